//! A scenario as the function that it is, and what it declares when it is run without a test.

use crate::scenario::Scenario;
use crate::sensor::{hashed, mixed};
use paracosm_coverage::{Domain, Parameter, Shape, Space, SpaceError, Value, Values};
use paracosm_oracles::Requirement;
use thiserror::Error;

/// A scenario: a named function from a test to a world.
#[derive(Debug, Clone, Copy)]
pub struct Program {
    /// The name by which it is called.
    pub name: &'static str,
    /// What it is about, in one line.
    pub about: &'static str,
    /// The function.
    pub build: fn(&mut Scenario),
}

/// A parameter that a program asks for.
#[derive(Debug, Clone, PartialEq)]
pub struct Declared {
    /// Name, domain, unit and nominal value.
    pub parameter: Parameter,
    /// Whether a test varies it where a study says nothing else.
    pub open: bool,
}

impl Declared {
    /// Its nominal value; the middle of an interval or the first level of a choice where none is declared.
    pub fn nominal(&self) -> Value {
        self.parameter.default.clone().unwrap_or_else(|| match &self.parameter.domain {
            Domain::Interval { lo, hi } => Value::Number(0.5 * (lo + hi)),
            // A choice of nothing is refused as soon as the program has returned.
            Domain::Choice(levels) => levels.first().cloned().unwrap_or(Value::Number(f64::NAN)),
        })
    }
}

/// What a program asks for and asks of its runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Declaration {
    /// Its parameters in the order in which it asks for them.
    pub parameters: Vec<Declared>,
    /// Its requirements.
    pub requirements: Vec<Requirement>,
    /// How long a run takes unless a contact ends it, in seconds.
    pub duration: f64,
    /// How long a tick is, in seconds.
    pub dt: f64,
}

/// The values that a test gives to all parameters of a program, and how those vary that do.
///
/// Mere values are a test too: their parameters vary as the program declares.
#[derive(Debug, Clone, Copy)]
pub struct Test<'a> {
    pub(crate) values: &'a Values,
    space: Option<&'a Space>,
}

impl<'a> Test<'a> {
    /// These values, of which those of the parameters of `space` vary as it says.
    pub fn new(values: &'a Values, space: &'a Space) -> Self {
        Self { values, space: Some(space) }
    }

    /// A number that another test hardly has: a hash of the values by their names, whatever their order.
    pub(crate) fn key(&self) -> u64 {
        self.values.iter().map(|(name, value)| entry(name, value)).fold(0, u64::wrapping_add)
    }

    /// How a parameter varies, if the test says so.
    pub(crate) fn signal(&self, name: &str) -> Option<Option<Shape>> {
        self.space?.parameter(name).ok().map(|parameter| parameter.signal)
    }
}

impl<'a> From<&'a Values> for Test<'a> {
    fn from(values: &'a Values) -> Self {
        Self { values, space: None }
    }
}

/// What a value adds to the key of its test.
pub(crate) fn entry(name: &str, value: &Value) -> u64 {
    let scalar = |hash: u64, value: &Value| {
        let bits = value.number().map_or_else(|| hashed(&value.to_string()), f64::to_bits);
        mixed(hash ^ bits)
    };
    value.scalars().iter().fold(hashed(name), scalar)
}

impl Declaration {
    /// The test in which every parameter has its nominal value.
    pub fn nominal(&self) -> Values {
        self.parameters.iter().map(|declared| (declared.parameter.name.clone(), declared.nominal())).collect()
    }
}

/// Why a program cannot be run.
#[derive(Debug, Error, PartialEq)]
pub enum ProgramError {
    /// Its parameters form no space.
    #[error("scenario `{program}`: {source}")]
    Parameters {
        /// The scenario.
        program: &'static str,
        /// What is wrong with them.
        source: SpaceError,
    },
    /// Its world cannot be built.
    #[error("scenario `{program}`: {}", problems.join("; "))]
    World {
        /// The scenario.
        program: &'static str,
        /// What is wrong with it.
        problems: Vec<String>,
    },
    /// It asks for other parameters with a test than without.
    #[error("scenario `{program}` asked for other parameters than it was given: {}", names.join(", "))]
    OtherParameters {
        /// The scenario.
        program: &'static str,
        /// The parameters that are on one side only.
        names: Vec<String>,
    },
}

/// The most ticks that a run may have: three hours at 1 kHz. A trace is kept in memory.
const MOST_TICKS: f64 = 1e7;

