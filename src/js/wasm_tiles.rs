//! Steps of tiles, for JavaScript: `pkg/tiles` reads and writes the files between them.

use crate::base::error::Error;
use crate::base::params::ReduceParams;
use crate::cloud::Attribute;
use crate::js::progress::JsProgress;
use crate::js::values::{JsOption, to_js};
use crate::js::{JsResult, object, optional};
use crate::tiles::points::Splitter;
use crate::tiles::{self, Aim, Counts, Grid, Measures, Plan, Points, Sample, Tile, samples};
use js_sys::{Array, Float32Array, Float64Array, Function, Reflect, Uint8Array, Uint32Array};
use serde::Serialize;
use std::cell::RefCell;
use wasm_bindgen::prelude::*;

thread_local! {
    /// Of the points that came since the last [`take_counts`].
    static COUNTS: RefCell<Counts> = RefCell::default();
    /// Of the plan that was opened last.
    static SPLITTER: RefCell<Option<Splitter>> = const { RefCell::new(None) };
}

#[wasm_bindgen]
extern "C" {
    /// `{ corner, size }` of a [`Grid`].
    pub type TileGrid;
    #[wasm_bindgen(method, getter)]
    fn corner(this: &TileGrid) -> Vec<f64>;
    #[wasm_bindgen(method, getter)]
    fn size(this: &TileGrid) -> f64;

    /// `{ places, colors, names, values }` of [`Points`].
    pub type TilePoints;
    #[wasm_bindgen(method, getter)]
    fn places(this: &TilePoints) -> Uint32Array;
    #[wasm_bindgen(method, getter)]
    fn colors(this: &TilePoints) -> Option<Uint8Array>;
    #[wasm_bindgen(method, getter)]
    fn names(this: &TilePoints) -> Vec<String>;
    #[wasm_bindgen(method, getter)]
    fn values(this: &TilePoints) -> Vec<Float32Array>;

    /// `{ places, range, points }` of a [`Sample`].
    pub type TileSample;
    #[wasm_bindgen(method, getter, js_name = places)]
    fn sampled(this: &TileSample) -> Uint32Array;
    #[wasm_bindgen(method, getter)]
    fn range(this: &TileSample) -> Vec<f64>;
    #[wasm_bindgen(method, getter)]
    fn points(this: &TileSample) -> f64;
}

/// Counts points.
#[wasm_bindgen(js_name = countPoints)]
pub fn count_points(positions: JsValue) -> Result<(), JsValue> {
    let points: Vec<[f64; 3]> = world(&positions).collect();
    COUNTS.with_borrow_mut(|counts| counts.add(&points))?;
    Ok(())
}

/// The bytes of the counts of all points since the last call.
#[wasm_bindgen(js_name = takeCounts)]
pub fn take_counts() -> Uint8Array {
    Uint8Array::from(&COUNTS.take().to_bytes()[..])
}

/// A leaf, or a tile above leaves.
#[derive(Serialize)]
struct Planned {
    tile: String,
    /// See [`Plan::level`].
    level: u32,
    /// Of a leaf, how many points of which file: the file's index and their number.
    files: Vec<(usize, u64)>,
    /// The tiles that it is reduced with.
    around: Vec<String>,
}

#[derive(Serialize)]
struct PlanFields {
    corner: [f64; 3],
    size: f64,
    strays: u64,
    leaves: Vec<Planned>,
    inner: Vec<Planned>,
}

