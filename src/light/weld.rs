//! Any list of triangles as a mesh: vertices at one place become one, and triangles that are none are left out.

use crate::base::error::{Error, Result};
use crate::cloud::{Attribute, Cloud};
use crate::light::painted::Painted;
use crate::mesh::Mesh;
use glam::Vec3;

/// A mesh of the vertices of `cloud`, three indices a triangle. Files like STL give every triangle corners of its own: those at one place
/// become one vertex, with the mean of their colours, normals and attributes.
///
/// # Errors
/// [`Error::BadLength`], [`Error::BadIndex`]; [`Error::Degenerate`] where no triangle has an area.
pub fn weld(cloud: &Cloud, indices: &[u32]) -> Result<Painted> {
    let points = cloud.points.len();
    if !indices.len().is_multiple_of(3) {
        return Err(Error::BadLength {
            array: "indices".into(),
            expected: "a multiple of 3".into(),
            found: indices.len(),
        });
    }
    if let Some(index) = indices.iter().position(|&v| v as usize >= points) {
        let found = indices[index];
        return Err(Error::BadIndex {
            index,
            points,
            found,
        });
    }
    let key = |v: u32| {
        cloud.points[v as usize]
            .to_array()
            .map(|x| (x + 0.0).to_bits())
    };
    let mut order: Vec<u32> = (0..points as u32).collect();
    order.sort_unstable_by_key(|&v| (key(v), v));
    // The first of those at one place stands for all.
    let mut first: Vec<u32> = (0..points as u32).collect();
    for same in order.chunk_by(|&a, &b| key(a) == key(b)) {
        same.iter().for_each(|&v| first[v as usize] = same[0]);
    }
    let corners = indices
        .chunks_exact(3)
        .map(|t| [t[0], t[1], t[2]].map(|v| first[v as usize]));
    let area = |[a, b, c]: [u32; 3]| {
        let [a, b, c] = [a, b, c].map(|v| cloud.points[v as usize].as_dvec3());
        (b - a).cross(c - a).length_squared()
    };
    let mut triangles: Vec<[u32; 3]> = corners.filter(|&t| area(t) > 0.0).collect();
    drop_twins(&mut triangles);
    if triangles.is_empty() {
        let found = "none of the triangles has an area".into();
        return Err(Error::Degenerate { found });
    }
    let mut index = vec![u32::MAX; points];
    let mut of = Vec::new();
    for v in triangles.as_flattened_mut() {
        let slot = &mut index[*v as usize];
        if *slot == u32::MAX {
            *slot = of.len() as u32;
            of.push(*v);
        }
        *v = *slot;
    }
    let vertex = |v: usize| Some(index[first[v] as usize]).filter(|&i| i != u32::MAX);
    let mean = |value: &dyn Fn(usize) -> Vec3| {
        let (mut sums, mut counts) = (vec![Vec3::ZERO; of.len()], vec![0u32; of.len()]);
        for (v, i) in (0..points).filter_map(|v| Some((v, vertex(v)? as usize))) {
            sums[i] += value(v);
            counts[i] += 1;
        }
        let means = sums.into_iter().zip(counts);
        means
            .map(|(sum, count)| sum / count.max(1) as f32)
            .collect::<Vec<_>>()
    };
    let normals = cloud.normals.as_ref().map(|normals| {
        let means = mean(&|v| normals[v]);
        means.into_iter().map(Vec3::normalize_or_zero).collect()
    });
    let colors = cloud.colors.as_ref().map(|colors| {
        let means = mean(&|v| Vec3::from(colors[v].map(f32::from)));
        let color = |mean: Vec3| mean.to_array().map(|x| x.round() as u8);
        means.into_iter().map(color).collect()
    });
    let attribute = |a: &Attribute| Attribute {
        name: a.name.clone(),
        values: mean(&|v| Vec3::splat(a.values[v]))
            .iter()
            .map(|m| m.x)
            .collect(),
    };
    Ok(Painted {
        mesh: Mesh {
            vertices: of.iter().map(|&v| cloud.points[v as usize]).collect(),
            normals: normals.unwrap_or_default(),
            triangles,
        },
        colors,
        attributes: cloud.attributes.iter().map(attribute).collect(),
    })
}

/// Leaves one of the triangles that have the same corners.
fn drop_twins(triangles: &mut Vec<[u32; 3]>) {
    let corners = |t: [u32; 3]| {
        let mut sorted = t;
        sorted.sort_unstable();
        sorted
    };
    let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
    order.sort_unstable_by_key(|&t| (corners(triangles[t as usize]), t));
    let mut stays = vec![true; triangles.len()];
    for pair in order.windows(2).map(|w| [w[0], w[1]].map(|t| t as usize)) {
        stays[pair[1]] = corners(triangles[pair[0]]) != corners(triangles[pair[1]]);
    }
    let mut stays = stays.into_iter();
    triangles.retain(|_| stays.next() == Some(true));
}
