//! The paper's own reduction, sections 3.1 and 3.2 to the letter.
//!
//! The octree is subdivided until a cell is flat or small; inside a cell fuzzy c-means runs from random memberships and
//! its centres stand for the points.
//!
//! **λ.** The paper gives 0.0003 and no definition. As surface variation λ0/(λ0+λ1+λ2) that number means nothing fixed:
//! it depends on the cell's size, and noise exceeds it everywhere. Here a cell is flat when the rms distance of its points to
//! their best plane, the noise taken out in quadrature, is at most λ (a fraction of the diagonal); a cell is small when
//! its box is no longer than [`SMALL`] or it holds no more than [`FEW`] points. The accuracy of section 5, 6e-4, is then 2λ.
//!
//! **Counts.** With a flatness target, points of small cells that are not flat are kept ("typical data with sharp
//! feature") and flat cells keep a third, the paper's share for its duck. With a ratio or a count every cell has its share of
//! the target, rounded along the Morton order, and nothing is kept verbatim: the total is exact.

use std::ops::Range;

use glam::Vec3;

use crate::base::error::Result;
use crate::base::linalg::sym_eigen;
use crate::base::par;
use crate::base::params::{Clusters, Method, ReduceParams, Target};
use crate::base::power::Fuzzifier;
use crate::base::progress::{Progress, Stage};
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;
use crate::features::Features;
use crate::reduce::clustering::Clustering;
use crate::reduce::density;
use crate::reduce::fcm::{Fcm, FcmParams, Start};
use crate::reduce::shares::Shares;

/// λ of section 5 where the target is not flatness.
const LAMBDA: f64 = 3e-4;
/// Diagonal of a cell that is not divided further: a disc of radius 0.75 % of the cloud's diagonal.
const SMALL: f32 = 0.015;
/// Points of a cell that is not divided further.
const FEW: usize = 8;
/// Share that flat cells keep when the target is flatness (section 5: the duck's data "decreased by almost two-thirds").
const FLAT_RATIO: f64 = 1.0 / 3.0;
/// c tried around the proportional one when the validity index chooses, as factors.
const VALIDITY_RANGE: [f64; 5] = [0.75, 0.875, 1.0, 1.125, 1.25];

/// Clusters the cloud to `count` centres, or by the flatness target; with a tree of the centres.
pub fn cluster(
    tree: &Octree,
    features: &Features,
    count: Option<usize>,
    params: &ReduceParams,
    progress: &mut dyn Progress,
) -> Result<(Clustering, Octree)> {
    let lambda = match params.target {
        Target::Flatness(lambda) => lambda,
        _ => LAMBDA,
    };
    let capacity = params.cell_points.unwrap_or(256);
    let noise = f64::from(features.noise);
    let cells = tree.cut(|node| {
        let small = node.range().len() <= FEW || node.lo.distance(node.hi) <= SMALL;
        let deep = u32::from(node.level) >= params.max_depth;
        let flat = || flatness(&tree.points[node.range()], noise) <= lambda;
        (node.range().len() <= capacity && (small || flat())) || deep
    });
    let sharp: Vec<bool> = match count {
        Some(_) => vec![false; cells.len()],
        None => cells
            .iter()
            .map(|cell| flatness(&tree.points[cell.clone()], noise) > lambda)
            .collect(),
    };
    let shares = |cell: &Range<usize>, sharp: bool| match count {
        Some(count) => cell.len() as f64 * count as f64 / tree.points.len() as f64,
        None if sharp => cell.len() as f64,
        None => cell.len() as f64 * FLAT_RATIO,
    };
    let mut shares: Vec<f64> = cells
        .iter()
        .zip(&sharp)
        .map(|(c, &s)| shares(c, s))
        .collect();
    let total = count.unwrap_or_else(|| (shares.iter().sum::<f64>().round() as usize).max(1));
    if params.clusters == Clusters::Validity {
        shares = valid_shares(tree, &cells, &shares, params, progress)?;
    }
    let quotas = density::quotas(&shares, &cells, total);

    let runs = par::map_progress(
        cells.len(),
        2000.0,
        (Stage::Cluster, progress),
        Fcm::default,
        |i, fcm| {
            run(
                fcm,
                &tree.points[cells[i].clone()],
                quotas[i],
                params,
                i as u64,
            )
        },
    )?;
    let iterations = runs.iter().map(|r| r.1).max().unwrap_or(0);
    let centers: Vec<Vec3> = runs.into_iter().flat_map(|r| r.0).collect();
    let kept = cells
        .iter()
        .zip(&sharp)
        .filter(|&(_, &s)| s)
        .map(|(c, _)| c.len())
        .sum();

    let index = Octree::build(&centers);
    let fuzzifier = Fuzzifier::new(params.fuzzifier(Method::Paper));
    let shares = par::map(
        tree.points.len(),
        Vec::new,
        |k, found: &mut Vec<Neighbor>| {
            index.knn(tree.points[k], crate::reduce::shares::SHARES, found);
            let near = found.iter().map(|n| index.order[n.index as usize]);
            Shares::of(tree.points[k], &centers, near, fuzzifier)
        },
    );
    let shrink = (tree.points.len() as f32 / centers.len() as f32).sqrt();
    let clustering = Clustering {
        centers,
        shares,
        spacing: features.spacing.iter().map(|s| s * shrink).collect(),
        cells,
        iterations,
        kept,
    };
    Ok((clustering, index))
}

