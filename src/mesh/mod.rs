//! The joined surface as a mesh: partition of unity (the stitching of section 4.2) and iso-surface extraction.
//!
//! The zero set of an implicit function becomes a mesh that is manifold and welded, on a narrow band around the fitted points.
//! [`field`] joins the local functions; [`extract`] walks these steps:
//!
//! 1. `band`: the lattice cells that the surface crosses, found by walking along it from the points.
//! 2. `dual`: dual marching cubes on them; vertices are moved onto the zero set, or onto creases.
//! 3. `holes`, `trim`, `rims`: where no fitted function reaches, the global extension closes the surface or the surface ends
//!    (see [`extract`]).
//! 4. `straighten`: vertices on creases are moved onto the curves that several cells tell.
//! 5. `simplify`: fewer triangles where the surface is flat.
//! 6. `fairing`: the grain that noise left goes, creases stay.
//! 7. `base`, `caps`, `disc`: walls down to the floor, and membranes over the rims, where the surface has to be closed.
//! 8. `crossings`: triangles that cross each other are found and mended.
//!
//! Of [`few`] points the mesh is made without a field.
//!
//! [`attach`] carries colours and scalars from the cloud to the vertices; [`topology`] counts components, handles and borders.
//!
//! **In**: an [`Implicit`] function, negative inside, and the fitted points with the radius that their functions reach, unit frame.
//! **Out**: a [`Mesh`] in the unit frame; normals point outward, triangles run counter-clockwise seen from outside.
//!
//! **Cost**: by the area over the squared edge length of the lattice, most of it evaluations of the field in the band.
//!
//! G. M. Nielson, "Dual marching cubes", 2004; R. Wenger, *Isosurfaces: Geometry, Topology, and Algorithms*, 2013.

pub mod attach;
pub(crate) mod band;
pub(crate) mod base;
pub(crate) mod boxes;
pub(crate) mod caps;
pub(crate) mod collapse;
pub(crate) mod creases;
pub(crate) mod curves;
pub(crate) mod crossings;
pub(crate) mod disc;
pub(crate) mod dual;
pub(crate) mod fairing;
pub(crate) mod few;
pub mod field;
pub(crate) mod flips;
pub mod holes;
pub(crate) mod lattice;
pub(crate) mod loops;
pub(crate) mod probe;
pub(crate) mod rims;
pub(crate) mod sides;
pub(crate) mod simplify;
pub(crate) mod straighten;
pub(crate) mod surface;
pub mod topology;
pub(crate) mod trim;

use crate::base::error::Result;
use crate::base::params::{Boundary, MaxHole};
use crate::base::progress::Progress;
use crate::mesh::band::{grow, span};
use crate::mesh::curves::OnCrease;
use crate::mesh::dual::{Dual, build};
use crate::mesh::holes::{Holes, decide_holes};
use crate::mesh::simplify::simplify;
use crate::mesh::straighten::straighten;
use crate::mesh::topology::area;
use crate::mesh::trim::{drop_phantoms, split_bow_ties, trim_rims};
use glam::{DVec3, Vec3};

pub use crate::mesh::base::Ground;
pub use crate::mesh::holes::{Hole, MOST_FILLED};
pub use crate::mesh::surface::{Implicit, Mesh};

/// Options of [`extract`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExtractParams {
    /// Edge length of the lattice's cells, unit frame, 1e-4 to 0.25.
    pub resolution: f64,
    /// What happens where no fitted function reaches.
    pub boundary: Boundary,
    /// What [`Boundary::Base`] stands on.
    pub ground: Ground,
    /// Widest hole that [`Boundary::Auto`] closes.
    pub max_hole: MaxHole,
    /// Put vertices on creases and corners of the zero set.
    pub sharp: bool,
    /// Edges are collapsed where the surface is flat until no more triangles are left than this, as far as the mesh
    /// stays manifold and well shaped; `None`: all that the lattice makes.
    pub most: Option<usize>,
    /// Take out the grain that the function's noise left.
    pub fairing: bool,
}

