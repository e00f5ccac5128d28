//! wasm-bindgen as the builds use it, at exactly the version that `Cargo.lock` gives the library: `bindgen MODULE.wasm FOLDER`.

use anyhow::Context;
use wasm_bindgen_cli_support::Bindgen;

fn main() -> anyhow::Result<()> {
    let mut args = std::env::args_os().skip(1);
    let module = args.next().context("bindgen takes a module first")?;
    let folder = args.next().context("bindgen takes a folder second")?;
    Bindgen::new()
        .input_path(module)
        .web(true)?
        .typescript(false)
        .omit_default_module_path(true)
        .remove_producers_section(true)
        .generate(folder)
}
