//! A recipe over a cloud: which points each step drops, and what it saw.
//!
//! What the steps need is measured once, when the first of them needs it, of the points that are left then; later steps take over
//! what was measured of theirs. So a crop before everything else makes all that follows cheap.

use crate::base::error::{Error, Result};
use crate::base::progress::{Part, Progress, Stage};
use crate::cloud::octree::Octree;
use crate::cloud::{Cloud, Floor, Frame};
use crate::features::{Features, outliers};
use crate::pipeline::input::measure;
use crate::pipeline::scans::Joined;
use crate::pipeline::step_reports::StepReport;
use crate::prepare::pieces::Pieces;
use crate::prepare::planes::{Known, NONE, Planes};
use crate::prepare::recipe::{MOST, Step};
use crate::prepare::strays;
use web_time::Instant;

/// What a recipe makes of a cloud.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// Indices of the points that are left, ascending: [`Cloud::select`] takes them.
    pub kept: Vec<u32>,
    /// For each point of the cloud 0, or the number of the step, from 1, that dropped it.
    pub dropped_by: Vec<u8>,
    /// What each step did.
    pub steps: Vec<StepReport>,
    /// The floor that was dropped: [`Cloud::with_floor`] takes it. Where several were, the last.
    pub floor: Option<Floor>,
}

/// Does the steps of a recipe, each with what those before left.
///
/// # Errors
/// [`Error::BadOption`] (a step that leaves nothing, more than [`MOST`] steps, `register` behind another step), [`Error::Cancelled`].
pub fn prepare(cloud: &Cloud, steps: &[Step], progress: &mut dyn Progress) -> Result<Prepared> {
    check(steps)?;
    let mut scan = Scan::of(cloud);
    let mut reports = Vec::new();
    if steps.first() == Some(&Step::Register) {
        reports.push(StepReport {
            step: Step::Register.name(),
            kept: cloud.len(),
            reason: "there is one scan, and none to register it with".into(),
            ..StepReport::default()
        });
    }
    scan.perform_all(steps, &mut reports, progress)?;
    Ok(Prepared {
        kept: scan.kept,
        dropped_by: scan.dropped_by,
        floor: floor(&reports),
        steps: reports,
    })
}

/// [`prepare`] of several scans, whose points are numbered through: as they lie, or, where the first step is `register`, in the frame of
/// the first scan that is placed.
///
/// # Errors
/// Those of [`prepare`]; [`Error::EmptyCloud`] without a scan.
pub fn prepare_scans(
    clouds: &[Cloud],
    steps: &[Step],
    progress: &mut dyn Progress,
) -> Result<Prepared> {
    check(steps)?;
    match clouds {
        [] => return Err(Error::EmptyCloud),
        [cloud] => return prepare(cloud, steps, progress),
        _ => {}
    }
    let mut reports = Vec::new();
    let joined = if steps.first() == Some(&Step::Register) {
        let start = Instant::now();
        let range = 0.0..1.0 / steps.len() as f32;
        let joined = Joined::registered(clouds, &mut Part::new(progress, range))?;
        reports.push(StepReport::of_scans(
            &joined,
            start.elapsed().as_secs_f64() * 1e3,
        ));
        joined
    } else {
        Joined::lying(clouds)?
    };
    let mut scan = Scan::of(&joined.cloud);
    scan.perform_all(steps, &mut reports, progress)?;
    // What is told of points of scans that were left out, too.
    let count = clouds.iter().map(Cloud::len).sum();
    let mut dropped_by = vec![1; count];
    for (&i, &by) in joined.callers.iter().zip(&scan.dropped_by) {
        dropped_by[i as usize] = by;
    }
    for labels in reports
        .iter_mut()
        .filter_map(|report| report.labels.as_mut())
    {
        *labels = spread(labels, &joined.callers, count);
    }
    let callers = scan.kept.iter().map(|&i| joined.callers[i as usize]);
    Ok(Prepared {
        kept: callers.collect(),
        dropped_by,
        floor: floor(&reports),
        steps: reports,
    })
}

