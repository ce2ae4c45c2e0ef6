//! The driver `default`: it leaves the car to the scenario, as the default controller of OpenSCENARIO does.
//!
//! A scenario of a file says what its ego vehicle does until a controller is activated. With this driver, it says so to the end, and
//! no contact ends the run. In a scenario that does not lead its ego vehicle, the driver keeps its speed and its way.

use super::cruise::{Cruise, PERIOD};
use super::{Descriptor, Driver, Fault, Settings};
use crate::observation::{Briefing, Control, Observation};

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    name: "default",
    about: "leaves the car to the scenario of a file, and keeps its speed and its way in other scenarios; no contact ends a run",
    settings: &[],
    make: |_: &Settings| Box::new(Passenger(Cruise::default())),
};

struct Passenger(Cruise);

impl Driver for Passenger {
    fn period(&self) -> f64 {
        PERIOD
    }

    fn takes_over(&self) -> bool {
        false
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        self.0.reset(briefing)
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        self.0.step(observation)
    }
}
