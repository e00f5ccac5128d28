//! A flat base: a surface that stands on a floor ends in it.
//!
//! 1. What reaches below the floor is cut off: an open surface ends a little beyond its points.
//! 2. A rim stands on the floor where what would close it looks down, and its lowest vertex is near the floor.
//! 3. A wall of triangles goes straight down from it. Its lower rim is in the plane of the floor, so that the membrane over it
//!    (`caps`) is flat.
//!
//! Where a rim overhangs itself, its wall may cross itself.

use crate::base::sets::Sets;
use crate::base::sort_keys::pack;
use crate::mesh::caps::{self, Rim};
use crate::mesh::surface::Mesh;
use glam::{DVec3, Vec3};
use std::collections::BTreeMap;

/// Cosine of the angle between straight down and the normal of what would close a rim, at least.
const DOWN: f64 = 0.5;
/// A rim stands on the floor when its lowest vertex is at most this share of its diameter over it,
const NEAR: f64 = 0.2;
/// or this many of its edges.
const EDGES: f64 = 4.0;
/// Rims nearer to the floor than this many of their edges are moved onto it: a wall would be slivers.
const ON_IT: f64 = 0.1;
/// A cut edge is cut at least this share of its length from its ends.
const END: f64 = 0.05;
/// The most rows of a wall.
const ROWS: f64 = 64.0;

/// What a surface stands on, in the unit frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ground {
    /// Unit, up.
    pub normal: DVec3,
    /// Where the floor is along the normal; `None`: at the lowest vertex.
    pub height: Option<f64>,
}

/// Ends the surface in the ground, where it stands on it, and returns its rims as they are then.
pub(crate) fn stand(mesh: &mut Mesh, ground: &Ground) -> Vec<Rim> {
    let up = ground.normal;
    let over = |v: &Vec3| v.as_dvec3().dot(up);
    let floor = (ground.height)
        .unwrap_or_else(|| mesh.vertices.iter().map(over).fold(f64::INFINITY, f64::min));
    cut(mesh, up, floor);
    drop_crumbs(mesh, up, floor);
    mesh.drop_unused();
    let mut rims = caps::rims(mesh);
    for rim in &mut rims {
        if stands(mesh, rim, up, floor) {
            *rim = wall(mesh, rim, up, floor);
        }
    }
    rims
}

/// Cuts off what is below the floor.
fn cut(mesh: &mut Mesh, up: DVec3, floor: f64) {
    let heights: Vec<f64> = (mesh.vertices.iter())
        .map(|v| v.as_dvec3().dot(up) - floor)
        .collect();
    let is_over = |v: u32| heights[v as usize] >= 0.0;
    let mut cuts: BTreeMap<u64, u32> = BTreeMap::new();
    let mut whole = std::mem::take(&mut mesh.triangles);
    // The corner that is alone on its side comes first.
    for t in &mut whole {
        let alone = (0..3).find(|&k| {
            is_over(t[k]) != is_over(t[(k + 1) % 3]) && is_over(t[k]) != is_over(t[(k + 2) % 3])
        });
        t.rotate_left(alone.unwrap_or(0));
    }
    for [a, b, c] in whole {
        let mut between = |a: u32, b: u32| {
            let (a, b) = (a.min(b), a.max(b));
            *cuts.entry(pack(a, b)).or_insert_with(|| {
                let [p, q] = [a, b].map(|v| mesh.vertices[v as usize].as_dvec3());
                let [h, k] = [a, b].map(|v| heights[v as usize]);
                let at = p.lerp(q, (h / (h - k)).clamp(END, 1.0 - END));
                let [m, n] = [a, b].map(|v| mesh.normals[v as usize]);
                mesh.vertices
                    .push((at - (at.dot(up) - floor) * up).as_vec3());
                mesh.normals.push((m + n).normalize_or(m));
                mesh.vertices.len() as u32 - 1
            })
        };
        match (is_over(a), is_over(b)) {
            (over, other) if over == other => {
                if over {
                    mesh.triangles.push([a, b, c]);
                }
            }
            (true, _) => {
                let (p, q) = (between(a, b), between(c, a));
                mesh.triangles.push([a, p, q]);
            }
            (false, _) => {
                let (p, q) = (between(a, b), between(c, a));
                mesh.triangles.extend([[p, b, c], [p, c, q]]);
            }
        }
    }
}

