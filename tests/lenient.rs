//! What other readers take, and what they keep: dialects of PLY, OFF, PCD, LAS and E57, and messages.
#![cfg(not(target_arch = "wasm32"))]

#[path = "common/made.rs"]
mod made;

use made::Kept;
use pointweave::formats::{
    FaceMode, Format, Positions, RawCloud, ReadOptions, Reading, detect, read,
};

fn values(cloud: &RawCloud) -> Vec<f64> {
    match &cloud.positions {
        Positions::F32(values) => values.iter().map(|&x| f64::from(x)).collect(),
        Positions::F64(values) => values.clone(),
    }
}

/// Vertices, as [`read`] gives them.
fn vertices() -> ReadOptions {
    ReadOptions {
        faces: FaceMode::Vertices,
        ..Default::default()
    }
}

/// Reads a file whole and byte by byte: the same.
fn both(bytes: &[u8], format: Format) -> RawCloud {
    let whole = read(bytes, format).unwrap_or_else(|error| panic!("{error}"));
    let mut reading = Reading::new(None, None, bytes.len() as u64)
        .with_options(vertices())
        .expect("options");
    for byte in bytes {
        reading
            .push(&[*byte])
            .unwrap_or_else(|error| panic!("{error}"));
    }
    while !reading.end().unwrap_or_else(|error| panic!("{error}")) {}
    assert_eq!(reading.summary().points, whole.points() as u64);
    whole
}

const HEADER: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";

#[test]
fn a_byte_order_mark_is_no_content() {
    let files = [
        (Format::Ply, format!("{HEADER}end_header\n1 2 3\n4 5 6\n7 8 9\n")),
        (Format::Xyz, "1 2 3\n4 5 6\n7 8 9\n".into()),
        (Format::Obj, "v 1 2 3\nv 4 5 6\nv 7 8 9\n".into()),
        (Format::Off, "OFF\n3 0 0\n1 2 3\n4 5 6\n7 8 9\n".into()),
        (Format::Pcd, "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 3\nHEIGHT 1\nDATA ascii\n1 2 3\n4 5 6\n7 8 9\n".into()),
        (Format::Stl, "solid a\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\nvertex 4 5 6\nvertex 7 8 9\nendloop\nendfacet\nendsolid\n".into()),
    ];
    for (format, text) in files {
        let marked = [b"\xef\xbb\xbf", text.as_bytes()].concat();
        assert_eq!(detect(&marked, None), Ok(format));
        assert_eq!(
            values(&both(&marked, format)),
            [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0],
            "{format:?}"
        );
    }
}

#[test]
fn lines_of_a_header_end_with_a_feed_and_a_return() {
    let text = HEADER.replace("ascii", "binary_little_endian") + "end_header\n";
    let mut bytes = text.replace('\n', "\n\r").into_bytes();
    // The first byte of the first point is that of a carriage return.
    let floats = [
        f32::from_le_bytes([13, 10, 0, 64]),
        2.0,
        3.0,
        4.0,
        5.0,
        6.0,
        7.0,
        8.0,
        9.0,
    ];
    bytes.extend(floats.iter().flat_map(|x| x.to_le_bytes()));
    assert_eq!(values(&both(&bytes, Format::Ply)), floats.map(f64::from));
}

#[test]
fn rows_go_on_in_the_next_line() {
    for rows in ["1 2\n3\n4\n5\n6\n7 8 9\n", "1\n2\n3\n4 5 6\n7 8\n\n9"] {
        let text = format!("{HEADER}end_header\n{rows}");
        assert_eq!(
            values(&both(text.as_bytes(), Format::Ply)),
            [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]
        );
    }
    // Only where a row ends with a line: else the line is too short.
    for (rows, line) in [
        ("1 2\n3 4 5\n6 7 8\n", 8),
        ("1 2 3\n4 5\n6 7 8\n", 9),
        ("1 2 3\n4 5 6\n7 8", 10),
    ] {
        let error = read(
            format!("{HEADER}end_header\n{rows}").as_bytes(),
            Format::Ply,
        )
        .expect_err("a short line");
        assert_eq!(
            (error.code(), error.index()),
            ("bad-file", Some(line)),
            "{error}"
        );
    }
    let list = HEADER.replace(
        "element vertex",
        "element face 1\nproperty list int int v\nelement vertex",
    );
    let text = format!("{list}end_header\n4000000000 1 2\n1 2 3\n");
    assert_eq!(
        read(text.as_bytes(), Format::Ply)
            .map_err(|e| e.code())
            .err(),
        Some("bad-file")
    );
}

