//! Sequences: names, ranges, reruns, bad frames.

use openh264::decoder::Decoder;
use openh264::formats::YUVSource;
use whitewater::io::picture::{EMPTY, Layers};

use super::mp4::Frames;
use super::support::{FRONT, Folder, GROUND, SIZE, SMALL, block};

fn sequence(folder: &Folder) {
    for frame in [8, 9, 10, 11] {
        let mut positions = block(4);
        positions.truncate(40 + frame);
        folder.particles(&format!("f_{frame}.ply"), positions);
    }
}

#[test]
fn a_rerun_draws_only_what_is_missing() {
    let folder = Folder::new();
    sequence(&folder);
    let command = format!("render f_*.ply -o out_%03d.png -o out.exr {SMALL} --layers none");
    folder.run(&command).ok();
    let all = [
        "f_10.ply",
        "f_11.ply",
        "f_8.ply",
        "f_9.ply",
        "out.0008.exr",
        "out.0009.exr",
        "out.0010.exr",
        "out.0011.exr",
        "out_008.png",
        "out_009.png",
        "out_010.png",
        "out_011.png",
    ];
    assert_eq!(folder.files(), all);
    let before = std::fs::read(folder.path("out.0009.exr")).unwrap();
    std::fs::remove_file(folder.path("out_009.png")).unwrap();
    folder.text("out.0010.exr", "kept");
    let run = folder.run(&command).ok();
    assert!(run.stderr().contains("3 finished frames"), "{}", run.stderr());
    assert_eq!(folder.files(), all);
    // The picture of a frame does not depend on which others are drawn with it.
    assert!(std::fs::read(folder.path("out.0009.exr")).unwrap() == before);
    assert_eq!(std::fs::read(folder.path("out.0010.exr")).unwrap(), b"kept");
    folder.run(&format!("{command} --overwrite --frames 10")).ok();
    assert_ne!(std::fs::read(folder.path("out.0010.exr")).unwrap(), b"kept");
    assert_eq!(folder.files(), all);
}

/// A film is one file with all frames of the range, at the requested rate.
#[test]
fn a_film_has_all_frames() {
    let folder = Folder::new();
    sequence(&folder);
    let command = format!("render f_*.ply -o film.mp4 {SMALL} --fps 12");
    let run = folder.run(&format!("{command} -o again.mp4")).ok();
    assert!(run.stderr().contains("film.mp4"), "{}", run.stderr());
    assert_eq!([folder.film("film.mp4"), folder.film("again.mp4")], [(4, 12.0); 2]);
    // The film is always drawn as a whole, whatever exists already.
    folder.run(&format!("{command} --every 2")).ok();
    assert_eq!(folder.film("film.mp4"), (2, 6.0));
    // It can play at another rate.
    let slow = folder.run(&format!("{command} --film-fps 6")).ok();
    assert_eq!(folder.film("film.mp4"), (4, 6.0));
    assert!(!slow.stderr().contains("--film-fps"), "{}", slow.stderr());
    let fast = folder.run(&format!("{command} --fps 480").replace("--fps 12 ", "")).ok();
    assert!(fast.stderr().contains("480 frames a second, more than"), "{}", fast.stderr());
    folder.run(&command.replace("96x64", "95x64")).fails(2, &["--size", "96x64"]);
    folder.run(&command.replace("film", "film_%d")).fails(2, &["film_%d.mp4"]);
    assert!(folder.film("film.mp4").1 > 400.0, "the one before is kept");
    // Also without particles.
    folder
        .run(&format!("render --bubbles one --frames 0-3 --every 2 -o b.mp4 {SIZE} --fps 12"))
        .ok();
    assert_eq!(folder.film("b.mp4"), (2, 6.0));
    assert_eq!(folder.files().len(), 7, "{:?}", folder.files());
    // Without a film there is nothing that the rate could set.
    for command in ["render f_8.ply", "render --bubbles one", "demo"] {
        folder.run(&format!("{command} -o c.png --film-fps 6")).fails(2, &["--film-fps", ".mp4"]);
    }
}

