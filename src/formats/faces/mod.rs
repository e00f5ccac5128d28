//! A mesh's faces become points: a file with faces is a scan whose surface is known, so its points are taken from the
//! surface and not from its corners alone.
//!
//! Parsers collect [`Faces`] beside the rows of their vertices. When all is parsed, files and pictures that the faces name
//! are asked for ([`Faces::want`]), and [`sample`] makes the points: evenly over the area, seeded, at distances as of blue
//! noise, with normals, colours and attributes interpolated.

pub(super) mod looks;
mod normals;
mod paint;
mod polygons;
pub(super) mod sampling;
mod spread;
pub(super) mod triangles;
mod vectors;

use super::colors::ColorRange;
use super::raw_cloud::RawCloud;
use super::table::{Columns, Table};
pub use looks::Picture;
use normals::CornerNormals;
use paint::Painter;
pub use sampling::Sampling;
use triangles::Faces;
pub use triangles::Want;
use vectors::unit;

/// Fewest and most points that a mesh becomes, and points a triangle between the two.
const FEWEST: usize = 100_000;
const MOST: usize = 2_000_000;
const A_TRIANGLE: usize = 4;

/// What becomes of a file's faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FaceMode {
    /// Points are taken from the faces: four a triangle, at least 100,000 and at most 2,000,000.
    #[default]
    Sample,
    /// The vertices are the points; faces are counted.
    Vertices,
    /// The vertices are the points, with the colours of their faces; [`crate::formats::Reading::take_indices`] gives the triangles.
    Mesh,
}

/// The vertices as points with the colours of their faces, and the triangles over them.
pub(super) fn mesh(
    mut faces: Faces,
    mut vertices: RawCloud,
    gone: &[u32],
) -> (RawCloud, Vec<u32>, Sampling) {
    faces.settle(gone, vertices.points());
    let sampling = Sampling {
        broken: faces.broken,
        missing: std::mem::take(&mut faces.missing),
        ..Sampling::default()
    };
    let colors = Painter::of(&faces, &vertices).map(|painter| {
        let mut sums = vec![([0.0; 3], 0.0); vertices.points()];
        for (triangle, corners) in faces.corners.iter().enumerate() {
            for (corner, &v) in corners.iter().enumerate() {
                let weights = [0, 1, 2].map(|k| f64::from(u8::from(k == corner)));
                if let Some(color) = painter.color(triangle, weights) {
                    let (sum, count) = &mut sums[v as usize];
                    *sum = [0, 1, 2].map(|k| sum[k] + color[k]);
                    *count += 1.0;
                }
            }
        }
        let mean = |(i, (sum, count)): (usize, &([f64; 3], f64))| match *count {
            0.0 => vertex_color(&vertices, i as u32),
            count => sum.map(|x| x / count),
        };
        let means = sums.iter().enumerate().map(mean);
        means.flatten().map(|x| x.round() as u8).collect()
    });
    vertices.colors = colors;
    (vertices, faces.corners.into_flattened(), sampling)
}

