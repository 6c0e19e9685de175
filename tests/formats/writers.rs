//! Files that were written are read back unchanged.

use super::folder::Folder;
use super::samples;
use whitewater::io::particles::{Particles, WriteError, WriteFormat, read, write};

fn cloud() -> Particles {
    let mut p = samples::cloud();
    p.lifetimes = Some((0..samples::COUNT).map(|i| 0.1 * i as f32 - 0.3).collect());
    p.kinds = Some((0..samples::COUNT as u32).map(|i| i % 3).collect());
    p
}

const NAMES: [&str; 5] = ["a.bgeo", "a.bgeo.gz", "a.vtu", "a.ply", "a.npz"];

#[test]
fn written_particles_read_back() {
    let own = Folder::new("write");
    let folder = own.path();
    let empty = Particles::from_positions(Vec::new());
    let bare = Particles::from_positions(samples::cloud().positions);
    // More than one compressed block of VTU.
    let mut large = Particles::from_positions(
        (0..70_000).map(|i| [i as f32, 0.5, -(i as f32).sqrt()]).collect(),
    );
    large.ids = Some((0..70_000).collect());
    for (what, p) in [("all", &cloud()), ("bare", &bare), ("empty", &empty), ("large", &large)] {
        for name in NAMES {
            let path = folder.join(name);
            write(&path, p, WriteFormat::from_path(&path).unwrap()).unwrap();
            let back = read(&path).unwrap_or_else(|e| panic!("{what}: {e}"));
            assert_eq!(back.positions, p.positions, "{what} {name}");
            assert_eq!(back.velocities, p.velocities, "{what} {name}");
            assert_eq!(back.densities, p.densities, "{what} {name}");
            assert_eq!(back.ids, p.ids, "{what} {name}");
            assert_eq!(back.lifetimes, p.lifetimes, "{what} {name}");
            assert_eq!(back.kinds, p.kinds, "{what} {name}");
            assert!(back.warnings.is_empty(), "{what} {name}: {:?}", back.warnings);
        }
    }
    // Each file was written four times, and no temporary files are left.
    assert_eq!(std::fs::read_dir(folder).unwrap().count(), NAMES.len());
}

#[test]
fn failures_leave_nothing() {
    let own = Folder::new("fail");
    let folder = own.path();
    let mut p = cloud();
    p.densities = Some(vec![1.0]);
    let path = folder.join("a.ply");
    let error = write(&path, &p, WriteFormat::Ply).unwrap_err();
    assert!(matches!(error, WriteError::Length { attribute: "densities", .. }), "{error}");
    let mut p = cloud();
    p.ids.as_mut().unwrap()[3] = u32::MAX;
    let error = write(&path, &p, WriteFormat::Bgeo { gzip: false }).unwrap_err();
    assert!(matches!(error, WriteError::Range { value: 4_294_967_295, .. }), "{error}");
    for format in [WriteFormat::Vtu, WriteFormat::Ply, WriteFormat::Npz] {
        write(&path, &p, format).unwrap();
        assert_eq!(read(&path).unwrap().ids, p.ids, "{format:?}");
    }
    std::fs::remove_file(&path).unwrap();
    // A folder has the name of the file, so that the final rename fails.
    std::fs::create_dir(&path).unwrap();
    assert!(matches!(write(&path, &p, WriteFormat::Vtu), Err(WriteError::Io { .. })));
    assert_eq!(std::fs::read_dir(folder).unwrap().count(), 1);
    assert!(matches!(
        write(&folder.join("no/a.vtu"), &p, WriteFormat::Vtu),
        Err(WriteError::Io { .. })
    ));
    for name in ["a.vtk", "a.vtu.gz", "a", "a.csv"] {
        assert_eq!(WriteFormat::from_path(std::path::Path::new(name)), None);
    }
}
