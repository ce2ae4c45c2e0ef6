//! Constraints: statements about the discrete parameters that every test has to keep.
//!
//! The language compares parameters with `== != < <= > >=` and `in [..]`, and joins comparisons with `not`, `and`,
//! `or`, `implies` and parentheses; `not` binds most tightly and `implies` least, `a implies b implies c` is
//! `a implies (b implies c)`, and `a not in [..]` is `not a in [..]`:
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
//! Numbers stand as they are, words in quotes, single or double. The name of a parameter stands as it is where it
//! consists of letters, digits, `_` and `.`, does not begin with a digit and is no word of the language; any name may
//! stand in brackets: `[road surface] == 'wet'`. In quotes and brackets a backslash takes the next sign as it is.
//! Words are compared as they are written. The order of `<` and its kin is that of numbers, between a parameter of
//! numbers and a number or another such parameter. A value that a parameter never takes is an error where it is asked
//! to be equal, for nobody means that.
//!
//! A constraint is kept in three forms: the [`Expression`] says what was written, a tree of sets of levels without
//! negations is what rows are checked against, and [`Clause`]s are what the engine of [`rules`](crate::rules) reasons
//! about.

mod clauses;
mod condition;
mod expression;
mod flaw;
mod parse;
mod token;

pub use expression::{Expression, Operand, Relation};
pub use flaw::{ConstraintError, ConstraintFlaw, Expected};
pub(crate) use token::enclosed;

use crate::Parameter;
use crate::rules::Clause;
use condition::{Condition, Resolver};

/// A statement that every test of a [`Space`](crate::Space) has to keep.
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
    /// The text is no constraint, names a parameter that is not there or is continuous, compares what cannot be
    /// compared, or cannot be written as clauses of a size that fits.
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

    /// The constraint as it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// What it says.
    pub fn expression(&self) -> &Expression {
        &self.expression
    }

    /// Whether a test with these levels, one for each discrete parameter, keeps it.
    ///
    /// # Panics
    /// A parameter that the constraint names has no level in the row, or one beyond its last.
    pub fn holds(&self, row: &[usize]) -> bool {
        self.condition.holds(row)
    }

    /// The clauses that a row keeps, all of them, exactly where the constraint [holds](Constraint::holds).
    pub fn clauses(&self) -> &[Clause] {
        &self.clauses
    }
}
