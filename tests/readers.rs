//! PCD, OBJ, OFF, STL, GLB, LAS, LAZ and E57: what each reads, and what each refuses. Files that others made are in
//! `files.rs`, damage of every kind in `fuzz`.
#![cfg(not(target_arch = "wasm32"))]

#[path = "fuzz/check.rs"]
mod check;
#[path = "common/made.rs"]
mod made;

use made::Kept;
use pointweave::base::rng::Rng;
use pointweave::formats::{
    FaceMode, Format, Positions, RawCloud, ReadOptions, Reading, detect, read, read_with,
};

fn values(cloud: &RawCloud) -> Vec<f64> {
    match &cloud.positions {
        Positions::F32(values) => values.iter().map(|&x| f64::from(x)).collect(),
        Positions::F64(values) => values.clone(),
    }
}

fn names(cloud: &RawCloud) -> Vec<&str> {
    cloud
        .attributes
        .iter()
        .map(|attribute| attribute.name.as_str())
        .collect()
}

/// Code and place of what a file fails with.
fn failure(bytes: &[u8], format: Format) -> (&'static str, Option<u64>) {
    let error = read(bytes, format).expect_err("the file is bad");
    (error.code(), error.index())
}

/// A PCD header for three points of these fields.
fn pcd(fields: &str, sizes: &str, types: &str, data: &str) -> Vec<u8> {
    format!("# .PCD v0.7\nVERSION 0.7\nFIELDS {fields}\nSIZE {sizes}\nTYPE {types}\nWIDTH 3\nHEIGHT 1\nPOINTS 3\nDATA {data}\n").into_bytes()
}

/// Each of these files breaks the rules at its line.
fn breaks_at(format: Format, files: &[(&str, u64)]) {
    for &(file, line) in files {
        let found = failure(file.as_bytes(), format);
        assert_eq!(found, ("bad-file", Some(line)), "{file}");
    }
}

#[test]
fn pcd_in_three_encodings_is_one_cloud() {
    let fields = ("label x y z rgb t", "1 4 4 4 4 8", "I F F F U F");
    let text = "-1 0 0.5 1 16711935 0.25\n2 nan 1 1 0 0\n3 3 4 5 255 -8\n";
    let ascii = [pcd(fields.0, fields.1, fields.2, "ascii"), text.into()].concat();
    let points: [(i8, [f32; 3], u32, f64); 3] = [
        (-1, [0.0, 0.5, 1.0], 0xff_00ff, 0.25),
        (2, [f32::NAN, 1.0, 1.0], 0, 0.0),
        (3, [3.0, 4.0, 5.0], 255, -8.0),
    ];
    let mut binary = pcd(fields.0, fields.1, fields.2, "binary");
    let mut columns: [Vec<u8>; 6] = Default::default();
    for (label, position, color, time) in points {
        let cells = [
            label.to_le_bytes().to_vec(),
            position[0].to_le_bytes().into(),
            position[1].to_le_bytes().into(),
            position[2].to_le_bytes().into(),
            color.to_le_bytes().into(),
            time.to_le_bytes().into(),
        ];
        for (column, cell) in columns.iter_mut().zip(cells) {
            binary.extend(&cell);
            column.extend(cell);
        }
    }
    // Literals of up to 32 bytes: packed by nothing, and still LZF.
    let unpacked = columns.concat();
    let packed: Vec<u8> = unpacked
        .chunks(32)
        .flat_map(|run| [&[run.len() as u8 - 1], run].concat())
        .collect();
    let mut compressed = pcd(fields.0, fields.1, fields.2, "binary_compressed");
    compressed.extend((packed.len() as u32).to_le_bytes());
    compressed.extend((unpacked.len() as u32).to_le_bytes());
    compressed.extend(&packed);

    let cloud = read(&ascii, Format::Pcd).unwrap();
    assert_eq!(values(&cloud), [0.0, 0.5, 1.0, 3.0, 4.0, 5.0]);
    assert_eq!(cloud.colors, Some(vec![255, 0, 255, 0, 0, 255]));
    assert_eq!(names(&cloud), ["label", "t"]);
    assert_eq!(
        (&cloud.attributes[0].values[..], cloud.dropped),
        (&[-1.0, 3.0][..], 1)
    );
    assert_eq!(read(&binary, Format::Pcd).unwrap(), cloud);
    assert_eq!(read(&compressed, Format::Pcd).unwrap(), cloud);

    for (file, at) in [
        (&binary, binary.len() - 25),
        (&compressed, compressed.len() - packed.len()),
    ] {
        let error = failure(&file[..file.len() - 1], Format::Pcd);
        assert_eq!(error, ("bad-file", Some(at as u64)));
    }
    let lie = |at: usize| {
        let mut file = compressed.clone();
        let at = file.len() - packed.len() - at;
        file[at..at + 4].copy_from_slice(&u32::MAX.to_le_bytes());
        failure(&file, Format::Pcd)
    };
    let start = (compressed.len() - packed.len()) as u64;
    assert_eq!(
        lie(4),
        ("bad-file", Some(start - 4)),
        "the size once unpacked"
    );
    assert_eq!(lie(8), ("bad-file", Some(start)), "the packed size");
}

