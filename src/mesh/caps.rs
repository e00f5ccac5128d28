//! Membranes over the rims of a mesh.
//!
//! 1. A rim is laid into the plane across it and cut into triangles by its ears (G. H. Meisters, "Polygons have ears", 1975).
//! 2. Vertices are put into large triangles, wider apart the farther in, and edges are flipped until the triangles are as
//!    equal-angled as they get (P. Liepa, "Filling holes in meshes", 2003).
//! 3. The new vertices take the mean height of their neighbours over the plane: a membrane, flat where the rim is flat.
//!
//! A cap is a disc whatever its rim looks like; where that crosses itself in the plane the disc may, too.

use crate::base::lists::{pack, unpack};
use crate::mesh::Mesh;
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;

/// New vertices are this many times as far apart as those around them.
const GROWTH: f64 = 1.5;
/// Rounds of new vertices: each has about the [`GROWTH`]-th part of a half fewer. And of flips in each.
const ROUNDS: usize = 24;
/// Sweeps that settle the heights.
const SWEEPS: usize = 400;
/// The sweeps end when nothing moves by more than this share of the rim's diameter.
const SETTLED: f64 = 1e-7;

/// A closed loop of boundary edges: its vertices in the order in which the triangles beside it run through them.
pub(crate) type Rim = Vec<u32>;

/// The rims of a manifold mesh, by their least vertex.
pub(crate) fn rims(mesh: &Mesh) -> Vec<Rim> {
    let mut next: Vec<u32> = vec![u32::MAX; mesh.vertices.len()];
    let mut edges: Vec<u64> = edges(mesh).collect();
    edges.sort_unstable();
    let is_inner = |edge: u64| edges.binary_search(&edge.rotate_left(32)).is_ok();
    for &edge in edges.iter().filter(|&&edge| !is_inner(edge)) {
        let (from, to) = unpack(edge);
        next[from as usize] = to;
    }
    let mut rims = Vec::new();
    for start in 0..next.len() {
        let (mut rim, mut v) = (Rim::new(), start as u32);
        while next[v as usize] != u32::MAX {
            rim.push(v);
            v = std::mem::replace(&mut next[v as usize], u32::MAX);
        }
        if !rim.is_empty() {
            rims.push(rim);
        }
    }
    rims
}

fn edges(mesh: &Mesh) -> impl Iterator<Item = u64> {
    let all = mesh.triangles.iter();
    all.flat_map(|&[a, b, c]| [pack(a, b), pack(b, c), pack(c, a)])
}

/// Twice the area that a rim encloses, across it: along the normal of what would close it.
fn across(at: impl Fn(u32) -> DVec3, rim: &[u32]) -> DVec3 {
    let first = at(rim[0]);
    let pairs = rim.windows(2).map(|pair| (pair[0], pair[1]));
    pairs
        .map(|(a, b)| (at(b) - first).cross(at(a) - first))
        .sum()
}

/// Diameter of the disc whose area a rim encloses.
pub(crate) fn diameter(mesh: &Mesh, rim: &[u32]) -> f64 {
    let at = |v: u32| mesh.vertices[v as usize].as_dvec3();
    2.0 * (across(at, rim).length() / 2.0 / std::f64::consts::PI).sqrt()
}

/// Caps these rims, and returns the share of the area that the caps have.
pub(crate) fn close(mesh: &mut Mesh, rims: &[Rim]) -> f64 {
    let before = crate::report::area(&mesh.vertices, &mesh.triangles);
    let mut taken: Vec<u64> = Vec::new();
    let mut on_rim = vec![false; mesh.vertices.len()];
    rims.iter()
        .flatten()
        .for_each(|&v| on_rim[v as usize] = true);
    for edge in edges(mesh) {
        let (a, b) = unpack(edge);
        if on_rim[a as usize] && on_rim[b as usize] {
            taken.push(pack(a.min(b), a.max(b)));
        }
    }
    taken.sort_unstable();
    for rim in rims {
        let mut cap = Cap::new(mesh, rim, &taken);
        cap.refine();
        cap.settle();
        cap.add_to(mesh, rim);
    }
    let area = crate::report::area(&mesh.vertices, &mesh.triangles);
    if area > 0.0 { 1.0 - before / area } else { 0.0 }
}

/// A disc of triangles. The first vertices are the rim's, in the order in which the disc runs through them.
struct Cap<'a> {
    /// Two coordinates in the plane, and the height over it.
    at: Vec<DVec3>,
    axes: [DVec3; 3],
    /// Wanted distance of a vertex from its neighbours.
    size: Vec<f64>,
    rim: usize,
    /// The mesh's vertex of each of the rim's.
    names: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    /// The triangles beside each inner edge, lesser vertex first.
    beside: BTreeMap<(u32, u32), [u32; 2]>,
    /// Edges of the mesh between vertices of rims.
    taken: &'a [u64],
}

