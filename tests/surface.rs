//! From points to a mesh on shapes whose surface is known: natively, and by `wasm.rs` in both wasm builds.

mod common;

use common::{Shape, points};
use glam::{DMat3, DVec3};
use pointweave::base::params::{Boundary, COLORS, Carry, Kernel, Propagation, Target};
use pointweave::base::progress::Silent;
use pointweave::base::rng::Rng;
use pointweave::report::distance::mesh_distance;
use pointweave::report::{area, topology, volume};
use pointweave::samples::{Model, sample};
use pointweave::{Cloud, Error, ReduceParams, Stage, Surface, SurfaceParams, reconstruct};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

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

/// Checks everything that is known of `shape`; distances are at most `error` (mean) in the shape's unit.
fn check(shape: Shape, s: &Surface, error: f64) {
    let t = topology(&s.mesh.triangles, s.mesh.vertices.len());
    assert!(t.is_manifold(), "{shape:?}: {t:?}");
    assert_eq!(
        (t.boundary_edges, t.inconsistent_edges),
        (0, 0),
        "{shape:?}"
    );
    assert_eq!(t.genus, shape.genus(), "{shape:?}");
    assert_eq!(s.report.genus, t.genus);
    assert_eq!(s.report.triangles, s.mesh.triangles.len());

    let (volume, area) = size(s);
    assert!(
        (volume / shape.volume() - 1.0).abs() < 0.02,
        "{shape:?}: volume {volume}"
    );
    assert!(
        (area / shape.area() - 1.0).abs() < 0.03,
        "{shape:?}: area {area}"
    );

    let positions = s.positions_f64();
    let off = points(&positions)
        .map(|p| shape.distance(p).abs())
        .sum::<f64>()
        / s.mesh.vertices.len() as f64;
    assert!(
        off < error,
        "{shape:?}: mean distance {off}, allowed {error}"
    );

    // Orientation: every normal of the fitted points and of the vertices looks out. On a crease either side is right.
    let fitted = s.cloud.reduced.cloud.positions_f64();
    let normals = s.cloud.reduced.cloud.normals.as_ref().unwrap();
    let looks_in = |p: DVec3, n: DVec3| shape.distance(p + n * 0.1) <= shape.distance(p - n * 0.1);
    let wrong = points(&fitted)
        .zip(normals)
        .filter(|&(p, n)| looks_in(p, n.as_dvec3()));
    assert_eq!(wrong.count(), 0, "{shape:?}: points oriented right");
    let wrong = points(&positions)
        .zip(&s.mesh.normals)
        .filter(|&(p, n)| looks_in(p, n.as_dvec3()));
    assert_eq!(wrong.count(), 0, "{shape:?}: vertex normals");
}

#[test]
fn known_shapes_come_back_from_all_their_points() {
    for shape in Shape::ALL {
        check(
            shape,
            &surface(&shape.sample(6000, 0.0, 1), &unreduced()).unwrap(),
            2e-3,
        );
    }
}

#[test]
fn known_shapes_come_back_from_a_third_of_their_points() {
    for shape in Shape::ALL {
        let s = surface(&shape.sample(12_000, 0.0, 2), &SurfaceParams::default()).unwrap();
        assert_eq!(s.report.reduce.output_points, 4000);
        check(shape, &s, 3e-3);
    }
}

#[test]
fn noise_is_smoothed_away() {
    let noise = 0.01;
    for shape in Shape::ALL {
        let s = surface(&shape.sample(9000, noise, 3), &unreduced()).unwrap();
        // The mean of |noise| is 0.8 of its deviation; the surface is far closer than its points.
        check(shape, &s, 0.5 * 0.8 * noise);
        let measured = s.report.reduce.noise * s.cloud.reduced.cloud.frame.diagonal;
        assert!(
            (measured / noise - 1.0).abs() < 0.25,
            "{shape:?}: noise {measured}"
        );
    }
}

#[test]
fn every_kernel_and_both_propagations_agree_with_the_truth() {
    let positions = Shape::Torus.sample(4000, 0.002, 4);
    for kernel in [Kernel::Biharmonic, Kernel::Triharmonic, Kernel::ThinPlate] {
        for propagation in [Propagation::Global, Propagation::Paper] {
            let params = SurfaceParams {
                kernel,
                propagation,
                ..unreduced()
            };
            let s = surface(&positions, &params).unwrap();
            check(Shape::Torus, &s, 4e-3);
            let (after, before) = (
                s.report.orientation_energy,
                s.report.orientation_energy_before,
            );
            assert!((-1.0..-0.9).contains(&after), "{after}");
            assert!(after <= before && before < 0.0, "{before} to {after}");
        }
    }
}

