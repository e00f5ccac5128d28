//! Distances to a surface of which only points with normals are known: the reduced cloud's.
//!
//! Around a query the reduced points on the face and sheet of the nearest one give a quadric height field over their mean
//! tangent plane, fitted to their positions and normals by least squares with Wendland weights. The distance is to that
//! quadric's tangent plane over the query, at most the distance to the nearest reduced point. Points that are left are
//! tried as further faces, and the nearest face counts. So points of a curved surface have a distance of fourth order in
//! the spacing, where to tangent planes it is second.
//!
//! Eight queries are answered at once, a lane each.

use glam::Vec3;

use crate::error::Result;
use crate::lanes::{LANES, Lanes};
use crate::neighborhood::{Block, CELL, Neighborhood, bounds};
use crate::octree::{Neighbor, Octree};
use crate::par;
use crate::progress::{Progress, Stage};
use crate::report::DistanceStats;

/// Reduced points around a query that make up its local surface, about.
const NEIGHBORS: usize = 8;
/// Radius of the weights, in distances to the eighth reduced point: weights vanish at their rim.
const SUPPORT: f32 = 1.2;
/// A query with fewer reduced points within its block's radius is in a sparser part, and asks for itself.
const FEW: f32 = 5.0;
/// Faces or sheets that are tried: at a corner three meet.
const FACES: usize = 3;
/// Neighbours whose normals differ by more (cosine of 60°) belong to another face.
const FACE_COSINE: f32 = 0.5;
/// Neighbours that stand out by more belong to another sheet: the offset along the mean of both normals over the
/// distance, which on one curved sheet is of second order in the distance.
const SHEET_SINE: f32 = 0.2;
/// Ridge on the quadric's second derivatives, relative to the weight of the data: a plane where the data leave them
/// open, unnoticeable elsewhere.
const RIDGE: f32 = 1e-5;
/// Weight below which members say nothing of their face: products of weights would leave the range of single precision.
const LIGHT: f32 = 1e-6;
/// Coefficients of a quadric.
const QUADRIC: usize = 6;

/// Distances of `points` (all in the unit frame), best in an octree's order, to the surface that reduced points stand for.
///
/// `reduced` is their tree, `normals` theirs, unit and of any sign, in the order from which the tree was built.
///
/// # Errors
/// [`crate::Error::Cancelled`] if `progress` asks for it.
pub fn cloud_distance(
    points: &[Vec3],
    reduced: &Octree,
    normals: &[Vec3],
    progress: &mut dyn Progress,
) -> Result<DistanceStats> {
    let distances = cloud_distances(points, reduced, normals, progress)?;
    Ok(DistanceStats::of(distances.into_iter().map(f64::from)))
}

/// The distance of every point, as [`cloud_distance`].
///
/// # Errors
/// The same.
pub fn cloud_distances(
    points: &[Vec3],
    reduced: &Octree,
    normals: &[Vec3],
    progress: &mut dyn Progress,
) -> Result<Vec<f32>> {
    let normals: Vec<Vec3> = reduced.order.iter().map(|&i| normals[i as usize]).collect();
    let surface = Surface {
        points,
        reduced,
        normals: &normals,
    };
    let distances = par::map_progress(
        points.len().div_ceil(CELL),
        50.0,
        (Stage::Report, progress),
        Scratch::default,
        |i, scratch| surface.cell(i * CELL..((i + 1) * CELL).min(points.len()), scratch),
    )?;
    Ok(distances.concat())
}

/// Queries, and the points with normals that they ask for.
struct Surface<'a> {
    points: &'a [Vec3],
    reduced: &'a Octree,
    /// In the tree's order.
    normals: &'a [Vec3],
}

/// Memory of one worker.
#[derive(Default)]
struct Scratch {
    cell: Neighborhood,
    own: Neighborhood,
    found: Vec<Neighbor>,
    around: Vec<Member>,
}

/// A reduced point as each lane's query sees it.
#[derive(Clone, Copy)]
struct Member {
    /// From the query, in radii.
    at: [Lanes; 3],
    length2: Lanes,
    normal: [Lanes; 3],
    /// Wendland weight; 0 once it has been on a face.
    weight: Lanes,
    /// Weight on the face at hand, with the sign that turns the normal to the face's side.
    signed: Lanes,
}

