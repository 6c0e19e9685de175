//! HDF5 and XDMF files, which `hdf5/make.py` and `hdf5/make_groups.py` wrote with the original libraries.

use std::path::{Path, PathBuf};

use super::bad::{damaged, numbers};
use super::samples::{self, Has};
use super::{allocation, folder::Folder};
use whitewater::io::particles::{
    Extension, Format, Meaning, Particles, Parts, ReadError, Step, read, read_bytes, read_step,
    read_with, steps,
};

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/formats/hdf5").join(name)
}

/// Moves particles back along x.
fn moved(mut particles: Particles, by: f32) -> Particles {
    particles.positions.iter_mut().for_each(|p| p[0] -= by);
    particles
}

fn times(name: &str) -> Vec<Option<f64>> {
    steps(&path(name)).unwrap().into_iter().map(|step| step.time).collect()
}

fn frame(name: &str, index: usize) -> Particles {
    let all = steps(&path(name)).unwrap();
    read_step(&path(name), all[index], &[]).unwrap()
}

#[test]
fn files_of_one_frame_are_the_cloud() {
    for name in ["pysph.hdf5", "grid.vtkhdf", "plain.h5", "turned.h5", "half.h5", "cloud.xdmf"] {
        let particles = read(&path(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
        samples::check(name, &particles, Has::All);
        let xdmf = name.ends_with("xdmf");
        assert_eq!(particles.format, if xdmf { Format::Xdmf } else { Format::Hdf5 }, "{name}");
        assert!(steps(&path(name)).unwrap().is_empty(), "{name}");
        if !xdmf {
            let bytes = std::fs::read(path(name)).unwrap();
            samples::check(name, &read_bytes(&bytes, Extension::Unknown).unwrap(), Has::All);
        }
        let parts = Parts::open(&path(name), 4).unwrap();
        assert_eq!(parts.total(), samples::COUNT, "{name}");
    }
}

/// PySPH stores walls beside the fluid; only the fluid is read. The time is the solver's.
#[test]
fn of_pysph_the_fluid_is_read() {
    let particles = read(&path("pysph.hdf5")).unwrap();
    assert_eq!(particles.time, Some(0.25));
    let told = "groups that are not fluid are not read: /particles/boundary/arrays";
    assert_eq!(particles.warnings, [told]);
    let names: Vec<_> = particles.attributes.iter().map(|a| a.name.as_str()).collect();
    assert!(names.contains(&"h") && !names.contains(&"au"), "{names:?}");
    let extra = whitewater::io::particles::read_with(&path("pysph.hdf5"), &["h"]).unwrap();
    assert_eq!(extra.extras[0].values, [0.1; 11]);
}

/// Time steps of VTKHDF, each with one particle fewer than the previous one, and groups whose names
/// differ in a number, which gives their order.
#[test]
fn steps_are_frames() {
    assert_eq!(times("steps.vtkhdf"), [0.0, 0.5, 1.0].map(Some));
    for i in 0..3 {
        let found = moved(frame("steps.vtkhdf", i), i as f32);
        let cloud = samples::cloud();
        let left = samples::COUNT - i;
        assert_eq!(found.positions, cloud.positions[..left], "{i}");
        assert_eq!(found.velocities.unwrap(), cloud.velocities.unwrap()[..left], "{i}");
        assert_eq!(found.ids.unwrap(), cloud.ids.unwrap()[..left], "{i}");
        assert_eq!(found.time, Some(0.5 * i as f64));
        assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    }
    let found = times("steps.h5part");
    assert_eq!(found.len(), 4);
    assert!(found.iter().zip([0.0, 0.1, 0.2, 1.0]).all(|(a, b)| (a.unwrap() - b).abs() < 1e-12));
    for (i, step) in [0.0, 1.0, 2.0, 10.0].into_iter().enumerate() {
        samples::check("h5part", &moved(frame("steps.h5part", i), step), Has::All);
    }
    for name in ["h5md.h5", "stacked.h5", "apart.h5"] {
        assert_eq!(times(name), [Some(0.0), Some(0.5)]);
        for i in 0..2 {
            let found = moved(frame(name, i), i as f32);
            assert_eq!(found.positions, samples::cloud().positions, "{name}");
            assert_eq!((found.velocities, found.ids), {
                let cloud = samples::cloud();
                (cloud.velocities, cloud.ids)
            });
        }
    }
    // If groups differ in a number at any place of their path, those of the fluid are read.
    for (i, by) in [0.0, 0.5].into_iter().enumerate() {
        let found = moved(frame("numbered.h5", i), by);
        assert_eq!(found.positions.len(), samples::COUNT);
        let cloud = samples::cloud();
        let pairs = found.positions.iter().flatten().zip(cloud.positions.iter().flatten());
        assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1.0e-6), "{i}");
        assert_eq!(found.ids, cloud.ids, "{i}");
        assert_eq!(found.velocities, cloud.velocities, "{i}");
        assert!(found.warnings[0].contains("are not read: /0000/walls, /0005/walls"));
    }
    // Without a frame number, a file with several frames is not read.
    let error = read(&path("steps.vtkhdf")).unwrap_err().to_string();
    assert!(error.contains("3 frames") && error.contains("steps.vtkhdf"), "{error}");
    let none = Step::new(3, None);
    read_step(&path("steps.vtkhdf"), none, &[]).unwrap_err();
}

