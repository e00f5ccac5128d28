//! The stages in order: what the crate, the package and the page call.
//!
//! [`inspect`] looks at a cloud, [`reduce`] takes it to fewer points, [`reconstruct`] to a mesh.

mod input;
mod inspect;
mod memory;
mod reconstruct;
mod reduce;
mod results;
mod sites;

pub use inspect::{Bounds, CloudInfo, inspect};
pub use memory::Memory;
pub use reconstruct::{reconstruct, reconstruct_again, reconstruct_owned};
pub use reduce::{reduce, reduce_owned};
pub use results::{Distances, ReducedCloud, Surface};
