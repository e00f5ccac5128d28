//! Motions that may bring one scan onto another: points that look alike are matched, and what many matches agree on is a candidate.
//!
//! Two matches agree when a rigid motion can hold both: the points are as far apart in either scan, and the normals stand to the
//! line between them, and to each other, as in the other. Among matches nearly all of which are wrong, right ones are found by how many
//! others agree with both ends of an agreement (Chen, Sun, Yang, Tao, "SC²-PCR: a second order spatial compatibility for efficient and
//! robust point cloud registration", 2022). Nothing is drawn at random.

use super::describe::{Look, turned};
use super::pose::{Pair, Pose};
use super::samples::Samples;
use crate::base::par;
use crate::base::sort_keys::{key, ranked, sort_by_key, unpack};
use glam::{DVec3, Vec3};

/// Matches that are compared with each other, at most.
const MOST: usize = 4096;
/// Two matches are at least this far apart, in cells: close by, wrong matches agree, too.
const FAR: f32 = 5.0;
/// How much longer the way between two points may be in one scan, in cells.
const LONGER: f32 = 1.5;
/// How much the cosines of their angles may differ.
const ANGLE: f32 = 0.25;
/// Matches from which a motion is looked for.
const SEEDS: usize = 64;
/// Matches of one seed.
const GROUP: usize = 24;
/// A match holds under a motion when its points come this near, in cells, and its normals within this cosine.
const NEAR: f64 = 1.5;
const ALONG: f64 = 0.8;
/// Candidates that are kept, and how far apart they are at least, in cells.
const KEPT: usize = 12;
const APART: f64 = 4.0;
/// Matches that a candidate needs.
const LEAST: usize = 5;

/// A point of one scan and one of another that looks like it. The second normal is turned to the side of the first.
#[derive(Debug, Clone, Copy)]
struct Match {
    from: (Vec3, Vec3),
    to: (Vec3, Vec3),
}

/// A scan's samples and their descriptions.
pub(crate) type Described<'a> = (&'a Samples, &'a [Look]);

/// Motions from `a` to `b`, the ones with most matches first.
pub(crate) fn candidates(a: Described, b: Described) -> Vec<Pose> {
    let cell = a.0.cell;
    let matches = matches(a, b);
    let agreements = Agreements::of(&matches, cell);
    let mut found: Vec<(usize, Pose)> = agreements
        .seeds()
        .into_iter()
        .filter_map(|seed| refined(&matches, &agreements.group(seed), cell))
        .collect();
    sort_by_key(&mut found, |&(held, _)| !(held as u32));
    let ball = a.0.ball();
    let mut kept: Vec<Pose> = Vec::new();
    for (_, pose) in found {
        let is_new = |other: &Pose| other.apart(&pose, ball) > APART * f64::from(cell);
        if kept.len() < KEPT && kept.iter().all(is_new) {
            kept.push(pose);
        }
    }
    kept
}

/// Of every point of either scan the one of the other that looks most like it.
fn matches((a, a_looks): Described, (b, b_looks): Described) -> Vec<Match> {
    let mut all = nearest((a, a_looks), (b, b_looks));
    let mut partner = vec![usize::MAX; a.len()];
    for &(i, j, ..) in &all {
        partner[i] = j;
    }
    let back = nearest((b, b_looks), (a, a_looks)).into_iter();
    // What was found from either side stands there already.
    let others = back.filter(|&(j, i, ..)| partner[i] != j);
    all.extend(others.map(|(j, i, sign, far)| (i, j, sign, far)));
    sort_by_key(&mut all, |&(.., far)| key(far));
    all.truncate(MOST);
    all.iter()
        .map(|&(i, j, sign, _)| Match {
            from: (a.tree.points[i], a.normals[i]),
            to: (b.tree.points[j], b.normals[j] * sign),
        })
        .collect()
}

fn nearest((a, a_looks): Described, (b, b_looks): Described) -> Vec<(usize, usize, f32, f32)> {
    let others: Vec<(usize, [Look; 2])> = (0..b.len())
        .filter(|&j| !b.rim[j])
        .map(|j| (j, [b_looks[j], turned(&b_looks[j])]))
        .collect();
    let asking: Vec<usize> = (0..a.len()).filter(|&i| !a.rim[i]).collect();
    let best = |k: usize, _: &mut ()| {
        let mut best = (asking[k], 0, 1.0, f32::INFINITY);
        for (j, looks) in &others {
            for (look, sign) in looks.iter().zip([1.0, -1.0]) {
                let far = distance(&a_looks[asking[k]], look);
                if far < best.3 {
                    best = (asking[k], *j, sign, far);
                }
            }
        }
        best
    };
    let found = par::map(asking.len(), || (), best);
    found.into_iter().filter(|m| m.3.is_finite()).collect()
}

