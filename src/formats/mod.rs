//! Files: bytes to arrays, one file a format, and back, in `write`; what readers share is here, in `input`, `text` and `table`.
//!
//! Bytes come from strangers. A reader returns a right result or a typed error that names the line or byte, never
//! panics, and never reserves memory on the word of a header: only what the bytes that are really there can fill.
//!
//! [`read`] takes a file that is wholly in memory; [`Reading`] takes it in slices and gives the points in blocks, so that
//! neither the file nor its points are in memory at once where the format allows that.

// A build with one feature's readers leaves parts unused of what they share.
#![cfg_attr(
    not(all(
        feature = "e57",
        feature = "files",
        feature = "las",
        feature = "packed"
    )),
    allow(dead_code, unused_variables)
)]

mod colors;
mod detect;
#[cfg(feature = "e57")]
mod e57;
mod faces;
#[cfg(feature = "packed")]
mod glb;
#[cfg(feature = "files")]
mod grid;
mod input;
#[cfg(feature = "las")]
mod las;
#[cfg(feature = "files")]
mod lzf;
#[cfg(feature = "files")]
mod obj;
#[cfg(feature = "files")]
mod off;
#[cfg(feature = "files")]
mod pcd;
#[cfg(feature = "files")]
mod ply;
mod pictures;
mod reading;
mod stations;
mod options;
#[cfg(feature = "packed")]
mod packed;
mod preview;
#[cfg(feature = "files")]
mod ptx;
mod sentinels;
#[cfg(any(feature = "files", feature = "packed"))]
mod splats;
#[cfg(feature = "files")]
mod stl;
mod table;
mod text;
mod write;
#[cfg(feature = "files")]
mod xyz;

use crate::base::error::{Error, Result};
use crate::cloud::{Attribute, Cloud, Crs, Unit, Viewpoints};
use crate::pipeline::Surface;
pub use detect::detect;
pub use faces::{FaceMode, Picture, Sampling, Want};
pub use options::ReadOptions;
#[cfg(feature = "packed")]
pub use packed::{Archive, Entry};
pub use pictures::decode as decode_picture;
pub use preview::Preview;
pub use reading::{Reading, Summary};
pub use sentinels::LeftOut;
pub use stations::{Run, Stations};
pub use table::{Block, ColorValues, Verdict};
pub use write::{Output, WriteOptions, write};

/// A file format that is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// PLY, the Stanford polygon format: ascii, binary little endian, binary big endian.
    Ply,
    /// Rows of numbers as text: XYZ, TXT, PTS, CSV, ASC.
    Xyz,
    /// PCD, the Point Cloud Library's: ascii, binary, compressed.
    Pcd,
    /// Wavefront OBJ: its vertices.
    Obj,
    /// OFF, the object file format of Geomview: its vertices.
    Off,
    /// STL, ascii and binary: its vertices, each once.
    Stl,
    /// Binary glTF: the vertices of its scene.
    Glb,
    /// ASPRS LAS 1.0 to 1.4 and LAZ, its compressed form.
    Las,
    /// ASTM E2807.
    E57,
    /// Leica's PTX: scans as text, each at its pose.
    Ptx,
    /// ESRI's ASCII raster: an elevation grid.
    Grid,
    /// GeoTIFF with one band: an elevation grid.
    Tiff,
    /// 3MF: its vertices.
    ThreeMf,
    /// Gaussian splats of 32 bytes: their centres.
    Splat,
    /// Gaussian splats, packed: their centres.
    Spz,
}

impl Format {
    /// All formats that are read.
    pub const ALL: [Format; 15] = [
        Format::Ply,
        Format::Xyz,
        Format::Pcd,
        Format::Obj,
        Format::Off,
        Format::Stl,
        Format::Glb,
        Format::Las,
        Format::E57,
        Format::Ptx,
        Format::Grid,
        Format::Tiff,
        Format::ThreeMf,
        Format::Splat,
        Format::Spz,
    ];
    /// Those that are written, too, and read back to the same bits.
    pub const WRITTEN: [Format; 2] = [Format::Ply, Format::Xyz];

