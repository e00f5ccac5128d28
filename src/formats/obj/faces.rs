//! The faces of an OBJ file: corners as `vertex/place/normal`, counted from 1, or from the last one backwards; and which material
//! of which library they have.

use super::super::faces::looks::Look;
use super::super::faces::triangles::{Face, Faces, NONE};
use super::super::table::Table;
use super::super::text::{number, words};

pub(super) struct ObjFaces {
    pub(super) faces: Faces,
    look: Option<u32>,
    /// Corners of the face at hand: vertices, places, normals.
    corners: [Vec<u32>; 3],
}

impl ObjFaces {
    pub(super) fn new(faces: Faces) -> ObjFaces {
        ObjFaces {
            faces,
            look: None,
            corners: Default::default(),
        }
    }

    /// A line `f`. A corner that is no number names no vertex, so that its face is left out.
    pub(super) fn face(&mut self, line: &[u8], table: &Table) {
        let counts = [
            table.next_row(),
            self.faces.places.len() as u64,
            self.faces.normals.len() as u64,
        ];
        self.corners.iter_mut().for_each(Vec::clear);
        for corner in words(line)
            .skip(1)
            .take_while(|word| !word.starts_with(b"#"))
        {
            let mut indices = corner.split(|&b| b == b'/');
            for (list, count) in self.corners.iter_mut().zip(counts) {
                list.push(index(indices.next().unwrap_or_default(), count));
            }
        }
        let [rows, places, normals] = &self.corners;
        let named = |list: &'_ [u32]| list.iter().any(|&i| i != NONE);
        let face = Face {
            rows,
            places: if named(places) { places } else { &[] },
            normals: if named(normals) { normals } else { &[] },
            look: self.look,
            ..Face::default()
        };
        self.faces.push(face, |row| table.position(row));
    }

    /// A line of another kind.
    pub(super) fn other(&mut self, key: &[u8], line: &[u8]) {
        let line = line.trim_ascii();
        let rest = line.get(key.len()..).unwrap_or_default().trim_ascii();
        let name = || String::from_utf8_lossy(rest).into_owned();
        match key {
            b"vt" => {
                let mut values = words(rest).map(|word| number(word).unwrap_or(0.0) as f32);
                let mut next = || values.next().unwrap_or(0.0);
                let (u, v) = (next(), next());
                self.faces.places.push([u, 1.0 - v]);
            }
            b"mtllib" => {
                for name in libraries(rest) {
                    if !self.faces.libraries.contains(&name) {
                        self.faces.libraries.push(name);
                    }
                }
            }
            b"usemtl" => {
                let names = &mut self.faces.look_names;
                let known = names.iter().position(|known| *known == name());
                self.look = Some(known.unwrap_or_else(|| {
                    names.push(name());
                    self.faces.looks.push(Look::default());
                    names.len() - 1
                }) as u32);
            }
            _ => {}
        }
    }

    pub(super) fn finish(mut self) -> Faces {
        // Without a material nothing of a library shows.
        if self.faces.look_names.is_empty() {
            self.faces.libraries.clear();
        }
        self.faces
    }
}

/// Names of libraries: one, which may have blanks and quotes, or several that all end as libraries do.
fn libraries(rest: &[u8]) -> Vec<String> {
    let text = |name: &[u8]| String::from_utf8_lossy(name).trim_matches('"').to_owned();
    let is_whole = |name: &[u8]| name.to_ascii_lowercase().ends_with(b".mtl");
    if words(rest).all(is_whole) {
        words(rest).map(text).collect()
    } else {
        vec![text(rest)]
    }
}

/// An index from 0, of one that counts from 1 or backwards from the `count` so far.
fn index(word: &[u8], count: u64) -> u32 {
    let number = std::str::from_utf8(word)
        .ok()
        .and_then(|word| word.parse::<i64>().ok());
    let at = match number {
        Some(i @ 1..) => Some(i - 1),
        Some(i @ ..=-1) => i.checked_add(count as i64),
        _ => None,
    };
    at.and_then(|at| u32::try_from(at).ok()).unwrap_or(NONE)
}
