//! Which holes are closed: each by its own size.
//!
//! What the global extension adds to a surface falls into *caps*, sets of filled quads that share edges. A cap is an
//! interpolation where it stays near the points, and an invention where it does not. How near it has to stay depends on its
//! *turn*, the angle between the cap and the surface around it: a hole in a smooth part has the cap go on as the surface
//! does, the open end of a pipe has it across.

use crate::base::params::{Boundary, MaxHole};
use crate::base::sets::Sets;
use crate::base::sort_keys::pack;
use crate::cloud::octree::Octree;
use crate::mesh::dual::Dual;
use crate::mesh::probe::{Quad, Vertex};
use crate::mesh::trim::components;
use glam::{DVec3, Vec3};
use serde::Serialize;

/// A component of which more than this share of the closed area would be filled is an open sheet, and has only holes that go
/// on smoothly closed. A ball cut off at a third of its height needs 0.25, a half ball or a deep bowl 0.33; a terrain tile
/// 0.5 or more.
pub const MOST_FILLED: f64 = 0.35;
/// A hole is a gap of the sampling when its cap is nowhere farther from the points than this many of their reaches, about 4.4
/// spacings.
const GAP: f32 = 2.0;
/// Widest hole that is closed where its cap turns, and where it goes on smoothly (fractions of the diagonal).
const WIDEST: [f32; 2] = [0.1, 0.2];
/// Cosine of the turn up to which a cap goes on as the surface does: 45°.
const SMOOTH: f64 = 0.7;

/// A hole of a surface, or the outer rim of an open one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Hole {
    /// Of a hole that was closed, that of the largest disc in it (twice the largest distance of what closes it from the
    /// points); of a rim, that of the disc whose area it encloses. Fraction of the diagonal.
    pub diameter: f64,
    /// Whether the surface goes on across it.
    pub closed: bool,
}

/// What [`decide_holes`] left.
#[derive(Debug, Default)]
pub(crate) struct Holes {
    /// Share of the area that is filled (0-1).
    pub(crate) filled: f64,
    /// Components whose holes were closed.
    pub(crate) closed: usize,
    /// Components that are open.
    pub(crate) open: usize,
    /// Those that were closed.
    pub(crate) holes: Vec<Hole>,
}

/// A component with what a decision about it rests on.
#[derive(Clone, Default)]
struct Component {
    area: f64,
    filled: f64,
    has_boundary: bool,
}

impl Component {
    /// Whether the extension does not close it, or closes it by more than it is itself.
    fn is_unclosed(&self) -> bool {
        self.has_boundary || self.filled > MOST_FILLED * self.area
    }
}

/// Filled quads that share edges.
#[derive(Clone, Default)]
struct Cap {
    /// Sum of the quads' normals, as long as their areas.
    area: DVec3,
    /// Sum of the unit normals of the quads around it, and how many they are.
    around: DVec3,
    count: usize,
    /// Largest distance of a vertex to the points, and that in the reaches of the points nearest to it.
    far: f32,
    reaches: f32,
    /// It ends where the lattice does.
    has_end: bool,
    component: u32,
}

impl Cap {
    /// Whether it goes on as the surface around it does.
    fn is_smooth(&self) -> bool {
        let across = self.around.dot(self.area.normalize_or_zero());
        self.count > 0 && across > SMOOTH * self.count as f64
    }

    /// Whether it closes its hole. In components that stay open only caps that go on smoothly do: others would be walls
    /// from rim to rim.
    fn stays(&self, unclosed: bool, max_hole: MaxHole) -> bool {
        let smooth = self.is_smooth();
        let widest = match max_hole {
            MaxHole::Auto => WIDEST[usize::from(smooth)],
            MaxHole::Diameter(diameter) => diameter as f32,
        };
        let near = self.reaches <= GAP || self.far <= widest / 2.0;
        near && !self.has_end && (smooth || !unclosed)
    }
}

