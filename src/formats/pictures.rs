//! Pictures of textures: PNG, JPEG and WebP, by crates that give the same pixels everywhere.

use super::faces::Picture;

/// The pixels of a file's bytes; `None` where they are of another kind, or damaged, or more than 2²⁸ bytes.
#[cfg(feature = "pictures")]
pub fn decode(bytes: &[u8]) -> Option<Picture> {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => png(bytes),
        [0xff, 0xd8, ..] => jpeg(bytes),
        [b'R', b'I', b'F', b'F', ..] => webp(bytes),
        _ => None,
    }
}

/// This build has no decoder.
#[cfg(not(feature = "pictures"))]
pub fn decode(_: &[u8]) -> Option<Picture> {
    None
}

/// A picture takes no more memory than this, whatever its header says.
#[cfg(feature = "pictures")]
const MOST_BYTES: usize = 1 << 28;

#[cfg(feature = "pictures")]
fn png(bytes: &[u8]) -> Option<Picture> {
    use png::{ColorType, Decoder, Limits, Transformations};
    let mut decoder =
        Decoder::new_with_limits(std::io::Cursor::new(bytes), Limits { bytes: MOST_BYTES });
    decoder.set_transformations(Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().ok()?;
    let size = reader
        .output_buffer_size()
        .filter(|&size| size <= MOST_BYTES)?;
    let mut content = vec![0; size];
    let info = reader.next_frame(&mut content).ok()?;
    content.truncate(info.buffer_size());
    let pixels = match info.color_type {
        ColorType::Rgba => content,
        ColorType::Rgb => rgba(&content, |&[r, g, b]| [r, g, b, 255]),
        ColorType::GrayscaleAlpha => rgba(&content, |&[l, a]| [l, l, l, a]),
        ColorType::Grayscale => rgba(&content, |&[l]| [l, l, l, 255]),
        ColorType::Indexed => return None,
    };
    Picture::new(info.width as usize, info.height as usize, pixels)
}

#[cfg(feature = "pictures")]
fn jpeg(bytes: &[u8]) -> Option<Picture> {
    use zune_jpeg::JpegDecoder;
    use zune_jpeg::zune_core::bytestream::ZCursor;
    use zune_jpeg::zune_core::colorspace::ColorSpace;
    use zune_jpeg::zune_core::options::DecoderOptions;
    let options = DecoderOptions::default()
        .jpeg_set_out_colorspace(ColorSpace::RGB)
        .set_max_width(1 << 15)
        .set_max_height(1 << 15)
        .set_use_unsafe(false);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().ok()?;
    decoder
        .output_buffer_size()
        .filter(|&size| size <= MOST_BYTES)?;
    let content = decoder.decode().ok()?;
    let (width, height) = decoder.dimensions()?;
    Picture::new(width, height, rgba(&content, |&[r, g, b]| [r, g, b, 255]))
}

#[cfg(feature = "pictures")]
fn webp(bytes: &[u8]) -> Option<Picture> {
    let mut decoder = image_webp::WebPDecoder::new(std::io::Cursor::new(bytes)).ok()?;
    decoder.set_memory_limit(MOST_BYTES);
    let (width, height) = decoder.dimensions();
    let size = decoder
        .output_buffer_size()
        .filter(|&size| size <= MOST_BYTES)?;
    let mut content = vec![0; size];
    decoder.read_image(&mut content).ok()?;
    let pixels = match decoder.has_alpha() {
        true => content,
        false => rgba(&content, |&[r, g, b]| [r, g, b, 255]),
    };
    Picture::new(width as usize, height as usize, pixels)
}

/// Pixels of some bytes each as red, green, blue and alpha.
#[cfg(feature = "pictures")]
fn rgba<const N: usize>(content: &[u8], pixel: impl Fn(&[u8; N]) -> [u8; 4]) -> Vec<u8> {
    let (pixels, _) = content.as_chunks::<N>();
    pixels.iter().flat_map(pixel).collect()
}
