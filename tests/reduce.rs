//! What a reduction promises: exact counts, points on the surface, complete bookkeeping, no input that breaks it.

mod common;

use common::{Shape, distances_to, points};
use glam::{DVec3, Vec3};
use pointweave::base::params::{
    COLORS, Carry, Clusters, Method, Norm, Outliers, Placement, Target,
};
use pointweave::base::progress::Silent;
use pointweave::base::rng::Rng;
use pointweave::cloud::octree::Octree;
use pointweave::features::Features;
use pointweave::features::outliers::{self, DROPPED};
use pointweave::reduce::density::quotas;
use pointweave::reduce::{Reduced, reduce};
use pointweave::samples::{Model, NOISE, sample_with_noise};
use pointweave::{Cloud, Error, ReduceParams, Stage, SurfaceParams, pipeline};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn run(cloud: &Cloud, params: &ReduceParams) -> Reduced {
    let tree = Octree::build(&cloud.points);
    let features = Features::measure(&tree, &mut Silent).unwrap();
    let reduced = reduce(cloud, &tree, features, params, &mut Silent).unwrap();
    assert_sound(cloud, &reduced);
    reduced
}

/// Lengths, finiteness, weights and indices of any result.
fn assert_sound(cloud: &Cloud, r: &Reduced) {
    let n = r.cloud.len();
    let normals = r.cloud.normals.as_ref().unwrap();
    for length in [
        normals.len(),
        r.spacing.len(),
        r.variation.len(),
        r.weights.len(),
        r.nearest.len(),
    ] {
        assert_eq!(length, n);
    }
    assert!(r.cloud.points.iter().chain(normals).all(|p| p.is_finite()));
    assert!(r.spacing.iter().all(|s| s.is_finite() && *s >= 0.0));
    assert!(r.variation.iter().all(|v| (0.0..=0.34).contains(v)));
    let unit = |n: &Vec3| *n == Vec3::ZERO || (n.length() - 1.0).abs() < 1e-5;
    assert!(normals.iter().all(unit));
    let total: f64 = r.weights.iter().map(|&w| f64::from(w)).sum();
    assert_eq!(
        total,
        cloud.len() as f64,
        "weights add up to the input's count"
    );
    if let Some(assignment) = &r.assignment {
        assert_eq!(assignment.len(), cloud.len());
        let mut members = vec![0.0; n];
        assignment.iter().for_each(|&i| members[i as usize] += 1.0);
        assert_eq!(members, r.weights);
    }
    for (p, &i) in r
        .cloud
        .points
        .iter()
        .zip(&r.nearest)
        .step_by(n.div_ceil(50))
    {
        let nearest = cloud
            .points
            .iter()
            .map(|q| q.distance_squared(*p))
            .fold(f32::INFINITY, f32::min);
        assert_eq!(cloud.points[i as usize].distance_squared(*p), nearest);
    }
}

fn count(n: usize) -> ReduceParams {
    ReduceParams {
        target: Target::Count(n),
        ..Default::default()
    }
}

fn cloud_of(points: &[Vec3]) -> Cloud {
    let positions: Vec<f32> = points.iter().flat_map(|p| p.to_array()).collect();
    Cloud::from_f32(&positions).unwrap()
}

fn shape(shape: Shape, n: usize, noise: f64) -> Cloud {
    Cloud::from_f64(&shape.sample(n, noise, 5)).unwrap()
}

/// Root mean square distance of the points to the shape, as a share of the diagonal.
fn rms(shape: Shape, r: &Reduced) -> f64 {
    let positions = r.cloud.positions_f64();
    let squares: f64 = points(&positions).map(|p| shape.distance(p).powi(2)).sum();
    (squares / r.cloud.len() as f64).sqrt() / r.cloud.frame.diagonal
}

#[test]
fn counts_are_exact_from_one_to_all() {
    let cloud = shape(Shape::Box, 700, 0.0);
    for method in [Method::Adaptive, Method::Paper] {
        for n in [1, 2, 3, 7, 50, 233, 350, 600, 690, 699, 700, 5000] {
            let r = run(&cloud, &ReduceParams { method, ..count(n) });
            assert_eq!(r.cloud.len(), n.min(700), "{method:?}");
        }
        for ratio in [1e-9, 0.1, 1.0 / 3.0, 0.5, 0.9, 1.0] {
            let target = Target::Ratio(ratio);
            let r = run(
                &cloud,
                &ReduceParams {
                    method,
                    target,
                    ..Default::default()
                },
            );
            assert_eq!(r.cloud.len(), ((700.0 * ratio).round() as usize).max(1));
        }
    }
}

#[test]
fn tiny_and_degenerate_clouds_are_reduced_too() {
    let line = |n: usize| {
        (0..n)
            .map(|i| Vec3::new(i as f32, 0.0, 0.0))
            .collect::<Vec<_>>()
    };
    let plane: Vec<Vec3> = (0..400)
        .map(|i| Vec3::new((i % 20) as f32, (i / 20) as f32, 0.0))
        .collect();
    let copies: Vec<Vec3> = (0..600).map(|i| line(30)[i % 30]).collect();
    let mut uneven = plane.clone();
    uneven.extend((0..900).map(|i| Vec3::splat(5.0 + i as f32 * 1e-6)));
    uneven.push(Vec3::splat(1e6));
    let clouds = [
        line(1),
        line(2),
        line(3),
        line(10),
        line(200),
        vec![Vec3::ONE; 500],
        plane,
        copies,
        uneven,
    ];
    for points in clouds {
        let cloud = cloud_of(&points);
        let n = points.len();
        let places = distinct(&cloud.points);
        for method in [Method::Adaptive, Method::Paper] {
            for placement in [
                Placement::Implicit,
                Placement::Mesh,
                Placement::Center,
                Placement::Sample,
            ] {
                for c in [1, n.div_ceil(3), n - n / 10, n] {
                    let r = run(
                        &cloud,
                        &ReduceParams {
                            method,
                            placement,
                            ..count(c)
                        },
                    );
                    // All points are kept with their copies; fewer are at places of their own.
                    assert_eq!(r.cloud.len(), if c == n { n } else { c.min(places) });
                }
            }
            for target in [Target::Tolerance(1e-3), Target::Flatness(3e-4)] {
                run(
                    &cloud,
                    &ReduceParams {
                        method,
                        target,
                        ..Default::default()
                    },
                );
            }
        }
    }
}

