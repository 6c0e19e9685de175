//! Files as users have them: with other axes and units, or that do not fit together, and the messages about them.

use super::support::{Folder, SIZE, SMALL, block};

/// Water that slopes down from a wall on the left to a floor, and falls towards it: positions and velocities, y up.
fn slope() -> Vec<[[f32; 3]; 2]> {
    let cells = (0..24).flat_map(|x| (0..12).flat_map(move |y| (0..10).map(move |z| (x, y, z))));
    let wet = cells.filter(|(x, y, _)| *y as f32 <= 11.0 - 0.5 * *x as f32);
    wet.map(|(x, y, z)| [[x, y, z].map(|i| 0.05 * i as f32), [2.4, -1.5, 0.0]]).collect()
}

/// CSV text of the particles, with `other` applied to all vectors.
fn csv(particles: &[[[f32; 3]; 2]], other: impl Fn([f32; 3]) -> [f32; 3]) -> String {
    let mut rows = String::from("x,y,z,vx,vy,vz\n");
    for [p, v] in particles {
        let ([x, y, z], [u, v, w]) = (other(*p), other(*v));
        rows += &format!("{x},{y},{z},{u},{v},{w}\n");
    }
    rows
}

/// In files with z up the water's shape shows the axis, and they are drawn as with `--up-axis z`. The option overrides
/// what is found.
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
    assert!(text.contains("up          z, clear: the water lies"), "{text}");
    let text = folder.run("info y.csv").ok().stdout();
    assert!(text.contains("up          y, clear: the water lies"), "{text}");
}

/// Files whose up axis points down are detected too, and drawn the right way up. A dam on its side follows `--up-axis`.
#[test]
fn files_that_hang_are_turned() {
    let folder = Folder::new();
    folder.text("y.csv", &csv(&slope(), |p| p));
    folder.text("down.csv", &csv(&slope(), |[x, y, z]| [x, -y, -z]));
    folder.text("deep.csv", &csv(&slope(), |[x, y, z]| [x, z, -y]));
    folder.text("side.csv", &csv(&slope(), |[x, y, z]| [y, -x, z]));
    folder.text("other.csv", &csv(&slope(), |[x, y, z]| [-y, x, z]));
    let run = |file: &str, out: &str, more: &str| {
        let command = format!("render {file}.csv -o {out}.exr {SMALL} --layers water.depth {more}");
        folder.run(&command).ok().stderr()
    };
    run("y", "y", "");
    for (file, axis) in [("down", "-y"), ("deep", "-z")] {
        let said = run(file, file, "");
        assert!(said.contains(&format!("{axis} is up in the files: the water lies")), "{said}");
        let text = folder.run(&format!("info {file}.csv")).ok().stdout();
        assert!(text.contains(&format!("up          {axis}, clear: the water lies")), "{text}");
    }
    for (file, axis) in [("side", "x"), ("other", "-x"), ("down", "-y"), ("deep", "-z")] {
        let out = format!("{file}_said");
        let said = run(file, &out, &format!("--up-axis {axis}"));
        assert!(!said.contains("is up in the files"), "{said}");
        folder.run(&format!("compare y.exr {out}.exr --tolerance 1e-4")).ok();
    }
    for file in ["down", "deep"] {
        folder.run(&format!("compare {file}.exr {file}_said.exr")).ok();
    }
    run("down", "as_it_is", "--up-axis y");
    folder.run("compare y.exr as_it_is.exr --tolerance 1e-3").fails(1, &["RMSE"]);
}