/// The pictures of a film are those of the PNGs of the same run, in the same order and light.
#[test]
fn a_film_shows_what_the_pngs_show() {
    let folder = Folder::new();
    let moved = |x: f32| block(6).into_iter().map(|p| [p[0] + x, p[1], p[2]]).collect();
    folder.particles("f_1.ply", moved(-0.5));
    folder.particles("f_2.ply", moved(0.5));
    let look = format!("{GROUND} {FRONT} --medium milk --surface-foam none --spray none");
    let shown = "--tone linear --exposure -1";
    folder.run(&format!("render f_%d.ply -o a.mp4 -o a_%d.png {look} {shown}")).ok();
    let film = Frames::of(&std::fs::read(folder.path("a.mp4")).unwrap());
    let mut decoder = Decoder::new().unwrap();
    decoder.decode(&film.head).unwrap();
    let decoded: Vec<Vec<f32>> = film
        .frames
        .iter()
        .map(|(frame, _)| {
            let picture = decoder.decode(frame).unwrap().unwrap();
            let rows = picture.y().chunks(picture.strides().0).take(64);
            rows.flat_map(|row| row[..96].iter().map(|y| f32::from(*y))).collect()
        })
        .collect();
    assert_eq!(decoded.len(), 2);
    // BT.709's luma of 8 bits, 16 for black and 235 for white.
    let luma = |[r, g, b]: [f32; 3]| 16.0 + 219.0 * (0.2126 * r + 0.7152 * g + 0.0722 * b);
    let pictures = [1, 2].map(|frame| folder.picture(&format!("a_{frame}.png")).rgb().unwrap());
    let pictures = pictures.map(|picture| picture.into_iter().map(luma).collect::<Vec<_>>());
    let apart = |a: &[f32], b: &[f32]| {
        let sum = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f32>();
        (sum / a.len() as f32).sqrt()
    };
    // The quantizer is at most 24, whose steps are 0.625 * 2^(24/6) = 10. A value is within two thirds of a step.
    for (i, frame) in decoded.iter().enumerate() {
        let (own, other) = (apart(frame, &pictures[i]), apart(frame, &pictures[1 - i]));
        assert!(own < 6.7 && other > 13.4, "frame {i}: {own} from its own, {other} from the other");
    }
}

/// Finished frames of scenes without particles are skipped before the others are counted.
#[test]
fn a_rerun_without_particles_draws_only_what_is_missing() {
    let folder = Folder::new();
    for scene in ["--bubbles one", "--shore pool"] {
        let command = format!("render {scene} --frames 1-3 -o o_%d.png {SIZE}");
        // Whatever exists is finished.
        folder.text("o_1.png", "a picture");
        let said = folder.run(&command).ok().stderr();
        assert!(said.contains("1 finished frame is skipped"), "{said}");
        assert!(said.contains("(1 of 2)") && said.contains("(2 of 2)"), "{said}");
        let said = folder.run(&command).ok().stderr();
        assert!(said.contains("3 finished frames") && !said.contains("o_"), "{said}");
        for frame in 1..=3 {
            std::fs::remove_file(folder.path(&format!("o_{frame}.png"))).unwrap();
        }
    }
}

#[test]
fn parts_of_a_sequence_fit_together() {
    let folder = Folder::new();
    sequence(&folder);
    folder.run(&format!("render f_*.ply -o a_%d.exr {SMALL}")).ok();
    for range in ["8-9", "10-11"] {
        folder.run(&format!("render f_*.ply -o b_%d.exr {SMALL} --frames {range}")).ok();
    }
    for frame in 8..=11 {
        folder.run(&format!("compare a_{frame}.exr b_{frame}.exr")).ok();
    }
    folder.run("render f_*.ply -o c.png --frames 3-5").fails(3, &["nearest of 4 found is 8"]);
    folder.run("render f_*.ply -o c.png --frames 5-3").fails(2, &["5-3"]);
}

