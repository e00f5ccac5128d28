//! Signs of least energy over a graph, by a multilevel descent.
//!
//! E = −Σ w_ab s_a s_b − Σ h_a s_a. Single flips stop early: an island that is wrong as a whole has no member that gains by
//! turning alone. So neighbours that agree are contracted into one node, level by level, clusters are flipped, and on the way
//! back their members again: a cluster of any size and shape can turn. Only satisfied edges are contracted, so no conflict is
//! frozen in and no cycle raises the energy (Hendrickson and Leland, "A multilevel algorithm for partitioning graphs", 1995,
//! do the same for cuts).

use crate::base::groups::Groups;
use crate::base::rng::Rng;
use crate::orient::graph::{Edge, adjacency};
use std::collections::VecDeque;

/// Cycles from the finest graph to the coarsest and back. The third lowers the energy of 34,000 sub-domains by 0.02 %, ten
/// by 0.06 %.
const CYCLES: u64 = 3;
/// Least share of the nodes with neighbours that a contraction must join to be worth one more level.
const JOINED: f64 = 0.03;
/// Least gain of a flip, against rounding.
const GAIN: f32 = 1e-6;

/// Lowers the energy from the `signs` it is given; `unary` is h.
pub(crate) fn descend(edges: &[Edge], unary: &[f32], signs: &mut [f32]) {
    for seed in 0..CYCLES {
        let level = Level::new(edges, unary, signs);
        turn(signs, &level.cycle(&mut Rng::new(seed)));
    }
}

/// Lowers it by single flips alone: what was turned as a whole stays as it is but for its border.
pub(crate) fn settle(edges: &[Edge], unary: &[f32], signs: &mut [f32]) {
    let mut turned = vec![1.0; signs.len()];
    Level::new(edges, unary, signs).flip_single(&mut turned);
    turn(signs, &turned);
}

fn turn(signs: &mut [f32], by: &[f32]) {
    for (sign, turned) in signs.iter_mut().zip(by) {
        *sign *= turned;
    }
}

/// A graph whose nodes all have the sign +1.
struct Level {
    /// Neighbours of every node and the weights of the edges to them.
    links: Groups<(u32, f32)>,
    unary: Vec<f32>,
}

impl Level {
    /// Signs become part of the weights.
    fn new(edges: &[Edge], unary: &[f32], signs: &[f32]) -> Level {
        let n = signs.len();
        let around = adjacency(n, edges);
        let links = Groups::new(n, || {
            (0..n as u32).flat_map(|a| {
                around.of(a).iter().map(move |&(e, b)| {
                    let weight = edges[e as usize].weight;
                    (a, (b, weight * signs[a as usize] * signs[b as usize]))
                })
            })
        });
        let unary = unary.iter().zip(signs).map(|(h, s)| h * s).collect();
        Level { links, unary }
    }

    fn cycle(&self, rng: &mut Rng) -> Vec<f32> {
        let mut signs = vec![1.0; self.unary.len()];
        self.flip_single(&mut signs);
        let (cluster, count) = self.matched(&signs, rng);
        let linked = self.links.iter().filter(|links| !links.is_empty()).count();
        let joined = signs.len() - count;
        if joined == 0 || (joined as f64) < JOINED * linked as f64 {
            return signs;
        }
        let turned = self.contracted(&cluster, count, &signs).cycle(rng);
        for (sign, &c) in signs.iter_mut().zip(&cluster) {
            *sign *= turned[c as usize];
        }
        self.flip_single(&mut signs);
        signs
    }

    /// Flips single nodes while that lowers the energy.
    fn flip_single(&self, signs: &mut [f32]) {
        let mut queue: VecDeque<u32> = (0..signs.len() as u32).collect();
        let mut queued = vec![true; signs.len()];
        while let Some(s) = queue.pop_front() {
            queued[s as usize] = false;
            let around = self.links.of(s);
            let ties: f32 = around.iter().map(|&(t, w)| w * signs[t as usize]).sum();
            if (ties + self.unary[s as usize]) * signs[s as usize] < -GAIN {
                signs[s as usize] = -signs[s as usize];
                for &(t, _) in around {
                    if !std::mem::replace(&mut queued[t as usize], true) {
                        queue.push_back(t);
                    }
                }
            }
        }
    }

    /// Pairs of nodes, in random order each with its free neighbour that it agrees with most: the cluster of every node, and
    /// how many there are.
    fn matched(&self, signs: &[f32], rng: &mut Rng) -> (Vec<u32>, usize) {
        let n = signs.len();
        let mut order: Vec<u32> = (0..n as u32).collect();
        for i in (1..n).rev() {
            order.swap(i, (rng.next_u64() % (i as u64 + 1)) as usize);
        }
        let mut cluster = vec![u32::MAX; n];
        let mut count = 0;
        for a in order {
            if cluster[a as usize] != u32::MAX {
                continue;
            }
            cluster[a as usize] = count;
            let mut best = (0.0, a);
            for &(b, weight) in self.links.of(a) {
                let agreement = weight * signs[a as usize] * signs[b as usize];
                if agreement > best.0 && cluster[b as usize] == u32::MAX {
                    best = (agreement, b);
                }
            }
            cluster[best.1 as usize] = count;
            count += 1;
        }
        (cluster, count as usize)
    }

    /// The graph of the clusters.
    fn contracted(&self, cluster: &[u32], count: usize, signs: &[f32]) -> Level {
        let mut unary = vec![0.0; count];
        for ((&c, h), s) in cluster.iter().zip(&self.unary).zip(signs) {
            unary[c as usize] += h * s;
        }
        let members = Groups::new(count, || cluster.iter().copied().zip(0u32..));
        // Where the edge to each cluster is in the list of the present one, if it has one.
        let mut place = vec![usize::MAX; count];
        let mut all: Vec<(u32, (u32, f32))> = Vec::new();
        for c in 0..count as u32 {
            let start = all.len();
            for &a in members.of(c) {
                for &(b, weight) in self.links.of(a) {
                    let d = cluster[b as usize];
                    if d == c {
                        continue;
                    }
                    let weight = weight * signs[a as usize] * signs[b as usize];
                    let at = place[d as usize];
                    if (start..all.len()).contains(&at) && all[at].1.0 == d {
                        all[at].1.1 += weight;
                    } else {
                        place[d as usize] = all.len();
                        all.push((c, (d, weight)));
                    }
                }
            }
        }
        Level {
            links: Groups::new(count, || all.iter().copied()),
            unary,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two rings of nodes that agree, joined by edges of little weight that say the opposite.
    #[test]
    fn an_island_that_is_wrong_as_a_whole_turns() {
        let ring = |start: u32| {
            (0..50).map(move |i| Edge {
                a: (start + i).min(start + (i + 1) % 50),
                b: (start + i).max(start + (i + 1) % 50),
                weight: 1.0,
            })
        };
        let bridge = (0..5).map(|i| Edge {
            a: i,
            b: 50 + i,
            weight: -0.3,
        });
        let edges: Vec<Edge> = ring(0).chain(ring(50)).chain(bridge).collect();
        let mut signs = vec![1.0; 100];
        descend(&edges, &[0.0; 100], &mut signs);
        assert!(signs[..50].iter().all(|&s| s == signs[0]));
        assert!(signs[50..].iter().all(|&s| s == -signs[0]));
        // Evidence at one node turns all.
        let mut unary = [0.0; 100];
        unary[70] = -0.1 * signs[70];
        let before = signs.clone();
        descend(&edges, &unary, &mut signs);
        assert!(signs.iter().zip(before).all(|(s, before)| *s == -before));
    }
}
