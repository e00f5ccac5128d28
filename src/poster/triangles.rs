//! Which triangle is seen at each sample, by M. Olano and T. Greer: in homogeneous coordinates nothing has to be clipped.

use super::camera::Camera;
use super::strip::Strip;
use glam::{DMat3, DVec3};

/// A triangle before the camera.
pub(super) struct Placed {
    /// The corners' weights over the depth, along samples to the right, down, and 1: with rows of this they are linear on the picture.
    pub(super) weights: [DVec3; 3],
    /// Samples of the picture that it may reach, first and last, along each axis.
    reach: [[f64; 2]; 2],
    /// Which one it is.
    pub(super) index: u32,
}

/// Those that are seen from nowhere edge-on and lie before the camera.
pub(super) fn place(points: &[DVec3], corners: &[[u32; 3]], camera: &Camera) -> Vec<Placed> {
    let [x, y] = camera.middle();
    let eye: Vec<DVec3> = points.iter().map(|&p| camera.eye(p)).collect();
    let mut placed = Vec::new();
    for (index, corner) in corners.iter().enumerate() {
        let [a, b, c] = corner.map(|v| eye[v as usize]);
        let nearest = a.z.min(b.z).min(c.z);
        let volume = a.dot(b.cross(c));
        if a.z.max(b.z).max(c.z) < camera.near || volume == 0.0 {
            continue;
        }
        let inverse = DMat3::from_cols(b.cross(c), c.cross(a), a.cross(b));
        let weights = inverse
            .to_cols_array_2d()
            .map(|row| DVec3::from(row) / volume);
        let [low, high] = if nearest > 1e-6 {
            let flat = [a, b, c].map(|p| [p.x / p.z + x, p.y / p.z + y]);
            let ends = |pick: fn(f64, f64) -> f64| {
                [0, 1].map(|k| pick(pick(flat[0][k], flat[1][k]), flat[2][k]))
            };
            [ends(f64::min), ends(f64::max)]
        } else {
            [[0.0; 2], [2.0 * x, 2.0 * y]]
        };
        if low[0] < 2.0 * x && low[1] < 2.0 * y && high[0] > 0.0 && high[1] > 0.0 {
            placed.push(Placed {
                weights,
                reach: [low, high],
                index: index as u32,
            });
        }
    }
    placed
}

/// Puts them into a strip; what is seen there is the place in the list.
pub(super) fn draw(placed: &[Placed], camera: &Camera, strip: &mut Strip) {
    let [middle_x, middle_y] = camera.middle();
    let nearest = 1.0 / camera.near;
    for (index, triangle) in placed.iter().enumerate() {
        let [low, high] = triangle.reach;
        // The samples between two places: their middles are halves.
        let first = |x: f64| (x - 0.5).ceil().max(0.0) as usize;
        let rows = first(low[1]).max(strip.rows.start)..first(high[1]).min(strip.rows.end);
        let columns = first(low[0])..first(high[0]).min(strip.width);
        let [a, b, c] = triangle.weights;
        for row in rows {
            let start = (row - strip.rows.start) * strip.width;
            let y = row as f64 + 0.5 - middle_y;
            let line = [a, b, c].map(|w| w.y * y + w.z);
            for column in columns.clone() {
                let x = column as f64 + 0.5 - middle_x;
                let [u, v, w] = [a.x * x + line[0], b.x * x + line[1], c.x * x + line[2]];
                let inverse = u + v + w;
                if u >= 0.0 && v >= 0.0 && w >= 0.0 && inverse <= nearest {
                    strip.put(start + column, inverse as f32, index as u32);
                }
            }
        }
    }
}
