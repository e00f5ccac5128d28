//! One tile, reduced with its surroundings.

use crate::base::error::Result;
use crate::base::params::{Outliers, ReduceParams};
use crate::base::progress::{Progress, Stage};
use crate::base::rng::Rng;
use crate::cloud::octree::Octree;
use crate::cloud::{Cloud, Frame};
use crate::features::{Features, Known, outliers};
use crate::reduce::{Reduced, Whole, reduce_part};
use crate::tiles::grid::{BITS, Cube, Grid, Tile};
use crate::tiles::measures::Measures;
use crate::tiles::points::Points;

/// The points of a tile, one at least, at a level ([`crate::tiles::Plan::level`]), reduced from `points`: the scan's for level 0, else the reduced points
/// of the tiles below; those of the tile and of what touches it. Of `options` those hold that say how scalars and colours are carried,
/// and whether isolated points of the scan are dropped.
///
/// # Errors
/// [`crate::Error::BadOption`] (`attributes`), [`crate::Error::Cancelled`].
pub fn reduce(
    points: &Points,
    (tile, level): (Tile, u32),
    (grid, measures): (Grid, &Measures),
    options: &ReduceParams,
    progress: &mut dyn Progress,
) -> Result<Points> {
    let rule = measures.rule(level);
    let cube = Cube::of(tile);
    let range = surroundings((tile, level), (grid, measures));
    let given = points.select(&within(points, range));
    if given.places.is_empty() {
        return Ok(given);
    }
    // The caller's unit of the unit frame's 1.
    let side = cube.side() * grid.step();
    progress.update(Stage::Octree, 0.0)?;
    let known = rule.surface.known(side);
    let points = match options.outliers {
        Outliers::Drop if level == 0 => without_strays(&given, cube, &known, progress)?,
        _ => given.clone(),
    };
    let cloud = cloud_of(&points, cube);
    let tree = Octree::build(&cloud.points);
    progress.update(Stage::Octree, 1.0)?;
    let features = Features::measure_part(&tree, &known, progress)?;
    let chance = |i: u32| chance(points.places[i as usize]);
    let whole = Whole {
        law: rule.law.scaled(1.0 / side),
        scale: rule.scale,
        walls: rule.walls,
        chance: &chance,
    };
    let params = ReduceParams {
        cell_points: Some(rule.cell_points),
        attributes: options.attributes.clone(),
        ..ReduceParams::default()
    };
    let reduced = reduce_part((&cloud, &tree), features, &params, &whole, progress)?;
    let made = kept(reduced, places_in(cube, tile));
    if made.places.is_empty() {
        // All that stand for the tile's points lie beside it.
        let first = given.places.iter().position(|&place| tile.holds(place));
        return Ok(given.select(&first.map(|i| i as u32).into_iter().collect::<Vec<u32>>()));
    }
    Ok(made)
}

/// The part of the lattice whose points a tile on a level is reduced with: its lower corner and the first place beyond, inside of the
/// tile's cube.
pub fn surroundings(
    (tile, level): (Tile, u32),
    (grid, measures): (Grid, &Measures),
) -> [[u64; 3]; 2] {
    let reach = measures.rule(level).reach / grid.step();
    let reach = reach.min(tile.side() as f64 / 2.0).max(1.0) as u64;
    let [low, high] = tile.range();
    [
        low.map(|x| x.saturating_sub(reach)),
        high.map(|x| (x + reach).min(1 << BITS)),
    ]
}

/// The indices of the points there.
fn within(points: &Points, [low, high]: [[u64; 3]; 2]) -> Vec<u32> {
    let near = |place: &[u32; 3]| (0..3).all(|a| (low[a]..high[a]).contains(&u64::from(place[a])));
    let each = (0u32..).zip(&points.places);
    each.filter(|(_, place)| near(place))
        .map(|(i, _)| i)
        .collect()
}

fn cloud_of(points: &Points, cube: Cube) -> Cloud {
    let frame = Frame {
        center: [0.0; 3],
        diagonal: 1.0,
    };
    let inside = points.places.iter().map(|&place| cube.unit(place));
    Cloud {
        colors: points.colors.clone(),
        attributes: points.attributes.clone(),
        ..Cloud::in_frame(inside.collect(), frame)
    }
}

/// Which place a point of the unit frame has, if it is in the tile.
fn places_in(cube: Cube, tile: Tile) -> impl Fn(glam::Vec3) -> Option<[u32; 3]> {
    move |p| Some(cube.place(p)).filter(|&place| tile.holds(place))
}

fn kept(reduced: Reduced, place: impl Fn(glam::Vec3) -> Option<[u32; 3]>) -> Points {
    let cloud = reduced.cloud;
    let places: Vec<Option<[u32; 3]>> = cloud.points.iter().map(|&p| place(p)).collect();
    let inside: Vec<u32> = (0u32..)
        .zip(&places)
        .filter(|(_, place)| place.is_some())
        .map(|(i, _)| i)
        .collect();
    let all = Points {
        places: places.into_iter().map(Option::unwrap_or_default).collect(),
        colors: cloud.colors,
        attributes: cloud.attributes,
    };
    all.select(&inside)
}

/// The points that are not isolated, and the first where all are.
fn without_strays(
    points: &Points,
    cube: Cube,
    known: &Known,
    progress: &mut dyn Progress,
) -> Result<Points> {
    let tree = Octree::build(&cloud_of(points, cube).points);
    let isolated = outliers::isolated_part(&tree, (known.noise, known.spacing), progress)?;
    let each = tree.order.iter().zip(isolated);
    let mut others: Vec<u32> = each.filter(|(_, is)| !is).map(|(&i, _)| i).collect();
    others.sort_unstable();
    if others.is_empty() {
        others.push(0);
    }
    Ok(points.select(&others))
}

/// From 0 to 1, evenly: of a place, whatever tile asks.
pub(super) fn chance([x, y, z]: [u32; 3]) -> f64 {
    let first = Rng::new(u64::from(x) << 32 | u64::from(y)).next_u64();
    Rng::new(first ^ u64::from(z)).uniform()
}
