//! Files with several frames, and frames that consist of several files.

use std::path::Path;

use super::folder::Folder;
use super::samples::{self, gzip};
use whitewater::io::particles::sequence::{SequenceError, expand, expand_joined};
use whitewater::io::particles::{Particles, Step, read, read_step, read_with, steps};

/// The cloud of a frame: moved along x by the frame's number, with that number of particles
/// removed.
fn cloud(frame: usize) -> Particles {
    let mut cloud = samples::cloud();
    cloud.positions.iter_mut().for_each(|p| p[0] += frame as f32);
    let kept: Vec<bool> = (0..samples::COUNT).map(|i| i >= frame).collect();
    cloud.retain(&kept);
    cloud
}

/// Rows of id, position and velocity.
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

/// Frames are separated by a column of times, whatever their order in the file, with and without
/// compression.
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
    // Without a frame number the file is still refused.
    let error = read(&folder.put("c.csv", &text)).unwrap_err().to_string();
    assert!(error.contains("3 frames"), "{error}");
    // A table with a single time is no sequence.
    let one = folder.put("one.csv", format!("{head}{}", rows(&cloud(0), "0.5,", ",")));
    assert!(steps(&one).unwrap().is_empty());
    assert_eq!(read(&one).unwrap().time, Some(0.5));
}

/// The column of times has many names. Some of them may mean something else: they count if ids repeat, or if equal
/// numbers of particles follow each other.
#[test]
fn the_column_of_times_has_many_names() {
    let folder = Folder::new("step-names");
    let body: String =
        (0..3).map(|i| rows(&cloud(i), &format!("{},", 0.25 * i as f32), ",")).collect();
    for name in [
        "Frame No.",
        "iteration",
        "snapshot",
        "timestamp",
        "sim_time",
        "FrameNumber",
        "Zeit (s)",
        "t",
    ] {
        let text = format!("{name},id,x,y,z,vx,vy,vz\n{body}");
        check(&folder.put("names.csv", text), &TIMES);
    }
    let of = |name: &str, values: [f32; 12]| {
        let row = |(i, value): (usize, &f32)| format!("{value},{},{},0\n", i % 4, i / 4);
        let body: String = values.iter().enumerate().map(row).collect();
        let path = folder.put("t.csv", format!("{name},x,y,z\n{body}"));
        (steps(&path).unwrap().len(), read(&path).map(|all| all.time).ok())
    };
    let blocks = |counts: [usize; 3], values: [f32; 3]| {
        let mut all = [0.0; 12];
        let repeated = counts.into_iter().zip(values).flat_map(|(n, value)| vec![value; n]);
        all.iter_mut().zip(repeated).for_each(|(a, b)| *a = b);
        all
    };
    let even = blocks([4, 4, 4], [0.0, 0.1, 0.2]);
    assert_eq!([of("t", even).0, of("it", even).0, of("time", even).0], [3; 3]);
    // Kinds of particles, and temperatures: one frame, whose time is unknown.
    for values in [
        blocks([6, 4, 2], [0.0, 0.1, 0.2]),
        blocks([4, 4, 4], [0.2, 0.1, 0.0]),
        blocks([6, 6, 0], [0.0, 1.0, 0.0]),
        [300.0; 12],
        std::array::from_fn(|i| 300.0 + i as f32),
    ] {
        assert_eq!(of("t", values), (0, Some(None)), "{values:?}");
    }
    assert_eq!(of("time", [300.0; 12]), (0, Some(Some(300.0))));
}

/// Where a solid body's particles were at first is called `X`.
#[test]
fn positions_in_small_letters_are_preferred() {
    let folder = Folder::new("reference");
    for head in ["X,Y,Z,x,y,z", "x,y,z,X,Y,Z", "Pos.X,Pos.Y,Pos.Z,pos.x,pos.y,pos.z"] {
        let row = if head.starts_with('x') { "4,5,6,1,2,3" } else { "1,2,3,4,5,6" };
        let found = read(&folder.put("a.csv", format!("{head}\n{row}\n"))).unwrap();
        assert_eq!(found.positions, [[4.0, 5.0, 6.0]], "{head}");
    }
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
    // An error names its line in the file.
    let text_of_bad = format!("{}what\n", named.strip_suffix("-2\n").unwrap());
    let line = text_of_bad.lines().count();
    let bad = folder.put("bad.xyz", text_of_bad);
    let found = steps(&bad).unwrap();
    let errors: Vec<_> = found.iter().filter_map(|s| read_step(&bad, *s, &[]).err()).collect();
    assert!(errors[0].to_string().contains(&format!("in line {line}")), "{line}: {}", errors[0]);
    // A frame that is cut off is listed, but reading it gives an error.
    let cut = folder.put("cut.xyz", &text[..text.len() - 30]);
    let found = steps(&cut).unwrap();
    assert_eq!(found.len(), 3);
    read_step(&cut, found[1], &[]).unwrap();
    read_step(&cut, found[2], &[]).unwrap_err();
}

