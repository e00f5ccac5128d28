//! `cargo xtask bench`.

use std::path::PathBuf;

use crate::build;
use crate::packages;
use crate::shell::{Result, command, root, run, say};

/// Runs the benchmarks: `orient`, `prepare` and `register` natively, the others on a fresh build. `formats` compares files with what other programs read
/// and write.
pub fn bench(arguments: &[String]) -> Result<()> {
    let asked = |name: &str| arguments.is_empty() || arguments.iter().any(|asked| asked == name);
    let is_own = |argument: &&String| {
        !["orient", "prepare", "register", "formats"].contains(&argument.as_str())
    };
    let others: Vec<&String> = arguments.iter().filter(is_own).collect();
    if arguments.is_empty() || !others.is_empty() {
        bench_package(&others)?;
    }
    if asked("formats") {
        compare_formats()?;
    }
    for (name, example) in [
        ("orient", "orient_truth"),
        ("prepare", "prepare_truth"),
        ("register", "register_truth"),
    ] {
        if asked(name) {
            bench_natively(name, example)?;
        }
    }
    Ok(())
}

/// Each format from our writers to the readers of others, and back.
fn compare_formats() -> Result<()> {
    build::ensure()?;
    packages::npm(&root().join("tests"))?;
    let mut compare = command("node");
    compare
        .arg("tests/independent/formats.mjs")
        .env("PEERS_PYTHON", packages::formats()?);
    run(
        &mut compare,
        "a file is not what it was meant to be; the table above says which",
    )
}

fn bench_package(arguments: &[&String]) -> Result<()> {
    build::build()?;
    packages::npm(&root().join("tests"))?;
    let mut bench = command("node");
    bench.arg("tests/bench/bench.mjs").args(arguments);
    let asked = |name: &str| arguments.is_empty() || arguments.iter().any(|asked| *asked == name);
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
    peer("simplify", "SIMPLIFY_PYTHON", packages::simplify);
    peer("texture", "SIMPLIFY_PYTHON", packages::simplify);
    peer("tiles", "TILES_PYTHON", packages::tiles);
    run(&mut bench, "a benchmark failed; its error is above")
}

/// An example with a known truth, beside Open3D: which side is out, what is cut off a scan, and how scans are put together.
fn bench_natively(name: &str, example: &str) -> Result<()> {
    let mut bench = command("cargo");
    bench.args(["run", "--release", "--quiet", "--example", example, "--"]);
    match packages::open3d() {
        Ok(python) => {
            bench.arg(format!("peer={}", python.display()));
        }
        Err(sentence) => say(&format!("{sentence}; `{name}` leaves its peer out")),
    }
    run(&mut bench, "the benchmark failed; its error is above")
}
