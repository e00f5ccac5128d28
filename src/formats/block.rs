//! [`Block`]: points of a file as arrays, as the caller takes them slice by slice.

use super::raw_cloud::Positions;
use super::sentinels::{LeftOut, Why};
use crate::cloud::{Attribute, Viewpoints};

/// Rows as arrays of one type each: all of a file's, or those that came since the last block.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// Coordinates.
    pub positions: Positions,
    /// `x y z` a point.
    pub normals: Option<Vec<f32>>,
    /// `r g b` a point.
    pub colors: Option<ColorValues>,
    /// Other scalars, one value a point. One that comes later than the first block was 0 before.
    pub attributes: Vec<Attribute>,
}

/// Colours as a file has them.
#[derive(Debug, Clone, PartialEq)]
pub enum ColorValues {
    /// 0-255.
    Bytes(Vec<u8>),
    /// To be multiplied by [`Verdict::color_scale`].
    Numbers(Vec<f32>),
}

/// What only the whole file tells about its blocks.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// Single precision suffices for the positions, which came in double.
    pub narrow: bool,
    /// From [`ColorValues::Numbers`] to 0-255.
    pub color_scale: f32,
    /// The colours say something.
    pub has_colors: bool,
    /// The normals belong to the points, and one of them is not zero.
    pub has_normals: bool,
    /// The points that are none.
    pub left_out: LeftOut,
    /// Names of the attributes, in order.
    pub attributes: Vec<String>,
}

impl Block {
    /// Leaves out points that are none; how many had no data, and how many were no returns.
    pub(super) fn leave_out(
        &mut self,
        left_out: &LeftOut,
        viewpoints: &mut Option<Viewpoints>,
    ) -> [u64; 2] {
        let mut counts = [0; 2];
        if left_out.is_empty() {
            return counts;
        }
        let points = self.positions.len() / 3;
        let keep: Vec<bool> = (0..points)
            .map(|point| {
                let position = [0, 1, 2].map(|axis| self.positions.get(3 * point + axis));
                let why = left_out.why(position);
                if let Some(why) = why {
                    counts[usize::from(why == Why::NoReturn)] += 1;
                }
                why.is_none()
            })
            .collect();
        match &mut self.positions {
            Positions::F32(values) => retain(values, 3, &keep),
            Positions::F64(values) => retain(values, 3, &keep),
        }
        if let Some(of) = viewpoints.as_mut().and_then(|all| all.of.as_mut()) {
            retain(of, 1, &keep);
        }
        if let Some(normals) = &mut self.normals {
            retain(normals, 3, &keep);
        }
        match &mut self.colors {
            Some(ColorValues::Bytes(values)) => retain(values, 3, &keep),
            Some(ColorValues::Numbers(values)) => retain(values, 3, &keep),
            None => {}
        }
        for attribute in &mut self.attributes {
            retain(&mut attribute.values, 1, &keep);
        }
        counts
    }
}

/// Keeps the values of these points.
fn retain<T>(values: &mut Vec<T>, each: usize, keep: &[bool]) {
    let mut value = 0;
    values.retain(|_| {
        value += 1;
        // Normals that the file has apart may be more than its points.
        keep.get((value - 1) / each).copied().unwrap_or(true)
    });
}
