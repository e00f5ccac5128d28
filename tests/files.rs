//! Files that others made: every one ends in the right result or in a typed error.
//!
//! Native only: a browser has no folder of shared data.
#![cfg(not(target_arch = "wasm32"))]

use pointweave::base::error::Error;
use pointweave::formats::{
    ColorValues, FaceMode, Format, Output, Positions, RawCloud, ReadOptions, Reading, Summary,
    WriteOptions, detect, read, write,
};
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

/// Every file of a format that is read, and every hostile one. The numbers are those of independent readers (laspy, Open3D,
/// plyfile, trimesh) where these read the file; each failure was looked at.
const FILES: [(&str, Outcome); 125] = [
    // It claims 353,535,235,358 vertices and has eight, then the faces.
    (
        "hostile/assimp_OutOfMemory.off",
        Fails("bad-file", Some(11)),
    ),
    // UTF-16, which the message says.
    (
        "hostile/assimp_box_UTF16BE.obj",
        Fails("unknown-format", None),
    ),
    ("hostile/assimp_box_longline.obj", Cloud(8)),
    (
        "hostile/assimp_crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply",
        Fails("bad-file", Some(7)),
    ),
    (
        "hostile/assimp_cube_binary_header_with_RN_newline.ply",
        Cloud(8),
    ),
    ("hostile/assimp_empty.obj", Fails("bad-file", Some(1))),
    ("hostile/assimp_empty.ply", Fails("bad-file", Some(1))),
    ("hostile/assimp_float-color.ply", Cloud(3)),
    // Its faces name vertices that there are not; the vertices are right.
    ("hostile/assimp_malformed.obj", Cloud(8)),
    ("hostile/assimp_multiple_spaces.obj", Cloud(4)),
    // "3.1+e2" is no number in any language.
    (
        "hostile/assimp_number_formats.obj",
        Fails("bad-file", Some(11)),
    ),
    ("hostile/assimp_only_a_part_of_vertexcolors.obj", Cloud(5)),
    ("hostile/assimp_point_cloud.obj", Cloud(3)),
    ("hostile/assimp_points.ply", Cloud(4)),
    // 285 triangles, whose 855 corners are 146 places.
    ("hostile/assimp_sphereWithHole.stl", Cloud(146)),
    ("hostile/assimp_triangle_with_empty_solid.stl", Cloud(3)),
    ("hostile/draco_eof_test.obj", Cloud(3)),
    ("hostile/draco_float_inf_point_cloud.ply", Dropped(13, 3)),
    // No coordinate triple of it is finite.
    ("hostile/draco_inf_nan.obj", Dropped(0, 3)),
    ("hostile/draco_int_point_cloud.ply", Cloud(16)),
    ("hostile/draco_test_extra_whitespace.ply", Cloud(3)),
    ("hostile/draco_test_more_datatypes.ply", Cloud(3)),
    ("hostile/gaussian_train-1000.ply", Cloud(1000)),
    ("hostile/happly_platonic_shelf_big_endian.ply", Cloud(50)),
    ("hostile/las_bad_points_1.1.las", Cloud(1)),
    ("hostile/las_no-points-1.3.laz", Cloud(0)),
    // The message says that it is a Git LFS pointer.
    (
        "hostile/lfs_pointer_autzen.laz",
        Fails("unknown-format", None),
    ),
    ("hostile/pcl_object_template_padding.pcd", Cloud(1397)),
    ("hostile/pcljs_exist-nan.pcd", Dropped(8, 2)),
    ("hostile/pcu_bunny_duplicates.ply", Cloud(2895)),
    // Points are found by their offset, whatever stands before them.
    ("hostile/pdal_bad_vlr_count.las", Cloud(10)),
    // Names X, Y, X: which is z?
    ("hostile/pdal_badheader.txt", Fails("bad-file", Some(1))),
    // Its first line says 8, and nine rows follow: none is thrown away.
    ("hostile/pdal_bunny_8.pts", Cloud(9)),
    ("hostile/pdal_crlf_test.txt", Cloud(10)),
    // Version 126.203.
    (
        "hostile/pdal_ept_invalid_tile_2-2-2-2.laz",
        Fails("unsupported-file", None),
    ),
    // It claims 1,069,128,089 variable length records, which does not matter, and is cut off within the last of its 719
    // points.
    (
        "hostile/pdal_garbage_nVariableLength.las",
        Fails("bad-file", Some(14601)),
    ),
    ("hostile/pdal_issue_2421.ply", Cloud(1)),
    ("hostile/pdal_lots_of_vlr.las", Cloud(1)),
    ("hostile/pdal_mesh.ply", Cloud(4)),
    // Without a header it is rows of numbers, and read as such.
    ("hostile/pdal_missingheader.pcd", Cloud(10)),
    ("hostile/pdal_no-points.las", Cloud(0)),
    ("hostile/pdal_no_vertex.obj", Fails("bad-file", Some(2))),
    ("hostile/pdal_no_vertex.ply", Fails("bad-file", Some(3))),
    // Chunks of old LASzip, at which the decompressor of the crate `laz` panics; its record decompressors do not.
    (
        "hostile/pdal_simple-laszip-compressor-version-1.2r0.laz",
        Cloud(1065),
    ),
    ("hostile/pdal_simple_text.ply", Cloud(3)),
    // It has no z.
    ("hostile/pdal_unsized_dims.ply", Fails("bad-file", Some(4))),
    ("hostile/pdal_utm17_1.txt", Cloud(10)),
    ("hostile/pdal_utm17_comma.pcd", Cloud(10)),
    // Its properties are a to p: there are no coordinates.
    (
        "hostile/plyrs_all_atomic_types_ok_ascii.ply",
        Fails("bad-file", Some(22)),
    ),
    // It has no z, as the next but one.
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
    ("hostile/pyntcloud_has_offsets.las", Cloud(20)),
    ("hostile/tinyobj_invalid-face-definition.obj", Cloud(8)),
    // One face and no vertex.
    (
        "hostile/tinyobj_invalid-relative-vertex-index.obj",
        Fails("bad-file", Some(2)),
    ),
    ("hostile/tinyobj_issue-140-zero-face-idx.obj", Cloud(4)),
    (
        "hostile/tinyobj_leading-decimal-dot-issue-201.obj",
        Cloud(3),
    ),
    // 76 lines are vertices.
    ("hostile/tinyobj_test-nan.obj", Dropped(72, 4)),
    ("hostile/trimesh_comments.off", Cloud(8)),
    ("hostile/trimesh_nancolor.obj", Cloud(8)),
    ("hostile/trimesh_negative_indices.obj", Cloud(8)),
    ("hostile/trimesh_ply_empty_bin.ply", Cloud(0)),
    (
        "hostile/trimesh_ply_empty_header.ply",
        Fails("bad-file", Some(3)),
    ),
    ("hostile/trimesh_ply_points_bin.ply", Cloud(8)),
    ("hostile/trimesh_points_agisoft.xyz", Cloud(100)),
    ("hostile/trimesh_points_ascii_with_lists.ply", Cloud(5)),
    ("hostile/trimesh_points_cloudcompare.xyz", Cloud(101)),
    ("hostile/trimesh_points_emptyface.ply", Cloud(1024)),
    ("hostile/trimesh_stl_empty_ascii.stl", Cloud(0)),
    ("lidar/100-points.las", Cloud(100)),
    ("lidar/autzen_trim.las", Cloud(110_000)),
    ("lidar/autzen_trim.laz", Cloud(110_000)),
    ("lidar/ellipsoid.laz", Cloud(100_000)),
    ("lidar/epsg_4326.las", Cloud(5_380)),
    ("lidar/lidR_MixedConifer.laz", Cloud(37_657)),
    ("lidar/simple.laz", Cloud(1_065)),
    ("lidar/test1_4.las", Cloud(1_000)),
    ("lidar/formats/pdrf6-1.4.las", Cloud(1_024)),
    ("lidar/formats/pdrf6-1.4.laz", Cloud(1_024)),
    ("lidar/formats/pdrf8-1.4.las", Cloud(1_024)),
    ("lidar/formats/pdrf8-1.4.laz", Cloud(1_024)),
    ("lidar/lasr_pcd_ascii.pcd", Cloud(69_977)),
    ("meshes/Duck.glb", Cloud(2_399)),
    ("meshes/armadillo_libigl.obj", Cloud(43_243)),
    ("meshes/block.off", Cloud(2_132)),
    ("meshes/bun_zipper.ply", Cloud(35_947)),
    ("meshes/fandisk.obj", Cloud(6_475)),
    ("meshes/featuretype.stl", Cloud(2_010)),
    ("meshes/rocker_arm.obj", Cloud(10_044)),
    ("meshes/spot.obj", Cloud(11_533)),
    ("meshes/wingnut.obj", Cloud(3_047)),
    ("scans/Zaghetto.pcd", Cloud(59_750)),
    ("scans/ball.ply", Cloud(31_374)),
    ("scans/oni.ply", Cloud(1_435)),
    ("scans/redwood_fragment_002.ply", Cloud(112_698)),
    ("scans/bunnyData.pts", Cloud(30_571)),
    ("scans/findsurface_sample.xyz", Cloud(9_664)),
    ("scans/iphone_chair.obj", Cloud(9_701)),
    ("scans/kitten.xyz", Cloud(5_210)),
    ("scans/owl-little.obj", Cloud(10_000)),
    ("scans/sphere_20k_normal.xyz", Cloud(21_000)),
    ("scans/pcl/bun0.pcd", Cloud(397)),
    ("scans/pcl/chef.pcd", Cloud(5_092)),
    ("scans/pcl/lamppost.pcd", Cloud(1_771)),
    ("scans/pcl/milk_color.pcd", Cloud(13_704)),
    ("scans/cad_scans/CAD_Range_Hood.stl", Cloud(59)),
    ("scans/cad_scans/CAD_Separator.stl", Cloud(70)),
    ("scans/forest_plot/TLS_Clip.laz", Cloud(400_754)),
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
    ("meshes/duck.dae", Fails("unknown-format", None)),
    // Hoppe's format of 1992: rows start with the letter p.
    ("scans/distcap.pts", Cloud(12_745)),
    (
        "scans/pcl/milk_cartoon_all_small_clorox.pcd",
        Dropped(241_407, 65_793),
    ),
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

/// The package names the formats by hand: its check, its type, and its table for people with every extension.
#[test]
fn the_package_names_every_format_that_is_read() {
    let text = |path: &str| {
        let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(path);
        std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    };
    let quoted = |path: &str, start: &str, end: char| -> Vec<String> {
        let text = text(path);
        let (_, after) = text.split_once(start).expect(start);
        let list = after.split(end).next().expect("a list");
        list.split('\'')
            .skip(1)
            .step_by(2)
            .map(String::from)
            .collect()
    };
    let names = Format::ALL.map(Format::name);
    let checked = quoted("pkg/engine/options.js", "format: { ...choice(", ')');
    assert_eq!(checked, names, "READ.format of pkg/engine/options.js");
    let typed = quoted("pkg/types.d.ts", "export type Format =", ';');
    assert_eq!(typed, names, "Format of pkg/types.d.ts");
    let table = text("pkg/docs/files.md");
    for format in Format::ALL {
        let start = format!("| `{}` | `.", format.name());
        let row = table.lines().find(|line| line.starts_with(&start));
        let row = row.unwrap_or_else(|| panic!("no row of pkg/docs/files.md starts {start}"));
        for extension in format.extensions() {
            assert!(
                row.contains(&format!(".{extension}")),
                ".{extension}: {row}"
            );
        }
    }
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
            assert!(error.to_string().lines().count() == 1, "{name}: {error}");
        }
    }
    let hostile = std::fs::read_dir(data.join("hostile")).unwrap().count();
    let listed = FILES
        .iter()
        .filter(|(name, _)| name.starts_with("hostile/"));
    assert_eq!(
        listed.count(),
        hostile,
        "a hostile file is not in the table"
    );
}

