//! How a table is read, decided from its first lines.

use super::super::colors::ColorRange;
use super::super::input::Input;
use super::super::options::ReadOptions;
use super::super::preview::Preview;
use super::super::table::Columns;
use super::super::text::decoded;
use super::dialect::Dialect;
use super::grid::{Grid, dialect_of};
use super::guess::{Column, guess, is_colmap, is_unit};
use super::header::{Header, header, header_names, is_header_of_numbers, only_numbers};
use super::line::{Line, NoPlan, Numbered, is_said, line_of};
use super::names;
use super::value::{Value, color};
use crate::base::error::{Error, Result};
use crate::cloud::Unit;

/// How rows are read.
pub(super) struct Plan {
    pub(super) dialect: Dialect,
    /// What each column holds, as in [`ReadOptions::columns`].
    pub(super) roles: Vec<String>,
    /// What the rows of the table hold: a value a column, then red, green and blue where one packs them.
    pub(super) columns: Columns,
    /// Number of the first row's line.
    pub(super) first_row: u64,
    packed: Option<usize>,
    /// The packed colours are text: hexadecimal without a mark, or three numbers.
    written: bool,
    /// The packed colours are the bits of a number in single precision.
    bits: bool,
    /// Values beyond the columns are passed over.
    ragged: bool,
    /// The letter that points have in front, where other lines have others (Hoppe, 1992).
    letter: Option<u8>,
    /// What a coordinate is, where the names of the columns say it.
    pub(super) unit: Option<Unit>,
    pub(super) preview: Preview,
}

impl Plan {
    /// Decides by the first lines, what is asked for first.
    pub(super) fn of(
        lines: &[Numbered],
        options: &ReadOptions,
    ) -> std::result::Result<Plan, NoPlan> {
        let said: Vec<&Numbered> = lines.iter().filter(|line| is_said(&line.bytes)).collect();
        let dialect = dialect_of(&said, options);
        let kinds: Vec<Line> = said
            .iter()
            .map(|line| line_of(&line.bytes, dialect))
            .collect();
        let first = kinds.iter().position(|kind| *kind == Line::Row);
        let first =
            first.map(|first| first + usize::from(is_header_of_numbers(&said[first..], dialect)));
        let first = first.map(|first| below_names(&said, &kinds, first, dialect));
        let rows: Vec<&Numbered> = match first {
            Some(first) => (first..said.len())
                .filter(|&i| {
                    kinds[i] == Line::Row
                        || (kinds[i] == Line::Other && !is_words(&said[i].bytes, dialect))
                })
                .map(|i| said[i])
                .collect(),
            None => Vec::new(),
        };
        let before = &said[..first.unwrap_or(said.len())];
        let counted = kinds.iter().any(|kind| matches!(kind, Line::Count(_)));
        let grid = Grid::of(&rows, dialect);
        let width = grid.columns.len();

        if let Some(asked) = &options.columns {
            let roles = names::asked(asked);
            if rows.is_empty() {
                return Err(NoPlan::Nothing);
            }
            let names = header_names(before, dialect, width).map_or(Vec::new(), |(_, names)| names);
            return Ok(Plan::new(dialect, roles, &grid, names, true, false));
        }
        if rows.is_empty()
            && let Some(last) = (0..said.len()).rfind(|&i| kinds[i] == Line::Other)
            && header_names(&said[..last], dialect, 0).is_some()
        {
            return Err(NoPlan::line(said[last], "rows of at least 3 numbers"));
        }
        match header(before, dialect, &grid)? {
            Header::Names {
                mut roles,
                names,
                ragged,
                weak,
            } => {
                name_normals(&mut roles, &grid);
                let unit = unit_above(before, dialect).or_else(|| names::unit(&names, &roles));
                let plan = Plan::new(dialect, roles, &grid, names, ragged, weak);
                Ok(Plan { unit, ..plan })
            }
            Header::None if rows.is_empty() => {
                match kinds.iter().position(|kind| *kind == Line::Other) {
                    Some(other) => Err(NoPlan::line(said[other], "rows of at least 3 numbers")),
                    None => Err(NoPlan::Nothing),
                }
            }
            Header::None if is_colmap(&grid.rows) => {
                let roles = ["-", "x", "y", "z", "red", "green", "blue", "error"].map(String::from);
                Ok(Plan::new(
                    dialect,
                    roles.into(),
                    &grid,
                    Vec::new(),
                    true,
                    false,
                ))
            }
            plain @ (Header::None | Header::Numbers) => {
                let found = guess(&grid.columns, counted);
                let weak = found.weak || matches!(plain, Header::Numbers);
                if !found.roles.iter().any(|role| role == "z") {
                    return Err(NoPlan::line(rows[0], "3 values that are numbers"));
                }
                let plan = Plan::new(dialect, found.roles, &grid, Vec::new(), false, weak);
                Ok(Plan {
                    letter: letter_of(&rows, dialect),
                    ..plan
                })
            }
        }
    }

