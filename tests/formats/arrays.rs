//! NumPy and JSON arrays in the shapes that users save.

use super::folder::Folder;
use super::samples::{self, floats, npz};
use whitewater::io::particles::{
    AttributeType, Extension, Format, Particles, Parts, ReadError, read_bytes, steps,
};

fn npy(descr: &str, shape: &str, fortran: bool, raw: &[u8]) -> Vec<u8> {
    samples::npy(descr, shape, fortran, 1, raw)
}

fn read(name: &str, bytes: &[u8], hint: Extension) -> Particles {
    let whole = read_bytes(bytes, hint).unwrap_or_else(|e| panic!("{name}: {e}"));
    // Reading in parts gives the same positions and warnings.
    for most in [1, 3, 100] {
        let parts = Parts::of_bytes(bytes, hint, most).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(parts.about().warnings, whole.warnings, "{name}");
        let positions: Vec<_> = parts.flat_map(|part| part.unwrap().positions).collect();
        assert_eq!(positions, whole.positions, "{name}");
    }
    whole
}

fn error(bytes: &[u8], hint: Extension, parts: &[&str]) {
    let error = match read_bytes(bytes, hint) {
        Ok(p) => panic!("{} particles read", p.positions.len()),
        Err(error) => error.to_string(),
    };
    assert!(!error.contains("damaged"), "{error}");
    for part in parts {
        assert!(error.contains(part), "`{part}` is not in: {error}");
    }
}

/// The values of a list of vectors, component by component.
fn columns(v: &[[f32; 3]]) -> Vec<f32> {
    (0..3).flat_map(|c| v.iter().map(move |v| v[c])).collect()
}

/// Rows of `f4` values: position, velocity and then zeros, cut to this number of columns.
fn rows(columns: usize) -> Vec<u8> {
    let cloud = samples::cloud();
    let row = |(p, v): (&[f32; 3], &[f32; 3])| {
        let mut row = [p.to_vec(), v.to_vec(), vec![0.0; columns]].concat();
        row.truncate(columns);
        row
    };
    let velocities = cloud.velocities.unwrap();
    let all: Vec<f32> = cloud.positions.iter().zip(&velocities).flat_map(row).collect();
    floats(&all, 4, false)
}

#[test]
fn arrays_of_other_shapes() {
    let cloud = samples::cloud();
    let plain = floats(cloud.positions.as_flattened(), 4, false);
    let turned = floats(&columns(&cloud.positions), 4, false);
    for (name, shape, fortran, raw) in [
        ("rows", "(11, 3)", false, &plain),
        ("columns of Fortran", "(11, 3)", true, &turned),
        ("columns", "(3, 11)", false, &turned),
        ("columns of Fortran, turned", "(3, 11)", true, &plain),
        ("one frame", "(1, 11, 3)", false, &plain),
        ("an axis more", "(11, 3, 1)", false, &plain),
        ("an axis among them", "(11, 1, 3)", false, &plain),
    ] {
        let array = npy("<f4", shape, fortran, raw);
        let p = read(name, &array, Extension::Npy);
        assert_eq!((p.positions, p.warnings.len()), (cloud.positions.clone(), 0), "{name}");
        let p = read(name, &npz(&[("pos", array)], true), Extension::Npz);
        assert_eq!((p.positions, p.warnings.len()), (cloud.positions.clone(), 0), "{name}");
    }
}

#[test]
fn arrays_of_more_columns_or_fewer() {
    let cloud = samples::cloud();
    for (columns, velocities, told) in
        [(4, false, "not read"), (6, true, "velocities"), (7, false, "not read")]
    {
        let p = read(
            "more",
            &npy("<f4", &format!("(11, {columns})"), false, &rows(columns)),
            Extension::Npy,
        );
        assert_eq!(p.positions, cloud.positions);
        assert_eq!(p.velocities, cloud.velocities.clone().filter(|_| velocities), "{columns}");
        assert!(p.warnings.len() == 1 && p.warnings[0].contains(told), "{:?}", p.warnings);
    }
    let p = read("two", &npy("<f4", "(11, 2)", false, &rows(2)), Extension::Npy);
    assert_eq!(p.positions[3], [cloud.positions[3][0], cloud.positions[3][1], 0.0]);
    assert!(p.warnings[0].contains("two components"), "{:?}", p.warnings);
    let two = [
        ("position", npy("<f4", "(11, 2)", false, &rows(2))),
        ("velocity", npy("<f4", "(11, 2)", false, &rows(2))),
    ];
    let p = read("two", &npz(&two, false), Extension::Npz);
    assert_eq!(p.velocities.unwrap()[5][2], 0.0);
    let array = |columns: usize| npy("<f4", &format!("(11, {columns})"), false, &rows(columns));
    let p = read("vel", &npz(&[("pos", array(3)), ("vel", array(4))], false), Extension::Npz);
    assert_eq!(p.velocities, Some(cloud.positions));
    let told = "array `vel` has 4 columns: the first 3 are taken as velocities";
    assert!(p.warnings.len() == 1 && p.warnings[0].contains(told), "{:?}", p.warnings);
}

