//! `cargo run --release --example register_truth [peer=PYTHON] [rounds=N]`
//!
//! Scans in random frames, put together: how many are placed, and how far from where they belong, in % of the object's diagonal. The raw
//! range images of the bunny (those in `../shared/data`, where they are) and the pig in eight views; then pairs of different things of one
//! size, of which none may be merged. With `peer`, Open3D's FPFH, RANSAC, ICP and pose graph do the same in the same run.

mod peer;
#[path = "../../common/peer.rs"]
mod process;
#[path = "../../common/views.rs"]
mod views;

use glam::{DMat3, DQuat, DVec3};
use peer::Peer;
use pointweave::Cloud;
use pointweave::base::progress::Silent;
use pointweave::base::rng::Rng;
use pointweave::formats::{detect, read};
use pointweave::prepare::register::{Pose, register};
use pointweave::samples::Model;
use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;
use views::{Views, errors, random_pose};

/// Things of which no two are the same.
const THINGS: [&str; 12] = [
    "bunny_raw/bun000.ply",
    "kitten.xyz",
    "oni.ply",
    "Zaghetto.pcd",
    "owl-little.obj",
    "ball.ply",
    "distcap.pts",
    "sphere_20k_normal.xyz",
    "findsurface_sample.xyz",
    "cad_scans/Range_Hood_4_filtered.ply",
    "pcl/milk_color.pcd",
    "pcl/chef.pcd",
];
/// Further views of the bunny for such pairs.
const BUNNIES: [&str; 4] = ["bun090", "bun180", "chin", "top3"];

/// Scans with their truth.
struct Scene {
    name: String,
    clouds: Vec<Cloud>,
    truth: Vec<Pose>,
    diagonal: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let (mut rounds, mut peer) = (3, None);
    for argument in std::env::args().skip(1) {
        if let Some(count) = argument.strip_prefix("rounds=") {
            rounds = count.parse()?;
        } else if let Some(python) = argument.strip_prefix("peer=") {
            peer = Some(Peer::start(python)?);
        }
    }
    println!(
        "{:>16} {:>6} {:>9} {:>9} {:>6}   Open3D",
        "scene", "placed", "median %", "most %", "ms"
    );
    for round in 0..rounds {
        for scene in [bunny(round)?, Some(pig(round))].into_iter().flatten() {
            row(&scene, &mut peer)?;
        }
    }
    wrong_pairs(&mut peer)
}

fn row(scene: &Scene, peer: &mut Option<Peer>) -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    let found = register(&scene.clouds, &mut Silent)?;
    let ms = start.elapsed().as_secs_f64() * 1e3;
    let poses: Vec<Option<Pose>> = found.scans.iter().map(|scan| scan.pose).collect();
    let (placed, median, most) = summary(scene, &poses);
    let theirs = match peer {
        Some(peer) => {
            let (poses, ms) = peer.register(&scene.clouds)?;
            let (placed, median, most) = summary(scene, &poses);
            format!("{placed} placed, median {median:.4} %, most {most:.4} %, {ms:.0} ms")
        }
        None => String::from("-"),
    };
    let name = &scene.name;
    println!("{name:>16} {placed:>6} {median:>9.4} {most:>9.4} {ms:>6.0}   {theirs}");
    Ok(())
}

/// How many scans were placed, and the median and the largest of their errors in %.
fn summary(scene: &Scene, poses: &[Option<Pose>]) -> (usize, f64, f64) {
    let errors = errors(&scene.clouds, &scene.truth, poses, scene.diagonal);
    let mut errors: Vec<f64> = errors.into_iter().flatten().map(|x| 100.0 * x).collect();
    errors.sort_by(f64::total_cmp);
    let n = errors.len();
    (
        n,
        (errors[(n - 1) / 2] + errors[n / 2]) / 2.0,
        errors[n - 1],
    )
}

