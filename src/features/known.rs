//! Normals that a cloud has, beside those of the planes through neighbours.
//!
//! Files have normals of every kind. A scanner's own know more than neighbours do in noise, so they are filtered in the place of the planes';
//! others' estimates are noisy themselves, which shows in how far they are from the filtered planes. Without noise nobody knows more than
//! the neighbours, and known normals only tell the side.

use crate::features::noise::quantile;
use glam::Vec3;

/// Of a point in the octree's order its unit normal, of any sign; zero where it is not known.
pub(crate) type Normals<'a> = dyn Fn(usize) -> Vec3 + Sync + 'a;

/// What is known of points before they are measured, by their places in the octree.
pub(crate) struct Clues<'a> {
    /// From where a point was seen.
    pub(crate) eye: &'a (dyn Fn(usize) -> Option<Vec3> + Sync),
    /// Its normal.
    pub(crate) normal: Option<&'a Normals<'a>>,
}

/// Cosine of the largest angle between a known normal and the filtered plane's, 26°. Beyond it one of them is of another face: at 60° true
/// normals of a part with creases make its surface four times as bad.
const ACROSS: f32 = 0.9;
/// Median angle to the filtered planes, in degrees, up to which known normals take their place, and from which on they count for nothing.
/// True normals of bench clouds with noise have 2 to 7, with 5° of noise of their own 6 to 9, with 15° 10 to 11.
const TRUSTED: (f32, f32) = (8.5, 11.5);
/// Points that are asked for it.
const ASKED: usize = 4096;

/// How much known normals count (0-1) beside filtered ones of points that are noisy by `denoise` (0-1).
pub(crate) fn share(filtered: &[Vec3], known: &Normals, denoise: f32) -> f32 {
    let step = filtered.len().div_ceil(ASKED).max(1);
    let asked = (0..filtered.len()).step_by(step);
    let along = asked.map(|i| (known(i), filtered[i]));
    let along = along.filter(|(a, b)| *a != Vec3::ZERO && *b != Vec3::ZERO);
    let cosines: Vec<f32> = along.map(|(a, b)| a.dot(b).abs().min(1.0)).collect();
    if cosines.is_empty() {
        return 0.0;
    }
    let angle = libm::acosf(quantile(cosines, 2)).to_degrees();
    let (all, none) = TRUSTED;
    denoise * ((none - angle) / (none - all)).clamp(0.0, 1.0)
}

/// Puts the known normals in the place of the planes', wherever both are of one face.
pub(crate) fn instead(planes: &mut [Vec3], filtered: &[Vec3], known: &Normals) {
    for (i, (plane, filtered)) in planes.iter_mut().zip(filtered).enumerate() {
        let own = known(i);
        if own.dot(*filtered).abs() > ACROSS {
            *plane = own * own.dot(*plane).signum();
        }
    }
}

/// Moves the filtered normals towards those that were filtered from known ones by this share.
pub(crate) fn join(filtered: &mut [Vec3], told: &[Vec3], share: f32) {
    for (normal, &told) in filtered.iter_mut().zip(told) {
        let told = told * told.dot(*normal).signum();
        *normal = normal.lerp(told, share).normalize_or(*normal);
    }
}