/// A time in a comment is named; flags that are called `T` are none.
#[test]
fn times_in_comments_of_xyz() {
    let folder = Folder::new("xyz-times");
    let frame = |comment: &str| format!("2\n{comment}\nH 0 0 0\nH 1 0 0\n");
    let head = "Lattice=\"1 0 0 0 1 0 0 0 1\" pbc=\"T T T\" Properties=species:S:1:pos:R:3";
    let text: String = (0..3).map(|i| frame(&format!("{head} Time={}", 0.25 * i as f32))).collect();
    let found = steps(&folder.put("all.xyz", text)).unwrap();
    assert_eq!(found.iter().map(|step| step.time).collect::<Vec<_>>(), TIMES);
    let timed = format!("{head} Time=0.5");
    for (comment, expected) in [
        (timed.as_str(), Some(0.5)),
        ("pbc=\"T T T\" time = 0.5", Some(0.5)),
        ("t=0.5, step 7", Some(0.5)),
        ("step: 7 Time: 0.5 s", Some(0.5)),
        ("Time=\"0.5\"", Some(0.5)),
        ("time 0.5 s", Some(0.5)),
        ("pbc=\"T 0.5 T\"", None),
        ("T 0.5 F", None),
        ("name=\"at time=3\"", None),
        ("timestep=3", None),
    ] {
        let found = read(&folder.put("one.xyz", frame(comment))).unwrap();
        assert_eq!((found.time, found.positions.len()), (expected, 2), "{comment}");
    }
}

/// The steps of a text say where they are, so that no other frame is read for one of them.
#[test]
fn frames_of_text_are_read_at_their_places() {
    let folder = Folder::new("places");
    let all = |of: &dyn Fn(usize) -> String| -> String { (0..3).map(of).collect() };
    let rows = |i: usize| format!("{i} 0 0\n{i} 1 0\n");
    let dump = |i: usize| {
        let rows = rows(i);
        format!("ITEM: TIMESTEP\n{i}\nITEM: NUMBER OF ATOMS\n2\nITEM: ATOMS x y z\n{rows}")
    };
    let zone = |i: usize| format!("ZONE T=\"t = {i}\", I=2, F=POINT\n{}", rows(i));
    for (name, text, from, to) in [
        ("a.xyz", all(&|i| format!("2\nTime={i}\n{}", rows(i))), "2\n", "3\n"),
        ("a.dump", all(&dump), "ATOMS\n2\n", "ATOMS\n9\n"),
        ("a.dat", format!("VARIABLES = x y z\n{}", all(&zone)), "POINT", "BLOCK"),
    ] {
        let path = folder.put(name, &text);
        let found = steps(&path).unwrap();
        assert_eq!(found.len(), 3, "{name}");
        // The first frame is damaged.
        folder.put(name, text.replacen(from, to, 1));
        let read = read_step(&path, found[1], &[]).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(read.positions, [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0]], "{name}");
        assert_eq!(read.time, found[1].time, "{name}");
        // In a file of another length, the frame is searched for.
        folder.put(name, format!("\n{text}"));
        let read = read_step(&path, found[2], &[]).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(read.positions, [[2.0, 0.0, 0.0], [2.0, 1.0, 0.0]], "{name}");
    }
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

