//! Studies: the complete description of a campaign, from which each of its tests can be run again.
//!
//! A [`StudyBuilder`] collects the choices and checks them once. The [`Study`] that it makes never changes; the scales
//! that a campaign learns are kept beside it. [`StudyFile`](crate::StudyFile) is its form in `campaign.json`.

mod actors;
mod agreement;
mod appearance;
mod builder;
mod command;
mod constraints;
mod driver;
mod entries;
mod formulas;
mod listed;
mod network;
mod odd;
mod parameters;
mod perceiver;
mod rates;
mod requirement;
mod requirements_file;
mod sampling;
mod scenario_files;
mod subject;
mod toml_file;

pub use actors::AppearanceFlaw;
pub use appearance::{Appearances, ModelFlaw, WithoutCameras};
pub use builder::StudyBuilder;
pub use command::{NamedCommand, NoSuchCommand, Untrusted, UntrustedAddress};
pub use driver::{DriverChoice, DriverFlaw, Origin};
pub use entries::EntryFlaw;
pub(crate) use entries::check_scale;
pub use formulas::{FormulaFlaw, SpecFlaw};
pub use listed::ListedDriver;
pub use network::NetworkFlaw;
pub use odd::{Attribute, Odd, OddFlaw};
pub use parameters::{ParameterMisuse, Variation};
pub use perceiver::{PerceiverChoice, PerceiverFlaw};
pub use rates::RateFlaw;
pub use requirement::StatedRequirement;
pub use requirements_file::RequirementFlaw;
pub use sampling::{Sampling, SamplingFlaw};
pub use subject::{MissingScenario, NoScenario, Simulation, Subject};
pub use toml_file::TomlFlaw;

use crate::{BlackBox, Catalogue, Error, TARGET, Trust};
use paracosm_engine::driver::Driver;
use paracosm_engine::{Program, Run, Setup, Test};
use paracosm_generators::{Generator, GeneratorError, Strategy};
use paracosm_oracles::Formula;
use paracosm_space::{Point, Space, Value, Values};

/// The complete description of a campaign, with the system under test, the open parameters, the requirements of every
/// test, and the choice of tests.
#[derive(Debug, Clone)]
pub struct Study {
    made_by: Maker,
    subject: Subject,
    space: Space,
    requirements: Vec<StatedRequirement>,
    odd: Option<Odd>,
    sampling: Sampling,
    /// The same study with each of the reference drivers.
    references: Vec<Study>,
    /// The trust in the command of the study.
    trust: Trust,
}

/// The software that wrote a study.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Maker {
    pub(crate) version: String,
    pub(crate) target: String,
}

impl Maker {
    /// Returns this software.
    fn this() -> Self {
        Self { version: env!("CARGO_PKG_VERSION").to_owned(), target: TARGET.to_owned() }
    }
}

impl Study {
    /// Makes a builder of a study that tests a driver in a scenario. By default the driver is `aeb`, the strategy
    /// `halton`, and the budget 500 tests.
    pub fn of(program: Program) -> StudyBuilder {
        StudyBuilder::of(program)
    }

    /// Makes a builder of a study that tests an external system over the given space. By default the strategy is
    /// `halton`, and the budget 500 tests.
    pub fn of_system(system: BlackBox, space: Space) -> StudyBuilder {
        StudyBuilder::of_system(system, space)
    }

    /// Makes the study of a file, which other software may have written.
    pub(crate) fn of_file(
        made_by: Maker,
        subject: Subject,
        space: Space,
        requirements: Vec<StatedRequirement>,
        odd: Option<Odd>,
        sampling: Sampling,
    ) -> Self {
        Self { made_by, subject, space, requirements, odd, sampling, references: Vec::new(), trust: Trust::NOTHING }
    }

    /// Returns the study with the trust of the user in the command that the study names. A study that was read from a
    /// file has none. A study that was built in this program is trusted.
    pub fn trusting(self, trust: &Trust) -> Self {
        let references = self.references.into_iter().map(|reference| reference.trusting(trust)).collect();
        Self { trust: trust.clone(), references, ..self }
    }

    /// Returns the same study with each of the reference drivers. A violation that none of the drivers avoids is
    /// unpreventable. Without reference drivers, no violation is.
    pub fn references(&self) -> &[Self] {
        &self.references
    }

    /// Sets the reference drivers.
    pub(crate) fn with_references(mut self, drivers: Vec<DriverChoice>) -> Result<Self, NoScenario> {
        self.references.clear();
        let reference = |driver| {
            let mut study = self.clone();
            study.subject.scenario_mut()?.driver = driver;
            Ok(study)
        };
        self.references = drivers.into_iter().map(reference).collect::<Result<_, NoScenario>>()?;
        Ok(self)
    }

