//! How curvature becomes spacing, the same on all of a surface.
//!
//! 1. Curvature asks for a density ρ ∝ κ^α. Against the largest error of a piecewise linear surface α = 1 is best,
//!    against the rms error 2/3 (Clark, *Proc. SIGGRAPH* 1976 onwards; d'Azevedo and Simpson, 1991); α = ½ was the best
//!    measured, because κ is an estimate.
//! 2. Bounds keep flat parts from starving and noise from gathering all points: [`FINEST`], [`COARSEST`].

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

/// The spacing that a curvature asks for: its mean over the surface is that of the groups that the law was
/// found from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Law {
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
    /// The law of a surface.
    pub(crate) fn of(patches: &[Patch], alpha: f64) -> Law {
        let area = |patch: &Patch| patch.area * patch.weight;
        let total = patches.iter().map(area).sum::<f64>().max(f64::MIN_POSITIVE);
        let mean = |values: &mut dyn Iterator<Item = f64>| {
            let weighted = values.zip(patches).map(|(v, patch)| v * area(patch));
            weighted.sum::<f64>() / total
        };
        let weight: f64 = patches.iter().map(|patch| patch.weight).sum();
        let mut law = Law {
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
                *h = Law::bounded(*h, law.means[i]);
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

    /// The wanted spacing where the surface is so curved.
    pub(crate) fn spacing(&self, curvature: f64) -> f32 {
        if self.is_even() {
            return self.unit as f32;
        }
        let asked = self.asked(curvature);
        (self
            .means
            .iter()
            .fold(asked, |h, &mean| Law::bounded(h, mean))
            * self.unit) as f32
    }

    /// The same law for groups that are `factor` times as far apart.
    pub(crate) fn with_groups(self, factor: f64) -> Law {
        Law {
            unit: self.unit * factor,
            ..self
        }
    }

    /// The same law where lengths are `factor` times as long.
    pub(crate) fn scaled(self, factor: f64) -> Law {
        Law {
            typical: self.typical / factor,
            unit: self.unit * factor,
            ..self
        }
    }
}
