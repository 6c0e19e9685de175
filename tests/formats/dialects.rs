//! The same particles in the layouts and with the attribute names of common programs.

use super::folder::Folder;
use whitewater::io::particles::{
    Extension, Format, Meaning, Particles, Parts, read_bytes, read_step, steps,
};

fn read(text: &str, hint: Extension) -> Particles {
    read_bytes(text.as_bytes(), hint).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn error(text: &str, hint: Extension, parts: &[&str]) -> String {
    let error = match read_bytes(text.as_bytes(), hint) {
        Ok(p) => panic!("{} particles read of\n{text}", p.positions.len()),
        Err(e) => e.to_string(),
    };
    for part in parts {
        assert!(error.contains(part), "`{part}` is not in: {error}");
    }
    error
}

/// Two particles with eight columns: position, velocity, id, density.
const ROWS: [[f64; 8]; 2] =
    [[1.5, 2.5, -3.0, 0.25, -0.5, 4.0, 7.0, 998.5], [10.0, 0.125, 2.0, 1.0, 2.0, 3.0, 8.0, 1001.0]];

/// Asserts that position, velocity, id and density were read, without warnings.
fn check(name: &str, p: &Particles) {
    let all = |column: usize| ROWS.map(|row| [0, 1, 2].map(|k| row[column + k] as f32));
    assert_eq!(p.positions, all(0), "{name}");
    assert_eq!(p.velocities.as_deref(), Some(&all(3)[..]), "{name}");
    assert_eq!(p.ids.as_deref(), Some(&ROWS.map(|row| row[6] as u32)[..]), "{name}");
    assert_eq!(p.densities.as_deref(), Some(&ROWS.map(|row| row[7] as f32)[..]), "{name}");
    assert!(p.warnings.is_empty(), "{name}: {:?}", p.warnings);
}

/// The two rows as text with this separator between numbers and this end of line.
fn rows(separator: &str, end: &str) -> String {
    let line = |row: &[f64; 8]| {
        let words: Vec<_> = row.iter().map(f64::to_string).collect();
        words.join(separator) + end
    };
    ROWS.iter().map(line).collect()
}

/// Names of the eight columns as programs write them.
const NAMES: [(&str, [&str; 8]); 22] = [
    ("plain", ["x", "y", "z", "vx", "vy", "vz", "id", "rho"]),
    ("sphsol", ["X", "Y", "Z", "VX", "VY", "VZ", "ID", "DENSITY"]),
    (
        "DualSPHysics",
        [
            "Pos.x [m]",
            "Pos.y [m]",
            "Pos.z [m]",
            "Vel.x [m/s]",
            "Vel.y [m/s]",
            "Vel.z [m/s]",
            "Idp",
            "Rhop [kg/m^3]",
        ],
    ),
    ("ParaView", ["Points:0", "Points:1", "Points:2", "Vel:0", "Vel:1", "Vel:2", "Idp", "Rhop"]),
    ("ParaView 5.10", ["Points_0", "Points_1", "Points_2", "U_0", "U_1", "U_2", "origId", "rho"]),
    ("taichi", ["x", "y", "z", "v_1", "v_2", "v_3", "id", "density"]),
    ("pandas", ["pos_0", "pos_1", "pos_2", "vel_0", "vel_1", "vel_2", "particle_id", "density"]),
    (
        "yt",
        [
            "particle_position_x",
            "particle_position_y",
            "particle_position_z",
            "particle_velocity_x",
            "particle_velocity_y",
            "particle_velocity_z",
            "particle_index",
            "particle_density",
        ],
    ),
    (
        "OVITO",
        [
            "Position.X",
            "Position.Y",
            "Position.Z",
            "Velocity.X",
            "Velocity.Y",
            "Velocity.Z",
            "Particle Identifier",
            "Density",
        ],
    ),
    ("GPUSPH", ["x", "y", "z", "Velocity[0]", "Velocity[1]", "Velocity[2]", "Part id", "Density"]),
    (
        "SPHinXsys",
        [
            "Position (0)",
            "Position (1)",
            "Position (2)",
            "Velocity (0)",
            "Velocity (1)",
            "Velocity (2)",
            "OriginalParticle_ID",
            "Density",
        ],
    ),
    ("of one letter", ["x (m)", "y (m)", "z (m)", "u (m/s)", "v (m/s)", "w (m/s)", "ID", "rho"]),
    ("with units", ["x[mm]", "y[mm]", "z[mm]", "ux", "uy", "uz", "gid", "rho_p"]),
    ("as words", ["X", "Y", "Z", "Vel X", "Vel Y", "Vel Z", "Global ID", "Mass Density"]),
    (
        "axis first",
        ["X_coord", "Y_coord", "Z_coord", "X_vel", "Y_vel", "Z_vel", "Particle_Number", "Dens"],
    ),
    (
        "Fluent",
        [
            "x-coordinate",
            "y-coordinate",
            "z-coordinate",
            "x-velocity",
            "y-velocity",
            "z-velocity",
            "atom id",
            "ρ [kg/m³]",
        ],
    ),
    ("maps", ["Easting", "Northing", "Elevation", "Speed_X", "Speed_Y", "Speed_Z", "label", "rho"]),
    (
        "STAR-CCM+",
        [
            "X (m)",
            "Y (m)",
            "Z (m)",
            "Track: Parcel Velocity[i] (m/s)",
            "Track: Parcel Velocity[j] (m/s)",
            "Track: Parcel Velocity[k] (m/s)",
            "Parcel Index",
            "Density (kg/m^3)",
        ],
    ),
    (
        "Rocky",
        [
            "Particle : X-Coordinate [m]",
            "Particle : Y-Coordinate [m]",
            "Particle : Z-Coordinate [m]",
            "Particle : Translational Velocity : X [m/s]",
            "Particle : Translational Velocity : Y [m/s]",
            "Particle : Translational Velocity : Z [m/s]",
            "Particle : ID",
            "Density [kg/m3]",
        ],
    ),
    (
        "CFX",
        [
            "X [ m ]",
            "Y [ m ]",
            "Z [ m ]",
            "Velocity u [ m s^-1 ]",
            "Velocity v [ m s^-1 ]",
            "Velocity w [ m s^-1 ]",
            "Node Number",
            "Density [ kg m^-3 ]",
        ],
    ),
    ("Houdini", ["P.x", "P.y", "P.z", "v.x", "v.y", "v.z", "@id", "density"]),
    ("r", ["rx", "ry", "rz", "dx/dt", "dy/dt", "dz/dt", "pid", "rho"]),
];

#[test]
fn names_of_columns() {
    for (name, names) in NAMES {
        let text = format!("{}\n{}", names.join(","), rows(",", "\n"));
        check(name, &read(&text, Extension::Csv));
        // Names after `#`, below comments, with a separator at the end of each line, and in quotes.
        let above = "# solver: example 1.2\n#\n# time = 0.32 s\n\n";
        let text = format!("{above}# {}\n{}", names.join(","), rows(", ", "\n"));
        check(name, &read(&text, Extension::Csv));
        let text = format!("{}; \r\n{}", names.join(";"), rows(";", ";\r\n"));
        check(name, &read(&text, Extension::Csv));
        let quoted = names.map(|name| format!("\"{name}\""));
        let text = format!("{above}{}\n{}", quoted.join(", "), rows(", ", "\n"));
        check(name, &read(&text, Extension::Csv));
        check(name, &read(&text, Extension::Xyz));
        let text = format!("{}\n{}", quoted.join("\t"), rows("\t", "\n"));
        check(name, &read(&text, Extension::Csv));
        // Names separated by spaces.
        if !names.iter().any(|name| name.contains(' ') && !name.contains(['[', '('])) {
            for hint in [Extension::Csv, Extension::Xyz, Extension::Text] {
                let text = format!("{above}# {}\n{}", names.join("  "), rows("   ", "\n"));
                check(name, &read(&text, hint));
                let text = format!("{}\n{}", names.join(" "), rows(" ", "\n"));
                check(name, &read(&text, hint));
            }
        }
    }
}

#[test]
fn names_of_arrays() {
    for (position, velocity) in [
        ("pos", "vel"),
        ("P", "v"),
        ("x_p", "v_p"),
        ("particle_positions", "particle_velocities"),
        ("Coordinates", "Velocities"),
        ("points", "U"),
        ("location", "u"),
        ("position", "linVelVec"),
    ] {
        let text = format!("{{\"{position}\":[[1,2,3],[4,5,6]],\"{velocity}\":[[0,1,0],[1,0,0]]}}");
        let p = read(&text, Extension::Json);
        assert_eq!(p.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], "{position}");
        assert_eq!(p.velocities, Some(vec![[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]), "{velocity}");
    }
    // Columns with another meaning: normals, a component of a tensor, a process number.
    let p =
        read("x,y,z,nx,ny,nz,sxx,origProc,Points_Magnitude\n1,2,3,0,0,1,5,3,4\n", Extension::Csv);
    assert_eq!((p.velocities, p.ids, p.densities), (None, None, None));
}

#[test]
fn head_lines_of_other_kinds_are_passed_over_and_told() {
    let head = "TimeStep;Np;Nbound\n0.32;2;0\n\n";
    let names = NAMES[2].1.join(";");
    let mut p = read(&format!("{head}{names};\n{}", rows(";", ";\n")), Extension::Csv);
    assert_eq!(p.warnings.len(), 1);
    assert!(p.warnings[0].contains("2 lines above"), "{:?}", p.warnings);
    p.warnings.clear();
    check("head lines", &p);
    // Section names in brackets are not JSON.
    let cfx = "X [ m ], Y [ m ], Z [ m ]";
    let text = format!("\n[Name]\nwater\n\n[Data]\n{cfx}\n1, 2, 3\n4, 5, 6\n");
    let p = read(&text, Extension::Csv);
    assert_eq!(p.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    assert!(p.warnings[0].contains("3 lines above"), "{:?}", p.warnings);
    // A line of units or a ruler below the names.
    for (names, below, separator) in [
        ("x,y,z,id", "m,m,m,-", ","),
        ("x,y,z,id", "[m],[m],[m],", ","),
        ("x;y;z;id", "mm;mm;mm;", ";"),
        ("| x | y | z | id |", "|---|---|---|---|", " | "),
    ] {
        let edge = if separator == " | " { "|" } else { "" };
        let row = |n: u8| {
            let numbers = [1, 2, 3, n].map(|c| c.to_string()).join(separator);
            format!("{edge}{numbers}{edge}\n")
        };
        let p = read(&format!("{names}\n{below}\n{}{}", row(7), row(8)), Extension::Csv);
        assert_eq!((p.positions, p.ids), (vec![[1.0, 2.0, 3.0]; 2], Some(vec![7, 8])), "{names}");
    }
    // PLY files that name the element `point` instead of `vertex`.
    let ply = "ply\nformat ascii 1.0\nelement point 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    assert_eq!(read(&format!("{ply}1 2 3\n4 5 6\n"), Extension::Ply).positions.len(), 2);
    // Any number of comments may precede the names.
    let comments: String = (0..200).map(|i| format!("# line {i} of the log\n")).collect();
    let p = read(&format!("{comments}x,y,z\n1,2,3\n"), Extension::Csv);
    assert_eq!((p.positions, p.warnings.len()), (vec![[1.0, 2.0, 3.0]], 0));
    // Several tables in one file.
    let again = "x,y,z\n1,2,3\n4,5,6\nx,y,z\n1,2,3\n";
    error(again, Extension::Csv, &["several frames (the second begins in line 4)"]);
    for text in [
        "x,y,z\n1,2,3\n4,5,6\na,b,c\n1,2,3\n",
        "TIMESTEP, 0.1\nx,y,z\n1,2,3\n4,5,6\nTIMESTEP, 0.2\nx,y,z\n1,2,3\n",
    ] {
        error(
            text,
            Extension::Csv,
            &["several parts (another one begins in line", "one file per frame"],
        );
    }
    error(
        "time,x1,y1,z1,x2,y2,z2\n0,1,2,3,4,5,6\n",
        Extension::Csv,
        &["three columns for each particle", "time,x,y,z"],
    );
    // A column whose cells contain vectors is reported by its name.
    for row in ["7,\"(0.1, 0.2, 0.3)\"", "7,\"[0.1 0.2 0.3]\""] {
        let text = format!("id,position\n{row}\n{row}\n");
        error(&text, Extension::Csv, &["vector in each cell of column `position`", "x,y,z"]);
    }
    // A comment that contains the words of column names is not a header.
    let p = read("# x and y are in metres\n1 2 3\n4 5 6\n", Extension::Xyz);
    assert_eq!((p.positions.len(), p.warnings.len()), (2, 0));
    // Errors name the line in the file.
    error(&format!("{head}{names}\n1;2;3;4;5;6;7;x\n"), Extension::Csv, &["line 5", "Rhop"]);
    error(
        &format!("{head}{names}\n{}1;2;3\n", rows(";", "\n")),
        Extension::Csv,
        &["line 7", "8 fields"],
    );
    let error_of = error("a|b|c\nd|e|f\n", Extension::Csv, &["line of names"]);
    assert!(!error_of.contains("damaged"), "{error_of}");
    let p = read("x|y|z\n1|2|3\n", Extension::Csv);
    assert_eq!(p.positions, [[1.0, 2.0, 3.0]]);
    // If no column is a position, the error lists the columns.
    error("a,b,c\n1,2,3\n", Extension::Csv, &["expected positions", "a: 1 x number, b"]);
}

#[test]
fn decimal_commas_where_others_separate() {
    let german = |separator: &str| rows(separator, "\n").replace('.', ",");
    let names = NAMES[2].1;
    check("semicolons", &read(&format!("{}\n{}", names.join(";"), german(";")), Extension::Csv));
    check("tabs", &read(&format!("{}\n{}", names.join("\t"), german("\t")), Extension::Csv));
    check("blanks", &read(&format!("# {}\n{}", names.join(" "), german(" ")), Extension::Xyz));
    let p = read("0,5 1 2,25\n1 2 3\n", Extension::Xyz);
    assert_eq!(p.positions, [[0.5, 1.0, 2.25], [1.0, 2.0, 3.0]]);
    let p = read("1 2 3\n0,5 1 2,25\n", Extension::Xyz);
    assert_eq!(p.positions[1], [0.5, 1.0, 2.25]);
    // Commas as separators.
    let p = read("1, 2,\t3\n4, 5,\t6\n", Extension::Xyz);
    assert_eq!(p.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
}

#[test]
fn text_in_other_encodings() {
    let text = format!("{}\r\n{}", NAMES[2].1.join(";"), rows(";", "\r\n"));
    let units: Vec<u16> = std::iter::once(0xfeff).chain(text.encode_utf16()).collect();
    for big in [false, true] {
        let bytes: Vec<u8> = units
            .iter()
            .flat_map(|u| if big { u.to_be_bytes() } else { u.to_le_bytes() })
            .collect();
        check("UTF-16", &read_bytes(&bytes, Extension::Csv).unwrap());
        check("UTF-16 without its mark", &read_bytes(&bytes[2..], Extension::Csv).unwrap());
    }
    check("a mark", &read(&format!("\u{feff}{text}"), Extension::Csv));
    // Latin-1: a superscript in a unit.
    let bytes: Vec<u8> = text.replace("^3", "\u{b3}").chars().map(|c| c as u32 as u8).collect();
    for hint in [Extension::Csv, Extension::Xyz, Extension::Text] {
        check("Latin-1", &read_bytes(&bytes, hint).unwrap());
    }
}

#[test]
fn doubles_of_fortran() {
    let p = read("  1.5D+00   2.5d-01  -3.0D0\n", Extension::Text);
    assert_eq!(p.positions, [[1.5, 0.25, -3.0]]);
    // An exponent of three digits has no letter.
    let p = read("1.404768-100 1.5+002 -2.5-001\n", Extension::Text);
    assert_eq!(p.positions, [[0.0, 150.0, -0.25]]);
    error("x,y,z\n1,2,2024-100\n", Extension::Csv, &["`z`", "2024-100"]);
    // A number that does not fit its field.
    let text = "x y z\n1.25 2.5 3.75\n1.25 ******* 3.75\n";
    error(text, Extension::Text, &["column 2 (`y`)", "\"*******\"", "line 3"]);
    error("x y z\n1 2 3\n1 2\n", Extension::Text, &["3 values", "found 2 in \"1 2\"", "line 3"]);
}

#[test]
fn empty_fields_at_the_end_of_the_first_row() {
    for row in ["1,2,3,,,", "1,2,3,,,,", "1,2,3,4,,", "1,2,3,4,5,"] {
        let p = read(&format!("x,y,z,vx,vy,vz\n{row}\n4,5,6,7,8,9\n"), Extension::Csv);
        assert_eq!(p.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], "{row}");
        let velocities = p.velocities.unwrap();
        assert!(velocities[0][2].is_nan() && velocities[1] == [7.0, 8.0, 9.0], "{row}");
        let [told] = &p.warnings[..] else { panic!("{row}: {:?}", p.warnings) };
        assert!(told.contains("1 of 2 velocities are missing"), "{row}: {told}");
    }
}

#[test]
fn two_dimensions_are_told() {
    for (text, expected) in [
        ("x,y,vx,vy\n1,2,3,4\n", ([1.0, 2.0, 0.0], [3.0, 4.0, 0.0])),
        ("x,z,vx,vz\n1,2,3,4\n", ([1.0, 0.0, 2.0], [3.0, 0.0, 4.0])),
    ] {
        let p = read(text, Extension::Csv);
        assert_eq!((p.positions[0], p.velocities.unwrap()[0]), expected);
        assert!(p.warnings[0].contains("two components"), "{:?}", p.warnings);
    }
    let p = read("{\"position\":[[1,2]],\"velocity\":[[3,4]]}", Extension::Json);
    assert_eq!(p.positions, [[1.0, 2.0, 0.0]]);
    assert_eq!(p.velocities, Some(vec![[3.0, 4.0, 0.0]]));
}

#[test]
fn elements_of_counted_xyz() {
    let expected = [[1.0, 2.5, 3.0], [4.0, 5.0, 6.0]];
    for text in [
        "2\nframe 8\nO 1 2.5 3\nH 4 5 6\n",
        "2\n1 2.5 3\n4 5 6\n",
        "2\n\n1 2.5 3\n4 5 6\n",
        "O 1 2.5 3\nH 4 5 6\n",
        // A comment of numbers: the sides of a box.
        "2\n10 10 10\nO 1 2.5 3\nH 4 5 6\n",
        "# made by hand\n  2\nx y z\n1 2.5 3\n4 5 6\n",
    ] {
        let p = read(text, Extension::Xyz);
        assert_eq!(p.positions, expected, "{text}");
        assert!(p.warnings.is_empty(), "{text}: {:?}", p.warnings);
        assert_eq!(p.format, Format::Xyz);
    }
    let p = read("2\n\nO 1 2.5 3 0.1 0.2 0.3\nH 4 5 6 0.1 0.2 0.3\n", Extension::Xyz);
    assert_eq!(p.positions, expected);
    assert!(p.warnings[0].contains("element"), "{:?}", p.warnings);
    // Whole numbers may be elements or coordinates, which is told.
    for text in ["2\n\n1 1 2.5 3\n1 4 5 6\n", "2\nAtoms. Timestep: 0\n12 1 2.5 3\n7 4 5 6\n"] {
        let p = read(text, Extension::Xyz);
        assert_eq!(p.positions, expected, "{text}");
        assert!(p.warnings[0].contains("whole numbers, is taken as the element"), "{text}");
    }
    // No element has the number 0.
    let p = read("3\n\n0 1 2 1.5\n1 0 2 2.5\n1 1 2 4.5\n", Extension::Xyz);
    assert_eq!(p.positions, [[0.0, 1.0, 2.0], [1.0, 0.0, 2.0], [1.0, 1.0, 2.0]]);
    assert!(p.warnings[0].contains("the first 3 of 4 columns"), "{:?}", p.warnings);
}

/// A row with too many numbers is refused; a comment may follow the numbers.
#[test]
fn rows_that_are_too_long_are_refused() {
    for head in ["", "x y z\n", "2\n\n"] {
        let parts = ["3 values in each line", "found 6 in \"4 5 6 7 8 9\""];
        let error = error(&format!("{head}1 2 3\n4 5 6 7 8 9\n"), Extension::Xyz, &parts);
        assert!(!error.contains("cut off"), "{error}");
    }
    let p = read("1 2 3\n4 5 6 # 7\n7 8 9 // last 1\n1 1 1 ! 8\n", Extension::Xyz);
    assert_eq!(p.positions[1..], [[4.0, 5.0, 6.0], [7.0, 8.0, 9.0], [1.0; 3]]);
}

#[test]
fn blank_lines_of_tables_are_skipped() {
    for blank in ["   ", " \t"] {
        let text = format!("x,y,z,id\n0,0,0,1\n{blank}\n1,0,0,2\n{blank}");
        for text in [text.clone(), text + "\n"] {
            let p = read(&text, Extension::Csv);
            assert_eq!((p.positions.len(), p.ids), (2, Some(vec![1, 2])), "{text}");
        }
    }
    // The last line that is not blank may be cut off.
    let parts = ["4 fields", "found 2 in line 3", "the last line"];
    error("x,y,z,id\n0,0,0,1\n1,0\n   \n", Extension::Csv, &parts);
}

#[test]
fn extended_xyz() {
    let text = "2\nLattice=\"2 0 0 0 1 0 0 0 1\" Properties=species:S:1:id:I:1:pos:R:3:velo:R:3:rho:R:1 \
                Time=0.32\nH 7 1.5 2.5 -3 0.25 -0.5 4 998.5\nO 8 10 0.125 2 1 2 3 1001\n";
    check("extended", &read(text, Extension::Xyz));
    check("extended", &read(&text.replace("species:S", "flag:L"), Extension::Text));
}

#[test]
fn several_frames_of_xyz_are_refused() {
    let frame = "2\nframe\nO 1 2 3\nO 4 5 6\n";
    error(&frame.repeat(3), Extension::Xyz, &["several frames", "line 5", "one file per frame"]);
    let error =
        error("2\n\nO 1 2 3\nO 4 5 6\nO 7 8 9\n", Extension::Xyz, &["expected 2", "found 3"]);
    assert!(!error.contains("damaged"), "{error}");
}

#[test]
fn dumps_of_lammps() {
    let dump = |step: u32, names: &str| {
        format!(
            "ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff mm\n0 2\n0 1\n0 1\n\
             ITEM: ATOMS {names}\n{}",
            rows(" ", " \n")
        )
    };
    for names in ["x y z vx vy vz id rho", "xu yu zu vx vy vz id rho"] {
        for hint in [Extension::Unknown, Extension::Text, Extension::Xyz] {
            let p = read(&dump(800, names), hint);
            check(names, &p);
            assert_eq!(p.format, Format::Lammps);
        }
    }
    let units = "ITEM: UNITS\nsi\nITEM: TIME\n0.32\n";
    check(
        "units",
        &read(&(units.to_string() + &dump(1, "x y z vx vy vz id rho")), Extension::Unknown),
    );
    let two = dump(800, "x y z vx vy vz id rho") + &dump(900, "x y z vx vy vz id rho");
    error(&two, Extension::Unknown, &["several frames", "line 12"]);
    // Coordinates relative to the sides of the box, which have lengths 2, 1 and 1.
    let scaled = read(&dump(1, "xs ys zs vx vy vz id rho"), Extension::Unknown);
    assert_eq!(scaled.positions, [[3.0, 2.5, -3.0], [20.0, 0.125, 2.0]]);
    let moved = dump(1, "zsu vx xsu vy ysu vz id rho").replace("mm\n0 2", "mm\n-1 3");
    assert_eq!(read(&moved, Extension::Unknown).positions[0], [-13.0, -0.5, 1.5]);
    let cut = dump(800, "x y z vx vy vz id rho");
    error(
        cut.trim_end().rsplit_once('\n').unwrap().0,
        Extension::Unknown,
        &["expected 2", "found 1"],
    );
}

/// Boxes with edges in any directions, and what is told where scaled positions cannot be found.
#[test]
fn scaled_dumps_of_lammps() {
    let dump = |bounds: &str, atoms: &str| {
        format!(
            "ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS {bounds}\nITEM: ATOMS {atoms}\n"
        )
    };
    let positions = |text: &str| read(text, Extension::Unknown).positions;
    // xlo 1, ylo -2, zlo 3; sides 4, 8 and 2; xy 1, xz -2, yz 0.5. The bounds in the file enclose
    // that box: x from 1 - 2 to 5 + 1, y from -2 to 6 + 0.5.
    let tilted = "xy xz yz pp pp ff\n-1 6 1\n-2 6.5 -2\n3 5 0.5";
    let rows = "1 0.5 0.25 0.5\n2 0 1 -1";
    // 1 + 0.5 * 4 + 0.25 * 1 - 0.5 * 2, -2 + 0.25 * 8 + 0.5 * 0.5, 3 + 0.5 * 2; and
    // 1 + 1 + 2, -2 + 8 - 0.5, 3 - 2.
    let expected = [[2.25, 0.25, 4.0], [4.0, 5.5, 1.0]];
    for names in ["id xs ys zs", "id xsu ysu zsu"] {
        assert_eq!(positions(&dump(tilted, &format!("{names}\n{rows}"))), expected, "{names}");
    }
    let turned = "zs id ys xs\n0.5 1 0.25 0.5\n-1 2 1 0";
    assert_eq!(positions(&dump(tilted, turned)), expected);
    // Edges (2, 0, 1), (0, 3, -1) and (1, 1, 4); origin (10, 20, 30):
    // 10 + 0.5 * 2 + 0.5 * 1, 20 + 0.25 * 3 + 0.5 * 1, 30 + 0.5 * 1 - 0.25 + 0.5 * 4; and
    // 10 - 1, 20 + 3 - 1, 30 - 1 - 4.
    let general = "abc origin pp pp pp\n2 0 1 10\n0 3 -1 20\n1 1 4 30";
    let expected = [[11.5, 21.25, 32.25], [9.0, 22.0, 25.0]];
    assert_eq!(positions(&dump(general, &format!("id xs ys zs\n{rows}"))), expected);
    // A tilt by both: the enclosing box is larger by their sum. xlo 0, side 4, xy 1, xz 2.
    let both = dump("xy xz yz pp pp pp\n0 7 1\n0 1 2\n0 1 0", "xs ys zs\n1 0 0\n0 1 1");
    assert_eq!(positions(&both), [[4.0, 0.0, 0.0], [3.0, 1.0, 1.0]]);
    // What is not scaled is as it is, in any box, and comes first.
    for (bounds, names) in
        [(tilted, "xu yu zu"), (general, "x y z"), ("xy xz yz pp pp pp\n0 1\nnone\n0 1", "x y z")]
    {
        let found =
            positions(&dump(bounds, &format!("{names} xs ys zs\n1 2 3 0 0 0\n4 5 6 0 0 0")));
        assert_eq!(found, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], "{names}");
    }
    // Axes may differ, as far as the edges do not reach along others.
    let straight = "pp pp pp\n0 2\n-1 1\n0 10";
    assert_eq!(positions(&dump(straight, "x yu zs\n1 2 0.5\n3 4 1"))[0], [1.0, 2.0, 5.0]);
    assert_eq!(positions(&dump(straight, "xs ys\n1 0.5\n3 4"))[0], [2.0, 0.0, 0.0]);
    let flat = "xy xz yz pp pp pp\n0 3 1\n0 1 0\n-1 1 0";
    assert_eq!(positions(&dump(flat, "xs ys\n1 0.5\n3 4"))[0], [2.5, 0.5, 0.0]);
    for (bounds, atoms, told) in [
        (tilted, "xs ys z\n1 1 1\n1 1 1", ["some axes only (xs ys, and not z)", "dump x y z"]),
        (tilted, "xs ys\n1 1\n1 1", ["some axes only (xs ys)", "in a tilted box"]),
        (
            "xy xz yz pp pp pp\n0 2\n0 1\n0 1",
            "xs ys zs\n1 1 1\n1 1 1",
            ["both ends and the tilt", "\"0 2\" in line 6"],
        ),
        (
            "pp pp pp\n0 2\n0 1 4\n0 1",
            "xs ys zs\n1 1 1\n1 1 1",
            ["both ends of each side", "\"0 1 4\" in line 7"],
        ),
        (
            "abc origin pp pp pp\n1 0 0 0\n0 1 0 0\n0 0 1",
            "xs ys zs\n1 1 1\n1 1 1",
            ["an edge of the box", "\"0 0 1\" in line 8"],
        ),
        (
            "xy xz yz pp pp pp\n0 inf 0\n0 1 0\n0 1 0",
            "xs ys zs\n1 1 1\n1 1 1",
            ["both ends and the tilt", "0 inf 0"],
        ),
    ] {
        error(&dump(bounds, atoms), Extension::Unknown, &told);
    }
    let none = dump(straight, "xs ys zs\n1 1 1\n1 1 1");
    let (head, rest) = none.split_once("ITEM: BOX").unwrap();
    let rest = rest.split_once("ITEM: ATOMS").unwrap().1;
    let told = ["scaled positions without `ITEM: BOX BOUNDS`"];
    error(&format!("{head}ITEM: ATOMS{rest}"), Extension::Unknown, &told);
}

#[test]
fn ids_that_repeat_are_dropped_and_told() {
    let table = |id: &dyn Fn(usize) -> usize| {
        let rows: String = (0..500).map(|i| format!("{i},0,0,{}\n", id(i))).collect();
        read(&format!("x,y,z,Idp\n{rows}"), Extension::Csv)
    };
    for id in [&(|_: usize| 0_usize) as &dyn Fn(usize) -> usize, &|i| i % 250, &|i| i / 2] {
        let p = table(id);
        assert_eq!(p.ids, None);
        assert!(p.warnings[0].contains("`Idp` is dropped"), "{:?}", p.warnings);
    }
    // A single duplicate id is no reason to drop the ids.
    for id in [&(|i: usize| i + 7) as &dyn Fn(usize) -> usize, &|i| i.max(1)] {
        let p = table(id);
        assert!(p.ids.is_some() && p.warnings.is_empty(), "{:?}", p.warnings);
    }
}

#[test]
fn copies_at_the_same_place_keep_their_ids() {
    for (count, times) in [(300, 4), (30_000, 3)] {
        let block: String = (0..count).map(|i| format!("{i},{},0,{i}\n", i % 7)).collect();
        let p = read(&format!("x,y,z,id\n{}", block.repeat(times)), Extension::Csv);
        assert!(p.ids.is_some() && p.warnings.len() == 1, "{:?}", p.warnings);
    }
}

#[test]
fn ids_that_repeat_are_found_among_many() {
    let positions: String = (0..60_000).map(|i| format!("{i},0,0,{}\n", i % 40_000)).collect();
    let p = read(&format!("x,y,z,id\n{positions}"), Extension::Csv);
    assert_eq!(p.ids, None);
    assert!(p.warnings[0].contains("33 %"), "{:?}", p.warnings);
}

#[test]
fn positions_that_are_there_more_than_once_are_told() {
    let rows = |times: usize| {
        let block: String = (0..300).map(|i| format!("{i} {} 0\n", i % 7)).collect();
        read(&block.repeat(times), Extension::Xyz)
    };
    assert!(rows(1).warnings.is_empty());
    let p = rows(4);
    assert_eq!(p.positions.len(), 1200);
    assert!(
        p.warnings[0].contains("75 %") && p.warnings[0].contains("up to 4"),
        "{:?}",
        p.warnings
    );
}

#[test]
fn doubles_far_from_the_origin_lose_nothing() {
    let far = [403_000.25, 3_604_900.5, 120.125];
    let at = |i: usize, moved: f64| {
        let c = [i % 10, i / 10 % 10, i / 100].map(|c| 0.0625 * c as f64);
        [0, 1, 2].map(|k| far[k] + c[k] + moved)
    };
    let frame = |moved: f64| {
        let row = |i| at(i, moved).map(|c| c.to_string()).join(",");
        let rows: Vec<_> = (0..1000).map(row).collect();
        read(&format!("x,y,z\n{}\n", rows.join("\n")), Extension::Csv)
    };
    let (first, second) = (frame(0.0), frame(0.5));
    for (p, moved) in [(&first, 0.0), (&second, 0.5)] {
        assert_ne!(p.origin, [0.0; 3]);
        for (i, found) in p.positions.iter().enumerate() {
            let there = [0, 1, 2].map(|k| f64::from(found[k]) + p.origin[k]);
            assert_eq!(there, at(i, moved), "the grid of 32-bit floats has all of these");
        }
        assert_eq!(p.warnings.len(), 1, "{:?}", p.warnings);
        assert!(p.warnings[0].contains("is subtracted from"), "{:?}", p.warnings);
    }
    assert_eq!(first.origin, second.origin, "one for a sequence");
    let mut moved = first.clone();
    moved.move_to([403_000.0, 3_604_900.0, 100.0]);
    assert_eq!(moved.positions[0], [0.25, 0.5, 20.125]);
    // Positions near the origin are not moved.
    let near = read("x,y,z\n100,0,0\n101,1,1\n", Extension::Csv);
    assert_eq!((near.origin, near.positions[0]), ([0.0; 3], [100.0, 0.0, 0.0]));
}

#[test]
fn several_steps_in_one_table_are_refused() {
    let table = |names: &str, row: &dyn Fn(usize, usize) -> String| {
        let step = |t| (0..20).map(move |i| row(t, i)).collect::<String>();
        format!("{names}\n{}", (0..3).map(step).collect::<String>())
    };
    // Frames one after the other, and the frames of each particle one after the other.
    let text = table("time,x,y,z", &|t, i| format!("{},{i},{t},0\n", 0.5 * t as f64));
    error(&text, Extension::Csv, &["3 frames", "`time` goes from 0 to 1", "one file per frame"]);
    let text = table("id,TimeStep,x,y,z", &|t, i| format!("{i},{t},{i},0,0\n"));
    error(&text, Extension::Csv, &["3 frames", "TimeStep"]);
    let rows: String =
        (0..20).flat_map(|i| (0..3).map(move |t| format!("{i} {t} {i} 0 0\n"))).collect();
    error(&format!("# id frame x y z\n{rows}"), Extension::Xyz, &["3 frames", "frame"]);
    // If all rows have one time, it is the time of the frame. If the ids show that each row is
    // another particle, times that differ are an attribute of the particles.
    let text = table("time,x,y,z,id", &|t, i| format!("0.25,{i},{t},0,{}\n", 100 * t + i));
    assert_eq!(read(&text, Extension::Csv).time, Some(0.25));
    let text = table("time,x,y,z,id", &|t, i| format!("{t},{i},{t},0,{}\n", 100 * t + i));
    assert_eq!(read(&text, Extension::Csv).time, None);
    let text = table("time,x,y,z", &|t, i| format!("12:0{t}:00,{i},0,{t}\n"));
    assert_eq!(read(&text, Extension::Csv).positions.len(), 60);
}

#[test]
fn lines_of_old_macs_and_vectors_in_brackets() {
    let text = format!("x,y,z,vx,vy,vz,id,rho\n{}", rows(",", "\n"));
    check("carriage returns", &read(&text.replace('\n', "\r"), Extension::Csv));
    let vectors: String = ROWS.map(|[x, y, z, ..]| format!("({x} {y}, {z})\n")).concat();
    let p = read(&vectors, Extension::Xyz);
    assert_eq!(p.positions, ROWS.map(|row| [0, 1, 2].map(|k| row[k] as f32)));
}

/// Positions in any coordinate plane, and words in place of numbers for the kind.
#[test]
fn two_axes_and_words() {
    for (names, expected) in
        [("x,y", [1.0, 2.0, 0.0]), ("x,z", [1.0, 0.0, 2.0]), ("y,z", [0.0, 1.0, 2.0])]
    {
        let p = read(&format!("{names}\n1,2\n"), Extension::Csv);
        assert_eq!(p.positions, [expected], "{names}");
    }
    let p = read("x,y,z,type\n1,2,3,water\n4,5,6,oil\n", Extension::Csv);
    assert_eq!((p.positions.len(), p.kinds), (2, None));
    assert!(p.warnings[0].contains("`type` is dropped"), "{:?}", p.warnings);
    let p = read("x,y,z,label\n0,0,0,fluid\n1,0,0,wall\n", Extension::Csv);
    assert_eq!((p.positions.len(), p.ids), (2, None));
    assert!(p.warnings[0].contains("`label` is dropped: the word"), "{:?}", p.warnings);
    error("x,y,z,rho\n1,2,3,water\n", Extension::Csv, &["a number in column `rho`", "water"]);
}

/// `u` may be a displacement beside the velocity `vx vy vz`.
#[test]
fn three_components_precede_a_vague_vector() {
    let component = |name: &str, a: u8, b: u8| {
        format!("SCALARS {name} float 1\nLOOKUP_TABLE default\n{a}\n{b}\n")
    };
    let head = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n\
                0 0 0\n1 2 3\nPOINT_DATA 2\nVECTORS u float\n9 9 9\n9 9 9\n";
    let components = [component("vx", 1, 4), component("vy", 2, 5), component("vz", 3, 6)];
    let p = read(&format!("{head}{}", components.concat()), Extension::Vtk);
    assert_eq!(p.velocities, Some(vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]));
    // Alone, `u` is the velocity.
    assert_eq!(read(head, Extension::Vtk).velocities, Some(vec![[9.0; 3]; 2]));
}