impl<'a> Cap<'a> {
    fn new(mesh: &Mesh, rim: &[u32], taken: &'a [u64]) -> Cap<'a> {
        let names: Vec<u32> = rim.iter().rev().copied().collect();
        let position = |v: u32| mesh.vertices[v as usize].as_dvec3();
        let normal = across(position, rim).normalize_or(DVec3::Z);
        let u = normal.any_orthonormal_vector();
        let axes = [u, normal.cross(u), normal];
        let at: Vec<DVec3> = names
            .iter()
            .map(|&v| DVec3::from_array(axes.map(|axis| position(v).dot(axis))))
            .collect();
        let n = at.len();
        let size = (0..n)
            .map(|i| (at[i].distance(at[(i + 1) % n]) + at[i].distance(at[(i + n - 1) % n])) / 2.0)
            .collect();
        let mut cap = Cap {
            triangles: ears(&at),
            rim: n,
            at,
            axes,
            size,
            names,
            beside: BTreeMap::new(),
            taken,
        };
        for t in 0..cap.triangles.len() as u32 {
            cap.enter(t);
        }
        cap.beside.retain(|_, sides| sides[1] != u32::MAX);
        cap
    }

    /// Enters a triangle beside its edges, while they are gathered.
    fn enter(&mut self, t: u32) {
        for (a, b) in sides(self.triangles[t as usize]) {
            let entry = self.beside.entry((a.min(b), a.max(b)));
            let sides = entry.or_insert([u32::MAX; 2]);
            sides[usize::from(sides[0] != u32::MAX)] = t;
        }
    }

    /// Puts `new` where `old` was beside an edge, if that is an inner one.
    fn replace(&mut self, a: u32, b: u32, old: u32, new: u32) {
        if let Some(sides) = self.beside.get_mut(&(a.min(b), a.max(b))) {
            let place = usize::from(sides[1] == old);
            sides[place] = new;
        }
    }

    fn add(&mut self, p: DVec3, size: f64) -> u32 {
        self.at.push(p);
        self.size.push(size);
        self.at.len() as u32 - 1
    }

    /// Step 2.
    fn refine(&mut self) {
        self.flip();
        if self.rim == 3 {
            // The mesh may have this very triangle.
            self.cut(0);
        }
        for _ in 0..ROUNDS {
            let before = self.triangles.len();
            for t in 0..before {
                let corners = self.triangles[t];
                let [a, b, c] = corners.map(|v| self.at[v as usize]);
                let middle = (a + b + c) / 3.0;
                let size = corners.iter().map(|&v| self.size[v as usize]).sum::<f64>() / 3.0;
                let far = |p: DVec3| (p - middle).truncate().length() > GROWTH * size;
                if far(a) && far(b) && far(c) {
                    self.cut(t);
                }
            }
            if self.triangles.len() == before {
                break;
            }
            self.flip();
        }
        // No edge that the mesh has already.
        let twice: Vec<(u32, u32)> = self.beside.keys().copied().collect();
        for (a, b) in twice {
            if self.is_taken(a, b) {
                self.split(a, b);
            }
        }
    }

    fn is_taken(&self, a: u32, b: u32) -> bool {
        let name = |v: u32| self.names.get(v as usize).copied();
        let (Some(a), Some(b)) = (name(a), name(b)) else {
            return false;
        };
        self.taken.binary_search(&pack(a.min(b), a.max(b))).is_ok()
    }

    /// Puts a vertex into the middle of a triangle.
    fn cut(&mut self, t: usize) {
        let [a, b, c] = self.triangles[t];
        let corners = [a, b, c];
        let middle = corners.iter().map(|&v| self.at[v as usize]).sum::<DVec3>() / 3.0;
        let size = corners.iter().map(|&v| self.size[v as usize]).sum::<f64>() / 3.0;
        let v = self.add(middle, GROWTH * size);
        let (first, second, third) = (
            t as u32,
            self.triangles.len() as u32,
            self.triangles.len() as u32 + 1,
        );
        self.triangles[t] = [a, b, v];
        self.triangles.extend([[b, c, v], [c, a, v]]);
        self.replace(b, c, first, second);
        self.replace(c, a, first, third);
        self.beside.insert((b, v), [first, second]);
        self.beside.insert((c, v), [second, third]);
        self.beside.insert((a, v), [third, first]);
    }

    /// Puts a vertex into the middle of an inner edge.
    fn split(&mut self, a: u32, b: u32) {
        let Some([s, t]) = self.beside.remove(&(a, b)) else {
            return;
        };
        let (c, d) = (self.opposite(s, a, b), self.opposite(t, a, b));
        let middle = (self.at[a as usize] + self.at[b as usize]) / 2.0;
        let v = self.add(middle, self.size[a as usize]);
        let count = self.triangles.len() as u32;
        for (old, new, apex) in [(s, count, c), (t, count + 1, d)] {
            let corners = self.triangles[old as usize];
            let with = |from: u32| corners.map(|w| if w == from { v } else { w });
            self.triangles.push(with(a));
            self.triangles[old as usize] = with(b);
            self.replace(b, apex, old, new);
            self.beside.insert((apex.min(v), apex.max(v)), [old, new]);
        }
        self.beside.insert((a, v), [s, t]);
        self.beside.insert((b, v), [count, count + 1]);
    }

    fn opposite(&self, t: u32, a: u32, b: u32) -> u32 {
        let corners = self.triangles[t as usize];
        corners.into_iter().find(|&v| v != a && v != b).unwrap_or(a)
    }

    /// Turns edges whose opposite angles are together more than half a turn, in the plane.
    fn flip(&mut self) {
        for _ in 0..ROUNDS {
            let edges: Vec<(u32, u32)> = self.beside.keys().copied().collect();
            let turned = edges.into_iter().filter(|&(a, b)| self.turn(a, b)).count();
            if turned == 0 {
                break;
            }
        }
    }

    fn turn(&mut self, a: u32, b: u32) -> bool {
        let Some(&[s, t]) = self.beside.get(&(a, b)) else {
            return false;
        };
        // s runs from `from` to `to`, t back.
        let runs = sides(self.triangles[s as usize]).contains(&(a, b));
        let (from, to) = if runs { (a, b) } else { (b, a) };
        let (c, d) = (self.opposite(s, a, b), self.opposite(t, a, b));
        let at = |v: u32| self.at[v as usize].truncate();
        let (p, q, r, w) = (at(from), at(to), at(c), at(d));
        // The sine of the sum of the opposite angles.
        let angle = |apex: DVec2| {
            let (u, v) = (p - apex, q - apex);
            let length = (u.length() * v.length()).max(f64::MIN_POSITIVE);
            (u.perp_dot(v).abs() / length, u.dot(v) / length)
        };
        let (r_angle, w_angle) = (angle(r), angle(w));
        let wide = r_angle.0 * w_angle.1 + r_angle.1 * w_angle.0 < -1e-6;
        let area = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a);
        let convex = area(w, q, r) > 0.0 && area(r, p, w) > 0.0;
        let new = (c.min(d), c.max(d));
        let exists = c == d || self.beside.contains_key(&new) || self.is_side(c, d);
        if !(wide && convex) || exists || self.is_taken(c, d) {
            return false;
        }
        self.beside.remove(&(a, b));
        self.triangles[s as usize] = [d, to, c];
        self.triangles[t as usize] = [c, from, d];
        self.replace(to, d, t, s);
        self.replace(from, c, s, t);
        self.beside.insert(new, [s, t]);
        true
    }

