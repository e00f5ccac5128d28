//! Recipes, on scans of which it is known what every point was taken from.

#[path = "common/staged.rs"]
mod staged;
#[path = "common/views.rs"]
mod views;

use glam::DVec3;
use pointweave::base::params::{Boundary, SurfaceParams};
use pointweave::base::progress::Silent;
use pointweave::mesh::topology::volume;
use pointweave::pipeline::{Prepared, prepare, prepare_scans};
use pointweave::prepare::planes::Drop;
use pointweave::prepare::recipe::Step;
use pointweave::prepare::regions::Region;
use pointweave::prepare::register::{Placed, register};
use pointweave::samples::{Model, sample};
use pointweave::{Cloud, Error, Stage as Part, reconstruct};
use staged::{Body, Scan, Stage, Staged, largest, plane, tidy};
use views::{View, Views, errors};

fn cloud_of(scan: &Scan) -> Cloud {
    Cloud::from_f64(&scan.positions()).unwrap()
}

/// Shares of the object's points that are kept and of the others that are dropped, without strays that touch the object.
fn shares(scan: &Scan, prepared: &Prepared) -> (f64, f64) {
    let touches = |i: usize| {
        scan.bodies[i] == Body::Stray && scan.model.distance(scan.points[i]) < 0.01 * scan.diagonal
    };
    let share = |of_object: bool| {
        let is_one = |&i: &usize| (scan.bodies[i] == Body::Object) == of_object && !touches(i);
        let those: Vec<usize> = (0..scan.points.len()).filter(is_one).collect();
        let right = those
            .iter()
            .filter(|&&i| (prepared.dropped_by[i] == 0) == of_object);
        right.count() as f64 / those.len() as f64
    };
    (share(true), share(false))
}

#[test]
fn objects_on_tables_and_in_rooms_are_left_alone() {
    for (model, stage, second) in [
        (Model::Duck, Stage::Room, Some(Model::Part)),
        (Model::Pig, Stage::Table, Some(Model::Part)),
        (Model::Part, Stage::Table, None),
    ] {
        let scan = Staged {
            model,
            stage,
            second,
            strays: true,
            points: 25_000,
            noise: 5e-4,
            seed: 1,
        }
        .scan();
        let prepared = prepare(&cloud_of(&scan), &tidy(), &mut Silent).unwrap();
        let (kept, dropped) = shares(&scan, &prepared);
        let name = format!("{} {stage:?} {second:?}: {kept} {dropped}", model.name());
        assert!(kept >= 0.99 && dropped >= 0.985, "{name}");
    }
}

#[test]
fn a_floor_is_the_plane_that_things_stand_on_and_an_objects_face_is_none() {
    let scan = Staged {
        model: Model::Part,
        stage: Stage::Room,
        second: None,
        strays: false,
        points: 16_000,
        noise: 5e-4,
        seed: 3,
    }
    .scan();
    let cloud = cloud_of(&scan);
    let looked = prepare(&cloud, &[plane(Drop::None)], &mut Silent).unwrap();
    assert_eq!(looked.kept.len(), cloud.len());
    let planes = looked.steps[0].planes.as_ref().unwrap();
    let floor = planes.iter().find(|plane| plane.floor).unwrap();
    assert!(floor.normal[1] > 0.9999 && (floor.point[1] - scan.ground).abs() < 0.01);
    assert!(floor.carries && !floor.dropped);
    // Two walls, seen from within.
    let walls = planes
        .iter()
        .filter(|plane| plane.carries && plane.normal[1].abs() < 0.01);
    assert_eq!(walls.count(), 2);
    // The floor alone goes, and the numbers of the report name the same planes.
    let number = planes.iter().position(|plane| plane.floor).unwrap() as u32;
    let floor = prepare(&cloud, &[plane(Drop::Floor)], &mut Silent).unwrap();
    let named = prepare(&cloud, &[plane(Drop::Numbers(vec![number]))], &mut Silent).unwrap();
    assert_eq!(floor.kept, named.kept);
    let labels = looked.steps[0].labels.as_ref().unwrap();
    let own = labels.iter().filter(|&&label| label == number).count();
    assert_eq!(
        own,
        looked.steps[0].planes.as_ref().unwrap()[number as usize].points
    );
    // A disc of 1.1 diagonals less what the part hides, and far from its frame's origin the same.
    let own = &planes[number as usize];
    let disc = std::f64::consts::PI * (1.1 * scan.diagonal).powi(2);
    assert!(
        (0.6..1.2).contains(&(own.area / disc)),
        "{}",
        own.area / disc
    );
    let away = [500_000.0, 20.0, 4e6];
    let map: Vec<f64> = scan
        .positions()
        .iter()
        .enumerate()
        .map(|(k, x)| x + away[k % 3])
        .collect();
    let far = prepare(
        &Cloud::from_f64(&map).unwrap(),
        &[plane(Drop::Floor)],
        &mut Silent,
    )
    .unwrap();
    let other = far.steps[0].dropped.abs_diff(floor.steps[0].dropped);
    assert!(other <= cloud.len() / 1000, "{other}");
    // What is clean already has no floor: the part's faces are its own.
    let clean = sample(Model::Part, 20_000, 4);
    let clean = Cloud::from_f32(&clean.positions).unwrap();
    let kept = prepare(&clean, &[plane(Drop::All)], &mut Silent).unwrap();
    assert_eq!(kept.kept.len(), clean.len());
    assert!(kept.steps[0].reason.contains("no plane"));
    assert!(!kept.steps[0].planes.as_ref().unwrap().is_empty());
}

