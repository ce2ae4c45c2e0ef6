//! What the tests of a study are run on: a scenario of ours with a driver, or a system that others wrote.

use super::{Appearances, DriverChoice, RequirementText, Study};
use crate::{BlackBox, Error};
use paracosm_coverage::{Space, Values};
use paracosm_engine::vehicle::Model;
use paracosm_engine::{Declaration, Program, Run, Setup, Test};
use paracosm_scenarios as scenarios;
use serde::{Deserialize, Serialize};

/// What tests are run on.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "missing field: expected `scenario` with `vehicle`, `fixed`, `driver`, `dt` and `duration`, or `system` \
                 with `timeout`"
)]
pub enum Subject {
    /// A simulated world with the system under test in it.
    Scenario(Simulation),
    /// A process.
    System(BlackBox),
}

/// A scenario with a driver.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Simulation {
    /// The scenario's name.
    pub scenario: String,
    /// Which model moves the car.
    pub vehicle: Model,
    /// The values of the parameters that are not open.
    pub fixed: Values,
    /// The system under test.
    pub driver: DriverChoice,
    /// What actors look like to cameras.
    #[serde(rename = "models", skip_serializing_if = "Appearances::is_empty", default)]
    pub(crate) appearances: Appearances,
    /// Whether a run ends as soon as all that is asked of it is decided.
    #[serde(skip_serializing_if = "std::ops::Not::not", default)]
    pub(crate) stop_runs_early: bool,
    dt: f64,
    duration: f64,
    /// A program that is not in the catalogue.
    #[serde(skip)]
    program: Option<Program>,
}

/// A system has no fixed parameters.
static NOTHING_FIXED: Values = Values::EMPTY;

impl Subject {
    /// The scenario.
    ///
    /// # Errors
    /// It is a system that others wrote.
    pub fn scenario(&self) -> Result<&Simulation, Error> {
        match self {
            Self::Scenario(simulation) => Ok(simulation),
            Self::System(system) => Err(no_scenario(system)),
        }
    }

    pub(super) fn scenario_mut(&mut self) -> Result<&mut Simulation, Error> {
        match self {
            Self::Scenario(simulation) => Ok(simulation),
            Self::System(system) => Err(no_scenario(system)),
        }
    }

    /// What is tested, in a few words.
    pub fn title(&self) -> String {
        match self {
            Self::Scenario(Simulation { scenario, driver, .. }) => format!("{scenario}, driver {}", driver.name),
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

fn no_scenario(system: &BlackBox) -> Error {
    Error::Usage(format!("the system `{}` is no scenario, but that is what is asked of it here", system.command))
}

impl Simulation {
    /// A program with nominal values and the driver `aeb`; its open parameters, and what it asks of its runs.
    pub(super) fn new(program: Program) -> Result<(Self, Space, Vec<RequirementText>), Error> {
        let Declaration { parameters, requirements, duration, dt } = program.declare()?;
        let (open, closed): (Vec<_>, Vec<_>) = parameters.into_iter().partition(|declared| declared.open);
        let fixed = closed.iter().map(|declared| (declared.parameter.name.clone(), declared.nominal()));
        let simulation = Self {
            scenario: program.name.to_owned(),
            vehicle: Model::default(),
            fixed: fixed.collect(),
            driver: DriverChoice::new("aeb", &[], program.name)?,
            appearances: Appearances::default(),
            stop_runs_early: false,
            dt,
            duration,
            program: Some(program),
        };
        let space = Space::new(open.into_iter().map(|declared| declared.parameter).collect())?;
        Ok((simulation, space, requirements.into_iter().map(RequirementText::from).collect()))
    }

    /// The program that is run.
    ///
    /// # Errors
    /// The study was read from a file and names a scenario that is not in the catalogue.
    pub fn program(&self) -> Result<Program, Error> {
        match self.program {
            Some(program) => Ok(program),
            None => scenarios::find(&self.scenario).copied().map_err(|_| {
                let message = "the campaign was run by another program: no scenario of this one is called";
                Error::Usage(format!("{message} `{}`", self.scenario))
            }),
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

impl Study {
    /// Lets this model move the car: `single-track` or `jointed`.
    ///
    /// # Errors
    /// There is no such model, or the study is of no scenario.
    pub fn vehicle(mut self, name: &str) -> Result<Self, Error> {
        self.subject.scenario_mut()?.vehicle = Model::find(name)?;
        Ok(self)
    }

    /// Ends a run as soon as all that is asked of it is decided, which never changes a verdict. The robustness of such a run is
    /// that of what was run.
    ///
    /// # Errors
    /// The study is of no scenario.
    pub fn stop_runs_early(mut self) -> Result<Self, Error> {
        self.subject.scenario_mut()?.stop_runs_early = true;
        Ok(self)
    }

    /// The signals that the trace of a test has, as far as they are known before it is run: those of the world with nominal
    /// values. Nothing is known of a system.
    ///
    /// # Errors
    /// There is no such program, or it cannot build its nominal world.
    pub fn signals(&self) -> Result<Option<Vec<String>>, Error> {
        let Subject::Scenario(simulation) = &self.subject else { return Ok(None) };
        let (program, values) = (simulation.program()?, self.nominal()?);
        let setup = Setup { model: simulation.vehicle, ..Setup::asking_every(simulation.dt) };
        Ok(Some(Run::new(&program, Test::new(&values, &self.space), setup)?.signals().to_vec()))
    }
}
