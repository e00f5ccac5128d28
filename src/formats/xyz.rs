//! Rows of numbers as text: XYZ, TXT, PTS, CSV, ASC. No standard says what such a file holds, so this does:
//!
//! - **Rows**: one point a line; values are separated by blanks, tabs, commas, semicolons or bars, the decimal mark is a point or
//!   a comma: whichever makes most of the first lines rows. All rows have the same number of values, three numbers at
//!   least; values may be quoted, or empty between marks. Columns of text are passed over, and so are blank lines, lines
//!   that start with `#`, `//`, `%` or `!`, and titles above the rows.
//! - **Counts**: a line with one whole number is a count of rows (PTS; a file may hold several scans). Fewer rows than the
//!   counts say mean that the file is cut off, which is an error; more are read.
//! - **Names**: a line or a comment before the first row that names x, y and z names the columns; see `names`. A line of as
//!   many other names is refused, because a guess could be wrong; the option `columns` says what they are.
//! - **Without names** a number that only counts or names the points in front is none of x, y, z; the next three columns are.
//!   The rest follows from their number and from the first thousand rows: three columns whose vectors have length 1
//!   (within 5 %) are normals; three with whole numbers of 8 or 16 bits, or with numbers from 0 to 1, are colours, and one
//!   with whole numbers beyond 16 bits, or with hexadecimal ones, packs them; one column alone is `intensity`. Where both
//!   readings of seven columns fit, intensity comes before the colours in a file with a count (PTS) and after them in
//!   others. Columns that fit nothing become attributes `column4`, `column5` ….

mod dialect;
mod grid;
mod guess;
mod header;
mod line;
mod names;
mod plan;
mod value;

use super::input::Input;
use super::options::ReadOptions;
use super::parser::{Parser, Step};
use super::preview::Preview;
use super::table::Table;
use crate::base::error::{Error, Result};
use crate::cloud::Unit;
use line::{Line, NoPlan, Numbered, is_comment, line_of};
use plan::Plan;

/// Lines that decide what the columns are.
const LOOK_AHEAD: usize = 1000;
/// Or bytes.
const MOST_AHEAD: usize = 1 << 22;

/// Whether the first line that says something is a row, a count, or names x, y and z.
pub(super) fn looks_like(head: &[u8]) -> bool {
    const MOST_LINES: usize = 100;
    let lines: Vec<Numbered> = head
        .split(|&b| b == b'\n' || b == b'\r')
        .take(MOST_LINES)
        .map(|line| Numbered {
            number: 0,
            bytes: line.to_vec(),
        })
        .collect();
    plan::looks_like(&lines)
}

/// Reads the points.
#[derive(Default)]
pub(super) struct Xyz {
    options: ReadOptions,
    /// The first lines, until there is a plan.
    ahead: Vec<Numbered>,
    ahead_bytes: usize,
    plan: Option<Plan>,
    /// Of a table that is refused, too: a person may say what its columns are.
    preview: Option<Preview>,
    /// Sum of the counts in the file.
    promised: Option<u64>,
    rows: u64,
    /// Values of the line at hand.
    values: Vec<f64>,
}

impl Xyz {
    pub(super) fn new(options: &ReadOptions) -> Xyz {
        Xyz {
            options: options.clone(),
            ..Xyz::default()
        }
    }
}

impl Parser for Xyz {
    fn parse(&mut self, input: &mut Input, table: &mut Option<Table>) -> Result<Step> {
        if input.place.byte == 0
            && (input.rest().starts_with(&[0xff, 0xfe]) || input.rest().starts_with(&[0xfe, 0xff]))
        {
            return Err(input.unsupported("UTF-8 or ASCII text", "UTF-16 text"));
        }
        while let Some(line) = input.line()? {
            let number = input.place.line;
            if number <= self.options.skip {
                continue;
            }
            if let (Some(plan), Some(table)) = (&self.plan, table.as_mut()) {
                let row = read_line(plan, line, number, input, &mut self.values)?;
                push(row, &self.values, &mut self.promised, &mut self.rows, table);
                continue;
            }
            self.ahead_bytes += line.len();
            self.ahead.push(Numbered {
                number,
                bytes: line.to_vec(),
            });
            if self.ahead.len() == LOOK_AHEAD || self.ahead_bytes > MOST_AHEAD {
                self.start(input, table)?;
            }
        }
        if !input.last {
            return Ok(Step::More);
        }
        self.finish(input, table)?;
        Ok(Step::Done)
    }

