//! One small cloud in every format and encoding, byte by byte.

use std::io::Write;

use base64::Engine;
use whitewater::io::particles::{Compression, Extension, Format, Particles, Storage};

pub const COUNT: usize = 11;

/// Positions that 32-bit floats, and text of seven digits, hold exactly.
pub fn positions() -> Vec<[f32; 3]> {
    (0..COUNT)
        .map(|i| {
            let t = i as f32;
            [0.25 * t - 1.0, 0.5 + 0.125 * (t * 3.0 % 7.0), -0.375 * t]
        })
        .collect()
}

pub fn velocities() -> Vec<[f32; 3]> {
    (0..COUNT)
        .map(|i| {
            let t = i as f32;
            [1.5 - t, 0.0625 * t, -2.0]
        })
        .collect()
}

pub fn densities() -> Vec<f32> {
    (0..COUNT).map(|i| 1000.0 + 0.5 * i as f32).collect()
}

pub fn ids() -> Vec<u32> {
    (0..COUNT as u32).map(|i| 500 - 40 * i).collect()
}

/// What a sample has beside positions.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Has {
    Positions,
    All,
}

pub struct Sample {
    pub name: String,
    pub hint: Extension,
    pub bytes: Vec<u8>,
    pub has: Has,
    pub format: Format,
}

fn sample(
    name: &str,
    hint: Extension,
    bytes: impl Into<Vec<u8>>,
    has: Has,
    format: Format,
) -> Sample {
    Sample { name: name.into(), hint, bytes: bytes.into(), has, format }
}

/// Fails unless the particles are those of this file.
pub fn check(name: &str, particles: &Particles, has: Has) {
    assert_eq!(particles.positions, positions(), "{name}: positions");
    match has {
        Has::Positions => {
            assert_eq!(particles.velocities, None, "{name}: velocities");
            assert_eq!(particles.ids, None, "{name}: ids");
        }
        Has::All => {
            assert_eq!(particles.velocities, Some(velocities()), "{name}: velocities");
            assert_eq!(particles.densities, Some(densities()), "{name}: densities");
            assert_eq!(particles.ids, Some(ids()), "{name}: ids");
        }
    }
    assert!(!particles.attributes.is_empty(), "{name}: attributes");
}

/// Values as bytes of `size` 4 or 8.
pub fn floats(values: &[f32], size: usize, big: bool) -> Vec<u8> {
    values
        .iter()
        .flat_map(|v| match (size, big) {
            (4, true) => v.to_be_bytes().to_vec(),
            (4, false) => v.to_le_bytes().to_vec(),
            (_, true) => f64::from(*v).to_be_bytes().to_vec(),
            (_, false) => f64::from(*v).to_le_bytes().to_vec(),
        })
        .collect()
}

pub fn ints(values: &[u32], size: usize, big: bool) -> Vec<u8> {
    values
        .iter()
        .flat_map(|v| match (size, big) {
            (4, true) => v.to_be_bytes().to_vec(),
            (4, false) => v.to_le_bytes().to_vec(),
            (_, true) => u64::from(*v).to_be_bytes().to_vec(),
            (_, false) => u64::from(*v).to_le_bytes().to_vec(),
        })
        .collect()
}

pub fn words<T: ToString>(values: impl IntoIterator<Item = T>) -> String {
    let words: Vec<_> = values.into_iter().map(|v| v.to_string()).collect();
    words.join(" ")
}

pub fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut out = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    out.write_all(bytes).unwrap();
    out.finish().unwrap()
}

