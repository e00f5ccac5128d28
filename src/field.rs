//! The local functions joined by a partition of unity (sections 3.1 and 4.2: "smoothly blended to form the overall
//! approximate surface").
//!
//! F(x) = Σ W_i(x) s_i f_i(x) / Σ W_i(x), with W_i(x) = Σ ψ(|x − p| / R_p) over the core sites p of sub-domain i, ψ
//! Wendland's C² function and R_p the reach of the site. Weights that hang on sites rather than on boxes fall with the
//! distance to the sheet, so that a thin wall's two sides hardly mix.
//!
//! Beyond all reaches F has no value. There the generalised winding number of the oriented sites (Jacobson, Kavan,
//! Sorkine-Hornung, 2013; evaluated by a tree of dipoles: Barill et al., "Fast winding numbers for soups and clouds",
//! 2018) tells inside from outside and closes holes.

use crate::cells::Sites;
use crate::extract::Implicit;
use crate::fit::{Fits, LocalFit};
use crate::kernel::{solid_angle, wendland};
use crate::octree::Octree;
use crate::orient::Signs;
use glam::{DVec3, Vec3};

/// The joined function: negative inside, positive outside, about the distance near the surface.
#[derive(Debug)]
pub struct Field<'a> {
    functions: &'a [LocalFit],
    signs: &'a [f32],
    tree: &'a Octree,
    /// R_p of every site, unit frame; 0 where the site is part of no surface.
    pub reach: Vec<f32>,
    /// Sub-domain of every site.
    owner: Vec<u32>,
    /// Largest reach in each node of the tree.
    node_reach: Vec<f32>,
    dipoles: Vec<Dipole>,
    /// Σ area · normal of each site.
    areas: Vec<Vec3>,
    /// Value that stands for one whole turn of the winding number.
    depth: f64,
}

/// The sites of a node seen from far away.
#[derive(Debug, Clone, Copy)]
struct Dipole {
    center: DVec3,
    /// Σ area · normal.
    moment: DVec3,
    radius: f64,
}

/// Reach in spacings: the ball holds about 16 sites of the sheet, so that no gap of the sampling is left out.
const REACH: f32 = 2.2;
/// A node farther away than this times its radius is a dipole. 2 gives the winding number to about 0.01 (Barill et al.,
/// section 4.4).
const FAR: f64 = 2.0;

/// Scratch of one evaluating worker.
#[derive(Debug, Default, Clone)]
pub struct Scratch {
    /// Sub-domain, weight, weight gradient.
    weights: Vec<(u32, f32, Vec3)>,
}