#[test]
fn pcd_packs_colours_into_floats_and_has_georeferenced_text() {
    let text = format!(
        "0 0 0 {:e}\n1 1 1 {:e}\n2 2 2 0\n",
        f32::from_bits(0x01_0203),
        f32::from_bits(0xff_ffff)
    );
    let file = [pcd("x y z rgb", "4 4 4 4", "F F F F", "ascii"), text.into()].concat();
    assert_eq!(
        read(&file, Format::Pcd).unwrap().colors.unwrap()[..6],
        [1, 2, 3, 255, 255, 255]
    );
    let text =
        "289814.15,4320978.61,170.76\n289814.64 4320978.84 170.76\n289815.12\t4320979.06\t170.75\n";
    let file = [pcd("X Y Z", "4 4 4", "F F F", "ascii"), text.into()].concat();
    assert_eq!(
        values(&read(&file, Format::Pcd).unwrap())[..3],
        [289_814.15, 4_320_978.61, 170.76]
    );
}

#[test]
fn pcd_says_the_line_that_is_wrong() {
    let good = String::from_utf8(pcd("x y z", "4 4 4", "F F F", "ascii")).unwrap()
        + "0 0 0\n1 1 1\n2 2 2\n";
    assert_eq!(read(good.as_bytes(), Format::Pcd).unwrap().points(), 3);
    for (from, to, line) in [
        ("FIELDS x y z", "FIELDS x y w", 9),
        ("SIZE 4 4 4", "SIZE 4 4 3", 4),
        ("SIZE 4 4 4", "SIZE 4 4", 9),
        ("TYPE F F F", "TYPE F F X", 5),
        ("WIDTH 3", "WIDTH 4", 9),
        ("WIDTH 3", "WIDTH -3", 6),
        ("DATA ascii", "DATA text", 9),
        ("HEIGHT 1", "HEIGTH 1", 7),
        ("1 1 1", "1 1", 11),
        ("1 1 1", "1 1 1 1", 11),
        ("1 1 1", "1 a 1", 11),
        ("2 2 2\n", "", 12),
        ("DATA ascii\n0 0 0\n1 1 1\n2 2 2\n", "", 9),
    ] {
        assert_eq!(
            failure(good.replace(from, to).as_bytes(), Format::Pcd),
            ("bad-file", Some(line)),
            "{to}"
        );
    }
}

#[test]
fn obj_has_vertices_with_or_without_colours_and_normals() {
    let file = b"# c\nmtllib a.mtl\nv 1 2 3\nv 4 5 6 1 # a weight\nv 7 8 \\\n9\n\nvn 0 0 1\nvn 0 1 0\nvn 1 0 0\nvt 0 0\nf 1//1 2//2 3//3\nf 1/1/1 2/1/2 3/1/3\n";
    let cloud = read(file, Format::Obj).unwrap();
    assert_eq!(
        values(&cloud),
        [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]
    );
    assert_eq!(
        cloud.normals,
        Some(vec![0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0])
    );
    assert_eq!((cloud.colors, cloud.faces), (None, 2));
    // A face that takes another vertex's normal: normals are not the vertices'.
    let apart = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\nf 1//2 2//2 3//2\n";
    assert_eq!(read(apart, Format::Obj).unwrap().normals, None);
    let fewer = b"v 0 0 0\nv 1 0 0\nvn 0 0 1\n";
    assert_eq!(read(fewer, Format::Obj).unwrap().normals, None);
    for (colors, bytes) in [
        ("1 0 0.5", [255, 0, 128]),
        ("255 0 128", [255, 0, 128]),
        ("1 0 0.5 1", [255, 0, 128]),
    ] {
        let file = format!("v 0 0 0 {colors}\nv 1 1 1 0 0 0\n");
        assert_eq!(
            read(file.as_bytes(), Format::Obj).unwrap().colors.unwrap()[..3],
            bytes,
            "{colors}"
        );
    }
    breaks_at(
        Format::Obj,
        &[
            ("v 1 2\n", 1),
            ("o a\nv 1 2 x\n", 2),
            ("v 1 2 3 4 5\n", 1),
            ("v 1 2 3\nvn 0 1\n", 2),
            ("vt 0 0\n", 2),
        ],
    );
    assert_eq!(
        failure(b"\xfe\xff\0v", Format::Obj),
        ("unsupported-file", None)
    );
}