    pub(crate) fn trust(&self) -> &Trust {
        &self.trust
    }

    /// Returns the software that wrote the study.
    pub(crate) fn made_by(&self) -> &Maker {
        &self.made_by
    }

    /// Returns the subject of the study, which is a scenario or an external system.
    pub fn subject(&self) -> &Subject {
        &self.subject
    }

    /// Returns the perceiver on trial; `None` if the driver or a system is on trial.
    pub fn perceiver(&self) -> Option<&PerceiverChoice> {
        match &self.subject {
            Subject::Scenario(simulation) => simulation.perceiver.as_ref(),
            Subject::System(_) => None,
        }
    }

    /// Returns the space of the open parameters, which the tests vary.
    pub fn space(&self) -> &Space {
        &self.space
    }

    /// Returns the requirements that every test should satisfy. The requirements of a system that answers with
    /// robustness are not known here.
    pub fn requirements(&self) -> &[StatedRequirement] {
        &self.requirements
    }

    /// Returns the requirement with the given id; `None` if the study does not state the requirement.
    pub fn requirement(&self, id: &str) -> Option<&StatedRequirement> {
        self.requirements.iter().find(|requirement| requirement.id == id)
    }

    /// Returns the attributes of the operational design domain; `None` if the study does not state the domain.
    pub fn odd(&self) -> Option<&Odd> {
        self.odd.as_ref()
    }

    /// Returns the strategy, the budget and all other options that determine the tests.
    pub fn sampling(&self) -> &Sampling {
        &self.sampling
    }

    /// Returns a short description of the system under test.
    pub fn title(&self) -> String {
        self.subject.title()
    }

    /// Returns the fixed values of the parameters that the tests do not vary.
    pub fn fixed(&self) -> &Values {
        self.subject.fixed()
    }

    /// Returns the program of the study's scenario.
    ///
    /// # Errors
    /// The study is that of an external system, or was read from a file and names a scenario that no catalogue has.
    pub fn program(&self) -> Result<&Program, Error> {
        Ok(self.subject.scenario()?.program()?)
    }

    /// Returns the names of the signals in the trace of a test with nominal values. Returns `None` for an external
    /// system, whose signals are not known before a test runs.
    ///
    /// # Errors
    /// The program does not exist, or cannot build its nominal world.
    pub fn signals(&self) -> Result<Option<Vec<String>>, Error> {
        let Subject::Scenario(simulation) = &self.subject else { return Ok(None) };
        let (program, values) = (simulation.program()?, self.nominal()?);
        let setup = Setup { vehicle: simulation.vehicle(), ..Setup::asking_every(simulation.dt()) };
        let mut signals = Run::new(program, Test::new(&values, &self.space), setup)?.signals().to_vec();
        signals.extend(
            simulation
                .perceiver
                .iter()
                .flat_map(|perceiver| perceiver.task().signals().iter().map(|name| (*name).to_owned())),
        );
        Ok(Some(signals))
    }

    /// Returns a catalogue of the study's own program, for files of the same scenario. The catalogue of an external
    /// system is empty.
    pub fn catalogue(&self) -> Catalogue {
        self.program().map(|program| Catalogue::of(&[program])).unwrap_or_default()
    }

    /// Makes a generator that proposes the study's tests in addition to the existing tests. Without an open parameter, there is one
    /// test, whatever the strategy is.
    ///
    /// # Errors
    /// The strategy cannot do what the study asks.
    pub fn generator(&self, existing: &[Point]) -> Result<Box<dyn Generator>, GeneratorError> {
        if self.is_one_test() {
            let request = self.sampling.request(&self.space, existing);
            if request.budget == 0 {
                return Err(GeneratorError::NoBudget);
            }
            // There are no combinations of k parameters.
            if request.k.is_some() {
                request.discrete_strength()?;
            }
            return Ok(Box::new(sampling::OneTest { is_asked: !existing.is_empty() }));
        }
        self.sampling.strategy.build(&self.sampling.request(&self.space, existing))
    }

    /// Makes a generator of the study's strategy that draws the discrete values of every test independently. The
    /// generator does not use the rows of a family.
    ///
    /// # Errors
    /// The same errors as [`Study::generator`].
    pub fn independent_generator(&self) -> Result<Box<dyn Generator>, GeneratorError> {
        self.sampling.strategy.build_independent(&self.sampling.request(&self.space, &[]))
    }