#[test]
fn properties_of_one_name() {
    let text = format!(
        "{HEADER}property float d\nproperty float d\nproperty float x\nend_header\n1 2 3 4 5 6\n1 2 3 4 5 6\n7 8 9 4 5 6\n"
    );
    let cloud = both(text.as_bytes(), Format::Ply);
    let names: Vec<&str> = cloud.attributes.iter().map(|a| a.name.as_str()).collect();
    assert_eq!(names, ["d", "d_2", "x_2"]);
    assert_eq!(values(&cloud)[..3], [1.0, 2.0, 3.0]);
    assert_eq!(cloud.attributes[1].values, [5.0; 3]);
}

#[test]
fn splats_of_a_ply_file_have_colours_and_say_what_they_are() {
    let names = [
        "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2", "f_rest_0", "opacity", "scale_0",
    ];
    let header: String = names
        .iter()
        .map(|name| format!("property float {name}\n"))
        .collect();
    let row = "0 0 0 1.7724539 0 -9 4 0.5 -3\n";
    let text = format!("{HEADER}{header}end_header\n1 2 3 {row}4 5 6 {row}7 8 9 {row}");
    let cloud = both(text.as_bytes(), Format::Ply);
    assert_eq!(
        cloud.colors.as_ref().map(|c| c[..3].to_vec()),
        Some(vec![255, 128, 0])
    );
    assert_eq!(cloud.normals, None);
    let names: Vec<&str> = cloud.attributes.iter().map(|a| a.name.as_str()).collect();
    assert_eq!(names, ["opacity", "scale_0"]);
    assert!(cloud.notes[0].contains("Gaussian splats"));
}

#[test]
fn a_count_may_touch_the_word_off() {
    for text in [
        "OFF3 0 0\n1 2 3\n4 5 6\n7 8 9\n",
        "# a\nOFF3 0 0\n1 2 3\n4 5 6\n7 8 9\n",
    ] {
        assert_eq!(detect(text.as_bytes(), None), Ok(Format::Off));
        assert_eq!(both(text.as_bytes(), Format::Off).points(), 3);
    }
    let text = "COFF2 0 0\n1 2 3 9 8 7\n4 5 6 9 8 7\n";
    assert_eq!(
        both(text.as_bytes(), Format::Off).colors,
        Some(vec![9, 8, 7, 9, 8, 7])
    );
}

#[test]
fn colours_of_a_pcd_file_of_every_type() {
    let pcd = |size: usize, kind: &str, data: &str, body: &[u8]| {
        let text = format!(
            "VERSION .7\nFIELDS x y z rgb\nSIZE 4 4 4 {size}\nTYPE F F F {kind}\nCOUNT 1 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA {data}\n"
        );
        [text.as_bytes(), body].concat()
    };
    let packed: u32 = 0x0012_5ac8;
    let opaque = packed | 0xff00_0000;
    let texts = [
        (4, "U", packed.to_string()),
        (4, "I", (opaque as i32).to_string()),
        (4, "F", f32::from_bits(packed).to_string()),
        (4, "F", format!("{:e}", f64::from(packed))),
        (4, "F", format!("{packed}.0")),
        (8, "U", packed.to_string()),
        (8, "F", packed.to_string()),
    ];
    for (size, kind, text) in texts {
        let file = pcd(size, kind, "ascii", format!("1 2 3 {text}\n").as_bytes());
        let cloud = read(&file, Format::Pcd).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(
            cloud.colors,
            Some(vec![0x12, 0x5a, 0xc8]),
            "{size} {kind} {text}"
        );
    }
    let place: Vec<u8> = [1f32, 2.0, 3.0]
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    let bytes: [(usize, &str, Vec<u8>); 6] = [
        (4, "F", packed.to_le_bytes().into()),
        (4, "F", opaque.to_le_bytes().into()),
        (4, "U", opaque.to_le_bytes().into()),
        (4, "F", (packed as f32).to_le_bytes().into()),
        (8, "F", f64::from(packed).to_le_bytes().into()),
        (8, "U", u64::from(packed).to_le_bytes().into()),
    ];
    for (size, kind, color) in bytes {
        let file = pcd(size, kind, "binary", &[place.clone(), color].concat());
        let cloud = read(&file, Format::Pcd).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(cloud.colors, Some(vec![0x12, 0x5a, 0xc8]), "{size} {kind}");
    }
}

