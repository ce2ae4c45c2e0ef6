//! Errors in constraints, and their messages.

use super::Function;
use super::expression::Relation;
use super::written::{Name, Written};
use crate::Value;
use crate::names::did_you_mean;
use std::fmt;
use thiserror::Error;

/// The number of levels that a message lists at most.
const LISTED: usize = 8;

/// An error in a constraint, with its place and its kind.
#[derive(Debug, Clone, Error, PartialEq)]
#[error("{flaw}")]
pub struct ConstraintError {
    /// The place of the error in the text of the constraint, as an offset in bytes.
    pub offset: usize,
    /// The kind of the error, with its details.
    pub flaw: Box<ConstraintFlaw>,
}

impl ConstraintError {
    pub(crate) fn at(offset: usize, flaw: ConstraintFlaw) -> Self {
        Self { offset, flaw: Box::new(flaw) }
    }
}

/// A kind of error in a constraint.
#[derive(Debug, Clone, Error, PartialEq)]
#[non_exhaustive]
pub enum ConstraintFlaw {
    /// Text that begins like a number is not a finite number.
    #[error("found `{written}`, expected a finite number; write a name that begins like a number in brackets")]
    NoNumber {
        /// The text that begins like a number.
        written: String,
    },
    /// A quoted word has no closing quote.
    #[error("the word that begins here has no closing {quote}")]
    OpenWord {
        /// The quotation mark that opens the word.
        quote: char,
    },
    /// A name in brackets has no closing bracket.
    #[error("the name that begins here has no closing `]`")]
    OpenName,
    /// The constraint uses a sign of another language, such as `&&`.
    #[error("found `{sign}`, expected {meant}")]
    Foreign {
        /// The sign of the other language.
        sign: &'static str,
        /// The signs of the constraint language that replace the sign of the other language.
        meant: &'static str,
    },
    /// A character of the constraint belongs neither to the constraint language nor to another known language.
    #[error(
        "found `{sign}`, which has no meaning here; names with other characters than letters, digits, `_` and `.` \
         stand in brackets: [road surface]"
    )]
    UnknownSign {
        /// The character that has no meaning.
        sign: char,
    },
    /// A token stands at a place where another token was expected.
    #[error("found {found}, expected {expected}{}", did_you_mean(.meant))]
    Unexpected {
        /// The token that was found, or the end of the constraint.
        found: String,
        /// The tokens that may stand at the place of the error.
        expected: Expected,
        /// The word of the constraint language that the author probably meant.
        meant: Option<&'static str>,
    },
    /// Comparisons are chained, as in `a < b < c`.
    #[error("comparisons do not chain: join two of them with `and`")]
    Chained,
    /// A closing parenthesis has no opening parenthesis.
    #[error("found `)` without an opening `(`")]
    ClosesNothing,
    /// An opening parenthesis has no closing parenthesis.
    #[error("the `(` here has no closing `)`")]
    NeverClosed,
    /// Parentheses, `not` and `implies` are nested too deeply.
    #[error("the constraint has more than {most} levels of nesting; divide it into several constraints")]
    TooDeep {
        /// The greatest depth of nesting that is allowed.
        most: usize,
    },
    /// A comparison computes with too many operators.
    #[error(
        "the comparison has more than {most} operators `+ - * / %`, expected fewer; a new parameter can replace a part of it"
    )]
    TooLong {
        /// The greatest number of operators that is allowed.
        most: usize,
    },
    /// A value stands in front of `in`, where a parameter has to stand.
    #[error("found {found}, expected the name of a parameter before `in`")]
    ValueBeforeIn {
        /// The value in front of `in`, as a token.
        found: String,
    },
    /// Both sides of a comparison are values.
    #[error("found values on both sides of the comparison, expected a parameter on one side")]
    OnlyValues,
    /// A constraint names a parameter that does not exist.
    #[error("no parameter is called `{name}`{}", did_you_mean(.nearest))]
    Unknown {
        /// The given name, which is not the name of a parameter.
        name: String,
        /// The most similar name of a parameter, if a name is similar enough.
        nearest: Option<String>,
    },
    /// A constraint names a function that does not exist.
    #[error("no function is called `{name}`{}; the functions are {}", did_you_mean(.nearest), functions())]
    UnknownFunction {
        /// The given name, which is not the name of a function.
        name: String,
        /// The most similar name of a function, if a name is similar enough.
        nearest: Option<&'static str>,
    },
    /// A word stands where a number is computed.
    #[error("found the word '{word}', expected a number or a parameter with numbers")]
    WordInTerm {
        /// The word.
        word: String,
    },
    /// A continuous parameter has to be equal to something, which hardly any test would keep.
    #[error(
        "`{name}` is continuous, so hardly any test keeps an equation with it; expected a discrete parameter, or one of `!=`, \
         `<`, `<=`, `>` and `>=`"
    )]
    Continuous {
        /// The name of the continuous parameter.
        name: String,
    },
    /// A constraint names a signal, which has several values in a test.
    #[error("`{name}` varies over time, expected a parameter with one value")]
    Varies {
        /// The name of the parameter that is a signal.
        name: String,
    },
    /// The name on the right side of a comparison is no valid parameter, but a level of the parameter on the left side.
    #[error("{flaw}; to compare with the level of `{}`, write {}", Name(.parameter), Written(.level))]
    Level {
        /// The reason why the name cannot be a parameter.
        flaw: Box<ConstraintFlaw>,
        /// The name of the parameter on the left side of the comparison.
        parameter: String,
        /// The level of the left parameter that equals the name on the right side of the comparison.
        level: Value,
    },
    /// A parameter is compared with a value that the parameter never takes.
    #[error("`{}` never has the value {}, expected one of {}{}", Name(.parameter), Written(.value), listed(.levels), hint(.meant))]
    Never {
        /// The name of the compared parameter.
        parameter: String,
        /// The value that the parameter never takes.
        value: Value,
        /// All levels of the parameter.
        levels: Vec<Value>,
        /// The level that the author probably meant.
        meant: Option<Value>,
    },
    /// A parameter is compared with a word by a relation that needs numbers, such as `<`.
    #[error("`{relation}` compares numbers, found {}", Written(.value))]
    Size {
        /// The relation that compares sizes, such as `<`.
        relation: Relation,
        /// The word that the parameter is compared with.
        value: Value,
    },
    /// A parameter with words among its levels is compared by a relation that needs numbers, such as `<`.
    #[error("`{relation}` compares numbers, but `{}` takes the word {}", Name(.parameter), Written(.word))]
    SizeOfWord {
        /// The relation that compares sizes, such as `<`.
        relation: Relation,
        /// The name of the parameter that has a word among its levels.
        parameter: String,
        /// A word among the levels of the parameter.
        word: Value,
    },
    /// Two parameters are compared for equality, but have no value in common.
    #[error("`{}` and `{}` have no value in common, so they are never equal", Name(&.parameters[0]), Name(&.parameters[1]))]
    NothingInCommon {
        /// The names of the two parameters that are compared.
        parameters: [String; 2],
    },
    /// A number is computed from a parameter with a word among its levels.
    #[error("only numbers can be computed with, but `{}` takes the word {}", Name(.parameter), Written(.word))]
    TermOfWord {
        /// The name of the parameter that has a word among its levels.
        parameter: String,
        /// A word among the levels of the parameter.
        word: Value,
    },
    /// The constraint needs too many clauses, or clauses that are too large.
    #[error(
        "the constraint needs too many clauses, since it combines too many alternatives; write its parts that are \
         joined by `and` as separate constraints, or add a parameter that says which alternative holds"
    )]
    TooManyClauses,
}

