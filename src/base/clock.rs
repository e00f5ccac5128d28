//! How long each stage of a job takes.

use crate::base::error::Result;
use crate::base::progress::{Progress, Stage};
use crate::report::StageTimes;
use web_time::Instant;

/// Passes progress on and notes how long each stage took.
pub(crate) struct Clock<'a> {
    inner: &'a mut dyn Progress,
    pub(crate) start: Instant,
    last: Instant,
    stage: Stage,
    pub(crate) times: StageTimes,
}

impl<'a> Clock<'a> {
    pub(crate) fn new(inner: &'a mut dyn Progress) -> Clock<'a> {
        let now = Instant::now();
        Clock {
            inner,
            start: now,
            last: now,
            stage: Stage::Octree,
            times: StageTimes::default(),
        }
    }
}

impl Progress for Clock<'_> {
    fn update(&mut self, stage: Stage, fraction: f32) -> Result<()> {
        // What passed before a stage's first word belongs to the stage before.
        if fraction > 0.0 {
            self.stage = stage;
        }
        let now = Instant::now();
        self.times
            .add(self.stage, (now - self.last).as_secs_f64() * 1e3);
        (self.last, self.stage) = (now, stage);
        self.inner.update(stage, fraction)
    }
}
