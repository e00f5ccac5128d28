//! Tiles, and the lattice on which their points lie.

use glam::Vec3;
use std::fmt;
use std::str::FromStr;

/// Bits an axis of a place on the lattice.
pub const BITS: u32 = 32;

/// A tile of the octree: the root is 0-0-0-0, its children 1-0-0-0 to 1-1-1-1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Tile {
    /// Levels below the root.
    pub depth: u32,
    /// Its place among those of its depth, along each axis.
    pub at: [u32; 3],
}

impl Tile {
    /// The tile that holds all.
    pub const ROOT: Tile = Tile {
        depth: 0,
        at: [0; 3],
    };

    /// The eight tiles that it is cut into.
    pub fn children(self) -> impl Iterator<Item = Tile> {
        (0..8).map(move |octant| Tile {
            depth: self.depth + 1,
            at: [0, 1, 2].map(|axis| 2 * self.at[axis] + (octant >> (2 - axis) & 1)),
        })
    }

    /// The tile that it is a part of; the root has none.
    pub fn parent(self) -> Option<Tile> {
        Some(Tile {
            depth: self.depth.checked_sub(1)?,
            at: self.at.map(|x| x / 2),
        })
    }

    /// The 26 tiles around it, of its depth.
    pub fn around(self) -> impl Iterator<Item = Tile> {
        let side = 1i64 << self.depth;
        let steps = (0..27).map(|i| [i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1]);
        steps.filter_map(move |step| {
            let at = [0, 1, 2].map(|axis| i64::from(self.at[axis]) + step[axis]);
            let inside = at.iter().all(|x| (0..side).contains(x)) && step != [0; 3];
            inside.then(|| Tile {
                depth: self.depth,
                at: at.map(|x| x as u32),
            })
        })
    }

    /// Whether two tiles of any depth meet, in a corner at least.
    pub fn touches(self, other: Tile) -> bool {
        let ([low, high], [from, to]) = (self.range(), other.range());
        (0..3).all(|axis| low[axis] <= to[axis] && from[axis] <= high[axis])
    }

    /// Its lower corner on the lattice, and the upper one, which is the first place beyond it.
    pub fn range(self) -> [[u64; 3]; 2] {
        let shift = BITS - self.depth;
        [0, 1].map(|more| self.at.map(|x| (u64::from(x) + more) << shift))
    }

    /// Its side, in steps of the lattice.
    pub fn side(self) -> u64 {
        1 << (BITS - self.depth)
    }

    /// Whether a place lies in it.
    pub fn holds(self, place: [u32; 3]) -> bool {
        let shift = BITS - self.depth;
        (0..3).all(|axis| u64::from(place[axis]) >> shift == u64::from(self.at[axis]))
    }
}

impl fmt::Display for Tile {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [x, y, z] = self.at;
        write!(f, "{}-{x}-{y}-{z}", self.depth)
    }
}

impl FromStr for Tile {
    type Err = ();

    fn from_str(text: &str) -> Result<Tile, ()> {
        let numbers: Vec<u32> = text
            .split('-')
            .map(|word| word.parse().map_err(|_| ()))
            .collect::<Result<_, ()>>()?;
        match numbers[..] {
            [depth, x, y, z] if depth < BITS && [x, y, z].iter().all(|&i| i >> depth == 0) => {
                Ok(Tile {
                    depth,
                    at: [x, y, z],
                })
            }
            _ => Err(()),
        }
    }
}

/// The root's cube, and the lattice of 2³² places a side in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Lower corner, in world coordinates.
    pub corner: [f64; 3],
    /// A power of two, in the caller's unit.
    pub size: f64,
}

impl Grid {
    /// The lattice's step, in the caller's unit.
    pub fn step(&self) -> f64 {
        self.size / (1u64 << BITS) as f64
    }

    /// A place in world coordinates.
    pub fn world(&self, place: [u32; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.corner[axis] + f64::from(place[axis]) * self.step())
    }
}

/// The cube in which a tile is reduced: of twice its side, with the tile in the middle, so that the octree's cells are those of every
/// other tile's cube.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cube {
    low: [i64; 3],
    side: f64,
}

impl Cube {
    pub(super) fn of(tile: Tile) -> Cube {
        let half = (tile.side() / 2) as i64;
        Cube {
            low: tile.range()[0].map(|x| x as i64 - half),
            side: 2.0 * tile.side() as f64,
        }
    }

    /// Of an extent in steps of the lattice.
    pub(super) fn between(low: [u32; 3], high: [u32; 3]) -> Cube {
        let longest = (0..3).map(|axis| high[axis] - low[axis]).max();
        Cube {
            low: low.map(i64::from),
            side: f64::from(longest.unwrap_or(0).max(1)),
        }
    }

    /// A place in the unit frame: the cube's sides are at ±0.5.
    pub(super) fn unit(&self, place: [u32; 3]) -> Vec3 {
        let of = |axis: usize| {
            let inside = i64::from(place[axis]) - self.low[axis];
            (inside as f64 / self.side - 0.5) as f32
        };
        Vec3::new(of(0), of(1), of(2))
    }

    /// The nearest place of the lattice to a point of the unit frame.
    pub(super) fn place(&self, p: Vec3) -> [u32; 3] {
        [0, 1, 2].map(|axis| {
            let inside = ((f64::from(p[axis]) + 0.5) * self.side).round() as i64;
            (inside + self.low[axis]).clamp(0, i64::from(u32::MAX)) as u32
        })
    }

    /// The cube's side, in steps of the lattice.
    pub(super) fn side(&self) -> f64 {
        self.side
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tile_has_a_name_a_parent_and_neighbours() {
        let tile: Tile = "3-1-7-4".parse().unwrap();
        assert_eq!(tile.to_string(), "3-1-7-4");
        assert!(
            ["3-1-8-4", "3-1-7", "a-0-0-0", "40-0-0-0"]
                .iter()
                .all(|t| t.parse::<Tile>().is_err())
        );
        assert!(tile.parent().unwrap().children().any(|child| child == tile));
        // At the upper side of one axis a third of them is missing.
        assert_eq!(tile.around().count(), 17);
        assert!(tile.around().all(|other| other.touches(tile)));
        assert!(!tile.touches("3-3-7-4".parse().unwrap()));
        assert!(tile.touches("2-1-3-2".parse().unwrap()));
        assert_eq!(Tile::ROOT.around().count(), 0);
    }

    #[test]
    fn places_come_back_from_the_unit_frame() {
        let tile: Tile = "4-3-0-15".parse().unwrap();
        let cube = Cube::of(tile);
        let low = tile.range()[0].map(|x| x as u32);
        for place in [low, low.map(|x| x + 12_345_678)] {
            let back = cube.place(cube.unit(place));
            assert!((0..3).all(|a| back[a].abs_diff(place[a]) < 64), "{back:?}");
            assert!(tile.holds(place));
        }
    }
}
