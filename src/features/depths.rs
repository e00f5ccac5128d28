//! Steps of a depth: a sensor rounded the distances that it measured from its own place.
//!
//! A depth is the distance from the viewpoint, or that along an optical axis, which may point anywhere. It may be rounded
//! itself, or what it was computed from: a disparity, whose even steps are steps of the depth that grow with its square. So
//! levels are looked for, not a lattice.
//!
//! 1. The axis is one of the coordinates', or the normal of terraces, which are exactly flat and all look the same way.
//! 2. The depths have levels when they are few values with gaps between them.
//! 3. The levels are steps where they show terraces, as in [`crate::features::steps`].
//! 4. A point's step is the median gap around its level; steps that grow count by their mean square.

use crate::base::linalg::Spread;
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;
use crate::features::noise::quantile;
use crate::features::terraces::{self, LEVEL, LEVELS, PATCH, SAMPLE, asked};
use glam::{DVec3, Vec3};

/// Depths nearer than this (unit frame) are of one level: what single precision rounds, and files of some digits do.
const SAME: [f32; 3] = [1e-6, 1e-5, 1e-4];
/// A level is at most this share of the gap to the next one wide; so must the levels of this share of the points be.
const NARROW: (f32, f32) = (0.25, 0.95);
/// Gaps around a level that tell its step.
const GAPS: usize = 5;
/// Neighbours that are exactly flat, and what is exactly (unit frame).
const FLAT: (usize, f64) = (12, 1e-6);
/// Terraces look the same way to this cosine, and so do these of the points asked.
const ONE_WAY: (f64, f32) = (0.99999, 0.1);
/// Viewpoints farther than this many diagonals have the depths of an axis, in single precision.
const FARTHEST: f32 = 20.0;

/// How deep a point is.
enum Depth<'a> {
    Along(DVec3),
    From(&'a (dyn Fn(usize) -> Option<Vec3> + Sync)),
}

impl Depth<'_> {
    fn of(&self, tree: &Octree, i: usize) -> Option<f32> {
        let p = tree.points[i];
        match self {
            Depth::Along(axis) => Some(axis.dot(p.as_dvec3()) as f32),
            Depth::From(eye) => {
                let away = (p - eye(i)?).as_dvec3().length() as f32;
                (away < FARTHEST).then_some(away)
            }
        }
    }
}

/// Root mean square of the steps of whichever depth has the coarsest (unit frame); 0 without steps.
pub(crate) fn step(tree: &Octree, eye: &(dyn Fn(usize) -> Option<Vec3> + Sync)) -> f32 {
    let axes = DVec3::AXES.into_iter().chain(terrace_axis(tree));
    let depths = axes.map(Depth::Along).chain([Depth::From(eye)]);
    let steps = depths.filter_map(|depth| {
        let levels = Levels::of(tree, &depth)?;
        levels.have_terraces(tree, &depth).then(|| levels.step())
    });
    steps.fold(0.0, f32::max)
}

/// The levels of a depth, the nearest first.
struct Levels {
    middles: Vec<f32>,
    /// Points of the sample on each.
    counts: Vec<f32>,
}

impl Levels {
    fn of(tree: &Octree, depth: &Depth) -> Option<Levels> {
        let n = tree.points.len();
        let some = (0..n).step_by(n.div_ceil(SAMPLE));
        let mut depths: Vec<f32> = some.filter_map(|i| depth.of(tree, i)).collect();
        depths.sort_unstable_by(f32::total_cmp);
        SAME.into_iter()
            .find_map(|same| Levels::within(&depths, same))
    }

    /// Levels of sorted depths, none of whose gaps within one is larger than `same`.
    fn within(depths: &[f32], same: f32) -> Option<Levels> {
        let runs: Vec<&[f32]> = depths.chunk_by(|a, b| b - a <= same).collect();
        if runs.len() < LEVELS || runs.len() * LEVEL > depths.len() {
            return None;
        }
        let ends = |run: &[f32]| (run[0], run[run.len() - 1]);
        let levels = Levels {
            middles: runs
                .iter()
                .map(|run| (ends(run).0 + ends(run).1) / 2.0)
                .collect(),
            counts: runs.iter().map(|run| run.len() as f32).collect(),
        };
        let is_narrow = |k: usize| ends(runs[k]).1 - ends(runs[k]).0 <= NARROW.0 * levels.gap(k);
        let narrow = (0..runs.len()).filter(|&k| is_narrow(k));
        let narrow: f32 = narrow.map(|k| levels.counts[k]).sum();
        (narrow >= NARROW.1 * depths.len() as f32).then_some(levels)
    }

    /// The step at a level.
    fn gap(&self, level: usize) -> f32 {
        let last = self.middles.len() - 1;
        let from = level
            .saturating_sub(GAPS / 2 + 1)
            .min(last.saturating_sub(GAPS));
        let around = &self.middles[from..=(from + GAPS).min(last)];
        quantile(around.windows(2).map(|pair| pair[1] - pair[0]).collect(), 2)
    }

    fn nearest(&self, depth: f32) -> usize {
        let above = self.middles.partition_point(|&m| m < depth);
        let below = above.saturating_sub(1);
        let above = above.min(self.middles.len() - 1);
        if depth - self.middles[below] < self.middles[above] - depth {
            below
        } else {
            above
        }
    }

