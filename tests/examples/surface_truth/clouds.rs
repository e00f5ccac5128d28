//! Generated clouds whose surface is known: where it is, which way it looks, where it ends.

use glam::{DVec3, dvec3};
use pointweave::base::rng::Rng;
use pointweave::report::distance::closest_on_triangle;
use pointweave::samples::{Model, sample_with_noise};
use std::f64::consts::TAU;

/// A surface of known truth. Normals look out of the solid, or up where there is none.
#[derive(Clone)]
pub enum Truth {
    /// Flat faces, counter-clockwise seen from outside.
    Facets(Vec<[DVec3; 3]>),
    /// A sphere; `side` −1 where the solid is around it.
    Sphere {
        center: DVec3,
        radius: f64,
        side: f64,
    },
    /// The part of a unit sphere above a height.
    Cap { lowest: f64 },
    /// Radii 1 and 0.4 around z.
    Torus,
    /// Hills over a square of half edge 1.
    Terrain,
    /// A generated sample, scanned.
    Model(Model),
    /// The part of a sample that looks to the right of an x, y, z direction and that nothing hides from there.
    Side(Model, DVec3),
    /// Several surfaces, points shared out by area.
    Several(Vec<Truth>),
}

/// Points of a truth.
#[derive(Clone)]
pub struct Scan {
    pub name: String,
    pub truth: Truth,
    /// In the caller's frame.
    pub points: Vec<DVec3>,
    /// True normals of `points`.
    pub normals: Vec<DVec3>,
    /// Standard deviation of the noise as a fraction of the diagonal.
    pub noise: f64,
}

impl Scan {
    /// The first columns of its row in a table: name, points, noise in percent, and the share that is kept.
    pub fn head(&self, kept: usize) -> String {
        format!(
            "{:<24} {:>6} {:>6.1} {:>5}",
            self.name,
            self.points.len(),
            100.0 * self.noise,
            format!("1/{kept}")
        )
    }

    pub fn new(name: impl Into<String>, truth: Truth, n: usize, noise: f64) -> Scan {
        let (points, normals) = truth.sample(n, 1);
        let mut scan = Scan {
            name: name.into(),
            truth,
            points,
            normals,
            noise: 0.0,
        };
        scan.add_noise(noise);
        scan
    }

    /// Keeps points with a probability that falls from 1 to `1 / ratio` along x.
    pub fn with_density(name: impl Into<String>, truth: Truth, n: usize, ratio: f64) -> Scan {
        let mut rng = Rng::new(7);
        let mut scan = Scan::new(name, truth, 0, 0.0);
        for seed in 1.. {
            let (points, normals) = scan.truth.sample(n, seed);
            for (p, normal) in points.into_iter().zip(normals) {
                if rng.uniform() < ratio.powf(-(p.x + 1.0) / 2.0) {
                    scan.points.push(p);
                    scan.normals.push(normal);
                }
            }
            if scan.points.len() >= n {
                break;
            }
        }
        scan.points.truncate(n);
        scan.normals.truncate(n);
        scan
    }

    fn add_noise(&mut self, noise: f64) {
        let deviation = noise * self.diagonal();
        let mut rng = Rng::new(11);
        for (p, n) in self.points.iter_mut().zip(&self.normals) {
            *p += *n * (deviation * rng.normal());
        }
        self.noise = noise;
    }

    pub fn diagonal(&self) -> f64 {
        let low = self.points.iter().copied().reduce(DVec3::min);
        let high = self.points.iter().copied().reduce(DVec3::max);
        low.zip(high).map_or(0.0, |(low, high)| low.distance(high))
    }
}

