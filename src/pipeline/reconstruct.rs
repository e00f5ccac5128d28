//! From a cloud to a mesh.

use crate::base::clock::Clock;
use crate::base::error::{Error, Result};
use crate::base::params::{Orientation, Outliers, Resolution, Scatter, SurfaceParams};
use crate::base::progress::Progress;
use crate::cloud::octree::Octree;
use crate::cloud::{Cloud, Floor};
use crate::features::Features;
use crate::features::noise::quantile;
use crate::features::scatter;
use crate::fit;
use crate::fit::cells::{self, Sites};
use crate::mesh::attach::attach;
use crate::mesh::few;
use crate::mesh::field::Field;
use crate::mesh::{ExtractParams, Extracted, Ground, extract};
use crate::orient;
use crate::pipeline::doubtful::{invented, thin};
use crate::pipeline::input::{Input, Origin, check_attributes};
#[cfg(feature = "light")]
use crate::pipeline::light::lighten;
use crate::pipeline::memory::Memory;
use crate::pipeline::reduce::{near_stats, reduce_report};
use crate::pipeline::results::{Distances, ReducedCloud, Surface};
use crate::pipeline::sites::{Noise, Reduction, points_to_fit, sites};
use crate::report::distance::{mesh_distances, vertex_distances};
use crate::report::{self, DistanceStats, Looked, ReduceReport, SurfaceReport};
use glam::Vec3;
use std::borrow::Cow;

/// Points farther from the mesh than this (fraction of the diagonal) are not on it.
const LOST: f64 = 0.02;
/// A surface needs this many points.
const MIN_POINTS: usize = 4;

/// Edge length of the extraction grid in median spacings: vertices are moved onto the zero set, so that edges of 0.5 to
/// 0.9 spacings give the same error (bench clouds: within 2 %), at 11 and 3.4 triangles a point before simplification.
const EDGE: f32 = 0.75;
/// Where the opposite sheet is near for more than this share of the points,
const WALLS: f64 = 0.01;
/// walls are so many edges thick, all but the thinnest tenth,
const ACROSS: f32 = 1.5;
/// but edges have at least this share of the median spacing.
const FINEST: f32 = 0.4;
/// Triangles a fitted point, at most, unless the caller chooses a resolution.
const TRIANGLES: usize = 3;

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
    reconstruct_cloud(Cow::Borrowed(cloud), params, None, progress)
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
    reconstruct_cloud(Cow::Owned(cloud), params, None, progress)
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
    reconstruct_cloud(Cow::Owned(cloud), params, Some(memory), progress)
}

fn reconstruct_cloud(
    cloud: Cow<Cloud>,
    params: &SurfaceParams,
    memory: Option<&mut Memory>,
    progress: &mut dyn Progress,
) -> Result<Surface> {
    params.validate()?;
    check_surface(&cloud, params)?;
    let mut clock = Clock::new(progress);
    let (input, remembered) = match memory {
        Some(memory) => memory.input(cloud, outliers(params), &mut clock)?,
        None => (Input::new(cloud, outliers(params), &mut clock)?, None),
    };
    let Input {
        cloud,
        tree,
        features,
        origin,
    } = input;
    check_extent(&features)?;
    let noise = Noise::of(&features);
    let reduce = || points_to_fit(&cloud, &tree, features.into_owned(), params, &mut clock);
    let fitted = match remembered {
        Some(last) => last.of(&params.reduce, reduce)?,
        None => reduce()?,
    };
    let ground = ground(&cloud, &tree.points);
    drop(cloud);
    let input = Measured::new((tree, ground), noise, origin, params);
    surface(input, fitted, params, clock)
}

/// What a surface needs of the input, once it was reduced.
struct Measured<'a> {
    points: Cow<'a, [Vec3]>,
    /// Where each point is in the cloud; empty where nobody asks.
    order: Cow<'a, [u32]>,
    noise: Noise,
    origin: Origin,
    ground: Ground,
}

impl<'a> Measured<'a> {
    fn new(
        (tree, ground): (Cow<'a, Octree>, Ground),
        noise: Noise,
        origin: Origin,
        params: &SurfaceParams,
    ) -> Measured<'a> {
        let (points, order): (_, Cow<[u32]>) = match tree {
            Cow::Borrowed(tree) => ((&tree.points[..]).into(), (&tree.order[..]).into()),
            Cow::Owned(tree) if params.distances => (tree.points.into(), tree.order.into()),
            Cow::Owned(tree) => (tree.into_points().into(), Cow::default()),
        };
        Measured {
            points,
            order,
            noise,
            origin,
            ground,
        }
    }
}

