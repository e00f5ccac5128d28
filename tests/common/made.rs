//! Files of formats that the crate reads and does not write, made by the crates that do or byte by byte.

#![allow(dead_code)] // every test takes what it needs

use e57::{
    E57Writer, Quaternion, Record, RecordDataType, RecordName, RecordValue, Transform, Translation,
};
use las::point::Format;
use std::io::Cursor;

/// Point `i` of what is made here: coordinates in thousandths.
pub fn position(i: usize) -> [i32; 3] {
    let i = i as i32;
    [1000 * i, 500 - i * i % 977, 17 * i % 311]
}

/// `points` points of a point format, as LAS or packed as LAZ, near (400,000, 5,000,000, 100).
pub fn las(format: u8, points: usize, version: (u8, u8), packed: bool) -> Vec<u8> {
    let mut builder = las::Builder::from(version);
    builder.point_format = Format::new(format).expect("a point format");
    builder.point_format.is_compressed = packed;
    builder.transforms = las::Vector {
        x: las::Transform {
            scale: 0.001,
            offset: 400_000.0,
        },
        y: las::Transform {
            scale: 0.001,
            offset: 5_000_000.0,
        },
        z: las::Transform {
            scale: 0.001,
            offset: 100.0,
        },
    };
    let header = builder.into_header().expect("a header");
    let mut writer = las::Writer::new(Cursor::new(Vec::new()), header).expect("a writer");
    let kind = Format::new(format).expect("a point format");
    for i in 0..points {
        let [x, y, z] = position(i);
        let word = |k: usize| (7919 * (i + k) % 65_536) as u16;
        let point = las::Point {
            x: 400_000.0 + f64::from(x) * 0.001,
            y: 5_000_000.0 + f64::from(y) * 0.001,
            z: 100.0 + f64::from(z) * 0.001,
            intensity: word(1),
            classification: las::point::Classification::new((i % 12) as u8).expect("a class"),
            color: kind
                .has_color
                .then(|| las::Color::new(word(2), word(3), word(4))),
            gps_time: kind.has_gps_time.then_some(i as f64),
            nir: kind.has_nir.then(|| word(5) | 1),
            waveform: kind.has_waveform.then(las::raw::point::Waveform::default),
            ..Default::default()
        };
        writer.write_point(point).expect("a point written");
    }
    writer.into_inner().expect("a file written").into_inner()
}

/// How the coordinates of a scan are kept.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Kept {
    Single,
    Double,
    /// As integers of a thousandth.
    Scaled,
    Spherical,
}

/// A pose: a quaternion `w x y z` and a place.
pub fn pose([w, x, y, z]: [f64; 4], [a, b, c]: [f64; 3]) -> Transform {
    Transform {
        rotation: Quaternion { w, x, y, z },
        translation: Translation { x: a, y: b, z: c },
    }
}

/// An E57 file with a scan of so many points for each entry, all with intensity, colours and normals; every fifth point
/// of a Cartesian scan is marked as invalid. The second scan, and those after it, are turned by 90° around z and moved by
/// (10, 20, 30).
pub fn e57(scans: &[(Kept, usize)]) -> Vec<u8> {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let moved = pose([half, 0.0, 0.0, half], [10.0, 20.0, 30.0]);
    let pose = |i: usize| (i > 0).then(|| moved.clone());
    let scans: Vec<_> = scans
        .iter()
        .enumerate()
        .map(|(i, &(kept, points))| (kept, points, pose(i)))
        .collect();
    e57_at(&scans)
}

/// The same, each scan at a pose of its own.
pub fn e57_at(scans: &[(Kept, usize, Option<Transform>)]) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let mut writer = E57Writer::new(&mut file, "{0}").expect("a writer");
    let extension = e57::Extension::new("nor", "http://www.libe57.org/E57_NOR_surface_normals.txt");
    writer.register_extension(extension).expect("an extension");
    for (scan, (kept, points, pose)) in scans.iter().enumerate() {
        let mut cloud = writer
            .add_pointcloud(&format!("{{{scan}}}"), prototype(*kept))
            .expect("a scan");
        cloud.set_transform(pose.clone());
        for i in 0..*points {
            cloud.add_point(values(*kept, i)).expect("a point");
        }
        cloud.finalize().expect("a scan written");
    }
    writer.finalize().expect("a file written");
    drop(writer);
    file.into_inner()
}

