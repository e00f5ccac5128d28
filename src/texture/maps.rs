//! The types of pictures, and of what they show.

use crate::base::error::{Error, Result};
use glam::Vec3;

/// Which pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Map {
    /// Of the scan's points, or of their values; none where they show nothing.
    Color,
    /// Of the full mesh, in the light mesh's tangent space: +x along the tangent, +y up in the picture, +z out.
    Normal,
    /// How open the full mesh is to the light around it, 255 where nothing is in its way; half as wide as the others.
    Occlusion,
}

/// A picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    /// What it shows.
    pub map: Map,
    /// In texels.
    pub width: usize,
    /// In texels.
    pub height: usize,
    /// A PNG file: 8 bits, three channels; of occlusion one.
    pub png: Vec<u8>,
}

/// The scan's points in the meshes' frame, and what they show.
#[derive(Debug, Clone, Copy)]
pub struct Scan<'a> {
    /// Positions.
    pub points: &'a [Vec3],
    /// One value a point.
    pub paint: Paint<'a>,
}

/// What points show.
#[derive(Debug, Clone, Copy)]
pub enum Paint<'a> {
    /// No colours.
    Nothing,
    /// One colour a point.
    Colors(&'a [[u8; 3]]),
    /// Measured values as colours.
    Scalars {
        /// One a point, 0 for the first of the ramp to 1 for the last; beyond as the ends. One that is not a number shows nothing.
        values: &'a [f32],
        /// At even steps.
        ramp: &'a [[u8; 3]],
    },
}

impl Paint<'_> {
    /// Whether there are as many as points.
    ///
    /// # Errors
    /// [`Error::BadLength`]; [`Error::BadOption`] for a ramp without colours.
    pub(super) fn check(&self, points: usize) -> Result<()> {
        let (array, found) = match self {
            Paint::Nothing => return Ok(()),
            Paint::Colors(colors) => ("colors", colors.len()),
            Paint::Scalars { ramp: [], .. } => {
                return Err(Error::bad_option("ramp", "one colour or more", "none"));
            }
            Paint::Scalars { values, .. } => ("scalars", values.len()),
        };
        match found == points {
            true => Ok(()),
            false => Err(Error::BadLength {
                array: array.into(),
                expected: format!("{points} (one a point)"),
                found,
            }),
        }
    }
}
