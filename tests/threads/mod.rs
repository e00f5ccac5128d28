//! The pool for tests of the wasm-threads build, as `pkg/engine/worker-host.js` makes it for the package.

use js_sys::{JsString, Promise};
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// The module that wasm-bindgen wrote for these tests.
    #[wasm_bindgen(thread_local_v2, js_namespace = ["import", "meta"], js_name = url)]
    static BINDINGS: JsString;
}

#[wasm_bindgen(module = "/tests/threads/workers.js")]
extern "C" {
    #[wasm_bindgen(js_name = startWorkers)]
    fn start_workers(bindings: JsString, module: JsValue, memory: JsValue, threads: usize) -> Promise;
}

/// Starts a pool of `threads`, once a test binary.
pub async fn start(threads: usize) {
    let bindings = BINDINGS.with(Clone::clone);
    let (module, memory) = (wasm_bindgen::module(), wasm_bindgen::memory());
    start_workers(bindings, module, memory, threads)
        .await
        .expect("every worker starts");
    pointweave::base::pool::build(threads).expect("one pool a test binary");
}
