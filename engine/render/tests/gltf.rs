//! Models of the users' own, in files that the tests write.

use nalgebra::Vector3;
use paracosm_render::{Mesh, Semantic, SurfaceKind, gltf};
use std::path::{Path, PathBuf};

/// A wedge: a triangle on the ground, z ahead and x to the left, and one that stands; positions, then indices.
fn buffer() -> Vec<u8> {
    let positions: [[f32; 3]; 4] = [[0.0, 0.0, 2.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 3.0, 0.0]];
    let mut bytes: Vec<u8> = positions.iter().flatten().flat_map(|number| number.to_le_bytes()).collect();
    let indices: [u16; 6] = [0, 2, 1, 0, 1, 3];
    bytes.extend(indices.iter().flat_map(|index| index.to_le_bytes()));
    bytes
}

/// The model's text; `buffer` says where its bytes are, and `indices` how many there are said to be.
fn text(buffer: &str, indices: usize) -> String {
    format!(
        r#"{{
            "asset": {{"version": "2.0"}},
            "scene": 0,
            "scenes": [{{"nodes": [0]}}],
            "nodes": [{{"children": [1], "translation": [0, 1, 0]}}, {{"mesh": 0, "scale": [2, 2, 2]}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1, "material": 0}}]}}],
            "materials": [{{"name": "Car Paint", "pbrMetallicRoughness": {{"baseColorFactor": [0.5, 0.25, 0.125, 1]}}}}],
            "accessors": [
                {{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, 0, 0], "max": [1, 3, 2]}},
                {{"bufferView": 1, "componentType": 5123, "count": {indices}, "type": "SCALAR"}}
            ],
            "bufferViews": [
                {{"buffer": 0, "byteOffset": 0, "byteLength": 48}},
                {{"buffer": 0, "byteOffset": 48, "byteLength": 12}}
            ],
            "buffers": [{{"byteLength": 60 {buffer}}}]
        }}"#
    )
}

fn binary(text: &str, bytes: &[u8]) -> Vec<u8> {
    let mut text = text.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let chunk = |kind: &[u8; 4], data: &[u8]| [&(data.len() as u32).to_le_bytes(), &kind[..], data].concat();
    let chunks = [chunk(b"JSON", &text), chunk(b"BIN\0", bytes)].concat();
    [b"glTF".as_slice(), &2_u32.to_le_bytes(), &(chunks.len() as u32 + 12).to_le_bytes(), &chunks].concat()
}

fn written(folder: &Path, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, content).unwrap();
    path
}

fn base64(bytes: &[u8]) -> String {
    let letters: Vec<char> = ('A'..='Z').chain('a'..='z').chain('0'..='9').chain(['+', '/']).collect();
    let group = |three: &[u8]| {
        let bits = three.iter().fold(0_usize, |bits, byte| bits << 8 | usize::from(*byte)) << (8 * (3 - three.len()));
        let letter = |i: usize| if i <= three.len() { letters[bits >> (18 - 6 * i) & 63] } else { '=' };
        (0..4).map(letter).collect::<String>()
    };
    bytes.chunks(3).map(group).collect()
}

fn refusal(folder: &Path, name: &str, content: impl AsRef<[u8]>) -> String {
    gltf::load(written(folder, name, content), Semantic::Car).expect_err("it is refused").to_string()
}

fn check(mesh: &Mesh) {
    // Twice as large and 1 m up, y up has become z up, z ahead has become x ahead.
    let corners: Vec<[f32; 3]> = mesh.indices().iter().map(|index| mesh.vertices()[*index as usize].position).collect();
    let [front, left, right, top] = [[4.0, 0.0, 1.0], [0.0, 2.0, 1.0], [0.0, -2.0, 1.0], [0.0, 0.0, 7.0]];
    assert_eq!(corners, [front, right, left, front, left, top]);
    let normal = Vector3::from(mesh.vertices()[0].normal);
    assert!((normal + Vector3::z()).norm() < 1e-6, "{normal}");
    for vertex in mesh.vertices() {
        assert_eq!((vertex.surface, vertex.semantic), (SurfaceKind::Paint, Semantic::Car));
        assert_eq!(vertex.colour, [0.5, 0.25, 0.125]);
    }
}

