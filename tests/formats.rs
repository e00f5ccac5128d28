//! Readers and writers: dialects, round trips, and damaged input. Files that others made are in `files.rs`.

use pointweave::base::rng::Rng;
use pointweave::cloud::Attribute;
use pointweave::formats::{Format, Output, Positions, RawCloud, WriteOptions, detect, read, write};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn values(positions: &Positions) -> Vec<f64> {
    match positions {
        Positions::F32(values) => values.iter().map(|&x| f64::from(x)).collect(),
        Positions::F64(values) => values.clone(),
    }
}

#[test]
fn origin_is_added_in_double_precision() {
    let mut cloud = RawCloud::new(Positions::F32(vec![0.25, 0.5, 0.75, 1.0, 2.0, 3.0]));
    cloud.origin = Some([500_000.0, 4_000_000.0, 100.0]);
    for format in Format::WRITTEN {
        let bytes = write(&cloud, None, output(format), WriteOptions::default()).unwrap();
        let expected = [
            500_000.25,
            4_000_000.5,
            100.75,
            500_001.0,
            4_000_002.0,
            103.0,
        ];
        assert_eq!(values(&read(&bytes, format).unwrap().positions), expected);
    }
}

#[test]
fn colours_come_in_bytes_floats_and_sixteen_bits() {
    let ply = |kind: &str, values: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n\
             property {kind} red\nproperty {kind} green\nproperty {kind} blue\nend_header\n0 0 0 {values}\n1 1 1 0 0 0\n"
        )
    };
    for (kind, text, bytes) in [
        ("uchar", "255 1 0", [255, 1, 0]),
        ("uchar", "1 1 0", [1, 1, 0]),
        ("float", "1 0.5 0", [255, 128, 0]),
        ("float", "200 100 0", [200, 100, 0]),
        ("ushort", "65535 257 0", [255, 1, 0]),
        ("ushort", "4095 2048 0", [255, 128, 0]),
        ("int", "65535 -5 0", [255, 0, 0]),
    ] {
        let cloud = read(ply(kind, text).as_bytes(), Format::Ply).unwrap();
        assert_eq!(cloud.colors.unwrap()[..3], bytes, "{kind} {text}");
    }
}

#[test]
fn text_dialects_without_names_are_told_apart() {
    let all: [(&str, &[&str]); 15] = [
        ("0 0 0\n1 2 3", &[]),
        ("0,0,0,\n1,2,3,", &[]),
        ("0;0;0\n1,5;2,5;3,5", &[]),
        ("0\t0\t0\n1 2\t3 ", &[]),
        ("0 0 0 0.5\n1 2 3 0.7", &["intensity"]),
        ("0 0 0 0 0.6 -0.8\n1 2 3 1 0 0", &["normals"]),
        ("0 0 0 0 0 9\n1 2 3 255 7 0", &["colors"]),
        ("0 0 0 0 0 0.1\n1 2 3 1 0.5 0", &["colors"]),
        (
            "0 0 0 0 0 300\n1 2 3 1 0.5 -4",
            &["column4", "column5", "column6"],
        ),
        (
            "2\n0 0 0 17 0 0 9\n1 2 3 18 255 7 0",
            &["colors", "intensity"],
        ),
        (
            "0 0 0 -900 0 0 9\n1 2 3 18 255 7 0",
            &["colors", "intensity"],
        ),
        (
            "0 0 0 0 0 9 1 0 0\n1 2 3 255 7 0 0 1 0",
            &["normals", "colors"],
        ),
        (
            "0 0 0 1 0 0 0 0 9\n1 2 3 0 1 0 255 7 0",
            &["normals", "colors"],
        ),
        (
            "//X Y Z Nx Ny Nz Class\n0 0 0 3 0 0 4\n1 2 3 0 1 0 9",
            &["normals", "Class"],
        ),
        (
            "\"x\",\"y\",\"z\",\"r\",\"g\",\"b\"\n0,0,0,1,2,3\n1,2,3,4,5,6",
            &["colors"],
        ),
    ];
    for (text, expected) in all {
        let cloud = read(text.as_bytes(), Format::Xyz).unwrap_or_else(|e| panic!("{text}: {e}"));
        let mut found: Vec<&str> = Vec::new();
        found.extend(cloud.normals.as_ref().map(|_| "normals"));
        found.extend(cloud.colors.as_ref().map(|_| "colors"));
        found.extend(cloud.attributes.iter().map(|a| a.name.as_str()));
        assert_eq!(found, expected, "{text}");
        assert_eq!(cloud.points(), 2, "{text}");
    }
    let decimal_commas = read(b"0;0;0\n1,5;2,5;3,5", Format::Xyz).unwrap();
    assert_eq!(
        decimal_commas.positions,
        Positions::F32(vec![0.0, 0.0, 0.0, 1.5, 2.5, 3.5])
    );
    let pts = read(b"2\n0 0 0 17 0 0 9\n1 2 3 18 255 7 0", Format::Xyz).unwrap();
    assert_eq!(pts.attributes[0].values, [17.0, 18.0]);
}

