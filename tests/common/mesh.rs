//! What must never be wrong with a mesh, counted.

use glam::{DVec3, Vec3};
use pointweave::cloud::octree::Octree;
use pointweave::report::{Topology, topology};

/// Height over longest edge under which a triangle has no area to speak of.
const FLAT: f64 = 1e-7;
/// Cosine under which two neighbours are folded onto each other.
const FOLDED: f64 = -0.985;

/// What can be wrong with a mesh. All but boundary edges are never allowed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Flaws {
    pub topology: Topology,
    /// Triangles without area.
    pub flat: usize,
    /// Edges whose triangles lie on each other (170° and more).
    pub folded: usize,
    /// Vertices that are not finite, or that no triangle uses.
    pub stray: usize,
}

impl Flaws {
    pub fn of(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Flaws {
        let corners = |t: &[u32; 3]| t.map(|v| vertices[v as usize].as_dvec3());
        let is_flat = |t: &&[u32; 3]| {
            let [a, b, c] = corners(t);
            let longest = [b - a, c - b, a - c]
                .map(DVec3::length_squared)
                .into_iter()
                .fold(0.0, f64::max);
            (b - a).cross(c - a).length() <= FLAT * longest
        };
        let mut used = vec![false; vertices.len()];
        triangles
            .as_flattened()
            .iter()
            .for_each(|&v| used[v as usize] = true);
        let is_stray = |(v, used): (&Vec3, &bool)| !used || !v.is_finite();
        Flaws {
            topology: topology(triangles, vertices.len()),
            flat: triangles.iter().filter(is_flat).count(),
            folded: folded(vertices, triangles),
            stray: vertices.iter().zip(&used).filter(|&v| is_stray(v)).count(),
        }
    }

    /// Whether nothing is wrong that is never allowed.
    pub fn is_clean(&self) -> bool {
        self.topology.is_manifold() && self.flat + self.stray == 0
    }
}

fn folded(vertices: &[Vec3], triangles: &[[u32; 3]]) -> usize {
    let normal = |t: usize| {
        let [a, b, c] = triangles[t].map(|v| vertices[v as usize].as_dvec3());
        (b - a).cross(c - a).normalize_or_zero()
    };
    let mut edges: Vec<(u32, u32, usize)> = triangles
        .iter()
        .enumerate()
        .flat_map(|(i, t)| {
            [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])].map(|(a, b)| (a.min(b), a.max(b), i))
        })
        .collect();
    edges.sort_unstable();
    edges
        .chunk_by(|a, b| (a.0, a.1) == (b.0, b.1))
        .filter(|e| e.len() == 2 && normal(e[0].2).dot(normal(e[1].2)) < FOLDED)
        .count()
}

/// Share of the area that is farther than 2 % of the diagonal from every point.
pub fn far(vertices: &[Vec3], triangles: &[[u32; 3]], points: &[Vec3]) -> f64 {
    let tree = Octree::build(points);
    let (mut all, mut far) = (0.0, 0.0);
    for t in triangles {
        let [a, b, c] = t.map(|v| vertices[v as usize]);
        let size = f64::from((b - a).cross(c - a).length());
        all += size;
        if tree.nearest((a + b + c) / 3.0).distance2 > 0.02 * 0.02 {
            far += size;
        }
    }
    far / all
}
