//! Results to files, from JavaScript.

use crate::base::error::Error;
use crate::cloud::Unit;
use crate::formats::{self, Output, Skin, WriteOptions};
use crate::js::clouds::{PointCloud, triple};
use js_sys::{Array, Uint8Array};
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// `{ format, encoding, quantize, up, unit }`; `pkg/engine/options.js` has checked their types.
    pub type WriteSettings;
    #[wasm_bindgen(method, getter)]
    fn format(this: &WriteSettings) -> Option<String>;
    #[wasm_bindgen(method, getter)]
    fn encoding(this: &WriteSettings) -> Option<String>;
    #[wasm_bindgen(method, getter)]
    fn quantize(this: &WriteSettings) -> Option<bool>;
    #[wasm_bindgen(method, getter)]
    fn up(this: &WriteSettings) -> Option<Array>;
    #[wasm_bindgen(method, getter)]
    fn unit(this: &WriteSettings) -> Option<String>;
}

/// [`formats::write`] of `{ format, encoding, quantize, up, unit }`: the file's bytes.
#[wasm_bindgen]
pub fn write(result: &PointCloud, options: &WriteSettings) -> Result<Uint8Array, JsValue> {
    let format = options.format();
    let name = format.as_deref().unwrap_or("ply");
    let format = Output::from_name(name).ok_or_else(|| {
        let names: Vec<&str> = Output::ALL.iter().map(|format| format.name()).collect();
        Error::bad_option("format", &names.join(", "), name)
    })?;
    let named = |name: &str| {
        Unit::from_name(name)
            .ok_or_else(|| Error::bad_option("unit", "mm, cm, m, in, ft, us-ft or deg", name))
    };
    let options = WriteOptions {
        ascii: options.encoding().as_deref() == Some("ascii"),
        quantize: options.quantize().unwrap_or_default(),
        up: options.up().map(triple),
        unit: options.unit().as_deref().map(named).transpose()?,
    };
    let indices = result.indices().map(|indices| indices.to_vec());
    let mut cloud = result.read()?;
    cloud.skin = result.uvs().map(|uvs| {
        Box::new(Skin {
            uvs: uvs.to_vec(),
            tangents: result.tangents().map(|values| values.to_vec()),
            color: result.color_picture().map(|bytes| bytes.to_vec()),
            normal: result.normal_picture().map(|bytes| bytes.to_vec()),
            occlusion: result.occlusion_picture().map(|bytes| bytes.to_vec()),
        })
    });
    let bytes = formats::write(&cloud, indices.as_deref(), format, options)?;
    Ok(Uint8Array::from(&bytes[..]))
}
