//! Open3D, by `tests/bench/prepare_open3d.py`.

use crate::process::Process;
use crate::staged::Scan;
use std::io;

/// Cuts one scan after the other.
pub struct Peer(Process);

impl Peer {
    pub fn start(python: &str) -> io::Result<Peer> {
        Process::start(python, "tests/bench/prepare_open3d.py").map(Peer)
    }

    /// Which points it keeps, and how many milliseconds it took.
    pub fn cut(&mut self, scan: &Scan, planes: u32, spacing: f64) -> io::Result<(Vec<bool>, f64)> {
        let mut message = (scan.points.len() as u32).to_le_bytes().to_vec();
        message.extend(planes.to_le_bytes());
        message.extend(spacing.to_le_bytes());
        message.extend(scan.positions().iter().flat_map(|x| x.to_le_bytes()));
        self.0.send(&message)?;
        let ms = self.0.receive(8)?;
        let kept = self.0.receive(scan.points.len())?;
        let ms = ms.try_into().map_err(|_| io::Error::other("no time"))?;
        Ok((
            kept.iter().map(|&k| k == 1).collect(),
            f64::from_le_bytes(ms),
        ))
    }
}
