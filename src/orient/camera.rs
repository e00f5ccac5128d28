//! Whether a cloud is what a camera at the origin of its frame saw.
//!
//! Depth frames come in the camera's own frame: the eye at 0, looking along z. All of this must hold: the points lie within a
//! cone around the z axis, none much nearer than the others; seen from the eye there is one range for each direction; and the
//! picture is fuller than the plan. A tile of terrain over its origin has one range for each direction too, but is full seen
//! from far away and not from near. (Whether the surface that comes out really looks to the eye is asked later.)

use glam::{Vec2, Vec3};

/// Points that are looked at, about. Fewer make larger cells, more of which hold an outline.
const SAMPLE: usize = 200_000;
/// Tangent of half the widest field of view: 60°.
const WIDEST: f32 = 1.733;
/// Share of the points that lie within it.
const WITHIN: f32 = 0.98;
/// The nearest of a camera's points, but for 1 in 200, against the median.
const NEAREST: f32 = 0.1;
/// The median distance, in diagonals of the cloud, from which on all directions are much the same.
const FARTHEST: f32 = 10.0;
/// Points a cell of the picture, about.
const PER_CELL: f32 = 8.0;
/// Share of a picture's cells that may hold two sheets: outlines.
const OUTLINE: f32 = 0.12;
/// Of cells that hold this many points.
const ENOUGH: usize = 4;
/// The gap between two sheets, in widths of a cell.
const GAP: f32 = 3.0;
/// How much more of the picture's cells than of the plan's are filled. Frames have 0.05 to 0.34 more, terrain over the origin
/// has 0.04 and 0.05 less.
const FULLER: f32 = 0.03;

/// Whether `points` look as if they were seen from `eye`, along z.
pub(crate) fn sees(eye: Vec3, points: &[Vec3]) -> bool {
    let step = points.len().div_ceil(SAMPLE).max(1);
    let from_eye: Vec<Vec3> = points.iter().step_by(step).map(|&p| p - eye).collect();
    let directions = from_eye.iter().map(|d| d.normalize_or_zero());
    let mean: Vec3 = directions.sum();
    if mean.abs().max_position() != 2 {
        return false;
    }
    let forward = mean.z.signum();
    let mut ranges: Vec<f32> = from_eye.iter().map(|d| d.z * forward).collect();
    ranges.sort_unstable_by(f32::total_cmp);
    let (near, median) = (ranges[ranges.len() / 200], ranges[ranges.len() / 2]);
    if median > FARTHEST || near <= 0.0 || near < NEAREST * median {
        return false;
    }
    let ahead = from_eye.iter().filter(|d| d.z * forward > 0.0);
    // Where in the picture, and how far.
    let seen: Vec<(Vec2, f32)> = ahead
        .map(|d| (d.truncate() / (d.z * forward), d.z * forward))
        .collect();
    let inside = seen.iter().filter(|s| s.0.length() < WIDEST).count();
    if (inside as f32) < WITHIN * from_eye.len() as f32 {
        return false;
    }
    let picture = Cells::of(seen.iter().map(|s| s.0));
    let plan = Cells::of(seen.iter().map(|s| s.0 * s.1));
    picture.filled() > plan.filled() + FULLER && picture.is_single(&seen)
}

/// A grid over points of a plane, with some points a cell.
struct Cells {
    /// The cell of every point.
    of: Vec<u32>,
    count: usize,
    width: f32,
}

impl Cells {
    fn of(points: impl ExactSizeIterator<Item = Vec2> + Clone) -> Cells {
        let (mut lo, mut hi) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for p in points.clone() {
            (lo, hi) = (lo.min(p), hi.max(p));
        }
        let size = (hi - lo).max(Vec2::splat(1e-6));
        let width = (size.x * size.y * PER_CELL / points.len() as f32).sqrt();
        // A picture that is a line has no more columns than points.
        let width = width.max(size.max_element() / points.len() as f32);
        let columns = (size.x / width) as u32 + 1;
        let rows = (size.y / width) as u32 + 1;
        let cell = |p: Vec2| {
            let c = (p - lo) / width;
            c.y as u32 * columns + c.x as u32
        };
        Cells {
            of: points.map(cell).collect(),
            count: (columns * rows) as usize,
            width,
        }
    }

    /// The share of cells that hold a point.
    fn filled(&self) -> f32 {
        let mut taken = vec![false; self.count];
        self.of.iter().for_each(|&c| taken[c as usize] = true);
        taken.iter().filter(|taken| **taken).count() as f32 / self.count as f32
    }

    /// Whether there is one range for each direction: in few cells a wide gap has some of the points on both sides.
    fn is_single(&self, seen: &[(Vec2, f32)]) -> bool {
        let ranges = || self.of.iter().copied().zip(seen.iter().map(|s| s.1));
        let mut ranges = crate::base::groups::Groups::new(self.count, ranges);
        let (mut full, mut double) = (0.0, 0.0);
        for c in 0..self.count as u32 {
            let ranges = ranges.of_mut(c);
            if ranges.len() < ENOUGH {
                continue;
            }
            ranges.sort_unstable_by(f32::total_cmp);
            let few = (ranges.len() / 5).max(1);
            let gaps = (few..=ranges.len() - few).map(|k| ranges[k] - ranges[k - 1]);
            full += 1.0;
            if gaps.fold(0.0, f32::max) > GAP * self.width * ranges[0] {
                double += 1.0;
            }
        }
        full > 0.0 && double < OUTLINE * full
    }
}
