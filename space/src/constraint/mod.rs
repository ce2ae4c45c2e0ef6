//! Constraints: statements about the parameters that every test has to keep.
//!
//! The language compares parameters with `== != < <= > >=` and `in [..]`. It joins comparisons with `not`, `and`,
//! `or`, `implies` and parentheses. `not` binds most tightly and `implies` least. `a implies b implies c` means `a
//! implies (b implies c)`, and `a not in [..]` means `not a in [..]`:
//!
//! ```
//! # for text in [
//! "lanes == 2 implies weather not in ['fog', 'snow']",
//! "[road surface] == 'ice' implies (tyres == 'winter' or speed_limit <= 30)",
//! "not (front_gap < rear_gap and lanes != 2)",
//! "ego_speed - lead_speed >= max(10, 0.2 * ego_speed)",
//! # ] { text.parse::<paracosm_space::constraint::Expression>()?; }
//! # Ok::<(), paracosm_space::constraint::ConstraintError>(())
//! ```
//!
//! A number is written as it is, a word in single or double quotes. The name of a parameter needs no brackets if it
//! consists of letters, digits, `_` and `.`, does not begin with a digit and is no word of the language. Any name may
//! stand in brackets: `[road surface] == 'wet'`. In quotes and brackets, a backslash takes the next character
//! literally. Words are compared with their case. `<`, `<=`, `>` and `>=` compare numbers only: a parameter whose
//! levels are all numbers is compared with a number or with another such parameter. `==`, `!=` and `in` refuse a value
//! that the parameter never takes, since such a comparison is a mistake.
//!
//! Numbers are computed with `+ - * / %`, parentheses, and the functions `min`, `max`, `abs`, `sqrt`, `pow`, `floor`, `ceil`,
//! `round`, `sign`, `sin`, `cos`, `tan`, `asin`, `acos` and `atan`, with angles in radians. A comparison with a number that
//! has no value (a division by zero, the root of a negative number, a number that is not finite) does not hold.
//!
//! A constraint may name continuous parameters, but must not demand an equation with one (`==`, `in`, `not a != b`): hardly any
//! test would keep such a constraint. The levels of the discrete parameters do not decide a constraint on continuous parameters, so
//! [`Constraint::checks_each_test`] is true for it.
//!
//! A constraint is kept in three forms. The [`Expression`] is the constraint as it was written. A tree of sets of
//! levels without negations checks the levels of tests. The [`Clause`]s are the form that [`rules`](crate::rules) works with.

mod clauses;
mod condition;
mod expression;
mod flaw;
mod over;
mod parse;
mod span;
mod specialise;
mod table;
mod term;
mod token;
mod truth;
mod written;

pub use expression::{Expression, Operand, Relation};
pub use flaw::{ConstraintError, ConstraintFlaw, Expected};
pub use specialise::Specialised;
pub use term::{Function, Term};
pub(crate) use token::enclosed;

use crate::rules::Clause;
use crate::{Parameter, Point, Values};
use condition::{Condition, Resolver};
use over::Over;

/// A condition on the parameters that every test of a [`Space`](crate::Space) has to keep.
#[derive(Debug, Clone, PartialEq)]
pub struct Constraint {
    text: String,
    expression: Expression,
    condition: Condition,
    clauses: Vec<Clause>,
    /// The parameters with their places in a test; `None` if the levels decide the constraint.
    over: Option<Over>,
}

impl Constraint {
    /// Reads a constraint on tests of these parameters.
    ///
    /// # Errors
    /// The text is not a constraint, names a parameter that does not exist or varies over time, compares values that cannot
    /// be compared, or needs too many clauses.
    pub(crate) fn new(text: &str, parameters: &[Parameter]) -> Result<Self, ConstraintError> {
        let (expression, places) = parse::parse(text)?;
        let mut resolver = Resolver::new(parameters, &places);
        let is_continuous = |parameter: &Parameter| parameter.levels().is_none();
        let named = |parameter: &&Parameter| expression.names().contains(&parameter.name.as_str());
        let named: Vec<&Parameter> = parameters.iter().filter(named).collect();
        let (condition, over) = if expression.computes() || named.iter().any(|parameter| is_continuous(parameter)) {
            resolver.check(&expression)?;
            let over = Over::new(&expression, parameters);
            let (condition, is_exact) = over.condition(&expression, parameters)?;
            (condition, Some(over).filter(|_| !is_exact))
        } else {
            (resolver.resolve(&expression)?, None)
        };
        let sizes = |parameter: &Parameter| {
            let levels = parameter.levels().map(<[_]>::len);
            levels
                .into_iter()
                .flat_map(|levels| std::iter::repeat_n(levels, parameter.coordinates()))
                .collect::<Vec<_>>()
        };
        let sizes: Vec<usize> = parameters.iter().flat_map(sizes).collect();
        let clauses = clauses::clauses(&condition, &sizes).map_err(|flaw| ConstraintError::at(0, flaw))?;
        Ok(Self { text: text.to_owned(), expression, condition, clauses, over })
    }

    /// Returns the text of the constraint as it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the constraint in the form of a logical expression.
    pub fn expression(&self) -> &Expression {
        &self.expression
    }

    /// Returns `true` if the levels of a test do not decide the constraint, so that each test has to be checked. This is so for
    /// a constraint on continuous parameters, and for a computed constraint on more than 200,000 combinations of levels.
    pub fn checks_each_test(&self) -> bool {
        self.over.is_some()
    }

    /// Returns `true` if a test keeps the constraint.
    ///
    /// # Panics
    /// The point lacks a coordinate for a parameter that the constraint names, or a level does not exist.
    pub fn allows(&self, point: &Point) -> bool {
        self.condition.holds(&point.discrete)
            && self.over.as_ref().is_none_or(|over| over.allows(&self.expression, point))
    }

    /// Returns `true` if a test keeps the constraint with its numbers as they are written. `row` has the levels of the test.
    ///
    /// # Panics
    /// The row lacks a level for a parameter that the constraint names, or the level does not exist.
    pub(crate) fn allows_written(&self, row: &[usize], test: &Values) -> bool {
        self.condition.holds(row) && self.over.as_ref().is_none_or(|over| over.allows_written(&self.expression, test))
    }

    /// Returns whether the tests of a part of the space keep the constraint: those with the levels in `row`, and with
    /// continuous coordinates from `lower` to `upper`. Returns `None` if some of them may keep the constraint and others not.
    /// If the answer is not `None`, it is certain, except for
    /// tests in which parameters are equal that must not be: such tests have no volume.
    ///
    /// # Panics
    /// The part lacks a coordinate for a parameter that the constraint names, or a level does not exist.
    pub fn allows_part(&self, row: &[usize], lower: &[f64], upper: &[f64]) -> Option<bool> {
        if !self.condition.holds(row) {
            return Some(false);
        }
        self.over.as_ref().map_or(Some(true), |over| over.part(&self.expression, row, lower, upper))
    }

    /// Returns `true` if the levels in `row` do not break the constraint. If the constraint does not
    /// [check each test](Self::checks_each_test), every test with these levels keeps it. `row` has a level for each discrete
    /// coordinate.
    ///
    /// # Panics
    /// The row lacks a level for a parameter that the constraint names, or the level does not exist.
    pub fn holds(&self, row: &[usize]) -> bool {
        self.condition.holds(row)
    }

    /// Returns the clauses whose conjunction is the constraint on the levels. A row keeps all of them exactly if the
    /// constraint [holds](Constraint::holds) for the row.
    pub fn clauses(&self) -> &[Clause] {
        &self.clauses
    }
}
