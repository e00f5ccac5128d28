//! PCD 0.6 and 0.7 (Point Cloud Library): a text header that names fields, then rows as text, rows of bytes, or columns
//! packed by LZF.
//!
//! Fields may have several values (`COUNT`); those that do, and the padding `_`, are passed over. Colours are packed into
//! one value, `rgb` or `rgba`: the lowest byte is blue. Points with a coordinate that is NaN, which organised clouds have
//! where nothing was seen, are left out and counted. The viewpoint is not applied: coordinates are the file's. It is where they were
//! seen from, unless it is the default, 0 0 0; then an organised cloud is asked whether it is a picture taken from there.
//!
//! Why not a crate: `pcd-rs` reads through memory maps or whole records with one allocation each, and gives no place
//! for an error; `pcd_rs` has no wasm32 build without a file system.

mod fields;
mod picture;

use super::colors::unpacked;
use super::input::Input;
use super::lzf;
use super::parser::{Parser, Step};
use super::table::{Columns, Table};
use super::text::number;
use crate::base::error::Result;
use fields::{Encoding, Field, Kind, columns, packed_color, value};
use picture::Picture;

/// Whether the content starts as a PCD file does: comments, then `VERSION` or `FIELDS`.
pub(super) fn looks_like(head: &[u8]) -> bool {
    let mut lines = head
        .split(|&b| b == b'\n' || b == b'\r')
        .map(<[u8]>::trim_ascii);
    lines
        .find(|line| line.starts_with(b"# .PCD") || !(line.is_empty() || line.starts_with(b"#")))
        .is_some_and(|line| {
            [&b"# .PCD"[..], b"VERSION .", b"VERSION 0.", b"FIELDS "]
                .iter()
                .any(|start| line.starts_with(start))
        })
}

/// Reads the points.
#[derive(Default)]
pub(super) struct Pcd {
    header: Header,
    body: Option<Body>,
}

impl Parser for Pcd {
    fn parse(&mut self, input: &mut Input, table: &mut Option<Table>) -> Result<Step> {
        let body = match &mut self.body {
            Some(body) => body,
            None => {
                let Some(body) = self.header.read(input)? else {
                    return Ok(Step::More);
                };
                *table = Some(Table::new(body.columns.clone(), body.most_rows(input)));
                self.body.insert(body)
            }
        };
        match table {
            Some(table) => body.read(input, table),
            None => Ok(Step::Done),
        }
    }
}

/// The header's entries.
#[derive(Default)]
struct Header {
    fields: Vec<String>,
    sizes: Vec<usize>,
    kinds: Vec<Kind>,
    counts: Vec<usize>,
    width: Option<u64>,
    height: Option<u64>,
    points: Option<u64>,
    viewpoint: Option<[f64; 3]>,
}

impl Header {
    /// Reads the lines at hand; the body, once all of the header was there.
    fn read(&mut self, input: &mut Input) -> Result<Option<Body>> {
        const EXPECTED: &str = "a line of a PCD header (VERSION, FIELDS, SIZE, TYPE, COUNT, WIDTH, HEIGHT, VIEWPOINT, POINTS, DATA)";
        loop {
            let Some(line) = input.line()? else {
                return if input.last {
                    Err(input.no_line(EXPECTED))
                } else {
                    Ok(None)
                };
            };
            let text = String::from_utf8_lossy(line);
            let mut words = text.split_ascii_whitespace();
            let key = words.next().unwrap_or_default();
            let values: Vec<&str> = words.collect();
            let count = |word: Option<&&str>| {
                let value = word.and_then(|word| word.parse::<u64>().ok());
                value.ok_or_else(|| input.bad_line("a count", line))
            };
            match key {
                "" | "VERSION" => {}
                "VIEWPOINT" => self.viewpoint = viewpoint(&values),
                _ if key.starts_with('#') => {}
                "FIELDS" | "COLUMNS" => {
                    self.fields = values.iter().map(|name| name.to_string()).collect()
                }
                "SIZE" => {
                    let size =
                        |word: &&str| word.parse().ok().filter(|size| [1, 2, 4, 8].contains(size));
                    let sizes: Option<Vec<usize>> = values.iter().map(size).collect();
                    self.sizes =
                        sizes.ok_or_else(|| input.bad_line("sizes of 1, 2, 4 or 8 bytes", line))?;
                }
                "TYPE" => {
                    let kind = |word: &&str| match *word {
                        "I" => Some(Kind::Signed),
                        "U" => Some(Kind::Unsigned),
                        "F" => Some(Kind::Float),
                        _ => None,
                    };
                    let kinds: Option<Vec<Kind>> = values.iter().map(kind).collect();
                    self.kinds = kinds.ok_or_else(|| input.bad_line("types I, U or F", line))?;
                }
                "COUNT" => {
                    const MOST: usize = 1 << 16;
                    let count = |word: &&str| word.parse().ok().filter(|&count| count <= MOST);
                    let counts: Option<Vec<usize>> = values.iter().map(count).collect();
                    self.counts = counts.ok_or_else(|| input.bad_line("counts", line))?;
                }
                "WIDTH" => self.width = Some(count(values.first())?),
                "HEIGHT" => self.height = Some(count(values.first())?),
                "POINTS" => self.points = Some(count(values.first())?),
                "DATA" => {
                    let encoding = match values[..] {
                        ["ascii"] => Encoding::Ascii,
                        ["binary"] => Encoding::Binary,
                        ["binary_compressed"] => Encoding::Compressed,
                        _ => {
                            return Err(
                                input.bad_line("DATA ascii, binary or binary_compressed", line)
                            );
                        }
                    };
                    return self.body(encoding, input, line).map(Some);
                }
                _ => return Err(input.bad_line(EXPECTED, line)),
            }
        }
    }

