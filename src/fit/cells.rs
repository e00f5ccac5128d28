//! Sub-domains with overlap: an octree cell's points and those around them, one sheet of the surface each.
//!
//! A sub-domain has one sign, so it must hold one sheet: it grows along the neighbour graph only over *compatible* pairs
//! (normals within 70°, offset along the normals small against the distance). A chain of such pairs may still lead around
//! the thin edge of a wedge onto its other side, so a site must also stand to all its neighbours that are in the
//! sub-domain as sites of one sheet do. Points of a cell that cannot be reached that way belong to another sheet and make
//! a sub-domain of their own.

use crate::base::error::Result;
use crate::base::kernel::dipoles;
use crate::base::par;
use crate::base::progress::{Progress, Stage};
use crate::base::sort_keys::{key, pack, unpack};
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;
use crate::features::opposite::across;
use glam::Vec3;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The points that surfaces are fitted to; all arrays in the tree's order.
#[derive(Debug, Clone)]
pub struct Sites {
    /// Positions in the unit frame and their neighbours.
    pub tree: Octree,
    /// Unit normals; of arbitrary sign unless `oriented`. Zero where there is none.
    pub normals: Vec<Vec3>,
    /// Distance of neighbours on the surface.
    pub spacing: Vec<f32>,
    /// Who is next to whom.
    pub graph: Graph,
    /// Standard deviation of the noise across the surface.
    pub noise: f32,
    /// Whether the normals' signs are the caller's and to be kept.
    pub oriented: bool,
    /// From each site straight across to the opposite sheet, where one is within its reach; else zero.
    pub across: Vec<Vec3>,
}

/// Reach of a site in spacings: the ball holds about 16 sites of the sheet, so that no gap of the sampling is left out.
pub(crate) const REACH: f32 = 2.2;
/// A site's spacing is at most this times the median of its neighbours': a straggler far from the surface has neighbours
/// on it, and must not reach as far as it is lonely.
const MOST_SPACING: f32 = 1.5;

impl Sites {
    /// Gathers them. Cost: one k-nearest query a site.
    pub fn new(
        tree: Octree,
        normals: Vec<Vec3>,
        spacing: Vec<f32>,
        noise: f32,
        oriented: bool,
        progress: &mut dyn Progress,
    ) -> Result<Sites> {
        let graph = Graph::build(&tree, progress)?;
        let capped = |i: usize| {
            let mut near: Vec<f32> = graph
                .of(i as u32)
                .iter()
                .map(|&j| spacing[j as usize])
                .collect();
            near.sort_unstable_by(f32::total_cmp);
            near.get(near.len() / 2)
                .map_or(spacing[i], |&m| spacing[i].min(MOST_SPACING * m))
        };
        let spacing = (0..spacing.len()).map(capped).collect();
        let mut sites = Sites {
            tree,
            normals,
            spacing,
            graph,
            noise,
            oriented,
            across: Vec::new(),
        };
        if !oriented {
            sites.mend_normals();
        }
        sites.across = sites.opposite(noise);
        Ok(sites)
    }

    /// From each site to the opposite sheet, if one is near and half of the sites around it on its own sheet see theirs there, too.
    /// At a corner a single one may see what is none.
    fn opposite(&self, noise: f32) -> Vec<Vec3> {
        /// Sites that are asked, one more than its neighbours.
        const ASKED: usize = 13;
        let found: Vec<Vec3> = par::map(self.spacing.len(), Vec::new, |i, steps| {
            let within = (REACH * self.spacing[i], noise);
            across(&self.tree, &self.normals, i, within, steps)
        });
        par::map(found.len(), Vec::new, |i, near| {
            let own = found[i];
            if own == Vec3::ZERO {
                return own;
            }
            let p = self.tree.points[i];
            self.tree.knn(p, ASKED, near);
            near.retain(|n| {
                let off = (self.tree.points[n.index as usize] - p).dot(own);
                off.abs() < 0.5 * own.length_squared()
            });
            let sees = |n: &&Neighbor| found[n.index as usize].dot(own) > 0.0;
            let agree = near.iter().filter(sees).count();
            if 2 * agree > near.len() {
                own
            } else {
                Vec3::ZERO
            }
        })
    }

