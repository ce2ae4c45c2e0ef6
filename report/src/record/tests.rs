//! Recordings against what they were made of, decoded and counted anew.

#[path = "../../../engine/render/tests/support/adapter.rs"]
mod adapter;
mod seen;
mod varied;
mod whole;

use super::*;
use paracosm_campaign::{Campaign, Catalogue, Study, StudyBuilder, Trial, Worker};
use paracosm_engine::sensor::{CameraSpec, Cameras};
use paracosm_render::{Frame, Stages};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Whether there is something to draw with; a note where there is not, unless somebody insists.
pub fn can_draw() -> bool {
    adapter::unless_missing(paracosm_render::adapter()).is_some()
}

fn cameras(more: &str) -> Cameras {
    let text = format!(
        "[camera.front]\nresolution = [48, 32]\nfocal_mm = 24.0\nsensor_mm = 36.0\nposition = [0.3, 0.0, 1.35]\n\
         rate = 2.0\n{more}"
    );
    toml::from_str(&text).expect("sound cameras")
}

fn two_tests() -> (Study, Vec<Trial>) {
    tests_of(of("pedestrian-crossing"), 2)
}

fn of(scenario: &str) -> StudyBuilder {
    Study::of(Catalogue::of(paracosm_scenarios::ALL).find(scenario).expect("it is in the catalogue"))
}

/// The first tests of a study.
fn tests_of(study: StudyBuilder, tests: usize) -> (Study, Vec<Trial>) {
    let study = study.budget(tests).build().expect("a sound study");
    let log = Campaign::new(&study).and_then(Campaign::into_log).expect("it runs");
    (study, log.trials().to_vec())
}

fn recorded(folder: &Path, cameras: &Cameras, kept: Kept, trials: &[Trial], study: &Study) {
    let dataset = Dataset::open(folder, cameras.clone(), kept, Some(3)).expect("a new data set");
    let mut projector = Projector::new(cameras, kept.outputs()).expect("there is an adapter");
    let mut worker = Worker::new(study).expect("it can be run");
    for trial in trials.iter().filter(|trial| !dataset.has(trial)) {
        assert!(dataset.record(&mut worker, trial, &mut projector).expect("it is recorded").images > 0);
    }
    dataset.finish(trials).expect("it can be written");
}

fn filmed(study: &Study, trial: &Trial, cameras: &Cameras) -> Result<Film, paracosm_campaign::Error> {
    Film::of(&mut Worker::new(study)?, trial, cameras, &Stages::default())
}

/// All files below a folder, by their paths.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut all = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let contents = fs::read(&path).expect("a file");
                all.insert(path.strip_prefix(folder).expect("it is below").to_owned(), contents);
            }
        }
    }
    all
}

/// The numbers of a grey image and how many are across.
fn decoded(contents: &[u8]) -> (Vec<u16>, usize) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(contents)).read_info().expect("a PNG");
    let mut bytes = vec![0; reader.output_buffer_size().expect("it fits into memory")];
    let info = reader.next_frame(&mut bytes).expect("an image");
    let words = match info.bit_depth {
        png::BitDepth::Sixteen => bytes.chunks_exact(2).map(|word| u16::from_be_bytes([word[0], word[1]])).collect(),
        _ => bytes.iter().map(|byte| u16::from(*byte)).collect(),
    };
    (words, info.width as usize)
}

/// The frames of a test, drawn one by one.
fn frames(study: &Study, trial: &Trial, cameras: &Cameras) -> Vec<(u64, Frame)> {
    let film = filmed(study, trial, cameras).expect("it can be filmed");
    let mut projector = Projector::new(cameras, Kept::ALL.outputs()).expect("there is an adapter");
    let mut frames = Vec::new();
    for shot in &film.shots[0] {
        let alone = Film { shots: vec![vec![shot.clone()]], ..film.clone() };
        projector
            .show(&alone, 0, |pictures| {
                let frame = |(shot, picture): Developed<'_>| (shot.number, picture.expect("it is outside").frame);
                frames.extend(pictures.into_iter().map(frame));
                Ok(())
            })
            .expect("it is drawn");
    }
    frames
}

