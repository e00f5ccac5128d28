//! The pipeline from JavaScript; what reads files is `wasm_read`, what both need `js`. Typed arrays and one options object in,
//! plain objects of typed arrays and a report out. Errors are thrown as plain objects `{ code, message, index, expected, found }`;
//! `pkg/` turns them into its `PointweaveError`.
//!
//! Every `progress` is a function `(stage, fraction) => stop` whose truthy answer, or exception, stops the job.

use crate::base::error::Error;
use crate::base::params::{ReduceParams, SurfaceParams};
use crate::base::progress::{Progress, Stage};
use crate::cloud::{Attribute, Cloud};
use crate::formats::{self, Output, Positions, RawCloud, WriteOptions};
use crate::js::viewpoints::{PointViews, views_to_js};
use crate::js::{JsResult, object, optional};
use crate::pipeline::{self, Distances, ReducedCloud, Surface};
use crate::report::ReduceReport;
use crate::samples::{self, Model};
use glam::Vec3;
use js_sys::{
    Array, Float32Array, Float64Array, Function, Object, Reflect, Uint8Array, Uint32Array,
};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::sync::Mutex;
use wasm_bindgen::prelude::*;

/// Builds the pool of `threads` workers; blocks until as many have called `lendThread`. `pkg/engine/worker-host.js` starts them.
#[cfg(feature = "threads")]
#[wasm_bindgen(js_name = buildPool)]
pub fn build_pool(threads: usize) -> Result<(), JsError> {
    Ok(crate::base::pool::build(threads)?)
}

/// Lends the calling worker to the pool. Does not return while the pool lives.
#[cfg(feature = "threads")]
#[wasm_bindgen(js_name = lendThread)]
pub fn lend_thread() {
    crate::base::pool::lend_thread();
}

/// `{ reduce, reconstruct }`: the defaults, which `pkg/engine/options.js` repeats.
#[wasm_bindgen]
pub fn defaults() -> JsResult {
    object([
        ("reduce", to_js(&ReduceParams::default())?),
        ("reconstruct", to_js(&SurfaceParams::default())?),
    ])
}

/// [`pipeline::reduce_owned`].
#[wasm_bindgen]
pub fn reduce(cloud: &PointCloud, options: JsValue, progress: Function) -> JsResult {
    let (input, precision) = cloud.to_cloud()?;
    let mut result = pipeline::reduce_owned(input, &from_js(options)?, &mut JsProgress(progress))?;
    sign(&mut result.report);
    reduced_to_js(&result, precision)
}

/// What is remembered for the next call that has `keep`.
static MEMORY: Mutex<Option<pipeline::Memory>> = Mutex::new(None);

/// [`pipeline::reconstruct_owned`], or where `keep` is true [`pipeline::reconstruct_again`].
#[wasm_bindgen]
pub fn reconstruct(cloud: &PointCloud, options: JsValue, progress: Function) -> JsResult {
    let params: SurfaceParams = from_js(options)?;
    let mut progress = JsProgress(progress);
    let mut memory = MEMORY
        .lock()
        .map_err(|_| Error::Internal("a call before this one panicked".into()))?;
    if !params.keep {
        *memory = None;
    }
    let (input, precision) = cloud.to_cloud()?;
    let mut surface = if params.keep {
        let memory = memory.get_or_insert_default();
        pipeline::reconstruct_again(input, &params, memory, &mut progress)?
    } else {
        pipeline::reconstruct_owned(input, &params, &mut progress)?
    };
    sign(&mut surface.report.reduce);
    sign(&mut surface.cloud.report);
    surface_to_js(&surface, precision)
}

/// [`pipeline::inspect`].
#[wasm_bindgen]
pub fn inspect(cloud: &PointCloud, progress: Function) -> JsResult {
    let positions = match cloud.read()?.positions {
        Positions::F32(values) => values.into_iter().map(f64::from).collect(),
        Positions::F64(values) => values,
    };
    to_js(&pipeline::inspect(&positions, &mut JsProgress(progress))?)
}

/// Options of [`write`].
#[derive(Deserialize)]
struct WriteSettings {
    format: Option<String>,
    encoding: Option<String>,
    #[serde(default)]
    quantize: bool,
}

