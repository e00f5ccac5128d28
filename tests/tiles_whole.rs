//! Tiles: what a reduction does in one piece, tiles do, too: tolerances, thin walls, scan lines, rounded heights, stray points.

#[path = "common/tiling.rs"]
mod tiling;

use glam::Vec3;
use pointweave::base::params::{Outliers, ReduceParams, Target};
use pointweave::base::rng::Rng;
use pointweave::cloud::octree::Octree;
use pointweave::cloud::{Cloud, Frame};
use pointweave::features::Features;
use pointweave::pipeline::reduce;
use pointweave::progress::Silent;
use pointweave::reduce::height_field::Patches;
use pointweave::reduce::shares::SHARES;
use pointweave::tiles::{Aim, Tile};
use tiling::{apart, joined, made, made_with, measured, planned, quantile, sorted};

/// Height of a relief with a bump, 2 units wide, that is flat in one half.
fn height(x: f64, y: f64) -> f64 {
    let bump = (-40.0 * ((x - 0.5f64).powi(2) + (y - 0.7f64).powi(2))).exp();
    let waves = if x < 1.0 {
        0.05 * (9.0 * x).sin().powi(2)
    } else {
        0.05 * 9f64.sin().powi(2)
    };
    waves + 0.2 * bump
}

/// Places in a square of 2 units, evenly by chance.
fn square(n: usize, seed: u64) -> Vec<[f64; 2]> {
    let mut rng = Rng::new(seed);
    (0..n)
        .map(|_| [2.0 * rng.uniform(), 2.0 * rng.uniform()])
        .collect()
}

#[test]
fn a_tolerance_is_kept_with_about_the_points_of_one_piece() {
    let mut rng = Rng::new(6);
    let points: Vec<[f64; 3]> = square(100_000, 5)
        .iter()
        .map(|&[x, y]| [x, y, height(x, y) + 1e-3 * rng.normal()])
        .collect();
    let tolerance = 4e-3;
    let plan = planned(&points, 20_000);
    let leaves = sorted(&points, &plan);
    let measures = measured(&plan, &leaves, (Aim::Tolerance(tolerance), (1, 8000)));
    assert_eq!(measures.tolerance, Some(tolerance));
    let tiles = made(&plan, &leaves, &measures);
    let all = joined(tiles.values());
    // In one piece lengths are shares of the diagonal.
    let positions: Vec<f32> = points.as_flattened().iter().map(|&x| x as f32).collect();
    let cloud = Cloud::from_f32(&positions).unwrap();
    let params = ReduceParams {
        target: Target::Tolerance(tolerance / cloud.frame.diagonal),
        ..ReduceParams::default()
    };
    let one = reduce(&cloud, &params, &mut Silent).unwrap().reduced.cloud;
    let counts = (all.places.len() as f64, one.len() as f64);
    assert!(
        counts.0 < 1.35 * counts.1 && counts.0 > 0.75 * counts.1,
        "{counts:?}"
    );

    // Both surfaces beside the true one, measured in the same way.
    let (size, corner) = (plan.grid.size, plan.grid.corner);
    let unit =
        |p: [f64; 3]| Vec3::from_array([0, 1, 2].map(|a| ((p[a] - corner[a]) / size - 0.5) as f32));
    let of_tiles = all.places.iter().map(|&p| unit(plan.grid.world(p)));
    let Frame { center, diagonal } = one.frame;
    let world = |p: &Vec3| [0, 1, 2].map(|a| f64::from(p[a]) * diagonal + center[a]);
    let of_one = one.points.iter().map(|p| unit(world(p)));
    let far = [of_tiles.collect::<Vec<Vec3>>(), of_one.collect()].map(|points| {
        let patches = Surface::through(&points);
        let inside = |&[x, y]: &[f64; 2]| (0.1..1.9).contains(&x) && (0.1..1.9).contains(&y);
        let places = square(20_000, 8).into_iter().filter(inside);
        let mut far: Vec<f32> = places
            .map(|[x, y]| patches.distance(unit([x, y, height(x, y)])) * size as f32)
            .collect();
        far.sort_by(f32::total_cmp);
        quantile(&far, 0.99)
    });
    assert!(far[0] < 1.2 * far[1], "{far:?}");
}

/// The surface through points whose normals are estimated.
struct Surface {
    tree: Octree,
    patches: Patches,
}

impl Surface {
    fn through(points: &[Vec3]) -> Surface {
        let tree = Octree::build(points);
        let features = Features::measure(&tree, &mut Silent).unwrap();
        let mut normals = vec![Vec3::ZERO; points.len()];
        for (&i, &normal) in tree.order.iter().zip(&features.normals) {
            normals[i as usize] = normal;
        }
        let patches = Patches::fit(&tree, &normals);
        Surface { tree, patches }
    }