    /// Whether the points of one level cover patches, on some levels.
    fn have_terraces(&self, tree: &Octree, depth: &Depth) -> bool {
        let level_of = |i: usize| depth.of(tree, i).map(|d| self.nearest(d));
        terraces::are_there(tree, level_of, |_, level, near| {
            let of_level = near.iter().map(|n| n.index as usize);
            let of_level = of_level.filter(|&j| level_of(j) == Some(level));
            let terrace: Vec<DVec3> = of_level.map(|j| tree.points[j].as_dvec3()).collect();
            terrace.len() >= LEVEL && is_patch(&Spread::of(terrace.iter().copied()))
        })
    }

    /// Root mean square of the points' steps.
    fn step(&self) -> f32 {
        let squares = (0..self.counts.len()).map(|k| self.counts[k] * self.gap(k).powi(2));
        (squares.sum::<f32>() / self.counts.iter().sum::<f32>()).sqrt()
    }
}

/// Whether points vary in two directions.
fn is_patch(spread: &Spread) -> bool {
    let [_, middle, long] = spread.eigen.values;
    middle >= PATCH * long && long > 0.0
}

/// The axis that exactly flat neighbourhoods look along, where many do.
fn terrace_axis(tree: &Octree) -> Option<DVec3> {
    let mut found: Vec<Neighbor> = Vec::new();
    let flat = |i: usize| {
        tree.knn(tree.points[i], FLAT.0, &mut found);
        let near = found
            .iter()
            .map(|n| tree.points[n.index as usize].as_dvec3());
        let spread = Spread::of(near);
        let thin = spread.variances()[0].max(0.0).sqrt();
        (thin <= FLAT.1 && is_patch(&spread)).then_some(spread.eigen.vectors[0])
    };
    let all = asked(tree).count();
    let normals: Vec<DVec3> = asked(tree).filter_map(flat).collect();
    let like = |axis: DVec3| {
        normals
            .iter()
            .filter(move |n| n.dot(axis).abs() >= ONE_WAY.0)
    };
    let most = normals.iter().max_by_key(|n| like(**n).count()).copied()?;
    if (like(most).count() as f32) < ONE_WAY.1 * all as f32 {
        return None;
    }
    let sum: DVec3 = like(most).map(|n| *n * n.dot(most).signum()).sum();
    Some(sum.normalize())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::Rng;
    use glam::{DMat3, dvec3};

    /// What a depth camera at the origin sees of a wall with a relief, its depth along z rounded by `round`, turned by `turn`.
    fn frame(round: impl Fn(DVec3) -> f64, turn: DMat3) -> (Octree, Vec3) {
        let mut rng = Rng::new(3);
        let seen = (0..12_000).map(|_| {
            let (u, v) = (rng.uniform() - 0.5, rng.uniform() - 0.5);
            let depth = 1.0 + 0.3 * u + 0.08 * libm::sin(7.0 * u) * libm::cos(6.0 * v);
            let p = depth * dvec3(u, v, 1.0);
            turn * (p * round(p))
        });
        let middle = turn * dvec3(0.0, 0.0, 1.0);
        let points: Vec<Vec3> = seen.map(|p| (0.5 * (p - middle)).as_vec3()).collect();
        (Octree::build(&points), (-0.5 * middle).as_vec3())
    }

    fn found(round: impl Fn(DVec3) -> f64, turn: DMat3) -> f64 {
        let (tree, eye) = frame(round, turn);
        f64::from(step(&tree, &|_| Some(eye)))
    }

    fn rounded(x: f64, step: f64) -> f64 {
        step * (x / step).round() / x
    }

    #[test]
    fn rounded_depths_are_steps() {
        let turn = DMat3::from_rotation_y(0.4) * DMat3::from_rotation_x(0.7);
        for turn in [DMat3::IDENTITY, turn] {
            for step in [0.02, 0.05] {
                let along = found(|p| rounded(p.z, step), turn);
                let range = found(|p| rounded(p.length(), step), turn);
                for found in [along, range] {
                    assert!(
                        (found / (0.5 * step) - 1.0).abs() < 0.05,
                        "{found} of {step}"
                    );
                }
                // A disparity: around a depth of 1 its steps are as large.
                let disparity = found(|p| 1.0 / rounded(1.0 / p.z, step), turn);
                assert!(
                    (disparity / (0.5 * step) - 1.0).abs() < 0.2,
                    "{disparity} of {step}"
                );
            }
            assert_eq!(found(|_| 1.0, turn), 0.0);
        }
    }

    #[test]
    fn floors_and_lids_are_no_terraces() {
        let mut rng = Rng::new(4);
        let mut box_of = |turn: DMat3| {
            let mut at = || rng.uniform() - 0.5;
            let points: Vec<Vec3> = (0..9000)
                .map(|i| {
                    let mut p = dvec3(at(), at(), at());
                    p[i % 3] = if i % 2 == 0 { 0.5 } else { -0.5 };
                    (turn * p * 0.6).as_vec3()
                })
                .collect();
            Octree::build(&points)
        };
        for turn in [DMat3::IDENTITY, DMat3::from_rotation_x(0.7)] {
            assert_eq!(step(&box_of(turn), &|_| None), 0.0);
        }
        let raster = (0..6).flat_map(|face| {
            (0..900).map(move |i| {
                let mut p = dvec3((i % 30) as f64, (i / 30) as f64, 0.0) / 29.0 - 0.5;
                p.z = if face % 2 == 0 { 0.5 } else { -0.5 };
                let p = [p, dvec3(p.z, p.x, p.y), dvec3(p.y, p.z, p.x)][face / 2];
                (p * 0.6).as_vec3()
            })
        });
        let raster = Octree::build(&raster.collect::<Vec<Vec3>>());
        assert_eq!(step(&raster, &|_| None), 0.0);
    }
}
