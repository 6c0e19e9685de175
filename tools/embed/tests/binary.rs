//! Runs the program as a user does: it is silent under validation, and its picture shows water.

#[path = "../../../tests/support/skipped.rs"]
mod skipped;

use std::process::Command;

#[test]
fn draws_water_and_is_silent() {
    let folder = std::env::temp_dir().join(format!("whitewater-embed-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let picture = folder.join("embed.ppm");
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_whitewater-embed"));
        let output = command.args(arguments).arg(&picture).output().expect("the program starts");
        let [out, err] = [&output.stdout, &output.stderr].map(|t| String::from_utf8_lossy(t));
        (output.status.success(), out.into_owned(), err.into_owned())
    };
    let mut result = run(&["--validate"]);
    let required = std::env::var("WHITEWATER_REQUIRE_VALIDATION").is_ok_and(|value| value == "1");
    if !result.0 && result.2.contains("ERROR_LAYER_NOT_PRESENT") && !required {
        skipped::skipped("validation: VK_LAYER_KHRONOS_validation is not installed");
        result = run(&[]);
    }
    let (success, out, err) = result;
    assert!(success, "{err}");
    assert_eq!(err, "");
    for pass in ["depth", "smooth", "thickness", "composite"] {
        assert!(out.lines().any(|line| line.starts_with(pass)), "no time of {pass} in\n{out}");
    }

    let bytes = std::fs::read(&picture).expect("the picture is there");
    let pixels = bytes.strip_prefix(b"P6 960 540 255\n").expect("the header of a PPM");
    assert_eq!(pixels.len(), 960 * 540 * 3);
    // The host's scene has one colour; pixels that differ from it are water.
    let water = pixels.chunks(3).filter(|pixel| *pixel != &pixels[..3]).count();
    assert!((960 * 540 / 10..960 * 540 / 2).contains(&water), "{water} pixels of water");
    std::fs::remove_dir_all(&folder).expect("the temporary folder can go");
}

/// A mistyped option is no name of a picture.
#[test]
fn unknown_options_are_refused() {
    for arguments in [&["--validat"][..], &["--help"], &["a.ppm", "b.ppm"]] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_whitewater-embed"));
        let output = command.args(arguments).output().expect("the program starts");
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && told.contains("usage: "), "{arguments:?}: {told}");
    }
}
