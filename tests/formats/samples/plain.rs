//! PLY, NPY, NPZ, and text tables.

use std::io::Write;
use whitewater::io::particles::{Extension, Format, Particles};

use super::{Has, Sample, densities, floats, ids, ints, positions, sample, velocities, words};

/// PLY, optionally with other elements before the vertices and a list property among the vertices'
/// properties.
pub fn ply(of: &Particles, format: &str, double: bool, lists: bool) -> Vec<u8> {
    let count = of.positions.len();
    let real = if double { "double" } else { "float32" };
    let mut out = format!("ply\nformat {format} 1.0\ncomment by hand\n");
    if lists {
        out += "element camera 2\nproperty uchar kind\nproperty list uchar float matrix\nelement empty 99999999999\n";
    }
    out += &format!("element vertex {count}\n");
    for name in ["x", "y", "z", "vx", "vy", "vz", "density"] {
        out += &format!("property {real} {name}\n");
    }
    if lists {
        out += "property list int short neighbours\n";
    }
    out += "property uint id\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n";
    let mut out = out.into_bytes();
    let (big, size) = (format.contains("big"), if double { 8 } else { 4 });
    if format == "ascii" {
        if lists {
            out.extend(b"1 2 0.5 0.5\n1 0\n");
        }
        for i in 0..count {
            let (p, v, d) = (positions(of)[i], velocities(of)[i], densities(of)[i]);
            let list = if lists { " 2 7 7" } else { "" };
            out.extend(format!("{} {} {d}{list} {}\n", words(p), words(v), ids(of)[i]).as_bytes());
        }
        return out;
    }
    if lists {
        out.extend([1, 2]);
        out.extend(floats(&[0.5, 0.5], 4, big));
        out.extend([1, 0]);
    }
    for i in 0..count {
        out.extend(floats(&positions(of)[i], size, big));
        out.extend(floats(&velocities(of)[i], size, big));
        out.extend(floats(&densities(of)[i..=i], size, big));
        if lists {
            out.extend(ints(&[1], 4, big));
            out.extend([9, 9]);
        }
        out.extend(ints(&ids(of)[i..=i], 4, big));
    }
    out
}

pub fn npy(descr: &str, shape: &str, fortran: bool, version: u8, raw: &[u8]) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let quote = if descr.starts_with('[') { "" } else { "'" };
    let header = format!(
        "{{'descr': {quote}{descr}{quote}, 'fortran_order': {order}, 'shape': {shape}, }}   \n"
    );
    let mut out = b"\x93NUMPY".to_vec();
    out.extend([version, 0]);
    if version == 1 {
        out.extend((header.len() as u16).to_le_bytes());
    } else {
        out.extend((header.len() as u32).to_le_bytes());
    }
    out.extend(header.as_bytes());
    out.extend(raw);
    out
}

