//! Meshes as scans: where points of faces lie, how evenly, which way they look, and what colour they have.
#![cfg(not(target_arch = "wasm32"))]

#[path = "common/mesh_files.rs"]
mod mesh_files;

use mesh_files::{glb, png};
use pointweave::formats::{
    FaceMode, Format, Positions, RawCloud, ReadOptions, Reading, Skin, Want, decode_picture,
    read_beside, read_with,
};

fn values(cloud: &RawCloud) -> Vec<[f64; 3]> {
    let flat: Vec<f64> = match &cloud.positions {
        Positions::F32(values) => values.iter().map(|&x| f64::from(x)).collect(),
        Positions::F64(values) => values.clone(),
    };
    flat.as_chunks().0.to_vec()
}

fn normals(cloud: &RawCloud) -> Vec<[f32; 3]> {
    cloud
        .normals
        .as_ref()
        .expect("faces have normals")
        .as_chunks()
        .0
        .to_vec()
}

fn colors(cloud: &RawCloud) -> Vec<[u8; 3]> {
    cloud
        .colors
        .as_ref()
        .expect("colours")
        .as_chunks()
        .0
        .to_vec()
}

fn sampled(file: &[u8], format: Format) -> RawCloud {
    let cloud = read_with(file, format, &ReadOptions::default()).expect("a good file");
    assert!(cloud.sampling.points > 0);
    cloud
}

/// Squared distance to the nearest other point, for some of the points.
fn spacings(points: &[[f64; 3]]) -> Vec<f64> {
    let distance = |a: [f64; 3], b: [f64; 3]| {
        (0..3)
            .map(|k| (a[k] - b[k]) * (a[k] - b[k]))
            .sum::<f64>()
            .sqrt()
    };
    (0..points.len())
        .step_by(points.len() / 300)
        .map(|i| {
            let others = points.iter().enumerate().filter(|&(j, _)| j != i);
            others
                .map(|(_, &other)| distance(points[i], other))
                .fold(f64::INFINITY, f64::min)
        })
        .collect()
}

/// Two squares of sides 3 and 1, far apart.
const SQUARES: &str = "OFF\n8 2 0\n0 0 0\n3 0 0\n3 3 0\n0 3 0\n10 0 0\n11 0 0\n11 0 1\n10 0 1\n4 0 1 2 3\n4 4 5 6 7\n";

#[test]
fn points_are_as_many_as_the_area_says_and_keep_apart() {
    let cloud = sampled(SQUARES.as_bytes(), Format::Off);
    let points = values(&cloud);
    assert_eq!(
        (points.len(), cloud.sampling.points, cloud.faces),
        (100_000, 100_000, 2)
    );
    let large = points.iter().filter(|p| p[0] < 5.0).count();
    assert!(large.abs_diff(90_000) < 100, "{large}");
    // Quarters of the large square, too.
    for quarter in 0..4 {
        let inside = |p: &&[f64; 3]| {
            p[0] < 3.0 && (usize::from(p[0] > 1.5) + 2 * usize::from(p[1] > 1.5)) == quarter
        };
        let count = points.iter().filter(inside).count();
        assert!(count.abs_diff(22_500) < 100, "{count}");
    }
    // Random points of that density have a mean spacing of half of it, and no least one.
    let packed = (2.0 / 3f64.sqrt() * 10.0 / 100_000.0).sqrt();
    let apart = spacings(&points);
    let least = {
        let mut sorted = apart.clone();
        sorted.sort_by(f64::total_cmp);
        sorted[sorted.len() / 50]
    };
    let mean = apart.iter().sum::<f64>() / apart.len() as f64;
    assert!(
        least > 0.5 * packed && mean > 0.7 * packed,
        "{least} {mean} of {packed}"
    );
}

#[test]
fn large_meshes_get_four_points_a_triangle() {
    let side = 201;
    let mut file = format!("OFF\n{} {} 0\n", side * side, (side - 1) * (side - 1));
    for i in 0..side * side {
        file += &format!("{} {} 0\n", i % side, i / side);
    }
    for i in 0..(side - 1) * (side - 1) {
        let a = i / (side - 1) * side + i % (side - 1);
        file += &format!("4 {} {} {} {}\n", a, a + 1, a + side + 1, a + side);
    }
    let cloud = sampled(file.as_bytes(), Format::Off);
    assert_eq!(cloud.points(), 4 * 2 * 200 * 200);
}