#[test]
fn text_that_is_no_table_says_the_line() {
    for (text, line) in [
        ("", 1),
        ("# nothing\n\n", 2),
        ("0 0 0\n1 2\n", 2),
        ("0 0 0\n\n1 2 3 4\n", 3),
        ("0 0 0\n1 2 x\n", 2),
        ("1 2\n3 4\n", 1),
        ("x,y\n1,2\n", 1),
        ("x,y,z,X\n1,2,3,4\n", 1),
        ("x,y,z\n1,2,3,4\n", 2),
        ("1,,3\n", 1),
        ("3\n0 0 0\n1 1 1\n", 3),
        ("hello world\n", 1),
    ] {
        let error = read(text.as_bytes(), Format::Xyz).unwrap_err();
        assert_eq!(
            (error.code(), error.index()),
            ("bad-file", Some(line)),
            "{text:?}: {error}"
        );
    }
    assert_eq!(read(b"x y z\n", Format::Xyz).unwrap().points(), 0);
    assert_eq!(
        read(b"\xff\xfe1\x00", Format::Xyz).unwrap_err().code(),
        "unsupported-file"
    );
}

#[test]
fn content_decides_the_format_before_the_name() {
    let found = |bytes: &[u8], name| detect(bytes, name).map_err(|e| e.code());
    assert_eq!(found(b"ply\r\nformat", Some("a.xyz")), Ok(Format::Ply));
    assert_eq!(found(b"# c\n\n1 2 3\n", None), Ok(Format::Xyz));
    assert_eq!(found(b"1 2 3\n", Some("a.ply")), Ok(Format::Xyz));
    assert_eq!(found(b"", Some("A.PLY")), Ok(Format::Ply));
    assert_eq!(found(b"garbage", Some("scan.csv")), Ok(Format::Xyz));
    assert_eq!(found(b"LASF", Some("a.ply")), Ok(Format::Las));
    assert_eq!(found(b"ASTM-E57", None), Ok(Format::E57));
    assert_eq!(found(b"glTF\x02", None), Ok(Format::Glb));
    assert_eq!(found(b"# .PCD v0.7", None), Ok(Format::Pcd));
    assert_eq!(found(b"# a\nVERSION .7\n", None), Ok(Format::Pcd));
    assert_eq!(found(b"# a\n\nmtllib x\nv 1 2 3\n", None), Ok(Format::Obj));
    assert_eq!(found(b"v 1 2 3\n", Some("a.xyz")), Ok(Format::Obj));
    assert_eq!(found(b"STCNOFF\n", None), Ok(Format::Off));
    assert_eq!(
        found(b"solid x\nfacet normal 0 0 1\n", None),
        Ok(Format::Stl)
    );
    for unknown in [
        &b"garbage"[..],
        b"",
        b"\x00\x01",
        b"solid x",
        b"OFFICE",
        b"PK\x03\x04",
        b"\xff\xfe1\x00",
    ] {
        assert_eq!(found(unknown, None), Err("unknown-format"));
    }
    // A format with a signature is none by its name.
    for name in ["a.las", "a.laz", "a.e57", "a.glb"] {
        assert_eq!(found(b"garbage", Some(name)), Err("unknown-format"));
    }
}

/// A cloud with everything in it; values that need all their digits.
fn full_cloud(points: usize) -> RawCloud {
    let mut rng = Rng::new(3);
    let mut floats = |n: usize| -> Vec<f32> { (0..n).map(|_| rng.normal() as f32).collect() };
    let mut cloud = RawCloud::new(Positions::F32(floats(3 * points)));
    cloud.normals = Some(floats(3 * points));
    cloud.attributes = vec![
        Attribute {
            name: "intensity".into(),
            values: floats(points),
        },
        Attribute {
            name: "scan_angle".into(),
            values: floats(points),
        },
    ];
    cloud.colors = Some((0..3 * points).map(|i| (i * 37 % 256) as u8).collect());
    cloud
}

