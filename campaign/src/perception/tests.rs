//! Tests of perceivers on trial, with perceivers that are simple enough to know what they see.

use crate::cameras::VariedCameras;
use crate::gallery::Gallery;
use crate::simulator::tests::can_draw;
use crate::study::{PerceiverChoice, StudyBuilder};
use crate::{Campaign, Log, Study, Worker};
use paracosm_engine::object::Body;
use paracosm_engine::sensor::{CameraSpec, Cameras};
use paracosm_engine::{AutonomousVehicle, Monitor, Mover, Program, RoadSegment, Scenario};
use paracosm_oracles::{Trace, Verdict};
use paracosm_perception::{Detection, Detector, Extent, Mask, Perceiver, PerceiverError, Percept, Picture, Rect, Task};
use std::num::NonZeroUsize;
use std::sync::{Arc, Mutex};

/// A red car drives ahead on an empty road.
const RED_CAR: Program = Program::new("red-car", "a red car drives ahead", red_car);

fn red_car(s: &mut Scenario) {
    let gap = s.interval("gap", 15.0..=35.0).unit("m");
    let road = s.place(RoadSegment::new(300.0));
    let car = s.place(AutonomousVehicle::along(road.path(1)).starting(10.0).speed(10.0));
    let red = Body::car().coloured([200, 10, 10]);
    s.place(Mover::new("leader", red, road.path(1)).starting(10.0 + gap.value()).speed(10.0));
    s.duration(4.0);
    s.monitor(Monitor::no_collision(&car));
    s.monitor(Monitor::progress(&car, 12.0));
}

/// A detector that answers with the box around all red pixels, or with nothing, or fails.
#[derive(Clone)]
struct Red {
    task: Task,
    behaviour: Behaviour,
}

#[derive(Clone, Copy, PartialEq)]
enum Behaviour {
    Sees,
    Blind,
    Broken,
    /// Answers with a class that the detector does not have.
    WrongClass,
    /// Answers fewer images than it was shown.
    Silent,
    /// Answers with a mask.
    Mask,
    Panics,
}

impl Red {
    fn new(behaviour: Behaviour) -> Self {
        Self { task: Task::Detection(Detector::of(vec!["car".to_owned()])), behaviour }
    }

    fn box_of(picture: &Picture<'_>) -> Option<Rect> {
        let red = |pixel: &[u8]| {
            let [r, g, b] = [0, 1, 2].map(|place| u16::from(pixel[place]));
            r > 60 && r > 2 * g && r > 2 * b
        };
        let places = picture.rgb.chunks_exact(3).enumerate().filter(|(_, pixel)| red(pixel)).map(|(place, _)| place);
        let places: Vec<[f64; 2]> = places
            .map(|place| [place % picture.width as usize, place / picture.width as usize].map(|number| number as f64))
            .collect();
        let end = |axis: usize, best: fn(f64, f64) -> f64| places.iter().map(|place| place[axis]).reduce(best);
        let (left, top) = (end(0, f64::min)?, end(1, f64::min)?);
        Some(Rect::between([left, top], [end(0, f64::max)? + 1.0, end(1, f64::max)? + 1.0]))
    }
}

impl Perceiver for Red {
    fn task(&self) -> &Task {
        &self.task
    }

    fn perceive(&mut self, pictures: &[Picture<'_>]) -> Result<Vec<Percept>, PerceiverError> {
        let answer = |picture: &Picture<'_>| match self.behaviour {
            Behaviour::Broken => Err(PerceiverError::Pixel),
            Behaviour::Blind | Behaviour::Silent => Ok(Percept::Boxes(Vec::new())),
            Behaviour::WrongClass => {
                Ok(Percept::Boxes(vec![Detection { class: 7, score: 0.9, rect: Rect::default() }]))
            }
            Behaviour::Mask => Ok(Percept::Mask(Mask { width: 1, height: 1, pixels: vec![true] })),
            Behaviour::Panics => panic!("a perceiver of a test"),
            Behaviour::Sees => {
                let found = Self::box_of(picture).map(|rect| Detection { class: 0, score: 0.9, rect });
                Ok(Percept::Boxes(found.into_iter().collect()))
            }
        };
        let shown = if self.behaviour == Behaviour::Silent { &pictures[1..] } else { pictures };
        shown.iter().map(answer).collect()
    }
}

