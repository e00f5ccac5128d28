//! Per-point estimates of the local surface: spacing, unoriented normal, curvature, variation, noise ([`Features`]).
//! The paper takes normals as given (section 4.2 only aligns them); these are estimated, so that noise does not look like detail.
//!
//! 1. `noise`: quadrics through the neighbours of a sample of the points measure the noise, and with it how many neighbours
//!    to ask.
//! 2. `planes`: a plane through the neighbours of every point gives its normal, variation and spacing.
//! 3. `filter`, first pass: normals are averaged over a support that grows with the noise, over neighbours whose normals agree
//!    (a bilateral filter: Jones, Durand, Desbrun, "Non-iterative, feature-preserving mesh smoothing", 2003), so that creases
//!    become sharp and stay so.
//! 4. `filter`, second pass: how fast the averaged normals turn is the curvature. Each point's distance to the surface is the
//!    mean of `½ (n_i + n_j)·(x_i - x_j)` over the same neighbours: exact on every quadric, with a third of the variance that
//!    fitting one would have, and blind to the far side of a crease. By that distance noisy points are moved.
//!
//! Normals that a noisy cloud has take the place of the planes' (`known`), and the first pass is done once more with them.
//!
//! Of rows of points far apart (`lines`) places are measured that are about as far apart in every direction.
//!
//! [`outliers`] finds isolated points, where the caller wants them dropped; the features of the others are then measured again.
//!
//! **In**: an octree, unit frame. **Out**: [`Features`] in the octree's order; lengths in the unit frame, curvature in its
//! inverse, normals of unit length and arbitrary sign.
//!
//! **Cost**: one plane and two filter sums for each point, n log n in all.

pub(crate) mod depths;
pub(crate) mod filter;
pub(crate) mod known;
pub(crate) mod lines;
pub(crate) mod noise;
pub(crate) mod opposite;
pub mod outliers;
pub(crate) mod planes;
pub(crate) mod scatter;
pub(crate) mod steps;
pub(crate) mod terraces;
pub(crate) mod values;

use crate::base::error::Result;
use crate::base::lanes::LANES;
use crate::base::par;
use crate::base::progress::{Part, Progress, Stage};
use crate::cloud::copies::{copied, copies};
use crate::cloud::neighborhood::CELL;
use crate::cloud::octree::Octree;
use crate::features::filter::{Filter, Sums};
use crate::features::known::{Clues, Normals};
use crate::features::lines::{Lines, Thinned};
use crate::features::noise::Scales;
use crate::features::planes::{Plane, Planes};
use glam::Vec3;
use std::ops::Range;

pub use crate::features::values::Features;

/// What is known of a scan before a part of it is measured, in the unit frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Known {
    /// Noise across the surface, and the part of it that comes from rounded coordinates.
    pub(crate) noise: f32,
    pub(crate) steps: f32,
    /// Median spacing.
    pub(crate) spacing: f32,
    /// Of scan lines, where there are some.
    pub(crate) lines: Option<Lines>,
}

impl Features {
    /// Measures them. Cost: a plane and two filter sums a point.
    pub fn measure(tree: &Octree, progress: &mut dyn Progress) -> Result<Features> {
        let none = Clues {
            eye: &|_| None,
            normal: None,
        };
        Features::measure_with(tree, &none, progress)
    }

    /// [`Features::measure`] of points of which more is known.
    pub(crate) fn measure_with(
        tree: &Octree,
        clues: &Clues,
        progress: &mut dyn Progress,
    ) -> Result<Features> {
        Features::of_places(tree, progress, |places, point, progress| {
            let normal = clues.normal.map(|of| move |k| of(point(k)));
            let of_places = Clues {
                eye: &|k| (clues.eye)(point(k)),
                normal: normal.as_ref().map(|of| of as &Normals),
            };
            Features::measure_distinct(places, &of_places, progress)
        })
    }

    /// [`Features::measure`] of a part of a scan of which some things are known: what is measured of a point follows from the points
    /// around it alone.
    pub(crate) fn measure_part(
        tree: &Octree,
        known: &Known,
        progress: &mut dyn Progress,
    ) -> Result<Features> {
        let of = |tree: &Octree, (noise, spacing), progress: &mut dyn Progress| {
            let scales = Scales::new(noise, spacing);
            let measured = Features::measure_by(tree, &scales, |_| noise, None, progress)?;
            let steps = known.steps;
            Ok(Features { steps, ..measured })
        };
        Features::of_places(tree, progress, |tree, _, progress| {
            let Some(lines) = &known.lines else {
                return of(tree, (known.noise, known.spacing), progress);
            };
            let thinned = Thinned::along_lines(tree);
            let places = Octree::build(&thinned.places);
            let measured = of(&places, lines.places, progress)?;
            let features = thinned.features((tree, known.noise), (&places, &measured));
            let lines = lines.share;
            Ok(Features { lines, ..features })
        })
    }

