//! How many points the surface deserves where: the wanted spacing of the reduced points.
//!
//! 1. Curvature asks for a density ρ ∝ κ^α. Against the largest error of a piecewise linear surface α = 1 is best,
//!    against the rms error 2/3 (Clark, *Proc. SIGGRAPH* 1976 onwards; d'Azevedo and Simpson, 1991); α = ½ was the best
//!    measured, because κ is an estimate.
//! 2. Bounds keep flat parts from starving and noise from gathering all points: [`FINEST`], [`COARSEST`].
//! 3. A gradient limit |∇h| ≤ [`GRADING`] lets the spacing h grow only slowly away from where it is small; without it
//!    the error of a CAD part more than doubles.
//! 4. The scale makes the expected counts add up to the target.
//!
//! Steps 1-3 work on groups of a dozen points, which is the resolution that the curvature estimate has anyway.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;

use glam::Vec3;

use crate::features::Features;
use crate::octree::{Neighbor, Octree};
use crate::par;

/// Smallest spacing, as a share of the mean: three times the mean density.
const FINEST: f32 = 0.577;
/// Largest spacing, as a multiple of the mean: three quarters of the mean density. Flat parts that are given less come
/// out of a Poisson reconstruction with dents (error of a clean CAD part at 2: four times as large).
const COARSEST: f32 = 1.155;
/// Largest growth of the spacing per length along the surface.
const GRADING: f32 = 0.2;
/// Points whose curvature is averaged.
const GROUP: usize = 12;
/// Groups that limit each other's spacing: a ring around each.
const RING: usize = 12;

/// The wanted spacing at every point, in the octree's order.
#[derive(Debug, Clone)]
pub struct Density {
    /// √(area a reduced point), in the unit frame.
    pub spacing: Vec<f32>,
    /// Reduced points that this point's patch of surface deserves, at most 1; adds up to the target.
    pub share: Vec<f32>,
}

impl Density {
    /// The density of `count` ≤ n points. `curvature_weight` is α.
    pub fn new(tree: &Octree, features: &Features, count: usize, curvature_weight: f64) -> Density {
        let relative = relative_spacing(tree, features, curvature_weight);
        let deserved: Vec<f64> = features
            .spacing
            .iter()
            .zip(&relative)
            .map(|(&s, &h)| f64::from(s / h) * f64::from(s / h))
            .collect();
        let scale = scale_to(&deserved, count);
        Density {
            spacing: relative
                .iter()
                .map(|&h| (f64::from(h) / scale.sqrt()) as f32)
                .collect(),
            share: deserved
                .iter()
                .map(|&d| (d * scale).min(1.0) as f32)
                .collect(),
        }
    }

    /// The expected number of centres in each cell.
    pub fn shares(&self, cells: &[Range<usize>]) -> Vec<f64> {
        let of = |cell: &Range<usize>| self.share[cell.clone()].iter().map(|&s| f64::from(s)).sum();
        cells.iter().map(of).collect()
    }
}

/// Whole numbers that follow `shares`: their sums along the cells, rounded. No cell gets more than its points; together
/// they are exactly `total` (at most the number of all points).
pub fn quotas(shares: &[f64], cells: &[Range<usize>], total: usize) -> Vec<usize> {
    let scale = total as f64 / shares.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let (mut sum, mut given) = (0.0, 0);
    let mut quotas = Vec::with_capacity(cells.len());
    for (share, cell) in shares.iter().zip(cells) {
        sum += share * scale;
        let quota = (sum.round() as usize)
            .min(total)
            .saturating_sub(given)
            .min(cell.len());
        given += quota;
        quotas.push(quota);
    }
    // Full cells, and the rounding of the last sum, leave a few over.
    let mut missing = total - given;
    for (quota, cell) in quotas.iter_mut().zip(cells) {
        let extra = missing.min(cell.len() - *quota);
        *quota += extra;
        missing -= extra;
    }
    quotas
}

/// The factor s for which Σ min(1, s·d) = count.
fn scale_to(deserved: &[f64], count: usize) -> f64 {
    let mut scale = count as f64 / deserved.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    // Each round fills more points up to 1 and spreads the rest; almost always none or a few rounds.
    for _ in 0..30 {
        let (mut full, mut rest) = (0.0, 0.0);
        for &d in deserved {
            if d * scale >= 1.0 {
                full += 1.0;
            } else {
                rest += d;
            }
        }
        let next = (count as f64 - full) / rest.max(f64::MIN_POSITIVE);
        if next <= scale * (1.0 + 1e-9) || rest == 0.0 {
            break;
        }
        scale = next;
    }
    scale
}

