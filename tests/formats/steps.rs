//! Files that hold several frames, and frames that are several files.

use std::path::Path;

use super::folder::Folder;
use super::samples::{self, gzip};
use whitewater::io::particles::sequence::{SequenceError, expand, expand_joined};
use whitewater::io::particles::{Particles, read, read_step, read_with, steps};

/// The cloud, moved along x by the number of the frame and without as many particles.
fn cloud(frame: usize) -> Particles {
    let mut cloud = samples::cloud();
    cloud.positions.iter_mut().for_each(|p| p[0] += frame as f32);
    let kept: Vec<bool> = (0..samples::COUNT).map(|i| i >= frame).collect();
    cloud.retain(&kept);
    cloud
}

/// Rows of numbers: id, position, velocity.
fn rows(of: &Particles, first: &str, separator: &str) -> String {
    let row = |i: usize| {
        let numbers = of.positions[i].iter().chain(&of.velocities.as_ref().unwrap()[i]);
        let numbers = numbers.map(f32::to_string).collect::<Vec<_>>().join(separator);
        format!("{first}{}{separator}{numbers}\n", of.ids.as_ref().unwrap()[i])
    };
    (0..of.positions.len()).map(row).collect()
}

#[track_caller]
fn check(path: &Path, times: &[Option<f64>]) {
    let name = path.display();
    let all = steps(path).unwrap();
    assert_eq!(all.iter().map(|step| step.time).collect::<Vec<_>>(), times, "{name}");
    for (i, step) in all.iter().enumerate() {
        assert_eq!(step.index, i);
        let (found, expected) = (read_step(path, *step, &[]).unwrap(), cloud(i));
        assert_eq!(found.positions, expected.positions, "{name}: {i}");
        assert_eq!(found.velocities, expected.velocities, "{name}: {i}");
        assert_eq!(found.ids, expected.ids, "{name}: {i}");
        assert_eq!(found.time, times[i], "{name}");
        assert!(found.warnings.is_empty(), "{name}: {:?}", found.warnings);
    }
}

const TIMES: [Option<f64>; 3] = [Some(0.0), Some(0.25), Some(0.5)];

/// By a column of times, whatever their order in the file; packed or not.
#[test]
fn a_table_with_times_is_frames() {
    let folder = Folder::new("steps");
    let head = "time,id,x,y,z,vx,vy,vz\n";
    let body = |order: [usize; 3]| -> String {
        let of = |i: usize| rows(&cloud(i), &format!("{},", 0.25 * i as f32), ",");
        order.into_iter().map(of).collect()
    };
    let text = format!("{head}{}", body([0, 1, 2]));
    check(&folder.put("a.csv", &text), &TIMES);
    check(&folder.put("b.csv", format!("{head}{}", body([2, 0, 1]))), &TIMES);
    check(&folder.put("a.csv.gz", gzip(text.as_bytes())), &TIMES);
    check(&folder.put("a.txt", text.replace(',', " ")), &TIMES);
    // Without a frame that is named it is refused as before.
    let error = read(&folder.put("c.csv", &text)).unwrap_err().to_string();
    assert!(error.contains("3 frames"), "{error}");
    // One time is no sequence.
    let one = folder.put("one.csv", format!("{head}{}", rows(&cloud(0), "0.5,", ",")));
    assert!(steps(&one).unwrap().is_empty());
    assert_eq!(read(&one).unwrap().time, Some(0.5));
}

#[test]
fn frames_of_xyz_one_after_the_other() {
    let folder = Folder::new("xyz-steps");
    let frame = |comment: &str, i: usize| {
        let of = cloud(i);
        let rows = rows(&of, "", " ");
        format!("{}\n{comment}\n{rows}", of.positions.len())
    };
    let extended = |i: usize| {
        let properties = "Properties=id:I:1:pos:R:3:velo:R:3";
        frame(&format!("{properties} Time={}", 0.25 * i as f32), i)
    };
    let text: String = (0..3).map(extended).collect();
    check(&folder.put("a.xyz", &text), &TIMES);
    check(&folder.put("a.xyz.gz", gzip(text.as_bytes())), &TIMES);
    let named: String = (0..3).map(|i| frame("id x y z vx vy vz", i)).collect();
    check(&folder.put("b.xyz", &named), &[None; 3]);
    // A fault is told by its line in the file.
    let text_of_bad = format!("{}what\n", named.strip_suffix("-2\n").unwrap());
    let line = text_of_bad.lines().count();
    let bad = folder.put("bad.xyz", text_of_bad);
    let found = steps(&bad).unwrap();
    let errors: Vec<_> = found.iter().filter_map(|s| read_step(&bad, *s, &[]).err()).collect();
    assert!(errors[0].to_string().contains(&format!("in line {line}")), "{line}: {}", errors[0]);
    // One that is cut off is there, and a fault.
    let cut = folder.put("cut.xyz", &text[..text.len() - 30]);
    let found = steps(&cut).unwrap();
    assert_eq!(found.len(), 3);
    read_step(&cut, found[1], &[]).unwrap();
    read_step(&cut, found[2], &[]).unwrap_err();
}

