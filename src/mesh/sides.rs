//! The two sides of a crease, and where they meet.
//!
//! Beside a crease the fitted functions round it off, and noise makes them do so more. So the surface on each side is taken
//! from where it is smooth, some edges away, and continued to the crease: by a plane, or by a quadric where that is much nearer.

use crate::base::linalg::Spread;
use crate::mesh::collapse::VertexTriangles;
use crate::mesh::curves::OnCrease;
use crate::mesh::surface::Mesh;
use glam::{DMat3, DVec3};
use nalgebra::{SMatrix, SVector};

/// Rings of triangles around a vertex that are looked at.
const RINGS: usize = 6;
/// Distances from the crease, in edges, at which the surface is taken.
const BAND: [f64; 2] = [1.2, 5.0];
/// Cosine of the largest turn from a side's mean normal: 30°.
const SAME: f64 = 0.866;
/// Vertices that tell a side, at least: a plane, a quadric.
const ENOUGH: [usize; 2] = [6, 14];
/// A quadric that leaves less than this share of a plane's squared residual is the better side.
const BENT: f64 = 0.3;
/// Sides that meet under less than 25° (sine) tell no crease.
const MEET: f64 = 0.42;
/// Farthest from where the cell found it, in edges.
const FARTHEST: f64 = 1.0;
/// Deepest that a crease is rounded off, in edges.
const DEEP: f64 = 0.5;

/// Memory of one worker.
#[derive(Default)]
pub(crate) struct Rings {
    seen: Vec<u32>,
    /// Of each vertex of the mesh the number of the last gathering that saw it.
    seen_in: Vec<u32>,
    gathering: u32,
}

/// The sides of a crease next to one of its vertices, and where they meet.
#[derive(Clone, Copy)]
pub(crate) struct Sides {
    pub(crate) point: DVec3,
    /// Across the crease, towards the first side.
    across: DVec3,
    along: DVec3,
    /// A point and the unit normal of the tangent plane of each.
    planes: [(DVec3, DVec3); 2],
}

impl Sides {
    /// Where a vertex belongs that is so near to the crease that it was rounded off, and its normal there.
    pub(crate) fn foot(&self, p: DVec3, edge: f64) -> Option<(DVec3, DVec3)> {
        let d = p - self.point;
        let (on, normal) = self.planes[usize::from(d.dot(self.across) < 0.0)];
        let shift = normal.dot(on - p);
        let near = d.reject_from_normalized(self.along).length() < BAND[0] * edge;
        (near && shift.abs() < DEEP * edge).then_some((p + shift * normal, normal))
    }
}

/// The sides of a crease next to one of its vertices; `None` where they do not tell where they meet.
pub(crate) fn meet(
    own: &OnCrease,
    (mesh, around, on_crease): (&Mesh, &VertexTriangles, &[bool]),
    edge: f64,
    rings: &mut Rings,
) -> Option<Sides> {
    let (origin, along) = (own.point.as_dvec3(), own.along.as_dvec3());
    let across = along.cross(own.normal.as_dvec3()).try_normalize()?;
    rings.gather(own.vertex, mesh, around);
    let planes = [1.0, -1.0].map(|side: f64| {
        let near = rings.seen.iter().filter_map(|&v| {
            let p = mesh.vertices[v as usize].as_dvec3();
            let d = p - origin;
            let away = d.reject_from_normalized(along).length();
            let is_in = (BAND[0] * edge..BAND[1] * edge).contains(&away);
            let is_of_side = side * d.dot(across) > 0.0 && !on_crease[v as usize];
            (is_in && is_of_side).then(|| (p, mesh.normals[v as usize].as_dvec3()))
        });
        let near: Vec<(DVec3, DVec3)> = near.collect();
        let normal = near.iter().map(|n| n.1).sum::<DVec3>().try_normalize()?;
        let same = near.iter().filter(|n| n.1.dot(normal) >= SAME);
        let points: Vec<DVec3> = same.map(|n| n.0).collect();
        tangent(&points, (origin, along, across), normal)
    });
    let [Some((a, n)), Some((b, m))] = planes else {
        return None;
    };
    if n.cross(m).length() < MEET {
        return None;
    }
    let rows = DMat3::from_cols(n, m, along).transpose();
    let shift = rows.inverse() * DVec3::new(n.dot(a - origin), m.dot(b - origin), 0.0);
    (shift.length() <= FARTHEST * edge).then_some(Sides {
        point: origin + shift,
        across,
        along,
        planes: [(a, n), (b, m)],
    })
}

