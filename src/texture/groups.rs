//! Queries for texels that lie beside each other: what any of them may find is gathered once.
//!
//! What is nearest to a place is at most as far from it as what is nearest to another place, and both places: so all that is nearest to
//! places of a ball lies within the distance of what is nearest to its middle, and twice its radius. A list in the order of distance from
//! the middle needs to be followed only until the next cannot be nearer than what was found.

use crate::cloud::octree::Octree;
use crate::cloud::queries::{Neighbor, insert};
use crate::light::carry::Spot;
use crate::mesh::Mesh;
use crate::report::distance::TriangleTree;
use glam::Vec3;
use std::ops::Range;

/// Most texels of a group.
const MOST: usize = 16;
/// How far they are from the first at most, in texels.
const WIDE: f64 = 4.0;
/// Of single precision, and more.
const ROUNDING: f32 = 1e-5;

/// Places that follow each other and lie within a few texels; `texel` is the length of one.
pub(super) fn groups(places: &[Vec3], texel: f64) -> Vec<Range<usize>> {
    let wide = (WIDE * texel) as f32;
    let mut groups = Vec::new();
    let mut start = 0;
    for (i, place) in places.iter().enumerate() {
        if i - start == MOST || place.distance(places[start]) > wide {
            groups.push(start..i);
            start = i;
        }
    }
    if start < places.len() {
        groups.push(start..places.len());
    }
    groups
}

/// A ball around places.
fn ball(places: &[Vec3]) -> (Vec3, f32) {
    let middle = places.iter().sum::<Vec3>() / places.len() as f32;
    let far = |p: &Vec3| p.distance(middle);
    (middle, places.iter().map(far).fold(0.0, f32::max))
}

/// What was gathered for a group, and what served the group before.
#[derive(Default)]
pub(super) struct Gathered {
    hint: u32,
    triangles: Vec<(f64, u32)>,
    points: Vec<(f32, u32)>,
    seed: Vec<Neighbor>,
    near: Vec<Neighbor>,
}

impl Gathered {
    /// The place of `mesh` nearest to each of `places`; `faces` is of its triangles.
    pub(super) fn spots(
        &mut self,
        places: &[Vec3],
        mesh: &Mesh,
        faces: &TriangleTree,
    ) -> Vec<Spot> {
        let (middle, radius) = ball(places);
        let (distance2, triangle) = faces.closest(middle, self.hint);
        self.hint = triangle;
        let reach = distance2.sqrt() + 2.0 * f64::from(radius) + f64::from(ROUNDING) * 0.1;
        faces.within(middle, reach, &mut self.triangles);
        let list = &mut self.triangles;
        list.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let nearest = |&place: &Vec3| {
            let beside = f64::from(place.distance(middle)) * (1.0 + f64::from(ROUNDING));
            let mut best = (f64::INFINITY, triangle);
            for &(distance, other) in list.iter() {
                if distance - beside > best.0.sqrt() {
                    break;
                }
                let distance2 = faces.distance2(place, other);
                if distance2 < best.0 {
                    best = (distance2, other);
                }
            }
            Spot::on(best.1, place, mesh)
        };
        places.iter().map(nearest).collect()
    }

    /// Calls `take` with each of `places`, by its number, and the `count` points nearest to it, as [`Octree::knn`] gives them.
    pub(super) fn points(
        &mut self,
        places: &[Vec3],
        tree: &Octree,
        count: usize,
        mut take: impl FnMut(usize, &[Neighbor]),
    ) {
        let (middle, radius) = ball(places);
        tree.knn(middle, count, &mut self.seed);
        let farthest = self.seed.last().map_or(0.0, |n| n.distance2.sqrt());
        let reach = (farthest + 2.0 * radius) * (1.0 + ROUNDING) + ROUNDING * 0.1;
        let list = &mut self.points;
        list.clear();
        tree.visit(
            |_, node| node.distance2(middle) <= reach * reach,
            |i| {
                let distance2 = tree.points[i].distance_squared(middle);
                if distance2 <= reach * reach {
                    list.push((distance2.sqrt(), i as u32));
                }
            },
        );
        list.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for (k, &place) in places.iter().enumerate() {
            let beside = place.distance(middle) * (1.0 + ROUNDING);
            self.near.clear();
            for &(distance, index) in list.iter() {
                if let [.., last] = self.near[..]
                    && self.near.len() == count
                {
                    let bound = (distance - beside).max(0.0) * (1.0 - ROUNDING);
                    if bound * bound > last.distance2 {
                        break;
                    }
                }
                let distance2 = tree.points[index as usize].distance_squared(place);
                insert(&mut self.near, count, Neighbor { distance2, index });
            }
            take(k, &self.near);
        }
    }
}
