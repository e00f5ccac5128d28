//! Eight `f32` side by side: the machine's vector instructions (simd128 in wasm), by the crate `wide`.
//!
//! Every operation rounds as its scalar does, so results do not depend on the machine.

use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Sub};

use wide::f32x8;

/// Number of lanes.
pub const LANES: usize = 8;

/// Eight values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lanes(f32x8);

impl Lanes {
    /// All zero.
    pub const ZERO: Lanes = Lanes(f32x8::ZERO);

    /// The same value in every lane.
    #[inline(always)]
    pub fn splat(x: f32) -> Lanes {
        Lanes(f32x8::splat(x))
    }

    /// `f` of every lane's number.
    #[inline(always)]
    pub fn from_fn(f: impl Fn(usize) -> f32) -> Lanes {
        Lanes(f32x8::new(std::array::from_fn(f)))
    }

    /// The first eight of a slice.
    #[inline(always)]
    pub fn load(x: &[f32]) -> Lanes {
        let mut lanes = [0.0; LANES];
        lanes.copy_from_slice(&x[..LANES]);
        Lanes(f32x8::new(lanes))
    }

    /// All values.
    #[inline(always)]
    pub fn to_array(self) -> [f32; LANES] {
        self.0.to_array()
    }

    /// The value of one lane.
    #[inline(always)]
    pub fn lane(self, l: usize) -> f32 {
        self.to_array()[l]
    }

    /// `f` of every lane, one by one.
    #[inline(always)]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Lanes {
        Lanes(f32x8::new(self.to_array().map(f)))
    }

    /// The smaller of each pair: `self` where it is less, else `o`, so that equals and NaN are defined.
    #[inline(always)]
    pub fn min(self, o: Lanes) -> Lanes {
        // One instruction where there is one: minps a b is a < b ? a : b, pmin a b is b < a ? b : a.
        if cfg!(target_feature = "sse") {
            Lanes(self.0.fast_min(o.0))
        } else if cfg!(target_feature = "simd128") {
            Lanes(o.0.fast_min(self.0))
        } else {
            self.less(o, self, o)
        }
    }

    /// The larger of each pair: `self` where it is larger, else `o`.
    #[inline(always)]
    pub fn max(self, o: Lanes) -> Lanes {
        if cfg!(target_feature = "sse") {
            Lanes(self.0.fast_max(o.0))
        } else if cfg!(target_feature = "simd128") {
            Lanes(o.0.fast_max(self.0))
        } else {
            o.less(self, self, o)
        }
    }

    /// In each lane `x` where `self` is less than `o`, else `y`.
    #[inline(always)]
    pub fn less(self, o: Lanes, x: Lanes, y: Lanes) -> Lanes {
        Lanes(self.0.simd_lt(o.0).bitselect(x.0, y.0))
    }

    /// A bit for each lane that is at most the other's, the lowest for the first one.
    #[inline(always)]
    pub fn at_most(self, o: Lanes) -> u32 {
        self.0.simd_le(o.0).to_bitmask()
    }

    /// 1 with the sign of each lane.
    #[inline(always)]
    pub fn sign(self) -> Lanes {
        Lanes(self.0.bitand(f32x8::splat(-0.0)).bitor(f32x8::splat(1.0)))
    }

    /// Square roots.
    #[inline(always)]
    pub fn sqrt(self) -> Lanes {
        Lanes(self.0.sqrt())
    }

    /// The sum of the lanes, in order.
    #[inline(always)]
    pub fn sum(self) -> f32 {
        self.to_array().iter().sum()
    }
}

impl Add for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn add(self, o: Lanes) -> Lanes {
        Lanes(self.0 + o.0)
    }
}

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, o: Lanes) {
        *self = *self + o;
    }
}

impl Sub for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn sub(self, o: Lanes) -> Lanes {
        Lanes(self.0 - o.0)
    }
}

impl Mul for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn mul(self, o: Lanes) -> Lanes {
        Lanes(self.0 * o.0)
    }
}

impl Div for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn div(self, o: Lanes) -> Lanes {
        Lanes(self.0 / o.0)
    }
}

/// Clears `out` and appends to it the places `0..n` for which the lanes that `value` gives for a block of places, by its
/// first one, are at most `limit`.
#[inline(always)]
pub fn places_within(n: usize, limit: f32, value: impl Fn(usize) -> Lanes, out: &mut Vec<u32>) {
    let limit = Lanes::splat(limit);
    out.clear();
    for start in (0..n).step_by(LANES) {
        let mut within = value(start).at_most(limit);
        if n - start < LANES {
            within &= (1 << (n - start)) - 1;
        }
        while within != 0 {
            out.push(start as u32 + within.trailing_zeros());
            within &= within - 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn minima_and_maxima_are_what_comparisons_say_bit_by_bit() {
        let values = [
            0.0,
            -0.0,
            1.0,
            -2.5,
            f32::NAN,
            f32::INFINITY,
            f32::NEG_INFINITY,
            1e-40,
        ];
        for a in values {
            let bits = |x: Lanes| x.to_array().map(f32::to_bits);
            let (a, b) = (Lanes::splat(a), Lanes::from_fn(|i| values[i]));
            assert_eq!(bits(a.min(b)), bits(a.less(b, a, b)));
            assert_eq!(bits(b.min(a)), bits(b.less(a, b, a)));
            assert_eq!(bits(a.max(b)), bits(b.less(a, a, b)));
            assert_eq!(bits(b.max(a)), bits(a.less(b, b, a)));
        }
    }
}
