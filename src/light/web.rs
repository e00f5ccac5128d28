//! A mesh whose edges can be collapsed one by one: triangles, and of each vertex those around it.

use crate::mesh::Mesh;
use glam::DVec3;

/// No edge is collapsed whose ends have more triangles than this: a fan so wide makes each look around it dear.
const WIDEST: usize = 96;

/// What new triangles must keep to.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rules {
    /// Least cosine between the normals of a triangle before and after.
    pub(crate) facing: f64,
    /// Least squared sine of a triangle's least angle, unless one around was worse before.
    pub(crate) sine2: f64,
}

pub(crate) struct Web {
    pub(crate) at: Vec<DVec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// The triangles of each vertex, in no order; none of one that is gone.
    pub(crate) around: Vec<Vec<u32>>,
    /// On an edge of one triangle.
    pub(crate) border: Vec<bool>,
    /// On an edge of three triangles or more, in more than one fan, or in a very wide one: stays as it is.
    pub(crate) locked: Vec<bool>,
    /// Triangles that are left.
    pub(crate) left: usize,
    /// Where a vertex was met last, see [`Web::neighbours`].
    met: Vec<u32>,
    mark: u32,
}

impl Web {
    pub(crate) fn new(mesh: &Mesh) -> Web {
        let mut around = vec![Vec::new(); mesh.vertices.len()];
        for (triangle, t) in mesh.triangles.iter().zip(0u32..) {
            triangle.iter().for_each(|&v| around[v as usize].push(t));
        }
        let mut web = Web {
            at: mesh.vertices.iter().map(|v| v.as_dvec3()).collect(),
            triangles: mesh.triangles.clone(),
            border: vec![false; around.len()],
            locked: vec![false; around.len()],
            left: mesh.triangles.len(),
            met: vec![0; around.len()],
            mark: 0,
            around,
        };
        for v in 0..web.around.len() as u32 {
            let (border, locked) = web.kind(v);
            (web.border[v as usize], web.locked[v as usize]) = (border, locked);
        }
        web
    }

    /// Whether a vertex is on a border, and whether it is not inside or on the border of one sheet.
    fn kind(&self, v: u32) -> (bool, bool) {
        if self.around[v as usize].len() > WIDEST {
            return (false, true);
        }
        let sides: Vec<[u32; 2]> = self.sides(v).collect();
        let (mut ends, mut many) = (0, false);
        for w in sides.as_flattened() {
            let [out, back] = [0, 1].map(|k| sides.iter().filter(|s| s[k] == *w).count());
            many |= out > 1 || back > 1;
            ends += usize::from(out + back == 1);
        }
        // One fan: going on from side to side meets all of them.
        let first = sides.iter().find(|s| sides.iter().all(|r| r[1] != s[0]));
        let Some(&start) = first.or(sides.first()) else {
            return (false, false);
        };
        let (mut reached, mut last) = (1, start[1]);
        while let Some(next) = sides.iter().find(|s| s[0] == last && last != start[0]) {
            (reached, last) = (reached + 1, next[1]);
            if reached > sides.len() {
                break;
            }
        }
        (ends > 0, many || ends > 2 || reached != sides.len())
    }

    /// The opposite sides of the triangles of `v`, in their direction.
    fn sides(&self, v: u32) -> impl Iterator<Item = [u32; 2]> {
        let triangles = self.around[v as usize].iter();
        triangles.map(move |&t| others(self.triangles[t as usize], v))
    }

    /// The triangles of an edge.
    pub(crate) fn of_edge(&self, [a, b]: [u32; 2]) -> impl Iterator<Item = u32> {
        let triangles = self.around[a as usize].iter().copied();
        triangles.filter(move |&t| self.triangles[t as usize].contains(&b))
    }

    /// The vertices that share an edge with `v`, each once, in ascending order.
    pub(crate) fn neighbours(&self, v: u32, into: &mut Vec<u32>) {
        into.clear();
        into.extend(self.sides(v).flatten());
        into.sort_unstable();
        into.dedup();
    }

    /// The link condition (T. Dey et al., "Topology preserving edge contraction", 1999), borders taken as edges to one more
    /// vertex: the mesh stays of the same topology.
    pub(crate) fn keeps_topology(&mut self, edge: [u32; 2]) -> bool {
        let [a, b] = edge.map(|v| v as usize);
        if self.locked[a] || self.locked[b] {
            return false;
        }
        let triangles = self.of_edge(edge).count();
        let inner = triangles == 2;
        if triangles == 0 || triangles > 2 {
            return false;
        }
        if inner && self.border[a] && self.border[b]
            || self.around[a].len() + self.around[b].len() > WIDEST
        {
            return false;
        }
        self.mark += 2;
        let mark = self.mark;
        for k in 0..self.around[a].len() {
            let triangle = self.triangles[self.around[a][k] as usize];
            triangle.iter().for_each(|&v| self.met[v as usize] = mark);
        }
        // Neighbours in common are met at `a`, then counted once at `b`.
        let mut common = 0;
        for k in 0..self.around[b].len() {
            for v in self.triangles[self.around[b][k] as usize] {
                let new = self.met[v as usize] == mark && !edge.contains(&v);
                common += usize::from(new);
                if new {
                    self.met[v as usize] = mark + 1;
                }
            }
        }
        if common != triangles {
            return false;
        }
        // An edge of both links: two triangles over it that are sides of a tetrahedron, or a border of three edges.
        let has = |[p, q]: [u32; 2]| self.sides(edge[1]).any(|s| s == [q, p] || s == [p, q]);
        if self.sides(edge[0]).any(|s| !s.contains(&edge[1]) && has(s)) {
            return false;
        }
        let is_border = |e: [u32; 2]| self.of_edge(e).count() == 1;
        let third = |w: u32| is_border([edge[0], w]) && is_border([edge[1], w]);
        let opposite = self
            .of_edge(edge)
            .map(|t| third_of(self.triangles[t as usize], edge));
        !opposite.into_iter().any(third)
    }

