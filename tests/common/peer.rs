//! A program that ours is measured beside, in a process of its own: it reads messages and writes answers.

use std::io::{self, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// A Python script that runs until its input ends.
pub struct Process {
    child: Child,
    to: Option<ChildStdin>,
    from: ChildStdout,
}

impl Process {
    pub fn start(python: &str, script: &str) -> io::Result<Process> {
        let mut child = Command::new(python)
            .arg(script)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let lacks = || io::Error::other("the peer has no pipe");
        Ok(Process {
            to: Some(child.stdin.take().ok_or_else(lacks)?),
            from: child.stdout.take().ok_or_else(lacks)?,
            child,
        })
    }

    pub fn send(&mut self, message: &[u8]) -> io::Result<()> {
        let to = self.to.as_mut();
        let to = to.ok_or_else(|| io::Error::other("the peer has ended"))?;
        to.write_all(message)?;
        to.flush()
    }

    /// So many bytes of its answer.
    pub fn receive(&mut self, bytes: usize) -> io::Result<Vec<u8>> {
        let mut answer = vec![0; bytes];
        self.from.read_exact(&mut answer)?;
        Ok(answer)
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // It ends when its input does.
        self.to = None;
        self.child.wait().ok();
    }
}
