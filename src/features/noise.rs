//! The noise of a scan, and the supports that follow from it.
//!
//! Quadrics are fitted to the neighbours of a sample of the points. A quadric follows every surface that bends slowly, so the
//! points' distances from it are noise.

use std::ops::Range;

use glam::{DVec3, Vec3};
use nalgebra::{SMatrix, SVector};

use crate::base::linalg::Spread;
use crate::base::par;
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;

/// Points of a group.
const GROUP: usize = 16;
/// Unknowns of the quadric z = a + bx + cy + dx² + exy + fy².
const QUADRIC: usize = 6;
/// Groups whose fits measure the noise, first roughly, then with supports that follow it. About ten points each give its
/// level to 7 and to 2.5 %.
const ROUNDS: [usize; 2] = [64, 512];
/// Noise, in spacings, up to which points are left where they are, and from which they are moved all the way: on clean
/// clouds the curvature inside the fit's support looks like noise of 0.02 spacings.
const NOISE_FLOOR: Range<f32> = 0.04..0.1;

/// One of so many points of a group tells the noise within its sheet.
const SPARSE: usize = 4;
/// This share of the differences of two Gaussians is under [`UNDER`] of their standard deviation: √2 · 0.385.
const SMALLER: f32 = 0.3;
/// See [`SMALLER`].
const UNDER: f32 = 0.545;
/// Noise within sheets under this share of what stands off the quadrics says that those run between two sheets.
const OF_TWO: f32 = 0.5;

/// Supports that follow the noise.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scales {
    /// Neighbours of a quadric.
    pub(crate) fit: usize,
    /// Neighbours of a plane.
    pub(crate) plane: usize,
    /// Neighbours of the filter.
    pub(crate) filter: f32,
    /// Its standard deviation, in the unit frame.
    pub(crate) noise: f32,
    /// Of the points, in the unit frame.
    pub(crate) spacing: f32,
    /// 0: leave points where they are, 1: move them onto the surface.
    pub(crate) denoise: f32,
}

impl Scales {
    /// A fit sees the surface, not a ball of noise, when its radius, √(k/π) spacings, is a few times the noise. The counts of
    /// the planes and of the filter gave the least error of surfaces of four other models than those of the bench, at 0.1
    /// and 0.5 %; planes with half as many neighbours cost 5 to 25 % at 0.5 %.
    pub(crate) fn new(noise: f32, spacing: f32) -> Scales {
        let relative = noise / spacing.max(f32::MIN_POSITIVE);
        let ramp = (relative - NOISE_FLOOR.start) / (NOISE_FLOOR.end - NOISE_FLOOR.start);
        Scales {
            fit: (16.0 + 8.0 * relative + 12.0 * relative * relative).min(128.0) as usize,
            plane: (16.0 + 24.0 * relative + 66.0 * relative * relative).min(224.0) as usize,
            filter: (12.0 + 80.0 * relative).min(256.0),
            noise,
            spacing,
            denoise: ramp.clamp(0.0, 1.0),
        }
    }

    /// For noise of at least so much, with the same spacing.
    pub(crate) fn at_least(self, noise: f32) -> Scales {
        if noise <= self.noise {
            return self;
        }
        Scales::new(noise, self.spacing)
    }

    /// For noise of no more than so much, with the same spacing.
    pub(crate) fn at_most(self, noise: f32) -> Scales {
        if noise >= self.noise {
            return self;
        }
        Scales::new(noise, self.spacing)
    }

    /// Measures the noise of a cloud.
    pub(crate) fn measure(tree: &Octree) -> Scales {
        let groups = tree.cut(|node| node.range().len() <= GROUP);
        let mut scales = Scales::new(0.0, 1.0);
        // A noise level found with too few neighbours is low, as they then fill a ball.
        for round in ROUNDS {
            let chosen = some(&groups, round);
            let local = par::map(chosen.len(), Vec::new, |i, found| {
                let of = |k| local(tree, k, scales.fit, found);
                chosen[i].clone().map(of).collect::<Vec<Local>>()
            })
            .concat();
            // The lower quartile, as detail that the quadrics miss must not pass for noise: smooth parts tell. That of
            // the absolute value of a normal variable is 0.3186 σ; a quadric over k points of a disc takes 4/k of the
            // variance at the middle.
            let residual = quantile(local.iter().map(|l| l.residual.abs()).collect(), 4);
            let kept = (1.0 - 4.0 / scales.fit as f32).sqrt();
            let spacing = quantile(local.iter().map(|l| l.spacing).collect(), 2);
            scales = Scales::new(residual / 0.3186 / kept, spacing);
        }
        scales
    }
}

