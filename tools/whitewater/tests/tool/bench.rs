//! `bench`: its output, and that an interruption loses no measurement.

use std::collections::HashMap;
use std::io::{BufRead, BufReader, Read};
use std::process::Stdio;

use serde_json::Value;

use super::support::Folder;

const QUICK: &str = "bench --particles 64 --frames 2 --warmup 0";

/// Checks the rows of two paths: each has its passes and their sum.
fn check(format: &str, text: &str) {
    match format {
        "table" => {
            for part in [", default, at most", ", tiles, at most", "median ms", "composite"] {
                assert!(text.contains(part), "{part}: {text}");
            }
            assert_eq!(text.matches("calibration loops\n").count(), 2, "{text}");
        }
        "csv" => {
            let mut lines = text.lines();
            let head: Vec<_> = lines.next().unwrap().split(',').collect();
            assert_eq!(head[..3], ["adapter", "driver", "version"]);
            let rows: Vec<Vec<_>> = lines
                .map(|line| {
                    // The fields before it are quoted and may contain commas.
                    let (_, rest) = line.rsplit_once('"').unwrap();
                    rest.trim_start_matches(',').split(',').collect()
                })
                .collect();
            assert!(rows.iter().all(|row| row.len() == head.len() - 2), "{text}");
            for path in ["default", "tiles"] {
                let frame = rows.iter().find(|row| row[4..6] == [path, "frame"]).unwrap();
                assert!(frame[6].parse::<f64>().unwrap() > 0.0, "{text}");
            }
        }
        _ => {
            let all: Value = serde_json::from_str(text).unwrap();
            assert!(all["adapter"].as_str().is_some_and(|name| !name.is_empty()));
            let rows = all["rows"].as_array().unwrap();
            for path in ["default", "tiles"] {
                let frame = rows.iter().find(|r| r["path"] == path && r["pass"] == "frame");
                assert!(frame.unwrap()["median"].as_f64().unwrap() > 0.0, "{text}");
            }
        }
    }
}

/// The pool as `render` draws a file: each of its passes appears once, and they sum to the frame.
#[test]
fn what_render_draws_is_timed() {
    let folder = Folder::new();
    let command = "bench --particles 1k --frames 1 --warmup 0 --size 64x48 --path render";
    let all: Value =
        serde_json::from_str(&folder.run(&format!("{command} --format json")).ok().stdout())
            .unwrap();
    let rows = all["rows"].as_array().unwrap();
    let of = |pass: &str| -> Vec<f64> {
        let found = rows.iter().filter(|row| row["pass"] == pass);
        found.map(|row| row["median"].as_f64().unwrap()).collect()
    };
    for pass in ["shape", "light", "caustics", "lit", "surface_foam", "spray", "back", "frame"] {
        assert!(matches!(of(pass)[..], [ms] if ms > 0.0), "{pass}: {rows:?}");
    }
    let passes = rows.iter().filter(|row| row["pass"] != "frame");
    let sum: f64 = passes.map(|row| row["median"].as_f64().unwrap()).sum();
    assert!((sum - of("frame")[0]).abs() < 1.0e-6 * sum, "{rows:?}");
    assert!(rows.iter().all(|row| row["path"] == "render"), "{rows:?}");
}

/// Blobs are drawn, and simulated on the GPU and on the CPU.
#[test]
fn bubble_foam_is_timed() {
    let folder = Folder::new();
    folder.text("few.toml", "[bubbles]\nvariants = 1\nbubbles = 8\nlayers = 2\nsort = \"peel\"\n");
    let command =
        "bench --bubbles box:20,one --settings few.toml --frames 2 --warmup 0 --size 64x48";
    let json = folder.run(&format!("{command} --format json")).ok();
    let all: Value = serde_json::from_str(&json.stdout()).unwrap();
    for (scene, blobs) in [("box:20", 20), ("one", 1)] {
        let rows = || all["rows"].as_array().unwrap().iter().filter(|r| r["bubble_scene"] == scene);
        for pass in ["peel", "soap", "frame", "heap", "heap on CPU"] {
            let row = rows().find(|row| row["pass"] == pass).unwrap();
            assert!(row["median"].as_f64().unwrap() > 0.0, "{row}");
            assert!(row["blobs"] == blobs && row["bubbles"] == 8 * blobs, "{row}");
            assert!(row["layers"] == 2 && row["path"] == "peel", "{row}");
        }
    }
    let csv = folder.run(&format!("{command} --format csv")).ok().stdout();
    let columns = csv.lines().next().unwrap().split(',').count();
    let whole = csv
        .lines()
        .skip(1)
        .all(|line| line.rsplit_once('"').unwrap().1.split(',').count() == columns - 1);
    assert!(whole && csv.contains(",box:20,20,160,2,ids,128,10"), "{csv}");
    for (bad, part) in [
        (format!("{command} --sea wave"), "--sea"),
        ("bench --bubbles box:0".into(), "1 to 1000000"),
    ] {
        let run = folder.run(&bad);
        let text = run.stderr();
        assert!(text.contains("--bubbles") && text.contains(part), "{text}");
        run.fails_at_once();
    }
}

