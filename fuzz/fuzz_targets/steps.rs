//! Files of several frames: each of them is read, or says why not.
#![no_main]

use std::path::PathBuf;

use libfuzzer_sys::fuzz_target;
use whitewater::io::particles::{read_step, steps};

/// Beginnings that lead to several frames, and the extensions that go with them.
const STARTS: [(&[u8], &str); 10] = [
    (b"1\nTime=0\n0 0 0\n1\nTime=1\n", "xyz"),
    (b"time,x,y,z\n0,1,2,3\n0,1,2,4\n1,", "csv"),
    (b"ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS id x y z\n1 2 3 4\nITEM: TIMESTEP\n", "dump"),
    (b"VARIABLES = x, y, z\nZONE T=\"1\"\n0 0 0\nZONE ", "dat"),
    (b"[[[0,1,2],[3,4,5]],", "json"),
    (b"{\"frame_1\":[[0,1,2]],\"frame_2\":", "json"),
    (b"\x93NUMPY\x01\x00\x3f\x00{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2, 3), }\n", "npy"),
    (b"x y z\n0 0 0\n1 0 0\n2 0 1\n\n\n0 1 0\n1 1 0\n2 1 1\n", "dat"),
    (b"# x y z\n# t = 0\n0 0 0\n# t = 1\n", "txt"),
    (b"", "xyz"),
];

fuzz_target!(|data: &[u8]| {
    for (start, extension) in STARTS {
        let path: PathBuf =
            std::env::temp_dir().join(format!("steps-{}.{extension}", std::process::id()));
        std::fs::write(&path, [start, data].concat()).expect("a file");
        for step in steps(&path).unwrap_or_default().into_iter().take(16) {
            let _ = read_step(&path, step, &["time"]);
        }
    }
});
