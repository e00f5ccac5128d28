//! Rows of named numbers become the arrays of a [`RawCloud`], all at once or block by block.

use super::block::{Block, ColorValues, Verdict};
use super::colors::{ColorRange, Tally};
use super::raw_cloud::{Positions, RawCloud};
use super::sentinels::{LeftOut, Sentinels};
use super::stations::Stations;
use crate::cloud::Attribute;

/// Which columns of a row hold what.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Columns {
    pub(super) position: [usize; 3],
    pub(super) normal: Option<[usize; 3]>,
    pub(super) color: Option<[usize; 3]>,
    /// Column and name of every other scalar.
    pub(super) scalars: Vec<(usize, String)>,
    /// The first of the scalars that a file need not use: where all of its values are 0, it is none.
    pub(super) optional_from: usize,
    pub(super) colors: ColorRange,
    pub(super) precision: Precision,
}

/// In what positions are kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Precision {
    /// Single: the file has no more.
    Single,
    /// Double, whatever the values are.
    Double,
    /// Double, and single in the end where that moves no coordinate by more than 2⁻²² of the diagonal.
    AsNeeded,
}

/// Spellings of the known columns, lower case.
const POSITION: [[&str; 3]; 1] = [["x", "y", "z"]];
const NORMAL: [[&str; 3]; 4] = [
    ["nx", "ny", "nz"],
    ["normal_x", "normal_y", "normal_z"],
    ["normalx", "normaly", "normalz"],
    ["normal x", "normal y", "normal z"],
];
const COLOR: [[&str; 3]; 4] = [
    ["red", "green", "blue"],
    ["r", "g", "b"],
    ["diffuse_red", "diffuse_green", "diffuse_blue"],
    ["rf", "gf", "bf"],
];

impl Columns {
    /// Columns by their names, case ignored; `None` where x, y or z is missing.
    pub(super) fn from_names(names: &[String]) -> Option<Columns> {
        let lower: Vec<String> = names.iter().map(|name| name.to_lowercase()).collect();
        let find = |spellings: &[[&str; 3]]| {
            spellings.iter().find_map(|triple| {
                let at = triple.map(|wanted| lower.iter().position(|name| name == wanted));
                Some([at[0]?, at[1]?, at[2]?])
            })
        };
        let position = find(&POSITION)?;
        let normal = find(&NORMAL);
        let color = find(&COLOR);
        let known: Vec<usize> = [Some(position), normal, color]
            .into_iter()
            .flatten()
            .flatten()
            .collect();
        let scalars = names
            .iter()
            .enumerate()
            .filter(|(column, _)| !known.contains(column))
            .map(|(column, name)| (column, name.clone()))
            .collect();
        Some(Columns {
            position,
            normal,
            color,
            scalars,
            ..Columns::xyz()
        })
    }

    /// Three columns, and nothing but x, y and z in them.
    pub(super) fn xyz() -> Columns {
        Columns {
            position: [0, 1, 2],
            normal: None,
            color: None,
            scalars: Vec::new(),
            optional_from: usize::MAX,
            colors: ColorRange::Guess,
            precision: Precision::AsNeeded,
        }
    }
}

/// Collects rows.
pub(super) struct Table {
    columns: Columns,
    /// No more rows than these can come.
    pub(super) most_rows: Option<u64>,
    block: Block,
    pub(super) rows: u64,
    pub(super) sentinels: Sentinels,
    tally: Tally,
    /// Which of the scalars had a value that is not 0, or need none.
    used: Vec<bool>,
    /// A normal was not zero.
    normals_used: bool,
    /// All rows lie within 45° of the z axis from the origin.
    pub(super) before_camera: bool,
    /// Where the format has colours that a file need not use: some do.
    pub(super) colors_said: bool,
    pub(super) normals_said: bool,
    /// Where the rows were seen from.
    pub(super) stations: Stations,
    /// Rows left out because a coordinate is not finite.
    pub(super) dropped: usize,
    /// Rows left out because the file marks them as invalid.
    pub(super) invalid: usize,
    /// Rows left out because the file says that they have no height, or no return.
    pub(super) no_data: u64,
    pub(super) no_returns: u64,
    pub(super) replaced: usize,
    /// Which rows were left out, counted with all others, where faces ask for it.
    pub(super) gone: Option<Vec<u32>>,
}

