//! Points spread over triangles: as many as are wanted, evenly over the area, none close to another.
//!
//! Several candidates for each point are laid out by area, in a triangle along the R2 sequence (Roberts, "The Unreasonable
//! Effectiveness of Quasirandom Sequences", 2018). Then darts are thrown (Cook, "Stochastic Sampling in Computer Graphics",
//! 1986): candidates in random order are accepted where no accepted point of the same side is within a radius, which shrinks
//! from round to round until there are enough (McCool and Fiume, "Hierarchical Poisson Disk Sampling Distributions", 1992). Where a
//! surface ends a point has fewer others to keep apart from; so that rims do not get more than their share, every few
//! hundred candidates, which stand for equal areas, have a quota.

use super::vectors::{area_normal, dot, unit};
use crate::base::rng::Rng;

/// Candidates for each point; fewer where they would take more memory than there are points worth it.
const CANDIDATES: usize = 4;
const MOST_CANDIDATES: usize = 6_000_000;
/// Radii of the rounds, as shares of the distance in the densest packing of as many discs; at 0 all are accepted.
const RADII: [f64; 6] = [0.80, 0.72, 0.64, 0.55, 0.4, 0.0];
/// Candidates that share a quota: few enough for even shares, many enough that they seldom have to come close.
const A_QUOTA: usize = 256;
/// Points of two sides of a sheet do not keep apart: the cosine between their triangles' normals is under this.
const OTHER_SIDE: f32 = -0.2;
/// Steps of the R2 sequence: powers of the inverse of the plastic number.
const R2: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];
/// Of the random numbers, so that a file gives the same points every time.
const SEED: u64 = 0x9e37_79b9;

/// A point of a triangle.
#[derive(Clone, Copy)]
pub(super) struct Sample {
    pub(super) triangle: u32,
    /// Shares of the second and third corner.
    shares: [f32; 2],
}

impl Sample {
    /// Shares of the three corners, which sum to 1.
    pub(super) fn weights(&self) -> [f64; 3] {
        let [v, w] = self.shares.map(f64::from);
        [1.0 - v - w, v, w]
    }
}

/// `wanted` points, in the order of the triangles; `None` where these have no area.
pub(super) fn over(
    corners: &[[u32; 3]],
    position: impl Fn(u32) -> [f64; 3],
    wanted: usize,
) -> Option<Vec<Sample>> {
    let double_area = |triangle: &[u32; 3]| {
        let v = area_normal(triangle.map(&position));
        dot(v, v).sqrt()
    };
    let areas: Vec<f64> = corners.iter().map(double_area).collect();
    let total: f64 = areas.iter().sum();
    if !(total.is_finite() && total > 0.0) {
        return None;
    }
    let count = (CANDIDATES * wanted).min(MOST_CANDIDATES.max(wanted));
    let candidates = lay_out(&areas, total, count);
    // The distance of neighbours in the densest packing: area = √3/2 · distance² for each.
    let packed = (total / (3f64.sqrt() * wanted as f64)).sqrt();
    let centre = position(corners[0][0]);
    let places: Vec<[f32; 3]> = candidates
        .iter()
        .map(|sample| {
            let [a, b, c] = corners[sample.triangle as usize].map(&position);
            let w = sample.weights();
            [0, 1, 2].map(|k| {
                let x = w[0] * (a[k] - centre[k])
                    + w[1] * (b[k] - centre[k])
                    + w[2] * (c[k] - centre[k]);
                (x / packed) as f32
            })
        })
        .collect();
    let normals: Vec<[f32; 3]> = corners
        .iter()
        .map(|triangle| unit(area_normal(triangle.map(&position))).map(|x| x as f32))
        .collect();
    let accepted = throw(&candidates, &places, &normals, wanted);
    let chosen = candidates
        .iter()
        .zip(accepted)
        .filter(|(_, accepted)| *accepted);
    Some(chosen.map(|(sample, _)| *sample).collect())
}

/// Candidates by area: one in each of as many equal shares of the whole.
fn lay_out(areas: &[f64], total: f64, count: usize) -> Vec<Sample> {
    let mut rng = Rng::new(SEED);
    let mut candidates = Vec::with_capacity(count);
    let mut before = 0.0;
    let mut next = rng.uniform();
    for (triangle, &area) in areas.iter().enumerate() {
        before += area;
        // The last takes what rounding has left.
        let upto = if triangle + 1 == areas.len() {
            count as f64
        } else {
            before / total * count as f64
        };
        if next >= upto || area == 0.0 {
            continue;
        }
        let start = [rng.uniform(), rng.uniform()];
        let mut step = 0.0;
        while next < upto && candidates.len() < count {
            let [mut v, mut w] = [0, 1].map(|k| (start[k] + R2[k] * step).fract());
            if v + w > 1.0 {
                (v, w) = (1.0 - v, 1.0 - w);
            }
            candidates.push(Sample {
                triangle: triangle as u32,
                shares: [v as f32, w as f32],
            });
            step += 1.0;
            next = candidates.len() as f64 + rng.uniform();
        }
    }
    candidates
}

