//! A scene as glTF: text, bytes behind the beginning of a binary file, and JSON in its first chunk.
#![no_main]

use libfuzzer_sys::fuzz_target;
use whitewater::headless::scene::Scene;

fuzz_target!(|data: &[u8]| {
    let _ = Scene::parse_glb(data);
    let _ = Scene::parse_glb(&[&b"glTF\x02\0\0\0\0\0\0\0"[..], data].concat());
    // What is left over is the second chunk.
    let text = data.iter().position(|b| *b == 0).unwrap_or(data.len());
    let mut bytes = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, chunk) in [(b"JSON", &data[..text]), (b"BIN\0", &data[text..])] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    let _ = Scene::parse_glb(&bytes);
});