/// A fast jet beside water at rest, in which no neighbours approach each other. A torn one, whose lower half falls
/// faster, foams by its turbulence; a smooth one does not.
#[test]
fn fast_torn_jets_foam() {
    let folder = Folder::new();
    for (name, upper) in [("torn", 5.0), ("smooth", 9.0)] {
        for frame in 1..=2 {
            let mut rows = String::from("x,y,z,vx,vy,vz,id\n");
            for i in 0..1000_u16 {
                let [x, y, z] = [i % 10, i / 10 % 10, i / 100].map(|i| 0.05 * f32::from(i));
                let (aside, fall) = match i {
                    0..980 => (0.0, 0.0),
                    980..990 => (2.0, 9.0),
                    _ => (2.0, upper),
                };
                rows += &format!("{},{y},{z},0,-{fall},0,{i}\n", x + aside);
            }
            folder.text(&format!("{name}_{frame}.csv"), &rows);
        }
    }
    folder.text("still.toml", "[surface_foam]\nturbulence = 0.0\n");
    let run = |what: &str| {
        folder.run(&format!("render {what} {SMALL} --fps 4 --overwrite")).ok().stderr()
    };
    for (input, foams) in [
        ("torn_*.csv -o a_%d.png", true),
        ("torn_1.csv -o a.png", true),
        ("torn_1.csv -o a.png --settings still.toml", false),
        ("smooth_*.csv -o a_%d.png", false),
        ("smooth_1.csv -o a.png", false),
    ] {
        let said = run(input);
        assert_eq!(
            said.contains("surface foam from Weber number of trapped air"),
            foams,
            "{input}: {said}"
        );
    }
    assert!(run("smooth_1.csv -o a.png").contains("no foam: the water is calm"));
    folder.text("wild.toml", "[surface_foam]\nturbulence = 5.0\n");
    let wild = "-o a.png --settings wild.toml --overwrite";
    let why = "[surface_foam] turbulence: expected 0 to 1, found 5";
    folder.run(&format!("render torn_1.csv {SMALL} {wild}")).fails(3, &[why]);
    folder.run(&format!("demo --size 32x18 {wild}")).fails(3, &[why]);
}

/// A loose body of water is drawn as water, but its Weber number is that of the density in the file.
#[test]
fn loose_water_foams_by_its_own_density() {
    let folder = Folder::new();
    let mut rows = String::from("x,y,z,vx,vy,vz,density\n");
    // Every second place of a lattice, of which the radius is told.
    for i in (0..8192_u16).filter(|i| (i % 16 + i / 16 % 16 + i / 256) % 2 == 0) {
        let [x, y, z] = [i % 16, i / 16 % 16, i / 256].map(|i| 0.05 * f32::from(i));
        rows += &format!("{x},{y},{z},1,0,0,500\n");
    }
    folder.text("f.csv", &rows);
    folder.text("rest.toml", "[water]\nrest_density = 1000.0\n");
    // 1e-5 (1.43 / spacing)² density speed² is 4.1. With the density of a body it would be 33.
    let foam = |threshold: f32| -> f32 {
        let common = format!(
            "{SMALL} --radius 0.025 --overwrite --settings rest.toml --layers surface_foam.thickness"
        );
        folder.run(&format!("render f.csv -o a.exr {common} --surface-foam {threshold}")).ok();
        let picture = folder.picture("a.exr");
        let layer = picture.channels.iter().find(|c| c.name == "surface_foam.thickness");
        layer.expect("the layer").data.iter().sum()
    };
    let [below, above] = [foam(3.0), foam(16.0)];
    assert!(below > 0.0 && above == 0.0, "{below} {above}");
}