/// Labels of some points as those of all, [`NONE`] for the others.
fn spread(labels: &[u32], callers: &[u32], count: usize) -> Vec<u32> {
    let mut all = vec![NONE; count];
    for (&i, &label) in callers.iter().zip(labels) {
        all[i as usize] = label;
    }
    all
}

/// The floor that steps dropped; of other planes the largest that carries.
fn floor(reports: &[StepReport]) -> Option<Floor> {
    let of = |report: &StepReport| {
        let dropped = || report.planes.iter().flatten().filter(|plane| plane.dropped);
        let floor = dropped().find(|plane| plane.floor);
        let plane = floor.or_else(|| dropped().find(|plane| plane.carries))?;
        Floor::new(plane.point, plane.normal.map(f64::from)).ok()
    };
    reports.iter().rev().find_map(of)
}

/// What is wrong with a recipe as a whole.
fn check(steps: &[Step]) -> Result<()> {
    if steps.len() > MOST {
        let expected = format!("at most {MOST} steps");
        let found = steps.len().to_string();
        return Err(Error::bad_option("prepare", &expected, &found));
    }
    let behind = steps
        .iter()
        .skip(1)
        .position(|step| *step == Step::Register);
    match behind {
        Some(k) => Err(Error::bad_option(
            &format!("prepare[{}].step", k + 1),
            "'register' as the first step alone",
            "'register' behind others",
        )),
        None => Ok(()),
    }
}

/// What is left of a cloud, and what is known of that.
struct Scan<'a> {
    cloud: &'a Cloud,
    /// The caller's indices, ascending.
    kept: Vec<u32>,
    /// Of each of the caller's points 0, or the number of the step that dropped it.
    dropped_by: Vec<u8>,
    /// Of those that were left when it was asked for last.
    measured: Option<Measured>,
}

/// What was measured of some points.
struct Measured {
    frame: Frame,
    tree: Octree,
    features: Features,
    /// The caller's index of each point of the tree.
    callers: Vec<u32>,
}

type Watch<'a> = (&'a mut dyn Progress, std::ops::Range<f32>);

