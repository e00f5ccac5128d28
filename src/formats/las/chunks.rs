//! The chunks of a LAZ file, so that parts of it can be read apart.

use super::super::format::Format;
use super::super::input::{Input, Place};
use super::header::Header;
use super::laz::Laz;
use crate::base::error::Result;

/// Points and bytes of each chunk. `head` is the file up to its first point, the eight bytes there with the place right behind them, and
/// the table of the chunks; `size` is that of the file. `None` where points are not in chunks that can be read each for itself.
///
/// # Errors
/// [`crate::Error::BadFile`], [`crate::Error::UnsupportedFile`].
pub fn chunks(head: &[u8], size: u64) -> Result<Option<Vec<(u64, u64)>>> {
    let input = Input::new(head, Format::Las, size, true, Place::default());
    let header = Header::read(&input)?;
    if !header.packed || header.points == 0 {
        return Ok(None);
    }
    Ok(Laz::open(&header, &input)?.chunks_of(header.points))
}
