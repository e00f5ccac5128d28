//! Straightens creases: moves each vertex on a crease onto a curve that is fitted to the crease around it.
//!
//! Each cell finds the crease from its own tangent planes, so that noise makes it wavy, and keeps its vertex inside of the cell,
//! beside which the crease may run. So once the triangles are there:
//!
//! 1. The crease next to a vertex is where the surfaces on both sides of it meet ([`crate::mesh::sides`]).
//! 2. Around each vertex a line or a parabola is fitted to what the cells along the crease found, over a length that follows
//!    the noise, as long as several sub-domains (moving least squares: D. Levin, "Mesh-independent surface interpolation",
//!    2003).
//! 3. Between such vertices the crease runs on: where the surface is cut off there, the nearest vertices go onto it as well.
//! 4. Vertices beside them go to the side that they are on, as far as they were rounded off.
//! 5. Edges across the crease are flipped to lie along it ([`crate::mesh::flips`]).
//!
//! No vertex moves where a triangle would turn over.

use crate::base::par;
use crate::cloud::octree::Octree;
use crate::mesh::collapse::{SLIVER_SINE2, Shape, VertexTriangles, vertex_triangles};
use crate::mesh::curves::{OnCrease, Samples};
use crate::mesh::flips::flip;
use crate::mesh::sides::{self, Rings, Sides};
use crate::mesh::surface::Mesh;
use glam::{DVec3, Vec3};

/// Half of the length that a curve is fitted over, in edges of the lattice: without noise, what is added for noise of one edge,
/// and at most.
const LENGTH: [f64; 3] = [4.0, 40.0, 14.0];
/// Noise, in edges, under which every cell knows the crease best.
const QUIET: f64 = 0.03;
/// Noise, as a fraction of the diagonal, under which creases are straight already.
const LEAST_NOISE: f64 = 1e-4;
/// Largest move in edges.
const FARTHEST: f64 = 1.0;
/// Corners nearer than this, in edges, leave a cell's own crease as it is.
const CORNER: f64 = 3.0;
/// Cosine of the least turn to a crease that runs another way: 45°.
const ONE_WAY: f32 = 0.7;
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

/// Moves the vertices of a mesh onto their creases, and those between them that cut a crease off; marks all as `on_crease`.
/// `edge` is the edge length of the lattice, `noise` that of the surface.
pub(crate) fn straighten(
    mesh: &mut Mesh,
    creases: &[OnCrease],
    (on_crease, at_end): (&mut [bool], &[bool]),
    (edge, noise): (f64, f64),
) {
    if creases.is_empty() || noise < LEAST_NOISE {
        return;
    }
    let around = vertex_triangles(mesh);
    creases
        .iter()
        .for_each(|c| on_crease[c.vertex as usize] = true);
    let near_corner = near_corners(creases, edge);
    let sides = par::map(creases.len(), Rings::default, |k, rings| {
        let known = (&*mesh, &around, &*on_crease);
        let is_line = !near_corner[k];
        is_line
            .then(|| sides::meet(&creases[k], known, edge, rings))
            .flatten()
    });
    let met = creases.iter().zip(&sides).map(|(own, sides)| OnCrease {
        point: sides.map_or(own.point, |sides| sides.point.as_vec3()),
        ..*own
    });
    let creases = &met.collect::<Vec<OnCrease>>();
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
    for (own, target) in creases.iter().zip(targets) {
        let v = own.vertex as usize;
        if f64::from(target.distance(mesh.vertices[v])) <= FARTHEST * edge {
            move_to(mesh, &around, own.vertex, target);
        }
    }
    let stays: Vec<bool> = on_crease
        .iter()
        .zip(at_end)
        .map(|(a, b)| *a || *b)
        .collect();
    fill_up(mesh, &around, (creases, &sides, &stays), edge);
    let length = length.max(GAP * edge);
    let mut beside = cut_off(mesh, (creases, &near_corner), &stays, (&tree, length, edge));
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
    flip(mesh, &around, on_crease);
}

