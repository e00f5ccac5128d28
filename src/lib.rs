//! Pointweave takes a raw 3D scan (points only, no normals) to a reduced cloud, oriented normals and a mesh.
//!
//! It implements "Reduction Strategy of Point Clouds to Reconstruct Surface Based on Fuzzy Clustering" (IJGDC, 2014),
//! called *the paper* throughout, and puts improvements beside it that were chosen by measurement.
//!
//! ```text
//! caller's arrays
//!   └ cloud     length and finiteness checked, unit frame
//!     └ octree    Morton order, neighbour queries
//!       └ features  spacing, unoriented normal, curvature, surface variation, noise
//!         ├ outliers    isolated points, which may be dropped before all else
//!         └ fcm, reduce   section 3: fuzzy c-means centres stand for the points   ──► reduced cloud
//!           └ cells, fit    section 4.1: one local implicit function a sub-domain (eq. 9-11)
//!             └ orient        section 4.2: which side is out (Algorithm 1)
//!               └ field         partition of unity joins the local functions
//!                 └ extract       manifold iso-surface                            ──► mesh
//!                   └ report        what was lost, measured
//! ```
//!
//! **Frame.** Inside, positions are `f32` in the *unit frame*: bounding box centred at the origin, diagonal 1.
//! Every tolerance is a fraction of that diagonal. The caller's frame is restored once, at exit.
//!
//! **Signs.** Local functions and the joined field are negative inside and positive outside; normals point outward;
//! triangles run counter-clockwise seen from outside.
//!
//! **Same input, same bytes.** Results depend neither on threads nor on the machine: transcendental functions come
//! from `libm`, sums have a fixed order, random numbers a seed.

#![forbid(unsafe_code)]
#![deny(missing_docs)]

// Base: knows no stage.
pub mod error;
pub mod params;
#[cfg(feature = "threads")]
pub mod pool;
pub mod progress;
pub mod par;
pub mod rng;
mod lists;
pub mod power;
pub mod lanes;
pub mod linalg;
pub mod kernel;

// Stages, in the order in which data flows through them.
pub mod cloud;
pub mod octree;
pub mod neighborhood;
pub mod features;
mod noise;
mod planes;
mod filter;
pub mod outliers;
pub mod density;
pub mod fcm;
pub mod clusters;
pub mod placement;
mod surroundings;
mod borders;
pub mod paper;
mod tolerance;
pub mod reduce;
pub mod cells;
pub mod local;
mod faces;
pub mod fit;
mod winding;
mod caves;
pub mod orient;
pub mod field;
pub mod extract;
mod band;
mod lattice;
mod loops;
mod dual;
mod creases;
mod trim;
mod rims;
mod simplify;
mod collapse;
pub mod attach;
pub mod report;
pub mod distance;
pub mod height_field;

// The top: what the stages start from, the stages in order.
mod clock;
mod input;
pub mod pipeline;

// Beside the pipeline: solids with a known surface and their simulated scans; files.
pub mod formats;
pub mod samples;

// The border to JavaScript.
#[cfg(target_arch = "wasm32")]
mod js;
#[cfg(all(target_arch = "wasm32", feature = "engine"))]
pub mod wasm;
#[cfg(all(target_arch = "wasm32", not(feature = "engine")))]
pub mod wasm_read;

pub use cloud::Cloud;
pub use error::{Error, Result};
pub use params::{ReduceParams, SurfaceParams};
pub use pipeline::{CloudInfo, ReducedCloud, Surface, inspect};
pub use pipeline::{reconstruct, reconstruct_owned, reduce, reduce_owned};
pub use progress::{Progress, Stage};
