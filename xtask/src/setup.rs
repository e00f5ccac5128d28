//! What is missing, installed: said before it is done, and nothing done when nothing is missing.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::shell::{Result, cargo, command, find, output, root, run, say};
use crate::toolchain;

/// `cargo xtask setup`: what any command needs.
pub fn everything() -> Result<()> {
    toolchain::wasm()?;
    rust_component("rustfmt")?;
    rust_component("clippy")?;
    wasm_tools()?;
    for folder in ["xtask", "pkg", "www", "tests", "tests/consumers"] {
        npm(&root().join(folder))?;
    }
    chromium()?;
    chromedriver()?;
    firefox()?;
    geckodriver()?;
    if let Err(sentence) = skfuzzy() {
        say(&format!("{sentence}; only a benchmark wants it"));
    }
    Ok(())
}

/// Debian packages, by apt. `otherwise` says what to do where that is impossible.
pub fn apt(packages: &[&str], what: &str, otherwise: &str) -> Result<()> {
    let list = packages.join(" ");
    if find("apt-get").is_none() {
        return Err(format!("{what} is missing; {otherwise}"));
    }
    let by_hand =
        format!("{what} could not be installed; run `sudo apt-get install {list}`, or {otherwise}");
    let is_root = output(command("id").arg("-u")).as_deref() == Some("0");
    if !is_root && output(command("sudo").args(["-n", "true"])).is_none() {
        return Err(by_hand);
    }
    say(&format!("installing {list} with apt: {what}"));
    let apt_get = |args: &[&str]| {
        let mut apt_get = if is_root {
            command("apt-get")
        } else {
            command("sudo")
        };
        if !is_root {
            apt_get.arg("apt-get");
        }
        apt_get
            .env("DEBIAN_FRONTEND", "noninteractive")
            .args(["-qq", "-o", "Dpkg::Use-Pty=0"])
            .args(args);
        // What apt prints is no result of the command that is running.
        apt_get.stdout(std::io::stderr());
        apt_get
    };
    static UPDATED: OnceLock<Result<()>> = OnceLock::new();
    let update = UPDATED.get_or_init(|| run(&mut apt_get(&["update"]), "apt-get update failed"));
    let mut install = vec!["install", "--yes", "--no-install-recommends"];
    install.extend(packages);
    run(&mut apt_get(&install), &by_hand).map_err(|error| match update {
        Ok(()) => error,
        Err(update) => format!("{error} ({update}: is the network there?)"),
    })
}

/// `cargo fmt` or `cargo clippy` for the compiler that runs xtask.
pub fn rust_component(name: &str) -> Result<()> {
    let subcommand = if name == "rustfmt" { "fmt" } else { name };
    if output(cargo().args([subcommand, "--version"])).is_some() {
        return Ok(());
    }
    let remedy = format!("`cargo {subcommand}` is missing; run `rustup component add {name}`");
    if env::var("RUSTUP_AUTO_INSTALL").as_deref() == Ok("0") || find("rustup").is_none() {
        return Err(remedy);
    }
    say(&format!("installing {name} with rustup"));
    run(command("rustup").args(["component", "add", name]), &remedy)
}

/// wasm-bindgen's tools, of the version that Cargo.lock gives the library.
pub fn wasm_tools() -> Result<PathBuf> {
    let target = root().join("target");
    let program = target.join(format!("xtask/wasm-tools{}", env::consts::EXE_SUFFIX));
    if !program.is_file() {
        say("building wasm-bindgen's tools, once: about 3 minutes on 2 cores");
    }
    run(
        cargo()
            .args([
                "build",
                "--quiet",
                "--package",
                "xtask",
                "--profile",
                "xtask",
            ])
            .args(["--features", "wasm-tools", "--bin", "wasm-tools"])
            .arg("--target-dir")
            .arg(target),
        "wasm-bindgen's tools did not build; their errors are above",
    )?;
    Ok(program)
}

