//! GPS times in chunks of LASzip 2, and in the layers of LASzip 3 and 4, which have no code for "the same again".
//!
//! The decoder of the crate `laz` (0.13.0), as LASzip's own, calls itself whenever the stream switches to another of four
//! sequences of times. What a writer makes switches once a point; what was damaged may switch a million times, and overflow
//! the stack. So this one counts.

use laz::decoders::ArithmeticDecoder;
use laz::decompressors::{IntegerDecompressor, IntegerDecompressorBuilder};
use laz::models::{ArithmeticModel, ArithmeticModelBuilder};
use laz::record::FieldDecompressor;
use std::io::{Error, ErrorKind, Read, Result};

/// Codes for a multiple of the last difference go up to this …
const MULTI: i32 = 500;
/// … and from here, as negative ones, …
const MULTI_MINUS: i32 = -10;
/// … then "the same again" …
const UNCHANGED: i32 = MULTI - MULTI_MINUS + 1;
/// … and "in full"; those after it switch to another sequence.
const FULL: i32 = MULTI - MULTI_MINUS + 2;
const CODES: u32 = (MULTI - MULTI_MINUS + 6) as u32;

/// Times of one source; a file may mix four.
#[derive(Clone, Copy, Default)]
struct Sequence {
    /// The last time's bits.
    time: i64,
    difference: i32,
    /// Differences of late that were no small multiple.
    extremes: u8,
}

/// Decodes the times.
pub(super) struct Times {
    /// In a layer, to which only times that change go.
    layered: bool,
    multiple: ArithmeticModel,
    after_zero: ArithmeticModel,
    integers: IntegerDecompressor,
    sequences: [Sequence; 4],
    last: usize,
    next: usize,
}

impl Default for Times {
    fn default() -> Self {
        Times::new(false)
    }
}

impl Times {
    fn new(layered: bool) -> Times {
        let fewer = u32::from(layered);
        Times {
            layered,
            multiple: ArithmeticModelBuilder::new(CODES - fewer).build(),
            after_zero: ArithmeticModelBuilder::new(6 - fewer).build(),
            integers: IntegerDecompressorBuilder::new()
                .bits(32)
                .contexts(9)
                .build_initialized(),
            sequences: Default::default(),
            last: 0,
            next: 0,
        }
    }

    /// Of a layer, after a point with this time's bits.
    pub(super) fn layered(time: i64) -> Times {
        let mut times = Times::new(true);
        times.sequences[0].time = time;
        times
    }

    /// The last time's bits.
    pub(super) fn now(&self) -> i64 {
        self.sequences[self.last].time
    }

    /// Goes on to the next time.
    pub(super) fn next<R: Read>(&mut self, decoder: &mut ArithmeticDecoder<R>) -> Result<()> {
        for _ in 0..=self.sequences.len() {
            let switch = if self.sequences[self.last].difference == 0 {
                self.after_zero(decoder)?
            } else {
                self.after_difference(decoder)?
            };
            match switch {
                Some(by) => self.last = (self.last + by) & 3,
                None => return Ok(()),
            }
        }
        Err(Error::new(
            ErrorKind::InvalidData,
            "times that switch on and on",
        ))
    }
}

impl<R: Read> FieldDecompressor<R> for Times {
    fn size_of_field(&self) -> usize {
        8
    }

    fn decompress_first(&mut self, source: &mut R, field: &mut [u8]) -> Result<()> {
        let mut bytes = [0; 8];
        source.read_exact(&mut bytes)?;
        self.sequences[0].time = i64::from_le_bytes(bytes);
        self.keep(field);
        Ok(())
    }

    fn decompress_with(
        &mut self,
        decoder: &mut ArithmeticDecoder<R>,
        field: &mut [u8],
    ) -> Result<()> {
        self.next(decoder)?;
        self.keep(field);
        Ok(())
    }
}

impl Times {
    /// Puts the time into the field's bytes.
    fn keep(&self, field: &mut [u8]) {
        if let Some(field) = field.first_chunk_mut() {
            *field = self.now().to_le_bytes();
        }
    }

    /// A time after one that was the same as that before; or by how many sequences to switch.
    fn after_zero<R: Read>(&mut self, decoder: &mut ArithmeticDecoder<R>) -> Result<Option<usize>> {
        match decoder.decode_symbol(&mut self.after_zero)? + u32::from(self.layered) {
            0 => {}
            1 => {
                let difference = self.integers.decompress(decoder, 0, 0)?;
                let last = &mut self.sequences[self.last];
                last.time = last.time.wrapping_add(i64::from(difference));
                (last.difference, last.extremes) = (difference, 0);
            }
            2 => self.full(decoder)?,
            other => return Ok(Some(other as usize - 2)),
        }
        Ok(None)
    }

    /// A time after one with a difference.
    fn after_difference<R: Read>(
        &mut self,
        decoder: &mut ArithmeticDecoder<R>,
    ) -> Result<Option<usize>> {
        let mut code = decoder.decode_symbol(&mut self.multiple)? as i32;
        if self.layered && code >= UNCHANGED {
            code += 1;
        }
        if code > FULL {
            return Ok(Some((code - FULL) as usize));
        }
        if code == FULL {
            self.full(decoder)?;
            return Ok(None);
        }
        if code >= UNCHANGED {
            return Ok(None);
        }
        let (multiple, context, extreme) = match code {
            0 => (0, 7, true),
            1 => (1, 1, false),
            2..10 => (code, 2, false),
            10..MULTI => (code, 3, false),
            MULTI => (code, 4, true),
            _ if MULTI - code > MULTI_MINUS => (MULTI - code, 5, false),
            _ => (MULTI_MINUS, 6, true),
        };
        let last = &mut self.sequences[self.last];
        let difference =
            self.integers
                .decompress(decoder, last.difference.wrapping_mul(multiple), context)?;
        last.time = last.time.wrapping_add(i64::from(difference));
        if code == 1 {
            last.extremes = 0;
        }
        if extreme {
            last.extremes += 1;
            if last.extremes > 3 {
                (last.difference, last.extremes) = (difference, 0);
            }
        }
        Ok(None)
    }

    /// A time in full, which begins a sequence.
    fn full<R: Read>(&mut self, decoder: &mut ArithmeticDecoder<R>) -> Result<()> {
        let upper = (self.sequences[self.last].time >> 32) as i32;
        let upper = self.integers.decompress(decoder, upper, 8)?;
        let time = (i64::from(upper) << 32) | i64::from(decoder.read_int()?);
        self.next = (self.next + 1) & 3;
        self.last = self.next;
        self.sequences[self.last] = Sequence {
            time,
            ..Sequence::default()
        };
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn switches_without_end_are_an_error() {
        // Ones decode to the last symbol for ever: a switch.
        let ones = vec![0xff; 1 << 16];
        let mut decoder = ArithmeticDecoder::new(&ones[..]);
        decoder.read_init_bytes().unwrap();
        for mut times in [Times::default(), Times::layered(0)] {
            let error = times
                .decompress_with(&mut decoder, &mut [0; 8])
                .unwrap_err();
            assert_eq!(error.kind(), ErrorKind::InvalidData, "{error}");
        }
    }
}
