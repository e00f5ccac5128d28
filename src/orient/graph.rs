//! The graph of sub-domains: how well neighbouring fitted functions agree.
//!
//! The weight of an edge has two kinds of evidence:
//! - the cosine of the two gradients at each site that both hold;
//! - for neighbouring sites of different sub-domains, how two dipoles along the gradients would rather stand:
//!   side by side they look the same way, facing each other opposite ways, be there material or air between them. Sites
//!   on one sheet, across a crease and on the two sides of a thin wall are all told right by the same formula. (It is
//!   the Dirichlet energy of the winding number, which is 0 for a closed surface that looks out everywhere.)

use crate::base::groups::Groups;
use crate::base::kernel::dipoles;
use crate::base::sets::Sets;
use crate::base::sort_keys::{key, of_key, pack, ranked, unpack};
use crate::orient::domains::Domains;

/// An edge between sub-domains `a` < `b`; positive weight: same sign.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Edge {
    pub(crate) a: u32,
    pub(crate) b: u32,
    pub(crate) weight: f32,
}

/// Weight of two neighbouring sites' dipoles against that of a shared site. Of two sheets a spacing or two apart some
/// sub-domains hold sites of both, so what they share misleads, and there are more of those than of neighbours: on plates
/// 1.5 spacings thick and on pigs of few points 5 to 30 do equally well, 3 and less do not.
const DIPOLES: f32 = 10.0;
/// Variance of the noise that a squared distance of dipoles is raised by, as their offset along the normal is partly noise:
/// with 0 noisy sheets come apart, with 4 thin plates do not.
const BLUR: f32 = 2.0;

/// All edges, sorted by (a, b).
pub(crate) fn edges(domains: &Domains) -> Vec<Edge> {
    let Domains {
        fits,
        sites,
        gradients,
    } = domains;
    let n_sites = sites.tree.points.len();
    let each = || fits.subdomains.iter().zip(gradients).zip(0u32..);
    // Gradients by site, and the sub-domain whose core a site is in.
    let samples = Groups::new(n_sites, || {
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
    let normals = domains.site_normals(&unsigned);
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
    let mut said = Groups::new(fits.subdomains.len(), || shared().chain(neighbors()));
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

/// E / Σ |w|.
pub(crate) fn energy(edges: &[Edge], signs: &[f32]) -> f64 {
    let total: f64 = edges.iter().map(|e| e.weight.abs() as f64).sum();
    let sum: f64 = edges
        .iter()
        .map(|e| (e.weight * signs[e.a as usize] * signs[e.b as usize]) as f64)
        .sum();
    if total > 0.0 { -sum / total } else { -1.0 }
}

/// The edges of every sub-domain: their indices, and the sub-domains at their other ends.
pub(crate) type Adjacency = Groups<(u32, u32)>;

pub(crate) fn adjacency(n: usize, edges: &[Edge]) -> Adjacency {
    Groups::new(n, || {
        let ends = edges.iter().zip(0u32..);
        ends.flat_map(|(e, i)| [(e.a, (i, e.b)), (e.b, (i, e.a))])
    })
}

/// Connected components, by their first sub-domain.
pub(crate) fn components(adjacency: &Adjacency) -> Vec<Vec<u32>> {
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

/// The signs that a maximum spanning forest of |w| (Kruskal) implies.
pub(crate) fn spanning_signs(n: usize, edges: &[Edge]) -> Vec<f32> {
    let mut sets = Sets::new(n);
    let mut tree = Vec::with_capacity(n);
    for place in ranked(edges.iter().map(|e| !key(e.weight.abs()))) {
        let e = edges[unpack(place).1 as usize];
        if sets.find(e.a) != sets.find(e.b) {
            sets.join(e.a, e.b);
            tree.push(e);
        }
    }
    let around = adjacency(n, &tree);
    let mut signs = vec![0.0f32; n];
    for component in components(&around) {
        signs[component[0] as usize] = 1.0;
        for &s in &component {
            for &(e, t) in around.of(s) {
                if signs[t as usize] == 0.0 {
                    let weight = tree[e as usize].weight;
                    signs[t as usize] = signs[s as usize] * weight.signum();
                }
            }
        }
    }
    signs
}
