//! Neighbours of points that lie close together, found for all of them at once.
//!
//! A query of the tree for each point would be most of the cost of a local sum. So a cell of some dozen points gathers the points
//! around its box once. Blocks of eight of its points, one per lane, narrow these down to their own box, and each neighbour
//! that is left is evaluated for all eight at once. Weights vanish smoothly at the rim of their support, so points that a
//! block sees beyond it add nothing.

use std::ops::Range;

use glam::Vec3;

use crate::base::lanes::{LANES, Lanes, places_within};
use crate::cloud::octree::Octree;

/// Points of a cell, at most: enough to share the search, few enough that blocks find most of what was gathered useful.
pub const CELL: usize = 128;

/// Points that a cell gathers, at most. Cells of isolated points far from each other would gather half of the cloud.
const MOST: usize = 4096;

/// Up to eight consecutive points; lanes beyond the last repeat it.
#[derive(Debug, Clone)]
pub struct Block {
    /// Which points.
    pub range: Range<usize>,
    /// Their coordinates.
    pub at: [Lanes; 3],
    /// Lower corner of their box.
    pub lo: Vec3,
    /// Upper corner of their box.
    pub hi: Vec3,
}

impl Block {
    /// The points `range` of `points`, one to eight.
    pub fn new(points: &[Vec3], range: Range<usize>) -> Block {
        let lane = |l: usize| points[range.start + l.min(range.len() - 1)];
        let (lo, hi) = bounds(&points[range.clone()]);
        Block {
            at: [0, 1, 2].map(|axis| Lanes::from_fn(|l| lane(l)[axis])),
            range,
            lo,
            hi,
        }
    }

    /// The blocks of a cell, in order.
    pub fn all(points: &[Vec3], cell: Range<usize>) -> impl Iterator<Item = Block> {
        let end = cell.end;
        cell.step_by(LANES)
            .map(move |start| Block::new(points, start..(start + LANES).min(end)))
    }

    /// `value` of every point, the last one's repeated.
    pub fn lanes(&self, value: impl Fn(usize) -> f32) -> Lanes {
        Lanes::from_fn(|l| value(self.range.start + l.min(self.range.len() - 1)))
    }

    /// Middle of the points in their order: unlike the middle of their box, a place where the surface is.
    pub fn middle(&self) -> usize {
        self.range.start + self.range.len() / 2
    }
}

/// Lower and upper corner of the box of some points.
pub fn bounds(points: &[Vec3]) -> (Vec3, Vec3) {
    let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    points
        .iter()
        .fold(start, |(lo, hi), &p| (lo.min(p), hi.max(p)))
}

/// Distance to the k-th neighbour if the points were spread evenly over the two longer sides of their box.
pub fn even_reach((lo, hi): (Vec3, Vec3), points: usize, k: usize) -> f32 {
    let size = hi - lo;
    let shortest = size.min_element();
    let area = size.x * size.y + size.y * size.z + size.z * size.x
        - shortest * (size.x + size.y + size.z - shortest);
    (area / points as f32 * k as f32 / std::f32::consts::PI).sqrt()
}

/// What lies around a cell, and which of it around the block at hand. The memory of one worker.
#[derive(Debug, Default)]
pub struct Neighborhood {
    /// Indices in the source, ascending, and their coordinates padded to whole lanes.
    around: Vec<u32>,
    at: [Vec<f32>; 3],
    /// All points within this of the cell's box are there.
    reach: f32,
    /// Places in `around` of those near the block.
    near: Vec<u32>,
    /// Squared distances from the last query, and the one that its answer was.
    squares: Vec<Lanes>,
    square: f32,
    sorted: Vec<f32>,
}

/// Radii that are tried before distances are sorted.
const GUESSES: usize = 6;

/// Coordinate of a padding lane: outside of every support, and small enough to be squared.
const FAR: f32 = 1e6;

impl Neighborhood {
    /// Gathers the points of `source` within `reach` of a box. False where they are so many that points had better ask
    /// one by one; then nothing is gathered.
    pub fn gather(&mut self, source: &Octree, corners: (Vec3, Vec3), reach: f32) -> bool {
        let whole = self.gather_most(source, corners, reach, MOST);
        if !whole {
            self.around.clear();
        }
        self.load(source);
        whole
    }

    /// [`Neighborhood::gather`], however many there are.
    pub fn gather_all(&mut self, source: &Octree, corners: (Vec3, Vec3), reach: f32) {
        self.gather_most(source, corners, reach, usize::MAX);
        self.load(source);
    }

    /// Gathers the points within `reach` of one point, however many; all of them are near.
    pub fn gather_at(&mut self, source: &Octree, p: Vec3, reach: f32) {
        self.gather_all(source, (p, p), reach);
        self.near.clear();
        self.near.extend(0..self.around.len() as u32);
    }

    fn gather_most(
        &mut self,
        source: &Octree,
        (lo, hi): (Vec3, Vec3),
        reach: f32,
        most: usize,
    ) -> bool {
        self.around.clear();
        self.reach = reach;
        source.gather(lo - reach, hi + reach, most, &mut self.around)
    }

    fn load(&mut self, source: &Octree) {
        self.square = 0.25 * self.reach * self.reach;
        let padded = self.around.len().next_multiple_of(LANES);
        for (axis, at) in self.at.iter_mut().enumerate() {
            at.clear();
            at.extend(self.around.iter().map(|&i| source.points[i as usize][axis]));
            at.resize(padded, FAR);
        }
    }

