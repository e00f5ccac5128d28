//! The project's commands: `cargo xtask build | page | serve | test | bench | setup`.
//!
//! Every command first sets up what it needs (`setup.rs`) and says what it installs before it does.
//! A failure is one sentence that says what to do.

mod apt;
mod bench;
mod browsers;
mod build;
mod options;
mod packages;
mod page;
mod serve;
mod setup;
mod shell;
mod test;
mod toolchain;
mod tools;
mod wasm_bindings;

use std::process::ExitCode;

use shell::Result;

const HELP: &str = "\
Pointweave's own commands. Each sets up what is missing first.

Usage: cargo xtask <command> [options]

  build [NAME…]         what the table of options says, into pkg/ and www/, and all wasm builds, or these, into pkg/wasm/
  options               what the table of options says, and nothing else
  page                  the builds and the page, into www/dist/, for any static server
  serve [--port N]      the same, served on localhost (default port 8080) as soon as there is something to see
  test [--only LIST]    every check, or those of a comma-separated list:
                        fmt,clippy,native,wasm,types,pkg,element,page
  test PART [FILE [NAME]]
                        one of them; of native, wasm, pkg, element and page one file alone
                        (`test pkg cli` runs tests/pkg/cli.test.mjs), or its tests of that name
  bench [ARGS…]         the benchmarks, after a build; `orient`, `prepare`, `register` and what else tests/bench/bench.mjs knows
  setup                 install whatever the other commands need, and nothing else

Environment: CHROMIUM, CHROMEDRIVER, FIREFOX and GECKODRIVER name programs to use instead of those found;
RUSTUP_AUTO_INSTALL=0 keeps rustup from downloading.
";

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    match run(&args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(sentence) => {
            eprintln!("xtask: {sentence}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: &[String]) -> Result<()> {
    let (command, arguments) = match args.split_first() {
        Some((command, arguments)) => (command.as_str(), arguments),
        None => ("help", args),
    };
    match command {
        "build" => build::build_these(arguments),
        "options" => expect_no_options(arguments).and_then(|()| options::write()),
        "page" => expect_no_options(arguments)
            .and_then(|()| build::ensure())
            .and_then(|()| page::ensure()),
        "serve" => serve::serve(port(arguments)?),
        "test" => test::test(&test::Selection::parse(arguments)?),
        "bench" => bench::bench(arguments),
        "setup" => expect_no_options(arguments).and_then(|()| setup::everything()),
        "help" | "--help" | "-h" => {
            print!("{HELP}");
            Ok(())
        }
        other => Err(format!(
            "no command `{other}`; `cargo xtask help` lists them"
        )),
    }
}

fn expect_no_options(options: &[String]) -> Result<()> {
    match options.first() {
        None => Ok(()),
        Some(option) => Err(format!(
            "this command takes no option `{option}`; `cargo xtask help` lists what it takes"
        )),
    }
}

fn port(options: &[String]) -> Result<u16> {
    match options {
        [] => Ok(8080),
        [flag, number] if flag == "--port" => number
            .parse()
            .map_err(|_| format!("`--port` takes a number from 0 to 65535, not `{number}`")),
        _ => Err("`serve` takes `--port N` and nothing else".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strings(args: &[&str]) -> Vec<String> {
        args.iter().map(|arg| arg.to_string()).collect()
    }

    #[test]
    fn port_is_8080_unless_told() {
        assert_eq!(port(&[]), Ok(8080));
        assert_eq!(port(&strings(&["--port", "3000"])), Ok(3000));
    }

    #[test]
    fn a_wrong_option_is_a_sentence() {
        assert!(
            port(&strings(&["--port", "70000"]))
                .unwrap_err()
                .contains("70000")
        );
        assert!(port(&strings(&["--prot", "1"])).is_err());
        assert!(run(&strings(&["biuld"])).unwrap_err().contains("biuld"));
        assert!(
            run(&strings(&["build", "--fast"]))
                .unwrap_err()
                .contains("--fast")
        );
    }
}