impl<'a> Scan<'a> {
    fn of(cloud: &'a Cloud) -> Scan<'a> {
        Scan {
            cloud,
            kept: (0..cloud.len() as u32).collect(),
            dropped_by: vec![0; cloud.len()],
            measured: None,
        }
    }

    /// Does the steps that have no report yet.
    fn perform_all(
        &mut self,
        steps: &[Step],
        reports: &mut Vec<StepReport>,
        progress: &mut dyn Progress,
    ) -> Result<()> {
        for step in &steps[reports.len()..] {
            let start = Instant::now();
            let share = |k: usize| k as f32 / steps.len() as f32;
            let range = share(reports.len())..share(reports.len() + 1);
            let (dropped, mut report) = self.perform(step, (progress, range))?;
            if dropped.len() == self.kept.len() {
                let option = format!("prepare[{}]", reports.len());
                let found = format!("a step '{}' that drops all {}", step.name(), dropped.len());
                let expected = "a step that keeps a point";
                return Err(Error::bad_option(&option, expected, &found));
            }
            self.drop_those(&dropped, reports.len() as u8 + 1);
            report.step = step.name();
            report.kept = self.kept.len();
            report.dropped = dropped.len();
            report.ms = start.elapsed().as_secs_f64() * 1e3;
            reports.push(report);
        }
        Ok(())
    }

    /// Which of the points that are left a step drops, as the caller's indices, and what it saw.
    fn perform(&mut self, step: &Step, (progress, range): Watch) -> Result<(Vec<u32>, StepReport)> {
        if let Step::Region { region, keep } = step {
            progress.update(Stage::Prepare, range.start)?;
            let at = |&i: &u32| self.cloud.frame.to_caller(self.cloud.points[i as usize]);
            let each = self.kept.iter().copied();
            let dropped = each.filter(|i| region.holds(at(i)) != *keep).collect();
            return Ok((dropped, StepReport::default()));
        }
        let cloud = self.cloud;
        let measured = self.measured(progress)?;
        let Measured {
            frame,
            tree,
            features,
            callers,
        } = measured;
        let eye = |i: usize| {
            let seeing = cloud.viewpoints.as_ref()?.seeing(callers[i] as usize)?;
            Some(frame.to_unit(seeing.to_array()))
        };
        let mut part = Part::of(Stage::Prepare, progress, range);
        let (mask, mut report) = match step {
            Step::Outliers => {
                let isolated = outliers::isolated(tree, features.noise, &mut part)?;
                (isolated, StepReport::default())
            }
            Step::Flying => {
                let halo = strays::halo(tree, features, &mut Part::new(&mut part, 0.0..0.6))?;
                let mut late = Part::new(&mut part, 0.6..1.0);
                let between = strays::between(tree, &eye, &mut late)?;
                let either = halo.into_iter().zip(between).map(|(a, b)| a || b);
                (either.collect(), StepReport::default())
            }
            Step::Plane {
                drop,
                behind,
                min_share,
                seed,
            } => {
                let known = Known {
                    up: cloud.up,
                    eye: &eye,
                };
                let planes = Planes::find(tree, features, &known, (*min_share, *seed), &mut part)?;
                let chosen = planes.chosen(drop);
                let mask = planes.dropped(tree, &chosen, *behind);
                (mask, StepReport::of_planes(planes, drop, &chosen, *frame))
            }
            Step::Pieces { keep, gap } => {
                let pieces = Pieces::find(tree, &features.spacing, *gap, &mut part)?;
                let kept = pieces.kept(keep);
                let mask = pieces
                    .of
                    .iter()
                    .map(|&piece| !kept[piece as usize])
                    .collect();
                (mask, StepReport::of_pieces(pieces, keep, &kept, *frame))
            }
            Step::Region { .. } | Step::Register => {
                (vec![false; callers.len()], StepReport::default())
            }
        };
        if let Some(labels) = &mut report.labels {
            *labels = spread(labels, callers, cloud.len());
        }
        let of = callers.iter().zip(mask);
        let mut dropped: Vec<u32> = of.filter(|(_, is)| *is).map(|(&i, _)| i).collect();
        dropped.sort_unstable();
        Ok((dropped, report))
    }

    /// What is known of the points that are left.
    fn measured(&mut self, progress: &mut dyn Progress) -> Result<&Measured> {
        let measured = match self.measured.take() {
            Some(measured) if measured.callers.len() == self.kept.len() => measured,
            Some(measured) => measured.of_those(|&i| self.dropped_by[i as usize] == 0),
            None => {
                let part = match self.kept.len() < self.cloud.len() {
                    true => Some(self.cloud.select(&self.kept)?),
                    false => None,
                };
                let cloud = part.as_ref().unwrap_or(self.cloud);
                let (tree, features) = measure(cloud, progress)?;
                let callers = tree.order.iter().map(|&i| self.kept[i as usize]);
                Measured {
                    frame: cloud.frame,
                    callers: callers.collect(),
                    tree,
                    features,
                }
            }
        };
        Ok(self.measured.insert(measured))
    }

    /// Takes away what a step dropped.
    fn drop_those(&mut self, dropped: &[u32], step: u8) {
        for &i in dropped {
            self.dropped_by[i as usize] = step;
        }
        self.kept.retain(|&i| self.dropped_by[i as usize] == 0);
    }
}

impl Measured {
    /// The same of a part of the points, which are told by the caller's indices.
    fn of_those(self, is_left: impl Fn(&u32) -> bool) -> Measured {
        let from: Vec<usize> = (0..self.callers.len())
            .filter(|&i| is_left(&self.callers[i]))
            .collect();
        let points: Vec<_> = from.iter().map(|&i| self.tree.points[i]).collect();
        let tree = Octree::build(&points);
        let of: Vec<usize> = tree.order.iter().map(|&i| from[i as usize]).collect();
        Measured {
            frame: self.frame,
            features: self.features.select(&of),
            callers: of.iter().map(|&i| self.callers[i]).collect(),
            tree,
        }
    }
}
