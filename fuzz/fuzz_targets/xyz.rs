//! Any bytes, with the hint that leads to this reader, and behind beginnings of its dialects.
#![no_main]

use libfuzzer_sys::fuzz_target;
use whitewater::io::particles::{Extension, read_bytes};

fuzz_target!(|data: &[u8]| {
    let _ = read_bytes(data, Extension::Xyz);
    let _ = read_bytes(&[&b"3\nProperties=pos:R:3:id:I:1\n"[..], data].concat(), Extension::Xyz);
    let _ = read_bytes(&[&b"# 1:x 2:y 3:"[..], data].concat(), Extension::Xyz);
    let _ = read_bytes(&[&b"# $1 = x\n# $2 = y\n# $3"[..], data].concat(), Extension::Xyz);
    let _ = read_bytes(
        &[&b"ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n3\nITEM: ATOMS "[..], data].concat(),
        Extension::Unknown,
    );
    let boxed = b"ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS ";
    let _ = read_bytes(&[&boxed[..], data].concat(), Extension::Unknown);
});