/// Zones are frames if they differ in time, or by their order. Zones with one time, or with
/// different names, are parts of one frame.
#[test]
fn zones_of_tecplot() {
    let folder = Folder::new("tecplot");
    let head = "TITLE = dam\nVARIABLES = id, x, y, z, vx, vy, vz\n";
    let frame = |record: &str, i: usize| format!("ZONE {record}\n{}", rows(&cloud(i), "", " "));
    let file = |record: &dyn Fn(usize) -> String| -> String {
        (0..3).fold(head.to_string(), |text, i| text + &frame(&record(i), i))
    };
    let text = file(&|i| {
        let count = samples::COUNT - i;
        format!("T=\"fluid\", I={count}\n STRANDID=1, SOLUTIONTIME = {}", 0.25 * i as f32)
    });
    check(&folder.put("a.dat", &text), &TIMES);
    check(&folder.put("a.tec.gz", gzip(text.as_bytes())), &TIMES);
    check(
        &folder.put("b.dat", text.replace("ZONE", "VARIABLES = id, x, y, z, vx, vy, vz\nZONE")),
        &TIMES,
    );
    check(&folder.put("c.dat", file(&|i| format!("T=\"t = {} s\"", 0.25 * i as f32))), &TIMES);
    check(&folder.put("d.dat", file(&|i| format!("T=\"step {i}\""))), &[None; 3]);
    let commas =
        |i: usize| frame(&format!("SOLUTIONTIME={}", 0.25 * i as f32), i).replace(' ', ",");
    let text: String = (0..3).map(commas).collect::<String>().replace("ZONE,", "ZONE ");
    check(&folder.put("e.csv", format!("{head}{text}")), &TIMES);
    // Zones of water and of walls are one frame.
    let both = |i: usize, time: &str| {
        frame(&format!("T=\"water\"{time}"), i) + &frame(&format!("T=\"walls\"{time}"), i + 1)
    };
    let walls = folder.put("walls.dat", format!("{head}{}", both(0, "")));
    assert!(steps(&walls).unwrap().is_empty());
    let all = read_with(&walls, &["zone"]).unwrap();
    assert_eq!(all.positions.len(), 2 * samples::COUNT - 1);
    assert_eq!(all.extras[0].values[samples::COUNT - 1..=samples::COUNT], [0.0, 1.0]);
    assert!(all.warnings[0].contains("water, walls"), "{:?}", all.warnings);
    let timed: String = (0..2).map(|i| both(i, &format!(", SOLUTIONTIME={i}"))).collect();
    let timed = folder.put("timed.dat", format!("{head}{timed}"));
    let found = steps(&timed).unwrap();
    assert_eq!(found.iter().map(|step| step.time).collect::<Vec<_>>(), [Some(0.0), Some(1.0)]);
    let second = read_step(&timed, found[1], &["zone"]).unwrap();
    assert_eq!(second.positions.len(), 2 * samples::COUNT - 3);
    assert_eq!(second.extras[0].values.iter().sum::<f64>(), (samples::COUNT - 2) as f64);
}

/// A frame of an array, in which all frames have the same number of particles.
fn even(frame: usize) -> Particles {
    let mut even = samples::cloud();
    even.positions.iter_mut().for_each(|p| p[0] += frame as f32);
    even
}

#[track_caller]
fn check_even(path: &Path, times: &[Option<f64>], velocities: bool) {
    let name = path.display();
    let all = steps(path).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(all.iter().map(|step| step.time).collect::<Vec<_>>(), times, "{name}");
    for (i, step) in all.iter().enumerate() {
        let (found, expected) = (read_step(path, *step, &[]).unwrap(), even(i));
        assert_eq!(found.positions, expected.positions, "{name}: {i}");
        assert_eq!(found.velocities, expected.velocities.filter(|_| velocities), "{name}: {i}");
    }
}

