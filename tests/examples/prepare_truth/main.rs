//! `cargo run --release --example prepare_truth [peer=PYTHON] [points=N] [FILE…]`
//!
//! Objects on a table and in a room, tidied by one recipe: what is kept of the object and what is dropped of the rest, with Open3D's
//! `segment_plane` and `cluster_dbscan` on the same points beside it. With files, what a recipe does to them is printed and
//! written to FILE.kept.xyz.

#[path = "../../common/staged.rs"]
mod staged;

use pointweave::base::progress::Silent;
use pointweave::pipeline::{Prepared, prepare};
use pointweave::prepare::pieces::{GAP, Keep};
use pointweave::prepare::planes::{Drop, MIN_SHARE};
use pointweave::prepare::recipe::Step;
use pointweave::samples::Model;
use pointweave::{Cloud, Result};
use staged::{Body, Scan, Stage, Staged};
use std::time::Instant;

fn main() -> Result<()> {
    let (mut points, mut viewpoints) = (60_000, false);
    for argument in std::env::args().skip(1) {
        if let Some(count) = argument.strip_prefix("points=") {
            points = count.parse().expect("a number");
        }
        viewpoints |= argument == "viewpoints";
    }
    println!(
        "{:>5} {:>6} {:>7} {:>7} {:>8} {:>8} {:>8} {:>8} {:>6} {:>7}",
        "model", "stage", "second", "points", "kept", "dropped", "lost", "left", "IoU", "ms"
    );
    for model in Model::ALL {
        for stage in [Stage::Table, Stage::Room] {
            for second in [false, true] {
                let staged = Staged {
                    model,
                    stage,
                    second: second.then_some(Model::Part),
                    strays: true,
                    points,
                    noise: 5e-4,
                    seed: 1,
                };
                row(&staged, viewpoints)?;
            }
        }
    }
    Ok(())
}

fn row(staged: &Staged, viewpoints: bool) -> Result<()> {
    let scan = staged.scan();
    let mut cloud = Cloud::from_f64(&scan.positions())?;
    if viewpoints {
        let eyes: Vec<f64> = scan.eyes.iter().flat_map(|p| p.to_array()).collect();
        cloud = cloud.with_viewpoints(&eyes, Some(&scan.of))?;
    }
    let start = Instant::now();
    let prepared = prepare(&cloud, &recipe(viewpoints), &mut Silent)?;
    let ms = start.elapsed().as_secs_f64() * 1e3;
    let truth = Truth::of(&scan, &prepared);
    println!(
        "{:>5} {:>6} {:>7} {:>7} {:>7.3}% {:>7.3}% {:>8} {:>8} {:>6.3} {ms:>7.0}",
        staged.model.name(),
        format!("{:?}", staged.stage),
        staged.second.map_or("-", Model::name),
        scan.points.len(),
        100.0 * truth.kept,
        100.0 * truth.dropped,
        truth.lost,
        truth.left,
        truth.iou,
    );
    if std::env::var("STEPS").is_ok() {
        for step in &prepared.steps {
            println!(
                "      {} -{} {} {:.0} ms",
                step.step, step.dropped, step.reason, step.ms
            );
            for plane in step.planes.iter().flatten() {
                println!("        {plane:?}");
            }
            for piece in step.pieces.iter().flatten().take(4) {
                println!("        {piece:?}");
            }
        }
    }
    Ok(())
}

/// Strays, then what carries, then all but the largest piece.
fn recipe(viewpoints: bool) -> Vec<Step> {
    let flying = viewpoints.then_some(Step::Flying);
    let rest = [
        Step::Outliers,
        Step::Plane {
            drop: Drop::All,
            behind: true,
            min_share: MIN_SHARE,
            seed: 0,
        },
        Step::Pieces {
            keep: Keep::Largest(1),
            gap: GAP,
        },
    ];
    flying.into_iter().chain(rest).collect()
}

/// What became of the object and of the rest.
struct Truth {
    /// Share of the object's points that are kept, and of all others that are dropped.
    kept: f64,
    dropped: f64,
    /// Points of the object that are lost, and others that are left, more than 1.5 spacings from where the object meets its support.
    lost: usize,
    left: usize,
    iou: f64,
}

impl Truth {
    fn of(scan: &Scan, prepared: &Prepared) -> Truth {
        let object = scan.count(Body::Object);
        let spacing = 1.5 * spacing(scan);
        let mut truth = Truth {
            kept: 0.0,
            dropped: 0.0,
            lost: 0,
            left: 0,
            iou: 0.0,
        };
        let (mut kept, mut left) = (0, 0);
        for (i, &p) in scan.points.iter().enumerate() {
            let is_kept = prepared.dropped_by[i] == 0;
            match (scan.bodies[i] == Body::Object, is_kept) {
                (true, true) => kept += 1,
                (true, false) => truth.lost += usize::from(p.y > scan.ground + spacing),
                (false, true) => {
                    left += 1;
                    truth.left += usize::from(scan.model.distance(p) > spacing);
                }
                (false, false) => {}
            }
        }
        truth.kept = kept as f64 / object as f64;
        truth.dropped = 1.0 - left as f64 / (scan.points.len() - object) as f64;
        truth.iou = kept as f64 / (object + left) as f64;
        truth
    }
}

/// Median distance to the nearest of the object's points, of a sample of them.
fn spacing(scan: &Scan) -> f64 {
    let object: Vec<_> = (0..scan.points.len())
        .filter(|&i| scan.bodies[i] == Body::Object)
        .map(|i| scan.points[i])
        .collect();
    // Points on a surface are 0.5 of its spacing from the nearest one, at random.
    let nearest = |p: &glam::DVec3| {
        let others = object.iter().filter(|q| *q != p);
        others.map(|q| q.distance(*p)).fold(f64::INFINITY, f64::min)
    };
    let mut all: Vec<f64> = object
        .iter()
        .step_by(object.len().div_ceil(200))
        .map(nearest)
        .collect();
    all.sort_unstable_by(f64::total_cmp);
    2.0 * all[all.len() / 2]
}