impl Table {
    /// An empty table; `most_rows` is how many rows the file's bytes can hold, where that is known.
    pub(super) fn new(columns: Columns, most_rows: Option<u64>) -> Table {
        Table {
            block: columns.empty_block(),
            used: (0..columns.scalars.len())
                .map(|scalar| scalar < columns.optional_from)
                .collect(),
            columns,
            most_rows,
            rows: 0,
            sentinels: Sentinels::default(),
            tally: Tally::default(),
            normals_used: false,
            before_camera: true,
            colors_said: true,
            normals_said: true,
            stations: Stations::default(),
            dropped: 0,
            gone: None,
            invalid: 0,
            no_data: 0,
            no_returns: 0,
            replaced: 0,
        }
    }

    /// A table of a cloud's points.
    pub(super) fn of(cloud: RawCloud) -> Table {
        let attributes = cloud.attributes.iter().enumerate();
        let columns = Columns {
            normal: cloud.normals.as_ref().map(|_| [3, 4, 5]),
            color: cloud.colors.as_ref().map(|_| [6, 7, 8]),
            scalars: attributes.map(|(i, a)| (9 + i, a.name.clone())).collect(),
            colors: ColorRange::Bytes,
            precision: match cloud.positions {
                Positions::F32(_) => Precision::Single,
                Positions::F64(_) => Precision::Double,
            },
            ..Columns::xyz()
        };
        let rows = cloud.points() as u64;
        let mut table = Table::new(columns, Some(rows));
        table.rows = rows;
        table.normals_used = true;
        for row in 0..cloud.points() {
            let position = [0, 1, 2].map(|axis| cloud.positions.get(3 * row + axis));
            table.sentinels.add(position);
        }
        table.block = Block {
            positions: cloud.positions,
            normals: cloud.normals,
            colors: cloud.colors.map(ColorValues::Bytes),
            attributes: cloud.attributes,
        };
        table
    }

    /// Rows so far, with those that were left out.
    pub(super) fn next_row(&self) -> u64 {
        self.rows + self.dropped as u64
    }

    /// The coordinates of a row, where none was left out and no block was taken.
    pub(super) fn position(&self, row: u32) -> Option<[f64; 3]> {
        let row = row as usize;
        let is_there = self.dropped == 0 && row < self.block.positions.len() / 3;
        is_there.then(|| [0, 1, 2].map(|axis| self.block.positions.get(3 * row + axis)))
    }

    /// Adds a row; one with a coordinate that is not finite is counted and left out.
    pub(super) fn push(&mut self, row: &[f64]) {
        let position = self.columns.position.map(|column| row[column]);
        if position.iter().any(|x| !x.is_finite()) {
            let row = self.next_row();
            if let Some(gone) = &mut self.gone {
                gone.push(row as u32);
            }
            self.dropped += 1;
            return;
        }
        self.rows += 1;
        let [x, y, z] = position;
        self.before_camera &= x.abs() < z && y.abs() < z;
        match &mut self.block.positions {
            Positions::F32(values) => values.extend(position.map(|x| x as f32)),
            Positions::F64(values) => values.extend(position),
        }
        self.sentinels.add(position);
        let row_of_block = self.block.positions.len() / 3;
        let replaced = &mut self.replaced;
        let mut finite = |column: usize| {
            let value = row[column] as f32;
            if value.is_finite() {
                value
            } else {
                *replaced += 1;
                0.0
            }
        };
        if let (Some(normal), Some(normals)) = (self.columns.normal, &mut self.block.normals) {
            let normal = normal.map(&mut finite);
            self.normals_used |= normal != [0.0; 3];
            normals.extend(normal);
        }
        if let (Some(color), Some(colors)) = (self.columns.color, &mut self.block.colors) {
            let range = self.columns.colors;
            let color = color.map(|column| range.kept(finite(column)));
            match colors {
                ColorValues::Bytes(bytes) => bytes.extend(color.map(|c| c as u8)),
                ColorValues::Numbers(numbers) => {
                    color.iter().for_each(|value| self.tally.add(*value));
                    numbers.extend(color);
                }
            }
        }
        let scalars = self.columns.scalars.iter().zip(&mut self.used);
        for (attribute, ((column, _), used)) in self.block.attributes.iter_mut().zip(scalars) {
            let value = finite(*column);
            if !*used && value != 0.0 {
                *used = true;
                attribute.values.resize(row_of_block - 1, 0.0);
            }
            if *used {
                attribute.values.push(value);
            }
        }
    }