/// Slices of every size give what the whole file gives.
#[test]
fn files_in_slices_are_the_same_files() {
    let Some(data) = data() else { return };
    for (name, expected) in FILES.iter().filter(|(name, _)| !name.contains("bunny_raw")) {
        let bytes = std::fs::read(data.join(name)).unwrap();
        let whole = read_named(&bytes, name);
        for size in [7, 4096, 100_000] {
            if bytes.len() / size > 3000 {
                continue;
            }
            let mut collected = Collected::default();
            let result = collected.read(&bytes, size, name);
            match (&whole, result) {
                (Ok(cloud), Ok(summary)) => collected.compare(cloud, &summary, name),
                (Err(whole), Err(error)) => assert_eq!(&error, whole, "{name} by {size}"),
                (whole, result) => panic!(
                    "{name} by {size}: {expected:?}, {result:?} is not {:?}",
                    whole.as_ref().err()
                ),
            }
        }
    }
}

/// The points of blocks.
#[derive(Default)]
struct Collected {
    positions: Vec<f64>,
    normals: Vec<f32>,
    colors: Vec<f32>,
    attributes: Vec<f32>,
}

impl Collected {
    fn read(&mut self, bytes: &[u8], size: usize, name: &str) -> Result<Summary, Error> {
        // As `read` does it.
        let vertices = ReadOptions {
            faces: FaceMode::Vertices,
            ..ReadOptions::default()
        };
        let mut reading =
            Reading::new(None, Some(name), bytes.len() as u64).with_options(vertices)?;
        for slice in bytes.chunks(size) {
            reading.push(slice)?;
            self.take(&mut reading);
        }
        while !reading.end()? {
            self.take(&mut reading);
        }
        self.take(&mut reading);
        Ok(reading.summary())
    }

