//! What orientation asks of the fitted sub-domains: their gradients, normals, areas, what they enclose.

use crate::base::error::Result;
use crate::base::par;
use crate::base::progress::{Progress, Stage};
use crate::cloud::octree::Octree;
use crate::fit::Fits;
use crate::fit::cells::Sites;
use crate::orient::winding::Winding;
use glam::Vec3;

/// The sub-domains with the unit gradients of their functions.
#[derive(Debug)]
pub(crate) struct Domains<'a> {
    pub(crate) fits: &'a Fits,
    pub(crate) sites: &'a Sites,
    /// At every site of each sub-domain's support.
    pub(crate) gradients: Vec<Vec<Vec3>>,
}

impl<'a> Domains<'a> {
    /// Sites that are asked what encloses them: the mean over them is off by 0.01.
    const ASKED: usize = 500;

    pub(crate) fn new(
        fits: &'a Fits,
        sites: &'a Sites,
        progress: &mut dyn Progress,
    ) -> Result<Domains<'a>> {
        let gradients = par::map_progress(
            fits.functions.len(),
            15.0,
            (Stage::Orient, progress),
            || (),
            |i, _| {
                let support = fits.subdomains[i].support.iter();
                let at: Vec<Vec3> = support.map(|&i| sites.tree.points[i as usize]).collect();
                let values = fits.functions[i].evaluate_all(&at).into_iter();
                values
                    .map(|v| v.1.normalize_or_zero())
                    .collect::<Vec<Vec3>>()
            },
        )?;
        Ok(Domains {
            fits,
            sites,
            gradients,
        })
    }

    pub(crate) fn len(&self) -> usize {
        self.gradients.len()
    }

    /// The sites that only this sub-domain has as core, each with its gradient.
    pub(crate) fn core(&self, s: u32) -> impl Iterator<Item = (u32, Vec3)> + '_ {
        let subdomain = &self.fits.subdomains[s as usize];
        let core = subdomain.support[..subdomain.core].iter().copied();
        core.zip(self.gradients[s as usize].iter().copied())
    }

    /// The area that a site stands for.
    pub(crate) fn site_area(&self, i: u32) -> f32 {
        self.sites.spacing[i as usize].powi(2)
    }

    /// The area of a sub-domain's core.
    pub(crate) fn area(&self, s: u32) -> f32 {
        self.core(s).map(|(i, _)| self.site_area(i)).sum()
    }

    /// Centre of each sub-domain's core.
    pub(crate) fn centers(&self) -> Vec<Vec3> {
        let center = |s: u32| {
            let at = self
                .core(s)
                .map(|(i, _)| self.sites.tree.points[i as usize]);
            at.sum::<Vec3>() / self.fits.subdomains[s as usize].core.max(1) as f32
        };
        (0..self.len() as u32).map(center).collect()
    }

    /// The mean unit normal of each sub-domain, with its sign.
    pub(crate) fn mean_normals(&self, signs: &[f32]) -> Vec<Vec3> {
        let mean = |(s, sign): (u32, &f32)| {
            let sum: Vec3 = self.core(s).map(|(_, g)| g).sum();
            sum.normalize_or_zero() * *sign
        };
        (0..).zip(signs).map(mean).collect()
    }

    /// The oriented normal of every site: the gradient of the function whose core it is in.
    pub(crate) fn site_normals(&self, signs: &[f32]) -> Vec<Vec3> {
        let mut normals = vec![Vec3::ZERO; self.sites.tree.points.len()];
        for (s, &sign) in (0..).zip(signs) {
            for (i, g) in self.core(s) {
                normals[i as usize] = g * sign;
            }
        }
        normals
    }

    /// [`Domains::site_normals`], but for sites at which the other functions that were fitted to them say the opposite: theirs.
    /// A site far off the sheet, in noise, bends the one function of which it is the end.
    pub(crate) fn agreed_normals(&self, signs: &[f32]) -> Vec<Vec3> {
        let mut sums = vec![Vec3::ZERO; self.sites.tree.points.len()];
        for ((subdomain, gradients), sign) in
            self.fits.subdomains.iter().zip(&self.gradients).zip(signs)
        {
            for (&i, &g) in subdomain.support.iter().zip(gradients) {
                sums[i as usize] += g * *sign;
            }
        }
        let mut normals = self.site_normals(signs);
        for (normal, sum) in normals.iter_mut().zip(sums) {
            if normal.dot(sum) < 0.0 {
                *normal = sum.normalize_or_zero();
            }
        }
        normals
    }

    /// Mean winding number of some sub-domains' sites around themselves, by area: ½ for what is closed and looks out, 0 for a
    /// flat sheet, −½ for what looks in.
    pub(crate) fn enclosed(&self, part: &[u32], signs: &[f32]) -> f64 {
        let each = || part.iter().flat_map(|&s| self.core(s).map(move |c| (s, c)));
        let at: Vec<Vec3> = each()
            .map(|(_, (i, _))| self.sites.tree.points[i as usize])
            .collect();
        if at.is_empty() {
            return 0.0;
        }
        let normals: Vec<Vec3> = each().map(|(s, (_, g))| g * signs[s as usize]).collect();
        let spacing: Vec<f32> = each()
            .map(|(_, (i, _))| self.sites.spacing[i as usize])
            .collect();
        let tree = Octree::build(&at);
        let ordered = |k: &u32| (normals[*k as usize], spacing[*k as usize]);
        let (normals, spacing): (Vec<Vec3>, Vec<f32>) = tree.order.iter().map(ordered).unzip();
        mean_winding(&tree, &normals, &spacing)
    }

    /// The winding number of the whole surface at some sub-domains: the mean over a few sites of each. What lies within a
    /// spacing hardly counts, as it is the sub-domain itself.
    pub(crate) fn winding(&self, which: &[u32], signs: &[f32]) -> Vec<f64> {
        /// Sites of each, at most.
        const SAMPLES: usize = 4;
        let sites = self.sites;
        let normals = self.site_normals(signs);
        let winding = Winding::new(&sites.tree, &normals, &sites.spacing);
        let mean = |k: usize| {
            let subdomain = &self.fits.subdomains[which[k] as usize];
            let step = subdomain.core.div_ceil(SAMPLES);
            let samples = subdomain.support[..subdomain.core].iter().step_by(step);
            let at = |&i: &u32| {
                let (p, blur) = (sites.tree.points[i as usize], sites.spacing[i as usize]);
                winding.around(p.as_dvec3(), f64::from(blur))
            };
            samples.map(at).sum::<f64>() / subdomain.core.div_ceil(step) as f64
        };
        par::map(which.len(), || (), |k, ()| mean(k))
    }
}

/// Mean winding number of a tree's points around themselves, by area, at some of them.
pub(crate) fn mean_winding(tree: &Octree, normals: &[Vec3], spacing: &[f32]) -> f64 {
    let winding = Winding::new(tree, normals, spacing);
    let n = tree.points.len();
    let step = n.div_ceil(Domains::ASKED).max(1);
    let asked: Vec<usize> = (0..n).step_by(step).collect();
    let weighted = par::map(
        asked.len(),
        || (),
        |k, ()| {
            let i = asked[k];
            let h = f64::from(spacing[i]);
            (h * h, h * h * winding.around(tree.points[i].as_dvec3(), h))
        },
    );
    let area: f64 = weighted.iter().map(|w| w.0).sum();
    weighted.iter().map(|w| w.1).sum::<f64>() / area.max(f64::MIN_POSITIVE)
}
