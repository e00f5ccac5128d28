//! PTX, elevation grids, splats, and what is packed as a whole: GeoTIFF, 3MF, SPZ, archives.
#![cfg(not(target_arch = "wasm32"))]

use miniz_oxide::deflate::compress_to_vec;
use pointweave::cloud::Unit;
use pointweave::formats::{
    Archive, FaceMode, Format, Positions, RawCloud, ReadOptions, Reading, detect, read, read_with,
};
use std::io::Cursor;
use tiff::encoder::{Compression, DeflateLevel, TiffEncoder, colortype};
use tiff::tags::Tag;

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

/// Reads a file whole and in small slices: the same count.
fn both(bytes: &[u8], format: Format) -> RawCloud {
    let whole = read(bytes, format).unwrap_or_else(|error| panic!("{error}"));
    let mut reading = Reading::new(Some(format), None, bytes.len() as u64)
        .with_options(vertices())
        .expect("options");
    for slice in bytes.chunks(7) {
        reading
            .push(slice)
            .unwrap_or_else(|error| panic!("{error}"));
    }
    while !reading.end().unwrap_or_else(|error| panic!("{error}")) {}
    assert_eq!(reading.summary().points, whole.points() as u64);
    whole
}

fn code(bytes: &[u8], format: Format) -> &'static str {
    read(bytes, format).expect_err("no such file").code()
}

const PTX: &str = "2\n2\n10 20 30\n1 0 0\n0 1 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n10 20 30 1\n1 2 3 0.5\n0 0 0 0.5\n4 5 6 0.25\n0 0 0 0.5\n1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 100 1\n7 8 9 1\n";

#[test]
fn scans_of_a_ptx_file_are_at_their_poses() {
    assert_eq!(detect(PTX.as_bytes(), None), Ok(Format::Ptx));
    let cloud = both(PTX.as_bytes(), Format::Ptx);
    // A point is a row before the matrix: x goes to y, y to -x.
    assert_eq!(
        values(&cloud),
        [8.0, 21.0, 33.0, 5.0, 24.0, 36.0, 7.0, 8.0, 109.0]
    );
    assert_eq!(cloud.attributes[0].values, [0.5, 0.25, 1.0]);
    assert_eq!(cloud.colors, None);
    assert_eq!(cloud.skipped, [("no-return", 2)]);
    let options = ReadOptions {
        keep_sentinels: true,
        ..Default::default()
    };
    let kept = read_with(PTX.as_bytes(), Format::Ptx, &options).expect("a PTX file");
    assert_eq!(values(&kept)[3..6], [10.0, 20.0, 30.0]);
    let colored = PTX
        .replace("1 2 3 0.5", "1 2 3 0.5 9 8 7")
        .replace("0 0 0 0.5", "0 0 0 0.5 0 0 0")
        .replace("4 5 6 0.25", "4 5 6 0.25 1 2 3")
        .replace("7 8 9 1", "7 8 9 1 255 0 1");
    assert_eq!(
        both(colored.as_bytes(), Format::Ptx).colors,
        Some(vec![9, 8, 7, 1, 2, 3, 255, 0, 1])
    );
    for bad in [
        &PTX[..PTX.len() - 8],
        &PTX[..60],
        "2\n2\n",
        &PTX.replace("1 2 3 0.5", "1 2"),
        &PTX.replacen("2\n", "-2\n", 1),
    ] {
        assert_eq!(code(bad.as_bytes(), Format::Ptx), "bad-file", "{bad}");
    }
}

const GRID: &str = "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 10\nNODATA_value -9999\n1 2 3\n4 -9999 6\n";

#[test]
fn a_scan_of_a_ptx_file_without_colours_is_white() {
    let head = "1\n2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n5 6 7 1\n";
    let file =
        format!("{head}1 2 3 0.5 255 128 0\n2 2 3 0.5 255 128 0\n{head}1 2 4 0.25\n2 2 4 0.25\n");
    let cloud = both(file.as_bytes(), Format::Ptx);
    let colors = [[255, 128, 0]; 2].into_iter().chain([[255; 3]; 2]);
    assert_eq!(cloud.colors, Some(colors.flatten().collect()));
    assert_eq!(cloud.attributes[0].values, [0.5, 0.5, 0.25, 0.25]);
    let fine = file.replace("255 128 0", "65535 32896 0");
    assert_eq!(both(fine.as_bytes(), Format::Ptx).colors, cloud.colors);
    // Points alone have no intensity.
    let bare = format!("{head}1 2 3\n2 2 3\n");
    assert!(both(bare.as_bytes(), Format::Ptx).attributes.is_empty());
}

