//! What is the same in all tiles, and what follows for a tile on a level.

use crate::features::Known;
use crate::features::lines::Lines;
use crate::reduce::WallShare;
use crate::reduce::law::Law;
use serde::{Deserialize, Serialize};

/// Centres of a sub-domain, as [`mod@crate::reduce`] has them.
const CENTERS: f64 = 32.0;
/// Points of a sub-domain, as there.
const FEWEST: usize = 64;
/// See [`FEWEST`].
const MOST: usize = 512;

/// How much is kept of the scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Aim {
    /// A share of the points.
    Ratio(f64),
    /// About so many points.
    Count(f64),
    /// √(area a reduced point), in the caller's unit.
    Spacing(f64),
    /// As few as keep 99 % of the surface within this distance, in the caller's unit.
    Tolerance(f64),
}

/// What is the same in all tiles. Lengths are in the caller's unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Measures {
    /// Standard deviation of the noise.
    pub noise: f64,
    /// The part of it that comes from rounded coordinates; 0 where there is none.
    pub steps: f64,
    /// Median spacing of the points.
    pub median: f64,
    /// √(area a point) of the scan.
    pub spacing: f64,
    /// √(area a reduced point), of the leaves.
    pub target: f64,
    /// Of scan lines, where there are some.
    pub lines: Option<LineMeasures>,
    /// Of the surface, for the scan's own points.
    pub law: Law,
    /// Reduced points that the law's spacing stands for, where it says 1; for the scan's own points.
    pub scale: f64,
    /// Of thin walls, where there are some.
    pub walls: Option<WallShare>,
    /// The tolerance that was aimed at, where it was the target: not the one that was asked for where noise hides that.
    pub tolerance: Option<f64>,
    /// How far from a leaf points still change what is in it.
    pub reach: f64,
}

/// What is known of scan lines.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct LineMeasures {
    /// Noise of the places by which lines are measured.
    pub noise: f64,
    /// Their median spacing.
    pub spacing: f64,
    /// Share of the points that are on lines.
    pub share: f64,
}

/// What a tile is reduced by; lengths in the caller's unit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rule {
    /// Of what is reduced.
    pub(super) surface: Surface,
    pub(super) law: Law,
    pub(super) scale: f64,
    pub(super) walls: Option<WallShare>,
    /// Points of a sub-domain.
    pub(super) cell_points: usize,
    /// How far from a tile points still change what is in it.
    pub(super) reach: f64,
}

impl Measures {
    /// √(area a reduced point) of a tile below which so many levels of tiles are reduced: twice as much for each.
    pub fn spacing_at(&self, level: u32) -> f64 {
        self.target * f64::from(1u32 << level.min(31))
    }

    pub(super) fn rule(&self, level: u32) -> Rule {
        let given = match level {
            0 => self.spacing,
            _ => self.spacing_at(level - 1),
        };
        let made = self.spacing_at(level);
        let coarser = given / self.spacing;
        let cell_points = cell_points(given, made);
        // Where spacings follow a tolerance they differ more than where they follow a share.
        let wide = match self.law {
            Law::Share(_) => 1.0,
            Law::Chords { widest, .. } => (widest / self.target).max(1.0),
        };
        let given_wide = if level == 0 { given } else { wide * given };
        Rule {
            surface: Surface {
                // A reduced point is the mean of those that it stands for, but all of them may be rounded alike.
                noise: (self.noise / coarser).max(self.steps),
                steps: self.steps,
                median: self.median * coarser,
                lines: self.lines.filter(|_| level == 0),
            },
            law: self.law.with_groups(coarser),
            scale: self.scale * (coarser * self.target / made).powi(2),
            walls: self.walls.filter(|_| level == 0),
            cell_points,
            // The clusters' sweeps and what looks at neighbours take ten spacings; a sub-domain is whole or not at all.
            reach: 10.0 * wide * made + (cell_points as f64).sqrt() * given_wide,
        }
    }
}

/// What is known of points before they are measured; lengths in the caller's unit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Surface {
    pub(super) noise: f64,
    pub(super) steps: f64,
    /// Median spacing.
    pub(super) median: f64,
    pub(super) lines: Option<LineMeasures>,
}

impl Surface {
    /// In a frame in which the caller's unit is 1/`side`.
    pub(super) fn known(&self, side: f64) -> Known {
        let of = |length: f64| (length / side) as f32;
        Known {
            noise: of(self.noise),
            steps: of(self.steps),
            spacing: of(self.median),
            lines: self.lines.map(|lines| Lines {
                places: (of(lines.noise), of(lines.spacing)),
                share: lines.share as f32,
            }),
        }
    }
}

/// Points of a sub-domain where points of one spacing are reduced to another.
pub(super) fn cell_points(given: f64, made: f64) -> usize {
    ((CENTERS * (made / given).powi(2)) as usize).clamp(FEWEST, MOST)
}
