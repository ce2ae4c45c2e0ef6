//! What can be wrong with a space or a test of it, in words.

use super::{Value, position};
use crate::constraint::ConstraintError;
use crate::names::did_you_mean;
use crate::rules::Conflict;
use thiserror::Error;

/// Why a space cannot be built, or a test does not belong to it.
#[derive(Debug, Error, PartialEq)]
pub enum SpaceError {
    /// Two parameters share a name.
    #[error("parameter `{0}` is declared twice")]
    Twice(String),
    /// A parameter without a name.
    #[error("parameter {0} has no name")]
    Nameless(usize),
    /// An interval without inner points, or with ends that are no numbers.
    #[error("parameter `{name}`: interval [{lo}, {hi}], expected two finite numbers, the first below the second")]
    Interval {
        /// The parameter.
        name: String,
        /// Its lower end.
        lo: f64,
        /// Its upper end.
        hi: f64,
    },
    /// A choice of nothing.
    #[error("parameter `{0}`: a choice needs at least one value")]
    EmptyChoice(String),
    /// A choice that names a value twice.
    #[error("parameter `{name}`: the choice names {value} twice")]
    SameLevel {
        /// The parameter.
        name: String,
        /// The repeated value.
        value: Value,
    },
    /// A signal that cannot be, or values that do not make it.
    #[error("parameter `{name}`: {message}")]
    Signal {
        /// The parameter.
        name: String,
        /// What was found and what was expected.
        message: String,
    },
    /// Values that cannot be distributed as the parameter says.
    #[error("parameter `{name}`: {message}")]
    Distribution {
        /// The parameter.
        name: String,
        /// What was found and what was expected.
        message: String,
    },
    /// A value that the parameter does not take.
    #[error("parameter `{name}`: found {value}, expected {expected}{}", did_you_mean(.nearest))]
    OutsideDomain {
        /// The parameter.
        name: String,
        /// The value found.
        value: Value,
        /// The parameter's domain, in words.
        expected: String,
        /// A level that was perhaps meant.
        nearest: Option<String>,
    },
    /// A name that the space does not know.
    #[error("no parameter is called `{name}`{}", did_you_mean(.nearest))]
    Unknown {
        /// The name.
        name: String,
        /// A name that was perhaps meant.
        nearest: Option<String>,
    },
    /// A test that says nothing of a parameter.
    #[error("the test gives no value for parameter `{0}`")]
    Missing(String),
    /// A constraint that means nothing here.
    #[error("constraint `{text}`, column {}: {error}", column(text, error.offset))]
    Constraint {
        /// Its position in the list of constraints, from 0.
        index: usize,
        /// The constraint as it was written.
        text: String,
        /// What is wrong with it, and where.
        error: ConstraintError,
    },
    /// Constraints that no test keeps together.
    #[error("{}", kept_by_none(.constraints, *.smallest))]
    Conflict {
        /// Their positions in the list of constraints, from 0, in ascending order, and how they were written.
        constraints: Vec<(usize, String)>,
        /// Whether it is known that no conflict has fewer constraints.
        smallest: bool,
    },
    /// Constraints on the parameters of these names that are too entangled.
    #[error(
        "what the constraints allow of {} was not found out within the bounds of the search; leave out some of the \
         constraints on these parameters, or give them fewer values", quoted(.0)
    )]
    Undecided(Vec<String>),
    /// A text that is no space.
    #[error("{message}")]
    Syntax {
        /// What was found and what was expected.
        message: String,
        /// Line and column, from 1, where the text parser knows them.
        at: Option<(usize, usize)>,
    },
}

fn quoted(texts: &[String]) -> String {
    texts.iter().map(|text| format!("`{text}`")).collect::<Vec<_>>().join(", ")
}

/// That no test keeps these constraints, each in a line of its own.
fn kept_by_none(constraints: &[(usize, String)], smallest: bool) -> String {
    let these = if constraints.len() == 1 { "this constraint" } else { "these constraints together" };
    let caveat = if smallest { "" } else { Conflict::CAVEAT };
    let lines: String = constraints.iter().map(|(_, text)| format!("\n  {text}")).collect();
    format!("no test keeps {these}{caveat}:{lines}")
}

/// The column, from 1, of a byte offset in the last line before it.
fn column(text: &str, offset: usize) -> usize {
    position(text, offset).1
}
