//! A scan is measured by samples of some of its leaves.
//!
//! 1. Each sample tells noise, steps, spacing and whether its points lie on lines. What most of the scan has is the whole's.
//! 2. With that, all samples are measured again, as tiles are: curvature and area of the surface.
//! 3. The target becomes a law of the density and a scale: a share of the points here, a tolerance in [`super::tolerance`].
//! 4. Thin walls, where samples have some, take points from the rest.

use crate::base::error::{Error, Result};
use crate::base::progress::Progress;
use crate::cloud::octree::Octree;
use crate::features::Features;
use crate::features::lines::{self, Thinned};
use crate::features::noise::Scales;
use crate::reduce::law::{Law, Patch};
use crate::reduce::{WallShare, density, walls};
use crate::tiles::grid::Grid;
use crate::tiles::measured::Measured;
use crate::tiles::measures::{Aim, LineMeasures, Measures, Surface};
use crate::tiles::samples::Sample;
use crate::tiles::tolerance;

/// Measures a scan by its samples. `curvature_weight` is that of [`crate::ReduceParams`].
///
/// # Errors
/// [`Error::EmptyCloud`] without a point, [`Error::Cancelled`].
pub fn measure(
    samples: &[Sample],
    grid: Grid,
    (aim, curvature_weight): (Aim, f64),
    progress: &mut dyn Progress,
) -> Result<Measures> {
    let mut measured = Vec::new();
    for sample in samples.iter().filter(|sample| !sample.places.is_empty()) {
        measured.push(Measured::new(sample, grid, progress)?);
    }
    if measured.is_empty() {
        return Err(Error::EmptyCloud);
    }
    let surface = Surface::of(&measured);
    for m in &mut measured {
        m.features = Features::measure_part(&m.tree, &surface.known(m.side), progress)?;
    }
    let total: f64 = samples.iter().map(|sample| sample.points).sum();
    let patches: Vec<Patch> = measured.iter().flat_map(Measured::patches).collect();
    let area: f64 = patches.iter().map(|patch| patch.area * patch.weight).sum();
    let count = match aim {
        Aim::Ratio(ratio) => ratio * total,
        Aim::Count(count) => count,
        Aim::Spacing(spacing) => area / (spacing * spacing),
        Aim::Tolerance(_) => total,
    };
    let whole = Measures {
        noise: surface.noise,
        steps: surface.steps,
        median: surface.median,
        spacing: (area / total).sqrt(),
        target: (area / count.clamp(1.0, total)).sqrt(),
        lines: surface.lines,
        law: Law::of(&patches, curvature_weight),
        scale: 1.0,
        walls: None,
        tolerance: None,
        reach: 0.0,
    };
    let whole = match aim {
        Aim::Tolerance(asked) => {
            tolerance::within(&measured, (whole, area, grid), asked, progress)?
        }
        _ => shared(&measured, whole, count.clamp(1.0, total)),
    };
    let reach = whole.rule(0).reach;
    Ok(Measures { reach, ..whole })
}

/// The scale at which the law gives so many points, with walls apart.
fn shared(measured: &[Measured], whole: Measures, count: f64) -> Measures {
    let relative = |m: &Measured| {
        let law = whole.law.scaled(1.0 / m.side);
        density::relative_spacing(&m.tree, &m.features, &law)
    };
    let relative: Vec<Vec<f32>> = measured.iter().map(relative).collect();
    let (mut deserved, mut weights) = (Vec::new(), Vec::new());
    for (m, relative) in measured.iter().zip(&relative) {
        deserved.extend(m.inner(density::deserved(&m.features, relative)));
        weights.resize(deserved.len(), m.weight);
    }
    let first = density::scale_to(&deserved, |i| weights[i], count);
    let without = Measures {
        scale: first,
        ..whole
    };
    let unit = first.sqrt().recip() as f32;
    let (mut floors, mut are_thin) = (Vec::new(), false);
    for (m, relative) in measured.iter().zip(&relative) {
        let found = walls::floors(&m.tree, &m.features, |i| relative[i] * unit);
        are_thin |= found.is_some();
        let none = vec![0.0; m.counts.len()];
        floors.extend(m.inner(found.unwrap_or(none).into_iter()));
    }
    if !are_thin {
        return without;
    }
    let each = || deserved.iter().zip(&floors).zip(&weights);
    let shares = each().map(|((d, &floor), &w)| ((d * first).min(1.0), floor, w));
    let allowed = walls::allowed(shares.clone(), count);
    let raised: Vec<f64> = shares
        .map(|(s, f, _)| walls::raised(s, f, allowed))
        .collect();
    let points = deserved.iter().zip(&raised).zip(&weights);
    let scale = walls::scale_to(points.map(|((&d, &floor), &w)| (d, floor, w)), count);
    Measures {
        walls: Some(WallShare { scale, allowed }),
        ..without
    }
}

impl Surface {
    /// What most of the scan has, by samples that are measured each for itself.
    fn of(measured: &[Measured]) -> Surface {
        let median_of = |value: &dyn Fn(&Measured) -> f64| median_of(measured, value);
        let steps = median_of(&|m| f64::from(m.features.steps) * m.side);
        let total: f64 = measured.iter().map(Measured::points).sum();
        let share = measured.iter().map(|m| {
            let (on_lines, asked) = Thinned::asked(&m.tree);
            m.points() * on_lines as f64 / asked.max(1) as f64
        });
        let share = share.sum::<f64>() / total;
        if !lines::are_there(share as f32, 1.0) {
            return Surface {
                noise: median_of(&|m| f64::from(m.features.noise) * m.side),
                steps,
                median: median_of(&|m| f64::from(m.features.median_spacing()) * m.side),
                lines: None,
            };
        }
        let noise = median_of(&|m| f64::from(lines::noise(&m.tree)) * m.side).max(steps);
        let thinned: Vec<(f64, f64, f64)> = measured
            .iter()
            .map(|m| {
                let thinned = Thinned::along_lines(&m.tree);
                let most = thinned.noise_of_places((noise / m.side) as f32);
                let scales = Scales::measure(&Octree::build(&thinned.places)).at_most(most);
                let apart = f64::from(scales.spacing) * m.side;
                let points = thinned.place_of.len() as f64 / thinned.places.len() as f64;
                (f64::from(scales.noise) * m.side, apart, points)
            })
            .collect();
        let median = |value: fn(&(f64, f64, f64)) -> f64| {
            let values: Vec<f64> = thinned.iter().map(value).collect();
            weighted_median(values.iter().zip(measured).map(|(&v, m)| (v, m.points())))
        };
        Surface {
            noise,
            steps,
            median: median(|&(_, apart, points)| apart / points.sqrt()),
            lines: Some(LineMeasures {
                noise: median(|t| t.0).max(steps),
                spacing: median(|t| t.1),
                share,
            }),
        }
    }
}

fn median_of(measured: &[Measured], value: &dyn Fn(&Measured) -> f64) -> f64 {
    weighted_median(measured.iter().map(|m| (value(m), m.points())))
}

/// Of values with their weights, of which there is one at least.
fn weighted_median(values: impl Iterator<Item = (f64, f64)>) -> f64 {
    let mut values: Vec<(f64, f64)> = values.collect();
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = values.iter().map(|(_, weight)| weight).sum();
    let mut before = 0.0;
    let middle = values.iter().find(|(_, weight)| {
        before += weight;
        2.0 * before >= total
    });
    middle.or(values.first()).map_or(0.0, |(value, _)| *value)
}
