//! Points that stand for a missing measurement.
#![cfg(not(target_arch = "wasm32"))]

use pointweave::formats::{Format, Positions, RawCloud, ReadOptions, read, read_with};

fn keep(text: &str) -> RawCloud {
    let options = ReadOptions {
        keep_sentinels: true,
        ..Default::default()
    };
    read_with(text.as_bytes(), Format::Xyz, &options).expect("a table")
}

/// A grid of heights, some of them missing.
fn raster(missing: &str, every: usize) -> String {
    let row = |i: usize| {
        let height = format!("{}", 250.0 + (i as f64 * 0.1).sin());
        let height = if i % every == 3 { missing } else { &height };
        format!("{} {} {height}\n", 500_000 + i % 20, 5_600_000 + i / 20)
    };
    (0..400).map(row).collect()
}

#[test]
fn heights_without_data_are_left_out() {
    for missing in [
        "-9999",
        "-9999.0",
        "-32768",
        "-32767",
        "-99999",
        "-3.4e38",
        "-3.402823466e+38",
        "1.70141e38",
        "-1.7976931348623157e308",
        "1e30",
        "9999",
        "-9999.9",
        "-999.25",
        "-6999",
        "-88888",
        "99999.99",
        "-2147483648",
        "-1e10",
    ] {
        for every in [4, 100] {
            let text = raster(missing, every);
            let cloud = read(text.as_bytes(), Format::Xyz).expect("a table");
            let left = 400 / every;
            assert_eq!(cloud.points(), 400 - left, "{missing}");
            assert_eq!(cloud.skipped, [("no-data", left as u64)], "{missing}");
            assert_eq!(keep(&text).points(), 400, "{missing}");
            let highest = match &cloud.positions {
                Positions::F64(values) => values
                    .iter()
                    .skip(2)
                    .step_by(3)
                    .copied()
                    .fold(0.0, f64::max),
                Positions::F32(_) => panic!("georeferenced"),
            };
            assert!(highest < 252.0);
        }
    }
}

#[test]
fn a_number_among_others_is_a_coordinate() {
    // -9999 is a place among these, and 9999 is one millimetre beyond them.
    let line: String = (0..400)
        .map(|i| format!("{} 0 {}\n", -20_000 + 73 * i, -9999 + i))
        .collect();
    assert_eq!(
        read(line.as_bytes(), Format::Xyz).map(|c| c.points()),
        Ok(400)
    );
    let near: String = (0..400)
        .map(|i| format!("{i}.5 {i} {}\n", 9600 + i))
        .collect();
    assert_eq!(
        read(near.as_bytes(), Format::Xyz).map(|c| c.points()),
        Ok(400)
    );
    let alone = "-9999 -9999 -9999\n".repeat(5);
    assert_eq!(
        read(alone.as_bytes(), Format::Xyz).map(|c| c.points()),
        Ok(5)
    );
}

/// A sphere, with `zeros` points at 0 0 0 and each other place `times` times.
fn sphere(zeros: usize, times: usize) -> String {
    let mut text = "0 0 0\n".repeat(zeros);
    for i in 0..300 {
        let (a, z) = (i as f64 * 2.4, (i as f64 + 0.5) / 150.0 - 1.0);
        let r = (1.0 - z * z).sqrt();
        text += &format!("{} {} {}\n", 5.0 + r * a.cos(), r * a.sin(), z).repeat(times);
    }
    text
}

#[test]
fn many_points_at_zero_are_no_returns() {
    for zeros in [6, 30, 900] {
        let text = sphere(zeros, 1);
        let cloud = read(text.as_bytes(), Format::Xyz).expect("a table");
        assert_eq!(cloud.points(), 300);
        assert_eq!(cloud.skipped, [("no-return", zeros as u64)]);
        assert_eq!(keep(&text).points(), 300 + zeros);
    }
    // One or two are places, and so is one that is repeated as the others are.
    for (zeros, times) in [(0, 1), (1, 1), (2, 1), (20, 20), (20, 6)] {
        let cloud = read(sphere(zeros, times).as_bytes(), Format::Xyz).expect("a table");
        assert_eq!(cloud.points(), 300 * times + zeros, "{zeros} {times}");
        assert!(cloud.skipped.is_empty());
    }
    assert_eq!(
        read("0 0 0\n".repeat(50).as_bytes(), Format::Xyz).map(|c| c.points()),
        Ok(50)
    );
}

