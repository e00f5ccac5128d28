//! Where one looks from, and how far away: as `pkg/viewer/look.js` and `orbit.js` have it.

use super::strip::SAMPLES;
use crate::base::error::{Error, Result};
use glam::{DMat3, DVec3};

/// From the front, a little from the right and above.
const DIRECTION: [f64; 3] = [0.55, 0.38, 1.0];
const FIELD_OF_VIEW: f64 = 32.0;
/// Nearer than this one is inside of things.
const NEAREST: f64 = 0.02;
/// How far one may go, in distances from which everything is seen.
const FARTHEST: f64 = 6.0;
/// Not over the poles.
const POLE: f64 = 1e-4;
/// What is left free around.
const MARGIN: f64 = 1.1;
/// Points that tell how large something looks.
const OUTLINE: usize = 4096;
/// More than this share along a second axis, up is between axes.
const BETWEEN: f64 = 1e-6;

/// How far the camera is from what it turns around.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reach {
    /// Of the distance from which everything is seen.
    Share(f64),
    /// In diagonals.
    Length(f64),
}

/// From where one looks at the middle of the bounding box, in the frame that stands upright.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Around the upright axis from the front, in degrees, to the right. Default: 28.81.
    pub azimuth: Option<f64>,
    /// Down from straight above, in degrees. Default: 71.58.
    pub polar: Option<f64>,
    /// Default: from where everything is seen.
    pub reach: Reach,
}

impl Default for View {
    fn default() -> Self {
        View {
            azimuth: None,
            polar: None,
            reach: Reach::Share(1.0),
        }
    }
}

/// What brings a direction up, as the viewer does: it turns about an axis that lies flat.
pub(super) fn standing(up: DVec3) -> DMat3 {
    let nearest = up.abs().max_element();
    let along = up
        .to_array()
        .iter()
        .filter(|x| x.abs() > BETWEEN * nearest)
        .count();
    let up = if along == 1 {
        (up / nearest).round()
    } else {
        up.normalize_or(DVec3::Y)
    };
    let sine = up.cross(DVec3::Y);
    if sine.length_squared() == 0.0 {
        // From head to foot about x.
        let turn = up.y.signum();
        return DMat3::from_diagonal(DVec3::new(1.0, turn, turn));
    }
    // Rodrigues' formula, with sine and cosine as they are.
    let cross = DMat3::from_cols(
        DVec3::new(0.0, sine.z, -sine.y),
        DVec3::new(-sine.z, 0.0, sine.x),
        DVec3::new(sine.y, -sine.x, 0.0),
    );
    DMat3::IDENTITY + cross + cross * cross * (1.0 / (1.0 + up.y))
}

/// A camera of a picture, in samples.
#[derive(Debug, Clone, Copy)]
pub(super) struct Camera {
    pub(super) place: DVec3,
    right: DVec3,
    over: DVec3,
    forward: DVec3,
    /// Samples of a picture along each axis.
    size: [f64; 2],
    /// Samples that a length of 1 has where it is 1 away.
    pub(super) scale: f64,
    /// What is nearer is not seen.
    pub(super) near: f64,
}

impl Camera {
    /// `points` stand upright.
    ///
    /// # Errors
    /// [`Error::BadOption`].
    pub(super) fn new(view: &View, points: &[DVec3], size: [usize; 2]) -> Result<Camera> {
        let first = DVec3::from(DIRECTION).normalize();
        let azimuth = view
            .azimuth
            .map_or(libm::atan2(first.x, first.z), f64::to_radians);
        let polar = view.polar.map_or(libm::acos(first.y), f64::to_radians);
        let reach = match view.reach {
            Reach::Share(x) | Reach::Length(x) => x,
        };
        if !(azimuth.is_finite() && polar.is_finite() && reach.is_finite() && reach > 0.0) {
            let expected = "finite angles, and a distance above 0";
            return Err(Error::bad_option("camera", expected, &format!("{view:?}")));
        }
        let polar = polar.clamp(POLE, std::f64::consts::PI - POLE);
        let flat = libm::sin(polar);
        let backward = DVec3::new(
            flat * libm::sin(azimuth),
            libm::cos(polar),
            flat * libm::cos(azimuth),
        );
        let right = DVec3::Y.cross(backward).normalize();
        let over = backward.cross(right);
        let size = size.map(|n| (n * SAMPLES) as f64);
        let tangent = libm::tan(FIELD_OF_VIEW.to_radians() / 2.0);
        let tangents = [tangent * size[0] / size[1] / MARGIN, tangent / MARGIN];
        let outline = points.iter().step_by(points.len().div_ceil(OUTLINE));
        let needed = |p: &DVec3| {
            let across = (p.dot(right).abs() / tangents[0]).max(p.dot(over).abs() / tangents[1]);
            p.dot(backward) + across
        };
        let whole = outline.map(needed).fold(NEAREST, f64::max);
        let distance = match view.reach {
            Reach::Share(share) => share * whole,
            Reach::Length(length) => length,
        };
        let distance = distance.clamp(NEAREST, FARTHEST * whole);
        Ok(Camera {
            place: backward * distance,
            right,
            over,
            forward: -backward,
            size,
            scale: size[1] / (2.0 * tangent),
            near: (distance * 0.005).max(distance - 1.0),
        })
    }

    /// A place as the camera has it: samples to the right and down of the picture's middle times the depth, and the depth.
    pub(super) fn eye(&self, p: DVec3) -> DVec3 {
        let from = p - self.place;
        DVec3::new(
            self.scale * from.dot(self.right),
            -self.scale * from.dot(self.over),
            from.dot(self.forward),
        )
    }

    /// The picture's middle, in samples.
    pub(super) fn middle(&self) -> [f64; 2] {
        self.size.map(|n| n / 2.0)
    }
}
