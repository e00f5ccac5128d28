//! `cargo run --release --example prepare_truth [peer=PYTHON] [points=N] [viewpoints]`, or `… prepare_truth FILE…`
//!
//! Objects on a table and in a room, cut out by one recipe: what is kept of the object, what is dropped of the rest, and the overlap
//! (points kept that are the object's, of those that are either). With `peer`, Open3D's `segment_plane` and `cluster_dbscan` do the
//! same scans in the same run. With files, says what the recipe does to each, and writes what is left to NAME.object.ply among the
//! temporary files.

mod peer;
#[path = "../../common/peer.rs"]
mod process;
#[path = "../../common/staged.rs"]
mod staged;

use peer::Peer;
use pointweave::Cloud;
use pointweave::base::progress::Silent;
use pointweave::formats::{Output, RawCloud, detect, read, write};
use pointweave::pipeline::{Prepared, prepare};
use pointweave::samples::Model;
use staged::{Body, Scan, Stage, Staged, tidy};
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let (mut points, mut viewpoints, mut peer, mut files) = (60_000, false, None, Vec::new());
    for argument in std::env::args().skip(1) {
        if let Some(count) = argument.strip_prefix("points=") {
            points = count.parse()?;
        } else if let Some(python) = argument.strip_prefix("peer=") {
            peer = Some(Peer::start(python)?);
        } else if argument == "viewpoints" {
            viewpoints = true;
        } else {
            files.push(argument);
        }
    }
    if !files.is_empty() {
        return files.iter().try_for_each(|file| cut(file));
    }
    println!(
        "{:>5} {:>6} {:>7} {:>7} {:>8} {:>8} {:>5} {:>5} {:>7} {:>6}   Open3D",
        "model", "stage", "second", "points", "kept", "dropped", "lost", "left", "overlap", "ms"
    );
    for model in Model::ALL {
        for stage in [Stage::Table, Stage::Room] {
            for second in [None, Some(Model::Part)] {
                let staged = Staged {
                    model,
                    stage,
                    second,
                    strays: true,
                    points,
                    noise: 5e-4,
                    seed: 1,
                };
                row(&staged, viewpoints, &mut peer)?;
            }
        }
    }
    Ok(())
}

fn row(staged: &Staged, viewpoints: bool, peer: &mut Option<Peer>) -> Result<(), Box<dyn Error>> {
    let scan = staged.scan();
    let mut cloud = Cloud::from_f64(&scan.positions())?;
    if viewpoints {
        let eyes: Vec<f64> = scan.eyes.iter().flat_map(|p| p.to_array()).collect();
        cloud = cloud.with_viewpoints(&eyes, Some(&scan.of))?;
    }
    let start = Instant::now();
    let prepared = prepare(&cloud, &tidy(), &mut Silent)?;
    let ms = start.elapsed().as_secs_f64() * 1e3;
    let spacing = spacing(&scan);
    let kept: Vec<bool> = prepared.dropped_by.iter().map(|&by| by == 0).collect();
    let truth = Truth::of(&scan, &kept, spacing);
    let theirs = match peer {
        Some(peer) => {
            let planes = if staged.stage == Stage::Table { 1 } else { 3 };
            let (kept, ms) = peer.cut(&scan, planes, spacing)?;
            let truth = Truth::of(&scan, &kept, spacing);
            format!("overlap {:.3}, {ms:.0} ms", truth.overlap)
        }
        None => String::from("-"),
    };
    println!(
        "{:>5} {:>6} {:>7} {:>7} {:>7.3}% {:>7.3}% {:>5} {:>5} {:>7.3} {ms:>6.0}   {theirs}",
        staged.model.name(),
        format!("{:?}", staged.stage),
        staged.second.map_or("-", Model::name),
        scan.points.len(),
        100.0 * truth.kept,
        100.0 * truth.dropped,
        truth.lost,
        truth.left,
        truth.overlap,
    );
    Ok(())
}

/// What became of the object and of the rest.
struct Truth {
    /// Share of the object's points that are kept, and of all others that are dropped; of strays those farther than a spacing and a
    /// half from the object.
    kept: f64,
    dropped: f64,
    /// Points of the object that are lost, and others that are left, more than 1.5 spacings from where the object meets the rest.
    lost: usize,
    left: usize,
    overlap: f64,
}

impl Truth {
    fn of(scan: &Scan, kept: &[bool], spacing: f64) -> Truth {
        let ring = 1.5 * spacing;
        let (mut object, mut others, mut right, mut wrong) = (0, 0, 0, 0);
        let (mut lost, mut left) = (0, 0);
        for (i, &p) in scan.points.iter().enumerate() {
            let is_far = scan.model.distance(p) > ring;
            match scan.bodies[i] {
                Body::Object => {
                    object += 1;
                    right += usize::from(kept[i]);
                    lost += usize::from(!kept[i] && p.y > scan.ground + ring);
                }
                Body::Stray if !is_far => {}
                _ => {
                    others += 1;
                    wrong += usize::from(kept[i]);
                    left += usize::from(kept[i] && is_far);
                }
            }
        }
        Truth {
            kept: right as f64 / object as f64,
            dropped: 1.0 - wrong as f64 / others as f64,
            lost,
            left,
            overlap: right as f64 / (object + wrong) as f64,
        }
    }
}

/// About the spacing of the object's points: twice the median distance to the nearest one.
fn spacing(scan: &Scan) -> f64 {
    let is_object = |&i: &usize| scan.bodies[i] == Body::Object;
    let object = (0..scan.points.len()).filter(is_object);
    let object: Vec<_> = object.map(|i| scan.points[i]).collect();
    let nearest = |p: &glam::DVec3| {
        let others = object.iter().filter(|q| *q != p);
        others.map(|q| q.distance(*p)).fold(f64::INFINITY, f64::min)
    };
    let some = object.iter().step_by(object.len().div_ceil(200));
    let mut all: Vec<f64> = some.map(nearest).collect();
    all.sort_unstable_by(f64::total_cmp);
    2.0 * all[all.len() / 2]
}

/// The recipe on a file.
fn cut(file: &str) -> Result<(), Box<dyn Error>> {
    let bytes = std::fs::read(file)?;
    let cloud = read(&bytes, detect(&bytes, Some(file))?)?.to_cloud()?;
    let prepared = prepare(&cloud, &tidy(), &mut Silent)?;
    println!("{file}: {} points", cloud.len());
    told(&prepared);
    let object = cloud.select(&prepared.kept)?;
    let name = file.rsplit('/').next().unwrap_or(file);
    let ply = write(
        &RawCloud::of_cloud(&object),
        None,
        Output::Ply,
        Default::default(),
    )?;
    Ok(std::fs::write(
        std::env::temp_dir().join(format!("{name}.object.ply")),
        ply,
    )?)
}

fn told(prepared: &Prepared) {
    for step in &prepared.steps {
        println!(
            "  {:8} -{} → {} {:.0} ms {}",
            step.step, step.dropped, step.kept, step.ms, step.reason
        );
        for plane in step.planes.iter().flatten() {
            println!("    {plane:?}");
        }
        for piece in step.pieces.iter().flatten().take(5) {
            println!("    {piece:?}");
        }
    }
}
