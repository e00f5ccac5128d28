//! Eight `f32` side by side.
//!
//! Plain arrays with element-wise operators: compilers turn them into the vector instructions of the machine (simd128 in
//! wasm), and every lane rounds as a scalar would, so results do not depend on that.

use std::ops::{Add, AddAssign, Div, Mul, Sub};

/// Number of lanes.
pub const LANES: usize = 8;

/// Eight values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lanes(pub [f32; LANES]);

impl Lanes {
    /// All zero.
    pub const ZERO: Lanes = Lanes([0.0; LANES]);

    /// The same value in every lane.
    #[inline(always)]
    pub fn splat(x: f32) -> Lanes {
        Lanes([x; LANES])
    }

    /// `f` of every lane's number.
    #[inline(always)]
    pub fn from_fn(f: impl Fn(usize) -> f32) -> Lanes {
        Lanes(std::array::from_fn(f))
    }

    /// The first eight of a slice.
    #[inline(always)]
    pub fn load(x: &[f32]) -> Lanes {
        let mut lanes = [0.0; LANES];
        lanes.copy_from_slice(&x[..LANES]);
        Lanes(lanes)
    }

    /// `f` of every lane.
    #[inline(always)]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Lanes {
        Lanes(self.0.map(f))
    }

    #[inline(always)]
    fn zip(self, o: Lanes, f: impl Fn(f32, f32) -> f32) -> Lanes {
        Lanes(std::array::from_fn(|l| f(self.0[l], o.0[l])))
    }

    /// The smaller of each pair.
    #[inline(always)]
    pub fn min(self, o: Lanes) -> Lanes {
        self.zip(o, |a, b| if a < b { a } else { b })
    }

    /// The larger of each pair.
    #[inline(always)]
    pub fn max(self, o: Lanes) -> Lanes {
        self.zip(o, |a, b| if a > b { a } else { b })
    }

    /// In each lane `x` where `self` is less than `o`, else `y`.
    #[inline(always)]
    pub fn less(self, o: Lanes, x: Lanes, y: Lanes) -> Lanes {
        Lanes::from_fn(|l| if self.0[l] < o.0[l] { x.0[l] } else { y.0[l] })
    }

    /// Square roots.
    #[inline(always)]
    pub fn sqrt(self) -> Lanes {
        self.map(f32::sqrt)
    }

    /// The sum of the lanes, in order.
    #[inline(always)]
    pub fn sum(self) -> f32 {
        self.0.iter().sum()
    }
}

impl Add for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn add(self, o: Lanes) -> Lanes {
        self.zip(o, |a, b| a + b)
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
        self.zip(o, |a, b| a - b)
    }
}

impl Mul for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn mul(self, o: Lanes) -> Lanes {
        self.zip(o, |a, b| a * b)
    }
}

impl Div for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn div(self, o: Lanes) -> Lanes {
        self.zip(o, |a, b| a / b)
    }
}

/// Clears `out` and appends to it the places `0..n` for which the lanes that `value` gives for a block of places, by its
/// first one, are at most `limit`. Without branches, which no processor could predict here.
#[inline(always)]
pub fn places_within(n: usize, limit: f32, value: impl Fn(usize) -> Lanes, out: &mut Vec<u32>) {
    out.clear();
    out.resize(n.next_multiple_of(LANES), 0);
    let mut found = 0;
    for start in (0..n).step_by(LANES) {
        for (l, x) in value(start).0.into_iter().enumerate() {
            out[found] = (start + l) as u32;
            found += usize::from(x <= limit && start + l < n);
        }
    }
    out.truncate(found);
}
