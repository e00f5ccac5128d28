//! One half-edge collapse: what it costs, and whether it may be made.

use crate::base::groups::Groups;
use crate::mesh::surface::Mesh;
use glam::DVec3;

/// A new triangle's normal is within 45° of that of the one it replaces (cosine).
const TURNED: f64 = 0.7;
/// No edge is folded by more than 120° (cosine), unless it was more before.
const FOLDED: f64 = -0.5;

/// What collapses must keep to.
#[derive(Clone, Copy)]
pub(crate) struct Rules {
    /// Curvature that every edge is taken to have on top of its own: what keeps flat parts even.
    pub(crate) bend: f64,
    /// Squared sine of the least angle of a new triangle, unless an old one around the vertex has a smaller one.
    pub(crate) least_sine2: f64,
}

/// A vertex's move onto its neighbour `to`.
#[derive(Clone, Copy)]
pub(crate) struct Collapse {
    /// 24 times the volume that it adds between the triangles and the surface.
    pub(crate) cost: f32,
    pub(crate) to: u32,
}

/// The triangles of every vertex.
pub(crate) type VertexTriangles = Groups<u32>;

pub(crate) fn vertex_triangles(mesh: &Mesh) -> VertexTriangles {
    Groups::new(mesh.vertices.len(), || {
        let triangles = mesh.triangles.iter().zip(0u32..);
        triangles.flat_map(|(corners, t)| corners.map(|v| (v, t)))
    })
}

/// The link condition (Hoppe et al., 1993) for a vertex `v` inside of the surface: it has just the two neighbours in
/// common with `to` whose triangles go, and if it has but three triangles, they are not the sides of a tetrahedron.
pub(crate) fn can_collapse(v: u32, to: u32, mesh: &Mesh, around: &VertexTriangles) -> bool {
    let triangle = |&t: &u32| mesh.triangles[t as usize];
    let list = around.of(v);
    let ring = || list.iter().map(|t| others(triangle(t), v));
    // A neighbour of the inner vertex v is once the first of a triangle's others; of a vertex on a boundary, one is not.
    let meets = |w: u32| around.of(to).iter().any(|t| triangle(t).contains(&w));
    let common = ring().filter(|r| r[0] != to && meets(r[0])).count();
    let is_face = |[a, b]: [u32; 2]| {
        let has_both = |t: [u32; 3]| t.contains(&a) && t.contains(&b);
        a != to && b != to && around.of(to).iter().any(|t| has_both(triangle(t)))
    };
    common == 2 && !(list.len() == 3 && ring().any(is_face))
}

/// The two other corners of a triangle of `v`, in its order.
fn others(triangle: [u32; 3], v: u32) -> [u32; 2] {
    let [a, b, c] = triangle;
    match v {
        _ if v == a => [b, c],
        _ if v == b => [c, a],
        _ => [a, b],
    }
}

/// A neighbour of a vertex, with the edge from it to the next one.
#[derive(Clone, Copy)]
struct Corner {
    vertex: u32,
    position: DVec3,
    normal: DVec3,
    /// [`bend`] of the edge to the next corner.
    bend: f64,
    /// Unit normal of the triangle over that edge.
    face: DVec3,
    /// No collapse goes there.
    refused: bool,
}

/// The triangles around a vertex; the memory of one worker.
#[derive(Default)]
pub(crate) struct Star {
    sides: Vec<[u32; 2]>,
    /// The neighbours in order, counter-clockwise seen from outside.
    ring: Vec<Corner>,
}

impl Star {
    /// The cheapest collapse of `v` that may be made; none of a vertex on a boundary.
    pub(crate) fn cheapest(
        &mut self,
        v: u32,
        mesh: &Mesh,
        around: &VertexTriangles,
        rules: &Rules,
    ) -> Option<Collapse> {
        let (before, worst) = self.read(v, mesh, around, rules)?;
        let rules = Rules {
            least_sine2: rules.least_sine2.min(worst),
            ..*rules
        };
        loop {
            let (mut after, mut best) = (f64::INFINITY, None);
            for k in (0..self.ring.len()).filter(|&k| !self.ring[k].refused) {
                if let Some(cost) = self.fan_cost(k, after, &rules) {
                    (after, best) = (cost, Some(k));
                }
            }
            let (k, cost) = (best?, after - before);
            let to = self.ring[k].vertex;
            if can_collapse(v, to, mesh, around) && !self.folds(k, mesh, around) {
                let cost = cost as f32;
                return Some(Collapse { cost, to });
            }
            self.ring[k].refused = true;
        }
    }

    /// Whether a collapse onto corner `to` folds an edge: one of the new ones, or one of the ring.
    fn folds(&self, to: usize, mesh: &Mesh, around: &VertexTriangles) -> bool {
        let n = self.ring.len();
        let corner = |k: usize| &self.ring[(to + k) % n];
        let inside = |k: usize| {
            let [a, b, c] = [corner(0), corner(k), corner(k + 1)].map(|c| c.position);
            (b - a).cross(c - a)
        };
        let mut inner = inside(1);
        for k in 0..n {
            let last = inner;
            inner = inside(k.clamp(1, n - 2));
            if cosine_if_negative(last, inner) < FOLDED {
                return true;
            }
            let [a, b] = [corner(k).vertex, corner(k + 1).vertex];
            let is_beyond = |t: &&u32| others(mesh.triangles[**t as usize], a)[1] == b;
            let Some(&beyond) = around.of(a).iter().find(is_beyond) else {
                continue;
            };
            let [p, q, r] =
                mesh.triangles[beyond as usize].map(|w| mesh.vertices[w as usize].as_dvec3());
            let outer = (q - p).cross(r - p);
            let after = cosine_if_negative(outer, inner);
            if after < FOLDED && after < cosine_if_negative(outer, corner(k).face) {
                return true;
            }
        }
        false
    }

