//! Whitewater particles together with the fluid's.

use whitewater::io::particles::{Particles, read};

use super::support::{FRONT, Folder, GROUND, SMALL, block};

/// Foam in front of the block's middle, a bubble in it, and one particle whose life has ended.
const FOAM: &str =
    "x,y,z,type,lifetime,id\n0,0.35,0.5,0,2,10\n0.2,0.35,0.2,2,1,11\n-0.2,0.35,0.5,1,-1,9\n";
/// Particles a few pixels wide.
const LOOK: &str = "[whitewater]\nradius = 0.1\nhalf_intensity_thickness = 0.3\n";

/// Foam near the eye becomes blobs; bubbles in the water do not change.
#[test]
fn near_foam_becomes_blobs() {
    let folder = Folder::new();
    folder.particles("a.ply", block(8));
    folder.text("foam.csv", FOAM);
    let bubbles = "[bubbles]\ncrossfade = [8.0, 9.0]\ncrossfade_blobs = 16\ncrossfade_size = 2.0\nmap_size = 16\n";
    folder.text("near.toml", &format!("{LOOK}{bubbles}"));
    let common = format!("render a.ply {SMALL} {FRONT} --settings near.toml --validate");
    folder.run(&format!("{common} -o near.exr --layers all --whitewater foam.csv")).ok();
    let near = folder.picture("near.exr");
    let at = |name: &str, x: usize| near.channel(name).unwrap()[32 * 96 + x];
    assert!((1.7..1.82).contains(&at("bubbles.Z", 48)), "{}", at("bubbles.Z", 48));
    assert!(at("whitewater.thickness", 48) == 0.0, "no sprite where a blob is");
    let bubble = near.channel("whitewater.submerged").unwrap().iter().any(|v| *v > 0.0);
    assert!(bubble, "the bubble is one still");
    let text =
        folder.run(&format!("{common} -o none.png")).fails(2, &["crossfade", "--whitewater"]);
    assert!(!text.stderr().is_empty() && !folder.exists("none.png"));
}

#[test]
fn whitewater_particles_are_drawn_before_and_in_the_water() {
    let folder = Folder::new();
    folder.particles("a.ply", block(8));
    folder.text("foam.csv", FOAM);
    folder.text("look.toml", LOOK);
    let common = format!("render a.ply {SMALL} {FRONT} --settings look.toml --validate");
    folder.run(&format!("{common} -o without.exr")).ok();
    folder.run(&format!("{common} -o with.exr --whitewater foam.csv")).ok();
    let (without, with) = (folder.picture("without.exr"), folder.picture("with.exr"));
    assert!(without.channel("whitewater.Z").is_none());
    for name in [
        "whitewater.Z",
        "whitewater.normal.Y",
        "whitewater.irradiance.B",
        "whitewater.radius",
        "whitewater.shadow",
    ] {
        assert!(with.channel(name).is_some(), "{name}");
    }
    // The water's own spray is drawn beside them.
    assert!(without.channel("water.spray").is_some() && with.channel("water.spray").is_some());
    let at = |name: &str, x: usize| with.channel(name).unwrap()[32 * 96 + x];
    // An id of 10 divides the radius by three: 10 mod 8 is 2.
    assert!((1.81..1.82).contains(&at("whitewater.Z", 48)), "{}", at("whitewater.Z", 48));
    assert!(at("whitewater.thickness", 48) > 0.5 && at("whitewater.submerged", 48) == 0.0);
    let row = |name: &str| -> Vec<f32> { (0..96).map(|x| at(name, x)).collect() };
    let submerged = row("whitewater.submerged").iter().rposition(|v| *v > 0.0).unwrap();
    assert!(submerged > 52, "the bubble is right of the middle: {submerged}");
    assert!(row("whitewater.thickness")[..40].iter().all(|v| *v == 0.0), "one is gone");
    let light = |layers: &whitewater::io::picture::Layers, x: usize| {
        ["R", "G", "B"].map(|c| layers.channel(c).unwrap()[32 * 96 + x])
    };
    assert!(light(&with, 48)[0] > 1.3 * light(&without, 48)[0], "foam is white before blue water");
}