#[test]
fn masks_depths_and_boxes_are_those_of_the_frames_whatever_they_were_drawn_beside() {
    if !can_draw() {
        return;
    }
    let (study, trials) = two_tests();
    let (dir, cameras) = (tempfile::tempdir().expect("a folder"), cameras(""));
    recorded(dir.path(), &cameras, Kept::ALL, &trials, &study);
    let files = files(&dir.path().join("000001"));
    let image = |kind: &str, number: u64| decoded(&files[Path::new(&format!("front/{kind}/{number:06}.png"))]);
    let annotations: serde_json::Value =
        serde_json::from_slice(&files[Path::new("annotations.json")]).expect("it is JSON");
    let mut boxes = 0;
    let drawn = frames(&study, &trials[1], &cameras);
    assert_eq!(drawn.len(), annotations["images"].as_array().expect("a list").len());
    for (entry, (number, frame)) in annotations["images"].as_array().expect("a list").iter().zip(&drawn) {
        assert_eq!(entry["frame"], *number);
        let words = |bytes: &[u8]| bytes.iter().map(|byte| u16::from(*byte)).collect::<Vec<_>>();
        assert_eq!(image("semantic", *number).0, words(frame.semantic.as_deref().expect("it was asked for")));
        let (instance, width) = image("instance", *number);
        assert_eq!(instance, *frame.instance.as_ref().expect("it was asked for"));
        for (word, metres) in image("depth", *number).0.iter().zip(frame.planar_depth().expect("it was asked for")) {
            let found = f32::from(*word) / 256.0;
            assert!(if *word == 0 { metres > 255.9 } else { (found - metres).abs() <= 0.5 / 256.0 }, "{metres} m");
        }
        let of_image = annotations["annotations"].as_array().expect("a list").iter();
        let of_image: Vec<_> = of_image.filter(|annotation| annotation["image_id"] == entry["id"]).collect();
        let mut ids: Vec<u16> = instance.iter().copied().filter(|id| *id != 0).collect();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(of_image.len(), ids.len());
        for annotation in of_image {
            boxes += 1;
            let id = annotation["instance"].as_u64().expect("a number") as u16;
            let mine = instance.iter().enumerate().filter(|(_, of)| **of == id);
            let places: Vec<_> = mine.map(|(index, _)| (index % width, index / width)).collect();
            let columns = || places.iter().map(|place| place.0);
            let rows = || places.iter().map(|place| place.1);
            let (left, top) = (columns().min().expect("it is seen"), rows().min().expect("it is seen"));
            let (right, bottom) = (columns().max().expect("it is seen"), rows().max().expect("it is seen"));
            assert_eq!(annotation["bbox"], serde_json::json!([left, top, right - left + 1, bottom - top + 1]));
            assert_eq!(annotation["area"], places.len());
            let occlusion = annotation["attributes"]["occlusion"].as_f64().expect("it is measured");
            assert!((0.0..=1.0).contains(&occlusion));
            assert!(annotation["box3d"]["center"][0].as_f64().expect("it has a place") > 0.0);
        }
    }
    assert!(boxes > 0, "somebody is to be seen");
}

#[test]
fn a_recording_goes_on_where_it_was_killed_and_is_the_same_with_noise_lost_images_and_all() {
    if !can_draw() {
        return;
    }
    let (study, trials) = two_tests();
    let noisy = cameras("dropped = 0.3\nlatency = 0.1\nblur = 0.7\nfull_well = 900.0\nread_noise = 9.0\n");
    let (whole, killed) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
    recorded(whole.path(), &noisy, Kept::ALL, &trials, &study);
    recorded(killed.path(), &noisy, Kept::ALL, &trials[..1], &study);
    // What a kill leaves behind.
    let part = killed.path().join("000001.part/front/rgb");
    fs::create_dir_all(&part).expect("a folder");
    fs::write(part.join("999999.png"), "half").expect("a file");
    recorded(killed.path(), &noisy, Kept::ALL, &trials, &study);
    let (whole_files, killed_files) = (files(whole.path()), files(killed.path()));
    assert!(whole_files == killed_files, "{:?}\n{:?}", whole_files.keys(), killed_files.keys());
    let numbers =
        |files: &BTreeMap<PathBuf, Vec<u8>>| files.keys().filter(|path| path.starts_with("000000/front/rgb")).count();
    let film = filmed(&study, &trials[0], &cameras("")).expect("it can be filmed");
    assert!(numbers(&whole_files) < film.shots[0].len(), "none of {} images was lost", film.shots[0].len());
    let other = Dataset::open(whole.path(), cameras(""), Kept::ALL, Some(3)).expect_err("it has other cameras");
    assert!(other.to_string().contains("other cameras"), "{other}");
}

#[test]
fn only_what_is_asked_for_is_kept() {
    if !can_draw() {
        return;
    }
    let (study, trials) = two_tests();
    let dir = tempfile::tempdir().expect("a folder");
    let kept = "rgb,depth".parse().expect("there are such outputs");
    recorded(dir.path(), &cameras(""), kept, &trials[..1], &study);
    let kinds: std::collections::BTreeSet<_> = files(&dir.path().join("000000"))
        .into_keys()
        .map(|path| path.iter().nth(1).map_or_else(|| path.display().to_string(), |kind| kind.display().to_string()))
        .collect();
    assert_eq!(kinds.into_iter().collect::<Vec<_>>(), ["calibration.json", "controls.csv", "depth", "rgb"]);
}

#[test]
fn a_film_has_the_moments_of_its_rate_and_the_answers_of_its_driver() {
    let (study, trials) = two_tests();
    let film = filmed(&study, &trials[0], &cameras("")).expect("it can be filmed");
    for (index, shot) in film.shots[0].iter().enumerate() {
        assert_eq!((shot.number, shot.time), (index as u64, 0.5 * index as f64));
    }
    assert!(film.shots[0].iter().any(|shot| shot.control.throttle != 0.0));
    let mut painted = film.clone();
    painted.repaint(5, 0);
    let colours =
        |film: &Film| film.shots[0][0].moment.bodies.iter().map(|state| state.body.colour).collect::<Vec<_>>();
    assert_ne!(colours(&film), colours(&painted));
    assert_eq!(colours(&film)[0], colours(&painted)[0]);
    let mut log = trials[0].clone();
    log.trace_hash = Some("another".to_owned());
    let refused = filmed(&study, &log, &cameras("")).expect_err("it is another run");
    assert!(refused.to_string().contains("trace"), "{refused}");
}

#[test]
fn lists_of_outputs_say_what_is_wrong_with_them() {
    let error = "rgb,depht".parse::<Kept>().expect_err("there is none").to_string();
    assert!(error.contains("`depth`"), "{error}");
    let error = "".parse::<Kept>().expect_err("there is none").to_string();
    assert_eq!(error, "the list of outputs is empty, expected some of rgb, semantic, depth, instance, boxes");
}

#[test]
fn depths_that_do_not_fit_are_none() {
    assert_eq!(image::depth_words(&[0.5, 10.0, 255.99, 300.0, f32::INFINITY]), [128, 2560, 65533, 0, 0]);
}
