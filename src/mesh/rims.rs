//! Smooths the rims of open surfaces, which the lattice leaves in steps.

use crate::base::groups::Groups;
use crate::base::sort_keys::{pack, unpack};
use crate::mesh::surface::Mesh;
use glam::DVec3;

/// Sweeps over the rim. Steps are one or two cells long; each sweep halves what is shorter than about three.
const SWEEPS: usize = 6;
/// A triangle that a move makes worse must keep this area over its summed squared edges (equilateral: 0.14).
const LEAST_QUALITY: f64 = 0.03;

/// Moves vertices of the rim halfway between their neighbours on it, along the surface, as long as no triangle turns by
/// more than 60° or gets thin. `at_end` says which vertices may be on it.
pub(crate) fn smooth(mesh: &mut Mesh, at_end: &[bool]) {
    let rim = rim(mesh, at_end);
    if rim.is_empty() {
        return;
    }
    let is_rim = |v: u32| rim.binary_search_by_key(&v, |r| r.vertex).ok();
    let around: Groups<u32> = Groups::new(rim.len(), || {
        let triangles = mesh.triangles.iter().zip(0u32..);
        let corners = triangles.flat_map(|(corners, t)| corners.map(|v| (v, t)));
        corners.filter_map(|(v, t)| Some((is_rim(v)? as u32, t)))
    });
    let normals: Vec<DVec3> = mesh
        .triangles
        .iter()
        .map(|&t| mesh.cross(t).normalize_or_zero())
        .collect();
    for _ in 0..SWEEPS {
        for (end, triangles) in rim.iter().zip(around.iter()) {
            let v = end.vertex as usize;
            let at = |v: u32| mesh.vertices[v as usize].as_dvec3();
            let (old, normal) = (mesh.vertices[v], mesh.normals[v].as_dvec3());
            let pull = (at(end.previous) + at(end.next)) / 2.0 - at(end.vertex);
            let step = (pull - normal * normal.dot(pull)) / 2.0;
            let worst = |mesh: &Mesh| {
                let rate = |&t: &u32| quality(mesh, t as usize, normals[t as usize]);
                triangles.iter().map(rate).fold(f64::INFINITY, f64::min)
            };
            let before = worst(mesh);
            mesh.vertices[v] = (at(end.vertex) + step).as_vec3();
            if worst(mesh) < before.min(LEAST_QUALITY) {
                mesh.vertices[v] = old;
            }
        }
    }
}

/// A vertex of the rim with its neighbours on it.
struct End {
    vertex: u32,
    previous: u32,
    next: u32,
}

/// The rim's vertices in ascending order. In a manifold mesh each has one boundary edge in and one out.
fn rim(mesh: &Mesh, at_end: &[bool]) -> Vec<End> {
    let edges = |t: &[u32; 3]| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])];
    let mut all: Vec<u64> = mesh
        .triangles
        .iter()
        .flat_map(edges)
        .filter(|&(a, b)| at_end[a as usize] && at_end[b as usize])
        .map(|(a, b)| pack(a, b))
        .collect();
    all.sort_unstable();
    // Inner edges occur in both directions, boundary edges in one.
    let turned = |&edge: &u64| edge.rotate_left(32);
    let is_boundary = |edge: &u64| all.binary_search(&turned(edge)).is_err();
    let leaving: Vec<u64> = all.iter().copied().filter(is_boundary).collect();
    let mut entering: Vec<u64> = leaving.iter().map(turned).collect();
    entering.sort_unstable();
    let ends = leaving.iter().zip(&entering);
    ends.map(|(&leaving, &entering)| {
        let (vertex, next) = unpack(leaving);
        End {
            vertex,
            previous: unpack(entering).1,
            next,
        }
    })
    .collect()
}

/// Area over summed squared edges; negative where the triangle has turned by more than 60° from `normal`.
fn quality(mesh: &Mesh, t: usize, normal: DVec3) -> f64 {
    let [a, b, c] = mesh.triangles[t].map(|v| mesh.vertices[v as usize].as_dvec3());
    let cross = (b - a).cross(c - a);
    let squares = (b - a).length_squared() + (c - b).length_squared() + (a - c).length_squared();
    if cross.dot(normal) > 0.5 * cross.length() {
        cross.length() / (2.0 * squares)
    } else {
        -1.0
    }
}
