//! LAS 1.4 and LAZ by the crate `las`, point formats 6 to 8: world coordinates in steps of a power of ten finer than 2⁻²³ of the
//! diagonal; colours of 16 bits; attributes in the fields of their names where those hold their values, and else, with the
//! normals, as extra bytes in single precision, `NAME (float)` where a field has their name; the reference system as the file had
//! it that the cloud was read from.

use super::values::world;
use crate::base::error::{Error, Result};
use crate::cloud::{Attribute, Crs};
use crate::formats::las_names::{FIELDS, FLOAT};
use crate::formats::raw_cloud::RawCloud;
use ::las::point::{Classification, Format, Point, ScanDirection};
use ::las::{Builder, Color, Transform, Vector, Vlr, Writer, raw};
use std::io::Cursor;

/// Writes points, `packed` by LASzip.
///
/// # Errors
/// [`Error::EmptyCloud`]; [`Error::NonFinite`]; [`Error::BadLength`] for more extra bytes than a file describes.
pub(super) fn write(cloud: &RawCloud, packed: bool) -> Result<Vec<u8>> {
    let points = cloud.points();
    if points == 0 {
        return Err(Error::EmptyCloud);
    }
    let (fields, extra): (Vec<_>, Vec<_>) = columns(cloud)
        .into_iter()
        .partition(|column| column.field.is_some());
    if extra.len() > MOST_EXTRA {
        return Err(Error::BadLength {
            array: "attributes".into(),
            expected: format!("at most {MOST_EXTRA} that are no fields of LAS"),
            found: extra.len(),
        });
    }
    let mut format = Format::new(6).map_err(internal)?;
    format.has_nir = fields.iter().any(|column| column.field == Some(Field::Nir));
    format.has_color = cloud.colors.is_some() || format.has_nir;
    format.extra_bytes = 4 * extra.len() as u16;
    format.is_compressed = packed;

    let mut builder = Builder::new(raw::Header {
        version: ::las::Version::new(1, 4),
        ..raw::Header::default()
    })
    .map_err(internal)?;
    builder.date = None;
    builder.generating_software = format!("Pointweave {}", env!("CARGO_PKG_VERSION"));
    builder.system_identifier = "EXTRACTION".into();
    builder.point_format = format;
    builder.transforms = transforms(cloud)?;
    if let Some(crs) = &cloud.crs {
        builder.has_wkt_crs = crs.wkt.is_some();
        builder.vlrs.extend(records(crs));
    }
    if !extra.is_empty() {
        builder
            .vlrs
            .push(record("LASF_Spec", 4, descriptions(&extra)));
    }
    let header = builder.into_header().map_err(internal)?;
    let mut writer = Writer::new(Cursor::new(Vec::new()), header).map_err(internal)?;
    for i in 0..points {
        let [x, y, z] = world(cloud, i);
        let mut point = Point {
            x,
            y,
            z,
            return_number: 1,
            number_of_returns: 1,
            gps_time: Some(0.0),
            color: format.has_color.then(|| color(cloud, i)),
            nir: format.has_nir.then_some(0),
            extra_bytes: extra
                .iter()
                .flat_map(|column| column.value(i).to_le_bytes())
                .collect(),
            ..Point::default()
        };
        for column in &fields {
            if let Some(field) = column.field {
                field.set(&mut point, column.value(i));
            }
        }
        writer.write_point(point).map_err(internal)?;
    }
    Ok(writer.into_inner().map_err(internal)?.into_inner())
}

fn internal(error: ::las::Error) -> Error {
    Error::Internal(format!("LAS: {error}"))
}

/// Descriptions of 192 bytes that a variable length record holds.
const MOST_EXTRA: usize = u16::MAX as usize / 192;

/// A field of a point that an attribute may have.
#[derive(Clone, Copy, PartialEq)]
enum Field {
    Intensity,
    Return,
    Returns,
    Class,
    UserData,
    Source,
    Nir,
    Angle,
    Time,
    Direction,
    EdgeOfLine,
    Synthetic,
    KeyPoint,
    Withheld,
    Overlap,
    Channel,
}

/// Degrees of a step of the scan angle.
const ANGLE_STEP: f32 = 0.006;

