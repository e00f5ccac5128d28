//! `cargo run --release --example orient_truth [NAME …] [seeds=N] [peer=PYTHON]`
//!
//! Which side is out: the shares of the surface and of the fitted points that are right side out, of generated scans of twelve kinds and of real ones
//! whose outer side is known (those in `../shared/data`, where they are). With `peer`, a Python that has Open3D, the share of
//! the points that it turns right by itself, and with the place of the camera, stands beside it; it runs
//! `tests/bench/orient_open3d.py`. Names choose scenes and kinds.

#[path = "../../common/scenes/mod.rs"]
mod scenes;

mod peer;
#[path = "../../common/peer.rs"]
mod process;
mod real;

use glam::DVec3;
use peer::Peer;
use pointweave::SurfaceParams;
use scenes::{Scene, Sure};
use std::io;

fn main() -> io::Result<()> {
    let mut names = Vec::new();
    let (mut seeds, mut peer) = (1, None);
    for arg in std::env::args().skip(1) {
        match arg.split_once('=') {
            Some(("seeds", n)) => seeds = n.parse().expect("a number of seeds"),
            Some(("peer", python)) => peer = Some(Peer::start(python)?),
            _ => names.push(arg),
        }
    }
    let is_asked = |name: &str| names.is_empty() || names.iter().any(|n| name.contains(n.as_str()));
    println!(
        "{:<62} {:>7} {:>8} {:>8} {:>8} {:>9} {:>9}  decided by; doubts",
        "scan", "points", "area %", "points %", "ms", "tangent %", "camera %"
    );
    for recipe in scenes::all() {
        let name = format!("{}: {}", recipe.kind, recipe.name);
        for seed in (0..seeds).filter(|_| is_asked(&name)) {
            row(&format!("{name} {seed}"), &recipe.scene(seed), &mut peer)?;
        }
    }
    for (name, make) in real::ALL {
        if is_asked(name)
            && let Some(scene) = make()
        {
            row(name, &scene, &mut peer)?;
        }
    }
    Ok(())
}

fn row(name: &str, scene: &Scene, peer: &mut Option<Peer>) -> io::Result<()> {
    let surface = scene.surface(&SurfaceParams::default());
    let report = &surface.report.reduce;
    let right = scene.right(&surface);
    let is_kept = match scene.sure {
        Sure::Closed => right >= 0.999 && report.doubts.is_empty(),
        Sure::Told => right >= 0.99,
        Sure::Guess => right.max(1.0 - right) >= 0.999 && !report.doubts.is_empty(),
    };
    let stage = |s: &(pointweave::Stage, f64)| s.0 == pointweave::Stage::Orient;
    let ms = report.ms.iter().find(stage).map_or(0.0, |s| s.1);
    let peers = match peer {
        Some(peer) => peer
            .right(scene)?
            .map(|share| format!("{:.2}", 100.0 * share)),
        None => [String::new(), String::new()],
    };
    let doubts: Vec<&str> = report.doubts.iter().map(|d| d.code).collect();
    let sources = surface.report.orientation.sources.iter();
    let sources: Vec<String> = sources
        .map(|s| {
            format!(
                "{:?} {:.1}/{:.1}",
                s.source,
                100.0 * s.share,
                100.0 * s.agreement
            )
        })
        .collect();
    println!(
        "{name:<62} {:>7} {:>8.3} {:>8.3} {ms:>8.1} {:>9} {:>9}  {}; {}{}",
        scene.points.len(),
        100.0 * right,
        100.0 * scene.right_points(&surface),
        peers[0],
        peers[1],
        sources.join(", "),
        doubts.join(" "),
        if is_kept { "" } else { " <--" }
    );
    Ok(())
}

/// Where a camera would stand that nobody told of: what the peer is given then.
fn somewhere(scene: &Scene) -> DVec3 {
    let told = &scene.told;
    if told.above {
        let top = scene
            .points
            .iter()
            .fold(DVec3::NEG_INFINITY, |a, &p| a.max(p));
        return top + DVec3::Z * 1e4;
    }
    told.viewpoints.first().copied().unwrap_or(DVec3::ZERO)
}
