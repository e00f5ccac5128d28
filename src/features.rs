//! What the points say of the surface around them: spacing, unoriented normal, curvature, surface variation, noise.
//!
//! 1. A quadric is fitted to the nearest neighbours of every point: normal, curvature, and the noise from its residuals.
//! 2. Normals are averaged over a support that grows with the noise, over neighbours whose normals agree (a bilateral
//!    filter: Jones, Durand, Desbrun, "Non-iterative, feature-preserving mesh smoothing", 2003), so that creases become
//!    sharp and stay so. How fast the averaged normals turn is the curvature.
//! 3. Each point's distance to the surface is the mean of `½ (n_i + n_j)·(x_i - x_j)` over the same neighbours: exact on
//!    every quadric, with a third of the variance that fitting one would have, and blind to the far side of a crease.
//!    By that distance noisy points are moved.

use crate::error::Result;
use crate::filter::{Filter, Step};
use crate::linalg::{SymEigen, sym_eigen};
use crate::octree::{Neighbor, Octree};
use crate::par;
use crate::progress::{Progress, Stage};
use glam::{DVec3, Vec3};
use nalgebra::{SMatrix, SVector};
use std::ops::Range;

/// Per-point features in the octree's (Morton) order; lengths in the unit frame.
#[derive(Debug, Clone)]
pub struct Features {
    /// Wanted distance of neighbours on the surface, √(area a point), from the area of the disc that holds k neighbours.
    pub spacing: Vec<f32>,
    /// Unit normal of arbitrary sign, filtered; zero where there is none.
    pub normals: Vec<Vec3>,
    /// √(κ1² + κ2²) of the principal curvatures, from how the normals turn, 1/length; 1/support at most.
    pub curvature: Vec<f32>,
    /// Surface variation λ0/(λ0+λ1+λ2) of the neighbours, 0 (flat) to 1/3 (Pauly, Gross, Kobbelt, "Efficient
    /// simplification of point-sampled surfaces", 2002).
    pub variation: Vec<f32>,
    /// Signed distance of the point to the surface, along its normal, 0 without noise: `point - residual * normal` is denoised.
    pub residual: Vec<f32>,
    /// Estimated standard deviation of the noise across the surface.
    pub noise: f32,
}

/// Points that look for their neighbours together.
const GROUP: usize = 16;
/// Unknowns of the quadric z = a + bx + cy + dx² + exy + fy².
const QUADRIC: usize = 6;
/// Groups whose fits measure the noise: 16 points each give its level to about 1 %.
const NOISE_GROUPS: usize = 512;
/// Noise, in spacings, up to which points are left where they are, and from which they are moved all the way: on clean
/// clouds the curvature inside the fit's support looks like noise of 0.02 spacings.
const NOISE_FLOOR: Range<f32> = 0.04..0.1;

/// Supports that follow the noise.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scales {
    /// Neighbours of a quadric.
    fit: usize,
    /// Neighbours of the filter.
    pub(crate) filter: f32,
    noise: f32,
    /// 0: leave points where they are, 1: move them onto the surface.
    pub(crate) denoise: f32,
}

impl Scales {
    /// A fit sees the surface, not a ball of noise, when its radius, √(k/π) spacings, is a few times the noise. The filter's
    /// counts gave the least error of Poisson surfaces of four other models than those of the bench, at 0.1 and 0.5 %.
    pub(crate) fn new(noise: f32, spacing: f32) -> Scales {
        let relative = noise / spacing.max(f32::MIN_POSITIVE);
        let ramp = (relative - NOISE_FLOOR.start) / (NOISE_FLOOR.end - NOISE_FLOOR.start);
        Scales {
            fit: (16.0 + 8.0 * relative + 12.0 * relative * relative).min(128.0) as usize,
            filter: (12.0 + 80.0 * relative).min(256.0),
            noise,
            denoise: ramp.clamp(0.0, 1.0),
        }
    }
}

impl Features {
    /// Measures them. Cost: one fit and two filter sums a point; about log n + 100 steps a point.
    pub fn measure(tree: &Octree, progress: &mut dyn Progress) -> Result<Features> {
        // Copies of a point say nothing of the surface: one of each is measured, and they share its area.
        let copies: Vec<Range<usize>> = copies(&tree.points);
        if copies.len() == tree.points.len() {
            return Features::measure_distinct(tree, progress);
        }
        let distinct: Vec<Vec3> = copies.iter().map(|c| tree.points[c.start]).collect();
        let one = Features::measure_distinct(&Octree::build(&distinct), progress)?;
        let each = || {
            copies
                .iter()
                .enumerate()
                .flat_map(|(i, c)| c.clone().map(move |_| (i, c.len())))
        };
        let spread = |v: &[f32]| each().map(|(i, _)| v[i]).collect::<Vec<f32>>();
        Ok(Features {
            spacing: each()
                .map(|(i, n)| one.spacing[i] / (n as f32).sqrt())
                .collect(),
            normals: each().map(|(i, _)| one.normals[i]).collect(),
            curvature: spread(&one.curvature),
            variation: spread(&one.variation),
            residual: spread(&one.residual),
            noise: one.noise,
        })
    }