#[test]
fn arrays_of_frames_are_refused_in_their_words() {
    let raw = vec![0; 4 * 6 * 5 * 3];
    let frames = npy("<f4", "(6, 5, 3)", false, &raw);
    let words = ["(6, 5, 3)", "6 frames of 5 particles", "enumerate"];
    error(&frames, Extension::Npy, &words);
    error(&npz(&[("positions", frames)], true), Extension::Npz, &words);
    error(&npy("<f4", "(90,)", false, &raw), Extension::Npy, &["(90,)", "reshape(-1, 3)"]);
    error(&npy("<f4", "()", false, &raw[..4]), Extension::Npy, &["reshape(-1, 3)"]);
    error(&npy("|O", "(30, 3)", false, &raw), Extension::Npy, &["Python objects", "np.savez"]);
    error(&npy("<c8", "(30, 3)", false, &raw), Extension::Npy, &["<c8", "astype"]);
    let frames = npy("[('x', '<f4'), ('y', '<f4'), ('z', '<f4')]", "(6, 5)", false, &raw);
    error(&frames, Extension::Npy, &["6 frames of 5"]);
}

/// As repeated calls of np.save with an open file write it.
#[test]
fn arrays_after_the_first_are_told() {
    let raw = floats(samples::cloud().positions.as_flattened(), 4, false);
    let turned = npy("<f4", "(11, 3)", true, &raw);
    let one = npy("<f4", "(11, 3)", false, &raw);
    let folder = Folder::new("arrays");
    for (name, first) in [("rows", &one), ("columns of Fortran", &turned)] {
        read(name, first, Extension::Npy);
        let two = [first.as_slice(), &one].concat();
        let words =
            ["several arrays", "(11, 3)", &format!("{} bytes follow", one.len()), "np.save"];
        for bytes in [two.clone(), samples::gzip(&two)] {
            error(&bytes, Extension::Npy, &words);
            let parts = Parts::of_bytes(&bytes, Extension::Npy, 4).map(|_| ()).unwrap_err();
            assert!(parts.to_string().contains("several arrays"), "{name}: {parts}");
        }
        assert!(steps(&folder.put("two.npy", two)).is_err(), "{name}");
        let more = [first.as_slice(), b"more"].concat();
        let told = read_bytes(&more, Extension::Npy).unwrap_err();
        assert!(told.to_string().contains("found 4 more bytes"), "{name}: {told}");
        assert!(matches!(told, ReadError::Malformed { .. }), "{name}: {told}");
    }
    // The frames of one array are no arrays of their own.
    let frames = npy("<f4", "(2, 11, 3)", false, &[raw.as_slice(), &raw].concat());
    assert_eq!(steps(&folder.put("frames.npy", frames)).unwrap().len(), 2);
}

/// Arrays whose first dimension counts particles instead of frames.
#[test]
fn frames_in_another_order_are_told() {
    let folder = Folder::new("order");
    for (shape, words) in [
        ("(600, 4, 3)", ["600 frames of 4 particles", "np.swapaxes(a, 0, 1)"]),
        ("(600, 3, 9)", ["600 frames of 9 particles", "np.moveaxis(a, -1, 0)"]),
    ] {
        let array = npy("<f4", shape, false, &vec![0; 4 * 600 * 27]);
        let array =
            array[..array.len() - if shape.ends_with("9)") { 0 } else { 4 * 600 * 15 }].to_vec();
        let zip = npz(&[("positions", array.clone())], true);
        for (name, bytes) in [("a.npy", array), ("a.npz", zip)] {
            error(&bytes, Extension::Unknown, &[shape, words[0], words[1]]);
            let told = steps(&folder.put(name, bytes)).unwrap_err().to_string();
            assert!(told.contains(words[1]), "{told}");
        }
    }
    let frames = npy("<f4", "(600, 61, 3)", false, &vec![0; 4 * 600 * 183]);
    assert_eq!(steps(&folder.put("frames.npy", frames)).unwrap().len(), 600);
}

#[test]
fn the_time_of_a_zip_of_arrays() {
    let raw = floats(samples::cloud().positions.as_flattened(), 4, false);
    let positions = npy("<f4", "(11, 3)", false, &raw);
    for shape in ["()", "(1,)", "(1, 1)"] {
        for (name, time, expected) in
            [("time", 0.03, Some(0.03)), ("dt", 0.03, None), ("time", f64::NAN, None)]
        {
            let time = npy("<f8", shape, false, &time.to_le_bytes());
            for deflate in [false, true] {
                let zip = npz(&[("position", positions.clone()), (name, time.clone())], deflate);
                let p = read("time", &zip, Extension::Npz);
                assert_eq!(p.time, expected, "{name} {shape}");
                assert!(p.warnings.is_empty(), "{:?}", p.warnings);
                let mut parts = Parts::of_bytes(&zip, Extension::Npz, 4).unwrap();
                assert_eq!(parts.about().time, expected, "{name} {shape}");
                assert_eq!(parts.next().unwrap().unwrap().time, expected, "{name} {shape}");
            }
        }
    }
}