    /// The spacing of a site; beside an opposite sheet that of its own alone, which looks nearly twice as dense with the other.
    pub(crate) fn of_one_sheet(&self, i: usize) -> f32 {
        let (p, across, spacing) = (self.tree.points[i], self.across[i], self.spacing[i]);
        if across == Vec3::ZERO {
            return spacing;
        }
        let (radius, half2) = (REACH * spacing, across.length_squared() / 2.0);
        let mut own = 0.0;
        self.tree.visit(
            |_, node| node.distance2(p) < radius * radius,
            |j| {
                let d = self.tree.points[j] - p;
                let is_own = d.length_squared() < radius * radius && d.dot(across).abs() < half2;
                own += f32::from(u8::from(is_own));
            },
        );
        let alone = radius * (std::f32::consts::PI / own).sqrt();
        alone.clamp(spacing, MOST_SPACING * spacing)
    }

    /// Distances to the opposite sheet, where one is near.
    pub(crate) fn thickness(&self) -> impl Iterator<Item = f32> {
        let across = self.across.iter().map(|d| d.length());
        across.filter(|&t| t > 0.0)
    }

    /// Gives a site whose normal agrees with no neighbour's the one of theirs that agrees with the most: where two sheets
    /// are near, the plane through a site's neighbours may lie across both.
    fn mend_normals(&mut self) {
        let mend = |i: usize| {
            let i = i as u32;
            let count = |normal: Vec3| {
                let near = self.graph.of(i).iter();
                near.filter(|&&j| agree(self, (i, normal), j)).count()
            };
            let own = self.normals[i as usize];
            if own == Vec3::ZERO || count(own) > 0 {
                return own;
            }
            let near = self.graph.of(i).iter().map(|&j| self.normals[j as usize]);
            let others = near.filter(|&n| n != Vec3::ZERO).map(|n| (count(n), n));
            // The nearest of those with the most.
            let best = others.reduce(|best, n| if n.0 > best.0 { n } else { best });
            best.map_or(own, |(_, normal)| normal)
        };
        self.normals = par::map(self.normals.len(), || (), |i, ()| mend(i));
    }
}

/// A sub-domain Ω_i.
#[derive(Debug, Clone, PartialEq)]
pub struct Subdomain {
    /// Its sites: first the `core` ones that only it holds as core, then those shared with others.
    pub support: Vec<u32>,
    /// How many of `support` are its own.
    pub core: usize,
    /// Normals of the support; signs agree within the sub-domain.
    pub normals: Vec<Vec3>,
}

/// Most core sites of a sub-domain. A cell of 10 to 16 with half as many around it balances the number of fits against
/// their cubic cost.
const CORE: usize = 16;
/// Sites shared with others, without noise and at a noise of half a spacing and more.
const OVERLAP: [f32; 2] = [18.0, 34.0];
/// Neighbours in the graph.
const GRAPH: usize = 10;
/// Cosine of 70°, the largest turn between compatible normals.
const MIN_COSINE: f32 = 0.342;
/// Largest offset along the normal against the distance; sin 45° and a margin, so that a right-angled crease connects.
const MAX_SLOPE: f32 = 0.75;
/// Largest offset against the distance that both normals see on the same side. A bent sheet leaves one tangent plane
/// downwards and meets the other from below: that is its turn, not a step. Two sheets are a step apart for both.
const MAX_STEP: f32 = 0.25;
/// Least mean of [`dipoles`] between a site and its neighbours in a sub-domain, for it to become one of the core, and one of
/// the overlap: on one flat sheet they are 1, between sheets under 0 where they are nearer than 0.7 of the distance
/// along them. Cores must be of one sheet to have a sign; overlaps that end too early leave a thin and noisy cloud in
/// pieces. Of −0.3 to 0.7, on wedges, plates, thin shells and the samples, with and without noise: 0.3 and 0.5 are best
/// for cores (0.7 turns whole branches of noisy ones), 0 for overlaps.
const TOGETHER: [f32; 2] = [0.5, 0.0];
/// Variances of the noise that squared distances are raised by for that: 2 cuts noisy fins of a few spacings off, with 30
/// thin plates stay mixed.
const BLUR: f32 = 10.0;
/// Sites closer than this times their spacing are one centre: eq. 11 would be singular.
const COINCIDENT: f32 = 0.02;

/// The neighbour graph of the sites, [`GRAPH`] a site at most.
#[derive(Debug, Clone)]
pub struct Graph {
    starts: Vec<u32>,
    targets: Vec<u32>,
}

