//! Some rows of a picture: what is nearest at each sample, and which colour it has.

use std::ops::Range;

/// Samples of a pixel along each axis.
pub(super) const SAMPLES: usize = 3;

/// Nothing is there.
pub(super) const NOTHING: u32 = u32::MAX;

/// Rows of samples, a margin above and below included.
pub(super) struct Strip {
    /// Samples in a row.
    pub(super) width: usize,
    /// Of the picture.
    pub(super) rows: Range<usize>,
    /// Rows of samples that are wanted.
    wanted: Range<usize>,
    /// One over the depth; 0 where nothing is.
    pub(super) inverse: Vec<f32>,
    /// What is seen.
    pub(super) seen: Vec<u32>,
    /// sRGB.
    pub(super) colors: Vec<[u8; 3]>,
}

impl Strip {
    /// `rows` of `height` rows of pixels, with a margin of rows of pixels.
    pub(super) fn new(width: usize, rows: Range<usize>, height: usize, margin: usize) -> Strip {
        let with = rows.start.saturating_sub(margin)..(rows.end + margin).min(height);
        let [wanted, rows] = [rows, with].map(|r| r.start * SAMPLES..r.end * SAMPLES);
        let width = width * SAMPLES;
        let samples = width * rows.len();
        Strip {
            width,
            rows,
            wanted,
            inverse: vec![0.0; samples],
            seen: vec![NOTHING; samples],
            colors: vec![[0; 3]; samples],
        }
    }

    /// Something is there, seen where nothing is nearer.
    pub(super) fn put(&mut self, at: usize, inverse: f32, index: u32) {
        if inverse > self.inverse[at] {
            self.inverse[at] = inverse;
            self.seen[at] = index;
        }
    }

    /// Colours what is seen, each thing once a pixel, at the middle of its samples there, which `color` takes in samples of the picture.
    pub(super) fn color(&mut self, color: impl Fn(u32, [f64; 2]) -> [u8; 3]) {
        for row in self.rows.clone().step_by(SAMPLES) {
            for column in (0..self.width).step_by(SAMPLES) {
                self.color_pixel(column, row, &color);
            }
        }
    }

    fn color_pixel(
        &mut self,
        column: usize,
        row: usize,
        color: &impl Fn(u32, [f64; 2]) -> [u8; 3],
    ) {
        let first = (row - self.rows.start) * self.width + column;
        let at = |k: usize| first + k / SAMPLES * self.width + k % SAMPLES;
        let place = |k: usize| [column + k % SAMPLES, row + k / SAMPLES].map(|x| x as f64 + 0.5);
        for k in 0..SAMPLES * SAMPLES {
            let index = self.seen[at(k)];
            if index == NOTHING || (0..k).any(|before| self.seen[at(before)] == index) {
                continue;
            }
            let own = || (k..SAMPLES * SAMPLES).filter(|&other| self.seen[at(other)] == index);
            let count = own().count() as f64;
            let middle = own()
                .map(place)
                .fold([0.0; 2], |[x, y], [u, v]| [x + u / count, y + v / count]);
            let shown = color(index, middle);
            let all: Vec<usize> = own().map(at).collect();
            all.into_iter()
                .for_each(|sample| self.colors[sample] = shown);
        }
    }

    /// Pixels of the wanted rows: red, green, blue over a background, or with alpha over none.
    pub(super) fn pixels(&self, background: Option<[u8; 3]>) -> Vec<u8> {
        let mut out = Vec::new();
        for row in self.wanted.clone().step_by(SAMPLES) {
            for column in (0..self.width).step_by(SAMPLES) {
                let (mut sum, mut count) = ([0u32; 3], 0);
                for k in 0..SAMPLES * SAMPLES {
                    let line = row - self.rows.start + k / SAMPLES;
                    let at = line * self.width + column + k % SAMPLES;
                    if self.seen[at] != NOTHING {
                        count += 1;
                        (0..3).for_each(|c| sum[c] += u32::from(self.colors[at][c]));
                    }
                }
                out.extend(pixel(sum, count, background));
            }
        }
        out
    }
}

/// A pixel of which so many samples show something.
fn pixel(sum: [u32; 3], count: u32, background: Option<[u8; 3]>) -> impl Iterator<Item = u8> {
    let all = (SAMPLES * SAMPLES) as u32;
    let rounded = |sum: u32, of: u32| ((2 * sum + of) / (2 * of)) as u8;
    let color = [0, 1, 2].map(|c| match background {
        Some(behind) => rounded(sum[c] + (all - count) * u32::from(behind[c]), all),
        None => rounded(sum[c], count.max(1)),
    });
    let alpha = background.is_none().then(|| rounded(255 * count, all));
    color.into_iter().chain(alpha)
}
