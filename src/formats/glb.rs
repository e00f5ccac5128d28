//! Binary glTF 2.0 (Khronos): the vertices of its scene, each mesh as often as a node places it, at that place. Normals and
//! the first set of colours are taken where every mesh has them. Quantised and sparse values are read; compressed meshes
//! (Draco, meshopt) and data outside of the file are not.
//!
//! Why not the crate `gltf`: it trusts what a file says of its own bytes, knows of no quantised positions, and is larger
//! than all readers here together.

mod accessor;
mod scene;

use super::colors::ColorRange;
use super::input::Input;
use super::reading::{Parser, Step};
use super::table::{Columns, Table};
use crate::base::error::Result;
use accessor::Accessor;
use scene::{Document, Placed};

/// Meshes that many nodes place make many points of few bytes: no more than these are believed.
const MOST_POINTS: usize = 1 << 27;

/// Reads the vertices.
#[derive(Default)]
pub(super) struct Glb {
    faces: u64,
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
        let has = |name: &str| {
            !parts.is_empty()
                && parts
                    .iter()
                    .all(|part| part.primitive.attributes.contains_key(name))
        };
        let columns = Columns {
            normal: has("NORMAL").then_some([3, 4, 5]),
            color: has("COLOR_0").then_some([6, 7, 8]),
            colors: ColorRange::Unit,
            ..Columns::xyz()
        };
        let table = table.insert(Table::new(columns, None));
        for part in &parts {
            self.push(part, &document, buffer, input, table)?;
        }
        Ok(Step::Done)
    }

    fn faces(&self) -> u64 {
        self.faces
    }
}

impl Glb {
    fn push(
        &mut self,
        part: &Placed,
        document: &Document,
        buffer: &[u8],
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
        if part.primitive.mode.unwrap_or(4) == 4 {
            let corners = match part.primitive.indices {
                Some(index) => Accessor::open(document, index, buffer, input)?.count,
                None => positions.count,
            };
            self.faces += corners as u64 / 3;
        }
        for i in 0..positions.count {
            let mut row = [0.0; 9];
            row[..3].copy_from_slice(&part.transform.point(positions.triple(i)));
            if let Some(normals) = &normals {
                row[3..6].copy_from_slice(&part.transform.normal(normals.triple(i)));
            }
            if let Some(colors) = &colors {
                row[6..].copy_from_slice(&colors.triple(i).map(srgb));
            }
            table.push(&row);
        }
        Ok(())
    }
}

/// A share of linear light, which vertex colours of glTF are, as a share of the display's scale.
fn srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
    }
}

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
