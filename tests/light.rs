//! Meshes with fewer triangles: how many, how near, of which topology.

mod common;

use common::mesh::Flaws;
use common::{Shape, points};
use glam::DVec3;
use pointweave::formats::{FaceMode, ReadOptions, Reading};
use pointweave::light::SimplifyParams;
use pointweave::params::Boundary;
use pointweave::pipeline::simplify;
use pointweave::progress::Silent;
use pointweave::{Cloud, Error, SurfaceParams, reconstruct};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn params(triangles: usize) -> SurfaceParams {
    SurfaceParams {
        reduce: None,
        triangles: Some(triangles),
        ..Default::default()
    }
}

#[test]
fn a_reconstruction_keeps_to_its_budget_and_to_the_topology() {
    for shape in Shape::ALL {
        let cloud = Cloud::from_f64(&shape.sample(4000, 0.0, 41)).unwrap();
        for most in [400, 1001, 6000] {
            let s = reconstruct(&cloud, &params(most), &mut Silent).unwrap();
            let found = s.mesh.triangles.len();
            assert!(
                found <= most && found as f64 >= 0.98 * most as f64,
                "{shape:?}: {found}, not {most}"
            );
            let flaws = Flaws::of(&s.mesh.vertices, &s.mesh.triangles);
            assert!(
                flaws.is_clean() && flaws.folded == 0,
                "{shape:?} {most}: {flaws:?}"
            );
            assert_eq!(
                (&flaws.topology.genus, flaws.topology.boundary_edges),
                (&shape.genus(), 0)
            );
            assert_eq!(s.mesh.normals.len(), s.mesh.vertices.len());
            let told = s.report.simplified.as_ref().unwrap();
            assert_eq!(
                (told.triangles, s.report.triangles, &*told.reason),
                (found, found, "")
            );
            assert!(
                told.from > found && told.error.max < 0.03,
                "{shape:?} {most}: {told:?}"
            );
        }
    }
}

/// The corners of a box are what a budget of hardly more than its faces leaves.
#[test]
fn creases_and_corners_are_where_they_were() {
    let cloud = Cloud::from_f64(&Shape::Box.sample(8000, 0.0, 42)).unwrap();
    let s = reconstruct(&cloud, &params(200), &mut Silent).unwrap();
    let vertices = s.positions_f64();
    for i in 0..8 {
        let sign = |bit: usize| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let corner = DVec3::new(1.0, 0.7, 0.5) * DVec3::new(sign(0), sign(1), sign(2));
        let near = points(&vertices)
            .map(|v| v.distance(corner))
            .fold(f64::INFINITY, f64::min);
        assert!(near < 0.02, "{corner}: {near}");
    }
    let error = s.report.simplified.unwrap().error;
    assert!(error.rms < 2e-3 && error.max < 0.01, "{error:?}");
}

/// A hilly grid of `n` by `n` cells over the unit square, two triangles a cell.
fn sheet(n: usize) -> (Vec<f64>, Vec<u32>) {
    let mut positions = Vec::new();
    for i in 0..=n {
        for j in 0..=n {
            let (x, y) = (i as f64 / n as f64, j as f64 / n as f64);
            positions.extend([x, y, 0.1 * (6.0 * x).sin() * (5.0 * y).cos()]);
        }
    }
    let at = |i, j| (i * (n + 1) + j) as u32;
    let cell = |(i, j): (usize, usize)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [a, b, c, a, c, d]
    };
    let cells = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    (positions, cells.flat_map(cell).collect())
}

fn fewer(triangles: usize) -> SimplifyParams {
    SimplifyParams {
        triangles: Some(triangles),
        error: None,
    }
}

