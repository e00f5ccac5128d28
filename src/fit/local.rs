//! A fitted local function f_i (eq. 9, 10): eight positions are evaluated side by side, in single precision and in
//! coordinates of its sub-domain.

use crate::base::kernel::phi;
use crate::base::lanes::{LANES, Lanes};
use crate::base::params::Kernel;
use crate::cloud::neighborhood::Block;
use glam::Vec3;

/// The function of a sub-domain: one smooth function, or where there is a crease the largest or least of one for each face
/// ([`crate::fit::faces`]).
#[derive(Debug, Clone)]
pub struct LocalFit {
    /// At least one.
    pub(crate) faces: Vec<Rbf>,
    /// Whether the least counts.
    pub(crate) concave: bool,
}

/// f(x) = Σ w_i φ(|x − c_i|) + λ0 + λ1 x + λ2 y + λ3 z.
#[derive(Debug, Clone)]
pub(crate) struct Rbf {
    /// φ.
    pub(crate) kernel: Kernel,
    /// Origin of the coordinates.
    pub(crate) center: Vec3,
    /// Their unit.
    pub(crate) radius: f32,
    /// x, y, z and weight of every centre.
    pub(crate) centers: Vec<[f32; 4]>,
    /// λ0 … λ3 of eq. 10.
    pub(crate) linear: [f32; 4],
}

impl Rbf {
    /// f, and for N = 4 its gradient behind it.
    fn evaluate<const N: usize>(&self, at: [Lanes; 3]) -> [Lanes; N] {
        let unit = Lanes::splat(1.0 / self.radius);
        let center = self.center.to_array();
        let q = [0, 1, 2].map(|axis| (at[axis] - Lanes::splat(center[axis])) * unit);
        let [l0, linear @ ..] = self.linear.map(Lanes::splat);
        let (sums, scale): ([Lanes; N], _) = match self.kernel {
            Kernel::Triharmonic => {
                let sums = self.sum(q, |r2| {
                    let r = r2.sqrt();
                    (r2 * r, r)
                });
                (sums, 3.0)
            }
            kernel => {
                let of = |r2: f32| phi(kernel, f64::from(r2));
                let sums = self.sum(q, |r2| {
                    (r2.map(|r2| of(r2).0 as f32), r2.map(|r2| of(r2).1 as f32))
                });
                (sums, 1.0)
            }
        };
        std::array::from_fn(|k| match k {
            0 => {
                let value = sums[0] + l0 + linear[0] * q[0] + linear[1] * q[1] + linear[2] * q[2];
                value * Lanes::splat(self.radius)
            }
            axis => sums[axis] * Lanes::splat(scale) + linear[axis - 1],
        })
    }

    /// Σ w φ, and for N = 4 behind it Σ w φ'/r (q − c), `phi` being φ and φ'/r of r².
    #[inline(always)]
    fn sum<const N: usize>(
        &self,
        q: [Lanes; 3],
        phi: impl Fn(Lanes) -> (Lanes, Lanes),
    ) -> [Lanes; N] {
        let mut sums = [Lanes::ZERO; N];
        for center in &self.centers {
            let [x, y, z, w] = center.map(Lanes::splat);
            let (dx, dy, dz) = (q[0] - x, q[1] - y, q[2] - z);
            let (value, slope) = phi(dx * dx + dy * dy + dz * dz);
            let slope = w * slope;
            let terms = [w * value, slope * dx, slope * dy, slope * dz];
            for (sum, term) in sums.iter_mut().zip(terms) {
                *sum += term;
            }
        }
        sums
    }
}

impl LocalFit {
    /// f in lengths of the unit frame at eight positions, and for N = 4 behind it its gradient (about unit length near the
    /// surface).
    pub fn evaluate<const N: usize>(&self, at: [Lanes; 3]) -> [Lanes; N] {
        let mut f: [Lanes; N] = self.faces[0].evaluate(at);
        for face in &self.faces[1..] {
            let other: [Lanes; N] = face.evaluate(at);
            let (low, high) = if self.concave {
                (other[0], f[0])
            } else {
                (f[0], other[0])
            };
            f = std::array::from_fn(|k| low.less(high, other[k], f[k]));
        }
        f
    }

    /// f and its gradient at every one of some positions.
    pub fn evaluate_all(&self, at: &[Vec3]) -> Vec<(f32, Vec3)> {
        let mut all = Vec::with_capacity(at.len());
        for block in Block::all(at, 0..at.len()) {
            let [value, gradient @ ..] = self.evaluate::<4>(block.at).map(Lanes::to_array);
            let of = |l: usize| (value[l], Vec3::from_array(gradient.map(|g| g[l])));
            all.extend((0..LANES).map(of).take(block.range.len()));
        }
        all
    }

    /// First-order distances |f|/|∇f| of some positions to f = 0.
    pub fn distances(&self, at: &[Vec3]) -> impl Iterator<Item = f32> {
        let all = self.evaluate_all(at).into_iter();
        all.map(|(value, gradient)| value.abs() / gradient.length().max(1e-3))
    }
}