/// A step number is no time, whichever comes first.
#[test]
fn the_time_of_a_zip_is_not_its_step() {
    let raw = floats(samples::cloud().positions.as_flattened(), 4, false);
    let doubles = |values: &[f64]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<_>>();
    let position = ("position", npy("<f4", "(11, 3)", false, &raw));
    let step = ("step", npy("<i8", "()", false, &400_i64.to_le_bytes()));
    let frames = ("pos", npy("<f4", "(3, 11, 3)", false, &raw.repeat(3)));
    let numbers = ("step", npy("<f8", "(3,)", false, &doubles(&[0.0, 100.0, 200.0])));
    let folder = Folder::new("times-of-zips");
    for name in ["time", "t", "simTime"] {
        let time = (name, npy("<f8", "()", false, &0.04_f64.to_le_bytes()));
        let times = (name, npy("<f8", "(3,)", false, &doubles(&[0.0, 0.25, 0.5])));
        for turned in [false, true] {
            let order = |mut last: Vec<(&'static str, Vec<u8>)>| {
                if turned {
                    last.reverse();
                }
                npz(&last, true)
            };
            let one = order(vec![position.clone(), step.clone(), time.clone()]);
            assert_eq!(read("time", &one, Extension::Npz).time, Some(0.04), "{name} {turned}");
            let several = order(vec![frames.clone(), times.clone(), numbers.clone()]);
            let all = steps(&folder.put("t.npz", several)).unwrap();
            let found: Vec<_> = all.iter().map(|step| step.time).collect();
            assert_eq!(found, [0.0, 0.25, 0.5].map(Some), "{name} {turned}");
        }
    }
}

/// `p` may be a momentum beside the positions `x`, `y`, `z`.
#[test]
fn coordinates_precede_a_vague_array() {
    let cloud = samples::cloud();
    let all = columns(&cloud.positions);
    let axis = |k: usize| npy("<f4", "(11,)", false, &floats(&all[11 * k..][..11], 4, false));
    let other = floats(cloud.velocities.unwrap().as_flattened(), 4, false);
    let other = npy("<f4", "(11, 3)", false, &other);
    for name in ["p", "r"] {
        let arrays = [("x", axis(0)), ("y", axis(1)), ("z", axis(2)), (name, other.clone())];
        let p = read(name, &npz(&arrays, true), Extension::Npz);
        assert_eq!((p.positions, p.velocities), (cloud.positions.clone(), None), "{name}");
    }
}

/// Kinds and ids of words are left out; what the picture needs is not.
#[test]
fn arrays_of_words_are_left_out() {
    let cloud = samples::cloud();
    let positions = npy("<f4", "(11, 3)", false, &floats(cloud.positions.as_flattened(), 4, false));
    let words = npy("<U1", "(11,)", false, &[0; 44]);
    let objects = npy("|O", "(11,)", false, &[0; 44]);
    for deflate in [false, true] {
        for name in ["type", "label"] {
            let arrays = [("pos", positions.clone()), (name, words.clone())];
            let p = read(name, &npz(&arrays, deflate), Extension::Npz);
            assert_eq!((&p.positions, p.kinds, p.ids), (&cloud.positions, None, None), "{name}");
            let told = format!("array `{name}` is not read: it holds text (dtype <U1)");
            assert_eq!(p.warnings, [told]);
            assert_eq!(p.attributes[1].ty, AttributeType::Text);
        }
        let arrays = [("pos", positions.clone()), ("type", objects.clone())];
        let p = read("objects", &npz(&arrays, deflate), Extension::Npz);
        assert!(p.warnings[0].contains("it holds Python objects"), "{:?}", p.warnings);
    }
    let arrays = [("pos", positions), ("rho", words)];
    error(&npz(&arrays, false), Extension::Npz, &["array `rho` of dtype <U1"]);
}

/// PySPH pickles dicts into its NPZ files.
#[test]
fn objects_of_python_are_named() {
    let object = npy("|O", "()", false, &[0; 50]);
    let arrays = [("version", npy("<i8", "()", false, &[0; 8])), ("particles", object.clone())];
    let parts = ["Python objects (in `particles`; perhaps of PySPH)", "np.savez", "HDF5"];
    error(&npz(&arrays, true), Extension::Npz, &parts);
    // Beside positions they are no matter.
    let raw = floats(samples::cloud().positions.as_flattened(), 4, false);
    let arrays = [("pos", npy("<f4", "(11, 3)", false, &raw)), ("particles", object)];
    let p = read("beside", &npz(&arrays, true), Extension::Npz);
    assert!(p.positions.len() == 11 && p.warnings.is_empty(), "{:?}", p.warnings);
}

