//! USDZ (Pixar; Apple's AR Quick Look): a stored layer as text, a mesh or points under a node that carries the origin in
//! double precision, and the pictures of a mesh beside it. y is up in metres. Colours are the primvar `displayColor`, linear as
//! USD wants them, and the material shows them, or the picture in their place; attributes are primvars of their names.

use super::glb::{bounds, check_finite, unit_normals};
use super::local::Local;
use super::pictures::expect_png;
use super::values::linear;
use super::zip::{Packing, archive};
use crate::base::error::{Error, Result};
use crate::cloud::Attribute;
use crate::formats::raw_cloud::{RawCloud, Skin};
use std::fmt::{Display, Write};

/// What the material needs to show the colours of the vertices.
const COLORED: &str = r#"        def Shader "Colors"
        {
            uniform token info:id = "UsdPrimvarReader_float3"
            string inputs:varname = "displayColor"
            float3 outputs:result
        }
"#;

/// What pictures need to know where they lie.
const PLACED: &str = r#"        def Shader "Places"
        {
            uniform token info:id = "UsdPrimvarReader_float2"
            string inputs:varname = "st"
            float2 outputs:result
        }
"#;

/// A picture of a mesh: a file of the archive, and what its values mean.
struct Picture<'a> {
    file: &'static str,
    png: &'a [u8],
    /// The shader's input that it goes to.
    input: &'static str,
    shader: &'static str,
    /// Which of its channels, and of what type they are.
    output: &'static str,
    kind: &'static str,
    meaning: &'static str,
}

impl Picture<'_> {
    fn all(skin: &Skin) -> Vec<Picture<'_>> {
        let color = skin.color.as_ref().map(|png| Picture {
            file: "color.png",
            png,
            input: "color3f inputs:diffuseColor",
            shader: "ColorPicture",
            output: "rgb",
            kind: "float3",
            meaning: "token inputs:sourceColorSpace = \"sRGB\"",
        });
        let normal = skin.normal.as_ref().map(|png| Picture {
            file: "normal.png",
            png,
            input: "normal3f inputs:normal",
            shader: "NormalPicture",
            output: "rgb",
            kind: "float3",
            // Bytes stand for -1 to 1.
            meaning: "token inputs:sourceColorSpace = \"raw\"\n            float4 inputs:scale = (2, 2, 2, 1)\n            \
                      float4 inputs:bias = (-1, -1, -1, 0)",
        });
        let occlusion = skin.occlusion.as_ref().map(|png| Picture {
            file: "occlusion.png",
            png,
            input: "float inputs:occlusion",
            shader: "OcclusionPicture",
            output: "r",
            kind: "float",
            meaning: "token inputs:sourceColorSpace = \"raw\"",
        });
        color.into_iter().chain(normal).chain(occlusion).collect()
    }

    fn connection(&self) -> String {
        let Picture {
            input,
            shader,
            output,
            ..
        } = self;
        format!("            {input}.connect = </Scan/Material/{shader}.outputs:{output}>\n")
    }

    fn texture(&self) -> String {
        let Picture {
            file,
            shader,
            output,
            kind,
            meaning,
            ..
        } = self;
        format!(
            r#"        def Shader "{shader}"
        {{
            uniform token info:id = "UsdUVTexture"
            asset inputs:file = @{file}@
            float2 inputs:st.connect = </Scan/Material/Places.outputs:result>
            token inputs:wrapS = "clamp"
            token inputs:wrapT = "clamp"
            {meaning}
            {kind} outputs:{output}
        }}
"#
        )
    }
}