#[test]
fn an_object_whose_floor_was_dropped_gets_a_flat_base_there() {
    let mut params = SurfaceParams::default();
    for model in [Model::Duck, Model::Pig, Model::Part] {
        let scan = Staged {
            model,
            stage: Stage::Table,
            second: None,
            strays: true,
            points: 25_000,
            noise: 5e-4,
            seed: 2,
        }
        .scan();
        let cloud = cloud_of(&scan);
        let prepared = prepare(&cloud, &tidy(), &mut Silent).unwrap();
        let floor = prepared.floor.unwrap();
        let noise = 5e-4 * scan.diagonal;
        assert!(floor.normal.y > 0.9999 && (floor.point[1] - scan.ground).abs() < noise);
        let object = cloud.select(&prepared.kept).unwrap().with_floor(floor);
        params.boundary = Boundary::Base;
        let based = reconstruct(&object, &params, &mut Silent).unwrap();
        let found = &based.report;
        let positions = based.positions_f64();
        let over = |y: f64| (y - floor.point[1]) / scan.diagonal;
        let heights = positions.chunks(3).map(|p| over(p[1]));
        let lowest = heights.clone().fold(f64::INFINITY, f64::min);
        let on_it = heights.filter(|h| h.abs() < 1e-4).count();
        let name = format!("{}: {lowest} {on_it} {found:?}", model.name());
        assert_eq!((found.boundary_edges, found.non_manifold_edges), (0, 0));
        assert!(
            found.components == 1 && lowest.abs() < 1e-4 && on_it > 200,
            "{name}"
        );
        params.boundary = Boundary::Closed;
        let closed = reconstruct(&object, &params, &mut Silent).unwrap();
        let [base, membrane] = [&based, &closed].map(|s| {
            let inside = volume(&s.mesh.vertices, &s.mesh.triangles);
            inside * object.frame.diagonal.powi(3) / truth(model) - 1.0
        });
        assert!(
            base.abs() < 0.08 && base.abs() < membrane.abs(),
            "{base} {membrane}"
        );
    }
}

/// Volume of a model, by a grid.
fn truth(model: Model) -> f64 {
    let (low, high) = model.bounds();
    let n = 80;
    let step = (high - low) / f64::from(n);
    let middle = |i: i32| f64::from(i) + 0.5;
    let inside = (0..n * n * n).filter(|i| {
        let at = DVec3::new(middle(i % n), middle(i / n % n), middle(i / n / n));
        model.distance(low + at * step) < 0.0
    });
    inside.count() as f64 * step.x * step.y * step.z
}

