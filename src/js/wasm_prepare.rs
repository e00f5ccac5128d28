//! Recipes, for JavaScript: which points are left, and what every step saw. `pkg/engine/preparing.js` takes the others out.

use crate::js::clouds::PointCloud;
use crate::js::progress::JsProgress;
use crate::js::values::{JsOption, to_js};
use crate::js::{JsResult, object, optional};
use crate::pipeline;
use crate::prepare::recipe::Step;
use js_sys::{Array, Function, Reflect, Uint8Array, Uint32Array};
use wasm_bindgen::prelude::*;

/// [`pipeline::prepare`] of an array of steps: `{ kept, labels, steps }`.
#[wasm_bindgen]
pub fn prepare(cloud: &PointCloud, steps: JsValue, progress: Function) -> JsResult {
    let recipe = Step::recipe(&JsOption(steps))?;
    let (cloud, _) = cloud.to_cloud()?;
    let prepared = pipeline::prepare(&cloud, &recipe, &mut JsProgress(progress))?;
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
    ])
}
