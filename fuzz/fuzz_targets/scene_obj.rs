//! A scene as Wavefront OBJ: any bytes.
#![no_main]

use libfuzzer_sys::fuzz_target;
use whitewater::headless::scene::Scene;

fuzz_target!(|data: &[u8]| {
    let _ = Scene::parse_obj(data);
});
