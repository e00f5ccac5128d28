//! Charts of a mesh in one picture.

use crate::base::error::{Error, Result};
use crate::mesh::Mesh;
use uvunwrap::{Density, MeshInput, Options, Packing};

/// Texels around each chart that are its own.
const PADDING: u32 = 2;
/// Sides of pictures are multiples of this: graphics cards compress so many texels as one (`KHR_texture_basisu`).
const BLOCK: u32 = 4;

/// A mesh whose vertices on cuts are there once for each chart.
pub(super) struct Unwrapped {
    /// Which vertex each one was.
    pub(super) of: Vec<u32>,
    pub(super) uvs: Vec<[f32; 2]>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Width and height of the picture.
    pub(super) size: [usize; 2],
}

/// # Errors
/// [`Error::BadOption`] where the charts do not fit, [`Error::Cancelled`].
pub(super) fn unwrap(
    mesh: &Mesh,
    size: usize,
    progress: &mut dyn FnMut(f32) -> Result<()>,
) -> Result<Unwrapped> {
    let positions: Vec<[f32; 3]> = mesh.vertices.iter().map(|v| v.to_array()).collect();
    let input = MeshInput::new(&positions, mesh.triangles.as_flattened());
    let options = Options {
        density: Density::Auto {
            page_size: size as u32,
        },
        padding: PADDING,
        packing: Packing::Fast,
        ..Options::default()
    };
    progress(0.0)?;
    let atlas = uvunwrap::generate(&[input], &options)
        .map_err(|error| Error::Internal(format!("the mesh cannot be unwrapped: {error}")))?;
    progress(1.0)?;
    if atlas.page_count > 1 {
        let charts = atlas.chart_count;
        return Err(Error::bad_option(
            "texture.size",
            "room for all charts: more texels, or fewer triangles",
            &format!("{size} for {charts} charts"),
        ));
    }
    let made = &atlas.meshes[0];
    let corners = made.indices.chunks_exact(3);
    let used = [atlas.width, atlas.height];
    let whole = used.map(|n| n.next_multiple_of(BLOCK));
    let share = [0, 1].map(|k| used[k] as f32 / whole[k] as f32);
    Ok(Unwrapped {
        of: made.vertices.iter().map(|v| v.xref).collect(),
        uvs: made
            .vertices
            .iter()
            .map(|v| [0, 1].map(|k| v.uv[k] * share[k]))
            .collect(),
        triangles: corners.map(|t| [t[0], t[1], t[2]]).collect(),
        size: whole.map(|n| n as usize),
    })
}