#[test]
fn frame_and_order_do_not_matter() {
    let shape = Shape::Torus;
    let positions = shape.sample(4000, 0.0, 5);
    let (volume, area) = size(&surface(&positions, &unreduced()).unwrap());
    let turn = DMat3::from_cols(
        DVec3::new(0.36, 0.48, -0.8),
        DVec3::new(-0.8, 0.6, 0.0),
        DVec3::new(0.48, 0.64, 0.6),
    );
    let moved = |f: &dyn Fn(DVec3) -> DVec3| -> Vec<f64> {
        points(&positions).flat_map(|p| f(p).to_array()).collect()
    };
    let shuffled: Vec<f64> = (0..4000)
        .map(|i| i * 1237 % 4000)
        .flat_map(|i| positions[3 * i..3 * i + 3].to_vec())
        .collect();
    for (name, other, scale) in [
        ("itself", positions.clone(), 1.0f64),
        ("shifted", moved(&|p| p + DVec3::new(5e5, -4e6, 30.0)), 1.0),
        ("tiny", moved(&|p| p * 1e-9), 1e-9),
        ("huge", moved(&|p| p * 1e9), 1e9),
        ("turned", moved(&|p| turn * p), 1.0),
        ("shuffled", shuffled, 1.0),
    ] {
        let s = surface(&other, &unreduced()).unwrap();
        let (v, a) = size(&s);
        assert!(
            (v / volume / scale.powi(3) - 1.0).abs() < 2e-3,
            "{name}: volume {v} for {volume}"
        );
        assert!(
            (a / area / scale.powi(2) - 1.0).abs() < 2e-3,
            "{name}: area {a} for {area}"
        );
        assert_eq!(
            (s.report.components, s.report.boundary_edges),
            (1, 0),
            "{name}"
        );
    }
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let positions = Shape::Box.sample(3000, 0.003, 6);
    let [a, b] = [0, 1].map(|_| surface(&positions, &SurfaceParams::default()).unwrap());
    assert_eq!(a.mesh, b.mesh);
    assert_eq!(a.cloud.reduced.cloud, b.cloud.reduced.cloud);
}

#[test]
fn open_sheets_stay_open_and_close_when_asked() {
    // The upper half of a sphere.
    let half: Vec<f64> = points(&Shape::Sphere.sample(8000, 0.0, 7))
        .filter(|p| p.z > 0.0)
        .flat_map(|p| p.to_array())
        .collect();
    let with = |boundary| {
        surface(
            &half,
            &SurfaceParams {
                boundary,
                ..unreduced()
            },
        )
        .unwrap()
    };
    let open = with(Boundary::Open);
    assert!(open.report.boundary_edges > 0);
    let lowest = points(&open.positions_f64())
        .map(|p| p.z)
        .fold(f64::INFINITY, f64::min);
    let spacing = (2.0 * std::f64::consts::PI / (half.len() / 3) as f64).sqrt();
    assert!(
        lowest > -1.5 * spacing,
        "the surface runs {lowest} past the border"
    );
    let closed = with(Boundary::Closed);
    assert_eq!(
        (closed.report.boundary_edges, closed.report.components),
        (0, 1)
    );
    // Convex side out: all normals of the points look away from the centre.
    let fitted = open.cloud.reduced.cloud.positions_f64();
    let normals = open.cloud.reduced.cloud.normals.as_ref().unwrap();
    assert!(
        points(&fitted)
            .zip(normals)
            .all(|(p, n)| p.dot(n.as_dvec3()) > 0.0)
    );
}

/// How many normals of the fitted points look to the wrong side; `outward` tells the right one from the position, zero
/// where it does not matter.
fn wrong_normals(s: &Surface, outward: impl Fn(DVec3) -> DVec3) -> usize {
    let fitted = s.cloud.reduced.cloud.positions_f64();
    let normals = s.cloud.reduced.cloud.normals.as_ref().unwrap();
    points(&fitted)
        .zip(normals)
        .filter(|(p, n)| outward(*p).dot(n.as_dvec3()) < 0.0)
        .count()
}

