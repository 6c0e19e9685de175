//! Values that VTK files have on cells: used if the cells are the particles, and otherwise named in
//! a warning.

use std::path::Path;

use super::samples::{self, Has, ORDER};
use whitewater::io::particles::{
    Compression, Extension, Meaning, Particles, Parts, Storage, read, read_bytes, read_with,
};

fn parsed(text: &str, hint: Extension) -> Particles {
    read_bytes(text.as_bytes(), hint).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// As other programs write them, see `make.py`.
#[test]
fn files_of_vtk_and_meshio_on_vertices() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/formats/cells");
    for file in ["vtk.vtp", "meshio.vtu", "meshio.vtk"] {
        let p = read(&folder.join(file)).unwrap();
        samples::check(file, &p, Has::All);
        assert!(p.warnings.is_empty(), "{file}: {:?}", p.warnings);
        let meanings: Vec<_> = p.meanings.iter().map(|(meaning, _)| *meaning).collect();
        assert_eq!(
            meanings,
            [Meaning::Position, Meaning::Velocity, Meaning::Density, Meaning::Id],
            "{file}"
        );
    }
    // Conditions may name fields of cells.
    let p = read_with(&folder.join("vtk.vtp"), &["density"]).unwrap();
    assert_eq!(p.extras[0].values[3], 1001.5);
}

/// Three particles: cells, the points of each, and their fields.
fn legacy(cells: &str, fields: &str) -> String {
    format!(
        "# vtk DataFile Version 4.2\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\n{cells}\n{fields}\n"
    )
}

fn xml(verts: (usize, &str, &str), cell_data: &str, point_data: &str) -> String {
    let (count, offsets, connectivity) = verts;
    format!(
        "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"3\" NumberOfVerts=\"{count}\"><CellData>{cell_data}\
         </CellData><PointData>{point_data}</PointData><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" \
         format=\"ascii\">0 0 0 1 0 0 0 1 0</DataArray></Points><Verts><DataArray type=\"Int32\" Name=\"offsets\" \
         format=\"ascii\">{offsets}</DataArray><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">\
         {connectivity}</DataArray></Verts></Piece></PolyData></VTKFile>"
    )
}

fn array(name: &str, values: &str) -> String {
    format!("<DataArray type=\"Float32\" Name=\"{name}\" format=\"ascii\">{values}</DataArray>")
}

