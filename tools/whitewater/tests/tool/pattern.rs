//! `pattern`.

use whitewater::io::picture::{Layers, write_exr, write_png, write_png_values};
use whitewater::shore::texture;

use super::support::Folder;

const SIZE: (usize, usize) = (24, 16);

/// An off-centre cross that wraps around the borders.
fn cross() -> Vec<bool> {
    (0..SIZE.0 * SIZE.1).map(|i| i % SIZE.0 == 3 || i / SIZE.0 == 5).collect()
}

fn values(pattern: &[bool]) -> Vec<f32> {
    pattern.iter().map(|on| f32::from(*on)).collect()
}

fn layers(channels: &[(&str, Vec<f32>)]) -> Layers {
    let mut layers = Layers::new(SIZE.0, SIZE.1);
    for (name, data) in channels {
        layers.push(name, SIZE.0, SIZE.1, data.clone()).unwrap();
    }
    layers
}

fn grey(values: &[f32]) -> Layers {
    layers(&["R", "G", "B"].map(|name| (name, values.to_vec())))
}

fn png(folder: &Folder, name: &str, layers: &Layers) {
    write_png(layers, 0.0, std::fs::File::create(folder.path(name)).unwrap()).unwrap();
}

fn exr(folder: &Folder, name: &str, layers: &Layers) {
    write_exr(layers, std::fs::File::create(folder.path(name)).unwrap()).unwrap();
}

/// The inverted distances of the cross.
fn expected(reach: f32) -> Vec<f32> {
    texture::from_pattern(&cross(), SIZE.0, SIZE.1, reach)
}

#[track_caller]
fn same(found: &[f32], expected: &[f32], tolerance: f32) {
    assert_eq!(found.len(), expected.len());
    for (i, (a, b)) in found.iter().zip(expected).enumerate() {
        assert!((a - b).abs() <= tolerance, "{i}: {a}, {b}");
    }
}