#[test]
fn files_of_one_kind_are_that_kind() {
    let folder = Folder::new();
    folder.particles("water_1.ply", block(4));
    folder.particles("water_2.ply", block(4));
    folder.particles("bubbles_1.ply", vec![[0.0, 0.0, 0.4]]);
    folder.particles("bubbles_2.ply", vec![[0.0, 0.0, 0.4], [0.1, 0.1, 0.4]]);
    folder.particles("drops_2.ply", vec![[0.0, 0.3, 0.4]]);
    folder.text("look.toml", LOOK);
    let common = format!("render water_%d.ply {SMALL} {FRONT} --settings look.toml --spray auto");
    let kinds = "--whitewater bubble=bubbles_%d.ply --whitewater spray=drops_%d.ply";
    folder
        .run(&format!("{common} {kinds} -o a_%d.exr --layers whitewater.thickness,water.spray"))
        .ok();
    let sum = |name: &str| {
        folder.picture(name).channel("whitewater.thickness").unwrap().iter().sum::<f32>()
    };
    assert!(sum("a_2.exr") > 1.5 * sum("a_1.exr") && sum("a_1.exr") > 0.0);
    assert!(folder.picture("a_1.exr").channel("water.spray").is_some(), "as it was asked for");
    // The same as a column of the file says, and no kind looks like another.
    folder.particles("plain.ply", vec![[0.0, 0.0, 0.4]]);
    let layers = "--layers whitewater.thickness,whitewater.submerged";
    let common = format!("render water_1.ply {SMALL} {FRONT} --settings look.toml {layers}");
    let drawn = [("foam", 0), ("spray", 1), ("bubble", 2)].map(|(name, kind)| {
        folder.text("typed.csv", &format!("x,y,z,type\n0,0,0.4,{kind}\n"));
        folder.run(&format!("{common} --whitewater {name}=plain.ply -o {name}.exr")).ok();
        folder.run(&format!("{common} --whitewater typed.csv -o typed.exr")).ok();
        folder.run(&format!("compare {name}.exr typed.exr --tolerance 0")).ok();
        folder.picture(&format!("{name}.exr")).rgb().unwrap()
    });
    assert!(drawn[0] != drawn[1] && drawn[1] != drawn[2] && drawn[2] != drawn[0]);
}

/// Foam that fills a box, as few particles and as many. Their radii, derived from the count, make it opaque enough to
/// hide what is behind it. The settings that a picture stores draw it again, and a settings file overrides the derived
/// ones.
#[test]
fn few_particles_and_many_read_as_foam() {
    let folder = Folder::new();
    folder.particles("a.ply", block(2));
    let unit = |i: u32, salt: u32| {
        (i.wrapping_mul(2_654_435_761).rotate_left(salt) >> 8) as f32 / 16_777_216.0
    };
    // 20 by 10 columns.
    for (name, count) in [("few", 2_000), ("many", 200_000)] {
        let at = |i: u32| [2.0 * unit(i, 0) - 1.0, unit(i, 11) - 0.15, unit(i, 22) - 0.5];
        let mut foam = Particles::from_positions((0..count).map(at).collect());
        foam.ids = Some((0..count).collect());
        folder.write(&format!("{name}.ply"), &foam);
    }
    let common = format!("render a.ply {GROUND} {FRONT} --supersample 1");
    let middle = |name: &str, channel: &str| {
        let picture = folder.picture(name);
        let data = picture.channel(channel).unwrap();
        let inside = (24..40).flat_map(|y| (30..66).map(move |x| y * 96 + x));
        inside.map(|i| data[i]).sum::<f32>() / (16.0 * 36.0)
    };
    let setting = |name: &str, key: &str| {
        let attributes = folder.picture(name).attributes;
        let text = attributes.into_iter().find(|(name, _)| name == "settings").unwrap().1;
        let table = text.parse::<toml::Table>().unwrap();
        table["whitewater"].as_table().unwrap().get(key).cloned()
    };
    // `Sizes` gives both an opacity of 0.8 where discs are spread evenly. At random places they hide less, few of them
    // less than many.
    for name in ["few", "many"] {
        let run =
            folder.run(&format!("{common} -o {name}.exr --whitewater {name}.ply --validate")).ok();
        assert!(run.stderr().contains("whitewater particles with radii of"), "{}", run.stderr());
        let exr = format!("{name}.exr");
        let intensity = middle(&exr, "whitewater.intensity");
        assert!(intensity > 0.7, "{name}: {intensity}");
        // The mean over the drawn discs, seen from 1.85 to 2.85 away; a few lie at the borders.
        let radius = setting(&exr, "radii").unwrap()[0].as_float().unwrap() as f32;
        // With few particles each is drawn as 27, which makes 270 per column.
        let n = if name == "few" { 270.0 } else { 1000.0 };
        let expected = 0.317_6 * n * (radius / 0.1).powi(2);
        let thickness = middle(&exr, "whitewater.thickness") + middle(&exr, "whitewater.submerged");
        assert!((thickness / expected - 1.0).abs() < 0.1, "{name}: {thickness} {expected}");
        let attributes = folder.picture(&exr).attributes;
        let settings = attributes.into_iter().find(|(name, _)| name == "settings").unwrap().1;
        folder.text("again.toml", &settings);
        let again = "--settings again.toml -o again.exr";
        folder.run(&format!("{common} {again} --whitewater {name}.ply")).ok();
        folder.run(&format!("compare {exr} again.exr --tolerance 0")).ok();
    }
    folder.text("own.toml", "[whitewater]\nradius = 0.02\nhalf_intensity_thickness = 2.0\n");
    folder.run(&format!("{common} --settings own.toml -o own.exr --whitewater few.ply")).ok();
    assert_eq!(setting("own.exr", "radii"), None);
    for (key, value) in [("radius", 0.02), ("half_intensity_thickness", 2.0)] {
        let found = setting("own.exr", key).unwrap().as_float().unwrap();
        assert!((found - value).abs() < 1.0e-6, "{key} {found}");
    }
}