#[test]
fn dumps_of_lammps_one_after_the_other() {
    let folder = Folder::new("dump-steps");
    let frame = |i: usize, timed: bool| {
        let of = cloud(i);
        let time = if timed { format!("ITEM: TIME\n{}\n", 0.25 * i as f32) } else { String::new() };
        let count = of.positions.len();
        format!(
            "{time}ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{count}\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n\
             ITEM: ATOMS id x y z vx vy vz\n{}",
            100 * i,
            rows(&of, "", " ")
        )
    };
    let text: String = (0..3).map(|i| frame(i, true)).collect();
    check(&folder.put("a.lammpstrj", &text), &TIMES);
    let text: String = (0..3).map(|i| frame(i, false)).collect();
    check(&folder.put("b.dump", &text), &[None; 3]);
    assert!(steps(&folder.put("one.dump", frame(0, true))).unwrap().is_empty());
}

/// Phases in a file each, and the ranks that a PVD has at one time.
#[test]
fn files_of_one_number_are_one_frame_where_told() {
    let folder = Folder::new("join");
    let text = |from: u32, phase: &str| {
        let row = |i: u32| format!("{i},1,{},0,{}{phase}\n", from + i, from + i);
        let head = if phase.is_empty() { "x,y,z,h,id\n" } else { "x,y,z,h,id,phase\n" };
        head.to_string() + &(0..4).map(row).collect::<String>()
    };
    for frame in [1, 2] {
        folder.put(&format!("oil_{frame}.csv"), text(10, ",1"));
        folder.put(&format!("water_{frame}.csv"), text(20, ""));
    }
    let pattern = folder.path().join("*_*.csv").display().to_string();
    let error = expand(&[&pattern], None).unwrap_err();
    assert!(matches!(error, SequenceError::Twice { .. }), "{error}");
    assert!(error.to_string().contains("--join"), "{error}");
    let frames = expand_joined(&[&pattern], None).unwrap();
    assert_eq!(frames.iter().map(|f| f.number).collect::<Vec<_>>(), [1, 2]);
    let paths: Vec<_> = frames[0].paths().map(|p| p.file_name().unwrap().to_owned()).collect();
    assert_eq!(paths, ["oil_1.csv", "water_1.csv"]);
    let read = |path: &Path| read_with(path, &["phase", "h"]).unwrap();
    let mut all = read(&frames[0].path);
    all.append(read(&frames[0].also[0]));
    assert_eq!(all.ids, Some((10..14).chain(20..24).collect()));
    let phase = all.extras.iter().find(|extra| extra.name == "phase").unwrap();
    assert!(phase.values[..4] == [1.0; 4] && phase.values[4..].iter().all(|v| v.is_nan()));
    assert!(all.warnings.is_empty(), "{:?}", all.warnings);
    // The same ids tell nothing, and velocities of a part are none.
    let mut other = read(&frames[0].path);
    other.velocities = Some(vec![[1.0; 3]; 4]);
    all.append(other);
    assert_eq!((all.ids, all.velocities), (None, None));
    assert!(all.warnings[0].contains("ids are dropped"), "{:?}", all.warnings);
    assert!(all.warnings[1].contains("velocity is dropped"), "{:?}", all.warnings);
    let set = |time: f32, part: u8, file: &str| {
        format!("<DataSet timestep=\"{time}\" group=\"\" part=\"{part}\" file=\"{file}\"/>")
    };
    let sets: String = [1, 2]
        .map(|f| {
            set(0.1 * f as f32, 0, &format!("oil_{f}.csv"))
                + &set(0.1 * f as f32, 1, &format!("water_{f}.csv"))
        })
        .concat();
    let text = format!("<VTKFile type=\"Collection\"><Collection>{sets}</Collection></VTKFile>");
    let pvd = folder.put("all.pvd", text);
    let frames = expand(&[pvd.display().to_string()], None).unwrap();
    assert_eq!(frames.iter().map(|f| f.also.len()).collect::<Vec<_>>(), [1, 1]);
}