/// BGEO with a text attribute between the others and a vector of two components.
pub fn bgeo() -> Vec<u8> {
    let mut out = b"BgeoV".to_vec();
    for n in [5, COUNT as i32, 3, 0, 0, 5, 1, 1, 0] {
        out.extend(n.to_be_bytes());
    }
    let mut define = |name: &str, size: u16, ty: i32, rest: &[u8]| {
        out.extend((name.len() as u16).to_be_bytes());
        out.extend(name.as_bytes());
        out.extend(size.to_be_bytes());
        out.extend(ty.to_be_bytes());
        out.extend(rest);
    };
    define("life", 2, 0, &[0; 8]);
    define("id", 1, 1, &[0; 4]);
    define("material", 1, 4, b"\0\0\0\x02\0\x05water\0\x03air");
    define("velocity", 3, 5, &[0; 12]);
    define("density", 1, 0, &[0; 4]);
    for i in 0..COUNT {
        out.extend(floats(&positions()[i], 4, true));
        out.extend(floats(&[1.0, 7.0, 8.0], 4, true));
        out.extend(ints(&[ids()[i], 1], 4, true));
        out.extend(floats(&velocities()[i], 4, true));
        out.extend(floats(&[densities()[i]], 4, true));
    }
    // Primitives and their attributes follow; nothing of them is needed.
    out.extend(b"\0\x09generator\0\x01\0\0\0\x04\0\0\0\x01\0\x04papi\0\0\x80\0\0\xff");
    out
}

pub fn geo() -> String {
    let mut out = format!(
        "PGEOMETRY V5\nNPoints {COUNT} NPrims 1\nNPointGroups 0 NPrimGroups 0\n\
         NPointAttrib 5 NVertexAttrib 0 NPrimAttrib 1 NAttrib 0\nPointAttrib\n\
         life 2 float 0 0\nid 1 int 0\nmaterial 1 index 2 water air\nvelocity 3 vector 0 0 0\ndensity 1 float 0\n"
    );
    for i in 0..COUNT {
        let (p, v) = (positions()[i], velocities()[i]);
        out +=
            &format!("{} 1 (7 8\t{}\t1\t{}\t{})\n", words(p), ids()[i], words(v), densities()[i]);
    }
    out + "PrimitiveAttrib\ngenerator 1 index 1 papi\nPart 1 0 [0]\nbeginExtra\nendExtra\n"
}

/// Legacy VTK. `double` writes double and 64-bit ids.
pub fn vtk(version: &str, binary: bool, polydata: bool, double: bool) -> Vec<u8> {
    let mut out = format!(
        "# vtk DataFile Version {version}\na title\n{}\nDATASET {}\n",
        if binary { "BINARY" } else { "ASCII" },
        if polydata { "POLYDATA" } else { "UNSTRUCTURED_GRID" }
    )
    .into_bytes();
    let size = if double { 8 } else { 4 };
    // All three are 32 bits wide.
    let id_32 = match (polydata, version) {
        (true, "4.2") => "vtkIdType",
        (true, _) => "int",
        (false, _) => "unsigned_int",
    };
    let (real, id) = if double { ("double", "vtktypeint64") } else { ("float", id_32) };
    let put = |out: &mut Vec<u8>, head: String, raw: Vec<u8>, text: String| {
        out.extend(head.as_bytes());
        out.extend(if binary { raw } else { text.into_bytes() });
        out.push(b'\n');
    };
    let numbers: Vec<u32> = (0..COUNT as u32).collect();
    // Something of no use before the points, as ParaView has with time values.
    put(
        &mut out,
        "FIELD FieldData 1\nTIME 1 1 double\n".into(),
        floats(&[0.5], 8, true),
        "0.5".into(),
    );
    put(
        &mut out,
        format!("POINTS {COUNT} {real}\n"),
        floats(positions().as_flattened(), size, true),
        words(positions().as_flattened()),
    );
    out.extend(
        b"METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 2\n\n",
    );
    let cells = if polydata { "VERTICES" } else { "CELLS" };
    if version.starts_with('5') {
        let offsets: Vec<u32> = (0..=COUNT as u32).collect();
        out.extend(format!("{cells} {} {COUNT}\n", COUNT + 1).as_bytes());
        put(&mut out, "OFFSETS vtktypeint64\n".into(), ints(&offsets, 8, true), words(&offsets));
        put(
            &mut out,
            "CONNECTIVITY vtktypeint64\n".into(),
            ints(&numbers, 8, true),
            words(&numbers),
        );
    } else {
        let list: Vec<u32> = numbers.iter().flat_map(|i| [1, *i]).collect();
        put(
            &mut out,
            format!("{cells} {COUNT} {}\n", 2 * COUNT),
            ints(&list, 4, true),
            words(&list),
        );
    }
    if !polydata {
        let types = [1_u32; COUNT];
        put(&mut out, format!("CELL_TYPES {COUNT}\n"), ints(&types, 4, true), words(types));
    }
    // Of the cells: must not be taken for those of the points.
    out.extend(format!("CELL_DATA {COUNT}\n").as_bytes());
    put(
        &mut out,
        "SCALARS density float 1\nLOOKUP_TABLE default\n".into(),
        floats(&[1.0; COUNT], 4, true),
        words([1.0; COUNT]),
    );
    out.extend(format!("POINT_DATA {COUNT}\n").as_bytes());
    put(
        &mut out,
        format!("SCALARS id {id} 1\nLOOKUP_TABLE id_table\n"),
        ints(&ids(), size, true),
        words(ids()),
    );
    put(
        &mut out,
        format!("VECTORS velocity {real}\n"),
        floats(velocities().as_flattened(), size, true),
        words(velocities().as_flattened()),
    );
    out.extend(b"FIELD FieldData 3\n");
    put(&mut out, "my%20flags 1 11 bit\n".into(), vec![0xff, 0xe0], words([1; COUNT]));
    out.extend(b"METADATA\nCOMPONENT_NAMES\nflag\n\n");
    let texts: Vec<u8> = (0..COUNT).flat_map(|i| [0xc0 | 2, b'a', b'a' + i as u8]).collect();
    put(&mut out, format!("label 1 {COUNT} string\n"), texts, ["ab"; COUNT].join("\n"));
    put(
        &mut out,
        format!("density 1 {COUNT} {real}\n"),
        floats(&densities(), size, true),
        words(densities()),
    );
    out
}

