//! Flying pixels: points between two surfaces, where a beam or a pixel was half on one and half on the other.
//!
//! 1. By density: near a surface they are sparser than it, and beside the plane that it has there. [`halo`] finds those: points
//!    off the plane of their flattest neighbours by more than the spacing and the noise, where these neighbours lie in a plane.
//! 2. By line of sight, where it is known from where a point was measured: a point of a surface has its neighbours in direction near
//!    it in space, too, unless they are across a depth edge; even on a surface that is seen at a flat angle, some of them. A flying
//!    pixel has hardly any: its neighbours in direction are on the surface in front of it or on the one behind. [`between`] finds
//!    those, of views whose directions are close together.
//!
//! What is far from every surface is isolated ([`crate::features::outliers`]).
//!
//! The constants were measured on objects in front of tables and walls (`tests/examples/prepare_truth`).

use crate::base::error::Result;
use crate::base::linalg::Spread;
use crate::base::progress::{Part, Progress, Stage};
use crate::base::sort_keys::key;
use crate::cloud::near::each_nearest;
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;
use crate::features::Features;
use glam::Vec3;

/// Neighbours of which the flattest tell the plane, and how many these are.
const HOOD: (usize, usize) = (24, 12);
/// Off that plane by more than so many spacings of the surface, standard deviations of the noise, and thicknesses of the plane.
const OFF: (f32, f32, f32) = (1.5, 4.0, 6.0);
/// Its spacing is at least this many times the surface's.
const SPARSER: f32 = 1.45;

/// Neighbours in direction that are asked.
const AROUND: usize = 16;
/// Directions of a view that tells something: the farthest of those neighbours is within this angle, 2°.
const FINE: f32 = 0.035;
/// How far apart in space neighbours in direction may be, in what that direction spans across the line of sight: on a surface seen
/// at 8° to it.
const FLAT: f32 = 7.0;
/// A point with fewer such neighbours than this flies, when there is something behind it.
const FEWEST: usize = 4;

/// Points beside a surface, in the octree's order. Cost: a query of 24 neighbours a point.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub fn halo(tree: &Octree, features: &Features, progress: &mut dyn Progress) -> Result<Vec<bool>> {
    let each = |i: usize, found: &mut Vec<Neighbor>| {
        let p = tree.points[i];
        found.retain(|f| f.index as usize != i);
        if found.len() < HOOD.1 {
            return false;
        }
        // The surface is where points are dense.
        found.sort_by(|a, b| {
            let [a, b] = [a, b].map(|f| features.spacing[f.index as usize]);
            a.total_cmp(&b)
        });
        let spacing = features.spacing[found[found.len() / 4].index as usize];
        if features.spacing[i] < SPARSER * spacing {
            return false;
        }
        found.sort_by(|a, b| {
            let [a, b] = [a, b].map(|f| features.variation[f.index as usize]);
            a.total_cmp(&b)
        });
        let flattest = found[..HOOD.1].iter();
        let plane = Spread::of(flattest.map(|f| tree.points[f.index as usize].as_dvec3()));
        let off = (p.as_dvec3() - plane.mean).dot(plane.eigen.vectors[0]);
        let thick = plane.variances()[0].max(0.0).sqrt() as f32;
        let limit = (OFF.0 * spacing)
            .max(OFF.1 * features.noise)
            .max(OFF.2 * thick);
        off.abs() as f32 > limit
    };
    each_nearest(tree, HOOD.0 + 1, None, (Stage::Prepare, progress), each)
}

/// Points between two surfaces on a line of sight, in the octree's order; `eye` says where each was seen from. Cost: a tree of
/// directions for each viewpoint, and a query of 16 a point.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub fn between(
    tree: &Octree,
    eye: &(dyn Fn(usize) -> Option<Vec3> + Sync),
    progress: &mut dyn Progress,
) -> Result<Vec<bool>> {
    let mut flies = vec![false; tree.points.len()];
    let seen = (0..tree.points.len() as u32).filter_map(|i| Some((eye(i as usize)?, i)));
    let mut seen: Vec<(Vec3, u32)> = seen.collect();
    // Equal viewpoints next to each other; their points in the octree's order.
    seen.sort_by_key(|(eye, _)| eye.to_array().map(key));
    let count = seen.len().max(1) as f32;
    let mut done = 0;
    for same in seen.chunk_by(|a, b| a.0 == b.0) {
        let share = |done: usize| done as f32 / count;
        let range = share(done)..share(done + same.len());
        done += same.len();
        let points: Vec<u32> = same.iter().map(|&(_, i)| i).collect();
        let view = View::new(tree, same[0].0, &points);
        let flying = view.flying(&mut Part::of(Stage::Prepare, progress, range))?;
        for (&i, fly) in points.iter().zip(flying) {
            flies[i as usize] = fly;
        }
    }
    progress.update(Stage::Prepare, 1.0)?;
    Ok(flies)
}

/// The points of one viewpoint by direction.
struct View {
    directions: Octree,
    /// By the order of directions.
    range: Vec<f32>,
}

