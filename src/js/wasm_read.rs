//! Files from JavaScript, slice by slice: [`read_start`], [`read_push`] for each slice, [`read_end`] until it says that it
//! is done. Both give the points that came as `{ positions, normals, colors, names, values, most }`, and nothing where none
//! did; `pkg/files/reading.js` puts them together. The builds of readers have this and nothing else.

use crate::base::error::Error;
use crate::formats::{Block, ColorValues, Format, Positions, Reading, Stations, Summary};
use crate::js::{JsResult, object, optional};
use js_sys::{Array, Float32Array, Float64Array, Reflect, Uint8Array, Uint32Array};
use std::cell::RefCell;
use wasm_bindgen::prelude::*;

thread_local! {
    /// The file that is being read.
    static READING: RefCell<Option<Reading>> = const { RefCell::new(None) };
}

/// Begins a file of `{ name, format, size }`, the first two optional; one that was being read is given up.
#[wasm_bindgen(js_name = readStart)]
pub fn read_start(options: JsValue) -> Result<(), JsValue> {
    let get = |name: &str| Reflect::get(&options, &name.into());
    let format = match get("format")?.as_string() {
        Some(name) => Some(named(&name)?),
        None => None,
    };
    let size = get("size")?.as_f64().unwrap_or(0.0) as u64;
    let name = get("name")?.as_string();
    READING.set(Some(Reading::new(format, name.as_deref(), size)));
    Ok(())
}

/// The next bytes.
#[wasm_bindgen(js_name = readPush)]
pub fn read_push(bytes: &[u8]) -> JsResult {
    with(|reading| {
        reading.push(bytes)?;
        block(reading)
    })
}

/// After the last bytes: `{ block, summary }`, the latter when all is read.
#[wasm_bindgen(js_name = readEnd)]
pub fn read_end() -> JsResult {
    let answer = with(|reading| {
        let summary = match reading.end()? {
            true => summary(&reading.summary())?,
            false => JsValue::UNDEFINED,
        };
        object([("block", block(reading)?), ("summary", summary)])
    })?;
    if Reflect::has(&answer, &"summary".into())? {
        READING.set(None);
    }
    Ok(answer)
}

/// Does something with the file that is being read; an error ends it.
fn with(work: impl FnOnce(&mut Reading) -> JsResult) -> JsResult {
    let mut reading = READING
        .take()
        .ok_or_else(|| Error::Internal("no file is being read".into()))?;
    let answer = work(&mut reading)?;
    READING.set(Some(reading));
    Ok(answer)
}

fn named(name: &str) -> Result<Format, Error> {
    let format = Format::ALL.into_iter().find(|format| format.name() == name);
    format.ok_or_else(|| Error::BadOption {
        option: "format".into(),
        expected: Format::ALL.map(Format::name).join(", "),
        found: name.into(),
    })
}

fn block(reading: &mut Reading) -> JsResult {
    let Some((
        Block {
            positions,
            normals,
            colors,
            attributes,
        },
        most,
    )) = reading.take_block()
    else {
        return Ok(JsValue::UNDEFINED);
    };
    let positions = match &positions {
        Positions::F32(values) => Float32Array::from(&values[..]).into(),
        Positions::F64(values) => Float64Array::from(&values[..]).into(),
    };
    let colors = optional(&colors, |colors| -> JsValue {
        match colors {
            ColorValues::Bytes(values) => Uint8Array::from(&values[..]).into(),
            ColorValues::Numbers(values) => Float32Array::from(&values[..]).into(),
        }
    });
    let names: Array = attributes
        .iter()
        .map(|attribute| JsValue::from(&attribute.name))
        .collect();
    let values: Array = attributes
        .iter()
        .map(|attribute| Float32Array::from(&attribute.values[..]))
        .collect();
    object([
        ("positions", positions),
        (
            "normals",
            optional(&normals, |values| Float32Array::from(&values[..])),
        ),
        ("colors", colors),
        ("names", names.into()),
        ("values", values.into()),
        (
            "most",
            most.map_or(JsValue::UNDEFINED, |most| (most as f64).into()),
        ),
    ])
}

fn summary(summary: &Summary) -> JsResult {
    let verdict = summary.verdict;
    object([
        ("format", summary.format.name().into()),
        ("dropped", (summary.dropped as f64).into()),
        ("replaced", (summary.replaced as f64).into()),
        ("faces", (summary.faces as f64).into()),
        ("narrow", verdict.narrow.into()),
        ("colorScale", verdict.color_scale.into()),
        ("hasColors", verdict.has_colors.into()),
        ("hasNormals", verdict.has_normals.into()),
        ("stations", stations(&summary.stations)?),
        (
            "up",
            optional(&summary.up, |up| {
                up.map(JsValue::from).iter().collect::<Array>()
            }),
        ),
        ("seenFromAbove", summary.seen_from_above.into()),
    ])
}

/// `{ positions, starts, of }`: the positions, and for each run of points the first of them and the index of its position.
fn stations(stations: &Stations) -> JsResult {
    if !stations.is_known() {
        return Ok(JsValue::UNDEFINED);
    }
    let Stations { positions, runs } = stations;
    let positions: Vec<f64> = positions.iter().flat_map(|p| p.to_array()).collect();
    let starts: Vec<f64> = runs.iter().map(|run| run.start as f64).collect();
    let of: Vec<u32> = runs.iter().map(|run| run.station).collect();
    object([
        ("positions", Float64Array::from(&positions[..]).into()),
        ("starts", Float64Array::from(&starts[..]).into()),
        ("of", Uint32Array::from(&of[..]).into()),
    ])
}