/// How many places some points are at.
fn distinct(points: &[Vec3]) -> usize {
    let mut places: Vec<[u32; 3]> = points
        .iter()
        .map(|p| p.to_array().map(f32::to_bits))
        .collect();
    places.sort_unstable();
    places.dedup();
    places.len()
}

#[test]
fn copies_are_one_place_that_stands_for_all_of_them() {
    let once = shape(Shape::Torus, 150, 0.0);
    let hundred: Vec<Vec3> = (0..15_000).map(|i| once.points[i % 150]).collect();
    let positions: Vec<f64> = hundred
        .iter()
        .flat_map(|p| p.as_dvec3().to_array())
        .collect();
    let value: Vec<f32> = (0..15_000).map(|i| (i / 150) as f32).collect();
    let cloud = Cloud::from_f64(&positions)
        .unwrap()
        .with_attribute("run", &value)
        .unwrap();
    for target in [Target::Ratio(1.0 / 3.0), Target::Count(14_999)] {
        for method in [Method::Adaptive, Method::Paper] {
            let params = ReduceParams {
                target,
                method,
                assignment: true,
                ..Default::default()
            };
            let r = run(&cloud, &params);
            assert_eq!((r.cloud.len(), distinct(&r.cloud.points)), (150, 150));
            assert!(r.reason.contains("150 places"), "{}", r.reason);
            assert!(r.weights.iter().all(|&w| w == 100.0));
            // The copies differ in their scalar: the mean is that of all of them.
            assert!(
                r.cloud.attributes[0]
                    .values
                    .iter()
                    .all(|&v| (v - 49.5).abs() < 1e-3)
            );
            let assignment = r.assignment.unwrap();
            assert!((0..15_000).all(|i| assignment[i] == assignment[i % 150]));
            for (&nearest, p) in r.nearest.iter().zip(&r.cloud.points) {
                assert_eq!(cloud.points[nearest as usize], *p);
            }
        }
    }
    // As many as are asked for where there are places enough.
    let r = run(&cloud, &count(40));
    assert_eq!((r.cloud.len(), distinct(&r.cloud.points)), (40, 40));
    assert_eq!(
        (r.weights.iter().sum::<f32>(), r.reason.as_str()),
        (15_000.0, "")
    );
}

#[test]
fn copies_share_their_place_and_do_not_starve_the_rest() {
    // Every point twenty times: the same as once, but for the weights.
    let once = shape(Shape::Sphere, 600, 0.0);
    let many = cloud_of(
        &once
            .points
            .iter()
            .flat_map(|p| [*p; 20])
            .collect::<Vec<_>>(),
    );
    let r = run(&many, &count(200));
    let middle: Vec3 = r.cloud.points.iter().sum::<Vec3>() / 200.0;
    assert!(
        middle.length() < 0.03,
        "spread over the sphere, not heaped: {middle}"
    );
}

#[test]
fn points_lie_on_the_surface() {
    for (s, tolerance) in [
        (Shape::Sphere, 2e-5),
        (Shape::Torus, 2e-4),
        (Shape::TwoSpheres, 3e-5),
    ] {
        let r = run(&shape(s, 12_000, 0.0), &count(4000));
        assert!(rms(s, &r) < tolerance, "{s:?}: {}", rms(s, &r));
    }
}

#[test]
fn noise_is_halved_and_normals_follow_the_surface() {
    for s in [Shape::Sphere, Shape::Torus, Shape::Box] {
        for noise in [1e-3, 5e-3] {
            let diagonal = Cloud::from_f64(&s.sample(1000, 0.0, 5))
                .unwrap()
                .frame
                .diagonal;
            let cloud = shape(s, 20_000, noise * diagonal);
            let r = run(&cloud, &count(6667));
            assert!(rms(s, &r) < 0.5 * noise, "{s:?}: {} of {noise}", rms(s, &r));
            let positions = r.cloud.positions_f64();
            let normals = r.cloud.normals.as_ref().unwrap();
            let agree = points(&positions)
                .zip(normals)
                .map(|(p, n)| s.normal(p).dot(n.as_dvec3()).abs());
            let least = if matches!(s, Shape::Box) { 0.95 } else { 0.98 }; // edges are rounded
            assert!(agree.sum::<f64>() / 6667.0 > least, "{s:?}");
        }
    }
}

#[test]
fn samples_are_input_points_and_no_two_the_same() {
    let cloud = shape(Shape::Torus, 3000, 1e-3);
    for method in [Method::Adaptive, Method::Paper] {
        let r = run(
            &cloud,
            &ReduceParams {
                method,
                placement: Placement::Sample,
                ..count(900)
            },
        );
        let mut indices = r.nearest.clone();
        indices.sort_unstable();
        indices.dedup();
        assert_eq!(indices.len(), 900);
        assert!(
            r.nearest
                .iter()
                .zip(&r.cloud.points)
                .all(|(&i, &p)| cloud.points[i as usize] == p)
        );
    }
}

#[test]
fn curved_parts_get_more_points_and_even_parts_stay_even() {
    let cloud = shape(Shape::Box, 20_000, 0.0);
    let share_near_edges = |curvature_weight| {
        let r = run(
            &cloud,
            &ReduceParams {
                curvature_weight,
                ..count(2000)
            },
        );
        assert!(r.stats.evenness < 0.3, "{}", r.stats.evenness);
        let edge = |p: DVec3| {
            let mut q = (p.abs() - DVec3::new(1.0, 0.7, 0.5)).to_array();
            q.sort_by(f64::total_cmp);
            q[1] > -0.1
        };
        points(&r.cloud.positions_f64())
            .filter(|&p| edge(p))
            .count()
    };
    let (even, strong) = (share_near_edges(0.0), share_near_edges(1.0));
    assert!(strong as f64 > 1.2 * even as f64, "{even} {strong}");
}

