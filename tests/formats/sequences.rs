//! Inputs to numbered frames.

use std::path::PathBuf;

use whitewater::io::particles::sequence::{SequenceError, expand, parse_range};

/// A folder of empty files that goes away at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str, files: &[&str]) -> Self {
        let path = std::env::temp_dir().join(format!("whitewater-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        for file in files {
            std::fs::write(path.join(file), b"").unwrap();
        }
        Self(path)
    }

    fn input(&self, name: &str) -> String {
        self.0.join(name).display().to_string()
    }

    fn frames(&self, inputs: &[&str], range: Option<&str>) -> Vec<(u64, String)> {
        let inputs: Vec<_> = inputs.iter().map(|i| self.input(i)).collect();
        let range = range.map(|r| parse_range(r).unwrap());
        expand(&inputs, range)
            .unwrap()
            .into_iter()
            .map(|f| (f.number, f.path.file_name().unwrap().to_string_lossy().into_owned()))
            .collect()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn named(list: &[(u64, &str)]) -> Vec<(u64, String)> {
    list.iter().map(|(n, s)| (*n, (*s).to_string())).collect()
}

#[test]
fn natural_order() {
    let folder =
        Folder::new("natural", &["frame_10.bgeo", "frame_2.bgeo", "frame_1.bgeo", "other.txt"]);
    let expected = named(&[(1, "frame_1.bgeo"), (2, "frame_2.bgeo"), (10, "frame_10.bgeo")]);
    assert_eq!(folder.frames(&["frame_*.bgeo"], None), expected);
    assert_eq!(folder.frames(&["frame_%d.bgeo"], None), expected);
    // As the shell expands it, in its order.
    assert_eq!(folder.frames(&["frame_1.bgeo", "frame_10.bgeo", "frame_2.bgeo"], None), expected);
    assert_eq!(folder.frames(&["frame_*.bgeo"], Some("2-9")), expected[1..2]);
    assert_eq!(folder.frames(&["frame_*.bgeo"], Some("10")), expected[2..]);
}

#[test]
fn printf_width() {
    let folder = Folder::new(
        "width",
        &["a_0007.vtu", "a_7.vtu", "a_0010.vtu", "a_12345.vtu", "a_00011.vtu", "a_x.vtu"],
    );
    assert_eq!(
        folder.frames(&["a_%04d.vtu"], None),
        named(&[(7, "a_0007.vtu"), (10, "a_0010.vtu"), (12345, "a_12345.vtu")])
    );
}

#[test]
fn the_number_is_the_run_that_differs() {
    let folder = Folder::new("differs", &["run2_f3_v1.ply", "run2_f12_v1.ply"]);
    assert_eq!(
        folder.frames(&["*.ply"], None),
        named(&[(3, "run2_f3_v1.ply"), (12, "run2_f12_v1.ply")])
    );
    // Where two runs differ it is the last.
    let folder = Folder::new("two", &["t5_f10.ply", "t6_f20.ply"]);
    assert_eq!(folder.frames(&["*.ply"], None), named(&[(10, "t5_f10.ply"), (20, "t6_f20.ply")]));
    let folder = Folder::new("single", &["dam27.npz", "still.ply", "a.ply"]);
    assert_eq!(folder.frames(&["dam27.npz"], None), named(&[(27, "dam27.npz")]));
    assert_eq!(folder.frames(&["*.ply"], None), named(&[(0, "a.ply"), (1, "still.ply")]));
}

#[test]
fn names_with_pattern_characters() {
    let folder = Folder::new("odd", &["a[1].bgeo", "b%d_3.bgeo"]);
    assert_eq!(folder.frames(&["a[1].bgeo"], None), named(&[(1, "a[1].bgeo")]));
    assert_eq!(folder.frames(&["b%d_3.bgeo"], None), named(&[(3, "b%d_3.bgeo")]));
}

#[test]
fn errors_say_what_is_there() {
    let folder = Folder::new("errors", &["f_3.bgeo", "g_3.bgeo"]);
    let fails = |inputs: &[&str], range: Option<&str>| {
        let inputs: Vec<_> = inputs.iter().map(|i| folder.input(i)).collect();
        expand(&inputs, range.map(|r| parse_range(r).unwrap())).unwrap_err()
    };
    assert!(matches!(expand::<&str>(&[], None), Err(SequenceError::NoInput)));
    assert!(matches!(fails(&["f_4.bgeo"], None), SequenceError::NotFound { .. }));
    assert!(matches!(fails(&[""], None), SequenceError::Directory { .. }));
    assert!(matches!(fails(&["no/%d.bgeo"], None), SequenceError::Io { .. }));
    assert!(matches!(fails(&["f_%s.bgeo"], None), SequenceError::Pattern { .. }));
    assert!(matches!(fails(&["f_%d_%d.bgeo"], None), SequenceError::Pattern { .. }));
    assert!(matches!(fails(&["f_[.bgeo"], None), SequenceError::Pattern { .. }));
    assert!(matches!(fails(&["?_3.bgeo"], None), SequenceError::Twice { number: 3, .. }));
    // One input that gives nothing is an error, though others give something.
    let none = fails(&["f_3.bgeo", "h_*.bgeo"], None).to_string();
    assert!(none.contains("h_*.bgeo") && none.contains("the first is f_3.bgeo"), "{none}");
    let outside = fails(&["f_*.bgeo"], Some("5-9")).to_string();
    assert!(outside.contains("5 to 9") && outside.contains("frames 3 to 3"), "{outside}");
    for range in ["", "a", "3-", "-3", "9-5", "1-2-3", "18446744073709551616"] {
        assert!(parse_range(range).is_err(), "{range}");
    }
    assert_eq!(parse_range("3-9").unwrap(), 3..=9);
}
