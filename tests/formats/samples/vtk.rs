//! Legacy VTK, and VTU and VTP in all encodings.

use base64::Engine;
use std::io::Write;
use whitewater::io::particles::{Compression, Particles, Storage};

use super::{densities, floats, ids, ints, positions, velocities, words};

/// Legacy VTK. `double`: positions in double precision, ids with 64 bits.
pub fn vtk(of: &Particles, version: &str, binary: bool, polydata: bool, double: bool) -> Vec<u8> {
    let count = of.positions.len();
    let mut out = format!(
        "# vtk DataFile Version {version}\na title\n{}\nDATASET {}\n",
        if binary { "BINARY" } else { "ASCII" },
        if polydata { "POLYDATA" } else { "UNSTRUCTURED_GRID" }
    )
    .into_bytes();
    let size = if double { 8 } else { 4 };
    // All three types have 32 bits.
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
    let numbers: Vec<u32> = (0..count as u32).collect();
    // A field before the points that is not used, such as ParaView's time values.
    put(
        &mut out,
        "FIELD FieldData 1\nTIME 1 1 double\n".into(),
        floats(&[0.5], 8, true),
        "0.5".into(),
    );
    put(
        &mut out,
        format!("POINTS {count} {real}\n"),
        floats(positions(of).as_flattened(), size, true),
        words(positions(of).as_flattened()),
    );
    out.extend(
        b"METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 2\n\n",
    );
    let cells = if polydata { "VERTICES" } else { "CELLS" };
    if version.starts_with('5') {
        let offsets: Vec<u32> = (0..=count as u32).collect();
        out.extend(format!("{cells} {} {count}\n", count + 1).as_bytes());
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
            format!("{cells} {count} {}\n", 2 * count),
            ints(&list, 4, true),
            words(&list),
        );
    }
    if !polydata {
        let types = vec![1_u32; count];
        put(&mut out, format!("CELL_TYPES {count}\n"), ints(&types, 4, true), words(types));
    }
    // Data of the cells, which must not be taken for data of the points.
    out.extend(format!("CELL_DATA {count}\n").as_bytes());
    put(
        &mut out,
        "SCALARS density float 1\nLOOKUP_TABLE default\n".into(),
        floats(&vec![1.0; count], 4, true),
        words(vec![1.0; count]),
    );
    out.extend(format!("POINT_DATA {count}\n").as_bytes());
    put(
        &mut out,
        format!("SCALARS id {id} 1\nLOOKUP_TABLE id_table\n"),
        ints(ids(of), size, true),
        words(ids(of)),
    );
    put(
        &mut out,
        format!("VECTORS velocity {real}\n"),
        floats(velocities(of).as_flattened(), size, true),
        words(velocities(of).as_flattened()),
    );
    out.extend(b"FIELD FieldData 3\n");
    put(
        &mut out,
        format!("my%20flags 1 {count} bit\n"),
        vec![0xff; count.div_ceil(8)],
        words(vec![1; count]),
    );
    out.extend(b"METADATA\nCOMPONENT_NAMES\nflag\n\n");
    let texts: Vec<u8> = (0..count).flat_map(|i| [0xc0 | 2, b'a', b'a' + (i % 26) as u8]).collect();
    put(&mut out, format!("label 1 {count} string\n"), texts, vec!["ab"; count].join("\n"));
    put(
        &mut out,
        format!("density 1 {count} {real}\n"),
        floats(densities(of), size, true),
        words(densities(of)),
    );
    out
}

