//! Rows of numbers as text: XYZ, TXT, PTS, CSV, ASC. No standard says what such a file holds, so this does:
//!
//! - **Rows**: one point a line; values are separated by blanks, tabs, commas or semicolons. Where a line has semicolons,
//!   commas are decimal commas. All rows have the same number of values, three at least. Blank lines are passed over,
//!   and lines that start with `#`, `//`, `%` or `!`.
//! - **Counts**: a line with one whole number is a count of rows (PTS; a file may hold several scans). Fewer rows than the
//!   counts say mean that the file is cut off, which is an error; more are read.
//! - **Names**: a line before the first row whose first value is not a number names the columns; so does a comment
//!   that names x, y and z. Without x, y and z among the names the file is refused, because a guess could be wrong.
//! - **Without names** the first three columns are x, y, z, and the rest follows from their number and from the first
//!   thousand rows: three columns whose vectors have length 1 (within 5 %) are normals; three columns with whole numbers
//!   from 0 to 255, or with numbers from 0 to 1, are colours; one column alone is `intensity`. Where both readings of
//!   seven columns fit, intensity comes before the colours in a file with a count (PTS) and after them in others. Columns
//!   that fit nothing become attributes `column4`, `column5` ….

use super::input::Input;
use super::reading::{Parser, Step};
use super::table::{ColorRange, Columns, Precision, Table};
use super::text::number;
use crate::base::error::Result;

/// Rows that decide what columns without names are.
const LOOK_AHEAD: usize = 1000;

/// Whether the first line that says something is a row, a count, or names x, y and z.
pub(super) fn looks_like(head: &[u8]) -> bool {
    const MOST_LINES: usize = 100;
    let mut row = Vec::new();
    without_mark(head)
        .split(|&b| b == b'\n' || b == b'\r')
        .take(MOST_LINES)
        .map(|line| match parse(line, &mut row) {
            Line::Nothing => None,
            Line::Names { names, .. } => Some(Columns::from_names(&names).is_some()),
            Line::Count(_) => Some(true),
            Line::Row => Some(row.len() >= 3),
            Line::Bad(_) => Some(false),
        })
        .find_map(|answer| answer)
        .unwrap_or(false)
}

/// Without the byte order mark of UTF-8.
fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// What a line says.
enum Line<'a> {
    /// Nothing, or a comment that names no columns.
    Nothing,
    /// Names of columns, as a line of their own or in a comment.
    Names { names: Vec<String>, comment: bool },
    /// One whole number.
    Count(u64),
    /// Numbers; they are in the buffer.
    Row,
    /// A value that is not a number.
    Bad(&'a [u8]),
}

/// Takes a line apart; a row's values replace what is in `row`.
fn parse<'a>(line: &'a [u8], row: &mut Vec<f64>) -> Line<'a> {
    row.clear();
    let line = line.trim_ascii();
    if line.starts_with(b"//") || line.first().is_some_and(|mark| b"#%!".contains(mark)) {
        let marks = line.iter().take_while(|b| b"#/%!".contains(b)).count();
        let names = names(&line[marks..]);
        return if Columns::from_names(&names).is_some() {
            Line::Names {
                names,
                comment: true,
            }
        } else {
            Line::Nothing
        };
    }
    let decimal_comma = line.contains(&b';') && line.contains(&b',');
    for token in values(line) {
        let value = if decimal_comma {
            number(
                &token
                    .iter()
                    .map(|&b| if b == b',' { b'.' } else { b })
                    .collect::<Vec<u8>>(),
            )
        } else {
            number(token)
        };
        match value {
            Some(value) => row.push(value),
            None if row.is_empty() => {
                return Line::Names {
                    names: names(line),
                    comment: false,
                };
            }
            None => return Line::Bad(token),
        }
    }
    match row[..] {
        [] => Line::Nothing,
        [count] if count >= 0.0 && count.fract() == 0.0 => Line::Count(count as u64),
        _ => Line::Row,
    }
}

