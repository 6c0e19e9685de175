//! Any bytes, with the hint that leads to this reader.
#![no_main]

use libfuzzer_sys::fuzz_target;
use whitewater::io::particles::{Extension, read_bytes};

fuzz_target!(|data: &[u8]| {
    let _ = read_bytes(data, Extension::Unknown);
});