impl Rings {
    /// The vertices of [`RINGS`] rings around one.
    fn gather(&mut self, v: u32, mesh: &Mesh, around: &VertexTriangles) {
        self.seen_in.resize(mesh.vertices.len(), 0);
        self.gathering += 1;
        self.seen.clear();
        self.see(v);
        let mut last = 0;
        for _ in 0..RINGS {
            let end = self.seen.len();
            for k in last..end {
                for &t in around.of(self.seen[k]) {
                    for w in mesh.triangles[t as usize] {
                        self.see(w);
                    }
                }
            }
            last = end;
        }
    }

    fn see(&mut self, v: u32) {
        let seen_in = &mut self.seen_in[v as usize];
        if *seen_in != self.gathering {
            *seen_in = self.gathering;
            self.seen.push(v);
        }
    }
}

/// The tangent plane of a side next to the crease: a point and the unit normal.
fn tangent(
    points: &[DVec3],
    (origin, along, across): (DVec3, DVec3, DVec3),
    normal: DVec3,
) -> Option<(DVec3, DVec3)> {
    if points.len() < ENOUGH[0] {
        return None;
    }
    let Spread { mean, eigen, .. } = Spread::of(points.iter().copied());
    let up = eigen.vectors[0] * eigen.vectors[0].dot(normal).signum();
    if up.dot(normal) < SAME {
        return None;
    }
    let plane = Some((mean, up));
    if points.len() < ENOUGH[1] {
        return plane;
    }
    // Coordinates in the plane: x away from the crease, y along it; unit is the band.
    let u = across.reject_from_normalized(up).try_normalize()?;
    let v = up.cross(u) * up.cross(u).dot(along).signum();
    let scale = eigen.values[2].max(f64::MIN_POSITIVE).sqrt() / (points.len() as f64).sqrt();
    let row = |p: DVec3| {
        let d = (p - mean) / scale;
        let (x, y) = (d.dot(u), d.dot(v));
        (
            SVector::<f64, 6>::new(1.0, x, y, x * x, x * y, y * y),
            d.dot(up),
        )
    };
    let mut matrix = SMatrix::<f64, 6, 6>::identity() * 1e-6;
    let mut right = SVector::<f64, 6>::zeros();
    for &p in points {
        let (row, height) = row(p);
        matrix += row * row.transpose();
        right += row * height;
    }
    let c = nalgebra::Cholesky::new(matrix)?.solve(&right);
    let left: f64 = points
        .iter()
        .map(|&p| (row(p).1 - row(p).0.dot(&c)).powi(2))
        .sum();
    if left * scale * scale >= BENT * eigen.values[0] {
        return plane;
    }
    let (at, _) = row(origin);
    let (x, y) = (at[1], at[2]);
    let slope = |one: f64, own: f64, mixed: f64| -(one + own + mixed);
    let tilt =
        u * slope(c[1], 2.0 * c[3] * x, c[4] * y) + v * slope(c[2], 2.0 * c[5] * y, c[4] * x);
    let foot = mean + scale * (u * x + v * y + up * at.dot(&c));
    Some((foot, (up + tilt).normalize()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a side `height` high over x > 0 says next to the y axis.
    fn side(height: impl Fn(f64, f64) -> f64) -> (DVec3, DVec3) {
        let points: Vec<DVec3> = (0..60)
            .map(|k| {
                let (x, y) = (0.1 + 0.04 * (k % 10) as f64, 0.1 * (k / 10) as f64 - 0.25);
                DVec3::new(x, y, height(x, y))
            })
            .collect();
        tangent(&points, (DVec3::ZERO, DVec3::Y, DVec3::X), DVec3::Z).unwrap()
    }

    #[test]
    fn sides_are_continued_to_the_crease() {
        let (p, n) = side(|x, _| 0.2 * x);
        assert!(n.dot(-p).abs() < 1e-9);
        assert!(n.dot(DVec3::new(-0.2, 0.0, 1.0).normalize()) > 1.0 - 1e-9);
        let (p, n) = side(|x, y| 0.3 * x * x - 0.2 * y * y + 0.1 * x);
        assert!(n.dot(-p).abs() < 1e-3, "{}", n.dot(-p));
        assert!(n.dot(DVec3::new(-0.1, 0.0, 1.0).normalize()) > 0.999);
    }
}
