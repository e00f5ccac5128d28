//! The stages in order: what the crate, the package and the page call.
//!
//! - [`inspect()`] looks at a cloud and changes nothing: counts, bounds, spacing, noise.
//! - [`prepare()`] says which points are a floor's, a second thing's or strays, step by step ([`mod@crate::prepare`]).
//!   [`prepare_scans`] takes several scans, and registers them where the recipe says so.
//! - [`reduce()`] takes it to fewer points (section 3): `input` (checks, octree, features, outliers), then [`mod@crate::reduce`].
//! - [`reconstruct()`] takes it to a mesh (section 4): the same, then `sites` (the points that are fitted), [`crate::fit`],
//!   [`crate::orient`], [`crate::mesh`], [`crate::report`]. [`reconstruct_again`] remembers in a [`Memory`] what another call for
//!   the same cloud needs not do again.
//!
//! - [`simplify()`] takes any mesh to fewer triangles ([`mod@crate::light`]), and so does `reconstruct` with `triangles`.
//!   [`texture()`] puts what is lost into pictures ([`mod@crate::texture`]).
//!
//! The variants that own their cloud need 12 bytes a point less. **In**: a [`crate::Cloud`], in the unit frame of its own. **Out**:
//! results in that frame, with functions that give the caller's.

mod doubtful;
mod input;
mod inspect;
#[cfg(feature = "light")]
mod light;
mod memory;
mod prepare;
mod reconstruct;
mod reduce;
mod results;
mod scans;
mod sites;
mod step_reports;

pub use inspect::{Bounds, CloudInfo, inspect};
#[cfg(feature = "light")]
pub use light::{simplify, texture};
pub use memory::Memory;
pub use prepare::{Prepared, prepare, prepare_scans};
pub use reconstruct::{reconstruct, reconstruct_again, reconstruct_owned};
pub use reduce::{reduce, reduce_owned};
pub use results::{Distances, ReducedCloud, Surface};
pub use scans::{PairReport, ScanReport};
pub use step_reports::{PieceReport, PlaneReport, StepReport};
