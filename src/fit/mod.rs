//! One local implicit function a sub-domain: radial basis functions and a linear polynomial (section 4.1, eq. 9-11).
//!
//! f(x) = Σ w_i φ(|x − c_i|) + λ0 + λ1 x + λ2 y + λ3 z (eq. 9, 10) with f = 0 at the sites and f = ±d at offset points
//! along the normal; the weights are orthogonal to linear polynomials (the lower rows of eq. 11). The offset points
//! c_i are centres too. A ridge on the diagonal smooths.
//!
//! Every function is right up to its sign: f and −f fit the sites equally well, and [`crate::orient`] chooses.
//!
//! 1. [`cells`]: the sites are divided into overlapping sub-domains.
//! 2. Fit: `system` solves each sub-domain's eq. 11; [`local`] evaluates its function.
//! 3. A sub-domain whose residual is beyond the accuracy asked for is divided and fitted again.
//! 4. `faces`: which of two crossing sheets each part of a sub-domain belongs to, where the caller wants sharp edges.
//!
//! **In**: sites (positions, spacing, unoriented normals) in the unit frame. **Out**: [`Fits`], one function for each sub-domain
//! with its domain, and the residual at every input point.
//!
//! **Cost**: one dense Cholesky factor for each sub-domain, cubic in its sites, whose number is bounded: linear in the points.

pub mod cells;
pub(crate) mod faces;
pub mod local;
mod system;

use crate::base::error::Result;
use crate::base::par;
use crate::base::params::{Smoothing, SurfaceParams};
use crate::base::progress::{Progress, Stage};
use crate::fit::cells::{Growth, Sites, Subdomain};
use crate::fit::faces::Faces;
use crate::fit::local::{LocalFit, Rbf};
use crate::fit::system::System;
use glam::Vec3;

/// What the fit of all sub-domains gave.
#[derive(Debug, Clone)]
pub struct Fits {
    /// The sub-domains, those that were refined in place of what they were cut from.
    pub subdomains: Vec<Subdomain>,
    /// One function a sub-domain.
    pub functions: Vec<LocalFit>,
    /// How many sub-domains were cut.
    pub refinements: usize,
    /// Distances of the input points to the function of their sub-domain.
    pub residuals: Vec<f32>,
}

/// Share of the smooth function's squared distances to the input that functions of faces must stay under. At 1 edges are 2 %
/// better and a few sites at them worse oriented.
const SHARPER: f64 = 0.9;
/// Rms distance to the input, in spacings, at which they do as well: through the input's own points the smooth function
/// passes whatever is between them. 0.02 starts to put creases on smooth models.
const CLOSE: f32 = 0.01;
/// How often a sub-domain may be cut.
const MAX_CUTS: usize = 2;
/// Fits every sub-domain and refines those that miss the accuracy at the `input` points, each of which stands for the site
/// that `site_of` names, if any.
///
/// A sub-domain is cut in two and fitted again when the rms distance of the input points nearest to its core exceeds
/// `accuracy` and what the noise explains (section 5: "computed and refined until desired accuracy"), and stays cut where
/// that brings it nearer to them.
pub fn fit(
    subdomains: Vec<Subdomain>,
    sites: &Sites,
    (input, site_of): (&[Vec3], impl Iterator<Item = Option<u32>>),
    input_noise: f32,
    params: &SurfaceParams,
    progress: &mut dyn Progress,
) -> Result<Fits> {
    let mut owned = vec![Vec::new(); sites.tree.points.len()];
    for (i, site) in site_of.enumerate() {
        if let Some(site) = site {
            owned[site as usize].push(i as u32);
        }
    }
    let fitting = Fitting {
        sites,
        input,
        owned,
        allowed: (params.accuracy as f32).max(1.25 * input_noise),
        params,
    };
    let done = par::map_progress(
        subdomains.len(),
        150.0,
        (Stage::Fit, progress),
        || Growth::new(sites.tree.points.len()),
        |i, growth| fitting.refine(subdomains[i].clone(), 0, growth),
    )?;
    let mut fits = Fits {
        subdomains: Vec::new(),
        functions: Vec::new(),
        refinements: 0,
        residuals: vec![0.0; input.len()],
    };
    for refined in done {
        fits.refinements += refined.len().saturating_sub(1);
        for (subdomain, function, residuals) in refined {
            for (i, r) in residuals {
                fits.residuals[i as usize] = r;
            }
            fits.subdomains.push(subdomain);
            fits.functions.push(function);
        }
    }
    Ok(fits)
}