#[test]
fn colours_of_a_ply_file_in_one_value() {
    for (kind, value) in [
        ("uint", "16744448".to_string()),
        ("int", (0xff80_0000u32 as i32 | 0x8000).to_string()),
        ("float", f32::from_bits(0x00ff_8000).to_string()),
        ("float", "16744448".to_string()),
    ] {
        let file = format!(
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty {kind} rgb\nproperty float y\n\
             property float z\nproperty float w\nend_header\n1 {value} 2 3 4\n"
        );
        let cloud = both(file.as_bytes(), Format::Ply);
        assert_eq!(values(&cloud), [1.0, 2.0, 3.0]);
        let red = if kind == "int" { 128 } else { 255 };
        assert_eq!(cloud.colors, Some(vec![red, 128, 0]), "{kind} {value}");
        assert_eq!(cloud.attributes.len(), 1);
    }
    // The bits of an opaque colour may be those of no number.
    let head = "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\n\
                property float z\nproperty float rgb\nend_header\n";
    let place = [1.0f32, 2.0, 3.0].map(f32::to_le_bytes).concat();
    let file = [head.as_bytes(), &place, &0xff8a_1020u32.to_le_bytes()].concat();
    let cloud = both(&file, Format::Ply);
    assert_eq!(cloud.colors, Some(vec![0x8a, 0x10, 0x20]));
}

#[test]
fn a_las_header_that_was_never_finished() {
    for (format, version, count) in [(3, (1, 2), 107), (1, (1, 2), 107), (7, (1, 4), 247)] {
        let file = made::las(format, 25, version, false);
        let mut bad = file.clone();
        bad[107..111].fill(0);
        bad[count..count + 4].fill(0);
        if version == (1, 4) {
            bad[247..255].fill(0);
        }
        let whole = read(&file, Format::Las).expect("a LAS file");
        assert_eq!(read(&bad, Format::Las), Ok(whole), "format {format}");
        // A record that was cut is none.
        let cut = &bad[..bad.len() - 3];
        assert_eq!(read(cut, Format::Las).map(|cloud| cloud.points()), Ok(24));
    }
    let empty = made::las(3, 0, (1, 2), false);
    assert_eq!(read(&empty, Format::Las).map(|cloud| cloud.points()), Ok(0));
}

/// A LAS file of point format 1 with these extra values, described as they are.
fn las_with_extras(described: &[(u8, u8, &str, f64, f64)], extra: &[Vec<u8>]) -> Vec<u8> {
    let file = made::las(1, extra.len(), (1, 4), false);
    let word =
        |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().expect("four bytes")) as usize;
    let (start, record) = (
        word(96),
        usize::from(u16::from_le_bytes([file[105], file[106]])),
    );
    let mut header = file[..start].to_vec();
    let mut vlr = vec![0; 54];
    vlr[2..11].copy_from_slice(b"LASF_Spec");
    vlr[18] = 4;
    vlr[20..22].copy_from_slice(&(192 * described.len() as u16).to_le_bytes());
    for &(kind, options, name, scale, offset) in described {
        let mut one = vec![0; 192];
        one[2] = kind;
        one[3] = options;
        one[4..4 + name.len()].copy_from_slice(name.as_bytes());
        one[40..48].copy_from_slice(&65_535u64.to_le_bytes());
        one[112..120].copy_from_slice(&scale.to_le_bytes());
        one[136..144].copy_from_slice(&offset.to_le_bytes());
        vlr.extend(one);
    }
    let at = start + vlr.len();
    header.extend(vlr);
    header[96..100].copy_from_slice(&(at as u32).to_le_bytes());
    let records = header[100] + 1;
    header[100] = records;
    let size = record + extra[0].len();
    header[105..107].copy_from_slice(&(size as u16).to_le_bytes());
    let points = file[start..].chunks_exact(record).zip(extra);
    let body = points.flat_map(|(point, extra)| [point, extra].concat());
    header.into_iter().chain(body).collect()
}

#[test]
fn extra_bytes_of_a_las_file_have_names_and_scales() {
    let value = |i: i16| {
        [
            i.to_le_bytes().to_vec(),
            (40 + i as u16).to_le_bytes().to_vec(),
            (i as f32 / 4.0).to_le_bytes().to_vec(),
        ]
        .concat()
    };
    let mut extra: Vec<Vec<u8>> = (0..6).map(value).collect();
    extra[4][2..4].copy_from_slice(&[255, 255]);
    let file = las_with_extras(
        &[
            (4, 8, "height", 0.25, 9.0),
            (3, 1 | 8 | 16, "amplitude", 0.5, 100.0),
            (9, 0, "intensity", 0.0, 0.0),
        ],
        &extra,
    );
    let cloud = both(&file, Format::Las);
    let attribute = |name: &str| {
        let found = cloud
            .attributes
            .iter()
            .find(|attribute| attribute.name == name);
        found.unwrap_or_else(|| panic!("{name}")).values.clone()
    };
    assert_eq!(attribute("height"), [0.0, 0.25, 0.5, 0.75, 1.0, 1.25]);
    // The fifth is what the file says is missing.
    assert_eq!(
        attribute("amplitude"),
        [120.0, 120.5, 121.0, 121.5, 0.0, 122.5]
    );
    assert_eq!(attribute("intensity_2"), [0.0, 0.25, 0.5, 0.75, 1.0, 1.25]);
    assert_eq!(cloud.replaced, 1);
    // A description of more bytes than a point has.
    let long = las_with_extras(&[(10, 0, "a", 0.0, 0.0), (4, 0, "b", 0.0, 0.0)], &extra);
    let names: Vec<String> = both(&long, Format::Las)
        .attributes
        .into_iter()
        .map(|a| a.name)
        .collect();
    assert!(
        names.contains(&"a".to_string()) && !names.contains(&"b".to_string()),
        "{names:?}"
    );
}

