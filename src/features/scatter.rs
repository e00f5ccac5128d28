//! Scatter: points of foliage, dust and filled volumes, through which there is no surface.
//!
//! 1. A point lies in a *volume* when its neighbours fill space at every scale, from 24 of them to 192, and grow in number as those
//!    of a volume do. Those of a surface lie flat at one of the scales at least: a noisy one, or the two sides of a thin wall, at
//!    a large one, a bent one at a small one. Twigs and scan lines are long at one of them. Where thin walls meet they are
//!    neither, but four times as many take up twice the radius, where those of a volume take 1.6 times.
//! 2. A point lies in a *clump* when its nearest, up to a dozen, are much nearer to it than all others.
//! 3. One place alone says little, as a corner is like a volume, so the places around have a vote: a place is scatter when most
//!    of them lie in volumes or clumps.
//!
//! Flatness is the surface variation of Pauly, Gross, Kobbelt, "Efficient simplification of point-sampled surfaces", 2002.
//!
//! **Cost**: a query of 24 neighbours for one place of eight; where some are scatter, for all, and of the larger scales where these
//! fill space.

use crate::base::linalg::Spread;
use crate::base::par;
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;
use glam::Vec3;

/// Neighbours at each scale.
const SCALES: [usize; 4] = [24, 48, 96, 192];
/// Surface variation from which neighbours fill space, and at the largest scale, where thin plates are told. A crease at a right
/// angle has 0.09, a plate as thick as 2.5 spacings 0.1 at the largest scale, even volumes 0.2 to 0.3, their ends 0.13.
const BULK: (f64, f64) = (0.07, 0.11);
/// Share of the longest variance up to which the middle one is that of a line.
const LINE: f64 = 0.1;
/// Scales whose radii tell the dimension, and their ratio, squared, in 2.45 dimensions.
const GROWTH: (usize, usize, f32) = (24, 96, 3.1);
/// Sizes of a clump.
const CLUMP: std::ops::RangeInclusive<usize> = 4..=12;
/// A clump is this many times as far from everything else as it is wide.
const APART: f32 = 2.5;
/// Noise, in spacings, from which it may be a volume that looks like noise.
const NOISY: f32 = 1.5;
/// Places around a place that vote.
const VOTES: usize = 12;
/// Points, in those of the largest scale, from which on that is a small part of the scan, and not its shape.
const ENOUGH: usize = 16;
/// Less than this share of the places is no scatter.
const LEAST: f64 = 0.05;
/// One of so many places is looked at first.
const STRIDE: usize = 8;
/// Where more than this share of the places is scatter, the rest is no surface either.
const MOST: f64 = 0.95;

/// Which of these places, on or between the points of the tree, lie in scatter. `noise` is its standard deviation across
/// surfaces, `spacing` the median of the points'.
pub(crate) fn places(tree: &Octree, at: &[Vec3], (noise, spacing): (f32, f32)) -> Vec<bool> {
    if tree.points.len() <= SCALES[0] {
        return vec![false; at.len()];
    }
    let noise2 = f64::from(noise).powi(2);
    // What looks like noise of more than that may be a volume: there only the largest scale reaches beyond it.
    let near2 = if noise < NOISY * spacing { noise2 } else { 0.0 };
    let look = |stride: usize| -> Vec<bool> {
        par::map(at.len().div_ceil(stride), Vec::new, |i, found| {
            is_alone(tree, at[i * stride], [near2, noise2], found)
        })
    };
    // Most scans have none, which a part of the places tells.
    if share(&look(STRIDE)) < LEAST / 4.0 {
        return vec![false; at.len()];
    }
    let mut alone = look(1);
    let places = Octree::build(at);
    let vote = |marked: &[bool]| {
        par::map(at.len(), Vec::new, |i, found| {
            places.knn(at[i], VOTES + 1, found);
            let is = |n: &&Neighbor| marked[places.order[n.index as usize] as usize];
            2 * found.iter().filter(is).count() > found.len()
        })
    };
    // The ends of a volume are half empty, and follow in a second round.
    let first = vote(&alone);
    for (alone, first) in alone.iter_mut().zip(&first) {
        *alone |= first;
    }
    let mut scatter = vote(&alone);
    // So little is a corner or an uneven part of a surface.
    if share(&scatter) < LEAST {
        scatter.fill(false);
    }
    scatter
}

/// Whether so much is scatter that the rest is no surface either.
pub(crate) fn is_all(scatter: &[bool]) -> bool {
    share(scatter) > MOST
}

/// Share of those that are marked.
fn share(marked: &[bool]) -> f64 {
    let count = marked.iter().filter(|&&is| is).count();
    count as f64 / marked.len().max(1) as f64
}