/// The values of a line: between semicolons, else between commas, else between blanks and tabs.
fn values(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    let separator = [b';', b','].into_iter().find(|mark| line.contains(mark));
    let line = match line {
        [start @ .., last] if Some(*last) == separator => start,
        _ => line,
    };
    line.split(move |b| separator.map_or(b.is_ascii_whitespace(), |mark| *b == mark))
        .filter(move |value| separator.is_some() || !value.is_empty())
        .map(|value| {
            let value = value.trim_ascii();
            let inside = value
                .strip_prefix(b"\"")
                .and_then(|rest| rest.strip_suffix(b"\""));
            inside.unwrap_or(value)
        })
}

fn names(line: &[u8]) -> Vec<String> {
    let name = |value: &[u8]| String::from_utf8_lossy(value.trim_ascii()).into_owned();
    values(line.trim_ascii()).map(name).collect()
}

/// Reads the points.
#[derive(Default)]
pub(super) struct Xyz {
    names: Option<Vec<String>>,
    names_in_comment: bool,
    /// Sum of the counts in the file.
    promised: Option<u64>,
    rows: u64,
    /// Values a row.
    width: usize,
    /// The first rows, one after the other, until the columns are known.
    ahead: Vec<f64>,
    /// Values of the line at hand.
    values: Vec<f64>,
}

impl Parser for Xyz {
    fn parse(&mut self, input: &mut Input, table: &mut Option<Table>) -> Result<Step> {
        if input.place.byte == 0 {
            if input.rest().starts_with(&[0xff, 0xfe]) || input.rest().starts_with(&[0xfe, 0xff]) {
                return Err(input.unsupported("UTF-8 or ASCII text", "UTF-16 text"));
            }
            if input.rest().len() < 3 && !input.last {
                return Ok(Step::More);
            }
            input.skip((input.rest().len() - without_mark(input.rest()).len()) as u64);
        }
        let mut values = std::mem::take(&mut self.values);
        while let Some(line) = input.line()? {
            self.line(line, &mut values, input, table)?;
        }
        self.values = values;
        if !input.last {
            return Ok(Step::More);
        }
        self.finish(input, table)?;
        Ok(Step::Done)
    }
}

impl Xyz {
    fn line(
        &mut self,
        line: &[u8],
        row: &mut Vec<f64>,
        input: &Input,
        table: &mut Option<Table>,
    ) -> Result<()> {
        match parse(line, row) {
            Line::Nothing => Ok(()),
            Line::Count(count) => {
                self.promised = Some(self.promised.unwrap_or(0).saturating_add(count));
                Ok(())
            }
            Line::Names { comment: true, .. } if self.rows > 0 => Ok(()),
            Line::Names { .. } if self.rows > 0 => Err(input.bad_line("numbers", line)),
            Line::Names { names, comment } => {
                let known = Columns::from_names(&names).is_some();
                let mut sorted: Vec<String> =
                    names.iter().map(|name| name.to_lowercase()).collect();
                sorted.sort_unstable();
                let twice = sorted.windows(2).any(|pair| pair[0] == pair[1]);
                if known && !twice {
                    self.names = Some(names);
                    self.names_in_comment = comment;
                    Ok(())
                } else if comment {
                    Ok(())
                } else {
                    let expected = "numbers, or different column names with x, y and z";
                    Err(input.bad_line(expected, line))
                }
            }
            Line::Bad(value) => Err(input.bad_line("a number", value)),
            Line::Row => self.row(line, row, input, table),
        }
    }

    fn row(
        &mut self,
        line: &[u8],
        row: &[f64],
        input: &Input,
        table: &mut Option<Table>,
    ) -> Result<()> {
        if self.rows == 0 {
            self.width = row.len();
            let names = self.names.as_ref().map_or(self.width, Vec::len);
            if names != self.width && self.names_in_comment {
                self.names = None;
            } else if names != self.width {
                return Err(input.bad_line(&format!("{names} values, one for each name"), line));
            }
        }
        if row.len() < 3 || row.len() != self.width {
            return Err(input.bad_line(&format!("{} values", self.width.max(3)), line));
        }
        self.rows += 1;
        match table {
            Some(table) => table.push(row),
            None => {
                self.ahead.extend(row);
                if self.ahead.len() == LOOK_AHEAD * self.width {
                    *table = Some(self.start_table());
                }
            }
        }
        Ok(())
    }

