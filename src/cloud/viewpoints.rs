//! Where a cloud was seen from.

use crate::base::error::{Error, Result};
use glam::DVec3;

/// Places from which the points of a cloud were seen: a scanner's positions, a camera's.
#[derive(Debug, Clone, PartialEq)]
pub struct Viewpoints {
    /// In the caller's frame and unit; at least one.
    pub positions: Vec<DVec3>,
    /// For each point the index of the position that saw it, or [`Viewpoints::UNKNOWN`]; `None`: the first saw all.
    pub of: Option<Vec<u32>>,
}

impl Viewpoints {
    /// Stands in `of` for a point that nobody knows the viewpoint of.
    pub const UNKNOWN: u32 = u32::MAX;

    /// From `x y z …` in the caller's frame, and one index a point of `points` or none at all.
    ///
    /// # Errors
    /// [`Error::BadLength`] (not a multiple of 3, no position, not an index a point), [`Error::NonFinite`],
    /// [`Error::BadOption`] (an index that no position has).
    pub fn new(positions: &[f64], of: Option<&[u32]>, points: usize) -> Result<Viewpoints> {
        if positions.is_empty() || !positions.len().is_multiple_of(3) {
            return Err(Error::BadLength {
                array: "viewpoints.positions".into(),
                expected: "a multiple of 3, at least 3".into(),
                found: positions.len(),
            });
        }
        if let Some(i) = positions.iter().position(|x| !x.is_finite()) {
            return Err(Error::NonFinite {
                array: "viewpoints.positions".into(),
                index: i / 3,
                found: positions[i],
            });
        }
        let count = positions.len() / 3;
        if let Some(of) = of {
            if of.len() != points {
                return Err(Error::BadLength {
                    array: "viewpoints.of".into(),
                    expected: format!("{points} (1 a point)"),
                    found: of.len(),
                });
            }
            let is_bad = |&i: &u32| i as usize >= count && i != Viewpoints::UNKNOWN;
            if let Some(index) = of.iter().position(is_bad) {
                return Err(Error::BadOption {
                    option: format!("viewpoints.of[{index}]"),
                    expected: format!("a number under {count}, the count of viewpoints"),
                    found: of[index].to_string(),
                });
            }
        }
        Ok(Viewpoints {
            positions: positions.chunks_exact(3).map(DVec3::from_slice).collect(),
            of: of.map(<[u32]>::to_vec),
        })
    }

    /// Where point `i` was seen from.
    pub fn seeing(&self, i: usize) -> Option<DVec3> {
        let index = self.of.as_ref().map_or(0, |of| of[i]);
        self.positions.get(index as usize).copied()
    }

    /// Those of some points.
    pub fn select(&self, indices: impl Iterator<Item = usize>) -> Viewpoints {
        Viewpoints {
            positions: self.positions.clone(),
            of: self.of.as_ref().map(|of| indices.map(|i| of[i]).collect()),
        }
    }
}
