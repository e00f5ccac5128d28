//! The adaptive method: sub-domains of about as many centres, quotas for each, and weighted fuzzy c-means over all of them.

use crate::base::error::Result;
use crate::base::params::{Method, ReduceParams};
use crate::base::progress::Progress;
use crate::cloud::octree::Octree;
use crate::features::Features;
use crate::reduce::clustering::Clustering;
use crate::reduce::clusters::{self, Samples, Settling};
use crate::reduce::density::{self, Density};
use std::ops::Range;

/// How many centres start in the cells.
#[derive(Clone, Copy)]
pub(crate) enum Quotas<'a> {
    /// So many together.
    Total(usize),
    /// In each as many as it deserves, rounded by the chance of its first point, given its index in the tree.
    Local(&'a dyn Fn(usize) -> f64),
}

/// Points of a cell so that it holds about 32 centres: enough to hide the cell's border, few enough that a point meets
/// few centres that are too far to matter.
fn cell_points(count: usize, n: usize, params: &ReduceParams) -> usize {
    params
        .cell_points
        .unwrap_or((32 * n / count).clamp(64, 512))
}

/// The clusters of a density, and a tree of their centres.
pub(crate) fn adaptive(
    tree: &Octree,
    features: &Features,
    (quotas, density): (Quotas, Density),
    params: &ReduceParams,
    progress: &mut dyn Progress,
) -> Result<(Clustering, Octree)> {
    let count = match quotas {
        Quotas::Total(count) => count,
        Quotas::Local(_) => density.count(),
    };
    let capacity = cell_points(count, tree.points.len(), params);
    let cells: Vec<Range<usize>> = tree.cut(|node| node.range().len() <= capacity);
    let shares = density.shares(&cells);
    let quotas = match quotas {
        Quotas::Total(count) => density::quotas(&shares, &cells, count),
        Quotas::Local(chance) => density::local_quotas(&shares, &cells, |cell| chance(cell.start)),
    };
    let Density { spacing, share } = density;
    drop(share);
    let samples = Samples {
        tree,
        features,
        spacing: &spacing,
    };
    let settling = Settling {
        fuzzifier: params.fuzzifier(params.method),
        epsilon: params.epsilon(Method::Adaptive),
        max_iterations: params.max_iterations(Method::Adaptive),
    };
    let clusters = clusters::cluster(samples, (&cells, &quotas), &settling, progress)?;
    let clustering = Clustering {
        centers: clusters.centers,
        shares: clusters.shares,
        spacing,
        cells,
        iterations: clusters.iterations,
        kept: 0,
    };
    Ok((clustering, clusters.index))
}
