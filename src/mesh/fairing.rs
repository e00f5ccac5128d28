//! Fairing within the noise: the grain that noise leaves in a mesh goes; creases, and what is more than noise, stay.
//!
//! 1. The normal of every triangle becomes a mean of those around it, [`PASSES`] times. What is near weighs more, and what looks
//!    elsewhere weighs nothing: creases stay (the bilateral filter of Y. Zheng et al., "Bilateral normal filtering for mesh
//!    denoising", 2011).
//! 2. How far it goes there depends on how much its neighbours' normals differ from it: all the way where noise explains that, hardly
//!    where the surface must have relief of its own.
//! 3. The vertices move along these normals until the triangles have them (X. Sun et al., "Fast and effective feature-preserving
//!    mesh denoising", 2007), no farther than [`MOST_MOVED`] allows.
//! 4. The normals of the vertices are the means of their triangles' filtered ones.
//!
//! **Cost**: linear in the triangles, about 15 sums over the neighbours of each.

use crate::base::groups::Groups;
use crate::base::par;
use crate::mesh::collapse::{VertexTriangles, vertex_triangles};
use crate::mesh::surface::Mesh;
use glam::Vec3;

/// Times that normals are filtered.
const PASSES: usize = 8;
/// Times that vertices are moved.
const MOVES: usize = 6;
/// Triangles weigh nothing at this many mean distances of a triangle from those around it: 1.5 follows the curvature of a duck that
/// 2 flattens.
const REACH: f32 = 1.5;
/// One over the square of the chord between normals at which they weigh nothing: 47 degrees.
const ALIKE: f32 = 1.0 / (0.8 * 0.8);
/// Noise explains normals that differ by this many times the noise over that mean distance. On samples and bench clouds of a third
/// of the points, 1.2 to 2 were tried: more takes grain out of smooth things, and relief out of the bunny.
const EXPLAINED: f32 = 1.5;
/// Times that the squares of these differences are averaged over the triangles around.
const SPREADS: usize = 3;
/// A vertex moves so many standard deviations of the noise at most,
const MOST_MOVED: f32 = 2.0;
/// and this share of the mean distance of the triangles around it: nothing folds where noise is wider than triangles.
const ASIDE: f32 = 0.25;
/// Where filtering goes less far than this on average, noise explains next to nothing of the relief.
const LEAST_STRENGTH: f32 = 0.15;