impl Graph {
    fn build(tree: &Octree, progress: &mut dyn Progress) -> Result<Graph> {
        let lists = par::map_progress(
            tree.points.len(),
            2.0,
            (Stage::Cells, progress),
            Vec::new,
            |i, found: &mut Vec<Neighbor>| {
                tree.knn(tree.points[i], GRAPH + 1, found);
                found
                    .iter()
                    .map(|n| n.index)
                    .filter(|&j| j != i as u32)
                    .collect::<Vec<_>>()
            },
        )?;
        let mut graph = Graph {
            starts: vec![0],
            targets: Vec::with_capacity(lists.len() * GRAPH),
        };
        for list in lists {
            graph.targets.extend(list);
            graph.starts.push(graph.targets.len() as u32);
        }
        Ok(graph)
    }

    /// The neighbours of site `i`, nearest first.
    pub fn of(&self, i: u32) -> &[u32] {
        &self.targets[self.starts[i as usize] as usize..self.starts[i as usize + 1] as usize]
    }
}

/// The sub-domains in Morton order of their cells; every site with a normal is core of exactly one. Cost: a few steps for
/// each site and its neighbours.
pub fn divide(sites: &Sites, progress: &mut dyn Progress) -> Result<Vec<Subdomain>> {
    let ranges = sites.tree.cut(|node| node.range().len() <= CORE);
    let lists = par::map_progress(
        ranges.len(),
        30.0,
        (Stage::Cells, progress),
        || Growth::new(sites.tree.points.len()),
        |i, growth| {
            let cell: Vec<u32> = ranges[i].clone().map(|i| i as u32).collect();
            growth.divide(sites, &cell)
        },
    )?;
    Ok(lists.into_iter().flatten().collect())
}

impl Subdomain {
    /// The two halves along the longest axis of the core, grown anew; the core must have at least two sites.
    pub fn split(&self, sites: &Sites, growth: &mut Growth) -> Vec<Subdomain> {
        let core = &self.support[..self.core];
        let position = |i: &u32| sites.tree.points[*i as usize];
        let at = || core.iter().map(position);
        let lo = at().reduce(Vec3::min).unwrap_or_default();
        let hi = at().reduce(Vec3::max).unwrap_or_default();
        let axis = (hi - lo).max_position();
        let place = |i: &u32| pack(key(position(i)[axis]), *i);
        let mut sorted: Vec<u64> = core.iter().map(place).collect();
        sorted.sort_unstable();
        let core: Vec<u32> = sorted.into_iter().map(|place| unpack(place).1).collect();
        let (low, high) = core.split_at(core.len() / 2);
        [low, high]
            .into_iter()
            .flat_map(|half| growth.divide(sites, half))
            .collect()
    }
}

/// Whether two sites lie on the same sheet.
fn compatible(sites: &Sites, i: u32, j: u32) -> bool {
    agree(sites, (i, sites.normals[i as usize]), j)
}

/// [`compatible`] if site `i` had the normal `a`.
fn agree(sites: &Sites, (i, a): (u32, Vec3), j: u32) -> bool {
    let (i, j) = (i as usize, j as usize);
    let mut b = sites.normals[j];
    if !sites.oriented && a.dot(b) < 0.0 {
        b = -b;
    }
    let d = sites.tree.points[j] - sites.tree.points[i];
    let (length, noise) = (d.length(), 2.0 * sites.noise);
    let (from, to) = (a.dot(d), b.dot(d));
    let step = if from * to > 0.0 {
        from.abs().min(to.abs())
    } else {
        0.0
    };
    a.dot(b) >= MIN_COSINE
        && from.abs().max(to.abs()) <= MAX_SLOPE * length + noise
        && step <= MAX_STEP * length + noise
}

/// A step of growth: cost, site, and the site it was reached from. Costs are non-negative floats as ordered bits.
type Step = Reverse<(u32, u32, u32)>;

/// Scratch of one worker that grows sub-domains.
#[derive(Debug)]
pub struct Growth {
    /// 1 + place in the support, 0 when not in it.
    place: Vec<u32>,
    in_cell: Vec<bool>,
    heap: BinaryHeap<Step>,
}

impl Growth {
    /// For `n` sites.
    pub fn new(n: usize) -> Growth {
        Growth {
            place: vec![0; n],
            in_cell: vec![false; n],
            heap: BinaryHeap::new(),
        }
    }