pub struct Xml {
    pub vtp: bool,
    pub storage: Storage,
    pub compression: Compression,
    pub big: bool,
    pub wide: bool,
    /// Where the particles are cut into two pieces.
    pub pieces: bool,
    pub double: bool,
}

fn pack(block: &[u8], compression: Compression) -> Vec<u8> {
    match compression {
        Compression::Zlib => {
            let mut out = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
            out.write_all(block).unwrap();
            out.finish().unwrap()
        }
        // One run of literals.
        Compression::Lz4 => {
            let mut out = Vec::new();
            if block.len() < 15 {
                out.push((block.len() as u8) << 4);
            } else {
                out.extend([0xf0, (block.len() - 15) as u8]);
            }
            out.extend(block);
            out
        }
        _ => unreachable!("a file is checked in for LZMA"),
    }
}

impl Xml {
    fn word(&self, n: usize) -> Vec<u8> {
        ints(&[n as u32], if self.wide { 8 } else { 4 }, self.big)
    }

    fn encoded(&self, raw: &[u8]) -> Vec<u8> {
        let base64 = |b: &[u8]| base64::engine::general_purpose::STANDARD.encode(b).into_bytes();
        let (head, data) = if self.compression == Compression::None {
            (self.word(raw.len()), raw.to_vec())
        } else {
            const BLOCK: usize = 48;
            let blocks: Vec<_> = raw.chunks(BLOCK).map(|b| pack(b, self.compression)).collect();
            let mut head =
                [self.word(blocks.len()), self.word(BLOCK), self.word(raw.len() % BLOCK)].concat();
            blocks.iter().for_each(|b| head.extend(self.word(b.len())));
            (head, blocks.concat())
        };
        match (self.storage, self.compression) {
            (Storage::AppendedRaw, _) => [head, data].concat(),
            (_, Compression::None) => base64(&[head, data].concat()),
            _ => [base64(&head), base64(&data)].concat(),
        }
    }

    fn array(
        &self,
        appended: &mut Vec<u8>,
        ty: &str,
        name: &str,
        components: usize,
        raw: &[u8],
        text: &str,
    ) -> String {
        let head =
            format!("<DataArray type=\"{ty}\" Name=\"{name}\" NumberOfComponents=\"{components}\"");
        let key = "<InformationKey name=\"L2_NORM_RANGE\" location=\"vtkDataArray\" length=\"1\"><Value index=\"0\">1</Value></InformationKey>";
        match self.storage {
            Storage::Ascii => format!("{head} format=\"ascii\">\n{text}\n{key}</DataArray>\n"),
            Storage::InlineBase64 => {
                let data = String::from_utf8(self.encoded(raw)).unwrap();
                format!("{head} format=\"binary\">{key}\n {data}\n</DataArray>\n")
            }
            _ => {
                let offset = appended.len();
                appended.extend(self.encoded(raw));
                format!("{head} format=\"appended\" offset=\"{offset}\"/>\n")
            }
        }
    }