fn cube_stl() -> Vec<u8> {
    let corner = |i: usize| [i & 1, i >> 1 & 1, i >> 2 & 1].map(|x| x as f32);
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let mut file = vec![b' '; 80];
    file.extend(12u32.to_le_bytes());
    for [a, b, c, d] in quads {
        for triangle in [[a, b, c], [a, c, d]] {
            file.extend([0; 12]);
            triangle
                .iter()
                .flat_map(|&i| corner(i))
                .for_each(|x| file.extend(x.to_le_bytes()));
            file.extend([0; 2]);
        }
    }
    file
}

#[test]
fn a_cube_stays_one_and_looks_outward() {
    let cloud = sampled(&cube_stl(), Format::Stl);
    for (p, n) in values(&cloud).into_iter().zip(normals(&cloud)) {
        // On one side of the cube, whose normal it has: creases are not rounded.
        let axis = (0..3)
            .find(|&k| n[k].abs() == 1.0)
            .expect("a normal along an axis");
        assert_eq!(p[axis], if n[axis] > 0.0 { 1.0 } else { 0.0 });
        assert!(p.iter().all(|x| (0.0..=1.0).contains(x)));
    }
}

#[test]
fn normals_of_the_file_are_interpolated_and_smooth_ones_are_made() {
    let roof = "v 0 0 0\nv 1 0 0.2\nv 2 0 0\nv 0 1 0\nv 1 1 0.2\nv 2 1 0\n";
    let said = format!("{roof}vn 1 0 0\nvn 0 1 0\nf 1//1 2//2 5//2 4//1\n");
    let cloud = sampled(said.as_bytes(), Format::Obj);
    for (p, n) in values(&cloud).into_iter().zip(normals(&cloud)) {
        let [x, y] = [1.0 - p[0], p[0]];
        let length = (x * x + y * y).sqrt();
        assert!(
            (f64::from(n[0]) - x / length).abs() < 1e-3
                && (f64::from(n[1]) - y / length).abs() < 1e-3,
            "{p:?} {n:?}"
        );
    }
    // Without normals: straight up at the ridge, which is too flat for a crease.
    let silent = format!("{roof}f 1 2 5 4\nf 2 3 6 5\n");
    let cloud = sampled(silent.as_bytes(), Format::Obj);
    let ridge = values(&cloud)
        .into_iter()
        .zip(normals(&cloud))
        .filter(|(p, _)| (p[0] - 1.0).abs() < 0.01);
    assert!(ridge.map(|(_, n)| n).all(|n| n[2] > 0.995));
}

#[test]
fn vertex_colours_and_scalars_are_interpolated_and_labels_are_not() {
    let file = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n\
                property uchar blue\nproperty float quality\nproperty float label\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
                0 0 0 0 0 0 0 1\n1 0 0 200 0 0 0.5 2\n0 1 0 0 100 0 0.5 7\n3 0 1 2\n";
    let cloud = sampled(file.as_bytes(), Format::Ply);
    for ((i, p), c) in values(&cloud).into_iter().enumerate().zip(colors(&cloud)) {
        assert!(
            (200.0 * p[0] - f64::from(c[0])).abs() < 0.51
                && (100.0 * p[1] - f64::from(c[1])).abs() < 0.51
        );
        let [quality, label] = [0, 1].map(|k| f64::from(cloud.attributes[k].values[i]));
        assert!((quality - 0.5 * (p[0] + p[1])).abs() < 1e-6);
        assert!([1.0, 2.0, 7.0].contains(&label));
    }
}

#[test]
fn faces_have_colours_of_their_own() {
    let file = SQUARES
        .replace("4 0 1 2 3", "4 0 1 2 3 255 0 128")
        .replace("4 4 5 6 7", "4 4 5 6 7 0.0 1.0 0.2");
    let cloud = sampled(file.as_bytes(), Format::Off);
    for (p, c) in values(&cloud).into_iter().zip(colors(&cloud)) {
        assert_eq!(
            c,
            if p[0] < 5.0 {
                [255, 0, 128]
            } else {
                [0, 255, 51]
            }
        );
    }
}