/// Two components are a velocity in two dimensions, or if their names say so.
#[test]
fn two_scalars_are_no_velocity_in_space() {
    for (text, hint, told) in [
        ("x,y,z,u,v\n1,2,3,4,5\n", Extension::Csv, "`u` and `v` are not taken"),
        ("x y z rho u w\n1 2 3 4 5 6\n", Extension::Xyz, "`u` and `w` are not taken"),
        ("x,z,u,v\n1,2,3,4\n", Extension::Csv, "`u` and `v` are not taken"),
    ] {
        let p = read(text, hint);
        assert_eq!(p.velocities, None, "{text}");
        assert!(p.warnings.iter().any(|w| w.contains(told)), "{text}: {:?}", p.warnings);
        assert!(p.meanings.iter().all(|(meaning, _)| *meaning != Meaning::Velocity), "{text}");
    }
    let p = read("x,y,u,v\n1,2,3,4\n", Extension::Csv);
    assert_eq!((p.velocities, p.warnings.len()), (Some(vec![[3.0, 4.0, 0.0]]), 1));
    let p = read("x,y,z,vx,vy\n1,2,3,4,5\n", Extension::Csv);
    assert_eq!(p.velocities, Some(vec![[4.0, 5.0, 0.0]]));
    let told = "velocities have two components (`vx` and `vy`)";
    assert!(p.warnings.len() == 1 && p.warnings[0].contains(told), "{:?}", p.warnings);
}