#[test]
fn arrays_of_frames() {
    let folder = Folder::new("npy-steps");
    let floats = |of: &dyn Fn(usize) -> Vec<[f32; 3]>| {
        let all: Vec<[f32; 3]> = (0..3).flat_map(of).collect();
        samples::floats(all.as_flattened(), 4, false)
    };
    let positions = floats(&|i| even(i).positions);
    let velocities = floats(&|i| even(i).velocities.unwrap());
    let count = samples::COUNT;
    let shape = format!("(3, {count}, 3)");
    check_even(
        &folder.put("a.npy", samples::npy("<f4", &shape, false, 1, &positions)),
        &[None; 3],
        false,
    );
    // Axes ordered as in `a.transpose(0, 2, 1)`, and Fortran order.
    let value = |t: usize, n: usize, c: usize| even(t).positions[n][c];
    let range = |n: usize| 0..n;
    let turned: Vec<f32> = range(3)
        .flat_map(|t| range(3).flat_map(move |c| range(count).map(move |n| value(t, n, c))))
        .collect();
    let turned = samples::floats(&turned, 4, false);
    let header = format!("(3, 3, {count})");
    check_even(
        &folder.put("b.npy", samples::npy("<f4", &header, false, 1, &turned)),
        &[None; 3],
        false,
    );
    let fortran: Vec<f32> = range(3)
        .flat_map(|c| range(count).flat_map(move |n| range(3).map(move |t| value(t, n, c))))
        .collect();
    let fortran = samples::floats(&fortran, 4, false);
    check_even(
        &folder.put("c.npy", samples::npy("<f4", &shape, true, 1, &fortran)),
        &[None; 3],
        false,
    );
    // With velocities and densities per frame, ids for all frames, and times.
    let ids: Vec<u8> = (0..count as u32).flat_map(u32::to_le_bytes).collect();
    let densities = samples::floats(&vec![1000.0; 3 * count], 4, false);
    let times = samples::floats(&[0.0, 0.25, 0.5], 8, false);
    let arrays = |name: &'static str| {
        [
            (name, samples::npy("<f4", &shape, false, 1, &positions)),
            ("vel", samples::npy("<f4", &shape, false, 1, &velocities)),
            ("ids", samples::npy("<u4", &format!("({count},)"), false, 1, &ids)),
            ("rho", samples::npy("<f4", &format!("(3, {count})"), false, 1, &densities)),
            ("t", samples::npy("<f8", "(3,)", false, 1, &times)),
        ]
    };
    for (name, packed) in [("positions", true), ("positions", false), ("frames_of_dam", false)] {
        // An array with an unknown name holds the positions if no other array can.
        let known = name == "positions";
        let all = arrays(name);
        let some = if known { &all[..] } else { &all[..1] };
        let path = folder.put(&format!("{name}-{packed}.npz"), samples::npz(some, packed));
        check_even(&path, if known { &TIMES } else { &[None; 3] }, known);
        let last = read_step(&path, steps(&path).unwrap()[2], &[]).unwrap();
        assert_eq!(last.ids.is_some() && last.densities.is_some(), known);
    }
    let axes = ["x", "y", "z"].map(|axis| {
        let c = "xyz".find(axis).unwrap();
        let all: Vec<f32> =
            range(3).flat_map(|t| range(count).map(move |n| value(t, n, c))).collect();
        let all = samples::floats(&all, 4, false);
        (axis, samples::npy("<f4", &format!("(3, {count})"), false, 1, &all))
    });
    check_even(&folder.put("axes.npz", samples::npz(&axes, true)), &[None; 3], false);
    // A single frame is no sequence.
    let one = samples::npy("<f4", &format!("(1, {count}, 3)"), false, 1, &positions[..12 * count]);
    assert!(steps(&folder.put("one.npy", one)).unwrap().is_empty());
    // If the file ends within the last frame, the other frames can be read.
    let cut = samples::npy("<f4", &shape, false, 1, &positions[..positions.len() - 12]);
    let cut = folder.put("cut.npy", cut);
    let all = steps(&cut).unwrap();
    read_step(&cut, all[1], &[]).unwrap();
    read_step(&cut, all[2], &[]).unwrap_err();
}

