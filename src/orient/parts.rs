//! Parts: pieces of surface that have one sign because more than a contact or a strand ties them.
//!
//! Pieces come first: flat ones (tables, floors, walls), then smooth ones. Two pieces become one part where their tie is
//! strong, and one-sided or of one mind. A tie is not where one piece goes on at both sides of the other, as a disc does inside
//! and outside of the vase that stands on it: in such a T both sides of the wall are equally good, and what the edges say hangs
//! on how the foot flares.

use crate::base::groups::Groups;
use crate::base::sets::Sets;
use crate::base::sort_keys::{key, pack, ranked, unpack};
use crate::features::noise::quantile;
use crate::orient::domains::Domains;
use crate::orient::graph::{Adjacency, Edge, adjacency};
use glam::Vec3;

/// Two pieces, the smaller of n sub-domains, are one part when their tie is more than this times √n. Of 0.4 to 3 on vases,
/// cups and boxes on tables of 1,500 to 8,000 points: under 1 some join across the table, from 1.5 on all are right.
pub(crate) const WEAK: f32 = 1.5;
/// A piece of fewer sub-domains joins what it is tied to by more than half of all that ties it.
const SMALL: usize = 12;
/// Cosine of the largest turn from one sub-domain to the next within a smooth piece.
const SMOOTH: f32 = 0.77;
/// Cosine of the largest turn from the mean of a flat piece.
const FLAT: f32 = 0.95;
/// Cosine of the turn from the mean under which members of a piece that was not flat need not be tried again: what grows from
/// them is much the same.
const TRIED: f32 = 0.988;
/// Length of the mean normal of a flat piece: a cap of a ball within the same turn has 0.975.
const EVEN: f32 = 0.99;
/// A flat piece has at least one in so many of all sub-domains.
const LARGE: usize = 33;
/// Sine of the slope from which on a neighbour counts as on one side of a sub-domain.
const ASIDE: f32 = 0.25;
/// One-sidedness of a tie: under the first it says nothing, from the second on it counts in full. Smooth joints and L joints
/// have 0.74 to 1.00, T joints 0.34 to 0.45.
const SIDED: [f32; 2] = [0.6, 0.9];
/// Share of a tie's weight that its edges agree on: from the second on it counts in full, on however many sides. In a T the edges of
/// both sides contradict each other. A few large sub-domains on thin walls see much on both sides and agree: 0.95 to 1.00 on
/// the machined part of 1,000 to 1,800 points.
const AGREED: [f32; 2] = [0.85, 0.95];

/// What ties two parts `a` < `b`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tie {
    pub(crate) a: u32,
    pub(crate) b: u32,
    /// Σ w s s over their edges, as far as it is one-sided.
    pub(crate) strength: f32,
}

/// The parts of a surface.
#[derive(Debug)]
pub(crate) struct Parts {
    /// The part of every sub-domain.
    pub(crate) of: Vec<u32>,
    /// The sub-domains of every part.
    pub(crate) members: Groups<u32>,
    pub(crate) ties: Vec<Tie>,
}

impl Parts {
    /// From `signs` of little energy. They change where two pieces of one plane, which another stands on, look to different
    /// sides: then the smaller turns.
    pub(crate) fn new(domains: &Domains, edges: &[Edge], signs: &mut [f32]) -> Parts {
        let normals = domains.mean_normals(signs);
        let mut ground = Ground {
            edges,
            signs,
            normals,
            centers: domains.centers(),
            spacing: quantile(domains.sites.spacing.clone(), 2),
        };
        let around = adjacency(ground.signs.len(), edges);
        let flat = ground.flat_pieces(&around);
        let mut sets = ground.level(&flat, &around);
        ground.join_smooth(&flat, &mut sets);
        loop {
            let (of, count) = sets.clone().numbered();
            let members = Groups::new(count, || of.iter().copied().zip(0u32..));
            let ties = ground.ties(&of, count);
            let joins = joins(&ties, &members);
            if joins.is_empty() {
                return Parts { of, members, ties };
            }
            for (a, b) in joins {
                sets.join(members.of(a)[0], members.of(b)[0]);
            }
        }
    }

    pub(crate) fn count(&self) -> usize {
        self.members.count()
    }

    /// The edges, with less weight the more the surface turns along them where two large parts meet in a T, times the squared
    /// cosine of the two normals. Where a wall stands on a disc, both pull at what lies at the foot, but it goes on from one of them.
    pub(crate) fn along_sheets(
        &self,
        domains: &Domains,
        edges: &[Edge],
        around: &Adjacency,
    ) -> Vec<Edge> {
        let is_large = |s: u32| self.members.of(self.of[s as usize]).len() >= SMALL;
        let silent = self.ties.iter().filter(|t| t.strength == 0.0);
        let mut silent: Vec<u64> = silent.map(|t| pack(t.a, t.b)).collect();
        silent.sort_unstable();
        let mut meet = vec![false; self.of.len()];
        for e in edges {
            let (p, q) = (self.of[e.a as usize], self.of[e.b as usize]);
            let is_t = silent.binary_search(&pack(p.min(q), p.max(q))).is_ok();
            if is_t && is_large(e.a) && is_large(e.b) {
                meet[e.a as usize] = true;
                meet[e.b as usize] = true;
            }
        }
        let near: Vec<bool> = (0..meet.len() as u32)
            .map(|s| meet[s as usize] || around.of(s).iter().any(|&(_, t)| meet[t as usize]))
            .collect();
        let normals = domains.mean_normals(&vec![1.0; domains.len()]);
        let along = |e: &Edge| {
            let (a, b) = (e.a as usize, e.b as usize);
            let cos = normals[a].dot(normals[b]);
            let weight = if near[a] || near[b] {
                e.weight * cos * cos
            } else {
                e.weight
            };
            Edge { weight, ..*e }
        };
        edges.iter().map(along).collect()
    }

