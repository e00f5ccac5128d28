//! The pool of the threads build, natively: alone in its process, as there is one pool a process and whoever maps first
//! would make it.
#![cfg(all(feature = "threads", not(target_arch = "wasm32")))]

use pointweave::base::pool;
use pointweave::par;

#[test]
fn lent_threads_become_the_pool() {
    for _ in 0..3 {
        std::thread::spawn(pool::lend_thread);
    }
    pool::build(3).unwrap();
    assert_eq!(par::threads(), 3);
    let squares = par::map(1000, || (), |i, ()| i * i);
    assert!(
        squares
            .iter()
            .enumerate()
            .all(|(i, &square)| square == i * i)
    );
    assert!(pool::build(3).is_err());
}