/// Water that is fast from the second frame on: foam needs time to form, and stays when the water is slow again. The
/// frames that are drawn make no difference to it.
#[test]
fn foam_comes_and_goes_whichever_frames_are_drawn() {
    let folder = Folder::new();
    folder.water_that_is_fast_for_a_while();
    let common = format!("{SMALL} --surface-foam 1 --fps 4 --layers surface_foam.thickness");
    folder.run(&format!("render f_*.csv -o a_%d.exr {common}")).ok();
    folder.run(&format!("render f_*.csv -o b_%d.exr {common} --frames 3-4")).ok();
    folder.run(&format!("render f_*.csv -o b_%d.exr {common} --frames 4 --overwrite")).ok();
    for frame in 3..=4 {
        folder.run(&format!("compare a_{frame}.exr b_{frame}.exr")).ok();
    }
    folder.run(&format!("render f_*.csv -o e_%d.exr {common} --frames 2-4 --every 2")).ok();
    folder.run("compare a_4.exr e_4.exr").ok();
    assert!(folder.path("e_2.exr").exists() && !folder.path("e_3.exr").exists());
    let foam = |name: &str| -> f32 {
        let picture = folder.picture(name);
        let layer = picture.channels.iter().find(|c| c.name == "surface_foam.thickness");
        layer.expect("the layer").data.iter().sum()
    };
    let [first, second, third, fourth] = [1, 2, 3, 4].map(|n| foam(&format!("a_{n}.exr")));
    assert_eq!([first, second], [0.0; 2], "at rest, and it has only begun");
    assert!(third > 0.0 && fourth > 0.0, "{third} {fourth}");
    folder.run(&format!("render f_4.csv -o c.exr {common}")).ok();
    assert_eq!(foam("c.exr"), 0.0, "alone it is at rest");
    // The earlier frames need not be valid.
    folder.text("f_2.csv", "x,y\n1,2\n");
    folder.run(&format!("render f_*.csv -o d_%d.exr {common} --frames 4")).ok();
    assert!(foam("d_4.exr") < fourth);
}

/// A frame that was not probed has many more particles than the others: the frames before it are simulated again, and
/// nothing is lost.
#[test]
fn more_room_steps_through_the_frames_again() {
    let folder = Folder::new();
    // Of 18 frames the ninth is not probed; there is room for 1024 particles at least.
    for frame in 1..=18 {
        let mut rows = String::from("x,y,z,vx,vy,vz,id\n");
        let more = if frame == 9 { block(11) } else { Vec::new() };
        let more = more.into_iter().map(|[x, y, z]| [x + 3.0, y, z]);
        for (i, [x, y, z]) in block(5).into_iter().chain(more).enumerate() {
            rows += &format!("{x},{y},{z},9,0,0,{i}\n");
        }
        folder.text(&format!("f_{frame}.csv"), &rows);
    }
    let common = format!("{SMALL} --surface-foam 1 --fps 30 --frames 10 --layers none");
    let said = folder.run(&format!("render f_*.csv -o a_%d.png {common}")).ok().stderr();
    let expected = "frame 10: the earlier frames are stepped through again";
    assert!(said.contains(expected) && !said.contains("start again"), "{said}");
}

/// Small waves on water that rests move from frame to frame, also where no foam is remembered, and a part of the
/// sequence shows the same.
#[test]
fn small_waves_move_in_every_sequence() {
    let folder = Folder::new();
    for frame in 1..=2 {
        folder.particles(&format!("f_{frame}.ply"), block(6));
    }
    folder.text("waves.toml", "[wavelets]\nslope = 0.3\n");
    let from_above = "--eye 0,1.6,1.6 --target 0,0.5,0 --radius 0.05 --settings waves.toml";
    let common = format!("{SMALL} {from_above} --surface-foam none --layers none");
    let said = folder.run(&format!("render f_*.ply -o a_%d.exr {common}")).ok().stderr();
    assert!(said.contains("30 frames a second (assumed"), "{said}");
    folder.run("compare a_1.exr a_2.exr --tolerance 1e-4").fails(1, &["RMSE"]);
    folder.run(&format!("render f_*.ply -o b_%d.exr {common} --frames 2")).ok();
    folder.run("compare a_2.exr b_2.exr").ok();
}

/// The shutter needs velocities: without any in the files they are found, also if no foam needs them.
#[test]
fn a_shutter_finds_velocities() {
    let folder = Folder::new();
    for frame in 1..=2_u8 {
        let mut rows = String::from("x,y,z,id\n");
        for (i, [x, y, z]) in block(5).into_iter().enumerate() {
            rows += &format!("{},{y},{z},{i}\n", x + 0.05 * f32::from(frame));
        }
        folder.text(&format!("f_{frame}.csv"), &rows);
    }
    let blurred = SMALL.replace("--samples 1", "--samples 2 --shutter 1/30");
    let common = format!("{blurred} --surface-foam none --fps 30 --frames 2 --layers none");
    let said = folder.run(&format!("render f_*.csv -o a_%d.exr {common}")).ok().stderr();
    assert!(said.contains("velocities are not in the files"), "{said}");
    assert!(!said.contains("blurs nothing"), "{said}");
}

