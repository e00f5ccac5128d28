//! Scans whose outer side is known, of twelve kinds; a seed makes another one of the same kind.

#![allow(dead_code)] // every test takes what it needs

mod objects;
mod places;
mod shapes;

use glam::{DVec3, Vec3};
use pointweave::base::progress::Silent;
use pointweave::base::rng::Rng;
use pointweave::cloud::octree::Octree;
use pointweave::{Cloud, Surface, SurfaceParams, reconstruct_owned};
use std::sync::Arc;

/// Whether a triangle at a place with a unit normal is right side out; `None` where that is not known.
pub type Truth = Arc<dyn Fn(DVec3, DVec3) -> Option<bool> + Send + Sync>;

/// What is told of a scan besides its points.
#[derive(Default)]
pub struct Told {
    pub normals: Option<Vec<DVec3>>,
    pub viewpoints: Vec<DVec3>,
    pub of: Option<Vec<u32>>,
    pub up: Option<DVec3>,
    pub above: bool,
}

/// Spacings, about, from all points beyond which nothing was scanned.
const NEAR: f32 = 0.8;

/// How sure the outer side is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sure {
    /// A closed object: at least 99.9 % of the area.
    Closed,
    /// Something tells: at least 99 %.
    Told,
    /// Nothing tells: one side, at least 99.9 %, and a doubt.
    Guess,
}

/// A scan.
pub struct Scene {
    pub points: Vec<DVec3>,
    pub told: Told,
    pub sure: Sure,
    pub truth: Truth,
}

impl Scene {
    pub fn new(
        sure: Sure,
        points: Vec<DVec3>,
        truth: impl Fn(DVec3, DVec3) -> Option<bool> + Send + Sync + 'static,
    ) -> Scene {
        Scene {
            points,
            told: Told::default(),
            sure,
            truth: Arc::new(truth),
        }
    }

    pub fn seen_from(mut self, eye: DVec3) -> Scene {
        self.told.viewpoints = vec![eye];
        self
    }

    pub fn seen_from_each(mut self, eyes: Vec<DVec3>, of: Vec<u32>) -> Scene {
        self.told.viewpoints = eyes;
        self.told.of = Some(of);
        self
    }

    pub fn seen_from_above(mut self) -> Scene {
        self.told.above = true;
        self
    }

    pub fn with_up(mut self, up: DVec3) -> Scene {
        self.told.up = Some(up);
        self
    }

    pub fn with_normals(mut self, normals: Vec<DVec3>) -> Scene {
        self.told.normals = Some(normals);
        self
    }

    pub fn cloud(&self) -> Cloud {
        let flat: Vec<f64> = self.points.iter().flat_map(|p| p.to_array()).collect();
        let mut cloud = Cloud::from_f64(&flat).expect("a cloud");
        let told = &self.told;
        if let Some(normals) = &told.normals {
            let flat: Vec<f32> = normals
                .iter()
                .flat_map(|n| n.as_vec3().to_array())
                .collect();
            cloud = cloud.with_normals(&flat).expect("normals");
        }
        if !told.viewpoints.is_empty() {
            let eyes: Vec<f64> = told.viewpoints.iter().flat_map(|v| v.to_array()).collect();
            cloud = cloud
                .with_viewpoints(&eyes, told.of.as_deref())
                .expect("viewpoints");
        }
        if let Some(up) = told.up {
            cloud = cloud.with_up(up.to_array()).expect("up");
        }
        cloud.with_seen_from_above(told.above)
    }

    pub fn surface(&self, params: &SurfaceParams) -> Surface {
        reconstruct_owned(self.cloud(), params, &mut Silent).expect("a surface")
    }

    /// The share of the surface's area that is right side out, of what the truth knows and what was scanned: where holes
    /// were closed there is no truth.
    pub fn right(&self, surface: &Surface) -> f64 {
        let scanned = Octree::build(&self.cloud().points);
        let mut nearest = Vec::new();
        // Of the diagonal, at least a third of a percent: that much smoothing may move a surface.
        let near = (NEAR / (self.points.len() as f32).sqrt()).max(0.0033);
        let positions = surface.positions_f64();
        let vertices: Vec<DVec3> = positions.chunks_exact(3).map(DVec3::from_slice).collect();
        let (mut right, mut area) = (0.0, 0.0);
        for t in &surface.mesh.triangles {
            let [a, b, c] = t.map(|v| vertices[v as usize]);
            let normal = (b - a).cross(c - a);
            let size = normal.length();
            let center = t
                .map(|v| surface.mesh.vertices[v as usize])
                .iter()
                .sum::<Vec3>()
                / 3.0;
            scanned.knn(center, 1, &mut nearest);
            if size == 0.0 || nearest[0].distance2 > near * near {
                continue;
            }
            if let Some(is_right) = (self.truth)((a + b + c) / 3.0, normal / size) {
                area += size;
                right += if is_right { size } else { 0.0 };
            }
        }
        right / area
    }

    /// The share of the fitted points whose normal is right.
    pub fn right_points(&self, surface: &Surface) -> f64 {
        let cloud = &surface.cloud.reduced.cloud;
        let normals = cloud.normals.as_deref().unwrap_or_default();
        let at = |p: Vec3| DVec3::from_array(cloud.frame.to_caller(p));
        let told = cloud
            .points
            .iter()
            .zip(normals)
            .filter(|(_, n)| **n != Vec3::ZERO);
        let is: Vec<bool> = told
            .filter_map(|(&p, n)| (self.truth)(at(p), n.as_dvec3()))
            .collect();
        is.iter().filter(|is| **is).count() as f64 / is.len() as f64
    }
}

/// A kind of scene with a name.
pub struct Recipe {
    pub kind: &'static str,
    pub name: &'static str,
    pub make: fn(&mut Rng) -> Scene,
}

type Row = (&'static str, &'static str, fn(&mut Rng) -> Scene);

/// All of them.
pub fn all() -> Vec<Recipe> {
    let rows = places::RECIPES.iter().chain(objects::RECIPES);
    rows.map(|&(kind, name, make)| Recipe { kind, name, make })
        .collect()
}

impl Recipe {
    /// The scene of a seed.
    pub fn scene(&self, seed: u64) -> Scene {
        let name = self
            .name
            .bytes()
            .fold(7u64, |h, b| h * 31 % 1_000_003 + u64::from(b));
        (self.make)(&mut Rng::new(seed * 1_000_003 + name))
    }
}
