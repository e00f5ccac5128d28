//! What every stage stands on. Knows no stage and imports none.
//!
//! - To the caller: [`error`] (typed errors), [`params`] (every option with its range), [`progress`] (stages, cancelling),
//!   `clock` (time by stage).
//! - Threads: [`par`], the only algorithm code that knows of them; `pool`, the threads of the wasm-threads build.
//! - Numbers: [`lanes`] (eight `f32` at once), [`linalg`] (symmetric 3 by 3 matrices), [`kernel`] (radial functions),
//!   [`power`] (`x^(1/(m-1))`), [`rng`] (seeded), [`srgb`] (the display's scale).
//! - Order: `groups` (values grouped by number), `sort_keys` (whole numbers that sort as floats do), `sets` (disjoint sets).

pub(crate) mod clock;
pub mod error;
pub(crate) mod groups;
pub mod kernel;
pub mod lanes;
pub mod linalg;
pub mod par;
pub mod params;
#[cfg(feature = "threads")]
pub mod pool;
pub mod power;
pub mod progress;
pub mod rng;
pub(crate) mod sets;
pub(crate) mod sort_keys;
pub mod srgb;