fn dot(a: [Lanes; 3], b: [Lanes; 3]) -> Lanes {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Surface<'_> {
    fn cell(&self, range: std::ops::Range<usize>, scratch: &mut Scratch) -> Vec<f32> {
        let mut distances = Vec::with_capacity(range.len());
        let corners = bounds(&self.points[range.clone()]);
        let middle = self.points[range.start + range.len() / 2];
        self.reduced.knn(middle, NEIGHBORS, &mut scratch.found);
        // Twice the radius at the middle: what needs more asks for itself.
        let reach = 2.0 * SUPPORT * farthest(&scratch.found);
        let gathered = scratch.cell.gather(self.reduced, corners, reach);
        for block in Block::all(self.points, range) {
            let middle = self.points[block.middle()];
            let radius = SUPPORT * scratch.cell.kth_distance(middle, NEIGHBORS);
            let together = gathered && radius > 0.0 && radius <= reach;
            let start = distances.len();
            if together {
                scratch.cell.narrow(&block, radius);
                let found = self.block(&block, radius, &scratch.cell, &mut scratch.around);
                distances.extend_from_slice(&found[..block.range.len()]);
            } else {
                distances.extend(block.range.clone().map(|_| f32::INFINITY));
            }
            for (i, distance) in block.range.clone().zip(&mut distances[start..]) {
                if *distance == f32::INFINITY {
                    *distance = self.alone(i, scratch);
                }
            }
        }
        distances
    }

    /// The distance of one query from its own nearest.
    fn alone(&self, i: usize, scratch: &mut Scratch) -> f32 {
        let query = self.points[i];
        self.reduced.knn(query, NEIGHBORS, &mut scratch.found);
        let radius = SUPPORT * farthest(&scratch.found);
        if radius == 0.0 {
            return 0.0;
        }
        scratch.own.gather_at(self.reduced, query, radius);
        let block = Block::new(self.points, i..i + 1);
        let [distance, ..] = self.block(&block, radius, &scratch.own, &mut scratch.around);
        // With fewer reduced points than asked for, the nearest one is all that is known.
        distance.min(scratch.found[0].distance2.sqrt())
    }

    /// The distances of a block; infinite where too few reduced points are within `radius`.
    fn block(
        &self,
        block: &Block,
        radius: f32,
        hood: &Neighborhood,
        around: &mut Vec<Member>,
    ) -> [f32; LANES] {
        let one = Lanes::splat(1.0);
        let scale = Lanes::splat(1.0 / radius);
        let (mut inside, mut least) = (Lanes::ZERO, Lanes::splat(f32::INFINITY));
        around.clear();
        around.extend(hood.near().map(|(j, at)| {
            let at = [0, 1, 2].map(|axis| (at[axis] - block.at[axis]) * scale);
            let length2 = dot(at, at);
            least = least.min(length2);
            inside += length2.less(one, one, Lanes::ZERO);
            Member {
                at,
                length2,
                normal: self.normals[j].to_array().map(Lanes::splat),
                weight: wendland(length2),
                signed: Lanes::ZERO,
            }
        }));
        let mut least = least.sqrt();
        for _ in 0..FACES {
            let Some(height) = face(around) else { break };
            least = least.min(height);
        }
        let enough = Lanes::splat(FEW.min(self.reduced.points.len() as f32));
        let least = least * Lanes::splat(radius);
        inside.less(enough, Lanes::splat(f32::INFINITY), least).0
    }
}

fn farthest(found: &[Neighbor]) -> f32 {
    found.last().map_or(0.0, |n| n.distance2.sqrt())
}

/// Wendland's C² function (1 - t)⁴ (4t + 1), as [`crate::kernel::wendland`], of t².
fn wendland(square: Lanes) -> Lanes {
    let t = square.sqrt();
    let rest = (Lanes::splat(1.0) - t).max(Lanes::ZERO);
    let rest2 = rest * rest;
    rest2 * rest2 * (Lanes::splat(4.0) * t + Lanes::splat(1.0))
}

