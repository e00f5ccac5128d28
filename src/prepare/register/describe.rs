//! What the surface around a point looks like, as numbers: fast point feature histograms (Rusu, Blodow, Beetz, "Fast point feature
//! histograms (FPFH) for 3D registration", 2009) that know no side of the surface.
//!
//! A normal's sign is unknown. The three angles between a point and a neighbour are those of normals that agree in sign; with both
//! turned round the first is the same, and the others change their signs: the histograms of these are read backwards.

use super::samples::{Samples, within};
use crate::base::par;
use glam::Vec3;

/// Bins of an angle's histogram.
const BINS: usize = 11;
/// Radii of the neighbourhoods, in cells.
const RADII: [f32; 2] = [4.5, 8.0];
/// Numbers of one description.
pub(crate) const NUMBERS: usize = 3 * BINS * RADII.len();

/// A description.
pub(crate) type Look = [f32; NUMBERS];

/// One radius's share of it.
type Histogram = [f32; 3 * BINS];

/// The descriptions of all samples.
pub(crate) fn looks(samples: &Samples) -> Vec<Look> {
    let mut looks = vec![[0.0; NUMBERS]; samples.len()];
    for (k, radius) in RADII.iter().enumerate() {
        let histograms = histograms(samples, radius * samples.cell);
        for (look, histogram) in looks.iter_mut().zip(histograms) {
            look[k * 3 * BINS..(k + 1) * 3 * BINS].copy_from_slice(&histogram);
        }
    }
    looks
}

/// The same as seen with the normal turned round.
pub(crate) fn turned(look: &Look) -> Look {
    let mut turned = *look;
    for histogram in turned.chunks_exact_mut(3 * BINS) {
        backwards(histogram);
    }
    turned
}

fn backwards(histogram: &mut [f32]) {
    for angle in histogram.chunks_exact_mut(BINS).skip(1) {
        angle.reverse();
    }
}

fn histograms(samples: &Samples, radius: f32) -> Vec<Histogram> {
    let Samples { tree, normals, .. } = samples;
    let n = samples.len();
    let own = par::map(
        n,
        || (),
        |i, ()| {
            let mut histogram = [0.0; 3 * BINS];
            within(tree, tree.points[i], radius, |j| {
                let apart = tree.points[j] - tree.points[i];
                if let Some(along) = apart.try_normalize() {
                    count(&mut histogram, normals[i], normals[j], along);
                }
            });
            normalized(&mut histogram);
            histogram
        },
    );
    par::map(
        n,
        || (),
        |i, ()| {
            let mut sum = [0.0; 3 * BINS];
            within(tree, tree.points[i], radius, |j| {
                let distance = tree.points[j].distance(tree.points[i]);
                let weight = samples.cell / distance.max(samples.cell);
                let mut other = own[j];
                if normals[i].dot(normals[j]) < 0.0 {
                    backwards(&mut other);
                }
                for (sum, x) in sum.iter_mut().zip(other) {
                    *sum += weight * x;
                }
            });
            normalized(&mut sum);
            // Of histograms the roots are compared: that of a full bin would outweigh all others.
            for (x, own) in sum.iter_mut().zip(&own[i]) {
                *x = (0.5 * (*x + own)).sqrt();
            }
            sum
        },
    )
}

/// Counts one neighbour: each angle falls on two bins.
fn count(histogram: &mut Histogram, u: Vec3, other: Vec3, along: Vec3) {
    let other = if u.dot(other) < 0.0 { -other } else { other };
    let Some(v) = along.cross(u).try_normalize() else {
        return;
    };
    let w = u.cross(v);
    let theta = libm::atan2f(w.dot(other), u.dot(other)) / std::f32::consts::FRAC_PI_2;
    for (k, x) in [v.dot(other), u.dot(along), theta].into_iter().enumerate() {
        let place = (0.5 * (x.clamp(-1.0, 1.0) + 1.0)) * (BINS - 1) as f32;
        let low = (place as usize).min(BINS - 2);
        let high = place - low as f32;
        histogram[k * BINS + low] += 1.0 - high;
        histogram[k * BINS + low + 1] += high;
    }
}

fn normalized(histogram: &mut Histogram) {
    for angle in histogram.chunks_exact_mut(BINS) {
        let sum: f32 = angle.iter().sum();
        if sum > 0.0 {
            angle.iter_mut().for_each(|x| *x /= sum);
        }
    }
}
