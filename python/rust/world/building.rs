//! The scenario that a function of Python builds, shared by all handles that the function gets.

use super::held::{self, Held, over};
use crate::error::raised;
use paracosm::engine;
use pyo3::prelude::*;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// The files that a scenario has read, with their hashes.
pub type Files = Arc<Mutex<BTreeMap<PathBuf, String>>>;

/// A scenario for as long as the function that builds it runs. Afterwards every handle of it is of no use, and says so.
#[derive(Clone)]
pub struct Building {
    scenario: Held<RefCell<Option<engine::Scenario>>>,
    files: Files,
}

impl Building {
    /// Takes the scenario of a program, calls a function that builds in it, and gives the scenario back. `files` gets the files that the scenario reads.
    pub fn lent<T>(scenario: &mut engine::Scenario, files: &Files, build: impl FnOnce(&Self) -> T) -> T {
        held::clear();
        let scenario_held = Held::new(RefCell::new(Some(std::mem::take(scenario))));
        let building = Self { scenario: scenario_held, files: Arc::clone(files) };
        let built = build(&building);
        if let Some(own) = building.scenario.get().ok().and_then(RefCell::take) {
            *scenario = own;
        }
        built
    }

    /// Does something in the scenario. A mistake that the scenario notes at once is raised, so that Python shows the line that made it.
    ///
    /// # Errors
    /// The scenario has noted a mistake, or the function that builds it has returned.
    pub fn with<T>(&self, act: impl FnOnce(&mut engine::Scenario) -> T) -> PyResult<T> {
        let mut lent = self.scenario.get()?.borrow_mut();
        let scenario = lent.as_mut().ok_or_else(over)?;
        let known = scenario.flaws().len();
        let made = act(scenario);
        match scenario.flaws().get(known) {
            Some(flaw) => Err(raised(flaw)),
            None => Ok(made),
        }
    }

    /// Notes that the scenario has read a file with this hash.
    pub fn reads(&self, (file, hash): (PathBuf, String)) {
        self.files.lock().unwrap_or_else(PoisonError::into_inner).insert(file, hash);
    }

    /// Refuses the test. That is no mistake of the program, so nothing is raised.
    ///
    /// # Errors
    /// The function that builds the scenario has returned.
    pub fn refuse(&self, why: &str) -> PyResult<()> {
        self.scenario.get()?.borrow_mut().as_mut().ok_or_else(over)?.refuse(why);
        Ok(())
    }

    /// Checks that the scenario is still being built.
    ///
    /// # Errors
    /// The function that builds it has returned.
    pub fn check(&self) -> PyResult<()> {
        if self.scenario.get()?.borrow().is_some() { Ok(()) } else { Err(over()) }
    }
}
