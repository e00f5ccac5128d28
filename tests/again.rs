//! What is remembered from one reconstruction to the next changes how much is done, never what comes out.

use pointweave::base::params::{Boundary, Outliers, Target};
use pointweave::base::progress::Silent;
use pointweave::pipeline::{Memory, reconstruct_again};
use pointweave::samples::{Model, sample};
use pointweave::{Cloud, ReduceParams, Stage, Surface, SurfaceParams, reconstruct};

fn scan(model: Model, seed: u64) -> Cloud {
    Cloud::from_f32(&sample(model, 4000, seed).positions).expect("a cloud")
}

/// Reconstructs with and without the memory, and says which stages the memory did not save.
fn again(cloud: &Cloud, params: &SurfaceParams, memory: &mut Memory) -> Vec<Stage> {
    let fresh = reconstruct(cloud, params, &mut Silent).expect("a surface");
    let made = reconstruct_again(cloud.clone(), params, memory, &mut Silent).expect("a surface");
    let bytes = |s: &Surface| {
        (
            s.mesh.vertices.clone(),
            s.mesh.triangles.clone(),
            s.cloud.reduced.cloud.clone(),
            s.cloud.reduced.nearest.clone(),
            s.report.reduce.distance,
        )
    };
    assert!(bytes(&made) == bytes(&fresh), "{params:?}");
    made.report
        .reduce
        .ms
        .iter()
        .map(|(stage, _)| stage)
        .collect()
}

#[test]
fn only_what_changed_is_done_again() {
    let duck = scan(Model::Duck, 1);
    let mut memory = Memory::default();
    let rounded = SurfaceParams {
        sharp: false,
        boundary: Boundary::Open,
        ..Default::default()
    };
    let sparse = SurfaceParams {
        reduce: Some(ReduceParams {
            target: Target::Count(700),
            ..Default::default()
        }),
        ..Default::default()
    };
    let unreduced = SurfaceParams {
        reduce: None,
        ..Default::default()
    };
    let first = again(&duck, &SurfaceParams::default(), &mut memory);
    assert!(first.contains(&Stage::Features) && first.contains(&Stage::Cluster));
    let other_surface = again(&duck, &rounded, &mut memory);
    assert!(!other_surface.contains(&Stage::Features) && !other_surface.contains(&Stage::Cluster));
    for other_points in [&sparse, &unreduced, &sparse] {
        let stages = again(&duck, other_points, &mut memory);
        assert!(!stages.contains(&Stage::Features) && stages.contains(&Stage::Place));
    }
}

#[test]
fn another_cloud_is_measured_anew() {
    let params = SurfaceParams::default();
    let mut memory = Memory::default();
    let duck = scan(Model::Duck, 1);
    again(&duck, &params, &mut memory);
    let mut moved = duck.clone();
    moved.frame.center[0] += 1.0;
    let mut named = duck.clone();
    named.origin = Some([1.0, 2.0, 3.0]);
    let mut turned = duck.clone();
    turned.points.swap(10, 20);
    let strays_dropped = SurfaceParams {
        reduce: Some(ReduceParams {
            outliers: Outliers::Drop,
            ..Default::default()
        }),
        ..Default::default()
    };
    for (cloud, params) in [
        (&scan(Model::Duck, 2), &params),
        (&scan(Model::Part, 1), &params),
        (&duck, &params),
        (&moved, &params),
        (&named, &params),
        (&turned, &params),
        (&duck, &strays_dropped),
        (&duck, &params),
    ] {
        assert!(again(cloud, params, &mut memory).contains(&Stage::Features));
    }
}

#[test]
fn a_job_that_is_stopped_loses_nothing_of_what_was_done_before() {
    let duck = scan(Model::Duck, 1);
    let params = SurfaceParams::default();
    let sparse = SurfaceParams {
        reduce: Some(ReduceParams {
            target: Target::Count(700),
            ..Default::default()
        }),
        ..Default::default()
    };
    let mut memory = Memory::default();
    let stop = |params: &SurfaceParams, at: Stage, memory: &mut Memory| {
        let mut until = |stage: Stage, _: f32| stage != at;
        let stopped = reconstruct_again(duck.clone(), params, memory, &mut until);
        assert!(matches!(stopped, Err(pointweave::Error::Cancelled)));
    };
    // Of a new cloud what was measured before the stop.
    stop(&params, Stage::Fit, &mut memory);
    let stages = again(&duck, &params, &mut memory);
    assert!(!stages.contains(&Stage::Features) && !stages.contains(&Stage::Cluster));
    // Of one that was made before the reduction, too, whatever the stopped job asked for.
    for at in [Stage::Cluster, Stage::Place] {
        stop(&sparse, at, &mut memory);
        let stages = again(&duck, &params, &mut memory);
        assert!(!stages.contains(&Stage::Features) && !stages.contains(&Stage::Cluster));
    }
    stop(&sparse, Stage::Extract, &mut memory);
    let stages = again(&duck, &sparse, &mut memory);
    assert!(!stages.contains(&Stage::Features) && !stages.contains(&Stage::Place));
}