/// Takes the face of the nearest member that is left, and returns the distance to it, in radii; `None` if nothing is left
/// for any lane.
fn face(around: &mut [Member]) -> Option<Lanes> {
    let mut nearest = Lanes::splat(f32::INFINITY);
    let (mut at, mut normal) = ([Lanes::ZERO; 3], [Lanes::ZERO; 3]);
    for member in around.iter() {
        // Those that are left have a weight.
        let length2 = Lanes::ZERO.less(member.weight, member.length2, Lanes::splat(f32::INFINITY));
        at = [0, 1, 2].map(|a| length2.less(nearest, member.at[a], at[a]));
        normal = [0, 1, 2].map(|a| length2.less(nearest, member.normal[a], normal[a]));
        nearest = nearest.min(length2);
    }
    if nearest.0.iter().all(|d| *d == f32::INFINITY) {
        return None;
    }
    let mut up = [Lanes::ZERO; 3];
    let mut total = Lanes::ZERO;
    for member in around.iter_mut() {
        let agreement = dot(member.normal, normal);
        let sign = agreement.map(|x| 1f32.copysign(x));
        let apart = [0, 1, 2].map(|a| member.at[a] - at[a]);
        let mean = [0, 1, 2].map(|a| normal[a] + member.normal[a] * sign);
        let stands_out = dot(mean, apart) * Lanes::splat(0.5);
        let limit = dot(apart, apart) * Lanes::splat(SHEET_SINE * SHEET_SINE);
        let same_face = (agreement * sign).less(
            Lanes::splat(FACE_COSINE),
            Lanes::ZERO,
            limit.less(stands_out * stands_out, Lanes::ZERO, member.weight),
        );
        // The face's own first member, also where it has no normal.
        let on_face = nearest.less(member.length2, same_face, member.weight);
        member.weight = Lanes::ZERO.less(on_face, Lanes::ZERO, member.weight);
        member.signed = on_face * sign;
        up = [0, 1, 2].map(|a| up[a] + member.signed * member.normal[a]);
        total += on_face;
    }
    let length = dot(up, up).sqrt().max(Lanes::splat(f32::MIN_POSITIVE));
    Some(height(around, up.map(|x| x / length), total))
}

/// Distance from the origin to the tangent plane over it of the quadric through the face's members.
fn height(around: &[Member], up: [Lanes; 3], total: Lanes) -> Lanes {
    let (u, v) = tangents(up);
    let half = Lanes::splat(0.5);
    let one = Lanes::splat(1.0);
    // Height a + b u + c v + d u²/2 + e u v + f v²/2 in units of the radius; rows for the height and both slopes.
    let mut matrix = [[Lanes::ZERO; QUADRIC]; QUADRIC];
    let mut right = [Lanes::ZERO; QUADRIC];
    for member in around {
        let weight = member.signed.max(Lanes::ZERO - member.signed);
        let sign = member.signed.map(|x| 1f32.copysign(x));
        let (x, y, z) = (dot(u, member.at), dot(v, member.at), dot(up, member.at));
        let steep = sign / (dot(member.normal, up) * sign).max(Lanes::splat(FACE_COSINE));
        let slope = [u, v].map(|t| Lanes::ZERO - dot(member.normal, t) * steep);
        let (wx, wy) = (weight * x, weight * y);
        let row = [one, x, y, half * x * x, x * y, half * y * y];
        for i in 0..QUADRIC {
            let w = weight * row[i];
            right[i] += w * z;
            for j in 0..=i {
                matrix[i][j] += w * row[j];
            }
        }
        // (0, 1, 0, x, y, 0) and (0, 0, 1, 0, x, y).
        for (s, first) in [(0, 1), (1, 2)] {
            right[first] += weight * slope[s];
            right[3 + s] += wx * slope[s];
            right[4 + s] += wy * slope[s];
            matrix[first][first] += weight;
            matrix[3 + s][first] += wx;
            matrix[4 + s][first] += wy;
            matrix[3 + s][3 + s] += wx * x;
            matrix[4 + s][3 + s] += wx * y;
            matrix[4 + s][4 + s] += wy * y;
        }
    }
    for (i, row) in matrix.iter_mut().enumerate().skip(3) {
        row[i] += Lanes::splat(RIDGE) * total;
    }
    let c = solve(matrix, right);
    let height = c[0].max(Lanes::ZERO - c[0]);
    let height = height / (one + c[1] * c[1] + c[2] * c[2]).sqrt();
    // A lane without members on this face, or with one at the rim of its support only, has none.
    Lanes::splat(LIGHT).less(total, height, Lanes::splat(f32::INFINITY))
}

