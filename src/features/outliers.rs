//! Isolated points: stray returns around a scan, and small clumps of them far away.
//!
//! 1. A point's *reach* is [`REACH`] times the distance to the last of its [`CLUMP`] - 1 nearest, about three spacings on a
//!    surface. Points among each other's [`NEAREST`] are *friends* when they are within each other's reach. A stray point is
//!    within no reach of the surface beside it, nor others within that of a clump, which has its own friends alone (mutual
//!    neighbours: Brito, Chávez, Quiroz, Yukich, "Connectivity of the mutual k-nearest-neighbor graph in clustering and
//!    outlier detection", 1997).
//! 2. Stray points that are many have each other for friends. They fill space, and are sparser than the surfaces beside
//!    them; a sparse part of a surface is flat, and a fine or a noisy part dense. So a point with [`CLUMP`] friends or more
//!    is *settled* when they lie flat, or when its reach is at most [`SPARSE`] times that of the surface nearest to it.
//! 3. A point is isolated when it is not settled, and fewer than [`SETTLED`] of its friends are: points at a border, or where
//!    the density jumps, have few friends but good ones (border points: Ester, Kriegel, Sander, Xu, "A density-based algorithm
//!    for discovering clusters", 1996).
//!
//! The constants were measured on the shapes of the tests. Of clean ones, of their borders, corners and changes of density
//! of 15 : 1, and of noise of 0.5 % of the diagonal, nothing is dropped. Of points scattered evenly in a box around them that
//! are farther than 5 spacings and 5 standard deviations from the surface, 95-100 % are (1-10 % of the scan); the exception
//! is 10 % beside 100,000 points with noise of 0.5 %, where the scatter is as dense as the noise: 90 %. Of clumps, all.
//! Real scans of 14 kinds lose 0 to 0.14 %.

use std::ops::Range;

use glam::{DVec3, Vec3};

use crate::base::error::Result;
use crate::base::linalg::{outer, sym_eigen};
use crate::base::par;
use crate::base::progress::{Part, Progress, Stage};
use crate::cloud::copies::copies;
use crate::cloud::near::each_nearest;
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;

/// In place of a reduced point's index in an assignment: the input point was dropped.
pub const DROPPED: u32 = u32::MAX;

/// Largest clump that is dropped: its points have one friend fewer.
const CLUMP: usize = 8;
/// Reach in distances to the seventh nearest: on a surface 2² · 7 = 28 points are within it.
const REACH: f32 = 2.0;
/// Nearest points that may be friends. Beside a jump of density of 15 : 1 most of them are on the dense side, and are none.
const NEAREST: usize = 40;
/// Surface variation of friends up to which they lie flat, or along a line; that of a cloud in space is about 0.2.
const FLAT: f64 = 0.03;
/// Thickness of noise in standard deviations: for a sheet, and added to a reach.
const THICK: (f64, f32) = (1.5, 2.0);
/// Three points nearer to each other than this share of the distance to the seventh nearest are a clump. Clumps lie flat
/// where they are three, which says nothing.
const TIGHT: f32 = 0.2;
/// Points of sheets that tell how dense the surface nearest to a point is.
const SHEET: usize = 16;
/// Largest reach of a settled point whose friends do not lie flat, in those of the surface nearest to it.
const SPARSE: f32 = 2.0;
/// Settled friends that keep a point that is not settled. One would let points near a surface keep those behind them.
const SETTLED: usize = 2;

/// How the friends of a point lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Lie {
    /// They are a clump's at most.
    Few,
    /// In a plane or along a line.
    Flat,
    /// In a sheet as thick as the noise.
    Sheet,
    /// Otherwise.
    Bulk,
}

/// Which points are isolated, in the octree's order. `noise` is its standard deviation across the surface, in the unit
/// frame. Cost: two queries of 8 and 40 neighbours a point, as much as the features. Progress is of [`Stage::Features`].
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub fn isolated(tree: &Octree, noise: f32, progress: &mut dyn Progress) -> Result<Vec<bool>> {
    isolated_by(tree, (noise, f32::INFINITY), progress)
}

/// [`isolated`] of a part of a scan with this noise and median spacing, which may have no surface in it.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(crate) fn isolated_part(
    tree: &Octree,
    (noise, spacing): (f32, f32),
    progress: &mut dyn Progress,
) -> Result<Vec<bool>> {
    let disc = ((CLUMP - 1) as f32 / std::f32::consts::PI).sqrt();
    isolated_by(tree, (noise, REACH * disc * spacing), progress)
}