/// The format that is written, of one that is read.
fn output(format: Format) -> Output {
    Output::from_name(format.name()).unwrap()
}

/// A text, or not, with nothing else chosen.
fn text(ascii: bool) -> WriteOptions {
    WriteOptions {
        ascii,
        ..Default::default()
    }
}

#[test]
fn what_is_written_reads_back_to_the_same_bits() {
    let mut cloud = full_cloud(257);
    for format in Format::WRITTEN {
        for ascii in [false, true] {
            let bytes = write(&cloud, None, output(format), text(ascii)).unwrap();
            assert_eq!(detect(&bytes, None).unwrap(), format);
            let mut back = read(&bytes, format).unwrap();
            back.columns.clear();
            assert_eq!(back, cloud, "{format:?} ascii {ascii}");
        }
    }
    let triangles = [0, 1, 2, 2, 1, 3];
    for ascii in [false, true] {
        let bytes = write(&cloud, Some(&triangles), Output::Ply, text(ascii)).unwrap();
        cloud.faces = 2;
        assert_eq!(read(&bytes, Format::Ply).unwrap(), cloud);
    }
}

#[test]
fn a_triangle_is_written_byte_for_byte() {
    let cloud = RawCloud::new(Positions::F32(vec![
        0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0,
    ]));
    let text = write(&cloud, Some(&[0, 1, 2]), Output::Ply, text(true)).unwrap();
    let expected = "ply\nformat ascii 1.0\ncomment Pointweave\nelement vertex 3\nproperty float x\nproperty float y\n\
                    property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
                    0.0 0.0 0.0\n1.0 0.0 0.0\n0.0 1.0 0.0\n3 0 1 2\n";
    assert_eq!(String::from_utf8(text).unwrap(), expected);
}

#[test]
fn names_of_attributes_never_clash() {
    let mut cloud = full_cloud(2);
    cloud.attributes[0].name = "red".into();
    cloud.attributes[1].name = "my value".into();
    for format in Format::WRITTEN {
        let bytes = write(&cloud, None, output(format), WriteOptions::default()).unwrap();
        let back = read(&bytes, format).unwrap();
        assert_eq!(back.colors, cloud.colors);
        assert_eq!(back.attributes.len(), 2, "{format:?}");
        assert_eq!(back.attributes[0].name, "red_");
        assert_eq!(back.attributes[1].name, "my_value");
    }
}

#[test]
fn arrays_of_the_wrong_length_are_not_written() {
    let mut cloud = full_cloud(2);
    cloud.colors = Some(vec![0; 5]);
    for format in Output::ALL {
        let error = write(&cloud, None, *format, WriteOptions::default()).unwrap_err();
        assert_eq!(error.code(), "bad-length");
    }
    let error = write(
        &full_cloud(3),
        Some(&[0, 1]),
        Output::Ply,
        WriteOptions::default(),
    )
    .unwrap_err();
    assert_eq!(error.code(), "bad-length");
}

#[test]
fn triangles_name_points_that_are_there() {
    for format in Output::ALL {
        let corners = Some(&[0, 1, 2, 2, 3, 0][..]);
        let error = write(&full_cloud(3), corners, *format, text(false)).unwrap_err();
        assert_eq!((error.code(), error.index()), ("bad-index", Some(4)));
        assert_eq!(error.found().as_deref(), Some("3"));
    }
}

#[test]
fn an_stl_file_needs_triangles() {
    let error = write(&full_cloud(3), None, Output::Stl, text(false)).unwrap_err();
    assert_eq!(error.code(), "needs-triangles");
    assert!(error.to_string().contains("PLY, XYZ, GLB"), "{error}");
    let bytes = write(&full_cloud(3), Some(&[]), Output::Stl, text(false)).unwrap();
    assert_eq!(bytes.len(), 84);
}

#[test]
fn what_a_format_cannot_hold_is_refused() {
    let mut cloud = full_cloud(3);
    cloud.attributes[1].values[2] = f32::INFINITY;
    let error = write(&cloud, None, Output::Glb, text(false)).unwrap_err();
    assert_eq!((error.code(), error.index()), ("non-finite", Some(2)));
    for format in [Output::Glb, Output::Stl] {
        let lost = RawCloud::new(Positions::F32(vec![0.0, 1.0, 2.0, 3.0, f32::NAN, 5.0]));
        let error = write(&lost, Some(&[0, 1, 0]), format, text(false)).unwrap_err();
        assert_eq!((error.code(), error.index()), ("non-finite", Some(1)));
    }
    let empty = RawCloud::new(Positions::F32(Vec::new()));
    let error = write(&empty, None, Output::Glb, text(false)).unwrap_err();
    assert_eq!(error.code(), "empty-cloud");
}

