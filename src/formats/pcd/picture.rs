//! Whether an organised cloud is a picture taken from the origin.
//!
//! Rows and columns of a camera, or of a scanner that turns, are steps in direction: seen from it every cell of the grid has much
//! the same solid angle, of one sign. Seen from elsewhere, as after a change of frame, or where the grid is one of heights,
//! cells near and far, before and behind, have all kinds.

use glam::DVec3;
use std::collections::VecDeque;

/// Fewer cells are no picture.
const FEWEST_CELLS: u64 = 64;
/// So much of the cells has the sign of the picture, at least: discontinuities have none of their own.
const ONE_SIDED: f64 = 0.98;
/// The solid angles of the middle 80 % of the cells are within this many powers of two: 0.35 of the centre's is what a corner of a
/// camera of 90° has, and rings of a scanner can be as uneven.
const OCTAVES: usize = 3;
/// A cell of the smallest camera has 1e-8 steradians; this is none.
const NONE: f64 = 1e-14;
/// Bits of the mantissa of a number of double precision.
const MANTISSA: u32 = 52;

/// What is known of the grid's cells so far.
pub(super) struct Picture {
    width: u64,
    column: u64,
    /// Directions of the last `width` points; zero where there is none.
    last: VecDeque<DVec3>,
    /// Cells of one sign and of the other.
    signs: [u64; 2],
    /// Cells by the exponent of their solid angle.
    exponents: Vec<u64>,
}

impl Picture {
    /// Of so many columns.
    pub(super) fn new(width: u64) -> Picture {
        Picture {
            width,
            column: 0,
            last: VecDeque::new(),
            signs: [0; 2],
            exponents: vec![0; 1 << 11],
        }
    }

    /// The next point, row by row; not finite where nothing was seen.
    pub(super) fn push(&mut self, position: [f64; 3]) {
        let direction = DVec3::from(position).normalize_or_zero();
        let above = match self.last.len() as u64 == self.width {
            true => self.last.pop_front(),
            false => None,
        };
        let left = self.last.back().filter(|_| self.column > 0);
        if let (Some(&left), Some(above)) = (left, above)
            && [left, above, direction].iter().all(|d| *d != DVec3::ZERO)
        {
            self.add((left - direction).cross(above - direction).dot(direction));
        }
        self.last.push_back(direction);
        self.column = (self.column + 1) % self.width.max(1);
    }

    fn add(&mut self, angle: f64) {
        self.signs[usize::from(angle > 0.0)] += u64::from(angle.abs() > NONE);
        let exponent = angle.abs().max(NONE).to_bits() >> MANTISSA;
        self.exponents[exponent as usize] += 1;
    }

    /// Whether the cells are those of a picture.
    pub(super) fn is_of_the_origin(&self) -> bool {
        let cells: u64 = self.exponents.iter().sum();
        let most = self.signs[0].max(self.signs[1]);
        let spread = self.quantile(0.9) - self.quantile(0.1);
        cells >= FEWEST_CELLS && most as f64 >= ONE_SIDED * cells as f64 && spread <= OCTAVES
    }

    /// The exponent that this share of the cells is below or at.
    fn quantile(&self, share: f64) -> usize {
        let cells: u64 = self.exponents.iter().sum();
        let mut below = 0;
        let reached = |&count: &u64| {
            below += count;
            below as f64 >= share * cells as f64
        };
        self.exponents.iter().position(reached).unwrap_or(0)
    }
}
