//! Open3D, by `tests/bench/register_open3d.py`.

use crate::process::Process;
use glam::{DMat3, DVec3};
use pointweave::Cloud;
use pointweave::prepare::register::Pose;
use std::io;

/// Registers one list of scans after the other.
pub struct Peer(Process);

impl Peer {
    pub fn start(python: &str) -> io::Result<Peer> {
        Process::start(python, "tests/bench/register_open3d.py").map(Peer)
    }

    /// Where it puts each scan, `None` where it leaves it out, and how many milliseconds it took.
    pub fn register(&mut self, clouds: &[Cloud]) -> io::Result<(Vec<Option<Pose>>, f64)> {
        let mut message = (clouds.len() as u32).to_le_bytes().to_vec();
        for cloud in clouds {
            message.extend((cloud.len() as u32).to_le_bytes());
            message.extend(cloud.positions_f64().iter().flat_map(|x| x.to_le_bytes()));
        }
        self.0.send(&message)?;
        let ms = self.number()?;
        let poses: io::Result<Vec<Option<Pose>>> = clouds.iter().map(|_| self.pose()).collect();
        Ok((poses?, ms))
    }

    fn pose(&mut self) -> io::Result<Option<Pose>> {
        let is_placed = self.number()? == 1.0;
        let mut m = [0.0; 16];
        for x in &mut m {
            *x = self.number()?;
        }
        let row = |r: usize| DVec3::new(m[4 * r], m[4 * r + 1], m[4 * r + 2]);
        let pose = Pose {
            turn: DMat3::from_cols(row(0), row(1), row(2)).transpose(),
            shift: DVec3::new(m[3], m[7], m[11]),
        };
        Ok(is_placed.then_some(pose))
    }

    fn number(&mut self) -> io::Result<f64> {
        let bytes = self.0.receive(8)?;
        let bytes = bytes
            .try_into()
            .map_err(|_| io::Error::other("no number"))?;
        Ok(f64::from_le_bytes(bytes))
    }
}