/// `usual` is the reach of points on a surface where there is none.
fn isolated_by(
    tree: &Octree,
    (noise, usual): (f32, f32),
    progress: &mut dyn Progress,
) -> Result<Vec<bool>> {
    // Copies of a point are no friends: one of each is looked at.
    let copies: Vec<Range<usize>> = copies(&tree.points);
    if copies.len() == tree.points.len() {
        return isolated_distinct(tree, (noise, usual), progress);
    }
    let distinct: Vec<Vec3> = copies.iter().map(|c| tree.points[c.start]).collect();
    let one = isolated_distinct(&Octree::build(&distinct), (noise, usual), progress)?;
    let each = copies.iter().zip(one);
    Ok(each
        .flat_map(|(c, isolated)| c.clone().map(move |_| isolated))
        .collect())
}

fn isolated_distinct(
    tree: &Octree,
    (noise, usual): (f32, f32),
    progress: &mut dyn Progress,
) -> Result<Vec<bool>> {
    let mut part = Part::new(progress, 0.0..0.3);
    let told = (Stage::Features, &mut part as &mut dyn Progress);
    let reach = each_nearest(tree, CLUMP, None, told, |_, found| {
        REACH * found[found.len() - 1].distance2.sqrt()
    })?;
    let are_friends = |i: usize, f: &Neighbor| {
        let j = f.index as usize;
        j != i && f.distance2.sqrt() <= reach[i].min(reach[j]) + THICK.1 * noise
    };
    let mut part = Part::new(part.progress, 0.3..1.0);
    let told = (Stage::Features, &mut part as &mut dyn Progress);
    let within = |i: usize| reach[i] + THICK.1 * noise;
    let lie = each_nearest(tree, NEAREST + 1, Some(&within), told, |i, found| {
        found.retain(|f| are_friends(i, f));
        lie(tree, i, found, reach[i], noise)
    })?;
    let settled = settled(tree, &lie, (&reach, usual));
    let each = |i: usize, found: &mut Vec<Neighbor>| {
        if settled[i] {
            return false;
        }
        tree.knn(tree.points[i], NEAREST + 1, found);
        let friends = found.iter().filter(|f| are_friends(i, f));
        friends.filter(|f| settled[f.index as usize]).count() < SETTLED
    };
    Ok(par::map(tree.points.len(), Vec::new, each))
}

/// How these friends of point `i`, nearest first, lie together with it.
fn lie(tree: &Octree, i: usize, friends: &[Neighbor], reach: f32, noise: f32) -> Lie {
    if friends.len() < CLUMP {
        return Lie::Few;
    }
    if friends[1].distance2.sqrt() < TIGHT * reach / REACH {
        return Lie::Bulk;
    }
    let from_here = |f: &Neighbor| (tree.points[f.index as usize] - tree.points[i]).as_dvec3();
    let count = (friends.len() + 1) as f64;
    let mean = friends.iter().map(from_here).sum::<DVec3>() / count;
    // The point itself lies at the origin.
    let mut covariance = outer(mean).map(|x| x / count);
    for friend in friends {
        let products = outer(from_here(friend) - mean);
        for (sum, product) in covariance.iter_mut().zip(products) {
            *sum += product / count;
        }
    }
    let [thin, middle, long] = sym_eigen(&covariance).values;
    if thin <= FLAT * (thin + middle + long) {
        Lie::Flat
    } else if thin.sqrt() <= THICK.0 * f64::from(noise) {
        Lie::Sheet
    } else {
        Lie::Bulk
    }
}

/// Which points are settled: step 2.
fn settled(tree: &Octree, lie: &[Lie], (reach, usual): (&[f32], f32)) -> Vec<bool> {
    let on_sheets: Vec<usize> = (0..lie.len())
        .filter(|&i| matches!(lie[i], Lie::Flat | Lie::Sheet))
        .collect();
    let points: Vec<Vec3> = on_sheets.iter().map(|&i| tree.points[i]).collect();
    let sheets = Octree::build(&points);
    par::map(lie.len(), Vec::new, |i, found: &mut Vec<Neighbor>| {
        if lie[i] == Lie::Few || lie[i] == Lie::Flat {
            return lie[i] == Lie::Flat;
        }
        if points.is_empty() {
            return reach[i] <= SPARSE * usual;
        }
        sheets.knn(tree.points[i], SHEET, found);
        let reach_of = |f: &Neighbor| reach[on_sheets[sheets.order[f.index as usize] as usize]];
        let mut around: Vec<f32> = found.iter().map(reach_of).collect();
        around.sort_unstable_by(f32::total_cmp);
        reach[i] <= SPARSE * around[around.len() / 2]
    })
}