impl Truth {
    /// A box around the origin.
    pub fn cuboid(half: DVec3) -> Truth {
        let mut facets = Vec::new();
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let corner = |a: f64, b: f64| {
                    let mut p = DVec3::ZERO;
                    (p[axis], p[u], p[v]) = (side * half[axis], a * half[u], side * b * half[v]);
                    p
                };
                let quad = [
                    corner(-1.0, -1.0),
                    corner(1.0, -1.0),
                    corner(1.0, 1.0),
                    corner(-1.0, 1.0),
                ];
                facets.extend([[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]);
            }
        }
        Truth::Facets(facets)
    }

    /// A square plate of half edge 1, rim included, so thick that `n` points on it are `spacings` apart across it.
    pub fn plate(n: usize, spacings: f64) -> Truth {
        let thickness = (0..50).fold(0.0, |t: f64, _| {
            spacings * ((8.0 + 8.0 * t) / n as f64).sqrt()
        });
        Truth::cuboid(dvec3(1.0, 1.0, thickness / 2.0))
    }

    /// A profile of the xy plane, counter-clockwise, cut into `triangles`, between z = ±`half`.
    fn prism(profile: &[(f64, f64)], triangles: &[[usize; 3]], half: f64) -> Truth {
        let at = |i: usize, z: f64| {
            let (x, y) = profile[i % profile.len()];
            dvec3(x, y, z)
        };
        let mut facets = Vec::new();
        for &[a, b, c] in triangles {
            facets.push([at(a, half), at(b, half), at(c, half)]);
            facets.push([at(a, -half), at(c, -half), at(b, -half)]);
        }
        for i in 0..profile.len() {
            let [a, b] = [at(i, -half), at(i + 1, -half)];
            let [c, d] = [at(i + 1, half), at(i, half)];
            facets.extend([[a, b, c], [a, c, d]]);
        }
        Truth::Facets(facets)
    }

    /// An L: five right-angled convex creases and a concave one.
    pub fn l_block() -> Truth {
        let profile = [
            (0.0, 0.0),
            (2.0, 0.0),
            (2.0, 0.8),
            (0.8, 0.8),
            (0.8, 2.0),
            (0.0, 2.0),
        ];
        let triangles = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
        Truth::prism(&profile, &triangles, 0.6)
    }

    /// A wedge with an edge of 30°.
    pub fn wedge() -> Truth {
        let profile = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.155)];
        Truth::prism(&profile, &[[0, 1, 2]], 0.7)
    }

    pub fn sphere() -> Truth {
        Truth::ball(DVec3::ZERO, 1.0)
    }

    pub fn ball(center: DVec3, radius: f64) -> Truth {
        Truth::Sphere {
            center,
            radius,
            side: 1.0,
        }
    }

    /// A ball of radius 1 with a ball of radius `inner` taken out.
    pub fn shells(inner: f64) -> Truth {
        let cave = Truth::Sphere {
            center: DVec3::ZERO,
            radius: inner,
            side: -1.0,
        };
        Truth::Several(vec![Truth::sphere(), cave])
    }

    /// A big ball, a small one and a box, apart.
    pub fn components() -> Truth {
        let facets = match Truth::cuboid(dvec3(0.5, 0.4, 0.3)) {
            Truth::Facets(facets) => facets,
            other => return other,
        };
        let moved = facets
            .into_iter()
            .map(|t| t.map(|p| p + dvec3(0.5, 2.0, 0.4)));
        Truth::Several(vec![
            Truth::sphere(),
            Truth::ball(dvec3(1.9, 0.0, 0.0), 0.5),
            Truth::Facets(moved.collect()),
        ])
    }

    /// Whether the surface encloses a solid.
    pub fn is_closed(&self) -> bool {
        !matches!(self, Truth::Cap { .. } | Truth::Terrain | Truth::Side(..))
    }

    fn area(&self) -> f64 {
        match self {
            Truth::Facets(facets) => facets.iter().map(facet_area).sum(),
            Truth::Sphere { radius, .. } => 2.0 * TAU * radius * radius,
            Truth::Several(parts) => parts.iter().map(Truth::area).sum(),
            _ => 1.0,
        }
    }

    /// Distance of a point to the surface.
    pub fn distance(&self, p: DVec3) -> f64 {
        match self {
            Truth::Facets(facets) => facets
                .iter()
                .map(|&t| closest_on_triangle(p, t).distance(p))
                .fold(f64::INFINITY, f64::min),
            Truth::Sphere { center, radius, .. } => (p.distance(*center) - radius).abs(),
            Truth::Cap { .. } => (p.length() - 1.0).abs(),
            Truth::Torus => {
                let ring = p.x.hypot(p.y) - 1.0;
                (ring.hypot(p.z) - 0.4).abs()
            }
            Truth::Terrain => {
                let (height, normal) = terrain(p.x, p.y);
                ((p.z - height) * normal.z).abs()
            }
            Truth::Model(model) | Truth::Side(model, _) => {
                (model.distance(p) / model.gradient(p).length().max(0.5)).abs()
            }
            Truth::Several(parts) => parts
                .iter()
                .map(|t| t.distance(p))
                .fold(f64::INFINITY, f64::min),
        }
    }

    /// `n` points with their normals.
    pub fn sample(&self, n: usize, seed: u64) -> (Vec<DVec3>, Vec<DVec3>) {
        let mut rng = Rng::new(seed);
        match self {
            Truth::Model(model) => scanned(*model, n, seed),
            Truth::Side(model, toward) => {
                let toward = toward.normalize();
                // The size of the seen part is not known: scan more until there is enough of it.
                let mut scanned_points = 3 * n;
                loop {
                    let (points, normals) = scanned(*model, scanned_points, seed);
                    let seen = points.into_iter().zip(normals).filter(|&(p, normal)| {
                        normal.dot(toward) > 0.12 && is_free(*model, p, toward)
                    });
                    let (mut points, mut normals): (Vec<_>, Vec<_>) = seen.unzip();
                    if points.len() >= n {
                        // Every k-th, as the scanner's order is spatial.
                        let pick = |k: usize| k * points.len() / n;
                        let at: Vec<usize> = (0..n).map(pick).collect();
                        points = at.iter().map(|&k| points[k]).collect();
                        normals = at.iter().map(|&k| normals[k]).collect();
                        return (points, normals);
                    }
                    scanned_points *= 2;
                }
            }
            Truth::Several(parts) => {
                let total = self.area();
                let mut out = (Vec::new(), Vec::new());
                for (k, part) in parts.iter().enumerate() {
                    let share = (n as f64 * part.area() / total).round() as usize;
                    let (points, normals) = part.sample(share, seed + 100 * k as u64);
                    out.0.extend(points);
                    out.1.extend(normals);
                }
                out
            }
            Truth::Facets(facets) => {
                let total = self.area();
                let one = |_| {
                    let mut left = rng.uniform() * total;
                    let past = |t: &&[DVec3; 3]| {
                        left -= facet_area(t);
                        left < 0.0
                    };
                    let [a, b, c] = *facets.iter().find(past).unwrap_or(&facets[0]);
                    let (mut u, mut v) = (rng.uniform(), rng.uniform());
                    if u + v > 1.0 {
                        (u, v) = (1.0 - u, 1.0 - v);
                    }
                    let normal = (b - a).cross(c - a).normalize();
                    (a + (b - a) * u + (c - a) * v, normal)
                };
                (0..n).map(one).unzip()
            }
            _ => (0..n).map(|_| self.point(&mut rng)).unzip(),
        }
    }

    fn point(&self, rng: &mut Rng) -> (DVec3, DVec3) {
        match self {
            Truth::Sphere {
                center,
                radius,
                side,
            } => {
                let d = direction(rng);
                (*center + d * *radius, d * *side)
            }
            Truth::Cap { lowest } => loop {
                let d = direction(rng);
                if d.z > *lowest {
                    return (d, d);
                }
            },
            Truth::Torus => loop {
                let (u, v) = (TAU * rng.uniform(), TAU * rng.uniform());
                let ring = 1.0 + 0.4 * v.cos();
                if rng.uniform() * 1.4 < ring {
                    let normal = dvec3(v.cos() * u.cos(), v.cos() * u.sin(), v.sin());
                    return (dvec3(u.cos(), u.sin(), 0.0) + 0.4 * normal, normal);
                }
            },
            _ => loop {
                let (x, y) = (2.0 * rng.uniform() - 1.0, 2.0 * rng.uniform() - 1.0);
                let (z, normal) = terrain(x, y);
                // Steeper is larger; slopes stay under 45°.
                if rng.uniform() < 0.7 / normal.z {
                    return (dvec3(x, y, z), normal);
                }
            },
        }
    }
}

