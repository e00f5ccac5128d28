//! A Rust compiler with the sources of its standard library: both wasm builds compile the library
//! anew, the threads build because the shipped one has no atomics, the other so that a machine
//! needs nothing more.

use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::apt::apt;
use crate::shell::{Result, command, find, output, run, say};

/// Debian's compiler for its browsers, kept current in every release, with sources and linker.
const DEBIAN_PACKAGES: [&str; 5] = [
    "rustc-web",
    "cargo-web",
    "rust-web-src",
    "rust-web-llvm",
    "lld-22",
];

/// The compiler that makes wasm.
#[derive(Debug, PartialEq)]
pub enum Toolchain {
    /// One of rustup's, by name.
    Rustup(String),
    /// The rustc and cargo that PATH finds, of no rustup.
    Path,
    /// Debian's packages.
    Debian,
}

impl Toolchain {
    /// Its cargo, set to use its own rustc only.
    pub fn cargo(&self) -> Command {
        match self {
            Self::Rustup(name) => {
                let mut cargo = command("cargo");
                cargo.env("RUSTUP_TOOLCHAIN", name).env_remove("RUSTC");
                cargo
            }
            Self::Path => command("cargo"),
            Self::Debian => {
                let mut cargo = command("/usr/bin/cargo");
                cargo
                    .env(
                        "PATH",
                        debian_first(env::var_os("PATH").unwrap_or_default()),
                    )
                    .env("RUSTC", "/usr/bin/rustc")
                    // Set by the cargo and rustup that run xtask, for their own compiler.
                    .env_remove("LD_LIBRARY_PATH")
                    .env_remove("RUSTUP_TOOLCHAIN");
                cargo
            }
        }
    }

    fn rustc(&self) -> Command {
        match self {
            Self::Rustup(name) => {
                let mut rustc = command("rustc");
                rustc.env("RUSTUP_TOOLCHAIN", name);
                rustc
            }
            Self::Path => command("rustc"),
            Self::Debian => command("/usr/bin/rustc"),
        }
    }

    /// New enough, with the sources of its standard library.
    fn is_complete(&self) -> bool {
        let version = output(self.rustc().arg("--version"));
        let sysroot = output(self.rustc().args(["--print", "sysroot"]));
        version.is_some_and(|version| is_new_enough(&version))
            && sysroot.is_some_and(|sysroot| has_library_sources(Path::new(&sysroot)))
    }
}

/// Whether `rustc 1.96.0 (…)` can compile the workspace.
fn is_new_enough(version: &str) -> bool {
    let number = version.split_whitespace().nth(1).unwrap_or_default();
    minor(number) >= minor(env!("CARGO_PKG_RUST_VERSION"))
}

/// 96 of 1.96.0.
fn minor(version: &str) -> Option<u32> {
    version.split('.').nth(1)?.parse().ok()
}

fn has_library_sources(sysroot: &Path) -> bool {
    sysroot
        .join("lib/rustlib/src/rust/library/std/Cargo.toml")
        .is_file()
}

fn debian_first(path: OsString) -> OsString {
    let folders = std::iter::once(PathBuf::from("/usr/bin")).chain(env::split_paths(&path));
    env::join_paths(folders).expect("folders that PATH held already")
}

/// The first complete one that is there.
pub fn installed() -> Option<Toolchain> {
    let debian = Path::new("/usr/bin/rustc")
        .is_file()
        .then_some(Toolchain::Debian);
    rustup_toolchains()
        .into_iter()
        .map(Toolchain::Rustup)
        .chain([Toolchain::Path])
        .chain(debian)
        .find(Toolchain::is_complete)
}

/// The first complete one of: what is there, rustup's after it may add the sources, Debian's.
pub fn wasm() -> Result<Toolchain> {
    if let Some(complete) = installed() {
        return Ok(complete);
    }
    let rustup = rustup_toolchains();
    let rustup_may = env::var("RUSTUP_AUTO_INSTALL").as_deref() != Ok("0");
    if let (Some(name), true) = (rustup.first(), rustup_may) {
        say(&format!(
            "installing rust-src for {name} with rustup: wasm builds compile std anew"
        ));
        let add = ["component", "add", "rust-src", "--toolchain", name];
        if run(command("rustup").args(add), "rustup could not").is_ok() {
            return Ok(Toolchain::Rustup(name.clone()));
        }
    }
    apt(
        &DEBIAN_PACKAGES,
        "a compiler with the sources of its standard library",
        "run `rustup component add rust-src`, or take a machine with apt",
    )?;
    if Toolchain::Debian.is_complete() {
        return Ok(Toolchain::Debian);
    }
    Err("Debian's rustc-web came without its sources; run `rustup component add rust-src`".into())
}

/// Names of rustup's toolchains, the active one first; empty without rustup.
fn rustup_toolchains() -> Vec<String> {
    if find("rustup").is_none() {
        return Vec::new();
    }
    let active = output(command("rustup").args(["show", "active-toolchain"])).unwrap_or_default();
    let all = output(command("rustup").args(["toolchain", "list"])).unwrap_or_default();
    active_first(&active, &all)
}

fn active_first(active: &str, all: &str) -> Vec<String> {
    let name = |line: &str| line.split_whitespace().next().map(String::from);
    let mut names: Vec<String> = all.lines().filter_map(name).collect();
    if let Some(active) = active.lines().next().and_then(name) {
        names.retain(|other| *other != active);
        names.insert(0, active);
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_active_toolchain_comes_first_and_once() {
        let active = "1.95-x86_64-unknown-linux-gnu (overridden by RUSTUP_TOOLCHAIN)";
        let all =
            "stable-x86_64-unknown-linux-gnu (default)\n1.95-x86_64-unknown-linux-gnu (active)\n";
        assert_eq!(
            active_first(active, all),
            [
                "1.95-x86_64-unknown-linux-gnu",
                "stable-x86_64-unknown-linux-gnu"
            ]
        );
        assert_eq!(active_first("", ""), Vec::<String>::new());
    }

    #[test]
    fn an_old_compiler_will_not_do() {
        assert!(is_new_enough(
            "rustc 1.196.0 (ac68faa20 2036-05-25) (built from a source tarball)"
        ));
        assert!(!is_new_enough(
            "rustc 1.72.0-nightly (0ab38e95b 2023-05-25)"
        ));
        assert!(!is_new_enough(""));
    }

    #[test]
    fn debian_comes_first_on_path() {
        assert_eq!(
            debian_first("/opt/bin:/usr/bin".into()),
            "/usr/bin:/opt/bin:/usr/bin"
        );
    }
}
