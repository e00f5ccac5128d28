//! Which tiles there are, and what each of them needs.

use crate::base::error::{Error, Result};
use crate::tiles::counts::{Counts, power_of_two};
use crate::tiles::grid::{Grid, Tile};
use std::collections::{BTreeMap, BTreeSet};

/// Levels of the octree, at most.
const DEEPEST: u32 = 20;
/// Points are strays that lie farther out than so many times the size of what most of them fill ...
const FAR_OUT: i64 = 20;
/// ... if all of them are less than this share.
const A_FEW: f64 = 1e-3;

/// A tile that is not cut further.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Leaf {
    /// Which.
    pub tile: Tile,
    /// How many points of each file that has some in it: the file's index and their number.
    pub files: Vec<(usize, u64)>,
}

impl Leaf {
    /// All points in it.
    pub fn points(&self) -> u64 {
        self.files.iter().map(|(_, points)| points).sum()
    }
}

/// A cell of the counts inside of the root, and its points of each file.
type Cell = ([u32; 3], Vec<(usize, u64)>);

/// The octree of tiles.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The root.
    pub grid: Grid,
    /// In ascending order.
    pub leaves: Vec<Leaf>,
    /// Points that are so far from all others that they are left out.
    pub strays: u64,
}

impl Plan {
    /// The octree over the points of all files, cut until no tile has more than `most` points or it is as small as a cell of the
    /// counts.
    ///
    /// # Errors
    /// [`Error::EmptyCloud`].
    pub fn new(counts: &[Counts], most: u64) -> Result<Plan> {
        let mut level = counts.iter().map(|c| c.level).max().unwrap_or_default();
        // Of each cell, how many points of which file.
        let gathered = |level: i32| {
            let mut cells: BTreeMap<[i64; 3], Vec<(usize, u64)>> = BTreeMap::new();
            for (file, counts) in counts.iter().enumerate() {
                let mut counts = counts.clone();
                counts.coarsen_to(level);
                for (cell, points) in counts.cells {
                    cells.entry(cell).or_default().push((file, points));
                }
            }
            cells
        };
        let mut cells = gathered(level);
        let (low, side) = loop {
            let (low, side) = extent(&cells).ok_or(Error::EmptyCloud)?;
            let depth = (side as u64).next_power_of_two().trailing_zeros();
            if depth <= DEEPEST {
                break (low, 1i64 << depth);
            }
            level += (depth - DEEPEST) as i32;
            cells = gathered(level);
        };
        let inside = |cell: &[i64; 3]| (0..3).all(|a| (low[a]..low[a] + side).contains(&cell[a]));
        let total = |cells: &BTreeMap<[i64; 3], Vec<(usize, u64)>>| -> u64 {
            cells.values().flatten().map(|(_, points)| points).sum()
        };
        let all = total(&cells);
        cells.retain(|cell, _| inside(cell));
        let strays = all - total(&cells);
        let unit = power_of_two(level);
        let cells = cells
            .into_iter()
            .map(|(cell, files)| ([0, 1, 2].map(|a| (cell[a] - low[a]) as u32), files))
            .collect();
        let mut leaves = Vec::new();
        let depth = side.trailing_zeros();
        cut(Tile::ROOT, cells, (depth, most), &mut leaves);
        leaves.sort_unstable_by_key(|leaf| leaf.tile);
        Ok(Plan {
            grid: Grid {
                corner: low.map(|x| x as f64 * unit),
                size: side as f64 * unit,
            },
            leaves,
            strays,
        })
    }

    /// Depth of the deepest leaf.
    pub fn depth(&self) -> u32 {
        self.leaves
            .iter()
            .map(|leaf| leaf.tile.depth)
            .max()
            .unwrap_or_default()
    }

    /// The tiles above the leaves, from those right above the deepest to the root.
    pub fn inner(&self) -> Vec<Tile> {
        let mut inner = BTreeSet::new();
        for leaf in &self.leaves {
            let mut tile = leaf.tile;
            while let Some(parent) = tile.parent() {
                inner.insert(parent);
                tile = parent;
            }
        }
        let mut inner: Vec<Tile> = inner.into_iter().collect();
        inner.sort_by_key(|tile| (std::cmp::Reverse(tile.depth), *tile));
        inner
    }

