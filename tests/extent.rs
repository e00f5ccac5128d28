//! Where a surface ends, on scans whose extent is known: holes and rims, few points, copies and strays, steps.

mod common;

use common::{Shape, mesh, points};
use glam::{DVec3, Vec3};
use pointweave::base::params::{Boundary, MaxHole};
use pointweave::base::progress::Silent;
use pointweave::base::rng::Rng;
use pointweave::report::{area, volume};
use pointweave::{Cloud, Error, ReduceParams, Surface, SurfaceParams, reconstruct, reduce};

fn surface(positions: &[f64], params: &SurfaceParams) -> Result<Surface, Error> {
    reconstruct(&Cloud::from_f64(positions)?, params, &mut Silent)
}

/// Every point goes to the fit.
fn unreduced() -> SurfaceParams {
    SurfaceParams {
        reduce: None,
        ..Default::default()
    }
}

/// Volume and area in the caller's unit.
fn size(s: &Surface) -> (f64, f64) {
    let d = s.cloud.reduced.cloud.frame.diagonal;
    let mesh = &s.mesh;
    (
        volume(&mesh.vertices, &mesh.triangles) * d.powi(3),
        area(&mesh.vertices, &mesh.triangles) * d * d,
    )
}

fn far(s: &Surface, positions: &[f64]) -> f64 {
    let cloud = Cloud::from_f64(positions).unwrap();
    mesh::far(&s.mesh.vertices, &s.mesh.triangles, &cloud.points)
}

/// A wall around z from -1 to 1, of radius `radius` at each height, with a floor where `floor` says so.
fn turned(n: usize, radius: impl Fn(f64) -> f64, floor: bool) -> Vec<f64> {
    let mut rng = Rng::new(17);
    let mut positions = Vec::with_capacity(3 * n);
    while positions.len() < 3 * n {
        let angle = std::f64::consts::TAU * rng.uniform();
        let bottom = radius(-1.0);
        // The wall is about 2 high and 2πr wide, the floor πr² large.
        let on_floor = floor && rng.uniform() * (4.0 + bottom) < bottom;
        let (r, z) = if on_floor {
            (bottom * rng.uniform().sqrt(), -1.0)
        } else {
            let z = 2.0 * rng.uniform() - 1.0;
            (radius(z), z)
        };
        positions.extend([r * libm::cos(angle), r * libm::sin(angle), z]);
    }
    positions
}

#[test]
fn what_is_open_stays_open() {
    let half: Vec<f64> = points(&Shape::Sphere.sample(16_000, 0.0, 7))
        .filter(|p| p.z > 0.0)
        .flat_map(|p| p.to_array())
        .collect();
    let statue: Vec<f64> = points(&Shape::Torus.sample(16_000, 0.0, 7))
        .filter(|p| p.x > 0.3)
        .flat_map(|p| p.to_array())
        .collect();
    let scans = [
        ("half a ball", half, 1),
        ("part of a ring", statue, 2),
        ("pipe", turned(20_000, |_| 0.4, false), 2),
        ("bin", turned(20_000, |z| 0.6 + 0.1 * z, true), 1),
        (
            "vase",
            turned(20_000, |z| 0.5 + 0.2 * libm::sin(3.0 * z), true),
            1,
        ),
    ];
    for (name, positions, rims) in scans {
        let s = surface(&positions, &SurfaceParams::default()).unwrap();
        assert_eq!(s.report.components, 1, "{name}");
        let open: Vec<_> = s.report.holes.iter().filter(|h| !h.closed).collect();
        assert_eq!(open.len(), rims, "{name}: {:?}", s.report.holes);
        assert!(
            far(&s, &positions) < 0.005,
            "{name}: {}",
            far(&s, &positions)
        );
        // Closed, it has a lid on every rim and is the same elsewhere.
        let closed = SurfaceParams {
            boundary: Boundary::Closed,
            ..Default::default()
        };
        let c = surface(&positions, &closed).unwrap();
        assert_eq!(
            (c.report.boundary_edges, c.report.components),
            (0, 1),
            "{name}"
        );
        assert!(c.report.holes.iter().all(|h| h.closed), "{name}");
        assert!(far(&c, &positions) > 0.02, "{name}");
    }
}

