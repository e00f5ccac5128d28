//! Morton codes: the bits of three coordinates interleaved, so that what is close in space is mostly close in order.

use glam::Vec3;

/// Bits an axis of a Morton key; three axes fit in 63 bits.
pub const MAX_DEPTH: u32 = 21;

/// Interleaved bits of a position of the unit frame (every coordinate within ±0.5).
pub(crate) fn morton(p: Vec3) -> u64 {
    let cell =
        |x: f32| (((x as f64 + 0.5) * (1u64 << MAX_DEPTH) as f64) as u64).min((1 << MAX_DEPTH) - 1);
    interleave([cell(p.x), cell(p.y), cell(p.z)])
}

/// The Morton code of a cell: the 21 low bits of its coordinates, interleaved.
pub(crate) fn interleave([x, y, z]: [u64; 3]) -> u64 {
    spread(x) << 2 | spread(y) << 1 | spread(z)
}

/// Two zero bits behind each of the 21 low bits.
fn spread(x: u64) -> u64 {
    let x = (x | x << 32) & 0x001F_0000_0000_FFFF;
    let x = (x | x << 16) & 0x001F_0000_FF00_00FF;
    let x = (x | x << 8) & 0x100F_00F0_0F00_F00F;
    let x = (x | x << 4) & 0x10C3_0C30_C30C_30C3;
    (x | x << 2) & 0x1249_2492_4924_9249
}
