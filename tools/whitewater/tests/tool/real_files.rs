//! What people have: other axes and units, files that do not fit each other, and what is said of them.

use super::support::{Folder, SMALL};

/// Water that slopes from a wall on the left down to a floor, which it falls to: positions and velocities, y up.
fn slope() -> Vec<[[f32; 3]; 2]> {
    let cells = (0..24).flat_map(|x| (0..12).flat_map(move |y| (0..10).map(move |z| (x, y, z))));
    let wet = cells.filter(|(x, y, _)| *y as f32 <= 11.0 - 0.5 * *x as f32);
    wet.map(|(x, y, z)| [[x, y, z].map(|i| 0.05 * i as f32), [2.4, -1.5, 0.0]]).collect()
}

/// As CSV, its vectors made others.
fn csv(particles: &[[[f32; 3]; 2]], other: impl Fn([f32; 3]) -> [f32; 3]) -> String {
    let mut rows = String::from("x,y,z,vx,vy,vz\n");
    for [p, v] in particles {
        let ([x, y, z], [u, v, w]) = (other(*p), other(*v));
        rows += &format!("{x},{y},{z},{u},{v},{w}\n");
    }
    rows
}

/// Files in which z is up are told by how the water lies, and drawn as if it were said; what is said goes first.
#[test]
fn the_axis_that_is_up_is_found() {
    let folder = Folder::new();
    folder.text("y.csv", &csv(&slope(), |p| p));
    folder.text("z.csv", &csv(&slope(), |[x, y, z]| [x, -z, y]));
    let run = |file: &str, more: &str| {
        let out = format!("{file}{}.exr", more.replace([' ', '-'], ""));
        let command = format!("render {file}.csv -o {out} {SMALL} --layers water.depth {more}");
        folder.run(&command).ok().stderr()
    };
    let said = run("z", "");
    assert_eq!(said.matches("z is up in the files: the water lies").count(), 1, "{said}");
    for (file, more) in [("y", ""), ("z", "--up-axis z"), ("z", "--up-axis y")] {
        let said = run(file, more);
        assert!(!said.contains("z is up"), "{file} {more}: {said}");
    }
    folder.run("compare z.exr zupaxisz.exr").ok();
    folder.run("compare z.exr y.exr --tolerance 1e-4").ok();
    folder.run("compare z.exr zupaxisy.exr --tolerance 1e-3").fails(1, &["RMSE"]);
    let text = folder.run("info z.csv").ok().stdout();
    assert!(text.contains("up          z: the water lies"), "{text}");
}

/// Millimetres are told by speeds that no water of that size has; with their unit the picture is that of metres.
#[test]
fn files_in_millimetres_are_told_and_drawn_in_metres() {
    let folder = Folder::new();
    folder.text("m.csv", &csv(&slope(), |p| p));
    folder.text("mm.csv", &csv(&slope(), |p| p.map(|c| 1000.0 * c)));
    let run = |file: &str, out: &str, more: &str| {
        let common = format!("{SMALL} --radius 0.025 --foam none");
        folder.run(&format!("render {file}.csv -o {out}.png {common} {more}")).ok().stderr()
    };
    let plain = run("m", "m", "");
    assert!(!plain.contains("spans"), "{plain}");
    let said = run("mm", "raw", "");
    assert!(said.contains("spans 1100 metres") && said.contains("--unit mm fits"), "{said}");
    for (out, more) in [("unit", "--unit mm"), ("scale", "--scale 0.001")] {
        let said = run("mm", out, more);
        assert!(!said.contains("spans"), "{said}");
        // A thousandth of a thousand times a length is not it to the last bit.
        folder.run(&format!("compare m.png {out}.png --tolerance 0.01")).ok();
    }
    folder.run("compare m.png raw.png --tolerance 0.02").fails(1, &["RMSE"]);
    folder.run("render m.csv -o a.exr --unit mm --scale 2").fails_at_once();
    folder.run("render m.csv -o a.exr --scale 0").fails_at_once();
}

/// Diffuse particles of other numbers than the water's are an error, those of some frames are told, and how many are drawn.
#[test]
fn whitewater_files_that_do_not_fit_are_told() {
    let folder = Folder::new();
    for frame in [10, 11] {
        folder.text(&format!("f_{frame}.csv"), &csv(&slope(), |p| p));
    }
    for (name, count) in [("a_0", 1), ("a_1", 1), ("b_10", 3), ("b_12", 1)] {
        folder.particles(&format!("{name}.ply"), vec![[0.5, 0.5, 0.2]; count]);
    }
    let common = format!("render f_%d.csv {SMALL} --layers none --foam none --whitewater");
    folder
        .run(&format!("{common} foam=a_*.ply -o a.png"))
        .fails(3, &["frames 10 to 11", "2 files of the numbers 0 to 1", "a_0.ply"]);
    let said = folder.run(&format!("{common} foam=b_*.ply -o b.png")).ok().stderr();
    for part in
        ["1 of 2 frames, from 11 on", "particles, 3 diffuse particles", "particles, 0 diffuse"]
    {
        assert!(said.contains(part), "{part}: {said}");
    }
    // A pattern of another program, and one that is padded as the files are not.
    for (pattern, parts) in [
        ("f_{}.csv", ["no such file", "'f_%d.csv'"]),
        ("f_####.csv", ["no such file", "'f_%d.csv'"]),
        ("f_%04d.csv", ["no file fits", "2 files fit 'f_%d.csv'"]),
    ] {
        folder.run(&format!("render {pattern} -o c.png")).fails(3, &parts);
    }
    folder.run(&format!("{common} foam=b_%04d.ply -o d.png")).fails(3, &["2 files fit 'b_%d.ply'"]);
}
