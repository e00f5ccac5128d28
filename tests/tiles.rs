//! Tiles: the cuts do not show.

use glam::Vec3;
use pointweave::base::params::Carry;
use pointweave::base::rng::Rng;
use pointweave::cloud::Attribute;
use pointweave::cloud::octree::Octree;
use pointweave::progress::Silent;
use pointweave::tiles::points::Splitter;
use pointweave::tiles::{
    Aim, Counts, Measures, Plan, Points, Sample, Tile, measure, measures, reduce,
};
use std::collections::BTreeMap;

/// A bent sheet with a bump and some noise, 2 units wide.
fn sheet(n: usize) -> Vec<[f64; 3]> {
    let mut rng = Rng::new(5);
    (0..n)
        .map(|_| {
            let (x, y) = (2.0 * rng.uniform(), 2.0 * rng.uniform());
            let bump = (-12.0 * ((x - 1.1f64).powi(2) + (y - 0.7f64).powi(2))).exp();
            [
                4e5 + x,
                y,
                0.3 * (3.0 * x).sin() + 0.4 * bump + 1e-3 * rng.normal(),
            ]
        })
        .collect()
}

/// The points of each leaf of a plan.
fn sorted(points: &[[f64; 3]], plan: &Plan) -> BTreeMap<Tile, Points> {
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

fn joined<'a>(parts: impl Iterator<Item = &'a Points>) -> Points {
    let places = parts.flat_map(|part| part.places.iter().copied()).collect();
    Points {
        places,
        ..Points::default()
    }
}

fn planned(points: &[[f64; 3]], most: u64) -> Plan {
    let mut counts = Counts::default();
    counts.add(points).unwrap();
    Plan::new(&[counts], most).unwrap()
}

fn measured(plan: &Plan, leaves: &BTreeMap<Tile, Points>, aim: Aim) -> Measures {
    let samples: Vec<Sample> = leaves
        .iter()
        .flat_map(|(&tile, points)| {
            let groups = measures::samples(tile, &points.places, 4);
            let each = points.places.len() as f64 / groups.len() as f64;
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
fn made(
    plan: &Plan,
    leaves: &BTreeMap<Tile, Points>,
    measures: &Measures,
) -> BTreeMap<Tile, Points> {
    let of = |tile: Tile| {
        let around = plan.around_leaf(tile);
        let points = joined(around.iter().filter_map(|tile| leaves.get(tile)));
        reduce::reduce(
            &points,
            (tile, 0),
            (plan.grid, measures),
            &BTreeMap::new(),
            &mut Silent,
        )
        .unwrap()
    };
    plan.leaves
        .iter()
        .map(|leaf| (leaf.tile, of(leaf.tile)))
        .collect()
}

/// How far the points of each are from the nearest of the other, in `spacing`s, in ascending order.
fn apart(a: &Points, b: &Points, spacing: f64) -> Vec<f32> {
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
fn quantile(values: &[f32], share: f64) -> f32 {
    values[((values.len() - 1) as f64 * share) as usize]
}

#[test]
fn tiles_have_the_points_of_one_piece() {
    let points = sheet(160_000);
    let whole = planned(&points, 1_000_000);
    let parts = planned(&points, 20_000);
    assert_eq!((whole.leaves.len(), whole.grid), (1, parts.grid));
    assert!(parts.leaves.len() > 7);
    let leaves = sorted(&points, &parts);
    let measures = measured(&parts, &leaves, Aim::Ratio(0.1));
    assert!((measures.noise - 1e-3).abs() < 2e-4, "{}", measures.noise);
    let one = &made(&whole, &sorted(&points, &whole), &measures)[&Tile::ROOT];
    let tiles = made(&parts, &leaves, &measures);
    let all = joined(tiles.values());
    // As many as were asked for, in either.
    for count in [one.places.len(), all.places.len()] {
        assert!((15_500..16_500).contains(&count), "{count}");
    }
    let spacing = measures.target / whole.grid.size;
    let far = apart(one, &all, spacing);
    assert!(quantile(&far, 0.99) < 0.005, "{}", quantile(&far, 0.99));
    assert!(quantile(&far, 0.999) < 0.1, "{}", quantile(&far, 0.999));

    // The levels above: a quarter of the points each, and cut they are what they are in one piece.
    let mut below = tiles;
    for tile in parts.inner() {
        let around = parts.around_inner(tile);
        let given = joined(around.iter().map(|tile| &below[tile]));
        let level = parts.level(tile);
        let points = reduce::reduce(
            &given,
            (tile, level),
            (parts.grid, &measures),
            &BTreeMap::new(),
            &mut Silent,
        )
        .unwrap();
        assert!(points.places.iter().all(|&place| tile.holds(place)));
        below.insert(tile, points);
    }
    let root = below[&Tile::ROOT].places.len();
    let expected = 16_000 >> (2 * parts.depth());
    assert!(
        (expected * 8 / 10..expected * 12 / 10).contains(&root),
        "{root} for {expected}"
    );
}

#[test]
fn colours_and_scalars_go_along() {
    let points = sheet(6000);
    let plan = planned(&points, 10_000);
    let mut leaf = sorted(&points, &plan).remove(&Tile::ROOT).unwrap();
    let middle = leaf.places.iter().map(|p| u64::from(p[0])).sum::<u64>() / 6000;
    let side = |p: &[u32; 3]| u8::from(u64::from(p[0]) > middle);
    leaf.colors = Some(leaf.places.iter().map(|p| [200 * side(p), 7, 0]).collect());
    let values = leaf.places.iter().map(|p| f32::from(side(p))).collect();
    leaf.attributes = vec![Attribute {
        name: "class".into(),
        values,
    }];
    let measures = measured(
        &plan,
        &BTreeMap::from([(Tile::ROOT, leaf.clone())]),
        Aim::Count(500.0),
    );
    let carry = BTreeMap::from([("class".into(), Carry::Majority)]);
    let reduced = reduce::reduce(
        &leaf,
        (Tile::ROOT, 0),
        (plan.grid, &measures),
        &carry,
        &mut Silent,
    )
    .unwrap();
    assert!(
        (400..600).contains(&reduced.places.len()),
        "{}",
        reduced.places.len()
    );
    let classes = &reduced.attributes[0].values;
    assert!(classes.iter().all(|&c| c == 0.0 || c == 1.0));
    assert!(reduced.colors.unwrap().iter().all(|c| c[1] == 7));
}

#[test]
fn a_few_points_are_a_tile() {
    for count in [1, 2, 5, 40] {
        let points: Vec<[f64; 3]> = (0..count).map(|i| [0.5 * f64::from(i), 0.0, 1e3]).collect();
        let plan = planned(&points, 1000);
        let leaves = sorted(&points, &plan);
        let measures = measured(&plan, &leaves, Aim::Ratio(0.3));
        let tiles = made(&plan, &leaves, &measures);
        let reduced = joined(tiles.values()).places.len();
        assert!(
            (1..=count as usize).contains(&reduced),
            "{reduced} of {count}"
        );
    }
}