#[test]
fn off_says_in_its_first_word_what_a_vertex_has() {
    for (file, colors, normals) in [
        ("OFF\n2 1 0\n0 0 0\n1 2 3\n3 0 1 0\n", None, None),
        ("OFF 2 1 0\n0 0 0 # c\n\n1 2 3\n", None, None),
        (
            "OFF\n2 1 0\n0 0 0 255 0 0\n1 2 3 0 0 255\n",
            Some([255, 0, 0, 0, 0, 255]),
            None,
        ),
        (
            "COFF\n2 1\n0 0 0 1 0 0 1\n1 2 3 0 0 1.0 1\n",
            Some([255, 0, 0, 0, 0, 255]),
            None,
        ),
        (
            "NOFF\n2 1 0\n0 0 0 0 0 1\n1 2 3 0 1 0\n",
            None,
            Some([0.0, 0.0, 1.0, 0.0, 1.0, 0.0]),
        ),
        (
            "STCNOFF\n2 1 0\n0 0 0 0 0 1 9 8 7 255 .5 .5\n1 2 3 0 1 0 1 2 3 255 .5 .5\n",
            Some([9, 8, 7, 1, 2, 3]),
            Some([0.0, 0.0, 1.0, 0.0, 1.0, 0.0]),
        ),
    ] {
        let cloud =
            read(file.as_bytes(), Format::Off).unwrap_or_else(|error| panic!("{file}: {error}"));
        assert_eq!(values(&cloud), [0.0, 0.0, 0.0, 1.0, 2.0, 3.0], "{file}");
        assert_eq!(cloud.colors, colors.map(Vec::from), "{file}");
        assert_eq!(cloud.normals, normals.map(Vec::from), "{file}");
        assert_eq!((names(&cloud).len(), cloud.faces), (0, 1), "{file}");
    }
    breaks_at(
        Format::Off,
        &[
            ("", 1),
            ("OF\n", 1),
            ("OFF\n2\n", 2),
            ("OFF\n2 1 0\n0 0 0\n", 4),
            ("OFF\n2 1 0\n0 0 0\n1 2\n", 4),
            ("OFF\n2 1 0\n0 0 x\n", 3),
            ("OFF\n2 1 0\n0 0 0 1\n", 3),
            ("COFF\n2 1 0\n0 0 0\n", 3),
            ("OFF\n18446744073709551615 1 0\n0 0 0\n", 4),
        ],
    );
    assert_eq!(
        failure(b"OFF BINARY\n\0\0", Format::Off),
        ("unsupported-file", None)
    );
}

/// A binary STL file of triangles.
fn stl(triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut file = b"solid is how this header starts, too".to_vec();
    file.resize(80, 0);
    file.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        file.extend([0; 12]);
        file.extend(triangle.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
        file.extend([0; 2]);
    }
    file
}

#[test]
fn stl_has_each_place_once() {
    let square = [
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]],
        [[-0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
    ];
    let binary = stl(&square);
    let cloud = read(&binary, Format::Stl).unwrap();
    assert_eq!(
        values(&cloud),
        [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]
    );
    assert_eq!((cloud.faces, detect(&binary, None)), (2, Ok(Format::Stl)));
    let mut text = String::from("solid a\n");
    for triangle in square {
        text += "facet normal 0 0 1\n outer loop\n";
        for [x, y, z] in triangle {
            text += &format!("  VERTEX {x} {y:e} {z}\n");
        }
        text += " endloop\nendfacet\n";
    }
    text += "endsolid a\n";
    assert_eq!(read(text.as_bytes(), Format::Stl).unwrap(), cloud);

    assert_eq!(
        failure(&binary[..binary.len() - 1], Format::Stl),
        ("bad-file", Some(84))
    );
    let mut unnamed = binary.clone();
    unnamed[..5].copy_from_slice(b"alone");
    assert_eq!(
        failure(&unnamed[..binary.len() - 1], Format::Stl),
        ("bad-file", Some(84))
    );
    unnamed[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    assert_eq!(failure(&unnamed, Format::Stl), ("bad-file", Some(84)));
    assert_eq!(failure(b"short", Format::Stl), ("bad-file", Some(0)));
    for (from, to, line) in [
        ("0 0e0 0\n", "0 0e0\n", 4),
        (
            " endloop\nendfacet",
            "endfacet\nfacet\nvertex 1 1 1\nendfacet",
            10,
        ),
        ("endsolid a\n", "", 16),
        ("facet", "face", 2),
    ] {
        let bad = text.replacen(from, to, 1);
        assert_eq!(
            failure(bad.as_bytes(), Format::Stl),
            ("bad-file", Some(line)),
            "{bad}"
        );
    }
}

/// Values as bytes.
fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|x| x.to_le_bytes()).collect()
}

