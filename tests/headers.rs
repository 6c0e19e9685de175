//! The first comment of each shader names its pass, what it reads and what it writes. Each include has a comment; one
//! that binds resources names what it reads. Steps between two numbers rise.

use std::path::{Path, PathBuf};

fn shaders(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|e| e.expect("readable").path());
    let files = |path: PathBuf| if path.is_dir() { shaders(&path) } else { vec![path] };
    entries.flat_map(files).collect()
}

/// The first comment of a file, after its version.
fn header(text: &str) -> String {
    let lines = text.lines().skip_while(|line| line.starts_with("#version"));
    let comment: Vec<_> = lines.map_while(|line| line.strip_prefix("//")).collect();
    comment.join("")
}

#[test]
fn headers_say_what_is_read_and_written() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("glsl");
    let (mut wrong, mut seen) = (Vec::new(), 0);
    for path in shaders(&root) {
        let text = std::fs::read_to_string(&path).expect("text");
        let (header, include) = (header(&text), path.extension().is_some_and(|e| e == "glsl"));
        let mut asked = vec![("a pass", include || header.starts_with(" Pass"))];
        asked.push(("a comment", !header.is_empty()));
        let binds = text.contains("layout(set");
        asked.push(("Reads", include && !binds || header.contains(" Reads")));
        asked.push(("Writes", include || header.contains(" Writes: ")));
        for (what, there) in asked {
            if !there {
                wrong.push(format!("{}: {what}", path.display()));
            }
        }
        seen += 1;
    }
    assert!(seen > 80, "only {seen} shaders");
    assert!(wrong.is_empty(), "headers lack\n{}", wrong.join("\n"));
}

/// The arguments of a call, from the text behind its opening parenthesis.
fn arguments(text: &str) -> Vec<&str> {
    let (mut depth, mut from, mut all) = (0, 0, Vec::new());
    for (i, c) in text.char_indices() {
        match c {
            '(' | '[' => depth += 1,
            ')' | ']' if depth > 0 => depth -= 1,
            ')' => {
                all.push(text[from..i].trim());
                break;
            }
            ',' if depth == 0 => {
                all.push(text[from..i].trim());
                from = i + 1;
            }
            _ => {}
        }
    }
    all
}

/// In GLSL and SPIR-V, `smoothstep` is undefined unless its first edge is below the second.
#[test]
fn smooth_steps_rise() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("glsl");
    let (mut wrong, mut seen) = (Vec::new(), 0);
    for path in shaders(&root) {
        let text = std::fs::read_to_string(&path).expect("text");
        for (at, name) in text.match_indices("smoothstep(") {
            let call = arguments(&text[at + name.len()..]);
            let edges = call.iter().take(2).map_while(|edge| edge.parse::<f64>().ok());
            if let [low, high] = edges.collect::<Vec<_>>()[..] {
                seen += 1;
                if low >= high {
                    wrong.push(format!("{}: smoothstep({low}, {high}, ...)", path.display()));
                }
            }
        }
    }
    assert!(seen > 20, "only {seen} with numbers");
    assert!(wrong.is_empty(), "they fall\n{}", wrong.join("\n"));
}
