//! The stages in order: what the crate, the package and the page call.

pub(crate) mod input;

use crate::base::clock::Clock;
use crate::base::error::{Error, Result};
use crate::base::par;
use crate::base::params::{
    COLORS, Orientation, Outliers, ReduceParams, Resolution, SurfaceParams, Target,
};
use crate::base::progress::Progress;
use crate::cloud::octree::Octree;
use crate::cloud::{Attribute, Cloud, in_frame};
use crate::features::noise::{Scales, quantile};
use crate::features::{self, Features};
use crate::fit;
use crate::fit::cells::{self, Sites};
use crate::mesh::attach::attach;
use crate::mesh::few::{self, Few};
use crate::mesh::field::Field;
use crate::mesh::{ExtractParams, Extracted, Mesh, extract};
use crate::orient::evidence::Evidence;
use crate::orient::{self, Signs};
use crate::pipeline::input::{Input, Origin, measure};
use crate::reduce::height_field::{Patches, cloud_distances};
use crate::reduce::{self, Reduced};
use crate::report::distance::{mesh_distances, vertex_distances};
use crate::report::{self, DistanceStats, ReduceReport, SurfaceReport};
use glam::Vec3;
use serde::Serialize;
use std::borrow::Cow;

/// A reduced cloud and what its reduction did.
#[derive(Debug, Clone)]
pub struct ReducedCloud {
    /// The points with all that belongs to them.
    pub reduced: Reduced,
    /// Counts, distances, times.
    pub report: ReduceReport,
}

/// A mesh with the cloud that it was fitted to.
#[derive(Debug, Clone)]
pub struct Surface {
    /// In the unit frame of `cloud.reduced.cloud`; see [`Surface::positions_f64`].
    pub mesh: Mesh,
    /// One colour a vertex, where the cloud had colours.
    pub colors: Option<Vec<[u8; 3]>>,
    /// One value a vertex for each scalar of the cloud.
    pub attributes: Vec<Attribute>,
    /// The points that the surface was fitted to, with oriented normals; without their `shares`.
    pub cloud: ReducedCloud,
    /// Where they were asked for.
    pub distances: Option<Distances>,
    /// Counts, distances, topology, times.
    pub report: SurfaceReport,
}

/// How far scan and mesh are apart, place by place, as fractions of the diagonal.
#[derive(Debug, Clone)]
pub struct Distances {
    /// Of every input point, in the input's order, to the mesh; NaN for one that was dropped.
    pub points: Vec<f32>,
    /// At every vertex, the mean of the points that are nearest to its triangles; NaN where there are none.
    pub vertices: Vec<f32>,
}

impl Surface {
    /// Vertices, `x y z …` in the caller's frame.
    pub fn positions_f64(&self) -> Vec<f64> {
        let frame = &self.cloud.reduced.cloud.frame;
        self.mesh
            .vertices
            .iter()
            .flat_map(|&v| frame.to_caller(v))
            .collect()
    }

    /// Corners of the triangles: three vertex indices each.
    pub fn indices(&self) -> &[u32] {
        self.mesh.triangles.as_flattened()
    }
}

/// What can be said of a cloud before anything is done to it. Lengths are in the caller's unit.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct CloudInfo {
    /// Points, those that are not finite too.
    pub count: usize,
    /// Points with a coordinate that is NaN or infinite; all else is about the other points.
    pub non_finite: usize,
    /// Points that repeat an earlier one exactly.
    pub duplicates: usize,
    /// Corners of the bounding box.
    pub bounds: Bounds,
    /// Diagonal of the bounding box.
    pub diagonal: f64,
    /// Median distance of neighbours on the surface.
    pub spacing: f64,
    /// Estimated standard deviation of the noise across the surface.
    pub noise: f64,
}

/// Corners of a bounding box in the caller's frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Bounds {
    /// Lower corner.
    pub min: [f64; 3],
    /// Upper corner.
    pub max: [f64; 3],
}

/// A surface needs this many points.
const MIN_POINTS: usize = 4;
/// A reduction that would leave fewer points than this for a surface is not done: sub-domains need about 30.
const MIN_REDUCED: usize = 64;

