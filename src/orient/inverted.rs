//! What the winding number of the whole surface says is inside out: on a surface it is ½, on a part of it that is inside out
//! −½. Where two parts touch in few points, that knows more than the edges there do.

use crate::orient::domains::Domains;
use crate::orient::graph::{Adjacency, Edge};
use crate::orient::parts::{Parts, WEAK};

/// Half way from what says nothing, 0, to what an inverted closed surface has.
const INVERTED: f64 = -0.25;

/// What is asked.
pub(crate) struct Inverted<'a> {
    pub(crate) domains: &'a Domains<'a>,
    pub(crate) edges: &'a [Edge],
    pub(crate) adjacency: &'a Adjacency,
    /// Whether evidence decided for a sub-domain: that is left alone.
    pub(crate) is_known: Vec<bool>,
}

impl Inverted<'_> {
    /// Turns whole parts, and connected groups that little ties to their part: a cut through a part costs more than any
    /// region that is really inside out. Gives the winding number of the whole at every sub-domain as it is then.
    pub(crate) fn turn(&self, parts: &Parts, signs: &mut [f32]) -> Vec<f64> {
        let all: Vec<u32> = (0..signs.len() as u32).collect();
        let around = self.domains.winding(&all, signs);
        let is_inverted = |part: &&[u32]| {
            let sum: f64 = part.iter().map(|&s| around[s as usize]).sum();
            sum < INVERTED * part.len() as f64 && !part.iter().any(|&s| self.is_known[s as usize])
        };
        let mut groups: Vec<Vec<u32>> = parts
            .members
            .iter()
            .filter(is_inverted)
            .map(<[u32]>::to_vec)
            .collect();
        let mut seen: Vec<bool> = (0..signs.len())
            .map(|s| around[s] > INVERTED || self.is_known[s])
            .collect();
        for s in groups.iter().flatten() {
            seen[*s as usize] = true;
        }
        // The start of the group that a sub-domain is in.
        let mut member = vec![u32::MAX; signs.len()];
        for &start in &all {
            if !seen[start as usize] {
                let group = self.grown(start, &mut seen, signs);
                group.iter().for_each(|&s| member[s as usize] = start);
                if self.holds(&group, |t| member[t as usize] == start, signs)
                    < WEAK * (group.len() as f32).sqrt()
                {
                    groups.push(group);
                }
            }
        }
        if groups.is_empty() {
            return around;
        }
        self.turn_those_that_mend(&groups, signs);
        self.domains.winding(&all, signs)
    }

    /// Those that agree with `start` and with each other, of what is not yet seen.
    fn grown(&self, start: u32, seen: &mut [bool], signs: &[f32]) -> Vec<u32> {
        let mut group = vec![start];
        seen[start as usize] = true;
        let mut next = 0;
        while next < group.len() {
            let s = group[next];
            for &(e, t) in self.adjacency.of(s) {
                let weight = self.edges[e as usize].weight;
                let agreement = weight * signs[s as usize] * signs[t as usize];
                if agreement > 0.0 && !std::mem::replace(&mut seen[t as usize], true) {
                    group.push(t);
                }
            }
            next += 1;
        }
        group
    }

    /// What turning a group would cost.
    fn holds(&self, group: &[u32], is_inside: impl Fn(u32) -> bool, signs: &[f32]) -> f32 {
        let mut holds = 0.0;
        for &s in group {
            for &(e, t) in self.adjacency.of(s) {
                if !is_inside(t) {
                    let weight = self.edges[e as usize].weight;
                    holds += weight * signs[s as usize] * signs[t as usize];
                }
            }
        }
        holds
    }

    /// Turns groups, and leaves those turned for which that mends it: a sheet beside a wrong one has the winding number of
    /// an inverted one, turned or not.
    fn turn_those_that_mend(&self, groups: &[Vec<u32>], signs: &mut [f32]) {
        let turn = |group: &[u32], signs: &mut [f32]| {
            group
                .iter()
                .for_each(|&s| signs[s as usize] = -signs[s as usize]);
        };
        groups.iter().for_each(|group| turn(group, signs));
        let mut after = self.domains.winding(&groups.concat(), signs).into_iter();
        for group in groups {
            if after.by_ref().take(group.len()).sum::<f64>() <= 0.0 {
                turn(group, signs);
            }
        }
    }
}
