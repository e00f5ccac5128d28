//! The file formats that are read.

use crate::cloud::Unit;

/// A file format that is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// PLY, the Stanford polygon format: ascii, binary little endian, binary big endian.
    Ply,
    /// Rows of numbers as text: XYZ, TXT, PTS, CSV, ASC.
    Xyz,
    /// PCD, the Point Cloud Library's: ascii, binary, compressed.
    Pcd,
    /// Wavefront OBJ: its faces, or its vertices.
    Obj,
    /// OFF, the object file format of Geomview: its faces, or its vertices.
    Off,
    /// STL, ascii and binary: its triangles, or its vertices, each once.
    Stl,
    /// Binary glTF: the triangles, or the vertices, of its scene.
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
    /// 3MF: its triangles, or its vertices.
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
    /// Those that are written, too, and read back to the same bits; [`super::Output`] has all that are written.
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

    /// Whether its clouds are airborne scans or grids of heights: z is up, and all was seen from above.
    pub fn is_airborne(self) -> bool {
        matches!(self, Format::Las | Format::Grid | Format::Tiff)
    }

    /// Which way is up, where the format says it.
    pub fn up(self) -> Option<[f64; 3]> {
        match self {
            Format::Las
            | Format::E57
            | Format::Ptx
            | Format::Grid
            | Format::Tiff
            | Format::ThreeMf => Some([0.0, 0.0, 1.0]),
            Format::Glb => Some([0.0, 1.0, 0.0]),
            _ => None,
        }
    }

    /// What a coordinate is, where the format says it; of LAS and LAZ the file may.
    pub fn unit(self) -> Option<Unit> {
        matches!(self, Format::E57 | Format::Glb).then_some(Unit::Metre)
    }

    /// Whether it starts with text, before which editors put a byte order mark.
    pub(super) fn is_text(self) -> bool {
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