    fn new(
        dialect: Dialect,
        roles: Vec<String>,
        grid: &Grid,
        names: Vec<String>,
        ragged: bool,
        weak: bool,
    ) -> Plan {
        let mut roles = roles;
        let column = |i: usize| grid.columns.get(i);
        for (i, role) in roles.iter_mut().enumerate() {
            let known = ["x", "y", "z", "rgb"].contains(&role.as_str());
            if !known && column(i).is_some_and(|column| !column.is_numeric() && column.texts > 0) {
                *role = "-".into();
            }
        }
        let named = roles.iter().position(|role| role == "rgb");
        let is = |holds: fn(&Column) -> bool| named.and_then(column).is_some_and(holds);
        let written = is(Column::is_written_color);
        let bits = is(Column::has_color_bits);
        // One value that packs no colour, as a name alone says it, is an attribute, or text.
        let packed = named.filter(|&i| {
            column(i).is_none_or(|column| {
                written
                    || column.values.is_empty()
                    || (column.texts == 0 && (column.is_packed() || is_small_packed(column)))
            })
        });
        if let Some(own) = roles
            .iter()
            .position(|role| role == "rgb")
            .filter(|_| packed.is_none())
        {
            let name = names.get(own).map_or("", |name| name.trim());
            roles[own] = if is(|column| column.texts > 0) {
                "-".into()
            } else if name.is_empty() {
                format!("column{}", own + 1)
            } else {
                name.into()
            };
        }
        let mut all: Vec<String> = roles.clone();
        if packed.is_some() {
            all.extend(["red", "green", "blue"].map(String::from));
        }
        let mut columns = Columns::from_names(&all).unwrap_or_else(Columns::xyz);
        columns
            .scalars
            .retain(|(i, name)| name != "-" && Some(*i) != packed);
        if packed.is_some() {
            columns.colors = ColorRange::Bytes;
        }
        let preview = Preview {
            rows: grid.texts.clone(),
            names,
            delimiter: dialect.delimiter_name(),
            decimal: if grid.commas { ',' } else { '.' },
            weak,
        };
        Plan {
            dialect,
            roles,
            columns,
            first_row: if grid.first_row == 0 {
                u64::MAX
            } else {
                grid.first_row
            },
            packed,
            written,
            bits,
            ragged,
            letter: None,
            unit: None,
            preview,
        }
    }

    /// Whether a line has another letter in front than points have.
    pub(super) fn is_no_point(&self, line: &[u8]) -> bool {
        self.letter
            .is_some_and(|letter| self.dialect.split(line).next() != Some(&[letter]))
    }

    /// Whether a line is a title, or the names of the columns again.
    pub(super) fn is_title(&self, line: &[u8]) -> bool {
        let names = self.dialect.split(line).map(decoded);
        is_words(line, self.dialect) || (names.eq(self.preview.names.iter().cloned()))
    }

    /// The values of a row, those that are passed over as 0.
    pub(super) fn row(
        &self,
        line: &[u8],
        input: &Input,
        number: u64,
        row: &mut Vec<f64>,
    ) -> Result<()> {
        row.clear();
        let width = self.roles.len();
        let mut count = 0;
        for token in self.dialect.split(line) {
            count += 1;
            if row.len() == width {
                if !self.ragged && !token.is_empty() {
                    return Err(self.wrong_width(line, input, number));
                }
                continue;
            }
            let column = row.len();
            row.push(if self.roles[column] == "-" {
                0.0
            } else if self.written && self.packed == Some(column) {
                let none = || match self.dialect.value(token) {
                    Value::Empty => Some(f64::NAN),
                    Value::Number(none) if none.is_nan() => Some(none),
                    _ => None,
                };
                let found = color(token).or_else(none);
                let expected = "a colour of 6 hexadecimal digits, or of 3 numbers";
                found.ok_or_else(|| input.bad_value(number, expected, token))?
            } else {
                match self.dialect.value(token) {
                    Value::Number(value) | Value::Hex(value) => value,
                    Value::Empty => f64::NAN,
                    Value::Text => return Err(input.bad_value(number, "a number", token)),
                }
            });
        }
        if row.len() < width || count < 3 {
            return Err(self.wrong_width(line, input, number));
        }
        if let Some(packed) = self.packed {
            let value = if self.bits {
                i64::from((row[packed] as f32).to_bits())
            } else {
                row[packed] as i64
            };
            let [blue, green, red, ..] = value.to_le_bytes();
            row.extend([red, green, blue].map(f64::from));
        }
        Ok(())
    }

