//! The space of tests: its named parameters and constraints, and the two ways in which a test is written.
//!
//! A test has *values* (a scenario reads them and a log keeps them) and *coordinates* (strategies propose them and
//! coverage measures use them). The coordinates are a number in `[0,1]` for each continuous parameter and a level
//! index for each discrete parameter. A parameter that varies over time has as many coordinates as its [`Shape`] says.
//! [`Space::decode`] and [`Space::encode`] are the only ways to convert one into the other.

mod chance;
mod levels;
mod text;

use crate::constraint::Constraint;
use crate::domain::{at, coordinate};
use crate::error::MOST_PARAMETERS;
use crate::names::nearest;
use crate::rules::{Clause, Conflict, Rules, RulesError};
use crate::{Coordinate, Domain, Parameter, Point, SpaceError, Value, Values, WordFlaw, word_flaw};
use levels::Levels;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};
use std::collections::HashSet;

/// An ordered list of parameters with distinct names, with constraints between the parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Declaration", into = "Declaration")]
pub struct Space {
    parameters: Vec<Parameter>,
    constraints: Vec<Constraint>,
    levels: Levels,
}

/// A space as it is written in a file. It is not checked yet.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Declaration {
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    constraints: Vec<String>,
    #[serde(rename = "parameter")]
    parameters: Vec<Parameter>,
    /// The description of the operational design domain in the file. Only programs that run tests of the space read
    /// it.
    #[serde(default, rename = "odd", skip_serializing)]
    _odd: IgnoredAny,
}

impl Space {
    /// Makes a space of the given parameters, in the given order.
    ///
    /// # Errors
    /// Two parameters share a name, or a parameter has no name, or a parameter is not valid; or there are more than
    /// 10,000 parameters.
    pub fn new(parameters: Vec<Parameter>) -> Result<Self, SpaceError> {
        if parameters.len() > MOST_PARAMETERS {
            return Err(SpaceError::TooMany { found: parameters.len() });
        }
        let mut names = HashSet::new();
        for (index, parameter) in parameters.iter().enumerate() {
            if parameter.name.trim().is_empty() {
                return Err(SpaceError::Nameless(index + 1));
            }
            if !names.insert(parameter.name.as_str()) {
                return Err(SpaceError::Twice { name: parameter.name.clone() });
            }
            if let Some((what, flaw)) = flaw_of_words(parameter) {
                return Err(SpaceError::Word { what, index: index + 1, flaw });
            }
            parameter.validate()?;
        }
        drop(names);
        let levels = Levels::of(parameters.len());
        let space = Self { parameters, constraints: Vec::new(), levels };
        // A table could not tell such a parameter apart from the coordinate of a signal that has the same name.
        let signals = space.coordinates().filter(|coordinate| coordinate.parameter.signal.is_some());
        for name in signals.map(|coordinate| coordinate.name()) {
            if space.find(&name).is_some() {
                return Err(SpaceError::Twice { name });
            }
        }
        Ok(space)
    }

    /// Returns the same space with further constraints, in the language of [`constraint`](crate::constraint).
    ///
    /// ```
    /// use paracosm_space::{Domain, Parameter, Point, Space};
    /// let lanes = Parameter::new("lanes", Domain::Choice(vec![2.into(), 4.into()]));
    /// let weather = Parameter::new("weather", Domain::Choice(vec!["clear".into(), "fog".into()]));
    /// let space = Space::new(vec![lanes, weather])?.with_constraints(["lanes == 2 implies weather != 'fog'"])?;
    /// assert!(!space.allows(&Point { continuous: vec![], discrete: vec![0, 1] }));
    /// assert!(space.allows(&Point { continuous: vec![], discrete: vec![1, 1] }));
    /// # Ok::<(), paracosm_space::SpaceError>(())
    /// ```
    ///
    /// # Errors
    /// A text is not a constraint between the parameters. [`SpaceError::Constraint`] says which text, where
    /// and why.
    pub fn with_constraints(mut self, texts: impl IntoIterator<Item = impl AsRef<str>>) -> Result<Self, SpaceError> {
        for text in texts {
            let text = text.as_ref();
            let constraint = Constraint::new(text, &self.parameters).map_err(|error| {
                let (index, text) = (self.constraints.len(), text.to_owned());
                SpaceError::Constraint { index, text, error, at: None }
            })?;
            self.constraints.push(constraint);
        }
        Ok(self)
    }