/// Legacy VTK with all but the positions on cells of one point each; cell `i` has point `order[i]`.
pub fn vtk_on_cells(
    of: &Particles,
    version: &str,
    binary: bool,
    polydata: bool,
    order: &[u32],
) -> Vec<u8> {
    let count = of.positions.len();
    let (kind, dataset, cells) = (
        if binary { "BINARY" } else { "ASCII" },
        if polydata { "POLYDATA" } else { "UNSTRUCTURED_GRID" },
        if polydata { "VERTICES" } else { "CELLS" },
    );
    let mut out =
        format!("# vtk DataFile Version {version}\non cells\n{kind}\nDATASET {dataset}\n");
    out += &format!("POINTS {count} float\n");
    let mut out = out.into_bytes();
    let put = |out: &mut Vec<u8>, head: &str, raw: Vec<u8>, text: String| {
        out.extend(head.as_bytes());
        out.extend(if binary { raw } else { text.into_bytes() });
        out.push(b'\n');
    };
    let p = positions(of).as_flattened();
    put(&mut out, "", floats(p, 4, true), words(p));
    if version.starts_with('5') {
        let offsets: Vec<u32> = (0..=count as u32).collect();
        out.extend(format!("{cells} {} {count}\n", count + 1).as_bytes());
        let head = "OFFSETS vtktypeint64\n";
        put(&mut out, head, ints(&offsets, 8, true), words(&offsets));
        let head = "CONNECTIVITY vtktypeint64\n";
        put(&mut out, head, ints(order, 8, true), words(order));
    } else {
        let list: Vec<u32> = order.iter().flat_map(|i| [1, *i]).collect();
        let head = format!("{cells} {count} {}\n", 2 * count);
        put(&mut out, &head, ints(&list, 4, true), words(&list));
    }
    if !polydata {
        let types = vec![1_u32; count];
        let head = format!("CELL_TYPES {count}\n");
        put(&mut out, &head, ints(&types, 4, true), words(types));
    }
    let of = in_order(of, order);
    out.extend(format!("CELL_DATA {count}\n").as_bytes());
    let head = "SCALARS id int 1\nLOOKUP_TABLE default\n";
    put(&mut out, head, ints(ids(&of), 4, true), words(ids(&of)));
    let v = velocities(&of).as_flattened();
    put(&mut out, "VECTORS velocity float\n", floats(v, 4, true), words(v));
    let head = format!("FIELD FieldData 1\ndensity 1 {count} float\n");
    put(&mut out, &head, floats(densities(&of), 4, true), words(densities(&of)));
    out
}

/// The particles in another order.
fn in_order(of: &Particles, order: &[u32]) -> Particles {
    fn some<T: Copy>(list: &[T], order: &[u32]) -> Vec<T> {
        order.iter().map(|i| list[*i as usize]).collect()
    }
    let mut found = Particles::from_positions(some(positions(of), order));
    found.velocities = Some(some(velocities(of), order));
    found.densities = Some(some(densities(of), order));
    found.ids = Some(some(ids(of), order));
    found
}