/// Edge length of the extraction grid in median spacings: vertices are moved onto the zero set, so that edges of 0.5 to
/// 0.9 spacings give the same error (bench clouds: within 2 %), at 11 and 3.4 triangles a point before simplification.
const EDGE: f64 = 0.75;
/// Share of signs more than against it that turn a hull.
const AGREE: f64 = 0.8;
/// Triangles a fitted point, at most, unless the caller chooses a resolution.
const TRIANGLES: usize = 3;

/// Reduces a cloud (section 3).
///
/// Normals of the result have the signs of the cloud's own normals, where it had them, else arbitrary ones.
///
/// # Errors
/// [`Error::BadOption`], [`Error::Cancelled`].
pub fn reduce(
    cloud: &Cloud,
    params: &ReduceParams,
    progress: &mut dyn Progress,
) -> Result<ReducedCloud> {
    reduce_input(Cow::Borrowed(cloud), params, progress)
}

/// [`reduce`] of a cloud that nobody needs any more: 12 bytes a point less.
///
/// # Errors
/// The same.
pub fn reduce_owned(
    cloud: Cloud,
    params: &ReduceParams,
    progress: &mut dyn Progress,
) -> Result<ReducedCloud> {
    reduce_input(Cow::Owned(cloud), params, progress)
}

fn reduce_input(
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
    let noise = features.noise;
    let mut reduced = reduce::reduce(&cloud, &tree, features, params, &mut clock)?;
    drop(cloud);
    let points = tree.into_points();
    let normals = reduced.cloud.normals.as_deref().unwrap_or_default();
    let patches = Patches::fit(&Octree::build(&reduced.cloud.points), normals);
    let distances = cloud_distances(|k| points[k], &reduced.shares, &patches, &mut clock)?;
    let distance = near_stats(&points, distances.into_iter().map(f64::from));
    let report = reduce_report((&origin, noise), &reduced, distance, &clock);
    origin.restore(&mut reduced);
    Ok(ReducedCloud { reduced, report })
}

/// Takes a cloud to a mesh: reduction, fit, orientation, blending, extraction.
///
/// # Errors
/// [`Error::TooFewPoints`] (under 4), [`Error::Degenerate`] (all points on a line or at one place),
/// [`Error::BadOption`] (`orient: false`, or an `orientation` by evidence that the cloud has not got, too),
/// [`Error::Cancelled`].
pub fn reconstruct(
    cloud: &Cloud,
    params: &SurfaceParams,
    progress: &mut dyn Progress,
) -> Result<Surface> {
    reconstruct_input(Cow::Borrowed(cloud), params, progress)
}

/// [`reconstruct`] of a cloud that nobody needs any more.
///
/// # Errors
/// The same.
pub fn reconstruct_owned(
    cloud: Cloud,
    params: &SurfaceParams,
    progress: &mut dyn Progress,
) -> Result<Surface> {
    reconstruct_input(Cow::Owned(cloud), params, progress)
}

fn reconstruct_input(
    cloud: Cow<Cloud>,
    params: &SurfaceParams,
    progress: &mut dyn Progress,
) -> Result<Surface> {
    params.validate()?;
    check_surface(&cloud, params)?;
    let mut clock = Clock::new(progress);
    let Input {
        cloud,
        tree,
        features,
        origin,
    } = Input::new(cloud, outliers(params), &mut clock)?;
    check_extent(&features)?;
    let noise = Noise::of(&features);
    let fitted = points_to_fit(&cloud, &tree, features, params, &mut clock)?;
    drop(cloud);
    let order = if params.distances {
        tree.order.clone()
    } else {
        Vec::new()
    };
    let input = Measured {
        points: tree.into_points(),
        order,
        noise,
        origin,
    };
    surface(input, fitted, params, clock)
}

/// The reduced cloud, where its points are for the fit, and what is known of their outer side.
type Reduction = (Reduced, Vec<Vec3>, Evidence);

/// What is remembered of a cloud from one call to the next.
#[derive(Debug, Default)]
pub struct Memory {
    input: Option<Input<'static>>,
    /// How it was reduced, and what came out.
    fitted: Option<(Option<ReduceParams>, Reduction)>,
}