#[test]
fn fields_of_a_las_file_that_are_not_all_zero() {
    let mut file = made::las(1, 9, (1, 2), false);
    let start = file.len() - 9 * 28;
    for i in 0..9 {
        let record = start + 28 * i;
        // Return 2 of 3, a key point, an angle of -7 degrees, user data, source.
        file[record + 14] = 2 | 3 << 3;
        file[record + 15] |= 64;
        file[record + 16] = 249;
        file[record + 17] = if i > 5 { 8 } else { 0 };
        file[record + 18..record + 20].copy_from_slice(&300u16.to_le_bytes());
        file[record + 20..record + 28].copy_from_slice(&(1e9 + i as f64 * 0.25).to_le_bytes());
    }
    let cloud = both(&file, Format::Las);
    let facts: Vec<(&str, f32, f32)> = cloud
        .attributes
        .iter()
        .map(|a| (a.name.as_str(), a.values[0], a.values[8]))
        .skip(2)
        .collect();
    let expected = [
        ("return_number", 2.0, 2.0),
        ("number_of_returns", 3.0, 3.0),
        ("key_point", 1.0, 1.0),
        ("scan_angle", -7.0, -7.0),
        ("user_data", 0.0, 8.0),
        ("point_source_id", 300.0, 300.0),
        ("gps_time", 0.0, 2.0),
    ];
    assert_eq!(facts, expected);
    assert_eq!(
        cloud.notes,
        ["The attribute gps_time counts the seconds from 1000000000."]
    );
}

#[test]
fn bits_of_a_las_files_colours() {
    let brightest = |wide: u32, stray: Option<u16>| {
        let mut file = made::las(2, 240, (1, 2), false);
        let start = file.len() - 240 * 26;
        for i in 0..240 {
            for channel in 0..3 {
                let at = start + 26 * i + 20 + 2 * channel;
                let value = ((i as u32 * 17 + channel as u32 * 5) % 256 * wide / 256) as u16;
                let value = if i == 7 && channel == 1 {
                    stray.unwrap_or(value)
                } else {
                    value
                };
                file[at..at + 2].copy_from_slice(&value.to_le_bytes());
            }
        }
        let colors = read(&file, Format::Las)
            .expect("a LAS file")
            .colors
            .expect("colours");
        colors.iter().copied().max()
    };
    assert!(brightest(256, None) > Some(250));
    assert!(brightest(256, Some(256)) > Some(250));
    assert!(brightest(4096, None) > Some(250));
}

#[test]
fn messages_say_what_is_there() {
    let png = b"\x89PNG\r\n\x1a\n\x00\x00\x00\x0dIHDR";
    for (bytes, words) in [
        (&png[..], "a PNG picture"),
        (b"PK\x03\x04\x14\x00", "a ZIP archive"),
        (b"# vtk DataFile Version 3.0\n", "a VTK file"),
        (
            b"<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\">",
            "a VTK file in XML",
        ),
        (b"Kaydara FBX Binary  \x00", "an FBX scene"),
        (b"  0\r\nSECTION\r\n", "a DXF drawing"),
        (b"\x93NUMPY\x01\x00", "an array of NumPy"),
        (b"DSRB\0\0\0\0", "a Surfer grid in binary"),
        (b"{\"asset\":{\"version\":\"2.0\"}}", "a glTF scene as text"),
        (b"\x00\x01\x02\xfe\xff", "the bytes 00 01 02 fe ff"),
    ] {
        let error = detect(bytes, None).expect_err("no scan");
        let text = error.to_string();
        assert!(text.contains(words) && !text.contains('\u{fffd}'), "{text}");
    }
    let binary = [HEADER.as_bytes(), b"\xff\xfe\x01\x02\n"].concat();
    let text = read(&binary, Format::Ply).expect_err("bytes").to_string();
    assert!(text.contains("the bytes ff fe 01 02"), "{text}");
    let mut e57 = made::e57(&[(Kept::Double, 20)]);
    for (at, words) in [
        (24, "a header and a directory"),
        (8, "a header and a directory"),
    ] {
        e57[at] ^= 0x40;
        let text = read(&e57, Format::E57).expect_err("damage").to_string();
        assert!(
            text.contains(words) && !text.contains("Invalid E57 content"),
            "{text}"
        );
        e57[at] ^= 0x40;
    }
}