    /// What the entries say together, at the line `DATA`.
    fn body(&mut self, encoding: Encoding, input: &Input, line: &[u8]) -> Result<Body> {
        let names = std::mem::take(&mut self.fields);
        if self.counts.is_empty() {
            self.counts = vec![1; names.len()];
        }
        if [self.sizes.len(), self.kinds.len(), self.counts.len()] != [names.len(); 3] {
            let expected = format!(
                "SIZE, TYPE and COUNT with {} values each, one a field, before DATA",
                names.len()
            );
            return Err(input.bad_line(&expected, line));
        }
        let fields: Vec<Field> = (0..names.len())
            .map(|i| Field {
                name: names[i].clone(),
                kind: self.kinds[i],
                size: self.sizes[i],
                count: self.counts[i],
            })
            .collect();
        let half = |field: &&Field| field.kind == Kind::Float && field.size < 4;
        if let Some(field) = fields.iter().find(half) {
            let found = format!("{} bytes a value of {}", field.size, field.name);
            return Err(input.unsupported("floats of 4 or 8 bytes", found));
        }
        let area = self
            .width
            .map(|width| width.saturating_mul(self.height.unwrap_or(1)));
        let points = match (self.points, area) {
            (Some(points), Some(area)) if points != area => {
                let expected = format!("as many POINTS as WIDTH times HEIGHT, {area}, before DATA");
                return Err(input.bad_line(&expected, points.to_string().as_bytes()));
            }
            (points, area) => points
                .or(area)
                .ok_or_else(|| input.bad_line("POINTS before DATA", line))?,
        };
        let columns = columns(&fields, encoding).ok_or_else(|| {
            let found = names.join(" ");
            input.bad_line("FIELDS with x, y and z before DATA", found.as_bytes())
        })?;
        let color = packed_color(&fields);
        Ok(Body {
            encoding,
            fields,
            points,
            columns,
            color,
            row: 0,
            values: Vec::new(),
            viewpoint: self.viewpoint,
            picture: match self.height {
                Some(2..) if self.viewpoint.is_none() => self.width.map(Picture::new),
                _ => None,
            },
        })
    }
}

/// The place in `tx ty tz qw qx qy qz`, unless it is the default.
fn viewpoint(values: &[&str]) -> Option<[f64; 3]> {
    let place = |i: usize| values.get(i)?.parse::<f64>().ok();
    let position = [place(0)?, place(1)?, place(2)?];
    let is_said = position != [0.0; 3] && position.iter().all(|x| x.is_finite());
    is_said.then_some(position)
}

/// The rows, and how far they have been read.
struct Body {
    encoding: Encoding,
    fields: Vec<Field>,
    points: u64,
    columns: Columns,
    /// The field that packs a colour.
    color: Option<usize>,
    row: u64,
    values: Vec<f64>,
    viewpoint: Option<[f64; 3]>,
    /// Of an organised cloud that says no viewpoint.
    picture: Option<Picture>,
}

impl Body {
    fn row_size(&self) -> usize {
        self.fields
            .iter()
            .map(|field| field.size * field.count)
            .sum()
    }

    /// How many rows the file has room for, unless they are packed.
    fn most_rows(&self, input: &Input) -> Option<u64> {
        let row = match self.encoding {
            Encoding::Ascii => 2 * self.fields.len(),
            Encoding::Binary => self.row_size(),
            Encoding::Compressed => return None,
        };
        Some(self.points.min((input.left() + 1) / row.max(1) as u64))
    }

    fn read(&mut self, input: &mut Input, table: &mut Table) -> Result<Step> {
        let step = match self.encoding {
            Encoding::Ascii => self.read_text(input, table),
            Encoding::Binary => self.read_rows(input, table),
            Encoding::Compressed => self.read_columns(input, table),
        }?;
        let is_picture = self.picture.as_ref().is_some_and(Picture::is_of_the_origin);
        let origin = is_picture.then_some([0.0; 3]);
        if let (Step::Done, Some(viewpoint)) = (step, self.viewpoint.or(origin)) {
            table.stations.begin(0, Some(viewpoint));
        }
        Ok(step)
    }

