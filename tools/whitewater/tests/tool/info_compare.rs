//! `info` and `compare`.

use serde_json::Value;
use whitewater::io::particles::{self, Particles, WriteFormat};
use whitewater::io::picture::{Layers, write_exr, write_png};

use super::support::{Folder, SMALL, SPACING, block};

#[test]
fn info_tells_what_a_file_holds() {
    let folder = Folder::new();
    let mut positions = block(6);
    positions.push([f32::NAN; 3]);
    let mut particles = Particles::from_positions(positions);
    particles.densities = Some((0..217).map(|i| i as f32).collect());
    particles::write(&folder.path("a.bgeo"), &particles, WriteFormat::Bgeo { gzip: true }).unwrap();
    let run = folder.run("info a.bgeo --json").ok();
    let value: Value = serde_json::from_str(&run.stdout()).unwrap();
    let file = &value["frames"][0];
    assert_eq!(file["particles"], 217);
    assert_eq!(file["non_finite"], 1);
    assert!(file["format"].as_str().unwrap().to_lowercase().contains("bgeo"));
    let spacing = file["spacing"].as_f64().unwrap() as f32;
    assert!((spacing - SPACING).abs() < 0.01 * SPACING, "{spacing}");
    assert_eq!(file["bounds"]["min"][1], 0.0);
    assert_eq!(file["density"]["max"], 216.0);
    assert!(file["attributes"].as_array().unwrap().iter().any(|a| a["name"] == "density"));
    let text = folder.run("info a.bgeo").ok().stdout();
    for part in ["particles   217", "not finite  1", "spacing", "attribute", "density"] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

/// Which attributes were used and how, which were ignored, and which are missing.
#[test]
fn info_tells_what_became_of_attributes() {
    let folder = Folder::new();
    let mut rows = String::from("x,y,z,vx,vy,vz,rho,id,shear\n");
    for (i, [x, y, z]) in block(3).into_iter().enumerate() {
        rows += &format!("{x},{y},{z},1,0,0,1000,{i},0.5\n");
    }
    folder.text("a.csv", &rows);
    let text = folder.run("info a.csv").ok().stdout();
    for part in [
        "x (number x 1): position",
        "vz (number x 1): velocity",
        "rho (number x 1): density",
        "id (number x 1): id",
        "shear (number x 1): not used",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert!(!text.contains("missing"), "{text}");
    // Ids that are not integers are dropped.
    folder.text("b.csv", &rows.replace("1000,", "1000,-"));
    let text = folder.run("info b.csv").ok().stdout();
    assert!(text.contains("id (number x 1): not used"), "{text}");
    assert!(
        text.contains("no ids: in a sequence foam is found for each frame by itself"),
        "{text}"
    );
    folder.particles("c.ply", block(3));
    folder.write("c.vtu", &Particles::from_positions(block(3)));
    for file in ["c.ply", "c.vtu"] {
        let run = folder.run(&format!("info {file} --json")).ok();
        let value: Value = serde_json::from_str(&run.stdout()).unwrap();
        let of = |a: &Value| a["meaning"] == "position";
        assert!(value["frames"][0]["attributes"].as_array().unwrap().iter().all(of), "{value}");
        let missing = value["frames"][0]["missing"].as_str().unwrap();
        assert!(missing.starts_with("no velocities and no ids"), "{missing}");
    }
}

/// Below the frames of a sequence stands what holds for the whole.
#[test]
fn info_sums_up_a_sequence() {
    let folder = Folder::new();
    // A block that moves to the right, with 50 frames a second, and is faster in frame 14. Its wall rests.
    for (frame, speed, way) in [(10, 2.0, 0.0), (12, 2.0, 0.04), (14, 3.0, 0.09)] {
        let mut rows = String::from("x,y,z,vx,vy,vz,id,type\n");
        for (i, [x, y, z]) in block(4).into_iter().enumerate() {
            rows += &format!("{},{y},{z},{speed},0,0,{i},1\n", x + way);
            rows += &format!("{},{y},{z},0,0,0,{},7\n", x - 1.0, 1000 + i);
        }
        folder.text(&format!("run_{frame}.csv"), &rows);
    }
    let text = folder.run("info run_*.csv").ok().stdout();
    for part in [
        "3 frames, 10 to 14\n  particles   128 to 128\n",
        "rate        50 frames a second (from velocities and positions)",
        "liveliest   frame 14, with a root mean square speed of 3.000 in the files' unit of speed",
        "values      type: 1 (64 particles), 7 (64 particles, all at rest: walls?)",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert!(!folder.run("info run_10.csv").ok().stdout().contains("frames a second"));
    // Times with a unit are seconds, however short; the file's own time may be a step.
    for time in ["900us", "925us", "0.95ms"] {
        folder.text(&format!("t_{time}.csv"), "x,y,z,time\n0,0,0,7\n1,0,0,7\n0,1,0,7\n");
    }
    let text = folder.run("info t_*.csv").ok().stdout();
    assert!(text.contains("40000 frames a second (from the frames' times)"), "{text}");
    // Without velocities the rate is assumed.
    for frame in 1..3 {
        folder.text(&format!("bare_{frame}.csv"), "x,y,z\n0,0,0\n1,0,0\n0,1,0\n");
    }
    let text = folder.run("info bare_*.csv").ok().stdout();
    assert!(text.contains("30 frames a second (assumed; --fps of render sets it)"), "{text}");
    assert!(!text.contains("liveliest"), "{text}");
}

/// The attribute that gave the time, the one that marks ghosts, and units in a row below the names.
#[test]
fn info_tells_times_ghosts_and_units() {
    let folder = Folder::new();
    for name in ["Iteration", "Frame No.", "sim_time", "snapshot"] {
        folder.text("a.csv", &format!("x,y,z,{name}\n0,0,0,7\n0.1,0,0,7\n0,0.1,0,7\n"));
        let text = folder.run("info a.csv").ok().stdout();
        assert!(text.contains(&format!("{name} (number x 1): time")), "{text}");
        assert!(text.contains("  time        7\n"), "{text}");
    }
    folder.text("b.csv", "x,y,z,vtkGhostType\n0,0,0,0\n0.1,0,0,1\n0,0.1,0,0\n");
    let text = folder.run("info b.csv").ok().stdout();
    assert!(text.contains("vtkGhostType (number x 1): ghost"), "{text}");
    for (unit, told) in [
        (
            "mm",
            "unit        the names of the positions say mm, but they are read as metres; --unit mm",
        ),
        ("m", "unit        m, as the names of the positions say (`x [m]`; a row of units below"),
    ] {
        folder.text("c.csv", &format!("x,y,z\n{unit},{unit},{unit}\n0,0,0\n0.1,0,0\n0,0.1,0\n"));
        let text = folder.run("info c.csv").ok().stdout();
        assert!(text.contains(told), "{text}");
        assert!(text.contains("particles   3\n"), "{text}");
    }
}

/// A frame in another unit, ids that number the rows, and velocities in other axes.
#[test]
fn info_tells_what_does_not_fit_in_a_sequence() {
    let folder = Folder::new();
    // The block turns about its middle, one radian a second, and rises.
    let rows = |frame: usize, scale: f32, shuffle: bool, turned: bool| {
        let angle = 0.04 * frame as f32;
        let (sin, cos) = angle.sin_cos();
        let points: Vec<_> = block(6).into_iter().enumerate().collect();
        let mut text = String::from("x,y,z,vx,vy,vz,id\n");
        for row in 0..216 {
            let pick = if shuffle { (row * 61 + 31 * frame) % 216 } else { row };
            let (_, [x, y, z]) = points[pick];
            let (x, z) = (x * cos - z * sin, x * sin + z * cos);
            let v = if turned { [-z, x, 0.1] } else { [-z, 0.1, x] };
            let p = [x, y + 0.1 * angle, z].map(|c| c * scale);
            let [p, v] = [p, v].map(|v| v.map(|c| c.to_string()).join(","));
            text += &format!("{p},{v},{row}\n");
        }
        text
    };
    let said = |name: &str, scale: &dyn Fn(usize) -> f32, shuffle: bool, turned: bool| {
        for frame in 1..=4 {
            let text = rows(frame, scale(frame), shuffle, turned);
            folder.text(&format!("{name}_{frame}.csv"), &text);
        }
        let text = folder.run(&format!("info {name}_*.csv")).ok().stdout();
        text[text.find("4 frames, 1 to 4").unwrap()..].to_string()
    };
    let plain = said("plain", &|_| 1.0, false, false);
    assert!(plain.contains("25 frames a second (from velocities and positions)"), "{plain}");
    assert!(!plain.contains("warning"), "{plain}");
    let shuffled = said("rows", &|_| 1.0, true, false);
    assert!(shuffled.contains("30 frames a second (assumed"), "{shuffled}");
    assert!(shuffled.contains("warning     ids are dropped: they number the rows"), "{shuffled}");
    let turned = said("turned", &|_| 1.0, false, true);
    assert!(turned.contains("25 frames a second (from velocities and positions)"), "{turned}");
    assert!(turned.contains("with the axes x z y they do"), "{turned}");
    for (scale, words) in [(1000.0, "lie 1000 times"), (0.01, "lie 0.01 times")] {
        let odd = said("odd", &|frame| if frame == 3 { scale } else { 1.0 }, false, false);
        assert_eq!(odd.matches("warning").count(), 1, "{odd}");
        assert!(odd.contains(&format!("the particles of frame 3 {words} as far apart")), "{odd}");
    }
    // `render` says each once, and draws without these ids.
    for (name, words) in [
        ("rows", "hold other particles in the next frame, as the velocities show"),
        ("turned", "with the axes x z y they do: write"),
        ("odd", "the particles of frame 3 lie 0.01 times as far apart as those of frame"),
    ] {
        let said = folder.run(&format!("render {name}_*.csv -o {name}.png {SMALL}")).ok().stderr();
        assert_eq!(said.matches(words).count(), 1, "{said}");
    }
    // A frame that is not drawn changes the view all the same.
    let said = folder.run(&format!("render odd_*.csv -o b.png {SMALL} --frames 1-2")).ok().stderr();
    assert_eq!(said.matches("the particles of frame 3 lie 0.01 times").count(), 1, "{said}");
}

/// A folder of MATLAB's files: those of version 7.3 are frames, others are named with the way out.
#[test]
fn info_lists_files_of_matlab() {
    let folder = Folder::new();
    let samples = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/formats/hdf5");
    std::fs::create_dir_all(folder.path("new")).unwrap();
    std::fs::create_dir_all(folder.path("old")).unwrap();
    for frame in 1..=2 {
        let to = folder.path(&format!("new/w_{frame}.mat"));
        std::fs::copy(samples.join("matlab.mat"), to).unwrap();
        let header =
            format!("{:116}\0\0\0\0\0\0\0\0\0\u{1}IM", "MATLAB 5.0 MAT-file, Platform: GLNXA64");
        folder.text(&format!("old/w_{frame}.mat"), &header);
    }
    let text = folder.run("info new").ok().stdout();
    assert!(text.contains("2 frames, 1 to 2"), "{text}");
    let run = folder.run("info old").fails(3, &["2 of 2 files", "w_1.mat", "w_2.mat"]);
    assert!(run.stderr().contains("scipy.io.loadmat('FILE')"), "{}", run.stderr());
}

#[test]
fn info_goes_on_after_a_bad_file() {
    let folder = Folder::new();
    folder.particles("a_1.ply", block(2));
    folder.text("a_2.ply", "ply\n");
    let run = folder.run("info a_*.ply --json").fails(1, &["1 of 2", "a_2.ply"]);
    let value: Value = serde_json::from_str(&run.stdout()).unwrap();
    assert_eq!(value["frames"].as_array().unwrap().len(), 2);
    assert!(value["frames"][1]["error"].is_string() && value["sequence"].is_null());
}

/// The summary of a sequence counts the files that can be read, if there are several.
#[test]
fn info_sums_up_what_can_be_read() {
    let folder = Folder::new();
    folder.particles("a_1.ply", block(2));
    folder.text("a_2.ply", "ply\n");
    let one = folder.run("info a_*.ply").fails(1, &["1 of 2", "a_2.ply"]).stdout();
    assert!(one.contains("particles   8\n") && !one.contains("2 frames"), "{one}");
    folder.particles("a_3.ply", block(3));
    let text = folder.run("info a_*.ply").fails(1, &["1 of 3", "a_2.ply"]).stdout();
    let summary = "3 frames (2 readable), 1 to 3\n  particles   8 to 27\n";
    assert!(text.contains(summary), "{text}");
    let json = folder.run("info a_*.ply --json").fails(1, &["1 of 3"]).stdout();
    let value: Value = serde_json::from_str(&json).unwrap();
    let expected = serde_json::json!({
        "frames": 3,
        "readable": 2,
        "first": 1,
        "last": 3,
        "particles": {"min": 8, "max": 27},
        "rate": {"frames_per_second": 30.0, "how": "assumed; --fps of render sets it"},
        "liveliest": null,
        "warnings": [],
    });
    assert_eq!(value["sequence"], expected);
    for bad in ["b_1.ply", "b_2.ply"] {
        folder.text(bad, "ply\n");
    }
    let none = folder.run("info b_*.ply").fails(3, &["2 of 2", "b_1.ply"]).stdout();
    assert_eq!(none, "");
}

#[test]
fn info_takes_files_that_are_no_sequence() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("b")).unwrap();
    for name in ["a_27.ply", "a_28.ply", "other_27.ply", "b/a_27.ply"] {
        folder.particles(name, block(2));
    }
    let files = |inputs: &str| {
        let run = folder.run(&format!("info {inputs} --json")).ok();
        let value: Value = serde_json::from_str(&run.stdout()).unwrap();
        let each = |v: &Value| format!("{} {}", v["file"].as_str().unwrap(), v["frame"]);
        value["frames"].as_array().unwrap().iter().map(each).collect::<Vec<_>>().join(", ")
    };
    assert_eq!(files("a_28.ply a_27.ply"), "a_27.ply 27, a_28.ply 28");
    assert_eq!(
        files("other_27.ply a_*.ply b/a_27.ply a_27.ply"),
        "other_27.ply 27, a_27.ply 27, a_28.ply 28, b/a_27.ply 27"
    );
    folder.run("info other_27.ply a_27.ply none.ply").fails(3, &["none.ply", "no such file"]);
    // One pattern names one sequence.
    folder.run("info *_27.ply").fails(3, &["both frame 27"]);
    folder.run("render a_27.ply other_27.ply -o o.png").fails(3, &["both frame 27"]);
}

fn grey(value: f32) -> Layers {
    let mut layers = Layers::new(32, 24);
    for (c, name) in ["R", "G", "B"].iter().enumerate() {
        let data = (0..768).map(|i| value + 0.0003 * i as f32 * c as f32).collect();
        layers.push(name, 32, 24, data).unwrap();
    }
    layers
}

#[test]
fn compare_tells_pictures_apart() {
    let folder = Folder::new();
    let exr = |name: &str, layers: &Layers| {
        write_exr(layers, std::fs::File::create(folder.path(name)).unwrap()).unwrap();
    };
    exr("a.exr", &grey(0.3));
    exr("same.exr", &grey(0.3));
    exr("off.exr", &grey(0.4));
    let mut more = grey(0.3);
    more.push("scene.Z", 32, 24, vec![1.0; 768]).unwrap();
    exr("more.exr", &more);
    write_png(&grey(0.3), 0.0, std::fs::File::create(folder.path("a.png")).unwrap()).unwrap();

    folder.run("compare a.exr same.exr").ok();
    folder.run("compare a.exr same.exr --flip").ok();
    folder.run("compare a.exr off.exr --tolerance 0.11").ok();
    folder.run("compare a.exr off.exr --tolerance 0.09").fails(1, &["RMSE 0.1"]);
    folder.run("compare a.exr off.exr --flip --tolerance 0.001").fails(1, &["FLIP"]);
    folder.run("compare a.exr a.png --tolerance 0.004").ok();
    folder.run("compare a.exr more.exr --tolerance 9").fails(1, &["differ"]);
    folder.run("compare a.exr none.exr").fails(3, &["none.exr"]);
    folder.text("bad.exr", "no");
    folder.run("compare a.exr bad.exr").fails(3, &["bad.exr", "expected"]);
}
