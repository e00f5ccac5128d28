//! Triangles that cross each other, found by exact predicates and mended where they are.
//!
//! 1. Triangles whose boxes meet are found by an octree of their centres.
//! 2. Around most vertices all triangles look the same way and go around once: those cross nobody who meets them there.
//! 3. Two others cross when an edge of one goes through the inside of the other: signs of determinants decide, which are exact
//!    (J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric predicates", 1997). Triangles
//!    with a common edge do not count, nor do those that only touch.
//! 4. Vertices of triangles that cross take the mean place of their neighbours, a few times, and what they moved is looked at
//!    again: folds open and sheets draw back. What moved farther than that helps is taken back.
//!
//! **Cost**: linear in the triangles; each round of mending builds the octree once more and asks only what moved.

use crate::base::par;
use crate::mesh::boxes::{Boxes, Near};
use crate::mesh::collapse::{VertexTriangles, vertex_triangles};
use crate::mesh::surface::Mesh;
use glam::{DVec3, Vec3};
use robust::{Coord3D, orient3d};

/// Triangles that gather candidates together.
const CELL: usize = 32;
/// Rounds of mending.
const ROUNDS: usize = 6;
/// From this round on the neighbours of those vertices move, too.
const WIDER: usize = 2;
/// Moves a round.
const SWEEPS: usize = 2;

/// Mends triangles that cross others as far as that goes, and returns how many still do.
pub(crate) fn mend(mesh: &mut Mesh) -> usize {
    let mut bad = crossing(mesh, None);
    if bad.is_empty() {
        return 0;
    }
    let around = vertex_triangles(mesh);
    let is_inner = inner(mesh, &around);
    let (mut best, mut least) = (mesh.vertices.clone(), bad.len());
    let mut active = vec![false; mesh.triangles.len()];
    let mut moved = vec![false; mesh.vertices.len()];
    for round in 0..ROUNDS {
        let mut vertices = corners(mesh, bad.iter().copied());
        if round >= WIDER {
            let near = vertices.iter().flat_map(|&v| around.of(v)).copied();
            vertices = corners(mesh, near);
        }
        vertices.retain(|&v| is_inner[v as usize]);
        for _ in 0..SWEEPS {
            let places: Vec<Vec3> = (vertices.iter())
                .map(|&v| mean_of_neighbours(mesh, v, around.of(v)))
                .collect();
            for (&v, place) in vertices.iter().zip(places) {
                mesh.vertices[v as usize] = place;
            }
        }
        for &v in &vertices {
            moved[v as usize] = true;
            let triangles = around.of(v).iter();
            triangles.for_each(|&t| active[t as usize] = true);
        }
        bad.iter().for_each(|&t| active[t as usize] = true);
        bad = crossing(mesh, Some(&active));
        if bad.len() < least {
            least = bad.len();
            best.clone_from(&mesh.vertices);
        }
        if bad.is_empty() {
            break;
        }
    }
    mesh.vertices = best;
    for v in (0..mesh.vertices.len() as u32).filter(|&v| moved[v as usize]) {
        let sum: DVec3 = around
            .of(v)
            .iter()
            .map(|&t| mesh.cross(mesh.triangles[t as usize]))
            .sum();
        if sum != DVec3::ZERO {
            mesh.normals[v as usize] = sum.normalize().as_vec3();
        }
    }
    least
}

/// Which vertices have only inner edges: they may move.
fn inner(mesh: &Mesh, around: &VertexTriangles) -> Vec<bool> {
    let is_inner = |v: u32| {
        // Of a closed fan every neighbour is once the next and once the one before.
        let next_and_previous = |&t: &u32| {
            let t = mesh.triangles[t as usize];
            let k = t.iter().position(|&w| w == v).unwrap_or(0);
            [u64::from(t[(k + 1) % 3]), u64::from(t[(k + 2) % 3])]
        };
        let pairs = around.of(v).iter().map(next_and_previous);
        let (next, previous) = pairs.fold((0u64, 0u64), |(a, b), [n, p]| {
            (a.wrapping_add(n * n + n), b.wrapping_add(p * p + p))
        });
        next == previous
    };
    (0..mesh.vertices.len() as u32).map(is_inner).collect()
}

/// Corners of some triangles, ascending.
fn corners(mesh: &Mesh, triangles: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut corners: Vec<u32> = triangles.flat_map(|t| mesh.triangles[t as usize]).collect();
    corners.sort_unstable();
    corners.dedup();
    corners
}

fn mean_of_neighbours(mesh: &Mesh, v: u32, triangles: &[u32]) -> Vec3 {
    let at = |v: u32| mesh.vertices[v as usize].as_dvec3();
    let all = triangles.iter().flat_map(|&t| mesh.triangles[t as usize]);
    // Around an inner vertex each neighbour is in two of the triangles.
    let others = all.filter(|&w| w != v).map(at).sum::<DVec3>();
    (others / (2 * triangles.len()) as f64).as_vec3()
}

