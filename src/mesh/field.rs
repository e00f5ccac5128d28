//! The local functions joined by a partition of unity (sections 3.1 and 4.2: "smoothly blended to form the overall
//! approximate surface").
//!
//! F(x) = Σ W_i(x) s_i f_i(x) / Σ W_i(x), with W_i(x) = Σ ψ(|x − p| / R_p) over the core sites p of sub-domain i, ψ
//! Wendland's C² function and R_p the reach of the site. Weights that hang on sites rather than on boxes fall with the
//! distance to the sheet, so that a thin wall's two sides hardly mix. Towards an opposite sheet that is within its reach a site
//! reaches no farther than that.
//!
//! Beyond all reaches F has no value. There the winding number of the oriented sites ([`crate::orient::winding`]) tells inside
//! from outside and closes holes.

use crate::base::kernel::wendland;
use crate::base::lanes::Lanes;
use crate::base::par;
use crate::cloud::neighborhood::Block;
use crate::cloud::octree::Octree;
use crate::features::noise::quantile;
use crate::fit::Fits;
use crate::fit::cells::{REACH, Sites};
use crate::fit::local::LocalFit;
use crate::mesh::surface::Implicit;
use crate::orient::Signs;
use crate::orient::winding::Winding;
use glam::{DVec3, Vec3};

/// The joined function: negative inside, positive outside, about the distance near the surface.
#[derive(Debug)]
pub struct Field<'a> {
    functions: &'a [LocalFit],
    signs: &'a [f32],
    tree: &'a Octree,
    /// R_p of every site, unit frame; 0 where the site is part of no surface.
    pub reach: Vec<f32>,
    /// Towards the opposite sheet, where it is near, and how much farther than it is a position on that side counts: the unit
    /// direction times √((R/L)² − 1) of its reach R and that to the opposite sheet, L. Else zero.
    squeeze: Vec<Vec3>,
    /// Sub-domain of every site.
    owner: Vec<u32>,
    /// Largest reach in each node of the tree.
    node_reach: Vec<f32>,
    winding: Winding<'a>,
    /// Value that stands for one whole turn of the winding number.
    depth: f64,
    /// See [`Implicit::sensor`]; empty where no sensor is known.
    sensor: &'a [Vec3],
    /// Whether the sites enclose something, so that the winding number tells inside from outside everywhere.
    solid: bool,
    /// Of the sites.
    noise: f64,
}

/// Share of the distance to the opposite sheet that a site reaches towards it: both sheets together leave no gap between them,
/// and neither says anything of the other.
const TOWARDS: f32 = 0.95;
/// Σ W_i below which functions are asked beyond their sites, more than about 1.3 spacings away from all: what they say of
/// inside and outside must not contradict the winding number. At 0.5 to 1.5 lobes that grow out of sparse and noisy parts
/// are gone (rms errors of four models that the bench does not use: 18 % less); farther in creases suffer.
const FAINT: f32 = 1.0;
/// Winding number that tells inside from outside against a function. Smooth parts are 6 % worse at 0.5.
const SURE: f32 = 0.6;
/// Sites that are asked whether the whole is solid, how many spacings inside of them, what the winding number is there, and
/// the share of them that must say so: closed scans have 98 % and more, a half ball 74 %,
/// three quarters of one 91 %.
const ASKED: usize = 512;
/// See [`ASKED`].
const DEEP: f32 = 2.0;
/// See [`ASKED`].
const INSIDE: f64 = 0.75;
/// See [`ASKED`].
const MOST_INSIDE: f64 = 0.95;

/// W_i of one sub-domain at eight positions, and for N = 4 its gradient behind it.
struct Part<const N: usize> {
    subdomain: u32,
    weight: [Lanes; N],
}

