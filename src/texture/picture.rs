//! PNG files.

use crate::base::error::{Error, Result};
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError};

/// A file of 8 bits a channel.
///
/// # Errors
/// [`Error::Internal`].
pub(crate) fn png(bytes: &[u8], [width, height]: [usize; 2], color: ColorType) -> Result<Vec<u8>> {
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, width as u32, height as u32);
    encoder.set_color(color);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    let failed = |error: EncodingError| Error::Internal(format!("no PNG: {error}"));
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(bytes).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(file)
}
