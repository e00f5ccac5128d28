//! Topology and distances against known truth and naive computation.

mod common;

use common::distances_to;
use glam::{DVec3, Vec3};
use pointweave::base::progress::Silent;
use pointweave::base::rng::Rng;
use pointweave::report::distance::{TriangleTree, closest_on_triangle, mesh_distance};
use pointweave::report::{
    DistanceStats, ReduceReport, StageTimes, SurfaceReport, Topology, area, topology, volume,
};
use pointweave::{Error, Stage};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// A grid of n × m quads over the whole of a torus (both seams closed), a tube (`v` open) or a sheet.
fn grid(
    n: u32,
    m: u32,
    closed: (bool, bool),
    at: impl Fn(f64, f64) -> DVec3,
) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (columns, rows) = (n + u32::from(!closed.0), m + u32::from(!closed.1));
    let vertices = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    let vertices = vertices
        .map(|(i, j)| at(i as f64 / n as f64, j as f64 / m as f64).as_vec3())
        .collect();
    let id = |i: u32, j: u32| i % columns + j % rows * columns;
    let quads = (0..m).flat_map(|j| (0..n).map(move |i| (i, j)));
    let triangles = quads.flat_map(|(i, j)| {
        let [p, q, r, s] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
        [[p, q, r], [p, r, s]]
    });
    (vertices, triangles.collect())
}

const TURN: f64 = 2.0 * std::f64::consts::PI;

fn torus(u: f64, v: f64) -> DVec3 {
    let (a, b) = (TURN * u, TURN * v);
    let r = 0.3 + 0.1 * libm::cos(b);
    DVec3::new(r * libm::cos(a), r * libm::sin(a), 0.1 * libm::sin(b))
}

fn tube(u: f64, v: f64) -> DVec3 {
    DVec3::new(
        0.2 * libm::cos(TURN * u),
        0.2 * libm::sin(TURN * u),
        v - 0.5,
    )
}

fn sheet(u: f64, v: f64) -> DVec3 {
    DVec3::new(u - 0.5, v - 0.5, 0.0)
}

#[test]
fn topology_of_known_surfaces() {
    let clean = |components, boundary_edges, genus| Topology {
        components,
        boundary_edges,
        genus,
        ..Topology::default()
    };
    let (vertices, triangles) = grid(40, 20, (true, true), torus);
    assert_eq!(topology(&triangles, vertices.len()), clean(1, 0, vec![1]));
    let (vertices, triangles) = grid(40, 20, (true, false), tube);
    assert_eq!(topology(&triangles, vertices.len()), clean(1, 80, vec![0]));
    let (vertices, triangles) = grid(40, 20, (false, false), sheet);
    assert_eq!(topology(&triangles, vertices.len()), clean(1, 120, vec![0]));
    // A torus and, larger, a tube: two components, the larger first. Unused vertices do not count.
    let (tori, mut triangles) = grid(8, 6, (true, true), torus);
    let offset = tori.len() as u32 + 5;
    let (tubes, more) = grid(20, 10, (true, false), tube);
    triangles.extend(more.into_iter().map(|t| t.map(|v| v + offset)));
    assert_eq!(
        topology(&triangles, offset as usize + tubes.len() + 3),
        clean(2, 40, vec![0, 1])
    );
    assert_eq!(topology(&[], 10), Topology::default());
}

#[test]
fn topology_finds_every_defect() {
    // Three triangles on one edge.
    let t = topology(&[[0, 1, 2], [1, 0, 3], [0, 1, 4]], 5);
    assert_eq!((t.non_manifold_edges, t.non_manifold_vertices), (1, 0));
    // Two triangles that share one vertex only.
    let t = topology(&[[0, 1, 2], [0, 3, 4]], 5);
    assert_eq!((t.non_manifold_vertices, t.components), (1, 1));
    // Two closed tetrahedra that share a vertex.
    let solid = |[a, b, c, d]: [u32; 4]| [[a, c, b], [a, b, d], [b, c, d], [a, d, c]];
    let t = topology(&[solid([0, 1, 2, 3]), solid([0, 4, 5, 6])].concat(), 7);
    assert_eq!(
        (
            t.non_manifold_vertices,
            t.boundary_edges,
            t.non_manifold_edges
        ),
        (1, 0, 0)
    );
    // Neighbours with opposite orientation, a triangle twice, a triangle on two vertices.
    assert_eq!(topology(&[[0, 1, 2], [0, 1, 3]], 4).inconsistent_edges, 1);
    let t = topology(&[[0, 1, 2], [2, 0, 1], [1, 2, 0]], 3);
    assert_eq!((t.duplicate, t.non_manifold_edges), (2, 3));
    let t = topology(&[[0, 1, 1]], 2);
    assert_eq!((t.degenerate, t.is_manifold()), (1, false));
}