/// Which candidates are accepted; `places` are in units of the densest packing's distance.
fn throw(
    candidates: &[Sample],
    places: &[[f32; 3]],
    normals: &[[f32; 3]],
    wanted: usize,
) -> Vec<bool> {
    let mut waiting: Vec<u32> = (0..candidates.len() as u32).collect();
    let mut rng = Rng::new(SEED + 1);
    for i in (1..waiting.len()).rev() {
        waiting.swap(i, (rng.next_u64() % (i as u64 + 1)) as usize);
    }
    let grid = Grid::of(places);
    let normal = |i: u32| normals[candidates[i as usize].triangle as usize];
    // Squared distance to the nearest accepted point of the same side, where it is within the first radius.
    let mut nearest = vec![f32::INFINITY; candidates.len()];
    let mut accepted = vec![false; candidates.len()];
    let mut left = quotas(candidates.len(), wanted.min(candidates.len()));
    for radius in RADII {
        let squared = (radius * radius) as f32;
        waiting.retain(|&i| {
            let quota = &mut left[i as usize / A_QUOTA];
            if *quota == 0 || nearest[i as usize] < squared {
                return true;
            }
            *quota -= 1;
            let (place, side) = (places[i as usize], normal(i));
            grid.near(place, |other| {
                let p = places[other as usize];
                let d = [p[0] - place[0], p[1] - place[1], p[2] - place[2]];
                let distance = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
                if distance < nearest[other as usize] {
                    let n = normal(other);
                    if n[0] * side[0] + n[1] * side[1] + n[2] * side[2] >= OTHER_SIDE {
                        nearest[other as usize] = distance;
                    }
                }
            });
            accepted[i as usize] = true;
            false
        });
    }
    accepted
}

/// How many of every [`A_QUOTA`] candidates are accepted; they sum to what is wanted.
fn quotas(candidates: usize, wanted: usize) -> Vec<u32> {
    let upto =
        |candidate: usize| (candidate as u64 * wanted as u64 / candidates.max(1) as u64) as u32;
    (0..candidates)
        .step_by(A_QUOTA)
        .map(|first| upto((first + A_QUOTA).min(candidates)) - upto(first))
        .collect()
}

/// Candidates by cubic cell. Cells are hashed to lists: one may hold those of other cells, too, which are too far to matter.
struct Grid {
    /// The candidates of list `l` are `members[starts[l]..starts[l + 1]]`.
    starts: Vec<u32>,
    members: Vec<u32>,
}

/// The first radius, so that what is near lies in eight cells at most.
const CELL: f32 = 2.0 * RADII[0] as f32;
/// No list is looked at farther: of a surface a cell holds some tens of candidates, more only where single precision fails.
const MOST_MEMBERS: usize = 1024;

impl Grid {
    fn of(places: &[[f32; 3]]) -> Grid {
        let lists = places.len().next_power_of_two();
        let list_of: Vec<u32> = places
            .iter()
            .map(|&place| list(cell(place), lists) as u32)
            .collect();
        let mut starts = vec![0u32; lists + 1];
        list_of.iter().for_each(|&l| starts[l as usize + 1] += 1);
        for l in 1..starts.len() {
            starts[l] += starts[l - 1];
        }
        let mut next = starts.clone();
        let mut members = vec![0; places.len()];
        for (i, &l) in list_of.iter().enumerate() {
            members[next[l as usize] as usize] = i as u32;
            next[l as usize] += 1;
        }
        Grid { starts, members }
    }

    /// All candidates within the first radius, and some others.
    fn near(&self, place: [f32; 3], mut each: impl FnMut(u32)) {
        let low = cell(place.map(|x| x - 0.5 * CELL));
        let high = cell(place.map(|x| x + 0.5 * CELL));
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    let l = list([x, y, z], self.starts.len() - 1);
                    let members =
                        &self.members[self.starts[l] as usize..self.starts[l + 1] as usize];
                    members.iter().take(MOST_MEMBERS).for_each(|&i| each(i));
                }
            }
        }
    }
}

fn cell(place: [f32; 3]) -> [i64; 3] {
    place.map(|x| (x / CELL).floor() as i64)
}

/// The list of a cell, of a power of two.
fn list(cell: [i64; 3], lists: usize) -> usize {
    let hash = cell.iter().fold(0u64, |hash, &x| {
        (hash ^ x as u64)
            .wrapping_mul(0x9E37_79B9_7F4A_7C15)
            .rotate_left(29)
    });
    hash as usize & (lists - 1)
}
