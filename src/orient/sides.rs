//! Which side of every part is out: evidence, else what it encloses, else up; and what its neighbours say.

use crate::orient::account::Source;
use crate::orient::descent::descend;
use crate::orient::domains::Domains;
use crate::orient::evidence::{Evidence, Known};
use crate::orient::graph::{Edge, adjacency, components};
use crate::orient::parts::{Parts, Tie};
use crate::orient::seen::together;
use glam::Vec3;

/// Mean agreement with the evidence from which on a part needs nothing else.
const KNOWN: f32 = 0.05;
/// Mean winding number over a part's own sites from which on it is a shell with an inside: ½ where it is closed, 0.28 to 0.36
/// for vases and bins, under 0.03 for discs and gentle terrains, 0.09 for a steep one.
const SHELL: f32 = 0.12;
/// How evidence, a shell at most and up count against each other, times √ the sub-domains.
const EVIDENCE: f32 = 4.0;
const CLOSED: f32 = 4.0;
const UPWARD: f32 = 0.3;
/// Share of a sheet's mean normal that is along up, for up to say anything.
const ALONG: f32 = 0.2;

/// Parts are a group when what ties them is more than this times √ the sub-domains of the smaller.
const TIED: f32 = 0.5;

/// Mean winding number from which on a group is closed enough: a corner of a room has 0.2.
const WHOLE: f32 = 0.35;

/// What a part says of its own side.
#[derive(Debug, Clone, Copy)]
struct Vote {
    source: Source,
    /// Positive where its present sign is right.
    weight: f32,
}

/// Turns whole parts so that they agree with what is known of them and with their neighbours; what decided for each.
pub(crate) fn turn_parts(
    domains: &Domains,
    parts: &Parts,
    known: &Known,
    evidence: &Evidence,
    signs: &mut [f32],
) -> Vec<Source> {
    let mut votes: Vec<Vote> = (0..parts.count() as u32)
        .map(|p| vote(domains, parts.members.of(p), known, evidence, signs))
        .collect();
    ask_groups(domains, parts, signs, &mut votes);
    let mut said: Vec<(u32, u32, f32)> =
        parts.ties.iter().map(|t| (t.a, t.b, t.strength)).collect();
    if votes
        .iter()
        .any(|v| matches!(v.source, Source::Shell | Source::Up | Source::Guess))
    {
        said.extend(together(domains, parts, signs));
    }
    let edges: Vec<Edge> = said
        .into_iter()
        .filter(|e| e.2 != 0.0)
        .map(|(a, b, weight)| Edge { a, b, weight })
        .collect();
    let unary: Vec<f32> = votes.iter().map(|v| v.weight).collect();
    let mut turned = vec![1.0; parts.count()];
    descend(&edges, &unary, &mut turned);
    for (&p, sign) in parts.of.iter().zip(signs.iter_mut()) {
        *sign *= turned[p as usize];
    }
    decided(&votes, &edges, &turned)
}

/// Faces that are parts of their own, of a box of few points: what parts without an inside of their own enclose together is
/// what decides for each.
fn ask_groups(domains: &Domains, parts: &Parts, signs: &[f32], votes: &mut [Vote]) {
    let size = |p: u32| parts.members.of(p).len() as f32;
    let is_tied = |t: &&Tie| t.strength.abs() > TIED * size(t.a).min(size(t.b)).sqrt();
    let tied: Vec<Edge> = parts
        .ties
        .iter()
        .filter(is_tied)
        .map(|t| Edge {
            a: t.a,
            b: t.b,
            weight: t.strength,
        })
        .collect();
    let mut turned = vec![1.0; parts.count()];
    descend(&tied, &vec![0.0; parts.count()], &mut turned);
    for group in components(&adjacency(parts.count(), &tied)) {
        let is_open = |p: &u32| matches!(votes[*p as usize].source, Source::Up | Source::Guess);
        if group.len() < 2 || !group.iter().all(is_open) {
            continue;
        }
        let mut signs = signs.to_vec();
        for &p in group.iter().filter(|&&p| turned[p as usize] < 0.0) {
            parts.turn(p, &mut signs);
        }
        let members: Vec<u32> = group
            .iter()
            .flat_map(|&p| parts.members.of(p))
            .copied()
            .collect();
        let shell = domains.enclosed(&members, &signs) as f32;
        if shell.abs() > WHOLE {
            for &p in &group {
                let weight = (shell / SHELL).clamp(-CLOSED, CLOSED) * size(p).sqrt();
                votes[p as usize] = Vote {
                    source: Source::Shell,
                    weight: weight * turned[p as usize],
                };
            }
        }
    }
}

fn vote(
    domains: &Domains,
    part: &[u32],
    known: &Known,
    evidence: &Evidence,
    signs: &[f32],
) -> Vote {
    let root = (part.len() as f32).sqrt();
    let told = |&s: &u32| known.values[s as usize] * signs[s as usize];
    let told = part.iter().map(told).sum::<f32>() / part.len() as f32;
    if told.abs() > KNOWN {
        let sources = part.iter().map(|&s| known.sources[s as usize]);
        let count = |source| sources.clone().filter(|s| *s == source).count();
        let counts = Source::ALL.map(|source| (source, count(source)));
        let known = counts.into_iter().filter(|c| c.0 != Source::Guess);
        let most = known.reduce(|best, c| if c.1 > best.1 { c } else { best });
        return Vote {
            source: most.map_or(Source::Guess, |m| m.0),
            weight: EVIDENCE * told * root,
        };
    }
    let shell = domains.enclosed(part, signs) as f32;
    if shell.abs() > SHELL {
        return Vote {
            source: Source::Shell,
            weight: (shell / SHELL).clamp(-CLOSED, CLOSED) * root,
        };
    }
    let (mut flux, mut area) = (Vec3::ZERO, f32::MIN_POSITIVE);
    for &s in part {
        for (i, g) in domains.core(s) {
            flux += g * (signs[s as usize] * domains.site_area(i));
            area += domains.site_area(i);
        }
    }
    let flux = flux / area;
    let along = flux.dot(evidence.axis());
    if along.abs() > ALONG * flux.length() {
        let source = evidence.up.map_or(Source::Guess, |_| Source::Up);
        Vote {
            source,
            weight: UPWARD * along * root,
        }
    } else {
        Vote {
            source: Source::Guess,
            weight: UPWARD * UPWARD * flux[flux.abs().max_position()] * root,
        }
    }
}

/// What decided for every part: what it says itself, or what decided for the one that it is tied to more than that.
fn decided(votes: &[Vote], edges: &[Edge], signs: &[f32]) -> Vec<Source> {
    let mut best: Vec<(f32, usize)> = votes
        .iter()
        .enumerate()
        .map(|(p, v)| (v.weight.abs(), p))
        .collect();
    let is_own = |v: &Vote| !matches!(v.source, Source::Up | Source::Guess);
    for e in edges {
        let agreement = e.weight * signs[e.a as usize] * signs[e.b as usize];
        for (p, q) in [(e.a as usize, e.b as usize), (e.b as usize, e.a as usize)] {
            if !is_own(&votes[p]) && is_own(&votes[q]) && agreement > best[p].0 {
                best[p] = (agreement, q);
            }
        }
    }
    best.iter().map(|b| votes[b.1].source).collect()
}