/// What [`extract`] makes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Extracted {
    /// The surface.
    pub mesh: Mesh,
    /// Share of the mesh's area (0-1) where no fitted function reached and the global extension closed it.
    pub filled: f64,
    /// Components whose holes were closed.
    pub closed: usize,
    /// Components that were left open.
    pub open: usize,
    /// Holes that were closed and rims that were left open, the widest first.
    pub holes: Vec<Hole>,
    /// Triangles that cross others, after what could be mended was.
    pub crossings: usize,
    /// Share of the points (0-1) that were nearest to pieces that were left out as too small.
    pub dropped: f64,
}

/// The zero set of `field` near `points`, whose fitted functions reach as far as `reach` (a radius for each point).
///
/// The mesh has no edge with more than two triangles, no vertex with more than one fan, no duplicate, degenerate or
/// flipped triangle, and consistent orientation, whatever the field returns (see `dual`). Its bytes depend on the
/// field's values only, not on threads or on the order of the points.
///
/// Where no fitted function reaches,
/// - `Open`: the surface ends, at most about 1.5 spacings (0.6 of a point's reach) beyond the points: it has no triangle
///   in a cell with an unreached corner, and near its rims none that shows the back to [`Implicit::sensor`];
/// - `Closed`: like `Open`, and then each rim is capped by a membrane, which is flat where the rim is; nothing else moves;
/// - `Base`: like `Closed`, and rims that stand on the ground are led straight down to it first, where their caps are flat;
/// - `Auto`: unreached corners take [`Implicit::global`], then each cap for itself stays or goes, by how far it is from the
///   points and how it turns ([`holes`]). Closing stops once it takes more cells than the rest of the surface; components
///   not closed by then stay open.
///
/// A component that no fitted function reaches at all is none, nor is one that is the nearest to fewer than 16 points, nor a
/// small piece that runs along a larger component within two spacings.
///
/// # Errors
/// [`crate::Error::Cancelled`] if `progress` asks for it.
pub fn extract<F: Implicit>(
    field: &F,
    points: &[Vec3],
    reach: &[f32],
    params: &ExtractParams,
    progress: &mut dyn Progress,
) -> Result<Extracted> {
    if points.is_empty() {
        return Ok(Extracted::default());
    }
    let lattice = grow(
        field,
        (points, reach),
        params.resolution,
        params.boundary,
        &mut span(progress, 0.0, 0.4),
    )?;
    let mut dual = build(field, lattice, params.sharp, &mut span(progress, 0.4, 0.75))?;
    let Holes {
        filled,
        closed,
        open,
        mut holes,
    } = decide_holes(&mut dual, params.boundary, (points, reach), params.max_hole);
    trim_rims(&mut dual, (points, reach), params.resolution, |i| {
        field.sensor(i)
    });
    split_bow_ties(&mut dual);
    let dropped = drop_phantoms(&mut dual, points, reach);
    let Triangulated {
        mut mesh,
        mut on_crease,
        at_end,
        creases,
    } = triangulate(dual);
    rims::smooth(&mut mesh, &at_end);
    let scale = (params.resolution, field.noise());
    straighten(&mut mesh, &creases, (&mut on_crease, &at_end), scale);
    let mut span = span(progress, 0.75, 1.0);
    if let Some(most) = params.most {
        simplify(&mut mesh, &on_crease, most, params.resolution, &mut span)?;
    }
    if params.fairing {
        fairing::fair(&mut mesh, field.noise() as f32);
    }
    span(1.0)?;
    let mut extracted = Extracted::of(mesh, params.boundary, &params.ground);
    holes.extend(std::mem::take(&mut extracted.holes));
    holes.sort_by(|a, b| b.diameter.total_cmp(&a.diameter));
    let closes = params.boundary.closes();
    Ok(Extracted {
        filled: filled + extracted.filled,
        closed: if closes { open } else { closed },
        open: if closes { 0 } else { open },
        holes,
        dropped,
        ..extracted
    })
}