/// A unit sphere with fifteen times the density on one side.
fn uneven_sphere(n: usize, noise: f64) -> Vec<f64> {
    let mut rng = Rng::new(3);
    let mut positions = Vec::new();
    while positions.len() < 3 * n {
        let p = DVec3::new(rng.normal(), rng.normal(), rng.normal()).normalize();
        if rng.uniform() < if p.x > 0.0 { 1.0 } else { 1.0 / 15.0 } {
            positions.extend((p * (1.0 + noise * rng.normal())).to_array());
        }
    }
    positions
}

#[test]
fn uneven_scans_become_even() {
    let cloud = Cloud::from_f64(&uneven_sphere(20_000, 0.0)).unwrap();
    let r = run(&cloud, &count(1500));
    let sparse = points(&r.cloud.positions_f64())
        .filter(|p| p.x < 0.0)
        .count();
    assert!(
        (600..900).contains(&sparse),
        "{sparse} of 1500 on the sparse half"
    );
}

#[test]
fn what_the_caller_attached_is_carried_along() {
    let cloud = shape(Shape::Sphere, 4000, 0.0);
    let z: Vec<f32> = cloud.points.iter().map(|p| p.z).collect();
    let colors: Vec<u8> = cloud
        .points
        .iter()
        .flat_map(|p| if p.x > 0.0 { [255, 0, 0] } else { [0, 0, 255] })
        .collect();
    let normals: Vec<f32> = cloud.points.iter().flat_map(|p| (-*p).to_array()).collect();
    let cloud = cloud
        .with_attribute("z", &z)
        .unwrap()
        .with_colors(&colors)
        .unwrap();
    let cloud = cloud
        .with_normals(&normals)
        .unwrap()
        .with_origin([1e6, 2e6, 3.0]);
    let r = run(&cloud, &count(800));
    assert_eq!((r.cloud.origin, r.cloud.frame), (cloud.origin, cloud.frame));
    let near = |(p, z): (&Vec3, &f32)| (p.z - z).abs() < 0.01;
    assert!(
        r.cloud
            .points
            .iter()
            .zip(&r.cloud.attributes[0].values)
            .all(near)
    );
    let colors = r.cloud.colors.as_ref().unwrap();
    let pure = r
        .cloud
        .points
        .iter()
        .zip(colors)
        .filter(|(p, _)| p.x.abs() > 0.05);
    pure.for_each(|(p, c)| assert_eq!(*c, if p.x > 0.0 { [255, 0, 0] } else { [0, 0, 255] }));
    // The given normals point inwards, so the reduced ones do.
    let inwards = r.cloud.points.iter().zip(r.cloud.normals.as_ref().unwrap());
    inwards.for_each(|(p, n)| assert!(p.dot(*n) < 0.0));
}

fn carried<const N: usize>(attributes: [(&str, Carry); N], params: ReduceParams) -> ReduceParams {
    ReduceParams {
        attributes: attributes.map(|(name, how)| (name.into(), how)).into(),
        ..params
    }
}

#[test]
fn labels_stay_labels() {
    let cloud = shape(Shape::Torus, 6000, 1e-3);
    let class = |p: &Vec3| if p.x > 0.0 { 2.0 } else { 9.0 };
    let labels: Vec<f32> = cloud.points.iter().map(class).collect();
    let color = |p: &Vec3| if p.y > 0.0 { [200, 0, 3] } else { [0, 90, 7] };
    let colors: Vec<u8> = cloud.points.iter().flat_map(color).collect();
    let cloud = ["mean", "majority", "nearest"]
        .iter()
        .try_fold(cloud, |cloud, name| cloud.with_attribute(name, &labels))
        .and_then(|cloud| cloud.with_colors(&colors))
        .unwrap();
    for method in [Method::Adaptive, Method::Paper] {
        for how in [Carry::Mean, Carry::Majority, Carry::Nearest] {
            let params = ReduceParams {
                method,
                ..count(700)
            };
            let named = [
                ("majority", Carry::Majority),
                ("nearest", Carry::Nearest),
                (COLORS, how),
            ];
            let r = run(&cloud, &carried(named, params));
            let [mean, majority, nearest] = [0, 1, 2].map(|a| &r.cloud.attributes[a].values);
            let mixed = mean.iter().filter(|v| ![2.0, 9.0].contains(v)).count();
            assert!((10..200).contains(&mixed), "{mixed} means at the border");
            let larger = |(m, l): (&f32, &f32)| *l == if *m < 5.5 { 2.0 } else { 9.0 };
            assert!(mean.iter().zip(majority).all(larger));
            let own = |(l, &i): (&f32, &u32)| *l == labels[i as usize];
            assert!(nearest.iter().zip(&r.nearest).all(own));
            let colors = r.cloud.colors.as_ref().unwrap();
            let pure = colors.iter().all(|c| [[200, 0, 3], [0, 90, 7]].contains(c));
            assert_eq!(pure, how != Carry::Mean, "{how:?}");
            if how == Carry::Nearest {
                let all = cloud.colors.as_ref().unwrap();
                let own = |(c, &i): (&[u8; 3], &u32)| *c == all[i as usize];
                assert!(colors.iter().zip(&r.nearest).all(own));
            }
        }
    }
}