#[test]
fn holes_are_closed_up_to_their_size() {
    // Holes of a ball, as wide as this share of the diagonal.
    let diagonal = 12f64.sqrt();
    let holed = |width: f64| -> Vec<f64> {
        let radius = width * diagonal / 2.0;
        let above = (1.0 - radius * radius).sqrt();
        points(&Shape::Sphere.sample(12_000, 0.0, 8))
            .filter(|p| p.z < above)
            .flat_map(|p| p.to_array())
            .collect()
    };
    let run = |width: f64, max_hole: MaxHole| {
        let params = SurfaceParams {
            max_hole,
            ..unreduced()
        };
        surface(&holed(width), &params).unwrap().report
    };
    for width in [0.04, 0.08, 0.12, 0.18] {
        let r = run(width, MaxHole::Auto);
        assert_eq!((r.boundary_edges, r.components), (0, 1), "{width}");
        // What the fitted functions reach across is no hole.
        if width > 0.05 {
            let widest = r.holes[0].diameter;
            assert!((widest / width - 1.0).abs() < 0.2, "{widest} of {width}");
        }
    }
    assert!(run(0.3, MaxHole::Auto).boundary_edges > 0);
    for (width, max_hole, closes) in [
        (0.12, 0.2, true),
        (0.12, 0.08, false),
        (0.2, 0.15, false),
        (0.3, 0.4, true),
    ] {
        let r = run(width, MaxHole::Diameter(max_hole));
        assert_eq!(r.boundary_edges == 0, closes, "{width} {max_hole}");
    }
}

#[test]
fn few_points_are_their_hull_or_a_sheet() {
    let cube: Vec<f64> = (0..8u8)
        .flat_map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from))
        .collect();
    let grid: Vec<f64> = (0..25u8)
        .flat_map(|i| [i / 5, i % 5, 0].map(f64::from))
        .collect();
    for boundary in [Boundary::Auto, Boundary::Open, Boundary::Closed] {
        let params = SurfaceParams {
            boundary,
            ..Default::default()
        };
        let s = surface(&cube, &params).unwrap();
        assert_eq!((s.report.components, s.report.boundary_edges), (1, 0));
        let (volume, area) = size(&s);
        assert!((volume - 1.0).abs() < 1e-5 && (area - 6.0).abs() < 1e-5);
        let normals = s.cloud.reduced.cloud.normals.as_ref().unwrap();
        let positions = s.cloud.reduced.cloud.positions_f64();
        let outward = |(p, n): (DVec3, &Vec3)| (p - 0.5).dot(n.as_dvec3()) > 0.0;
        assert!(points(&positions).zip(normals).all(outward));
        assert!(s.report.reduce.distance.max < 1e-6);
        let s = surface(&grid, &params).unwrap();
        assert_eq!(s.report.components, 1);
        assert_eq!(s.report.boundary_edges == 0, boundary == Boundary::Closed);
        assert!(points(&s.positions_f64()).all(|p| p.z == 0.0 && p.max_element() <= 4.0 + 1e-6));
        assert!(boundary == Boundary::Closed || (size(&s).1 - 16.0).abs() < 1e-5);
    }
    for n in [4, 5, 12, 25, 50] {
        let positions = Shape::Sphere.sample(n, 0.0, 3);
        let s = surface(&positions, &SurfaceParams::default()).unwrap();
        assert_eq!(
            (s.report.components, s.report.boundary_edges),
            (1, 0),
            "{n}"
        );
        assert!(
            size(&s).0 > 0.0 && size(&s).0 < Shape::Sphere.volume(),
            "{n}"
        );
    }
}

#[test]
fn the_distance_of_a_stray_is_not_the_surfaces() {
    let mut positions = Shape::Sphere.sample(4000, 0.0, 5);
    let alone = surface(&positions, &SurfaceParams::default())
        .unwrap()
        .report;
    positions.extend([1e6, 2e6, 0.0]);
    let s = surface(&positions, &SurfaceParams::default())
        .unwrap()
        .report;
    assert!(s.reduce.distance.rms < 1.1 * alone.reduce.distance.rms);
    assert!(s.reduce.distance.max < 0.01 && s.residual.max < 0.01);
    let cloud = Cloud::from_f64(&positions).unwrap();
    let reduced = reduce(&cloud, &ReduceParams::default(), &mut Silent).unwrap();
    assert!(reduced.report.distance.max < 0.01);
}

