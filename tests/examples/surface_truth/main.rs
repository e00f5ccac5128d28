//! `cargo run --release --example surface_truth [orient] [topology] [ends] [accuracy] [edges] [lines] [grain] [normals] [time] [million] [CLOUD.f32 …]`
//!
//! What reconstruction promises, measured on generated clouds whose surface is known: which side is out, what is never
//! allowed in a mesh, where open surfaces end, how near the mesh is to the truth and how many triangles it takes, how
//! grainy it is, what normals of a cloud are worth, and where the time goes. All sections run unless some are named; a promise that is not kept is marked with `<--`.
//! Raw clouds (`x y z` as f32) have no truth: their topology, ends and triangles are printed.

mod accuracy;
mod clouds;
mod edges;
mod ends;
mod grain;
mod lines;
mod measure;
#[path = "../../common/mesh.rs"]
mod mesh;
mod normals;
mod orient;
mod topology;

use glam::{DVec3, dvec3};
use std::io;

fn main() -> io::Result<()> {
    let (files, words): (Vec<String>, Vec<String>) =
        std::env::args().skip(1).partition(|a| a.ends_with(".f32"));
    let is_all = files.is_empty() && words.iter().all(|w| w == "million");
    let is_asked = |name: &str| is_all || words.iter().any(|w| w == name);
    if is_asked("orient") {
        orient::run();
    }
    if is_asked("topology") {
        topology::run();
    }
    if is_asked("ends") {
        ends::run();
    }
    if is_asked("accuracy") {
        accuracy::run();
    }
    if is_asked("time") || words.iter().any(|w| w == "million") {
        accuracy::times(words.iter().any(|w| w == "million"));
    }
    if is_asked("edges") {
        let soup = words.iter().find_map(|w| w.strip_prefix("truth="));
        let facets = |path: &str| -> io::Result<clouds::Truth> {
            let corners = read(path)?;
            let facets = corners.chunks_exact(3).map(|t| [t[0], t[1], t[2]]);
            Ok(clouds::Truth::Facets(facets.collect()))
        };
        edges::run(soup.map(facets).transpose()?);
    }
    if is_asked("lines") {
        lines::run();
    }
    if is_asked("grain") {
        grain::run();
    }
    if is_asked("normals") {
        normals::run();
    }
    for file in &files {
        topology::rows(file, &read(file)?);
    }
    Ok(())
}

/// A raw cloud.
fn read(path: &str) -> io::Result<Vec<DVec3>> {
    let bytes = std::fs::read(path)?;
    let values: Vec<f64> = bytes
        .chunks_exact(4)
        .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]).into())
        .collect();
    Ok(values
        .chunks_exact(3)
        .map(|p| dvec3(p[0], p[1], p[2]))
        .collect())
}
