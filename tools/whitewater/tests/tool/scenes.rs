//! Scenes: simulated ones, moving parts, and a moving camera.

use whitewater::io::particles::read;

use super::support::{Folder, SIZE, block, names};

#[test]
fn what_is_simulated_can_be_drawn() {
    let folder = Folder::new();
    let command = "simulate corridor --spacing 0.1 --frames 2-8 --keep 7-8 --out c";
    folder.run(&format!("{command} --threads 1")).ok();
    let all = ["camera.json", "corridor_0007.bgeo", "corridor_0008.bgeo", "scene.json"];
    assert_eq!(names(&folder.path("c")), all);
    let before = all.map(|name| std::fs::read(folder.path("c").join(name)).unwrap());
    folder.run(&format!("{command} --threads 3")).ok();
    assert!(before == all.map(|name| std::fs::read(folder.path("c").join(name)).unwrap()));
    let view = "--scene c/scene.json --camera c/camera.json --supersample 1";
    folder.run(&format!("render c/corridor_*.bgeo -o p_%d.png {view} {SIZE}")).ok();
    assert!(folder.exists("p_7.png") && folder.exists("p_8.png"));
}

/// A frame's positions follow its velocities at the rate that is asked for, and the seed moves the particles.
#[test]
fn simulations_have_a_rate_and_a_seed() {
    let folder = Folder::new();
    let run = |out: &str, more: &str| {
        let common = "simulate corridor --spacing 0.1 --frames 0-8 --keep 7-8";
        folder.run(&format!("{common} --out {out} {more}")).ok();
        [7, 8].map(|frame| read(&folder.path(&format!("{out}/corridor_000{frame}.bgeo"))).unwrap())
    };
    for fps in [30.0_f32, 60.0] {
        let [before, after] = run("r", &format!("--fps {fps}"));
        let (ids, velocities) = (before.ids.unwrap(), before.velocities.unwrap());
        let at: std::collections::HashMap<u32, usize> =
            ids.into_iter().enumerate().map(|(i, id)| (id, i)).collect();
        let (mut off, mut way) = (0.0, 0.0);
        for (id, now) in after.ids.unwrap().iter().zip(&after.positions) {
            let Some(i) = at.get(id) else { continue };
            for c in 0..3 {
                let (moved, said) = (now[c] - before.positions[*i][c], velocities[*i][c] / fps);
                off += (moved - said).abs();
                way += said.abs();
            }
        }
        assert!(way > 0.0 && off < 0.3 * way, "{fps}: {off} of {way}");
    }
    let positions = |seed: u32| run("s", &format!("--seed {seed}"))[1].positions.clone();
    assert!(positions(1) == positions(1) && positions(1) != positions(2));
}

/// The JSON scene in the help is one.
#[test]
fn the_scene_of_the_help_is_drawn() {
    let folder = Folder::new();
    let help = folder.run("render --help").ok().stdout();
    let from = help.find("{\"ground\"").expect("an example");
    let to = from + help[from..].find("]}.").expect("its end") + 2;
    folder.text("help.json", &help[from..to]);
    folder.particles("a.ply", block(4));
    folder.run(&format!("render a.ply -o a.png --scene help.json {SIZE}")).ok();
    folder.text("bad.json", &help[from..to].replace("\"half\"", "\"halves\""));
    let why = ["unknown field `halves`"];
    folder.run(&format!("render a.ply -o b.png --scene bad.json {SIZE}")).fails(3, &why);
}

#[test]
fn what_cannot_be_simulated_is_refused() {
    let folder = Folder::new();
    folder.run("simulate bamboo --out b --spacing 0.1").fails(2, &["--spacing", "0.1"]);
    folder.run("simulate bamboo --out b --frames 3-1").fails(2, &["3-1"]);
    let keep = "simulate bamboo --out b --frames 1-2 --keep 5-6";
    folder.run(keep).fails(2, &["--keep", "frames 1-2", "found 5-6"]);
    folder.text("file", "");
    folder.run("simulate corridor --out file").fails(5, &["cannot write file"]);
    assert_eq!(folder.run("simulate lake --out b").0.status.code(), Some(2));
    assert_eq!(folder.files(), ["file"]);
}

