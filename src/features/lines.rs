//! Scan lines: rows of points much farther apart than the points of a row, as laser lines and spinning scanners give them.
//!
//! The nearest points of such a point lie along its own line, and say nothing of the surface. So a line is thinned until
//! its points are no nearer than a part of the way to the next line: then the nearest are those around.
//!
//! 1. The *reach* of a point is the distance within which its neighbours spread in two directions: the least radius for which
//!    the second eigenvalue of their covariance is a quarter of the first (Pauly, Gross, Kobbelt, "Efficient simplification of
//!    point-sampled surfaces", 2002, for the covariance). On lines that is the distance to the next one.
//! 2. Points whose reach holds many others are on lines. Where few are, there are no lines: those are ends and wires.
//! 3. Points of lines that are nearer than [`PITCH`] of their reach are one *place*, at their mean.
//!
//! By place: a sweep is thinned where its lines are far apart, and nowhere else.

use crate::base::linalg::{Spread, outer, sym_eigen};
use crate::base::par;
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;
use crate::features::noise::{Scales, quantile};
use crate::features::values::Features;
use glam::{DVec3, Vec3};
use nalgebra::{SMatrix, SVector};

/// Least ratio of the second eigenvalue to the first of neighbours that spread in two directions.
const SPREAD: f64 = 0.25;
/// Neighbours that are asked at first, and then where these are on a line. Even points need no more than the first.
const NEIGHBORS: [usize; 4] = [24, 64, 160, 512];
/// Neighbours that are looked at for their spread, at least.
const FEWEST: usize = 8;
/// Points of a line around one that tell the noise.
const ON_LINE: usize = 9;
/// Points that are close together and have one reach.
const TOGETHER: usize = 8;
/// Points that are asked whether there are lines.
const ASKED: usize = 2048;
/// Share of the points that must be on lines, and how many points their reach then holds at least: lines six times as far
/// apart as their points have a quarter of the points beyond that, the bench's clouds 0.4 % at most.
const LINES: (f32, usize) = (0.1, 20);
/// Where there are lines, points whose reach holds more than this are thinned. Even points need eight.
const THINNED: usize = 12;
/// Points nearer than this share of the reach are one place.
const PITCH: f32 = 0.2;
/// Places that tell what is known of a point.
const AROUND: usize = 4;
/// Cosine of the largest turn between a point's normal and those that tell it: 60°.
const SAME_SIDE: f32 = 0.5;

/// Whether a scan has lines, of whose points so many are on them.
pub(crate) fn are_there(on_lines: f32, points: f32) -> bool {
    on_lines >= LINES.0 * points
}

/// What is known of the lines of a scan, in the unit frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lines {
    /// Noise and median spacing of the places.
    pub(crate) places: (f32, f32),
    /// Share of the points that are on lines.
    pub(crate) share: f32,
}

/// The points of a cloud by places.
#[derive(Debug)]
pub(crate) struct Thinned {
    /// The places, in the order of their first points.
    pub(crate) places: Vec<Vec3>,
    /// The place of each point, in the octree's order.
    pub(crate) place_of: Vec<u32>,
    /// Share of the points that are on lines.
    share: f32,
}

impl Thinned {
    /// `None` where there are no lines.
    pub(crate) fn of(tree: &Octree) -> Option<Thinned> {
        let (on_lines, asked) = Thinned::asked(tree);
        are_there(on_lines as f32, asked as f32).then(|| Thinned::along_lines(tree))
    }

    /// How many points are on lines, and of how many that is said.
    pub(crate) fn asked(tree: &Octree) -> (usize, usize) {
        let n = tree.points.len();
        let step = n.div_ceil(ASKED).max(1);
        let some = par::map(n.div_ceil(step), Vec::new, |i, found| {
            reach(tree, i * step, found).is_some_and(|(k, _)| k > LINES.1)
        });
        (some.iter().filter(|&&is| is).count(), some.len())
    }

