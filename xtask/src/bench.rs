//! `cargo xtask bench`.

use std::path::PathBuf;

use crate::build;
use crate::packages;
use crate::shell::{Result, command, root, run, say};

/// Runs the benchmarks on a fresh build.
pub fn bench(arguments: &[String]) -> Result<()> {
    build::build()?;
    packages::npm(&root().join("tests"))?;
    let mut bench = command("node");
    bench.arg("tests/bench/bench.mjs").args(arguments);
    let asked = |name| arguments.is_empty() || arguments.iter().any(|asked| asked == name);
    let mut peer = |name, variable: &str, install: fn() -> Result<PathBuf>| {
        if asked(name) {
            match install() {
                Ok(python) => {
                    bench.env(variable, python);
                }
                Err(sentence) => say(&format!("{sentence}; `{name}` leaves its peer out")),
            }
        }
    };
    peer("fcm", "SKFUZZY_PYTHON", packages::skfuzzy);
    peer("surface", "OPEN3D_PYTHON", packages::open3d);
    run(&mut bench, "a benchmark failed; its error is above")
}