/// Drops what the cut left of hems that hung through the floor: all but the largest piece that is lower than a few edges.
fn drop_crumbs(mesh: &mut Mesh, up: DVec3, floor: f64) {
    let mut sets = Sets::new(mesh.vertices.len());
    for &[a, b, c] in &mesh.triangles {
        sets.join(a, b);
        sets.join(b, c);
    }
    let mut pieces: BTreeMap<u32, (usize, f64, f64)> = BTreeMap::new();
    for &t in &mesh.triangles {
        let corners = t.map(|v| mesh.vertices[v as usize].as_dvec3());
        let highest = corners
            .iter()
            .map(|p| p.dot(up) - floor)
            .fold(0.0, f64::max);
        let (count, top, length) = pieces.entry(sets.find(t[0])).or_default();
        *count += 1;
        *top = highest.max(*top);
        *length += corners[0].distance(corners[1]);
    }
    let most = pieces.values().map(|(count, ..)| *count).max();
    let stays = |&(count, top, length): &(usize, f64, f64)| {
        Some(count) == most || top > EDGES * length / count as f64
    };
    (mesh.triangles).retain(|t| pieces.get(&sets.find(t[0])).is_some_and(stays));
}

/// Mean length of a rim's edges.
fn edge(mesh: &Mesh, rim: &[u32]) -> f64 {
    let at = |v: u32| mesh.vertices[v as usize].as_dvec3();
    let next = rim.iter().cycle().skip(1);
    let lengths = rim.iter().zip(next).map(|(&a, &b)| at(a).distance(at(b)));
    lengths.sum::<f64>() / rim.len() as f64
}

/// Whether a surface stands on the floor with this rim.
fn stands(mesh: &Mesh, rim: &[u32], up: DVec3, floor: f64) -> bool {
    let at = |v: u32| mesh.vertices[v as usize].as_dvec3();
    let lid = caps::across(at, rim).normalize_or_zero();
    let heights = rim.iter().map(|&v| at(v).dot(up) - floor);
    let lowest = heights.fold(f64::INFINITY, f64::min);
    let near = (NEAR * caps::diameter(mesh, rim)).max(EDGES * edge(mesh, rim));
    lid.dot(up) < -DOWN && lowest.abs() < near
}

