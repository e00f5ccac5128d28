//! The plane of least variance around every point: unoriented normal, surface variation, spacing.
//!
//! Neighbours count by `w = (1 - d²/R²)²`, so that no single one coming or going turns a normal. Over points of even
//! density the weights add up to a third of those in the disc of radius R, which gives the spacing without counting.

use std::ops::Range;

use glam::Vec3;

use crate::base::lanes::{LANES, Lanes};
use crate::base::linalg::least_axis;
use crate::cloud::neighborhood::{Block, Neighborhood, bounds, even_reach};
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;

/// R, in distances to the k-th neighbour of a block's middle point: the weights then amount to those of 0.8 k equal ones. On
/// clean clouds of four models that the bench does not use 1.15 to 1.5 give the same surfaces; thin parts of the samples want
/// it small.
const SUPPORT: f32 = 1.2;
/// A point whose neighbours weigh less than this is in a sparser part than its block, and asks for itself. Even density gives
/// a third of the `SUPPORT²·k` neighbours.
const FEW: f32 = 2.5;
/// A cell gathers this many times as far as an even patch over its box would need. Blocks that need more gather for themselves.
const MARGIN: f32 = 1.4;
/// Share of the second moments about the point that the moments about the mean must have. At a straight border it is a fifth.
const ROUNDING: f32 = 1e-3;

/// What the neighbours of one point tell.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Plane {
    /// √(area a point); 0 where there is one point only.
    pub(crate) spacing: f32,
    /// Unit, of any sign; zero for points on a line or at one place.
    pub(crate) normal: Vec3,
    /// Least eigenvalue of the covariance over their sum.
    pub(crate) variation: f32,
}

/// Memory of one worker.
#[derive(Default)]
pub(crate) struct Planes {
    cell: Neighborhood,
    own: Neighborhood,
    found: Vec<Neighbor>,
}

impl Planes {
    /// The planes of the points `range`, which lie close together, from about `k` neighbours each.
    pub(crate) fn cell(&mut self, tree: &Octree, range: Range<usize>, k: usize) -> Vec<Plane> {
        let mut planes = Vec::with_capacity(range.len());
        let corners = bounds(&tree.points[range.clone()]);
        let reach = MARGIN * SUPPORT * even_reach(corners, range.len(), k);
        let gathered = self.cell.gather(tree, corners, reach);
        for block in Block::all(&tree.points, range) {
            let middle = tree.points[block.middle()];
            let mut radius = SUPPORT * self.cell.kth_distance(middle, k);
            let mut hood = &mut self.cell;
            let mut together = gathered && radius <= reach;
            if !together {
                tree.knn(middle, k, &mut self.found);
                radius = SUPPORT * self.found.last().map_or(0.0, |n| n.distance2).sqrt();
                hood = &mut self.own;
                together = hood.gather(tree, (block.lo, block.hi), radius);
            }
            let start = planes.len();
            if together && radius > 0.0 {
                hood.narrow(&block, radius);
                planes.extend(planes_of(&block, radius, hood));
            } else {
                planes.extend(block.range.clone().map(|_| Plane::default()));
            }
            for (i, plane) in block.range.clone().zip(&mut planes[start..]) {
                if plane.spacing == 0.0 {
                    *plane = self.alone(tree, i, k);
                }
            }
        }
        planes
    }

    /// The plane of one point from its own nearest.
    fn alone(&mut self, tree: &Octree, i: usize, k: usize) -> Plane {
        tree.knn(tree.points[i], k, &mut self.found);
        let radius = SUPPORT * self.found.last().map_or(0.0, |n| n.distance2).sqrt();
        if radius == 0.0 {
            return Plane::default();
        }
        let block = Block::new(&tree.points, i..i + 1);
        self.own.gather_at(tree, tree.points[i], radius);
        fit(moments(&block, radius, &self.own), radius)
            .next()
            .unwrap_or_default()
    }
}

/// The planes of a block; those of points with few neighbours have no spacing.
fn planes_of(block: &Block, radius: f32, hood: &Neighborhood) -> impl Iterator<Item = Plane> {
    let sums = moments(block, radius, hood);
    let weight = sums[0];
    fit(sums, radius)
        .enumerate()
        .take(block.range.len())
        .map(move |(l, plane)| {
            if weight.lane(l) - 1.0 < FEW {
                Plane::default()
            } else {
                plane
            }
        })
}

/// Σ w, Σ w d and Σ w d dᵀ for each lane, d from the point to its neighbours in units of R.
fn moments(block: &Block, radius: f32, hood: &Neighborhood) -> [Lanes; 10] {
    let scale = Lanes::splat(1.0 / radius);
    let one = Lanes::splat(1.0);
    let mut sums = [Lanes::ZERO; 10];
    for (_, at) in hood.near() {
        let [x, y, z] = [0, 1, 2].map(|axis| (at[axis] - block.at[axis]) * scale);
        let root = (one - (x * x + y * y + z * z)).max(Lanes::ZERO);
        let w = root * root;
        let (wx, wy, wz) = (w * x, w * y, w * z);
        let terms = [
            w,
            wx,
            wy,
            wz,
            wx * x,
            wx * y,
            wx * z,
            wy * y,
            wy * z,
            wz * z,
        ];
        for (sum, term) in sums.iter_mut().zip(terms) {
            *sum += term;
        }
    }
    sums
}

/// Plane and spacing of each lane.
fn fit(sums: [Lanes; 10], radius: f32) -> impl Iterator<Item = Plane> {
    let [w, x, y, z, xx, xy, xz, yy, yz, zz] = sums;
    let inverse = Lanes::splat(1.0) / w;
    let (x, y, z) = (x * inverse, y * inverse, z * inverse);
    let (xx, yy, zz) = (xx * inverse, yy * inverse, zz * inverse);
    let covariance = [
        xx - x * x,
        xy * inverse - x * y,
        xz * inverse - x * z,
        yy - y * y,
        yz * inverse - y * z,
        zz - z * z,
    ];
    // Where all neighbours are in one place far away, what is left of their moments is rounding.
    let left = covariance[0] + covariance[3] + covariance[5];
    let told = (Lanes::splat(ROUNDING) * (xx + yy + zz)).less(left, Lanes::splat(1.0), Lanes::ZERO);
    let covariance = covariance.map(|m| m * told);
    let (variation, normal) = least_axis(covariance);
    // The point itself counts: reduced points keep apart, as a lattice does, and with it the sum is the lattice's.
    let disc = Lanes::splat(std::f32::consts::PI / 3.0 * radius * radius);
    let spacing = (disc * inverse).sqrt();
    (0..LANES).map(move |l| Plane {
        spacing: spacing.lane(l),
        normal: Vec3::from_array(normal.map(|n| n.lane(l))),
        variation: variation.lane(l),
    })
}
