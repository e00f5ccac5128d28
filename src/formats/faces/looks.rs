//! Pictures and materials.

/// Pixels, the first row at the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Pixels a row, at least 1.
    pub width: usize,
    /// Rows, at least 1.
    pub height: usize,
    /// `r g b a` a pixel, sRGB.
    pub pixels: Vec<u8>,
}

impl Picture {
    /// Pixels of a size; `None` where it is not theirs.
    pub fn new(width: usize, height: usize, pixels: Vec<u8>) -> Option<Picture> {
        let expected = width.checked_mul(height)?.checked_mul(4)?;
        (expected > 0 && pixels.len() == expected).then_some(Picture {
            width,
            height,
            pixels,
        })
    }
}

/// A material, as far as it says colours.
#[derive(Clone, Default)]
pub(in crate::formats) struct Look {
    /// Multiplies the colours, from 0 to 1.
    pub(in crate::formats) factor: Option<[f64; 3]>,
    pub(in crate::formats) texture: Option<Texture>,
    /// Multiplies in linear light, as glTF does; else in the display's scale.
    pub(in crate::formats) linear: bool,
    /// Where the texture's alpha is under it there is no surface.
    pub(in crate::formats) cutoff: Option<f64>,
}

#[derive(Clone)]
pub(in crate::formats) struct Texture {
    /// Which of the pictures.
    pub(in crate::formats) picture: usize,
    pub(in crate::formats) wrap: [Wrap; 2],
    /// The nearest pixel, not a mean of four.
    pub(in crate::formats) nearest: bool,
    /// Places, counted from the lower left corner, are scaled and then moved by these.
    pub(in crate::formats) scale: [f64; 2],
    pub(in crate::formats) offset: [f64; 2],
}

impl Texture {
    /// A picture that repeats, as it is.
    pub(in crate::formats) fn of(picture: usize) -> Texture {
        Texture {
            picture,
            wrap: [Wrap::Repeat; 2],
            nearest: false,
            scale: [1.0; 2],
            offset: [0.0; 2],
        }
    }

    /// The place of a picture that is at a place of the file; both from the upper left corner.
    pub(super) fn place(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let moved = |x: f64, k: usize| x * self.scale[k] + self.offset[k];
        [moved(u, 0), 1.0 - moved(1.0 - v, 1)]
    }
}

/// What is beyond a picture's border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::formats) enum Wrap {
    Repeat,
    Mirror,
    Clamp,
}

impl Wrap {
    /// The pixel `i` of `count`.
    pub(super) fn pixel(self, i: f64, count: usize) -> usize {
        let n = count as f64;
        let i = match self {
            Wrap::Clamp => i,
            Wrap::Repeat => i - (i / n).floor() * n,
            Wrap::Mirror => {
                let j = i - (i / (2.0 * n)).floor() * 2.0 * n;
                if j < n { j } else { 2.0 * n - 1.0 - j }
            }
        };
        // The cast takes what is not finite for 0.
        (i.max(0.0) as usize).min(count - 1)
    }
}
