//! The border to JavaScript: arguments checked and taken, a call of the crate, results handed over. No algorithm is here.
//!
//! 1. `wasm`: the engine's calls: reduce, reconstruct, inspect. `wasm_read`: readers, slice by slice. `wasm_write`: writers.
//!    `wasm_prepare`: recipes. `wasm_light`: meshes with fewer triangles. `wasm_tiles`: the steps of tiles. `wasm_samples`: sample scans. `wasm_pictures`: pictures of textures. Which of them a module has, its feature says (`Cargo.toml`).
//! 2. `values`: options of a call, and reports. `progress`: who hears of it. `clouds`, `viewpoints`, `crs`: a JavaScript object becomes a [`crate::Cloud`] or a part of it, and back.
//! 3. This file is what all of them need: panics kept, errors thrown as objects, objects made.
//!
//! **In**: typed arrays, copied once into wasm's memory; options as plain objects whose ranges the crate checks. **Out**: objects of
//! typed arrays that JavaScript owns, and reports in camel case. An error carries its code, its place, what was expected and found.
//!
//! **Cost**: one copy of each array in each direction.

#[cfg(any(
    feature = "engine",
    feature = "exports",
    feature = "light",
    feature = "prepare"
))]
pub mod clouds;
#[cfg(any(
    feature = "engine",
    feature = "exports",
    feature = "las",
    feature = "light",
    feature = "prepare"
))]
mod crs;
#[cfg(feature = "stages")]
mod progress;
#[cfg(feature = "stages")]
mod values;
#[cfg(any(
    feature = "engine",
    feature = "exports",
    feature = "light",
    feature = "prepare"
))]
mod viewpoints;
#[cfg(feature = "engine")]
pub mod wasm;
#[cfg(feature = "light")]
pub mod wasm_light;
#[cfg(feature = "pictures")]
pub mod wasm_pictures;
#[cfg(feature = "prepare")]
pub mod wasm_prepare;
#[cfg(all(
    not(feature = "engine"),
    any(
        feature = "e57",
        feature = "files",
        feature = "las",
        feature = "packed"
    )
))]
pub mod wasm_read;
#[cfg(feature = "samples")]
pub mod wasm_samples;
#[cfg(feature = "tiles")]
pub mod wasm_tiles;
#[cfg(feature = "exports")]
pub mod wasm_write;

use crate::base::error::Error;
use js_sys::{Object, Reflect};
use std::sync::Mutex;
use wasm_bindgen::prelude::*;

pub(crate) type JsResult = Result<JsValue, JsValue>;

/// The text of the panic that ended this instance.
static PANIC: Mutex<String> = Mutex::new(String::new());

/// Keeps a panic's text for [`panic_message`], and shows it on the console.
#[wasm_bindgen(start)]
pub fn start() {
    std::panic::set_hook(Box::new(|info| {
        web_sys::console::error_1(&info.to_string().into());
        if let Ok(mut message) = PANIC.lock() {
            *message = info.to_string();
        }
    }));
}

/// What the panic said that ended this instance, or an empty string.
#[wasm_bindgen(js_name = panicMessage)]
pub fn panic_message() -> String {
    PANIC
        .lock()
        .map(|mut message| std::mem::take(&mut *message))
        .unwrap_or_default()
}

impl From<Error> for JsValue {
    fn from(error: Error) -> JsValue {
        let index = error
            .index()
            .map_or(JsValue::UNDEFINED, |i| (i as f64).into());
        let fields = [
            ("code", error.code().into()),
            ("message", error.to_string().into()),
            ("index", index),
            ("expected", error.expected().into()),
            ("found", error.found().into()),
        ];
        object(fields).unwrap_or_else(|failed| failed)
    }
}

/// An object with these properties; those that are undefined are left out.
pub(crate) fn object<const N: usize>(fields: [(&str, JsValue); N]) -> JsResult {
    let object = Object::new();
    for (name, value) in fields {
        if !value.is_undefined() {
            Reflect::set(&object, &name.into(), &value)?;
        }
    }
    Ok(object.into())
}

#[cfg(any(
    feature = "engine",
    feature = "e57",
    feature = "files",
    feature = "las",
    feature = "light",
    feature = "packed",
    feature = "prepare",
    feature = "tiles"
))]
pub(crate) fn optional<T, A: Into<JsValue>>(value: &Option<T>, array: impl Fn(&T) -> A) -> JsValue {
    value
        .as_ref()
        .map_or(JsValue::UNDEFINED, |value| array(value).into())
}