#[test]
fn heights_of_an_ascii_grid_are_in_the_middles_of_their_cells() {
    assert_eq!(detect(GRID.as_bytes(), Some("dem.asc")), Ok(Format::Grid));
    let cloud = both(GRID.as_bytes(), Format::Grid);
    let expected = [
        105.0, 215.0, 1.0, 115.0, 215.0, 2.0, 125.0, 215.0, 3.0, 105.0, 205.0, 4.0, 125.0, 205.0,
        6.0,
    ];
    assert_eq!(values(&cloud), expected);
    assert_eq!(cloud.skipped, [("no-data", 1)]);
    let middle = GRID
        .replace("corner", "center")
        .replace("NCOLS", "ncols")
        .replace("1 2 3\n4", "1 2\n3 4");
    assert_eq!(
        values(&both(middle.as_bytes(), Format::Grid))[..3],
        [100.0, 210.0, 1.0]
    );
    let sides = GRID.replace("cellsize 10", "dx 10\ndy 5");
    assert_eq!(
        values(&both(sides.as_bytes(), Format::Grid))[..3],
        [105.0, 207.5, 1.0]
    );
    // Other orders, colons, decimal commas, GRASS's edges, Surfer's ranges from the south on.
    let rows = "1 2 3\n4 -9999 6\n";
    for other in [
        format!("nrows 2\nncols 3\nxllcorner 100\nyllcorner 200\ncellsize 10\n{rows}"),
        format!("ncols: 3\nnrows: 2\nxllcorner: 100\nyllcorner: 200\ncellsize: 10\n{rows}"),
        format!(
            "ncols 3\nnrows 2\nxllcorner 100,0\nyllcorner 200,0\ncellsize 10,0\n{}",
            "1,0 2,0 3,0\n4,0 -9999,0 6,0\n"
        ),
        format!(
            "north: 220\nsouth: 200\neast: 130\nwest: 100\nrows: 2\ncols: 3\n{}",
            rows.replace("-9999", "*")
        ),
        "DSAA\n3 2\n105 125\n205 215\n1 6\n4 1.70141e+38 6\n1 2 3\n".into(),
    ] {
        assert_eq!(detect(other.as_bytes(), None), Ok(Format::Grid), "{other}");
        let cloud = both(other.as_bytes(), Format::Grid);
        let mut points: Vec<[f64; 3]> = values(&cloud).as_chunks().0.to_vec();
        points.sort_by(|a, b| a[2].total_cmp(&b[2]));
        assert_eq!(points.as_flattened(), expected, "{other}");
        assert_eq!(cloud.skipped, [("no-data", 1)], "{other}");
    }
    for bad in [
        "DSAA\n3 2\n105 125\n205 x\n".into(),
        GRID.replace(" 6\n", "\n"),
        GRID.replace("cellsize", "size"),
        GRID.replace("nrows 2", "nrows -2"),
        GRID.replace("nrows 2\n", ""),
        GRID.replace("2 3", "2 x"),
        "ncols 3\n".into(),
    ] {
        assert_eq!(code(bad.as_bytes(), Format::Grid), "bad-file", "{bad}");
    }
}

/// A GeoTIFF of 5 columns and 4 rows with heights 0, 1, 2 ….
fn tiff(
    compression: Compression,
    strip: u32,
    tags: &[(Tag, Vec<f64>)],
    missing: Option<&str>,
) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes)
        .expect("an encoder")
        .with_compression(compression);
    let mut image = encoder
        .new_image::<colortype::Gray32Float>(5, 4)
        .expect("an image");
    for (tag, values) in tags {
        if *tag == Tag::GeoKeyDirectoryTag {
            let keys: Vec<u16> = values.iter().map(|value| *value as u16).collect();
            image.encoder().write_tag(*tag, &keys[..]).expect("a tag");
        } else {
            image.encoder().write_tag(*tag, &values[..]).expect("a tag");
        }
    }
    if let Some(missing) = missing {
        image
            .encoder()
            .write_tag(Tag::GdalNodata, missing)
            .expect("a tag");
    }
    image.rows_per_strip(strip).expect("strips");
    let heights: Vec<f32> = (0..20u8).map(f32::from).collect();
    image.write_data(&heights).expect("heights");
    bytes.into_inner()
}

