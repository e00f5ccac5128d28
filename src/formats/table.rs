//! Rows of named numbers become the arrays of a [`RawCloud`].

use super::{Positions, RawCloud};
use crate::cloud::Attribute;

/// Which columns of a row hold what.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Columns {
    pub(super) position: [usize; 3],
    pub(super) normal: Option<[usize; 3]>,
    pub(super) color: Option<[usize; 3]>,
    /// Column and name of every other scalar.
    pub(super) scalars: Vec<(usize, String)>,
    /// The colours are declared as 8-bit integers: 1 means 1 of 255.
    pub(super) color_is_bytes: bool,
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
            color_is_bytes: false,
        })
    }
}

/// Collects rows.
pub(super) struct Table {
    columns: Columns,
    positions: Vec<f64>,
    normals: Vec<f32>,
    colors: Vec<f32>,
    scalars: Vec<Vec<f32>>,
    dropped: usize,
    replaced: usize,
}

impl Table {
    /// An empty table; `rows` is how many rows the bytes can hold at most.
    pub(super) fn new(columns: Columns, rows: usize) -> Table {
        let triples = |wanted: bool| Vec::with_capacity(if wanted { 3 * rows } else { 0 });
        Table {
            positions: Vec::with_capacity(3 * rows),
            normals: triples(columns.normal.is_some()),
            colors: triples(columns.color.is_some()),
            scalars: columns
                .scalars
                .iter()
                .map(|_| Vec::with_capacity(rows))
                .collect(),
            dropped: 0,
            replaced: 0,
            columns,
        }
    }

    /// Adds a row; one with a coordinate that is not finite is counted and left out.
    pub(super) fn push(&mut self, row: &[f64]) {
        let position = self.columns.position.map(|column| row[column]);
        if position.iter().any(|x| !x.is_finite()) {
            self.dropped += 1;
            return;
        }
        self.positions.extend(position);
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
        if let Some(normal) = self.columns.normal {
            self.normals.extend(normal.map(&mut finite));
        }
        if let Some(color) = self.columns.color {
            self.colors.extend(color.map(&mut finite));
        }
        for (values, (column, _)) in self.scalars.iter_mut().zip(&self.columns.scalars) {
            values.push(finite(*column));
        }
    }

    /// The arrays.
    pub(super) fn finish(self) -> RawCloud {
        let Columns {
            normal,
            color,
            scalars,
            color_is_bytes,
            ..
        } = self.columns;
        let mut cloud = RawCloud::new(narrowed(self.positions));
        cloud.normals = normal.map(|_| self.normals);
        cloud.colors = color.map(|_| to_bytes(&self.colors, color_is_bytes));
        cloud.attributes = scalars
            .into_iter()
            .zip(self.scalars)
            .map(|((_, name), values)| Attribute { name, values })
            .collect();
        cloud.dropped = self.dropped;
        cloud.replaced = self.replaced;
        cloud
    }
}

/// Single precision where it moves no coordinate by more than 2⁻²² of the diagonal.
fn narrowed(positions: Vec<f64>) -> Positions {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for point in positions.chunks_exact(3) {
        for axis in 0..3 {
            low[axis] = low[axis].min(point[axis]);
            high[axis] = high[axis].max(point[axis]);
        }
    }
    let extent = [0, 1, 2].map(|axis| high[axis] - low[axis]);
    let diagonal = (extent[0] * extent[0] + extent[1] * extent[1] + extent[2] * extent[2]).sqrt();
    let allowed = diagonal / f64::from(1 << 22);
    let suffices = |&x: &f64| {
        let rounded = x as f32;
        rounded.is_finite() && (f64::from(rounded) - x).abs() <= allowed
    };
    if positions.iter().all(suffices) {
        Positions::F32(positions.into_iter().map(|x| x as f32).collect())
    } else {
        Positions::F64(positions)
    }
}

/// Colours as bytes. Unless they are bytes already, values that are all at most 1 run from 0 to 1, and values above
/// 255 make the range 16 bits.
fn to_bytes(colors: &[f32], are_bytes: bool) -> Vec<u8> {
    let most = colors.iter().copied().fold(0.0, f32::max);
    let scale = if are_bytes {
        1.0
    } else if most <= 1.0 {
        255.0
    } else if most > 255.0 {
        1.0 / 257.0
    } else {
        1.0
    };
    // The cast saturates: values below 0 and above 255 are clamped.
    colors.iter().map(|&c| (c * scale).round() as u8).collect()
}
