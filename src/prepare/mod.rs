//! From what a scanner gave to the object: which points are a floor's, a second thing's, a stray's.
//!
//! Hardly any scan holds the object alone. Every step here says of each point what it belongs to, and takes none away: that is
//! done by `prepare` of the pipeline, which calls steps in the order in which a caller lists them.
//!
//! 1. [`pieces`]: connected components of the points, however dense each is.
//! 2. [`planes`]: the planes that hold much of the scan, which of them carry the rest, and which points are theirs.
//! 3. [`regions`]: boxes, spheres, half spaces, and polygons on a screen.
//! 4. [`strays`]: points beside a surface, or between two on one line of sight. Isolated points are [`crate::features::outliers`].
//! 5. [`register`]: several scans in frames of their own are brought into one.
//! 6. [`recipe`]: a list of steps as plain data, as a file or a caller in JavaScript has it.
//!
//! **In**: an octree and its [`crate::features::Features`], unit frame; regions take points of the caller's frame. **Out**: labels or
//! masks in the octree's order.
//!
//! **Cost**: one range query a point for the pieces, a few passes over the points for planes: less than the features.

pub mod pieces;
pub mod planes;
pub mod recipe;
pub mod regions;
pub mod register;
mod search;
mod sheet;
pub mod strays;
