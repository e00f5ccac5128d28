//! E57 (ASTM E2807), by the crate `e57`: the points of all its scans, each at its pose, spherical coordinates made Cartesian.
//! Colours are taken over the range that the file gives them, `intensity` as it is, normals where the extension for
//! surface normals has them, and every other value of a point as an attribute where one is not 0; times are counted from the
//! scan's first. Points without a colour, where others have one, are white. Points that the scanner marked as invalid
//! are left out and counted.
//!
//! The file is kept until all of it is there, because its directory is at its end; scans are then read one after the other.

use super::colors::ColorRange;
use super::input::Input;
use super::reading::{Parser, Step};
use super::table::{Columns, Precision, Table};
use crate::base::error::{Error, Result};
use ::e57::{CartesianCoordinate, E57Reader, PointCloud, RecordDataType, RecordName, Transform};
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// After so many points the scan is the last of its step.
const STEP: u64 = 1 << 18;

/// Reads the points.
#[derive(Default)]
pub(super) struct E57 {
    /// Scans that have been read.
    read: usize,
}

impl Parser for E57 {
    fn parse(&mut self, input: &mut Input, table: &mut Option<Table>) -> Result<Step> {
        if !input.last {
            return Ok(Step::More);
        }
        let bytes = input.rest();
        if !bytes.starts_with(b"ASTM-E57") {
            let found = super::text::quote(&bytes[..bytes.len().min(8)]);
            return Err(input.bad_byte(0, "\"ASTM-E57\"", found));
        }
        let mut file = guarded(input, 0, || E57Reader::new(Cursor::new(bytes)))?;
        let scans = file.pointclouds();
        let table = table
            .get_or_insert_with(|| Table::new(columns(&scans), Some(room(&scans, bytes.len()))));
        let start = table.rows;
        while let Some(scan) = scans.get(self.read) {
            if table.rows - start >= STEP {
                return Ok(Step::More);
            }
            read_scan(&mut file, scan, &extra_names(&scans), input, table)?;
            self.read += 1;
        }
        Ok(Step::Done)
    }
}

/// What a value beyond the known ones is called: as in the file.
fn extra_name(name: &RecordName) -> Option<String> {
    match name {
        RecordName::RowIndex => Some("rowIndex".into()),
        RecordName::ColumnIndex => Some("columnIndex".into()),
        RecordName::ReturnCount => Some("returnCount".into()),
        RecordName::ReturnIndex => Some("returnIndex".into()),
        RecordName::TimeStamp => Some("timeStamp".into()),
        RecordName::Unknown { name, .. } => {
            (!NORMAL.contains(&name.as_str())).then(|| name.clone())
        }
        _ => None,
    }
}

/// Names of the extra values of all scans, each once.
fn extra_names(scans: &[PointCloud]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    let records = scans.iter().flat_map(|scan| &scan.prototype);
    for name in records.filter_map(|record| extra_name(&record.name)) {
        if !names.contains(&name) && name != "intensity" {
            names.push(name);
        }
    }
    names
}

/// The normals' names in their extension.
const NORMAL: [&str; 3] = ["normalX", "normalY", "normalZ"];

/// Where the prototype of a scan has the normals.
fn normals(scan: &PointCloud) -> Option<[usize; 3]> {
    let find = |wanted: &str| {
        scan.prototype.iter().position(|record| match &record.name {
            RecordName::Unknown { name, .. } => name == wanted,
            _ => false,
        })
    };
    let [x, y, z] = NORMAL.map(find);
    Some([x?, y?, z?])
}

/// The columns of the rows that [`read_scan`] makes: what any of the scans has.
fn columns(scans: &[PointCloud]) -> Columns {
    let any = |has: fn(&PointCloud) -> bool| scans.iter().any(has);
    let mut scalars = Vec::new();
    if any(PointCloud::has_intensity) {
        scalars.push((6, "intensity".into()));
    }
    let optional_from = scalars.len();
    let extras = extra_names(scans).into_iter().enumerate();
    scalars.extend(extras.map(|(i, name)| (KNOWN + i, name)));
    Columns {
        color: any(PointCloud::has_color).then_some([3, 4, 5]),
        scalars,
        optional_from,
        normal: any(|scan| normals(scan).is_some()).then_some([7, 8, 9]),
        colors: ColorRange::Unit,
        precision: if scans.iter().all(is_single) {
            Precision::Single
        } else {
            Precision::Double
        },
        ..Columns::xyz()
    }
}

