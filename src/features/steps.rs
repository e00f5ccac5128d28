//! Steps: coordinates that a sensor rounded to a lattice along an axis, coarser than the points are apart.
//!
//! 1. The coordinates along an axis lie on a lattice when they have few values, and the values' differences are whole
//!    multiples of one step.
//!    Depths from a viewpoint are looked at by [`depths`].
//! 2. A lattice is no step where the points were laid out on it: of a raster or of parallel scan lines the points of one
//!    level are a line. They are a step where the points of one level cover a patch of the surface, a terrace.
//!
//! A rounded coordinate is off by up to half a step, evenly: a standard deviation of step/√12 (W. R. Bennett, "Spectra of
//! quantized signals", 1948).

use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;
use crate::features::depths;
use crate::features::noise::quantile;
use crate::features::terraces::{self, LEVEL, PATCH, SAMPLE};
use glam::{DVec2, Vec3};

/// Values nearer than this (unit frame) are one level: some times what single precision rounds.
const SAME: f32 = 1e-6;
/// Differences of levels are whole multiples of the step to this share of it, but for this share of them.
const WHOLE: (f32, f32) = (0.05, 0.02);

/// Standard deviation of the rounding along the axis, or of the depth seen from the points' `eye`s, that has the coarsest
/// steps (unit frame); 0 without steps.
pub(crate) fn noise(tree: &Octree, eye: &(dyn Fn(usize) -> Option<Vec3> + Sync)) -> f32 {
    let steps = (0..3).filter_map(|axis| {
        let step = step(tree, axis)?;
        has_terraces(tree, axis, step).then_some(step)
    });
    let mut coarsest = steps.fold(0.0, f32::max);
    if coarsest == 0.0 {
        coarsest = depths::step(tree, eye);
    }
    coarsest / 12f32.sqrt()
}

/// The step of the lattice that the coordinates along an axis lie on.
fn step(tree: &Octree, axis: usize) -> Option<f32> {
    let some = tree
        .points
        .iter()
        .step_by(tree.points.len().div_ceil(SAMPLE));
    let mut values: Vec<f32> = some.map(|p| p[axis]).collect();
    let most = values.len() / LEVEL;
    values.sort_unstable_by(f32::total_cmp);
    values.dedup_by(|b, a| *b - *a <= SAME);
    if values.len() < 3 || values.len() > most {
        return None;
    }
    let apart: Vec<f32> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    // Next to each other most levels are one step apart.
    let rough = quantile(apart.clone(), 4);
    let one: Vec<f32> = apart
        .iter()
        .copied()
        .filter(|d| (d / rough).round() == 1.0)
        .collect();
    let step = one.iter().sum::<f32>() / one.len().max(1) as f32;
    let off = |d: &&f32| (**d / step - (**d / step).round()).abs() > WHOLE.0;
    let odd = apart.iter().filter(off).count() as f32;
    (odd <= WHOLE.1 * apart.len() as f32).then_some(step)
}

/// Whether the points of one level cover patches.
fn has_terraces(tree: &Octree, axis: usize, step: f32) -> bool {
    let level_of = |i: usize| Some((tree.points[i][axis] / step).round() as i32);
    terraces::are_there(tree, level_of, |i, _, near| {
        let from_here = |n: &Neighbor| tree.points[n.index as usize] - tree.points[i];
        let level = near.iter().map(from_here);
        let level = level.filter(|d| d[axis].abs() < step / 2.0);
        let flat: Vec<DVec2> = level
            .map(|d| DVec2::new(d[(axis + 1) % 3].into(), d[(axis + 2) % 3].into()))
            .collect();
        flat.len() >= LEVEL && is_patch(&flat)
    })
}

/// Whether points in a plane vary in two directions.
fn is_patch(points: &[DVec2]) -> bool {
    let mean = points.iter().sum::<DVec2>() / points.len() as f64;
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for d in points.iter().map(|p| *p - mean) {
        xx += d.x * d.x;
        xy += d.x * d.y;
        yy += d.y * d.y;
    }
    let (sum, root) = (xx + yy, ((xx - yy).powi(2) + 4.0 * xy * xy).sqrt());
    sum - root >= PATCH * (sum + root) && sum > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::Rng;
    use glam::Vec3;

    /// Points of a gentle relief, made of two numbers from 0 to 1.
    fn relief(n: usize, at: impl Fn(usize, &mut Rng) -> [f64; 2], step: f64) -> Octree {
        let mut rng = Rng::new(9);
        let points: Vec<Vec3> = (0..n)
            .map(|i| {
                let [x, y] = at(i, &mut rng).map(|t| 0.7 * t - 0.35);
                let z = 0.1 * libm::sin(9.0 * x) * libm::cos(7.0 * y);
                let z = if step > 0.0 {
                    step * (z / step).round()
                } else {
                    z
                };
                Vec3::new(x as f32, y as f32, z as f32)
            })
            .collect();
        Octree::build(&points)
    }

    #[test]
    fn rounded_heights_are_steps_and_layouts_are_not() {
        let scattered = |_: usize, rng: &mut Rng| [rng.uniform(), rng.uniform()];
        let raster = |i: usize, _: &mut Rng| [(i % 100) as f64 / 100.0, (i / 100) as f64 / 100.0];
        let lines = |i: usize, rng: &mut Rng| [rng.uniform(), (i % 20) as f64 / 20.0];
        for step in [0.015, 0.03] {
            let expected = step / 12f64.sqrt();
            for tree in [
                relief(10_000, scattered, step),
                relief(10_000, raster, step),
            ] {
                let found = f64::from(noise(&tree, &|_| None));
                assert!(
                    (found / expected - 1.0).abs() < 0.01,
                    "{found} of {expected}"
                );
            }
        }
        for tree in [
            relief(10_000, scattered, 0.0),
            relief(10_000, raster, 0.0),
            relief(10_000, lines, 0.0),
        ] {
            assert_eq!(noise(&tree, &|_| None), 0.0);
        }
        // Finer than the points are apart: nobody sees them.
        assert!(noise(&relief(10_000, scattered, 1e-5), &|_| None) < 1e-5);
    }
}
