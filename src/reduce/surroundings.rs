//! Where the other centres lie around each centre: the distance to the nearest, and the mean of those near it.

use glam::Vec3;

use crate::base::lanes::{LANES, Lanes};
use crate::base::par;
use crate::cloud::neighborhood::{Block, CELL, Neighborhood, bounds};
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;

/// Radius within which neighbours balance each other, in spacings: the first ring of a lattice of centres.
const RING: f32 = 1.7;

/// What is around one centre.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Surroundings {
    /// Squared distance to the nearest other centre; infinite where there is none.
    pub(crate) apart2: f32,
    /// Weighted mean of the centres around, from this one, in radii of [`RING`] spacings.
    pub(crate) mean: Vec3,
}

/// Memory of one worker.
#[derive(Default)]
struct Scratch {
    hood: Neighborhood,
    found: Vec<Neighbor>,
}

/// Measures every centre, in the order from which `index` was built; `spacing` in the same order.
pub(crate) fn measure(
    index: &Octree,
    spacing: impl Fn(usize) -> f32 + Sync + Send,
) -> Vec<Surroundings> {
    let spacing = |i: usize| spacing(index.order[i] as usize);
    let cells = index.cut(|node| node.range().len() <= CELL);
    let of = |c: usize, scratch: &mut Scratch| {
        let cell = cells[c].clone();
        let widest = RING * cell.clone().map(spacing).fold(0.0, f32::max);
        let corners = bounds(&index.points[cell.clone()]);
        let together = scratch.hood.gather(index, corners, widest);
        let mut around = Vec::with_capacity(cell.len());
        for block in Block::all(&index.points, cell) {
            let radius = Lanes::splat(RING) * block.lanes(spacing);
            let reach = radius.to_array().into_iter().fold(0.0, f32::max);
            if !together {
                scratch.hood.gather_all(index, (block.lo, block.hi), reach);
            }
            scratch.hood.narrow(&block, reach);
            let found = block_of(&block, radius, &scratch.hood);
            for (l, i) in block.range.clone().enumerate() {
                let mut own = found[l];
                // Seen for sure is what is within the lane's own radius.
                if own.apart2 > radius.lane(l) * radius.lane(l) {
                    index.knn(index.points[i], 2, &mut scratch.found);
                    own.apart2 = scratch.found.get(1).map_or(f32::INFINITY, |n| n.distance2);
                }
                around.push(own);
            }
        }
        around
    };
    let mut all = vec![Surroundings::default(); index.points.len()];
    par::map_each(cells.len(), Scratch::default, of, |c, measured| {
        for (&i, around) in index.order[cells[c].clone()].iter().zip(measured) {
            all[i as usize] = around;
        }
    });
    all
}

/// What is around each lane's centre, as far as the neighbourhood reaches.
fn block_of(block: &Block, radius: Lanes, hood: &Neighborhood) -> [Surroundings; LANES] {
    let one = Lanes::splat(1.0);
    let scale = one / radius.max(Lanes::splat(f32::MIN_POSITIVE));
    let mut apart2 = Lanes::splat(f32::INFINITY);
    let mut sums = [Lanes::ZERO; 4];
    for (j, at) in hood.near() {
        let [x, y, z] = [0, 1, 2].map(|axis| at[axis] - block.at[axis]);
        let length2 = x * x + y * y + z * z;
        apart2 = apart2.min(Lanes::from_fn(|l| {
            if block.range.start + l == j {
                f32::INFINITY
            } else {
                length2.lane(l)
            }
        }));
        let root = (one - length2 * scale * scale).max(Lanes::ZERO);
        let w = root * root;
        for (sum, term) in sums.iter_mut().zip([w * x, w * y, w * z, w]) {
            *sum += term;
        }
    }
    let [x, y, z, w] = sums;
    let [x, y, z] = [x, y, z].map(|sum| sum * scale / w);
    std::array::from_fn(|l| Surroundings {
        apart2: apart2.lane(l),
        mean: Vec3::new(x.lane(l), y.lane(l), z.lane(l)),
    })
}
