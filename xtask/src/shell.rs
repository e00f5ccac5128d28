//! Running other programs, and saying so.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;

/// The error is a whole sentence for the person at the terminal.
pub type Result<T> = std::result::Result<T, String>;

/// The folder that holds the workspace.
pub fn root() -> PathBuf {
    let xtask = Path::new(env!("CARGO_MANIFEST_DIR"));
    xtask
        .parent()
        .expect("xtask lies in the workspace")
        .to_path_buf()
}

/// Says on standard error what is about to happen.
pub fn say(what: &str) {
    eprintln!("xtask: {what}");
}

/// A command that starts in the workspace's folder.
pub fn command(program: impl AsRef<Path>) -> Command {
    let mut command = Command::new(program.as_ref());
    command.current_dir(root());
    command
}

/// The cargo that runs this program.
pub fn cargo() -> Command {
    command(env::var_os("CARGO").unwrap_or("cargo".into()))
}

/// Runs to the end; `remedy` is the sentence for a failure.
pub fn run(command: &mut Command, remedy: &str) -> Result<()> {
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(_) => Err(remedy.into()),
        Err(error) => Err(not_started(command, &error)),
    }
}

/// Runs two commands at once. What each of them wrote is printed whole, and not before both are done.
pub fn run_both(commands: [(&mut Command, &str); 2]) -> Result<()> {
    let outputs = thread::scope(|scope| {
        commands
            .map(|(command, remedy)| {
                let output = || {
                    let output = command.output();
                    output.map_err(|error| not_started(command, &error))
                };
                (scope.spawn(output), remedy)
            })
            .map(|(running, remedy)| (running.join().expect("no panic"), remedy))
    });
    let results = outputs.map(|(output, remedy)| {
        let output = output?;
        print!("{}", String::from_utf8_lossy(&output.stdout));
        eprint!("{}", String::from_utf8_lossy(&output.stderr));
        if output.status.success() {
            Ok(())
        } else {
            Err(remedy.to_string())
        }
    });
    let failed: Vec<String> = results.into_iter().filter_map(Result::err).collect();
    if failed.is_empty() {
        Ok(())
    } else {
        Err(failed.join("; "))
    }
}

/// Standard output without the space around it; `None` if the program is missing or fails.
pub fn output(command: &mut Command) -> Option<String> {
    let output = command.stderr(Stdio::null()).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_string())
}

/// The sentence for a program that cannot be run at all.
pub fn not_started(command: &Command, error: &std::io::Error) -> String {
    let program = command.get_program().to_string_lossy();
    format!("`{program}` cannot be run ({error}); install it or put it on PATH")
}

/// Where PATH finds a program.
pub fn find(program: &str) -> Option<PathBuf> {
    let file = format!("{program}{}", env::consts::EXE_SUFFIX);
    env::split_paths(&env::var_os("PATH")?)
        .map(|folder| folder.join(&file))
        .find(|path| path.is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn root_holds_the_workspace() {
        assert!(root().join("Cargo.lock").is_file());
    }

    #[test]
    fn a_missing_program_is_named() {
        let error = run(&mut command("no-such-program"), "unused").unwrap_err();
        assert!(error.contains("`no-such-program`"), "{error}");
        assert_eq!(output(&mut command("no-such-program")), None);
        assert_eq!(find("no-such-program"), None);
    }

    #[test]
    fn of_two_commands_each_failure_is_told() {
        let version = || {
            let mut command = cargo();
            command.arg("--version");
            command
        };
        let wrong = || {
            let mut command = cargo();
            command.arg("--no-such-option");
            command
        };
        assert!(run_both([(&mut version(), "a"), (&mut version(), "b")]).is_ok());
        let failed = |a: &mut Command, b: &mut Command| run_both([(a, "a"), (b, "b")]).unwrap_err();
        assert_eq!(failed(&mut wrong(), &mut version()), "a");
        assert_eq!(failed(&mut version(), &mut wrong()), "b");
        assert_eq!(failed(&mut wrong(), &mut wrong()), "a; b");
    }

    #[test]
    fn cargo_is_found_and_runs() {
        assert!(
            output(cargo().arg("--version"))
                .unwrap()
                .starts_with("cargo ")
        );
        assert!(run(cargo().arg("--version").stdout(Stdio::null()), "").is_ok());
    }
}
