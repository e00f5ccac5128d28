//! How a table is read, decided from its first lines.

use super::super::colors::ColorRange;
use super::super::input::Input;
use super::super::options::ReadOptions;
use super::super::preview::Preview;
use super::super::table::Columns;
use super::super::text::{decoded, quote};
use super::dialect::{DIALECTS, Delimiter, Dialect, Value, hex};
use super::guess::{Column, guess, is_colmap};
use super::names;
use super::{Line, line_of};
use crate::base::error::Result;

/// A line of the file.
pub(super) struct Numbered {
    pub(super) number: u64,
    pub(super) bytes: Vec<u8>,
}

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
    /// The packed colours are hexadecimal without a mark.
    hexadecimal: bool,
    /// Values beyond the columns are passed over.
    ragged: bool,
    pub(super) preview: Preview,
}

/// Why there is no plan.
pub(super) enum NoPlan {
    /// Nothing in the lines is a row or names columns.
    Nothing,
    /// A line is wrong.
    Line {
        number: u64,
        expected: String,
        found: String,
    },
}

impl NoPlan {
    fn line(line: &Numbered, expected: impl Into<String>) -> NoPlan {
        NoPlan::Line {
            number: line.number,
            expected: expected.into(),
            found: quote(&line.bytes),
        }
    }
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
        let rows: Vec<&Numbered> = match first {
            Some(first) => (first..said.len())
                .filter(|&i| [Line::Row, Line::Other].contains(&kinds[i]))
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
        match header(before, dialect, &grid)? {
            Header::Names {
                roles,
                names,
                ragged,
            } => Ok(Plan::new(dialect, roles, &grid, names, ragged, false)),
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
            Header::None => {
                let found = guess(&grid.columns, counted);
                if !found.roles.iter().any(|role| role == "z") {
                    return Err(NoPlan::line(rows[0], "3 values that are numbers"));
                }
                Ok(Plan::new(
                    dialect,
                    found.roles,
                    &grid,
                    Vec::new(),
                    false,
                    found.weak,
                ))
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
        let packed = roles.iter().position(|role| role == "rgb");
        let hexadecimal = packed
            .and_then(column)
            .is_some_and(|column| column.texts > 0);
        // One value that packs no colour, as a name alone says it, is an attribute.
        let packed = packed.filter(|&i| {
            column(i).is_none_or(|column| {
                hexadecimal
                    || column.values.is_empty()
                    || column.is_packed()
                    || is_small_packed(column)
            })
        });
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
            hexadecimal,
            ragged,
            preview,
        }
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
            } else if self.hexadecimal && self.packed == Some(column) {
                let found = if token.is_empty() {
                    Some(f64::NAN)
                } else {
                    hex(token, false)
                };
                found.ok_or_else(|| {
                    input.bad_value(number, "a colour of 6 hexadecimal digits", token)
                })?
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
            let [blue, green, red, ..] = (row[packed] as i64).to_le_bytes();
            row.extend([red, green, blue].map(f64::from));
        }
        Ok(())
    }

    fn wrong_width(&self, line: &[u8], input: &Input, number: u64) -> crate::Error {
        let expected = format!("{} values", self.roles.len().max(3));
        input.bad_value(number, &expected, line)
    }
}

/// A column that names itself a colour holds one where its values can be: whole, and beyond a byte.
fn is_small_packed(column: &Column) -> bool {
    column.values.iter().all(|v| v.is_nan() || v.fract() == 0.0)
        && column.values.iter().any(|v| *v > 255.0)
}

/// Whether a line says something: it is neither blank nor only marks.
fn is_said(line: &[u8]) -> bool {
    line.iter().any(|b| !b.is_ascii_whitespace())
}

pub(super) fn is_comment(line: &[u8]) -> bool {
    let line = line.trim_ascii_start();
    line.starts_with(b"//") || line.first().is_some_and(|mark| b"#%!".contains(mark))
}

/// The dialect in which most lines are rows, with the fewest values that are no numbers and the fewest widths.
fn dialect_of(said: &[&Numbered], options: &ReadOptions) -> Dialect {
    let asked = |dialect: &Dialect| {
        let comma = options
            .decimal
            .is_none_or(|mark| dialect.decimal_comma == (mark == ','));
        let delimiter = match options.delimiter {
            None => true,
            Some(' ') => dialect.delimiter == Delimiter::Blanks,
            Some(mark) => dialect.delimiter == Delimiter::Mark(mark as u8),
        };
        comma && delimiter
    };
    let own = options.delimiter.map(|mark| Dialect {
        delimiter: if mark == ' ' {
            Delimiter::Blanks
        } else {
            Delimiter::Mark(mark as u8)
        },
        decimal_comma: options.decimal == Some(','),
    });
    let candidates = DIALECTS.into_iter().filter(asked);
    let mut best: Option<((usize, usize, usize), Dialect)> = None;
    for dialect in candidates.chain(own) {
        let score = score(said, dialect);
        if best.is_none_or(|(most, _)| score > most) {
            best = Some((score, dialect));
        }
    }
    best.map_or(DIALECTS[8], |(_, dialect)| dialect)
}

