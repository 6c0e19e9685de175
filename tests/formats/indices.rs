//! Index files that list other files, pieces of a frame, ghost particles, and messages about meshes
//! and times.

use std::path::Path;

use super::folder::Folder;
use super::samples;
use whitewater::io::particles::sequence::{SequenceError, expand};
use whitewater::io::particles::{
    Compression, Extension, Particles, Parts, Storage, find_origin, read, read_bytes,
};

fn vtu(of: &Particles, storage: Storage, vtp: bool) -> Vec<u8> {
    let compression = if storage == Storage::Ascii { Compression::None } else { Compression::Zlib };
    let xml = samples::Xml {
        vtp,
        storage,
        compression,
        big: false,
        wide: false,
        pieces: false,
        double: false,
    };
    xml.bytes(of)
}

/// A range of the cloud's particles.
fn some(from: usize, to: usize) -> Particles {
    let all = samples::cloud();
    let mut some = Particles::from_positions(all.positions[from..to].to_vec());
    some.velocities = all.velocities.map(|list| list[from..to].to_vec());
    some.densities = all.densities.map(|list| list[from..to].to_vec());
    some.ids = all.ids.map(|list| list[from..to].to_vec());
    some
}

const EMPTY: &str = "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"0\" \
                     NumberOfCells=\"0\"></Piece></UnstructuredGrid></VTKFile>";

fn pvtu(files: &[&str]) -> String {
    let pieces: String = files.iter().map(|f| format!("<Piece Source=\"{f}\"/>")).collect();
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"0.1\">\
         <PUnstructuredGrid GhostLevel=\"0\"><PPointData/>{pieces}</PUnstructuredGrid></VTKFile>\n"
    )
}

#[test]
fn pieces_of_ranks_are_one_frame() {
    let folder = Folder::new("pvtu");
    folder.put("p-8.0.vtu", vtu(&some(0, 4), Storage::AppendedRaw, false));
    folder.put("ranks/p-8.1.vtu", EMPTY);
    folder.put("p-8.2.vtu", vtu(&some(4, 11), Storage::Ascii, false));
    let index = folder.put("p-8.pvtu", pvtu(&["p-8.0.vtu", "ranks/p-8.1.vtu", "p-8.2.vtu"]));
    let whole = read(&index).unwrap();
    samples::check("pvtu", &whole, samples::Has::All);
    assert!(whole.warnings.is_empty(), "{:?}", whole.warnings);
    let parts = Parts::open(&index, 3).unwrap();
    assert_eq!((parts.total(), parts.in_memory()), (11, false));
    let parts: Vec<_> = parts.collect::<Result<_, _>>().unwrap();
    assert_eq!(parts.iter().map(|p| p.positions.len()).collect::<Vec<_>>(), [3, 3, 3, 2]);
    assert_eq!(parts.iter().flat_map(|p| p.positions.clone()).collect::<Vec<_>>(), whole.positions);
    // An error names the piece.
    folder.put("p-8.2.vtu", &vtu(&some(4, 11), Storage::AppendedRaw, false)[..700]);
    let error = read(&index).unwrap_err().to_string();
    assert!(error.contains("p-8.2.vtu"), "{error}");
    std::fs::remove_file(folder.path().join("p-8.2.vtu")).unwrap();
    let error = read(&index).unwrap_err().to_string();
    assert!(error.contains("cannot read") && error.contains("p-8.2.vtu"), "{error}");
}

#[test]
fn damaged_lists_are_no_reason_to_panic() {
    let folder = Folder::new("damaged");
    folder.put("p_0.vtu", vtu(&some(0, 4), Storage::Ascii, false));
    let lists = [
        ("a.pvtu", pvtu(&["p_0.vtu", "p_0.vtu"])),
        ("a.pvd", "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0.5\" file=\"p_0.vtu\"/></Collection></VTKFile>".into()),
        ("a.vtk.series", "{\"files\": [{\"name\": \"p_0.vtu\", \"time\": 1}]}".into()),
    ];
    let mut seed = 7_u32;
    let mut next = |below: usize| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as usize % below
    };
    for (name, text) in lists {
        for _ in 0..300 {
            let mut bytes = text.clone().into_bytes();
            for _ in 0..=next(3) {
                let at = next(bytes.len());
                match next(3) {
                    0 => bytes[at] = next(256) as u8,
                    1 => bytes.truncate(at.max(1)),
                    _ => drop(bytes.remove(at)),
                }
                bytes.push(b'>');
            }
            let path = folder.put(name, bytes);
            let _ = (read(&path), Parts::open(&path, 2).map(Iterator::count));
            let _ = expand(&[path.display().to_string()], None);
        }
    }
}