/// Houdini's `life` is the time that a particle may live in all.
#[test]
fn the_time_left_is_the_life_less_the_age() {
    let text = "x,y,z,life,age\n0,0,0,2,0.5\n1,0,0,2,3\n";
    let p = read(text, Extension::Csv);
    assert_eq!(p.lifetimes, Some(vec![1.5, -1.0]));
    assert!(p.warnings.is_empty(), "{:?}", p.warnings);
    let meaning = p.meanings.iter().find(|(meaning, _)| *meaning == Meaning::Lifetime);
    assert_eq!(meaning.unwrap().1, ["life", "age"]);
    let parts = Parts::of_bytes(text.as_bytes(), Extension::Csv, 1).unwrap();
    let parts: Vec<_> = parts.flat_map(|part| part.unwrap().lifetimes.unwrap()).collect();
    assert_eq!(parts, [1.5, -1.0]);
    let p = read("x,y,z,life\n0,0,0,2\n", Extension::Csv);
    assert_eq!(p.lifetimes, None);
    assert!(p.warnings[0].contains("`life` is not used"), "{:?}", p.warnings);
    let p = read(&text.replace("life", "lifetime"), Extension::Csv);
    assert_eq!(p.lifetimes, Some(vec![1.5, -1.0]));
    assert!(p.warnings[0].contains("`lifetime` less `age`"), "{:?}", p.warnings);
    let p = read("x,y,z,lifetime\n0,0,0,2\n", Extension::Csv);
    assert_eq!((p.lifetimes, p.warnings.len()), (Some(vec![2.0]), 0));
    let p = read("x,y,z,age\n0,0,0,2\n", Extension::Csv);
    assert_eq!((p.lifetimes, p.warnings.len()), (None, 0));
}

