//! What of a scan is registered: points some way apart, each with a normal of the surface around it.

use crate::base::linalg::{Spread, outer, sym_eigen};
use crate::base::par;
use crate::base::sort_keys::sort_pairs;
use crate::cloud::in_frame;
use crate::cloud::morton::interleave;
use crate::cloud::octree::Octree;
use crate::features::noise::Scales;
use glam::{DVec3, Vec3};
use std::f32::consts::PI;

/// Points of a scan that are looked at, at most.
const MOST: usize = 250_000;
/// Radius of the neighbourhood that gives a normal, in cells.
const AROUND: f32 = 1.5;
/// Points that a normal needs.
const ENOUGH: usize = 6;
/// A plane's least variance is at most this share of the next: else it is no surface.
const FLAT: f64 = 0.5;
/// Radius in which a point has neighbours all around, in cells, and the widest gap between two of these.
const RIM: f32 = 2.5;
const GAP: f32 = 100.0 / 180.0 * PI;

/// The length of cells from which the search for another starts, its steps, and the least one that keys have room for.
const START: f32 = 1.0 / 64.0;
const STEPS: usize = 3;
const SMALLEST: f32 = 1e-5;

/// The points of one scan.
#[derive(Debug)]
pub(crate) struct Scan {
    tree: Octree,
    /// The caller's index of each point of the tree.
    callers: Vec<u32>,
    /// Standard deviation of the points across the surface.
    pub(crate) noise: f32,
}

/// Some of them, in the order of their octree.
#[derive(Debug)]
pub(crate) struct Samples {
    /// Length of the cells, each of which gave one.
    pub(crate) cell: f32,
    pub(crate) tree: Octree,
    /// Unit, of unknown sign.
    pub(crate) normals: Vec<Vec3>,
    /// Whether the scan ends here.
    pub(crate) rim: Vec<bool>,
    /// The caller's index of each.
    pub(crate) callers: Vec<u32>,
}

impl Scan {
    /// From points within ±0.5; those beyond, which are far from all others, are left out.
    pub(crate) fn of(points: &[Vec3]) -> Scan {
        let count = points.len().min(MOST);
        let place = |k: usize| (k as u64 * points.len() as u64 / count as u64) as u32;
        let chosen = (0..count).map(place);
        let chosen: Vec<u32> = chosen.filter(|&i| in_frame(points[i as usize])).collect();
        let points: Vec<Vec3> = chosen.iter().map(|&i| points[i as usize]).collect();
        let tree = Octree::build(&points);
        let callers = tree.order.iter().map(|&k| chosen[k as usize]).collect();
        Scan {
            noise: Scales::measure(&tree).noise,
            tree,
            callers,
        }
    }

    /// How many points there are.
    pub(crate) fn len(&self) -> usize {
        self.callers.len()
    }

    /// The length of cells of which so many have a point.
    pub(crate) fn cell_for(&self, count: usize) -> f32 {
        let mut cell = START;
        // Cells on a surface are as many as its area over theirs.
        for _ in 0..STEPS {
            let keyed = self.keyed(cell);
            let found = keyed.chunk_by(|a, b| a.0 == b.0).count();
            cell *= (found as f32 / count as f32).sqrt();
        }
        cell.max(SMALLEST)
    }

    /// Points by the cell in which they lie.
    fn keyed(&self, cell: f32) -> Vec<(u64, u32)> {
        let key = |p: &Vec3| interleave(p.to_array().map(|x| ((x + 1.0) / cell) as u64));
        let mut keyed: Vec<(u64, u32)> = self.tree.points.iter().map(key).zip(0..).collect();
        sort_pairs(&mut keyed);
        keyed
    }

