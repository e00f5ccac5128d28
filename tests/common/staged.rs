//! Sample models in front of a scanner with what real scans have around them: a table, a floor with walls, a second object, flying
//! pixels at depth edges, stray returns. Of each point it is known what it was taken from.

#![allow(dead_code)] // every test takes what it needs

use glam::{DVec3, dvec3};
use pointweave::base::rng::Rng;
use pointweave::prepare::pieces::{GAP, Keep};
use pointweave::prepare::planes::{Drop, MIN_SHARE};
use pointweave::prepare::recipe::Step;
use pointweave::samples::{Model, sample_with_noise};

/// What a point was taken from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Body {
    Object,
    /// A table, a floor, a wall.
    Support,
    Second,
    /// Between two surfaces on one ray, or nowhere.
    Stray,
}

/// What stands around the object.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// On a round table that goes on for a quarter of the diagonal around it.
    Table,
    /// On a floor, with two walls behind it.
    Room,
}

/// A scan to be made.
#[derive(Debug, Clone, Copy)]
pub struct Staged {
    pub model: Model,
    pub stage: Stage,
    /// Another model of half the size beside it, a tenth of the diagonal away.
    pub second: Option<Model>,
    /// Flying pixels and stray returns.
    pub strays: bool,
    /// Points, about.
    pub points: usize,
    /// Standard deviation of the range, a fraction of the object's diagonal.
    pub noise: f64,
    pub seed: u64,
}

/// A scan and its truth.
pub struct Scan {
    pub points: Vec<DVec3>,
    pub bodies: Vec<Body>,
    /// Where each point was seen from.
    pub eyes: Vec<DVec3>,
    pub of: Vec<u32>,
    /// Height of the table or floor.
    pub ground: f64,
    pub model: Model,
    /// Diagonal of the object.
    pub diagonal: f64,
}

/// Elevation in degrees, poses around, distance in diagonals.
const RINGS: [(f64, usize, f64); 4] = [
    (16.0, 8, 2.0),
    (38.0, 6, 2.2),
    (62.0, 3, 2.2),
    (90.0, 1, 2.6),
];
/// Share of depth edges that give a flying pixel, and stray returns among all points.
const FLYING: f64 = 0.4;
const LOOSE: f64 = 0.004;
/// Cosine of the flattest incidence that returns.
const LEAST_COSINE: f64 = 0.12;

/// Size of the second object.
const SECOND: f64 = 0.5;

/// Something that rays hit.
enum Solid {
    /// At a place, so many times as large.
    Model(Model, DVec3, f64),
    /// Up to this distance from the axis through the origin.
    Ground(f64, f64),
    /// x or z is at most this far: a wall at minus that, up to a height and along to a width.
    Wall(usize, f64, f64),
}

/// The recipe for such scans: strays, then what carries, then all but the largest piece.
pub fn tidy() -> Vec<Step> {
    vec![Step::Outliers, Step::Flying, plane(Drop::All), largest()]
}

pub fn plane(drop: Drop) -> Step {
    Step::Plane {
        drop,
        behind: true,
        min_share: MIN_SHARE,
        seed: 0,
    }
}

pub fn largest() -> Step {
    Step::Pieces {
        keep: Keep::Largest(1),
        gap: GAP,
    }
}

impl Staged {
    /// Makes the scan.
    pub fn scan(&self) -> Scan {
        let (low, high) = self.model.bounds();
        let diagonal = low.distance(high);
        let ground = foot(self.model);
        let mut solids = vec![(Body::Object, Solid::Model(self.model, DVec3::ZERO, 1.0))];
        let half = 0.5 * dvec3(high.x - low.x, 0.0, high.z - low.z).length();
        match self.stage {
            Stage::Table => {
                solids.push((Body::Support, Solid::Ground(ground, half + 0.25 * diagonal)))
            }
            Stage::Room => {
                solids.push((Body::Support, Solid::Ground(ground, 1.1 * diagonal)));
                for axis in [0, 2] {
                    solids.push((Body::Support, Solid::Wall(axis, 0.75 * diagonal, ground)));
                }
            }
        }
        if let Some(second) = self.second {
            let (other, _) = second.bounds();
            let aside = high.x + 0.1 * diagonal - SECOND * other.x;
            let at = dvec3(aside, ground - SECOND * foot(second), 0.0);
            solids.push((Body::Second, Solid::Model(second, at, SECOND)));
        }
        let mut pitch = 0.05;
        let mut scan = self.raster(&solids, (diagonal, ground), pitch);
        while scan.points.len() < self.points {
            pitch *= (scan.points.len() as f64 / (1.02 * self.points as f64))
                .sqrt()
                .min(0.97);
            scan = self.raster(&solids, (diagonal, ground), pitch);
        }
        if self.strays {
            self.add_loose(&mut scan);
        }
        scan
    }