/// Numbers in the names of groups count frames only where the name or a time says so.
#[test]
fn groups_are_frames_by_their_names_or_times() {
    let found = times("ranks.h5");
    assert_eq!(found, [None, None]);
    for (i, by) in [0.0, 1.5].into_iter().enumerate() {
        let particles = moved(frame("ranks.h5", i), by);
        assert_eq!(particles.positions, samples::cloud().positions, "{i}");
        assert_eq!(particles.ids, samples::cloud().ids, "{i}");
        let name = ["0", "1.5"][i];
        let told =
            format!("2 groups are read as pieces of one frame: /t_{name}/rank_0, /t_{name}/rank_1");
        assert_eq!(particles.warnings, [told]);
    }
    assert_eq!(times("timed.h5"), [Some(0.25), Some(0.5)]);
    for i in 0..2 {
        let particles = moved(frame("timed.h5", i), i as f32);
        assert_eq!(particles.positions, samples::cloud().positions, "{i}");
    }
    // Sorted by number, not by name.
    assert_eq!(times("beside.h5"), [None, None]);
    for i in 0..2 {
        let particles = moved(frame("beside.h5", i), i as f32);
        assert_eq!(particles.positions, samples::cloud().positions, "{i}");
        assert_eq!(particles.warnings, ["groups beside the frames are not read: /floor"]);
    }
    let error = read(&path("bodies.h5")).unwrap_err().to_string();
    assert!(error.contains("(/body0, /body1)") && error.contains("`step_1`"), "{error}");
    assert_eq!(error, steps(&path("bodies.h5")).unwrap_err().to_string());
    let particles = read(&path("fluids.h5")).unwrap();
    assert_eq!(particles.positions, samples::cloud().positions);
    let told = &particles.warnings;
    assert!(told[0].starts_with("2 groups are joined: /step_0001/fluid1, /step_0001/fluid2;"));
    assert_eq!(told[1], "groups that are not fluid are not read: /step_0001/walls");
}

/// By the convention of Gadget, type 0 is the gas.
#[test]
fn of_gadget_the_gas_is_read() {
    let particles = read(&path("gadget.hdf5")).unwrap();
    samples::check("gadget", &particles, Has::All);
    assert_eq!(particles.time, Some(0.25));
    assert_eq!(particles.warnings, ["groups that are not fluid are not read: /PartType1"]);
}

