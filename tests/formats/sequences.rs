//! Input arguments become a list of numbered frames.

use super::folder::Folder;
use whitewater::io::particles::sequence::{
    SequenceError, expand, expand_joined, parse_range, time_unit,
};

/// A folder of empty files.
struct Files(Folder);

impl Files {
    fn new(name: &str, files: &[&str]) -> Self {
        let folder = Folder::new(name);
        for file in files {
            folder.put(file, b"");
        }
        Self(folder)
    }

    fn input(&self, name: &str) -> String {
        self.0.path().join(name).display().to_string()
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

fn named(list: &[(u64, &str)]) -> Vec<(u64, String)> {
    list.iter().map(|(n, s)| (*n, (*s).to_string())).collect()
}

#[test]
fn natural_order() {
    let folder =
        Files::new("natural", &["frame_10.bgeo", "frame_2.bgeo", "frame_1.bgeo", "other.txt"]);
    let expected = named(&[(1, "frame_1.bgeo"), (2, "frame_2.bgeo"), (10, "frame_10.bgeo")]);
    assert_eq!(folder.frames(&["frame_*.bgeo"], None), expected);
    assert_eq!(folder.frames(&["frame_%d.bgeo"], None), expected);
    // The list of files in the order in which a shell expands the pattern.
    assert_eq!(folder.frames(&["frame_1.bgeo", "frame_10.bgeo", "frame_2.bgeo"], None), expected);
    assert_eq!(folder.frames(&["frame_*.bgeo"], Some("2-9")), expected[1..2]);
    assert_eq!(folder.frames(&["frame_*.bgeo"], Some("10")), expected[2..]);
}

#[test]
fn printf_width() {
    let folder = Files::new(
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
    let folder = Files::new("differs", &["run2_f3_v1.ply", "run2_f12_v1.ply"]);
    assert_eq!(
        folder.frames(&["*.ply"], None),
        named(&[(3, "run2_f3_v1.ply"), (12, "run2_f12_v1.ply")])
    );
    // If two numbers differ between the names, the last one is the frame number.
    let folder = Files::new("two", &["t5_f10.ply", "t6_f20.ply"]);
    assert_eq!(folder.frames(&["*.ply"], None), named(&[(10, "t5_f10.ply"), (20, "t6_f20.ply")]));
    let folder = Files::new("single", &["dam27.npz", "still.ply", "a.ply"]);
    assert_eq!(folder.frames(&["dam27.npz"], None), named(&[(27, "dam27.npz")]));
    assert_eq!(folder.frames(&["*.ply"], None), named(&[(0, "a.ply"), (1, "still.ply")]));
}

/// Lists the files of a pattern, with their numbers and times.
fn times(name: &str, files: &[&str], pattern: &str) -> Vec<(u64, Option<f64>, String)> {
    let folder = Files::new(name, files);
    let root = format!("{}/", folder.0.path().display());
    let found = expand(&[folder.input(pattern)], None).unwrap();
    let short = |path: &std::path::Path| path.display().to_string().replace(&root, "");
    found.into_iter().map(|f| (f.number, f.time, short(&f.path))).collect()
}

/// Names that contain times, listed in the order of the times.
#[test]
fn times_order_the_frames() {
    for (name, pattern, files) in [
        ("shortest", "t*.npz", &[("t0.32.npz", 0.32), ("t0.4.npz", 0.4), ("t0.44.npz", 0.44)][..]),
        (
            "fixed",
            "*.vtk",
            &[("fluid_0.90.vtk", 0.9), ("fluid_1.05.vtk", 1.05), ("fluid_10.00.vtk", 10.0)],
        ),
        (
            "mixed",
            "*.vtk",
            &[("t0.vtk", 0.0), ("t0.5.vtk", 0.5), ("t1.vtk", 1.0), ("t1.25.vtk", 1.25)],
        ),
        (
            "folders",
            "*/cloud.vtp",
            &[("9.92/cloud.vtp", 9.92), ("10/cloud.vtp", 10.0), ("10.04/cloud.vtp", 10.04)],
        ),
        (
            "deep",
            "*/lagrangian/c1/p.vtp",
            &[("0.5/lagrangian/c1/p.vtp", 0.5), ("1e-05/lagrangian/c1/p.vtp", 1e-5)],
        ),
        (
            "exponents",
            "*.npz",
            &[("e_3.600e-04.npz", 3.6e-4), ("e_4.000e-04.npz", 4e-4), ("e_4.000e-03.npz", 4e-3)],
        ),
        ("signs", "*.npz", &[("t_-0.5.npz", -0.5), ("t_0.npz", 0.0), ("t_0.25.npz", 0.25)]),
        ("packed", "*.vtk.gz", &[("a.0.32.vtk.gz", 0.32), ("a.0.4.vtk.gz", 0.4)]),
    ] {
        let mut expected: Vec<(u64, Option<f64>, String)> =
            files.iter().map(|(file, time)| (0, Some(*time), (*file).to_string())).collect();
        expected.sort_by(|a, b| a.1.unwrap().total_cmp(&b.1.unwrap()));
        (0..).zip(&mut expected).for_each(|(i, frame)| frame.0 = i);
        let names: Vec<_> = files.iter().rev().map(|(file, _)| *file).collect();
        assert_eq!(times(name, &names, pattern), expected, "{name}");
    }
}

#[test]
fn numbers_that_are_no_times() {
    let frame = |number, path: &str| (number, None, path.to_string());
    for (name, pattern, files) in [
        ("letters", "*.vtu", &[(9, "fluid.0009.vtu"), (10, "fluid.0010.vtu")][..]),
        ("no extension", "dump.*", &[(900, "dump.liggghts.900"), (1000, "dump.liggghts.1000")]),
        ("dots", "*.vtk", &[(8, "Particle.Data_8.vtk"), (12, "Particle.Data_12.vtk")]),
        ("whole folders", "*/p.vtk", &[(2, "2/p.vtk"), (10, "10/p.vtk")]),
        ("hashes", "*.ply", &[(3, "2e4_3.ply"), (4, "2e4_4.ply")]),
        (
            "many digits",
            "*.ply",
            &[(3_000_000_000, "p_3000000000_of_4.ply"), (3_000_001_000, "p_3000001000_of_4.ply")],
        ),
        ("ranks", "*.vtu", &[(0, "p-00008.0000.vtu"), (1, "p-00008.0001.vtu")]),
        // A hash after the frame number; and times of day, with the hours first.
        ("more runs", "*.ply", &[(3, "f_3_99.ply"), (4, "f_4_17.ply"), (5, "f_5_3.ply")]),
        ("clocks", "*.ply", &[(0, "d_10_58.ply"), (1, "d_10_59.ply"), (2, "d_11_01.ply")]),
        // No program writes 1.1 as 1.10 next to times with fewer decimals, so 1.10 comes after 1.9.
        ("steps of runs", "*.vtk", &[(0, "run1.9.vtk"), (1, "run1.10.vtk")]),
        // A minus after another separator is a sign.
        (
            "negative",
            "*.npz",
            &[(0, "step--1.npz"), (1, "step-0.npz"), (2, "step-1.npz"), (3, "step-2.npz")],
        ),
    ] {
        let expected: Vec<_> = files.iter().map(|(number, file)| frame(*number, file)).collect();
        let names: Vec<_> = files.iter().rev().map(|(_, file)| *file).collect();
        assert_eq!(times(name, &names, pattern), expected, "{name}");
    }
    // A pattern with `%d` determines which number is the frame.
    let files = ["f.1.0004.vtu", "f.1.0010.vtu"];
    assert_eq!(times("said", &files, "f.1.%04d.vtu"), [frame(4, files[0]), frame(10, files[1])]);
}

/// Units of time behind the numbers. Where they differ, the times order the frames.
#[test]
fn units_of_time_in_names() {
    for (name, pattern, files) in [
        (
            "differ",
            "w_*.csv",
            &[
                (0, "w_0.csv", 0.0),
                (1, "w_900us.csv", 9.0e-4),
                (2, "w_1ms.csv", 1.0e-3),
                (3, "w_1500\u{b5}s.csv", 1.5e-3),
                (4, "w_1.5s.csv", 1.5),
                (5, "w_2min.csv", 120.0),
                (6, "w_1h.csv", 3600.0),
            ][..],
        ),
        ("one", "w_*.csv", &[(5, "w_5ms.csv", 0.005), (10, "w_10ms.csv", 0.01)]),
        ("padded", "w_*.csv", &[(5, "w_0005us_a.csv", 5.0e-6), (10, "w_0010us_a.csv", 1.0e-5)]),
        ("said", "w_%dms.csv", &[(5, "w_5ms.csv", 0.005), (10, "w_10ms.csv", 0.01)]),
        ("points", "w_*.csv", &[(0, "w_000.50s.csv", 0.5), (1, "w_010.25s.csv", 10.25)]),
        ("exponents", "w_*.csv", &[(0, "w_5.0e-04s.csv", 5.0e-4), (1, "w_2e-03s.csv", 2.0e-3)]),
        ("folders", "*/p.csv", &[(0, "900ns/p.csv", 9.0e-7), (1, "1us/p.csv", 1.0e-6)]),
        ("words", "*.csv", &[(10, "step_10s_fluid.csv", 10.0), (20, "step_20s_fluid.csv", 20.0)]),
        // `1.10` is no pair of numbers if it has a unit.
        ("pairs", "*.csv", &[(0, "w1.10s.csv", 1.1), (1, "w1.9s.csv", 1.9)]),
        ("signs", "*.csv", &[(0, "w_-5ms.csv", -0.005), (1, "w_0ms.csv", 0.0)]),
    ] {
        let expected: Vec<_> = files
            .iter()
            .map(|(number, file, time)| (*number, Some(*time), (*file).into()))
            .collect();
        let mut names: Vec<_> = files.iter().map(|(_, file, _)| *file).collect();
        names.sort();
        assert_eq!(times(&format!("unit {name}"), &names, pattern), expected, "{name}");
    }
    let folder = Files::new("unit seconds", &["w_1ms.csv", "w_2ms.csv", "v_0.1.csv", "v_0.2.csv"]);
    for (pattern, in_seconds) in [("w_*.csv", true), ("w_%dms.csv", true), ("v_*.csv", false)] {
        let frames = expand(&[folder.input(pattern)], None).unwrap();
        assert!(frames.iter().all(|frame| frame.in_seconds == in_seconds), "{pattern}");
    }
    // Letters that are no unit of time, or do not end the word.
    let frame = |number, path: &str| (number, None, path.to_string());
    for (name, files) in [
        ("metres", [(9, "9m_run.csv"), (10, "10m_run.csv")]),
        ("hex", [(3, "5h3.csv"), (4, "5h4.csv")]),
        ("steps", [(2, "2steps.csv"), (10, "10steps.csv")]),
        ("before", [(2, "t_s2.csv"), (10, "t_s10.csv")]),
    ] {
        let expected = files.map(|(number, file)| frame(number, file));
        let names = files.map(|(_, file)| file);
        assert_eq!(times(&format!("unit {name}"), &names, "*.csv"), expected, "{name}");
    }
    // One time in two units is one frame.
    let folder = Files::new("unit twice", &["w_1000us.csv", "w_1ms.csv"]);
    let error = expand(&[folder.input("*.csv")], None).unwrap_err().to_string();
    assert!(error.contains("both frame 0"), "{error}");
    // A number without a unit could be anywhere among units that differ.
    let folder = Files::new("unit none", &["w_900us.csv", "w_1ms.csv", "w_2.csv"]);
    let error = expand(&[folder.input("*.csv")], None).unwrap_err().to_string();
    assert!(error.contains("w_2.csv: expected a unit of time behind the number"), "{error}");
    for (text, length) in [
        ("ms_fluid", Some(2)),
        ("s", Some(1)),
        ("\u{b5}s.csv", Some(3)),
        ("min", Some(3)),
        ("sec", Some(3)),
        ("m", None),
        ("steps", None),
        ("h3", None),
        ("", None),
    ] {
        assert_eq!(time_unit(text), length, "{text}");
    }
}

#[test]
fn two_files_of_a_frame_are_told_what_to_do() {
    let fails = |name: &str, files: &[&str], pattern: &str| {
        let folder = Files::new(name, files);
        expand(&[folder.input(pattern)], None).unwrap_err().to_string()
    };
    let phases = ["D_Fluid_8.vtk", "D_Fluid_9.vtk", "D_Oil_8.vtk", "D_Oil_9.vtk"];
    let error = fails("phases", &phases, "D_*.vtk");
    assert!(error.contains("both frame 8") && error.contains("D_Fluid_*.vtk'"), "{error}");
    let ranks = ["0.1/p_0.vtk", "0.1/p_1.vtk", "0.2/p_0.vtk", "0.2/p_1.vtk"];
    let error = fails("ranks of times", &ranks, "*/p_*.vtk");
    assert!(error.contains("pieces of one frame") && error.contains(".pvtu"), "{error}");
    let error = fails("times", &["a0.5.vtk", "b0.5.vtk"], "*.vtk");
    assert!(error.contains("both frame 0"), "{error}");
}

#[test]
fn names_with_pattern_characters() {
    let folder = Files::new("odd", &["a[1].bgeo", "b%d_3.bgeo"]);
    assert_eq!(folder.frames(&["a[1].bgeo"], None), named(&[(1, "a[1].bgeo")]));
    assert_eq!(folder.frames(&["b%d_3.bgeo"], None), named(&[(3, "b%d_3.bgeo")]));
}

#[test]
fn errors_say_what_is_there() {
    let folder = Files::new("errors", &["f_3.bgeo", "g_3.bgeo"]);
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
    // An input without a file is an error, even if another input has files.
    let none = fails(&["f_3.bgeo", "h_*.bgeo"], None).to_string();
    assert!(none.contains("h_*.bgeo") && none.contains("the first is f_3.bgeo"), "{none}");
    let outside = fails(&["f_*.bgeo"], Some("5-9")).to_string();
    assert_eq!(outside, "no frame from 5 to 9; the only frame found is 3");
    let folder = Files::new("nearest", &["f_3.bgeo", "f_5.bgeo", "f_8.bgeo", "f_12.bgeo"]);
    for (range, told) in [
        ("9-11", "no frame from 9 to 11; the nearest of 4 found are 8 and 12"),
        ("6", "no frame 6; the nearest of 4 found are 5 and 8"),
        ("0-2", "no frame from 0 to 2; the nearest of 4 found is 3"),
        ("13", "no frame 13; the nearest of 4 found is 12"),
    ] {
        let range = parse_range(range).unwrap();
        let failed = expand(&[folder.input("f_*.bgeo")], Some(range)).unwrap_err();
        assert_eq!(failed.to_string(), told);
    }
    for range in ["", "a", "3-", "-3", "9-5", "1-2-3", "18446744073709551616"] {
        assert!(parse_range(range).is_err(), "{range}");
    }
    assert_eq!(parse_range("3-9").unwrap(), 3..=9);
}

/// Files of several processes are parts of one frame.
#[test]
fn ranks_are_no_frames() {
    let folder = Folder::new("ranks");
    for rank in 0..3 {
        std::fs::create_dir_all(folder.path().join(format!("run/proc{rank}"))).unwrap();
        for frame in [10, 11] {
            folder.put(&format!("fluid_{frame}_rank{rank}.csv"), "x,y,z\n0,0,0\n");
        }
        folder.put(&format!("one_MPI-{rank}.csv"), "x,y,z\n0,0,0\n");
        folder.put(&format!("run/proc{rank}/f.csv"), "x,y,z\n0,0,0\n");
    }
    for (pattern, numbers) in
        [("fluid_*.csv", &[10, 11][..]), ("one_*.csv", &[0]), ("run/proc*/f.csv", &[0])]
    {
        let pattern = folder.path().join(pattern).display().to_string();
        let frames = expand_joined(&[&pattern], None).unwrap();
        assert_eq!(frames.iter().map(|f| f.number).collect::<Vec<_>>(), numbers, "{pattern}");
        assert!(frames.iter().all(|frame| frame.also.len() == 2), "{pattern}");
        let error = expand(&[&pattern], None).unwrap_err().to_string();
        assert!(error.contains("--join"), "{error}");
    }
}

/// A file that the system cannot look at (here a link to itself) would otherwise be a frame less.
#[cfg(unix)]
#[test]
fn files_that_cannot_be_looked_at_are_told() {
    let folder = Files::new("unseen", &["f_1.csv", "f_3.csv"]);
    let link = folder.0.path().join("f_2.csv");
    std::os::unix::fs::symlink(&link, &link).unwrap();
    for pattern in ["f_*.csv", "f_%d.csv", "f_2.csv"] {
        let error = expand(&[folder.input(pattern)], None).unwrap_err();
        assert!(matches!(error, SequenceError::Io { .. }), "{pattern}: {error}");
        assert!(error.to_string().contains("f_2.csv"), "{pattern}: {error}");
    }
    // A link whose target does not exist.
    std::fs::remove_file(&link).unwrap();
    std::os::unix::fs::symlink("gone.csv", &link).unwrap();
    for pattern in ["f_*.csv", "f_%d.csv", "f_2.csv"] {
        let error = expand(&[folder.input(pattern)], None).unwrap_err().to_string();
        assert!(error.contains("f_2.csv is a link to gone.csv, which"), "{pattern}: {error}");
    }
    // Emacs locks a file so.
    std::fs::remove_file(&link).unwrap();
    std::os::unix::fs::symlink("me@host.42", folder.0.path().join(".#f_2.csv")).unwrap();
    assert_eq!(folder.frames(&["*.csv"], None).len(), 2);
}