impl Field {
    /// The field of a name, whatever its spelling.
    fn named(name: &str) -> Option<Field> {
        let plain: String = name.chars().filter(char::is_ascii_alphanumeric).collect();
        Some(match plain.to_ascii_lowercase().as_str() {
            "intensity" => Field::Intensity,
            "returnnumber" => Field::Return,
            "numberofreturns" => Field::Returns,
            "classification" => Field::Class,
            "userdata" => Field::UserData,
            "pointsourceid" => Field::Source,
            "nir" => Field::Nir,
            "scanangle" => Field::Angle,
            "gpstime" => Field::Time,
            "scandirectionflag" => Field::Direction,
            "edgeofflightline" => Field::EdgeOfLine,
            "synthetic" => Field::Synthetic,
            "keypoint" => Field::KeyPoint,
            "withheld" => Field::Withheld,
            "overlap" => Field::Overlap,
            "scannerchannel" => Field::Channel,
            _ => return None,
        })
    }

    /// Whether it holds the values. Of integers: rounding a mean of large ones loses nothing, shares of 1 would be lost.
    fn holds(self, values: &[f32]) -> bool {
        let most = match self {
            Field::Intensity | Field::Source | Field::Nir => 65_535.0,
            Field::Class | Field::UserData => 255.0,
            Field::Return | Field::Returns => 15.0,
            Field::Channel => 3.0,
            Field::Angle => return values.iter().all(|x| x.abs() <= 180.0),
            Field::Time => return values.iter().all(|x| x.is_finite()),
            _ => 1.0,
        };
        let within = values.iter().all(|x| (0.0..=most).contains(x));
        within && (values.iter().all(|x| x.fract() == 0.0) || values.iter().any(|&x| x > 255.0))
    }

    fn set(self, point: &mut Point, value: f32) {
        let whole = value.round() as u16;
        match self {
            Field::Intensity => point.intensity = whole,
            Field::Return => point.return_number = whole as u8,
            Field::Returns => point.number_of_returns = whole as u8,
            // The class of overlaps has a flag of its own in the crate's eyes.
            Field::Class => {
                let class = Classification::new(whole as u8);
                point.is_overlap |= class.is_err();
                point.classification = class.unwrap_or(Classification::Unclassified);
            }
            Field::UserData => point.user_data = whole as u8,
            Field::Source => point.point_source_id = whole,
            Field::Nir => point.nir = Some(whole),
            // The crate cuts off what is no whole step.
            Field::Angle => {
                let steps = (value / ANGLE_STEP).round();
                point.scan_angle = (steps + 0.25 * steps.signum()) * ANGLE_STEP;
            }
            Field::Time => point.gps_time = Some(f64::from(value)),
            Field::Direction if value == 1.0 => point.scan_direction = ScanDirection::LeftToRight,
            Field::Direction => point.scan_direction = ScanDirection::RightToLeft,
            Field::EdgeOfLine => point.is_edge_of_flight_line = value == 1.0,
            Field::Synthetic => point.is_synthetic = value == 1.0,
            Field::KeyPoint => point.is_key_point = value == 1.0,
            Field::Withheld => point.is_withheld = value == 1.0,
            Field::Overlap => point.is_overlap |= value == 1.0,
            Field::Channel => point.scanner_channel = whole as u8,
        }
    }
}

/// Values, one a point, on their way to a field or to extra bytes.
struct Column<'a> {
    name: String,
    values: &'a [f32],
    stride: usize,
    start: usize,
    field: Option<Field>,
}

impl Column<'_> {
    fn value(&self, i: usize) -> f32 {
        self.values[self.stride * i + self.start]
    }
}

fn columns<'a>(cloud: &'a RawCloud) -> Vec<Column<'a>> {
    let mut taken: Vec<Field> = Vec::new();
    let attribute = |Attribute { name, values }: &'a Attribute| {
        let field =
            Field::named(name).filter(|field| field.holds(values) && !taken.contains(field));
        taken.extend(field);
        Column {
            name: name.clone(),
            values,
            stride: 1,
            start: 0,
            field,
        }
    };
    let mut columns: Vec<Column> = cloud.attributes.iter().map(attribute).collect();
    if let Some(normals) = &cloud.normals {
        let axis = |(start, name): (usize, &str)| Column {
            name: name.into(),
            values: normals,
            stride: 3,
            start,
            field: None,
        };
        columns.extend(
            ["NormalX", "NormalY", "NormalZ"]
                .into_iter()
                .enumerate()
                .map(axis),
        );
    }
    columns
}