/// Soft links lead to arrays of the same file, which are read once.
#[test]
fn links_within_the_file_are_followed() {
    let particles = read(&path("soft.h5")).unwrap();
    samples::check("soft", &particles, Has::All);
    assert!(particles.warnings.is_empty(), "{:?}", particles.warnings);
    let error = read(&path("external.h5")).unwrap_err().to_string();
    assert!(error.contains("(/position leads to /POSITIONS in plain.h5)"), "{error}");
    assert!(error.contains("give the file that a link leads to"), "{error}");
    // So many links are stored apart from the group.
    let error = read(&path("externals.h5")).unwrap_err().to_string();
    assert!(error.contains(" in run_07.h5, ") && error.contains(" and 6 more)"), "{error}");
    let particles = read(&path("partly.h5")).unwrap();
    assert_eq!(particles.positions, samples::cloud().positions);
    let told = "links to other files are not followed: /velocity leads to /VELOCITIES in plain.h5";
    assert_eq!(particles.warnings, [told]);
}

/// MATLAB writes a user block before the HDF5, and columns as rows.
#[test]
fn behind_a_user_block() {
    for name in ["matlab.mat", "block.h5"] {
        let particles = read(&path(name)).unwrap();
        samples::check(name, &particles, Has::All);
        assert_eq!((particles.format, particles.time), (Format::Hdf5, Some(0.5)), "{name}");
        let bytes = std::fs::read(path(name)).unwrap();
        samples::check(name, &read_bytes(&bytes, Extension::Unknown).unwrap(), Has::All);
    }
    let bytes = std::fs::read(path("matlab.mat")).unwrap();
    let error = read_bytes(&bytes[..512], Extension::Unknown).unwrap_err().to_string();
    assert!(error.contains("MATLAB 7.3"), "{error}");
}

/// A unit that is stored beside an array is read like one in the name of a column.
#[test]
fn units_are_part_of_the_names() {
    let particles = read(&path("units.h5")).unwrap();
    samples::check("units", &particles, Has::All);
    assert_eq!(particles.time, Some(0.5));
    let (meaning, names) = &particles.meanings[0];
    assert_eq!((*meaning, names.as_slice()), (Meaning::Position, &["position [mm]".into()][..]));
    let names: Vec<_> = particles.attributes.iter().map(|a| a.name.as_str()).collect();
    for name in ["velocity [mm/s]", "density [kg/m3]", "id"] {
        assert!(names.contains(&name), "{name}: {names:?}");
    }
}

/// A group of x, y and z is a vector of the particles around it, not more particles.
#[test]
fn groups_of_components_are_vectors() {
    let particles = read(&path("components.h5")).unwrap();
    samples::check("components", &particles, Has::All);
    let told = "not read, because their number of values is not that of the positions beside them: \
                /particles/probes";
    assert_eq!(particles.warnings, [told]);
    let names: Vec<_> = particles.attributes.iter().map(|a| a.name.as_str()).collect();
    for name in ["positions_x", "velocities_z", "force_y", "id", "density"] {
        assert!(names.contains(&name), "{name}: {names:?}");
    }
    let particles = read(&path("velocity_group.h5")).unwrap();
    samples::check("velocity_group", &particles, Has::All);
    assert!(particles.warnings.is_empty(), "{:?}", particles.warnings);
    // Without the name of positions such groups are particles.
    let particles = read(&path("bare.h5")).unwrap();
    samples::check("bare", &particles, Has::Positions);
    assert_eq!(particles.warnings, ["groups that are not fluid are not read: /floor"]);
}

#[test]
fn times_come_before_step_numbers() {
    assert_eq!(times("step_time.h5"), [Some(0.0), Some(0.5)]);
}

/// What netCDF packed is unpacked; a missing value becomes NaN.
#[test]
fn packed_values_are_unpacked() {
    let particles = read_with(&path("packed.h5"), &["depth"]).unwrap();
    samples::check("packed", &particles, Has::All);
    let depth = &particles.extras[0].values;
    assert!(depth[3].is_nan() && depth[4] == 8.0 && depth.len() == samples::COUNT, "{depth:?}");
    let error = read(&path("badly_packed.h5")).unwrap_err().to_string();
    assert!(error.contains("position`, whose `scale_factor` is not a number"), "{error}");
}

