//! Debian's packages.

use std::sync::OnceLock;

use crate::shell::{Result, command, find, output, run, say};

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
