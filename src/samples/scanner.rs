//! A simulated laser scanner.
//!
//! The model stands on a turntable in front of the sensor, is tilted, and is turned over for its underside: 22 poses
//! in all, each a little off its nominal angle and distance. From each pose a raster of rays, all of one angular pitch, goes over
//! the model's bounding box. A ray that hits gives one point, so the density falls with the incidence and the distance
//! and adds up where poses overlap, and what no pose sees stays empty. Returns at less than 7° to the surface are
//! dropped, as real scanners do. The range along the ray carries Gaussian noise.

use super::Model;
use crate::par;
use crate::rng::Rng;
use glam::DVec3;

/// One measured point.
pub(super) struct Hit {
    /// Measured, with noise.
    pub(super) position: DVec3,
    /// Where the ray met the surface.
    pub(super) truth: DVec3,
    /// Outward normal there.
    pub(super) normal: DVec3,
}

/// Elevation above the table in degrees, number of poses around, sensor distance in diagonals.
const RINGS: [(f64, usize, f64); 5] = [
    (14.0, 8, 1.6),
    (52.0, 6, 1.9),
    (-42.0, 6, 1.9),
    (90.0, 1, 2.2),
    (-90.0, 1, 2.2),
];
/// Standard deviation of a pose's angles in degrees, and of its distance as a fraction.
const POSE_JITTER: (f64, f64) = (1.5, 0.03);
/// A ray's offset from the raster, in pitches.
const RAY_JITTER: f64 = 0.2;
/// Cosine of the flattest incidence that returns.
const LEAST_COSINE: f64 = 0.12;
/// Steps of a ray before it counts as a miss; it gets there only by grazing.
const MOST_STEPS: usize = 160;
/// A ray has met the surface within this fraction of the diagonal.
const CONTACT: f64 = 1e-6;

/// One pose: the sensor, its axes, and the raster's window in units of tangent.
struct Pose {
    sensor: DVec3,
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    low: [f64; 2],
    high: [f64; 2],
}

/// One raster line of one pose.
struct Line<'a> {
    pose: &'a Pose,
    v: f64,
    seed: u64,
}

/// Exactly `count` points; `noise` is the standard deviation of the range as a fraction of the diagonal.
pub(super) fn scan(model: Model, count: usize, noise: f64, seed: u64) -> Vec<Hit> {
    if count == 0 {
        return Vec::new();
    }
    let poses = poses(model, seed);
    // A coarse raster tells how many rays hit; the pitch that gives a few points too many follows.
    let mut pitch = 0.02;
    let mut hits = raster(model, &poses, pitch, noise, seed);
    let surplus = 1.02;
    while hits.len() < count {
        let scale = (hits.len() as f64 / (surplus * count as f64)).sqrt();
        pitch *= scale.min(0.99);
        hits = raster(model, &poses, pitch, noise, seed);
    }
    thin(hits, count, seed)
}

/// Takes `count` of the hits at random, in order.
fn thin(hits: Vec<Hit>, count: usize, seed: u64) -> Vec<Hit> {
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

fn poses(model: Model, seed: u64) -> Vec<Pose> {
    let (low, high) = model.bounds();
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

/// All hits of all poses, in raster order.
fn raster(model: Model, poses: &[Pose], pitch: f64, noise: f64, seed: u64) -> Vec<Hit> {
    let mut rng = Rng::new(seed);
    let mut lines = Vec::new();
    for pose in poses {
        let rows = ((pose.high[1] - pose.low[1]) / pitch).ceil() as usize;
        lines.extend((0..rows).map(|row| Line {
            pose,
            v: pose.low[1] + pitch * row as f64,
            seed: rng.next_u64(),
        }));
    }
    par::map(
        lines.len(),
        || (),
        |i, ()| lines[i].hits(model, pitch, noise),
    )
    .into_iter()
    .flatten()
    .collect()
}

impl Line<'_> {
    fn hits(&self, model: Model, pitch: f64, noise: f64) -> Vec<Hit> {
        let pose = self.pose;
        let mut rng = Rng::new(self.seed);
        let (low, high) = model.bounds();
        let sigma = noise * low.distance(high);
        let columns = ((pose.high[0] - pose.low[0]) / pitch).ceil() as usize;
        let mut hits = Vec::new();
        for column in 0..columns {
            let mut jitter = || pitch * RAY_JITTER * (2.0 * rng.uniform() - 1.0);
            let u = pose.low[0] + pitch * column as f64 + jitter();
            let v = self.v + jitter();
            let ray = (pose.forward + pose.right * u + pose.up * v).normalize();
            let Some(range) = trace(model, pose.sensor, ray) else {
                continue;
            };
            let truth = pose.sensor + ray * range;
            let normal = model.gradient(truth).normalize_or(-ray);
            if -ray.dot(normal) < LEAST_COSINE {
                continue;
            }
            let position = truth + ray * (sigma * rng.normal());
            hits.push(Hit {
                position,
                truth,
                normal,
            });
        }
        hits
    }
}

/// Range at which a ray meets the surface: sphere tracing inside the bounding box (Hart 1996).
fn trace(model: Model, from: DVec3, ray: DVec3) -> Option<f64> {
    let (low, high) = model.bounds();
    let inverse = ray.recip();
    let (a, b) = ((low - from) * inverse, (high - from) * inverse);
    let mut range = a.min(b).max_element();
    let end = a.max(b).min_element();
    let contact = CONTACT * low.distance(high);
    for _ in 0..MOST_STEPS {
        if range > end {
            return None;
        }
        let gap = model.distance(from + ray * range);
        if gap < contact {
            return Some(range);
        }
        range += gap;
    }
    None
}
