//! Creases as lines: vertices on one are moved onto the curve that those along it tell together.
//!
//! Each cell finds the crease from its own tangent planes, so that noise makes it wavy, and keeps its vertex inside of the cell,
//! beside which the crease may run. So once the triangles are there:
//!
//! 1. Around each vertex a line or a parabola is fitted to what the cells along the crease found, over a length that follows
//!    the noise, as long as several sub-domains (moving least squares: D. Levin, "Mesh-independent surface interpolation",
//!    2003).
//! 2. Between such vertices the crease runs on: where the surface is cut off there, the nearest vertices go onto it as well.
//! 3. The vertex moves there, across the crease only, unless a triangle would turn over.

use crate::base::par;
use crate::cloud::octree::Octree;
use crate::mesh::collapse::{VertexTriangles, vertex_triangles};
use crate::mesh::surface::Mesh;
use glam::{DVec3, Vec3};
use nalgebra::{SMatrix, SVector};

/// Half of the length that a curve is fitted over, in edges of the lattice: without noise, what is added for noise of one edge,
/// and at most.
const LENGTH: [f64; 3] = [4.0, 40.0, 14.0];
/// Noise, in edges, under which every cell knows the crease best.
const QUIET: f64 = 0.03;
/// Cosine of the largest turn, of the crease and of its normal, to another cell's that is of the same crease: 30°.
const SAME: f64 = 0.866;
/// How far beside the crease another cell may see it, in edges, and per distance along it.
const ASIDE: [f64; 2] = [0.7, 0.2];
/// Cells that tell a line, at least.
const FEWEST: usize = 5;
/// A parabola that leaves less than this share of a line's squared residual is the better curve.
const BENT: f64 = 0.5;
/// Share of the length that a parabola must be seen over on either side.
const BOTH_SIDES: f64 = 0.3;
/// Residuals, in medians of them, at which a cell's weight is a quarter.
const ODD: f64 = 2.0;
/// Largest move in edges.
const FARTHEST: f64 = 1.0;
/// Half of the length over which cells tell where a crease runs that others cut off, in edges.
const GAP: f64 = 8.0;
/// The surface turns from one side of a crease to the other where normals of neighbours do by more than this (cosine of 25°).
const TURN: f32 = 0.906;
/// What cuts a crease off is no farther from it than this, in edges, and from the next vertex along it no nearer than that.
const BESIDE: f64 = 0.7;
/// See [`BESIDE`].
const APART: f64 = 0.5;
/// Least cosine between a triangle's normals before and after: 60°.
const TURNED: f64 = 0.5;
/// Squared sine of the least angle of a moved triangle, unless it had a smaller one: 5°.
const LEAST_SINE2: f64 = 0.0076;

/// What a cell knows of the crease at its vertex.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OnCrease {
    pub(crate) vertex: u32,
    /// On the crease, maybe outside of the cell.
    pub(crate) point: Vec3,
    /// Along the crease, unit; zero at a corner.
    pub(crate) along: Vec3,
    /// Mean of the normals on both sides.
    pub(crate) normal: Vec3,
}

/// Moves the vertices of a mesh onto their creases, and those between them that cut a crease off; marks all as `on_crease`.
/// `edge` is the edge length of the lattice, `noise` that of the surface.
pub(crate) fn straighten(
    mesh: &mut Mesh,
    creases: &[OnCrease],
    on_crease: &mut [bool],
    (edge, noise): (f64, f64),
) {
    if creases.is_empty() {
        return;
    }
    let points: Vec<Vec3> = creases.iter().map(|c| c.point).collect();
    let tree = Octree::build(&points);
    let relative = noise / edge;
    let length = edge * (LENGTH[0] + LENGTH[1] * relative).min(LENGTH[2]);
    let targets = par::map(creases.len(), Vec::new, |k, found| {
        let own = &creases[k];
        if relative < QUIET || own.along == Vec3::ZERO {
            return own.point;
        }
        let curve = Samples::of(own, creases, (&tree, length, edge), found);
        let at = curve.and_then(|samples| samples.at_middle());
        at.map_or(own.point, |at| at.as_vec3())
    });
    let around = vertex_triangles(mesh);
    for (own, target) in creases.iter().zip(targets) {
        on_crease[own.vertex as usize] = true;
        let v = own.vertex as usize;
        if f64::from(target.distance(mesh.vertices[v])) <= FARTHEST * edge {
            move_to(mesh, &around, own.vertex, target);
        }
    }
    let length = length.max(GAP * edge);
    let mut beside = cut_off(mesh, creases, on_crease, (&tree, length, edge));
    beside.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.vertex.cmp(&b.1.vertex)));
    for (_, at) in beside {
        // One vertex a place along the crease is enough.
        let taken = around.of(at.vertex).iter().any(|&t| {
            let others = mesh.triangles[t as usize].into_iter();
            others.filter(|&w| on_crease[w as usize]).any(|w| {
                let apart = mesh.vertices[w as usize] - at.point;
                f64::from(apart.dot(at.along).abs()) < APART * edge
            })
        });
        if !taken && move_to(mesh, &around, at.vertex, at.point) {
            on_crease[at.vertex as usize] = true;
        }
    }
}