/// Two unit vectors across each lane's unit vector (Duff et al., "Building an orthonormal basis, revisited", 2017).
fn tangents([x, y, z]: [Lanes; 3]) -> ([Lanes; 3], [Lanes; 3]) {
    let one = Lanes::splat(1.0);
    let sign = z.map(|z| 1f32.copysign(z));
    let a = (Lanes::ZERO - one) / (sign + z);
    let b = x * y * a;
    (
        [one + sign * x * x * a, sign * b, Lanes::ZERO - sign * x],
        [b, sign + y * y * a, Lanes::ZERO - y],
    )
}

/// Solves eight symmetric positive definite systems, lower triangles given, by Cholesky's method. A pivot that is lost to
/// rounding counts as infinite, and its unknown as 0.
fn solve(mut m: [[Lanes; QUADRIC]; QUADRIC], mut right: [Lanes; QUADRIC]) -> [Lanes; QUADRIC] {
    /// Pivots below this share of the diagonal are rounding.
    const LOST: f32 = 1e-6;
    for i in 0..QUADRIC {
        for j in 0..=i {
            let sum = (0..j).fold(m[i][j], |sum, k| sum - m[i][k] * m[j][k]);
            m[i][j] = if i == j {
                // The inverse of the pivot, as it is only divided by.
                let least = (m[i][i] * Lanes::splat(LOST)).max(Lanes::splat(f32::MIN_POSITIVE));
                let root = sum.max(least).sqrt();
                sum.less(least, Lanes::ZERO, Lanes::splat(1.0) / root)
            } else {
                sum * m[j][j]
            };
        }
    }
    for i in 0..QUADRIC {
        for k in 0..i {
            right[i] = right[i] - m[i][k] * right[k];
        }
        right[i] = right[i] * m[i][i];
    }
    for i in (0..QUADRIC).rev() {
        for k in i + 1..QUADRIC {
            right[i] = right[i] - m[k][i] * right[k];
        }
        right[i] = right[i] * m[i][i];
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    #[test]
    fn solutions_satisfy_their_systems() {
        let mut rng = Rng::new(9);
        for rank in [QUADRIC, 4] {
            // A sum of outer products has their number as its rank.
            let rows: Vec<[f32; QUADRIC]> = (0..rank)
                .map(|_| std::array::from_fn(|_| rng.normal() as f32))
                .collect();
            let entry = |i: usize, j: usize| rows.iter().map(|r| r[i] * r[j]).sum::<f32>();
            let matrix =
                std::array::from_fn(|i| std::array::from_fn(|j| Lanes::splat(entry(i, j))));
            let x: [f32; QUADRIC] = std::array::from_fn(|_| rng.normal() as f32);
            let right = |i: usize| (0..QUADRIC).map(|j| entry(i, j) * x[j]).sum::<f32>();
            let found = solve(matrix, std::array::from_fn(|i| Lanes::splat(right(i))));
            for i in 0..QUADRIC {
                let sum: f32 = (0..QUADRIC).map(|j| entry(i, j) * found[j].0[5]).sum();
                assert!((sum - right(i)).abs() < 1e-2, "{sum} {} {rank}", right(i));
            }
        }
    }

    #[test]
    fn tangents_make_a_frame() {
        let mut rng = Rng::new(3);
        for k in 0..100 {
            let n = match k {
                0 => Vec3::Z,
                1 => Vec3::NEG_Z,
                _ => Vec3::from_array(std::array::from_fn(|_| rng.normal() as f32)).normalize(),
            };
            let (u, v) = tangents(n.to_array().map(Lanes::splat));
            let [u, v] = [u, v].map(|t| Vec3::new(t[0].0[0], t[1].0[0], t[2].0[0]));
            assert!((u.length() - 1.0).abs() < 1e-5 && (v.length() - 1.0).abs() < 1e-5);
            assert!(u.dot(v).abs().max(u.dot(n).abs()).max(v.dot(n).abs()) < 1e-5);
        }
    }
}
