//! Normals of the full mesh in the frames of the light one.

use super::color::normal;
use super::fill::Pixel;
use super::texels::{Texels, mix};
use crate::base::error::Result;
use crate::light::carry::Spot;
use crate::mesh::Mesh;
use glam::{DMat3, DVec3};

/// Least height of a normal over the light mesh: one that lies flatter, or looks through it, is taken for this.
const LEAST: f64 = 0.05;

/// What each texel's normal is as a colour: 0 to 255 for -1 to 1.
pub(super) fn bake(
    texels: &Texels,
    spots: &[Spot],
    full: &Mesh,
    (light, tangents): (&Mesh, &[[f32; 4]]),
    progress: &mut dyn FnMut(f32) -> Result<()>,
) -> Result<Vec<Option<Pixel>>> {
    progress(0.0)?;
    let mut pixels = vec![None; texels.size[0] * texels.size[1]];
    for (texel, spot) in texels.all.iter().zip(spots) {
        let out = normal(light, &texel.on);
        let tangent = mix(light, &texel.on, |v| {
            let [x, y, z, _] = tangents[v].map(f64::from);
            DVec3::new(x, y, z)
        });
        let sign = f64::from(tangents[light.triangles[texel.on.triangle as usize][0] as usize][3]);
        let tangent = tangent.normalize_or(out.any_orthonormal_vector());
        let bitangent = (out.cross(tangent) * sign).normalize_or_zero();
        // What shaders do with the colour, undone.
        let frame = DMat3::from_cols(tangent, bitangent, out);
        let told = frame.inverse() * normal(full, spot);
        let told = told.with_z(told.z.max(LEAST)).try_normalize();
        let told = told.filter(|told| told.is_finite()).unwrap_or(DVec3::Z);
        let color = (told * 127.5 + 127.5).to_array().map(|x| x as f32);
        pixels[texel.pixel as usize] = Some(color);
    }
    progress(1.0)?;
    Ok(pixels)
}
