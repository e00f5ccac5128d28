//! Which side is out, on scans whose outer side is known, and how the result says that it knows.

mod common;

use common::scenes::{Recipe, Scene, Sure, Told, all};
use glam::{DQuat, DVec3};
use pointweave::base::params::{Orientation, Target};
use pointweave::base::progress::Silent;
use pointweave::base::rng::Rng;
use pointweave::cloud::Viewpoints;
use pointweave::report::Source;
use pointweave::samples::{Model, sample, sample_with_noise};
use pointweave::{Cloud, ReduceParams, Surface, SurfaceParams, reconstruct, reduce};
use std::sync::Arc;

/// Every kind is made this often.
const SEEDS: u64 = 8;

/// Every scene of some kinds keeps what its [`Sure`] promises.
fn all_are_right(kinds: &[&str]) {
    let recipes: Vec<Recipe> = all()
        .into_iter()
        .filter(|r| kinds.contains(&r.kind))
        .collect();
    let mut wrong = Vec::new();
    for recipe in &recipes {
        for seed in 0..SEEDS {
            let scene = recipe.scene(seed);
            let surface = scene.surface(&SurfaceParams::default());
            let right = scene.right(&surface);
            let codes = codes(&surface);
            let is_kept = match scene.sure {
                Sure::Closed => right >= 0.999 && codes.is_empty(),
                Sure::Told => right >= 0.99,
                Sure::Guess => right.max(1.0 - right) >= 0.999 && !codes.is_empty(),
            };
            if !is_kept {
                wrong.push(format!("{} {seed}: {right:.4} {codes:?}", recipe.name));
            }
        }
    }
    assert!(!recipes.is_empty() && wrong.is_empty(), "{wrong:#?}");
}

fn codes(surface: &Surface) -> Vec<&'static str> {
    let doubts = surface.report.reduce.doubts.iter();
    doubts.map(|d| d.code).collect()
}

#[test]
fn there_are_sixty_scenes_of_twelve_kinds() {
    let mut kinds: Vec<&str> = all().iter().map(|r| r.kind).collect();
    assert!(kinds.len() >= 60, "{}", kinds.len());
    kinds.sort_unstable();
    kinds.dedup();
    assert!(kinds.len() >= 12, "{kinds:?}");
}

#[test]
fn terrain_and_towns_look_up() {
    all_are_right(&["terrain", "town"]);
}

#[test]
fn rooms_look_in_where_a_pose_says_so_and_out_where_nothing_does() {
    all_are_right(&["room with a pose", "room without a pose"]);
}

#[test]
fn what_was_seen_looks_to_where_it_was_seen_from() {
    all_are_right(&["several setups", "depth frame"]);
}

#[test]
fn half_objects_bowls_and_vases_look_out() {
    all_are_right(&["half object", "bowl or vase", "on a table"]);
}

#[test]
fn sheets_have_one_side_and_bodies_their_outer_one() {
    all_are_right(&["leaf or wall", "nested or separate", "closed object"]);
}

#[test]
fn raw_scans_with_holes_look_out() {
    all_are_right(&["raw scan"]);
}

fn recipe(name: &str) -> Recipe {
    let found = all().into_iter().find(|r| r.name == name);
    found.unwrap_or_else(|| panic!("no scene {name}"))
}

/// The scene as it is with its points moved.
fn moved(scene: &Scene, turn: DQuat) -> Scene {
    let vectors = |v: &[DVec3]| v.iter().map(|&v| turn * v).collect::<Vec<DVec3>>();
    let inverse = turn.inverse();
    let before = scene.truth.clone();
    Scene {
        points: vectors(&scene.points),
        told: Told {
            normals: scene.told.normals.as_deref().map(vectors),
            viewpoints: vectors(&scene.told.viewpoints),
            of: scene.told.of.clone(),
            // Up turns along, so that the guess for sheets stays the same.
            up: Some(turn * scene.told.up.unwrap_or(DVec3::Z)),
            above: scene.told.above,
        },
        sure: scene.sure,
        truth: Arc::new(move |p, n| before(inverse * p, inverse * n)),
    }
}