/// A series with two grids; the second takes its velocities from the item at a path.
fn referring(to: &str) -> String {
    let points = |name: &str, time: u8, numbers: &str| {
        format!(
            "<Grid Name=\"{name}\"><Time Value=\"{time}\"/><Geometry GeometryType=\"XYZ\"><DataItem Name=\"p\" \
             Dimensions=\"2 3\">{numbers}</DataItem></Geometry>"
        )
    };
    format!(
        "<Xdmf><Domain><DataItem Name=\"own/one\" Dimensions=\"2 3\">0 0 1 0 0 2</DataItem><DataItem Name=\"loop\" \
         Reference=\"/Xdmf/Domain/DataItem[2]\"/><Grid GridType=\"Collection\" CollectionType=\"Temporal\">{}</Grid>{}\
         <Attribute Name=\"velocity\"><DataItem Dimensions=\"2 3\" Reference=\"XML\"> {to} </DataItem></Attribute></Grid>\
         </Grid></Domain></Xdmf>",
        points("g0", 0, "1 2 3 4 5 6"),
        points("g1", 1, "7 8 9 10 11 12")
    )
}

#[test]
fn references_of_xdmf_follow_their_path() {
    let folder = Folder::new("xdmf-references");
    let second = |to: &str| {
        let file = folder.put("a.xmf", referring(to));
        let step = steps(&file).unwrap()[1];
        read_step(&file, step, &[]).map(|particles| particles.velocities.unwrap()[0])
    };
    for (to, expected) in [
        ("/Xdmf/Domain/Grid/Grid[2]/Geometry/DataItem[@Name='p']", [7.0, 8.0, 9.0]),
        ("/Xdmf/Domain/Grid/Grid[1]/Geometry/DataItem[@Name='p']", [1.0, 2.0, 3.0]),
        ("//Grid[@Name=\"g1\"]/Geometry/DataItem[1]", [7.0, 8.0, 9.0]),
        ("../../Geometry/DataItem", [7.0, 8.0, 9.0]),
        ("/Xdmf/*/DataItem[ @Name = 'own/one' ]", [0.0, 0.0, 1.0]),
        // A path of another kind, and a name that only one item has.
        ("xpointer(//DataItem[@Name='own/one'])", [0.0, 0.0, 1.0]),
    ] {
        assert_eq!(second(to).unwrap_or_else(|e| panic!("{to}: {e}")), expected, "{to}");
    }
    for (to, told) in [
        ("//DataItem[@Name='p']", "2 by `//DataItem"),
        ("xpointer(//DataItem[@Name='p'])", "2 by `xpointer"),
        ("/Xdmf/Domain/Grid/Grid[3]/Geometry/DataItem", "0 by `/Xdmf"),
        ("/Xdmf/Domain/DataItem[0]", "0 by `/Xdmf"),
        ("/Xdmf/Domain/DataItem[@Name='loop']", "ever more references"),
    ] {
        let error = second(to).unwrap_err().to_string();
        assert!(error.contains(told), "{to}: {error}");
    }
}

#[test]
fn joined_grids_of_xdmf_are_told() {
    let folder = Folder::new("xdmf-joined");
    let grid = |name: &str, x: u8| {
        format!(
            "<Grid Name=\"{name}\" GridType=\"Uniform\"><Geometry GeometryType=\"XYZ\"><DataItem Dimensions=\"2 3\">\
             {x} 0 0 {x} 1 0</DataItem></Geometry></Grid>"
        )
    };
    let both = grid("fluid", 1) + &grid("wall", 2);
    let particles =
        read(&folder.put("a.xmf", format!("<Xdmf><Domain>{both}</Domain></Xdmf>"))).unwrap();
    assert_eq!(particles.positions.len(), 4);
    assert_eq!(particles.warnings.len(), 1, "{:?}", particles.warnings);
    assert!(particles.warnings[0].starts_with("2 grids are joined: fluid, wall;"));
    // The parts of a spatial collection belong together.
    for kind in ["", "CollectionType=\"Spatial\""] {
        let text = format!(
            "<Xdmf><Domain><Grid GridType=\"Collection\" {kind}>{both}</Grid></Domain></Xdmf>"
        );
        let particles = read(&folder.put("b.xmf", text)).unwrap();
        assert_eq!((particles.positions.len(), particles.warnings), (4, vec![]), "{kind}");
    }
}

