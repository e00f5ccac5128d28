//! PLY (Greg Turk, 1994): a text header that names elements and their properties, then rows, as text or binary.
//!
//! Read are all three encodings, all scalar types in both spellings, list properties in any element, elements in any
//! order, comments and `obj_info` anywhere in the header, and any end of line. The points are the element `vertex`, or
//! else the first element with x, y and z. Normals are `nx ny nz`, colours `red green blue` (bytes, 16 bits, or floats
//! from 0 to 1); every other scalar is an attribute, lists are passed over. Elements after the points are looked at where
//! points are taken from faces.
//!
//! Why not a crate: `ply-rs-bw`, the one that is kept up, makes a map from property name to value for every row, or
//! calls back with the name for every value, and reports errors as text. Here columns and the line or byte are wanted.

mod faces;
mod header;

use super::faces::triangles::Faces;
use super::input::Input;
use super::parser::{Parser, Step};
use super::splats::SPLATS;
use super::table::Table;
use super::text::{number, words};
use crate::base::error::{Error, Result};
use faces::{Layout, Lists};
use header::{Element, Encoding, Header, HeaderLines, Packed, Property};

/// Whether the content starts as a PLY file does.
pub(super) fn looks_like(head: &[u8]) -> bool {
    let first = head
        .split(|&b| b == b'\n' || b == b'\r')
        .next()
        .unwrap_or_default();
    first.trim_ascii() == b"ply"
}

/// Reads the points.
#[derive(Default)]
pub(super) struct Ply {
    header: HeaderLines,
    rows: Option<Rows>,
    /// Where they are wanted.
    faces: Option<Faces>,
}

impl Ply {
    pub(super) fn new(faces: Option<Faces>) -> Ply {
        Ply {
            faces,
            ..Ply::default()
        }
    }
}

impl Parser for Ply {
    fn parse(&mut self, input: &mut Input, table: &mut Option<Table>) -> Result<Step> {
        let rows = match &mut self.rows {
            Some(rows) => rows,
            None => {
                let Some(mut header) = self.header.read(input)? else {
                    return Ok(Step::More);
                };
                let (points, mut columns) = header.points(input)?;
                let packed = header.elements[points].packed_color(header.encoding, &mut columns);
                let has_faces =
                    |element: &Element| Layout::of(element).is_some() && element.rows > 0;
                let last = self.faces.as_mut().and_then(|faces| {
                    faces::looks(&header, faces);
                    header.elements.iter().rposition(has_faces)
                });
                let places = last.and_then(|_| faces::places_of_rows(&header, points));
                if let Some(places) = places {
                    columns.scalars.retain(|(at, _)| !places.contains(at));
                }
                let most = header.most_rows(points, input);
                let table = table.insert(Table::new(columns, Some(most)));
                table.gone = last.is_some().then(Vec::new);
                if last.is_none() {
                    self.faces = None;
                }
                self.rows.insert(Rows {
                    packed,
                    places,
                    header,
                    points,
                    last: last.unwrap_or(0).max(points),
                    element: 0,
                    row: 0,
                    skipped: 0,
                    values: Vec::new(),
                    lists: Lists::default(),
                })
            }
        };
        match table {
            Some(table) => rows.read(input, table, &mut self.faces),
            None => Ok(Step::Done),
        }
    }

    fn notes(&self) -> Vec<String> {
        let is_splats = |rows: &Rows| rows.header.elements[rows.points].is_splats();
        let splats = self.rows.iter().any(is_splats);
        splats.then(|| SPLATS.to_string()).into_iter().collect()
    }

    fn faces(&self) -> u64 {
        let elements = self.rows.iter().flat_map(|rows| &rows.header.elements);
        elements
            .filter(|element| element.name == "face")
            .map(|face| face.rows)
            .next()
            .unwrap_or(0)
    }

    fn waits_for_faces(&self) -> bool {
        self.faces.is_some()
    }

    fn take_faces(&mut self) -> Option<Faces> {
        self.faces.take()
    }
}

/// The rows of the elements up to the points, and to the faces where they are wanted.
struct Rows {
    header: Header,
    /// Which element the points are, and which is the last that matters.
    points: usize,
    last: usize,
    /// The element whose rows come next, and how many of its rows, or of its bytes, have been.
    element: usize,
    row: u64,
    skipped: u64,
    /// Where the rows of the points have a packed colour, and places in a picture.
    packed: Option<Packed>,
    places: Option<[usize; 2]>,
    values: Vec<f64>,
    lists: Lists,
}

impl Rows {
    /// Reads what is at hand.
    fn read(
        &mut self,
        input: &mut Input,
        table: &mut Table,
        faces: &mut Option<Faces>,
    ) -> Result<Step> {
        while self.element <= self.last {
            let element = &self.header.elements[self.element];
            let points = self.element == self.points;
            let layout = Layout::of(element).filter(|_| faces.is_some() && !points);
            let cells = (&mut self.values, &mut self.lists);
            if points {
                let add = |row: &mut Vec<f64>, _: &Lists| {
                    if let (Some([u, v]), Some(faces)) = (self.places, &mut *faces) {
                        faces.places.push([row[u] as f32, 1.0 - row[v] as f32]);
                    }
                    if let Some(packed) = &self.packed {
                        let color = packed.color(row);
                        row.extend(color);
                    }
                    table.push(row);
                };
                self.row += read_rows(&self.header, element, self.row, cells, input, add)?;
            } else if let (Some(mut layout), Some(faces)) = (layout, &mut *faces) {
                layout.by_row = self.places.is_some();
                let known = (self.element > self.points).then_some(&*table);
                self.row += read_rows(
                    &self.header,
                    element,
                    self.row,
                    cells,
                    input,
                    |row, lists| {
                        layout.push(row, lists, faces, known);
                    },
                )?;
            } else if let Some(size) = element.fixed_size(self.header.encoding) {
                let total = size.saturating_mul(element.rows);
                self.skipped += input.skip(total - self.skipped);
                if self.skipped < total {
                    return if input.last {
                        Err(no_rows(input, total - self.skipped, element))
                    } else {
                        Ok(Step::More)
                    };
                }
                self.row = element.rows;
            } else {
                self.row += read_rows(&self.header, element, self.row, cells, input, |_, _| ())?;
            }
            if self.row < element.rows {
                return Ok(Step::More);
            }
            (self.element, self.row, self.skipped) = (self.element + 1, 0, 0);
        }
        Ok(Step::Done)
    }
}

