//! The surface that a reduced cloud stands for, made of its points and normals alone.
//!
//! Every reduced point has a patch: a quadric height field over the mean tangent plane of the reduced points around it on its
//! own face and sheet, fitted to their positions and normals by least squares with Wendland weights. The distance of a point
//! is that to the tangent plane over it of the patch of the nearest reduced point, or of one near it that is on another
//! face or sheet, at most the distance to the nearest reduced point itself. So points of a curved surface have a distance of
//! fourth order in the spacing, where to tangent planes it is second.
//!
//! Eight patches are fitted at once, a lane each.

use glam::Vec3;

use crate::base::error::Result;
use crate::base::kernel::wendland;
use crate::base::lanes::{LANES, Lanes};
use crate::base::par;
use crate::base::progress::{Progress, Stage};
use crate::cloud::neighborhood::{Block, CELL, Neighborhood, bounds};
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;
use crate::reduce::shares::{SHARES, Shares};

/// Reduced points around one that make up its patch, about.
const NEIGHBORS: usize = 8;
/// Radius of the weights, in distances to the eighth reduced point: weights vanish at their rim.
const SUPPORT: f32 = 1.2;
/// A point with fewer reduced points within its block's radius is in a sparser part, and asks for itself.
const FEW: f32 = 5.0;
/// Neighbours whose normals differ by more (cosine of 60°) belong to another face.
const FACE_COSINE: f32 = 0.5;
/// Patches whose normals differ by more (cosine of 25°) may have a crease between them, and a point next to it belongs to
/// either: with 60° the faces of a point on a right-angled edge would go unasked, and edges seem a quarter less accurate.
const SMOOTH_COSINE: f32 = 0.9;
/// Neighbours that stand out by more belong to another sheet: the offset along the mean of both normals over the
/// distance, which on one curved sheet is of second order in the distance.
const SHEET_SINE: f32 = 0.2;
/// Ridge on the quadric's second derivatives, relative to the weight of the data: a plane where the data leave them
/// open, unnoticeable elsewhere.
const RIDGE: f32 = 1e-5;
/// Coefficients of a quadric.
const QUADRIC: usize = 6;

/// A quadric over the tangent plane of one reduced point.
#[derive(Debug, Clone, Copy)]
struct Patch {
    at: Vec3,
    /// Normal of the plane.
    up: Vec3,
    /// The point's own.
    normal: Vec3,
    /// Unit of length of the coefficients; none of the patch is known farther away.
    radius: f32,
    /// Height a + b u + c v + d u²/2 + e u v + f v²/2 in units of the radius.
    c: [f32; QUADRIC],
}

/// The surface that reduced points stand for.
#[derive(Debug, Clone)]
pub struct Patches(Vec<Patch>);

impl Patches {
    /// Fits the patches of the points of a tree (unit frame), in the order from which it was built; so are `normals`, unit and
    /// of any sign.
    pub fn fit(reduced: &Octree, normals: &[Vec3]) -> Patches {
        let normals: Vec<Vec3> = reduced.order.iter().map(|&i| normals[i as usize]).collect();
        let fitting = Fitting {
            reduced,
            normals: &normals,
        };
        let mut patches = vec![Patch::NONE; normals.len()];
        par::map_each(
            reduced.points.len().div_ceil(CELL),
            Scratch::default,
            |i, scratch| {
                let end = ((i + 1) * CELL).min(reduced.points.len());
                fitting.cell(i * CELL..end, scratch)
            },
            |i, fitted| {
                for (&i, patch) in reduced.order[i * CELL..].iter().zip(fitted) {
                    patches[i as usize] = patch;
                }
            },
        );
        Patches(patches)
    }

    /// Distance of `p`, of which `near` are the nearest reduced points, nearest first.
    pub fn distance(&self, p: Vec3, near: [u32; SHARES]) -> f32 {
        let [nearest, others @ ..] = near.map(|i| &self.0[i as usize]);
        let mut distance = nearest.distance(p);
        for other in others {
            if !nearest.shares_face(other) {
                distance = distance.min(other.distance(p));
            }
        }
        distance
    }
}

/// Distances of points, which have these shares in the reduced points, to the surface.
///
/// # Errors
/// [`crate::Error::Cancelled`] if `progress` asks for it.
pub fn cloud_distances(
    points: impl Fn(usize) -> Vec3 + Sync + Send,
    shares: &[Shares],
    patches: &Patches,
    progress: &mut dyn Progress,
) -> Result<Vec<f32>> {
    par::flat_map_progress(
        shares.len().div_ceil(SLICE),
        shares.len(),
        40.0,
        (Stage::Report, progress),
        || (),
        |i, ()| {
            let end = ((i + 1) * SLICE).min(shares.len());
            (i * SLICE..end)
                .map(|k| patches.distance(points(k), shares[k].near()))
                .collect()
        },
    )
}