/// More particles than fit in one part, in formats that are read in parts and in one that is not: the pictures are the
/// same. One file or all have no ids, and kinds come from the files or from their names.
#[test]
fn what_is_read_in_parts_is_what_is_read_at_once() {
    let folder = Folder::new();
    folder.particles("a.ply", block(4));
    folder.text("look.toml", "[whitewater]\nradius = 0.01\n");
    let count: u32 = 140_000;
    let unit =
        |i: u32, salt: u32| (i.wrapping_mul(2_654_435_761).rotate_left(salt) >> 22) as f32 / 1024.0;
    let mut particles = Particles::from_positions(
        (0..count).map(|i| [0, 9, 21].map(|salt| unit(i, salt) - 0.5)).collect(),
    );
    particles.kinds = Some((0..count).map(|i| i / 7 % 3).collect());
    particles.lifetimes = Some((0..count).map(|i| (i % 64) as f32 / 16.0 - 0.25).collect());
    let lifetimes = particles.lifetimes.clone().unwrap();
    let rows = |ids: bool, range: std::ops::Range<usize>| {
        let of = |i: usize| {
            let ([x, y, z], life) = (particles.positions[i], lifetimes[i]);
            let id = if ids { format!(",{}", 3 * i) } else { String::new() };
            format!("{x},{y},{z},{},{life}{id}\n", i / 7 % 3)
        };
        let head = if ids { "x,y,z,type,lifetime,id\n" } else { "x,y,z,type,lifetime\n" };
        head.to_string() + &range.map(of).collect::<String>()
    };
    let whole = |ids: bool, range: std::ops::Range<usize>| {
        let list = |of: &dyn Fn(usize) -> String| {
            format!("[{}]", range.clone().map(of).collect::<Vec<_>>().join(","))
        };
        let positions = list(&|i| format!("{:?}", particles.positions[i]));
        let (kinds, life) =
            (list(&|i| (i / 7 % 3).to_string()), list(&|i| lifetimes[i].to_string()));
        let ids = if ids { list(&|i| (3 * i).to_string()) } else { "0".into() };
        format!("{{\"position\":{positions},\"type\":{kinds},\"lifetime\":{life},\"id\":{ids}}}")
    };
    for (name, ids) in [("plain", false), ("named", true)] {
        for (part, range) in [(1, 0..70_000), (2, 70_000..count as usize)] {
            folder.text(&format!("{name}_{part}.csv"), &rows(ids, range.clone()));
            folder.text(&format!("{name}_{part}.json"), &whole(ids, range));
        }
    }
    for name in ["plain.bgeo.gz", "plain.npz"] {
        folder.write(name, &particles);
    }
    particles.ids = Some((0..count).map(|i| 3 * i).collect());
    for name in ["named.bgeo.gz", "named.ply", "named.vtu"] {
        folder.write(name, &particles);
    }
    let draw = |files: &str, out: &str| {
        let files = files.replace('+', "--whitewater ");
        let look = format!("{SMALL} {FRONT} --settings look.toml");
        folder.run(&format!("render a.ply {look} -o {out} {files}")).ok();
        folder.picture(out).channels
    };
    for (what, whole, parts) in [
        (
            "one",
            "+named_1.json +named_2.json",
            &["+named.bgeo.gz", "+named_1.csv +named_2.csv"][..],
        ),
        (
            "all",
            "+named_1.json +named_2.json +bubble=named_1.json +bubble=named_2.json",
            &["+named.ply +bubble=named.vtu"],
        ),
        (
            "some",
            "+plain_1.json +plain_2.json +spray=named_1.json +spray=named_2.json",
            &["+plain.npz +spray=named.vtu"],
        ),
    ] {
        let whole = draw(whole, &format!("{what}_whole.exr"));
        assert!(whole.iter().any(|c| c.name == "whitewater.thickness"));
        for parts in parts {
            let read = draw(parts, &format!("{what}_parts.exr"));
            assert_eq!(whole.len(), read.len());
            let bits = |values: &[f32]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
            for (a, b) in whole.iter().zip(&read) {
                assert!(a.name == b.name && bits(&a.data) == bits(&b.data), "{parts}: {}", a.name);
            }
        }
    }
}