#[test]
fn json_of_frames() {
    let folder = Folder::new("json-steps");
    let list = |of: &[[f32; 3]]| format!("{of:?}");
    let positions = |i: usize| list(&cloud(i).positions);
    let columns = |i: usize, time: &str| {
        let of = cloud(i);
        let (p, v) = (list(&of.positions), list(of.velocities.as_ref().unwrap()));
        format!("{{{time}\"positions\": {p}, \"velocities\": {v}, \"id\": {:?}}}", of.ids.unwrap())
    };
    let objects = |i: usize| {
        let of = cloud(i);
        let row = |k: usize| {
            let (p, v, id) =
                (of.positions[k], of.velocities.as_ref().unwrap()[k], of.ids.as_ref().unwrap()[k]);
            format!("{{\"id\": {id}, \"pos\": {p:?}, \"vel\": {v:?}}}")
        };
        format!("[{}]", (0..of.positions.len()).map(row).collect::<Vec<_>>().join(", "))
    };
    let all = |of: &dyn Fn(usize) -> String, between: &str| {
        (0..3).map(of).collect::<Vec<_>>().join(between)
    };
    let timed = |i: usize| columns(i, &format!("\"time\": {}, ", 0.25 * i as f32));
    let list_of = all(&timed, ", ");
    check(&folder.put("a.json", format!("[{list_of}]")), &TIMES);
    check(&folder.put("b.json", format!("{{\"dt\": 0.1, \"frames\": [{list_of}]}}")), &TIMES);
    check(&folder.put("c.jsonl", all(&timed, "\n")), &TIMES);
    check(&folder.put("c.json.gz", gzip(all(&timed, "\n").as_bytes())), &TIMES);
    check(&folder.put("d.json", format!("[{}]", all(&objects, ", "))), &[None; 3]);
    let held =
        |i: usize| format!("{{\"time\": {}, \"particles\": {}}}", 0.25 * i as f32, objects(i));
    check(&folder.put("e.json", format!("[{}]", all(&held, ", "))), &TIMES);
    let named = |i: usize| format!("\"frame_{}\": {}", 8 + i, timed(i));
    check(&folder.put("f.json", format!("{{{}}}", all(&named, ", "))), &TIMES);
    // Arrays with an additional dimension for the frames.
    let even = |of: &dyn Fn(Particles) -> Vec<[f32; 3]>| all(&|i| list(&of(even(i))), ", ");
    let p = even(&|of| of.positions);
    let v = even(&|of| of.velocities.unwrap());
    let text =
        format!("{{\"positions\": [{p}], \"velocities\": [{v}], \"times\": [0, 0.25, 0.5]}}");
    check_even(&folder.put("g.json", text), &TIMES, true);
    check_even(&folder.put("h.json", format!("[{p}]")), &[None; 3], false);
    // One frame, however deep it is nested.
    for text in
        [format!("[{}]", positions(0)), format!("[{}]", columns(0, "")), columns(0, ""), objects(0)]
    {
        let path = folder.put("one.json", text);
        assert!(steps(&path).unwrap().is_empty(), "{}", std::fs::read_to_string(&path).unwrap());
        assert_eq!(read(&path).unwrap().positions, cloud(0).positions);
    }
}

/// Of a time and a step number, the time counts.
#[test]
fn times_of_json_beside_step_numbers() {
    let folder = Folder::new("json-times");
    let points = |i: usize| format!("[[{i}, 0, 0], [0, 1, 2], [1, 0, 2]]");
    let all = |of: &dyn Fn(usize) -> String| (0..3).map(of).collect::<Vec<_>>().join(", ");
    let frame = |i: usize| {
        let (step, time) = (100 * i, 0.25 * i as f32);
        format!("{{\"frame\": {step}, \"time\": {time}, \"positions\": {}}}", points(i))
    };
    let stacked = format!(
        "{{\"frame\": [0, 100, 200], \"time\": [0, 0.25, 0.5], \"positions\": [{}]}}",
        all(&points)
    );
    let lists = |i: usize| {
        let p = format!("{{\"x\": [{i}, 0, 1], \"y\": [0, 1, 0], \"z\": [0, 2, 2]}}");
        format!("{{\"step\": {i}, \"t\": {}, \"position\": {p}}}", 0.25 * i as f32)
    };
    for (i, text) in
        [format!("[{}]", all(&frame)), stacked, format!("[{}]", all(&lists))].iter().enumerate()
    {
        let path = folder.put(&format!("{i}.json"), text);
        let all = steps(&path).unwrap();
        assert_eq!(all.iter().map(|step| step.time).collect::<Vec<_>>(), TIMES, "{text}");
        for (k, step) in all.into_iter().enumerate() {
            let p = read_step(&path, step, &[]).unwrap();
            let positions = [[k as f32, 0.0, 0.0], [0.0, 1.0, 2.0], [1.0, 0.0, 2.0]];
            assert_eq!((p.positions, p.time), (positions.to_vec(), TIMES[k]), "{text}");
        }
    }
    let path = folder.put("one.json", "{\"step\": 400, \"time\": 0.5, \"positions\": [[0, 0, 0]]}");
    assert_eq!(read(&path).unwrap().time, Some(0.5));
}