#[test]
fn missing_densities_and_lifetimes_are_told() {
    let text = "x,y,z,rho,lifetime\n0,0,0,1,1\n1,0,0,,\n2,0,0,3,nan\n";
    let told = ["1 of 3 densities are missing", "2 of 3 lifetimes are missing"];
    let parts = Parts::of_bytes(text.as_bytes(), Extension::Csv, 1).unwrap();
    for warnings in [&read(text, Extension::Csv).warnings, &parts.about().warnings] {
        assert_eq!(warnings.len(), 2, "{warnings:?}");
        for (warning, told) in warnings.iter().zip(told) {
            assert!(warning.contains(told), "{warning}");
        }
    }
    // An infinite lifetime is one.
    let p = read("x,y,z,lifetime\n0,0,0,inf\n", Extension::Csv);
    assert!(p.warnings.is_empty(), "{:?}", p.warnings);
}

/// The time of a frame is its time and not its number, whatever comes first.
#[test]
fn times_precede_steps() {
    let folder = Folder::new("times-before-steps");
    for names in ["timestep,time", "step,time", "Iteration,sim_time"] {
        let row = |k: usize, i: usize| format!("{},{},{i},{i},{k},0\n", 100 * k, 0.25 * k as f64);
        let rows: String = (0..3).flat_map(|k| (0..2).map(move |i| row(k, i))).collect();
        let path = folder.put("t.csv", format!("{names},id,x,y,z\n{rows}"));
        let all = steps(&path).unwrap();
        let times: Vec<_> = all.iter().map(|step| step.time).collect();
        assert_eq!(times, [0.0, 0.25, 0.5].map(Some), "{names}");
        let last = read_step(&path, all[2], &[]).unwrap();
        assert_eq!((last.time, last.positions[1]), (Some(0.5), [1.0, 2.0, 0.0]), "{names}");
    }
    let p = read("step,time,x,y,z\n400,0.25,0,0,0\n400,0.25,1,0,0\n", Extension::Csv);
    assert_eq!(p.time, Some(0.25));
}

