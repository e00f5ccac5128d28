//! Binary glTF 2.0 (Khronos): the vertices of its scene, each mesh as often as a node places it, at that place. Normals and
//! the first set of colours are taken where every mesh has them. Quantised and sparse values are read; compressed meshes
//! (Draco, meshopt) and data outside of the file are not. Where points are taken from its triangles, they have the colours of
//! its materials and their textures. A mesh of one material keeps these (`skin`).
//!
//! Why not the crate `gltf`: it trusts what a file says of its own bytes, knows of no quantised positions, and is larger
//! than all readers here together.

mod accessor;
mod materials;
mod scene;
mod skin;

use super::colors::ColorRange;
use super::faces::triangles::{Face, Faces, NONE};
use super::input::Input;
use super::parser::{Parser, Step};
use super::raw_cloud::Skin;
use super::table::{Columns, Table};
use crate::base::error::Result;
use crate::base::srgb::srgb;
use accessor::Accessor;
use materials::Placing;
use scene::{Document, Placed};

/// Meshes that many nodes place make many points of few bytes: no more than these are believed.
const MOST_POINTS: usize = 1 << 27;

/// Reads the vertices.
#[derive(Default)]
pub(super) struct Glb {
    count: u64,
    /// Where they are wanted.
    faces: Option<Faces>,
    /// Whether the pictures are wanted as they are; and these.
    wears: bool,
    skin: Option<Skin>,
}

impl Glb {
    pub(super) fn new(faces: Option<Faces>, wears: bool) -> Glb {
        Glb {
            faces,
            wears,
            ..Glb::default()
        }
    }
}

impl Parser for Glb {
    fn parse(&mut self, input: &mut Input, table: &mut Option<Table>) -> Result<Step> {
        if !input.last {
            return Ok(Step::More);
        }
        let (document, buffer) = chunks(input)?;
        let parts = scene::parts(&document, input)?;
        let placed = parts
            .iter()
            .filter_map(|part| part.primitive.attributes.get("POSITION"));
        let counts = placed
            .filter_map(|&index| document.accessors.get(index).map(|accessor| accessor.count));
        let points = counts.fold(0usize, usize::saturating_add);
        if points > MOST_POINTS {
            let found = format!("{points} once its nodes have placed them");
            return Err(input.unsupported(&format!("at most {MOST_POINTS} vertices"), found));
        }
        let wanted = self.faces.is_some();
        // What some meshes have and others lack is known to the faces, and would be wrong of points.
        let has = |name: &str| {
            let mut have = parts
                .iter()
                .map(|part| part.primitive.attributes.contains_key(name));
            if wanted {
                have.any(|has| has)
            } else {
                !parts.is_empty() && have.all(|has| has)
            }
        };
        let columns = Columns {
            normal: has("NORMAL").then_some([3, 4, 5]),
            color: has("COLOR_0").then_some([6, 7, 8]),
            colors: ColorRange::Unit,
            ..Columns::xyz()
        };
        let table = table.insert(Table::new(columns, None));
        table.gone = wanted.then(Vec::new);
        let placings = match &mut self.faces {
            Some(faces) => materials::looks(&document, buffer, faces),
            None => Vec::new(),
        };
        if let ([part], true) = (&parts[..], self.wears) {
            self.skin = skin::of(part, &document, buffer, input)?;
        }
        for part in &parts {
            self.push(part, &document, buffer, &placings, input, table)?;
        }
        Ok(Step::Done)
    }

    fn faces(&self) -> u64 {
        self.count
    }

    fn waits_for_faces(&self) -> bool {
        self.faces.is_some()
    }

    fn take_faces(&mut self) -> Option<Faces> {
        self.faces.take()
    }

    fn take_skin(&mut self) -> Option<Skin> {
        self.skin.take()
    }
}

