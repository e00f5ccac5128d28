//! Which way is up and what a coordinate is: what readers tell, what results keep, what writers make of it.
#![cfg(not(target_arch = "wasm32"))]

use pointweave::cloud::{Attribute, Crs, Unit, Viewpoints};
use pointweave::formats::{
    Format, Output, Positions, RawCloud, Reading, Skin, WriteOptions, read, write,
};
use pointweave::progress::Silent;
use pointweave::{ReduceParams, SurfaceParams};

const UP_Y: [f64; 3] = [0.0, 1.0, 0.0];
const UP_Z: [f64; 3] = [0.0, 0.0, 1.0];

fn values(positions: &Positions) -> Vec<f64> {
    match positions {
        Positions::F32(values) => values.iter().map(|&x| f64::from(x)).collect(),
        Positions::F64(values) => values.clone(),
    }
}

/// Three points in a scanner's frame, z up, in millimetres.
fn scan() -> RawCloud {
    RawCloud {
        normals: Some(vec![0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
        up: Some(UP_Z),
        unit: Some(Unit::Millimetre),
        ..RawCloud::new(Positions::F32(vec![
            0.0, 0.0, 0.0, 300.0, 0.0, 0.0, 0.0, 200.0, 100.0,
        ]))
    }
}

fn written(cloud: &RawCloud, format: Output, options: WriteOptions) -> RawCloud {
    let bytes = write(cloud, Some(&[0, 1, 2]), format, options).unwrap();
    read(&bytes, Format::from_name(format.name()).unwrap()).unwrap()
}

#[test]
fn a_glb_stands_with_y_up_in_metres() {
    let back = written(&scan(), Output::Glb, WriteOptions::default());
    let expected = [0.0, 0.0, 0.0, 0.3f32, 0.0, 0.0, 0.0, 0.1, -0.2].map(f64::from);
    assert_eq!(values(&back.positions), expected);
    assert_eq!(
        back.normals.unwrap(),
        [0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0]
    );
    assert_eq!((back.up, back.unit), (Some(UP_Y), Some(Unit::Metre)));
}

#[test]
fn formats_without_a_rule_stay_as_they_are_unless_told() {
    for format in [Output::Ply, Output::Xyz, Output::Obj, Output::Pcd] {
        let back = written(&scan(), format, WriteOptions::default());
        assert_eq!(
            values(&back.positions),
            values(&scan().positions),
            "{}",
            format.name()
        );
        let told = WriteOptions {
            up: Some([0.0, -1.0, 0.0]),
            unit: Some(Unit::Inch),
            ..WriteOptions::default()
        };
        let turned = values(&written(&scan(), format, told).positions);
        let inch = |x: f64| f64::from((x / 25.4) as f32);
        assert_eq!(
            turned[3..],
            [inch(300.0), 0.0, 0.0, 0.0, inch(-100.0), inch(200.0)],
            "{}",
            format.name()
        );
    }
}

#[test]
fn an_stl_is_z_up_in_millimetres() {
    let mut cloud = scan();
    (cloud.up, cloud.unit) = (Some(UP_Y), Some(Unit::Centimetre));
    let back = written(&cloud, Output::Stl, WriteOptions::default());
    assert_eq!(
        values(&back.positions)[3..],
        [3000.0, 0.0, 0.0, 0.0, -1000.0, 2000.0]
    );
}

#[test]
fn a_cloud_that_says_nothing_stays_as_it_is_and_cannot_be_told() {
    let cloud = RawCloud {
        up: None,
        unit: None,
        ..scan()
    };
    let back = written(&cloud, Output::Glb, WriteOptions::default());
    assert_eq!(values(&back.positions), values(&cloud.positions));
    for options in [
        WriteOptions {
            up: Some(UP_Y),
            ..WriteOptions::default()
        },
        WriteOptions {
            unit: Some(Unit::Metre),
            ..WriteOptions::default()
        },
    ] {
        assert_eq!(
            write(&cloud, None, Output::Ply, options)
                .unwrap_err()
                .code(),
            "bad-option"
        );
    }
    let options = WriteOptions {
        up: Some([0.0; 3]),
        ..WriteOptions::default()
    };
    assert_eq!(
        write(&scan(), None, Output::Ply, options)
            .unwrap_err()
            .code(),
        "bad-option"
    );
    // Nor has a cloud whose own up is no direction.
    let nowhere = RawCloud {
        up: Some([0.0; 3]),
        ..scan()
    };
    assert_eq!(
        write(&nowhere, None, Output::Glb, WriteOptions::default())
            .unwrap_err()
            .code(),
        "bad-option"
    );
    // Degrees are no lengths.
    let degrees = RawCloud {
        unit: Some(Unit::Degree),
        ..scan()
    };
    assert!(write(&degrees, None, Output::Glb, WriteOptions::default()).is_ok());
    let options = WriteOptions {
        unit: Some(Unit::Metre),
        ..WriteOptions::default()
    };
    assert_eq!(
        write(&degrees, None, Output::Ply, options)
            .unwrap_err()
            .code(),
        "bad-option"
    );
}

#[test]
fn origins_stay_exact() {
    let mut cloud = scan();
    cloud.unit = Some(Unit::Metre);
    cloud.origin = Some([500_000.125, 4_000_000.25, 100.5]);
    let glb = read(
        &write(&cloud, None, Output::Glb, WriteOptions::default()).unwrap(),
        Format::Glb,
    )
    .unwrap();
    assert_eq!(
        values(&glb.positions)[..3],
        [500_000.125, 100.5, -4_000_000.25]
    );
    let las = read(
        &write(&cloud, None, Output::Las, WriteOptions::default()).unwrap(),
        Format::Las,
    )
    .unwrap();
    for (found, local) in values(&las.positions)
        .chunks_exact(3)
        .zip(values(&cloud.positions).chunks_exact(3))
    {
        for k in 0..3 {
            assert!((found[k] - local[k] - cloud.origin.unwrap()[k]).abs() < 1e-4);
        }
    }
}

#[test]
fn viewpoints_go_along() {
    let mut cloud = scan();
    cloud.viewpoints = Viewpoints::new(&[1.0, 2.0, 3.0], None, 3).ok();
    let options = WriteOptions {
        up: Some(UP_Y),
        ..WriteOptions::default()
    };
    let bytes = write(&cloud, None, Output::Pcd, options).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    assert!(text.contains("VIEWPOINT 1 3 -2 1 0 0 0\n"), "{text}");
}

/// A cap of points over a plane, so that there is something to reduce and to mesh.
fn cap() -> RawCloud {
    let points = (0..2000).flat_map(|i| {
        let (a, r) = (f64::from(i) * 2.399_963, (f64::from(i) / 2000.0).sqrt());
        let (x, y) = (r * a.cos(), r * a.sin());
        [x, y, 1.0 - r * r].map(|x| x as f32)
    });
    RawCloud {
        up: Some(UP_Z),
        unit: Some(Unit::Foot),
        crs: Some(Crs {
            wkt: Some("LOCAL_CS[\"site\"]".into()),
            ..Crs::default()
        }),
        ..RawCloud::new(Positions::F32(points.collect()))
    }
}

#[test]
fn results_keep_them() {
    let cloud = cap();
    let reduced = pointweave::reduce(
        &cloud.to_cloud().unwrap(),
        &ReduceParams::default(),
        &mut Silent,
    )
    .unwrap();
    let back = RawCloud::of_cloud(&reduced.reduced.cloud);
    assert_eq!(
        (back.up, back.unit, &back.crs),
        (cloud.up, cloud.unit, &cloud.crs)
    );
    let surface = pointweave::reconstruct(
        &cloud.to_cloud().unwrap(),
        &SurfaceParams::default(),
        &mut Silent,
    )
    .unwrap();
    let back = RawCloud::of_surface(&surface);
    assert_eq!(
        (back.up, back.unit, &back.crs),
        (cloud.up, cloud.unit, &cloud.crs)
    );
    assert!(
        surface
            .report
            .reduce
            .doubts
            .iter()
            .all(|doubt| doubt.code != "sampled-from-faces")
    );
}

#[test]
fn points_of_faces_are_doubted_in_the_reports() {
    let file = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    let options = pointweave::formats::ReadOptions::default();
    let cloud = pointweave::formats::read_with(file.as_bytes(), Format::Off, &options).unwrap();
    let reduced = pointweave::reduce(
        &cloud.to_cloud().unwrap(),
        &ReduceParams::default(),
        &mut Silent,
    )
    .unwrap();
    let doubt = &reduced.report.doubts[0];
    assert_eq!(doubt.code, "sampled-from-faces");
    assert!(doubt.message.contains("4 faces"), "{}", doubt.message);
}

#[test]
fn pcd_keeps_colours_attributes_and_double_precision() {
    let mut cloud = scan();
    cloud.colors = Some(vec![1, 2, 3, 4, 5, 6, 7, 8, 9]);
    cloud.attributes = vec![Attribute {
        name: "intensity".into(),
        values: vec![0.5, 1.0, 2.0],
    }];
    let back = read(
        &write(&cloud, None, Output::Pcd, WriteOptions::default()).unwrap(),
        Format::Pcd,
    )
    .unwrap();
    assert_eq!(
        (&back.positions, &back.normals),
        (&cloud.positions, &cloud.normals)
    );
    assert_eq!(
        (&back.colors, &back.attributes),
        (&cloud.colors, &cloud.attributes)
    );
    let far = RawCloud::new(Positions::F64(vec![
        500_000.001,
        4e6,
        1.0,
        500_001.002,
        4e6,
        2.0,
    ]));
    let back = read(
        &write(&far, None, Output::Pcd, WriteOptions::default()).unwrap(),
        Format::Pcd,
    )
    .unwrap();
    assert_eq!(values(&back.positions), values(&far.positions));
}

#[test]
fn las_and_laz_keep_colours_attributes_normals_and_reference_systems() {
    let mut cloud = scan();
    cloud.colors = Some(vec![1, 2, 3, 4, 5, 6, 255, 8, 9]);
    cloud.unit = Some(Unit::SurveyFoot);
    let wkt = "PROJCS[\"p\",GEOGCS[\"g\",UNIT[\"degree\",0.017]],UNIT[\"US survey foot\",0.3048006096012192]]";
    cloud.crs = Some(Crs {
        wkt: Some(wkt.into()),
        ..Crs::default()
    });
    let attribute = |name: &str, values: [f32; 3]| Attribute {
        name: name.into(),
        values: values.into(),
    };
    cloud.attributes = vec![
        attribute("intensity", [0.0, 300.0, 65_535.0]),
        attribute("classification", [2.0, 6.0, 200.0]),
        attribute("quality", [0.25, -1.0, 7.5]),
    ];
    for (output, format) in [(Output::Las, Format::Las), (Output::Laz, Format::Las)] {
        let bytes = write(&cloud, None, output, WriteOptions::default()).unwrap();
        let back = read(&bytes, format).unwrap();
        for (found, expected) in values(&back.positions)
            .into_iter()
            .zip(values(&cloud.positions))
        {
            assert!((found - expected).abs() < 1e-4, "{found} {expected}");
        }
        assert_eq!(
            (&back.colors, back.up, back.unit, &back.crs),
            (&cloud.colors, Some(UP_Z), cloud.unit, &cloud.crs)
        );
        for Attribute { name, values } in &cloud.attributes {
            let found = back
                .attributes
                .iter()
                .find(|attribute| attribute.name == *name);
            assert_eq!(
                found.map(|attribute| &attribute.values),
                Some(values),
                "{name}"
            );
        }
        assert_eq!(
            bytes,
            write(&cloud, None, output, WriteOptions::default()).unwrap()
        );
    }
    // However large or small a cloud is, there are steps for it.
    for size in [1e308, 1e-310] {
        let pair = RawCloud::new(Positions::F64(vec![-size, 0.0, 0.0, size, 0.0, 0.0]));
        assert!(write(&pair, None, Output::Las, WriteOptions::default()).is_ok());
    }
    // Shares of 1 are no whole numbers: they stay what they are.
    cloud.attributes = vec![attribute("intensity", [0.0, 0.5, 1.0])];
    let back = read(
        &write(&cloud, None, Output::Las, WriteOptions::default()).unwrap(),
        Format::Las,
    )
    .unwrap();
    assert!(
        back.attributes
            .iter()
            .any(|attribute| attribute.values == [0.0, 0.5, 1.0])
    );
}

#[test]
fn geotiff_keys_go_on() {
    let crs = Crs {
        keys: vec![1, 1, 0, 1, 3076, 0, 1, 9002],
        doubles: vec![0.5],
        ascii: "here|".into(),
        ..Crs::default()
    };
    let cloud = RawCloud {
        crs: Some(crs.clone()),
        ..scan()
    };
    let back = read(
        &write(&cloud, None, Output::Las, WriteOptions::default()).unwrap(),
        Format::Las,
    )
    .unwrap();
    assert_eq!((back.crs, back.unit), (Some(crs), Some(Unit::Foot)));
}

#[test]
fn a_3mf_wants_triangles() {
    assert_eq!(
        write(&scan(), None, Output::ThreeMf, WriteOptions::default())
            .unwrap_err()
            .code(),
        "needs-triangles"
    );
    let file = write(
        &scan(),
        Some(&[0, 1, 2]),
        Output::ThreeMf,
        WriteOptions::default(),
    )
    .unwrap();
    let back = read(&file, Format::ThreeMf).unwrap();
    assert_eq!(
        (values(&back.positions), back.faces),
        (values(&scan().positions), 1)
    );
    assert_eq!((back.up, back.unit), (Some(UP_Z), Some(Unit::Millimetre)));
    // In metres, far from home, with colours.
    let far = RawCloud {
        unit: Some(Unit::Metre),
        colors: Some(vec![1, 2, 3, 250, 251, 252, 0, 0, 0]),
        origin: Some([500_000.25, 4e6, 0.0]),
        ..scan()
    };
    let options = WriteOptions {
        unit: Some(Unit::Metre),
        ..WriteOptions::default()
    };
    let back = read(
        &write(&far, Some(&[0, 1, 2]), Output::ThreeMf, options).unwrap(),
        Format::ThreeMf,
    )
    .unwrap();
    assert_eq!(
        values(&back.positions)[..6],
        [500_000.25, 4e6, 0.0, 500_300.25, 4e6, 0.0]
    );
    assert_eq!((back.colors, back.unit), (far.colors, Some(Unit::Metre)));
}

#[test]
fn a_camera_looks_along_z_and_robots_stand_on_it() {
    let pcd = |rows: &str| {
        let count = rows.lines().count();
        let text = format!(
            "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {count}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {count}\nDATA ascii\n{rows}"
        );
        read(text.as_bytes(), Format::Pcd).unwrap().up
    };
    assert_eq!(pcd("0.1 0.2 1\n-0.5 0.4 2\n"), Some([0.0, -1.0, 0.0]));
    assert_eq!(pcd("0.1 0.2 1\n-3 0.4 2\n"), Some(UP_Z));
    assert_eq!(pcd("0.1 0.2 1\n0 0 -1\n"), Some(UP_Z));
}

/// A column of values for three points.
fn column(name: &str, values: [f32; 3]) -> Attribute {
    Attribute {
        name: name.into(),
        values: values.into(),
    }
}

#[test]
fn las_gives_attributes_back_under_their_names() {
    let mut cloud = scan();
    cloud.attributes = vec![
        column("classification", [2.0, 6.0, 200.0]),
        column("return_number", [1.0, 2.0, 3.0]),
        column("scan_direction_flag", [0.0, 1.0, 1.0]),
        column("edge_of_flight_line", [1.0, 0.0, 0.0]),
        column("withheld", [0.0, 1.0, 0.0]),
        column("scanner_channel", [0.0, 3.0, 1.0]),
        column("scan_angle", [-12.0, 0.006 * 7.0, 0.006 * 2999.0]),
        column("gps_time", [0.25, 1.5, 100.0]),
        // No field holds these.
        column("intensity", [0.0, 0.5, 1.0]),
        column("user_data", [0.5, 1.5, 2.5]),
        column("wave_packet", [0.0, 7.0, 9.0]),
        column("red", [0.5, 0.25, 0.0]),
        column("a name that is longer than 32 bytes: one", [1.0, 2.0, 3.0]),
        column("a name that is longer than 32 bytes: two", [4.0, 5.0, 6.0]),
    ];
    let mut back = cloud.clone();
    for _ in 0..2 {
        let bytes = write(&back, None, Output::Las, WriteOptions::default()).unwrap();
        back = read(&bytes, Format::Las).unwrap();
        for (i, Attribute { name, values }) in cloud.attributes.iter().enumerate() {
            let name = match i {
                11 => "red (float)",
                12 => "a name that is longer than 32 by",
                13 => "a name that is longer than 32  2",
                _ => name,
            };
            let found = back.attributes.iter().find(|one| one.name == name);
            let found = found.map(|attribute| &attribute.values);
            let near = found
                .is_some_and(|found| found.iter().zip(values).all(|(a, b)| (a - b).abs() < 1e-5));
            assert!(near, "{name}: {found:?}");
        }
        // With the normals, and how many returns there are.
        assert_eq!(back.attributes.len(), cloud.attributes.len() + 4);
        back.normals = None;
    }
}

#[test]
fn a_reference_system_too_long_for_a_record_comes_behind_the_points() {
    let mut cloud = scan();
    let wkt = format!("PROJCS[\"{}\",UNIT[\"metre\",1]]", "n".repeat(70_000));
    cloud.crs = Some(Crs {
        wkt: Some(wkt),
        ..Crs::default()
    });
    for output in [Output::Las, Output::Laz] {
        let bytes = write(&cloud, None, output, WriteOptions::default()).unwrap();
        assert_eq!(read(&bytes, Format::Las).unwrap().crs, cloud.crs);
        // In slices, too.
        let mut reading = Reading::new(Some(Format::Las), None, bytes.len() as u64);
        for slice in bytes.chunks(1000) {
            reading.push(slice).unwrap();
        }
        while !reading.end().unwrap() {}
        assert_eq!(reading.summary().crs, cloud.crs);
    }
}

#[test]
fn more_extra_bytes_than_las_describes_are_refused() {
    let mut cloud = scan();
    cloud.normals = None;
    let columns = |count: usize| (0..count).map(|i| column(&format!("a{i}"), [0.5, i as f32, 2.0]));
    cloud.attributes = columns(341).collect();
    for output in [Output::Las, Output::Laz] {
        let bytes = write(&cloud, None, output, WriteOptions::default()).unwrap();
        let back = read(&bytes, Format::Las).unwrap();
        assert!(
            cloud
                .attributes
                .iter()
                .all(|one| back.attributes.contains(one))
        );
    }
    cloud.attributes = columns(342).collect();
    let error = write(&cloud, None, Output::Las, WriteOptions::default()).unwrap_err();
    assert_eq!(error.code(), "bad-length");
    assert_eq!(error.found().as_deref(), Some("342"));
}

#[test]
fn usdz_is_a_stored_layer_with_y_up_in_metres() {
    let mut cloud = scan();
    cloud.positions = Positions::F32(vec![0.0, 0.0, 0.0, 1000.0, 0.0, 0.0, 0.0, 500.0, 250.0]);
    cloud.origin = Some([4e9, 0.0, 1000.0]);
    cloud.unit = Some(Unit::Millimetre);
    cloud.up = Some(UP_Z);
    cloud.normals = None;
    cloud.colors = Some(vec![255, 0, 0, 0, 255, 0, 0, 0, 255]);
    cloud.attributes = vec![
        column("1st value", [0.5, 1.0, 2.0]),
        column("_1st_value", [3.0, 4.0, 5.0]),
    ];
    let options = WriteOptions::default();
    let bytes = write(&cloud, Some(&[0, 1, 2]), Output::Usdz, options).unwrap();
    assert_eq!(&bytes[..4], b"PK\x03\x04");
    let short = |at: usize| usize::from(u16::from_le_bytes([bytes[at], bytes[at + 1]]));
    assert_eq!(short(8), 0, "stored");
    let start = 30 + short(26) + short(28);
    assert_eq!(start % 64, 0);
    let size = u32::from_le_bytes(*bytes[22..].first_chunk().unwrap()) as usize;
    let layer = String::from_utf8(bytes[start..start + size].to_vec()).unwrap();
    for line in [
        "    metersPerUnit = 1\n",
        "    upAxis = \"Y\"\n",
        "    double3 xformOp:translate = (4000000, 1, 0)\n",
        "        float3[] extent = [(0, 0, -0.5), (1, 0.25, 0)]\n",
        "        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 0.25, -0.5)]\n",
        "        int[] faceVertexIndices = [0, 1, 2]\n",
        "        color3f[] primvars:displayColor = [(1, 0, 0), (0, 1, 0), (0, 0, 1)] (interpolation = \"vertex\")\n",
        "        float[] primvars:_1st_value = [0.5, 1, 2] (interpolation = \"vertex\")\n",
        "        float[] primvars:_1st_value_ = [3, 4, 5] (interpolation = \"vertex\")\n",
    ] {
        assert!(layer.contains(line), "{line} in {layer}");
    }
    let points = write(&cloud, None, Output::Usdz, options).unwrap();
    assert!(
        points
            .windows(19)
            .any(|part| part == b"def Points \"Points\"")
    );
    assert_eq!(
        write(
            &RawCloud::new(Positions::F32(vec![])),
            None,
            Output::Usdz,
            options
        )
        .map_err(|error| error.code()),
        Err("empty-cloud")
    );
}

#[test]
fn the_pictures_of_a_mesh_lie_in_usdz_beside_its_layer() {
    let mut cloud = RawCloud::new(Positions::F32(vec![0., 0., 0., 1., 0., 0., 0., 1., 0.]));
    cloud.colors = Some(vec![9; 9]);
    let file = |byte: u8, length: usize| [&b"\x89PNG"[..], &vec![byte; length]].concat();
    let pictures = [file(1, 100), file(2, 70), file(3, 50)];
    cloud.skin = Some(Box::new(Skin {
        uvs: vec![0.0, 0.0, 1.0, 0.25, 0.5, 1.0],
        tangents: None,
        color: Some(pictures[0].clone()),
        normal: Some(pictures[1].clone()),
        occlusion: Some(pictures[2].clone()),
    }));
    let options = WriteOptions::default();
    let bytes = write(&cloud, Some(&[0, 1, 2]), Output::Usdz, options).unwrap();
    let find = |part: &[u8]| bytes.windows(part.len()).position(|at| at == part);
    for picture in &pictures {
        assert_eq!(
            find(picture).map(|at| at % 64),
            Some(0),
            "as it is, aligned"
        );
    }
    let layer = String::from_utf8_lossy(&bytes);
    for line in [
        "texCoord2f[] primvars:st = [(0, 1), (1, 0.75), (0.5, 0)] (interpolation = \"vertex\")\n",
        "asset inputs:file = @color.png@\n",
        "asset inputs:file = @normal.png@\n",
        "color3f inputs:diffuseColor.connect = </Scan/Material/ColorPicture.outputs:rgb>\n",
        "normal3f inputs:normal.connect = </Scan/Material/NormalPicture.outputs:rgb>\n",
        "float inputs:occlusion.connect = </Scan/Material/OcclusionPicture.outputs:r>\n",
    ] {
        assert!(layer.contains(line), "{line}");
    }
    assert!(!layer.contains("displayColor"), "the picture has them");
    let archive = write(&cloud, Some(&[0, 1, 2]), Output::Zip, options).unwrap();
    for name in ["color.png", "normal.png", "occlusion.png"] {
        assert!(
            archive
                .windows(name.len())
                .any(|part| part == name.as_bytes()),
            "{name}"
        );
    }
}

#[test]
fn pictures_of_other_kinds_go_into_glb_alone() {
    let mut cloud = RawCloud::new(Positions::F32(vec![0., 0., 0., 1., 0., 0., 0., 1., 0.]));
    let [webp, ktx2] = [
        b"RIFF\x04\0\0\0WEBP".to_vec(),
        b"\xabKTX 20\xbb\r\n\x1a\n".to_vec(),
    ];
    cloud.skin = Some(Box::new(Skin {
        uvs: vec![0.0; 6],
        color: Some(webp.clone()),
        normal: Some(b"\x89PNG".to_vec()),
        occlusion: Some(ktx2),
        ..Skin::default()
    }));
    let options = WriteOptions {
        quantize: true,
        ..WriteOptions::default()
    };
    let bytes = write(&cloud, Some(&[0, 1, 2]), Output::Glb, options).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    for part in [
        r#""extensionsRequired":["EXT_texture_webp","KHR_texture_basisu","KHR_mesh_quantization"]"#,
        r#""textures":[{"extensions":{"EXT_texture_webp":{"source":0}},"sampler":0},{"source":1,"sampler":0},{"extensions":{"KHR_texture_basisu":{"source":2}},"sampler":0}]"#,
        r#""mimeType":"image/webp""#,
        r#""mimeType":"image/ktx2""#,
        r#""occlusionTexture":{"index":2}"#,
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
    for format in [Output::Usdz, Output::Zip] {
        let error = write(&cloud, Some(&[0, 1, 2]), format, WriteOptions::default()).unwrap_err();
        assert_eq!(error.code(), "bad-option");
    }
    if let Some(skin) = &mut cloud.skin {
        skin.color = Some(b"GIF89a".to_vec());
    }
    let error = write(&cloud, Some(&[0, 1, 2]), Output::Glb, options).unwrap_err();
    assert_eq!(error.code(), "bad-option");
}

#[test]
fn times_in_layers_are_those_of_the_same_points_unpacked() {
    const POINTS: usize = 120_000;
    let mut state = 7u32;
    let mut random = |below: u32| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) % below
    };
    let mut cloud = RawCloud::new(Positions::F32(vec![]));
    // The first time is so small that times are not counted from it.
    let mut columns = [0.5, 1.0, 1.0, 0.0].map(|first: f32| vec![first]);
    // Five scanners take turns; pulses of several returns have one time; clocks run, stand, jump, and go back.
    let mut clocks = [0.0f32, 1e3, 5e5, 1e6, -3e4];
    let mut positions = vec![0.0; 3];
    while columns[0].len() < POINTS {
        let scanner = random(5) as usize;
        let clock = &mut clocks[scanner];
        *clock += match random(12) {
            0 => random(1_000_000) as f32,
            1 => -(random(5000) as f32),
            2 => 0.0,
            3 => 0.001 * random(1000) as f32,
            _ => 0.25,
        };
        let returns = 1 + random(4);
        for number in 1..=returns {
            let values = [*clock, number as f32, returns as f32, (scanner % 4) as f32];
            columns
                .iter_mut()
                .zip(values)
                .for_each(|(column, value)| column.push(value));
            positions.extend([0; 3].map(|_| random(100_000) as f32 / 1024.0));
        }
    }
    cloud.positions = Positions::F32(positions);
    let names = [
        "gps_time",
        "return_number",
        "number_of_returns",
        "scanner_channel",
    ];
    cloud.attributes = names
        .into_iter()
        .zip(columns)
        .map(|(name, values)| Attribute {
            name: name.into(),
            values,
        })
        .collect();
    let [plain, packed] = [Output::Las, Output::Laz].map(|output| {
        let bytes = write(&cloud, None, output, WriteOptions::default()).unwrap();
        read(&bytes, Format::Las).unwrap()
    });
    for attribute in &cloud.attributes {
        for read in [&plain, &packed] {
            assert!(read.attributes.contains(attribute), "{}", attribute.name);
        }
    }
}
