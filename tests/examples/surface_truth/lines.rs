//! Section 6: scan lines, much farther apart than their points.

use crate::measure::{doubts, mark, surface};
use crate::mesh::far;
use glam::{DVec3, dvec3};
use pointweave::base::rng::Rng;
use pointweave::report::distance::TriangleTree;
use pointweave::{Surface, SurfaceParams};
use std::f64::consts::{PI, TAU};

/// Distance of a point to the truth, and the normal of the truth there.
type At = fn(DVec3) -> (f64, DVec3);

struct Lines {
    name: String,
    points: Vec<DVec3>,
    truth: At,
    is_closed: bool,
    /// Lines are as far apart everywhere.
    is_even: bool,
}

/// Hills, and waves along x that are little longer than lines 20 points apart are far from each other: each line sees them.
fn waves(p: DVec3) -> (f64, DVec3) {
    let z = 0.12 * libm::sin(4.0 * p.x) * libm::cos(5.0 * p.y) + 0.01 * libm::sin(40.0 * p.x);
    let dx = 0.48 * libm::cos(4.0 * p.x) * libm::cos(5.0 * p.y) + 0.4 * libm::cos(40.0 * p.x);
    let dy = -0.6 * libm::sin(4.0 * p.x) * libm::sin(5.0 * p.y);
    let normal = dvec3(-dx, -dy, 1.0).normalize();
    ((p.z - z) * normal.z, normal)
}

fn hills(p: DVec3) -> (f64, DVec3) {
    let z = 0.12 * libm::sin(4.0 * p.x) * libm::cos(5.0 * p.y);
    let dx = 0.48 * libm::cos(4.0 * p.x) * libm::cos(5.0 * p.y);
    let dy = -0.6 * libm::sin(4.0 * p.x) * libm::sin(5.0 * p.y);
    let normal = dvec3(-dx, -dy, 1.0).normalize();
    ((p.z - z) * normal.z, normal)
}

fn ball(p: DVec3) -> (f64, DVec3) {
    (p.length() - 1.0, p.normalize())
}

/// `lines` lines over a square of edge 2, `ratio` times as far apart as their points, at random or `even`.
fn strips(name: &str, truth: At, (lines, ratio): (usize, f64), is_even: bool, noise: f64) -> Lines {
    let mut rng = Rng::new(5);
    let each = (ratio * lines as f64) as usize;
    let mut points = Vec::new();
    for line in 0..lines {
        let y = 2.0 * line as f64 / (lines - 1) as f64 - 1.0;
        for k in 0..each {
            let t = if is_even {
                k as f64 + 0.5
            } else {
                each as f64 * rng.uniform()
            };
            let p = dvec3(2.0 * t / each as f64 - 1.0, y, 0.0);
            // The height is what takes the point onto the surface.
            let (away, normal) = truth(p);
            points.push(
                p + dvec3(0.0, 0.0, -away / normal.z) + normal * (2.83 * noise * rng.normal()),
            );
        }
    }
    Lines {
        name: format!(
            "{name} 1:{ratio}{}{}",
            if is_even { " even" } else { "" },
            if noise > 0.0 {
                format!(" {:.1} %", 100.0 * noise)
            } else {
                String::new()
            }
        ),
        points,
        truth,
        is_closed: false,
        is_even: true,
    }
}

/// A ball of rings around z.
fn rings(count: usize, ratio: f64) -> Lines {
    let mut rng = Rng::new(6);
    let apart = PI / count as f64;
    let mut points = Vec::new();
    for ring in 0..count {
        let polar = (ring as f64 + 0.5) * apart;
        let (r, z) = (libm::sin(polar), libm::cos(polar));
        for _ in 0..(TAU * r * ratio / apart) as usize {
            let angle = TAU * rng.uniform();
            points.push(dvec3(r * libm::cos(angle), r * libm::sin(angle), z));
        }
    }
    Lines {
        name: format!("ring ball 1:{ratio}"),
        points,
        truth: ball,
        is_closed: true,
        is_even: true,
    }
}

