//! Formats whose content is packed as a whole: ZIP and gzip archives, and those that are archives inside.

mod archive;
mod raster;
mod splats;
mod threemf;

pub use archive::{Archive, Entry};
pub(super) use raster::Tiff;
pub(super) use splats::Spz;
pub(super) use threemf::ThreeMf;
