//! Distances from points to a mesh, and to a surface of which only points with normals are known.

use crate::error::Result;
use crate::kernel::wendland;
use crate::octree::{Neighbor, Octree};
use crate::par;
use crate::progress::{Progress, Stage};
use crate::report::DistanceStats;
use glam::{DVec3, Vec3};
use nalgebra::{Matrix6, Vector6};

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
        let mut near = [(0.0f32, 0); 8];
        let mut count = 0;
        for child in node.child_ids() {
            let (low, high) = self.boxes[child];
            let distance2 = (low - point)
                .max(point - high)
                .max(Vec3::ZERO)
                .length_squared();
            if (distance2 as f64) < best.0 {
                near[count] = (distance2, child);
                count += 1;
            }
        }
        near[..count].sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        for &(distance2, child) in &near[..count] {
            if distance2 as f64 >= best.0 {
                break;
            }
            self.closest_below(child, point, best);
        }
    }

    fn distance2(&self, point: Vec3, triangle: u32) -> f64 {
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

/// Distances of `points` to a mesh (all in the unit frame); zeros where there is no triangle. Fastest where points that
/// follow each other are near each other, as in an octree's order.
///
/// # Errors
/// [`crate::Error::Cancelled`] if `progress` asks for it.
pub fn mesh_distance(
    points: &[Vec3],
    vertices: &[Vec3],
    triangles: &[[u32; 3]],
    progress: &mut dyn Progress,
) -> Result<DistanceStats> {
    if triangles.is_empty() {
        return Ok(DistanceStats::default());
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
            distance2.sqrt()
        },
    )
}

/// Reduced points around a query that make up its local surface.
const NEIGHBORS: usize = 8;
/// Faces or sheets among them that are tried: at a corner three meet.
const FACES: usize = 3;
/// Neighbours whose normals differ by more (cosine of 60°) belong to another face.
const FACE_COSINE: f64 = 0.5;
/// Neighbours that stand out by more belong to another sheet: the offset along the mean of both normals over the
/// distance, which on one curved sheet is of second order in the distance.
const SHEET_SINE: f64 = 0.2;
/// Ridge on the quadric's second derivatives, relative to the weight of the data: a plane where the data leave them
/// open, unnoticeable elsewhere.
const RIDGE: f64 = 1e-6;

/// Distances of `points` to the surface that reduced points stand for (all in the unit frame).
///
/// Of the 8 nearest reduced points those on the nearest one's face and sheet give a quadric height field over their
/// mean tangent plane, fitted to their positions and normals by least squares with Wendland weights that vanish at 1.1
/// times the distance of the eighth. The distance is to that quadric's tangent plane over `x`, at most the distance to
/// the nearest reduced point. Points that are left are tried as further faces, and the nearest face counts. So points
/// of a curved surface have a distance of fourth order in the spacing, where to tangent planes it is second.
///
/// `reduced` is the tree of the reduced points, `normals` theirs, unit and of any sign, in the order from which the
/// tree was built.
///
/// # Errors
/// [`crate::Error::Cancelled`] if `progress` asks for it.
pub fn cloud_distance(
    points: &[Vec3],
    reduced: &Octree,
    normals: &[Vec3],
    progress: &mut dyn Progress,
) -> Result<DistanceStats> {
    by_task(
        points,
        2.0,
        progress,
        || (Vec::new(), Vec::new()),
        |x, (found, around)| {
            reduced.knn(x, NEIGHBORS, found);
            around.clear();
            around.extend(found.iter().map(|n: &Neighbor| {
                let normal = normals[reduced.order[n.index as usize] as usize];
                (
                    (reduced.points[n.index as usize] - x).as_dvec3(),
                    normal.as_dvec3(),
                )
            }));
            surface_distance(around)
        },
    )
}

/// The distance from the origin to the surface of these points with normals, nearest first; empties them.
fn surface_distance(around: &mut Vec<(DVec3, DVec3)>) -> f64 {
    let (Some(first), Some(last)) = (around.first(), around.last()) else {
        return 0.0;
    };
    let radius = 1.1 * last.0.length();
    let mut least = first.0.length();
    for _ in 0..FACES {
        let Some(&(p, n)) = around.first() else { break };
        if least == 0.0 {
            break;
        }
        let mut face = [(DVec3::ZERO, DVec3::ZERO); NEIGHBORS];
        let mut count = 0;
        around.retain(|&(q, m)| {
            let agreement = m.dot(n);
            let mean = (n + m * agreement.signum()) / 2.0;
            let on_face = agreement.abs() >= FACE_COSINE
                && mean.dot(q - p).abs() <= SHEET_SINE * q.distance(p);
            if on_face || count == 0 {
                face[count] = (q, m * agreement.signum());
                count += 1;
                return false;
            }
            true
        });
        least = least.min(quadric_distance(&face[..count], radius));
    }
    least
}

/// The distance from the origin to the tangent plane over it of the quadric through these points with normals.
fn quadric_distance(face: &[(DVec3, DVec3)], radius: f64) -> f64 {
    let weight = |q: DVec3| wendland(q.length() / radius).0;
    let mean: DVec3 = face.iter().map(|&(q, m)| m * weight(q)).sum();
    let up = mean.normalize_or(face[0].1);
    let (u, v) = up.any_orthonormal_pair();
    // Height a + b u + c v + d u²/2 + e u v + f v²/2 in units of the radius; rows for the height and both slopes.
    let mut matrix = Matrix6::zeros();
    let mut right = Vector6::zeros();
    let mut total = 0.0;
    for &(q, m) in face {
        let (x, y, z) = (u.dot(q) / radius, v.dot(q) / radius, up.dot(q) / radius);
        let steep = m.dot(up).max(FACE_COSINE);
        let rows = [
            (Vector6::new(1.0, x, y, x * x / 2.0, x * y, y * y / 2.0), z),
            (Vector6::new(0.0, 1.0, 0.0, x, y, 0.0), -m.dot(u) / steep),
            (Vector6::new(0.0, 0.0, 1.0, 0.0, x, y), -m.dot(v) / steep),
        ];
        total += weight(q);
        for (row, value) in rows {
            matrix += row * row.transpose() * weight(q);
            right += row * (value * weight(q));
        }
    }
    for k in 3..6 {
        matrix[(k, k)] += RIDGE * total;
    }
    let Some(cholesky) = matrix.cholesky() else {
        return f64::INFINITY;
    };
    let height = cholesky.solve(&right);
    radius * height[0].abs() / (1.0 + height[1] * height[1] + height[2] * height[2]).sqrt()
}

/// Statistics of `distance` over the points, in parallel; `weight` is about how many microseconds a point takes.
fn by_task<S>(
    points: &[Vec3],
    weight: f32,
    progress: &mut dyn Progress,
    scratch: impl Fn() -> S + Sync + Send,
    distance: impl Fn(Vec3, &mut S) -> f64 + Sync + Send,
) -> Result<DistanceStats> {
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
                .collect::<Vec<f64>>()
        },
    )?;
    Ok(DistanceStats::of(distances.into_iter().flatten()))
}
