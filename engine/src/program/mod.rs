//! Scenarios as functions, and the declaration that such a function makes when it is run without a test.

mod error;
mod promise;

pub use error::ProgramError;

use crate::flaw::WorldFlaw;
use crate::scenario::{Constraint, Reach, Scenario};
use crate::signal::Quantity;
use crate::stream::Sketch;
use crate::test::{Declared, Test};
use paracosm_oracles::Requirement;
use paracosm_space::{Domain, Space, Values};
use promise::Promise;
use std::any::Any;
use std::borrow::Cow;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;

/// A scenario, which is a named function from a test to a world.
///
/// ```
/// use paracosm_engine::{AutonomousVehicle, Program, RoadSegment, Scenario};
///
/// fn empty_road(s: &mut Scenario) {
///     let road = s.place(RoadSegment::new(300.0));
///     s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(10.0));
/// }
///
/// const PROGRAM: Program = Program::new("empty-road", "a car alone", empty_road);
/// assert!(PROGRAM.declare()?.parameters.is_empty());
/// # Ok::<(), paracosm_engine::ProgramError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Program {
    name: Cow<'static, str>,
    about: Cow<'static, str>,
    build: Build,
    files: Option<Files>,
    /// `true` if the program was read by running a file.
    runs_a_file: bool,
    /// The quantities that traces have in addition to those that the program asks for.
    recorded: Vec<Quantity>,
    promise: Option<Arc<Promise>>,
}

/// The files that the world of a test reads.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FilesRead {
    /// The hash of the contents of the files.
    pub hash: String,
    /// The paths of the files, as the program opens them.
    pub paths: Vec<PathBuf>,
}

/// A function that returns the files of a test.
type Reads = dyn Fn(&Values) -> Option<FilesRead> + Send + Sync;

/// The files that the worlds of a program read.
#[derive(Clone)]
struct Files {
    chosen_by: Arc<[String]>,
    reads: Arc<Reads>,
}

impl fmt::Debug for Files {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Files").field("chosen_by", &self.chosen_by).finish_non_exhaustive()
    }
}

/// The function of a program.
#[derive(Clone)]
enum Build {
    Function(fn(&mut Scenario)),
    Shared(Arc<dyn Fn(&mut Scenario) + Send + Sync>),
}

impl fmt::Debug for Build {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Build")
    }
}

/// The parameters and requirements that a program declares.
#[derive(Debug, Clone)]
pub struct Declaration {
    /// The parameters of the program, in the order of their declaration.
    pub parameters: Vec<Declared>,
    /// The constraints between the parameters.
    pub constraints: Vec<Constraint>,
    /// The requirements that the program states.
    pub requirements: Vec<Requirement>,
    /// The event that a test waits for, as a formula of streams; `None` if the situation is there from the beginning.
    pub premise: Option<String>,
    /// The duration in seconds of a run without a contact.
    pub duration: f64,
    /// The duration of a tick in seconds.
    pub dt: f64,
}

impl Declaration {
    /// Returns the test in which every parameter has its nominal value.
    pub fn nominal(&self) -> Values {
        self.parameters.iter().map(|declared| (declared.parameter.name.clone(), declared.nominal())).collect()
    }
}

/// Returns the ranges of a parameter that are no part of its values.
fn outside(declared: &Declared) -> Vec<WorldFlaw> {
    let Domain::Interval { lo, hi } = declared.parameter.domain else { return Vec::new() };
    let opens = match declared.opens {
        Some(Domain::Interval { lo, hi }) => Some([lo, hi]),
        _ => None,
    };
    let ranges = [("opens", opens), ("plausible", declared.plausible)];
    let flaw = |(what, range): (&'static str, Option<[f64; 2]>)| {
        let range = range.filter(|[least, greatest]| !(lo <= *least && least <= greatest && *greatest <= hi))?;
        Some(WorldFlaw::Outside { parameter: declared.parameter.name.clone(), what, range, domain: [lo, hi] })
    };
    ranges.into_iter().filter_map(flaw).collect()
}