impl<'a> Field<'a> {
    /// Joins the functions. Cost: n log n.
    pub fn new(
        fits: &'a Fits,
        signs: &'a Signs,
        sites: &'a Sites,
        sensor: &'a [Vec3],
    ) -> Field<'a> {
        let tree = &sites.tree;
        let mut owner = vec![u32::MAX; tree.points.len()];
        for (s, subdomain) in fits.subdomains.iter().enumerate() {
            subdomain.support[..subdomain.core]
                .iter()
                .for_each(|&i| owner[i as usize] = s as u32);
        }
        let reach: Vec<f32> = par::map(
            owner.len(),
            || (),
            |i, ()| match owner[i] {
                s if s != u32::MAX && signs.kept[s as usize] => REACH * sites.of_one_sheet(i),
                _ => 0.0,
            },
        );
        let squeeze = sites.across.iter().zip(&reach);
        let squeeze = squeeze
            .map(|(&across, &reach)| {
                let ratio = reach / (TOWARDS * across.length());
                if across == Vec3::ZERO || ratio <= 1.0 {
                    return Vec3::ZERO;
                }
                across.normalize() * (ratio * ratio - 1.0).sqrt()
            })
            .collect();
        let node_reach = tree.largest(&reach);
        let depth = 4.0 * f64::from(quantile(sites.spacing.clone(), 2));
        let mut field = Field {
            functions: &fits.functions,
            signs: &signs.signs,
            tree,
            reach,
            squeeze,
            owner,
            node_reach,
            winding: Winding::new(tree, &signs.normals, &sites.spacing),
            depth,
            sensor,
            solid: false,
            noise: sites.noise.into(),
        };
        field.solid = field.is_solid(signs, sites);
        field
    }

    /// Whether the sites enclose something: whether the winding number is near 1 just inside of nearly all of some of them.
    fn is_solid(&self, signs: &Signs, sites: &Sites) -> bool {
        let n = self.tree.points.len();
        let asked = (0..n).step_by(n.div_ceil(ASKED).max(1));
        let inside = asked.clone().filter(|&i| {
            let x = self.tree.points[i] - signs.normals[i] * (DEEP * sites.spacing[i]);
            self.winding.around(x.as_dvec3(), 0.0) > INSIDE
        });
        inside.count() as f64 > MOST_INSIDE * asked.count() as f64
    }

    /// The parts of every sub-domain that reaches one of a block's positions, by sub-domain.
    fn weights<const N: usize>(&self, block: &Block, parts: &mut Vec<Part<N>>) {
        parts.clear();
        self.tree.visit(
            |id, node| {
                let r = self.node_reach[id];
                apart2((node.lo, node.hi), (block.lo, block.hi)) < r * r
            },
            |i| {
                let (p, r) = (self.tree.points[i], self.reach[i]);
                if p.distance_squared(p.clamp(block.lo, block.hi)) >= r * r {
                    return;
                }
                let [dx, dy, dz] = [0, 1, 2].map(|axis| block.at[axis] - Lanes::splat(p[axis]));
                let mut square = dx * dx + dy * dy + dz * dz;
                let mut away = [dx, dy, dz];
                let squeeze = self.squeeze[i];
                if squeeze != Vec3::ZERO {
                    let [sx, sy, sz] = squeeze.to_array().map(Lanes::splat);
                    let towards = (dx * sx + dy * sy + dz * sz).max(Lanes::ZERO);
                    square += towards * towards;
                    away = [dx + towards * sx, dy + towards * sy, dz + towards * sz];
                }
                let (weight, slope) = wendland(square.sqrt() * Lanes::splat(1.0 / r));
                let slope = slope * Lanes::splat(1.0 / (r * r));
                let terms = [weight, slope * away[0], slope * away[1], slope * away[2]];
                let weight = std::array::from_fn(|k| terms[k]);
                let subdomain = self.owner[i];
                // In this order their sums do not depend on which positions share a block.
                let place = parts.iter().take_while(|p| p.subdomain < subdomain).count();
                match parts.get_mut(place) {
                    Some(part) if part.subdomain == subdomain => {
                        for (sum, term) in part.weight.iter_mut().zip(weight) {
                            *sum += term;
                        }
                    }
                    _ => parts.insert(place, Part { subdomain, weight }),
                }
            },
        );
    }

    /// F(x) at a block's positions, and for N = 4 ∇F(x) behind it, and Σ W_i; NaN where no sub-domain reaches.
    fn blend<const N: usize>(
        &self,
        block: &Block,
        parts: &mut Vec<Part<N>>,
    ) -> ([Lanes; N], Lanes) {
        self.weights(block, parts);
        let (mut total, mut sum) = ([Lanes::ZERO; N], [Lanes::ZERO; N]);
        for Part { subdomain, weight } in parts.iter() {
            let s = *subdomain as usize;
            let sign = Lanes::splat(self.signs[s]);
            let f: [Lanes; N] = self.functions[s].evaluate(block.at);
            let (value, w_sign) = (f[0] * sign, weight[0] * sign);
            total[0] += weight[0];
            sum[0] += weight[0] * value;
            for k in 1..N {
                total[k] += weight[k];
                sum[k] += weight[k] * value + f[k] * w_sign;
            }
        }
        // Below this the quotient is rounding; the next site is a whole reach away.
        let (one, least) = (Lanes::splat(1.0), Lanes::splat(1e-6));
        let inverse = total[0].less(least, Lanes::splat(f32::NAN), one / total[0]);
        let value = sum[0] * inverse;
        let blended = std::array::from_fn(|k| match k {
            0 => value,
            _ => (sum[k] - total[k] * value) * inverse,
        });
        (blended, total[0])
    }

    /// [`Field::blend`] of all positions, eight at a time, without what the winding number contradicts.
    fn blend_all<const N: usize>(&self, at: &[DVec3], asked: &mut Asked) {
        asked.points.clear();
        asked.points.extend(at.iter().map(|x| x.as_vec3()));
        asked.blended.clear();
        asked.faint.clear();
        let mut parts = Vec::new();
        for block in Block::all(&asked.points, 0..at.len()) {
            let (blended, weight) = self.blend::<N>(&block, &mut parts);
            let (blended, weight) = (blended.map(Lanes::to_array), weight.to_array());
            for (l, k) in block.range.enumerate() {
                let values = std::array::from_fn(|n| if n < N { blended[n][l] } else { 0.0 });
                asked.blended.push(values);
                if self.solid && weight[l] < FAINT && !values[0].is_nan() {
                    asked.faint.push(k as u32);
                }
            }
        }
        self.doubt(asked);
    }

    /// Takes out the values at faint positions that the winding number contradicts.
    fn doubt(&self, asked: &mut Asked) {
        let faint = asked.faint.iter().map(|&k| asked.points[k as usize]);
        let faint: Vec<Vec3> = faint.collect();
        for block in Block::all(&faint, 0..faint.len()) {
            let turns = self.winding.around_block(&block).to_array();
            for (turns, &k) in turns.iter().zip(&asked.faint[block.range]) {
                let value = &mut asked.blended[k as usize][0];
                let denied = if *value < 0.0 {
                    *turns < 1.0 - SURE
                } else {
                    *value > 0.0 && *turns > SURE
                };
                if denied {
                    *value = f32::NAN;
                }
            }
        }
    }

    /// A continuation of F to all of space from the winding number: its zero set closes the holes of F's.
    pub fn extension(&self, x: DVec3) -> f64 {
        self.depth * (0.5 - self.winding.around(x, 0.0))
    }
}

