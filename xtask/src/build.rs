//! The wasm builds: the engine with and without threads, from one code, and readers, decoders and writers of files, in modules
//! that are loaded when such a file comes.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;
use std::time::SystemTime;

use crate::options;
use crate::packages;
use crate::shell::{Result, command, root, run, say};
use crate::toolchain::{self, Toolchain};
use crate::tools;
use crate::wasm_bindings;

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
    /// The decoders of textures' pictures alone.
    Pictures,
    /// The writers alone.
    Exports,
    /// Recipes alone: what is cut before a reduction.
    Prepare,
    /// Meshes with fewer triangles alone.
    Light,
    /// The steps of tiles alone.
    Tiles,
    /// Sample scans alone.
    Samples,
    /// The readers of what is packed as a whole.
    Packed,
}

impl Build {
    pub const ALL: [Build; 12] = [
        Build::Single,
        Build::Threads,
        Build::Files,
        Build::Las,
        Build::E57,
        Build::Pictures,
        Build::Exports,
        Build::Samples,
        Build::Packed,
        Build::Prepare,
        Build::Light,
        Build::Tiles,
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
            Self::Pictures => "pictures",
            Self::Exports => "exports",
            Self::Prepare => "prepare",
            Self::Light => "light",
            Self::Tiles => "tiles",
            Self::Samples => "samples",
            Self::Packed => "packed",
        }
    }

    /// Features of the crate.
    fn features(self) -> &'static str {
        match self {
            Self::Single => "engine",
            Self::Threads => "engine,threads",
            other => other.name(),
        }
    }

    /// Arguments for rustc. Builds with others keep apart target folders, or each would undo the other.
    fn rust_flags(self) -> Vec<String> {
        let strings = |flags: &[&str]| flags.iter().map(|flag| flag.to_string()).collect();
        match self {
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
            _ => strings(&["-Ctarget-feature=+simd128"]),
        }
    }

    /// The finished module.
    fn module(self) -> PathBuf {
        let folder = root().join("pkg/wasm").join(self.name());
        folder.join("pointweave_bg.wasm")
    }

    /// Whether the finished module is there and no source is newer.
    pub fn is_current(self) -> bool {
        let made = newest(&[self.module()]);
        let sources: Vec<PathBuf> = SOURCES
            .iter()
            .chain(&MAKERS)
            .map(|path| root().join(path))
            .collect();
        made.is_some() && newest(&sources) <= made
    }

    pub fn target_dir(self) -> PathBuf {
        let threads = if self == Self::Threads {
            "threads"
        } else {
            "single"
        };
        root().join("target").join(format!("wasm-{threads}"))
    }

    /// `cargo <action>` for this build, in a profile of Cargo.toml.
    pub fn cargo(self, toolchain: &Toolchain, action: &str, profile: &str) -> Command {
        let mut cargo = toolchain.cargo();
        let mut flags = self.rust_flags();
        if profile == "release" {
            // A panic names its file, not line and column, which are 2 % of a module.
            flags.push("-Zlocation-detail=file".into());
        }
        cargo
            .args([
                action,
                "--package",
                "pointweave",
                "--profile",
                profile,
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
            .env("CARGO_ENCODED_RUSTFLAGS", flags.join("\u{1f}"));
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

/// [`build`] of the modules of these names, or of all where there is none.
pub fn build_these(names: &[String]) -> Result<()> {
    let named = |name: &String| {
        let known = Build::ALL.into_iter().find(|build| build.name() == name);
        known.ok_or_else(|| {
            let all = Build::ALL.map(Build::name).join(", ");
            format!("there is no module `{name}`; there are {all}")
        })
    };
    let builds: Vec<Build> = names.iter().map(named).collect::<Result<_>>()?;
    if builds.is_empty() {
        return build();
    }
    make(&builds)
}

/// `cargo xtask build`: what is written from the table of options, the builds of pkg/wasm and the element in one file.
pub fn build() -> Result<()> {
    make(&Build::ALL)
}

/// The builds that are older than the sources: the quick way for tests.
pub fn ensure() -> Result<()> {
    let is_old = |build: &Build| !build.is_current();
    let old: Vec<Build> = Build::ALL.into_iter().filter(is_old).collect();
    if old.is_empty() {
        options::write()?;
        return one_file();
    }
    make(&old)
}

fn make(builds: &[Build]) -> Result<()> {
    options::write()?;
    let builder = Builder::ready()?;
    let begin = |build: Build| say(&format!("building wasm, {}", build.name()));
    let (threads, others): (Vec<Build>, Vec<Build>) =
        (builds.iter().copied()).partition(|&build| build == Build::Threads);
    // Two target folders, so two at once: the optimiser of a build takes one core.
    thread::scope(|scope| {
        let beside = scope.spawn(|| builder.make_all(&threads, begin));
        let made = builder.make_all(&others, begin);
        beside.join().expect("no panic").and(made)
    })?;
    one_file()
}

/// `pkg/element.min.js` and `pkg/element-tiles.min.js`, made of the package's modules in no time.
fn one_file() -> Result<()> {
    packages::npm(&root().join("xtask"))?;
    let remedy = "the element's one file was not made; the error is above";
    run(command("node").arg("xtask/element.mjs"), remedy)
}

/// What the builds are made with.
pub struct Builder {
    toolchain: Toolchain,
    bindgen: PathBuf,
}

impl Builder {
    /// Installs what is missing.
    pub fn ready() -> Result<Self> {
        let toolchain = toolchain::wasm()?;
        let bindgen = tools::bindgen()?;
        packages::npm(&root().join("xtask"))?;
        Ok(Self { toolchain, bindgen })
    }

    /// Makes these modules. While one is finished, which takes one core, the next is compiled.
    pub fn make_all(&self, builds: &[Build], mut begin: impl FnMut(Build)) -> Result<()> {
        thread::scope(|scope| {
            let mut finishing: Option<thread::ScopedJoinHandle<Result<()>>> = None;
            for &build in builds {
                begin(build);
                let compiled = self.compile(build)?;
                if let Some(last) = finishing.take() {
                    last.join().expect("no panic")?;
                }
                if let Some(part) = compiled {
                    finishing = Some(scope.spawn(move || finish(build, &part)));
                }
            }
            finishing.map_or(Ok(()), |last| last.join().expect("no panic"))
        })
    }

    /// The module as wasm-bindgen leaves it, or nothing if the finished one is already made of what the compiler wrote.
    fn compile(&self, build: Build) -> Result<Option<PathBuf>> {
        run(
            build
                .cargo(&self.toolchain, "build", "release")
                .args(["--quiet", "--lib"]),
            "the wasm build failed; its errors are above",
        )?;
        let wasm = build
            .target_dir()
            .join(TARGET)
            .join("release/pointweave.wasm");
        let made = build.module();
        let is_current = is_newer(&made, &[&wasm, &self.bindgen])
            && newest(&MAKERS.map(|path| root().join(path))) <= newest(std::slice::from_ref(&made));
        if is_current {
            return touch(&made).map(|()| None);
        }
        let part = build.target_dir().join(format!("pkg-{}", build.name()));
        bind(&self.bindgen, &wasm, &part)?;
        Ok(Some(part))
    }
}

/// Optimises a module and moves it into place.
fn finish(build: Build, part: &Path) -> Result<()> {
    optimise(build, &part.join("pointweave_bg.wasm"))?;
    replace(part, build.module().parent().expect("a folder of pkg/wasm"))
}

/// Where the sources of every build are.
const SOURCES: [&str; 3] = ["src", "Cargo.toml", "Cargo.lock"];
/// What says how a module is made of what the compiler wrote.
const MAKERS: [&str; 3] = [
    "xtask/src/build.rs",
    "xtask/src/wasm_bindings.rs",
    "xtask/src/bin/bindgen.rs",
];

/// The time of the newest file of these files and folders.
pub fn newest(paths: &[PathBuf]) -> Option<SystemTime> {
    let time = |path: &PathBuf| match fs::read_dir(path) {
        Ok(entries) => {
            let inside: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
            newest(&inside)
        }
        Err(_) => fs::metadata(path).and_then(|file| file.modified()).ok(),
    };
    paths.iter().filter_map(time).max()
}

/// Marks a file as made now.
fn touch(file: &Path) -> Result<()> {
    fs::File::options()
        .append(true)
        .open(file)
        .and_then(|opened| opened.set_modified(SystemTime::now()))
        .map_err(|error| format!("{} cannot be touched: {error}", file.display()))
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

/// The JavaScript side, as modules that a page, a worker and Node load alike.
fn bind(bindgen: &Path, wasm: &Path, out: &Path) -> Result<()> {
    run(
        command(bindgen).arg(wasm).arg(out),
        "wasm-bindgen failed; its error is above",
    )?;
    wasm_bindings::make_factory(&out.join("pointweave.js"))
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
    say(&format!(
        "wasm-opt, {}: {before} kB to {after} kB",
        build.name()
    ));
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
