//! GPS times in chunks of layers (LASzip 3 and 4, point formats 6 to 10).
//!
//! The decoder of the crate `laz` (0.13.0) calls itself at every switch between sequences of times, so damaged data overflow the
//! stack; see `Times`. Which points have another time than the point before is told in the layer of returns and coordinates, so
//! that layer is decoded here, too, without its values: they are the crate's.

use super::time::Times;
use laz::decoders::ArithmeticDecoder;
use laz::decompressors::{IntegerDecompressor, IntegerDecompressorBuilder};
use laz::models::{ArithmeticModel, ArithmeticModelBuilder};
use std::array::from_fn;
use std::io::Result;

/// Where a record has the bits of returns, the scanner's channel, and the time.
const RETURNS: usize = 14;
const CHANNEL: usize = 15;
const TIME: usize = 22;

/// Layers of a point's fields; the first is that of returns and coordinates, the last that of times.
const LAYERS: usize = 9;

/// Decodes the times of a chunk, point by point.
pub(super) struct LayeredTimes<'a> {
    returns: ArithmeticDecoder<&'a [u8]>,
    times: ArithmeticDecoder<&'a [u8]>,
    channels: [Option<Box<Channel>>; 4],
    current: usize,
}

impl<'a> LayeredTimes<'a> {
    /// Of a chunk that starts with a `record` in full, then a count, sizes of `layers`, and those; `None` where all points have the time
    /// of the first, or the chunk is too short.
    pub(super) fn open(
        chunk: &'a [u8],
        record: usize,
        layers: usize,
    ) -> Result<Option<LayeredTimes<'a>>> {
        let size = |layer: usize| {
            let bytes = chunk.get(record + 4 + 4 * layer..)?.first_chunk()?;
            usize::try_from(u32::from_le_bytes(*bytes)).ok()
        };
        let sizes: Option<Vec<usize>> = (0..LAYERS).map(size).collect();
        let Some(sizes) = sizes.filter(|sizes| sizes[LAYERS - 1] > 0) else {
            return Ok(None);
        };
        let layer = |layer: usize| {
            let start = record + 4 + 4 * layers + sizes[..layer].iter().sum::<usize>();
            chunk.get(start..start + sizes[layer])
        };
        let Some((returns, times)) = layer(0).zip(layer(LAYERS - 1)) else {
            return Ok(None);
        };
        let mut channels = from_fn(|_| None);
        let current = usize::from(chunk[CHANNEL] >> 4 & 3);
        let time = chunk[TIME..]
            .first_chunk()
            .map_or(0, |b| i64::from_le_bytes(*b));
        let [number, count] = [chunk[RETURNS] & 15, chunk[RETURNS] >> 4];
        channels[current] = Some(Box::new(Channel::new(number, count, time)));
        let mut all = LayeredTimes {
            returns: ArithmeticDecoder::new(returns),
            times: ArithmeticDecoder::new(times),
            channels,
            current,
        };
        all.returns.read_init_bytes()?;
        all.times.read_init_bytes()?;
        Ok(Some(all))
    }

    /// Puts the time of the next point, the second of the chunk first, into its record.
    pub(super) fn next(&mut self, record: &mut [u8]) -> Result<()> {
        let before = channel(&mut self.channels, self.current);
        let (number, count, time) = (before.number, before.count, before.times.now());
        let changes = self
            .returns
            .decode_symbol(&mut before.changes[before.last_return()])?;
        if changes & 64 != 0 {
            let step = self.returns.decode_symbol(&mut before.channel)?;
            self.current = (self.current + step as usize + 1) % 4;
            self.channels[self.current]
                .get_or_insert_with(|| Box::new(Channel::new(number, count, time)));
        }
        let point = channel(&mut self.channels, self.current);
        point.time_changed = changes & 16 != 0;
        point.read_returns(changes, &mut self.returns)?;
        if point.time_changed {
            point.times.next(&mut self.times)?;
        }
        if let Some(field) = record.get_mut(TIME..).and_then(<[u8]>::first_chunk_mut) {
            *field = point.times.now().to_le_bytes();
        }
        Ok(())
    }
}

/// That of a number, which is there: the first point's, and those that were switched to.
fn channel(channels: &mut [Option<Box<Channel>>; 4], number: usize) -> &mut Channel {
    channels[number].get_or_insert_with(|| Box::new(Channel::new(0, 0, 0)))
}

/// What is known of the points of one channel of the scanner, and how their next one is decoded.
struct Channel {
    /// Which return the last point is, and of how many.
    number: u8,
    count: u8,
    time_changed: bool,
    times: Times,
    changes: [ArithmeticModel; 8],
    channel: ArithmeticModel,
    counts: [Option<ArithmeticModel>; 16],
    numbers: [Option<ArithmeticModel>; 16],
    numbers_of_a_time: ArithmeticModel,
    across: IntegerDecompressor,
    along: IntegerDecompressor,
}

fn model(symbols: u32) -> ArithmeticModel {
    ArithmeticModelBuilder::new(symbols).build()
}

fn integers(contexts: u32) -> IntegerDecompressor {
    IntegerDecompressorBuilder::new()
        .bits(32)
        .contexts(contexts)
        .build_initialized()
}

impl Channel {
    fn new(number: u8, count: u8, time: i64) -> Channel {
        Channel {
            number,
            count,
            time_changed: false,
            times: Times::layered(time),
            changes: from_fn(|_| model(128)),
            channel: model(3),
            counts: from_fn(|_| None),
            numbers: from_fn(|_| None),
            numbers_of_a_time: model(13),
            across: integers(2),
            along: integers(22),
        }
    }

    /// What the last point was: the first return, the last, and whether its time had changed.
    fn last_return(&self) -> usize {
        usize::from(self.number == 1)
            + 2 * usize::from(self.number >= self.count)
            + 4 * usize::from(self.time_changed)
    }

    /// Returns of the next point, and past its coordinates.
    fn read_returns(&mut self, changes: u32, decoder: &mut ArithmeticDecoder<&[u8]>) -> Result<()> {
        let last = self.number;
        if changes & 4 != 0 {
            let counts = &mut self.counts[usize::from(self.count)];
            self.count = decoder.decode_symbol(counts.get_or_insert_with(|| model(16)))? as u8;
        }
        self.number = match changes & 3 {
            0 => last,
            1 => (last + 1) % 16,
            2 => (last + 15) % 16,
            _ if self.time_changed => {
                let numbers = &mut self.numbers[usize::from(last)];
                decoder.decode_symbol(numbers.get_or_insert_with(|| model(16)))? as u8
            }
            _ => {
                let step = decoder.decode_symbol(&mut self.numbers_of_a_time)?;
                ((u32::from(last) + step + 2) % 16) as u8
            }
        };
        // Where the values come from does not depend on what they are.
        let single = u32::from(self.count == 1);
        self.across.decompress(decoder, 0, single)?;
        let bits = self.across.k();
        let context = single + if bits < 20 { bits & !1 } else { 20 };
        self.along.decompress(decoder, 0, context)?;
        Ok(())
    }
}
