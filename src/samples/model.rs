//! The three solids, their colours and how far a point is from them.

use super::solid::Solid;
use super::{machined, toys};
use glam::{DVec3, dvec3};
use std::sync::LazyLock;

static DUCK: LazyLock<Solid> = LazyLock::new(|| Solid::new(toys::duck()));
static PIG: LazyLock<Solid> = LazyLock::new(|| Solid::new(toys::pig()));

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
    pub(super) fn color(self, p: DVec3) -> [u8; 3] {
        match self {
            Model::Duck => DUCK.color(p),
            Model::Pig => PIG.color(p),
            Model::Part => [176, 182, 190],
        }
    }
}
