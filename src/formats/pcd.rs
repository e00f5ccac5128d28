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

mod body;
mod picture;

use super::colors::ColorRange;
use super::input::Input;
use super::parser::{Parser, Step};
use super::table::{Columns, Precision, Table};
use crate::base::error::Result;
use body::{Body, Encoding, Field, Kind};
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

/// The columns of the rows that [`Body::push`] makes: a value for each field, then red, green, blue where one packs them.
fn columns(fields: &[Field], encoding: Encoding) -> Option<Columns> {
    // Fields with several values and padding have names of no meaning, and no attribute is made of them.
    let name = |(i, field): (usize, &Field)| {
        if field.count == 1 && field.name != "_" {
            field.name.clone()
        } else {
            format!("\0{i}")
        }
    };
    let mut names: Vec<String> = fields.iter().enumerate().map(name).collect();
    let packed = packed_color(fields);
    if let Some(packed) = packed {
        names[packed] = "\0".into();
        names.extend(["red", "green", "blue"].map(String::from));
    }
    let mut columns = Columns::from_names(&names)?;
    columns.scalars.retain(|(_, name)| !name.starts_with('\0'));
    if packed.is_some() {
        columns.colors = ColorRange::Bytes;
    }
    let is_single =
        |&i: &usize| fields[i].size < 4 || (fields[i].size == 4 && fields[i].kind == Kind::Float);
    // Text may have more digits than the type that it names.
    if encoding != Encoding::Ascii && columns.position.iter().all(is_single) {
        columns.precision = Precision::Single;
    }
    Some(columns)
}

/// The field that packs a colour into four bytes.
fn packed_color(fields: &[Field]) -> Option<usize> {
    let packs = |field: &Field| {
        ["rgb", "rgba"].contains(&field.name.to_lowercase().as_str())
            && field.size >= 4
            && field.count == 1
    };
    fields.iter().position(packs)
}