#[test]
fn heights_of_a_geotiff_are_where_it_says() {
    let scale = (Tag::ModelPixelScaleTag, vec![2.0, 3.0, 0.0]);
    let tie = (
        Tag::ModelTiepointTag,
        vec![0.0, 0.0, 0.0, 1000.0, 5000.0, 0.0],
    );
    let matrix = vec![
        2.0, 0.0, 0.0, 1000.0, 0.0, -3.0, 0.0, 5000.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0,
    ];
    for compression in [
        Compression::Uncompressed,
        Compression::Lzw,
        Compression::Deflate(DeflateLevel::Balanced),
        Compression::Packbits,
    ] {
        for strip in [4, 3, 1] {
            for tags in [
                vec![scale.clone(), tie.clone()],
                vec![(Tag::ModelTransformationTag, matrix.clone())],
            ] {
                let file = tiff(compression, strip, &tags, Some("7"));
                assert_eq!(detect(&file, None), Ok(Format::Tiff));
                let cloud = both(&file, Format::Tiff);
                assert_eq!(
                    (cloud.points(), cloud.skipped.clone()),
                    (19, vec![("no-data", 1)])
                );
                assert_eq!(
                    values(&cloud)[..6],
                    [1001.0, 4998.5, 0.0, 1003.0, 4998.5, 1.0]
                );
                assert_eq!(values(&cloud)[54..], [1009.0, 4989.5, 19.0]);
            }
        }
    }
    // The reference system tells the unit; the text of what is no data has more digits than a cell.
    let keys = [1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 25832].map(f64::from);
    let tags = [
        scale.clone(),
        tie.clone(),
        (Tag::GeoKeyDirectoryTag, keys.into()),
    ];
    let cloud = both(
        &tiff(Compression::Lzw, 4, &tags, Some("7.0000001")),
        Format::Tiff,
    );
    assert_eq!((cloud.points(), cloud.unit), (19, Some(Unit::Metre)));
    assert!(cloud.crs.is_some());
    let bare = tiff(Compression::Uncompressed, 4, &[], None);
    assert_eq!(values(&both(&bare, Format::Tiff))[..3], [0.5, -0.5, 0.0]);
    let whole = tiff(Compression::Lzw, 2, &[scale, tie], None);
    for length in [8, 40, whole.len() / 2] {
        assert_eq!(code(&whole[..length], Format::Tiff), "bad-file", "{length}");
    }
    let mut picture = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut picture).expect("an encoder");
    encoder
        .write_image::<colortype::RGB8>(2, 2, &[9; 12])
        .expect("a picture");
    assert_eq!(
        code(&picture.into_inner(), Format::Tiff),
        "unsupported-file"
    );
}

/// A ZIP file; `packed` deflates.
fn zip(files: &[(&str, &[u8])], packed: bool) -> Vec<u8> {
    let (mut bytes, mut directory) = (Vec::new(), Vec::new());
    for (name, content) in files {
        let body = if packed {
            compress_to_vec(content, 6)
        } else {
            content.to_vec()
        };
        let method = if packed { 8u16 } else { 0 };
        let mut common = Vec::new();
        common.extend(
            [20u16, 0, method, 0, 0]
                .iter()
                .flat_map(|x| x.to_le_bytes()),
        );
        common.extend(
            [0u32, body.len() as u32, content.len() as u32]
                .iter()
                .flat_map(|x| x.to_le_bytes()),
        );
        common.extend([name.len() as u16, 0].iter().flat_map(|x| x.to_le_bytes()));
        directory.extend(b"PK\x01\x02\x14\x00");
        directory.extend(&common);
        directory.extend([0; 10]);
        directory.extend((bytes.len() as u32).to_le_bytes());
        directory.extend(name.as_bytes());
        bytes.extend(b"PK\x03\x04");
        bytes.extend(common);
        bytes.extend(name.as_bytes());
        bytes.extend(body);
    }
    let start = bytes.len() as u32;
    bytes.extend(&directory);
    bytes.extend(b"PK\x05\x06\0\0\0\0");
    bytes.extend([files.len() as u16; 2].iter().flat_map(|x| x.to_le_bytes()));
    bytes.extend((directory.len() as u32).to_le_bytes());
    bytes.extend(start.to_le_bytes());
    bytes.extend([0, 0]);
    bytes
}