/// A camera that is given as matrices has no target, and focuses on the water.
#[test]
fn matrices_focus_on_the_water() {
    let folder = Folder::new();
    folder.particles("a.ply", block(8));
    // The camera of `FRONT`.
    let (wide, near) = (20.0_f32.to_radians().tan().recip(), 0.01_f32 * 2.35);
    let aspect = 96.0 / 64.0;
    let view = "1,0,0,0,0,1,0,0,0,0,1,0,0,-0.35,-2.35,1";
    let projection = format!("{},0,0,0,0,{},0,0,0,0,0,-1,0,0,{near},0", wide / aspect, -wide);
    folder.text("m.json", &format!("{{\"view\":[{view}],\"projection\":[{projection}]}}"));
    let blurred = SMALL.replace("--samples 1", "--samples 4 --aperture 0.4");
    let common = format!("render a.ply {blurred} --layers none");
    folder.run(&format!("{common} {FRONT} -o target.exr")).ok();
    folder.run(&format!("{common} --radius 0.05 --camera m.json -o matrices.exr")).ok();
    folder.run("compare target.exr matrices.exr --tolerance 0.01").ok();
}

/// Motion vectors of a camera that moves around one frame, and before scenes without particles.
#[test]
fn a_camera_alone_makes_motion() {
    let folder = Folder::new();
    let mut rows = String::from("x,y,z,vx,vy,vz\n");
    block(5).iter().for_each(|[x, y, z]| rows += &format!("{x},{y},{z},0,50,0\n"));
    folder.text("a.csv", &rows);
    folder.text(
        "c.json",
        r#"{"keys":[{"frame":1,"eye":[0,2,6],"target":[0,0.5,0]},{"frame":3,"eye":[2,2,6],"target":[2,0.5,0]}]}"#,
    );
    let motion = |picture: &str| {
        let picture = folder.picture(picture);
        let water = picture.channel("water.depth.Z");
        ["motion.X", "motion.Y"].map(|name| {
            let all = picture.channel(name).unwrap().iter().enumerate();
            let seen = all.filter(|(i, _)| water.is_none_or(|z| z[*i] < EMPTY));
            let seen = seen.inspect(|(i, v)| assert!(v.is_finite(), "{name} at {i}"));
            seen.map(|(_, v)| v.abs()).fold(0.0, f32::max)
        })
    };
    let around = format!("{SMALL} {FRONT} --up-axis y --turntable=8 --surface-foam none");
    folder.run(&format!("render a.csv {around} --layers motion,water.depth -o t_%d.exr")).ok();
    assert_eq!(motion("t_1.exr"), [0.0; 2], "no picture before");
    let [x, y] = motion("t_2.exr");
    // The water stands still, however fast it is: it would move by 60 pixels.
    assert!(x > 1.0 && y < 4.0, "{x} {y}");
    for scene in ["--bubbles one", "--shore pool"] {
        let common = format!("--camera c.json {SIZE} --layers motion --overwrite");
        folder.run(&format!("render {scene} --frames 2 {common} -o b.exr")).ok();
        let [x, _] = motion("b.exr");
        assert!(x > 1.0, "{scene}: {x}");
    }
}

