//! Open borders stay where they are: a cluster's centre lies half a spacing inside of its members, so the outermost centres of
//! an open sheet would recede from its border. They are moved out to their outermost member.

use glam::Vec3;

use crate::base::par;
use crate::cloud::octree::Octree;
use crate::features::Features;
use crate::reduce::placement::{Members, Placed};
use crate::reduce::surroundings::Surroundings;

/// Distance of the weighted mean of a centre's neighbours from it, in radii, from which it may be at a border: a hexagonal
/// lattice has 0.16 along a straight border, less where the rows interlock.
const UNBALANCED: f32 = 0.06;
/// Radius of an empty disc just beyond the outermost member that makes a border, in spacings of the centres and of the input
/// points: random points leave one of 1.6 of their spacings empty in 3 of 10,000 places.
const EMPTY: [f32; 2] = [0.85, 1.6];
/// Members farther from the line outwards do not tell how far out it goes, in spacings.
const ASIDE: f32 = 0.6;

/// Moves the centres next to open borders.
pub(crate) fn restore(
    tree: &Octree,
    features: &Features,
    members: &Members,
    around: &[Surroundings],
    placed: &mut [Placed],
) {
    let unbalanced: Vec<usize> = (0..placed.len())
        .filter(|&i| around[i].mean.length() > UNBALANCED)
        .collect();
    let moved = par::map(
        unbalanced.len(),
        || (),
        |j, ()| {
            let i = unbalanced[j];
            outermost(tree, features, members.own(i), &placed[i], -around[i].mean)
        },
    );
    for (&i, position) in unbalanced.iter().zip(moved) {
        if let Some(position) = position {
            placed[i].position = position;
        }
    }
}

/// Where a centre at a border belongs; `None` where there is none.
fn outermost(
    tree: &Octree,
    features: &Features,
    members: impl Iterator<Item = u32>,
    placed: &Placed,
    outward: Vec3,
) -> Option<Vec3> {
    let Placed {
        position,
        normal,
        spacing,
        ..
    } = *placed;
    let outward = outward.reject_from(normal).try_normalize()?;
    let aside = normal.cross(outward);
    let mut farthest: Option<(f32, usize)> = None;
    for k in members {
        let k = k as usize;
        let d = features.denoised(tree, k) - position;
        let way = d.dot(outward);
        if d.dot(aside).abs() < ASIDE * spacing && farthest.is_none_or(|(most, _)| way > most) {
            farthest = Some((way, k));
        }
    }
    let (_, k) = farthest.filter(|&(way, _)| way > 0.0)?;
    let radius = (EMPTY[0] * spacing).max(EMPTY[1] * features.spacing[k]);
    let last = features.denoised(tree, k);
    let onwards = outward.reject_from(features.normals[k]).try_normalize()?;
    if tree.has_nearer(last + radius * onwards, 0.95 * radius) {
        return None;
    }
    let straight = last - (last - position).dot(aside) * aside;
    // Next to a corner straight out can be off the sheet.
    let off = !tree.has_nearer(straight, 0.75 * features.spacing[k]);
    Some(if off { last } else { straight })
}
