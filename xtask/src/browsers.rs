//! Browsers for tests, and their drivers: those that the environment names, or what is found, or installed.

use std::env;
use std::path::PathBuf;

use crate::apt::apt;
use crate::shell::{Result, cargo, find, root, run, say};

/// The browser for page tests: `CHROMIUM`, or what is found, or Debian's.
pub fn chromium() -> Result<PathBuf> {
    let names = [
        "chromium",
        "chromium-browser",
        "google-chrome-stable",
        "google-chrome",
    ];
    let mac = ["/Applications/Google Chrome.app/Contents/MacOS/Google Chrome"];
    let found = || {
        let mac = mac.iter().map(PathBuf::from).find(|path| path.is_file());
        named("CHROMIUM")
            .or_else(|| names.iter().find_map(|name| find(name)))
            .or(mac)
    };
    found_or_apt(
        found,
        "chromium",
        "Chromium",
        "install Chrome or Chromium, or set CHROMIUM",
    )
}

/// The driver for wasm tests in Chromium: `CHROMEDRIVER`, or what is found, or Debian's.
pub fn chromedriver() -> Result<PathBuf> {
    let found = || named("CHROMEDRIVER").or_else(|| find("chromedriver"));
    found_or_apt(
        found,
        "chromium-driver",
        "Chromium's driver",
        "install chromedriver, or set CHROMEDRIVER",
    )
}

/// The other browser: `FIREFOX`, or what is found, or Debian's.
pub fn firefox() -> Result<PathBuf> {
    let found = || {
        let mac = PathBuf::from("/Applications/Firefox.app/Contents/MacOS/firefox");
        named("FIREFOX")
            .or_else(|| find("firefox-esr"))
            .or_else(|| find("firefox"))
            .or(Some(mac).filter(|path| path.is_file()))
    };
    found_or_apt(
        found,
        "firefox-esr",
        "Firefox",
        "install Firefox, or set FIREFOX",
    )
}

/// Mozilla releases no Debian package of it, and its builds are on a site that not every machine reaches.
const GECKODRIVER: &str = "geckodriver@0.37.1";

/// The driver for wasm tests in Firefox: `GECKODRIVER`, or what is found, or built.
pub fn geckodriver() -> Result<PathBuf> {
    let own = root().join("target/tools");
    let built = own
        .join("bin")
        .join(format!("geckodriver{}", env::consts::EXE_SUFFIX));
    let found = || {
        named("GECKODRIVER")
            .or_else(|| find("geckodriver"))
            .or(Some(built.clone()).filter(|path| path.is_file()))
    };
    if let Some(driver) = found() {
        return Ok(driver);
    }
    say("building geckodriver with cargo, once: about 2 minutes on 2 cores");
    run(
        cargo()
            .args(["install", GECKODRIVER, "--quiet", "--locked"])
            // It only passes messages on: fast to build counts, not fast to run.
            .args(["--debug", "--config", "profile.dev.debug=false", "--root"])
            .arg(&own),
        "geckodriver did not build; install it from github.com/mozilla/geckodriver and set GECKODRIVER",
    )?;
    Ok(built)
}

fn named(variable: &str) -> Option<PathBuf> {
    env::var_os(variable)
        .filter(|value| !value.is_empty())
        .map(PathBuf::from)
}

fn found_or_apt(
    find: impl Fn() -> Option<PathBuf>,
    package: &str,
    what: &str,
    otherwise: &str,
) -> Result<PathBuf> {
    if let Some(program) = find() {
        return Ok(program);
    }
    apt(&[package], what, otherwise)?;
    find().ok_or_else(|| {
        format!("{what} is not where it was expected after its installation; {otherwise}")
    })
}
