//! Planes that hold much of a scan, and which of them carry the rest: the floor, a table, a wall.
//!
//! 1. `search` finds the planes. They are the same for every order of threads, and for every seed as far as they are large.
//! 2. A plane's front is the side that it was seen from, or without viewpoints the side of most of what stands on it. `sheet` says
//!    what stands on it: what has the plane beneath it. A plane *carries* when at most a tenth of that is behind it, when its rim
//!    is not where other surfaces begin, as a face's of a block is, and when half of the scan, or something that touches it,
//!    stands on it; or when it is a large part of the scan and most of its rim is free.
//! 3. The *floor* is the plane that carries and lies across `up`, where one does; of several the one that most things touch.
//! 4. A point belongs to a plane when it lies within its points' spread and along it, or, where its normal says otherwise, within
//!    the noise and beside points that belong: where an object meets the plane, normals are those of neither.
//!
//! Distances to a plane are in standard deviations of the noise, so that a foot loses no more than the noise hides.

use crate::base::error::Result;
use crate::base::par;
use crate::base::progress::{Progress, Stage};
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;
use crate::features::Features;
use crate::prepare::search::{self, ALONG, Found, Voter};
use crate::prepare::sheet::Sheet;
use glam::{DVec3, Vec3};

/// Stands for a point of no plane.
pub const NONE: u32 = u32::MAX;
/// Smallest share of the area that a plane holds, unless another is asked for.
pub const MIN_SHARE: f64 = 0.05;

/// Within so many standard deviations of the plane's points one that lies along it belongs to it.
const SPREAD: f64 = 4.0;
/// Within so many of the noise, or this share of the spacing, any point may.
const WITHIN: (f64, f64) = (2.5, 0.1);
/// Neighbours that are asked whether they belong, and how many have to.
const BESIDE: (usize, usize) = (13, 4);
/// Least share of what stands on a plane that is in front of it, where it carries.
const IN_FRONT: f64 = 0.9;
/// Least share of the rim that is free, where it carries.
const FREE: f64 = 0.2;
/// Least share of the rest of the scan that stands on it, or that touches it, where it carries.
const STANDS: (f64, f64) = (0.5, 0.002);
/// Or: at least so much of its rim is free, and it holds at least this share of the scan's area. What stands on a table that is
/// seen from one side hides a part of it, so that nothing is beneath it.
const OPEN: (f64, f64) = (0.6, 0.2);
/// What is nearer than so many cells of the sheet touches the plane.
const TOUCHES: f64 = 2.0;
/// Cosine of the largest angle between a floor's normal and up: 37°.
const UPRIGHT: f64 = 0.8;

/// The planes of a scan.
#[derive(Debug, Clone)]
pub struct Planes {
    /// The plane of each point, in the octree's order, or [`NONE`].
    pub of: Vec<u32>,
    /// The planes, the largest first.
    pub all: Vec<Plane>,
    /// Which of them is the floor.
    pub floor: Option<usize>,
}

/// One plane, in the unit frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    /// Middle of its points.
    pub point: DVec3,
    /// Unit, to its front.
    pub normal: DVec3,
    /// Standard deviation of its points across it.
    pub sigma: f64,
    /// How many points belong to it.
    pub points: usize,
    /// Share of the scan's area, 0 to 1.
    pub share: f64,
    /// Area that its points stand for, in squares of the diagonal.
    pub area: f64,
    /// Whether it carries what stands on it.
    pub carries: bool,
    /// Share of what stands on it that is in front of it.
    pub in_front: f64,
    /// Share of its rim at which no other surface begins.
    pub free_rim: f64,
    /// Share of the rest of the scan that touches it away from its rim.
    pub touching: f64,
}

/// Which planes are dropped.
#[derive(Debug, Clone, PartialEq)]
pub enum Drop {
    /// None: the planes are looked for, and nothing else.
    None,
    /// The floor, with what is behind it.
    Floor,
    /// All that carry, with what is behind them.
    All,
    /// These, by number, and nothing behind them.
    Numbers(Vec<u32>),
}

/// What is known of a scan beside its points.
pub struct Known<'a> {
    /// Which way is up.
    pub up: Option<Vec3>,
    /// Where a point was seen from, in the octree's order, where that is told and no guess.
    pub eye: &'a (dyn Fn(usize) -> Option<Vec3> + Sync),
}

