//! A test that is being run: a run and its driver, as they go from image to image.

use crate::darkroom::{NoImage, Set};
use crate::drivers::NoDriver;
use crate::{Problem, ProblemKind};
use paracosm_engine::driver::Driver;
use paracosm_engine::sensor::Image;
use paracosm_engine::vehicle::VehicleSetup;
use paracosm_engine::{Outcome, Program, Run, Test};
use paracosm_oracles::Verdict;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The index and the result of a test that is over.
pub type TestEnd = (usize, Result<Outcome, Problem>);

/// A test that is being run. A panic of the run or of its driver ends this test alone.
pub(super) struct Ride {
    /// The index of the test.
    place: usize,
    driver: Option<Box<dyn Driver>>,
    run: Option<Run>,
    /// The set of the images of the driver; `None` if the driver has no cameras.
    set: Option<Result<Set, NoImage>>,
    /// The images that the driver is to be shown before it answers.
    images: Vec<Image>,
    /// True if the run waits for the driver.
    asked: bool,
    /// Ends the test at the next question to the driver: a test may take minutes.
    stop: Arc<AtomicBool>,
    outcome: Option<Result<Outcome, Problem>>,
}

impl Ride {
    /// Begins the run of a test with a driver. Without a driver, the test is over.
    pub fn begin(
        place: usize,
        (program, test, vehicle): (&Program, Test<'_>, VehicleSetup),
        driver: Result<Box<dyn Driver>, NoDriver>,
        stop: Arc<AtomicBool>,
    ) -> Self {
        let mut ride =
            Self { place, driver: None, run: None, set: None, images: Vec::new(), asked: false, stop, outcome: None };
        match driver {
            Ok(driver) => {
                let driver = ride.driver.insert(driver).as_mut();
                let seated = || Run::seated(program, test, vehicle, driver);
                match catch_unwind(AssertUnwindSafe(seated)) {
                    Ok(Ok(run)) => ride.run = Some(run),
                    Ok(Err(outcome)) => ride.outcome = Some(Ok(*outcome)),
                    Err(panic) => ride.outcome = Some(Err(Problem::panicked("run", panic.as_ref()))),
                }
            }
            Err(error) => ride.outcome = Some(Err(error.into())),
        }
        ride
    }

    /// Furnishes the set of the images if the driver has cameras.
    pub fn furnish(&mut self, set: impl FnOnce(&Run) -> Result<Set, NoImage>) {
        let Some(run) = self.run.as_ref().filter(|run| !run.eyes().cameras().all.is_empty()) else { return };
        match catch_unwind(AssertUnwindSafe(|| set(run))) {
            Ok(set) => self.set = Some(set),
            Err(panic) => self.outcome = Some(Err(Problem::panicked("run", panic.as_ref()))),
        }
    }

    /// Prepares the run before it begins.
    pub fn prepare(&mut self, prepare: impl FnOnce(&mut Run)) {
        if let Some(run) = &mut self.run {
            prepare(run);
        }
    }

    /// Continues the run until the driver waits for images or the test is over. `see` gets the run whenever the driver
    /// is asked, and at the end.
    pub fn go_on(&mut self, see: impl FnMut(&Run)) {
        if self.outcome.is_none() {
            let went = catch_unwind(AssertUnwindSafe(|| self.until_images(see)));
            self.outcome = match went {
                Ok(outcome) => outcome,
                Err(panic) => Some(Err(Problem::panicked("run", panic.as_ref()))),
            };
        }
    }

    fn until_images(&mut self, mut see: impl FnMut(&Run)) -> Option<Result<Outcome, Problem>> {
        let (run, driver) = (self.run.as_mut()?, self.driver.as_mut()?);
        loop {
            if self.stop.load(Ordering::Relaxed) {
                return Some(Err(Problem::new(ProblemKind::Interrupted, "interrupted")));
            }
            if self.asked {
                if let Err(fault) = run.answer(driver.as_mut(), &self.images) {
                    return Some(Ok(run.broken_by(fault)));
                }
                self.images.clear();
            }
            let outcome = run.advance().outcome();
            self.asked = true;
            see(run);
            if outcome.is_some() || run.eyes().arrived().next().is_some() {
                return outcome.map(Ok);
            }
        }
    }

    /// Returns the run of the test with the set of its images; `None` if the test is over, or there is no set.
    pub fn seen(&self) -> Option<(&Run, &Set)> {
        self.run.as_ref().filter(|_| self.outcome.is_none()).zip(self.set.as_ref()?.as_ref().ok())
    }

    /// Ends a test without a set. It is called when the driver waits for images.
    pub fn miss(&mut self) {
        if let Some(Err(error)) = self.set.as_ref().filter(|_| self.outcome.is_none()) {
            let error = error.clone();
            self.show(Err(error));
        }
    }

    /// Returns `true` if the test is over.
    pub fn is_over(&self) -> bool {
        self.outcome.is_some()
    }

    /// Gives the driver the images for which it waits, or ends the test with the reason why the images are missing.
    pub fn show(&mut self, images: Result<Vec<Image>, NoImage>) {
        match images {
            Ok(images) => self.images = images,
            Err(error) => {
                let time = self.run.as_ref().map_or(0.0, Run::time);
                let message = format!("the driver got no images at {time:.3} s: {error}");
                self.outcome = Some(Err(Problem::new(ProblemKind::Camera, message)));
            }
        }
    }

    /// Returns the index and the result of the test. Also returns the driver, unless the test broke and left it in an
    /// unknown state.
    pub fn end(self) -> (TestEnd, Option<Box<dyn Driver>>) {
        let left = || Err(Problem::new(ProblemKind::Interrupted, "the test was abandoned before its end"));
        let outcome = self.outcome.unwrap_or_else(left);
        let driver = self.driver.filter(|_| error_of(&outcome).is_none());
        ((self.place, outcome), driver)
    }
}

/// Returns the error of a test without a usable result; `None` if the test has a result.
pub(super) fn error_of(outcome: &Result<Outcome, Problem>) -> Option<String> {
    match outcome {
        Err(problem) => Some(problem.message.clone()),
        Ok(outcome) if outcome.verdict() == Verdict::Error => Some(outcome.ending.message().unwrap_or_default()),
        Ok(_) => None,
    }
}