/// `npm ci` in a folder that has a lock file, unless what it would install is there already.
pub fn npm(folder: &Path) -> Result<()> {
    let lock = folder.join("package-lock.json");
    if !lock.is_file() {
        return Ok(());
    }
    let stamp = folder.join("node_modules/.installed-lock.json");
    unless_installed(&lock, &stamp, || {
        if find("node").is_none() || find("npm").is_none() {
            return Err(
                "Node and npm are missing; install Node 20 or newer from nodejs.org".into(),
            );
        }
        say(&format!(
            "installing what {} locks, with npm",
            lock.display()
        ));
        let mut npm = command("npm");
        npm.current_dir(folder)
            .args(["ci", "--no-audit", "--no-fund", "--loglevel=error"])
            .stdout(std::io::stderr());
        run(
            &mut npm,
            &format!(
                "`npm ci` failed in {}; is the network there?",
                folder.display()
            ),
        )
    })
}

/// A Python with scikit-fuzzy.
pub fn skfuzzy() -> Result<PathBuf> {
    python("skfuzzy", "scikit-fuzzy")
}

/// A Python with Open3D.
pub fn open3d() -> Result<PathBuf> {
    python("open3d", "Open3D")
}

/// A Python with what tests/bench/`name`.txt lists, in a virtual environment in target/.
fn python(name: &str, what: &str) -> Result<PathBuf> {
    let requirements = root().join(format!("tests/bench/{name}.txt"));
    let environment = root().join("target").join(name);
    let python = environment.join(if cfg!(windows) {
        "Scripts/python.exe"
    } else {
        "bin/python"
    });
    let stamp = environment.join("installed-requirements.txt");
    unless_installed(&requirements, &stamp, || {
        let system = find("python3")
            .or_else(|| find("python"))
            .ok_or("Python is missing; install Python 3.11 or newer with venv and pip")?;
        say(&format!(
            "installing {what} into {} with pip",
            environment.display()
        ));
        let mut venv = command(system);
        venv.args(["-m", "venv", "--clear"]).arg(&environment);
        run(
            venv.stdout(std::io::stderr()),
            "Python's venv or pip is missing; install both (Debian's package is python3-venv)",
        )?;
        let mut pip = command(&python);
        pip.args(["-m", "pip", "install", "--quiet", "--requirement"])
            .arg(&requirements);
        run(
            pip.stdout(std::io::stderr()),
            "pip failed; is the network there, and Python 3.11 or newer?",
        )
    })?;
    Ok(python)
}

/// Installs what a lock file names, unless `stamp`, the lock that was last installed in full, is the same.
fn unless_installed(lock: &Path, stamp: &Path, install: impl FnOnce() -> Result<()>) -> Result<()> {
    let wanted =
        fs::read(lock).map_err(|error| format!("{} cannot be read: {error}", lock.display()))?;
    if fs::read(stamp).is_ok_and(|installed| installed == wanted) {
        return Ok(());
    }
    install()?;
    fs::create_dir_all(stamp.parent().expect("a folder holds it"))
        .and_then(|()| fs::write(stamp, wanted))
        .map_err(|error| format!("{} cannot be written: {error}", stamp.display()))
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_lock_that_was_not_installed_in_full_is_installed() {
        let folder = env::temp_dir().join(format!("pointweave-setup-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let (lock, stamp) = (folder.join("lock"), folder.join("installed/lock"));
        fs::write(&lock, "one").unwrap();
        let refused = || Err("refused".into());
        assert!(unless_installed(&lock, &stamp, refused).is_err());
        assert!(!stamp.exists());
        assert_eq!(unless_installed(&lock, &stamp, || Ok(())), Ok(()));
        assert_eq!(unless_installed(&lock, &stamp, refused), Ok(()));
        fs::write(&lock, "two").unwrap();
        assert!(unless_installed(&lock, &stamp, refused).is_err());
        fs::remove_dir_all(&folder).unwrap();
    }
}