impl Planes {
    /// Finds planes with at least `min_share` (above 0) of the scan's area. Cost: a few passes over a sample, and one over all points.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub fn find(
        tree: &Octree,
        features: &Features,
        known: &Known,
        (min_share, seed): (f64, u64),
        progress: &mut dyn Progress,
    ) -> Result<Planes> {
        progress.update(Stage::Prepare, 0.0)?;
        let voters = search::voters(tree, features);
        let noise = f64::from(features.noise);
        // Without noise a plane is as thick as single precision makes it.
        let found = search::planes(&voters, noise.max(1e-6), min_share, seed);
        progress.update(Stage::Prepare, 0.4)?;
        let on_planes: Vec<bool> = (0..voters.len())
            .map(|k| found.iter().any(|plane| plane.own[k]))
            .collect();
        let seen = |found: &Found| seen_from_front(&voters, found, known.eye);
        let mut all: Vec<Plane> = found
            .iter()
            .map(|plane| judged(&voters, plane, &on_planes, seen(plane)))
            .collect();
        progress.update(Stage::Prepare, 0.5)?;
        let mut of = assigned(tree, features, &all);
        progress.update(Stage::Prepare, 1.0)?;
        for (&plane, &spacing) in of.iter().zip(&features.spacing) {
            if plane != NONE {
                let plane = &mut all[plane as usize];
                plane.points += 1;
                plane.area += f64::from(spacing) * f64::from(spacing);
            }
        }
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_by(|&a, &b| all[b].share.total_cmp(&all[a].share));
        let mut number = vec![NONE; all.len()];
        for (rank, &plane) in (0..).zip(&order) {
            number[plane] = rank;
        }
        for plane in of.iter_mut().filter(|plane| **plane != NONE) {
            *plane = number[*plane as usize];
        }
        let all: Vec<Plane> = order.into_iter().map(|plane| all[plane].clone()).collect();
        let floor = floor(&all, known.up.map(|up| up.as_dvec3()));
        Ok(Planes { of, all, floor })
    }

    /// Which planes are meant.
    pub fn chosen(&self, drop: &Drop) -> Vec<bool> {
        let is_chosen = |number: usize| match drop {
            Drop::None => false,
            Drop::Floor => self.floor == Some(number),
            Drop::All => self.all[number].carries,
            Drop::Numbers(numbers) => numbers.contains(&(number as u32)),
        };
        (0..self.all.len()).map(is_chosen).collect()
    }

    /// Which points go with these planes: their own, and where `behind` is true all that is behind one of them.
    pub fn dropped(&self, tree: &Octree, chosen: &[bool], behind: bool) -> Vec<bool> {
        let is_behind = |p: Vec3| {
            let mut planes = self.all.iter().zip(chosen);
            planes.any(|(plane, chosen)| *chosen && plane.height(p) < -SPREAD * plane.sigma)
        };
        let each = |i: usize, _: &mut ()| {
            let own = self.of[i] != NONE && chosen[self.of[i] as usize];
            own || behind && is_behind(tree.points[i])
        };
        par::map(tree.points.len(), || (), each)
    }
}

impl Plane {
    /// Signed distance of a point, positive in front.
    pub fn height(&self, p: Vec3) -> f64 {
        (p.as_dvec3() - self.point).dot(self.normal)
    }
}

/// Whether most of a plane's points were seen from the side that its normal points to; `None` where nobody knows.
fn seen_from_front(
    voters: &[Voter],
    found: &Found,
    eye: &(dyn Fn(usize) -> Option<Vec3> + Sync),
) -> Option<bool> {
    let own = voters.iter().zip(&found.own).filter(|&(_, own)| *own);
    let (mut seen, mut front) = (0u32, 0u32);
    for (voter, _) in own {
        if let Some(eye) = eye(voter.point) {
            seen += 1;
            front += u32::from((eye.as_dvec3() - found.point).dot(found.normal) > 0.0);
        }
    }
    (seen > 0).then_some(2 * front > seen)
}

