//! Edges collapsed in the order of what they cost, until as few triangles are left as asked for.
//!
//! 1. The planes of a vertex's triangles, weighted by their areas, make its quadric; planes upright on borders hold those.
//! 2. An edge's two vertices become one where the sum `Q` of their quadrics is least, on the border where one of them is there.
//!    With `W`, the sum of the areas, `Q / W` is the mean squared distance to the planes. The cost `Q √(Q / W)` lies between the two:
//!    by measurement it gives the least mean distance, and smaller largest ones than `Q`.
//! 3. Each vertex keeps the places of a few that became one with it, those that the mesh left farthest behind: **witnesses**. A
//!    collapse costs at least what its farthest one says, so that a thin spike is not lost for having little area.
//! 4. The cheapest edge that keeps topology and shape goes first. What was refused is looked at again each time a quarter
//!    of the triangles are gone, and once nothing else is left with less asked of shapes.
//!
//! M. Garland, P. Heckbert, "Surface simplification using quadric error metrics", 1997.

use super::quadric::Quadric;
use super::web::{Rules, Web, cross};
use crate::base::error::Result;
use crate::mesh::Mesh;
use crate::report::distance::closest_on_triangle;
use glam::DVec3;
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// Rules one after the other: normals within 78° and least angles of 4°, then no triangle turned over.
const RULES: [Rules; 2] = [
    Rules {
        facing: 0.2,
        sine2: 0.005,
    },
    Rules {
        facing: 0.0,
        sine2: 0.0,
    },
];
/// Weight of a border's upright planes, in squared lengths of its edges.
const BORDER: f64 = 4.0;
/// Squared edge lengths count for so much beside squared distances: flat parts stay even.
const EVEN: f64 = 1e-6;
/// Places farther from an edge's middle than so many of its lengths are not taken.
const REACH: f64 = 1.5;
/// Witnesses that a vertex keeps.
const WITNESSES: usize = 4;
/// The farthest witness's squared distance counts for so much beside the mean squared distance. By measurement on three models, from
/// 0 to 0.4 the largest distance falls by a tenth to two thirds and the mean stays; 1 makes a third of them worse again.
const FARTHEST: f64 = 0.4;
/// The queue is made anew when so much is left of the triangles that there were.
const RENEW: f64 = 0.75;
/// Edges looked at between two progress calls.
const PER_CALL: usize = 4096;

/// Collapses edges until at most `most` triangles are left, or every other collapse costs more than `farthest`: a distance from the
/// planes of the triangles that were there (root mean square).
pub(crate) fn shrink(
    mesh: &Mesh,
    most: usize,
    farthest: f64,
    progress: &mut dyn FnMut(f32) -> Result<()>,
) -> Result<Mesh> {
    let web = Web::new(mesh);
    let mut work = Work {
        quadrics: quadrics(&web),
        witnesses: web.at.iter().map(|&at| vec![at]).collect(),
        web,
    };
    let start = work.web.left;
    let (mut rules, mut looked) = (0, 0);
    while work.web.left > most && rules < RULES.len() {
        let before = work.web.left;
        let again = ((before as f64 * RENEW) as usize).max(most);
        let mut queue = Queue::of(&work, farthest);
        while work.web.left > again
            && let Some(next) = queue.pop()
        {
            if looked % PER_CALL == 0 {
                progress((start - work.web.left) as f32 / (start - most) as f32)?;
            }
            looked += 1;
            work.collapse(&next, &RULES[rules], &mut queue);
        }
        if work.web.left == before {
            rules += 1;
        }
    }
    Ok(work.web.into_mesh())
}

/// The mesh with what is known of its vertices.
struct Work {
    web: Web,
    quadrics: Vec<Quadric>,
    witnesses: Vec<Vec<DVec3>>,
}

impl Work {
    /// Makes this collapse, or says to the queue how else or at which cost, or leaves it.
    fn collapse(&mut self, next: &Next, rules: &Rules, queue: &mut Queue) {
        let (edge, way) = (next.edge, next.way);
        let Some((_, to)) = self.place(edge, way) else {
            return;
        };
        if !self.web.keeps_topology(edge) {
            return;
        }
        if !self.web.keeps_shape(edge, to, rules) {
            if !way.simple {
                let simple = Way {
                    simple: true,
                    seen: false,
                };
                queue.push(edge, simple, 0.0, self);
            }
            return;
        }
        let seen = self.witnesses_after(edge, to);
        let least = FARTHEST * self.weight(edge) * seen.first().map_or(0.0, |(far2, _)| *far2);
        if !way.seen && least > next.sum {
            queue.push(edge, Way { seen: true, ..way }, least, self);
            return;
        }
        self.web.collapse(edge, to);
        let [a, b] = edge.map(|v| v as usize);
        let gone = self.quadrics[b];
        self.quadrics[a].add(&gone);
        self.witnesses[b] = Vec::new();
        self.witnesses[a] = seen.into_iter().take(WITNESSES).map(|(_, at)| at).collect();
        queue.changed(edge);
        let mut near = Vec::new();
        self.web.neighbours(edge[0], &mut near);
        for &other in &near {
            queue.push([edge[0], other], Way::default(), 0.0, self);
        }
    }

    fn weight(&self, edge: [u32; 2]) -> f64 {
        edge.iter().map(|&v| self.quadrics[v as usize].weight).sum()
    }

