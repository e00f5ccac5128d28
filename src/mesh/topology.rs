//! Connectivity, volume and area of a triangle mesh.

use crate::base::groups::Groups;
use crate::base::sets::Sets;
use crate::base::sort_keys::{pack, unpack};
use glam::{DVec3, Vec3};
use serde::Serialize;

/// The connectivity of a triangle mesh.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Topology {
    /// Sets of triangles that are joined by shared vertices.
    pub components: usize,
    /// Edges with one triangle.
    pub boundary_edges: usize,
    /// Edges with more than two triangles.
    pub non_manifold_edges: usize,
    /// Vertices whose triangles are not one fan, open or closed.
    pub non_manifold_vertices: usize,
    /// Edges that their two triangles run through in the same direction.
    pub inconsistent_edges: usize,
    /// One a component, the largest (by triangles, then by first triangle) first: (2 - b - V + E - F) / 2 with b
    /// boundary loops, which for an open component is the genus that it has once every loop is capped by a disk.
    pub genus: Vec<i64>,
    /// Triangles that name a vertex twice.
    pub degenerate: usize,
    /// Triangles whose three vertices an earlier triangle has too.
    pub duplicate: usize,
}

impl Topology {
    /// Whether the mesh is a consistently oriented 2-manifold, with or without boundary.
    pub fn is_manifold(&self) -> bool {
        self.non_manifold_edges
            + self.non_manifold_vertices
            + self.inconsistent_edges
            + self.degenerate
            + self.duplicate
            == 0
    }
}

/// Counts what [`Topology`] holds. Vertices that no triangle names are ignored; indices must be under `vertex_count`.
pub fn topology(triangles: &[[u32; 3]], vertex_count: usize) -> Topology {
    let mut t = Topology {
        degenerate: triangles
            .iter()
            .filter(|[a, b, c]| a == b || b == c || c == a)
            .count(),
        duplicate: count_duplicates(triangles, vertex_count),
        ..Topology::default()
    };
    let mut joined = Sets::new(vertex_count);
    for &[a, b, c] in triangles {
        joined.join(a, b);
        joined.join(a, c);
    }
    let (component, count) = joined.numbered();
    let mut euler = vec![0i64; count];
    // A corner is one vertex of one triangle (3 t + i); corners of one vertex are joined across shared edges.
    let mut corners = Sets::new(3 * triangles.len());
    let mut loops = Sets::new(vertex_count);
    let mut on_boundary = vec![false; vertex_count];
    for (lo, sides) in (0u32..).zip(half_edges(triangles, vertex_count).iter()) {
        for edge in sides.chunk_by(|a, b| unpack(*a).0 == unpack(*b).0) {
            let first = HalfEdge::unpack(edge[0]);
            let hi = first.hi;
            if lo == hi {
                continue;
            }
            euler[component[lo as usize] as usize] -= 1;
            match edge {
                [_] => {
                    t.boundary_edges += 1;
                    loops.join(lo, hi);
                    on_boundary[lo as usize] = true;
                    on_boundary[hi as usize] = true;
                }
                [_, second] => {
                    let second = HalfEdge::unpack(*second);
                    t.inconsistent_edges += usize::from(first.forward == second.forward);
                }
                _ => t.non_manifold_edges += 1,
            }
            for other in edge[1..].iter().map(|&side| HalfEdge::unpack(side)) {
                for v in [lo, hi] {
                    corners.join(first.corner_at(v, triangles), other.corner_at(v, triangles));
                }
            }
        }
    }
    // Triangles of each component, and its first one.
    let mut size = vec![(0u32, u32::MAX); count];
    let mut fans = vec![0u32; vertex_count];
    for (i, triangle) in (0u32..).zip(triangles) {
        let c = component[triangle[0] as usize] as usize;
        euler[c] += 1;
        size[c] = (size[c].0 + 1, size[c].1.min(i));
        for (corner, &v) in (3 * i..).zip(triangle) {
            fans[v as usize] += u32::from(corners.find(corner) == corner);
        }
    }
    for v in (0..vertex_count).filter(|&v| fans[v] > 0) {
        t.non_manifold_vertices += usize::from(fans[v] > 1);
        // A boundary loop counts as one more face: the disk that caps it.
        let caps = on_boundary[v] && loops.find(v as u32) == v as u32;
        euler[component[v] as usize] += 1 + i64::from(caps);
    }
    // Largest first.
    let there = size.iter().filter(|(triangles, _)| *triangles > 0);
    let mut order: Vec<u64> = there.map(|&(size, first)| pack(!size, first)).collect();
    order.sort_unstable();
    t.components = order.len();
    let of_first = |&packed: &u64| component[triangles[unpack(packed).1 as usize][0] as usize];
    let genus = |c: u32| (2 - euler[c as usize]) / 2;
    t.genus = order.iter().map(|first| genus(of_first(first))).collect();
    t
}

