//! A simulated laser scanner.
//!
//! The model stands on a turntable in front of the sensor, is tilted, and is turned over for its underside: 20 poses
//! in all, each a little off its nominal angle and distance. From each pose a raster of rays, all of one angular pitch, goes over
//! the model's bounding box. A ray that hits gives one point, so the density falls with the incidence and the distance
//! and adds up where poses overlap, and what no pose sees stays empty. Returns at less than 7° to the surface are
//! dropped, as real scanners do. The range along the ray carries Gaussian noise.

use super::model::Model;
use crate::base::par;
use crate::base::rng::Rng;
use glam::DVec3;

/// One measured point.
#[derive(Clone)]
pub(super) struct Hit {
    /// Measured, with noise.
    pub(super) position: DVec3,
    /// Where the ray met the surface.
    pub(super) truth: DVec3,
    /// Outward normal there.
    pub(super) normal: DVec3,
}

/// Elevation above the table in degrees, number of poses around, sensor distance in diagonals. The last is a close-up
/// of the front.
const RINGS: [(f64, usize, f64); 6] = [
    (14.0, 8, 1.6),
    (52.0, 5, 1.9),
    (-42.0, 4, 1.9),
    (90.0, 1, 2.2),
    (-90.0, 1, 2.2),
    (22.0, 1, 1.0),
];
/// Standard deviation of a pose's angles in degrees, and of its distance as a fraction.
const POSE_JITTER: (f64, f64) = (1.5, 0.03);
/// A ray's offset from the raster, in pitches.
const RAY_JITTER: f64 = 0.2;
/// Cosine of the flattest incidence that returns.
const LEAST_COSINE: f64 = 0.12;
/// Steps of a ray before it counts as a miss; it gets there only by grazing.
const MOST_STEPS: usize = 160;
/// Hits to aim at for each point that is wanted.
const SURPLUS: f64 = 1.02;
/// A ray has met the surface within this fraction of the diagonal.
const CONTACT: f64 = 1e-6;
/// Within this fraction of the diagonal the surface is taken as flat.
const CLOSE: f64 = 2e-3;

/// One pose: the sensor, its axes, and the raster's window in units of tangent.
struct Pose {
    sensor: DVec3,
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    low: [f64; 2],
    high: [f64; 2],
}

/// Exactly `count` points; `noise` is the standard deviation of the range as a fraction of the diagonal.
pub(super) fn scan(model: Model, count: usize, noise: f64, seed: u64) -> Vec<Hit> {
    if count == 0 {
        return Vec::new();
    }
    let scanner = Scanner::new(model, noise, seed);
    // A coarse raster tells how many rays hit; the pitch that gives a few points too many follows.
    let mut pitch = 0.02;
    let mut hits = scanner.raster(pitch);
    while hits.len() < count {
        let scale = (hits.len() as f64 / (SURPLUS * count as f64)).sqrt();
        pitch *= scale.min(0.99);
        hits = scanner.raster(pitch);
    }
    thin(hits, count, seed)
}

/// Takes `count` of the hits at random, in order.
pub(super) fn thin(hits: Vec<Hit>, count: usize, seed: u64) -> Vec<Hit> {
    let mut rng = Rng::new(seed ^ 0x7468_696e);
    let mut left = hits.len();
    let mut wanted = count;
    hits.into_iter()
        .filter(|_| {
            let take = rng.uniform() * (left as f64) < wanted as f64;
            left -= 1;
            wanted -= usize::from(take);
            take
        })
        .collect()
}

impl Pose {
    /// A pose whose window holds the box low-high.
    fn looking_at(sensor: DVec3, forward: DVec3, right: DVec3, low: DVec3, high: DVec3) -> Pose {
        let up = right.cross(forward);
        let mut pose = Pose {
            sensor,
            forward,
            right,
            up,
            low: [f64::INFINITY; 2],
            high: [f64::NEG_INFINITY; 2],
        };
        for corner in 0..8 {
            let pick = |axis: usize| {
                if corner >> axis & 1 == 0 {
                    low[axis]
                } else {
                    high[axis]
                }
            };
            let q = DVec3::new(pick(0), pick(1), pick(2)) - sensor;
            for (axis, direction) in [right, up].into_iter().enumerate() {
                let tangent = q.dot(direction) / q.dot(forward);
                pose.low[axis] = pose.low[axis].min(tangent);
                pose.high[axis] = pose.high[axis].max(tangent);
            }
        }
        pose
    }
}

/// A model in front of the sensor.
struct Scanner {
    model: Model,
    low: DVec3,
    high: DVec3,
    diagonal: f64,
    /// Standard deviation of the range.
    sigma: f64,
    seed: u64,
    poses: Vec<Pose>,
    clearance: Clearance,
}

impl Scanner {
    fn new(model: Model, noise: f64, seed: u64) -> Scanner {
        let (low, high) = model.bounds();
        let diagonal = low.distance(high);
        let poses = poses(low, high, seed);
        let clearance = Clearance::of(model);
        let sigma = noise * diagonal;
        Scanner {
            model,
            low,
            high,
            diagonal,
            sigma,
            seed,
            poses,
            clearance,
        }
    }

