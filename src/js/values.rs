//! Options as JavaScript has them, and reports as it gets them.

use crate::base::error::Error;
use crate::base::params::Value;
use crate::js::JsResult;
use js_sys::{Array, Object};
use serde::Serialize;
use wasm_bindgen::prelude::*;

/// A number, a string, a boolean or an object.
pub(crate) struct JsOption(pub JsValue);

impl Value for JsOption {
    fn number(&self) -> Option<f64> {
        self.0.as_f64()
    }

    fn switch(&self) -> Option<bool> {
        self.0.as_bool()
    }

    fn word(&self) -> Option<String> {
        self.0.as_string()
    }

    fn entries(&self) -> Option<Vec<(String, Box<dyn Value>)>> {
        let object = self.0.dyn_ref::<Object>()?;
        let mut entries: Vec<(String, Box<dyn Value>)> = Vec::new();
        for entry in Object::entries(object).iter() {
            let entry: Array = entry.unchecked_into();
            let value = entry.get(1);
            if !value.is_undefined() {
                let name = entry.get(0).as_string().unwrap_or_default();
                entries.push((name, Box::new(JsOption(value))));
            }
        }
        Some(entries)
    }
}

/// A report or table as a plain object.
pub(crate) fn to_js(value: &impl Serialize) -> JsResult {
    let serializer = serde_wasm_bindgen::Serializer::new().serialize_maps_as_objects(true);
    value
        .serialize(&serializer)
        .map_err(|error| Error::Internal(error.to_string()).into())
}
