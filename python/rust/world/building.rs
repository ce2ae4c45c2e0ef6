//! The scenario that a function of Python builds, shared by all handles that the function gets.

use crate::error::raised;
use paracosm::engine;
use pyo3::prelude::*;
use std::cell::RefCell;
use std::rc::Rc;

/// A scenario for as long as the function that builds it runs. Afterwards every handle of it is of no use, and says so.
#[derive(Clone)]
pub struct Building(Rc<RefCell<Option<engine::Scenario>>>);

impl Building {
    /// Takes the scenario of a program, calls a function that builds in it, and gives the scenario back.
    pub fn lent<T>(scenario: &mut engine::Scenario, build: impl FnOnce(&Self) -> T) -> T {
        let building = Self(Rc::new(RefCell::new(Some(std::mem::take(scenario)))));
        let built = build(&building);
        if let Some(own) = building.0.take() {
            *scenario = own;
        }
        built
    }

    /// Does something in the scenario. A mistake that the scenario notes at once is raised, so that Python shows the line that made it.
    ///
    /// # Errors
    /// The scenario has noted a mistake, or the function that builds it has returned.
    pub fn with<T>(&self, act: impl FnOnce(&mut engine::Scenario) -> T) -> PyResult<T> {
        let mut lent = self.0.borrow_mut();
        let scenario = lent.as_mut().ok_or_else(over)?;
        let known = scenario.flaws().len();
        let made = act(scenario);
        match scenario.flaws().get(known) {
            Some(flaw) => Err(raised(flaw)),
            None => Ok(made),
        }
    }

    /// Refuses the test. That is no mistake of the program, so nothing is raised.
    ///
    /// # Errors
    /// The function that builds the scenario has returned.
    pub fn refuse(&self, why: &str) -> PyResult<()> {
        self.0.borrow_mut().as_mut().ok_or_else(over)?.refuse(why);
        Ok(())
    }

    /// Checks that the scenario is still being built.
    ///
    /// # Errors
    /// The function that builds it has returned.
    pub fn check(&self) -> PyResult<()> {
        if self.0.borrow().is_some() { Ok(()) } else { Err(over()) }
    }
}

fn over() -> PyErr {
    raised(
        "this object belongs to the world of an earlier test: make all objects and streams inside the function of the scenario, and keep none",
    )
}