    /// All hits of all poses with rays `pitch` apart in tangent, in raster order.
    fn raster(&self, pitch: f64) -> Vec<Hit> {
        let mut rng = Rng::new(self.seed);
        let mut lines = Vec::new();
        for pose in &self.poses {
            let rows = ((pose.high[1] - pose.low[1]) / pitch).ceil() as usize;
            lines.extend((0..rows).map(|row| (pose, row, rng.next_u64())));
        }
        let line = |i: usize, _: &mut ()| {
            let (pose, row, seed) = lines[i];
            self.line(pose, row, pitch, Rng::new(seed))
        };
        par::map(lines.len(), || (), line).concat()
    }

    /// The hits of one raster line.
    fn line(&self, pose: &Pose, row: usize, pitch: f64, mut rng: Rng) -> Vec<Hit> {
        let columns = ((pose.high[0] - pose.low[0]) / pitch).ceil() as usize;
        let mut hits = Vec::new();
        for column in 0..columns {
            let mut offset =
                |i: usize| pitch * (i as f64 + RAY_JITTER * (2.0 * rng.uniform() - 1.0));
            let u = pose.low[0] + offset(column);
            let v = pose.low[1] + offset(row);
            let ray = (pose.forward + pose.right * u + pose.up * v).normalize();
            let Some(range) = self.trace(pose.sensor, ray) else {
                continue;
            };
            let truth = pose.sensor + ray * range;
            let normal = self.model.gradient(truth).normalize_or(-ray);
            if -ray.dot(normal) >= LEAST_COSINE {
                let position = truth + ray * (self.sigma * rng.normal());
                hits.push(Hit {
                    position,
                    truth,
                    normal,
                });
            }
        }
        hits
    }

    /// Range at which a ray meets the surface: sphere tracing inside the bounding box (Hart 1996).
    fn trace(&self, from: DVec3, ray: DVec3) -> Option<f64> {
        let inverse = ray.recip();
        let (a, b) = ((self.low - from) * inverse, (self.high - from) * inverse);
        let mut range = a.min(b).max_element();
        let end = a.max(b).min_element();
        let mut before: Option<(f64, f64)> = None;
        for _ in 0..MOST_STEPS {
            if range > end {
                return None;
            }
            let p = from + ray * range;
            let clear = self.clearance.at(p);
            if clear > self.clearance.cell / 4.0 {
                range += clear;
                continue;
            }
            let gap = self.model.distance(p);
            if gap.abs() < CONTACT * self.diagonal {
                return Some(range);
            }
            // Close to the surface by the secant through the last two gaps, else by the gap, which is always safe.
            let slope = match before {
                Some((at, value)) if gap < CLOSE * self.diagonal => {
                    ((value - gap) / (range - at)).clamp(LEAST_COSINE, 1.0)
                }
                _ => 1.0,
            };
            before = Some((range, gap));
            range += gap / slope;
        }
        None
    }
}

/// All poses around a bounding box.
fn poses(low: DVec3, high: DVec3, seed: u64) -> Vec<Pose> {
    let center = (low + high) / 2.0;
    let diagonal = low.distance(high);
    let mut rng = Rng::new(seed ^ 0x706f_7365);
    let mut poses = Vec::new();
    for (elevation, around, reach) in RINGS {
        for step in 0..around {
            let elevation = elevation + POSE_JITTER.0 * rng.normal();
            let azimuth = 360.0 * step as f64 / around as f64 + POSE_JITTER.0 * rng.normal();
            let reach = reach * diagonal * (1.0 + POSE_JITTER.1 * rng.normal());
            let (sin_e, cos_e) = libm::sincos(elevation.to_radians());
            let (sin_a, cos_a) = libm::sincos(azimuth.to_radians());
            let outward = DVec3::new(cos_e * cos_a, sin_e, cos_e * sin_a);
            let right = DVec3::new(-sin_a, 0.0, cos_a);
            let sensor = center + outward * reach;
            poses.push(Pose::looking_at(sensor, -outward, right, low, high));
        }
    }
    poses
}

/// A coarse grid over the bounding box: how far a ray may step from anywhere in a cell. Far from the surface a look-up
/// takes the place of the exact distance.
struct Clearance {
    low: DVec3,
    cell: f64,
    size: [usize; 3],
    steps: Vec<f64>,
}

impl Clearance {
    /// Cells along the longest side.
    const CELLS: f64 = 40.0;

    fn of(model: Model) -> Clearance {
        let (low, high) = model.bounds();
        let cell = (high - low).max_element() / Self::CELLS;
        let size = [0, 1, 2].map(|axis| ((high[axis] - low[axis]) / cell).ceil() as usize);
        let reach = cell * 3f64.sqrt() / 2.0;
        let layers = par::map(
            size[0],
            || (),
            |i, ()| {
                let center = |j: usize, k: usize| {
                    low + (DVec3::new(i as f64, j as f64, k as f64) + 0.5) * cell
                };
                let cells = (0..size[1] * size[2]).map(|jk| center(jk / size[2], jk % size[2]));
                cells
                    .map(|p| model.distance(p) - reach)
                    .collect::<Vec<f64>>()
            },
        );
        Clearance {
            low,
            cell,
            size,
            steps: layers.concat(),
        }
    }

    fn at(&self, p: DVec3) -> f64 {
        let q = (p - self.low) / self.cell;
        let [i, j, k] = [0, 1, 2].map(|axis| (q[axis] as usize).min(self.size[axis] - 1));
        self.steps[(i * self.size[1] + j) * self.size[2] + k]
    }
}