/// Positions that are asked about, and what is known of them; the memory of one worker.
#[derive(Default)]
pub struct Asked {
    points: Vec<Vec3>,
    /// F and its gradient.
    blended: Vec<[f32; 4]>,
    /// Positions where the weights are below [`FAINT`].
    faint: Vec<u32>,
}

impl Implicit for Field<'_> {
    type Scratch = Asked;

    fn noise(&self) -> f64 {
        self.noise
    }

    fn scratch(&self) -> Asked {
        Asked::default()
    }

    fn global(&self, at: DVec3, _: &mut Asked) -> f64 {
        self.extension(at)
    }

    fn locals(&self, at: &[DVec3], values: &mut [f64], asked: &mut Asked) {
        self.blend_all::<1>(at, asked);
        for (value, blended) in values.iter_mut().zip(&asked.blended) {
            *value = f64::from(blended[0]);
        }
    }

    fn gradients(&self, at: &[DVec3], found: &mut [Option<(f64, DVec3)>], asked: &mut Asked) {
        self.blend_all::<4>(at, asked);
        for (found, &[value, slope @ ..]) in found.iter_mut().zip(&asked.blended) {
            let slope = Vec3::from_array(slope).as_dvec3();
            *found = (!value.is_nan()).then(|| (f64::from(value), slope));
        }
    }

    fn sensor(&self, point: usize) -> Vec3 {
        self.sensor.get(point).copied().unwrap_or_default()
    }
}

/// Squared distance between two boxes.
fn apart2(a: (Vec3, Vec3), b: (Vec3, Vec3)) -> f32 {
    (a.0 - b.1).max(b.0 - a.1).max(Vec3::ZERO).length_squared()
}
