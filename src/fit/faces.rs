//! The faces of a sub-domain that holds a crease or a corner.
//!
//! One smooth function rounds a crease off. So sites are shared out by their normals, every face gets a function of its own,
//! and the largest of them is the sub-domain's where the crease is convex, the least where it is concave (Ohtake et al.,
//! "Multi-level partition of unity implicits", 2003, section 4.3).

use crate::fit::cells::{Sites, Subdomain};
use glam::Vec3;

/// Normals farther apart than this (cosine of 40°) may belong to two faces, and one farther than this from the faces' to a
/// third. On two machined models that the bench does not use 32° rounds more edges off, 46 and 53° are the same.
const CREASE_COSINE: f32 = 0.766;
/// Sites that a face must have; more leaves corners to the smooth function.
const FEWEST: usize = 4;
/// Rounds of sharing out.
const ROUNDS: usize = 4;

/// Faces that meet in a crease or a corner.
pub(crate) struct Faces {
    /// The sites of each with their normals.
    pub(crate) sites: Vec<Vec<(u32, Vec3)>>,
    /// Whether they meet like the walls of a room, seen from outside.
    pub(crate) concave: bool,
}

impl Faces {
    /// Finds them; `None` where there is one only, or where they meet in different ways.
    pub(crate) fn of(s: &Subdomain, sites: &Sites) -> Option<Faces> {
        let mut axes = farthest_pair(&s.normals)?;
        let mut owner = share_out(&s.normals, &mut axes);
        let (turn, third) = s
            .normals
            .iter()
            .zip(&owner)
            .map(|(n, &face)| (n.dot(axes[face]), *n))
            .min_by(|a, b| a.0.total_cmp(&b.0))?;
        if turn < CREASE_COSINE {
            axes.push(third);
            owner = share_out(&s.normals, &mut axes);
        }
        let mut faces = vec![Vec::new(); axes.len()];
        for ((&i, &n), &face) in s.support.iter().zip(&s.normals).zip(&owner) {
            faces[face].push((i, n));
        }
        // What little of a face is seen beyond the core says nothing; in the core it must be more.
        let own = &owner[..s.core];
        if (0..axes.len()).any(|f| faces[f].len() < FEWEST && own.contains(&f)) {
            return None;
        }
        let enough: Vec<usize> = (0..axes.len())
            .filter(|&f| faces[f].len() >= FEWEST)
            .collect();
        let axes: Vec<Vec3> = enough.iter().map(|&f| axes[f]).collect();
        let faces: Vec<Vec<(u32, Vec3)>> = enough.iter().map(|&f| faces[f].clone()).collect();
        let middle = |f: usize| {
            let positions = faces[f].iter().map(|&(i, _)| sites.tree.points[i as usize]);
            positions.sum::<Vec3>() / faces[f].len() as f32
        };
        let mut concave = None;
        for a in 0..axes.len() {
            for b in (0..axes.len()).filter(|&b| b != a) {
                let rises = axes[a].dot(middle(b) - middle(a)) > 0.0;
                if *concave.get_or_insert(rises) != rises {
                    return None;
                }
            }
        }
        Some(Faces {
            sites: faces,
            concave: concave.unwrap_or(false),
        })
    }
}

/// The two normals that are farthest apart, unless that is not far: the farthest from the mean and the farthest from it.
fn farthest_pair(normals: &[Vec3]) -> Option<Vec<Vec3>> {
    let farthest = |from: Vec3| {
        let away = |a: &&Vec3, b: &&Vec3| a.dot(from).total_cmp(&b.dot(from));
        normals.iter().min_by(away).copied()
    };
    let first = farthest(normals.iter().sum())?;
    let second = farthest(first)?;
    (first.dot(second) < CREASE_COSINE).then(|| vec![first, second])
}

/// The face of every normal: that with the nearest axis, which then becomes the mean of its normals.
fn share_out(normals: &[Vec3], axes: &mut [Vec3]) -> Vec<usize> {
    let nearest = |n: &Vec3, axes: &[Vec3]| {
        let near = |&a: &usize, &b: &usize| n.dot(axes[a]).total_cmp(&n.dot(axes[b]));
        (0..axes.len()).max_by(near).unwrap_or(0)
    };
    let mut owner = Vec::new();
    for _ in 0..ROUNDS {
        owner = normals.iter().map(|n| nearest(n, axes)).collect();
        let mut sums = vec![Vec3::ZERO; axes.len()];
        for (n, &face) in normals.iter().zip(&owner) {
            sums[face] += *n;
        }
        for (axis, sum) in axes.iter_mut().zip(sums) {
            *axis = sum.normalize_or(*axis);
        }
    }
    owner
}
