//! How many triangles a surface has, where they are, and how they are shaped.

mod common;

use common::mesh::Flaws;
use common::{Shape, points};
use glam::DVec3;
use pointweave::base::params::{Boundary, Resolution};
use pointweave::base::progress::Silent;
use pointweave::base::rng::Rng;
use pointweave::{Cloud, Surface, SurfaceParams, reconstruct};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn surface(positions: &[f64], params: &SurfaceParams) -> Surface {
    let cloud = Cloud::from_f64(positions).unwrap();
    reconstruct(&cloud, params, &mut Silent).unwrap()
}

/// Every point goes to the fit.
fn unreduced() -> SurfaceParams {
    SurfaceParams {
        reduce: None,
        ..Default::default()
    }
}

fn corners(s: &Surface) -> impl Iterator<Item = [DVec3; 3]> + '_ {
    let at = |v: u32| s.mesh.vertices[v as usize].as_dvec3();
    s.mesh.triangles.iter().map(move |t| t.map(at))
}

fn triangles_a_point(s: &Surface) -> f64 {
    s.report.triangles as f64 / s.report.reduce.output_points as f64
}

/// Share of the triangles with an angle under so many degrees.
fn thin(s: &Surface, degrees: f64) -> f64 {
    let is_thin = |&[a, b, c]: &[DVec3; 3]| {
        let angles =
            [[a, b, c], [b, c, a], [c, a, b]].map(|[p, q, r]| (q - p).angle_between(r - p));
        angles.into_iter().fold(f64::INFINITY, f64::min) < degrees.to_radians()
    };
    corners(s).filter(is_thin).count() as f64 / s.report.triangles as f64
}

#[test]
fn three_triangles_a_point_are_enough() {
    for shape in Shape::ALL {
        for (noise, params) in [
            (0.0, unreduced()),
            (0.0, SurfaceParams::default()),
            (0.005, unreduced()),
        ] {
            let s = surface(&shape.sample(9000, noise, 31), &params);
            let count = triangles_a_point(&s);
            assert!((2.5..=3.0).contains(&count), "{shape:?}, {noise}: {count}");
            let flaws = Flaws::of(&s.mesh.vertices, &s.mesh.triangles);
            assert!(flaws.is_clean() && flaws.topology.boundary_edges == 0);
            assert_eq!(flaws.topology.genus, shape.genus());
            assert!(
                thin(&s, 15.0) < 0.01,
                "{shape:?}, {noise}: {}",
                thin(&s, 15.0)
            );
            let off = |p: DVec3| shape.distance(p).abs();
            let positions = s.positions_f64();
            let worst = points(&positions).map(off).sum::<f64>() / s.mesh.vertices.len() as f64;
            assert!(worst < 3e-3, "{shape:?}, {noise}: {worst}");
        }
    }
}

#[test]
fn hostile_clouds_give_manifold_meshes() {
    let mut rng = Rng::new(32);
    let scattered: Vec<f64> = (0..9000).map(|_| rng.uniform()).collect();
    let plane: Vec<f64> = (0..3000)
        .flat_map(|_| [rng.uniform(), rng.uniform(), 0.0])
        .collect();
    let ribbon: Vec<f64> = points(&plane)
        .flat_map(|p| [p.x, 0.01 * p.y, 0.0])
        .collect();
    let noisy = Shape::Torus.sample(3000, 0.1, 33);
    let clouds = [
        ("scattered", scattered),
        ("plane", plane),
        ("ribbon", ribbon),
        ("noisy", noisy),
    ];
    for (name, positions) in clouds {
        for boundary in [Boundary::Auto, Boundary::Open, Boundary::Closed] {
            let params = SurfaceParams {
                boundary,
                ..unreduced()
            };
            let s = surface(&positions, &params);
            let flaws = Flaws::of(&s.mesh.vertices, &s.mesh.triangles);
            assert!(flaws.is_clean(), "{name}, {boundary:?}: {flaws:?}");
            // Caps come on top.
            if boundary != Boundary::Closed {
                assert!(s.report.triangles <= 9000, "{name}, {boundary:?}");
            }
            // Scattered points make folds, not the simplification; mending what crosses makes or opens a few.
            let lattice = unsimplified(&positions, &params);
            let before = Flaws::of(&lattice.mesh.vertices, &lattice.mesh.triangles);
            assert!(
                flaws.folded <= before.folded + 1 + before.folded / 100,
                "{name}: {flaws:?} {before:?}"
            );
            assert_eq!(flaws.topology, before.topology);
        }
    }
}

