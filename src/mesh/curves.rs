//! The curve that several cells tell of a crease together.

use crate::cloud::octree::Octree;
use glam::{DVec3, Vec3};
use nalgebra::{SMatrix, SVector};

/// Cosine of the largest turn, of the crease and of its normal, to another cell's that is of the same crease: 30°.
const SAME: f64 = 0.866;
/// How far beside the crease another cell may see it, in edges, and per distance along it.
const ASIDE: [f64; 2] = [0.7, 0.2];
/// Cells that tell a line, at least.
const FEWEST: usize = 5;
/// A parabola that leaves less than this share of a line's squared residual is the better curve.
const BENT: f64 = 0.5;
/// Share of the length that a parabola must be seen over on either side.
const BOTH_SIDES: f64 = 0.3;
/// Residuals, in medians of them, at which a cell's weight is a quarter.
const ODD: f64 = 2.0;

/// What a cell knows of the crease at its vertex.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OnCrease {
    pub(crate) vertex: u32,
    /// On the crease, maybe outside of the cell.
    pub(crate) point: Vec3,
    /// Along the crease, unit; zero at a corner.
    pub(crate) along: Vec3,
    /// Mean of the normals on both sides.
    pub(crate) normal: Vec3,
}

/// What the cells along a crease found, seen from one of them: how far along, and how far across in two directions.
pub(crate) struct Samples {
    origin: DVec3,
    across: [DVec3; 2],
    at: Vec<[f64; 3]>,
    weights: Vec<f64>,
    length: f64,
}

impl Samples {
    pub(crate) fn of(
        own: &OnCrease,
        creases: &[OnCrease],
        (tree, length, edge): (&Octree, f64, f64),
        found: &mut Vec<u32>,
    ) -> Option<Samples> {
        found.clear();
        let reach = length as f32;
        tree.gather(own.point - reach, own.point + reach, usize::MAX, found);
        let (origin, direction) = (own.point.as_dvec3(), own.along.as_dvec3());
        let is_same = |c: &&OnCrease| {
            let d = c.point.as_dvec3() - origin;
            let along = d.dot(direction);
            let aside = (d - along * direction).length();
            along.abs() < length
                && aside <= ASIDE[0] * edge + ASIDE[1] * along.abs()
                && f64::from(c.along.dot(own.along).abs()) >= SAME
                && f64::from(c.normal.dot(own.normal)) >= SAME
        };
        let same = || {
            let each = found
                .iter()
                .map(|&k| &creases[tree.order[k as usize] as usize]);
            each.filter(is_same)
        };
        let turned = |c: &OnCrease| c.along * c.along.dot(own.along).signum();
        let direction = same()
            .map(turned)
            .sum::<Vec3>()
            .as_dvec3()
            .try_normalize()?;
        let across = direction.any_orthonormal_pair();
        let at: Vec<[f64; 3]> = same()
            .map(|c| {
                let d = c.point.as_dvec3() - origin;
                [d.dot(direction), d.dot(across.0), d.dot(across.1)]
            })
            .collect();
        let weights = at
            .iter()
            .map(|a| (1.0 - (a[0] / length).powi(2)).max(0.0).powi(2));
        let weights: Vec<f64> = weights.collect();
        (at.len() >= FEWEST).then_some(Samples {
            origin,
            across: [across.0, across.1],
            at,
            weights,
            length,
        })
    }

    /// Whether the crease was found on both sides along it.
    pub(crate) fn is_between(&self) -> bool {
        let beyond = |side: f64| self.at.iter().any(|a| side * a[0] > 0.0);
        beyond(1.0) && beyond(-1.0)
    }

    /// Where the curve is next to the middle one.
    pub(crate) fn at_middle(mut self) -> Option<DVec3> {
        let first = self.curve(1)?;
        let off: Vec<f64> = self.at.iter().map(|a| first.off(a)).collect();
        let mut sorted = off.clone();
        let middle = sorted.len() / 2;
        let median = *sorted.select_nth_unstable_by(middle, f64::total_cmp).1;
        let odd = ODD * median.max(f64::MIN_POSITIVE);
        for (weight, off) in self.weights.iter_mut().zip(off) {
            *weight /= (1.0 + (off / odd).powi(2)).powi(2);
        }
        let line = self.curve(1)?;
        let beyond = |side: f64| {
            self.at
                .iter()
                .any(|a| side * a[0] > BOTH_SIDES * self.length)
        };
        let bent = (beyond(1.0) && beyond(-1.0))
            .then(|| self.curve(2))
            .flatten();
        let curve = match bent {
            Some(bent) if bent.squares < BENT * line.squares => bent,
            _ => line,
        };
        let [u, v] = self.across;
        Some(self.origin + u * curve.c[0][0] + v * curve.c[1][0])
    }

