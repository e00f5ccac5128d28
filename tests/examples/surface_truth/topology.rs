//! Section 2: what must never be wrong with a mesh, on clouds that break careless methods.

use crate::clouds::hostile;
use crate::measure::{doubts, mark, reduced_to, surface};
use crate::mesh::Flaws;
use glam::DVec3;
use pointweave::SurfaceParams;
use pointweave::base::params::Boundary;

pub fn run() {
    println!(
        "\nTOPOLOGY: triangles, components and boundary edges; then what must be 0, marked where it is not"
    );
    println!(
        "(edges and vertices that are no manifold, duplicates, triangles without area or with a corner twice,"
    );
    println!(
        "edges run through twice in one direction, vertices that are not finite or unused); then folded edges, and doubts"
    );
    println!(
        "{:<28} {:>7} {:>6} {:>4} {:>8} {:>5} {:>6} {:>4} {:>4} {:>4} {:>4} {:>5} {:>5} {:>5}",
        "cloud",
        "points",
        "ends",
        "kept",
        "triangles",
        "parts",
        "border",
        "edge",
        "vert",
        "dupl",
        "flat",
        "turned",
        "stray",
        "fold"
    );
    for (name, points) in hostile() {
        rows(&name, &points);
    }
}

/// All three boundary modes, unreduced and reduced by default.
pub fn rows(name: &str, points: &[DVec3]) {
    for boundary in [Boundary::Closed, Boundary::Open, Boundary::Auto] {
        for kept in [1, 3] {
            let params = SurfaceParams {
                boundary,
                ..reduced_to(kept)
            };
            let head = format!(
                "{name:<28} {:>7} {:>6} {:>4}",
                points.len(),
                format!("{boundary:?}").to_lowercase(),
                format!("1/{kept}")
            );
            let s = match surface(points, &params) {
                Ok(s) => s,
                Err(error) => {
                    println!("{head} {error}");
                    continue;
                }
            };
            let flaws = Flaws::of(&s.mesh.vertices, &s.mesh.triangles);
            let t = &flaws.topology;
            let is_unclosed = boundary == Boundary::Closed && t.boundary_edges > 0;
            println!(
                "{head} {:>9} {:>5} {:>6} {:>4} {:>4} {:>4} {:>4} {:>5} {:>5} {:>5} {}{}",
                s.mesh.triangles.len(),
                t.components,
                t.boundary_edges,
                t.non_manifold_edges,
                t.non_manifold_vertices,
                t.duplicate,
                t.degenerate + flaws.flat,
                t.inconsistent_edges,
                flaws.stray,
                flaws.folded,
                doubts(&s),
                mark(!flaws.is_clean() || is_unclosed || s.mesh.triangles.is_empty())
            );
        }
    }
}