#[test]
fn glb_places_its_meshes() {
    // Two points, their normals, their colours as bytes; the second point again as a sparse value.
    let mut data = floats(&[0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    data.extend([255, 0, 0, 255, 0, 255, 0, 255]);
    let json = r#"{
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 2, "type": "VEC3"},
            {"bufferView": 0, "byteOffset": 24, "componentType": 5126, "count": 2, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5121, "normalized": true, "count": 2, "type": "VEC4"},
            {"bufferView": 1, "componentType": 5121, "count": 6, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 8}],
        "buffers": [{"byteLength": 56}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "COLOR_0": 2}, "indices": 3}]}],
        "nodes": [
            {"mesh": 0, "children": [1]},
            {"mesh": 0, "translation": [10, 0, 0], "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476], "scale": [2, 1, 1]},
            {"mesh": 0}],
        "scene": 0, "scenes": [{"nodes": [0]}]}"#;
    let file = made::glb(json, &data);
    let cloud = read(&file, Format::Glb).unwrap();
    let expected = [0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 10.0, 0.0, 0.0, 8.0, 2.0, 3.0];
    assert!(
        values(&cloud)
            .iter()
            .zip(expected)
            .all(|(x, y)| (x - y).abs() < 1e-6),
        "{:?}",
        values(&cloud)
    );
    let normals = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0];
    assert!(
        cloud
            .normals
            .unwrap()
            .iter()
            .zip(normals)
            .all(|(x, y): (&f32, f32)| (x - y).abs() < 1e-6)
    );
    assert_eq!(cloud.colors, Some([255, 0, 0, 0, 255, 0].repeat(2)));
    assert_eq!(cloud.faces, 4);

    let change =
        |from: &str, to: &str| failure(&made::glb(&json.replacen(from, to, 1), &data), Format::Glb);
    for (from, to) in [
        ("\"count\": 2", "\"count\": 9999999"),
        ("\"byteLength\": 48", "\"byteLength\": 480"),
        ("\"byteLength\": 48", "\"byteLength\": 18446744073709551615"),
        // Found by fuzzing: fewer normals than positions.
        (
            "\"byteOffset\": 24, \"componentType\": 5126, \"count\": 2",
            "\"byteOffset\": 24, \"componentType\": 5126, \"count\": 1",
        ),
        ("\"bufferView\": 0", "\"bufferView\": 7"),
        ("\"byteOffset\": 24", "\"byteOffset\": 49"),
        ("\"componentType\": 5126", "\"componentType\": 5124"),
        ("\"POSITION\": 0", "\"POSITION\": 9"),
        ("\"children\": [1]", "\"children\": [0]"),
        ("\"children\": [1]", "\"children\": [5]"),
        ("\"mesh\": 0", "\"mesh\": 1"),
        ("{", "["),
    ] {
        assert_eq!(change(from, to).0, "bad-file", "{to}");
    }
    let all = "\"count\": 18446744073709551615";
    assert_eq!(change("\"count\": 2", all).0, "unsupported-file");
    let many = format!(
        "\"children\": [{}]",
        (1..=200)
            .map(|i| i.to_string())
            .collect::<Vec<_>>()
            .join(",")
    );
    let nodes = ",{\"mesh\": 0}".repeat(200);
    let crowd = json
        .replace("\"children\": [1]", &many)
        .replace("{\"mesh\": 0}]", &format!("{{\"mesh\": 0}}{nodes}]"));
    let crowd = crowd.replacen("\"count\": 2", "\"count\": 1000000", 1);
    assert_eq!(
        failure(&made::glb(&crowd, &data), Format::Glb).0,
        "unsupported-file",
        "200 million points of 56 bytes"
    );
    let draco = "{ \"extensionsRequired\": [\"KHR_draco_mesh_compression\"],";
    assert_eq!(change("{", draco).0, "unsupported-file");
    assert_eq!(
        change(
            "\"byteLength\": 56",
            "\"byteLength\": 56, \"uri\": \"a.bin\""
        )
        .0,
        "unsupported-file"
    );
    for length in 0..file.len() {
        assert!(
            read(&file[..length], Format::Glb).is_err(),
            "{length} bytes"
        );
    }
}

