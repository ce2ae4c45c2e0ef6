//! The subject of a study: a scenario with a driver, or an external system.

use super::{Appearances, DriverChoice, PerceiverChoice, StatedRequirement};
use crate::catalogue::UntrustedScenario;
use crate::{BlackBox, Catalogue, Error, Reason};
use paracosm_engine::vehicle::VehicleSetup;
use paracosm_engine::{Declaration, Declared, Program};
use paracosm_space::{Space, Values};
use std::sync::Arc;
use thiserror::Error;

/// The subject of a study, which is a scenario with a driver or an external system.
#[derive(Debug, Clone)]
pub enum Subject {
    /// A simulated scenario with a driver under test.
    Scenario(Box<Simulation>),
    /// An external system under test, which answers tests in a separate process.
    System(BlackBox),
}

/// A scenario with the driver under test and the fixed parameters.
#[derive(Debug, Clone)]
pub struct Simulation {
    pub(crate) scenario: String,
    /// The hash of the files of the scenario; `None` if the scenario is not that of a file.
    pub(crate) files: Option<String>,
    pub(crate) vehicle: VehicleSetup,
    pub(crate) fixed: Values,
    pub(crate) driver: DriverChoice,
    /// The perceiver on trial; `None` if the driver is on trial.
    pub(crate) perceiver: Option<PerceiverChoice>,
    pub(crate) appearances: Appearances,
    /// True if runs ended as soon as all requirements were decided, as older versions allowed.
    pub(crate) stop_runs_early: bool,
    pub(crate) dt: f64,
    pub(crate) duration: f64,
    pub(crate) program: Source,
}

/// The source of a study's program.
#[derive(Debug, Clone, Default)]
pub(crate) enum Source {
    Here(Program),
    /// No catalogue has the program.
    Missing(Arc<Error>),
    /// Nobody has looked for the program yet.
    #[default]
    Unknown,
}

/// The error that the scenario of a study is not available.
#[derive(Debug, Error)]
#[error("the campaign was run on the scenario `{scenario}`, which cannot be used here{}", why(.source))]
pub struct MissingScenario {
    /// The name of the missing scenario.
    pub scenario: String,
    /// The reason why the scenario was not found; `None` if the software has not looked for the scenario.
    pub source: Option<Arc<Error>>,
}

/// The error that a scenario is needed, but the subject of the study is an external system.
#[derive(Debug, Error)]
#[error("the system `{command}` is not a scenario, but this works only with a scenario")]
pub struct NoScenario {
    /// The command of the external system.
    pub command: String,
}

impl Reason for MissingScenario {}
impl Reason for NoScenario {}

fn why(source: &Option<Arc<Error>>) -> String {
    source.as_ref().map(|source| format!(": {source}")).unwrap_or_default()
}

/// The fixed parameters of a system: it has none.
static NOTHING_FIXED: Values = Values::EMPTY;

impl Subject {
    /// Returns the scenario of the subject, with the driver.
    ///
    /// # Errors
    /// The subject is an external system.
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

    /// Returns a short description of the system under test.
    pub fn title(&self) -> String {
        match self {
            Self::Scenario(simulation) => match &simulation.perceiver {
                Some(perceiver) => format!("{}, perceiver {}", simulation.scenario, perceiver.name()),
                None => format!("{}, driver {}", simulation.scenario, simulation.driver.name()),
            },
            Self::System(system) => format!("system {}", system.command),
        }
    }

    /// Returns the fixed values of the parameters that the tests do not vary.
    pub fn fixed(&self) -> &Values {
        match self {
            Self::Scenario(simulation) => &simulation.fixed,
            Self::System(_) => &NOTHING_FIXED,
        }
    }
}

impl Simulation {
    /// Makes the simulation of a program with nominal values and the driver `aeb`. Also returns its open parameters and
    /// its requirements.
    pub(super) fn new(program: Program) -> Result<(Self, Space, Vec<StatedRequirement>), Error> {
        let declaration = program.declare()?;
        let program = program.keeping(&declaration);
        let Declaration { parameters, requirements, duration, dt, .. } = declaration;
        let (open, closed): (Vec<_>, Vec<_>) = parameters.into_iter().partition(|declared| declared.open);
        let fixed = closed.iter().map(|declared| (declared.parameter.name.clone(), declared.nominal()));
        let simulation = Self {
            scenario: program.name().to_owned(),
            files: None,
            vehicle: VehicleSetup::default(),
            fixed: fixed.collect(),
            driver: DriverChoice::usual(),
            perceiver: None,
            appearances: Appearances::default(),
            stop_runs_early: false,
            dt,
            duration,
            program: Source::Here(program),
        };
        let space = Space::new(open.iter().map(Declared::opened).collect())?;
        Ok((simulation, space, requirements.into_iter().map(StatedRequirement::from).collect()))
    }

    /// Returns the name of the scenario.
    pub fn scenario(&self) -> &str {
        &self.scenario
    }

    /// Returns the model that computes the motion of the ego vehicle, with the resistances against the motion.
    pub fn vehicle(&self) -> VehicleSetup {
        self.vehicle
    }

    /// Returns the driver, which is the system under test.
    pub fn driver(&self) -> &DriverChoice {
        &self.driver
    }

    /// Returns the 3D models that replace actors in images.
    pub fn appearances(&self) -> &Appearances {
        &self.appearances
    }

    /// Returns the program of the scenario.
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

    /// Returns `true` if the scenario stands in a file that runs when it is read, so that the user has to trust it.
    pub fn runs_a_file(&self) -> bool {
        match &self.program {
            Source::Here(program) => program.runs_a_file(),
            Source::Missing(error) => error.reason::<UntrustedScenario>().is_some(),
            Source::Unknown => false,
        }
    }

    /// Records further signals, which formulas ask for, in the traces of the scenario. Only signals that are measured on request change
    /// anything.
    pub(super) fn record<'s>(&mut self, signals: impl IntoIterator<Item = &'s str>) {
        if let Source::Here(program) = &mut self.program {
            *program = program.recording(signals);
        }
    }

    /// Looks for the program of a study that was read from a file. Parameters that were added to the program since then
    /// are fixed at their nominal values, which changes nothing.
    pub(super) fn look_for_program(&mut self, catalogue: &Catalogue, open: &Space) {
        self.program = match catalogue.find(&self.scenario) {
            Ok(program) => Source::Here(program),
            Err(error) => Source::Missing(Arc::new(error)),
        };
        // If the scenario cannot be declared, the first test reports the reason.
        let declared = self.program().ok().and_then(|program| program.declare().ok());
        if let (Source::Here(program), Some(declaration)) = (&mut self.program, &declared) {
            *program = program.keeping(declaration);
        }
        for declared in declared.into_iter().flat_map(|declaration| declaration.parameters) {
            let name = &declared.parameter.name;
            if !declared.open && self.fixed.get(name).is_none() && open.parameter(name).is_err() {
                self.fixed.set(name.as_str(), declared.nominal());
            }
        }
    }

    /// Returns the length of a tick in seconds.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Returns the simulated duration of a test in seconds, unless a contact ends the test early.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Returns the number of ticks of a test, unless a contact ends the test early.
    pub fn ticks(&self) -> usize {
        (self.duration / self.dt).round() as usize
    }
}