    /// Gives a part the other sign.
    pub(crate) fn turn(&self, part: u32, signs: &mut [f32]) {
        for &s in self.members.of(part) {
            signs[s as usize] = -signs[s as usize];
        }
    }

    /// The sum of a value over every part.
    pub(crate) fn sums(&self, value: impl Fn(u32) -> f32) -> Vec<f32> {
        let parts = self.members.iter();
        parts.map(|p| p.iter().map(|&s| value(s)).sum()).collect()
    }
}

/// The pairs of parts that become one: the strongest ties first. What joined a larger one takes nothing up in the same round,
/// so that the T between two is seen before a third joins them.
fn joins(ties: &[Tie], members: &Groups<u32>) -> Vec<(u32, u32)> {
    let size = |p: u32| members.of(p).len();
    let mut total = vec![0.0; members.count()];
    for tie in ties {
        total[tie.a as usize] += tie.strength;
        total[tie.b as usize] += tie.strength;
    }
    let mut wanted: Vec<(u32, u32, f32)> = Vec::new();
    for tie in ties {
        let (small, large) = if size(tie.a) <= size(tie.b) {
            (tie.a, tie.b)
        } else {
            (tie.b, tie.a)
        };
        let ratio = tie.strength / (size(small) as f32).sqrt();
        let is_most = size(small) < SMALL && tie.strength > 0.5 * total[small as usize];
        if ratio > WEAK || (is_most && ratio > 0.0) {
            wanted.push((small, large, ratio));
        }
    }
    let (mut taken, mut joined) = (vec![false; members.count()], vec![false; members.count()]);
    let mut joins = Vec::new();
    for place in ranked(wanted.iter().map(|w| !key(w.2))) {
        let (small, large, _) = wanted[unpack(place).1 as usize];
        if joined[small as usize] || taken[small as usize] {
            continue;
        }
        joined[small as usize] = true;
        if !joined[large as usize] {
            taken[large as usize] = true;
            joins.push((small, large));
        }
    }
    joins
}

/// What parts are made from.
struct Ground<'a> {
    edges: &'a [Edge],
    signs: &'a mut [f32],
    normals: Vec<Vec3>,
    centers: Vec<Vec3>,
    spacing: f32,
}

/// Pieces that are flat.
struct Flat {
    /// The piece of every sub-domain, or [`NONE`].
    of: Vec<u32>,
    pieces: Vec<Vec<u32>>,
}

/// In no piece.
const NONE: u32 = u32::MAX;

