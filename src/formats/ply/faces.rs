//! The faces of a PLY file: the lists `vertex_indices` (or `vertex_index`) of the element `face`, with colours, and with the
//! `texcoord` lists and `comment TextureFile` of MeshLab and of photogrammetry; strips of the element `tristrips`.

use super::super::faces::looks::{Look, Texture};
use super::super::faces::triangles::{Face, Faces, NONE};
use super::super::table::Table;
use super::header::{Element, Header, Property};

/// What a face's row holds where.
pub(super) struct Layout {
    pub(super) strips: bool,
    /// Which of the lists names the vertices, and which the places in a picture.
    corners: usize,
    places: Option<usize>,
    /// The places in a picture are those of the rows.
    pub(super) by_row: bool,
    /// Which of the values are the colour, and which the picture's number.
    color: Option<[usize; 3]>,
    picture: Option<usize>,
}

impl Layout {
    /// `None` where the element has no faces.
    pub(super) fn of(element: &Element) -> Option<Layout> {
        let strips = element.name == "tristrips";
        if !strips && element.name != "face" {
            return None;
        }
        let lists = || {
            element
                .properties
                .iter()
                .filter_map(|property| match property {
                    Property::List { name, .. } => Some(name.as_str()),
                    Property::One { .. } => None,
                })
        };
        let names = element.names();
        let value = |name: &str| names.iter().position(|other| other == name);
        let color = || Some([value("red")?, value("green")?, value("blue")?]);
        Some(Layout {
            strips,
            corners: lists().position(|name| name == "vertex_indices" || name == "vertex_index")?,
            by_row: false,
            places: lists().position(|name| name == "texcoord"),
            color: color(),
            picture: value("texnumber"),
        })
    }

    /// Adds a row: its values, and its lists one behind the other with their ends.
    pub(super) fn push(
        &self,
        values: &[f64],
        lists: &Lists,
        faces: &mut Faces,
        table: Option<&Table>,
    ) {
        // What is no index is no vertex either: such a face is left out later.
        let rows: Vec<u32> = lists
            .of(self.corners)
            .iter()
            .map(|&x| if x >= 0.0 { x as u32 } else { NONE })
            .collect();
        let position = |row| table.and_then(|table| table.position(row));
        if self.strips {
            return strips(&rows, faces);
        }
        let places = self.places.map_or(&[][..], |list| lists.of(list));
        let known = !rows.is_empty() && places.len() == 2 * rows.len();
        let first = faces.places.len() as u32;
        if known {
            faces.places.extend(
                places
                    .chunks_exact(2)
                    .map(|uv| [uv[0] as f32, 1.0 - uv[1] as f32]),
            );
        }
        let place_of: Vec<u32> = if known {
            (first..).take(rows.len()).collect()
        } else {
            Vec::new()
        };
        // Floats from 0 to 1 are as rare as a face's colour of 1 of 255.
        let byte = |c: f64| {
            if c <= 1.0 && c.fract() != 0.0 {
                255.0 * c
            } else {
                c
            }
        };
        let color = self
            .color
            .map(|at| at.map(|i| byte(values[i]).round() as u8));
        let picture = self.picture.map_or(0, |i| values[i] as u32);
        let face = Face {
            rows: &rows,
            places: &place_of,
            color,
            look: (known || self.by_row).then_some(picture),
            ..Face::default()
        };
        faces.push(face, position);
    }
}

/// Strips of triangles, each turned the other way; -1 ends one.
fn strips(rows: &[u32], faces: &mut Faces) {
    for strip in rows.split(|&row| row == NONE) {
        for (i, three) in strip.windows(3).enumerate() {
            let [a, b, c] = [three[0], three[1], three[2]];
            let rows = if i % 2 == 0 { [a, b, c] } else { [b, a, c] };
            faces.push(
                Face {
                    rows: &rows,
                    ..Face::default()
                },
                |_| None,
            );
        }
    }
}

/// The looks that the header names, one a picture.
pub(super) fn looks(header: &Header, faces: &mut Faces) {
    for name in &header.textures {
        let picture = faces.picture_beside(name.clone());
        faces.looks.push(Look {
            texture: Some(Texture::of(picture)),
            ..Look::default()
        });
    }
}

/// Which values of the points' rows are places in a picture, where no face has its own and the points come first.
pub(super) fn places_of_rows(header: &Header, points: usize) -> Option<[usize; 2]> {
    const NAMES: [[&str; 2]; 4] = [
        ["s", "t"],
        ["u", "v"],
        ["texture_u", "texture_v"],
        ["texcoord_u", "texcoord_v"],
    ];
    let layouts = || {
        header
            .elements
            .iter()
            .enumerate()
            .filter_map(|(i, e)| Some((i, Layout::of(e)?)))
    };
    let own = layouts().any(|(i, layout)| layout.places.is_some() || i < points);
    if header.textures.is_empty() || own {
        return None;
    }
    let names = header.elements[points].names();
    let at = |wanted: &str| names.iter().position(|name| name == wanted);
    NAMES.iter().find_map(|[u, v]| Some([at(u)?, at(v)?]))
}

/// The lists of a row.
#[derive(Default)]
pub(super) struct Lists {
    pub(super) items: Vec<f64>,
    pub(super) ends: Vec<usize>,
}

impl Lists {
    pub(super) fn clear(&mut self) {
        self.items.clear();
        self.ends.clear();
    }

    fn of(&self, list: usize) -> &[f64] {
        let start = if list == 0 { 0 } else { self.ends[list - 1] };
        &self.items[start..self.ends[list]]
    }
}
