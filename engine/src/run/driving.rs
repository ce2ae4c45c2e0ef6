//! Runs with a driver at the wheel.
//!
//! A driver [takes its seat](Run::seat) in a run, and [answers](Run::answer) whenever the run needs a control. The
//! images of its cameras have to be rendered before it answers, which the engine does not do: a program that renders
//! goes from question to question itself. For drivers without cameras there are [`simulate`] and [`watch`].

use super::{Run, Setup};
use crate::driver::{Driver, Fault, FaultKind};
use crate::outcome::{Breakdown, Invalid, Outcome};
use crate::program::{Program, ProgramError};
use crate::scenario::ticks;
use crate::sensor::{Image, Shutters};
use crate::test::Test;
use crate::vehicle::VehicleSetup;

impl Run {
    /// Makes the run of a test with the given vehicle model, and [seats](Self::seat) the driver in the car.
    ///
    /// # Errors
    /// Returns the outcome of the test if the world cannot be built or the driver cannot drive such a car.
    pub fn seated<'a>(
        program: &Program,
        test: impl Into<Test<'a>>,
        vehicle: impl Into<VehicleSetup>,
        driver: &mut dyn Driver,
    ) -> Result<Self, Box<Outcome>> {
        let (vehicle, takes_over) = (vehicle.into(), driver.takes_over());
        let setup = Setup { vehicle, takes_over, ..Setup::asking_every(driver.period()) };
        let mut run = match Self::new(program, test, setup) {
            Ok(run) => run,
            Err(error @ ProgramError::World { .. }) => return Err(Box::new(Outcome::broken(Invalid::World(error)))),
            Err(error) => return Err(Box::new(Outcome::broken(Breakdown::Program(error)))),
        };
        match run.seat(driver) {
            Ok(()) => Ok(run),
            Err(fault) => Err(Box::new(run.broken_by(fault))),
        }
    }

    /// Puts a driver in the car, with the driver's equipment and latency, and resets the driver. If the driver has no
    /// rig, a rig that the run was given before stays.
    ///
    /// # Errors
    /// The driver cannot drive such a car, or has a camera with impossible settings.
    pub fn seat(&mut self, driver: &mut dyn Driver) -> Result<(), Fault> {
        let equipment = driver.equipment();
        if !equipment.rig.is_empty() {
            self.equip(equipment.rig);
        }
        self.open_eyes(
            Shutters::of(equipment.cameras).map_err(|error| Fault::of(FaultKind::Equipment, error.to_string()))?,
        );
        self.latency = ticks(driver.latency().max(0.0), self.dt);
        driver.reset(&self.briefing())
    }

    /// Supplies the run with the driver's control, which [`Run::advance`] needs. `images` are the images of all moments
    /// that have arrived from the run's [`eyes`](Run::eyes), in order, without images from inside a body.
    ///
    /// # Errors
    /// The driver cannot go on.
    pub fn answer(&mut self, driver: &mut dyn Driver, images: &[Image]) -> Result<(), Fault> {
        driver.perceive(self.rig(), images)?;
        let control = driver.step(&self.observation)?;
        self.supply(control);
        Ok(())
    }

    /// Simulates the run to its end with the given driver, and returns the outcome.
    pub fn drive(&mut self, driver: &mut dyn Driver) -> Outcome {
        self.watch(driver, |_| ())
    }

    /// Simulates the run to its end with a driver, and calls `see` at each question to the driver and at the end. No
    /// images are rendered, so a driver with cameras cannot drive.
    pub fn watch(&mut self, driver: &mut dyn Driver, see: impl FnMut(&Self)) -> Outcome {
        match self.seat(driver) {
            Ok(()) => self.finish(driver, see),
            Err(fault) => self.broken_by(fault),
        }
    }

    fn finish(&mut self, driver: &mut dyn Driver, mut see: impl FnMut(&Self)) -> Outcome {
        if let Some(camera) = self.eyes().cameras().all.keys().next() {
            let message = format!("the driver uses camera `{camera}`, but nothing renders images in this run");
            return self.broken_by(Fault::of(FaultKind::Equipment, message));
        }
        loop {
            let outcome = self.advance().outcome();
            see(self);
            if let Some(outcome) = outcome {
                return outcome;
            }
            if let Err(fault) = self.answer(driver, &[]) {
                return self.broken_by(fault);
            }
        }
    }

    /// Ends the run because of a fault of the driver, and returns the outcome.
    pub fn broken_by(&mut self, fault: Fault) -> Outcome {
        self.over = true;
        Outcome::broken(Breakdown::Driver { fault, time: self.time() })
    }
}

/// Simulates a test to its end with the given vehicle model and driver. An impossible world is an outcome, too.
pub fn simulate<'a>(
    program: &Program,
    test: impl Into<Test<'a>>,
    vehicle: impl Into<VehicleSetup>,
    driver: &mut dyn Driver,
) -> Outcome {
    watch(program, test, vehicle, driver, |_| ())
}

/// Simulates a test like [`simulate`], and calls `see` at each question to the driver and at the end.
pub fn watch<'a>(
    program: &Program,
    test: impl Into<Test<'a>>,
    vehicle: impl Into<VehicleSetup>,
    driver: &mut dyn Driver,
    see: impl FnMut(&Run),
) -> Outcome {
    match Run::seated(program, test, vehicle, driver) {
        Ok(mut run) => run.finish(driver, see),
        Err(outcome) => *outcome,
    }
}