    fn distance(&self, p: Vec3) -> f32 {
        let mut found = Vec::new();
        self.tree.knn(p, SHARES, &mut found);
        let near = std::array::from_fn(|k| self.tree.order[found[k].index as usize]);
        self.patches.distance(p, near)
    }
}

#[test]
fn thin_walls_stay_apart() {
    let gap = 0.03;
    let points: Vec<[f64; 3]> = square(80_000, 1)
        .iter()
        .enumerate()
        .map(|(i, &[x, y])| [x, y, gap * (i % 2) as f64])
        .collect();
    let plan = planned(&points, 10_000);
    let leaves = sorted(&points, &plan);
    // One point for each 0.05 of both sides together: the sides would be joined.
    let measures = measured(&plan, &leaves, (Aim::Spacing(0.05), (4, 500)));
    let walls = measures.walls.expect("there are thin walls");
    assert!(
        walls.allowed < 1.0 && walls.scale < measures.scale,
        "{walls:?}"
    );
    let all = joined(made(&plan, &leaves, &measures).values());
    let step = plan.grid.step();
    let heights = all
        .places
        .iter()
        .map(|p| plan.grid.corner[2] + f64::from(p[2]) * step);
    let between = heights
        .filter(|z| (0.2 * gap..0.8 * gap).contains(z))
        .count();
    assert!(
        20 * between < all.places.len(),
        "{between} of {}",
        all.places.len()
    );
}

#[test]
fn scan_lines_are_told_and_cuts_do_not_show_on_them() {
    let mut rng = Rng::new(2);
    let (lines, along) = (64, 1200);
    let points: Vec<[f64; 3]> = (0..lines * along)
        .map(|i| {
            let (x, y) = (2.0 * rng.uniform(), 2.0 * (i / along) as f64 / lines as f64);
            [x, y, height(x, y) + 5e-4 * rng.normal()]
        })
        .collect();
    let whole = planned(&points, 1_000_000);
    let parts = planned(&points, 20_000);
    let leaves = sorted(&points, &parts);
    let measures = measured(&parts, &leaves, (Aim::Ratio(0.05), (4, 500)));
    let told = measures.lines.expect("there are lines");
    assert!(told.share > 0.5, "{told:?}");
    assert!((measures.noise - 5e-4).abs() < 2e-4, "{}", measures.noise);
    let one = &made(&whole, &sorted(&points, &whole), &measures)[&Tile::ROOT];
    let tiles = joined(made(&parts, &leaves, &measures).values());
    let counts = [one, &tiles].map(|points| points.places.len() as f64);
    assert!((counts[0] / counts[1] - 1.0).abs() < 0.02, "{counts:?}");
    let far = apart(one, &tiles, measures.target / whole.grid.size);
    assert!(quantile(&far, 0.9) < 0.2, "{}", quantile(&far, 0.9));
}

#[test]
fn rounded_heights_are_noise() {
    let step = 0.02;
    let points: Vec<[f64; 3]> = square(80_000, 3)
        .iter()
        .map(|&[x, y]| [x, y, step * ((0.4 * x + 0.3 * y * y) / step).round()])
        .collect();
    let plan = planned(&points, 10_000);
    let measures = measured(&plan, &sorted(&points, &plan), (Aim::Ratio(0.1), (4, 500)));
    let expected = step / 12f64.sqrt();
    assert!(
        (measures.steps / expected - 1.0).abs() < 0.1,
        "{}",
        measures.steps
    );
    assert!(measures.noise >= measures.steps);
}

#[test]
fn stray_points_are_dropped_where_that_is_asked() {
    let mut rng = Rng::new(4);
    let mut points: Vec<[f64; 3]> = square(40_000, 7)
        .iter()
        .map(|&[x, y]| [x, y, height(x, y)])
        .collect();
    points.extend((0..200).map(|_| {
        [
            2.0 * rng.uniform(),
            2.0 * rng.uniform(),
            0.5 + rng.uniform(),
        ]
    }));
    let plan = planned(&points, 10_000);
    let leaves = sorted(&points, &plan);
    let measures = measured(&plan, &leaves, (Aim::Ratio(0.3), (4, 500)));
    let above = |outliers| {
        let options = ReduceParams {
            outliers,
            ..ReduceParams::default()
        };
        let tiles = made_with(&plan, &leaves, (&measures, &options));
        let places = tiles.values().flat_map(|points| points.places.iter());
        places.filter(|&&p| plan.grid.world(p)[2] > 0.45).count()
    };
    assert!(above(Outliers::Keep) > 100, "{}", above(Outliers::Keep));
    // A tile of strays alone keeps one.
    assert!(
        above(Outliers::Drop) <= plan.leaves.len(),
        "{}",
        above(Outliers::Drop)
    );
}
