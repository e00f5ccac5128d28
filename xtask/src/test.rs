//! `cargo xtask test`: every check of the project, each named, timed and summed up at the end.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use crate::build::{self, Build, TARGET};
use crate::page;
use crate::setup;
use crate::shell::{Result, cargo, command, root, run, say};
use crate::toolchain::{self, Toolchain};

/// A check that `--only` can name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Check {
    Fmt,
    Clippy,
    Native,
    Wasm,
    Types,
    Pkg,
    Element,
    Page,
}

impl Check {
    /// The quick ones first.
    const ALL: [(Check, &str); 8] = [
        (Check::Fmt, "fmt"),
        (Check::Clippy, "clippy"),
        (Check::Native, "native"),
        (Check::Wasm, "wasm"),
        (Check::Types, "types"),
        (Check::Pkg, "pkg"),
        (Check::Element, "element"),
        (Check::Page, "page"),
    ];

    /// These read what `cargo xtask build` writes.
    fn needs_package(self) -> bool {
        matches!(
            self,
            Check::Types | Check::Pkg | Check::Element | Check::Page
        )
    }
}

/// The checks that the command line asks for: all, or those after `--only`.
pub fn selection(options: &[String]) -> Result<Vec<Check>> {
    let list = match options {
        [] => return Ok(Check::ALL.map(|(check, _)| check).to_vec()),
        [flag, list] if flag == "--only" => list,
        _ => return Err("`test` takes `--only fmt,clippy,…` and nothing else".into()),
    };
    let names = Check::ALL.map(|(_, name)| name).join(",");
    let find = |name| Check::ALL.iter().find(|(_, known)| *known == name);
    list.split(',')
        .map(|name| find(name).map(|(check, _)| *check))
        .collect::<Option<Vec<Check>>>()
        .ok_or_else(|| format!("`--only {list}` names something else than {names}"))
}

/// Runs every check, also after one has failed, so that one run shows all that is wrong.
pub fn test(checks: &[Check]) -> Result<()> {
    let mut log = Log::default();
    let mut built = false;
    for &check in checks {
        if check.needs_package() && !built {
            log.step("build", build::build);
            built = true;
        }
        match check {
            Check::Fmt => log.step("fmt", fmt),
            Check::Clippy => log.step("clippy", clippy),
            Check::Native => log.step("native", native),
            Check::Wasm => wasm(&mut log),
            Check::Types => log.step("types", types),
            Check::Pkg => log.step("pkg", || {
                setup::npm(&root().join("tests/consumers"))?;
                node_tests("tests/pkg")
            }),
            Check::Element => log.step("element", || node_tests("tests/element")),
            Check::Page => log.step("page", || {
                page::page().and_then(|()| node_tests("tests/page"))
            }),
        }
    }
    log.finish()
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
    setup::rust_component("rustfmt")?;
    run(
        cargo().args(["fmt", "--all", "--check"]),
        "run `cargo fmt --all`",
    )
}

fn clippy() -> Result<()> {
    setup::rust_component("clippy")?;
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

/// With threads: the feature adds tests and takes none away.
fn native() -> Result<()> {
    let mut tests = cargo();
    tests.args([
        "test",
        "--quiet",
        "--workspace",
        "--no-fail-fast",
        "--features",
        "pointweave/threads",
    ]);
    run(&mut tests, "native tests failed, see above")
}

/// Every build in every browser, each compiled once.
fn wasm(log: &mut Log) {
    let mut ready = None;
    log.step("wasm: set up", || {
        setup::chromium()?;
        setup::firefox()?;
        ready = Some((
            toolchain::wasm()?,
            setup::wasm_tools()?,
            [
                ("chromium", "CHROMEDRIVER", setup::chromedriver()?),
                ("firefox", "GECKODRIVER", setup::geckodriver()?),
            ],
        ));
        Ok(())
    });
    let Some((toolchain, tools, browsers)) = ready else {
        return;
    };
    for build in Build::ENGINES {
        log.step(&format!("wasm: compile {}", build.name()), || {
            run(
                wasm_tests(build, &toolchain, &tools).arg("--no-run"),
                "the tests did not compile, see above",
            )
        });
        for (browser, variable, driver) in &browsers {
            log.step(&format!("wasm: {} in {browser}", build.name()), || {
                let mut tests = wasm_tests(build, &toolchain, &tools);
                // The runner takes the first driver that any of these names.
                for (_, other, _) in &browsers {
                    tests.env_remove(other);
                }
                tests.env(variable, driver);
                run(
                    &mut tests,
                    &format!("wasm tests failed in {browser}, see above"),
                )
            });
        }
    }
}

fn wasm_tests(build: Build, toolchain: &Toolchain, tools: &Path) -> Command {
    let mut tests = build.cargo(toolchain, "test");
    // By name: documentation tests would take rustdoc from PATH, and it is another compiler's.
    tests.args(["--test", "wasm"]);
    if build == Build::Threads {
        tests.args(["--test", "pool"]);
    }
    tests
        .args(["--no-fail-fast", "--config"])
        .arg(format!(
            "target.{TARGET}.runner=[{:?}, \"test-runner\"]",
            tools.display().to_string()
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
        setup::npm(&root().join(folder))?;
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

/// The tests in a folder, by Node's own runner.
fn node_tests(folder: &str) -> Result<()> {
    for installed in ["pkg", "tests"] {
        setup::npm(&root().join(installed))?;
    }
    let files = files(folder, ".test.mjs")?;
    if files.is_empty() {
        return Err(format!("{folder} holds no *.test.mjs"));
    }
    let mut tests = command("node");
    tests
        .env("CHROMIUM", setup::chromium()?)
        .env("FIREFOX", setup::firefox()?);
    tests.args(["--test", "--test-reporter=spec"]).args(files);
    run(&mut tests, &format!("tests in {folder} failed, see above"))
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

    fn select(options: &[&str]) -> Result<Vec<Check>> {
        selection(
            &options
                .iter()
                .map(|option| option.to_string())
                .collect::<Vec<_>>(),
        )
    }

    #[test]
    fn everything_is_checked_unless_told() {
        assert_eq!(select(&[]).unwrap().len(), Check::ALL.len());
        assert_eq!(
            select(&["--only", "page,fmt"]),
            Ok(vec![Check::Page, Check::Fmt])
        );
    }

    #[test]
    fn an_unknown_check_is_refused() {
        assert!(
            select(&["--only", "fmt,lint"])
                .unwrap_err()
                .contains("fmt,lint")
        );
        assert!(select(&["--only"]).is_err());
        assert!(select(&["wasm"]).is_err());
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