/// Fields with the names of keys of the header.
#[test]
fn fields_called_as_the_keys() {
    let cloud = samples::cloud();
    let row = |p: &[f32; 3]| [floats(p, 4, false), vec![7; 4]].concat();
    let raw: Vec<u8> = cloud.positions.iter().flat_map(row).collect();
    for name in ["shape", "fortran_order", "descr"] {
        let descr = format!("[('x', '<f4'), ('y', '<f4'), ('z', '<f4'), ('{name}', '<i4')]");
        let p = read(name, &npy(&descr, "(11,)", false, &raw), Extension::Npy);
        assert_eq!((&p.positions, p.warnings.len()), (&cloud.positions, 0), "{name}");
    }
}

/// From 2^24 on, 32-bit floats do not tell ids apart.
#[test]
fn ids_that_floats_do_not_hold_are_dropped() {
    let raw = floats(samples::cloud().positions.as_flattened(), 4, false);
    let positions = npy("<f4", "(11, 3)", false, &raw);
    for (first, descr, size, kept) in [
        (16_777_205_u32, "<f4", 4, true),
        (16_777_206, "<f4", 4, false),
        (33_554_432, "<f4", 4, false),
        (16_777_206, "<f8", 8, true),
    ] {
        let doubles: Vec<f64> = (first..first + 11).map(f64::from).collect();
        let raw: Vec<u8> = match size {
            4 => doubles.iter().flat_map(|id| (*id as f32).to_le_bytes()).collect(),
            _ => doubles.iter().flat_map(|id| id.to_le_bytes()).collect(),
        };
        let arrays = [("pos", positions.clone()), ("id", npy(descr, "(11,)", false, &raw))];
        let p = read("ids", &npz(&arrays, false), Extension::Npz);
        let expected = kept.then(|| (first..first + 11).collect::<Vec<_>>());
        assert_eq!(p.ids, expected, "{first} {descr}");
        let told = p.warnings.iter().any(|w| w.contains("not exact from 16777216 on"));
        assert_eq!(told, !kept, "{first} {descr}: {:?}", p.warnings);
    }
}

/// Structured arrays with fields of fields.
#[test]
fn fields_of_fields() {
    let cloud = samples::cloud();
    let (v, ids) = (cloud.velocities.clone().unwrap(), cloud.ids.clone().unwrap());
    let row = |i: usize| {
        let mut row = samples::ints(&ids[i..=i], 4, false);
        row.extend(floats(&cloud.positions[i], 8, false));
        row.extend([7; 10]);
        row.extend(floats(&v[i], 4, false));
        row
    };
    let raw: Vec<u8> = (0..11).flat_map(row).collect();
    let descr = "[('id', '<i4'), ('pos', [('x', '<f8'), ('y', '<f8'), ('z', '<f8')]), \
                 ('tags', [('a', '<i2'), ('b', '|S3')], (2,)), ('state', [('vel', '<f4', (3,))])]";
    let p = read("nested", &npy(descr, "(11,)", false, &raw), Extension::Npy);
    assert_eq!((&p.positions, &p.ids), (&cloud.positions, &cloud.ids));
    let listed: Vec<_> = p.attributes.iter().map(|a| a.name.as_str()).collect();
    assert_eq!(listed, ["id", "pos.x", "pos.y", "pos.z", "tags", "state.vel"]);
    let deep = "[('x', ".repeat(100_000);
    let _ = read_bytes(&npy(&deep, "(11,)", false, &raw), Extension::Npy).unwrap_err();
}

#[test]
fn structured_arrays() {
    let cloud = samples::cloud();
    let (v, ids) = (cloud.velocities.clone().unwrap(), cloud.ids.clone().unwrap());
    for big in [false, true] {
        let order = if big { '>' } else { '<' };
        let row = |i: usize| {
            let mut row = floats(&cloud.positions[i], 4, big);
            row.extend([9; 9]);
            row.extend(floats(&v[i], 8, big));
            row.extend(samples::ints(&ids[i..=i], 4, big));
            row
        };
        let raw: Vec<u8> = (0..11).flat_map(row).collect();
        let descr = format!(
            "[('pos', '{order}f4', (3,)), ('', '|V4'), ('tag', '|S5'), (('long name', 'vel'), '{order}f8', (3,)), ('id', '{order}i4')]"
        );
        let array = npy(&descr, "(11,)", false, &raw);
        for (bytes, format) in [
            (array.clone(), Format::Npy),
            (
                npz(
                    &[("particles", array.clone()), ("box", npy("<f4", "(3,)", false, &[0; 12]))],
                    true,
                ),
                Format::Npz,
            ),
        ] {
            let p = read("structured", &bytes, Extension::Unknown);
            assert_eq!((p.format, &p.positions), (format, &cloud.positions));
            assert_eq!((p.velocities, p.ids), (cloud.velocities.clone(), cloud.ids.clone()));
            assert!(p.warnings.is_empty() && p.attributes.iter().any(|a| a.name == "tag"));
        }
    }
    let scalars = npy(
        "[('x', '<f4'), ('y', '<f4'), ('z', '<f4')]",
        "(11,)",
        false,
        &floats(cloud.positions.as_flattened(), 4, false),
    );
    assert_eq!(read("scalars", &scalars, Extension::Npy).positions, cloud.positions);
    for descr in ["[('x'", "[('x', '<f4'", "[]", "[('x', [('y', '<f4')])]", "[(", "['x']"] {
        let _ = read_bytes(&npy(descr, "(11,)", false, &[0; 132]), Extension::Npy).unwrap_err();
    }
}