#[test]
fn parts_and_the_camera_move_by_the_number_of_the_frame() {
    let folder = Folder::new();
    for frame in 1..=3 {
        folder.particles(&format!("f_{frame}.ply"), block(4));
    }
    folder.text(
        "s.json",
        r#"{"boxes":[{"name":"lid","material":"timber","centre":[0.4,0.2,0],"half":[0.1,0.2,0.2]}],
            "ground":{"y":0,"material":"sand"},
            "motion":[{"parts":["lid"],"origin":[0,0,0],"first_frame":1,"poses":[
                [0,0,0,0,0,0,1],[0,0,0,0,0.3826834,0,0.9238795],[0,0,0,0,0.3826834,0,0.9238795]]}]}"#,
    );
    folder.text(
        "c.json",
        r#"{"keys":[{"frame":1,"eye":[0,0.5,2],"target":[0,0.2,0]},
                    {"frame":9,"eye":[2,0.5,2],"target":[0,0.2,0]}]}"#,
    );
    // Small waves would move too, and the pattern of spray.
    folder.text("calm.toml", "[wavelets]\nslope = 0.0\n[spray]\nclumps = 0.0\n");
    let draw = |name: &str, view: &str, more: &str| {
        let look =
            format!("--scene s.json --radius 0.05 --supersample 1 --settings calm.toml {SIZE}");
        folder.run(&format!("render f_*.ply -o {name}_%d.exr {view} {look} {more}")).ok();
    };
    let still = "--eye 0,0.5,2 --target 0,0.2,0";
    draw("still", still, "");
    folder.run("compare still_1.exr still_2.exr").fails(1, &[]);
    folder.run("compare still_2.exr still_3.exr").ok();
    draw("alone", still, "--frames 2");
    folder.run("compare still_2.exr alone_2.exr").ok();
    draw("moving", "--camera c.json", "");
    folder.run("compare still_1.exr moving_1.exr").ok();
    folder.run("compare still_3.exr moving_3.exr").fails(1, &[]);
    draw("one", "--camera c.json", "--frames 3");
    folder.run("compare moving_3.exr one_3.exr").ok();
    folder.text("c.json", r#"{"keys":[{"frame":1,"eye":[0,0,0],"target":[0,0,0]}]}"#);
    folder
        .run("render f_*.ply -o x.png --camera c.json")
        .fails(3, &["frame 1", "different places"]);
}

/// A table on sand.
const TABLE: &str = r#"{"boxes":[{"name":"table","material":"timber","centre":[0,0.2,0],"half":[0.5,0.2,0.5]}],
    "ground":{"y":0,"material":"sand"}}"#;

/// Blobs from a file fall onto the scene, and torn-off blobs split on the way.
#[test]
fn blobs_fall_on_the_scene() {
    let folder = Folder::new();
    folder.text("s.json", TABLE);
    folder.text(
        "b.json",
        r#"{"blobs":[{"center":[0,0.6,0],"radius":0.1},{"center":[1.2,0.6,0],"radius":0.1}],"moves":true}"#,
    );
    folder.text("few.toml", "[bubbles]\nvariants = 1\nbubbles = 8\nmap_size = 16\n");
    let view = "--eye 0.6,0.3,3 --target 0.6,0.3,0 --fov 40 --supersample 1";
    let look = format!("{view} {SIZE} --settings few.toml --scene s.json --validate");
    folder.run(&format!("render --bubbles b.json --frames 45-45 -o b_%d.exr {look}")).ok();
    let picture = folder.picture("b_45.exr");
    let z = picture.channel("bubbles.Z").unwrap();
    // Lowest row of blobs on the left, over the table, and on the right. 64 rows are 2.18 m at a distance of 3 m.
    let lowest = |columns: std::ops::Range<usize>| {
        let row = (0..64).rfind(|y| columns.clone().any(|x| z[96 * y + x] < 1.0e9));
        let row = row.expect("a blob") as f32;
        0.3 + (32.0 - row - 1.0) / 64.0 * 2.184
    };
    let (table, ground) = (lowest(0..48), lowest(48..96));
    assert!((0.3..0.45).contains(&table), "{table}");
    assert!((-0.1..0.08).contains(&ground), "{ground}");
    let text = "a file of moving blobs cannot be drawn together with particles";
    folder.particles("a.ply", block(2));
    folder.run(&format!("render a.ply --bubbles b.json -o n.png {look}")).fails(3, &[text]);
}

/// A scene stands in a set if one is named; otherwise it has its own ground and sky. Water alone has no scene.
#[test]
fn a_scene_stands_in_a_set() {
    let folder = Folder::new();
    folder.text("s.json", TABLE);
    folder.particles("a.ply", block(4));
    let view = "--eye 2,1.2,2 --target 0,0.2,0 --fov 60 --supersample 1";
    let draw = |more: &str| {
        let command = format!("render a.ply -o a.png {view} {SIZE} --scene s.json {more}");
        folder.run(&command).ok();
        folder.picture("a.png").rgb().unwrap()
    };
    let (own, pool, lab) = (draw(""), draw("--set pool --validate"), draw("--set lab"));
    // The corners of the picture show ground and sky.
    let changed = |a: &[[f32; 3]], b: &[[f32; 3]], i: usize| {
        a[i].iter().zip(b[i]).any(|(a, b)| (a - b).abs() > 0.02)
    };
    for (one, other) in [(&own, &pool), (&own, &lab), (&pool, &lab)] {
        assert!(changed(one, other, 0) && changed(one, other, one.len() - 1));
    }
    folder
        .run("render a.ply -o a.png --scene s.json --set none")
        .fails(2, &["--set none", "--scene"]);
}
