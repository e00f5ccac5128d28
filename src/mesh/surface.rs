//! The input and the output of an extraction: [`Implicit`], the function, and [`Mesh`].

use glam::{DVec3, Vec3};

/// A function whose zero set is a surface: negative inside, positive outside, about the distance near the surface.
/// Positions are in the unit frame.
pub trait Implicit: Sync {
    /// Memory that one evaluating worker reuses; what is left in it must not change a result.
    type Scratch;

    /// A new [`Implicit::Scratch`].
    fn scratch(&self) -> Self::Scratch;

    /// Standard deviation of the noise in what the function was fitted to.
    fn noise(&self) -> f64 {
        0.0
    }

    /// A value everywhere, which agrees with the fitted one as to inside and outside where both exist.
    fn global(&self, at: DVec3, scratch: &mut Self::Scratch) -> f64;

    /// The fitted values at positions close to each other, one a position; NaN where no fitted function reaches.
    fn locals(&self, at: &[DVec3], values: &mut [f64], scratch: &mut Self::Scratch);

    /// The fitted values with their gradients, one a position; `None` where no fitted function reaches.
    fn gradients(
        &self,
        at: &[DVec3],
        found: &mut [Option<(f64, DVec3)>],
        scratch: &mut Self::Scratch,
    );

    /// A vector that points from a fitted point to the sensor that saw it; zero where none is known.
    fn sensor(&self, _point: usize) -> Vec3 {
        Vec3::ZERO
    }
}

/// A triangle mesh in the unit frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Positions; every one is used by a triangle.
    pub vertices: Vec<Vec3>,
    /// Unit normals that point outward, one a vertex.
    pub normals: Vec<Vec3>,
    /// Vertex indices, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Normal of a triangle, as long as twice its area.
    pub fn cross(&self, triangle: [u32; 3]) -> DVec3 {
        let [a, b, c] = triangle.map(|v| self.vertices[v as usize].as_dvec3());
        (b - a).cross(c - a)
    }

    /// Turns it to its other side.
    pub fn invert(&mut self) {
        self.normals.iter_mut().for_each(|n| *n = -*n);
        self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }

    /// Drops vertices that no triangle has.
    pub(crate) fn drop_unused(&mut self) {
        let mut index = vec![u32::MAX; self.vertices.len()];
        let corners = self.triangles.as_flattened_mut();
        corners.iter().for_each(|&v| index[v as usize] = 0);
        let mut kept = 0;
        for (v, index) in index.iter_mut().enumerate().filter(|i| *i.1 == 0) {
            *index = kept as u32;
            self.vertices[kept] = self.vertices[v];
            self.normals[kept] = self.normals[v];
            kept += 1;
        }
        self.vertices.truncate(kept);
        self.normals.truncate(kept);
        corners.iter_mut().for_each(|v| *v = index[*v as usize]);
    }
}