/// Arrays with a dimension of 0 hold no particles, or are an error. Fuzzing found that rows of no
/// elements panicked.
#[test]
fn arrays_without_elements() {
    let table = "[('pos', '<f4', (3,)), ('rho', '<f4')]";
    for shape in ["(0,)", "(0, 3)", "(5, 0)", "(0, 0)", "(1, 0)", "(5, 0, 3)", "(0, 5, 3)"] {
        for (descr, fortran) in [(table, false), (table, true), ("<f4", false), ("<f4", true)] {
            for raw in [&[][..], &[0; 256]] {
                let read = read_bytes(&npy(descr, shape, fortran, raw), Extension::Npy);
                let count = read.map_or(0, |read| read.positions.len());
                assert_eq!(count, 0, "{descr} {shape} {fortran}");
            }
        }
    }
    let rows_of_none = npy(table, "(5, 0)", false, &[0; 256]);
    error(&rows_of_none, Extension::Npy, &["(5, 0)", "5 frames of 0 particles"]);
}

#[test]
fn half_precision() {
    let cloud = samples::cloud();
    for big in [false, true] {
        let bytes = |v: &f32| {
            let half = half::f16::from_f32(*v);
            if big { half.to_be_bytes() } else { half.to_le_bytes() }
        };
        let raw: Vec<u8> = cloud.positions.as_flattened().iter().flat_map(bytes).collect();
        let descr = if big { ">f2" } else { "<f2" };
        let p = read("half", &npy(descr, "(11, 3)", false, &raw), Extension::Npy);
        assert_eq!(p.positions, cloud.positions, "all of them have eight digits or fewer");
    }
}

#[test]
fn the_only_array_is_the_positions() {
    let cloud = samples::cloud();
    let array = |v: &[[f32; 3]]| npy("<f4", "(11, 3)", false, &floats(v.as_flattened(), 4, false));
    let positions = array(&cloud.positions);
    let other = array(cloud.velocities.as_ref().unwrap());
    let scalar = npy("<f4", "(11,)", false, &floats(cloud.densities.as_ref().unwrap(), 4, false));
    for (arrays, told) in [
        (vec![("arr_0", positions.clone())], "`arr_0` is taken"),
        (vec![("data", positions.clone()), ("rho", scalar.clone())], "`data` is taken"),
        (vec![("arr_1", other.clone()), ("arr_0", positions.clone())], "1 others"),
    ] {
        let p = read(told, &npz(&arrays, true), Extension::Npz);
        assert_eq!(p.positions, cloud.positions);
        assert!(p.warnings.len() == 1 && p.warnings[0].contains(told), "{:?}", p.warnings);
    }
    error(
        &npz(&[("a", positions.clone()), ("b", other.clone())], true),
        Extension::Npz,
        &["expected positions", "a: 3 x f32, b: 3 x f32"],
    );
    let p = read(
        "pairs",
        &npz(&[("x_p", positions), ("v_p", other.clone()), ("arr_0", other)], true),
        Extension::Npz,
    );
    assert_eq!((&p.positions, &p.velocities), (&cloud.positions, &cloud.velocities));
}

