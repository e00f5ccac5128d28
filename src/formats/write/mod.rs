//! Results to bytes, one file a format; what they share is here, in `names` and in `local`.

mod glb;
mod local;
mod names;
mod obj;
mod ply;
mod stl;
mod xyz;

use super::{Positions, RawCloud};
use crate::base::error::{Error, Result};

/// A format that is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Output {
    /// PLY: everything, in world coordinates, binary or text.
    Ply,
    /// Rows of numbers as text: everything but triangles, in world coordinates.
    Xyz,
    /// Binary glTF 2.0: everything, single precision around an origin in double precision.
    Glb,
    /// Wavefront OBJ: everything but attributes, as text in world coordinates.
    Obj,
    /// Binary STL: triangles alone, single precision.
    Stl,
}

impl Output {
    /// All of them.
    pub const ALL: [Output; 5] = [
        Output::Ply,
        Output::Xyz,
        Output::Glb,
        Output::Obj,
        Output::Stl,
    ];

    /// Lower-case name, as `format` in the JS interface and as the extension of files.
    pub fn name(self) -> &'static str {
        match self {
            Output::Ply => "ply",
            Output::Xyz => "xyz",
            Output::Glb => "glb",
            Output::Obj => "obj",
            Output::Stl => "stl",
        }
    }

    /// The format of that [`Output::name`].
    pub fn from_name(name: &str) -> Option<Output> {
        Output::ALL.into_iter().find(|format| format.name() == name)
    }
}

/// How a file is written.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct WriteOptions {
    /// PLY as text instead of binary. Default: binary.
    pub ascii: bool,
    /// GLB with positions and normals as integers, in half the room, by `KHR_mesh_quantization`. Default: not.
    pub quantize: bool,
}

/// Writes points, and with `triangles` (three indices each) a mesh. [`Output`] says what each format holds; what it does
/// not hold is left out.
///
/// # Errors
/// [`Error::BadLength`] where an array does not have one entry a point, or the triangles' length is no multiple of 3;
/// [`Error::BadIndex`] for a corner that is no point; [`Error::NeedsTriangles`] for an STL file without triangles;
/// [`Error::NonFinite`] where the format cannot hold such a number (GLB and STL).
pub fn write(
    cloud: &RawCloud,
    triangles: Option<&[u32]>,
    format: Output,
    options: WriteOptions,
) -> Result<Vec<u8>> {
    cloud.check_lengths()?;
    if let Some(indices) = triangles {
        check_triangles(indices, cloud.points())?;
    }
    match format {
        Output::Ply => Ok(ply::write(cloud, triangles, options.ascii)),
        Output::Xyz => Ok(xyz::write(cloud)),
        Output::Glb => glb::write(cloud, triangles, options.quantize),
        Output::Obj => Ok(obj::write(cloud, triangles)),
        Output::Stl => stl::write(cloud, triangles.ok_or(Error::NeedsTriangles)?),
    }
}

fn check_triangles(indices: &[u32], points: usize) -> Result<()> {
    if !indices.len().is_multiple_of(3) {
        return Err(Error::BadLength {
            array: "indices".into(),
            expected: "a multiple of 3".into(),
            found: indices.len(),
        });
    }
    match indices.iter().position(|&corner| corner as usize >= points) {
        None => Ok(()),
        Some(index) => Err(Error::BadIndex {
            index,
            points,
            found: indices[index],
        }),
    }
}

/// Whether world coordinates need double precision.
fn is_double(cloud: &RawCloud) -> bool {
    cloud.origin.is_some() || matches!(cloud.positions, Positions::F64(_))
}

/// A point in world coordinates.
fn world(cloud: &RawCloud, i: usize) -> [f64; 3] {
    let origin = cloud.origin.unwrap_or_default();
    [0, 1, 2].map(|axis| cloud.positions.get(3 * i + axis) + origin[axis])
}

/// The three values of point `i`, or none where there is no such array.
fn triple<T>(array: &Option<Vec<T>>, i: usize) -> &[T] {
    array
        .as_ref()
        .map_or(&[], |values| &values[3 * i..3 * i + 3])
}