/// The triangles that cross another, ascending; where some are `active`, only those of pairs with one of them.
fn crossing(mesh: &Mesh, active: Option<&[bool]>) -> Vec<u32> {
    let boxes = Boxes::new(mesh);
    let plain = plain(mesh);
    let name = |i: usize| boxes.tree.order[i];
    let asked = |i: &usize| active.is_none_or(|active| active[name(*i) as usize]);
    let cells = boxes.tree.cut(|node| node.range().len() <= CELL);
    let of_cell = |c: usize, near: &mut Near| {
        let own: Vec<usize> = cells[c].clone().filter(asked).collect();
        let all = own.iter().map(|&i| boxes.boxes[i]);
        let Some(bounds) = all.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))) else {
            return Vec::new();
        };
        boxes.near(bounds, near);
        let mut bad = Vec::new();
        for &i in &own {
            for j in near.meeting(boxes.boxes[i]) {
                // Of two that are asked the first one answers.
                if j == i || j < i && asked(&j) {
                    continue;
                }
                if cross_each_other(mesh, &plain, name(i), name(j)) {
                    bad.extend([name(i), name(j)]);
                }
            }
        }
        bad
    };
    let mut bad = par::map(cells.len(), Near::default, of_cell).concat();
    bad.sort_unstable();
    bad.dedup();
    bad
}

/// The vertices around which the triangles go once and look the same way, seen along the sum of their normals: seen so they lie side
/// by side, and those that have only this vertex in common do not cross.
fn plain(mesh: &Mesh) -> Vec<bool> {
    /// Cosine between a triangle's normal and the sum of them: far more than rounding.
    const TURNED: f64 = 1e-3;
    #[derive(Clone, Copy, Default)]
    struct Fan {
        normal: DVec3,
        /// Sums over the next and over the last vertices of all triangles: equal where the fan is closed.
        next: u64,
        last: u64,
        /// Triangles that cross the half line from which turns are counted.
        turns: u32,
        turned: bool,
    }
    let mut fans = vec![Fan::default(); mesh.vertices.len()];
    let crosses: Vec<DVec3> = mesh.triangles.iter().map(|&t| mesh.cross(t)).collect();
    let term = |v: u32| u64::from(v) * u64::from(v) + u64::from(v);
    for (triangle, &cross) in mesh.triangles.iter().zip(&crosses) {
        for k in 0..3 {
            let fan = &mut fans[triangle[k] as usize];
            fan.normal += cross;
            fan.next = fan.next.wrapping_add(term(triangle[(k + 1) % 3]));
            fan.last = fan.last.wrapping_add(term(triangle[(k + 2) % 3]));
        }
    }
    for (triangle, &cross) in mesh.triangles.iter().zip(&crosses) {
        let corners = triangle.map(|v| mesh.vertices[v as usize].as_dvec3());
        for k in 0..3 {
            let fan = &mut fans[triangle[k] as usize];
            let up = fan.normal.any_orthogonal_vector();
            let side = |of: DVec3| (of - corners[k]).dot(up) > 0.0;
            fan.turns += u32::from(!side(corners[(k + 1) % 3]) && side(corners[(k + 2) % 3]));
            let least = TURNED * (cross.length_squared() * fan.normal.length_squared()).sqrt();
            fan.turned |= cross.dot(fan.normal) <= least;
        }
    }
    let is_plain = |fan: &Fan| fan.next == fan.last && fan.turns == 1 && !fan.turned;
    fans.iter().map(is_plain).collect()
}

/// Whether an edge of one triangle goes through the inside of the other.
fn cross_each_other(mesh: &Mesh, plain: &[bool], a: u32, b: u32) -> bool {
    let [a, b] = [a, b].map(|t| mesh.triangles[t as usize]);
    let both = || a.iter().filter(|v| b.contains(v));
    let common = both().count();
    if common > 1 || both().any(|&v| plain[v as usize]) {
        return false;
    }
    let of_a = sides(mesh, a, b);
    // Wholly on one side, it meets the other's plane at a common corner at most.
    let apart = 3 - common;
    if [1.0, -1.0]
        .map(|s| of_a.iter().filter(|x| s * **x > 0.0).count())
        .contains(&apart)
    {
        return false;
    }
    pierces(mesh, (a, of_a), b) || pierces(mesh, (b, sides(mesh, b, a)), a)
}

fn coordinates(mesh: &Mesh, triangle: [u32; 3]) -> [Coord3D<f64>; 3] {
    triangle.map(|v| {
        let [x, y, z] = mesh.vertices[v as usize].as_dvec3().to_array();
        Coord3D { x, y, z }
    })
}

/// On which side of the plane of `b` each corner of `a` is, by sign; 0 for one that both have.
fn sides(mesh: &Mesh, a: [u32; 3], b: [u32; 3]) -> [f64; 3] {
    let [p, q, r] = coordinates(mesh, b);
    let corners = coordinates(mesh, a);
    [0, 1, 2].map(|k| {
        if b.contains(&a[k]) {
            0.0
        } else {
            orient3d(p, q, r, corners[k])
        }
    })
}