    /// Lower-case name, as `format` in the JS interface: `ply`, `xyz`.
    pub fn name(self) -> &'static str {
        self.extensions()[0]
    }

    /// Its name in messages.
    pub fn title(self) -> &'static str {
        match self {
            Format::Ply => "PLY",
            Format::Xyz => "XYZ",
            Format::Pcd => "PCD",
            Format::Obj => "OBJ",
            Format::Off => "OFF",
            Format::Stl => "STL",
            Format::Glb => "GLB",
            Format::Las => "LAS",
            Format::E57 => "E57",
            Format::Ptx => "PTX",
            Format::Grid => "ASCII grid",
            Format::Tiff => "GeoTIFF",
            Format::ThreeMf => "3MF",
            Format::Splat => "splat",
            Format::Spz => "SPZ",
        }
    }

    /// File name extensions, lower case, without the dot.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Format::Ply => &["ply"],
            Format::Xyz => &["xyz", "txt", "pts", "csv", "asc", "xyzn", "xyzrgb"],
            Format::Pcd => &["pcd"],
            Format::Obj => &["obj"],
            Format::Off => &["off", "coff", "noff", "cnoff"],
            Format::Stl => &["stl"],
            Format::Glb => &["glb"],
            Format::Las => &["las", "laz"],
            Format::E57 => &["e57"],
            Format::Ptx => &["ptx"],
            // Those that end with .asc are told from rows of points by their content.
            Format::Grid => &["grid", "agr", "grd"],
            Format::Tiff => &["tif", "tiff"],
            Format::ThreeMf => &["3mf"],
            Format::Splat => &["splat"],
            Format::Spz => &["spz"],
        }
    }

    /// Whether its clouds are airborne scans: z is up, and all was seen from above.
    pub fn is_airborne(self) -> bool {
        self == Format::Las
    }

    /// Which way is up, where the format says it.
    pub fn up(self) -> Option<[f64; 3]> {
        match self {
            Format::Las | Format::E57 | Format::ThreeMf => Some([0.0, 0.0, 1.0]),
            Format::Glb => Some([0.0, 1.0, 0.0]),
            _ => None,
        }
    }

    /// What a coordinate is, where the format says it; of LAS and LAZ the file may.
    pub fn unit(self) -> Option<Unit> {
        matches!(self, Format::E57 | Format::Glb).then_some(Unit::Metre)
    }

    /// Whether it starts with text, before which editors put a byte order mark.
    fn is_text(self) -> bool {
        use Format::{Grid, Obj, Off, Pcd, Ply, Ptx, Stl, Xyz};
        matches!(self, Ply | Xyz | Pcd | Obj | Off | Stl | Ptx | Grid)
    }

    /// The format of a name (`ply`), an extension (`PTS`) or a file name (`scan.csv`).
    pub fn from_name(name: &str) -> Option<Format> {
        let extension = name.rsplit('.').next().unwrap_or(name).to_lowercase();
        Format::ALL
            .into_iter()
            .find(|format| format.extensions().contains(&extension.as_str()))
    }
}

/// Coordinates `x y z x y z …`: single precision where that loses nothing that matters, else double.
#[derive(Debug, Clone, PartialEq)]
pub enum Positions {
    /// Rounding to single precision moves no coordinate by more than 2⁻²² of the diagonal (2.4e-7).
    F32(Vec<f32>),
    /// Single precision would not do: georeferenced coordinates, for one.
    F64(Vec<f64>),
}

