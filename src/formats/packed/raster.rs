//! Elevation grids as GeoTIFF, by the crate `tiff`: one band of numbers, stored, or packed by deflate or LZW. Each cell with data
//! is a point at its middle, where the file's scale and tie point, or its matrix, place it; without them columns are x
//! and rows run down y. Pictures are refused: bands of colour, and bytes that no place belongs to.

use super::super::input::Input;
use super::super::options::ReadOptions;
use super::super::parser::{Parser, Step};
use super::super::table::{Columns, Table};
use crate::base::error::Result;
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};
use tiff::decoder::{Decoder, DecodingResult};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError, TiffResult};

/// Reads the cells.
#[derive(Default)]
pub(in super::super) struct Tiff {
    keep: bool,
}

impl Tiff {
    pub(in super::super) fn new(options: &ReadOptions) -> Tiff {
        Tiff {
            keep: options.keep_sentinels,
        }
    }
}

impl Parser for Tiff {
    fn parse(&mut self, input: &mut Input, table: &mut Option<Table>) -> Result<Step> {
        if !input.last {
            return Ok(Step::More);
        }
        let bytes = input.rest();
        let keep = self.keep;
        let read = AssertUnwindSafe(|| read(bytes, keep, table));
        let bad = |found: String| input.bad_byte(0, "an elevation grid that is whole", found);
        match catch_unwind(read) {
            Ok(Ok(None)) => Ok(Step::Done),
            Ok(Ok(Some(picture))) => {
                Err(input.unsupported("one band of heights, with its place on the ground", picture))
            }
            Ok(Err(TiffError::UnsupportedError(error))) => {
                Err(input.unsupported("stored, deflated or LZW content", error.to_string()))
            }
            Ok(Err(error)) => Err(bad(error.to_string())),
            Err(_) => Err(bad("damaged content".into())),
        }
    }
}

/// From cells to the ground: `[x per column, x per row, x of the first corner]`, then y.
type Placing = [[f64; 3]; 2];

/// Reads the cells; says what the file is where it is none of heights.
fn read(bytes: &[u8], keep: bool, table: &mut Option<Table>) -> TiffResult<Option<String>> {
    let mut file = Decoder::new(Cursor::new(bytes))?;
    let (width, height) = file.dimensions()?;
    let bits = match file.colortype()? {
        ColorType::Gray(bits) => bits,
        ColorType::Multiband { num_samples, .. } => {
            return Ok(Some(format!("{num_samples} bands")));
        }
        ColorType::GrayA(_) => return Ok(Some("2 bands".into())),
        _ => return Ok(Some("a picture in colours".into())),
    };
    let placing = placing(&mut file)?;
    if bits <= 8 && placing.is_none() {
        return Ok(Some(format!("a picture of {bits} bits")));
    }
    let placing = placing.unwrap_or([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]);
    let no_data = file.find_tag(Tag::GdalNodata)?;
    let no_data = no_data.and_then(|value| value.into_string().ok());
    let no_data: Option<f64> = no_data.and_then(|text| text.trim_matches(['\0', ' ']).parse().ok());

    let (chunk_width, chunk_height) = file.chunk_dimensions();
    let across = width.div_ceil(chunk_width.max(1)).max(1);
    let chunks = u64::from(across) * u64::from(height.div_ceil(chunk_height.max(1)));
    // A chunk has a byte at least.
    if chunks > bytes.len() as u64 {
        return Err(TiffError::LimitsExceeded);
    }
    let chunks = u32::try_from(chunks).map_err(|_| TiffError::LimitsExceeded)?;
    let table = table.insert(Table::new(Columns::xyz(), None));
    for chunk in 0..chunks {
        let (wide, high) = file.chunk_data_dimensions(chunk);
        if u64::from(wide) * u64::from(high) > MOST_A_BYTE * bytes.len() as u64 {
            return Err(TiffError::LimitsExceeded);
        }
        let heights = file.read_chunk(chunk)?;
        let (left, top) = (
            (chunk % across) * chunk_width,
            (chunk / across) * chunk_height,
        );
        for row in 0..high {
            for column in 0..wide {
                let z = value(&heights, (row * wide + column) as usize);
                if Some(z) == no_data && !keep {
                    table.no_data += 1;
                    continue;
                }
                // The middle of the cell.
                let (i, j) = (f64::from(left + column) + 0.5, f64::from(top + row) + 0.5);
                let [x, y] = placing.map(|[a, b, c]| a * i + b * j + c);
                table.push(&[x, y, z]);
            }
        }
    }
    Ok(None)
}

/// Deflate packs no more bytes into one.
const MOST_A_BYTE: u64 = 1032;

/// Where the file says that its cells are.
fn placing(file: &mut Decoder<Cursor<&[u8]>>) -> TiffResult<Option<Placing>> {
    let mut numbers = |tag: Tag| match file.find_tag(tag)? {
        Some(value) => value.into_f64_vec().map(Some),
        None => Ok(None),
    };
    let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
    let scale = numbers(Tag::ModelPixelScaleTag)?;
    let tie = numbers(Tag::ModelTiepointTag)?;
    let matrix = numbers(Tag::ModelTransformationTag)?;
    let mut placing = match (scale.as_deref(), tie.as_deref(), matrix.as_deref()) {
        (Some([sx, sy, ..]), Some([i, j, _, x, y, ..]), _)
            if finite(&[*sx, *sy, *i, *j, *x, *y]) =>
        {
            [[*sx, 0.0, x - sx * i], [0.0, -sy, y + sy * j]]
        }
        (_, _, Some([a, b, _, d, e, f, _, h, ..])) if finite(&[*a, *b, *d, *e, *f, *h]) => {
            [[*a, *b, *d], [*e, *f, *h]]
        }
        _ => return Ok(None),
    };
    // Key 1025 is the raster's type; 2 means that the place is the cell's middle, not its corner.
    let keys = file.find_tag(Tag::GeoKeyDirectoryTag)?;
    let keys = keys.map_or(Ok(Vec::new()), |value| value.into_u16_vec())?;
    if keys
        .chunks_exact(4)
        .any(|key| key[0] == 1025 && key[3] == 2)
    {
        for [a, b, c] in &mut placing {
            *c -= 0.5 * (*a + *b);
        }
    }
    Ok(Some(placing))
}

fn value(values: &DecodingResult, i: usize) -> f64 {
    fn at<T: Copy>(values: &[T], i: usize, number: impl Fn(T) -> f64) -> f64 {
        values.get(i).map_or(f64::NAN, |value| number(*value))
    }
    match values {
        DecodingResult::U8(values) => at(values, i, f64::from),
        DecodingResult::U16(values) => at(values, i, f64::from),
        DecodingResult::U32(values) => at(values, i, f64::from),
        DecodingResult::U64(values) => at(values, i, |v| v as f64),
        DecodingResult::I8(values) => at(values, i, f64::from),
        DecodingResult::I16(values) => at(values, i, f64::from),
        DecodingResult::I32(values) => at(values, i, f64::from),
        DecodingResult::I64(values) => at(values, i, |v| v as f64),
        DecodingResult::F32(values) => at(values, i, f64::from),
        DecodingResult::F64(values) => at(values, i, |v| v),
        DecodingResult::F16(values) => at(values, i, |v| f64::from(v.to_f32())),
    }
}