pub fn npz(arrays: &[(&str, Vec<u8>)], deflate: bool) -> Vec<u8> {
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    let method =
        if deflate { zip::CompressionMethod::Deflated } else { zip::CompressionMethod::Stored };
    let options = zip::write::SimpleFileOptions::default().compression_method(method);
    for (name, bytes) in arrays {
        archive.start_file(format!("{name}.npy"), options).unwrap();
        archive.write_all(bytes).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

/// The values of the vectors, component by component.
pub fn columns(vectors: &[[f32; 3]]) -> Vec<f32> {
    (0..3).flat_map(|c| vectors.iter().map(move |v| v[c])).collect()
}

fn csv(of: &Particles, header: &str, separator: &str, quote: &str) -> String {
    let count = of.positions.len();
    let mut out = String::new();
    if !header.is_empty() {
        let names: Vec<_> = header.split(' ').map(|n| format!("{quote}{n}{quote}")).collect();
        out += &(names.join(separator) + "\r\n");
    }
    for i in 0..count {
        let row = format!(
            "{} {} {} {}",
            words(velocities(of)[i]),
            densities(of)[i],
            ids(of)[i],
            words(positions(of)[i])
        );
        out += &(row.replace(' ', separator) + "\r\n");
    }
    out
}

fn rows(of: &Particles) -> String {
    positions(of).iter().map(|p| words(p) + "\n").collect()
}

pub fn numpy_samples(list: &mut Vec<Sample>, of: &Particles) {
    let count = of.positions.len();
    let p = positions(of);
    let p = p.as_flattened();
    let shape = format!("({count}, 3)");
    let arrays = [
        ("<f4, C", npy("<f4", &shape, false, 1, &floats(p, 4, false))),
        (">f8, C, version 2", npy(">f8", &shape, false, 2, &floats(p, 8, true))),
        ("<f4, Fortran", npy("<f4", &shape, true, 1, &floats(&columns(positions(of)), 4, false))),
        (
            ">f4, Fortran, version 3",
            npy(">f4", &shape, true, 3, &floats(&columns(positions(of)), 4, true)),
        ),
    ];
    for (name, bytes) in arrays {
        list.push(sample(
            &format!("npy {name}"),
            Extension::Npy,
            bytes,
            Has::Positions,
            Format::Npy,
        ));
    }
    let row = format!("({count},)");
    let velocity = velocities(of);
    let common = [
        ("rho", npy("<f8", &row, false, 1, &floats(densities(of), 8, false))),
        ("ids", npy("<i8", &row, false, 1, &ints(ids(of), 8, false))),
        ("time", npy("<f8", "()", false, 1, &floats(&[0.5], 8, false))),
    ];
    for deflate in [false, true] {
        let mut arrays = common.to_vec();
        arrays.push(("pos", npy("<f4", &shape, false, 1, &floats(p, 4, false))));
        arrays.push((
            "vel",
            npy("<f8", &shape, false, 1, &floats(velocity.as_flattened(), 8, false)),
        ));
        list.push(sample(
            &format!("npz deflate {deflate}"),
            Extension::Npz,
            npz(&arrays, deflate),
            Has::All,
            Format::Npz,
        ));
    }
    let particle = |i: usize| {
        let mut row = floats(&positions(of)[i], 4, false);
        row.extend(floats(&velocity[i], 8, false));
        row.extend(floats(&densities(of)[i..=i], 4, false));
        row.extend(ints(&ids(of)[i..=i], 4, false));
        row
    };
    let raw: Vec<u8> = (0..of.positions.len()).flat_map(particle).collect();
    let descr = "[('pos', '<f4', (3,)), ('vel', '<f8', 3), ('rho', '<f4'), ('id', '<i4')]";
    let array = npy(descr, &row, false, 1, &raw);
    let zipped = npz(&[("particles", array.clone())], true);
    list.push(sample("npy, structured", Extension::Npy, array, Has::All, Format::Npy));
    list.push(sample("npz, structured", Extension::Npz, zipped, Has::All, Format::Npz));
    let mut arrays = common.to_vec();
    for (c, (pos, vel)) in [("x", "vx"), ("y", "vy"), ("z", "vz")].into_iter().enumerate() {
        let pick = |v: &[[f32; 3]]| floats(&v.iter().map(|v| v[c]).collect::<Vec<_>>(), 4, false);
        arrays.push((pos, npy("<f4", &row, false, 1, &pick(positions(of)))));
        arrays.push((vel, npy("<f4", &row, false, 1, &pick(velocity))));
    }
    list.push(sample(
        "npz of components",
        Extension::Npz,
        npz(&arrays, true),
        Has::All,
        Format::Npz,
    ));
}

pub fn text_samples(list: &mut Vec<Sample>, of: &Particles) {
    let count = of.positions.len();
    use Has::{All, Positions};
    let csvs = [
        (
            "paraview",
            "velocity:0 velocity:1 velocity:2 density id Points:0 Points:1 Points:2",
            ",",
            "\"",
        ),
        (
            "underscores",
            "Velocity_0 Velocity_1 Velocity_2 Density ID Points_0 Points_1 Points_2",
            ",",
            "",
        ),
        ("short", "vx vy vz rho particle_id x y z", ";", ""),
        ("uvw, tabs", "u v w densities ids X Y Z", "\t", ""),
        ("long", "velocity_x velocity_y velocity_z rho Index pos_x pos_y pos_z", ",", "\""),
    ];
    for (name, header, separator, quote) in csvs {
        list.push(sample(
            &format!("csv {name}"),
            Extension::Csv,
            csv(of, header, separator, quote),
            All,
            Format::Csv,
        ));
    }
    let dump = csv(of, "vx vy vz rho id x y z", " ", "");
    let (_, dump) = dump.split_once('\n').unwrap();
    let dump = format!(
        "ITEM: TIMESTEP\n8\nITEM: NUMBER OF ATOMS\n{count}\nITEM: BOX BOUNDS ff ff ff\n-9 9\n-9 9\n-9 9\n\
         ITEM: ATOMS vx vy vz rho id x y z\n{dump}"
    );
    list.push(sample("lammps", Extension::Unknown, dump, All, Format::Lammps));
    // A tilted box whose sides are powers of two: xlo 0, sides 4, 8 and 2, xy 1, xz -2, yz 0.5.
    let mut dump = format!(
        "ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS xy xz yz pp pp pp\n-2 5 1\n0 8.5 -2\n\
         0 2 0.5\nITEM: ATOMS id xs ys zs vx vy vz density\n",
        of.positions.len()
    );
    for i in 0..of.positions.len() {
        let [x, y, z] = positions(of)[i].map(f64::from);
        let c = z / 2.0;
        let b = (y - 0.5 * c) / 8.0;
        let a = (x - b + 2.0 * c) / 4.0;
        let ([vx, vy, vz], id, density) = (velocities(of)[i], ids(of)[i], densities(of)[i]);
        dump += &format!("{id} {a} {b} {c} {vx} {vy} {vz} {density}\n");
    }
    list.push(sample("lammps, scaled", Extension::Unknown, dump, All, Format::Lammps));
    let hashed = format!("# {}", csv(of, "vx vy vz rho id x y z", ",", ""));
    list.push(sample("csv with a hashed header", Extension::Csv, hashed, All, Format::Csv));
    let named_csv = csv(of, "vx vy vz rho id x y z", ",", "");
    list.push(sample("csv named .xyz", Extension::Xyz, named_csv, All, Format::Csv));
    list.push(sample(
        "csv without names",
        Extension::Csv,
        rows(of).replace(' ', ","),
        Positions,
        Format::Csv,
    ));
    list.push(sample("xyz", Extension::Xyz, rows(of), Positions, Format::Xyz));
    let variants = [
        ("with comments", format!("# x y z\n% more\n\n{}\n", rows(of))),
        ("with a count", format!("{count}\n{}", rows(of))),
        ("with a count and a comment", format!("{count}\ntime 0.5 s\n{}", rows(of))),
        ("with commas", rows(of).replace(' ', ", ")),
        ("with more columns", rows(of).replace('\n', " 9 9\n")),
        ("with a byte order mark", format!("\u{feff}{}", rows(of))),
    ];
    for (name, text) in variants {
        list.push(sample(&format!("xyz {name}"), Extension::Xyz, text, Positions, Format::Xyz));
    }
    let table = csv(of, "vx vy vz rho id x y z", "  ", "");
    list.push(sample("xyz with names", Extension::Xyz, table, All, Format::Xyz));
    let body = |separator| {
        let text = csv(of, "a b c d e f g h", separator, "").replace('\r', "");
        text.split_once('\n').unwrap().1.to_string()
    };
    let dialects = [
        (
            "csv of DualSPHysics",
            Extension::Csv,
            format!(
                "Np;Time\n11;0.5\n\nVel.x [m/s];Vel.y [m/s];Vel.z [m/s];Rhop [kg/m^3];Idp;Pos.x [m];Pos.y [m];Pos.z [m];\n{}",
                body(";").replace('.', ",").replace('\n', ";\n")
            ),
            Format::Csv,
        ),
        (
            "xyz, extended",
            Extension::Xyz,
            format!(
                "{count}\nProperties=velo:R:3:rho:R:1:id:I:1:pos:R:3:species:S:1 Time=0.5\n{}",
                body(" ").replace('\n', " H\n")
            ),
            Format::Xyz,
        ),
        (
            "text behind a hash",
            Extension::Text,
            format!("# vx vy vz rho id x y z\n{}", body("  ")),
            Format::Xyz,
        ),
        (
            "dump of LAMMPS",
            Extension::Unknown,
            format!(
                "ITEM: TIMESTEP\n5\nITEM: NUMBER OF ATOMS\n{count}\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n\
                 ITEM: ATOMS vx vy vz rho id x y z\n{}",
                body(" ")
            ),
            Format::Lammps,
        ),
    ];
    for (name, hint, text, format) in dialects {
        list.push(sample(name, hint, text, All, format));
    }
    let raw = floats(positions(of).as_flattened(), 4, false);
    list.push(sample("xyz raw", Extension::Xyz, raw, Positions, Format::RawF32));
    let array = |v: &[[f32; 3]]| {
        let rows: Vec<_> = v.iter().map(|p| format!("[{}]", words(p).replace(' ', ","))).collect();
        format!("[{}]", rows.join(", "))
    };
    let flat = |text: String| format!("[{}]", text.replace(' ', ", "));
    list.push(sample("json array", Extension::Json, array(positions(of)), Positions, Format::Json));
    let object = format!(
        "{{\"time\": 0.5, \"Positions\": {}, \"v\": {}, \"density\": {}, \"id\": {}, \"p\": [1]}}",
        array(positions(of)),
        array(velocities(of)),
        flat(words(densities(of))),
        flat(words(ids(of)))
    );
    list.push(sample("json object", Extension::Unknown, object, All, Format::Json));
}
