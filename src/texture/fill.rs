//! Texels without a value of their own take those around them.
//!
//! Around charts, and in holes of them, first the mean of the neighbours that have one, twice; then what is still missing from
//! pictures of half the size, a quarter and so on, in which each texel is the mean of what is known of four ("push and pull": S. J. Gortler
//! et al., "The lumigraph", 1996).

/// Red, green and blue, 0 to 255.
pub(super) type Pixel = [f32; 3];

/// Rings of texels that take the mean of their neighbours.
const RINGS: usize = 2;

/// All pixels; black where nothing is known anywhere.
pub(super) fn fill(mut pixels: Vec<Option<Pixel>>, [width, height]: [usize; 2]) -> Vec<Pixel> {
    for _ in 0..RINGS {
        pixels = grown(&pixels, [width, height]);
    }
    pulled(&pixels, [width, height])
}

/// With one ring more.
fn grown(pixels: &[Option<Pixel>], [width, height]: [usize; 2]) -> Vec<Option<Pixel>> {
    let mut grown = pixels.to_vec();
    for y in 0..height {
        for x in 0..width {
            if pixels[y * width + x].is_none() {
                let (xs, ys) = (
                    x.saturating_sub(1)..(x + 2).min(width),
                    y.saturating_sub(1)..(y + 2).min(height),
                );
                let near = ys.flat_map(|y| xs.clone().map(move |x| y * width + x));
                grown[y * width + x] = mean(near.map(|at| pixels[at]));
            }
        }
    }
    grown
}

/// What is missing from smaller and smaller pictures.
fn pulled(pixels: &[Option<Pixel>], [width, height]: [usize; 2]) -> Vec<Pixel> {
    if !pixels.contains(&None) || width * height == 1 {
        return pixels
            .iter()
            .map(|pixel| pixel.unwrap_or_default())
            .collect();
    }
    let half = [width.div_ceil(2), height.div_ceil(2)];
    let mut smaller = Vec::with_capacity(half[0] * half[1]);
    for y in 0..half[1] {
        for x in 0..half[0] {
            let ys = 2 * y..(2 * y + 2).min(height);
            let xs = 2 * x..(2 * x + 2).min(width);
            let four = ys.flat_map(|y| xs.clone().map(move |x| y * width + x));
            smaller.push(mean(four.map(|at| pixels[at])));
        }
    }
    let smaller = pulled(&smaller, half);
    let from = |(at, pixel): (usize, &Option<Pixel>)| {
        let (x, y) = (at % width, at / width);
        pixel.unwrap_or(smaller[y / 2 * half[0] + x / 2])
    };
    pixels.iter().enumerate().map(from).collect()
}

fn mean(pixels: impl Iterator<Item = Option<Pixel>>) -> Option<Pixel> {
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for pixel in pixels.flatten() {
        sum = [0, 1, 2].map(|k| sum[k] + pixel[k]);
        count += 1.0;
    }
    (count > 0.0).then(|| sum.map(|x| x / count))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_known_stays_and_the_rest_is_like_what_is_near() {
        let mut pixels = vec![None; 32 * 8];
        pixels[0] = Some([10.0, 0.0, 0.0]);
        pixels[31] = Some([200.0, 0.0, 0.0]);
        let filled = fill(pixels, [32, 8]);
        assert_eq!((filled[0][0], filled[31][0]), (10.0, 200.0));
        assert_eq!((filled[2][0], filled[29][0]), (10.0, 200.0));
        assert!(filled.iter().all(|p| (10.0..=200.0).contains(&p[0])));
        assert_eq!(fill(vec![None; 6], [3, 2]), vec![[0.0; 3]; 6]);
    }
}
