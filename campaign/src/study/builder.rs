//! Collects the choices for a study, and checks them together.

use super::driver::{DriverFlaw, Wish};
use super::parameters::ParameterMisuse;
use super::{DriverChoice, Maker, PerceiverChoice, PerceiverFlaw, Sampling, Simulation, Study, Subject, Variation};
#[cfg(feature = "camera")]
use crate::cameras::VariedCameras;
use crate::{BlackBox, Error, Trust};
use paracosm_engine::Program;
use paracosm_engine::driver::{Driver, find as find_driver};
use paracosm_engine::sensor::Cameras;
use paracosm_engine::vehicle::VehicleModel;
use paracosm_generators::{OwnStrategy, Strategy};
use paracosm_oracles::Semantics;
#[cfg(feature = "camera")]
use paracosm_perception::Perceiver;
use paracosm_space::{Distribution, Domain, Parameter, Space, Value};
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A builder of a study, which collects the choices for the study. The methods only note the choices;
/// [`build`](Self::build) checks them.
///
/// ```
/// use paracosm_campaign::{Catalogue, Study};
/// use paracosm_generators::Strategy;
///
/// let catalogue = Catalogue::of(paracosm_scenarios::ALL);
/// let study = Study::of(catalogue.find("pedestrian-crossing")?)
///     .driver("aeb")
///     .open("friction")
///     .fix("distance", 30.0)
///     .strategy(Strategy::SOBOL)
///     .budget(64)
///     .build()?;
/// assert_eq!(study.space().parameters().len(), 2);
/// # Ok::<(), paracosm_campaign::Error>(())
/// ```
#[derive(Debug, Clone)]
#[must_use = "a study is made by `build`"]
pub struct StudyBuilder {
    subject: Wanted,
    vehicle: Option<VehicleModel>,
    resistance: Vec<(String, f64)>,
    driver: Option<Wish>,
    driver_settings: Vec<(String, f64)>,
    driver_timeout: Option<f64>,
    references: Vec<String>,
    continuous: bool,
    may_be_one_test: bool,
    opened: Vec<Opened>,
    fixed: Vec<(String, Value)>,
    distributions: Vec<(String, Distribution)>,
    cameras: Vec<Parameter>,
    filmed: Vec<Cameras>,
    perceiver: Option<PerceiverWish>,
    models: Vec<(String, String)>,
    requirements: Vec<PathBuf>,
    odd: Option<PathBuf>,
    specs: Vec<(Semantics, String)>,
    sampling: Sampling,
}

/// The driver that drives while a perceiver is on trial.
const CARRIER: &str = "planner";

#[derive(Debug, Clone)]
enum Wanted {
    Scenario(Program),
    System(BlackBox, Space),
}

/// A perceiver that was asked for: a function that makes the choice.
#[derive(Clone)]
struct PerceiverWish(Arc<dyn Fn() -> Result<PerceiverChoice, Error> + Send + Sync>);

impl fmt::Debug for PerceiverWish {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a perceiver")
    }
}

#[derive(Debug, Clone)]
struct Opened {
    name: String,
    over: Option<Domain>,
    variation: Option<Variation>,
}

impl StudyBuilder {
    pub(super) fn of(program: Program) -> Self {
        Self::on(Wanted::Scenario(program))
    }

    pub(super) fn of_system(system: BlackBox, space: Space) -> Self {
        Self::on(Wanted::System(system, space))
    }

    fn on(subject: Wanted) -> Self {
        Self {
            subject,
            vehicle: None,
            resistance: Vec::new(),
            driver: None,
            driver_settings: Vec::new(),
            driver_timeout: None,
            references: Vec::new(),
            continuous: false,
            may_be_one_test: false,
            opened: Vec::new(),
            fixed: Vec::new(),
            distributions: Vec::new(),
            cameras: Vec::new(),
            filmed: Vec::new(),
            perceiver: None,
            models: Vec::new(),
            requirements: Vec::new(),
            odd: None,
            specs: Vec::new(),
            sampling: Sampling::default(),
        }
    }

    /// Sets the driver under test by its name. The name is the name of a driver of `paracosm-fuzz list`, the address
    /// `grpc://HOST:PORT` of a server, or a network, which is `cnn` or a file whose name ends in `.onnx`.
    pub fn driver(mut self, name: &str) -> Self {
        self.driver = Some(Wish::Name(name.to_owned()));
        self
    }

    /// Sets a command that starts the driver under test, once for each worker. The variable `PARACOSM_ADDRESS` tells
    /// the driver where to listen, as HOST:PORT. The driver should end when its standard input ends.
    pub fn driver_command(mut self, command: &str) -> Self {
        self.driver = Some(Wish::Command(command.to_owned()));
        self
    }

