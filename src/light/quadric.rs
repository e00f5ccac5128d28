//! Sums of squared distances to planes (M. Garland, P. Heckbert, "Surface simplification using quadric error metrics", 1997).

use crate::base::linalg::outer;
use glam::DVec3;

/// Share of the matrix's trace that is added to its diagonal: where planes leave a direction open, the place stays near a guess.
const HOLD: f64 = 1e-5;

/// `Σ w (n · x - d)²` as a function of `x`, by its matrix, vector and number; coordinates are of the mesh's.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Quadric {
    /// `Σ w n nᵀ`: xx, xy, xz, yy, yz, zz.
    matrix: [f64; 6],
    /// `Σ w d n`.
    vector: DVec3,
    /// `Σ w d²`.
    number: f64,
    /// `Σ w`.
    pub(crate) weight: f64,
}

impl Quadric {
    /// Of the plane through `at` with a unit normal.
    pub(crate) fn plane(at: DVec3, normal: DVec3, weight: f64) -> Quadric {
        let d = normal.dot(at);
        Quadric {
            matrix: outer(normal).map(|x| weight * x),
            vector: normal * (weight * d),
            number: weight * d * d,
            weight,
        }
    }

    pub(crate) fn add(&mut self, other: &Quadric) {
        for (sum, x) in self.matrix.iter_mut().zip(other.matrix) {
            *sum += x;
        }
        self.vector += other.vector;
        self.number += other.number;
        self.weight += other.weight;
    }

    /// The sum at `x`; rounding never makes it negative.
    pub(crate) fn at(&self, x: DVec3) -> f64 {
        (x.dot(self.times(x)) - 2.0 * self.vector.dot(x) + self.number).max(0.0)
    }

    fn times(&self, x: DVec3) -> DVec3 {
        let [xx, xy, xz, yy, yz, zz] = self.matrix;
        DVec3::new(
            xx * x.x + xy * x.y + xz * x.z,
            xy * x.x + yy * x.y + yz * x.z,
            xz * x.x + yz * x.y + zz * x.z,
        )
    }

    /// Where the sum is least, near `guess` along directions in which it hardly changes.
    pub(crate) fn least(&self, guess: DVec3) -> Option<DVec3> {
        let [xx, xy, xz, yy, yz, zz] = self.matrix;
        let hold = HOLD * (xx + yy + zz);
        let (a, d, f) = (xx + hold, yy + hold, zz + hold);
        let right = self.vector - self.times(guess);
        // Cramer's rule of the symmetric matrix.
        let (p, q, r) = (d * f - yz * yz, xz * yz - xy * f, xy * yz - xz * d);
        let determinant = a * p + xy * q + xz * r;
        let (s, t, u) = (a * f - xz * xz, xy * xz - a * yz, a * d - xy * xy);
        let step = DVec3::new(
            p * right.x + q * right.y + r * right.z,
            q * right.x + s * right.y + t * right.z,
            r * right.x + t * right.y + u * right.z,
        ) / determinant;
        step.is_finite().then_some(guess + step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_planes_meet_in_a_point_and_one_leaves_the_guess_on_it() {
        let corner = DVec3::new(0.1, -0.2, 0.3);
        let mut sum = Quadric::default();
        for normal in DVec3::AXES {
            sum.add(&Quadric::plane(corner, normal, 2.0));
        }
        let least = sum.least(DVec3::ZERO).unwrap();
        assert!(least.distance(corner) < 1e-4, "{least}");
        assert!((sum.at(corner + DVec3::X) - 2.0).abs() < 1e-12);

        let plane = Quadric::plane(corner, DVec3::Z, 1.0);
        let guess = DVec3::new(0.4, 0.4, 0.0);
        let least = plane.least(guess).unwrap();
        assert!(least.distance(DVec3::new(0.4, 0.4, 0.3)) < 1e-4, "{least}");
        assert!(Quadric::default().least(guess).is_none());
    }
}