#[test]
fn fields_of_other_cells_are_told() {
    let fields = |n: usize| {
        let values = |v: &str| vec![v; n].join(" ");
        format!(
            "CELL_DATA {n}\nFIELD data 2\nrho 1 {n} float\n{}\nstress 1 {n} float\n{}",
            values("1000"),
            values("5")
        )
    };
    let both = |n: usize| {
        let values = vec!["1000"; n].join(" ");
        array("rho", &values) + &array("stress", &values)
    };
    let cases = [
        ("all points in one cell", legacy("VERTICES 1 4\n3 0 1 2", &fields(1)), "1 cells for 3"),
        (
            "a cell of two points",
            legacy("VERTICES 3 7\n1 0 2 1 2 1 2", &fields(3)),
            "7 values instead of 6",
        ),
        (
            "as many values",
            legacy("VERTICES 3 6\n1 0 2 1 2 0", &fields(3)),
            "cell 1 has 2 points instead of one",
        ),
        ("a point twice", legacy("VERTICES 3 6\n1 0 1 2 1 2", &fields(3)), "point 2 has several"),
        ("no such point", legacy("VERTICES 3 6\n1 0 1 1 1 3", &fields(3)), "cell 2 has point 3"),
        ("lines", legacy("LINES 3 9\n2 0 1 2 1 2 2 2 0", &fields(3)), "3 of the cells are lines"),
        (
            "lines too",
            legacy("VERTICES 2 4\n1 0 1 1\nLINES 1 3\n2 1 2", &fields(3)),
            "1 of the cells are lines",
        ),
        ("no cells", legacy("", &fields(3)), "0 cells for 3"),
        ("one cell, XML", xml((1, "3", "0 1 2"), &both(1), ""), "1 cells for 3"),
        (
            "two points, XML",
            xml((3, "1 1 3", "0 1 2"), &both(3), ""),
            "cell 1 has 0 points instead of one",
        ),
        ("a point twice, XML", xml((3, "1 2 3", "0 2 2"), &both(3), ""), "point 2 has several"),
        ("no such point, XML", xml((3, "1 2 3", "0 1 -1"), &both(3), ""), "has point -1"),
        ("cut off, XML", xml((3, "1 2 3", "0 1"), &both(3), ""), "cannot be read"),
        (
            "no list, XML",
            xml((3, "1 2 3", "0 1 2"), &both(3), "").replace("Name=\"offsets\"", "Name=\"o\""),
            "do not list their points",
        ),
    ];
    for (name, text, why) in cases {
        let hint = if text.starts_with('#') { Extension::Vtk } else { Extension::Vtp };
        let p = parsed(&text, hint);
        assert_eq!((p.positions.len(), p.densities), (3, None), "{name}");
        assert_eq!(p.warnings.len(), 1, "{name}: {:?}", p.warnings);
        for part in ["cells are not used: `rho`, `stress`;", why, "Cell Data to Point Data"] {
            assert!(p.warnings[0].contains(part), "{name}: {part} in {:?}", p.warnings);
        }
        assert!(p.attributes.iter().all(|a| a.name != "rho"), "{name}");
    }
    // Nothing is lost where there are no values.
    let none = legacy("", "CELL_DATA 0\nFIELD data 1\nrho 1 0 float\n");
    assert!(parsed(&none, Extension::Vtk).warnings.is_empty());
    let none = xml((0, "", ""), &array("rho", ""), "");
    assert!(parsed(&none, Extension::Vtp).warnings.is_empty());
}

#[test]
fn fields_of_points_come_first() {
    let on_points = "POINT_DATA 3\nSCALARS rho float\nLOOKUP_TABLE default\n1 2 3\n";
    let on_cells = "CELL_DATA 3\nSCALARS Rho float\nLOOKUP_TABLE default\n7 8 9\nSCALARS id int\n\
                    LOOKUP_TABLE default\n40 50 60\n";
    for fields in [format!("{on_points}{on_cells}"), format!("{on_cells}{on_points}")] {
        let p = parsed(&legacy("VERTICES 3 6\n1 2 1 0 1 1", &fields), Extension::Vtk);
        assert_eq!(p.densities, Some(vec![1.0, 2.0, 3.0]));
        assert_eq!(p.ids, Some(vec![50, 60, 40]));
        assert!(p.warnings[0].contains("not used: `Rho`; the points have"), "{:?}", p.warnings);
        assert_eq!(p.warnings.len(), 1);
    }
    let cells = array("Rho", "7 8 9") + &array("id", "40 50 60") + &array("stress", "1 1 1");
    let p = parsed(&xml((3, "1 2 3", "2 0 1"), &cells, &array("rho", "1 2 3")), Extension::Vtp);
    assert_eq!((p.densities, p.ids), (Some(vec![1.0, 2.0, 3.0]), Some(vec![50, 60, 40])));
    assert!(p.warnings[0].contains("not used: `Rho`; the points have"), "{:?}", p.warnings);
    let names: Vec<_> = p.attributes.iter().map(|a| a.name.as_str()).collect();
    assert_eq!(names, ["Points", "rho", "id", "stress"]);
}

/// Points without a name are listed as VTK names them, and as positions.
#[test]
fn points_without_a_name_are_positions() {
    let p = parsed(&xml((0, "", ""), "", &array("rho", "1 2 3")), Extension::Vtp);
    let (meaning, names) = &p.meanings[0];
    assert_eq!((*meaning, names.as_slice()), (Meaning::Position, &["Points".to_string()][..]));
    assert_eq!(p.attributes[0].name, "Points");
}

