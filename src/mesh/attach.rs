//! Colours and scalars of a cloud on the vertices of a mesh.

use crate::base::par;
use crate::base::params::{COLORS, Carry};
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;
use crate::cloud::{Attribute, Cloud};
use crate::reduce::placement::{color_key, label_key, majority};
use glam::Vec3;
use std::collections::BTreeMap;

/// Sites that a vertex takes its values from.
const NEAREST: usize = 4;

/// Colours and scalars at `vertices`, from the nearest sites weighted by 1/d² (Shepard, 1968): their mean, or where
/// `carried` says so the value with most of the weight, or that of the nearest alone, so that labels stay labels. `tree`
/// holds the points of `cloud`.
pub fn attach(
    vertices: &[Vec3],
    tree: &Octree,
    cloud: &Cloud,
    carried: &BTreeMap<String, Carry>,
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
    let how = |name: &str| carried.get(name).copied().unwrap_or(Carry::Mean);
    let mean = |shares: &[(usize, f32)], value: &dyn Fn(usize) -> f32| -> f32 {
        shares.iter().map(|&(i, w)| w * value(i)).sum()
    };
    let colors = cloud.colors.as_ref().map(|colors| {
        let of = |shares: &Vec<(usize, f32)>| {
            let nearest = || colors[shares[0].0];
            match how(COLORS) {
                Carry::Mean => {
                    [0, 1, 2].map(|c| mean(shares, &|i| colors[i][c] as f32).round() as u8)
                }
                Carry::Majority => majority(shares.iter().map(|&(i, w)| (colors[i], w)), color_key)
                    .unwrap_or_else(nearest),
                Carry::Nearest => nearest(),
            }
        };
        shares.iter().map(of).collect()
    });
    let attributes = cloud.attributes.iter().map(|a| {
        let of = |shares: &Vec<(usize, f32)>| {
            let nearest = || a.values[shares[0].0];
            let votes = || shares.iter().map(|&(i, w)| (a.values[i], w));
            match how(&a.name) {
                Carry::Mean => mean(shares, &|i| a.values[i]),
                Carry::Majority => majority(votes(), label_key).unwrap_or_else(nearest),
                Carry::Nearest => nearest(),
            }
        };
        Attribute {
            name: a.name.clone(),
            values: shares.iter().map(of).collect(),
        }
    });
    (colors, attributes.collect())
}