    fn columns(&self) -> Vec<String> {
        self.plan
            .as_ref()
            .map_or(Vec::new(), |plan| plan.roles.clone())
    }

    fn unit(&self) -> Option<Unit> {
        self.plan.as_ref().and_then(|plan| plan.unit)
    }

    fn preview(&self) -> Option<Preview> {
        self.preview.clone()
    }
}

/// What a line after the plan holds: a row, which is in `values`, a count of rows, or nothing.
fn read_line(
    plan: &Plan,
    line: &[u8],
    number: u64,
    input: &Input,
    values: &mut Vec<f64>,
) -> Result<Line> {
    let line = line.trim_ascii_end();
    if is_comment(line) || plan.is_no_point(line) {
        return Ok(Line::Nothing);
    }
    if plan.dialect.split(line).nth(1).is_none()
        && let count @ Line::Count(_) = line_of(line, plan.dialect)
    {
        return Ok(count);
    }
    match plan.row(line, input, number, values) {
        // Words between the rows, or below them.
        Err(_) if plan.is_title(line) => Ok(Line::Nothing),
        done => done.map(|()| Line::Row),
    }
}

fn push(line: Line, values: &[f64], promised: &mut Option<u64>, rows: &mut u64, table: &mut Table) {
    match line {
        Line::Count(count) => *promised = Some(promised.unwrap_or(0).saturating_add(count)),
        Line::Row => {
            *rows += 1;
            table.push(values);
        }
        Line::Nothing | Line::Other => {}
    }
}

impl Xyz {
    /// Decides how rows are read, and reads the first.
    fn start(&mut self, input: &Input, table: &mut Option<Table>) -> Result<()> {
        let ahead = std::mem::take(&mut self.ahead);
        let plan = Plan::of(&ahead, &self.options);
        self.preview = match &plan {
            Ok(plan) => Some(plan.preview.clone()),
            Err(refused) => self.refused(&ahead, refused),
        };
        let plan = match plan {
            Ok(plan) => plan,
            Err(NoPlan::Line {
                number,
                expected,
                found,
            }) => return Err(input.bad_at_line(number, &expected, found)),
            Err(NoPlan::Nothing) => {
                return Err(self.no_rows(input, "rows of numbers"));
            }
        };
        let table = table.insert(Table::new(plan.columns.clone(), None));
        // Titles and names are above the first row.
        let mut begun = false;
        for line in &ahead {
            let kind = line_of(&line.bytes, plan.dialect);
            begun |= line.number >= plan.first_row;
            if begun || matches!(kind, Line::Count(_)) {
                let row = read_line(&plan, &line.bytes, line.number, input, &mut self.values)?;
                push(row, &self.values, &mut self.promised, &mut self.rows, table);
            }
        }
        self.plan = Some(plan);
        Ok(())
    }

    /// What a person needs of a table that is refused, with the names that are not understood.
    fn refused(&self, ahead: &[Numbered], why: &NoPlan) -> Option<Preview> {
        let any = ReadOptions {
            columns: Some(Vec::new()),
            ..self.options.clone()
        };
        let plan = Plan::of(ahead, &any).ok()?;
        let mut preview = plan.preview;
        if let NoPlan::Line { number, .. } = why
            && *number < plan.first_row
            && let Some(line) = ahead.iter().find(|line| line.number == *number)
        {
            let names = plan.dialect.split(&line.bytes);
            preview.names = names
                .map(|name| String::from_utf8_lossy(name).into_owned())
                .collect();
        }
        Some(preview)
    }

    fn finish(&mut self, input: &Input, table: &mut Option<Table>) -> Result<()> {
        if self.plan.is_none() {
            self.start(input, table)?;
        }
        match self.promised {
            Some(promised) if self.rows < promised => {
                Err(self.no_rows(input, &format!("{promised} rows")))
            }
            _ => Ok(()),
        }
    }

    fn no_rows(&self, input: &Input, expected: &str) -> Error {
        let found = format!("the end of the file after {} rows", self.rows);
        input.bad_at_line(input.place.line.max(1), expected, found)
    }
}