    /// Makes the unit cube as a space with the parameters `x1` to `x{dims}`. It serves a set of points that has no
    /// space of its own.
    pub fn unit_cube(dims: usize) -> Self {
        let axis = |i| Parameter::new(format!("x{i}"), Domain::Interval { lo: 0.0, hi: 1.0 });
        Self { parameters: (1..=dims).map(axis).collect(), constraints: Vec::new(), levels: Levels::of(dims) }
    }

    /// Returns the space of the discrete parameters, with the constraints that mention no other parameter.
    pub fn discrete_part(&self) -> Self {
        let discrete = self.parameters.iter().filter(|parameter| parameter.levels().is_some()).cloned().collect();
        let part = Self::new(discrete).expect("some parameters of a space are a space");
        let own =
            |part: Self, constraint: &Constraint| part.clone().with_constraints([constraint.text()]).unwrap_or(part);
        self.constraints.iter().fold(part, own)
    }

    /// Returns the parameters of the space in their order.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Returns the parameter with the given name, if the space has it. Unlike [`Space::parameter`] it looks for no
    /// similar name.
    pub fn find(&self, name: &str) -> Option<&Parameter> {
        self.parameters.iter().find(|parameter| parameter.name == name)
    }

    /// Returns the parameter with the given name.
    ///
    /// # Errors
    /// No parameter has the name. The error suggests the nearest name.
    pub fn parameter(&self, name: &str) -> Result<&Parameter, SpaceError> {
        self.find(name).ok_or_else(|| SpaceError::Unknown {
            name: name.to_owned(),
            nearest: nearest(name, self.parameters.iter().map(|p| p.name.as_str())).map(str::to_owned),
        })
    }