impl<'a> Field<'a> {
    /// Joins the functions. Cost: n log n.
    pub fn new(fits: &'a Fits, signs: &'a Signs, sites: &'a Sites) -> Field<'a> {
        let tree = &sites.tree;
        let mut owner = vec![u32::MAX; tree.points.len()];
        for (s, subdomain) in fits.subdomains.iter().enumerate() {
            subdomain.support[..subdomain.core]
                .iter()
                .for_each(|&i| owner[i as usize] = s as u32);
        }
        let reach: Vec<f32> = sites
            .spacing
            .iter()
            .zip(&owner)
            .map(|(&h, &s)| {
                if s != u32::MAX && signs.kept[s as usize] {
                    REACH * h
                } else {
                    0.0
                }
            })
            .collect();
        let node_reach = tree
            .nodes
            .iter()
            .map(|n| reach[n.range()].iter().copied().fold(0.0, f32::max))
            .collect();
        let areas: Vec<Vec3> = signs
            .normals
            .iter()
            .zip(&sites.spacing)
            .map(|(&n, &h)| n * (h * h))
            .collect();
        let dipoles = tree
            .nodes
            .iter()
            .map(|node| {
                let center = ((node.lo + node.hi) * 0.5).as_dvec3();
                let moment = areas[node.range()].iter().map(|a| a.as_dvec3()).sum();
                Dipole {
                    center,
                    moment,
                    radius: ((node.hi - node.lo) * 0.5).as_dvec3().length(),
                }
            })
            .collect();
        let mut spacings = sites.spacing.clone();
        spacings.sort_unstable_by(f32::total_cmp);
        let depth = 4.0 * spacings[spacings.len() / 2] as f64;
        Field {
            functions: &fits.functions,
            signs: &signs.signs,
            tree,
            reach,
            owner,
            node_reach,
            dipoles,
            areas,
            depth,
        }
    }

    /// W_i and its gradient of every sub-domain that reaches `x`.
    fn weights(&self, x: Vec3, out: &mut Vec<(u32, f32, Vec3)>) {
        out.clear();
        self.tree.visit(
            |id, node| {
                let r = self.node_reach[id];
                node.distance2(x) < r * r
            },
            |i| {
                let r = self.reach[i];
                let d = x - self.tree.points[i];
                let d2 = d.length_squared();
                if d2 < r * r {
                    let (w, slope) = wendland((d2.sqrt() / r) as f64);
                    let (w, gradient) = (w as f32, d * (slope as f32 / (r * r)));
                    match out.iter_mut().find(|o| o.0 == self.owner[i]) {
                        Some(o) => *o = (o.0, o.1 + w, o.2 + gradient),
                        None => out.push((self.owner[i], w, gradient)),
                    }
                }
            },
        );
    }

    /// F(x), `None` where no sub-domain reaches.
    pub fn value(&self, x: Vec3, scratch: &mut Scratch) -> Option<f32> {
        self.value_and_gradient(x, scratch).map(|v| v.0)
    }

    /// F(x) and ∇F(x), `None` where no sub-domain reaches.
    pub fn value_and_gradient(&self, x: Vec3, scratch: &mut Scratch) -> Option<(f32, Vec3)> {
        self.weights(x, &mut scratch.weights);
        let mut total = 0.0;
        let mut total_gradient = Vec3::ZERO;
        let mut sum = 0.0;
        let mut sum_gradient = Vec3::ZERO;
        for &(s, w, dw) in &scratch.weights {
            let sign = self.signs[s as usize];
            let (f, df) = self.functions[s as usize].evaluate(x);
            total += w;
            total_gradient += dw;
            sum += w * sign * f;
            sum_gradient += dw * (sign * f) + df * (w * sign);
        }
        // Below this the quotient is rounding; the next site is a whole reach away.
        if total < 1e-6 {
            return None;
        }
        let value = sum / total;
        Some((value, (sum_gradient - total_gradient * value) / total))
    }

    /// The winding number of the oriented sites around `x`: about 1 inside, 0 outside, between in a hole.
    pub fn winding(&self, x: DVec3) -> f64 {
        let mut sum = 0.0;
        let mut stack = vec![0];
        while let Some(id) = stack.pop() {
            let (node, dipole) = (&self.tree.nodes[id], &self.dipoles[id]);
            let far = (dipole.center - x).length_squared() > (FAR * dipole.radius).powi(2);
            if far {
                sum += solid_angle(dipole.center - x, dipole.moment);
            } else if node.is_leaf() {
                for i in node.range() {
                    sum +=
                        solid_angle(self.tree.points[i].as_dvec3() - x, self.areas[i].as_dvec3());
                }
            } else {
                stack.extend(node.child_ids());
            }
        }
        sum / (4.0 * std::f64::consts::PI)
    }

    /// A continuation of F to all of space from the winding number: its zero set closes the holes of F's.
    pub fn extension(&self, x: DVec3) -> f64 {
        self.depth * (0.5 - self.winding(x))
    }
}

impl Implicit for Field<'_> {
    type Scratch = Scratch;

    fn scratch(&self) -> Scratch {
        Scratch::default()
    }

    fn local(&self, at: DVec3, scratch: &mut Scratch) -> Option<f64> {
        self.value(at.as_vec3(), scratch).map(f64::from)
    }

    fn global(&self, at: DVec3, _: &mut Scratch) -> f64 {
        self.extension(at)
    }

    fn gradient(&self, at: DVec3, scratch: &mut Scratch) -> Option<(f64, DVec3)> {
        let (value, gradient) = self.value_and_gradient(at.as_vec3(), scratch)?;
        Some((value as f64, gradient.as_dvec3()))
    }
}