#[test]
fn turning_a_cloud_or_leaving_points_out_changes_nothing() {
    for name in ["statue, nothing known", "town", "vase on a disc"] {
        let scene = recipe(name).scene(1);
        let right = |scene: &Scene| scene.right(&scene.surface(&SurfaceParams::default()));
        let mut shares = vec![right(&scene)];
        let mut rng = Rng::new(5);
        for _ in 0..8 {
            let mut axis = || rng.normal();
            let (x, y, z, w) = (axis(), axis(), axis(), axis());
            shares.push(right(&moved(
                &scene,
                DQuat::from_xyzw(x, y, z, w).normalize(),
            )));
        }
        let mut fewer = moved(&scene, DQuat::IDENTITY);
        for _ in 0..6 {
            fewer
                .points
                .swap_remove((rng.next_u64() % fewer.points.len() as u64) as usize);
        }
        shares.push(right(&fewer));
        let least = shares.iter().copied().fold(1.0, f64::min);
        let most = shares.iter().copied().fold(0.0, f64::max);
        assert!(most - least <= 0.002, "{name}: {shares:.4?}");
    }
}

#[test]
fn orientation_names_what_decides() {
    let room = recipe("closed room").scene(0);
    let run = |orientation, flip| {
        let params = SurfaceParams {
            orientation,
            flip,
            ..SurfaceParams::default()
        };
        room.right(&room.surface(&params))
    };
    for (orientation, inward) in [
        (Orientation::Auto, true),
        (Orientation::Viewpoints, true),
        (Orientation::Inward, true),
        (Orientation::Outward, false),
    ] {
        for flip in [false, true] {
            let right = run(orientation, flip);
            let wanted = if inward != flip { right } else { 1.0 - right };
            assert!(wanted > 0.99, "{orientation:?} {flip}: {right}");
        }
    }
    let hills = recipe("hills seen from below, with normals").scene(0);
    let run = |orientation| {
        let params = SurfaceParams {
            orientation,
            ..SurfaceParams::default()
        };
        hills.right(&hills.surface(&params))
    };
    assert!(run(Orientation::Normals) > 0.99);
    assert!(run(Orientation::Up) < 0.01);
}

#[test]
fn evidence_that_is_not_there_is_an_error() {
    let scene = recipe("ball").scene(0);
    for (orientation, lacks) in [
        (Orientation::Normals, "a cloud with normals"),
        (Orientation::Viewpoints, "a cloud with viewpoints"),
    ] {
        let params = SurfaceParams {
            orientation,
            ..SurfaceParams::default()
        };
        let error = reconstruct(&scene.cloud(), &params, &mut Silent).unwrap_err();
        assert_eq!(error.code(), "bad-option");
        assert_eq!(error.expected().as_deref(), Some(lacks));
    }
}

#[test]
fn the_report_says_what_decided() {
    let decided = |name: &str| {
        let surface = recipe(name).scene(0).surface(&SurfaceParams::default());
        let orientation = &surface.report.orientation;
        let sum: f64 = orientation.sources.iter().map(|s| s.share).sum();
        assert!((sum - 1.0).abs() < 1e-5, "{name}: {sum}");
        let most = orientation.sources.iter().copied();
        let most = most.reduce(|a, b| if b.share > a.share { b } else { a });
        (most.expect("a source").source, codes(&surface))
    };
    for (name, source, doubts) in [
        ("ball", Source::Shell, vec![]),
        ("hills from above", Source::Above, vec![]),
        ("hills with up", Source::Up, vec![]),
        ("hills with normals", Source::Normals, vec![]),
        ("street", Source::Viewpoints, vec![]),
        ("wall and balls", Source::Camera, vec![]),
        ("leaf", Source::Guess, vec!["side-guessed"]),
        (
            "statue with random normals",
            Source::Shell,
            vec!["sources-disagree"],
        ),
    ] {
        assert_eq!(decided(name), (source, doubts), "{name}");
    }
}