#[test]
fn glb_has_quantised_and_sparse_positions() {
    let json = r#"{
        "accessors": [
            {"bufferView": 0, "componentType": 5122, "normalized": true, "count": 2, "type": "VEC3"},
            {"componentType": 5126, "count": 3, "type": "VEC3", "sparse": {"count": 1,
                "indices": {"bufferView": 1, "componentType": 5121}, "values": {"bufferView": 1, "byteOffset": 4}}}],
        "bufferViews": [{"buffer": 0, "byteLength": 16, "byteStride": 8}, {"buffer": 0, "byteOffset": 16, "byteLength": 16}],
        "buffers": [{"byteLength": 32}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 0}]}, {"primitives": [{"attributes": {"POSITION": 1}, "mode": 0}]}]}"#;
    let mut data: Vec<u8> = [32767i16, -32767, -32768, 9, 0, 16384, 0, 9]
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    data.extend([1, 0, 0, 0]);
    data.extend(floats(&[4.0, 5.0, 6.0]));
    let cloud = read(&made::glb(json, &data), Format::Glb).unwrap();
    let half = 16384.0 / 32767.0;
    let expected = [
        1.0, -1.0, -1.0, 0.0, half, 0.0, 0.0, 0.0, 0.0, 4.0, 5.0, 6.0, 0.0, 0.0, 0.0,
    ];
    assert!(
        values(&cloud)
            .iter()
            .zip(expected)
            .all(|(x, y)| (x - y).abs() < 1e-6),
        "{:?}",
        values(&cloud)
    );
    assert_eq!(cloud.faces, 0);
}

#[test]
fn an_off_file_of_no_vertices_has_no_points() {
    for (file, faces) in [("OFF\n0 0 0\n", 0), ("OFF 0 2 0\n3 0 1 2\n4 0 1 2 3\n", 2)] {
        for mode in [FaceMode::Sample, FaceMode::Vertices] {
            let options = ReadOptions {
                faces: mode,
                ..ReadOptions::default()
            };
            let cloud = read_with(file.as_bytes(), Format::Off, &options).unwrap();
            assert_eq!((cloud.points(), cloud.faces), (0, faces), "{file}");
        }
    }
}

#[test]
fn las_and_laz_of_every_point_format() {
    for format in 0..=10 {
        let version = if format < 6 { (1, 3) } else { (1, 4) };
        let file = made::las(format, 70, version, false);
        let cloud =
            read(&file, Format::Las).unwrap_or_else(|error| panic!("format {format}: {error}"));
        assert_eq!(cloud.points(), 70);
        let positions = values(&cloud);
        for i in [0, 1, 69] {
            let place = made::position(i).map(f64::from);
            let expected = [
                place[0] * 0.001 + 400_000.0,
                place[1] * 0.001 + 5_000_000.0,
                place[2] * 0.001 + 100.0,
            ];
            assert_eq!(positions[3 * i..3 * i + 3], expected, "format {format}");
        }
        assert!(matches!(cloud.positions, Positions::F64(_)));
        let has_nir = [8, 10].contains(&format);
        let has_times = ![0, 2].contains(&format);
        let expected = [
            ("intensity", true),
            ("classification", true),
            ("nir", has_nir),
            ("gps_time", has_times),
        ];
        let expected = expected.into_iter().filter(|(_, has)| *has);
        let expected: Vec<&str> = expected.map(|(name, _)| name).collect();
        assert_eq!(names(&cloud), expected, "format {format}");
        assert_eq!(cloud.attributes[0].values[3], 31_676.0);
        assert_eq!(cloud.attributes[1].values[5], 5.0);
        let colored = [2, 3, 5, 7, 8, 10].contains(&format);
        let red = (39_595.0 / 257.0_f64).round() as u8;
        assert_eq!(
            cloud.colors.as_ref().map(|colors| colors[9]),
            colored.then_some(red),
            "format {format}"
        );
        // The crate writes no packed waveforms.
        if ![4, 5, 9, 10].contains(&format) {
            let packed = made::las(format, 70, version, true);
            let expected = cloud;
            let unpacked = read(&packed, Format::Las).unwrap();
            for (found, expected) in unpacked.attributes.iter().zip(&expected.attributes) {
                assert_eq!(found, expected, "format {format}");
            }
            assert_eq!(unpacked, expected, "format {format}");
        }
    }
}

