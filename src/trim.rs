//! What is kept of the dual mesh: holes closed or not, no sheets that no point supports, one fan around each vertex.
//!
//! Every step only leaves out quads, so edges keep at most two; [`split_bow_ties`] then sees to the vertices.

use crate::dual::{Dual, Quad, Vertex};
use crate::extract::MOST_FILLED;
use crate::octree::Octree;
use crate::orient::SMALLEST;
use crate::par;
use crate::params::Boundary;
use crate::report::Sets;
use glam::Vec3;

/// An open surface ends within this share of a point's reach of it. Reaches are some 2.2 spacings, so that is 1.3, and what
/// the rim is smoothed by stays within 1.5.
const RIM: f32 = 0.6;
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

/// Components with what a decision about them rests on.
struct Component {
    area: f64,
    filled: f64,
    has_boundary: bool,
}

/// Drops the filled quads of the components that are better left open, and components that are nothing but filling.
pub(crate) fn decide_holes(dual: &mut Dual, boundary: Boundary) {
    let (mut roots, components) = measure(dual);
    dual.quads.retain(|quad| {
        let component = &components[roots.find(quad.vertices[0]) as usize];
        let share = component.filled / component.area;
        let is_unclosed = component.has_boundary || share > MOST_FILLED;
        !quad.filled || share < 1.0 && !(boundary == Boundary::Auto && is_unclosed)
    });
}

/// Connected components, by the vertex that stands for them.
fn measure(dual: &Dual) -> (Sets, Vec<Component>) {
    let mut roots = components(dual);
    let none = || Component {
        area: 0.0,
        filled: 0.0,
        has_boundary: false,
    };
    let mut components: Vec<Component> = dual.vertices.iter().map(|_| none()).collect();
    for quad in &dual.quads {
        let component = &mut components[roots.find(quad.vertices[0]) as usize];
        let area = quad_area(quad, &dual.vertices);
        component.area += area;
        component.filled += if quad.filled { area } else { 0.0 };
    }
    for (v, degree) in degrees(dual).into_iter().enumerate() {
        let component = &mut components[roots.find(v as u32) as usize];
        component.has_boundary |= degree < dual.vertices[v].degree;
    }
    (roots, components)
}

fn components(dual: &Dual) -> Sets {
    let mut roots = Sets::new(dual.vertices.len());
    for quad in &dual.quads {
        quad.vertices[1..]
            .iter()
            .for_each(|&v| roots.join(quad.vertices[0], v));
    }
    roots
}

fn quad_area(quad: &Quad, vertices: &[Vertex]) -> f64 {
    let [p, q, r, s] = quad
        .vertices
        .map(|v| vertices[v as usize].position.as_dvec3());
    ((q - p).cross(r - p).length() + (r - p).cross(s - p).length()) / 2.0
}

/// Quads around each vertex.
pub(crate) fn degrees(dual: &Dual) -> Vec<u8> {
    let mut degrees = vec![0; dual.vertices.len()];
    dual.quads
        .iter()
        .flat_map(|q| q.vertices)
        .for_each(|v| degrees[v as usize] += 1);
    degrees
}

/// What [`decide_holes`] left: share of the area that is filled, components that were closed, components that are open.
pub(crate) fn summarise(dual: &Dual) -> (f64, usize, usize) {
    let (_, components) = measure(dual);
    let there: Vec<&Component> = components.iter().filter(|c| c.area > 0.0).collect();
    let (area, filled) = there
        .iter()
        .fold((0.0, 0.0), |s, c| (s.0 + c.area, s.1 + c.filled));
    let closed = there
        .iter()
        .filter(|c| c.filled > 0.0 && !c.has_boundary)
        .count();
    let open = there.iter().filter(|c| c.has_boundary).count();
    (if area > 0.0 { filled / area } else { 0.0 }, closed, open)
}

/// Drops quads on an open end with a corner farther from every point than [`RIM`] of their reach, from the end inwards: gaps
/// of the sampling inside of the surface stay closed.
pub(crate) fn trim_rims(dual: &mut Dual, points: &[Vec3], reach: &[f32]) {
    let mut degree = degrees(dual);
    let is_end = |v: u32, degree: &[u8]| degree[v as usize] < dual.vertices[v as usize].degree;
    let mut ends: Vec<u32> = (0..dual.vertices.len() as u32)
        .filter(|&v| degree[v as usize] > 0 && is_end(v, &degree))
        .collect();
    if ends.is_empty() {
        return;
    }
    let tree = Octree::build(points);
    let mut found = Vec::new();
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
    let around = quads_around(dual);
    let mut dropped = vec![false; dual.quads.len()];
    while let Some(end) = ends.pop() {
        for &q in around.of(end) {
            if !dropped[q as usize] && is_far(&dual.quads[q as usize]) {
                dropped[q as usize] = true;
                for v in dual.quads[q as usize].vertices {
                    if !is_end(v, &degree) {
                        ends.push(v);
                    }
                    degree[v as usize] -= 1;
                }
            }
        }
    }
    let mut dropped = dropped.into_iter();
    dual.quads.retain(|_| dropped.next() == Some(false));
}

/// Lists of quads by vertex.
struct Around {
    start: Vec<u32>,
    quads: Vec<u32>,
}

