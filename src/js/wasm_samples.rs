//! Sample scans, for JavaScript.

use crate::base::error::Error;
use crate::js::{JsResult, object};
use crate::samples::{self, Model};
use js_sys::{Float32Array, Uint8Array};
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// `{ model, count, seed, noise }`; `pkg/engine/options.js` has checked them.
    pub type SampleOptions;
    #[wasm_bindgen(method, getter)]
    fn model(this: &SampleOptions) -> String;
    #[wasm_bindgen(method, getter)]
    fn count(this: &SampleOptions) -> Option<u32>;
    #[wasm_bindgen(method, getter)]
    fn seed(this: &SampleOptions) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn noise(this: &SampleOptions) -> Option<f64>;
}

/// [`samples::sample_with_noise`], or [`samples::desk`], of `{ model, count, seed, noise }`: a cloud with colours.
#[wasm_bindgen]
pub fn sample(options: &SampleOptions) -> JsResult {
    let name = options.model();
    let count = |usual: usize| options.count().map_or(usual, |n| n as usize);
    let seed = options.seed().unwrap_or_default() as u64;
    let noise = options.noise().unwrap_or(samples::NOISE);
    let scan = match Model::from_name(&name) {
        Some(model) => {
            samples::sample_with_noise(model, count(model.default_points()), seed, noise)
        }
        None if name == "desk" => samples::desk(count(samples::DESK_POINTS), seed, noise),
        None => return Err(Error::bad_option("model", "duck, pig, part or desk", &name).into()),
    };
    object([
        ("positions", Float32Array::from(&scan.positions[..]).into()),
        ("colors", Uint8Array::from(&scan.colors[..]).into()),
    ])
}