#[test]
fn many_points_at_minus_one_are_no_returns() {
    let text = sphere(60, 1).replace("0 0 0\n", "-1 -1 -1\n");
    let cloud = read(text.as_bytes(), Format::Xyz).expect("a table");
    assert_eq!(cloud.skipped, [("no-return", 60)]);
}

#[test]
fn words_for_nothing_are_no_points() {
    for missing in ["<NA>", "\\N", "(null)", "#DIV/0!", "missing", "n.a.", "---"] {
        let cloud = read(raster(missing, 4).as_bytes(), Format::Xyz).expect("a table");
        assert_eq!((cloud.points(), cloud.dropped), (300, 100), "{missing}");
    }
}

#[test]
fn all_arrays_lose_the_same_points() {
    let rows: String = (0..60)
        .map(|i| {
            let z = if i % 5 == 0 {
                -9999.0
            } else {
                1.0 + f64::from(i) * 0.01
            };
            format!("{i}.5 {} {z} {i} {i} {i} {} 0 0 1\n", i * i % 17, 100 + i)
        })
        .collect();
    let text = format!("x y z red green blue intensity nx ny nz\n{rows}");
    let cloud = read(text.as_bytes(), Format::Xyz).expect("a table");
    assert_eq!(cloud.points(), 48);
    let kept: Vec<u8> = (0..60u8).filter(|i| i % 5 != 0).collect();
    let colors: Vec<u8> = cloud
        .colors
        .expect("colours")
        .chunks_exact(3)
        .map(|c| c[0])
        .collect();
    assert_eq!(colors, kept);
    let intensity: Vec<f32> = kept.iter().map(|&i| 100.0 + f32::from(i)).collect();
    assert_eq!(cloud.attributes[0].values, intensity);
    assert_eq!(cloud.normals.map(|n| n.len()), Some(3 * 48));
}

#[test]
fn a_depth_frame_of_a_pcd_file_loses_its_holes() {
    let mut data = String::new();
    for i in 0..200 {
        data += &if i % 3 == 0 {
            "0 0 0\n".into()
        } else {
            format!("{} {} {}\n", i % 20, i / 20, 700 + i % 7)
        };
    }
    let text = format!(
        "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 20\nHEIGHT 10\nPOINTS 200\nDATA ascii\n{data}"
    );
    let cloud = read(text.as_bytes(), Format::Pcd).expect("a PCD file");
    assert_eq!(
        (cloud.points(), cloud.skipped),
        (133, vec![("no-return", 67)])
    );
}

#[test]
fn vertices_of_faces_without_area_lose_sentinels_too() {
    let mut file = String::from(
        "ply\nformat ascii 1.0\nelement vertex 400\nproperty float x\nproperty float y\nproperty float z\n\
         element face 1\nproperty list uchar int vertex_indices\nend_header\n",
    );
    for i in 0..400 {
        let height = if i % 10 == 3 { -9999.0 } else { 5.0 };
        file += &format!("{} {} {height}\n", i % 20, i / 20);
    }
    // On one line.
    file += "3 0 1 2\n";
    for (keep_sentinels, points) in [(false, 360), (true, 400)] {
        let options = ReadOptions {
            keep_sentinels,
            ..Default::default()
        };
        let cloud = read_with(file.as_bytes(), Format::Ply, &options).expect("a mesh");
        assert_eq!(cloud.points(), points);
        let skipped: &[(&str, u64)] = if keep_sentinels {
            &[]
        } else {
            &[("no-data", 40)]
        };
        assert_eq!(cloud.skipped, skipped);
    }
}