    /// The leaves whose points a leaf is reduced with, itself among them.
    pub fn around_leaf(&self, tile: Tile) -> Vec<Tile> {
        let leaves = self.leaves.iter().map(|leaf| leaf.tile);
        leaves.filter(|leaf| leaf.touches(tile)).collect()
    }

    /// The tiles whose reduced points an inner tile is reduced with: its children, and those of its depth + 1 that touch it, or
    /// the leaves above them.
    pub fn around_inner(&self, tile: Tile) -> Vec<Tile> {
        let mut needed = BTreeSet::new();
        for leaf in self.leaves.iter().map(|leaf| leaf.tile) {
            if leaf.touches(tile) {
                let mut at = leaf;
                while at.depth > tile.depth + 1 {
                    at = at.parent().unwrap_or(Tile::ROOT);
                }
                needed.insert(at);
            }
        }
        needed.into_iter().collect()
    }

    /// How many levels of tiles are reduced below this one's: 0 for a leaf.
    pub fn level(&self, tile: Tile) -> u32 {
        match self.leaves.binary_search_by_key(&tile, |leaf| leaf.tile) {
            Ok(_) => 0,
            Err(_) => self.depth() - tile.depth,
        }
    }
}

/// Cuts a tile: `cells` are the counts of those in it, `depth` levels below the root.
fn cut(tile: Tile, cells: Vec<Cell>, (depth, most): (u32, u64), leaves: &mut Vec<Leaf>) {
    let mut files: BTreeMap<usize, u64> = BTreeMap::new();
    for (file, points) in cells.iter().flat_map(|(_, files)| files) {
        *files.entry(*file).or_default() += points;
    }
    if tile.depth == depth || files.values().sum::<u64>() <= most {
        if !files.is_empty() {
            let files = files.into_iter().collect();
            leaves.push(Leaf { tile, files });
        }
        return;
    }
    let shift = depth - tile.depth - 1;
    let mut parts: [Vec<_>; 8] = Default::default();
    for (cell, files) in cells {
        let octant = cell.map(|x| (x >> shift & 1) as usize);
        parts[octant[0] << 2 | octant[1] << 1 | octant[2]].push((cell, files));
    }
    for (child, part) in tile.children().zip(parts) {
        cut(child, part, (depth, most), leaves);
    }
}

