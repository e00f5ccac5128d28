//! Where a file's points were seen from, scan by scan.

use crate::cloud::Viewpoints;
use glam::DVec3;

/// The scanner's positions, and which of them saw each run of points.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Stations {
    /// In the file's frame and unit.
    pub positions: Vec<DVec3>,
    /// Runs in the order of the points. A run ends where the next one starts.
    pub runs: Vec<Run>,
}

/// Points in a row that were seen from one place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Run {
    /// Index of its first point.
    pub start: u64,
    /// Index of the position, or [`Viewpoints::UNKNOWN`].
    pub station: u32,
}

impl Stations {
    /// The points from `start` on were seen from `position`; `None` where the file does not tell.
    pub(super) fn begin(&mut self, start: u64, position: Option<[f64; 3]>) {
        if self.runs.is_empty() && start > 0 {
            let station = Viewpoints::UNKNOWN;
            self.runs.push(Run { start: 0, station });
        }
        let known = position.map(DVec3::from).filter(|p| p.is_finite());
        let station = known.map_or(Viewpoints::UNKNOWN, |position| {
            if self.positions.last() != Some(&position) {
                self.positions.push(position);
            }
            self.positions.len() as u32 - 1
        });
        // A scan without points has no run.
        self.runs.pop_if(|run| run.start == start);
        if self.runs.last().is_none_or(|run| run.station != station) {
            self.runs.push(Run { start, station });
        }
    }

    /// Whether they tell of any point where it was seen from.
    pub fn is_known(&self) -> bool {
        let known = |run: &Run| run.station != Viewpoints::UNKNOWN;
        self.runs.iter().any(known)
    }

    /// The same, point by point.
    pub fn viewpoints(&self, points: usize) -> Option<Viewpoints> {
        if !self.is_known() {
            return None;
        }
        let all_from_the_first = self.runs.iter().all(|run| run.station == 0);
        let of = (!all_from_the_first).then(|| {
            let mut of = vec![Viewpoints::UNKNOWN; points];
            let starts = self.runs.iter().map(|run| run.start as usize);
            for (run, end) in self.runs.iter().zip(starts.skip(1).chain([points])) {
                of[run.start as usize..end].fill(run.station);
            }
            of
        });
        let positions = self.positions.clone();
        Some(Viewpoints { positions, of })
    }
}
