//! What drivers see while they drive, against what a recording of the same test shows.

#[path = "../../../../campaign/src/simulator/tests/quiet_road.rs"]
mod quiet_road;

use super::super::{Developed, Film, Projector};
use super::{cameras, can_draw, of};
use paracosm_campaign::{Campaign, Study, Trial, Worker};
use paracosm_engine::driver::{Driver, Equipment, Fault, find};
use paracosm_engine::sensor::{Cameras, Image, Look, Rig};
use paracosm_engine::{Briefing, Control, Observation};
use paracosm_render::{Stages, WantedImages};
use quiet_road::QUIET;
use std::sync::{Arc, Mutex};

fn study(changes: &[(&str, f64)]) -> Study {
    let study = Study::of(QUIET).driver("lane-camera").budget(7);
    let study = changes.iter().fold(study, |study, (name, value)| study.set_driver(name, *value));
    study.build().expect("a sound study")
}

fn trials(campaign: Campaign<'_>) -> Vec<Trial> {
    campaign.into_log().expect("it runs").trials().to_vec()
}

#[test]
fn more_rain_changes_more_of_an_image_and_no_rain_changes_nothing() {
    if !can_draw() {
        return;
    }
    let trial = trials(Campaign::new(&study(&[])).unwrap()).swap_remove(0);
    let cameras = find("lane-camera").unwrap().build(&[]).unwrap().equipment().cameras;
    let dry = study(&[]);
    let filmed = |rain: Option<f64>| {
        let mut worker = Worker::new(&dry).unwrap();
        let mut trial = trial.clone();
        if let Some(rain) = rain {
            trial.test.set("rain", rain);
            trial = worker.run(0, &trial.test).0;
        }
        let film = Film::of(&mut worker, &trial, &cameras, &Stages::default()).unwrap();
        let mut first = None;
        let mut projector = Projector::new(&cameras, WantedImages { rgb: true, ..WantedImages::default() }).unwrap();
        let show = |pictures: Vec<Developed<'_>>| {
            first = first.take().or_else(|| pictures.into_iter().next()?.1.ok()?.frame.rgb);
            Ok(())
        };
        projector.show(&film, 0, show).unwrap();
        first.expect("it has an image")
    };
    let none = filmed(None);
    assert!(filmed(Some(0.0)) == none);
    let apart = |rain: f64| -> u64 {
        filmed(Some(rain)).iter().zip(&none).map(|(wet, dry)| u64::from(wet.abs_diff(*dry))).sum()
    };
    let (little, much) = (apart(0.1), apart(1.0));
    assert!(0 < little && little < much, "{little} and {much}");
}

/// A driver that keeps what another one is shown, and when.
struct Witness {
    driver: Box<dyn Driver>,
    /// Images that have come, and not been asked about.
    new: Vec<Image>,
    shown: Arc<Mutex<Vec<(f64, Image)>>>,
}

impl Driver for Witness {
    fn period(&self) -> f64 {
        self.driver.period()
    }

    fn equipment(&mut self) -> Equipment {
        self.driver.equipment()
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        self.driver.reset(briefing)
    }

    fn perceive(&mut self, rig: &Rig, images: &[Image]) -> Result<(), Fault> {
        self.new = images.to_vec();
        self.driver.perceive(rig, images)
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        let shown = self.new.drain(..).map(|image| (observation.time, image));
        self.shown.lock().unwrap().extend(shown);
        self.driver.step(observation)
    }
}

