//! The texels of the charts, and their places.

use super::groups::{Gathered, groups};
use crate::base::error::Result;
use crate::base::par;
use crate::light::carry::Spot;
use crate::mesh::Mesh;
use crate::report::distance::TriangleTree;
use glam::{DVec2, DVec3, Vec3};

/// Groups of texels, or texels, that one index of a parallel map takes.
const PER_TASK: usize = 64;
/// Tasks between two progress calls.
const TASKS: usize = 128;
/// Texels whose centre is so far outside of a triangle, in texels, are still its own where no other has them.
const BESIDE: f64 = 0.75;

/// Texels of a square lie behind each other.
const SQUARE: usize = 4;

/// A texel of a chart.
pub(super) struct Texel {
    pub(super) pixel: u32,
    /// Of the textured mesh.
    pub(super) on: Spot,
}

pub(super) struct Texels {
    pub(super) all: Vec<Texel>,
    pub(super) size: [usize; 2],
}

impl Texels {
    /// Those whose centre lies in a triangle, and those beside one that no triangle has, by small squares.
    pub(super) fn new(mesh: &Mesh, uvs: &[[f32; 2]], [width, height]: [usize; 2]) -> Texels {
        // For each pixel the triangle that it lies in, or least outside of, and by how many texels.
        let mut owner = vec![(f64::INFINITY, u32::MAX); width * height];
        let scale = DVec2::new(width as f64, height as f64);
        let place = |v: u32| {
            let [u, v] = uvs[v as usize].map(f64::from);
            DVec2::new(u, v) * scale - 0.5
        };
        for (t, triangle) in mesh.triangles.iter().enumerate() {
            let corners = triangle.map(place);
            let Some(flat) = Flat::of(corners) else {
                continue;
            };
            let low = corners.into_iter().reduce(DVec2::min).unwrap_or_default() - BESIDE;
            let high = corners.into_iter().reduce(DVec2::max).unwrap_or_default() + BESIDE;
            let range = |low: f64, high: f64, count: usize| {
                let end = (high.floor() + 1.0).clamp(0.0, count as f64) as usize;
                low.ceil().max(0.0) as usize..end
            };
            for y in range(low.y, high.y, height) {
                for x in range(low.x, high.x, width) {
                    let outside = flat.outside(DVec2::new(x as f64, y as f64));
                    let pixel = &mut owner[y * width + x];
                    if outside <= BESIDE && outside < pixel.0 {
                        *pixel = (outside, t as u32);
                    }
                }
            }
        }
        let texel = |(pixel, &(_, t)): (usize, &(f64, u32))| {
            let corners = mesh.triangles.get(t as usize)?.map(place);
            let at = DVec2::new((pixel % width) as f64, (pixel / width) as f64);
            let weights = Flat::of(corners)?.weights(at);
            let on = Spot {
                triangle: t,
                weights,
            };
            Some(Texel {
                pixel: pixel as u32,
                on,
            })
        };
        Texels {
            all: tiled(width, height)
                .filter_map(|at| texel((at, &owner[at])))
                .collect(),
            size: [width, height],
        }
    }

    /// Length of a texel on the mesh, the square root of the mean area.
    pub(super) fn length(&self, mesh: &Mesh) -> f64 {
        let area: f64 = mesh
            .triangles
            .iter()
            .map(|&t| mesh.cross(t).length() / 2.0)
            .sum();
        (area / self.all.len().max(1) as f64).sqrt()
    }

    /// The places of the full mesh nearest to the texels', in their order; `faces` is of its triangles.
    pub(super) fn spots(
        &self,
        mesh: &Mesh,
        (full, faces): (&Mesh, &TriangleTree),
        progress: &mut dyn FnMut(f32) -> Result<()>,
    ) -> Result<Vec<Spot>> {
        let at = |texel: &Texel| place(mesh, &texel.on).as_vec3();
        let places: Vec<Vec3> = self.all.iter().map(at).collect();
        let groups = groups(&places, self.length(mesh));
        let found = in_parallel(&groups, progress, Gathered::default, |group, gathered| {
            gathered.spots(&places[group.clone()], full, faces)
        })?;
        Ok(found.concat())
    }
}

