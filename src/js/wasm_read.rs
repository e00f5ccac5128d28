//! Files from JavaScript, slice by slice: [`read_start`], [`read_push`] for each slice, [`read_end`] until it says that it
//! is done. Both give the points that came as `{ positions, normals, colors, names, values, most }`, and nothing where none
//! did; `pkg/files/reading.js` puts them together. The builds of readers have this and nothing else.

use crate::base::error::Error;
#[cfg(feature = "packed")]
use crate::formats::Archive;
use crate::formats::{
    Block, ColorValues, FaceMode, Format, LeftOut, Picture, Positions, Preview, ReadOptions,
    Reading, Skin, Stations, Summary, Want,
};
use crate::js::{JsResult, object, optional};
use js_sys::{Array, Float32Array, Float64Array, Object, Reflect, Uint8Array, Uint32Array};
use std::cell::RefCell;
use wasm_bindgen::prelude::*;

thread_local! {
    /// The file that is being read.
    static READING: RefCell<Option<Reading>> = const { RefCell::new(None) };
}

#[cfg(feature = "packed")]
thread_local! {
    /// The archive that is being unpacked.
    static ARCHIVE: RefCell<Option<Archive<'static>>> = const { RefCell::new(None) };
}

/// Begins a file of `{ name, format, size, columns, delimiter, decimal, skip, sentinels, faces }`, all but the size optional; one that
/// was being read is given up.
#[wasm_bindgen(js_name = readStart)]
pub fn read_start(options: JsValue) -> Result<(), JsValue> {
    let get = |name: &str| Reflect::get(&options, &name.into());
    let format = match get("format")?.as_string() {
        Some(name) => Some(named(&name)?),
        None => None,
    };
    let size = get("size")?.as_f64().unwrap_or(0.0) as u64;
    let name = get("name")?.as_string();
    let reading =
        Reading::new(format, name.as_deref(), size).with_options(read_options(&options)?)?;
    READING.set(Some(reading));
    Ok(())
}

fn read_options(options: &JsValue) -> Result<ReadOptions, JsValue> {
    let get = |name: &str| Reflect::get(options, &name.into());
    let mark = |name: &str| Ok::<_, JsValue>(get(name)?.as_string().and_then(|s| s.chars().next()));
    let columns = get("columns")?;
    let names = || {
        Array::from(&columns)
            .iter()
            .filter_map(|name| name.as_string())
            .collect()
    };
    Ok(ReadOptions {
        columns: (!columns.is_undefined()).then(names),
        delimiter: mark("delimiter")?,
        decimal: mark("decimal")?,
        skip: get("skip")?.as_f64().unwrap_or(0.0) as u64,
        keep_sentinels: get("sentinels")?.as_string().as_deref() == Some("keep"),
        faces: match get("faces")?.as_string().as_deref() {
            Some("vertices") => FaceMode::Vertices,
            Some("mesh") => FaceMode::Mesh,
            _ => FaceMode::Sample,
        },
    })
}

/// Keeps a ZIP or gzip archive for [`unpack`], and says the names of what is in it.
#[cfg(feature = "packed")]
#[wasm_bindgen(js_name = openArchive)]
pub fn open_archive(bytes: Vec<u8>, name: &str) -> JsResult {
    let archive = Archive::open(bytes, Some(name))?;
    let names = archive.entries.iter().map(|entry| entry.name.clone());
    let names: Vec<String> = names.collect();
    ARCHIVE.set(Some(archive));
    Ok(strings(&names))
}

/// The content of a part of the archive, by its number.
#[cfg(feature = "packed")]
#[wasm_bindgen(js_name = unpack)]
pub fn unpack(part: usize) -> Result<Uint8Array, JsValue> {
    ARCHIVE.with_borrow(|archive| {
        let archive = archive.as_ref();
        let of = archive.and_then(|archive| Some((archive, archive.entries.get(part)?)));
        let (archive, entry) = of.ok_or_else(|| Error::Internal("no such part".into()))?;
        Ok(Uint8Array::from(&archive.unpack(entry)?[..]))
    })
}

/// [`crate::formats::laz_chunks`]: points and bytes of each chunk, one after the other, or nothing.
#[cfg(feature = "las")]
#[wasm_bindgen(js_name = lazChunks)]
pub fn laz_chunks(head: &[u8], size: f64) -> Result<Option<Vec<f64>>, JsValue> {
    let found = crate::formats::laz_chunks(head, size as u64)?;
    let numbers = |each: Vec<(u64, u64)>| {
        let pairs = each.iter().flat_map(|&(points, bytes)| [points, bytes]);
        pairs.map(|x| x as f64).collect()
    };
    Ok(found.map(numbers))
}

/// The next bytes.
#[wasm_bindgen(js_name = readPush)]
pub fn read_push(bytes: &[u8]) -> JsResult {
    with(|reading| {
        reading.push(bytes)?;
        block(reading)
    })
}

