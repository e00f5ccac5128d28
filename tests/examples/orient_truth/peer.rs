//! Open3D in a process of its own.

use crate::scenes::Scene;
use crate::somewhere;
use glam::DVec3;
use std::io::{self, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// `tests/bench/orient_open3d.py`, which turns the normals of one cloud after the other.
pub struct Peer {
    process: Child,
    to: Option<ChildStdin>,
    from: ChildStdout,
}

impl Peer {
    pub fn start(python: &str) -> io::Result<Peer> {
        let mut process = Command::new(python)
            .arg("tests/bench/orient_open3d.py")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let lacks = || io::Error::other("the peer has no pipe");
        Ok(Peer {
            to: Some(process.stdin.take().ok_or_else(lacks)?),
            from: process.stdout.take().ok_or_else(lacks)?,
            process,
        })
    }

    /// The share of the points that it turns right, by consistent tangent planes and towards the camera.
    pub fn right(&mut self, scene: &Scene) -> io::Result<[f64; 2]> {
        let mut message = (scene.points.len() as u32).to_le_bytes().to_vec();
        for p in std::iter::once(&somewhere(scene)).chain(&scene.points) {
            message.extend(p.to_array().iter().flat_map(|x| x.to_le_bytes()));
        }
        let to = self
            .to
            .as_mut()
            .ok_or_else(|| io::Error::other("the peer has ended"))?;
        to.write_all(&message)?;
        to.flush()?;
        let mut shares = [0.0; 2];
        for share in &mut shares {
            let mut bytes = vec![0; 12 * scene.points.len()];
            self.from.read_exact(&mut bytes)?;
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

impl Drop for Peer {
    fn drop(&mut self) {
        // At the end of its input it ends.
        self.to = None;
        self.process.wait().ok();
    }
}
