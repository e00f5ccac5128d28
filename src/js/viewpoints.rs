//! Where a cloud was seen from, as `{ positions, of }`.

use crate::base::error::Error;
use crate::cloud::Viewpoints;
use crate::js::{JsResult, object, optional};
use js_sys::{Float64Array, Uint32Array};
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// The caller's; `pkg/engine/clouds.js` has checked the types.
    pub type PointViews;
    #[wasm_bindgen(method, getter)]
    fn positions(this: &PointViews) -> Float64Array;
    #[wasm_bindgen(method, getter)]
    fn of(this: &PointViews) -> Option<Uint32Array>;
}

impl PointViews {
    /// Those of a cloud of so many points.
    pub(crate) fn read(&self, points: usize) -> Result<Viewpoints, Error> {
        let of = self.of().map(|of| of.to_vec());
        Viewpoints::new(&self.positions().to_vec(), of.as_deref(), points)
    }
}

/// Undefined where there are none.
pub(crate) fn views_to_js(viewpoints: &Option<Viewpoints>) -> JsResult {
    let Some(Viewpoints { positions, of }) = viewpoints else {
        return Ok(JsValue::UNDEFINED);
    };
    let positions: Vec<f64> = positions.iter().flat_map(|p| p.to_array()).collect();
    object([
        ("positions", Float64Array::from(&positions[..]).into()),
        ("of", optional(of, |of| Uint32Array::from(&of[..]))),
    ])
}
