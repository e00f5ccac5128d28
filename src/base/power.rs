//! The two powers of fuzzy c-means: a distance ratio to a share of membership, a membership to its weight.
//!
//! For `m` of 2, 1.5 and 1.25 the exponents of eq. 5, `1/(m-1)`, are 1, 2 and 4, and `u^m` needs square roots only;
//! any other fuzzifier takes `libm`.

use wide::f64x4;

use crate::base::lanes::Lanes;

/// The powers that one fuzzifier asks for, of single values in double precision or of lanes.
pub trait Power<T>: Copy {
    /// `r^(1/(m-1))` of a ratio of squared distances (eq. 5).
    fn share(self, ratio: T) -> T;
    /// `u^m` (eq. 1, 2).
    fn raise(self, u: T) -> T;
}

/// m = 2.
#[derive(Clone, Copy, Debug)]
pub struct TwoPower;
/// m = 1.5.
#[derive(Clone, Copy, Debug)]
pub struct ThreeHalvesPower;
/// m = 1.25.
#[derive(Clone, Copy, Debug)]
pub struct FiveQuartersPower;
/// Any m.
#[derive(Clone, Copy, Debug)]
pub struct AnyPower {
    m: f64,
    exponent: f64,
}

/// A fuzzifier, sorted by how its powers are computed.
#[derive(Clone, Copy, Debug)]
pub enum Fuzzifier {
    /// m = 2.
    Two(TwoPower),
    /// m = 1.5.
    ThreeHalves(ThreeHalvesPower),
    /// m = 1.25.
    FiveQuarters(FiveQuartersPower),
    /// Any other m > 1.
    Any(AnyPower),
}

impl Fuzzifier {
    /// `m` > 1.
    pub fn new(m: f64) -> Fuzzifier {
        if m == 2.0 {
            Fuzzifier::Two(TwoPower)
        } else if m == 1.5 {
            Fuzzifier::ThreeHalves(ThreeHalvesPower)
        } else if m == 1.25 {
            Fuzzifier::FiveQuarters(FiveQuartersPower)
        } else {
            Fuzzifier::Any(AnyPower {
                m,
                exponent: 1.0 / (m - 1.0),
            })
        }
    }
}

impl Fuzzifier {
    /// `r^(1/(m-1))`.
    pub fn share(self, ratio: f64) -> f64 {
        match self {
            Fuzzifier::Two(power) => power.share(ratio),
            Fuzzifier::ThreeHalves(power) => power.share(ratio),
            Fuzzifier::FiveQuarters(power) => power.share(ratio),
            Fuzzifier::Any(power) => power.share(ratio),
        }
    }

    /// `u^m`.
    pub fn raise(self, u: f64) -> f64 {
        match self {
            Fuzzifier::Two(power) => power.raise(u),
            Fuzzifier::ThreeHalves(power) => power.raise(u),
            Fuzzifier::FiveQuarters(power) => power.raise(u),
            Fuzzifier::Any(power) => power.raise(u),
        }
    }
}

macro_rules! powers {
    ($float:ty) => {
        impl Power<$float> for TwoPower {
            #[inline(always)]
            fn share(self, ratio: $float) -> $float {
                ratio
            }
            #[inline(always)]
            fn raise(self, u: $float) -> $float {
                u * u
            }
        }

        impl Power<$float> for ThreeHalvesPower {
            #[inline(always)]
            fn share(self, ratio: $float) -> $float {
                ratio * ratio
            }
            #[inline(always)]
            fn raise(self, u: $float) -> $float {
                u * u.sqrt()
            }
        }

        impl Power<$float> for FiveQuartersPower {
            #[inline(always)]
            fn share(self, ratio: $float) -> $float {
                let square = ratio * ratio;
                square * square
            }
            #[inline(always)]
            fn raise(self, u: $float) -> $float {
                u * u.sqrt().sqrt()
            }
        }
    };
}

powers!(f64);
powers!(f64x4);
powers!(Lanes);

impl Power<f64> for AnyPower {
    fn share(self, ratio: f64) -> f64 {
        libm::pow(ratio, self.exponent)
    }
    fn raise(self, u: f64) -> f64 {
        libm::pow(u, self.m)
    }
}

impl Power<Lanes> for AnyPower {
    fn share(self, ratio: Lanes) -> Lanes {
        ratio.map(|r| Power::<f64>::share(self, f64::from(r)) as f32)
    }
    fn raise(self, u: Lanes) -> Lanes {
        u.map(|u| Power::<f64>::raise(self, f64::from(u)) as f32)
    }
}

impl Power<f64x4> for AnyPower {
    fn share(self, ratio: f64x4) -> f64x4 {
        f64x4::new(ratio.to_array().map(|r| Power::<f64>::share(self, r)))
    }
    fn raise(self, u: f64x4) -> f64x4 {
        f64x4::new(u.to_array().map(|u| Power::<f64>::raise(self, u)))
    }
}
