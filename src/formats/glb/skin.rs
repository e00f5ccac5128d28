//! The pictures of a mesh that has one material.

use super::super::faces::looks::Wrap;
use super::super::faces::triangles::Source;
use super::super::input::Input;
use super::super::raw_cloud::Skin;
use super::accessor::Accessor;
use super::materials::{image_source, texture_of};
use super::scene::{Document, Placed, TextureUse};
use crate::base::error::Result;

/// Pictures as they are, where they lie in the file by the first set of places, and nothing else colours the mesh.
pub(super) fn of(
    part: &Placed,
    document: &Document,
    buffer: &[u8],
    input: &Input,
) -> Result<Option<Skin>> {
    let attributes = &part.primitive.attributes;
    let material = part
        .primitive
        .material
        .and_then(|i| document.materials.get(i));
    let (Some(material), Some(&places)) = (material, attributes.get("TEXCOORD_0")) else {
        return Ok(None);
    };
    let pbr = &material.pbr_metallic_roughness;
    let factor = pbr.base_color_factor.unwrap_or([1.0; 4]);
    let plain = factor[..3] == [1.0; 3]
        && material.extensions.specular.is_none()
        && !attributes.contains_key("COLOR_0");
    let places = Accessor::open(document, places, buffer, input)?;
    let uvs: Vec<f32> = (0..places.count)
        .flat_map(|i| places.values(i).map(|x| x as f32).into_iter().take(2))
        .collect();
    let inside = uvs.iter().all(|x| (0.0..=1.0).contains(x));
    let picture = |wanted: &Option<TextureUse>| {
        let wanted = wanted.as_ref()?;
        let moved = wanted.tex_coord != 0 || wanted.extensions.transform.is_some();
        let texture = texture_of(wanted, document).filter(|_| !moved)?;
        if texture.wrap != [Wrap::Clamp; 2] && !inside {
            return None;
        }
        match image_source(&document.images[texture.picture], document, buffer) {
            Source::Packed(bytes) => Some(bytes),
            _ => None,
        }
    };
    let color = picture(&pbr.base_color_texture);
    if !plain || color.is_some() != pbr.base_color_texture.is_some() {
        return Ok(None);
    }
    let tangents = match attributes.get("TANGENT") {
        Some(&index) => {
            let tangents = Accessor::open(document, index, buffer, input)?;
            let turned = |i: usize| {
                let [x, y, z, w] = tangents.values(i);
                let [x, y, z] = part.transform.direction([x, y, z]);
                let w = if part.transform.mirrors() { -w } else { w };
                [x, y, z, w].map(|x| x as f32)
            };
            let same = tangents.count == places.count;
            same.then(|| (0..tangents.count).flat_map(turned).collect())
        }
        None => None,
    };
    let normal = picture(&material.normal_texture);
    let occlusion = picture(&material.occlusion_texture);
    let any = color.is_some() || normal.is_some() || occlusion.is_some();
    Ok(any.then_some(Skin {
        uvs,
        tangents,
        color,
        normal,
        occlusion,
    }))
}