/// Points of an angle profile: an L of thickness 1 whose legs are 2 long, 2 wide.
fn angle_profile(n: usize) -> Vec<f64> {
    let outline =
        [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)].map(|(x, z)| (f64::from(x), f64::from(z)));
    let mut rng = pointweave::base::rng::Rng::new(31);
    let (walls, ends) = (8.0 * 2.0, 2.0 * 3.0);
    let mut positions = Vec::new();
    while positions.len() < 3 * n {
        if rng.uniform() * (walls + ends) < walls {
            let mut along = 8.0 * rng.uniform();
            let mut k = 0;
            let (a, b) = loop {
                let (a, b) = (outline[k], outline[(k + 1) % 6]);
                let length = (b.0 - a.0).abs() + (b.1 - a.1).abs();
                if along < length {
                    let t = along / length;
                    break (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1));
                }
                along -= length;
                k += 1;
            };
            positions.extend([a, 2.0 * rng.uniform(), b]);
        } else {
            let (x, z) = (2.0 * rng.uniform(), 2.0 * rng.uniform());
            if x < 1.0 || z < 1.0 {
                positions.extend([x, if rng.uniform() < 0.5 { 0.0 } else { 2.0 }, z]);
            }
        }
    }
    positions
}

#[test]
fn creases_and_corners_are_in_the_mesh() {
    let positions = angle_profile(9000);
    let spacing = (22.0 / 9000.0f64).sqrt();
    // Rms distance of the mesh to the edge inside of the angle, to the outer edges, and to all corners.
    let errors = |sharp: bool| {
        let params = SurfaceParams {
            sharp,
            ..unreduced()
        };
        let s = surface(&positions, &params).unwrap();
        let frame = &s.cloud.reduced.cloud.frame;
        let outline = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)];
        let edge = |x: i32, z: i32| {
            (1..40).map(move |k| DVec3::new(x.into(), f64::from(k) / 20.0, z.into()))
        };
        let inner: Vec<DVec3> = edge(1, 1).collect();
        let outer = outline.iter().filter(|&&c| c != (1, 1));
        let outer: Vec<DVec3> = outer.flat_map(|&(x, z)| edge(x, z)).collect();
        let corner = |&(x, z): &(i32, i32)| [0.0, 2.0].map(|y| DVec3::new(x.into(), y, z.into()));
        let corners: Vec<DVec3> = outline.iter().flat_map(corner).collect();
        [inner, outer, corners].map(|truth| {
            let at: Vec<_> = truth.iter().map(|p| frame.to_unit(p.to_array())).collect();
            let (v, t) = (&s.mesh.vertices, &s.mesh.triangles);
            let found = mesh_distance(&at, v, t, &mut Silent).unwrap();
            found.rms * frame.diagonal / spacing
        })
    };
    let (kept, rounded) = (errors(true), errors(false));
    for (k, most) in [0.2, 0.2, 0.4].into_iter().enumerate() {
        let (kept, rounded) = (kept[k], rounded[k]);
        assert!(
            kept < most && kept < 0.75 * rounded,
            "{k}: {kept} of {rounded} spacings"
        );
    }
}

/// Mean angle of the triangles to the true surface by area, in degrees, and mean distance, in diagonals.
fn grain_of(model: Model, s: &Surface) -> (f64, f64) {
    let frame = &s.cloud.reduced.cloud.frame;
    let at = |v: u32| DVec3::from_array(frame.to_caller(s.mesh.vertices[v as usize]));
    let mut sums = DVec3::ZERO;
    for triangle in &s.mesh.triangles {
        let [a, b, c] = triangle.map(at);
        let (cross, middle) = ((b - a).cross(c - a), (a + b + c) / 3.0);
        let gradient = model.gradient(middle);
        let distance = model.distance(middle).abs() / frame.diagonal;
        sums += cross.length() * DVec3::new(1.0, cross.angle_between(gradient), distance);
    }
    ((sums.y / sums.x).to_degrees(), sums.z / sums.x)
}