#[test]
fn what_is_known_stays_with_the_points() {
    let positions: Vec<f64> = (0..300).map(|i| f64::from(i * i % 97)).collect();
    let of: Vec<u32> = (0..100)
        .map(|i| if i == 7 { Viewpoints::UNKNOWN } else { i % 2 })
        .collect();
    let eyes = [0.0, 0.0, 9.0, 1.0, 2.0, 3.0];
    let cloud = Cloud::from_f64(&positions)
        .and_then(|c| c.with_viewpoints(&eyes, Some(&of)))
        .and_then(|c| c.with_up([0.0, 2.0, 0.0]))
        .expect("a cloud")
        .with_seen_from_above(true);
    let some = cloud.select(&[7, 8, 9]).expect("a cloud");
    let seen = some.viewpoints.as_ref().expect("viewpoints");
    assert_eq!(seen.of.as_deref(), Some(&[Viewpoints::UNKNOWN, 0, 1][..]));
    assert_eq!(
        (seen.seeing(0), seen.seeing(2)),
        (None, Some(DVec3::new(1.0, 2.0, 3.0)))
    );
    assert_eq!((some.up, some.seen_from_above), (Some(glam::Vec3::Y), true));
    let reduced = reduce(&cloud, &ReduceParams::default(), &mut Silent).expect("reduced");
    let reduced = reduced.reduced;
    let seen = reduced.cloud.viewpoints.as_ref().expect("viewpoints");
    for (i, &nearest) in reduced.nearest.iter().enumerate() {
        assert_eq!(
            seen.of.as_ref().map(|seen| seen[i]),
            Some(of[nearest as usize])
        );
    }
    assert_eq!(
        (reduced.cloud.up, reduced.cloud.seen_from_above),
        (Some(glam::Vec3::Y), true)
    );
}

#[test]
fn viewpoints_and_up_are_checked() {
    let cloud = || Cloud::from_f64(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]).expect("a cloud");
    let code = |result: pointweave::Result<Cloud>| result.unwrap_err().code();
    assert_eq!(code(cloud().with_viewpoints(&[], None)), "bad-length");
    assert_eq!(
        code(cloud().with_viewpoints(&[0.0, 1.0], None)),
        "bad-length"
    );
    assert_eq!(
        code(cloud().with_viewpoints(&[0.0, f64::NAN, 0.0], None)),
        "non-finite"
    );
    assert_eq!(
        code(cloud().with_viewpoints(&[0.0; 3], Some(&[0]))),
        "bad-length"
    );
    assert_eq!(
        code(cloud().with_viewpoints(&[0.0; 3], Some(&[0, 1]))),
        "bad-option"
    );
    assert_eq!(code(cloud().with_up([0.0; 3])), "bad-option");
    assert_eq!(
        code(cloud().with_up([0.0, f64::INFINITY, 0.0])),
        "bad-option"
    );
}

#[test]
fn scans_of_closed_objects_are_not_doubted() {
    let sizes = [(1_500, 1.0), (3_000, 0.2), (10_000, 0.3), (36_000, 0.1)];
    let mut doubted = Vec::new();
    for model in Model::ALL {
        for (count, ratio) in sizes {
            let scan = sample(model, count, 1);
            let cloud = Cloud::from_f32(&scan.positions).unwrap();
            let params = SurfaceParams {
                reduce: Some(ReduceParams {
                    target: Target::Ratio(ratio),
                    ..ReduceParams::default()
                }),
                ..SurfaceParams::default()
            };
            let surface = reconstruct(&cloud, &params, &mut Silent).unwrap();
            if !surface.report.reduce.doubts.is_empty() {
                doubted.push((model, count, surface.report.reduce.doubts));
            }
        }
    }
    assert!(doubted.is_empty(), "{doubted:#?}");
}

#[test]
fn few_points_on_thin_walls_agree() {
    let scan = sample_with_noise(Model::Part, 36_000, 1, 0.0);
    let cloud = Cloud::from_f32(&scan.positions).unwrap();
    let params = SurfaceParams {
        reduce: Some(ReduceParams {
            target: Target::Ratio(0.05),
            ..ReduceParams::default()
        }),
        ..SurfaceParams::default()
    };
    let surface = reconstruct(&cloud, &params, &mut Silent).unwrap();
    // Walls turned one by one have -0.81.
    assert!(surface.report.orientation_energy < -0.97);
}