/// Red, green, blue and white, from the left to the right and from the top down.
fn four() -> Vec<u8> {
    png(
        2,
        2,
        &[
            [255, 0, 0, 255],
            [0, 255, 0, 255],
            [0, 0, 255, 255],
            [255, 255, 255, 255],
        ],
    )
}

/// A square whose corners have the corners of the picture of [`four`], with this material library.
fn square(library: &str, name: &str) -> RawCloud {
    let file = format!(
        "mtllib {name}\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3 4/4\n"
    );
    read_beside(
        file.as_bytes(),
        Format::Obj,
        &ReadOptions::default(),
        &mut |name| match name {
            "my scan.mtl" | "b.mtl" => Some(library.into()),
            "my tex.png" => Some(four()),
            _ => None,
        },
    )
    .expect("an OBJ file")
}

#[test]
fn maps_of_an_obj_are_moved_scaled_and_quoted() {
    let plain = square("newmtl a\nmap_Kd my tex.png\n", "my scan.mtl");
    let corners = [(0.1, 0.1), (0.9, 0.1), (0.1, 0.9), (0.9, 0.9)];
    let [low, right, upper, far] = corners.map(|(x, y)| color_at(&plain, x, y));
    assert_ne!(low, far);
    for (library, name) in [
        ("newmtl a\nmap_Kd \"my tex.png\"\n", "my scan.mtl"),
        ("newmtl a\nmap_Kd my tex.png\n", "a.mtl b.mtl"),
        ("newmtl a\nmap_Kd my tex.png\n", "\"my scan.mtl\""),
    ] {
        let cloud = square(library, name);
        assert_eq!(
            corners.map(|(x, y)| color_at(&cloud, x, y)),
            [low, right, upper, far]
        );
    }
    // The middles of the pixels lie in the square's corners; and one of them everywhere.
    let inner = square(
        "newmtl a\nmap_Kd -s 0.5 0.5 -o 0.25 0.25 my tex.png\n",
        "b.mtl",
    );
    let pixels = [[0, 0, 255], [255, 255, 255], [255, 0, 0], [0, 255, 0]];
    for ((x, y), pixel) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)]
        .into_iter()
        .zip(pixels)
    {
        let found = color_at(&inner, x, y);
        assert!(
            found
                .iter()
                .zip(pixel)
                .all(|(&a, b): (&u8, u8)| a.abs_diff(b) < 12),
            "{found:?}"
        );
    }
    let one = square(
        "newmtl a\nmap_Kd -s 0 0 1 -o 0.75 0.25 0 my tex.png\n",
        "b.mtl",
    );
    assert!(colors(&one).iter().all(|color| *color == [255; 3]));
}

#[test]
fn a_ply_has_the_colours_of_its_texture() {
    let plain = square("newmtl a\nmap_Kd my tex.png\n", "my scan.mtl");
    for names in [["s", "t"], ["texture_u", "texture_v"]] {
        let file = format!(
            "ply\nformat ascii 1.0\ncomment TextureFile my tex.png\nelement vertex 4\nproperty float x\nproperty float y\n\
             property float z\nproperty float {}\nproperty float {}\nelement face 1\nproperty list uchar int vertex_indices\n\
             end_header\n0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n4 0 1 2 3\n",
            names[0], names[1]
        );
        let cloud = read_beside(
            file.as_bytes(),
            Format::Ply,
            &ReadOptions::default(),
            &mut |name| (name == "my tex.png").then(four),
        )
        .expect("a PLY file");
        assert!(cloud.attributes.is_empty());
        for (x, y) in [(0.1, 0.1), (0.9, 0.1), (0.1, 0.9), (0.9, 0.9)] {
            assert_eq!(color_at(&cloud, x, y), color_at(&plain, x, y));
        }
    }
}

