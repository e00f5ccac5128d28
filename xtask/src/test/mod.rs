//! `cargo xtask test`: every check of the project, each named, timed and summed up at the end.

mod selection;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use crate::browsers;
use crate::build::{self, Build, TARGET};
use crate::packages;
use crate::page;
use crate::shell::{Result, cargo, command, root, run, run_both, say};
use crate::toolchain::{self, Toolchain};
use crate::tools;
use selection::Check;
pub use selection::Selection;

/// Runs every check, also after one has failed, so that one run shows all that is wrong.
pub fn test(selection: &Selection) -> Result<()> {
    let mut log = Log::default();
    match selection {
        Selection::Checks(checks) => all(checks, &mut log),
        Selection::File { check, file, name } => {
            log.step(file, || one(*check, file, name.as_deref()));
        }
    }
    log.finish()
}

fn all(checks: &[Check], log: &mut Log) {
    let mut built = false;
    for &check in checks {
        if check.needs_package() && !built {
            log.step("build", build::ensure);
            built = true;
        }
        match check {
            Check::Fmt => log.step("fmt", fmt),
            Check::Clippy => {
                log.step("clippy", clippy);
                log.step("rustdoc", rustdoc);
            }
            Check::Native => log.step("native", native),
            Check::Wasm => wasm(log),
            Check::Types => log.step("types", types),
            Check::Pkg => log.step("pkg", || {
                packages::npm(&root().join("tests/consumers"))?;
                node_tests("tests/pkg")
            }),
            Check::Element => log.step("element", || node_tests("tests/element")),
            Check::Page => log.step("page", || {
                page::ensure().and_then(|()| node_tests("tests/page"))
            }),
            Check::Cluster => log.step("cluster", cluster),
        }
    }
}

/// One file of a check, with nothing made that it does not need.
fn one(check: Check, file: &str, name: Option<&str>) -> Result<()> {
    match check {
        Check::Native => native_file(file, name),
        Check::Wasm => wasm_file(file, name),
        Check::Pkg => node_file("tests/pkg", file, name),
        Check::Element => node_file("tests/element", file, name),
        Check::Cluster => cluster_file(file, name),
        _ => node_file("tests/page", file, name),
    }
}

/// What ran, how long it took and how it ended.
#[derive(Default)]
struct Log {
    steps: Vec<(String, Duration, Result<()>)>,
}

impl Log {
    fn step(&mut self, name: &str, check: impl FnOnce() -> Result<()>) {
        say(&format!("— {name}"));
        let start = Instant::now();
        let result = check();
        if let Err(sentence) = &result {
            say(&format!("{name} failed: {sentence}"));
        }
        self.steps.push((name.into(), start.elapsed(), result));
    }

    fn finish(self) -> Result<()> {
        for (name, time, result) in &self.steps {
            let end = match result {
                Ok(()) => "ok".into(),
                Err(sentence) => format!("FAILED: {sentence}"),
            };
            println!("xtask test: {name:<24} {:>5} s  {end}", time.as_secs());
        }
        let failed: Vec<&str> = self
            .steps
            .iter()
            .filter(|(_, _, result)| result.is_err())
            .map(|(name, ..)| name.as_str())
            .collect();
        match failed[..] {
            [] => Ok(()),
            _ => Err(format!(
                "these checks failed: {}; their output is above",
                failed.join(", ")
            )),
        }
    }
}

fn fmt() -> Result<()> {
    tools::rust_component("rustfmt")?;
    run(
        cargo().args(["fmt", "--all", "--check"]),
        "run `cargo fmt --all`",
    )
}

fn clippy() -> Result<()> {
    tools::rust_component("clippy")?;
    for features in [&[][..], &["--features", "pointweave/threads"]] {
        let mut clippy = cargo();
        clippy
            .args(["clippy", "--quiet", "--workspace", "--all-targets"])
            .args(features);
        run(
            clippy.args(["--", "-D", "warnings"]),
            "clippy has warnings, see above",
        )?;
    }
    Ok(())
}

/// Every link in the docs leads somewhere, also those that only contributors read.
fn rustdoc() -> Result<()> {
    let mut doc = cargo();
    doc.args(["doc", "--quiet", "--no-deps", "--document-private-items"])
        .args(["--package", "pointweave"])
        .env("RUSTDOCFLAGS", "-D warnings");
    run(&mut doc, "the docs have warnings, see above")
}

