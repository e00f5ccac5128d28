//! The pictures of a mesh.

use super::scene::Pixels;

/// A picture with its smaller copies, each of half the size.
pub(super) struct Mipmaps {
    levels: Vec<Level>,
    /// What a byte says; it grows with the byte.
    meanings: [f32; 256],
}

struct Level {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 3]>,
}

impl Mipmaps {
    /// `meaning` is what a byte says.
    pub(super) fn of(Pixels { width, rgba }: Pixels, meaning: impl Fn(u8) -> f32) -> Mipmaps {
        let meanings = std::array::from_fn(|byte| meaning(byte as u8));
        let (pixels, _) = rgba.as_chunks::<4>();
        let mut levels = vec![Level {
            width,
            height: pixels.len() / width,
            pixels: pixels.iter().map(|&[r, g, b, _]| [r, g, b]).collect(),
        }];
        while let Some(last) = levels
            .last()
            .filter(|level| level.width.max(level.height) > 1)
        {
            let half = last.half(&meanings);
            levels.push(half);
        }
        Mipmaps { levels, meanings }
    }

    /// The colour at a place, 0 to 1 from the first row down, of texels so many times as wide as they are, as a power of two.
    pub(super) fn at(&self, place: [f64; 2], wide: f64) -> [f64; 3] {
        let wide = wide.clamp(0.0, (self.levels.len() - 1) as f64);
        let level = wide.floor();
        let share = wide - level;
        let near = self.levels[level as usize].at(place, &self.meanings);
        match self.levels.get(level as usize + 1) {
            Some(next) if share > 0.0 => {
                let far = next.at(place, &self.meanings);
                [0, 1, 2].map(|c| (1.0 - share) * near[c] + share * far[c])
            }
            _ => near,
        }
    }

    /// Width and height.
    pub(super) fn size(&self) -> [f64; 2] {
        [self.levels[0].width as f64, self.levels[0].height as f64]
    }
}

impl Level {
    fn half(&self, meanings: &[f32; 256]) -> Level {
        let [width, height] = [self.width, self.height].map(|n| n.div_ceil(2));
        let pixel = |k: usize| {
            let (x, y) = (2 * (k % width), 2 * (k / width));
            let at = |i: usize, j: usize| {
                let (x, y) = ((x + i).min(self.width - 1), (y + j).min(self.height - 1));
                self.pixels[y * self.width + x]
            };
            let four = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
            [0, 1, 2].map(|c| {
                let mean = four
                    .iter()
                    .map(|p| meanings[usize::from(p[c])])
                    .sum::<f32>()
                    / 4.0;
                let above = meanings.partition_point(|&x| x < mean).min(255);
                let below = above.saturating_sub(1);
                if mean - meanings[below] < meanings[above] - mean {
                    below as u8
                } else {
                    above as u8
                }
            })
        };
        Level {
            width,
            height,
            pixels: (0..width * height).map(pixel).collect(),
        }
    }

    fn at(&self, [u, v]: [f64; 2], meanings: &[f32; 256]) -> [f64; 3] {
        let [x, y] = [u * self.width as f64 - 0.5, v * self.height as f64 - 0.5];
        let [s, t] = [x - x.floor(), y - y.floor()];
        let pixel = |i: f64, j: f64| {
            let x = (x.floor() + i).clamp(0.0, self.width as f64 - 1.0) as usize;
            let y = (y.floor() + j).clamp(0.0, self.height as f64 - 1.0) as usize;
            self.pixels[y * self.width + x].map(|byte| f64::from(meanings[usize::from(byte)]))
        };
        let [a, b, c, d] = [
            pixel(0.0, 0.0),
            pixel(1.0, 0.0),
            pixel(0.0, 1.0),
            pixel(1.0, 1.0),
        ];
        [0, 1, 2]
            .map(|k| (1.0 - t) * ((1.0 - s) * a[k] + s * b[k]) + t * ((1.0 - s) * c[k] + s * d[k]))
    }
}
