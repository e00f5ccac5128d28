//! Results to files, from JavaScript: in the engine's builds, and in the one of the writers that are not in the engine.

use crate::cloud::Unit;
use crate::formats::{self, Output, WriteOptions};
use crate::js::clouds::PointCloud;
use crate::js::{bad_option, from_js};
use js_sys::Uint8Array;
use serde::Deserialize;
use wasm_bindgen::prelude::*;

/// Options of [`write`].
#[derive(Deserialize)]
struct WriteSettings {
    format: Option<String>,
    encoding: Option<String>,
    #[serde(default)]
    quantize: bool,
    up: Option<[f64; 3]>,
    unit: Option<String>,
}

/// [`formats::write`] of `{ format, encoding, quantize, up, unit }`: the file's bytes.
#[wasm_bindgen]
pub fn write(result: &PointCloud, options: JsValue) -> Result<Uint8Array, JsValue> {
    let WriteSettings {
        format,
        encoding,
        quantize,
        up,
        unit,
    } = from_js(options)?;
    let name = format.as_deref().unwrap_or("ply");
    let format = Output::from_name(name).ok_or_else(|| {
        let names: Vec<&str> = Output::ALL.iter().map(|format| format.name()).collect();
        bad_option("format", &names.join(", "), name)
    })?;
    let named = |name: &str| {
        Unit::from_name(name)
            .ok_or_else(|| bad_option("unit", "mm, cm, m, in, ft, us-ft or deg", name))
    };
    let options = WriteOptions {
        ascii: encoding.as_deref() == Some("ascii"),
        quantize,
        up,
        unit: unit.as_deref().map(named).transpose()?,
    };
    let indices = result.indices().map(|indices| indices.to_vec());
    let bytes = formats::write(&result.read()?, indices.as_deref(), format, options)?;
    Ok(Uint8Array::from(&bytes[..]))
}