/// Rows, numbers among their values in thousandths, and rows as wide as the first.
fn score(said: &[&Numbered], dialect: Dialect) -> (usize, usize, usize) {
    let (mut rows, mut numbers, mut values, mut alike) = (0, 0, 0, 0);
    let mut first = None;
    for line in said.iter().filter(|line| !is_comment(&line.bytes)) {
        let (mut here, mut count) = (0, 0);
        for token in dialect.split(&line.bytes) {
            count += 1;
            let value = dialect.value(token);
            here += usize::from(matches!(value, Value::Number(_) | Value::Hex(_)));
            values += usize::from(value != Value::Empty);
        }
        if here >= 3 {
            rows += 1;
            numbers += here;
            alike += usize::from(*first.get_or_insert(count) == count);
        }
    }
    (rows, 1000 * numbers / values.max(1), alike)
}

/// A header that numbers its columns, as pandas writes it: `,0,1,2`.
fn is_header_of_numbers(lines: &[&Numbered], dialect: Dialect) -> bool {
    let Some(line) = lines.first() else {
        return false;
    };
    let mut tokens = dialect.split(&line.bytes).enumerate();
    lines.len() > 1
        && tokens.next().is_some_and(|(_, first)| first.is_empty())
        && tokens.all(|(i, token)| dialect.value(token) == Value::Number(i as f64 - 1.0))
}

/// The first rows.
#[derive(Default)]
struct Grid {
    columns: Vec<Column>,
    /// Values row by row, whatever their number.
    rows: Vec<Vec<f64>>,
    texts: Vec<Vec<String>>,
    /// A value has a decimal comma.
    commas: bool,
    /// Number of the first row's line.
    first_row: u64,
}

impl Grid {
    fn of(lines: &[&Numbered], dialect: Dialect) -> Grid {
        const SHOWN: usize = 8;
        const MOST_SHOWN: usize = 64;
        let mut grid = Grid {
            first_row: lines.first().map_or(0, |line| line.number),
            ..Grid::default()
        };
        for line in lines {
            let tokens: Vec<&[u8]> = dialect.split(&line.bytes).collect();
            if grid.columns.is_empty() {
                grid.columns.resize_with(tokens.len(), Column::default);
            }
            if grid.texts.len() < SHOWN {
                let text = |token: &&[u8]| decoded(&token[..token.len().min(40)]);
                grid.texts
                    .push(tokens.iter().take(MOST_SHOWN).map(text).collect());
            }
            let values: Vec<Value> = tokens.iter().map(|token| dialect.value(token)).collect();
            let number = |value: &Value| match value {
                Value::Number(value) | Value::Hex(value) => *value,
                Value::Empty | Value::Text => f64::NAN,
            };
            grid.commas |=
                dialect.decimal_comma && tokens.iter().any(|token| token.contains(&b','));
            grid.rows.push(values.iter().map(number).collect());
            for (column, (value, token)) in grid.columns.iter_mut().zip(values.iter().zip(&tokens))
            {
                column.values.push(number(value));
                column.texts += usize::from(*value == Value::Text);
                column.empty += usize::from(*value == Value::Empty);
                column.hexes += usize::from(matches!(value, Value::Hex(_)));
                column.fractions += usize::from(token.iter().any(|b| b".,eEdD".contains(b)));
            }
        }
        // A mark at the end of every line has nothing behind it.
        while grid
            .columns
            .last()
            .is_some_and(|column| column.empty == column.values.len())
        {
            grid.columns.pop();
        }
        // Rows that are too short are refused later; here all columns are as long as the rows are many.
        for column in &mut grid.columns {
            column.values.resize(lines.len(), f64::NAN);
        }
        grid
    }
}

enum Header {
    Names {
        roles: Vec<String>,
        names: Vec<String>,
        ragged: bool,
    },
    None,
}