/// The raw bunny, in round 0 as its scanner saw it, then in random frames.
fn bunny(round: u64) -> Result<Option<Scene>, Box<dyn Error>> {
    let Ok(poses) = std::fs::read_to_string(path("bunny_raw/bun.conf")) else {
        return Ok(None);
    };
    let mut scene = Scene {
        name: format!("bunny, round {round}"),
        clouds: Vec::new(),
        truth: Vec::new(),
        diagonal: 0.2502,
    };
    let mut rng = Rng::new(round);
    for line in poses.lines().filter(|line| line.starts_with("bmesh")) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let numbers: Result<Vec<f64>, _> = words[2..].iter().map(|word| word.parse()).collect();
        let x = numbers?;
        // The file has the inverse of the usual quaternion.
        let turn = DQuat::from_xyzw(x[3], x[4], x[5], -x[6]).normalize();
        let truth = Pose {
            turn: DMat3::from_quat(turn),
            shift: DVec3::from_slice(&x[..3]),
        };
        let apart = match round {
            0 => Pose::IDENTITY,
            _ => random_pose(&mut rng, 0.5),
        };
        let cloud = load(&format!("bunny_raw/{}", words[1]))?;
        scene.clouds.push(moved(&cloud, &apart, 1.0)?);
        scene.truth.push(truth.after(&apart.back()));
    }
    Ok(Some(scene))
}

fn pig(round: u64) -> Scene {
    let views = Views {
        model: Model::Pig,
        points: 60_000,
        noise: 5e-4,
        turn: 45.0,
        seed: 100 * round,
    };
    let (low, high) = Model::Pig.bounds();
    let views = views.first(8);
    Scene {
        name: format!("pig, round {round}"),
        truth: views.iter().map(|view| view.truth).collect(),
        clouds: views.into_iter().map(|view| view.cloud).collect(),
        diagonal: low.distance(high),
    }
}

/// All pairs of different things, each of one size: how many are merged, which none should be.
fn wrong_pairs(peer: &mut Option<Peer>) -> Result<(), Box<dyn Error>> {
    let mut clouds = Vec::new();
    let bunnies = BUNNIES.map(|name| format!("bunny_raw/{name}.ply"));
    for name in THINGS.map(String::from).iter().chain(&bunnies) {
        if path(name).exists() {
            let cloud = load(name)?;
            let scaled = moved(&cloud, &Pose::IDENTITY, 0.2 / cloud.frame.diagonal)?;
            clouds.push((name.starts_with("bunny"), scaled));
        }
    }
    let (mut tries, mut ours, mut theirs, mut ms, mut their_ms) = (0, 0, 0, 0.0, 0.0);
    for j in 0..clouds.len() {
        for i in 0..j {
            if clouds[i].0 && clouds[j].0 {
                continue;
            }
            let pair = [clouds[i].1.clone(), clouds[j].1.clone()];
            let start = Instant::now();
            let found = register(&pair, &mut Silent)?;
            ms += start.elapsed().as_secs_f64() * 1e3;
            tries += 1;
            ours += usize::from(found.scans.iter().all(|scan| scan.pose.is_some()));
            if let Some(peer) = peer {
                let (poses, ms) = peer.register(&pair)?;
                their_ms += ms;
                theirs += usize::from(poses.iter().all(Option::is_some));
            }
        }
    }
    println!(
        "wrong pairs merged: {ours} of {tries}, {:.0} ms each",
        ms / f64::from(tries.max(1))
    );
    if peer.is_some() {
        println!(
            "by Open3D: {theirs} of {tries}, {:.0} ms each",
            their_ms / f64::from(tries.max(1))
        );
    }
    Ok(())
}

fn path(name: &str) -> PathBuf {
    PathBuf::from("../shared/data/scans").join(name)
}

fn load(name: &str) -> Result<Cloud, Box<dyn Error>> {
    let bytes = std::fs::read(path(name))?;
    let format = detect(&bytes, Some(name))?;
    Ok(read(&bytes, format)?.to_cloud()?)
}

/// The points of a cloud, larger and elsewhere.
fn moved(cloud: &Cloud, pose: &Pose, scale: f64) -> Result<Cloud, Box<dyn Error>> {
    let positions = cloud.positions_f64();
    let each = positions.chunks_exact(3);
    let at = each.flat_map(|p| pose.at(DVec3::from_slice(p) * scale).to_array());
    Ok(Cloud::from_f64(&at.collect::<Vec<f64>>())?)
}
