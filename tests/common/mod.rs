//! Shapes with a known surface, sampled at random.

#![allow(dead_code)] // every test file takes what it needs

pub mod mesh;
pub mod scenes;

use glam::{DVec3, Vec3};
use pointweave::base::progress::Silent;
use pointweave::base::rng::Rng;
use pointweave::cloud::octree::Octree;
use pointweave::reduce::height_field::{Patches, cloud_distances};
use pointweave::reduce::shares::{SHARES, Shares};
use std::f64::consts::{PI, TAU};

/// A closed surface of known truth.
#[derive(Debug, Clone, Copy)]
pub enum Shape {
    /// Radius 1.
    Sphere,
    /// Radii 1 and 0.4 around z.
    Torus,
    /// Half edges 1, 0.7, 0.5.
    Box,
    /// Radius 1 each, centres 3 apart.
    TwoSpheres,
}

/// Half edges of [`Shape::Box`].
const HALF: DVec3 = DVec3::new(1.0, 0.7, 0.5);
/// Centre of either sphere of [`Shape::TwoSpheres`].
const APART: DVec3 = DVec3::new(1.5, 0.0, 0.0);

impl Shape {
    pub const ALL: [Shape; 4] = [Shape::Sphere, Shape::Torus, Shape::Box, Shape::TwoSpheres];

    /// Genus of each component.
    pub fn genus(self) -> Vec<i64> {
        match self {
            Shape::Sphere | Shape::Box => vec![0],
            Shape::Torus => vec![1],
            Shape::TwoSpheres => vec![0, 0],
        }
    }

    pub fn volume(self) -> f64 {
        match self {
            Shape::Sphere => 4.0 / 3.0 * PI,
            Shape::Torus => 2.0 * PI * PI * 0.16,
            Shape::Box => 8.0 * HALF.x * HALF.y * HALF.z,
            Shape::TwoSpheres => 8.0 / 3.0 * PI,
        }
    }

    pub fn area(self) -> f64 {
        match self {
            Shape::Sphere => 4.0 * PI,
            Shape::Torus => 4.0 * PI * PI * 0.4,
            Shape::Box => 8.0 * (HALF.x * HALF.y + HALF.y * HALF.z + HALF.z * HALF.x),
            Shape::TwoSpheres => 8.0 * PI,
        }
    }

    /// Signed distance, negative inside.
    pub fn distance(self, p: DVec3) -> f64 {
        match self {
            Shape::Sphere => p.length() - 1.0,
            Shape::Torus => {
                let ring = (p.x * p.x + p.y * p.y).sqrt() - 1.0;
                (ring * ring + p.z * p.z).sqrt() - 0.4
            }
            Shape::Box => {
                let q = p.abs() - HALF;
                q.max(DVec3::ZERO).length() + q.max_element().min(0.0)
            }
            Shape::TwoSpheres => (p - APART).length().min((p + APART).length()) - 1.0,
        }
    }

    /// Outward normal of the surface point nearest to `p`, by differences.
    pub fn normal(self, p: DVec3) -> DVec3 {
        let h = 1e-6;
        let slope = |e: DVec3| self.distance(p + h * e) - self.distance(p - h * e);
        DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z)).normalize()
    }

    /// `n` points, even by area, moved along the normal by Gaussian noise; one coordinate triple after the other.
    pub fn sample(self, n: usize, noise: f64, seed: u64) -> Vec<f64> {
        let mut rng = Rng::new(seed);
        let mut out = Vec::with_capacity(3 * n);
        for _ in 0..n {
            let p = self.point(&mut rng);
            let q = p + self.normal(p) * (noise * rng.normal());
            out.extend(q.to_array());
        }
        out
    }

    fn point(self, rng: &mut Rng) -> DVec3 {
        match self {
            Shape::Sphere => direction(rng),
            Shape::TwoSpheres => direction(rng) + if rng.uniform() < 0.5 { APART } else { -APART },
            Shape::Torus => loop {
                let (u, v) = (TAU * rng.uniform(), TAU * rng.uniform());
                let ring = 1.0 + 0.4 * v.cos();
                if rng.uniform() * 1.4 < ring {
                    return DVec3::new(ring * u.cos(), ring * u.sin(), 0.4 * v.sin());
                }
            },
            Shape::Box => {
                let areas = DVec3::new(HALF.y * HALF.z, HALF.z * HALF.x, HALF.x * HALF.y);
                let pick = rng.uniform() * areas.element_sum();
                let axis = if pick < areas.x {
                    0
                } else if pick < areas.x + areas.y {
                    1
                } else {
                    2
                };
                let mut p = DVec3::ZERO;
                for a in 0..3 {
                    p[a] = HALF[a] * (2.0 * rng.uniform() - 1.0);
                }
                p[axis] = HALF[axis].copysign(rng.uniform() - 0.5);
                p
            }
        }
    }
}

fn direction(rng: &mut Rng) -> DVec3 {
    DVec3::new(rng.normal(), rng.normal(), rng.normal()).normalize()
}

/// Points of an array `x y z …`.
pub fn points(positions: &[f64]) -> impl Iterator<Item = DVec3> + '_ {
    positions.chunks_exact(3).map(DVec3::from_slice)
}

/// Distances of points to the surface that reduced points with normals stand for, the nearest ones found by a search.
pub fn distances_to(reduced: &[Vec3], normals: &[Vec3], points: &[Vec3]) -> Vec<f32> {
    let tree = Octree::build(reduced);
    let patches = Patches::fit(&tree, normals);
    let mut found = Vec::new();
    let mut nearest = |p: &Vec3| {
        tree.knn(*p, SHARES, &mut found);
        let near = |j: usize| tree.order[found.get(j).unwrap_or(&found[0]).index as usize];
        Shares {
            center: std::array::from_fn(near),
            u: [1.0 / SHARES as f32; SHARES],
        }
    };
    let shares: Vec<Shares> = points.iter().map(&mut nearest).collect();
    cloud_distances(|k| points[k], &shares, &patches, &mut Silent).expect("nobody cancels")
}