#[test]
fn a_border_stays_where_it_was_and_colours_stay_with_their_places() {
    let (positions, indices) = sheet(40);
    let colors: Vec<u8> = points(&positions)
        .flat_map(|p| [(255.0 * p.x) as u8, (255.0 * p.y) as u8, 7])
        .collect();
    let cloud = Cloud::from_f64(&positions)
        .unwrap()
        .with_colors(&colors)
        .unwrap();
    let (light, report) = simplify(&cloud, &indices, &fewer(300), &mut Silent).unwrap();
    assert!(
        report.triangles <= 300 && report.triangles >= 294,
        "{report:?}"
    );
    assert!(
        report.error.max < 0.01 && report.components == 1,
        "{report:?}"
    );
    for (v, color) in light.mesh.vertices.iter().zip(light.colors.unwrap()) {
        let [x, y, _] = cloud.frame.to_caller(*v);
        let expected = [255.0 * x, 255.0 * y, 7.0];
        let off = (0..3)
            .map(|k| (f64::from(color[k]) - expected[k]).abs())
            .fold(0.0, f64::max);
        assert!(off < 4.0, "{color:?} at {x} {y}");
    }
    let flat: f64 = light
        .mesh
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| {
                DVec3::from(cloud.frame.to_caller(light.mesh.vertices[v as usize])).with_z(0.0)
            });
            (b - a).cross(c - a).z / 2.0
        })
        .sum();
    assert!(
        (flat - 1.0).abs() < 2e-3,
        "seen from above it covers {flat} of the square"
    );
}

#[test]
fn an_error_is_kept_to_and_less_of_it_takes_more_triangles() {
    let (positions, indices) = sheet(40);
    let cloud = Cloud::from_f64(&positions).unwrap();
    let mut last = usize::MAX;
    for error in [1e-4, 1e-3, 1e-2] {
        let params = SimplifyParams {
            triangles: None,
            error: Some(error),
        };
        let (_, report) = simplify(&cloud, &indices, &params, &mut Silent).unwrap();
        assert!(
            report.error.max <= error && report.triangles < last,
            "{error}: {report:?}"
        );
        last = report.triangles;
    }
    assert!(last < 200, "{last}");
}