/// A wall from a rim straight down to the floor, and its lower rim.
fn wall(mesh: &mut Mesh, rim: &[u32], up: DVec3, floor: f64) -> Rim {
    let n = rim.len();
    let edge = edge(mesh, rim);
    let at: Vec<DVec3> = (rim.iter().map(|&v| mesh.vertices[v as usize].as_dvec3())).collect();
    let heights: Vec<f64> = at.iter().map(|p| p.dot(up) - floor).collect();
    let stands: Vec<bool> = heights.iter().map(|&h| h < ON_IT * edge).collect();
    for i in (0..n).filter(|&i| stands[i]) {
        mesh.vertices[rim[i] as usize] = (at[i] - heights[i] * up).as_vec3();
    }
    let height = heights.iter().sum::<f64>() / n as f64;
    let rows = (height / edge).round().clamp(1.0, ROWS);
    let mut above = rim.to_vec();
    for row in 1..=rows as u32 {
        let share = f64::from(row) / rows;
        let mut below = above.clone();
        for i in (0..n).filter(|&i| !stands[i]) {
            // The surface is at the left of its rim, seen from outside: out is at the right of the way back, seen from above.
            let out = up.cross(at[(i + n - 1) % n] - at[(i + 1) % n]);
            below[i] = mesh.vertices.len() as u32;
            let down = at[i] - share * heights[i] * up;
            mesh.vertices.push(down.as_vec3());
            mesh.normals.push(out.normalize_or(up).as_vec3());
        }
        for i in 0..n {
            let j = (i + 1) % n;
            let (a, b, c, d) = (above[i], above[j], below[i], below[j]);
            let whole = [[b, a, c], [b, c, d]].into_iter();
            mesh.triangles
                .extend(whole.filter(|[a, b, c]| a != b && b != c && c != a));
        }
        above = below;
    }
    above
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::topology::{topology, volume};

    /// A tube of two rows, open at both ends, from `low` to 0.5 over the floor, 0.3 wide; its lower rim waves by `wave`.
    fn tube(low: f64, wave: f64) -> Mesh {
        let n = 60u32;
        let mut mesh = Mesh::default();
        for row in 0..3 {
            for i in 0..n {
                let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
                let foot = low + wave * libm::cos(3.0 * angle);
                let z = foot + (0.5 - foot) * f64::from(row) / 2.0;
                let p = DVec3::new(0.15 * libm::cos(angle), 0.15 * libm::sin(angle), z);
                mesh.vertices.push(p.as_vec3());
            }
        }
        mesh.normals = vec![Vec3::Z; mesh.vertices.len()];
        for (row, i) in (0..2).flat_map(|row| (0..n).map(move |i| (row, i))) {
            let at = |row: u32, i: u32| row * n + i % n;
            let (a, b) = (at(row, i), at(row, i + 1));
            let (c, d) = (at(row + 1, i + 1), at(row + 1, i));
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
        mesh
    }

    fn based(mut mesh: Mesh, height: Option<f64>) -> Mesh {
        let normal = DVec3::Z;
        let rims = stand(&mut mesh, &Ground { normal, height });
        caps::close(&mut mesh, &rims);
        let found = topology(&mesh.triangles, mesh.vertices.len());
        assert!(found.is_manifold() && found.boundary_edges == 0);
        assert_eq!((found.components, &found.genus[..]), (1, &[0][..]));
        mesh
    }

    fn lowest(mesh: &Mesh) -> f32 {
        mesh.vertices.iter().fold(f32::INFINITY, |z, v| z.min(v.z))
    }

    /// Area of the regular polygon that the tube is.
    const ROUND: f64 = 30.0 * 0.15 * 0.15 * 0.104_528_463_267_653_47;

    #[test]
    fn a_wavy_foot_over_the_floor_goes_straight_down_to_it() {
        let mesh = based(tube(0.04, 0.02), Some(0.0));
        assert!(lowest(&mesh).abs() < 1e-7);
        let inside = volume(&mesh.vertices, &mesh.triangles);
        assert!((inside / (0.5 * ROUND) - 1.0).abs() < 1e-3, "{inside}");
        let down = mesh.normals.iter().filter(|n| n.z < -0.999).count();
        assert!(down > 20, "the base looks down: {down}");
    }

    #[test]
    fn what_is_below_the_floor_is_cut_off() {
        for wave in [0.0, 0.005, 0.04] {
            let mesh = based(tube(-0.01, wave), Some(0.0));
            assert!(lowest(&mesh).abs() < 1e-7, "{wave}: {}", lowest(&mesh));
            let inside = volume(&mesh.vertices, &mesh.triangles);
            assert!((inside / (0.5 * ROUND) - 1.0).abs() < 2e-3, "{inside}");
        }
    }

    #[test]
    fn without_a_floor_the_base_is_at_the_lowest_vertex() {
        let mesh = based(tube(0.1, 0.02), None);
        assert!((lowest(&mesh) - 0.08).abs() < 5e-3, "{}", lowest(&mesh));
    }

    #[test]
    fn a_rim_that_is_far_over_the_floor_gets_a_membrane() {
        let mesh = based(tube(0.2, 0.0), Some(0.0));
        assert!((lowest(&mesh) - 0.2).abs() < 1e-6);
    }
}
