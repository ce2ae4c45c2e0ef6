//! Compares average precision and recall with `pycocotools`, the evaluation of COCO, on random images. Without Python or
//! pycocotools the test is skipped; `tests/run` installs both.

use paracosm_perception::{Areas, Criterion, Detection, Object, Rect, Tally};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

const IMAGES: usize = 500;

/// The objects and the detections of an image.
type Image = (Vec<Object>, Vec<Detection>);

/// An image with objects of many sizes, with crowds, and with detections near objects and elsewhere. Boxes lie on a grid
/// and scores have few levels, so that there are many ties.
fn image(rng: &mut Pcg64) -> Image {
    let rect = |rng: &mut Pcg64| {
        let mut side = |most: u32| f64::from(rng.random_range(0..most)) * 4.0;
        Rect { left: side(100), top: side(80), width: side(30) + 4.0, height: side(30) + 4.0 }
    };
    let objects: Vec<Object> = (0..rng.random_range(0..8))
        .map(|_| {
            let rect = rect(rng);
            // The visible area of an object is smaller than its box.
            Object { rect, area: (0.7 * rect.area()).floor(), crowd: rng.random_bool(0.2) }
        })
        .collect();
    let most = if rng.random_bool(0.02) { 160 } else { 12 };
    let detections = (0..rng.random_range(0..most)).map(|_| {
        let mut rect = rect(rng);
        if !objects.is_empty() && rng.random_bool(0.7) {
            rect = objects[rng.random_range(0..objects.len())].rect;
            rect.left += f64::from(rng.random_range(-3..4)) * 4.0;
            rect.width += f64::from(rng.random_range(0..3)) * 4.0;
        }
        Detection { class: 0, score: f64::from(rng.random_range(1..40)) / 40.0, rect }
    });
    let detections = detections.collect();
    (objects, detections)
}

/// Returns the results of `pycocotools`: average precision and recall of each case. `None` if it is not installed.
fn judged(images: &[Image], cases: &[(f64, Areas)]) -> Option<Vec<(f64, f64)>> {
    let has_judge = Command::new("python3").args(["-c", "import pycocotools"]).stderr(Stdio::null()).status();
    if !has_judge.is_ok_and(|status| status.success()) {
        eprintln!("no pycocotools: the test is skipped");
        return None;
    }
    let bbox = |rect: &Rect| [rect.left, rect.top, rect.width, rect.height];
    let (mut objects, mut detections) = (Vec::<Value>::new(), Vec::<Value>::new());
    for (image, (there, found)) in (1..).zip(images) {
        objects.extend(there.iter().map(|object| {
            json!({"image_id": image, "bbox": bbox(&object.rect), "area": object.area, "iscrowd": u8::from(object.crowd)})
        }));
        detections
            .extend(found.iter().map(|one| json!({"image_id": image, "bbox": bbox(&one.rect), "score": one.score})));
    }
    let cases: Vec<Value> = cases.iter().map(|(overlap, areas)| json!([overlap, [areas.least, areas.most]])).collect();
    let asked = json!({"images": images.len(), "objects": objects, "detections": detections, "cases": cases});
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/judge.py");
    let mut judge = Command::new("python3").arg(script).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    judge.stdin.take().unwrap().write_all(asked.to_string().as_bytes()).unwrap();
    let output = judge.wait_with_output().unwrap();
    assert!(output.status.success());
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

/// The least overlaps and the areas for which results are compared.
fn cases() -> Vec<(f64, Areas)> {
    let small = Areas { least: 0.0, most: 1024.0 };
    let large = Areas { least: 1024.0, most: 1e10 };
    let areas = [Areas::ALL, small, large];
    [0.5, 0.75, 0.95, 1.0].into_iter().flat_map(|least| areas.map(|areas| (least, areas))).collect()
}

/// Checks that average precision and recall are those of `pycocotools`.
fn compare(images: &[Image], of: &str) {
    let Some(expected) = judged(images, &cases()) else { return };
    for ((least, areas), (precision, recall)) in cases().iter().zip(expected) {
        let mut tally = Tally::default();
        for (objects, detections) in images {
            tally.add(objects, detections, Criterion::Overlap(*least), *areas);
        }
        let found = (tally.average_precision().unwrap_or(-1.0), tally.recall().unwrap_or(-1.0));
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-9;
        assert!(
            near(found.0, precision) && near(found.1, recall),
            "{of}, overlap {least}, {areas:?}: {found:?}, pycocotools has {precision} and {recall}"
        );
    }
}

#[test]
fn average_precision_and_recall_of_500_random_images_are_those_of_pycocotools() {
    for seed in 0..3 {
        let mut rng = Pcg64::seed_from_u64(seed);
        compare(&(0..IMAGES).map(|_| image(&mut rng)).collect::<Vec<_>>(), &format!("seed {seed}"));
    }
}

#[test]
fn average_precision_and_recall_of_500_recorded_images_are_those_of_pycocotools() {
    let mut images: Vec<Image> = vec![Image::default(); IMAGES];
    // The study `recall` writes the table.
    for row in include_str!("../../../experiments/data/recall-boxes.csv").lines().skip(1) {
        let fields: Vec<&str> = row.split(',').collect();
        let number = |column: usize| fields[column].parse::<f64>().unwrap();
        let rect = Rect { left: number(2), top: number(3), width: number(4), height: number(5) };
        let (objects, detections) = &mut images[number(0) as usize - 1];
        match fields[1] {
            "car" => objects.push(Object { rect, area: number(6), crowd: fields[7] == "1" }),
            _ => detections.push(Detection { class: 0, score: number(6), rect }),
        }
    }
    assert!(images.iter().filter(|(objects, _)| !objects.is_empty()).count() > IMAGES / 2);
    compare(&images, "recorded images");
}