#[test]
fn fairing_takes_the_grain_out_within_the_noise() {
    for model in [Model::Duck, Model::Part] {
        let cloud = Cloud::from_f32(&sample(model, 24_000, 5).positions).unwrap();
        let mesh = |fairing| {
            let params = SurfaceParams {
                fairing,
                ..Default::default()
            };
            reconstruct(&cloud, &params, &mut Silent).unwrap()
        };
        let (fair, grainy) = (mesh(true), mesh(false));
        assert_eq!(fair.mesh.triangles, grainy.mesh.triangles);
        // But for the few whose triangles crossed others, which are mended apart.
        let vertices = fair.mesh.vertices.iter().zip(&grainy.mesh.vertices);
        let noise = 2.0 * fair.cloud.report.noise;
        let far = vertices.filter(|(a, b)| f64::from(a.distance(**b)) > noise);
        assert!(far.count() <= fair.mesh.vertices.len() / 1000, "{model:?}");
        let (fair, grainy) = (grain_of(model, &fair), grain_of(model, &grainy));
        assert!(fair.0 < 0.85 * grainy.0, "{model:?}: {fair:?} {grainy:?}");
        assert!(fair.1 < grainy.1, "{model:?}: {fair:?} {grainy:?}");
    }
}

#[test]
fn nested_shells_bound_the_solid_between_them() {
    // Four spheres in each other: solid, cave, and a solid with a cave in it again.
    let radii = [1.0, 0.8, 0.55, 0.3];
    let mut positions = Vec::new();
    for (k, radius) in radii.into_iter().enumerate() {
        let n = (9000.0 * radius * radius) as usize;
        let sphere = Shape::Sphere.sample(n, 0.0, 20 + k as u64);
        positions.extend(sphere.iter().map(|x| radius * x));
    }
    let s = surface(&positions, &unreduced()).unwrap();
    let outward = |p: DVec3| {
        let nearest = |k: &usize| ((radii[*k] - p.length()).abs() * 1e9) as u64;
        let shell = (0..radii.len()).min_by_key(nearest).unwrap();
        if shell % 2 == 0 { p } else { -p }
    };
    assert_eq!(wrong_normals(&s, outward), 0);
    assert_eq!((s.report.components, s.report.boundary_edges), (4, 0));
    let solid: f64 = [1.0, -1.0, 1.0, -1.0]
        .into_iter()
        .zip(radii)
        .map(|(sign, r)| sign * r.powi(3) * Shape::Sphere.volume())
        .sum();
    assert!((size(&s).0 / solid - 1.0).abs() < 0.02);
}

#[test]
fn thin_plates_have_two_sides() {
    for (spacings, share) in [(3.0, 0.002), (1.5, 0.005)] {
        let n = 6000;
        let half = (0..50).fold(0.0, |half: f64, _| {
            spacings / 2.0 * ((8.0 + 16.0 * half) / n as f64).sqrt()
        });
        // A plate of half edge 1: the box, squeezed.
        let mut rng = pointweave::base::rng::Rng::new(21);
        let rim = 16.0 * half / (8.0 + 16.0 * half);
        let mut positions = Vec::new();
        for _ in 0..n {
            let mut side = || 2.0 * rng.uniform() - 1.0;
            let (a, b, c) = (side(), side(), side());
            let p = if c.abs() > rim {
                [a, b, half.copysign(c)]
            } else if c * b.abs() > 0.0 {
                [1f64.copysign(b), a, half * (2.0 * b.abs() - 1.0)]
            } else {
                [a, 1f64.copysign(b), half * (2.0 * b.abs() - 1.0)]
            };
            positions.extend(p);
        }
        let s = surface(&positions, &unreduced()).unwrap();
        // On the rim two directions are right, so only the sides are looked at.
        let wrong = wrong_normals(&s, |p| match p.x.abs().max(p.y.abs()) {
            farthest if farthest < 1.0 - 1e-5 => DVec3::Z * p.z,
            _ => DVec3::ZERO,
        });
        assert!(
            (wrong as f64) < share * n as f64,
            "{spacings} spacings: {wrong} of {n}"
        );
    }
}

#[test]
fn two_spheres_that_touch_both_look_out() {
    // Few points touch: what tells the sides is what each sphere encloses.
    for (n, seed) in [(750, 5), (1500, 5), (1500, 22), (3000, 22)] {
        let mut positions = Shape::Sphere.sample(n, 0.0, seed);
        let other = Shape::Sphere.sample(n, 0.0, seed + 1);
        positions.extend(points(&other).flat_map(|p| (p + 2.0 * DVec3::X).to_array()));
        let s = surface(&positions, &unreduced()).unwrap();
        let wrong = wrong_normals(&s, |p| if p.x < 1.0 { p } else { p - 2.0 * DVec3::X });
        assert!(wrong < 90, "{wrong} of {}", 2 * n);
    }
}

