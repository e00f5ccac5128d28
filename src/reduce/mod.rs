//! The reduction of section 3: an octree's sub-domains, fuzzy c-means in each, its centres in place of the points.
//!
//! 1. Goal: how many points, and how close where. [`density`] asks for more of them where the surface is curved; a target
//!    given as a `tolerance` is searched for by reducing and measuring. [`law`] is how curvature becomes spacing.
//! 2. Clusters: centres and memberships ([`clustering::Clustering`]), by one of two methods.
//!    - Adaptive (`adaptive`): [`clusters`], weighted fuzzy c-means over all sub-domains without seams (eq. 1, 2 and 5); centres start by
//!      `farthest_first` traversal.
//!    - Paper: [`paper`], sections 3.1 and 3.2 to the letter, with [`fcm`] in each sub-domain.
//! 3. Placement: [`placement`] moves each centre from the mean of its members to their surface; `borders` moves those next to an
//!    open border out to it (`surroundings` tells which).
//! 4. What belongs to a point is carried to its reduced point: colours, scalars, the nearest input point, weights.
//!
//! [`height_field`] is the local surface that the reduced points stand for; distances to it are the reduction's error.
//!
//! **In**: a cloud, its octree and [`Features`], unit frame. **Out**: [`Reduced`], in the unit frame of the cloud, normals of
//! unit length with the input's signs.
//!
//! **Cost**: a sweep of clustering meets each point with the centres within 1.25 wanted spacings of it; five sweeps at most by
//! default. A tolerance takes one to five reductions, mostly.

pub(crate) mod adaptive;
pub(crate) mod borders;
pub mod clustering;
pub mod clusters;
pub mod density;
pub(crate) mod farthest_first;
pub mod fcm;
pub mod height_field;
pub mod law;
pub mod paper;
pub(crate) mod places;
pub mod placement;
pub mod shares;
mod stats;
pub(crate) mod surroundings;
pub(crate) mod tolerance;
pub(crate) mod walls;

use glam::Vec3;

use crate::base::error::Result;
use crate::base::par;
use crate::base::params::{Method, Placement, ReduceParams, Target};
use crate::base::power::Fuzzifier;
use crate::base::progress::{Part, Progress, Stage};
use crate::cloud::Cloud;
use crate::cloud::octree::Octree;
use crate::features::Features;
use crate::reduce::adaptive::{Quotas, adaptive};
use crate::reduce::clustering::Clustering;
use crate::reduce::density::{CurvatureSpacing, Density};
use crate::reduce::height_field::{Patches, cloud_distances};
use crate::reduce::law::Law;
use crate::reduce::placement::{Members, Placed};
use crate::reduce::places::Places;
use crate::reduce::shares::{SHARES, Shares};
use crate::reduce::stats::stats;
use crate::reduce::surroundings::Surroundings;

pub use crate::reduce::stats::ReduceStats;
pub use crate::reduce::walls::WallShare;

/// A reduced cloud. Every array but `assignment` and `cells` has one entry a reduced point.
#[derive(Debug, Clone)]
pub struct Reduced {
    /// Positions, unit normals (signs of the input's normals where it had them, else arbitrary), colours and scalars, in
    /// the input's unit frame.
    pub cloud: Cloud,
    /// √(area that a point stands for), in the unit frame.
    pub spacing: Vec<f32>,
    /// Surface variation λ0/(λ0+λ1+λ2) of the input around the point.
    pub variation: Vec<f32>,
    /// Input points for which this is the nearest centre; adds up to the input's count, without those that were dropped.
    pub weights: Vec<f32>,
    /// Index of the nearest input point.
    pub nearest: Vec<u32>,
    /// Where it was asked for: the reduced point that each input point belongs to most, in the input's order;
    /// [`crate::features::outliers::DROPPED`] for one that was dropped.
    pub assignment: Option<Vec<u32>>,
    /// Where they were asked for: the sub-domains, as the corners of the box of each one's points.
    pub cells: Option<Vec<[Vec3; 2]>>,
    /// The shares of the input points, in the octree's order, in the reduced points.
    pub shares: Vec<Shares>,
    /// What the clustering did.
    pub stats: ReduceStats,
    /// Why the count is not what was asked for, where it is not; else empty.
    pub reason: String,
}