#[test]
fn tables_of_tecplot() {
    let text = format!(
        "TITLE = \"dam\"\nVARIABLES = \"X (m)\", \"Y (m)\", \"Z (m)\", \"U\", \"V\", \"W\", \"ID\", \"Rho\"\n\
         ZONE T=\"0.32 s\", I=2, F=POINT\n{}",
        rows("  ", "\n")
    );
    let mut p = read(&text, Extension::Text);
    p.warnings.clear();
    check("Tecplot", &p);
    check("Tecplot", &read(&text.replace("TITLE = \"dam\"\n", "# dam\n"), Extension::Text));
    let zone = text.split_once("ZONE").unwrap().1.to_string();
    let next = zone.replace("0.32", "0.36");
    error(&format!("{text}ZONE{next}"), Extension::Text, &["several frames", "line 6"]);
    error(&text.replace("F=POINT", "F=BLOCK"), Extension::Text, &["in blocks (line 3)", "POINT"]);
    // A record over several lines, and names on separate lines.
    let lines = text.replace("\", \"", "\"\n\"").replace(", I=2", "\n I = 2, J=1\n");
    let mut p = read(&lines, Extension::Csv);
    p.warnings.clear();
    check("Tecplot", &p);
    // A column may be called `zone`.
    let named = format!("zone x y z\n1 {}", "0 1 2\n");
    assert_eq!(read(&named, Extension::Xyz).positions, [[0.0, 1.0, 2.0]]);
}