#[test]
fn a_few_far_points_leave_the_surface_as_it_is() {
    let scan = Shape::Torus.sample(6000, 1e-3, 5);
    for far in [1e2, 1e5, 1e9] {
        let mut positions = scan.clone();
        positions.extend([far, 0.0, 0.0, 0.0, -far, 0.3 * far, far, far, far]);
        let s = surface(&positions, &SurfaceParams::default()).unwrap();
        assert_eq!(
            (s.report.components, s.report.boundary_edges),
            (1, 0),
            "{far}"
        );
        let vertices = s.positions_f64();
        let worst = points(&vertices)
            .map(|p| Shape::Torus.distance(p).abs())
            .fold(0.0, f64::max);
        assert!(worst < 0.05, "{far}: {worst}");
        assert!(
            s.cloud.reduced.cloud.normals.as_ref().unwrap().len() == s.report.reduce.output_points
        );
    }
}

#[test]
fn a_small_hole_is_closed() {
    let holed: Vec<f64> = points(&Shape::Sphere.sample(8000, 0.0, 8))
        .filter(|p| p.z < 0.95)
        .flat_map(|p| p.to_array())
        .collect();
    let s = surface(&holed, &unreduced()).unwrap();
    assert_eq!((s.report.boundary_edges, s.report.components), (0, 1));
    assert!((size(&s).0 / Shape::Sphere.volume() - 1.0).abs() < 0.02);
}

#[test]
fn given_normals_are_used_as_they_are() {
    let shape = Shape::Sphere;
    let positions = shape.sample(3000, 0.0, 9);
    // Inside out on purpose: the surface must follow.
    let normals: Vec<f32> = points(&positions)
        .flat_map(|p| (-p).as_vec3().to_array())
        .collect();
    let cloud = Cloud::from_f64(&positions)
        .unwrap()
        .with_normals(&normals)
        .unwrap();
    let params = SurfaceParams {
        orient: false,
        boundary: Boundary::Open,
        ..unreduced()
    };
    let s = reconstruct(&cloud, &params, &mut Silent).unwrap();
    assert!(size(&s).0 < 0.0);
    let without = surface(&positions, &params).unwrap_err();
    assert_eq!(without.code(), "bad-option");
}

#[test]
fn given_normals_of_any_kind_do_no_harm() {
    for (shape, noise) in [Shape::Torus, Shape::Box]
        .map(|s| [(s, 0.0), (s, 0.02)])
        .concat()
    {
        let positions = shape.sample(8000, noise, 5);
        let mut rng = Rng::new(6);
        let mut of = |tilt: f64, sign: f64| {
            let normals = points(&positions).flat_map(|p| {
                let aside = DVec3::new(rng.normal(), rng.normal(), rng.normal());
                let normal = shape.normal(p) + tilt * aside;
                (sign * normal.normalize()).as_vec3().to_array()
            });
            normals.collect::<Vec<f32>>()
        };
        let error = |normals: Option<Vec<f32>>| {
            let mut cloud = Cloud::from_f64(&positions).unwrap();
            if let Some(normals) = normals {
                cloud = cloud.with_normals(&normals).unwrap();
            }
            let s = reconstruct(&cloud, &SurfaceParams::default(), &mut Silent).unwrap();
            let vertices = s.positions_f64();
            let off = points(&vertices).map(|p| shape.distance(p).abs());
            off.sum::<f64>() / s.mesh.vertices.len() as f64
        };
        let none = error(None);
        for (tilt, sign) in [(0.0, 1.0), (0.0, -1.0), (0.1, -1.0), (0.3, 1.0)] {
            let with = error(Some(of(tilt, sign)));
            assert!(
                with < 1.04 * none,
                "{shape:?}, noise {noise}, tilt {tilt}, {sign}: {with} for {none}"
            );
        }
        if noise > 0.0 && matches!(shape, Shape::Torus) {
            let with = error(Some(of(0.0, 1.0)));
            assert!(with < 0.98 * none, "{shape:?}: {with} for {none}");
        }
    }
}