/// A block that flies to the right and a little up, before a camera that rests or follows it.
#[test]
fn motion_is_what_moved_in_a_frame() {
    let folder = Folder::new();
    let (fps, speed) = (8.0_f32, [0.8_f32, 0.4]);
    for frame in 1..=3_u8 {
        let time = f32::from(frame) / fps;
        let mut rows = String::from("x,y,z,vx,vy,vz,id\n");
        for (i, [x, y, z]) in block(5).into_iter().enumerate() {
            let (x, y) = (x + speed[0] * time, y + speed[1] * time);
            rows += &format!("{x},{y},{z},{},{},0,{i}\n", speed[0], speed[1]);
        }
        folder.text(&format!("f_{frame}.csv"), &rows);
    }
    let keys = |frame: u8| {
        let x = 0.1 + speed[0] * f32::from(frame) / fps;
        format!("{{\"frame\":{frame},\"eye\":[{x},0.2,3],\"target\":[{x},0.2,0]}}")
    };
    let of = |k: &str| format!("{{\"fov_y_degrees\":40,\"keys\":[{k}]}}");
    folder.text("rests.json", &of(&keys(2)));
    folder.text("follows.json", &of(&[1, 2, 3].map(keys).join(",")));
    for (camera, supersample) in [("rests", 1), ("follows", 2)] {
        let common = format!(
            "{GROUND} --layers motion,water.depth,scene --camera {camera}.json --surface-foam none \
             --supersample {supersample} --overwrite"
        );
        let run = folder.run(&format!("render f_*.csv -o a_%d.exr {common}")).ok();
        assert!(run.stderr().contains("8 frames a second (found"), "{}", run.stderr());
        folder.run(&format!("render f_*.csv -o b_%d.exr {common} --frames 3")).ok();
        folder.run("compare a_3.exr b_3.exr").ok();
        let first = folder.picture("a_1.exr");
        let motion = |picture: &Layers, name| picture.channel(name).unwrap().to_vec();
        assert!(motion(&first, "motion.X").iter().all(|x| *x == 0.0), "no frame before");
        let picture = folder.picture("a_2.exr");
        let depth = motion(&picture, "water.depth.Z");
        let [x, y] = ["motion.X", "motion.Y"].map(|name| motion(&picture, name));
        let mut seen = 0;
        let scene = motion(&picture, "scene.Z");
        // A pixel at an outline has the motion of its nearest surface.
        for (i, z) in depth.into_iter().enumerate().filter(|(i, z)| *z < scene[*i].min(EMPTY)) {
            seen += 1;
            // 64 rows are 40 degrees.
            let pixels = 32.0 / 20.0_f32.to_radians().tan() / z / fps;
            let along = if camera == "rests" { speed[0] } else { 0.0 };
            let off = [x[i] - along * pixels, y[i] + speed[1] * pixels];
            // The smoothed surface is within a few radii of the frontmost particle.
            assert!(off.iter().all(|off| off.abs() < 0.1 * 0.9 * pixels), "{camera}: {off:?}");
        }
        assert!(seen > 100, "{camera}: {seen} pixels");
        // The ground stands still, and moves relative to a moving camera.
        let ground = (96 * 60..96 * 64).filter(|i| scene[*i] < EMPTY);
        let passes = ground.map(|i| x[i]).fold(0.0, f32::min);
        assert_eq!(passes < -1.0, camera == "follows", "{camera}: {passes}");
    }
}

#[test]
fn a_bad_frame_does_not_lose_the_others() {
    let folder = Folder::new();
    sequence(&folder);
    let bytes = std::fs::read(folder.path("f_9.ply")).unwrap();
    std::fs::write(folder.path("f_9.ply"), &bytes[..bytes.len() / 2]).unwrap();
    let command = format!("render f_%d.ply -o out.png {SMALL}");
    folder.run(&command).fails(1, &["1 of 4", "9 (", "ends too early"]);
    let there = |frame: u32| folder.exists(&format!("out.{frame:04}.png"));
    assert!(there(8) && !there(9) && there(10) && there(11));
    // When the file is mended, a rerun draws the frame that was missing.
    std::fs::write(folder.path("f_9.ply"), bytes).unwrap();
    let run = folder.run(&command).ok();
    assert!(there(9) && run.stderr().contains("3 finished frames"), "{}", run.stderr());
}

#[test]
fn a_frame_with_a_particle_absurdly_far_spoils_no_other() {
    let folder = Folder::new();
    for frame in 1..=3 {
        folder.particles(&format!("f_{frame}.ply"), block(7));
    }
    folder.run(&format!("render f_*.ply -o a_%d.exr {SMALL}")).ok();
    let mut positions = block(7);
    positions.push([1.0e20, 0.0, 0.0]);
    folder.particles("f_2.ply", positions);
    folder.run(&format!("render f_*.ply -o b_%d.exr {SMALL}")).ok();
    for frame in 1..=3 {
        folder.run(&format!("compare a_{frame}.exr b_{frame}.exr")).ok();
    }
}

#[test]
fn a_single_picture_is_drawn_again() {
    let folder = Folder::new();
    folder.particles("a.ply", block(3));
    folder.text("a.png", "old");
    folder.run(&format!("render a.ply -o a.png {SMALL}")).ok();
    assert_eq!(folder.picture("a.png").width, 96);
}

