//! Published caches, if `WHITEWATER_DATA` names their folder, and frames of this project's own
//! scenes.

use std::path::PathBuf;

use whitewater::io::particles::{
    Extension, Particles, WriteFormat, estimate_spacing, read, read_bytes, sequence, write_to,
};

use crate::skipped::skipped;

fn folder() -> Option<PathBuf> {
    let folder = std::env::var_os("WHITEWATER_DATA").map(PathBuf::from);
    if folder.is_none() {
        skipped("WHITEWATER_DATA is not set");
    }
    folder
}

/// A frame of one of the project's own scenes, which the published crate does not contain.
fn own(file: &str) -> Option<PathBuf> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("assets").join(file);
    if !path.exists() {
        skipped("the assets are not in the published crate");
        return None;
    }
    Some(path)
}

/// File, number of particles, spacing, and measured error of the estimated spacing in percent. The
/// error may change by one percent.
const OWN: [(&str, usize, f32, f32); 3] = [
    ("waterfall/waterfall_0240.bgeo", 29_408, 0.04, 2.6),
    ("corridor/corridor_0090.bgeo", 27_117, 0.04, 1.3),
    ("bamboo/bamboo_0115.bgeo", 30_230, 0.02, 5.6),
];

/// Frames written in each format that this library writes, and read back bit for bit.
#[test]
fn our_frames_in_every_format_that_is_written() {
    for (file, count, spacing, expected) in OWN {
        let Some(path) = own(file) else { return };
        let truth = load(&path);
        assert_eq!(truth.positions.len(), count, "{file}");
        assert!(truth.velocities.is_some() && truth.densities.is_some() && truth.ids.is_some());
        assert!(truth.warnings.is_empty(), "{file}: {:?}", truth.warnings);
        let found = estimate_spacing(&truth.positions).unwrap();
        let error = 100.0 * (found / spacing - 1.0);
        assert!((error - expected).abs() < 1.0, "{file}: {error:+.1} %, not {expected:+.1} %");
        for (name, hint) in [
            ("a.bgeo", Extension::Bgeo),
            ("a.bgeo.gz", Extension::Bgeo),
            ("a.vtu", Extension::Vtu),
            ("a.ply", Extension::Ply),
            ("a.npz", Extension::Npz),
        ] {
            let format = WriteFormat::from_path(name.as_ref()).unwrap();
            let mut bytes = std::io::Cursor::new(Vec::new());
            write_to(&mut bytes, &truth, format).unwrap();
            let back = read_bytes(&bytes.into_inner(), hint).unwrap();
            let bits = |of: &Particles| -> Vec<u32> {
                let vectors = of.positions.iter().chain(of.velocities.iter().flatten());
                let all = vectors.flatten().chain(of.densities.iter().flatten());
                all.map(|v| v.to_bits()).collect()
            };
            assert!(bits(&truth) == bits(&back), "{file} as {name}");
            assert_eq!(truth.ids, back.ids, "{file} as {name}");
        }
    }
}

#[test]
fn a_frame_of_ours_is_a_sequence() {
    for (file, ..) in OWN {
        let Some(path) = own(file) else { return };
        let stem = path.file_stem().unwrap().to_str().unwrap();
        let (name, number) = stem.rsplit_once('_').unwrap();
        for pattern in ["*", "%04d"] {
            let input = path.with_file_name(format!("{name}_{pattern}.bgeo"));
            let frames = sequence::expand(&[input.display().to_string()], None).unwrap();
            assert_eq!(frames.len(), 1, "{}", input.display());
            assert_eq!((frames[0].number, &frames[0].path), (number.parse().unwrap(), &path));
        }
    }
}

fn load(path: &std::path::Path) -> Particles {
    read(path).unwrap_or_else(|e| panic!("{e}"))
}

/// Asserts that values agree within a relative error of `digits`.
fn differ(name: &str, a: &[f32], b: &[f32], digits: f32) {
    assert_eq!(a.len(), b.len(), "{name}");
    for (i, (a, b)) in a.iter().zip(b).enumerate() {
        let error = (a - b).abs();
        assert!(error <= digits * a.abs(), "{name}: value {i}: {a} and {b}");
    }
}

#[test]
fn one_frame_in_23_files() {
    let Some(folder) = folder() else { return };
    let folder = folder.join("formats");
    let truth = load(&folder.join("dam27_uncompressed.bgeo"));
    assert_eq!(truth.positions.len(), 4732);
    let mut files: Vec<_> =
        std::fs::read_dir(&folder).unwrap().map(|e| e.unwrap().path()).collect();
    files.sort();
    assert_eq!(files.len(), 23);
    for file in files {
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        let p = load(&file);
        let text = ["ascii", "csv", "json"].iter().any(|t| name.contains(t));
        // VTK writes legacy text with six digits; the other text has seven.
        let digits = match (text, name.contains("legacy51_ascii")) {
            (false, _) => 0.0,
            (true, false) => 6e-7,
            (true, true) => 6e-6,
        };
        differ(&name, truth.positions.as_flattened(), p.positions.as_flattened(), digits);
        assert!(p.warnings.is_empty(), "{name}: {:?}", p.warnings);
        if name.contains("positions") {
            assert_eq!(p.velocities, None, "{name}");
            continue;
        }
        let (v, w) = (truth.velocities.as_ref().unwrap(), p.velocities.as_ref().unwrap());
        differ(&name, v.as_flattened(), w.as_flattened(), digits);
        differ(&name, truth.densities.as_ref().unwrap(), p.densities.as_ref().unwrap(), digits);
        assert_eq!(truth.ids, p.ids, "{name}");
        println!("{name}: {}", p.format);
    }
}

