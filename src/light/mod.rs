//! A mesh made light: fewer triangles, and how far it is then from what it was.
//!
//! 1. [`weld()`] makes a mesh of any list of triangles.
//! 2. `shrink` collapses edges by quadrics, with what `web` and `quadric` say of the mesh and of its planes.
//! 3. `crossings` of [`crate::mesh`] mends triangles that cross since.
//! 4. `carry` takes normals, colours and scalars from the nearest place of the mesh as it was.
//! 5. Both meshes are measured from each other ([`LightReport::error`]).
//!
//! **In**: a mesh in the unit frame with what its vertices carry, and [`SimplifyParams`]. **Out**: the same with fewer triangles, of the
//! same topology, with creases and borders where they were.
//!
//! **Cost**: `n log n` of the triangles that there are; a second natively for 200,000.

pub(crate) mod carry;
mod painted;
pub(crate) mod quadric;
mod shrink;
mod web;
mod weld;

use crate::base::error::{Error, Result};
use crate::base::progress::{Progress, Silent, Stage};
use crate::mesh::{Mesh, crossings};
use crate::report::distance::mesh_distance;
use crate::report::{DistanceStats, LightReport, Topology, topology};
use glam::{DVec3, Vec3};

pub use painted::Painted;
pub use weld::weld;

/// Tries to keep to a largest distance.
const TRIES: usize = 8;
/// After a try that was too far off, the next is given this share of what would do if the distance were in proportion.
const CAUTION: f64 = 0.9;

/// How light a mesh becomes: one of the two, or both.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SimplifyParams {
    /// At most so many triangles, at least 1. The mesh has at least 98 % of them, or as many as it had.
    pub triangles: Option<usize>,
    /// As few triangles as keep both meshes within this distance of each other, a fraction of the diagonal, above 0 to 1.
    pub error: Option<f64>,
}

impl SimplifyParams {
    /// Checks the ranges, and that one of them is given.
    ///
    /// # Errors
    /// [`Error::BadOption`].
    pub fn validate(&self) -> Result<()> {
        let fits = |error: f64| error > 0.0 && error <= 1.0;
        match (self.triangles, self.error) {
            (None, None) => Err(Error::bad_option(
                "triangles",
                "a number of triangles, or error",
                "neither",
            )),
            (Some(0), _) => Err(Error::bad_option(
                "triangles",
                "an integer of at least 1",
                "0",
            )),
            (_, Some(error)) if !fits(error) => Err(Error::bad_option(
                "error",
                "a number in (0, 1]",
                &error.to_string(),
            )),
            _ => Ok(()),
        }
    }
}

/// A mesh with fewer triangles.
///
/// # Errors
/// [`Error::BadOption`], [`Error::Cancelled`].
pub fn simplify(
    full: &Painted,
    params: &SimplifyParams,
    progress: &mut dyn Progress,
) -> Result<(Painted, LightReport)> {
    params.validate()?;
    let from = full.mesh.triangles.len();
    let most = params.triangles.unwrap_or(0);
    let mut limit = params.error.unwrap_or(f64::INFINITY);
    let mut tries = 0;
    loop {
        let mut tell = |part: f32| progress.update(Stage::Simplify, 0.7 * part);
        let mut mesh = shrink::shrink(&full.mesh, most, limit, &mut tell)?;
        let self_intersections = mend(&mut mesh);
        tell(1.0)?;
        let error = apart(&full.mesh, &mesh)?;
        tries += 1;
        if let Some(wanted) = params.error.filter(|&wanted| error.max > wanted) {
            if tries < TRIES {
                limit *= CAUTION * (wanted / error.max);
                continue;
            }
            return unchanged(full, params);
        }
        let light = carry::carry(full, mesh);
        progress.update(Stage::Simplify, 1.0)?;
        let report = report(from, &light.mesh, (error, self_intersections), most);
        return Ok((light, report));
    }
}

/// The mesh as it was, where nothing less is near enough.
fn unchanged(full: &Painted, params: &SimplifyParams) -> Result<(Painted, LightReport)> {
    let mut light = full.clone();
    let crossings = mend(&mut light.mesh);
    let most = params.triangles.unwrap_or(0);
    let from = full.mesh.triangles.len();
    let report = report(
        from,
        &light.mesh,
        (DistanceStats::default(), crossings),
        most,
    );
    Ok((light, report))
}

/// [`crossings::mend`] of a mesh that may have no normals.
fn mend(mesh: &mut Mesh) -> usize {
    let bare = mesh.normals.is_empty();
    if bare {
        mesh.normals = vec![Vec3::ZERO; mesh.vertices.len()];
    }
    let crossing = crossings::mend(mesh);
    if bare {
        mesh.normals = Vec::new();
    }
    crossing
}

fn report(
    from: usize,
    mesh: &Mesh,
    (error, self_intersections): (DistanceStats, usize),
    most: usize,
) -> LightReport {
    let Topology {
        components,
        boundary_edges,
        non_manifold_edges,
        genus,
        ..
    } = topology(&mesh.triangles, mesh.vertices.len());
    let triangles = mesh.triangles.len();
    let reason = match most {
        1.. if triangles > most => format!(
            "{triangles} triangles are left of {from}, not {most}: fewer would tear the surface or go beyond the error"
        ),
        _ => String::new(),
    };
    LightReport {
        from,
        triangles,
        error,
        components,
        boundary_edges,
        non_manifold_edges,
        genus,
        self_intersections,
        reason,
    }
}

/// Distances between two meshes, both ways.
fn apart(full: &Mesh, light: &Mesh) -> Result<DistanceStats> {
    let one_way = |of: &Mesh, to: &Mesh| {
        let middle = |t: &[u32; 3]| t.iter().map(|&v| of.vertices[v as usize]).sum::<Vec3>() / 3.0;
        let mut places = of.vertices.clone();
        places.extend(of.triangles.iter().map(middle));
        mesh_distance(&places, &to.vertices, &to.triangles, &mut Silent)
    };
    let (there, back) = (one_way(full, light)?, one_way(light, full)?);
    Ok(DistanceStats {
        mean: there.mean.max(back.mean),
        rms: there.rms.max(back.rms),
        max: there.max.max(back.max),
    })
}

/// Unit normals of the vertices: the mean of their triangles', weighted by area.
pub fn normals(mesh: &Mesh) -> Vec<Vec3> {
    let mut sums = vec![DVec3::ZERO; mesh.vertices.len()];
    for &triangle in &mesh.triangles {
        let cross = mesh.cross(triangle);
        triangle.iter().for_each(|&v| sums[v as usize] += cross);
    }
    let unit = |sum: DVec3| sum.normalize_or(DVec3::Z).as_vec3();
    sums.into_iter().map(unit).collect()
}
