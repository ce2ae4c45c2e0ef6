//! Opens and fixes the parameters of a study.

use super::{Study, Subject, owned};
use crate::setting_names::is_of_camera;
use crate::{Error, Reason};
use paracosm_engine::{Declared, Test};
use paracosm_space::{Distribution, Domain, Parameter, Shape, Space, Value, Values, did_you_mean, nearest};
use thiserror::Error;

/// The greatest number of whole numbers that a parameter may be opened to.
const MOST_WHOLE: f64 = 10_000.0;

/// The variation of an open parameter over time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Variation {
    /// The parameter is constant during a test.
    Constant,
    /// The parameter has a value for every tick.
    PerTick,
    /// The parameter follows a curve over time that a few coordinates describe.
    Shape(Shape),
}

/// The reason why a parameter cannot be opened, fixed or given a distribution.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ParameterMisuse {
    /// The scenario has no parameter with the given name.
    #[error("scenario `{scenario}` has no parameter `{name}`{}; it has {}", did_you_mean(.nearest), all.join(", "))]
    Unknown {
        /// The name of the scenario.
        scenario: String,
        /// The name that no parameter of the scenario has.
        name: String,
        /// The most similar name of a parameter; `None` if no name is similar.
        nearest: Option<String>,
        /// The names of all parameters of the scenario.
        all: Vec<String>,
    },
    /// An interval was given for a parameter whose domain is a list of values.
    #[error("parameter `{name}` takes {domain}, which is not an interval")]
    NoInterval {
        /// The name of the parameter.
        name: String,
        /// The domain of the parameter, which is a list of values.
        domain: Domain,
    },
    /// The parameter was fixed twice, or fixed and opened.
    #[error("parameter `{name}` is set and opened, or set twice")]
    Twice {
        /// The name of the parameter.
        name: String,
    },
    /// The parameter was given two distributions.
    #[error("parameter `{name}` is distributed twice")]
    DistributedTwice {
        /// The name of the parameter.
        name: String,
    },
    /// The parameter is fixed, but was given a distribution.
    #[error("parameter `{name}` is fixed; --open {name} lets tests vary it")]
    Fixed {
        /// The name of the parameter.
        name: String,
    },
    /// A parameter of whole numbers is opened over more of them than a list of values may have.
    #[error(
        "parameter `{name}` takes whole numbers; {lo} to {hi} are {count:.0} of them, expected at most {MOST_WHOLE}: name fewer, \
         for example --open {name}=0..10"
    )]
    TooManyWhole {
        /// The name of the parameter.
        name: String,
        /// The least of the numbers.
        lo: f64,
        /// The greatest of the numbers.
        hi: f64,
        /// The number of the numbers.
        count: f64,
    },
    /// No parameter has a range of numbers that could be opened.
    #[error("scenario `{scenario}` has no open range with a step that could become an interval")]
    NoRange {
        /// The name of the scenario.
        scenario: String,
    },
    /// No test keeps a constraint of the scenario, because of the fixed values.
    #[error("{}no test keeps the constraint `{constraint}` with {}", place.as_ref().map(|place| format!("{place}: ")).unwrap_or_default(), values.join(", "))]
    Broken {
        /// The file and the line that state the constraint; `None` if the program itself states it.
        place: Option<String>,
        /// The text of the constraint.
        constraint: String,
        /// The fixed values in the constraint, each as `NAME = VALUE`.
        values: Vec<String>,
    },
    /// The scenario leaves no parameter open.
    #[error("scenario `{scenario}` has no open parameter, so all its tests are the same; open some of {}, for example with --open NAME=LO..HI", all.join(", "))]
    NoneOpen {
        /// The name of the scenario.
        scenario: String,
        /// The names of all parameters of the scenario.
        all: Vec<String>,
    },
    /// The parameter cannot be fixed, because no other parameter is open.
    #[error("with `{name}` fixed no parameter is left open, so there is nothing to test")]
    LastOpen {
        /// The name of the parameter.
        name: String,
    },
}

impl Reason for ParameterMisuse {}

/// Returns `true` if a parameter belongs to the world.
pub(super) fn is_of_world(name: &str) -> bool {
    !is_of_camera(name)
}

