//! PTX (Leica Cyclone): scans, each with the counts of its columns and rows, the scanner's place and axes, a matrix, and a line
//! `x y z intensity [r g b]` for each cell of its grid. The matrix takes the points to the common frame: a point is a row
//! before it, and its last row is the scanner's place. Cells without a return are `0 0 0`; they are left out and counted. Points of a
//! scan without colours are white where another scan has some.

use super::colors::{ColorRange, WHITE};
use super::input::Input;
use super::options::ReadOptions;
use super::parser::{Parser, Step};
use super::table::{Columns, Table};
use super::text::{number, words};
use crate::base::error::Result;

/// Lines of a scan before its points: counts, place, axes, matrix.
const HEADER: usize = 10;

/// Whether the first lines are the head of a scan.
pub(super) fn looks_like(head: &[u8]) -> bool {
    let mut lines = head
        .split(|&b| b == b'\n')
        .map(<[u8]>::trim_ascii)
        .filter(|line| !line.is_empty());
    let widths = [1, 1, 3, 3, 3, 3, 4, 4, 4, 4];
    widths.into_iter().all(|width| {
        lines.next().is_some_and(|line| {
            words(line).count() == width && words(line).all(|word| number(word).is_some())
        })
    })
}

/// A scan.
struct Scan {
    left: u64,
    matrix: [[f64; 4]; 4],
    /// Values a point, once one has been.
    width: usize,
}

/// Reads the points.
#[derive(Default)]
pub(super) struct Ptx {
    keep: bool,
    header: Vec<Vec<f64>>,
    scan: Option<Scan>,
    values: Vec<f64>,
}

impl Ptx {
    pub(super) fn new(options: &ReadOptions) -> Ptx {
        Ptx {
            keep: options.keep_sentinels,
            ..Ptx::default()
        }
    }
}

impl Parser for Ptx {
    fn parse(&mut self, input: &mut Input, table: &mut Option<Table>) -> Result<Step> {
        while let Some(line) = input.line()? {
            if line.trim_ascii().is_empty() {
                continue;
            }
            self.values.clear();
            for word in words(line) {
                let value = number(word).ok_or_else(|| input.bad_line("a number", word))?;
                self.values.push(value);
            }
            match &mut self.scan {
                Some(scan) => {
                    point(scan, &self.values, self.keep, line, input, table)?;
                    if scan.left == 0 {
                        self.scan = None;
                    }
                }
                None => self.header(line, input, table)?,
            }
        }
        if !input.last {
            return Ok(Step::More);
        }
        match &self.scan {
            Some(scan) => {
                let found = format!("the end of the file, with {} points to come", scan.left);
                Err(input.bad_at_line(input.place.line, "the points of a scan", found))
            }
            None if !self.header.is_empty() || table.is_none() => {
                Err(input.no_line("the head of a scan: counts, place, axes and a matrix"))
            }
            None => Ok(Step::Done),
        }
    }
}

impl Ptx {
    fn header(&mut self, line: &[u8], input: &Input, table: &mut Option<Table>) -> Result<()> {
        let expected = match self.header.len() {
            0 => (1, "the count of a scan's columns"),
            1 => (1, "the count of a scan's rows"),
            2 => (3, "the scanner's place"),
            3..=5 => (3, "an axis of the scanner"),
            _ => (4, "a row of a scan's matrix"),
        };
        let finite = self.values.iter().all(|value| value.is_finite());
        if self.values.len() != expected.0 || !finite {
            return Err(input.bad_line(expected.1, line));
        }
        self.header.push(self.values.clone());
        if self.header.len() < HEADER {
            return Ok(());
        }
        let header = std::mem::take(&mut self.header);
        let counts = [header[0][0], header[1][0]];
        if counts
            .iter()
            .any(|c| *c < 0.0 || c.fract() != 0.0 || *c > f64::from(u32::MAX))
        {
            return Err(input.bad_line("whole counts of columns and rows before the matrix", line));
        }
        let left = counts[0] as u64 * counts[1] as u64;
        let mut matrix = [[0.0; 4]; 4];
        for (row, values) in matrix.iter_mut().zip(&header[6..]) {
            row.copy_from_slice(values);
        }
        let table = table.get_or_insert_with(|| {
            let mut table = Table::new(columns(), None);
            table.colors_said = false;
            table
        });
        let [x, y, z, _] = matrix[3];
        table.seen_from(Some([x, y, z]));
        self.scan = (left > 0).then_some(Scan {
            left,
            matrix,
            width: 0,
        });
        Ok(())
    }
}

fn point(
    scan: &mut Scan,
    values: &[f64],
    keep: bool,
    line: &[u8],
    input: &Input,
    table: &mut Option<Table>,
) -> Result<()> {
    if scan.width == 0 {
        scan.width = values.len();
    }
    let width = scan.width;
    if values.len() != width || ![3, 4, 6, 7].contains(&width) {
        let expected = "x y z, an intensity, and a colour where all of the scan have one";
        return Err(input.bad_line(expected, line));
    }
    scan.left -= 1;
    let Some(table) = table else {
        return Ok(());
    };
    let local = [values[0], values[1], values[2]];
    if local == [0.0; 3] && !keep {
        table.no_returns += 1;
        return Ok(());
    }
    let m = &scan.matrix;
    let at = |axis: usize| {
        local[0] * m[0][axis] + local[1] * m[1][axis] + local[2] * m[2][axis] + m[3][axis]
    };
    let intensity = if [4, 7].contains(&width) {
        values[3]
    } else {
        0.0
    };
    let color = match width {
        6 | 7 => [values[width - 3], values[width - 2], values[width - 1]],
        _ => [f64::from(WHITE); 3],
    };
    table.colors_said |= width > 4;
    table.push(&[at(0), at(1), at(2), color[0], color[1], color[2], intensity]);
    Ok(())
}

fn columns() -> Columns {
    Columns {
        color: Some([3, 4, 5]),
        colors: ColorRange::Integers,
        scalars: vec![(6, "intensity".into())],
        optional_from: 0,
        ..Columns::xyz()
    }
}
