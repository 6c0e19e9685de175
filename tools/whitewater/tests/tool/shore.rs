//! Shoreline and contact foam.

use super::support::{FRONT, Folder, SMALL, block};

/// A hill that stands in the sea.
const HILL: &str =
    r#"{"spheres":[{"name":"hill","material":"sand","centre":[0,-3,0],"radius":5}]}"#;

#[test]
fn foam_goes_round_a_hill_of_ones_own() {
    let folder = Folder::new();
    folder.text("hill.json", HILL);
    folder.text(
        "map.toml",
        "[shore]\nmap = 128\n[shoreline]\nreach = [3.0, 1.0]\n[contact]\nopacity = 0.0\n",
    );
    let view = "--eye 0,14,4 --target 0,0,0 --fov 50 --supersample 1 --validate";
    let common = format!("render --shore hill.json {view} {SMALL} --settings map.toml");
    folder.run(&format!("{common} -o map.exr")).ok();
    let picture = folder.picture("map.exr");
    let foam = picture.channel("shore.amount").unwrap();
    // The shore is a circle of radius 4 about the middle of the picture: on it, off it, inside.
    let amount = |rows: std::ops::Range<usize>| {
        let all = rows.clone().map(|y| foam[96 * y + 48]).sum::<f32>();
        all / rows.len() as f32
    };
    assert!(foam.iter().any(|v| *v > 0.9), "no foam");
    assert_eq!(amount(30..34), 0.0, "on the land");
    assert!(picture.channel("contact.amount").unwrap().iter().all(|v| *v == 0.0));
    // Half a second later it has moved; the colour shows it.
    folder.run(&format!("{common} --frames 13 -o later.exr")).ok();
    folder.run("compare map.exr later.exr").fails(1, &[]);
    folder.run(&format!("{common} --level 9 -o none.png")).fails(3, &["no shore at 9", "--level"]);
    folder.text("bad.toml", "[shore]\nby = \"strip\"\n");
    let bad = common.replace("map.toml", "bad.toml");
    folder.run(&format!("{bad} -o none.png")).fails(3, &["strip", "map"]);
    folder.text("bad.toml", "[shoreline]\nfade = 0.0\n");
    folder.run(&format!("{bad} -o none.png")).fails(3, &["ShorelineLook.fade"]);
    assert!(!folder.exists("none.png"));
}

/// A web of the user's is what is seen.
#[test]
fn a_web_of_ones_own() {
    let folder = Folder::new();
    folder.text("hill.json", HILL);
    folder.run("pattern web:3 -o web.png --size 64").ok();
    let view = "--eye 0,14,4 --target 0,0,0 --fov 50 --supersample 1 --layers shore.amount";
    let draw = |name: &str, web: &str| {
        folder.text("s.toml", &format!("[shore]\nmap = 64\nby = \"screen\"\n{web}"));
        folder
            .run(&format!("render --shore hill.json {view} {SMALL} --settings s.toml -o {name}"))
            .ok();
    };
    draw("own.exr", "web = \"web.png\"\n");
    draw("built.exr", "");
    folder.run("compare own.exr built.exr").fails(1, &[]);
    folder.text("s.toml", "[shore]\nweb = \"gone.png\"\n");
    let gone = format!("render --shore hill.json {view} {SMALL} --settings s.toml -o n.png");
    folder.run(&gone).fails(3, &["gone.png"]);
}

/// Foam where particles' water meets what stands in it.
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
    let common = format!("render a.ply --scene s.json {view} {SMALL} --layers all");
    folder.run(&format!("{common} --settings on.toml -o on.exr")).ok();
    folder.run(&format!("{common} -o off.exr")).ok();
    let (on, off) = (folder.picture("on.exr"), folder.picture("off.exr"));
    assert!(off.channel("contact.amount").is_none());
    let foam = on.channel("contact.amount").unwrap();
    let [a, b] = [&on, &off].map(|picture| picture.channel("G").unwrap());
    assert!(foam.iter().any(|v| *v > 0.5), "no foam");
    let bad = foam.iter().zip(a.iter().zip(b)).filter(|(f, (a, b))| **f == 0.0 && a != b).count();
    // Refraction sees none of it: it lies on the water.
    assert_eq!(bad, 0, "pixels without foam are as they were");
    let both = folder.run(&format!("render a.ply --shore pool {FRONT} -o n.png"));
    assert_eq!(both.0.status.code(), Some(2), "either particles or a scene with a sea");
}

#[test]
fn built_in_scenes_are_drawn() {
    let folder = Folder::new();
    folder.text("s.toml", "[shore]\nmap = 128\n");
    let common =
        |scene: &str| format!("render --shore {scene} {SMALL} --supersample 1 --settings s.toml");
    for scene in ["pool", "lava"] {
        folder.run(&format!("{} -o {scene}.exr", common(scene))).ok();
        let picture = folder.picture(&format!("{scene}.exr"));
        let foam = picture.channel("contact.amount").unwrap();
        assert!(foam.iter().any(|v| *v > 0.3), "{scene}");
    }
    // One island drifts, and its map goes with it: a cut sequence shows the same.
    let islands = common("archipelago");
    folder.run(&format!("{islands} --frames 1-81 --every 80 -o a_%d.exr")).ok();
    folder.run(&format!("{islands} --frames 81 -o b.exr")).ok();
    folder.run("compare a_81.exr b.exr").ok();
    let picture = folder.picture("b.exr");
    assert!(picture.channel("shore.amount").unwrap().iter().any(|v| *v > 0.9));
}
