//! Pictures of textures from JavaScript. The build of pictures has this and nothing else.

use crate::formats::decode_picture;
use crate::js::{JsResult, object};
use js_sys::Uint8Array;
use wasm_bindgen::prelude::*;

/// `{ width, height, pixels }` of a PNG, JPEG or WebP file's bytes, four bytes a pixel; undefined for others.
#[wasm_bindgen(js_name = decodePicture)]
pub fn decode(bytes: &[u8]) -> JsResult {
    let Some(picture) = decode_picture(bytes) else {
        return Ok(JsValue::UNDEFINED);
    };
    object([
        ("width", (picture.width as f64).into()),
        ("height", (picture.height as f64).into()),
        ("pixels", Uint8Array::from(&picture.pixels[..]).into()),
    ])
}