#[test]
fn las_headers_that_lie() {
    let file = made::las(3, 20, (1, 2), false);
    let packed = made::las(3, 20, (1, 2), true);
    let with = |file: &[u8], at: usize, bytes: &[u8]| {
        let mut file = file.to_vec();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        file
    };
    let start = u32::from_le_bytes(file[96..100].try_into().unwrap()) as u64;
    for file in [&file, &packed] {
        assert_eq!(
            failure(&with(file, 0, b"LASX"), Format::Las),
            ("bad-file", Some(0))
        );
        assert_eq!(
            failure(&with(file, 25, &[5]), Format::Las),
            ("unsupported-file", None)
        );
        assert_eq!(
            failure(&with(file, 104, &[11]), Format::Las),
            ("unsupported-file", None)
        );
        assert_eq!(
            failure(&with(file, 105, &[3, 0]), Format::Las),
            ("bad-file", Some(105))
        );
        assert_eq!(
            failure(&with(file, 131, &f64::NAN.to_le_bytes()), Format::Las),
            ("bad-file", Some(131))
        );
        assert_eq!(
            failure(&with(file, 96, &u32::MAX.to_le_bytes()), Format::Las),
            ("bad-file", Some(96))
        );
        assert_eq!(
            failure(&with(file, 107, &u32::MAX.to_le_bytes()), Format::Las).0,
            "bad-file"
        );
        assert_eq!(failure(&file[..100], Format::Las).0, "bad-file");
    }
    // Any number of variable length records is of no account, and so is the header's own size.
    for (at, bytes) in [(100, u32::MAX.to_le_bytes().to_vec()), (94, vec![255, 255])] {
        assert_eq!(
            read(&with(&file, at, &bytes), Format::Las)
                .unwrap()
                .points(),
            20
        );
    }
    assert_eq!(
        failure(&with(&packed, 100, &[0; 4]), Format::Las).0,
        "bad-file"
    );
    assert_eq!(
        failure(&file[..file.len() - 1], Format::Las),
        ("bad-file", Some(file.len() as u64 - 1))
    );
    assert!(start >= 227);
    // Colours that are all 0 say nothing.
    let mut black = file.clone();
    for record in black[start as usize..].chunks_exact_mut(34) {
        record[28..].fill(0);
    }
    assert_eq!(read(&black, Format::Las).unwrap().colors, None);
    // Bytes as colours, where none is above 255.
    let mut dark = file;
    for record in dark[start as usize..].chunks_exact_mut(34) {
        record[28..].copy_from_slice(&[200, 0, 1, 0, 0, 0]);
    }
    assert_eq!(
        read(&dark, Format::Las).unwrap().colors.unwrap()[..3],
        [200, 1, 0]
    );
}

#[test]
fn e57_places_its_scans() {
    for kept in [Kept::Single, Kept::Double, Kept::Scaled, Kept::Spherical] {
        // The last scan is so small that its packets have no whole point of some field, which the crate stumbles over.
        let file = made::e57(&[(kept, 10), (kept, 5), (kept, 3)]);
        let cloud = read(&file, Format::E57).unwrap_or_else(|error| panic!("{kept:?}: {error}"));
        let (first, dropped) = if kept == Kept::Spherical {
            (10, 0)
        } else {
            (8, 3)
        };
        let single = matches!(cloud.positions, Positions::F32(_));
        assert!(!single, "{kept:?}: a pose needs double precision");
        assert_eq!(
            (cloud.points(), cloud.dropped),
            (18 - dropped, dropped),
            "{kept:?}"
        );
        let positions = values(&cloud);
        let near = |found: &[f64], expected: [f64; 3]| {
            found
                .iter()
                .zip(expected)
                .all(|(x, y)| (x - y).abs() < 1e-5)
        };
        let [x, y, z] = made::position(3).map(|x| f64::from(x) * 0.001);
        assert!(
            near(&positions[9..12], [x, y, z]),
            "{kept:?}: {:?}",
            &positions[9..12]
        );
        // The second scan: turned by 90° around z, then moved.
        let at = 3 * (first + 3);
        assert!(
            near(&positions[at..at + 3], [10.0 - y, 20.0 + x, 30.0 + z]),
            "{kept:?}: {:?}",
            &positions[at..at + 3]
        );
        let normals = cloud.normals.unwrap();
        assert_eq!(normals[..3], [1.0, 0.0, 0.0]);
        assert!((normals[at] - 0.0).abs() < 1e-6 && (normals[at + 1] - 1.0).abs() < 1e-6);
        assert_eq!(cloud.colors.unwrap()[9..12], [3, 252, 7]);
        assert_eq!(
            (
                cloud.attributes[0].name.as_str(),
                cloud.attributes[0].values[3]
            ),
            ("intensity", 3.0)
        );
    }
}