impl Program {
    /// Runs the program without a test: what parameters and requirements it has.
    ///
    /// # Errors
    /// The parameters form no space, or the world cannot be built with nominal values.
    pub fn declare(&self) -> Result<Declaration, ProgramError> {
        let scenario = self.built(None)?;
        let parameters = scenario.parameters.borrow().clone();
        Space::new(parameters.iter().map(|declared| declared.parameter.clone()).collect())
            .map_err(|source| ProgramError::Parameters { program: self.name, source })?;
        let requirements = scenario.requirements.borrow().iter().map(|stated| stated.requirement.clone()).collect();
        Ok(Declaration { parameters, requirements, duration: scenario.duration, dt: scenario.dt })
    }

    /// Checks that the program can build its world for this test.
    ///
    /// # Errors
    /// It cannot.
    pub fn check<'a>(&self, test: impl Into<Test<'a>>) -> Result<(), ProgramError> {
        self.built(Some(test.into())).map(|_| ())
    }

    /// The graph of its streams with nominal values, in the DOT language of Graphviz.
    ///
    /// # Errors
    /// The world cannot be built with nominal values.
    pub fn dot(&self) -> Result<String, ProgramError> {
        Ok(self.built(None)?.dot(self.name))
    }

    /// Runs the program, with a test or without, and checks what it built.
    pub(crate) fn built(&self, test: Option<Test>) -> Result<Scenario, ProgramError> {
        let mut scenario = Scenario::new(test.as_ref());
        (self.build)(&mut scenario);
        if let Some(test) = test {
            self.check_names(&scenario, test.values)?;
        }
        scenario.lay_out();
        let mut problems = Vec::new();
        for problem in scenario.problems.take() {
            // The same mistake on every line that uses the same value is one mistake.
            if !problems.contains(&problem) {
                problems.push(problem);
            }
        }
        if scenario.cars.len() != 1 || scenario.networks.len() != 1 {
            let (cars, roads) = (scenario.cars.len(), scenario.networks.len());
            problems.push(format!("{cars} cars under test on {roads} roads, expected one on one"));
        }
        if !(scenario.duration > 0.0 && scenario.duration.is_finite()) {
            problems.push(format!("a run takes {} s, expected a positive number", scenario.duration));
        }
        if !(scenario.dt > 0.0 && scenario.dt <= scenario.duration) {
            problems.push(format!(
                "a tick takes {} s, expected a positive number up to the run's {}",
                scenario.dt, scenario.duration
            ));
        }
        if scenario.duration / scenario.dt > MOST_TICKS {
            problems.push(format!(
                "a run has {:.0} ticks, expected at most {MOST_TICKS:.0}",
                scenario.duration / scenario.dt
            ));
        }
        let requirements = scenario.requirements.borrow();
        for (i, stated) in requirements.iter().enumerate() {
            let id = &stated.requirement.id;
            if requirements[..i].iter().any(|other| other.requirement.id == *id) {
                problems.push(format!("requirement `{id}` is stated twice"));
            }
            for signal in &stated.signals {
                let name = signal.to_string();
                let others = requirements[..=i].iter().flat_map(|other| &other.signals);
                if others.filter(|other| other.to_string() == name).any(|other| !other.means(signal)) {
                    problems.push(format!(
                        "two streams that requirements speak of are called `{name}`: tell them apart by `named`"
                    ));
                }
                if !signal.is_output() && scenario.signals.iter().any(|(output, _)| *output == name) {
                    problems.push(format!("a stream is called `{name}`, which is the name of an object's output"));
                }
            }
        }
        drop(requirements);
        if problems.is_empty() { Ok(scenario) } else { Err(ProgramError::World { program: self.name, problems }) }
    }

    fn check_names(&self, scenario: &Scenario, test: &Values) -> Result<(), ProgramError> {
        let declared = scenario.parameters.borrow();
        let asked = declared.iter().map(|declared| declared.parameter.name.as_str());
        let not_given = asked.clone().filter(|name| test.get(name).is_none());
        let not_asked = test.iter().map(|(name, _)| name).filter(|name| !asked.clone().any(|asked| asked == *name));
        let names: Vec<String> = not_given.chain(not_asked).map(str::to_owned).collect();
        if names.is_empty() { Ok(()) } else { Err(ProgramError::OtherParameters { program: self.name, names }) }
    }
}