/// Returns the message of a panic that was caught.
pub fn panic_message(panic: &(dyn Any + Send)) -> &str {
    let owned = panic.downcast_ref::<String>().map(String::as_str);
    owned.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message")
}

/// The most ticks that a run may have: three hours at 1 kHz. A trace is kept in memory.
const MOST_TICKS: f64 = 1e7;

impl Program {
    /// Makes a scenario from its name, its description in one line and the function that builds its world.
    pub const fn new(name: &'static str, about: &'static str, build: fn(&mut Scenario)) -> Self {
        Self {
            name: Cow::Borrowed(name),
            about: Cow::Borrowed(about),
            build: Build::Function(build),
            files: None,
            runs_a_file: false,
            recorded: Vec::new(),
            promise: None,
        }
    }

    /// Makes a scenario from a closure, which may hold data such as the contents of a file, or an interpreter.
    pub fn of(
        name: impl Into<String>,
        about: impl Into<String>,
        build: impl Fn(&mut Scenario) + Send + Sync + 'static,
    ) -> Self {
        let (name, about) = (Cow::Owned(name.into()), Cow::Owned(about.into()));
        Self {
            name,
            about,
            build: Build::Shared(Arc::new(build)),
            files: None,
            runs_a_file: false,
            recorded: Vec::new(),
            promise: None,
        }
    }

    /// Says which files the worlds read, so that a campaign is not continued after a file has changed. `reads` returns the files of a
    /// test; `None` if the test reads none. The parameters `chosen_by` choose among files.
    pub fn of_files(
        self,
        chosen_by: impl IntoIterator<Item = String>,
        reads: impl Fn(&Values) -> Option<FilesRead> + Send + Sync + 'static,
    ) -> Self {
        Self { files: Some(Files { chosen_by: chosen_by.into_iter().collect(), reads: Arc::new(reads) }), ..self }
    }

    /// Says that the program stands in a file that runs when it is read, such as a file of Python. A campaign of a stranger may name any
    /// such file, so the user has to trust the campaign.
    pub fn of_running_a_file(self) -> Self {
        Self { runs_a_file: true, ..self }
    }

    /// Returns `true` if the program stands in a file that runs when it is read.
    pub fn runs_a_file(&self) -> bool {
        self.runs_a_file
    }

    /// Returns the files that the world of a test reads; `None` if it reads none.
    pub fn files_read(&self, test: &Values) -> Option<FilesRead> {
        self.files.as_ref().and_then(|files| (files.reads)(test))
    }

    /// Returns the names of the parameters that choose among files.
    pub fn files_chosen_by(&self) -> &[String] {
        self.files.as_ref().map_or(&[], |files| &files.chosen_by)
    }

    /// Returns the program with its declaration. Then a test is an error if its world has other requirements or another tick, or if only one of
    /// the two has a premise. Otherwise, a test that omits a requirement would pass.
    pub fn keeping(&self, declaration: &Declaration) -> Self {
        Self { promise: Some(Arc::new(Promise::of(declaration))), ..self.clone() }
    }

