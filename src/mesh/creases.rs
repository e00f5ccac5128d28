//! Creases and corners of the zero set: vertices where the tangent planes of a loop meet.
//!
//! L. P. Kobbelt et al., "Feature sensitive surface extraction from volume data", 2001; T. Ju et al., "Dual contouring
//! of Hermite data", 2002.

use crate::base::linalg::sym_eigen;
use crate::mesh::curves::OnCrease;
use crate::mesh::probe::{MARGIN, Probe, Quad, Vertex, clamp};
use crate::mesh::surface::Implicit;
use glam::{DVec3, Vec3};
use std::ops::Range;

/// Neighbouring vertices whose normals differ by more (cosine of 25°) may lie on a crease.
const CREASE_COSINE: f32 = 0.906;
/// A direction in which the planes of a loop determine the vertex: its eigenvalue over the largest. 0.1 is met by two
/// planes at 35° to each other (tan²(17.5°)); noise in the gradients stays under it. (Ju et al., section 2.3, cut
/// singular values off at 0.1.)
const RANK_SHARE: f64 = 0.1;
/// Evaluations that find where an edge is crossed, at most. Beside a crease values are not linear along an edge, and a
/// plane through a wrong point moves the vertex.
const EVALUATIONS: usize = 3;
/// A crossing is found once the surface is nearer to it than this share of an edge.
const FOUND: f64 = 0.02;

/// A vertex that would be farther off the surface than this share of an edge is left where it is: its cell does not hold
/// the place where the planes meet.
const FARTHEST: f64 = 0.2;

/// Marks the vertices whose normal differs from that of a neighbour.
pub(crate) fn mark(vertices: &[Vertex], quads: &[Quad]) -> Vec<bool> {
    let mut marked = vec![false; vertices.len()];
    for quad in quads {
        for k in 0..4 {
            let (p, q) = (
                quad.vertices[k] as usize,
                quad.vertices[(k + 1) % 4] as usize,
            );
            let (n, m) = (vertices[p].normal, vertices[q].normal);
            if n != Vec3::ZERO && m != Vec3::ZERO && n.dot(m) < CREASE_COSINE {
                marked[p] = true;
                marked[q] = true;
            }
        }
    }
    marked
}

/// A crossed lattice edge on which the crossing is being found.
pub(crate) struct Crossing {
    /// The edge's lower end.
    start: DVec3,
    /// Along the edge, as long as it.
    along: DVec3,
    /// The crossing lies between these shares of the edge.
    low: f64,
    high: f64,
    /// The best guess.
    at: f64,
    /// Whether values rise along the edge.
    rising: bool,
    /// The surface's tangent plane near the best guess: a point and the unit normal.
    plane: Option<(DVec3, DVec3)>,
}

impl Crossing {
    /// Starts from linear interpolation between the values at both ends.
    pub(crate) fn new(start: DVec3, along: DVec3, [low, high]: [f64; 2]) -> Crossing {
        Crossing {
            start,
            along,
            low: 0.0,
            high: 1.0,
            at: low / (low - high),
            rising: low < 0.0,
            plane: None,
        }
    }

    fn position(&self) -> DVec3 {
        self.start + self.along * self.at
    }

    /// Takes value and gradient at the best guess: a Newton step, or halving where that would leave the bracket, unless
    /// the crossing is found. Returns whether to go on.
    fn improve(&mut self, (value, gradient): (f64, DVec3)) -> bool {
        let to_plane = gradient * (-value / gradient.length_squared());
        self.plane = Some((self.position() + to_plane, gradient.normalize()));
        if to_plane.length() < FOUND * self.along.length() {
            return false;
        }
        if (value < 0.0) == self.rising {
            self.low = self.at;
        } else {
            self.high = self.at;
        }
        let next = self.at - value / gradient.dot(self.along);
        let inside = next >= self.low && next <= self.high;
        self.at = if inside {
            next
        } else {
            (self.low + self.high) / 2.0
        };
        true
    }
}

/// A loop whose vertex may lie on a crease.
pub(crate) struct Candidate {
    pub(crate) vertex: u32,
    /// Position of its cell's lowest corner.
    pub(crate) corner: DVec3,
    /// Its crossings.
    pub(crate) crossings: Range<usize>,
}

/// A vertex that has been moved to a crease or corner, as far as its cell goes, and where that is.
pub(crate) struct Moved {
    pub(crate) position: Vec3,
    pub(crate) crease: OnCrease,
}

/// The candidates whose planes meet in a line or a point of their cell, moved there. `edge` is the cells' edge length.
pub(crate) fn sharpen<F: Implicit>(
    candidates: &[Candidate],
    crossings: &mut [Crossing],
    edge: f64,
    probe: &mut Probe<F>,
) -> Vec<Moved> {
    let mut sought: Vec<usize> = (0..crossings.len()).collect();
    for _ in 0..EVALUATIONS {
        probe.at.clear();
        probe
            .at
            .extend(sought.iter().map(|&k| crossings[k].position()));
        probe.evaluate();
        let mut found = probe.found.iter();
        sought
            .retain(|&k| matches!(found.next(), Some(&Some(found)) if crossings[k].improve(found)));
    }
    let solve = |candidate: &Candidate| {
        let planes: Vec<_> = crossings[candidate.crossings.clone()]
            .iter()
            .filter_map(|c| c.plane)
            .collect();
        let crease = meet_planes(&planes)?;
        let nearest = crease.in_cell(candidate.corner, edge);
        let at = |inside: DVec3| (candidate.corner + edge * inside).as_vec3();
        Some(Moved {
            position: at(clamp(nearest)),
            crease: OnCrease {
                vertex: candidate.vertex,
                point: at(nearest),
                along: crease.along.as_vec3(),
                normal: crease.normal.as_vec3(),
            },
        })
    };
    let mut moved: Vec<Moved> = candidates.iter().filter_map(solve).collect();
    probe.at.clear();
    probe.at.extend(moved.iter().map(|m| m.position.as_dvec3()));
    probe.evaluate();
    let mut found = probe.found.iter();
    let is_near = |(value, _): (f64, DVec3)| value.abs() < FARTHEST * edge;
    moved.retain(|_| found.next().is_some_and(|found| found.is_some_and(is_near)));
    moved
}

