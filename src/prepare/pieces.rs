//! Connected components of the points themselves.
//!
//! Two points touch when they are at most `gap` times the geometric mean of their spacings apart. So each part of a scan is held
//! together by its own density: a sparse side of an object stays with a dense one up to a ratio of `gap`² between their
//! spacings, and a second object beside it, though nearer than a spacing of the sparse side, stays apart.
//!
//! Copies of a point are one point. The result does not depend on the order of the points but for the numbers of pieces of equal size.

use crate::base::error::Result;
use crate::base::groups::Groups;
use crate::base::progress::{Progress, Stage};
use crate::base::sets::Sets;
use crate::cloud::copies::{copied, copies};
use crate::cloud::near::each_within;
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;
use glam::Vec3;

/// The largest gap within a piece unless another is asked for, in spacings.
pub const GAP: f32 = 3.0;

/// The pieces of a cloud.
#[derive(Debug, Clone)]
pub struct Pieces {
    /// The piece of each point, in the octree's order.
    pub of: Vec<u32>,
    /// The pieces, the largest first; of equal ones that first whose first point comes first in the octree's order.
    pub all: Vec<Piece>,
}

/// One piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// How many points it has.
    pub points: usize,
    /// Lower corner of its box, unit frame.
    pub lo: Vec3,
    /// Upper corner.
    pub hi: Vec3,
}

/// Which pieces are kept.
#[derive(Debug, Clone, PartialEq)]
pub enum Keep {
    /// All of them.
    All,
    /// So many of the largest.
    Largest(usize),
    /// Those with at least this share of the points.
    MinShare(f64),
    /// These, by number.
    Numbers(Vec<u32>),
}

impl Pieces {
    /// Finds them. `spacing` is that of [`crate::features::Features`]; `gap` in spacings. Cost: a query of about π `gap`² points each.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub fn find(
        tree: &Octree,
        spacing: &[f32],
        gap: f32,
        progress: &mut dyn Progress,
    ) -> Result<Pieces> {
        if !copied(&tree.points) {
            return Ok(Pieces::numbered(
                tree,
                components(tree, spacing, gap, progress)?,
            ));
        }
        let runs = copies(&tree.points);
        let distinct: Vec<Vec3> = runs.iter().map(|run| tree.points[run.start]).collect();
        let places = Octree::build(&distinct);
        // Copies share their area: the place has that of all of them.
        let of_place = |&k: &u32| {
            let run = &runs[k as usize];
            spacing[run.start] * (run.len() as f32).sqrt()
        };
        let spacing: Vec<f32> = places.order.iter().map(of_place).collect();
        let mut of_places = components(&places, &spacing, gap, progress)?;
        let mut sets = Sets::new(tree.points.len());
        let mut first = vec![u32::MAX; places.points.len()];
        for (k, run) in places.order.iter().map(|&k| &runs[k as usize]).enumerate() {
            let root = of_places.find(k as u32) as usize;
            if first[root] == u32::MAX {
                first[root] = run.start as u32;
            }
            for i in run.clone() {
                sets.join(first[root], i as u32);
            }
        }
        Ok(Pieces::numbered(tree, sets))
    }

    /// The largest first.
    fn numbered(tree: &Octree, sets: Sets) -> Pieces {
        let (of, count) = sets.numbered();
        let groups = Groups::new(count, || of.iter().copied().zip(0u32..));
        let mut order: Vec<u32> = (0..count as u32).collect();
        order.sort_by_key(|&piece| std::cmp::Reverse(groups.of(piece).len()));
        let mut number = vec![0; count];
        for (rank, &piece) in (0..).zip(&order) {
            number[piece as usize] = rank;
        }
        let piece = |&piece: &u32| {
            let members = groups.of(piece);
            let at = |&i: &u32| tree.points[i as usize];
            let none = (Vec3::INFINITY, Vec3::NEG_INFINITY);
            let grow = |(lo, hi): (Vec3, Vec3), p: Vec3| (lo.min(p), hi.max(p));
            let (lo, hi) = members.iter().map(at).fold(none, grow);
            Piece {
                points: members.len(),
                lo,
                hi,
            }
        };
        Pieces {
            all: order.iter().map(piece).collect(),
            of: of.iter().map(|&piece| number[piece as usize]).collect(),
        }
    }

    /// Of every piece whether it is kept.
    pub fn kept(&self, keep: &Keep) -> Vec<bool> {
        let share = |piece: &Piece| piece.points as f64 / self.of.len() as f64;
        let is_kept = |(number, piece): (usize, &Piece)| match keep {
            Keep::All => true,
            Keep::Largest(count) => number < *count,
            Keep::MinShare(least) => share(piece) >= *least,
            Keep::Numbers(numbers) => numbers.contains(&(number as u32)),
        };
        self.all.iter().enumerate().map(is_kept).collect()
    }
}

