//! The linear system of one sub-domain (eq. 11), and how it is solved.

use crate::base::kernel::phi;
use crate::base::params::Kernel;
use crate::cloud::queries::Neighbor;
use crate::fit::cells::{Sites, Subdomain};
use crate::fit::local::Rbf;
use glam::{DMat3, DMat4, DVec3, DVec4, Vec3, Vec4Swizzles};
use std::cmp::Ordering;

/// Offsets d along the normal, in spacings: without noise and at a noise of half a spacing and more.
const OFFSET: [f32; 2] = [0.6, 1.5];
/// How strongly surfaces of unit diagonal vary at unit distance, as the factor of r³ in their covariance. Measured on
/// bunny, armadillo and fandisk, full and reduced, at noise 0.1 and 0.5 %: errors are lowest for 0.17 to 0.33 and 5 %
/// higher at half and twice that.
const ROUGHNESS: f64 = 0.25;
/// Volume, in cubes of the sub-domain's radius, from which four centres are taken for not lying in a plane.
const FLAT: f64 = 1e-9;
/// Added to the diagonal, in φ at one spacing, where centres that nearly coincide leave the matrix no inverse.
const LEAST_RIDGE: f64 = 1e-9;

/// The weights of all centres, and λ0 … λ3.
type Solution = (Vec<f64>, [f64; 4]);

/// Eq. 11 of one sub-domain, in its own coordinates: origin at the mean of its support, unit its radius.
pub(super) struct System {
    kernel: Kernel,
    center: Vec3,
    radius: f32,
    /// Sites first, then offset points.
    centers: Vec<DVec3>,
    /// Wanted values h_i.
    values: Vec<f64>,
    sites: usize,
    /// φ at one spacing.
    pub(super) unit_phi: f64,
}

impl System {
    pub(super) fn new(
        through: &[(u32, Vec3)],
        s: &Subdomain,
        sites: &Sites,
        kernel: Kernel,
    ) -> System {
        let position = |i: u32| sites.tree.points[i as usize];
        let positions = || through.iter().map(|&(i, _)| position(i));
        let center = positions().sum::<Vec3>() / through.len() as f32;
        let reach = positions().map(|p| p.distance(center)).fold(0.0, f32::max);
        let radius = if reach > 0.0 { reach } else { 1.0 };
        let local = |p: Vec3| ((p - center) / radius).as_dvec3();
        let mut centers: Vec<DVec3> = positions().map(local).collect();
        let mut values = vec![0.0; centers.len()];
        // Every second site has offset points: the function is smooth at the scale of the spacing.
        for &(i, normal) in through.iter().step_by(2) {
            let spacing = sites.spacing[i as usize];
            let relative = (2.0 * sites.noise / spacing.max(f32::MIN_POSITIVE)).min(1.0);
            let wanted = spacing * (OFFSET[0] + relative * (OFFSET[1] - OFFSET[0]));
            for sign in [1.0, -1.0] {
                if let Some(d) = free_offset(sites, s, i, normal * sign, wanted) {
                    centers.push(local(position(i) + normal * (sign * d)));
                    values.push((sign * d / radius) as f64);
                }
            }
        }
        let spacing = (sites.spacing[through[0].0 as usize] / radius) as f64;
        let unit_phi = phi(kernel, spacing * spacing).0.abs();
        System {
            kernel,
            center,
            radius,
            centers,
            values,
            sites: through.len(),
            unit_phi,
        }
    }

    /// Eq. 11 with `ridge` on its diagonal; `None` when it has no solution, or one of no use.
    pub(super) fn solve(&self, ridge: f64) -> Option<Rbf> {
        if self.sites < 4 {
            return None;
        }
        let small =
            |(weights, linear): &Solution| weights.iter().chain(linear).all(|w| w.abs() < 1e9);
        let least = ridge + LEAST_RIDGE * self.unit_phi;
        let solution = self.weights(ridge).filter(small);
        let solution = solution.or_else(|| self.weights(least).filter(small));
        solution.map(|(weights, linear)| self.fitted(&weights, linear))
    }

