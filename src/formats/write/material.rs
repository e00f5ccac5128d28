//! The material of a GLB file, and its pictures.

use super::pictures::{Kind, kind};
use crate::base::error::Result;
use crate::formats::raw_cloud::Skin;

/// What the JSON says of pictures.
#[derive(Default)]
pub(super) struct Material {
    pub(super) color: String,
    pub(super) normal: String,
    pub(super) occlusion: String,
    images: Vec<String>,
    textures: Vec<String>,
    /// What the file needs for them.
    pub(super) extensions: Vec<&'static str>,
}

impl Material {
    /// Takes the pictures; `store` puts bytes into the file and gives the view's index.
    pub(super) fn wear(
        &mut self,
        skin: &Skin,
        store: &mut dyn FnMut(&[u8]) -> usize,
    ) -> Result<()> {
        if let Some(bytes) = &skin.color {
            let index = self.picture(bytes, store)?;
            self.color = format!("\"baseColorTexture\":{{\"index\":{index}}},");
        }
        if let Some(bytes) = &skin.normal {
            let index = self.picture(bytes, store)?;
            self.normal = format!("\"normalTexture\":{{\"index\":{index}}},");
        }
        if let Some(bytes) = &skin.occlusion {
            let index = self.picture(bytes, store)?;
            self.occlusion = format!("\"occlusionTexture\":{{\"index\":{index}}},");
        }
        Ok(())
    }

    fn picture(&mut self, bytes: &[u8], store: &mut dyn FnMut(&[u8]) -> usize) -> Result<usize> {
        let Kind { mime, extension } = kind(bytes)?;
        let view = store(bytes);
        let source = self.images.len();
        self.images
            .push(format!("{{\"bufferView\":{view},\"mimeType\":\"{mime}\"}}"));
        let source = match extension {
            Some(name) => format!("\"extensions\":{{\"{name}\":{{\"source\":{source}}}}}"),
            None => format!("\"source\":{source}"),
        };
        self.textures.push(format!("{{{source},\"sampler\":0}}"));
        self.extensions
            .extend(extension.filter(|name| !self.extensions.contains(name)));
        Ok(self.images.len() - 1)
    }

    /// The lists of images and textures; nothing without any.
    pub(super) fn pictures(&self) -> String {
        if self.images.is_empty() {
            return String::new();
        }
        format!(
            "\"images\":[{}],\"textures\":[{}],\"samplers\":[{{\"magFilter\":9729,\"minFilter\":9987,\"wrapS\":33071,\"wrapT\":33071}}],",
            self.images.join(","),
            self.textures.join(",")
        )
    }
}
