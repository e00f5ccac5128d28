//! Elevation grids as text. ESRI's ASCII raster: `ncols`, `nrows`, the lower left corner or its cell's middle, the cell's size,
//! the value of cells without data; then heights, the northern row first. GRASS has the edges instead (`north:` …) and `*` for no
//! data. Surfer's (`DSAA`) has counts, the ranges of the middles and of the heights, then the southern row first. Each cell with
//! data is a point at its middle.

use super::input::Input;
use super::options::ReadOptions;
use super::parser::{Parser, Step};
use super::table::{Columns, Table};
use super::text::{decimal_comma, number, words};
use crate::base::error::Result;

/// Whether the first line is one of a grid's head.
pub(super) fn looks_like(head: &[u8]) -> bool {
    const KEYS: [&str; 12] = [
        "ncols",
        "nrows",
        "xllcorner",
        "yllcorner",
        "xllcenter",
        "yllcenter",
        "north",
        "south",
        "east",
        "west",
        "rows",
        "cols",
    ];
    let mut lines = head.split(|&b| b == b'\n' || b == b'\r');
    let first = lines
        .find(|line| !line.trim_ascii().is_empty())
        .unwrap_or_default();
    let mut words = words(first);
    let key = key_of(words.next().unwrap_or_default());
    key == SURFER || (KEYS.contains(&key.as_str()) && words.next().and_then(height).is_some())
}

/// The first word of Surfer's grids as text.
const SURFER: &str = "dsaa";

/// A name in the head, without its colon.
fn key_of(word: &[u8]) -> String {
    let key = String::from_utf8_lossy(word).to_ascii_lowercase();
    key.trim_end_matches(':').into()
}

/// A number with a decimal point or comma.
fn height(word: &[u8]) -> Option<f64> {
    number(word).or_else(|| decimal_comma(word))
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
    /// West and south, east and north: the outer edges.
    edges: [[Option<f64>; 2]; 2],
    /// Surfer's: counts and ranges, as far as they have been.
    surfer: Option<Vec<f64>>,
}

/// Where cells are.
struct Grid {
    columns: u64,
    rows: u64,
    /// Middle of the lower left cell.
    start: [f64; 2],
    cell: [f64; 2],
    no_data: f64,
    /// The southern row comes first.
    from_south: bool,
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
            if word == b"*" {
                input.take(blanks + length);
                self.cells += 1;
                table.no_data += 1;
                continue;
            }
            let height = height(word)
                .ok_or_else(|| input.bad_byte(at, "a height", super::text::quote(word)))?;
            input.take(blanks + length);
            let (row, column) = (self.cells / grid.columns, self.cells % grid.columns);
            self.cells += 1;
            if height == grid.no_data && !self.keep {
                table.no_data += 1;
                continue;
            }
            let up = if grid.from_south {
                row
            } else {
                grid.rows - 1 - row
            };
            table.push(&[
                grid.start[0] + column as f64 * grid.cell[0],
                grid.start[1] + up as f64 * grid.cell[1],
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
            let is_number = first.is_some_and(|b| b.is_ascii_digit() || b"+-.*".contains(b));
            let begun = self.header.surfer.as_ref().map_or(0, Vec::len);
            if is_number && (self.header.surfer.is_none() || begun >= SURFERS) {
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
            if let Some(values) = &mut self.header.surfer {
                for word in said {
                    let value = height(word);
                    values.push(value.ok_or_else(|| input.bad_line("a count or a range", line))?);
                }
                continue;
            }
            let Some(key) = said.next() else {
                continue;
            };
            let key = key_of(key);
            if key == SURFER {
                self.header.surfer = Some(Vec::new());
                continue;
            }
            if key == "nan" {
                input.go_back(start);
                self.grid = Some(self.header.grid(input)?);
                return Ok(true);
            }
            let value = said.next().and_then(height);
            let value = value.ok_or_else(|| input.bad_line("a name and a number", line))?;
            let header = &mut self.header;
            match key.as_str() {
                "ncols" | "cols" => header.columns = Some(value),
                "nrows" | "rows" => header.rows = Some(value),
                "xllcorner" => header.corner[0] = Some((value, false)),
                "yllcorner" => header.corner[1] = Some((value, false)),
                "xllcenter" => header.corner[0] = Some((value, true)),
                "yllcenter" => header.corner[1] = Some((value, true)),
                "cellsize" => header.cell = [Some(value); 2],
                "dx" => header.cell[0] = Some(value),
                "dy" => header.cell[1] = Some(value),
                "west" => header.edges[0][0] = Some(value),
                "south" => header.edges[0][1] = Some(value),
                "east" => header.edges[1][0] = Some(value),
                "north" => header.edges[1][1] = Some(value),
                "nodata_value" | "nodata" | "null" => header.no_data = Some(value),
                _ => {
                    let expected = "ncols, nrows, xllcorner, yllcorner, cellsize or NODATA_value";
                    return Err(input.bad_line(expected, line));
                }
            }
        }
    }
}

/// Numbers in the head of Surfer's grids.
const SURFERS: usize = 8;

impl Header {
    /// Takes corner and size of the cells from the edges, or from Surfer's ranges of their middles.
    fn settle(&mut self) {
        if let Some(&[columns, rows, west, east, south, north, ..]) = self.surfer.as_deref() {
            (self.columns, self.rows) = (Some(columns), Some(rows));
            let size = |from: f64, to: f64, count: f64| Some((to - from) / (count - 1.0).max(1.0));
            self.cell = [size(west, east, columns), size(south, north, rows)];
            self.corner = [Some((west, true)), Some((south, true))];
        }
        for (axis, count) in [self.columns, self.rows].into_iter().enumerate() {
            if let ([Some(low), Some(high)], Some(count)) =
                (self.edges.map(|edge| edge[axis]), count)
            {
                self.cell[axis] = Some((high - low) / count);
                self.corner[axis] = Some((low, false));
            }
        }
    }

    fn grid(&mut self, input: &Input) -> Result<Grid> {
        self.settle();
        let usual = if self.surfer.is_some() {
            1.70141e38
        } else {
            -9999.0
        };
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
            no_data: self.no_data.unwrap_or(usual),
            from_south: self.surfer.is_some(),
        })
    }
}
