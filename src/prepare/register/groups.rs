//! Scans that were joined, and how they lie to each other.

use super::pose::Pose;

/// From the frame of one scan to that of another.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion {
    pub(crate) from: usize,
    pub(crate) to: usize,
    pub(crate) pose: Pose,
}

/// Groups of scans, at first each alone.
#[derive(Debug, Clone)]
pub(crate) struct Groups {
    /// Of each scan the group's number, which is that of one of its scans.
    of: Vec<usize>,
    /// Of each scan the pose in its group's frame.
    poses: Vec<Pose>,
}

impl Groups {
    /// So many scans.
    pub(crate) fn of(scans: usize) -> Groups {
        Groups {
            of: (0..scans).collect(),
            poses: vec![Pose::IDENTITY; scans],
        }
    }

    /// Whether two scans are in one group.
    pub(crate) fn are_joined(&self, a: usize, b: usize) -> bool {
        self.of[a] == self.of[b]
    }

    /// From the group's frame of a motion's first scan to that of its second.
    fn step(&self, motion: &Motion) -> Pose {
        let from = self.poses[motion.from].back();
        self.poses[motion.to].after(&motion.pose).after(&from)
    }

    /// Joins the groups of two scans.
    pub(crate) fn join(&mut self, motion: &Motion) {
        let (from, to) = (self.of[motion.from], self.of[motion.to]);
        if from == to {
            return;
        }
        let step = self.step(motion);
        for (of, pose) in self.of.iter_mut().zip(&mut self.poses) {
            if *of == from {
                (*of, *pose) = (to, step.after(pose));
            }
        }
    }

    /// The scans of the two groups that a motion would join, each with its pose in the second group's frame.
    pub(crate) fn both(&self, motion: &Motion) -> [Vec<(usize, Pose)>; 2] {
        let step = self.step(motion);
        [(motion.from, step), (motion.to, Pose::IDENTITY)].map(|(scan, step)| {
            let own = (0..self.of.len()).filter(|&k| self.are_joined(k, scan));
            own.map(|k| (k, step.after(&self.poses[k]))).collect()
        })
    }

    /// The scans of the group with most of them, of equal ones that of the first scan; their poses in the frame of the first of them.
    pub(crate) fn largest(&self) -> (Vec<usize>, Vec<Pose>) {
        let size = |scan: usize| self.of.iter().filter(|&&of| of == self.of[scan]).count();
        let first =
            (0..self.of.len()).fold(0, |best, k| if size(k) > size(best) { k } else { best });
        let members: Vec<usize> = (0..self.of.len())
            .filter(|&k| self.are_joined(k, first))
            .collect();
        let to_first = self.poses[first].back();
        let poses = members
            .iter()
            .map(|&k| to_first.after(&self.poses[k]))
            .collect();
        (members, poses)
    }
}