/// A table of points of the faces over the vertices of another; `None` where the faces have no area: the vertices are then all
/// there is. Vertices that no face uses stay as points where they are more than those that faces use, and not all at one place.
pub(super) fn sample(
    mut faces: Faces,
    vertices: &RawCloud,
    gone: &[u32],
) -> (Option<Table>, Sampling) {
    faces.settle(gone, vertices.points());
    let mut sampling = Sampling {
        broken: faces.broken,
        missing: std::mem::take(&mut faces.missing),
        ..Sampling::default()
    };
    let position = |i: u32| [0, 1, 2].map(|axis| vertices.positions.get(3 * i as usize + axis));
    let wanted = (A_TRIANGLE * faces.corners.len()).clamp(FEWEST, MOST);
    let Some(samples) = spread::over(&faces.corners, position, wanted) else {
        return (None, sampling);
    };
    let normals = CornerNormals::of(&faces, vertices, position);
    let painter = Painter::of(&faces, vertices);
    let scalars = Scalars::of(vertices);
    let mut table = Table::new(
        columns(vertices, painter.is_some()),
        Some(samples.len() as u64),
    );
    let mut row = vec![0.0; 9 + vertices.attributes.len()];
    for sample in &samples {
        let triangle = sample.triangle as usize;
        let [a, b, c] = faces.corners[triangle];
        let weights = sample.weights();
        let mix = |values: [[f64; 3]; 3]| {
            [0, 1, 2].map(|k| {
                (0..3)
                    .map(|corner| weights[corner] * values[corner][k])
                    .sum::<f64>()
            })
        };
        row[..3].copy_from_slice(&mix([a, b, c].map(position)));
        row[3..6].copy_from_slice(&unit(mix(normals.of_triangle(triangle))));
        if let Some(painter) = &painter {
            let Some(color) = painter.color(triangle, weights) else {
                continue;
            };
            row[6..9].copy_from_slice(&color.map(f64::round));
        }
        scalars.mix([a, b, c], weights, &mut row[9..]);
        table.push(&row);
        sampling.points += 1;
    }
    let loose = loose_vertices(&faces, vertices);
    if !keeps_loose(&loose, vertices) {
        sampling.unused = loose.len() as u64;
    } else {
        for &i in &loose {
            row[..3].copy_from_slice(&position(i));
            row[3..6].copy_from_slice(&vertex_normal(vertices, i));
            row[6..9].copy_from_slice(&vertex_color(vertices, i));
            scalars.mix([i; 3], [1.0, 0.0, 0.0], &mut row[9..]);
            table.push(&row);
        }
    }
    (Some(table), sampling)
}

fn columns(vertices: &RawCloud, colors: bool) -> Columns {
    let attributes = vertices.attributes.iter().enumerate();
    Columns {
        normal: Some([3, 4, 5]),
        color: colors.then_some([6, 7, 8]),
        scalars: attributes
            .map(|(i, attribute)| (9 + i, attribute.name.clone()))
            .collect(),
        colors: ColorRange::Bytes,
        ..Columns::xyz()
    }
}

/// How the values of the corners become that of a point between them.
struct Scalars<'a> {
    vertices: &'a RawCloud,
    /// Integers alone: labels, which have no mean.
    labels: Vec<bool>,
}

impl Scalars<'_> {
    fn of(vertices: &RawCloud) -> Scalars<'_> {
        let labels = vertices.attributes.iter();
        Scalars {
            vertices,
            labels: labels
                .map(|a| a.values.iter().all(|x| x.fract() == 0.0))
                .collect(),
        }
    }

    fn mix(&self, corners: [u32; 3], weights: [f64; 3], row: &mut [f64]) {
        let nearest = (1..3).fold(
            0,
            |best, k| if weights[k] > weights[best] { k } else { best },
        );
        for ((value, attribute), label) in row
            .iter_mut()
            .zip(&self.vertices.attributes)
            .zip(&self.labels)
        {
            let of = |corner: usize| f64::from(attribute.values[corners[corner] as usize]);
            *value = match label {
                true => of(nearest),
                false => (0..3).map(|corner| weights[corner] * of(corner)).sum(),
            };
        }
    }
}

/// Vertices that no face uses.
fn loose_vertices(faces: &Faces, vertices: &RawCloud) -> Vec<u32> {
    let mut used = vec![false; vertices.points()];
    for &corner in faces.corners.as_flattened() {
        used[corner as usize] = true;
    }
    (0..vertices.points() as u32)
        .filter(|&i| !used[i as usize])
        .collect()
}

/// Whether they are a scan of their own, with a few faces beside.
fn keeps_loose(loose: &[u32], vertices: &RawCloud) -> bool {
    let place = |&i: &u32| [0, 1, 2].map(|axis| vertices.positions.get(3 * i as usize + axis));
    2 * loose.len() > vertices.points() && loose.iter().any(|i| place(i) != place(&loose[0]))
}

fn vertex_normal(vertices: &RawCloud, i: u32) -> [f64; 3] {
    let normals = vertices.normals.as_ref();
    normals.map_or([0.0; 3], |normals| {
        [0, 1, 2].map(|axis| f64::from(normals[3 * i as usize + axis]))
    })
}

fn vertex_color(vertices: &RawCloud, i: u32) -> [f64; 3] {
    let colors = vertices.colors.as_ref();
    colors.map_or([255.0; 3], |colors| {
        [0, 1, 2].map(|axis| f64::from(colors[3 * i as usize + axis]))
    })
}
