//! Damaged scene files give an error or a scene: never a panic, and never an allocation for a false
//! count.

use whitewater::headless::scene::Scene;
use whitewater::io::picture::{Layers, write_png_values};

use super::allocation;
use super::bad::{damaged, numbers};

/// A node with a child node, with indices, normals and a colour.
const GLB: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
    "nodes":[{"mesh":0,"children":[1]},{"mesh":0,"translation":[1,2,3],"rotation":[0,0,0,1]}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":0},"indices":1,"material":0}]}],
    "materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.4,0.3,1]}}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
    {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
    "bufferViews":[{"buffer":0,"byteLength":36},
    {"buffer":0,"byteOffset":36,"byteLength":6}],"buffers":[{"byteLength":44}]}"#;

/// A GLB file with this JSON and the data of one triangle.
fn glb(json: &[u8]) -> Vec<u8> {
    let mut data = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat();
    data.extend([0, 0, 1, 0, 2, 0, 0, 0]);
    let mut bytes = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", &data)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

const OBJ: &str = "# a sheet\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvn 0 0 1\n\
    f 1/1/1 2/2/1 3/2/1\nf -4 -3 -2 -1\nf 1//1 2//1 3//1\n";

const JSON: &str = r#"{"boxes":[
    {"name":"basin floor","material":"concrete","centre":[0,-0.05,0],"half":[1,0.05,1]},
    {"name":"lid","material":"timber","centre":[0.95,0.3,0],"half":[0.05,0.3,1],"rotation":[0,0,0,1]}],
    "cylinders":[{"material":"stone","centre":[0,1,0],"radius":0.2,"bore":0.1,"height":1,"slope":0.5}],
    "spheres":[{"material":"stone","centre":[0,1,0],"radius":0.2}],
    "motion":[{"parts":["lid"],"origin":[0,0,0],"first_frame":1,"poses":[[0,0,0,0,0,0,1],[0,1,0,0,0,0,1]]}],
    "ground":{"y":-0.1,"material":"ground"},"fluid":{"pool_level":0.2},
    "panes":[{"corner":[0,0,1],"edges":[[1,0,0],[0,1,0]]}]}"#;

type Parse = fn(&[u8]) -> Result<Scene, String>;

#[test]
fn damaged_scenes() {
    let samples: [(&str, Vec<u8>, Parse); 4] = [
        ("glb", glb(GLB.as_bytes()), Scene::parse_glb),
        // Only the JSON is damaged; the length of its chunk is correct.
        ("glb's text", GLB.into(), |text| Scene::parse_glb(&glb(text))),
        ("obj", OBJ.into(), Scene::parse_obj),
        ("json", JSON.into(), Scene::parse_json),
    ];
    let mut next = numbers();
    for (name, bytes, parse) in &samples {
        let scene = parse(bytes).unwrap_or_else(|why| panic!("{name}: {why}"));
        let whole = scene.meshes.iter().map(|m| m.positions.len()).sum::<usize>();
        assert!(whole > 3, "{name}: {whole}");
        let (mut read, cases) = (0, 4000);
        for _ in 0..cases {
            let bytes = damaged(bytes, &mut next);
            let (result, peak) = allocation::peak(|| parse(&bytes));
            // A shape of a hundred bytes becomes a few hundred vertices of 32 bytes.
            let limit = (1 << 20) + 1000 * bytes.len();
            assert!(peak <= limit, "{name}: {peak} bytes held for {} of input", bytes.len());
            match result {
                Ok(scene) => {
                    read += 1;
                    for mesh in &scene.meshes {
                        let count = mesh.positions.len();
                        assert!(mesh.indices.iter().all(|i| (*i as usize) < count), "{name}");
                        assert_eq!(mesh.normals.len(), count, "{name}");
                    }
                }
                Err(why) => assert!(why.len() < 3000, "{name}: {why}"),
            }
        }
        println!("{name}: {read} of {cases} damaged files read");
        assert!(read > 0 && read < cases, "{name}: {read} of {cases}");
    }
}

#[test]
fn a_glb_that_doubles_itself_is_refused() {
    // Thirty nodes that have the next node as child twice: 2^30 meshes.
    let nodes: Vec<String> =
        (1..=30).map(|next| format!("{{\"mesh\":0,\"children\":[{next},{next}]}}")).collect();
    let (head, rest) = GLB.split_once("\"nodes\":[{\"mesh").unwrap();
    let (_, tail) = rest.split_once("\"meshes\"").unwrap();
    let json = format!("{head}\"nodes\":[{},{{\"mesh\":0}}],\"meshes\"{tail}", nodes.join(","));
    let (result, peak) = allocation::peak(|| Scene::parse_glb(&glb(json.as_bytes())));
    let why = result.err().unwrap();
    assert!(why.contains("more than one parent"), "{why}");
    assert!(peak < 1 << 20, "{peak}");
}

/// Without a list of scenes the roots are the nodes that no node has as child.
#[test]
fn nodes_without_a_scene_are_a_tree() {
    let json = GLB.replace("\"scene\":0,\"scenes\":[{\"nodes\":[0]}],", "");
    assert!(json.len() < GLB.len());
    let scene = Scene::parse_glb(&glb(json.as_bytes())).expect("two nodes");
    assert_eq!(scene.meshes.len(), 2);
}