#[test]
fn of_equally_frequent_labels_the_smallest_is_taken() {
    let one_of = |labels: &[f32], colors: &[u8]| {
        let line: Vec<Vec3> = (0..labels.len())
            .map(|i| Vec3::new(i as f32, 0.0, 0.0))
            .collect();
        let cloud = cloud_of(&line).with_attribute("label", labels).unwrap();
        let cloud = cloud.with_colors(colors).unwrap();
        let both = [("label", Carry::Majority), (COLORS, Carry::Majority)];
        let r = run(&cloud, &carried(both, count(1))).cloud;
        (r.attributes[0].values[0], r.colors.unwrap()[0])
    };
    let black_or_blue = [0, 0, 255, 0, 0, 0];
    assert_eq!(one_of(&[5.0, 2.0], &black_or_blue), (2.0, [0, 0, 0]));
    assert_eq!(one_of(&[-1.0, -3.0], &black_or_blue), (-3.0, [0, 0, 0]));
    let mostly_green = [9, 9, 9, 0, 200, 0, 1, 1, 1, 0, 200, 0];
    assert_eq!(
        one_of(&[7.0, 1.0, 7.0, 4.0], &mostly_green),
        (7.0, [0, 200, 0])
    );
}

#[test]
fn a_name_that_the_cloud_does_not_have_is_refused() {
    let bare = shape(Shape::Sphere, 100, 0.0);
    let height = vec![0.0; 100];
    let cloud = bare.clone().with_attribute("height", &height).unwrap();
    let colored = cloud.clone().with_colors(&[0; 300]).unwrap();
    for (cloud, name, expected) in [
        (&bare, "height", "an empty object"),
        (&cloud, "heigth", "height"),
        (&cloud, COLORS, "height"),
        (&colored, "", "height, colors"),
    ] {
        let params = carried([(name, Carry::Nearest)], ReduceParams::default());
        let surface = SurfaceParams {
            reduce: Some(params.clone()),
            ..Default::default()
        };
        for error in [
            pipeline::reduce(cloud, &params, &mut Silent).unwrap_err(),
            pipeline::reconstruct(cloud, &surface, &mut Silent).unwrap_err(),
        ] {
            assert_eq!(error.code(), "bad-option");
            let found = error.found().unwrap();
            assert!(found.ends_with(name), "{found}");
            let said = error.expected().unwrap();
            assert!(said.contains(expected), "{said}");
            assert!(error.to_string().contains("option attributes"), "{error}");
        }
    }
    let params = carried([(COLORS, Carry::Nearest)], ReduceParams::default());
    assert!(pipeline::reduce(&colored, &params, &mut Silent).is_ok());
}

#[test]
fn every_input_point_knows_its_reduced_point() {
    let cloud = shape(Shape::Box, 3000, 1e-3);
    for method in [Method::Adaptive, Method::Paper] {
        for target in [
            Target::Count(1),
            Target::Count(500),
            Target::Ratio(1.0),
            Target::Flatness(3e-4),
        ] {
            for placement in [Placement::Center, Placement::Sample] {
                let params = ReduceParams {
                    method,
                    target,
                    placement,
                    ..Default::default()
                };
                assert_eq!(run(&cloud, &params).assignment, None);
                let asked = ReduceParams {
                    assignment: true,
                    ..params
                };
                let r = run(&cloud, &asked);
                let assignment = r.assignment.unwrap();
                let farther = cloud.points.iter().zip(&assignment).filter(|(p, i)| {
                    let own = p.distance(r.cloud.points[**i as usize]);
                    let next = r.cloud.points.iter().map(|q| p.distance(*q));
                    own > 1.5 * next.fold(f32::INFINITY, f32::min) + 0.01
                });
                // In the input's order: a wrong one would name points anywhere.
                assert!(farther.count() < 30, "{method:?}, {target:?}");
            }
        }
    }
}

/// A fifth of the points, without those that are isolated.
fn without_outliers() -> ReduceParams {
    ReduceParams {
        target: Target::Ratio(0.2),
        assignment: true,
        outliers: Outliers::Drop,
        ..Default::default()
    }
}

/// Points spread evenly over the shapes' box and half as far around it, and eight clumps of 1 to 8 points beyond.
fn strays(n: usize) -> Vec<f64> {
    let mut rng = Rng::new(8);
    let mut positions: Vec<f64> = (0..3 * n).map(|_| 6.0 * rng.uniform() - 3.0).collect();
    for size in 1..=8 {
        let away = DVec3::new(rng.normal(), rng.normal(), rng.normal()).normalize() * 5.0;
        for _ in 0..size {
            let jitter = DVec3::new(rng.normal(), rng.normal(), rng.normal());
            positions.extend((away + 0.02 * jitter).to_array());
        }
    }
    positions
}

#[test]
fn stray_points_and_clumps_are_dropped_and_nothing_else() {
    let n = 20_000;
    for s in Shape::ALL {
        let diagonal = shape(s, n, 0.0).frame.diagonal;
        for noise in [0.0, 1e-3] {
            let mut positions = s.sample(n, noise * diagonal, 5);
            positions.extend(strays(n / 20));
            let cloud = Cloud::from_f64(&positions).unwrap();
            let result = pipeline::reduce(&cloud, &without_outliers(), &mut Silent).unwrap();
            let r = &result.reduced;
            let assignment = r.assignment.as_ref().unwrap();
            let dropped = |i: usize| assignment[i] == DROPPED;
            assert_eq!((0..n).filter(|&i| dropped(i)).count(), 0, "{s:?} {noise}");
            let spacing = (s.area() / n as f64).sqrt();
            let far = |p: DVec3| s.distance(p).abs() > 5.0 * (spacing + noise * diagonal);
            let (mut strays, mut left) = (0, 0);
            for (i, p) in points(&positions).enumerate().skip(n).take(n / 20) {
                strays += usize::from(far(p));
                left += usize::from(far(p) && !dropped(i));
            }
            assert!(strays > n / 40 && left <= strays / 50, "{left} of {strays}");
            assert!((n + n / 20..assignment.len()).all(dropped), "clumps");

            let count = (0..assignment.len()).filter(|&i| dropped(i)).count();
            let kept = assignment.len() - count;
            assert_eq!(result.report.outliers, count);
            assert_eq!(result.report.input_points, assignment.len());
            assert_eq!(r.cloud.len(), (0.2 * kept as f64).round() as usize);
            assert_eq!(r.weights.iter().sum::<f32>(), kept as f32);
            // The frame is that of the points that are left, their indices the caller's.
            assert!(r.cloud.frame.diagonal < 1.3 * diagonal.max(3.5));
            let mut weights = vec![0.0; r.cloud.len()];
            for &own in assignment.iter().filter(|&&own| own != DROPPED) {
                weights[own as usize] += 1.0;
            }
            assert_eq!(weights, r.weights);
            for (p, &i) in points(&r.cloud.positions_f64()).zip(&r.nearest) {
                let input = DVec3::from_slice(&positions[3 * i as usize..]);
                assert!(!dropped(i as usize) && p.distance(input) < 6.0 * spacing);
            }
        }
    }
}

