//! The space of tests: named parameters, and the two ways in which a test is written.
//!
//! A test has *values* (what a scenario reads and a log keeps) and *coordinates* (what generators propose and
//! coverage measures): a number in `[0,1]` for each continuous parameter, a level index for each discrete
//! one, and as many for a parameter that varies over time as its [`Shape`] says. [`Space::decode`] and
//! [`Space::encode`] are the only way from one to the other.

mod chance;
mod text;

use crate::constraint::Constraint;
use crate::domain::{at, coordinate};
use crate::names::nearest;
use crate::rules::{Clause, Conflict, Rules, RulesError};
use crate::{Coordinate, Domain, Parameter, SpaceError, Value, Values};
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

/// A test as coordinates, in the order of the space's parameters.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Point {
    /// One coordinate in `[0,1]` for each continuous parameter; several of a signal.
    pub continuous: Vec<f64>,
    /// One level index for each discrete parameter; several of a signal.
    pub discrete: Vec<usize>,
}

/// An ordered list of parameters with distinct names, and the constraints between them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Declaration", into = "Declaration")]
pub struct Space {
    parameters: Vec<Parameter>,
    constraints: Vec<Constraint>,
}

/// A space as it is written in a file, before it is checked.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Declaration {
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    constraints: Vec<String>,
    #[serde(rename = "parameter")]
    parameters: Vec<Parameter>,
    /// What a file says of the operational design domain, which is for whoever runs tests of the space.
    #[serde(default, rename = "odd", skip_serializing)]
    _odd: IgnoredAny,
}

impl Space {
    /// A space of these parameters, in this order.
    ///
    /// # Errors
    /// Two parameters share a name, or one has no name or a domain without values.
    pub fn new(parameters: Vec<Parameter>) -> Result<Self, SpaceError> {
        for (index, parameter) in parameters.iter().enumerate() {
            if parameter.name.trim().is_empty() {
                return Err(SpaceError::Nameless(index + 1));
            }
            if parameters[..index].iter().any(|other| other.name == parameter.name) {
                return Err(SpaceError::Twice { name: parameter.name.clone() });
            }
            parameter.validate()?;
        }
        let space = Self { parameters, constraints: Vec::new() };
        // What is called as a coordinate of a signal could not be told from it in a table.
        let signals = space.coordinates().filter(|coordinate| coordinate.parameter.signal.is_some());
        for name in signals.map(|coordinate| coordinate.name()) {
            if space.parameter(&name).is_ok() {
                return Err(SpaceError::Twice { name });
            }
        }
        Ok(space)
    }

    /// The same space with these constraints besides those it has, in the language of
    /// [`constraint`](crate::constraint).
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
    /// One of them is no constraint between the discrete parameters: [`SpaceError::Constraint`] says which, where and
    /// why.
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

    /// The unit cube with coordinates `x1` to `x{dims}`: the space of a point set that came without one.
    pub fn unit_cube(dims: usize) -> Self {
        let axis = |i| Parameter::new(format!("x{i}"), Domain::Interval { lo: 0.0, hi: 1.0 });
        Self { parameters: (1..=dims).map(axis).collect(), constraints: Vec::new() }
    }

    /// The parameters in order.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// The parameter of that name.
    ///
    /// # Errors
    /// No parameter has it; the error suggests the nearest name.
    pub fn parameter(&self, name: &str) -> Result<&Parameter, SpaceError> {
        self.parameters.iter().find(|p| p.name == name).ok_or_else(|| SpaceError::Unknown {
            name: name.to_owned(),
            nearest: nearest(name, self.parameters.iter().map(|p| p.name.as_str())).map(str::to_owned),
        })
    }

    /// All coordinates of a test in the order of their parameters, which is that of a table's columns.
    pub fn coordinates(&self) -> impl Iterator<Item = Coordinate<'_>> {
        let of = |parameter| (0..Parameter::coordinates(parameter)).map(move |index| Coordinate { parameter, index });
        self.parameters.iter().flat_map(of)
    }

    /// What each coordinate of [`Point::continuous`] belongs to, in order.
    pub fn continuous(&self) -> impl Iterator<Item = Coordinate<'_>> {
        self.coordinates().filter(|coordinate| coordinate.parameter.levels().is_none())
    }

    /// What each coordinate of [`Point::discrete`] belongs to, in order.
    pub fn discrete(&self) -> impl Iterator<Item = Coordinate<'_>> {
        self.coordinates().filter(|coordinate| coordinate.parameter.levels().is_some())
    }

    /// The number of continuous coordinates.
    pub fn dims(&self) -> usize {
        self.parameters.iter().filter(|p| p.levels().is_none()).map(Parameter::coordinates).sum()
    }

    /// The number of levels of each discrete coordinate.
    pub fn levels(&self) -> Vec<usize> {
        self.discrete().filter_map(|coordinate| coordinate.parameter.levels()).map(<[Value]>::len).collect()
    }

    /// The constraints in order.
    pub fn constraints(&self) -> &[Constraint] {
        &self.constraints
    }

    /// Whether the test keeps every constraint.
    ///
    /// # Panics
    /// The point has fewer discrete coordinates than the space, or a level index beyond a choice's last.
    pub fn allows(&self, point: &Point) -> bool {
        self.constraints.iter().all(|constraint| constraint.holds(&point.discrete))
    }

    /// The clauses of each constraint, over the positions of parameters among the discrete ones.
    pub fn clauses(&self) -> Vec<Vec<Clause>> {
        self.constraints.iter().map(|constraint| constraint.clauses().to_vec()).collect()
    }

    /// What the constraints allow of the discrete parameters.
    ///
    /// # Errors
    /// No test keeps all constraints: the error names as few as possible that cannot be kept together. Or the
    /// constraints are too entangled to find out whether a test does, or at which levels.
    pub fn rules(&self) -> Result<Rules, SpaceError> {
        Rules::new(&self.levels(), &self.clauses()).map_err(|error| self.explain(error))
    }

    /// Why there are no rules, with the constraints and parameters by their names.
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

    /// The values at these coordinates.
    ///
    /// # Panics
    /// The point has another number of coordinates than the space, or a level index beyond a choice's last.
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

    /// The coordinates of these values; the inverse of [`Space::decode`].
    ///
    /// Decoding what this returns gives the very numbers that went in, if decoding gave them in the first
    /// place.
    ///
    /// # Errors
    /// A parameter is missing or unknown, or has a value outside its domain.
    pub fn encode(&self, values: &Values) -> Result<Point, SpaceError> {
        if let Some((name, _)) = values.iter().find(|(name, _)| self.parameter(name).is_err()) {
            self.parameter(name)?;
        }
        let mut point = Point::default();
        for parameter in &self.parameters {
            let value =
                values.get(&parameter.name).ok_or_else(|| SpaceError::Missing { name: parameter.name.clone() })?;
            for value in parameter.scalars(value)? {
                match &parameter.domain {
                    Domain::Interval { lo, hi } => {
                        let v = value.number().expect("checked against an interval");
                        point.continuous.push(coordinate(*lo, *hi, v));
                    }
                    Domain::Choice(_) => {
                        point.discrete.push(parameter.level(&value).expect("checked against the choice"));
                    }
                }
            }
        }
        Ok(point)
    }
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