/// Reduces a cloud of at least one point, whose positions are taken from its `tree`. Features are freed as soon as nothing
/// asks for them any more. Copies of a point are one place, which is reduced once and stands for all of them; only a target
/// that is all points keeps the copies.
///
/// # Errors
/// [`crate::Error::BadOption`], [`crate::Error::Cancelled`].
pub fn reduce(
    cloud: &Cloud,
    tree: &Octree,
    features: Features,
    params: &ReduceParams,
    progress: &mut dyn Progress,
) -> Result<Reduced> {
    params.validate()?;
    run((cloud, tree), features, params, None, progress)
}

/// What a part of a scan is reduced by, so that the points of its parts are those of the whole.
pub(crate) struct Whole<'a> {
    /// The law of the whole.
    pub(crate) law: Law,
    /// Reduced points that the law's spacing stands for, where it says 1.
    pub(crate) scale: f64,
    /// How thin walls are kept apart, where there are some.
    pub(crate) walls: Option<WallShare>,
    /// Even in 0..1, of a point by its index in the cloud: the same whatever part it is in.
    pub(crate) chance: &'a dyn Fn(u32) -> f64,
}

/// [`reduce`] of a part of a scan: the target is the `whole`'s, and so that sub-domains do not depend on the part, the parameters say
/// how many points they have.
pub(crate) fn reduce_part(
    (cloud, tree): (&Cloud, &Octree),
    features: Features,
    params: &ReduceParams,
    whole: &Whole,
    progress: &mut dyn Progress,
) -> Result<Reduced> {
    run((cloud, tree), features, params, Some(whole), progress)
}

fn run(
    (cloud, tree): (&Cloud, &Octree),
    features: Features,
    params: &ReduceParams,
    whole: Option<&Whole>,
    progress: &mut dyn Progress,
) -> Result<Reduced> {
    let power = Fuzzifier::new(params.fuzzifier(params.method));
    let given = tree.points.len();
    let all = whole.is_none() && params.target.count(given) == Some(given);
    let places = if all { None } else { Places::of(tree) };
    let (at, features) = match &places {
        Some(places) => (&places.tree, places.features(&features)),
        None => (tree, features),
    };
    let mut job = Job {
        tree: at,
        given,
        features,
        params,
    };
    let first = |k: usize| places.as_ref().map_or(k as u32, |p| p.point(k as u32));
    let chance =
        |k: usize| whole.map_or(0.0, |whole| (whole.chance)(tree.order[first(k) as usize]));
    let (goal, reason) = match whole {
        None => job.goal(progress)?,
        Some(whole) => {
            let density =
                Density::of_part(at, &job.features, (&whole.law, whole.scale), whole.walls);
            (
                Goal::Density(Quotas::Local(&chance), density),
                String::new(),
            )
        }
    };
    let searched = match params.target {
        Target::Tolerance(_) if whole.is_none() => tolerance::DONE,
        _ => 0.0,
    };
    // Only the goal asks for it.
    job.features.curvature = Vec::new();
    let plan = job.plan(&goal);
    let (clustering, index) = job.cluster(goal, &mut Part::new(progress, searched..1.0))?;
    progress.update(Stage::Place, 0.0)?;
    let arrangement = job.arrangement(&clustering, index);
    let members = Members::new(&clustering.shares, clustering.centers.len());
    let mut placed = job.place(&clustering, &arrangement, &members, plan);
    drop(job);
    let stats = stats(at, &clustering, &arrangement.around, power);
    drop((arrangement, clustering.spacing));
    progress.update(Stage::Place, 0.5)?;
    let nearest = if plan.placement == Placement::Sample {
        placement::snap(at, &members, &mut placed)
    } else {
        par::map(
            placed.len(),
            || (),
            |i, ()| placement::nearest(at, &members, i, placed[i].position),
        )
    };
    let cells = params.cells.then(|| {
        let ranges = clustering.cells.iter();
        ranges
            .map(|range| corners(&at.points[range.clone()]))
            .collect()
    });
    // From here on about the points, copies too.
    let point = |&k: &u32| places.as_ref().map_or(k, |places| places.point(k));
    let nearest: Vec<u32> = nearest.iter().map(point).collect();
    let spread = places.as_ref().map(|p| p.spread(&clustering.shares));
    let of_copies = spread.as_ref().map(|s| Members::new(s, placed.len()));
    let members = of_copies.as_ref().unwrap_or(&members);
    let reduced = placement::carry(cloud, tree, members, &placed, &nearest, &params.attributes);
    drop(of_copies);
    let shares = spread.unwrap_or(clustering.shares);
    let mut weights = vec![0.0; placed.len()];
    for s in &shares {
        weights[s.center[0] as usize] += 1.0;
    }
    let assignment = params.assignment.then(|| {
        let mut assignment = vec![0; tree.points.len()];
        for (s, &i) in shares.iter().zip(&tree.order) {
            assignment[i as usize] = s.center[0];
        }
        assignment
    });
    progress.update(Stage::Place, 1.0)?;
    Ok(Reduced {
        cloud: reduced,
        spacing: placed.iter().map(|p| p.spacing).collect(),
        variation: placed.iter().map(|p| p.variation).collect(),
        weights,
        nearest: nearest.iter().map(|&k| tree.order[k as usize]).collect(),
        assignment,
        cells,
        shares,
        stats,
        reason,
    })
}