/// The noise that neighbours' offsets along their normals tell of, in place of `noise` if it is under [`OF_TWO`] of that:
/// quadrics between two sheets take their distance for noise. Most of a point's neighbours are on its own sheet, so the
/// smaller offsets are, and those are what the mean of two normals leaves, on every quadric 0 but for the noise.
pub(crate) fn within_sheets(tree: &Octree, normals: &[Vec3], scales: &Scales) -> f32 {
    let noise = scales.noise;
    let groups = tree.cut(|node| node.range().len() <= GROUP);
    let chosen = some(&groups, ROUNDS[1]);
    let mut offsets = par::map(chosen.len(), Vec::new, |g, found| {
        let mut offsets = Vec::new();
        for i in chosen[g].clone().step_by(SPARSE) {
            tree.knn(tree.points[i], scales.plane, found);
            for n in found.iter().filter(|n| n.index as usize != i) {
                let (a, b) = (normals[i], normals[n.index as usize]);
                let mean = (if a.dot(b) < 0.0 { a - b } else { a + b }) / 2.0;
                if mean != Vec3::ZERO {
                    let apart = tree.points[n.index as usize] - tree.points[i];
                    offsets.push(mean.dot(apart).abs());
                }
            }
        }
        offsets
    })
    .concat();
    if offsets.is_empty() {
        return noise;
    }
    let k = (SMALLER * offsets.len() as f32) as usize;
    let within = *offsets.select_nth_unstable_by(k, f32::total_cmp).1 / UNDER;
    if within < OF_TWO * noise {
        within
    } else {
        noise
    }
}

/// About `most` of the groups, evenly chosen.
fn some(groups: &[Range<usize>], most: usize) -> Vec<Range<usize>> {
    let step = groups.len().div_ceil(most);
    groups.iter().step_by(step).cloned().collect()
}

/// The value that 1/`parts` of the values are below.
pub(crate) fn quantile(mut values: Vec<f32>, parts: usize) -> f32 {
    let at = values.len() / parts;
    *values.select_nth_unstable_by(at, f32::total_cmp).1
}

/// What the quadric of one point tells.
#[derive(Clone, Copy)]
struct Local {
    spacing: f32,
    residual: f32,
}

fn local(tree: &Octree, i: usize, k: usize, found: &mut Vec<Neighbor>) -> Local {
    tree.knn(tree.points[i], k, found);
    let radius2 = found.last().map_or(0.0, |n| f64::from(n.distance2));
    let nearest = found
        .iter()
        .map(|n| tree.points[n.index as usize].as_dvec3());
    let fit = Quadric::new(nearest, radius2.sqrt());
    Local {
        spacing: (std::f64::consts::PI * radius2 / found.len() as f64).sqrt() as f32,
        residual: fit.map_or(0.0, |fit| fit.offset(tree.points[i].as_dvec3())) as f32,
    }
}

/// A least-squares quadric over the plane of least variance.
struct Quadric {
    mean: DVec3,
    /// Normal and two tangents of the plane.
    axes: [DVec3; 3],
    radius: f64,
    /// z = c0 + c1 x + c2 y + c3 x² + c4 xy + c5 y², lengths in radii.
    c: [f64; QUADRIC],
}

impl Quadric {
    /// `None` for points on a line or at one place; the plane alone with fewer than eight points.
    fn new(positions: impl Iterator<Item = DVec3> + Clone, radius: f64) -> Option<Quadric> {
        let Spread {
            count: points,
            mean,
            eigen,
        } = Spread::of(positions.clone());
        // Fewer than three points, or all on a line, have no normal.
        if eigen.values[1] <= 1e-12 * eigen.values[2] || radius == 0.0 {
            return None;
        }
        let mut fit = Quadric {
            mean,
            axes: eigen.vectors,
            radius,
            c: [0.0; QUADRIC],
        };
        if points >= (QUADRIC + 2) as f64 {
            fit.bend(positions, points);
        }
        Some(fit)
    }

    fn local(&self, p: DVec3) -> [f64; 3] {
        let d = (p - self.mean) / self.radius;
        let [normal, u, v] = self.axes;
        [d.dot(u), d.dot(v), d.dot(normal)]
    }

    /// Solves for the quadric's coefficients; leaves the plane where the system is singular.
    fn bend(&mut self, positions: impl Iterator<Item = DVec3>, points: f64) {
        let mut ata = SMatrix::<f64, QUADRIC, QUADRIC>::zeros();
        let mut atz = SVector::<f64, QUADRIC>::zeros();
        for p in positions {
            let [x, y, z] = self.local(p);
            let row = [1.0, x, y, x * x, x * y, y * y];
            for a in 0..QUADRIC {
                for b in a..QUADRIC {
                    ata[(b, a)] += row[a] * row[b];
                }
                atz[a] += row[a] * z;
            }
        }
        // Keeps the system regular when the points lie on a conic; far below any curvature that matters.
        for a in 0..QUADRIC {
            ata[(a, a)] += 1e-9 * points;
        }
        if let Some(cholesky) = nalgebra::Cholesky::new(ata) {
            self.c.copy_from_slice(cholesky.solve(&atz).as_slice());
        }
    }

    /// Signed distance of `p` from the quadric: the vertical distance, foreshortened by the slope.
    fn offset(&self, p: DVec3) -> f64 {
        let c = &self.c;
        let [x, y, z] = self.local(p);
        let height = c[0] + c[1] * x + c[2] * y + c[3] * x * x + c[4] * x * y + c[5] * y * y;
        let (dx, dy) = (
            c[1] + 2.0 * c[3] * x + c[4] * y,
            c[2] + c[4] * x + 2.0 * c[5] * y,
        );
        (z - height) * self.radius / (1.0 + dx * dx + dy * dy).sqrt()
    }
}