#[test]
fn colours_scalars_and_origin_reach_the_vertices() {
    let shape = Shape::Sphere;
    let positions = shape.sample(6000, 0.0, 10);
    let colors: Vec<u8> = points(&positions)
        .flat_map(|p| if p.x > 0.0 { [255, 0, 0] } else { [0, 0, 255] })
        .collect();
    let heights: Vec<f32> = points(&positions).map(|p| p.z as f32).collect();
    let cloud = Cloud::from_f64(&positions)
        .unwrap()
        .with_colors(&colors)
        .unwrap()
        .with_attribute("height", &heights)
        .unwrap()
        .with_origin([1e6, 2e6, 3e6]);
    let s = reconstruct(&cloud, &SurfaceParams::default(), &mut Silent).unwrap();
    assert_eq!(s.cloud.reduced.cloud.origin, Some([1e6, 2e6, 3e6]));
    let vertices = s.positions_f64();
    let colors = s.colors.as_ref().unwrap();
    for (p, c) in points(&vertices)
        .zip(colors)
        .filter(|(p, _)| p.x.abs() > 0.2)
    {
        assert_eq!(*c, if p.x > 0.0 { [255, 0, 0] } else { [0, 0, 255] });
    }
    assert_eq!(s.attributes[0].name, "height");
    for (p, h) in points(&vertices).zip(&s.attributes[0].values) {
        assert!((p.z - *h as f64).abs() < 0.1, "{h} at height {}", p.z);
    }
}

#[test]
fn labels_stay_labels_on_the_vertices() {
    let positions = Shape::Sphere.sample(4000, 0.0, 10);
    let class = |p: DVec3| if p.x > 0.0 { 2.0 } else { 9.0 };
    let labels: Vec<f32> = points(&positions).map(class).collect();
    let color = |p: DVec3| if p.y > 0.0 { [200, 0, 3] } else { [0, 90, 7] };
    let colors: Vec<u8> = points(&positions).flat_map(color).collect();
    let cloud = ["mean", "majority", "nearest"]
        .iter()
        .try_fold(Cloud::from_f64(&positions).unwrap(), |cloud, name| {
            cloud.with_attribute(name, &labels)
        })
        .and_then(|cloud| cloud.with_colors(&colors))
        .unwrap();
    for how in [Carry::Mean, Carry::Majority, Carry::Nearest] {
        let named = [
            ("majority", Carry::Majority),
            ("nearest", Carry::Nearest),
            (COLORS, how),
        ];
        let reduce = ReduceParams {
            attributes: named.map(|(name, how)| (name.into(), how)).into(),
            ..Default::default()
        };
        let params = SurfaceParams {
            reduce: Some(reduce),
            ..Default::default()
        };
        let s = reconstruct(&cloud, &params, &mut Silent).unwrap();
        let [mean, majority, nearest] = [0, 1, 2].map(|a| &s.attributes[a].values);
        assert!(mean.iter().any(|v| (3.0..8.0).contains(v)), "means between");
        let vertices = s.positions_f64();
        for (kind, values) in [("majority", majority), ("nearest", nearest)] {
            for (p, v) in points(&vertices).zip(values) {
                assert!([2.0, 9.0].contains(v), "{kind}: {v}");
                assert!(p.x.abs() < 0.2 || *v == class(p), "{kind}: {v} at {p}");
            }
        }
        let colors = s.colors.as_ref().unwrap();
        let pure = colors.iter().all(|c| [[200, 0, 3], [0, 90, 7]].contains(c));
        assert_eq!(pure, how != Carry::Mean, "{how:?}");
    }
}

#[test]
fn degenerate_input_gives_a_clear_error() {
    let line: Vec<f64> = (0..300)
        .flat_map(|i| [i as f64, 2.0 * i as f64, 0.0])
        .collect();
    let cases: [(&str, Vec<f64>, &str); 7] = [
        ("empty", vec![], "empty-cloud"),
        ("one point", vec![1.0, 2.0, 3.0], "too-few-points"),
        (
            "three points",
            vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0],
            "too-few-points",
        ),
        ("all equal", [1.0, 2.0, 3.0].repeat(100), "degenerate"),
        ("collinear", line, "degenerate"),
        ("two values", vec![1.0, 2.0], "bad-length"),
        (
            "a NaN",
            vec![0.0, 0.0, 0.0, 1.0, f64::NAN, 0.0],
            "non-finite",
        ),
    ];
    for (name, positions, code) in cases {
        let error = surface(&positions, &SurfaceParams::default()).unwrap_err();
        assert_eq!(error.code(), code, "{name}");
    }
    let error = surface(&[0.0, 0.0, 0.0, 1.0, f64::NAN, 0.0], &unreduced()).unwrap_err();
    assert_eq!(error.index(), Some(1));
}