#[test]
fn volume_and_area_of_a_torus() {
    let (vertices, triangles) = grid(400, 200, (true, true), torus);
    let (exact_volume, exact_area) = (
        TURN * 0.3 * std::f64::consts::PI * 0.01,
        TURN * 0.3 * TURN * 0.1,
    );
    assert!((volume(&vertices, &triangles) / exact_volume - 1.0).abs() < 1e-3);
    assert!((area(&vertices, &triangles) / exact_area - 1.0).abs() < 1e-3);
    let inside_out: Vec<_> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    assert_eq!(
        volume(&vertices, &inside_out),
        -volume(&vertices, &triangles)
    );
}

fn random_points(n: usize, seed: u64) -> Vec<Vec3> {
    let mut rng = Rng::new(seed);
    let mut one = || (rng.uniform() - 0.5) as f32;
    (0..n).map(|_| Vec3::new(one(), one(), one())).collect()
}

/// The closest point of a triangle is no farther than any of a fine raster of it, and as near as the best of them.
#[test]
fn closest_point_of_a_triangle() {
    let points = random_points(4 * 300, 3);
    for p in points.chunks_exact(4) {
        let [q, a, b, c] = [p[0], p[1], p[2], p[3]].map(|p| p.as_dvec3());
        let found = q.distance(closest_on_triangle(q, [a, b, c]));
        let raster = (0..=100)
            .flat_map(|i| (0..=100 - i).map(move |j| (i as f64 / 100.0, j as f64 / 100.0)));
        let best = raster
            .map(|(u, v)| q.distance(a + (b - a) * u + (c - a) * v))
            .fold(f64::INFINITY, f64::min);
        assert!(
            found <= best + 1e-12 && best < found + 0.02,
            "{found} {best}"
        );
    }
}

#[test]
fn mesh_distances_are_those_of_a_scan_of_all_triangles() {
    let (vertices, triangles) = grid(30, 16, (true, true), torus);
    let queries = random_points(500, 1);
    let tree = TriangleTree::new(&vertices, &triangles);
    let naive = |q: Vec3| {
        let to = |t: &[u32; 3]| {
            let corners = t.map(|v| vertices[v as usize].as_dvec3());
            q.as_dvec3()
                .distance_squared(closest_on_triangle(q.as_dvec3(), corners))
        };
        triangles.iter().map(to).fold(f64::INFINITY, f64::min)
    };
    for (i, &q) in queries.iter().enumerate() {
        assert_eq!(tree.closest(q, (i % triangles.len()) as u32).0, naive(q));
    }
    let stats = mesh_distance(&queries, &vertices, &triangles, &mut Silent).expect("not cancelled");
    assert_eq!(
        stats,
        DistanceStats::of(queries.iter().map(|&q| naive(q).sqrt()))
    );
    assert_eq!(
        mesh_distance(&queries, &[], &[], &mut Silent),
        Ok(DistanceStats::default())
    );
}

fn stats_of(distances: Vec<f32>) -> DistanceStats {
    DistanceStats::of(distances.into_iter().map(f64::from))
}

