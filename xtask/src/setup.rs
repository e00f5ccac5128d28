//! `cargo xtask setup`: all that any command needs, installed. What a command needs is said before it is done, and nothing is
//! done when nothing is missing.

use crate::shell::{Result, root, say};
use crate::{browsers, packages, toolchain, tools};

/// What any command needs.
pub fn everything() -> Result<()> {
    toolchain::wasm()?;
    tools::rust_component("rustfmt")?;
    tools::rust_component("clippy")?;
    tools::bindgen()?;
    tools::test_runner()?;
    for folder in ["xtask", "pkg", "www", "tests", "tests/consumers"] {
        packages::npm(&root().join(folder))?;
    }
    browsers::chromium()?;
    browsers::chromedriver()?;
    browsers::firefox()?;
    browsers::geckodriver()?;
    if let Err(sentence) = packages::skfuzzy() {
        say(&format!("{sentence}; only a benchmark wants it"));
    }
    Ok(())
}
