//! Many frames: names, ranges, reruns, bad frames.

use whitewater::io::picture::{EMPTY, Layers};

use super::support::{Folder, SMALL, block};

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

/// A film is one file of all frames, at the rate that is asked for; its frames are those of the range.
#[test]
fn a_film_has_all_frames() {
    let folder = Folder::new();
    sequence(&folder);
    let command = format!("render f_*.ply -o film.mp4 {SMALL} --fps 12");
    let run = folder.run(&format!("{command} -o again.mp4")).ok();
    assert!(run.stderr().contains("film.mp4"), "{}", run.stderr());
    assert_eq!([folder.film("film.mp4"), folder.film("again.mp4")], [(4, 12.0); 2]);
    // It is never there in part: drawn again, whatever there is.
    folder.run(&format!("{command} --every 2")).ok();
    assert_eq!(folder.film("film.mp4"), (2, 6.0));
    folder.run(&command.replace("96x64", "95x64")).fails(2, &["--size", "96x64"]);
    folder.run(&command.replace("film", "film_%d")).fails(2, &["film_%d.mp4"]);
    assert_eq!(folder.film("film.mp4"), (2, 6.0), "the one before is kept");
    // Without particles, too.
    folder
        .run(&format!("render --bubbles one --frames 0-3 --every 2 -o b.mp4 {SMALL} --fps 12"))
        .ok();
    assert_eq!(folder.film("b.mp4"), (2, 6.0));
    assert_eq!(folder.files().len(), 7, "{:?}", folder.files());
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
    folder.run("render f_*.ply -o c.png --frames 3-5").fails(3, &["8 to 11"]);
    folder.run("render f_*.ply -o c.png --frames 5-3").fails(2, &["5-3"]);
}

/// Water that is fast from the second frame on: foam needs time to come, and stays when it is slow
/// again; which frames are drawn together does not show.
#[test]
fn foam_comes_and_goes_whichever_frames_are_drawn() {
    let folder = Folder::new();
    for (frame, speed) in [(1, 0.0), (2, 9.0), (3, 9.0), (4, 0.0)] {
        let mut rows = String::from("x,y,z,vx,vy,vz,id\n");
        for (i, [x, y, z]) in block(5).into_iter().enumerate() {
            rows += &format!("{x},{y},{z},{speed},0,0,{i}\n");
        }
        folder.text(&format!("f_{frame}.csv"), &rows);
    }
    let common = format!("{SMALL} --foam 1 --fps 4 --layers water.foam.thickness");
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
        let layer = picture.channels.iter().find(|c| c.name == "water.foam.thickness");
        layer.expect("the layer").data.iter().sum()
    };
    let [first, second, third, fourth] = [1, 2, 3, 4].map(|n| foam(&format!("a_{n}.exr")));
    assert_eq!([first, second], [0.0; 2], "at rest, and it has only begun");
    assert!(third > 0.0 && fourth > 0.0, "{third} {fourth}");
    folder.run(&format!("render f_4.csv -o c.exr {common}")).ok();
    assert_eq!(foam("c.exr"), 0.0, "alone it is at rest");
    // The frames before need not be good.
    folder.text("f_2.csv", "x,y\n1,2\n");
    folder.run(&format!("render f_*.csv -o d_%d.exr {common} --frames 4")).ok();
    assert!(foam("d_4.exr") < fourth);
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
    for (camera, supersample) in [("rests", 1), ("rests", 2), ("follows", 2)] {
        let common = format!(
            "{SMALL} --layers motion,water.depth,scene --camera {camera}.json --foam none \
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
        // A pixel at an outline has the motion of what is nearest in it.
        for (i, z) in depth.into_iter().enumerate().filter(|(i, z)| *z < scene[*i].min(EMPTY)) {
            seen += 1;
            // 64 rows are 40 degrees.
            let pixels = 32.0 / 20.0_f32.to_radians().tan() / z / fps;
            let along = if camera == "rests" { speed[0] } else { 0.0 };
            let off = [x[i] - along * pixels, y[i] + speed[1] * pixels];
            // The smoothed surface is no farther than a few radii from the frontmost.
            assert!(off.iter().all(|off| off.abs() < 0.1 * 0.9 * pixels), "{camera}: {off:?}");
        }
        assert!(seen > 100, "{camera}: {seen} pixels");
        // The ground stands still, and passes a camera that moves.
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
    // Mended, the rerun draws the one that was missing.
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
