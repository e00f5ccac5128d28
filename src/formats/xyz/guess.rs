//! What the columns of rows without names are, by their values.

/// The first rows, column by column.
#[derive(Default)]
pub(super) struct Column {
    /// NaN where there is no number.
    pub(super) values: Vec<f64>,
    pub(super) texts: usize,
    pub(super) empty: usize,
    pub(super) hexes: usize,
    /// Values that are a colour, as text says it.
    pub(super) colors: usize,
    /// Values with a decimal mark or an exponent.
    pub(super) fractions: usize,
}

impl Column {
    /// Whether it holds numbers, or colours.
    pub(super) fn is_numeric(&self) -> bool {
        let said = self.values.len() - self.empty;
        said > 0 && 2 * self.texts <= said
    }

    fn all(&self, holds: impl Fn(f64) -> bool) -> bool {
        self.values
            .iter()
            .all(|&value| value.is_nan() || holds(value))
    }

    fn is_whole(&self) -> bool {
        self.fractions == 0 && self.all(|value| value.fract() == 0.0)
    }

    fn most(&self) -> f64 {
        self.values
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max)
    }

    fn distinct(&self) -> usize {
        let mut sorted = self.values.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        sorted.dedup();
        sorted.len()
    }

    /// A running number, or a number that names the point: whole, and each another.
    fn is_index(&self, next: &[&Column]) -> bool {
        const ENOUGH: usize = 8;
        if self.values.len() < ENOUGH || !self.is_whole() || self.values.iter().any(|v| v.is_nan())
        {
            return false;
        }
        let runs = self.values.windows(2).all(|pair| pair[1] - pair[0] == 1.0);
        let measured = next
            .iter()
            .all(|column| 2 * column.fractions >= column.values.len());
        runs || (measured && self.distinct() == self.values.len())
    }

    /// Seconds of a clock: they grow, and no coordinate is as large.
    fn is_time(&self) -> bool {
        const LEAST: f64 = 1e8;
        self.values.len() > 2 && self.rises() && self.values[0] >= LEAST
    }

    fn rises(&self) -> bool {
        self.values.windows(2).all(|pair| pair[0] <= pair[1])
    }

    /// Colours as text.
    pub(super) fn is_written_color(&self) -> bool {
        self.texts > 0 && 2 * self.colors > self.values.len() - self.empty
    }

    /// A packed colour whose bits were taken for a number: one of less than 2⁻¹²⁵.
    pub(super) fn has_color_bits(&self) -> bool {
        const MOST: f64 = 2.36e-38;
        self.all(|v| (0.0..MOST).contains(&v)) && self.values.iter().any(|v| *v > 0.0)
    }

    /// A packed colour: `0xRRGGBB` or `0xAARRGGBB`, which may have a sign.
    pub(super) fn is_packed(&self) -> bool {
        let range = -2_147_483_648.0..=4_294_967_295.0;
        let sorted = self.values.windows(2).all(|pair| pair[0] <= pair[1])
            || self.values.windows(2).all(|pair| pair[0] >= pair[1]);
        let large = self.values.iter().any(|v| v.abs() > 65_535.0);
        2 * self.hexes > self.values.len()
            || self.is_written_color()
            || self.has_color_bits()
            || (self.all(|v| v.fract() == 0.0 && range.contains(&v)) && large && !sorted)
    }
}

/// What the columns are, and whether they could be something else.
pub(super) struct Guess {
    pub(super) roles: Vec<String>,
    pub(super) weak: bool,
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
    fn names(self) -> &'static [&'static str] {
        match self {
            Field::Intensity => &["intensity"],
            Field::Color => &["red", "green", "blue"],
            Field::Normal => &["nx", "ny", "nz"],
        }
    }

    /// Whether the columns look like it.
    fn fits(self, columns: &[&Column]) -> bool {
        match self {
            Field::Intensity => true,
            Field::Normal => is_unit(columns),
            Field::Color => is_color(columns),
        }
    }
}

/// Vectors of length 1, within 5 %.
pub(super) fn is_unit(columns: &[&Column]) -> bool {
    (0..columns[0].values.len()).all(|row| {
        let [x, y, z] = [0, 1, 2].map(|axis| columns[axis].values[row]);
        ((x * x + y * y + z * z).sqrt() - 1.0).abs() <= 0.05
    })
}

/// Whole numbers to 255, or, each of the three columns beyond it, to 65,535; or numbers from 0 to 1.
fn is_color(columns: &[&Column]) -> bool {
    let all = |holds: fn(f64) -> bool| columns.iter().all(|column| column.all(holds));
    let whole = |most: f64| {
        columns
            .iter()
            .all(|column| column.all(|v| v.fract() == 0.0 && (0.0..=most).contains(&v)))
    };
    whole(255.0)
        || (whole(65_535.0) && columns.iter().all(|column| column.most() > 255.0))
        || all(|v| (0.0..=1.0).contains(&v))
}