    /// The places of a cloud that has lines.
    pub(crate) fn along_lines(tree: &Octree) -> Thinned {
        let n = tree.points.len();
        let some = par::map(n.div_ceil(TOGETHER), Vec::new, |c, found| {
            let middle = (c * TOGETHER + TOGETHER / 2).min(n - 1);
            match reach(tree, middle, found) {
                Some((k, radius)) if k > THINNED => PITCH * radius,
                _ => 0.0,
            }
        });
        let pitch: Vec<f32> = (0..n).map(|i| some[i / TOGETHER]).collect();
        let share = pitch.iter().filter(|&&p| p > 0.0).count() as f32 / n.max(1) as f32;
        let kept = kept(tree, &pitch);
        let place_of = par::map(n, Vec::new, |i, found: &mut Vec<u32>| {
            nearest_kept(tree, i, pitch[i], &kept.place, found)
        });
        let mut sums = vec![(DVec3::ZERO, 0.0); kept.count];
        for (&place, p) in place_of.iter().zip(&tree.points) {
            let (sum, count) = &mut sums[place as usize];
            *sum += p.as_dvec3();
            *count += 1.0;
        }
        Thinned {
            places: sums.iter().map(|(sum, n)| (*sum / *n).as_vec3()).collect(),
            place_of,
            share,
        }
    }

    /// What is left of the points' `noise` in the mean of a place, mostly.
    pub(crate) fn noise_of_places(&self, noise: f32) -> f32 {
        noise * (self.places.len() as f32 / self.place_of.len() as f32).sqrt()
    }

    /// What the points know from what was measured of the places, whose octree is `places`: a point has its share of its
    /// place's area, and the normal and the offset that the places around it tell. `noise` is that of the points.
    pub(crate) fn features(
        &self,
        (tree, noise): (&Octree, f32),
        (places, of): (&Octree, &Features),
    ) -> Features {
        let mut at = vec![0u32; places.order.len()];
        for (k, &place) in places.order.iter().enumerate() {
            at[place as usize] = k as u32;
        }
        let mut counts = vec![0.0f32; at.len()];
        for &place in &self.place_of {
            counts[place as usize] += 1.0;
        }
        let spacing_of = |i: usize| {
            let place = self.place_of[i] as usize;
            of.spacing[at[place] as usize] / counts[place].sqrt()
        };
        let told = par::map(
            tree.points.len(),
            Vec::new,
            |i, found: &mut Vec<Neighbor>| {
                places.knn(tree.points[i], AROUND, found);
                let (normal, residual) = told(tree.points[i], places, of, found);
                (normal, Scales::new(noise, spacing_of(i)).denoise * residual)
            },
        );
        let n = 0..tree.points.len();
        let place = |i: usize| at[self.place_of[i] as usize] as usize;
        Features {
            spacing: n.clone().map(spacing_of).collect(),
            normals: told.iter().map(|t| t.0).collect(),
            curvature: n.clone().map(|i| of.curvature[place(i)]).collect(),
            variation: n.map(|i| of.variation[place(i)]).collect(),
            residual: told.iter().map(|t| t.1).collect(),
            noise: noise.max(of.steps),
            steps: of.steps,
            lines: self.share,
        }
    }
}

/// Normal of a point and its distance to the surface, from the places `near` it: as the filter has it, the mean of
/// `½ (n_i + n_j)·(x_i - x_j)` over those on its side.
fn told(p: Vec3, places: &Octree, of: &Features, near: &[Neighbor]) -> (Vec3, f32) {
    let Some(first) = near.first() else {
        return (Vec3::ZERO, 0.0);
    };
    let own = of.normals[first.index as usize];
    let rim = 1.1 * near[near.len() - 1].distance2.max(f32::MIN_POSITIVE);
    let on_side = || {
        near.iter().filter_map(|n| {
            let normal = of.normals[n.index as usize];
            let along = normal.dot(own);
            let weight = 1.0 - n.distance2 / rim;
            (along.abs() > SAME_SIDE).then_some((n.index as usize, normal * along.signum(), weight))
        })
    };
    let sum: Vec3 = on_side().map(|(_, normal, weight)| weight * normal).sum();
    let normal = sum.normalize_or(own);
    let (mut offset, mut weights) = (0.0, 0.0);
    for (k, other, weight) in on_side() {
        let sign = of.normals[k].dot(other).signum();
        let away = 0.5 * (normal + other).dot(p - places.points[k]) + sign * of.residual[k];
        offset += weight * away;
        weights += weight;
    }
    (normal, offset / weights.max(f32::MIN_POSITIVE))
}

