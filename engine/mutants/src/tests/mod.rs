//! A driver that plays given controls and records what it sees, and the tests with it.

mod acting;
mod conditions;
mod defects;
mod kinds;
mod random;
mod sensing;
mod sets;
mod timing;

use crate::Defect;
use nalgebra::Vector2;
use paracosm_engine::driver::{Driver, Fault};
use paracosm_engine::object::{Class, Outline};
use paracosm_engine::vehicle::Vehicle;
use paracosm_engine::{Briefing, Control, Observation, Other};
use std::sync::{Arc, Mutex};

/// The seconds between two questions to the probe.
const PERIOD: f64 = 0.1;

/// A driver that plays a list of controls from the start of each run, and records all observations.
#[derive(Default)]
struct Probe {
    plays: Vec<Control>,
    step: usize,
    seen: Arc<Mutex<Vec<Observation>>>,
}

impl Driver for Probe {
    fn period(&self) -> f64 {
        PERIOD
    }

    fn latency(&self) -> f64 {
        0.25
    }

    fn takes_over(&self) -> bool {
        false
    }

    fn reset(&mut self, _briefing: &Briefing) -> Result<(), Fault> {
        self.step = 0;
        Ok(())
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        self.seen.lock().unwrap().push(observation.clone());
        let control = self.plays.get(self.step).copied().unwrap_or_default();
        self.step += 1;
        Ok(control)
    }
}

fn defect(kind: &str, size: f64) -> Defect {
    Defect::new(kind, size).unwrap()
}

fn briefing() -> Briefing {
    Briefing { cruise_speed: 15.0, vehicle: Vehicle::BMW_320I, navigation: None }
}

/// What a driver with a defect sees of a world, moment by moment.
fn seen(defect: Defect, world: &[Observation]) -> Vec<Observation> {
    let probe = Probe::default();
    let seen = probe.seen.clone();
    let mut driver = defect.in_driver(Box::new(probe));
    driver.reset(&briefing()).unwrap();
    for moment in world {
        driver.step(moment).unwrap();
    }
    let seen = seen.lock().unwrap();
    seen.clone()
}

/// What a driver with a defect does in a world, if it wants the given controls.
fn done(defect: Defect, world: &[Observation], plays: &[Control]) -> Vec<Control> {
    let mut driver = defect.in_driver(Box::new(Probe { plays: plays.to_vec(), ..Probe::default() }));
    driver.reset(&briefing()).unwrap();
    world.iter().map(|moment| driver.step(moment).unwrap()).collect()
}

/// A body with a number at a place, with a velocity.
fn body(id: usize, class: Class, position: (f64, f64), velocity: (f64, f64)) -> Other {
    let outline = match class {
        Class::Pedestrian => Outline::Disc { radius: 0.3 },
        _ => Outline::Rectangle { length: 4.0, width: 1.8 },
    };
    let vector = |(x, y)| Vector2::new(x, y);
    Other { id, class, position: vector(position), velocity: vector(velocity), heading: 0.0, outline }
}

/// The observation at a time, of a car at 15 m/s, with some bodies.
fn moment(time: f64, others: Vec<Other>) -> Observation {
    Observation { time, speed: 15.0, travelled: 15.0 * time, others, ..Observation::default() }
}

/// A world that shows the same bodies at so many moments.
fn same(moments: usize, others: &[Other]) -> Vec<Observation> {
    (0..moments).map(|step| moment(PERIOD * step as f64, others.to_vec())).collect()
}

/// A world of a standing body straight ahead, to which the car comes nearer.
fn approach(moments: usize) -> Vec<Observation> {
    let at = |time: f64| body(0, Class::Car, (100.0 - 15.0 * time, 0.0), (0.0, 0.0));
    (0..moments).map(|step| PERIOD * step as f64).map(|time| moment(time, vec![at(time)])).collect()
}

fn throttles(wanted: &[f64]) -> Vec<Control> {
    wanted.iter().map(|&throttle| Control { throttle, steering: 0.0 }).collect()
}
