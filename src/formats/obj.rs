//! Wavefront OBJ: its vertices, `v x y z`, with colours where they follow (`v x y z r g b`, from 0 to 1 or to 255). A
//! fourth value alone is a weight and is passed over, as is one after a colour.
//!
//! Normals (`vn`) are taken where they are the vertices' own: as many, and every face that names any has vertex and normal
//! of the same number. Faces are counted, or taken apart where points are taken from them. All else is passed over. Vertices without a colour, in a file where others have
//! one, are white.
//!
//! Why not a crate: `tobj` and `obj` read meshes, give up a file for its faces or materials, and know of no place for an
//! error.

mod faces;

use super::faces::triangles::Faces;
use super::input::Input;
use super::parser::{Parser, Step};
use super::table::{Columns, Table};
use super::text::{number, words};
use crate::base::error::Result;
use faces::ObjFaces;

/// Whether the first line that is no comment is one of an OBJ file.
pub(super) fn looks_like(head: &[u8]) -> bool {
    let lines = head
        .split(|&b| b == b'\n' || b == b'\r')
        .map(<[u8]>::trim_ascii);
    lines
        .filter(|line| !line.is_empty() && !line.starts_with(b"#"))
        .map(|line| {
            let mut words = words(line);
            let key = words.next().unwrap_or_default();
            let numbers = words.clone().filter(|word| number(word).is_some()).count();
            match key {
                b"v" | b"vn" => numbers >= 3,
                b"vt" => numbers >= 1,
                b"f" => {
                    words.all(|word| word.iter().all(|b| b.is_ascii_digit() || b"/-".contains(b)))
                }
                b"mtllib" | b"usemtl" | b"o" | b"g" => true,
                _ => false,
            }
        })
        .next()
        .unwrap_or(false)
}

/// Reads the vertices.
#[derive(Default)]
pub(super) struct Obj {
    /// A line that goes on in the next, after a backslash.
    begun: Vec<u8>,
    normals: u64,
    /// A face has a normal that is not its vertex's.
    normals_apart: bool,
    faces: u64,
    /// Where they are wanted.
    taken: Option<ObjFaces>,
}

impl Obj {
    pub(super) fn new(faces: Option<Faces>) -> Obj {
        Obj {
            taken: faces.map(ObjFaces::new),
            ..Obj::default()
        }
    }
}

impl Parser for Obj {
    fn parse(&mut self, input: &mut Input, table: &mut Option<Table>) -> Result<Step> {
        if input.place.byte == 0
            && (input.rest().starts_with(&[0xff, 0xfe]) || input.rest().starts_with(&[0xfe, 0xff]))
        {
            return Err(input.unsupported("UTF-8 or ASCII text", "UTF-16 text"));
        }
        let table = table.get_or_insert_with(|| {
            let mut table = Table::new(columns(), None);
            table.colors_said = false;
            table.gone = self.taken.is_some().then(Vec::new);
            table
        });
        while let Some(line) = input.line()? {
            if let Some(start) = line.strip_suffix(b"\\") {
                self.begun.extend(start);
                self.begun.push(b' ');
            } else if self.begun.is_empty() {
                self.line(line, input, table)?;
            } else {
                let mut whole = std::mem::take(&mut self.begun);
                whole.extend(line);
                self.line(&whole, input, table)?;
            }
            if self.begun.len() > 1 << 20 {
                return Err(input.bad_line("the end of a line that goes on within 1 MiB", line));
            }
        }
        if !input.last {
            return Ok(Step::More);
        }
        if !self.begun.is_empty() {
            let whole = std::mem::take(&mut self.begun);
            self.line(&whole, input, table)?;
        }
        if table.rows == 0 && table.dropped == 0 {
            return Err(input.no_line("vertices (lines that start with v)"));
        }
        table.normals_said =
            self.normals == table.rows && table.dropped == 0 && !self.normals_apart;
        Ok(Step::Done)
    }

    fn faces(&self) -> u64 {
        self.faces
    }

    fn waits_for_faces(&self) -> bool {
        self.taken.is_some()
    }

    fn take_faces(&mut self) -> Option<Faces> {
        self.taken.take().map(ObjFaces::finish)
    }
}

impl Obj {
    fn line(&mut self, line: &[u8], input: &Input, table: &mut Table) -> Result<()> {
        let mut words = words(line);
        match words.next() {
            Some(b"v") => {
                let mut row = [1.0; 6];
                let mut count = 0;
                for word in words.take_while(|word| !word.starts_with(b"#")) {
                    let value = number(word).ok_or_else(|| input.bad_line("a number", word))?;
                    if count < 6 {
                        row[count] = value;
                    }
                    count += 1;
                }
                match count {
                    3 | 4 => row[3..].fill(1.0),
                    6 | 7 => table.colors_said = true,
                    _ => return Err(input.bad_line("3 coordinates, or 3 and a colour", line)),
                }
                table.push(&row);
            }
            Some(b"vn") => {
                let mut normal = [0.0; 3];
                for value in &mut normal {
                    let word = words.next().unwrap_or_default();
                    *value = number(word)
                        .ok_or_else(|| input.bad_line("the 3 numbers of a normal", line))?
                        as f32;
                }
                let finite = normal.iter().all(|x| x.is_finite());
                let normal = if finite { normal } else { [0.0; 3] };
                self.normals += 1;
                table.push_normal(normal);
                if let Some(taken) = &mut self.taken {
                    taken.faces.normals.push(normal);
                }
            }
            Some(b"f") => {
                self.faces += 1;
                self.normals_apart |= words.any(|corner| {
                    let mut indices = corner.split(|&b| b == b'/');
                    let vertex = indices.next();
                    indices.nth(1).is_some_and(|normal| Some(normal) != vertex)
                });
                if let Some(taken) = &mut self.taken {
                    taken.face(line, table);
                }
            }
            Some(key) => {
                if let Some(taken) = &mut self.taken {
                    taken.other(key, line);
                }
            }
            None => {}
        }
        Ok(())
    }
}

fn columns() -> Columns {
    Columns {
        color: Some([3, 4, 5]),
        ..Columns::xyz()
    }
}