#[test]
fn e57_values_beyond_the_known_ones_and_its_invalid_states() {
    const POINTS: usize = 42;
    let cloud = read(&made::e57_with_extras(POINTS), Format::E57).unwrap();
    let valid: Vec<usize> = (0..POINTS).filter(|i| i % 7 != 6 && i % 3 != 2).collect();
    assert_eq!(cloud.points(), 2 * valid.len());
    assert_eq!(
        cloud.skipped,
        [("invalid", 2 * (POINTS - valid.len()) as u64)]
    );
    // Columns that are all 0 are none; the scan without values has 0.
    let of = |value: &dyn Fn(usize) -> f32| -> Vec<f32> {
        let first = valid.iter().map(|&i| value(i));
        first.chain(valid.iter().map(|_| 0.0)).collect()
    };
    assert_eq!(names(&cloud), ["rowIndex", "timeStamp", "temperature"]);
    assert_eq!(cloud.attributes[0].values, of(&|i| i as f32 % 10.0));
    assert_eq!(cloud.attributes[1].values, of(&|i| i as f32));
    assert_eq!(cloud.attributes[2].values, of(&|i| 20.5 + i as f32));
}

#[test]
fn e57_in_single_precision_stays_so() {
    let cloud = read(&made::e57(&[(Kept::Single, 10)]), Format::E57).unwrap();
    assert!(matches!(cloud.positions, Positions::F32(_)));
    let cloud = read(&made::e57(&[(Kept::Scaled, 10)]), Format::E57).unwrap();
    assert!(matches!(cloud.positions, Positions::F64(_)));
}

#[test]
fn e57_headers_that_lie() {
    let file = made::e57(&[(Kept::Double, 20)]);
    assert_eq!(detect(&file, None), Ok(Format::E57));
    for length in [0, 20, 48, 1000, file.len() / 2, file.len() - 1] {
        assert_eq!(
            failure(&file[..length], Format::E57).0,
            "bad-file",
            "{length} bytes"
        );
    }
    // The directory has a checksum for each page: one changed byte is found.
    for at in [8, 24, 32, 40, file.len() - 600] {
        let mut bad = file.clone();
        bad[at] ^= 0x40;
        assert_eq!(failure(&bad, Format::E57).0, "bad-file", "byte {at}");
    }
}

#[test]
fn damaged_files_never_panic() {
    let mut rng = Rng::new(5);
    let pcd = [
        pcd("x y z rgb", "4 4 4 4", "F F F U", "binary"),
        vec![7; 48],
    ]
    .concat();
    let json = r#"{"accessors":[{"bufferView":0,"componentType":5126,"count":2,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":24}],"buffers":[{"byteLength":24}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0,"scale":[2,2,2]}],"scenes":[{"nodes":[0]}]}"#;
    let files = [
        (Format::Pcd, pcd),
        (
            Format::Obj,
            b"v 1 2 3 1 1 1\nvn 0 0 1\nf 1//1 1//1 1//1\n".to_vec(),
        ),
        (
            Format::Off,
            b"COFF\n2 1 0\n0 0 0 1 1 1\n1 1 1 0 0 0\n".to_vec(),
        ),
        (Format::Stl, stl(&[[[0.0; 3], [1.0; 3], [2.0; 3]]])),
        (Format::Glb, made::glb(json, &[63; 24])),
        (Format::Las, made::las(3, 5, (1, 2), false)),
        (Format::Las, made::las(3, 40, (1, 2), true)),
        (Format::Las, made::las(7, 40, (1, 4), true)),
        (Format::E57, made::e57(&[(Kept::Scaled, 6)])),
        (
            Format::Xyz,
            b"id;x;y;z;rgb;a\n1;0,5;1;2;#ff8000;\n2;1,5;1;2;#ff8000;3\n".to_vec(),
        ),
        (
            Format::Grid,
            b"ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n".to_vec(),
        ),
        (
            Format::Ptx,
            b"1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 2 3 0.5\n"
                .to_vec(),
        ),
    ];
    for (format, bytes) in files {
        for _ in 0..500 {
            let mut damaged = bytes.clone();
            for _ in 0..1 + rng.next_u64() % 4 {
                let at = (rng.next_u64() % damaged.len() as u64) as usize;
                match rng.next_u64() % 4 {
                    0 => damaged[at] = rng.next_u64() as u8,
                    1 => damaged[at] ^= 1 << (rng.next_u64() % 8),
                    2 => drop(damaged.remove(at)),
                    _ => damaged.insert(at, b"0 9\n-ex."[(rng.next_u64() % 8) as usize]),
                }
            }
            check::check(&damaged, &[format]);
        }
    }
}