#[test]
fn mistakes_in_whitewater_files_are_named() {
    let folder = Folder::new();
    folder.particles("a.ply", block(4));
    folder.text("cut.csv", "x,y,z,type\n0,0,0,0\n1,1\n");
    let run = |more: &str| folder.run(&format!("render a.ply -o a.png {SMALL} {more}"));
    run("--whitewater none_%d.bgeo").fails(3, &["none_%d.bgeo"]);
    run("--whitewater cut.csv").fails(3, &["cut.csv", "line 3"]);
    assert!(!folder.exists("a.png"));
}

#[test]
fn a_bad_whitewater_file_loses_its_frame_alone() {
    let folder = Folder::new();
    for frame in 1..=2 {
        folder.particles(&format!("water_{frame}.ply"), block(4));
    }
    folder.text("foam_1.csv", FOAM);
    folder.text("foam_2.csv", "x,y,z,type\n0,0,0,0\n1,1\n");
    let files = "water_%d.ply --whitewater foam_%d.csv -o a_%d.png";
    folder.run(&format!("render {files} {SMALL}")).fails(1, &["1 of 2 frames", "foam_2.csv"]);
    assert!(folder.exists("a_1.png") && !folder.exists("a_2.png"));
}

/// A block of water whose upper half slides over the lower one, in frames of a thirtieth of a second.
fn torn(folder: &Folder, frames: u32) {
    torn_at(folder, frames, 4.0);
}

fn torn_at(folder: &Folder, frames: u32, speed: f32) {
    for frame in 1..=frames {
        let rows = block(8).into_iter().enumerate().map(|(id, [x, y, z])| {
            let sign = if y > 0.0 { 1.0 } else { -1.0 };
            let way = speed * sign * (frame - 1) as f32 / 30.0;
            let up = 0.5 * speed * f32::from(y > 0.2);
            format!("{},{y},{z},{},{up},0,{id}\n", x + way, speed * sign)
        });
        let text = format!("x,y,z,vx,vy,vz,id\n{}", rows.collect::<String>());
        folder.text(&format!("torn_{frame}.csv"), &text);
    }
}

