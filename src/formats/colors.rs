//! How many bits the numbers of a file's colours have.

/// What the values of colours run to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ColorRange {
    /// 8-bit integers: 1 means 1 of 255.
    Bytes,
    /// 1.
    Unit,
    /// Coefficients of the spherical harmonic of degree 0, as Gaussian splats have them.
    Harmonics,
    /// Integers of 8, 12 or 16 bits.
    Integers,
    /// The values tell: 1 where they are at most 1, else integers.
    Guess,
}

impl ColorRange {
    /// A value of a file, as it is kept.
    pub(super) fn kept(self, value: f32) -> f32 {
        /// 1 / (2 √π).
        const HARMONIC_0: f32 = 0.282_094_8;
        match self {
            ColorRange::Harmonics => (0.5 + HARMONIC_0 * value).clamp(0.0, 1.0),
            _ => value,
        }
    }
}

/// White beside values of any range.
pub(super) const WHITE: f32 = f32::MAX;

/// Counts of the values of colours.
#[derive(Default)]
pub(super) struct Tally {
    positive: u64,
    fractional: u64,
    over_1: u64,
    over_255: u64,
    over_4095: u64,
    /// Those that are no byte written in 16 bits, which is 257 times the byte.
    uneven: u64,
}

impl Tally {
    pub(super) fn add(&mut self, value: f32) {
        if value == WHITE {
            return;
        }
        self.positive += u64::from(value > 0.0);
        self.fractional += u64::from(value.fract() != 0.0);
        self.over_1 += u64::from(value > 1.0);
        self.over_255 += u64::from(value > 255.0);
        self.over_4095 += u64::from(value > 4095.0);
        self.uneven += u64::from(value % 257.0 != 0.0);
    }

    /// What the values are multiplied by to run to 255. One value in a hundred may be beyond, as rounding and
    /// overexposure have it.
    pub(super) fn scale(&self, range: ColorRange) -> f32 {
        let strays = |count: u64| 100 * count <= self.positive;
        let unit = self.over_1 == 0 || (self.fractional > 0 && strays(self.over_1));
        match range {
            ColorRange::Unit | ColorRange::Harmonics => 255.0,
            ColorRange::Guess if unit => 255.0,
            _ if strays(self.over_255) => 1.0,
            _ if self.over_4095 == 0 && self.uneven > 0 => 255.0 / 4095.0,
            _ => 1.0 / 257.0,
        }
    }
}

/// The colour that a value packs: its integer, or, of a float, its `bits`. Some programs write the integer as a float's value: it
/// is whole and not tiny, as the bits of no colour are without transparency or with all of it.
pub(super) fn unpacked(is_float: bool, value: f64, bits: u32) -> u32 {
    let is_integer = (1.0..=f64::from(u32::MAX)).contains(&value) && value.fract() == 0.0;
    if is_float && !is_integer {
        bits
    } else {
        value as i64 as u32
    }
}
