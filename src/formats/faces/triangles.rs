//! Triangles over the rows of a table, as parsers collect them, and what they still need.

use super::looks::{Look, Picture};
use super::polygons;

/// What the faces need besides their own file.
#[derive(Debug, Clone, PartialEq)]
pub enum Want {
    /// The content of a file beside it, by the name that it is called by.
    File(String),
    /// The pixels of a picture, of a PNG, JPEG or WebP file's bytes.
    Picture(Vec<u8>),
}

/// A picture that textures show.
pub(in crate::formats) enum Source {
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
pub(in crate::formats) struct Faces {
    /// Rows of the corners, counted with those that the table left out.
    pub(in crate::formats) corners: Vec<[u32; 3]>,
    /// Normals that are not the rows' own, and which of them each triangle's corners have.
    pub(in crate::formats) normals: Vec<[f32; 3]>,
    pub(in crate::formats) normal_corners: Vec<[u32; 3]>,
    /// Places in a picture, the first row at the top, and which of them each triangle's corners have: those of the rows where
    /// there is no list.
    pub(in crate::formats) places: Vec<[f32; 2]>,
    pub(in crate::formats) place_corners: Vec<[u32; 3]>,
    /// Colour of each triangle, 0-255.
    pub(in crate::formats) colors: Vec<[u8; 3]>,
    /// Which of the looks each triangle has.
    pub(in crate::formats) look_of: Vec<u32>,
    pub(in crate::formats) looks: Vec<Look>,
    /// Name of each look in the file's own libraries, and those libraries that were not read yet.
    pub(in crate::formats) look_names: Vec<String>,
    pub(in crate::formats) libraries: Vec<String>,
    pub(in crate::formats) pictures: Vec<Source>,
    /// Files that were asked for and not found, and pictures that are of no kind that is read.
    pub(in crate::formats) missing: Vec<String>,
    /// Faces with a corner that there is not.
    pub(in crate::formats) broken: u64,
}

/// A face on its way in: a polygon. Lists have one entry a corner, or none.
#[derive(Default)]
pub(in crate::formats) struct Face<'a> {
    pub(in crate::formats) rows: &'a [u32],
    pub(in crate::formats) places: &'a [u32],
    pub(in crate::formats) normals: &'a [u32],
    pub(in crate::formats) color: Option<[u8; 3]>,
    pub(in crate::formats) look: Option<u32>,
}

/// Adds an entry to a list that has one for each of the `before` triangles, or none as long as nobody says any.
fn add<T: Copy>(list: &mut Vec<T>, before: usize, entry: Option<T>, nothing: T) {
    if entry.is_some() || !list.is_empty() {
        list.resize(before, nothing);
        list.push(entry.unwrap_or(nothing));
    }
}

/// Stands for no normal and no place of a corner.
pub(in crate::formats) const NONE: u32 = u32::MAX;

impl Faces {
    /// Adds a face; `position` gives those of its rows that are known.
    pub(in crate::formats) fn push(
        &mut self,
        face: Face,
        position: impl Fn(u32) -> Option<[f64; 3]>,
    ) {
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
    pub(in crate::formats) fn want(&self) -> Option<Want> {
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
    pub(in crate::formats) fn give_file(&mut self, content: Option<&[u8]>) {
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
    pub(in crate::formats) fn give_picture(&mut self, picture: Option<Picture>) {
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
    pub(super) fn settle(&mut self, gone: &[u32], points: usize) {
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
