//! Radial basis functions φ(r) of eq. 9 and the weight of the partition of unity, with their derivatives; solid angles.

use crate::base::lanes::Lanes;
use crate::base::params::Kernel;
use glam::{DVec3, Vec3};

/// φ(r) and φ'(r)/r of the kernel, from r².
///
/// - biharmonic: φ = −r (the sign makes the interpolation matrix conditionally positive definite of order 1),
/// - triharmonic: φ = r³ (order 2),
/// - thin plate: φ = r² log r (order 2), the paper's.
///
/// Wendland, *Scattered Data Approximation*, 2005, section 8.3. φ'(r)/r is 0 at r = 0, where the biharmonic kernel has
/// no derivative.
#[inline]
pub fn phi(kernel: Kernel, r2: f64) -> (f64, f64) {
    match kernel {
        Kernel::Triharmonic => {
            let r = r2.sqrt();
            (r2 * r, 3.0 * r)
        }
        Kernel::Biharmonic => {
            let r = r2.sqrt();
            (-r, if r > 0.0 { -1.0 / r } else { 0.0 })
        }
        Kernel::ThinPlate if r2 > 0.0 => {
            let log = 0.5 * libm::log(r2);
            (r2 * log, 2.0 * log + 1.0)
        }
        Kernel::ThinPlate => (0.0, 0.0),
    }
}

/// Wendland's C² function ψ(t) = (1 − t)⁴ (4t + 1) on [0, 1] and ψ'(t)/t, zero beyond (Wendland, "Piecewise polynomial,
/// positive definite and compactly supported radial functions of minimal degree", 1995).
#[inline(always)]
pub fn wendland(t: Lanes) -> (Lanes, Lanes) {
    let one = Lanes::splat(1.0);
    let u = (one - t).max(Lanes::ZERO);
    let u3 = u * u * u;
    (
        u3 * u * (Lanes::splat(4.0) * t + one),
        u3 * Lanes::splat(-20.0),
    )
}

/// Solid angle of a small patch of area vector `a` at `d`.
pub fn solid_angle(d: DVec3, a: DVec3) -> f64 {
    blurred_solid_angle(d, a, 0.0)
}

/// [`solid_angle`] of a patch that is spread over about `blur`: much nearer than that it is hardly seen.
pub(crate) fn blurred_solid_angle(d: DVec3, a: DVec3, blur: f64) -> f64 {
    let r2 = d.length_squared() + blur * blur;
    if r2 > 0.0 {
        d.dot(a) / (r2 * r2.sqrt())
    } else {
        0.0
    }
}

/// How much two dipoles along `m` and, `d` away, along `n` want to stand as they do, −2 to 2: side by side they look the
/// same way, facing each other opposite ways. `blur2`, a squared length, tempers offsets that may be noise.
pub(crate) fn dipoles(d: Vec3, m: Vec3, n: Vec3, blur2: f32) -> f32 {
    let square = d.length_squared() + blur2;
    m.dot(n) - 3.0 * m.dot(d) * n.dot(d) / square.max(f32::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_match_differences() {
        let h = 1e-6;
        for kernel in [Kernel::Biharmonic, Kernel::Triharmonic, Kernel::ThinPlate] {
            for r in [0.1, 0.5, 1.0, 2.0] {
                let f = |r: f64| phi(kernel, r * r).0;
                let slope = (f(r + h) - f(r - h)) / (2.0 * h);
                assert!(
                    (slope - phi(kernel, r * r).1 * r).abs() < 1e-7,
                    "{kernel:?} at {r}"
                );
            }
        }
        let wendland = |t: f32| {
            let (value, slope) = wendland(Lanes::splat(t));
            (f64::from(value.lane(0)), f64::from(slope.lane(0)))
        };
        let h = 1.0 / 128.0;
        for t in [0.125, 0.5, 0.875] {
            let slope = (wendland(t + h).0 - wendland(t - h).0) / f64::from(2.0 * h);
            assert!((slope - wendland(t).1 * f64::from(t)).abs() < 2e-3);
        }
        assert_eq!(wendland(1.0), (0.0, 0.0));
        assert_eq!(wendland(2.0), (0.0, 0.0));
        assert_eq!(wendland(0.0).0, 1.0);
    }
}