#[test]
fn steps_go_in_order_and_say_what_they_did() {
    let duck = sample(Model::Duck, 6000, 1);
    let cloud = Cloud::from_f32(&duck.positions).unwrap();
    let inside = Region::cuboid([-100.0, 0.0, -100.0], [100.0, 100.0, 100.0], None).unwrap();
    let ball = Region::sphere([0.0, 8.0, 0.0], 3.0).unwrap();
    let steps = [
        Step::Region {
            region: inside,
            keep: true,
        },
        Step::Region {
            region: ball,
            keep: false,
        },
        Step::Outliers,
        largest(),
    ];
    let prepared = prepare(&cloud, &steps, &mut Silent).unwrap();
    let positions = cloud.positions_f64();
    for (i, p) in positions.chunks_exact(3).enumerate() {
        let far = p[0] * p[0] + (p[1] - 8.0) * (p[1] - 8.0) + p[2] * p[2];
        let expected = if p[1] < 0.0 {
            1
        } else if far <= 9.0 {
            2
        } else {
            0
        };
        let found = prepared.dropped_by[i];
        assert!(
            found == expected || (expected == 0 && found > 2),
            "point {i}: {found}"
        );
    }
    let kept: Vec<u32> = (0..cloud.len() as u32)
        .filter(|&i| prepared.dropped_by[i as usize] == 0)
        .collect();
    assert_eq!(kept, prepared.kept);
    let names: Vec<&str> = prepared.steps.iter().map(|step| step.step).collect();
    assert_eq!(names, ["box", "sphere", "outliers", "pieces"]);
    let mut left = cloud.len();
    for step in &prepared.steps {
        assert_eq!(step.kept + step.dropped, left);
        left = step.kept;
    }
    assert_eq!(cloud.select(&prepared.kept).unwrap().len(), left);
    // Pieces of a scan are those of what is left.
    let pieces = prepared.steps[3].pieces.as_ref().unwrap();
    assert!(pieces[0].min[1] >= -1e-5 && pieces[0].kept);
}

#[test]
fn a_step_that_leaves_nothing_is_an_error_and_a_recipe_can_be_stopped() {
    let duck = sample(Model::Duck, 3000, 1);
    let cloud = Cloud::from_f32(&duck.positions).unwrap();
    let far = Region::sphere([1e3, 0.0, 0.0], 1.0).unwrap();
    let nothing = [
        Step::Outliers,
        Step::Region {
            region: far,
            keep: true,
        },
    ];
    match prepare(&cloud, &nothing, &mut Silent) {
        Err(Error::BadOption { option, .. }) => assert_eq!(option, "prepare[1]"),
        other => panic!("{other:?}"),
    }
    for step in [Step::Outliers, Step::Flying, plane(Drop::All), largest()] {
        let mut stop = |stage: Part, _: f32| stage != Part::Prepare;
        let stopped = prepare(&cloud, &[step], &mut stop);
        assert_eq!(stopped.unwrap_err(), Error::Cancelled);
    }
}

#[test]
fn the_same_scan_has_the_same_labels_in_any_order() {
    let scan = Staged {
        model: Model::Duck,
        stage: Stage::Table,
        second: None,
        strays: true,
        points: 8000,
        noise: 5e-4,
        seed: 2,
    }
    .scan();
    let positions = scan.positions();
    let once = prepare(&cloud_of(&scan), &tidy(), &mut Silent).unwrap();
    let again = prepare(&cloud_of(&scan), &tidy(), &mut Silent).unwrap();
    assert_eq!(once.dropped_by, again.dropped_by);
    let turned: Vec<f64> = positions.chunks_exact(3).rev().flatten().copied().collect();
    let back = prepare(&Cloud::from_f64(&turned).unwrap(), &tidy(), &mut Silent).unwrap();
    let same = once.dropped_by.iter().zip(back.dropped_by.iter().rev());
    let other = same.filter(|(a, b)| a != b).count();
    assert!(other <= 3, "{other} of {}", scan.points.len());
}

const PIG: Views = Views {
    model: Model::Pig,
    points: 9000,
    noise: 5e-4,
    turn: 50.0,
    seed: 1,
};

