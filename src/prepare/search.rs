//! The search for planes: RANSAC over points with normals, each of which is a plane of its own (Schnabel, Wahl, Klein, "Efficient
//! RANSAC for point-cloud shape detection", 2007), refined by least squares.
//!
//! 1. A sample of the points, even along the octree's order, votes by the area each stands for: a floor that is scanned sparsely
//!    is as large as one that is scanned densely.
//! 2. Points drawn from those of no plane yet, each with its normal, are candidates. A candidate is fitted to what agrees with it
//!    within a band that is halved from fit to fit, as one normal says little of a place far away.
//! 3. The candidate with the largest area is a plane, and its points are drawn no more, until too little area is left.

use crate::base::linalg::{outer, sym_eigen};
use crate::base::par;
use crate::base::rng::Rng;
use crate::cloud::octree::Octree;
use crate::features::Features;
use crate::features::noise::quantile;
use glam::{DVec3, Vec3};

/// Points that vote.
const VOTERS: usize = 16_384;
/// Candidates for each plane.
const CANDIDATES: usize = 48;
/// Planes of one scan, at most.
const MOST: usize = 12;
/// Half widths of the bands of the fits, in diagonals; the last is by what was found.
const BANDS: [f64; 4] = [0.04, 0.02, 0.01, 0.005];
/// Cosine of the largest angle between a plane's normal and its points': 25°.
pub(super) const ALONG: f64 = 0.9063;
/// A band is this many standard deviations of the plane's points.
const SIGMAS: f64 = 3.0;
/// The area of a point is at most this many times the median: strays stand for nothing.
const LARGEST: f32 = 4.0;

/// A point that votes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Voter {
    /// Which point of the tree it is.
    pub(super) point: usize,
    pub(super) at: Vec3,
    pub(super) normal: Vec3,
    pub(super) area: f64,
}

/// A plane as the search finds it.
#[derive(Debug, Clone)]
pub(super) struct Found {
    pub(super) point: DVec3,
    pub(super) normal: DVec3,
    /// Standard deviation of its points across it.
    pub(super) sigma: f64,
    /// Which voters are its own.
    pub(super) own: Vec<bool>,
    /// Their share of the area.
    pub(super) share: f64,
}

/// The voters of a scan.
pub(super) fn voters(tree: &Octree, features: &Features) -> Vec<Voter> {
    let n = tree.points.len();
    let count = n.min(VOTERS);
    let places = (0..count).map(|k| (k as u64 * n as u64 / count as u64) as usize);
    let areas: Vec<f32> = places
        .clone()
        .map(|i| features.spacing[i].powi(2))
        .collect();
    let most = LARGEST * quantile(areas.clone(), 2);
    let voter = |(i, area): (usize, f32)| Voter {
        point: i,
        at: tree.points[i],
        normal: features.normals[i],
        area: f64::from(area.min(most)),
    };
    places.zip(areas).map(voter).collect()
}

/// The planes that hold at least `min_share` of the area, the largest first as far as drawing finds them.
pub(super) fn planes(voters: &[Voter], least_sigma: f64, min_share: f64, seed: u64) -> Vec<Found> {
    let total: f64 = voters.iter().map(|voter| voter.area).sum();
    let mut free: Vec<bool> = voters.iter().map(|v| v.normal != Vec3::ZERO).collect();
    let mut rng = Rng::new(seed);
    let mut planes = Vec::new();
    while planes.len() < MOST {
        let open: Vec<usize> = (0..voters.len()).filter(|&i| free[i]).collect();
        if open.is_empty() {
            break;
        }
        let mut draw = || open[(rng.next_u64() % open.len() as u64) as usize];
        let drawn: Vec<usize> = (0..CANDIDATES).map(|_| draw()).collect();
        let fit = |k: usize, _: &mut ()| {
            let start = &voters[drawn[k]];
            refined(voters, &free, start, (least_sigma, min_share * total))
        };
        let fitted = par::map(CANDIDATES, || (), fit);
        let largest = |best: Option<Found>, next: Found| match best {
            Some(best) if best.share >= next.share => Some(best),
            _ => Some(next),
        };
        let Some(mut found) = fitted.into_iter().flatten().fold(None, largest) else {
            break;
        };
        found.share /= total;
        for (free, own) in free.iter_mut().zip(&found.own) {
            *free &= !own;
        }
        planes.push(found);
    }
    planes
}

/// The plane that a voter and its normal lead to, its share as an area; `None` where that gets less than `least`.
fn refined(
    voters: &[Voter],
    free: &[bool],
    start: &Voter,
    (least_sigma, least): (f64, f64),
) -> Option<Found> {
    let mut plane = (start.at.as_dvec3(), start.normal.as_dvec3());
    let mut sigma = least_sigma;
    for band in BANDS.map(Some).into_iter().chain([None, None]) {
        // What a plane's own points say of its noise, once it lies well.
        let band = band.unwrap_or((SIGMAS * sigma).min(BANDS[3]));
        let agrees = |&(voter, free): &(&Voter, &bool)| *free && agrees(voter, plane, band);
        let own = || {
            voters
                .iter()
                .zip(free)
                .filter(agrees)
                .map(|(voter, _)| voter)
        };
        let area: f64 = own().map(|voter| voter.area).sum();
        if area < least {
            return None;
        }
        let mean = own().map(|v| v.area * v.at.as_dvec3()).sum::<DVec3>() / area;
        let mut squares = [0.0; 6];
        for voter in own() {
            let products = outer(voter.at.as_dvec3() - mean);
            for (sum, product) in squares.iter_mut().zip(products) {
                *sum += voter.area * product;
            }
        }
        let normal = sym_eigen(&squares).vectors[0];
        let away: Vec<f32> = own()
            .map(|voter| (voter.at.as_dvec3() - mean).dot(normal).abs() as f32)
            .collect();
        // The median of a normal distribution's absolute values is 0.6745 standard deviations.
        sigma = (f64::from(quantile(away, 2)) / 0.6745).max(least_sigma);
        plane = (mean, normal);
    }
    let band = (SIGMAS * sigma).min(BANDS[3]);
    let own: Vec<bool> = voters
        .iter()
        .zip(free)
        .map(|(voter, free)| *free && agrees(voter, plane, 2.0 * band))
        .collect();
    let area = voters
        .iter()
        .zip(&own)
        .map(|(v, own)| if *own { v.area } else { 0.0 });
    let share: f64 = area.sum();
    (share >= least).then_some(Found {
        point: plane.0,
        normal: plane.1,
        sigma,
        own,
        share,
    })
}

/// Whether a voter lies within a band of a plane, and as it does.
fn agrees(voter: &Voter, (point, normal): (DVec3, DVec3), band: f64) -> bool {
    let away = (voter.at.as_dvec3() - point).dot(normal).abs();
    away <= band && voter.normal.as_dvec3().dot(normal).abs() >= ALONG
}