/// Returns the domain over which a parameter is opened. If the parameter takes whole numbers only, an interval stands for the
/// whole numbers in it that the parameter takes.
fn listed(declared: &Declared, domain: &Domain) -> Result<Domain, ParameterMisuse> {
    match (domain, declared.parameter.levels()) {
        (Domain::Interval { lo, hi }, Some(levels)) if declared.whole => {
            let is_within = |level: &&Value| level.number().is_some_and(|number| (lo..=hi).contains(&&number));
            Ok(Domain::Choice(levels.iter().filter(is_within).cloned().collect()))
        }
        (&Domain::Interval { lo, hi }, None) if declared.whole => {
            let count = hi.floor() - lo.ceil() + 1.0;
            if count > MOST_WHOLE {
                return Err(ParameterMisuse::TooManyWhole { name: declared.parameter.name.clone(), lo, hi, count });
            }
            Ok(Domain::Choice((0..count as usize).map(|index| Value::Number(lo.ceil() + index as f64)).collect()))
        }
        _ => Ok(domain.clone()),
    }
}

impl Study {
    /// Opens a parameter, so that tests vary it over its declared domain or over this part of it.
    pub(super) fn open(&mut self, name: &str, over: Option<&Domain>) -> Result<(), Error> {
        let parameter = match over {
            Some(domain) => self.over(name, domain)?,
            None => {
                let declared = self.find_declared(name)?;
                let mut parameter = declared.opened();
                parameter.domain = listed(&declared, &parameter.domain)?;
                parameter
            }
        };
        let fixed = &mut self.subject.scenario_mut()?.fixed;
        *fixed = fixed.iter().filter(|(key, _)| *key != name).map(owned).collect();
        self.rebuild(name, Some(parameter))
    }

    /// Returns a parameter of the scenario over a part of its domain.
    pub(super) fn over(&self, name: &str, domain: &Domain) -> Result<Parameter, Error> {
        let declared = self.find_declared(name)?;
        let (domain, ends) = match domain {
            Domain::Interval { lo, hi } => (domain.clone(), vec![Value::Number(*lo), Value::Number(*hi)]),
            Domain::Choice(levels) => {
                let levels: Vec<Value> = levels.iter().map(|level| declared.taken(level.clone())).collect();
                (Domain::Choice(levels.clone()), levels)
            }
        };
        // If the ends of an interval are in the wrong order, that is reported before they are found to lie outside.
        Space::new(vec![Parameter::new(name, domain.clone())])?;
        for end in &ends {
            declared.check(end)?;
        }
        let domain = listed(&declared, &domain)?;
        let mut parameter = declared.parameter;
        if matches!((&parameter.domain, &domain), (Domain::Choice(_), Domain::Interval { .. })) {
            return Err(ParameterMisuse::NoInterval { name: name.to_owned(), domain: parameter.domain }.into());
        }
        parameter.distribution = parameter.distribution.within(&parameter.domain, &domain);
        parameter.domain = domain;
        parameter.default = parameter.default.take().filter(|value| parameter.check(value).is_ok());
        Ok(parameter)
    }

    /// Lets an open parameter vary over time.
    pub(super) fn vary(&mut self, name: &str, variation: Variation) -> Result<(), Error> {
        let signal = match variation {
            Variation::Constant => None,
            Variation::PerTick => Some(Shape::PiecewiseConstant { pieces: self.subject.scenario()?.ticks() }),
            Variation::Shape(shape) => Some(shape),
        };
        let mut parameter = self.space.parameter(name)?.clone();
        parameter.signal = signal;
        parameter.default = parameter.default.take().filter(|value| parameter.check(value).is_ok());
        self.rebuild(name, Some(parameter))?;
        self.program()?.check(Test::new(&self.nominal()?, &self.space))?;
        Ok(())
    }

    /// Opens the parameters whose tests have only some numbers of an interval to the whole interval.
    pub(super) fn open_intervals(&mut self) -> Result<(), Error> {
        let mut opened = 0;
        for declared in self.program()?.declare()?.parameters {
            let name = declared.parameter.name.as_str();
            let is_listed = self.space.find(name).is_some_and(|open| open.levels().is_some());
            if is_listed && !declared.whole && declared.parameter.levels().is_none() {
                self.rebuild(name, Some(declared.parameter.clone()))?;
                opened += 1;
            }
        }
        if opened == 0 {
            return Err(ParameterMisuse::NoRange { scenario: self.subject.scenario()?.scenario.clone() }.into());
        }
        Ok(())
    }

    /// Fixes a parameter at a value; a signal at a value or at a list of values.
    pub(super) fn fix(&mut self, name: &str, value: Value) -> Result<(), Error> {
        let declared = self.find_declared(name)?;
        let value = declared.taken(value);
        declared.check(&value)?;
        self.rebuild(name, None)?;
        self.subject.scenario_mut()?.fixed.set(name, value);
        Ok(())
    }

