//! Open3D in a process of its own.

use crate::staged::Scan;
use std::io::{self, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// `tests/bench/prepare_open3d.py`, which cuts one scan after the other.
pub struct Peer {
    process: Child,
    to: Option<ChildStdin>,
    from: ChildStdout,
}

impl Peer {
    pub fn start(python: &str) -> io::Result<Peer> {
        let mut process = Command::new(python)
            .arg("tests/bench/prepare_open3d.py")
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

    /// Which points it keeps, and how many milliseconds it took.
    pub fn cut(&mut self, scan: &Scan, planes: u32, spacing: f64) -> io::Result<(Vec<bool>, f64)> {
        let mut message = (scan.points.len() as u32).to_le_bytes().to_vec();
        message.extend(planes.to_le_bytes());
        message.extend(spacing.to_le_bytes());
        message.extend(scan.positions().iter().flat_map(|x| x.to_le_bytes()));
        let to = self.to.as_mut();
        let to = to.ok_or_else(|| io::Error::other("the peer has ended"))?;
        to.write_all(&message)?;
        to.flush()?;
        let mut ms = [0; 8];
        self.from.read_exact(&mut ms)?;
        let mut kept = vec![0; scan.points.len()];
        self.from.read_exact(&mut kept)?;
        Ok((
            kept.iter().map(|&k| k == 1).collect(),
            f64::from_le_bytes(ms),
        ))
    }
}

impl Drop for Peer {
    fn drop(&mut self) {
        // It ends when its input does.
        self.to = None;
        let _ = self.process.wait();
    }
}
