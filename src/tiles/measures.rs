//! What is the same in all tiles: noise, spacing, and the law of the density, found from samples of some leaves.

use crate::base::error::{Error, Result};
use crate::base::progress::Progress;
use crate::cloud::octree::Octree;
use crate::features::Features;
use crate::reduce::density;
use crate::reduce::law::{Law, Patch};
use crate::tiles::grid::{Cube, Grid, Tile};
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Points of a sample that count, at least.
const INNER: usize = 500;
/// Centres of a sub-domain, as [`mod@crate::reduce`] has them.
const CENTERS: f64 = 32.0;
/// Points of a sub-domain, as there.
const FEWEST: usize = 64;
/// See [`FEWEST`].
const MOST: usize = 512;

/// How much is kept of the scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Aim {
    /// A share of the points.
    Ratio(f64),
    /// About so many points.
    Count(f64),
    /// √(area a reduced point), in the caller's unit.
    Spacing(f64),
}

/// Some neighbouring points of a leaf.
#[derive(Debug, Clone)]
pub struct Sample {
    /// With those around, so that what is measured of those within is right.
    pub places: Vec<[u32; 3]>,
    /// The part that counts, on the lattice: lower corner, and the first place beyond.
    pub range: [[u64; 3]; 2],
    /// How many points of the scan it stands for.
    pub points: f64,
}

/// What is the same in all tiles. Lengths are in the caller's unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Measures {
    /// Standard deviation of the noise.
    pub noise: f64,
    /// Median spacing of the points.
    pub median: f64,
    /// √(area a point) of the scan.
    pub spacing: f64,
    /// √(area a reduced point), of the leaves.
    pub target: f64,
    /// Of the surface, for the scan's own points.
    pub law: Law,
    /// Reduced points that the law's spacing stands for, where it says 1; for the scan's own points.
    pub scale: f64,
}

/// What a tile is reduced by; lengths in the caller's unit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rule {
    pub(super) noise: f64,
    /// Median spacing of what is reduced.
    pub(super) median: f64,
    pub(super) law: Law,
    pub(super) scale: f64,
    /// Points of a sub-domain.
    pub(super) cell_points: usize,
    /// How far from a tile points still change what is in it.
    pub(super) reach: f64,
}

impl Measures {
    /// √(area a reduced point) of a tile below which so many levels of tiles are reduced: twice as much for each.
    pub fn spacing_at(&self, level: u32) -> f64 {
        self.target * f64::from(1u32 << level.min(31))
    }

    pub(super) fn rule(&self, level: u32) -> Rule {
        let given = match level {
            0 => self.spacing,
            _ => self.spacing_at(level - 1),
        };
        let made = self.spacing_at(level);
        let coarser = given / self.spacing;
        let ratio = (made / given).powi(2);
        let cell_points = ((CENTERS * ratio) as usize).clamp(FEWEST, MOST);
        Rule {
            // A reduced point is the mean of those that it stands for.
            noise: self.noise / coarser,
            median: self.median * coarser,
            law: self.law.with_groups(coarser),
            scale: self.scale * (coarser * self.target / made).powi(2),
            cell_points,
            // The clusters' sweeps and what looks at neighbours take ten spacings; a sub-domain is whole or not at all.
            reach: 10.0 * made + (cell_points as f64).sqrt() * given,
        }
    }
}

/// So many groups of neighbouring points of a leaf to measure, apart from each other: the indices of each, and the range that counts; the
/// same whenever the points are the same.
pub fn samples(tile: Tile, places: &[[u32; 3]], count: usize) -> Vec<(Vec<u32>, [[u64; 3]; 2])> {
    let count = count.clamp(1, places.len().max(1));
    let at = |i: usize| places.len() * (2 * i + 1) / (2 * count);
    (0..count).map(|i| sample(tile, places, at(i))).collect()
}

