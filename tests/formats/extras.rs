//! Attributes that are requested by name, and reports about attributes that were not read.

use std::path::PathBuf;

use whitewater::io::particles::{
    Extra, Meaning, Particles, WriteFormat, read, read_with, same_name, write,
};

/// Path of a file that only one test uses.
fn place(name: &str) -> PathBuf {
    std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

fn file(name: &str) -> PathBuf {
    let path = place(name);
    std::fs::write(&path, ROWS).unwrap();
    path
}

const ROWS: &str = "x,y,z,Vel.x [m/s],Vel.y [m/s],Vel.z [m/s],Mk,Press [Pa],note\n\
                    0,0,0,1,2,3,11,0.5,wall\n1,0,0,1,2,3,1,1.5,\n0,1,0,1,2,3,1,-2,water\n";

#[test]
fn attributes_are_read_that_are_asked_for() {
    let csv = file("asked.csv");
    let plain = read(&csv).unwrap();
    assert!(plain.extras.is_empty());
    let all = read_with(&csv, &["press", "MK", "type", "density"]).unwrap();
    let extra = |name: &str, values: [f64; 3]| Extra { name: name.into(), values: values.into() };
    assert_eq!(all.extras, [extra("Mk", [11.0, 1.0, 1.0]), extra("Press [Pa]", [0.5, 1.5, -2.0])]);
    // Without the extra attributes the result is the same, and `read` returns no extra attributes.
    assert_eq!(Particles { extras: Vec::new(), ..all.clone() }, plain);
    assert_eq!(read(&csv).unwrap(), plain);
    let mut some = all;
    some.retain(&[false, true]);
    assert_eq!(some.positions, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(some.velocities.as_ref().unwrap().len(), 2);
    assert_eq!(some.extras[0].values, [1.0, 1.0]);
    assert!(same_name("Press [Pa]", "press") && !same_name("press", "pressure"));
}

/// An attribute with a known meaning can be requested too, in any format.
#[test]
fn kinds_can_be_asked_for() {
    let mut particles = Particles::from_positions(vec![[0.0; 3], [1.0; 3]]);
    particles.kinds = Some(vec![3, 0]);
    for (format, suffix) in [
        (WriteFormat::Vtu, ".vtu"),
        (WriteFormat::Ply, ".ply"),
        (WriteFormat::Npz, ".npz"),
        (WriteFormat::Bgeo { gzip: false }, ".bgeo"),
    ] {
        let path = place(&format!("kinds{suffix}"));
        write(&path, &particles, format).unwrap();
        let found = read_with(&path, &["type"]).unwrap();
        assert_eq!(found.kinds, Some(vec![3, 0]), "{suffix}");
        assert_eq!(found.extras.len(), 1, "{suffix}");
        assert_eq!(found.extras[0].values, [3.0, 0.0], "{suffix}");
        let meanings: Vec<Meaning> = found.meanings.iter().map(|(meaning, _)| *meaning).collect();
        assert_eq!(meanings, [Meaning::Position, Meaning::Kind], "{suffix}");
    }
}

#[test]
fn what_became_of_attributes_is_told() {
    let csv = read(&file("told.csv")).unwrap();
    let [(Meaning::Position, positions), (Meaning::Velocity, velocities)] = &csv.meanings[..]
    else {
        panic!("{:?}", csv.meanings)
    };
    assert_eq!(positions, &["x", "y", "z"]);
    assert_eq!(velocities[0], "Vel.x [m/s]");
}

/// Attributes that give the time of a frame, or mark ghosts, have a meaning. A time that is none has not.
#[test]
fn times_and_ghosts_have_a_meaning() {
    let of = |name: &str, text: &str| {
        let path = place(name);
        std::fs::write(&path, text).unwrap();
        let particles = read(&path).unwrap();
        let part = |(meaning, names): &(Meaning, Vec<String>)| (*meaning, names.join(" "));
        let all: Vec<_> = particles.meanings.iter().map(part).collect();
        (particles.time, all[1..].to_vec())
    };
    for name in ["time", "Iteration", "Frame No.", "sim_time", "Snapshot"] {
        let text = format!("x,y,z,{name}\n0,0,0,7\n1,0,0,7\n");
        assert_eq!(of("time.csv", &text), (Some(7.0), vec![(Meaning::Time, name.into())]));
    }
    // A time of its own for each particle, such as its age, is none of the frame; a lone `t` is a temperature.
    for text in ["x,y,z,time\n0,0,0,7\n1,0,0,8\n2,0,0,3\n", "x,y,z,t\n0,0,0,7\n1,0,0,7\n"] {
        assert_eq!(of("none.csv", text), (None, Vec::new()), "{text}");
    }
    let text = "x,y,z,vtkGhostType\n0,0,0,0\n1,0,0,1\n";
    assert_eq!(of("ghosts.csv", text).1, [(Meaning::Ghost, "vtkGhostType".to_string())]);
}
