//! Parts of a surface that are better not relied on: walls as thin as the spacing of the points, and area that no point supports.

use crate::base::par;
use crate::fit::cells::Sites;
use crate::mesh::Mesh;
use glam::Vec3;

/// Thickness of a wall that is known, in spacings and in standard deviations of the noise.
const KNOWN: (f32, f32) = (1.3, 6.0);
/// Area is invented where it is farther from all points than this many times their spacing, and this share of the diagonal.
const FAR: (f32, f32) = (4.4, 0.02);

/// Share of the points whose wall is too thin for what is known of it.
pub(crate) fn thin(sites: &Sites, noise: f32) -> f64 {
    let walls = sites.across.iter().zip(&sites.spacing);
    let is_thin = |&(d, &spacing): &(&Vec3, &f32)| {
        let thickness = d.length();
        thickness > 0.0 && thickness < (KNOWN.0 * spacing).max(KNOWN.1 * noise)
    };
    walls.filter(is_thin).count() as f64 / sites.spacing.len() as f64
}

/// Share of the area that is far from all points.
pub(crate) fn invented(mesh: &Mesh, sites: &Sites) -> f64 {
    let areas = par::map(
        mesh.triangles.len(),
        || (),
        |t, ()| {
            let [a, b, c] = mesh.triangles[t].map(|v| mesh.vertices[v as usize]);
            let area = f64::from((b - a).cross(c - a).length());
            let center = (a + b + c) / 3.0;
            (area, is_far(center, sites))
        },
    );
    let all: f64 = areas.iter().map(|(area, _)| area).sum();
    let far: f64 = areas.iter().filter(|(_, is)| *is).map(|(a, _)| a).sum();
    if all > 0.0 { far / all } else { 0.0 }
}

fn is_far(p: Vec3, sites: &Sites) -> bool {
    // Mostly some site is near enough whatever its spacing, and no nearest one is looked for.
    if sites.tree.has_nearer(p, FAR.1) {
        return false;
    }
    let near = sites.tree.nearest(p);
    let spacing = sites.spacing[near.index as usize];
    near.distance2.sqrt() > (FAR.0 * spacing).max(FAR.1)
}
