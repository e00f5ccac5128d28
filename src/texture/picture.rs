//! PNG files.

use super::fill::Pixel;
use crate::base::error::{Error, Result};

/// 8 bits, three channels.
///
/// # Errors
/// [`Error::Internal`].
pub(super) fn png(pixels: &[Pixel], [width, height]: [usize; 2]) -> Result<Vec<u8>> {
    let bytes: Vec<u8> = pixels
        .as_flattened()
        .iter()
        .map(|x| x.round() as u8)
        .collect();
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    let failed = |error: png::EncodingError| Error::Internal(format!("no PNG: {error}"));
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&bytes).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(file)
}
