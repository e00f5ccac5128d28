//! `cargo xtask serve`: what the first picture needs is built first, and the rest behind the page.

use std::fs;
use std::process::{Child, Command};
use std::time::Instant;

use crate::build::{Build, Builder};
use crate::options;
use crate::packages;
use crate::page;
use crate::shell::{Result, command, not_started, root, say};
use crate::toolchain;
use crate::tools;

/// The builds that a page needs to show a scan, of a file or a sample. The others make it faster, or read and write more formats.
const FIRST: [Build; 3] = [Build::Single, Build::Files, Build::Samples];

/// Builds the package and the page, and serves the page until it is stopped.
pub fn serve(port: u16) -> Result<()> {
    let plan = Plan::new();
    plan.announce();
    let mut steps = Steps::of(&plan);
    if plan.compiler {
        steps.begin("installing a compiler with the sources of its standard library");
        toolchain::wasm()?;
    }
    if plan.bindgen {
        steps.begin("building wasm-bindgen");
        tools::bindgen()?;
    }
    if plan.packages {
        steps.begin("installing packages with npm");
        packages::npm(&root().join("xtask"))?;
        packages::npm(&root().join("www"))?;
    }
    options::write()?;
    let builder = Builder::ready()?;
    let (first, later) = plan.halves();
    builder.make_all(&first, |build| {
        steps.begin(&format!("building wasm, {}", build.name()));
    })?;
    steps.begin("building the page");
    page::build(&later)?;
    let mut server = start(port)?;
    say(&format!(
        "the page is at http://localhost:{port}/ until you press Ctrl-C (after {})",
        steps.elapsed()
    ));
    if let Err(sentence) = finish(&builder, &later, &mut steps) {
        say(&format!("{sentence}; the page goes on without it"));
    }
    let gone =
        format!("nothing is served any more; if port {port} is taken, choose one with `--port N`");
    match server.wait() {
        Ok(status) if status.success() => Ok(()),
        _ => Err(gone),
    }
}

/// Builds the rest, and the page once more with it. Meanwhile building.json tells the page how far that is.
fn finish(builder: &Builder, later: &[Build], steps: &mut Steps) -> Result<()> {
    if later.is_empty() {
        return Ok(());
    }
    let mut begun = 0;
    builder.make_all(later, |build| {
        // The one before is not finished yet.
        note(&later[usize::saturating_sub(begun, 1)..]);
        begun += 1;
        steps.begin(&format!("building wasm, {}", build.name()));
    })?;
    steps.begin("building the page with all of it");
    page::build(&[])?;
    say(&format!(
        "all is built, after {}: reload the page",
        steps.elapsed()
    ));
    Ok(())
}

/// What is still being built, for the page that is open. A page that cannot know only says so later.
fn note(missing: &[Build]) {
    let names: Vec<String> = missing
        .iter()
        .map(|build| format!("{:?}", build.name()))
        .collect();
    let text = format!("[{}]\n", names.join(","));
    if let Err(error) = fs::write(root().join("www/dist/building.json"), text) {
        say(&format!(
            "www/dist/building.json cannot be written: {error}"
        ));
    }
}

fn start(port: u16) -> Result<Child> {
    let mut vite: Command = command("npm");
    vite.current_dir(root().join("www"))
        .args(["run", "--silent", "preview", "--"])
        .args(["--host", "localhost", "--strictPort", "--port"])
        .arg(port.to_string());
    vite.spawn().map_err(|error| not_started(&vite, &error))
}

/// What has to be done, found out before anything is.
struct Plan {
    compiler: bool,
    bindgen: bool,
    packages: bool,
    builds: Vec<Build>,
}

/// Minutes on 2 cores.
const COMPILER: f32 = 1.0;
const BINDGEN: f32 = 1.0;
const PACKAGES: f32 = 0.5;
const PAGE: f32 = 0.3;

