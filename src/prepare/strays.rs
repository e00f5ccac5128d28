//! Flying pixels: points on a line of sight between two surfaces, where a beam or a pixel was half on one and half on the other.
//!
//! Seen from where it was measured, a point of a surface has its neighbours in direction near it in space, too, unless they are
//! across a depth edge; even on a surface that is seen at a flat angle, some of them. A flying pixel has hardly any: its neighbours in
//! direction are on the surface in front of it or on the one behind.
//!
//! Without a viewpoint there is no line of sight, and nothing is found: [`crate::features::outliers`] finds what is isolated.

use crate::base::error::Result;
use crate::base::par;
use crate::base::progress::{Progress, Stage};
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;
use glam::Vec3;

/// Neighbours in direction that are asked.
const AROUND: usize = 16;
/// How far apart in space neighbours in direction may be, in what that direction spans across the line of sight: on a surface seen
/// at 8° to it.
const FLAT: f32 = 7.0;
/// A point with fewer such neighbours than this flies, when there is something behind it.
const FEWEST: usize = 4;

/// Which points fly, in the octree's order; `eye` says where each was seen from. Cost: a tree of directions for each viewpoint, and
/// a query of 16 a point.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub fn flying(
    tree: &Octree,
    eye: &(dyn Fn(usize) -> Option<Vec3> + Sync),
    progress: &mut dyn Progress,
) -> Result<Vec<bool>> {
    let mut flies = vec![false; tree.points.len()];
    // Points by viewpoint, in the order in which viewpoints come up.
    let mut views: Vec<(Vec3, Vec<u32>)> = Vec::new();
    for i in 0..tree.points.len() {
        let Some(eye) = eye(i) else { continue };
        match views.iter_mut().rev().find(|(of, _)| *of == eye) {
            Some((_, points)) => points.push(i as u32),
            None => views.push((eye, vec![i as u32])),
        }
    }
    let count = views.len().max(1) as f32;
    for (k, (eye, points)) in views.into_iter().enumerate() {
        progress.update(Stage::Prepare, k as f32 / count)?;
        let view = View::new(tree, eye, &points);
        for (&i, fly) in points.iter().zip(view.flying()) {
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
    fn flying(&self) -> Vec<bool> {
        let n = self.range.len();
        let found = par::map(n, Vec::new, |k, found: &mut Vec<Neighbor>| {
            self.directions
                .knn(self.directions.points[k], AROUND + 1, found);
            let range = self.range[k];
            let (mut near, mut behind) = (0, 0);
            for f in found.iter().filter(|f| f.index as usize != k) {
                // The distance of two halved directions, doubled, is what they span at a range of 1.
                let across = 2.0 * f.distance2.sqrt() * range;
                let along = self.range[f.index as usize] - range;
                if along.abs() <= FLAT * across {
                    near += 1;
                } else if along > 0.0 {
                    behind += 1;
                }
            }
            near < FEWEST && behind > 0
        });
        let mut flies = vec![false; n];
        for (&k, fly) in self.directions.order.iter().zip(found) {
            flies[k as usize] = fly;
        }
        flies
    }
}