impl Positions {
    /// Number of coordinates, three a point.
    pub fn len(&self) -> usize {
        match self {
            Positions::F32(values) => values.len(),
            Positions::F64(values) => values.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn get(&self, i: usize) -> f64 {
        match self {
            Positions::F32(values) => f64::from(values[i]),
            Positions::F64(values) => values[i],
        }
    }
}

/// What a file holds, in the file's frame and unit: the caller's arrays, not yet a [`Cloud`]. May have no points.
#[derive(Debug, Clone, PartialEq)]
pub struct RawCloud {
    /// Finite coordinates.
    pub positions: Positions,
    /// `r g b` a point, 0-255.
    pub colors: Option<Vec<u8>>,
    /// `x y z` a point as in the file; zero where the file has none.
    pub normals: Option<Vec<f32>>,
    /// Other scalars, one value a point.
    pub attributes: Vec<Attribute>,
    /// Added to positions to give world coordinates.
    pub origin: Option<[f64; 3]>,
    /// Where the points were seen from.
    pub viewpoints: Option<Viewpoints>,
    /// Which way is up.
    pub up: Option<[f64; 3]>,
    /// Whether all was seen from above, as airborne scans are.
    pub seen_from_above: bool,
    /// What a coordinate is.
    pub unit: Option<Unit>,
    /// The reference system of world coordinates.
    pub crs: Option<Crs>,
    /// Rows left out because a coordinate was NaN or infinite.
    pub dropped: usize,
    /// Values of colours, normals and attributes that were not finite and are now 0.
    pub replaced: usize,
    /// Faces that the file says it has.
    pub faces: u64,
    /// What was made of them.
    pub sampling: Sampling,
    /// Points left out, by why: `not-finite`, `invalid`, `no-data`, `no-return`. The first two are `dropped`.
    pub skipped: Vec<(&'static str, u64)>,
    /// What the columns of a table of text were taken for, as [`ReadOptions::columns`] says it.
    pub columns: Vec<String>,
    /// What else is to be said of the points, in sentences.
    pub notes: Vec<String>,
}

impl RawCloud {
    /// Positions alone.
    pub fn new(positions: Positions) -> RawCloud {
        RawCloud {
            positions,
            colors: None,
            normals: None,
            attributes: Vec::new(),
            origin: None,
            viewpoints: None,
            up: None,
            seen_from_above: false,
            unit: None,
            crs: None,
            dropped: 0,
            replaced: 0,
            faces: 0,
            sampling: Sampling::default(),
            skipped: Vec::new(),
            columns: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// The points of a reduced cloud, in double precision.
    pub fn of_cloud(cloud: &Cloud) -> RawCloud {
        RawCloud {
            colors: cloud.colors.as_ref().map(|c| c.as_flattened().to_vec()),
            normals: cloud
                .normals
                .as_ref()
                .map(|n| n.iter().flat_map(|n| n.to_array()).collect()),
            attributes: cloud.attributes.clone(),
            origin: cloud.origin,
            viewpoints: cloud.viewpoints.clone(),
            up: cloud.up.map(|up| up.as_dvec3().to_array()),
            seen_from_above: cloud.seen_from_above,
            unit: cloud.unit,
            crs: cloud.crs.clone(),
            ..RawCloud::new(Positions::F64(cloud.positions_f64()))
        }
    }

    /// The vertices of a mesh, in double precision; its triangles are [`Surface::indices`].
    pub fn of_surface(surface: &Surface) -> RawCloud {
        let cloud = &surface.cloud.reduced.cloud;
        RawCloud {
            colors: surface.colors.as_ref().map(|c| c.as_flattened().to_vec()),
            normals: Some(
                surface
                    .mesh
                    .normals
                    .iter()
                    .flat_map(|n| n.to_array())
                    .collect(),
            ),
            attributes: surface.attributes.clone(),
            origin: cloud.origin,
            up: cloud.up.map(|up| up.as_dvec3().to_array()),
            unit: cloud.unit,
            crs: cloud.crs.clone(),
            ..RawCloud::new(Positions::F64(surface.positions_f64()))
        }
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.positions.len() / 3
    }

    /// The cloud that the pipeline works on.
    ///
    /// # Errors
    /// [`Error::EmptyCloud`]; [`Error::BadLength`], [`Error::NonFinite`] and [`Error::BadOption`] for what no reader made.
    pub fn to_cloud(&self) -> Result<Cloud> {
        let mut cloud = match &self.positions {
            Positions::F32(values) => Cloud::from_f32(values)?,
            Positions::F64(values) => Cloud::from_f64(values)?,
        };
        if let Some(colors) = &self.colors {
            cloud = cloud.with_colors(colors)?;
        }
        if let Some(normals) = &self.normals {
            cloud = cloud.with_normals(normals)?;
        }
        for attribute in &self.attributes {
            cloud = cloud.with_attribute(&attribute.name, &attribute.values)?;
        }
        if let Some(Viewpoints { positions, of }) = &self.viewpoints {
            let positions: Vec<f64> = positions.iter().flat_map(|p| p.to_array()).collect();
            cloud = cloud.with_viewpoints(&positions, of.as_deref())?;
        }
        if let Some(up) = self.up {
            cloud = cloud.with_up(up)?;
        }
        cloud.origin = self.origin;
        cloud.unit = self.unit;
        cloud.crs = self.crs.clone();
        // Points of faces are no measurements, and the results say so.
        cloud.faces = if self.sampling.points > 0 {
            self.faces
        } else {
            0
        };
        Ok(cloud.with_seen_from_above(self.seen_from_above))
    }

    /// Checks that every array has one entry a point.
    fn check_lengths(&self) -> Result<()> {
        let points = self.points();
        let arrays = [
            ("positions", Some(self.positions.len()), 3),
            ("colors", self.colors.as_ref().map(Vec::len), 3),
            ("normals", self.normals.as_ref().map(Vec::len), 3),
        ];
        let attributes = self
            .attributes
            .iter()
            .map(|attribute| (attribute.name.as_str(), Some(attribute.values.len()), 1));
        for (array, found, each) in arrays.into_iter().chain(attributes) {
            let expected = points * each;
            match found {
                Some(found) if found != expected => {
                    return Err(Error::BadLength {
                        array: array.into(),
                        expected: format!("{expected} ({each} a point)"),
                        found,
                    });
                }
                _ => {}
            }
        }
        Ok(())
    }
}

/// Reads a file that is wholly in memory; of a file with faces its vertices.
///
/// # Errors
/// [`Error::BadFile`] with the line or byte, [`Error::UnsupportedFile`].
pub fn read(bytes: &[u8], format: Format) -> Result<RawCloud> {
    let options = ReadOptions {
        faces: FaceMode::Vertices,
        ..ReadOptions::default()
    };
    read_with(bytes, format, &options)
}

/// [`read`], with what the caller says of the file; of a file with faces points are taken from them unless told otherwise.
///
/// # Errors
/// Those of [`read`], and [`Error::BadOption`].
pub fn read_with(bytes: &[u8], format: Format, options: &ReadOptions) -> Result<RawCloud> {
    read_beside(bytes, format, options, &mut |_| None)
}

/// [`read_with`], where `beside` gives the content of files that faces name: of an OBJ file its material library and pictures.
///
/// # Errors
/// The same.
pub fn read_beside(
    bytes: &[u8],
    format: Format,
    options: &ReadOptions,
    beside: &mut dyn FnMut(&str) -> Option<Vec<u8>>,
) -> Result<RawCloud> {
    Reading::new(Some(format), None, bytes.len() as u64)
        .with_options(options.clone())?
        .whole(bytes, beside)
}
