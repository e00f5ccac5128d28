//! What the sections measure of a surface.

use crate::clouds::Scan;
use glam::{DVec3, Vec3};
use pointweave::base::params::Target;
use pointweave::base::progress::Silent;
use pointweave::cloud::octree::Octree;
use pointweave::cloud::queries::Neighbor;
use pointweave::report::distance::TriangleTree;
use pointweave::report::{DistanceStats, volume};
use pointweave::{Cloud, ReduceParams, Result, Stage, Surface, SurfaceParams, reconstruct};
use std::f64::consts::PI;

/// What marks a promise that is not kept.
pub const MISS: &str = " <--";

pub fn mark(is_missed: bool) -> &'static str {
    if is_missed { MISS } else { "" }
}

/// Codes of what the report doubts, one after the other.
pub fn doubts(s: &Surface) -> String {
    let codes = s.report.reduce.doubts.iter().map(|d| d.code);
    codes.collect::<Vec<_>>().join(",")
}

pub fn surface(points: &[DVec3], params: &SurfaceParams) -> Result<Surface> {
    let positions: Vec<f64> = points.iter().flat_map(|p| p.to_array()).collect();
    reconstruct(&Cloud::from_f64(&positions)?, params, &mut Silent)
}

/// One in `kept` points goes to the fit.
pub fn reduced_to(kept: usize) -> SurfaceParams {
    let reduce = (kept > 1).then(|| ReduceParams {
        target: Target::Ratio(1.0 / kept as f64),
        ..Default::default()
    });
    SurfaceParams {
        reduce,
        ..Default::default()
    }
}

/// Share of the fitted points whose normal looks to the side that the nearest input point's true normal looks to. An open
/// sheet has no outside: there the larger share counts, of those that look either way.
pub fn oriented_right(scan: &Scan, s: &Surface) -> f64 {
    let reduced = &s.cloud.reduced;
    let normals = reduced.cloud.normals.as_deref().unwrap_or_default();
    let right = normals
        .iter()
        .zip(&reduced.nearest)
        .filter(|&(n, &i)| n.as_dvec3().dot(scan.normals[i as usize]) > 0.0)
        .count();
    let share = right as f64 / normals.len().max(1) as f64;
    if scan.truth.is_closed() {
        share
    } else {
        share.max(1.0 - share)
    }
}

pub fn signed_volume(s: &Surface) -> f64 {
    volume(&s.mesh.vertices, &s.mesh.triangles)
}

/// Milliseconds of a stage.
pub fn stage_ms(s: &Surface, stage: Stage) -> f64 {
    let times = s.report.reduce.ms.iter();
    times.filter(|t| t.0 == stage).map(|t| t.1).sum()
}

/// Points in the surface's unit frame with the distance of neighbours around each.
pub struct Spaced {
    pub tree: Octree,
    /// In the tree's order.
    spacing: Vec<f32>,
}

impl Spaced {
    /// √(area a point), from how far the eighth neighbour is; the median around each point, as ends have half as many.
    pub fn new(points: &[Vec3]) -> Spaced {
        const K: usize = 8;
        let tree = Octree::build(points);
        let mut found: Vec<Neighbor> = Vec::new();
        let mut around = |p: Vec3, k: usize| {
            tree.knn(p, k + 1, &mut found);
            found.clone()
        };
        let raw: Vec<f32> = tree
            .points
            .iter()
            .map(|&p| {
                let last = around(p, K).last().map_or(0.0, |n| n.distance2);
                (f64::from(last) * PI / K as f64).sqrt() as f32
            })
            .collect();
        let median = |&p: &Vec3| {
            let mut near: Vec<f32> = around(p, 24)
                .iter()
                .map(|n| raw[n.index as usize])
                .collect();
            near.sort_unstable_by(f32::total_cmp);
            near[near.len() / 2]
        };
        let spacing = tree.points.iter().map(median).collect();
        Spaced { tree, spacing }
    }

    /// The spacing at the point nearest to `p`.
    pub fn spacing_at(&self, p: Vec3) -> f64 {
        f64::from(self.spacing[self.tree.nearest(p).index as usize])
    }

    /// Distance of `p` to the nearest point, in spacings there.
    pub fn away(&self, p: Vec3) -> f64 {
        let nearest = self.tree.nearest(p);
        f64::from(nearest.distance2.sqrt() / self.spacing[nearest.index as usize])
    }
}

/// Distances of the mesh to the truth, by area (at the triangles' centroids), and of the truth to the mesh; both as fractions of the
/// diagonal.
/// The last is what 99 % of the mesh's area and of the truth are within of each other.
pub fn two_sided(scan: &Scan, s: &Surface) -> (DistanceStats, DistanceStats, f64) {
    let frame = &s.cloud.reduced.cloud.frame;
    let mesh = &s.mesh;
    let (mut weights, mut sum, mut squares, mut max) = (0.0, 0.0, 0.0, 0.0f64);
    let mut each = Vec::new();
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|v| mesh.vertices[v as usize]);
        let area = f64::from((b - a).cross(c - a).length());
        let centroid = DVec3::from_array(frame.to_caller((a + b + c) / 3.0));
        let d = scan.truth.distance(centroid) / frame.diagonal;
        weights += area;
        sum += area * d;
        squares += area * d * d;
        max = max.max(d);
        each.push((d, area));
    }
    let to_truth = DistanceStats {
        mean: sum / weights,
        rms: (squares / weights).sqrt(),
        max,
    };
    if mesh.triangles.is_empty() {
        return (to_truth, DistanceStats::default(), 0.0);
    }
    let tree = TriangleTree::new(&mesh.vertices, &mesh.triangles);
    let (truth, _) = scan.truth.sample(10_000, 99);
    let mut hint = 0;
    let from = truth.iter().map(|p| {
        let (distance2, triangle) = tree.closest(frame.to_unit(p.to_array()), hint);
        hint = triangle;
        distance2.sqrt()
    });
    let mut from: Vec<f64> = from.collect();
    let from_truth = DistanceStats::of(from.iter().copied());
    from.sort_unstable_by(f64::total_cmp);
    each.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut before = 0.0;
    let within = each.iter().find(|(_, area)| {
        before += area;
        before >= 0.99 * weights
    });
    let within = within.map_or(0.0, |(d, _)| *d);
    (
        to_truth,
        from_truth,
        within.max(from[from.len() * 99 / 100]),
    )
}

/// Shares of the triangles whose least angle is under each of `degrees`.
pub fn thin_shares<const N: usize>(s: &Surface, degrees: [f64; N]) -> [f64; N] {
    let mut counts = [0usize; N];
    for t in &s.mesh.triangles {
        let [a, b, c] = t.map(|v| s.mesh.vertices[v as usize].as_dvec3());
        let least = [(a, b, c), (b, c, a), (c, a, b)]
            .map(|(p, q, r)| (q - p).angle_between(r - p).to_degrees())
            .into_iter()
            .fold(180.0, f64::min);
        for (count, limit) in counts.iter_mut().zip(degrees) {
            *count += usize::from(least < limit);
        }
    }
    counts.map(|c| c as f64 / s.mesh.triangles.len().max(1) as f64)
}