    /// Adds a normal that the file has apart from the rows; the columns name none.
    pub(super) fn push_normal(&mut self, normal: [f32; 3]) {
        self.normals_used |= normal != [0.0; 3];
        self.block.normals.get_or_insert_default().extend(normal);
    }

    /// The rows from here on were seen from `position`; `None` where the file does not tell.
    pub(super) fn seen_from(&mut self, position: Option<[f64; 3]>) {
        self.stations.begin(self.rows, position);
        if let Some(position) = position {
            self.sentinels.seen_from(position);
        }
    }

    /// The rows since the last block.
    pub(super) fn take_block(&mut self) -> Block {
        let mut block = std::mem::replace(&mut self.block, self.columns.empty_block());
        let mut used = self.used.iter();
        block.attributes.retain(|_| used.next() == Some(&true));
        block
    }

    /// After the last row; `keep` leaves nothing out.
    pub(super) fn verdict(&self, keep: bool) -> Verdict {
        let left_out = if keep {
            LeftOut::default()
        } else {
            self.sentinels.verdict()
        };
        let span = self.sentinels.span(&left_out);
        let extent = [0, 1, 2].map(|axis| span.high[axis] - span.low[axis]);
        let diagonal =
            (extent[0] * extent[0] + extent[1] * extent[1] + extent[2] * extent[2]).sqrt();
        let allowed = diagonal / f64::from(1 << 22);
        let suffices = span.rounding.is_finite() && (self.rows == 0 || span.rounding <= allowed);
        let scalars = self.columns.scalars.iter().zip(&self.used);
        Verdict {
            narrow: self.columns.precision == Precision::AsNeeded && suffices,
            color_scale: self.tally.scale(self.columns.colors),
            has_colors: self.colors_said,
            has_normals: self.normals_said && (self.normals_used || self.rows == 0),
            left_out,
            attributes: scalars
                .filter(|(_, used)| **used)
                .map(|((_, name), _)| name.clone())
                .collect(),
        }
    }

    /// Rows that were left out, by why; `later` had no data, or no return, as the end told.
    pub(super) fn skipped(&self, later: [u64; 2]) -> Vec<(&'static str, u64)> {
        let counts = [
            ("not-finite", self.dropped as u64),
            ("invalid", self.invalid as u64),
            ("no-data", self.no_data + later[0]),
            ("no-return", self.no_returns + later[1]),
        ];
        counts.into_iter().filter(|(_, count)| *count > 0).collect()
    }

    /// The arrays of all rows, where no block was taken.
    pub(super) fn finish(mut self, keep: bool) -> RawCloud {
        let verdict = self.verdict(keep);
        let mut block = self.take_block();
        let mut viewpoints = self.stations.viewpoints(self.rows as usize);
        let [no_data, no_return] = block.leave_out(&verdict.left_out, &mut viewpoints);
        let Block {
            positions,
            normals,
            colors,
            attributes,
        } = block;
        let positions = match positions {
            Positions::F64(values) if verdict.narrow => {
                Positions::F32(values.into_iter().map(|x| x as f32).collect())
            }
            as_they_are => as_they_are,
        };
        let mut cloud = RawCloud::new(positions);
        cloud.normals = normals.filter(|_| verdict.has_normals);
        cloud.colors = colors
            .filter(|_| verdict.has_colors)
            .map(|colors| match colors {
                ColorValues::Bytes(bytes) => bytes,
                // The cast saturates: values below 0 and above 255 are clamped.
                ColorValues::Numbers(numbers) => numbers
                    .into_iter()
                    .map(|c| (c * verdict.color_scale).round() as u8)
                    .collect(),
            });
        cloud.attributes = attributes;
        cloud.dropped = self.dropped + self.invalid;
        cloud.skipped = self.skipped([no_data, no_return]);
        cloud.viewpoints = viewpoints;
        cloud.replaced = self.replaced;
        cloud
    }
}

impl Columns {
    fn empty_block(&self) -> Block {
        let attribute = |(_, name): &(usize, String)| Attribute {
            name: name.clone(),
            values: Vec::new(),
        };
        Block {
            positions: match self.precision {
                Precision::Single => Positions::F32(Vec::new()),
                _ => Positions::F64(Vec::new()),
            },
            normals: self.normal.map(|_| Vec::new()),
            colors: self.color.map(|_| match self.colors {
                ColorRange::Bytes => ColorValues::Bytes(Vec::new()),
                _ => ColorValues::Numbers(Vec::new()),
            }),
            attributes: self.scalars.iter().map(attribute).collect(),
        }
    }
}