#[test]
fn archives_are_unpacked() {
    let long = b"1 2 3\n".repeat(500);
    for packed in [false, true] {
        let file = zip(
            &[("a/", b""), ("a/b.xyz", &long), ("c.txt", b"hello")],
            packed,
        );
        let archive = Archive::open(&file, None).expect("a ZIP file");
        let names: Vec<&str> = archive
            .entries
            .iter()
            .map(|entry| entry.name.as_str())
            .collect();
        assert_eq!(names, ["a/b.xyz", "c.txt"]);
        assert_eq!(archive.unpack(&archive.entries[0]).as_ref(), Ok(&long));
        assert_eq!(
            archive.unpack(&archive.entries[1]).as_deref(),
            Ok(&b"hello"[..])
        );
        for at in 0..file.len() {
            let mut bad = file.clone();
            bad[at] ^= 0x55;
            if let Ok(archive) = Archive::open(&bad, None) {
                archive
                    .entries
                    .iter()
                    .for_each(|entry| drop(archive.unpack(entry)));
            }
            let _ = Archive::open(&file[..at], None);
        }
    }
    let mut gzip = b"\x1f\x8b\x08\x08\0\0\0\0\0\x03name\0".to_vec();
    gzip.extend(compress_to_vec(&long, 6));
    gzip.extend([0; 8]);
    let archive = Archive::open(&gzip, Some("scan.xyz.gz")).expect("a gzip file");
    assert_eq!(archive.entries[0].name, "scan.xyz");
    assert_eq!(archive.unpack(&archive.entries[0]).as_ref(), Ok(&long));
    // Members one after the other, with a name or without, are one content; what is behind the last is none.
    let mut members = gzip.clone();
    for part in [&long[..7], b"", &long] {
        members.extend(b"\x1f\x8b\x08\0\0\0\0\0\0\x03");
        members.extend(compress_to_vec(part, 6));
        members.extend([1; 8]);
    }
    let whole = [&long[..], &long[..7], &long].concat();
    for tail in [&b""[..], &[0; 300]] {
        let file = [&members, tail].concat();
        let archive = Archive::open(&file, None).expect("a gzip file");
        assert_eq!(archive.unpack(&archive.entries[0]).as_ref(), Ok(&whole));
    }
    for cut in [members.len() - long.len() / 50, gzip.len() + 5] {
        let archive = Archive::open(&members[..cut], None).expect("a gzip file");
        let error = archive.unpack(&archive.entries[0]).unwrap_err();
        assert_eq!(error.code(), "bad-file", "{cut}");
    }
    let bomb = zip(&[("a", &vec![0; 1 << 20])], true);
    let mut lying = bomb.clone();
    let size = lying.len() - 22 - 46 - 1 + 24;
    lying[size..size + 4].copy_from_slice(&100u32.to_le_bytes());
    let archive = Archive::open(&lying, None).expect("a ZIP file");
    assert_eq!(
        archive.unpack(&archive.entries[0]).map_err(|e| e.code()),
        Err("bad-file")
    );
    let mut locked = bomb;
    let flags = locked.len() - 22 - 46 - 1 + 8;
    locked[flags] = 1;
    let archive = Archive::open(&locked, None).expect("a ZIP file");
    assert_eq!(
        archive.unpack(&archive.entries[0]).map_err(|e| e.code()),
        Err("unsupported-file")
    );
}

const MODEL: &str = r#"<?xml version="1.0"?><model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06"><resources>
<object id="1" type="model"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1.5" z="0"/></vertices><triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object>
<object id="2" type="model"><components><component objectid="1" transform="1 0 0 0 1 0 0 0 1 10 0 0"/><component objectid="1"/></components></object>
</resources><build><item objectid="2" transform="0 1 0 -1 0 0 0 0 1 0 0 5"/></build></model>"#;

#[test]
fn objects_of_a_3mf_file_are_where_its_build_places_them() {
    let file = zip(
        &[
            ("[Content_Types].xml", b"<Types/>"),
            ("3D/3dmodel.model", MODEL.as_bytes()),
        ],
        true,
    );
    assert_eq!(detect(&file, None), Ok(Format::ThreeMf));
    let cloud = both(&file, Format::ThreeMf);
    // First the component's step along x, then the build's quarter turn and its step along z.
    let expected = [
        0.0, 10.0, 5.0, 0.0, 11.0, 5.0, -1.5, 10.0, 5.0, 0.0, 0.0, 5.0, 0.0, 1.0, 5.0, -1.5, 0.0,
        5.0,
    ];
    assert_eq!(values(&cloud), expected);
    assert_eq!(cloud.faces, 1);
    let of = |model: &str| zip(&[("3D/3dmodel.model", model.as_bytes())], false);
    let (start, end) = (
        MODEL.find("<build>").expect("a build"),
        MODEL.find("</model>").expect("an end"),
    );
    let unbuilt = format!("{}{}", &MODEL[..start], &MODEL[end..]);
    assert_eq!(both(&of(&unbuilt), Format::ThreeMf).points(), 3);
    // An object of itself has no end.
    let circle = MODEL.replace("component objectid=\"1\"", "component objectid=\"2\"");
    assert_eq!(code(&of(&circle), Format::ThreeMf), "unsupported-file");
    for bad in [
        MODEL.replace("x=\"1\"", "x=\"one\""),
        MODEL.replace("vertex ", "corner "),
        MODEL.replace("1 10 0 0", "1 10"),
        MODEL.replace("</model>", "</modl>"),
    ] {
        assert_eq!(code(&of(&bad), Format::ThreeMf), "bad-file", "{bad}");
    }
    assert_eq!(
        code(&zip(&[("a.txt", b"b")], true), Format::ThreeMf),
        "bad-file"
    );
}