/// A fitted sub-domain and the residuals of its input points.
type Refined = (Subdomain, LocalFit, Vec<(u32, f32)>);

/// What the refinement of every sub-domain reads.
struct Fitting<'a> {
    sites: &'a Sites,
    input: &'a [Vec3],
    /// For every site the input points that it stands for.
    owned: Vec<Vec<u32>>,
    /// Largest rms residual that is not refined.
    allowed: f32,
    params: &'a SurfaceParams,
}

impl Fitting<'_> {
    /// The function of one sub-domain, which owns the input points `at`: that of its faces where it is nearer to them.
    fn function(&self, subdomain: &Subdomain, at: &[Vec3]) -> LocalFit {
        let support = subdomain.support.iter().copied();
        let all: Vec<(u32, Vec3)> = support.zip(subdomain.normals.iter().copied()).collect();
        let smooth = LocalFit {
            faces: vec![self.solve(subdomain, &all)],
            concave: false,
        };
        if !self.params.sharp {
            return smooth;
        }
        let Some(faces) = Faces::of(subdomain, self.sites) else {
            return smooth;
        };
        let creased = LocalFit {
            faces: faces
                .sites
                .iter()
                .map(|face| self.solve(subdomain, face))
                .collect(),
            concave: faces.concave,
        };
        let error = |f: &LocalFit| f.distances(at).map(|d| f64::from(d * d)).sum::<f64>();
        let spacing = self.sites.spacing[subdomain.support[0] as usize];
        let close = f64::from(CLOSE * spacing).powi(2) * at.len() as f64;
        if error(&creased) < (SHARPER * error(&smooth)).max(close) {
            creased
        } else {
            smooth
        }
    }

    /// The smooth function through some sites of a sub-domain.
    fn solve(&self, subdomain: &Subdomain, through: &[(u32, Vec3)]) -> Rbf {
        let system = System::new(through, subdomain, self.sites, self.params.kernel);
        let solved = match self.params.smoothing {
            Smoothing::Ridge(ridge) => system.solve(ridge * system.unit_phi),
            Smoothing::Auto => system.solve(system.ridge_for(self.sites.noise as f64)),
        };
        solved.unwrap_or_else(|| system.plane(through))
    }

    /// The fit of a sub-domain, or of what it was cut into where that is nearer to the input: a cut that does not help is
    /// taken back.
    fn refine(&self, subdomain: Subdomain, cuts: usize, growth: &mut Growth) -> Vec<Refined> {
        let own: Vec<u32> = subdomain.support[..subdomain.core]
            .iter()
            .flat_map(|&i| &self.owned[i as usize])
            .copied()
            .collect();
        let at: Vec<Vec3> = own.iter().map(|&i| self.input[i as usize]).collect();
        let function = self.function(&subdomain, &at);
        let residuals: Vec<(u32, f32)> = own.into_iter().zip(function.distances(&at)).collect();
        let whole = vec![(subdomain, function, residuals)];
        let (subdomain, _, residuals) = &whole[0];
        let rms = (squares(&whole) / residuals.len().max(1) as f64).sqrt() as f32;
        if rms <= self.allowed || cuts == MAX_CUTS || subdomain.core < 4 {
            return whole;
        }
        let cut: Vec<Refined> = subdomain
            .split(self.sites, growth)
            .into_iter()
            .flat_map(|half| self.refine(half, cuts + 1, growth))
            .collect();
        if squares(&cut) < squares(&whole) {
            cut
        } else {
            whole
        }
    }
}

/// Sum of the squared residuals.
fn squares(fits: &[Refined]) -> f64 {
    let residuals = fits.iter().flat_map(|(_, _, residuals)| residuals);
    residuals.map(|&(_, r)| (r as f64).powi(2)).sum()
}