    /// Sets a function of this program that makes the driver under test. The study notes the driver's settings, which the function has to know;
    /// only `latency` has an effect by itself. Only this program can replay its tests, with
    /// [`Study::driven_by_own`](super::Study::driven_by_own).
    pub fn own_driver(mut self, name: &str, make: impl Fn() -> Box<dyn Driver> + Send + Sync + 'static) -> Self {
        self.driver = Some(Wish::own(name, make));
        self
    }

    /// Changes a setting of the driver under test. A driver in an external process gets all settings except two:
    /// `latency`, the seconds from a question to the time when its answer takes effect, and `seed`, the seed of its
    /// randomness and of its sensors' noise.
    pub fn set_driver(mut self, setting: &str, value: f64) -> Self {
        self.driver_settings.push((setting.to_owned(), value));
        self
    }

    /// Sets the time that a driver in an external process may take for an answer, in seconds; the driver may take ten
    /// times as long to start. The default is 60.
    pub fn driver_timeout(mut self, seconds: f64) -> Self {
        self.driver_timeout = Some(seconds);
        self
    }

    /// Adds a reference driver by its name. A violation that no reference driver avoids in the same test has the verdict
    /// `unpreventable` and is no failure.
    pub fn reference(mut self, name: &str) -> Self {
        self.references.push(name.to_owned());
        self
    }

    /// Lets the study have no open parameter. Such a study has one test.
    pub fn maybe_one_test(mut self) -> Self {
        self.may_be_one_test = true;
        self
    }

    /// Sets the vehicle model that computes the motion of the ego vehicle.
    pub fn vehicle(mut self, model: VehicleModel) -> Self {
        self.vehicle = Some(model);
        self
    }

    /// Sets a resistance against the motion of the ego vehicle by its name in [`Resistance::SETTINGS`]. There are no
    /// resistances by default.
    ///
    /// [`Resistance::SETTINGS`]: paracosm_engine::vehicle::Resistance::SETTINGS
    pub fn set_vehicle(mut self, setting: &str, value: f64) -> Self {
        self.resistance.push((setting.to_owned(), value));
        self
    }

    /// Lets the tests vary a parameter over the parameter's declared domain.
    pub fn open(self, name: &str) -> Self {
        self.opened(name, None, None)
    }

    /// Lets the tests vary a parameter over a part of the parameter's domain.
    pub fn open_over(self, name: &str, domain: Domain) -> Self {
        self.opened(name, Some(domain), None)
    }

    /// Lets the tests vary a parameter over a domain and, if a variation is given, over time. Without `over`, the
    /// domain is the declared domain of the parameter.
    pub fn opened(mut self, name: &str, over: Option<Domain>, variation: Option<Variation>) -> Self {
        self.opened.push(Opened { name: name.to_owned(), over, variation });
        self
    }

    /// Opens each parameter that has a list of numbers from an interval, such as a range with a step in a file, to the whole
    /// interval. Parameters that [`open`](Self::open) names keep what they were opened to.
    pub fn continuous(mut self) -> Self {
        self.continuous = true;
        self
    }

    /// Fixes a parameter at a value, or a signal at a value or a list of values.
    pub fn fix(mut self, name: &str, value: impl Into<Value>) -> Self {
        self.fixed.push((name.to_owned(), value.into()));
        self
    }

    /// Gives an open parameter a distribution, from which the probability of failure is estimated.
    pub fn distribute(mut self, name: &str, distribution: Distribution) -> Self {
        self.distributions.push((name.to_owned(), distribution));
        self
    }

    /// Lets the tests vary settings of the cameras that record the tests. These parameters come after all other open
    /// parameters. [`build`](Self::build) refuses a camera that is faster than the ticks of the scenario.
    #[cfg(feature = "camera")]
    pub fn open_cameras(mut self, cameras: &VariedCameras) -> Self {
        self.cameras.extend(cameras.parameters().cloned());
        self.filmed.push(cameras.nominal().clone());
        self
    }

    /// Puts a perception network on trial: an ONNX file, with its description in another file. It sees the images of the
    /// given camera. The driver, by default `planner`, only drives, and the requirements of the scenario do not count.
    /// Without a formula, a detector has the requirement `detection`. Settings of the camera that vary become parameters
    /// after all other open parameters.
    #[cfg(feature = "camera")]
    pub fn perceiver(self, file: &str, description: &str, cameras: VariedCameras) -> Self {
        let (file, description) = (file.to_owned(), description.to_owned());
        self.perceived(cameras, move |seen| PerceiverChoice::network(&file, &description, seen))
    }

