//! The types that the pipeline returns, and their values in the caller's frame.

use crate::cloud::Attribute;
use crate::mesh::Mesh;
use crate::reduce::Reduced;
use crate::report::{ReduceReport, SurfaceReport};

/// A reduced cloud and what its reduction did.
#[derive(Debug, Clone)]
pub struct ReducedCloud {
    /// The points with all that belongs to them.
    pub reduced: Reduced,
    /// Counts, distances, times.
    pub report: ReduceReport,
}

/// A mesh with the cloud that it was fitted to.
#[derive(Debug, Clone)]
pub struct Surface {
    /// In the unit frame of `cloud.reduced.cloud`; see [`Surface::positions_f64`].
    pub mesh: Mesh,
    /// One colour a vertex, where the cloud had colours.
    pub colors: Option<Vec<[u8; 3]>>,
    /// One value a vertex for each scalar of the cloud.
    pub attributes: Vec<Attribute>,
    /// The points that the surface was fitted to, with oriented normals; without their `shares`.
    pub cloud: ReducedCloud,
    /// Where they were asked for.
    pub distances: Option<Distances>,
    /// Counts, distances, topology, times.
    pub report: SurfaceReport,
}

/// How far scan and mesh are apart, place by place, as fractions of the diagonal.
#[derive(Debug, Clone)]
pub struct Distances {
    /// Of every input point, in the input's order, to the mesh; NaN for one that was dropped.
    pub points: Vec<f32>,
    /// At every vertex, the mean of the points that are nearest to its triangles; NaN where there are none.
    pub vertices: Vec<f32>,
}

impl Surface {
    /// Vertices, `x y z …` in the caller's frame.
    pub fn positions_f64(&self) -> Vec<f64> {
        let frame = &self.cloud.reduced.cloud.frame;
        self.mesh
            .vertices
            .iter()
            .flat_map(|&v| frame.to_caller(v))
            .collect()
    }

    /// Corners of the triangles: three vertex indices each.
    pub fn indices(&self) -> &[u32] {
        self.mesh.triangles.as_flattened()
    }
}
