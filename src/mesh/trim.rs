//! Trims the dual mesh: leaves out sheets that no point supports, and makes one fan around each vertex.
//!
//! Every step only leaves out quads, so edges keep at most two; [`split_bow_ties`] then sees to the vertices.

use crate::base::groups::Groups;
use crate::base::par;
use crate::base::sets::Sets;
use crate::base::sort_keys::{key, of_key, pack, unpack};
use crate::cloud::octree::Octree;
use crate::features::noise::quantile;
use crate::mesh::dual::Dual;
use crate::mesh::probe::{Quad, Vertex};
use crate::orient::SMALLEST;
use glam::Vec3;

/// An open surface ends within this share of a point's reach of it. Reaches are some 2.2 spacings, so that is 1.3, and what
/// the rim is smoothed by stays within 1.5.
const RIM: f32 = 0.6;
/// A rim that shows its sensor the back is trimmed so many median reaches deep, about 4.4 spacings. Depth frames curl at
/// outlines by less; farther in, what looks away is noise on a surface that is seen at a grazing angle.
const BEHIND: f64 = 2.0;
/// Points at the end of a surface have half as many neighbours as others and seem to be farther apart: the reach that
/// counts is the median of so many.
const AROUND: usize = 24;
/// A component that is the nearest one to fewer points than this is a phantom: stragglers off a noisy surface make such,
/// up to about 10 of them together were seen at a noise of 0.5 % of the diagonal.
const LEAST_POINTS: u32 = SMALLEST as u32;
/// A second layer has less than this share of the largest component's points.
const LAYER_POINTS: f64 = 0.1;
/// Half of its vertices are within this share of a point's reach, some two spacings, of another component. Of the merged range
/// images of a bunny all pieces are within 0.7, next pieces of other scans are beyond 1.
const LAYER: f32 = 0.9;
/// Points that one index of a parallel map takes.
const POINTS_PER_TASK: usize = 1024;

/// The number of every vertex's connected component, and how many there are; a vertex without quads is one of its own.
pub(crate) fn components(dual: &Dual) -> (Vec<u32>, usize) {
    let mut sets = Sets::new(dual.vertices.len());
    for quad in &dual.quads {
        quad.vertices[1..]
            .iter()
            .for_each(|&v| sets.join(quad.vertices[0], v));
    }
    sets.numbered()
}

/// Drops quads on an open end with a corner farther from every point than [`RIM`] of their reach, from the end inwards: gaps
/// of the sampling inside of the surface stay closed. Dropped, too, are quads near the end that show the back to the `sensor` of
/// the nearest point ([`Implicit::sensor`]): no sensor sees such, the fit curls there. `edge` is that of the lattice.
///
/// [`Implicit::sensor`]: crate::mesh::Implicit::sensor
pub(crate) fn trim_rims(
    dual: &mut Dual,
    (points, reach): (&[Vec3], &[f32]),
    edge: f64,
    sensor: impl Fn(usize) -> Vec3,
) {
    let vertices = dual.vertices.iter().enumerate();
    let mut ends: Vec<u32> = vertices
        .filter(|(_, vertex)| vertex.quads > 0 && vertex.is_at_end())
        .map(|(v, _)| v as u32)
        .collect();
    if ends.is_empty() {
        return;
    }
    let mut left: Vec<u8> = dual.vertices.iter().map(|vertex| vertex.quads).collect();
    let tree = Octree::build(points);
    let mut found = Vec::new();
    let shows_back = |quad: &Quad| {
        let [a, b, c, d] = quad.vertices.map(|v| dual.vertices[v as usize].position);
        let nearest = tree.nearest((a + b + c + d) * 0.25).index as usize;
        (c - a)
            .cross(d - b)
            .dot(sensor(tree.order[nearest] as usize))
            < 0.0
    };
    let mut is_far = |quad: &Quad| {
        let beyond = |v: u32| {
            let p = dual.vertices[v as usize].position;
            (tree.nearest(p), p)
        };
        let farthest = quad
            .vertices
            .map(beyond)
            .into_iter()
            .max_by(|a, b| a.0.distance2.total_cmp(&b.0.distance2));
        let Some((nearest, p)) = farthest else {
            return false;
        };
        tree.knn(p, AROUND, &mut found);
        let mut reaches: Vec<f32> = found
            .iter()
            .map(|n| reach[tree.order[n.index as usize] as usize])
            .collect();
        reaches.sort_unstable_by(f32::total_cmp);
        let rim = RIM * reaches[reaches.len() / 2];
        nearest.distance2 > rim * rim
    };
    let around = Groups::new(dual.vertices.len(), || {
        let quads = dual.quads.iter().zip(0u32..);
        quads.flat_map(|(quad, q)| quad.vertices.map(|v| (v, q)))
    });
    let mut dropped = vec![false; dual.quads.len()];
    let behind = if (0..points.len()).any(|i| sensor(i) != Vec3::ZERO) {
        BEHIND * f64::from(quantile(reach.to_vec(), 2))
    } else {
        0.0
    };
    let mut depth = 0.0;
    while !ends.is_empty() {
        for end in std::mem::take(&mut ends) {
            for &q in around.of(end) {
                let quad = &dual.quads[q as usize];
                let is_behind = || depth < behind && shows_back(quad);
                if !dropped[q as usize] && (is_behind() || is_far(quad)) {
                    dropped[q as usize] = true;
                    for v in quad.vertices {
                        if left[v as usize] == dual.vertices[v as usize].degree {
                            ends.push(v);
                        }
                        left[v as usize] -= 1;
                    }
                }
            }
        }
        depth += edge;
    }
    let mut dropped = dropped.into_iter();
    dual.retain(|_| dropped.next() == Some(false));
}