/// Height and upward normal of the hills.
fn terrain(x: f64, y: f64) -> (f64, DVec3) {
    let (a, b) = (2.5 * x + 0.3, 2.1 * y - 0.7);
    let height = 0.12 * a.sin() * b.cos() + 0.05 * (5.0 * x + 4.0 * y).sin();
    let wave = 0.05 * (5.0 * x + 4.0 * y).cos();
    let slope_x = 0.12 * 2.5 * a.cos() * b.cos() + 5.0 * wave;
    let slope_y = -0.12 * 2.1 * a.sin() * b.sin() + 4.0 * wave;
    (height, dvec3(-slope_x, -slope_y, 1.0).normalize())
}

fn scanned(model: Model, n: usize, seed: u64) -> (Vec<DVec3>, Vec<DVec3>) {
    let sample = sample_with_noise(model, n, seed, 0.0);
    let triples = |v: &[f32]| -> Vec<DVec3> {
        v.chunks_exact(3)
            .map(|p| dvec3(p[0].into(), p[1].into(), p[2].into()))
            .collect()
    };
    (triples(&sample.positions), triples(&sample.normals))
}

/// Whether a ray from the surface leaves the model.
fn is_free(model: Model, p: DVec3, toward: DVec3) -> bool {
    let (low, high) = model.bounds();
    let far = low.distance(high);
    let mut t = 0.01 * far;
    while t < far {
        let d = model.distance(p + toward * t);
        if d < 1e-4 * far {
            return false;
        }
        t += d;
    }
    true
}