#[test]
fn each_format_has_all_rows_also_where_it_ends_early() {
    let folder = Folder::new();
    for format in ["table", "csv", "json"] {
        let command = format!("{QUICK} --path default,tiles --format {format} --size");
        let run = folder.run(&format!("{command} 64x48,300000x64"));
        check(format, &run.stdout());
        let text = run.fails(2, &["300000x64", "--size"]).stderr();
        assert!(text.contains("(1 of 4)") && !text.contains("--supersample"), "{text}");
    }
}

#[test]
fn an_interrupt_loses_nothing_measured() {
    let folder = Folder::new();
    // The second combination is slow.
    let command = "bench --particles 64 --size 16x16,1280x720 --frames 60 --format json";
    let mut command = folder.command(command);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let lines = BufReader::new(child.stderr.take().unwrap()).lines();
    let mut told = lines.map_while(Result::ok);
    assert!(told.any(|line| line.contains("(1 of 2)")));
    let id = child.id().to_string();
    assert!(std::process::Command::new("kill").args(["-INT", &id]).status().unwrap().success());
    let mut text = String::new();
    child.stdout.take().unwrap().read_to_string(&mut text).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let all: Value = serde_json::from_str(&text).unwrap();
    let rows = all["rows"].as_array().unwrap();
    assert!(!rows.is_empty() && rows.iter().all(|row| row["width"] == 16), "{text}");
}

/// A sea instead of water: time per particle, memory and picture are reported.
#[test]
fn a_sea_says_what_its_foam_costs() {
    let folder = Folder::new();
    let quick = "bench --sea wave --whitewater 20k --size 160x120 --frames 1 --warmup 0";
    let run = folder.run(&format!("{quick} --occlusion fast,reference --format json")).ok();
    let all: Value = serde_json::from_str(&run.stdout()).unwrap();
    let rows = all["rows"].as_array().unwrap();
    for occlusion in ["fast", "reference"] {
        let row = |pass: &str| {
            let row = rows.iter().find(|r| r["occlusion"] == occlusion && r["pass"] == pass);
            row.unwrap_or_else(|| panic!("{occlusion}, {pass}: {}", run.stdout()))
        };
        let frame = row("frame");
        assert_eq!((&frame["sea"], &frame["whitewater"]), (&"wave".into(), &20_000.into()));
        // Positions, kinds, ages and ids, and the device's rounding.
        let input = frame["inputs"].as_u64().unwrap();
        assert!((24 * 20_000..24 * 20_000 + 4096).contains(&input), "{input}");
        assert!(frame["memory"].as_u64().unwrap() > 28 * 160 * 120);
        // Words and images of a pixel, and the particle streams read twice, as in bytes.rs.
        let bytes = row("splat")["bytes"].as_u64().unwrap() - 112 * 160 * 120;
        assert!([24, 48].contains(&(bytes / 20_000)) && bytes % 20_000 == 0, "{bytes}");
        let each = row("splat")["ns_per_whitewater"].as_f64().unwrap();
        let median = row("splat")["median"].as_f64().unwrap();
        assert!(each > 0.0 && (each * 20_000.0 / (median * 1e6) - 1.0).abs() < 1e-6);
        assert!(row("radiance")["bytes"].as_u64() >= Some(24 * 160 * 120));
        assert!(row("blur")["median"].as_f64() > Some(0.0));
        assert!(row("radiance").get("ns_per_whitewater").is_none());
    }
    let text = folder.run(&format!("{quick} --format csv --picture wave.png")).ok().stdout();
    let mut lines = text.lines();
    let head: Vec<_> = lines.next().unwrap().split(',').collect();
    let splat = lines.find(|line| line.contains(",splat,")).unwrap();
    let (_, rest) = splat.rsplit_once('"').unwrap();
    let cells: Vec<_> = rest.trim_start_matches(',').split(',').collect();
    assert_eq!(cells.len(), head.len() - 2, "{text}");
    let cell = |name: &str| cells[head.iter().position(|h| *h == name).unwrap() - 2];
    assert_eq!([cell("sea"), cell("whitewater"), cell("occlusion")], ["wave", "20000", "fast"]);
    assert!(cell("ns_per_whitewater").parse::<f64>().unwrap() > 0.0);
    // A look a tenth as bright, and its layers.
    folder.text("dim.toml", "[whitewater]\nalbedo = [0.09, 0.09, 0.09]\n");
    let table = folder.run(&format!("{quick} --settings dim.toml --picture dim.exr")).ok().stdout();
    let dim = folder.picture("dim.exr");
    for layer in ["whitewater.Z", "whitewater.shadow", "whitewater.normal.X", "scene.Z"] {
        assert!(dim.channel(layer).is_some(), "{layer}");
    }
    let intensity = dim.channel("whitewater.intensity").unwrap();
    let red = dim.channel("R").unwrap();
    let thick: Vec<_> = intensity.iter().zip(red).filter(|(i, _)| **i > 0.7).collect();
    let mean = thick.iter().map(|(_, red)| **red).sum::<f32>() / thick.len() as f32;
    assert!(thick.len() > 20 && mean < 0.6, "{mean} of {}", thick.len());
    // The picture shows foam and sea.
    let picture = folder.picture("wave.png");
    assert_eq!((picture.width, picture.height), (160, 120));
    let rgb = picture.rgb().unwrap();
    let share = |test: &dyn Fn(&[f32; 3]) -> bool| {
        rgb.iter().filter(|c| test(c)).count() as f32 / rgb.len() as f32
    };
    let white = share(&|c| c.iter().all(|v| *v > 0.8));
    assert!((0.01..0.5).contains(&white), "{white} of the picture is white");
    assert!(share(&|c| c[2] < 0.55 && c[2] > c[0]) > 0.2);
    for part in
        ["wave, 20000 whitewater particles, 160x120, fast occlusion", "(24.", "ns a particle"]
    {
        assert!(table.contains(part), "{part}: {table}");
    }
}

