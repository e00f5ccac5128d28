//! A mesh's faces become points: a file with faces is a scan whose surface is known, so its points are taken from the
//! surface and not from its corners alone.
//!
//! Parsers collect [`Faces`] beside the rows of their vertices. When all is parsed, files and pictures that the faces name
//! are asked for ([`Faces::want`]), and [`sample`] makes the points: evenly over the area, seeded, at distances as of blue
//! noise, with normals, colours and attributes interpolated.

mod normals;
mod paint;
mod polygons;
mod spread;

use super::RawCloud;
use super::colors::ColorRange;
use super::table::{Columns, Table};
use normals::CornerNormals;
use paint::Painter;
pub use paint::Picture;
pub(super) use paint::{Look, Texture, Wrap, srgb};

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
}

/// What the faces need besides their own file.
#[derive(Debug, Clone, PartialEq)]
pub enum Want {
    /// The content of a file beside it, by the name that it is called by.
    File(String),
    /// The pixels of a picture, of a PNG, JPEG or WebP file's bytes.
    Picture(Vec<u8>),
}

/// A picture that textures show.
pub(super) enum Source {
    /// In a file beside.
    Beside(String),
    /// As a file's bytes.
    Packed(Vec<u8>),
    /// Its pixels.
    Open(Picture),
    /// It is not to be had.
    Missing,
}

/// Triangles over the rows of a table, and what is painted on them. Lists that are empty say nothing.
#[derive(Default)]
pub(super) struct Faces {
    /// Rows of the corners, counted with those that the table left out.
    pub(super) corners: Vec<[u32; 3]>,
    /// Normals that are not the rows' own, and which of them each triangle's corners have.
    pub(super) normals: Vec<[f32; 3]>,
    pub(super) normal_corners: Vec<[u32; 3]>,
    /// Places in a picture, the first row at the top, and which of them each triangle's corners have: those of the rows where
    /// there is no list.
    pub(super) places: Vec<[f32; 2]>,
    pub(super) place_corners: Vec<[u32; 3]>,
    /// Colour of each triangle, 0-255.
    pub(super) colors: Vec<[u8; 3]>,
    /// Which of the looks each triangle has.
    pub(super) look_of: Vec<u32>,
    pub(super) looks: Vec<Look>,
    /// Name of each look in the file's own libraries, and those libraries that were not read yet.
    pub(super) look_names: Vec<String>,
    pub(super) libraries: Vec<String>,
    pub(super) pictures: Vec<Source>,
    /// Files that were asked for and not found, and pictures that are of no kind that is read.
    pub(super) missing: Vec<String>,
    /// Faces with a corner that there is not.
    pub(super) broken: u64,
}

/// A face on its way in: a polygon. Lists have one entry a corner, or none.
#[derive(Default)]
pub(super) struct Face<'a> {
    pub(super) rows: &'a [u32],
    pub(super) places: &'a [u32],
    pub(super) normals: &'a [u32],
    pub(super) color: Option<[u8; 3]>,
    pub(super) look: Option<u32>,
}

/// Adds an entry to a list that has one for each of the `before` triangles, or none as long as nobody says any.
fn add<T: Copy>(list: &mut Vec<T>, before: usize, entry: Option<T>, nothing: T) {
    if entry.is_some() || !list.is_empty() {
        list.resize(before, nothing);
        list.push(entry.unwrap_or(nothing));
    }
}

/// Stands for no normal and no place of a corner.
pub(super) const NONE: u32 = u32::MAX;

impl Faces {
    /// Adds a face; `position` gives those of its rows that are known.
    pub(super) fn push(&mut self, face: Face, position: impl Fn(u32) -> Option<[f64; 3]>) {
        polygons::cut(face.rows, position, |corners| {
            let before = self.corners.len();
            let of = |list: &[u32]| match list {
                [] => None,
                list => Some(corners.map(|at| list[at])),
            };
            add(&mut self.place_corners, before, of(face.places), [NONE; 3]);
            add(
                &mut self.normal_corners,
                before,
                of(face.normals),
                [NONE; 3],
            );
            add(&mut self.colors, before, face.color, [255; 3]);
            add(&mut self.look_of, before, face.look, NONE);
            self.corners.push(corners.map(|at| face.rows[at]));
        });
    }

