//! The density of the reduced points: their wanted spacing at every place of the surface.
//!
//! 1. The spacing that curvature asks for, bounded: [`law`](crate::reduce::law).
//! 2. A gradient limit |∇h| ≤ [`GRADING`] lets the spacing h grow only slowly away from where it is small; without it
//!    the error of a CAD part more than doubles.
//! 3. The scale makes the expected counts add up to the target.
//! 4. On thin walls the spacing is at most half of the distance to the other side, whatever the curvature says ([`walls`]).
//!
//! Steps 1 and 2 work on groups of a dozen points, which is the resolution that the curvature estimate has anyway.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;

use glam::Vec3;

use crate::base::par;
use crate::cloud::neighborhood::{Block, CELL, Neighborhood, bounds, even_reach};
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;
use crate::features::Features;
use crate::reduce::law::{Law, Patch};
use crate::reduce::walls::{self, WallShare};

/// Largest growth of the spacing per length along the surface.
const GRADING: f32 = 0.2;
/// Largest spacing with a tolerance as the target, a fraction of the diagonal: a plane needs more than its corners.
pub(crate) const WIDEST: f64 = 0.05;
/// Smallest spacing, about the resolution of the octree's keys.
const SMALLEST: f32 = 1e-6;
/// Points whose curvature is averaged.
const GROUP: usize = 12;
/// Groups that limit each other's spacing: a ring around each.
const RING: usize = 12;
/// Groups whose points are done in one go.
const SLICE: usize = 64;
/// A cell of groups gathers this many times as far as an even patch over its box would need.
const MARGIN: f32 = 1.6;

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
        let groups = Groups::new(tree, features);
        let law = Law::of(
            &groups.patches(1.0).collect::<Vec<Patch>>(),
            curvature_weight,
        );
        let relative = groups.spread(tree, groups.wanted(&law));
        let deserved: Vec<f64> = deserved(features, &relative).collect();
        let scale = scale_to(&deserved, |_| 1.0, count as f64);
        let unit = 1.0 / scale.sqrt();
        let spacing = relative.iter().map(|&h| (f64::from(h) * unit) as f32);
        let share = deserved.iter().map(|&d| (d * scale).min(1.0) as f32);
        let mut density = Density {
            spacing: spacing.collect(),
            share: share.collect(),
        };
        let Density { spacing, share } = &mut density;
        walls::refine(tree, features, (spacing, share), &deserved, count);
        density
    }

    /// The density of a part of a scan, by the law, the scale and the walls of the whole: what it is at a point follows from the
    /// surface around it alone.
    pub(crate) fn of_part(
        tree: &Octree,
        features: &Features,
        (law, scale): (&Law, f64),
        walls: Option<WallShare>,
    ) -> Density {
        let relative = relative_spacing(tree, features, law);
        let unit = 1.0 / scale.sqrt();
        let deserved: Vec<f64> = deserved(features, &relative).collect();
        let share = deserved.iter().map(|d| (d * scale).min(1.0) as f32);
        let mut density = Density {
            share: share.collect(),
            spacing: relative
                .iter()
                .map(|&h| (f64::from(h) * unit) as f32)
                .collect(),
        };
        if let Some(walls) = walls {
            let Density { spacing, share } = &mut density;
            let floor = walls::all_floors(tree, features, |i| spacing[i]);
            let new = |k: usize| {
                let floor = walls::raised(f64::from(share[k]), floor[k], walls.allowed);
                (deserved[k] * walls.scale).min(1.0).max(floor)
            };
            let new: Vec<f64> = (0..floor.len()).map(new).collect();
            walls::set(&new, (spacing, share));
        }
        density
    }

    /// The number of reduced points that the shares add up to, rounded up.
    pub fn count(&self) -> usize {
        let total: f64 = self.share.iter().map(|&s| f64::from(s)).sum();
        (total.ceil() as usize).clamp(1, self.share.len())
    }

    /// The expected number of centres in each cell.
    pub fn shares(&self, cells: &[Range<usize>]) -> Vec<f64> {
        let of = |cell: &Range<usize>| self.share[cell.clone()].iter().map(|&s| f64::from(s)).sum();
        cells.iter().map(of).collect()
    }
}

/// Densities of surfaces whose error curvature alone decides, for one cloud.
pub struct CurvatureSpacing<'a> {
    tree: &'a Octree,
    features: &'a Features,
    groups: Groups,
}