    fn take(&mut self, reading: &mut Reading) {
        let Some((block, most)) = reading.take_block() else {
            return;
        };
        self.positions.extend(values(&block.positions));
        self.normals.extend(block.normals.unwrap_or_default());
        match block.colors {
            Some(ColorValues::Bytes(bytes)) => self.colors.extend(bytes.into_iter().map(f32::from)),
            Some(ColorValues::Numbers(numbers)) => self.colors.extend(numbers),
            None => {}
        }
        self.attributes.extend(
            block
                .attributes
                .iter()
                .flat_map(|attribute| &attribute.values),
        );
        assert!(most.is_none_or(|most| most >= self.positions.len() as u64 / 3));
    }

    fn compare(&self, cloud: &RawCloud, summary: &Summary, name: &str) {
        if !summary.verdict.left_out.is_empty() {
            // The blocks hold what only the end says is none.
            let left = summary.points - cloud.points() as u64;
            let later = cloud
                .skipped
                .iter()
                .filter(|(why, _)| ["no-data", "no-return"].contains(why));
            assert_eq!(left, later.map(|(_, count)| count).sum::<u64>(), "{name}");
            return;
        }
        let positions = if summary.verdict.narrow {
            self.positions
                .iter()
                .map(|&x| f64::from(x as f32))
                .collect()
        } else {
            self.positions.clone()
        };
        assert_eq!(positions, values(&cloud.positions), "{name}");
        if let Some(normals) = &cloud.normals {
            assert_eq!(&self.normals, normals, "{name}");
        }
        if let Some(colors) = &cloud.colors {
            let scaled = |c: &f32| (c * summary.verdict.color_scale).round() as u8;
            let bytes: Vec<u8> = self.colors.iter().map(scaled).collect();
            assert_eq!(&bytes, colors, "{name}");
        }
        assert_eq!(
            summary.verdict.has_colors && !self.colors.is_empty(),
            cloud.colors.as_ref().is_some_and(|c| !c.is_empty()),
            "{name}"
        );
        assert_eq!(
            summary.verdict.has_normals && !self.normals.is_empty(),
            cloud.normals.as_ref().is_some_and(|n| !n.is_empty()),
            "{name}"
        );
        let sum = |values: &[f32]| values.iter().map(|&x| f64::from(x)).sum::<f64>();
        let whole: f64 = cloud
            .attributes
            .iter()
            .map(|attribute| sum(&attribute.values))
            .sum();
        assert!(
            (sum(&self.attributes) - whole).abs() <= 1e-9 * whole.abs().max(1.0),
            "{name}"
        );
        assert_eq!(
            (summary.dropped, summary.replaced, summary.faces),
            (cloud.dropped, cloud.replaced, cloud.faces),
            "{name}"
        );
        assert_eq!(summary.points, cloud.points() as u64);
    }
}