/// Files in millimetres are reported because water of that size cannot have these speeds. With `--unit` the picture
/// equals that in metres.
#[test]
fn files_in_millimetres_are_told_and_drawn_in_metres() {
    let folder = Folder::new();
    folder.text("m.csv", &csv(&slope(), |p| p));
    folder.text("mm.csv", &csv(&slope(), |p| p.map(|c| 1000.0 * c)));
    let run = |file: &str, out: &str, more: &str| {
        let common = format!("{SMALL} --radius 0.025 --surface-foam none");
        folder.run(&format!("render {file}.csv -o {out}.png {common} {more}")).ok().stderr()
    };
    let plain = run("m", "m", "");
    assert!(!plain.contains("spans"), "{plain}");
    let said = run("mm", "raw", "");
    assert!(said.contains("spans 1100 metres") && said.contains("--unit mm fits"), "{said}");
    for (out, more) in [("unit", "--unit mm"), ("scale", "--scale 0.001")] {
        let said = run("mm", out, more);
        assert!(!said.contains("spans"), "{said}");
        // Scaling to millimetres and back rounds, so the pictures may differ slightly.
        folder.run(&format!("compare m.png {out}.png --tolerance 0.01")).ok();
    }
    folder.run("compare m.png raw.png --tolerance 0.02").fails(1, &["RMSE"]);
    folder.run("render m.csv -o a.exr --unit mm --scale 2").fails_at_once();
    folder.run("render m.csv -o a.exr --scale 0").fails_at_once();
}

