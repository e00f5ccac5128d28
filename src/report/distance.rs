//! Distances from points to a mesh.

use crate::base::error::Result;
use crate::base::par;
use crate::base::progress::{Progress, Stage};
use crate::base::sort_keys::{key, of_key, pack, unpack};
use crate::cloud::octree::Octree;
use crate::report::DistanceStats;
use glam::{DVec3, Vec3};

/// Points that one index of a parallel map takes.
const POINTS_PER_TASK: usize = 256;

/// Triangles in a tree for closest-point queries.
pub struct TriangleTree<'a> {
    vertices: &'a [Vec3],
    triangles: &'a [[u32; 3]],
    /// Over the triangles' centroids.
    centroids: Octree,
    /// Boxes of the triangles below each node.
    boxes: Vec<(Vec3, Vec3)>,
}

impl<'a> TriangleTree<'a> {
    /// At least one triangle. Cost: n log n, 80 bytes a triangle.
    pub fn new(vertices: &'a [Vec3], triangles: &'a [[u32; 3]]) -> TriangleTree<'a> {
        let corners = |t: u32| triangles[t as usize].map(|v| vertices[v as usize]);
        let centroid = |t: u32| corners(t).into_iter().sum::<Vec3>() / 3.0;
        let centroids: Vec<Vec3> = (0..triangles.len() as u32).map(centroid).collect();
        let centroids = Octree::build(&centroids);
        let mut boxes = vec![(Vec3::INFINITY, Vec3::NEG_INFINITY); centroids.nodes.len()];
        // Children come after their parents.
        for (id, node) in centroids.nodes.iter().enumerate().rev() {
            let (mut low, mut high) = boxes[id];
            if node.is_leaf() {
                for corner in centroids.order[node.range()]
                    .iter()
                    .flat_map(|&t| corners(t))
                {
                    (low, high) = (low.min(corner), high.max(corner));
                }
            }
            for (child_low, child_high) in node.child_ids().map(|child| boxes[child]) {
                (low, high) = (low.min(child_low), high.max(child_high));
            }
            boxes[id] = (low, high);
        }
        TriangleTree {
            vertices,
            triangles,
            centroids,
            boxes,
        }
    }

    /// The squared distance (unit frame) of `point` to the nearest triangle, and that triangle. `hint` is a triangle
    /// that may be near, such as the last answer; it saves time and changes nothing but which of equally near ones is
    /// found.
    pub fn closest(&self, point: Vec3, hint: u32) -> (f64, u32) {
        let mut best = (self.distance2(point, hint), hint);
        self.closest_below(0, point, &mut best);
        best
    }

    fn closest_below(&self, id: usize, point: Vec3, best: &mut (f64, u32)) {
        let node = &self.centroids.nodes[id];
        if node.is_leaf() {
            for &triangle in &self.centroids.order[node.range()] {
                let distance2 = self.distance2(point, triangle);
                if distance2 < best.0 {
                    *best = (distance2, triangle);
                }
            }
            return;
        }
        let mut near = [0; 8];
        let mut count = 0;
        for child in node.child_ids() {
            let (low, high) = self.boxes[child];
            let distance2 = (low - point)
                .max(point - high)
                .max(Vec3::ZERO)
                .length_squared();
            if (distance2 as f64) < best.0 {
                near[count] = pack(key(distance2), child as u32);
                count += 1;
            }
        }
        near[..count].sort_unstable();
        for (distance2, child) in near[..count].iter().map(|&n| unpack(n)) {
            if f64::from(of_key(distance2)) >= best.0 {
                break;
            }
            self.closest_below(child as usize, point, best);
        }
    }

    /// The triangles within `reach` of `point`, and how far they are; `out` is cleared.
    pub(crate) fn within(&self, point: Vec3, reach: f64, out: &mut Vec<(f64, u32)>) {
        out.clear();
        let enter = |id: usize| {
            let (low, high) = self.boxes[id];
            let off = (low - point).max(point - high).max(Vec3::ZERO);
            f64::from(off.length_squared()) <= reach * reach
        };
        self.centroids.visit(
            |id, _| enter(id),
            |at| {
                let triangle = self.centroids.order[at];
                let distance2 = self.distance2(point, triangle);
                if distance2 <= reach * reach {
                    out.push((distance2.sqrt(), triangle));
                }
            },
        );
    }

    pub(crate) fn distance2(&self, point: Vec3, triangle: u32) -> f64 {
        let [a, b, c] =
            self.triangles[triangle as usize].map(|v| self.vertices[v as usize].as_dvec3());
        let point = point.as_dvec3();
        point.distance_squared(closest_on_triangle(point, [a, b, c]))
    }
}