/// Takes the grain out of a mesh that was fitted to points with noise of this standard deviation, unit frame.
pub(crate) fn fair(mesh: &mut Mesh, noise: f32) {
    let around = vertex_triangles(mesh);
    let filter = Filter::new(mesh, &around);
    let strengths = filter.strengths(noise);
    if mean(&strengths) < LEAST_STRENGTH {
        return;
    }
    let normals = filter.filtered(&strengths);
    let most = |&t: &u32| (MOST_MOVED * noise).min(ASIDE * filter.scales[t as usize]);
    let reach = |v| around.of(v).iter().map(most).fold(f32::INFINITY, f32::min);
    let limits: Vec<f32> = (0..mesh.vertices.len() as u32).map(reach).collect();
    let areas: Vec<f32> = filter.triangles.iter().map(|t| t.area).collect();
    mesh.vertices = moved(mesh, &around, &normals, &limits);
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

fn mean(values: &[f32]) -> f32 {
    let sum: f64 = values.iter().map(|&v| f64::from(v)).sum();
    (sum / values.len().max(1) as f64) as f32
}

/// What a triangle's neighbours ask of it, side by side in memory.
struct Triangle {
    center: Vec3,
    /// Twice its area.
    area: f32,
}

/// What the filter knows of every triangle.
struct Filter {
    triangles: Vec<Triangle>,
    normals: Vec<Vec3>,
    /// The triangles with a common vertex, those with a common edge twice.
    others: Groups<u32>,
    /// Mean distance to the triangles around it.
    scales: Vec<f32>,
}

impl Filter {
    fn new(mesh: &Mesh, around: &VertexTriangles) -> Filter {
        let corners = |t: &[u32; 3]| t.map(|v| mesh.vertices[v as usize]);
        let cross = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a);
        let triangle = |[a, b, c]: [Vec3; 3]| Triangle {
            center: (a + b + c) / 3.0,
            area: cross([a, b, c]).length(),
        };
        let all = || mesh.triangles.iter().map(corners);
        let pairs = || {
            mesh.triangles.iter().zip(0u32..).flat_map(|(corners, t)| {
                let near = corners.iter().flat_map(|&v| around.of(v));
                near.filter(move |&&other| other != t)
                    .map(move |&other| (t, other))
            })
        };
        let mut filter = Filter {
            triangles: all().map(triangle).collect(),
            normals: all().map(|t| cross(t).normalize_or_zero()).collect(),
            others: Groups::new(mesh.triangles.len(), pairs),
            scales: Vec::new(),
        };
        let center = |t: usize| filter.triangles[t].center;
        filter.scales = filter.means(|t, other| center(t).distance(center(other)));
        filter
    }

    /// The triangles around one.
    fn others(&self, t: usize) -> impl Iterator<Item = usize> {
        self.others.of(t as u32).iter().map(|&other| other as usize)
    }

    /// The mean of what `of` says of each triangle and those around it.
    fn means(&self, of: impl Fn(usize, usize) -> f32 + Sync + Send) -> Vec<f32> {
        par::map(
            self.normals.len(),
            || (),
            |t, ()| {
                let sum: f32 = self.others(t).map(|other| of(t, other)).sum();
                sum / (self.others.of(t as u32).len() as f32).max(1.0)
            },
        )
    }

    fn filtered(&self, strengths: &[f32]) -> Vec<Vec3> {
        let mut normals = self.pass(&self.normals, strengths);
        for _ in 1..PASSES {
            normals = self.pass(&normals, strengths);
        }
        normals
    }

    /// How far a pass goes (0-1): as the square of what noise explains of the variance of normals, around each triangle.
    fn strengths(&self, noise: f32) -> Vec<f32> {
        let normals = &self.normals;
        let mut spread = par::map(
            normals.len(),
            || (),
            |t, ()| {
                let (mut sum, mut weights) = (0.0, f32::MIN_POSITIVE);
                for (weight, other) in self.weighted(t, normals) {
                    sum += weight * normals[t].distance_squared(normals[other]);
                    weights += weight;
                }
                sum / weights
            },
        );
        for _ in 0..SPREADS {
            spread = self.means(|_, other| spread[other]);
        }
        let explained = self.scales.iter().map(|s| (EXPLAINED * noise / s).powi(2));
        let strength = |(e, s): (f32, f32)| (e / s.max(f32::MIN_POSITIVE)).min(1.0).powi(2);
        explained.zip(spread).map(strength).collect()
    }

    /// What the triangles around one weigh.
    fn weighted<'a>(
        &'a self,
        t: usize,
        normals: &'a [Vec3],
    ) -> impl Iterator<Item = (f32, usize)> + 'a {
        let (center, normal) = (self.triangles[t].center, normals[t]);
        let nearness = 1.0 / (REACH * self.scales[t]).powi(2);
        self.others(t).map(move |k| {
            let other = &self.triangles[k];
            let near = 1.0 - center.distance_squared(other.center) * nearness;
            let alike = 1.0 - normal.distance_squared(normals[k]) * ALIKE;
            (other.area * (near.max(0.0) * alike.max(0.0)).powi(2), k)
        })
    }

    fn pass(&self, normals: &[Vec3], strengths: &[f32]) -> Vec<Vec3> {
        par::map(
            normals.len(),
            || (),
            |t, ()| {
                let normal = normals[t];
                let sum: Vec3 = (self.weighted(t, normals))
                    .map(|(weight, other)| weight * normals[other])
                    .sum();
                normal
                    .lerp(sum.normalize_or(normal), strengths[t])
                    .normalize_or(normal)
            },
        )
    }
}

/// The vertices where the triangles around them have these normals, each no farther than its limit.
fn moved(mesh: &Mesh, around: &VertexTriangles, normals: &[Vec3], limits: &[f32]) -> Vec<Vec3> {
    let mut vertices = mesh.vertices.clone();
    for _ in 0..MOVES {
        let offset = |(t, normal): (&[u32; 3], &Vec3)| {
            let [a, b, c] = t.map(|v| vertices[v as usize]);
            normal.dot(a + b + c) / 3.0
        };
        let offsets: Vec<f32> = mesh.triangles.iter().zip(normals).map(offset).collect();
        vertices = par::map(
            vertices.len(),
            || (),
            |v, ()| {
                let (place, triangles) = (vertices[v], around.of(v as u32));
                let step: Vec3 = (triangles.iter().map(|&t| t as usize))
                    .map(|t| (offsets[t] - normals[t].dot(place)) * normals[t])
                    .sum();
                let moved = place + step / triangles.len().max(1) as f32 - mesh.vertices[v];
                mesh.vertices[v] + moved.clamp_length_max(limits[v])
            },
        );
    }
    vertices
}