/// [`reconstruct_owned`] that does not do again what the call before has done for the same cloud, to the same bytes: the
/// measurements, and the reduction where its options are the same too. Stages that were not run have no time in the
/// report. Costs about 100 bytes a point until the memory is dropped or another cloud comes.
///
/// # Errors
/// Those of [`reconstruct`].
pub fn reconstruct_again(
    cloud: Cloud,
    params: &SurfaceParams,
    memory: &mut Memory,
    progress: &mut dyn Progress,
) -> Result<Surface> {
    params.validate()?;
    check_surface(&cloud, params)?;
    let mut clock = Clock::new(progress);
    // Without its strays a cloud is another one than the caller hands over.
    let whole = outliers(params) == Outliers::Keep;
    let known = |input: &Input| whole && input.is_of(&cloud);
    let input = match memory.input.take().filter(known) {
        Some(input) => input,
        None => {
            memory.fitted = None;
            Input::new(Cow::Owned(cloud), outliers(params), &mut clock)?
        }
    };
    // Remembered from here on, so that a job that is stopped loses nothing of what was done before it.
    let stray;
    let input = if whole {
        &*memory.input.insert(input)
    } else {
        stray = input;
        &stray
    };
    let Input {
        cloud,
        tree,
        features,
        origin,
    } = input;
    check_extent(features)?;
    let fitted = match &memory.fitted {
        Some((reduce, fitted)) if *reduce == params.reduce => fitted.clone(),
        _ => {
            let fitted = points_to_fit(cloud, tree, features.clone(), params, &mut clock)?;
            if whole {
                memory.fitted = Some((params.reduce.clone(), fitted.clone()));
            }
            fitted
        }
    };
    let measured = Measured {
        points: tree.points.clone(),
        order: tree.order.clone(),
        noise: Noise::of(features),
        origin: origin.clone(),
    };
    surface(measured, fitted, params, clock)
}

/// What a surface needs of the input, once it was reduced.
struct Measured {
    points: Vec<Vec3>,
    /// Where each point is in the cloud; empty where nobody asks.
    order: Vec<u32>,
    noise: Noise,
    origin: Origin,
}

/// What is known of the input's noise (standard deviations across the surface, unit frame).
#[derive(Clone, Copy)]
struct Noise {
    all: f32,
    /// The part that comes from rounded coordinates, which a reduction does not average away.
    steps: f32,
}

impl Noise {
    fn of(features: &Features) -> Noise {
        Noise {
            all: features.noise,
            steps: features.steps,
        }
    }
}