#[test]
fn what_not_all_pieces_have_is_dropped_and_told() {
    let folder = Folder::new("unlike");
    folder.put("a_0.vtp", vtu(&some(0, 4), Storage::Ascii, true));
    let text = String::from_utf8(vtu(&some(4, 11), Storage::Ascii, true)).unwrap();
    folder.put("a_1.vtp", text.replace("Name=\"id\"", "Name=\"mass\""));
    let index = pvtu(&["a_0.vtp", "a_1.vtp"]).replace("PUnstructuredGrid", "PPolyData");
    let p = read(&folder.put("a.pvtp", index)).unwrap();
    assert_eq!((p.positions.len(), p.ids.is_some(), p.velocities.is_some()), (11, false, true));
    assert!(p.warnings[0].contains("`id` is dropped"), "{:?}", p.warnings);
}

#[test]
fn blocks_are_put_together_and_told() {
    let folder = Folder::new("vtm");
    folder.put("all/all_0.vtp", vtu(&some(0, 4), Storage::Ascii, true));
    folder.put("all/all_1.vtu", vtu(&some(4, 11), Storage::InlineBase64, false));
    let index = |blocks: &str| {
        format!(
            "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\"><vtkMultiBlockDataSet>{blocks}\
             </vtkMultiBlockDataSet></VTKFile>"
        )
    };
    let two = "<Block index=\"0\" name=\"all\"><DataSet index=\"0\" name=\"fluid\" file=\"all/all_0.vtp\"/>\
               <DataSet index=\"1\" name=\"walls\" file=\"all/all_1.vtu\"/><DataSet index=\"2\"/></Block>";
    let p = read(&folder.put("all.vtm", index(two))).unwrap();
    samples::check("vtm", &p, samples::Has::All);
    assert!(p.warnings[0].contains("2 blocks") && p.warnings[0].contains("fluid, walls"));
    let p = read(&folder.put("one.vtm", index("<DataSet index=\"0\" file=\"all/all_0.vtp\"/>")))
        .unwrap();
    assert_eq!((p.positions.len(), p.warnings.len()), (4, 0));
    let error = read(&folder.put("none.vtm", index(""))).unwrap_err().to_string();
    assert!(error.contains("files in the list"), "{error}");
}

#[test]
fn lists_of_frames_are_sequences() {
    let folder = Folder::new("pvd");
    let frames = |input: &Path| {
        let found = expand(&[input.display().to_string()], None);
        found.map(|list| {
            let name =
                |path: &Path| path.strip_prefix(folder.path()).unwrap().display().to_string();
            list.iter().map(|f| (f.number, f.time, name(&f.path))).collect::<Vec<_>>()
        })
    };
    let set = |time: &str, file: &str| {
        format!("<DataSet timestep=\"{time}\" part=\"0\" file=\"{file}\"/>")
    };
    let pvd = |sets: &[String]| {
        format!("<VTKFile type=\"Collection\"><Collection>{}</Collection></VTKFile>", sets.concat())
    };
    let list = folder.put(
        "dam.pvd",
        pvd(&[set("0.5", "z/a.vtu"), set("0.04", "z/b.vtu"), set("1e-2", "c.pvtu")]),
    );
    assert_eq!(
        frames(&list).unwrap(),
        [
            (0, Some(0.01), "c.pvtu".into()),
            (1, Some(0.04), "z/b.vtu".into()),
            (2, Some(0.5), "z/a.vtu".into())
        ]
    );
    let series = "{\"file-series-version\": \"1.0\", \"files\": [{\"name\": \"d_1.vtk\", \"time\": 1}, \
                  {\"name\": \"d_0.vtk\", \"time\": 0.5}]}";
    let list = folder.put("d.vtk.series", series);
    assert_eq!(
        frames(&list).unwrap(),
        [(0, Some(0.5), "d_0.vtk".into()), (1, Some(1.0), "d_1.vtk".into())]
    );
    // Ranks at one time without an index file are one frame.
    let list = folder.put("ranks.pvd", pvd(&[set("0", "a_0.vtu"), set("0", "a_1.vtu")]));
    assert_eq!(frames(&list).unwrap(), [(0, Some(0.0), "a_0.vtu".into())]);
    // Walls that rest, and a frame that is held.
    let list = folder.put(
        "rest.pvd",
        pvd(&[
            set("0", "a_0.vtu"),
            set("0", "wall.vtu"),
            set("1", "a_1.vtu"),
            set("1", "wall.vtu"),
            set("1", "wall.vtu"),
            set("2", "a_1.vtu"),
        ]),
    );
    let list = list.display().to_string();
    for inputs in [vec![list.clone()], vec![list.clone(), list]] {
        let found = expand(&inputs, None).unwrap();
        let name = |path: &Path| path.file_name().unwrap().display().to_string();
        let names = found.iter().map(|f| f.paths().map(name).collect::<Vec<_>>());
        assert_eq!(
            names.collect::<Vec<_>>(),
            [vec!["a_0.vtu", "wall.vtu"], vec!["a_1.vtu", "wall.vtu"], vec!["a_1.vtu"]]
        );
        let times: Vec<_> = found.iter().map(|f| f.time).collect();
        assert_eq!(times, [Some(0.0), Some(1.0), Some(2.0)]);
    }
    for (name, bytes) in
        [("empty.pvd", pvd(&[])), ("bad.pvd", "<".into()), ("bad.series", "{".into())]
    {
        assert!(
            matches!(frames(&folder.put(name, bytes)), Err(SequenceError::Pattern { .. })),
            "{name}"
        );
    }
}