/// Whitewater files whose frame numbers do not match the water's are an error. If only some are missing, a message says
/// how many frames are drawn without.
#[test]
fn whitewater_files_that_do_not_fit_are_told() {
    let folder = Folder::new();
    for frame in [10, 11] {
        folder.text(&format!("f_{frame}.csv"), &csv(&slope(), |p| p));
    }
    for (name, count) in [("a_0", 1), ("a_1", 1), ("b_10", 3), ("b_12", 1)] {
        folder.particles(&format!("{name}.ply"), vec![[0.5, 0.5, 0.2]; count]);
    }
    let common = format!("render f_%d.csv {SMALL} --layers none --surface-foam none --whitewater");
    folder
        .run(&format!("{common} foam=a_*.ply -o a.png"))
        .fails(3, &["frames 10 to 11", "2 files of the numbers 0 to 1", "a_0.ply"]);
    let said = folder.run(&format!("{common} foam=b_*.ply -o b.png")).ok().stderr();
    for part in [
        "1 of 2 frames, from 11 on",
        "particles, 3 whitewater particles",
        "particles, 0 whitewater",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    // A pattern of another program, and one with a different padding than the files.
    for (pattern, parts) in [
        ("f_{}.csv", ["no such file", "'f_%d.csv'"]),
        ("f_####.csv", ["no such file", "'f_%d.csv'"]),
        ("f_%04d.csv", ["no file fits", "2 files fit 'f_%d.csv'"]),
    ] {
        folder.run(&format!("render {pattern} -o c.png")).fails(3, &parts);
    }
    folder.run(&format!("{common} foam=b_%04d.ply -o d.png")).fails(3, &["2 files fit 'b_%d.ply'"]);
}

/// Walls in the water's files are reported, and left out by --where; the picture is then that of the water alone.
#[test]
fn walls_are_told_and_left_out() {
    let folder = Folder::new();
    let mut rows = String::from("Type,Idp,x,y,z,vx,vy,vz\n");
    let water: Vec<_> = slope();
    let mut alone = String::from("x,y,z,vx,vy,vz\n");
    for (i, [[x, y, z], [u, v, w]]) in water.iter().enumerate() {
        rows += &format!("3,{i},{x},{y},{z},{u},{v},{w}\n");
        alone += &format!("{x},{y},{z},{u},{v},{w}\n");
    }
    for i in 0..400 {
        let [x, z] = [i % 20, i / 20].map(|i| 0.1 * i as f32 - 0.4);
        rows += &format!("0,{},{x},-0.05,{z},0,0,0\n", 5000 + i);
    }
    folder.text("all.csv", &rows);
    folder.text("water.csv", &alone);
    let run = |file: &str, more: &str, out: &str| {
        let common = format!("{SMALL} --radius 0.025 --layers water.depth");
        folder.run(&format!("render {file}.csv -o {out}.exr {common} {more}")).ok().stderr()
    };
    let said = run("all", "", "all");
    let expected = format!(
        "attribute `Type` has the values 0 (400 particles) and 3 ({} particles), all drawn as one water",
        water.len()
    );
    assert_eq!(said.matches(&expected).count(), 1, "{said}");
    assert!(said.contains("--where 'Type=3'"), "what moves: {said}");
    let plain = run("water", "", "water");
    for (out, more) in [("is", "--where type=3"), ("more", "--where Type>1 --where Idp<4999")] {
        let said = run("all", more, out);
        assert!(!said.contains("attribute `Type`"), "{said}");
        assert!(said.contains(&format!("{} particles", water.len())), "{said}");
        folder.run(&format!("compare water.exr {out}.exr")).ok();
    }
    folder.run("compare water.exr all.exr --tolerance 1e-3").fails(1, &["RMSE"]);
    assert!(!plain.contains("attribute"), "{plain}");
    let text = folder.run("info all.csv").ok().stdout();
    assert!(text.contains("values      Type: 0 (400 particles, all at rest: walls?), 3"), "{text}");
    let fails = |more: &str, parts: &[&str]| {
        folder.run(&format!("render all.csv -o a.png {more}")).fails(3, parts);
    };
    fails("--where phase=1", &["--where 'phase=1'", "attribute `phase`", "Idp"]);
    fails("--where Type=2", &["none", "values are 0 and 3"]);
    folder.run("render all.csv -o a.png --where Type~3").fails_at_once();
}

/// A column called only `r` may be radii or a distance: what it is taken for is told, and `--radius r` decides.
#[test]
fn a_column_r_is_radii_or_told() {
    let folder = Folder::new();
    let table = |name: &str, r: &dyn Fn([f32; 3]) -> f32| {
        let mut rows = String::from("x,y,z,r\n");
        for [p, _] in slope() {
            rows += &format!("{},{},{},{}\n", p[0], p[1], p[2], r(p));
        }
        folder.text(name, &rows);
    };
    table("radii.csv", &|p| if p[2] > 0.3 { 0.028 } else { 0.031 });
    table("away.csv", &|p| 0.001 + (p[0] - 0.1).hypot(p[2] + 0.2));
    let said = |command: &str| folder.run(&format!("{command} {SMALL}")).ok().stderr();
    let text = said("render radii.csv -o a.png");
    let part = "radius 0.031 (attribute `r` of the files, which fits their spacing; they go from 0.028 to 0.031";
    assert!(text.contains(part), "{text}");
    let text = said("render away.csv -o b.png");
    for part in [
        "(estimated; --radius",
        "attribute `r` is not taken as radii: its median",
        "--radius r takes",
    ] {
        assert!(text.contains(part), "{text}");
    }
    let text = said("render away.csv -o c.png --radius R");
    assert!(text.contains("(attribute `R` of the files; they go from"), "{text}");
    let text = said("render away.csv -o d.png --radius 0.03");
    assert!(!text.contains("attribute `r`"), "{text}");
    folder
        .run(&format!("render away.csv -o e.png --radius size {SMALL}"))
        .fails(3, &["expected an attribute `size`", "x, y, z, r"]);
    folder.run("render away.csv -o e.png --radius 0.03m").fails_at_once();
    let text = folder.run("info radii.csv").ok().stdout();
    for part in ["r (number x 1): radius", "radii       0.028000 to 0.031000"] {
        assert!(text.contains(part), "{text}");
    }
    let text = folder.run("info away.csv").ok().stdout();
    for part in ["r (number x 1): not used", "warning     attribute `r` is not taken as radii"] {
        assert!(text.contains(part), "{text}");
    }
}

/// Radii in the files are used, and copies of particles at one place are drawn once.
#[test]
fn radii_and_copies_of_particles_are_understood() {
    let folder = Folder::new();
    let (mut rows, mut twice) = (String::from("x,y,z,radius\n"), String::from("x,y,z\n"));
    for [[x, y, z], _] in slope() {
        rows += &format!("{x},{y},{z},{}\n", if z > 0.3 { 0.028 } else { 0.031 });
        twice += &format!("{x},{y},{z}\n{x},{y},{z}\n");
    }
    folder.text("radii.csv", &rows);
    folder.text("twice.csv", &twice);
    let said = folder.run(&format!("render radii.csv -o r.png {SMALL}")).ok().stderr();
    assert!(
        said.contains(
            "radius 0.031 (of the files; they go from 0.028 to 0.031, and all are drawn alike"
        ),
        "{said}"
    );
    let text = folder.run("info radii.csv").ok().stdout();
    assert!(text.contains("radius (number x 1): radius"), "{text}");
    // A block with eight times the particles, and half of it again as particles of twice the radius.
    let half: Vec<_> =
        (0..6 * 6 * 6).map(|i| [i % 6, i / 6 % 6, i / 36].map(|i| 0.1 * i as f32)).collect();
    let mut mixed = String::from("x,y,z,radius\n");
    for [x, y, z] in half {
        match x > 0.25 {
            true => mixed += &format!("{x},{y},{z},0.05\n"),
            false => {
                for corner in 0..8_u8 {
                    let [a, b, c] =
                        [0, 1, 2].map(|axis| if corner >> axis & 1 == 1 { 0.025 } else { -0.025 });
                    mixed += &format!("{},{},{},0.025\n", x + a, y + b, z + c);
                }
            }
        }
    }
    folder.text("mixed.csv", &mixed);
    let view =
        "--eye 0.25,0.25,2.4 --target 0.25,0.25,0.25 --fov 20 --layers water.depth,water.thickness";
    let said = folder.run(&format!("render mixed.csv -o m.exr {SMALL} {view}")).ok().stderr();
    for part in [
        "radius 0.025 (of the files; they go from 0.025 to 0.05, and larger",
        "972 particles are split into 1728",
    ] {
        assert!(said.contains(part), "{said}");
    }
    // Both halves have equal thickness, within the noise of a few copies.
    let picture = folder.picture("m.exr");
    let thick = picture.channel("water.thickness").unwrap();
    let mean = |from: usize| {
        let rows = (20..44).flat_map(|y| (from..from + 12).map(move |x| thick[y * 96 + x]));
        rows.sum::<f32>() / (24.0 * 12.0)
    };
    let (fine, coarse) = (mean(34), mean(50));
    assert!((fine / coarse - 1.0).abs() < 0.15, "{fine} {coarse}");
    let said = folder
        .run(&format!("render mixed.csv -o a.exr {SMALL} {view} --radius 0.03"))
        .ok()
        .stderr();
    assert!(!said.contains("are split into"), "{said}");
    let said = folder.run(&format!("render twice.csv -o t.png {SMALL}")).ok().stderr();
    let count = slope().len();
    for part in [
        format!("{count} copies of particles"),
        format!("{count} particles"),
        "radius 0.025 ".into(),
    ] {
        assert!(said.contains(&part), "{part}: {said}");
    }
}

/// A flat sheet of particles is reported and seen from the front, whichever two axes it lies in.
#[test]
fn two_dimensions_are_told_and_seen_from_the_front() {
    let folder = Folder::new();
    let sheet: Vec<_> = slope().into_iter().filter(|[p, _]| p[2] == 0.0).collect();
    folder.text("xy.csv", &csv(&sheet, |p| p));
    folder.text("xz.csv", &csv(&sheet, |[x, y, z]| [x, -z, y]));
    for file in ["xy", "xz"] {
        let common = format!("{SIZE} --set studio --layers water.depth");
        let said = folder.run(&format!("render {file}.csv -o {file}.exr {common}")).ok().stderr();
        assert!(said.contains("two-dimensional: drawn as a sheet one spacing thick"), "{said}");
        assert_eq!(said.contains("z is up in the files"), file == "xz", "{said}");
        assert!(!said.contains("a basin"), "{said}");
        assert!(said.contains("the sheet has the colour of 1 metre of pool water"), "{said}");
    }
    folder.run("compare xy.exr xz.exr --tolerance 1e-4").ok();
    let picture = folder.picture("xy.exr");
    let depth = picture.channel("water.depth.Z").unwrap();
    let wet = depth.iter().filter(|z| **z < whitewater::io::picture::EMPTY).count();
    assert!(wet > 600, "{wet} of {} pixels", depth.len());
    // Blue on the studio's grey. A metre of pool water takes 1 - exp(-1.1) of red and 1 - exp(-0.11) of blue.
    let [mut water, mut ground] = [Vec::new(), Vec::new()];
    for (z, [red, _, blue]) in depth.iter().zip(picture.rgb().unwrap()) {
        let of = if *z < whitewater::io::picture::EMPTY { &mut water } else { &mut ground };
        of.push(red / blue);
    }
    let median = |ratios: &mut Vec<f32>| {
        ratios.sort_by(f32::total_cmp);
        ratios[ratios.len() / 2]
    };
    let [water, ground] = [&mut water, &mut ground].map(median);
    let through = (-1.1_f32).exp() / (-0.11_f32).exp();
    assert!(
        (0.8 * through..0.5 * (1.0 + through)).contains(&(water / ground)),
        "{water} on {ground}"
    );
    let (_, config) = picture.attributes.iter().find(|(name, _)| name == "config").unwrap();
    assert!(config.contains("spray: false") && config.contains("exit: Straight"), "{config}");
    // A liquid that is asked for is that liquid.
    let said = folder
        .run(&format!("render xy.csv -o milk.exr {SIZE} --set studio --medium milk"))
        .ok()
        .stderr();
    assert!(!said.contains("the sheet has"), "{said}");
    folder.run("compare xy.exr milk.exr --tolerance 0.01").fails(1, &["RMSE"]);
}

/// A folder stands for the sequence in it. Step numbers are not times; the frame rate comes from the files.
#[test]
fn a_folder_of_steps_becomes_a_film() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("out")).unwrap();
    for (i, step) in [0, 500, 1000, 1500].into_iter().enumerate() {
        let moved = 0.02 * i as f32;
        let mut rows = String::from("ITEM: TIMESTEP\n");
        rows += &format!("{step}\nITEM: NUMBER OF ATOMS\n{}\n", slope().len());
        rows += "ITEM: BOX BOUNDS ff ff ff\n0 2\n0 2\n0 2\nITEM: ATOMS id x y z vx vy vz\n";
        for (id, [[x, y, z], _]) in slope().into_iter().enumerate() {
            rows += &format!("{id} {} {} {y} 0.5 0 0\n", x + moved, -z);
        }
        folder.text(&format!("out/dump.{step}"), &rows);
    }
    let common = format!("render out {SMALL} -o film.mp4 --overwrite");
    let said = folder.run(&common).ok().stderr();
    assert!(said.contains("25 frames a second (found"), "{said}");
    assert_eq!(folder.film("film.mp4"), (4, 25.0));
    // Every other frame, at the rate that is given instead of the one that is found.
    folder.run(&format!("{common} --fps 12 --every 2")).ok();
    assert_eq!(folder.film("film.mp4"), (2, 6.0));
    // Without velocities or ids, times in file names give the rate.
    for time in ["0.32", "0.36", "0.4"] {
        folder.particles(&format!("t{time}.ply"), slope().iter().map(|[p, _]| *p).collect());
    }
    let said = folder.run(&format!("render t*.ply {SMALL} -o times.mp4")).ok().stderr();
    assert!(said.contains("25 frames a second (found"), "{said}");
    folder.run("info out").ok();
    folder.text("out/foam_1.csv", "x,y,z\n0,0,0\n");
    folder
        .run("render out -o a.png")
        .fails(3, &["several sequences", "'out/dump.*' (4 files)", "'out/foam_*.csv' (1 file)"]);
    folder.text("a.bi4", "DATA");
    folder.run("render a.bi4 -o a.png").fails(3, &["a.bi4", "PartVTK"]);
}

