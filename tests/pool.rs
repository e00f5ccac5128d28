//! The pool of the wasm-threads build, in the browsers themselves.
#![cfg(all(target_arch = "wasm32", feature = "threads"))]

mod threads;

use pointweave::par;
use std::collections::BTreeSet;
use wasm_bindgen_test::wasm_bindgen_test;

wasm_bindgen_test::wasm_bindgen_test_configure!(run_in_dedicated_worker);

#[wasm_bindgen_test]
async fn workers_share_the_work_and_results_keep_their_order() {
    threads::start(2).await;
    assert_eq!(par::threads(), 2);

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