#[test]
fn a_pattern_becomes_its_distances() {
    let folder = Folder::new();
    png(&folder, "lines.png", &grey(&values(&cross())));
    let text = folder.run("pattern lines.png -o web.exr").ok().stdout();
    // The farthest texel is 12 columns and 8 rows away from the cross, 8 texels from its row.
    for part in ["24x16", "10.2 %", "8.00 texels", "0 from 8.00"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let web = folder.picture("web.exr");
    assert_eq!((web.width, web.height, web.channels.len()), (24, 16, 1));
    assert_eq!(web.channel("Y").unwrap(), expected(8.0));
    assert_eq!(web.channel("Y").unwrap().iter().copied().fold(1.0, f32::min), 0.0);

    folder.run("pattern lines.png -o web.png --reach 4.5").ok();
    let web = folder.picture("web.png");
    same(web.channel("R").unwrap(), &expected(4.5), 0.51 / 65535.0);
    // A texture of distances can be a pattern again.
    folder.run("pattern web.png -o again.exr --threshold 1").ok();
    assert_eq!(folder.picture("again.exr").channel("Y").unwrap(), expected(8.0));
    assert_eq!(folder.files(), ["again.exr", "lines.png", "web.exr", "web.png"]);
}

#[test]
fn every_kind_of_picture_is_a_pattern() {
    let folder = Folder::new();
    let (on, off) = (values(&cross()), values(&cross().iter().map(|on| !on).collect::<Vec<_>>()));
    let dim: Vec<f32> = on.iter().map(|v| 0.1 + 0.2 * v).collect();
    let nothing = vec![f32::NAN; on.len()];
    let full = vec![1.0; on.len()];
    let check = |what: &str, name: &str, flags: &str| {
        folder.run(&format!("pattern {name} -o out.exr {flags}")).ok();
        assert_eq!(folder.picture("out.exr").channel("Y").unwrap(), expected(8.0), "{what}");
    };
    exr(&folder, "y.exr", &layers(&[("Y", on.clone()), ("water.depth.Z", nothing.clone())]));
    check("grey", "y.exr", "");
    exr(&folder, "one.exr", &layers(&[("mask", on.clone())]));
    check("one channel", "one.exr", "");
    // Pure green is bright enough to count as white, pure blue is not.
    let green = |g: &[f32], b: &[f32]| {
        layers(&[("R", vec![0.0; g.len()]), ("G", g.to_vec()), ("B", b.to_vec())])
    };
    exr(&folder, "green.exr", &green(&on, &off));
    check("luminance", "green.exr", "");
    exr(&folder, "dim.exr", &grey(&dim));
    check("dim", "dim.exr", "--threshold 0.2");
    png(&folder, "black.png", &grey(&off));
    check("black lines", "black.png", "--invert");
    // White on a transparent background that is itself white, and black on a transparent background.
    let color = |v: &[f32], alpha: &[f32]| {
        let mut all = grey(v);
        all.push("A", SIZE.0, SIZE.1, alpha.to_vec()).unwrap();
        all
    };
    let values = |name: &str, layers: &Layers| {
        write_png_values(layers, std::fs::File::create(folder.path(name)).unwrap()).unwrap();
    };
    values("white.png", &color(&full, &on));
    check("white on nothing", "white.png", "");
    values("ink.png", &color(&vec![0.0; on.len()], &on));
    check("black on nothing", "ink.png", "--invert");
    exr(&folder, "ink.exr", &color(&vec![0.0; on.len()], &on));
    check("black on nothing", "ink.exr", "--invert");
    // Half opaque, with premultiplied alpha.
    let half: Vec<f32> = on.iter().map(|v| 0.6 * v).collect();
    exr(&folder, "half.exr", &color(&half, &half));
    check("half", "half.exr", "");
    let holes: Vec<f32> = on.iter().map(|v| if *v > 0.0 { 1.0 } else { f32::NAN }).collect();
    exr(&folder, "holes.exr", &grey(&holes));
    check("no numbers", "holes.exr", "");
}

#[test]
fn built_in_textures_are_written() {
    let folder = Folder::new();
    folder.run("pattern web:7 -o web.exr --size 64").ok();
    assert_eq!(folder.picture("web.exr").channel("Y").unwrap(), texture::web(64, 7));
    folder.run("pattern web:7 -o web.png --size 64").ok();
    let web = folder.picture("web.png");
    same(web.channel("G").unwrap(), &texture::web(64, 7), 0.51 / 65535.0);
    folder.run("pattern noise:0 -o noise.exr --size 32").ok();
    folder.run("pattern noise:0 -o noise.png --size 32").ok();
    let (exr, png) = (folder.picture("noise.exr"), folder.picture("noise.png"));
    let noise = texture::noise(32, 0);
    for (c, name) in ["R", "G", "B", "A"].into_iter().enumerate() {
        let channel: Vec<f32> = noise.iter().map(|texel| texel[c]).collect();
        assert_eq!(exr.channel(name).unwrap(), channel);
        let half: Vec<f32> = channel.iter().map(|v| 0.5 + 0.5 * v).collect();
        same(png.channel(name).unwrap(), &half, 0.51 / 65535.0);
    }
    folder.run("pattern web:1 -o web.png").ok();
    assert_eq!(folder.picture("web.png").width, 512);
}

#[test]
fn what_is_no_pattern_says_what_to_do() {
    let folder = Folder::new();
    png(&folder, "lines.png", &grey(&values(&cross())));
    png(&folder, "black.png", &grey(&[0.2; 384]));
    folder.text("words.png", "these are no lines");
    folder.text("empty.png", "");
    for (arguments, code, parts) in [
        ("none.png -o o.png", 3, &["none.png", "check the name"][..]),
        ("words.png -o o.png", 3, &["words.png", "expected"]),
        ("empty.png -o o.png", 3, &["empty.png", "empty"]),
        ("black.png -o o.png", 3, &["black.png", "nothing white", "--threshold", "with --invert"]),
        ("black.png -o o.png --invert", 3, &["all of it black", "--threshold", "without --invert"]),
        ("lines.png -o o.png --threshold 0", 3, &["all of it white", "--threshold"]),
        ("lines.png -o o.png --invert --threshold -1", 3, &["nothing black", "without --invert"]),
        ("lines.png -o o.jpg", 2, &[".exr or .png", "o.jpg"]),
        ("lines.png -o o", 2, &[".exr or .png"]),
        ("lines.png -o o.png --size 64", 2, &["--size", "web:SEED"]),
        ("web:1 -o o.png --reach 4", 2, &["--reach", "--size"]),
        ("noise:1 -o o.png --invert", 2, &["--invert", "--size"]),
        ("web:1 -o o.png --threshold 0.5", 2, &["--threshold", "--size"]),
        ("lines.png -o none/o.png", 5, &["none/o.png", "make the folder"]),
        ("web:1 -o . --size 8", 2, &[".exr or .png"]),
    ] {
        folder.run(&format!("pattern {arguments}")).fails(code, parts);
    }
    for arguments in [
        "",
        "lines.png",
        "lines.png -o o.png --reach 0",
        "lines.png -o o.png --reach -2",
        "lines.png -o o.png --reach NaN",
        "lines.png -o o.png --threshold white",
        "web:x -o o.png",
        "web: -o o.png",
        "web:-1 -o o.png",
        "noise:4294967296 -o o.png",
        "web:1 -o o.png --size 0",
        "web:1 -o o.png --size 9000",
    ] {
        let run = folder.run(&format!("pattern {arguments}"));
        assert_eq!(run.0.status.code(), Some(2), "{arguments}: {}", run.stderr());
    }
    std::fs::create_dir(folder.path("dir.png")).unwrap();
    folder.run("pattern lines.png -o dir.png").fails(5, &["directory"]);
    std::os::unix::fs::symlink("/dev/full", folder.path("full.exr")).unwrap();
    folder.run("pattern lines.png -o full.exr").fails(5, &["full.exr"]);
    let left = ["black.png", "dir.png", "empty.png", "full.exr", "lines.png", "words.png"];
    assert_eq!(folder.files(), left);
}
