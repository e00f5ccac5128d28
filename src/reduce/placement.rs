//! From clusters to reduced points: where each centre goes and what it carries.
//!
//! A cluster centre (eq. 2) is a mean, and sinks below a curved surface by about κh²/4π. With a matrix `A` of its own
//! for each point, `A_k = n_k n_kᵀ + τI`, eq. 1 measures distances to the tangent planes, and the centre that minimises
//! it, `v = (Σ u^m A_k)⁻¹ Σ u^m A_k x_k`, lands as far outside and exactly on creases and corners.
//! Half-way between the two lies on the surface (to third order).

use std::collections::BTreeMap;
use std::ops::Range;

use glam::{DMat3, DVec3, Vec3};

use crate::base::linalg::sym_eigen;
use crate::base::par;
use crate::base::params::{COLORS, Carry, Placement};
use crate::base::power::Fuzzifier;
use crate::base::sort_keys::{key, ranked, unpack};
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;
use crate::cloud::{Attribute, Cloud};
use crate::features::Features;
use crate::reduce::shares::Shares;

/// τ of A_k: how much a distance along the surface counts against one across it.
const TAU: f64 = 0.03;

/// Second eigenvalue of the mean of n nᵀ (0 on a plane, ½ on a right-angled edge) from which a centre is on a crease,
/// and from which it is so for sure.
const CREASE: Range<f64> = 0.02..0.08;

/// How far an implicit placement goes from the mean to the minimum of the plane distances. Half-way is on a surface of
/// constant curvature; surfaces that are fitted through few points shrink, and 0.7 gave the least error of Poisson surfaces of
/// four models that the bench does not use (2 % less than 0.5, no farther from the truth).
const OUTWARD: f64 = 0.7;

/// Centres whose members are in one list: short lists find room where large arrays were freed, one list of all would not.
const BLOCK: usize = 1024;

/// The members of every cluster.
#[derive(Debug, Clone)]
pub struct Members<'a> {
    shares: &'a [Shares],
    /// How many members the centres before each one have together.
    before: Vec<u32>,
    /// The members of [`BLOCK`] centres each.
    blocks: Vec<Vec<u32>>,
}