/// Points of a sphere have no distance to a sparse reduced sphere; points off it have theirs.
#[test]
fn cloud_distance_follows_the_curvature() {
    let on_sphere = |n, seed| {
        random_points(n, seed)
            .into_iter()
            .map(|p| p.normalize() * 0.4)
            .collect::<Vec<_>>()
    };
    let reduced = on_sphere(2000, 1);
    let mut flip = 1.0;
    let normals: Vec<Vec3> = reduced
        .iter()
        .map(|p| {
            // Normals of any sign.
            flip = -flip;
            p.normalize() * flip
        })
        .collect();
    let distances = |points: &[Vec3]| stats_of(distances_to(&reduced, &normals, points));
    let stats = distances(&on_sphere(5000, 2));
    assert!(stats.max < 5e-4 && stats.mean < 1e-5, "{stats:?}");
    let outside: Vec<Vec3> = on_sphere(5000, 3).into_iter().map(|p| p * 1.01).collect();
    let stats = distances(&outside);
    assert!((stats.mean - 0.004).abs() < 1e-4, "{stats:?}");
    // The reduced points themselves, and a cloud of one point.
    let stats = distances(&reduced);
    assert!(stats.max < 1e-7, "{stats:?}");
    let stats = stats_of(distances_to(
        &[Vec3::ZERO],
        &[Vec3::Z],
        &[Vec3::ZERO, Vec3::Z],
    ));
    assert_eq!(stats.max, 1.0);
}

/// Two sheets closer than the spacing of their points do not answer for each other.
#[test]
fn cloud_distance_keeps_thin_sheets_apart() {
    let mut reduced = Vec::new();
    for (i, p) in random_points(2000, 4).into_iter().enumerate() {
        reduced.push(Vec3::new(p.x, p.y, if i % 2 == 0 { 0.0 } else { 0.015 }));
    }
    let normals: Vec<Vec3> = reduced
        .iter()
        .map(|p| if p.z > 0.0 { Vec3::Z } else { -Vec3::Z })
        .collect();
    let queries: Vec<Vec3> = random_points(2000, 5)
        .into_iter()
        .map(|p| Vec3::new(p.x * 0.9, p.y * 0.9, 0.0))
        .collect();
    let stats = stats_of(distances_to(&reduced, &normals, &queries));
    // One in sixteen has only points of the other sheet among its four nearest.
    assert!(stats.mean < 0.015 / 16.0, "{stats:?}");
}

#[test]
fn a_face_that_just_touches_the_support_does_not_count() {
    // Eight points on a plane below the query, and one of another face at the rim: at 1.2 times the eighth's distance.
    let ring = (0..8).map(|k| {
        let angle = k as f32;
        (0.4 + k as f32 * 0.6 / 7.0) * Vec3::new(angle.cos(), angle.sin(), 0.0)
    });
    for ulps in 1..200 {
        let radius = 1.2 * (1.0f32 + 0.1 * 0.1).sqrt();
        let rim = Vec3::new(0.0, 0.0, f32::from_bits(radius.to_bits() - ulps));
        let points: Vec<Vec3> = ring
            .clone()
            .map(|p| p + Vec3::new(0.0, 0.0, 0.1))
            .chain([rim])
            .collect();
        let mut normals = vec![Vec3::Z; 8];
        normals.push(Vec3::X);
        let found = distances_to(&points, &normals, &[Vec3::ZERO]);
        assert!((found[0] - 0.1).abs() < 1e-3, "{ulps}: {}", found[0]);
    }
}

#[test]
fn distances_can_be_cancelled() {
    let (vertices, triangles) = grid(30, 16, (true, true), torus);
    let mut stop = |stage: Stage, _: f32| {
        assert_eq!(stage, Stage::Report);
        false
    };
    assert_eq!(
        mesh_distance(&random_points(10, 1), &vertices, &triangles, &mut stop),
        Err(Error::Cancelled)
    );
}

#[test]
fn stages_keep_their_order_and_add_up() {
    let mut ms = StageTimes::default();
    ms.add(Stage::Octree, 1.0);
    ms.add(Stage::Fit, 2.0);
    ms.add(Stage::Octree, 4.0);
    assert_eq!(
        ms.iter().collect::<Vec<_>>(),
        [(Stage::Octree, 5.0), (Stage::Fit, 2.0)]
    );
    let report = SurfaceReport {
        reduce: ReduceReport {
            ms,
            ..ReduceReport::default()
        },
        ..SurfaceReport::default()
    };
    assert_eq!(report.reduce.ms.iter().count(), 2);
}