/// The text that an STL file starts with, without the blanks.
fn stl_text(cloud: &RawCloud) -> String {
    let bytes = write(cloud, Some(&[0, 1, 0]), Output::Stl, text(false)).unwrap();
    String::from_utf8(bytes[..80].to_vec())
        .unwrap()
        .trim()
        .into()
}

#[test]
fn the_origin_of_single_precision_has_few_digits() {
    let near = |origin: Option<[f64; 3]>, positions: Positions| RawCloud {
        origin,
        ..RawCloud::new(positions)
    };
    let small = vec![0.5, 0.25, -1.0, 2.0, 3.0, 4.0];
    let single = Positions::F32(small.iter().map(|&x| x as f32).collect());
    assert_eq!(stl_text(&near(None, single.clone())), "Pointweave");
    assert_eq!(
        stl_text(&near(None, Positions::F64(small.clone()))),
        "Pointweave"
    );
    // The cloud's own, to the last bit.
    let longest = [-2.2250738585072014e-308, 1.7976931348623157e308, 0.1];
    for positions in [single, Positions::F64(small.clone())] {
        let text = stl_text(&near(Some(longest), positions));
        assert_eq!(
            text,
            "at -2.2250738585072014e-308 1.7976931348623157e308 0.1"
        );
    }
    // One of its own: the sides are up to 5 long, so it is a multiple of 4.
    let far = [4_512_345.123, -543_211.789, 100.5];
    let georeferenced = (0..6).map(|k| small[k] + far[k % 3]).collect();
    let text = stl_text(&near(None, Positions::F64(georeferenced)));
    assert_eq!(text, "at 4512348.0 -543212.0 104.0");
}

#[test]
fn values_that_are_not_finite_are_counted() {
    let ply = b"ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n\
        property double time\nend_header\n0 0 0 1\nnan 0 0 2\n1 1 1 -1.#IND\n";
    let cloud = read(ply, Format::Ply).unwrap();
    assert_eq!((cloud.points(), cloud.dropped, cloud.replaced), (2, 1, 1));
    assert_eq!(cloud.attributes[0].values, [1.0, 0.0]);
    assert!(cloud.to_cloud().is_ok());
}

/// Small valid files of every kind.
fn small_files() -> Vec<(Format, Vec<u8>)> {
    let cloud = full_cloud(5);
    let mut files: Vec<(Format, Vec<u8>)> = Vec::new();
    for ascii in [false, true] {
        files.push((
            Format::Ply,
            write(&cloud, Some(&[0, 1, 2]), Output::Ply, text(ascii)).unwrap(),
        ));
    }
    files.push((
        Format::Xyz,
        write(&cloud, None, Output::Xyz, WriteOptions::default()).unwrap(),
    ));
    files.push((
        Format::Xyz,
        b"3\r\n0 0 0 1 9 8 7\r\n1 1 1 2 9 8 7\r\n\r\n2 2 2 3 9 8 7\r\n".to_vec(),
    ));
    let mut lists = b"ply\nformat binary_big_endian 1.0\nelement edge 2\nproperty list ushort short v\nproperty char c\n\
        element vertex 2\nproperty list uchar double w\nproperty float x\nproperty double y\nproperty int z\nend_header\n"
        .to_vec();
    for _ in 0..2 {
        lists.extend([0, 2, 1, 2, 3, 4, 5]);
    }
    for i in 0..2u8 {
        lists.push(i);
        lists.extend(vec![7; 8 * usize::from(i)]);
        lists.extend(1.5f32.to_be_bytes());
        lists.extend(2.5f64.to_be_bytes());
        lists.extend((-3i32).to_be_bytes());
    }
    files.push((Format::Ply, lists));
    files
}

#[test]
fn lists_and_elements_before_the_points_are_passed_over() {
    let (format, bytes) = small_files().pop().unwrap();
    let cloud = read(&bytes, format).unwrap();
    assert_eq!(
        cloud.positions,
        Positions::F32(vec![1.5, 2.5, -3.0, 1.5, 2.5, -3.0])
    );
}