/// The lower corner of the cells and how many there are along the longest side, without those of strays.
fn extent(cells: &BTreeMap<[i64; 3], Vec<(usize, u64)>>) -> Option<([i64; 3], i64)> {
    let counted: Vec<([i64; 3], u64)> = cells
        .iter()
        .map(|(cell, files)| (*cell, files.iter().map(|(_, points)| points).sum()))
        .collect();
    let total: u64 = counted.iter().map(|(_, points)| points).sum();
    let few = (A_FEW * total as f64) as u64;
    // Where most are, axis by axis.
    let middle = [0, 1, 2].map(|axis| {
        let mut along: Vec<(i64, u64)> = counted.iter().map(|(c, n)| (c[axis], *n)).collect();
        along.sort_unstable();
        let mut before = 0;
        let after = |&(_, points): &(i64, u64)| {
            before += points;
            before > few
        };
        let low = along.iter().copied().find(after).map_or(0, |(x, _)| x);
        let mut before = 0;
        let after = |&(_, points): &(i64, u64)| {
            before += points;
            before > few
        };
        let high = along
            .iter()
            .rev()
            .copied()
            .find(after)
            .map_or(0, |(x, _)| x);
        [low, high]
    });
    let size = middle.iter().map(|[low, high]| high - low + 1).max()?;
    let reach = size.saturating_mul(FAR_OUT);
    let near = |c: &[i64; 3]| {
        (0..3).all(|a| {
            c[a] >= middle[a][0].saturating_sub(reach) && c[a] <= middle[a][1].saturating_add(reach)
        })
    };
    let out: u64 = counted
        .iter()
        .filter(|(c, _)| !near(c))
        .map(|(_, n)| n)
        .sum();
    let kept = || {
        counted
            .iter()
            .map(|(c, _)| c)
            .filter(|c| out > few || near(c))
    };
    let corner = |pick: fn(i64, i64) -> i64| {
        [0, 1, 2].map(|a| kept().map(|c| c[a]).reduce(pick).unwrap_or_default())
    };
    kept().next()?;
    let (low, high) = (corner(i64::min), corner(i64::max));
    Some((low, (0..3).map(|a| high[a] - low[a] + 1).max()?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::Rng;

    fn counted(points: &[[f64; 3]]) -> Counts {
        let mut counts = Counts::default();
        counts.add(points).unwrap();
        counts
    }

    /// A plane with a dense corner.
    fn points(n: usize) -> Vec<[f64; 3]> {
        let mut rng = Rng::new(3);
        (0..n)
            .map(|i| {
                let side = if i % 2 == 0 { 100.0 } else { 5.0 };
                [
                    7e5 + side * rng.uniform(),
                    side * rng.uniform(),
                    40.0 + rng.uniform(),
                ]
            })
            .collect()
    }

    #[test]
    fn leaves_hold_all_points_once_and_no_more_than_asked() {
        let points = points(60_000);
        let (first, second) = points.split_at(20_000);
        let plan = Plan::new(&[counted(first), counted(second)], 3000).unwrap();
        assert!(plan.leaves.iter().all(|leaf| leaf.points() <= 3000));
        let sum = |file| -> u64 {
            let files = plan.leaves.iter().flat_map(|leaf| &leaf.files);
            files.filter(|(f, _)| *f == file).map(|(_, n)| n).sum()
        };
        assert_eq!((sum(0), sum(1), plan.strays), (20_000, 40_000, 0));
        let depths: BTreeSet<u32> = plan.leaves.iter().map(|leaf| leaf.tile.depth).collect();
        assert!(depths.len() > 2, "{depths:?}");
        // Every inner tile needs its own children, and nothing twice.
        for tile in plan.inner() {
            let around = plan.around_inner(tile);
            let there: BTreeSet<Tile> = plan
                .leaves
                .iter()
                .map(|l| l.tile)
                .chain(plan.inner())
                .collect();
            assert!(
                tile.children()
                    .filter(|c| there.contains(c))
                    .all(|c| around.contains(&c))
            );
            assert!(around.iter().all(|t| there.contains(t) && t.touches(tile)));
            for (i, a) in around.iter().enumerate() {
                let over = |b: &Tile| {
                    b.depth > a.depth && (0..3).all(|x| b.at[x] >> (b.depth - a.depth) == a.at[x])
                };
                assert!(!around[i + 1..].iter().any(over));
            }
        }
        assert_eq!(plan.inner().last(), Some(&Tile::ROOT));
        let leaf = plan.leaves[7].tile;
        assert!(plan.around_leaf(leaf).contains(&leaf));
    }

    #[test]
    fn strays_do_not_make_the_lattice_coarse() {
        let mut points = points(30_000);
        points.push([1e12, 0.0, 0.0]);
        points.push([0.0, -1e9, 3.0]);
        let plan = Plan::new(&[counted(&points)], 10_000).unwrap();
        assert_eq!(plan.strays, 2);
        assert!(plan.grid.size <= 256.0, "{}", plan.grid.size);
        assert_eq!(
            Plan::new(&[Counts::default()], 5).unwrap_err().code(),
            "empty-cloud"
        );
        let one = Plan::new(&[counted(&[[3.5, -1.25, 0.0]])], 5).unwrap();
        assert_eq!(one.leaves.len(), 1);
        assert_eq!((one.leaves[0].tile, one.level(Tile::ROOT)), (Tile::ROOT, 0));
    }
}
