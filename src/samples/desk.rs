//! A scan as one gets it: the duck on a round table, with a block beside it, seen from two places.
//!
//! 1. The duck as [`scanner`] sees it, without what stands on the table, and with a hole in its back.
//! 2. The table and the block, without what is hidden from both places.
//! 3. Flying pixels behind the duck's rim on one line of sight, and strays anywhere.
//! 4. Light from one side, which falls off over the table.

use super::model::Model;
use super::scanner;
use crate::base::rng::Rng;
use glam::{DVec3, dvec3};

/// Number of points that it is shown with.
pub const DESK_POINTS: usize = 60_000;

/// Height of the table's top: the duck stands on it.
const TOP: f64 = -2.25;
/// Of the table.
const RADIUS: f64 = 11.0;
/// Where it is seen from, in centimetres.
const EYES: [DVec3; 2] = [dvec3(15.0, 12.0, 13.0), dvec3(-13.0, 10.0, 14.0)];
/// Nothing was scanned within this distance of a place on the duck's back.
const HOLE: (DVec3, f64) = (dvec3(-2.4, 2.3, 0.9), 0.9);
/// Middle, half sizes and turn about y, in radians, of the block.
const BLOCK: (DVec3, DVec3, f64) = (dvec3(6.2, TOP + 1.1, -4.6), dvec3(1.7, 1.1, 1.2), 0.5);
/// Shares of the points: the table, the block, flying pixels, strays. The rest is the duck.
const SHARES: [f64; 4] = [0.44, 0.07, 0.006, 0.002];
/// Of tries for each point that is wanted: so many are enough where one in a few is taken.
const TRIES: usize = 400;

/// A point, its true normal, and its colour before there is light.
type Seen = (DVec3, DVec3, [f64; 3]);

/// Exactly `points` points with their true normals and colours; `noise` is a fraction of the duck's diagonal.
pub(super) fn scan(points: usize, seed: u64, noise: f64) -> Vec<(DVec3, DVec3, [u8; 3])> {
    let mut rng = Rng::new(seed ^ 0x6465_736b);
    let (low, high) = Model::Duck.bounds();
    let sigma = noise * low.distance(high);
    let counts = SHARES.map(|share| (share * points as f64) as usize);
    let duck = duck(points - counts.iter().sum::<usize>(), seed, noise);
    let mut seen = duck.clone();
    take(&mut seen, counts[0], || table(&mut rng, sigma));
    take(&mut seen, counts[1], || block(&mut rng, sigma));
    take(&mut seen, counts[2], || flying(&mut rng, &duck));
    while seen.len() < points {
        seen.push(stray(&mut rng));
    }
    seen.into_iter()
        .map(|one| (one.0, one.1, lit(&one)))
        .collect()
}

/// So many more of those that there are.
fn take(seen: &mut Vec<Seen>, count: usize, mut one: impl FnMut() -> Option<Seen>) {
    let tries = (0..TRIES * count).filter_map(|_| one());
    seen.extend(tries.take(count));
}

fn duck(count: usize, seed: u64, noise: f64) -> Vec<Seen> {
    let mut asked = count + count / 3;
    loop {
        let mut hits = scanner::scan(Model::Duck, asked, noise, seed);
        hits.retain(|hit| hit.truth.y > TOP + 0.06 && hit.truth.distance(HOLE.0) > HOLE.1);
        if hits.len() >= count {
            let hits = scanner::thin(hits, count, seed);
            let color = |p: DVec3| Model::Duck.color(p).map(f64::from);
            let seen = hits.iter();
            return seen
                .map(|hit| (hit.position, hit.normal, color(hit.truth)))
                .collect();
        }
        asked += 1 + asked / 3;
    }
}

fn table(rng: &mut Rng, sigma: f64) -> Option<Seen> {
    let (radius, angle) = (RADIUS * rng.uniform().sqrt(), rng.uniform());
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * angle);
    let p = dvec3(radius * cos, TOP, radius * sin);
    let off = DVec3::Y * (sigma * rng.normal());
    if !is_seen(p, rng) {
        return None;
    }
    let grain = 14.0 * libm::sin(2.3 * p.z + 0.8 * libm::sin(0.6 * p.x));
    let color = [178.0, 132.0, 90.0].map(|value| value + grain);
    Some((p + off, DVec3::Y, color))
}

