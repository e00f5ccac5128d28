//! Points that are there more than once.

use glam::Vec3;
use std::ops::Range;

/// Whether [`copies`] finds any.
pub(crate) fn copied(points: &[Vec3]) -> bool {
    points.windows(2).any(|pair| pair[0] == pair[1])
}

/// Runs of equal points. In Morton order copies follow each other, unless another point shares their cell of 2⁻²¹.
pub(crate) fn copies(points: &[Vec3]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::with_capacity(points.len());
    for (i, p) in points.iter().enumerate() {
        match runs.last_mut() {
            Some(run) if points[run.start] == *p => run.end = i + 1,
            _ => runs.push(i..i + 1),
        }
    }
    runs
}