    /// Puts a perceiver on trial that a command starts in a process of its own, as [`perceiver`](Self::perceiver) does. The
    /// process has `timeout` seconds for each answer, by default 60.
    #[cfg(feature = "camera")]
    pub fn perceiver_command(self, command: &str, timeout: Option<f64>, cameras: VariedCameras) -> Self {
        let command = command.to_owned();
        self.perceived(cameras, move |seen| PerceiverChoice::process(&command, timeout, seen))
    }

    /// Puts a perceiver on trial that a function of this program makes, as [`perceiver`](Self::perceiver) does. Only this
    /// program can replay its tests.
    #[cfg(feature = "camera")]
    pub fn own_perceiver(
        self,
        name: &str,
        cameras: VariedCameras,
        make: impl Fn() -> Box<dyn Perceiver> + Send + Sync + Clone + 'static,
    ) -> Self {
        let name = name.to_owned();
        self.perceived(cameras, move |seen| Ok(PerceiverChoice::own(&name, seen, make.clone())?))
    }

    #[cfg(feature = "camera")]
    fn perceived(
        self,
        cameras: VariedCameras,
        choose: impl Fn(Cameras) -> Result<PerceiverChoice, Error> + Send + Sync + 'static,
    ) -> Self {
        let seen = cameras.nominal().clone();
        let perceiver = Some(PerceiverWish(Arc::new(move || choose(seen.clone()))));
        Self { perceiver, ..self.open_cameras(&cameras) }
    }

    /// Replaces an actor in camera images by the 3D model in a glTF file, stretched to the actor's size. The ego
    /// vehicle is `car`; every other actor has the name that it has in traces and messages. Actors of one name, `tree`,
    /// `tree-2` and so on, look like the first actor unless they have a model of their own.
    pub fn show(mut self, actor: &str, file: &str) -> Self {
        self.models.push((actor.to_owned(), file.to_owned()));
        self
    }

    /// Adds the requirements and the operational design domain of a TOML file to the study.
    pub fn require(mut self, path: &Path) -> Self {
        self.requirements.push(path.to_owned());
        self
    }

    /// Adds the operational design domain in the table `[odd]` of a SPACE.toml to the study, if the file has the table.
    pub fn odd_of(mut self, path: &Path) -> Self {
        self.odd = Some(path.to_owned());
        self
    }

    /// Adds a requirement with the given formula, which judges every trace. The first formula has the id `spec-1`, the
    /// next formula has the id `spec-2`; such formulas have no unit and no scale.
    pub fn spec(self, formula: &str) -> Self {
        self.spec_in(Semantics::Sampled, formula)
    }

    /// Adds a requirement with the given formula as [`spec`](Self::spec) does, with sampled or dense time.
    pub fn spec_in(mut self, time: Semantics, formula: &str) -> Self {
        self.specs.push((time, formula.to_owned()));
        self
    }

    /// Sets the strategy, the budget and all other options that determine the tests of the study.
    pub fn sampling(mut self, sampling: Sampling) -> Self {
        self.sampling = sampling;
        self
    }

    /// Sets the strategy that chooses the tests.
    pub fn strategy(mut self, strategy: Strategy) -> Self {
        self.sampling.strategy = strategy;
        self
    }

    /// Sets a strategy of the program, such as a search of another package.
    pub fn own_strategy(mut self, strategy: OwnStrategy) -> Self {
        self.sampling.strategy = Strategy::OWN;
        self.sampling.own = Some(strategy);
        self
    }

    /// Sets the budget, which is the greatest number of tests.
    pub fn budget(mut self, tests: usize) -> Self {
        self.sampling.budget = tests;
        self
    }

    /// Sets the seed of all randomness in the strategy. Without a seed, Halton is the plain sequence.
    pub fn seed(mut self, seed: u64) -> Self {
        self.sampling.seed = Some(seed);
        self
    }

