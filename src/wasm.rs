//! The border to JavaScript, and the only file that knows of it: typed arrays and one options object in, plain objects
//! of typed arrays and a report out. Errors are thrown as plain objects `{ code, message, index, expected, found }`;
//! `pkg/` turns them into its `PointweaveError`.

use crate::error::Error;
use crate::params::{ReduceParams, SurfaceParams};
use crate::progress::{Progress, Stage};
use crate::samples::{self, Model};
use js_sys::{Float32Array, Function, Object, Reflect, Uint8Array};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::sync::Mutex;
use wasm_bindgen::prelude::*;

type JsResult = Result<JsValue, JsValue>;

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

/// Builds the pool of `threads` workers; blocks until as many have called `lendThread`. `pkg/hosts.js` starts them.
#[cfg(feature = "threads")]
#[wasm_bindgen(js_name = buildPool)]
pub fn build_pool(threads: usize) -> Result<(), JsError> {
    Ok(crate::pool::build(threads)?)
}

/// Lends the calling worker to the pool. Does not return while the pool lives.
#[cfg(feature = "threads")]
#[wasm_bindgen(js_name = lendThread)]
pub fn lend_thread() {
    crate::pool::lend_thread();
}

/// `{ reduce, reconstruct }`: the defaults, which `pkg/options.js` repeats.
#[wasm_bindgen]
pub fn defaults() -> JsResult {
    object([
        ("reduce", to_js(&ReduceParams::default())?),
        ("reconstruct", to_js(&SurfaceParams::default())?),
    ])
}

/// Options of [`sample`].
#[derive(Deserialize)]
struct SampleOptions {
    model: String,
    count: Option<usize>,
    #[serde(default)]
    seed: u64,
}

/// A generated scan: `{ positions, colors }` of `{ model, count, seed }`.
#[wasm_bindgen]
pub fn sample(options: JsValue) -> JsResult {
    let SampleOptions { model, count, seed } = from_js(options)?;
    let model =
        Model::from_name(&model).ok_or_else(|| bad_option("model", "duck, pig or part", &model))?;
    let scan = samples::sample(model, count.unwrap_or(model.default_points()), seed);
    object([
        ("positions", Float32Array::from(&scan.positions[..]).into()),
        ("colors", Uint8Array::from(&scan.colors[..]).into()),
    ])
}

/// Calls `f(stage, fraction)`; a truthy answer, or an exception, stops the job.
struct JsProgress(Function);

impl Progress for JsProgress {
    fn update(&mut self, stage: Stage, fraction: f32) -> crate::Result<()> {
        match self
            .0
            .call2(&JsValue::NULL, &stage.name().into(), &fraction.into())
        {
            Ok(stop) if stop.is_falsy() => Ok(()),
            _ => Err(Error::Cancelled),
        }
    }
}

impl From<Error> for JsValue {
    fn from(error: Error) -> JsValue {
        let fields = [
            ("code", error.code().into()),
            ("message", error.to_string().into()),
            (
                "index",
                error
                    .index()
                    .map_or(JsValue::UNDEFINED, |i| (i as f64).into()),
            ),
            ("expected", error.expected().into()),
            ("found", error.found().into()),
        ];
        object(fields).unwrap_or_else(|failed| failed)
    }
}

fn bad_option(option: &str, expected: &str, found: impl ToString) -> Error {
    Error::BadOption {
        option: option.into(),
        expected: expected.into(),
        found: found.to_string(),
    }
}

/// An object with these properties.
fn object<const N: usize>(fields: [(&str, JsValue); N]) -> JsResult {
    let object = Object::new();
    for (name, value) in fields {
        Reflect::set(&object, &name.into(), &value)?;
    }
    Ok(object.into())
}

/// A report or table as a plain object.
fn to_js(value: &impl Serialize) -> JsResult {
    let serializer = serde_wasm_bindgen::Serializer::new().serialize_maps_as_objects(true);
    value
        .serialize(&serializer)
        .map_err(|error| Error::Internal(error.to_string()).into())
}

/// Options over their defaults; ranges are checked by the pipeline.
fn from_js<T: DeserializeOwned>(options: JsValue) -> Result<T, Error> {
    serde_wasm_bindgen::from_value(options)
        .map_err(|error| bad_option("options", "the options of the reference", error))
}
