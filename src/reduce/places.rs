//! Copies of a point are one place: a reduction works on the places, and each stands for all of its copies.

use crate::cloud::copies::{copied, copies};
use crate::cloud::octree::Octree;
use crate::features::Features;
use std::ops::Range;

/// The distinct places of a cloud that has copies.
pub(crate) struct Places {
    /// One point a place, in the order of the cloud's octree.
    pub(crate) tree: Octree,
    /// The points of each place, in the octree's order.
    copies: Vec<Range<usize>>,
}

impl Places {
    /// `None` where no point has a copy.
    pub(crate) fn of(tree: &Octree) -> Option<Places> {
        if !copied(&tree.points) {
            return None;
        }
        let copies = copies(&tree.points);
        let distinct: Vec<_> = copies.iter().map(|c| tree.points[c.start]).collect();
        Some(Places {
            tree: Octree::build(&distinct),
            copies,
        })
    }

    /// The features of the places: a place has the area that its copies shared.
    pub(crate) fn features(&self, all: &Features) -> Features {
        let first = || self.copies.iter().map(|c| c.start);
        let of = |values: &[f32]| first().map(|i| values[i]).collect();
        let area = |c: &Range<usize>| all.spacing[c.start] * (c.len() as f32).sqrt();
        Features {
            spacing: self.copies.iter().map(area).collect(),
            normals: first().map(|i| all.normals[i]).collect(),
            curvature: of(&all.curvature),
            variation: of(&all.variation),
            residual: of(&all.residual),
            noise: all.noise,
            steps: all.steps,
            lines: all.lines,
        }
    }

    /// One value a point from one a place.
    pub(crate) fn spread<T: Clone>(&self, values: &[T]) -> Vec<T> {
        let each = self.copies.iter().zip(values);
        each.flat_map(|(c, value)| c.clone().map(move |_| value.clone()))
            .collect()
    }

    /// A point at place `k`, in the octree's order.
    pub(crate) fn point(&self, k: u32) -> u32 {
        self.copies[k as usize].start as u32
    }
}