#[test]
fn an_obj_has_the_colours_of_its_materials() {
    let obj = "mtllib my scan.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 3 0 0\nv 4 0 0\nv 4 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
               usemtl photo\nf 1/1 2/2 3/3 4/4\nusemtl plain\nf -3 -2 -1\n";
    let mtl =
        b"newmtl photo\nKd 0.2 0.2 0.2\nmap_Kd -clamp on tex\\four.png\nnewmtl plain\nKd 1 0.5 0\n";
    let mut asked = Vec::new();
    let mut beside = |name: &str| {
        asked.push(name.to_string());
        if name == "my scan.mtl" {
            Some(mtl.to_vec())
        } else {
            Some(four())
        }
    };
    let cloud = read_beside(
        obj.as_bytes(),
        Format::Obj,
        &ReadOptions::default(),
        &mut beside,
    )
    .unwrap();
    assert_eq!(asked, ["my scan.mtl", "tex\\four.png"]);
    for (p, c) in values(&cloud).into_iter().zip(colors(&cloud)) {
        // Beyond the outer centres of pixels there is nothing to mix.
        let corner =
            |x: f64, y: f64| p[0] < 2.0 && (p[0] - x).abs() < 0.25 && (p[1] - y).abs() < 0.25;
        let expected = match () {
            _ if corner(0.0, 1.0) => [255, 0, 0],
            _ if corner(1.0, 1.0) => [0, 255, 0],
            _ if corner(0.0, 0.0) => [0, 0, 255],
            _ if corner(1.0, 0.0) => [255, 255, 255],
            _ if p[0] > 2.0 => [255, 128, 0],
            _ => continue,
        };
        assert_eq!(c, expected, "{p:?}");
    }
    // Without the files the points are there, and what is missing is said.
    let cloud = read_with(obj.as_bytes(), Format::Obj, &ReadOptions::default()).unwrap();
    assert_eq!((cloud.points(), cloud.colors), (100_000, None));
    assert_eq!(cloud.sampling.missing, ["my scan.mtl"]);
}

/// A square of side 1 with places from 0 to 1, and this material.
fn textured(material: &str, sampler: &str, extra: &str) -> RawCloud {
    sampled(&glb(material, sampler, extra, &four()), Format::Glb)
}

/// The colour of the point nearest to a place.
fn color_at(cloud: &RawCloud, x: f64, y: f64) -> [u8; 3] {
    let points = values(cloud);
    let apart = |p: &[f64; 3]| (p[0] - x) * (p[0] - x) + (p[1] - y) * (p[1] - y);
    let nearest =
        (0..points.len()).min_by(|&a, &b| apart(&points[a]).total_cmp(&apart(&points[b])));
    colors(cloud)[nearest.unwrap()]
}