    /// The sub-domains of the sites of one cell.
    fn divide(&mut self, sites: &Sites, cell: &[u32]) -> Vec<Subdomain> {
        let usable = |i: u32| sites.normals[i as usize] != Vec3::ZERO;
        for &i in cell {
            self.in_cell[i as usize] = usable(i);
        }
        let mut out = Vec::new();
        for &seed in cell {
            if self.in_cell[seed as usize] {
                let mut s = Subdomain {
                    support: Vec::new(),
                    core: 0,
                    normals: Vec::new(),
                };
                self.grow_core(sites, seed, &mut s);
                self.grow_overlap(sites, &mut s);
                s.support.iter().for_each(|&i| self.place[i as usize] = 0);
                out.push(s);
            }
        }
        out
    }

    /// Takes `j`, its normal turned to agree with that of `from`.
    fn take(&mut self, sites: &Sites, j: u32, from: u32, s: &mut Subdomain) {
        s.normals.push(self.turned(sites, j, from, s));
        s.support.push(j);
        self.place[j as usize] = s.support.len() as u32;
    }

    /// The normal of `j`, turned to agree with that of `from` where that is in the support.
    fn turned(&self, sites: &Sites, j: u32, from: u32, s: &Subdomain) -> Vec3 {
        let normal = sites.normals[j as usize];
        match self.place[from as usize] {
            0 => normal,
            place if s.normals[place as usize - 1].dot(normal) < 0.0 => -normal,
            _ => normal,
        }
    }

    /// Whether `j`, reached from `from`, and its neighbours in the support stand as on one sheet: see [`TOGETHER`].
    fn is_together(&self, sites: &Sites, j: u32, from: u32, s: &Subdomain, least: f32) -> bool {
        let normal = self.turned(sites, j, from, s);
        let blur2 = BLUR * sites.noise * sites.noise;
        let (mut sum, mut count) = (0.0, 0.0);
        for &k in sites.graph.of(j) {
            if let Some(place) = self.place[k as usize].checked_sub(1) {
                let d = sites.tree.points[k as usize] - sites.tree.points[j as usize];
                sum += dipoles(d, normal, s.normals[place as usize], blur2);
                count += 1.0;
            }
        }
        sum >= least * count
    }

    /// The part of the cell that is reached from `seed`, by the smallest turns of the normal first (Prim's algorithm).
    fn grow_core(&mut self, sites: &Sites, seed: u32, s: &mut Subdomain) {
        self.heap.push(Reverse((0, seed, seed)));
        while let Some(Reverse((_, j, from))) = self.heap.pop() {
            if !self.in_cell[j as usize] || !self.is_together(sites, j, from, s, TOGETHER[0]) {
                continue;
            }
            self.in_cell[j as usize] = false;
            self.take(sites, j, from, s);
            for &k in sites.graph.of(j) {
                if self.in_cell[k as usize] && compatible(sites, j, k) {
                    let turn = 1.0
                        - sites.normals[j as usize]
                            .dot(sites.normals[k as usize])
                            .abs();
                    self.heap.push(Reverse((turn.max(0.0).to_bits(), k, j)));
                }
            }
        }
        s.core = s.support.len();
    }

    /// The sites around the core, nearest first, that are reached over compatible pairs.
    fn grow_overlap(&mut self, sites: &Sites, s: &mut Subdomain) {
        let points = &sites.tree.points;
        let center = s.support.iter().map(|&i| points[i as usize]).sum::<Vec3>() / s.core as f32;
        let spacing = sites.spacing[s.support[0] as usize];
        let relative = (2.0 * sites.noise / spacing.max(f32::MIN_POSITIVE)).min(1.0);
        let wanted = s.core + (OVERLAP[0] + relative * (OVERLAP[1] - OVERLAP[0])) as usize;
        let mut next = 0;
        loop {
            while next < s.support.len() {
                let i = s.support[next];
                for &k in sites.graph.of(i) {
                    let usable =
                        self.place[k as usize] == 0 && sites.normals[k as usize] != Vec3::ZERO;
                    if usable && compatible(sites, i, k) {
                        let cost = points[k as usize].distance_squared(center);
                        self.heap.push(Reverse((cost.to_bits(), k, i)));
                    }
                }
                next += 1;
            }
            match self.heap.pop() {
                Some(Reverse((_, k, from))) if s.support.len() < wanted => {
                    let near = (COINCIDENT * spacing).powi(2);
                    let apart =
                        |&i: &u32| points[i as usize].distance_squared(points[k as usize]) > near;
                    if self.place[k as usize] == 0
                        && s.support.iter().all(apart)
                        && self.is_together(sites, k, from, s, TOGETHER[1])
                    {
                        self.take(sites, k, from, s);
                    }
                }
                _ => break,
            }
        }
        self.heap.clear();
    }
}