    /// The curve of least squares: a line (degree 1) or a parabola (2).
    fn curve(&self, degree: usize) -> Option<Curve> {
        let mut matrix = SMatrix::<f64, 3, 3>::zeros();
        let mut right = SMatrix::<f64, 3, 2>::zeros();
        let row = |a: &[f64; 3]| {
            let s = a[0] / self.length;
            SVector::<f64, 3>::new(1.0, s, if degree == 2 { s * s } else { 0.0 })
        };
        for (a, &weight) in self.at.iter().zip(&self.weights) {
            let row = row(a);
            matrix += weight * row * row.transpose();
            right += weight * row * SVector::<f64, 2>::new(a[1], a[2]).transpose();
        }
        if degree == 1 {
            matrix[(2, 2)] = 1.0;
        }
        let c = nalgebra::Cholesky::new(matrix)?.solve(&right);
        let mut curve = Curve {
            c: [0, 1].map(|k| [c[(0, k)], c[(1, k)], c[(2, k)]]),
            length: self.length,
            squares: 0.0,
        };
        let weighted = self.at.iter().zip(&self.weights);
        curve.squares = weighted
            .map(|(a, weight)| weight * curve.off(a).powi(2))
            .sum();
        Some(curve)
    }
}

/// A curve, and the weighted sum of its squared residuals.
struct Curve {
    c: [[f64; 3]; 2],
    length: f64,
    squares: f64,
}

impl Curve {
    /// Distance of a sample across the crease.
    fn off(&self, a: &[f64; 3]) -> f64 {
        let s = a[0] / self.length;
        let away = |k: usize| a[k + 1] - self.c[k][0] - s * (self.c[k][1] + s * self.c[k][2]);
        away(0).hypot(away(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::Rng;

    /// A crease seen by cells with noise; rms distance to it before and after.
    fn rms(curve: impl Fn(f64) -> DVec3, slope: impl Fn(f64) -> DVec3) -> [f64; 2] {
        let mut rng = Rng::new(2);
        let edge = 0.01;
        let cells: Vec<OnCrease> = (0..80)
            .map(|k| {
                let s = k as f64 * edge;
                let mut off = || 0.2 * edge * rng.normal();
                let point = curve(s) + DVec3::new(off(), off(), off());
                OnCrease {
                    vertex: k,
                    point: point.as_vec3(),
                    along: slope(s).normalize().as_vec3(),
                    normal: Vec3::Z,
                }
            })
            .collect();
        let tree = Octree::build(&cells.iter().map(|c| c.point).collect::<Vec<Vec3>>());
        let away = |p: DVec3| {
            let at = (0..8000).map(|k| curve(0.0001 * k as f64).distance_squared(p));
            at.fold(f64::INFINITY, f64::min)
        };
        let after = |own: &OnCrease| {
            let samples = Samples::of(own, &cells, (&tree, 8.0 * edge, edge), &mut Vec::new());
            samples.unwrap().at_middle().unwrap()
        };
        let (mut sums, inner) = ([0.0; 2], &cells[8..72]);
        for own in inner {
            sums[0] += away(own.point.as_dvec3());
            sums[1] += away(after(own));
        }
        sums.map(|sum| (sum / inner.len() as f64).sqrt())
    }

    #[test]
    fn what_several_cells_tell_is_nearer_to_the_crease() {
        let turn = DVec3::new(0.8, 0.6, 0.0);
        let [before, after] = rms(|s| s * turn, |_| turn);
        assert!(after < 0.45 * before, "{before} {after}");
        let circle = |s: f64| 0.3 * DVec3::new(libm::cos(s / 0.3), libm::sin(s / 0.3), 0.0);
        let along = |s: f64| DVec3::new(-libm::sin(s / 0.3), libm::cos(s / 0.3), 0.0);
        let [before, after] = rms(circle, along);
        assert!(after < 0.6 * before, "{before} {after}");
    }
}