#[test]
fn what_is_no_sea_is_an_error() {
    let folder = Folder::new();
    for (arguments, says) in [
        ("--sea pool", "pool"),
        ("--sea wave --whitewater 0", "from 1 to 268m"),
        ("--sea wave --whitewater 269m", "from 1 to 268m"),
        ("--sea wave --whitewater nan", "from 1 to 268m"),
        ("--sea wave --particles 64k", "--particles"),
        ("--whitewater 20k", "--sea"),
        ("--away 20", "--sea"),
        ("--sea wave --away 0.5", "from 1 to 100000"),
        ("--sea wave --away nan", "from 1 to 100000"),
        ("--sea wave,ship --picture a.png", "one combination"),
        ("--sea wave --picture a.jpg", ".png"),
        ("--settings a.toml", "--sea"),
    ] {
        let run = folder.run(&format!("bench {arguments}"));
        assert_eq!(run.0.status.code(), Some(2), "{arguments}: {}", run.stderr());
        assert!(run.stderr().contains(says), "{arguments}: {}", run.stderr());
    }
    assert!(folder.files().is_empty(), "{:?}", folder.files());
}

/// Cells of a CSV's rows by column name, without adapter and driver, which may contain commas.
fn cells(text: &str) -> Vec<HashMap<&str, &str>> {
    let mut lines = text.lines();
    let head: Vec<_> = lines.next().unwrap().split(',').skip(2).collect();
    lines
        .map(|line| {
            let (_, rest) = line.rsplit_once('"').unwrap();
            let row: Vec<_> = rest.split(',').skip(1).collect();
            assert_eq!(row.len(), head.len(), "{line}");
            head.iter().copied().zip(row).collect()
        })
        .collect()
}

const QUICK_MAP: &str = "[shore]\nmap = 256\ntexture_size = 64\n";