    /// Returns the program whose traces also have these signals of the ego vehicle, as far as they are signals that are measured
    /// [on request](crate::signal::on_request). Other names change nothing.
    pub fn recording<'s>(&self, signals: impl IntoIterator<Item = &'s str>) -> Self {
        let mut recorded = self.recorded.clone();
        for name in signals {
            recorded.extend(Quantity::all().find(|one| one.name() == name).filter(|one| !recorded.contains(one)));
        }
        Self { recorded, ..self.clone() }
    }

    /// Returns the name of the scenario.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the description of the scenario in one line.
    pub fn about(&self) -> &str {
        &self.about
    }

    /// Builds the program's world in a scenario. A program that extends another program calls this first.
    pub fn build(&self, scenario: &mut Scenario) {
        match &self.build {
            Build::Function(build) => build(scenario),
            Build::Shared(build) => build(scenario),
        }
    }

    /// Runs the program without a test and returns its parameters and requirements.
    ///
    /// # Errors
    /// The parameters form no space, or the world cannot be built with nominal values: it has flaws, or the program panics.
    pub fn declare(&self) -> Result<Declaration, ProgramError> {
        let scenario = self.caught(None)?;
        let parameters = scenario.parameters.borrow().clone();
        Space::new(parameters.iter().map(|declared| declared.parameter.clone()).collect())
            .map_err(|source| ProgramError::Parameters { program: self.name().to_owned(), source })?;
        let requirements = scenario.requirements.borrow().iter().map(|stated| stated.requirement.clone()).collect();
        Ok(Declaration {
            parameters,
            constraints: scenario.constraints,
            requirements,
            premise: scenario.premise.as_ref().map(|event| event.node.to_string()),
            duration: scenario.duration,
            dt: scenario.dt,
        })
    }

    /// Checks that the program can build its world for a test.
    ///
    /// # Errors
    /// The program cannot build its world, or it asks for other parameters than the test gives.
    pub fn check<'a>(&self, test: impl Into<Test<'a>>) -> Result<(), ProgramError> {
        self.caught(Some(test.into())).map(|_| ())
    }

    /// Returns how far each parameter reaches into the world of a test, in the order of the declaration.
    ///
    /// # Errors
    /// The program cannot build its world, or it asks for other parameters than the test gives.
    pub fn reaches<'a>(&self, test: impl Into<Test<'a>>) -> Result<Vec<(String, Reach)>, ProgramError> {
        Ok(self.caught(Some(test.into()))?.reaches())
    }

    /// Returns the remarks of the program on the world of a test, for example which parts of a file have no effect.
    pub fn notes<'a>(&self, test: impl Into<Test<'a>>) -> Vec<String> {
        let mut scenario = Scenario::new(Some(&test.into()));
        scenario.notes = Some(Vec::new());
        // A program that panics has no more to say; its run ends in an error.
        let _ = catch_unwind(AssertUnwindSafe(|| self.build(&mut scenario)));
        scenario.notes.unwrap_or_default()
    }

    /// Returns the graph of the program's streams with nominal values, in the DOT language of Graphviz.
    ///
    /// # Errors
    /// The world cannot be built with nominal values.
    pub fn dot(&self) -> Result<String, ProgramError> {
        let mut scenario = Scenario::new(None);
        scenario.sketch = Some(Sketch::default());
        Ok(self.built_in(scenario, None)?.dot(self.name()))
    }

    /// Runs the program, with a test or without, and checks the world that it built.
    pub(crate) fn built(&self, test: Option<Test>) -> Result<Scenario, ProgramError> {
        self.built_in(Scenario::new(test.as_ref()), test)
    }

    /// Runs the program like [`built`](Self::built), and returns an error if it panics.
    fn caught(&self, test: Option<Test>) -> Result<Scenario, ProgramError> {
        let is_nominal = test.is_none();
        catch_unwind(AssertUnwindSafe(|| self.built(test))).unwrap_or_else(|panic| {
            let (program, message) = (self.name().to_owned(), panic_message(&*panic).to_owned());
            Err(match is_nominal {
                true => ProgramError::Panicked { program, message },
                false => ProgramError::TestPanicked { program, message },
            })
        })
    }

    fn built_in(&self, mut scenario: Scenario, test: Option<Test>) -> Result<Scenario, ProgramError> {
        self.build(&mut scenario);
        if let Some(why) = scenario.failure.take() {
            return Err(ProgramError::Failed { program: self.name().to_owned(), why });
        }
        if let Some(car) = scenario.cars.first() {
            let recorded: Vec<_> = self.recorded.iter().map(|quantity| car.record(*quantity)).collect();
            scenario.signals.extend(recorded);
        }
        // A program that refuses a test may end before it asks for all parameters.
        let is_refused =
            |scenario: &Scenario| scenario.flaws.borrow().iter().any(|flaw| matches!(flaw, WorldFlaw::Refused { .. }));
        if let Some(test) = test {
            if !is_refused(&scenario) {
                self.check_names(&scenario, test.values)?;
                self.promise.as_ref().map_or(Ok(()), |promise| promise.check(self.name(), &scenario))?;
            }
            for why in scenario.constraints.iter().filter_map(|constraint| constraint.broken(test.values)) {
                scenario.flaw(WorldFlaw::Refused { why });
            }
        }
        scenario.lay_out();
        let mut flaws = Vec::new();
        for flaw in scenario.flaws.take() {
            // A mistake that comes up on several lines with the same value counts once.
            if !flaws.contains(&flaw) {
                flaws.push(flaw);
            }
        }
        flaws.extend(scenario.parameters.borrow().iter().flat_map(outside));
        // A program that refuses a test may end before it places anything.
        let is_refused = flaws.iter().any(|flaw| matches!(flaw, WorldFlaw::Refused { .. }));
        if !is_refused && (scenario.cars.len() != 1 || scenario.networks.len() != 1) {
            let (cars, roads) = (scenario.cars.len(), scenario.networks.len());
            flaws.push(WorldFlaw::Cars { cars, roads });
        }
        if !(scenario.duration > 0.0 && scenario.duration.is_finite()) {
            flaws.push(WorldFlaw::Duration { seconds: scenario.duration });
        }
        if !(scenario.dt > 0.0 && scenario.dt <= scenario.duration) {
            flaws.push(WorldFlaw::Tick { tick: scenario.dt, run: scenario.duration });
        }
        if scenario.duration / scenario.dt > MOST_TICKS {
            flaws.push(WorldFlaw::Ticks { ticks: scenario.duration / scenario.dt, most: MOST_TICKS });
        }
        let requirements = scenario.requirements.borrow();
        for (i, stated) in requirements.iter().enumerate() {
            let id = &stated.requirement.id;
            if requirements[..i].iter().any(|other| other.requirement.id == *id) {
                flaws.push(WorldFlaw::RequirementTwice { id: id.clone() });
            }
            let scale = stated.requirement.scale;
            if !(scale > 0.0 && scale.is_finite()) {
                flaws.push(WorldFlaw::Scale { id: id.clone(), scale });
            }
            for signal in &stated.signals {
                let name = signal.to_string();
                let others = requirements[..=i].iter().flat_map(|other| &other.signals);
                if others.filter(|other| other.to_string() == name).any(|other| !other.means(signal)) {
                    flaws.push(WorldFlaw::SameName { stream: name.clone() });
                }
                if !signal.is_output() && scenario.signals.iter().any(|(output, _)| *output == name) {
                    flaws.push(WorldFlaw::NameOfOutput { stream: name });
                }
            }
        }
        drop(requirements);
        if flaws.is_empty() {
            Ok(scenario)
        } else {
            Err(ProgramError::World { program: self.name().to_owned(), flaws })
        }
    }

    fn check_names(&self, scenario: &Scenario, test: &Values) -> Result<(), ProgramError> {
        let declared = scenario.parameters.borrow();
        let asked = declared.iter().map(|declared| declared.parameter.name.as_str());
        let not_given = asked.clone().filter(|name| test.get(name).is_none());
        let not_asked = test.iter().map(|(name, _)| name).filter(|name| !asked.clone().any(|asked| asked == *name));
        let names: Vec<String> = not_given.chain(not_asked).map(str::to_owned).collect();
        if names.is_empty() {
            Ok(())
        } else {
            Err(ProgramError::OtherParameters { program: self.name().to_owned(), names })
        }
    }
}