/// A field without a value for each cell is told, and the others are read.
#[test]
fn uneven_fields_of_cells_are_told() {
    let fields = "CELL_DATA 3\nFIELD data 2\nrho 1 2 float\n1 2\nid 1 3 int\n4 5 6";
    let p = parsed(&legacy("VERTICES 3 6\n1 0 1 1 1 2", fields), Extension::Vtk);
    assert_eq!((p.densities, p.ids), (None, Some(vec![4, 5, 6])));
    assert!(p.warnings[0].contains("not used: `rho`; they do not"), "{:?}", p.warnings);
}

/// Of cells, other bits say that one is a copy or hidden.
#[test]
fn ghosts_of_cells_are_left_out() {
    for (name, values, kept) in [
        ("vtkGhostType", "1 0 0", vec![1.0, 0.0]),
        ("vtkGhostType", "32 0 2", vec![1.0, 0.0]),
        ("vtkGhostType", "0 2 4", vec![0.0, 1.0, 0.0]),
        ("vtkGhostLevels", "0 0 2", vec![0.0, 0.0]),
    ] {
        let text = xml((3, "1 2 3", "0 2 1"), &array(name, values), "");
        let p = parsed(&text.replace("0 0 0 1 0 0 0 1 0", "0 0 0 1 0 0 0 1 1"), Extension::Vtp);
        let x: Vec<f32> = p.positions.iter().map(|p| p[0]).collect();
        assert_eq!(x, kept, "{name} {values}");
        assert!(p.attributes.iter().any(|a| a.name == name));
    }
}

/// Values in another order are the same in parts of any size, and in gzip.
#[test]
fn cells_in_parts() {
    let cloud = samples::cloud();
    let xml = samples::Xml {
        vtp: false,
        storage: Storage::AppendedRaw,
        compression: Compression::Zlib,
        big: false,
        wide: true,
        pieces: true,
        double: false,
    };
    let legacy = samples::vtk_on_cells(&cloud, "5.1", true, false, &ORDER);
    for (bytes, hint) in [(xml.on_cells(&cloud, &ORDER), Extension::Vtu), (legacy, Extension::Vtk)]
    {
        for bytes in [samples::gzip(&bytes), bytes] {
            for most in [1, 2, 3, 7, 11, 100] {
                let parts = Parts::of_bytes(&bytes, hint, most).unwrap();
                let (mut densities, mut velocities) = (Vec::new(), Vec::new());
                for part in parts {
                    let part = part.unwrap();
                    densities.extend(part.densities.unwrap());
                    velocities.extend(part.velocities.unwrap());
                }
                assert_eq!(Some(densities), cloud.densities, "parts of {most}");
                assert_eq!(Some(velocities), cloud.velocities, "parts of {most}");
            }
        }
    }
}

#[cfg(feature = "hdf5")]
#[test]
fn cells_in_vtkhdf() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/formats/cells");
    let p = read(&folder.join("same.vtkhdf")).unwrap();
    samples::check("same", &p, Has::All);
    assert!(p.warnings.is_empty(), "{:?}", p.warnings);
    let p = read(&folder.join("other.vtkhdf")).unwrap();
    samples::check("other", &p, Has::Positions);
    for part in ["not used: ", "`density`", "`velocity`", "not the points in their order"] {
        assert!(p.warnings[0].contains(part), "{:?}", p.warnings);
    }
}

