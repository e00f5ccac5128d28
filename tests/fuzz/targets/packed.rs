#![no_main]

#[path = "../check.rs"]
mod check;

use pointweave::formats::{Archive, Format};
use std::sync::Once;

/// Panics of the crate for TIFF are caught and become errors; one that is not still ends the run.
static QUIET: Once = Once::new();

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    QUIET.call_once(|| std::panic::set_hook(Box::new(|_| {})));
    check::check(bytes, &[Format::Tiff, Format::ThreeMf, Format::Spz]);
    if let Ok(archive) = Archive::open(bytes, None) {
        for entry in archive.entries.iter().take(16) {
            let _ = archive.unpack(entry);
        }
    }
});
