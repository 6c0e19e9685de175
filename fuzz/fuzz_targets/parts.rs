//! Files that are read in parts: the same particles as those that are read at once, or a fault in both.
#![no_main]

use libfuzzer_sys::fuzz_target;
use whitewater::io::particles::{Extension, Particles, Parts, read_bytes};

/// Beginnings that lead to the formats which are read in parts.
const MAGIC: [&[u8]; 5] =
    [b"", b"BgeoV\0\0\0\x05", b"ply\nformat binary_", b"\x93NUMPY\x01\0", b"PK\x03\x04"];

/// Position after position, as bits: no NaN is equal to itself.
fn bits<'a>(particles: impl Iterator<Item = &'a Particles>) -> Vec<u32> {
    particles.flat_map(|p| p.positions.as_flattened()).map(|x| x.to_bits()).collect()
}

fuzz_target!(|data: &[u8]| {
    let Some((size, data)) = data.split_first() else { return };
    for magic in MAGIC {
        let bytes = [magic, data].concat();
        let whole = read_bytes(&bytes, Extension::Unknown);
        let parts = Parts::of_bytes(&bytes, Extension::Unknown, usize::from(*size));
        match (whole, parts) {
            (Err(_), Err(_)) => {}
            (Ok(whole), Ok(parts)) => {
                let about = parts.about().clone();
                assert_eq!(about.warnings, whole.warnings);
                assert_eq!(about.attributes, whole.attributes);
                assert_eq!(parts.total(), whole.positions.len());
                let parts = parts.collect::<Result<Vec<_>, _>>().expect("faults are found first");
                assert_eq!(bits(std::iter::once(&whole)), bits(parts.iter()));
                let ids = parts.iter().flat_map(|p| p.ids.iter().flatten()).copied();
                assert_eq!(whole.ids.unwrap_or_default(), ids.collect::<Vec<_>>());
                let kinds = parts.iter().flat_map(|p| p.kinds.iter().flatten()).copied();
                assert_eq!(whole.kinds.unwrap_or_default(), kinds.collect::<Vec<_>>());
            }
            (whole, parts) => panic!("{:?} but in parts {:?}", whole.err(), parts.err()),
        }
    }
});
