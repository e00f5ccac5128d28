//! The sparse lattice that extraction works on: values at its vertices, only where the surface passes.
//!
//! Vertices and cells lie in bricks of 8³; cell (x, y, z) has its lowest corner at vertex (x, y, z). A brick holds 512
//! values and a few sets of 512 bits, and knows its 26 neighbours, so that a step to an adjacent vertex is arithmetic.

use crate::cloud::morton::interleave;
use glam::{DVec3, IVec3, Vec3};
use std::collections::BTreeMap;

/// A set of the 512 vertices or cells of a brick; member `x + 8 y + 64 z`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bits([u64; 8]);

impl Bits {
    pub(crate) fn has(&self, i: usize) -> bool {
        self.0[i >> 6] >> (i & 63) & 1 == 1
    }

    /// Puts `i` in; `true` where it was not in before.
    pub(crate) fn insert(&mut self, i: usize) -> bool {
        let new = !self.has(i);
        self.0[i >> 6] |= 1 << (i & 63);
        new
    }

    /// All that are not in.
    pub(crate) fn others(&self) -> Bits {
        Bits(self.0.map(|word| !word))
    }

    pub(crate) fn len(&self) -> usize {
        self.0.iter().map(|w| w.count_ones() as usize).sum()
    }

    /// How many members are smaller than `i`.
    pub(crate) fn rank(&self, i: usize) -> usize {
        let full: u32 = self.0[..i >> 6].iter().map(|w| w.count_ones()).sum();
        (full + (self.0[i >> 6] & ((1 << (i & 63)) - 1)).count_ones()) as usize
    }

    /// The members in ascending order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = usize> {
        let words = self.0;
        words.into_iter().enumerate().flat_map(|(k, word)| {
            let mut rest = word;
            std::iter::from_fn(move || {
                let bit = rest.trailing_zeros() as usize;
                rest &= rest.wrapping_sub(1);
                (bit < 64).then_some(64 * k + bit)
            })
        })
    }
}

/// No brick.
const NONE: u32 = u32::MAX;

/// 8³ vertices, and the cells whose lowest corners they are.
pub(crate) struct Brick {
    /// Lattice coordinates of its first vertex.
    pub(crate) at: IVec3,
    /// The bricks around it, x fastest; itself in the middle.
    near: [u32; 27],
    /// The field at the vertices; NaN where it is not known.
    pub(crate) value: Box<[f32; 512]>,
    /// Vertices that were asked for.
    pub(crate) known: Bits,
    /// Vertices whose value comes from a fitted function.
    pub(crate) fitted: Bits,
    /// Cells that were asked for.
    pub(crate) seen: Bits,
    /// Cells that the surface crosses.
    pub(crate) crossed: Bits,
}

/// A vertex or a cell: its brick and its number there.
pub(crate) type Place = (u32, usize);

/// Bricks on a regular lattice.
pub(crate) struct Lattice {
    /// Position of vertex (0, 0, 0), unit frame.
    pub(crate) origin: DVec3,
    /// Distance of neighbouring vertices, unit frame.
    pub(crate) edge: f64,
    /// Vertices along each axis.
    pub(crate) size: IVec3,
    pub(crate) bricks: Vec<Brick>,
    index: BTreeMap<u64, u32>,
}

impl Lattice {
    /// A lattice over the box from `low` to `high`, without bricks.
    pub(crate) fn new(low: DVec3, high: DVec3, edge: f64) -> Lattice {
        let cells = ((high - low) / edge).ceil().as_ivec3().max(IVec3::ONE);
        let origin = (low + high) / 2.0 - cells.as_dvec3() * (edge / 2.0);
        Lattice {
            origin,
            edge,
            size: cells + IVec3::ONE,
            bricks: Vec::new(),
            index: BTreeMap::new(),
        }
    }

    /// The cell around a position, which lies in the lattice's box.
    pub(crate) fn cell_at(&mut self, position: Vec3) -> Place {
        let at = ((position.as_dvec3() - self.origin) / self.edge)
            .floor()
            .as_ivec3();
        let at = at.clamp(IVec3::ZERO, self.size - IVec3::splat(2));
        (self.brick_at(at & !7), number(at & 7))
    }