/// [`Plan::new`] of an array of bytes of counts.
#[wasm_bindgen(js_name = planTiles)]
pub fn plan_tiles(counts: Vec<Uint8Array>, most: f64) -> JsResult {
    let counts: Vec<Counts> = counts
        .iter()
        .map(|bytes| Counts::from_bytes(&bytes.to_vec()))
        .collect::<Result<_, Error>>()?;
    let plan = Plan::new(&counts, most as u64)?;
    let names = |tiles: Vec<Tile>| tiles.iter().map(Tile::to_string).collect();
    let leaves = plan.leaves.iter().map(|leaf| Planned {
        tile: leaf.tile.to_string(),
        level: 0,
        files: leaf.files.clone(),
        around: names(plan.around_leaf(leaf.tile)),
    });
    let inner = plan.inner().into_iter().map(|tile| Planned {
        tile: tile.to_string(),
        level: plan.level(tile),
        files: Vec::new(),
        around: names(plan.around_inner(tile)),
    });
    to_js(&PlanFields {
        corner: plan.grid.corner,
        size: plan.grid.size,
        strays: plan.strays,
        leaves: leaves.collect(),
        inner: inner.collect(),
    })
}

/// Opens a plan for [`split_points`]: its grid, and the names of its leaves.
#[wasm_bindgen(js_name = openLeaves)]
pub fn open_leaves(grid: &TileGrid, leaves: Vec<String>) -> Result<(), JsValue> {
    let leaves: Vec<Tile> = leaves
        .iter()
        .map(|name| tile(name))
        .collect::<Result<_, _>>()?;
    SPLITTER.set(Some(Splitter::new(read_grid(grid), leaves.into_iter())));
    Ok(())
}

/// [`Splitter::split`] of positions: `{ places, order, tiles, counts }`.
#[wasm_bindgen(js_name = splitPoints)]
pub fn split_points(positions: JsValue) -> JsResult {
    let split = SPLITTER.with_borrow(|splitter| {
        let splitter = splitter.as_ref();
        splitter.map(|splitter| splitter.split(world(&positions)))
    });
    let split = split.ok_or_else(|| Error::Internal("no plan is open".into()))?;
    let tiles: Array = split
        .runs
        .iter()
        .map(|(tile, _)| JsValue::from(tile.to_string()))
        .collect();
    let counts: Vec<u32> = split.runs.iter().map(|&(_, count)| count as u32).collect();
    object([
        (
            "places",
            Uint32Array::from(split.places.as_flattened()).into(),
        ),
        ("order", Uint32Array::from(&split.order[..]).into()),
        ("tiles", tiles.into()),
        ("counts", Uint32Array::from(&counts[..]).into()),
    ])
}

/// [`samples::samples`] of a leaf's places, so many of so many points: `{ indices, range }` of each.
#[wasm_bindgen(js_name = sampleTile)]
pub fn sample_tile(
    name: &str,
    places: &Uint32Array,
    count: usize,
    points: usize,
) -> Result<Array, JsValue> {
    let samples = samples::samples(tile(name)?, &triples(places), (count, points));
    let each = samples.iter().map(|(indices, range)| {
        let range = range
            .as_flattened()
            .iter()
            .map(|&x| JsValue::from(x as f64));
        object([
            ("indices", Uint32Array::from(&indices[..]).into()),
            ("range", range.collect::<Array>().into()),
        ])
    });
    each.collect()
}

/// [`tiles::measure`] of an array of samples, with `{ ratio, count, spacing or tolerance }` and `{ curvatureWeight }` of a reduction: the
/// [`Measures`].
#[wasm_bindgen(js_name = measureTiles)]
pub fn measure_tiles(
    samples: Vec<TileSample>,
    grid: &TileGrid,
    aim: JsValue,
    options: JsValue,
    progress: Function,
) -> JsResult {
    let samples: Vec<Sample> = samples
        .iter()
        .map(|sample| {
            let range: Vec<u64> = sample.range().iter().map(|&x| x as u64).collect();
            Sample {
                places: triples(&sample.sampled()),
                range: [0, 3].map(|from| [0, 1, 2].map(|axis| range[from + axis])),
                points: sample.points(),
            }
        })
        .collect();
    let field = |name: &str| Reflect::get(&aim, &name.into()).map(|value| value.as_f64());
    let aim = match (field("ratio")?, field("count")?, field("spacing")?) {
        (Some(ratio), ..) => Aim::Ratio(ratio),
        (_, Some(count), _) => Aim::Count(count),
        (.., Some(spacing)) => Aim::Spacing(spacing),
        _ => Aim::Tolerance(field("tolerance")?.unwrap_or_default()),
    };
    let weight = ReduceParams::given(&JsOption(options))?.curvature_weight;
    let progress = &mut JsProgress(progress);
    to_js(&tiles::measure(
        &samples,
        read_grid(grid),
        (aim, weight),
        progress,
    )?)
}