    pub fn bytes(&self) -> Vec<u8> {
        let kind = if self.vtp { "PolyData" } else { "UnstructuredGrid" };
        let compressor = match self.compression {
            Compression::Zlib => " compressor=\"vtkZLibDataCompressor\"",
            Compression::Lz4 => " compressor=\"vtkLZ4DataCompressor\"",
            _ => "",
        };
        let mut out = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"{}\" header_type=\"{}\"{compressor}>\n<{kind}>\n",
            if self.big { "BigEndian" } else { "LittleEndian" },
            if self.wide { "UInt64" } else { "UInt32" },
        );
        let (size, real, id) =
            if self.double { (8, "Float64", "UInt64") } else { (4, "Float32", "Int32") };
        let mut appended = Vec::new();
        let cuts: &[usize] = if self.pieces { &[0, 4, 4, COUNT] } else { &[0, COUNT] };
        for (from, to) in cuts.iter().zip(&cuts[1..]) {
            let range = *from..*to;
            out += &format!(
                "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"0\">\n<PointData>\n",
                range.len()
            );
            let v = &velocities()[range.clone()];
            let v = v.as_flattened();
            out += &self.array(
                &mut appended,
                real,
                "velocity",
                3,
                &floats(v, size, self.big),
                &words(v),
            );
            let unused = vec![1.0; range.len()];
            out += &self.array(
                &mut appended,
                real,
                "pressure",
                1,
                &floats(&unused, size, self.big),
                &words(&unused),
            );
            let d = &densities()[range.clone()];
            out += &self.array(
                &mut appended,
                real,
                "density",
                1,
                &floats(d, size, self.big),
                &words(d),
            );
            let i = &ids()[range.clone()];
            out += &self.array(&mut appended, id, "id", 1, &ints(i, size, self.big), &words(i));
            let p = &positions()[range];
            let p = p.as_flattened();
            out += "</PointData>\n<CellData/>\n<Points>\n";
            out += &self.array(
                &mut appended,
                real,
                "Points",
                3,
                &floats(p, size, self.big),
                &words(p),
            );
            out += "</Points>\n</Piece>\n";
        }
        out += &format!("</{kind}>\n");
        let encoding = match self.storage {
            Storage::AppendedRaw => "raw",
            Storage::AppendedBase64 => "base64",
            _ => return format!("{out}</VTKFile>\n").into_bytes(),
        };
        let mut out = format!("{out}<AppendedData encoding=\"{encoding}\">\n   _").into_bytes();
        out.extend(appended);
        out.extend(b"\n  </AppendedData>\n</VTKFile>\n");
        out
    }
}

/// PLY with an element and a list before and among the vertices.
pub fn ply(format: &str, double: bool, lists: bool) -> Vec<u8> {
    let real = if double { "double" } else { "float32" };
    let mut out = format!("ply\nformat {format} 1.0\ncomment by hand\n");
    if lists {
        out += "element camera 2\nproperty uchar kind\nproperty list uchar float matrix\nelement empty 99999999999\n";
    }
    out += &format!("element vertex {COUNT}\n");
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
        for i in 0..COUNT {
            let (p, v, d) = (positions()[i], velocities()[i], densities()[i]);
            let list = if lists { " 2 7 7" } else { "" };
            out.extend(format!("{} {} {d}{list} {}\n", words(p), words(v), ids()[i]).as_bytes());
        }
        return out;
    }
    if lists {
        out.extend([1, 2]);
        out.extend(floats(&[0.5, 0.5], 4, big));
        out.extend([1, 0]);
    }
    for i in 0..COUNT {
        out.extend(floats(&positions()[i], size, big));
        out.extend(floats(&velocities()[i], size, big));
        out.extend(floats(&densities()[i..=i], size, big));
        if lists {
            out.extend(ints(&[1], 4, big));
            out.extend([9, 9]);
        }
        out.extend(ints(&ids()[i..=i], 4, big));
    }
    out
}

