//! The native tests once more, in browsers: the same files, for both wasm builds.
#![cfg(target_arch = "wasm32")]

wasm_bindgen_test::wasm_bindgen_test_configure!(run_in_dedicated_worker);

#[path = "extract.rs"]
mod extract;
#[path = "fcm.rs"]
mod fcm;
#[path = "formats.rs"]
mod formats;
#[path = "reduce.rs"]
mod reduce;
#[path = "report.rs"]
mod report;
#[path = "samples.rs"]
mod samples;
#[path = "simplify.rs"]
mod simplify;
#[path = "surface.rs"]
mod surface;
