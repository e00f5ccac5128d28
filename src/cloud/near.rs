//! The nearest neighbours of every point: what a query of the tree gives for each, from what is gathered around a cell once.

use crate::base::error::Result;
use crate::base::lanes::{LANES, Lanes, places_within};
use crate::base::par;
use crate::base::progress::{Progress, Stage};
use crate::cloud::neighborhood::{bounds, even_reach};
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;
use glam::Vec3;
use std::ops::Range;

/// Points of a cell, at most: more share a search, and are looked at by each.
const CELL: usize = 64;
/// Points that a cell gathers, at most. Cells of isolated points far from each other would gather half of the cloud.
const MOST: usize = 2048;
/// Gathered is so many times the distance in which a cell's points would have their neighbours if they were spread evenly.
const WIDER: f32 = 1.4;
/// The square of a radius is taken so much larger: rounding must not lose a point at its rim.
const RIM: f32 = 1.0 + 1e-6;
/// Cells between two looks at whether the caller wants to stop.
const SLICE: usize = 128;
/// Coordinate of a padding lane, as far as none is looked at.
const FAR: f32 = 1e6;

/// What lies around a cell. The memory of one worker.
#[derive(Default)]
struct Around {
    /// Indices in the tree, ascending, and their coordinates padded to whole lanes.
    indices: Vec<u32>,
    at: [Vec<f32>; 3],
    /// All points within this of the cell's points are there; 0: none are.
    reach: f32,
    places: Vec<u32>,
    found: Vec<Neighbor>,
}

impl Around {
    fn gather(&mut self, tree: &Octree, cell: Range<usize>, reach: f32) {
        self.indices.clear();
        let (lo, hi) = bounds(&tree.points[cell]);
        let whole = tree.gather(lo - reach, hi + reach, MOST, &mut self.indices);
        self.reach = if whole { reach } else { 0.0 };
        let padded = self.indices.len().next_multiple_of(LANES);
        for (axis, at) in self.at.iter_mut().enumerate() {
            at.clear();
            at.extend(self.indices.iter().map(|&i| tree.points[i as usize][axis]));
            at.resize(padded, FAR);
        }
    }

    /// The gathered points within a radius of `q`, by index.
    fn find(&mut self, tree: &Octree, q: Vec3, radius: f32) {
        let [x, y, z] = q.to_array().map(Lanes::splat);
        let at = &self.at;
        let distance2 = |start: usize| {
            let [x, y, z] =
                [(0, x), (1, y), (2, z)].map(|(axis, q)| Lanes::load(&at[axis][start..]) - q);
            x * x + y * y + z * z
        };
        let limit = radius * radius * RIM;
        places_within(self.indices.len(), limit, distance2, &mut self.places);
        let neighbor = |&place: &u32| {
            let index = self.indices[place as usize];
            let distance2 = tree.points[index as usize].distance_squared(q);
            Neighbor { distance2, index }
        };
        self.found.clear();
        self.found.extend(self.places.iter().map(neighbor));
    }

    /// Keeps the `k` nearest, nearest first, equal distances by index.
    fn keep_nearest(&mut self, k: usize) {
        let order = |a: &Neighbor, b: &Neighbor| {
            (a.distance2.total_cmp(&b.distance2)).then(a.index.cmp(&b.index))
        };
        if self.found.len() > k {
            self.found.select_nth_unstable_by(k, order);
            self.found.truncate(k);
        }
        self.found.sort_unstable_by(order);
    }
}

/// How a pass over all points is told.
pub(crate) type Told<'a> = (Stage, &'a mut dyn Progress);

/// `f` of each point and of its `k` nearest, itself among them, nearest first, as [`Octree::knn`] gives them. Where a `radius` is
/// given for each point, those farther away may be missing.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(crate) fn each_nearest<T: Send>(
    tree: &Octree,
    k: usize,
    radius: Option<&(dyn Fn(usize) -> f32 + Sync)>,
    told: Told,
    f: impl Fn(usize, &mut Vec<Neighbor>) -> T + Sync + Send,
) -> Result<Vec<T>> {
    let reach = |cell: Range<usize>| match radius {
        Some(radius) => cell.map(radius).fold(0.0, f32::max),
        None => WIDER * even_reach(bounds(&tree.points[cell.clone()]), cell.len(), k),
    };
    let mut all = Vec::with_capacity(tree.points.len());
    let one = |i: usize, around: &mut Around| {
        let q = tree.points[i];
        let wanted = radius.map_or(around.reach, |radius| radius(i));
        let gathered = around.reach > 0.0 && wanted <= around.reach;
        if gathered {
            around.find(tree, q, wanted);
        }
        if gathered && (radius.is_some() || around.found.len() >= k) {
            around.keep_nearest(k);
        } else {
            tree.knn(q, k, &mut around.found);
        }
        f(i, &mut around.found)
    };
    each(tree, reach, told, one, |_, value| all.push(value))?;
    Ok(all)
}