    /// Puts the ring of `v` in order. Returns what its triangles cost, and the squared sine of their least angle.
    fn read(
        &mut self,
        v: u32,
        mesh: &Mesh,
        around: &VertexTriangles,
        rules: &Rules,
    ) -> Option<(f64, f64)> {
        let at = |w: u32| mesh.vertices[w as usize].as_dvec3();
        let normal = |w: u32| mesh.normals[w as usize].as_dvec3();
        self.sides.clear();
        let sides = around
            .of(v)
            .iter()
            .map(|&t| others(mesh.triangles[t as usize], v));
        self.sides.extend(sides);
        self.ring.clear();
        let mut next = self.sides.first()?[0];
        while self.ring.len() < self.sides.len() {
            self.ring.push(Corner {
                vertex: next,
                position: at(next),
                normal: normal(next),
                bend: 0.0,
                face: DVec3::ZERO,
                refused: false,
            });
            next = self.sides.iter().find(|s| s[0] == next)?[1];
        }
        if next != self.ring[0].vertex || self.ring.len() < 3 {
            return None;
        }
        let (position, n) = (at(v), self.ring.len());
        let spoke = |c: &Corner| bend(c.position - position, c.normal - normal(v), rules);
        let mut spokes = spoke(&self.ring[0]);
        let (mut cost, mut worst) = (0.0, f64::INFINITY);
        for k in 0..n {
            let end = self.ring[(k + 1) % n];
            let corner = &mut self.ring[k];
            corner.bend = bend(
                end.position - corner.position,
                end.normal - corner.normal,
                rules,
            );
            let triangle = Shape::of([position, corner.position, end.position]);
            let twice = triangle.cross.length();
            corner.face = triangle.cross / twice.max(f64::MIN_POSITIVE);
            let following = spoke(&end);
            cost += twice * (spokes + corner.bend + following);
            worst = worst.min(twice * twice / triangle.longest2.max(f64::MIN_POSITIVE));
            spokes = following;
        }
        Some((cost / 2.0, worst))
    }

    /// What the triangles cost that a collapse onto corner `to` leaves, if that is less than `most` and they are allowed.
    fn fan_cost(&self, to: usize, most: f64, rules: &Rules) -> Option<f64> {
        let (before, from) = self.ring.split_at(to);
        let (apex, rest) = from.split_first()?;
        let mut corners = rest.iter().chain(before);
        let mut a = corners.next()?;
        let (mut twice_cost, mut spoke) = (0.0, apex.bend);
        for b in corners {
            let triangle = Shape::of([apex.position, a.position, b.position]);
            let square = triangle.cross.length_squared();
            let twice = square.sqrt();
            let facing = triangle.cross.dot(a.face);
            if square < rules.least_sine2 * triangle.longest2 || facing < TURNED * twice {
                return None;
            }
            let following = bend(b.position - apex.position, b.normal - apex.normal, rules);
            twice_cost += twice * (spoke + a.bend + following);
            if twice_cost >= 2.0 * most {
                return None;
            }
            (a, spoke) = (b, following);
        }
        Some(twice_cost / 2.0)
    }
}

/// `κ L²` of an edge `along` which the normals turn by `turn`, see [`mod@crate::mesh::simplify`].
fn bend(along: DVec3, turn: DVec3, rules: &Rules) -> f64 {
    along.dot(turn).abs() + rules.bend * along.length_squared()
}

/// The cosine between two vectors; 0 if it is positive, which takes no root.
fn cosine_if_negative(a: DVec3, b: DVec3) -> f64 {
    let dot = a.dot(b);
    if dot < 0.0 {
        dot / (a.length_squared() * b.length_squared()).sqrt()
    } else {
        0.0
    }
}

/// Squared sine of the least angle under which a triangle is a sliver: 5°.
pub(crate) const SLIVER_SINE2: f64 = 0.0076;

/// What tells whether a triangle is well shaped.
pub(crate) struct Shape {
    /// Normal, as long as twice the area.
    pub(crate) cross: DVec3,
    /// Product of the squares of the two longest sides: the least angle is between them, and its squared sine is
    /// `cross² / longest2`.
    longest2: f64,
}

impl Shape {
    pub(crate) fn of([a, b, c]: [DVec3; 3]) -> Shape {
        let [p, q, r] = [b - a, c - b, a - c].map(DVec3::length_squared);
        Shape {
            cross: (b - a).cross(c - a),
            longest2: p.max(q) * p.min(q).max(r),
        }
    }

    /// Squared sine of the least angle.
    pub(crate) fn sine2(&self) -> f64 {
        self.cross.length_squared() / self.longest2.max(f64::MIN_POSITIVE)
    }
}
