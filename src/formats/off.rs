//! OFF (Geomview, 1996), as text: `OFF`, before it `C` for colours, `N` for normals, `ST` for texture; the counts of vertices
//! and faces; then a vertex a line. Colours may follow the coordinates without the `C`, too. Comments start with `#`.

use super::faces::triangles::{Face, Faces, NONE};
use super::input::Input;
use super::parser::{Parser, Step};
use super::table::{Columns, Table};
use super::text::{number, words};
use crate::base::error::Result;

/// Whether the first line that is no comment starts as an OFF file does.
pub(super) fn looks_like(head: &[u8]) -> bool {
    head.split(|&b| b == b'\n' || b == b'\r')
        .map(|line| first_word(without_comment(line)))
        .find(|word| !word.is_empty())
        .is_some_and(|word| Kind::of(word).is_some())
}

/// The first word, without a count that is not kept apart from it: `OFF240 0 0`, as in ModelNet.
fn first_word(line: &[u8]) -> &[u8] {
    let word = words(line).next().unwrap_or_default();
    let digits = word.iter().rev().take_while(|b| b.is_ascii_digit()).count();
    &word[..word.len() - digits]
}

/// What the first word says that each vertex has.
#[derive(Clone, Copy)]
struct Kind {
    texture: bool,
    colors: bool,
    normals: bool,
}

impl Kind {
    fn of(word: &[u8]) -> Option<Kind> {
        let mut before = word.strip_suffix(b"OFF")?;
        let mut has = |mark: &[u8]| match before.strip_prefix(mark) {
            Some(rest) => {
                before = rest;
                true
            }
            None => false,
        };
        let kind = Kind {
            texture: has(b"ST"),
            colors: has(b"C"),
            normals: has(b"N"),
        };
        before.is_empty().then_some(kind)
    }
}

/// Reads the vertices.
#[derive(Default)]
pub(super) struct Off {
    kind: Option<Kind>,
    /// Of vertices and faces.
    counts: Option<[u64; 2]>,
    /// Vertices so far.
    row: u64,
    /// Values a vertex.
    width: usize,
    values: Vec<f64>,
    /// Faces so far, and what they are where they are wanted.
    face: u64,
    faces: Option<Faces>,
}

impl Off {
    pub(super) fn new(faces: Option<Faces>) -> Off {
        Off {
            faces,
            ..Off::default()
        }
    }
}

impl Parser for Off {
    fn parse(&mut self, input: &mut Input, table: &mut Option<Table>) -> Result<Step> {
        loop {
            let is_done = |[vertices, faces]: [u64; 2]| {
                self.row >= vertices && (self.faces.is_none() || self.face >= faces)
            };
            if self.counts.is_some_and(is_done) {
                return Ok(Step::Done);
            }
            let Some(line) = input.line()? else {
                return if input.last {
                    Err(input.no_line(&self.expected()))
                } else {
                    Ok(Step::More)
                };
            };
            let line = without_comment(line).trim_ascii();
            if !line.is_empty() {
                self.line(line, input, table)?;
            }
        }
    }

    fn faces(&self) -> u64 {
        self.counts.map_or(0, |[_, faces]| faces)
    }

    fn waits_for_faces(&self) -> bool {
        self.faces.is_some()
    }

    fn take_faces(&mut self) -> Option<Faces> {
        self.faces.take()
    }
}

impl Off {
    fn expected(&self) -> String {
        match (self.kind, self.counts) {
            (None, _) => "\"OFF\"".into(),
            (_, None) => "the counts of vertices and faces".into(),
            (_, Some([vertices, _])) if self.row < vertices => {
                format!("one of {vertices} vertices")
            }
            (_, Some([_, faces])) => format!("one of {faces} faces"),
        }
    }