pub fn npy(descr: &str, shape: &str, fortran: bool, version: u8, raw: &[u8]) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let header =
        format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': {shape}, }}   \n");
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

/// All values of the first component, then all of the second ...
pub fn columns(vectors: &[[f32; 3]]) -> Vec<f32> {
    (0..3).flat_map(|c| vectors.iter().map(move |v| v[c])).collect()
}

fn csv(header: &str, separator: &str, quote: &str) -> String {
    let mut out = String::new();
    if !header.is_empty() {
        let names: Vec<_> = header.split(' ').map(|n| format!("{quote}{n}{quote}")).collect();
        out += &(names.join(separator) + "\r\n");
    }
    for i in 0..COUNT {
        let row = format!(
            "{} {} {} {}",
            words(velocities()[i]),
            densities()[i],
            ids()[i],
            words(positions()[i])
        );
        out += &(row.replace(' ', separator) + "\r\n");
    }
    out
}

fn rows() -> String {
    positions().iter().map(|p| words(p) + "\n").collect()
}

fn numpy_samples(list: &mut Vec<Sample>) {
    let p = positions();
    let p = p.as_flattened();
    let shape = format!("({COUNT}, 3)");
    let arrays = [
        ("<f4, C", npy("<f4", &shape, false, 1, &floats(p, 4, false))),
        (">f8, C, version 2", npy(">f8", &shape, false, 2, &floats(p, 8, true))),
        ("<f4, Fortran", npy("<f4", &shape, true, 1, &floats(&columns(&positions()), 4, false))),
        (
            ">f4, Fortran, version 3",
            npy(">f4", &shape, true, 3, &floats(&columns(&positions()), 4, true)),
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
    let row = format!("({COUNT},)");
    let velocity = velocities();
    let common = [
        ("rho", npy("<f8", &row, false, 1, &floats(&densities(), 8, false))),
        ("ids", npy("<i8", &row, false, 1, &ints(&ids(), 8, false))),
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
    let mut arrays = common.to_vec();
    for (c, (pos, vel)) in [("x", "vx"), ("y", "vy"), ("z", "vz")].into_iter().enumerate() {
        let pick = |v: &[[f32; 3]]| floats(&v.iter().map(|v| v[c]).collect::<Vec<_>>(), 4, false);
        arrays.push((pos, npy("<f4", &row, false, 1, &pick(&positions()))));
        arrays.push((vel, npy("<f4", &row, false, 1, &pick(&velocity))));
    }
    list.push(sample(
        "npz of components",
        Extension::Npz,
        npz(&arrays, true),
        Has::All,
        Format::Npz,
    ));
}

fn text_samples(list: &mut Vec<Sample>) {
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
            csv(header, separator, quote),
            All,
            Format::Csv,
        ));
    }
    let hashed = format!("# {}", csv("vx vy vz rho id x y z", ",", ""));
    list.push(sample("csv with a hashed header", Extension::Csv, hashed, All, Format::Csv));
    let named_csv = csv("vx vy vz rho id x y z", ",", "");
    list.push(sample("csv named .xyz", Extension::Xyz, named_csv, All, Format::Csv));
    list.push(sample(
        "csv without names",
        Extension::Csv,
        rows().replace(' ', ","),
        Positions,
        Format::Csv,
    ));
    list.push(sample("xyz", Extension::Xyz, rows(), Positions, Format::Xyz));
    let variants = [
        ("with comments", format!("# x y z\n% more\n\n{}\n", rows())),
        ("with a count", format!("{COUNT}\n{}", rows())),
        ("with a count and a comment", format!("{COUNT}\ntime 0.5 s\n{}", rows())),
        ("with commas", rows().replace(' ', ", ")),
        ("with more columns", rows().replace('\n', " 9 9\n")),
        ("with a byte order mark", format!("\u{feff}{}", rows())),
    ];
    for (name, text) in variants {
        list.push(sample(&format!("xyz {name}"), Extension::Xyz, text, Positions, Format::Xyz));
    }
    let table = csv("vx vy vz rho id x y z", "  ", "");
    list.push(sample("xyz with names", Extension::Xyz, table, All, Format::Xyz));
    let raw = floats(positions().as_flattened(), 4, false);
    list.push(sample("xyz raw", Extension::Xyz, raw, Positions, Format::RawF32));
    let array = |v: &[[f32; 3]]| {
        let rows: Vec<_> = v.iter().map(|p| format!("[{}]", words(p).replace(' ', ","))).collect();
        format!("[{}]", rows.join(", "))
    };
    let flat = |text: String| format!("[{}]", text.replace(' ', ", "));
    list.push(sample("json array", Extension::Json, array(&positions()), Positions, Format::Json));
    let object = format!(
        "{{\"time\": 0.5, \"Positions\": {}, \"v\": {}, \"density\": {}, \"id\": {}, \"p\": [1]}}",
        array(&positions()),
        array(&velocities()),
        flat(words(densities())),
        flat(words(ids()))
    );
    list.push(sample("json object", Extension::Unknown, object, All, Format::Json));
}

