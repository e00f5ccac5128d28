//! Section 7: how straight creases are.

use crate::clouds::{Scan, Truth};
use crate::measure::{reduced_to, surface};
use glam::{DMat3, DVec3};
use pointweave::Surface;
use std::collections::BTreeMap;

/// Edges with a larger dihedral angle (cosine of 30°) are creases.
const CREASE: f64 = 0.866;
/// What is nearer to a true edge than this share of the diagonal is looked at.
const NEAR: f64 = 0.01;

pub fn run(more: Option<Truth>) {
    println!(
        "\nEDGES: rms distance of vertices on creases to the true edges, mean and rms distance to the truth of the area within"
    );
    println!(
        "1 % of the true edges, in 1e-4 of the diagonal; found: share of the true edges with a crease vertex within 1 %"
    );
    println!(
        "{:<24} {:>6} {:>6} {:>5} {:>8} {:>6} {:>6} {:>8} {:>8} {:>7}",
        "cloud", "points", "noise%", "kept", "crease", "50%", "90%", "mean", "rms", "found%"
    );
    let turn = DMat3::from_rotation_x(0.5) * DMat3::from_rotation_y(0.3);
    let turned = |truth: Truth| match truth {
        Truth::Facets(facets) => {
            Truth::Facets(facets.into_iter().map(|t| t.map(|p| turn * p)).collect())
        }
        other => other,
    };
    let mut truths = vec![
        ("L block", turned(Truth::l_block())),
        ("wedge of 30 degrees", turned(Truth::wedge())),
        ("cylinder", turned(cylinder())),
    ];
    truths.extend(more.map(|truth| ("given", truth)));
    for noise in [0.0, 1e-3, 5e-3] {
        for (name, truth) in &truths {
            let n = if *name == "given" { 36_000 } else { 18_000 };
            let scan = Scan::new(*name, truth.clone(), n, noise);
            for kept in [1, 3] {
                row(&scan, kept);
            }
        }
    }
}

/// A cylinder of radius 0.7 and height 1: two round creases.
fn cylinder() -> Truth {
    let at = |k: usize, z: f64| {
        let angle = std::f64::consts::TAU * k as f64 / 96.0;
        DVec3::new(0.7 * libm::cos(angle), 0.7 * libm::sin(angle), z)
    };
    let mut facets = Vec::new();
    for k in 0..96 {
        let [a, b, c, d] = [at(k, -0.5), at(k + 1, -0.5), at(k + 1, 0.5), at(k, 0.5)];
        facets.extend([[a, b, c], [a, c, d]]);
        facets.extend([[d, c, DVec3::Z * 0.5], [b, a, DVec3::Z * -0.5]]);
    }
    Truth::Facets(facets)
}

/// The edges between facets that meet at more than 30°.
fn true_edges(truth: &Truth) -> Vec<[DVec3; 2]> {
    let Truth::Facets(facets) = truth else {
        return Vec::new();
    };
    let key = |p: DVec3| p.to_array().map(|x| (x * 1e6).round() as i64);
    type Side = (DVec3, [DVec3; 2]);
    let mut sides: BTreeMap<[[i64; 3]; 2], Vec<Side>> = BTreeMap::new();
    for t in facets {
        let normal = (t[1] - t[0]).cross(t[2] - t[0]).normalize();
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            let (p, q) = (key(a).min(key(b)), key(a).max(key(b)));
            sides.entry([p, q]).or_default().push((normal, [a, b]));
        }
    }
    let creases = sides
        .values()
        .filter(|s| s.len() == 2 && s[0].0.dot(s[1].0) < CREASE);
    creases.map(|s| s[0].1).collect()
}

fn to_segment(p: DVec3, [a, b]: [DVec3; 2]) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    p.distance(a + along * t)
}

fn row(scan: &Scan, kept: usize) {
    let s = match surface(&scan.points, &reduced_to(kept)) {
        Ok(s) => s,
        Err(error) => return println!("{} {error}", scan.head(kept)),
    };
    let edges = true_edges(&scan.truth);
    let d = scan.diagonal();
    let away = |p: DVec3| {
        edges
            .iter()
            .map(|&e| to_segment(p, e))
            .fold(f64::INFINITY, f64::min)
    };
    let on_crease = crease_vertices(&s);
    let near: Vec<(DVec3, f64)> = on_crease
        .iter()
        .map(|&p| (p, away(p) / d))
        .filter(|&(_, away)| away < NEAR)
        .collect();
    let rms = (near.iter().map(|n| n.1 * n.1).sum::<f64>() / near.len().max(1) as f64).sqrt();
    let (mut area, mut sum, mut squares) = (0.0, 0.0, 0.0);
    let frame = &s.cloud.reduced.cloud.frame;
    let some = s.mesh.triangles.len().div_ceil(6000);
    for t in s.mesh.triangles.iter().step_by(some) {
        let [a, b, c] = t.map(|v| DVec3::from_array(frame.to_caller(s.mesh.vertices[v as usize])));
        let size = (b - a).cross(c - a).length();
        let p = (a + b + c) / 3.0;
        if away(p) < NEAR * d {
            let off = scan.truth.distance(p) / d;
            area += size;
            sum += size * off;
            squares += size * off * off;
        }
    }
    let (mut all, mut found) = (0.0, 0.0);
    for e in &edges {
        let steps = ((e[1] - e[0]).length() / (0.005 * d)).ceil() as usize;
        for k in 0..steps {
            let p = e[0] + (e[1] - e[0]) * ((k as f64 + 0.5) / steps as f64);
            all += 1.0;
            found += f64::from(near.iter().any(|n| n.0.distance(p) < NEAR * d));
        }
    }
    let mut sorted: Vec<f64> = near.iter().map(|n| 1e4 * n.1).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let [half, most] = [0.5, 0.9].map(|q| {
        sorted
            .get((q * sorted.len() as f64) as usize)
            .copied()
            .unwrap_or(0.0)
    });
    println!(
        "{} {:>8.2} {half:>6.2} {most:>6.2} {:>8.2} {:>8.2} {:>7.1}",
        scan.head(kept),
        1e4 * rms,
        1e4 * sum / area,
        1e4 * (squares / area).sqrt(),
        100.0 * found / all
    );
}

/// Vertices of mesh edges that fold by more than 30°, in the caller's frame.
fn crease_vertices(s: &Surface) -> Vec<DVec3> {
    let mesh = &s.mesh;
    let at = |v: u32| mesh.vertices[v as usize].as_dvec3();
    let mut sides: BTreeMap<(u32, u32), Vec<DVec3>> = BTreeMap::new();
    for t in &mesh.triangles {
        let [a, b, c] = t.map(at);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        for (p, q) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            sides.entry((p.min(q), p.max(q))).or_default().push(normal);
        }
    }
    let mut on = vec![false; mesh.vertices.len()];
    for ((p, q), normals) in sides {
        if normals.len() == 2 && normals[0].dot(normals[1]) < CREASE {
            on[p as usize] = true;
            on[q as usize] = true;
        }
    }
    let frame = &s.cloud.reduced.cloud.frame;
    let vertices = mesh.vertices.iter().zip(on).filter(|v| v.1);
    vertices
        .map(|(&p, _)| DVec3::from_array(frame.to_caller(p)))
        .collect()
}
