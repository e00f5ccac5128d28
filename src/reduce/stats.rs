//! Statistics of a clustering: objective, validity, evenness, sweeps.

use crate::base::power::Fuzzifier;
use crate::cloud::octree::Octree;
use crate::reduce::clustering::Clustering;
use crate::reduce::surroundings::Surroundings;

/// Figures of one reduction.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ReduceStats {
    /// Sub-domains.
    pub cells: usize,
    /// Sweeps of steps (b) and (c); the most that any sub-domain took.
    pub iterations: usize,
    /// J of eq. 1, Σ u^m |x - v|² over the nearest centres, in squared diagonals.
    pub objective: f64,
    /// Validity index χ of eq. 7; 0 with fewer than two centres or with coincident ones.
    pub validity: f64,
    /// Coefficient of variation of (distance of a reduced point to its nearest / wanted spacing); 0 is perfectly even.
    pub evenness: f64,
    /// Input points that were kept as they are (the paper's "typical data with sharp feature").
    pub kept: usize,
}

/// The figures of one clustering.
pub(crate) fn stats(
    tree: &Octree,
    clustering: &Clustering,
    around: &[Surroundings],
    power: Fuzzifier,
) -> ReduceStats {
    let centers = &clustering.centers;
    let mut objective = 0.0;
    for (p, s) in tree.points.iter().zip(&clustering.shares) {
        for (i, u) in s.used() {
            objective +=
                power.raise(f64::from(u)) * f64::from(p.distance_squared(centers[i as usize]));
        }
    }
    let mut wanted = vec![(0.0, 0u32); centers.len()];
    for (s, &h) in clustering.shares.iter().zip(&clustering.spacing) {
        let (sum, n) = &mut wanted[s.center[0] as usize];
        *sum += f64::from(h);
        *n += 1;
    }
    let apart = || around.iter().map(|a| f64::from(a.apart2));
    let relative = apart()
        .zip(&wanted)
        .filter(|&(apart2, &(sum, _))| sum > 0.0 && apart2.is_finite())
        .map(|(apart2, &(sum, n))| apart2.sqrt() * f64::from(n) / sum);
    let separation = apart().fold(f64::INFINITY, f64::min);
    ReduceStats {
        cells: clustering.cells.len(),
        iterations: clustering.iterations,
        objective,
        validity: if centers.len() > 1 && separation > 0.0 {
            objective / (centers.len() as f64 * separation)
        } else {
            0.0
        },
        evenness: coefficient_of_variation(&relative.collect::<Vec<f64>>()),
        kept: clustering.kept,
    }
}

fn coefficient_of_variation(values: &[f64]) -> f64 {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n;
    if mean > 0.0 {
        variance.sqrt() / mean
    } else {
        0.0
    }
}
