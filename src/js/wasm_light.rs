//! Meshes with fewer triangles, and with pictures, and posters, from JavaScript.

use crate::base::error::Error;
use crate::cloud::{Attribute, Cloud};
use crate::formats::Positions;
use crate::js::clouds::{PointCloud, Precision, triple};
use crate::js::progress::JsProgress;
use crate::js::values::to_js;
use crate::js::{JsResult, object, optional};
use crate::light::{Painted, SimplifyParams};
use crate::pipeline;
use crate::poster::{Pixels, PosterParams, Reach, Scene, View};
use crate::texture::{Map, Paint, Texture, TextureParams};
use js_sys::{
    Array, Float32Array, Float64Array, Function, Object, Reflect, Uint8Array, Uint32Array,
};
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// `{ triangles, error }`; `pkg/engine/options.js` has checked their types.
    pub type SimplifySettings;
    #[wasm_bindgen(method, getter)]
    fn triangles(this: &SimplifySettings) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn error(this: &SimplifySettings) -> Option<f64>;
}

/// [`pipeline::simplify`] of a mesh: `{ positions, normals, indices, colors, attributes, report }`.
#[wasm_bindgen]
pub fn simplify(mesh: &PointCloud, settings: &SimplifySettings, progress: Function) -> JsResult {
    let params = SimplifyParams {
        triangles: settings.triangles().map(|n| n as usize),
        error: settings.error(),
    };
    let indices = mesh.indices().ok_or(Error::NeedsTriangles)?.to_vec();
    let (cloud, precision) = mesh.to_cloud()?;
    let mut progress = JsProgress(progress);
    let (light, report) = pipeline::simplify(&cloud, &indices, &params, &mut progress)?;
    let result = painted_to_js(&light, &cloud, precision)?;
    Reflect::set(&result, &"report".into(), &to_js(&report)?)?;
    Ok(result)
}

#[wasm_bindgen]
extern "C" {
    /// `{ triangles, size, maps, ramp }`; `pkg/engine/options.js` has checked their types.
    pub type TextureSettings;
    #[wasm_bindgen(method, getter, js_name = triangles)]
    fn most(this: &TextureSettings) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn size(this: &TextureSettings) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn maps(this: &TextureSettings) -> Option<Array>;
    /// Colours of the values that are the scan's attribute, three bytes each.
    #[wasm_bindgen(method, getter)]
    fn ramp(this: &TextureSettings) -> Option<Uint8Array>;
}

/// [`pipeline::texture`] of a mesh and the scan's positions, and its colours or its attribute: what [`simplify`] gives, and `{ uvs, tangents, textures }`.
#[wasm_bindgen]
pub fn texture(
    mesh: &PointCloud,
    scan: &PointCloud,
    settings: &TextureSettings,
    progress: Function,
) -> JsResult {
    let maps = settings.maps().map(|names| {
        let named = |name: JsValue| match name.as_string().as_deref() {
            Some("normal") => Map::Normal,
            Some("occlusion") => Map::Occlusion,
            _ => Map::Color,
        };
        names.iter().map(named).collect()
    });
    let params = TextureParams {
        size: settings.size().map(|size| size as usize),
        maps: maps.unwrap_or(TextureParams::default().maps),
    };
    let triangles = settings.most().map(|n| n as usize);
    let indices = mesh.indices().ok_or(Error::NeedsTriangles)?.to_vec();
    let (cloud, precision) = mesh.to_cloud()?;
    let scan = scan.read()?;
    let points = match scan.positions {
        Positions::F32(values) => values.into_iter().map(f64::from).collect(),
        Positions::F64(values) => values,
    };
    let ramp = settings.ramp().map(|ramp| ramp.to_vec());
    let paint = match (&ramp, &scan.attributes[..], &scan.colors) {
        (Some(ramp), [attribute], _) => Paint::Scalars {
            values: &attribute.values,
            ramp: ramp.as_chunks().0,
        },
        (_, _, Some(colors)) => Paint::Colors(colors.as_chunks().0),
        _ => Paint::Nothing,
    };
    let mut progress = JsProgress(progress);
    let (textured, report) = pipeline::texture(
        (&cloud, &indices),
        (&points, paint),
        triangles,
        &params,
        &mut progress,
    )?;
    let result = painted_to_js(&textured.painted, &cloud, precision)?;
    let textures = Object::new();
    for Texture {
        map,
        width,
        height,
        png,
    } in &textured.textures
    {
        let name = match map {
            Map::Color => "color",
            Map::Normal => "normal",
            Map::Occlusion => "occlusion",
        };
        let texture = object([
            ("width", (*width as f64).into()),
            ("height", (*height as f64).into()),
            ("type", "image/png".into()),
            ("data", Uint8Array::from(&png[..]).into()),
        ])?;
        Reflect::set(&textures, &name.into(), &texture)?;
    }
    let set = |name: &str, value: JsValue| Reflect::set(&result, &name.into(), &value);
    set(
        "uvs",
        Float32Array::from(textured.uvs.as_flattened()).into(),
    )?;
    set(
        "tangents",
        Float32Array::from(textured.tangents.as_flattened()).into(),
    )?;
    set("textures", textures.into())?;
    if let Some(report) = &report {
        set("report", to_js(report)?)?;
    }
    Ok(result)
}