    /// The triangles that stay when `edge` is collapsed to a place, as they were and as they would be.
    pub(crate) fn moved(
        &self,
        edge: [u32; 2],
        to: DVec3,
    ) -> impl Iterator<Item = ([DVec3; 3], [DVec3; 3])> {
        let around = edge
            .into_iter()
            .flat_map(|v| self.around[v as usize].iter());
        around.filter_map(move |&t| {
            let corners = self.triangles[t as usize];
            let moves = corners.map(|v| edge.contains(&v));
            if moves.iter().filter(|m| **m).count() == 2 {
                return None;
            }
            let before = corners.map(|v| self.at[v as usize]);
            let after = [0, 1, 2].map(|k| if moves[k] { to } else { before[k] });
            Some((before, after))
        })
    }

    /// Whether the triangles that a collapse leaves keep to the rules.
    pub(crate) fn keeps_shape(&self, edge: [u32; 2], to: DVec3, rules: &Rules) -> bool {
        let mut worst_before = f64::INFINITY;
        let mut worst_after = f64::INFINITY;
        for (before, after) in self.moved(edge, to) {
            let (old, new) = (cross(before), cross(after));
            let length = new.length();
            if length == 0.0 || old.dot(new) < rules.facing * old.length() * length {
                return false;
            }
            worst_before = worst_before.min(sine2(before));
            worst_after = worst_after.min(sine2(after));
        }
        worst_after >= rules.sine2.min(worst_before)
    }

    /// Moves the ends of an edge to one place, the first end; its triangles go.
    pub(crate) fn collapse(&mut self, edge: [u32; 2], to: DVec3) {
        let [a, b] = edge;
        let gone: Vec<u32> = self.of_edge(edge).collect();
        for &t in &gone {
            for v in self.triangles[t as usize] {
                self.around[v as usize].retain(|&other| other != t);
            }
        }
        self.left -= gone.len();
        for t in std::mem::take(&mut self.around[b as usize]) {
            for v in &mut self.triangles[t as usize] {
                *v = if *v == b { a } else { *v };
            }
            self.around[a as usize].push(t);
        }
        self.at[a as usize] = to;
        self.border[a as usize] |= self.border[b as usize];
    }

    /// The triangles that are left, of vertices that are left, in their order.
    pub(crate) fn into_mesh(self) -> Mesh {
        let used = |v: &usize| !self.around[*v].is_empty();
        let mut index = vec![u32::MAX; self.at.len()];
        let mut mesh = Mesh::default();
        for v in (0..self.at.len()).filter(used) {
            index[v] = mesh.vertices.len() as u32;
            mesh.vertices.push(self.at[v].as_vec3());
        }
        let mut seen = vec![false; self.triangles.len()];
        for &t in self.around.iter().flatten() {
            seen[t as usize] = true;
        }
        let stays = self.triangles.iter().zip(seen).filter(|(_, seen)| *seen);
        mesh.triangles = stays.map(|(t, _)| t.map(|v| index[v as usize])).collect();
        mesh
    }
}

/// Normal of a triangle, as long as twice its area.
pub(crate) fn cross([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// Squared sine of a triangle's least angle: that between its two longest sides.
pub(crate) fn sine2([a, b, c]: [DVec3; 3]) -> f64 {
    let [p, q, r] = [b - a, c - b, a - c].map(DVec3::length_squared);
    let longest = p.max(q) * p.min(q).max(r);
    cross([a, b, c]).length_squared() / longest.max(f64::MIN_POSITIVE)
}

/// The two other corners of a triangle of `v`, in its order.
fn others([a, b, c]: [u32; 3], v: u32) -> [u32; 2] {
    match v {
        _ if v == a => [b, c],
        _ if v == b => [c, a],
        _ => [a, b],
    }
}

/// The corner of a triangle that is not on an edge.
fn third_of(triangle: [u32; 3], edge: [u32; 2]) -> u32 {
    let third = triangle.into_iter().find(|v| !edge.contains(v));
    third.unwrap_or(triangle[0])
}