/// A zone has as many rows as its record says; of a mesh, the elements behind the nodes are no particles.
#[test]
fn zones_have_the_rows_of_their_records() {
    let head = "TITLE = \"mesh\"\nVARIABLES = \"X\" \"Y\" \"Z\"\n";
    let nodes = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
    let at = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let zone = |record: &str, rows: &str| format!("{head}ZONE {record}\n{rows}");
    for (record, elements) in [
        ("N=4, E=2, F=FEPOINT, ET=TETRAHEDRON", "1 2 3 4\n1 3 2 4\n"),
        ("NODES=4, ELEMENTS=2, ZONETYPE=FETRIANGLE, DATAPACKING=POINT", "1 2 3\n1 3 2\n"),
        ("N=4\n\n# more\n E=2\n ET=TRIANGLE\n F=FEPOINT", "1 2 3\n1 3 2\n"),
        ("T=\"I=9, N=7\", N=4, E=1, F=FEPOINT, ET=TRIANGLE", "1,2,3\n"),
        ("N=4, E=2, F=FEPOINT, ET=TRIANGLE, CONNECTIVITYSHAREZONE=1", ""),
    ] {
        let p = read(&zone(record, &format!("{nodes}{elements}")), Extension::Text);
        assert_eq!(p.positions, at, "{record}");
        let told = p.warnings.iter().any(|told| told.contains("1 of 1 zones are meshes"));
        assert!(told, "{record}: {:?}", p.warnings);
    }
    // A line of elements may be shorter than a row.
    let text = zone("N=4, E=1, F=FEPOINT, ET=TETRAHEDRON", &nodes.replace('\n', " 1000 1\n"));
    let text = text.replace("\"Z\"", "\"Z\" \"RHO\" \"ID\"") + "1 2 3 4\n";
    assert_eq!(read(&text, Extension::Text).positions, at);
    // Zones of one frame have records of their own.
    let wall = format!("ZONE T=\"wall\", N=4, E=1, F=FEPOINT, ET=TETRAHEDRON\n{nodes}1 2 3 4\n");
    let both = zone("T=\"fluid\", I=2, F=POINT", "0 0 5\n1 0 5\n") + &wall;
    let p = read(&both, Extension::Text);
    assert_eq!(p.positions.len(), 6);
    assert!(p.warnings[1].contains("1 of 2 zones are meshes"), "{:?}", p.warnings);
    let rows = "rows in a zone of Tecplot, as its record says";
    let blocks = "0 0.1 0.2 0.3\n0.4 0.5 0.6 0.7\n".repeat(3);
    for (text, parts) in [
        (zone("I=6, F=POINT", nodes), [rows, "expected 6 ", "found 4 in line 7"]),
        (zone("I=3, F=POINT", nodes), [rows, "expected 3 ", "found more in line 7"]),
        (zone("I=2, J=2, K=2, F=POINT", nodes), [rows, "expected 8 ", "found 4 in line 7"]),
        (zone("I=4, F=POINT", "0 0 0\n1 0 0\n0 1 0\n0 0"), [rows, "found 3 in line 7", "cut off"]),
        (zone("T=\"a\", I=5, F=POINT", nodes) + &wall, [rows, "expected 5 ", "found 4 in line 7"]),
        (
            zone("N=3, E=1, F=FEPOINT, ET=TRIANGLE", &format!("{nodes}1 2 3\n")),
            [rows, "expected 3 ", "found more in line 8"],
        ),
        (
            zone("I=8, J=1, K=1", &blocks),
            ["without DATAPACKING", "4 values in its first line, for 3 variables", "=POINT"],
        ),
        (
            zone("I=4, VARSHARELIST=([1]=1)", nodes),
            ["values of its own", "line 3", "without VARSHARELIST"],
        ),
        (
            zone("F=FEPOINT, ET=TRIANGLE", nodes),
            ["without the number of its nodes", "line 3", "NODES"],
        ),
    ] {
        error(&text, Extension::Text, &parts);
    }
    let p = read(&zone("I=2, J=2, F=POINT", nodes), Extension::Text);
    assert_eq!(p.positions, at);
    assert!(p.warnings[0].contains("1 of 1 zones are grids"), "{:?}", p.warnings);
    // Three lines of three values may be rows or blocks.
    for (record, told) in [("I=3", true), ("I=3, F=POINT", false)] {
        let p = read(&zone(record, "0 0 1\n1 0 2\n0 1 3\n"), Extension::Text);
        assert_eq!(p.positions.len(), 3);
        let found = p.warnings.iter().any(|told| told.contains("no DATAPACKING"));
        assert_eq!(found, told, "{record}: {:?}", p.warnings);
    }
}