    fn line(&mut self, line: &[u8], input: &Input, table: &mut Option<Table>) -> Result<()> {
        let mut rest = line;
        if self.kind.is_none() {
            let word = first_word(line);
            self.kind = Some(Kind::of(word).ok_or_else(|| input.bad_line("\"OFF\"", line))?);
            rest = line[word.len()..].trim_ascii();
            if rest == b"BINARY" {
                return Err(input.unsupported("OFF as text", "binary OFF"));
            }
            if rest.is_empty() {
                return Ok(());
            }
        }
        if self.counts.is_none() {
            let counts: Vec<Option<u64>> = words(rest)
                .map(|word| {
                    std::str::from_utf8(word)
                        .ok()
                        .and_then(|word| word.parse().ok())
                })
                .collect();
            match counts[..] {
                [Some(vertices), Some(faces)] | [Some(vertices), Some(faces), _] => {
                    self.counts = Some([vertices, faces]);
                    // Then the next lines are faces.
                    if vertices == 0 {
                        let table = table.insert(Table::new(Columns::xyz(), Some(0)));
                        table.gone = self.faces.is_some().then(Vec::new);
                    }
                }
                _ => return Err(input.bad_line("the counts of vertices, faces and edges", line)),
            }
            return Ok(());
        }
        self.values.clear();
        for word in words(line) {
            self.values
                .push(number(word).ok_or_else(|| input.bad_line("a number", word))?);
        }
        if let (Some([vertices, _]), Some(table)) = (self.counts, &table)
            && self.row >= vertices
        {
            self.face += 1;
            if let Some(faces) = &mut self.faces {
                push_face(&self.values, faces, table);
            }
            return Ok(());
        }
        let table = match table {
            Some(table) => table,
            None => {
                self.width = self.values.len();
                let columns = self
                    .columns()
                    .ok_or_else(|| input.bad_line("the coordinates of a vertex", line))?;
                let vertices = self.counts.map_or(0, |[vertices, _]| vertices);
                // A digit and its separator for each coordinate, and this line is taken already.
                let most = vertices.min(input.left() / 6 + 2);
                let table = table.insert(Table::new(columns, Some(most)));
                table.gone = self.faces.is_some().then(Vec::new);
                table
            }
        };
        if self.values.len() != self.width {
            return Err(input.bad_line(&format!("{} values", self.width), line));
        }
        table.push(&self.values);
        self.row += 1;
        Ok(())
    }

    /// What the values of a vertex are, by the first word and by how many they are.
    fn columns(&self) -> Option<Columns> {
        let kind = self.kind?;
        let mut names: Vec<&str> = vec!["x", "y", "z"];
        if kind.normals {
            names.extend(["nx", "ny", "nz"]);
        }
        let texture = if kind.texture { 2 } else { 0 };
        match (self.width.checked_sub(names.len() + texture)?, kind.colors) {
            (0, false) => {}
            (3, _) => names.extend(["red", "green", "blue"]),
            (4, _) => names.extend(["red", "green", "blue", ""]),
            _ => return None,
        }
        let names: Vec<String> = names.into_iter().map(String::from).collect();
        let mut columns = Columns::from_names(&names)?;
        // The alpha of a colour is no attribute.
        columns.scalars.clear();
        Some(columns)
    }
}

/// A face: how many corners, which, and a colour, of bytes or from 0 to 1.
fn push_face(values: &[f64], faces: &mut Faces, table: &Table) {
    let count = values.first().map_or(0, |&count| count as usize);
    let row = |&x: &f64| if x >= 0.0 { x as u32 } else { NONE };
    let rows: Vec<u32> = values.iter().skip(1).take(count).map(row).collect();
    let color = match values.get(count.saturating_add(1)..) {
        Some(&[r, g, b]) | Some(&[r, g, b, _]) => {
            let scale = if [r, g, b].iter().all(|&c| c <= 1.0) {
                255.0
            } else {
                1.0
            };
            Some([r, g, b].map(|c| (scale * c).round() as u8))
        }
        _ => None,
    };
    let face = Face {
        rows: &rows,
        color,
        ..Face::default()
    };
    faces.push(face, |row| table.position(row));
}

/// A line up to its comment.
fn without_comment(line: &[u8]) -> &[u8] {
    line.split(|&b| b == b'#').next().unwrap_or_default()
}
