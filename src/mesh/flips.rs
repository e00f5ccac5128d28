//! Edges that lead across a crease are flipped to lie along it, between two vertices on it (L. P. Kobbelt et al., "Feature
//! sensitive surface extraction from volume data", 2001, section 4).

use crate::mesh::collapse::{SLIVER_SINE2, Shape, VertexTriangles};
use crate::mesh::surface::Mesh;
use std::collections::BTreeSet;

/// Normals of both ends of an edge across a crease differ by more (cosine of 25°).
const ACROSS: f32 = 0.906;
/// A new triangle looks the way of its vertex that is on no crease to this cosine: 45°. Its least angle is 5° ([`SLIVER_SINE2`]).
const FACING: f64 = 0.7;
/// Flips them.
pub(crate) fn flip(mesh: &mut Mesh, around: &VertexTriangles, on_crease: &[bool]) {
    let mut touched = vec![false; mesh.triangles.len()];
    let mut joined: BTreeSet<[u32; 2]> = BTreeSet::new();
    let free = |v: u32| !on_crease[v as usize];
    // Fewer than three triangles are no fan.
    let count = |v: usize| around.of(v as u32).len();
    let mut degree: Vec<usize> = (0..mesh.vertices.len()).map(count).collect();
    for t in 0..mesh.triangles.len() {
        let corners = mesh.triangles[t];
        let Some(k) = (0..3).find(|&k| !free(corners[k])) else {
            continue;
        };
        let [r, a, b] = [0, 1, 2].map(|j| corners[(k + j) % 3]);
        if touched[t] || !free(a) || !free(b) {
            continue;
        }
        let [n, m] = [a, b].map(|v| mesh.normals[v as usize]);
        let is_beyond = |&u: &u32| {
            let other = mesh.triangles[u as usize];
            u as usize != t && other.contains(&a) && other.contains(&b)
        };
        let Some(beyond) = around.of(a).iter().copied().find(is_beyond) else {
            continue;
        };
        let mut opposite = mesh.triangles[beyond as usize].into_iter();
        let Some(s) = opposite.rfind(|&v| v != a && v != b) else {
            continue;
        };
        let has_s = |&u: &u32| mesh.triangles[u as usize].contains(&s);
        let pair = [r.min(s), r.max(s)];
        if n.dot(m) >= ACROSS
            || touched[beyond as usize]
            || free(s)
            || around.of(r).iter().any(has_s)
            || joined.contains(&pair)
            || degree[a as usize].min(degree[b as usize]) <= 3
        {
            continue;
        }
        // Both run around as before: r a b and b a s become r a s and r s b.
        let new = [[r, a, s], [r, s, b]];
        let good = [(new[0], n), (new[1], m)]
            .into_iter()
            .all(|(triangle, normal)| {
                let shape = Shape::of(triangle.map(|v| mesh.vertices[v as usize].as_dvec3()));
                shape.cross.dot(normal.as_dvec3()) >= FACING * shape.cross.length()
                    && shape.sine2() >= SLIVER_SINE2
            });
        if good {
            [mesh.triangles[t], mesh.triangles[beyond as usize]] = new;
            touched[t] = true;
            touched[beyond as usize] = true;
            joined.insert(pair);
            degree[a as usize] -= 1;
            degree[b as usize] -= 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::collapse::vertex_triangles;
    use glam::Vec3;

    #[test]
    fn an_edge_across_a_crease_lies_along_it() {
        // A roof: the ridge along y from 0 to 1, a vertex on either side of it half way, and the eaves.
        let side = |x: f32| Vec3::new(x, 0.0, 1.0).normalize();
        let mut mesh = Mesh {
            vertices: vec![
                Vec3::ZERO,
                Vec3::new(-1.0, 0.5, -1.0),
                Vec3::new(1.0, 0.5, -1.0),
                Vec3::Y,
                Vec3::new(-2.0, 0.5, -2.0),
                Vec3::new(2.0, 0.5, -2.0),
            ],
            normals: vec![
                Vec3::Z,
                side(-1.0),
                side(1.0),
                Vec3::Z,
                side(-1.0),
                side(1.0),
            ],
            triangles: vec![
                [0, 2, 1],
                [1, 2, 3],
                [0, 1, 4],
                [1, 3, 4],
                [2, 0, 5],
                [2, 5, 3],
            ],
        };
        let around = vertex_triangles(&mesh);
        let before = mesh.clone();
        let mut on_crease = [true, false, false, false, false, false];
        flip(&mut mesh, &around, &on_crease);
        assert_eq!(mesh, before);
        on_crease[3] = true;
        flip(&mut mesh, &around, &on_crease);
        assert_eq!(mesh.triangles[..2], [[0, 2, 3], [0, 3, 1]]);
        assert_eq!(mesh.triangles[2..], before.triangles[2..]);
        // A vertex of three triangles keeps them.
        let mut small = before.clone();
        small.triangles.pop();
        let around = vertex_triangles(&small);
        let before = small.clone();
        flip(&mut small, &around, &on_crease);
        assert_eq!(small, before);
    }
}