impl Around {
    fn of(&self, v: u32) -> &[u32] {
        &self.quads[self.start[v as usize] as usize..self.start[v as usize + 1] as usize]
    }
}

fn quads_around(dual: &Dual) -> Around {
    let mut start = vec![0u32];
    start.extend(degrees(dual).iter().scan(0u32, |sum, &d| {
        *sum += d as u32;
        Some(*sum)
    }));
    let mut next = start.clone();
    let mut quads = vec![0; 4 * dual.quads.len()];
    for (i, quad) in dual.quads.iter().enumerate() {
        for v in quad.vertices {
            quads[next[v as usize] as usize] = i as u32;
            next[v as usize] += 1;
        }
    }
    Around { start, quads }
}

/// Drops components that are no part of the surface: those that are the nearest one to fewer than [`LEAST_POINTS`] points
/// (the one with the most points stays), and second layers: pieces with an end that stand for less than [`LAYER_POINTS`] of
/// the points of the largest, and run along a component that is not so. Scans that are not quite registered make such.
pub(crate) fn drop_phantoms(dual: &mut Dual, points: &[Vec3], reach: &[f32]) {
    let mut roots = components(dual);
    let degree = degrees(dual);
    let used: Vec<u32> = (0..degree.len() as u32)
        .filter(|&v| degree[v as usize] > 0)
        .collect();
    let Some(&first) = used.first() else { return };
    let root_of: Vec<u32> = used.iter().map(|&v| roots.find(v)).collect();
    if root_of.iter().all(|&r| r == roots.find(first)) {
        return;
    }
    let position = |&v: &u32| dual.vertices[v as usize].position;
    let positions: Vec<Vec3> = used.iter().map(position).collect();
    let votes = votes(&positions, &root_of, points, dual.vertices.len());
    let most = votes.iter().copied().max().unwrap_or(0);
    let least = LEAST_POINTS.min(most);
    let mut has_end = vec![false; votes.len()];
    for (&v, &root) in used.iter().zip(&root_of) {
        has_end[root as usize] |= degree[v as usize] < dual.vertices[v as usize].degree;
    }
    let mut dropped: Vec<bool> = votes.iter().map(|&points| points < least).collect();
    let (mut pieces, mut others) = (Vec::new(), Vec::new());
    for (&p, &root) in positions.iter().zip(&root_of) {
        let points = f64::from(votes[root as usize]);
        if has_end[root as usize] && points < LAYER_POINTS * f64::from(most) {
            pieces.push((root, p));
        } else if !dropped[root as usize] {
            others.push(p);
        }
    }
    if !pieces.is_empty() {
        let (others, tree) = (Octree::build(&others), Octree::build(points));
        let away = |(root, p): (u32, Vec3)| {
            let reach = reach[tree.order[tree.nearest(p).index as usize] as usize];
            (root, others.nearest(p).distance2.sqrt() / reach)
        };
        let mut away: Vec<(u32, f32)> = pieces.into_iter().map(away).collect();
        away.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        for piece in away.chunk_by(|a, b| a.0 == b.0) {
            let (root, median) = piece[piece.len() / 2];
            dropped[root as usize] |= median < LAYER;
        }
    }
    dual.quads
        .retain(|quad| !dropped[roots.find(quad.vertices[0]) as usize]);
}

/// How many points each component is the nearest one to, by the vertex that stands for it.
fn votes(positions: &[Vec3], root_of: &[u32], points: &[Vec3], vertices: usize) -> Vec<u32> {
    let tree = Octree::build(positions);
    let tasks: Vec<&[Vec3]> = points.chunks(POINTS_PER_TASK).collect();
    let nearest = par::map(
        tasks.len(),
        || (),
        |k, ()| {
            let root = |&p: &Vec3| root_of[tree.order[tree.nearest(p).index as usize] as usize];
            tasks[k].iter().map(root).collect::<Vec<u32>>()
        },
    );
    let mut votes = vec![0u32; vertices];
    for root in nearest.into_iter().flatten() {
        votes[root as usize] += 1;
    }
    votes
}

/// Gives every fan of quads around a vertex a vertex of its own. With all its quads a vertex has one closed fan; where
/// an open surface left some out there may be several.
pub(crate) fn split_bow_ties(dual: &mut Dual) {
    let degrees = degrees(dual);
    let is_at_end = |v: u32| degrees[v as usize] < dual.vertices[v as usize].degree;
    // (vertex, next corner, previous corner, quad, place there) of the quads around vertices at the surface's end.
    let mut around = Vec::new();
    for (i, quad) in dual.quads.iter().enumerate() {
        let corner = |k: usize| quad.vertices[k % 4];
        for k in (0..4).filter(|&k| is_at_end(corner(k))) {
            around.push((corner(k), corner(k + 1), corner(k + 3), i, k));
        }
    }
    around.sort_unstable();
    for fans in around.chunk_by(|a, b| a.0 == b.0) {
        let starts = fans.iter().filter(|a| fans.iter().all(|b| b.2 != a.1));
        for start in starts.skip(1) {
            let copy = dual.vertices.len() as u32;
            dual.vertices.push(dual.vertices[start.0 as usize]);
            let mut member = Some(start);
            while let Some(&(_, _, previous, quad, k)) = member {
                dual.quads[quad].vertices[k] = copy;
                member = fans.iter().find(|a| a.1 == previous);
            }
        }
    }
}
