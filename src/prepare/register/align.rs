//! All poses at once, from where they are to where the surfaces lie on each other.
//!
//! Iterated closest points with the symmetric distance of Rusinkiewicz, "A symmetric objective function for ICP" (2019): across the mean of
//! the two normals, which is zero wherever both points lie on one surface of constant curvature. Points of samples need not be each
//! other's then. Every step solves the poses of all scans together, over all pairs that overlap.

use super::pose::Pose;
use super::samples::Samples;
use crate::base::par;
use crate::cloud::queries::Neighbor;
use glam::{DVec3, Vec3};
use nalgebra::{Cholesky, DMatrix, DVector, Matrix6, Vector6};

/// Cosine of the largest angle between the normals of two points that are matched.
const ALONG: f32 = 0.7;
/// Samples of one part of a sum.
const PART: usize = 512;
/// A step ends the search when no pose turns or moves by more, in cells.
const STILL: f64 = 1e-3;

/// How wide is looked, in cells.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Width {
    /// How far matches may be.
    pub(crate) reach: f32,
    /// The distance across that leaves a quarter of a match's weight.
    pub(crate) across: f64,
    /// Steps, at most.
    pub(crate) steps: usize,
    /// One of so many samples is matched.
    pub(crate) every: usize,
}

/// From a candidate to where it leads, by coarse, fine and the finest samples.
pub(crate) const WIDE: [Width; 3] = [
    width(3.0, 1.0, 10, 1),
    width(2.0, 0.4, 10, 1),
    width(2.0, 0.15, 5, 1),
];
pub(crate) const NARROW: [Width; 2] = [width(3.0, 0.5, 6, 1), width(2.0, 0.15, 8, 1)];
pub(crate) const SHARP: [Width; 2] = [width(3.0, 0.5, 8, 4), width(2.0, 0.1, 12, 4)];

const fn width(reach: f32, across: f64, steps: usize, every: usize) -> Width {
    Width {
        reach,
        across,
        steps,
        every,
    }
}

/// Moves all scans but the first. `links` are the pairs that are matched.
pub(crate) fn align(
    scans: &[&Samples],
    poses: &mut [Pose],
    links: &[(usize, usize)],
    widths: &[Width],
) {
    for width in widths {
        for _ in 0..width.steps {
            let sums: Vec<Sum> = links
                .iter()
                .map(|&(a, b)| {
                    let there = Sum::of((scans[a], &poses[a]), (scans[b], &poses[b]), width);
                    let back = Sum::of((scans[b], &poses[b]), (scans[a], &poses[a]), width);
                    there.less(&back)
                })
                .collect();
            let Some(steps) = solve(poses.len(), links, &sums) else {
                return;
            };
            let mut most: f64 = 0.0;
            for (pose, step) in poses.iter_mut().skip(1).zip(steps.chunks_exact(6)) {
                let (turn, shift) = (DVec3::from_slice(&step[..3]), DVec3::from_slice(&step[3..]));
                *pose = pose.moved(turn, shift);
                most = most.max(turn.length()).max(shift.length());
            }
            if most < STILL * f64::from(scans[0].cell) {
                break;
            }
        }
    }
}

/// Σ w J Jᵀ and Σ w r J over matches, with J = (x × m, m).
struct Sum {
    matrix: Matrix6<f64>,
    right: Vector6<f64>,
}

impl Sum {
    fn zero() -> Sum {
        Sum {
            matrix: Matrix6::zeros(),
            right: Vector6::zeros(),
        }
    }

    /// Of the samples of one scan and what is nearest of another. `right` is how the first would have to move.
    fn of((a, a_pose): (&Samples, &Pose), (b, b_pose): (&Samples, &Pose), width: &Width) -> Sum {
        let to_b = b_pose.back().after(a_pose);
        let count = a.len().div_ceil(width.every);
        let parts = count.div_ceil(PART);
        let part = |k: usize, _: &mut ()| {
            let mut sum = Sum::zero();
            for i in k * PART..((k + 1) * PART).min(count) {
                sum.add((a, i * width.every), &to_b, (b, b_pose), width);
            }
            sum
        };
        let mut sum = Sum::zero();
        for part in par::map(parts, || (), part) {
            sum.matrix += part.matrix;
            sum.right += part.right;
        }
        sum
    }

    fn add(
        &mut self,
        (a, i): (&Samples, usize),
        to_b: &Pose,
        (b, b_pose): (&Samples, &Pose),
        width: &Width,
    ) {
        let reach = width.reach * a.cell;
        let at = to_b.at(a.tree.points[i].as_dvec3());
        let limit = Neighbor {
            distance2: reach * reach,
            index: u32::MAX,
        };
        let j = b.tree.nearer_than(limit, at.as_vec3()).index as usize;
        // What is nearest to points beyond the end of a scan is not where they lie.
        if j >= b.len() || a.rim[i] || b.rim[j] {
            return;
        }
        let (own, other): (Vec3, Vec3) = (to_b.along(a.normals[i]), b.normals[j]);
        let cosine = own.dot(other);
        if cosine.abs() < ALONG {
            return;
        }
        let mean = if cosine < 0.0 {
            other - own
        } else {
            other + own
        };
        let normal = mean.as_dvec3().normalize();
        let there = b.tree.points[j].as_dvec3();
        let away = (at - there).dot(normal);
        // Geman and McClure's weight.
        let far = away / (width.across * f64::from(a.cell));
        let weight = 1.0 / ((1.0 + far * far) * (1.0 + far * far));
        let middle = b_pose.at((at + there) / 2.0);
        let normal = b_pose.turn * normal;
        let turn = middle.cross(normal);
        let row = Vector6::new(turn.x, turn.y, turn.z, normal.x, normal.y, normal.z);
        self.matrix += row * row.transpose() * weight;
        self.right -= row * (weight * away);
    }

    /// With matches that were looked for from the other side.
    fn less(mut self, back: &Sum) -> Sum {
        self.matrix += back.matrix;
        self.right -= back.right;
        self
    }
}

/// The step of every scan but the first.
fn solve(scans: usize, links: &[(usize, usize)], sums: &[Sum]) -> Option<Vec<f64>> {
    let size = 6 * (scans - 1);
    let mut matrix = DMatrix::<f64>::zeros(size, size);
    let mut right = DVector::<f64>::zeros(size);
    for (&(a, b), sum) in links.iter().zip(sums) {
        for (one, other, sign) in [(a, b, 1.0), (b, a, -1.0)] {
            if one == 0 {
                continue;
            }
            let at = 6 * (one - 1);
            let mut own = matrix.fixed_view_mut::<6, 6>(at, at);
            own += sum.matrix;
            let mut own = right.fixed_rows_mut::<6>(at);
            own += sum.right * sign;
            if other > 0 {
                let mut cross = matrix.fixed_view_mut::<6, 6>(at, 6 * (other - 1));
                cross -= sum.matrix;
            }
        }
    }
    // Ways to move that nothing holds stay still.
    let most = matrix.diagonal().max();
    for k in 0..size {
        matrix[(k, k)] += 1e-9 * most + f64::MIN_POSITIVE;
    }
    let solved = Cholesky::new(matrix)?.solve(&right);
    Some(solved.as_slice().to_vec())
}