/// The surface through the reduced cloud, at `positions`.
fn surface(
    input: Measured,
    reduction: Reduction,
    params: &SurfaceParams,
    mut clock: Clock,
) -> Result<Surface> {
    let Measured {
        points: input,
        order,
        noise,
        origin,
        ground,
    } = input;
    let Reduction {
        mut reduced,
        positions,
        evidence,
        scatter,
    } = reduction;
    let is_scatter = |i: u32| scatter[i as usize];
    let scattered: Vec<bool> = (reduced.shares.iter().map(|s| is_scatter(s.center[0]))).collect();
    let drops = params.scatter == Scatter::Drop && !scatter::is_all(&scatter);
    let without = if drops {
        scatter
    } else {
        vec![false; scatter.len()]
    };
    let how = (noise, params.orient);
    let (sites, site_of) = sites(&reduced, &positions, &without, how, &mut clock)?;
    drop(positions);
    let subdomains = cells::divide(&sites, &mut clock)?;
    let stands_for = reduced.shares.iter().map(|s| site_of[s.center[0] as usize]);
    let input_of = (&input[..], stands_for);
    let fits = fit::fit(subdomains, &sites, input_of, noise.all, params, &mut clock)?;
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
    let mut sensor = evidence.sensor(&signs.account);
    if inward {
        signs.invert();
        sensor.iter_mut().for_each(|v| *v = -*v);
    }
    let Extracted {
        mut mesh,
        holes,
        crossings,
        dropped,
        ..
    } = match few {
        Some(few) => few.placed(
            (&sites, &mut signs),
            (params.orient, params.boundary, &ground),
        ),
        None => {
            let field = Field::new(&fits, &signs, &sites, &sensor);
            let how = extract_params(&sites, ground, params);
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
    let kept = (0..input.len()).filter(|&k| !(drops && scattered[k]));
    let lost = kept.clone().filter(|&k| apart[k].distance > LOST).count();
    let distance = near_stats(kept.map(|k| (input[k], apart[k].distance)));
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
    let (low, high) = world_box(&input, &reduced.cloud);
    let mut doubts = report.doubts.clone();
    doubts.extend(report::doubts_of_shape(low, high, report.distance.rms));
    doubts.extend(report::doubts(&signs.account));
    let scattered = scattered.iter().filter(|&&is| is).count();
    let looked = Looked {
        scatter: scattered as f64 / input.len() as f64,
        drops,
        thin: thin(&sites, noise.all),
        invented: invented(&mesh, &sites),
        tunnels: topology.genus.iter().sum::<i64>().max(0) as usize,
        points: sites.tree.points.len(),
        triangles: mesh.triangles.len(),
        crossings,
        islands: dropped.max(lost as f64 / input.len() as f64),
    };
    doubts.extend(report::doubts_of_surface(&looked));
    let surface_report = SurfaceReport {
        reduce: ReduceReport {
            doubts,
            ..report.clone()
        },
        triangles: mesh.triangles.len(),
        components: topology.components,
        boundary_edges: topology.boundary_edges,
        non_manifold_edges: topology.non_manifold_edges,
        genus: topology.genus,
        holes,
        self_intersections: crossings,
        scatter: if drops { scattered } else { 0 },
        refinements: fits.refinements,
        residual: DistanceStats::of(residuals()),
        beyond_accuracy: beyond as f64 / input.len() as f64,
        orientation_energy: signs.energy,
        orientation_energy_before: signs.energy_before,
        orientation: signs.account,
        #[cfg(feature = "light")]
        simplified: None,
    };
    let cloud = ReducedCloud { reduced, report };
    let surface = Surface {
        mesh,
        colors,
        attributes,
        cloud,
        distances,
        report: surface_report,
    };
    #[cfg(feature = "light")]
    if let Some(triangles) = params.triangles {
        return lighten(surface, triangles, &mut clock);
    }
    Ok(surface)
}

/// Corners of the bounding box of points in the cloud's unit frame, in world coordinates.
fn world_box(points: &[Vec3], cloud: &Cloud) -> ([f64; 3], [f64; 3]) {
    let low = points.iter().copied().reduce(Vec3::min).unwrap_or_default();
    let high = points.iter().copied().reduce(Vec3::max).unwrap_or_default();
    let origin = cloud.origin.unwrap_or_default();
    let world = |corner| {
        let p = cloud.frame.to_caller(corner);
        [0, 1, 2].map(|axis| p[axis] + origin[axis])
    };
    (world(low), world(high))
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

/// What the object stands on: the plane that the cloud knows, or whatever is lowest. Most of the object is over it.
fn ground(cloud: &Cloud, points: &[Vec3]) -> Ground {
    let Some(Floor { point, normal }) = cloud.floor else {
        return Ground {
            normal: cloud.up.unwrap_or(Vec3::Z).as_dvec3(),
            height: None,
        };
    };
    let normal = normal.as_dvec3();
    let height = cloud.frame.to_unit(point).as_dvec3().dot(normal);
    let over = points.iter().filter(|p| p.as_dvec3().dot(normal) > height);
    let side = if 2 * over.count() < points.len() {
        -1.0
    } else {
        1.0
    };
    Ground {
        normal: side * normal,
        height: Some(side * height),
    }
}

/// How the surface of these sites is extracted.
fn extract_params(sites: &Sites, ground: Ground, params: &SurfaceParams) -> ExtractParams {
    let resolution = match params.resolution {
        Resolution::Edge(edge) => edge,
        Resolution::Auto => {
            let spacing = quantile(sites.spacing.clone(), 2);
            let walls: Vec<f32> = sites.thickness().collect();
            let edge = if walls.len() as f64 > WALLS * sites.spacing.len() as f64 {
                let wall = quantile(walls, 10) / ACROSS;
                (EDGE * spacing).min(wall).max(FINEST * spacing)
            } else {
                EDGE * spacing
            };
            f64::from(edge).clamp(1e-4, 0.25)
        }
    };
    ExtractParams {
        resolution,
        boundary: params.boundary,
        ground,
        max_hole: params.max_hole,
        sharp: params.sharp,
        most: (params.resolution == Resolution::Auto)
            .then(|| (TRIANGLES * sites.tree.points.len()).max(params.triangles.unwrap_or(0))),
        fairing: params.fairing,
    }
}