/// The neighbours of a point.
fn sample(tile: Tile, places: &[[u32; 3]], middle: usize) -> (Vec<u32>, [[u64; 3]; 2]) {
    let middle = places.get(middle).copied().unwrap_or_default();
    let within = |half: u64, place: &[u32; 3]| {
        (0..3).all(|a| u64::from(place[a].abs_diff(middle[a])) <= half)
    };
    let count = |half: u64| places.iter().filter(|place| within(half, place)).count();
    let mut half = tile.side();
    while half > 1 && count(half / 2) >= INNER {
        half /= 2;
    }
    let each = (0u32..).zip(places);
    let near = each.filter(|(_, place)| within(2 * half, place));
    let low = middle.map(|x| u64::from(x).saturating_sub(half));
    let high = middle.map(|x| u64::from(x) + half + 1);
    (near.map(|(i, _)| i).collect(), [low, high])
}

/// One sample while it is measured.
struct Measured {
    tree: Octree,
    /// In the caller's unit, of the unit frame's 1.
    side: f64,
    features: Features,
    /// Of the tree's points, whether each counts.
    counts: Vec<bool>,
    /// Points of the scan that each of these stands for.
    weight: f64,
}

/// Measures a scan by its samples. `curvature_weight` is that of [`crate::ReduceParams`].
///
/// # Errors
/// [`Error::EmptyCloud`] without a point, [`Error::Cancelled`].
pub fn measure(
    samples: &[Sample],
    grid: Grid,
    (aim, curvature_weight): (Aim, f64),
    progress: &mut dyn Progress,
) -> Result<Measures> {
    let mut measured = Vec::new();
    for sample in samples.iter().filter(|sample| !sample.places.is_empty()) {
        measured.push(Measured::new(sample, grid, progress)?);
    }
    if measured.is_empty() {
        return Err(Error::EmptyCloud);
    }
    let total: f64 = samples.iter().map(|sample| sample.points).sum();
    let median_of = |value: &dyn Fn(&Measured) -> f64| {
        let mut values: Vec<(f64, f64)> = measured.iter().map(|m| (value(m), m.points())).collect();
        values.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut before = 0.0;
        let mut middle = values.iter().find(|(_, points)| {
            before += points;
            2.0 * before >= total
        });
        middle.get_or_insert(&values[0]).0
    };
    let noise = median_of(&|m| f64::from(m.features.noise) * m.side);
    let median = median_of(&|m| f64::from(m.features.median_spacing()) * m.side);
    let mut patches = Vec::new();
    for m in &mut measured {
        let known = ((noise / m.side) as f32, (median / m.side) as f32);
        m.features = Features::measure_part(&m.tree, known, progress)?;
        patches.extend(m.patches());
    }
    let area: f64 = patches.iter().map(|patch| patch.area * patch.weight).sum();
    let law = Law::of(&patches, curvature_weight);
    let spacing = (area / total).sqrt();
    let count = match aim {
        Aim::Ratio(ratio) => ratio * total,
        Aim::Count(count) => count,
        Aim::Spacing(spacing) => area / (spacing * spacing),
    };
    let (mut deserved, mut weights) = (Vec::new(), Vec::new());
    for m in &measured {
        let law = law.scaled(1.0 / m.side);
        let all = density::deserved_by(&m.tree, &m.features, &law);
        let inner = all.iter().zip(&m.counts).filter(|(_, counts)| **counts);
        deserved.extend(inner.map(|(d, _)| d));
        weights.resize(deserved.len(), m.weight);
    }
    let count = count.clamp(1.0, total);
    Ok(Measures {
        noise,
        median,
        spacing,
        target: (area / count).sqrt(),
        law,
        scale: density::scale_to(&deserved, |i| weights[i], count),
    })
}

impl Measured {
    fn new(sample: &Sample, grid: Grid, progress: &mut dyn Progress) -> Result<Measured> {
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
            side: cube.side() * grid.step(),
            tree,
            features,
            counts,
            weight: sample.points / inner as f64,
        })
    }

    /// Of the scan, that it stands for.
    fn points(&self) -> f64 {
        self.weight * self.counts.iter().filter(|counts| **counts).count() as f64
    }

    /// The patches that count, in the caller's unit.
    fn patches(&self) -> Vec<Patch> {
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
        let inner = self.tree.points.iter().zip(&self.counts);
        let inner = inner.filter(|(_, counts)| **counts).map(|(p, _)| *p);
        inner.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| {
            (low.min(p), high.max(p))
        })
    }
}

fn in_range(place: [u32; 3], [low, high]: [[u64; 3]; 2]) -> bool {
    (0..3).all(|a| (low[a]..high[a]).contains(&u64::from(place[a])))
}