fn block(rng: &mut Rng, sigma: f64) -> Option<Seen> {
    let (middle, half, turn) = BLOCK;
    // Two sides along each axis, but not the one that it stands on.
    let areas = [half.y * half.z, half.x * half.z, half.x * half.y];
    let side = rng.uniform() * (2.0 * areas[0] + areas[1] + 2.0 * areas[2]);
    let (axis, sign) = match side {
        s if s < areas[0] => (0, 1.0),
        s if s < 2.0 * areas[0] => (0, -1.0),
        s if s < 2.0 * areas[0] + areas[1] => (1, 1.0),
        s if s < 2.0 * areas[0] + areas[1] + areas[2] => (2, 1.0),
        _ => (2, -1.0),
    };
    let mut local = half * dvec3(place(rng), place(rng), place(rng));
    let mut normal = DVec3::ZERO;
    local[axis] = sign * half[axis];
    normal[axis] = sign;
    let turned = |v: DVec3| {
        let (sin, cos) = libm::sincos(turn);
        dvec3(cos * v.x + sin * v.z, v.y, cos * v.z - sin * v.x)
    };
    let (p, normal) = (middle + turned(local), turned(normal));
    let faces = EYES.iter().any(|&eye| (eye - p).dot(normal) > 0.0);
    let off = normal * (sigma * rng.normal());
    let color = [62.0, 112.0, 168.0];
    (faces && is_seen(p + 0.05 * normal, rng)).then_some((p + off, normal, color))
}

/// Behind the rim of the duck, as seen from the first place.
fn flying(rng: &mut Rng, duck: &[Seen]) -> Option<Seen> {
    let (p, normal, color) = duck.get((rng.uniform() * duck.len() as f64) as usize)?;
    let ray = (*p - EYES[0]).normalize();
    let q = *p + ray * (0.2 + 2.5 * rng.uniform());
    let is_rim = (-ray.dot(*normal)).abs() < 0.3;
    let is_free = q.y > TOP + 0.2 && Model::Duck.distance(q) > 0.1;
    (is_rim && is_free).then_some((q, -ray, color.map(|value| 0.6 * value + 60.0)))
}

fn stray(rng: &mut Rng) -> Seen {
    let p = dvec3(
        RADIUS * place(rng),
        4.0 + 6.0 * place(rng),
        RADIUS * place(rng),
    );
    (p, DVec3::Y, [150.0; 3])
}

/// From -1 to 1.
fn place(rng: &mut Rng) -> f64 {
    2.0 * rng.uniform() - 1.0
}

/// Whether a place is outside of duck and block and one of the eyes sees it; far ones are seen less often.
fn is_seen(p: DVec3, rng: &mut Rng) -> bool {
    let eye = EYES[usize::from(rng.uniform() < 0.4)];
    let way = eye - p;
    let near = EYES[0].length() / way.length();
    if rng.uniform() > 0.6 * near * near {
        return false;
    }
    let ray = way.normalize();
    let mut range = 0.0;
    while range < 20.0 {
        let q = p + ray * range;
        let gap = Model::Duck.distance(q).min(block_distance(q));
        if gap < 0.02 {
            return false;
        }
        range += gap;
    }
    true
}

/// From the block, where it is not negative.
fn block_distance(p: DVec3) -> f64 {
    let (middle, half, turn) = BLOCK;
    let (sin, cos) = libm::sincos(turn);
    let v = p - middle;
    let local = dvec3(cos * v.x - sin * v.z, v.y, sin * v.x + cos * v.z);
    (local.abs() - half).max(DVec3::ZERO).length()
}

/// Its colour where a lamp stands on one side.
fn lit((p, normal, color): &Seen) -> [u8; 3] {
    let lamp = dvec3(10.0, 16.0, 4.0) - *p;
    let falls = 420.0 / lamp.length_squared();
    let light = 0.3 + falls * normal.dot(lamp.normalize()).max(0.0) * 0.75;
    color.map(|value| (value * light).round().clamp(0.0, 255.0) as u8)
}
