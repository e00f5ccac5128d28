//! The pipeline from JavaScript; files and samples are `wasm_read`, `wasm_write` and `wasm_samples`, what all need `js`. Typed arrays
//! and one options object in, plain objects of typed arrays and a report out. Errors are thrown as plain objects `{ code, message, index, expected, found }`;
//! `pkg/` turns them into its `PointweaveError`.
//!
//! Every `progress` is a function `(stage, fraction) => stop` whose truthy answer, or exception, stops the job.

use crate::base::error::Error;
use crate::base::params::{ReduceParams, SurfaceParams};
use crate::cloud::{Attribute, Cloud};
use crate::formats::Positions;
use crate::js::clouds::{PointCloud, Precision, floor_to_js};
use crate::js::crs::crs_to_js;
use crate::js::progress::JsProgress;
use crate::js::values::{JsOption, to_js};
use crate::js::viewpoints::views_to_js;
use crate::js::{JsResult, object, optional};
use crate::pipeline::{self, Distances, ReducedCloud, Surface};
use crate::report::ReduceReport;
use glam::Vec3;
use js_sys::{
    Array, Float32Array, Float64Array, Function, Object, Reflect, Uint8Array, Uint32Array,
};
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

/// [`pipeline::reduce_owned`].
#[wasm_bindgen]
pub fn reduce(cloud: &PointCloud, options: JsValue, progress: Function) -> JsResult {
    let params = ReduceParams::given(&JsOption(options))?;
    let (input, precision) = cloud.to_cloud()?;
    let mut result = pipeline::reduce_owned(input, &params, &mut JsProgress(progress))?;
    sign(&mut result.report);
    reduced_to_js(&result, precision)
}

/// What is remembered for the next call that has `keep`.
static MEMORY: Mutex<Option<pipeline::Memory>> = Mutex::new(None);

/// [`pipeline::reconstruct_owned`], or where `keep` is true [`pipeline::reconstruct_again`].
#[wasm_bindgen]
pub fn reconstruct(cloud: &PointCloud, options: JsValue, progress: Function) -> JsResult {
    let params = SurfaceParams::given(&JsOption(options))?;
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
        ("floor", floor_to_js(&cloud.floor)?),
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

/// Adds `attributes`, and the cloud's `origin`, `up`, `unit`, `crs` and `faces`, where there are any.
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
    if let Some(unit) = cloud.unit {
        Reflect::set(&result, &"unit".into(), &unit.name().into())?;
    }
    if cloud.crs.is_some() {
        Reflect::set(&result, &"crs".into(), &crs_to_js(&cloud.crs)?)?;
    }
    if cloud.faces > 0 {
        Reflect::set(&result, &"faces".into(), &(cloud.faces as f64).into())?;
    }
    Ok(result)
}

/// Says what only this file knows. Wasm memory never shrinks, so its size is its peak.
fn sign(report: &mut ReduceReport) {
    const PAGE: u64 = 65_536;
    report.peak_memory_bytes = core::arch::wasm32::memory_size(0) as u64 * PAGE;
}