/// What a plane is to the rest of the scan.
fn judged(
    voters: &[Voter],
    found: &Found,
    on_planes: &[bool],
    seen_from_front: Option<bool>,
) -> Plane {
    let own = |(voter, own): (&Voter, &bool)| own.then_some(voter.at);
    let points: Vec<Vec3> = voters.iter().zip(&found.own).filter_map(own).collect();
    let sheet = Sheet::of(&points, found.normal);
    let thick = SPREAD * found.sigma;
    let rest = || {
        let others = voters.iter().zip(&found.own).filter(|&(_, own)| !own);
        others.map(|(voter, _)| (voter.at, sheet.height(voter.at)))
    };
    let off = |&(_, height): &(Vec3, f64)| height.abs() > thick;
    let standing = || rest().filter(off).filter(|&(p, _)| sheet.is_beneath(p));
    let above = standing().filter(|&(_, height)| height > 0.0).count() as f64;
    let stands = standing().count() as f64;
    let all = (rest().count() as f64).max(1.0);
    let front = match seen_from_front {
        Some(true) => 1.0,
        Some(false) => -1.0,
        None if 2.0 * above >= stands => 1.0,
        None => -1.0,
    };
    let before = if front > 0.0 { above } else { stands - above };
    let in_front = before / stands.max(1.0);
    let near = |&(_, height): &(Vec3, f64)| {
        (thick..TOUCHES * sheet.cell + thick).contains(&(front * height))
    };
    // What lies on another plane touches this one where the two meet.
    let things = voters.iter().zip(on_planes).filter(|&(_, on)| !on);
    let things = things.map(|(voter, _)| (voter.at, sheet.height(voter.at)));
    let touching = things
        .filter(near)
        .filter(|&(p, _)| sheet.is_around(p))
        .count() as f64
        / all;
    let free_rim = sheet.free_rim(rest().filter(near).map(|(p, _)| p));
    let stands = stands / all;
    let open = free_rim >= FREE || seen_from_front.is_some();
    let bears = stands >= STANDS.0 || touching >= STANDS.1;
    let lies_open = free_rim >= OPEN.0 && found.share >= OPEN.1;
    Plane {
        point: found.point,
        normal: front * found.normal,
        sigma: found.sigma,
        points: 0,
        share: found.share,
        area: 0.0,
        carries: in_front >= IN_FRONT && (open && bears || lies_open),
        in_front,
        free_rim,
        touching,
    }
}

/// Which of these planes is the floor.
fn floor(all: &[Plane], up: Option<DVec3>) -> Option<usize> {
    let level = |i: &usize| up.is_none_or(|up| all[*i].normal.dot(up).abs() >= UPRIGHT);
    let carrying = || (0..all.len()).filter(|&i| all[i].carries);
    // A camera's up is not always the world's: where nothing lies across it, it says nothing.
    let is_any_level = carrying().any(|i| level(&i));
    let carrying = carrying().filter(|i| level(i) || !is_any_level);
    // Of equal ones the first, which is the largest.
    carrying.reduce(|best, next| {
        if all[next].touching > all[best].touching {
            next
        } else {
            best
        }
    })
}

/// The plane of each point, by its number in `all`.
fn assigned(tree: &Octree, features: &Features, all: &[Plane]) -> Vec<u32> {
    let n = tree.points.len();
    let noise = f64::from(features.noise);
    let nearest = |i: usize, along: bool| {
        let normal = features.normals[i].as_dvec3();
        let within = (WITHIN.0 * noise).max(WITHIN.1 * f64::from(features.spacing[i]));
        let limit = |plane: &Plane| match along {
            true => within.max(SPREAD * plane.sigma),
            false => within,
        };
        let mut best = (f64::INFINITY, NONE);
        for (number, plane) in (0..).zip(all) {
            let away = plane.height(tree.points[i]).abs();
            let agrees = !along || normal.dot(plane.normal).abs() >= ALONG;
            if agrees && away <= limit(plane) && away < best.0 {
                best = (away, number);
            }
        }
        best.1
    };
    let along = par::map(n, || (), |i, ()| nearest(i, true));
    par::map(n, Vec::new, |i, found: &mut Vec<Neighbor>| {
        if along[i] != NONE {
            return along[i];
        }
        let plane = nearest(i, false);
        if plane == NONE {
            return NONE;
        }
        tree.knn(tree.points[i], BESIDE.0, found);
        let beside = found.iter().filter(|f| along[f.index as usize] == plane);
        if beside.count() >= BESIDE.1 {
            plane
        } else {
            NONE
        }
    })
}