    fn read_text(&mut self, input: &mut Input, table: &mut Table) -> Result<Step> {
        while self.row < self.points {
            let line = match input.line()? {
                Some(line) if line.trim_ascii().is_empty() => continue,
                Some(line) => line,
                None if input.last => {
                    return Err(input.no_line(&format!("one of {} points", self.points)));
                }
                None => return Ok(Step::More),
            };
            // Some programs write commas.
            let mut words = line
                .split(|b| b.is_ascii_whitespace() || *b == b',')
                .filter(|word| !word.is_empty());
            self.values.clear();
            let mut packed = None;
            for (i, field) in self.fields.iter().enumerate() {
                let mut first = 0.0;
                for part in 0..field.count {
                    let Some(word) = words.next() else {
                        let all: usize = self.fields.iter().map(|field| field.count).sum();
                        return Err(input.bad_line(&format!("{all} values"), line));
                    };
                    let value = number(word).ok_or_else(|| input.bad_line("a number", word))?;
                    if part == 0 {
                        first = value;
                    }
                }
                if self.color == Some(i) {
                    packed = Some(unpacked(
                        field.kind == Kind::Float,
                        first,
                        (first as f32).to_bits(),
                    ));
                }
                self.values.push(first);
            }
            if let Some(extra) = words.next() {
                return Err(input.bad_line("the end of the line", extra));
            }
            self.push(packed, table);
        }
        Ok(Step::Done)
    }

    fn read_rows(&mut self, input: &mut Input, table: &mut Table) -> Result<Step> {
        let size = self.row_size();
        while self.row < self.points {
            let Some(row) = input.take(size) else {
                return if input.last {
                    let missing = (self.points - self.row).saturating_mul(size as u64);
                    Err(input.no_bytes(missing, &format!("{} points", self.points)))
                } else {
                    Ok(Step::More)
                };
            };
            let mut at = 0;
            self.push_bytes(
                |field| {
                    let here = at;
                    at += field.size * field.count;
                    &row[here..here + field.size * field.count]
                },
                table,
            );
        }
        Ok(Step::Done)
    }

    /// All of the first field's values, then all of the second's …
    fn read_columns(&mut self, input: &mut Input, table: &mut Table) -> Result<Step> {
        if !input.last {
            return Ok(Step::More);
        }
        let start = input.place.byte;
        let Some(&[a, b, c, d, e, f, g, h]) = input.take(8) else {
            return Err(input.no_bytes(8, "the sizes of the packed points"));
        };
        let (packed, unpacked) = (
            u32::from_le_bytes([a, b, c, d]),
            u32::from_le_bytes([e, f, g, h]),
        );
        let size = self.row_size();
        if Some(u64::from(unpacked)) != self.points.checked_mul(size as u64) {
            let expected = format!("{} points of {size} bytes each", self.points);
            return Err(input.bad_byte(start + 4, &expected, format!("{unpacked} bytes in all")));
        }
        let Some(bytes) = input.take(packed as usize) else {
            return Err(input.no_bytes(u64::from(packed), "packed points"));
        };
        let at_fault = |at: usize| {
            input.bad_byte(
                start + 8 + at as u64,
                "points packed by LZF",
                "bytes that do not unpack",
            )
        };
        let columns = lzf::unpack(bytes, unpacked as usize).map_err(at_fault)?;
        if columns.len() != unpacked as usize {
            return Err(input.bad_byte(
                start + 4,
                &format!("{unpacked} bytes once unpacked"),
                columns.len().to_string(),
            ));
        }
        for row in 0..self.points as usize {
            let mut column = 0;
            self.push_bytes(
                |field| {
                    let width = field.size * field.count;
                    let here = column + row * width;
                    column += width * (columns.len() / size);
                    &columns[here..here + width]
                },
                table,
            );
        }
        Ok(Step::Done)
    }

    /// A row from the bytes of each field, in order.
    fn push_bytes<'a>(&mut self, mut next: impl FnMut(&Field) -> &'a [u8], table: &mut Table) {
        self.values.clear();
        let mut packed = None;
        for (i, field) in self.fields.iter().enumerate() {
            let bytes = next(field);
            let first = if field.count == 0 {
                0.0
            } else {
                value(field, bytes)
            };
            if self.color == Some(i) {
                let bits = match *bytes {
                    [a, b, c, d] => u32::from_le_bytes([a, b, c, d]),
                    _ => (first as f32).to_bits(),
                };
                packed = Some(unpacked(field.kind == Kind::Float, first, bits));
            }
            self.values.push(first);
        }
        self.push(packed, table);
    }

    /// Puts the values into the table, and the colour after them.
    fn push(&mut self, packed: Option<u32>, table: &mut Table) {
        if let Some(packed) = packed {
            let [blue, green, red, _] = packed.to_le_bytes();
            self.values.extend([red, green, blue].map(f64::from));
        }
        if let Some(picture) = &mut self.picture {
            picture.push(self.columns.position.map(|column| self.values[column]));
        }
        table.push(&self.values);
        self.row += 1;
    }
}
