//! From a cloud to a reduced cloud.

use crate::base::clock::Clock;
use crate::base::error::Result;
use crate::base::par;
use crate::base::params::ReduceParams;
use crate::base::progress::Progress;
use crate::cloud::octree::Octree;
use crate::cloud::{Cloud, in_frame};
use crate::pipeline::input::{Input, Origin, check_attributes};
use crate::pipeline::results::ReducedCloud;
use crate::pipeline::sites::Noise;
use crate::reduce::height_field::{Patches, cloud_distances};
use crate::reduce::{self, Reduced};
use crate::report;
use crate::report::{DistanceStats, ReduceReport};
use glam::Vec3;
use std::borrow::Cow;

/// Reduces a cloud (section 3).
///
/// Normals of the result have the signs of the cloud's own normals, where it had them, else arbitrary ones.
///
/// # Errors
/// [`crate::Error::BadOption`], [`crate::Error::Cancelled`].
pub fn reduce(
    cloud: &Cloud,
    params: &ReduceParams,
    progress: &mut dyn Progress,
) -> Result<ReducedCloud> {
    reduce_cloud(Cow::Borrowed(cloud), params, progress)
}

/// [`reduce()`] of a cloud that nobody needs any more: 12 bytes a point less.
///
/// # Errors
/// The same.
pub fn reduce_owned(
    cloud: Cloud,
    params: &ReduceParams,
    progress: &mut dyn Progress,
) -> Result<ReducedCloud> {
    reduce_cloud(Cow::Owned(cloud), params, progress)
}

fn reduce_cloud(
    cloud: Cow<Cloud>,
    params: &ReduceParams,
    progress: &mut dyn Progress,
) -> Result<ReducedCloud> {
    params.validate()?;
    check_attributes(&cloud, params)?;
    let mut clock = Clock::new(progress);
    let Input {
        cloud,
        tree,
        features,
        origin,
    } = Input::new(cloud, params.outliers, &mut clock)?;
    let noise = Noise::of(&features);
    let mut reduced = reduce::reduce(&cloud, &tree, features.into_owned(), params, &mut clock)?;
    drop(cloud);
    let points = tree.into_owned().into_points();
    let normals = reduced.cloud.normals.as_deref().unwrap_or_default();
    let patches = Patches::fit(&Octree::build(&reduced.cloud.points), normals);
    let distances = cloud_distances(|k| points[k], &reduced.shares, &patches, &mut clock)?;
    let distances = distances.into_iter().map(f64::from);
    let distance = near_stats(points.iter().copied().zip(distances));
    let report = reduce_report((&origin, noise), &reduced, distance, &clock);
    origin.restore(&mut reduced);
    Ok(ReducedCloud { reduced, report })
}

/// Statistics of the distances of points, without those that are far from all others: one stray would be all that they tell.
pub(crate) fn near_stats(each: impl Iterator<Item = (Vec3, f64)>) -> DistanceStats {
    DistanceStats::of(each.filter(|&(p, _)| in_frame(p)).map(|(_, d)| d))
}

/// What a reduction did, alone or before a surface.
pub(crate) fn reduce_report(
    (origin, noise): (&Origin, Noise),
    reduced: &Reduced,
    distance: DistanceStats,
    clock: &Clock,
) -> ReduceReport {
    ReduceReport {
        input_points: origin.given,
        outliers: origin.dropped(),
        output_points: reduced.cloud.len(),
        cells: reduced.stats.cells,
        iterations: reduced.stats.iterations,
        objective: reduced.stats.objective,
        validity: reduced.stats.validity,
        evenness: reduced.stats.evenness,
        noise: noise.all.into(),
        sharp_points: reduced.stats.kept,
        distance,
        ms: clock.times.clone(),
        total_ms: clock.start.elapsed().as_secs_f64() * 1e3,
        build: if cfg!(not(target_arch = "wasm32")) {
            "native"
        } else if cfg!(feature = "threads") {
            "threads"
        } else {
            "single"
        }
        .into(),
        threads: par::threads(),
        reason: [origin.reason.as_str(), &reduced.reason]
            .into_iter()
            .filter(|reason| !reason.is_empty())
            .collect::<Vec<_>>()
            .join("; "),
        doubts: [
            report::doubts_of_faces(reduced.cloud.faces),
            report::doubts_of_steps(noise.steps),
            report::doubts_of_lines(noise.lines),
        ]
        .concat(),
        ..Default::default()
    }
}
