//! Tiles: the cuts do not show.

#[path = "common/tiling.rs"]
mod tiling;

use pointweave::base::params::{Carry, ReduceParams};
use pointweave::base::rng::Rng;
use pointweave::cloud::Attribute;
use pointweave::progress::Silent;
use pointweave::tiles::{Aim, Tile, reduce};
use std::collections::BTreeMap;
use tiling::{apart, joined, made, measured, planned, quantile, sorted};

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

#[test]
fn tiles_have_the_points_of_one_piece() {
    let points = sheet(160_000);
    let whole = planned(&points, 1_000_000);
    let parts = planned(&points, 20_000);
    assert_eq!((whole.leaves.len(), whole.grid), (1, parts.grid));
    assert!(parts.leaves.len() > 7);
    let leaves = sorted(&points, &parts);
    let measures = measured(&parts, &leaves, (Aim::Ratio(0.1), (4, 500)));
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
            &ReduceParams::default(),
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
        (Aim::Count(500.0), (4, 500)),
    );
    let options = ReduceParams {
        attributes: BTreeMap::from([("class".into(), Carry::Majority)]),
        ..ReduceParams::default()
    };
    let reduced = reduce::reduce(
        &leaf,
        (Tile::ROOT, 0),
        (plan.grid, &measures),
        &options,
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
        let measures = measured(&plan, &leaves, (Aim::Ratio(0.3), (4, 500)));
        let tiles = made(&plan, &leaves, &measures);
        let reduced = joined(tiles.values()).places.len();
        assert!(
            (1..=count as usize).contains(&reduced),
            "{reduced} of {count}"
        );
    }
}
