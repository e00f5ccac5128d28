//! Scans that lie in frames of their own are brought into one, and what does not fit is left out.
//!
//! 1. [`samples`], [`views`]: of every scan points some way apart with their normals, coarse to fine. Normals have no sign here.
//! 2. [`mod@search`]: scans that fit as they lie stay together. For others [`describe`] and [`candidates`] give motions on which points
//!    that look alike agree; [`mod@align`] refines each, and [`agreement`] says whether to trust it: enough of the one lies on the
//!    other, next to nothing stands against it, and what lies on it holds it in all six ways to move.
//! 3. [`groups`]: trusted pairs make groups. A motion that one pair of scans does not carry may be carried by all pairs of two groups.
//! 4. The largest group is aligned as a whole, over all pairs that overlap. [`gains`] evens its colours out.
//!
//! **In**: clouds, each in its own unit frame. **Out**: [`Registered`]: for each a [`Pose`] to the frame of the first that is placed, or the
//! reason why it has none.
//!
//! **Cost**: a sort of the points of each scan, and some 0.2 s of one core for two scans that are searched, whatever their size. Of scans in
//! a round each of which overlaps with the next, about as many pairs are searched as there are scans; of scans that fit none, all.

mod agreement;
mod align;
mod candidates;
mod describe;
mod gains;
mod groups;
mod pose;
mod samples;
mod search;
mod views;

use crate::base::error::Result;
use crate::base::progress::{Part, Progress, Stage};
use crate::base::sort_keys::{key, sort_by_key};
use crate::cloud::Cloud;
use agreement::{Agreement, LEAST};
use align::{NARROW, SHARP, WIDE, align};
use groups::{Groups, Motion};
use samples::Samples;
use search::{as_they_lie, join_groups, overlaps, search};
use views::Views;

pub use pose::Pose;

/// Where the scans lie.
#[derive(Debug, Clone, PartialEq)]
pub struct Registered {
    /// For each scan.
    pub scans: Vec<Placed>,
    /// Pairs of placed scans that overlap.
    pub pairs: Vec<Overlap>,
}

/// What became of a scan.
#[derive(Debug, Clone, PartialEq)]
pub struct Placed {
    /// From its own frame to that of the first placed scan, both the caller's; `None` where it is left out.
    pub pose: Option<Pose>,
    /// What its red, green and blue are multiplied by so that scans agree in colour; `None` where nothing is known of that.
    pub gain: Option<[f64; 3]>,
    /// Why it is left out; else empty.
    pub reason: String,
}

/// How two placed scans lie on each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Which scans, the lower number first.
    pub scans: [usize; 2],
    /// Share of a scan that lies on the other: that of the scan of which it is more.
    pub overlap: f64,
    /// Root of the mean square of their distances across the surface, in the caller's unit.
    pub rms: f64,
    /// Whether the pair alone would be enough to trust its place.
    pub trusted: bool,
}

/// Registers scans.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub fn register(clouds: &[Cloud], progress: &mut dyn Progress) -> Result<Registered> {
    let mut views = Views::of(clouds, &mut Part::new(progress, 0.0..0.2))?;
    let mut groups = Groups::of(clouds.len());
    as_they_lie(&views, &mut groups, &mut Part::new(progress, 0.2..0.3))?;
    let likely = search(&mut views, &mut groups, &mut Part::new(progress, 0.3..0.7))?;
    join_groups(
        &views,
        &mut groups,
        &likely,
        &mut Part::new(progress, 0.7..0.8),
    )?;
    let (members, poses) = aligned(&views, &groups, &mut Part::new(progress, 0.8..1.0))?;
    let fine: Vec<&Samples> = members.iter().map(|&k| &views.all[k].fine).collect();
    let overlaps = overlaps(&fine, &poses);
    let gains = gains::gains(clouds, &members, &fine, &poses, &overlaps);
    let placed = |k: usize| match members.iter().position(|&member| member == k) {
        Some(at) => Placed {
            pose: Some(views.callers(&poses[at], k, members[0])),
            gain: gains[at],
            reason: String::new(),
        },
        None => Placed {
            pose: None,
            gain: None,
            reason: reason(&views, &groups, &likely, k),
        },
    };
    let overlap = |&((a, b), agreement): &((usize, usize), Agreement)| Overlap {
        scans: [members[a], members[b]],
        overlap: agreement.overlap(),
        rms: agreement.rms() * views.unit,
        trusted: agreement.is_trusted(),
    };
    Ok(Registered {
        scans: (0..clouds.len()).map(placed).collect(),
        pairs: overlaps.iter().map(overlap).collect(),
    })
}

/// The scans of the largest group and their poses, aligned as a whole.
fn aligned(
    views: &Views,
    groups: &Groups,
    progress: &mut dyn Progress,
) -> Result<(Vec<usize>, Vec<Pose>)> {
    let (members, mut poses) = groups.largest();
    if members.len() == 1 {
        return Ok((members, poses));
    }
    let coarse: Vec<&Samples> = members.iter().map(|&k| &views.all[k].coarse).collect();
    let fine: Vec<&Samples> = members.iter().map(|&k| &views.all[k].fine).collect();
    let finest = views.finest(&members);
    let finest: Vec<&Samples> = finest.iter().collect();
    let levels = [
        (coarse, &WIDE[..]),
        (fine.clone(), &NARROW[..]),
        (finest, &SHARP[..]),
    ];
    for (k, (samples, widths)) in levels.into_iter().enumerate() {
        progress.update(Stage::Prepare, k as f32 / 3.0)?;
        let links = links(members.len(), overlaps(&fine, &poses));
        align(&samples, &mut poses, &links, widths);
    }
    Ok((members, poses))
}

/// The pairs by which scans are aligned. What overlaps little does so where both were seen at a slant and are least true: a pair counts
/// when its overlap is at least half of the best that one of its scans has, or when nothing else holds the two together.
fn links(scans: usize, mut overlaps: Vec<((usize, usize), Agreement)>) -> Vec<(usize, usize)> {
    sort_by_key(&mut overlaps, |(_, agreement)| {
        !key(agreement.overlap() as f32)
    });
    let mut best = vec![0.0f64; scans];
    for &((a, b), agreement) in &overlaps {
        for k in [a, b] {
            best[k] = best[k].max(agreement.overlap());
        }
    }
    let mut held = Groups::of(scans);
    let mut links = Vec::new();
    for ((from, to), agreement) in overlaps {
        let is_much = agreement.overlap() >= 0.5 * best[from].min(best[to]);
        if is_much || !held.are_joined(from, to) {
            links.push((from, to));
            let pose = Pose::IDENTITY;
            held.join(&Motion { from, to, pose });
        }
    }
    links
}

/// Why a scan is in no group, or in a small one.
fn reason(views: &Views, groups: &Groups, likely: &[Motion], scan: usize) -> String {
    let others: Vec<String> = (0..views.all.len())
        .filter(|&other| other != scan && groups.are_joined(scan, other))
        .map(|other| format!("scan {other}"))
        .collect();
    if views.all[scan].fine.len() < LEAST {
        return "too few of its points are on a surface".into();
    }
    if !others.is_empty() {
        return format!("it fits {} and none of the others", others.join(", "));
    }
    let is_own = |motion: &Motion| motion.from == scan || motion.to == scan;
    match likely.iter().any(is_own) {
        true => "too little of it lies on another scan to be sure of its place".into(),
        false => "nothing of it looks like a part of another scan".into(),
    }
}
