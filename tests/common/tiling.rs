//! Scans in tiles, as `pkg/tiles` makes them.

#![allow(dead_code)] // every test file takes what it needs

use glam::Vec3;
use pointweave::base::params::ReduceParams;
use pointweave::cloud::octree::Octree;
use pointweave::progress::Silent;
use pointweave::tiles::points::Splitter;
use pointweave::tiles::{
    Aim, Counts, Measures, Plan, Points, Sample, Tile, measure, reduce, samples,
};
use std::collections::BTreeMap;

/// The points of each leaf of a plan.
pub fn sorted(points: &[[f64; 3]], plan: &Plan) -> BTreeMap<Tile, Points> {
    let split = Splitter::new(plan.grid, plan.leaves.iter().map(|leaf| leaf.tile))
        .split(points.iter().copied());
    let mut at = 0;
    let mut of = BTreeMap::new();
    for (tile, count) in split.runs {
        let places = split.places[at..at + count].to_vec();
        of.insert(
            tile,
            Points {
                places,
                ..Points::default()
            },
        );
        at += count;
    }
    of
}

pub fn joined<'a>(parts: impl Iterator<Item = &'a Points>) -> Points {
    let places = parts.flat_map(|part| part.places.iter().copied()).collect();
    Points {
        places,
        ..Points::default()
    }
}

pub fn planned(points: &[[f64; 3]], most: u64) -> Plan {
    let mut counts = Counts::default();
    counts.add(points).unwrap();
    Plan::new(&[counts], most).unwrap()
}

/// By so many samples of so many points of each leaf.
pub fn measured(
    plan: &Plan,
    leaves: &BTreeMap<Tile, Points>,
    (aim, samples_of): (Aim, (usize, usize)),
) -> Measures {
    let samples: Vec<Sample> = leaves
        .iter()
        .flat_map(|(&tile, own)| {
            let around = plan.around_leaf(tile);
            let points = joined(around.iter().filter_map(|tile| leaves.get(tile)));
            let groups = samples::samples(tile, &points.places, samples_of);
            let each = own.places.len() as f64 / groups.len() as f64;
            groups.into_iter().map(move |(indices, range)| Sample {
                places: points.select(&indices).places,
                range,
                points: each,
            })
        })
        .collect();
    measure(&samples, plan.grid, (aim, 0.5), &mut Silent).unwrap()
}

/// All leaves, reduced.
pub fn made(
    plan: &Plan,
    leaves: &BTreeMap<Tile, Points>,
    measures: &Measures,
) -> BTreeMap<Tile, Points> {
    made_with(plan, leaves, (measures, &ReduceParams::default()))
}

/// [`made`] with options.
pub fn made_with(
    plan: &Plan,
    leaves: &BTreeMap<Tile, Points>,
    (measures, options): (&Measures, &ReduceParams),
) -> BTreeMap<Tile, Points> {
    let of = |tile: Tile| {
        let around = plan.around_leaf(tile);
        let points = joined(around.iter().filter_map(|tile| leaves.get(tile)));
        let whole = (plan.grid, measures);
        reduce::reduce(&points, (tile, 0), whole, options, &mut Silent).unwrap()
    };
    plan.leaves
        .iter()
        .map(|leaf| (leaf.tile, of(leaf.tile)))
        .collect()
}

/// How far the points of each are from the nearest of the other, in `spacing`s, in ascending order.
pub fn apart(a: &Points, b: &Points, spacing: f64) -> Vec<f32> {
    let unit = |p: &[u32; 3]| Vec3::from_array(p.map(|x| x as f32 / 4_294_967_296.0 - 0.5));
    let [a, b] = [a, b].map(|points| points.places.iter().map(unit).collect::<Vec<_>>());
    let mut far = Vec::new();
    for (from, to) in [(&a, &b), (&b, &a)] {
        let tree = Octree::build(to);
        let distance = |&p: &Vec3| tree.nearest(p).distance2.sqrt() / spacing as f32;
        far.extend(from.iter().map(distance));
    }
    far.sort_by(f32::total_cmp);
    far
}

/// Of values in ascending order, the one that so large a share is no larger than.
pub fn quantile(values: &[f32], share: f64) -> f32 {
    values[((values.len() - 1) as f64 * share) as usize]
}
