//! How well two scans fit under a motion.

use super::pose::Pose;
use super::samples::Samples;
use crate::base::par;
use crate::cloud::queries::Neighbor;
use glam::{DVec3, Vec3};
use nalgebra::{Cholesky, Matrix6, Vector6};

/// Across a surface, in cells: points within this lie on it; those farther off, but within the next, stand against it.
const ON: f32 = 0.25;
const OFF: f32 = 1.25;
/// Along a surface, in cells.
const BESIDE: f32 = 1.75;
/// Cosine of the largest angle between the normals of one place.
const ALONG: f32 = 0.85;

/// Samples that a scan needs.
pub(crate) const LEAST: usize = 40;
/// What a trusted motion has: samples on the other scan, overlap, quality and hold. Of 110 pairs of different things of one size none came
/// nearer than an overlap of 0.22 with a quality of 0.87; the raw bunny's true pairs that overlap by as much as this have 0.85 to 0.99.
const TRUSTED: (usize, f64, f64, f64) = (100, 0.25, 0.85, 0.004);
/// Overlap and quality of one that is trusted before all others are known.
const FIRM: (f64, f64) = (0.35, 0.9);

/// What the samples of two scans say of a motion.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Agreement {
    /// Samples of the first that lie on the second, and of the second on the first.
    pub(crate) on: [usize; 2],
    /// Samples of either that lie near the other and not on it.
    pub(crate) off: [usize; 2],
    /// How many there are of either.
    pub(crate) of: [usize; 2],
    /// Σ of squares of the distances across, of those that lie on.
    pub(crate) squares: f64,
    /// How firmly they hold each other: the least share of what all would hold if their normals pointed everywhere.
    pub(crate) hold: f64,
}

impl Agreement {
    /// Of `a` moved by `pose` and `b`.
    pub(crate) fn of(a: &Samples, pose: &Pose, b: &Samples) -> Agreement {
        Agreement::between(&[(a, *pose)], &[(b, Pose::IDENTITY)])
    }

    /// Of two groups of scans, each with its pose in one frame. A sample counts once, however many scans it lies on.
    pub(crate) fn between(a: &[Posed], b: &[Posed]) -> Agreement {
        let mut sum = Agreement::default();
        let mut held = Vec::new();
        for (k, (own, other)) in [(a, b), (b, a)].into_iter().enumerate() {
            for &(samples, pose) in own {
                let mut seen = vec![Seen::Nothing; samples.len()];
                for &(others, there) in other {
                    let found = looks(samples, &there.back().after(&pose), others);
                    for (seen, found) in seen.iter_mut().zip(found) {
                        *seen = seen.or(found);
                    }
                }
                for (&at, seen) in samples.tree.points.iter().zip(&seen) {
                    match seen {
                        Seen::On { across, normal, .. } => {
                            sum.on[k] += 1;
                            sum.squares += across * across;
                            held.push((pose.at(at.as_dvec3()), pose.turn * normal.as_dvec3()));
                        }
                        Seen::Off => sum.off[k] += 1,
                        Seen::Nothing => {}
                    }
                }
                sum.of[k] += samples.len();
            }
        }
        sum.hold = hold(&held);
        sum
    }

    /// How much is said for a motion: samples on, the fewer the more is against it.
    pub(crate) fn weight(&self) -> f64 {
        (self.on[0] + self.on[1]) as f64 * self.quality() * self.quality()
    }

    /// Share of the samples near the other surface that lie on it.
    pub(crate) fn quality(&self) -> f64 {
        let on = (self.on[0] + self.on[1]) as f64;
        let off = (self.off[0] + self.off[1]) as f64;
        on / (on + off).max(1.0)
    }

    /// Share of a scan that lies on the other: that of the scan of which it is more.
    pub(crate) fn overlap(&self) -> f64 {
        let share = |k: usize| self.on[k] as f64 / self.of[k].max(1) as f64;
        share(0).max(share(1))
    }

    /// Whether the motion is to be trusted.
    pub(crate) fn is_trusted(&self) -> bool {
        let (on, overlap, quality, hold) = TRUSTED;
        self.on[0] + self.on[1] >= on
            && self.overlap() >= overlap
            && self.quality() >= quality
            && self.hold >= hold
    }

    /// Whether it is before all others are known.
    pub(crate) fn is_firm(&self) -> bool {
        self.is_trusted() && self.overlap() >= FIRM.0 && self.quality() >= FIRM.1
    }