/// [`tiles::reduce::surroundings`]: six numbers, the lower corner first.
#[wasm_bindgen(js_name = tileSurroundings)]
pub fn tile_surroundings(
    name: &str,
    level: u32,
    grid: &TileGrid,
    measures: JsValue,
) -> Result<Vec<f64>, JsValue> {
    let whole = (read_grid(grid), &read_measures(measures)?);
    let range = tiles::reduce::surroundings((tile(name)?, level), whole);
    Ok(range.as_flattened().iter().map(|&x| x as f64).collect())
}

/// [`tiles::reduce::reduce`] of a tile by its name, on its level; `options` are `{ attributes, outliers }` of a reduction: `{ places, colors,
/// values }`, values in the order of the names that came in.
#[wasm_bindgen(js_name = reduceTile)]
pub fn reduce_tile(
    points: &TilePoints,
    name: &str,
    level: u32,
    grid: &TileGrid,
    measures: JsValue,
    options: JsValue,
    progress: Function,
) -> JsResult {
    let measures = read_measures(measures)?;
    let options = ReduceParams::given(&JsOption(options))?;
    let scalars = points.names().into_iter().zip(points.values());
    let given = Points {
        places: triples(&points.places()),
        colors: points.colors().map(|colors| {
            let colors = colors.to_vec();
            colors.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect()
        }),
        attributes: scalars
            .map(|(name, values)| Attribute {
                name,
                values: values.to_vec(),
            })
            .collect(),
    };
    let of = (tile(name)?, level);
    let whole = (read_grid(grid), &measures);
    let made = tiles::reduce::reduce(&given, of, whole, &options, &mut JsProgress(progress))?;
    let values: Array = made
        .attributes
        .iter()
        .map(|attribute| Float32Array::from(&attribute.values[..]))
        .collect();
    object([
        (
            "places",
            Uint32Array::from(made.places.as_flattened()).into(),
        ),
        (
            "colors",
            optional(&made.colors, |colors| {
                Uint8Array::from(colors.as_flattened())
            }),
        ),
        ("values", values.into()),
    ])
}

fn tile(name: &str) -> Result<Tile, Error> {
    name.parse()
        .map_err(|()| Error::bad_option("tile", "a tile as it is named in the plan, 3-1-0-2", name))
}

fn read_measures(measures: JsValue) -> Result<Measures, Error> {
    let bad = |error: serde_wasm_bindgen::Error| {
        Error::bad_option("measures", "what measureTiles gave", &error.to_string())
    };
    serde_wasm_bindgen::from_value(measures).map_err(bad)
}

fn read_grid(grid: &TileGrid) -> Grid {
    let corner = grid.corner();
    Grid {
        corner: [0, 1, 2].map(|axis| corner.get(axis).copied().unwrap_or_default()),
        size: grid.size(),
    }
}

fn triples(places: &Uint32Array) -> Vec<[u32; 3]> {
    let all = places.to_vec();
    all.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect()
}

/// Positions in the world, in double precision.
fn world(positions: &JsValue) -> impl Iterator<Item = [f64; 3]> {
    let values: Vec<f64> = match positions.dyn_ref::<Float64Array>() {
        Some(values) => values.to_vec(),
        None => {
            let values = positions.unchecked_ref::<Float32Array>().to_vec();
            values.into_iter().map(f64::from).collect()
        }
    };
    (0..values.len() / 3).map(move |i| [0, 1, 2].map(|axis| values[3 * i + axis]))
}