/// Values of a row before the extra ones: place, colour, intensity, normal.
const KNOWN: usize = 10;

/// Whether single precision holds the coordinates: they have no more, and stay where they are.
fn is_single(scan: &PointCloud) -> bool {
    let axes = [
        RecordName::CartesianX,
        RecordName::CartesianY,
        RecordName::CartesianZ,
    ];
    let mut records = scan
        .prototype
        .iter()
        .filter(|record| axes.contains(&record.name));
    let single = |record: &::e57::Record| matches!(record.data_type, RecordDataType::Single { .. });
    scan.has_cartesian() && scan.transform.is_none() && records.all(single)
}

/// Points of all scans, as far as a file of this size can hold them.
fn room(scans: &[PointCloud], size: usize) -> u64 {
    let most = |scan: &PointCloud| scan.records.min(8 * size as u64 / bits(scan).max(1));
    scans.iter().map(most).fold(0, u64::saturating_add)
}

/// Bits of a point.
fn bits(scan: &PointCloud) -> u64 {
    let bits = |data_type: &RecordDataType| match *data_type {
        RecordDataType::Single { .. } => 32,
        RecordDataType::Double { .. } => 64,
        RecordDataType::ScaledInteger { min, max, .. } | RecordDataType::Integer { min, max } => {
            u64::from(64 - min.abs_diff(max).leading_zeros())
        }
    };
    scan.prototype
        .iter()
        .map(|record| bits(&record.data_type))
        .sum()
}

fn read_scan(
    file: &mut E57Reader<Cursor<&[u8]>>,
    scan: &PointCloud,
    names: &[String],
    input: &Input,
    table: &mut Table,
) -> Result<()> {
    let at = scan.file_offset;
    let bytes = input.rest();
    let most = 8 * bytes.len() as u64 / bits(scan).max(1);
    // Points of no bits, all the same, take no bytes: the crate would make them without end.
    if scan.records > most || (scan.records > 0 && bits(scan) == 0) {
        let expected = format!(
            "a scan of {} points of {} bits each",
            scan.records,
            bits(scan)
        );
        return Err(input.bad_byte(at, &expected, format!("a file of {} bytes", bytes.len())));
    }
    if !scan.has_cartesian() && !scan.has_spherical() {
        return Err(input.unsupported(
            "scans with Cartesian or spherical coordinates",
            "one without",
        ));
    }
    guarded(input, at, || {
        let mut points = file.pointcloud_simple(scan)?;
        points.intensity_to_color(false);
        points.normalize_intensity(false);
        table.seen_from(station(scan));
        let turn = Turn::of(scan.transform.as_ref());
        // Normals are none of what the crate knows, so they are read beside the points.
        let mut second = E57Reader::new(Cursor::new(bytes))?;
        let normals = normals(scan);
        let extras = scan.prototype.iter().enumerate();
        let extras: Vec<(usize, usize)> = extras
            .filter_map(|(i, record)| {
                let name = extra_name(&record.name)?;
                Some((i, names.iter().position(|known| *known == name)?))
            })
            .collect();
        let is_time = |i: usize| scan.prototype[i].name == RecordName::TimeStamp;
        let mut start = None;
        let mut raw = if normals.is_some() || !extras.is_empty() {
            Some(second.pointcloud_raw(scan)?)
        } else {
            None
        };
        if let Some(Transform { translation, .. }) = &scan.transform {
            let sensor = [translation.x, translation.y, translation.z];
            table.seen_from(Some(sensor));
        }
        let mut row = vec![0.0; KNOWN + names.len()];
        for point in points {
            let point = match point {
                Err(error) if is_packet_without_points(&error) => continue,
                other => other?,
            };
            let values = match raw.as_mut().and_then(Iterator::next) {
                Some(values) => values?,
                None => Vec::new(),
            };
            let CartesianCoordinate::Valid { x, y, z } = point.cartesian else {
                table.invalid += 1;
                continue;
            };
            row[..3].copy_from_slice(&[x, y, z]);
            let color = point
                .color
                .map_or([1.0; 3], |color| [color.red, color.green, color.blue]);
            row[3..6].copy_from_slice(&color.map(f64::from));
            row[6] = f64::from(point.intensity.unwrap_or(0.0));
            row[7..].fill(0.0);
            let value = |i: usize| match values.get(i) {
                Some(value) => value.to_f64(&scan.prototype[i].data_type),
                None => Ok(0.0),
            };
            if let Some(indices) = normals {
                let [x, y, z] = indices.map(value);
                row[7..KNOWN].copy_from_slice(&turn.apply([x?, y?, z?]));
            }
            for &(i, name) in &extras {
                let value = value(i)?;
                row[KNOWN + name] = if is_time(i) {
                    value - *start.get_or_insert(value)
                } else {
                    value
                };
            }
            table.push(&row);
        }
        Ok(())
    })
}