/// How many neighbours spread in two directions, and still do when they are twice as many, as those of a noisy line do not;
/// and the distance of the last of them. `None` where they never do.
fn reach(tree: &Octree, i: usize, found: &mut Vec<Neighbor>) -> Option<(usize, f32)> {
    let p = tree.points[i];
    for asked in NEIGHBORS {
        tree.knn(p, asked, found);
        let (mut sum, mut squares) = (DVec3::ZERO, [0.0; 6]);
        let mut next = FEWEST;
        let mut since = None;
        for (k, near) in found.iter().enumerate() {
            let d = (tree.points[near.index as usize] - p).as_dvec3();
            sum += d;
            for (s, product) in squares.iter_mut().zip(outer(d)) {
                *s += product;
            }
            if k + 1 < next {
                continue;
            }
            next = (next * 5).div_ceil(4);
            let count = (k + 1) as f64;
            let mean = outer(sum / count);
            let covariance = std::array::from_fn(|a| squares[a] / count - mean[a]);
            let [_, middle, long] = sym_eigen(&covariance).values;
            if middle < SPREAD * long || long == 0.0 {
                since = None;
                continue;
            }
            let (first, radius) = *since.get_or_insert((k + 1, near.distance2.sqrt()));
            if k + 1 >= 2 * first {
                return Some((first, radius));
            }
        }
        if found.len() < asked {
            return since;
        }
    }
    None
}

/// Noise of points on lines: what they stand off the parabola through those next to them on their line. Whatever bends the
/// line more slowly is detail.
pub(crate) fn noise(tree: &Octree) -> f32 {
    let n = tree.points.len();
    let step = n.div_ceil(ASKED).max(1);
    let off = par::map(
        n.div_ceil(step),
        Vec::new,
        |i, found: &mut Vec<Neighbor>| {
            let p = tree.points[i * step];
            tree.knn(p, ON_LINE, found);
            let near = || {
                let each = found.iter();
                each.map(|n| (tree.points[n.index as usize] - p).as_dvec3())
            };
            let eigen = Spread::of(near()).eigen;
            let along = eigen.vectors[2];
            let scale = eigen.values[2].sqrt().max(f64::MIN_POSITIVE);
            // The parabola at the point itself, where s = 0.
            let mut parabola = SMatrix::<f64, 3, 3>::identity() * 1e-9;
            let mut right = SMatrix::<f64, 3, 3>::zeros();
            for d in near() {
                let s = d.dot(along) / scale;
                let row = SVector::<f64, 3>::new(1.0, s, s * s);
                parabola += row * row.transpose();
                right += row * SVector::<f64, 3>::from(d.to_array()).transpose();
            }
            let Some(inverse) = parabola.try_inverse() else {
                return 0.0;
            };
            let at = (inverse * right).row(0).transpose();
            let at = DVec3::new(at[0], at[1], at[2]).reject_from_normalized(along);
            let free = (1.0 - inverse[(0, 0)]).max(0.1);
            (at.length() / free.sqrt()) as f32
        },
    );
    // The lower quartile of the absolute value of a normal variable is 0.3186 of its standard deviation.
    quantile(off, 4) / 0.3186
}

/// Which points are kept: none within the pitch of one before it.
struct Kept {
    /// The place of a kept point; `u32::MAX` for one that is not.
    place: Vec<u32>,
    count: usize,
}

fn kept(tree: &Octree, pitch: &[f32]) -> Kept {
    let mut place = vec![u32::MAX; pitch.len()];
    let mut count = 0;
    let mut found = Vec::new();
    for (i, &pitch) in pitch.iter().enumerate() {
        let p = tree.points[i];
        let is_near = pitch > 0.0 && {
            found.clear();
            tree.gather(p - pitch, p + pitch, usize::MAX, &mut found);
            found.iter().any(|&j| {
                let j = j as usize;
                place[j] != u32::MAX && tree.points[j].distance(p) < pitch
            })
        };
        if !is_near {
            place[i] = count;
            count += 1;
        }
    }
    Kept {
        place,
        count: count as usize,
    }
}

/// The place of the kept point that is nearest to `i`.
fn nearest_kept(tree: &Octree, i: usize, pitch: f32, place: &[u32], found: &mut Vec<u32>) -> u32 {
    if place[i] != u32::MAX {
        return place[i];
    }
    let p = tree.points[i];
    found.clear();
    tree.gather(p - pitch, p + pitch, usize::MAX, found);
    let kept = found.iter().filter(|&&j| place[j as usize] != u32::MAX);
    let near = kept.min_by(|&&a, &&b| {
        let away = |j: u32| tree.points[j as usize].distance_squared(p);
        away(a).total_cmp(&away(b)).then(a.cmp(&b))
    });
    near.map_or(0, |&j| place[j as usize])
}