#[test]
fn shapes_of_json() {
    let cloud = samples::cloud();
    let velocities = cloud.velocities.clone().unwrap();
    let ids = cloud.ids.clone().unwrap();
    let vector = |v: &[f32; 3]| format!("[{},{},{}]", v[0], v[1], v[2]);
    let join = |list: Vec<String>, with: &str| list.join(with);
    let all = |f: &dyn Fn(usize) -> String, with: &str| join((0..11).map(f).collect(), with);
    let object = |i: usize| {
        format!(
            "{{\"position\":{},\"velocity\":{},\"id\":{},\"name\":\"a\"}}",
            vector(&cloud.positions[i]),
            vector(&velocities[i]),
            ids[i]
        )
    };
    let scalars = |i: usize| {
        let ([x, y, z], [u, v, w]) = (cloud.positions[i], velocities[i]);
        format!(
            "{{\"x\":{x},\"y\":{y},\"z\":{z},\"vx\":{u},\"vy\":{v},\"vz\":{w},\"id\":{}}}",
            ids[i]
        )
    };
    let position = |i: usize| vector(&cloud.positions[i]);
    let flat =
        |v: &[[f32; 3]]| v.as_flattened().iter().map(f32::to_string).collect::<Vec<_>>().join(",");
    for (name, text, full) in [
        ("records", format!("[{}]", all(&object, ",")), true),
        ("records of pandas", format!("[{}]", all(&scalars, ",")), true),
        ("named", format!("{{\"time\":0.5,\"particles\":[{}]}}", all(&object, ",")), true),
        (
            "deeper",
            format!("{{\"meta\":[1],\"frame\":{{\"x\":[{}]}}}}", all(&position, ",")),
            false,
        ),
        ("lines", all(&object, "\n"), true),
        ("lines of vectors", all(&position, "\n") + "\n", false),
        (
            "flat",
            format!(
                "{{\"positions\":[{}],\"velocity\":[{}],\"id\":{ids:?}}}",
                flat(&cloud.positions),
                flat(&velocities)
            ),
            true,
        ),
        ("flat and bare", format!("[{}]", flat(&cloud.positions)), false),
        (
            "vectors as objects",
            format!(
                "[{}]",
                all(
                    &|i| {
                        let object = |v: &[f32; 3]| {
                            format!("{{\"x\":{},\"y\":{},\"z\":{}}}", v[0], v[1], v[2])
                        };
                        format!(
                            "{{\"position\":{},\"velocity\":{},\"id\":{}}}",
                            object(&cloud.positions[i]),
                            object(&velocities[i]),
                            ids[i]
                        )
                    },
                    ","
                )
            ),
            true,
        ),
        (
            "a list of such",
            format!(
                "{{\"positions\":[{}]}}",
                all(
                    &|i| {
                        let v = cloud.positions[i];
                        format!("{{\"x\":{},\"y\":{},\"z\":{}}}", v[0], v[1], v[2])
                    },
                    ","
                )
            ),
            false,
        ),
        (
            "split of pandas",
            format!(
                "{{\"columns\":[\"id\",\"x\",\"y\",\"z\"],\"index\":[0],\"data\":[{}]}}",
                all(
                    &|i| {
                        let [x, y, z] = cloud.positions[i];
                        format!("[{},{x},{y},{z}]", ids[i])
                    },
                    ","
                )
            ),
            false,
        ),
        (
            "columns of pandas",
            format!(
                "{{{}}}",
                join(
                    ["x", "y", "z"]
                        .iter()
                        .enumerate()
                        .map(|(c, name)| {
                            format!(
                                "\"{name}\":{{{}}}",
                                all(&|i| format!("\"{}\":{}", 10 + i, cloud.positions[i][c]), ",")
                            )
                        })
                        .collect(),
                    ","
                )
            ),
            false,
        ),
        (
            "rows of pandas",
            format!("{{{}}}", all(&|i| format!("\"{}\":{}", 10 + i, scalars(i)), ",")),
            true,
        ),
        ("rows of six", format!("[{}]", all(&|i| position(i).replace(']', ",7,8,9]"), ",")), false),
        ("particles are vectors", format!("{{\"particles\":[{}]}}", all(&position, ",")), false),
    ] {
        let p = read(name, text.as_bytes(), Extension::Json);
        assert_eq!(p.positions, cloud.positions, "{name}");
        assert_eq!(p.velocities, cloud.velocities.clone().filter(|_| full), "{name}");
        assert_eq!(
            p.ids,
            cloud.ids.clone().filter(|_| full || name.starts_with("split")),
            "{name}"
        );
        assert_eq!(
            p.warnings.len(),
            usize::from(name == "rows of six"),
            "{name}: {:?}",
            p.warnings
        );
    }
    // Positions keyed by id. With another key they are none.
    let text = r#"{"7": [1, 2, 3], "12": [4, 5, 6]}"#;
    let p = read_bytes(text.as_bytes(), Extension::Json).unwrap();
    let ids = p.ids.expect("ids");
    let at = |id: u32| p.positions[ids.iter().position(|i| *i == id).expect("the id")];
    assert_eq!((at(7), at(12), ids.len()), ([1.0, 2.0, 3.0], [4.0, 5.0, 6.0], 2));
    for other in ["-1", "a"] {
        let text = text.replace("12", other);
        assert!(read_bytes(text.as_bytes(), Extension::Json).is_err(), "{text}");
    }
    let text = "[[NaN, 1, 2], [3, Infinity, -Infinity], [5, 6, 7]]";
    let p = read_bytes(text.as_bytes(), Extension::Json).unwrap();
    assert_eq!(p.positions[2], [5.0, 6.0, 7.0]);
    assert!(p.warnings[0].contains("2 of 3 positions are not finite"), "{:?}", p.warnings);
    // Comments, and commas after the last value.
    for text in [
        "// of a run\n{\"positions\": [[1, 2, 3], [4, 5, 6],], /* [ */ \"a // b\": \"/* ,]\",}",
        "/* [[0, */ [[1, 2, 3], // , ]\n [4, 5, 6], /* last */ ]",
        "[[1, 2, 3,], [4, 5, 6]] // the end",
    ] {
        let p =
            read_bytes(text.as_bytes(), Extension::Json).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_eq!(p.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], "{text}");
    }
    let text = "[[1, \"2.5\", 3], [\"NaN\", 5, 6]]";
    let p = read_bytes(text.as_bytes(), Extension::Json).unwrap();
    assert!(p.positions[0] == [1.0, 2.5, 3.0] && p.positions[1][0].is_nan(), "{:?}", p.positions);
    for text in ["[[1, 2, 3],, [4, 5, 6]]", "[[1, 2, 3] / [4, 5, 6]]", "[,]"] {
        read_bytes(text.as_bytes(), Extension::Json).unwrap_err();
    }
    let text = "{\"NaN \\\" is no number\": 1, \"position\": [[1, 2, NaN]]}";
    assert!(read_bytes(text.as_bytes(), Extension::Json).unwrap().positions[0][2].is_nan());
}

