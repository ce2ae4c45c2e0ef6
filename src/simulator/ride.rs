//! One test under way: a run and its driver, on their way from image to image.

use crate::Error;
use paracosm_engine::driver::Driver;
use paracosm_engine::sensor::{Image, Shutters};
use paracosm_engine::vehicle::Model;
use paracosm_engine::{Outcome, Program, Run, Test};
use paracosm_oracles::{Formula, Verdict};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A test under way. A panic of the run or of its driver ends this one alone.
pub(super) struct Ride {
    /// Which of the tests it is.
    place: usize,
    driver: Option<Box<dyn Driver>>,
    run: Option<Run>,
    /// What the driver is to be shown before it answers.
    images: Vec<Image>,
    /// Whether the run waits for the driver.
    asked: bool,
    outcome: Option<Outcome>,
}

impl Ride {
    /// Lets a driver take its seat in the run of a test; without a driver, the test is over.
    pub fn begin(
        place: usize,
        program: &Program,
        test: Test<'_>,
        model: Model,
        driver: Result<Box<dyn Driver>, Error>,
    ) -> Self {
        let mut ride = Self { place, driver: None, run: None, images: Vec::new(), asked: false, outcome: None };
        match driver {
            Ok(driver) => {
                let driver = ride.driver.insert(driver).as_mut();
                let seated = || Run::seated(program, test, model, driver);
                match catch_unwind(AssertUnwindSafe(seated)) {
                    Ok(Ok(run)) => ride.run = Some(run),
                    Ok(Err(outcome)) => ride.outcome = Some(*outcome),
                    Err(panic) => ride.outcome = Some(panicked(panic.as_ref())),
                }
            }
            Err(error) => ride.outcome = Some(broken(error.to_string())),
        }
        ride
    }

    /// Lets it end as soon as its requirements and these formulas are decided.
    pub fn end_when_decided(&mut self, formulas: &[Formula]) {
        if let Some(run) = &mut self.run {
            run.end_when_decided(formulas);
        }
    }

    /// Films it.
    pub fn film(&mut self, cameras: Shutters) {
        if let Some(run) = &mut self.run {
            run.film(cameras);
        }
    }

    /// Goes on until the driver waits for images or the test is over. `see` has a look whenever the driver is asked, and at
    /// the end.
    pub fn go_on(&mut self, see: impl FnMut(&Run)) {
        if self.outcome.is_none() {
            let went = catch_unwind(AssertUnwindSafe(|| self.until_images(see)));
            self.outcome = went.unwrap_or_else(|panic| Some(panicked(panic.as_ref())));
        }
    }

    fn until_images(&mut self, mut see: impl FnMut(&Run)) -> Option<Outcome> {
        let (run, driver) = (self.run.as_mut()?, self.driver.as_mut()?);
        loop {
            if self.asked {
                if let Err(fault) = run.answer(driver.as_mut(), &self.images) {
                    return Some(run.broken_by(&fault));
                }
                self.images.clear();
            }
            let outcome = run.advance().outcome();
            self.asked = true;
            see(run);
            if outcome.is_some() || run.eyes().arrived().next().is_some() {
                return outcome;
            }
        }
    }

    /// The run, if it goes on.
    pub fn run(&self) -> Option<&Run> {
        self.run.as_ref().filter(|_| self.outcome.is_none())
    }

    /// Whether it has come to its end.
    pub fn is_over(&self) -> bool {
        self.outcome.is_some()
    }

    /// Gives the driver what it waits for, or says why there is nothing.
    pub fn show(&mut self, images: Result<Vec<Image>, String>) {
        match images {
            Ok(images) => self.images = images,
            Err(message) => {
                let time = self.run.as_ref().map_or(0.0, Run::time);
                self.outcome = Some(broken(format!("the driver could not see at {time:.3} s: {message}")));
            }
        }
    }

    /// What became of the test with its place, and the driver, unless that may be in any state.
    pub fn end(self) -> ((usize, Outcome), Option<Box<dyn Driver>>) {
        let outcome = self.outcome.unwrap_or_else(|| broken("the test was left before its end".to_owned()));
        let driver = self.driver.filter(|_| outcome.verdict != Verdict::Error);
        ((self.place, outcome), driver)
    }
}

fn panicked(panic: &(dyn Any + Send)) -> Outcome {
    let message = panic.downcast_ref::<String>().map(String::as_str);
    let message = message.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
    broken(format!("the run panicked: {message}"))
}

fn broken(message: String) -> Outcome {
    Outcome::broken(Verdict::Error, message)
}
