//! What every result carries: counts, distances, topology, times.
//!
//! Lengths are fractions of the bounding-box diagonal of the input, which is the unit of the unit frame. The structs
//! serialise in camel case, as JS sees them; a number that does not exist for a job is 0, and `reason` says why.
//!
//! 1. [`distance`] measures how far every input point is from the mesh.
//! 2. `knowledge` says what may not be as it should, in sentences.
//! 3. [`ReduceReport`] and [`SurfaceReport`] hold both with counts, topology ([`crate::mesh::topology`]) and times.
//!
//! **Cost**: one nearest-triangle query for each input point.

pub mod distance;
mod knowledge;

use serde::Serialize;

pub use crate::base::clock::StageTimes;
pub use crate::mesh::holes::Hole;
pub use crate::mesh::topology::{Topology, area, topology, volume};
pub use crate::orient::account::{Account as OrientationReport, Source, SourceShare, WeakestTie};
pub use knowledge::Doubt;
pub(crate) use knowledge::{
    Looked, doubts, doubts_of_faces, doubts_of_lines, doubts_of_shape, doubts_of_steps,
    doubts_of_surface,
};

/// Mean, root mean square and maximum of distances.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct DistanceStats {
    /// Mean.
    pub mean: f64,
    /// Root mean square.
    pub rms: f64,
    /// Maximum.
    pub max: f64,
}

impl DistanceStats {
    /// Over these distances (their absolute values), summed in their order; all 0 where there are none.
    pub fn of(distances: impl IntoIterator<Item = f64>) -> DistanceStats {
        let (mut n, mut sum, mut squares, mut max) = (0usize, 0.0, 0.0, 0.0f64);
        for d in distances {
            n += 1;
            sum += d.abs();
            squares += d * d;
            max = max.max(d.abs());
        }
        let n = n.max(1) as f64;
        DistanceStats {
            mean: sum / n,
            rms: (squares / n).sqrt(),
            max,
        }
    }
}

/// What a reduction did.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ReduceReport {
    /// Points in, those that were dropped too.
    pub input_points: usize,
    /// Isolated points that were dropped; 0 where they are kept. All below is about the others.
    pub outliers: usize,
    /// Points out.
    pub output_points: usize,
    /// Sub-domains that were clustered or kept.
    pub cells: usize,
    /// Sweeps of steps (b) and (c); the most that any sub-domain took.
    pub iterations: usize,
    /// J of eq. 1 over the whole cloud, in squared diagonals.
    pub objective: f64,
    /// The validity index χ of eq. 7 over the whole cloud; 0 where it is not defined: one centre, or two at one place.
    pub validity: f64,
    /// How even the result's spacing is: standard deviation over mean of nearest-neighbour distance by wanted spacing.
    pub evenness: f64,
    /// Estimated standard deviation of the noise along the normal.
    pub noise: f64,
    /// Points that the paper calls typical data with sharp feature, kept as they are.
    pub sharp_points: usize,
    /// From the input points to the reduced surface ([`crate::reduce::height_field`]).
    pub distance: DistanceStats,
    /// Milliseconds by stage.
    pub ms: StageTimes,
    /// Milliseconds of the whole job.
    pub total_ms: f64,
    /// Largest memory of the job in bytes: the wasm memory's size, or 0 where it is not known.
    pub peak_memory_bytes: u64,
    /// `"single"`, `"threads"` or `"native"`.
    pub build: String,
    /// Threads that took part.
    pub threads: usize,
    /// Why the result is not what was asked to the letter (a target out of reach, a fallback); empty where it is.
    pub reason: String,
    /// What may not be as it should.
    pub doubts: Vec<Doubt>,
}

/// What a simplification did.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct LightReport {
    /// Triangles that there were.
    pub from: usize,
    /// Triangles that are left.
    pub triangles: usize,
    /// Distance between both meshes, a fraction of the diagonal: from the vertices and triangles' middles of each to the other.
    pub error: DistanceStats,
    /// Connected components.
    pub components: usize,
    /// Edges with one triangle.
    pub boundary_edges: usize,
    /// Edges with more than two triangles.
    pub non_manifold_edges: usize,
    /// Genus of each component, the largest component first.
    pub genus: Vec<i64>,
    /// Triangles that cross others.
    pub self_intersections: usize,
    /// Why there are more triangles than were asked for; empty where there are not.
    pub reason: String,
}

/// What a reconstruction did: all of [`ReduceReport`] (`distance` is then from the input points to the mesh), and:
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct SurfaceReport {
    /// The reduction's fields, beside the others in JS; times and memory are those of the whole job.
    #[serde(flatten)]
    pub reduce: ReduceReport,
    /// Triangles of the mesh.
    pub triangles: usize,
    /// Connected components of the mesh.
    pub components: usize,
    /// Edges with one triangle.
    pub boundary_edges: usize,
    /// Edges with more than two triangles: 0.
    pub non_manifold_edges: usize,
    /// Genus of each component, the largest component first ([`Topology::genus`]).
    pub genus: Vec<i64>,
    /// Holes that were closed and rims that were left open, the widest first.
    pub holes: Vec<Hole>,
    /// Triangles that cross others, after what could be mended was.
    pub self_intersections: usize,
    /// Input points that the mesh leaves out, as there is no surface through them: foliage, dust, filled volumes.
    pub scatter: usize,
    /// Sub-domains that were split and fitted again.
    pub refinements: usize,
    /// Residual of the joined field at the input points.
    pub residual: DistanceStats,
    /// Share of the input points (0-1) whose residual is beyond the accuracy asked for.
    pub beyond_accuracy: f64,
    /// Energy of the chosen signs ([`crate::orient`]): −1 where all local functions agree, 1 where none do.
    pub orientation_energy: f64,
    /// The same before conflicts were solved over the whole graph.
    pub orientation_energy_before: f64,
    /// What decided which side is out.
    pub orientation: OrientationReport,
    /// With `triangles`, what that cost. Counts above are of the mesh with the fewer triangles, distances from the points those of the
    /// surface before: with [`LightReport::error`] added, they bound those of the mesh.
    #[cfg(feature = "light")]
    pub simplified: Option<LightReport>,
}