    /// Decides what the columns are and moves the first rows into a table.
    fn start_table(&mut self) -> Table {
        let columns = match &self.names {
            Some(names) => Columns::from_names(names),
            None => None,
        };
        let columns =
            columns.unwrap_or_else(|| guess(&self.ahead, self.width, self.promised.is_some()));
        let mut table = Table::new(columns, None);
        for row in self.ahead.chunks_exact(self.width.max(1)) {
            table.push(row);
        }
        self.ahead = Vec::new();
        table
    }

    fn finish(&mut self, input: &Input, table: &mut Option<Table>) -> Result<()> {
        let promised = self.promised.unwrap_or(0);
        let says_nothing = self.promised.is_none() && self.names.is_none();
        if self.rows < promised || (self.rows == 0 && says_nothing) {
            let expected = if says_nothing {
                "rows of numbers".into()
            } else {
                format!("{promised} rows")
            };
            let found = format!("the end of the file after {} rows", self.rows);
            return Err(input.bad_at_line(input.place.line.max(1), &expected, found));
        }
        if table.is_none() {
            *table = Some(self.start_table());
        }
        Ok(())
    }
}

/// A column, or three, after x, y and z.
#[derive(Clone, Copy, PartialEq)]
enum Field {
    Intensity,
    Color,
    Normal,
}

/// What may follow x, y and z; of those that fit, the first counts.
const LAYOUTS: [&[Field]; 15] = {
    use Field::{Color, Intensity, Normal};
    [
        &[Intensity],
        &[Normal],
        &[Color],
        &[Normal, Intensity],
        &[Intensity, Normal],
        &[Color, Intensity],
        &[Intensity, Color],
        &[Color, Normal],
        &[Normal, Color],
        &[Intensity, Color, Normal],
        &[Intensity, Normal, Color],
        &[Color, Intensity, Normal],
        &[Normal, Intensity, Color],
        &[Color, Normal, Intensity],
        &[Normal, Color, Intensity],
    ]
};

impl Field {
    fn width(self) -> usize {
        if self == Field::Intensity { 1 } else { 3 }
    }

    /// Whether the columns from `start` on look like it in all rows.
    fn fits<'a>(self, rows: impl Iterator<Item = &'a [f64]> + Clone, start: usize) -> bool {
        match self {
            Field::Intensity => true,
            Field::Normal => rows.into_iter().all(|row| {
                let [x, y, z] = [row[start], row[start + 1], row[start + 2]];
                ((x * x + y * y + z * z).sqrt() - 1.0).abs() <= 0.05
            }),
            Field::Color => {
                let mut values = rows.flat_map(|row| &row[start..start + 3]);
                let mut again = values.clone();
                values.all(|v| (0.0..=255.0).contains(v) && v.fract() == 0.0)
                    || again.all(|v| (0.0..=1.0).contains(v))
            }
        }
    }
}

/// The columns of rows without names, by their values.
fn guess(values: &[f64], width: usize, counted: bool) -> Columns {
    let rows = values.chunks_exact(width.max(1));
    let fits = |layout: &&&[Field]| {
        let mut start = 3;
        let total: usize = layout.iter().map(|field| field.width()).sum();
        width == 3 + total
            && layout.iter().all(|field| {
                let here = start;
                start += field.width();
                field.fits(rows.clone(), here)
            })
    };
    let intensity_first: &[Field] = &[Field::Intensity, Field::Color];
    let preferred = Some(&intensity_first).filter(|_| counted);
    let layout = preferred.into_iter().chain(&LAYOUTS).find(fits);
    let mut names: Vec<String> = ["x", "y", "z"].map(String::from).into();
    for field in layout.copied().unwrap_or_default() {
        match field {
            Field::Intensity => names.push("intensity".into()),
            Field::Color => names.extend(["red", "green", "blue"].map(String::from)),
            Field::Normal => names.extend(["nx", "ny", "nz"].map(String::from)),
        }
    }
    names.extend((names.len()..width).map(|column| format!("column{}", column + 1)));
    Columns::from_names(&names).unwrap_or(Columns {
        position: [0, 1, 2],
        normal: None,
        color: None,
        scalars: Vec::new(),
        colors: ColorRange::Guess,
        precision: Precision::AsNeeded,
    })
}