    /// Whether two scans of one frame lie on each other.
    pub(crate) fn overlaps(&self) -> bool {
        self.overlap() >= 0.05 && self.quality() >= 0.5
    }

    /// Root of the mean square of the distances across.
    pub(crate) fn rms(&self) -> f64 {
        (self.squares / (self.on[0] + self.on[1]).max(1) as f64).sqrt()
    }
}

/// Samples and how they lie in a common frame.
pub(crate) type Posed<'a> = (&'a Samples, Pose);

/// What a sample sees of another scan.
#[derive(Debug, Clone, Copy)]
enum Seen {
    Nothing,
    /// It lies on this sample, so far off. The normal is its own.
    On {
        place: u32,
        normal: Vec3,
        across: f64,
    },
    Off,
}

impl Seen {
    fn or(self, other: Seen) -> Seen {
        match (self, other) {
            (Seen::On { .. }, _) | (Seen::Off, Seen::Nothing) => self,
            _ => other,
        }
    }
}

/// Which sample of `b` each sample of `a` lies on, where it lies on one.
pub(crate) fn matched(a: &Samples, pose: &Pose, b: &Samples) -> Vec<(usize, usize)> {
    let seen = looks(a, pose, b).into_iter().enumerate();
    let on = |(i, seen)| match seen {
        Seen::On { place, .. } => Some((i, place as usize)),
        _ => None,
    };
    seen.filter_map(on).collect()
}

/// What each sample of `a`, moved by `pose`, sees of `b`.
fn looks(a: &Samples, pose: &Pose, b: &Samples) -> Vec<Seen> {
    let cell = a.cell;
    let look = |i: usize, _: &mut ()| {
        let at = pose.at_single(a.tree.points[i]);
        let limit = Neighbor {
            distance2: (BESIDE * BESIDE + OFF * OFF) * cell * cell,
            index: u32::MAX,
        };
        let place = b.tree.nearer_than(limit, at).index;
        let j = place as usize;
        if j >= b.len() {
            return Seen::Nothing;
        }
        let (normal, own) = (b.normals[j], pose.along(a.normals[i]));
        let cosine = normal.dot(own);
        let mean = if cosine < 0.0 {
            normal - own
        } else {
            normal + own
        };
        let mean = mean.normalize_or_zero();
        let apart = at - b.tree.points[j];
        let across = apart.dot(mean);
        let beside = (apart - across * mean).length();
        if across.abs() < ON * cell && cosine.abs() > ALONG && beside < BESIDE * cell {
            return Seen::On {
                place,
                normal: a.normals[i],
                across: across.into(),
            };
        }
        // Beyond the end of a scan nothing is known.
        if a.rim[i] || b.rim[j] || beside > cell {
            return Seen::Nothing;
        }
        Seen::Off
    };
    par::map(a.len(), || (), look)
}

/// What planes through points hold of a body: all six ways to move, or fewer (Gelfand, Ikemoto, Rusinkiewicz, Levoy, "Geometrically
/// stable sampling for the ICP algorithm", 2003). Least eigenvalue of the mean of the products of (x × n, n), turns about the middle
/// and in units of the mean radius.
fn hold(points: &[(DVec3, DVec3)]) -> f64 {
    let count = points.len() as f64;
    if points.len() < 6 {
        return 0.0;
    }
    let middle = points.iter().map(|(p, _)| *p).sum::<DVec3>() / count;
    let square: f64 = points.iter().map(|(p, _)| p.distance_squared(middle)).sum();
    let radius = (square / count).sqrt();
    let mut sum = Matrix6::zeros();
    for (p, n) in points {
        let turn = (*p - middle).cross(*n) / radius;
        let row = Vector6::new(turn.x, turn.y, turn.z, n.x, n.y, n.z);
        sum += row * row.transpose() / count;
    }
    least_eigenvalue(sum)
}

/// Of a positive matrix, by inverse iteration.
fn least_eigenvalue(matrix: Matrix6<f64>) -> f64 {
    let shifted = matrix + Matrix6::identity() * 1e-9;
    let Some(cholesky) = Cholesky::new(shifted) else {
        return 0.0;
    };
    let mut v = Vector6::new(1.0, 0.9, 1.1, 0.8, 1.2, 0.7);
    let mut value = 0.0;
    for _ in 0..30 {
        v /= v.norm();
        let next = cholesky.solve(&v);
        value = 1.0 / next.norm();
        v = next;
    }
    value
}