    /// What is needed next; [`Faces::give_file`] or [`Faces::give_picture`] answers.
    pub(super) fn want(&self) -> Option<Want> {
        if let Some(library) = self.libraries.first() {
            return Some(Want::File(library.clone()));
        }
        self.pictures.iter().find_map(|source| match source {
            Source::Beside(name) => Some(Want::File(name.clone())),
            Source::Packed(bytes) => Some(Want::Picture(bytes.clone())),
            _ => None,
        })
    }

    /// The file that was wanted, or that there is none.
    pub(super) fn give_file(&mut self, content: Option<&[u8]>) {
        if !self.libraries.is_empty() {
            let name = self.libraries.remove(0);
            match content {
                Some(text) => self.read_library(text),
                None => self.missing.push(name),
            }
            return;
        }
        let wanted = |source: &&mut Source| matches!(source, Source::Beside(_));
        if let Some(source) = self.pictures.iter_mut().find(wanted) {
            let found = match content {
                Some(bytes) => Source::Packed(bytes.to_vec()),
                None => Source::Missing,
            };
            if let (Source::Beside(name), Source::Missing) =
                (std::mem::replace(source, found), &*source)
            {
                self.missing.push(name);
            }
        }
    }

    /// The picture that was wanted, or that its bytes are of no kind that is read.
    pub(super) fn give_picture(&mut self, picture: Option<Picture>) {
        let wanted = |source: &&mut Source| matches!(source, Source::Packed(_));
        if let Some(source) = self.pictures.iter_mut().find(wanted) {
            *source = match picture {
                Some(picture) => Source::Open(picture),
                None => {
                    self.missing
                        .push("a picture that is no PNG, JPEG or WebP file".into());
                    Source::Missing
                }
            };
        }
    }

    /// The rows of the corners as points of a cloud that lacks the rows of `gone`, in order; triangles with a corner that is
    /// gone, or that never was, go too.
    fn settle(&mut self, gone: &[u32], points: usize) {
        let settled = |row: u32| {
            let before = gone.partition_point(|&other| other < row);
            let is_there = gone.get(before) != Some(&row);
            let at = row - before as u32;
            (is_there && (at as usize) < points).then_some(at)
        };
        let mut kept = Vec::with_capacity(self.corners.len());
        let mut corners = Vec::with_capacity(self.corners.len());
        for &[a, b, c] in &self.corners {
            let whole = (|| Some([settled(a)?, settled(b)?, settled(c)?]))();
            kept.push(whole.is_some());
            match whole {
                Some(whole) => corners.push(whole),
                None => self.broken += 1,
            }
        }
        // Places of rows go with the rows: what was counted with those that are gone is not any more.
        if self.place_corners.is_empty() && !self.places.is_empty() {
            self.place_corners = self.corners.clone();
        }
        keep(&mut self.normal_corners, &kept);
        keep(&mut self.place_corners, &kept);
        keep(&mut self.colors, &kept);
        keep(&mut self.look_of, &kept);
        self.corners = corners;
    }
}

/// Those of the values that are kept; of a list that is empty none.
fn keep<T>(values: &mut Vec<T>, kept: &[bool]) {
    let mut at = 0;
    values.retain(|_| {
        at += 1;
        kept[at - 1]
    });
}

/// What was made of a file's faces.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sampling {
    /// Points that were taken from faces; 0 where the points are the file's own.
    pub points: u64,
    /// Vertices that no face uses.
    pub unused: u64,
    /// Faces that name a vertex that there is not.
    pub broken: u64,
    /// Files that the faces name and that were not there, and pictures that are of no kind that is read.
    pub missing: Vec<String>,
}

impl Sampling {
    /// What was left out, by why.
    pub(super) fn skipped(&self) -> Vec<(&'static str, u64)> {
        let counts = [
            ("unused-vertices", self.unused),
            ("broken-faces", self.broken),
        ];
        counts.into_iter().filter(|(_, count)| *count > 0).collect()
    }
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
    sampling.unused = loose.len() as u64;
    if keeps_loose(&loose, vertices) {
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

/// Of unit length; zero stays zero.
fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    if length > 0.0 {
        v.map(|x| x / length)
    } else {
        [0.0; 3]
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Twice a triangle's area along its normal.
fn area_normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    cross(minus(b, a), minus(c, a))
}
