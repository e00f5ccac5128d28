//! Colours and scalars of a cloud on the vertices of a mesh.

use crate::cloud::{Attribute, Cloud};
use crate::octree::{Neighbor, Octree};
use crate::par;
use glam::Vec3;

/// Sites that a vertex takes its values from.
const NEAREST: usize = 4;

/// Colours and scalars at `vertices`: means of the nearest sites weighted by 1/d² (Shepard, 1968). `tree` holds the
/// points of `cloud`.
pub fn attach(
    vertices: &[Vec3],
    tree: &Octree,
    cloud: &Cloud,
) -> (Option<Vec<[u8; 3]>>, Vec<Attribute>) {
    if cloud.colors.is_none() && cloud.attributes.is_empty() {
        return (None, Vec::new());
    }
    let shares = par::map(vertices.len(), Vec::new, |i, found: &mut Vec<Neighbor>| {
        tree.knn(vertices[i], NEAREST, found);
        // A vertex on a site takes that site's value alone.
        let weight = |n: &Neighbor| 1.0 / n.distance2.max(1e-14);
        let total: f32 = found.iter().map(weight).sum();
        found
            .iter()
            .map(|n| (tree.order[n.index as usize] as usize, weight(n) / total))
            .collect::<Vec<_>>()
    });
    let mean = |value: &dyn Fn(usize) -> f32| -> Vec<f32> {
        shares
            .iter()
            .map(|s| s.iter().map(|&(i, w)| w * value(i)).sum())
            .collect()
    };
    let colors = cloud.colors.as_ref().map(|colors| {
        let [r, g, b] = [0, 1, 2].map(|c| mean(&|i| colors[i][c] as f32));
        (0..vertices.len())
            .map(|v| [r[v], g[v], b[v]].map(|x| x.round() as u8))
            .collect()
    });
    let attributes = cloud
        .attributes
        .iter()
        .map(|a| Attribute {
            name: a.name.clone(),
            values: mean(&|i| a.values[i]),
        })
        .collect();
    (colors, attributes)
}