#[test]
fn views_in_frames_of_their_own_are_put_together_and_another_thing_is_left_out() {
    let mut views = PIG.first(4);
    let part = Views {
        model: Model::Part,
        ..PIG
    };
    views.extend(part.first(1));
    let truth: Vec<_> = views.iter().map(|view| view.truth).collect();
    let clouds: Vec<Cloud> = views.into_iter().map(|view| view.cloud).collect();
    let found = register(&clouds, &mut Silent).unwrap();
    let (low, high) = Model::Pig.bounds();
    let poses: Vec<_> = found.scans.iter().map(|scan| scan.pose).collect();
    let errors = errors(&clouds[..4], &truth[..4], &poses[..4], low.distance(high));
    for error in &errors {
        assert!(error.is_some_and(|error| error < 2e-3), "{errors:?}");
    }
    assert_eq!(
        poses[0].unwrap(),
        pointweave::prepare::register::Pose::IDENTITY
    );
    let Placed { pose, reason, .. } = &found.scans[4];
    assert!(
        pose.is_none() && reason.contains("another scan"),
        "{reason}"
    );
    let next = found
        .pairs
        .iter()
        .find(|pair| pair.scans == [0, 1])
        .unwrap();
    assert!(
        next.trusted && next.overlap > 0.3 && next.rms < 0.05,
        "{next:?}"
    );
    // The lights of the views were 1, 0.92, 0.84 and 1.
    let gain = |k: usize| found.scans[k].gain.unwrap()[0];
    assert!(
        (gain(1) / gain(0) - 1.0 / 0.92).abs() < 0.02,
        "{} {}",
        gain(0),
        gain(1)
    );
    assert!((gain(3) / gain(0) - 1.0).abs() < 0.02);

    // As a recipe: the part goes, and what is told of points is told of those that were given.
    let steps = [Step::Register, Step::Outliers, largest()];
    let prepared = prepare_scans(&clouds, &steps, &mut Silent).unwrap();
    let before: usize = clouds[..4].iter().map(Cloud::len).sum();
    assert_eq!(prepared.dropped_by.len(), before + clouds[4].len());
    assert!(prepared.dropped_by[before..].iter().all(|&by| by == 1));
    let kept = prepared.dropped_by[..before].iter().filter(|&&by| by == 0);
    assert!(kept.count() > before * 98 / 100);
    let report = &prepared.steps[0];
    let scans = report.scans.as_ref().unwrap();
    assert_eq!((report.kept, report.dropped), (before, clouds[4].len()));
    assert!(scans[3].placed && !scans[4].placed && report.reason.contains("1 scan"));
    // 16 numbers by columns take a point of the last view to where it is in the first's frame.
    let p = DVec3::from_slice(&clouds[3].positions_f64()[..3]);
    let m = scans[3].pose.unwrap();
    let at = [0, 1, 2].map(|a| m[a] * p.x + m[4 + a] * p.y + m[8 + a] * p.z + m[12 + a]);
    assert!(poses[3].unwrap().at(p).distance(DVec3::from_array(at)) < 1e-9);
}

#[test]
fn scans_of_one_frame_stay_where_they_are_and_register_comes_first() {
    let placed = |view: &View| {
        let positions = view.cloud.positions_f64();
        let each = positions.chunks_exact(3);
        let at = each.flat_map(|p| view.truth.at(DVec3::from_slice(p)).to_array());
        Cloud::from_f64(&at.collect::<Vec<f64>>()).unwrap()
    };
    let clouds: Vec<Cloud> = PIG.first(2).iter().map(placed).collect();
    let found = register(&clouds, &mut Silent).unwrap();
    for scan in &found.scans {
        let pose = scan.pose.unwrap();
        for p in [DVec3::ZERO, DVec3::X * 9.0, DVec3::Y * 6.0] {
            assert!(pose.at(p).distance(p) < 0.06, "{pose:?}");
        }
    }
    let alone = prepare(&clouds[0], &[Step::Register], &mut Silent).unwrap();
    assert!(alone.kept.len() == clouds[0].len() && alone.steps[0].reason.contains("one scan"));
    match prepare_scans(&clouds, &[Step::Outliers, Step::Register], &mut Silent) {
        Err(Error::BadOption { option, .. }) => assert_eq!(option, "prepare[1].step"),
        other => panic!("{other:?}"),
    }
    let joined = prepare_scans(&clouds, &[], &mut Silent).unwrap();
    assert_eq!(joined.kept.len(), clouds[0].len() + clouds[1].len());
    let mut stop = |stage: Part, fraction: f32| stage != Part::Prepare || fraction < 0.1;
    let stopped = prepare_scans(&clouds, &[Step::Register], &mut stop);
    assert_eq!(stopped.unwrap_err(), Error::Cancelled);
}
