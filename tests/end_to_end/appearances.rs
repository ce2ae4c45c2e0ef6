//! Models of users' own, by the command line: campaigns, replays and recordings show the same.

use crate::common::{fuzz, refused, succeeds, without_study};
use std::fs;
use std::path::Path;

/// A box of 4 m by 2 m by 1.5 m that shines in a colour, as binary glTF: y up, z ahead.
fn model(colour: [f32; 3]) -> Vec<u8> {
    let corner = |i: u8| {
        [1.0, 0.75, 2.0]
            .map(|half: f32| half)
            .into_iter()
            .enumerate()
            .map(move |(axis, half)| if i >> axis & 1 == 1 { half } else { -half })
    };
    let mut bytes: Vec<u8> = (0..8).flat_map(corner).flat_map(f32::to_le_bytes).collect();
    let faces: [[u16; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]);
    bytes.extend(triangles.flat_map(u16::to_le_bytes));
    let mut text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1, "material": 0}}]}}],
        "materials": [{{"pbrMetallicRoughness": {{"baseColorFactor": [{}, {}, {}, 1]}}}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3",
                        "min": [-1, -0.75, -2], "max": [1, 0.75, 2]}},
                      {{"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}}],
        "bufferViews": [{{"buffer": 0, "byteOffset": 0, "byteLength": 96}},
                        {{"buffer": 0, "byteOffset": 96, "byteLength": 72}}],
        "buffers": [{{"byteLength": 168}}]}}"#,
        colour[0], colour[1], colour[2]
    )
    .into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let chunk = |kind: &[u8; 4], data: &[u8]| [&(data.len() as u32).to_le_bytes(), &kind[..], data].concat();
    let chunks = [chunk(b"JSON", &text), chunk(b"BIN\0", &bytes)].concat();
    [b"glTF".as_slice(), &2_u32.to_le_bytes(), &(chunks.len() as u32 + 12).to_le_bytes(), &chunks].concat()
}

const CAMERAS: &str = "[camera.front]\nresolution = [64, 40]\nfocal_mm = 24.0\nsensor_mm = 36.0\nposition = [0.3, 0.0, 1.4]\n\
                       rate = 1.0\n";
const FOLLOW: [&str; 7] = ["follow-leader", "--set", "gap=10", "--budget", "1", "--model", "leader=box.glb"];

fn folder() -> tempfile::TempDir {
    let dir = tempfile::tempdir().expect("a folder");
    fs::write(dir.path().join("box.glb"), model([0.02, 0.02, 0.9])).expect("a file");
    fs::write(dir.path().join("cameras.toml"), CAMERAS).expect("a file");
    dir
}

fn pixels(path: &Path) -> Vec<u8> {
    let file = fs::File::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a small one")];
    reader.next_frame(&mut pixels).expect("a PNG");
    pixels
}

/// How many pixels of an image are of a strong blue, as only the model is.
fn blue(path: &Path) -> usize {
    let blue = |rgb: &[u8]| rgb[2] > 80 && rgb[2] / 2 > rgb[0].max(rgb[1]);
    pixels(path).chunks(3).filter(|rgb| blue(rgb)).count()
}