#[test]
fn nothing_of_a_clean_scan_is_dropped() {
    let mut scans: Vec<Vec<f64>> = vec![uneven_sphere(20_000, 0.0), uneven_sphere(60_000, 2e-3)];
    for s in Shape::ALL {
        scans.extend([300, 3000, 20_000].map(|n| s.sample(n, 0.0, 6)));
    }
    // Open sheets with borders and corners: at random, and a grid.
    let mut rng = Rng::new(2);
    let wave = |x: f64, y: f64| [x, y, 0.1 * (3.0 * x).sin()];
    scans.push(
        (0..10_000)
            .flat_map(|_| wave(rng.uniform(), rng.uniform()))
            .collect(),
    );
    let grid = |i: i32| wave(f64::from(i % 100) / 99.0, f64::from(i / 100) / 99.0);
    scans.push((0..10_000).flat_map(grid).collect());
    // Lines of a scanner, ten times as dense along as across.
    let line = |i: i32| wave(f64::from(i % 400) / 400.0, f64::from(i / 400) / 40.0);
    scans.push((0..16_000).flat_map(line).collect());
    // Every point five times.
    let once = Shape::Torus.sample(2000, 0.0, 6);
    scans.push(once.chunks_exact(3).flat_map(|p| p.repeat(5)).collect());
    for (k, positions) in scans.iter().enumerate() {
        let cloud = Cloud::from_f64(positions).unwrap();
        let drop = pipeline::reduce(&cloud, &without_outliers(), &mut Silent).unwrap();
        assert_eq!(drop.report.outliers, 0, "scan {k}");
        assert_eq!(drop.report.reason, "");
        let keep = ReduceParams {
            outliers: Outliers::Keep,
            ..without_outliers()
        };
        let keep = pipeline::reduce(&cloud, &keep, &mut Silent).unwrap();
        assert_eq!(drop.reduced.cloud, keep.reduced.cloud, "scan {k}");
        assert_eq!(drop.reduced.assignment, keep.reduced.assignment);
    }
}

#[test]
fn a_cloud_is_given_away_or_kept() {
    let mut positions = Shape::Torus.sample(5000, 0.0, 5);
    positions.extend(strays(50));
    let colors: Vec<u8> = (0..positions.len()).map(|i| (i % 251) as u8).collect();
    let cloud = Cloud::from_f64(&positions)
        .and_then(|cloud| cloud.with_colors(&colors))
        .unwrap();
    for outliers in [Outliers::Keep, Outliers::Drop] {
        let params = ReduceParams {
            outliers,
            ..without_outliers()
        };
        let kept = pipeline::reduce(&cloud, &params, &mut Silent).unwrap();
        let given = pipeline::reduce_owned(cloud.clone(), &params, &mut Silent).unwrap();
        assert_eq!(given.reduced.cloud, kept.reduced.cloud);
        assert_eq!(given.reduced.nearest, kept.reduced.nearest);
        assert_eq!(given.reduced.assignment, kept.reduced.assignment);
        assert_eq!(given.report.outliers, kept.report.outliers);
    }
}

#[test]
fn noise_is_not_isolated() {
    for n in [2000, 80_000] {
        for s in Shape::ALL {
            let diagonal = shape(s, 1000, 0.0).frame.diagonal;
            let cloud = shape(s, n, 5e-3 * diagonal);
            let tree = Octree::build(&cloud.points);
            let noise = Features::measure(&tree, &mut Silent).unwrap().noise;
            let isolated = outliers::isolated(&tree, noise, &mut Silent).unwrap();
            let dropped = isolated.iter().filter(|&&is| is).count();
            assert!(dropped * 1000 <= n, "{s:?}: {dropped} of {n}");
        }
    }
}

#[test]
fn a_scan_is_not_dropped_as_a_whole() {
    let few: Vec<f64> = (0..6).flat_map(|i| [f64::from(i * i), 0.0, 1.0]).collect();
    let mut rng = Rng::new(1);
    let clumps: Vec<f64> = (0..90)
        .map(|i| f64::from(i / 24 * 100) + rng.uniform())
        .collect();
    for positions in [few, clumps, vec![1.0; 60]] {
        let cloud = Cloud::from_f64(&positions).unwrap();
        let result = pipeline::reduce(&cloud, &without_outliers(), &mut Silent).unwrap();
        assert_eq!(result.report.outliers, 0);
        let reason = result.report.reason;
        assert!(reason.contains("isolated: none was dropped"), "{reason}");
    }
}

