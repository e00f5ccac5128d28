//! 3×3 symmetric eigen-decomposition, the inner loop of every normal, and how points spread.

use crate::base::lanes::Lanes;
use glam::DVec3;

/// Eigenvalues in ascending order with their unit vectors, a right-handed frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SymEigen {
    /// λ0 ≤ λ1 ≤ λ2.
    pub values: [f64; 3],
    /// Unit and mutually orthogonal; `vectors[0]` of a covariance is the normal.
    pub vectors: [DVec3; 3],
}

/// How some points spread.
#[derive(Debug, Clone, Copy)]
pub struct Spread {
    /// How many they are.
    pub count: f64,
    /// Their mean.
    pub mean: DVec3,
    /// Of Σ (p − mean) (p − mean)ᵀ: variances times [`Spread::count`], with their directions.
    pub eigen: SymEigen,
}

impl Spread {
    /// Of these points, which are asked for twice.
    pub fn of(points: impl Iterator<Item = DVec3> + Clone) -> Spread {
        let (mut sum, mut count) = (DVec3::ZERO, 0.0);
        for p in points.clone() {
            sum += p;
            count += 1.0;
        }
        let mean = sum / count;
        let mut squares = [0.0; 6];
        for p in points {
            for (sum, product) in squares.iter_mut().zip(outer(p - mean)) {
                *sum += product;
            }
        }
        Spread {
            count,
            mean,
            eigen: sym_eigen(&squares),
        }
    }

    /// Variances along the eigenvectors, ascending.
    pub fn variances(&self) -> [f64; 3] {
        self.eigen.values.map(|value| value / self.count)
    }
}

/// v vᵀ as `[xx, xy, xz, yy, yz, zz]`.
pub fn outer(v: DVec3) -> [f64; 6] {
    [
        v.x * v.x,
        v.x * v.y,
        v.x * v.z,
        v.y * v.y,
        v.y * v.z,
        v.z * v.z,
    ]
}

/// Decomposes the symmetric matrix `[xx, xy, xz, yy, yz, zz]` by cyclic Jacobi rotations (Golub and Van Loan, *Matrix
/// Computations*, section 8.5): accurate to rounding for close and for zero eigenvalues, where the closed formula is not.
pub fn sym_eigen(m: &[f64; 6]) -> SymEigen {
    let mut a = [[m[0], m[1], m[2]], [m[1], m[3], m[4]], [m[2], m[4], m[5]]];
    let mut v = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let scale = m.iter().fold(0.0f64, |s, x| s.max(x.abs()));
    // Convergence is quadratic: 3 to 5 sweeps reach rounding, 12 is a bound that was never met.
    for _ in 0..12 {
        let off = a[0][1].abs() + a[0][2].abs() + a[1][2].abs();
        if off <= 1e-15 * scale {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            rotate(&mut a, &mut v, p, q);
        }
    }
    let mut order: [usize; 3] = [0, 1, 2];
    for (i, j) in [(0, 1), (1, 2), (0, 1)] {
        if a[order[j]][order[j]] < a[order[i]][order[i]] {
            order.swap(i, j);
        }
    }
    let column = |j: usize| DVec3::new(v[0][j], v[1][j], v[2][j]);
    let (e0, e1) = (column(order[0]).normalize_or_zero(), column(order[1]));
    let e1 = (e1 - e0 * e0.dot(e1)).normalize_or_zero();
    SymEigen {
        values: order.map(|i| a[i][i]),
        vectors: [e0, e1, e0.cross(e1)],
    }
}

/// One Jacobi rotation that makes `a[p][q]` zero.
fn rotate(a: &mut [[f64; 3]; 3], v: &mut [[f64; 3]; 3], p: usize, q: usize) {
    if a[p][q] == 0.0 {
        return;
    }
    let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    let r = 3 - p - q;
    let apq = a[p][q];
    a[p][p] -= t * apq;
    a[q][q] += t * apq;
    a[p][q] = 0.0;
    a[q][p] = 0.0;
    let (arp, arq) = (a[r][p], a[r][q]);
    a[r][p] = c * arp - s * arq;
    a[p][r] = a[r][p];
    a[r][q] = s * arp + c * arq;
    a[q][r] = a[r][q];
    for row in v.iter_mut() {
        let (vp, vq) = (row[p], row[q]);
        row[p] = c * vp - s * vq;
        row[q] = s * vp + c * vq;
    }
}