/// Steps 1-3: the spacing at every point, its unit still free.
fn relative_spacing(tree: &Octree, features: &Features, alpha: f64) -> Vec<f32> {
    let groups = tree.cut(|node| node.range().len() <= GROUP);
    let centers: Vec<Vec3> = groups
        .iter()
        .map(|g| mean(&tree.points[g.clone()]))
        .collect();
    let mut spacing = curvature_spacing(features, &groups, alpha);
    let rings = rings(&centers);
    limit_gradient(&mut spacing, &centers, &rings);

    let mut relative = vec![0.0; tree.points.len()];
    for (range, ring) in groups.iter().zip(&rings) {
        for k in range.clone() {
            let p = tree.points[k];
            relative[k] = ring
                .iter()
                .map(|&j| spacing[j as usize] + GRADING * p.distance(centers[j as usize]))
                .fold(f32::INFINITY, f32::min);
        }
    }
    relative
}

/// Steps 1 and 2 for every group. The result's unit is that of `features.spacing`.
fn curvature_spacing(features: &Features, groups: &[Range<usize>], alpha: f64) -> Vec<f32> {
    let of = |v: &[f32], g: &Range<usize>| -> f64 {
        v[g.clone()].iter().map(|&x| f64::from(x)).sum::<f64>() / g.len() as f64
    };
    let area: Vec<f64> = groups
        .iter()
        .map(|g| g.len() as f64 * of(&features.spacing, g).powi(2))
        .collect();
    let total = area.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let unit = (total / features.spacing.len() as f64).sqrt();
    let curvature: Vec<f64> = groups.iter().map(|g| of(&features.curvature, g)).collect();
    let typical = curvature.iter().zip(&area).map(|(k, a)| k * a).sum::<f64>() / total;
    if typical == 0.0 || alpha == 0.0 || unit == 0.0 {
        return vec![unit.max(f64::from(f32::MIN_POSITIVE)) as f32; groups.len()];
    }
    // h = ρ^(-1/2), then in units of its mean over the surface, and bounded.
    let mut spacing: Vec<f64> = curvature
        .iter()
        .map(|k| libm::pow((k / typical).max(1e-6), -0.5 * alpha))
        .collect();
    for _ in 0..2 {
        let mean = spacing.iter().zip(&area).map(|(h, a)| h * a).sum::<f64>() / total;
        for h in &mut spacing {
            *h = (*h / mean).clamp(f64::from(FINEST), f64::from(COARSEST));
        }
    }
    spacing.iter().map(|h| (h * unit) as f32).collect()
}

/// The groups nearest to each group, itself first.
fn rings(centers: &[Vec3]) -> Vec<Vec<u32>> {
    let tree = Octree::build(centers);
    let mut rings = vec![Vec::new(); centers.len()];
    let found = par::map(centers.len(), Vec::new, |i, found: &mut Vec<Neighbor>| {
        tree.knn(tree.points[i], RING, found);
        let ring = found.iter().map(|n| tree.order[n.index as usize]);
        ring.collect::<Vec<u32>>()
    });
    for (&group, ring) in tree.order.iter().zip(found) {
        rings[group as usize] = ring;
    }
    rings
}

/// Step 3, exactly, by Dijkstra's algorithm: h ← min over paths of (h at the start + grading · length).
fn limit_gradient(spacing: &mut [f32], centers: &[Vec3], rings: &[Vec<u32>]) {
    // Positive floats order as their bits do.
    let entry = |h: f32, i: usize| Reverse((h.to_bits(), i as u32));
    let mut front: BinaryHeap<_> = spacing
        .iter()
        .enumerate()
        .map(|(i, &h)| entry(h, i))
        .collect();
    while let Some(Reverse((bits, i))) = front.pop() {
        let (h, i) = (f32::from_bits(bits), i as usize);
        if h > spacing[i] {
            continue;
        }
        for &j in &rings[i] {
            let j = j as usize;
            let limit = h + GRADING * centers[i].distance(centers[j]);
            if limit < spacing[j] {
                spacing[j] = limit;
                front.push(entry(limit, j));
            }
        }
    }
}

fn mean(points: &[Vec3]) -> Vec3 {
    points.iter().sum::<Vec3>() / points.len() as f32
}