#[test]
fn whitewater_particles_are_made_of_the_water() {
    let folder = Folder::new();
    torn(&folder, 4);
    folder.text(
        "look.toml",
        "[whitewater]\nradius = 0.1\nhalf_intensity_thickness = 0.3\n[generate]\nmax_particles = 3000\n",
    );
    let common =
        format!("render torn_%d.csv {SMALL} {FRONT} --settings look.toml --fps 30 --overwrite");
    let made = "--whitewater generate --write-whitewater made_%d.bgeo.gz";
    let run = folder.run(&format!("{common} {made} -o a_%d.exr -o a_%d.png --validate")).ok();
    assert!(run.stderr().contains("trapped air") && run.stderr().contains("whitewater particles"));
    assert!(!run.stderr().contains("there is room for"), "{}", run.stderr());
    let amount = |name: &str| {
        folder.picture(name).channel("whitewater.thickness").unwrap().iter().sum::<f32>()
    };
    let amounts = [1, 2, 3, 4].map(|frame| amount(&format!("a_{frame}.exr")));
    assert!(amounts.iter().all(|amount| *amount > 0.0), "{amounts:?} {}", run.stderr());
    // Cutting the sequence makes no difference, and the written files give the same result.
    folder.run(&format!("{common} {made} --frames 4 -o b_%d.png")).ok();
    let file = |name: &str| std::fs::read(folder.path(name)).unwrap();
    assert_eq!(file("a_4.png"), file("b_4.png"));
    folder.run(&format!("{common} --whitewater made_%d.bgeo.gz --frames 4 -o c_%d.exr")).ok();
    let (made, read) = (amount("a_4.exr"), amount("c_4.exr"));
    assert!((made / read - 1.0).abs() < 1.0e-3, "{made} {read}");
    // Motion blur moves emitted whitewater as it moves that of files.
    let blurred = common.replace("--samples 1", "--samples 4 --shutter 0.05");
    folder.run(&format!("{blurred} --whitewater generate -o moved_%d.exr --frames 4")).ok();
    folder.run(&format!("{blurred} --whitewater made_%d.bgeo.gz -o file_%d.exr --frames 4")).ok();
    let light = |name: &str| folder.picture(name).rgb().unwrap();
    let off = apart(&light("moved_4.exr"), &light("file_4.exr"));
    assert!(off < 1.0e-3, "{off}");
    // Existing pictures do not suffice if whitewater files are requested too.
    let keep = "--whitewater generate --write-whitewater kept_%d.ply -o b_%d.png --frames 4";
    let again = common.replace("--overwrite", "");
    folder.run(&format!("{again} {keep}")).ok();
    assert!(folder.exists("kept_4.ply"));
    // A message says once how many particles did not fit.
    let rates = "[generate]\nmax_particles = 50\nrates = [4000.0, 4000.0]\n";
    folder.text("full.toml", rates);
    let full = common.replace("look.toml", "full.toml");
    let run = folder.run(&format!("{full} --whitewater generate -o f_%d.png")).ok();
    assert_eq!(run.stderr().matches("there is room for 50 whitewater particles").count(), 1);
    // A single frame.
    let alone = format!("render torn_1.csv {SMALL} {FRONT} --whitewater generate");
    let run = folder.run(&format!("{alone} -o d.exr")).ok();
    // Without a setting, size and opacity follow the number of particles.
    assert!(
        run.stderr().contains(" of whitewater particles (found; table [whitewater]"),
        "{}",
        run.stderr()
    );
    folder.text("half.toml", "[whitewater]\nhalf_intensity_thickness = 3.0\nradius = 0.002\n");
    folder.run(&format!("{alone} --settings half.toml -o e.exr")).ok();
    assert!(amount("d.exr") > 2.0 * amount("e.exr") && amount("e.exr") > 0.0);
}

/// Sum of the absolute differences of two pictures, relative to the sum of the second.
fn apart(a: &[[f32; 3]], b: &[[f32; 3]]) -> f32 {
    let off: f32 = a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| (a - b).abs()).sum();
    off / b.as_flattened().iter().sum::<f32>()
}

/// A particle before still water is as much wider as it moves during the exposure.
#[test]
fn whitewater_is_blurred_along_its_velocity() {
    let folder = Folder::new();
    folder.particles("a.ply", block(8));
    folder.text("look.toml", LOOK);
    folder.text("still.csv", "x,y,z,type,id\n0,0.35,0.5,0,10\n");
    folder.text("fast.csv", "x,y,z,vx,vy,vz,type,id\n0,0.35,0.5,6,0,0,0,10\n");
    let small = SMALL.replace("--samples 1", "--samples 16 --shutter 0.05 --shadows none");
    let row = |name: &str, more: &str| -> (Vec<f32>, String) {
        let common = format!("render a.ply {small} {FRONT} --settings look.toml");
        let run = folder.run(&format!("{common} -o {name} {more}")).ok();
        let light = folder.picture(name).rgb().unwrap();
        (light[32 * 96..33 * 96].iter().map(|c| c[1]).collect(), run.stderr())
    };
    let (without, _) = row("none.exr", "");
    let wide = |foam: &str| {
        let (with, said) = row(&format!("{foam}.exr"), &format!("--whitewater {foam}.csv"));
        let off = with.iter().zip(&without).filter(|(a, b)| (*a - *b).abs() > 0.05);
        (off.count() as f32, said.contains("blurs nothing"))
    };
    let ((still, told), (fast, moved)) = (wide("still"), wide("fast"));
    assert!(told && !moved, "the message says whether anything moves");
    // From the first to the last of 16 moments in 0.05 s, at 6 m/s and 1.85 m from the eye, in pixels.
    let way = 0.3 * 15.0 / 16.0 * 32.0 / (20.0_f32.to_radians().tan() * 1.85);
    // Both ends are whole pixels.
    assert!((fast - still - way).abs() <= 2.0, "{fast} pixels, {still} at rest, {way} of motion");
}

