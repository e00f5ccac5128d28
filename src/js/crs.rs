//! Reference systems, as `{ wkt, keys, doubles, ascii }`.

use crate::cloud::Crs;
use crate::js::{JsResult, object, optional};
use js_sys::{Float64Array, Uint16Array};
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// The caller's; `pkg/engine/clouds.js` has checked the types.
    pub type PointCrs;
    #[wasm_bindgen(method, getter)]
    fn wkt(this: &PointCrs) -> Option<String>;
    #[wasm_bindgen(method, getter)]
    fn keys(this: &PointCrs) -> Option<Uint16Array>;
    #[wasm_bindgen(method, getter)]
    fn doubles(this: &PointCrs) -> Option<Float64Array>;
    #[wasm_bindgen(method, getter)]
    fn ascii(this: &PointCrs) -> Option<String>;
}

#[cfg(any(
    feature = "engine",
    feature = "exports",
    feature = "light",
    feature = "prepare"
))]
impl PointCrs {
    pub(crate) fn read(&self) -> Crs {
        Crs {
            wkt: self.wkt(),
            keys: self.keys().map_or(Vec::new(), |keys| keys.to_vec()),
            doubles: self
                .doubles()
                .map_or(Vec::new(), |doubles| doubles.to_vec()),
            ascii: self.ascii().unwrap_or_default(),
        }
    }
}

/// Undefined where there is none.
pub(crate) fn crs_to_js(crs: &Option<Crs>) -> JsResult {
    let Some(Crs {
        wkt,
        keys,
        doubles,
        ascii,
    }) = crs
    else {
        return Ok(JsValue::UNDEFINED);
    };
    let given = |is_given: bool| is_given.then_some(());
    object([
        ("wkt", optional(wkt, |wkt| JsValue::from(wkt))),
        (
            "keys",
            optional(&given(!keys.is_empty()), |_| Uint16Array::from(&keys[..])),
        ),
        (
            "doubles",
            optional(&given(!doubles.is_empty()), |_| {
                Float64Array::from(&doubles[..])
            }),
        ),
        (
            "ascii",
            optional(&given(!ascii.is_empty()), |_| JsValue::from(ascii)),
        ),
    ])
}