/// Each frame of a list is read on its own; the contents of the other frames are not parsed.
#[test]
fn json_frames_are_read_alone() {
    let folder = Folder::new("json-parts");
    let frame = |i: usize| {
        format!(
            "{{\"note\": \"a ] \\\" {{\", \"positions\": [[{i}, NaN, 2], [0, 1, 2], [1, 0, 2]]}}"
        )
    };
    let all = |between: &str| (0..3).map(frame).collect::<Vec<_>>().join(between);
    let named = |i: usize| format!("\"t\\u0031_{}\": {}", 12 - i, frame(i));
    let named = (0..3).map(named).collect::<Vec<_>>().join(", ");
    let texts = [
        format!("[{}]", all(", ")),
        all("\n"),
        format!("\u{feff}{{\"dt\": 0.1, \"no\": [], \"frames\": [{}]}}", all(", ")),
        format!("{{{named}}}"),
    ];
    for (i, text) in texts.into_iter().enumerate() {
        let path = folder.put(&format!("{i}.json"), &text);
        let steps = steps(&path).unwrap();
        assert_eq!(steps.len(), 3, "{text}");
        // The names give another order than the file.
        let first = |k: usize| if i == 3 { 2 - k } else { k };
        for (k, step) in steps.iter().enumerate() {
            let alone = frame(first(k));
            let at = text.find(&alone).unwrap();
            let others = "#".repeat(at) + &alone + &"#".repeat(text.len() - at - alone.len());
            let of = |text: &str| {
                folder.put(&format!("{i}.json"), text);
                read_step(&path, *step, &[]).unwrap().positions[0][0]
            };
            assert_eq!(of(&text), first(k) as f32, "{text}");
            assert_eq!(of(&others), first(k) as f32, "{others}");
            read_step(&path, Step::new(k, step.time), &[]).unwrap_err();
        }
        // If the file is replaced in between, its new contents are read, and nothing panics.
        let path = folder.put(&format!("{i}.json"), format!("[[], {}]", frame(7)));
        let _ = read_step(&path, steps[1], &[]);
    }
}

/// In arrays with an additional dimension for the frames, each frame is read on its own.
#[test]
fn json_frames_of_arrays_are_read_alone() {
    let folder = Folder::new("json-stacked");
    let positions = |i: usize| format!("[[{i}, 1, NaN], [0, 1, 2], [1, 0, 2]]");
    let velocities = |i: usize| format!("[[0, {i}, 0], [0, 1, 2], [1, 0, 2]]");
    let all = |of: &dyn Fn(usize) -> String| (0..3).map(of).collect::<Vec<_>>().join(", ");
    let object = format!(
        "/* {{[ */ {{\"dt\": 0.1, // [\n \"t\": [0, 0.25, 0.5], \"pos\\u0069tions\": [{}], \"id\": [7, 8, 9], \"vel\": [{}]}}",
        all(&positions),
        all(&velocities)
    );
    for (i, text) in
        [object.clone(), format!("{{\"a\": 1, \"run\": {object}}}")].into_iter().enumerate()
    {
        let path = folder.put(&format!("{i}.json"), &text);
        let steps = steps(&path).unwrap();
        assert_eq!(steps.len(), 3, "{text}");
        for (k, step) in steps.iter().enumerate() {
            let mut alone = text.clone();
            for other in (0..3).filter(|other| *other != k) {
                for part in [positions(other), velocities(other)] {
                    alone = alone.replace(&part, &"#".repeat(part.len()));
                }
            }
            assert!(alone.contains('#'));
            for text in [&text, &alone] {
                folder.put(&format!("{i}.json"), text);
                let read = read_step(&path, *step, &[]).unwrap();
                assert_eq!(read.positions[0][0], k as f32, "{text}");
                assert_eq!(read.velocities.unwrap()[0][1], k as f32);
                assert_eq!((read.ids, read.time), (Some(vec![7, 8, 9]), Some(0.25 * k as f64)));
                assert_eq!(read.attributes.len(), 3, "{:?}", read.attributes);
            }
            read_step(&path, Step::new(k, step.time), &[]).unwrap_err();
        }
    }
}

/// In a table of trajectories, one particle after the other, the times give the frames.
#[test]
fn trajectories_below_each_other_are_frames() {
    let folder = Folder::new("trajectories");
    for names in ["time,x,y,z", "particle,time,x,y,z"] {
        let row = |i: usize, k: usize| {
            let id = if names.starts_with('p') { format!("{i},") } else { String::new() };
            format!("{id}{},{},{i},0\n", 0.5 * k as f32, k)
        };
        let rows: String = (0..5).flat_map(|i| (0..3).map(move |k| row(i, k))).collect();
        let path = folder.put("t.csv", format!("{names}\n{rows}"));
        let all = steps(&path).unwrap();
        assert_eq!(all.iter().map(|step| step.time).collect::<Vec<_>>(), [0.0, 0.5, 1.0].map(Some));
        for (k, step) in all.into_iter().enumerate() {
            let expected: Vec<_> = (0..5).map(|i| [k as f32, i as f32, 0.0]).collect();
            assert_eq!(read_step(&path, step, &[]).unwrap().positions, expected, "{names}");
        }
    }
}