#[test]
fn pieces_among_the_frames_are_refused() {
    let folder = Folder::new("pieces");
    folder.put("p_8_0.vtu", EMPTY);
    folder.put("p_8_1.vtu", EMPTY);
    folder.put("p_8.pvtu", pvtu(&["p_8_0.vtu", "./p_8_1.vtu"]));
    let pattern = |name: &str| folder.path().join(name).display().to_string();
    let error = expand(&[pattern("*.vtu")], None).unwrap_err();
    assert!(matches!(error, SequenceError::Piece { .. }));
    assert!(error.to_string().contains("p_8.pvtu: give that one"), "{error}");
    // A single piece is read as any other file.
    assert_eq!(expand(&[pattern("p_8_1.vtu")], None).unwrap().len(), 1);
    assert_eq!(expand(&[pattern("*.pvtu")], None).unwrap()[0].number, 8);
}

/// Four points, of which the second and the fourth are ghosts.
fn with_ghosts(name: &str, values: &str) -> String {
    format!(
        "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"4\"><PointData>\
         <DataArray type=\"UInt8\" Name=\"{name}\" format=\"ascii\">{values}</DataArray>\
         <DataArray type=\"Int32\" Name=\"id\" format=\"ascii\">5 6 7 6</DataArray></PointData><Points>\
         <DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 2 0 0 1 0 0</DataArray>\
         </Points></Piece></PolyData></VTKFile>"
    )
}

#[test]
fn ghosts_are_left_out_and_told() {
    for (name, values) in
        [("vtkGhostType", "0 1 0 3"), ("vtkGhostType", "4 2 0 1"), ("vtkGhostLevels", "0 4 0 1")]
    {
        let text = with_ghosts(name, values);
        let p = read_bytes(text.as_bytes(), Extension::Vtp).unwrap();
        assert_eq!((p.positions, p.ids), (vec![[0.0; 3], [2.0, 0.0, 0.0]], Some(vec![5, 7])));
        assert!(p.warnings.len() == 1 && p.warnings[0].contains("2 of 4"), "{:?}", p.warnings);
        for most in 1..5 {
            let parts = Parts::of_bytes(text.as_bytes(), Extension::Vtp, most).unwrap();
            assert_eq!((parts.total(), parts.about().warnings.len()), (2, 1));
            let ids: Vec<_> = parts.flat_map(|part| part.unwrap().ids.unwrap()).collect();
            assert_eq!(ids, [5, 7], "parts of {most}");
        }
    }
    let none =
        read_bytes(with_ghosts("vtkGhostType", "0 0 0 0").as_bytes(), Extension::Vtp).unwrap();
    assert_eq!(none.positions.len(), 4);
}

fn warnings(text: &str, hint: Extension) -> Vec<String> {
    read_bytes(text.as_bytes(), hint).unwrap_or_else(|e| panic!("{e}\n{text}")).warnings
}