#[test]
fn depth_in_steps_is_a_smooth_surface() {
    // A relief of 2 by 2 whose heights were rounded.
    let height = |x: f64, y: f64| 0.2 * libm::sin(2.0 * x) * libm::cos(1.5 * y);
    let mut rng = Rng::new(23);
    let mut scan = |step: f64| -> Vec<f64> {
        (0..12_000)
            .flat_map(|_| {
                let (x, y) = (2.0 * rng.uniform() - 1.0, 2.0 * rng.uniform() - 1.0);
                [x, y, step * (height(x, y) / step).round()]
            })
            .collect()
    };
    for step in [0.02, 0.03] {
        let s = surface(&scan(step), &SurfaceParams::default()).unwrap();
        let noise = step / 12f64.sqrt() / s.cloud.reduced.cloud.frame.diagonal;
        assert!((s.report.reduce.noise / noise - 1.0).abs() < 0.02);
        let said = |code| {
            s.report
                .reduce
                .doubts
                .iter()
                .any(|doubt| doubt.code == code)
        };
        assert!(said("steps"));
        let vertices: Vec<DVec3> = points(&s.positions_f64()).collect();
        let mut angles: Vec<f64> = s
            .mesh
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| vertices[v as usize]);
                let q = (a + b + c) / 3.0;
                let slope = DVec3::new(
                    -0.4 * libm::cos(2.0 * q.x) * libm::cos(1.5 * q.y),
                    0.3 * libm::sin(2.0 * q.x) * libm::sin(1.5 * q.y),
                    1.0,
                );
                let n = (b - a).cross(c - a).normalize();
                libm::acos(n.dot(slope.normalize()).abs().min(1.0)).to_degrees()
            })
            .collect();
        angles.sort_unstable_by(f64::total_cmp);
        let (median, most) = (angles[angles.len() / 2], angles[angles.len() * 9 / 10]);
        assert!(median < 5.0 && most < 12.0, "{step}: {median} {most}");
    }
}

/// A relief over a square of edge 1, seen by lines along x.
fn relief(x: f64, y: f64) -> f64 {
    0.06 * libm::sin(7.0 * x) * libm::cos(6.0 * y) + 0.004 * libm::sin(60.0 * x)
}

/// Share of the mesh's area that is more than 10° off the normal that `truth` has at a place of the caller's frame.
fn share_turned(s: &Surface, truth: impl Fn(DVec3) -> DVec3) -> f64 {
    let frame = &s.cloud.reduced.cloud.frame;
    let (mut all, mut off) = (0.0, 0.0);
    for t in &s.mesh.triangles {
        let at = |v: u32| DVec3::from_array(frame.to_caller(s.mesh.vertices[v as usize]));
        let [a, b, c] = t.map(at);
        let normal = (b - a).cross(c - a);
        all += normal.length();
        let cosine = normal
            .normalize_or_zero()
            .dot(truth((a + b + c) / 3.0))
            .abs();
        if cosine < libm::cos(10f64.to_radians()) {
            off += normal.length();
        }
    }
    off / all
}

#[test]
fn scan_lines_far_apart_are_one_surface() {
    let says_lines = |s: &Surface| s.report.reduce.doubts.iter().any(|d| d.code == "lines");
    for ratio in [1.0, 10.0, 20.0] {
        let mut rng = Rng::new(31);
        let lines = if ratio == 1.0 { 70 } else { 25 };
        let each = (f64::from(lines) * ratio) as usize;
        let mut positions = Vec::new();
        for line in 0..lines {
            for _ in 0..each {
                let (x, y) = (rng.uniform(), f64::from(line) / f64::from(lines - 1));
                positions.extend([x, y, relief(x, y)]);
            }
        }
        let s = surface(&positions, &SurfaceParams::default()).unwrap();
        assert_eq!(
            s.report.reduce.output_points,
            (positions.len() as f64 / 9.0).round() as usize
        );
        assert_eq!(says_lines(&s), ratio > 1.0, "{ratio}");
        assert_eq!(s.report.components, 1, "1:{ratio}");
        let holes: Vec<_> = s.report.holes.iter().filter(|h| !h.closed).collect();
        assert_eq!(holes.len(), 1, "1:{ratio}: {holes:?}");
        // Lines see the waves along them, with crests nearer to each other than two lines are in three places.
        let normal = |p: DVec3| {
            let slope =
                |dx: f64, dy: f64| (relief(p.x + dx, p.y + dy) - relief(p.x - dx, p.y - dy)) / 2e-4;
            DVec3::new(-slope(1e-4, 0.0), -slope(0.0, 1e-4), 1.0).normalize()
        };
        if ratio > 1.0 {
            let share = share_turned(&s, normal);
            assert!(share < 0.1, "1:{ratio}: {share}");
        }
    }
}