/// Joins points that touch. Each point asks for those whose spacing is no larger: so every pair is looked at from its sparser side,
/// whose query reaches as far as they may be apart.
fn components(
    tree: &Octree,
    spacing: &[f32],
    gap: f32,
    progress: &mut dyn Progress,
) -> Result<Sets> {
    let touching = |i: usize, found: &[Neighbor]| {
        let own = spacing[i];
        let touches = |n: &&Neighbor| {
            let (j, other) = (n.index as usize, spacing[n.index as usize]);
            let asks = other < own || (other == own && j < i);
            asks && n.distance2 <= gap * gap * own * other
        };
        found
            .iter()
            .filter(touches)
            .map(|n| n.index)
            .collect::<Vec<u32>>()
    };
    let radius = |i: usize| gap * spacing[i];
    let mut sets = Sets::new(tree.points.len());
    let join = |i: usize, found: Vec<u32>| found.iter().for_each(|&j| sets.join(i as u32, j));
    each_within(tree, &radius, (Stage::Prepare, progress), touching, join)?;
    Ok(sets)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::progress::Silent;
    use crate::base::rng::Rng;

    /// `n` even points of a square of this side at `at`, parallel to the xy plane.
    fn square(n: usize, side: f32, at: Vec3) -> Vec<Vec3> {
        let rows = (n as f32).sqrt() as usize;
        let step = side / rows as f32;
        (0..rows * rows)
            .map(|i| at + step * Vec3::new((i % rows) as f32, (i / rows) as f32, 0.0))
            .collect()
    }

    fn spacing_of(tree: &Octree) -> Vec<f32> {
        let mut found = Vec::new();
        let each = tree.points.iter().map(|&p| {
            tree.knn(p, 10, &mut found);
            (std::f32::consts::PI * found[found.len() - 1].distance2 / 9.0).sqrt()
        });
        each.collect()
    }

    #[test]
    fn pieces_are_those_of_a_comparison_of_all_pairs() {
        let mut rng = Rng::new(3);
        let mut at = |wide: f32| (rng.uniform() as f32 - 0.5) * wide;
        // Three blobs of different density, and points between them.
        let mut points: Vec<Vec3> = Vec::new();
        for (center, wide, n) in [(-0.3, 0.1, 300), (0.0, 0.3, 200), (0.35, 0.05, 200)] {
            points.extend((0..n).map(|_| Vec3::new(center + at(wide), at(wide), at(wide))));
        }
        points.extend((0..20).map(|_| Vec3::new(at(0.9), at(0.3), at(0.3))));
        let tree = Octree::build(&points);
        let spacing = spacing_of(&tree);
        for gap in [0.6, 1.0, 2.0] {
            let pieces = Pieces::find(&tree, &spacing, gap, &mut Silent).unwrap();
            let mut sets = Sets::new(points.len());
            for i in 0..points.len() {
                for j in 0..i {
                    let limit = gap * gap * spacing[i] * spacing[j];
                    if tree.points[i].distance_squared(tree.points[j]) <= limit {
                        sets.join(i as u32, j as u32);
                    }
                }
            }
            let (of, count) = sets.numbered();
            assert_eq!(pieces.all.len(), count, "gap {gap}");
            for i in 1..points.len() {
                let same = of[i] == of[i - 1];
                assert_eq!(
                    pieces.of[i] == pieces.of[i - 1],
                    same,
                    "gap {gap}, point {i}"
                );
            }
            assert!(pieces.all.is_sorted_by(|a, b| a.points >= b.points));
            let sum: usize = pieces.all.iter().map(|piece| piece.points).sum();
            assert_eq!(sum, points.len());
        }
    }

    #[test]
    fn a_sparse_side_stays_and_a_near_object_does_not() {
        // A sheet whose right half has a sixteenth of the density, and another object eight dense spacings above the dense half:
        // nearer than the points of the sparse half are to each other.
        let dense = square(10_000, 0.4, Vec3::new(-0.4, 0.0, 0.0));
        let sparse = square(156, 0.4, Vec3::new(0.0, 0.0, 0.0));
        let other = square(2500, 0.2, Vec3::new(-0.3, 0.1, 0.032));
        let all = [dense, sparse, other].concat();
        let tree = Octree::build(&all);
        let pieces = Pieces::find(&tree, &spacing_of(&tree), GAP, &mut Silent).unwrap();
        let sizes: Vec<usize> = pieces.all.iter().map(|piece| piece.points).collect();
        assert_eq!(sizes, [10_144, 2500]);
        assert_eq!(pieces.all[1].lo.z, 0.032);
        assert_eq!(pieces.kept(&Keep::Largest(1)), [true, false]);
        assert_eq!(pieces.kept(&Keep::MinShare(0.5)), [true, false]);
        assert_eq!(pieces.kept(&Keep::Numbers(vec![1])), [false, true]);
        assert_eq!(pieces.kept(&Keep::All), [true, true]);
    }

    #[test]
    fn copies_and_single_points_are_pieces_like_others() {
        for points in [vec![Vec3::ZERO], vec![Vec3::ZERO; 20_000]] {
            let tree = Octree::build(&points);
            let pieces = Pieces::find(&tree, &vec![0.0; points.len()], GAP, &mut Silent).unwrap();
            assert_eq!(pieces.all.len(), 1);
            assert_eq!(pieces.all[0].points, points.len());
        }
        // Two squares of which every point is there twice.
        let near = square(400, 0.2, Vec3::ZERO);
        let far = square(100, 0.1, Vec3::new(0.5, 0.0, 0.0));
        let once = [near, far].concat();
        let twice = [once.clone(), once].concat();
        let tree = Octree::build(&twice);
        let half: Vec<f32> = vec![0.01 / 2f32.sqrt(); twice.len()];
        let pieces = Pieces::find(&tree, &half, GAP, &mut Silent).unwrap();
        let sizes: Vec<usize> = pieces.all.iter().map(|piece| piece.points).collect();
        assert_eq!(sizes, [800, 200]);
    }
}
