//! Checks a study that was read from a file, entry by entry: anybody may have changed the file.

use super::{
    DriverFlaw, FormulaFlaw, PerceiverChoice, PerceiverFlaw, SamplingFlaw, Simulation, StatedRequirement, Study,
    Subject,
};
use crate::black_box::{TimeoutFlaw, checked_timeout};
use crate::{Error, Reason};
use paracosm_engine::vehicle::VehicleSettingFlaw;
use paracosm_space::{WordFlaw, word_flaw};
use std::collections::HashSet;
use std::fmt::Debug;
use thiserror::Error;

/// The greatest number of ticks of a test. With more ticks a single trace takes gigabytes.
const MOST_TICKS: f64 = 1e7;

/// The reason why an entry of a study cannot be right.
#[derive(Debug, Error)]
pub enum EntryFlaw {
    /// The study has neither a scenario nor a system.
    #[error("expected the entry `scenario` or the entry `system`")]
    NoSubject,
    /// A study of a scenario lacks an entry, or a study of a system.
    #[error("the entry `{entry}` is missing, which a study with `{of}` has")]
    Lacks {
        /// The name of the missing entry.
        entry: &'static str,
        /// The entry that names the subject: `scenario` or `system`.
        of: &'static str,
    },
    /// A study of a system has an entry for scenarios, or the other way round.
    #[error("found the entry `{entry}` beside `{of}`, expected one of them")]
    Surplus {
        /// The name of the entry that does not belong there.
        entry: &'static str,
        /// The entry that names the subject: `scenario` or `system`.
        of: &'static str,
    },
    /// The entry has a value out of its range.
    #[error("`{entry}` is {found}, expected {expected}")]
    Range {
        /// The name of the entry, with the names of the entries around it.
        entry: String,
        /// The value in the file.
        found: String,
        /// The range of values.
        expected: String,
    },
    /// The entry has another value than the scenario, and this version of the software wrote the file.
    #[error("`{entry}` is {found}, expected {expected} as in the scenario `{scenario}`")]
    Other {
        /// The name of the entry, with the names of the entries around it.
        entry: String,
        /// The value in the file.
        found: String,
        /// The value of the scenario.
        expected: String,
        /// The name of the scenario.
        scenario: String,
    },
    /// The scenario has a requirement that the file does not state, and this version of the software wrote the file.
    #[error("the requirement `{id}` of the scenario `{scenario}` is missing")]
    Missing {
        /// The id of the requirement.
        id: String,
        /// The name of the scenario.
        scenario: String,
    },
    /// Two requirements have the same id.
    #[error("two requirements have the id `{id}`")]
    Twice {
        /// The id of both requirements.
        id: String,
    },
    /// The id of a requirement cannot be a name.
    #[error("the id of requirement {place} {flaw}")]
    Id {
        /// The place of the requirement in the list, from 1.
        place: usize,
        /// The error in the id.
        flaw: WordFlaw,
    },
    /// A fixed value or an open parameter does not fit the scenario.
    #[error("`{entry}`: {flaw}")]
    Parameter {
        /// The entry: `fixed` or `space`.
        entry: &'static str,
        /// The reason.
        flaw: Box<Error>,
    },
    /// A parameter of the scenario is neither fixed nor open.
    #[error("the parameter `{name}` of the scenario `{scenario}` is missing: `fixed` or `space` should have it")]
    NoParameter {
        /// The name of the parameter.
        name: String,
        /// The name of the scenario.
        scenario: String,
    },
    /// A setting does not fit the driver.
    #[error("`driver`: {0}")]
    Driver(DriverFlaw),
    /// The perceiver cannot be on trial.
    #[error(transparent)]
    Perceiver(PerceiverFlaw),
    /// A formula that a user has added cannot judge a trace of the scenario.
    #[error("the formula of requirement {id}: {flaw}")]
    Formula {
        /// The id of the requirement.
        id: String,
        /// The reason.
        flaw: Box<FormulaFlaw>,
    },
    /// The study does not agree with the program of its scenario.
    #[error("{0} (the file or the scenario was changed after the campaign)")]
    Changed(Box<EntryFlaw>),
    /// A resistance of the vehicle is out of range.
    #[error("`resistance`: {0}")]
    Resistance(#[from] VehicleSettingFlaw),
    /// The budget or the batch is 0.
    #[error(transparent)]
    Sampling(#[from] SamplingFlaw),
    /// The time-out of an external system is out of range.
    #[error(transparent)]
    Timeout(#[from] TimeoutFlaw),
}

impl Reason for EntryFlaw {}

/// Checks that a number is in the range that `expected` describes.
fn range(entry: &str, found: impl Debug, is_right: bool, expected: &str) -> Result<(), EntryFlaw> {
    let flaw =
        || EntryFlaw::Range { entry: entry.to_owned(), found: format!("{found:?}"), expected: expected.to_owned() };
    if is_right { Ok(()) } else { Err(flaw()) }
}

fn is_positive(number: f64) -> bool {
    number > 0.0 && number.is_finite()
}

/// Checks a scale of a requirement.
pub(crate) fn check_scale(entry: &str, scale: f64) -> Result<(), EntryFlaw> {
    range(entry, scale, is_positive(scale), "a number above 0")
}

impl Study {
    /// Checks the entries of a study that was read from a file, without its program.
    pub(crate) fn check_entries(&self) -> Result<(), EntryFlaw> {
        match &self.subject {
            Subject::Scenario(simulation) => {
                simulation.check_numbers()?;
                simulation.perceiver.iter().try_for_each(PerceiverChoice::check).map_err(EntryFlaw::Perceiver)?;
            }
            Subject::System(system) => drop(checked_timeout(Some(system.timeout))?),
        }
        let sampling = &self.sampling;
        sampling.check()?;
        let parameters = self.space.levels().len() + self.space.dims();
        let most = format!("a number from 1 to {parameters}, the number of parameters");
        sampling.k.map_or(Ok(()), |k| range("k", k, (1..=parameters).contains(&k), &most))?;
        let epsilon = |volume: f64| range("epsilon", volume, volume > 0.0 && volume < 1.0, "above 0 and below 1");
        sampling.epsilon.map_or(Ok(()), epsilon)?;
        let mut ids = HashSet::new();
        for (i, StatedRequirement { id, scale, .. }) in self.requirements.iter().enumerate() {
            word_flaw(id).map_or(Ok(()), |flaw| Err(EntryFlaw::Id { place: i + 1, flaw }))?;
            if !ids.insert(id) {
                return Err(EntryFlaw::Twice { id: id.clone() });
            }
            scale.map_or(Ok(()), |scale| check_scale(&format!("scale of {id}"), scale))?;
        }
        Ok(())
    }
}

impl Simulation {
    fn check_numbers(&self) -> Result<(), EntryFlaw> {
        self.vehicle.resistance.check()?;
        let Self { dt, duration, .. } = *self;
        range("dt", dt, is_positive(dt), "a number of seconds above 0")?;
        range("duration", duration, is_positive(duration), "a number of seconds above 0")?;
        let ticks = duration / dt;
        range("duration", duration, (0.5..=MOST_TICKS).contains(&ticks), &format!("1 to {MOST_TICKS} ticks of {dt} s"))
    }
}