pub struct Xml {
    pub vtp: bool,
    pub storage: Storage,
    pub compression: Compression,
    pub big: bool,
    pub wide: bool,
    /// Whether the particles are split into two pieces.
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
        // A single run of literals.
        Compression::Lz4 => {
            let mut out = Vec::new();
            match block.len().checked_sub(15) {
                None => out.push((block.len() as u8) << 4),
                Some(more) => {
                    out.push(0xf0);
                    out.extend(std::iter::repeat_n(255, more / 255));
                    out.push((more % 255) as u8);
                }
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
            // Blocks of VTK's usual size, or small ones so that there are several.
            let block = if raw.len() > 1 << 12 { 1 << 15 } else { 48 };
            let blocks: Vec<_> = raw.chunks(block).map(|b| pack(b, self.compression)).collect();
            let mut head =
                [self.word(blocks.len()), self.word(block), self.word(raw.len() % block)].concat();
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

    pub fn bytes(&self, of: &Particles) -> Vec<u8> {
        let count = of.positions.len();
        let kind = if self.vtp { "PolyData" } else { "UnstructuredGrid" };
        let mut out = self.begun(kind);
        let (size, real, id) =
            if self.double { (8, "Float64", "UInt64") } else { (4, "Float32", "Int32") };
        let mut appended = Vec::new();
        let cuts: &[usize] = if self.pieces { &[0, 4, 4, count] } else { &[0, count] };
        for (from, to) in cuts.iter().zip(&cuts[1..]) {
            let range = *from..*to;
            out += &format!(
                "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"0\">\n<PointData>\n",
                range.len()
            );
            let v = &velocities(of)[range.clone()];
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
            let d = &densities(of)[range.clone()];
            out += &self.array(
                &mut appended,
                real,
                "density",
                1,
                &floats(d, size, self.big),
                &words(d),
            );
            let i = &ids(of)[range.clone()];
            out += &self.array(&mut appended, id, "id", 1, &ints(i, size, self.big), &words(i));
            let p = &positions(of)[range];
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
        self.ended(out, kind, &appended)
    }

    /// The particles with all but the positions on cells of one point each; in each piece, cell `i`
    /// has point `order[i]`.
    pub fn on_cells(&self, of: &Particles, order: &[u32]) -> Vec<u8> {
        let count = of.positions.len();
        let kind = if self.vtp { "PolyData" } else { "UnstructuredGrid" };
        let mut out = self.begun(kind);
        let mut appended = Vec::new();
        let (size, real) = if self.double { (8, "Float64") } else { (4, "Float32") };
        let cuts: &[usize] = if self.pieces { &[0, 4, 4, count] } else { &[0, count] };
        for (from, to) in cuts.iter().zip(&cuts[1..]) {
            let points: Vec<u32> = (*from as u32..*to as u32).collect();
            // Of each piece, its own points in the order that they have in the whole.
            let own: Vec<u32> = order.iter().copied().filter(|i| points.contains(i)).collect();
            let local: Vec<u32> = own.iter().map(|i| i - *from as u32).collect();
            let ends: Vec<u32> = (1..=own.len() as u32).collect();
            let n = own.len();
            let (counts, cells) = match self.vtp {
                true => (format!("NumberOfVerts=\"{n}\" NumberOfPolys=\"0\""), "Verts"),
                false => (format!("NumberOfCells=\"{n}\""), "Cells"),
            };
            out += &format!("<Piece NumberOfPoints=\"{n}\" {counts}>\n<PointData/>\n<CellData>\n");
            let of_cells = in_order(of, &own);
            let mut put = |ty: &str, name: &str, components: usize, raw: Vec<u8>, text: String| {
                out += &self.array(&mut appended, ty, name, components, &raw, &text);
            };
            let v = velocities(&of_cells).as_flattened();
            put(real, "velocity", 3, floats(v, size, self.big), words(v));
            let d = densities(&of_cells);
            put(real, "density", 1, floats(d, size, self.big), words(d));
            put("Int32", "id", 1, ints(ids(&of_cells), 4, self.big), words(ids(&of_cells)));
            out += "</CellData>\n<Points>\n";
            let p = in_order(of, &points);
            let p = positions(&p).as_flattened();
            let raw = floats(p, size, self.big);
            out += &self.array(&mut appended, real, "Points", 3, &raw, &words(p));
            out += &format!("</Points>\n<{cells}>\n");
            for (name, list) in [("connectivity", &local), ("offsets", &ends)] {
                let raw = ints(list, 8, self.big);
                out += &self.array(&mut appended, "Int64", name, 1, &raw, &words(list));
            }
            if !self.vtp {
                let types = vec![1; n];
                out += &self.array(&mut appended, "UInt8", "types", 1, &types, &words(&types));
            }
            out += &format!("</{cells}>\n</Piece>\n");
        }
        self.ended(out, kind, &appended)
    }

    fn begun(&self, kind: &str) -> String {
        let compressor = match self.compression {
            Compression::Zlib => " compressor=\"vtkZLibDataCompressor\"",
            Compression::Lz4 => " compressor=\"vtkLZ4DataCompressor\"",
            _ => "",
        };
        format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"{}\" header_type=\"{}\"{compressor}>\n<{kind}>\n",
            if self.big { "BigEndian" } else { "LittleEndian" },
            if self.wide { "UInt64" } else { "UInt32" },
        )
    }

    fn ended(&self, mut out: String, kind: &str, appended: &[u8]) -> Vec<u8> {
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
