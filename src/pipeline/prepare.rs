//! A recipe over a cloud: which points each step drops, and what it saw.
//!
//! What the steps need is measured once, when the first of them needs it, of the points that are left then; later steps take over
//! what was measured of theirs. So a crop before everything else makes all that follows cheap.

use crate::base::error::{Error, Result};
use crate::base::progress::{Part, Progress, Stage};
use crate::cloud::octree::Octree;
use crate::cloud::{Cloud, Frame};
use crate::features::{Features, outliers};
use crate::pipeline::input::measure;
use crate::prepare::pieces::{Keep, Pieces};
use crate::prepare::planes::{Drop, Known, NONE, Planes};
use crate::prepare::recipe::{MOST, Step};
use crate::prepare::strays;
use serde::Serialize;
use web_time::Instant;

/// Pieces that a report tells of.
const TOLD: usize = 100;

/// What a recipe makes of a cloud.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// Indices of the points that are left, ascending: [`Cloud::select`] takes them.
    pub kept: Vec<u32>,
    /// For each point of the cloud 0, or the number of the step, from 1, that dropped it.
    pub dropped_by: Vec<u8>,
    /// What each step did.
    pub steps: Vec<StepReport>,
}

/// What a step did. Lengths and places are in the caller's frame and unit.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct StepReport {
    /// Its name in the recipe.
    pub step: &'static str,
    /// Points that are left after it.
    pub kept: usize,
    /// Points that it dropped.
    pub dropped: usize,
    /// Of a step `plane`: the planes, the largest first.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub planes: Option<Vec<PlaneReport>>,
    /// Of a step `pieces`: the hundred largest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pieces: Option<Vec<PieceReport>>,
    /// Of a step `pieces`: how many there are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub count: Option<usize>,
    /// Why it did less than a person may expect; else empty.
    pub reason: String,
    /// Time that it took, with what it was the first to need.
    pub ms: f64,
    /// Of a step `plane` or `pieces`, for each point of the cloud: the number of its plane or piece, or 2³² - 1.
    #[serde(skip)]
    pub labels: Option<Vec<u32>>,
}

/// A plane of a scan.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct PlaneReport {
    /// Points that belong to it.
    pub points: usize,
    /// Their share of the points that the step found.
    pub share: f64,
    /// Middle of its points.
    pub point: [f64; 3],
    /// Unit, to the side that was seen or that most of the scan is on.
    pub normal: [f64; 3],
    /// Standard deviation of its points across it.
    pub spread: f64,
    /// Area that its points stand for.
    pub area: f64,
    /// Whether it is what a step `plane` with `drop: 'floor'` drops.
    pub floor: bool,
    /// Whether it is among those that `drop: 'all'` drops.
    pub carries: bool,
    /// Whether this step dropped it.
    pub dropped: bool,
}

/// A piece of a scan.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct PieceReport {
    /// How many points it has.
    pub points: usize,
    /// Their share of the points that the step found.
    pub share: f64,
    /// Lower corner of its box.
    pub min: [f64; 3],
    /// Upper corner.
    pub max: [f64; 3],
    /// Whether this step kept it.
    pub kept: bool,
}