#[test]
fn sequences() {
    let Some(folder) = folder() else { return };
    let cases = [
        ("double_dam_pillar/ParticleData_Fluid_*.bgeo", 18, 40, 57),
        ("double_dam_pillar/foam/foam_*.bgeo", 18, 40, 57),
        ("inflow/ParticleData_Fluid_%d.bgeo", 10, 120, 138),
        ("inflow/foam/foam_*.bgeo", 10, 120, 138),
        ("big_dam/*.bgeo", 1, 46, 46),
        ("big_dam/foam/*.bgeo", 1, 46, 46),
        ("double_dam_small/ParticleData_Fluid_%d.bgeo", 50, 13, 62),
        ("double_dam_small/foam/foam_%d.bgeo", 50, 13, 62),
    ];
    for (pattern, count, first, last) in cases {
        let input = folder.join(pattern).display().to_string();
        let frames = sequence::expand(&[input], None).unwrap();
        assert_eq!(frames.len(), count, "{pattern}");
        assert_eq!((frames[0].number, frames[count - 1].number), (first, last), "{pattern}");
        for frame in frames {
            let p = load(&frame.path);
            assert!(p.velocities.is_some() && p.ids.is_some(), "{}", frame.path.display());
            let foam = pattern.contains("foam");
            assert_eq!(
                p.lifetimes.is_some() && p.kinds.is_some(),
                foam,
                "{}",
                frame.path.display()
            );
            assert!(p.kinds.iter().flatten().all(|k| *k <= 2));
            assert!(p.warnings.is_empty(), "{}: {:?}", frame.path.display(), p.warnings);
            if !pattern.contains("inflow") && !foam {
                let expected = [("pillar", 27_528), ("big", 139_995), ("small", 4_732)];
                let expected = expected.iter().find(|(name, _)| pattern.contains(name)).unwrap().1;
                assert_eq!(p.positions.len(), expected);
            }
        }
    }
}

#[test]
fn other_programs() {
    let Some(folder) = folder() else { return };
    let random = load(&folder.join("splashsurf/ParticleData_Random_1000.vtk"));
    assert_eq!(random.positions.len(), 1000);
    assert!(random.positions.as_flattened().iter().all(|c| (-1.0..=1.0).contains(c)));
    let block = load(&folder.join("splashsurf/fluid_250_particles.vtu"));
    assert!(block.velocities.is_some() && block.densities.is_some() && block.ids.is_some());
    let pysph = load(&folder.join("pysph/spheric2_fluid_01180.vtu"));
    assert_eq!(pysph.positions.len(), 23_760);
    // Arrays `u`, `v`, `w` and `rho`: the fastest particle is in a jet along x, and the density is
    // that of water.
    let fastest = pysph.velocities.unwrap().iter().map(|v| v[0]).fold(0.0, f32::max);
    assert!((fastest - 3.245_584).abs() < 1e-5, "{fastest}");
    assert!(pysph.densities.unwrap().iter().all(|d| (990.0..1016.0).contains(d)));
    let warp = load(&folder.join("warp_sph/frame_0112.npz"));
    assert_eq!(warp.positions.len(), 32_000);
    assert!(warp.velocities.is_some() && warp.densities.is_some());
    let [binary, text] = ["partio/test.bgeo", "partio/test.geo"].map(|f| load(&folder.join(f)));
    assert_eq!(binary.positions, text.positions);
    assert_eq!(binary.ids, Some(vec![0, 1, 2, 3, 4]));
    assert_eq!((text.ids, text.lifetimes), (binary.ids, None));
    assert_eq!(load(&folder.join("partio/base.bgeo")).positions, binary.positions);
}

/// Measured errors of the estimated spacing in percent. They may change by one percent.
#[test]
fn spacing_of_the_caches() {
    let Some(folder) = folder() else { return };
    let cases = [
        ("splashsurf/dam_break_frame_23_24389_particles.bgeo", 0.05, -4.4),
        ("splashsurf/dam_break_frame_9_6859_particles.bgeo", 0.05, 3.7),
        ("splashsurf/double_dam_break_frame_26_4732_particles.vtk", 0.05, 2.6),
        ("splashsurf/hilbert_46843_particles.bgeo", 0.05, 2.0),
        ("pysph/spheric2_fluid_01180.vtu", 0.03, 0.0),
        ("warp_sph/frame_0112.npz", 1.0, 1.0),
        ("bench/pool_65536.vtk", 0.02306, -0.3),
        ("big_dam/ParticleData_Fluid_46.bgeo", 0.025, 2.4),
        ("inflow/ParticleData_Fluid_120.bgeo", 0.05, 2.2),
        ("double_dam_pillar/ParticleData_Fluid_57.bgeo", 0.05, 1.4),
        ("double_dam_small/ParticleData_Fluid_13.bgeo", 0.05, 4.4),
        ("double_dam_small/ParticleData_Fluid_62.bgeo", 0.05, 4.3),
        // Two thirds of these particles are in the air.
        ("formats/dam27_uncompressed.bgeo", 0.05, 9.4),
    ];
    for (file, spacing, expected) in cases {
        let found = estimate_spacing(&load(&folder.join(file)).positions).unwrap();
        let error = 100.0 * (found / spacing - 1.0);
        println!("{file}: {found:.5} for {spacing}: {error:+.1} %");
        assert!((error - expected).abs() < 1.0, "{file}: {error:+.1} %, not {expected:+.1} %");
    }
}