/// The surface through the reduced cloud, at `positions`.
fn surface(
    input: Measured,
    (mut reduced, positions, evidence): Reduction,
    params: &SurfaceParams,
    mut clock: Clock,
) -> Result<Surface> {
    let Measured {
        points: input,
        order,
        noise,
        origin,
    } = input;
    let (sites, site_of) = sites(&reduced, &positions, noise, params.orient, &mut clock)?;
    drop(positions);
    let subdomains = cells::divide(&sites, &mut clock)?;
    let noise = noise.all;
    let stands_for = reduced.shares.iter().map(|s| site_of[s.center[0] as usize]);
    let input_of = (&input[..], stands_for);
    let fits = fit::fit(subdomains, &sites, input_of, noise, params, &mut clock)?;
    reduced.shares = Vec::new();
    if fits.functions.is_empty() {
        let found = "no neighbourhood of the points spans a surface".into();
        return Err(Error::Degenerate { found });
    }
    let evidence = evidence.at_sites(&site_of, sites.tree.points.len());
    let rules = (params.orientation, params.propagation);
    let mut signs = orient::orient(&fits, &sites, &evidence, rules, &mut clock)?;
    let few = few::mesh(&sites.tree.points);
    // What is solid around a room is extracted as what is solid in it: holes and borders mean the same then.
    let inward = few.is_none() && signs.look_inward(&sites);
    if inward {
        signs.invert();
    }
    let Extracted {
        mut mesh, holes, ..
    } = match few {
        Some(few) => few_mesh(few, (&sites, &mut signs), params),
        None => {
            let field = Field::new(&fits, &signs, &sites);
            let how = extract_params(&sites, params);
            extract(&field, &sites.tree.points, &field.reach, &how, &mut clock)?
        }
    };
    if inward {
        signs.invert();
    }
    if inward != params.flip {
        mesh.invert();
    }
    if params.flip {
        signs.invert();
    }

    let normals = reduced.cloud.normals.get_or_insert_default();
    normals.resize(reduced.cloud.points.len(), Vec3::ZERO);
    for (normal, site) in normals.iter_mut().zip(&site_of) {
        if let Some(site) = site {
            *normal = signs.normals[*site as usize];
        }
    }
    let carried = params.reduce.as_ref().map(|r| r.attributes.clone());
    let (colors, attributes) = attach(
        &mesh.vertices,
        &sites.tree,
        &reduced.cloud,
        &carried.unwrap_or_default(),
    );
    let apart = mesh_distances(&input, &mesh.vertices, &mesh.triangles, &mut clock)?;
    let distance = near_stats(&input, apart.iter().map(|a| a.distance));
    let distances = params.distances.then(|| {
        let mut points = vec![f32::NAN; origin.given];
        for (&i, apart) in order.iter().zip(&apart) {
            points[origin.callers(i) as usize] = apart.distance as f32;
        }
        Distances {
            points,
            vertices: vertex_distances(&apart, &mesh.triangles, mesh.vertices.len()),
        }
    });
    drop(apart);
    let topology = report::topology(&mesh.triangles, mesh.vertices.len());
    let report = reduce_report((&origin, noise), &reduced, distance, &clock);
    origin.restore(&mut reduced);
    let residuals = || fits.residuals.iter().map(|&r| r as f64);
    let beyond = residuals().filter(|&r| r > params.accuracy).count();
    let surface_report = SurfaceReport {
        reduce: ReduceReport {
            doubts: report::doubts(&signs.account),
            ..report.clone()
        },
        triangles: mesh.triangles.len(),
        components: topology.components,
        boundary_edges: topology.boundary_edges,
        non_manifold_edges: topology.non_manifold_edges,
        genus: topology.genus,
        holes,
        refinements: fits.refinements,
        residual: DistanceStats::of(residuals()),
        beyond_accuracy: beyond as f64 / input.len() as f64,
        orientation_energy: signs.energy,
        orientation_energy_before: signs.energy_before,
        orientation: signs.account,
    };
    let cloud = ReducedCloud { reduced, report };
    Ok(Surface {
        mesh,
        colors,
        attributes,
        cloud,
        distances,
        report: surface_report,
    })
}

/// Statistics of the distances of `points`, without those that are far from all others: one stray would be all that they tell.
fn near_stats(points: &[Vec3], distances: impl Iterator<Item = f64>) -> DistanceStats {
    let each = points.iter().zip(distances);
    DistanceStats::of(each.filter(|(p, _)| in_frame(**p)).map(|(_, d)| d))
}

/// The mesh of a few points that need no fit, looking out as the signs have it.
///
/// A hull has an outer side of its own: only signs that agree with each other turn it, as those of given normals do.
fn few_mesh(few: Few, (sites, signs): (&Sites, &mut Signs), params: &SurfaceParams) -> Extracted {
    let Few { mut mesh, closed } = few;
    let outward: Vec<Vec3> = sites
        .tree
        .points
        .iter()
        .map(|&p| few::normal(&mesh, p))
        .collect();
    let agree = |(a, b): (&Vec3, &Vec3)| f64::from(a.dot(*b)).signum();
    let pairs = outward.iter().zip(&signs.normals);
    let agreement = pairs.map(agree).sum::<f64>() / outward.len() as f64;
    let inverted = agreement < if closed { -AGREE } else { 0.0 };
    if inverted {
        mesh.invert();
    }
    if params.orient {
        let turned = outward.into_iter().map(|n| if inverted { -n } else { n });
        signs.normals = turned.collect();
    }
    Extracted::of(mesh, params.boundary)
}