/// [`formats::write`] of `{ format, encoding, quantize }`: the file's bytes.
#[wasm_bindgen]
pub fn write(result: &PointCloud, options: JsValue) -> Result<Uint8Array, JsValue> {
    let WriteSettings {
        format,
        encoding,
        quantize,
    } = from_js(options)?;
    let name = format.as_deref().unwrap_or("ply");
    let format = Output::from_name(name)
        .ok_or_else(|| bad_option("format", "ply, xyz, glb, obj or stl", name))?;
    let options = WriteOptions {
        ascii: encoding.as_deref() == Some("ascii"),
        quantize,
    };
    let indices = result.indices().map(|indices| indices.to_vec());
    let bytes = formats::write(&result.read()?, indices.as_deref(), format, options)?;
    Ok(Uint8Array::from(&bytes[..]))
}

/// Options of [`sample`].
#[derive(Deserialize)]
struct SampleOptions {
    model: String,
    count: Option<usize>,
    #[serde(default)]
    seed: u64,
    noise: Option<f64>,
}

/// [`samples::sample_with_noise`] of `{ model, count, seed, noise }`: a cloud with colours.
#[wasm_bindgen]
pub fn sample(options: JsValue) -> JsResult {
    let SampleOptions {
        model,
        count,
        seed,
        noise,
    } = from_js(options)?;
    let model =
        Model::from_name(&model).ok_or_else(|| bad_option("model", "duck, pig or part", &model))?;
    let count = count.unwrap_or(model.default_points());
    let scan = samples::sample_with_noise(model, count, seed, noise.unwrap_or(samples::NOISE));
    object([
        ("positions", Float32Array::from(&scan.positions[..]).into()),
        ("colors", Uint8Array::from(&scan.colors[..]).into()),
    ])
}

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
    #[wasm_bindgen(method, getter)]
    fn indices(this: &PointCloud) -> Option<Uint32Array>;
}

impl PointCloud {
    fn read(&self) -> Result<RawCloud, Error> {
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
            ..RawCloud::new(positions)
        })
    }

    /// The cloud, and what its positions were in; no second copy of them stays.
    fn to_cloud(&self) -> Result<(Cloud, Precision), Error> {
        let raw = self.read()?;
        let precision = match raw.positions {
            Positions::F32(_) => Precision::Single,
            Positions::F64(_) => Precision::Double,
        };
        Ok((raw.to_cloud()?, precision))
    }
}

/// Type of the positions of a cloud, and of its results.
#[derive(Clone, Copy)]
enum Precision {
    Single,
    Double,
}

/// Three numbers.
fn triple(values: Array) -> [f64; 3] {
    [0, 1, 2].map(|axis| values.get(axis).as_f64().unwrap_or(0.0))
}

/// An entry `[name, values]`.
fn attribute(entry: &Array) -> Attribute {
    Attribute {
        name: entry.get(0).as_string().unwrap_or_default(),
        values: entry.get(1).unchecked_into::<Float32Array>().to_vec(),
    }
}

/// A `ReducedCloud` with positions of the input's type.
fn reduced_to_js(result: &ReducedCloud, precision: Precision) -> JsResult {
    let reduced = &result.reduced;
    let cloud = &reduced.cloud;
    let normals = cloud.normals.as_deref().unwrap_or_default();
    let fields = object([
        (
            "positions",
            positions_to_js(&cloud.points, cloud, precision),
        ),
        ("normals", triples(normals)),
        ("colors", colors_to_js(&cloud.colors)),
        (
            "variation",
            Float32Array::from(&reduced.variation[..]).into(),
        ),
        ("weights", Float32Array::from(&reduced.weights[..]).into()),
        ("nearest", Uint32Array::from(&reduced.nearest[..]).into()),
        (
            "assignment",
            optional(&reduced.assignment, |a| Uint32Array::from(&a[..])),
        ),
        (
            "cells",
            reduced.cells.as_ref().map_or(JsValue::UNDEFINED, |cells| {
                positions_to_js(cells.as_flattened(), cloud, precision)
            }),
        ),
        ("viewpoints", views_to_js(&cloud.viewpoints)?),
        (
            "seenFromAbove",
            optional(&cloud.seen_from_above.then_some(true), |yes| *yes),
        ),
        ("report", to_js(&result.report)?),
    ])?;
    attach(fields, &cloud.attributes, cloud)
}

