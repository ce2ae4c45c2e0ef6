//! What is tested, how, and with what: the contents of `campaign.json`, from which any test can be run again.

mod appearance;
mod driver;
mod failures;
mod network;
mod odd;
mod parameters;
mod recorded;
mod requirement;
mod requirements_file;
mod subject;

pub(crate) use appearance::Appearances;
pub use driver::DriverChoice;
pub(crate) use driver::Origin;
pub use odd::{Attribute, Odd};
#[cfg(feature = "camera")]
pub(crate) use recorded::setting_name;
pub use requirement::RequirementText;
pub(crate) use requirement::Specs;
pub use subject::{Simulation, Subject};

use crate::scales::Scales;
use crate::{BlackBox, Error, Extension, Promise, Trial};
use paracosm_coverage::{Deadline, Point, Space, Value, Values};
use paracosm_engine::Program;
use paracosm_generators::{Aim, DiscreteFamily, Generator, Request, Strategy};
use paracosm_scenarios as scenarios;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// How many tests an adaptive strategy is asked for at a time where nothing is said.
const ADAPTIVE_BATCH: usize = 16;

/// The version of the files that this software writes.
const FORMAT: u32 = 1;

/// A study: what is tested, the open parameters, a strategy and a budget.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Study {
    format: u32,
    version: String,
    target: String,
    /// What the tests are run on.
    #[serde(flatten)]
    pub subject: Subject,
    /// The open parameters: what the tests vary.
    pub space: Space,
    /// What is asked of every run. A system that answers with robustness has requirements that are not known here.
    pub requirements: Vec<RequirementText>,
    /// How much robustness is a lot of those that state no scale, once a campaign has learned that.
    #[serde(skip_serializing_if = "BTreeMap::is_empty", default)]
    learned_scales: BTreeMap<String, f64>,
    /// What of the operational design domain the tests are about, if anybody has said so.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub odd: Option<Odd>,
    strategy: String,
    discrete: String,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    delta: Option<f64>,
    k: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    epsilon: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    measure: Option<String>,
    skip: Option<u64>,
    seed: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    batch: Option<usize>,
    /// How many tests are run.
    pub budget: usize,
    #[serde(skip_serializing_if = "std::ops::Not::not", default)]
    stop_at_first: bool,
    /// The tests that count as done.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub extends: Option<Extension>,
}

impl Study {
    /// The study of a scenario of the catalogue with all defaults: driver `aeb`, strategy `halton`, 500 tests.
    ///
    /// # Errors
    /// There is no such scenario.
    pub fn of(scenario: &str) -> Result<Self, Error> {
        Self::new(*scenarios::find(scenario)?)
    }

    /// The study of a program, with all defaults.
    ///
    /// # Errors
    /// The program cannot be run.
    pub fn new(program: Program) -> Result<Self, Error> {
        let (simulation, space, requirements) = Simulation::new(program)?;
        Ok(Self::on(Subject::Scenario(simulation), space, requirements))
    }

    /// The study of a system that others wrote, over this space, with all defaults.
    pub fn of_system(system: BlackBox, space: Space) -> Self {
        Self::on(Subject::System(system), space, Vec::new())
    }

    fn on(subject: Subject, space: Space, requirements: Vec<RequirementText>) -> Self {
        Self {
            format: FORMAT,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            target: env!("PARACOSM_TARGET").to_owned(),
            subject,
            space,
            requirements,
            learned_scales: BTreeMap::new(),
            odd: None,
            strategy: Strategy::Halton.name().to_owned(),
            discrete: "ipog".to_owned(),
            delta: None,
            k: None,
            epsilon: None,
            measure: None,
            skip: None,
            seed: None,
            batch: None,
            budget: 500,
            stop_at_first: false,
            extends: None,
        }
    }

    /// Chooses tests by this strategy.
    ///
    /// # Errors
    /// There is no such strategy.
    pub fn strategy(mut self, name: &str) -> Result<Self, Error> {
        let strategy = name.parse::<Strategy>()?;
        self.strategy = strategy.name().to_owned();
        self.batch = strategy.is_adaptive().then_some(ADAPTIVE_BATCH);
        Ok(self)
    }