/// Vertices beside a crease, where the surface turns from one of its sides to the other but no cell found it: how far from it,
/// and where it runs, between cells that did find it.
fn cut_off(
    mesh: &Mesh,
    creases: &[OnCrease],
    on_crease: &[bool],
    (tree, length, edge): (&Octree, f64, f64),
) -> Vec<(f32, OnCrease)> {
    let mut turns = vec![false; mesh.vertices.len()];
    for t in &mesh.triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            let [n, m] = [a, b].map(|v| mesh.normals[v as usize]);
            if n.dot(m) < TURN {
                turns[a as usize] = true;
                turns[b as usize] = true;
            }
        }
    }
    let is_free = |v: &u32| turns[*v as usize] && !on_crease[*v as usize];
    let free: Vec<u32> = (0..turns.len() as u32).filter(is_free).collect();
    let found = par::map(free.len(), Vec::new, |k, found| {
        let vertex = free[k];
        let point = mesh.vertices[vertex as usize];
        let nearest = &creases[tree.order[tree.nearest(point).index as usize] as usize];
        if nearest.along == Vec3::ZERO {
            return None;
        }
        let own = OnCrease {
            vertex,
            point,
            ..*nearest
        };
        let samples = Samples::of(&own, creases, (tree, length, edge), found)?;
        if !samples.is_between() {
            return None;
        }
        let point = samples.at_middle()?.as_vec3();
        let away = point.distance(mesh.vertices[vertex as usize]);
        let near = f64::from(away) <= BESIDE * edge;
        near.then_some((away, OnCrease { point, ..own }))
    });
    found.into_iter().flatten().collect()
}

/// Moves a vertex, by half of the way or not at all where a triangle would turn over; whether it moved.
fn move_to(mesh: &mut Mesh, around: &VertexTriangles, v: u32, target: Vec3) -> bool {
    let from = mesh.vertices[v as usize];
    for share in [1.0, 0.5] {
        let to = from + share * (target - from);
        let stays = around.of(v).iter().all(|&t| {
            let corners = mesh.triangles[t as usize];
            let at = |w: u32| mesh.vertices[w as usize].as_dvec3();
            let before = corners.map(at);
            let after = corners.map(|w| if w == v { to.as_dvec3() } else { at(w) });
            let (old, new) = (cross(before), cross(after));
            let facing =
                old.dot(new) >= TURNED * (old.length_squared() * new.length_squared()).sqrt();
            facing && sine2(after) >= LEAST_SINE2.min(sine2(before))
        });
        if stays {
            mesh.vertices[v as usize] = to;
            return true;
        }
    }
    false
}

