//! Bytes behind the beginning that makes a file this format, so that no run is spent on finding it.
#![no_main]

use libfuzzer_sys::fuzz_target;
use whitewater::io::particles::{Extension, read_bytes};

fuzz_target!(|data: &[u8]| {
    let _ = read_bytes(data, Extension::Json);
    for start in [
        "[",
        "[{\"x\":1,\"y\":2,\"z\":",
        "{\"particles\":[{\"position\":[",
        "{\"meta\":{\"dt\":1},\"frame\":{\"fluid\":{\"positions\":[",
        "{\"columns\":[\"x\",\"y\",\"z\"],\"data\":[",
    ] {
        let _ = read_bytes(&[start.as_bytes(), data].concat(), Extension::Json);
    }
});
