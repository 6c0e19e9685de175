//! BGEO (binary) and GEO.

use whitewater::io::particles::Particles;

use super::{densities, floats, ids, ints, positions, velocities, words};

/// BGEO with a text attribute between the others and a vector of two components.
pub fn bgeo(of: &Particles) -> Vec<u8> {
    let count = of.positions.len();
    let mut out = b"BgeoV".to_vec();
    for n in [5, count as i32, 3, 0, 0, 5, 1, 1, 0] {
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
    for i in 0..count {
        out.extend(floats(&positions(of)[i], 4, true));
        out.extend(floats(&[1.0, 7.0, 8.0], 4, true));
        out.extend(ints(&[ids(of)[i], 1], 4, true));
        out.extend(floats(&velocities(of)[i], 4, true));
        out.extend(floats(&[densities(of)[i]], 4, true));
    }
    // Primitives and their attributes follow, which the reader does not need.
    out.extend(b"\0\x09generator\0\x01\0\0\0\x04\0\0\0\x01\0\x04papi\0\0\x80\0\0\xff");
    out
}

pub fn geo(of: &Particles) -> String {
    let count = of.positions.len();
    let mut out = format!(
        "PGEOMETRY V5\nNPoints {count} NPrims 1\nNPointGroups 0 NPrimGroups 0\n\
         NPointAttrib 5 NVertexAttrib 0 NPrimAttrib 1 NAttrib 0\nPointAttrib\n\
         life 2 float 0 0\nid 1 int 0\nmaterial 1 index 2 water air\nvelocity 3 vector 0 0 0\ndensity 1 float 0\n"
    );
    for i in 0..count {
        let (p, v) = (positions(of)[i], velocities(of)[i]);
        out += &format!(
            "{} 1 (7 8\t{}\t1\t{}\t{})\n",
            words(p),
            ids(of)[i],
            words(v),
            densities(of)[i]
        );
    }
    out + "PrimitiveAttrib\ngenerator 1 index 1 papi\nPart 1 0 [0]\nbeginExtra\nendExtra\n"
}