#[wasm_bindgen]
extern "C" {
    /// `{ width, height, azimuth, polar, share, length, up, background }`; `pkg/engine/posing.js` has made them.
    pub type PosterSettings;
    #[wasm_bindgen(method, getter)]
    fn width(this: &PosterSettings) -> f64;
    #[wasm_bindgen(method, getter)]
    fn height(this: &PosterSettings) -> f64;
    #[wasm_bindgen(method, getter)]
    fn azimuth(this: &PosterSettings) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn polar(this: &PosterSettings) -> Option<f64>;
    /// Of the distance from which everything is seen.
    #[wasm_bindgen(method, getter)]
    fn share(this: &PosterSettings) -> Option<f64>;
    /// In the caller's unit.
    #[wasm_bindgen(method, getter)]
    fn length(this: &PosterSettings) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn up(this: &PosterSettings) -> Array;
    #[wasm_bindgen(method, getter)]
    fn background(this: &PosterSettings) -> Option<Array>;
}

/// [`crate::poster::poster`] of a cloud or a mesh: a PNG file's bytes.
#[wasm_bindgen]
pub fn poster(what: &PointCloud, settings: &PosterSettings, progress: Function) -> JsResult {
    let (cloud, _) = what.to_cloud()?;
    let indices = what.indices().map(|indices| indices.to_vec());
    let uvs = what.uvs().map(|uvs| uvs.to_vec());
    let tangents = what.tangents().map(|tangents| tangents.to_vec());
    let pictures = [
        what.color_pixels(),
        what.normal_pixels(),
        what.occlusion_pixels(),
    ];
    let pictures = pictures.map(|decoded| {
        decoded.map(|decoded| (decoded.width() as usize, decoded.pixels().to_vec()))
    });
    let [color, normal, occlusion] = pictures.each_ref().map(|picture| {
        let picture = picture.as_ref();
        picture.map(|(width, rgba)| Pixels {
            width: *width,
            rgba,
        })
    });
    let scene = Scene {
        points: &cloud.points,
        triangles: indices.as_deref().map(|corners| corners.as_chunks().0),
        normals: cloud.normals.as_deref(),
        colors: cloud.colors.as_deref(),
        uvs: uvs.as_deref().map(|uvs| uvs.as_chunks().0),
        tangents: tangents.as_deref().map(|tangents| tangents.as_chunks().0),
        color,
        normal,
        occlusion,
    };
    let params = PosterParams {
        size: [settings.width(), settings.height()].map(|n| n as usize),
        view: View {
            azimuth: settings.azimuth(),
            polar: settings.polar(),
            reach: match settings.length() {
                Some(length) => Reach::Length(length / cloud.frame.diagonal),
                None => Reach::Share(settings.share().unwrap_or(1.0)),
            },
        },
        up: triple(settings.up()).into(),
        background: settings
            .background()
            .map(|color| triple(color).map(|c| c as u8)),
    };
    let png = crate::poster::poster(&scene, &params, &mut JsProgress(progress))?;
    Ok(Uint8Array::from(&png[..]).into())
}

/// A mesh with positions of the type and frame of the caller's.
fn painted_to_js(painted: &Painted, cloud: &Cloud, precision: Precision) -> JsResult {
    let Painted {
        mesh,
        colors,
        attributes,
    } = painted;
    let coordinates = mesh.vertices.iter().flat_map(|&p| cloud.frame.to_caller(p));
    let positions: JsValue = match precision {
        Precision::Single => {
            let values: Vec<f32> = coordinates.map(|x| x as f32).collect();
            Float32Array::from(&values[..]).into()
        }
        Precision::Double => Float64Array::from(&coordinates.collect::<Vec<_>>()[..]).into(),
    };
    let normals: Vec<f32> = mesh.normals.iter().flat_map(|n| n.to_array()).collect();
    let normals = (!normals.is_empty()).then_some(normals);
    let table = Object::new();
    for Attribute { name, values } in attributes {
        Reflect::set(&table, &name.into(), &Float32Array::from(&values[..]))?;
    }
    let indices = Uint32Array::from(mesh.triangles.as_flattened());
    object([
        ("positions", positions),
        (
            "normals",
            optional(&normals, |n| Float32Array::from(&n[..])),
        ),
        ("indices", indices.into()),
        (
            "colors",
            optional(colors, |colors| Uint8Array::from(colors.as_flattened())),
        ),
        (
            "attributes",
            if attributes.is_empty() {
                JsValue::UNDEFINED
            } else {
                table.into()
            },
        ),
    ])
}
