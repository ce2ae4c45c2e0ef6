//! Drivers in this process that speak the messages of the protocol, such as a driver of an interpreter. They get the same as over gRPC, and so
//! drive the same, but nothing is sent.

use crate::message;
use crate::wire::{self, Described};
use paracosm_engine::driver::{Driver, Equipment, Fault};
use paracosm_engine::sensor::{Image, Rig};
use paracosm_engine::{Briefing, Control, Observation};

/// Someone in this process who answers the messages of the protocol.
pub trait Answers: Send {
    /// Forgets all earlier tests, because a test begins.
    ///
    /// # Errors
    /// The driver cannot drive such a car.
    fn reset(&mut self, reset: &message::Reset) -> Result<(), Fault>;

    /// Returns the control of the car until the next step.
    ///
    /// # Errors
    /// The driver cannot go on.
    fn step(&mut self, step: message::Step) -> Result<Control, Fault>;
}

/// A driver in this process that answers the messages of the protocol.
pub struct Partner<A> {
    described: Described,
    next: message::Step,
    answers: A,
}

impl<A: Answers> Partner<A> {
    /// Makes the driver that has welcomed PARACOSM. `seed` is the seed of the noise of its sensors.
    ///
    /// # Errors
    /// The period or a sensor of the welcome is impossible.
    pub fn new(welcome: message::Welcome, seed: u64, answers: A) -> Result<Self, Fault> {
        Ok(Self { described: Described::new(welcome, seed)?, next: message::Step::default(), answers })
    }
}

impl<A: Answers> Driver for Partner<A> {
    fn period(&self) -> f64 {
        self.described.period
    }

    fn equipment(&mut self) -> Equipment {
        self.described.equipment()
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        self.next = message::Step::default();
        self.answers.reset(&briefing.into())
    }

    fn perceive(&mut self, rig: &Rig, images: &[Image]) -> Result<(), Fault> {
        self.described.write(rig, images, &mut self.next);
        Ok(())
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        let mut step = std::mem::take(&mut self.next);
        wire::write(observation, self.described.others, &mut step);
        self.answers.step(step)
    }
}