fn cross([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// Squared sine of a triangle's least angle.
fn sine2(t: [DVec3; 3]) -> f64 {
    let [p, q, r] = [t[1] - t[0], t[2] - t[1], t[0] - t[2]].map(DVec3::length_squared);
    let longest2 = p.max(q) * p.min(q).max(r);
    cross(t).length_squared() / longest2.max(f64::MIN_POSITIVE)
}

/// What the cells along a crease found, seen from one of them: how far along, and how far across in two directions.
struct Samples {
    origin: DVec3,
    across: [DVec3; 2],
    at: Vec<[f64; 3]>,
    weights: Vec<f64>,
    length: f64,
}

impl Samples {
    fn of(
        own: &OnCrease,
        creases: &[OnCrease],
        (tree, length, edge): (&Octree, f64, f64),
        found: &mut Vec<u32>,
    ) -> Option<Samples> {
        found.clear();
        let reach = length as f32;
        tree.gather(own.point - reach, own.point + reach, usize::MAX, found);
        let (origin, direction) = (own.point.as_dvec3(), own.along.as_dvec3());
        let is_same = |c: &&OnCrease| {
            let d = c.point.as_dvec3() - origin;
            let along = d.dot(direction);
            let aside = (d - along * direction).length();
            along.abs() < length
                && aside <= ASIDE[0] * edge + ASIDE[1] * along.abs()
                && f64::from(c.along.dot(own.along).abs()) >= SAME
                && f64::from(c.normal.dot(own.normal)) >= SAME
        };
        let same = || {
            let each = found
                .iter()
                .map(|&k| &creases[tree.order[k as usize] as usize]);
            each.filter(is_same)
        };
        let turned = |c: &OnCrease| c.along * c.along.dot(own.along).signum();
        let direction = same()
            .map(turned)
            .sum::<Vec3>()
            .as_dvec3()
            .try_normalize()?;
        let across = direction.any_orthonormal_pair();
        let at: Vec<[f64; 3]> = same()
            .map(|c| {
                let d = c.point.as_dvec3() - origin;
                [d.dot(direction), d.dot(across.0), d.dot(across.1)]
            })
            .collect();
        let weights = at
            .iter()
            .map(|a| (1.0 - (a[0] / length).powi(2)).max(0.0).powi(2));
        let weights: Vec<f64> = weights.collect();
        (at.len() >= FEWEST).then_some(Samples {
            origin,
            across: [across.0, across.1],
            at,
            weights,
            length,
        })
    }

    /// Whether the crease was found on both sides along it.
    fn is_between(&self) -> bool {
        let beyond = |side: f64| self.at.iter().any(|a| side * a[0] > 0.0);
        beyond(1.0) && beyond(-1.0)
    }

    /// Where the curve is next to the middle one.
    fn at_middle(mut self) -> Option<DVec3> {
        let first = self.curve(1)?;
        let off: Vec<f64> = self.at.iter().map(|a| first.off(a)).collect();
        let mut sorted = off.clone();
        let middle = sorted.len() / 2;
        let median = *sorted.select_nth_unstable_by(middle, f64::total_cmp).1;
        let odd = ODD * median.max(f64::MIN_POSITIVE);
        for (weight, off) in self.weights.iter_mut().zip(off) {
            *weight /= (1.0 + (off / odd).powi(2)).powi(2);
        }
        let line = self.curve(1)?;
        let beyond = |side: f64| {
            self.at
                .iter()
                .any(|a| side * a[0] > BOTH_SIDES * self.length)
        };
        let bent = (beyond(1.0) && beyond(-1.0))
            .then(|| self.curve(2))
            .flatten();
        let curve = match bent {
            Some(bent) if bent.squares < BENT * line.squares => bent,
            _ => line,
        };
        let [u, v] = self.across;
        Some(self.origin + u * curve.c[0][0] + v * curve.c[1][0])
    }

    /// The curve of least squares: a line (degree 1) or a parabola (2).
    fn curve(&self, degree: usize) -> Option<Curve> {
        let mut matrix = SMatrix::<f64, 3, 3>::zeros();
        let mut right = SMatrix::<f64, 3, 2>::zeros();
        let row = |a: &[f64; 3]| {
            let s = a[0] / self.length;
            SVector::<f64, 3>::new(1.0, s, if degree == 2 { s * s } else { 0.0 })
        };
        for (a, &weight) in self.at.iter().zip(&self.weights) {
            let row = row(a);
            matrix += weight * row * row.transpose();
            right += weight * row * SVector::<f64, 2>::new(a[1], a[2]).transpose();
        }
        if degree == 1 {
            matrix[(2, 2)] = 1.0;
        }
        let c = nalgebra::Cholesky::new(matrix)?.solve(&right);
        let mut curve = Curve {
            c: [0, 1].map(|k| [c[(0, k)], c[(1, k)], c[(2, k)]]),
            length: self.length,
            squares: 0.0,
        };
        let weighted = self.at.iter().zip(&self.weights);
        curve.squares = weighted
            .map(|(a, weight)| weight * curve.off(a).powi(2))
            .sum();
        Some(curve)
    }
}

/// A curve, and the weighted sum of its squared residuals.
struct Curve {
    c: [[f64; 3]; 2],
    length: f64,
    squares: f64,
}

impl Curve {
    /// Distance of a sample across the crease.
    fn off(&self, a: &[f64; 3]) -> f64 {
        let s = a[0] / self.length;
        let away = |k: usize| a[k + 1] - self.c[k][0] - s * (self.c[k][1] + s * self.c[k][2]);
        away(0).hypot(away(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::Rng;

    /// A crease seen by cells with noise; rms distance to it before and after.
    fn rms(curve: impl Fn(f64) -> DVec3, slope: impl Fn(f64) -> DVec3) -> [f64; 2] {
        let mut rng = Rng::new(2);
        let edge = 0.01;
        let cells: Vec<OnCrease> = (0..80)
            .map(|k| {
                let s = k as f64 * edge;
                let mut off = || 0.2 * edge * rng.normal();
                let point = curve(s) + DVec3::new(off(), off(), off());
                OnCrease {
                    vertex: k,
                    point: point.as_vec3(),
                    along: slope(s).normalize().as_vec3(),
                    normal: Vec3::Z,
                }
            })
            .collect();
        let tree = Octree::build(&cells.iter().map(|c| c.point).collect::<Vec<Vec3>>());
        let away = |p: DVec3| {
            let at = (0..8000).map(|k| curve(0.0001 * k as f64).distance_squared(p));
            at.fold(f64::INFINITY, f64::min)
        };
        let after = |own: &OnCrease| {
            let samples = Samples::of(own, &cells, (&tree, 8.0 * edge, edge), &mut Vec::new());
            samples.unwrap().at_middle().unwrap()
        };
        let (mut sums, inner) = ([0.0; 2], &cells[8..72]);
        for own in inner {
            sums[0] += away(own.point.as_dvec3());
            sums[1] += away(after(own));
        }
        sums.map(|sum| (sum / inner.len() as f64).sqrt())
    }

    #[test]
    fn what_several_cells_tell_is_nearer_to_the_crease() {
        let turn = DVec3::new(0.8, 0.6, 0.0);
        let [before, after] = rms(|s| s * turn, |_| turn);
        assert!(after < 0.45 * before, "{before} {after}");
        let circle = |s: f64| 0.3 * DVec3::new(libm::cos(s / 0.3), libm::sin(s / 0.3), 0.0);
        let along = |s: f64| DVec3::new(-libm::sin(s / 0.3), libm::cos(s / 0.3), 0.0);
        let [before, after] = rms(circle, along);
        assert!(after < 0.6 * before, "{before} {after}");
    }

    #[test]
    fn no_triangle_turns_over() {
        let fan = |tip: Vec3| Mesh {
            vertices: vec![tip, Vec3::X, Vec3::Y, -Vec3::X, -Vec3::Y],
            normals: vec![Vec3::Z; 5],
            triangles: vec![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]],
        };
        let on = |point: Vec3| OnCrease {
            vertex: 0,
            point,
            along: Vec3::ZERO,
            normal: Vec3::Z,
        };
        let mut mesh = fan(Vec3::ZERO);
        straighten(
            &mut mesh,
            &[on(Vec3::new(0.3, 0.0, 0.2))],
            &mut [false; 5],
            (1.0, 0.0),
        );
        assert_eq!(mesh.vertices[0], Vec3::new(0.3, 0.0, 0.2));
        let mut mesh = fan(Vec3::ZERO);
        straighten(
            &mut mesh,
            &[on(Vec3::new(1.4, 0.0, 0.0))],
            &mut [false; 5],
            (2.0, 0.0),
        );
        assert_eq!(mesh.vertices[0], Vec3::new(0.7, 0.0, 0.0));
    }
}