/// 24 rings on the ground around a scanner two units above it: 1:3 near it, 1:30 far from it.
fn sweep() -> Lines {
    let mut points = Vec::new();
    for ring in 0..24 {
        let down = 0.9 - 0.03 * ring as f64;
        let r = 0.25 / libm::tan(down);
        for k in 0..900 {
            let angle = TAU * (k as f64 + 0.37 * ring as f64) / 900.0;
            let p = dvec3(r * libm::cos(angle), r * libm::sin(angle), 0.0);
            let (away, normal) = hills(p);
            points.push(p + dvec3(0.0, 0.0, -away / normal.z));
        }
    }
    Lines {
        name: "mixed sweep".into(),
        points,
        truth: hills,
        is_closed: false,
        is_even: false,
    }
}

pub fn run() {
    println!(
        "\nLINES: distance of the mesh to the truth, in 1e-4 of the diagonal; turned: share of the area more than 10 degrees off;"
    );
    println!(
        "missed: share of the points farther than half a percent of the diagonal from the mesh; far: area farther than 2 % from any point"
    );
    println!(
        "{:<26} {:>6} {:>6} {:>5} {:>6} {:>7} {:>7} {:>8} {:>8} {:>6} {:>6} {:>6}",
        "cloud",
        "points",
        "fitted",
        "parts",
        "border",
        "mean",
        "rms",
        "turned%",
        "missed%",
        "far%",
        "noise",
        "doubts"
    );
    let mut all = Vec::new();
    for ratio in [10.0, 20.0, 40.0] {
        let lines = if ratio == 40.0 { 20 } else { 30 };
        all.push(strips("hills", hills, (lines, ratio), false, 0.0));
        all.push(strips("hills", hills, (lines, ratio), true, 0.0));
        all.push(strips("hills", hills, (lines, ratio), false, 1e-3));
        all.push(strips("waves", waves, (lines, ratio), false, 0.0));
        all.push(rings(24, ratio));
    }
    all.push(strips("even", hills, (100, 1.0), true, 0.0));
    all.push(sweep());
    for cloud in &all {
        row(cloud);
    }
}

fn row(cloud: &Lines) {
    let head = format!("{:<26} {:>6}", cloud.name, cloud.points.len());
    let s = match surface(&cloud.points, &SurfaceParams::default()) {
        Ok(s) => s,
        Err(error) => return println!("{head} {error}{}", mark(true)),
    };
    let [mean, rms, turned] = to_truth(cloud, &s);
    let far = far(
        &s.mesh.vertices,
        &s.mesh.triangles,
        &s.cloud.reduced.cloud.points,
    );
    let missed = missed(cloud, &s);
    let is_missed = s.report.components != 1
        || cloud.is_closed && s.report.boundary_edges > 0
        || cloud.is_even && far > 0.02;
    println!(
        "{head} {:>6} {:>5} {:>6} {:>7.2} {:>7.2} {:>8.2} {:>8.3} {:>6.2} {:>6.2} {:>6}{}",
        s.report.reduce.output_points,
        s.report.components,
        s.report.boundary_edges,
        1e4 * mean,
        1e4 * rms,
        100.0 * turned,
        100.0 * missed,
        100.0 * far,
        1e4 * s.report.reduce.noise,
        doubts(&s),
        mark(is_missed)
    );
}

/// Mean and rms distance by area, and the share of the area that is turned.
fn to_truth(cloud: &Lines, s: &Surface) -> [f64; 3] {
    let frame = &s.cloud.reduced.cloud.frame;
    let (mut weights, mut sum, mut squares, mut turned) = (0.0, 0.0, 0.0, 0.0);
    for t in &s.mesh.triangles {
        let corners = t.map(|v| DVec3::from_array(frame.to_caller(s.mesh.vertices[v as usize])));
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        let area = normal.length();
        let (away, truth) = (cloud.truth)((a + b + c) / 3.0);
        let d = away / frame.diagonal;
        weights += area;
        sum += area * d.abs();
        squares += area * d * d;
        let cosine = normal.normalize_or_zero().dot(truth);
        if cosine.abs() < libm::cos(10f64.to_radians()) {
            turned += area;
        }
    }
    [sum / weights, (squares / weights).sqrt(), turned / weights]
}

fn missed(cloud: &Lines, s: &Surface) -> f64 {
    let tree = TriangleTree::new(&s.mesh.vertices, &s.mesh.triangles);
    let frame = &s.cloud.reduced.cloud.frame;
    let mut hint = 0;
    let away = cloud.points.iter().filter(|p| {
        let (distance2, triangle) = tree.closest(frame.to_unit(p.to_array()), hint);
        hint = triangle;
        distance2.sqrt() > 0.005
    });
    away.count() as f64 / cloud.points.len() as f64
}