    /// The witnesses of an edge with their squared distances from the triangles that a collapse leaves, the farthest first.
    fn witnesses_after(&self, edge: [u32; 2], to: DVec3) -> Vec<(f64, DVec3)> {
        let after: Vec<[DVec3; 3]> = self.web.moved(edge, to).map(|moved| moved.1).collect();
        let far = |&at: &DVec3| {
            let distances = after
                .iter()
                .map(|&t| at.distance_squared(closest_on_triangle(at, t)));
            (distances.fold(f64::INFINITY, f64::min), at)
        };
        let witnesses = edge.iter().flat_map(|&v| &self.witnesses[v as usize]);
        let mut seen: Vec<(f64, DVec3)> = witnesses.map(far).collect();
        seen.sort_by(|a, b| b.0.total_cmp(&a.0));
        seen
    }

    /// The sum of squared distances that a collapse leaves, and where it leads.
    fn place(&self, [a, b]: [u32; 2], way: Way) -> Option<(f64, DVec3)> {
        let web = &self.web;
        let [p, q] = [a, b].map(|v| web.at[v as usize]);
        let mut sum = self.quadrics[a as usize];
        sum.add(&self.quadrics[b as usize]);
        let even = EVEN * sum.weight * p.distance_squared(q);
        let middle = (p + q) / 2.0;
        let with_sum = |at: DVec3| (sum.at(at) + even, at);
        let is_near =
            |at: &DVec3| at.distance_squared(middle) <= REACH * REACH * p.distance_squared(q);
        let found = match (web.border[a as usize], web.border[b as usize]) {
            (true, false) => with_sum(p),
            (false, true) => with_sum(q),
            _ => match sum.least(middle).filter(|at| !way.simple && is_near(at)) {
                Some(least) => with_sum(least),
                None => [p, q]
                    .map(with_sum)
                    .into_iter()
                    .fold(with_sum(middle), |best, found| {
                        if found.0 < best.0 { found } else { best }
                    }),
            },
        };
        found.0.is_finite().then_some(found)
    }
}

/// The quadric of each vertex.
fn quadrics(web: &Web) -> Vec<Quadric> {
    let mut quadrics = vec![Quadric::default(); web.at.len()];
    for &triangle in &web.triangles {
        let corners = triangle.map(|v| web.at[v as usize]);
        let cross = cross(corners);
        let twice = cross.length();
        if twice == 0.0 {
            continue;
        }
        let normal = cross / twice;
        let plane = Quadric::plane(corners[0], normal, twice / 2.0);
        triangle
            .iter()
            .for_each(|&v| quadrics[v as usize].add(&plane));
        for k in 0..3 {
            let edge = [triangle[k], triangle[(k + 1) % 3]];
            let is_border = edge.iter().all(|&v| web.border[v as usize]);
            if is_border && web.of_edge(edge).count() == 1 {
                let along = corners[(k + 1) % 3] - corners[k];
                let upright = along.cross(normal).normalize_or_zero();
                let plane = Quadric::plane(corners[k], upright, BORDER * along.length_squared());
                edge.iter().for_each(|&v| quadrics[v as usize].add(&plane));
            }
        }
    }
    quadrics
}

/// How a collapse is made.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Way {
    /// To the middle or an end, not to where the quadrics say.
    simple: bool,
    /// Its witnesses were looked at: its cost holds.
    seen: bool,
}

/// An edge to collapse.
struct Next {
    cost: f64,
    /// The sum of squared distances that the cost is made of.
    sum: f64,
    edge: [u32; 2],
    way: Way,
    /// Changes of both ends when it was put here: with other ones it is of the past.
    changes: u32,
}

impl Ord for Next {
    fn cmp(&self, other: &Next) -> Ordering {
        let key = |next: &Next| (next.edge, next.way);
        self.cost
            .total_cmp(&other.cost)
            .then_with(|| key(self).cmp(&key(other)))
    }
}

impl PartialOrd for Next {
    fn partial_cmp(&self, other: &Next) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Next {
    fn eq(&self, other: &Next) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Next {}

/// Edges, the cheapest first.
struct Queue {
    heap: BinaryHeap<Reverse<Next>>,
    /// How often each vertex changed.
    changes: Vec<u32>,
    farthest2: f64,
}

impl Queue {
    /// All edges.
    fn of(work: &Work, farthest: f64) -> Queue {
        let count = work.web.at.len();
        let mut queue = Queue {
            heap: BinaryHeap::new(),
            changes: vec![0; count],
            farthest2: farthest * farthest,
        };
        let mut near = Vec::new();
        for a in 0..count as u32 {
            work.web.neighbours(a, &mut near);
            for &b in near.iter().filter(|&&b| b > a) {
                queue.push([a, b], Way::default(), 0.0, work);
            }
        }
        queue
    }

    /// An edge whose sum of squared distances is not taken for less than `least`.
    fn push(&mut self, edge: [u32; 2], way: Way, least: f64, work: &Work) {
        let Some((sum, _)) = work.place(edge, way) else {
            return;
        };
        let (sum, weight) = (sum.max(least), work.weight(edge));
        if sum <= self.farthest2 * weight {
            let cost = sum * (sum / weight.max(f64::MIN_POSITIVE)).sqrt();
            let [a, b] = edge.map(|v| self.changes[v as usize]);
            let changes = a + b;
            self.heap.push(Reverse(Next {
                cost,
                sum,
                edge,
                way,
                changes,
            }));
        }
    }

    fn pop(&mut self) -> Option<Next> {
        loop {
            let Reverse(next) = self.heap.pop()?;
            let [a, b] = next.edge.map(|v| self.changes[v as usize]);
            if a + b == next.changes {
                return Some(next);
            }
        }
    }

    /// The first end of an edge changed, and the other is gone.
    fn changed(&mut self, edge: [u32; 2]) {
        edge.iter().for_each(|&v| self.changes[v as usize] += 1);
    }
}
