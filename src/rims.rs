//! Smooth ends of open surfaces: the lattice leaves them in steps.

use crate::extract::Mesh;
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
    let mut around: Vec<(u32, u32)> = Vec::new();
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        around.extend(
            triangle
                .iter()
                .filter_map(|&v| Some((is_rim(v)? as u32, t as u32))),
        );
    }
    around.sort_unstable();
    let lists: Vec<&[(u32, u32)]> = around.chunk_by(|a, b| a.0 == b.0).collect();
    let normals: Vec<DVec3> = mesh
        .triangles
        .iter()
        .map(|&t| cross(mesh, t).normalize_or_zero())
        .collect();
    for _ in 0..SWEEPS {
        for (end, list) in rim.iter().zip(&lists) {
            let v = end.vertex as usize;
            let at = |v: u32| mesh.vertices[v as usize].as_dvec3();
            let (old, normal) = (mesh.vertices[v], mesh.normals[v].as_dvec3());
            let pull = (at(end.previous) + at(end.next)) / 2.0 - at(end.vertex);
            let step = (pull - normal * normal.dot(pull)) / 2.0;
            let worst = |mesh: &Mesh| {
                let rate = |&(_, t): &(u32, u32)| quality(mesh, t as usize, normals[t as usize]);
                list.iter().map(rate).fold(f64::INFINITY, f64::min)
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
    // Inner edges occur in both directions, boundary edges in one.
    let mut sorted: Vec<(u32, u32, bool)> = mesh
        .triangles
        .iter()
        .flat_map(edges)
        .filter(|&(a, b)| at_end[a as usize] && at_end[b as usize])
        .map(|(a, b)| (a.min(b), a.max(b), a < b))
        .collect();
    sorted.sort_unstable();
    let boundary = sorted
        .chunk_by(|a, b| (a.0, a.1) == (b.0, b.1))
        .filter(|group| group.len() == 1);
    let directed = boundary.map(|group| {
        if group[0].2 {
            (group[0].0, group[0].1)
        } else {
            (group[0].1, group[0].0)
        }
    });
    let mut leaving: Vec<(u32, u32)> = directed.collect();
    let mut entering: Vec<(u32, u32)> = leaving.iter().map(|&(a, b)| (b, a)).collect();
    leaving.sort_unstable();
    entering.sort_unstable();
    let ends = leaving.iter().zip(&entering);
    ends.map(|(&(vertex, next), &(_, previous))| End {
        vertex,
        previous,
        next,
    })
    .collect()
}

fn cross(mesh: &Mesh, triangle: [u32; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(|v| mesh.vertices[v as usize].as_dvec3());
    (b - a).cross(c - a)
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
