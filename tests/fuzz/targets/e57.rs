#![no_main]

#[path = "../check.rs"]
mod check;

use pointweave::formats::Format;
use std::sync::Once;

/// Panics of the crates for LAZ and E57 are caught and become errors; one that is not still ends the run.
static QUIET: Once = Once::new();

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    QUIET.call_once(|| std::panic::set_hook(Box::new(|_| {})));
    check::check(bytes, &[Format::E57]);
    // With checksums that are right, damage gets past the pages.
    let mut mended = bytes.to_vec();
    mended.truncate(bytes.len() / 1024 * 1024);
    for page in mended.chunks_exact_mut(1024) {
        let (content, checksum) = page.split_at_mut(1020);
        checksum.copy_from_slice(&crc32c(content).to_be_bytes());
    }
    check::check(&mended, &[Format::E57]);
});

/// CRC-32C (Castagnoli), bit by bit.
fn crc32c(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc: u32, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| {
            (crc >> 1) ^ (0x82f6_3b78 & (0u32.wrapping_sub(crc & 1)))
        })
    })
}
