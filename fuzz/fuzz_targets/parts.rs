//! Files that are read in parts: the same particles as those that are read at once, or a fault in both. The input's
//! first byte chooses the beginning, its second the size of a part.
#![no_main]

use libfuzzer_sys::fuzz_target;
use whitewater::io::particles::{Extension, Particles, Parts, read_bytes};

/// Beginnings and hints that lead to the formats which are read in parts.
const STARTS: [(&[u8], Extension); 19] = [
    (b"", Extension::Unknown),
    (b"", Extension::Csv),
    (b"", Extension::Xyz),
    (b"x,y,z,id\n", Extension::Csv),
    (b"Np\n3\nPos.x [m];Pos.y [m];Pos.z [m];Idp;\n", Extension::Csv),
    (b"3\nProperties=pos:R:3:id:I:1\n", Extension::Xyz),
    (b"ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n3\nITEM: ATOMS id x y z\n", Extension::Unknown),
    (b"BgeoV\0\0\0\x05", Extension::Unknown),
    (b"PGEOMETRY V5\nNPoints 3 NPointAttrib 1\nid 1 int 0\n", Extension::Unknown),
    (b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float ", Extension::Unknown),
    (b"ply\nformat binary_", Extension::Unknown),
    (b"\x93NUMPY\x01\0", Extension::Unknown),
    (b"PK\x03\x04", Extension::Unknown),
    (
        b"# vtk DataFile Version 4.2\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n",
        Extension::Unknown,
    ),
    (
        b"# vtk DataFile Version 4.2\nt\nBINARY\nDATASET POLYDATA\nPOINTS 3 float\n",
        Extension::Unknown,
    ),
    (
        b"<VTKFile type=\"PolyData\"><Piece NumberOfPoints=\"3\"><Points><DataArray ",
        Extension::Unknown,
    ),
    // Fields of cells, in another order than the points.
    (
        b"# vtk DataFile Version 4.2\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\nVERTICES 3 6\n\
          1 2 1 0 1 1\nCELL_DATA 3\n",
        Extension::Unknown,
    ),
    (
        b"<VTKFile type=\"PolyData\"><Piece NumberOfPoints=\"3\" NumberOfVerts=\"3\"><Points><DataArray type=\"Float32\" \
          NumberOfComponents=\"3\">0 0 0 1 0 0 0 1 0</DataArray></Points><Verts><DataArray type=\"Int32\" Name=\"offsets\">\
          1 2 3</DataArray><DataArray type=\"Int32\" Name=\"connectivity\">2 0 1</DataArray></Verts><CellData><DataArray ",
        Extension::Unknown,
    ),
    (
        b"ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS xy xz yz\n0 2 1\n0 1 0.5\n0 1 0\nITEM: ATOMS id xs \
          ys zs\n",
        Extension::Unknown,
    ),
];

/// Position after position, as bits: no NaN is equal to itself.
fn bits<'a>(particles: impl Iterator<Item = &'a Particles>) -> Vec<u32> {
    particles.flat_map(|p| p.positions.as_flattened()).map(|x| x.to_bits()).collect()
}

fuzz_target!(|data: &[u8]| {
    let [start, size, data @ ..] = data else { return };
    let (start, hint) = STARTS[usize::from(*start) % STARTS.len()];
    let bytes = [start, data].concat();
    let whole = read_bytes(&bytes, hint);
    // The beginnings announce three particles: only smaller parts read the file twice.
    let parts = Parts::of_bytes(&bytes, hint, usize::from(*size % 4));
    match (whole, parts) {
        (Err(_), Err(_)) => {}
        (Ok(whole), Ok(parts)) => {
            let about = parts.about().clone();
            assert_eq!(about.warnings, whole.warnings);
            assert_eq!(about.attributes, whole.attributes);
            assert_eq!(about.format, whole.format);
            assert_eq!(about.meanings, whole.meanings);
            assert_eq!(about.time.map(f64::to_bits), whole.time.map(f64::to_bits));
            assert_eq!(about.origin.map(f64::to_bits), whole.origin.map(f64::to_bits));
            assert_eq!(parts.total(), whole.positions.len());
            let parts = parts.collect::<Result<Vec<_>, _>>().expect("faults are found first");
            assert_eq!(bits(std::iter::once(&whole)), bits(parts.iter()));
            for field in [
                |p: &Particles| p.densities.clone().unwrap_or_default(),
                |p: &Particles| p.lifetimes.clone().unwrap_or_default(),
                |p: &Particles| p.velocities.iter().flatten().flatten().copied().collect(),
            ] {
                let field = |p: &Particles| -> Vec<u32> {
                    field(p).into_iter().map(f32::to_bits).collect()
                };
                assert_eq!(field(&whole), parts.iter().flat_map(field).collect::<Vec<_>>());
            }
            let ids = parts.iter().flat_map(|p| p.ids.iter().flatten()).copied();
            assert_eq!(whole.ids.unwrap_or_default(), ids.collect::<Vec<_>>());
            let kinds = parts.iter().flat_map(|p| p.kinds.iter().flatten()).copied();
            assert_eq!(whole.kinds.unwrap_or_default(), kinds.collect::<Vec<_>>());
        }
        (whole, parts) => panic!("{:?} but in parts {:?}", whole.err(), parts.err()),
    }
});