/// Found by fuzzing: a list longer than the file ended the reading early, with a count of the bytes at hand for those of the file.
#[test]
fn what_is_missing_is_counted_to_the_end_of_the_file_in_slices_too() {
    let header = b"ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list uint int v\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    let file = [&header[..], &[255; 40]].concat();
    let whole = read(&file, Format::Ply).expect_err("the list is too long");
    let mut reading = Reading::new(Some(Format::Ply), None, file.len() as u64);
    let sliced = file
        .chunks(header.len() + 8)
        .find_map(|slice| reading.push(slice).err());
    assert_eq!(sliced, Some(whole));
}

/// Found by fuzzing: damaged times switched from sequence to sequence until the crate's decoder had no stack left.
#[test]
fn damaged_times_do_not_overflow_the_stack() {
    // A chunk of format 1 whose times' first codes are what a stream of ones decodes to: the last, which switches.
    for format in [1, 3, 6, 7] {
        let version = if format < 6 { (1, 3) } else { (1, 4) };
        let whole = made::las(format, 4000, version, true);
        let mut rng = Rng::new(9);
        let start = whole.len() / 3;
        for fill in [0x00, 0xff, 0x55] {
            for _ in 0..20 {
                let mut damaged = whole.clone();
                let at = start + (rng.next_u64() % (whole.len() / 2) as u64) as usize;
                damaged[at..].fill(fill);
                check::check(&damaged, &[Format::Las]);
            }
        }
    }
}

/// Found while fuzzing: zeros unpack to the same point over and over, hundreds a byte, as long as the header wants more.
#[test]
fn no_more_points_are_unpacked_than_a_scan_is_packed_to() {
    let packed = made::las(0, 30, (1, 3), true);
    let start = u32::from_le_bytes(*packed[96..].first_chunk().unwrap()) as usize;
    let user = b"laszip encoded";
    let record = packed.windows(user.len()).position(|w| w == user).unwrap() - 2;
    let bomb = |points: u32| {
        let mut file = packed[..start].to_vec();
        file[107..111].copy_from_slice(&points.to_le_bytes());
        // All points are one chunk.
        file[record + 54] = 1;
        file.extend([0; 4000]);
        file
    };
    let (code, at) = failure(&bomb(u32::MAX), Format::Las);
    assert_eq!((code, at), ("bad-file", Some(start as u64)));
    check::check(&bomb(u32::MAX), &[Format::Las]);
    assert_eq!(read(&bomb(100_000), Format::Las).unwrap().points(), 100_000);
}

/// Found by reading: a stride of 0 made any number of points of the bytes of one.
#[test]
fn a_stride_of_zero_is_none() {
    let file = |count: usize| {
        let json = format!(
            r#"{{"accessors":[{{"bufferView":0,"componentType":5126,"count":{count},"type":"VEC3"}}],"bufferViews":[{{"buffer":0,"byteLength":24,"byteStride":0}}],"buffers":[{{"byteLength":24}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],"nodes":[{{"mesh":0}}],"scenes":[{{"nodes":[0]}}]}}"#
        );
        made::glb(&json, &[63; 24])
    };
    assert_eq!(read(&file(2), Format::Glb).unwrap().points(), 2);
    assert_eq!(failure(&file(3), Format::Glb).0, "bad-file");
    assert_eq!(failure(&file(1 << 26), Format::Glb).0, "bad-file");
}

/// Found by fuzzing: whether a file was text depended on how many bytes of it were at hand.
#[test]
fn stl_is_told_from_its_first_bytes_alone() {
    let file = [" ".repeat(100).as_bytes(), b"solid a\nendsolid a\n"].concat();
    check::check(&file, &[Format::Stl]);
}
