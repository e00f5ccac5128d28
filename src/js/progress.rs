//! A function of JavaScript's that hears how far a job is.

use crate::base::error::{Error, Result};
use crate::base::progress::{Progress, Stage};
use js_sys::Function;
use wasm_bindgen::prelude::*;

/// Calls `f(stage, fraction)`; a truthy answer, or an exception, stops the job.
pub(crate) struct JsProgress(pub(crate) Function);

impl Progress for JsProgress {
    fn update(&mut self, stage: Stage, fraction: f32) -> Result<()> {
        let answer = self
            .0
            .call2(&JsValue::NULL, &stage.name().into(), &fraction.into());
        match answer {
            Ok(stop) if stop.is_falsy() => Ok(()),
            _ => Err(Error::Cancelled),
        }
    }
}