/// Name, size of the bounding box, colours, normals, names of attributes.
type Facts = (&'static str, [f64; 3], bool, bool, &'static [&'static str]);

#[test]
fn sizes_and_kinds_are_as_the_data_readme_says() {
    let Some(data) = data() else { return };
    const FACTS: [Facts; 29] = [
        (
            "lidar/autzen_trim.laz",
            [1177.46, 562.7, 114.25],
            true,
            false,
            &["intensity", "classification"],
        ),
        (
            "lidar/formats/pdrf8-1.4.laz",
            [4.288_510e9, 4.286_665e9, 4.293_701e9],
            true,
            false,
            &["intensity", "classification", "nir"],
        ),
        (
            "lidar/epsg_4326.las",
            [0.022_834_3, 0.010_595, 39.038],
            false,
            false,
            &["intensity", "classification"],
        ),
        (
            "scans/pcl/milk_color.pcd",
            [0.1539, 0.2521, 0.177],
            true,
            false,
            &[],
        ),
        (
            "scans/pcl/chef.pcd",
            [0.2732, 0.123, 0.1072],
            false,
            true,
            &[],
        ),
        (
            "scans/pcl/bun0.pcd",
            [0.1535, 0.1471, 0.1128],
            false,
            true,
            &["curvature"],
        ),
        (
            "scans/Zaghetto.pcd",
            [0.5566, 0.4161, 0.1961],
            false,
            false,
            &[],
        ),
        (
            "scans/owl-little.obj",
            [115.8, 233.8, 169.9],
            false,
            false,
            &[],
        ),
        // In metres: the scene's node scales the centimetres of the mesh.
        ("meshes/Duck.glb", [1.655, 1.540, 1.153], false, true, &[]),
        ("meshes/block.off", [20.0, 20.0, 38.0], false, false, &[]),
        (
            "meshes/featuretype.stl",
            [5.0, 2.5, 1.375],
            false,
            false,
            &[],
        ),
        (
            "scans/forest_plot/TLS_Clip.laz",
            [23.874, 29.061, 35.844],
            false,
            false,
            &["intensity", "classification"],
        ),
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
        // Of LAS other fields follow, where they are used.
        if name.contains("lidar/") {
            assert!(
                attributes.iter().all(|n| names.contains(n)),
                "{name}: {names:?}"
            );
        } else {
            assert_eq!(names, *attributes, "{name}");
        }
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
    for format in Format::WRITTEN {
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

/// Points, sums of intensity and classification, sum of the red bytes, the first point: as laspy gives them.
type Lidar = (&'static str, usize, f64, f64, u64, [f64; 3]);

#[test]
fn lidar_is_what_laspy_reads() {
    let Some(data) = data() else { return };
    const LIDAR: [Lidar; 12] = [
        (
            "lidar/autzen_trim.las",
            110000,
            11220547.0,
            136107.0,
            12255922,
            [637177.98, 849393.9500000001, 411.19],
        ),
        (
            "lidar/autzen_trim.laz",
            110000,
            11220547.0,
            136107.0,
            12255922,
            [637177.98, 849393.9500000001, 411.19],
        ),
        (
            "lidar/ellipsoid.laz",
            100000,
            19150000.0,
            1098884.0,
            14149958,
            [-8242746.0, 4966605.44, -0.28],
        ),
        (
            "lidar/epsg_4326.las",
            5380,
            352578300.0,
            0.0,
            0,
            [-94.6639387, 31.0367341, 47.8700002],
        ),
        (
            "lidar/lidR_MixedConifer.laz",
            37657,
            3178363.0,
            43527.0,
            0,
            [481349.53, 3813010.75, 0.07],
        ),
        (
            "lidar/simple.laz",
            1065,
            81361.0,
            1341.0,
            129567,
            [637012.24, 849028.31, 431.66],
        ),
        (
            "lidar/test1_4.las",
            1000,
            38007.0,
            2000.0,
            0,
            [1694510.3869346841, 1816497.966263977, 5598.3596128149675],
        ),
        (
            "lidar/formats/pdrf6-1.4.laz",
            1024,
            33049351.0,
            128752.0,
            0,
            [373598160.0, 295657190.0, 195961234.0],
        ),
        (
            "lidar/formats/pdrf8-1.4.las",
            1024,
            32866212.0,
            130942.0,
            136330,
            [373598160.0, 295657190.0, 195961234.0],
        ),
        (
            "lidar/formats/pdrf8-1.4.laz",
            1024,
            32866212.0,
            130942.0,
            136330,
            [373598160.0, 295657190.0, 195961234.0],
        ),
        (
            "scans/forest_plot/TLS_Clip.laz",
            400754,
            0.0,
            0.0,
            0,
            [-186.7235, -126.53425, 24.560249999999996],
        ),
        (
            "hostile/pyntcloud_has_offsets.las",
            20,
            566947.0,
            20.0,
            2063,
            [-44490.842948180776, -135781.17522365286, 54.584930982349874],
        ),
    ];
    for (name, points, intensity, classes, red, first) in LIDAR {
        let cloud = read_named(&std::fs::read(data.join(name)).unwrap(), name).unwrap();
        let Positions::F64(positions) = &cloud.positions else {
            panic!("{name} is in single precision")
        };
        assert_eq!(positions[..3], first, "{name}");
        assert_eq!(cloud.points(), points, "{name}");
        let sum = |i: usize| {
            cloud.attributes[i]
                .values
                .iter()
                .map(|&x| f64::from(x))
                .sum::<f64>()
        };
        assert_eq!([sum(0), sum(1)], [intensity, classes], "{name}");
        let reds = cloud
            .colors
            .iter()
            .flat_map(|colors| colors.iter().step_by(3));
        assert_eq!(reds.map(|&c| u64::from(c)).sum::<u64>(), red, "{name}");
    }
}
