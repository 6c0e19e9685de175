//! Bytes behind the beginning that makes a file this format, so that no run is spent on finding it.
#![no_main]

use libfuzzer_sys::fuzz_target;
use whitewater::io::particles::{Extension, read_bytes};

fuzz_target!(|data: &[u8]| {
    let _ = read_bytes(data, Extension::Npy);
    let _ = read_bytes(&[&b"\x93NUMPY"[..], data].concat(), Extension::Npy);
    let structured = b"\x93NUMPY\x01\0\x80\0{'fortran_order': False, 'shape': (3,), 'descr': [('pos', '<f4', (3,)), ";
    let _ = read_bytes(&[&structured[..], data].concat(), Extension::Npy);
});