/// Looks at positions `x y z …` without changing or refusing any.
///
/// # Errors
/// [`Error::EmptyCloud`] (no finite point), [`Error::BadLength`], [`Error::Cancelled`].
pub fn inspect(positions: &[f64], progress: &mut dyn Progress) -> Result<CloudInfo> {
    let finite: Vec<f64> = positions
        .chunks_exact(3)
        .filter(|p| p.iter().all(|x| x.is_finite()))
        .flatten()
        .copied()
        .collect();
    let whole = positions.len() / 3 * 3 == positions.len();
    let cloud = Cloud::from_f64(if whole { &finite } else { positions })?;
    let (tree, features) = measure(&cloud, progress)?;
    let mut sorted: Vec<[u64; 3]> = finite
        .chunks_exact(3)
        .map(|p| [0, 1, 2].map(|a| (p[a] + 0.0).to_bits()))
        .collect();
    sorted.sort_unstable();
    let corner = |pick: fn(f64, f64) -> f64, start: f64| {
        [0, 1, 2].map(|a| finite[a..].iter().step_by(3).copied().fold(start, pick))
    };
    let diagonal = cloud.frame.diagonal;
    let extent = tree.nodes[0].lo != tree.nodes[0].hi;
    Ok(CloudInfo {
        count: positions.len() / 3,
        non_finite: (positions.len() - finite.len()) / 3,
        duplicates: sorted.windows(2).filter(|w| w[0] == w[1]).count(),
        bounds: Bounds {
            min: corner(f64::min, f64::INFINITY),
            max: corner(f64::max, f64::NEG_INFINITY),
        },
        diagonal: if extent { diagonal } else { 0.0 },
        spacing: features.median_spacing() as f64 * diagonal,
        noise: features.noise as f64 * diagonal,
    })
}

/// Whether strays are dropped before a surface is made.
fn outliers(params: &SurfaceParams) -> Outliers {
    let reduce = params.reduce.as_ref();
    reduce.map_or(Outliers::Keep, |reduce| reduce.outliers)
}

/// Points that span something.
fn check_extent(features: &Features) -> Result<()> {
    if features.normals.iter().any(|&n| n != Vec3::ZERO) {
        return Ok(());
    }
    let found = "all points lie on one line or at one place".into();
    Err(Error::Degenerate { found })
}

fn check_surface(cloud: &Cloud, params: &SurfaceParams) -> Result<()> {
    if cloud.len() < MIN_POINTS {
        return Err(Error::TooFewPoints {
            needed: MIN_POINTS,
            found: cloud.len(),
        });
    }
    if !params.orient && cloud.normals.is_none() {
        return Err(Error::BadOption {
            option: "orient".into(),
            expected: "true, or a cloud with normals".into(),
            found: "false and no normals".into(),
        });
    }
    let (lacks, evidence) = match params.orientation {
        Orientation::Normals => (cloud.normals.is_none(), "normals"),
        Orientation::Viewpoints => (cloud.viewpoints.is_none(), "viewpoints"),
        _ => (false, ""),
    };
    if lacks {
        return Err(Error::BadOption {
            option: "orientation".into(),
            expected: format!("a cloud with {evidence}"),
            found: format!("'{evidence}' and the cloud has none"),
        });
    }
    match &params.reduce {
        Some(reduce) => check_attributes(cloud, reduce),
        None => Ok(()),
    }
}

/// Names of `attributes` that the cloud does not have.
fn check_attributes(cloud: &Cloud, params: &ReduceParams) -> Result<()> {
    let scalars = cloud.attributes.iter().map(|a| a.name.as_str());
    let names: Vec<&str> = scalars
        .chain(cloud.colors.as_ref().map(|_| COLORS))
        .collect();
    match params
        .attributes
        .keys()
        .find(|key| !names.contains(&key.as_str()))
    {
        None => Ok(()),
        Some(key) => Err(Error::BadOption {
            option: "attributes".into(),
            expected: if names.is_empty() {
                "an empty object, as the cloud has no attributes".into()
            } else {
                format!("names of the cloud's attributes: {}", names.join(", "))
            },
            found: format!("an object with {key}"),
        }),
    }
}

