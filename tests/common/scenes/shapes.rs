//! What scenes are made of: points on simple surfaces, and what of them is seen.

use glam::DVec3;
use pointweave::base::rng::Rng;
use std::f64::consts::TAU;

pub fn range(rng: &mut Rng, from: f64, to: f64) -> f64 {
    from + (to - from) * rng.uniform()
}

pub fn direction(rng: &mut Rng) -> DVec3 {
    gauss(rng).normalize()
}

pub fn gauss(rng: &mut Rng) -> DVec3 {
    DVec3::new(rng.normal(), rng.normal(), rng.normal())
}

/// Moved by noise of this standard deviation.
pub fn noisy(rng: &mut Rng, deviation: f64, points: Vec<DVec3>) -> Vec<DVec3> {
    points
        .into_iter()
        .map(|p| p + gauss(rng) * deviation)
        .collect()
}

/// A rectangle with a corner and two edges.
pub fn rectangle(rng: &mut Rng, n: usize, corner: DVec3, u: DVec3, v: DVec3) -> Vec<DVec3> {
    let one = |rng: &mut Rng| corner + u * rng.uniform() + v * rng.uniform();
    (0..n).map(|_| one(rng)).collect()
}

/// The faces of a box without some: 0 and 1 are low and high x, then y, then z. Even by area, `n` in all.
pub fn boxed(rng: &mut Rng, n: usize, lo: DVec3, hi: DVec3, without: &[usize]) -> Vec<DVec3> {
    let size = hi - lo;
    let area = |face: usize| size.element_product() / size[face / 2];
    let faces: Vec<usize> = (0..6).filter(|f| !without.contains(f)).collect();
    let total: f64 = faces.iter().map(|&f| area(f)).sum();
    let mut points = Vec::new();
    for face in faces {
        for _ in 0..(n as f64 * area(face) / total) as usize {
            let mut p = lo + size * DVec3::new(rng.uniform(), rng.uniform(), rng.uniform());
            p[face / 2] = if face % 2 == 1 { hi } else { lo }[face / 2];
            points.push(p);
        }
    }
    points
}

pub fn disc(rng: &mut Rng, n: usize, radius: f64, z: f64) -> Vec<DVec3> {
    let one = |rng: &mut Rng| {
        let (r, a) = (radius * rng.uniform().sqrt(), TAU * rng.uniform());
        DVec3::new(r * a.cos(), r * a.sin(), z)
    };
    (0..n).map(|_| one(rng)).collect()
}

/// Of a ball of radius 1, those directions that are wanted.
pub fn ball(rng: &mut Rng, n: usize, wanted: impl Fn(DVec3) -> bool) -> Vec<DVec3> {
    let mut points = Vec::new();
    while points.len() < n {
        let d = direction(rng);
        if wanted(d) {
            points.push(d);
        }
    }
    points
}

/// Around z from 0 to 1, with a radius by height.
pub fn turned(rng: &mut Rng, n: usize, radius: impl Fn(f64) -> f64) -> Vec<DVec3> {
    let widest = (0..=100)
        .map(|k| radius(k as f64 / 100.0))
        .fold(0.0, f64::max);
    let mut points = Vec::new();
    while points.len() < n {
        let t = rng.uniform();
        if rng.uniform() * widest < radius(t) {
            let a = TAU * rng.uniform();
            points.push(DVec3::new(radius(t) * a.cos(), radius(t) * a.sin(), t));
        }
    }
    points
}

/// A clump of strays and a strand of them to a place.
pub fn strays(rng: &mut Rng, n: usize, at: DVec3, to: DVec3) -> Vec<DVec3> {
    let clump = n * 6 / 10;
    let mut points: Vec<DVec3> = (0..clump).map(|_| at + gauss(rng) * 0.05).collect();
    let strand = n - clump;
    for k in 0..strand {
        let t = k as f64 / strand as f64;
        points.push(at + (to - at) * t + gauss(rng) * 0.012);
    }
    points
}

/// The points that an eye sees: those not far behind the nearest in their direction, and turned to it.
pub fn seen(points: &[(DVec3, DVec3)], eye: DVec3, cell: f64) -> Vec<usize> {
    let key = |p: DVec3| {
        let d = (p - eye).normalize();
        (d / cell).floor().as_ivec3()
    };
    let mut front = std::collections::HashMap::new();
    for (p, _) in points {
        let range = front.entry(key(*p)).or_insert(f64::INFINITY);
        *range = f64::min(*range, p.distance(eye));
    }
    let is_seen = |&i: &usize| {
        let (p, n) = points[i];
        let towards = (eye - p).normalize();
        towards.dot(n) > 0.25 && p.distance(eye) < front[&key(p)] * (1.0 + cell)
    };
    (0..points.len()).filter(is_seen).collect()
}