    /// Copies of a point say nothing of the surface: one of each is measured, and they share its area. `measure` gets a tree of
    /// them, and which point of `tree` each is.
    fn of_places(
        tree: &Octree,
        progress: &mut dyn Progress,
        measure: impl FnOnce(
            &Octree,
            &(dyn Fn(usize) -> usize + Sync),
            &mut dyn Progress,
        ) -> Result<Features>,
    ) -> Result<Features> {
        if !copied(&tree.points) {
            return measure(tree, &|k| k, progress);
        }
        let copies: Vec<Range<usize>> = copies(&tree.points);
        let distinct: Vec<Vec3> = copies.iter().map(|c| tree.points[c.start]).collect();
        let places = Octree::build(&distinct);
        let point = |k: usize| copies[places.order[k] as usize].start;
        let one = measure(&places, &point, progress)?;
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
            steps: one.steps,
            lines: one.lines,
        })
    }

    fn measure_distinct(
        tree: &Octree,
        clues: &Clues,
        progress: &mut dyn Progress,
    ) -> Result<Features> {
        let steps = steps::noise(tree, clues.eye);
        let Some(thinned) = Thinned::of(tree) else {
            let limits = (steps, f32::INFINITY);
            return Features::measure_even(tree, limits, clues.normal, progress);
        };
        let places = Octree::build(&thinned.places);
        let noise = lines::noise(tree);
        let most = thinned.noise_of_places(noise).max(steps);
        let limits = (steps, most);
        let of_places = Features::measure_even(&places, limits, None, progress)?;
        Ok(thinned.features((tree, noise), (&places, &of_places)))
    }

    /// Of points whose nearest are around them. Their noise is at least that of `steps` and no more than `most`.
    fn measure_even(
        tree: &Octree,
        (steps, most): (f32, f32),
        known: Option<&Normals>,
        progress: &mut dyn Progress,
    ) -> Result<Features> {
        let scales = Scales::measure(tree).at_most(most).at_least(steps);
        let noise = |normals: &[Vec3]| noise::within_sheets(tree, normals, &scales).max(steps);
        let features = Features::measure_by(tree, &scales, noise, known, progress)?;
        Ok(Features { steps, ..features })
    }

    /// With supports of these sizes; the planes' normals tell the noise.
    fn measure_by(
        tree: &Octree,
        scales: &Scales,
        noise: impl FnOnce(&[Vec3]) -> f32,
        known: Option<&Normals>,
        progress: &mut dyn Progress,
    ) -> Result<Features> {
        let cells = tree.cut(|node| node.range().len() <= CELL);
        let mut part = Part::new(progress, 0.0..0.4);
        let n = tree.points.len();
        let planes: Vec<Plane> = par::flat_map_progress(
            cells.len(),
            n,
            20.0,
            (Stage::Features, &mut part),
            Planes::default,
            |i, planes| planes.cell(tree, cells[i].clone(), scales.plane),
        )?;
        let mut features = Features {
            spacing: planes.iter().map(|p| p.spacing).collect(),
            normals: planes.iter().map(|p| p.normal).collect(),
            curvature: Vec::new(),
            variation: planes.iter().map(|p| p.variation).collect(),
            residual: Vec::new(),
            noise: scales.noise,
            steps: 0.0,
            lines: 0.0,
        };
        drop(planes);
        features.noise = noise(&features.normals);
        let once = if known.is_some() { 0.55 } else { 0.7 };
        let (first, second, late) = (0.4..once, once..0.7, 0.7..1.0);
        let smooth = |features: &Features, progress: &mut dyn Progress, range| {
            features.pass(tree, &cells, (progress, range), |sums, denoise| {
                sums.normals(denoise)
            })
        };
        let mut filtered = smooth(&features, progress, first)?;
        let share = known.map_or(0.0, |of| known::share(&filtered, of, scales.denoise));
        if let Some(of) = known.filter(|_| share > 0.0) {
            known::instead(&mut features.normals, &filtered, of);
            let told = smooth(&features, progress, second)?;
            known::join(&mut filtered, &told, share);
        }
        features.normals = filtered;
        let offsets = features.pass(tree, &cells, (progress, late), |sums, denoise| {
            sums.offsets(denoise)
        })?;
        features.residual = offsets.iter().map(|o| o.residual).collect();
        features.curvature = offsets.iter().map(|o| o.curvature).collect();
        Ok(features)
    }

    /// One pass of the filter over all points, as a part of the stage's progress.
    fn pass<T: Send>(
        &self,
        tree: &Octree,
        cells: &[Range<usize>],
        (progress, range): (&mut dyn Progress, Range<f32>),
        of: impl Fn(&Sums, f32) -> [T; LANES] + Sync + Send,
    ) -> Result<Vec<T>> {
        par::flat_map_progress(
            cells.len(),
            tree.points.len(),
            20.0,
            (Stage::Features, &mut Part::new(progress, range)),
            Filter::default,
            |i, filter| filter.cell(tree, self, cells[i].clone(), &of),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::progress::Silent;
    use crate::base::rng::Rng;
    use glam::DVec3;

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
