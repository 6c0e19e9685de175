//! Recognises valid files of unsupported formats by their first bytes, and says how to convert them.

use super::bytes;
use super::error::ReadError;

/// Number of bytes that suffice for the detection.
pub(super) const START: usize = 512;

const EXPORT: &str = "export the particles as classic BGEO, VTU, PLY or NPZ";

/// First bytes, name of the format, and advice.
const MAGIC: &[(&[u8], &str, &str)] = &[
    #[cfg(not(feature = "hdf5"))]
    (
        b"\x89HDF\r\n\x1a\n",
        "HDF5",
        "save its arrays as NPZ, in Python: h = h5py.File('FILE'); \
         np.savez('out.npz', position=h['POSITIONS'], velocity=h['VELOCITIES'])",
    ),
    (b"Ogawa", "Alembic", EXPORT),
    (b"PXR-USDC", "USD", EXPORT),
    (b"#usda", "USD", EXPORT),
    (
        b"\x20\x42\x44\x56\0\0\0\0",
        "OpenVDB",
        "it holds volumes or packed points: export the particles they were made of",
    ),
    (
        b"#FileJBD",
        "a .bi4 file of DualSPHysics",
        "run its PartVTK with -savevtk or -savecsv and give what that writes",
    ),
    (b"PB01", "particles of Mantaflow (.uni)", EXPORT),
    (b"PB02", "particles of Mantaflow (.uni)", EXPORT),
    (b"PD01", "data of particles of Mantaflow (.uni)", EXPORT),
    (b"MNT1", "a grid of Mantaflow (.uni)", "export the particles, as BGEO, VTU, PLY or NPZ"),
    (b"MNT2", "a grid of Mantaflow (.uni)", "export the particles, as BGEO, VTU, PLY or NPZ"),
    (b"MNT3", "a grid of Mantaflow (.uni)", "export the particles, as BGEO, VTU, PLY or NPZ"),
    (b"BPHYSICS", "a cache of Blender (.bphys)", EXPORT),
    (b"BLENDER", "a scene of Blender", EXPORT),
    (b"\xda\xba\xfa\0", "particles of RealFlow (.bin)", EXPORT),
    (b"\xc0PRT\r\n\x1a\n", "particles of Krakatoa (.prt)", EXPORT),
    (b"PDC ", "particles of Maya (.pdc)", EXPORT),
    (b"FOR4", "a cache of Maya (.mc)", EXPORT),
    (b"FOR8", "a cache of Maya (.mc)", EXPORT),
    (b"LASF", "a point cloud of a laser scanner (LAS)", EXPORT),
    (b"ASTM-E57", "a point cloud of a laser scanner (E57)", EXPORT),
    (
        b"# .PCD",
        "a point cloud of PCL (PCD)",
        "save it as PLY: pcl_pcd2ply, or Open3D's write_point_cloud",
    ),
    (b"glTF", "a scene of meshes (glTF)", "give particles here, and meshes with --scene"),
    (b"Kaydara FBX", "a scene of meshes (FBX)", EXPORT),
    (b"CDF\x01", "NetCDF", "save its arrays as NPZ: np.savez('out.npz', position=p, velocity=v)"),
    (b"CDF\x02", "NetCDF", "save its arrays as NPZ: np.savez('out.npz', position=p, velocity=v)"),
    (b"CDF\x05", "NetCDF", "save its arrays as NPZ: np.savez('out.npz', position=p, velocity=v)"),
    (
        b"MATLAB 5.0",
        "a file of MATLAB",
        "save its arrays as NPZ: np.savez('out.npz', **scipy.io.loadmat('FILE'))",
    ),
    (
        b"MATLAB 7.3",
        "a file of MATLAB 7.3 without readable HDF5 in it",
        "save its arrays as NPZ: h = h5py.File('FILE'); np.savez('out.npz', position=h['pos'][()].T)",
    ),
    (b"\xdf\x65\xdf\x65\xdf\x65\xdf\x65", "a trajectory of HOOMD (GSD)", EXPORT),
    (
        b"LAMMPS",
        "a data file of LAMMPS",
        "write a dump: write_dump all custom out.dump id type x y z vx vy vz",
    ),
    (b"HETATM", "a file of molecules (PDB)", "save the points as XYZ, CSV or NPZ"),
    (b"ATOM  ", "a file of molecules (PDB)", "save the points as XYZ, CSV or NPZ"),
    (b"#!TDV", "Tecplot's binary form", "save it as text (.dat), or as VTU"),
    (b"#!SZPLT", "Tecplot's binary form", "save it as text (.dat), or as VTU"),
    (b"PAR1", "Parquet", "save CSV: pandas.read_parquet('FILE').to_csv('out.csv', index=False)"),
    (b"ARROW1", "Arrow", "save CSV: pandas.read_feather('FILE').to_csv('out.csv', index=False)"),
    (b"\x80\x03", "a pickle of Python", "save arrays: np.savez('out.npz', position=p, velocity=v)"),
    (b"\x80\x04", "a pickle of Python", "save arrays: np.savez('out.npz', position=p, velocity=v)"),
    (b"\x80\x05", "a pickle of Python", "save arrays: np.savez('out.npz', position=p, velocity=v)"),
    (b"\x28\xb5\x2f\xfd", "a file packed by zstd", "unpack it: zstd -d FILE"),
    (b"BZh", "a file packed by bzip2", "unpack it: bunzip2 FILE"),
    (b"\xfd7zXZ\0", "a file packed by xz", "unpack it: unxz FILE"),
    (
        b"version https://git-lfs",
        "a pointer of Git LFS, which stands for the file,",
        "fetch the file: git lfs pull",
    ),
    (b"<!DOCTYPE html", "a web page", "fetch the file itself (its raw form)"),
    (b"<html", "a web page", "fetch the file itself (its raw form)"),
];

