//! The teacher of a network: a driver with an expert who says for every image what should be done.
//!
//! At first the expert drives, and a disturbance pushes the car about, so that the network sees how to come back. Then
//! the network drives, and the expert only says what it would have done, in situations that the network's own mistakes
//! have led to (Ross, Gordon, Bagnell, "A Reduction of Imitation Learning and Structured Prediction to No-Regret Online
//! Learning", 2011).

use super::courses::LOOK;
use paracosm::engine::driver::{Driver, Equipment, Fault};
use paracosm::engine::sensor::{Cameras, Chance, Image, Rig};
use paracosm::engine::{Briefing, Control, Observation};
use paracosm_neural::learn::Lesson;
use paracosm_neural::{PERIOD, Pilot, camera};
use std::mem::take;
use std::sync::{Arc, Mutex};

/// The lessons of each run, in the order in which the runs ended.
pub type Notes = Arc<Mutex<Vec<Vec<Lesson>>>>;

/// The share of a disturbance that is left after a step, which is a time constant of about half a second.
const LEFT: f64 = 0.8;

/// The distance from its route, in metres, from which on the car is lost and the lesson ends.
const LOST: f64 = 3.0;

/// The lesson ends when all other road users are this many metres behind the car.
const PAST: f64 = 60.0;

/// A driver that records lessons (an expert's control for an image) to train a network.
pub struct Teacher {
    expert: Box<dyn Driver>,
    /// The network that drives instead of the expert, if any.
    pupil: Option<Pilot>,
    resolution: [u32; 2],
    /// The standard deviations of the noise that is added to steering and throttle.
    disturbance: [f64; 2],
    seed: u64,
    notes: Notes,
    run: Vec<Lesson>,
    seen: Option<Image>,
    /// The source of the disturbance and its present values; `None` until a run has begun.
    pushed: Option<(Chance, [f64; 2])>,
}

impl Teacher {
    /// Makes a teacher. Without a pupil, the expert drives with this disturbance; with a pupil, the pupil drives.
    pub fn new(
        expert: Box<dyn Driver>,
        pupil: Option<Pilot>,
        resolution: [u32; 2],
        disturbance: [f64; 2],
        seed: u64,
        notes: Notes,
    ) -> Self {
        Self { expert, pupil, resolution, disturbance, seed, notes, run: Vec::new(), seen: None, pushed: None }
    }

    fn hand_in(&mut self) {
        let run = take(&mut self.run);
        if !run.is_empty() {
            self.notes.lock().expect("nobody panics while taking notes").push(run);
        }
    }

    /// Returns the present disturbance. It changes slowly, and is the same in every run that begins in the same way.
    fn push(&mut self, observation: &Observation) -> [f64; 2] {
        let seed = self.seed;
        let (chance, push) = self.pushed.get_or_insert_with(|| {
            let places = observation.others.iter().map(|other| other.position.x.to_bits());
            let number = places.fold(observation.speed.to_bits(), |sum, bits| sum.rotate_left(7) ^ bits);
            (Chance::of(seed, "disturbance", number), [0.0; 2])
        });
        for (push, deviation) in push.iter_mut().zip(self.disturbance) {
            *push = LEFT * *push + (1.0 - LEFT * LEFT).sqrt() * deviation * chance.normal();
        }
        *push
    }
}

impl Drop for Teacher {
    fn drop(&mut self) {
        self.hand_in();
    }
}

impl Driver for Teacher {
    fn period(&self) -> f64 {
        PERIOD
    }

    fn equipment(&mut self) -> Equipment {
        let all = [("front".to_owned(), camera(self.resolution))];
        Equipment { cameras: Cameras { look: LOOK, all: all.into(), ..Cameras::default() }, ..Equipment::default() }
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        self.hand_in();
        (self.seen, self.pushed) = (None, None);
        self.expert.reset(briefing)?;
        self.pupil.as_mut().map_or(Ok(()), |pupil| pupil.reset(briefing))
    }

    fn perceive(&mut self, rig: &Rig, images: &[Image]) -> Result<(), Fault> {
        self.seen = images.last().cloned();
        self.pupil.as_mut().map_or(Ok(()), |pupil| pupil.perceive(rig, images))
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        if observation.way.offset.abs() > LOST {
            return Err(Fault::new("the car is lost, and the lesson is over"));
        }
        if !observation.others.is_empty() && observation.others.iter().all(|other| other.position.x < -PAST) {
            return Err(Fault::new("all other road users are far behind the car, and the lesson is over"));
        }
        let right = self.expert.step(observation)?;
        if let Some(image) = self.seen.take() {
            let control = [right.steering as f32, right.throttle as f32];
            let speed = observation.speed as f32;
            self.run.push(Lesson { run: 0, rgb: image.rgb, speed, control });
        }
        let wanted = self.pupil.as_mut().map_or(Ok(right), |pupil| pupil.step(observation))?;
        let [steering, throttle] = self.push(observation);
        Ok(Control {
            steering: (wanted.steering + steering).clamp(-1.0, 1.0),
            throttle: (wanted.throttle + throttle).clamp(-1.0, 1.0),
        })
    }
}