/// Phases in separate files, and a PVD with several ranks at one time.
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
    // Ids that occur in both files do not identify particles and are dropped. Velocities that only
    // one file has are dropped too.
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

/// Blocks of rows in one text, each with this before it, under a line of names.
fn blocks(names: &str, between: impl Fn(usize) -> String, separator: &str) -> String {
    let names = names.replace(' ', separator);
    let of = |i: usize| between(i) + &rows(&cloud(i), "", separator);
    (0..3).fold(names, |text, i| text + &of(i))
}

/// Without a column of times, lines with a time or the names again separate frames.
#[test]
fn times_between_blocks_of_rows_are_frames() {
    let folder = Folder::new("step-blocks");
    let time = |i: usize| 0.25 * i as f32;
    let names = "id x y z vx vy vz\n";
    for (name, separator) in [("a.txt", " "), ("a.dat", "\t"), ("a.csv", ","), ("a.csv", ";")] {
        let check = |text: &str, times: &[Option<f64>]| {
            check(&folder.put(name, text), times);
            check(&folder.put(&format!("{name}.gz"), gzip(text.as_bytes())), times);
            // Without a frame number the file is refused.
            let error = read(&folder.put(name, text)).unwrap_err().to_string();
            assert!(error.contains("several frames"), "{error}");
        };
        check(&blocks(names, |i| format!("# time = {}\n", time(i)), separator), &TIMES);
        check(&blocks(names, |i| format!("\n\n# t={}\n", time(i)), separator), &TIMES);
        check(&blocks(names, |i| format!("Time: {}\n", time(i)), separator), &TIMES);
        check(&blocks(names, |i| format!("timestep{separator}{i}\n"), separator), &[None; 3]);
        let step =
            |i: usize| format!("# step {}, {} particles, time [s] = {}\n", 100 * i, 9, time(i));
        check(&blocks(names, step, separator), &TIMES);
        check(&blocks(names, |i| format!("# Step {i}\n"), separator), &[None; 3]);
        // The time is below its block.
        let behind =
            |i: usize| if i > 0 { format!("# t = {}\n", time(i - 1)) } else { String::new() };
        check(&(blocks(names, behind, separator) + "# t = 0.5\n"), &TIMES);
        // The names are there again, also with the time.
        let again = names.replace(' ', separator);
        check(&blocks("", |_| again.clone(), separator), &[None; 3]);
        check(&blocks("", |_| format!("\n# {again}"), separator), &[None; 3]);
        check(&blocks("", |i| format!("# time {}\n{again}", time(i)), separator), &TIMES);
    }
    // Parts of one frame have one time.
    let parts = |i: usize| format!("# time = 0.5\n# part {i}\n");
    let path = folder.put("parts.txt", blocks(names, parts, " "));
    assert!(steps(&path).unwrap().is_empty());
    assert_eq!(read(&path).unwrap().positions.len(), 3 * samples::COUNT - 3);
    // A step that is named by its index alone.
    let path = folder.put("a.txt", blocks(names, |i| format!("# t = {i}\n"), " "));
    let found = read_step(&path, Step::new(2, None), &[]).unwrap();
    assert_eq!((found.positions, found.time), (cloud(2).positions, Some(2.0)));
}

/// A lattice of n³ particles, moved along x, in rows of text.
fn lattice(n: usize, moved: f32, separator: &str) -> String {
    let row = |i: usize| {
        let [x, y, z] = [i % n, i / n % n, i / n / n].map(|c| c as f32);
        [x + moved, y, z].map(|c| c.to_string()).join(separator) + "\n"
    };
    (0..n * n * n).map(row).collect()
}