/// A file of several frames is a sequence, at the rate of its times. Files of one frame number are joined on request.
#[test]
fn frames_in_one_file_and_files_of_one_frame() {
    let folder = Folder::new();
    let rows = |time: f32| -> String {
        let row = |(i, [[x, y, z], _]): (usize, &[[f32; 3]; 2])| {
            format!("{time},{i},{},{y},{z},1,0,0\n", x + time)
        };
        slope().iter().enumerate().map(row).collect()
    };
    let head = "Time [s],Idp,x,y,z,vx,vy,vz\n";
    folder.text("all.csv", &format!("{head}{}{}{}", rows(0.0), rows(0.04), rows(0.08)));
    for (i, time) in [0.0, 0.04, 0.08].into_iter().enumerate() {
        folder.text(&format!("f_{i}.csv"), &format!("{head}{}", rows(time)));
    }
    let common = format!("{SMALL} --layers motion --surface-foam none");
    let said = folder.run(&format!("render all.csv -o a_%d.exr {common}")).ok().stderr();
    assert!(said.contains("25 frames a second (found"), "{said}");
    folder.run(&format!("render f_*.csv -o b_%d.exr {common}")).ok();
    for frame in 0..3 {
        folder.run(&format!("compare a_{frame}.exr b_{frame}.exr")).ok();
    }
    folder.run(&format!("render all.csv -o c.exr {common} --frames 2")).ok();
    folder.run("compare a_2.exr c.0002.exr").ok();
    folder.run("render all.csv -o c.exr --frames 7").fails(3, &["the nearest of 3 found is 2"]);
    let text = folder.run("info all.csv").ok().stdout();
    for part in ["frame       2", "time        0.04", "Time [s] (number x 1): time"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    // One file for each half.
    let (left, right): (Vec<_>, Vec<_>) = slope().into_iter().partition(|[p, _]| p[0] < 0.5);
    folder.text("whole_1.csv", &csv(&[left.clone(), right.clone()].concat(), |p| p));
    folder.text("left_1.csv", &csv(&left, |p| p));
    folder.text("right_1.csv", &csv(&right, |p| p));
    let halves = format!("render left_1.csv right_1.csv -o d.exr {common}");
    folder.run(&halves).fails(3, &["both frame 1", "--join"]);
    folder.run(&format!("{halves} --join")).ok();
    folder.run(&format!("render whole_1.csv -o e.exr {common}")).ok();
    folder.run("compare d.exr e.exr").ok();
}

/// Each fluid is drawn with its own look. A single fluid looks as without --fluid, and of two the nearer one is in
/// front, from both sides.
#[test]
fn several_fluids_are_drawn_each_with_its_look() {
    let folder = Folder::new();
    let mut rows = String::from("x,y,z,Type\n");
    let mut near = rows.clone();
    for [x, y, z] in block(6) {
        rows += &format!("{x},{y},{},1\n{x},{y},{},2\n{x},{y},0,0\n", z + 0.35, z - 0.35);
        near += &format!("{x},{y},{},1\n", z + 0.35);
    }
    folder.text("both_1.csv", &rows);
    folder.text("milk_1.csv", &near);
    let run = |out: &str, more: &str| {
        let common = "--target 0,0.25,0 --fov 40 --radius 0.05 --layers water.depth";
        folder.run(&format!("render both_1.csv -o {out}.exr {SMALL} {common} {more}")).ok().stderr()
    };
    let (front, back) = ("--eye 0,0.25,3", "--eye 0,0.25,-3");
    let said = run("plain", &format!("{front} --where Type=1"));
    assert!(!said.contains("--fluid"), "{said}");
    run("one", &format!("{front} --fluid Type=1:water"));
    folder.run("compare plain.exr one.exr").ok();
    for (side, out) in [(front, "front"), (back, "back")] {
        run(&format!("{out}-milk"), &format!("{side} --where Type=1 --medium milk"));
        run(&format!("{out}-lava"), &format!("{side} --where Type=2 --medium lava"));
        let said = run(out, &format!("{side} --fluid Type=1:milk --fluid type=2:lava"));
        assert!(said.contains("216 of 648 particles belong to no --fluid"), "{said}");
        let [both, milk, lava] =
            [out, &format!("{out}-milk"), &format!("{out}-lava")].map(|name| {
                let picture = folder.picture(&format!("{name}.exr"));
                picture.rgb().unwrap()[32 * 96 + 48]
            });
        let (seen, hidden) = if out == "front" { (milk, lava) } else { (lava, milk) };
        let off =
            |a: [f32; 3], b: [f32; 3]| (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f32::max);
        // Both are opaque, but light passes around the other.
        assert!(off(both, seen) < 0.1 * off(seen, hidden), "{out}: {both:?} {seen:?} {hidden:?}");
    }
    // The same with one file per fluid.
    let common =
        format!("{SMALL} {front} --target 0,0.25,0 --fov 40 --radius 0.05 --layers water.depth");
    let two = "--medium milk --where Type!=0 --fluid lava_1.csv:lava";
    folder.text("lava_1.csv", &rows.replace(",1\n", ",0\n"));
    let said = folder.run(&format!("render milk_1.csv -o files.exr {common} {two}")).ok().stderr();
    assert!(said.contains("frame 1: 432 particles"), "{said}");
    folder.run("compare front.exr files.exr --tolerance 0.01").ok();
    let wrong = format!("render both_1.csv -o a.exr {common} --fluid");
    folder
        .run(&format!("{wrong} phase=1:milk"))
        .fails(3, &["--fluid 'phase=1:milk'", "found x, y, z, Type"]);
    folder.run(&format!("{wrong} Type=1")).fails_at_once();
    folder.run(&format!("{wrong} Type=1:oil")).fails_at_once();
}

/// Touching fluids of one look are seen as one. Whitewater is drawn once, over both.
#[test]
fn fluids_that_touch_are_seen_through() {
    let folder = Folder::new();
    let (mut rows, mut all) = (String::from("x,y,z,Type\n"), String::from("x,y,z\n"));
    for [x, y, z] in block(6) {
        for (kind, side) in [(1, -0.3), (2, 0.3)] {
            rows += &format!("{},{y},{z},{kind}\n", x + side);
            all += &format!("{},{y},{z}\n", x + side);
        }
    }
    folder.text("two_1.csv", &rows);
    folder.text("one_1.csv", &all);
    folder.particles("foam_1.ply", block(4).into_iter().map(|[x, y, z]| [x, y, z + 0.6]).collect());
    let run = |out: &str, file: &str, more: &str| {
        let common = format!("{SMALL} --eye 1.8,0.6,2.4 --target 0,0.25,0 --fov 30 --radius 0.05");
        let common = format!("{common} --layers none --surface-foam none --spray none");
        folder.run(&format!("render {file}_1.csv -o {out}.exr {common} {more}")).ok();
        folder.picture(&format!("{out}.exr")).rgb().unwrap()
    };
    let two = "--fluid Type=1:water --fluid Type=2:water";
    let exit = |word: &str| {
        let file = format!("{word}.toml");
        folder.text(&file, &format!("[water]\nexit = \"{word}\"\n"));
        format!("--settings {file}")
    };
    let off = |a: &[[f32; 3]], b: &[[f32; 3]]| {
        let each = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs());
        each.sum::<f32>() / (3 * a.len()) as f32
    };
    let one = run("one", "one", &exit("straight"));
    let (seen, bent) =
        (run("seen", "two", two), run("bent", "two", &format!("{two} {}", exit("two_interfaces"))));
    assert!(off(&seen, &one) < 0.5 * off(&bent, &one), "{} {}", off(&seen, &one), off(&bent, &one));
    let foam = "--whitewater foam=foam_1.ply";
    let (foamy, alone) = (
        run("foamy", "two", &format!("{two} {foam}")),
        run("alone", "one", &format!("{foam} {}", exit("straight"))),
    );
    let added = off(&foamy, &seen);
    assert!(
        added > 1.0e-3 && (added / off(&alone, &one) - 1.0).abs() < 0.1,
        "{added} {}",
        off(&alone, &one)
    );
}

