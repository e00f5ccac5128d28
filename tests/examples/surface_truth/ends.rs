//! Section 3: where open surfaces end, and what `auto` takes for open.

use crate::clouds::{Scan, Truth};
use crate::measure::{Spaced, mark, reduced_to, surface};
use glam::{Vec3, dvec3};
use pointweave::base::params::Boundary;
use pointweave::report::distance::TriangleTree;
use pointweave::samples::Model;
use pointweave::{Surface, SurfaceParams};
use std::collections::BTreeMap;

/// An open surface ends within this many spacings of where the points end.
const PROMISED: f64 = 1.5;
/// Share of a random sampling's area that is farther than that from every point (0.0009), doubled: gaps inside of the
/// surface are no phantoms.
const GAPS: f64 = 2e-3;
/// Share of the border that may be beyond, as the spacing of uneven scans is known no better.
const STRAY: f64 = 0.01;

pub fn run() {
    println!(
        "\nENDS: late: greatest distance of the mesh's border to the fitted points, in spacings; share: border"
    );
    println!(
        "vertices beyond {PROMISED}; phantom: share of the area beyond {PROMISED}; early: share of the points farther than"
    );
    println!("1 spacing from the mesh; auto must leave open what is open and close what is closed");
    println!(
        "{:<24} {:>6} {:>6} {:>5} {:>6} {:>5} {:>6} {:>6} {:>7} {:>8} {:>7}",
        "cloud",
        "points",
        "noise%",
        "kept",
        "ends",
        "parts",
        "border",
        "late",
        "share%",
        "phantom%",
        "early%"
    );
    for noise in [0.0, 1e-3, 5e-3] {
        for scan in scans(noise) {
            for kept in [1, 3] {
                for boundary in [Boundary::Open, Boundary::Auto] {
                    row(&scan, kept, boundary);
                }
            }
        }
    }
}

fn scans(noise: f64) -> Vec<Scan> {
    let side = |model: Model, toward| {
        Scan::new(
            format!("{}, one side", model.name()),
            Truth::Side(model, toward),
            10_000,
            noise,
        )
    };
    let plain = |name: &str, truth| Scan::new(name, truth, 10_000, noise);
    vec![
        plain("terrain", Truth::Terrain),
        plain("half sphere", Truth::Cap { lowest: 0.0 }),
        plain("bowl, 3/4 of a sphere", Truth::Cap { lowest: -0.5 }),
        side(Model::Part, dvec3(0.3, 1.0, 0.2)),
        side(Model::Duck, dvec3(0.2, 0.3, 1.0)),
        side(Model::Pig, dvec3(0.2, 0.3, 1.0)),
        plain("sphere, closed", Truth::sphere()),
        plain("L block, closed", Truth::l_block()),
        plain("part, closed", Truth::Model(Model::Part)),
        plain("plate, closed", Truth::plate(10_000, 6.0)),
    ]
}

fn row(scan: &Scan, kept: usize, boundary: Boundary) {
    let params = SurfaceParams {
        boundary,
        ..reduced_to(kept)
    };
    let ends = format!("{boundary:?}").to_lowercase();
    let head = format!("{} {ends:>6}", scan.head(kept));
    let s = match surface(&scan.points, &params) {
        Ok(s) => s,
        Err(error) => return println!("{head} {error}{}", mark(true)),
    };
    let ends = Ends::of(&s, scan.noise);
    let is_open = ends.border > 0;
    let is_wrong = is_open == scan.truth.is_closed() && boundary == Boundary::Auto;
    let is_late = !scan.truth.is_closed() && (ends.share > STRAY || ends.phantom > GAPS);
    println!(
        "{head} {:>5} {:>6} {:>6.2} {:>7.2} {:>8.3} {:>7.3}{}",
        s.report.components,
        ends.border,
        ends.late,
        100.0 * ends.share,
        100.0 * ends.phantom,
        100.0 * ends.early,
        mark(is_wrong || is_late && is_open || ends.early > 1e-3)
    );
}

/// Where a mesh ends; see the table's head.
pub struct Ends {
    pub border: usize,
    pub late: f64,
    pub share: f64,
    pub phantom: f64,
    pub early: f64,
}

impl Ends {
    pub fn of(s: &Surface, noise: f64) -> Ends {
        let mesh = &s.mesh;
        let points = Spaced::new(&s.cloud.reduced.cloud.points);
        let mut edges: BTreeMap<(u32, u32), usize> = BTreeMap::new();
        let (mut area, mut phantom) = (0.0, 0.0);
        for t in &mesh.triangles {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                *edges.entry((a.min(b), a.max(b))).or_default() += 1;
            }
            let [a, b, c] = t.map(|v| mesh.vertices[v as usize]);
            let size = f64::from((b - a).cross(c - a).length());
            area += size;
            if points.away((a + b + c) / 3.0) > PROMISED {
                phantom += size;
            }
        }
        let border = edges.iter().filter(|e| *e.1 == 1);
        let away: Vec<f64> = border
            .map(|(&(a, _), _)| points.away(mesh.vertices[a as usize]))
            .collect();
        let tree = TriangleTree::new(&mesh.vertices, &mesh.triangles);
        let mut hint = 0;
        let mut is_uncovered = |p: &&Vec3| {
            let (distance2, triangle) = tree.closest(**p, hint);
            hint = triangle;
            distance2.sqrt() > points.spacing_at(**p) + 3.0 * noise
        };
        let uncovered = points.tree.points.iter().filter(&mut is_uncovered).count();
        Ends {
            border: away.len(),
            late: away.iter().copied().fold(0.0, f64::max),
            share: away.iter().filter(|&&d| d > PROMISED).count() as f64 / away.len().max(1) as f64,
            phantom: phantom / area,
            early: uncovered as f64 / points.tree.points.len() as f64,
        }
    }
}
