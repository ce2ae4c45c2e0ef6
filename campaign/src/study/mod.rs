//! What is tested, how, and with what: a value that says all that it takes to run any of the tests again.
//!
//! A [`StudyBuilder`] is told what is wanted and checks it once. The [`Study`] that it gives never changes, and whatever a
//! campaign learns stands beside it. [`StudyFile`](crate::StudyFile) is its form in `campaign.json`.

mod actors;
mod appearance;
mod builder;
mod driver;
mod formulas;
mod listed;
mod network;
mod odd;
mod parameters;
mod requirement;
mod requirements_file;
mod sampling;
mod subject;
mod toml_file;

pub use actors::AppearanceFlaw;
pub use appearance::{Appearances, ModelFlaw, WithoutCameras};
pub use builder::StudyBuilder;
pub use driver::{DriverChoice, DriverFlaw, Origin};
pub use formulas::{FormulaFlaw, SpecFlaw};
pub use listed::ListedDriver;
pub use network::NetworkFlaw;
pub use odd::{Attribute, Odd, OddFlaw};
pub use parameters::{ParameterMisuse, Variation, setting_name};
pub use requirement::StatedRequirement;
pub use requirements_file::RequirementFlaw;
pub use sampling::{Sampling, SamplingFlaw};
pub use subject::{MissingScenario, NoScenario, Simulation, Subject};
pub use toml_file::TomlFlaw;

use crate::{BlackBox, Catalogue, Error, TARGET};
use paracosm_engine::driver::Driver;
use paracosm_engine::{Program, Run, Setup, Test};
use paracosm_generators::{Generator, GeneratorError};
use paracosm_space::{Point, Space, Value, Values};

/// A study: what is tested, the open parameters, what is asked of every test, and how tests are chosen.
#[derive(Debug, Clone)]
pub struct Study {
    made_by: Maker,
    subject: Subject,
    space: Space,
    requirements: Vec<StatedRequirement>,
    odd: Option<Odd>,
    sampling: Sampling,
}

/// The software that has written a study.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Maker {
    pub(crate) version: String,
    pub(crate) target: String,
}

impl Maker {
    /// This software.
    fn this() -> Self {
        Self { version: env!("CARGO_PKG_VERSION").to_owned(), target: TARGET.to_owned() }
    }
}

impl Study {
    /// A study of a scenario; without further wishes its driver is `aeb`, its strategy `halton`, and it has 500 tests.
    pub fn of(program: Program) -> StudyBuilder {
        StudyBuilder::of(program)
    }

    /// A study of a system that others wrote, over this space; without further wishes by 500 tests of `halton`.
    pub fn of_system(system: BlackBox, space: Space) -> StudyBuilder {
        StudyBuilder::of_system(system, space)
    }

    /// The study of a file, which other software may have written.
    pub(crate) fn of_file(
        made_by: Maker,
        subject: Subject,
        space: Space,
        requirements: Vec<StatedRequirement>,
        odd: Option<Odd>,
        sampling: Sampling,
    ) -> Self {
        Self { made_by, subject, space, requirements, odd, sampling }
    }

    /// The software that has written it.
    pub(crate) fn made_by(&self) -> &Maker {
        &self.made_by
    }

    /// The scenario or the system that the tests are run on.
    pub fn subject(&self) -> &Subject {
        &self.subject
    }

    /// The open parameters, which the tests vary.
    pub fn space(&self) -> &Space {
        &self.space
    }

    /// What is asked of every run. A system that answers with robustness has requirements that are not known here.
    pub fn requirements(&self) -> &[StatedRequirement] {
        &self.requirements
    }

    /// The requirement of this id, if it was known beforehand.
    pub fn requirement(&self, id: &str) -> Option<&StatedRequirement> {
        self.requirements.iter().find(|requirement| requirement.id == id)
    }

    /// The part of the operational design domain that the tests are about, if anybody has said so.
    pub fn odd(&self) -> Option<&Odd> {
        self.odd.as_ref()
    }

    /// How tests are chosen.
    pub fn sampling(&self) -> &Sampling {
        &self.sampling
    }

    /// What is tested, in a few words.
    pub fn title(&self) -> String {
        self.subject.title()
    }

    /// The values of the parameters that are not open.
    pub fn fixed(&self) -> &Values {
        self.subject.fixed()
    }

