//! A fitted local function f_i (eq. 9, 10): eight positions are evaluated side by side, in single precision and in
//! coordinates of its sub-domain.

use crate::kernel::phi;
use crate::lanes::{LANES, Lanes};
use crate::neighborhood::Block;
use crate::params::Kernel;
use glam::Vec3;

/// The function of a sub-domain: one smooth function, or where there is a crease the largest or least of one for each face
/// ([`crate::faces`]).
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
    fn evaluate(&self, at: [Lanes; 3]) -> (Lanes, [Lanes; 3]) {
        let unit = Lanes::splat(1.0 / self.radius);
        let center = self.center.to_array();
        let q = [0, 1, 2].map(|axis| (at[axis] - Lanes::splat(center[axis])) * unit);
        let [l0, linear @ ..] = self.linear.map(Lanes::splat);
        let (value, gradient) = match self.kernel {
            Kernel::Triharmonic => {
                let three = Lanes::splat(3.0);
                let (value, gradient) = self.sum(q, |r2| {
                    let r = r2.sqrt();
                    (r2 * r, r)
                });
                (value, gradient.map(|g| g * three))
            }
            kernel => self.sum(q, |r2| {
                let of = |r2: f32| phi(kernel, f64::from(r2));
                (r2.map(|r2| of(r2).0 as f32), r2.map(|r2| of(r2).1 as f32))
            }),
        };
        let value = value + l0 + linear[0] * q[0] + linear[1] * q[1] + linear[2] * q[2];
        (
            value * Lanes::splat(self.radius),
            [0, 1, 2].map(|axis| gradient[axis] + linear[axis]),
        )
    }

    /// Σ w φ and Σ w φ'/r (q − c), `phi` being φ and φ'/r of r².
    #[inline(always)]
    fn sum(&self, q: [Lanes; 3], phi: impl Fn(Lanes) -> (Lanes, Lanes)) -> (Lanes, [Lanes; 3]) {
        let mut sums = [Lanes::ZERO; 4];
        for center in &self.centers {
            let [x, y, z, w] = center.map(Lanes::splat);
            let (dx, dy, dz) = (q[0] - x, q[1] - y, q[2] - z);
            let (value, slope) = phi(dx * dx + dy * dy + dz * dz);
            let slope = w * slope;
            for (sum, term) in sums
                .iter_mut()
                .zip([w * value, slope * dx, slope * dy, slope * dz])
            {
                *sum += term;
            }
        }
        let [value, gradient @ ..] = sums;
        (value, gradient)
    }
}

impl LocalFit {
    /// f in lengths of the unit frame at eight positions, and its gradient (about unit length near the surface).
    pub fn evaluate(&self, at: [Lanes; 3]) -> (Lanes, [Lanes; 3]) {
        let (mut value, mut gradient) = self.faces[0].evaluate(at);
        for face in &self.faces[1..] {
            let (other, slope) = face.evaluate(at);
            let (low, high) = if self.concave {
                (other, value)
            } else {
                (value, other)
            };
            gradient = [0, 1, 2].map(|axis| low.less(high, slope[axis], gradient[axis]));
            value = low.less(high, other, value);
        }
        (value, gradient)
    }

    /// f and its gradient at every one of some positions.
    pub fn evaluate_all(&self, at: &[Vec3]) -> Vec<(f32, Vec3)> {
        let mut all = Vec::with_capacity(at.len());
        for block in Block::all(at, 0..at.len()) {
            let (value, gradient) = self.evaluate(block.at);
            let (value, gradient) = (value.to_array(), gradient.map(Lanes::to_array));
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
