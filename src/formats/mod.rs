//! Files: bytes to a [`RawCloud`], and results back to bytes. The paper starts from points in memory and has no such section.
//!
//! 1. [`detect()`] tells the [`Format`] by the first bytes, then by the name.
//! 2. A `parser`, one file a format, takes the bytes slice by slice and gives a [`Block`] of points when it has one. What parsers
//!    share is in `input` (bytes with their place), `text`, `table` (columns of numbers) and `colors`.
//! 3. Points that measure nothing are left out (`sentinels`); faces become points that lie evenly on them (`faces`, with the
//!    colours of their `pictures`); where the points were seen from goes along (`stations`).
//! 4. [`Reading`] drives these, and says what it met in a [`Summary`]. [`read`] is that for a file that is wholly in memory.
//! 5. `write` makes a file of a cloud or a mesh: [`write()`].
//!
//! **In**: bytes, from strangers. A reader returns a right result or a typed error that names the line or byte, never panics, and
//! never reserves memory on the word of a header: only what the bytes that are really there can fill. **Out**: positions in the
//! file's frame and unit, `f32` or `f64` as the file has them; colours from 0 to 255; normals of any length; up, unit and
//! reference system where the format or the file says them.
//!
//! **Cost**: linear in the bytes. Where the format allows it, neither the file nor its points are in memory at once.

// A build with one feature's readers leaves parts unused of what they share.
#![cfg_attr(
    not(all(
        feature = "e57",
        feature = "files",
        feature = "las",
        feature = "packed"
    )),
    allow(dead_code, unused_variables)
)]

mod block;
mod colors;
mod detect;
#[cfg(feature = "e57")]
mod e57;
mod faces;
#[cfg(feature = "packed")]
mod glb;
#[cfg(feature = "files")]
mod grid;
mod format;
mod input;
#[cfg(feature = "las")]
mod las;
#[cfg(any(feature = "las", feature = "exports"))]
mod las_names;
#[cfg(feature = "files")]
mod lzf;
#[cfg(feature = "files")]
mod obj;
#[cfg(feature = "files")]
mod off;
#[cfg(feature = "files")]
mod pcd;
#[cfg(feature = "files")]
mod ply;
mod pictures;
mod parser;
mod raw_cloud;
mod reading;
mod stations;
mod opening;
mod options;
#[cfg(feature = "packed")]
mod packed;
mod preview;
#[cfg(feature = "files")]
mod ptx;
mod sentinels;
#[cfg(any(feature = "files", feature = "packed"))]
mod splats;
#[cfg(feature = "files")]
mod stl;
mod table;
mod text;
mod write;
#[cfg(feature = "files")]
mod xyz;

use crate::base::error::Result;
pub use block::{Block, ColorValues, Verdict};
pub use detect::detect;
pub use faces::{FaceMode, Picture, Sampling, Want};
pub use format::Format;
#[cfg(feature = "las")]
pub use las::chunks as laz_chunks;
pub use options::ReadOptions;
#[cfg(feature = "packed")]
pub use packed::{Archive, Entry};
pub use pictures::decode as decode_picture;
pub use preview::Preview;
pub use raw_cloud::{Positions, RawCloud, Skin};
pub use reading::{Reading, Summary};
pub use sentinels::LeftOut;
pub use stations::{Run, Stations};
pub use write::{Output, WriteOptions, write};

/// Reads a file that is wholly in memory; of a file with faces its vertices.
///
/// # Errors
/// [`crate::Error::BadFile`] with the line or byte, [`crate::Error::UnsupportedFile`].
pub fn read(bytes: &[u8], format: Format) -> Result<RawCloud> {
    let options = ReadOptions {
        faces: FaceMode::Vertices,
        ..ReadOptions::default()
    };
    read_with(bytes, format, &options)
}

/// [`read`], with what the caller says of the file; of a file with faces points are taken from them unless told otherwise.
///
/// # Errors
/// Those of [`read`], and [`crate::Error::BadOption`].
pub fn read_with(bytes: &[u8], format: Format, options: &ReadOptions) -> Result<RawCloud> {
    read_beside(bytes, format, options, &mut |_| None)
}

/// [`read_with`], where `beside` gives the content of files that faces name: of an OBJ file its material library and pictures.
///
/// # Errors
/// The same.
pub fn read_beside(
    bytes: &[u8],
    format: Format,
    options: &ReadOptions,
    beside: &mut dyn FnMut(&str) -> Option<Vec<u8>>,
) -> Result<RawCloud> {
    Reading::new(Some(format), None, bytes.len() as u64)
        .with_options(options.clone())?
        .whole(bytes, beside)
}