impl<'a> CurvatureSpacing<'a> {
    /// Cost: as [`Density::new`].
    pub fn new(tree: &'a Octree, features: &'a Features) -> CurvatureSpacing<'a> {
        CurvatureSpacing {
            tree,
            features,
            groups: Groups::new(tree, features),
        }
    }

    /// The density of a piecewise linear surface whose chords are off by `chord`, with a spacing of at most [`WIDEST`].
    pub fn within(&self, chord: f64) -> Density {
        let widest = WIDEST;
        let wanted = self.groups.wanted(&Law::Chords { chord, widest });
        let spacing = self.groups.spread(self.tree, wanted);
        let share = deserved(self.features, &spacing)
            .map(|d| d.min(1.0) as f32)
            .collect();
        Density { spacing, share }
    }
}

/// Whole numbers that follow `shares`: their sums along the cells, rounded. No cell gets more than its points; together
/// they are exactly `total` (at most the number of all points).
pub fn quotas(shares: &[f64], cells: &[Range<usize>], total: usize) -> Vec<usize> {
    let all: f64 = shares.iter().sum();
    let points: usize = cells.iter().map(|c| c.len()).sum();
    let (mut sum, mut given) = (0.0, 0);
    let mut quotas = Vec::with_capacity(cells.len());
    for (share, cell) in shares.iter().zip(cells) {
        // Where all points are equal there is no area to share.
        sum += if all > 0.0 {
            share / all
        } else {
            cell.len() as f64 / points as f64
        };
        let quota = ((sum * total as f64).round() as usize)
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

/// Whole numbers that follow the shares of the cells each for itself: rounded up where `chance` of the cell, evenly distributed
/// from 0 to 1, is less than what is beyond the whole.
pub(crate) fn local_quotas(
    shares: &[f64],
    cells: &[Range<usize>],
    chance: impl Fn(&Range<usize>) -> f64,
) -> Vec<usize> {
    let each = shares.iter().zip(cells);
    let mut quotas: Vec<usize> = each
        .map(|(share, cell)| ((share + chance(cell)).floor() as usize).min(cell.len()))
        .collect();
    // Some point stands for the few that there are.
    if quotas.iter().all(|&quota| quota == 0) {
        quotas[0] = 1;
    }
    quotas
}

/// The spacing at every point by the law, at the scale 1.
pub(crate) fn relative_spacing(tree: &Octree, features: &Features, law: &Law) -> Vec<f32> {
    let groups = Groups::new(tree, features);
    groups.spread(tree, groups.wanted(law))
}

/// The patches of the surface of which curvature is known, each with the middle of its points.
pub(crate) fn patches(tree: &Octree, features: &Features, weight: f64) -> Vec<(Vec3, Patch)> {
    let groups = Groups::new(tree, features);
    let patches = groups.patches(weight);
    groups.centers.iter().copied().zip(patches).collect()
}

/// The factor s for which Σ w min(1, s·d) = count.
pub(crate) fn scale_to(deserved: &[f64], weight: impl Fn(usize) -> f64, count: f64) -> f64 {
    let each = || deserved.iter().enumerate().map(|(i, d)| (d, weight(i)));
    let sum: f64 = each().map(|(d, w)| d * w).sum();
    let mut scale = count / sum.max(f64::MIN_POSITIVE);
    // Each round fills more points up to 1 and spreads the rest; almost always none or a few rounds.
    for _ in 0..30 {
        let (mut full, mut rest) = (0.0, 0.0);
        for (d, w) in each() {
            if d * scale >= 1.0 {
                full += w;
            } else {
                rest += d * w;
            }
        }
        let next = (count - full) / rest.max(f64::MIN_POSITIVE);
        if next <= scale * (1.0 + 1e-9) || rest == 0.0 {
            break;
        }
        scale = next;
    }
    scale
}

/// Reduced points of spacing h that the patch of every point deserves: its area over h².
pub(crate) fn deserved<'a>(
    features: &'a Features,
    spacing: &'a [f32],
) -> impl Iterator<Item = f64> + 'a {
    let patch = features.spacing.iter().zip(spacing);
    patch.map(|(&s, &h)| (f64::from(s) / f64::from(h)).powi(2))
}

/// Neighbouring points, a dozen at a time.
struct Groups {
    ranges: Vec<Range<usize>>,
    centers: Vec<Vec3>,
    curvature: Vec<f64>,
    area: Vec<f64>,
}

