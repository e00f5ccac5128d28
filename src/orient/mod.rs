//! Which side is out: one sign a sub-domain (section 4.2, Algorithm 1).
//!
//! Sub-domains are joined by edges whose weight says how well their *fitted functions* agree, from two kinds of evidence:
//! - the cosine of the two gradients at each site that both hold;
//! - for neighbouring sites of different sub-domains, how two dipoles along the gradients would rather stand:
//!   side by side they look the same way, facing each other opposite ways, be there material or air between them. Sites
//!   on one sheet, across a crease and on the two sides of a thin wall are all told right by the same formula. (It is
//!   the Dirichlet energy of the winding number, which is 0 for a closed surface that looks out everywhere.)
//!
//! The energy of signs s is E = −Σ w_ab s_a s_b. [`Propagation::Paper`] is Algorithm 1: an advancing front with belief
//! propagation on local graphs. [`Propagation::Global`] starts from the maximum spanning tree of |w| and then flips
//! sub-domains and whole branches of the tree while that lowers the energy: a front that is wrong once stays wrong,
//! a tree can be mended.
//!
//! Every connected component then gets the sign that makes its enclosed volume positive; open sheets without a clear
//! volume follow the paper's rule for the start (the normal at the largest coordinate agrees with that axis). One that
//! lies in the solid of an odd number of others is a cave's wall, and looks into the cave: nested shells bound the solid
//! between them.
//!
//! Last, the winding number is asked itself: on a surface it is ½, on a part of it that is inside out −½. Where two parts
//! touch in few points, that knows more than the edges there do.

pub(crate) mod caves;
pub(crate) mod winding;

use crate::base::error::Result;
use crate::base::kernel::dipoles;
use crate::base::lists::{Lists, key, of_key, pack, ranked, unpack};
use crate::base::par;
use crate::base::params::Propagation;
use crate::base::progress::{Progress, Stage};
use crate::fit::Fits;
use crate::fit::cells::Sites;
use crate::orient::caves::{Solid, caves};
use crate::orient::winding::Winding;
use glam::{DVec3, Vec3};
use std::collections::VecDeque;

/// The signs and what they cost.
#[derive(Debug, Clone)]
pub struct Signs {
    /// +1 or −1 for each sub-domain's function.
    pub signs: Vec<f32>,
    /// E = −Σ w_ab s_a s_b over all edges, divided by Σ |w|: −1 when all edges agree.
    pub energy: f64,
    /// The same for the signs that were handed on from neighbour to neighbour, before conflicts were solved over the whole
    /// graph.
    pub energy_before: f64,
    /// Oriented unit normal of every site; zero where the site belongs to no sub-domain.
    pub normals: Vec<Vec3>,
    /// Whether the sub-domain is part of a surface: its connected component has at least [`SMALLEST`] sites of its own,
    /// or is the largest. Fewer are taken for outliers.
    pub kept: Vec<bool>,
}

impl Signs {
    /// The other side of everything.
    pub fn invert(&mut self) {
        self.signs.iter_mut().for_each(|s| *s = -*s);
        self.normals.iter_mut().for_each(|n| *n = -*n);
    }
}

/// An edge between sub-domains `a` < `b`; positive weight: same sign.
#[derive(Debug, Clone, Copy)]
struct Edge {
    a: u32,
    b: u32,
    weight: f32,
}

/// Weight of two neighbouring sites' dipoles against that of a shared site. Of two sheets a spacing or two apart some
/// sub-domains hold sites of both, so what they share misleads, and there are more of those than of neighbours: on plates
/// 1.5 spacings thick and on pigs of few points 5 to 30 do equally well, 3 and less do not.
const DIPOLES: f32 = 10.0;
/// Variance of the noise that a squared distance of dipoles is raised by, as their offset along the normal is partly noise:
/// with 0 noisy sheets come apart, with 4 thin plates do not.
const BLUR: f32 = 2.0;

/// Sites of the smallest connected component that counts as a surface, unless it is the largest: fewer than a
/// sub-domain's support cannot be told from scattered points.
pub const SMALLEST: usize = 16;