#[test]
fn a_first_column_that_counts_is_the_id() {
    let table = |separator: &str, first: usize, columns: usize| {
        let row = |i: usize| {
            let mut row = vec![
                (first + i).to_string(),
                format!("{}.5", i + 1),
                "2".into(),
                "3".into(),
                "9".into(),
            ];
            row.truncate(columns);
            row.join(separator) + "\n"
        };
        (0..20).map(row).collect::<String>()
    };
    for (separator, hint) in [
        (",", Extension::Csv),
        (";", Extension::Csv),
        (" ", Extension::Xyz),
        (" ", Extension::Csv),
        (", ", Extension::Xyz),
    ] {
        for (first, columns) in [(0, 4), (1, 4), (1, 5)] {
            let p = read(&table(separator, first, columns), hint);
            assert_eq!(p.positions[4], [5.5, 2.0, 3.0], "{separator} {columns}");
            assert_eq!(p.ids.unwrap()[4], 4 + first as u32);
            assert!(p.warnings.len() == 1 && p.warnings[0].contains("counts"), "{:?}", p.warnings);
        }
        // Three columns are always positions.
        assert_eq!(read(&table(separator, 0, 3), hint).positions[4], [4.0, 5.5, 2.0]);
    }
}

/// A row of units below the names: each unit is behind its name, as if it stood there in brackets.
#[test]
fn a_row_of_units_is_read() {
    let rows = "0 0 0 1 7 900\n1 2 3 1 8 1000\n";
    for (names, units, expected) in [
        (
            "x y z vx id rho",
            "mm mm mm mm/s - kg/m3",
            "x [mm],y [mm],z [mm],vx [mm/s],id,rho [kg/m3]",
        ),
        (
            "x y z vx id rho",
            "[m] [m] [m] [m/s] [1] [kg/m^3]",
            "x [m],y [m],z [m],vx [m/s],id,rho [kg/m^3]",
        ),
        (
            "x y z vx id rho",
            "(cm) (cm) (cm) (cm/s) () (g)",
            "x [cm],y [cm],z [cm],vx [cm/s],id,rho [g]",
        ),
        ("# x y z vx id rho", "# mm mm mm mm/s 1 g", "x [mm],y [mm],z [mm],vx [mm/s],id,rho [g]"),
        ("x[m] y[m] z[m] vx id rho", "mm mm mm m/s - g", "x[m],y[m],z[m],vx [m/s],id,rho [g]"),
        // Rules, words and types are no units.
        ("x y z vx id rho", "- - - - - -", "x,y,z,vx,id,rho"),
        ("x y z vx id rho", "real real real real int real", "x,y,z,vx,id,rho"),
    ] {
        for separator in [" ", ",", ";", "\t"] {
            let join = |text: &str| text.replace(' ', separator);
            let text = format!("{}\n{}\n{}", join(names), join(units), join(rows));
            let text = if names.starts_with('#') {
                text.replace("#,", "#").replace("#;", "#")
            } else {
                text
            };
            let p = read(&text, Extension::Csv);
            let found: Vec<_> = p.attributes.iter().map(|a| a.name.as_str()).collect();
            assert_eq!(found.join(","), expected, "{text}");
            assert_eq!(p.positions, [[0.0; 3], [1.0, 2.0, 3.0]], "{text}");
            assert_eq!(p.ids.as_deref(), Some(&[7, 8][..]), "{text}");
        }
    }
    // Between commas a unit may be missing.
    let p = read("id,x,y,z\n,m,m,m\n7,0,0,0\n8,1,1,1\n", Extension::Csv);
    assert_eq!(p.meanings[0].1, ["x [m]", "y [m]", "z [m]"]);
    // Between spaces it would be that of another column.
    let p = read("id x y z\nm m m\n7 0 0 0\n8 1 1 1\n", Extension::Xyz);
    assert_eq!(p.meanings[0].1, ["x", "y", "z"]);
}

