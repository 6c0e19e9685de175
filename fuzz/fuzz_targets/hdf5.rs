//! HDF5 files: the input as it is, with its length mended, and behind the format's signature. Random bytes contain no
//! groups, so start from the samples. libFuzzer writes new inputs to the first folder and only reads the second:
//! `cargo +nightly fuzz run hdf5 fuzz/corpus/hdf5 tests/formats/hdf5`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use whitewater::io::particles::{Extension, read_bytes};

/// Writes the file's true length into its header, of versions 0 and 1. Without that the reader would refuse each file
/// that the fuzzer has shortened, and read no further. Later versions have a checksum, and stay as they are.
fn whole(mut bytes: Vec<u8>) -> Vec<u8> {
    let length = (bytes.len() as u64).to_le_bytes();
    let at = match bytes.get(8) {
        Some(0) => 40,
        Some(1) => 44,
        _ => return bytes,
    };
    if let Some(end) = bytes.get_mut(at..at + 8) {
        end.copy_from_slice(&length);
    }
    bytes
}

fuzz_target!(|data: &[u8]| {
    let _ = read_bytes(data, Extension::Unknown);
    let _ = read_bytes(&whole(data.to_vec()), Extension::Unknown);
    let _ = read_bytes(&[&b"\x89HDF\r\n\x1a\n\0"[..], data].concat(), Extension::Unknown);
});