#[test]
fn a_mesh_is_made_without_the_outliers() {
    let n = 6000;
    let mut positions = Shape::Torus.sample(n, 0.0, 5);
    positions.extend(strays(60));
    let cloud = Cloud::from_f64(&positions).unwrap();
    let run = |reduce| {
        let params = SurfaceParams {
            reduce,
            ..Default::default()
        };
        pipeline::reconstruct(&cloud, &params, &mut Silent).unwrap()
    };
    let params = ReduceParams {
        target: Target::Ratio(0.4),
        ..without_outliers()
    };
    let surface = run(Some(params.clone()));
    let dropped = surface.report.reduce.outliers;
    assert!((60..=96).contains(&dropped), "{dropped}");
    assert_eq!(surface.cloud.report.outliers, dropped);
    assert_eq!(surface.report.reduce.input_points, n + 96);
    assert_eq!(
        (surface.report.components, &surface.report.genus[..]),
        (1, &[1][..])
    );
    let vertices = surface.positions_f64();
    assert!(points(&vertices).all(|p| Shape::Torus.distance(p).abs() < 0.1));
    let r = &surface.cloud.reduced;
    let assignment = r.assignment.as_ref().unwrap();
    assert!(r.nearest.iter().all(|&i| assignment[i as usize] != DROPPED));
    assert_eq!(
        assignment.iter().filter(|&&i| i == DROPPED).count(),
        dropped
    );

    // Too few are left to fit a surface to: all that are not dropped are taken.
    let all = run(Some(ReduceParams {
        target: Target::Count(10),
        ..params
    }));
    assert_eq!(all.cloud.reduced.cloud.len(), n + 96 - dropped);
    assert!(all.report.reduce.reason.contains("all were fitted"));
    assert_eq!(all.cloud.reduced.assignment.as_ref().unwrap().len(), n + 96);
    let kept = run(None);
    assert_eq!(kept.report.reduce.outliers, 0);
    assert_eq!(kept.cloud.reduced.cloud.len(), n + 96);
}

#[test]
fn a_few_far_points_cost_no_detail() {
    let scan = Shape::Torus.sample(9000, 1e-3, 5);
    let without = run(&Cloud::from_f64(&scan).unwrap(), &count(3000));
    for far in [1e1, 1e3, 1e5, 1e9, 1e14] {
        let mut positions = scan.clone();
        positions.extend([far, 0.0, 0.0, 0.0, -far, 0.3 * far, far, far, far]);
        let cloud = Cloud::from_f64(&positions).unwrap();
        let r = run(&cloud, &count(3000));
        assert_sound(&cloud, &r);
        let positions = r.cloud.positions_f64();
        let near: Vec<DVec3> = points(&positions).filter(|p| p.length() < 2.0).collect();
        assert_eq!(
            near.len(),
            3000 - 3,
            "{far}: each far point stands for itself"
        );
        for p in points(&positions).filter(|p| p.length() >= 2.0) {
            assert!(
                (p.abs().max_element() / far - 1.0).abs() < 1e-6,
                "{far}: {p}"
            );
        }
        let rms = |points: &[DVec3]| {
            let squares = points.iter().map(|p| Shape::Torus.distance(*p).powi(2));
            (squares.sum::<f64>() / points.len() as f64).sqrt()
        };
        let alone: Vec<DVec3> = points(&without.cloud.positions_f64()).collect();
        assert!(
            rms(&near) < 1.2 * rms(&alone),
            "{far}: {} {}",
            rms(&near),
            rms(&alone)
        );
    }
}

#[test]
fn the_figures_are_those_of_a_naive_computation() {
    for (method, m) in [
        (Method::Adaptive, 1.5),
        (Method::Adaptive, 2.0),
        (Method::Adaptive, 1.7),
        (Method::Paper, 2.0),
    ] {
        // Without noise nothing is moved, and raw centres stay where they are.
        let cloud = shape(Shape::Torus, 1500, 0.0);
        let params = ReduceParams {
            method,
            fuzzifier: Some(m),
            placement: Placement::Center,
            ..count(300)
        };
        let r = run(&cloud, &params);
        let points = Octree::build(&cloud.points).points;
        let away = |p: Vec3, i: usize| p.as_dvec3().distance_squared(r.cloud.points[i].as_dvec3());
        let (mut objective, mut others) = (0.0, 0);
        for (&p, shares) in points.iter().zip(&r.shares) {
            let mut nearest: Vec<usize> = (0..r.cloud.len()).collect();
            nearest.sort_by(|&i, &j| away(p, i).total_cmp(&away(p, j)));
            assert_eq!(shares.center[0] as usize, nearest[0], "{method:?} {m}");
            others += usize::from(shares.center.map(|i| i as usize) != nearest[..4]);
            // Eq. 5 over the centres that count.
            let d: Vec<f64> = shares.used().map(|(i, _)| away(p, i as usize)).collect();
            for ((i, u), &di) in shares.used().zip(&d) {
                let sum: f64 = d.iter().map(|dj| (di / dj).powf(1.0 / (m - 1.0))).sum();
                // A point at a centre belongs to it alone.
                let expected = if d[0] == 0.0 {
                    f64::from(u8::from(di == 0.0))
                } else {
                    1.0 / sum
                };
                assert!(
                    (f64::from(u) - expected).abs() < 1e-4,
                    "{method:?} {m}: {u} {expected}"
                );
                objective += f64::from(u).powf(m) * away(p, i as usize);
            }
        }
        assert!(
            others * 100 < points.len(),
            "{others} have other centres than their four nearest"
        );
        assert!((r.stats.objective / objective - 1.0).abs() < 1e-3);
        let apart: Vec<f64> = (0..r.cloud.len())
            .map(|i| {
                let others = (0..r.cloud.len()).filter(|&j| j != i);
                others
                    .map(|j| away(r.cloud.points[j], i))
                    .fold(f64::INFINITY, f64::min)
            })
            .collect();
        let separation = apart.iter().copied().fold(f64::INFINITY, f64::min);
        let validity = objective / (r.cloud.len() as f64 * separation);
        assert!(
            (r.stats.validity / validity - 1.0).abs() < 1e-3,
            "{} {validity}",
            r.stats.validity
        );
    }
}