/// Corners of their own for every triangle, as STL has them, a triangle twice, one without area, and three on one edge.
#[test]
fn any_triangles_become_a_mesh() {
    let (positions, indices) = sheet(12);
    let place = |v: u32| positions[3 * v as usize..][..3].to_vec();
    let mut soup: Vec<f64> = indices.iter().flat_map(|&v| place(v)).collect();
    soup.extend_from_within(..9);
    soup.extend([0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    let [p, q] = [place(6 * 13 + 6), place(7 * 13 + 6)];
    soup.extend([p, q, vec![0.5, 0.5, 1.0]].concat());
    let all: Vec<u32> = (0..soup.len() as u32 / 3).collect();
    let cloud = Cloud::from_f64(&soup).unwrap();
    let (light, report) = simplify(&cloud, &all, &fewer(100), &mut Silent).unwrap();
    assert_eq!(
        (report.from, report.non_manifold_edges),
        (12 * 12 * 2 + 1, 1)
    );
    assert!(
        report.triangles <= 100 && report.reason.is_empty(),
        "{report:?}"
    );
    assert!(light.mesh.normals.is_empty());
}

#[test]
fn what_is_no_mesh_is_an_error() {
    let cloud = Cloud::from_f64(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 2.0, 0.0, 0.0]).unwrap();
    let error =
        |indices: &[u32], params| simplify(&cloud, indices, &params, &mut Silent).unwrap_err();
    assert!(matches!(
        error(&[0, 1], fewer(9)),
        Error::BadLength { found: 2, .. }
    ));
    assert!(matches!(
        error(&[0, 1, 3], fewer(9)),
        Error::BadIndex {
            index: 2,
            found: 3,
            ..
        }
    ));
    assert!(matches!(
        error(&[0, 1, 2], fewer(9)),
        Error::Degenerate { .. }
    ));
    for params in [
        fewer(0),
        SimplifyParams::default(),
        SimplifyParams {
            triangles: None,
            error: Some(0.0),
        },
    ] {
        assert!(
            matches!(error(&[0, 1, 2], params), Error::BadOption { .. }),
            "{params:?}"
        );
    }
}

/// A disc of 20,000 triangles around one vertex takes no longer than another mesh.
#[test]
fn a_wide_fan_is_no_trap() {
    let n = 20_000;
    let angle = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
    let rim = (0..n).flat_map(|i| [angle(i).cos(), angle(i).sin(), 0.0]);
    let positions: Vec<f64> = [0.0, 0.0, 0.5].into_iter().chain(rim).collect();
    let triangle = |i: usize| [0, 1 + i as u32, 1 + ((i + 1) % n) as u32];
    let indices: Vec<u32> = (0..n).flat_map(triangle).collect();
    let cloud = Cloud::from_f64(&positions).unwrap();
    let (_, report) = simplify(&cloud, &indices, &fewer(500), &mut Silent).unwrap();
    assert!(
        report.triangles <= 500 && report.error.max < 1e-3,
        "{report:?}"
    );
}

/// Two tetrahedra have no triangle to spare.
#[test]
fn as_few_as_the_surface_needs_are_said_to_be() {
    let corners = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    let moved = |by: f64| corners.map(|c| c.map(|x: f64| x + by));
    let positions = [moved(0.0), moved(3.0)].concat().concat();
    let tetrahedron = [0u32, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2];
    let indices = [tetrahedron, tetrahedron.map(|v| v + 4)].concat();
    let cloud = Cloud::from_f64(&positions).unwrap();
    let (_, report) = simplify(&cloud, &indices, &fewer(4), &mut Silent).unwrap();
    assert_eq!((report.triangles, report.components), (8, 2));
    assert!(
        report.reason.contains("8 triangles are left"),
        "{}",
        report.reason
    );
}

#[test]
fn an_open_surface_stays_open_and_a_wall_stays_a_wall() {
    let mut half = Shape::Sphere.sample(6000, 0.0, 43);
    half = points(&half)
        .filter(|p| p.z > 0.0)
        .flat_map(|p| p.to_array())
        .collect();
    let cloud = Cloud::from_f64(&half).unwrap();
    let params = SurfaceParams {
        boundary: Boundary::Open,
        ..params(300)
    };
    let s = reconstruct(&cloud, &params, &mut Silent).unwrap();
    let flaws = Flaws::of(&s.mesh.vertices, &s.mesh.triangles);
    assert!(
        flaws.is_clean() && flaws.topology.boundary_edges > 8,
        "{flaws:?}"
    );
    assert_eq!(flaws.topology.genus, [0]);
    assert_eq!(s.report.boundary_edges, flaws.topology.boundary_edges);
}

#[test]
fn a_file_gives_its_triangles_and_the_colours_of_its_faces() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n\
        property list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n\
        0 0 0\nnan 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 2 3 4 255 0 0\n3 0 1 2 0 0 255\n";
    let options = ReadOptions {
        faces: FaceMode::Mesh,
        ..Default::default()
    };
    let mut reading = Reading::new(None, None, ply.len() as u64)
        .with_options(options)
        .unwrap();
    reading.push(ply.as_bytes()).unwrap();
    while !reading.end().unwrap() {}
    let indices = reading.take_indices();
    assert_eq!(
        indices.len(),
        6,
        "the triangle with the vertex that is none is left out"
    );
    assert!(indices.iter().all(|&v| v < 4));
    let (block, _) = reading.take_block().unwrap();
    assert_eq!(block.positions.len(), 12);
}

#[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
#[test]
fn threads_do_not_change_a_byte() {
    let cloud = Cloud::from_f64(&Shape::Torus.sample(4000, 0.002, 44)).unwrap();
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| reconstruct(&cloud, &params(800), &mut Silent).unwrap().mesh)
    };
    assert!(with(1) == with(3));
}
