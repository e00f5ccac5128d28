//! What every stage stands on: errors, options, progress, threads, random numbers, lists, small algebra, kernels.
//!
//! Knows no stage and imports none.

pub(crate) mod clock;
pub mod error;
pub mod kernel;
pub mod lanes;
pub mod linalg;
pub(crate) mod lists;
pub mod par;
pub mod params;
#[cfg(feature = "threads")]
pub mod pool;
pub mod power;
pub mod progress;
pub mod rng;
pub(crate) mod sets;
