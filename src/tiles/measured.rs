//! A sample while it is measured.

use crate::base::error::Result;
use crate::base::progress::Progress;
use crate::cloud::octree::Octree;
use crate::features::Features;
use crate::reduce::density;
use crate::reduce::law::Patch;
use crate::tiles::grid::{Cube, Grid};
use crate::tiles::samples::Sample;
use glam::Vec3;

/// One sample: its points, those that count among them, and what is known of them.
pub(super) struct Measured<'a> {
    pub(super) sample: &'a Sample,
    pub(super) tree: Octree,
    /// In the caller's unit, of the unit frame's 1.
    pub(super) side: f64,
    pub(super) features: Features,
    /// Of the tree's points, whether each counts.
    pub(super) counts: Vec<bool>,
    /// Points of the scan that each of these stands for.
    pub(super) weight: f64,
}

impl Measured<'_> {
    pub(super) fn new<'a>(
        sample: &'a Sample,
        grid: Grid,
        progress: &mut dyn Progress,
    ) -> Result<Measured<'a>> {
        let corner = |pick: fn(u32, u32) -> u32| {
            let places = sample.places.iter().copied();
            let both = |a: [u32; 3], b: [u32; 3]| [0, 1, 2].map(|axis| pick(a[axis], b[axis]));
            places.reduce(both).unwrap_or_default()
        };
        let cube = Cube::between(corner(u32::min), corner(u32::max));
        let points: Vec<Vec3> = sample
            .places
            .iter()
            .map(|&place| cube.unit(place))
            .collect();
        let tree = Octree::build(&points);
        let features = Features::measure(&tree, progress)?;
        let counts: Vec<bool> = tree
            .order
            .iter()
            .map(|&i| in_range(sample.places[i as usize], sample.range))
            .collect();
        let inner = counts.iter().filter(|counts| **counts).count().max(1);
        Ok(Measured {
            sample,
            side: cube.side() * grid.step(),
            tree,
            features,
            counts,
            weight: sample.points / inner as f64,
        })
    }

    /// Values of the points that count, of all those of the tree.
    pub(super) fn inner<T>(&self, values: impl Iterator<Item = T>) -> impl Iterator<Item = T> {
        let each = values.zip(&self.counts);
        each.filter_map(|(value, &counts)| counts.then_some(value))
    }

    /// Of the scan, that it stands for.
    pub(super) fn points(&self) -> f64 {
        self.weight * self.counts.iter().filter(|counts| **counts).count() as f64
    }

    /// The patches that count, in the caller's unit.
    pub(super) fn patches(&self) -> Vec<Patch> {
        let (low, high) = self.corners();
        let all = density::patches(&self.tree, &self.features, self.weight);
        let inside = |p: Vec3| p.cmpge(low).all() && p.cmple(high).all();
        let inner = all.into_iter().filter(|(at, _)| inside(*at));
        inner
            .map(|(_, patch)| Patch {
                curvature: patch.curvature / self.side,
                area: patch.area * self.side * self.side,
                ..patch
            })
            .collect()
    }

    /// Corners of the box of the points that count.
    fn corners(&self) -> (Vec3, Vec3) {
        let inner = self.inner(self.tree.points.iter().copied());
        inner.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| {
            (low.min(p), high.max(p))
        })
    }
}

fn in_range(place: [u32; 3], [low, high]: [[u64; 3]; 2]) -> bool {
    (0..3).all(|a| (low[a]..high[a]).contains(&u64::from(place[a])))
}
