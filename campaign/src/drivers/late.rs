//! Drivers whose answers take effect later, like the answers of a computer that is slower than simulated time.

use paracosm_engine::driver::{Driver, Equipment, Fault};
use paracosm_engine::sensor::{Image, Rig};
use paracosm_engine::{Briefing, Control, Observation};

/// A driver with an additional latency: the seconds from a question to the time when its answer takes effect.
pub(super) struct Late {
    pub driver: Box<dyn Driver>,
    pub latency: f64,
}

impl Driver for Late {
    fn period(&self) -> f64 {
        self.driver.period()
    }

    fn equipment(&mut self) -> Equipment {
        self.driver.equipment()
    }

    fn latency(&self) -> f64 {
        self.latency + self.driver.latency()
    }

    fn takes_over(&self) -> bool {
        self.driver.takes_over()
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        self.driver.reset(briefing)
    }

    fn perceive(&mut self, rig: &Rig, images: &[Image]) -> Result<(), Fault> {
        self.driver.perceive(rig, images)
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        self.driver.step(observation)
    }
}
