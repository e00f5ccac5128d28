//! 3MF (3MF Consortium, core 1.3 with materials 1.2): one mesh, its colours by corner, and the origin as the transform of its
//! item, in double precision. Points alone have no place in it.

use super::local::Local;
use super::zip::{Packing, archive};
use crate::base::error::{Error, Result};
use crate::cloud::Unit;
use crate::formats::raw_cloud::RawCloud;
use std::fmt::Write;

const TYPES: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">\
<Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>\
<Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>";

const RELATIONS: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\
<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";

/// Writes the triangles, in the cloud's unit; a cloud without one is in the format's, millimetres.
///
/// # Errors
/// [`Error::NonFinite`]; [`Error::BadOption`] for degrees, which are no unit of a body.
pub(super) fn write(cloud: &RawCloud, triangles: &[u32]) -> Result<Vec<u8>> {
    let Local { origin, positions } = Local::of(cloud)?;
    let unit = match cloud.unit {
        None | Some(Unit::Millimetre) => "millimeter",
        Some(Unit::Centimetre) => "centimeter",
        Some(Unit::Metre) => "meter",
        Some(Unit::Inch) => "inch",
        Some(Unit::Foot) => "foot",
        Some(other @ (Unit::SurveyFoot | Unit::Degree)) => {
            return Err(Error::BadOption {
                option: "unit".into(),
                expected: "mm, cm, m, in or ft, which 3MF knows".into(),
                found: other.name().into(),
            });
        }
    };
    let palette = cloud.colors.as_deref().map(Palette::of);
    let mut model = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"{unit}\" xml:lang=\"en-US\" \
         xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" \
         xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\">\n\
         <metadata name=\"Application\">Pointweave {}</metadata>\n<resources>\n",
        env!("CARGO_PKG_VERSION")
    );
    // Writing to a string cannot fail.
    if let Some(palette) = &palette {
        model += "<m:colorgroup id=\"1\">";
        for [r, g, b] in &palette.colors {
            let _ = write!(model, "<m:color color=\"#{r:02X}{g:02X}{b:02X}\"/>");
        }
        model += "</m:colorgroup>\n";
    }
    model += "<object id=\"2\" type=\"model\"><mesh>\n<vertices>\n";
    for p in positions.chunks_exact(3) {
        let _ = writeln!(
            model,
            "<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>",
            p[0], p[1], p[2]
        );
    }
    model += "</vertices>\n<triangles>\n";
    for t in triangles.chunks_exact(3) {
        let _ = write!(
            model,
            "<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"",
            t[0], t[1], t[2]
        );
        if let Some(palette) = &palette {
            let [a, b, c] = [t[0], t[1], t[2]].map(|corner| palette.of[corner as usize]);
            let _ = write!(model, " pid=\"1\" p1=\"{a}\" p2=\"{b}\" p3=\"{c}\"");
        }
        model += "/>\n";
    }
    model += "</triangles>\n</mesh></object>\n</resources>\n<build><item objectid=\"2\"";
    if let Some([x, y, z]) = origin {
        let _ = write!(model, " transform=\"1 0 0 0 1 0 0 0 1 {x} {y} {z}\"");
    }
    model += "/></build>\n</model>\n";
    let files: [(&str, &[u8]); 3] = [
        ("[Content_Types].xml", TYPES.as_bytes()),
        ("_rels/.rels", RELATIONS.as_bytes()),
        ("3D/3dmodel.model", model.as_bytes()),
    ];
    Ok(archive(&files, Packing::Deflated))
}

/// The different colours, in order, and which each vertex has.
struct Palette {
    colors: Vec<[u8; 3]>,
    of: Vec<u32>,
}

impl Palette {
    fn of(bytes: &[u8]) -> Palette {
        let (each, _) = bytes.as_chunks::<3>();
        let mut colors = each.to_vec();
        colors.sort_unstable();
        colors.dedup();
        let place = |color: &[u8; 3]| colors.partition_point(|other| other < color) as u32;
        let of = each.iter().map(place).collect();
        Palette { colors, of }
    }
}