/// At equal rates a single frame has the whitewater that its water brings, in addition to the emission of a first
/// frame.
#[test]
fn a_frame_by_itself_has_foam_of_before() {
    let folder = Folder::new();
    // The water is slow, but whitewater of a moment ago still exists.
    torn_at(&folder, 2, 0.5);
    let limits = "trapped_air = [0.1, 1.0]\nwave_crest = [1.0, 4.0]\nenergy = [0.01, 0.1]";
    folder.text("look.toml", &format!("[generate]\n{limits}\nrates = [200.0, 200.0]\n"));
    let made = |files: &str, name: &str| {
        let look = format!("{SMALL} {FRONT} --settings look.toml --whitewater generate");
        let keep = format!("--write-whitewater {name}_%d.ply -o {name}_%d.png");
        folder.run(&format!("render {files} {look} {keep}")).ok();
        read(&folder.path(&format!("{name}_1.ply"))).unwrap().positions.len()
    };
    let first = made("torn_%d.csv --fps 30 --frames 1", "first");
    let alone = made("torn_1.csv", "alone");
    assert!(first > 500 && 2 * alone > 3 * first, "{first} {alone}");
}

/// The same water without velocities, but with ids or in constant order: velocities are found, and give nearly the same
/// whitewater.
#[test]
fn velocities_are_found_from_frame_to_frame() {
    let folder = Folder::new();
    torn(&folder, 3);
    for frame in 1..=3 {
        let text = std::fs::read_to_string(folder.path(&format!("torn_{frame}.csv"))).unwrap();
        let columns = |which: &'static [usize]| {
            let row = move |line: &str| {
                let all: Vec<_> = line.split(',').collect();
                which.iter().map(|i| all[*i]).collect::<Vec<_>>().join(",") + "\n"
            };
            text.lines().map(row).collect::<String>()
        };
        folder.text(&format!("id_{frame}.csv"), &columns(&[0, 1, 2, 6]));
        folder.text(&format!("order_{frame}.csv"), &columns(&[0, 1, 2]));
    }
    // An upward speed that does not appear in the positions has little effect.
    let limits = "trapped_air = [1.0, 10.0]\nwave_crest = [1.0, 4.0]\nenergy = [1.0, 8.0]";
    folder.text(
        "look.toml",
        &format!("[whitewater]\nradius = 0.1\n[generate]\n{limits}\nrates = [500.0, 500.0]\n"),
    );
    let amount = |name: &str| {
        let look = format!("{SMALL} {FRONT} --settings look.toml --fps 30 --whitewater generate");
        let run =
            folder.run(&format!("render {name}_%d.csv {look} --frames 3 -o {name}_%d.exr")).ok();
        let told = run.stderr().contains("velocities are not in the files");
        assert_eq!(told, name != "torn", "{}", run.stderr());
        folder
            .picture(&format!("{name}_3.exr"))
            .channel("whitewater.thickness")
            .unwrap()
            .iter()
            .sum::<f32>()
    };
    let [own, by_id, by_order] = ["torn", "id", "order"].map(amount);
    assert!(own > 0.0 && (by_id / own - 1.0).abs() < 0.5, "{own} {by_id}");
    assert!((by_order / by_id - 1.0).abs() < 0.1, "{by_id} {by_order}");
    // A single frame has no velocities.
    folder
        .run(&format!("render id_1.csv {SMALL} --whitewater generate -o alone.png"))
        .fails(3, &["velocities", "ids"]);
}

