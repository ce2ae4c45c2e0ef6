//! What can be wrong with a constraint, and the words for it.

use super::expression::{Name, Relation, Written};
use crate::Value;
use crate::names::did_you_mean;
use std::fmt;
use thiserror::Error;

/// How many levels a message lists.
const LISTED: usize = 8;

/// Why a text is no constraint.
#[derive(Debug, Clone, Error, PartialEq)]
#[error("{flaw}")]
pub struct ConstraintError {
    /// Where in the text, in bytes.
    pub offset: usize,
    /// What is wrong there.
    pub flaw: Box<ConstraintFlaw>,
}

impl ConstraintError {
    pub(crate) fn at(offset: usize, flaw: ConstraintFlaw) -> Self {
        Self { offset, flaw: Box::new(flaw) }
    }
}

/// What is wrong at a place of a constraint.
#[derive(Debug, Clone, Error, PartialEq)]
#[non_exhaustive]
pub enum ConstraintFlaw {
    /// A number that is none.
    #[error("found `{written}`, expected a number; a name like it stands in brackets")]
    NoNumber {
        /// The number as it is written.
        written: String,
    },
    /// A word without an end.
    #[error("the word that begins here has no closing {quote}")]
    OpenWord {
        /// The quote that it begins with.
        quote: char,
    },
    /// A name without an end.
    #[error("the name that begins here has no closing `]`")]
    OpenName,
    /// A sign of another language.
    #[error("found `{sign}`, expected {meant}")]
    Foreign {
        /// The sign.
        sign: &'static str,
        /// The signs of this language for it.
        meant: &'static str,
    },
    /// No sign of any language that is known here.
    #[error(
        "found `{sign}`, which is no sign of the language; names with other signs than letters, digits, `_` and `.` \
         stand in brackets: [road surface]"
    )]
    UnknownSign {
        /// The sign.
        sign: char,
    },
    /// A sign in the place of another one.
    #[error("found {found}, expected {expected}{}", did_you_mean(.meant))]
    Unexpected {
        /// The sign that is there, or the end of the constraint.
        found: String,
        /// What may stand there.
        expected: Expected,
        /// The word of the language that was perhaps meant.
        meant: Option<&'static str>,
    },
    /// A comparison of a comparison.
    #[error("comparisons do not chain: join two of them with `and`")]
    Chained,
    /// A parenthesis too many.
    #[error("found `)`, which closes nothing")]
    ClosesNothing,
    /// A parenthesis too few.
    #[error("the `(` here is never closed")]
    NeverClosed,
    /// Parentheses, `not` and `implies` in each other.
    #[error("the constraint is nested more than {most} deep")]
    TooDeep {
        /// How deep they may be.
        most: usize,
    },
    /// A value before `in`.
    #[error("found {found}, expected the name of a parameter before `in`")]
    ValueBeforeIn {
        /// The value.
        found: String,
    },
    /// A comparison of two values.
    #[error("found values on both sides, expected a parameter on one of them")]
    OnlyValues,
    /// A parameter that is not there.
    #[error("no parameter is called `{name}`{}", did_you_mean(.nearest))]
    Unknown {
        /// Its name.
        name: String,
        /// A name that was perhaps meant.
        nearest: Option<String>,
    },
    /// A parameter without levels.
    #[error("`{name}` is continuous, expected a discrete parameter")]
    Continuous {
        /// Its name.
        name: String,
    },
    /// A signal.
    #[error("`{name}` varies over time, expected a parameter with one value")]
    Varies {
        /// Its name.
        name: String,
    },
    /// A name that can be no parameter, but is a level of the parameter on the other side.
    #[error("{flaw}; the level of `{}` is written {}", Name(.parameter), Written(.level))]
    Level {
        /// Why it can be no parameter.
        flaw: Box<ConstraintFlaw>,
        /// The parameter on the other side.
        parameter: String,
        /// Its level.
        level: Value,
    },
    /// A value that a parameter never takes.
    #[error("`{}` is never {}, expected one of {}{}", Name(.parameter), Written(.value), listed(.levels), hint(.meant))]
    Never {
        /// The parameter.
        parameter: String,
        /// The value.
        value: Value,
        /// All levels of the parameter.
        levels: Vec<Value>,
        /// The level that was perhaps meant.
        meant: Option<Value>,
    },
    /// A word that is compared by size.
    #[error("`{relation}` compares numbers, found {}", Written(.value))]
    Size {
        /// The comparison.
        relation: Relation,
        /// The word.
        value: Value,
    },
    /// A parameter with words that is compared by size.
    #[error("`{relation}` compares numbers, but `{}` takes the word {}", Name(.parameter), Written(.word))]
    SizeOfWord {
        /// The comparison.
        relation: Relation,
        /// The parameter.
        parameter: String,
        /// One of its words.
        word: Value,
    },
    /// Parameters that are never equal.
    #[error("`{}` and `{}` have no value in common, so they are never equal", Name(&.parameters[0]), Name(&.parameters[1]))]
    NothingInCommon {
        /// Both of them.
        parameters: [String; 2],
    },
    /// A constraint that has no clauses of a size that fits.
    #[error(
        "the constraint takes too many clauses, for it chooses between too many combinations; write its parts that are \
         joined by `and` as constraints of their own, or add a parameter that says which of its alternatives holds"
    )]
    TooManyClauses,
}

/// What may stand at a place of a constraint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Expected {
    /// After a condition.
    Junction,
    /// After a condition in parentheses.
    JunctionOrClose,
    /// The beginning of a condition.
    Condition,
    /// Between the sides of a comparison.
    Comparison,
    /// After a `not` between the sides of a comparison.
    In,
    /// The right side of a comparison.
    Operand,
    /// After `in`.
    List,
    /// A value of a list.
    Value,
    /// After a value of a list.
    CommaOrClose,
}

impl Expected {
    /// The words of the language that may stand there.
    pub(super) fn keywords(self) -> &'static [&'static str] {
        match self {
            Self::Junction | Self::JunctionOrClose => &["and", "or", "implies"],
            Self::Condition => &["not"],
            Self::Comparison | Self::In => &["in"],
            Self::Operand | Self::List | Self::Value | Self::CommaOrClose => &[],
        }
    }
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Junction => "`and`, `or`, `implies` or the end of the constraint",
            Self::JunctionOrClose => "`and`, `or`, `implies` or `)`",
            Self::Condition => "a parameter, `not` or `(`",
            Self::Comparison => "a comparison (`==`, `!=`, `<`, `<=`, `>`, `>=` or `in`)",
            Self::In => "`in`",
            Self::Operand => "a number, a quoted word or a parameter",
            Self::List => "a list like [1, 2] or ['rain', 'fog']",
            Self::Value => "a number or a quoted word",
            Self::CommaOrClose => "`,` or `]`",
        })
    }
}

/// The first levels, and how many there are if these are not all.
fn listed(levels: &[Value]) -> String {
    let written: Vec<_> = levels.iter().take(LISTED).map(|level| Written(level).to_string()).collect();
    let more = if levels.len() > LISTED { format!(", .. ({} in all)", levels.len()) } else { String::new() };
    written.join(", ") + &more
}

fn hint(level: &Option<Value>) -> String {
    did_you_mean(&level.as_ref().map(|level| Written(level).to_string()))
}
