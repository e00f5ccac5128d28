//! STL (3D Systems, 1989), ascii and binary: the vertices of its triangles. Every triangle repeats its corners, so vertices
//! of exactly equal coordinates are one point, where it came first.

use super::faces::triangles::{Face, Faces};
use super::input::Input;
use super::parser::{Parser, Step};
use super::table::{Columns, Precision, Table};
use super::text::{number, words};
use crate::base::error::Result;
use std::collections::HashMap;

/// Before the triangles of a binary file: 80 bytes of any content and their count.
const HEADER: u64 = 84;
/// Bytes of a triangle: its normal, three vertices, and two more.
const TRIANGLE: usize = 50;

/// Whether the size is that of a binary file, or the content starts as an ascii file does.
pub(super) fn looks_like(head: &[u8], size: u64) -> bool {
    let text = head.trim_ascii_start();
    let ascii = || {
        let solid = text.len() >= 5 && text[..5].eq_ignore_ascii_case(b"solid");
        let keyword = |word: &[u8]| {
            [&b"facet"[..], b"endsolid"]
                .iter()
                .any(|key| word.eq_ignore_ascii_case(key))
        };
        solid
            && text
                .split(|&b| b == b'\n' || b == b'\r')
                .skip(1)
                .filter_map(|line| words(line).next())
                .any(keyword)
    };
    is_binary(head, size) || ascii()
}

/// Whether the count of triangles is that of the size. A binary file's header may start with "solid", too.
fn is_binary(head: &[u8], size: u64) -> bool {
    match head.get(80..84) {
        Some(&[a, b, c, d]) => {
            let count = u32::from_le_bytes([a, b, c, d]);
            count > 0 && size == HEADER + u64::from(count) * TRIANGLE as u64
        }
        _ => false,
    }
}

/// Reads the vertices.
#[derive(Default)]
pub(super) struct Stl {
    kind: Option<Kind>,
    /// Number of the row of each vertex.
    seen: HashMap<[u32; 3], u32>,
    triangles: u64,
    /// Rows of the triangle at hand.
    corners: Vec<u32>,
    /// Where they are wanted.
    faces: Option<Faces>,
}

impl Stl {
    pub(super) fn new(faces: Option<Faces>) -> Stl {
        Stl {
            faces,
            ..Stl::default()
        }
    }
}

enum Kind {
    /// How many triangles there are.
    Binary(u32),
    /// The vertices since the last triangle ended, and whether a solid is open.
    Ascii { corners: u8, open: bool },
}

impl Parser for Stl {
    fn parse(&mut self, input: &mut Input, table: &mut Option<Table>) -> Result<Step> {
        if self.kind.is_none() {
            let head = input.rest();
            if head.len() < HEADER as usize && !input.last {
                return Ok(Step::More);
            }
            self.kind = Some(kind(input)?);
        }
        let table = table.get_or_insert_with(|| {
            let mut table = Table::new(columns(), None);
            table.gone = self.faces.is_some().then(Vec::new);
            table
        });
        match self.kind {
            Some(Kind::Binary(count)) => self.binary(count, input, table),
            _ => self.ascii(input, table),
        }
    }

    fn faces(&self) -> u64 {
        self.triangles
    }

    fn waits_for_faces(&self) -> bool {
        self.faces.is_some()
    }

    fn take_faces(&mut self) -> Option<Faces> {
        self.faces.take()
    }
}

/// What kind of file it is; a binary one's header is taken.
fn kind(input: &mut Input) -> Result<Kind> {
    // No more than a binary header, however many bytes are at hand: slices must not matter.
    let head = &input.rest()[..input.rest().len().min(HEADER as usize)];
    let ascii = Kind::Ascii {
        corners: 0,
        open: false,
    };
    let starts = head.trim_ascii_start();
    let solid = starts.len() >= 5 && starts[..5].eq_ignore_ascii_case(b"solid");
    // Text has no zeros: what has is a binary file, cut off.
    if solid && !head.contains(&0) && !is_binary(head, input.size) {
        return Ok(ascii);
    }
    match input.take(HEADER as usize) {
        Some(&[.., a, b, c, d]) => Ok(Kind::Binary(u32::from_le_bytes([a, b, c, d]))),
        _ => Err(input.no_bytes(HEADER, "the header, or \"solid\"")),
    }
}

