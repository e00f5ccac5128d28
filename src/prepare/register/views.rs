//! The samples of all scans, and where these lie.

use super::describe::Look;
use super::pose::Pose;
use super::samples::{Samples, Scan};
use crate::base::error::Result;
use crate::base::progress::{Progress, Stage};
use crate::cloud::{Cloud, Frame};
use glam::{DVec3, Vec3};

/// Samples of a scan of the middle size: coarse ones, which are matched; fine ones, which say whether a motion is to be trusted; and those
/// by which scans are aligned in the end.
const COARSE: usize = 1200;
const FINE: usize = 4800;
const FINEST: usize = 16_000;
/// Points of a scan for each of its samples, at least.
const DENSE: usize = 2;
/// Length of a fine cell, in standard deviations of the noise, at least, and of a coarse one in fine ones.
const QUIET: f32 = 8.0;
const COARSER: f32 = 1.5;

/// A scan as it is registered: lengths are in the longest diagonal of all scans, its own middle is the origin.
#[derive(Debug)]
pub(crate) struct View {
    scan: Scan,
    pub(crate) coarse: Samples,
    pub(crate) fine: Samples,
    /// Descriptions of the coarse samples, once they are asked for.
    pub(crate) looks: Option<Vec<Look>>,
}

/// All scans.
#[derive(Debug)]
pub(crate) struct Views {
    pub(crate) all: Vec<View>,
    frames: Vec<Frame>,
    /// The longest diagonal, in the caller's unit.
    pub(crate) unit: f64,
}

impl Views {
    /// Samples all scans, in cells that suit most of them.
    pub(crate) fn of(clouds: &[Cloud], progress: &mut dyn Progress) -> Result<Views> {
        let frames: Vec<Frame> = clouds.iter().map(|cloud| cloud.frame).collect();
        let unit = frames
            .iter()
            .map(|frame| frame.diagonal)
            .fold(0.0, f64::max);
        let mut scans = Vec::new();
        for (k, cloud) in clouds.iter().enumerate() {
            progress.update(Stage::Prepare, 0.5 * k as f32 / clouds.len() as f32)?;
            let size = (cloud.frame.diagonal / unit) as f32;
            let points: Vec<Vec3> = cloud.points.iter().map(|&p| p * size).collect();
            scans.push(Scan::of(&points));
        }
        let every: Vec<&Scan> = scans.iter().collect();
        let fine = cell(&every, FINE);
        let coarse = cell(&every, COARSE).max(COARSER * fine);
        let mut all = Vec::new();
        for (k, scan) in scans.into_iter().enumerate() {
            progress.update(Stage::Prepare, 0.5 + 0.5 * k as f32 / clouds.len() as f32)?;
            all.push(View {
                coarse: scan.samples(coarse),
                fine: scan.samples(fine),
                looks: None,
                scan,
            });
        }
        Ok(Views { all, frames, unit })
    }

    /// The finest samples of some scans.
    pub(crate) fn finest(&self, members: &[usize]) -> Vec<Samples> {
        let scans: Vec<&Scan> = members.iter().map(|&k| &self.all[k].scan).collect();
        let cell = cell(&scans, FINEST);
        scans.iter().map(|scan| scan.samples(cell)).collect()
    }

    /// The motion between two scans' units that moves nothing.
    pub(crate) fn still(&self, from: usize, to: usize) -> Pose {
        let [from, to] = self.middles(from, to);
        Pose {
            shift: (from - to) / self.unit,
            ..Pose::IDENTITY
        }
    }

    /// A motion between two scans' units as one of the caller's frames.
    pub(crate) fn callers(&self, pose: &Pose, from: usize, to: usize) -> Pose {
        let [from, to] = self.middles(from, to);
        Pose {
            turn: pose.turn,
            shift: to + pose.shift * self.unit - pose.turn * from,
        }
    }

    fn middles(&self, from: usize, to: usize) -> [DVec3; 2] {
        [from, to].map(|k| DVec3::from_array(self.frames[k].center))
    }
}

/// The length of cells that give so many samples of a scan of the middle size, fewer where it is sparse or noisy.
fn cell(scans: &[&Scan], samples: usize) -> f32 {
    let of = |scan: &&Scan| scan.cell_for(samples.min(scan.len() / DENSE).max(1));
    let cell = middle(scans.iter().map(of).collect());
    cell.max(QUIET * middle(scans.iter().map(|scan| scan.noise).collect()))
}

/// The value of the middle.
fn middle(mut values: Vec<f32>) -> f32 {
    values.sort_unstable_by(f32::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}