/// Which cells are at a corner, or see another crease nearby that runs another way: sides there are of more than two faces.
fn near_corners(creases: &[OnCrease], edge: f64) -> Vec<bool> {
    let points: Vec<Vec3> = creases.iter().map(|c| c.point).collect();
    let tree = Octree::build(&points);
    let reach = (CORNER * edge) as f32;
    par::map(creases.len(), Vec::new, |k, found: &mut Vec<u32>| {
        let own = &creases[k];
        found.clear();
        tree.gather(own.point - reach, own.point + reach, usize::MAX, found);
        let other = |&j: &u32| {
            let along = creases[tree.order[j as usize] as usize].along;
            along.dot(own.along).abs() < ONE_WAY
        };
        own.along == Vec3::ZERO || found.iter().any(other)
    })
}

/// Moves the vertices next to those on creases to the sides from which a crease was rounded off.
fn fill_up(
    mesh: &mut Mesh,
    around: &VertexTriangles,
    (creases, sides, stays): (&[OnCrease], &[Option<Sides>], &[bool]),
    edge: f64,
) {
    let mut feet: Vec<(u32, DVec3, DVec3)> = Vec::new();
    for (own, sides) in creases.iter().zip(sides) {
        let Some(sides) = sides else { continue };
        for &t in around.of(own.vertex) {
            for w in mesh.triangles[t as usize] {
                let foot = sides.foot(mesh.vertices[w as usize].as_dvec3(), edge);
                let free = foot.filter(|_| !stays[w as usize]);
                feet.extend(free.map(|(at, normal)| (w, at, normal)));
            }
        }
    }
    feet.sort_by_key(|foot| foot.0);
    for of_vertex in feet.chunk_by(|a, b| a.0 == b.0) {
        let v = of_vertex[0].0;
        let mean = of_vertex.iter().map(|f| f.1).sum::<DVec3>() / of_vertex.len() as f64;
        let normal = of_vertex.iter().map(|f| f.2).sum::<DVec3>();
        if move_to(mesh, around, v, mean.as_vec3()) {
            let own = &mut mesh.normals[v as usize];
            *own = normal.as_vec3().normalize_or(*own);
        }
    }
}

/// Vertices beside a crease, where the surface turns from one of its sides to the other but no cell found it: how far from it,
/// and where it runs, between cells that did find it.
fn cut_off(
    mesh: &Mesh,
    (creases, near_corner): (&[OnCrease], &[bool]),
    stays: &[bool],
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
    let is_free = |v: &u32| turns[*v as usize] && !stays[*v as usize];
    let free: Vec<u32> = (0..turns.len() as u32).filter(is_free).collect();
    let found = par::map(free.len(), Vec::new, |k, found| {
        let vertex = free[k];
        let point = mesh.vertices[vertex as usize];
        let nearest = tree.order[tree.nearest(point).index as usize] as usize;
        if near_corner[nearest] {
            return None;
        }
        let nearest = &creases[nearest];
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

/// Moves a vertex, by half of the way or not at all where a triangle would turn over or get an angle under 5°; whether it moved.
fn move_to(mesh: &mut Mesh, around: &VertexTriangles, v: u32, target: Vec3) -> bool {
    let from = mesh.vertices[v as usize];
    for share in [1.0, 0.5] {
        let to = from + share * (target - from);
        let stays = around.of(v).iter().all(|&t| {
            let corners = mesh.triangles[t as usize];
            let at = |w: u32| mesh.vertices[w as usize].as_dvec3();
            let before = Shape::of(corners.map(at));
            let after = Shape::of(corners.map(|w| if w == v { to.as_dvec3() } else { at(w) }));
            let (old, new) = (before.cross, after.cross);
            let facing =
                old.dot(new) >= TURNED * (old.length_squared() * new.length_squared()).sqrt();
            facing && after.sine2() >= SLIVER_SINE2.min(before.sine2())
        });
        if stays {
            mesh.vertices[v as usize] = to;
            return true;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

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
            (&mut [false; 5], &[false; 5]),
            (1.0, LEAST_NOISE),
        );
        assert_eq!(mesh.vertices[0], Vec3::new(0.3, 0.0, 0.2));
        let mut mesh = fan(Vec3::ZERO);
        straighten(
            &mut mesh,
            &[on(Vec3::new(1.4, 0.0, 0.0))],
            (&mut [false; 5], &[false; 5]),
            (2.0, LEAST_NOISE),
        );
        assert_eq!(mesh.vertices[0], Vec3::new(0.7, 0.0, 0.0));
    }
}
