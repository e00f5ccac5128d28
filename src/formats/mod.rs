//! Files: bytes to arrays, one file a format, and back, in `write`; what readers share is here, in `lines` and in `table`.
//!
//! Bytes come from strangers. A reader returns a right result or a typed error that names the line or byte, never
//! panics, and never reserves memory on the word of a header: only what the bytes that are really there can fill.

mod lines;
mod ply;
mod table;
mod write;
mod xyz;

use crate::cloud::{Attribute, Cloud};
use crate::error::{Error, Result};
use crate::pipeline::Surface;

pub use write::{Output, WriteOptions, write};

/// A file format that is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// PLY, the Stanford polygon format: ascii, binary little endian, binary big endian.
    Ply,
    /// Rows of numbers as text: XYZ, TXT, PTS, CSV, ASC.
    Xyz,
}

impl Format {
    /// All formats.
    pub const ALL: [Format; 2] = [Format::Ply, Format::Xyz];

    /// Lower-case name, as `format` in the JS interface: `ply`, `xyz`.
    pub fn name(self) -> &'static str {
        match self {
            Format::Ply => "ply",
            Format::Xyz => "xyz",
        }
    }

    /// File name extensions, lower case, without the dot.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Format::Ply => &["ply"],
            Format::Xyz => &["xyz", "txt", "pts", "csv", "asc", "xyzn", "xyzrgb"],
        }
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
    /// Rows left out because a coordinate was NaN or infinite.
    pub dropped: usize,
    /// Values of colours, normals and attributes that were not finite and are now 0.
    pub replaced: usize,
    /// Faces that the file says it has; they are not read.
    pub faces: u64,
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
            dropped: 0,
            replaced: 0,
            faces: 0,
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
            ..RawCloud::new(Positions::F64(cloud.positions_f64()))
        }
    }

    /// The vertices of a mesh, in double precision; its triangles are [`Surface::indices`].
    pub fn of_surface(surface: &Surface) -> RawCloud {
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
            origin: surface.cloud.reduced.cloud.origin,
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
    /// [`Error::EmptyCloud`]; [`Error::BadLength`] and [`Error::NonFinite`] for arrays that no reader made.
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
        cloud.origin = self.origin;
        Ok(cloud)
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

/// The format of a file: by its content where that tells, else by its name.
///
/// # Errors
/// [`Error::UnknownFormat`], which says what the content looks like.
pub fn detect(bytes: &[u8], name: Option<&str>) -> Result<Format> {
    if ply::looks_like(bytes) {
        return Ok(Format::Ply);
    }
    if let Some(other) = known_but_not_read(bytes) {
        return Err(unknown(other));
    }
    if xyz::looks_like(bytes) {
        return Ok(Format::Xyz);
    }
    name.and_then(Format::from_name).ok_or_else(|| {
        let start = lines::quote(&bytes[..bytes.len().min(16)]);
        unknown(&format!("content that starts with {start}"))
    })
}

/// Reads a file that is wholly in memory.
///
/// # Errors
/// [`Error::BadFile`] with the line or byte, [`Error::UnsupportedFile`].
pub fn read(bytes: &[u8], format: Format) -> Result<RawCloud> {
    match format {
        Format::Ply => ply::read(bytes),
        Format::Xyz => xyz::read(bytes),
    }
}

/// The name of a format that is recognised by its first bytes but has no reader here.
fn known_but_not_read(bytes: &[u8]) -> Option<&'static str> {
    const SIGNATURES: [(&[u8], &str); 13] = [
        (b"LASF", "a LAS or LAZ file"),
        (b"# .PCD", "a PCD file"),
        (b"VERSION .7", "a PCD file"),
        (b"VERSION 0.7", "a PCD file"),
        (b"ASTM-E57", "an E57 file"),
        (b"glTF", "a binary glTF file"),
        (b"solid", "an STL file"),
        (b"OFF", "an OFF file"),
        (b"COFF", "an OFF file"),
        (b"PK\x03\x04", "a ZIP archive"),
        (b"\x1f\x8b", "a gzip archive"),
        (
            b"version https://git-lfs",
            "a Git LFS pointer, not the file itself",
        ),
        (b"<", "an XML or HTML document"),
    ];
    SIGNATURES
        .iter()
        .find(|(start, _)| bytes.starts_with(start))
        .map(|(_, name)| *name)
}

fn unknown(found: &str) -> Error {
    Error::UnknownFormat {
        expected: "PLY, or rows of numbers as text (XYZ, TXT, PTS, CSV)".into(),
        found: found.into(),
    }
}
