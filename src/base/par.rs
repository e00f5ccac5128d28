//! The only algorithm code that knows of threads.
//!
//! Work is cut by index, every index writes its own result and results come back in index order: the same bytes with
//! one thread or sixteen, and one code path for both builds.

use crate::base::error::Result;
use crate::base::progress::{Progress, Stage};

/// `f(0), f(1), … f(n-1)`, in that order. `scratch` makes the reusable memory of one worker; what is left in it from
/// other indices must not change a result.
#[cfg(not(feature = "threads"))]
pub fn map<S, T>(
    n: usize,
    scratch: impl Fn() -> S + Sync + Send,
    f: impl Fn(usize, &mut S) -> T + Sync + Send,
) -> Vec<T> {
    let mut s = scratch();
    (0..n).map(|i| call(&f, i, &mut s)).collect()
}

/// `f(i, s)`, in a function of its own. A browser compiles a function quickly and badly at first, and well while it runs, for
/// its next call: what a stage does for every index must not become part of a function that is called once.
#[inline(never)]
fn call<S, T>(f: &impl Fn(usize, &mut S) -> T, i: usize, s: &mut S) -> T {
    f(i, s)
}

/// `f(0), f(1), … f(n-1)`, in that order. `scratch` makes the reusable memory of one worker; what is left in it from
/// other indices must not change a result.
///
/// Every worker takes one part of the indices after the other. Rayon would cut them itself, in a machinery that is compiled
/// anew for every loop: that made a quarter of the threads build.
#[cfg(feature = "threads")]
pub fn map<S, T: Send>(
    n: usize,
    scratch: impl Fn() -> S + Sync + Send,
    f: impl Fn(usize, &mut S) -> T + Sync + Send,
) -> Vec<T> {
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::sync::{Mutex, PoisonError};

    let parts = n.min(PARTS * threads());
    let results: Vec<Mutex<Vec<T>>> = (0..parts).map(|_| Mutex::default()).collect();
    let next = AtomicUsize::new(0);
    on_every_worker(&|| {
        let mut memory = None;
        loop {
            let part = next.fetch_add(1, Ordering::Relaxed);
            let Some(result) = results.get(part) else {
                break;
            };
            let s = memory.get_or_insert_with(&scratch);
            let start = |part| (n as u64 * part as u64 / parts as u64) as usize;
            let values = (start(part)..start(part + 1))
                .map(|i| call(&f, i, s))
                .collect();
            *result.lock().unwrap_or_else(PoisonError::into_inner) = values;
        }
    });
    let mut out = Vec::with_capacity(n);
    for result in results {
        out.append(&mut result.into_inner().unwrap_or_else(PoisonError::into_inner));
    }
    out
}

/// Parts that [`map`] cuts for each thread, so that all of them end at about the same time.
#[cfg(feature = "threads")]
const PARTS: usize = 16;

/// Runs a job once a thread of the pool, and returns when all have ended.
#[cfg(feature = "threads")]
fn on_every_worker(job: &(dyn Fn() + Sync)) {
    use rayon::prelude::*;
    (0..threads())
        .into_par_iter()
        .with_max_len(1)
        .for_each(|_| job());
}

/// [`map`] in slices, with progress and a chance to cancel between them.
///
/// `weight` is about how many microseconds one index takes; slices last about 20 ms on one thread.
pub fn map_progress<S, T: Send>(
    n: usize,
    weight: f32,
    (stage, progress): (Stage, &mut dyn Progress),
    scratch: impl Fn() -> S + Sync + Send,
    f: impl Fn(usize, &mut S) -> T + Sync + Send,
) -> Result<Vec<T>> {
    let slice = ((20_000.0 / weight) as usize).max(1);
    let mut out = Vec::with_capacity(n);
    progress.update(stage, 0.0)?;
    while out.len() < n {
        let start = out.len();
        let m = slice.min(n - start);
        out.extend(map(m, &scratch, |i, s| f(start + i, s)));
        progress.update(stage, out.len() as f32 / n as f32)?;
    }
    Ok(out)
}

/// Results that [`map_each`] makes before it hands them on.
const BATCH: usize = 1024;

/// [`map`] of which `take` gets every index and result, in that order; they never exist all at once.
pub fn map_each<S, T: Send>(
    n: usize,
    scratch: impl Fn() -> S + Sync + Send,
    f: impl Fn(usize, &mut S) -> T + Sync + Send,
    mut take: impl FnMut(usize, T),
) {
    for start in (0..n).step_by(BATCH) {
        let batch = map(BATCH.min(n - start), &scratch, |i, s| f(start + i, s));
        for (i, result) in batch.into_iter().enumerate() {
            take(start + i, result);
        }
    }
}

/// [`map`] of lists that become one, which has `total` values; no second copy of them all exists at any time.
pub fn flat_map<S, T: Send>(
    n: usize,
    total: usize,
    scratch: impl Fn() -> S + Sync + Send,
    f: impl Fn(usize, &mut S) -> Vec<T> + Sync + Send,
) -> Vec<T> {
    let mut out = Vec::with_capacity(total);
    map_each(n, scratch, f, |_, list| out.extend(list));
    out
}

/// [`flat_map`] in slices, as [`map_progress`].
pub fn flat_map_progress<S, T: Send>(
    n: usize,
    total: usize,
    weight: f32,
    (stage, progress): (Stage, &mut dyn Progress),
    scratch: impl Fn() -> S + Sync + Send,
    f: impl Fn(usize, &mut S) -> Vec<T> + Sync + Send,
) -> Result<Vec<T>> {
    let slice = ((20_000.0 / weight) as usize).max(1);
    let mut out = Vec::with_capacity(total);
    progress.update(stage, 0.0)?;
    for start in (0..n).step_by(slice) {
        let m = slice.min(n - start);
        out.extend(flat_map(m, 0, &scratch, |i, s| f(start + i, s)));
        progress.update(stage, (start + m) as f32 / n as f32)?;
    }
    Ok(out)
}

/// How many threads [`map`] uses.
pub fn threads() -> usize {
    #[cfg(feature = "threads")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "threads"))]
    return 1;
}