    /// Whether two vertices are neighbours on the rim.
    fn is_side(&self, a: u32, b: u32) -> bool {
        let (n, apart) = (self.rim as u32, a.abs_diff(b));
        a < n && b < n && (apart == 1 || apart == n - 1)
    }

    /// Step 3, by over-relaxation.
    fn settle(&mut self) {
        let mut near: Vec<Vec<u32>> = vec![Vec::new(); self.at.len() - self.rim];
        for &(a, b) in self.beside.keys() {
            for (v, w) in [(a, b), (b, a)] {
                if let Some(near) = (v as usize).checked_sub(self.rim).map(|v| &mut near[v]) {
                    near.push(w);
                }
            }
        }
        let (lo, hi) = self
            .at
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), &p| {
                (lo.min(p), hi.max(p))
            });
        let settled = SETTLED * lo.distance(hi);
        for _ in 0..SWEEPS {
            let mut most: f64 = 0.0;
            for (v, near) in (self.rim..).zip(&near) {
                let height = near.iter().map(|&w| self.at[w as usize].z).sum::<f64>();
                let step = height / near.len() as f64 - self.at[v].z;
                self.at[v].z += 1.5 * step;
                most = most.max(step.abs());
            }
            if most < settled {
                break;
            }
        }
    }

    /// The cap becomes part of the mesh, its new vertices with the mean normals of their triangles.
    fn add_to(self, mesh: &mut Mesh, rim: &[u32]) {
        let first = mesh.vertices.len() as u32;
        let name = |v: u32| match self.names.get(v as usize) {
            Some(&name) => name,
            None => first + v - rim.len() as u32,
        };
        let mut normals = vec![DVec3::ZERO; self.at.len()];
        let place = |v: u32| {
            let [x, y, z] = self.at[v as usize].to_array();
            x * self.axes[0] + y * self.axes[1] + z * self.axes[2]
        };
        for &triangle in &self.triangles {
            let [a, b, c] = triangle.map(place);
            let normal = (b - a).cross(c - a);
            triangle.iter().for_each(|&v| normals[v as usize] += normal);
            mesh.triangles.push(triangle.map(name));
        }
        for v in self.rim..self.at.len() {
            mesh.vertices.push(place(v as u32).as_vec3());
            mesh.normals
                .push(normals[v].normalize_or(self.axes[2]).as_vec3());
        }
    }
}