pub fn all() -> Vec<Sample> {
    use Extension as E;
    use Has::All;
    let mut list = vec![
        sample("bgeo", E::Bgeo, bgeo(), All, Format::Bgeo { gzip: false }),
        sample("bgeo gzip", E::Bgeo, gzip(&bgeo()), All, Format::Bgeo { gzip: true }),
        sample("geo", E::Geo, geo(), All, Format::Geo),
        sample("bgeo named .ply", E::Ply, bgeo(), All, Format::Bgeo { gzip: false }),
    ];
    for (version, number) in
        [("2.0", (2, 0)), ("3.0", (3, 0)), ("4.1", (4, 1)), ("4.2", (4, 2)), ("5.1", (5, 1))]
    {
        for binary in [false, true] {
            for polydata in [false, true] {
                for double in [false, true] {
                    let name = format!(
                        "vtk {version} binary {binary} polydata {polydata} double {double}"
                    );
                    let format = Format::VtkLegacy { version: number, binary };
                    list.push(sample(
                        &name,
                        E::Vtk,
                        vtk(version, binary, polydata, double),
                        All,
                        format,
                    ));
                }
            }
        }
    }
    for storage in
        [Storage::Ascii, Storage::InlineBase64, Storage::AppendedBase64, Storage::AppendedRaw]
    {
        for compression in [Compression::None, Compression::Zlib, Compression::Lz4] {
            for bits in 0..32 {
                let [vtp, big, wide, pieces, double] = [1, 2, 4, 8, 16].map(|bit| bits & bit != 0);
                let xml = Xml { vtp, storage, compression, big, wide, pieces, double };
                let format = if vtp {
                    Format::Vtp(storage, compression)
                } else {
                    Format::Vtu(storage, compression)
                };
                let name =
                    format!("{format}, big {big} wide {wide} pieces {pieces} double {double}");
                list.push(sample(
                    &name,
                    if vtp { E::Vtp } else { E::Vtu },
                    xml.bytes(),
                    All,
                    format,
                ));
            }
        }
    }
    let lzma = include_bytes!("lzma.vtu");
    list.push(sample(
        "vtu lzma",
        E::Vtu,
        &lzma[..],
        All,
        Format::Vtu(Storage::AppendedRaw, Compression::Lzma),
    ));
    for double in [false, true] {
        for lists in [false, true] {
            for (format, expected) in [
                ("ascii", Format::PlyAscii),
                ("binary_little_endian", Format::PlyBinary { big_endian: false }),
                ("binary_big_endian", Format::PlyBinary { big_endian: true }),
            ] {
                let name = format!("ply {format} double {double} lists {lists}");
                list.push(sample(&name, E::Ply, ply(format, double, lists), All, expected));
            }
        }
    }
    let cr = String::from_utf8(ply("ascii", false, true)).unwrap().replace('\n', "\r\n");
    list.push(sample("ply with carriage returns", E::Ply, cr, All, Format::PlyAscii));
    numpy_samples(&mut list);
    text_samples(&mut list);
    list
}