impl<'a> Members<'a> {
    /// Turns memberships by point into memberships by centre.
    pub fn new(shares: &'a [Shares], centers: usize) -> Members<'a> {
        let mut before = vec![0u32; centers + 1];
        for (i, _) in shares.iter().flat_map(Shares::used) {
            before[i as usize + 1] += 1;
        }
        for i in 0..centers {
            before[i + 1] += before[i];
        }
        let starts = (0..centers).step_by(BLOCK);
        let mut blocks: Vec<Vec<u32>> = starts
            .map(|i| before[(i + BLOCK).min(centers)] - before[i])
            .map(|members| vec![0; members as usize])
            .collect();
        let mut next: Vec<u32> = (0..centers)
            .map(|i| before[i] - before[i - i % BLOCK])
            .collect();
        for (k, s) in shares.iter().enumerate() {
            for (i, _) in s.used() {
                let next = &mut next[i as usize];
                blocks[i as usize / BLOCK][*next as usize] = k as u32;
                *next += 1;
            }
        }
        Members {
            shares,
            before,
            blocks,
        }
    }

    /// The members of centre `i`, in the octree's order, and their memberships.
    pub fn of(&self, i: usize) -> impl Iterator<Item = (u32, f32)> {
        let place = |before: u32| (before - self.before[i - i % BLOCK]) as usize;
        let members = place(self.before[i])..place(self.before[i + 1]);
        self.blocks[i / BLOCK][members].iter().map(move |&k| {
            let mut used = self.shares[k as usize].used();
            (
                k,
                used.find_map(|(c, u)| (c as usize == i).then_some(u))
                    .unwrap_or(0.0),
            )
        })
    }

    /// Those that belong to centre `i` most.
    pub fn own(&self, i: usize) -> impl Iterator<Item = u32> {
        let all = self.of(i).map(|(k, _)| k);
        all.filter(move |&k| self.shares[k as usize].center[0] as usize == i)
    }
}

/// A reduced point, without what the caller attached.
#[derive(Debug, Clone, Copy)]
pub struct Placed {
    /// In the unit frame.
    pub position: Vec3,
    /// Unit, of arbitrary sign; zero where the members have none.
    pub normal: Vec3,
    /// √(area that it stands for).
    pub spacing: f32,
    /// Membership-weighted mean.
    pub variation: f32,
}

/// The area of surface that each centre stands for: that of the points, as they are shared.
pub fn areas(features: &Features, shares: &[Shares], centers: usize) -> Vec<f64> {
    let mut areas = vec![0.0; centers];
    for (s, &spacing) in shares.iter().zip(&features.spacing) {
        let area = f64::from(spacing).powi(2);
        for (i, u) in s.used() {
            areas[i as usize] += f64::from(u) * area;
        }
    }
    areas
}

/// Places every centre. `areas` are those that they stand for.
pub fn place(
    tree: &Octree,
    features: &Features,
    (centers, areas): (&[Vec3], &[f64]),
    members: &Members,
    (placement, fuzzifier): (Placement, Fuzzifier),
) -> Vec<Placed> {
    par::map(
        centers.len(),
        || (),
        |i, ()| {
            let mut sums = Sums::default();
            for (k, u) in members.of(i) {
                sums.add(tree, features, k as usize, u, fuzzifier);
            }
            sums.place(centers[i], areas[i].sqrt(), placement)
        },
    )
}

/// Sums over the members of one cluster, relative to its first member.
#[derive(Default)]
struct Sums {
    origin: DVec3,
    weight: f64,
    position: DVec3,
    /// Σ n nᵀ, and Σ n nᵀ x.
    normals: [f64; 6],
    planes: DVec3,
    membership: f64,
    variation: f64,
}

impl Sums {
    fn add(&mut self, tree: &Octree, features: &Features, k: usize, u: f32, fuzzifier: Fuzzifier) {
        let u = f64::from(u);
        let n = features.normals[k].as_dvec3();
        let x = features.denoised(tree, k).as_dvec3();
        if self.membership == 0.0 {
            self.origin = x;
        }
        let x = x - self.origin;
        let area = f64::from(features.spacing[k]).powi(2);
        let w = fuzzifier.raise(u) * area.max(f64::MIN_POSITIVE);
        self.weight += w;
        self.position += w * x;
        let products = crate::base::linalg::outer(n);
        for (sum, product) in self.normals.iter_mut().zip(products) {
            *sum += w * product;
        }
        self.planes += w * n.dot(x) * n;
        self.membership += u;
        self.variation += u * f64::from(features.variation[k]);
    }