/// A lone particle is drawn as a drop, not as invisible spray, and a frame without particles is reported.
#[test]
fn few_particles_are_drawn_and_none_are_told() {
    let folder = Folder::new();
    folder.text("one_1.csv", "x,y,z\n0,0.5,0\n");
    folder.text("none_1.csv", "x,y,z\n");
    let run = |file: &str| {
        let command = format!("render {file}_1.csv -o {file}.exr {SMALL} --layers water.depth");
        folder.run(&command).ok().stderr()
    };
    let said = run("one");
    assert!(!said.contains("spans") && !said.contains("up is a guess"), "{said}");
    let depth = |file: &str| {
        let picture = folder.picture(&format!("{file}.exr"));
        let layer = picture.channels.iter().find(|channel| channel.name == "water.depth.Z");
        layer.unwrap().data.iter().filter(|z| **z < 1.0e9).count()
    };
    assert!(depth("one") > 50, "{}", depth("one"));
    assert!(run("none").contains("no particles in the probed frames"));
    assert_eq!(depth("none"), 0);
}

/// A guess about files is reported once: the axis that is up, and units in the names of columns.
#[test]
fn guesses_are_told() {
    let folder = Folder::new();
    let rows = |names: &str| {
        let rows = block(6).into_iter().map(|[x, y, z]| format!("{x},{y},{z}\n"));
        names.to_string() + "\n" + &rows.collect::<String>()
    };
    folder.text("cube_1.csv", &rows("x,y,z"));
    folder.text("cube_2.csv", &rows("x,y,z"));
    folder.text("cm_1.csv", &rows("X [cm],Y [cm],Z [cm]"));
    let run = |files: &str, more: &str| {
        let command =
            format!("render {files} -o a_%d.exr {SMALL} --overwrite --layers none {more}");
        folder.run(&command).ok().stderr()
    };
    let said = run("cube_*.csv", "");
    assert_eq!(said.matches("up is a guess: y").count(), 1, "{said}");
    for more in ["--up-axis y", "--eye 0,1,3 --target 0,0.3,0"] {
        let said = run("cube_*.csv", more);
        assert!(!said.contains("a guess"), "{more}: {said}");
    }
    let said = run("cm_1.csv", "");
    assert_eq!(said.matches("say cm, but they are read as metres; --unit cm").count(), 1, "{said}");
    assert!(!run("cm_1.csv", "--unit cm").contains("say cm"));
    let text = folder.run("info cm_1.csv").ok().stdout();
    assert!(text.contains("unit        the names of the positions say cm"), "{text}");
}

