//! Splits world coordinates into an origin in double precision and offsets from it in single precision.

use crate::base::error::{Error, Result};
use crate::formats::raw_cloud::{Positions, RawCloud};

/// Positions that single precision holds, and what is added to them to give world coordinates.
pub(super) struct Local {
    pub(super) origin: Option<[f64; 3]>,
    /// `x y z` a point.
    pub(super) positions: Vec<f32>,
}

impl Local {
    /// The cloud's own origin and positions where single precision moves no coordinate by more than 2⁻²² of the longest
    /// side; else the origin is moved near the middle, to a multiple of a power of two, so that it has few digits.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::BadOption`] where a coordinate is larger than single precision can hold.
    pub(super) fn of(cloud: &RawCloud) -> Result<Local> {
        let (lo, hi) = bounds(cloud)?;
        let longest = (0..3).map(|a| hi[a] - lo[a]).fold(0.0, f64::max);
        let moved = |x: f64| (x - f64::from(x as f32)).abs();
        let fits = match &cloud.positions {
            Positions::F32(_) => true,
            Positions::F64(values) => {
                let most = longest * 2f64.powi(-22);
                values.iter().all(|&x| moved(x) <= most)
            }
        };
        let shift = if fits {
            [0.0; 3]
        } else {
            let step = power_of_two(longest);
            [0, 1, 2].map(|a| ((lo[a] * 0.5 + hi[a] * 0.5) / step).round() * step)
        };
        let positions = (0..3 * cloud.points())
            .map(|k| (cloud.positions.get(k) - shift[k % 3]) as f32)
            .collect();
        let own = cloud.origin.unwrap_or_default();
        let origin = [0, 1, 2].map(|a| own[a] + shift[a]);
        Ok(Local {
            origin: (origin != [0.0; 3]).then_some(origin),
            positions,
        })
    }
}

/// Corners of the bounding box; zero without points.
fn bounds(cloud: &RawCloud) -> Result<([f64; 3], [f64; 3])> {
    let (mut lo, mut hi) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for k in 0..3 * cloud.points() {
        let x = cloud.positions.get(k);
        if !x.is_finite() || x.abs() > f64::from(f32::MAX) {
            return Err(Error::NonFinite {
                array: "positions".into(),
                index: k / 3,
                found: x,
            });
        }
        (lo[k % 3], hi[k % 3]) = (lo[k % 3].min(x), hi[k % 3].max(x));
    }
    Ok(if cloud.points() == 0 {
        ([0.0; 3], [0.0; 3])
    } else {
        (lo, hi)
    })
}

/// The largest power of two that is not above `x`; 1 where `x` is zero.
fn power_of_two(x: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    let power = f64::from_bits(x.to_bits() & EXPONENT);
    if power > 0.0 { power } else { 1.0 }
}
