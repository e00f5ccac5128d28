//! Programs of Rust: components of the toolchain, and wasm-bindgen's.

use std::env;
use std::path::PathBuf;

use crate::shell::{Result, cargo, command, find, output, root, run, say};

/// `cargo fmt` or `cargo clippy` for the compiler that runs xtask.
pub fn rust_component(name: &str) -> Result<()> {
    let subcommand = if name == "rustfmt" { "fmt" } else { name };
    if output(cargo().args([subcommand, "--version"])).is_some() {
        return Ok(());
    }
    let remedy = format!("`cargo {subcommand}` is missing; run `rustup component add {name}`");
    if env::var("RUSTUP_AUTO_INSTALL").as_deref() == Ok("0") || find("rustup").is_none() {
        return Err(remedy);
    }
    say(&format!("installing {name} with rustup"));
    run(command("rustup").args(["component", "add", name]), &remedy)
}

/// What makes the JavaScript of a wasm module.
pub fn bindgen() -> Result<PathBuf> {
    own("bindgen", "about 1 minute")
}

/// What runs wasm tests in a browser.
pub fn test_runner() -> Result<PathBuf> {
    own("test-runner", "about 3 minutes")
}

/// Whether [`bindgen`] was built before.
pub fn has_bindgen() -> bool {
    place("bindgen").is_file()
}

fn place(name: &str) -> PathBuf {
    let file = format!("xtask/{name}{}", env::consts::EXE_SUFFIX);
    root().join("target").join(file)
}

/// One of the programs in `src/bin`.
fn own(name: &str, time: &str) -> Result<PathBuf> {
    let program = place(name);
    if !program.is_file() {
        say(&format!(
            "building wasm-bindgen's {name}, once: {time} on 2 cores"
        ));
    }
    run(
        cargo()
            .args(["build", "--quiet", "--package", "xtask"])
            .args(["--profile", "xtask", "--features", name, "--bin", name])
            .arg("--target-dir")
            .arg(root().join("target")),
        &format!("wasm-bindgen's {name} did not build; its errors are above"),
    )?;
    Ok(program)
}
