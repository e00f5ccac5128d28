//! The type that goes in.

use crate::base::error::{Error, Result};
use glam::Vec3;

/// What is shown.
#[derive(Debug, Clone, Copy, Default)]
pub struct Scene<'a> {
    /// In the unit frame.
    pub points: &'a [Vec3],
    /// The points are the vertices of these; a cloud without.
    pub triangles: Option<&'a [[u32; 3]]>,
    /// One a vertex; default: from the triangles. Those of clouds are not looked at.
    pub normals: Option<&'a [Vec3]>,
    /// One a point.
    pub colors: Option<&'a [[u8; 3]]>,
    /// Places in the pictures, one a vertex, 0 to 1.
    pub uvs: Option<&'a [[f32; 2]]>,
    /// One a vertex, with the sign of the bitangent; without them the picture of normals is not used.
    pub tangents: Option<&'a [[f32; 4]]>,
    /// Base colours.
    pub color: Option<Pixels<'a>>,
    /// Normals in tangent space.
    pub normal: Option<Pixels<'a>>,
    /// How open the surface is to the light around, in red.
    pub occlusion: Option<Pixels<'a>>,
}

/// A picture on a mesh, the first row at the top.
#[derive(Debug, Clone, Copy)]
pub struct Pixels<'a> {
    /// At least 1.
    pub width: usize,
    /// Four bytes a pixel: red, green, blue, alpha, which is not looked at.
    pub rgba: &'a [u8],
}

impl Scene<'_> {
    /// Every list has one entry a point, and every corner is a point.
    pub(super) fn check(&self) -> Result<()> {
        let points = self.points.len();
        if points == 0 {
            return Err(Error::EmptyCloud);
        }
        let lengths = [
            ("normals", self.normals.map(<[Vec3]>::len)),
            ("colors", self.colors.map(<[[u8; 3]]>::len)),
            ("uvs", self.uvs.map(<[[f32; 2]]>::len)),
            ("tangents", self.tangents.map(<[[f32; 4]]>::len)),
        ];
        for (array, length) in lengths {
            if let Some(found) = length.filter(|&length| length != points) {
                return Err(Error::BadLength {
                    array: array.into(),
                    expected: format!("{points} (one a point)"),
                    found,
                });
            }
        }
        let pictures = [
            ("color", self.color),
            ("normal", self.normal),
            ("occlusion", self.occlusion),
        ];
        for (name, picture) in pictures {
            if let Some(Pixels { width, rgba }) = picture
                && (width == 0 || rgba.is_empty() || !rgba.len().is_multiple_of(4 * width))
            {
                return Err(Error::BadLength {
                    array: name.into(),
                    expected: format!("rows of {width} pixels, four bytes each"),
                    found: rgba.len(),
                });
            }
        }
        let corners = self.triangles.unwrap_or_default().as_flattened();
        match corners.iter().position(|&corner| corner as usize >= points) {
            None => Ok(()),
            Some(index) => Err(Error::BadIndex {
                index,
                points,
                found: corners[index],
            }),
        }
    }
}