fn sides([a, b, c]: [u32; 3]) -> [(u32, u32); 3] {
    [(a, b), (b, c), (c, a)]
}

/// Step 1: the triangles of a polygon that runs counter-clockwise in the plane of the first two coordinates. Where it has no
/// ear, as it crosses itself, the corner that turns the most goes.
fn ears(at: &[DVec3]) -> Vec<[u32; 3]> {
    let n = at.len();
    let p = |v: u32| at[v as usize].truncate();
    let turn = |a: u32, b: u32, c: u32| (p(b) - p(a)).perp_dot(p(c) - p(b));
    let mut left: Vec<u32> = (0..n as u32).collect();
    let mut triangles = Vec::with_capacity(n - 2);
    let mut k = 0;
    while left.len() > 3 {
        let count = left.len();
        let around = |k: usize| {
            let before = left[(k + count - 1) % count];
            (before, left[k % count], left[(k + 1) % count])
        };
        // A corner that lies in another's ear is a reflex one.
        let reflex: Vec<u32> = (0..count)
            .map(around)
            .filter(|&(a, b, c)| turn(a, b, c) <= 0.0)
            .map(|(_, b, _)| b)
            .collect();
        let is_ear = |&(a, b, c): &(u32, u32, u32)| {
            let inside = |&v: &u32| {
                let inner = |a: u32, b: u32| (p(b) - p(a)).perp_dot(p(v) - p(a)) >= 0.0;
                v != a && v != b && v != c && inner(a, b) && inner(b, c) && inner(c, a)
            };
            turn(a, b, c) > 0.0 && !reflex.iter().any(inside)
        };
        let found = (0..count)
            .map(|step| (k + step) % count)
            .find(|&k| is_ear(&around(k)));
        let ear = found.unwrap_or_else(|| {
            let turn = |k: &usize| {
                let (a, b, c) = around(*k);
                turn(a, b, c)
            };
            let most = (0..count).max_by(|a, b| turn(a).total_cmp(&turn(b)).then(b.cmp(a)));
            most.unwrap_or(0)
        });
        let (a, b, c) = around(ear);
        triangles.push([a, b, c]);
        left.remove(ear);
        // The next ear is looked for two corners on, so that they do not make a fan.
        k = (ear + 1) % left.len();
    }
    triangles.push([left[0], left[1], left[2]]);
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{topology, volume};
    use glam::Vec3;

    /// A wall of two rows of triangles over an outline, which runs counter-clockwise seen from above; `height` says where its
    /// upper rim is.
    fn wall(outline: &[DVec2], height: impl Fn(usize) -> f64) -> Mesh {
        let n = outline.len() as u32;
        let mut mesh = Mesh::default();
        for row in 0..3u32 {
            for (i, p) in outline.iter().enumerate() {
                let z = height(i) * f64::from(row) / 2.0;
                mesh.vertices.push(p.extend(z).as_vec3());
            }
        }
        mesh.normals = vec![Vec3::Z; mesh.vertices.len()];
        for (row, i) in (0..2).flat_map(|row| (0..n).map(move |i| (row, i))) {
            let at = |row: u32, i: u32| row * n + i % n;
            let (a, b, c, d) = (
                at(row, i),
                at(row, i + 1),
                at(row + 1, i + 1),
                at(row + 1, i),
            );
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
        mesh
    }

    fn ring(n: usize, radius: impl Fn(f64) -> f64) -> Vec<DVec2> {
        let at = |i: usize| {
            let angle = std::f64::consts::TAU * i as f64 / n as f64;
            radius(angle) * DVec2::new(libm::cos(angle), libm::sin(angle))
        };
        (0..n).map(at).collect()
    }

    fn area(outline: &[DVec2]) -> f64 {
        let n = outline.len();
        (0..n)
            .map(|i| outline[i].perp_dot(outline[(i + 1) % n]) / 2.0)
            .sum()
    }

    fn closed(mut mesh: Mesh) -> Mesh {
        let rims = rims(&mesh);
        close(&mut mesh, &rims);
        let found = topology(&mesh.triangles, mesh.vertices.len());
        assert!(
            found.is_manifold() && found.boundary_edges == 0,
            "{found:?}"
        );
        assert_eq!((found.components, &found.genus[..]), (1, &[0][..]));
        mesh
    }

    #[test]
    fn flat_rims_of_any_outline_get_flat_caps() {
        let comb: Vec<DVec2> = (0..20)
            .map(|i| {
                DVec2::new(
                    f64::from(i / 2) / 10.0,
                    if i / 2 % 2 == i % 2 { 0.1 } else { 0.4 },
                )
            })
            .chain((0..10).rev().map(|i| DVec2::new(f64::from(i) / 10.0, 0.5)))
            .collect();
        let comb: Vec<DVec2> = comb.into_iter().rev().collect();
        let comb = if area(&comb) < 0.0 {
            comb.into_iter().rev().collect()
        } else {
            comb
        };
        for outline in [
            ring(100, |_| 0.3),
            ring(90, |a| 0.3 + 0.15 * libm::sin(5.0 * a)),
            ring(3, |_| 0.3),
            ring(4, |_| 0.3),
            comb,
        ] {
            let mesh = wall(&outline, |_| 0.2);
            let first = mesh.vertices.len();
            let rims = rims(&mesh);
            assert_eq!(rims.len(), 2);
            let wide = 2.0 * (area(&outline) / std::f64::consts::PI).sqrt();
            assert!((diameter(&mesh, &rims[0]) / wide - 1.0).abs() < 1e-3);
            let mesh = closed(mesh);
            let inside = volume(&mesh.vertices, &mesh.triangles);
            assert!((inside / (0.2 * area(&outline)) - 1.0).abs() < 1e-4);
            let on_a_rim = |v: &Vec3| v.z.abs() < 1e-6 || (v.z - 0.2).abs() < 1e-6;
            assert!(mesh.vertices[first..].iter().all(on_a_rim));
        }
    }

    #[test]
    fn a_wavy_rim_gets_a_membrane() {
        let n = 120;
        let wave =
            |i: usize| 0.3 + 0.05 * libm::cos(2.0 * std::f64::consts::TAU * i as f64 / n as f64);
        let mesh = wall(&ring(n, |_| 0.3), wave);
        let first = mesh.vertices.len();
        let mesh = closed(mesh);
        // The harmonic height of this rim is a saddle, 0.05 (r/0.3)² cos 2φ.
        let lid = || mesh.vertices[first..].iter().filter(|v| v.z > 0.1);
        assert!(lid().count() > 20);
        for v in lid().map(|v| v.as_dvec3()) {
            let saddle = 0.3 + 0.05 * (v.x * v.x - v.y * v.y) / 0.09;
            assert!((v.z - saddle).abs() < 0.006, "{v} {saddle}");
        }
    }

    #[test]
    fn a_triangle_alone_becomes_a_cushion_of_its_own_sides() {
        let mut mesh = Mesh {
            vertices: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            normals: vec![Vec3::Z; 3],
            triangles: vec![[0, 1, 2]],
        };
        let all = rims(&mesh);
        close(&mut mesh, &all);
        let found = topology(&mesh.triangles, mesh.vertices.len());
        assert!(
            found.is_manifold() && found.boundary_edges == 0,
            "{found:?}"
        );
    }

    #[test]
    fn a_strip_keeps_its_chords_to_itself() {
        // Every edge across it joins two vertices of its rim.
        let n = 12;
        let mut mesh = Mesh::default();
        for i in 0..n {
            let x = f64::from(i) / 10.0;
            mesh.vertices
                .push(DVec3::new(x, f64::from(i % 2) / 5.0, 0.3 * x * x).as_vec3());
        }
        mesh.normals = vec![Vec3::Z; n as usize];
        for i in 0..n as u32 - 2 {
            mesh.triangles.push(if i % 2 == 0 {
                [i, i + 2, i + 1]
            } else {
                [i, i + 1, i + 2]
            });
        }
        closed(mesh);
    }
}
