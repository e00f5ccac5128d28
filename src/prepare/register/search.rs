//! Which scans fit each other: those that do as they lie, then those that do after a motion.

use super::agreement::{Agreement, LEAST, Posed};
use super::align::{NARROW, WIDE, align};
use super::candidates::candidates;
use super::describe;
use super::groups::{Groups, Motion};
use super::pose::Pose;
use super::samples::Samples;
use super::views::{View, Views};
use crate::base::error::Result;
use crate::base::par;
use crate::base::progress::{Progress, Stage};
use crate::base::sort_keys::{key, ranked, sort_by_key, unpack};

/// Candidates that are refined.
const REFINED: usize = 6;
/// Quality from which on a motion is remembered.
const LIKELY: f64 = 0.6;
/// How far two motions that lead to one place may end apart, in fine cells.
const SAME: f64 = 3.0;
/// A pair fits in two ways when the second has this share of the first's weight.
const RIVAL: f64 = 0.8;

/// Joins scans that fit without a motion, or with one of less than a cell.
pub(crate) fn as_they_lie(
    views: &Views,
    groups: &mut Groups,
    progress: &mut dyn Progress,
) -> Result<()> {
    let all = pairs(views.all.len());
    for (k, &(to, from)) in all.iter().enumerate() {
        progress.update(Stage::Prepare, k as f32 / all.len() as f32)?;
        let (a, b) = (&views.all[from], &views.all[to]);
        let still = views.still(from, to);
        if groups.are_joined(from, to) || !Agreement::of(&a.coarse, &still, &b.coarse).overlaps() {
            continue;
        }
        let pose = fine(coarse(still, a, b), a, b);
        let motion = Motion { from, to, pose };
        let is_near = pose.apart(&still, a.coarse.ball()) < f64::from(a.coarse.cell);
        if is_near && together(views, groups, &motion).is_trusted() {
            groups.join(&motion);
        }
    }
    Ok(())
}

/// Looks for motions between scans that no group holds together yet, neighbours in the list first, and joins those that are beyond doubt.
/// Gives all that are likely.
pub(crate) fn search(
    views: &mut Views,
    groups: &mut Groups,
    progress: &mut dyn Progress,
) -> Result<Vec<Motion>> {
    let mut likely = Vec::new();
    let all = pairs(views.all.len());
    for (k, &(to, from)) in all.iter().enumerate() {
        progress.update(Stage::Prepare, k as f32 / all.len() as f32)?;
        let is_small = |k: usize| views.all[k].fine.len() < LEAST;
        if groups.are_joined(from, to) || is_small(from) || is_small(to) {
            continue;
        }
        let motions = motions(views, (from, to));
        progress.update(Stage::Prepare, (k as f32 + 0.5) / all.len() as f32)?;
        let mut found = distinct(views, (from, to), &motions);
        found.retain(|(_, agreement)| agreement.quality() >= LIKELY);
        if let [(motion, best), others @ ..] = &found[..] {
            let is_rival = |(_, other): &(Motion, Agreement)| {
                other.is_trusted() && other.weight() > RIVAL * best.weight()
            };
            let alone = best.is_firm() && !others.iter().any(is_rival);
            if alone && together(views, groups, motion).is_trusted() {
                groups.join(motion);
            }
        }
        likely.extend(found.into_iter().map(|(motion, _)| motion));
    }
    Ok(likely)
}

/// Candidates for the motion of one scan onto another.
fn motions(views: &mut Views, (from, to): (usize, usize)) -> Vec<Pose> {
    for k in [from, to] {
        let View { coarse, looks, .. } = &mut views.all[k];
        looks.get_or_insert_with(|| describe::looks(coarse));
    }
    let described = |k: usize| {
        let View { coarse, looks, .. } = &views.all[k];
        (coarse, looks.as_deref().unwrap_or_default())
    };
    candidates(described(from), described(to))
}