#[test]
fn evenness_is_that_of_known_patterns() {
    // A regular grid is perfectly even; random points have Rayleigh distributed distances, √(4/π - 1) = 0.523.
    let side = 60;
    let grid: Vec<f64> = (0..side * side)
        .flat_map(|k| [(k % side) as f64, (k / side) as f64, 0.0])
        .collect();
    let mut rng = Rng::new(2);
    let random: Vec<f64> = (0..side * side)
        .flat_map(|_| [rng.uniform(), rng.uniform(), 0.0])
        .collect();
    let evenness = |positions: &[f64]| {
        let cloud = Cloud::from_f64(positions).unwrap();
        run(&cloud, &count(side * side)).stats.evenness
    };
    assert!(evenness(&grid) < 0.08, "{}", evenness(&grid));
    assert!(
        (evenness(&random) - 0.523).abs() < 0.06,
        "{}",
        evenness(&random)
    );
}

#[test]
fn open_borders_stay_where_they_are() {
    // A wavy square sheet as a depth camera would see it, noise included.
    let side = 120;
    let row = |count: usize| 4.0 * (count as f64).sqrt();
    for (noise, ratio) in [(0.0, 4), (0.0, 10), (1e-3, 4), (1e-3, 10)] {
        let mut rng = Rng::new(8);
        let positions: Vec<f64> = (0..side * side)
            .flat_map(|k| {
                let [x, y] = [k % side, k / side].map(|i| i as f64 / (side - 1) as f64 - 0.5);
                [x, y, 0.15 * (4.0 * x).sin() + noise * rng.normal()]
            })
            .collect();
        let cloud = Cloud::from_f64(&positions).unwrap();
        for placement in [Placement::Implicit, Placement::Mesh, Placement::Sample] {
            let r = run(
                &cloud,
                &ReduceParams {
                    placement,
                    ..count(side * side / ratio)
                },
            );
            assert_sound(&cloud, &r);
            let spacing = (1.0 / r.cloud.len() as f64).sqrt();
            let positions = r.cloud.positions_f64();
            // How far inside of the border, in spacings.
            let inside: Vec<f64> = points(&positions)
                .map(|p| (0.5 - p.x.abs().max(p.y.abs())) / spacing)
                .collect();
            let among = |range: std::ops::Range<f64>| {
                inside.iter().filter(|d| range.contains(d)).count() as f64
            };
            let row = row(r.cloud.len());
            let half = 0.5 / (ratio as f64).sqrt();
            let on = among(-half..0.25);
            assert!(
                on > 0.75 * row && among(0.25..0.5) < 0.12 * row,
                "{noise} {ratio} {placement:?}: {on} of {row}"
            );
            // None is farther out than half an input spacing.
            assert_eq!(among(-9.0..-half), 0.0);
        }
        // The paper's centres, and raw ones, are means.
        let raw = run(
            &cloud,
            &ReduceParams {
                placement: Placement::Center,
                ..count(side * side / ratio)
            },
        );
        let positions = raw.cloud.positions_f64();
        let on = points(&positions).filter(|p| {
            0.5 - p.x.abs().max(p.y.abs()) < 0.1 * (1.0 / raw.cloud.len() as f64).sqrt()
        });
        assert!((on.count() as f64) < 0.3 * row(raw.cloud.len()));
    }
}

/// Points of a model's true surface where a scan of it has seen any, in the scan's unit frame.
fn true_surface(model: Model, scan: &Cloud) -> Vec<Vec3> {
    let truth = sample_with_noise(model, 40_000, 77, 0.0).positions;
    let unit = |p: &[f32]| scan.frame.to_unit([p[0], p[1], p[2]].map(f64::from));
    let tree = Octree::build(&scan.points);
    let near = |p: &Vec3| tree.nearest(*p).distance2.sqrt() < 0.01;
    truth.chunks_exact(3).map(unit).filter(near).collect()
}

/// What 99 % of the true surface are within of the local surfaces that reduced points stand for.
fn covered_within(truth: &[Vec3], r: &Reduced) -> f64 {
    let normals = r.cloud.normals.as_deref().unwrap();
    let mut distances = distances_to(&r.cloud.points, normals, truth);
    distances.sort_unstable_by(f32::total_cmp);
    f64::from(distances[distances.len() * 99 / 100])
}

#[test]
fn a_tolerance_is_kept_with_hardly_more_points_than_needed() {
    for (model, noise, tolerance) in [
        (Model::Duck, 0.0, 3e-3),
        (Model::Duck, 0.0, 1e-3),
        (Model::Duck, NOISE, 1e-3),
        (Model::Pig, NOISE, 3e-3),
        (Model::Part, NOISE, 3e-3),
    ] {
        let cloud = Cloud::from_f32(&sample_with_noise(model, 36_000, 1, noise).positions).unwrap();
        let truth = true_surface(model, &cloud);
        let params = ReduceParams {
            target: Target::Tolerance(tolerance),
            ..Default::default()
        };
        let r = run(&cloud, &params);
        let within = covered_within(&truth, &r);
        assert!(within <= tolerance, "{model:?} {tolerance}: {within}");
        assert!(r.reason.is_empty(), "{}", r.reason);
        // With the best count that a search could find, 1.3 times fewer would still do.
        let fewer = run(&cloud, &count((r.cloud.len() as f64 / 1.3) as usize));
        let within = covered_within(&truth, &fewer);
        assert!(within > tolerance, "{model:?} {tolerance}: {within}");
    }
}

#[test]
fn the_papers_method_keeps_a_tolerance_too() {
    let cloud = shape(Shape::Torus, 8000, 0.0);
    let truth = shape(Shape::Torus, 30_000, 0.0);
    let reduced = |tolerance| {
        let params = ReduceParams {
            method: Method::Paper,
            target: Target::Tolerance(tolerance),
            ..Default::default()
        };
        run(&cloud, &params)
    };
    let (coarse, fine) = (reduced(4e-3), reduced(2e-3));
    assert!(coarse.cloud.len() < fine.cloud.len() && fine.cloud.len() < cloud.len() / 2);
    for (r, tolerance) in [(coarse, 4e-3), (fine, 2e-3)] {
        let within = covered_within(&truth.points, &r);
        assert!(within <= tolerance, "{tolerance}: {within}");
    }
}