    /// The brick whose first vertex is `at`, made where it is missing.
    fn brick_at(&mut self, at: IVec3) -> u32 {
        if let Some(&brick) = self.index.get(&key(at)) {
            return brick;
        }
        let new = self.bricks.len() as u32;
        let mut near = [NONE; 27];
        for (k, other) in near.iter_mut().enumerate() {
            let d = IVec3::new(k as i32 % 3, k as i32 / 3 % 3, k as i32 / 9) - IVec3::ONE;
            if let Some(&b) = self.index.get(&key(at + 8 * d)) {
                *other = b;
                self.bricks[b as usize].near[26 - k] = new;
            }
        }
        near[13] = new;
        self.index.insert(key(at), new);
        let (value, empty) = (Box::new([f32::NAN; 512]), Bits::default());
        self.bricks.push(Brick {
            at,
            near,
            value,
            known: empty,
            fitted: empty,
            seen: empty,
            crossed: empty,
        });
        new
    }

    /// Where `place` shifted by `d` (at most 8 along an axis) lies, if that brick exists.
    pub(crate) fn shifted(&self, (brick, i): Place, d: IVec3) -> Option<Place> {
        let p = coordinates(i) + d;
        if (p.x | p.y | p.z) & !7 == 0 {
            return Some((brick, number(p)));
        }
        let b = self.bricks[brick as usize].near[direction(p)];
        (b != NONE).then_some((b, number(p & 7)))
    }

    /// [`Lattice::shifted`]; makes the brick where it is missing.
    pub(crate) fn shifted_or_new(&mut self, place: Place, d: IVec3) -> Place {
        self.shifted(place, d).unwrap_or_else(|| {
            let at = self.at(place) + d;
            (self.brick_at(at & !7), number(at & 7))
        })
    }

    /// Lattice coordinates.
    pub(crate) fn at(&self, (brick, i): Place) -> IVec3 {
        self.bricks[brick as usize].at + coordinates(i)
    }

    /// Position in the unit frame of what is `d` beyond a brick's first vertex.
    pub(crate) fn beyond(&self, brick: u32, d: IVec3) -> DVec3 {
        self.origin + self.edge * (self.bricks[brick as usize].at + d).as_dvec3()
    }

    /// Position in the unit frame.
    pub(crate) fn position(&self, (brick, i): Place) -> DVec3 {
        self.beyond(brick, coordinates(i))
    }

    /// Whether the surface crosses the cell `place` shifted by `d`: then its place.
    pub(crate) fn crossed(&self, place: Place, d: IVec3) -> Option<Place> {
        let (b, i) = self.shifted(place, d)?;
        self.bricks[b as usize].crossed.has(i).then_some((b, i))
    }

    /// The values at the eight corners of a cell, in the order of [`crate::mesh::loops`]; NaN where not known.
    pub(crate) fn corners(&self, cell: Place) -> [f32; 8] {
        std::array::from_fn(|c| match self.shifted(cell, corner(c)) {
            Some((b, i)) => self.bricks[b as usize].value[i],
            None => f32::NAN,
        })
    }

    /// Whether all eight corners have a value from a fitted function.
    pub(crate) fn is_fitted(&self, cell: Place) -> bool {
        let fitted = |(b, i): Place| self.bricks[b as usize].fitted.has(i);
        (0..8).all(|c| self.shifted(cell, corner(c)).is_some_and(fitted))
    }

    /// Whether no fitted function reaches a brick or one around it, as far as is known.
    pub(crate) fn is_far(&self, brick: u32) -> bool {
        let near = self.bricks[brick as usize].near.iter();
        let mut there = near.filter(|&&b| b != NONE);
        there.all(|&b| self.bricks[b as usize].fitted.len() == 0)
    }

    /// Whether a vertex is on the hull of the lattice.
    pub(crate) fn is_on_hull(&self, vertex: Place) -> bool {
        let at = self.at(vertex);
        at.min_element() <= 0 || (self.size - at).min_element() <= 1
    }

    /// Brick numbers in Morton order, which does not depend on how the lattice grew and keeps what is close together.
    pub(crate) fn order(&self) -> Vec<u32> {
        self.index.values().copied().collect()
    }
}

/// Offset of a cell's corner.
pub(crate) fn corner(c: usize) -> IVec3 {
    let c = c as i32;
    IVec3::new(c & 1, c >> 1 & 1, c >> 2)
}

fn coordinates(i: usize) -> IVec3 {
    let i = i as i32;
    IVec3::new(i & 7, i >> 3 & 7, i >> 6)
}

fn number(p: IVec3) -> usize {
    (p.x | p.y << 3 | p.z << 6) as usize
}

/// The entry of [`Brick::near`] that holds local coordinates outside of the brick.
fn direction(p: IVec3) -> usize {
    let d: IVec3 = (p >> 3) + IVec3::ONE;
    (d.x + 3 * d.y + 9 * d.z) as usize
}

/// A brick's key; bricks just outside of the lattice take the first value of an axis.
fn key(at: IVec3) -> u64 {
    interleave(at.to_array().map(|x| ((x >> 3) + 1) as u64))
}