impl Stl {
    fn binary(&mut self, count: u32, input: &mut Input, table: &mut Table) -> Result<Step> {
        let count = u64::from(count);
        let missing = (count - self.triangles) * TRIANGLE as u64;
        if missing > input.left() {
            return Err(input.no_bytes(missing, &format!("{count} triangles")));
        }
        while self.triangles < count {
            let Some(triangle) = input.take(TRIANGLE) else {
                let missing = (count - self.triangles) * TRIANGLE as u64;
                return if input.last {
                    Err(input.no_bytes(missing, &format!("{count} triangles")))
                } else {
                    Ok(Step::More)
                };
            };
            for corner in triangle[12..48].chunks_exact(12) {
                let value = |at: usize| {
                    f32::from_le_bytes([corner[at], corner[at + 1], corner[at + 2], corner[at + 3]])
                };
                self.vertex([0, 4, 8].map(value), table);
            }
            self.triangle();
        }
        Ok(Step::Done)
    }

    fn ascii(&mut self, input: &mut Input, table: &mut Table) -> Result<Step> {
        let Some(Kind::Ascii {
            mut corners,
            mut open,
        }) = self.kind
        else {
            return Ok(Step::Done);
        };
        while let Some(line) = input.line()? {
            let mut words = words(line);
            let key = words.next().unwrap_or_default().to_ascii_lowercase();
            match &key[..] {
                b"solid" => open = true,
                b"endsolid" => open = false,
                b"vertex" => {
                    let mut vertex = [0.0; 3];
                    for value in &mut vertex {
                        let word = words.next().unwrap_or_default();
                        *value = number(word)
                            .ok_or_else(|| input.bad_line("the 3 coordinates of a vertex", line))?
                            as f32;
                    }
                    corners += 1;
                    self.vertex(vertex, table);
                }
                b"endfacet" if corners == 3 => {
                    corners = 0;
                    self.triangle();
                }
                b"endfacet" => {
                    return Err(
                        input.bad_line(&format!("3 vertices before it, not {corners}"), line)
                    );
                }
                b"" | b"facet" | b"outer" | b"endloop" | b"color" => {}
                _ => {
                    return Err(input.bad_line(
                        "a line of an STL file (solid, facet, outer loop, vertex …)",
                        line,
                    ));
                }
            }
            if corners > 3 {
                return Err(input.bad_line("the end of a triangle", line));
            }
        }
        self.kind = Some(Kind::Ascii { corners, open });
        match (input.last, open) {
            (false, _) => Ok(Step::More),
            (true, true) => Err(input.no_line("\"endsolid\"")),
            (true, false) => Ok(Step::Done),
        }
    }

    fn vertex(&mut self, vertex: [f32; 3], table: &mut Table) {
        let row = table.next_row() as u32;
        // Both zeros are one.
        let seen = *self
            .seen
            .entry(vertex.map(|x| (x + 0.0).to_bits()))
            .or_insert_with(|| {
                table.push(&vertex.map(f64::from));
                row
            });
        self.corners.push(seen);
    }

    /// The vertices since the last one are a triangle.
    fn triangle(&mut self) {
        if let Some(faces) = &mut self.faces {
            let rows = &self.corners;
            faces.push(
                Face {
                    rows,
                    ..Face::default()
                },
                |_| None,
            );
        }
        self.corners.clear();
        self.triangles += 1;
    }
}

fn columns() -> Columns {
    Columns {
        precision: Precision::Single,
        ..Columns::xyz()
    }
}