/// The point of a triangle nearest to `p`, by the region of its plane that `p` lies over (C. Ericson, *Real-Time
/// Collision Detection*, 2005, section 5.1.5).
pub fn closest_on_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (ab.dot(p - a), ac.dot(p - a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let (d3, d4) = (ab.dot(p - b), ac.dot(p - b));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let (d5, d6) = (ab.dot(p - c), ac.dot(p - c));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    a + (ab * vb + ac * vc) / (va + vb + vc)
}

/// How far a point is from a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Apart {
    /// Distance to the nearest triangle.
    pub distance: f64,
    /// That triangle.
    pub triangle: u32,
}

/// Distances of `points` to a mesh (all in the unit frame); none where there is no triangle. Fastest where points that
/// follow each other are near each other, as in an octree's order.
///
/// # Errors
/// [`crate::Error::Cancelled`] if `progress` asks for it.
pub fn mesh_distances(
    points: &[Vec3],
    vertices: &[Vec3],
    triangles: &[[u32; 3]],
    progress: &mut dyn Progress,
) -> Result<Vec<Apart>> {
    if triangles.is_empty() {
        return Ok(Vec::new());
    }
    let tree = TriangleTree::new(vertices, triangles);
    by_task(
        points,
        1.0,
        progress,
        || 0,
        |point, hint| {
            let (distance2, triangle) = tree.closest(point, *hint);
            *hint = triangle;
            Apart {
                distance: distance2.sqrt(),
                triangle,
            }
        },
    )
}

/// Statistics of [`mesh_distances`]; zeros where there is no triangle.
///
/// # Errors
/// The same.
pub fn mesh_distance(
    points: &[Vec3],
    vertices: &[Vec3],
    triangles: &[[u32; 3]],
    progress: &mut dyn Progress,
) -> Result<DistanceStats> {
    let apart = mesh_distances(points, vertices, triangles, progress)?;
    Ok(DistanceStats::of(apart.iter().map(|a| a.distance)))
}

/// At every vertex, the mean distance of the points whose nearest triangle has it as a corner; NaN where there is none.
pub fn vertex_distances(apart: &[Apart], triangles: &[[u32; 3]], vertices: usize) -> Vec<f32> {
    let mut sums = vec![(0.0, 0u32); vertices];
    for Apart { distance, triangle } in apart {
        for corner in triangles[*triangle as usize] {
            let (sum, count) = &mut sums[corner as usize];
            *sum += distance;
            *count += 1;
        }
    }
    sums.into_iter()
        .map(|(sum, count)| (sum / f64::from(count)) as f32)
        .collect()
}

/// `distance` of every point, in parallel; `weight` is about how many microseconds a point takes.
fn by_task<S, T: Send>(
    points: &[Vec3],
    weight: f32,
    progress: &mut dyn Progress,
    scratch: impl Fn() -> S + Sync + Send,
    distance: impl Fn(Vec3, &mut S) -> T + Sync + Send,
) -> Result<Vec<T>> {
    let tasks: Vec<&[Vec3]> = points.chunks(POINTS_PER_TASK).collect();
    let weight = weight * POINTS_PER_TASK as f32;
    let distances = par::map_progress(
        tasks.len(),
        weight,
        (Stage::Report, progress),
        scratch,
        |k, scratch| {
            tasks[k]
                .iter()
                .map(|&point| distance(point, scratch))
                .collect::<Vec<T>>()
        },
    )?;
    Ok(distances.into_iter().flatten().collect())
}
