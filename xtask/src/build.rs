//! The wasm builds: the engine with and without threads (DESIGN: "Two builds, one code"), and the readers of
//! files, in modules that are loaded when such a file comes.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::glue;
use crate::options;
use crate::setup;
use crate::shell::{Result, command, root, run, say};
use crate::toolchain::{self, Toolchain};

/// One of the wasm builds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Build {
    /// One thread and no atomics: runs on every page.
    Single,
    /// A pool of workers over shared memory: needs a cross-origin isolated page, or Node.
    Threads,
    /// The readers of files that are small, alone.
    Files,
    /// The reader of LAS and LAZ alone.
    Las,
    /// The reader of E57 alone.
    E57,
}

impl Build {
    pub const ALL: [Build; 5] = [
        Build::Single,
        Build::Threads,
        Build::Files,
        Build::Las,
        Build::E57,
    ];
    /// Those with the whole engine.
    pub const ENGINES: [Build; 2] = [Build::Single, Build::Threads];

    pub fn name(self) -> &'static str {
        match self {
            Self::Single => "single",
            Self::Threads => "threads",
            Self::Files => "files",
            Self::Las => "las",
            Self::E57 => "e57",
        }
    }

    /// Features of the crate.
    fn features(self) -> &'static str {
        match self {
            Self::Single => "engine",
            Self::Threads => "engine,threads",
            Self::Files => "files",
            Self::Las => "las",
            Self::E57 => "e57",
        }
    }

    /// Arguments for rustc. Builds with others keep apart target folders, or each would undo the other.
    fn rust_flags(self) -> Vec<String> {
        let strings = |flags: &[&str]| flags.iter().map(|flag| flag.to_string()).collect();
        match self {
            Self::Single | Self::Files | Self::Las | Self::E57 => {
                strings(&["-Ctarget-feature=+simd128"])
            }
            Self::Threads => {
                let mut flags: Vec<String> = strings(&[
                    "-Ctarget-feature=+atomics,+bulk-memory,+simd128",
                    "-Clink-arg=--shared-memory",
                    "-Clink-arg=--import-memory",
                    // Shared memory states its limit; this is all that wasm32 can address. Whoever
                    // makes the memory may choose less.
                    "-Clink-arg=--max-memory=4294967296",
                    // Whoever makes it has to know this, too: `pkg/engine/memory.js`.
                    "-Clink-arg=--initial-memory=4194304",
                ]);
                // What wasm-bindgen needs to give every thread its own stack and statics.
                for symbol in [
                    "__wasm_init_tls",
                    "__tls_size",
                    "__tls_align",
                    "__tls_base",
                    "__heap_base",
                ] {
                    flags.push(format!("-Clink-arg=--export={symbol}"));
                }
                flags
            }
        }
    }

    pub fn target_dir(self) -> PathBuf {
        let threads = if self == Self::Threads {
            "threads"
        } else {
            "single"
        };
        root().join("target").join(format!("wasm-{threads}"))
    }

    /// `cargo <action>` for this build, release profile.
    pub fn cargo(self, toolchain: &Toolchain, action: &str) -> Command {
        let mut cargo = toolchain.cargo();
        cargo
            .args([
                action,
                "--package",
                "pointweave",
                "--release",
                "--target",
                TARGET,
            ])
            // Without panic_unwind: wasm aborts on panic.
            .arg("-Zbuild-std=std,panic_abort")
            .arg("--target-dir")
            .arg(self.target_dir())
            // Lets a stable compiler build its own standard library.
            .env("RUSTC_BOOTSTRAP", "1")
            // The one way that keeps spaces and overrides whatever flags the environment has.
            .env("CARGO_ENCODED_RUSTFLAGS", self.rust_flags().join("\u{1f}"));
        cargo.args(["--no-default-features", "--features", self.features()]);
        cargo
    }
}

pub const TARGET: &str = "wasm32-unknown-unknown";

/// Features that the two builds may use, one by one: with `--all-features` wasm-opt writes
/// instructions that no browser has yet.
const WASM_OPT_FEATURES: [&str; 8] = [
    "--enable-simd",
    "--enable-bulk-memory",
    "--enable-bulk-memory-opt",
    "--enable-nontrapping-float-to-int",
    "--enable-sign-ext",
    "--enable-mutable-globals",
    "--enable-reference-types",
    "--enable-multivalue",
];

