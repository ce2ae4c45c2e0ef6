//! What the tests of a study are run on: a scenario of ours with a driver, or a system that others wrote.

use super::{Appearances, DriverChoice, StatedRequirement};
use crate::{BlackBox, Catalogue, Error, Reason};
use paracosm_engine::vehicle::VehicleModel;
use paracosm_engine::{Declaration, Program};
use paracosm_space::{Space, Values};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use thiserror::Error;

/// What tests are run on.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "missing field: expected `scenario` with `vehicle`, `fixed`, `driver`, `dt` and `duration`, or `system` \
                 with `timeout`"
)]
pub enum Subject {
    /// A simulated world with the system under test in it.
    Scenario(Box<Simulation>),
    /// A process.
    System(BlackBox),
}

/// A scenario with a driver.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Simulation {
    pub(super) scenario: String,
    pub(super) vehicle: VehicleModel,
    pub(super) fixed: Values,
    pub(super) driver: DriverChoice,
    #[serde(rename = "models", skip_serializing_if = "Appearances::is_empty", default)]
    pub(super) appearances: Appearances,
    /// Whether runs ended as soon as all requirements were decided, as they could in older versions.
    #[serde(skip_serializing_if = "std::ops::Not::not", default)]
    pub(super) stop_runs_early: bool,
    dt: f64,
    duration: f64,
    #[serde(skip)]
    program: Source,
}

/// Where the program of a study comes from.
#[derive(Debug, Clone, Default)]
enum Source {
    Here(Program),
    /// No catalogue has it.
    Missing(Arc<Error>),
    /// Nobody has looked for it yet.
    #[default]
    Unknown,
}

/// A scenario that a study names and that cannot be had.
#[derive(Debug, Error)]
#[error("the campaign was run on the scenario `{scenario}`, which cannot be had here{}", why(.source))]
pub struct MissingScenario {
    /// Its name.
    pub scenario: String,
    /// Why, if anybody has looked for it.
    pub source: Option<Arc<Error>>,
}

/// A system in a place where only a scenario will do.
#[derive(Debug, Error)]
#[error("the system `{command}` is no scenario, but that is what is asked of it here")]
pub struct NoScenario {
    /// The command of the system.
    pub command: String,
}

impl Reason for MissingScenario {}
impl Reason for NoScenario {}

fn why(source: &Option<Arc<Error>>) -> String {
    source.as_ref().map(|source| format!(": {source}")).unwrap_or_default()
}

/// A system has no fixed parameters.
static NOTHING_FIXED: Values = Values::EMPTY;

impl Subject {
    /// The scenario.
    ///
    /// # Errors
    /// It is a system that others wrote.
    pub fn scenario(&self) -> Result<&Simulation, NoScenario> {
        match self {
            Self::Scenario(simulation) => Ok(simulation),
            Self::System(system) => Err(NoScenario { command: system.command.clone() }),
        }
    }

    pub(super) fn scenario_mut(&mut self) -> Result<&mut Simulation, NoScenario> {
        match self {
            Self::Scenario(simulation) => Ok(simulation),
            Self::System(system) => Err(NoScenario { command: system.command.clone() }),
        }
    }

    /// What is tested, in a few words.
    pub fn title(&self) -> String {
        match self {
            Self::Scenario(simulation) => format!("{}, driver {}", simulation.scenario, simulation.driver.name()),
            Self::System(system) => format!("system {}", system.command),
        }
    }

    /// The values of the parameters that are not open.
    pub fn fixed(&self) -> &Values {
        match self {
            Self::Scenario(simulation) => &simulation.fixed,
            Self::System(_) => &NOTHING_FIXED,
        }
    }
}

impl Simulation {
    /// A program with nominal values and the driver `aeb`; its open parameters, and what it asks of its runs.
    pub(super) fn new(program: Program) -> Result<(Self, Space, Vec<StatedRequirement>), Error> {
        let Declaration { parameters, requirements, duration, dt } = program.declare()?;
        let (open, closed): (Vec<_>, Vec<_>) = parameters.into_iter().partition(|declared| declared.open);
        let fixed = closed.iter().map(|declared| (declared.parameter.name.clone(), declared.nominal()));
        let simulation = Self {
            scenario: program.name().to_owned(),
            vehicle: VehicleModel::default(),
            fixed: fixed.collect(),
            driver: DriverChoice::usual(),
            appearances: Appearances::default(),
            stop_runs_early: false,
            dt,
            duration,
            program: Source::Here(program),
        };
        let space = Space::new(open.into_iter().map(|declared| declared.parameter).collect())?;
        Ok((simulation, space, requirements.into_iter().map(StatedRequirement::from).collect()))
    }

    /// The scenario's name.
    pub fn scenario(&self) -> &str {
        &self.scenario
    }

    /// The model that moves the car.
    pub fn vehicle(&self) -> VehicleModel {
        self.vehicle
    }

    /// The system under test.
    pub fn driver(&self) -> &DriverChoice {
        &self.driver
    }

    /// What actors look like to cameras.
    pub fn appearances(&self) -> &Appearances {
        &self.appearances
    }

    /// The program that is run.
    ///
    /// # Errors
    /// The study was read from a file and names a scenario that no catalogue has.
    pub fn program(&self) -> Result<&Program, MissingScenario> {
        let missing = |source| Err(MissingScenario { scenario: self.scenario.clone(), source });
        match &self.program {
            Source::Here(program) => Ok(program),
            Source::Missing(error) => missing(Some(Arc::clone(error))),
            Source::Unknown => missing(None),
        }
    }

    /// Looks for the program of a study that was read from a file. Parameters that it has come to ask for since then are fixed
    /// at their nominal values, which changes nothing.
    pub(super) fn look_for_program(&mut self, catalogue: &Catalogue, open: &Space) {
        self.program = match catalogue.find(&self.scenario) {
            Ok(program) => Source::Here(program),
            Err(error) => Source::Missing(Arc::new(error)),
        };
        // If the scenario cannot be declared, its first test says why.
        let declared = self.program().ok().and_then(|program| program.declare().ok());
        for declared in declared.into_iter().flat_map(|declaration| declaration.parameters) {
            let name = &declared.parameter.name;
            if !declared.open && self.fixed.get(name).is_none() && open.parameter(name).is_err() {
                self.fixed.set(name, declared.nominal());
            }
        }
    }

    /// The tick in seconds.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// How long a test takes in simulated seconds, unless a contact ends it.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// How many ticks a test takes, unless a contact ends it.
    pub fn ticks(&self) -> usize {
        (self.duration / self.dt).round() as usize
    }
}