/// The tokens that may stand at the place of an error in a constraint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Expected {
    /// The tokens `and`, `or` and `implies`, or the end, which may follow a condition.
    Junction,
    /// The tokens `and`, `or`, `implies` and `)`, which may follow a condition in parentheses.
    JunctionOrClose,
    /// The beginning of a condition, which is a parameter, `not` or `(`.
    Condition,
    /// The token between the two sides of a comparison, such as `==` or `in`.
    Comparison,
    /// The token `in`, which has to follow a `not` between the two sides of a comparison.
    In,
    /// The right side of a comparison, which is a number, a quoted word or a parameter.
    Operand,
    /// The list of values after `in`.
    List,
    /// A value in a list, which is a number or a quoted word.
    Value,
    /// The token after a value in a list, which is `,` or `]`.
    CommaOrClose,
    /// A number, a parameter, a function or `(`, after an operator.
    Number,
    /// The comma between the operands of a function.
    Comma,
    /// An operator or `)`, after a number in parentheses.
    OperatorOrClose,
}

impl Expected {
    /// Returns the words of the language that may stand at the place.
    pub(super) fn keywords(self) -> &'static [&'static str] {
        match self {
            Self::Junction | Self::JunctionOrClose => &["and", "or", "implies"],
            Self::Condition => &["not"],
            Self::Comparison | Self::In => &["in"],
            Self::Operand
            | Self::List
            | Self::Value
            | Self::CommaOrClose
            | Self::Number
            | Self::Comma
            | Self::OperatorOrClose => &[],
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
            Self::Number => "a number, a parameter, a function or `(`",
            Self::Comma => "an operator or `,`",
            Self::OperatorOrClose => "an operator or `)`",
        })
    }
}

/// Lists the first levels, and adds the number of all levels if some are left out.
fn listed(levels: &[Value]) -> String {
    let written: Vec<_> = levels.iter().take(LISTED).map(|level| Written(level).to_string()).collect();
    let more = if levels.len() > LISTED { format!(", .. ({} in all)", levels.len()) } else { String::new() };
    written.join(", ") + &more
}

fn hint(level: &Option<Value>) -> String {
    did_you_mean(&level.as_ref().map(|level| Written(level).to_string()))
}

fn functions() -> String {
    Function::names().collect::<Vec<_>>().join(", ")
}
