//! What decided which side is out, as the report says it.

use crate::orient::domains::Domains;
use crate::orient::graph::Edge;
use crate::orient::solved::Solved;
use crate::orient::source::SOME;
use serde::Serialize;

pub use crate::orient::source::Source;

/// What a source had to say.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct SourceShare {
    /// Which.
    pub source: Source,
    /// Share of the surface (0-1) whose side it decided.
    pub share: f64,
    /// Share of what it says anything about (0-1) where the result agrees with it.
    pub agreement: f64,
}

/// The part of the surface whose side hangs on the least.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct WeakestTie {
    /// Share of the surface (0-1) that would turn.
    pub share: f64,
    /// What holds it: the weights at its border that speak for its side less those against it, over the root of its
    /// sub-domains' number. Parts of one smooth sheet have 1.5 and more.
    pub strength: f64,
}

/// What decided which side is out.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Account {
    /// Every source that said anything; the shares add up to 1.
    pub sources: Vec<SourceShare>,
    /// Share of the surface (0-1) whose side is a guess.
    pub guessed: f64,
    /// Of the parts that are tied to others and have over 1 % of the surface, that no normal or viewpoint decided, and at
    /// which the whole encloses nothing.
    pub weakest_tie: Option<WeakestTie>,
}

/// Parts of a smaller share of the surface are not worth a warning.
const LARGE: f32 = 0.01;

/// What decided for which share of the surface.
pub(crate) fn of(domains: &Domains, edges: &[Edge], solved: &Solved) -> Account {
    let areas: Vec<f32> = (0..domains.len() as u32).map(|s| domains.area(s)).collect();
    let total: f32 = areas.iter().sum::<f32>().max(f32::MIN_POSITIVE);
    let share = |which: &dyn Fn(usize) -> bool| {
        let of = (0..areas.len()).filter(|&s| which(s)).map(|s| areas[s]);
        // The sum of nothing would be −0.
        f64::from(of.fold(0.0, |sum, area| sum + area) / total)
    };
    let mut sources = Vec::new();
    for source in Source::ALL {
        let decided = share(&|s| solved.sources[s] == source);
        let said = solved.said.iter().find(|said| said.0 == source);
        let agreement = said.map_or(1.0, |(_, says)| {
            let all = share(&|s| says[s].abs() > SOME);
            let agrees = share(&|s| says[s] * solved.signs[s] > SOME);
            if all > 0.0 { agrees / all } else { 1.0 }
        });
        if decided > 0.0 || said.is_some() {
            sources.push(SourceShare {
                source,
                share: decided,
                agreement,
            });
        }
    }
    Account {
        guessed: share(&|s| solved.sources[s] == Source::Guess),
        sources,
        weakest_tie: weakest_tie(solved, edges, &areas, total),
    }
}

/// [`Account::weakest_tie`].
fn weakest_tie(solved: &Solved, edges: &[Edge], areas: &[f32], total: f32) -> Option<WeakestTie> {
    let (parts, enclosing) = solved.parts.as_ref()?;
    let sums = parts.sums(|s| areas[s as usize]);
    let mut ties = vec![None; parts.count()];
    for e in edges {
        let (p, q) = (parts.of[e.a as usize], parts.of[e.b as usize]);
        if p != q {
            let holds = e.weight * solved.signs[e.a as usize] * solved.signs[e.b as usize];
            *ties[p as usize].get_or_insert(0.0) += holds;
            *ties[q as usize].get_or_insert(0.0) += holds;
        }
    }
    let mut weakest: Option<WeakestTie> = None;
    for (p, holds) in (0..).zip(ties) {
        let members = parts.members.of(p);
        let source = solved.sources[members[0] as usize];
        let is_known =
            enclosing[p as usize] || !matches!(source, Source::Shell | Source::Up | Source::Guess);
        // What would turn is the part, or all but the part where that is less.
        let area = sums[p as usize].min(total - sums[p as usize]);
        let count = members.len().min(solved.signs.len() - members.len());
        let (Some(holds), false, true) = (holds, is_known, area > LARGE * total) else {
            continue;
        };
        let tie = WeakestTie {
            share: f64::from(area / total),
            strength: f64::from(holds / (count as f32).sqrt()),
        };
        if weakest.is_none_or(|w| tie.strength < w.strength) {
            weakest = Some(tie);
        }
    }
    weakest
}