/// The tests, and those in the docs, with threads: the feature adds tests and takes none away. Clippy has compiled the examples.
fn native() -> Result<()> {
    for targets in [&["--lib", "--bins", "--tests"][..], &["--doc"]] {
        let mut tests = cargo();
        tests.args(["test", "--quiet", "--workspace", "--no-fail-fast"]);
        tests.args(["--features", "pointweave/threads"]);
        run(tests.args(targets), "native tests failed, see above")?;
    }
    Ok(())
}

/// One file of tests/, or the unit tests of a module of src/ or of xtask.
fn native_file(file: &str, name: Option<&str>) -> Result<()> {
    let mut tests = cargo();
    tests.args(["test", "--features", "pointweave/threads"]);
    if root().join(format!("tests/{file}.rs")).is_file() {
        tests.args(["--package", "pointweave", "--test", file, "--"]);
        tests.args(name);
    } else {
        tests.args(["--workspace", "--lib", "--bins", "--"]);
        tests.arg(match name {
            Some(name) => format!("{file}::tests::{name}"),
            None => format!("{file}::"),
        });
    }
    run(&mut tests, "tests failed, see above")
}

/// Every build in every browser, each compiled once: both builds at once, then both browsers at once.
fn wasm(log: &mut Log) {
    let mut ready = None;
    log.step("wasm: set up", || {
        browsers::chromium()?;
        browsers::firefox()?;
        ready = Some((
            toolchain::wasm()?,
            tools::test_runner()?,
            browsers::chromedriver()?,
            browsers::geckodriver()?,
        ));
        Ok(())
    });
    let Some((toolchain, runner, chromedriver, geckodriver)) = ready else {
        return;
    };
    log.step("wasm: compile", || {
        let [mut single, mut threads] = Build::ENGINES.map(|build| {
            let mut tests = wasm_tests(build, &toolchain, &runner);
            tests.arg("--no-run");
            tests
        });
        run_both([
            (&mut single, "the tests did not compile, see above"),
            (
                &mut threads,
                "those with threads did not compile, see above",
            ),
        ])
    });
    for build in Build::ENGINES {
        log.step(&format!("wasm: {}", build.name()), || {
            // The runner takes the first driver that the environment names.
            let mut chromium = wasm_tests(build, &toolchain, &runner);
            chromium
                .env_remove("GECKODRIVER")
                .env("CHROMEDRIVER", &chromedriver);
            let mut firefox = wasm_tests(build, &toolchain, &runner);
            firefox
                .env_remove("CHROMEDRIVER")
                .env("GECKODRIVER", &geckodriver);
            run_both([
                (&mut chromium, "wasm tests failed in Chromium, see above"),
                (&mut firefox, "wasm tests failed in Firefox, see above"),
            ])
        });
    }
}

/// The module of one file of tests/, in the single-threaded build and Chromium alone.
fn wasm_file(file: &str, name: Option<&str>) -> Result<()> {
    browsers::chromium()?;
    let (toolchain, runner) = (toolchain::wasm()?, tools::test_runner()?);
    let mut tests = wasm_tests(Build::Single, &toolchain, &runner);
    tests
        .env_remove("GECKODRIVER")
        .env("CHROMEDRIVER", browsers::chromedriver()?)
        .arg("--")
        .arg(format!("{file}::{}", name.unwrap_or_default()));
    run(&mut tests, "wasm tests failed, see above")
}

fn wasm_tests(build: Build, toolchain: &Toolchain, runner: &Path) -> Command {
    let mut tests = build.cargo(toolchain, "test", "wasm-test");
    // Files of both kinds are read and written, which the engine does not.
    tests.args(["--features", "files,packed"]);
    // By name: documentation tests would take rustdoc from PATH, and it is another compiler's.
    tests.args(["--test", "wasm"]);
    if build == Build::Threads {
        tests.args(["--test", "pool"]);
    }
    tests
        .args(["--no-fail-fast", "--config"])
        .arg(format!(
            "target.{TARGET}.runner=[{:?}]",
            runner.display().to_string()
        ))
        .env("WASM_BINDGEN_TEST_TIMEOUT", "1200")
        .env("WASM_BINDGEN_TEST_DRIVER_TIMEOUT", "60")
        // Of the runner, below every failed test: it says nothing of the test.
        .env("RUST_LIB_BACKTRACE", "0");
    tests
}