/// Writes points and, with `triangles`, a mesh.
///
/// # Errors
/// [`Error::EmptyCloud`]; [`Error::NonFinite`]; [`Error::BadOption`] for pictures that are no PNG files.
pub(super) fn write(cloud: &RawCloud, triangles: Option<&[u32]>) -> Result<Vec<u8>> {
    if cloud.points() == 0 {
        return Err(Error::EmptyCloud);
    }
    let Local { origin, positions } = Local::of(cloud)?;
    let triangles = triangles.filter(|indices| !indices.is_empty());
    let mut layer = format!(
        "#usda 1.0\n(\n    defaultPrim = \"Scan\"\n    doc = \"Pointweave {}\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\n\
         def Xform \"Scan\" (\n    kind = \"component\"\n)\n{{\n",
        env!("CARGO_PKG_VERSION")
    );
    // Writing to a string cannot fail.
    if let Some([x, y, z]) = origin {
        let _ = write!(
            layer,
            "    double3 xformOp:translate = ({x}, {y}, {z})\n    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n"
        );
    }
    let kind = match triangles {
        Some(_) => "Mesh \"Surface\"",
        None => "Points \"Points\"",
    };
    let _ = write!(
        layer,
        "    def {kind} (\n        prepend apiSchemas = [\"MaterialBindingAPI\"]\n    )\n    {{\n"
    );
    let corners = bounds(&positions).map(|corner| triple(&corner));
    array(&mut layer, "float3[] extent", ONCE, corners);
    array(&mut layer, "point3f[] points", ONCE, triples(&positions));
    if let Some(indices) = triangles {
        layer += "        uniform bool doubleSided = 1\n        uniform token subdivisionScheme = \"none\"\n";
        let counts = std::iter::repeat_n(3, indices.len() / 3);
        array(&mut layer, "int[] faceVertexCounts", ONCE, counts);
        array(&mut layer, "int[] faceVertexIndices", ONCE, indices);
    }
    if let Some(normals) = unit_normals(cloud)? {
        array(
            &mut layer,
            "normal3f[] normals",
            A_VERTEX,
            triples(&normals),
        );
    }
    let skin = cloud.skin().filter(|_| triangles.is_some());
    let pictures = skin.map(Picture::all).unwrap_or_default();
    if let Some(skin) = skin {
        let Skin { uvs, .. } = skin;
        check_finite("uvs", uvs, 2)?;
        expect_png(skin)?;
        // From the bottom up, as USD has it.
        let places = uvs.chunks_exact(2);
        let places = places.map(|uv| format!("({}, {})", uv[0], 1.0 - uv[1]));
        array(&mut layer, "texCoord2f[] primvars:st", A_VERTEX, places);
    }
    let pictured = skin.is_some_and(|skin| skin.color.is_some());
    let colors = cloud.colors.as_ref().filter(|_| !pictured);
    if let Some(colors) = colors {
        let linear: Vec<f32> = (0..=u8::MAX).map(|c| linear(c) as f32).collect();
        let values: Vec<f32> = colors.iter().map(|&c| linear[usize::from(c)]).collect();
        let name = "color3f[] primvars:displayColor";
        array(&mut layer, name, A_VERTEX, triples(&values));
    }
    for (name, attribute) in names(&cloud.attributes).iter().zip(&cloud.attributes) {
        check_finite(&attribute.name, &attribute.values, 1)?;
        let name = format!("float[] primvars:{name}");
        array(&mut layer, &name, A_VERTEX, &attribute.values);
    }
    layer += "        rel material:binding = </Scan/Material>\n    }\n\n    def Material \"Material\"\n    {\n        \
              token outputs:surface.connect = </Scan/Material/Surface.outputs:surface>\n\n        \
              def Shader \"Surface\"\n        {\n            uniform token info:id = \"UsdPreviewSurface\"\n            \
              float inputs:metallic = 0\n            float inputs:roughness = 0.9\n";
    if colors.is_some() {
        layer += "            color3f inputs:diffuseColor.connect = </Scan/Material/Colors.outputs:result>\n";
    }
    for picture in &pictures {
        layer += &picture.connection();
    }
    layer += "            token outputs:surface\n        }\n";
    if colors.is_some() {
        layer += COLORED;
    }
    if !pictures.is_empty() {
        layer += PLACED;
    }
    for picture in &pictures {
        layer += &picture.texture();
    }
    layer += "    }\n}\n";
    // The layer comes first: it is what the archive shows.
    let mut files = vec![("scan.usda", layer.as_bytes())];
    files.extend(pictures.iter().map(|picture| (picture.file, picture.png)));
    Ok(archive(&files, Packing::StoredAt64))
}

/// What is said of an array: that it has a value a vertex, or nothing.
const A_VERTEX: &str = " (interpolation = \"vertex\")";
const ONCE: &str = "";

/// The line `TYPE NAME = [a, b, c]`.
fn array<T: Display>(
    layer: &mut String,
    name: &str,
    meaning: &str,
    values: impl IntoIterator<Item = T>,
) {
    let _ = write!(layer, "        {name} = [");
    for (i, value) in values.into_iter().enumerate() {
        let _ = write!(layer, "{}{value}", if i == 0 { "" } else { ", " });
    }
    let _ = writeln!(layer, "]{meaning}");
}

fn triples(values: &[f32]) -> impl Iterator<Item = String> {
    values.chunks_exact(3).map(triple)
}

fn triple(values: &[f32]) -> String {
    format!("({}, {}, {})", values[0], values[1], values[2])
}

/// A name for each attribute that USD takes: letters, digits and underscores; no name twice, and none that USD has itself.
fn names(attributes: &[Attribute]) -> Vec<String> {
    let mut names: Vec<String> = ["displayColor", "displayOpacity", "st"]
        .map(String::from)
        .into();
    let own = names.len();
    for Attribute { name, .. } in attributes {
        let known = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        let mut word: String = name.chars().map(known).collect();
        if !word.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
            word.insert(0, '_');
        }
        while names.contains(&word) {
            word.push('_');
        }
        names.push(word);
    }
    names.split_off(own)
}