/// One file is drawn from all sides, unmoved, and the last picture is one step before the first.
#[test]
fn a_turntable_goes_round_one_file() {
    let folder = Folder::new();
    // Longer than wide, so that the direction of view shows.
    let bar = block(12).into_iter().filter(|p| p[2].abs() < 0.2 && p[1] < 0.35).collect();
    folder.particles("bar_0046.ply", bar);
    let common =
        format!("render bar_0046.ply {SMALL} --radius 0.05 --turntable=8 --layers water.depth");
    folder.run(&format!("{common} -o t.exr -o t.mp4 --fps 24")).ok();
    assert_eq!(folder.files().iter().filter(|name| name.ends_with(".exr")).count(), 8);
    assert_eq!(folder.film("t.mp4"), (8, 24.0));
    let pixels = |name: &str| {
        let depth = folder.picture(name);
        let depth = depth.channel("water.depth.Z").unwrap();
        let wet: Vec<usize> = (0..depth.len()).filter(|i| depth[*i] < EMPTY).collect();
        let inside = |i: &usize| (1..95).contains(&(i % 96)) && (1..63).contains(&(i / 96));
        assert!(wet.iter().all(inside), "{name}: all of it is seen");
        wet.len() as f32
    };
    let seen: Vec<f32> = (1..=8).map(|i| pixels(&format!("t.{i:04}.exr"))).collect();
    // After half a turn the bar looks the same; after a quarter it does not.
    for i in 0..4 {
        assert!((seen[i] / seen[i + 4] - 1.0).abs() < 0.05, "{seen:?}");
    }
    assert!((0..4).any(|i| (seen[i] / seen[i + 2] - 1.0).abs() > 0.1), "{seen:?}");
    folder.run("compare t.0001.exr t.0003.exr --tolerance 0.001").fails(1, &["RMSE"]);
    // An existing picture is not drawn again.
    let said = folder.run(&format!("{common} -o t.exr")).ok().stderr();
    assert!(said.contains("8 finished"), "{said}");
    // A duration in seconds sets the number of frames.
    folder.run(&format!("render bar_0046.ply {SMALL} --turntable=0.25s --fps 16 -o s.mp4")).ok();
    assert_eq!(folder.film("s.mp4"), (4, 16.0));
    let seconds = "--turntable=0.5s --fps 16 --film-fps 8";
    folder.run(&format!("render bar_0046.ply {SMALL} {seconds} -o s.mp4")).ok();
    assert_eq!(folder.film("s.mp4"), (4, 8.0));
}

/// A sequence runs while the camera turns; a turn may be longer than the sequence.
#[test]
fn a_turntable_goes_round_a_sequence() {
    let folder = Folder::new();
    for frame in 0..4 {
        folder.particles(&format!("f_{frame}.ply"), block(5));
    }
    let eye = |name: &str| {
        let picture = folder.picture(name);
        let (_, text) = picture.attributes.iter().find(|(key, _)| key == "camera").unwrap().clone();
        let camera: serde_json::Value = serde_json::from_str(&text).unwrap();
        [0, 2].map(|axis| {
            camera["eye"][axis].as_f64().unwrap() - camera["target"][axis].as_f64().unwrap()
        })
    };
    let common = format!("render f_*.ply {SMALL} {FRONT} --layers none --surface-foam none");
    folder.run(&format!("{common} -o a.exr --turntable")).ok();
    for (frame, expected) in
        [[0.0, 2.35], [2.35, 0.0], [0.0, -2.35], [-2.35, 0.0]].iter().enumerate()
    {
        let found = eye(&format!("a.{frame:04}.exr"));
        let near = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1.0e-4);
        assert!(near, "{frame}: {found:?}");
    }
    folder.run(&format!("{common} -o b.exr --turntable=8 --frames 2-2")).ok();
    let [x, z] = eye("b.0002.exr");
    assert!(
        x.abs() < 1.0e-4 && (z - 2.35).abs() < 1.0e-4,
        "begins with the first that is drawn: {x} {z}"
    );
    // Combinations that a turntable refuses.
    folder.text("keys.json", r#"{"keys":[{"frame":0,"eye":[0,0,5],"target":[0,0,0]}]}"#);
    folder
        .run(&format!("render f_0.ply -o c.png {SMALL} --turntable --camera keys.json"))
        .fails(3, &["--turntable", "stands still"]);
    folder.run("render --bubbles one -o c.png --turntable").fails(2, &["--turntable"]);
    folder.run("render f_0.ply -o c.png --turntable=1").fails_at_once();
    folder.run("render f_0.ply -o c.png --turntable=0.01s").fails(2, &["2 to 100000"]);
}