/// A node is placed by its own turn, stretch and move, then by its parent's; a matrix is stored by columns. Expected
/// places are worked out by hand.
#[test]
fn nodes_are_placed_and_coloured() {
    let nodes = r#"[{"children":[1],"rotation":[0,0.70710678,0,0.70710678],"translation":[10,0,0]},
        {"name":"child","mesh":0,"translation":[1,2,3],"scale":[2,3,4]},
        {"name":"turned","mesh":0,"matrix":[0,0,1,0, 1,0,0,0, 0,1,0,0, 5,6,7,1]}]"#;
    let (head, rest) = GLB.split_once("\"nodes\":[{\"mesh").unwrap();
    let (_, tail) = rest.split_once("\"meshes\"").unwrap();
    let json = format!("{head}\"nodes\":{nodes},\"meshes\"{tail}");
    let json = json.replace("\"nodes\":[0]", "\"nodes\":[0,2]");
    let json = json.replace("[0.5,0.4,0.3,1]", "[0.5,0.4,0.3,1],\"roughnessFactor\":0.7");
    let scene = Scene::parse_glb(&glb(json.as_bytes())).expect("two meshes");
    assert_eq!(scene.meshes.len(), 2);
    for (name, expected) in [
        // A quarter turn about y takes (x, y, z) to (z, y, -x).
        ("child", [[13.0, 2.0, -1.0], [13.0, 2.0, -3.0], [13.0, 5.0, -1.0]]),
        ("turned", [[5.0, 6.0, 7.0], [5.0, 6.0, 8.0], [6.0, 6.0, 7.0]]),
    ] {
        let mesh = scene.meshes.iter().find(|mesh| mesh.name == name).expect(name);
        for (position, expected) in mesh.positions.iter().zip(expected) {
            let found = mesh.transform.transform_point3((*position).into()).to_array();
            let near = found.iter().zip(expected).all(|(a, b): (_, f32)| (a - b).abs() < 1.0e-5);
            assert!(near, "{name}: {found:?}, not {expected:?}");
        }
        assert_eq!((mesh.material.base_color, mesh.material.roughness), ([0.5, 0.4, 0.3], 0.7));
    }
}

/// A .gltf with its data and its texture in files beside it.
#[test]
fn data_and_textures_beside_a_gltf_are_read() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("beside");
    std::fs::create_dir_all(&folder).unwrap();
    let bytes = glb(b"");
    std::fs::write(folder.join("t.bin"), &bytes[bytes.len() - 44..]).unwrap();
    let mut picture = Layers::new(2, 1);
    for (name, data) in [("R", [1.0, 0.0]), ("G", [0.0, 1.0]), ("B", [0.0, 1.0]), ("A", [1.0; 2])] {
        picture.push(name, 2, 1, data.to_vec()).unwrap();
    }
    let file = std::fs::File::create(folder.join("t.png")).unwrap();
    write_png_values(&picture, file).unwrap();
    let texture = r#""baseColorTexture":{"index":0},"baseColorFactor""#;
    let json = GLB.replace("{\"byteLength\":44}", "{\"uri\":\"t.bin\",\"byteLength\":44}");
    let json = json.replace("\"NORMAL\":0", "\"TEXCOORD_0\":2").replace(
        "\"bufferViews\"",
        r#""textures":[{"source":0}],"images":[{"uri":"t.png"}],"bufferViews""#,
    );
    let json = json.replace("\"baseColorFactor\"", texture).replace(
        "\"type\":\"SCALAR\"}",
        r#""type":"SCALAR"},{"bufferView":0,"componentType":5126,"count":3,"type":"VEC2"}"#,
    );
    std::fs::write(folder.join("t.gltf"), json).unwrap();
    let scene = Scene::load(folder.join("t.gltf")).unwrap();
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.positions, [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    // The first six of the file's numbers.
    assert_eq!(mesh.uvs, [[0.0, 0.0], [0.0, 1.0], [0.0, 0.0]]);
    let texture = mesh.material.texture.as_ref().unwrap();
    assert_eq!((texture.width, texture.height), (2, 1));
    assert_eq!(texture.data, [[255, 0, 0, 255], [0, 255, 255, 255]]);
}

/// A node that lists itself a million times is refused before the list is multiplied.
#[test]
fn a_glb_of_endless_children_is_refused() {
    let again = "0,".repeat(1 << 20);
    let json = GLB.replace("\"children\":[1]", &format!("\"children\":[{again}1]"));
    let (result, peak) = allocation::peak(|| Scene::parse_glb(&glb(json.as_bytes())));
    let why = result.err().unwrap();
    assert!(why.contains("more than one parent"), "{why}");
    assert!(peak < 64 << 20, "{peak}");
}

#[test]
fn files_beside_a_scene_are_in_its_folder() {
    for uri in ["/dev/zero", "../a.bin", "a/../../b.bin"] {
        let json =
            GLB.replace("{\"byteLength\":44}", &format!("{{\"uri\":\"{uri}\",\"byteLength\":44}}"));
        let why = Scene::parse_glb(&glb(json.as_bytes())).err().unwrap();
        assert!(why.contains("in the scene's folder"), "{uri}: {why}");
    }
}

/// A number that is too large for single precision is an error, not an invisible part.
#[test]
fn json_numbers_are_finite() {
    for (old, new, named) in [
        ("\"centre\":[0,-0.05,0]", "\"centre\":[0,1e39,0]", "centre of 'basin floor'"),
        ("\"rotation\":[0,0,0,1]", "\"rotation\":[0,0,1e39,1]", "rotation of 'lid'"),
        ("\"ground\":{\"y\":-0.1", "\"ground\":{\"y\":1e39", "y of 'ground'"),
    ] {
        assert!(JSON.contains(old));
        let why = Scene::parse_json(JSON.replacen(old, new, 1).as_bytes()).err().unwrap();
        assert!(why.contains(named) && why.contains("finite"), "{why}");
    }
}