/// Rms distance to the best plane, without the noise.
fn flatness(points: &[Vec3], noise: f64) -> f64 {
    let n = points.len() as f64;
    let mean = points.iter().map(|p| p.as_dvec3()).sum::<glam::DVec3>() / n;
    let mut m = [0.0; 6];
    for p in points {
        let d = p.as_dvec3() - mean;
        let products = crate::base::linalg::outer(d);
        for (sum, product) in m.iter_mut().zip(products) {
            *sum += product / n;
        }
    }
    (sym_eigen(&m).values[0] - noise * noise).max(0.0).sqrt()
}

/// For each cell the c near its share whose partition has the smallest validity index (eq. 7). The sum is brought back
/// to the target afterwards by [`density::quotas`].
fn valid_shares(
    tree: &Octree,
    cells: &[Range<usize>],
    shares: &[f64],
    params: &ReduceParams,
    progress: &mut dyn Progress,
) -> Result<Vec<f64>> {
    par::map_progress(
        cells.len(),
        10_000.0,
        (Stage::Cluster, progress),
        Fcm::default,
        |i, fcm| {
            let points = &tree.points[cells[i].clone()];
            let mut best = (f64::INFINITY, shares[i]);
            let mut tried = 0;
            for factor in VALIDITY_RANGE {
                let c = (shares[i] * factor).round() as usize;
                if c < 2 || c >= points.len() || c == tried {
                    continue;
                }
                tried = c;
                fcm.load(points, &[], params.norm);
                let start = Start::Random {
                    clusters: c,
                    seed: cell_seed(params.seed, i as u64),
                };
                let found = fcm.run(start, &fcm_params(params));
                if found.validity < best.0 {
                    best = (found.validity, c as f64);
                }
            }
            best.1
        },
    )
}

/// The centres of one cell, and the sweeps they took.
fn run(
    fcm: &mut Fcm,
    points: &[Vec3],
    c: usize,
    params: &ReduceParams,
    cell: u64,
) -> (Vec<Vec3>, usize) {
    if c == 0 || c >= points.len() {
        return (points[..c].to_vec(), 0);
    }
    fcm.load(points, &[], params.norm);
    let start = Start::Random {
        clusters: c,
        seed: cell_seed(params.seed, cell),
    };
    let found = fcm.run(start, &fcm_params(params));
    (
        found.centers.iter().map(|v| v.as_vec3()).collect(),
        found.iterations,
    )
}

fn fcm_params(params: &ReduceParams) -> FcmParams {
    FcmParams {
        fuzzifier: params.fuzzifier(Method::Paper),
        epsilon: params.epsilon(Method::Paper),
        max_iterations: params.max_iterations(Method::Paper),
    }
}

fn cell_seed(seed: u64, cell: u64) -> u64 {
    seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(cell)
}
