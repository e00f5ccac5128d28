//! Normals at the corners of triangles: the file's, or else the mean of the faces around a vertex that no crease parts.

use super::{Faces, NONE, area_normal, dot, unit};
use crate::formats::RawCloud;

/// Cosine of the angle between faces from which on the edge between them is a crease: 45°.
const CREASE: f64 = std::f64::consts::FRAC_1_SQRT_2;

pub(super) struct CornerNormals<'a> {
    faces: &'a Faces,
    vertices: &'a RawCloud,
    /// Twice the area along the normal, by triangle.
    areas: Vec<[f64; 3]>,
    /// A number for each place of vertices: vertices of equal coordinates are one.
    place: Vec<u32>,
    /// The triangles around place `p` are `around[starts[p]..starts[p + 1]]`.
    starts: Vec<u32>,
    around: Vec<u32>,
}

impl CornerNormals<'_> {
    pub(super) fn of<'a>(
        faces: &'a Faces,
        vertices: &'a RawCloud,
        position: impl Fn(u32) -> [f64; 3],
    ) -> CornerNormals<'a> {
        let place = places(vertices.points(), &position);
        let corners = || {
            faces
                .corners
                .as_flattened()
                .iter()
                .map(|&i| place[i as usize] as usize)
        };
        let mut starts = vec![0u32; place.len() + 1];
        corners().for_each(|p| starts[p + 1] += 1);
        for p in 1..starts.len() {
            starts[p] += starts[p - 1];
        }
        let mut next = starts.clone();
        let mut around = vec![0; 3 * faces.corners.len()];
        for (corner, p) in corners().enumerate() {
            around[next[p] as usize] = (corner / 3) as u32;
            next[p] += 1;
        }
        CornerNormals {
            areas: faces
                .corners
                .iter()
                .map(|corners| area_normal(corners.map(&position)))
                .collect(),
            faces,
            vertices,
            place,
            starts,
            around,
        }
    }

    /// The three normals of a triangle's corners.
    pub(super) fn of_triangle(&self, triangle: usize) -> [[f64; 3]; 3] {
        [0, 1, 2].map(|corner| {
            let own = self.own(triangle, corner);
            own.unwrap_or_else(|| self.mean(triangle, corner))
        })
    }

    /// That which the file says, unless it says none.
    fn own(&self, triangle: usize, corner: usize) -> Option<[f64; 3]> {
        let normal = match self
            .faces
            .normal_corners
            .get(triangle)
            .map(|corners| corners[corner])
        {
            Some(NONE) => return None,
            Some(i) => *self.faces.normals.get(i as usize)?,
            None => {
                let i = 3 * self.faces.corners[triangle][corner] as usize;
                *self.vertices.normals.as_ref()?.get(i..)?.first_chunk()?
            }
        };
        let normal = unit(normal.map(f64::from));
        (normal != [0.0; 3] && normal.iter().all(|x| x.is_finite())).then_some(normal)
    }

    /// The mean of the faces around a corner, by area, that differ from the triangle by less than a crease.
    fn mean(&self, triangle: usize, corner: usize) -> [f64; 3] {
        let own = unit(self.areas[triangle]);
        let p = self.place[self.faces.corners[triangle][corner] as usize] as usize;
        let around = &self.around[self.starts[p] as usize..self.starts[p + 1] as usize];
        let mut sum = [0.0; 3];
        for &other in around {
            let area = self.areas[other as usize];
            if dot(unit(area), own) >= CREASE {
                (0..3).for_each(|k| sum[k] += area[k]);
            }
        }
        let mean = unit(sum);
        if mean == [0.0; 3] { own } else { mean }
    }
}

/// A number for each place: that of the first vertex there, in the order of coordinates.
fn places(points: usize, position: impl Fn(u32) -> [f64; 3]) -> Vec<u32> {
    // Both zeros are one place.
    let key = |i: u32| position(i).map(|x| (x + 0.0).to_bits());
    let mut order: Vec<u32> = (0..points as u32).collect();
    order.sort_unstable_by_key(|&i| (key(i), i));
    let mut place = vec![0; points];
    for pair in 0..order.len() {
        let i = order[pair];
        let same = pair > 0 && key(order[pair - 1]) == key(i);
        place[i as usize] = if same {
            place[order[pair - 1] as usize]
        } else {
            i
        };
    }
    place
}
