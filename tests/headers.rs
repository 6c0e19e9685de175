//! The first comment of each shader names its pass, what it reads and what it writes. That of each include describes it
//! and names the includes that it needs.

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
