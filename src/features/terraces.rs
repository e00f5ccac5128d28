//! What [`crate::features::steps`] and [`crate::features::depths`] ask of terraces: the points of one level that cover a patch.

use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;

/// Points whose coordinates are looked at.
pub(crate) const SAMPLE: usize = 1 << 15;
/// Points a level, at least: fewer are no lattice, however the values lie.
pub(crate) const LEVEL: usize = 8;
/// Points that are asked for their terraces, and the neighbours of each.
const ASKED: usize = 400;
/// See [`ASKED`].
const NEAR: usize = 24;
/// Points of one level are a patch, no line, when their lesser variance is this share of the larger one: a straight line has 0.
pub(crate) const PATCH: f64 = 0.1;
/// Share of the points whose neighbours must show a patch: those of a third of a closed surface face the axis.
const TERRACES: f32 = 0.25;
/// Levels that show terraces, at least: the floor and the lid of a box on a raster are two.
pub(crate) const LEVELS: usize = 3;

/// The points that are asked for their terraces.
pub(crate) fn asked(tree: &Octree) -> impl Iterator<Item = usize> {
    let n = tree.points.len();
    (0..n).step_by(n.div_ceil(ASKED).max(1))
}

/// Whether the points that are asked lie on terraces: those around a point and of its level are a patch, and this on some levels.
/// Points without a level are not counted.
pub(crate) fn are_there<L: Ord + Copy>(
    tree: &Octree,
    level_of: impl Fn(usize) -> Option<L>,
    is_patch: impl Fn(usize, L, &[Neighbor]) -> bool,
) -> bool {
    let mut near = Vec::new();
    let (mut all, mut patches, mut levels) = (0.0, 0.0, Vec::new());
    for i in asked(tree) {
        let Some(level) = level_of(i) else { continue };
        tree.knn(tree.points[i], NEAR, &mut near);
        all += 1.0;
        if is_patch(i, level, &near) {
            patches += 1.0;
            levels.push(level);
        }
    }
    levels.sort_unstable();
    levels.dedup();
    patches >= TERRACES * all && levels.len() >= LEVELS
}