    fn place(&self, center: Vec3, spacing: f64, placement: Placement) -> Placed {
        if self.weight == 0.0 {
            return Placed {
                position: center,
                normal: Vec3::ZERO,
                spacing: spacing as f32,
                variation: 0.0,
            };
        }
        let mean = self.position / self.weight;
        let tensor = self.normals.map(|t| t / self.weight);
        let eigen = sym_eigen(&tensor);
        let normal = if eigen.values[2] > 0.0 {
            eigen.vectors[2]
        } else {
            DVec3::ZERO
        };
        let position = match placement {
            Placement::Center => center.as_dvec3(),
            Placement::Mesh | Placement::Implicit | Placement::Sample => {
                let [xx, xy, xz, yy, yz, zz] = tensor;
                let a = DMat3::from_cols(
                    DVec3::new(xx + TAU, xy, xz),
                    DVec3::new(xy, yy + TAU, yz),
                    DVec3::new(xz, yz, zz + TAU),
                );
                let offset = self.planes / self.weight - (a * mean - TAU * mean);
                let step = (a.inverse() * offset).clamp_length_max(spacing);
                let crease = ((eigen.values[1] - CREASE.start) / (CREASE.end - CREASE.start))
                    .clamp(0.0, 1.0);
                let on_surface = OUTWARD * normal.dot(step) * normal;
                let part = if placement == Placement::Mesh {
                    step
                } else {
                    on_surface.lerp(step, crease)
                };
                self.origin + mean + part
            }
        };
        Placed {
            position: position.as_vec3(),
            normal: normal.as_vec3(),
            spacing: spacing as f32,
            variation: (self.variation / self.membership) as f32,
        }
    }
}

/// The input point nearest to a placed centre `i`, in the octree's order. Most often it is a member, so little is looked at.
pub fn nearest(tree: &Octree, members: &Members, i: usize, p: Vec3) -> u32 {
    let away = |(k, _): (u32, f32)| Neighbor {
        distance2: tree.points[k as usize].distance_squared(p),
        index: k,
    };
    let none = Neighbor {
        distance2: f32::INFINITY,
        index: 0,
    };
    let nearer = |a: Neighbor, b: Neighbor| if b.distance2 < a.distance2 { b } else { a };
    let member = members.of(i).map(away).fold(none, nearer);
    tree.nearer_than(member, p).index
}

/// Moves every placed point to an input point, no two to the same, and returns which (in the octree's order): the nearest
/// of those that belong to the centre most, or, for a centre to which none does, the nearest that nobody took.
pub fn snap(tree: &Octree, members: &Members, placed: &mut [Placed]) -> Vec<u32> {
    let away = |k: u32, p: Vec3| tree.points[k as usize].distance_squared(p);
    let first: Vec<Option<u32>> = (0..placed.len())
        .map(|i| {
            let p = placed[i].position;
            members
                .own(i)
                .min_by(|&a, &b| away(a, p).total_cmp(&away(b, p)).then(a.cmp(&b)))
        })
        .collect();
    let mut taken = vec![false; tree.points.len()];
    for k in first.iter().flatten() {
        taken[*k as usize] = true;
    }
    let mut found: Vec<Neighbor> = Vec::new();
    let mut free = |p: Vec3| {
        let mut k = 16;
        loop {
            tree.knn(p, k, &mut found);
            let next = found.iter().map(|n| n.index).find(|&j| !taken[j as usize]);
            if let Some(j) = next {
                taken[j as usize] = true;
                return j;
            }
            // There are no more centres than points, so a free one turns up.
            k *= 4;
        }
    };
    let chosen: Vec<u32> = first
        .into_iter()
        .zip(placed.iter())
        .map(|(k, p)| k.unwrap_or_else(|| free(p.position)))
        .collect();
    for (p, &k) in placed.iter_mut().zip(&chosen) {
        p.position = tree.points[k as usize];
    }
    chosen
}

/// The reduced cloud's colours and scalars, carried as `attributes` says, its normal signs, by the mean of the
/// input's, and its viewpoints, those of the nearest input points. `nearest` has the nearest input point of every placed one, in the octree's order.
pub fn carry(
    cloud: &Cloud,
    tree: &Octree,
    members: &Members,
    placed: &[Placed],
    nearest: &[u32],
    attributes: &BTreeMap<String, Carry>,
) -> Cloud {
    let how = |name: &str| attributes.get(name).copied().unwrap_or(Carry::Mean);
    let input = |k: u32| tree.order[k as usize] as usize;
    let mean = |i: usize, value: &dyn Fn(usize) -> f64| -> f64 {
        let (mut sum, mut total) = (0.0, 0.0);
        for (k, u) in members.of(i) {
            sum += f64::from(u) * value(input(k));
            total += f64::from(u);
        }
        if total > 0.0 { sum / total } else { 0.0 }
    };
    let each = 0..placed.len();
    let votes = |i: usize| members.of(i).map(|(k, u)| (input(k), u));
    let closest = |i: usize| input(nearest[i]);
    let colors = cloud.colors.as_ref().map(|colors| {
        let of = |i: usize| match how(COLORS) {
            Carry::Mean => [0, 1, 2].map(|c| mean(i, &|k| f64::from(colors[k][c])).round() as u8),
            Carry::Majority => majority(votes(i).map(|(k, u)| (colors[k], u)), color_key)
                .unwrap_or(colors[closest(i)]),
            Carry::Nearest => colors[closest(i)],
        };
        each.clone().map(of).collect()
    });
    let attributes = cloud.attributes.iter().map(|a| {
        let of = |i: usize| match how(&a.name) {
            Carry::Mean => mean(i, &|k| f64::from(a.values[k])) as f32,
            Carry::Majority => majority(votes(i).map(|(k, u)| (a.values[k], u)), label_key)
                .unwrap_or(a.values[closest(i)]),
            Carry::Nearest => a.values[closest(i)],
        };
        Attribute {
            name: a.name.clone(),
            values: each.clone().map(of).collect(),
        }
    });
    let signed = |i: usize| {
        let n = placed[i].normal;
        let along = |given: &Vec<Vec3>| mean(i, &|k| f64::from(given[k].dot(n)));
        if cloud.normals.as_ref().map_or(1.0, along) < 0.0 {
            -n
        } else {
            n
        }
    };
    Cloud {
        points: placed.iter().map(|p| p.position).collect(),
        frame: cloud.frame,
        colors,
        normals: Some(each.clone().map(signed).collect()),
        attributes: attributes.collect(),
        origin: cloud.origin,
        viewpoints: cloud
            .viewpoints
            .as_ref()
            .map(|v| v.select(each.clone().map(closest))),
        up: cloud.up,
        seen_from_above: cloud.seen_from_above,
        floor: cloud.floor,
        unit: cloud.unit,
        crs: cloud.crs.clone(),
        faces: cloud.faces,
    }
}

/// The value with the most votes, of equals the one with the smallest key; `None` without votes.
pub(crate) fn majority<T: Copy>(
    votes: impl Iterator<Item = (T, f32)>,
    key: fn(T) -> u32,
) -> Option<T> {
    let votes: Vec<(T, f32)> = votes.collect();
    let sorted = ranked(votes.iter().map(|&(value, _)| key(value)));
    let mut most = None;
    for same in sorted.chunk_by(|a, b| unpack(*a).0 == unpack(*b).0) {
        let vote = |packed: &u64| votes[unpack(*packed).1 as usize];
        let sum: f64 = same.iter().map(|packed| f64::from(vote(packed).1)).sum();
        if most.is_none_or(|(_, before)| sum > before) {
            most = Some((vote(&same[0]).0, sum));
        }
    }
    most.map(|(value, _)| value)
}

/// A label's [`key`]: −0 is 0.
pub(crate) fn label_key(label: f32) -> u32 {
    key(label + 0.0)
}

/// A colour's [`key`].
pub(crate) fn color_key([r, g, b]: [u8; 3]) -> u32 {
    u32::from_be_bytes([0, r, g, b])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::Rng;
    use crate::reduce::shares::SHARES;

    #[test]
    fn members_are_the_points_with_a_share() {
        let centers = 2 * BLOCK + 7;
        let mut rng = Rng::new(4);
        let mut shares = |_| {
            let first = (rng.uniform() * centers as f64) as usize;
            Shares {
                center: std::array::from_fn(|j| ((first + 700 * j) % centers) as u32),
                u: std::array::from_fn(|j| {
                    if j < SHARES - 1 {
                        0.5 - 0.1 * j as f32
                    } else {
                        0.0
                    }
                }),
            }
        };
        let shares: Vec<Shares> = (0..10_000).map(&mut shares).collect();
        let members = Members::new(&shares, centers);
        let mut of = vec![Vec::new(); centers];
        for (k, s) in shares.iter().enumerate() {
            for (i, u) in s.used() {
                of[i as usize].push((k as u32, u));
            }
        }
        for (i, of) in of.iter().enumerate() {
            assert!(members.of(i).eq(of.iter().copied()), "centre {i}");
            let own = |k: &u32| shares[*k as usize].center[0] as usize == i;
            assert!(members.own(i).eq(of.iter().map(|&(k, _)| k).filter(own)));
        }
    }
}
