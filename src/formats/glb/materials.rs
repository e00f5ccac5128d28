//! Colours of materials: the base colour's factor, texture, its transform and sampler.

use super::super::faces::looks::{Look, Texture, Wrap};
use super::super::faces::triangles::{Faces, Source};
use super::accessor::within;
use super::scene::{Document, Image, Material, TextureSource, TextureUse};

/// What the materials need of the texture's places: which set, and how it is moved.
pub(super) struct Placing {
    pub(super) set: usize,
    matrix: [[f64; 3]; 2],
}

impl Placing {
    pub(super) fn place(&self, [u, v, _]: [f64; 3]) -> [f32; 2] {
        self.matrix
            .map(|row| (row[0] * u + row[1] * v + row[2]) as f32)
    }
}

/// Adds a look for each material and the pictures; gives where each look's texture lies.
pub(super) fn looks(document: &Document, buffer: &[u8], faces: &mut Faces) -> Vec<Option<Placing>> {
    let picture = |image: &Image| image_source(image, document, buffer);
    faces.pictures = document.images.iter().map(picture).collect();
    let mut used = vec![false; faces.pictures.len()];
    let look = |material: &Material| {
        let pbr = &material.pbr_metallic_roughness;
        let (factor, texture) = match &material.extensions.specular {
            Some(specular) => (specular.diffuse_factor, &specular.diffuse_texture),
            // A body that is black and shines: scans whose light is in their texture.
            None if material.only_shines() => {
                let [r, g, b] = material.emissive_factor;
                (Some([r, g, b, 1.0]), &material.emissive_texture)
            }
            None => (pbr.base_color_factor, &pbr.base_color_texture),
        };
        let found = texture
            .as_ref()
            .and_then(|texture| texture_of(texture, document));
        if let Some(found) = &found {
            used[found.picture] = true;
        }
        faces.looks.push(Look {
            factor: factor.map(|[r, g, b, _]| [r, g, b]),
            cutoff: (material.alpha_mode == "MASK").then(|| material.alpha_cutoff.unwrap_or(0.5)),
            linear: true,
            texture: found,
        });
        texture.as_ref().map(placing)
    };
    let placings = document.materials.iter().map(look).collect();
    // Pictures of normals and of roughness are not looked at.
    for (source, used) in faces.pictures.iter_mut().zip(used) {
        if !used {
            *source = Source::Missing;
        }
    }
    placings
}

pub(super) fn texture_of(texture: &TextureUse, document: &Document) -> Option<Texture> {
    let entry = document.textures.get(texture.index)?;
    // A picture of a kind that is not read is one that is missing.
    let of = |other: &Option<TextureSource>| other.as_ref().and_then(|other| other.source);
    let picture = of(&entry.extensions.webp)
        .or(entry.source)
        .or(of(&entry.extensions.basis))
        .or(of(&entry.extensions.avif))
        .filter(|&i| i < document.images.len())?;
    let sampler = entry.sampler.and_then(|i| document.samplers.get(i));
    let wrap = |code: Option<u32>| match code {
        Some(33071) => Wrap::Clamp,
        Some(33648) => Wrap::Mirror,
        _ => Wrap::Repeat,
    };
    Some(Texture {
        wrap: sampler.map_or([Wrap::Repeat; 2], |s| [wrap(s.wrap_s), wrap(s.wrap_t)]),
        nearest: sampler.is_some_and(|sampler| sampler.mag_filter == Some(9728)),
        ..Texture::of(picture)
    })
}

/// The set of places and its transform: `translation · rotation · scale` (KHR_texture_transform).
fn placing(texture: &TextureUse) -> Placing {
    let Some(transform) = &texture.extensions.transform else {
        return Placing {
            set: texture.tex_coord,
            matrix: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        };
    };
    let [sx, sy] = transform.scale.unwrap_or([1.0; 2]);
    let (sin, cos) = (libm::sin(transform.rotation), libm::cos(transform.rotation));
    let [x, y] = transform.offset;
    Placing {
        set: transform.tex_coord.unwrap_or(texture.tex_coord),
        matrix: [[cos * sx, sin * sy, x], [-sin * sx, cos * sy, y]],
    }
}

pub(super) fn image_source(image: &Image, document: &Document, buffer: &[u8]) -> Source {
    if let Some(view) = image.buffer_view.and_then(|i| document.buffer_views.get(i)) {
        let bytes = Some(view)
            .filter(|view| view.buffer == 0)
            .and_then(|view| within(view, 0, buffer));
        return bytes.map_or(Source::Missing, |bytes| Source::Packed(bytes.to_vec()));
    }
    match &image.uri {
        Some(uri) if uri.starts_with("data:") => {
            let content = uri
                .split_once(";base64,")
                .and_then(|(_, text)| from_base64(text));
            content.map_or(Source::Missing, Source::Packed)
        }
        Some(uri) => Source::Beside(from_percent(uri)),
        None => Source::Missing,
    }
}

/// RFC 4648; `None` for other characters.
fn from_base64(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut held) = (0u32, 0);
    for c in text.bytes().filter(|&c| c != b'=') {
        let value = match c {
            b'A'..=b'Z' => c - b'A',
            b'a'..=b'z' => c - b'a' + 26,
            b'0'..=b'9' => c - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return None,
        };
        bits = bits << 6 | u32::from(value);
        held += 6;
        if held >= 8 {
            held -= 8;
            bytes.push((bits >> held) as u8);
        }
    }
    Some(bytes)
}

/// A name with `%20` and its like.
fn from_percent(uri: &str) -> String {
    let bytes = uri.as_bytes();
    let mut name = Vec::with_capacity(bytes.len());
    let mut at = 0;
    while at < bytes.len() {
        let code = bytes
            .get(at + 1..at + 3)
            .and_then(|hex| std::str::from_utf8(hex).ok());
        match code.and_then(|hex| u8::from_str_radix(hex, 16).ok()) {
            Some(byte) if bytes[at] == b'%' => {
                name.push(byte);
                at += 3;
            }
            _ => {
                name.push(bytes[at]);
                at += 1;
            }
        }
    }
    String::from_utf8_lossy(&name).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_uris() {
        assert_eq!(from_base64("UG9pbnQ=").as_deref(), Some(&b"Point"[..]));
        assert_eq!(from_base64("a!"), None);
        assert_eq!(from_percent("my%20scan%2.png"), "my scan%2.png");
    }
}
