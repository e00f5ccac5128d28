//! What a light mesh lost, as pictures on it: maps of colours, normals and occlusion.
//!
//! 1. `unwrap`: the light mesh is cut into charts, which lie flat in one picture and nowhere on each other (crate `uvunwrap`);
//!    vertices on cuts are there once for each chart.
//! 2. `tangents`: the frame of each vertex that normal maps are told in, by MikkTSpace, as glTF asks.
//! 3. `texels`: for each texel of a chart its place on the light mesh, and from there the nearest place of the full mesh; `groups` of them
//!    look together.
//! 4. `color`: the colour of the scan's points around that place, or of their values, those of the other side of a wall left out. `relief`: the full mesh's
//!    normal there, in the frame of the light mesh.
//!    `occlusion`: how open the surface is there to the light around, by `layers`, the lines of many directions through the full mesh.
//! 5. `fill`: texels that no point is near take the colours around them, and so do those around charts, so that no seam shows.
//! 6. `picture`: PNG files.
//!
//! **In**: a full and a light mesh of one unit frame ([`crate::light`]), and the scan's points with their colours or values. **Out**: the light mesh
//! with texture coordinates, tangents and pictures ([`Textured`]).
//!
//! **Cost**: one nearest-triangle query a texel, and one of the nearest points for colours; 4 bytes a texel and map, and 40 bytes
//! a texel of a chart.
//!
//! M. Mikkelsen, "Simulation of wrinkled surfaces revisited", 2008, for the frames; J. Cohen et al., "Appearance-preserving
//! simplification", 1998, for normals and colours in maps of a simplified mesh.

mod baking;
mod color;
mod fill;
mod groups;
mod layers;
mod maps;
mod occlusion;
pub(crate) mod picture;
mod relief;
mod tangents;
mod texels;
mod unwrap;

use crate::base::error::{Error, Result};
use crate::base::progress::{Progress, Stage};
use crate::cloud::Attribute;
use crate::light::Painted;
use crate::mesh::Mesh;
use crate::report::distance::TriangleTree;
use baking::Baking;

pub use maps::{Map, Paint, Scan, Texture};

/// Sides of pictures, in texels.
const SIZES: [usize; 2] = [64, 8192];
/// Texels for each point of the scan, where nobody says the size: two along each axis.
const TEXELS_A_POINT: f64 = 4.0;
/// About the share of a picture that charts cover.
const COVERED: f64 = 0.6;

/// How a mesh is textured.
#[derive(Debug, Clone, PartialEq)]
pub struct TextureParams {
    /// Sides of the pictures in texels, 64 to 8192; they are as high as the charts need. Default: two texels a point of the scan along each
    /// axis, a power of two from 256 to 4096.
    pub size: Option<usize>,
    /// Default: colours and normals.
    pub maps: Vec<Map>,
}

impl Default for TextureParams {
    fn default() -> Self {
        TextureParams {
            size: None,
            maps: vec![Map::Color, Map::Normal],
        }
    }
}

/// A mesh with texture coordinates, and pictures for it.
#[derive(Debug, Clone, PartialEq)]
pub struct Textured {
    /// The light mesh, with vertices on the cuts once for each chart.
    pub painted: Painted,
    /// One a vertex, 0 to 1; the first row of a picture is at 0.
    pub uvs: Vec<[f32; 2]>,
    /// One a vertex, with the sign of the bitangent: `cross(normal, tangent) · w`.
    pub tangents: Vec<[f32; 4]>,
    /// The pictures, in the order in which they were asked for.
    pub textures: Vec<Texture>,
}

/// Textures `light` with what `full` and the scan show.
///
/// # Errors
/// [`Error::BadOption`] (size; more charts than the size has room for), [`Error::BadLength`], [`Error::Cancelled`].
pub fn bake(
    full: &Mesh,
    light: &Painted,
    scan: Scan,
    params: &TextureParams,
    progress: &mut dyn Progress,
) -> Result<Textured> {
    let size = size(params, scan.points.len())?;
    scan.paint.check(scan.points.len())?;
    let mut tell =
        |from: f32, to: f32, part: f32| progress.update(Stage::Texture, from + (to - from) * part);
    let unwrapped = unwrap::unwrap(&light.mesh, size, &mut |part| tell(0.0, 0.2, part))?;
    let painted = split(light, &unwrapped.of, unwrapped.triangles);
    let uvs = unwrapped.uvs;
    let tangents = tangents::tangents(&painted.mesh, &uvs)?;
    let faces = TriangleTree::new(&full.vertices, &full.triangles);
    let baking = Baking {
        full,
        faces: &faces,
        light: &painted.mesh,
        uvs: &uvs,
        tangents: &tangents,
        scan,
        size: unwrapped.size,
    };
    let textures = baking.all(&params.maps, &mut |part| tell(0.2, 1.0, part))?;
    Ok(Textured {
        painted,
        uvs,
        tangents,
        textures,
    })
}

/// The size that is asked for, or that suits so many points.
fn size(params: &TextureParams, points: usize) -> Result<usize> {
    match params.size {
        Some(size) if !(SIZES[0]..=SIZES[1]).contains(&size) => Err(Error::bad_option(
            "texture.size",
            "an integer from 64 to 8192",
            &size.to_string(),
        )),
        Some(size) => Ok(size),
        None => {
            let side = (points as f64 * TEXELS_A_POINT / COVERED).sqrt();
            Ok((side as usize).next_power_of_two().clamp(256, 4096))
        }
    }
}

/// The mesh with its vertices in another order, some of them more than once.
fn split(light: &Painted, of: &[u32], triangles: Vec<[u32; 3]>) -> Painted {
    fn picked<T: Copy>(values: &[T], of: &[u32]) -> Vec<T> {
        of.iter().map(|&v| values[v as usize]).collect()
    }
    let attribute = |a: &Attribute| Attribute {
        name: a.name.clone(),
        values: picked(&a.values, of),
    };
    Painted {
        mesh: Mesh {
            vertices: picked(&light.mesh.vertices, of),
            normals: picked(&light.mesh.normals, of),
            triangles,
        },
        colors: light.colors.as_ref().map(|colors| picked(colors, of)),
        attributes: light.attributes.iter().map(attribute).collect(),
    }
}
