//! Colours of scans that overlap brought together: a factor for each scan and channel.
//!
//! Where two scans lie on each other the median ratio of their colours is measured; the factors even these ratios out in the mean of
//! squares of their logarithms, with the mean factor 1.

use super::agreement::Agreement;
use super::pose::Pose;
use super::samples::Samples;
use crate::cloud::Cloud;
use nalgebra::{Cholesky, DMatrix, DVector};

/// Darker and lighter values are clipped, and say nothing.
const TOLD: std::ops::RangeInclusive<u8> = 8..=247;
/// Places that a ratio needs.
const ENOUGH: usize = 20;
/// Factors are at most this, and at least one divided by this.
const MOST: f64 = 2.0;

/// The factors of red, green and blue of each of `members`, whose samples and poses these are.
pub(crate) fn gains(
    clouds: &[Cloud],
    members: &[usize],
    samples: &[&Samples],
    poses: &[Pose],
    overlaps: &[((usize, usize), Agreement)],
) -> Vec<Option<[f64; 3]>> {
    let mut ratios = Vec::new();
    for &((a, b), _) in overlaps {
        let colors = (&clouds[members[a]].colors, &clouds[members[b]].colors);
        let (Some(a_colors), Some(b_colors)) = colors else {
            continue;
        };
        let to_b = poses[b].back().after(&poses[a]);
        let mut logs = [Vec::new(), Vec::new(), Vec::new()];
        for (i, j) in super::agreement::matched(samples[a], &to_b, samples[b]) {
            let p = a_colors[samples[a].callers[i] as usize];
            let q = b_colors[samples[b].callers[j] as usize];
            for channel in 0..3 {
                if TOLD.contains(&p[channel]) && TOLD.contains(&q[channel]) {
                    let ratio = f32::from(q[channel]) / f32::from(p[channel]);
                    logs[channel].push(libm::logf(ratio));
                }
            }
        }
        let medians = logs.map(|mut logs| {
            logs.sort_unstable_by(f32::total_cmp);
            (logs.len() >= ENOUGH).then(|| (f64::from(logs[logs.len() / 2]), logs.len() as f64))
        });
        ratios.push((a, b, medians));
    }
    let mut gains = vec![None; members.len()];
    for channel in 0..3 {
        let known: Vec<(usize, usize, f64, f64)> = ratios
            .iter()
            .filter_map(|&(a, b, medians)| {
                medians[channel].map(|(ratio, weight)| (a, b, ratio, weight))
            })
            .collect();
        let logs = evened(members.len(), &known);
        for (k, log) in logs.into_iter().enumerate() {
            if known.iter().any(|&(a, b, ..)| a == k || b == k) {
                let gain = gains[k].get_or_insert([1.0; 3]);
                gain[channel] = libm::exp(log).clamp(1.0 / MOST, MOST);
            }
        }
    }
    gains
}

/// x with least Σ weight (x_a - x_b - ratio)², and the least sum of squares among these.
fn evened(count: usize, known: &[(usize, usize, f64, f64)]) -> Vec<f64> {
    let mut matrix = DMatrix::<f64>::zeros(count, count);
    let mut right = DVector::<f64>::zeros(count);
    let all: f64 = known.iter().map(|k| k.3).sum();
    for k in 0..count {
        matrix[(k, k)] = 1e-6 * all + f64::MIN_POSITIVE;
    }
    for &(a, b, ratio, weight) in known {
        matrix[(a, a)] += weight;
        matrix[(b, b)] += weight;
        matrix[(a, b)] -= weight;
        matrix[(b, a)] -= weight;
        right[a] += weight * ratio;
        right[b] -= weight * ratio;
    }
    match Cholesky::new(matrix) {
        Some(cholesky) => cholesky.solve(&right).as_slice().to_vec(),
        None => vec![0.0; count],
    }
}
