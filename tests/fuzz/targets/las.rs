#![no_main]

#[path = "../check.rs"]
mod check;

use pointweave::formats::Format;
use std::sync::Once;

/// Panics of the crates for LAZ and E57 are caught and become errors; one that is not still ends the run.
static QUIET: Once = Once::new();

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    QUIET.call_once(|| std::panic::set_hook(Box::new(|_| {})));
    check::check(bytes, &[Format::Las]);
});