/// `cargo xtask build`: what is written from the table of options, and pkg/wasm/single, threads, files, las and e57.
pub fn build() -> Result<()> {
    options::write()?;
    let toolchain = toolchain::wasm()?;
    let tools = setup::wasm_tools()?;
    setup::npm(&root().join("xtask"))?;
    for build in Build::ALL {
        say(&format!("building wasm, {}", build.name()));
        run(
            build.cargo(&toolchain, "build").args(["--quiet", "--lib"]),
            "the wasm build failed; its errors are above",
        )?;
        let wasm = build
            .target_dir()
            .join(TARGET)
            .join("release/pointweave.wasm");
        let out = root().join("pkg/wasm").join(build.name());
        let made = out.join("pointweave_bg.wasm");
        if !is_newer(&made, &[&wasm, &tools, &this_program()?]) {
            let part = build.target_dir().join("pkg");
            bind(&tools, &wasm, &part)?;
            optimise(build, &part.join("pointweave_bg.wasm"))?;
            replace(&part, &out)?;
        }
    }
    Ok(())
}

/// Whether a file is there and no older than those that it was made from and by.
fn is_newer(made: &Path, from: &[&Path]) -> bool {
    let time = |file: &Path| {
        fs::metadata(file)
            .and_then(|metadata| metadata.modified())
            .ok()
    };
    let made = time(made);
    made.is_some() && from.iter().all(|file| time(file) <= made)
}

fn this_program() -> Result<PathBuf> {
    std::env::current_exe()
        .map_err(|error| format!("xtask cannot find itself ({error}); run it by `cargo xtask`"))
}

/// The JavaScript side, as modules that a page, a worker and Node load alike.
fn bind(tools: &Path, wasm: &Path, out: &Path) -> Result<()> {
    let mut bindgen = command(tools);
    bindgen
        .args(["bindgen", "--target", "web", "--remove-producers-section"])
        .args(["--no-typescript", "--omit-default-module-path"])
        .arg("--out-dir")
        .arg(out)
        .arg(wasm);
    run(&mut bindgen, "wasm-bindgen failed; its error is above")?;
    glue::make_factory(&out.join("pointweave.js"))
}

fn optimise(build: Build, wasm: &Path) -> Result<()> {
    let mut wasm_opt = command("node");
    wasm_opt
        .arg("xtask/node_modules/binaryen/bin/wasm-opt")
        .args(WASM_OPT_FEATURES);
    if build == Build::Threads {
        wasm_opt.arg("--enable-threads");
    }
    let before = size(wasm);
    // Without a limit it would undo `par::call`.
    wasm_opt.args(["--one-caller-inline-max-function-size", "20"]);
    wasm_opt.arg("-O3").arg(wasm).arg("-o").arg(wasm);
    run(&mut wasm_opt, "wasm-opt failed; its error is above")?;
    let after = size(wasm);
    say(&format!("wasm-opt: {before} kB to {after} kB"));
    Ok(())
}

/// Moves a finished folder into place: a build that is stopped halfway leaves the last one as it was.
fn replace(part: &Path, out: &Path) -> Result<()> {
    let parent = out.parent().expect("pkg/wasm");
    let moved = fs::create_dir_all(parent)
        .and_then(|()| {
            if out.exists() {
                fs::remove_dir_all(out)
            } else {
                Ok(())
            }
        })
        .and_then(|()| fs::rename(part, out));
    moved.map_err(|error| format!("{} cannot be replaced: {error}", out.display()))
}

fn size(file: &Path) -> u64 {
    fs::metadata(file).map_or(0, |metadata| metadata.len() / 1000)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_threads_build_has_atomics() {
        assert!(!Build::Single.rust_flags().concat().contains("atomics"));
        assert!(Build::Threads.rust_flags().concat().contains("+atomics"));
        assert_ne!(Build::Single.target_dir(), Build::Threads.target_dir());
    }

    #[test]
    fn what_is_missing_or_older_is_made_again() {
        let folder = std::env::temp_dir().join(format!("pointweave-xtask-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let (source, made) = (folder.join("source"), folder.join("made"));
        fs::write(&source, "").unwrap();
        assert!(!is_newer(&made, &[&source]));
        fs::write(&made, "").unwrap();
        assert!(is_newer(&made, &[&source]));
        let later =
            fs::metadata(&made).unwrap().modified().unwrap() + std::time::Duration::from_secs(1);
        fs::File::open(&source)
            .unwrap()
            .set_modified(later)
            .unwrap();
        assert!(!is_newer(&made, &[&source]));
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn both_builds_have_simd() {
        for build in Build::ALL {
            assert!(
                build.rust_flags().concat().contains("+simd128"),
                "{}",
                build.name()
            );
        }
    }
}
