//! The points that a surface is fitted to: the reduced cloud, or all points where that would be too few.

use crate::base::error::Result;
use crate::base::groups::Groups;
use crate::base::params::{Method, ReduceParams, SurfaceParams, Target};
use crate::base::progress::Progress;
use crate::cloud::copies::copies;
use crate::cloud::octree::Octree;
use crate::cloud::{Cloud, in_frame};
use crate::features::Features;
use crate::features::lines::Thinned;
use crate::features::noise::Scales;
use crate::features::scatter;
use crate::fit::cells::Sites;
use crate::orient::evidence::Evidence;
use crate::reduce::{self, Reduced, walls};
use glam::Vec3;

/// A reduction that would leave fewer points than this for a surface is not done: sub-domains need about 30.
const MIN_REDUCED: usize = 64;

/// Thin walls have more points than were asked for where those would be this many times as many.
const MORE: f64 = 1.5;
/// Where they are more than this share of all, all are fitted.
const MOST: f64 = 0.7;

/// Points of one terrace are off by the same, so that their mean is, too: noise of steps counts so many times.
const TERRACE: f32 = 2.0;

/// The reduced cloud and what a surface is made of it with.
#[derive(Debug, Clone)]
pub(crate) struct Reduction {
    pub(crate) reduced: Reduced,
    /// Where its points are for the fit.
    pub(crate) positions: Vec<Vec3>,
    /// What is known of their outer side.
    pub(crate) evidence: Evidence,
    /// Which of them lie where there is no surface.
    pub(crate) scatter: Vec<bool>,
}

impl Reduction {
    fn new(
        (cloud, tree): (&Cloud, &Octree),
        reduced: Reduced,
        positions: Vec<Vec3>,
        scales: (f32, f32),
    ) -> Reduction {
        Reduction {
            evidence: Evidence::of(cloud, tree, &reduced.shares, reduced.cloud.len()),
            scatter: scatter::places(tree, &positions, scales),
            reduced,
            positions,
        }
    }
}

/// The reduced cloud that surfaces are fitted to, and where its points are for that.
pub(crate) fn points_to_fit(
    cloud: &Cloud,
    tree: &Octree,
    mut features: Features,
    params: &SurfaceParams,
    progress: &mut dyn Progress,
) -> Result<Reduction> {
    let n = tree.points.len();
    let scales = (features.noise, features.median_spacing());
    let is_few = |count: usize| count < MIN_REDUCED.min(n);
    let mut reason = String::new();
    if let Some(asked) = &params.reduce {
        let (target, why) = with_walls(tree, &features, asked);
        reason = why;
        let params = ReduceParams {
            target,
            ..asked.clone()
        };
        let count = target.count(n);
        let takes_all = count == Some(n) && target != asked.target;
        if !count.is_some_and(is_few) && !takes_all {
            // The validity index may choose fewer centres, and a tolerance or a flatness any number: then the features are
            // asked again.
            let spare = count
                .is_none_or(|count| count < 2 * MIN_REDUCED)
                .then(|| features.clone());
            let mut reduced = reduce::reduce(cloud, tree, features, &params, progress)?;
            match spare {
                Some(spare) if is_few(reduced.cloud.len()) => features = spare,
                _ => {
                    if reduced.reason.is_empty() {
                        reduced.reason = reason;
                    }
                    let positions = reduced.cloud.points.clone();
                    return Ok(Reduction::new((cloud, tree), reduced, positions, scales));
                }
            }
        }
        if asked.target.count(n).is_none_or(is_few) {
            reason = format!("fewer than {MIN_REDUCED} points would be left: all were fitted");
        }
    }
    let all = ReduceParams {
        target: Target::Ratio(1.0),
        assignment: params.reduce.as_ref().is_some_and(|r| r.assignment),
        cells: params.reduce.as_ref().is_some_and(|r| r.cells),
        ..Default::default()
    };
    let positions: Vec<Vec3> = (0..n).map(|i| features.denoised(tree, i)).collect();
    let mut reduced = reduce::reduce(cloud, tree, features, &all, progress)?;
    reduced.reason = reason;
    Ok(Reduction::new((cloud, tree), reduced, positions, scales))
}