/// Missing data in files and their effect are reported once.
#[test]
fn what_is_missing_is_told() {
    let folder = Folder::new();
    folder.particles("a.ply", block(4));
    let said = |command: &str| folder.run(&format!("render {command} {SMALL}")).ok().stderr();
    let text = said("a.ply -o a.png");
    assert_eq!(text.matches("no velocities and no ids: no foam").count(), 1, "{text}");
    // If no foam is wanted, nothing is reported.
    let text = said("a.ply -o a.png --surface-foam none");
    assert!(!text.contains("velocities"), "{text}");
    // In a sequence whose particle order changes, velocities cannot be found.
    for frame in 1..=3_usize {
        let mut positions = block(6);
        (0..216).for_each(|i| positions.swap(i, (i * 61 * frame + 31) % 216));
        folder.particles(&format!("f_{frame}.ply"), positions);
    }
    let text = said("f_*.ply -o f.png");
    assert_eq!(text.matches("do not keep their order: no foam").count(), 1, "{text}");
}

/// One frame of four has neither velocities nor ids: this is reported, and it foams like the others.
#[test]
fn a_frame_that_lacks_what_others_have_is_told() {
    let folder = Folder::new();
    let (fps, speed) = (64.0_f32, 2.0_f32);
    for frame in 1..=4_u8 {
        let full = frame != 3;
        let mut rows = String::from(if full { "x,y,z,vx,vy,vz,id\n" } else { "x,y,z\n" });
        for (i, [x, y, z]) in block(5).into_iter().enumerate() {
            // The upper half slides over the lower one.
            let speed = if y > 0.15 { speed } else { 0.0 };
            rows += &format!("{},{y},{z}", x + speed / fps * f32::from(frame));
            rows += &if full { format!(",{speed},0,0,{i}\n") } else { "\n".into() };
        }
        folder.text(&format!("f_{frame}.csv"), &rows);
    }
    let common = format!("{SMALL} --surface-foam 1 --layers surface_foam.thickness");
    let said = folder.run(&format!("render f_*.csv -o a_%d.exr {common}")).ok().stderr();
    let expected =
        "f_3.csv: no velocities and ids, which other frames have; velocities and ids are found";
    assert_eq!(said.matches(expected).count(), 1, "{said}");
    assert!(said.contains("64 frames a second (found"), "{said}");
    assert!(!said.contains("velocities are not in the files"), "{said}");
    let foam = |frame: u8| -> f32 {
        let picture = folder.picture(&format!("a_{frame}.exr"));
        picture.channel("surface_foam.thickness").unwrap().iter().sum()
    };
    let [before, here, after] = [2, 3, 4].map(foam);
    assert!(here > 0.7 * before && here > 0.7 * after, "{before} {here} {after}");
    folder.run(&format!("render f_*.csv -o b_%d.exr {common} --frames 3")).ok();
    folder.run("compare a_3.exr b_3.exr").ok();
}

/// A warning that is the same for each frame is printed for the first one, with a count at the end.
#[test]
fn a_warning_of_many_frames_is_said_once() {
    let folder = Folder::new();
    for frame in 1..=4_u8 {
        let mut positions = block(6);
        positions.extend(vec![[f32::NAN; 3]; usize::from(frame)]);
        folder.particles(&format!("f_{frame}.ply"), positions);
    }
    let said = folder.run(&format!("render f_*.ply -o a.png {SMALL}")).ok().stderr();
    assert_eq!(said.matches("or infinite, or too large").count(), 1, "{said}");
    assert!(
        said.contains(
            "warning in 4 of 4 frames, first in f_1.ply: 1 of 217 positions are not finite"
        ),
        "{said}"
    );
}