impl Glb {
    fn push(
        &mut self,
        part: &Placed,
        document: &Document,
        buffer: &[u8],
        placings: &[Option<Placing>],
        input: &Input,
        table: &mut Table,
    ) -> Result<()> {
        let attributes = &part.primitive.attributes;
        let open = |name: &str| match attributes.get(name) {
            Some(&index) => Accessor::open(document, index, buffer, input).map(Some),
            None => Ok(None),
        };
        let Some(positions) = open("POSITION")? else {
            return Ok(());
        };
        let [normals, colors] = [open("NORMAL")?, open("COLOR_0")?];
        for other in [&normals, &colors].into_iter().flatten() {
            if other.count != positions.count {
                let expected = format!(
                    "{} normals and colours, as there are positions",
                    positions.count
                );
                return Err(input.bad_byte(20, &expected, other.count.to_string()));
            }
        }
        let indices = match part.primitive.indices {
            Some(index) => Some(Accessor::open(document, index, buffer, input)?),
            None => None,
        };
        let corners = indices
            .as_ref()
            .map_or(positions.count, |indices| indices.count);
        let mode = part.primitive.mode.unwrap_or(TRIANGLES);
        self.count += match mode {
            TRIANGLES => corners as u64 / 3,
            STRIP | FAN => (corners as u64).saturating_sub(2),
            _ => 0,
        };
        let first = table.next_row() as u32;
        for i in 0..positions.count {
            let mut row = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
            row[..3].copy_from_slice(&part.transform.point(positions.triple(i)));
            if let Some(normals) = &normals {
                row[3..6].copy_from_slice(&part.transform.normal(normals.triple(i)));
            }
            if let Some(colors) = &colors {
                row[6..].copy_from_slice(&colors.triple(i).map(srgb));
            }
            table.push(&row);
        }
        let Some(faces) = &mut self.faces else {
            return Ok(());
        };
        let look = part.primitive.material;
        let placing = look.and_then(|look| placings.get(look)?.as_ref());
        let places = match placing {
            Some(placing) => open(&format!("TEXCOORD_{}", placing.set))?,
            None => None,
        };
        let place = |i: usize| match (placing, &places) {
            (Some(placing), Some(places)) if i < places.count => placing.place(places.triple(i)),
            _ => [0.0; 2],
        };
        faces.places.extend((0..positions.count).map(place));
        let row = |corner: usize| {
            let i = indices
                .as_ref()
                .map_or(corner, |indices| indices.triple(corner)[0] as usize);
            // A vertex that the part has not is none of the file.
            if i < positions.count {
                first + i as u32
            } else {
                NONE
            }
        };
        let mirrored = part.transform.mirrors();
        let mut push = |[a, b, c]: [usize; 3]| {
            let [a, b, c] = [row(a), row(b), row(c)];
            let rows = if mirrored { [a, c, b] } else { [a, b, c] };
            let look = look.map(|look| look as u32);
            faces.push(
                Face {
                    rows: &rows,
                    look,
                    ..Face::default()
                },
                |_| None,
            );
        };
        match mode {
            TRIANGLES => (0..corners / 3).for_each(|i| push([3 * i, 3 * i + 1, 3 * i + 2])),
            STRIP => (2..corners).for_each(|i| push([i - 2, i - 1 + i % 2, i - i % 2])),
            FAN => (2..corners).for_each(|i| push([0, i - 1, i])),
            _ => {}
        }
        Ok(())
    }
}

/// Modes of primitives that have triangles.
const TRIANGLES: u32 = 4;
const STRIP: u32 = 5;
const FAN: u32 = 6;

/// The file's two chunks: its description, and its data.
fn chunks<'a>(input: &Input<'a>) -> Result<(Document, &'a [u8])> {
    const HEADER: usize = 12;
    let bytes = input.rest();
    let number = |at: usize| {
        bytes
            .get(at..at + 4)
            .and_then(|b| b.first_chunk())
            .map(|b| u32::from_le_bytes(*b))
    };
    if !bytes.starts_with(b"glTF") {
        return Err(input.bad_byte(
            0,
            "\"glTF\"",
            super::text::quote(&bytes[..bytes.len().min(4)]),
        ));
    }
    match number(4) {
        Some(2) => {}
        Some(version) => return Err(input.unsupported("version 2", format!("version {version}"))),
        None => return Err(input.no_bytes(HEADER as u64, "the header")),
    }
    let chunk = |at: usize, kind: &[u8; 4]| {
        let length = number(at)? as usize;
        let content = bytes.get(at + 8..(at + 8).checked_add(length)?)?;
        (bytes.get(at + 4..at + 8)? == kind).then_some(content)
    };
    let Some(json) = chunk(HEADER, b"JSON") else {
        return Err(input.bad_byte(HEADER as u64, "a JSON chunk within the file", "none"));
    };
    let document: Document = serde_json::from_slice(json).map_err(|error| {
        // The text is one line mostly: the column says where.
        let at = (HEADER + 8 + error.column()) as u64;
        input.bad_byte(at, "a description as JSON", error.to_string())
    })?;
    let data = HEADER + 8 + json.len().next_multiple_of(4);
    Ok((document, chunk(data, b"BIN\0").unwrap_or_default()))
}