fn distance(a: &Look, b: &Look) -> f32 {
    let mut sums = [0.0f32; 8];
    for (x, y) in a.chunks(8).zip(b.chunks(8)) {
        for ((sum, x), y) in sums.iter_mut().zip(x).zip(y) {
            *sum += (x - y) * (x - y);
        }
    }
    sums.iter().sum()
}

/// Which matches agree: a bit for each two.
struct Agreements {
    rows: Vec<Vec<u64>>,
}

impl Agreements {
    fn of(matches: &[Match], cell: f32) -> Agreements {
        let words = matches.len().div_ceil(64);
        let row = |i: usize, _: &mut ()| {
            let mut row = vec![0u64; words];
            for (j, other) in matches.iter().enumerate() {
                row[j / 64] |= u64::from(agree(&matches[i], other, cell)) << (j % 64);
            }
            row
        };
        Agreements {
            rows: par::map(matches.len(), || (), row),
        }
    }

    fn common(&self, i: usize, j: usize) -> u32 {
        let both = self.rows[i].iter().zip(&self.rows[j]);
        both.map(|(x, y)| (x & y).count_ones()).sum()
    }

    fn neighbors(&self, i: usize) -> impl Iterator<Item = usize> {
        let words = self.rows[i].iter().enumerate();
        words.flat_map(|(w, &word)| {
            (0..64)
                .filter(move |b| word >> b & 1 == 1)
                .map(move |b| 64 * w + b)
        })
    }

    /// The matches with most agreements that others share.
    fn seeds(&self) -> Vec<usize> {
        let shared = |i: usize, _: &mut ()| {
            let common = self.neighbors(i).map(|j| u64::from(self.common(i, j)));
            common.sum::<u64>()
        };
        let shared = par::map(self.rows.len(), || (), shared);
        let order = ranked(shared.iter().map(|&x| !(x.min(u32::MAX.into()) as u32)));
        let order = order.into_iter().map(|packed| unpack(packed).1 as usize);
        order.filter(|&i| shared[i] > 0).take(SEEDS).collect()
    }

    /// A match and those that agree with it and, as it does, with most others.
    fn group(&self, seed: usize) -> Vec<usize> {
        let all: Vec<usize> = self.neighbors(seed).collect();
        let near = ranked(all.iter().map(|&j| !self.common(seed, j))).into_iter();
        let near = near
            .take(GROUP)
            .map(|packed| all[unpack(packed).1 as usize]);
        std::iter::once(seed).chain(near).collect()
    }
}

fn agree(a: &Match, b: &Match, cell: f32) -> bool {
    let (p, q) = (b.from.0 - a.from.0, b.to.0 - a.to.0);
    let (p2, q2) = (p.length_squared(), q.length_squared());
    let least = FAR * cell;
    if p2 < least * least || q2 < least * least {
        return false;
    }
    let (p_length, q_length) = (p2.sqrt(), q2.sqrt());
    if (p_length - q_length).abs() > LONGER * cell {
        return false;
    }
    let (p, q) = (p / p_length, q / q_length);
    (a.from.1.dot(p) - a.to.1.dot(q)).abs() < ANGLE
        && (b.from.1.dot(p) - b.to.1.dot(q)).abs() < ANGLE
        && (a.from.1.dot(b.from.1) - a.to.1.dot(b.to.1)).abs() < ANGLE
}

/// The motion of a group, then of all matches that hold under it; how many do.
fn refined(matches: &[Match], group: &[usize], cell: f32) -> Option<(usize, Pose)> {
    let pair = |m: &Match| {
        let double = |(p, n): (Vec3, Vec3)| (p.as_dvec3(), n.as_dvec3());
        Pair {
            from: double(m.from),
            to: double(m.to),
        }
    };
    let arm = 4.0 * f64::from(cell);
    let group: Vec<Pair> = group.iter().map(|&i| pair(&matches[i])).collect();
    let mut pose = Pose::fit(&group, arm)?;
    let mut held = 0;
    for _ in 0..3 {
        let holds = |pair: &Pair| {
            let (p, n): (DVec3, DVec3) = (pose.at(pair.from.0), pose.turn * pair.from.1);
            p.distance(pair.to.0) < NEAR * f64::from(cell) && n.dot(pair.to.1) > ALONG
        };
        let own: Vec<Pair> = matches.iter().map(pair).filter(holds).collect();
        if own.len() < LEAST {
            return None;
        }
        held = own.len();
        pose = Pose::fit(&own, arm)?;
    }
    Some((held, pose))
}