#[test]
fn odd_input_gives_a_manifold_mesh() {
    let flat: Vec<f64> = points(&Shape::Box.sample(3000, 0.0, 11))
        .flat_map(|p| [p.x, p.y, 0.0])
        .collect();
    let mut doubled = Shape::Sphere.sample(2000, 0.0, 12);
    doubled.extend_from_within(..);
    let mut rng = pointweave::base::rng::Rng::new(13);
    let scattered: Vec<f64> = (0..6000).map(|_| rng.uniform()).collect();
    let four = vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    for (name, positions) in [
        ("coplanar", flat),
        ("duplicates", doubled),
        ("random in a cube", scattered),
        ("four points", four),
    ] {
        for boundary in [Boundary::Auto, Boundary::Open, Boundary::Closed] {
            let params = SurfaceParams {
                boundary,
                ..Default::default()
            };
            match surface(&positions, &params) {
                Ok(s) => {
                    let t = topology(&s.mesh.triangles, s.mesh.vertices.len());
                    assert!(t.is_manifold(), "{name}, {boundary:?}: {t:?}");
                    assert!(s.mesh.vertices.iter().all(|v| v.is_finite()), "{name}");
                    assert!(
                        boundary != Boundary::Closed || t.boundary_edges == 0,
                        "{name}"
                    );
                }
                Err(error) => assert_eq!(error.code(), "degenerate", "{name}"),
            }
        }
    }
}

#[test]
fn copies_of_points_leave_the_surface_as_it_is() {
    let once = Shape::Sphere.sample(3000, 0.0, 12);
    let six: Vec<f64> = (0..6).flat_map(|_| once.iter().copied()).collect();
    let params = SurfaceParams {
        boundary: Boundary::Open,
        ..unreduced()
    };
    let expected = surface(&once, &params).unwrap();
    let found = surface(&six, &params).unwrap();
    for s in [&expected, &found] {
        assert_eq!(s.report.boundary_edges, 0);
        assert_eq!(s.report.components, 1);
    }
    let ratio = found.report.triangles as f64 / expected.report.triangles as f64;
    assert!((ratio - 1.0).abs() < 0.05, "{ratio} times the triangles");
    // In Morton order copies follow each other.
    let cloud = &found.cloud.reduced.cloud;
    let normals = cloud.normals.as_ref().unwrap();
    for (points, normals) in cloud.points.chunks(6).zip(normals.chunks(6)) {
        assert!(points.iter().all(|p| *p == points[0]));
        assert!(normals.iter().all(|n| *n == normals[0]));
        assert!(normals[0].is_normalized());
    }
}

#[test]
fn residuals_meet_the_accuracy_and_refinement_helps() {
    let positions = Shape::Box.sample(9000, 0.0, 14);
    let coarse = ReduceParams {
        target: Target::Ratio(0.1),
        ..Default::default()
    };
    let with = |accuracy| {
        let params = SurfaceParams {
            reduce: Some(coarse.clone()),
            accuracy,
            ..Default::default()
        };
        surface(&positions, &params).unwrap().report
    };
    let (loose, tight) = (with(0.1), with(6e-4));
    assert_eq!(loose.refinements, 0);
    assert!(
        tight.refinements > 0,
        "creases of a box in 900 points need refinement"
    );
    assert!(tight.residual.rms <= loose.residual.rms);
    assert!(tight.beyond_accuracy < 0.5);
}

#[test]
fn a_job_stops_when_asked_and_the_next_one_runs() {
    let positions = Shape::Sphere.sample(3000, 0.0, 15);
    let cloud = Cloud::from_f64(&positions).unwrap();
    for stop in [
        Stage::Features,
        Stage::Cluster,
        Stage::Fit,
        Stage::Orient,
        Stage::Extract,
    ] {
        let mut listen = |stage: Stage, _: f32| stage != stop;
        let error = reconstruct(&cloud, &SurfaceParams::default(), &mut listen).unwrap_err();
        assert_eq!(error, Error::Cancelled, "{stop:?}");
    }
    assert!(reconstruct(&cloud, &SurfaceParams::default(), &mut Silent).is_ok());
}