/// One triangle's side of an edge between vertices `lo` ≤ `hi`.
#[derive(Clone, Copy)]
struct HalfEdge {
    hi: u32,
    triangle: u32,
    /// The triangle runs from `lo` to `hi`.
    forward: bool,
}

impl HalfEdge {
    /// As a number that is ordered by `hi`, then by the triangle.
    fn pack(self) -> u64 {
        pack(self.hi, self.triangle << 1 | u32::from(self.forward))
    }

    fn unpack(packed: u64) -> HalfEdge {
        let (hi, side) = unpack(packed);
        HalfEdge {
            hi,
            triangle: side >> 1,
            forward: side & 1 == 1,
        }
    }

    /// The corner of this triangle at vertex `v`.
    fn corner_at(self, v: u32, triangles: &[[u32; 3]]) -> u32 {
        let corners = triangles[self.triangle as usize];
        let place = corners.iter().position(|&w| w == v).unwrap_or(0);
        3 * self.triangle + place as u32
    }
}

/// The half-edges of each vertex `lo`, packed: those of one edge are neighbours.
fn half_edges(triangles: &[[u32; 3]], vertex_count: usize) -> Groups<u64> {
    let mut sorted = Groups::new(vertex_count, || {
        let numbered = triangles.iter().zip(0u32..);
        numbered.flat_map(|(&[a, b, c], triangle)| {
            [(a, b), (b, c), (c, a)].map(|(from, to)| {
                let half_edge = HalfEdge {
                    hi: from.max(to),
                    triangle,
                    forward: from < to,
                };
                (from.min(to), half_edge.pack())
            })
        })
    });
    for lo in 0..vertex_count as u32 {
        sorted.of_mut(lo).sort_unstable();
    }
    sorted
}

fn count_duplicates(triangles: &[[u32; 3]], vertex_count: usize) -> usize {
    let mut first = vec![u32::MAX; vertex_count];
    let mut next = vec![u32::MAX; triangles.len()];
    let sorted = |i: usize| {
        let mut t = triangles[i];
        t.sort_unstable();
        t
    };
    let mut duplicates = 0;
    for i in 0..triangles.len() {
        let t = sorted(i);
        // Earlier triangles with the same lowest vertex form a short list.
        let mut j = first[t[0] as usize];
        while j != u32::MAX && sorted(j as usize) != t {
            j = next[j as usize];
        }
        duplicates += usize::from(j != u32::MAX);
        next[i] = first[t[0] as usize];
        first[t[0] as usize] = i as u32;
    }
    duplicates
}

/// The three corners of a triangle.
fn corners(vertices: &[Vec3], triangle: [u32; 3]) -> [DVec3; 3] {
    triangle.map(|v| vertices[v as usize].as_dvec3())
}

/// Signed volume enclosed by the triangles (unit frame, diagonal³): positive where they are counter-clockwise seen
/// from outside. Of an open mesh it is the volume of the cone over it from the origin.
pub fn volume(vertices: &[Vec3], triangles: &[[u32; 3]]) -> f64 {
    let cone = |&t: &[u32; 3]| {
        let [a, b, c] = corners(vertices, t);
        a.dot(b.cross(c)) / 6.0
    };
    triangles.iter().map(cone).sum()
}

/// Area of the triangles (unit frame, diagonal²).
pub fn area(vertices: &[Vec3], triangles: &[[u32; 3]]) -> f64 {
    let one = |&t: &[u32; 3]| {
        let [a, b, c] = corners(vertices, t);
        (b - a).cross(c - a).length() / 2.0
    };
    triangles.iter().map(one).sum()
}