#[test]
fn a_tolerance_finer_than_noise_allows_says_so_and_one_finer_than_the_scan_keeps_almost_all() {
    let run = |noise, tolerance| {
        let target = Target::Tolerance(tolerance);
        let params = ReduceParams {
            target,
            ..Default::default()
        };
        run(&shape(Shape::Torus, 6000, noise), &params)
    };
    let noisy = run(2e-3, 1e-5);
    assert!(noisy.reason.contains("noise"), "{}", noisy.reason);
    assert!(noisy.cloud.len() < 6000);
    let clean = run(0.0, 1e-9);
    // 99 % of the surface are promised.
    assert!(clean.cloud.len() > 5940 && clean.reason.is_empty());
}

#[test]
fn flatness_keeps_the_sharp_points_and_thins_the_flat_ones() {
    let cloud = shape(Shape::Box, 20_000, 0.0);
    for method in [Method::Paper, Method::Adaptive] {
        let target = Target::Flatness(3e-4);
        let r = run(
            &cloud,
            &ReduceParams {
                method,
                target,
                ..Default::default()
            },
        );
        assert!(
            r.stats.kept > 100 && r.stats.kept < 8000,
            "{}",
            r.stats.kept
        );
        let flat = (20_000 - r.stats.kept) as f64 / 3.0;
        assert!((r.cloud.len() as f64 - r.stats.kept as f64 - flat).abs() < 0.02 * flat);
        let unmoved = r
            .nearest
            .iter()
            .zip(&r.cloud.points)
            .filter(|&(&i, &p)| cloud.points[i as usize] == p);
        assert!(unmoved.count() >= r.stats.kept);
    }
}

#[test]
fn every_option_of_the_papers_method_keeps_the_count() {
    let cloud = shape(Shape::Torus, 1500, 1e-3);
    for norm in [Norm::Euclidean, Norm::Diagonal, Norm::Mahalanobis] {
        for clusters in [Clusters::Proportional, Clusters::Validity] {
            for fuzzifier in [1.5, 2.0, 2.7] {
                let params = ReduceParams {
                    method: Method::Paper,
                    norm,
                    clusters,
                    fuzzifier: Some(fuzzifier),
                    epsilon: Some(1e-2),
                    max_iterations: Some(30),
                    cell_points: Some(100),
                    ..count(400)
                };
                let r = run(&cloud, &params);
                assert_eq!(r.cloud.len(), 400);
                assert!(r.stats.iterations >= 1 && r.stats.iterations <= 30);
                assert!(r.stats.objective > 0.0 && r.stats.cells > 10);
            }
        }
    }
}

#[test]
fn the_seed_decides_the_papers_start_and_nothing_else_does() {
    let cloud = shape(Shape::Sphere, 1000, 0.0);
    let paper = |seed| {
        run(
            &cloud,
            &ReduceParams {
                method: Method::Paper,
                seed,
                ..count(300)
            },
        )
        .cloud
        .points
    };
    assert_eq!(paper(1), paper(1));
    assert_ne!(paper(1), paper(2));
    let adaptive = |seed| {
        run(&cloud, &ReduceParams { seed, ..count(300) })
            .cloud
            .points
    };
    assert_eq!(
        adaptive(1),
        adaptive(2),
        "the default starts without chance"
    );
}

#[test]
fn quotas_add_up_and_fit_into_their_cells() {
    let cells = [0..10, 10..11, 11..40, 40..100];
    for total in [1, 2, 10, 50, 99, 100] {
        for shares in [
            [1.0, 1.0, 1.0, 1.0],
            [0.0, 0.0, 0.0, 0.0],
            [100.0, 0.1, 0.0, 0.2],
        ] {
            let q = quotas(&shares, &cells, total);
            assert_eq!(q.iter().sum::<usize>(), total);
            assert!(q.iter().zip(&cells).all(|(q, c)| *q <= c.len()));
        }
    }
}

#[test]
fn a_listener_stops_it_at_any_stage() {
    let cloud = shape(Shape::Sphere, 5000, 0.0);
    let tree = Octree::build(&cloud.points);
    let features = Features::measure(&tree, &mut Silent).unwrap();
    for stage in [Stage::Cluster, Stage::Place] {
        for method in [Method::Adaptive, Method::Paper] {
            let params = ReduceParams {
                method,
                ..Default::default()
            };
            let stopped = reduce(
                &cloud,
                &tree,
                features.clone(),
                &params,
                &mut |s: Stage, _: f32| s != stage,
            );
            assert_eq!(stopped.err(), Some(Error::Cancelled));
        }
    }
    // While outliers are sought, and progress does not go back for them.
    let search = |s: Stage, f: f32| s != Stage::Features || !(0.41..0.59).contains(&f);
    let stopped = pipeline::reduce(&cloud, &without_outliers(), &mut { search });
    assert_eq!(stopped.err(), Some(Error::Cancelled));
    let mut positions = Shape::Sphere.sample(3000, 0.0, 5);
    positions.extend(strays(30));
    let mut before = (Stage::Octree, 0.0);
    let mut forward = |stage: Stage, fraction: f32| {
        let back = stage == before.0 && fraction < before.1;
        before = (stage, fraction);
        !back
    };
    let strewn = Cloud::from_f64(&positions).unwrap();
    let done = pipeline::reduce(&strewn, &without_outliers(), &mut forward).unwrap();
    assert!(done.report.outliers > 0);
    let bad = ReduceParams {
        fuzzifier: Some(1.0),
        ..Default::default()
    };
    let refused = reduce(&cloud, &tree, features, &bad, &mut Silent)
        .err()
        .unwrap();
    assert_eq!(refused.code(), "bad-option");
}
