//! [`Clustering`]: the centres and memberships that either method returns.

use crate::reduce::shares::Shares;
use glam::Vec3;
use std::ops::Range;

/// Cluster centres and how the points are shared among them, in the octree's order: what both methods hand on.
#[derive(Debug, Clone)]
pub struct Clustering {
    /// Centres, in the unit frame.
    pub centers: Vec<Vec3>,
    /// Memberships of every point in its nearest centres.
    pub shares: Vec<Shares>,
    /// Wanted spacing at every point.
    pub spacing: Vec<f32>,
    /// Sub-domains, as ranges of the octree's points.
    pub cells: Vec<Range<usize>>,
    /// Sweeps.
    pub iterations: usize,
    /// Points kept as they are.
    pub kept: usize,
}