#[test]
fn shapes_of_json_that_are_refused() {
    for (text, parts) in [
        (
            "{\"frames\":[{\"time\":0,\"particles\":[[1,2,3]]},{\"particles\":[[1,2,3]]}]}",
            ["2 frames", "one file per frame"],
        ),
        ("[[1,2,3],\"a\"]", ["[[x, y, z], ...]", "found \"\\\"a\\\"\""]),
        ("[[[1,2,3],[4,5,6]],[[1,2,3],[4,5,6]]]", ["several frames", "one file per frame"]),
        ("{\"positions\":[[[1,2,3]],[[4,5,6]]]}", ["several frames", "2 lists"]),
        ("[1,2,3,4]", ["4 numbers", "[x, y, z]"]),
        ("{\"water\":{\"a\":[1]},\"walls\":{\"a\":[1]}}", ["expected positions", "walls"]),
        ("[{\"x\":1,\"y\":2,\"z\":3},{\"x\":1,\"y\":2}]", ["attribute `z`", "expected 2"]),
        ("{\"file-series-version\":\"1.0\",\"files\":[]}", ["files of a sequence", ".series"]),
        (
            "{\"water\":{\"positions\":[[1,2,3]]},\"n\":1,\"oil\":{\"pos\":[[1,2,3]],\"rho\":[1]}}",
            ["positions inside several objects: `oil`, `water`", "file of its own"],
        ),
    ] {
        error(text.as_bytes(), Extension::Json, &parts);
    }
}

/// Vectors that are objects of lists, one for each component.
#[test]
fn vectors_of_json_as_lists_of_components() {
    let read = |text: &str| read_bytes(text.as_bytes(), Extension::Json).unwrap();
    let vector = |x: &str, y: &str, z: &str| format!("{{\"x\":{x},\"y\":{y},\"z\":{z}}}");
    let (p, v) = (vector("[0,1,2]", "[5,5,5]", "[7,8,9]"), vector("[9,8,7]", "[0,0,0]", "[1,1,2]"));
    let fluid = format!("{{\"position\":{p},\"velocity\":{v},\"id\":[7,8,9]}}");
    for text in [fluid.clone(), format!("{{\"time\":0.5,\"fluid\":{fluid}}}"), format!("[{fluid}]")]
    {
        let found = read(&text);
        assert_eq!(found.positions, [[0.0, 5.0, 7.0], [1.0, 5.0, 8.0], [2.0, 5.0, 9.0]], "{text}");
        assert_eq!(found.velocities.unwrap()[2], [7.0, 0.0, 2.0], "{text}");
        assert_eq!(found.ids, Some(vec![7, 8, 9]), "{text}");
        assert!(found.warnings.is_empty(), "{text}: {:?}", found.warnings);
    }
    // As many particles as dimensions, and fewer dimensions.
    let found = read(&format!("{{\"pos\":{}}}", vector("[0,1]", "[5,6]", "[7,8]")));
    assert_eq!(found.positions, [[0.0, 5.0, 7.0], [1.0, 6.0, 8.0]]);
    let found = read("{\"pos\":{\"X\":[0,1,2],\"Y\":[5,6,7]}}");
    assert_eq!(found.positions, [[0.0, 5.0, 0.0], [1.0, 6.0, 0.0], [2.0, 7.0, 0.0]]);
    assert!(found.warnings[0].contains("two components"), "{:?}", found.warnings);
    let uneven = format!("{{\"pos\":{}}}", vector("[0,1]", "[5,6]", "[7]"));
    error(uneven.as_bytes(), Extension::Json, &["as many numbers", "`pos`", "[2, 2, 1]"]);
}

