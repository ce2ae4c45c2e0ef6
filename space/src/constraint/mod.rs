//! Constraints: statements about the discrete parameters that every test has to keep.
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
//! A constraint is kept in three forms. The [`Expression`] is the constraint as it was written. A tree of sets of
//! levels without negations checks tests. The [`Clause`]s are the form that [`rules`](crate::rules) works with.

mod clauses;
mod condition;
mod expression;
mod flaw;
mod parse;
mod table;
mod token;

pub use expression::{Expression, Operand, Relation};
pub use flaw::{ConstraintError, ConstraintFlaw, Expected};
pub use table::{can_be_written, expressions};
pub(crate) use token::enclosed;

use crate::Parameter;
use crate::rules::Clause;
use condition::{Condition, Resolver};

/// A condition on the discrete parameters that every test of a [`Space`](crate::Space) has to keep.
#[derive(Debug, Clone, PartialEq)]
pub struct Constraint {
    text: String,
    expression: Expression,
    condition: Condition,
    clauses: Vec<Clause>,
}

impl Constraint {
    /// Reads a constraint on tests of these parameters.
    ///
    /// # Errors
    /// The text is not a constraint, names a parameter that does not exist or is continuous or varies over time,
    /// compares values that cannot be compared, or needs too many clauses.
    pub(crate) fn new(text: &str, parameters: &[Parameter]) -> Result<Self, ConstraintError> {
        let (expression, places) = parse::parse(text)?;
        let condition = Resolver::new(parameters, &places).resolve(&expression)?;
        let sizes = |parameter: &Parameter| {
            let levels = parameter.levels().map(<[_]>::len);
            levels
                .into_iter()
                .flat_map(|levels| std::iter::repeat_n(levels, parameter.coordinates()))
                .collect::<Vec<_>>()
        };
        let sizes: Vec<usize> = parameters.iter().flat_map(sizes).collect();
        let clauses = clauses::clauses(&condition, &sizes).map_err(|flaw| ConstraintError::at(0, flaw))?;
        Ok(Self { text: text.to_owned(), expression, condition, clauses })
    }

    /// Returns the text of the constraint as it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the constraint in the form of a logical expression.
    pub fn expression(&self) -> &Expression {
        &self.expression
    }

    /// Returns `true` if a test with the levels in `row` keeps the constraint. `row` has a level for each discrete
    /// coordinate.
    ///
    /// # Panics
    /// The row lacks a level for a parameter that the constraint names, or the level does not exist.
    pub fn holds(&self, row: &[usize]) -> bool {
        self.condition.holds(row)
    }

    /// Returns the clauses whose conjunction is the constraint. A test keeps all of them exactly if the constraint
    /// [holds](Constraint::holds).
    pub fn clauses(&self) -> &[Clause] {
        &self.clauses
    }
}
