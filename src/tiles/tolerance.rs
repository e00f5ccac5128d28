//! A tolerance as the target: the samples are reduced as tiles would be, and the chord is scaled until 99 % of their surface are just
//! within the tolerance, as [`mod@crate::reduce`] does it of a whole scan.

use crate::base::error::Result;
use crate::base::params::ReduceParams;
use crate::base::progress::Progress;
use crate::cloud::octree::Octree;
use crate::cloud::{Cloud, Frame};
use crate::reduce::height_field::{Patches, cloud_distances};
use crate::reduce::law::Law;
use crate::reduce::{Whole, density, reduce_part, tolerance};
use crate::tiles::grid::Grid;
use crate::tiles::measured::Measured;
use crate::tiles::measures::{Measures, cell_points};
use crate::tiles::reduce::chance;

/// Largest spacing, in mean ones. Tiles are reduced with ten of the largest around them; with this, flat parts of a scan take up to a
/// ninth of the points that the mean spacing would give them.
const WIDEST: f64 = 3.0;

/// The measures of a scan whose surface has an area, for a tolerance.
pub(super) fn within(
    measured: &[Measured],
    (whole, area, grid): (Measures, f64, Grid),
    asked: f64,
    progress: &mut dyn Progress,
) -> Result<Measures> {
    let removed = tolerance::removed(whole.noise as f32, whole.median as f32);
    let aim = asked.max(tolerance::least(removed));
    // Of a flat scan as wide as the root the diagonal, of which WIDEST is a share.
    let all = density::WIDEST * std::f64::consts::SQRT_2 * grid.size;
    let by_chord = |chord: f64| {
        let free = target(measured, area, Law::Chords { chord, widest: all });
        let widest = all.min(WIDEST * free);
        let law = Law::Chords { chord, widest };
        Measures {
            law,
            target: target(measured, area, law),
            tolerance: Some(aim),
            ..whole
        }
    };
    let chord = tolerance::search((removed, aim), progress, |chord, progress| {
        let trial = by_chord(chord);
        let (mut distances, mut areas) = (Vec::new(), Vec::new());
        for m in measured {
            distances.extend(m.distances(&trial, progress)?);
            let own = m.features.spacing.iter();
            let area = own.map(|&s| (f64::from(s) * m.side).powi(2) * m.weight);
            areas.extend(m.inner(area));
        }
        let area = |i: u32| areas[i as usize];
        Ok(Some(tolerance::error(distances, area)))
    })?;
    Ok(by_chord(chord))
}

/// The mean spacing that a law gives to a surface.
fn target(measured: &[Measured], area: f64, law: Law) -> f64 {
    let of = |m: &Measured| {
        let law = law.scaled(1.0 / m.side);
        let relative = density::relative_spacing(&m.tree, &m.features, &law);
        let shares = density::deserved(&m.features, &relative).map(|d| d.min(1.0));
        m.weight * m.inner(shares).sum::<f64>()
    };
    let count: f64 = measured.iter().map(of).sum();
    (area / count.max(1.0)).sqrt()
}

impl Measured<'_> {
    /// How far the points that count are from the surface that a reduction gives, in the caller's unit.
    fn distances(
        &self,
        trial: &Measures,
        progress: &mut dyn Progress,
    ) -> Result<impl Iterator<Item = f32>> {
        let frame = Frame {
            center: [0.0; 3],
            diagonal: 1.0,
        };
        let mut points = vec![glam::Vec3::ZERO; self.tree.order.len()];
        for (&i, &p) in self.tree.order.iter().zip(&self.tree.points) {
            points[i as usize] = p;
        }
        let cloud = Cloud::in_frame(points, frame);
        let chance = |i: u32| chance(self.sample.places[i as usize]);
        let whole = Whole {
            law: trial.law.scaled(1.0 / self.side),
            scale: trial.scale,
            walls: None,
            chance: &chance,
        };
        let params = ReduceParams {
            cell_points: Some(cell_points(trial.spacing, trial.target)),
            ..ReduceParams::default()
        };
        let features = self.features.clone();
        let reduced = reduce_part((&cloud, &self.tree), features, &params, &whole, progress)?;
        let distances = if reduced.cloud.points.len() == self.tree.points.len() {
            vec![0.0; self.tree.points.len()]
        } else {
            let normals = reduced.cloud.normals.unwrap_or_default();
            let patches = Patches::fit(&Octree::build(&reduced.cloud.points), &normals);
            let denoised = |k| self.features.denoised(&self.tree, k);
            cloud_distances(denoised, &reduced.shares, &patches, progress)?
        };
        let side = self.side as f32;
        let inner: Vec<f32> = self.inner(distances.into_iter()).collect();
        Ok(inner.into_iter().map(move |distance| distance * side))
    }
}