/// A packet may have no whole point, and an index has none: the crate (0.11.13) then gives this error where it should go on, as
/// it does when it is asked again.
fn is_packet_without_points(error: &::e57::Error) -> bool {
    matches!(error, ::e57::Error::Internal { desc, .. } if desc == "Cannot read next point because of logic error")
}

/// Where a scan was made from: the place of its pose. The identity is what files have that know no pose, and a rotation that is
/// none says that the pose means nothing; but spherical coordinates are those of a scanner.
fn station(scan: &PointCloud) -> Option<[f64; 3]> {
    let Transform {
        rotation,
        translation,
    } = scan.transform.clone().unwrap_or_default();
    let ::e57::Quaternion { w, x, y, z } = rotation;
    let is_rotation = ((w * w + x * x + y * y + z * z) - 1.0).abs() < 1e-3;
    let position = [translation.x, translation.y, translation.z];
    let is_identity = position == [0.0; 3] && [x, y, z] == [0.0; 3];
    let is_known = !is_identity || !scan.has_cartesian();
    (is_rotation && is_known).then_some(position)
}

/// The rotation of a pose.
struct Turn([[f64; 3]; 3]);

impl Turn {
    fn of(pose: Option<&Transform>) -> Turn {
        let Some(pose) = pose else {
            return Turn([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        };
        let ::e57::Quaternion { w, x, y, z } = pose.rotation;
        Turn([
            [
                w * w + x * x - y * y - z * z,
                2.0 * (x * y - w * z),
                2.0 * (x * z + w * y),
            ],
            [
                2.0 * (x * y + w * z),
                w * w + y * y - x * x - z * z,
                2.0 * (y * z - w * x),
            ],
            [
                2.0 * (x * z - w * y),
                2.0 * (y * z + w * x),
                w * w + z * z - x * x - y * y,
            ],
        ])
    }

    fn apply(&self, v: [f64; 3]) -> [f64; 3] {
        self.0
            .map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
    }
}

/// What the crate says is wrong, with its causes: in the file's directory where `at` is 0, else in the points there.
fn wrong(input: &Input, at: u64, error: &::e57::Error) -> Error {
    use ::e57::Error::{Internal, Invalid, NotImplemented, Read, Write};
    let (Invalid { desc, .. }
    | Read { desc, .. }
    | Write { desc, .. }
    | Internal { desc, .. }
    | NotImplemented { desc }) = error
    else {
        return input.bad_byte(at, "an E57 file that is whole", error.to_string());
    };
    let mut found = desc.trim_end_matches('.').to_string();
    let mut cause = std::error::Error::source(error);
    while let Some(error) = cause {
        found = format!("{found} ({error})");
        cause = error.source();
    }
    if matches!(error, NotImplemented { .. }) {
        return input.unsupported("what the standard's core has", found);
    }
    let expected = if at == 0 {
        "a header and a directory that are whole"
    } else {
        "points that are whole"
    };
    // The crate tells no byte; the directory is said in the header to be at the byte in it.
    let place = input
        .rest()
        .get(24..32)
        .and_then(|bytes| bytes.first_chunk());
    let directory = place.map_or(0, |bytes| u64::from_le_bytes(*bytes));
    let at = if at == 0 {
        directory.min(input.size)
    } else {
        at
    };
    input.bad_byte(at, expected, found)
}

/// What the crate gives; its errors, and its panics, as an error at `at`.
fn guarded<T>(input: &Input, at: u64, call: impl FnOnce() -> ::e57::Result<T>) -> Result<T> {
    match catch_unwind(AssertUnwindSafe(call)) {
        Ok(result) => result.map_err(|error| wrong(input, at, &error)),
        Err(_) => {
            let expected = "points that can be taken apart";
            Err(input.bad_byte(at, expected, "damaged ones"))
        }
    }
}
