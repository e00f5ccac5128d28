//! Detects the format of a file: by its first bytes, else by its name.

use super::format::Format;
#[cfg(feature = "files")]
use super::text::MARK;
use super::text::quote;
#[cfg(feature = "files")]
use super::{grid, obj, off, pcd, ply, ptx, stl, xyz};
use crate::base::error::{Error, Result};

/// The format of a file: by its content where that tells, else by its name.
///
/// # Errors
/// [`Error::UnknownFormat`], which says what the content looks like.
pub fn detect(bytes: &[u8], name: Option<&str>) -> Result<Format> {
    detect_head(bytes, bytes.len() as u64, name)
}

/// [`detect`] from the first bytes of `size`.
pub(super) fn detect_head(head: &[u8], size: u64, name: Option<&str>) -> Result<Format> {
    const MAGIC: [(&[u8], Format); 8] = [
        (b"LASF", Format::Las),
        (b"ASTM-E57", Format::E57),
        (b"glTF", Format::Glb),
        (b"NGSP", Format::Spz),
        (b"II*\x00", Format::Tiff),
        (b"MM\x00*", Format::Tiff),
        (b"II+\x00", Format::Tiff),
        (b"MM\x00+", Format::Tiff),
    ];
    if let Some((_, format)) = MAGIC.iter().find(|(start, _)| head.starts_with(start)) {
        return Ok(*format);
    }
    let named = name.and_then(Format::from_name);
    match (head, named) {
        ([0x1f, 0x8b, ..], Some(Format::Spz)) => return Ok(Format::Spz),
        ([b'P', b'K', 3, 4, ..], _) if named == Some(Format::ThreeMf) || is_model(head) => {
            return Ok(Format::ThreeMf);
        }
        _ => {}
    }
    if let Some(other) = known_but_not_read(head) {
        return Err(unknown(other));
    }
    // Nothing in it says what it is, and text is none.
    if named == Some(Format::Splat) && size > 0 && size.is_multiple_of(32) {
        return Ok(Format::Splat);
    }
    if let Some(format) = by_look(head, size) {
        return Ok(format);
    }
    // A format with a signature is never one by its name alone.
    let signed = |format: &Format| {
        let archives = [Format::ThreeMf, Format::Splat];
        archives.contains(format) || MAGIC.iter().any(|(_, signed)| signed == format)
    };
    let by_name = named.filter(|format| !signed(format));
    by_name.ok_or_else(|| {
        let found = match head {
            [] => "no content".into(),
            _ => format!(
                "content that starts with {}",
                quote(&head[..head.len().min(16)])
            ),
        };
        match named {
            Some(format) => unknown(&format!("{found}, which no {} file does", format.title())),
            None => unknown(&found),
        }
    })
}

/// The format of a file without a signature, by what its first lines say or by its size.
#[cfg(feature = "files")]
fn by_look(head: &[u8], size: u64) -> Option<Format> {
    let head = head.strip_prefix(MARK).unwrap_or(head);
    type Look = fn(&[u8], u64) -> bool;
    let looks: [(Look, Format); 8] = [
        (|head, _| ply::looks_like(head), Format::Ply),
        (|head, _| pcd::looks_like(head), Format::Pcd),
        (stl::looks_like, Format::Stl),
        (|head, _| off::looks_like(head), Format::Off),
        (|head, _| obj::looks_like(head), Format::Obj),
        (|head, _| ptx::looks_like(head), Format::Ptx),
        (|head, _| grid::looks_like(head), Format::Grid),
        (|head, _| xyz::looks_like(head), Format::Xyz),
    ];
    let found = looks.iter().find(|(look, _)| look(head, size));
    found.map(|(_, format)| *format)
}

#[cfg(not(feature = "files"))]
fn by_look(_: &[u8], _: u64) -> Option<Format> {
    None
}

/// Whether a ZIP archive starts as 3MF files do.
fn is_model(head: &[u8]) -> bool {
    has(head, b"3D/3dmodel.model") || has(head, b"3D/_rels/3dmodel.model.rels")
}

