//! Recipes, for JavaScript: which points are left, and what every step saw. `pkg/engine/preparing.js` takes the others out.

use crate::base::error::Error;
use crate::cloud::Cloud;
use crate::js::clouds::{PointCloud, floor_to_js};
use crate::js::progress::JsProgress;
use crate::js::values::{JsOption, to_js};
use crate::js::{JsResult, object, optional};
use crate::pipeline;
use crate::prepare::recipe::Step;
use js_sys::{Array, Function, Reflect, Uint8Array, Uint32Array};
use wasm_bindgen::prelude::*;

/// [`pipeline::prepare_scans`] of an array of clouds and an array of steps: `{ kept, labels, steps, floor }`.
#[wasm_bindgen]
pub fn prepare(clouds: Array, steps: JsValue, progress: Function) -> JsResult {
    let recipe = Step::recipe(&JsOption(steps))?;
    let cloud = |cloud: JsValue| cloud.unchecked_into::<PointCloud>().to_cloud();
    let clouds = clouds.iter().map(|given| Ok(cloud(given)?.0));
    let clouds: Vec<Cloud> = clouds.collect::<Result<_, Error>>()?;
    let prepared = pipeline::prepare_scans(&clouds, &recipe, &mut JsProgress(progress))?;
    let steps = Array::new();
    for report in &prepared.steps {
        let step = to_js(report)?;
        let labels = optional(&report.labels, |labels| Uint32Array::from(&labels[..]));
        if !labels.is_undefined() {
            Reflect::set(&step, &"labels".into(), &labels)?;
        }
        steps.push(&step);
    }
    object([
        ("kept", Uint32Array::from(&prepared.kept[..]).into()),
        ("labels", Uint8Array::from(&prepared.dropped_by[..]).into()),
        ("steps", steps.into()),
        ("floor", floor_to_js(&prepared.floor)?),
    ])
}
