//! Parts of a surface that are better not relied on: walls as thin as the spacing of the points, and area that no point supports.

use crate::fit::cells::Sites;
use crate::mesh::Mesh;

/// Thickness of a wall that is known, in spacings and in standard deviations of the noise.
const KNOWN: (f32, f32) = (1.3, 6.0);
/// Area is invented where it is farther from all points than this many times their spacing, and this share of the diagonal.
const FAR: (f32, f32) = (4.4, 0.02);

/// Share of the points whose wall is too thin for what is known of it.
pub(crate) fn thin(sites: &Sites, noise: f32) -> f64 {
    let walls = sites.across.iter().zip(&sites.spacing);
    let is_thin = |&(d, &spacing): &(&glam::Vec3, &f32)| {
        let thickness = d.length();
        thickness > 0.0 && thickness < (KNOWN.0 * spacing).max(KNOWN.1 * noise)
    };
    walls.filter(is_thin).count() as f64 / sites.spacing.len() as f64
}

/// Share of the area that is far from all points.
pub(crate) fn invented(mesh: &Mesh, sites: &Sites) -> f64 {
    let at = |v: u32| mesh.vertices[v as usize];
    let (mut all, mut far) = (0.0, 0.0);
    for &triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(at);
        let area = f64::from((b - a).cross(c - a).length());
        let near = sites.tree.nearest((a + b + c) / 3.0);
        let spacing = sites.spacing[near.index as usize];
        all += area;
        if near.distance2.sqrt() > (FAR.0 * spacing).max(FAR.1) {
            far += area;
        }
    }
    if all > 0.0 { far / all } else { 0.0 }
}