/// A list of one number for each particle is no vector, though it has the name of a velocity.
#[test]
fn speeds_of_json_are_no_velocities() {
    for (points, speed) in [
        ("[0,0,0],[1,0,0],[0,1,0]", "\"speed\":[1,2,3]"),
        ("[0,0,0],[1,0,0],[0,1,0],[0,0,1]", "\"speed\":[1,2,3,4]"),
        ("[0,0,0],[1,0,0],[0,1,0],[0,0,1]", "\"velocity\":[1,2,3,4]"),
    ] {
        let text = format!("{{\"positions\":[{points}],{speed}}}");
        let p = read_bytes(text.as_bytes(), Extension::Json).unwrap();
        assert_eq!((p.positions[1], p.velocities), ([1.0, 0.0, 0.0], None), "{text}");
        let listed: Vec<_> = p.attributes.iter().map(|a| (a.name.as_str(), a.components)).collect();
        assert!(listed.contains(&(speed.split('"').nth(1).unwrap(), 1)), "{text}: {listed:?}");
    }
    let text = "{\"positions\":[[0,0,0],[1,0,0]],\"velocity\":[1,2,3,4,5,6]}";
    let p = read_bytes(text.as_bytes(), Extension::Json).unwrap();
    assert_eq!(p.velocities, Some(vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]));
}

/// Words as kinds and ids do not keep the particles from being read.
#[test]
fn words_of_json_as_kinds_and_ids() {
    let x = "\"x\":[0,1],\"y\":[2,3],\"z\":[4,5]";
    let rows = |name: &str, words: [&str; 2]| {
        let row = |i: usize| format!("{{\"x\":{i},\"y\":2,\"z\":4,\"{name}\":{}}}", words[i]);
        format!("[{},{}]", row(0), row(1))
    };
    for (name, words) in [
        ("type", ["\"fluid\"", "\"wall\""]),
        ("type", ["true", "false"]),
        ("type", ["1", "\"wall\""]),
        ("label", ["\"a\"", "\"b\""]),
        ("id", ["3", "\"p2\""]),
        ("id", ["\"p1\"", "\"p2\""]),
    ] {
        for text in [format!("{{{x},\"{name}\":[{}]}}", words.join(",")), rows(name, words)] {
            let p = read_bytes(text.as_bytes(), Extension::Json)
                .unwrap_or_else(|e| panic!("{text}: {e}"));
            assert_eq!(p.positions[0], [0.0, 2.0, 4.0], "{text}");
            assert_eq!((p.kinds, p.ids), (None, None), "{text}");
            let told = format!("`{name}` is not used");
            assert!(p.warnings[0].contains(&told), "{text}: {:?}", p.warnings);
            assert_eq!(p.warnings.len(), 1, "{text}: {:?}", p.warnings);
        }
    }
    // An attribute that changes the picture has to be numbers, and unknown words are no matter.
    let text = format!("{{{x},\"density\":[1,\"a\"]}}");
    error(text.as_bytes(), Extension::Json, &["numbers in `density`"]);
    let text = format!("{{{x},\"name\":[\"a\",\"b\"]}}");
    assert!(read_bytes(text.as_bytes(), Extension::Json).unwrap().warnings.is_empty());
}

/// Attributes that not all particles have: some are missing, and what few have is dropped.
#[test]
fn attributes_of_json_that_some_particles_lack() {
    for text in [
        "[{\"position\":[0,0,0]},{\"position\":[1,0,0],\"velocity\":[1,2,3]}]",
        "[{\"position\":[0,0,0],\"velocity\":null},{\"position\":[1,0,0],\"velocity\":[1,2,3]}]",
    ] {
        let p = read_bytes(text.as_bytes(), Extension::Json).unwrap();
        let v = p.velocities.expect("velocities");
        assert!(v[0].iter().all(|c| c.is_nan()) && v[1] == [1.0, 2.0, 3.0], "{text}: {v:?}");
        assert!(p.warnings[0].contains("1 of 2 velocities"), "{text}: {:?}", p.warnings);
        let names: Vec<_> = p.attributes.iter().map(|a| (a.name.as_str(), a.components)).collect();
        assert_eq!(names, [("position", 3), ("velocity", 3)], "{text}");
    }
    let text = "[{\"pos\":[0,0,0]},{\"pos\":[1,0,0]},{\"pos\":[2,0,0],\"rho\":1,\"note\":\"a\"}]";
    let p = read_bytes(text.as_bytes(), Extension::Json).unwrap();
    assert_eq!((p.positions.len(), p.densities, p.attributes.len()), (3, None, 3));
    let told = "attribute `rho` is dropped: only 1 of 3 particles have it";
    assert_eq!(p.warnings, [told]);
}

/// Numbers in quotes, as csv.DictReader of Python leaves them.
#[test]
fn numbers_of_json_in_quotes() {
    let text = "[{\"x\":\"1\",\"y\":\"2.5\",\"z\":\"-3e0\",\"name\":\"7\",\"id\":\"4\"},\
                {\"x\":\"0\",\"y\":0,\"z\":\"0\",\"name\":\"b\",\"id\":\"5\"}]";
    let p = read("quotes", text.as_bytes(), Extension::Json);
    assert_eq!(p.positions, [[1.0, 2.5, -3.0], [0.0; 3]]);
    assert_eq!(p.ids, Some(vec![4, 5]));
}