/// The name of a format that is recognised by its first bytes but has no reader here.
fn known_but_not_read(head: &[u8]) -> Option<&'static str> {
    const SIGNATURES: [(&[u8], &str); 40] = [
        (b"\xff\xfe", "UTF-16 text"),
        (b"\xfe\xff", "UTF-16 text"),
        (b"PK\x03\x04", "a ZIP archive"),
        (b"PK\x05\x06", "an empty ZIP archive"),
        (b"\x1f\x8b", "a gzip archive"),
        (b"7z\xbc\xaf", "a 7z archive"),
        (b"Rar!", "a RAR archive"),
        (b"BZh", "a bzip2 archive"),
        (b"\xfd7zXZ", "an xz archive"),
        (b"\x28\xb5\x2f\xfd", "a Zstandard archive"),
        (
            b"version https://git-lfs",
            "a Git LFS pointer, not the file itself",
        ),
        (b"<", "an XML or HTML document"),
        (b"{", "a JSON document"),
        (b"%PDF", "a PDF document"),
        (b"\x89PNG", "a PNG picture"),
        (b"\xff\xd8\xff", "a JPEG picture"),
        (b"GIF8", "a GIF picture"),
        (b"RIFF", "a RIFF file (WebP, WAV or AVI)"),
        (b"# vtk DataFile", "a VTK file"),
        (b"DRACO", "a Draco mesh"),
        (b"Kaydara FBX", "an FBX scene"),
        (b"BLENDER", "a Blender scene"),
        (b"#usda", "a USD scene"),
        (b"PXR-USDC", "a USD scene"),
        (b"ISO-10303-21", "a STEP model"),
        (b"#VRML", "a VRML scene"),
        (b"AC10", "a DWG drawing"),
        (b"\x89HDF", "an HDF5 file"),
        (b"CDF\x01", "a NetCDF file"),
        (b"#ROSBAG", "a ROS bag"),
        (b"CCB2", "a project of CloudCompare (.bin)"),
        (b"\x93NUMPY", "an array of NumPy"),
        (b"\x89MCAP", "a recording of ROS (MCAP)"),
        (b"MATLAB 5.0", "data of MATLAB"),
        (b"SQLite format 3", "a database"),
        (b"NVM_V3", "a reconstruction of VisualSFM"),
        (b"# Bundle file", "a reconstruction of Bundler"),
        (b"\xd4\xc3\xb2\xa1", "a capture of packets (PCAP)"),
        (b"DSBB", "a Surfer grid in binary, not as text"),
        (b"DSRB", "a Surfer grid in binary, not as text"),
    ];
    let known = SIGNATURES
        .iter()
        .find(|(start, _)| head.starts_with(start))
        .map(|(_, name)| *name);
    if head.get(257..262) == Some(b"ustar") {
        return Some("a tar archive");
    }
    // The first group and its code, each in a line.
    let mut lines = head.split(|&b| b == b'\n').map(<[u8]>::trim_ascii);
    if (lines.next(), lines.next()) == (Some(b"0"), Some(b"SECTION")) {
        return Some("a DXF drawing");
    }
    match known {
        Some("an XML or HTML document") => kind_of(head, &XML_KINDS).or(known),
        Some("a JSON document") => kind_of(head, &JSON_KINDS).or(known),
        known => known,
    }
}

/// What a JSON document says it is; much has assets.
const JSON_KINDS: [(&[u8], &str); 3] = [
    (b"\"FeatureCollection\"", "a GeoJSON document"),
    (b"\"CityJSON\"", "a CityJSON model"),
    (b"\"asset\"", "a glTF scene as text (.gltf), not as GLB"),
];

/// What an XML document says it is.
const XML_KINDS: [(&[u8], &str); 5] = [
    (b"<VTKFile", "a VTK file in XML"),
    (b"<COLLADA", "a COLLADA scene"),
    (b"<X3D", "an X3D scene"),
    (b"<kml", "a KML document"),
    (b"<LandXML", "a LandXML survey"),
];

/// The first of the kinds whose mark stands near the start.
fn kind_of(head: &[u8], kinds: &[(&[u8], &'static str)]) -> Option<&'static str> {
    let head = &head[..head.len().min(4096)];
    let found = kinds.iter().find(|(mark, _)| has(head, mark));
    found.map(|(_, name)| *name)
}

fn has(head: &[u8], name: &[u8]) -> bool {
    head.windows(name.len()).any(|window| window == name)
}

fn unknown(found: &str) -> Error {
    Error::UnknownFormat {
        expected: "PLY, PCD, LAS, LAZ, E57, PTX, OBJ, OFF, STL, GLB, 3MF, a grid (.asc, GeoTIFF), splats, or rows of numbers as text (XYZ, TXT, PTS, CSV)".into(),
        found: found.into(),
    }
}
