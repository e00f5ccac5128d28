//! Fairing within the noise: the grain that noise leaves in a mesh goes, creases and what is wider than the noise stay.
//!
//! 1. The normal of every triangle becomes a mean of those around it, [`PASSES`] times. What is near weighs more, and what looks
//!    elsewhere by more than the noise can turn a triangle weighs nothing: creases stay (the bilateral filter of Y. Zheng et al.,
//!    "Bilateral normal filtering for mesh denoising", 2011).
//! 2. The vertices move along these normals until the triangles have them (X. Sun et al., "Fast and effective feature-preserving
//!    mesh denoising", 2007), and no farther than the noise allows.
//! 3. The normals of the vertices are the means of their triangles' filtered ones.
//!
//! **Cost**: linear in the triangles; about as much as 40 sums over the neighbours of each.

use crate::base::par;
use crate::mesh::collapse::{VertexTriangles, vertex_triangles};
use crate::mesh::surface::Mesh;
use glam::Vec3;

/// Times that normals are filtered.
const PASSES: usize = 5;
/// Times that vertices are moved.
const MOVES: usize = 6;
/// Triangles weigh nothing at this many mean distances of a triangle from those around it: 1.5 follows the curvature of a duck that
/// 2 flattens.
const REACH: f32 = 1.5;
/// Normals weigh nothing when they differ by this many times the noise over that mean distance,
const TURN: f32 = 10.0;
/// and by this, as the chord of the angle: 60 degrees.
const MOST_TURN: f32 = 1.0;
/// Below this chord nothing would be seen to change.
const LEAST_TURN: f32 = 0.02;
/// A vertex moves so many standard deviations of the noise at most.
const MOST_MOVED: f32 = 0.8;

/// Takes the grain out of a mesh whose points had noise of this standard deviation, unit frame.
pub(crate) fn fair(mesh: &mut Mesh, noise: f32) {
    let around = vertex_triangles(mesh);
    let filter = Filter::new(mesh, &around, noise);
    if filter.mean_turn() < LEAST_TURN {
        return;
    }
    let normals = filter.filtered();
    let areas = filter.areas;
    mesh.vertices = moved(mesh, &around, &normals, MOST_MOVED * noise);
    mesh.normals = par::map(
        mesh.vertices.len(),
        || (),
        |v, ()| {
            let triangles = around.of(v as u32).iter().map(|&t| t as usize);
            let sum: Vec3 = triangles.map(|t| areas[t] * normals[t]).sum();
            sum.normalize_or(mesh.normals[v])
        },
    );
}

/// What the filter knows of every triangle.
struct Filter<'a> {
    mesh: &'a Mesh,
    around: &'a VertexTriangles,
    centers: Vec<Vec3>,
    areas: Vec<f32>,
    normals: Vec<Vec3>,
    /// One over the square of the distance at which a triangle around it weighs nothing.
    nearness: Vec<f32>,
    /// The square of the chord at which its normal does.
    turns: Vec<f32>,
}

impl Filter<'_> {
    fn new<'a>(mesh: &'a Mesh, around: &'a VertexTriangles, noise: f32) -> Filter<'a> {
        let n = mesh.triangles.len();
        let corners = |t: usize| mesh.triangles[t].map(|v| mesh.vertices[v as usize]);
        let centers = par::map(n, || (), |t, ()| corners(t).iter().sum::<Vec3>() / 3.0);
        let crosses = par::map(
            n,
            || (),
            |t, ()| {
                let [a, b, c] = corners(t);
                (b - a).cross(c - a)
            },
        );
        let mut filter = Filter {
            mesh,
            around,
            centers,
            areas: crosses.iter().map(|cross| cross.length()).collect(),
            normals: crosses
                .iter()
                .map(|cross| cross.normalize_or_zero())
                .collect(),
            nearness: Vec::new(),
            turns: Vec::new(),
        };
        let scales = par::map(n, || (), |t, ()| filter.scale(t));
        filter.nearness = scales.iter().map(|s| 1.0 / (REACH * s).powi(2)).collect();
        let turn = |s: &f32| (TURN * noise / s).min(MOST_TURN).powi(2);
        filter.turns = scales.iter().map(turn).collect();
        filter
    }

    /// Mean distance from a triangle to those around it.
    fn scale(&self, t: usize) -> f32 {
        let (mut sum, mut count) = (0.0, 0);
        for other in self.others(t) {
            sum += self.centers[t].distance(self.centers[other]);
            count += 1;
        }
        sum / count as f32
    }

    /// The triangles with a common vertex, those with a common edge twice.
    fn others(&self, t: usize) -> impl Iterator<Item = usize> {
        let vertices = self.mesh.triangles[t].into_iter();
        let triangles = vertices.flat_map(|v| self.around.of(v));
        triangles
            .map(|&other| other as usize)
            .filter(move |&other| other != t)
    }

    fn mean_turn(&self) -> f32 {
        let sum: f64 = self.turns.iter().map(|turn| f64::from(turn.sqrt())).sum();
        (sum / self.turns.len().max(1) as f64) as f32
    }

    fn filtered(&self) -> Vec<Vec3> {
        let mut normals = self.pass(&self.normals);
        for _ in 1..PASSES {
            normals = self.pass(&normals);
        }
        normals
    }

    fn pass(&self, normals: &[Vec3]) -> Vec<Vec3> {
        par::map(
            normals.len(),
            || (),
            |t, ()| {
                let (center, normal) = (self.centers[t], normals[t]);
                let (nearness, turn) = (self.nearness[t], 1.0 / self.turns[t]);
                let mut sum = Vec3::ZERO;
                for other in self.others(t) {
                    let near =
                        (1.0 - center.distance_squared(self.centers[other]) * nearness).max(0.0);
                    let alike = (1.0 - normal.distance_squared(normals[other]) * turn).max(0.0);
                    sum += self.areas[other] * (near * alike).powi(2) * normals[other];
                }
                sum.normalize_or(normal)
            },
        )
    }
}

/// The vertices where the triangles around them have these normals, as far as that is no more than `most` away.
fn moved(mesh: &Mesh, around: &VertexTriangles, normals: &[Vec3], most: f32) -> Vec<Vec3> {
    let mut vertices = mesh.vertices.clone();
    for _ in 0..MOVES {
        let offsets = par::map(
            normals.len(),
            || (),
            |t, ()| {
                let [a, b, c] = mesh.triangles[t].map(|v| vertices[v as usize]);
                normals[t].dot(a + b + c) / 3.0
            },
        );
        vertices = par::map(
            vertices.len(),
            || (),
            |v, ()| {
                let (place, triangles) = (vertices[v], around.of(v as u32));
                let step: Vec3 = (triangles.iter())
                    .map(|&t| {
                        (offsets[t as usize] - normals[t as usize].dot(place)) * normals[t as usize]
                    })
                    .sum();
                let moved = place + step / triangles.len().max(1) as f32 - mesh.vertices[v];
                mesh.vertices[v] + moved.clamp_length_max(most)
            },
        );
    }
    vertices
}
