//! The page for production, in www/dist.

use std::path::PathBuf;

use crate::build::{Build, newest};
use crate::packages;
use crate::shell::{Result, command, root, run, say};

/// What the page is made of, besides pkg/.
const SOURCES: [&str; 6] = [
    "www/index.html",
    "www/package-lock.json",
    "www/public",
    "www/service-worker.js",
    "www/src",
    "www/vite.config.js",
];

/// Builds the page. It imports the package, so that has to be built before; what is `missing` of it is left out, and the page
/// says so.
pub fn build(missing: &[Build]) -> Result<()> {
    packages::npm(&root().join("www"))?;
    let names: Vec<&str> = missing.iter().map(|build| build.name()).collect();
    let mut vite = command("npm");
    vite.current_dir(root().join("www"))
        .args(["run", "--silent", "build"])
        .env("POINTWEAVE_BUILDING", names.join(","));
    run(&mut vite, "the page did not build; its errors are above")
}

/// Builds the page unless nothing that it is made of is newer.
pub fn ensure() -> Result<()> {
    let built = root().join("www/dist");
    let made = newest(&[built.join("service-worker.js")]);
    let sources: Vec<PathBuf> = SOURCES
        .iter()
        .chain(&["pkg"])
        .map(|path| root().join(path))
        .collect();
    if made.is_some() && newest(&sources) <= made {
        return Ok(());
    }
    say("building the page");
    build(&[])
}
