//! A scene as the project's own JSON: any bytes, and what may stand in its lists.
#![no_main]

use libfuzzer_sys::fuzz_target;
use whitewater::headless::scene::Scene;

fuzz_target!(|data: &[u8]| {
    let _ = Scene::parse_json(data);
    for list in ["boxes", "cylinders", "spheres", "motion"] {
        let head = format!("{{\"{list}\":[");
        let _ = Scene::parse_json(&[head.as_bytes(), data, b"]}"].concat());
    }
});
