//! Clouds and meshes of the caller's.

use crate::base::error::Error;
use crate::cloud::{Attribute, Cloud, Floor, Unit};
use crate::formats::{Positions, RawCloud};
use crate::js::crs::PointCrs;
use crate::js::viewpoints::PointViews;
use crate::js::{JsResult, object};
use js_sys::{Array, Float32Array, Float64Array, Object, Uint8Array, Uint32Array};
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// A cloud or mesh of the caller's, its arrays in memory of their own; `pkg/engine/clouds.js` has checked their types.
    pub type PointCloud;
    #[wasm_bindgen(method, getter)]
    fn positions(this: &PointCloud) -> JsValue;
    #[wasm_bindgen(method, getter)]
    fn colors(this: &PointCloud) -> Option<Uint8Array>;
    #[wasm_bindgen(method, getter)]
    fn normals(this: &PointCloud) -> Option<Float32Array>;
    #[wasm_bindgen(method, getter)]
    fn attributes(this: &PointCloud) -> Option<Object>;
    #[wasm_bindgen(method, getter)]
    fn origin(this: &PointCloud) -> Option<Array>;
    #[wasm_bindgen(method, getter)]
    fn viewpoints(this: &PointCloud) -> Option<PointViews>;
    #[wasm_bindgen(method, getter)]
    fn up(this: &PointCloud) -> Option<Array>;
    #[wasm_bindgen(method, getter, js_name = seenFromAbove)]
    fn seen_from_above(this: &PointCloud) -> Option<bool>;
    /// A point and a normal.
    #[wasm_bindgen(method, getter)]
    fn floor(this: &PointCloud) -> Option<PointFloor>;
    #[wasm_bindgen(method, getter)]
    fn unit(this: &PointCloud) -> Option<String>;
    #[wasm_bindgen(method, getter)]
    fn crs(this: &PointCloud) -> Option<PointCrs>;
    /// Faces that the points were taken from.
    #[wasm_bindgen(method, getter)]
    fn faces(this: &PointCloud) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    pub fn indices(this: &PointCloud) -> Option<Uint32Array>;
    #[cfg(any(feature = "exports", feature = "light"))]
    #[wasm_bindgen(method, getter)]
    pub fn uvs(this: &PointCloud) -> Option<Float32Array>;
    #[cfg(any(feature = "exports", feature = "light"))]
    #[wasm_bindgen(method, getter)]
    pub fn tangents(this: &PointCloud) -> Option<Float32Array>;
    /// The bytes of picture files.
    #[cfg(feature = "exports")]
    #[wasm_bindgen(method, getter, js_name = colorPicture)]
    pub fn color_picture(this: &PointCloud) -> Option<Uint8Array>;
    #[cfg(feature = "exports")]
    #[wasm_bindgen(method, getter, js_name = normalPicture)]
    pub fn normal_picture(this: &PointCloud) -> Option<Uint8Array>;
    #[cfg(feature = "exports")]
    #[wasm_bindgen(method, getter, js_name = occlusionPicture)]
    pub fn occlusion_picture(this: &PointCloud) -> Option<Uint8Array>;
    /// What is in them.
    #[cfg(feature = "light")]
    #[wasm_bindgen(method, getter, js_name = colorPixels)]
    pub fn color_pixels(this: &PointCloud) -> Option<Decoded>;
    #[cfg(feature = "light")]
    #[wasm_bindgen(method, getter, js_name = normalPixels)]
    pub fn normal_pixels(this: &PointCloud) -> Option<Decoded>;
    #[cfg(feature = "light")]
    #[wasm_bindgen(method, getter, js_name = occlusionPixels)]
    pub fn occlusion_pixels(this: &PointCloud) -> Option<Decoded>;

    /// A picture as the build of pictures gives it: `{ width, height, pixels }`, four bytes a pixel.
    #[cfg(feature = "light")]
    pub type Decoded;
    #[cfg(feature = "light")]
    #[wasm_bindgen(method, getter)]
    pub fn width(this: &Decoded) -> f64;
    #[cfg(feature = "light")]
    #[wasm_bindgen(method, getter)]
    pub fn pixels(this: &Decoded) -> Uint8Array;
}

#[wasm_bindgen]
extern "C" {
    /// `{ point, normal }`.
    pub type PointFloor;
    #[wasm_bindgen(method, getter)]
    fn point(this: &PointFloor) -> Array;
    #[wasm_bindgen(method, getter)]
    fn normal(this: &PointFloor) -> Array;
}

impl PointCloud {
    /// What a writer takes.
    pub(crate) fn read(&self) -> Result<RawCloud, Error> {
        let positions = self.positions();
        let positions = match positions.dyn_ref::<Float64Array>() {
            Some(values) => Positions::F64(values.to_vec()),
            None => Positions::F32(positions.unchecked_into::<Float32Array>().to_vec()),
        };
        let attributes = self.attributes().unwrap_or_default();
        let points = positions.len() / 3;
        let viewpoints = self.viewpoints().map(|views| views.read(points));
        Ok(RawCloud {
            colors: self.colors().map(|values| values.to_vec()),
            normals: self.normals().map(|values| values.to_vec()),
            attributes: Object::entries(&attributes)
                .iter()
                .map(|entry| attribute(&entry.unchecked_into()))
                .collect(),
            origin: self.origin().map(triple),
            viewpoints: viewpoints.transpose()?,
            up: self.up().map(triple),
            seen_from_above: self.seen_from_above().unwrap_or_default(),
            floor: (self.floor()).map(|floor| [triple(floor.point()), triple(floor.normal())]),
            unit: self.unit().and_then(|name| Unit::from_name(&name)),
            crs: self.crs().map(|crs| crs.read()),
            ..RawCloud::new(positions)
        })
    }

    /// The cloud, and what its positions were in; no second copy of them stays.
    pub(crate) fn to_cloud(&self) -> Result<(Cloud, Precision), Error> {
        let raw = self.read()?;
        let precision = match raw.positions {
            Positions::F32(_) => Precision::Single,
            Positions::F64(_) => Precision::Double,
        };
        let mut cloud = raw.to_cloud()?;
        cloud.faces = self.faces().unwrap_or_default() as u64;
        Ok((cloud, precision))
    }
}

/// Type of the positions of a cloud, and of its results.
#[derive(Clone, Copy)]
pub(crate) enum Precision {
    Single,
    Double,
}

/// Three numbers.
pub(crate) fn triple(values: Array) -> [f64; 3] {
    [0, 1, 2].map(|axis| values.get(axis).as_f64().unwrap_or(0.0))
}

/// `{ point, normal }`; undefined where there is none.
pub(crate) fn floor_to_js(floor: &Option<Floor>) -> JsResult {
    let Some(Floor { point, normal }) = floor else {
        return Ok(JsValue::UNDEFINED);
    };
    let array = |triple: [f64; 3]| triple.into_iter().map(JsValue::from).collect::<Array>();
    let normal = normal.as_dvec3().to_array();
    object([
        ("point", array(*point).into()),
        ("normal", array(normal).into()),
    ])
}

/// An entry `[name, values]`.
fn attribute(entry: &Array) -> Attribute {
    Attribute {
        name: entry.get(0).as_string().unwrap_or_default(),
        values: entry.get(1).unchecked_into::<Float32Array>().to_vec(),
    }
}