    /// Of each cell the point that is nearest to the mean of its points, where it lies on a surface.
    pub(crate) fn samples(&self, cell: f32) -> Samples {
        let keyed = self.keyed(cell);
        let nearest = |points: &[(u64, u32)]| {
            let at = |&(_, i): &(u64, u32)| self.tree.points[i as usize];
            let mean = points.iter().map(at).sum::<Vec3>() / points.len() as f32;
            let far = |a: &&(u64, u32)| at(a).distance_squared(mean);
            let least = points.iter().min_by(|a, b| far(a).total_cmp(&far(b)));
            least.map_or(0, |&(_, i)| i as usize)
        };
        let chosen: Vec<usize> = keyed.chunk_by(|a, b| a.0 == b.0).map(nearest).collect();
        let normal = |k: usize, _: &mut ()| self.normal(self.tree.points[chosen[k]], AROUND * cell);
        let normals = par::map(chosen.len(), || (), normal);
        let on_surface: Vec<(usize, Vec3)> = chosen
            .into_iter()
            .zip(normals)
            .filter_map(|(i, normal)| Some((i, normal?)))
            .collect();
        let points: Vec<Vec3> = on_surface
            .iter()
            .map(|&(i, _)| self.tree.points[i])
            .collect();
        let tree = Octree::build(&points);
        let of = || tree.order.iter().map(|&k| on_surface[k as usize]);
        let normals: Vec<Vec3> = of().map(|(_, normal)| normal).collect();
        let callers = of().map(|(i, _)| self.callers[i]).collect();
        let is_rim = |k: usize, _: &mut ()| is_rim(&tree, k, normals[k], RIM * cell);
        Samples {
            cell,
            rim: par::map(tree.points.len(), || (), is_rim),
            callers,
            normals,
            tree,
        }
    }

    /// Of the plane through the points around a place.
    fn normal(&self, at: Vec3, radius: f32) -> Option<Vec3> {
        let mut around = Vec::new();
        within(&self.tree, at, radius, |i| {
            around.push(self.tree.points[i].as_dvec3())
        });
        if around.len() < ENOUGH {
            return None;
        }
        let mean = around.iter().sum::<DVec3>() / around.len() as f64;
        let mut squares = [0.0; 6];
        for p in &around {
            for (sum, product) in squares.iter_mut().zip(outer(*p - mean)) {
                *sum += product;
            }
        }
        let eigen = sym_eigen(&squares);
        (eigen.values[0] < FLAT * eigen.values[1]).then(|| eigen.vectors[0].as_vec3())
    }
}

impl Samples {
    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.normals.len()
    }

    /// A ball that has most of them.
    pub(crate) fn ball(&self) -> (DVec3, f64) {
        let points = self.tree.points.iter().map(|p| p.as_dvec3());
        let spread = Spread::of(points);
        let square: f64 = spread.variances().iter().sum();
        (spread.mean, (5.0 / 3.0 * square).sqrt())
    }
}

/// Every point within a radius of a place.
pub(crate) fn within(tree: &Octree, at: Vec3, radius: f32, mut visit: impl FnMut(usize)) {
    let square = radius * radius;
    let near = |p: Vec3| p.distance_squared(at) <= square;
    tree.visit(
        |_, node| node.distance2(at) <= square,
        |i| {
            if near(tree.points[i]) {
                visit(i);
            }
        },
    );
}

/// Whether the neighbours of a point leave a wide gap around it.
fn is_rim(tree: &Octree, k: usize, normal: Vec3, radius: f32) -> bool {
    let at = tree.points[k];
    let u = normal.any_orthonormal_vector();
    let v = normal.cross(u);
    let mut turns: Vec<f32> = Vec::new();
    within(tree, at, radius, |i| {
        let d = tree.points[i] - at;
        if i != k {
            turns.push(libm::atan2f(d.dot(v), d.dot(u)));
        }
    });
    turns.sort_unstable_by(f32::total_cmp);
    let around = turns.first().map(|first| first + 2.0 * PI);
    let next = turns.iter().skip(1).copied().chain(around);
    turns.len() < 3 || turns.iter().zip(next).any(|(a, b)| b - a > GAP)
}