/// Comments number the columns in many ways, in one line or a line each. The positions are where the names say.
#[test]
fn comments_number_the_columns() {
    let body = "0.5 7 1 2 3\n0.5 9 4 5 6\n0.5 8 7 8 9\n";
    for head in [
        "# 1:time 2:id 3:x 4:y 5:z",
        "# 1:time, 2:id, 3:x, 4:y, 5:z",
        "# [1] time [2] id [3] x [4] y [5] z",
        "# [1]=time  [2]=id  [3]=x  [4]=y  [5]=z",
        "# (1) time (2) id (3) x (4) y (5) z",
        "#1 time 2 id 3 x 4 y 5 z",
        "# col1: time, col2: id, col3: x, col4: y, col5: z",
        "# 1=time 2=id 3=x 4=y 5=z",
        "# $1 = time $2 = id $3 = x [m] $4 = y [m] $5 = z [m]",
        "% 0:time 1:id 2:x 3:y 4:z",
        "# columns: time id x y z",
        "# written by a solver\n# column 1: time\n# column 2: id\n# column 3: x\n# column 4: y\n# column 5: z\n# end",
        "# 1 time [s]\n# 2 id\n# 3 x position of a particle\n# 4 y\n# 5 z",
        "# $1 = time [s]\n# $2 = id\n# $3 = x [m]\n# $4 = y [m]\n# $5 = z [m]\n",
    ] {
        for (hint, separator) in [(Extension::Xyz, " "), (Extension::Csv, ",")] {
            let text = format!("{head}\n{}", body.replace(' ', separator));
            if head.starts_with('%') && hint == Extension::Csv {
                continue;
            }
            let p = read(&text, hint);
            assert_eq!(p.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]], "{text}");
            assert_eq!(p.ids.as_deref(), Some(&[7, 9, 8][..]), "{text}");
            assert_eq!(p.time, Some(0.5), "{text}");
            assert!(p.warnings.is_empty(), "{text}: {:?}", p.warnings);
        }
    }
    let all = "# 1:x 2:y 3:z 4:vx 5:vy 6:vz 7:id 8:rho\n";
    check("numbered", &read(&format!("{all}{}", rows(" ", "\n")), Extension::Text));
    // Names of something else than positions, and names of some columns only.
    let altitude = "# $1 = time [s]\n# $2 = altitude [km]\n# $3 = longitude [deg]\n0 1 2\n0 2 3\n";
    error(altitude, Extension::Text, &["altitude", "rename"]);
    for head in ["# 1:x 2:y 3:z 4:vx 5:vy 6:vz", "# x y z vx", "# 1: x\n# 2: y\n# 3: z"] {
        let p = read(&format!("{head}\n{body}"), Extension::Text);
        let told = p.warnings.join("; ");
        assert!(told.contains("the rows have 5") && told.contains("x y z"), "{head}: {told}");
    }
    // A remark that is no list of names.
    let p = read("# positions in x and y and z of 3 particles\n1 2 3\n4 5 6\n", Extension::Text);
    assert!(p.warnings.is_empty(), "{:?}", p.warnings);
}

/// One line of words below a table is skipped and told; anything else there is an error.
#[test]
fn a_line_below_the_table_is_told() {
    let table = "x y z\n1 2 3\n4 5 6\n";
    for (hint, separator) in [(Extension::Text, " "), (Extension::Csv, ",")] {
        let table = table.replace(' ', separator);
        for below in ["Total: 1234", "END", "total, 2, particles", "mean 2.5 3.5 4.5 extra"] {
            for end in ["", "\n", "\n\n"] {
                let p = read(&format!("{table}\n{below}{end}"), hint);
                assert_eq!(p.positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], "{below}");
                let told = &p.warnings[..];
                assert!(told.len() == 1 && told[0].contains("the last line is no row"), "{told:?}");
            }
        }
        // Comments are no rows anyway, and words of a column of words are.
        let p = read(&format!("{table}# end\n"), hint);
        assert!(p.warnings.is_empty(), "{:?}", p.warnings);
        let words = "type x y z\n1 0 0 0\nwall 1 1 1\n".replace(' ', separator);
        assert_eq!(read(&words, hint).positions.len(), 2);
        error(&format!("{table}Total: 2\n7{separator}8{separator}9\n"), hint, &["line"]);
        error(&format!("{table}Total: 2\nwords\n"), hint, &["line"]);
    }
}

/// The particles of a JSON file are found wherever they are, if one place has them.
#[test]
fn json_may_have_other_objects_beside_the_particles() {
    let at = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
    let list =
        r#"[{"x":1,"y":2,"z":3,"vx":1,"vy":0,"vz":0},{"x":4,"y":5,"z":6,"vx":2,"vy":0,"vz":0}]"#;
    let arrays = r#"{"position":[[1,2,3],[4,5,6]],"velocity":[[1,0,0],[2,0,0]]}"#;
    for (text, warned) in [
        (format!(r#"{{"meta":{{"solver":"x","dt":0.01}},"particles":{list}}}"#), false),
        (format!(r#"{{"particles":{arrays},"info":{{"n":3}}}}"#), false),
        (format!(r#"{{"frame":{{"fluid":{arrays},"time":0.5}},"meta":{{}}}}"#), false),
        (format!(r#"{{"a":{{"b":{{"c":{arrays},"d":[1,2]}},"e":{{}}}},"f":[{{"g":1}}]}}"#), false),
        (format!(r#"{{"points":{arrays},"meta":{{"n":2}}}}"#), false),
        (format!(r#"{{"points":{list},"meta":{{"tags":["a","b"]}}}}"#), false),
        (format!(r#"{{"frames":[{{"particles":{list}}}],"meta":{{"n":2}}}}"#), false),
        (format!(r#"{{"box":[[0,0,0],[9,9,9]],"fluid":{list}}}"#), false),
        (format!(r#"{{"m":{{"domain":{{"x":[0,9],"y":[0,9],"z":[0,9]}}}},"p":{list}}}"#), false),
        (format!(r#"{{"walls":[[0,0,0],[9,9,9]],"fluid":{list}}}"#), true),
    ] {
        let p = read(&text, Extension::Json);
        assert_eq!(p.positions, at, "{text}");
        assert_eq!(
            p.velocities.as_deref(),
            Some(&[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]][..]),
            "{text}"
        );
        assert_eq!(p.time, text.contains("time").then_some(0.5), "{text}");
        let told = p.warnings.iter().any(|warning| warning.contains("not read: `walls`"));
        assert_eq!((told, p.warnings.is_empty()), (warned, !warned), "{:?}", p.warnings);
    }
    let bare = r#"{"meta":{"dt":0.1},"cloud":{"of":[[1,2,3],[4,5,6]]}}"#;
    assert_eq!(read(bare, Extension::Json).positions, at);
    for (text, places) in [
        (
            format!(r#"{{"run":{{"fluid":{arrays},"wall":{arrays}}},"meta":{{}}}}"#),
            ["`run.fluid`", "`run.wall`"],
        ),
        (format!(r#"{{"a":{list},"b":{{"c":{arrays}}}}}"#), ["`a`", "`b.c`"]),
        (r#"{"a":[[0,0,0],[1,1,1]],"b":[[1,2,3],[4,5,6]]}"#.into(), ["`a`", "`b`"]),
    ] {
        let found = error(&text, Extension::Json, &places);
        assert!(found.contains("a file of its own"), "{found}");
    }
    // Settings beside frames by name.
    let folder = Folder::new("beside");
    let text = format!(r#"{{"meta":{{"dt":1}},"frame_1":{list},"frame_2":{list}}}"#);
    assert_eq!(steps(&folder.put("frames.json", text)).unwrap().len(), 2);
}
