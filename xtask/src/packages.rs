//! What npm and pip install: nothing while what a lock file names is there.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::shell::{Result, command, find, root, run, say};

/// `npm ci` in a folder that has a lock file, unless what it would install is there already.
pub fn npm(folder: &Path) -> Result<()> {
    let (lock, stamp) = npm_files(folder);
    if !lock.is_file() {
        return Ok(());
    }
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

/// Whether [`npm`] has nothing to do in a folder.
pub fn npm_is_installed(folder: &Path) -> bool {
    let (lock, stamp) = npm_files(folder);
    !lock.is_file() || is_installed(&lock, &stamp)
}

/// The lock file of a folder, and that of what was installed last.
fn npm_files(folder: &Path) -> (PathBuf, PathBuf) {
    (
        folder.join("package-lock.json"),
        folder.join("node_modules/.installed-lock.json"),
    )
}

/// A Python with scikit-fuzzy.
pub fn skfuzzy() -> Result<PathBuf> {
    python("skfuzzy", "scikit-fuzzy")
}

/// A Python with Open3D.
pub fn open3d() -> Result<PathBuf> {
    python("open3d", "Open3D")
}

/// A Python with what simplifies meshes.
pub fn simplify() -> Result<PathBuf> {
    python("simplify", "Open3D and PyMeshLab")
}

/// A Python with what makes tilesets and what measures them.
pub fn tiles() -> Result<PathBuf> {
    python("tiles", "py3dtiles and what measures tilesets")
}

/// A Python with libraries of other people's for the formats of scans.
pub fn formats() -> Result<PathBuf> {
    python("formats", "readers and writers of scans")
}

/// A Python with what tests/bench/`name`.txt lists, in a virtual environment in target/.
fn python(name: &str, what: &str) -> Result<PathBuf> {
    let requirements = root().join(format!("tests/bench/{name}.txt"));
    let python = environment(name);
    installed(&python, &requirements, what, |pip| {
        pip.arg("--requirement").arg(&requirements)
    })?;
    Ok(python)
}

/// A Python with the package in cluster/ as it stands, and what tests it.
pub fn cluster() -> Result<PathBuf> {
    let python = environment("cluster");
    let described = root().join("cluster/pyproject.toml");
    installed(&python, &described, "Dask and what tests with it", |pip| {
        pip.arg("./cluster[test]")
    })?;
    let mut pip = pip(&python);
    pip.args(["--no-deps", "--force-reinstall", "./cluster"]);
    run(
        &mut pip,
        "the wheel of cluster/ cannot be built; its error is above",
    )?;
    Ok(python)
}

/// The Python of a virtual environment in target/.
fn environment(name: &str) -> PathBuf {
    let python = if cfg!(windows) {
        "Scripts/python.exe"
    } else {
        "bin/python"
    };
    root().join("target").join(name).join(python)
}

/// `pip install` in a virtual environment that is made anew, unless what `lock` names was installed last.
fn installed(
    python: &Path,
    lock: &Path,
    what: &str,
    arguments: impl FnOnce(&mut Command) -> &mut Command,
) -> Result<()> {
    let environment = python
        .ancestors()
        .nth(2)
        .expect("it lies in an environment");
    let stamp = environment.join("installed-requirements.txt");
    unless_installed(lock, &stamp, || {
        let system = find("python3")
            .or_else(|| find("python"))
            .ok_or("Python is missing; install Python 3.11 or newer with venv and pip")?;
        say(&format!(
            "installing {what} into {} with pip",
            environment.display()
        ));
        let mut venv = command(system);
        venv.args(["-m", "venv", "--clear"]).arg(environment);
        run(
            venv.stdout(std::io::stderr()),
            "Python's venv or pip is missing; install both (Debian's package is python3-venv)",
        )?;
        run(
            arguments(&mut pip(python)),
            "pip failed; is the network there, and Python 3.11 or newer?",
        )
    })
}

fn pip(python: &Path) -> Command {
    let mut pip = command(python);
    pip.args([
        "-m",
        "pip",
        "install",
        "--quiet",
        "--disable-pip-version-check",
    ])
    .stdout(std::io::stderr());
    pip
}

/// Installs what a lock file names, unless `stamp`, the lock that was last installed in full, is the same.
fn unless_installed(lock: &Path, stamp: &Path, install: impl FnOnce() -> Result<()>) -> Result<()> {
    if is_installed(lock, stamp) {
        return Ok(());
    }
    install()?;
    fs::create_dir_all(stamp.parent().expect("a folder holds it"))
        .and_then(|()| fs::copy(lock, stamp))
        .map(|_| ())
        .map_err(|error| format!("{} cannot be written: {error}", stamp.display()))
}

fn is_installed(lock: &Path, stamp: &Path) -> bool {
    let read = |file| fs::read(file).ok();
    read(stamp).is_some_and(|installed| Some(installed) == read(lock))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_lock_that_was_not_installed_in_full_is_installed() {
        let folder =
            std::env::temp_dir().join(format!("pointweave-packages-{}", std::process::id()));
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