/// Blank lines between blocks of rows separate frames if that is convincing. Else it is told that they may.
#[test]
fn blank_lines_between_blocks_may_be_frames() {
    let folder = Folder::new("step-blanks");
    for (name, separator) in [("a.xyz", " "), ("a.txt", "\t"), ("a.dat", " "), ("a.csv", ",")] {
        for (between, head) in [
            ("\n\n", ""),
            ("\n\n", "x y z\n"),
            ("\n", "# x y z\n"),
            ("\n", ""),
            ("# ------\n", "x y z\n"),
            ("\n\n\n# block\n", ""),
        ] {
            let all: Vec<String> = (0..3).map(|i| lattice(3, 0.1 * i as f32, separator)).collect();
            let text = head.replace(' ', separator) + &all.join(between) + "\n\n";
            let path = folder.put(name, &text);
            let found = steps(&path).unwrap();
            assert_eq!(found.len(), 3, "{name} {between:?} {head:?}");
            for (i, step) in found.iter().enumerate() {
                let frame = read_step(&path, *step, &[]).unwrap();
                assert_eq!(frame.positions.len(), 27, "{name} {between:?} {head:?}");
                assert_eq!(frame.positions[0], [0.1 * i as f32, 0.0, 0.0]);
                assert!(
                    frame.warnings[0].contains("delete the lines between"),
                    "{:?}",
                    frame.warnings
                );
            }
            let error = read(&path).unwrap_err().to_string();
            assert!(error.contains("several frames") && error.contains("delete"), "{error}");
        }
    }
    let of = |text: &str| {
        let path = folder.put("one.txt", text);
        assert!(steps(&path).unwrap().is_empty(), "{text}");
        let all = read(&path).unwrap_or_else(|e| panic!("{e}\n{text}"));
        all.warnings.iter().any(|warning| warning.contains("are taken as one frame"))
    };
    // Grids: lines and planes between blank lines. Rings might also be one that grows.
    let row = |i: usize, j: usize| format!("{} {} {}\n", i, j, (i * j) % 3);
    let lines: String =
        (0..9).map(|i| (0..9).map(|j| row(i, j)).collect::<String>() + "\n").collect();
    assert!(!of(&lines));
    let plane =
        |z: usize| (0..81).map(|i| format!("{} {} {z}\n", i % 9, i / 9)).collect::<String>();
    assert!(!of(&(0..4).map(|z| plane(z) + "\n").collect::<String>()));
    let ring = |r: usize| {
        let at = |i: usize| (i as f32 / 16.0 * 6.3).sin_cos();
        let point = |i: usize| format!("{} {} 0\n", at(i).0 * r as f32, at(i).1 * r as f32);
        (0..16).map(point).collect::<String>()
    };
    assert!(of(&(5..9).map(|r| ring(r) + "\n").collect::<String>()));
    // Blocks that differ, and those of bodies.
    let body = |n: usize| lattice(n, 0.0, " ");
    assert!(of(&format!("{}\n{}", body(4), body(3))));
    assert!(of(&format!("{}\n\n{}", body(4), body(2))));
    assert!(of(&format!("{}\n\n# walls\n{}", body(3), body(3))));
    assert!(of(&format!("{}# walls\n{}", body(3), body(3))));
    assert!(of(&format!("{}\n{}", body(3), lattice(3, 5.0, " "))));
    // Too few rows for steps: three between two blank lines, and eight between single ones.
    let first =
        |count: usize| lattice(2, 0.0, " ").split_inclusive('\n').take(count).collect::<String>();
    assert!(of(&format!("{}\n\n{}", first(2), first(2))));
    assert!(of(&format!("{}\n{}", first(7), first(7))));
    // Blank lines above, below and behind single rows mean nothing.
    assert!(!of(&format!("\n\nx y z\n\n{}\n{}\n\n\n# end\n", body(1), body(3))));
    // And so do those in quoted fields.
    let named =
        |offset: f32, text: &str| lattice(3, offset, ",").replace('\n', &format!(",{text}\n"));
    let text = named(0.0, "a") + &named(0.1, "\"b\n\n\n\"");
    let path = folder.put("quoted.csv", format!("x,y,z,name\n{text}"));
    let all = read(&path).unwrap();
    assert_eq!((all.positions.len(), all.warnings), (54, vec![]));
    assert!(steps(&path).unwrap().is_empty());
}

/// Ids that are all there several times are probably those of several steps.
#[test]
fn steps_without_a_time_are_told_by_their_ids() {
    let row = |i: usize| format!("{},{},{},0\n", i % 20, i % 20, i / 20);
    let table = |rows: std::ops::Range<usize>| {
        "id,x,y,z\n".to_string() + &rows.map(row).collect::<String>()
    };
    let folder = Folder::new("step-ids");
    let told = |rows| read(&folder.put("ids.csv", table(rows))).unwrap().warnings.join("; ");
    assert!(
        told(0..60).contains("each occurs 3 times: if these are 3 time steps"),
        "{}",
        told(0..60)
    );
    // Some ids are there more often than others.
    let some = told(0..50);
    assert!(some.contains("does not identify them") && !some.contains("time steps"), "{some}");
    assert!(told(0..20).is_empty());
}