    /// Checks all choices, and makes the study.
    ///
    /// # Errors
    /// The program cannot be run; a driver, setting, parameter or actor does not exist; a value is out of range; a
    /// parameter is fixed twice; a file cannot be read or makes no sense; a formula names signals that the study does
    /// not have; the budget or the batch is 0; the strategy cannot do what is asked. The error names what was found and
    /// what was expected.
    pub fn build(self) -> Result<Study, Error> {
        let (subject, space, requirements) = match &self.subject {
            Wanted::Scenario(program) => {
                let (simulation, space, requirements) = Simulation::new(program.clone())?;
                (Subject::Scenario(Box::new(simulation)), space, requirements)
            }
            Wanted::System(system, space) => (Subject::System(system.clone()), space.clone(), Vec::new()),
        };
        self.sampling.check()?;
        let made_by = Maker::this();
        let sampling = self.sampling.clone();
        let mut study = Study {
            made_by,
            subject,
            space,
            requirements,
            odd: None,
            sampling,
            references: Vec::new(),
            trust: Trust::all(),
        };
        if self.driver.is_some() || !self.driver_settings.is_empty() || self.driver_timeout.is_some() {
            let simulation = study.subject.scenario_mut()?;
            let wish = self.driver.clone().unwrap_or_else(|| Wish::Name(simulation.driver.name().to_owned()));
            let (settings, timeout) = (&self.driver_settings, self.driver_timeout);
            simulation.driver = DriverChoice::new(&wish, settings, timeout, &simulation.scenario)?;
        }
        for cameras in &self.filmed {
            study.subject.scenario()?.check_rates(cameras)?;
        }
        if let Some(PerceiverWish(choose)) = &self.perceiver {
            let simulation = study.subject.scenario_mut()?;
            if self.driver.is_none() {
                let wish = Wish::Name(CARRIER.to_owned());
                simulation.driver = DriverChoice::new(&wish, &self.driver_settings, None, &simulation.scenario)?;
            }
            simulation.perceiver = Some(choose()?);
            study.requirements.clear();
        }
        if let Some(model) = self.vehicle {
            study.subject.scenario_mut()?.vehicle.model = model;
        }
        for (setting, value) in &self.resistance {
            study.subject.scenario_mut()?.vehicle.resistance.set(setting, *value)?;
        }
        self.open_and_fix(&mut study)?;
        if !self.cameras.is_empty() {
            study.open_cameras(&self.cameras)?;
        }
        study.keep_constraints()?;
        for (i, (name, distribution)) in self.distributions.iter().enumerate() {
            if self.distributions[..i].iter().any(|(other, _)| other == name) {
                return Err(ParameterMisuse::DistributedTwice { name: name.clone() }.into());
            }
            study.distribute(name, distribution)?;
        }
        if !self.may_be_one_test {
            self.has_tests(&study)?;
        }
        self.models.iter().try_for_each(|(actor, file)| study.show(actor, file))?;
        self.odd.iter().try_for_each(|path| study.odd_of_space(path))?;
        self.requirements.iter().try_for_each(|path| study.require(path))?;
        self.specs.iter().try_for_each(|(time, formula)| study.ask(*time, formula))?;
        if let Some(perceiver) = study.perceiver().filter(|_| study.requirements.is_empty()) {
            let usual = perceiver.usual_requirement()?;
            study.requirements.push(usual);
        }
        let reference = |name: &String| {
            let scenario = &study.subject.scenario()?.scenario;
            find_driver(name).map_err(DriverFlaw::from)?;
            DriverChoice::new(&Wish::Name(name.clone()), &[], None, scenario)
        };
        let references = self.references.iter().map(reference).collect::<Result<Vec<_>, Error>>()?;
        if let Ok(simulation) = study.subject.scenario()
            && references.iter().any(|reference| reference == simulation.driver())
        {
            return Err(DriverFlaw::OwnReference { name: simulation.driver().name().to_owned() }.into());
        }
        if !references.is_empty() {
            if study.perceiver().is_some() {
                return Err(PerceiverFlaw::References.into());
            }
            study = study.with_references(references)?;
        }
        study.hash_files()?;
        // The strategy checks that it can do what is asked of it. A file with tests is read later.
        if !study.runs_given_tests() {
            study.generator(&[])?;
        }
        Ok(study)
    }

    /// Checks that a parameter is open, so that tests differ.
    fn has_tests(&self, study: &Study) -> Result<(), ParameterMisuse> {
        match (&study.subject, self.fixed.last()) {
            _ if !study.space.parameters().is_empty() => Ok(()),
            (_, Some((name, _))) => Err(ParameterMisuse::LastOpen { name: name.clone() }),
            (Subject::Scenario(simulation), None) => {
                let scenario = simulation.scenario.clone();
                let all = study.fixed().iter().map(|(name, _)| name.to_owned()).collect();
                Err(ParameterMisuse::NoneOpen { scenario, all })
            }
            // The strategy refuses the space.
            (Subject::System(_), None) => Ok(()),
        }
    }

    fn open_and_fix(&self, study: &mut Study) -> Result<(), Error> {
        if self.continuous {
            study.open_intervals()?;
        }
        for Opened { name, over, variation } in &self.opened {
            study.open(name, over.as_ref())?;
            variation.map_or(Ok(()), |variation| study.vary(name, variation))?;
        }
        for (i, (name, value)) in self.fixed.iter().enumerate() {
            let is_opened = self.opened.iter().any(|opened| opened.name == *name);
            if is_opened || self.fixed[..i].iter().any(|(other, _)| other == name) {
                return Err(ParameterMisuse::Twice { name: name.clone() }.into());
            }
            study.fix(name, value.clone())?;
        }
        study.check_texts()
    }
}
