//! Runs the tests of a scenario: one by one, or many in lockstep where drivers see.
//!
//! Tests in lockstep go on to where their drivers wait for images, and what all their cameras have taken is drawn in one go.
//! A test that is over makes room for the next one, so that there is always as much to draw as can be. None has anything to
//! do with another, so that how many there are changes nothing but the speed.

mod ride;
#[cfg(all(test, feature = "camera"))]
mod tests;

use crate::Error;
use crate::darkroom::Darkroom;
use crate::drivers::Drivers;
use crate::executor::Desk;
use crate::study::{Appearances, Simulation};
use paracosm_coverage::{Space, Values};
use paracosm_engine::sensor::{Cameras, Shutters};
use paracosm_engine::vehicle::Model;
use paracosm_engine::{Outcome, Program, Run, Test};
use paracosm_oracles::Formula;
use ride::Ride;
use std::slice;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A scenario, its drivers, and what draws for them.
pub(crate) struct Simulator<'a> {
    program: Program,
    model: Model,
    drivers: Drivers<'a>,
    appearances: Appearances,
    /// What has to be decided beside a run's own requirements for it to end early, if it may.
    early: Option<Vec<Formula>>,
    darkroom: Option<Arc<Darkroom>>,
}

impl<'a> Simulator<'a> {
    /// A simulator of a scenario, whose drivers see what others draw for them, if anything, and are not waited for any more
    /// once `stop` is set.
    ///
    /// # Errors
    /// The scenario or the driver does not exist.
    pub fn new(
        simulation: &'a Simulation,
        stop: Arc<AtomicBool>,
        darkroom: Option<Arc<Darkroom>>,
    ) -> Result<Self, Error> {
        let drivers = Drivers::new(&simulation.driver, stop)?;
        let simulator = Self::with(simulation.program()?, simulation.vehicle, drivers, darkroom);
        Ok(Self { appearances: simulation.appearances.clone(), ..simulator })
    }

    /// A simulator of a program, in which these drivers drive a car that this model moves.
    fn with(program: Program, model: Model, drivers: Drivers<'a>, darkroom: Option<Arc<Darkroom>>) -> Self {
        Self { program, model, drivers, appearances: Appearances::default(), early: None, darkroom }
    }

    /// Ends runs as soon as their requirements and these formulas are decided.
    pub fn end_when_decided(&mut self, formulas: Vec<Formula>) {
        self.early = Some(formulas);
    }

    /// A test under way.
    fn begin(&mut self, place: usize, test: Test<'_>) -> Ride {
        let driver = self.drivers.hire();
        let mut ride = Ride::begin(place, &self.program, test, self.model, driver);
        if let Some(formulas) = &self.early {
            ride.end_when_decided(formulas);
        }
        ride
    }

    /// Has a driver at hand, and what draws for it.
    ///
    /// # Errors
    /// There is no driver to be had, or it sees through cameras and there is nothing to draw with.
    pub fn start(&mut self) -> Result<(), Error> {
        let cameras = self.eyes()?;
        if cameras.all.is_empty() { Ok(()) } else { self.open(&cameras).map(drop) }
    }

    /// The cameras that its drivers see through, if any.
    ///
    /// # Errors
    /// There is no driver to be had.
    pub fn eyes(&mut self) -> Result<Cameras, Error> {
        let mut driver = self.drivers.hire()?;
        let cameras = driver.equipment().cameras;
        self.drivers.dismiss(Some(driver));
        Ok(cameras)
    }

    /// What draws for its drivers, if they see.
    pub fn darkroom(&self) -> Option<&Arc<Darkroom>> {
        self.darkroom.as_ref()
    }

    /// Runs a test.
    pub fn run(&mut self, test: Test<'_>) -> Outcome {
        let has_past = self.drivers.any_idle();
        let outcome = self.ride(test, None, |_| ());
        if has_past && self.drivers.doubts(&outcome) { self.watch(test, None, |_| ()) } else { outcome }
    }

    /// Runs a test, which is filmed with these cameras, with a look at the run whenever the driver is asked, and at the end.
    pub fn watch(&mut self, test: Test<'_>, film: Option<Shutters>, see: impl FnMut(&Run)) -> Outcome {
        // A test that has to be run again would be seen twice.
        self.drivers.renew();
        self.ride(test, film, see)
    }

    fn ride(&mut self, test: Test<'_>, film: Option<Shutters>, mut see: impl FnMut(&Run)) -> Outcome {
        let mut ride = self.begin(0, test);
        if let Some(film) = film {
            ride.film(film);
        }
        loop {
            ride.go_on(&mut see);
            if ride.is_over() {
                return self.dismiss(ride).1;
            }
            self.draw(slice::from_mut(&mut ride));
        }
    }

    /// Runs the tests that the desk gives out, at most so many at a time, until `stopped`. What a test is, by its index,
    /// `tests` says, and `judged` what comes of it.
    pub fn run_in_lockstep<T>(
        &mut self,
        desk: &Desk<T>,
        at_once: usize,
        (tests, space): (&dyn Fn(usize) -> Values, &Space),
        stopped: impl Fn() -> bool,
        judged: impl Fn(usize, Outcome) -> T,
    ) {
        let mut rides: Vec<Ride> = Vec::new();
        loop {
            while rides.len() < at_once.max(1)
                && let Some(index) = desk.next()
            {
                rides.push(self.begin(index, Test::new(&tests(index), space)));
            }
            rides.iter_mut().for_each(|ride| ride.go_on(|_| ()));
            // What broke because it was stopped came to nothing.
            if rides.is_empty() || desk.is_closed() || stopped() {
                return;
            }
            for over in rides.extract_if(.., |ride| ride.is_over()) {
                let (index, mut outcome) = self.dismiss(over);
                if self.drivers.doubts(&outcome) {
                    outcome = self.watch(Test::new(&tests(index), space), None, |_| ());
                }
                if stopped() {
                    return;
                }
                desk.hand_in(index, Some(judged(index, outcome)));
            }
            self.draw(&mut rides);
        }
    }

    /// What became of a test, with its place; its driver has nothing to do any more.
    fn dismiss(&mut self, ride: Ride) -> (usize, Outcome) {
        let (ended, driver) = ride.end();
        self.drivers.dismiss(driver);
        ended
    }

    /// Draws what the drivers of these wait for.
    fn draw(&mut self, rides: &mut [Ride]) {
        let runs: Vec<&Run> = rides.iter().filter_map(Ride::run).collect();
        let Some(first) = runs.first() else { return };
        let images = match self.open(first.eyes().cameras()) {
            Ok(darkroom) => darkroom.develop(&runs),
            Err(error) => runs.iter().map(|_| Err(error.to_string())).collect(),
        };
        let waiting = rides.iter_mut().filter(|ride| !ride.is_over());
        waiting.zip(images).for_each(|(ride, images)| ride.show(images));
    }

    /// What draws for its drivers.
    fn open(&mut self, cameras: &Cameras) -> Result<&Darkroom, Error> {
        match &mut self.darkroom {
            Some(darkroom) => Ok(darkroom),
            none => Ok(none.insert(Arc::new(Darkroom::open(cameras, &self.appearances)?))),
        }
    }
}
