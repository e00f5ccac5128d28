//! Sample scans that are generated, not shipped: three solids whose surface is known exactly, and a simulated laser
//! scanner that measures them.
//!
//! The duck and the pig take the place of the paper's scans of section 5 and have their numbers of points. The truth
//! stays at hand: [`Model::distance`] says how far any point is from the surface.

mod machined;
mod scanner;
mod solid;
mod toys;

use glam::{DVec3, dvec3};
use solid::Solid;
use std::sync::LazyLock;

static DUCK: LazyLock<Solid> = LazyLock::new(|| Solid::new(toys::duck()));
static PIG: LazyLock<Solid> = LazyLock::new(|| Solid::new(toys::pig()));

/// Standard deviation of the range that [`sample`] takes, as a fraction of the diagonal: a good hand-held scanner.
pub const NOISE: f64 = 5e-4;

/// A solid with a known, closed, connected surface. Centimetres, y up, the toys face +x.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// A toy duck: smooth, little detail.
    Duck,
    /// A toy pig: smooth, with finer detail than the duck (trotters, nostrils, smile, slot, curly tail).
    Pig,
    /// A machined part: flat and round faces, sharp edges, through holes.
    Part,
}

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

impl Model {
    /// All models.
    pub const ALL: [Model; 3] = [Model::Duck, Model::Pig, Model::Part];

    /// Name in lower case: `duck`, `pig`, `part`.
    pub fn name(self) -> &'static str {
        match self {
            Model::Duck => "duck",
            Model::Pig => "pig",
            Model::Part => "part",
        }
    }

    /// The model of that name.
    pub fn from_name(name: &str) -> Option<Model> {
        Model::ALL.into_iter().find(|model| model.name() == name)
    }

    /// Number of points of the paper's scan (section 5); for the part, of our own choice.
    pub fn default_points(self) -> usize {
        match self {
            Model::Duck => 35_647,
            Model::Pig => 171_875,
            Model::Part => 60_000,
        }
    }

    /// Number of handles of the surface.
    pub fn genus(self) -> u32 {
        match self {
            Model::Duck | Model::Pig => 0,
            Model::Part => machined::GENUS,
        }
    }

    /// Signed distance to the surface in centimetres, negative inside.
    ///
    /// 1-Lipschitz, so its amount is never more than the true distance. It is the true distance but in the smooth
    /// seams of the toys, in their cuts and inside the wedges of the part's inner corners, where it can be less by up
    /// to the factor √2 near the surface. To first order the true distance is `distance / |gradient|`.
    pub fn distance(self, p: DVec3) -> f64 {
        match self {
            Model::Duck => DUCK.distance(p),
            Model::Pig => PIG.distance(p),
            Model::Part => machined::distance(p),
        }
    }

    /// Gradient of [`Model::distance`], outward, by central differences over 1e-5 of the diagonal: at most 1 long,
    /// shorter in seams and at sharp edges.
    pub fn gradient(self, p: DVec3) -> DVec3 {
        let (low, high) = self.bounds();
        let step = 1e-5 * low.distance(high);
        let slope = |axis: DVec3| {
            (self.distance(p + axis * step) - self.distance(p - axis * step)) / (2.0 * step)
        };
        dvec3(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z))
    }

    /// Bounding box, low and high corner, a little larger than the solid.
    pub fn bounds(self) -> (DVec3, DVec3) {
        match self {
            Model::Duck => (dvec3(-6.0, -3.0, -4.0), dvec3(7.0, 8.0, 4.0)),
            Model::Pig => (dvec3(-9.0, -6.0, -5.0), dvec3(9.0, 7.0, 5.0)),
            Model::Part => (dvec3(-7.0, 0.0, -4.0), dvec3(7.0, 3.6, 4.0)),
        }
    }

    /// Colour of the surface near `p`: r g b, 0 to 255.
    fn color(self, p: DVec3) -> [u8; 3] {
        match self {
            Model::Duck => DUCK.color(p),
            Model::Pig => PIG.color(p),
            Model::Part => [176, 182, 190],
        }
    }
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