/// `f` of each point and of all that are within its `radius`, itself among them, and perhaps of some that are hardly farther; `take` gets
/// what it gives, in order.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(crate) fn each_within<T: Send>(
    tree: &Octree,
    radius: &(dyn Fn(usize) -> f32 + Sync),
    told: Told,
    f: impl Fn(usize, &[Neighbor]) -> T + Sync + Send,
    take: impl FnMut(usize, T),
) -> Result<()> {
    // A stray point looks far: it alone does so.
    let reach = |cell: Range<usize>| {
        let mut all: Vec<f32> = cell.map(radius).collect();
        let most = all.len() - all.len().div_ceil(8);
        *all.select_nth_unstable_by(most, f32::total_cmp).1
    };
    let one = |i: usize, around: &mut Around| {
        let (q, radius) = (tree.points[i], radius(i));
        if around.reach > 0.0 && radius <= around.reach {
            around.find(tree, q, radius);
        } else {
            let (limit, found) = (radius * radius * RIM, &mut around.found);
            found.clear();
            tree.visit(
                |_, node| node.distance2(q) <= limit,
                |j| {
                    let distance2 = tree.points[j].distance_squared(q);
                    if distance2 <= limit {
                        let index = j as u32;
                        found.push(Neighbor { distance2, index });
                    }
                },
            );
        }
        f(i, &around.found)
    };
    each(tree, reach, told, one, take)
}

/// `f` of each point, cell by cell, with what is within `reach` of the cell; `take` gets what it gives, in order.
fn each<T: Send>(
    tree: &Octree,
    reach: impl Fn(Range<usize>) -> f32 + Sync + Send,
    (stage, progress): Told,
    f: impl Fn(usize, &mut Around) -> T + Sync + Send,
    mut take: impl FnMut(usize, T),
) -> Result<()> {
    let cells = tree.cut(|node| node.range().len() <= CELL);
    for (k, some) in cells.chunks(SLICE).enumerate() {
        progress.update(stage, (k * SLICE) as f32 / cells.len() as f32)?;
        let found = par::map(some.len(), Around::default, |c, around| {
            around.gather(tree, some[c].clone(), reach(some[c].clone()));
            let each = some[c].clone().map(|i| f(i, around));
            each.collect::<Vec<T>>()
        });
        for (cell, found) in some.iter().zip(found) {
            cell.clone()
                .zip(found)
                .for_each(|(i, found)| take(i, found));
        }
    }
    progress.update(stage, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::progress::Silent;
    use crate::base::rng::Rng;

    /// A sheet whose density changes, copies, a cloud, and stragglers.
    fn points() -> Vec<Vec3> {
        let mut rng = Rng::new(7);
        let mut at = || (rng.uniform() - 0.5) as f32;
        let mut points: Vec<Vec3> = (0..3000)
            .map(|i| Vec3::new(at() * (i % 7) as f32 / 7.0, at(), 0.01 * at()))
            .collect();
        points.extend(vec![Vec3::splat(0.1); 3000]);
        points.extend((0..300).map(|_| 0.9 * Vec3::new(at(), at(), at())));
        points
    }

    #[test]
    fn they_are_those_of_a_query_for_each_point() {
        let tree = Octree::build(&points());
        let told = || (Stage::Features, Box::new(Silent));
        for k in [1, 8, 41] {
            let (stage, mut silent) = told();
            let found = each_nearest(&tree, k, None, (stage, &mut *silent), |_, found| {
                found.clone()
            });
            let radius = |i: usize| 0.02 + 1e-5 * i as f32;
            let near = each_nearest(&tree, k, Some(&radius), (stage, &mut *silent), |_, f| {
                f.clone()
            });
            let mut expected = Vec::new();
            for (i, (found, near)) in found.unwrap().iter().zip(near.unwrap()).enumerate() {
                tree.knn(tree.points[i], k, &mut expected);
                assert_eq!(*found, expected);
                let within = |list: &[Neighbor]| {
                    let inside = list.iter().filter(|n| n.distance2.sqrt() <= radius(i));
                    inside.copied().collect::<Vec<_>>()
                };
                assert_eq!(within(&near), within(&expected));
            }
        }
    }

    #[test]
    fn all_within_a_radius_are_found() {
        let tree = Octree::build(&points());
        let radius = |i: usize| if i.is_multiple_of(50) { 0.4 } else { 0.03 };
        let told = (Stage::Features, &mut Silent as &mut dyn Progress);
        let mut all = Vec::new();
        let copy = |_, found: &[Neighbor]| found.to_vec();
        each_within(&tree, &radius, told, copy, |_, found| all.push(found)).unwrap();
        assert_eq!(all.len(), tree.points.len());
        for (i, found) in all.iter().enumerate().step_by(7) {
            let is_in = |j: &u32| tree.points[*j as usize].distance(tree.points[i]) <= radius(i);
            let expected: Vec<u32> = (0..tree.points.len() as u32).filter(is_in).collect();
            let mut found: Vec<u32> = found.iter().map(|n| n.index).collect();
            found.retain(is_in);
            found.sort_unstable();
            assert_eq!(found, expected);
        }
    }
}