    /// The program that is run.
    ///
    /// # Errors
    /// The study is of a system that others wrote, or was read from a file and names a scenario that no catalogue has.
    pub fn program(&self) -> Result<&Program, Error> {
        Ok(self.subject.scenario()?.program()?)
    }

    /// The signals that the trace of a test has, as far as they are known before it is run: those of the world with nominal
    /// values. Nothing is known of a system.
    ///
    /// # Errors
    /// There is no such program, or it cannot build its nominal world.
    pub fn signals(&self) -> Result<Option<Vec<String>>, Error> {
        let Subject::Scenario(simulation) = &self.subject else { return Ok(None) };
        let (program, values) = (simulation.program()?, self.nominal()?);
        let setup = Setup { model: simulation.vehicle(), ..Setup::asking_every(simulation.dt()) };
        Ok(Some(Run::new(program, Test::new(&values, &self.space), setup)?.signals().to_vec()))
    }

    /// A generator of the study's tests, which complete the existing ones.
    ///
    /// # Errors
    /// The strategy cannot do what is asked of it.
    pub fn generator(&self, existing: &[Point]) -> Result<Box<dyn Generator>, GeneratorError> {
        self.sampling.strategy.build(&self.sampling.request(&self.space, existing))
    }

    /// A generator of the study's strategy that draws discrete values for every test rather than take the rows of a family.
    ///
    /// # Errors
    /// As [`Study::generator`].
    pub fn independent_generator(&self) -> Result<Box<dyn Generator>, GeneratorError> {
        self.sampling.strategy.build_independent(&self.sampling.request(&self.space, &[]))
    }

    /// All values of a test that its world is built of: its own and the fixed ones.
    pub fn complete(&self, test: &Values) -> Values {
        let own = test.iter().filter(|(name, _)| parameters::is_of_world(name));
        own.chain(self.fixed().iter()).map(owned).collect()
    }

    /// Whether this very software has written it, so that a replay has to give the same trace.
    pub fn is_of_this_software(&self) -> bool {
        let ended_early = matches!(&self.subject, Subject::Scenario(simulation) if simulation.stop_runs_early);
        self.made_by == Maker::this() && !ended_early
    }

    /// The same study with its tests chosen otherwise.
    ///
    /// # Errors
    /// The budget or the batch is 0.
    pub fn sampled(&self, sampling: Sampling) -> Result<Self, SamplingFlaw> {
        sampling.check()?;
        Ok(Self { sampling, ..self.clone() })
    }

    /// The same study of another driver, with changed settings.
    ///
    /// # Errors
    /// As for [`StudyBuilder::driver`].
    pub fn driven_by(&self, name: &str, settings: &[(String, f64)]) -> Result<Self, Error> {
        self.with_driver(&driver::Wish::Name(name.to_owned()), settings)
    }

    /// The same study of a driver of one's own, as [`StudyBuilder::own_driver`].
    ///
    /// # Errors
    /// The study is of no scenario.
    pub fn driven_by_own(
        &self,
        name: &str,
        make: impl Fn() -> Box<dyn Driver> + Send + Sync + 'static,
    ) -> Result<Self, Error> {
        self.with_driver(&driver::Wish::own(name, make), &[])
    }

    fn with_driver(&self, wish: &driver::Wish, settings: &[(String, f64)]) -> Result<Self, Error> {
        let mut study = self.clone();
        let simulation = study.subject.scenario_mut()?;
        simulation.driver = DriverChoice::new(wish, settings, None, &simulation.scenario)?;
        Ok(study)
    }

    /// The same study with nothing said of how its tests are chosen, how many there are and which part of the design domain
    /// they are about: what a single test of it needs.
    pub(crate) fn of_one_test(&self) -> Self {
        let sampling = Sampling { budget: 1, stop_at_first: false, ..self.sampling.clone() };
        Self { odd: None, sampling, ..self.clone() }
    }

    /// The study with the program of its scenario, if the catalogue has that. Scenarios that a catalogue does not have are
    /// missed when a test is run.
    pub fn with_program_of(mut self, catalogue: &Catalogue) -> Self {
        if let Subject::Scenario(simulation) = &mut self.subject {
            simulation.look_for_program(catalogue, &self.space);
        }
        self
    }
}

fn owned((name, value): (&str, &Value)) -> (String, Value) {
    (name.to_owned(), value.clone())
}
