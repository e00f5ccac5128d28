//! Scans larger than memory: cut into tiles that are reduced each for itself, in such a way that the cuts do not show, and
//! reduced again, level by level, up to one tile that holds all. Section 3 of the paper at every level.
//!
//! 1. [`counts`]: points are counted on a lattice, file by file; counts of several files add up.
//! 2. [`plan`]: an octree over the lattice, whose leaves have at most so many points, and what each tile needs of others.
//! 3. [`points`]: a file's points go to their leaves, as whole numbers on a lattice of the root tile ([`grid`]).
//! 4. [`measuring`]: samples of some leaves ([`samples`]) tell noise, spacing, lines, steps, walls and the law of the density, once for
//!    the whole scan ([`measures`]); for a tolerance they are reduced until they keep it (`tolerance`).
//! 5. [`reduce`]: the points of a tile and those around it become the tile's reduced points: of a leaf from the scan, of a tile
//!    above from the points of the tiles below.
//!
//! Nothing here reads or writes files: `pkg/tiles` does. No step needs more than one tile with its surroundings in memory, and
//! what a step gives depends on nothing but what it is given, so that they run in any order, anywhere.
//!
//! **Why cuts do not show.** What a reduction does at a place follows from the points within a few spacings of it, but for what it
//! takes from the whole: noise, mean curvature, the number of points, the octree. Here the first three are the scan's, whatever
//! the tile, octrees have the cells of the root's, and how many centres a cell gets is rounded by a chance that its own points
//! tell. A tile is reduced with more than those few spacings of its surroundings, and keeps the points that lie in it.
//!
//! **In**: positions in the caller's unit, `f32` or `f64` with an origin. **Out**: points on the root's lattice, of which one step is
//! the root's side by 2³².
//!
//! **Cost**: three passes over the points to count, sort and reduce; a leaf takes what [`crate::pipeline::reduce()`] does, and 7 % more
//! for its surroundings at two million points.

pub mod counts;
pub mod grid;
mod measured;
pub mod measures;
pub mod measuring;
pub mod plan;
pub mod points;
pub mod reduce;
pub mod samples;
mod tolerance;

pub use counts::Counts;
pub use grid::{Grid, Tile};
pub use measures::{Aim, Measures};
pub use measuring::measure;
pub use plan::{Leaf, Plan};
pub use points::{Points, Split};
pub use samples::Sample;