/// The times of a collection, as a list or by first, distance and count.
#[test]
fn times_of_an_xdmf_collection() {
    let folder = Folder::new("xdmf-times");
    let grid = |time: &str| {
        format!(
            "<Grid>{time}<Geometry GeometryType=\"XYZ\"><DataItem Dimensions=\"1 3\">1 2 3</DataItem></Geometry></Grid>"
        )
    };
    for (kind, numbers) in [("List", "0.5 0.75"), ("HyperSlab", "0.5 0.25 2")] {
        for (own, second) in [("", 0.75), ("<Time Value=\"8\"/>", 8.0)] {
            let text = format!(
                "<Xdmf><Domain><Grid GridType=\"Collection\" CollectionType=\"Temporal\"><Time TimeType=\"{kind}\">\
                 <DataItem Format=\"XML\" Dimensions=\"2\">{numbers}</DataItem></Time>{}{}</Grid></Domain></Xdmf>",
                grid(""),
                grid(own)
            );
            let all = steps(&folder.put("a.xmf", text)).unwrap();
            let times: Vec<_> = all.iter().map(|step| step.time).collect();
            assert_eq!(times, [Some(0.5), Some(second)], "{kind}");
        }
    }
}

/// Points that are stored once belong to all frames.
#[test]
fn a_series_of_xdmf_is_frames() {
    assert_eq!(times("series.xdmf"), [Some(0.0), Some(0.5)]);
    samples::check("series", &frame("series.xdmf", 0), Has::All);
    let second = frame("series.xdmf", 1);
    let twice = samples::cloud().velocities.unwrap().iter().map(|v| v.map(|c| 2.0 * c)).collect();
    assert_eq!(second.velocities, Some(twice));
    assert_eq!(second.time, Some(0.5));
    let folder = Folder::new("xdmf");
    let text = std::fs::read_to_string(path("cloud.xdmf")).unwrap();
    let alone = folder.put("alone.xmf", &text);
    let error = read(&alone).unwrap_err().to_string();
    assert!(error.contains("cloud.h5") && error.contains("check the name"), "{error}");
    // Numbers within the text of the file, and coordinates in separate arrays.
    let apart = "<Xdmf><Domain><Grid><Geometry GeometryType=\"X_Y_Z\"><DataItem Dimensions=\"2\">1 2</DataItem>\
                 <DataItem Dimensions=\"2\">3 4</DataItem><DataItem Dimensions=\"2\">5 6</DataItem></Geometry>\
                 <Attribute Name=\"rho\"><DataItem Dimensions=\"2\">8 9</DataItem></Attribute></Grid></Domain></Xdmf>";
    let found = read(&folder.put("apart.xmf", apart)).unwrap();
    assert_eq!(found.positions, [[1.0, 3.0, 5.0], [2.0, 4.0, 6.0]]);
    assert_eq!(found.densities, Some(vec![8.0, 9.0]));
    let error = read(&folder.put("short.xmf", apart.replace("8 9", "8"))).unwrap_err();
    assert!(error.to_string().contains("expected 2 values"), "{error}");
}

#[test]
fn what_is_not_read_is_named() {
    let error = read(&path("lzf.h5")).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("lzf.h5") && text.contains("compression='gzip'"), "{text}");
    let error = read(&path("series.h5")).unwrap_err().to_string();
    assert!(error.contains("expected positions") && error.contains("/data0"), "{error}");
    // Data that were never written take no space in the file, and none in memory.
    let (result, peak) = allocation::peak(|| steps(&path("sparse.vtkhdf")));
    let error = result.unwrap_err().to_string();
    assert!(error.contains("PartOffsets` unpacks to more than"), "{error}");
    assert!(peak < 1 << 24, "{peak}");
    let (result, peak) = allocation::peak(|| read(&path("hollow.h5")));
    assert_eq!(result.unwrap().positions, samples::cloud().positions);
    assert!(peak < 1 << 24, "{peak}");
    let error = read(&path("table.h5")).unwrap_err().to_string();
    assert!(error.contains("/particles (a table: save each of its columns"), "{error}");
    let bytes = std::fs::read(path("plain.h5")).unwrap();
    for cut in [8, 100] {
        let error = read_bytes(&bytes[..cut], Extension::Unknown).unwrap_err();
        let told = matches!(error, ReadError::Malformed { .. } | ReadError::Truncated { .. });
        assert!(told, "{cut}: {error}");
    }
}

