//! Meshes with fewer triangles: any mesh, and the surface of a reconstruction.

use crate::base::error::Result;
use crate::base::progress::Progress;
use crate::cloud::{Attribute, Cloud};
use crate::light::{self, Painted, SimplifyParams};
use crate::pipeline::results::Surface;
use crate::report::LightReport;
use crate::texture::{self, Paint, Scan, TextureParams, Textured};
use glam::Vec3;

/// Takes any list of triangles to fewer of them. `cloud` holds the vertices with what they carry, `indices` three a triangle. The
/// result is in the cloud's unit frame.
///
/// # Errors
/// [`crate::Error::BadOption`], [`crate::Error::BadLength`], [`crate::Error::BadIndex`], [`crate::Error::Degenerate`] (no triangle has an
/// area), [`crate::Error::Cancelled`].
pub fn simplify(
    cloud: &Cloud,
    indices: &[u32],
    params: &SimplifyParams,
    progress: &mut dyn Progress,
) -> Result<(Painted, LightReport)> {
    params.validate()?;
    light::simplify(&light::weld(cloud, indices)?, params, progress)
}

/// Textures a mesh, of `triangles` at most where they are given, with what is lost of it and with what a scan shows: `points` in
/// the caller's frame, and the colours or values of each. The report says what fewer triangles cost.
///
/// # Errors
/// Those of [`simplify`]; [`crate::Error::BadOption`] for a size out of range, or too small for so many triangles; [`crate::Error::BadLength`].
pub fn texture(
    mesh: (&Cloud, &[u32]),
    scan: (&[f64], Paint),
    triangles: Option<usize>,
    params: &TextureParams,
    progress: &mut dyn Progress,
) -> Result<(Textured, Option<LightReport>)> {
    let ((cloud, indices), (points, paint)) = (mesh, scan);
    let mut full = light::weld(cloud, indices)?;
    if full.mesh.normals.is_empty() {
        full.mesh.normals = light::normals(&full.mesh);
    }
    let (light, report) = match triangles {
        None => (full.clone(), None),
        Some(_) => {
            let fewer = SimplifyParams {
                triangles,
                error: None,
            };
            let (light, report) = light::simplify(&full, &fewer, progress)?;
            (light, Some(report))
        }
    };
    let frame = &cloud.frame;
    let unit = |p: &[f64]| {
        Vec3::from([0, 1, 2].map(|a| ((p[a] - frame.center[a]) / frame.diagonal) as f32))
    };
    let points: Vec<Vec3> = points.chunks_exact(3).map(unit).collect();
    let scan = Scan {
        points: &points,
        paint,
    };
    let textured = texture::bake(&full.mesh, &light, scan, params, progress)?;
    Ok((textured, report))
}

/// The name under which distances travel among attributes.
const DISTANCES: &str = "";

/// A surface with at most so many triangles, and its report told of them.
pub(crate) fn lighten(
    mut surface: Surface,
    triangles: usize,
    progress: &mut dyn Progress,
) -> Result<Surface> {
    let mut attributes = std::mem::take(&mut surface.attributes);
    if let Some(distances) = &mut surface.distances {
        attributes.push(Attribute {
            name: DISTANCES.into(),
            values: std::mem::take(&mut distances.vertices),
        });
    }
    let full = Painted {
        mesh: std::mem::take(&mut surface.mesh),
        colors: surface.colors.take(),
        attributes,
    };
    let params = SimplifyParams {
        triangles: Some(triangles),
        error: None,
    };
    let (light, told) = light::simplify(&full, &params, progress)?;
    surface.mesh = light.mesh;
    surface.colors = light.colors;
    surface.attributes = light.attributes;
    if let Some(distances) = &mut surface.distances {
        distances.vertices = surface
            .attributes
            .pop()
            .map(|a| a.values)
            .unwrap_or_default();
    }
    let report = &mut surface.report;
    report.triangles = told.triangles;
    report.components = told.components;
    report.boundary_edges = told.boundary_edges;
    report.non_manifold_edges = told.non_manifold_edges;
    report.genus = told.genus.clone();
    report.self_intersections = told.self_intersections;
    report.simplified = Some(told);
    Ok(surface)
}