/// Candidates where they lead, each place once, the best first.
fn distinct(
    views: &Views,
    (from, to): (usize, usize),
    candidates: &[Pose],
) -> Vec<(Motion, Agreement)> {
    let (a, b) = (&views.all[from], &views.all[to]);
    let rate = |k: usize, _: &mut ()| Agreement::of(&a.coarse, &candidates[k], &b.coarse).weight();
    let rates = par::map(candidates.len(), || (), rate);
    let order = ranked(rates.iter().map(|&rate| !key(rate as f32)));
    let order = order.into_iter().map(|packed| unpack(packed).1 as usize);
    let mut found: Vec<(Motion, Agreement)> = Vec::new();
    let (ball, apart) = (a.fine.ball(), SAME * f64::from(a.fine.cell));
    for k in order.take(REFINED) {
        let pose = coarse(candidates[k], a, b);
        let is_new = |other: &(Motion, Agreement)| other.0.pose.apart(&pose, ball) > apart;
        let is_likely = Agreement::of(&a.coarse, &pose, &b.coarse).quality() >= LIKELY;
        if is_likely && found.iter().all(is_new) {
            let pose = fine(pose, a, b);
            let agreement = Agreement::of(&a.fine, &pose, &b.fine);
            found.push((Motion { from, to, pose }, agreement));
        }
    }
    sort_by_key(&mut found, |(_, agreement)| !key(agreement.weight() as f32));
    found
}

/// Where the coarse samples lead a motion of `a` onto `b`.
fn coarse(pose: Pose, a: &View, b: &View) -> Pose {
    let mut poses = [Pose::IDENTITY, pose];
    align(&[&b.coarse, &a.coarse], &mut poses, &[(1, 0)], &WIDE);
    poses[1]
}

/// Where the fine samples do.
fn fine(pose: Pose, a: &View, b: &View) -> Pose {
    let mut poses = [Pose::IDENTITY, pose];
    align(&[&b.fine, &a.fine], &mut poses, &[(1, 0)], &NARROW);
    poses[1]
}

/// How two whole groups fit when one pair of their scans is joined by a motion.
fn together(views: &Views, groups: &Groups, motion: &Motion) -> Agreement {
    let posed = |group: Vec<(usize, Pose)>| {
        let each = group.into_iter();
        each.map(|(k, pose)| (&views.all[k].fine, pose))
            .collect::<Vec<Posed>>()
    };
    let [from, to] = groups.both(motion).map(posed);
    Agreement::between(&from, &to)
}

/// Joins groups by the motion by which they fit best as wholes, as long as there is one to be trusted.
pub(crate) fn join_groups(
    views: &Views,
    groups: &mut Groups,
    likely: &[Motion],
    progress: &mut dyn Progress,
) -> Result<()> {
    loop {
        let mut best: Option<(&Motion, f64)> = None;
        for motion in likely {
            progress.update(Stage::Prepare, 0.0)?;
            if groups.are_joined(motion.from, motion.to) {
                continue;
            }
            let sum = together(views, groups, motion);
            if sum.is_trusted() && best.is_none_or(|(_, weight)| sum.weight() > weight) {
                best = Some((motion, sum.weight()));
            }
        }
        match best {
            Some((motion, _)) => groups.join(motion),
            None => return Ok(()),
        }
    }
}

/// Which scans of one frame overlap, and how.
pub(crate) fn overlaps(scans: &[&Samples], poses: &[Pose]) -> Vec<((usize, usize), Agreement)> {
    let mut found = Vec::new();
    for (a, b) in pairs(scans.len()) {
        let agreement = Agreement::of(scans[a], &poses[b].back().after(&poses[a]), scans[b]);
        if agreement.overlaps() {
            found.push(((a, b), agreement));
        }
    }
    found
}

/// All pairs of so many, those whose numbers are near each other first.
fn pairs(count: usize) -> Vec<(usize, usize)> {
    (1..count)
        .flat_map(|apart| (0..count - apart).map(move |a| (a, a + apart)))
        .collect()
}
