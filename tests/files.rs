//! Files that others made: every one ends in the right result or in a typed error.
//!
//! Native only: a browser has no folder of shared data.
#![cfg(not(target_arch = "wasm32"))]

use pointweave::error::Error;
use pointweave::formats::{Format, Output, Positions, RawCloud, WriteOptions, detect, read, write};
use std::path::PathBuf;

/// What a file is expected to give: points left out and kept, or an error code with the line or byte.
#[derive(Debug, PartialEq)]
enum Outcome {
    /// Points.
    Cloud(usize),
    /// Points, and rows dropped because they are not finite.
    Dropped(usize, usize),
    /// Code, and where.
    Fails(&'static str, Option<u64>),
}
use Outcome::{Cloud, Dropped, Fails};

/// Every PLY, XYZ, PTS and TXT file of the shared data.
const FILES: [(&str, Outcome); 54] = [
    (
        "hostile/assimp_crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply",
        Fails("bad-file", Some(7)),
    ),
    (
        "hostile/assimp_cube_binary_header_with_RN_newline.ply",
        Cloud(8),
    ),
    ("hostile/assimp_empty.ply", Fails("bad-file", Some(1))),
    ("hostile/assimp_float-color.ply", Cloud(3)),
    ("hostile/assimp_points.ply", Cloud(4)),
    ("hostile/draco_float_inf_point_cloud.ply", Dropped(13, 3)),
    ("hostile/draco_int_point_cloud.ply", Cloud(16)),
    ("hostile/draco_test_extra_whitespace.ply", Cloud(3)),
    ("hostile/draco_test_more_datatypes.ply", Cloud(3)),
    ("hostile/gaussian_train-1000.ply", Cloud(1000)),
    ("hostile/happly_platonic_shelf_big_endian.ply", Cloud(50)),
    ("hostile/pcu_bunny_duplicates.ply", Cloud(2895)),
    ("hostile/pdal_issue_2421.ply", Cloud(1)),
    ("hostile/pdal_mesh.ply", Cloud(4)),
    ("hostile/pdal_no_vertex.ply", Fails("bad-file", Some(3))),
    ("hostile/pdal_simple_text.ply", Cloud(3)),
    ("hostile/pdal_unsized_dims.ply", Fails("bad-file", Some(4))),
    (
        "hostile/plyrs_all_atomic_types_ok_ascii.ply",
        Fails("bad-file", Some(22)),
    ),
    (
        "hostile/plyrs_exponent_values_ok_ascii.ply",
        Fails("bad-file", Some(8)),
    ),
    ("hostile/plyrs_greg_turk_example2_ok_ascii.ply", Cloud(8)),
    (
        "hostile/plyrs_single_elements_err_ascii.ply",
        Fails("bad-file", Some(8)),
    ),
    ("hostile/pyntcloud_diamond_ascii_vertex_index.ply", Cloud(6)),
    ("hostile/trimesh_ply_empty_bin.ply", Cloud(0)),
    (
        "hostile/trimesh_ply_empty_header.ply",
        Fails("bad-file", Some(3)),
    ),
    ("hostile/trimesh_ply_points_bin.ply", Cloud(8)),
    ("hostile/trimesh_points_ascii_with_lists.ply", Cloud(5)),
    ("hostile/trimesh_points_emptyface.ply", Cloud(1024)),
    ("hostile/pdal_bunny_8.pts", Cloud(9)),
    ("hostile/pdal_badheader.txt", Fails("bad-file", Some(1))),
    ("hostile/pdal_crlf_test.txt", Cloud(10)),
    ("hostile/pdal_utm17_1.txt", Cloud(10)),
    ("hostile/trimesh_points_agisoft.xyz", Cloud(100)),
    ("hostile/trimesh_points_cloudcompare.xyz", Cloud(101)),
    ("scans/ball.ply", Cloud(31_374)),
    ("scans/oni.ply", Cloud(1_435)),
    ("scans/redwood_fragment_002.ply", Cloud(112_698)),
    ("scans/bunnyData.pts", Cloud(30_571)),
    ("scans/distcap.pts", Fails("bad-file", Some(3))),
    ("scans/findsurface_sample.xyz", Cloud(9_664)),
    ("scans/kitten.xyz", Cloud(5_210)),
    ("scans/sphere_20k_normal.xyz", Cloud(21_000)),
    ("scans/bunny_raw/bun000.ply", Cloud(40_256)),
    ("scans/bunny_raw/bun045.ply", Cloud(40_097)),
    ("scans/bunny_raw/bun090.ply", Cloud(30_379)),
    ("scans/bunny_raw/bun180.ply", Cloud(40_251)),
    ("scans/bunny_raw/bun270.ply", Cloud(31_701)),
    ("scans/bunny_raw/bun315.ply", Cloud(35_336)),
    ("scans/bunny_raw/chin.ply", Cloud(37_738)),
    ("scans/bunny_raw/ear_back.ply", Cloud(32_193)),
    ("scans/bunny_raw/top2.ply", Cloud(38_298)),
    ("scans/bunny_raw/top3.ply", Cloud(36_023)),
    ("scans/cad_scans/Range_Hood_4_BB1.6.ply", Cloud(10_074)),
    ("scans/cad_scans/Range_Hood_4_filtered.ply", Cloud(2_761)),
    ("scans/cad_scans/Separator_1_filtered.ply", Cloud(6_046)),
];

/// The folder of shared data, or `None` with a printed line.
fn data() -> Option<PathBuf> {
    let shared = std::env::var_os("POINTWEAVE_SHARED").map(PathBuf::from);
    let beside = || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared");
    let data = shared.unwrap_or_else(beside).join("data");
    if data.is_dir() {
        return Some(data);
    }
    println!(
        "SKIPPED: no shared data at {}; set POINTWEAVE_SHARED",
        data.display()
    );
    None
}

fn read_named(bytes: &[u8], name: &str) -> Result<RawCloud, Error> {
    detect(bytes, Some(name)).and_then(|format| read(bytes, format))
}

fn outcome(result: &Result<RawCloud, Error>) -> Outcome {
    match result {
        Ok(cloud) if cloud.dropped > 0 => Dropped(cloud.points(), cloud.dropped),
        Ok(cloud) => Cloud(cloud.points()),
        Err(error) => Fails(error.code(), error.index()),
    }
}

fn values(positions: &Positions) -> Vec<f64> {
    match positions {
        Positions::F32(values) => values.iter().map(|&x| f64::from(x)).collect(),
        Positions::F64(values) => values.clone(),
    }
}

fn bounds(cloud: &RawCloud) -> ([f64; 3], [f64; 3]) {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for point in values(&cloud.positions).chunks(3) {
        for axis in 0..3 {
            low[axis] = low[axis].min(point[axis]);
            high[axis] = high[axis].max(point[axis]);
        }
    }
    (low, high)
}

#[test]
fn every_shared_file_ends_in_the_right_result_or_a_typed_error() {
    let Some(data) = data() else { return };
    for (name, expected) in &FILES {
        let bytes = std::fs::read(data.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
        let result = read_named(&bytes, name);
        assert_eq!(
            &outcome(&result),
            expected,
            "{name}: {:?}",
            result.as_ref().err()
        );
        if let Err(error) = result {
            println!("{name}: {error}");
            assert!(error.to_string().lines().count() == 1, "{name}: {error}");
        }
    }
}

/// Name, size of the bounding box, colours, normals, names of attributes.
type Facts = (&'static str, [f64; 3], bool, bool, &'static [&'static str]);

#[test]
fn sizes_and_kinds_are_as_the_data_readme_says() {
    let Some(data) = data() else { return };
    const FACTS: [Facts; 17] = [
        (
            "scans/bunny_raw/bun000.ply",
            [0.1558, 0.1522, 0.1174],
            false,
            false,
            &[],
        ),
        (
            "meshes/bun_zipper.ply",
            [0.1557, 0.1543, 0.1207],
            false,
            false,
            &["confidence", "intensity"],
        ),
        ("scans/oni.ply", [0.5888, 1.0, 0.7537], false, true, &[]),
        (
            "scans/ball.ply",
            [84.76, 72.43, 81.0],
            false,
            true,
            &["segment_index"],
        ),
        (
            "scans/redwood_fragment_002.ply",
            [2.32, 1.458, 2.069],
            true,
            false,
            &[],
        ),
        (
            "scans/kitten.xyz",
            [0.651, 0.9986, 0.5906],
            false,
            true,
            &[],
        ),
        (
            "scans/sphere_20k_normal.xyz",
            [2.169, 2.175, 2.223],
            false,
            true,
            &[],
        ),
        (
            "scans/bunnyData.pts",
            [0.1557, 0.1473, 0.1207],
            false,
            false,
            &[],
        ),
        (
            "scans/findsurface_sample.xyz",
            [1.407, 0.8492, 0.8362],
            false,
            false,
            &[],
        ),
        (
            "hostile/trimesh_points_agisoft.xyz",
            [16.5, 41.4, 12.39],
            true,
            false,
            &[],
        ),
        (
            "hostile/trimesh_points_cloudcompare.xyz",
            [16.5, 83.8, 17.85],
            true,
            false,
            &["intensity"],
        ),
        (
            "hostile/pdal_crlf_test.txt",
            [4.35, 1.98, 0.18],
            false,
            false,
            &["Intensity"],
        ),
        (
            "hostile/happly_platonic_shelf_big_endian.ply",
            [13.49, 2.316, 2.316],
            false,
            false,
            &[],
        ),
        (
            "hostile/pcu_bunny_duplicates.ply",
            [0.9989, 0.9795, 0.7701],
            false,
            false,
            &[],
        ),
        (
            "hostile/trimesh_points_emptyface.ply",
            [265.5, 209.4, 167.8],
            false,
            false,
            &[],
        ),
        (
            "hostile/pyntcloud_diamond_ascii_vertex_index.ply",
            [1.0, 1.0, 1.0],
            true,
            true,
            &["alpha"],
        ),
        (
            "hostile/draco_int_point_cloud.ply",
            [388.0, 268.0, 7.0],
            false,
            false,
            &[],
        ),
    ];
    for (name, size, colors, normals, attributes) in FACTS {
        let bytes = std::fs::read(data.join(name)).unwrap();
        let cloud = read_named(&bytes, name).unwrap();
        let (low, high) = bounds(&cloud);
        for axis in 0..3 {
            let found = high[axis] - low[axis];
            let off = (found - size[axis]).abs();
            assert!(
                off <= 6e-4 * size[axis],
                "{name} axis {axis}: {found} is not {}",
                size[axis]
            );
        }
        assert_eq!(cloud.colors.is_some(), colors, "{name}");
        assert_eq!(cloud.normals.is_some(), normals, "{name}");
        let names: Vec<&str> = cloud.attributes.iter().map(|a| a.name.as_str()).collect();
        assert_eq!(names, attributes, "{name}");
    }
}

#[test]
fn georeferenced_coordinates_stay_exact() {
    let Some(data) = data() else { return };
    let name = "hostile/pdal_utm17_1.txt";
    let cloud = read_named(&std::fs::read(data.join(name)).unwrap(), name).unwrap();
    let Positions::F64(positions) = &cloud.positions else {
        panic!("{name} does not fit single precision")
    };
    assert_eq!(positions[..3], [289_814.15, 4_320_978.61, 170.76]);
    for format in Format::ALL {
        for ascii in [false, true] {
            let options = WriteOptions {
                ascii,
                ..Default::default()
            };
            let output = Output::from_name(format.name()).unwrap();
            let bytes = write(&cloud, None, output, options).unwrap();
            assert_eq!(read(&bytes, format).unwrap().positions, cloud.positions);
        }
    }
}
