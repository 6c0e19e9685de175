//! Shoreline and contact foam.

use whitewater::io::picture::{EMPTY, Layers, write_png_values};

use super::support::{FRONT, Folder, SIZE, block};

/// A hill in the sea.
const HILL: &str =
    r#"{"spheres":[{"name":"hill","material":"sand","centre":[0,-3,0],"radius":5}]}"#;

/// Distance from the y axis at which a pixel of 96x64 sees a level, from 0,14,4 towards the origin at 50 degrees.
fn radius(pixel: usize, level: f32) -> f32 {
    let scale = 25.0_f32.to_radians().tan() / 32.0;
    let [across, up] = [(pixel % 96) as f32 - 47.5, 31.5 - (pixel / 96) as f32].map(|v| v * scale);
    let long = 14.0_f32.hypot(4.0);
    let [y, z] = [(-14.0 + 4.0 * up) / long, (-4.0 - 14.0 * up) / long];
    let way = (level - 14.0) / y;
    if way < 0.0 { f32::INFINITY } else { (across * way).hypot(4.0 + z * way) }
}

#[test]
fn foam_goes_round_a_hill_of_ones_own() {
    let folder = Folder::new();
    folder.text("hill.json", HILL);
    folder.text(
        "map.toml",
        "[shore]\nmap = 128\n[shoreline]\nsea_reach = 3.0\nland_reach = 1.0\n[contact]\nopacity = 0.0\n",
    );
    let view = "--eye 0,14,4 --target 0,0,0 --fov 50 --supersample 1";
    let common = format!("render --shore hill.json {view} {SIZE} --settings map.toml");
    folder.run(&format!("{common} --validate -o map.exr")).ok();
    let picture = folder.picture("map.exr");
    let foam = picture.channel("shore.amount").unwrap();
    // The shore is a circle of radius 4; foam reaches 3 out to sea. The hill is seen before the level behind it.
    assert!(foam.iter().any(|v| *v > 0.9), "no foam");
    let amounts = |range: std::ops::Range<f32>| -> Vec<f32> {
        let inside = |i: &usize| range.contains(&radius(*i, 0.0));
        (0..foam.len()).filter(inside).map(|i| foam[i]).collect()
    };
    let (land, shore, sea) = (amounts(0.0..1.5), amounts(4.0..5.5), amounts(7.3..99.0));
    assert!(land.len() > 50 && land.iter().all(|v| *v == 0.0), "on the land");
    assert!(sea.len() > 500 && sea.iter().all(|v| *v == 0.0), "far out");
    let mean = shore.iter().sum::<f32>() / shore.len() as f32;
    assert!(mean > 0.05, "{mean} by the shore");
    // A metre higher the circle has a radius of 3. The mean radius falls by as much, a little less where the outer foam
    // is weighted by its area.
    folder.run(&format!("{common} --level 1 -o high.exr")).ok();
    let high = folder.picture("high.exr");
    let middle = |foam: &[f32], level: f32| {
        let weighted = foam.iter().enumerate().map(|(i, v)| v * radius(i, level)).sum::<f32>();
        weighted / foam.iter().sum::<f32>()
    };
    let falls = middle(foam, 0.0) - middle(high.channel("shore.amount").unwrap(), 1.0);
    assert!((0.8..1.2).contains(&falls), "{falls}");
    assert!(picture.channel("contact.amount").unwrap().iter().all(|v| *v == 0.0));
    // Half a second later the foam has moved, which the colour shows.
    folder.run(&format!("{common} --frames 13 -o later.exr")).ok();
    folder.run("compare map.exr later.exr").fails(1, &[]);
    folder.run(&format!("{common} --level 9 -o none.png")).fails(3, &["no shore at 9", "--level"]);
    folder.text("bad.toml", "[shore]\nby = \"strip\"\n");
    let bad = common.replace("map.toml", "bad.toml");
    folder.run(&format!("{bad} -o none.png")).fails(3, &["strip", "map"]);
    folder.text("bad.toml", "[shoreline]\nfade = 0.0\n");
    folder.run(&format!("{bad} -o none.png")).fails(3, &["Settings.shore.shoreline.fade"]);
    assert!(!folder.exists("none.png"));
}

