//! Any bytes, with the hint that leads to this reader, and behind beginnings of its dialects.
#![no_main]

use libfuzzer_sys::fuzz_target;
use whitewater::io::particles::{Extension, read_bytes};

fuzz_target!(|data: &[u8]| {
    let _ = read_bytes(data, Extension::Csv);
    let _ =
        read_bytes(&[&b"Pos.x [m];Pos.y [m];Pos.z [m];Idp;\n"[..], data].concat(), Extension::Csv);
});