    fn raster(&self, solids: &[(Body, Solid)], (diagonal, ground): (f64, f64), pitch: f64) -> Scan {
        let mut rng = Rng::new(self.seed);
        let mut scan = Scan {
            points: Vec::new(),
            bodies: Vec::new(),
            eyes: Vec::new(),
            of: Vec::new(),
            ground,
            model: self.model,
            diagonal,
        };
        let (low, high) = self.model.bounds();
        let center = (low + high) / 2.0;
        for (elevation, around, reach) in RINGS {
            for step in 0..around {
                let turn =
                    (360.0 * (step as f64 + 0.3) / around as f64 + rng.normal()).to_radians();
                let (up, out) = (elevation.to_radians().sin(), elevation.to_radians().cos());
                let outward = dvec3(out * turn.cos(), up, out * turn.sin());
                let eye = center + outward * reach * diagonal;
                let behind_walls = self.stage == Stage::Room && eye.x.min(eye.z) < -0.7 * diagonal;
                if behind_walls {
                    continue;
                }
                let right = dvec3(-turn.sin(), 0.0, turn.cos());
                let above = right.cross(-outward);
                let view = scan.eyes.len() as u32;
                scan.eyes.push(eye);
                let half = (1.2 / reach / pitch) as i32;
                for row in -half..half {
                    let mut before: Option<f64> = None;
                    for column in -half..half {
                        let mut at =
                            |i: i32| pitch * (f64::from(i) + 0.2 * (2.0 * rng.uniform() - 1.0));
                        let ray = (-outward + right * at(column) + above * at(row)).normalize();
                        let hit = cast(solids, eye, ray);
                        if let (Some(before), Some((range, ..))) = (before, hit) {
                            let edge = (before - range).abs() > 0.05 * diagonal;
                            if edge && self.strays && rng.uniform() < FLYING {
                                let range = before + (range - before) * (0.1 + 0.8 * rng.uniform());
                                scan.push(eye + ray * range, Body::Stray, view);
                                continue;
                            }
                        }
                        before = hit.map(|(range, ..)| range);
                        let Some((range, body, normal)) = hit else {
                            continue;
                        };
                        if -ray.dot(normal) >= LEAST_COSINE {
                            let noise = self.noise * diagonal * rng.normal();
                            scan.push(eye + ray * (range + noise), body, view);
                        }
                    }
                }
            }
        }
        scan
    }

    /// Stray returns anywhere around.
    fn add_loose(&self, scan: &mut Scan) {
        let mut rng = Rng::new(self.seed ^ 0x6c6f_6f73);
        for _ in 0..(LOOSE * scan.points.len() as f64) as usize {
            let mut at = |low: f64, high: f64| low + (high - low) * rng.uniform();
            let d = scan.diagonal;
            let p = dvec3(at(-d, d), scan.ground + at(0.02 * d, d), at(-d, d));
            scan.push(p, Body::Stray, 0);
        }
    }
}

impl Scan {
    fn push(&mut self, p: DVec3, body: Body, view: u32) {
        self.points.push(p);
        self.bodies.push(body);
        self.of.push(view);
    }

    pub fn positions(&self) -> Vec<f64> {
        self.points.iter().flat_map(|p| p.to_array()).collect()
    }

    pub fn count(&self, body: Body) -> usize {
        self.bodies.iter().filter(|&&own| own == body).count()
    }
}

/// The least y of a model.
fn foot(model: Model) -> f64 {
    let scan = sample_with_noise(model, 8000, 1, 0.0);
    let heights = scan.positions.iter().skip(1).step_by(3);
    f64::from(heights.copied().fold(f32::INFINITY, f32::min))
}

/// What a ray hits first: range, body, normal.
fn cast(solids: &[(Body, Solid)], eye: DVec3, ray: DVec3) -> Option<(f64, Body, DVec3)> {
    let hits = solids.iter().filter_map(|(body, solid)| {
        let (range, normal) = solid.cast(eye, ray)?;
        Some((range, *body, normal))
    });
    hits.min_by(|a, b| a.0.total_cmp(&b.0))
}

impl Solid {
    fn cast(&self, eye: DVec3, ray: DVec3) -> Option<(f64, DVec3)> {
        match *self {
            Solid::Model(model, at, size) => {
                let (range, normal) = trace(model, (eye - at) / size, ray)?;
                Some((size * range, normal))
            }
            Solid::Ground(height, radius) => {
                let range = (height - eye.y) / ray.y;
                let p = eye + ray * range;
                (range > 0.0 && p.x.hypot(p.z) <= radius).then_some((range, DVec3::Y))
            }
            Solid::Wall(axis, away, ground) => {
                let range = (-away - eye[axis]) / ray[axis];
                let p = eye + ray * range;
                let along = p[2 - axis];
                let inside = (ground..ground + 1.3 * away).contains(&p.y)
                    && (-away..1.4 * away).contains(&along);
                let normal = if axis == 0 { DVec3::X } else { DVec3::Z };
                (range > 0.0 && inside).then_some((range, normal))
            }
        }
    }
}

/// Sphere tracing inside of a model's box.
fn trace(model: Model, eye: DVec3, ray: DVec3) -> Option<(f64, DVec3)> {
    let (low, high) = model.bounds();
    let inverse = ray.recip();
    let (a, b) = ((low - eye) * inverse, (high - eye) * inverse);
    let mut range = a.min(b).max_element().max(0.0);
    let end = a.max(b).min_element();
    let close = 1e-5 * low.distance(high);
    for _ in 0..200 {
        if range > end {
            return None;
        }
        let p = eye + ray * range;
        let gap = model.distance(p);
        if gap.abs() < close {
            return Some((range, model.gradient(p).normalize_or(-ray)));
        }
        range += gap;
    }
    None
}