/// Does the steps of a recipe, each with what those before left.
///
/// # Errors
/// [`Error::BadOption`] (a step that leaves nothing, more than [`MOST`] steps), [`Error::Cancelled`].
pub fn prepare(cloud: &Cloud, steps: &[Step], progress: &mut dyn Progress) -> Result<Prepared> {
    if steps.len() > MOST {
        let expected = format!("at most {MOST} steps");
        let found = steps.len().to_string();
        return Err(Error::bad_option("prepare", &expected, &found));
    }
    let mut scan = Scan {
        cloud,
        kept: (0..cloud.len() as u32).collect(),
        dropped_by: vec![0; cloud.len()],
        measured: None,
    };
    let mut reports = Vec::new();
    for (number, step) in (1..).zip(steps) {
        let start = Instant::now();
        let share = |k: usize| k as f32 / steps.len() as f32;
        let range = share(reports.len())..share(reports.len() + 1);
        let (dropped, mut report) = scan.perform(step, (progress, range))?;
        if dropped.len() == scan.kept.len() {
            let option = format!("prepare[{}]", reports.len());
            let found = format!("a step '{}' that drops all {}", step.name(), dropped.len());
            let expected = "a step that keeps a point";
            return Err(Error::bad_option(&option, expected, &found));
        }
        scan.drop_those(&dropped, number);
        report.step = step.name();
        report.kept = scan.kept.len();
        report.dropped = dropped.len();
        report.ms = start.elapsed().as_secs_f64() * 1e3;
        reports.push(report);
    }
    Ok(Prepared {
        kept: scan.kept,
        dropped_by: scan.dropped_by,
        steps: reports,
    })
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

impl Scan<'_> {
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
                (mask, planes_report(planes, drop, &chosen, *frame))
            }
            Step::Pieces { keep, gap } => {
                let pieces = Pieces::find(tree, &features.spacing, *gap, &mut part)?;
                let kept = pieces.kept(keep);
                let mask = pieces
                    .of
                    .iter()
                    .map(|&piece| !kept[piece as usize])
                    .collect();
                (mask, pieces_report(pieces, keep, &kept, *frame))
            }
            Step::Region { .. } => (Vec::new(), StepReport::default()),
        };
        if let Some(labels) = &mut report.labels {
            let mut all = vec![NONE; cloud.len()];
            for (&i, &label) in callers.iter().zip(labels.iter()) {
                all[i as usize] = label;
            }
            *labels = all;
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

fn planes_report(planes: Planes, drop: &Drop, chosen: &[bool], frame: Frame) -> StepReport {
    let all = planes.of.len() as f64;
    let report = |(number, plane): (usize, &crate::prepare::planes::Plane)| PlaneReport {
        points: plane.points,
        share: plane.points as f64 / all,
        point: frame.to_caller(plane.point.as_vec3()),
        normal: plane.normal.to_array(),
        spread: plane.sigma * frame.diagonal,
        area: plane.area * frame.diagonal * frame.diagonal,
        floor: planes.floor == Some(number),
        carries: plane.carries,
        dropped: chosen[number],
    };
    let reason = match drop {
        Drop::Floor if planes.floor.is_none() => {
            "no plane carries what was scanned: none was dropped"
        }
        Drop::All if !chosen.contains(&true) => {
            "no plane carries what was scanned: none was dropped"
        }
        Drop::Numbers(numbers) if numbers.iter().any(|&n| n as usize >= chosen.len()) => {
            "some of these numbers are no plane's"
        }
        _ => "",
    };
    StepReport {
        planes: Some(planes.all.iter().enumerate().map(report).collect()),
        labels: Some(planes.of),
        reason: reason.into(),
        ..StepReport::default()
    }
}

fn pieces_report(pieces: Pieces, keep: &Keep, kept: &[bool], frame: Frame) -> StepReport {
    let all = pieces.of.len() as f64;
    let each = pieces.all.iter().zip(kept).take(TOLD);
    let report = |(piece, &kept): (&crate::prepare::pieces::Piece, &bool)| PieceReport {
        points: piece.points,
        share: piece.points as f64 / all,
        min: frame.to_caller(piece.lo),
        max: frame.to_caller(piece.hi),
        kept,
    };
    let reason = match keep {
        Keep::Largest(count) if *count > kept.len() => "there are fewer pieces",
        Keep::Numbers(numbers) if numbers.iter().any(|&n| n as usize >= kept.len()) => {
            "some of these numbers are no piece's"
        }
        _ => "",
    };
    StepReport {
        pieces: Some(each.map(report).collect()),
        count: Some(kept.len()),
        labels: Some(pieces.of),
        reason: reason.into(),
        ..StepReport::default()
    }
}