#[test]
fn a_glb_has_the_colours_of_its_texture() {
    // Places of glTF start at the top.
    let base = r#"{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}"#;
    let cloud = textured(base, "{}", "");
    assert_eq!(
        [(0.25, 0.25), (0.75, 0.25), (0.25, 0.75), (0.75, 0.75)]
            .map(|(x, y)| color_at(&cloud, x, y))
            .map(|[r, g, b]| [r > 200, g > 200, b > 200]),
        [
            [true, false, false],
            [false, true, false],
            [false, false, true],
            [true, true, true],
        ]
    );
    // At the border of a repeated picture it meets its other side.
    assert!(color_at(&cloud, 0.0, 0.25).iter().all(|&c| c < 140));
    let clamped = textured(base, r#"{"wrapS":33071,"wrapT":33071}"#, "");
    assert_eq!(color_at(&clamped, 0.0, 0.0), [255, 0, 0]);
    let nearest = textured(base, r#"{"magFilter":9728}"#, "");
    assert_eq!(
        [color_at(&nearest, 0.48, 0.2), color_at(&nearest, 0.52, 0.2)],
        [[255, 0, 0], [0, 255, 0]]
    );
}

#[test]
fn factors_multiply_linear_light_and_transforms_move_the_texture() {
    let half = r#"{"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.5,0.5,1],"baseColorTexture":{"index":0}}}"#;
    let nearest = r#"{"magFilter":9728}"#;
    // Half the light is 188 of 255 on a display.
    assert_eq!(color_at(&textured(half, nearest, ""), 0.9, 0.9), [188; 3]);
    let moved = r#"{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":{"offset":[0.5,0],"scale":[2,1]}}}}}"#;
    let cloud = textured(moved, nearest, "");
    // From a half on, twice around: green, red, green, red.
    let along = [0.1, 0.4, 0.6, 0.9].map(|x| color_at(&cloud, x, 0.2));
    assert_eq!(along, [[0, 255, 0], [255, 0, 0], [0, 255, 0], [255, 0, 0]]);
    let turned = r#"{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":{"rotation":1.5707963267948966}}}}}"#;
    // (u, v) becomes (v, -u): what was to the right is at the top.
    let cloud = textured(turned, nearest, "");
    assert_eq!(
        [
            color_at(&cloud, 0.2, 0.2),
            color_at(&cloud, 0.8, 0.2),
            color_at(&cloud, 0.2, 0.8)
        ],
        [[0, 0, 255], [255, 0, 0], [255, 255, 255]]
    );
    let plain = r#"{"pbrMetallicRoughness":{"baseColorFactor":[1,0,0.2158605,1]}}"#;
    assert_eq!(
        color_at(&textured(plain, "{}", ""), 0.5, 0.5),
        [255, 0, 128]
    );
}

#[test]
fn a_black_body_that_shines_has_the_colours_of_its_light() {
    let shining = r#"{"emissiveFactor":[1,1,1],"emissiveTexture":{"index":0},"pbrMetallicRoughness":{"baseColorFactor":[0,0,0,1]}}"#;
    let plain = r#"{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}"#;
    assert_eq!(
        colors(&textured(shining, "{}", "")),
        colors(&textured(plain, "{}", ""))
    );
}

#[test]
fn holes_of_a_texture_have_no_points() {
    let mask = r#"{"alphaMode":"MASK","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}"#;
    let picture = png(2, 1, &[[9, 9, 9, 255], [9, 9, 9, 0]]);
    let cloud = sampled(
        &glb(mask, r#"{"magFilter":9728}"#, "", &picture),
        Format::Glb,
    );
    assert!(values(&cloud).iter().all(|p| p[0] <= 0.5));
    assert!(cloud.points().abs_diff(50_000) < 200);
}

#[test]
fn a_mirrored_node_keeps_its_outer_side() {
    let material = "{}";
    let cloud = sampled(
        &glb(material, "{}", r#","scale":[-1,1,1]"#, &four()),
        Format::Glb,
    );
    assert!(values(&cloud).iter().all(|p| (-1.0..=0.0).contains(&p[0])));
    assert!(normals(&cloud).iter().all(|n| n[2] == 1.0));
}

#[test]
fn strips_and_polygons_become_triangles() {
    let strip = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\n\
                 property list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n6 0 1 2 3 -1 4\n";
    let cloud = sampled(strip.as_bytes(), Format::Ply);
    assert_eq!(cloud.faces, 2);
    assert!(normals(&cloud).iter().all(|n| n[2] == 1.0));
    assert!(values(&cloud).iter().all(|p| p[0] <= 1.0 && p[1] <= 1.0));
    // An arrowhead: nothing in its notch.
    let arrow = "OFF\n4 1 0\n0 0 0\n2 -1 0\n1 0 0\n2 1 0\n4 0 1 2 3\n";
    let cloud = sampled(arrow.as_bytes(), Format::Off);
    assert!(
        values(&cloud)
            .iter()
            .all(|p| p[1].abs() >= p[0] - 1.0 - 1e-6)
    );
}

#[test]
fn vertices_are_to_be_had_and_stay_where_there_is_no_area() {
    let options = ReadOptions {
        faces: FaceMode::Vertices,
        ..ReadOptions::default()
    };
    let cloud = read_with(SQUARES.as_bytes(), Format::Off, &options).unwrap();
    assert_eq!(
        (cloud.points(), cloud.faces, cloud.sampling.points),
        (8, 2, 0)
    );
    let line = "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n";
    let cloud = read_with(line.as_bytes(), Format::Obj, &ReadOptions::default()).unwrap();
    assert_eq!((cloud.points(), cloud.sampling.points), (3, 0));
}

#[test]
fn vertices_without_faces_are_left_out_and_faces_without_vertices_too() {
    // Depth cameras write 0 0 0 for no return.
    let mut file = "v 1 1 1\nv 2 1 1\nv 1 2 1\nf 1 2 3\nf 1 2 99\n".to_string();
    file += &"v 0 0 0\n".repeat(9);
    let cloud = sampled(file.as_bytes(), Format::Obj);
    assert!(values(&cloud).iter().all(|p| p[2] == 1.0));
    assert_eq!((cloud.sampling.unused, cloud.sampling.broken), (9, 1));
    // A scan with a face beside it stays a scan.
    let mut file = "v 1 1 1\nv 2 1 1\nv 1 2 1\nf 1 2 3\n".to_string();
    (0..50).for_each(|i| file += &format!("v {i} 0 7\n"));
    let cloud = sampled(file.as_bytes(), Format::Obj);
    assert_eq!(values(&cloud).iter().filter(|p| p[2] == 7.0).count(), 50);
    assert!(cloud.sampling.unused == 0 && cloud.skipped.is_empty());
    // Vertices that are not finite take their faces with them, and no other's.
    let file = "v nan 0 0\nv 1 1 1\nv 2 1 1\nv 1 2 1\nf 1 2 3\nf 2 3 4\n";
    let cloud = sampled(file.as_bytes(), Format::Obj);
    assert_eq!((cloud.dropped, cloud.sampling.broken), (1, 1));
    assert!(values(&cloud).iter().all(|p| p[2] == 1.0));
}

#[test]
fn the_same_points_come_from_slices_and_again() {
    let file = cube_stl();
    let whole = sampled(&file, Format::Stl);
    assert_eq!(whole, sampled(&file, Format::Stl));
    let mut reading = Reading::new(None, Some("cube.stl"), file.len() as u64);
    for slice in file.chunks(100) {
        reading.push(slice).unwrap();
        assert!(reading.take_block().is_none(), "vertices are no points");
    }
    while !reading.end().unwrap() {
        assert_eq!(reading.want(), None::<Want>);
    }
    let (block, _) = reading.take_block().unwrap();
    let Positions::F64(values) = block.positions else {
        panic!("the verdict narrows")
    };
    let narrow: Vec<f32> = values.iter().map(|&x| x as f32).collect();
    assert_eq!(Positions::F32(narrow), whole.positions);
    assert_eq!(reading.summary().sampling.points, 100_000);
}

#[test]
fn far_away_meshes_stay_exact() {
    let file = "OFF\n4 1 0\n500000 4000000 0\n500003 4000000 0\n500003 4000003 0\n500000 4000003 0\n4 0 1 2 3\n";
    let cloud = sampled(file.as_bytes(), Format::Off);
    assert!(matches!(cloud.positions, Positions::F64(_)));
}

/// Reads a file whole, with the pictures of its triangles.
fn worn(bytes: &[u8]) -> Option<Skin> {
    let options = ReadOptions {
        faces: FaceMode::Mesh,
        ..ReadOptions::default()
    };
    let mut reading = Reading::new(None, None, bytes.len() as u64)
        .with_options(options)
        .unwrap();
    reading.push(bytes).unwrap();
    while !reading.end().unwrap() {
        match reading.want() {
            Some(Want::Picture(bytes)) => reading.give_picture(decode_picture(&bytes)),
            Some(Want::File(_)) => reading.give_file(None),
            None => panic!("it waits for nothing"),
        }
    }
    reading.take_skin()
}

#[test]
fn a_glb_of_one_material_keeps_its_pictures() {
    let material = r#"{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}},"normalTexture":{"index":0},"occlusionTexture":{"index":0}}"#;
    let skin = worn(&glb(material, "{}", "", &four())).unwrap();
    assert_eq!(skin.uvs, [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0]);
    for picture in [skin.color, skin.normal, skin.occlusion] {
        assert_eq!(picture, Some(four()), "the bytes as they are");
    }
    assert_eq!(skin.tangents, None);
    for other in [
        r#"{"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1],"baseColorTexture":{"index":0}}}"#,
        r#"{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1}}}"#,
        r#"{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":{"scale":[2,2]}}}}}"#,
        r#"{"pbrMetallicRoughness":{"baseColorTexture":{"index":7}}}"#,
        "{}",
    ] {
        assert_eq!(worn(&glb(other, "{}", "", &four())), None, "{other}");
    }
}