/// Size and opacity that are found for emitted whitewater are those of all fluids: if a settings file says them, the
/// picture is the same.
#[test]
fn emitted_whitewater_looks_alike_with_fluids() {
    let folder = Folder::new();
    torn(&folder, 1);
    folder.text("oil_1.csv", "x,y,z,vx,vy,vz,id\n0.9,0,0,0,0,0,0\n0.9,0.1,0,0,0,0,1\n");
    let common = format!(
        "render torn_1.csv --fluid oil_1.csv:water {SMALL} {FRONT} --whitewater generate --surface-foam none"
    );
    folder.run(&format!("{common} -o found.exr")).ok();
    let found = folder.picture("found.exr");
    let text = &found.attributes.iter().find(|(name, _)| name == "settings").unwrap().1;
    let table = text.parse::<toml::Table>().unwrap();
    let of = |key: &str| table["whitewater"].as_table().unwrap()[key].as_float().unwrap();
    let [radius, half] = ["radius", "half_intensity_thickness"].map(of);
    folder.text(
        "said.toml",
        &format!("[whitewater]\nradius = {radius:?}\nhalf_intensity_thickness = {half:?}\n"),
    );
    folder.run(&format!("{common} --settings said.toml -o said.exr")).ok();
    let said = folder.picture("said.exr");
    for name in ["whitewater.thickness", "whitewater.intensity"] {
        let sum = |picture: &whitewater::io::picture::Layers| {
            picture.channel(name).unwrap().iter().sum::<f32>()
        };
        let (found, said) = (sum(&found), sum(&said));
        assert!(said > 0.0 && (found / said - 1.0).abs() < 1.0e-3, "{name}: {found} {said}");
    }
}

/// A frame has many more whitewater particles than those that are probed. Surface foam from before it is not lost.
#[test]
fn many_whitewater_particles_leave_surface_foam_as_it_is() {
    let folder = Folder::new();
    folder.water_that_is_fast_for_a_while();
    // Of 34 files every third is probed, beginning with the first; there is room for 1024 particles at least.
    for frame in 1..=34 {
        let count = if frame == 3 { 1500 } else { 1 };
        let rows = "0,0.35,0.5,0\n".repeat(count);
        folder.text(&format!("w_{frame}.csv"), &format!("x,y,z,type\n{rows}"));
    }
    folder.text("look.toml", LOOK);
    let common = format!(
        "render f_*.csv {SMALL} --settings look.toml --surface-foam 1 --fps 4 --layers surface_foam.thickness"
    );
    folder.run(&format!("{common} -o a_%d.exr")).ok();
    let run = folder.run(&format!("{common} --whitewater w_%d.csv -o b_%d.exr")).ok();
    let said = run.stderr();
    assert_eq!(said.matches("frame 3: the earlier frames are stepped through again").count(), 1);
    assert!(said.contains("1500 whitewater particles"), "{said}");
    for frame in 1..=4 {
        let [a, b] = ["a", "b"].map(|name| {
            let picture = folder.picture(&format!("{name}_{frame}.exr"));
            picture.channel("surface_foam.thickness").unwrap().to_vec()
        });
        assert!(a == b, "frame {frame}");
        assert_eq!(a.iter().sum::<f32>() > 0.0, frame > 2, "frame {frame}");
    }
}

#[test]
fn mistakes_in_making_whitewater_particles_are_named() {
    let folder = Folder::new();
    torn(&folder, 1);
    folder.particles("still.ply", block(4));
    folder.text("foam.csv", FOAM);
    folder.text("bad.toml", "[generate]\nrate = 3\n");
    folder.text("limits.toml", "[generate]\nenergy = [3.0, 1.0]\n");
    let run = |more: &str| folder.run(&format!("render {more} {SMALL} -o a.png"));
    run("still.ply --whitewater generate").fails(3, &["velocities"]);
    run("torn_1.csv --whitewater generate --whitewater foam.csv").fails(2, &["generate", "both"]);
    run("torn_1.csv --write-whitewater a.ply").fails(2, &["--whitewater generate"]);
    run("torn_1.csv --whitewater generate --write-whitewater a.obj").fails(2, &[".bgeo", "a.obj"]);
    run("torn_1.csv --whitewater generate --write-whitewater no/a.ply").fails(5, &["no/a.ply"]);
    run("torn_1.csv --whitewater generate --settings bad.toml").fails(3, &["rate"]);
    folder.text("none.toml", "[generate]\nmax_particles = 0\n");
    run("torn_1.csv --whitewater generate --settings none.toml").fails(3, &["max_particles"]);
    let over = "still.ply --whitewater generate --write-whitewater still.ply";
    run(over).fails(2, &["still.ply is an input"]);
    run("torn_1.csv --whitewater generate --settings limits.toml").fails(3, &["energy"]);
    assert!(!folder.exists("a.png"));
}