/// The pixels of a picture, those of each small square behind each other.
fn tiled(width: usize, height: usize) -> impl Iterator<Item = usize> {
    let squares = (0..height).step_by(SQUARE);
    let squares = squares.flat_map(move |y| (0..width).step_by(SQUARE).map(move |x| (x, y)));
    squares.flat_map(move |(left, top)| {
        let rows = top..(top + SQUARE).min(height);
        rows.flat_map(move |y| (left..(left + SQUARE).min(width)).map(move |x| y * width + x))
    })
}

/// `f` of each value, in their order, in parallel; `scratch` serves values that follow each other.
pub(super) fn in_parallel<V: Sync, S, T: Send>(
    values: &[V],
    progress: &mut dyn FnMut(f32) -> Result<()>,
    scratch: impl Fn() -> S + Sync + Send,
    f: impl Fn(&V, &mut S) -> T + Sync + Send,
) -> Result<Vec<T>> {
    let mut found = Vec::with_capacity(values.len());
    for slice in values.chunks(PER_TASK * TASKS) {
        progress(found.len() as f32 / values.len() as f32)?;
        let tasks: Vec<&[V]> = slice.chunks(PER_TASK).collect();
        let each = par::map(tasks.len(), &scratch, |k, scratch| {
            tasks[k]
                .iter()
                .map(|value| f(value, scratch))
                .collect::<Vec<T>>()
        });
        found.extend(each.into_iter().flatten());
    }
    Ok(found)
}

/// The place of a spot.
pub(super) fn place(mesh: &Mesh, spot: &Spot) -> DVec3 {
    mix(mesh, spot, |v| mesh.vertices[v].as_dvec3())
}

/// A value of the corners between them.
pub(super) fn mix(mesh: &Mesh, spot: &Spot, value: impl Fn(usize) -> DVec3) -> DVec3 {
    let corners = mesh.triangles[spot.triangle as usize]
        .into_iter()
        .zip(spot.weights);
    corners.fold(DVec3::ZERO, |sum, (v, weight)| {
        sum + value(v as usize) * weight
    })
}

/// A triangle in the picture.
struct Flat {
    corners: [DVec2; 3],
    /// Twice its area, with its sign.
    twice: f64,
}

impl Flat {
    fn of(corners: [DVec2; 3]) -> Option<Flat> {
        let [a, b, c] = corners;
        let twice = (b - a).perp_dot(c - a);
        (twice != 0.0).then_some(Flat { corners, twice })
    }

    /// How much the corners count at `p`; outside of the triangle, at the point of it nearest to `p`.
    fn weights(&self, p: DVec2) -> [f64; 3] {
        let [a, b, c] = self.corners;
        let at = if self.is_inside(p) {
            p
        } else {
            self.nearest(p)
        };
        let of = |p: DVec2, q: DVec2| ((p - at).perp_dot(q - at) / self.twice).clamp(0.0, 1.0);
        let (first, second) = (of(b, c), of(c, a));
        [first, second, (1.0 - first - second).max(0.0)]
    }

    fn is_inside(&self, p: DVec2) -> bool {
        let [a, b, c] = self.corners;
        [(a, b), (b, c), (c, a)]
            .iter()
            .all(|&(q, r)| (r - q).perp_dot(p - q) * self.twice >= 0.0)
    }

    /// Distance from `p`, 0 inside.
    fn outside(&self, p: DVec2) -> f64 {
        if self.is_inside(p) {
            return 0.0;
        }
        self.nearest(p).distance(p)
    }

    /// The point of its sides nearest to `p`.
    fn nearest(&self, p: DVec2) -> DVec2 {
        let [a, b, c] = self.corners;
        let on = |q: DVec2, r: DVec2| {
            let along = r - q;
            let share = (p - q).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
            q + along * share.clamp(0.0, 1.0)
        };
        let sides = [on(a, b), on(b, c), on(c, a)];
        let nearer = |best: DVec2, at: DVec2| {
            if at.distance_squared(p) < best.distance_squared(p) {
                at
            } else {
                best
            }
        };
        sides.into_iter().fold(sides[0], nearer)
    }
}
