//! Sample scans with a known surface, generated and not shipped. The duck and the pig take the place of the paper's scans of
//! section 5 and have their numbers of points.
//!
//! 1. `solid`: signed distances and what joins them; `toys` and `machined`: the solids that are made of these.
//! 2. [`Model`]: which solid, how many points, and its truth: [`Model::distance`] says how far any point is from the surface.
//! 3. `scanner`: rays from 20 poses on a turntable, noise along the ray, thinned to the number of points.
//! 4. [`desk()`]: the duck as one gets it, on a table, with a second thing, shadows, strays and uneven light.
//!
//! **In**: a model, a number of points, a seed, noise along the ray as a fraction of the diagonal. **Out**: a [`Sample`]: points in
//! centimetres, y up, without normals, as a scanner gives them, and the truth beside each.
//!
//! **Cost**: linear in the points; a ray is traced through the solid's signed distance.

mod desk;
mod machined;
mod model;
mod scanner;
mod solid;
mod toys;

use glam::DVec3;

pub use desk::DESK_POINTS;
pub use model::Model;

/// Standard deviation of the range that [`sample`] takes, as a fraction of the diagonal: a good hand-held scanner.
pub const NOISE: f64 = 5e-4;

/// A simulated scan; three values a point each.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Measured x y z, in centimetres.
    pub positions: Vec<f32>,
    /// r g b of the model's surface, 0 to 255.
    pub colors: Vec<u8>,
    /// True unit normals, outward. Not measured: what a test compares with.
    pub normals: Vec<f32>,
}

/// Scans a model: exactly `points` points with noise [`NOISE`]. The same seed gives the same bits.
pub fn sample(model: Model, points: usize, seed: u64) -> Sample {
    sample_with_noise(model, points, seed, NOISE)
}

/// [`sample`] with another standard deviation of the range, a fraction of the diagonal.
pub fn sample_with_noise(model: Model, points: usize, seed: u64, noise: f64) -> Sample {
    let hits = scanner::scan(model, points, noise, seed);
    let triples = |v: DVec3| v.as_vec3().to_array();
    Sample {
        positions: hits.iter().flat_map(|hit| triples(hit.position)).collect(),
        colors: hits.iter().flat_map(|hit| model.color(hit.truth)).collect(),
        normals: hits.iter().flat_map(|hit| triples(hit.normal)).collect(),
    }
}

/// The duck on a table, with a block, shadows, a hole, strays and uneven light: exactly `points` points, with noise as
/// [`sample_with_noise`] has it. Strays have any normals.
pub fn desk(points: usize, seed: u64, noise: f64) -> Sample {
    let seen = desk::scan(points, seed, noise);
    let triples = |v: &DVec3| v.as_vec3().to_array();
    Sample {
        positions: seen.iter().flat_map(|(p, _, _)| triples(p)).collect(),
        colors: seen.iter().flat_map(|(_, _, color)| *color).collect(),
        normals: seen.iter().flat_map(|(_, n, _)| triples(n)).collect(),
    }
}
