//! Runs with cameras in them, which nobody draws here: when moments arrive, and that none of them depends on what else
//! the car carries.

use paracosm_engine::driver::{Driver, Equipment, Fault, find};
use paracosm_engine::sensor::{CameraSpec, Cameras, Delivery, Image, Imu, ImuSettings, Moment, Rig, Sample, Shutters};
use paracosm_engine::vehicle::VehicleModel;
use paracosm_engine::{
    AutonomousVehicle, Briefing, Control, Observation, Outcome, Program, RoadSegment, Run, Scenario, Setup, simulate,
};
use paracosm_oracles::Verdict;
use paracosm_space::Values;

const PROGRAM: Program = Program::new("empty-road", "a car alone", empty_road);

fn empty_road(s: &mut Scenario) {
    let road = s.place(RoadSegment::new(300.0));
    let speed = s.nominal("speed", 5.0..=15.0, 10.0).unit("m/s");
    s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(speed.value()));
    s.duration(4.0);
}

/// Keeps its speed, with cameras and sensors on it that it never looks through; it gives up at a time.
struct Equipped {
    driver: Box<dyn Driver>,
    cameras: Cameras,
    rig: bool,
    until: f64,
}

impl Driver for Equipped {
    fn period(&self) -> f64 {
        self.driver.period()
    }

    fn equipment(&mut self) -> Equipment {
        let mut rig = Rig::new(3);
        if self.rig {
            let imu = Imu::new(ImuSettings::default()).expect("there is one");
            rig.attach("front", imu, Delivery::default()).expect("it is the first");
        }
        Equipment { rig, cameras: self.cameras.clone() }
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        self.driver.reset(briefing)
    }

    fn perceive(&mut self, rig: &Rig, images: &[Image]) -> Result<(), Fault> {
        assert_eq!((rig.is_empty(), images.len()), (!self.rig, 0));
        Ok(())
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        if observation.time >= self.until { Err(Fault::new("it is enough")) } else { self.driver.step(observation) }
    }
}

fn camera(rate: f64, latency: f64, dropped: f64) -> CameraSpec {
    let (resolution, position) = ([8, 4], [0.3, 0.0, 1.35]);
    CameraSpec {
        resolution,
        focal_mm: 24.0,
        sensor_mm: 36.0,
        position,
        rate,
        latency,
        dropped,
        ..CameraSpec::default()
    }
}

fn cameras(all: &[(&str, CameraSpec)]) -> Cameras {
    Cameras {
        seed: 1,
        all: all.iter().map(|(name, camera)| ((*name).to_owned(), camera.clone())).collect(),
        ..Cameras::default()
    }
}

fn driver(cameras: Cameras, rig: bool) -> Equipped {
    Equipped { driver: find("cruise").unwrap().build(&[]).unwrap(), cameras, rig, until: f64::INFINITY }
}

type Taken = Vec<(f64, usize, Sample<Moment>)>;

/// Drives to the end without images: what arrived from the driver's cameras and from those of the film, each with when.
fn driven(driver: Equipped, film: &Cameras) -> (Taken, Taken, Outcome) {
    driven_in(&PROGRAM.declare().unwrap().nominal(), driver, film)
}

fn driven_in(test: &Values, mut driver: Equipped, film: &Cameras) -> (Taken, Taken, Outcome) {
    let mut run = Run::new(&PROGRAM, test, Setup::asking_every(driver.period())).unwrap();
    run.seat(&mut driver).unwrap();
    run.film(Shutters::of(film.clone()).unwrap());
    let (mut seen, mut filmed) = (Vec::new(), Vec::new());
    loop {
        let outcome = run.advance().outcome();
        let noted = |shutters: &Shutters| -> Taken {
            shutters.arrived().map(|(camera, sample)| (run.time(), camera, sample.clone())).collect()
        };
        seen.extend(noted(run.eyes()));
        filmed.extend(noted(run.filmed()));
        match outcome {
            Some(outcome) => return (seen, filmed, outcome),
            None => run.answer(&mut driver, &[]).unwrap(),
        }
    }
}