#[cfg(feature = "hdf5")]
#[test]
fn cells_in_xdmf() {
    let folder = super::folder::Folder::new("cells_xdmf");
    let item = |dimensions: &str, values: &str| {
        format!("<DataItem Dimensions=\"{dimensions}\" Format=\"XML\">{values}</DataItem>")
    };
    let grid = |topology: &str, center: &str| {
        format!(
            "<Xdmf><Domain><Grid><Geometry GeometryType=\"XYZ\">{}</Geometry>{topology}<Attribute Name=\"density\" \
             Center=\"{center}\">{}</Attribute></Grid></Domain></Xdmf>",
            item("3 3", "0 0 0 1 0 0 0 1 0"),
            item("3", "7 8 9")
        )
    };
    let vertices = |list: &str| {
        format!(
            "<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"3\" NodesPerElement=\"1\">{list}</Topology>"
        )
    };
    for (name, topology, densities) in [
        ("none", vertices(""), [7.0, 8.0, 9.0]),
        ("same", vertices(&item("3 1", "0 1 2")), [7.0, 8.0, 9.0]),
        ("other", vertices(&item("3 1", "2 0 1")), [8.0, 9.0, 7.0]),
    ] {
        let path = folder.put(&format!("{name}.xdmf"), grid(&topology, "Cell"));
        let p = read(&path).unwrap();
        assert_eq!(p.densities, Some(densities.to_vec()), "{name}");
        assert!(p.warnings.is_empty(), "{name}: {:?}", p.warnings);
    }
    let triangle = vertices("").replace("Polyvertex", "Triangle").replace("\"1\"", "\"3\"");
    for (name, topology, center, why) in [
        ("triangles", triangle, "Cell", "the cells are Triangle of 3 points"),
        ("twice", vertices(&item("3 1", "2 0 2")), "Cell", "point 2 has several cells"),
        ("few", vertices(&item("2 1", "0 1")), "Cell", "2 cells for 3 points"),
        ("grid", vertices(""), "Grid", "Center=\"Grid\""),
    ] {
        let path = folder.put(&format!("{name}.xdmf"), grid(&topology, center));
        let p = read(&path).unwrap();
        assert_eq!((p.positions.len(), p.densities), (3, None), "{name}");
        assert!(p.warnings[0].contains("not used: `density`"), "{name}: {:?}", p.warnings);
        assert!(p.warnings[0].contains(why), "{name}: {:?}", p.warnings);
    }
}

fn list(name: &str, ty: &str, values: &str) -> String {
    format!("<DataArray type=\"{ty}\" Name=\"{name}\" format=\"ascii\">{values}</DataArray>")
}

fn cells_of(node: &str, offsets: &str, connectivity: &str, types: &str) -> String {
    let types = if types.is_empty() { String::new() } else { list("types", "UInt8", types) };
    let (offsets, points) =
        (list("offsets", "Int64", offsets), list("connectivity", "Int64", connectivity));
    format!("<{node}>{points}{offsets}{types}</{node}>")
}

/// Six points `x` = id = 0 to 5.
fn six(kind: &str, counts: &str, cells: &str) -> String {
    let points: String = (0..6).map(|x| format!("{x} 0 0 ")).collect();
    format!(
        "<VTKFile type=\"{kind}\"><{kind}><Piece NumberOfPoints=\"6\" {counts}><PointData>{}</PointData><Points>\
         <DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">{points}</DataArray></Points>{cells}\
         </Piece></{kind}></VTKFile>",
        list("id", "Int32", "0 1 2 3 4 5")
    )
}

