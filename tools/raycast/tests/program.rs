//! The program: its pictures, its tables and its exit codes.

use std::path::Path;
use std::process::{Command, Output};

fn run(arguments: &[&str], folder: &Path) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_whitewater-raycast"));
    program.args(arguments).current_dir(folder).output().expect("it starts")
}

fn out(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn draws_a_picture_and_prints_times() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut pictures = Vec::new();
    for method in ["kernel", "grid", "plain"] {
        let name = format!("{method}.png");
        let arguments =
            ["--particles", "2000", "--size", "96x64", "--step", "0.1", "--repeat", "1"];
        let more = ["--method", method, "--timings", "-o", &name];
        let output = run(&[&arguments[..], &more].concat(), folder.path());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let own = if method == "plain" { "sort" } else { "tiles" };
        for pass in ["prepare", own, "count", "scan", "march", "resolve", "memory"] {
            assert!(out(&output).lines().any(|line| line.starts_with(pass)), "{}", out(&output));
        }
        let picture = image::open(folder.path().join(&name)).expect("a PNG").into_luma8();
        assert_eq!(picture.dimensions(), (96, 64));
        // The sky is empty, the crest is not.
        let row = |y: u32| (0..96).map(|x| u32::from(picture.get_pixel(x, y)[0])).sum::<u32>();
        assert!(row(0) == 0 && row(28) > 96 * 30, "{} {}", row(0), row(28));
        pictures.push(picture);
    }
    let apart = pictures[0].iter().zip(pictures[1].iter()).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(apart < Some(16), "{apart:?} of 255");
    let apart = pictures[0].iter().zip(pictures[2].iter()).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(apart < Some(2), "{apart:?} of 255");
}

#[test]
fn compares_all_with_whitewater() {
    let folder = tempfile::tempdir().expect("a folder");
    let arguments = ["compare", "--particles", "3000", "--size", "96x64", "--repeat", "1"];
    let output = run(&[&arguments[..], &["--pictures", "p"]].concat(), folder.path());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = out(&output);
    let row = |name: &str| -> Vec<f64> {
        let line = text.lines().find(|line| line.starts_with(name)).expect(name);
        let words = line[32..].split_whitespace().map(|word| word.trim_end_matches('x'));
        words.map_while(|word| word.parse().ok()).collect()
    };
    let apart: Vec<f64> =
        text.lines().filter_map(|line| line.split_once("mean FLIP ")?.1.parse().ok()).collect();
    // The sea cuts some balls. A ray counts only the part in front of it; a sprite counts in full if its front is
    // visible. Few and large particles show that. Both ray-casters have the same difference.
    assert!(apart.len() == 2 && apart.iter().all(|flip| *flip < 0.1), "{text}");
    assert!((apart[0] - apart[1]).abs() < 0.005, "{text}");
    let ours = ["ours, intensity", "ours, total"].map(|name| row(name)[0]);
    // As near to the converged picture as whitewater's; four digits are printed.
    let rows = [("kernel", apart[0]), ("grid", apart[1]), ("plain", apart[0])];
    let names = rows.into_iter().flat_map(|(name, near)| {
        let name = format!("ray-casting, {name}");
        [(name.clone(), 0.02), (format!("{name}, equal"), near.max(0.002) + 0.0001)]
    });
    for (name, most) in names {
        let [step, ms, intensity, total, flip, memory] = row(&name)[..] else {
            panic!("{name}: {text}");
        };
        assert!(step > 0.0 && ms > 0.0 && flip <= most && memory > 0.0, "{text}");
        for (ratio, ours) in [(intensity, ours[0]), (total, ours[1])] {
            // Times and ratios are printed to hundredths.
            let (least, most) = ((ms - 0.005) / (ours + 0.005), (ms + 0.005) / (ours - 0.005));
            assert!(ratio > least - 0.0051 && (ours < 0.01 || ratio < most + 0.0051), "{text}");
        }
    }
    for nearness in ["", ", equal"] {
        let step = |method| row(&format!("ray-casting, {method}{nearness}"))[0];
        assert_eq!(step("plain"), step("kernel"), "{text}");
    }
    for name in
        ["ours", "kernel-converged", "kernel-step", "grid-converged", "grid-step", "plain-step"]
    {
        assert!(folder.path().join(format!("p/{name}.png")).is_file(), "{name}");
    }
}

#[test]
fn ends_by_what_went_wrong() {
    let folder = tempfile::tempdir().expect("a folder");
    let small = ["--particles", "10"];
    for (arguments, code, part) in [
        (&["--no-such"][..], 2, "--no-such"),
        (&["--size", "0x8", "--timings"], 2, "800x600"),
        (&["--sea", "pond", "--timings"], 2, "wave, ship"),
        (&["--method", "other", "--timings"], 2, "kernel"),
        (&["--step=-1", "--timings"], 2, "--step: -1"),
        (&["--step", "NaN", "--size", "8x8", "--timings"], 2, "expected"),
        (&["--tile", "5", "--timings"], 2, "--tile: 5: 4, 8 or 16"),
        (&["--cell", "0.5", "--timings"], 2, "--cell: 0.5: from 1 to 16"),
        (&[], 2, "-o OUT.png"),
        (&["--size", "8x8", "-o", "no/such/folder.png"], 1, "no/such/folder.png"),
        (&["--device", "no such device", "--timings"], 1, "no such device"),
    ] {
        let output = run(&[&small[..], arguments].concat(), folder.path());
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {text}");
        assert!(text.contains(part), "{arguments:?}: {text}");
    }
}