#[test]
fn a_leader_looks_like_the_model_in_recordings_and_replays_and_is_still_a_car() {
    if !crate::cameras::can_draw() {
        return;
    }
    let dir = folder();
    let dir = dir.path();
    let record = ["--cameras", "cameras.toml", "--out", "shown"];
    succeeds(fuzz(dir, &[&["record"][..], &FOLLOW, &record].concat()));
    let image = |folder: &str| dir.join(folder).join("000000.png");
    let leader = blue(&image("shown/000000/front/rgb"));
    assert!(leader > 15, "{leader} blue pixels");
    let cars = pixels(&image("shown/000000/front/semantic")).iter().filter(|class| **class == 14).count();
    assert!(cars >= leader, "{cars} pixels of cars, {leader} blue ones");

    let film = ["--cameras", "cameras.toml", "--camera"];
    succeeds(fuzz(dir, &[&["replay", "shown", "0"][..], &film, &["front"]].concat()));
    assert_eq!(pixels(&image("front")), pixels(&image("shown/000000/front/rgb")));

    succeeds(fuzz(dir, &[&FOLLOW[..5], &["--out", "usual"]].concat()));
    succeeds(fuzz(dir, &[&["replay", "usual", "0"][..], &film, &["red"]].concat()));
    assert_eq!(blue(&image("red")), 0);
    let log = |folder: &str| without_study(&fs::read_to_string(dir.join(folder).join("trials.jsonl")).expect("a log"));
    assert_eq!(log("shown"), log("usual"), "who does not see drives as ever");

    fs::write(dir.join("box.glb"), model([0.9, 0.9, 0.9])).expect("a file");
    let other = fuzz(dir, &[&["replay", "shown", "0"][..], &film, &["other"]].concat());
    refused(&other, &["box.glb", "the campaign was run with another model"]);
    succeeds(fuzz(dir, &["replay", "shown", "0"]));
}

#[test]
fn a_driver_that_sees_sees_the_model() {
    if !crate::cameras::can_draw() {
        return;
    }
    let dir = folder();
    let dir = dir.path();
    // A wall that is as bright as lines, over both of them.
    fs::write(dir.join("box.glb"), model([1.0; 3])).expect("a file");
    let see = ["oncoming-distractor", "--driver", "lane-camera", "--set", "gap=10", "--budget", "1", "--out"];
    let log = |out: &str, more: &[&str]| {
        succeeds(fuzz(dir, &[&see[..], &[out], more].concat()));
        fs::read_to_string(dir.join(out).join("trials.jsonl")).expect("a log")
    };
    let shown = log("shown", &["--model", "leader=box.glb"]);
    assert!(shown.contains("\"error\":null"), "{shown}");
    assert_ne!(shown, log("usual", &[]));
    succeeds(fuzz(dir, &["replay", "shown", "0"]));
}

#[test]
fn an_unknown_actor_and_a_broken_file_are_said() {
    let dir = folder();
    let dir = dir.path();
    fs::write(dir.join("broken.glb"), "no model").expect("a file");
    fs::write(dir.join("cut.glb"), &model([0.5; 3])[..300]).expect("a file");
    let show = |models: &[&str]| {
        let models = models.iter().flat_map(|model| ["--model", model]).collect::<Vec<_>>();
        fuzz(dir, &[&["follow-leader", "--budget", "1", "--out", "x"][..], &models].concat())
    };
    refused(&show(&["leadr=box.glb"]), &["`leadr`", "did you mean `leader`?", "car, leader"]);
    refused(&show(&["leader=box"]), &["leader=box", "cannot read `box`"]);
    refused(&show(&["leader"]), &["--model leader: expected ACTOR=FILE.glb"]);
    refused(&show(&["leader=broken.glb"]), &["`broken.glb` cannot be used as a model"]);
    refused(&show(&["leader=cut.glb"]), &["`cut.glb` cannot be used as a model"]);
    refused(&show(&["car=box.glb", "car=box.glb"]), &["already has another model"]);
    refused(&show(&["tree=box.glb"]), &["no actor `tree`"]);
    assert!(!dir.join("x").exists());
    let trees = ["--open", "roadside", "--model", "tree=box.glb", "--model", "bystander-2=box.glb"];
    succeeds(fuzz(dir, &[&["follow-leader", "--budget", "1", "--out", "trees"][..], &trees].concat()));
    let system = ["--system", "cat", "--space", "space.toml", "--model", "car=box.glb", "--out", "y"];
    fs::write(dir.join("space.toml"), "[[parameter]]\nname = \"x\"\ninterval = [0.0, 1.0]\n").expect("a file");
    refused(&fuzz(dir, &system), &["is not a scenario"]);
}