/// Corners of the box of some points.
fn corners(points: &[Vec3]) -> [Vec3; 2] {
    let low = points.iter().copied().fold(Vec3::INFINITY, Vec3::min);
    let high = points.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
    [low, high]
}

/// What the options ask for.
enum Goal<'a> {
    /// This many points by the paper's method.
    Count(usize),
    /// This many points with this density.
    Density(Quotas<'a>, Density),
    /// Flat cells are reduced, the others kept: the paper's own criterion, for which both methods take its cells.
    Flatness,
}

/// How centres are placed.
#[derive(Clone, Copy)]
struct Plan {
    placement: Placement,
    /// Whether those next to open borders move out to them.
    to_borders: bool,
}

/// What a reduction works on.
struct Job<'a> {
    /// Of the places.
    tree: &'a Octree,
    /// Points, with all copies.
    given: usize,
    features: Features,
    params: &'a ReduceParams,
}

/// How centres lie to each other before they are placed.
struct Arrangement {
    /// The area of surface that each stands for.
    areas: Vec<f64>,
    around: Vec<Surroundings>,
}

impl Job<'_> {
    /// What to do, and why it is not what was asked for, where it is not.
    fn goal(&self, progress: &mut dyn Progress) -> Result<(Goal<'static>, String)> {
        if let Target::Tolerance(tolerance) = self.params.target {
            let (tolerance, reason) = tolerance::allowed(&self.features, tolerance);
            return Ok((self.within(tolerance, progress)?, reason));
        }
        let places = self.tree.points.len();
        let asked = self.params.target.count(self.given);
        let count = asked.map(|count| count.min(places));
        let reason = match asked {
            Some(asked) if asked > places => {
                format!("the points are at {places} places: each is kept once")
            }
            _ => String::new(),
        };
        let goal = match (count, self.params.method) {
            (None, _) => Goal::Flatness,
            (Some(count), Method::Paper) => Goal::Count(count),
            (Some(count), Method::Adaptive) => {
                let alpha = self.params.curvature_weight;
                let density = Density::new(self.tree, &self.features, count, alpha);
                Goal::Density(Quotas::Total(count), density)
            }
        };
        Ok((goal, reason))
    }

    /// Looks for the fewest points that keep the surface within a tolerance.
    fn within(&self, tolerance: f64, progress: &mut dyn Progress) -> Result<Goal<'static>> {
        let curvature = CurvatureSpacing::new(self.tree, &self.features);
        let goal = |chord: f64| {
            let density = curvature.within(chord);
            match self.params.method {
                Method::Paper => Goal::Count(density.count()),
                Method::Adaptive => Goal::Density(Quotas::Total(density.count()), density),
            }
        };
        let n = self.tree.points.len();
        let noise = tolerance::removed_noise(&self.features);
        let known = (noise, tolerance);
        let chord = tolerance::search(known, progress, |chord, progress| {
            let goal = goal(chord);
            let plan = self.plan(&goal);
            let (clustering, index) = self.cluster(goal, progress)?;
            if clustering.centers.len() == n {
                return Ok(None);
            }
            let arrangement = self.arrangement(&clustering, index);
            let members = Members::new(&clustering.shares, clustering.centers.len());
            let placed = self.place(&clustering, &arrangement, &members, plan);
            let positions: Vec<Vec3> = placed.iter().map(|p| p.position).collect();
            let normals: Vec<Vec3> = placed.iter().map(|p| p.normal).collect();
            let patches = Patches::fit(&Octree::build(&positions), &normals);
            let denoised = |k| self.features.denoised(self.tree, k);
            let distances = cloud_distances(denoised, &clustering.shares, &patches, progress)?;
            let area = |i: u32| f64::from(self.features.spacing[i as usize]).powi(2);
            Ok(Some(tolerance::error(distances, area)))
        })?;
        Ok(goal(chord))
    }

    /// The clusters, and a tree of their centres.
    fn cluster(&self, goal: Goal, progress: &mut dyn Progress) -> Result<(Clustering, Octree)> {
        let Job {
            tree,
            features,
            params,
            ..
        } = self;
        match goal {
            Goal::Count(count) | Goal::Density(Quotas::Total(count), _)
                if count == tree.points.len() =>
            {
                Ok(keep_all(tree, features))
            }
            Goal::Flatness => paper::cluster(tree, features, None, params, progress),
            Goal::Count(count) => paper::cluster(tree, features, Some(count), params, progress),
            Goal::Density(quotas, density) => {
                adaptive(tree, features, (quotas, density), params, progress)
            }
        }
    }

    /// How centres are placed: points that are all kept, and the paper's centres, stay where they are.
    fn plan(&self, goal: &Goal) -> Plan {
        let dense = match goal {
            Goal::Density(Quotas::Total(count), _) => *count < self.tree.points.len(),
            Goal::Density(Quotas::Local(_), _) => true,
            Goal::Count(_) | Goal::Flatness => false,
        };
        let placement = match self.params.placement {
            Placement::Sample => Placement::Sample,
            other if dense => other,
            _ => Placement::Center,
        };
        Plan {
            placement,
            // The next line is no border, far as it is.
            to_borders: dense && placement != Placement::Center && self.features.lines == 0.0,
        }
    }

    /// `index` is a tree of the centres.
    fn arrangement(&self, clustering: &Clustering, index: Octree) -> Arrangement {
        let areas = placement::areas(&self.features, &clustering.shares, clustering.centers.len());
        let around = surroundings::measure(&index, |i| areas[i].sqrt() as f32);
        Arrangement { areas, around }
    }

    fn place(
        &self,
        clustering: &Clustering,
        arrangement: &Arrangement,
        members: &Members,
        plan: Plan,
    ) -> Vec<Placed> {
        let power = Fuzzifier::new(self.params.fuzzifier(self.params.method));
        let mut placed = placement::place(
            self.tree,
            &self.features,
            (&clustering.centers, &arrangement.areas),
            members,
            (plan.placement, power),
        );
        if plan.to_borders {
            borders::restore(
                self.tree,
                &self.features,
                members,
                &arrangement.around,
                &mut placed,
            );
        }
        placed
    }
}

fn keep_all(tree: &Octree, features: &Features) -> (Clustering, Octree) {
    let alone = |i: u32| Shares {
        center: [i; SHARES],
        u: std::array::from_fn(|j| if j == 0 { 1.0 } else { 0.0 }),
    };
    let n = tree.points.len();
    let clustering = Clustering {
        centers: tree.points.clone(),
        shares: (0..n as u32).map(alone).collect(),
        spacing: features.spacing.clone(),
        cells: Vec::new(),
        iterations: 0,
        kept: n,
    };
    (clustering, Octree::build(&tree.points))
}