    /// The weights are orthogonal to linear polynomials, so those of four centres follow from the others. On what is left the
    /// kernel is positive definite (Wendland 2005, section 8.1), and Cholesky's factor serves. `None` where rounding leaves it
    /// otherwise, or where all centres lie in a plane.
    fn weights(&self, ridge: f64) -> Option<Solution> {
        let corners = corners(&self.centers)?;
        let at = corners.map(|i| self.centers[i]);
        let inverse = DMat3::from_cols(at[1] - at[0], at[2] - at[0], at[3] - at[0]).inverse();
        let phi = |a: DVec3, b: DVec3| phi(self.kernel, a.distance_squared(b)).0;
        let among = DMat4::from_cols_array_2d(
            &[0, 1, 2, 3]
                .map(|i| [0, 1, 2, 3].map(|j| if i == j { ridge } else { phi(at[i], at[j]) })),
        );
        let heights = DVec4::from_array(corners.map(|i| self.values[i]));
        let others: Vec<usize> = (0..self.centers.len())
            .filter(|i| !corners.contains(i))
            .collect();
        let count = others.len();
        // Of each other centre: its barycentric coordinates in the corners, φ to them, and what of that counts twice.
        let rows: Vec<[DVec4; 3]> = others
            .iter()
            .map(|&i| {
                let l = inverse * (self.centers[i] - at[0]);
                let l = DVec4::new(1.0 - l.x - l.y - l.z, l.x, l.y, l.z);
                let to = DVec4::from_array(at.map(|corner| phi(self.centers[i], corner)));
                [l, to, to - 0.5 * (among * l)]
            })
            .collect();
        let mut m = vec![0.0; count * count];
        let mut weights = Vec::with_capacity(count);
        for (j, &center) in others.iter().enumerate() {
            let [l, _, f] = rows[j];
            for (i, value) in m[j * count..][..count].iter_mut().enumerate().skip(j) {
                let [m, _, g] = rows[i];
                *value = phi(self.centers[others[i]], self.centers[center]) - g.dot(l) - m.dot(f);
            }
            m[j * count + j] += ridge;
            weights.push(self.values[center] - l.dot(heights));
        }
        cholesky(&mut m, &mut weights)?;
        let (mut at_corners, mut left) = (DVec4::ZERO, heights);
        for (&[l, to, _], &w) in rows.iter().zip(&weights) {
            at_corners -= w * l;
            left -= w * to;
        }
        left -= among * at_corners;
        let slope = inverse.transpose() * (left.yzw() - left.x);
        let mut all = vec![0.0; self.centers.len()];
        for (&i, &w) in others.iter().zip(&weights) {
            all[i] = w;
        }
        for (&i, w) in corners.iter().zip(at_corners.to_array()) {
            all[i] = w;
        }
        Some((all, [left.x - slope.dot(at[0]), slope.x, slope.y, slope.z]))
    }

    /// The diagonal of eq. 11 for this noise: the variance of a value against that of the function, in local units
    /// (kriging with the kernel as generalised covariance: Matheron, 1973).
    pub(super) fn ridge_for(&self, noise: f64) -> f64 {
        noise * noise / (ROUGHNESS * (self.radius as f64).powi(3))
    }

    /// The mean plane of the support, for sub-domains that eq. 11 cannot serve.
    pub(super) fn plane(&self, through: &[(u32, Vec3)]) -> Rbf {
        let sum: Vec3 = through.iter().map(|&(_, n)| n).sum();
        let n = sum.normalize_or_zero().as_dvec3();
        self.fitted(&[], [0.0, n.x, n.y, n.z])
    }

    fn fitted(&self, weights: &[f64], linear: [f64; 4]) -> Rbf {
        let centers = self.centers.iter().zip(weights);
        let centers = centers
            .map(|(c, &w)| [c.x as f32, c.y as f32, c.z as f32, w as f32])
            .collect();
        let (kernel, center, radius) = (self.kernel, self.center, self.radius);
        Rbf {
            kernel,
            center,
            radius,
            centers,
            linear: linear.map(|l| l as f32),
        }
    }
}

/// Four centres that are far from being in one plane, found one after the other.
fn corners(centers: &[DVec3]) -> Option<[usize; 4]> {
    let farthest = |measure: &dyn Fn(DVec3) -> f64| {
        let measures = centers.iter().map(|&c| measure(c)).enumerate();
        measures.fold(
            (0, 0.0),
            |best, next| if next.1 > best.1 { next } else { best },
        )
    };
    let (a, _) = farthest(&|c| c.length_squared());
    let (b, _) = farthest(&|c| c.distance_squared(centers[a]));
    let edge = centers[b] - centers[a];
    let (c, _) = farthest(&|c| (c - centers[a]).cross(edge).length_squared());
    let normal = edge.cross(centers[c] - centers[a]);
    let (d, volume) = farthest(&|d| (d - centers[a]).dot(normal).abs());
    (volume > FLAT).then_some([a, b, c, d])
}

