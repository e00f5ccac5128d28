//! Thin walls: both of their sides stay apart when the points on each are at most half as far from each other as the sides are.

use crate::base::par;
use crate::cloud::octree::Octree;
use crate::features::Features;
use crate::features::opposite::across;
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

/// The largest spacing that each point of the tree should have, where that is less than the `wanted` one; else infinite. `None`
/// where no part is thin.
fn limits(
    tree: &Octree,
    features: &Features,
    wanted: impl Fn(usize) -> f32 + Sync,
) -> Option<Vec<f32>> {
    let groups: Vec<Range<usize>> = tree.cut(|node| node.range().len() <= GROUP);
    let limit_of = |g: usize, steps: &mut Vec<f32>| {
        let middle = groups[g].start + groups[g].len() / 2;
        let spacing = wanted(middle);
        // Half of what is at most as far as that asks for less than the wanted spacing.
        let within = (2.0 * spacing, features.noise);
        let apart = across(tree, &features.normals, middle, within, steps).length();
        if apart > 0.0 && apart / 2.0 < spacing {
            apart / 2.0
        } else {
            f32::INFINITY
        }
    };
    // Most scans have no thin parts, which some of the groups tell.
    let some = par::map(groups.len().div_ceil(STRIDE), Vec::new, |i, steps| {
        limit_of(i * STRIDE, steps)
    });
    if some.iter().all(|limit| limit.is_infinite()) {
        return None;
    }
    let found = par::map(groups.len(), Vec::new, limit_of);
    let each = groups.iter().zip(found);
    Some(
        each.flat_map(|(group, limit)| group.clone().map(move |_| limit))
            .collect(),
    )
}

/// The share of a reduced point that a point of this spacing needs, so that theirs is at most `limit`.
fn least(spacing: f32, limit: f32) -> f64 {
    f64::from(spacing / limit).powi(2).min(1.0)
}

/// How many of all points keep thin walls apart, where the others are reduced as to `count`.
pub(crate) fn needed(tree: &Octree, features: &Features, count: usize) -> usize {
    let even = count as f64 / tree.points.len() as f64;
    let apart = THINNER * even.sqrt().recip() as f32;
    let Some(limits) = limits(tree, features, |i| features.spacing[i] * apart) else {
        return count;
    };
    let each = features.spacing.iter().zip(&limits);
    each.map(|(&s, &limit)| least(s, limit).max(even))
        .sum::<f64>() as usize
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
    let Some(limits) = limits(tree, features, |i| spacing[i]) else {
        return;
    };
    let floor = features.spacing.iter().zip(&limits);
    let mut floor: Vec<f64> = floor.map(|(&s, &limit)| least(s, limit)).collect();
    let more: f64 = floor
        .iter()
        .zip(share.iter())
        .map(|(f, &s)| (f - f64::from(s)).max(0.0))
        .sum();
    let most = MOST * count as f64;
    if more > most {
        for (f, &s) in floor.iter_mut().zip(share.iter()) {
            let s = f64::from(s);
            *f = if *f > s {
                s + (*f - s) * most / more
            } else {
                *f
            };
        }
    }
    let of = |k: usize, scale: f64| (deserved[k] * scale).min(1.0).max(floor[k]);
    let sum = |scale: f64| (0..floor.len()).map(|k| of(k, scale)).sum::<f64>();
    let total: f64 = deserved.iter().sum();
    let (mut low, mut high) = (0.0, count as f64 / total.max(f64::MIN_POSITIVE) * 4.0);
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        if sum(middle) > count as f64 {
            high = middle;
        } else {
            low = middle;
        }
    }
    for k in 0..floor.len() {
        let new = of(k, low);
        let before = f64::from(share[k]);
        if new > 0.0 && before > 0.0 {
            spacing[k] *= (before / new).sqrt() as f32;
            share[k] = new as f32;
        }
    }
}
