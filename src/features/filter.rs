//! The bilateral filter of the features, steps 2 and 3 of [`crate::features`]: normals, distances to the surface and
//! curvature from neighbours on the same side of every crease.

use crate::base::lanes::{LANES, Lanes};
use crate::cloud::neighborhood::{Block, Neighborhood, bounds};
use crate::cloud::octree::Octree;
use crate::features::noise::Scales;
use crate::features::values::Features;
use glam::Vec3;
use std::ops::Range;

/// Angle (as length of the difference of unit normals) from which neighbours have nothing to say to each other.
const SAME_SIDE: f32 = 0.5;
/// Distances along the normal, in standard deviations of the noise, from which they have not: another sheet.
const SAME_SHEET: f32 = 5.0;
/// Share of the neighbours on another side from which a point may be, and from which it is, next to a crease.
const NEAR_CREASE: Range<f32> = 0.3..0.6;
/// What a clean surface is allowed in place of noise, in spacings: the filter's formula leaves third-order terms.
const BEND: f32 = 0.05;

/// Distance of one point to the surface, and how that bends.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Offset {
    pub(crate) residual: f32,
    pub(crate) curvature: f32,
}

/// Memory of one worker of the filter.
#[derive(Default)]
pub(crate) struct Filter {
    cell: Neighborhood,
    own: Neighborhood,
}

/// One block with the scales of its sums.
pub(crate) struct Sums<'a> {
    features: &'a Features,
    block: &'a Block,
    hood: &'a Neighborhood,
    /// Normals of the block's points.
    normal: [Lanes; 3],
    /// Radius of the support.
    support: f32,
    /// Distance along the normal from which a neighbour is of another sheet.
    sheet: f32,
}

/// A neighbour as each lane sees it.
struct Pair {
    /// (1 - d²/R²), not below 0.
    near: Lanes,
    /// The same of the distance along the normals over [`SAME_SHEET`].
    sheet: Lanes,
    /// The same of the angle over [`SAME_SIDE`].
    side: Lanes,
    length2: Lanes,
    angle2: Lanes,
    /// ½ (n_i + n_j)·(x_i - x_j).
    away: Lanes,
    /// The neighbour's normal, turned to the lane's side.
    normal: [Lanes; 3],
}

impl Filter {
    /// One pass over the points `range`, which lie close together: `of` makes of each block's sums what is wanted, and gets
    /// how much is to be denoised.
    pub(crate) fn cell<T>(
        &mut self,
        tree: &Octree,
        features: &Features,
        range: Range<usize>,
        of: impl Fn(&Sums, f32) -> [T; LANES],
    ) -> Vec<T> {
        let mut filtered = Vec::with_capacity(range.len());
        let support = |block: &Block| {
            let scales = Scales::new(features.noise, typical_spacing(features, block));
            (
                typical_spacing(features, block) * (scales.filter / std::f32::consts::PI).sqrt(),
                scales.denoise,
            )
        };
        let blocks = || Block::all(&tree.points, range.clone());
        let widest = blocks().map(|b| support(&b).0).fold(0.0, f32::max);
        let corners = bounds(&tree.points[range.clone()]);
        let together = self.cell.gather(tree, corners, widest);
        for block in blocks() {
            let (support, denoise) = support(&block);
            if together {
                self.cell.narrow(&block, support);
                let sums = Sums::new(features, &block, &self.cell, support);
                filtered.extend(of(&sums, denoise).into_iter().take(block.range.len()));
            } else {
                for i in block.range.clone() {
                    self.own.gather_at(tree, tree.points[i], support);
                    let block = Block::new(&tree.points, i..i + 1);
                    let sums = Sums::new(features, &block, &self.own, support);
                    filtered.extend(of(&sums, denoise).into_iter().take(block.range.len()));
                }
            }
        }
        filtered
    }
}

/// The median of a block's spacings: stragglers among its points have far larger ones.
fn typical_spacing(features: &Features, block: &Block) -> f32 {
    let mut spacing = [0.0; LANES];
    let spacing = &mut spacing[..block.range.len()];
    spacing.copy_from_slice(&features.spacing[block.range.clone()]);
    spacing.sort_unstable_by(f32::total_cmp);
    spacing[spacing.len() / 2]
}

