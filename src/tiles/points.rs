//! Points on the root's lattice, and which tile each is in.

use crate::cloud::Attribute;
use crate::cloud::morton::interleave;
use crate::tiles::grid::{BITS, Grid, Tile};

/// Bits an axis of the keys by which leaves are found.
const KEY: u32 = 20;

/// Points, with what belongs to each.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Points {
    /// Places on the lattice.
    pub places: Vec<[u32; 3]>,
    /// Red, green, blue.
    pub colors: Option<Vec<[u8; 3]>>,
    /// Scalars.
    pub attributes: Vec<Attribute>,
}

impl Points {
    /// Some of them.
    pub fn select(&self, indices: &[u32]) -> Points {
        let each = || indices.iter().map(|&i| i as usize);
        let scalars = self.attributes.iter().map(|a| Attribute {
            name: a.name.clone(),
            values: each().map(|i| a.values[i]).collect(),
        });
        Points {
            places: each().map(|i| self.places[i]).collect(),
            colors: self.colors.as_ref().map(|c| each().map(|i| c[i]).collect()),
            attributes: scalars.collect(),
        }
    }
}

/// Points in the order of their leaves.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Split {
    /// Their places.
    pub places: Vec<[u32; 3]>,
    /// The index that each had. Those that are in no leaf are missing.
    pub order: Vec<u32>,
    /// Which leaf, and how many points of it follow each other.
    pub runs: Vec<(Tile, usize)>,
}

/// Finds the leaves of points.
pub struct Splitter {
    /// In ascending order of the first key in each, with the key after its last.
    leaves: Vec<(u64, u64, Tile)>,
    /// The grid's corner, in steps of its lattice.
    corner: [i64; 3],
    /// Of the step's side.
    per_unit: f64,
}

impl Splitter {
    /// For the leaves of a plan.
    pub fn new(grid: Grid, leaves: impl Iterator<Item = Tile>) -> Splitter {
        let range = |tile: Tile| {
            let low = tile.range()[0].map(|x| x >> (BITS - KEY));
            let first = interleave(low);
            (first, first + (1 << (3 * (KEY - tile.depth))), tile)
        };
        let mut leaves: Vec<_> = leaves.map(range).collect();
        leaves.sort_unstable();
        let per_unit = (1u64 << BITS) as f64 / grid.size;
        Splitter {
            leaves,
            corner: grid.corner.map(|x| (x * per_unit) as i64),
            per_unit,
        }
    }

    /// The place of a point of the world, if the root holds it. Exact down to the lattice's step, which is a power of two.
    fn place(&self, point: [f64; 3]) -> Option<[u32; 3]> {
        let mut place = [0; 3];
        for axis in 0..3 {
            let at = (point[axis] * self.per_unit).floor() as i64;
            place[axis] = u32::try_from(at.checked_sub(self.corner[axis])?).ok()?;
        }
        Some(place)
    }

    fn leaf(&self, place: [u32; 3]) -> Option<usize> {
        let key = interleave(place.map(|x| u64::from(x >> (BITS - KEY))));
        let after = self.leaves.partition_point(|&(first, ..)| first <= key);
        let leaf = after.checked_sub(1)?;
        (key < self.leaves[leaf].1).then_some(leaf)
    }

    /// Puts points of the world in the order of their leaves, those of a leaf as they came.
    pub fn split(&self, points: impl Iterator<Item = [f64; 3]>) -> Split {
        let mut found = Vec::new();
        let mut counts = vec![0usize; self.leaves.len()];
        let mut last = None;
        for (i, point) in points.enumerate() {
            let Some(place) = self.place(point) else {
                continue;
            };
            // Points that follow each other are mostly near each other.
            let leaf = match last {
                Some(leaf) if self.holds(leaf, place) => leaf,
                _ => match self.leaf(place) {
                    Some(leaf) => leaf,
                    None => continue,
                },
            };
            last = Some(leaf);
            counts[leaf] += 1;
            found.push((leaf, i as u32, place));
        }
        let mut next = Vec::with_capacity(counts.len());
        let mut start = 0;
        for count in &counts {
            next.push(start);
            start += count;
        }
        let mut split = Split {
            places: vec![[0; 3]; found.len()],
            order: vec![0; found.len()],
            runs: Vec::new(),
        };
        for (leaf, i, place) in found {
            let to = next[leaf];
            next[leaf] += 1;
            (split.places[to], split.order[to]) = (place, i);
        }
        let runs = self.leaves.iter().zip(counts);
        split.runs = runs
            .filter(|(_, count)| *count > 0)
            .map(|(&(.., tile), count)| (tile, count))
            .collect();
        split
    }

    fn holds(&self, leaf: usize, place: [u32; 3]) -> bool {
        self.leaves[leaf].2.holds(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::Rng;
    use crate::tiles::counts::Counts;
    use crate::tiles::plan::Plan;

    #[test]
    fn every_point_goes_to_the_leaf_that_counted_it() {
        let mut rng = Rng::new(9);
        let points: Vec<[f64; 3]> = (0..50_000)
            .map(|_| {
                [
                    rng.normal() * 30.0 - 5e6,
                    rng.normal() * 30.0,
                    rng.normal() * 1e-3,
                ]
            })
            .collect();
        let mut counts = Counts::default();
        counts.add(&points).unwrap();
        let plan = Plan::new(&[counts], 1000).unwrap();
        let splitter = Splitter::new(plan.grid, plan.leaves.iter().map(|leaf| leaf.tile));
        let split = splitter.split(points.iter().copied());
        let expected: Vec<(Tile, u64)> = plan.leaves.iter().map(|l| (l.tile, l.points())).collect();
        let mut found: Vec<(Tile, u64)> = split.runs.iter().map(|&(t, n)| (t, n as u64)).collect();
        found.sort_unstable();
        assert_eq!(found, expected);
        let step = plan.grid.step();
        let mut at = 0;
        for (tile, count) in split.runs {
            for k in at..at + count {
                assert!(tile.holds(split.places[k]));
                let world = plan.grid.world(split.places[k]);
                let point = points[split.order[k] as usize];
                assert!((0..3).all(|a| (0.0..=step).contains(&(point[a] - world[a]))));
            }
            at += count;
        }
        // What was not counted, and what is not finite, is in no tile.
        let others = [[f64::NAN; 3], [1e300; 3], [0.0; 3]];
        assert!(splitter.split(others.into_iter()).order.is_empty());
    }
}
