//! Results to bytes, one file a format; what they share is here, in `names`, `local` and `stand`.

mod glb;
#[cfg(feature = "exports")]
mod las;
mod local;
mod material;
mod names;
mod obj;
#[cfg(feature = "exports")]
mod obj_zip;
#[cfg(feature = "exports")]
mod pcd;
mod pictures;
mod ply;
mod stand;
mod stl;
#[cfg(feature = "exports")]
mod threemf;
#[cfg(feature = "exports")]
mod usdz;
mod values;
mod xyz;
#[cfg(feature = "exports")]
mod zip;

use super::raw_cloud::RawCloud;
use crate::base::error::{Error, Result};
use crate::cloud::Unit;
use stand::Wanted;

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
    /// PCD of the Point Cloud Library, binary: points with everything, in world coordinates.
    #[cfg(feature = "exports")]
    Pcd,
    /// LAS 1.4: points with everything, in world coordinates, with their reference system.
    #[cfg(feature = "exports")]
    Las,
    /// LAS 1.4, compressed by LASzip.
    #[cfg(feature = "exports")]
    Laz,
    /// 3MF: triangles and colours.
    #[cfg(feature = "exports")]
    ThreeMf,
    /// USDZ: everything, single precision around an origin in double precision.
    #[cfg(feature = "exports")]
    Usdz,
    /// A ZIP archive of an OBJ file, its material library and its pictures.
    #[cfg(feature = "exports")]
    Zip,
}

impl Output {
    /// All of this build.
    pub const ALL: &[Output] = &[
        Output::Ply,
        Output::Xyz,
        Output::Glb,
        Output::Obj,
        Output::Stl,
        #[cfg(feature = "exports")]
        Output::Pcd,
        #[cfg(feature = "exports")]
        Output::Las,
        #[cfg(feature = "exports")]
        Output::Laz,
        #[cfg(feature = "exports")]
        Output::ThreeMf,
        #[cfg(feature = "exports")]
        Output::Usdz,
        #[cfg(feature = "exports")]
        Output::Zip,
    ];

    /// Lower-case name, as `format` in the JS interface and as the extension of files.
    pub fn name(self) -> &'static str {
        match self {
            Output::Ply => "ply",
            Output::Xyz => "xyz",
            Output::Glb => "glb",
            Output::Obj => "obj",
            Output::Stl => "stl",
            #[cfg(feature = "exports")]
            Output::Pcd => "pcd",
            #[cfg(feature = "exports")]
            Output::Las => "las",
            #[cfg(feature = "exports")]
            Output::Laz => "laz",
            #[cfg(feature = "exports")]
            Output::ThreeMf => "3mf",
            #[cfg(feature = "exports")]
            Output::Usdz => "usdz",
            #[cfg(feature = "exports")]
            Output::Zip => "zip",
        }
    }

    /// The format of that [`Output::name`].
    pub fn from_name(name: &str) -> Option<Output> {
        let all = Output::ALL.iter().copied();
        all.into_iter().find(|format| format.name() == name)
    }

    /// Which way is up in such files; `None` where any may be.
    pub fn up(self) -> Option<[f64; 3]> {
        match self {
            Output::Glb => Some([0.0, 1.0, 0.0]),
            #[cfg(feature = "exports")]
            Output::Usdz => Some([0.0, 1.0, 0.0]),
            Output::Stl => Some([0.0, 0.0, 1.0]),
            #[cfg(feature = "exports")]
            Output::Las | Output::Laz | Output::ThreeMf => Some([0.0, 0.0, 1.0]),
            _ => None,
        }
    }

    /// The unit of such files; `None` where any may be.
    pub fn unit(self) -> Option<Unit> {
        match self {
            Output::Glb => Some(Unit::Metre),
            #[cfg(feature = "exports")]
            Output::Usdz => Some(Unit::Metre),
            Output::Stl => Some(Unit::Millimetre),
            #[cfg(feature = "exports")]
            Output::ThreeMf => Some(Unit::Millimetre),
            _ => None,
        }
    }
}

/// How a file is written.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WriteOptions {
    /// PLY as text instead of binary. Default: binary.
    pub ascii: bool,
    /// GLB with positions and normals as integers, in half the room, by `KHR_mesh_quantization`. Default: not.
    pub quantize: bool,
    /// Which way is up in the file. Default: what the format asks for ([`Output::up`]), or as it is.
    pub up: Option<[f64; 3]>,
    /// What a coordinate is in the file. Default: what the format asks for ([`Output::unit`]), or as it is.
    pub unit: Option<Unit>,
}

/// Writes points, and with `triangles` (three indices each) a mesh. [`Output`] says what each format holds; what it does
/// not hold is left out.
///
/// # Errors
/// [`Error::BadLength`] where an array does not have one entry a point, or the triangles' length is no multiple of 3;
/// [`Error::BadIndex`] for a corner that is no point; [`Error::NeedsTriangles`] for an STL file without triangles;
/// [`Error::NonFinite`] where the format cannot hold such a number (GLB, STL, USDZ); [`Error::BadOption`] where the options ask for
/// another up or unit and the cloud does not say its own.
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
    check_up(options.up)?;
    check_up(cloud.up)?;
    let up = Wanted::of(options.up, format.up());
    let standing = stand::stand(cloud, up, Wanted::of(options.unit, format.unit()))?;
    let cloud = standing.as_ref().unwrap_or(cloud);
    match format {
        Output::Ply => Ok(ply::write(cloud, triangles, options.ascii)),
        Output::Xyz => Ok(xyz::write(cloud)),
        Output::Glb => glb::write(cloud, triangles, options.quantize),
        Output::Obj => Ok(obj::write(cloud, triangles, None)),
        #[cfg(feature = "exports")]
        Output::Zip => obj_zip::write(cloud, triangles),
        Output::Stl => stl::write(cloud, triangles.ok_or(Error::NeedsTriangles)?),
        #[cfg(feature = "exports")]
        Output::Pcd => Ok(pcd::write(cloud)),
        #[cfg(feature = "exports")]
        Output::Las | Output::Laz => las::write(cloud, format == Output::Laz),
        #[cfg(feature = "exports")]
        Output::ThreeMf => threemf::write(cloud, triangles.ok_or(Error::NeedsTriangles)?),
        #[cfg(feature = "exports")]
        Output::Usdz => usdz::write(cloud, triangles),
    }
}

/// A direction has one.
fn check_up(up: Option<[f64; 3]>) -> Result<()> {
    match up {
        Some([x, y, z]) if !(x * x + y * y + z * z).is_normal() => Err(Error::BadOption {
            option: "up".into(),
            expected: "three finite numbers that are not all 0".into(),
            found: format!("{x}, {y}, {z}"),
        }),
        _ => Ok(()),
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
