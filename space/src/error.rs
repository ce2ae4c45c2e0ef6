//! What can be wrong with a space, or with a test of it.

use crate::constraint::ConstraintError;
use crate::names::did_you_mean;
use crate::rules::Conflict;
use crate::{ParameterError, Position};
use thiserror::Error;

/// Why a space cannot be built, or a test does not belong to it.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum SpaceError {
    /// Two parameters share a name.
    #[error("parameter `{name}` is declared twice")]
    Twice {
        /// The name.
        name: String,
    },
    /// A parameter without a name.
    #[error("parameter {0} has no name")]
    Nameless(usize),
    /// A parameter that cannot be, or a value that it does not take.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// A name that the space does not know.
    #[error("no parameter is called `{name}`{}", did_you_mean(.nearest))]
    Unknown {
        /// The name.
        name: String,
        /// A name that was perhaps meant.
        nearest: Option<String>,
    },
    /// A test that says nothing of a parameter.
    #[error("the test gives no value for parameter `{name}`")]
    Missing {
        /// The parameter.
        name: String,
    },
    /// A constraint that means nothing here.
    #[error("{}", in_constraint(.text, .error, .at.as_ref()))]
    Constraint {
        /// Its position in the list of constraints, from 0.
        index: usize,
        /// The constraint as it was written.
        text: String,
        /// What is wrong with it, and where in the constraint.
        error: ConstraintError,
        /// The place in the file that the constraint was read from.
        at: Option<Position>,
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
    /// A text that is no TOML, or has other fields than a space.
    #[error("{}", .error.message())]
    Toml {
        /// The error of the reader of TOML.
        error: Box<toml::de::Error>,
        /// The place in the text, if the reader knows it.
        at: Option<Position>,
    },
}

impl SpaceError {
    /// The place in the text that the space was read from, if it is known.
    pub fn at(&self) -> Option<Position> {
        match self {
            Self::Toml { at, .. } | Self::Constraint { at, .. } => *at,
            _ => None,
        }
    }
}

/// Names the constraint, unless the place in a file is known.
fn in_constraint(text: &str, error: &ConstraintError, at: Option<&Position>) -> String {
    match at {
        Some(_) => error.to_string(),
        None => format!("constraint `{text}`, column {}: {error}", Position::of(text, error.offset).column),
    }
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