#[test]
fn a_model_is_the_same_from_any_kind_of_file() {
    let folder = tempfile::tempdir().unwrap();
    written(folder.path(), "bytes of it.bin", buffer());
    let files = [
        written(folder.path(), "model.glb", binary(&text("", 6), &buffer())),
        written(folder.path(), "beside.gltf", text(r#", "uri": "bytes%20of%20it.bin""#, 6)),
        written(
            folder.path(),
            "within.gltf",
            text(&format!(r#", "uri": "data:application/octet-stream;base64,{}""#, base64(&buffer())), 6),
        ),
    ];
    for file in files {
        check(&gltf::load(&file, Semantic::Car).unwrap_or_else(|error| panic!("{error}")));
    }
}

#[test]
fn a_file_that_is_no_model_is_refused_with_what_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let refuse = |name: &str, content: &[u8]| refusal(folder.path(), name, content);
    let missing = gltf::load(folder.path().join("none.glb"), Semantic::Car).unwrap_err().to_string();
    assert!(missing.contains("cannot read `") && missing.contains("none.glb"), "{missing}");
    let bytes = refuse("lost.gltf", text(r#", "uri": "lost.bin""#, 6).as_bytes());
    assert!(bytes.contains("cannot read `") && bytes.contains("lost.bin"), "{bytes}");
    let text_of = |indices| binary(&text("", indices), &buffer());
    let many = refuse("many.glb", &text_of(60));
    assert!(many.contains("the file has too few bytes for its accessor 1: number of elements 60"), "{many}");
    let odd = refuse("odd.glb", &text_of(5));
    assert!(odd.contains("do not match its corners"), "{odd}");
    let short = refuse("short.glb", &binary(&text("", 6), &buffer()[..40]));
    assert!(short.contains("too few bytes for its accessor"), "{short}");
    let lines = text("", 6).replace(r#""indices": 1"#, r#""indices": 1, "mode": 1"#);
    let lines = refuse("lines.glb", &binary(&lines, &buffer()));
    assert!(lines.contains("a part of it is made of Lines, expected Triangles"), "{lines}");
    let circle = text("", 6).replace(r#""mesh": 0"#, r#""mesh": 0, "children": [0]"#);
    let circle = refuse("circle.glb", &binary(&circle, &buffer()));
    assert!(circle.contains("listed twice, expected a tree"), "{circle}");
    let other = text("", 6).replace(r#""POSITION": 0"#, r#""POSITION": 7"#);
    let other = refuse("other.glb", &binary(&other, &buffer()));
    assert!(other.contains("it names accessor 7, but its number of accessors is 2"), "{other}");
    let scrambled = refuse("scrambled.gltf", text(r#", "uri": "data:;base64,a*b""#, 6).as_bytes());
    assert!(scrambled.contains("not valid base64"), "{scrambled}");
    for (name, content) in [("empty.gltf", &b""[..]), ("empty.glb", b"glTF"), ("words.gltf", b"a car")] {
        let refused = refuse(name, content);
        assert!(refused.contains("cannot be used as a model") && refused.contains(name), "{refused}");
    }
}

proptest::proptest! {
    #[test]
    fn whatever_is_in_a_file_nothing_panics(at in 0_usize..1500, with in proptest::prelude::any::<u8>(), cut in 0_usize..1500) {
        let folder = tempfile::tempdir().unwrap();
        let mut content = binary(&text("", 6), &buffer());
        let at = at % content.len();
        content[at] = with;
        let _ = gltf::load(written(folder.path(), "changed.glb", &content), Semantic::Car);
        let cut = cut % content.len();
        let _ = gltf::load(written(folder.path(), "cut.glb", &content[..cut]), Semantic::Car);
    }
}

/// A model of nodes as JSON, with the mesh 0; `nodes` and `roots` are lists as JSON.
fn nodes(roots: &str, nodes: &str) -> String {
    let buffer = format!(", \"uri\": \"data:application/octet-stream;base64,{}\"", base64(&buffer()));
    let text = text(&buffer, 6).replace("\"nodes\": [0]", &format!("\"nodes\": {roots}"));
    let (before, after) = text.split_once("\"nodes\": [{").expect("it has nodes");
    let (_, after) = after.split_once("}],").expect("its nodes end");
    format!("{before}\"nodes\": {nodes},{after}")
}

#[test]
fn nodes_that_are_no_tree_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let doubled: Vec<String> = (0..28).map(|i| format!(r#"{{"children": [{0}, {0}]}}"#, i + 1)).collect();
    for (roots, list) in [
        ("[0]", format!(r#"[{}, {{"mesh": 0}}]"#, doubled.join(","))),
        ("[0, 1]", r#"[{"children": [2]}, {"children": [2]}, {"mesh": 0}]"#.to_owned()),
        ("[0, 0]", r#"[{"mesh": 0}]"#.to_owned()),
        ("[0]", r#"[{"children": [0], "mesh": 0}]"#.to_owned()),
    ] {
        let message = refusal(dir.path(), "model.gltf", nodes(roots, &list));
        assert!(message.contains("child of two nodes or listed twice, expected a tree"), "{message}");
    }
}

#[test]
fn a_mesh_that_very_many_nodes_draw_is_refused_in_time() {
    let dir = tempfile::tempdir().unwrap();
    let count = 700_000;
    let list = format!("[{}]", vec![r#"{"mesh": 0}"#; count].join(","));
    let roots = format!("[{}]", (0..count).map(|i| i.to_string()).collect::<Vec<_>>().join(","));
    let message = refusal(dir.path(), "model.gltf", nodes(&roots, &list));
    assert!(message.contains("more than 6000000 corners") && message.contains("reduce"), "{message}");
}

#[test]
fn buffers_are_regular_files_below_the_folder_of_the_model() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("models");
    std::fs::create_dir_all(folder.join("parts")).unwrap();
    written(dir.path(), "outside.bin", buffer());
    written(&folder, "parts/inside.bin", buffer());
    let with = |uri: &str| text(&format!(", \"uri\": \"{uri}\""), 6);
    check(&gltf::load(written(&folder, "good.gltf", with("parts/inside.bin")), Semantic::Car).unwrap());
    let absolute = dir.path().join("outside.bin");
    for uri in ["../outside.bin", "parts/../../outside.bin", "%2e%2e/outside.bin", absolute.to_str().unwrap()] {
        let message = refusal(&folder, "bad.gltf", with(uri));
        assert!(message.contains(uri) && message.contains("in the folder of the model"), "{message}");
    }
    let message = refusal(&folder, "bad.gltf", with("parts"));
    assert!(message.contains("no regular file"), "{message}");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("../outside.bin", folder.join("link.bin")).unwrap();
        assert!(refusal(&folder, "bad.gltf", with("link.bin")).contains("in the folder of the model"));
        let pipe = folder.join("pipe.bin");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        assert!(refusal(&folder, "bad.gltf", with("pipe.bin")).contains("no regular file"));
    }
}