#[test]
fn a_driver_sees_what_a_recording_shows_after_its_latency_and_but_for_what_is_lost() {
    if !can_draw() {
        return;
    }
    let study = study(&[("blur", 0.8), ("latency", 0.12), ("dropped", 0.3)]);
    let trial = trials(Campaign::new(&study).unwrap()).swap_remove(2);
    let changes = [("blur", 0.8), ("latency", 0.12), ("dropped", 0.3)].map(|(name, value)| (name.to_owned(), value));
    let shown = Arc::<Mutex<Vec<(f64, Image)>>>::default();
    let seen = shown.clone();
    let lane_camera = move || find("lane-camera").unwrap().build(&changes).unwrap();
    let cameras = lane_camera().equipment().cameras;
    let make = move || -> Box<dyn Driver> {
        Box::new(Witness { driver: lane_camera(), new: Vec::new(), shown: seen.clone() })
    };
    let witnessed = study.driven_by_own("witness", make).unwrap();
    let (again, _) = Worker::new(&witnessed).unwrap().run(2, &trial.test);
    assert_eq!(again.trace_hash, trial.trace_hash);

    let mut worker = Worker::new(&study).unwrap();
    assert_eq!(worker.eyes().unwrap(), cameras);
    let recorded = recorded(&mut worker, &trial, &cameras);
    let shown = std::mem::take(&mut *shown.lock().unwrap());
    assert!(shown.len() > 10 && shown.len() < 28, "{} of 30 images", shown.len());
    for ((asked, image), (number, rgb)) in shown.iter().zip(&recorded) {
        let late = asked - image.time;
        assert!((0.12..0.17 + 1e-9).contains(&(late + 1e-9)), "{late} s");
        assert_eq!(image.number, *number);
        assert!((image.time - 0.1 * *number as f64).abs() < 1e-9, "{} s", image.time);
        assert!(image.rgb == *rgb, "image {number}");
    }
    // The last may come when the test is over.
    assert!(recorded.len() - shown.len() <= 1);
}

/// The number and the pixels of each image that a recording of a test has.
fn recorded(worker: &mut Worker<'_>, trial: &Trial, cameras: &Cameras) -> Vec<(u64, Vec<u8>)> {
    let film = Film::of(worker, trial, cameras, &Stages::default()).unwrap();
    let mut recorded = Vec::new();
    let mut projector = Projector::new(cameras, WantedImages { rgb: true, ..WantedImages::default() }).unwrap();
    let show = |pictures: Vec<Developed<'_>>| {
        recorded.extend(pictures.into_iter().map(|(shot, picture)| (shot.number, picture.unwrap().frame.rgb.unwrap())));
        Ok(())
    };
    projector.show(&film, 0, show).unwrap();
    recorded
}

/// A driver that stands still and has cameras.
struct Parked(Cameras);

impl Driver for Parked {
    fn period(&self) -> f64 {
        0.1
    }

    fn equipment(&mut self) -> Equipment {
        Equipment { cameras: self.0.clone(), ..Equipment::default() }
    }

    fn reset(&mut self, _: &Briefing) -> Result<(), Fault> {
        Ok(())
    }

    fn step(&mut self, _: &Observation) -> Result<Control, Fault> {
        Ok(Control { throttle: -1.0, steering: 0.0 })
    }
}

#[test]
fn a_driver_sees_the_look_that_its_cameras_have_also_if_the_first_image_comes_late() {
    if !can_draw() {
        return;
    }
    let seen_in = |look: Look| {
        let cameras = Cameras { look, ..cameras("latency = 0.7\n") };
        let (own, shown) = (cameras.clone(), Arc::<Mutex<Vec<(f64, Image)>>>::default());
        let seen = shown.clone();
        let make = move || -> Box<dyn Driver> {
            let driver = Box::new(Parked(own.clone()));
            Box::new(Witness { driver, new: Vec::new(), shown: seen.clone() })
        };
        // Cars move while the first image is on its way, and parked cars keep clear of them.
        let study = of("grid-traffic").own_driver("parked", make).budget(1).build().unwrap();
        let trial = trials(Campaign::new(&study).unwrap()).swap_remove(0);
        let shown: Vec<_> = std::mem::take(&mut *shown.lock().unwrap()).into_iter().take(3).collect();
        assert_eq!(shown.len(), 3);
        let mut worker = Worker::new(&study).unwrap();
        assert_eq!(worker.eyes().unwrap().look, look);
        let recorded = recorded(&mut worker, &trial, &cameras);
        for ((_, image), (number, rgb)) in shown.iter().zip(&recorded) {
            assert!(image.number == *number && image.rgb == *rgb, "image {number} in the look {look}");
        }
        shown.into_iter().map(|(_, image)| image.rgb).collect::<Vec<_>>()
    };
    assert_ne!(seen_in(Look::Flat), seen_in(Look::Textured));
}
