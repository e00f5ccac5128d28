//! How curvature becomes spacing, the same on all of a surface.
//!
//! 1. Curvature asks for a density ρ ∝ κ^α. Against the largest error of a piecewise linear surface α = 1 is best,
//!    against the rms error 2/3 (Clark, *Proc. SIGGRAPH* 1976 onwards; d'Azevedo and Simpson, 1991); α = ½ was the best
//!    measured, because κ is an estimate.
//! 2. Bounds keep flat parts from starving and noise from gathering all points: [`FINEST`], [`COARSEST`].
//!
//! With a tolerance as the target chords of a linear surface are equally wrong everywhere: [`Law::Chords`].

use serde::{Deserialize, Serialize};

/// Smallest spacing, as a share of the mean: three times the mean density.
const FINEST: f32 = 0.577;
/// Largest spacing, as a multiple of the mean: three quarters of the mean density. Flat parts that are given less come
/// out of a Poisson reconstruction with dents (error of a clean CAD part at 2: four times as large).
const COARSEST: f32 = 1.155;
/// Smallest curvature that counts, as a share of the mean. Without it clean flat parts, whose curvature is zero, set the
/// mean and drive everything else to the finest spacing (error of a clean CAD part 15 % larger, at its edges 30 %).
const FLATTEST: f64 = 0.1;

/// A patch of the surface.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Patch {
    pub(crate) curvature: f64,
    pub(crate) area: f64,
    /// How many patches of the surface it stands for.
    pub(crate) weight: f64,
}

/// The spacing that a curvature asks for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum Law {
    /// A share of the points.
    Share(Share),
    /// Chords of a piecewise linear surface that are off by `chord`: one of length h over curvature κ is off by κh²/8.
    #[serde(rename_all = "camelCase")]
    Chords {
        /// In the lengths' unit.
        chord: f64,
        /// Largest spacing.
        widest: f64,
    },
}

/// A law whose mean over the surface is the spacing of the groups that it was found from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Share {
    /// α.
    alpha: f64,
    /// Mean curvature of the surface, in the inverse of the lengths' unit.
    typical: f64,
    /// What the mean spacing is before it is bounded, and once more after.
    means: [f64; 2],
    /// Mean spacing of the groups.
    unit: f64,
}

impl Law {
    /// The law of a surface that gives a share of its points.
    pub(crate) fn of(patches: &[Patch], alpha: f64) -> Law {
        Law::Share(Share::of(patches, alpha))
    }

    /// The wanted spacing where the surface is so curved.
    pub(crate) fn spacing(&self, curvature: f64) -> f32 {
        match self {
            Law::Share(share) => share.spacing(curvature),
            Law::Chords { chord, widest } => (8.0 * chord / curvature.max(f64::MIN_POSITIVE))
                .sqrt()
                .min(*widest) as f32,
        }
    }

    /// The same law for groups that are `factor` times as far apart.
    pub(crate) fn with_groups(self, factor: f64) -> Law {
        match self {
            Law::Share(share) => Law::Share(Share {
                unit: share.unit * factor,
                ..share
            }),
            Law::Chords { chord, widest } => Law::Chords {
                chord: chord * factor * factor,
                widest: widest * factor,
            },
        }
    }

    /// The same law where lengths are `factor` times as long.
    pub(crate) fn scaled(self, factor: f64) -> Law {
        match self {
            Law::Share(share) => Law::Share(Share {
                typical: share.typical / factor,
                unit: share.unit * factor,
                ..share
            }),
            Law::Chords { chord, widest } => Law::Chords {
                chord: chord * factor,
                widest: widest * factor,
            },
        }
    }
}

impl Share {
    fn of(patches: &[Patch], alpha: f64) -> Share {
        let area = |patch: &Patch| patch.area * patch.weight;
        let total = patches.iter().map(area).sum::<f64>().max(f64::MIN_POSITIVE);
        let mean = |values: &mut dyn Iterator<Item = f64>| {
            let weighted = values.zip(patches).map(|(v, patch)| v * area(patch));
            weighted.sum::<f64>() / total
        };
        let weight: f64 = patches.iter().map(|patch| patch.weight).sum();
        let mut law = Share {
            alpha,
            typical: mean(&mut patches.iter().map(|patch| patch.curvature)),
            means: [1.0; 2],
            unit: (total / weight).sqrt(),
        };
        if law.is_even() {
            return law;
        }
        let asked = |patch: &Patch| law.asked(patch.curvature);
        let mut spacing: Vec<f64> = patches.iter().map(asked).collect();
        for i in 0..law.means.len() {
            law.means[i] = mean(&mut spacing.iter().copied());
            for h in &mut spacing {
                *h = Share::bounded(*h, law.means[i]);
            }
        }
        law
    }

    fn is_even(&self) -> bool {
        self.typical == 0.0 || self.alpha == 0.0
    }

    /// h = ρ^(-1/2).
    fn asked(&self, curvature: f64) -> f64 {
        libm::pow((curvature / self.typical).max(FLATTEST), -0.5 * self.alpha)
    }

    /// In units of its mean over the surface, and bounded.
    fn bounded(h: f64, mean: f64) -> f64 {
        (h / mean).clamp(f64::from(FINEST), f64::from(COARSEST))
    }

    fn spacing(&self, curvature: f64) -> f32 {
        if self.is_even() {
            return self.unit as f32;
        }
        let asked = self.asked(curvature);
        (self
            .means
            .iter()
            .fold(asked, |h, &mean| Share::bounded(h, mean))
            * self.unit) as f32
    }
}
