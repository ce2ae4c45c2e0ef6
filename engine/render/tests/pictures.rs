//! The images on the surfaces of users' models, in files that the tests write.

mod support;

use nalgebra::Isometry3;
use paracosm_render::{Look, Semantic, View, gltf};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use support::{RGB, camera, one, renderer, thing};

/// A plate that stands 5 m ahead and faces the camera: positions, texture coordinates and indices.
fn plate() -> Vec<u8> {
    let positions: [[f32; 3]; 4] = [[2.0, 0.0, 5.0], [-2.0, 0.0, 5.0], [-2.0, 4.0, 5.0], [2.0, 4.0, 5.0]];
    let uvs: [[f32; 2]; 4] = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let numbers = positions.iter().flatten().chain(uvs.iter().flatten());
    let mut bytes: Vec<u8> = numbers.flat_map(|number| number.to_le_bytes()).collect();
    bytes.extend([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes()));
    bytes
}

/// A PNG image of two pixels: red to the left, blue to the right.
fn red_and_blue() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 2, 1);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header().unwrap().write_image_data(&[255, 0, 0, 0, 0, 255]).unwrap();
    bytes
}

/// A JPEG image of 8 x 8 pixels of the level 228: a mean of 100 above the middle, and no more.
fn light_grey() -> Vec<u8> {
    let table = |class: u8, symbol: u8| [&[0xff, 0xc4, 0, 20, class, 1][..], &[0; 15], &[symbol]].concat();
    [
        &[0xff, 0xd8, 0xff, 0xdb, 0, 67, 0][..],
        &[8; 64],
        &[0xff, 0xc0, 0, 11, 8, 0, 8, 0, 8, 1, 1, 0x11, 0],
        &table(0, 7),
        &table(0x10, 0),
        &[0xff, 0xda, 0, 8, 1, 1, 0, 0, 63, 0, 0x64, 0x7f, 0xff, 0xd9],
    ]
    .concat()
}

fn data_uri(kind: &str, bytes: &[u8]) -> String {
    format!("data:{kind};base64,{}", base64(bytes))
}

fn base64(bytes: &[u8]) -> String {
    let letters: Vec<char> = ('A'..='Z').chain('a'..='z').chain('0'..='9').chain(['+', '/']).collect();
    let mut text = String::new();
    for three in bytes.chunks(3) {
        let bits = three.iter().fold(0_usize, |bits, byte| bits << 8 | usize::from(*byte)) << (8 * (3 - three.len()));
        (0..4).for_each(|i| text.push(if i <= three.len() { letters[bits >> (18 - 6 * i) & 63] } else { '=' }));
    }
    text
}

/// The text of a model of the plate, with `images` as a list of JSON objects, of which the first is on the plate. The bytes
/// `more` follow those of the plate.
fn model(images: &[String], more: &[u8]) -> String {
    let bytes = [plate(), more.to_vec()].concat();
    let listed = |of: &dyn Fn(usize) -> String| (0..images.len()).map(of).collect::<Vec<_>>().join(",");
    let textures = listed(&|i| format!(r#"{{"source": {i}}}"#));
    let materials = listed(&|i| format!(r#"{{"pbrMetallicRoughness": {{"baseColorTexture": {{"index": {i}}}}}}}"#));
    let mut text = String::new();
    write!(
        text,
        r#"{{
            "asset": {{"version": "2.0"}},
            "scenes": [{{"nodes": [0]}}],
            "nodes": [{{"mesh": 0}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "TEXCOORD_0": 1}}, "indices": 2, "material": 0}}]}}],
            "materials": [{materials}],
            "textures": [{textures}],
            "images": [{}],
            "accessors": [
                {{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-2, 0, 5], "max": [2, 4, 5]}},
                {{"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"}},
                {{"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}}
            ],
            "bufferViews": [
                {{"buffer": 0, "byteOffset": 0, "byteLength": 48}},
                {{"buffer": 0, "byteOffset": 48, "byteLength": 32}},
                {{"buffer": 0, "byteOffset": 80, "byteLength": 12}},
                {{"buffer": 0, "byteOffset": 92, "byteLength": {}}}
            ],
            "buffers": [{{"byteLength": {}, "uri": "{}"}}]
        }}"#,
        images.join(","),
        more.len().max(1),
        bytes.len(),
        data_uri("application/octet-stream", &bytes),
    )
    .expect("it can be written");
    text
}

fn written(folder: &Path, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, content).unwrap();
    path
}

fn refusal(folder: &Path, images: &[String], more: &[u8]) -> String {
    let file = written(folder, "model.gltf", model(images, more));
    gltf::load(&file, Semantic::Car).expect("the look flat needs no images");
    gltf::load_in_look(&file, Semantic::Car, Look::Textured).expect_err("it is refused").to_string()
}