    /// Returns `true` if a scenario has no open parameter, so that all tests are the same.
    pub fn is_one_test(&self) -> bool {
        self.space.parameters().is_empty() && matches!(self.subject, Subject::Scenario(_))
    }

    /// Returns the values of all parameters of a test's world, including the fixed parameters.
    pub fn complete(&self, test: &Values) -> Values {
        let own = test.iter().filter(|(name, _)| parameters::is_of_world(name));
        own.chain(self.fixed().iter()).map(owned).collect()
    }

    /// Returns `true` if the study runs the tests of a file, in their order.
    pub fn runs_given_tests(&self) -> bool {
        self.sampling.strategy == Strategy::GIVEN
    }

    /// Returns `true` if a test of the study is sure to end as before when it runs again: a driver in this process drives, and no perceiver is
    /// on trial.
    pub fn repeats_in_process(&self) -> bool {
        let is_driven_here = self.subject.scenario().is_ok_and(|simulation| !simulation.driver().is_external());
        is_driven_here && self.perceiver().is_none()
    }

    /// Returns `true` if this version of the software wrote the study, so that a replay has to give the same trace.
    pub fn is_of_this_software(&self) -> bool {
        let ended_early = matches!(&self.subject, Subject::Scenario(simulation) if simulation.stop_runs_early);
        self.made_by == Maker::this() && !ended_early
    }

    /// Returns a copy of the study with the given sampling, which determines the tests.
    ///
    /// # Errors
    /// The budget or the batch is 0.
    pub fn sampled(&self, sampling: Sampling) -> Result<Self, SamplingFlaw> {
        sampling.check()?;
        Ok(Self { sampling, ..self.clone() })
    }

    /// Returns a copy of the study with the given driver and the given settings of the driver.
    ///
    /// # Errors
    /// The same errors as for [`StudyBuilder::driver`].
    pub fn driven_by(&self, name: &str, settings: &[(String, f64)]) -> Result<Self, Error> {
        self.with_driver(&driver::Wish::Name(name.to_owned()), settings)
    }

    /// Returns a copy of the study with a driver that the given function makes, as [`StudyBuilder::own_driver`] does.
    ///
    /// # Errors
    /// The study is that of an external system.
    pub fn driven_by_own(
        &self,
        name: &str,
        make: impl Fn() -> Box<dyn Driver> + Send + Sync + 'static,
    ) -> Result<Self, Error> {
        self.with_driver(&driver::Wish::own(name, make), &[])
    }

    /// Returns a copy of the study in which the given function makes the driver. The file of a study has only the name and the settings of a
    /// driver that a program made.
    ///
    /// # Errors
    /// The driver of the study has another name, or the study is that of an external system.
    pub fn with_own_driver(
        &self,
        name: &str,
        make: impl Fn() -> Box<dyn Driver> + Send + Sync + 'static,
    ) -> Result<Self, Error> {
        let mut study = self.clone();
        let simulation = study.subject.scenario_mut()?;
        simulation.driver = simulation.driver.made_by(name, make)?;
        Ok(study)
    }

    fn with_driver(&self, wish: &driver::Wish, settings: &[(String, f64)]) -> Result<Self, Error> {
        let mut study = Self { references: Vec::new(), ..self.clone() };
        let simulation = study.subject.scenario_mut()?;
        simulation.driver = DriverChoice::new(wish, settings, None, &simulation.scenario)?;
        Ok(study)
    }

    /// Returns the same study as a single test needs it: with a budget of one test and without a statement about the
    /// design domain.
    pub(crate) fn of_one_test(&self) -> Self {
        let sampling = Sampling { budget: 1, stop_at_first: false, ..self.sampling.clone() };
        Self { odd: None, sampling, ..self.clone() }
    }

    /// Looks for the scenario of the study in a catalogue, and returns the study with the scenario's program. If the
    /// catalogue does not have the scenario, the first test reports the error.
    pub fn with_program_of(mut self, catalogue: &Catalogue) -> Self {
        if let Subject::Scenario(simulation) = &mut self.subject {
            simulation.look_for_program(catalogue, &self.space);
            let formulas = self.requirements.iter().filter_map(|requirement| requirement.formula.as_ref());
            simulation.record(formulas.flat_map(Formula::signals));
        }
        self.references = self.references.into_iter().map(|study| study.with_program_of(catalogue)).collect();
        self
    }
}

fn owned((name, value): (&str, &Value)) -> (String, Value) {
    (name.to_owned(), value.clone())
}
