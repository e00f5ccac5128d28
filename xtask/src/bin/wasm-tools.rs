//! wasm-bindgen's command line tools as one program, at exactly the version that `Cargo.lock` gives
//! the library: `wasm-tools bindgen …` and `wasm-tools test-runner …`.

use std::env;
use std::ffi::OsString;

fn main() -> anyhow::Result<()> {
    let mut args = env::args_os().skip(1);
    let tool = args.next().unwrap_or_default();
    let args: Vec<OsString> = std::iter::once(tool.clone()).chain(args).collect();
    match tool.to_str() {
        Some("bindgen") => wasm_bindgen_cli::wasm_bindgen::run_cli_with_args(args),
        Some("test-runner") => wasm_bindgen_cli::wasm_bindgen_test_runner::run_cli_with_args(args),
        _ => anyhow::bail!("wasm-tools takes `bindgen` or `test-runner` as its first argument"),
    }
}