#[test]
fn centres_of_splats() {
    let splat = |x: f32, color: [u8; 4]| {
        let floats = [x, 2.0, 3.0, 0.1, 0.1, 0.1];
        let bytes = floats.iter().flat_map(|x| x.to_le_bytes());
        bytes.chain(color).chain([128; 4]).collect::<Vec<u8>>()
    };
    let file = [splat(1.0, [255, 0, 7, 51]), splat(-1.0, [1, 2, 3, 255])].concat();
    assert_eq!(detect(&file, Some("a.splat")), Ok(Format::Splat));
    assert_eq!(
        detect(&file, None).map_err(|e| e.code()),
        Err("unknown-format")
    );
    let cloud = both(&file, Format::Splat);
    assert_eq!(values(&cloud), [1.0, 2.0, 3.0, -1.0, 2.0, 3.0]);
    assert_eq!(cloud.colors, Some(vec![255, 0, 7, 1, 2, 3]));
    assert_eq!(cloud.attributes[0].values, [0.2, 1.0]);
    assert!(cloud.notes[0].contains("Gaussian splats"));
    assert_eq!(code(&file[..40], Format::Splat), "bad-file");
}

#[test]
fn centres_of_packed_splats() {
    let spz = |version: u32, places: &[u8], points: u32| {
        let mut bytes = b"NGSP".to_vec();
        bytes.extend(version.to_le_bytes());
        bytes.extend(points.to_le_bytes());
        bytes.extend([0, 12, 0, 0]);
        bytes.extend(places);
        bytes.extend([51, 255]);
        bytes.extend([128, 0, 255, 128, 128, 128]);
        bytes.extend([0; 12]);
        let mut gzip = b"\x1f\x8b\x08\0\0\0\0\0\0\x03".to_vec();
        gzip.extend(compress_to_vec(&bytes, 6));
        (bytes, gzip)
    };
    // Steps of 1/4096: 1, -2 and 0.5; then 1/4096.
    let places = [
        0, 0x10, 0, 0, 0xe0, 0xff, 0, 8, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0,
    ];
    for version in [2, 3] {
        let (bytes, gzip) = spz(version, &places, 2);
        assert_eq!(detect(&bytes, None), Ok(Format::Spz));
        assert_eq!(detect(&gzip, Some("a.spz")), Ok(Format::Spz));
        let cloud = both(&gzip, Format::Spz);
        assert_eq!(both(&bytes, Format::Spz), cloud);
        assert_eq!(values(&cloud), [1.0, -2.0, 0.5, 1.0 / 4096.0, 0.0, 0.0]);
        let colors = cloud.colors.expect("colours");
        assert!(colors[0].abs_diff(128) <= 1 && colors[1] == 0 && colors[2] == 255);
        assert_eq!(cloud.attributes[0].values, [0.2, 1.0]);
    }
    let halves: Vec<u8> = [0x3c00u16, 0xc000, 0x3800, 0, 0, 0]
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    assert_eq!(
        values(&both(&spz(1, &halves, 2).1, Format::Spz))[..3],
        [1.0, -2.0, 0.5]
    );
    assert_eq!(code(&spz(9, &places, 2).1, Format::Spz), "unsupported-file");
    assert_eq!(code(&spz(2, &places, 200).1, Format::Spz), "bad-file");
    assert_eq!(code(b"\x1f\x8b", Format::Spz), "bad-file");
}

#[test]
fn archives_are_looked_through_for_every_extension() {
    let script = std::fs::read_to_string("pkg/files/archive.js").expect("the script");
    let list = |name: &str| -> Vec<String> {
        let start = format!("const {name} = /\\.(");
        let (_, rest) = script.split_once(&start).expect("a list");
        let (list, _) = rest.split_once(")$/i;").expect("its end");
        list.split('|').map(String::from).collect()
    };
    let mut found = [list("SCAN"), list("TEXT")].concat();
    let all = Format::ALL.iter().flat_map(|format| format.extensions());
    let mut expected: Vec<String> = all.map(|extension| extension.to_string()).collect();
    found.sort_unstable();
    expected.sort_unstable();
    assert_eq!(found, expected);
}