/// Types of the package, the page and the tests, wherever there is a tsconfig.json.
fn types() -> Result<()> {
    for folder in ["pkg", "www", "tests"] {
        packages::npm(&root().join(folder))?;
    }
    for folder in ["pkg", "www", "tests"] {
        let project = root().join(folder).join("tsconfig.json");
        if project.is_file() {
            let mut tsc = command("node");
            tsc.args([
                "tests/node_modules/typescript/bin/tsc",
                "--noEmit",
                "--project",
            ])
            .arg(&project);
            run(
                &mut tsc,
                &format!("the types of {folder} do not fit, see above"),
            )?;
        }
    }
    Ok(())
}

/// The Python package: its style, its types, and what it does on a cluster of this machine.
fn cluster() -> Result<()> {
    let python = packages::cluster()?;
    for (tool, remedy) in [
        (&["ruff", "check"][..], "ruff has complaints, see above"),
        (
            &["ruff", "format", "--check"],
            "run `ruff format` in cluster/",
        ),
        (&["mypy"], "the types of cluster/ do not fit, see above"),
        (&["pytest", "-q"], "tests failed, see above"),
    ] {
        run(&mut cluster_tool(&python, tool), remedy)?;
    }
    Ok(())
}

/// `test_FILE.py`, or its tests with `name` in theirs.
fn cluster_file(file: &str, name: Option<&str>) -> Result<()> {
    build::ensure()?;
    let mut pytest = cluster_tool(&packages::cluster()?, &["pytest"]);
    pytest.arg(format!("tests/test_{file}.py"));
    if let Some(name) = name {
        pytest.args(["-k", name]);
    }
    run(&mut pytest, "tests failed, see above")
}

fn cluster_tool(python: &Path, tool: &[&str]) -> Command {
    let mut command = command(python);
    command
        .arg("-m")
        .args(tool)
        .current_dir(root().join("cluster"));
    command
}

/// The tests in a folder, by Node's own runner.
fn node_tests(folder: &str) -> Result<()> {
    let files = files(folder, ".test.mjs")?;
    if files.is_empty() {
        return Err(format!("{folder} holds no *.test.mjs"));
    }
    node(&files, None, true)
}

/// One file of such a folder: no package is built that is not older than the sources, no page where none is opened.
fn node_file(folder: &str, file: &str, name: Option<&str>) -> Result<()> {
    let path = root().join(folder).join(format!("{file}.test.mjs"));
    let text = std::fs::read_to_string(&path)
        .map_err(|error| format!("{} cannot be read: {error}", path.display()))?;
    build::ensure()?;
    if text.contains("consumers") {
        packages::npm(&root().join("tests/consumers"))?;
    }
    if folder == "tests/page" && text.contains("./browser.mjs") {
        page::ensure()?;
    }
    let opens = ["browser.mjs", "site.mjs"]
        .iter()
        .any(|helper| text.contains(helper));
    node(&[path], name, opens)
}

fn node(files: &[PathBuf], name: Option<&str>, in_browsers: bool) -> Result<()> {
    packages::npm(&root().join("tests"))?;
    let mut tests = command("node");
    tests.args(["--test", "--test-reporter=spec", "--test-concurrency=2"]);
    if in_browsers {
        tests.env("CHROMIUM", browsers::chromium()?);
        tests.env("FIREFOX", browsers::firefox()?);
    }
    if let Some(name) = name {
        tests.arg(format!("--test-name-pattern={name}"));
    }
    run(tests.args(files), "tests failed, see above")
}

/// Files of a folder of the workspace whose name ends so, sorted.
fn files(folder: &str, end: &str) -> Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(root().join(folder))
        .map_err(|error| format!("{folder} cannot be read: {error}"))?;
    let mut files: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.to_string_lossy().ends_with(end))
        .collect();
    files.sort();
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_not_there_is_named() {
        let error = node_file("tests/pkg", "nothing", None).unwrap_err();
        assert!(error.contains("nothing.test.mjs"), "{error}");
    }

    #[test]
    fn one_failure_fails_the_run_and_is_named() {
        let mut log = Log::default();
        log.step("good", || Ok(()));
        assert!(
            Log {
                steps: log.steps.clone()
            }
            .finish()
            .is_ok()
        );
        log.step("bad", || Err("reason".into()));
        log.step("good again", || Ok(()));
        let error = log.finish().unwrap_err();
        assert!(error.contains("failed: bad;"), "{error}");
    }
}
