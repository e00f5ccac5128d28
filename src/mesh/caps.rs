//! Membranes over the rims of a mesh.
//!
//! A rim is laid into the plane across it, and filled by a [`Disc`]. The disc's inner vertices take the mean height of their
//! neighbours over the plane: a membrane, flat where the rim is flat.
//!
//! A cap is a disc whatever its rim looks like; where that crosses itself in the plane the disc may, too.

use crate::base::sort_keys::{pack, unpack};
use crate::mesh::disc::Disc;
use crate::mesh::surface::Mesh;
use glam::DVec3;
use std::collections::BTreeMap;

/// Sweeps that settle the heights.
const SWEEPS: usize = 400;
/// The sweeps end when nothing moves by more than this share of the rim's diameter.
const SETTLED: f64 = 1e-7;

/// Largest weight of an edge, and one over the least.
const MOST: f64 = 10.0;

/// A closed loop of boundary edges: its vertices in the order in which the triangles beside it run through them.
pub(crate) type Rim = Vec<u32>;

/// The rims of a manifold mesh, by their least vertex; fewer than three vertices are none.
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
        if rim.len() >= 3 {
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
pub(crate) fn across(at: impl Fn(u32) -> DVec3, rim: &[u32]) -> DVec3 {
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

/// Caps these rims.
pub(crate) fn close(mesh: &mut Mesh, rims: &[Rim]) {
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
        cap(mesh, rim, &taken);
    }
}

/// Caps one rim. `taken` are the edges of the mesh between vertices of rims, sorted.
fn cap(mesh: &mut Mesh, rim: &[u32], taken: &[u64]) {
    let names: Vec<u32> = rim.iter().rev().copied().collect();
    let position = |v: u32| mesh.vertices[v as usize].as_dvec3();
    let normal = across(position, rim).normalize_or(DVec3::Z);
    let u = normal.any_orthonormal_vector();
    let axes = [u, normal.cross(u), normal];
    let outline = names
        .iter()
        .map(|&v| DVec3::from_array(axes.map(|axis| position(v).dot(axis))))
        .collect();
    let is_taken = |a: u32, b: u32| {
        let (a, b) = (names[a as usize], names[b as usize]);
        taken.binary_search(&pack(a.min(b), a.max(b))).is_ok()
    };
    let mut disc = Disc::new(outline, is_taken);
    settle(&mut disc, rim.len());
    let first = mesh.vertices.len() as u32;
    let name = |v: u32| match names.get(v as usize) {
        Some(&name) => name,
        None => first + v - rim.len() as u32,
    };
    let place = |v: u32| {
        let [x, y, z] = disc.at[v as usize].to_array();
        x * axes[0] + y * axes[1] + z * axes[2]
    };
    // New vertices have the mean normals of their triangles.
    let mut normals = vec![DVec3::ZERO; disc.at.len()];
    for &triangle in &disc.triangles {
        let [a, b, c] = triangle.map(place);
        let normal = (b - a).cross(c - a);
        triangle.iter().for_each(|&v| normals[v as usize] += normal);
        mesh.triangles.push(triangle.map(name));
    }
    for (v, normal) in (0..).zip(normals).skip(rim.len()) {
        mesh.vertices.push(place(v).as_vec3());
        mesh.normals.push(normal.normalize_or(axes[2]).as_vec3());
    }
}

/// The membrane, by over-relaxation.
fn settle(disc: &mut Disc<impl Fn(u32, u32) -> bool>, rim: usize) {
    // Half of the cotangents of the angles opposite to each inner edge, in the plane: in a Delaunay triangulation their sums are
    // positive. Where they are not, as a cap crosses itself, a membrane of any weights will do.
    let mut weights: BTreeMap<(u32, u32), f64> = BTreeMap::new();
    for &[a, b, c] in &disc.triangles {
        for (a, b, c) in [(a, b, c), (b, c, a), (c, a, b)] {
            let apex = disc.at[c as usize].truncate();
            let [u, v] = [a, b].map(|v| disc.at[v as usize].truncate() - apex);
            let cotangent = u.dot(v) / u.perp_dot(v).abs().max(f64::MIN_POSITIVE);
            *weights.entry((a.min(b), a.max(b))).or_default() += cotangent.clamp(-MOST, MOST);
        }
    }
    let mut near: Vec<Vec<(u32, f64)>> = vec![Vec::new(); disc.at.len() - rim];
    for ((a, b), weight) in weights {
        for (v, w) in [(a, b), (b, a)] {
            if let Some(near) = (v as usize).checked_sub(rim).map(|v| &mut near[v]) {
                near.push((w, weight.max(1.0 / MOST)));
            }
        }
    }
    let (lo, hi) = disc
        .at
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), &p| {
            (lo.min(p), hi.max(p))
        });
    let settled = SETTLED * lo.distance(hi);
    for _ in 0..SWEEPS {
        let mut most: f64 = 0.0;
        for (v, near) in (rim..).zip(&near) {
            let total = near.iter().map(|(_, weight)| weight).sum::<f64>();
            let height = near
                .iter()
                .map(|&(w, weight)| weight * disc.at[w as usize].z);
            let step = height.sum::<f64>() / total - disc.at[v].z;
            disc.at[v].z += 1.5 * step;
            most = most.max(step.abs());
        }
        if most < settled {
            break;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::topology::{topology, volume};
    use glam::{DVec2, Vec3};

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
            assert!((v.z - saddle).abs() < 0.01, "{v} {saddle}");
        }
    }

    #[test]
    fn a_rim_that_crosses_itself_gets_a_disc_near_it() {
        // A figure of eight in the plane, which passes over itself.
        let n = 200;
        let at = |i: usize| {
            let angle = std::f64::consts::TAU * i as f64 / n as f64;
            0.3 * DVec2::new(libm::sin(angle), libm::sin(2.0 * angle))
        };
        let outline: Vec<DVec2> = (0..n).map(at).collect();
        let height = |i: usize| 0.2 + 0.1 * libm::cos(std::f64::consts::TAU * i as f64 / n as f64);
        let mesh = closed(wall(&outline, height));
        let (lo, hi) = (Vec3::new(-0.31, -0.31, -0.01), Vec3::new(0.31, 0.31, 0.31));
        assert!(
            mesh.vertices
                .iter()
                .all(|v| v.cmpge(lo).all() && v.cmple(hi).all())
        );
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
