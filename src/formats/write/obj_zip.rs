//! Wavefront OBJ with what a textured mesh needs beside it, in one ZIP archive: `model.obj`, `model.mtl` and the pictures as PNG files.

use super::glb::check_finite;
use super::obj;
use super::pictures::expect_png;
use super::zip::{Packing, archive};
use crate::base::error::Result;
use crate::formats::raw_cloud::RawCloud;

/// Without pictures the archive has the OBJ file alone.
///
/// # Errors
/// [`crate::Error::NonFinite`]; [`crate::Error::BadOption`] for pictures that are no PNG files.
pub(super) fn write(cloud: &RawCloud, triangles: Option<&[u32]>) -> Result<Vec<u8>> {
    let skin = cloud.skin().filter(|_| triangles.is_some());
    if let Some(skin) = skin {
        check_finite("uvs", &skin.uvs, 2)?;
        expect_png(skin)?;
    }
    let model = obj::write(cloud, triangles, skin.map(|skin| (skin, "model.mtl")));
    let mut library = String::from("# Pointweave\nnewmtl scan\nKd 1 1 1\nKs 0 0 0\nd 1\nillum 1\n");
    let mut files: Vec<(&str, &[u8])> = vec![("model.obj", &model)];
    if let Some(skin) = skin {
        let pictures = [
            ("color.png", &skin.color, "map_Kd color.png\n"),
            ("normal.png", &skin.normal, "norm normal.png\n"),
            (
                "occlusion.png",
                &skin.occlusion,
                "Ka 1 1 1\nmap_Ka occlusion.png\n",
            ),
        ];
        for (name, png, line) in pictures {
            if let Some(png) = png {
                library.push_str(line);
                files.push((name, png));
            }
        }
        files.insert(1, ("model.mtl", library.as_bytes()));
    }
    Ok(archive(&files, Packing::Deflated))
}
