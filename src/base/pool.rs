//! The thread pool of the wasm-threads build: rayon's, on workers that JavaScript starts.
//!
//! Wasm cannot start a thread. So JavaScript starts workers over the shared memory, each calls [`lend_thread`] and waits
//! there; then [`build`] hands every one of them its share of the pool. A pool is not taken down: JavaScript
//! terminates the workers together with the engine that owns the memory.

use std::collections::VecDeque;
use std::sync::{Condvar, Mutex, PoisonError};

use rayon::{ThreadBuilder, ThreadPoolBuildError, ThreadPoolBuilder};

/// Threads that rayon wants run and no worker has taken yet.
static WANTED: Mutex<VecDeque<ThreadBuilder>> = Mutex::new(VecDeque::new());
static ADDED: Condvar = Condvar::new();

/// Builds the pool that [`crate::base::par::map`] uses, once a memory. Blocks until `threads` workers have called
/// [`lend_thread`]; a browser's main thread may not block, so call it in a worker.
///
/// # Errors
/// If there is a pool already.
pub fn build(threads: usize) -> Result<(), ThreadPoolBuildError> {
    ThreadPoolBuilder::new()
        .num_threads(threads)
        .spawn_handler(|thread| {
            WANTED
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .push_back(thread);
            ADDED.notify_one();
            Ok(())
        })
        .build_global()
}

/// Lends the calling thread to the pool, for as long as there is a pool.
pub fn lend_thread() {
    let mut wanted = WANTED.lock().unwrap_or_else(PoisonError::into_inner);
    let thread = loop {
        if let Some(thread) = wanted.pop_front() {
            break thread;
        }
        wanted = ADDED.wait(wanted).unwrap_or_else(PoisonError::into_inner);
    };
    drop(wanted);
    thread.run();
}
