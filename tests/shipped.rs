//! The SPIR-V under `spirv/`, which hosts without a shader compiler use, equals the compiled GLSL. To renew it:
//! `WHITEWATER_SPIRV_OUT=$PWD/spirv cargo build`.
#![cfg(feature = "shaderc")]

use std::collections::BTreeMap;
use std::path::Path;

#[allow(dead_code)] // `hoisted` is the build's
#[path = "../build/uniforms.rs"]
mod uniforms;

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    std::fs::read_dir(folder)
        .unwrap_or_else(|error| panic!("{}: {error}", folder.display()))
        .map(|entry| entry.expect("readable").path())
        .filter(|path| path.extension().is_some_and(|e| e == "spv" || e == "rs"))
        .map(|path| {
            let name = path.file_name().expect("a file").to_string_lossy().into_owned();
            (name, std::fs::read(path).expect("readable"))
        })
        .collect()
}

#[test]
fn shipped_spirv_is_what_the_glsl_compiles_to() {
    let built = files(Path::new(env!("OUT_DIR")));
    let shipped = files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("spirv"));
    let renew = "renew it: WHITEWATER_SPIRV_OUT=$PWD/spirv cargo build";
    let names = |map: &BTreeMap<String, Vec<u8>>| map.keys().cloned().collect::<Vec<_>>();
    assert!(built.len() > 10, "only {} shaders were built", built.len());
    assert_eq!(names(&built), names(&shipped), "other files; {renew}");
    for (name, bytes) in &built {
        assert!(bytes == &shipped[name], "spirv/{name} is stale; {renew}");
    }
}

#[test]
fn uniforms_are_read_where_functions_begin() {
    let mut all = 0;
    for (name, bytes) in files(Path::new(env!("OUT_DIR"))) {
        if name.ends_with(".spv") {
            let words = bytes.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
            let (reads, late) = uniforms::counted(&words.collect::<Vec<_>>());
            assert_eq!(late, 0, "{name}: of {reads} reads of uniforms");
            all += reads;
        }
    }
    assert!(all > 1000, "only {all} reads of uniforms were found");
}