impl Extracted {
    /// A mesh with its rims, which are capped where it has to be closed.
    pub(crate) fn of(mut mesh: Mesh, boundary: Boundary, ground: &Ground) -> Extracted {
        let mut rims = caps::rims(&mesh);
        let closed = boundary.closes();
        let hole = |rim: &caps::Rim| Hole {
            diameter: caps::diameter(&mesh, rim),
            closed,
        };
        let holes = rims.iter().map(hole).collect();
        let mut filled = 0.0;
        if closed && !rims.is_empty() {
            let before = area(&mesh.vertices, &mesh.triangles);
            if boundary == Boundary::Base {
                rims = base::stand(&mut mesh, ground);
            }
            caps::close(&mut mesh, &rims);
            // A base cuts off, too, and may leave nothing.
            let after = area(&mesh.vertices, &mesh.triangles);
            filled = (after - before).max(0.0) / after.max(f64::MIN_POSITIVE);
        }
        let crossings = crossings::mend(&mut mesh);
        Extracted {
            mesh,
            filled,
            holes,
            crossings,
            ..Default::default()
        }
    }
}

/// A mesh, and which of its vertices are on creases, and at an end of the surface.
struct Triangulated {
    mesh: Mesh,
    on_crease: Vec<bool>,
    at_end: Vec<bool>,
    /// What is known of the creases of vertices that are not at an end.
    creases: Vec<OnCrease>,
}

/// Cuts the quads, drops unused vertices, and gives a normal to those that have none: the mean of their triangles'.
fn triangulate(dual: Dual) -> Triangulated {
    let mut index = vec![u32::MAX; dual.vertices.len()];
    let used = dual.vertices.iter().filter(|v| v.quads > 0).count();
    let mut mesh = Mesh {
        vertices: Vec::with_capacity(used),
        normals: Vec::with_capacity(used),
        triangles: Vec::with_capacity(2 * dual.quads.len()),
    };
    let (mut on_crease, mut at_end) = (Vec::with_capacity(used), Vec::with_capacity(used));
    let vertices = dual.vertices.iter().zip(&mut index);
    for (vertex, index) in vertices.filter(|(vertex, _)| vertex.quads > 0) {
        *index = mesh.vertices.len() as u32;
        mesh.vertices.push(vertex.position);
        mesh.normals.push(vertex.normal);
        on_crease.push(vertex.sharp);
        at_end.push(vertex.is_at_end());
    }
    for quad in &dual.quads {
        let [p, q, r, s] = quad.vertices.map(|v| index[v as usize]);
        mesh.triangles.extend([[p, q, r], [p, r, s]]);
    }
    if mesh.normals.contains(&Vec3::ZERO) {
        fill_normals(&mut mesh);
    }
    let crease = |crease: &OnCrease| {
        let vertex = index[crease.vertex as usize];
        let inner = vertex != u32::MAX && !at_end[vertex as usize];
        inner.then_some(OnCrease { vertex, ..*crease })
    };
    let creases = dual.creases.iter().filter_map(crease).collect();
    Triangulated {
        mesh,
        on_crease,
        at_end,
        creases,
    }
}

/// Gives the vertices without a normal the mean of their triangles'.
fn fill_normals(mesh: &mut Mesh) {
    let mut sums = vec![DVec3::ZERO; mesh.vertices.len()];
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| mesh.vertices[v as usize].as_dvec3());
        let normal = (b - a).cross(c - a);
        triangle.iter().for_each(|&v| sums[v as usize] += normal);
    }
    let missing = mesh.normals.iter_mut().zip(sums);
    for (normal, sum) in missing.filter(|(n, _)| **n == Vec3::ZERO) {
        *normal = sum.normalize_or(DVec3::Z).as_vec3();
    }
}