/// After the last bytes: `{ block, skin, indices, summary, want }`: the triangles and their pictures where they come along, the summary when all is read, the last where something else is needed for
/// that: `{ file }` by its name, which [`read_file`] gives, or the pixels of a `{ picture }`'s bytes, which [`read_picture`] gives.
#[wasm_bindgen(js_name = readEnd)]
pub fn read_end() -> JsResult {
    let answer = with(|reading| {
        let summary = match reading.end()? {
            true => summary(&reading.summary())?,
            false => JsValue::UNDEFINED,
        };
        let want = match reading.want() {
            Some(Want::File(name)) => object([("file", name.into())])?,
            Some(Want::Picture(bytes)) => {
                object([("picture", Uint8Array::from(&bytes[..]).into())])?
            }
            None => JsValue::UNDEFINED,
        };
        let indices = match summary.is_undefined() {
            true => Vec::new(),
            false => reading.take_indices(),
        };
        let indices = (!indices.is_empty()).then_some(indices);
        let skin = reading.take_skin();
        object([
            ("block", block(reading)?),
            ("skin", skin.as_ref().map_or(Ok(JsValue::UNDEFINED), worn)?),
            (
                "indices",
                optional(&indices, |indices| Uint32Array::from(&indices[..])),
            ),
            ("summary", summary),
            ("want", want),
        ])
    })?;
    if Reflect::has(&answer, &"summary".into())? {
        READING.set(None);
    }
    Ok(answer)
}

/// The content of the file that is wanted; undefined where there is none.
#[wasm_bindgen(js_name = readFile)]
pub fn read_file(content: Option<Vec<u8>>) -> JsResult {
    with(|reading| {
        reading.give_file(content.as_deref());
        Ok(JsValue::UNDEFINED)
    })
}

/// The pixels of the picture that is wanted; undefined where it is of no kind that is read.
#[wasm_bindgen(js_name = readPicture)]
pub fn read_picture(pixels: Option<Vec<u8>>, width: usize, height: usize) -> JsResult {
    with(|reading| {
        reading.give_picture(pixels.and_then(|pixels| Picture::new(width, height, pixels)));
        Ok(JsValue::UNDEFINED)
    })
}

/// Does something with the file that is being read; an error ends it. That of a table of text has the `table` that could not be read.
fn with(work: impl FnOnce(&mut Reading) -> JsResult) -> JsResult {
    let mut reading = READING
        .take()
        .ok_or_else(|| Error::Internal("no file is being read".into()))?;
    match work(&mut reading) {
        Ok(answer) => {
            READING.set(Some(reading));
            Ok(answer)
        }
        Err(error) => {
            if let Some(preview) = reading.preview() {
                Reflect::set(&error, &"table".into(), &table(&preview)?)?;
            }
            Err(error)
        }
    }
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
    let verdict = &summary.verdict;
    let skipped = Object::new();
    for (why, count) in &summary.skipped {
        Reflect::set(&skipped, &(*why).into(), &(*count as f64).into())?;
    }
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
        (
            "unit",
            optional(&summary.unit, |unit| JsValue::from(unit.name())),
        ),
        ("crs", crs(summary)?),
        ("sampled", (summary.sampling.points as f64).into()),
        (
            "missing",
            summary
                .sampling
                .missing
                .iter()
                .map(JsValue::from)
                .collect::<Array>()
                .into(),
        ),
        ("attributes", strings(&verdict.attributes)),
        ("leftOut", left_out(&verdict.left_out)?),
        ("skipped", skipped.into()),
        ("columns", strings(&summary.columns)),
        ("notes", strings(&summary.notes)),
        (
            "preview",
            match &summary.preview {
                Some(preview) => table(preview)?,
                None => JsValue::UNDEFINED,
            },
        ),
    ])
}

/// `{ uvs, tangents, color, normal, occlusion }`: places, frames, and the bytes of picture files.
fn worn(skin: &Skin) -> JsResult {
    let bytes = |file: &Option<Vec<u8>>| optional(file, |file| Uint8Array::from(&file[..]));
    object([
        ("uvs", Float32Array::from(&skin.uvs[..]).into()),
        (
            "tangents",
            optional(&skin.tangents, |values| Float32Array::from(&values[..])),
        ),
        ("color", bytes(&skin.color)),
        ("normal", bytes(&skin.normal)),
        ("occlusion", bytes(&skin.occlusion)),
    ])
}

fn strings(strings: &[String]) -> JsValue {
    strings.iter().map(JsValue::from).collect::<Array>().into()
}

fn left_out(left_out: &LeftOut) -> JsResult {
    let no_data: Array = left_out
        .no_data
        .iter()
        .map(|values| Float64Array::from(&values[..]))
        .collect();
    object([
        ("huge", left_out.huge.into()),
        ("noData", no_data.into()),
        (
            "noReturns",
            Float64Array::from(left_out.no_returns.as_flattened()).into(),
        ),
    ])
}

fn table(preview: &Preview) -> JsResult {
    let rows: Array = preview.rows.iter().map(|row| strings(row)).collect();
    object([
        ("rows", rows.into()),
        ("names", strings(&preview.names)),
        ("delimiter", String::from(preview.delimiter).into()),
        ("decimal", String::from(preview.decimal).into()),
        ("weak", preview.weak.into()),
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

/// Only LAS has one.
#[cfg(feature = "las")]
fn crs(summary: &Summary) -> JsResult {
    crate::js::crs::crs_to_js(&summary.crs)
}

#[cfg(not(feature = "las"))]
fn crs(_: &Summary) -> JsResult {
    Ok(JsValue::UNDEFINED)
}