    /// Covers discrete parameters by this family of rows.
    ///
    /// # Errors
    /// There is no such family.
    pub fn discrete(mut self, family: &str) -> Result<Self, Error> {
        family.parse::<DiscreteFamily>()?;
        self.discrete = family.to_owned();
        Ok(self)
    }

    /// Lets random rows miss a combination with this probability at most; without it, with 0.05.
    pub fn delta(mut self, delta: Option<f64>) -> Self {
        self.delta = delta;
        self
    }

    /// Covers any `k` parameters together; without it, two.
    pub fn k(mut self, k: Option<usize>) -> Self {
        self.k = k;
        self
    }

    /// Runs tests until no row of discrete values has an empty box above this volume, or the budget is spent; the next
    /// test goes to the row with the largest.
    pub fn epsilon(mut self, epsilon: Option<f64>) -> Self {
        self.epsilon = epsilon;
        self
    }

    /// Makes this measure small, with the strategy `greedy`.
    ///
    /// # Errors
    /// It is none that can be aimed at.
    pub fn measure(mut self, measure: &str) -> Result<Self, Error> {
        self.measure = Some(measure.parse::<Aim>()?.name().to_owned());
        Ok(self)
    }

    /// Runs this many tests.
    ///
    /// # Errors
    /// It is 0.
    pub fn budget(mut self, tests: usize) -> Result<Self, Error> {
        if tests == 0 {
            return Err(Error::Usage("the budget is 0, expected at least 1 test".into()));
        }
        self.budget = tests;
        Ok(self)
    }

    /// Takes all chance of the strategy from this seed; without one, Halton is the plain sequence.
    pub fn seed(mut self, seed: Option<u64>) -> Self {
        self.seed = seed;
        self
    }

    /// Asks the strategy for this many tests at a time, which changes what an adaptive one proposes; without it, for 16,
    /// and an open-loop one for as many as fit in memory. To be called when the strategy is chosen.
    ///
    /// # Errors
    /// It is 0.
    pub fn batch(mut self, tests: Option<usize>) -> Result<Self, Error> {
        if tests == Some(0) {
            return Err(Error::Usage("the batch is 0, expected at least 1 test".into()));
        }
        self.batch = tests.or(self.batch);
        Ok(self)
    }

    /// Whether the strategy is after a failure, whatever it violates.
    pub(crate) fn seeks_a_failure(&self) -> Result<bool, Error> {
        Ok(self.strategy.parse::<Strategy>()?.seeks_a_failure())
    }

    /// How many tests the strategy is asked for at a time, where that matters.
    pub(crate) fn batch_size(&self) -> Option<usize> {
        self.batch
    }

    /// Starts a sequence at this index.
    pub fn skip(mut self, skip: Option<u64>) -> Self {
        self.skip = skip;
        self
    }

    /// Counts the tests in a CSV as done, so that those of the study complete them. To be called when all parameters are
    /// opened, fixed and varied.
    ///
    /// # Errors
    /// The file cannot be read, does not hold tests of the open parameters, or has other values for fixed ones: the error
    /// says in which line and why.
    pub fn extend(mut self, path: &Path) -> Result<Self, Error> {
        self.extends = Some(Extension::read(path, &self.space, self.subject.fixed())?);
        Ok(self)
    }

    /// The tests that count as done.
    ///
    /// # Errors
    /// The study was read from a file, which only says which tests they are.
    pub(crate) fn existing(&self) -> Result<Vec<Point>, Error> {
        self.extends.as_ref().map_or(Ok(Vec::new()), |extension| extension.points(&self.space))
    }

    /// The program that is run.
    ///
    /// # Errors
    /// The study is of a system that others wrote, or was read from a file and names a scenario that is not in the
    /// catalogue.
    pub fn program(&self) -> Result<Program, Error> {
        self.subject.scenario()?.program()
    }

    /// A generator of the study's tests.
    ///
    /// # Errors
    /// The strategy cannot do what is asked of it, or the tests to extend have not been read.
    pub fn generator(&self) -> Result<Box<dyn Generator>, Error> {
        let existing = self.existing()?;
        let (strategy, request) = self.request(&existing)?;
        Ok(strategy.build(&request)?)
    }