/// Steps and offset of each axis.
fn transforms(cloud: &RawCloud) -> Result<Vector<Transform>> {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for i in 0..cloud.points() {
        for (axis, x) in world(cloud, i).into_iter().enumerate() {
            if !x.is_finite() {
                return Err(Error::NonFinite {
                    array: "positions".into(),
                    index: i,
                    found: x,
                });
            }
            low[axis] = low[axis].min(x);
            high[axis] = high[axis].max(x);
        }
    }
    let longest = (0..3)
        .map(|axis| high[axis] - low[axis])
        .fold(0.0, f64::max);
    // Powers by division and multiplication: the same everywhere. A place has steps, too. No steps are so fine or so
    // coarse that there is no power of ten beside them.
    let wanted = if longest > 0.0 {
        (longest / f64::from(1 << 23)).clamp(f64::MIN_POSITIVE, f64::MAX)
    } else {
        1e-3
    };
    let mut scale = 1.0;
    while scale > wanted {
        scale /= 10.0;
    }
    while scale * 10.0 <= wanted {
        scale *= 10.0;
    }
    let of = |axis: usize| Transform {
        scale,
        offset: (low[axis] * 0.5 + high[axis] * 0.5).round(),
    };
    let offset_fits =
        |axis: usize| (high[axis] - of(axis).offset).abs() / scale < f64::from(i32::MAX);
    let fine = |axis: usize| match offset_fits(axis) {
        true => of(axis),
        // Of a cloud so small that a whole number is far away.
        false => Transform {
            scale,
            offset: low[axis] * 0.5 + high[axis] * 0.5,
        },
    };
    Ok(Vector {
        x: fine(0),
        y: fine(1),
        z: fine(2),
    })
}

fn color(cloud: &RawCloud, i: usize) -> Color {
    let of = |c: u8| u16::from(c) * 257;
    match super::values::triple(&cloud.colors, i) {
        &[red, green, blue] => Color::new(of(red), of(green), of(blue)),
        _ => Color::default(),
    }
}

/// The 192 bytes that describe each column of extra bytes: single precision, and its name.
fn descriptions(extra: &[Column]) -> Vec<u8> {
    const KIND_OF_FLOATS: u8 = 9;
    let mut names: Vec<String> = Vec::new();
    let mut all = Vec::with_capacity(192 * extra.len());
    for column in extra {
        let name = free_name(&column.name, &names);
        let mut bytes = [0; 192];
        bytes[2] = KIND_OF_FLOATS;
        bytes[4..4 + name.len()].copy_from_slice(name.as_bytes());
        all.extend(bytes);
        names.push(name);
    }
    all
}

/// A name of at most 32 bytes that neither a field nor another column has: readers refuse a name that comes twice.
fn free_name(name: &str, others: &[String]) -> String {
    const ROOM: usize = 32;
    /// What readers call the parts of a point besides [`FIELDS`].
    const PARTS: [&str; 12] = [
        "X",
        "Y",
        "Z",
        "x",
        "y",
        "z",
        "red",
        "green",
        "blue",
        "bit_fields",
        "raw_classification",
        "classification_flags",
    ];
    let cut = |end: &str| {
        let mut length = name.len().min(ROOM - end.len());
        while !name.is_char_boundary(length) {
            length -= 1;
        }
        format!("{}{end}", &name[..length])
    };
    let is_field = FIELDS.contains(&name) || PARTS.contains(&name);
    let mut free = cut(if is_field { FLOAT } else { "" });
    let mut count = 1;
    while free.is_empty() || others.contains(&free) {
        count += 1;
        free = cut(&format!(" {count}"));
    }
    free
}

fn records(crs: &Crs) -> Vec<Vlr> {
    const USER: &str = "LASF_Projection";
    let mut records = Vec::new();
    if let Some(text) = &crs.wkt {
        records.push(record(USER, 2112, [text.as_bytes(), b"\0"].concat()));
    }
    if !crs.keys.is_empty() {
        records.push(record(
            USER,
            34735,
            crs.keys.iter().flat_map(|x| x.to_le_bytes()).collect(),
        ));
    }
    if !crs.doubles.is_empty() {
        records.push(record(
            USER,
            34736,
            crs.doubles.iter().flat_map(|x| x.to_le_bytes()).collect(),
        ));
    }
    if !crs.ascii.is_empty() {
        records.push(record(USER, 34737, [crs.ascii.as_bytes(), b"\0"].concat()));
    }
    records
}

fn record(user: &str, number: u16, data: Vec<u8>) -> Vlr {
    Vlr {
        user_id: user.into(),
        record_id: number,
        description: String::new(),
        data,
    }
}
