//! Section 1: share of the fitted points oriented right.

use crate::clouds::{Scan, Truth};
use crate::measure::{mark, oriented_right, reduced_to, signed_volume, stage_ms, surface};
use pointweave::base::params::Propagation;
use pointweave::samples::Model;
use pointweave::{Stage, SurfaceParams};

const POINTS: usize = 12_000;
const NOISES: [f64; 3] = [0.0, 1e-3, 5e-3];
const KEPT: [usize; 3] = [1, 3, 10];

/// A cloud and the share of its points that must be right at the noise it has.
struct Case {
    scan: Scan,
    kept: Vec<usize>,
    promised: f64,
}

pub fn run() {
    println!(
        "\nORIENT: share of the fitted points oriented right, in %; E: energy; volume: its sign, for closed ones"
    );
    println!(
        "{:<24} {:>6} {:>6} {:>5} {:>8} {:>8} {:>7} {:>7} {:>7} {:>6} {:>6}",
        "cloud",
        "points",
        "noise%",
        "kept",
        "ours",
        "paper",
        "E",
        "E paper",
        "promise",
        "volume",
        "ms"
    );
    for case in cases() {
        for &kept in &case.kept {
            row(&case, kept);
        }
    }
}

fn row(case: &Case, kept: usize) {
    let scan = &case.scan;
    let head = scan.head(kept);
    let run = |propagation| {
        let params = SurfaceParams {
            propagation,
            ..reduced_to(kept)
        };
        surface(&scan.points, &params)
    };
    match (run(Propagation::Global), run(Propagation::Paper)) {
        (Ok(ours), Ok(paper)) => {
            let shares = [&ours, &paper].map(|s| oriented_right(scan, s));
            let volume = signed_volume(&ours);
            let is_missed = shares[0] < case.promised || scan.truth.is_closed() && volume <= 0.0;
            println!(
                "{head} {:>8.3} {:>8.3} {:>7.4} {:>7.4} {:>7.2} {:>6} {:>6.0}{}",
                100.0 * shares[0],
                100.0 * shares[1],
                ours.report.orientation_energy,
                paper.report.orientation_energy,
                100.0 * case.promised,
                if volume > 0.0 { "+" } else { "-" },
                stage_ms(&ours, Stage::Orient),
                mark(is_missed)
            );
        }
        (Err(error), _) | (_, Err(error)) => println!("{head} {error}{}", mark(true)),
    }
}

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    let mut add = |scan, kept: &[usize], promised| {
        cases.push(Case {
            scan,
            kept: kept.to_vec(),
            promised,
        });
    };
    for noise in NOISES {
        let promised = if noise < 5e-3 { 0.999 } else { 0.997 };
        for model in Model::ALL {
            let scan = Scan::new(model.name(), Truth::Model(model), 36_000, noise);
            add(scan, &KEPT, if noise < 5e-3 { 1.0 } else { promised });
        }
        for (name, truth) in [
            ("sphere", Truth::sphere()),
            ("torus", Truth::Torus),
            ("L block", Truth::l_block()),
            ("wedge of 30 degrees", Truth::wedge()),
            ("three components", Truth::components()),
            ("half sphere", Truth::Cap { lowest: 0.0 }),
            ("terrain", Truth::Terrain),
        ] {
            add(Scan::new(name, truth, POINTS, noise), &KEPT, promised);
        }
    }
    for model in [Model::Pig, Model::Duck] {
        for n in [3600, 5000] {
            let name = format!("{}, few", model.name());
            add(Scan::new(name, Truth::Model(model), n, 0.0), &[1], 0.99);
        }
    }
    for (thickness, promised) in [(3.0, 0.99), (1.5, 0.95)] {
        for n in [3000, 10_000, 30_000] {
            let name = format!("plate, {thickness} spacings");
            add(
                Scan::new(name, Truth::plate(n, thickness), n, 0.0),
                &[1],
                promised,
            );
        }
    }
    for inner in [0.5, 0.8, 0.9] {
        let name = format!("shells 1 and {inner}");
        add(
            Scan::new(name, Truth::shells(inner), POINTS, 0.0),
            &KEPT,
            1.0,
        );
    }
    for ratio in [100.0, 1000.0] {
        for (name, truth) in [("sphere", Truth::sphere()), ("terrain", Truth::Terrain)] {
            let name = format!("{name}, density 1:{ratio}");
            add(
                Scan::with_density(name, truth, POINTS, ratio),
                &[1, 3],
                0.999,
            );
        }
    }
    cases
}