/// A ring as OBJ, about a hill whose shore is a circle of radius 4: from 7 out at sea to 3 on land.
fn ring(with_v: bool) -> String {
    let mut text = String::new();
    let corner = |i: usize, radius: f32| {
        let (sin, cos) = (i as f32 * std::f32::consts::TAU / 24.0).sin_cos();
        [radius * cos, radius * sin]
    };
    for i in 0..24 {
        for (radius, v) in [(7.0, 0.0), (4.0, 1.0), (3.0, 2.0)] {
            let [x, z] = corner(i, radius);
            text += &format!("v {x} 0.02 {z}\n");
            if with_v {
                text += &format!("vt 0 {v}\n");
            }
        }
    }
    for i in 0..24 {
        for k in 1..3 {
            let [a, b] = [i, (i + 1) % 24].map(|i| 3 * i + k);
            let face = [a, b, b + 1, a + 1];
            let face = face.map(|n| if with_v { format!("{n}/{n}") } else { n.to_string() });
            text += &format!("f {}\n", face.join(" "));
        }
    }
    text
}

/// A user's strip, from its own file: foam lies on it, and follows its v.
#[test]
fn a_strip_of_ones_own() {
    let folder = Folder::new();
    folder.text("hill.json", HILL);
    folder.text("ring.obj", &ring(true));
    let rest = "[shoreline]\nsea_reach = 3.0\nland_reach = 1.0\n[contact]\nopacity = 0.0\n";
    let view = "--eye 0,14,4 --target 0,0,0 --fov 50 --supersample 1 --layers shore.amount";
    let draw = |name: &str, shore: &str| {
        folder.text("s.toml", &format!("[shore]\n{shore}\n{rest}"));
        folder.run(&format!("render --shore hill.json {view} {SIZE} --settings s.toml -o {name}"))
    };
    draw("strip.exr", "strip = \"ring.obj\"").ok();
    draw("map.exr", "map = 256").ok();
    let [strip, map] = ["strip.exr", "map.exr"].map(|name| folder.picture(name));
    let [strip, map] = [&strip, &map].map(|picture| picture.channel("shore.amount").unwrap());
    // Both have the same v, one from the ring's vertices, the other from the hill.
    let off = strip.iter().zip(map).map(|(a, b)| (a - b).abs()).sum::<f32>();
    let all = map.iter().sum::<f32>();
    assert!(all > 100.0 && off < 0.25 * all, "{off} of {all}");
    folder.text("ring.obj", &ring(false));
    draw("n.exr", "strip = \"ring.obj\"")
        .fails(3, &["ring.obj", "v of 0 everywhere", "second", "vt of OBJ"]);
    folder.text("s.toml", "[shore]\nstrip = \"hill.json\"\n");
    let json = format!("render --shore hill.json {view} {SIZE} --settings s.toml -o n.exr");
    folder.run(&json).fails(3, &["hill.json", "'hill'", "TEXCOORD_0"]);
}

/// A user's web is used.
#[test]
fn a_web_of_ones_own() {
    let folder = Folder::new();
    folder.text("hill.json", HILL);
    folder.run("pattern web:3 -o web.png --size 64").ok();
    let view = "--eye 0,14,4 --target 0,0,0 --fov 50 --supersample 1 --layers shore.amount";
    let draw = |name: &str, web: &str| {
        folder.text("s.toml", &format!("[shore]\nmap = 64\nby = \"screen\"\n{web}"));
        folder
            .run(&format!("render --shore hill.json {view} {SIZE} --settings s.toml -o {name}"))
            .ok();
    };
    draw("own.exr", "web = \"web.png\"\n");
    draw("built.exr", "");
    folder.run("compare own.exr built.exr").fails(1, &[]);
    let amount =
        |name: &str| folder.picture(name).channel("shore.amount").unwrap().iter().sum::<f32>();
    let [own, built] = ["own.exr", "built.exr"].map(amount);
    assert!((own / built - 1.0).abs() < 0.3, "as much foam: {own} {built}");
    // The built-in web as a picture gives the same foam.
    folder.run("pattern web:1 -o web.png --size 512").ok();
    draw("same.exr", "web = \"web.png\"\n");
    folder.run("compare same.exr built.exr --tolerance 1e-3").ok();
    folder.text("s.toml", "[shore]\nweb = \"gone.png\"\n");
    let gone = format!("render --shore hill.json {view} {SIZE} --settings s.toml -o n.png");
    folder.run(&gone).fails(3, &["gone.png"]);
}

