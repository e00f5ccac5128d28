//! The pool of the wasm-threads build, in the browsers themselves.
#![cfg(all(target_arch = "wasm32", feature = "threads"))]

mod threads;

use pointweave::base::params::SurfaceParams;
use pointweave::base::progress::Silent;
use pointweave::{Cloud, par, pipeline};
use std::collections::BTreeSet;
use wasm_bindgen_test::wasm_bindgen_test;

wasm_bindgen_test::wasm_bindgen_test_configure!(run_in_dedicated_worker);

#[wasm_bindgen_test]
async fn the_pool_works() {
    threads::start(2).await;
    assert_eq!(par::threads(), 2);
    results_keep_their_order_and_both_workers_share();
    a_sphere_becomes_a_closed_surface();
}

fn results_keep_their_order_and_both_workers_share() {
    let slow_square = |i: usize, (): &mut ()| {
        let root = (0..10_000).fold(i as f64, |x, _| (x * x + 1.0).sqrt());
        assert!(root > 0.0);
        (i * i, rayon::current_thread_index())
    };
    let results = par::map(2_000, || (), slow_square);
    assert!(
        results
            .iter()
            .enumerate()
            .all(|(i, (square, _))| *square == i * i)
    );

    let workers: BTreeSet<_> = results.iter().map(|(_, worker)| *worker).collect();
    assert_eq!(workers, BTreeSet::from([Some(0), Some(1)]));
}

fn a_sphere_becomes_a_closed_surface() {
    let golden_angle = 2.399_963;
    let point = |i: usize| {
        let z = 1.0 - (2 * i + 1) as f64 / 3_000.0;
        let (radius, angle) = ((1.0 - z * z).sqrt(), golden_angle * i as f64);
        [radius * libm::cos(angle), radius * libm::sin(angle), z]
    };
    let positions: Vec<f64> = (0..3_000).flat_map(point).collect();
    let cloud = Cloud::from_f64(&positions).unwrap();
    let surface = pipeline::reconstruct(&cloud, &SurfaceParams::default(), &mut Silent).unwrap();
    let report = &surface.report;
    assert_eq!(report.genus, [0]);
    assert_eq!((report.components, report.boundary_edges), (1, 0));
    assert!(report.reduce.distance.mean < 1e-3, "{report:?}");
}
