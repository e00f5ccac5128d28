//! Neighbouring points of some leaves, by which the scan is measured.

use crate::tiles::grid::Tile;

/// Some neighbouring points of a leaf.
#[derive(Debug, Clone)]
pub struct Sample {
    /// With those around, so that what is measured of those within is right.
    pub places: Vec<[u32; 3]>,
    /// The part that counts, on the lattice: lower corner, and the first place beyond.
    pub range: [[u64; 3]; 2],
    /// How many points of the scan it stands for.
    pub points: f64,
}

/// How far around a leaf points are sampled, as a share of its side.
const AROUND: u64 = 4;

/// So many groups of at least `points` neighbouring points to measure, apart from each other, of the points of a leaf and those up to a
/// quarter of its side around it: the indices of each, with as many around it, and the range that counts; the same whenever the points
/// are the same. A group's middle is a point of the leaf.
pub fn samples(
    leaf: Tile,
    places: &[[u32; 3]],
    (count, points): (usize, usize),
) -> Vec<(Vec<u32>, [[u64; 3]; 2])> {
    let own: Vec<[u32; 3]> = places.iter().copied().filter(|&p| leaf.holds(p)).collect();
    let count = count.clamp(1, own.len().max(1));
    let middle = |i: usize| own.get(own.len() * (2 * i + 1) / (2 * count)).copied();
    (0..count)
        .map(|i| sample(leaf, places, (middle(i).unwrap_or_default(), points)))
        .collect()
}

/// The neighbours of a place.
fn sample(
    leaf: Tile,
    places: &[[u32; 3]],
    (middle, points): ([u32; 3], usize),
) -> (Vec<u32>, [[u64; 3]; 2]) {
    let within = |half: u64, place: &[u32; 3]| {
        (0..3).all(|a| u64::from(place[a].abs_diff(middle[a])) <= half)
    };
    let count = |half: u64| places.iter().filter(|place| within(half, place)).count();
    let mut half = leaf.side();
    while half > 1 && count(half / 2) >= points {
        half /= 2;
    }
    let each = (0u32..).zip(places);
    let near = each.filter(|(_, place)| within(2 * half, place));
    // Where there are no points half as far again, because they are too far from the leaf, none count.
    let grown = (leaf.side() / AROUND).saturating_sub(half);
    let [from, to] = leaf.range();
    let low = [0, 1, 2].map(|a| {
        let own = from[a].saturating_sub(grown);
        u64::from(middle[a]).saturating_sub(half).max(own)
    });
    let high = [0, 1, 2].map(|a| (u64::from(middle[a]) + half + 1).min(to[a] + grown));
    (near.map(|(i, _)| i).collect(), [low, high])
}
