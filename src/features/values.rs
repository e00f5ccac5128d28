//! [`Features`]: the per-point estimates, one array each.

use crate::cloud::octree::Octree;
use crate::features::noise::quantile;
use glam::Vec3;

/// Per-point features in the octree's (Morton) order; lengths in the unit frame.
#[derive(Debug, Clone)]
pub struct Features {
    /// Wanted distance of neighbours on the surface, √(area a point), from how many neighbours a disc holds.
    pub spacing: Vec<f32>,
    /// Unit normal of arbitrary sign, filtered; zero where there is none.
    pub normals: Vec<Vec3>,
    /// √(κ1² + κ2²) of the principal curvatures, from how the normals turn, 1/length; 1/support at most.
    pub curvature: Vec<f32>,
    /// Surface variation λ0/(λ0+λ1+λ2) of the neighbours, 0 (flat) to 1/3 (Pauly, Gross, Kobbelt, "Efficient
    /// simplification of point-sampled surfaces", 2002).
    pub variation: Vec<f32>,
    /// Signed distance of the point to the surface, along its normal, 0 without noise: `point - residual * normal` is denoised.
    pub residual: Vec<f32>,
    /// Estimated standard deviation of the noise across the surface.
    pub noise: f32,
    /// The part of it that comes from rounded coordinates ([`crate::features::steps`]), which a reduction does not average
    /// away; 0 where they were not rounded.
    pub steps: f32,
    /// Share of the points that are on scan lines much farther apart than their points ([`crate::features::lines`]).
    pub lines: f32,
}

impl Features {
    /// Point `i` of the tree, moved onto the surface.
    pub fn denoised(&self, tree: &Octree, i: usize) -> Vec3 {
        tree.points[i] - self.residual[i] * self.normals[i]
    }

    /// Those of some points, as they were measured among all.
    pub(crate) fn select(&self, indices: &[usize]) -> Features {
        let pick = |values: &[f32]| indices.iter().map(|&i| values[i]).collect();
        Features {
            spacing: pick(&self.spacing),
            normals: indices.iter().map(|&i| self.normals[i]).collect(),
            curvature: pick(&self.curvature),
            variation: pick(&self.variation),
            residual: pick(&self.residual),
            ..*self
        }
    }

    /// Median of the spacing.
    pub fn median_spacing(&self) -> f32 {
        quantile(self.spacing.clone(), 2)
    }
}
