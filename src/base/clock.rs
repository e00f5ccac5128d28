//! How long each stage of a job takes.

use crate::base::error::Result;
use crate::base::progress::{Progress, Stage};
use serde::{Serialize, Serializer, ser::SerializeMap};
use web_time::Instant;

/// Milliseconds by stage, in the order in which the stages ran.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StageTimes(Vec<(Stage, f64)>);

impl StageTimes {
    /// Adds `ms` to a stage's time.
    pub fn add(&mut self, stage: Stage, ms: f64) {
        match self.0.iter_mut().find(|(s, _)| *s == stage) {
            Some((_, total)) => *total += ms,
            None => self.0.push((stage, ms)),
        }
    }

    /// Stages and their milliseconds.
    pub fn iter(&self) -> impl Iterator<Item = (Stage, f64)> {
        self.0.iter().copied()
    }
}

impl Serialize for StageTimes {
    fn serialize<S: Serializer>(&self, s: S) -> std::result::Result<S::Ok, S::Error> {
        let mut map = s.serialize_map(Some(self.0.len()))?;
        for (stage, ms) in &self.0 {
            map.serialize_entry(stage.name(), ms)?;
        }
        map.end()
    }
}

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