/// What the lines before the rows call the columns.
fn header(
    before: &[&Numbered],
    dialect: Dialect,
    grid: &Grid,
) -> std::result::Result<Header, NoPlan> {
    let width = grid.columns.len();
    let Some((line, mut names)) = header_names(before, dialect, width) else {
        // Without rows the first line that is none says more.
        let last = before.last().filter(|line| {
            let names = dialect.split(&line.bytes).count();
            width > 0
                && !is_comment(&line.bytes)
                && names == width
                && line_of(&line.bytes, dialect) == Line::Other
        });
        return match last {
            Some(line) if dialect.split(&line.bytes).all(|name| name.is_empty()) => {
                Ok(Header::None)
            }
            Some(line) if is_header_of_numbers(&[line, line], dialect) => Ok(Header::None),
            Some(line) => Err(NoPlan::line(
                line,
                "numbers, or names of columns with x, y and z, or the option columns",
            )),
            None => Ok(Header::None),
        };
    };
    if names::contradict(&names) {
        return Err(NoPlan::line(
            line,
            "numbers, or different column names with x, y and z",
        ));
    }
    // COLMAP: a list whose length differs ends the row.
    let list = names.iter().position(|name| name.contains("[]"));
    if let Some(list) = list {
        names.truncate(list);
    }
    if names.len() + 1 == width && list.is_none() && is_row_name(grid) {
        names.insert(0, String::new());
    }
    let roles = names::roles(&names).unwrap_or_default();
    let matches = width == 0 || roles.len() == width || list.is_some();
    if !matches && is_comment(&line.bytes) {
        return Ok(Header::None);
    }
    // Behind the columns that have names a mark may end each row.
    let wider = roles.len() > width && roles[width..].iter().all(|role| role == "-");
    if !matches && !wider {
        return Err(NoPlan::Line {
            number: grid.first_row,
            expected: format!("{} values, one for each name", roles.len()),
            found: format!("{width} values"),
        });
    }
    let mut roles = roles;
    if list.is_none() && width > 0 {
        roles.truncate(width);
    }
    Ok(Header::Names {
        roles,
        names,
        ragged: list.is_some(),
    })
}

/// R writes names of rows without a name for their column.
fn is_row_name(grid: &Grid) -> bool {
    let first = &grid.columns[0];
    let runs = first.values.windows(2).all(|pair| pair[1] - pair[0] == 1.0);
    grid.rows.len() > 1 && (runs || !first.is_numeric())
}

/// The last line before the rows that names x, y and z, and its names.
fn header_names<'a>(
    before: &[&'a Numbered],
    dialect: Dialect,
    width: usize,
) -> Option<(&'a Numbered, Vec<String>)> {
    before.iter().rev().find_map(|line| {
        let bytes = &line.bytes[line.bytes.iter().take_while(|b| b" \t".contains(b)).count()..];
        let marks = bytes.iter().take_while(|b| b"#/%!".contains(b)).count();
        let text = &bytes[marks..];
        let own = std::iter::once(dialect);
        let splits: Vec<Vec<String>> = own
            .chain(
                DIALECTS
                    .into_iter()
                    .filter(|dialect| !dialect.decimal_comma),
            )
            .map(|dialect| names_of(text, dialect))
            .filter(|names| names::roles(names).is_some())
            .collect();
        let fitting = splits.iter().find(|names| names.len() == width);
        let found = fitting.or_else(|| {
            splits
                .iter()
                .max_by_key(|names| std::cmp::Reverse(names.len().abs_diff(width)))
        });
        found.map(|names| (*line, names.clone()))
    })
}

/// Names of columns; between blanks a unit in brackets belongs to the name before it.
fn names_of(text: &[u8], dialect: Dialect) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for token in dialect.split(text) {
        let name = decoded(token);
        let open =
            |name: &String| name.matches(['(', '[']).count() > name.matches([')', ']']).count();
        match names.last_mut() {
            Some(last)
                if dialect.delimiter == Delimiter::Blanks
                    && (name.starts_with(['(', '[']) || open(last)) =>
            {
                last.push(' ');
                last.push_str(&name);
            }
            _ => names.push(name),
        }
    }
    names
}

/// Whether the lines can be rows: the first that says something is one, counts them, or names x, y and z.
pub(super) fn looks_like(lines: &[Numbered]) -> bool {
    let said: Vec<&Numbered> = lines.iter().filter(|line| is_said(&line.bytes)).collect();
    let dialect = dialect_of(&said, &ReadOptions::default());
    for line in &said {
        let named = header_names(&[line], dialect, 0).is_some();
        match line_of(&line.bytes, dialect) {
            _ if named => return true,
            Line::Nothing => {}
            Line::Count(_) | Line::Row => return true,
            Line::Other => return is_header_of_numbers(&[line, line], dialect),
        }
    }
    false
}