impl Ground<'_> {
    fn agreement(&self, e: &Edge) -> f32 {
        e.weight * self.signs[e.a as usize] * self.signs[e.b as usize]
    }

    fn flat_pieces(&self, around: &Adjacency) -> Flat {
        let n = self.signs.len();
        let least = SMALL.max(n / LARGE);
        let mut flat = Flat {
            of: vec![NONE; n],
            pieces: Vec::new(),
        };
        let mut tried = vec![false; n];
        // The seed from which a sub-domain was reached last.
        let mut reached = vec![NONE; n];
        for seed in 0..n as u32 {
            if flat.of[seed as usize] != NONE || tried[seed as usize] {
                continue;
            }
            let (mut piece, mut sum, mut next) = (vec![seed], self.normals[seed as usize], 0);
            reached[seed as usize] = seed;
            while next < piece.len() {
                let mean = sum.normalize_or_zero();
                for &(e, t) in around.of(piece[next]) {
                    let normal = self.normals[t as usize];
                    if flat.of[t as usize] == NONE
                        && reached[t as usize] != seed
                        && self.agreement(&self.edges[e as usize]) > 0.0
                        && normal.dot(mean) > FLAT
                    {
                        reached[t as usize] = seed;
                        sum += normal;
                        piece.push(t);
                    }
                }
                next += 1;
            }
            if piece.len() >= least && sum.length() > EVEN * piece.len() as f32 {
                let number = flat.pieces.len() as u32;
                piece.iter().for_each(|&s| flat.of[s as usize] = number);
                flat.pieces.push(piece);
            } else {
                let mean = sum.normalize_or_zero();
                for &s in &piece {
                    tried[s as usize] |= self.normals[s as usize].dot(mean) > TRIED;
                }
            }
        }
        flat
    }

    /// Joins flat pieces of one plane that something stands between, as a vase does on its disc.
    fn level(&mut self, flat: &Flat, around: &Adjacency) -> Sets {
        let mut sets = Sets::new(self.signs.len());
        for piece in &flat.pieces {
            piece.iter().for_each(|&s| sets.join(s, piece[0]));
        }
        let mean = |of: &[Vec3], piece: &[u32]| {
            let sum: Vec3 = piece.iter().map(|&s| of[s as usize]).sum();
            sum / piece.len() as f32
        };
        let mut between: Vec<u64> = Vec::new();
        for s in (0..self.signs.len() as u32).filter(|&s| flat.of[s as usize] == NONE) {
            let pieces = around.of(s).iter().map(|&(_, t)| flat.of[t as usize]);
            let mut pieces: Vec<u32> = pieces.filter(|&p| p != NONE).collect();
            pieces.sort_unstable();
            pieces.dedup();
            for (k, &p) in pieces.iter().enumerate() {
                between.extend(pieces[k + 1..].iter().map(|&q| pack(p, q)));
            }
        }
        between.sort_unstable();
        between.dedup();
        for (p, q) in between.into_iter().map(unpack) {
            let [p, q] = [p, q].map(|p| &flat.pieces[p as usize]);
            let [m, n] = [p, q].map(|piece| mean(&self.normals, piece).normalize_or_zero());
            let [a, b] = [p, q].map(|piece| mean(&self.centers, piece));
            let is_level = m.dot(n).abs() > EVEN && (b - a).dot(m).abs() < self.spacing;
            if is_level && sets.find(p[0]) != sets.find(q[0]) {
                if m.dot(n) < 0.0 {
                    let smaller = if p.len() < q.len() { p } else { q };
                    self.turn_set(sets.find(smaller[0]), &mut sets);
                }
                sets.join(p[0], q[0]);
            }
        }
        sets
    }

    fn turn_set(&mut self, set: u32, sets: &mut Sets) {
        for s in 0..self.signs.len() {
            if sets.find(s as u32) == set {
                self.signs[s] = -self.signs[s];
                self.normals[s] = -self.normals[s];
            }
        }
    }

    /// Joins what is smooth and not flat.
    fn join_smooth(&self, flat: &Flat, sets: &mut Sets) {
        for e in self.edges {
            let (a, b) = (e.a as usize, e.b as usize);
            let is_free = flat.of[a] == NONE && flat.of[b] == NONE;
            let is_smooth = self.normals[a].dot(self.normals[b]) > SMOOTH;
            if is_free && is_smooth && self.agreement(e) > 0.0 {
                sets.join(e.a, e.b);
            }
        }
    }

    /// What ties every two pieces.
    fn ties(&self, of: &[u32], count: usize) -> Vec<Tie> {
        let between = Groups::new(count, || {
            let numbered = self.edges.iter().zip(0u32..);
            numbered.filter_map(|(e, i)| {
                let (a, b) = (of[e.a as usize], of[e.b as usize]);
                (a != b).then(|| (a.min(b), pack(a.max(b), i)))
            })
        });
        let mut ties = Vec::new();
        for a in 0..count as u32 {
            let mut others = between.of(a).to_vec();
            others.sort_unstable();
            for edges in others.chunk_by(|x, y| unpack(*x).0 == unpack(*y).0) {
                let b = unpack(edges[0]).0;
                let edges = || edges.iter().map(|&p| &self.edges[unpack(p).1 as usize]);
                let sum: f32 = edges().map(|e| self.agreement(e)).sum();
                let sided = self.sided(edges(), |e| of[e.a as usize] == a);
                let sided = sided.min(self.sided(edges(), |e| of[e.a as usize] == b));
                let all: f32 = edges().map(|e| e.weight.abs()).sum();
                let agreed = sum.abs() / all.max(f32::MIN_POSITIVE);
                let within =
                    |x: f32, [low, high]: [f32; 2]| ((x - low) / (high - low)).clamp(0.0, 1.0);
                let strength = sum * within(sided, SIDED).max(within(agreed, AGREED));
                ties.push(Tie { a, b, strength });
            }
        }
        ties
    }

    /// How far the other ends of some edges are on one side of those at this piece: 1, 0 where as many are on either.
    fn sided<'b>(
        &self,
        edges: impl Iterator<Item = &'b Edge>,
        starts_here: impl Fn(&Edge) -> bool,
    ) -> f32 {
        let (mut above, mut below, mut along) = (0.0f32, 0.0f32, 0.0f32);
        for e in edges {
            let (here, there) = if starts_here(e) {
                (e.a as usize, e.b as usize)
            } else {
                (e.b as usize, e.a as usize)
            };
            let away = (self.centers[there] - self.centers[here]).normalize_or_zero();
            let side = self.normals[here].dot(away);
            let weight = e.weight.abs();
            if side > ASIDE {
                above += weight;
            } else if side < -ASIDE {
                below += weight;
            } else {
                along += weight;
            }
        }
        let all = above + below + along;
        if all > 0.0 {
            ((above - below).abs() + along) / all
        } else {
            1.0
        }
    }
}