fn cameras() -> VariedCameras {
    let front = CameraSpec {
        resolution: [160, 120],
        focal_mm: 36.0,
        sensor_mm: 36.0,
        position: [0.3, 0.0, 1.35],
        rate: 5.0,
        ..CameraSpec::default()
    };
    Cameras { seed: 1, all: [("front".to_owned(), front)].into(), ..Cameras::default() }.into()
}

/// A study of a red leader.
fn study(behaviour: Behaviour) -> StudyBuilder {
    let study = Study::of(RED_CAR).budget(3);
    study.own_perceiver("red", cameras(), move || Box::new(Red::new(behaviour)))
}

fn first(study: &Study) -> (crate::Trial, Option<Trace>) {
    let test = crate::Campaign::new(study).unwrap().into_log().unwrap().trials()[0].test.clone();
    Worker::new(study).unwrap().run(0, &test)
}

fn most(trace: &Trace, signal: &str) -> f64 {
    trace.signal(signal).unwrap_or_else(|| panic!("no {signal}")).fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn a_detector_that_sees_passes_where_a_blind_detector_fails() {
    if !can_draw() {
        return;
    }
    let (seen, trace) = first(&study(Behaviour::Sees).build().unwrap());
    let trace = trace.unwrap();
    assert_eq!(seen.verdict, Verdict::Pass, "{:?}", seen.judgements);
    assert_eq!(seen.requirements().collect::<Vec<_>>(), ["detection"]);
    assert_eq!((most(&trace, "perception.objects"), most(&trace, "perception.matches")), (1.0, 1.0));
    assert!(most(&trace, "perception.images") >= 20.0);
    let (missed, trace) = first(&study(Behaviour::Blind).build().unwrap());
    let trace = trace.unwrap();
    assert_eq!(missed.verdict, Verdict::Fail);
    assert_eq!((most(&trace, "perception.matches"), most(&trace, "perception.misses")), (0.0, 1.0));
    // The robustness is the time that is left, or minus the time that was too long.
    let robustness = missed.robustness("detection").unwrap();
    assert!((robustness - (0.5 - most(&trace, "perception.unmatched"))).abs() < 1e-9, "{robustness}");
    // The score of a blind detector is missing by the whole threshold.
    let least = trace.signal("perception.margin").unwrap().fold(f64::INFINITY, f64::min);
    assert_eq!(least, -0.5);
}

#[test]
fn the_run_is_the_run_of_the_driver_and_results_do_not_depend_on_workers() {
    if !can_draw() {
        return;
    }
    let sees = study(Behaviour::Sees).build().unwrap();
    let log = |study: &Study, jobs: usize| -> Log {
        Campaign::new(study).unwrap().jobs(NonZeroUsize::new(jobs).unwrap()).into_log().unwrap()
    };
    let (one, two) = (log(&sees, 1), log(&sees, 2));
    assert_eq!(one.trials(), two.trials());
    let plain = Study::of(RED_CAR).driver("planner").budget(3).build().unwrap();
    let hashes = |log: &Log| log.trials().iter().map(|trial| trial.trace_hash.clone()).collect::<Vec<_>>();
    assert_eq!(hashes(&one), hashes(&log(&plain, 1)), "the perceiver does not drive");
}

#[test]
fn a_perceiver_that_fails_is_an_error_of_its_test() {
    if !can_draw() {
        return;
    }
    let seen = study(Behaviour::Sees).build().unwrap();
    let test = Campaign::new(&seen).unwrap().into_log().unwrap().trials()[0].test.clone();
    for (behaviour, said) in [
        (Behaviour::Broken, "no number"),
        (Behaviour::WrongClass, "a box has the class 7, expected a number below 1"),
        (Behaviour::Silent, "expected one for each image"),
        (Behaviour::Mask, "the answer is a mask, expected boxes"),
        (Behaviour::Panics, "the perceiver panicked: a perceiver of a test"),
    ] {
        let broken = study(behaviour).build().unwrap();
        let (trial, _) = Worker::new(&broken).unwrap().run(0, &test);
        assert_eq!(trial.verdict, Verdict::Error, "{said}");
        assert!(trial.error().unwrap().contains(said), "{:?}", trial.problem);
    }
}

#[test]
fn a_perceiver_of_a_file_has_one_camera_and_a_valid_task() {
    let written = serde_json::to_value(study(Behaviour::Sees).build().unwrap().perceiver().unwrap()).unwrap();
    let checked = |change: &dyn Fn(&mut serde_json::Value)| {
        let mut changed = written.clone();
        change(&mut changed);
        let choice: PerceiverChoice = serde_json::from_value(changed).unwrap();
        choice.check().unwrap_err().to_string()
    };
    let no_camera = checked(&|entry| entry["cameras"]["camera"] = serde_json::json!({}));
    assert!(no_camera.contains("found 0"), "{no_camera}");
    let threshold = checked(&|entry| entry["task"]["detection"]["threshold"] = 7.0.into());
    assert!(threshold.contains("`threshold` is 7"), "{threshold}");
    // The function of another program cannot be called.
    let choice: PerceiverChoice = serde_json::from_value(written).unwrap();
    assert!(
        choice
            .build(crate::Supervision::default())
            .err()
            .unwrap()
            .to_string()
            .contains("only that program can run its tests")
    );
}

#[test]
fn formulas_about_perception_replace_the_usual_requirement_and_unknown_signals_are_refused() {
    let given = study(Behaviour::Sees).spec("always (perception.false_alarms <= 2)").build().unwrap();
    let ids: Vec<&str> = given.requirements().iter().map(|requirement| requirement.id.as_str()).collect();
    assert_eq!(ids, ["spec-1"]);
    let wrong = study(Behaviour::Sees).spec("always (perception.recal >= 1)").build().unwrap_err();
    assert!(wrong.to_string().contains("perception.recall"), "{wrong}");
    assert!(given.title().ends_with("perceiver red"));
    // Without a perceiver there are no such signals.
    assert!(Study::of(RED_CAR).spec("always (perception.recall >= 1)").build().is_err());
}

#[test]
fn a_gallery_shows_the_images_that_a_perceiver_sees_with_their_ground_truth() {
    if !can_draw() {
        return;
    }
    /// A perceiver that keeps the images.
    struct Keeper(Task, Arc<Mutex<Vec<Vec<u8>>>>);
    impl Perceiver for Keeper {
        fn task(&self) -> &Task {
            &self.0
        }
        fn perceive(&mut self, pictures: &[Picture<'_>]) -> Result<Vec<Percept>, PerceiverError> {
            self.1.lock().unwrap().extend(pictures.iter().map(|picture| picture.rgb.to_vec()));
            Ok(pictures.iter().map(|_| Percept::Boxes(Vec::new())).collect())
        }
    }
    let seen = Arc::new(Mutex::new(Vec::new()));
    let (kept, task) = (seen.clone(), Red::new(Behaviour::Blind).task);
    let study = Study::of(RED_CAR).budget(1);
    let study =
        study.own_perceiver("keeper", cameras(), move || Box::new(Keeper(task.clone(), kept.clone()))).build().unwrap();
    let test = Campaign::new(&study).unwrap().into_log().unwrap().trials()[0].test.clone();
    let plain = Study::of(RED_CAR).driver("planner").build().unwrap();
    let shown = Gallery::new(&plain, cameras()).unwrap().show(&test).unwrap();
    let seen = seen.lock().unwrap();
    assert_eq!(shown.len(), seen.len());
    assert!(shown.len() >= 20);
    for (shown, seen) in shown.iter().zip(seen.iter()) {
        assert!(shown.picture().rgb == &seen[..], "at {} s", shown.time());
        let users = shown.road_users(Extent::Visible);
        assert_eq!(users.len(), 1);
        assert!(users[0].kind == "car" && users[0].should_be_detected(), "{users:?}");
        let road = shown.mask(&["road".to_owned()]).pixels;
        assert!(road.iter().filter(|is_road| **is_road).count() > road.len() / 10);
    }
}