#[test]
fn steps_of_a_depth_are_noise() {
    // A camera at the origin that looks along z, turned about x; its ranges are rounded.
    let mut rng = Rng::new(32);
    let turn = glam::DMat3::from_rotation_x(0.6);
    let depth = |u: f64, v: f64| 1.0 + 0.05 * libm::sin(5.0 * u) * libm::cos(4.0 * v);
    let mut clean = Vec::new();
    let mut rounded = Vec::new();
    for _ in 0..9000 {
        let (u, v) = (rng.uniform() - 0.5, rng.uniform() - 0.5);
        let p = depth(u, v) * DVec3::new(u, v, 1.0);
        let range = (p.length() / 0.01).round() * 0.01;
        clean.extend((turn * p).to_array());
        rounded.extend((turn * p * (range / p.length())).to_array());
    }
    let normal = |p: DVec3| {
        let p = turn.transpose() * p;
        let at = |u: f64, v: f64| depth(u, v) * DVec3::new(u, v, 1.0);
        let (u, v) = (p.x / p.z, p.y / p.z);
        let along = at(u + 1e-4, v) - at(u - 1e-4, v);
        turn * along.cross(at(u, v + 1e-4) - at(u, v - 1e-4)).normalize()
    };
    let says_steps = |s: &Surface| s.report.reduce.doubts.iter().any(|d| d.code == "steps");
    let s = surface(&clean, &SurfaceParams::default()).unwrap();
    assert!(!says_steps(&s));
    let s = surface(&rounded, &SurfaceParams::default()).unwrap();
    assert!(says_steps(&s));
    let step = 0.01 / s.cloud.reduced.cloud.frame.diagonal;
    assert!((s.report.reduce.noise * 12f64.sqrt() / step - 1.0).abs() < 0.1);
    assert!(
        share_turned(&s, normal) < 0.1,
        "{}",
        share_turned(&s, normal)
    );
}

#[test]
fn creases_stay_straight_in_noise() {
    let mut rng = Rng::new(33);
    let mut positions = Vec::new();
    let turn = glam::DMat3::from_rotation_x(0.5) * glam::DMat3::from_rotation_y(0.3);
    for i in 0..18_000 {
        let (a, b) = (rng.uniform() - 0.5, rng.uniform() - 0.5);
        // 0.1 % of the diagonal.
        let c = 0.5 * if i % 2 == 0 { 1.0 } else { -1.0 } + 0.001 * 3f64.sqrt() * rng.normal();
        let p = [
            DVec3::new(a, b, c),
            DVec3::new(c, a, b),
            DVec3::new(b, c, a),
        ][i % 3];
        positions.extend((turn * p).to_array());
    }
    let s = surface(&positions, &SurfaceParams::default()).unwrap();
    let frame = &s.cloud.reduced.cloud.frame;
    // Distance to the cube near its edges, away from its corners.
    let (mut area, mut sum) = (0.0, 0.0);
    for t in &s.mesh.triangles {
        let at = |v: u32| {
            turn.transpose() * DVec3::from_array(frame.to_caller(s.mesh.vertices[v as usize]))
        };
        let [a, b, c] = t.map(at);
        let middle = ((a + b + c) / 3.0).abs();
        let mut sorted = middle.to_array();
        sorted.sort_unstable_by(f64::total_cmp);
        if sorted[1] > 0.48 && sorted[0] < 0.4 {
            let size = (b - a).cross(c - a).length();
            area += size;
            sum += size * (sorted[2] - 0.5).abs() / frame.diagonal;
        }
    }
    // 5.5e-4 where every cell knows its own crease alone.
    assert!(sum / area < 4.6e-4, "{}", sum / area);
}
