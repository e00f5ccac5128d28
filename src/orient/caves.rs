//! Closed components inside of others: which are the walls of caves (by the generalised winding number, as in
//! [`crate::orient::winding`]).

use crate::base::kernel::solid_angle;
use crate::base::par;
use crate::fit::Fits;
use crate::fit::cells::Sites;
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// The components that an odd number of others have inside of them. Cost: a few samples of each against every sub-domain of
/// those whose box is around its own.
pub(crate) fn caves<'a>(solids: &[Solid<'a>]) -> Vec<&'a [u32]> {
    let is_cave = par::map(
        solids.len(),
        || (),
        |k, ()| {
            let around = solids.iter().filter(|s| s.holds(&solids[k]));
            around.count() % 2 == 1
        },
    );
    let with = solids.iter().zip(is_cave).filter(|s| s.1);
    with.map(|(solid, _)| solid.component).collect()
}

/// A closed component that looks outward.
pub(crate) struct Solid<'a> {
    component: &'a [u32],
    /// Corners of its sites' box.
    low: Vec3,
    high: Vec3,
    /// Some of its sites.
    samples: Vec<DVec3>,
    /// Centre and area vector of each sub-domain.
    dipoles: Vec<(DVec3, DVec3)>,
}

impl<'a> Solid<'a> {
    /// Sites that are asked whether they are in another solid: the mean over them is off by less than its margin, ½, even
    /// where the two nearly touch.
    const SAMPLES: usize = 16;

    pub(crate) fn new(
        component: &'a [u32],
        fits: &Fits,
        sites: &Sites,
        gradients: &[Vec<Vec3>],
        signs: &[f32],
    ) -> Solid<'a> {
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let step = component.len().div_ceil(Solid::SAMPLES);
        let (mut samples, mut dipoles) = (Vec::new(), Vec::new());
        for (k, &s) in component.iter().enumerate() {
            let subdomain = &fits.subdomains[s as usize];
            let core = &subdomain.support[..subdomain.core];
            let (mut center, mut moment) = (DVec3::ZERO, DVec3::ZERO);
            for (&i, &g) in core.iter().zip(&gradients[s as usize]) {
                let (p, h) = (sites.tree.points[i as usize], sites.spacing[i as usize]);
                (low, high) = (low.min(p), high.max(p));
                center += p.as_dvec3() / core.len() as f64;
                moment += (g * (signs[s as usize] * h * h)).as_dvec3();
            }
            if k % step == 0 {
                samples.push(sites.tree.points[core[0] as usize].as_dvec3());
            }
            dipoles.push((center, moment));
        }
        Solid {
            component,
            low,
            high,
            samples,
            dipoles,
        }
    }

    /// Whether `other` lies inside: by the winding number.
    fn holds(&self, other: &Solid) -> bool {
        let is_within = self.low.cmplt(other.low).all() && other.high.cmplt(self.high).all();
        let winding = |x: &DVec3| -> f64 {
            let turns = self.dipoles.iter().map(|&(c, a)| solid_angle(c - *x, a));
            turns.sum::<f64>() / (4.0 * PI)
        };
        let n = other.samples.len() as f64;
        is_within && other.samples.iter().map(winding).sum::<f64>() > 0.5 * n
    }
}