/// Positions and velocities in separate NumPy files are joined to moving particles.
#[test]
fn arrays_in_files_of_their_own_are_put_together() {
    let folder = Folder::new();
    let npy = |name: &str, vectors: &[[f32; 3]]| {
        let shape = format!("'shape': ({}, 3), ", vectors.len());
        let header = format!("{{'descr': '<f4', 'fortran_order': False, {shape}}}");
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.bytes());
        bytes.extend(vectors.iter().flatten().flat_map(|c| c.to_le_bytes()));
        std::fs::write(folder.path(name), bytes).unwrap();
    };
    std::fs::create_dir(folder.path("run")).unwrap();
    let (positions, velocities): (Vec<_>, Vec<_>) =
        slope().into_iter().map(|[p, v]| (p, v)).unzip();
    for frame in [0, 1] {
        npy(&format!("run/x_{frame}.npy"), &positions);
        npy(&format!("run/v_{frame}.npy"), &velocities);
    }
    let text = folder.run("info run").ok().stdout();
    assert_eq!(text.matches("v_1.npy (f32 x 3): velocity").count(), 1, "{text}");
    assert!(!text.contains("no velocities"), "{text}");
    let count = format!("frame 0: {} particles", positions.len());
    let said = folder.run(&format!("render run -o a.png {SMALL} --frames 0")).ok().stderr();
    assert!(said.contains(&count) && !said.contains("no velocities"), "{said}");
    let both = "render run/v_*.npy run/x_*.npy --join -o b.png --frames 0";
    let said = folder.run(&format!("{both} {SMALL}")).ok().stderr();
    assert!(said.contains(&count), "{said}");
    let said = folder.run(&format!("render run/v_0.npy -o c.png {SMALL}")).ok().stderr();
    assert!(said.contains("the file's name says that these are velocities"), "{said}");
}

/// Frames of one file are drawn like those of several files.
#[test]
fn frames_in_one_file_are_drawn() {
    let folder = Folder::new();
    let list = |frame: usize| {
        let moved = block(4).into_iter().map(|[x, y, z]| [x + 0.1 * frame as f32, y, z]);
        format!("{:?}", moved.collect::<Vec<_>>())
    };
    folder.text("all.json", &format!("[{}, {}]", list(0), list(1)));
    [0, 1].into_iter().for_each(|i| folder.text(&format!("one_{i}.json"), &list(i)));
    let common = format!(
        "{SMALL} --eye 0,0.35,2.35 --target 0,0.35,0 --fov 40 --radius 0.05 --surface-foam none"
    );
    folder.run(&format!("render all.json -o all.png {common} --frames 1")).ok();
    folder.run(&format!("render one_*.json -o one.png {common} --frames 1")).ok();
    folder.run("compare all.0001.png one.0001.png").ok();
    let text = folder.run("info all.json").ok().stdout();
    assert_eq!(text.matches("particles   64\n").count(), 2, "{text}");
}
