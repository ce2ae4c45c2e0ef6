//! The tests that a page asks for: a test of the campaign by its index, or a new test by its numbers.

use paracosm_campaign::{Error, Log, Reason, Trial, Worker};
use paracosm_engine::Run;
use paracosm_oracles::Trace;
use paracosm_space::{Domain, Parameter, Space, SpaceError, Value, Values, plural};
use serde::Deserialize;
use thiserror::Error;

/// A test that the page asks for.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(untagged)]
pub(super) enum Wanted {
    /// The test of the campaign with this index.
    Logged(usize),
    /// A new test, with a number for each coordinate: the value, or the position of the level.
    New(Vec<f64>),
}

/// The error that the page asks for a test that does not exist.
#[derive(Debug, Clone, PartialEq, Error)]
pub(super) enum NoTest {
    #[error("the campaign has {}, and no test {index}", plural(*tests, "test"))]
    Index { index: usize, tests: usize },
    #[error("found {}, expected {expected}: one for each coordinate", plural(*found, "number"))]
    Count { found: usize, expected: usize },
    #[error("`{name}`: no level has the position {position}")]
    Level { name: String, position: f64 },
    #[error("the test breaks the constraint `{constraint}`")]
    Broken { constraint: String },
    #[error(transparent)]
    Space(#[from] SpaceError),
}

impl Reason for NoTest {}

impl Wanted {
    /// Returns `true` if `log` is enough to run the test.
    pub fn is_in(&self, log: &Log) -> bool {
        matches!(self, Self::New(_)) || self.logged(log).is_some()
    }

    /// Returns the test of the campaign as its log has it; `None` for a new test, or if the log does not have the test.
    pub fn logged<'l>(&self, log: &'l Log) -> Option<&'l Trial> {
        match self {
            Self::Logged(index) => log.trials().get(*index),
            Self::New(_) => None,
        }
    }

    /// Runs the test, which `log` has if it is a test of the campaign. `see` gets the run whenever the driver is asked, and at the end.
    ///
    /// # Errors
    /// There is no such test; or the flag of the worker's supervision was set.
    pub fn run(&self, worker: &mut Worker, log: &Log, see: impl FnMut(&Run)) -> Result<(Trial, Option<Trace>), Error> {
        match self {
            Self::New(numbers) => {
                let test = test_of(worker.study().space(), numbers)?;
                Ok(worker.watch(0, &test, see))
            }
            Self::Logged(index) => {
                let tests = log.trials().len();
                let logged = log.trials().get(*index).ok_or(NoTest::Index { index: *index, tests })?;
                Ok(worker.replay(log, logged, see))
            }
        }
    }
}

/// Returns the test with these numbers for the coordinates of a space.
pub(super) fn test_of(space: &Space, numbers: &[f64]) -> Result<Values, Error> {
    let expected = space.coordinates().count();
    if numbers.len() != expected {
        return Err(NoTest::Count { found: numbers.len(), expected }.into());
    }
    let mut left = numbers.iter();
    let mut scalar = |name: &str, domain: &Domain| {
        let number = *left.next().expect("they were counted");
        match domain {
            Domain::Interval { .. } => Ok(Value::Number(number)),
            Domain::Choice(levels) => {
                let is_position = number >= 0.0 && number.fract() == 0.0;
                let level = is_position.then(|| levels.get(number as usize)).flatten();
                level.cloned().ok_or_else(|| NoTest::Level { name: name.to_owned(), position: number })
            }
        }
    };
    let mut values = Vec::new();
    for parameter in space.parameters() {
        let (name, domain) = (&parameter.name, &parameter.domain);
        let value = match parameter.signal {
            None => scalar(name, domain)?,
            Some(shape) => {
                Value::List((0..shape.coordinates()).map(|_| scalar(name, domain)).collect::<Result<_, _>>()?)
            }
        };
        values.push((name.clone(), value));
    }
    let test: Values = values.into_iter().collect();
    let point = space.encode(&test).map_err(NoTest::from)?;
    match space.broken(&point) {
        Some(constraint) => Err(NoTest::Broken { constraint: constraint.text().to_owned() }.into()),
        None => Ok(test),
    }
}

/// Returns the numbers of a test, from which [`test_of`] makes the test.
pub(super) fn numbers_of(space: &Space, test: &Values) -> Vec<f64> {
    let of_parameter = |parameter: &Parameter| {
        let scalars = test.get(&parameter.name).and_then(|value| parameter.scalars(value).ok()).unwrap_or_default();
        let number = |scalar: Value| match &parameter.domain {
            Domain::Interval { .. } => scalar.number().unwrap_or(f64::NAN),
            Domain::Choice(levels) => {
                levels.iter().position(|level| level.means(&scalar)).map_or(f64::NAN, |at| at as f64)
            }
        };
        scalars.into_iter().map(number).collect::<Vec<_>>()
    };
    space.parameters().iter().flat_map(of_parameter).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_a_test_if_they_lie_in_the_space_and_keep_its_constraints() {
        let speed = Parameter::new("speed", Domain::Interval { lo: 0.0, hi: 10.0 });
        let levels = [2.0, 4.0].map(Value::Number).to_vec();
        let lanes = Parameter::new("lanes", Domain::Choice(levels));
        let space = Space::new(vec![speed, lanes]).unwrap().with_constraints(["lanes == 4 or speed < 5"]).unwrap();
        let test = test_of(&space, &[0.1 + 0.2, 0.0]).unwrap();
        assert_eq!(
            (test.get("speed"), test.get("lanes")),
            (Some(&Value::Number(0.1 + 0.2)), Some(&Value::Number(2.0)))
        );
        assert_eq!(numbers_of(&space, &test), [0.1 + 0.2, 0.0]);
        for (numbers, says) in [
            (vec![1.0], "found 1 number, expected 2: one for each coordinate"),
            (vec![1.0, 2.0], "`lanes`: no level has the position 2"),
            (vec![1.0, -1.0], "`lanes`: no level has the position -1"),
            (vec![1.0, f64::NAN], "`lanes`: no level has the position NaN"),
            (vec![11.0, 0.0], "parameter `speed`: found 11, expected a number in [0, 10]"),
            (vec![f64::NAN, 0.0], "parameter `speed`: found NaN, expected a number in [0, 10]"),
            (vec![6.0, 0.0], "the test breaks the constraint `lanes == 4 or speed < 5`"),
        ] {
            assert_eq!(test_of(&space, &numbers).unwrap_err().to_string(), says);
        }
    }
}
