//! The input point nearest to each reduced point.
//!
//! Most often it is a member. Reduced points that follow each other lie together: a chunk of them gathers once what can be nearer
//! than their nearest members, and looks at all of it eight at a time.

use glam::Vec3;

use crate::base::par;
use crate::cloud::neighborhood::Neighborhood;
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;
use crate::reduce::placement::{Members, Placed};

/// Reduced points that ask together.
const CHUNK: usize = 24;

/// Widens a box, so that no point at the rim is lost to rounding.
const RIM: f32 = 1.0001;

/// The nearest input points, in the octree's order; of equally near ones a member, then the first.
pub(crate) fn nearest(tree: &Octree, members: &Members, placed: &[Placed]) -> Vec<u32> {
    let none = Neighbor {
        distance2: f32::INFINITY,
        index: 0,
    };
    par::flat_map(
        placed.len().div_ceil(CHUNK),
        placed.len(),
        Neighborhood::default,
        |chunk, hood| {
            let start = chunk * CHUNK;
            let end = (start + CHUNK).min(placed.len());
            let (mut lo, mut hi) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
            let mut own: Vec<Neighbor> = Vec::with_capacity(CHUNK);
            for (i, Placed { position: p, .. }) in (start..).zip(&placed[start..end]) {
                let mut best = none;
                for (index, _) in members.of(i) {
                    let distance2 = tree.points[index as usize].distance_squared(*p);
                    if distance2 < best.distance2 {
                        best = Neighbor { distance2, index };
                    }
                }
                let reach = Vec3::splat(best.distance2.sqrt() * RIM);
                (lo, hi) = (lo.min(*p - reach), hi.max(*p + reach));
                own.push(best);
            }
            let are_gathered = hood.gather(tree, (lo, hi), 0.0);
            let of = |(own, at): (Neighbor, &Placed)| match are_gathered {
                true => hood.nearer_than(own, at.position).index,
                false => tree.nearer_than(own, at.position).index,
            };
            own.into_iter().zip(&placed[start..end]).map(of).collect()
        },
    )
}
