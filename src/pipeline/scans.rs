//! Several scans as one: as they lie, or registered.

use crate::base::error::Result;
use crate::base::progress::Progress;
use crate::cloud::{Attribute, Cloud, Viewpoints};
use crate::prepare::register::{Overlap, Placed, Pose, Registered, register};
use glam::{DVec3, Vec3};
use serde::Serialize;

/// What became of a scan.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ScanReport {
    /// How many points it has.
    pub points: usize,
    /// Whether its points are in the result.
    pub placed: bool,
    /// From its own frame to that of the first placed scan: 16 numbers by columns, as WebGL has it; `None` where it is left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pose: Option<[f64; 16]>,
    /// What its red, green and blue were multiplied by; `None` where nothing told.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gain: Option<[f64; 3]>,
    /// Why it is left out; else empty.
    pub reason: String,
}

/// How two placed scans lie on each other.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct PairReport {
    /// Their numbers in the list.
    pub scans: [usize; 2],
    /// Share of a scan that lies on the other: that of the scan of which it is more.
    pub overlap: f64,
    /// Root of the mean square of their distances across the surface, in the caller's unit.
    pub rms: f64,
    /// Whether the pair alone would be enough to trust its place.
    pub trusted: bool,
}

/// Scans in one frame.
pub(crate) struct Joined {
    pub(crate) cloud: Cloud,
    /// Of each point its number among those of all scans.
    pub(crate) callers: Vec<u32>,
    pub(crate) scans: Vec<ScanReport>,
    pub(crate) pairs: Vec<PairReport>,
}

impl Joined {
    /// Registers scans; those that do not fit are left out.
    pub(crate) fn registered(clouds: &[Cloud], progress: &mut dyn Progress) -> Result<Joined> {
        let Registered { scans, pairs } = register(clouds, progress)?;
        let poses: Vec<Option<Pose>> = scans.iter().map(|scan| scan.pose).collect();
        let gains: Vec<[f64; 3]> = scans
            .iter()
            .map(|scan| scan.gain.unwrap_or([1.0; 3]))
            .collect();
        let (cloud, callers) = joined(clouds, &poses, &gains)?;
        let each = clouds.iter().zip(scans);
        let report = |(cloud, scan): (&Cloud, Placed)| ScanReport {
            points: cloud.len(),
            placed: scan.pose.is_some(),
            pose: scan.pose.map(|pose| columns(&pose)),
            gain: scan.gain,
            reason: scan.reason,
        };
        let pair = |pair: Overlap| PairReport {
            scans: pair.scans,
            overlap: pair.overlap,
            rms: pair.rms,
            trusted: pair.trusted,
        };
        Ok(Joined {
            cloud,
            callers,
            scans: each.map(report).collect(),
            pairs: pairs.into_iter().map(pair).collect(),
        })
    }

    /// Puts scans together as they lie.
    pub(crate) fn lying(clouds: &[Cloud]) -> Result<Joined> {
        let poses = vec![Some(Pose::IDENTITY); clouds.len()];
        let (cloud, callers) = joined(clouds, &poses, &vec![[1.0; 3]; clouds.len()])?;
        Ok(Joined {
            cloud,
            callers,
            scans: Vec::new(),
            pairs: Vec::new(),
        })
    }
}

/// A motion as a matrix by columns.
fn columns(pose: &Pose) -> [f64; 16] {
    let [x, y, z] = [pose.turn.x_axis, pose.turn.y_axis, pose.turn.z_axis];
    let t = pose.shift;
    [
        x.x, x.y, x.z, 0.0, y.x, y.y, y.z, 0.0, z.x, z.y, z.z, 0.0, t.x, t.y, t.z, 1.0,
    ]
}

/// The points of all scans that have a pose, moved by it, one scan after the other, with their numbers among all. Where a scan lacks what
/// another has, it is white (colours), zero (normals) or 0 (attributes); viewpoints stay where all have them. The rest is the first scan's.
fn joined(
    clouds: &[Cloud],
    poses: &[Option<Pose>],
    gains: &[[f64; 3]],
) -> Result<(Cloud, Vec<u32>)> {
    let mut starts = vec![0];
    for cloud in clouds {
        starts.push(starts[starts.len() - 1] + cloud.len() as u32);
    }
    let placed: Vec<(usize, &Cloud, Pose)> = (0..clouds.len())
        .filter_map(|k| Some((k, &clouds[k], poses[k]?)))
        .collect();
    let each = || placed.iter();
    let callers = each()
        .flat_map(|&(k, ..)| starts[k]..starts[k + 1])
        .collect();
    let positions: Vec<f64> = each()
        .flat_map(|(_, cloud, pose)| {
            let at = |&p: &Vec3| {
                pose.at(DVec3::from_array(cloud.frame.to_caller(p)))
                    .to_array()
            };
            cloud.points.iter().flat_map(at).collect::<Vec<f64>>()
        })
        .collect();
    let mut all = Cloud::from_f64(&positions)?;
    if each().any(|(_, cloud, _)| cloud.normals.is_some()) {
        let normals = each().flat_map(|(_, cloud, pose)| match &cloud.normals {
            Some(normals) => normals.iter().map(|&n| pose.along(n)).collect(),
            None => vec![Vec3::ZERO; cloud.len()],
        });
        all.normals = Some(normals.collect());
    }
    if each().any(|(_, cloud, _)| cloud.colors.is_some()) {
        let colors = each().flat_map(|(k, cloud, _)| match &cloud.colors {
            Some(colors) => colors.iter().map(|&c| lit(c, gains[*k])).collect(),
            None => vec![[255; 3]; cloud.len()],
        });
        all.colors = Some(colors.collect());
    }
    let mut names: Vec<&str> = Vec::new();
    for attribute in each().flat_map(|(_, cloud, _)| &cloud.attributes) {
        if !names.contains(&attribute.name.as_str()) {
            names.push(&attribute.name);
        }
    }
    for name in names {
        let values = each().flat_map(|(_, cloud, _)| {
            let own = cloud.attributes.iter().find(|own| own.name == name);
            own.map_or_else(|| vec![0.0; cloud.len()], |own| own.values.clone())
        });
        let (name, values) = (name.into(), values.collect());
        all.attributes.push(Attribute { name, values });
    }
    all.viewpoints = viewpoints(&placed);
    let first = placed[0].1;
    all.origin = first.origin;
    all.up = first.up;
    all.unit = first.unit;
    all.crs = first.crs.clone();
    all.seen_from_above = each().all(|(_, cloud, _)| cloud.seen_from_above);
    all.faces = each().map(|(_, cloud, _)| cloud.faces).sum();
    Ok((all, callers))
}

/// A colour times a factor.
fn lit(color: [u8; 3], gain: [f64; 3]) -> [u8; 3] {
    [0, 1, 2].map(|k| libm::floor(f64::from(color[k]) * gain[k] + 0.5).min(255.0) as u8)
}

fn viewpoints(placed: &[(usize, &Cloud, Pose)]) -> Option<Viewpoints> {
    let (mut positions, mut of) = (Vec::new(), Vec::new());
    for (_, cloud, pose) in placed {
        let own = cloud.viewpoints.as_ref()?;
        let before = positions.len() as u32;
        let number = |i: usize| match own.of.as_ref().map_or(0, |of| of[i]) {
            Viewpoints::UNKNOWN => Viewpoints::UNKNOWN,
            station => before + station,
        };
        of.extend((0..cloud.len()).map(number));
        positions.extend(own.positions.iter().map(|&p| pose.at(p)));
    }
    Some(Viewpoints {
        positions,
        of: Some(of),
    })
}
