//! Texts that name arrays, of which none is there but those in the text.
#![no_main]

use std::path::PathBuf;

use libfuzzer_sys::fuzz_target;
use whitewater::io::particles::{read, steps};

const START: &[u8] = b"<Xdmf><Domain><Grid><Geometry><DataItem Dimensions=\"2 3\">";

fuzz_target!(|data: &[u8]| {
    let path: PathBuf = std::env::temp_dir().join(format!("{}.xmf", std::process::id()));
    for start in [&b""[..], START] {
        std::fs::write(&path, [start, data].concat()).expect("a file");
        let _ = steps(&path);
        let _ = read(&path);
    }
});
