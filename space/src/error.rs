//! Errors of a space, and of a test in a space.

use crate::constraint::ConstraintError;
use crate::names::did_you_mean;
use crate::rules::Conflict;
use crate::{ParameterError, Position, WordFlaw};
use thiserror::Error;

/// The greatest number of parameters of a space. The time and the memory of a plan grow with the number of pairs of
/// parameters.
pub(crate) const MOST_PARAMETERS: usize = 10_000;

/// The reason why a space cannot be built, or why a test does not belong to a space.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum SpaceError {
    /// Two parameters have the same name.
    #[error("parameter `{name}` is declared twice")]
    Twice {
        /// The name that both parameters have.
        name: String,
    },
    /// There are more parameters than a space may have.
    #[error("found {found} parameters, expected at most {MOST_PARAMETERS}: fix some of them")]
    TooMany {
        /// The number of parameters.
        found: usize,
    },
    /// A parameter has no name. The number is its position among the parameters, from 1.
    #[error("parameter {0} has no name")]
    Nameless(usize),
    /// Tables and pictures cannot show the name of a parameter, or one of its values.
    #[error("{what} of parameter {index} {flaw}")]
    Word {
        /// The word with the flaw: "the name" or "a value".
        what: &'static str,
        /// The position of the parameter among the parameters, from 1.
        index: usize,
        /// The reason why the word cannot be shown.
        flaw: WordFlaw,
    },
    /// A parameter is not valid, or a value is outside the domain of its parameter.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// The space has no parameter with the given name.
    #[error("no parameter is called `{name}`{}", did_you_mean(.nearest))]
    Unknown {
        /// The given name, which is not the name of a parameter.
        name: String,
        /// The most similar name of a parameter, if a name is similar enough.
        nearest: Option<String>,
    },
    /// A test gives no value for a parameter.
    #[error("the test gives no value for parameter `{name}`")]
    Missing {
        /// The name of the parameter without a value.
        name: String,
    },
    /// A constraint cannot be read, or does not fit the parameters.
    #[error("{}", in_constraint(.text, .error, .at.as_ref()))]
    Constraint {
        /// The position of the constraint in the list of constraints, from 0.
        index: usize,
        /// The text of the constraint as it was written.
        text: String,
        /// The error in the constraint, with its place in the text of the constraint.
        error: ConstraintError,
        /// The position of the error in the file, if the constraint was read from a file.
        at: Option<Position>,
    },
    /// No test keeps all of the given constraints together.
    #[error("{}", kept_by_none(.constraints, *.smallest))]
    Conflict {
        /// The constraints in conflict, each as its position in the list of constraints, from 0, and its text. The
        /// positions are in ascending order.
        constraints: Vec<(usize, String)>,
        /// `true` if it is certain that no smaller set of constraints is in conflict.
        smallest: bool,
    },
    /// The search for the combinations that the constraints allow exceeded its bounds. The list names the parameters.
    #[error(
        "the search for the combinations of {} that the constraints allow exceeded its bounds; leave out some of the \
         constraints on these parameters, or give them fewer values", quoted(.0)
    )]
    Undecided(Vec<String>),
    /// The text is not valid TOML, or does not have the fields of a space.
    #[error("{}", .error.message())]
    Toml {
        /// The error that the TOML reader reports.
        error: Box<toml::de::Error>,
        /// The position of the error in the text, if the TOML reader gives a position.
        at: Option<Position>,
    },
}

impl SpaceError {
    /// Returns the position of the error in the text from which the space was read, or `None` if the position is
    /// unknown.
    pub fn at(&self) -> Option<Position> {
        match self {
            Self::Toml { at, .. } | Self::Constraint { at, .. } => *at,
            _ => None,
        }
    }
}

/// Writes the message of an error in a constraint. It names the constraint unless the position in a file is known.
fn in_constraint(text: &str, error: &ConstraintError, at: Option<&Position>) -> String {
    match at {
        Some(_) => error.to_string(),
        None => format!("constraint `{text}`, column {}: {error}", Position::of(text, error.offset).column),
    }
}

fn quoted(texts: &[String]) -> String {
    texts.iter().map(|text| format!("`{text}`")).collect::<Vec<_>>().join(", ")
}

/// Says that no test keeps these constraints, and lists each constraint in a line of its own.
fn kept_by_none(constraints: &[(usize, String)], smallest: bool) -> String {
    let these = if constraints.len() == 1 { "this constraint" } else { "these constraints together" };
    let caveat = if smallest { "" } else { Conflict::CAVEAT };
    let lines: String = constraints.iter().map(|(_, text)| format!("\n  {text}")).collect();
    format!("no test keeps {these}{caveat}:{lines}")
}