/// Drops the caps of the holes that are better left open, and components that are nothing but filling.
pub(crate) fn decide_holes(
    dual: &mut Dual,
    boundary: Boundary,
    (points, reach): (&[Vec3], &[f32]),
    max_hole: MaxHole,
) -> Holes {
    let (of, components) = measure(dual);
    let is_auto = boundary == Boundary::Auto && dual.quads.iter().any(|quad| quad.filled);
    let (cap_of, caps) = if is_auto {
        caps(dual, &of, (points, reach))
    } else {
        Default::default()
    };
    let stays: Vec<bool> = caps
        .iter()
        .map(|cap| {
            let component = &components[cap.component as usize];
            component.filled < component.area && cap.stays(component.is_unclosed(), max_hole)
        })
        .collect();
    let mut holes = Holes::default();
    let mut left = components.clone();
    for component in &mut left {
        component.filled = 0.0;
    }
    let (mut area, mut filled) = (0.0, 0.0);
    let quads = dual.quads.iter().enumerate();
    let decided: Vec<bool> = quads
        .map(|(q, quad)| {
            let kept = !quad.filled || is_auto && stays[cap_of[q] as usize];
            let size = quad_normal(quad, &dual.vertices).length();
            let component = &mut left[of[quad.vertices[0] as usize] as usize];
            if kept {
                area += size;
                if quad.filled {
                    filled += size;
                    component.filled += size;
                }
            } else {
                component.has_boundary = true;
            }
            kept
        })
        .collect();
    for (component, before) in left.iter().zip(&components) {
        if before.filled < before.area {
            holes.open += usize::from(component.has_boundary);
            holes.closed += usize::from(component.filled > 0.0 && !component.has_boundary);
        }
    }
    holes.filled = if area > 0.0 { filled / area } else { 0.0 };
    let closed = caps.iter().zip(&stays).filter(|(_, stays)| **stays);
    holes.holes = closed
        .map(|(cap, _)| Hole {
            diameter: 2.0 * f64::from(cap.far),
            closed: true,
        })
        .collect();
    let mut decided = decided.into_iter();
    dual.retain(|_| decided.next() == Some(true));
    holes
}

/// The component of every vertex, and what is to be known of each.
fn measure(dual: &Dual) -> (Vec<u32>, Vec<Component>) {
    let (of, count) = components(dual);
    let mut components = vec![Component::default(); count];
    for quad in &dual.quads {
        let component = &mut components[of[quad.vertices[0] as usize] as usize];
        let area = quad_normal(quad, &dual.vertices).length();
        component.area += area;
        component.filled += if quad.filled { area } else { 0.0 };
    }
    for (vertex, &c) in dual.vertices.iter().zip(&of) {
        components[c as usize].has_boundary |= vertex.is_at_end();
    }
    (of, components)
}

/// Normal of a quad, as long as its area.
fn quad_normal(quad: &Quad, vertices: &[Vertex]) -> DVec3 {
    let [p, q, r, s] = quad
        .vertices
        .map(|v| vertices[v as usize].position.as_dvec3());
    (r - p).cross(s - q) / 2.0
}

/// The cap of every filled quad, and the caps.
fn caps(
    dual: &Dual,
    component_of: &[u32],
    (points, reach): (&[Vec3], &[f32]),
) -> (Vec<u32>, Vec<Cap>) {
    let filled = || {
        dual.quads
            .iter()
            .zip(0u32..)
            .filter(|(quad, _)| quad.filled)
    };
    let mut edges: Vec<(u64, u32)> = Vec::new();
    for (quad, q) in filled() {
        for k in 0..4 {
            let (a, b) = (quad.vertices[k], quad.vertices[(k + 1) % 4]);
            edges.push((pack(a.min(b), a.max(b)), q));
        }
    }
    edges.sort_unstable();
    let mut sets = Sets::new(dual.quads.len());
    for pair in edges.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        sets.join(pair[0].1, pair[1].1);
    }
    drop(edges);
    let mut of = vec![u32::MAX; dual.quads.len()];
    let mut count = 0;
    for (_, q) in filled() {
        // The least member of a set comes first.
        let first = sets.find(q);
        if first == q {
            of[q as usize] = count;
            count += 1;
        } else {
            of[q as usize] = of[first as usize];
        }
    }
    let mut caps = vec![Cap::default(); count as usize];
    let mut at: Vec<u32> = vec![u32::MAX; dual.vertices.len()];
    let tree = Octree::build(points);
    for (quad, q) in filled() {
        let cap = &mut caps[of[q as usize] as usize];
        cap.area += quad_normal(quad, &dual.vertices);
        cap.component = component_of[quad.vertices[0] as usize];
        for v in quad.vertices {
            let vertex = &dual.vertices[v as usize];
            cap.has_end |= vertex.is_at_end();
            if at[v as usize] == u32::MAX {
                at[v as usize] = of[q as usize];
                let near = tree.nearest(vertex.position);
                let far = near.distance2.sqrt();
                let reach = reach[tree.order[near.index as usize] as usize];
                cap.far = cap.far.max(far);
                cap.reaches = cap.reaches.max(far / reach.max(f32::MIN_POSITIVE));
            }
        }
    }
    for quad in dual.quads.iter().filter(|quad| !quad.filled) {
        let normal = quad_normal(quad, &dual.vertices).normalize_or_zero();
        let mut met = u32::MAX;
        for v in quad.vertices {
            let cap = at[v as usize];
            if cap != u32::MAX && cap != met {
                met = cap;
                caps[cap as usize].around += normal;
                caps[cap as usize].count += 1;
            }
        }
    }
    (of, caps)
}