/// Points whose distances are measured in one go.
const SLICE: usize = 1024;

impl Patch {
    /// Before it is fitted.
    const NONE: Patch = Patch {
        at: Vec3::ZERO,
        up: Vec3::ZERO,
        normal: Vec3::ZERO,
        radius: 0.0,
        c: [0.0; QUADRIC],
    };

    fn distance(&self, p: Vec3) -> f32 {
        let away = p.distance(self.at);
        if away >= self.radius {
            return away;
        }
        let d = (p - self.at) / self.radius;
        let (u, v) = self.up.any_orthonormal_pair();
        let (x, y, z) = (d.dot(u), d.dot(v), d.dot(self.up));
        let [c0, cx, cy, cxx, cxy, cyy] = self.c;
        let (dx, dy) = (cx + cxx * x + cxy * y, cy + cxy * x + cyy * y);
        let height = c0 + cx * x + cy * y + 0.5 * (cxx * x * x + cyy * y * y) + cxy * x * y;
        let off = (z - height).abs() * self.radius / (1.0 + dx * dx + dy * dy).sqrt();
        off.min(away)
    }

    /// Whether another one continues this one. Those without a normal are a face each.
    fn shares_face(&self, other: &Patch) -> bool {
        let agreement = self.normal.dot(other.normal);
        let apart = other.at - self.at;
        let mean = self.normal + other.normal * 1f32.copysign(agreement);
        let stands_out = 0.5 * mean.dot(apart);
        agreement.abs() >= SMOOTH_COSINE
            && stands_out * stands_out <= SHEET_SINE * SHEET_SINE * apart.length_squared()
    }
}

/// Reduced points and their normals, in the tree's order.
struct Fitting<'a> {
    reduced: &'a Octree,
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

/// A reduced point as each lane's point sees it.
#[derive(Clone, Copy)]
struct Member {
    /// From the lane's point, in radii.
    at: [Lanes; 3],
    normal: [Lanes; 3],
    /// Wendland weight, 0 for those of other faces, with the sign that turns the normal to the lane's side.
    signed: Lanes,
}