impl View {
    fn new(tree: &Octree, eye: Vec3, points: &[u32]) -> View {
        let from_eye: Vec<Vec3> = points
            .iter()
            .map(|&i| tree.points[i as usize] - eye)
            .collect();
        // Half: the unit frame ends at 0.5.
        let halves: Vec<Vec3> = from_eye
            .iter()
            .map(|v| 0.5 * v.normalize_or_zero())
            .collect();
        let directions = Octree::build(&halves);
        let range = directions
            .order
            .iter()
            .map(|&k| from_eye[k as usize].length());
        View {
            range: range.collect(),
            directions,
        }
    }

    /// In the order of the points given.
    fn flying(&self, progress: &mut dyn Progress) -> Result<Vec<bool>> {
        let n = self.range.len();
        let told = (Stage::Prepare, progress);
        let found = each_nearest(&self.directions, AROUND + 1, None, told, |k, found| {
            // The distance of two halved directions, doubled, is what they span at a range of 1.
            let span = |f: &Neighbor| 2.0 * f.distance2.sqrt();
            if span(&found[found.len() - 1]) > FINE {
                return false;
            }
            let range = self.range[k];
            let (mut near, mut behind) = (0, 0);
            for f in found.iter().filter(|f| f.index as usize != k) {
                let along = self.range[f.index as usize] - range;
                if along.abs() <= FLAT * span(f) * range {
                    near += 1;
                } else if along > 0.0 {
                    behind += 1;
                }
            }
            near < FEWEST && behind > 0
        })?;
        let mut flies = vec![false; n];
        for (&k, fly) in self.directions.order.iter().zip(found) {
            flies[k as usize] = fly;
        }
        Ok(flies)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::progress::Silent;
    use crate::base::rng::Rng;

    #[test]
    fn what_is_between_two_walls_on_one_ray_flies() {
        // From the origin: a plate at z = 0.2 before a wall at z = 0.45 that is seen at 15° to its surface at its far end; at the plate's
        // edge x = 0 every other ray ends between them.
        let mut rng = Rng::new(5);
        let mut points = Vec::new();
        let mut truth = Vec::new();
        for row in -60..60 {
            for column in -60..60 {
                let mut at = |i: i32| 0.004 * (i as f32 + 0.2 * (rng.uniform() as f32 - 0.5));
                let ray = Vec3::new(at(column), at(row), 1.0);
                let wall = 0.45 / (1.0 + 3.5 * ray.x.abs());
                let range = if column < 0 { 0.2 } else { wall };
                let flies = column == 0 && row % 2 == 0;
                let between = 0.24 + 0.14 * rng.uniform() as f32;
                points.push(ray * if flies { between } else { range });
                truth.push(flies);
            }
        }
        let tree = Octree::build(&points);
        let found = between(&tree, &|_| Some(Vec3::ZERO), &mut Silent).unwrap();
        let truth: Vec<bool> = tree.order.iter().map(|&i| truth[i as usize]).collect();
        let count = |right: bool, of: bool| {
            let pairs = truth.iter().zip(&found);
            pairs.filter(|&(&t, &f)| t == of && f == right).count()
        };
        assert!(count(true, true) >= 57, "{} of 60", count(true, true));
        assert!(count(true, false) <= 14, "{} of 14,340", count(true, false));
        // Nobody knows from where: no line of sight.
        let blind = between(&tree, &|_| None, &mut Silent).unwrap();
        assert!(!blind.contains(&true));
    }

    #[test]
    fn a_halo_is_what_is_beside_a_surface_and_no_edge_of_it() {
        let mut rng = Rng::new(8);
        let mut at = |wide: f32| (rng.uniform() as f32 - 0.5) * wide;
        // A cube with its edges and corners, and strays two to four spacings beside its faces.
        let n = 12_000;
        let mut points: Vec<Vec3> = (0..n)
            .map(|i| {
                let (face, u, v) = (i % 6, at(0.5), at(0.5));
                let w = if face < 3 { 0.25 } else { -0.25 };
                [Vec3::new(u, v, w), Vec3::new(w, u, v), Vec3::new(v, w, u)][face % 3]
            })
            .collect();
        let spacing = (1.5 / n as f32).sqrt();
        for i in 0..60 {
            let far = 0.25 + spacing * (2.0 + 2.0 * (i as f32 / 60.0));
            let at = [at(0.45), at(0.45)];
            points.push([Vec3::new(at[0], at[1], far), Vec3::new(-far, at[0], at[1])][i % 2]);
        }
        let tree = Octree::build(&points);
        let features = Features::measure(&tree, &mut Silent).unwrap();
        let found = halo(&tree, &features, &mut Silent).unwrap();
        let is_stray = |k: usize| tree.order[k] >= n as u32;
        let all = || (0..points.len()).filter(|&k| found[k]);
        let strays = all().filter(|&k| is_stray(k)).count();
        assert!(strays >= 54, "{strays} of 60");
        assert!(
            all().count() - strays <= 12,
            "{} of the cube",
            all().count() - strays
        );
    }
}