fn prototype(kept: Kept) -> Vec<Record> {
    let scaled = |name| Record {
        name,
        data_type: RecordDataType::ScaledInteger {
            min: -10_000_000,
            max: 10_000_000,
            scale: 0.001,
            offset: 0.0,
        },
    };
    let mut records = match kept {
        Kept::Single => vec![
            Record::CARTESIAN_X_F32,
            Record::CARTESIAN_Y_F32,
            Record::CARTESIAN_Z_F32,
        ],
        Kept::Double => vec![
            Record::CARTESIAN_X_F64,
            Record::CARTESIAN_Y_F64,
            Record::CARTESIAN_Z_F64,
        ],
        Kept::Scaled => vec![
            scaled(RecordName::CartesianX),
            scaled(RecordName::CartesianY),
            scaled(RecordName::CartesianZ),
        ],
        Kept::Spherical => vec![
            Record::SPHERICAL_RANGE_F64,
            Record::SPHERICAL_AZIMUTH_F64,
            Record::SPHERICAL_ELEVATION_F64,
        ],
    };
    if kept != Kept::Spherical {
        records.push(Record::CARTESIAN_INVALID_STATE);
    }
    records.extend([
        Record::COLOR_RED_U8,
        Record::COLOR_GREEN_U8,
        Record::COLOR_BLUE_U8,
    ]);
    records.push(Record {
        name: RecordName::Intensity,
        data_type: RecordDataType::F32,
    });
    for name in ["normalX", "normalY", "normalZ"] {
        records.push(Record {
            name: RecordName::Unknown {
                namespace: "nor".into(),
                name: name.into(),
            },
            data_type: RecordDataType::F32,
        });
    }
    records
}

fn values(kept: Kept, i: usize) -> Vec<RecordValue> {
    let place = position(i);
    let [x, y, z] = place.map(|x| f64::from(x) * 0.001);
    let mut values: Vec<RecordValue> = match kept {
        Kept::Single => [x, y, z].map(|x| RecordValue::Single(x as f32)).into(),
        Kept::Double => [x, y, z].map(RecordValue::Double).into(),
        Kept::Scaled => place
            .map(|x| RecordValue::ScaledInteger(i64::from(x)))
            .into(),
        Kept::Spherical => {
            let range = (x * x + y * y + z * z).sqrt();
            [range, y.atan2(x), (z / range).asin()]
                .map(RecordValue::Double)
                .into()
        }
    };
    if kept != Kept::Spherical {
        values.push(RecordValue::Integer(if i % 5 == 4 { 2 } else { 0 }));
    }
    values.extend([i % 256, 255 - i % 256, 7].map(|c| RecordValue::Integer(c as i64)));
    values.push(RecordValue::Single(i as f32));
    values.extend([1.0, 0.0, 0.0].map(RecordValue::Single));
    values
}

/// An E57 file of a scan of so many points with rows, times that start late, and values of an extension, and of one without them.
pub fn e57_with_extras(points: usize) -> Vec<u8> {
    let record = |name: RecordName, data_type: RecordDataType| Record { name, data_type };
    let whole = RecordDataType::Integer { min: 0, max: 1000 };
    let temperature = RecordName::Unknown {
        namespace: "demo".into(),
        name: "temperature".into(),
    };
    let places = [
        Record::CARTESIAN_X_F64,
        Record::CARTESIAN_Y_F64,
        Record::CARTESIAN_Z_F64,
        Record::CARTESIAN_INVALID_STATE,
    ];
    let mut records = places.to_vec();
    records.extend([
        record(RecordName::RowIndex, whole.clone()),
        record(RecordName::ColumnIndex, whole),
        record(RecordName::TimeStamp, RecordDataType::F64),
        record(temperature, RecordDataType::F32),
    ]);
    let mut file = Cursor::new(Vec::new());
    let mut writer = E57Writer::new(&mut file, "{0}").expect("a writer");
    let extension = e57::Extension::new("demo", "http://example.org/demo");
    writer.register_extension(extension).expect("an extension");
    for (scan, prototype) in [records, places.to_vec()].into_iter().enumerate() {
        let extras = prototype.len() > places.len();
        let mut cloud = writer
            .add_pointcloud(&format!("{{{scan}}}"), prototype)
            .expect("a scan");
        for i in 0..points {
            let mut values: Vec<RecordValue> = position(i)
                .map(|x| RecordValue::Double(f64::from(x) * 0.001))
                .into();
            // Every third point has a direction alone, every seventh nothing.
            let state = if i % 7 == 6 { 2 } else { i64::from(i % 3 == 2) };
            values.push(RecordValue::Integer(state));
            if extras {
                values.extend([
                    RecordValue::Integer(i as i64 % 10),
                    RecordValue::Integer(0),
                    RecordValue::Double(1e9 + i as f64),
                    RecordValue::Single(20.5 + i as f32),
                ]);
            }
            cloud.add_point(values).expect("a point");
        }
        cloud.finalize().expect("a scan written");
    }
    writer.finalize().expect("a file written");
    drop(writer);
    file.into_inner()
}

/// A GLB file of this description and data.
pub fn glb(json: &str, data: &[u8]) -> Vec<u8> {
    let padded = |content: &[u8], by: u8| {
        let mut content = content.to_vec();
        content.resize(content.len().next_multiple_of(4), by);
        content
    };
    let (json, data) = (padded(json.as_bytes(), b' '), padded(data, 0));
    let length = (12 + 8 + json.len() + 8 + data.len()) as u32;
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend(length.to_le_bytes());
    for (kind, content) in [(b"JSON", &json), (b"BIN\0", &data)] {
        file.extend((content.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(content);
    }
    file
}