    /// Returns all coordinates of a test of the space, in the order of their parameters. The columns of a table have
    /// the same order.
    pub fn coordinates(&self) -> impl Iterator<Item = Coordinate<'_>> {
        let of = |parameter| (0..Parameter::coordinates(parameter)).map(move |index| Coordinate { parameter, index });
        self.parameters.iter().flat_map(of)
    }

    /// Returns the coordinates of the continuous parameters, in the order of [`Point::continuous`].
    pub fn continuous(&self) -> impl Iterator<Item = Coordinate<'_>> {
        self.coordinates().filter(|coordinate| coordinate.parameter.levels().is_none())
    }

    /// Returns the coordinates of the discrete parameters, in the order of [`Point::discrete`].
    pub fn discrete(&self) -> impl Iterator<Item = Coordinate<'_>> {
        self.coordinates().filter(|coordinate| coordinate.parameter.levels().is_some())
    }

    /// Returns the number of continuous coordinates of a test.
    pub fn dims(&self) -> usize {
        self.parameters.iter().filter(|p| p.levels().is_none()).map(Parameter::coordinates).sum()
    }

    /// Returns the number of levels of each discrete coordinate of a test.
    pub fn levels(&self) -> Vec<usize> {
        self.discrete().filter_map(|coordinate| coordinate.parameter.levels()).map(<[Value]>::len).collect()
    }

    /// Returns the constraints of the space in their order.
    pub fn constraints(&self) -> &[Constraint] {
        &self.constraints
    }

    /// Returns `true` if the test at the given point keeps every constraint of the space.
    ///
    /// # Panics
    /// The point has fewer coordinates than the space, or a level index is not below the number of levels.
    pub fn allows(&self, point: &Point) -> bool {
        self.broken(point).is_none()
    }

    /// Returns the first constraint of the space that the test at the given point breaks.
    ///
    /// # Panics
    /// The point has fewer coordinates than the space, or a level index is not below the number of levels.
    pub fn broken(&self, point: &Point) -> Option<&Constraint> {
        self.constraints.iter().find(|constraint| !constraint.allows(point))
    }

    /// Returns the first constraint of the space that a test breaks with its numbers as they are written. The point of the test may be a
    /// rounding error away from them.
    ///
    /// # Errors
    /// A parameter is missing or unknown, or has a value outside its domain.
    pub fn broken_as_written(&self, test: &Values) -> Result<Option<&Constraint>, SpaceError> {
        let row = self.encode(test)?.discrete;
        Ok(self.constraints.iter().find(|constraint| !constraint.allows_written(&row, test)))
    }

    /// Returns `true` if the levels of a test do not decide whether the test keeps the constraints, so that each test has to be
    /// checked. This is so if a constraint names a continuous parameter.
    pub fn checks_each_test(&self) -> bool {
        self.constraints.iter().any(Constraint::checks_each_test)
    }

    /// Returns whether the tests of a part of the space keep every constraint: those with the levels in `row`, and with
    /// continuous coordinates from `lower` to `upper`. Returns `None` if some of them may keep the constraints and others not.
    /// If the answer is not `None`, it is certain, except for
    /// tests in which parameters are equal that must not be: such tests have no volume.
    ///
    /// # Panics
    /// The part has fewer coordinates than the space, or a level index is not below the number of levels.
    pub fn allows_part(&self, row: &[usize], lower: &[f64], upper: &[f64]) -> Option<bool> {
        let mut all = Some(true);
        for constraint in &self.constraints {
            match constraint.allows_part(row, lower, upper) {
                Some(true) => {}
                Some(false) => return Some(false),
                None => all = None,
            }
        }
        all
    }

    /// Returns the clauses of each constraint of the space. A literal names a parameter by its position among the
    /// discrete coordinates.
    pub fn clauses(&self) -> Vec<Vec<Clause>> {
        self.constraints.iter().map(|constraint| constraint.clauses().to_vec()).collect()
    }

    /// Returns the rules that the constraints imply for the discrete parameters.
    ///
    /// # Errors
    /// No test keeps all constraints: the error names a conflict among them that is as small as possible. Or the
    /// search for a test, or for the levels that tests can have, exceeds its bounds.
    pub fn rules(&self) -> Result<Rules, SpaceError> {
        Rules::new(&self.levels(), &self.clauses()).map_err(|error| self.explain(error))
    }

    /// Converts an error of the rules, so that it shows the constraints as texts and the parameters by name.
    pub(crate) fn explain(&self, error: RulesError) -> SpaceError {
        match error {
            RulesError::Conflict(Conflict { constraints, smallest }) => {
                let written = |index: usize| (index, self.constraints[index].text().to_owned());
                SpaceError::Conflict { constraints: constraints.into_iter().map(written).collect(), smallest }
            }
            RulesError::Undecided(parameters) => {
                let names: Vec<String> = self.discrete().map(|coordinate| coordinate.name()).collect();
                SpaceError::Undecided(parameters.into_iter().map(|parameter| names[parameter].clone()).collect())
            }
        }
    }

    /// Returns the parameter values of the test with the given coordinates.
    ///
    /// # Panics
    /// The point has another number of coordinates than the space, or a level index is not below the number of levels.
    pub fn decode(&self, point: &Point) -> Values {
        let mut continuous = point.continuous.iter();
        let mut discrete = point.discrete.iter();
        let mut scalar = |domain: &Domain| match domain {
            Domain::Interval { lo, hi } => {
                let u = continuous.next().expect("a number for every continuous coordinate");
                Value::Number(at(*lo, *hi, *u))
            }
            Domain::Choice(levels) => levels[*discrete.next().expect("a level for every discrete coordinate")].clone(),
        };
        let values = self.parameters.iter().map(|parameter| {
            let value = match parameter.signal {
                None => scalar(&parameter.domain),
                Some(shape) => Value::List((0..shape.coordinates()).map(|_| scalar(&parameter.domain)).collect()),
            };
            (parameter.name.clone(), value)
        });
        let values = values.collect();
        assert!(continuous.next().is_none() && discrete.next().is_none(), "more coordinates than parameters");
        values
    }

    /// Returns the coordinates of the test with the given parameter values. This is the inverse of [`Space::decode`].
    ///
    /// If the values come from [`Space::decode`], then decoding the result gives exactly the same values.
    ///
    /// # Errors
    /// A parameter is missing or unknown, or has a value outside its domain.
    pub fn encode(&self, values: &Values) -> Result<Point, SpaceError> {
        if let Some((name, _)) = values.iter().find(|(name, _)| self.parameter(name).is_err()) {
            self.parameter(name)?;
        }
        let mut point = Point::default();
        for (position, parameter) in self.parameters.iter().enumerate() {
            let value =
                values.get(&parameter.name).ok_or_else(|| SpaceError::Missing { name: parameter.name.clone() })?;
            match &parameter.domain {
                Domain::Interval { lo, hi } => {
                    for value in parameter.scalars(value)? {
                        let v = value.number().expect("checked against an interval");
                        point.continuous.push(coordinate(*lo, *hi, v));
                    }
                }
                Domain::Choice(_) => {
                    let level = |value: &Value| self.levels.level(position, parameter, value);
                    let found: Option<Vec<usize>> = match value {
                        Value::List(values) if parameter.signal.is_some() => values.iter().map(level).collect(),
                        value => level(value).map(|level| vec![level; parameter.coordinates()]),
                    };
                    match found.filter(|levels| levels.len() == parameter.coordinates()) {
                        Some(levels) => point.discrete.extend(levels),
                        None => return Err(parameter.check(value).expect_err("a value without a level").into()),
                    }
                }
            }
        }
        Ok(point)
    }

    /// Returns the values of a test in the order of the parameters, and levels as the space writes them. Numbers stay exactly as they are,
    /// which the way through [`encode`](Self::encode) and [`decode`](Self::decode) does not promise.
    ///
    /// # Errors
    /// A parameter is missing or unknown, or has a value outside its domain.
    pub fn as_written(&self, test: &Values) -> Result<Values, SpaceError> {
        let decoded = self.decode(&self.encode(test)?);
        let written = self.parameters.iter().zip(decoded.iter()).map(|(parameter, (name, decoded))| {
            let is_continuous = parameter.levels().is_none() && parameter.signal.is_none();
            let number = test.get(name).and_then(Value::number).filter(|_| is_continuous);
            (name.to_owned(), number.map_or_else(|| decoded.clone(), Value::Number))
        });
        Ok(written.collect())
    }
}

/// Returns the first word among the name and the values of a parameter that tables and pictures cannot show.
fn flaw_of_words(parameter: &Parameter) -> Option<(&'static str, WordFlaw)> {
    let values = match &parameter.domain {
        Domain::Choice(values) => values.as_slice(),
        Domain::Interval { .. } => &[],
    };
    let words = values.iter().filter_map(|value| match value {
        Value::Word(word) => Some(("a value", word)),
        _ => None,
    });
    let mut words = [("the name", &parameter.name)].into_iter().chain(words);
    words.find_map(|(what, word)| word_flaw(word).map(|flaw| (what, flaw)))
}

impl TryFrom<Declaration> for Space {
    type Error = SpaceError;

    fn try_from(declaration: Declaration) -> Result<Self, SpaceError> {
        Self::new(declaration.parameters)?.with_constraints(declaration.constraints)
    }
}

impl From<Space> for Declaration {
    fn from(space: Space) -> Self {
        let constraints = space.constraints.iter().map(|constraint| constraint.text().to_owned()).collect();
        Self { constraints, parameters: space.parameters, _odd: IgnoredAny }
    }
}

#[cfg(test)]
mod tests;