    /// A generator of the study's strategy that draws discrete values for every test rather than take the rows of a family.
    ///
    /// # Errors
    /// As [`Study::generator`].
    pub(crate) fn independent_generator(&self) -> Result<Box<dyn Generator>, Error> {
        let existing = self.existing()?;
        let (strategy, request) = self.request(&existing)?;
        Ok(strategy.build_independent(&request)?)
    }

    /// What the study's tests promise by theory; `None` where their rows are not random.
    ///
    /// # Errors
    /// As [`Study::generator`].
    pub fn promise(&self) -> Result<Option<Promise>, Error> {
        let existing = self.existing()?;
        let (strategy, request) = self.request(&existing)?;
        Promise::of(strategy, &request, self.budget as u64)
    }

    fn request<'a>(&'a self, existing: &'a [Point]) -> Result<(Strategy, Request<'a>), Error> {
        let request = Request {
            space: &self.space,
            budget: self.budget,
            seed: self.seed,
            skip: self.skip,
            discrete: self.discrete.parse::<DiscreteFamily>()?.with_delta(self.delta)?,
            k: self.k,
            epsilon: self.epsilon,
            // A campaign has to propose the same tests when it is resumed.
            deadline: Deadline::never(),
            groups: &[],
            rows: None,
            aim: self.measure.as_deref().map(str::parse).transpose()?,
            existing,
        };
        Ok((self.strategy.parse()?, request))
    }

    /// Checks that the study is written in the form that this software reads.
    pub(crate) fn check_format(&self) -> Result<(), String> {
        if self.format == FORMAT {
            return Ok(());
        }
        Err(format!(
            "found format {}, expected {FORMAT}: the campaign is of another version, {}",
            self.format, self.version
        ))
    }

    /// Whether this very software has written it, so that a replay has to give the same trace.
    pub fn is_of_this_software(&self) -> bool {
        self.version == env!("CARGO_PKG_VERSION") && self.target == env!("PARACOSM_TARGET")
    }

    /// The strategy, with its seed if it was given one.
    pub fn strategy_label(&self) -> String {
        match self.seed {
            Some(seed) => format!("{} (seed {seed})", self.strategy),
            None => self.strategy.clone(),
        }
    }

    /// How many parameters at a time the tests are to cover.
    pub fn strength(&self) -> Option<usize> {
        self.k
    }

    /// The requirement of this id, if it was known beforehand.
    pub fn requirement(&self, id: &str) -> Option<&RequirementText> {
        self.requirements.iter().find(|requirement| requirement.id == id)
    }

    /// The scales that a campaign has learned, of requirements that state none.
    pub fn learned_scales(&self) -> &BTreeMap<String, f64> {
        &self.learned_scales
    }

    /// The study with scales that a campaign has learned, and for requirements that neither state one nor are among these,
    /// the largest robustness among these trials of it.
    pub fn with_scales(mut self, learned: BTreeMap<String, f64>, trials: &[Trial]) -> Self {
        self.learned_scales = learned;
        let mut scales = Scales::of(&self);
        scales.learn(trials);
        self.learned_scales = scales.learned().clone();
        self
    }

    /// The requirement that a trial comes nearest to violating, or violates most: its id and its robustness in
    /// multiples of its scale. `None` where the trial broke or nothing was decided.
    pub fn worst<'t>(&self, trial: &'t Trial) -> Option<(&'t str, f64)> {
        let scales = Scales::of(self);
        let worth = |id: &'t str| Some((id, scales.normalised(id, trial.robustness(id)?)));
        trial.requirements().filter(|_| trial.covers()).filter_map(worth).min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The worst robustness, in multiples of the requirement's scale, stated or learned, and clipped to [-10, 10].
    pub fn objective(&self, trial: &Trial) -> Option<f64> {
        Scales::of(self).worst(trial)
    }

    /// All values of a test that its world is built of: its own and the fixed ones.
    pub fn complete(&self, test: &Values) -> Values {
        let own = test.iter().filter(|(name, _)| recorded::is_of_world(name));
        own.chain(self.subject.fixed().iter()).map(owned).collect()
    }
}

fn owned((name, value): (&str, &Value)) -> (String, Value) {
    (name.to_owned(), value.clone())
}