/// The error for a file of a known but unsupported format; `None` if it is unknown.
pub(super) fn told(bytes: &[u8]) -> Option<ReadError> {
    let head = bytes.get(..bytes.len().min(START)).unwrap_or(bytes);
    let unsupported =
        |what: &str, advice| Some(ReadError::Unsupported { what: what.into(), advice });
    if let Some((_, what, advice)) = MAGIC.iter().find(|(magic, ..)| head.starts_with(magic)) {
        return unsupported(what, advice);
    }
    if head.get(257..).is_some_and(|rest| rest.starts_with(b"ustar")) {
        return unsupported("an archive (tar)", "unpack it: tar xf FILE");
    }
    // The name of the first entry in a zip.
    if let (true, Some(rest)) = (head.starts_with(b"PK\x03\x04"), head.get(30..)) {
        let length =
            head.get(26..28).and_then(|l| l.first_chunk::<2>()).map(|l| u16::from_le_bytes(*l));
        let name = rest.get(..usize::from(length.unwrap_or(0))).unwrap_or_default();
        let ends = |end: &[u8]| name.to_ascii_lowercase().ends_with(end);
        if [&b".usd"[..], b".usda", b".usdc"].iter().any(|end| ends(end)) {
            return unsupported("USD (.usdz)", EXPORT);
        }
        if name.starts_with(b"[Content_Types]") || name.starts_with(b"_rels/") {
            return unsupported("a spreadsheet", "save it as CSV");
        }
    }
    // OpenFOAM headers may follow a banner.
    let text = head.trim_ascii_start();
    if text.starts_with(b"FoamFile")
        || (text.starts_with(b"/*")
            && head.windows(8).any(|w| w == b"OpenFOAM" || w == b"FoamFile"))
    {
        return unsupported(
            "a file of OpenFOAM",
            "run foamToVTK and give the VTK files of the cloud that it writes",
        );
    }
    None
}

/// The error for a text of a known but unsupported format without first words of its own; `None` if it is unknown.
pub(super) fn told_of_text(text: &[u8]) -> Option<ReadError> {
    let head = text.get(..text.len().min(8 * START)).unwrap_or(text);
    let mut lines = head.split(|b| *b == b'\n').map(<[u8]>::trim_ascii_end);
    let number = |word: &[u8]| bytes::parse_number(word.trim_ascii()).is_some();
    let vertex = |line: &[u8]| {
        line.strip_prefix(b"v ").is_some_and(|rest| {
            let words = rest.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
            words.take(3).filter(|word| number(word)).count() == 3
        })
    };
    // Rows `v x y z` alone are read as a table.
    let words = [&b"mtllib "[..], b"usemtl ", b"vn ", b"vt ", b"f ", b"o ", b"g "];
    let named = |line: &[u8]| words.iter().any(|word| line.starts_with(word));
    if lines.clone().any(vertex) && lines.clone().any(named) {
        return Some(ReadError::Unsupported {
            what: "a mesh of Wavefront (.obj)".into(),
            advice: "keep its points alone: grep '^v ' FILE | cut -d' ' -f2-4 > points.xyz, or export PLY",
        });
    }
    // A title, a count, and columns of fixed width, the positions from the 21st character on.
    let count = lines.nth(1)?.trim_ascii();
    let first = lines.next()?;
    let places = [0..5, 15..20, 20..28, 28..36, 36..44];
    let atom = places.into_iter().all(|place| first.get(place).is_some_and(number));
    (atom && !count.is_empty() && count.iter().all(u8::is_ascii_digit)).then(|| {
        ReadError::Unsupported {
            what: "a configuration of GROMACS (.gro)".into(),
            advice: "save its positions: np.save('out.npy', MDAnalysis.Universe('FILE').atoms.positions)",
        }
    })
}
