//! Normals, colours and scalars of one mesh at the vertices of another: those of the nearest place on it.

use crate::base::par;
use crate::cloud::Attribute;
use crate::light::painted::Painted;
use crate::mesh::Mesh;
use crate::report::distance::{TriangleTree, closest_on_triangle};
use glam::{DVec3, Vec3};

/// Vertices that one index of a parallel map takes.
const VERTICES_PER_TASK: usize = 256;

/// A place on a mesh: a triangle, and how much its corners count.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spot {
    pub(crate) triangle: u32,
    pub(crate) weights: [f64; 3],
}

impl Spot {
    /// The place of `mesh` nearest to `point`; `tree` is of its triangles.
    pub(crate) fn nearest(point: Vec3, mesh: &Mesh, tree: &TriangleTree, hint: &mut u32) -> Spot {
        *hint = tree.closest(point, *hint).1;
        Spot::on(*hint, point, mesh)
    }

    /// The place of a triangle nearest to `point`.
    pub(crate) fn on(triangle: u32, point: Vec3, mesh: &Mesh) -> Spot {
        let corners =
            mesh.triangles[triangle as usize].map(|v| mesh.vertices[v as usize].as_dvec3());
        let at = closest_on_triangle(point.as_dvec3(), corners);
        Spot {
            triangle,
            weights: weights(at, corners),
        }
    }
}

/// How much the corners of a triangle count at a place of it.
pub(crate) fn weights(at: DVec3, [a, b, c]: [DVec3; 3]) -> [f64; 3] {
    let normal = (b - a).cross(c - a);
    let square = normal.length_squared();
    if square == 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let of = |p: DVec3, q: DVec3| ((p - at).cross(q - at).dot(normal) / square).clamp(0.0, 1.0);
    let (first, second) = (of(b, c), of(c, a));
    [first, second, (1.0 - first - second).max(0.0)]
}

/// `light` with what the vertices of `full` carry. A mesh without normals gives none.
pub(crate) fn carry(full: &Painted, mut light: Mesh) -> Painted {
    let of = &full.mesh;
    let tree = TriangleTree::new(&of.vertices, &of.triangles);
    let tasks: Vec<&[Vec3]> = light.vertices.chunks(VERTICES_PER_TASK).collect();
    let spots: Vec<Vec<Spot>> = par::map(
        tasks.len(),
        || 0,
        |k, hint| {
            let nearest = |&point: &Vec3| Spot::nearest(point, of, &tree, hint);
            tasks[k].iter().map(nearest).collect()
        },
    );
    let spots: Vec<Spot> = spots.concat();
    let mix = |spot: &Spot, value: &dyn Fn(usize) -> DVec3| {
        let corners = of.triangles[spot.triangle as usize]
            .into_iter()
            .zip(spot.weights);
        corners.fold(DVec3::ZERO, |sum, (v, weight)| {
            sum + value(v as usize) * weight
        })
    };
    if !of.normals.is_empty() {
        let normal = |spot: &Spot| {
            let mean = mix(spot, &|v| of.normals[v].as_dvec3());
            let face = of.cross(of.triangles[spot.triangle as usize]);
            mean.try_normalize()
                .unwrap_or(face.normalize_or(DVec3::Z))
                .as_vec3()
        };
        light.normals = spots.iter().map(normal).collect();
    }
    let colors = full.colors.as_ref().map(|colors| {
        let color = |spot: &Spot| {
            let mean = mix(spot, &|v| DVec3::from(colors[v].map(f64::from)));
            mean.to_array().map(|x| x.round() as u8)
        };
        spots.iter().map(color).collect()
    });
    let attribute = |a: &Attribute| {
        let is_label = a.values.iter().all(|x| x.fract() == 0.0);
        let value = |spot: &Spot| {
            let nearest = (1..3).fold(0, |best, k| {
                if spot.weights[k] > spot.weights[best] {
                    k
                } else {
                    best
                }
            });
            if is_label {
                let corner = of.triangles[spot.triangle as usize][nearest];
                return a.values[corner as usize];
            }
            mix(spot, &|v| DVec3::splat(f64::from(a.values[v]))).x as f32
        };
        Attribute {
            name: a.name.clone(),
            values: spots.iter().map(value).collect(),
        }
    };
    Painted {
        mesh: light,
        colors,
        attributes: full.attributes.iter().map(attribute).collect(),
    }
}
