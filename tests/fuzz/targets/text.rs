#![no_main]

#[path = "../check.rs"]
mod check;

use pointweave::formats::Format;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    check::check(bytes, &[Format::Ptx, Format::Grid, Format::Splat]);
});