/// Infers the signs; with `sites.oriented` every sign is +1 already.
pub fn orient(
    fits: &Fits,
    sites: &Sites,
    propagation: Propagation,
    progress: &mut dyn Progress,
) -> Result<Signs> {
    let n = fits.functions.len();
    let gradients = par::map_progress(
        n,
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
    let edges = edges(fits, sites, &gradients);
    let adjacency = adjacency(n, &edges);
    let mut signs = vec![1.0; n];
    let mut energy_before = energy(&edges, &signs);
    let components = components(&adjacency);
    if !sites.oriented {
        match propagation {
            Propagation::Paper => {
                advancing_front(fits, sites, &edges, &adjacency, &mut signs);
                energy_before = energy(&edges, &signs);
            }
            Propagation::Global => {
                let forest = Forest::strongest_first(n, &edges);
                signs.copy_from_slice(&forest.signs);
                energy_before = energy(&edges, &signs);
                forest.flip_branches(&edges, &mut signs);
                flip_single(&edges, &adjacency, &mut signs);
            }
        }
        let is_solid: Vec<bool> = components
            .iter()
            .map(|c| turn_outward(c, fits, sites, &gradients, &mut signs))
            .collect();
        turn_caves(&components, &is_solid, fits, sites, &gradients, &mut signs);
        if propagation == Propagation::Global {
            let around =
                |signs: &[f32], which: &[u32]| winding(which, fits, sites, &gradients, signs);
            turn_inverted(&edges, &adjacency, around, &mut signs);
        }
    }
    let normals = site_normals(fits, sites, &gradients, &signs);
    let kept = kept(&components, fits);
    progress.update(Stage::Orient, 1.0)?;
    Ok(Signs {
        energy: energy(&edges, &signs),
        energy_before,
        signs,
        normals,
        kept,
    })
}

/// [`Signs::kept`].
fn kept(components: &[Vec<u32>], fits: &Fits) -> Vec<bool> {
    let size = |c: &Vec<u32>| {
        c.iter()
            .map(|&s| fits.subdomains[s as usize].core)
            .sum::<usize>()
    };
    let enough = SMALLEST.min(components.iter().map(size).max().unwrap_or(0));
    let mut kept = vec![false; fits.subdomains.len()];
    for component in components.iter().filter(|c| size(c) >= enough) {
        component.iter().for_each(|&s| kept[s as usize] = true);
    }
    kept
}

/// E / Σ |w|.
fn energy(edges: &[Edge], signs: &[f32]) -> f64 {
    let total: f64 = edges.iter().map(|e| e.weight.abs() as f64).sum();
    let sum: f64 = edges
        .iter()
        .map(|e| (e.weight * signs[e.a as usize] * signs[e.b as usize]) as f64)
        .sum();
    if total > 0.0 { -sum / total } else { -1.0 }
}

/// All edges, sorted by (a, b).
fn edges(fits: &Fits, sites: &Sites, gradients: &[Vec<Vec3>]) -> Vec<Edge> {
    let n_sites = sites.tree.points.len();
    let each = || fits.subdomains.iter().zip(gradients).zip(0u32..);
    // Gradients by site, and the sub-domain whose core a site is in.
    let samples = Lists::new(n_sites, || {
        each().flat_map(|((subdomain, gradients), s)| {
            let samples = subdomain.support.iter().zip(gradients);
            samples.map(move |(&i, &g)| (i, (s, g)))
        })
    });
    let mut owner = vec![u32::MAX; n_sites];
    for ((subdomain, _), s) in each() {
        subdomain.support[..subdomain.core]
            .iter()
            .for_each(|&i| owner[i as usize] = s);
    }
    let unsigned = vec![1.0; fits.subdomains.len()];
    let normals = site_normals(fits, sites, gradients, &unsigned);
    let blur2 = BLUR * sites.noise * sites.noise;
    // What every pair says: a, and b with the agreement.
    let shared = || {
        samples.iter().flat_map(|group| {
            let firsts = group.iter().enumerate();
            firsts.flat_map(|(k, &(a, ga))| {
                let others = group[k + 1..].iter();
                others.map(move |&(b, gb)| (a, pack(b, key(ga.dot(gb)))))
            })
        })
    };
    let neighbors = || {
        let all = (0..n_sites as u32).flat_map(|i| sites.graph.of(i).iter().map(move |&j| (i, j)));
        all.filter_map(|(i, j)| {
            let (a, b) = (owner[i as usize], owner[j as usize]);
            if a == b || a.max(b) == u32::MAX {
                return None;
            }
            let d = sites.tree.points[j as usize] - sites.tree.points[i as usize];
            let stand = dipoles(d, normals[i as usize], normals[j as usize], blur2);
            Some((a.min(b), pack(a.max(b), key(DIPOLES * stand))))
        })
    };
    let mut said = Lists::new(fits.subdomains.len(), || shared().chain(neighbors()));
    drop(samples);
    let size = |s: u32| fits.subdomains[s as usize].support.len();
    let mut edges = Vec::new();
    for a in 0..said.count() as u32 {
        let said = said.of_mut(a);
        said.sort_unstable();
        for pair in said.chunk_by(|x, y| unpack(*x).0 == unpack(*y).0) {
            let b = unpack(pair[0]).0;
            let sum: f32 = pair.iter().map(|&p| of_key(unpack(p).1)).sum();
            let weight = sum / (size(a).min(size(b)) as f32 * (1.0 + DIPOLES));
            if weight != 0.0 {
                edges.push(Edge { a, b, weight });
            }
        }
    }
    edges
}

/// The edges of every sub-domain: their indices, and the sub-domains at their other ends.
type Adjacency = Lists<(u32, u32)>;

fn adjacency(n: usize, edges: &[Edge]) -> Adjacency {
    Lists::new(n, || {
        let ends = edges.iter().zip(0u32..);
        ends.flat_map(|(e, i)| [(e.a, (i, e.b)), (e.b, (i, e.a))])
    })
}

/// Connected components, by their first sub-domain.
fn components(adjacency: &Adjacency) -> Vec<Vec<u32>> {
    let mut seen = vec![false; adjacency.count()];
    let mut out = Vec::new();
    for start in 0..seen.len() as u32 {
        if seen[start as usize] {
            continue;
        }
        seen[start as usize] = true;
        let mut members = vec![start];
        let mut next = 0;
        while next < members.len() {
            for &(_, t) in adjacency.of(members[next]) {
                if !std::mem::replace(&mut seen[t as usize], true) {
                    members.push(t);
                }
            }
            next += 1;
        }
        out.push(members);
    }
    out
}

/// A maximum spanning forest of |w| (Kruskal) with the signs it implies.
struct Forest {
    signs: Vec<f32>,
    /// Parent of each sub-domain, itself for a root.
    parent: Vec<u32>,
    /// Steps to the root.
    depth: Vec<u32>,
    /// Parents before children.
    order: Vec<u32>,
}

impl Forest {
    fn strongest_first(n: usize, edges: &[Edge]) -> Forest {
        let order = ranked(edges.iter().map(|e| !key(e.weight.abs())));
        let mut set: Vec<u32> = (0..n as u32).collect();
        fn root(set: &mut [u32], mut i: u32) -> u32 {
            while set[i as usize] != i {
                set[i as usize] = set[set[i as usize] as usize];
                i = set[i as usize];
            }
            i
        }
        let mut tree = Vec::with_capacity(n);
        for i in order {
            let e = edges[unpack(i).1 as usize];
            let (a, b) = (root(&mut set, e.a), root(&mut set, e.b));
            if a != b {
                set[a.max(b) as usize] = a.min(b);
                tree.push(e);
            }
        }
        Forest::rooted(n, &tree)
    }

    /// Roots every tree at its first sub-domain and carries signs from there.
    fn rooted(n: usize, tree: &[Edge]) -> Forest {
        let adjacency = adjacency(n, tree);
        let mut forest = Forest {
            signs: vec![1.0; n],
            parent: (0..n as u32).collect(),
            depth: vec![0; n],
            order: Vec::with_capacity(n),
        };
        for component in components(&adjacency) {
            for &s in &component {
                for &(e, t) in adjacency.of(s) {
                    if t != forest.parent[s as usize] {
                        forest.parent[t as usize] = s;
                        forest.depth[t as usize] = forest.depth[s as usize] + 1;
                        forest.signs[t as usize] =
                            forest.signs[s as usize] * tree[e as usize].weight.signum();
                    }
                }
            }
            forest.order.extend(component);
        }
        forest
    }

    /// Flips whole branches while that lowers the energy, the best branch first. The gain of a branch is the sum of
    /// w s s over the edges that leave it: added at both ends and taken off twice at their lowest common ancestor, it is
    /// a sum over the branch.
    fn flip_branches(&self, edges: &[Edge], signs: &mut [f32]) {
        let ancestors: Vec<u32> = edges.iter().map(|e| self.ancestor(e.a, e.b)).collect();
        // Every round lowers the energy by a finite amount; the bound only guards the time on graphs without order.
        for _ in 0..200 {
            let mut cut = vec![0.0f64; signs.len()];
            for (e, &ancestor) in edges.iter().zip(&ancestors) {
                let agreement = (e.weight * signs[e.a as usize] * signs[e.b as usize]) as f64;
                cut[e.a as usize] += agreement;
                cut[e.b as usize] += agreement;
                cut[ancestor as usize] -= 2.0 * agreement;
            }
            let mut worst = (-1e-6, u32::MAX);
            for &s in self.order.iter().rev() {
                let value = cut[s as usize];
                let parent = self.parent[s as usize];
                if parent != s {
                    cut[parent as usize] += value;
                    if value < worst.0 {
                        worst = (value, s);
                    }
                }
            }
            if worst.1 == u32::MAX {
                return;
            }
            let mut inside = vec![false; signs.len()];
            inside[worst.1 as usize] = true;
            for &s in &self.order {
                inside[s as usize] |=
                    self.parent[s as usize] != s && inside[self.parent[s as usize] as usize];
                if inside[s as usize] {
                    signs[s as usize] = -signs[s as usize];
                }
            }
        }
    }

    fn ancestor(&self, mut a: u32, mut b: u32) -> u32 {
        while a != b {
            if self.depth[a as usize] >= self.depth[b as usize] {
                a = self.parent[a as usize];
            } else {
                b = self.parent[b as usize];
            }
        }
        a
    }
}

/// Flips single sub-domains while that lowers the energy.
fn flip_single(edges: &[Edge], adjacency: &Adjacency, signs: &mut [f32]) {
    let mut queue: VecDeque<u32> = (0..signs.len() as u32).collect();
    let mut queued = vec![true; signs.len()];
    while let Some(s) = queue.pop_front() {
        queued[s as usize] = false;
        let field: f32 = adjacency
            .of(s)
            .iter()
            .map(|&(e, t)| edges[e as usize].weight * signs[t as usize])
            .sum();
        if field * signs[s as usize] < -1e-6 {
            signs[s as usize] = -signs[s as usize];
            for &(_, t) in adjacency.of(s) {
                if !std::mem::replace(&mut queued[t as usize], true) {
                    queue.push_back(t);
                }
            }
        }
    }
}

/// Algorithm 1. The start is the sub-domain of the site with the largest coordinate, its normal along that axis.
fn advancing_front(
    fits: &Fits,
    sites: &Sites,
    edges: &[Edge],
    adjacency: &Adjacency,
    signs: &mut [f32],
) {
    let mut aligned = vec![false; signs.len()];
    let mut marked = vec![false; signs.len()];
    for component in components(adjacency) {
        // Steps 1 and 2.
        let (start, sign) = highest(&component, fits, sites);
        signs[start as usize] = sign;
        aligned[start as usize] = true;
        marked[start as usize] = true;
        let mut front = VecDeque::from([start]);
        // Step 4.
        while let Some(active) = front.pop_front() {
            let unaligned: Vec<u32> = adjacency
                .of(active)
                .iter()
                .map(|&(_, t)| t)
                .filter(|&t| !aligned[t as usize])
                .collect();
            let beliefs = believe(&unaligned, edges, adjacency, &aligned, signs);
            for (&s, belief) in unaligned.iter().zip(beliefs) {
                signs[s as usize] = if belief < 0.0 { -1.0 } else { 1.0 };
                aligned[s as usize] = true;
                if !std::mem::replace(&mut marked[s as usize], true) {
                    front.push_back(s);
                }
            }
        }
    }
}

/// Belief propagation (sum-product, in log-odds) on the graph of the `free` sub-domains; aligned neighbours are evidence.
/// The potential of an edge is exp(β w s s'); returns the log-odds of +1.
fn believe(
    free: &[u32],
    edges: &[Edge],
    adjacency: &Adjacency,
    aligned: &[bool],
    signs: &[f32],
) -> Vec<f64> {
    /// Inverse temperature: an edge of full agreement is e^8 times likelier than one of full contradiction.
    const BETA: f64 = 4.0;
    /// Rounds of messages; local graphs are a few steps wide.
    const ROUNDS: usize = 10;
    let local = |s: u32| free.iter().position(|&f| f == s);
    let mut evidence = vec![0.0; free.len()];
    // Directed local edges: from, to, β w.
    let mut links: Vec<(usize, usize, f64)> = Vec::new();
    for (i, &s) in free.iter().enumerate() {
        for &(e, t) in adjacency.of(s) {
            let strength = BETA * edges[e as usize].weight as f64;
            if aligned[t as usize] {
                evidence[i] += 2.0 * strength * signs[t as usize] as f64;
            } else if let Some(j) = local(t) {
                links.push((i, j, strength));
            }
        }
    }
    let mut messages = vec![0.0; links.len()];
    let mut beliefs = evidence.clone();
    for _ in 0..ROUNDS {
        let next: Vec<f64> = links
            .iter()
            .map(|&(from, to, strength)| {
                // What `from` believes without what `to` told it: 2 atanh(tanh(βw) tanh(h/2)).
                let told = links
                    .iter()
                    .zip(&messages)
                    .find(|(l, _)| (l.0, l.1) == (to, from))
                    .map_or(0.0, |(_, &m)| m);
                let product = libm::tanh(strength) * libm::tanh(0.5 * (beliefs[from] - told));
                2.0 * libm::atanh(product.clamp(-0.999_999, 0.999_999))
            })
            .collect();
        messages = next;
        beliefs.copy_from_slice(&evidence);
        for (&(_, to, _), m) in links.iter().zip(&messages) {
            beliefs[to] += m;
        }
    }
    beliefs
}

/// The sub-domain of a component that holds the site with the largest coordinate component, and the sign that turns its
/// normal there along that axis.
fn highest(component: &[u32], fits: &Fits, sites: &Sites) -> (u32, f32) {
    let mut best = (f32::NEG_INFINITY, 0, 0u32, 0usize);
    for &s in component {
        let subdomain = &fits.subdomains[s as usize];
        for &i in &subdomain.support[..subdomain.core] {
            let p = sites.tree.points[i as usize];
            let axis = p.max_position();
            if p[axis] > best.0 {
                best = (p[axis], s, i, axis);
            }
        }
    }
    let (_, s, i, axis) = best;
    let at = [sites.tree.points[i as usize]];
    let slope = fits.functions[s as usize].evaluate_all(&at)[0].1[axis];
    (s, if slope < 0.0 { -1.0 } else { 1.0 })
}

/// Gives a component the sign that encloses a positive volume; whether it encloses a clear one.
fn turn_outward(
    component: &[u32],
    fits: &Fits,
    sites: &Sites,
    gradients: &[Vec<Vec3>],
    signs: &mut [f32],
) -> bool {
    let cores = || {
        component.iter().flat_map(|&s| {
            let subdomain = &fits.subdomains[s as usize];
            let sign = signs[s as usize];
            subdomain.support[..subdomain.core]
                .iter()
                .zip(&gradients[s as usize])
                .map(move |(&i, &g)| {
                    let area = (sites.spacing[i as usize] as f64).powi(2);
                    (
                        sites.tree.points[i as usize].as_dvec3(),
                        (g * sign).as_dvec3() * area,
                        area,
                    )
                })
        })
    };
    let area: f64 = cores().map(|c| c.2).sum();
    let center = cores().map(|c| c.0 * c.2).sum::<DVec3>() / area.max(f64::MIN_POSITIVE);
    let volume: f64 = cores().map(|(p, n, _)| (p - center).dot(n)).sum::<f64>() / 3.0;
    let size: f64 = cores()
        .map(|(p, n, _)| (p - center).length() * n.length())
        .sum::<f64>()
        / 3.0;
    // A closed body has a volume of a third of `size` and more; a nearly flat sheet next to none.
    let is_solid = volume.abs() > 0.02 * size;
    let flip = if is_solid {
        volume < 0.0
    } else {
        let (s, sign) = highest(component, fits, sites);
        sign != signs[s as usize]
    };
    if flip {
        turn(component, signs);
    }
    is_solid
}

fn turn(component: &[u32], signs: &mut [f32]) {
    component
        .iter()
        .for_each(|&s| signs[s as usize] = -signs[s as usize]);
}

/// Turns the solid components that an odd number of other solid ones have inside of them. All must look outward.
fn turn_caves(
    components: &[Vec<u32>],
    is_solid: &[bool],
    fits: &Fits,
    sites: &Sites,
    gradients: &[Vec<Vec3>],
    signs: &mut [f32],
) {
    let kept = kept(components, fits);
    let solids: Vec<Solid> = components
        .iter()
        .zip(is_solid)
        .filter(|(c, is)| **is && kept[c[0] as usize])
        .map(|(c, _)| Solid::new(c, fits, sites, gradients, signs))
        .collect();
    for cave in caves(&solids) {
        turn(cave, signs);
    }
}

/// Turns the connected groups of sub-domains whose winding number says that they are inside out, and leaves those turned for
/// which that mends it: a sheet beside a wrong one has the winding number of an inverted one, turned or not. `around`
/// tells the winding number at some sub-domains.
fn turn_inverted(
    edges: &[Edge],
    adjacency: &Adjacency,
    around: impl Fn(&[f32], &[u32]) -> Vec<f64>,
    signs: &mut [f32],
) {
    /// Half way from what says nothing, 0, to what an inverted closed surface has.
    const INVERTED: f64 = -0.25;
    let all: Vec<u32> = (0..signs.len() as u32).collect();
    let mut seen: Vec<bool> = around(signs, &all).iter().map(|&w| w > INVERTED).collect();
    let mut groups: Vec<Vec<u32>> = Vec::new();
    for start in all {
        if std::mem::replace(&mut seen[start as usize], true) {
            continue;
        }
        let mut group = vec![start];
        let mut next = 0;
        while next < group.len() {
            let s = group[next];
            for &(e, t) in adjacency.of(s) {
                let agreement = edges[e as usize].weight * signs[s as usize] * signs[t as usize];
                if agreement > 0.0 && !std::mem::replace(&mut seen[t as usize], true) {
                    group.push(t);
                }
            }
            next += 1;
        }
        groups.push(group);
    }
    if groups.is_empty() {
        return;
    }
    groups.iter().for_each(|group| turn(group, signs));
    let after = around(signs, &groups.concat());
    let mut after = after.into_iter();
    for group in &groups {
        if after.by_ref().take(group.len()).sum::<f64>() <= 0.0 {
            turn(group, signs);
        }
    }
    flip_single(edges, adjacency, signs);
}

/// The winding number at some sub-domains: the mean over a few sites of each. What lies within a spacing hardly counts, as
/// it is the sub-domain itself.
fn winding(
    which: &[u32],
    fits: &Fits,
    sites: &Sites,
    gradients: &[Vec<Vec3>],
    signs: &[f32],
) -> Vec<f64> {
    /// Sites of each, at most.
    const SAMPLES: usize = 4;
    let normals = site_normals(fits, sites, gradients, signs);
    let winding = Winding::new(&sites.tree, &normals, &sites.spacing);
    let mean = |k: usize| {
        let subdomain = &fits.subdomains[which[k] as usize];
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

/// The oriented normal of every site: the gradient of the function whose core it is in.
fn site_normals(fits: &Fits, sites: &Sites, gradients: &[Vec<Vec3>], signs: &[f32]) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; sites.tree.points.len()];
    for ((subdomain, gradients), &sign) in fits.subdomains.iter().zip(gradients).zip(signs) {
        for (&i, &g) in subdomain.support[..subdomain.core].iter().zip(gradients) {
            normals[i as usize] = g * sign;
        }
    }
    normals
}