    fn measure_distinct(tree: &Octree, progress: &mut dyn Progress) -> Result<Features> {
        let groups = tree.cut(|node| node.range().len() <= GROUP);
        let scales = scales(tree, &groups);
        let mut part = Part {
            progress,
            from: 0.0,
            to: 0.6,
        };
        let local: Vec<Local> = par::map_progress(
            groups.len(),
            40.0,
            (Stage::Features, &mut part),
            Scratch::default,
            |i, scratch| scratch.group(tree, groups[i].clone(), scales.fit),
        )?
        .concat();
        let mut features = Features {
            spacing: local.iter().map(|l| l.spacing).collect(),
            normals: local.iter().map(|l| l.normal).collect(),
            curvature: vec![0.0; local.len()],
            variation: local.iter().map(|l| l.variation).collect(),
            residual: vec![0.0; local.len()],
            noise: scales.noise,
        };
        for (from, to, step) in [(0.6, 0.8, Step::Normals), (0.8, 1.0, Step::Offsets)] {
            let mut part = Part {
                progress: part.progress,
                from,
                to,
            };
            let filtered = par::map_progress(
                groups.len(),
                20.0,
                (Stage::Features, &mut part),
                Filter::default,
                |i, filter| filter.group(tree, &features, groups[i].clone(), step),
            )?
            .concat();
            match step {
                Step::Normals => features.normals = filtered.iter().map(|f| f.normal).collect(),
                Step::Offsets => {
                    features.residual = filtered.iter().map(|f| f.offset).collect();
                    features.curvature = filtered.iter().map(|f| f.curvature).collect();
                }
            }
        }
        Ok(features)
    }

    /// The points moved onto their local quadrics.
    pub fn denoised(&self, tree: &Octree) -> Vec<Vec3> {
        let moved = |i: usize| tree.points[i] - self.residual[i] * self.normals[i];
        (0..tree.points.len()).map(moved).collect()
    }

    /// Median of the spacing.
    pub fn median_spacing(&self) -> f32 {
        median(self.spacing.clone())
    }
}

/// Runs of equal points. In Morton order copies follow each other, unless another point shares their cell of 2⁻²¹.
fn copies(points: &[Vec3]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::with_capacity(points.len());
    for (i, p) in points.iter().enumerate() {
        match runs.last_mut() {
            Some(run) if points[run.start] == *p => run.end = i + 1,
            _ => runs.push(i..i + 1),
        }
    }
    runs
}

/// A part of a stage's progress.
struct Part<'a> {
    progress: &'a mut dyn Progress,
    from: f32,
    to: f32,
}

impl Progress for Part<'_> {
    fn update(&mut self, stage: Stage, fraction: f32) -> Result<()> {
        self.progress
            .update(stage, self.from + (self.to - self.from) * fraction)
    }
}

/// The noise from the fits of some groups, and the supports that follow from it.
fn scales(tree: &Octree, groups: &[Range<usize>]) -> Scales {
    let mut scales = Scales::new(0.0, 1.0);
    // Twice: a noise level found with too few neighbours is low, as they then fill a ball.
    for _ in 0..2 {
        let step = groups.len().div_ceil(NOISE_GROUPS);
        let chosen: Vec<Range<usize>> = groups.iter().step_by(step).cloned().collect();
        let local = par::map(chosen.len(), Scratch::default, |i, scratch| {
            scratch.group(tree, chosen[i].clone(), scales.fit)
        })
        .concat();
        // The lower quartile, as detail that the quadrics miss must not pass for noise: smooth parts tell. That of the
        // absolute value of a normal variable is 0.3186 σ; a quadric over k points of a disc takes 4/k of the variance at
        // the middle.
        let residual = quantile(local.iter().map(|l| l.residual.abs()).collect(), 4);
        let kept = (1.0 - 4.0 / scales.fit as f32).sqrt();
        let spacing = median(local.iter().map(|l| l.spacing).collect());
        scales = Scales::new(residual / 0.3186 / kept, spacing);
    }
    scales
}

fn median(values: Vec<f32>) -> f32 {
    quantile(values, 2)
}

/// The value that 1/`parts` of the values are below.
fn quantile(mut values: Vec<f32>, parts: usize) -> f32 {
    values.sort_unstable_by(f32::total_cmp);
    values[values.len() / parts]
}

