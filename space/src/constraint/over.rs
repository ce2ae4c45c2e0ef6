//! Constraints on tests whose levels do not decide them: the check of one test, and of a part of the space.

use super::condition::{Condition, Resolver};
use super::span::Span;
use super::truth::{Known, truth};
use super::{ConstraintError, Expression, parse, table};
use crate::domain::at;
use crate::{Domain, Parameter, Point, Value, Values};

/// The parameters of a constraint, with their places in a test.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Over(Vec<(String, Place)>);

/// The place of a parameter in a test.
#[derive(Debug, Clone, PartialEq)]
enum Place {
    /// The position among the continuous coordinates, with the interval of the parameter.
    Continuous { position: usize, lo: f64, hi: f64 },
    /// The position among the discrete coordinates, with the levels of the parameter.
    Discrete { position: usize, levels: Vec<Value> },
}

impl Over {
    /// Finds the parameters that an expression names. None of them varies over time.
    pub fn new(expression: &Expression, parameters: &[Parameter]) -> Self {
        let names = expression.names();
        let (mut continuous, mut discrete) = (0, 0);
        let mut places = Vec::new();
        for parameter in parameters {
            let before = if parameter.levels().is_some() { &mut discrete } else { &mut continuous };
            let position = *before;
            *before += parameter.coordinates();
            if names.contains(&parameter.name.as_str()) {
                let place = match &parameter.domain {
                    Domain::Interval { lo, hi } => Place::Continuous { position, lo: *lo, hi: *hi },
                    Domain::Choice(levels) => Place::Discrete { position, levels: levels.clone() },
                };
                places.push((parameter.name.clone(), place));
            }
        }
        Self(places)
    }

    /// Returns the condition on the levels that the expression implies, and whether the condition decides the expression.
    pub fn condition(
        &self,
        expression: &Expression,
        parameters: &[Parameter],
    ) -> Result<(Condition, bool), ConstraintError> {
        let named = |parameter: &&Parameter| self.0.iter().any(|(name, _)| *name == parameter.name);
        let discrete: Vec<&Parameter> =
            parameters.iter().filter(named).filter(|parameter| parameter.levels().is_some()).collect();
        let is_exact = discrete.len() == self.0.len();
        let holds = |values: &[&Value]| {
            let known = |name: &str| {
                if let Some(at) = discrete.iter().position(|parameter| parameter.name == name) {
                    return Some(Known::of(values[at]));
                }
                self.0.iter().find(|(known, _)| known == name).and_then(|(_, place)| match place {
                    Place::Continuous { lo, hi, .. } => Some(Known::Quantity(Span { lo: *lo, hi: *hi })),
                    Place::Discrete { .. } => None,
                })
            };
            let exact = |name: &str| {
                discrete.iter().position(|parameter| parameter.name == name).map(|at| Known::<f64>::of(values[at]))
            };
            if is_exact { truth(expression, &exact) == Some(true) } else { truth(expression, &known) != Some(false) }
        };
        if discrete.is_empty() && !holds(&[]) {
            return Ok((Condition::NEVER, is_exact));
        }
        let Some(written) = table::expressions(&discrete, holds) else { return Ok((Condition::ALWAYS, false)) };
        let mut parts = Vec::new();
        for part in written {
            let (part, places) = parse::parse(&part.to_string())?;
            parts.push(Resolver::new(parameters, &places).resolve(&part)?);
        }
        Ok((Condition::many(true, parts), is_exact))
    }

    /// Returns `true` if a test keeps the expression.
    pub fn allows(&self, expression: &Expression, point: &Point) -> bool {
        let known = |name: &str| {
            Some(match self.place(name)? {
                Place::Continuous { position, lo, hi } => Known::Quantity(at(*lo, *hi, point.continuous[*position])),
                Place::Discrete { position, levels } => Known::of(&levels[point.discrete[*position]]),
            })
        };
        truth(expression, &known) == Some(true)
    }

    /// Returns `true` if a test keeps the expression with its numbers as they are written: the coordinates of a point may be a rounding error
    /// away from them.
    pub fn allows_written(&self, expression: &Expression, test: &Values) -> bool {
        let known = |name: &str| {
            self.place(name)?;
            Some(Known::<f64>::of(test.get(name)?))
        };
        truth(expression, &known) == Some(true)
    }

    /// Returns whether the tests of a part of the space keep the expression; `None` if this is not certain for all of them.
    pub fn part(&self, expression: &Expression, row: &[usize], lower: &[f64], upper: &[f64]) -> Option<bool> {
        let known = |name: &str| {
            Some(match self.place(name)? {
                Place::Continuous { position, lo, hi } => {
                    let end = |coordinates: &[f64]| at(*lo, *hi, coordinates[*position]);
                    Known::Quantity(Span { lo: end(lower), hi: end(upper) })
                }
                Place::Discrete { position, levels } => Known::of(&levels[row[*position]]),
            })
        };
        truth(expression, &known)
    }

    fn place(&self, name: &str) -> Option<&Place> {
        self.0.iter().find(|(known, _)| known == name).map(|(_, place)| place)
    }
}
