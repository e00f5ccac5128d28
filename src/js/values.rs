//! Options as JavaScript has them.

use crate::base::params::Value;
use js_sys::{Array, Object};
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
