//! Open3D, by `tests/bench/orient_open3d.py`.

use crate::process::Process;
use crate::scenes::Scene;
use crate::somewhere;
use glam::DVec3;
use std::io;

/// Turns the normals of one cloud after the other.
pub struct Peer(Process);

impl Peer {
    pub fn start(python: &str) -> io::Result<Peer> {
        Process::start(python, "tests/bench/orient_open3d.py").map(Peer)
    }

    /// The share of the points that it turns right, by consistent tangent planes and towards the camera.
    pub fn right(&mut self, scene: &Scene) -> io::Result<[f64; 2]> {
        let mut message = (scene.points.len() as u32).to_le_bytes().to_vec();
        for p in std::iter::once(&somewhere(scene)).chain(&scene.points) {
            message.extend(p.to_array().iter().flat_map(|x| x.to_le_bytes()));
        }
        self.0.send(&message)?;
        let mut shares = [0.0; 2];
        for share in &mut shares {
            let bytes = self.0.receive(12 * scene.points.len())?;
            let values: Vec<f64> = bytes
                .chunks_exact(4)
                .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]).into())
                .collect();
            let normals = values.chunks_exact(3).map(DVec3::from_slice);
            let told = scene.points.iter().zip(normals);
            let is: Vec<bool> = told.filter_map(|(&p, n)| (scene.truth)(p, n)).collect();
            *share = is.iter().filter(|is| **is).count() as f64 / is.len() as f64;
        }
        Ok(shares)
    }
}