/// The red, green and blue of the left and of the right half of the plate as a camera before it sees them.
fn halves(file: &Path, loaded: Look, drawn: Look) -> Option<[[u8; 3]; 2]> {
    let mut renderer = renderer()?;
    let mesh = Arc::new(gltf::load_in_look(file, Semantic::Car, loaded).unwrap_or_else(|error| panic!("{error}")));
    let mut scene = support::scene(vec![thing(&mesh, [0.0; 3], 0.0, 1)]);
    scene.look = drawn;
    let camera = camera(200, 100);
    let frame = one(&mut renderer, &View::new(&scene, &camera, Isometry3::identity()), RGB);
    let rgb = frame.rgb.expect("asked for");
    let pixel = |x: usize| std::array::from_fn(|part| rgb[3 * (200 * 50 + x) + part]);
    Some([pixel(80), pixel(120)])
}

#[test]
fn an_image_is_the_same_from_any_place_and_its_upper_left_corner_is_at_0_0() {
    let folder = tempfile::tempdir().unwrap();
    let png = red_and_blue();
    written(folder.path(), "red and blue.png", &png);
    let view = r#"{"bufferView": 3, "mimeType": "image/png"}"#.to_owned();
    let beside = r#"{"uri": "red%20and%20blue.png"}"#.to_owned();
    let within = format!(r#"{{"uri": "{}"}}"#, data_uri("image/png", &png));
    for (name, image) in [("view.gltf", view), ("beside.gltf", beside), ("within.gltf", within)] {
        let file = written(folder.path(), name, model(&[image], &png));
        let Some([left, right]) = halves(&file, Look::Textured, Look::Textured) else { return };
        assert!(left[0] > 150 && left[2] < 30 && right[2] > 150 && right[0] < 30, "{name}: {left:?} {right:?}");
        // In the other look, the plate is as white as the factor of its base colour.
        for loaded in Look::ALL {
            let [left, right] = halves(&file, loaded, Look::Flat).expect("there is an adapter");
            assert!(left == right && left.iter().all(|part| *part > 150), "{name}: {left:?} {right:?}");
        }
    }
}

#[test]
fn a_jpeg_image_has_the_level_that_it_says() {
    let folder = tempfile::tempdir().unwrap();
    let see = |name: &str, content: &[u8], kind: &str| {
        let image = format!(r#"{{"uri": "{}"}}"#, data_uri(kind, content));
        halves(&written(folder.path(), name, model(&[image], &[])), Look::Textured, Look::Textured)
    };
    let mut grey = Vec::new();
    png::Encoder::new(&mut grey, 1, 1).write_header().unwrap().write_image_data(&[228]).unwrap();
    let Some(jpeg) = see("jpeg.gltf", &light_grey(), "image/jpeg") else { return };
    assert_eq!(Some(jpeg), see("png.gltf", &grey, "image/png"));
}

#[test]
fn images_that_cannot_be_used_are_refused_with_their_index_and_their_flaw() {
    let folder = tempfile::tempdir().unwrap();
    let uri = |kind: &str, content: &[u8]| format!(r#"{{"uri": "{}"}}"#, data_uri(kind, content));
    let refuse = |content: &[u8]| refusal(folder.path(), &[uri("image/png", content)], &[]);
    let gif = refuse(b"GIF89a");
    assert!(gif.contains("its image 0 cannot be used: it is neither a PNG nor a JPEG image"), "{gif}");
    let short = refuse(&red_and_blue()[..40]);
    assert!(short.contains("it is no sound PNG image"), "{short}");
    let jpeg = refuse(&light_grey()[..90]);
    assert!(jpeg.contains("it is no sound JPEG image"), "{jpeg}");
    let mut wide = Vec::new();
    png::Encoder::new(&mut wide, 100_000, 1).write_header().unwrap().write_image_data(&[0; 100_000]).unwrap();
    let wide = refuse(&wide);
    assert!(wide.contains("100000 x 1 pixels, expected at most 8192 each way"), "{wide}");
    let view = r#"{"bufferView": 3, "mimeType": "image/png"}"#.to_owned();
    let bytes = refusal(folder.path(), &[view], &[]);
    assert!(bytes.contains("its buffer has too few bytes for it"), "{bytes}");
    let many: Vec<String> = (0..17).map(|_| uri("image/png", &red_and_blue())).collect();
    let many = refusal(folder.path(), &many, &[]);
    assert!(many.contains("more than 16 images"), "{many}");
    written(folder.path(), "outside.png", red_and_blue());
    let inner = folder.path().join("models");
    std::fs::create_dir(&inner).unwrap();
    let outside = refusal(&inner, &[r#"{"uri": "../outside.png"}"#.to_owned()], &[]);
    assert!(outside.contains("../outside.png") && outside.contains("in the folder of the model"), "{outside}");
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(40))]

    #[test]
    fn whatever_is_in_an_image_nothing_panics(at in 0_usize..200, with in proptest::prelude::any::<u8>(), jpeg in proptest::prelude::any::<bool>()) {
        let folder = tempfile::tempdir().unwrap();
        let mut content = if jpeg { light_grey() } else { red_and_blue() };
        let at = at % content.len();
        content[at] = with;
        let image = format!(r#"{{"uri": "{}"}}"#, data_uri("image/png", &content));
        let file = written(folder.path(), "changed.gltf", model(&[image], &[]));
        let _ = gltf::load_in_look(file, Semantic::Car, Look::Textured);
    }
}
