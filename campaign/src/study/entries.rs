//! Checks a study that was read from a file, entry by entry: anybody may have changed the file.

use super::{SamplingFlaw, Simulation, StatedRequirement, Study, Subject};
use crate::Reason;
use crate::black_box::{TimeoutFlaw, checked_timeout};
use paracosm_space::{ParameterError, WordFlaw, word_flaw};
use std::collections::HashSet;
use std::fmt::Display;
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
    /// A fixed value does not fit its parameter.
    #[error("`fixed`: {0}")]
    Fixed(ParameterError),
    /// The budget or the batch is 0.
    #[error(transparent)]
    Sampling(#[from] SamplingFlaw),
    /// The time-out of an external system is out of range.
    #[error(transparent)]
    Timeout(#[from] TimeoutFlaw),
}

impl Reason for EntryFlaw {}

/// Checks that a number is in the range that `expected` describes.
fn range(entry: &str, found: impl Display, is_right: bool, expected: &str) -> Result<(), EntryFlaw> {
    let flaw = || EntryFlaw::Range { entry: entry.to_owned(), found: found.to_string(), expected: expected.to_owned() };
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
            Subject::Scenario(simulation) => simulation.check_times()?,
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

    /// Checks that a study which this version of the software wrote agrees with the program of its scenario. A study of
    /// another version may differ, and a study without a program can be analysed but not run.
    pub(crate) fn check_program(&self) -> Result<(), EntryFlaw> {
        let Subject::Scenario(simulation) = &self.subject else { return Ok(()) };
        // If the scenario cannot be declared, the first test reports the reason.
        let declared = simulation.program().ok().and_then(|program| program.declare().ok());
        let Some(declared) = declared.filter(|_| self.is_of_this_software()) else { return Ok(()) };
        let same = |entry: &str, found: String, expected: String| {
            if found == expected {
                return Ok(());
            }
            let scenario = simulation.scenario.clone();
            Err(EntryFlaw::Other { entry: entry.to_owned(), found, expected, scenario })
        };
        let seconds = |seconds: f64| format!("{seconds} s");
        same("dt", seconds(simulation.dt), seconds(declared.dt))?;
        same("duration", seconds(simulation.duration), seconds(declared.duration))?;
        for own in declared.requirements.into_iter().map(StatedRequirement::from) {
            let missing = || EntryFlaw::Missing { id: own.id.clone(), scenario: simulation.scenario.clone() };
            let stated = self.requirement(&own.id).ok_or_else(missing)?;
            let formula = |of: &StatedRequirement| of.formula.as_ref().map(ToString::to_string).unwrap_or_default();
            let scale = |of: &StatedRequirement| of.scale.map(|scale| scale.to_string()).unwrap_or_default();
            let name = |entry: &str| format!("{entry} of requirement {}", own.id);
            same(&name("formula"), formula(stated), formula(&own))?;
            same(&name("scale"), scale(stated), scale(&own))?;
            same(&name("unit"), stated.unit.clone(), own.unit.clone())?;
        }
        let closed = |name: &str| declared.parameters.iter().find(|declared| declared.parameter.name == name);
        let check = |(name, value)| closed(name).map_or(Ok(()), |declared| declared.parameter.check(value));
        simulation.fixed.iter().try_for_each(check).map_err(EntryFlaw::Fixed)
    }
}

impl Simulation {
    fn check_times(&self) -> Result<(), EntryFlaw> {
        let Self { dt, duration, .. } = *self;
        range("dt", dt, is_positive(dt), "a number of seconds above 0")?;
        range("duration", duration, is_positive(duration), "a number of seconds above 0")?;
        let ticks = duration / dt;
        range("duration", duration, (0.5..=MOST_TICKS).contains(&ticks), &format!("1 to {MOST_TICKS} ticks of {dt} s"))
    }
}