/// The target, or where a share of the points is too few to keep thin walls apart, how many are enough; and why.
fn with_walls(tree: &Octree, features: &Features, params: &ReduceParams) -> (Target, String) {
    let n = tree.points.len();
    if let (Target::Ratio(_), Some(count), Method::Adaptive) =
        (params.target, params.target.count(n), params.method)
    {
        let needed = walls::needed(tree, features, count);
        if needed as f64 > MORE * count as f64 {
            let enough = if needed as f64 > MOST * n as f64 {
                n
            } else {
                needed
            };
            let reason = format!("thin walls need more points: {enough} were fitted");
            return (Target::Count(enough), reason);
        }
    }
    (params.target, String::new())
}

/// What is known of the input's noise: standard deviations across the surface, in the unit frame.
#[derive(Clone, Copy)]
pub(crate) struct Noise {
    pub(crate) all: f32,
    /// See [`Features::steps`].
    pub(crate) steps: f32,
    /// See [`Features::lines`].
    pub(crate) lines: f32,
}

impl Noise {
    pub(crate) fn of(features: &Features) -> Noise {
        Noise {
            all: features.noise,
            steps: features.steps,
            lines: features.lines,
        }
    }
}

/// The reduced points, at `positions`, as sites of the fit, but for those `without` a surface, and the site of each: copies of a
/// point are one, which stands for the area of all; so are points of a scan line that are much nearer to each other than to the
/// next line.
pub(crate) fn sites(
    reduced: &Reduced,
    positions: &[Vec3],
    without: &[bool],
    (input, orient): (Noise, bool),
    progress: &mut dyn Progress,
) -> Result<(Sites, Vec<Option<u32>>)> {
    // Points that the unit frame leaves out are no part of a surface.
    let framed: Vec<u32> = (0..positions.len() as u32)
        .filter(|&i| in_frame(positions[i as usize]) && !without[i as usize])
        .collect();
    let inside: Vec<Vec3> = framed.iter().map(|&i| positions[i as usize]).collect();
    let all = Octree::build(&inside);
    let index = |k: u32| framed[all.order[k as usize] as usize];
    let (places, groups) = places(&all, input.lines > 0.0);
    let mut site_of = vec![None; positions.len()];
    let mut tree = Octree::build(&places);
    let mut spacing = Vec::with_capacity(tree.points.len());
    let mut normals = Vec::with_capacity(tree.points.len());
    let own = reduced.cloud.normals.as_deref().unwrap_or_default();
    for (site, place) in tree.order.iter_mut().enumerate() {
        let members = groups.of(*place);
        *place = index(members[0]);
        let area = (members.len() as f32).sqrt();
        spacing.push(reduced.spacing[*place as usize] * area);
        normals.push(own[*place as usize]);
        for &k in members {
            site_of[index(k) as usize] = Some(site as u32);
        }
    }
    drop((all, places, groups));
    // Coarse sampling of curved parts looks like noise, so what is fitted is never noisier than the input.
    let noise = Scales::measure(&tree)
        .noise
        .min(input.all)
        .max(TERRACE * input.steps);
    let sites = Sites::new(tree, normals, spacing, noise, !orient, progress)?;
    Ok((sites, site_of))
}

/// The places of the sites, and the points of each, at least one: copies, or of scan lines what is much nearer to each other than
/// to the next line.
fn places(tree: &Octree, has_lines: bool) -> (Vec<Vec3>, Groups<u32>) {
    let n = tree.points.len() as u32;
    if has_lines {
        let Thinned {
            places, place_of, ..
        } = Thinned::along_lines(tree);
        let points = Groups::new(places.len(), || place_of.iter().copied().zip(0..n));
        return (places, points);
    }
    let copies = copies(&tree.points);
    let places = copies.iter().map(|c| tree.points[c.start]).collect();
    let points = Groups::new(copies.len(), || {
        let each = (0u32..).zip(&copies);
        each.flat_map(|(place, c)| c.clone().map(move |k| (place, k as u32)))
    });
    (places, points)
}