/// Mean area of the triangles whose centre is at a place.
fn mean_area(s: &Surface, is_there: impl Fn(DVec3) -> bool) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    let frame = &s.cloud.reduced.cloud.frame;
    for [a, b, c] in corners(s) {
        let centre = DVec3::from(frame.to_caller(((a + b + c) / 3.0).as_vec3()));
        if is_there(centre) {
            sum += (b - a).cross(c - a).length() / 2.0;
            count += 1;
        }
    }
    sum / count as f64
}

/// A disk of radius 1 with a round rim of radius 0.2, evenly sampled.
#[test]
fn triangles_are_denser_where_the_surface_is_curved() {
    let mut rng = Rng::new(34);
    let mut positions = Vec::new();
    while positions.len() < 3 * 12_000 {
        let mut side = |half: f64| half * (2.0 * rng.uniform() - 1.0);
        let p = DVec3::new(side(1.25), side(1.25), side(0.25));
        // Points of a shell around the surface, led onto it.
        let flat = DVec3::new(p.x, p.y, 0.0);
        let inner = flat.clamp_length_max(1.0);
        if ((p - inner).length() - 0.2).abs() < 0.02 {
            positions.extend((inner + (p - inner).normalize() * 0.2).to_array());
        }
    }
    let s = surface(&positions, &unreduced());
    let flat = mean_area(&s, |p| p.x.hypot(p.y) < 0.95);
    let round = mean_area(&s, |p| p.x.hypot(p.y) > 1.05);
    assert!(flat > 1.5 * round, "{flat} {round}");
}

#[test]
fn a_chosen_resolution_is_kept() {
    let positions = Shape::Sphere.sample(3000, 0.0, 35);
    let count = |edge| {
        let params = SurfaceParams {
            resolution: Resolution::Edge(edge),
            ..unreduced()
        };
        surface(&positions, &params).report.triangles as f64
    };
    let (coarse, fine) = (count(0.02), count(0.01));
    // A sphere of radius r (diagonal 1) crosses 6π r² / edge² cells: as many vertices, twice as many triangles.
    let radius = 1.0 / 12f64.sqrt();
    let expected = 12.0 * std::f64::consts::PI * radius * radius / 0.02f64.powi(2);
    assert!(
        (coarse / expected - 1.0).abs() < 0.05,
        "{coarse} {expected}"
    );
    assert!((fine / coarse / 4.0 - 1.0).abs() < 0.05, "{coarse} {fine}");
    assert!(fine > 3.0 * 3000.0);
}

/// What the lattice makes of the same points.
fn unsimplified(positions: &[f64], params: &SurfaceParams) -> Surface {
    let mut spacing = surface(positions, params).cloud.reduced.spacing;
    spacing.sort_unstable_by(f32::total_cmp);
    let params = SurfaceParams {
        resolution: Resolution::Edge(0.75 * spacing[spacing.len() / 2] as f64),
        ..params.clone()
    };
    surface(positions, &params)
}

#[test]
fn creases_are_kept() {
    let positions = Shape::Box.sample(12_000, 0.0, 36);
    // Points on all edges of the box along each axis.
    let half = DVec3::new(1.0, 0.7, 0.5);
    let on_edge = |i: usize| {
        let sign = |bit: usize| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let mut p = half * DVec3::new(sign(0), sign(1), sign(2));
        p[i / 8 % 3] *= (i / 24) as f64 / 20.0;
        p
    };
    let to_vertices = |s: &Surface| {
        let vertices = s.positions_f64();
        let nearest = |i| {
            let distances = points(&vertices).map(|v| v.distance(on_edge(i)));
            distances.fold(f64::INFINITY, f64::min)
        };
        (0..480).map(nearest).sum::<f64>() / 480.0
    };
    let (s, lattice) = (
        surface(&positions, &unreduced()),
        unsimplified(&positions, &unreduced()),
    );
    let change = to_vertices(&s) / to_vertices(&lattice) - 1.0;
    assert!(change < 0.1, "{change}");
    let volume = |s: &Surface| pointweave::report::volume(&s.mesh.vertices, &s.mesh.triangles);
    let change = volume(&s) / volume(&lattice) - 1.0;
    assert!(change.abs() < 5e-4, "volume {change}");
}

#[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
#[test]
fn threads_do_not_change_a_byte() {
    let positions = Shape::Torus.sample(6000, 0.002, 37);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let run = || surface(&positions, &unreduced()).mesh;
        pool.build().unwrap().install(run)
    };
    let one = with(1);
    assert!(one == with(2) && one == with(4));
}