/// Particles beside a mesh, as ParaView's Append Datasets writes them.
#[test]
fn points_of_a_mesh_beside_particles_are_left_out() {
    let poly = |counts: &str, cells: &[String]| six("PolyData", counts, &cells.concat());
    let grid = |count: usize, cells: String| {
        six("UnstructuredGrid", &format!("NumberOfCells=\"{count}\""), &cells)
    };
    let three = cells_of("Verts", "1 2 3", "0 1 2", "");
    let face = |points: &str| cells_of("Polys", "3", points, "");
    for (name, text, expected) in [
        (
            "VTP",
            poly("NumberOfVerts=\"3\" NumberOfPolys=\"1\"", &[three.clone(), face("3 4 5")]),
            &[0, 1, 2][..],
        ),
        (
            "VTP, the mesh first, one cell of all particles",
            poly(
                "NumberOfVerts=\"1\" NumberOfPolys=\"1\"",
                &[cells_of("Verts", "3", "5 3 4", ""), face("0 1 2")],
            ),
            &[3, 4, 5],
        ),
        (
            "VTP, vertices of some",
            poly("NumberOfVerts=\"3\"", &[cells_of("Verts", "1 2 3", "4 0 2", "")]),
            &[0, 2, 4],
        ),
        ("VTU", grid(4, cells_of("Cells", "1 2 5 6", "0 2 1 3 4 5", "1 1 5 1")), &[0, 2, 5]),
        (
            "VTU, one cell of several",
            grid(2, cells_of("Cells", "2 6", "4 5 0 1 2 3", "2 9")),
            &[4, 5],
        ),
    ] {
        let whole = parsed(&text, Extension::Vtu);
        let ids: Vec<u32> = whole.positions.iter().map(|p| p[0] as u32).collect();
        assert_eq!((ids.as_slice(), whole.ids.as_deref()), (expected, Some(expected)), "{name}");
        let told = format!("{} of 6 points are left out", 6 - expected.len());
        assert!(
            whole.warnings.len() == 1 && whole.warnings[0].contains(&told),
            "{name}: {:?}",
            whole.warnings
        );
        for most in 1..4 {
            let parts = Parts::of_bytes(text.as_bytes(), Extension::Vtu, most).unwrap();
            assert_eq!(parts.total(), expected.len(), "{name}");
            let ids: Vec<u32> = parts.flat_map(|part| part.unwrap().ids.unwrap()).collect();
            assert_eq!(ids, expected, "{name} in parts of {most}");
        }
    }
    let old = |version: &str, kind: &str, cells: &str| {
        let points: String = (0..6).map(|x| format!("{x} 0 0 ")).collect();
        format!(
            "# vtk DataFile Version {version}\nt\nASCII\nDATASET {kind}\nPOINTS 6 float\n{points}\n{cells}\n\
             POINT_DATA 6\nSCALARS id int\nLOOKUP_TABLE default\n0 1 2 3 4 5\n"
        )
    };
    for (name, text, expected) in [
        (
            "polygons",
            old("4.2", "POLYDATA", "VERTICES 3 6\n1 0 1 2 1 1\nPOLYGONS 1 4\n3 3 4 5"),
            [0, 1, 2],
        ),
        ("some", old("4.2", "POLYDATA", "VERTICES 1 4\n3 5 1 3"), [1, 3, 5]),
        (
            "version 5",
            old(
                "5.1",
                "POLYDATA",
                "VERTICES 3 3\nOFFSETS vtktypeint64\n0 1 3\nCONNECTIVITY vtktypeint64\n3 4 5\nPOLYGONS 2 3\n\
                 OFFSETS vtktypeint64\n0 3\nCONNECTIVITY vtktypeint64\n0 1 2",
            ),
            [3, 4, 5],
        ),
        (
            "grid",
            old(
                "4.2",
                "UNSTRUCTURED_GRID",
                "CELLS 4 10\n1 0 1 2 3 1 3 4 1 5\nCELL_TYPES 4\n1 1 5 1",
            ),
            [0, 2, 5],
        ),
    ] {
        let p = parsed(&text, Extension::Vtk);
        assert_eq!(p.ids, Some(expected.to_vec()), "{name}");
        assert!(p.warnings[0].contains("3 of 6 points are left out"), "{name}: {:?}", p.warnings);
        let parts = Parts::of_bytes(text.as_bytes(), Extension::Vtk, 2).unwrap();
        let ids: Vec<u32> = parts.flat_map(|part| part.unwrap().ids.unwrap()).collect();
        assert_eq!(ids, expected, "{name}");
    }
    for (name, text, mesh) in [
        (
            "faces between particles",
            poly(
                "NumberOfVerts=\"1\" NumberOfPolys=\"1\"",
                &[cells_of("Verts", "6", "0 1 2 3 4 5", ""), face("0 1 2")],
            ),
            false,
        ),
        ("points alone of meshio", grid(1, cells_of("Cells", "1", "0", "1")), false),
        ("corners of Gmsh", grid(3, cells_of("Cells", "1 4 7", "0 0 1 2 3 4 5", "1 5 5")), true),
        (
            "no such point",
            poly("NumberOfVerts=\"3\"", &[cells_of("Verts", "1 2 3", "4 0 6", "")]),
            false,
        ),
        ("no list", poly("NumberOfVerts=\"3\"", &[]), false),
    ] {
        let p = parsed(&text, Extension::Vtu);
        assert_eq!(p.positions.len(), 6, "{name}");
        assert_eq!(p.warnings.len(), usize::from(mesh), "{name}: {:?}", p.warnings);
    }
}