/// Reads rows of an element, of which `read` have been; how many they were. All, where nothing follows.
fn read_rows(
    header: &Header,
    element: &Element,
    read: u64,
    (values, lists): (&mut Vec<f64>, &mut Lists),
    input: &mut Input,
    mut row: impl FnMut(&mut Vec<f64>, &Lists),
) -> Result<u64> {
    if element.properties.is_empty() {
        return Ok(element.rows);
    }
    let mut count = 0;
    while read + count < element.rows {
        values.clear();
        lists.clear();
        let big_endian = header.encoding == Encoding::BigEndian;
        let whole = match header.encoding {
            Encoding::Ascii => read_text_row(element, input, values, lists)?,
            _ => read_binary_row(element, big_endian, input, values, lists)?,
        };
        if !whole {
            break;
        }
        row(values, lists);
        count += 1;
    }
    Ok(count)
}

/// A line that is not blank: its values, and its lists. `false` where it is not at hand.
fn read_text_row<'a>(
    element: &Element,
    input: &mut Input<'a>,
    row: &mut Vec<f64>,
    lists: &mut Lists,
) -> Result<bool> {
    let start = input.mark();
    let line = loop {
        match input.line()? {
            Some(line) if line.trim_ascii().is_empty() => {}
            Some(line) => break line,
            None if input.last => return Err(input.no_line(&rows_of(element))),
            None => return Ok(false),
        }
    };
    let first = input.place.line;
    let mut tokens = words(line);
    // A row may go on in the next lines, where it ends with one.
    let mut next = |input: &mut Input<'a>| loop {
        if let Some(token) = tokens.next() {
            let value = number(token).ok_or_else(|| input.bad_line("a number", token))?;
            return Ok(Some(value));
        }
        match input.line()? {
            Some(more) => tokens = words(more),
            None => return Ok(None),
        }
    };
    let mut whole = true;
    'row: for property in &element.properties {
        let Some(value) = next(input)? else {
            whole = false;
            break;
        };
        match property {
            Property::One { .. } => row.push(value),
            Property::List { .. } => {
                let items =
                    list_length(value).ok_or_else(|| input.bad_line("a list's length", line))?;
                for _ in 0..items {
                    let Some(item) = next(input)? else {
                        whole = false;
                        break 'row;
                    };
                    lists.items.push(item);
                }
                lists.ends.push(lists.items.len());
            }
        }
    }
    let short = format!("{} values", element.properties.len());
    match tokens.next() {
        _ if !whole && !input.last => {
            input.go_back(start);
            Ok(false)
        }
        _ if !whole => Err(input.bad_value(first, &short, line)),
        None => Ok(true),
        Some(_) if input.place.line > first => Err(input.bad_value(first, &short, line)),
        Some(token) => Err(input.bad_line("the end of the line", token)),
    }
}

/// A binary row: its values, and its lists. `false` where it is not at hand.
fn read_binary_row(
    element: &Element,
    big_endian: bool,
    input: &mut Input,
    row: &mut Vec<f64>,
    lists: &mut Lists,
) -> Result<bool> {
    let here = input.rest();
    let mut at = 0;
    for property in &element.properties {
        let (Property::One { scalar, .. } | Property::List { count: scalar, .. }) = property;
        let Some(bytes) = here.get(at..at + scalar.size()) else {
            return missing(input, (at + scalar.size()) as u64, element);
        };
        let value = scalar.value(bytes, big_endian);
        match property {
            Property::One { .. } => row.push(value),
            Property::List { item, .. } => {
                let items = list_length(value).ok_or_else(|| {
                    input.bad_byte(
                        input.place.byte + at as u64,
                        "a list's length",
                        value.to_string(),
                    )
                })?;
                let start = at + scalar.size();
                let length = items.saturating_mul(item.size());
                let Some(content) = here.get(start..start.saturating_add(length)) else {
                    return missing(input, start.saturating_add(length) as u64, element);
                };
                let values = content.chunks_exact(item.size());
                lists
                    .items
                    .extend(values.map(|bytes| item.value(bytes, big_endian)));
                lists.ends.push(lists.items.len());
                at += length;
            }
        }
        at += scalar.size();
    }
    Ok(input.take(at).is_some())
}

/// A row of `length` bytes is not at hand.
fn missing(input: &Input, length: u64, element: &Element) -> Result<bool> {
    // What a list says is longer than the file is never waited for.
    if input.last || length > input.left() {
        return Err(no_rows(input, length, element));
    }
    Ok(false)
}

fn no_rows(input: &Input, length: u64, element: &Element) -> Error {
    input.no_bytes(length, &rows_of(element))
}

fn rows_of(element: &Element) -> String {
    format!(
        "{} rows of element {}",
        element.rows,
        super::text::quote(element.name.as_bytes())
    )
}

/// A list's length from its value in the file.
fn list_length(value: f64) -> Option<usize> {
    (value >= 0.0 && value <= f64::from(u32::MAX) && value.fract() == 0.0).then_some(value as usize)
}