/// The columns of rows without names; `counted` where the file says how many rows follow, as PTS does.
pub(super) fn guess(columns: &[Column], counted: bool) -> Guess {
    let numeric: Vec<usize> = (0..columns.len())
        .filter(|&i| columns[i].is_numeric())
        .collect();
    let of = |places: &[usize]| -> Vec<&Column> { places.iter().map(|&i| &columns[i]).collect() };
    let mut roles: Vec<String> = vec!["-".into(); columns.len()];
    let first = &columns[*numeric.first().unwrap_or(&0)];
    let index = numeric.len() >= 4 && (first.is_index(&of(&numeric[1..4])) || first.is_time());
    // What grows from row to row may be a time.
    let may_be_time = numeric.len() >= 4
        && !index
        && first.values.len() > 8
        && first.distinct() == first.values.len()
        && first.rises();
    let numeric = &numeric[usize::from(index)..];
    let (place, rest) = numeric.split_at(numeric.len().min(3));
    let mut name = |places: &[usize], names: &[&str]| {
        let named = places.iter().zip(names);
        named.for_each(|(&i, name)| roles[i] = name.to_string());
    };
    name(place, &["x", "y", "z"]);

    let intensity_first: &[Field] = &[Field::Intensity, Field::Color];
    let preferred = Some(intensity_first).filter(|_| counted);
    let fits = |layout: &&[Field]| {
        let mut start = 0;
        let total: usize = layout.iter().map(|field| field.names().len()).sum();
        rest.len() == total
            && layout.iter().all(|field| {
                let here = start;
                start += field.names().len();
                field.fits(&of(&rest[here..start]))
            })
    };
    let mut fitting = preferred.into_iter().chain(LAYOUTS).filter(fits);
    let layout = fitting.next();
    let others = fitting.any(|other| Some(other) != layout);
    let packed = rest.iter().copied().find(|&i| columns[i].is_packed());
    let written =
        (place.last().map_or(0, |z| z + 1)..columns.len()).find(|&i| columns[i].is_written_color());
    let packed = packed.or(written);
    let mut weak = index || may_be_time || others;
    if let Some(at) = packed.filter(|_| layout.is_none_or(|layout| layout == [Field::Intensity])) {
        name(&[at], &["rgb"]);
    } else if let Some(layout) = layout {
        let mut start = 0;
        for field in layout {
            name(&rest[start..], field.names());
            start += field.names().len();
        }
        // Three columns with a handful of values are colours, or classes.
        weak |= layout.contains(&Field::Color) && !rest.iter().any(|&i| columns[i].distinct() > 8);
    } else {
        weak |= !rest.is_empty();
        let normal = rest.windows(3).position(|triple| is_unit(&of(triple)));
        if let Some(at) = normal {
            name(&rest[at..at + 3], Field::Normal.names());
        }
        if let Some(at) = best_color(rest, columns, normal) {
            name(&rest[at..at + 3], Field::Color.names());
        }
    }
    for &i in rest {
        if roles[i] == "-" {
            roles[i] = format!("column{}", i + 1);
        }
    }
    Guess { roles, weak }
}

/// Where among many columns the three are that are most likely a colour: they have many values, which are alike.
fn best_color(rest: &[usize], columns: &[Column], normal: Option<usize>) -> Option<usize> {
    if rest.len() < 4 {
        return None;
    }
    let mut best: Option<(f64, usize)> = None;
    for (at, triple) in rest.windows(3).enumerate() {
        let apart = normal.is_none_or(|normal| at + 3 <= normal || at >= normal + 3);
        let channels: Vec<&Column> = triple.iter().map(|&i| &columns[i]).collect();
        if !apart || !is_color(&channels) {
            continue;
        }
        let values = channels
            .iter()
            .map(|column| column.distinct())
            .min()
            .unwrap_or(0);
        if values < 3 {
            continue;
        }
        let rows = channels[0].values.len();
        let most = channels
            .iter()
            .map(|column| column.most())
            .fold(1e-9, f64::max);
        let apart: f64 = (0..rows)
            .map(|row| {
                let [r, g, b] = [0, 1, 2].map(|i| channels[i].values[row]);
                (r - g).abs() + (g - b).abs()
            })
            .filter(|apart| apart.is_finite())
            .sum();
        let likeness = values as f64 / rows as f64 - apart / (most * rows as f64);
        if best.is_none_or(|(most, _)| likeness > most) {
            best = Some((likeness, at));
        }
    }
    best.map(|(_, at)| at)
}

/// Whether rows are those of COLMAP's points: number, place, colour, error, then pairs of numbers, as many as
/// images see the point.
pub(super) fn is_colmap(rows: &[Vec<f64>]) -> bool {
    let whole = |value: &f64| *value >= 0.0 && value.fract() == 0.0;
    let point = |row: &Vec<f64>| {
        row.len() >= 10
            && row.len().is_multiple_of(2)
            && whole(&row[0])
            && row[4..7].iter().all(|v| whole(v) && *v <= 255.0)
            && row[7] >= 0.0
            && row[8..].iter().all(whole)
    };
    rows.len() > 1
        && rows.iter().all(point)
        && rows
            .iter()
            .any(|row| row[1..4].iter().any(|v| v.fract() != 0.0))
}