/// Whether a place, looked at alone, lies in a volume or in a clump.
fn is_alone(tree: &Octree, p: Vec3, noise2: [f64; 2], found: &mut Vec<Neighbor>) -> bool {
    tree.knn(p, SCALES[0], found);
    if in_clump(found) {
        return true;
    }
    let largest = SCALES[SCALES.len() - 1];
    if tree.points.len() < ENOUGH * largest {
        return false;
    }
    if !is_bulk(tree, p, found, (BULK.0, noise2[0])) {
        return false;
    }
    tree.knn(p, largest, found);
    let scale = |&k: &usize| is_bulk(tree, p, &found[..k.min(found.len())], (BULK.0, noise2[0]));
    fills(found) && is_bulk(tree, p, found, (BULK.1, noise2[1])) && SCALES[1..3].iter().all(scale)
}

/// Whether the number of these neighbours grows with the distance as in a volume.
fn fills(found: &[Neighbor]) -> bool {
    let (inner, outer, ratio) = GROWTH;
    found.len() < outer || found[outer - 1].distance2 < ratio * found[inner - 1].distance2
}

/// Whether the nearest of these, nearest first, are much nearer than the others.
fn in_clump(found: &[Neighbor]) -> bool {
    let gap = |&k: &usize| found[k].distance2 > APART * APART * found[k - 1].distance2;
    found[CLUMP.start() - 1].distance2 > 0.0 && CLUMP.filter(|k| *k < found.len()).any(|k| gap(&k))
}

/// Whether these neighbours of `p` lie neither flat, but for the noise, nor along a line.
fn is_bulk(tree: &Octree, p: Vec3, found: &[Neighbor], (bulk, noise2): (f64, f64)) -> bool {
    let from_here = |n: &Neighbor| (tree.points[n.index as usize] - p).as_dvec3();
    let [thin, middle, long] = Spread::of(found.iter().map(from_here)).variances();
    thin - noise2 > bulk * (thin + middle + long) && middle > LINE * long
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::Rng;
    use glam::DVec3;

    fn share_of(points: &[Vec3], noise: f32) -> f64 {
        share(&places(&Octree::build(points), points, (noise, 6e-3)))
    }

    fn direction(rng: &mut Rng) -> DVec3 {
        DVec3::new(rng.normal(), rng.normal(), rng.normal()).normalize()
    }

    /// The sides of a box, with noise across them.
    fn boxed(n: usize, half: [f64; 3], noise: f64, rng: &mut Rng) -> Vec<Vec3> {
        let area = |a: usize| half[(a + 1) % 3] * half[(a + 2) % 3];
        let all = area(0) + area(1) + area(2);
        let mut points = Vec::new();
        for _ in 0..n {
            let pick = all * rng.uniform();
            let axis = usize::from(pick > area(0)) + usize::from(pick > area(0) + area(1));
            let mut p = half.map(|h| h * (2.0 * rng.uniform() - 1.0));
            p[axis] = half[axis].copysign(p[axis]) + noise * rng.normal();
            points.push(DVec3::from_array(p).as_vec3());
        }
        points
    }

    #[test]
    fn surfaces_are_none() {
        let mut rng = Rng::new(11);
        for noise in [0.0, 1e-3, 5e-3] {
            // A cube, a rod and plates as thick as 6 and 1.6 of their spacings of 0.005.
            for half in [
                [0.28, 0.28, 0.28],
                [0.45, 0.03, 0.03],
                [0.4, 0.3, 0.015],
                [0.4, 0.3, 0.004],
            ] {
                let points = boxed(20_000, half, noise, &mut rng);
                let share = share_of(&points, noise as f32);
                assert!(share < 1e-2, "{half:?} with {noise}: {share}");
            }
            let ball: Vec<Vec3> = (0..2000)
                .map(|_| (direction(&mut rng) * (0.4 + noise * rng.normal())).as_vec3())
                .collect();
            assert_eq!(share_of(&ball, noise as f32), 0.0);
        }
        // Small balls, far apart: 120 points each.
        let balls: Vec<Vec3> = (0..6000)
            .map(|i| {
                let center = DVec3::new(f64::from(i % 50), 0.0, 0.0) / 60.0;
                (center + direction(&mut rng) * 0.005).as_vec3()
            })
            .collect();
        assert_eq!(share_of(&balls, 0.0), 0.0);
    }

    #[test]
    fn volumes_and_clumps_are() {
        let mut rng = Rng::new(12);
        let mut points: Vec<Vec3> = (0..6000)
            .map(|_| (direction(&mut rng) * 0.2).as_vec3())
            .collect();
        for _ in 0..150 {
            let center = direction(&mut rng) * (0.25 + 0.1 * rng.uniform());
            points.extend((0..8).map(|_| (center + direction(&mut rng) * 1e-3).as_vec3()));
        }
        let crown = DVec3::new(0.6, 0.0, 0.0);
        points
            .extend((0..3000).map(|_| {
                (crown + direction(&mut rng) * 0.2 * libm::cbrt(rng.uniform())).as_vec3()
            }));
        let scatter = places(&Octree::build(&points), &points, (0.0, 6e-3));
        let share = |range: std::ops::Range<usize>| share(&scatter[range]);
        assert!(share(0..6000) < 0.01, "{}", share(0..6000));
        assert!(share(6000..7200) > 0.99, "{}", share(6000..7200));
        assert!(share(7200..10_200) > 0.85, "{}", share(7200..10_200));
    }
}
