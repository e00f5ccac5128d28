//! Elevation grids as text (ESRI ASCII raster): `ncols`, `nrows`, the lower left corner or its cell's middle, the cell's size,
//! the value of cells without data; then heights, the northern row first. Each cell with data is a point at its middle.

use super::input::Input;
use super::options::ReadOptions;
use super::reading::{Parser, Step};
use super::table::{Columns, Table};
use super::text::{number, words};
use crate::base::error::Result;

/// Whether the first line is the count of columns.
pub(super) fn looks_like(head: &[u8]) -> bool {
    let mut lines = head.split(|&b| b == b'\n' || b == b'\r');
    let first = lines
        .find(|line| !line.trim_ascii().is_empty())
        .unwrap_or_default();
    let mut words = words(first);
    words
        .next()
        .is_some_and(|word| word.eq_ignore_ascii_case(b"ncols"))
        && words.next().is_some_and(|word| number(word).is_some())
}

/// What the head says.
#[derive(Default)]
struct Header {
    columns: Option<f64>,
    rows: Option<f64>,
    /// Of the lower left cell: x and y, and whether they are its middle.
    corner: [Option<(f64, bool)>; 2],
    cell: [Option<f64>; 2],
    no_data: Option<f64>,
}

/// Where cells are.
struct Grid {
    columns: u64,
    rows: u64,
    /// Middle of the lower left cell.
    start: [f64; 2],
    cell: [f64; 2],
    no_data: f64,
}

/// Reads the cells.
#[derive(Default)]
pub(super) struct Raster {
    keep: bool,
    header: Header,
    grid: Option<Grid>,
    /// Cells so far.
    cells: u64,
}

impl Raster {
    pub(super) fn new(options: &ReadOptions) -> Raster {
        Raster {
            keep: options.keep_sentinels,
            ..Raster::default()
        }
    }
}

impl Parser for Raster {
    fn parse(&mut self, input: &mut Input, table: &mut Option<Table>) -> Result<Step> {
        if self.grid.is_none() && !self.read_header(input)? {
            return Ok(Step::More);
        }
        let Some(grid) = &self.grid else {
            return Ok(Step::More);
        };
        let total = grid.columns * grid.rows;
        let room = (input.left() / 2 + 1).min(total);
        let table = table.get_or_insert_with(|| Table::new(Columns::xyz(), Some(room)));
        while self.cells < total {
            // A row of a wide grid is longer than lines of text are.
            let bytes = input.rest();
            let blanks = bytes.iter().take_while(|b| b.is_ascii_whitespace()).count();
            let length = bytes[blanks..]
                .iter()
                .take_while(|b| !b.is_ascii_whitespace())
                .count();
            if blanks + length == bytes.len() && !input.last {
                return Ok(Step::More);
            }
            let at = input.place.byte + blanks as u64;
            let word = &bytes[blanks..blanks + length];
            if word.is_empty() {
                let found = format!("{} of them, then the end of the file", self.cells);
                return Err(input.bad_byte(at, &format!("{total} heights"), found));
            }
            let height = number(word)
                .ok_or_else(|| input.bad_byte(at, "a height", super::text::quote(word)))?;
            input.take(blanks + length);
            let (row, column) = (self.cells / grid.columns, self.cells % grid.columns);
            self.cells += 1;
            if height == grid.no_data && !self.keep {
                table.no_data += 1;
                continue;
            }
            table.push(&[
                grid.start[0] + column as f64 * grid.cell[0],
                grid.start[1] + (grid.rows - 1 - row) as f64 * grid.cell[1],
                height,
            ]);
        }
        Ok(Step::Done)
    }
}

impl Raster {
    /// Reads the lines at hand; whether all of the head was there.
    fn read_header(&mut self, input: &mut Input) -> Result<bool> {
        loop {
            let start = input.mark();
            // The first line of heights may be longer than a line of text.
            let first = input.rest().iter().find(|b| !b.is_ascii_whitespace());
            let is_number = first.is_some_and(|b| b.is_ascii_digit() || b"+-.".contains(b));
            if is_number {
                self.grid = Some(self.header.grid(input)?);
                return Ok(true);
            }
            let Some(line) = input.line()? else {
                return if input.last {
                    Err(input.no_line("a line of a grid's head, or heights"))
                } else {
                    input.go_back(start);
                    Ok(false)
                };
            };
            let mut said = words(line);
            let Some(key) = said.next() else {
                continue;
            };
            let key = String::from_utf8_lossy(key).to_ascii_lowercase();
            if key == "nan" {
                input.go_back(start);
                self.grid = Some(self.header.grid(input)?);
                return Ok(true);
            }
            let value = said.next().and_then(number);
            let value = value.ok_or_else(|| input.bad_line("a name and a number", line))?;
            let header = &mut self.header;
            match key.as_str() {
                "ncols" => header.columns = Some(value),
                "nrows" => header.rows = Some(value),
                "xllcorner" => header.corner[0] = Some((value, false)),
                "yllcorner" => header.corner[1] = Some((value, false)),
                "xllcenter" => header.corner[0] = Some((value, true)),
                "yllcenter" => header.corner[1] = Some((value, true)),
                "cellsize" => header.cell = [Some(value); 2],
                "dx" => header.cell[0] = Some(value),
                "dy" => header.cell[1] = Some(value),
                "nodata_value" | "nodata" => header.no_data = Some(value),
                _ => {
                    return Err(input.bad_line(
                        "ncols, nrows, xllcorner, yllcorner, cellsize or NODATA_value",
                        line,
                    ));
                }
            }
        }
    }
}

impl Header {
    fn grid(&self, input: &Input) -> Result<Grid> {
        let missing = |what: &str| {
            input.bad_at_line(
                input.place.line.max(1),
                what,
                "none before the heights".into(),
            )
        };
        let count = |value: Option<f64>, what: &str| match value {
            Some(count) if count >= 1.0 && count <= f64::from(u32::MAX) && count.fract() == 0.0 => {
                Ok(count as u64)
            }
            _ => Err(missing(what)),
        };
        let finite = |value: Option<f64>, what: &str| {
            value.filter(|x| x.is_finite()).ok_or_else(|| missing(what))
        };
        let mut start = [0.0; 2];
        let mut cell = [0.0; 2];
        for axis in 0..2 {
            cell[axis] = finite(
                self.cell[axis].filter(|size| *size > 0.0),
                "the cell's size",
            )?;
            let (corner, middle) =
                self.corner[axis].ok_or_else(|| missing("the lower left corner"))?;
            let corner = finite(Some(corner), "the lower left corner")?;
            start[axis] = if middle {
                corner
            } else {
                corner + 0.5 * cell[axis]
            };
        }
        Ok(Grid {
            columns: count(self.columns, "the count of columns")?,
            rows: count(self.rows, "the count of rows")?,
            start,
            cell,
            no_data: self.no_data.unwrap_or(-9999.0),
        })
    }
}
