//! The paper's own rule for signs (Algorithm 1), and which side of a component is out by its volume.

use crate::orient::domains::Domains;
use crate::orient::graph::{Adjacency, Edge, components};
use glam::DVec3;
use std::collections::VecDeque;

/// Algorithm 1. The start is the sub-domain of the site with the largest coordinate, its normal along that axis.
pub(crate) fn advancing_front(
    domains: &Domains,
    edges: &[Edge],
    adjacency: &Adjacency,
    signs: &mut [f32],
) {
    let mut aligned = vec![false; signs.len()];
    let mut marked = vec![false; signs.len()];
    for component in components(adjacency) {
        // Steps 1 and 2.
        let (start, sign) = highest(&component, domains);
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
fn highest(component: &[u32], domains: &Domains) -> (u32, f32) {
    let Domains { fits, sites, .. } = domains;
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
///
/// Open sheets without a clear volume follow the paper's rule for the start: the normal at the largest coordinate agrees
/// with that axis.
pub(crate) fn turn_outward(component: &[u32], domains: &Domains, signs: &mut [f32]) -> bool {
    let Domains {
        fits,
        sites,
        gradients,
    } = domains;
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
        let (s, sign) = highest(component, domains);
        sign != signs[s as usize]
    };
    if flip {
        component
            .iter()
            .for_each(|&s| signs[s as usize] = -signs[s as usize]);
    }
    is_solid
}
