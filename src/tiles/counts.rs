//! How many points lie where: on a lattice whose cells have sides that are powers of two, from the world's zero on.
//!
//! The cells are as fine as [`MOST`] of them allow. That depends on the points, not on their order or on how they came in files: counts
//! of parts add up to the counts of all.

use crate::base::error::{Error, Result};

/// Cells at most.
const MOST: usize = 1 << 18;
/// Side of the finest cells: 2⁻²⁰ of the caller's unit.
const FINEST: i32 = -20;
/// A cell's place along an axis is below 2 to this.
const PLACES: i32 = 50;
/// Bytes before the cells, and of a cell.
const HEAD: usize = 8;
const CELL: usize = 32;

/// Points of cells.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Counts {
    /// A cell's side is 2 to this.
    pub level: i32,
    /// The cells that have points, each with their number, in ascending order.
    pub cells: Vec<([i64; 3], u64)>,
}

impl Default for Counts {
    fn default() -> Counts {
        Counts {
            level: FINEST,
            cells: Vec::new(),
        }
    }
}

/// The cell of a coordinate. Exact: the side is a power of two.
pub(super) fn cell_of(x: f64, level: i32) -> i64 {
    (x * power_of_two(-level)).floor() as i64
}

/// Of an exponent from -1022 to 1023.
pub(super) fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

/// The least level at which the cell of this coordinate has a place.
fn least_level(x: f64) -> i32 {
    let exponent = ((x.to_bits() >> 52) & 0x7FF) as i32 - 1023;
    (exponent + 1 - PLACES).max(FINEST)
}

impl Counts {
    /// Counts points of the world.
    ///
    /// # Errors
    /// [`Error::NonFinite`]; nothing is counted then.
    pub fn add(&mut self, points: &[[f64; 3]]) -> Result<()> {
        let far = |p: &[f64; 3]| p.iter().all(|x| x.abs() < 1e290);
        if let Some(index) = points.iter().position(|p| !far(p)) {
            return Err(Error::NonFinite {
                array: "positions".into(),
                index,
                found: points[index][0],
            });
        }
        let level = points.iter().flatten().map(|&x| least_level(x)).max();
        self.coarsen_to(level.unwrap_or(FINEST).max(self.level));
        let mut cells: Vec<([i64; 3], u64)> = Vec::new();
        for p in points {
            let cell = p.map(|x| cell_of(x, self.level));
            match cells.last_mut() {
                Some((last, count)) if *last == cell => *count += 1,
                _ => cells.push((cell, 1)),
            }
        }
        self.merge(Counts {
            level: self.level,
            cells,
        });
        Ok(())
    }

    /// Adds the counts of other points.
    pub fn merge(&mut self, mut other: Counts) {
        let level = self.level.max(other.level);
        self.coarsen_to(level);
        other.coarsen_to(level);
        self.cells.append(&mut other.cells);
        self.tidy();
        while self.cells.len() > MOST {
            self.coarsen_to(self.level + 1);
        }
    }

    /// All points.
    pub fn total(&self) -> u64 {
        self.cells.iter().map(|(_, count)| count).sum()
    }

    /// The same counts in cells of this level, which is no finer.
    pub(super) fn coarsen_to(&mut self, level: i32) {
        let shift = (level - self.level).min(63);
        if shift > 0 {
            for (cell, _) in &mut self.cells {
                *cell = cell.map(|x| x >> shift);
            }
            self.level = level;
            self.tidy();
        }
    }

    /// Sorts, and makes one of equal cells.
    fn tidy(&mut self) {
        self.cells.sort_unstable();
        self.cells.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
    }

    /// As a file has them.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(HEAD + CELL * self.cells.len());
        bytes.extend(i64::from(self.level).to_le_bytes());
        for (cell, count) in &self.cells {
            bytes.extend(cell.iter().flat_map(|x| x.to_le_bytes()));
            bytes.extend(count.to_le_bytes());
        }
        bytes
    }

    /// From a file.
    ///
    /// # Errors
    /// [`Error::BadFile`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Counts> {
        let bad = |found: &str| Error::BadFile {
            format: "counts",
            place: "byte",
            at: bytes.len() as u64,
            expected: "counts of tiles, as they were written".into(),
            found: found.into(),
        };
        let number = |at: usize| {
            let word = bytes.get(at..at + 8).and_then(|word| word.try_into().ok());
            word.map(i64::from_le_bytes)
                .ok_or_else(|| bad("too few bytes"))
        };
        let level = number(0)?;
        if !(bytes.len() - HEAD).is_multiple_of(CELL) || !(-20..=1000).contains(&level) {
            return Err(bad("something else"));
        }
        let cells = (HEAD..bytes.len()).step_by(CELL).map(|at| {
            let cell = [number(at)?, number(at + 8)?, number(at + 16)?];
            Ok((cell, number(at + 24)? as u64))
        });
        Ok(Counts {
            level: level as i32,
            cells: cells.collect::<Result<_>>()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::Rng;

    fn points(n: usize, seed: u64) -> Vec<[f64; 3]> {
        let mut rng = Rng::new(seed);
        let mut x = |size: f64| rng.uniform() * size - 1.0;
        (0..n)
            .map(|_| [4e5 + x(900.0), x(500.0), x(20.0)])
            .collect()
    }

    #[test]
    fn counts_do_not_depend_on_order_or_parts() {
        let all = points(400_000, 1);
        let mut whole = Counts::default();
        whole.add(&all).unwrap();
        assert_eq!(whole.total(), 400_000);
        assert!(whole.cells.len() <= MOST && whole.cells.len() > MOST / 16);
        let mut backwards = Counts::default();
        for part in all.chunks(70_001).rev() {
            let mut counts = Counts::default();
            counts.add(part).unwrap();
            let bytes = counts.to_bytes();
            backwards.merge(Counts::from_bytes(&bytes).unwrap());
        }
        assert_eq!(whole, backwards);
    }

    #[test]
    fn far_coordinates_and_damaged_files_are_no_panic() {
        let mut counts = Counts::default();
        counts
            .add(&[[1e200, -1e200, 0.0], [0.0; 3], [5e-324, 1.0, -0.0]])
            .unwrap();
        assert_eq!(counts.total(), 3);
        assert!(counts.add(&[[0.0, f64::NAN, 0.0]]).is_err());
        assert_eq!(counts.total(), 3);
        for bytes in [&[0u8; 5][..], &[255; 9], &[0; 41]] {
            assert_eq!(Counts::from_bytes(bytes).unwrap_err().code(), "bad-file");
        }
    }
}