impl<'a> Sums<'a> {
    fn new(
        features: &'a Features,
        block: &'a Block,
        hood: &'a Neighborhood,
        support: f32,
    ) -> Sums<'a> {
        let spacing = typical_spacing(features, block);
        Sums {
            features,
            block,
            hood,
            normal: [0, 1, 2].map(|axis| block.lanes(|i| features.normals[i][axis])),
            support: support.max(f32::MIN_POSITIVE.sqrt()),
            sheet: (SAME_SHEET * features.noise.max(BEND * spacing)).max(f32::MIN_POSITIVE.sqrt()),
        }
    }

    fn pairs(&self) -> impl Iterator<Item = Pair> {
        let one = Lanes::splat(1.0);
        let half = Lanes::splat(0.5);
        let support2 = Lanes::splat(1.0 / (self.support * self.support));
        let sheet2 = Lanes::splat(1.0 / (self.sheet * self.sheet));
        let side2 = Lanes::splat(1.0 / (SAME_SIDE * SAME_SIDE));
        let clip = |x: Lanes| x.max(Lanes::ZERO);
        let [px, py, pz] = self.block.at;
        let [nx, ny, nz] = self.normal;
        self.hood.near().map(move |(j, [x, y, z])| {
            let [mx, my, mz] = self.features.normals[j].to_array().map(Lanes::splat);
            let (dx, dy, dz) = (px - x, py - y, pz - z);
            let length2 = dx * dx + dy * dy + dz * dz;
            let dot = nx * mx + ny * my + nz * mz;
            let sign = dot.sign();
            let (mx, my, mz) = (mx * sign, my * sign, mz * sign);
            let angle2 = clip(Lanes::splat(2.0) - (dot + dot) * sign);
            let away = half * ((nx + mx) * dx + (ny + my) * dy + (nz + mz) * dz);
            Pair {
                near: clip(one - length2 * support2),
                sheet: clip(one - away * away * sheet2),
                side: clip(one - angle2 * side2),
                length2,
                angle2,
                away,
                normal: [mx, my, mz],
            }
        })
    }

    /// The filtered normals, unit or zero.
    pub(crate) fn normals(&self, denoise: f32) -> [Vec3; LANES] {
        let mut sums = [Lanes::ZERO; 5];
        for pair in self.pairs() {
            let any_side = pair.near * pair.sheet;
            let root = any_side * pair.side;
            let w = root * root;
            let [x, y, z] = pair.normal.map(|m| w * m);
            for (sum, term) in sums.iter_mut().zip([x, y, z, w, any_side * any_side]) {
                *sum += term;
            }
        }
        let [x, y, z, total, any_side] = sums.map(Lanes::to_array);
        std::array::from_fn(|l| {
            let n = Vec3::from_array(self.normal.map(|n| n.lane(l)));
            // Without noise the plane's normal is the better one, but for the neighbours of a crease.
            let refused = 1.0 - total[l] / any_side[l].max(f32::MIN_POSITIVE);
            let crease = (refused - NEAR_CREASE.start) / (NEAR_CREASE.end - NEAR_CREASE.start);
            let filtered = Vec3::new(x[l], y[l], z[l]).normalize_or(n);
            let mix = denoise.max(crease.clamp(0.0, 1.0));
            n.lerp(filtered, mix).normalize_or(n)
        })
    }

    /// How far the points are from the surface that the filtered normals make.
    pub(crate) fn offsets(&self, denoise: f32) -> [Offset; LANES] {
        let mut sums = [Lanes::ZERO; 4];
        for pair in self.pairs() {
            let any_side = pair.near * pair.sheet;
            let root = any_side * pair.side;
            let w = root * root;
            let terms = [
                w,
                w * pair.away,
                any_side * pair.angle2,
                any_side * pair.length2,
            ];
            for (sum, term) in sums.iter_mut().zip(terms) {
                *sum += term;
            }
        }
        let [total, offset, turn, way] = sums.map(Lanes::to_array);
        std::array::from_fn(|l| Offset {
            residual: if total[l] > 0.0 {
                denoise * offset[l] / total[l]
            } else {
                0.0
            },
            // Normals turn by κ1 dx and κ2 dy, whose squares have the mean ½ (κ1² + κ2²) d² around a point.
            curvature: if way[l] > 0.0 {
                (2.0 * turn[l] / way[l]).sqrt().min(1.0 / self.support)
            } else {
                0.0
            },
        })
    }
}