/// What the quadric of one point tells.
#[derive(Debug, Clone, Copy, Default)]
struct Local {
    spacing: f32,
    normal: Vec3,
    variation: f32,
    residual: f32,
}

/// Memory of one worker.
#[derive(Default)]
struct Scratch {
    found: Vec<Neighbor>,
    candidates: Vec<Neighbor>,
    /// (squared distance, index) of the candidates, as integers that order the same way.
    keys: Vec<u64>,
    nearest: Vec<u32>,
}

impl Scratch {
    /// The features of the points `range`, which lie close together, from `k` neighbours each.
    fn group(&mut self, tree: &Octree, range: Range<usize>, k: usize) -> Vec<Local> {
        let (center, extent) = ball(&tree.points[range.clone()]);
        tree.knn(center, k, &mut self.found);
        let reach = self.found[self.found.len() - 1].distance2.sqrt();
        // Every point of the group has its nearest ones within `reach` plus twice the way to the centre. Groups that an
        // outlier stretches ask the tree for each point.
        let together = extent <= 2.0 * reach && reach > 0.0;
        if together {
            tree.within(center, reach + 2.0 * extent, &mut self.candidates);
        }
        range
            .map(|i| {
                if together {
                    self.select(tree, i, k);
                } else {
                    tree.knn(tree.points[i], k, &mut self.found);
                    self.keys.clear();
                    self.keys.extend(self.found.iter().map(key));
                }
                self.local(tree, i)
            })
            .collect()
    }

    /// Leaves the keys of the `k` candidates nearest to point `i` in `keys`, nearest first.
    fn select(&mut self, tree: &Octree, i: usize, k: usize) {
        let p = tree.points[i];
        self.keys.clear();
        self.keys.extend(self.candidates.iter().map(|n| {
            let distance2 = tree.points[n.index as usize].distance_squared(p);
            key(&Neighbor {
                distance2,
                index: n.index,
            })
        }));
        if k < self.keys.len() {
            self.keys.select_nth_unstable(k - 1);
            self.keys.truncate(k);
        }
        self.keys.sort_unstable();
    }

    fn local(&mut self, tree: &Octree, i: usize) -> Local {
        self.nearest.clear();
        self.nearest.extend(self.keys.iter().map(|&key| key as u32));
        let radius2 = self
            .keys
            .last()
            .map_or(0.0, |key| f64::from(f32::from_bits((key >> 32) as u32)));
        let spacing = (std::f64::consts::PI * radius2 / self.nearest.len() as f64).sqrt() as f32;
        match Fit::new(tree, self.nearest.iter().copied(), radius2.sqrt()) {
            None => Local {
                spacing,
                ..Local::default()
            },
            Some(fit) => {
                let at = fit.at(tree.points[i].as_dvec3());
                Local {
                    spacing,
                    normal: at.normal.as_vec3(),
                    variation: fit.variation as f32,
                    residual: at.offset as f32,
                }
            }
        }
    }
}

/// Middle and radius of a few points.
pub(crate) fn ball(points: &[Vec3]) -> (Vec3, f32) {
    let center = points.iter().sum::<Vec3>() / points.len() as f32;
    (
        center,
        points
            .iter()
            .map(|p| p.distance(center))
            .fold(0.0, f32::max),
    )
}

/// Orders as (distance, index) does: positive floats order as their bits do.
fn key(n: &Neighbor) -> u64 {
    u64::from(n.distance2.to_bits()) << 32 | u64::from(n.index)
}

/// A least-squares quadric over the plane of least variance.
struct Fit {
    mean: DVec3,
    /// Normal and two tangents of the plane.
    axes: [DVec3; 3],
    radius: f64,
    points: f64,
    variation: f64,
    /// z = c0 + c1 x + c2 y + c3 x² + c4 xy + c5 y², lengths in radii.
    c: [f64; QUADRIC],
}

/// A quadric near a point: signed distance of the point along the normal there.
struct At {
    offset: f64,
    normal: DVec3,
}

impl Fit {
    /// `None` for points on a line or at one place; the plane alone with fewer than eight points.
    fn new(tree: &Octree, found: impl Iterator<Item = u32> + Clone, radius: f64) -> Option<Fit> {
        let position = |i: u32| tree.points[i as usize].as_dvec3();
        let (mean, eigen, points) = covariance(found.clone().map(position));
        let values = eigen.values;
        // Fewer than three points, or all on a line, have no normal.
        if values[1] <= 1e-12 * values[2] || radius == 0.0 {
            return None;
        }
        let mut fit = Fit {
            mean,
            axes: eigen.vectors,
            radius,
            points,
            variation: values[0].max(0.0) / (values[0].max(0.0) + values[1] + values[2]),
            c: [0.0; QUADRIC],
        };
        if points >= (QUADRIC + 2) as f64 {
            fit.bend(found.map(position));
        }
        Some(fit)
    }