/// A damaged file is read or gives an error, and its memory is limited by the size of the file.
#[test]
fn damaged_files() {
    let mut next = numbers();
    let (mut cases, mut sound) = (0, 0);
    for name in [
        "pysph.hdf5",
        "grid.vtkhdf",
        "steps.vtkhdf",
        "plain.h5",
        "steps.h5part",
        "h5md.h5",
        "ranks.h5",
        "half.h5",
        "externals.h5",
        "matlab.mat",
    ] {
        let bytes = std::fs::read(path(name)).unwrap();
        for _ in 0..super::bad::rounds(24) {
            let bytes = damaged(&bytes, &mut next);
            let (result, peak) = allocation::peak(|| read_bytes(&bytes, Extension::Unknown));
            // Bound of the unpacked bytes, times three because they are held as stored and as
            // numbers.
            let limit = 3 * ((16 << 20) + 64 * bytes.len());
            assert!(peak <= limit, "{name}: {peak} bytes held for {}", bytes.len());
            cases += 1;
            sound += usize::from(result.is_ok());
        }
    }
    println!("{cases} damaged files, {sound} of them read");
    assert!(sound > 0 && sound < cases, "{sound} of {cases}");
}

/// XDMF with damaged text and intact arrays, and with damaged arrays.
#[test]
fn damaged_xdmf() {
    let folder = Folder::new("damaged-xdmf");
    let inline = "<Xdmf><Domain><DataItem Name=\"p\" Dimensions=\"2 3\">1 2 3 4 5 6</DataItem><Grid GridType=\"Collection\" \
                  CollectionType=\"Temporal\"><Grid><Time Value=\"0.5\"/><Geometry GeometryType=\"XYZ\"><DataItem \
                  Reference=\"/Xdmf/Domain/DataItem[@Name='p']\"/></Geometry><Attribute Name=\"id\" Center=\"Node\"><DataItem \
                  Dimensions=\"2\">7 8</DataItem></Attribute></Grid><Grid><Time Value=\"1\"/></Grid></Grid></Domain></Xdmf>";
    let text = |name: &str| std::fs::read(path(name)).unwrap();
    let arrays: Vec<_> = ["cloud.h5", "series.h5"].map(|name| (name, text(name))).into();
    arrays.iter().for_each(|(name, bytes)| drop(folder.put(name, bytes)));
    let mut next = numbers();
    let (mut cases, mut sound) = (0, 0);
    for (name, bytes) in
        [("cloud", text("cloud.xdmf")), ("series", text("series.xdmf")), ("inline", inline.into())]
    {
        for round in 0..super::bad::rounds(48) {
            // In every eighth round the arrays are damaged instead of the text.
            let of_array = round % 8 == 7 && name != "inline";
            let changed = if of_array { bytes.clone() } else { damaged(&bytes, &mut next) };
            if of_array {
                let (name, array) = &arrays[usize::from(name == "series")];
                folder.put(name, damaged(array, &mut next));
            }
            let file = folder.put("a.xmf", changed);
            let (results, peak) = allocation::peak(|| {
                let frames = steps(&file).unwrap_or_default();
                let frames =
                    frames.into_iter().take(4).map(|step| read_step(&file, step, &["rho"]));
                frames.chain([read(&file)]).map(|result| result.is_ok()).collect::<Vec<_>>()
            });
            let limit = 3 * ((16 << 20) + 64 * 20_000);
            assert!(peak <= limit, "{name}: {peak} bytes held");
            cases += 1;
            sound += usize::from(results.contains(&true));
            if of_array {
                arrays.iter().for_each(|(name, bytes)| drop(folder.put(name, bytes)));
            }
        }
    }
    println!("{cases} damaged files, {sound} of them read");
    assert!(sound > 0 && sound < cases, "{sound} of {cases}");
}
