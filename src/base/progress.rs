//! How a job tells the caller its progress, and how the caller stops it: [`Progress`] is asked at every step, and ends the job
//! by [`Error::Cancelled`].

use crate::base::error::{Error, Result};
use serde::Serialize;
use std::ops::Range;

/// The steps of a job, in the order in which they run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "camelCase")]
pub enum Stage {
    /// Morton order and octree.
    Octree,
    /// Spacing, normals, curvature, noise; isolated points.
    Features,
    /// Pieces, planes and strays of a scan.
    Prepare,
    /// Fuzzy c-means in the sub-domains (section 3).
    Cluster,
    /// Centres put in place; attributes carried over.
    Place,
    /// Sub-domains with their overlap.
    Cells,
    /// Local implicit functions (eq. 9-11).
    Fit,
    /// Which side is out (Algorithm 1).
    Orient,
    /// The iso-surface.
    Extract,
    /// Distances and topology.
    Report,
    /// Fewer triangles.
    #[cfg(feature = "light")]
    Simplify,
    /// Pictures of colours and normals.
    #[cfg(feature = "light")]
    Texture,
}

impl Stage {
    /// The name used in reports and in JS, e.g. `"cluster"`.
    pub fn name(self) -> &'static str {
        match self {
            Stage::Octree => "octree",
            Stage::Features => "features",
            Stage::Prepare => "prepare",
            Stage::Cluster => "cluster",
            Stage::Place => "place",
            Stage::Cells => "cells",
            Stage::Fit => "fit",
            Stage::Orient => "orient",
            Stage::Extract => "extract",
            Stage::Report => "report",
            #[cfg(feature = "light")]
            Stage::Simplify => "simplify",
            #[cfg(feature = "light")]
            Stage::Texture => "texture",
        }
    }
}

/// Hears how far a job is and may stop it.
///
/// Called often enough that a stop takes effect within about 100 ms, always from the thread that started the job.
pub trait Progress {
    /// `fraction` (0-1) of `stage` is done. An `Err(Error::Cancelled)` ends the job, which then returns that error.
    fn update(&mut self, stage: Stage, fraction: f32) -> Result<()>;
}

/// Listens to nothing and never stops.
#[derive(Debug, Default, Clone, Copy)]
pub struct Silent;

impl Progress for Silent {
    fn update(&mut self, _: Stage, _: f32) -> Result<()> {
        Ok(())
    }
}

/// A closure is a listener; it returns `false` to stop.
impl<F: FnMut(Stage, f32) -> bool> Progress for F {
    fn update(&mut self, stage: Stage, fraction: f32) -> Result<()> {
        if self(stage, fraction) {
            Ok(())
        } else {
            Err(Error::Cancelled)
        }
    }
}

/// A part of a stage's progress.
pub(crate) struct Part<'a> {
    pub(crate) progress: &'a mut dyn Progress,
    range: Range<f32>,
    stage: Option<Stage>,
}

impl<'a> Part<'a> {
    /// What is told to it, from 0 to 1, goes on as fractions of `range`.
    pub(crate) fn new(progress: &'a mut dyn Progress, range: Range<f32>) -> Part<'a> {
        Part {
            progress,
            range,
            stage: None,
        }
    }

    /// The same, whatever stages it hears of, as a part of this one.
    pub(crate) fn of(stage: Stage, progress: &'a mut dyn Progress, range: Range<f32>) -> Part<'a> {
        Part {
            progress,
            range,
            stage: Some(stage),
        }
    }
}

impl Progress for Part<'_> {
    fn update(&mut self, stage: Stage, fraction: f32) -> Result<()> {
        let Range { start, end } = self.range;
        self.progress.update(
            self.stage.unwrap_or(stage),
            start + (end - start) * fraction,
        )
    }
}
