//! Where lines of one direction cross a mesh (layered depth images: J. Shade et al., "Layered depth images", 1998).

use crate::mesh::Mesh;
use glam::DVec3;

/// Lines along each side of the unit frame.
const LINES: usize = 256;
/// Distance of neighbouring lines.
pub(super) const APART: f64 = 1.0 / LINES as f64;

/// The crossings of a grid of parallel lines with a mesh of the unit frame.
pub(super) struct Layers {
    /// Of unit length, and at right angles: the two along the grid, and that of the lines.
    axes: [DVec3; 3],
    /// Where the crossings of each line start, by rows.
    starts: Vec<u32>,
    /// Of one line in rising order: how far along it, and whether the triangle is seen from its outer side by who looks along the line.
    crossings: Vec<(f32, bool)>,
}

impl Layers {
    /// `along` is of unit length.
    pub(super) fn new(mesh: &Mesh, along: DVec3) -> Layers {
        let (across, up) = along.any_orthonormal_pair();
        let axes = [across, up, along];
        let placed: Vec<DVec3> = mesh
            .vertices
            .iter()
            .map(|v| place(&axes, v.as_dvec3()))
            .collect();
        let mut found = Vec::new();
        for triangle in &mesh.triangles {
            cross(triangle.map(|v| placed[v as usize]), |line, crossing| {
                found.push((line, crossing));
            });
        }
        let mut starts = vec![0u32; LINES * LINES + 1];
        for &(line, _) in &found {
            starts[line + 1] += 1;
        }
        for line in 0..LINES * LINES {
            starts[line + 1] += starts[line];
        }
        let mut ends = starts.clone();
        let mut crossings = vec![(0.0, false); found.len()];
        for (line, crossing) in found {
            crossings[ends[line] as usize] = crossing;
            ends[line] += 1;
        }
        for line in starts.windows(2) {
            crossings[line[0] as usize..line[1] as usize].sort_unstable_by(order);
        }
        Layers {
            axes,
            starts,
            crossings,
        }
    }

    /// How far it is from a place of the surface, whose unit normal is `normal` and whose triangle has the unit normal `face`, to the next of
    /// the surface along the lines, on the side that the normal is on; and the cosine of the angle between the two. Where that way leads
    /// into the triangle itself, nothing is told: the cosine is 0.
    pub(super) fn free(&self, at: DVec3, normal: DVec3, face: DVec3) -> (f64, f64) {
        let [x, y, z] = place(&self.axes, at).to_array();
        let [slope_x, slope_y, upright] = self.axes.map(|axis| axis.dot(face));
        let cosine = self.axes[2].dot(normal);
        if cosine * upright <= 0.0 {
            return (f64::INFINITY, 0.0);
        }
        let (column, row) = (nearest(x), nearest(y));
        // The line passes beside the place: where the triangle's plane crosses it.
        let steep = upright.abs().max(STEEP).copysign(upright);
        let beside = (line_at(column) - x) * slope_x + (line_at(row) - y) * slope_y;
        let own = z - beside / steep;
        let line = row * LINES + column;
        let crossings = &self.crossings[self.starts[line] as usize..self.starts[line + 1] as usize];
        // What turns its outer side to the place is another part of the surface; what turns its inner side may be the place itself.
        let bias = |outer: bool| if outer { OUTER } else { INNER } * APART;
        let next = if cosine >= 0.0 {
            let mut above = crossings.iter();
            above.find_map(|&(z, outer)| {
                let free = f64::from(z) - own;
                (free > bias(outer)).then_some(free)
            })
        } else {
            let mut below = crossings.iter().rev();
            below.find_map(|&(z, outer)| {
                let free = own - f64::from(z);
                (free > bias(!outer)).then_some(free)
            })
        };
        (next.unwrap_or(f64::INFINITY), cosine.abs())
    }
}

/// Least cosine that a plane's slope is taken of.
const STEEP: f64 = 0.2;
/// Crossings nearer than so many distances of lines do not count, where they show their outer side and where they show their inner one.
const OUTER: f64 = 0.5;
const INNER: f64 = 3.0;

fn place(axes: &[DVec3; 3], p: DVec3) -> DVec3 {
    DVec3::from(axes.map(|axis| axis.dot(p)))
}

/// Coordinate of a line.
fn line_at(index: usize) -> f64 {
    (index as f64 + 0.5) * APART - 0.5
}

fn nearest(x: f64) -> usize {
    ((x + 0.5) / APART).clamp(0.0, LINES as f64 - 1.0) as usize
}

/// The lines that cross a triangle.
fn cross([a, b, c]: [DVec3; 3], mut take: impl FnMut(usize, (f32, bool))) {
    let normal = (b - a).cross(c - a);
    if normal.z == 0.0 {
        return;
    }
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let range = |low: f64, high: f64| {
        let first = ((low + 0.5) / APART - 0.5).ceil().max(0.0) as usize;
        let end = ((high + 0.5) / APART - 0.5).floor() + 1.0;
        first..end.clamp(0.0, LINES as f64) as usize
    };
    let columns = range(low.x, high.x);
    for row in range(low.y, high.y) {
        for column in columns.clone() {
            let p = DVec3::new(line_at(column), line_at(row), 0.0);
            let side = |q: DVec3, r: DVec3| {
                ((r.x - q.x) * (p.y - q.y) - (r.y - q.y) * (p.x - q.x)) * normal.z
            };
            if side(a, b) >= 0.0 && side(b, c) >= 0.0 && side(c, a) >= 0.0 {
                let z = a.z - ((p.x - a.x) * normal.x + (p.y - a.y) * normal.y) / normal.z;
                let z = z.clamp(low.z, high.z) as f32;
                take(row * LINES + column, (z, normal.z < 0.0));
            }
        }
    }
}

fn order(a: &(f32, bool), b: &(f32, bool)) -> std::cmp::Ordering {
    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
}
