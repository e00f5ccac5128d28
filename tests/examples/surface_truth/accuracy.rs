//! Sections 4 and 5: how near the mesh is to the truth, how many triangles of what shape it takes, and how long.

use crate::clouds::{Scan, Truth};
use crate::measure::{mark, reduced_to, signed_volume, stage_ms, surface, thin_shares, two_sided};
use pointweave::samples::{Model, NOISE};
use pointweave::{Stage, Surface};

/// Triangles for each fitted point, at most.
const MOST_TRIANGLES: f64 = 3.0;

pub fn run() {
    println!(
        "\nACCURACY: mean and rms distance of the mesh to the truth, mean and greatest of the truth to the mesh, what 99 % of both are within, in 1e-4 of"
    );
    println!(
        "the diagonal; t/p: triangles a fitted point, {MOST_TRIANGLES} at most; shares of triangles with a least angle under 5, 15, 30 degrees"
    );
    println!(
        "{:<24} {:>6} {:>6} {:>5} {:>6} {:>6} {:>7} {:>8} {:>6} {:>5} {:>5} {:>5} {:>5} {:>6}",
        "cloud",
        "points",
        "noise%",
        "kept",
        "mean",
        "rms",
        "covered",
        "farthest",
        "99 %",
        "t/p",
        "<5%",
        "<15%",
        "<30%",
        "volume"
    );
    for noise in [0.0, 1e-3, 5e-3] {
        for scan in scans(noise) {
            for kept in [1, 3] {
                row(&scan, kept);
            }
        }
    }
}

fn scans(noise: f64) -> Vec<Scan> {
    let models = Model::ALL.map(|m| Scan::new(m.name(), Truth::Model(m), 36_000, noise));
    let plain = [
        ("sphere", Truth::sphere()),
        ("torus", Truth::Torus),
        ("cube", Truth::cuboid(glam::DVec3::splat(0.5))),
        ("L block", Truth::l_block()),
        ("wedge of 30 degrees", Truth::wedge()),
        ("terrain", Truth::Terrain),
    ]
    .map(|(name, truth)| Scan::new(name, truth, 12_000, noise));
    models.into_iter().chain(plain).collect()
}

fn row(scan: &Scan, kept: usize) {
    let head = scan.head(kept);
    let s = match surface(&scan.points, &reduced_to(kept)) {
        Ok(s) => s,
        Err(error) => return println!("{head} {error}{}", mark(true)),
    };
    let (to, from, within) = two_sided(scan, &s);
    let [under_5, under_15, under_30] = thin_shares(&s, [5.0, 15.0, 30.0]).map(|s| 100.0 * s);
    let volume = signed_volume(&s);
    let per_point = s.mesh.triangles.len() as f64 / s.report.reduce.output_points as f64;
    let is_missed = per_point > MOST_TRIANGLES || scan.truth.is_closed() && volume <= 0.0;
    println!(
        "{head} {:>6.2} {:>6.2} {:>7.2} {:>8.2} {:>6.2} {per_point:>5.2} {under_5:>5.2} {under_15:>5.2} {under_30:>5.1} {:>6}{}",
        1e4 * to.mean,
        1e4 * to.rms,
        1e4 * from.mean,
        1e4 * from.max,
        1e4 * within,
        if volume > 0.0 { "+" } else { "-" },
        mark(is_missed)
    );
}

const STAGES: [Stage; 9] = [
    Stage::Octree,
    Stage::Features,
    Stage::Cluster,
    Stage::Place,
    Stage::Cells,
    Stage::Fit,
    Stage::Orient,
    Stage::Extract,
    Stage::Report,
];

pub fn times(is_million: bool) {
    println!("\nTIME in ms by stage, every point fitted; orientation must take less than the fit");
    print!("{:<6} {:>8}", "cloud", "points");
    STAGES.iter().for_each(|s| print!(" {:>8}", s.name()));
    println!();
    let sizes = if is_million {
        vec![100_000, 1_000_000]
    } else {
        vec![100_000]
    };
    for n in sizes {
        for model in [Model::Pig, Model::Part] {
            let scan = Scan::new(model.name(), Truth::Model(model), n, NOISE);
            match surface(&scan.points, &reduced_to(1)) {
                Ok(s) => time_row(&scan, &s),
                Err(error) => println!("{:<6} {n:>8} {error}{}", scan.name, mark(true)),
            }
        }
    }
}

fn time_row(scan: &Scan, s: &Surface) {
    print!("{:<6} {:>8}", scan.name, scan.points.len());
    STAGES
        .iter()
        .for_each(|&stage| print!(" {:>8.0}", stage_ms(s, stage)));
    println!(
        "{}",
        mark(stage_ms(s, Stage::Orient) >= stage_ms(s, Stage::Fit))
    );
}