/// Coverage and cost of foam along shores, for each way to find the shore, relative to the water.
#[test]
fn shores_say_what_their_foam_costs() {
    let folder = Folder::new();
    folder.text("quick.toml", QUICK_MAP);
    let quick = "bench --particles 64 --size 160x90 --frames 2 --warmup 0 --settings quick.toml";
    let paths = "clip,strip";
    let command = format!("{quick} --shore isles --cover 0.4 --path {paths} --format json");
    let run = folder.run(&command).ok();
    let all: Value = serde_json::from_str(&run.stdout()).unwrap();
    let rows = all["rows"].as_array().unwrap();
    let number = |row: &Value, name: &str| row[name].as_f64().unwrap();
    for path in paths.split(',') {
        let find = |pass: &str| rows.iter().find(|r| r["path"] == path && r["pass"] == pass);
        let row = |pass: &str| find(pass).unwrap_or_else(|| panic!("{path}, {pass}"));
        let median = |pass: &str| number(row(pass), "median");
        let foam = row("foam");
        let (way, edge) = if path == "clip" { ("map", "clip") } else { ("strip", "smooth") };
        assert_eq!([&foam["shore"], &foam["way"], &foam["edge"]], ["isles", way, edge]);
        // The cost of foam is its passes and the increase of the composite; all are relative to the water's frame.
        let coat = median("composite") - median("composite without");
        assert!((median("coat") - coat).abs() < 1e-9, "{path}: {coat}");
        let sum = coat + median("shore-tiles") + median("shoreline");
        assert!((number(foam, "median") - sum).abs() < 1e-9, "{path}: {sum}");
        assert!((number(foam, "ratio") - sum / median("water frame")).abs() < 1e-9, "{path}");
        assert!(median("shoreline") > 0.0 && median("composite without") > 0.0);
        // As large as requested, and with foam.
        let shown = number(foam, "foam");
        let band = number(foam, "covered");
        assert!((band - 0.4).abs() < 0.01, "{path}: {band}");
        assert!((0.25 * band..band + 0.02).contains(&shown), "{path}: {shown} of {band}");
        assert_eq!(find("map").is_some(), way == "map", "{path}");
        if way == "map" {
            // Only an idle machine could tell which is slower.
            assert!(["map", "map in part", "map again"].map(median).iter().all(|time| *time > 0.0));
        }
    }
    let quick = format!("{quick} --shore isles --path contact --format csv");
    let text = folder.run(&quick).ok().stdout();
    let cells = cells(&text);
    let of = |pass| cells.iter().filter(move |row| row["pass"] == pass).collect::<Vec<_>>();
    let (foam, water) = (of("foam"), of("water frame"));
    assert_eq!([foam.len(), water.len()], [1; 2], "{text}");
    let (row, water) = (foam[0], water[0]);
    let number = |row: &HashMap<&str, &str>, name: &str| row[name].parse::<f64>().unwrap();
    assert_eq!([row["shore"], row["way"], row["covered"]], ["isles", "none", ""], "{text}");
    assert_eq!(number(row, "cover"), 0.2, "{text}");
    assert!(number(row, "foam") > 0.002, "{text}");
    // Its parts are times and a difference of two times, which noise may make negative; the sum is reported as it is.
    let ratio = number(row, "median_ms") / number(water, "median_ms");
    assert!((number(row, "ratio") - ratio).abs() < 1e-3, "{text}");
}

/// Contact foam on the water itself, and its picture.
#[test]
fn foam_on_the_water_is_timed() {
    let folder = Folder::new();
    folder.text("quick.toml", QUICK_MAP);
    let quick = "bench --particles 4k --size 160x90 --frames 1 --warmup 0 --settings quick.toml";
    let run = folder.run(&format!("{quick} --shore splash --picture splash.exr")).ok();
    let text = run.stdout();
    for part in ["splash, 160x90, default: v by none", "contact", "of the frame of"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let foam = folder.picture("splash.exr");
    let some = foam.channel("contact.amount").unwrap().iter().filter(|v| **v > 0.0).count();
    assert!(some > 30, "{some} pixels");
    // A path that does not apply to the scene is skipped.
    let run = folder.run(&format!("{quick} --shore splash --path strip")).ok();
    assert!(run.stderr().contains("skipped"), "{}", run.stderr());
}

#[test]
fn what_is_no_shore_is_an_error() {
    let folder = Folder::new();
    for (arguments, says) in [
        ("--shore beach", "isles"),
        ("--shore isles --sea wave", "--sea"),
        ("--shore isles --cover 0", "from 0.001 to 1"),
        ("--shore isles --cover nan", "from 0.001 to 1"),
        ("--shore isles --cover 0.99 --size 64x48", "--cover: expected at most"),
        ("--shore pool --cover 0.2", "applies to isles only"),
        ("--cover 0.2", "--shore"),
        ("--shore isles --particles 64,128", "one count"),
        ("--shore isles --path tiles", "draws water"),
        ("--path strip", "--shore isles"),
        ("--picture a.png", "--sea"),
        ("--shore isles --path all --picture a.png", "one combination"),
        ("--shore isles --picture a.jpg", ".png"),
    ] {
        let run = folder.run(&format!("bench {arguments}"));
        assert_eq!(run.0.status.code(), Some(2), "{arguments}: {}", run.stderr());
        assert!(run.stderr().contains(says), "{arguments}: {}", run.stderr());
    }
    assert!(folder.files().is_empty(), "{:?}", folder.files());
}