/// Of eight positive semidefinite matrices `[xx, xy, xz, yy, yz, zz]`: the least eigenvalue over the trace, and its unit
/// eigenvector, zero where it is none (two eigenvalues are zero, or all are equal).
///
/// Newton's method from 0 reaches the least root of the characteristic polynomial from below, as that is concave there; the
/// eigenvector is the longest product of two rows of what is left.
pub fn least_axis(m: [Lanes; 6]) -> (Lanes, [Lanes; 3]) {
    /// Quadratic convergence: 1e-7 of the trace is reached in 4 steps where the root is well apart, in 7 where it nearly
    /// is a double one, and there the eigenvector means little.
    const STEPS: usize = 7;
    /// Sum of the principal minors, about the second eigenvalue over the trace, below which it is rounding.
    const LINE: f32 = 1e-6;
    let tiny = Lanes::splat(f32::MIN_POSITIVE);
    let one = Lanes::splat(1.0);
    let scale = one / (m[0] + m[3] + m[5]).max(tiny);
    let [xx, xy, xz, yy, yz, zz] = m.map(|x| x * scale);
    let minor = |a: Lanes, b: Lanes, c: Lanes| a * b - c * c;
    let c1 = minor(xx, yy, xy) + minor(yy, zz, yz) + minor(zz, xx, xz);
    let c0 = xx * minor(yy, zz, yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    let mut root = Lanes::ZERO;
    for _ in 0..STEPS {
        let value = ((root - one) * root + c1) * root - c0;
        let slope = (Lanes::splat(3.0) * root - Lanes::splat(2.0)) * root + c1;
        root = (root - value / slope.max(tiny))
            .max(Lanes::ZERO)
            .min(Lanes::splat(1.0 / 3.0));
    }
    let (xx, yy, zz) = (xx - root, yy - root, zz - root);
    let products = [
        [xy * yz - xz * yy, xz * xy - xx * yz, xx * yy - xy * xy],
        [yy * zz - yz * yz, yz * xz - xy * zz, xy * yz - yy * xz],
        [xy * zz - xz * yz, xz * xz - xx * zz, xx * yz - xy * xz],
    ];
    let square = |v: [Lanes; 3]| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    let mut axis = products[0];
    for other in &products[1..] {
        let (longest, length) = (square(axis), square(*other));
        axis = [0, 1, 2].map(|a| longest.less(length, other[a], axis[a]));
    }
    let length2 = square(axis);
    let unit = length2.less(tiny, Lanes::ZERO, one / length2.max(tiny).sqrt());
    let unit = c1.less(Lanes::splat(LINE), Lanes::ZERO, unit);
    (root, axis.map(|x| x * unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvectors_satisfy_their_definition() {
        let mut rng = crate::base::rng::Rng::new(1);
        for k in 0..1000 {
            let mut m = [0.0; 6];
            m.iter_mut().for_each(|x| *x = rng.normal());
            if k % 3 == 0 {
                // rank 1: two zero eigenvalues
                let d = [m[0], m[1], m[2]];
                m = [
                    d[0] * d[0],
                    d[0] * d[1],
                    d[0] * d[2],
                    d[1] * d[1],
                    d[1] * d[2],
                    d[2] * d[2],
                ];
            }
            let e = sym_eigen(&m);
            for (l, v) in e.values.iter().zip(e.vectors) {
                let mv = DVec3::new(
                    m[0] * v.x + m[1] * v.y + m[2] * v.z,
                    m[1] * v.x + m[3] * v.y + m[4] * v.z,
                    m[2] * v.x + m[4] * v.y + m[5] * v.z,
                );
                assert!((mv - *l * v).length() < 1e-13 * 10.0, "{m:?}");
                assert!((v.length() - 1.0).abs() < 1e-12);
            }
            assert!(e.values[0] <= e.values[1] && e.values[1] <= e.values[2]);
        }
        assert_eq!(sym_eigen(&[0.0; 6]).vectors, [DVec3::X, DVec3::Y, DVec3::Z]);
    }

    #[test]
    fn least_axes_are_those_of_the_exact_decomposition() {
        let mut rng = crate::base::rng::Rng::new(2);
        for k in 0..200 {
            // Covariances of flat clouds: a thin one, a clean plane, a line, a point.
            let thickness = [0.3, 1e-3, 0.0, 0.0, 0.0][k % 5];
            let width = [1.0, 1.0, 1.0, 0.0, 0.0][k % 5];
            let length = [1.0, 3.0, 1.0, 1.0, 0.0][k % 5];
            let frame = sym_eigen(&std::array::from_fn(|_| rng.normal())).vectors;
            let mut m = [0.0; 6];
            for (axis, size) in frame.iter().zip([thickness, width, length]) {
                let square = outer(*axis * size);
                m.iter_mut().zip(square).for_each(|(sum, x)| *sum += x);
            }
            let (value, axis) = least_axis(m.map(|x| Lanes::splat(x as f32)));
            let axis = DVec3::new(
                axis[0].lane(3).into(),
                axis[1].lane(3).into(),
                axis[2].lane(3).into(),
            );
            let trace = m[0] + m[3] + m[5];
            if width == 0.0 {
                assert_eq!(axis, DVec3::ZERO, "{m:?}");
            } else {
                let share = thickness * thickness / trace;
                assert!(
                    (f64::from(value.lane(0)) - share).abs() < 1e-5,
                    "{value:?} {share}"
                );
                assert!(axis.dot(frame[0]).abs() > 1.0 - 1e-5, "{axis} {}", frame[0]);
            }
        }
    }
}
