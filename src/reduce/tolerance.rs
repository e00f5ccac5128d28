//! The tolerance target: the fewest points whose local surfaces stay within a distance of the scan.
//!
//! Curvature says how points are best shared out: h = √(8 chord/κ) makes all chords of a linear surface equally wrong.
//! How far the surfaces that the reduced points stand for ([`crate::reduce::height_field`]) are from the scan is then measured, and
//! the chord is scaled until [`SURFACE`] of the scan is just within the tolerance.

use crate::base::error::Result;
use crate::base::progress::{Part, Progress, Stage};
use crate::base::sort_keys::{key, of_key, ranked, unpack};
use crate::features::Features;
use crate::features::noise::Scales;
use std::ops::RangeInclusive;

/// Share of the scan that must be within the tolerance. 99 % of the surface are promised, of which the scan is a sample: a
/// little more of it is asked for. 99.5 % cost a tenth more points on the generated samples, up to 1.4 times the fewest.
const SURFACE: f64 = 0.992;
/// A measured error in this range of the tolerance is close enough: counts go with its inverse, so that at most a
/// twelfth of the points are too many.
const CLOSE: RangeInclusive<f64> = 0.92..=1.0;
/// Reductions that are tried. Of 18 searches on the generated samples 16 took one to five, the others eight.
const TRIALS: usize = 10;
/// How much of the search's progress is done when it ends.
pub(crate) const DONE: f32 = 0.9;
/// What the filter leaves of the noise at [`SURFACE`] of the points, in standard deviations of the noise. Measured
/// distances have it in them, surfaces do not.
const LEFT: f64 = 1.5;
/// Least tolerance, in standard deviations of the noise. Below 1.3 no number of points met it on the generated samples.
const NOISE_FLOOR: f64 = 1.5;

/// The tolerance that is aimed at, and why it is not the one that was asked for, where it is not.
pub(crate) fn allowed(features: &Features, tolerance: f64) -> (f64, String) {
    let noise = removed_noise(features);
    let least = least(noise);
    if tolerance >= least {
        return (tolerance, String::new());
    }
    let reason = format!(
        "noise of {noise:.1e} hides a surface within {tolerance:.1e}: the tolerance was taken as {least:.1e}"
    );
    (least, reason)
}

/// The least tolerance, with so much noise.
pub(crate) fn least(noise: f64) -> f64 {
    NOISE_FLOOR * noise
}

/// The noise, as far as the filter takes it for noise and not for the bend of coarsely sampled parts.
pub(crate) fn removed_noise(features: &Features) -> f64 {
    removed(features.noise, features.median_spacing())
}

/// [`removed_noise`] of a noise and a median spacing.
pub(crate) fn removed(noise: f32, spacing: f32) -> f64 {
    let scales = Scales::new(noise, spacing);
    f64::from(scales.noise * scales.denoise)
}

/// The chord to aim at, given what the filter removes of the noise, and the tolerance. `error` reduces the scan for a chord and
/// measures how far most of it is from the result ([`error`]), or says that all points would be kept.
pub(crate) fn search(
    (noise, tolerance): (f64, f64),
    progress: &mut dyn Progress,
    error: impl Fn(f64, &mut dyn Progress) -> Result<Option<f64>>,
) -> Result<f64> {
    let noise = LEFT * noise;
    let (mut within, mut beyond) = (0.0, f64::INFINITY);
    let mut chord = tolerance;
    for trial in 0..TRIALS {
        let done = |k: usize| DONE * k as f32 / TRIALS as f32;
        let mut part = Part::of(Stage::Cluster, progress, done(trial)..done(trial + 1));
        let error = error(chord, &mut part)?.unwrap_or(0.0);
        let error = (error * error - noise * noise).max(0.0).sqrt() / tolerance;
        if error <= 1.0 {
            within = chord;
        } else {
            beyond = chord;
        }
        if CLOSE.contains(&error) || beyond < (2.0 - CLOSE.start()) * within {
            break;
        }
        // The error grows with the chord, about in proportion.
        let aim = 0.5 * (CLOSE.start() + CLOSE.end());
        let next = chord * (aim / error).clamp(0.1, 10.0);
        chord = if within < next && next < beyond {
            next
        } else {
            (within * beyond).sqrt()
        };
    }
    Ok(within)
}

/// How far [`SURFACE`] of a scan is from the result at most, by its points' distances and the areas that they stand for.
pub(crate) fn error(distances: Vec<f32>, area: impl Fn(u32) -> f64) -> f64 {
    let parts = ranked(distances.into_iter().map(key));
    let parts = || parts.iter().map(|&part| unpack(part));
    let total: f64 = parts().map(|(_, i)| area(i)).sum();
    let mut below = 0.0;
    let last = parts().find(|&(_, i)| {
        below += area(i);
        below >= SURFACE * total
    });
    last.map_or(0.0, |(distance, _)| f64::from(of_key(distance)))
}
