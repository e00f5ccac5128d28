//! The bilateral filter of the features, steps 2 and 3 of [`crate::features`]: normals, distances to the surface and
//! curvature from neighbours on the same side of every crease.

use crate::features::{Features, Scales, ball};
use crate::lanes::{LANES, Lanes};
use crate::octree::{Neighbor, Octree};
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
/// Coordinate of a padding lane: outside of every support, and small enough to be squared.
const FAR: f32 = 1e6;

/// What a pass of the filter finds.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Step {
    Normals,
    Offsets,
}

/// Result of the filter at one point.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Filtered {
    pub(crate) normal: Vec3,
    pub(crate) offset: f32,
    pub(crate) curvature: f32,
}

/// Memory of one worker of the filter: neighbours of a group, structure of arrays padded to whole lanes with points that
/// are out of every support.
#[derive(Default)]
pub(crate) struct Filter {
    candidates: Vec<Neighbor>,
    position: [Vec<f32>; 3],
    normal: [Vec<f32>; 3],
}

impl Filter {
    /// One pass over the points `range`, which lie close together.
    pub(crate) fn group(
        &mut self,
        tree: &Octree,
        features: &Features,
        range: Range<usize>,
        step: Step,
    ) -> Vec<Filtered> {
        let (center, extent) = ball(&tree.points[range.clone()]);
        let spacing = features.spacing[range.clone()].iter().sum::<f32>() / range.len() as f32;
        let scales = Scales::new(features.noise, spacing);
        let support = spacing * (scales.filter / std::f32::consts::PI).sqrt();
        let sheet = SAME_SHEET * features.noise.max(BEND * spacing);
        let together = extent <= 2.0 * support;
        if together {
            tree.within(center, support + extent, &mut self.candidates);
            self.load(tree, features, center);
        }
        range
            .map(|i| {
                if !together {
                    tree.within(tree.points[i], support, &mut self.candidates);
                    self.load(tree, features, center);
                }
                let p = tree.points[i] - center;
                self.at(
                    p,
                    features.normals[i],
                    (support, sheet),
                    scales.denoise,
                    step,
                )
            })
            .collect()
    }

    fn load(&mut self, tree: &Octree, features: &Features, origin: Vec3) {
        let padded = self.candidates.len().next_multiple_of(LANES);
        for axis in 0..3 {
            let of = |v: &[Vec3], j: u32| v[j as usize][axis];
            let position = self
                .candidates
                .iter()
                .map(|c| of(&tree.points, c.index) - origin[axis]);
            self.position[axis].clear();
            self.position[axis].extend(position);
            self.position[axis].resize(padded, FAR);
            self.normal[axis].clear();
            self.normal[axis].extend(
                self.candidates
                    .iter()
                    .map(|c| of(&features.normals, c.index)),
            );
            self.normal[axis].resize(padded, 0.0);
        }
    }

    fn at(
        &self,
        p: Vec3,
        n: Vec3,
        (support, sheet): (f32, f32),
        denoise: f32,
        step: Step,
    ) -> Filtered {
        let one = Lanes::splat(1.0);
        let half = Lanes::splat(0.5);
        let support2 = Lanes::splat(1.0 / (support * support));
        let sheet2 = Lanes::splat(1.0 / (sheet * sheet));
        let side2 = Lanes::splat(1.0 / (SAME_SIDE * SAME_SIDE));
        let clip = |x: Lanes| x.max(Lanes::ZERO);
        let [px, py, pz, nx, ny, nz] = [p.x, p.y, p.z, n.x, n.y, n.z].map(Lanes::splat);
        let mut sums = [Lanes::ZERO; 6];
        let (mut turn, mut way) = (Lanes::ZERO, Lanes::ZERO);
        for block in (0..self.position[0].len()).step_by(LANES) {
            let [x, y, z] = [0, 1, 2].map(|axis| Lanes::load(&self.position[axis][block..]));
            let [mx, my, mz] = [0, 1, 2].map(|axis| Lanes::load(&self.normal[axis][block..]));
            let (dx, dy, dz) = (px - x, py - y, pz - z);
            let length2 = dx * dx + dy * dy + dz * dz;
            let near = clip(one - length2 * support2);
            let dot = nx * mx + ny * my + nz * mz;
            let sign = dot.map(|d| 1f32.copysign(d));
            let (mx, my, mz) = (mx * sign, my * sign, mz * sign);
            let angle2 = clip(Lanes::splat(2.0) - (dot + dot) * sign);
            let away = half * ((nx + mx) * dx + (ny + my) * dy + (nz + mz) * dz);
            let sheet = clip(one - away * away * sheet2);
            let side = clip(one - angle2 * side2);
            let root = near * side * sheet;
            let w = root * root;
            let any_side = near * sheet;
            for (sum, term) in sums.iter_mut().zip([one, away, mx, my, mz]) {
                *sum += w * term;
            }
            sums[5] += any_side * any_side;
            turn += any_side * angle2;
            way += any_side * length2;
        }
        let [total, offset, mx, my, mz, any_side] = sums.map(Lanes::sum);
        let (turn, way) = (turn.sum(), way.sum());
        match step {
            Step::Normals => {
                // Without noise the quadric's normal is the better one, but for the neighbours of a crease.
                let refused = 1.0 - total / any_side.max(f32::MIN_POSITIVE);
                let crease = (refused - NEAR_CREASE.start) / (NEAR_CREASE.end - NEAR_CREASE.start);
                let filtered = Vec3::new(mx, my, mz).normalize_or(n);
                let mix = denoise.max(crease.clamp(0.0, 1.0));
                Filtered {
                    normal: n.lerp(filtered, mix).normalize_or(n),
                    ..Filtered::default()
                }
            }
            Step::Offsets => Filtered {
                normal: n,
                offset: if total > 0.0 {
                    denoise * offset / total
                } else {
                    0.0
                },
                // Normals turn by κ1 dx and κ2 dy, whose squares have the mean ½ (κ1² + κ2²) d² around a point.
                curvature: if way > 0.0 {
                    (2.0 * turn / way).sqrt().min(1.0 / support)
                } else {
                    0.0
                },
            },
        }
    }
}