/// The reduced cloud that surfaces are fitted to, and where its points are for that.
fn points_to_fit(
    cloud: &Cloud,
    tree: &Octree,
    mut features: Features,
    params: &SurfaceParams,
    progress: &mut dyn Progress,
) -> Result<Reduction> {
    let n = tree.points.len();
    let is_few = |count: usize| count < MIN_REDUCED.min(n);
    if let Some(params) = &params.reduce {
        let count = params.target.count(n);
        if !count.is_some_and(is_few) {
            // The validity index may choose fewer centres, and a tolerance or a flatness any number: then the features are
            // asked again.
            let spare = count
                .is_none_or(|count| count < 2 * MIN_REDUCED)
                .then(|| features.clone());
            let reduced = reduce::reduce(cloud, tree, features, params, progress)?;
            match spare {
                Some(spare) if is_few(reduced.cloud.len()) => features = spare,
                _ => {
                    let positions = reduced.cloud.points.clone();
                    let evidence = evidence(cloud, tree, &reduced);
                    return Ok((reduced, positions, evidence));
                }
            }
        }
    }
    let all = ReduceParams {
        target: Target::Ratio(1.0),
        assignment: params.reduce.as_ref().is_some_and(|r| r.assignment),
        cells: params.reduce.as_ref().is_some_and(|r| r.cells),
        ..Default::default()
    };
    let positions = (0..n).map(|i| features.denoised(tree, i)).collect();
    let mut reduced = reduce::reduce(cloud, tree, features, &all, progress)?;
    if params.reduce.is_some() {
        reduced.reason = format!("fewer than {MIN_REDUCED} points would be left: all were fitted");
    }
    let evidence = evidence(cloud, tree, &reduced);
    Ok((reduced, positions, evidence))
}

fn evidence(cloud: &Cloud, tree: &Octree, reduced: &Reduced) -> Evidence {
    Evidence::of(cloud, tree, &reduced.shares, reduced.cloud.len())
}

/// The reduced points, at `positions`, as sites of the fit, and the site of each: copies of a point are one, which stands for
/// the area of all.
fn sites(
    reduced: &Reduced,
    positions: &[Vec3],
    input: Noise,
    orient: bool,
    progress: &mut dyn Progress,
) -> Result<(Sites, Vec<Option<u32>>)> {
    // Points that the unit frame leaves out are no part of a surface.
    let framed: Vec<u32> = (0..positions.len() as u32)
        .filter(|&i| in_frame(positions[i as usize]))
        .collect();
    let inside: Vec<Vec3> = framed.iter().map(|&i| positions[i as usize]).collect();
    let all = Octree::build(&inside);
    let copies = features::copies(&all.points);
    let distinct: Vec<Vec3> = copies.iter().map(|c| all.points[c.start]).collect();
    let index = |k: usize| framed[all.order[k] as usize];
    let mut site_of = vec![None; positions.len()];
    let mut tree = Octree::build(&distinct);
    let mut spacing = Vec::with_capacity(distinct.len());
    for (site, c) in tree.order.iter_mut().enumerate() {
        let copies = copies[*c as usize].clone();
        *c = index(copies.start);
        spacing.push(reduced.spacing[*c as usize] * (copies.len() as f32).sqrt());
        for k in copies {
            site_of[index(k) as usize] = Some(site as u32);
        }
    }
    drop(all);
    let normals = reduced.cloud.normals.as_deref().unwrap_or_default();
    let normals = tree.order.iter().map(|&i| normals[i as usize]).collect();
    // Coarse sampling of curved parts looks like noise, so what is fitted is never noisier than the input.
    let noise = Scales::measure(&tree).noise.min(input.all).max(input.steps);
    let sites = Sites::new(tree, normals, spacing, noise, !orient, progress)?;
    Ok((sites, site_of))
}

/// How the surface of these sites is extracted.
fn extract_params(sites: &Sites, params: &SurfaceParams) -> ExtractParams {
    let resolution = match params.resolution {
        Resolution::Edge(edge) => edge,
        Resolution::Auto => {
            let spacing = quantile(sites.spacing.clone(), 2);
            (EDGE * f64::from(spacing)).clamp(1e-4, 0.25)
        }
    };
    ExtractParams {
        resolution,
        boundary: params.boundary,
        max_hole: params.max_hole,
        sharp: params.sharp,
        most: (params.resolution == Resolution::Auto).then(|| TRIANGLES * sites.tree.points.len()),
    }
}

fn reduce_report(
    (origin, noise): (&Origin, f32),
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
        noise: noise as f64,
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
        ..Default::default()
    }
}