#[test]
fn moments_arrive_after_their_latency_but_for_those_that_are_lost_camera_by_camera() {
    let two = cameras(&[("b", camera(10.0, 0.23, 0.4)), ("a", camera(20.0, 0.0, 0.0))]);
    let (seen, _, _) = driven(driver(two, false), &Cameras::default());
    let of = |camera: usize| seen.iter().filter(move |(_, of, _)| *of == camera);
    assert!(of(0).map(|(_, _, sample)| sample.number).eq(0..=80), "of `a` all");
    assert!(of(0).all(|(asked, _, sample)| (asked - sample.time).abs() < 1e-9));
    assert!((12..36).contains(&of(1).count()), "of `b` {} of 41", of(1).count());
    assert!(of(1).all(|(asked, _, sample)| (0.23 - 1e-9..0.28).contains(&(asked - sample.time))));
    assert!(of(1).all(|(_, _, sample)| (sample.reading.travelled - 10.0 * sample.time).abs() < 1e-6));
    let places: Vec<_> = seen.iter().map(|(asked, camera, sample)| (*asked, *camera, sample.number)).collect();
    assert!(places.is_sorted_by(|a, b| a < b), "by time, camera and number");
}

#[test]
fn what_else_a_car_carries_changes_no_moment_and_no_trace() {
    let front = cameras(&[("front", camera(10.0, 0.1, 0.5))]);
    let (_, alone, plain) = driven(driver(Cameras::default(), false), &front);
    // All of them are called `front`.
    let (seen, filmed, outcome) = driven(driver(front.clone(), true), &front);
    assert!(!alone.is_empty() && seen == filmed && filmed == alone);
    assert_eq!(plain.trace.unwrap().hash(), outcome.trace.unwrap().hash());
}

#[test]
fn every_test_loses_images_of_its_own_and_the_same_ones_each_time() {
    let lossy = cameras(&[("front", camera(20.0, 0.0, 0.5))]);
    let kept = |speed: f64| {
        let mut test = PROGRAM.declare().unwrap().nominal();
        test.set("speed", speed);
        let (seen, filmed, _) = driven_in(&test, driver(lossy.clone(), false), &lossy);
        let numbers = |taken: Taken| taken.iter().map(|(_, _, sample)| sample.number).collect::<Vec<_>>();
        let (seen, filmed) = (numbers(seen), numbers(filmed));
        assert_eq!(seen, filmed);
        seen
    };
    let all = [kept(10.0), kept(10.000001), kept(12.0)];
    assert_eq!(all[0], kept(10.0));
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        // Of 81 images a quarter is kept in both of two tests by chance; five standard deviations are 19.
        let both = all[i].iter().filter(|number| all[j].contains(number)).count();
        assert!((1..40).contains(&both), "{both} of {} and {}", all[i].len(), all[j].len());
    }
}

#[test]
fn a_driver_that_cannot_drive_says_why() {
    let told = |mut driver: Equipped| {
        let outcome = simulate(&PROGRAM, &PROGRAM.declare().unwrap().nominal(), VehicleModel::default(), &mut driver);
        assert_eq!(outcome.verdict(), Verdict::Error);
        outcome.ending.message().unwrap()
    };
    let blind = told(driver(cameras(&[("front", camera(10.0, 0.0, 0.0))]), false));
    assert!(blind.contains("camera `front`") && blind.contains("nothing renders images"), "{blind}");
    let wrong = told(driver(cameras(&[("rear", camera(0.0, 0.0, 0.0))]), false));
    assert!(wrong.contains("rear") && wrong.contains("period"), "{wrong}");
    let tired = told(Equipped { until: 1.0, ..driver(Cameras::default(), true) });
    assert!(tired.contains("gave up at 1.000 s: it is enough"), "{tired}");
}

/// The road with a parameter that is asked for later than the speed.
fn later_road(s: &mut Scenario) {
    s.nominal("wind", 0.0..=1.0, 0.5).incidental();
    empty_road(s);
}

/// The seed of cameras in a test of a program.
fn seed(program: &Program, changes: &[(&str, f64)]) -> u64 {
    let mut test = program.declare().unwrap().nominal();
    changes.iter().for_each(|(name, value)| test.set(*name, *value));
    let mut run = Run::new(program, &test, Setup::asking_every(0.1)).unwrap();
    run.film(Shutters::of(cameras(&[])).unwrap());
    run.filmed().cameras().seed
}

#[test]
fn what_is_asked_for_later_leaves_the_noise_of_tests_in_which_it_is_nominal_alone() {
    let later = Program::new("empty-road", "a car alone", later_road);
    for speed in [("speed", 10.0), ("speed", 7.0)] {
        assert_eq!(seed(&later, &[speed]), seed(&PROGRAM, &[speed]));
        assert_ne!(seed(&later, &[speed, ("wind", 0.25)]), seed(&PROGRAM, &[speed]));
    }
    assert_ne!(seed(&PROGRAM, &[("speed", 10.0)]), seed(&PROGRAM, &[("speed", 7.0)]));
    assert_ne!(seed(&later, &[("wind", 0.25)]), seed(&later, &[("wind", 0.75)]));
}
