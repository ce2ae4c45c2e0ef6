//! Reads the pre-trained detectors that experiments/detectors/fetch.py fetches and converts. Detectors that are absent
//! are skipped.

#![cfg(feature = "onnx")]

use paracosm_neural::vision::{Description, Vision};
use paracosm_perception::{Perceiver, Percept, Picture, Task, suppress};
use std::fs;
use std::path::Path;

#[test]
fn fetched_detectors_are_read_and_answer_an_image() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/detectors");
    for name in ["ssd-coco", "centernet-coco", "ssd-open-images"] {
        let Ok(contents) = fs::read(folder.join(format!("{name}.onnx"))) else {
            eprintln!("no {name}: skipped; experiments/detectors/fetch.py fetches it");
            continue;
        };
        let text = fs::read_to_string(folder.join(format!("{name}.toml"))).unwrap();
        let mut network = Vision::read(&contents, Description::parse(&text).unwrap()).unwrap();
        let Task::Detection(detector) = network.task().clone() else { panic!("{name} is a detector") };
        assert!(detector.groups.iter().any(|group| group.name == "vehicle"), "{name}");
        let rgb = vec![127; 3 * 640 * 480];
        let picture = Picture { width: 640, height: 480, rgb: &rgb };
        let answers = network.perceive(&[picture, picture]).unwrap();
        assert_eq!(answers[0], answers[1], "{name}: an answer depends on its image alone");
        let Percept::Boxes(boxes) = &answers[0] else { panic!("{name} answers with boxes") };
        assert!(suppress(boxes, 0.5, 0.5).is_empty(), "{name} sees something on a grey image");
    }
}