fn minutes(build: Build) -> f32 {
    match build {
        Build::Single | Build::Threads | Build::Prepare => 2.5,
        _ => 1.0,
    }
}

impl Plan {
    fn new() -> Self {
        Self {
            compiler: toolchain::installed().is_none(),
            bindgen: !tools::has_bindgen(),
            packages: ["xtask", "www"]
                .iter()
                .any(|folder| !packages::npm_is_installed(&root().join(folder))),
            builds: Build::ALL
                .into_iter()
                .filter(|build| !build.is_current())
                .collect(),
        }
    }

    /// The builds to make before the page and behind it.
    fn halves(&self) -> (Vec<Build>, Vec<Build>) {
        let is_first = |build: &Build| FIRST.contains(build);
        self.builds.iter().copied().partition(is_first)
    }

    /// Steps until the page is served, and after it; each with its minutes.
    fn steps(&self) -> ((usize, f32), (usize, f32)) {
        let mut first = vec![PAGE];
        let tools = [
            (self.compiler, COMPILER),
            (self.bindgen, BINDGEN),
            (self.packages, PACKAGES),
        ];
        first.extend(tools.iter().filter(|tool| tool.0).map(|tool| tool.1));
        let (before, behind) = self.halves();
        first.extend(before.into_iter().map(minutes));
        let mut later: Vec<f32> = behind.into_iter().map(minutes).collect();
        if !later.is_empty() {
            later.push(PAGE);
        }
        let sum = |steps: &[f32]| (steps.len(), steps.iter().sum());
        (sum(&first), sum(&later))
    }

    fn announce(&self) {
        let ((first, soon), (later, rest)) = self.steps();
        let count = |steps: usize| match steps {
            1 => "1 step".into(),
            _ => format!("{steps} steps"),
        };
        let behind = match later {
            0 => String::new(),
            _ => format!("; then {} more behind it, {}", count(later), about(rest)),
        };
        say(&format!(
            "{} to the page, {}{behind}",
            count(first),
            about(soon)
        ));
    }
}

fn about(minutes: f32) -> String {
    match minutes.round() {
        whole if whole > 1.0 => format!("about {whole} minutes on 2 cores"),
        _ => "about a minute".into(),
    }
}

/// Numbers the steps as they begin.
struct Steps {
    all: usize,
    begun: usize,
    start: Instant,
}

impl Steps {
    fn of(plan: &Plan) -> Self {
        let ((first, _), (later, _)) = plan.steps();
        Self {
            all: first + later,
            begun: 0,
            start: Instant::now(),
        }
    }

    /// Minutes and seconds so far.
    fn elapsed(&self) -> String {
        let seconds = self.start.elapsed().as_secs();
        format!("{} min {} s", seconds / 60, seconds % 60)
    }

    fn begin(&mut self, what: &str) {
        self.begun += 1;
        say(&format!("[{}/{}] {what}", self.begun, self.all));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bare_machine_has_the_page_before_the_rest() {
        let bare = Plan {
            compiler: true,
            bindgen: true,
            packages: true,
            builds: Build::ALL.to_vec(),
        };
        let ((first, soon), (later, rest)) = bare.steps();
        assert_eq!((first, later), (7, Build::ALL.len() - FIRST.len() + 1));
        assert!(soon > 0.0 && rest > 0.0);
    }

    #[test]
    fn what_is_there_is_no_step() {
        let ready = Plan {
            compiler: false,
            bindgen: false,
            packages: false,
            builds: vec![Build::Las],
        };
        let ((first, _), (later, _)) = ready.steps();
        assert_eq!((first, later), (1, 2));
        assert_eq!(ready.halves(), (vec![], vec![Build::Las]));
        let mut steps = Steps::of(&ready);
        steps.begin("a test");
        assert_eq!((steps.begun, steps.all), (1, 3));
    }

    #[test]
    fn times_are_round() {
        assert_eq!(about(0.3), "about a minute");
        assert_eq!(about(6.4), "about 6 minutes on 2 cores");
    }
}
