//! Which reader a format has.

use super::faces::FaceMode;
use super::faces::triangles::Faces;
use super::format::Format;
use super::options::ReadOptions;
use super::parser::Parser;
#[cfg(feature = "files")]
use super::{grid, obj, off, pcd, ply, ptx, splats, stl, xyz};
use crate::base::error::Result;

/// The reader of a format; an error in a build that has it not.
#[cfg_attr(
    not(any(
        feature = "e57",
        feature = "files",
        feature = "las",
        feature = "packed"
    )),
    expect(
        unreachable_code,
        reason = "builds of writers and pictures have no reader"
    )
)]
pub(super) fn parser(format: Format, options: &ReadOptions) -> Result<Box<dyn Parser>> {
    let faces = || (options.faces != FaceMode::Vertices).then(Faces::default);
    Ok(match format {
        #[cfg(feature = "files")]
        Format::Ply => Box::new(ply::Ply::new(faces())),
        #[cfg(feature = "files")]
        Format::Xyz => Box::new(xyz::Xyz::new(options)),
        #[cfg(feature = "files")]
        Format::Pcd => Box::new(pcd::Pcd::default()),
        #[cfg(feature = "files")]
        Format::Obj => Box::new(obj::Obj::new(faces())),
        #[cfg(feature = "files")]
        Format::Off => Box::new(off::Off::new(faces())),
        #[cfg(feature = "files")]
        Format::Stl => Box::new(stl::Stl::new(faces())),
        #[cfg(feature = "files")]
        Format::Ptx => Box::new(ptx::Ptx::new(options)),
        #[cfg(feature = "files")]
        Format::Grid => Box::new(grid::Raster::new(options)),
        #[cfg(feature = "files")]
        Format::Splat => Box::new(splats::Splats),
        #[cfg(feature = "packed")]
        Format::Spz => Box::new(super::packed::Spz),
        #[cfg(feature = "packed")]
        Format::Tiff => Box::new(super::packed::Tiff::new(options)),
        #[cfg(feature = "packed")]
        Format::ThreeMf => Box::new(super::packed::ThreeMf::new(faces())),
        #[cfg(feature = "packed")]
        Format::Glb => Box::new(super::glb::Glb::new(
            faces(),
            options.faces == FaceMode::Mesh,
        )),
        #[cfg(feature = "las")]
        Format::Las => Box::new(super::las::Las::default()),
        #[cfg(feature = "e57")]
        Format::E57 => Box::new(super::e57::E57::default()),
        #[cfg(not(all(
            feature = "e57",
            feature = "files",
            feature = "las",
            feature = "packed"
        )))]
        other => {
            return Err(crate::base::error::Error::UnsupportedFile {
                format: other.title(),
                expected: "a build with its reader".into(),
                found: "one without".into(),
            });
        }
    })
}
