//! Fewer triangles where the surface is flat: edges are collapsed by what that costs in distance to the surface.
//!
//! Vertices lie on the zero set and carry its normals. To second order the surface stands over a triangle by the sum
//! over its edges of `κ L² λ λ' / 2` (κ the curvature along the edge, L its length, λ and λ' barycentric coordinates of
//! its ends), and `κ L²` is `Δn · e`, the turn of the normals along the edge. So `area / 24 · Σ |Δn · e|` bounds the
//! volume between triangle and surface, and is that volume where the surface is no saddle: what is lost is known without
//! looking back at the mesh as it was. A vertex is removed by moving it onto a neighbour (a half-edge collapse), so that
//! those that stay are on the zero set as before.
//!
//! 1. Each vertex finds its cheapest collapse that keeps the mesh manifold, well shaped and facing the same way
//!    ([`crate::mesh::collapse`]).
//! 2. The cheapest collapses that do not touch each other are made, and what they touched is looked at again as soon as
//!    it seems cheap.
//!
//! H. Hoppe et al., "Mesh optimization", 1993; M. Garland, P. Heckbert, "Surface simplification using quadric error
//! metrics", 1997, for the order of collapses by a cost that is local.

use crate::base::error::Result;
use crate::base::par;
use crate::base::sort_keys::{key, pack, unpack};
use crate::mesh::collapse::{
    Collapse, Rules, SLIVER_SINE2, Star, VertexTriangles, can_collapse, vertex_triangles,
};
use crate::mesh::surface::Mesh;

/// Curvature that every edge is taken to have on top of its own, as the turn of the normals along one edge of the
/// lattice: it keeps flat parts even. By measurement on four models that the bench does not use: 0.01 and 0.05 change the
/// surface's error by -0.3 % and 0.3 %, and the mean least angle by -1° and 2°.
const BEND: f64 = 0.02;
/// Squared sine of the least angle of new triangles: 15°, and [`SLIVER_SINE2`] once nothing else is left. By measurement on the same models 20° makes the surface 0.2 %
/// worse (1 % without noise), 10° makes it no better.
const LEAST_SINE2: f64 = 0.067;
/// At least one vertex in so many is considered in a sweep, needed or not: the last sweeps would do little else.
const LEAST_SHARE: usize = 64;
/// Vertices that one index of a parallel map takes.
const VERTICES_PER_TASK: usize = 256;
/// Tasks between two progress calls.
const TASKS_PER_SLICE: usize = 128;
/// Collapses between two progress calls.
const COLLAPSES_PER_CALL: usize = 65_536;

/// Collapses edges until at most `most` triangles are left, or none can go that keeps to the rules. Vertices that are
/// `fixed` or on a boundary stay; `edge` is the edge length of the lattice.
pub(crate) fn simplify(
    mesh: &mut Mesh,
    fixed: &[bool],
    most: usize,
    edge: f64,
    progress: &mut dyn FnMut(f32) -> Result<()>,
) -> Result<()> {
    let start = mesh.triangles.len();
    let mut rules = Rules {
        bend: BEND / edge,
        least_sine2: LEAST_SINE2,
    };
    let mut ranking = Ranking::new(fixed);
    while mesh.triangles.len() > most {
        let done = (start - mesh.triangles.len()) as f32 / (start - most) as f32;
        let mut tell = || progress(done);
        let needed = (mesh.triangles.len() - most).div_ceil(2);
        let around = vertex_triangles(mesh);
        let count = needed.max(ranking.out.len() / LEAST_SHARE);
        let stale = ranking.to_look_at(count);
        for slice in stale.chunks(TASKS_PER_SLICE * VERTICES_PER_TASK) {
            tell()?;
            let tasks: Vec<&[u32]> = slice.chunks(VERTICES_PER_TASK).collect();
            let cheapest = |&v: &u32, star: &mut Star| star.cheapest(v, mesh, &around, &rules);
            let found = par::map(tasks.len(), Star::default, |k, star| {
                let found = tasks[k].iter().map(|v| cheapest(v, star));
                found.collect::<Vec<_>>()
            });
            for (&v, found) in slice.iter().zip(found.into_iter().flatten()) {
                ranking.set(v, found);
            }
        }
        let order = ranking.to_collapse(count);
        if order.is_empty() && stale.is_empty() {
            if rules.least_sine2 == SLIVER_SINE2 {
                break;
            }
            rules.least_sine2 = SLIVER_SINE2;
            ranking = Ranking::new(fixed);
        }
        collapse(mesh, &around, &order, needed, &mut ranking, &mut tell)?;
    }
    mesh.drop_unused();
    Ok(())
}