/// A line or a point in which planes meet.
struct Crease {
    point: DVec3,
    /// Along the line; zero where it is a point.
    along: DVec3,
    /// Mean normal of the planes.
    normal: DVec3,
}

impl Crease {
    /// Of the line's points in the cell the one nearest to `point`, or else `point`; in the cell's coordinates (0-1).
    fn in_cell(&self, corner: DVec3, edge: f64) -> DVec3 {
        let start = (self.point - corner) / edge;
        let (mut first, mut last) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            // Along an axis with no slope both are infinite or NaN, which bounds the line as it should.
            let at = |side: f64| (side - start[axis]) / self.along[axis];
            let (a, b) = (at(MARGIN), at(1.0 - MARGIN));
            first = first.max(a.min(b));
            last = last.min(a.max(b));
        }
        if first <= last {
            start + self.along * 0f64.max(first).min(last)
        } else {
            start
        }
    }
}

/// The point (nearest to the mean of the planes' points) or the line with the least sum of squared distances to planes
/// (point, unit normal); `None` where they are all about the same.
fn meet_planes(planes: &[(DVec3, DVec3)]) -> Option<Crease> {
    let mean = planes.iter().map(|p| p.0).sum::<DVec3>() / planes.len().max(1) as f64;
    let mut matrix = [0.0; 6];
    let (mut right, mut normal) = (DVec3::ZERO, DVec3::ZERO);
    for &(point, n) in planes {
        let products = crate::base::linalg::outer(n);
        matrix.iter_mut().zip(products).for_each(|(m, p)| *m += p);
        right += n * n.dot(point - mean);
        normal += n;
    }
    let eigen = sym_eigen(&matrix);
    let determined = |k: usize| eigen.values[k] > RANK_SHARE * eigen.values[2];
    if planes.len() < 3 || !determined(1) {
        return None;
    }
    let along = |k: usize| eigen.vectors[k] * (eigen.vectors[k].dot(right) / eigen.values[k]);
    let shift: DVec3 = (0..3).filter(|&k| determined(k)).map(along).sum();
    Some(Crease {
        point: mean + shift,
        along: if determined(0) {
            DVec3::ZERO
        } else {
            eigen.vectors[0]
        },
        normal: normal.normalize_or(planes[0].1),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_meet_in_a_corner_a_line_or_not_at_all() {
        let at = DVec3::new(0.1, -0.2, 0.3);
        let plane = |n: DVec3, shift: DVec3| (at + shift - n * n.dot(shift), n);
        let (a, b) = (DVec3::new(0.3, 0.1, 0.4), DVec3::new(-0.2, 0.5, 0.1));
        let corner = [plane(DVec3::X, a), plane(DVec3::Y, b), plane(DVec3::Z, a)];
        let found = meet_planes(&corner).expect("three planes");
        assert!(found.point.distance(at) < 1e-12 && found.along == DVec3::ZERO);
        assert!(found.normal.distance(DVec3::ONE.normalize()) < 1e-12);
        let line = [plane(DVec3::X, a), plane(DVec3::Y, b), plane(DVec3::Y, a)];
        let found = meet_planes(&line).expect("two planes");
        let mean = (line[0].0.z + line[1].0.z + line[2].0.z) / 3.0;
        assert!(found.point.distance(at.with_z(mean)) < 1e-12);
        let inside = found.in_cell(DVec3::new(0.0, -0.25, 0.0), 0.25);
        assert!(
            inside.distance(DVec3::new(0.4, 0.2, 1.0 - MARGIN)) < 1e-9,
            "{inside}"
        );
        let outside = found.in_cell(DVec3::ZERO, 0.25);
        assert!(outside.distance(found.point / 0.25) < 1e-12);
        let tilted = DVec3::new(0.2, 0.0, 1.0).normalize();
        let flat = [plane(DVec3::Z, a), plane(tilted, b), plane(DVec3::Z, b)];
        assert!(meet_planes(&flat).is_none());
    }

    #[test]
    fn a_crossing_is_found_where_values_are_not_linear() {
        let value = |t: f64| (t - 0.2).max(10.0 * (t - 0.6));
        let slope = |t: f64| if t < 0.644 { 1.0 } else { 10.0 };
        let mut crossing = Crossing::new(DVec3::ZERO, DVec3::X, [value(0.0), value(1.0)]);
        let mut evaluations = 1;
        while crossing.improve((value(crossing.at), DVec3::X * slope(crossing.at))) {
            evaluations += 1;
        }
        assert!(evaluations <= EVALUATIONS);
        assert!((crossing.at - 0.2).abs() < 1e-9, "{}", crossing.at);
    }
}
