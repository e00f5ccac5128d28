//! The neutral studio that lights meshes, as `pkg/viewer/light.js` has it, blurred as a rough surface sees it.

use glam::DVec3;
use std::f64::consts::PI;

/// Radiance of the walls, looking down, level and up.
const WALLS: [f64; 3] = [0.55, 0.07, 0.3];
/// Soft boxes: direction, half the angle that one covers in degrees, and radiance.
const BOXES: [([f64; 3], f64, f64); 6] = [
    ([-0.82, 0.42, 0.46], 5.2, 106.0),
    ([-0.8, 0.56, -0.24], 5.0, 106.0),
    ([0.82, 0.5, 0.0], 10.0, 24.0),
    ([0.0, 0.36, 0.93], 10.0, 18.0),
    ([0.44, 0.28, -0.85], 5.2, 106.0),
    ([-0.38, 0.6, -0.7], 4.6, 106.0),
];
/// Steps of latitude; there are twice as many around: of what is lit, and of the light that is summed.
const LIT: usize = 24;
const LIGHT: usize = 64;

/// Radiance from each direction, blurred.
pub(super) struct Studio {
    values: Vec<f64>,
}

impl Studio {
    /// As a surface of that roughness reflects it towards who looks straight at it (B. Karis, 2013); 1 is also what a matt one gets.
    pub(super) fn of(roughness: f64) -> Studio {
        let mut light = Vec::new();
        for row in 0..LIGHT {
            let latitude = ((row as f64 + 0.5) / LIGHT as f64 - 0.5) * PI;
            for column in 0..2 * LIGHT {
                let longitude = (column as f64 + 0.5) / LIGHT as f64 * PI;
                let from = direction(latitude, longitude);
                light.push((from, radiance(from), libm::cos(latitude)));
            }
        }
        let squared = roughness * roughness;
        let alpha2 = squared * squared;
        let blurred = |towards: DVec3| {
            let (mut sum, mut weights) = (0.0, 0.0);
            for &(from, radiance, size) in &light {
                let cosine = towards.dot(from);
                if cosine > 0.0 {
                    // The distribution of Trowbridge and Reitz, at half the angle.
                    let spread = 0.5 * (1.0 + cosine) * (alpha2 - 1.0) + 1.0;
                    let weight = cosine * size / (spread * spread);
                    sum += weight * radiance;
                    weights += weight;
                }
            }
            sum / weights
        };
        let values = (0..=LIT).flat_map(|row| {
            let latitude = (row as f64 / LIT as f64 - 0.5) * PI;
            (0..2 * LIT).map(move |column| direction(latitude, column as f64 / LIT as f64 * PI))
        });
        Studio {
            values: values.map(blurred).collect(),
        }
    }

    /// From a direction of unit length.
    pub(super) fn from(&self, towards: DVec3) -> f64 {
        let down = (libm::asin(towards.y.clamp(-1.0, 1.0)) / PI + 0.5) * LIT as f64;
        let around = libm::atan2(towards.z, towards.x) / PI * LIT as f64 + 2.0 * LIT as f64;
        let (row, column) = (down.floor().min(LIT as f64 - 1.0), around.floor());
        let (s, t) = (around - column, down - row);
        let value = |i: usize, j: usize| {
            self.values[(row as usize + i) * 2 * LIT + (column as usize + j) % (2 * LIT)]
        };
        let line = |i: usize| (1.0 - s) * value(i, 0) + s * value(i, 1);
        (1.0 - t) * line(0) + t * line(1)
    }
}

/// Longitude 0 is x, a quarter further z.
fn direction(latitude: f64, longitude: f64) -> DVec3 {
    let flat = libm::cos(latitude);
    DVec3::new(
        flat * libm::cos(longitude),
        libm::sin(latitude),
        flat * libm::sin(longitude),
    )
}

/// The walls', and a box's with an edge as wide as itself.
fn radiance(from: DVec3) -> f64 {
    let [down, level, up] = WALLS;
    let wall = level
        + if from.y > 0.0 {
            up - level
        } else {
            level - down
        } * from.y;
    let boxes = BOXES.iter().map(|&(towards, half, radiance)| {
        let cosine = DVec3::from(towards).normalize().dot(from).clamp(-1.0, 1.0);
        let share = (1.5 - libm::acos(cosine).to_degrees() / half).clamp(0.0, 1.0);
        radiance * share * share * (3.0 - 2.0 * share)
    });
    wall + boxes.sum::<f64>()
}
