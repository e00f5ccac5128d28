//! `cargo xtask serve` and `cargo xtask bench`.

use crate::build;
use crate::setup;
use crate::shell::{Result, command, root, run, say};
use std::path::PathBuf;

/// Builds the package and the page, and serves the page until it is stopped.
pub fn serve(port: u16) -> Result<()> {
    build::build()?;
    page()?;
    let mut vite = command("npm");
    vite.current_dir(root().join("www"))
        .args([
            "run",
            "--silent",
            "preview",
            "--",
            "--host",
            "localhost",
            "--strictPort",
            "--port",
        ])
        .arg(port.to_string());
    say(&format!(
        "the page is at http://localhost:{port}/ until you press Ctrl-C"
    ));
    run(
        &mut vite,
        &format!("nothing is served any more; if port {port} is taken, choose one with `--port N`"),
    )
}

/// The page for production, into www/dist. It imports the package, so that has to be built before.
pub fn page() -> Result<()> {
    for folder in ["pkg", "www"] {
        setup::npm(&root().join(folder))?;
    }
    say("building the page");
    let mut vite = command("npm");
    vite.current_dir(root().join("www"))
        .args(["run", "--silent", "build"]);
    run(&mut vite, "the page did not build; its errors are above")
}

/// Runs the benchmarks: `orient` natively, the others on a fresh build.
pub fn bench(arguments: &[String]) -> Result<()> {
    let is_orient = |argument: &&String| *argument == "orient";
    let (orient, others): (Vec<&String>, Vec<&String>) = arguments.iter().partition(is_orient);
    if arguments.is_empty() || !others.is_empty() {
        bench_package(&others)?;
    }
    if arguments.is_empty() || !orient.is_empty() {
        bench_orientation()?;
    }
    Ok(())
}

fn bench_package(arguments: &[&String]) -> Result<()> {
    build::build()?;
    setup::npm(&root().join("tests"))?;
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
    peer("fcm", "SKFUZZY_PYTHON", setup::skfuzzy);
    peer("surface", "OPEN3D_PYTHON", setup::open3d);
    run(&mut bench, "a benchmark failed; its error is above")
}

/// Which side is out, beside Open3D.
fn bench_orientation() -> Result<()> {
    let mut bench = command("cargo");
    bench.args([
        "run",
        "--release",
        "--quiet",
        "--example",
        "orient_truth",
        "--",
    ]);
    match setup::open3d() {
        Ok(python) => {
            bench.arg(format!("peer={}", python.display()));
        }
        Err(sentence) => say(&format!("{sentence}; `orient` leaves its peer out")),
    }
    run(&mut bench, "the benchmark failed; its error is above")
}
