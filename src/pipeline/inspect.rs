//! Counts, bounds, spacing and noise of a cloud, which stays as it is.

use crate::base::error::Result;
use crate::base::progress::Progress;
use crate::cloud::Cloud;
use crate::pipeline::input::measure;
use serde::Serialize;

/// What can be said of a cloud before anything is done to it. Lengths are in the caller's unit.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct CloudInfo {
    /// Points, those that are not finite too.
    pub count: usize,
    /// Points with a coordinate that is NaN or infinite; all else is about the other points.
    pub non_finite: usize,
    /// Points that repeat an earlier one exactly.
    pub duplicates: usize,
    /// Corners of the bounding box.
    pub bounds: Bounds,
    /// Diagonal of the bounding box.
    pub diagonal: f64,
    /// Median distance of neighbours on the surface.
    pub spacing: f64,
    /// Estimated standard deviation of the noise across the surface.
    pub noise: f64,
}

/// Corners of a bounding box in the caller's frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Bounds {
    /// Lower corner.
    pub min: [f64; 3],
    /// Upper corner.
    pub max: [f64; 3],
}

/// Looks at positions `x y z …` without changing or refusing any.
///
/// # Errors
/// [`crate::Error::EmptyCloud`] (no finite point), [`crate::Error::BadLength`], [`crate::Error::Cancelled`].
pub fn inspect(positions: &[f64], progress: &mut dyn Progress) -> Result<CloudInfo> {
    let finite: Vec<f64> = positions
        .chunks_exact(3)
        .filter(|p| p.iter().all(|x| x.is_finite()))
        .flatten()
        .copied()
        .collect();
    let whole = positions.len() / 3 * 3 == positions.len();
    let cloud = Cloud::from_f64(if whole { &finite } else { positions })?;
    let (tree, features) = measure(&cloud, progress)?;
    let mut sorted: Vec<[u64; 3]> = finite
        .chunks_exact(3)
        .map(|p| [0, 1, 2].map(|a| (p[a] + 0.0).to_bits()))
        .collect();
    sorted.sort_unstable();
    let corner = |pick: fn(f64, f64) -> f64, start: f64| {
        [0, 1, 2].map(|a| finite[a..].iter().step_by(3).copied().fold(start, pick))
    };
    let diagonal = cloud.frame.diagonal;
    let extent = tree.nodes[0].lo != tree.nodes[0].hi;
    Ok(CloudInfo {
        count: positions.len() / 3,
        non_finite: (positions.len() - finite.len()) / 3,
        duplicates: sorted.windows(2).filter(|w| w[0] == w[1]).count(),
        bounds: Bounds {
            min: corner(f64::min, f64::INFINITY),
            max: corner(f64::max, f64::NEG_INFINITY),
        },
        diagonal: if extent { diagonal } else { 0.0 },
        spacing: features.median_spacing() as f64 * diagonal,
        noise: features.noise as f64 * diagonal,
    })
}
