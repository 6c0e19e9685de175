//! Reads Wavefront OBJ: all faces as one mesh.

use std::collections::HashMap;

use glam::Vec3;

use super::load::{MOST, make_normals};
use super::{Mesh, Scene};

pub fn parse(bytes: &[u8]) -> Result<Scene, String> {
    let text = String::from_utf8_lossy(bytes);
    let (mut points, mut normals, mut uvs) = (Vec::new(), Vec::new(), Vec::new());
    let mut mesh = Mesh { name: "obj".into(), ..Mesh::default() };
    let mut known: HashMap<[usize; 3], u32> = HashMap::new();
    let mut lacks_normals = false;
    for (number, line) in text.lines().enumerate() {
        let number = number + 1;
        let mut words = line.split('#').next().unwrap_or_default().split_whitespace();
        match words.next() {
            Some("v") => points.push(numbers::<3>(words, number)?),
            Some("vn") => normals.push(numbers::<3>(words, number)?),
            Some("vt") => uvs.push(numbers::<2>(words, number)?),
            Some("f") => {
                let mut corners = Vec::new();
                for word in words {
                    let key = corner(word, [points.len(), uvs.len(), normals.len()])
                        .map_err(|why| format!("line {number}: {why}"))?;
                    lacks_normals |= key[2] == 0;
                    let next = mesh.positions.len() as u32;
                    corners.push(*known.entry(key).or_insert_with(|| {
                        // Indices begin at 1; 0 means none.
                        mesh.positions.push(points[key[0] - 1]);
                        let uv: [f32; 2] = if key[1] > 0 { uvs[key[1] - 1] } else { [0.0; 2] };
                        mesh.uvs.push([uv[0], 1.0 - uv[1]]);
                        mesh.normals.push(if key[2] > 0 {
                            let n: [f32; 3] = normals[key[2] - 1];
                            Vec3::from(n).normalize_or_zero().to_array()
                        } else {
                            [0.0; 3]
                        });
                        next
                    }));
                }
                if corners.len() < 3 {
                    return Err(format!(
                        "line {number}: expected a face of 3 or more corners, found {}",
                        corners.len()
                    ));
                }
                for pair in corners[1..].windows(2) {
                    mesh.indices.extend([corners[0], pair[0], pair[1]]);
                }
            }
            // Groups, materials, lines and other records are ignored.
            _ => {}
        }
        if mesh.indices.len() > 3 * MOST || points.len() > MOST {
            return Err(format!("line {number}: more than {MOST} vertices or triangles"));
        }
    }
    if mesh.indices.is_empty() {
        return Err("expected faces (lines that begin with 'f'), found none".into());
    }
    if lacks_normals {
        make_normals(&mut mesh);
    }
    Ok(Scene { meshes: vec![mesh], ..Scene::default() })
}

fn numbers<'a, const N: usize>(
    mut words: impl Iterator<Item = &'a str>,
    line: usize,
) -> Result<[f32; N], String> {
    let mut out = [0.0; N];
    for value in &mut out {
        let word = words.next().unwrap_or_default();
        *value = word
            .parse()
            .ok()
            .filter(|v: &f32| v.is_finite())
            .ok_or_else(|| format!("line {line}: expected {N} numbers, found '{word}'"))?;
    }
    Ok(out)
}

/// Parses `p`, `p/t`, `p//n` or `p/t/n`. Indices count from 1, or backwards from −1. Returns the indices of
/// position, texture coordinate and normal, counted from 1; 0 stands for a missing one.
fn corner(word: &str, counts: [usize; 3]) -> Result<[usize; 3], String> {
    let mut key = [0; 3];
    for (k, part) in word.split('/').enumerate() {
        let Some(slot) = key.get_mut(k) else {
            return Err(format!("expected a corner like 1/2/3, found '{word}'"));
        };
        if part.is_empty() && k > 0 {
            continue;
        }
        let count = counts[k] as i64;
        let index: i64 =
            part.parse().map_err(|_| format!("expected a corner like 1/2/3, found '{word}'"))?;
        let index = if index < 0 { count.saturating_add(index).saturating_add(1) } else { index };
        if index < 1 || index > count {
            return Err(format!("expected an index from 1 to {count}, found '{word}'"));
        }
        *slot = index as usize;
    }
    Ok(key)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn obj_reads_all_kinds_of_corners() {
        let obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n\
                   f 1/1/1 2/1/1 3//1 -1//-1 # a quad\n";
        let scene = parse(obj.as_bytes()).expect("good");
        assert_eq!(scene.meshes[0].indices, [0, 1, 2, 0, 2, 3]);
        assert!(scene.meshes[0].normals.iter().all(|n| *n == [0.0, 0.0, 1.0]));
        let bare = parse(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3").expect("good");
        assert!(bare.meshes[0].normals.iter().all(|n| *n == [0.0, 0.0, 1.0]));
    }

    #[test]
    fn bad_obj_says_which_line() {
        for bad in [
            "v 0 0\n",
            "v 0 0 nan\n",
            "v 0 0 0\nf 1 1 2\n",
            "v 0 0 0\nf 0 1 1\n",
            "v 0 0 0\nf 1 1 -2\n",
            "v 0 0 0\nf 1 1 1/\u{fe}\n",
            "v 0 0 0\nf 1/1/1/1 1 1\n",
            "v 0 0 0\nf 1 1\n",
            "v 0 0 0\nf -9223372036854775808 1 1\n",
        ] {
            let why = parse(bad.as_bytes()).expect_err(bad);
            assert!(why.starts_with("line "), "{why}");
        }
        assert!(parse(b"\xff\xfe\x00").is_err());
    }
}