fn facet_area(&[a, b, c]: &[DVec3; 3]) -> f64 {
    (b - a).cross(c - a).length() / 2.0
}

fn direction(rng: &mut Rng) -> DVec3 {
    dvec3(rng.normal(), rng.normal(), rng.normal()).normalize()
}

/// Clouds that no method has a right answer for, or that break careless ones. No truth.
pub fn hostile() -> Vec<(String, Vec<DVec3>)> {
    let mut rng = Rng::new(3);
    let mut cube = |n: usize, half: f64| -> Vec<DVec3> {
        let mut side = || half * (2.0 * rng.uniform() - 1.0);
        (0..n).map(|_| dvec3(side(), side(), side())).collect()
    };
    let random = cube(2000, 1.0);
    let outliers = cube(3000, 1.5);
    let flat = cube(3000, 1.0);
    let few = cube(60, 1.0);
    let sphere = |n, seed| Truth::sphere().sample(n, seed).0;
    let joined = |parts: Vec<Vec<DVec3>>| parts.concat();
    let moved =
        |points: Vec<DVec3>, by: DVec3| points.into_iter().map(|p| p + by).collect::<Vec<_>>();
    let mut noise = Rng::new(4);
    let noisy: Vec<DVec3> = flat
        .iter()
        .map(|p| dvec3(p.x, p.y, 0.05 * noise.normal()))
        .collect();
    let line: Vec<DVec3> = (0..500)
        .map(|i| dvec3(1.0 + 0.004 * i as f64, 0.0, 0.0))
        .collect();
    let holed = |lowest: f64| -> Vec<DVec3> {
        sphere(6000, 5)
            .into_iter()
            .filter(|p| p.z < lowest)
            .collect()
    };
    let mut all = vec![
        ("random in a cube".to_string(), random),
        ("noisy plane".into(), noisy),
        (
            "two touching spheres".into(),
            joined(vec![
                sphere(3000, 1),
                moved(sphere(3000, 2), 2.0 * DVec3::X),
            ]),
        ),
        (
            "half outliers".into(),
            joined(vec![sphere(3000, 1), outliers]),
        ),
        (
            "densities 1000 apart".into(),
            joined(vec![
                sphere(20_000, 1),
                moved(sphere(20, 2), 2.5 * DVec3::X),
            ]),
        ),
        (
            "density 1000 along a sphere".into(),
            Scan::with_density("", Truth::sphere(), 10_000, 1000.0).points,
        ),
        (
            "20 beside 100,000".into(),
            joined(vec![
                sphere(100_000, 1),
                sphere(20, 2)
                    .into_iter()
                    .map(|p| 0.02 * p + 1.5 * DVec3::Y)
                    .collect(),
            ]),
        ),
        ("sphere, small hole".into(), holed(0.95)),
        ("sphere, large hole".into(), holed(0.4)),
        ("every point twice".into(), sphere(3000, 1).repeat(2)),
        (
            "one point 500 times".into(),
            joined(vec![sphere(3000, 1), vec![DVec3::X; 500]]),
        ),
        (
            "line and sphere".into(),
            joined(vec![sphere(3000, 1), line]),
        ),
        (
            "crossing planes".into(),
            joined(vec![
                flat[..1500].iter().map(|p| dvec3(p.x, p.y, 0.0)).collect(),
                flat[1500..].iter().map(|p| dvec3(p.x, 0.0, p.z)).collect(),
            ]),
        ),
        (
            "lattice of a cube".into(),
            (0..12 * 12 * 12)
                .map(|i| dvec3((i % 12) as f64, (i / 12 % 12) as f64, (i / 144) as f64))
                .collect(),
        ),
    ];
    for n in [4, 5, 8, 16, 30, 60] {
        all.push((format!("{n} on a sphere"), sphere(n, 6)));
        all.push((format!("{n} in a cube"), few[..n].to_vec()));
    }
    all
}