/// Makes up to `needed` of these collapses, in this order, that do not touch each other.
fn collapse(
    mesh: &mut Mesh,
    around: &VertexTriangles,
    order: &[u32],
    needed: usize,
    ranking: &mut Ranking,
    tell: &mut dyn FnMut() -> Result<()>,
) -> Result<()> {
    let mut touched = vec![false; mesh.vertices.len()];
    let mut gone = vec![false; mesh.triangles.len()];
    let mut done = 0;
    for (k, &v) in order.iter().enumerate() {
        if k % COLLAPSES_PER_CALL == 0 {
            tell()?;
        }
        let Some(Collapse { to, .. }) = ranking.known[v as usize] else {
            continue;
        };
        if done == needed || touched[v as usize] || touched[to as usize] {
            continue;
        }
        if !can_collapse(v, to, mesh, around) {
            ranking.stale[v as usize] = true;
            continue;
        }
        for &t in around.of(v) {
            let triangle = &mut mesh.triangles[t as usize];
            gone[t as usize] = triangle.contains(&to);
            for w in triangle {
                touched[*w as usize] = true;
                ranking.stale[*w as usize] = true;
                *w = if *w == v { to } else { *w };
            }
        }
        ranking.out[v as usize] = true;
        done += 1;
    }
    let mut gone = gone.into_iter();
    mesh.triangles.retain(|_| gone.next() == Some(false));
    Ok(())
}

/// What is known of each vertex's collapse.
struct Ranking {
    /// The cheapest, if there is any.
    known: Vec<Option<Collapse>>,
    /// What is known is of before something changed around the vertex: an estimate.
    stale: Vec<bool>,
    /// The vertex stays, or is gone.
    out: Vec<bool>,
}

impl Ranking {
    fn new(fixed: &[bool]) -> Ranking {
        Ranking {
            known: vec![None; fixed.len()],
            stale: vec![true; fixed.len()],
            out: fixed.to_vec(),
        }
    }

    fn set(&mut self, v: u32, found: Option<Collapse>) {
        self.known[v as usize] = found;
        self.stale[v as usize] = false;
    }

    /// What the collapse of a vertex costs, as far as is known, -∞ where nothing is; `None` if there is none.
    fn cost(&self, v: usize) -> Option<f32> {
        match self.known[v] {
            _ if self.out[v] => None,
            Some(known) => Some(known.cost),
            None => self.stale[v].then_some(f32::NEG_INFINITY),
        }
    }

    /// The vertices, stale ones or the others, that are among the `count` cheapest of all, with their costs.
    fn cheap(&self, count: usize, stale: bool) -> impl Iterator<Item = (f32, u32)> {
        let mut costs: Vec<f32> = (0..self.out.len()).filter_map(|v| self.cost(v)).collect();
        let dearest = if count < costs.len() {
            *costs.select_nth_unstable_by(count, f32::total_cmp).1
        } else {
            f32::INFINITY
        };
        let of_kind = (0..self.out.len()).filter(move |&v| self.stale[v] == stale);
        of_kind.filter_map(move |v| Some((self.cost(v).filter(|&c| c <= dearest)?, v as u32)))
    }

    /// Those of which little is known, in ascending order.
    fn to_look_at(&self, count: usize) -> Vec<u32> {
        self.cheap(count, true).map(|c| c.1).collect()
    }

    /// The others, in ascending order of cost.
    fn to_collapse(&self, count: usize) -> Vec<u32> {
        let cheap = self.cheap(count, false);
        let mut sorted: Vec<u64> = cheap.map(|(cost, v)| pack(key(cost), v)).collect();
        sorted.sort_unstable();
        sorted.into_iter().map(|cheap| unpack(cheap).1).collect()
    }
}