impl Groups {
    fn new(tree: &Octree, features: &Features) -> Groups {
        let ranges = tree.cut(|node| node.range().len() <= GROUP);
        let mean = |v: &[f32], g: &Range<usize>| -> f64 {
            v[g.clone()].iter().map(|&x| f64::from(x)).sum::<f64>() / g.len() as f64
        };
        let center =
            |g: &Range<usize>| tree.points[g.clone()].iter().sum::<Vec3>() / g.len() as f32;
        Groups {
            centers: ranges.iter().map(center).collect(),
            curvature: ranges
                .iter()
                .map(|g| mean(&features.curvature, g))
                .collect(),
            area: ranges
                .iter()
                .map(|g| g.len() as f64 * mean(&features.spacing, g).powi(2))
                .collect(),
            ranges,
        }
    }

    fn patches(&self, weight: f64) -> impl Iterator<Item = Patch> {
        let each = self.curvature.iter().zip(&self.area);
        each.map(move |(&curvature, &area)| Patch {
            curvature,
            area,
            weight,
        })
    }

    fn wanted(&self, law: &Law) -> Vec<f32> {
        self.curvature.iter().map(|&k| law.spacing(k)).collect()
    }

    /// Step 2, then from groups to points.
    fn spread(&self, tree: &Octree, mut wanted: Vec<f32>) -> Vec<f32> {
        let rings = rings(&self.centers);
        limit_gradient(&mut wanted, &self.centers, &rings);
        // Inside its disc a group's spacing holds as it is.
        let disc = |&area: &f64| (area / std::f64::consts::PI).sqrt() as f32;
        let discs: Vec<f32> = self.area.iter().map(disc).collect();
        let of = |p: Vec3, ring: &[u32]| {
            let limit = |&j: &u32| {
                let j = j as usize;
                wanted[j] + GRADING * (p.distance(self.centers[j]) - discs[j]).max(0.0)
            };
            let least = ring.iter().map(limit).fold(f32::INFINITY, f32::min);
            // Where all points are equal any spacing will do, but not none.
            least.max(SMALLEST)
        };
        par::flat_map(
            rings.len().div_ceil(SLICE),
            tree.points.len(),
            || (),
            |slice, ()| {
                let groups = slice * SLICE..((slice + 1) * SLICE).min(rings.len());
                let points = groups.flat_map(|g| self.ranges[g].clone().map(move |k| (k, g)));
                points.map(|(k, g)| of(tree.points[k], &rings[g])).collect()
            },
        )
    }
}

/// Memory of one worker.
#[derive(Default)]
struct Surroundings {
    cell: Neighborhood,
    own: Neighborhood,
    found: Vec<Neighbor>,
}

/// The groups around each group, about [`RING`], itself among them.
fn rings(centers: &[Vec3]) -> Vec<Vec<u32>> {
    let tree = Octree::build(centers);
    let cells = tree.cut(|node| node.range().len() <= CELL);
    let of = |c: usize, around: &mut Surroundings| {
        let cell = cells[c].clone();
        let corners = bounds(&tree.points[cell.clone()]);
        let reach = MARGIN * even_reach(corners, cell.len(), RING);
        let together = around.cell.gather(&tree, corners, reach);
        let mut rings = Vec::with_capacity(cell.len());
        for block in Block::all(&tree.points, cell) {
            let middle = tree.points[block.middle()];
            let mut radius = around.cell.kth_distance(middle, RING);
            let mut hood = &mut around.cell;
            if !together || radius > reach {
                tree.knn(middle, RING, &mut around.found);
                radius = around.found.last().map_or(0.0, |n| n.distance2).sqrt();
                hood = &mut around.own;
                hood.gather_all(&tree, (block.lo, block.hi), radius);
            }
            hood.narrow(&block, radius);
            rings.extend(block.range.clone().map(|i| {
                let near = hood.near().filter(|(_, at)| {
                    let at = Vec3::from_array(at.map(|x| x.lane(0)));
                    at.distance_squared(tree.points[i]) <= radius * radius
                });
                near.map(|(j, _)| tree.order[j]).collect::<Vec<u32>>()
            }));
        }
        rings
    };
    let mut rings = vec![Vec::new(); centers.len()];
    par::map_each(cells.len(), Surroundings::default, of, |c, found| {
        for (&group, ring) in tree.order[cells[c].clone()].iter().zip(found) {
            rings[group as usize] = ring;
        }
    });
    rings
}

/// Step 2, exactly, by Dijkstra's algorithm: h ← min over paths of (h at the start + grading · length).
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