    /// Distance from `q` to the `k`-th nearest gathered point, or to the farthest one if there are fewer; where points lie on a
    /// surface, to within a few hundredths: it is counted how many are within a radius, and that is scaled until it fits.
    pub fn kth_distance(&mut self, q: Vec3, k: usize) -> f32 {
        let [x, y, z] = q.to_array().map(Lanes::splat);
        self.squares.clear();
        for block in (0..self.at[0].len()).step_by(LANES) {
            let [dx, dy, dz] =
                [(0, x), (1, y), (2, z)].map(|(axis, q)| Lanes::load(&self.at[axis][block..]) - q);
            self.squares.push(dx * dx + dy * dy + dz * dz);
        }
        let few = self.around.len() <= 2 * k;
        let mut square = self.square;
        for _ in 0..if few { 0 } else { GUESSES } {
            let within = self.within(square);
            let ratio = k as f32 / within;
            square *= ratio.clamp(0.25, 4.0);
            if (0.9..1.12).contains(&ratio) {
                self.square = square;
                return square.sqrt();
            }
        }
        self.select(k)
    }

    /// How many gathered points are within the square of a distance.
    fn within(&self, square: f32) -> f32 {
        let (one, limit) = (Lanes::splat(1.0), Lanes::splat(square));
        let mut count = Lanes::ZERO;
        for squares in &self.squares {
            count += limit.less(*squares, Lanes::ZERO, one);
        }
        count.sum()
    }

    /// The distance by sorting, for what no scaling finds.
    fn select(&mut self, k: usize) -> f32 {
        self.sorted.clear();
        self.sorted
            .extend(self.squares.iter().flat_map(|s| s.to_array()));
        self.sorted.truncate(self.around.len());
        let Some(k) = k.min(self.sorted.len()).checked_sub(1) else {
            return 0.0;
        };
        let (_, &mut kth, _) = self.sorted.select_nth_unstable_by(k, f32::total_cmp);
        kth.sqrt()
    }

    /// Keeps what is within `reach` of the block's box.
    pub fn narrow(&mut self, block: &Block, reach: f32) {
        let lo = block.lo.to_array().map(Lanes::splat);
        let hi = block.hi.to_array().map(Lanes::splat);
        let at = &self.at;
        let distance2 = |start: usize| {
            let mut sum = Lanes::ZERO;
            for axis in 0..3 {
                let x = Lanes::load(&at[axis][start..]);
                let away = (lo[axis] - x).max(x - hi[axis]).max(Lanes::ZERO);
                sum += away * away;
            }
            sum
        };
        places_within(self.around.len(), reach * reach, distance2, &mut self.near);
    }

    /// What is near the block: indices in the source, ascending, and coordinates in every lane.
    pub fn near(&self) -> impl Iterator<Item = (usize, [Lanes; 3])> {
        self.near.iter().map(|&place| {
            let place = place as usize;
            let at = [0, 1, 2].map(|axis| Lanes::splat(self.at[axis][place]));
            (self.around[place] as usize, at)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::Rng;

    #[test]
    fn blocks_see_what_a_scan_of_all_points_finds() {
        let mut rng = Rng::new(4);
        let mut at = || (rng.uniform() - 0.5) as f32;
        // A sheet, so that cells have an inside and an outside, and a straggler.
        let mut points: Vec<Vec3> = (0..2000)
            .map(|_| Vec3::new(at(), at(), 0.01 * at()))
            .collect();
        points.push(Vec3::splat(0.5));
        let tree = Octree::build(&points);
        let mut hood = Neighborhood::default();
        let reach = 0.1;
        for cell in tree.cut(|node| node.range().len() <= CELL) {
            assert!(hood.gather(&tree, bounds(&tree.points[cell.clone()]), reach));
            for block in Block::all(&tree.points, cell) {
                let query = tree.points[block.middle()];
                let mut all: Vec<f32> = tree.points.iter().map(|p| p.distance(query)).collect();
                all.sort_unstable_by(f32::total_cmp);
                if all[15] <= reach {
                    let found = hood.kth_distance(query, 16);
                    let within = all.iter().filter(|&&d| d <= found).count();
                    assert!((12..=21).contains(&within), "{within}");
                    assert_eq!(hood.select(16), all[15]);
                }
                hood.narrow(&block, 0.05);
                let near: Vec<usize> = hood.near().map(|(i, _)| i).collect();
                let within =
                    |p: &Vec3| p.distance_squared(p.clamp(block.lo, block.hi)) <= 0.05 * 0.05;
                let expected = (0..points.len()).filter(|&i| within(&tree.points[i]));
                assert_eq!(near, expected.collect::<Vec<_>>());
                for (l, i) in block.range.clone().enumerate() {
                    let lane = block.at.map(|x| x.lane(l));
                    assert_eq!(lane, tree.points[i].to_array());
                }
            }
        }
    }

    #[test]
    fn a_cell_that_would_gather_too_much_says_so() {
        let tree = Octree::build(&vec![Vec3::ZERO; MOST + 1]);
        let mut hood = Neighborhood::default();
        assert!(!hood.gather(&tree, (Vec3::ZERO, Vec3::ZERO), 1.0));
        hood.narrow(&Block::new(&tree.points, 0..8), 1.0);
        assert_eq!(hood.near().count(), 0);
        hood.gather_at(&tree, Vec3::ZERO, 1.0);
        assert_eq!(hood.near().count(), MOST + 1);
    }
}