#[test]
fn meshes_are_told() {
    let points = "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0</DataArray></Points>";
    let grid = |types: &str| {
        format!(
            "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"3\" NumberOfCells=\"3\">{points}\
             <Cells><DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">{types}</DataArray></Cells></Piece>\
             </UnstructuredGrid></VTKFile>"
        )
    };
    let poly = |verts, polys| {
        format!(
            "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"3\" NumberOfVerts=\"{verts}\" \
             NumberOfPolys=\"{polys}\">{points}</Piece></PolyData></VTKFile>"
        )
    };
    let legacy = |cells: &str| {
        format!(
            "# vtk DataFile Version 4.2\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\n{cells}\n"
        )
    };
    let ply = |faces: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n{faces}\
             end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
        )
    };
    let face = "element face 1\nproperty list uchar int vertex_indices\n";
    for (name, text, hint) in [
        ("cells", grid("5 10 12"), Extension::Vtu),
        ("polygons", poly(0, 1), Extension::Vtp),
        ("legacy polygons", legacy("POLYGONS 1 4\n3 0 1 2"), Extension::Vtk),
        (
            "legacy cells",
            legacy("CELL_TYPES 3\n5\n5\n12").replace("POLYDATA", "UNSTRUCTURED_GRID"),
            Extension::Vtk,
        ),
        ("faces", ply(face), Extension::Ply),
    ] {
        let told = warnings(&text, hint);
        assert!(told.len() == 1 && told[0].contains("this is a mesh of"), "{name}: {told:?}");
    }
    for (name, text, hint) in [
        ("points", grid("1 1 1"), Extension::Vtu),
        ("one line among points", grid("1 3 1"), Extension::Vtu),
        ("types that are none", grid("1 1 x"), Extension::Vtu),
        ("points as polygons have them", poly(3, 0), Extension::Vtp),
        ("legacy points", legacy("VERTICES 3 6\n1 0 1 1 1 2"), Extension::Vtk),
        (
            "legacy vertices",
            legacy("CELL_TYPES 3\n1\n1\n1").replace("POLYDATA", "UNSTRUCTURED_GRID"),
            Extension::Vtk,
        ),
        (
            "no faces",
            ply(&face.replace("face 1", "face 0")).replace("3 0 1 2\n", ""),
            Extension::Ply,
        ),
    ] {
        assert_eq!(warnings(&text, hint), Vec::<String>::new(), "{name}");
    }
}

#[test]
fn the_time_of_a_frame() {
    let time = |text: &str, hint| read_bytes(text.as_bytes(), hint).unwrap().time;
    let xml = with_ghosts("vtkGhostType", "0 0 0 0").replace(
        "<PolyData><Piece",
        "<PolyData><FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" \
         format=\"ascii\">0.32</DataArray></FieldData><Piece",
    );
    assert_eq!(time(&xml, Extension::Vtp), Some(0.32));
    for name in ["TIME", "TimeValue"] {
        let text = format!(
            "# vtk DataFile Version 4.2\nt\nASCII\nDATASET POLYDATA\nFIELD FieldData 2\n{name} 1 1 double\n0.32\n\
             CYCLE 1 1 int\n8\nPOINTS 1 float\n0 0 0\n"
        );
        assert_eq!(time(&text, Extension::Vtk), Some(0.32));
    }
    let mut binary = b"# vtk DataFile Version 4.2\nt\nBINARY\nDATASET POLYDATA\nFIELD FieldData 1\nTIME 1 1 double\n".to_vec();
    binary.extend(0.32_f64.to_be_bytes());
    binary.extend(b"\nPOINTS 1 float\n");
    binary.extend([0; 12]);
    assert_eq!(read_bytes(&binary, Extension::Vtk).unwrap().time, Some(0.32));
    assert_eq!(time("0 0 0\n", Extension::Xyz), None);
}

#[test]
fn the_origin_of_a_file_is_found_by_its_first_particles() {
    let folder = Folder::new("origin");
    let table = |far: f64| {
        let rows: String =
            (0..5000).map(|i| format!("{},0.5,{}\n", far + f64::from(i % 70), i / 70)).collect();
        format!("x,y,z\n{rows}")
    };
    let far = folder.put("far.csv", table(4.0e6));
    let origin = find_origin(&far).unwrap();
    assert_eq!(origin, read(&far).unwrap().origin);
    assert_ne!(origin, [0.0; 3]);
    assert_eq!(Parts::open(&far, 100).unwrap().about().origin, origin);
    let near = folder.put("near.csv", table(40.0));
    assert_eq!(find_origin(&near).unwrap(), [0.0; 3]);
    let list = folder.put("far.json", "[[4e6, 0, 0], [4000001, 1, 1]]");
    assert_eq!(find_origin(&list).unwrap(), read(&list).unwrap().origin);
    let none = find_origin(&folder.path().join("none.csv")).unwrap_err().to_string();
    assert!(none.contains("none.csv"), "{none}");
}
