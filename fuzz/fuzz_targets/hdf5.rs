//! Bytes behind the beginning that makes a file this format. Give it `tests/formats/hdf5` as a corpus: what is random has no
//! tree of groups.
#![no_main]

use libfuzzer_sys::fuzz_target;
use whitewater::io::particles::{Extension, read_bytes};

fuzz_target!(|data: &[u8]| {
    let _ = read_bytes(data, Extension::Unknown);
    let _ = read_bytes(&[&b"\x89HDF\r\n\x1a\n\0"[..], data].concat(), Extension::Unknown);
});