fn dot(a: [Lanes; 3], b: [Lanes; 3]) -> Lanes {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Fitting<'_> {
    fn cell(&self, range: std::ops::Range<usize>, scratch: &mut Scratch) -> Vec<Patch> {
        let points = &self.reduced.points;
        let mut patches = Vec::with_capacity(range.len());
        let corners = bounds(&points[range.clone()]);
        let middle = points[range.start + range.len() / 2];
        self.reduced.knn(middle, NEIGHBORS, &mut scratch.found);
        // Twice the radius at the middle: what needs more asks for itself.
        let reach = 2.0 * SUPPORT * farthest(&scratch.found);
        let gathered = scratch.cell.gather(self.reduced, corners, reach);
        for block in Block::all(points, range) {
            let middle = points[block.middle()];
            let radius = SUPPORT * scratch.cell.kth_distance(middle, NEIGHBORS);
            let together = gathered && radius > 0.0 && radius <= reach;
            let start = patches.len();
            if together {
                scratch.cell.narrow(&block, radius);
                let found = self.block(&block, radius, &scratch.cell, &mut scratch.around);
                patches.extend_from_slice(&found[..block.range.len()]);
            } else {
                patches.extend(block.range.clone().map(|_| Patch::NONE));
            }
            for (i, patch) in block.range.clone().zip(&mut patches[start..]) {
                if patch.radius == 0.0 {
                    *patch = self.alone(i, scratch);
                }
            }
        }
        patches
    }

    /// The patch of one point from its own nearest.
    fn alone(&self, i: usize, scratch: &mut Scratch) -> Patch {
        let at = self.reduced.points[i];
        self.reduced.knn(at, NEIGHBORS, &mut scratch.found);
        let radius = SUPPORT * farthest(&scratch.found);
        let normal = self.normals[i];
        let place = Patch {
            at,
            normal,
            ..Patch::NONE
        };
        if radius == 0.0 {
            return place;
        }
        scratch.own.gather_at(self.reduced, at, radius);
        let block = Block::new(&self.reduced.points, i..i + 1);
        let [patch, ..] = self.block(&block, radius, &scratch.own, &mut scratch.around);
        // With fewer reduced points than asked for, the place is all that is known.
        if patch.radius == 0.0 { place } else { patch }
    }

    /// The patches of a block; of radius 0 where too few reduced points are within `radius`.
    fn block(
        &self,
        block: &Block,
        radius: f32,
        hood: &Neighborhood,
        around: &mut Vec<Member>,
    ) -> [Patch; LANES] {
        let one = Lanes::splat(1.0);
        let scale = Lanes::splat(1.0 / radius);
        let normal = [0, 1, 2].map(|axis| block.lanes(|i| self.normals[i][axis]));
        let (mut inside, mut total) = (Lanes::ZERO, Lanes::ZERO);
        let mut up = [Lanes::ZERO; 3];
        around.clear();
        around.extend(hood.near().map(|(j, at)| {
            let at = [0, 1, 2].map(|axis| (at[axis] - block.at[axis]) * scale);
            let length2 = dot(at, at);
            inside += length2.less(one, one, Lanes::ZERO);
            let own = self.normals[j].to_array().map(Lanes::splat);
            let agreement = dot(own, normal);
            let sign = agreement.sign();
            let mean = [0, 1, 2].map(|a| normal[a] + own[a] * sign);
            let stands_out = dot(mean, at) * Lanes::splat(0.5);
            let limit = length2 * Lanes::splat(SHEET_SINE * SHEET_SINE);
            let on_face = (agreement * sign).less(
                Lanes::splat(FACE_COSINE),
                Lanes::ZERO,
                limit.less(
                    stands_out * stands_out,
                    Lanes::ZERO,
                    wendland(length2.sqrt()).0,
                ),
            );
            // The point itself, also where it has no normal.
            let weight = Lanes::ZERO.less(length2, on_face, one);
            total += weight;
            let signed = weight * sign;
            up = [0, 1, 2].map(|a| up[a] + signed * own[a]);
            Member {
                at,
                normal: own,
                signed,
            }
        }));
        let length = dot(up, up).sqrt().max(Lanes::splat(f32::MIN_POSITIVE));
        let up = up.map(|x| x / length);
        let c = quadric(around, up, total);
        let enough = FEW.min(self.reduced.points.len() as f32);
        std::array::from_fn(|l| {
            let i = block.range.start + l.min(block.range.len() - 1);
            Patch {
                at: self.reduced.points[i],
                up: Vec3::from_array(up.map(|x| x.lane(l))),
                normal: self.normals[i],
                radius: if inside.lane(l) < enough || length.lane(l) == f32::MIN_POSITIVE {
                    0.0
                } else {
                    radius
                },
                c: c.map(|c| c.lane(l)),
            }
        })
    }
}

fn farthest(found: &[Neighbor]) -> f32 {
    found.last().map_or(0.0, |n| n.distance2.sqrt())
}

/// The quadric through the face's members.
fn quadric(around: &[Member], up: [Lanes; 3], total: Lanes) -> [Lanes; QUADRIC] {
    let (u, v) = tangents(up);
    let half = Lanes::splat(0.5);
    let one = Lanes::splat(1.0);
    // Height a + b u + c v + d u²/2 + e u v + f v²/2 in units of the radius; rows for the height and both slopes.
    let mut matrix = [[Lanes::ZERO; QUADRIC]; QUADRIC];
    let mut right = [Lanes::ZERO; QUADRIC];
    for member in around {
        let weight = member.signed.max(Lanes::ZERO - member.signed);
        let sign = member.signed.sign();
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
    solve(matrix, right)
}

/// Two unit vectors across each lane's unit vector (Duff et al., "Building an orthonormal basis, revisited", 2017).
fn tangents([x, y, z]: [Lanes; 3]) -> ([Lanes; 3], [Lanes; 3]) {
    let one = Lanes::splat(1.0);
    let sign = z.sign();
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
    use crate::base::rng::Rng;

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
                let sum: f32 = (0..QUADRIC).map(|j| entry(i, j) * found[j].lane(5)).sum();
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
            let [u, v] = [u, v].map(|t| Vec3::from_array(t.map(|x| x.lane(0))));
            assert!((u.length() - 1.0).abs() < 1e-5 && (v.length() - 1.0).abs() < 1e-5);
            assert!(u.dot(v).abs().max(u.dot(n).abs()).max(v.dot(n).abs()) < 1e-5);
        }
    }
}
