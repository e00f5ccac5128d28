//! Thin walls: both of their sides stay apart when the points on each are at most half as far from each other as the sides are.

use crate::base::par;
use crate::cloud::octree::Octree;
use crate::features::Features;
use crate::features::opposite::across;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Points that are asked together, for one of them.
const GROUP: usize = 12;
/// One of so many groups is asked first.
const STRIDE: usize = 8;
/// Share of all reduced points that thin parts may take, at most, beyond what they would have anyway.
const MOST: f64 = 0.75;
/// Walls ask for more points than there are when they are thinner than twice this share of the spacing: thicker ones are as good
/// with those that there are, and noise is averaged by few.
const THINNER: f32 = 0.75;
/// Steps of the search for what the other parts get: each halves what is uncertain of it.
const STEPS: usize = 40;

/// What the thin walls of a scan get.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WallShare {
    /// The scale of what the other parts get, in place of the whole's.
    pub scale: f64,
    /// Which part of what walls ask for beyond that they get.
    pub allowed: f64,
}

/// Neighbouring points of a tree that are asked together, and the largest spacing that they should have where that is less than
/// the `wanted` one; else infinite.
struct Asking<'a, W> {
    tree: &'a Octree,
    features: &'a Features,
    groups: Vec<Range<usize>>,
    wanted: W,
}

impl<'a, W: Fn(usize) -> f32 + Sync> Asking<'a, W> {
    fn new(tree: &'a Octree, features: &'a Features, wanted: W) -> Asking<'a, W> {
        let groups = tree.cut(|node| node.range().len() <= GROUP);
        Asking {
            tree,
            features,
            groups,
            wanted,
        }
    }

    fn limit(&self, g: usize, steps: &mut Vec<f32>) -> f32 {
        let middle = self.groups[g].start + self.groups[g].len() / 2;
        let spacing = (self.wanted)(middle);
        // Half of what is at most as far as that asks for less than the wanted spacing.
        let within = (2.0 * spacing, self.features.noise);
        let apart = across(self.tree, &self.features.normals, middle, within, steps).length();
        if apart > 0.0 && apart / 2.0 < spacing {
            apart / 2.0
        } else {
            f32::INFINITY
        }
    }

    /// Whether some part is thin, as one of [`STRIDE`] groups tells: most scans have none.
    fn is_any_thin(&self) -> bool {
        let some = self.groups.len().div_ceil(STRIDE);
        let limits = par::map(some, Vec::new, |i, steps| self.limit(i * STRIDE, steps));
        limits.iter().any(|limit| limit.is_finite())
    }

    /// The share that each point needs.
    fn floors(&self) -> Vec<f64> {
        let each = self.features.spacing.iter().zip(self.limits());
        each.map(|(&s, limit)| least(s, limit)).collect()
    }

    /// Of each point.
    fn limits(&self) -> Vec<f32> {
        let found = par::map(self.groups.len(), Vec::new, |g, steps| self.limit(g, steps));
        let each = self.groups.iter().zip(found);
        each.flat_map(|(group, limit)| group.clone().map(move |_| limit))
            .collect()
    }
}

/// The share of a reduced point that a point of this spacing needs, so that theirs is at most `limit`.
fn least(spacing: f32, limit: f32) -> f64 {
    f64::from(spacing / limit).powi(2).min(1.0)
}

/// How many of all points keep thin walls apart, where the others are reduced as to `count`.
pub(crate) fn needed(tree: &Octree, features: &Features, count: usize) -> usize {
    let even = count as f64 / tree.points.len() as f64;
    let apart = THINNER * even.sqrt().recip() as f32;
    let asking = Asking::new(tree, features, |i: usize| features.spacing[i] * apart);
    if !asking.is_any_thin() {
        return count;
    }
    let limits = asking.limits();
    let each = features.spacing.iter().zip(&limits);
    each.map(|(&s, &limit)| least(s, limit).max(even))
        .sum::<f64>() as usize
}

/// The share of a reduced point that each point needs by its wall, at most 1; 0 where there is none. `None` where some of the points
/// tell of none.
pub(crate) fn floors(
    tree: &Octree,
    features: &Features,
    spacing: impl Fn(usize) -> f32 + Sync,
) -> Option<Vec<f64>> {
    let asking = Asking::new(tree, features, spacing);
    asking.is_any_thin().then(|| asking.floors())
}

/// [`floors`], for which all points are asked.
pub(crate) fn all_floors(
    tree: &Octree,
    features: &Features,
    spacing: impl Fn(usize) -> f32 + Sync,
) -> Vec<f64> {
    Asking::new(tree, features, spacing).floors()
}

/// Which part of what walls ask for beyond what their points have anyway they get, given each point's share, its floor and how many
/// points it stands for.
pub(crate) fn allowed(points: impl Iterator<Item = (f64, f64, f64)>, count: f64) -> f64 {
    let more: f64 = points.map(|(s, floor, w)| w * (floor - s).max(0.0)).sum();
    let most = MOST * count;
    if more > most { most / more } else { 1.0 }
}

/// A floor as far as it is allowed, of a point that has a share anyway.
pub(crate) fn raised(share: f64, floor: f64, allowed: f64) -> f64 {
    if allowed < 1.0 && floor > share {
        share + (floor - share) * allowed
    } else {
        floor
    }
}

/// The scale of what points deserve so that with floors they are `count`, given what each deserves, its floor and how many points it
/// stands for.
pub(crate) fn scale_to(points: impl Iterator<Item = (f64, f64, f64)> + Clone, count: f64) -> f64 {
    let sum = |scale: f64| -> f64 {
        let each = points.clone();
        each.map(|(d, floor, w)| w * (d * scale).min(1.0).max(floor))
            .sum()
    };
    let total: f64 = points.clone().map(|(d, _, w)| d * w).sum();
    let (mut low, mut high) = (0.0, count / total.max(f64::MIN_POSITIVE) * 4.0);
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        if sum(middle) > count {
            high = middle;
        } else {
            low = middle;
        }
    }
    low
}

/// Gives points new shares, and the spacing that belongs to them.
pub(crate) fn set(new: &[f64], (spacing, share): (&mut [f32], &mut [f32])) {
    for (k, &new) in new.iter().enumerate() {
        let before = f64::from(share[k]);
        if new > 0.0 && before > 0.0 {
            spacing[k] *= (before / new).sqrt() as f32;
            share[k] = new as f32;
        }
    }
}

/// Makes the spacing finer on thin walls and coarser elsewhere, for the same `count`. `deserved` is what each point would get of
/// a reduced point, up to a common factor.
pub(crate) fn refine(
    tree: &Octree,
    features: &Features,
    (spacing, share): (&mut [f32], &mut [f32]),
    deserved: &[f64],
    count: usize,
) {
    let found = floors(tree, features, |i| spacing[i]);
    let Some(mut floor) = found else {
        return;
    };
    let pairs = share.iter().zip(&floor);
    let allowed = allowed(
        pairs.map(|(&s, &floor)| (f64::from(s), floor, 1.0)),
        count as f64,
    );
    for (floor, &s) in floor.iter_mut().zip(share.iter()) {
        *floor = raised(f64::from(s), *floor, allowed);
    }
    let each = deserved.iter().zip(&floor);
    let scale = scale_to(each.map(|(&d, &floor)| (d, floor, 1.0)), count as f64);
    let each = deserved.iter().zip(&floor);
    let new: Vec<f64> = each
        .map(|(d, &floor)| (d * scale).min(1.0).max(floor))
        .collect();
    set(&new, (spacing, share));
}