/// Whether an edge of `a`, whose corners are on these sides of the plane of `b`, goes through the inside of `b`.
fn pierces(mesh: &Mesh, (a, side): ([u32; 3], [f64; 3]), b: [u32; 3]) -> bool {
    let (corners, plane) = (coordinates(mesh, a), coordinates(mesh, b));
    (0..3).any(|k| {
        let next = (k + 1) % 3;
        let (from, to) = (side[k], side[next]);
        if !(from > 0.0 && to < 0.0 || from < 0.0 && to > 0.0) {
            return false;
        }
        let (p, q) = (corners[k], corners[next]);
        let around = [0, 1, 2].map(|m| orient3d(p, q, plane[m], plane[(m + 1) % 3]));
        around.iter().all(|&x| x > 0.0) || around.iter().all(|&x| x < 0.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::topology::{topology, volume};

    /// A sheet of 2 n² triangles over the unit square, at these heights.
    fn sheet(n: u32, height: impl Fn(f32, f32) -> f32) -> Mesh {
        let mut mesh = Mesh::default();
        for i in 0..=n {
            for j in 0..=n {
                let (x, y) = (i as f32 / n as f32 - 0.5, j as f32 / n as f32 - 0.5);
                mesh.vertices.push(Vec3::new(x, y, height(x, y)));
                mesh.normals.push(Vec3::Z);
                if i < n && j < n {
                    let v = i * (n + 1) + j;
                    let (right, up) = (v + n + 1, v + 1);
                    mesh.triangles
                        .extend([[v, right, right + 1], [v, right + 1, up]]);
                }
            }
        }
        mesh
    }

    fn both(mut a: Mesh, b: &Mesh) -> Mesh {
        let first = a.vertices.len() as u32;
        a.vertices.extend(&b.vertices);
        a.normals.extend(&b.normals);
        a.triangles
            .extend(b.triangles.iter().map(|t| t.map(|v| v + first)));
        a
    }

    /// The triangles of all pairs that cross.
    fn naive(mesh: &Mesh) -> Vec<u32> {
        let n = mesh.triangles.len() as u32;
        let none = vec![false; mesh.vertices.len()];
        let mut bad: Vec<u32> = (0..n)
            .flat_map(|a| (a + 1..n).map(move |b| (a, b)))
            .filter(|&(a, b)| cross_each_other(mesh, &none, a, b))
            .flat_map(|(a, b)| [a, b])
            .collect();
        bad.sort_unstable();
        bad.dedup();
        bad
    }

    #[test]
    fn crossings_around_a_vertex_are_found() {
        for amount in [0.02, 0.06, 0.2] {
            let mut mesh = sheet(14, |x, y| 0.2 * x * y);
            let mut seed = 1u32;
            let mut random = || {
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (seed >> 8) as f32 / (1 << 24) as f32 - 0.5
            };
            for v in &mut mesh.vertices {
                *v += amount * Vec3::new(random(), random(), random());
            }
            let naive = naive(&mesh);
            assert_eq!(naive.is_empty(), amount < 0.05);
            assert_eq!(crossing(&mesh, None), naive);
            let plain = plain(&mesh).iter().filter(|&&plain| plain).count();
            assert_eq!(
                plain == 13 * 13,
                amount < 0.05,
                "{plain} of the inner vertices"
            );
        }
    }

    #[test]
    fn crossings_are_those_of_all_pairs() {
        let bent = sheet(12, |x, y| 0.3 * x + 0.2 * y * y - 0.013);
        let mesh = both(sheet(10, |_, _| 0.0), &bent);
        let naive = naive(&mesh);
        assert!(naive.len() > 30);
        assert_eq!(crossing(&mesh, None), naive);
        let all = vec![true; mesh.triangles.len()];
        assert_eq!(crossing(&mesh, Some(&all)), naive);
        assert!(crossing(&mesh, Some(&vec![false; all.len()])).is_empty());
        // Sheets that touch or share edges do not cross.
        let touching = both(sheet(10, |_, _| 0.0), &sheet(10, |_, _| 0.0));
        assert!(crossing(&touching, None).is_empty());
    }

    #[test]
    fn folds_are_opened_and_nothing_else_moves() {
        let mut mesh = both(
            sheet(20, |x, y| 0.1 * x * y),
            &sheet(20, |x, y| 0.1 * x * y + 0.03),
        );
        let before = mesh.clone();
        assert_eq!(mend(&mut mesh), 0);
        assert_eq!(mesh, before);
        // A vertex that goes through the sheet above.
        let folded = 10 * 21 + 10;
        mesh.vertices[folded] += Vec3::new(0.012, 0.007, 0.08);
        assert!(!crossing(&mesh, None).is_empty());
        assert_eq!(mend(&mut mesh), 0);
        let far = |i: usize| before.vertices[i].distance(before.vertices[folded]) > 0.3;
        assert!(
            (0..mesh.vertices.len()).all(|i| !far(i) || mesh.vertices[i] == before.vertices[i])
        );
        assert!(topology(&mesh.triangles, mesh.vertices.len()).is_manifold());
        assert!(volume(&mesh.vertices, &mesh.triangles).is_finite());
    }
}
