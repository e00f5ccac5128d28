//! Rows of named numbers become the arrays of a [`RawCloud`], all at once or block by block.

use super::{Positions, RawCloud, Stations};
use crate::cloud::Attribute;

/// Which columns of a row hold what.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Columns {
    pub(super) position: [usize; 3],
    pub(super) normal: Option<[usize; 3]>,
    pub(super) color: Option<[usize; 3]>,
    /// Column and name of every other scalar.
    pub(super) scalars: Vec<(usize, String)>,
    pub(super) colors: ColorRange,
    pub(super) precision: Precision,
}

/// What the values of colours run to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ColorRange {
    /// 8-bit integers: 1 means 1 of 255.
    Bytes,
    /// 1.
    Unit,
    /// Integers: 255, or 65,535 where one of them is larger.
    Integers,
    /// The values tell: 1 where all are at most 1, else 255, or 65,535 where one is larger.
    Guess,
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
            colors: ColorRange::Guess,
            precision: Precision::AsNeeded,
        })
    }
}

/// Rows as arrays of one type each: all of a file's, or those that came since the last block.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// Coordinates.
    pub positions: Positions,
    /// `x y z` a point.
    pub normals: Option<Vec<f32>>,
    /// `r g b` a point.
    pub colors: Option<ColorValues>,
    /// Other scalars, one value a point.
    pub attributes: Vec<Attribute>,
}

/// Colours as a file has them.
#[derive(Debug, Clone, PartialEq)]
pub enum ColorValues {
    /// 0-255.
    Bytes(Vec<u8>),
    /// To be multiplied by [`Verdict::color_scale`].
    Numbers(Vec<f32>),
}

/// What only the whole file tells about its blocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Verdict {
    /// Single precision suffices for the positions, which came in double.
    pub narrow: bool,
    /// From [`ColorValues::Numbers`] to 0-255.
    pub color_scale: f32,
    /// The colours say something.
    pub has_colors: bool,
    /// The normals belong to the points.
    pub has_normals: bool,
}

/// Collects rows.
pub(super) struct Table {
    columns: Columns,
    /// No more rows than these can come.
    pub(super) most_rows: Option<u64>,
    block: Block,
    pub(super) rows: u64,
    low: [f64; 3],
    high: [f64; 3],
    /// The most that rounding to single precision moves a coordinate.
    rounding: f64,
    /// The largest value of a colour.
    brightest: f32,
    /// Where the format has colours that a file need not use: some do.
    pub(super) colors_said: bool,
    pub(super) normals_said: bool,
    pub(super) stations: Stations,
    pub(super) dropped: usize,
    replaced: usize,
}

impl Table {
    /// An empty table; `most_rows` is how many rows the file's bytes can hold, where that is known.
    pub(super) fn new(columns: Columns, most_rows: Option<u64>) -> Table {
        Table {
            block: columns.empty_block(),
            columns,
            most_rows,
            rows: 0,
            low: [f64::INFINITY; 3],
            high: [f64::NEG_INFINITY; 3],
            rounding: 0.0,
            brightest: 0.0,
            colors_said: true,
            normals_said: true,
            stations: Stations::default(),
            dropped: 0,
            replaced: 0,
        }
    }

    /// Adds a row; one with a coordinate that is not finite is counted and left out.
    pub(super) fn push(&mut self, row: &[f64]) {
        let position = self.columns.position.map(|column| row[column]);
        if position.iter().any(|x| !x.is_finite()) {
            self.dropped += 1;
            return;
        }
        self.rows += 1;
        match &mut self.block.positions {
            Positions::F32(values) => values.extend(position.map(|x| x as f32)),
            Positions::F64(values) => {
                values.extend(position);
                for (axis, x) in position.into_iter().enumerate() {
                    self.low[axis] = self.low[axis].min(x);
                    self.high[axis] = self.high[axis].max(x);
                    self.rounding = self.rounding.max((f64::from(x as f32) - x).abs());
                }
            }
        }
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
            normals.extend(normal.map(&mut finite));
        }
        if let (Some(color), Some(colors)) = (self.columns.color, &mut self.block.colors) {
            let color = color.map(&mut finite);
            match colors {
                ColorValues::Bytes(bytes) => bytes.extend(color.map(|c| c as u8)),
                ColorValues::Numbers(numbers) => {
                    self.brightest = color.into_iter().fold(self.brightest, f32::max);
                    numbers.extend(color);
                }
            }
        }
        for (attribute, (column, _)) in self.block.attributes.iter_mut().zip(&self.columns.scalars)
        {
            attribute.values.push(finite(*column));
        }
    }

    /// Adds a normal that the file has apart from the rows; the columns name none.
    pub(super) fn push_normal(&mut self, normal: [f32; 3]) {
        self.block.normals.get_or_insert_default().extend(normal);
    }

    /// The rows from here on were seen from `position`; `None` where the file does not tell.
    pub(super) fn seen_from(&mut self, position: Option<[f64; 3]>) {
        self.stations.begin(self.rows, position);
    }

    /// The rows since the last block.
    pub(super) fn take_block(&mut self) -> Block {
        std::mem::replace(&mut self.block, self.columns.empty_block())
    }

    /// After the last row.
    pub(super) fn verdict(&self) -> Verdict {
        let extent = [0, 1, 2].map(|axis| self.high[axis] - self.low[axis]);
        let diagonal =
            (extent[0] * extent[0] + extent[1] * extent[1] + extent[2] * extent[2]).sqrt();
        let allowed = diagonal / f64::from(1 << 22);
        let suffices = self.rounding.is_finite() && (self.rows == 0 || self.rounding <= allowed);
        Verdict {
            narrow: self.columns.precision == Precision::AsNeeded && suffices,
            color_scale: match self.columns.colors {
                ColorRange::Unit => 255.0,
                ColorRange::Guess if self.brightest <= 1.0 => 255.0,
                _ if self.brightest > 255.0 => 1.0 / 257.0,
                _ => 1.0,
            },
            has_colors: self.colors_said,
            has_normals: self.normals_said,
        }
    }

    /// Values of colours, normals and attributes that were not finite and are now 0.
    pub(super) fn replaced(&self) -> usize {
        self.replaced
    }

    /// The arrays of all rows, where no block was taken.
    pub(super) fn finish(mut self) -> RawCloud {
        let verdict = self.verdict();
        let Block {
            positions,
            normals,
            colors,
            attributes,
        } = self.take_block();
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
        cloud.viewpoints = self.stations.viewpoints(cloud.points());
        cloud.dropped = self.dropped;
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
