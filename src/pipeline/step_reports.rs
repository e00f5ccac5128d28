//! What the steps of a recipe did, as it is told.

use crate::cloud::Frame;
use crate::pipeline::scans::{Joined, PairReport, ScanReport};
use crate::prepare::pieces::{Keep, Pieces};
use crate::prepare::planes::{Drop, Planes};
use crate::prepare::recipe::Step;
use serde::Serialize;

/// Pieces that a report tells of.
const TOLD: usize = 100;

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
    /// Of a step `register`: what became of each scan.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scans: Option<Vec<ScanReport>>,
    /// Of a step `register`: the pairs of placed scans that overlap.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pairs: Option<Vec<PairReport>>,
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

impl StepReport {
    /// Of a step `register`.
    pub(crate) fn of_scans(joined: &Joined, ms: f64) -> StepReport {
        let points: usize = joined.scans.iter().map(|scan| scan.points).sum();
        let out = joined.scans.iter().filter(|scan| !scan.placed).count();
        StepReport {
            step: Step::Register.name(),
            kept: joined.cloud.len(),
            dropped: points - joined.cloud.len(),
            reason: match out {
                0 => String::new(),
                1 => "1 scan fits no other and is left out".into(),
                _ => format!("{out} scans fit no other and are left out"),
            },
            scans: Some(joined.scans.clone()),
            pairs: Some(joined.pairs.clone()),
            ms,
            ..StepReport::default()
        }
    }

    /// Of a step `plane`.
    pub(crate) fn of_planes(
        planes: Planes,
        drop: &Drop,
        chosen: &[bool],
        frame: Frame,
    ) -> StepReport {
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

    /// Of a step `pieces`.
    pub(crate) fn of_pieces(
        pieces: Pieces,
        keep: &Keep,
        kept: &[bool],
        frame: Frame,
    ) -> StepReport {
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
}