    fn local(&self, p: DVec3) -> [f64; 3] {
        let d = (p - self.mean) / self.radius;
        let [normal, u, v] = self.axes;
        [d.dot(u), d.dot(v), d.dot(normal)]
    }

    /// Solves for the quadric's coefficients; leaves the plane where the system is singular.
    fn bend(&mut self, positions: impl Iterator<Item = DVec3>) {
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
            ata[(a, a)] += 1e-9 * self.points;
        }
        if let Some(cholesky) = nalgebra::Cholesky::new(ata) {
            self.c.copy_from_slice(cholesky.solve(&atz).as_slice());
        }
    }

    fn at(&self, p: DVec3) -> At {
        let c = &self.c;
        let [x, y, z] = self.local(p);
        let height = c[0] + c[1] * x + c[2] * y + c[3] * x * x + c[4] * x * y + c[5] * y * y;
        let (dx, dy) = (
            c[1] + 2.0 * c[3] * x + c[4] * y,
            c[2] + c[4] * x + 2.0 * c[5] * y,
        );
        let [normal, u, v] = self.axes;
        let slope = (1.0 + dx * dx + dy * dy).sqrt();
        At {
            // The vertical distance, foreshortened by the slope.
            offset: (z - height) * self.radius / slope,
            normal: (normal - dx * u - dy * v) / slope,
        }
    }
}

/// Mean, eigen-decomposition of the covariance, and count.
fn covariance(positions: impl Iterator<Item = DVec3> + Clone) -> (DVec3, SymEigen, f64) {
    let (mut sum, mut count) = (DVec3::ZERO, 0.0);
    for p in positions.clone() {
        sum += p;
        count += 1.0;
    }
    let mean = sum / count;
    let mut m = [0.0; 6];
    for p in positions {
        let d = p - mean;
        let products = crate::linalg::outer(d);
        for (sum, product) in m.iter_mut().zip(products) {
            *sum += product;
        }
    }
    (mean, sym_eigen(&m), count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::Silent;
    use crate::rng::Rng;

    /// `n` points of a sphere of radius 0.25 with noise across it.
    fn sphere(n: usize, noise: f64) -> Vec<Vec3> {
        let mut rng = Rng::new(7);
        (0..n)
            .map(|_| {
                let d = DVec3::new(rng.normal(), rng.normal(), rng.normal()).normalize();
                (d * (0.25 + noise * rng.normal())).as_vec3()
            })
            .collect()
    }

    #[test]
    fn a_sphere_has_its_curvature_normals_and_noise() {
        for noise in [0.0, 1e-3, 4e-3] {
            let tree = Octree::build(&sphere(8000, noise));
            let f = Features::measure(&tree, &mut Silent).unwrap();
            let median = |v: &[f32]| {
                let mut v = v.to_vec();
                v.sort_unstable_by(f32::total_cmp);
                v[v.len() / 2] as f64
            };
            assert!(
                (f.noise as f64 - noise).abs() < 0.15 * noise + 2e-5,
                "{} for {noise}",
                f.noise
            );
            let tilt: Vec<f32> = tree
                .points
                .iter()
                .zip(&f.normals)
                .map(|(p, n)| 1.0 - p.normalize().dot(*n).abs())
                .collect();
            assert!(
                median(&tilt) < if noise < 2e-3 { 0.002 } else { 0.02 },
                "{}",
                median(&tilt)
            );
            if noise == 0.0 {
                // Both principal curvatures are 4: the Frobenius norm is 4 √2.
                let curvature = median(&f.curvature);
                assert!((curvature - 4.0 * 2f64.sqrt()).abs() < 0.3, "{curvature}");
            }
            // Area a point: 4π 0.0625 / 8000.
            let spacing = (4.0 * std::f64::consts::PI * 0.0625 / 8000.0f64).sqrt();
            assert!((median(&f.spacing) / spacing - 1.0).abs() < 0.15);
        }
    }

    #[test]
    fn degenerate_clouds_have_finite_features() {
        let line: Vec<Vec3> = (0..50)
            .map(|i| Vec3::new(i as f32 / 50.0 - 0.5, 0.0, 0.0))
            .collect();
        for points in [vec![Vec3::ZERO], vec![Vec3::ZERO; 40], line] {
            let f = Features::measure(&Octree::build(&points), &mut Silent).unwrap();
            assert!(f.normals.iter().all(|n| *n == Vec3::ZERO));
            assert!(
                f.curvature
                    .iter()
                    .chain(&f.spacing)
                    .chain(&f.variation)
                    .all(|x| x.is_finite())
            );
            assert!(f.noise.is_finite());
        }
    }
}