    /// Gives an open parameter a distribution.
    pub(super) fn distribute(&mut self, name: &str, distribution: &Distribution) -> Result<(), Error> {
        if self.fixed().get(name).is_some() {
            return Err(ParameterMisuse::Fixed { name: name.to_owned() }.into());
        }
        self.space = self.space.clone().with_distribution(name, distribution.clone())?;
        Ok(())
    }

    /// Lets the tests vary settings of the cameras that record them. These parameters come after all other open
    /// parameters.
    pub(super) fn open_cameras(&mut self, settings: &[Parameter]) -> Result<(), Error> {
        self.space = Space::new(self.space.parameters().iter().chain(settings).cloned().collect())?;
        Ok(())
    }

    /// Returns a test with nominal values of the open parameters, and with the fixed values.
    pub(super) fn nominal(&self) -> Result<Values, Error> {
        let mut test = self.program()?.declare()?.nominal();
        for (name, value) in self.fixed().iter() {
            test.set(name, value.clone());
        }
        for parameter in self.space.parameters().iter().filter(|parameter| is_of_world(&parameter.name)) {
            test.set(parameter.name.as_str(), Declared::open(parameter.clone()).nominal());
        }
        Ok(test)
    }

    /// Replaces the open parameter with this name, and keeps the order in which the scenario declares parameters.
    fn rebuild(&mut self, name: &str, with: Option<Parameter>) -> Result<(), Error> {
        let declared = self.program()?.declare()?.parameters;
        let kept = self.space.parameters().iter().filter(|parameter| parameter.name != name).cloned();
        let mut open: Vec<Parameter> = kept.chain(with).collect();
        open.sort_by_key(|parameter| declared.iter().position(|other| other.parameter.name == parameter.name));
        self.space = Space::new(open)?;
        Ok(())
    }

    /// Checks that the program can build its world with each text that this study gives to a parameter. Only the program
    /// knows which texts make sense.
    pub(super) fn check_texts(&self) -> Result<(), Error> {
        let Subject::Scenario(simulation) = &self.subject else { return Ok(()) };
        let program = simulation.program()?;
        for declared in program.declare()?.parameters.iter().filter(|declared| declared.takes_texts) {
            let name = declared.parameter.name.as_str();
            let mut test = self.nominal()?;
            let given = test.get(name).cloned();
            let opened = self.space.find(name).and_then(Parameter::levels).map(<[Value]>::to_vec);
            for value in opened.unwrap_or_else(|| given.into_iter().collect()) {
                test.set(name, value);
                program.check(Test::new(&test, &self.space))?;
            }
        }
        Ok(())
    }

    /// Returns the remarks of the program on the worlds of the tests, for example which parts of a file have no effect. Each
    /// remark comes once. A word that the study gives a parameter, such as the name of a file, can bring further remarks.
    ///
    /// # Errors
    /// The program cannot be run.
    pub fn notes(&self) -> Result<Vec<String>, Error> {
        let Subject::Scenario(simulation) = &self.subject else { return Ok(Vec::new()) };
        let (program, nominal) = (simulation.program()?, self.nominal()?);
        let mut notes = program.notes(Test::new(&nominal, &self.space));
        for parameter in self.space.parameters().iter().filter(|parameter| is_of_world(&parameter.name)) {
            for word in parameter.levels().into_iter().flatten().filter(|level| level.word().is_some()) {
                let mut test = nominal.clone();
                test.set(parameter.name.as_str(), word.clone());
                for note in program.notes(Test::new(&test, &self.space)) {
                    if !notes.contains(&note) {
                        notes.push(note);
                    }
                }
            }
        }
        Ok(notes)
    }

    pub(super) fn find_declared(&self, name: &str) -> Result<Declared, Error> {
        let simulation = self.subject.scenario()?;
        let declared = simulation.program()?.declare()?.parameters;
        let found = declared.iter().find(|declared| declared.parameter.name == name);
        let unknown = || {
            let all: Vec<String> = declared.iter().map(|declared| declared.parameter.name.clone()).collect();
            let nearest = nearest(name, all.iter().map(String::as_str)).map(str::to_owned);
            let scenario = simulation.scenario.clone();
            ParameterMisuse::Unknown { scenario, name: name.to_owned(), nearest, all }
        };
        Ok(found.ok_or_else(unknown)?.clone())
    }
}
