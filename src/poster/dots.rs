//! Clouds: round dots as wide as they cover the surface, and eye-dome lighting (C. Boucheny, 2009), as `pkg/viewer/materials.js` and
//! `eye-dome.js` have them.

use super::camera::Camera;
use super::strip::{NOTHING, SAMPLES, Strip};
use glam::DVec3;

/// Of points without colours.
const TINT: [u8; 3] = [0x5d, 0x7f, 0x93];
/// Dots are so many times as wide as their distance, so that they close the surface.
const COVER: f64 = 1.8;
/// However sparse the scan, its points stay points.
const LARGEST: f64 = 0.015;
/// Narrowest and widest dots, in pixels.
const PIXELS: [f64; 2] = [1.5, 96.0];
/// Pixels to the neighbours that a sample is compared with: the outlines of points, then the shape that they make.
const REACHES: [f64; 2] = [1.5, 7.0];
/// Rows of pixels around a strip that the comparison needs.
pub(super) const MARGIN: usize = 8;
const STRENGTH: f64 = 60.0;
/// A neighbour counts for no more than this.
const LIMIT: f64 = 0.012;
/// Cells of a side of the box, to tell how far points are from each other.
const CELLS: usize = 64;

/// A point before the camera.
pub(super) struct Dot {
    middle: [f64; 2],
    radius: f64,
    inverse: f32,
    index: u32,
}

pub(super) fn place(points: &[DVec3], camera: &Camera) -> Vec<Dot> {
    let diameter = LARGEST.min(COVER * spacing(points));
    let [x, y] = camera.middle();
    let [narrow, wide] = PIXELS.map(|pixels| pixels * SAMPLES as f64);
    let dot = |(index, &p): (usize, &DVec3)| {
        let eye = camera.eye(p);
        (eye.z >= camera.near).then(|| Dot {
            middle: [eye.x / eye.z + x, eye.y / eye.z + y],
            radius: (diameter * camera.scale / eye.z).clamp(narrow, wide) / 2.0,
            inverse: (1.0 / eye.z) as f32,
            index: index as u32,
        })
    };
    points.iter().enumerate().filter_map(dot).collect()
}

/// Draws them into a strip.
pub(super) fn draw(dots: &[Dot], colors: Option<&[[u8; 3]]>, strip: &mut Strip) {
    for dot in dots {
        let [x, y] = dot.middle;
        // The samples between two places: their middles are halves.
        let first = |x: f64| (x - 0.5).ceil().max(0.0) as usize;
        let rows =
            first(y - dot.radius).max(strip.rows.start)..first(y + dot.radius).min(strip.rows.end);
        let columns = first(x - dot.radius)..first(x + dot.radius).min(strip.width);
        for row in rows {
            let down = row as f64 + 0.5 - y;
            let start = (row - strip.rows.start) * strip.width;
            for column in columns.clone() {
                let right = column as f64 + 0.5 - x;
                if right * right + down * down <= dot.radius * dot.radius {
                    strip.put(start + column, dot.inverse, dot.index);
                }
            }
        }
    }
    let depths: Vec<f32> = strip
        .inverse
        .iter()
        .map(|&inverse| -libm::log2f(inverse))
        .collect();
    for at in 0..depths.len() {
        let index = strip.seen[at];
        if index != NOTHING {
            let light = libm::exp(-STRENGTH * behind(&depths, strip.width, at) / 16.0);
            let color = colors.map_or(TINT, |colors| colors[index as usize]);
            strip.colors[at] = color.map(|c| (f64::from(c) * light).round() as u8);
        }
    }
}

/// How far a sample is behind its neighbours, in powers of two of the depth; what is beyond the strip's end is like its end.
fn behind(depths: &[f32], width: usize, at: usize) -> f64 {
    let rows = depths.len() / width;
    let (row, column) = ((at / width) as i64, (at % width) as i64);
    let end = |x: i64, most: usize| x.clamp(0, most as i64 - 1) as usize;
    let one = |[x, y]: [i64; 2]| {
        let there = end(row + y, rows) * width + end(column + x, width);
        f64::from(depths[at] - depths[there]).clamp(0.0, LIMIT)
    };
    neighbors().into_iter().map(one).sum()
}

/// Eight directions at each reach, in samples.
fn neighbors() -> [[i64; 2]; 16] {
    let diagonal = std::f64::consts::FRAC_1_SQRT_2;
    let turns = [
        [1.0, 0.0],
        [diagonal, diagonal],
        [0.0, 1.0],
        [-diagonal, diagonal],
        [-1.0, 0.0],
        [-diagonal, -diagonal],
        [0.0, -1.0],
        [diagonal, -diagonal],
    ];
    std::array::from_fn(|k| {
        turns[k % 8].map(|x: f64| (x * REACHES[k / 8] * SAMPLES as f64).round() as i64)
    })
}

/// About how far neighbours are from each other: of the share of a grid's cells that hold a point, as `pkg/viewer/density.js` has it.
fn spacing(points: &[DVec3]) -> f64 {
    let area = 0.7 / (CELLS * CELLS) as f64;
    let mut taken = vec![false; CELLS * CELLS * CELLS];
    for p in points {
        let cell = |x: f64| (((x + 0.5) * CELLS as f64).floor().max(0.0) as usize).min(CELLS - 1);
        taken[cell(p.x) + CELLS * (cell(p.y) + CELLS * cell(p.z))] = true;
    }
    let count = taken.iter().filter(|&&taken| taken).count();
    (area * count as f64 / points.len() as f64).sqrt()
}
