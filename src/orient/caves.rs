//! Closed components inside of others: which are the walls of caves (by the generalised winding number, as in
//! [`crate::orient::winding`]).

use crate::base::kernel::solid_angle;
use crate::base::par;
use crate::orient::domains::Domains;
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// Turns the closed components that an odd number of others have inside of them. All must look outward. Cost: a few samples
/// of each against every sub-domain of those whose box is around its own.
pub(crate) fn turn_caves(closed: &[&[u32]], domains: &Domains, signs: &mut [f32]) {
    let solids: Vec<Solid> = closed
        .iter()
        .map(|c| Solid::new(c, domains, signs))
        .collect();
    let is_cave = par::map(
        solids.len(),
        || (),
        |k, ()| {
            let around = solids.iter().filter(|s| s.holds(&solids[k]));
            around.count() % 2 == 1
        },
    );
    for (component, _) in closed.iter().zip(is_cave).filter(|c| c.1) {
        component
            .iter()
            .for_each(|&s| signs[s as usize] = -signs[s as usize]);
    }
}

/// A closed component that looks outward.
struct Solid {
    /// Corners of its sites' box.
    low: Vec3,
    high: Vec3,
    /// Some of its sites.
    samples: Vec<DVec3>,
    /// Centre and area vector of each sub-domain.
    dipoles: Vec<(DVec3, DVec3)>,
}

impl Solid {
    /// Sites that are asked whether they are in another solid: the mean over them is off by less than its margin, ½, even
    /// where the two nearly touch.
    const SAMPLES: usize = 16;

    fn new(component: &[u32], domains: &Domains, signs: &[f32]) -> Solid {
        let sites = domains.sites;
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let step = component.len().div_ceil(Solid::SAMPLES);
        let (mut samples, mut dipoles) = (Vec::new(), Vec::new());
        for (k, &s) in component.iter().enumerate() {
            let subdomain = &domains.fits.subdomains[s as usize];
            let core = &subdomain.support[..subdomain.core];
            let (mut center, mut moment) = (DVec3::ZERO, DVec3::ZERO);
            for (i, g) in domains.core(s) {
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