/// Drops components that are no part of the surface: those that are the nearest one to fewer than [`LEAST_POINTS`] points
/// (the one with the most points stays), and second layers: pieces with an end that stand for less than [`LAYER_POINTS`] of
/// the points of the largest, and run along a component that is not so. Scans that are not quite registered make such. Returns
/// the share of the points that were nearest to what was dropped.
pub(crate) fn drop_phantoms(dual: &mut Dual, points: &[Vec3], reach: &[f32]) -> f64 {
    let (of, count) = components(dual);
    let used = || {
        let vertices = dual.vertices.iter().zip(&of);
        vertices.filter(|(vertex, _)| vertex.quads > 0)
    };
    let Some((_, first)) = used().next() else {
        return 0.0;
    };
    if used().all(|(_, component)| component == first) {
        return 0.0;
    }
    let (positions, component_of): (Vec<Vec3>, Vec<u32>) = used()
        .map(|(vertex, &component)| (vertex.position, component))
        .unzip();
    let votes = votes(&positions, &component_of, points, count);
    let most = votes.iter().copied().max().unwrap_or(0);
    let least = LEAST_POINTS.min(most);
    let mut has_end = vec![false; count];
    for (vertex, &component) in used() {
        has_end[component as usize] |= vertex.is_at_end();
    }
    let mut dropped: Vec<bool> = votes.iter().map(|&points| points < least).collect();
    let (mut pieces, mut others) = (Vec::new(), Vec::new());
    for (&p, &component) in positions.iter().zip(&component_of) {
        let points = f64::from(votes[component as usize]);
        if has_end[component as usize] && points < LAYER_POINTS * f64::from(most) {
            pieces.push((component, p));
        } else if !dropped[component as usize] {
            others.push(p);
        }
    }
    if !pieces.is_empty() {
        let (others, tree) = (Octree::build(&others), Octree::build(points));
        let away = |(component, p): (u32, Vec3)| {
            let reach = reach[tree.order[tree.nearest(p).index as usize] as usize];
            pack(component, key(others.nearest(p).distance2.sqrt() / reach))
        };
        let mut away: Vec<u64> = pieces.into_iter().map(away).collect();
        away.sort_unstable();
        for piece in away.chunk_by(|a, b| unpack(*a).0 == unpack(*b).0) {
            let (component, median) = unpack(piece[piece.len() / 2]);
            dropped[component as usize] |= of_key(median) < LAYER;
        }
    }
    dual.retain(|quad| !dropped[of[quad.vertices[0] as usize] as usize]);
    let left_out = votes.iter().zip(&dropped).filter(|(_, dropped)| **dropped);
    left_out.map(|(&votes, _)| f64::from(votes)).sum::<f64>() / points.len() as f64
}

/// How many points each of `count` components is the nearest one to.
fn votes(positions: &[Vec3], component_of: &[u32], points: &[Vec3], count: usize) -> Vec<u32> {
    let tree = Octree::build(positions);
    let tasks: Vec<&[Vec3]> = points.chunks(POINTS_PER_TASK).collect();
    let nearest = par::map(
        tasks.len(),
        || (),
        |k, ()| {
            let nearest =
                |&p: &Vec3| component_of[tree.order[tree.nearest(p).index as usize] as usize];
            tasks[k].iter().map(nearest).collect::<Vec<u32>>()
        },
    );
    let mut votes = vec![0u32; count];
    for component in nearest.into_iter().flatten() {
        votes[component as usize] += 1;
    }
    votes
}

/// Gives every fan of quads around a vertex a vertex of its own. With all its quads a vertex has one closed fan; where
/// an open surface left some out there may be several.
pub(crate) fn split_bow_ties(dual: &mut Dual) {
    // Vertices at the surface's end with their quads.
    let mut around = Vec::new();
    for (quad, q) in dual.quads.iter().zip(0u32..) {
        let ends = quad.vertices.into_iter();
        let ends = ends.filter(|&v| dual.vertices[v as usize].is_at_end());
        around.extend(ends.map(|v| pack(v, q)));
    }
    around.sort_unstable();
    for fans in around.chunk_by(|a, b| unpack(*a).0 == unpack(*b).0) {
        let v = unpack(fans[0]).0;
        let quads = fans.iter().map(|&fan| unpack(fan).1);
        let sectors: Vec<Sector> = quads
            .map(|q| Sector::of(v, q, &dual.quads[q as usize]))
            .collect();
        let starts = sectors
            .iter()
            .filter(|a| sectors.iter().all(|b| b.previous != a.next));
        for start in starts.skip(1) {
            let copy = dual.vertices.len() as u32;
            let mut vertex = Vertex {
                quads: 0,
                ..dual.vertices[v as usize]
            };
            let mut member = Some(start);
            while let Some(sector) = member {
                dual.quads[sector.quad].vertices[sector.place] = copy;
                vertex.quads += 1;
                member = sectors.iter().find(|a| a.next == sector.previous);
            }
            dual.vertices[v as usize].quads -= vertex.quads;
            dual.vertices.push(vertex);
        }
    }
}

/// A quad seen from one of its vertices.
struct Sector {
    quad: usize,
    /// Of the vertex in the quad.
    place: usize,
    /// The corners after and before it.
    next: u32,
    previous: u32,
}

impl Sector {
    fn of(v: u32, q: u32, quad: &Quad) -> Sector {
        let corners = quad.vertices;
        let place = corners.iter().position(|&w| w == v).unwrap_or(0);
        Sector {
            quad: q as usize,
            place,
            next: corners[(place + 1) % 4],
            previous: corners[(place + 3) % 4],
        }
    }
}