/// Solves m x = b for a symmetric positive definite matrix, of which the columns' parts at and below the diagonal count. `b`
/// becomes x. `None` where the matrix is not so.
fn cholesky(m: &mut [f64], b: &mut [f64]) -> Option<()> {
    let n = b.len();
    for j in 0..n {
        let (done, rest) = m.split_at_mut(j * n);
        let column = &mut rest[j..n];
        let diagonal = column[0];
        let mut fours = done.chunks_exact(4 * n);
        for four in &mut fours {
            let [p, q, r, s] = [0, 1, 2, 3].map(|k| &four[k * n + j..(k + 1) * n]);
            let [fp, fq, fr, fs] = [p[0], q[0], r[0], s[0]];
            for ((((value, p), q), r), s) in column.iter_mut().zip(p).zip(q).zip(r).zip(s) {
                *value -= (fp * p + fq * q) + (fr * r + fs * s);
            }
        }
        for one in fours.remainder().chunks_exact(n) {
            let factor = one[j];
            for (value, p) in column.iter_mut().zip(&one[j..]) {
                *value -= factor * p;
            }
        }
        if column[0].partial_cmp(&(f64::EPSILON * diagonal)) != Some(Ordering::Greater) {
            return None;
        }
        let unit = 1.0 / column[0].sqrt();
        for value in column.iter_mut() {
            *value *= unit;
        }
        let y = b[j] * unit;
        b[j] = y;
        for (value, l) in b[j + 1..].iter_mut().zip(&column[1..]) {
            *value -= y * l;
        }
    }
    for j in (0..n).rev() {
        let column = &m[j * n + j..(j + 1) * n];
        let known: f64 = column[1..]
            .iter()
            .zip(&b[j + 1..])
            .map(|(l, x)| l * x)
            .sum();
        b[j] = (b[j] - known) / column[0];
    }
    Some(())
}

/// The largest of d, d/2, d/4 for which the point at distance d along `normal` from site `i` is nearest to a site of
/// its own sub-domain and really that far from it: offset points never reach another sheet.
fn free_offset(sites: &Sites, s: &Subdomain, i: u32, normal: Vec3, wanted: f32) -> Option<f32> {
    let p = sites.tree.points[i as usize];
    [wanted, 0.5 * wanted, 0.25 * wanted]
        .into_iter()
        .find(|&d| {
            let own = Neighbor {
                distance2: d * d,
                index: i,
            };
            let near = sites.tree.nearer_than(own, p + normal * d);
            s.support.contains(&near.index) && near.distance2.sqrt() >= 0.6 * d
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sites on a sphere with offset points at half of them.
    fn ball(kernel: Kernel) -> System {
        let mut centers = Vec::new();
        let mut values = Vec::new();
        for i in 0..24 {
            let (z, turn) = (1.0 - (f64::from(i) + 0.5) / 12.0, f64::from(i) * 2.4);
            let around = (1.0 - z * z).sqrt();
            centers.push(DVec3::new(
                around * libm::cos(turn),
                around * libm::sin(turn),
                z,
            ));
            values.push(0.0);
        }
        for i in 0..12 {
            for d in [-0.25, 0.25] {
                centers.push(centers[2 * i] * (1.0 + d));
                values.push(d);
            }
        }
        System {
            kernel,
            center: Vec3::ZERO,
            radius: 1.0,
            centers,
            values,
            sites: 24,
            unit_phi: 1.0,
        }
    }

    #[test]
    fn weights_solve_eq_11() {
        for kernel in [Kernel::Biharmonic, Kernel::Triharmonic, Kernel::ThinPlate] {
            for ridge in [0.0, 1e-3] {
                let system = ball(kernel);
                let (weights, linear) = system.weights(ridge).unwrap();
                let moments = system.centers.iter().zip(&weights);
                let total = moments.fold(DVec4::ZERO, |sum, (c, &w)| sum + w * c.extend(1.0));
                assert!(total.length() < 1e-9, "{total}");
                for (i, &at) in system.centers.iter().enumerate() {
                    let sum: f64 = (system.centers.iter().zip(&weights))
                        .map(|(c, w)| w * phi(kernel, c.distance_squared(at)).0)
                        .sum();
                    let [l0, x, y, z] = linear;
                    let found = sum + ridge * weights[i] + l0 + at.dot(DVec3::new(x, y, z));
                    assert!(
                        (found - system.values[i]).abs() < 1e-9,
                        "{kernel:?}: {found}"
                    );
                }
            }
        }
    }

    #[test]
    fn centres_in_a_plane_have_no_weights() {
        let mut flat = ball(Kernel::Triharmonic);
        for center in &mut flat.centers {
            center.z = 0.0;
        }
        assert!(flat.solve(1e-3).is_none());
        // Two centres at one place, with the same value.
        let mut twice = ball(Kernel::Triharmonic);
        twice.centers.push(twice.centers[0]);
        twice.values.push(0.0);
        assert!(twice.weights(0.0).is_none() && twice.solve(0.0).is_some());
        assert_eq!(cholesky(&mut [1.0, 2.0, 0.0, 1.0], &mut [1.0, 1.0]), None);
        assert_eq!(cholesky(&mut [f64::NAN], &mut [1.0]), None);
    }
}