#[test]
fn headers_of_many_dialects() {
    let header = |element: &str, end: &str| {
        let lines = [
            "ply",
            "comment a",
            "format binary_little_endian 1.0",
            "obj_info b",
            &format!("element {element} 1"),
            "comment c",
            "property uint8 X",
            "property uint8 y",
            "property int8 z",
            "element face 7",
            "property list uchar int vertex_indices",
            "end_header",
        ];
        lines
            .map(|line| format!("{line}{end}"))
            .concat()
            .into_bytes()
    };
    for end in ["\n", "\r\n", "\r"] {
        for element in ["vertex", "point"] {
            // The first value is the byte of a line feed.
            let bytes = [header(element, end), vec![10, 13, 255]].concat();
            let cloud = read(&bytes, Format::Ply).unwrap();
            assert_eq!(
                cloud.positions,
                Positions::F32(vec![10.0, 13.0, -1.0]),
                "{end:?}"
            );
            assert_eq!(cloud.faces, 7);
        }
    }
    for (bad, line) in [
        ("ply\nformat ascii 2.0\n", 2),
        ("ply\nformat text 1.0\n", 2),
        ("ply\nproperty float x\n", 2),
        ("ply\nelement vertex -1\n", 2),
        ("ply\nelement vertex 1\nproperty list float x\n", 3),
        ("ply\nelement vertex 1\nproperty word x\n", 3),
        ("ply\nend_header\n", 2),
        ("ply\nhello\n", 2),
        ("plyformat", 1),
    ] {
        let error = read(bad.as_bytes(), Format::Ply).unwrap_err();
        assert_eq!(
            (error.code(), error.index()),
            ("bad-file", Some(line)),
            "{bad:?}: {error}"
        );
    }
}

#[test]
fn rows_of_text_say_their_line() {
    let header = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n\
                  property list uchar int n\nend_header\n";
    for (rows, line) in [
        ("0 0 0 0\n1 1 1\n", 10),
        ("0 0 0 0\n\n1 1 1 1\n", 11),
        ("0 0 0 0\n1 1 1 1 5 6\n", 10),
        ("0 0 0 0\n1 1 a 0\n", 10),
        ("0 0 0 -1\n1 1 1 0\n", 9),
        ("0 0 0 0\n", 10),
    ] {
        let error = read(format!("{header}{rows}").as_bytes(), Format::Ply).unwrap_err();
        assert_eq!(
            (error.code(), error.index()),
            ("bad-file", Some(line)),
            "{rows:?}: {error}"
        );
    }
    let cloud = read(
        format!("{header}0 0 0 2 5 6\n1 1 1 0").as_bytes(),
        Format::Ply,
    )
    .unwrap();
    assert_eq!(cloud.points(), 2);
}

#[test]
fn truncated_files_give_a_typed_error_or_whole_points() {
    for (format, bytes) in small_files() {
        let whole = read(&bytes, format).unwrap().points();
        for length in 0..bytes.len() {
            match read(&bytes[..length], format) {
                Ok(cloud) => assert!(cloud.points() <= whole, "{length} of {}", bytes.len()),
                Err(error) => assert_eq!(error.code(), "bad-file", "{length}: {error}"),
            }
        }
    }
}

#[test]
fn damaged_files_never_panic() {
    let mut rng = Rng::new(11);
    for (format, bytes) in small_files() {
        for _ in 0..4000 {
            let mut damaged = bytes.clone();
            for _ in 0..1 + rng.next_u64() % 4 {
                let at = (rng.next_u64() % damaged.len() as u64) as usize;
                match rng.next_u64() % 3 {
                    0 => damaged[at] = rng.next_u64() as u8,
                    1 => drop(damaged.remove(at)),
                    _ => damaged.insert(at, b"0 9\n-ex."[(rng.next_u64() % 8) as usize]),
                }
            }
            if let Ok(cloud) = read(&damaged, format) {
                let numbers = values(&cloud.positions);
                assert!(numbers.iter().all(|x| x.is_finite()) && numbers.len().is_multiple_of(3));
            }
            let _ = detect(&damaged, None);
        }
    }
}

#[test]
fn a_header_that_lies_about_counts_reserves_nothing() {
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        for before in [
            "",
            "element face 18446744073709551615\nproperty list uint double v\n",
            "element nothing 18446744073709551615\n",
        ] {
            let text = format!(
                "ply\nformat {encoding} 1.0\n{before}element vertex 18446744073709551615\n\
                 property float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n"
            );
            let error = read(text.as_bytes(), Format::Ply).unwrap_err();
            assert_eq!(error.code(), "bad-file", "{encoding} {before}: {error}");
        }
    }
    let error = read(b"99999999999999999999\n1 2 3\n", Format::Xyz).unwrap_err();
    assert_eq!(error.code(), "bad-file");
}