    fn wrong_width(&self, line: &[u8], input: &Input, number: u64) -> Error {
        let expected = format!("{} values", self.roles.len().max(3));
        input.bad_value(number, &expected, line)
    }
}

/// The unit of a line of units between the names and the rows.
fn unit_above(before: &[&Numbered], dialect: Dialect) -> Option<Unit> {
    let values: Vec<String> = dialect.split(&before.last()?.bytes).map(decoded).collect();
    names::unit_of_line(values.iter().map(String::as_str))
}

/// Whether a line has words and no number.
fn is_words(line: &[u8], dialect: Dialect) -> bool {
    let is_word = |token| matches!(dialect.value(token), Value::Text | Value::Empty);
    let readable = line
        .iter()
        .all(|&b| b == b'\t' || (b >= b' ' && !b.is_ascii_digit()));
    readable && std::str::from_utf8(line).is_ok() && dialect.split(line).all(is_word)
}

/// The first row below the names of the columns, where a title above these has numbers, too.
fn below_names(said: &[&Numbered], kinds: &[Line], first: usize, dialect: Dialect) -> usize {
    /// Lines of a title.
    const MOST: usize = 10;
    let width = |i: usize| dialect.split(&said[i].bytes).count();
    let below = (first + 1..said.len()).take(MOST).find(|&i| {
        kinds[i] == Line::Row
            && kinds[i - 1] == Line::Other
            && width(i) != width(first)
            && header_names(&said[i - 1..i], dialect, width(i)).is_some()
    });
    below.unwrap_or(first)
}

/// Columns that the file calls i, j and k hold normals where these are vectors of length 1, as coordinate measuring machines
/// write them, and no others are there.
fn name_normals(roles: &mut [String], grid: &Grid) {
    if roles.iter().any(|role| role == "nx") {
        return;
    }
    let at = ["i", "j", "k"].map(|name| {
        roles
            .iter()
            .position(|role| role.eq_ignore_ascii_case(name))
    });
    let [Some(i), Some(j), Some(k)] = at else {
        return;
    };
    let columns: Option<Vec<&Column>> = [i, j, k].iter().map(|&at| grid.columns.get(at)).collect();
    if columns.is_some_and(|columns| !columns[0].values.is_empty() && is_unit(&columns)) {
        for (at, name) in [i, j, k].into_iter().zip(["nx", "ny", "nz"]) {
            roles[at] = name.into();
        }
    }
}

/// A column that names itself a colour holds one where its values can be: whole, and beyond a byte.
fn is_small_packed(column: &Column) -> bool {
    column.values.iter().all(|v| v.is_nan() || v.fract() == 0.0)
        && column.values.iter().any(|v| *v > 255.0)
}

/// The letter in front of nearly all rows.
fn letter_of(rows: &[&Numbered], dialect: Dialect) -> Option<u8> {
    let first = |line: &&Numbered| match dialect.split(&line.bytes).next() {
        Some([letter]) if letter.is_ascii_alphabetic() => Some(*letter),
        _ => None,
    };
    let letter = rows.last().and_then(&first)?;
    let same = rows.iter().filter(|row| first(row) == Some(letter)).count();
    (10 * same >= 9 * rows.len()).then_some(letter)
}

/// Whether the lines can be rows: the first that says something is one, counts them, or names x, y and z; or a title is above
/// such names and a row.
pub(super) fn looks_like(lines: &[Numbered]) -> bool {
    /// Lines of a title.
    const MOST: usize = 10;
    let said: Vec<&Numbered> = lines.iter().filter(|line| is_said(&line.bytes)).collect();
    let dialect = dialect_of(&said, &ReadOptions::default());
    let named = |line: &&Numbered| header_names(&[line], dialect, 0).is_some();
    for (i, line) in said.iter().enumerate() {
        match line_of(&line.bytes, dialect) {
            _ if named(line) => return true,
            Line::Nothing => {}
            Line::Count(_) | Line::Row => return true,
            Line::Other if is_header_of_numbers(&[line, line], dialect) => return true,
            Line::Other if only_numbers(line, dialect) => {
                let below = said.get(i + 1).map(|row| line_of(&row.bytes, dialect));
                return below == Some(Line::Row);
            }
            Line::Other => {
                let below = &said[i..said.len().min(i + MOST)];
                let names = below.iter().position(named);
                let first = |names: usize| said.get(i + names + 1);
                let row = names
                    .and_then(first)
                    .map(|row| line_of(&row.bytes, dialect));
                return row == Some(Line::Row);
            }
        }
    }
    false
}
