//! `bench`: what it prints, and that nothing measured is lost.

use std::io::{BufRead, BufReader, Read};
use std::process::Stdio;

use serde_json::Value;

use super::support::Folder;

const QUICK: &str = "bench --particles 64 --frames 2 --warmup 0";

/// Two ways to draw, each with its passes and their sum.
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
                    // What comes before is in quotes and may have commas.
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

#[test]
fn each_format_has_all_rows_also_where_it_ends_early() {
    let folder = Folder::new();
    for format in ["table", "csv", "json"] {
        let command = format!("{QUICK} --path default,tiles --format {format} --size");
        let run = folder.run(&format!("{command} 64x48")).ok();
        check(format, &run.stdout());
        assert!(run.stderr().contains("(1 of 2, "), "{}", run.stderr());
        let run = folder.run(&format!("{command} 64x48,300000x64"));
        check(format, &run.stdout());
        let text = run.fails(2, &["300000x64", "--size"]).stderr();
        assert!(!text.contains("--supersample"), "{text}");
    }
}

#[test]
fn an_interrupt_loses_nothing_measured() {
    let folder = Folder::new();
    // The second combination takes long.
    let command = "bench --particles 64 --size 16x16,1280x720 --frames 500 --format json";
    let mut command = folder.command(command);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let lines = BufReader::new(child.stderr.take().unwrap()).lines();
    let mut told = lines.map_while(Result::ok);
    assert!(told.any(|line| line.contains("(1 of 2, ")));
    let id = child.id().to_string();
    assert!(std::process::Command::new("kill").args(["-INT", &id]).status().unwrap().success());
    let mut text = String::new();
    child.stdout.take().unwrap().read_to_string(&mut text).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let all: Value = serde_json::from_str(&text).unwrap();
    let rows = all["rows"].as_array().unwrap();
    assert!(!rows.is_empty() && rows.iter().all(|row| row["width"] == 16), "{text}");
}
