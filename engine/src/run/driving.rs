//! A run with a driver at the wheel.
//!
//! What a driver does with a run is two things: it [takes its seat](Run::seat), and it [answers](Run::answer) whenever the
//! run needs it. Where its cameras have taken something, that has to be drawn in between, which is not the engine's to do:
//! whoever draws goes from question to question. All others have [`simulate`] and [`watch`].

use super::{Run, Setup};
use crate::driver::{Driver, Fault, FaultKind};
use crate::outcome::{Breakdown, Invalid, Outcome};
use crate::program::{Program, ProgramError};
use crate::scenario::ticks;
use crate::sensor::{Image, Shutters};
use crate::test::Test;
use crate::vehicle::VehicleModel;

impl Run {
    /// The run of a test, in a car that this model moves, for this driver, which takes its seat.
    ///
    /// # Errors
    /// The world cannot be built, or the driver cannot drive such a car: what becomes of the test.
    pub fn seated<'a>(
        program: &Program,
        test: impl Into<Test<'a>>,
        model: VehicleModel,
        driver: &mut dyn Driver,
    ) -> Result<Self, Box<Outcome>> {
        let mut run = match Self::new(program, test, Setup { model, ..Setup::asking_every(driver.period()) }) {
            Ok(run) => run,
            Err(error @ ProgramError::World { .. }) => return Err(Box::new(Outcome::broken(Invalid::World(error)))),
            Err(error) => return Err(Box::new(Outcome::broken(Breakdown::Program(error)))),
        };
        match run.seat(driver) {
            Ok(()) => Ok(run),
            Err(fault) => Err(Box::new(run.broken_by(fault))),
        }
    }

    /// Gives the car what the driver measures with, lets its answers be as late as it says, and tells the driver that a new run begins. A rig that the run was given
    /// stays where the driver brings none.
    ///
    /// # Errors
    /// The driver cannot drive such a car, or has a camera that cannot be.
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

    /// Lets the driver answer what [`Run::advance`] needed. The images are those of all moments that have arrived from its
    /// [`eyes`](Run::eyes), in their order; from where there was nothing to see, there is none.
    ///
    /// # Errors
    /// The driver cannot go on.
    pub fn answer(&mut self, driver: &mut dyn Driver, images: &[Image]) -> Result<(), Fault> {
        driver.perceive(self.rig(), images)?;
        let control = driver.step(&self.observation)?;
        self.supply(control);
        Ok(())
    }

    /// Goes to the end with this driver, which is told that a new run begins.
    pub fn drive(&mut self, driver: &mut dyn Driver) -> Outcome {
        self.watch(driver, |_| ())
    }

    /// Goes to the end with this driver, and lets `see` have a look whenever the driver is asked, and at the end. Nothing is
    /// drawn, so that a driver with cameras cannot drive.
    pub fn watch(&mut self, driver: &mut dyn Driver, see: impl FnMut(&Self)) -> Outcome {
        match self.seat(driver) {
            Ok(()) => self.finish(driver, see),
            Err(fault) => self.broken_by(fault),
        }
    }

    fn finish(&mut self, driver: &mut dyn Driver, mut see: impl FnMut(&Self)) -> Outcome {
        if let Some(camera) = self.eyes().cameras().all.keys().next() {
            let message = format!("it sees through camera `{camera}`, and nothing draws here what cameras see");
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

    /// Ends the run because its driver cannot go on.
    pub fn broken_by(&mut self, fault: Fault) -> Outcome {
        self.over = true;
        Outcome::broken(Breakdown::Driver { fault, time: self.time() })
    }
}

/// Runs a test to its end with a driver, in a car that this model moves; a world that cannot be built is an outcome too.
pub fn simulate<'a>(
    program: &Program,
    test: impl Into<Test<'a>>,
    model: VehicleModel,
    driver: &mut dyn Driver,
) -> Outcome {
    watch(program, test, model, driver, |_| ())
}

/// [`simulate`], with a look at the run whenever the driver is asked, and at the end: [`Run::watch`].
pub fn watch<'a>(
    program: &Program,
    test: impl Into<Test<'a>>,
    model: VehicleModel,
    driver: &mut dyn Driver,
    see: impl FnMut(&Run),
) -> Outcome {
    match Run::seated(program, test, model, driver) {
        Ok(mut run) => run.finish(driver, see),
        Err(outcome) => *outcome,
    }
}
