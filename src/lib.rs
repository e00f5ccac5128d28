//! Pointweave takes a raw 3D scan (points only, no normals) to a reduced cloud, oriented normals and a mesh.
//!
//! It implements "Reduction Strategy of Point Clouds to Reconstruct Surface Based on Fuzzy Clustering" (IJGDC, 2014),
//! called *the paper* throughout, and puts improvements beside it that were chosen by measurement.
//!
//! ```text
//! caller's arrays
//!   └ cloud       checked, unit frame, Morton order                 section 3, sub-domains
//!     └ features    spacing, normal, curvature, variation, noise      (given, in the paper)
//!       ├ prepare     floors, pieces, strays, regions                   (before all else, where asked for)
//!       └ reduce      fuzzy c-means centres stand for the points      section 3, eq. 1-8        ──► reduced cloud
//!         └ fit         a local implicit function a sub-domain        section 4.1, eq. 9-11
//!           └ orient      which side is out                           section 4.2, Algorithm 1
//!             └ mesh        partition of unity, manifold iso-surface  section 4.2, "stitch"      ──► mesh
//!               └ report      what was lost, measured                 section 5                 ──► report
//!                 └ light       fewer triangles, where asked for
//!                   └ texture     colours and normals in pictures
//!                     └ poster      a picture of it
//! ```
//!
//! [`pipeline`] calls them in this order. Each is a folder (a *wing*) whose `mod.rs` says what the stage does, step by step; all
//! stand on [`base`]. A wing imports only those above it, no two files import each other, and a test holds both.
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
// Who changes a stage reads its docs with `--document-private-items`; for who calls it such names are text.
#![allow(rustdoc::private_intra_doc_links)]
// A wasm module takes what it needs; what nobody needs is found natively, where all of them are.
#![cfg_attr(not(all(feature = "light", feature = "tiles")), allow(dead_code))]

// The wings, in the order in which data flows through them. Each imports only those above it.
pub mod base;
pub mod cloud;
#[cfg(feature = "stages")]
pub mod features;
#[cfg(feature = "stages")]
pub mod prepare;
#[cfg(feature = "stages")]
pub mod reduce;
#[cfg(feature = "stages")]
pub mod fit;
#[cfg(feature = "stages")]
pub mod orient;
#[cfg(feature = "stages")]
pub mod mesh;
#[cfg(feature = "stages")]
pub mod report;
#[cfg(feature = "light")]
pub mod light;
#[cfg(feature = "light")]
pub mod texture;
#[cfg(feature = "light")]
pub mod poster;
#[cfg(feature = "stages")]
pub mod pipeline;
#[cfg(feature = "tiles")]
pub mod tiles;

// Beside the pipeline: solids with a known surface and their simulated scans; files.
#[cfg(any(feature = "samples", feature = "stages"))]
pub mod samples;
pub mod formats;

// The border to JavaScript.
#[cfg(target_arch = "wasm32")]
mod js;

pub use base::error::{Error, Result};
pub use base::params::{ReduceParams, SurfaceParams};
pub use base::progress::{Progress, Stage};
pub use base::{error, par, params, progress};
pub use cloud::Cloud;
#[cfg(feature = "stages")]
pub use pipeline::{CloudInfo, ReducedCloud, Surface, inspect};
#[cfg(feature = "stages")]
pub use pipeline::{reconstruct, reconstruct_owned, reduce, reduce_owned};