/// A user's mask lies over the view: there is no contact foam where it is black.
#[test]
fn a_mask_of_ones_own() {
    let folder = Folder::new();
    let mut half = Layers::new(8, 6);
    let values: Vec<f32> = (0..48).map(|i| f32::from(i % 8 >= 4)).collect();
    half.push("Y", 8, 6, values).unwrap();
    let file = std::fs::File::create(folder.path("half.png")).unwrap();
    write_png_values(&half, file).unwrap();
    folder.text("s.toml", "[contact]\nmask = 1.0\nmask_picture = \"half.png\"\n");
    let pool = format!("render --shore pool {SIZE} --supersample 1 --settings s.toml");
    folder.run(&format!("{pool} --layers contact.amount -o half.exr --validate")).ok();
    let picture = folder.picture("half.exr");
    let foam = picture.channel("contact.amount").unwrap();
    let part = |right: bool| {
        let own = foam.iter().enumerate().filter(|(i, _)| (i % 96 >= 48) == right);
        own.map(|(_, v)| v).sum::<f32>()
    };
    assert!(part(false) == 0.0 && part(true) > 5.0, "{} and {}", part(false), part(true));
    folder.text("s.toml", "[contact]\nmask_picture = \"gone.png\"\n");
    folder.run(&format!("{pool} -o n.png")).fails(3, &["gone.png"]);
}

/// Foam where particle water meets objects.
#[test]
fn contact_foam_on_particles() {
    let folder = Folder::new();
    folder.particles("a.ply", block(8));
    folder.text(
        "s.json",
        r#"{"spheres":[{"name":"ball","material":"timber","centre":[0,0.7,0],"radius":0.25}],
            "ground":{"y":-0.05,"material":"sand"}}"#,
    );
    folder.text("on.toml", "[contact]\nparticle_opacity = 1.0\nmask = 0.0\n");
    let view = "--eye 0,2.2,1.2 --target 0,0.7,0 --fov 40 --radius 0.05 --supersample 1 --validate";
    let common = format!("render a.ply --scene s.json {view} {SIZE} --layers all");
    folder.run(&format!("{common} --settings on.toml -o on.exr")).ok();
    folder.run(&format!("{common} -o off.exr")).ok();
    let (on, off) = (folder.picture("on.exr"), folder.picture("off.exr"));
    assert!(off.channel("contact.amount").is_none());
    let foam = on.channel("contact.amount").unwrap();
    let [a, b] = [&on, &off].map(|picture| picture.channel("G").unwrap());
    assert!(foam.iter().any(|v| *v > 0.5), "no foam");
    let bad = foam.iter().zip(a.iter().zip(b)).filter(|(f, (a, b))| **f == 0.0 && a != b).count();
    // Refracted rays do not see it, because it lies on the water.
    assert_eq!(bad, 0, "pixels without foam are as they were");
    // The ball's rim lies in the middle of the water.
    let water = on.channel("water.depth.Z").unwrap();
    let wet: Vec<usize> = (0..foam.len()).filter(|i| water[*i] < EMPTY).collect();
    let bare = wet.iter().filter(|i| foam[**i] == 0.0).count();
    assert!(2 * bare > wet.len(), "{bare} of {} without foam", wet.len());
    let both = folder.run(&format!("render a.ply --shore pool {FRONT} -o n.png"));
    assert_eq!(both.0.status.code(), Some(2), "either particles or a scene with a sea");
}

#[test]
fn built_in_scenes_are_drawn() {
    let folder = Folder::new();
    folder.text("s.toml", "[shore]\nmap = 128\n");
    let common =
        |scene: &str| format!("render --shore {scene} {SIZE} --supersample 1 --settings s.toml");
    // `a_mask_of_ones_own` tests the pool.
    folder.run(&format!("{} -o lava.exr", common("lava"))).ok();
    let picture = folder.picture("lava.exr");
    assert!(picture.channel("contact.amount").unwrap().iter().any(|v| *v > 0.3));
    // One island drifts, and its map moves with it, so part of a sequence shows the same.
    let islands = common("archipelago");
    folder.run(&format!("{islands} --frames 1-81 --every 80 -o a_%d.exr")).ok();
    folder.run(&format!("{islands} --frames 81 -o b.exr")).ok();
    folder.run("compare a_81.exr b.exr").ok();
    let [before, after] = ["a_1.exr", "a_81.exr"].map(|name| folder.picture(name));
    for name in ["scene.Z", "shore.amount"] {
        let [a, b] = [&before, &after].map(|picture| picture.channel(name).unwrap());
        let changed = a.iter().zip(b).filter(|(a, b)| (*a - *b).abs() > 0.1).count();
        assert!(changed > 20, "{name}: {changed} pixels");
    }
    // The scene repeats after 240 frames.
    folder.run(&format!("{islands} --frames 321 -o c.exr")).ok();
    folder.run("compare b.exr c.exr --tolerance 1e-3").ok();
    let picture = folder.picture("b.exr");
    assert!(picture.channel("shore.amount").unwrap().iter().any(|v| *v > 0.9));
}