/// A `SurfaceMesh` with positions of the input's type.
fn surface_to_js(surface: &Surface, precision: Precision) -> JsResult {
    let mesh = &surface.mesh;
    let cloud = &surface.cloud.reduced.cloud;
    let fields = object([
        (
            "positions",
            positions_to_js(&mesh.vertices, cloud, precision),
        ),
        ("normals", triples(&mesh.normals)),
        (
            "indices",
            Uint32Array::from(mesh.triangles.as_flattened()).into(),
        ),
        ("colors", colors_to_js(&surface.colors)),
        ("cloud", reduced_to_js(&surface.cloud, precision)?),
        ("distances", distances_to_js(&surface.distances)?),
        ("report", to_js(&surface.report)?),
    ])?;
    attach(fields, &surface.attributes, cloud)
}

fn distances_to_js(distances: &Option<Distances>) -> JsResult {
    let Some(Distances { points, vertices }) = distances else {
        return Ok(JsValue::UNDEFINED);
    };
    object([
        ("points", Float32Array::from(&points[..]).into()),
        ("vertices", Float32Array::from(&vertices[..]).into()),
    ])
}

/// Points of the unit frame in the caller's, single or double precision as the input was.
fn positions_to_js(points: &[Vec3], cloud: &Cloud, precision: Precision) -> JsValue {
    let coordinates = points.iter().flat_map(|&p| cloud.frame.to_caller(p));
    match precision {
        Precision::Single => {
            Float32Array::from(&coordinates.map(|x| x as f32).collect::<Vec<_>>()[..]).into()
        }
        Precision::Double => Float64Array::from(&coordinates.collect::<Vec<_>>()[..]).into(),
    }
}

fn triples(vectors: &[Vec3]) -> JsValue {
    let flat: Vec<f32> = vectors.iter().flat_map(|v| v.to_array()).collect();
    Float32Array::from(&flat[..]).into()
}

fn colors_to_js(colors: &Option<Vec<[u8; 3]>>) -> JsValue {
    optional(colors, |colors| Uint8Array::from(colors.as_flattened()))
}

/// Adds `attributes`, and the cloud's `origin` and `up`, where there are any.
fn attach(result: JsValue, attributes: &[Attribute], cloud: &Cloud) -> JsResult {
    if !attributes.is_empty() {
        let table = Object::new();
        for Attribute { name, values } in attributes {
            Reflect::set(&table, &name.into(), &Float32Array::from(&values[..]))?;
        }
        Reflect::set(&result, &"attributes".into(), &table)?;
    }
    let up = cloud.up.map(|up| up.as_dvec3().to_array());
    for (name, triple) in [("origin", cloud.origin), ("up", up)] {
        if let Some(triple) = triple {
            let triple: Array = triple.into_iter().map(JsValue::from).collect();
            Reflect::set(&result, &name.into(), &triple)?;
        }
    }
    Ok(result)
}

/// Says what only this file knows. Wasm memory never shrinks, so its size is its peak.
fn sign(report: &mut ReduceReport) {
    const PAGE: u64 = 65_536;
    report.peak_memory_bytes = core::arch::wasm32::memory_size(0) as u64 * PAGE;
}

/// Calls `f(stage, fraction)`; a truthy answer, or an exception, stops the job.
struct JsProgress(Function);

impl Progress for JsProgress {
    fn update(&mut self, stage: Stage, fraction: f32) -> crate::Result<()> {
        let answer = self
            .0
            .call2(&JsValue::NULL, &stage.name().into(), &fraction.into());
        match answer {
            Ok(stop) if stop.is_falsy() => Ok(()),
            _ => Err(Error::Cancelled),
        }
    }
}

fn bad_option(option: &str, expected: &str, found: impl ToString) -> Error {
    Error::BadOption {
        option: option.into(),
        expected: expected.into(),
        found: found.to_string(),
    }
}

/// A report or table as a plain object.
fn to_js(value: &impl Serialize) -> JsResult {
    let serializer = serde_wasm_bindgen::Serializer::new().serialize_maps_as_objects(true);
    value
        .serialize(&serializer)
        .map_err(|error| Error::Internal(error.to_string()).into())
}

/// Options over their defaults; ranges are checked by the pipeline.
fn from_js<T: DeserializeOwned>(options: JsValue) -> Result<T, Error> {
    serde_wasm_bindgen::from_value(options)
        .map_err(|error| bad_option("options", "the options of the reference", error))
}
