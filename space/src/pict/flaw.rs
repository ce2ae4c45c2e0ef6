//! The errors of model files.

use crate::SpaceError;
use crate::constraint::ConstraintError;
use crate::names::did_you_mean;
use thiserror::Error;

/// Where a text stops being a model, and why.
#[derive(Debug, Clone, Error, PartialEq)]
#[error("line {line}, column {column}: {flaw}")]
pub struct PictError {
    /// The line, from 1.
    pub line: usize,
    /// The column, from 1.
    pub column: usize,
    /// The flaw at this place.
    pub flaw: Box<PictFlaw>,
}

/// A kind of line of a model file. The kinds stand in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Section {
    /// The values of a parameter.
    Parameter,
    /// A group of parameters.
    SubModel,
    /// A constraint.
    Constraint,
}

impl Section {
    const fn name(self) -> &'static str {
        match self {
            Self::Parameter => "a parameter",
            Self::SubModel => "a sub-model",
            Self::Constraint => "a constraint",
        }
    }
}

/// What is wrong at a place of a model file.
#[derive(Debug, Clone, Error, PartialEq)]
#[non_exhaustive]
pub enum PictFlaw {
    /// A line that belongs further up.
    #[error(
        "found {} after {}; parameters come first, then sub-models, then constraints", .found.name(), .after.name()
    )]
    Misplaced {
        /// The kind of the line.
        found: Section,
        /// The kind of a line above it.
        after: Section,
    },
    /// A file without parameters.
    #[error("found no parameters, expected a line like `Weather: clear, rain, fog`")]
    NoParameters,
    /// A line of a parameter without a colon.
    #[error(
        "found no `:`, expected one between the name of a parameter and its values{}",
        if *.bracket { ", or a constraint that begins with IF, NOT, [ or (" } else { "" }
    )]
    NoColon {
        /// Whether the line has a bracket, as a constraint has.
        bracket: bool,
    },
    /// A parameter without a name.
    #[error("found no name before `:`")]
    Nameless,
    /// A parameter for the expected result.
    #[error("`{name}` is a result parameter, which is not supported")]
    ResultParameter {
        /// The name, with its `$`.
        name: String,
    },
    /// An order behind the name of a parameter.
    #[error("an order of a parameter is not supported; give the order of a sub-model: `{{A, B}} @ 3`")]
    OrderOfParameter,
    /// A second parameter of the same name.
    #[error("parameter `{name}` is declared twice; case makes no difference")]
    Twice {
        /// The name, as the first declaration writes it.
        name: String,
    },
    /// A parameter without values.
    #[error("found no values, expected those of `{name}`, with commas between them")]
    NoValues {
        /// The parameter.
        name: String,
    },
    /// A parameter with negative values only.
    #[error("every value of `{name}` is negative (`~`), expected one that is not")]
    OnlyNegative {
        /// The parameter.
        name: String,
    },
    /// A value that is negative and is not.
    #[error("`{value}` is listed with and without `~`")]
    BothSigns {
        /// The value.
        value: String,
    },
    /// A name that no parameter has.
    #[error("no parameter is called `{name}`{}", did_you_mean(.nearest))]
    Unknown {
        /// The name.
        name: String,
        /// The nearest name of a parameter.
        nearest: Option<String>,
    },
    /// A reference to a parameter that is declared below it.
    #[error("`<{name}>` stands before parameter `{name}`, expected it below")]
    BeforeItsParameter {
        /// The parameter.
        name: String,
    },
    /// A sub-model without an end.
    #[error("found no `}}`, expected one after the names of a sub-model")]
    OpenSubModel,
    /// A comma of a sub-model without a name.
    #[error("found no name, expected a parameter of the sub-model")]
    NamelessInSubModel,
    /// A sub-model that names a parameter twice.
    #[error("the sub-model names `{name}` twice")]
    TwiceInSubModel {
        /// The name, as it is written the second time.
        name: String,
    },
    /// Text behind a sub-model.
    #[error("found `{found}`, expected `@` and the order of the sub-model")]
    AfterSubModel {
        /// The text.
        found: String,
    },
    /// An order that the sub-model cannot have.
    #[error(
        "found {}, expected an order from 1 to {most}, the number of parameters",
        if .found.is_empty() { "nothing".to_owned() } else { format!("`{found}`") }
    )]
    Order {
        /// The order as it is written, perhaps empty.
        found: String,
        /// The number of parameters of the sub-model.
        most: usize,
    },
    /// A name or a word without an end.
    #[error("the {} that begins here has no closing `{close}`", if *.close == ']' { "name" } else { "word" })]
    Open {
        /// The sign that would end it.
        close: char,
    },
    /// A number that is none.
    #[error("found `{written}`, expected a number")]
    NoNumber {
        /// The number as it is written.
        written: String,
    },
    /// A comment behind something else.
    #[error("found `#`, which begins a comment only at the start of a line")]
    LateComment,
    /// A sign of another language.
    #[error("found `{sign}`, expected {meant}")]
    Foreign {
        /// The sign.
        sign: &'static str,
        /// The sign of this language for it.
        meant: &'static str,
    },
    /// No sign of any language that is known here.
    #[error("found `{sign}`, which is no sign of a constraint")]
    UnknownSign {
        /// The sign.
        sign: char,
    },
    /// A token in the place of another one.
    #[error("found {found}, expected {}{}", either(.expected), did_you_mean(.meant))]
    Unexpected {
        /// The token that is there, or the end of the model, in words.
        found: String,
        /// What may stand there, in words.
        expected: Vec<String>,
        /// The word of the language that was perhaps meant.
        meant: Option<&'static str>,
    },
    /// Parentheses and `NOT` in each other.
    #[error("the constraint is nested more than {most} deep")]
    TooDeep {
        /// How deep they may be.
        most: usize,
    },
    /// A parenthesis too few.
    #[error("the `(` here is never closed")]
    NeverClosed,
    /// A word in the place of a parameter.
    #[error("found `{word}`, expected a parameter in brackets, as [{word}]")]
    NoBrackets {
        /// The word.
        word: String,
    },
    /// A pattern for numbers.
    #[error("`LIKE` compares words, but `{name}` takes numbers only")]
    PatternOfNumbers {
        /// The parameter.
        name: String,
    },
    /// A parameter of numbers compared with one of words.
    #[error("`{numbers}` takes numbers and `{words}` words, which are not compared")]
    NotCompared {
        /// The parameter of numbers.
        numbers: String,
        /// The parameter of words.
        words: String,
    },
    /// A number for a parameter of words.
    #[error("`{name}` takes words, which stand in quotes: found `{number}`")]
    NumberForWords {
        /// The parameter.
        name: String,
        /// The number.
        number: f64,
    },
    /// A word for a parameter of numbers.
    #[error("`{name}` takes numbers only, which stand without quotes: found `\"{word}\"`")]
    WordForNumbers {
        /// The parameter.
        name: String,
        /// The word.
        word: String,
    },
    /// A word without quotes.
    #[error("found `{word}`, expected a value; words stand in quotes: \"{word}\"")]
    NoQuotes {
        /// The word.
        word: String,
    },
    /// A constraint that means nothing for these parameters.
    #[error(transparent)]
    Constraint(ConstraintError),
    /// Parameters that make no space.
    #[error(transparent)]
    Space(SpaceError),
}

/// Joins alternatives: `a, b or c`.
fn either(alternatives: &[String]) -> String {
    match alternatives {
        [] => String::new(),
        [one] => one.clone(),
        [others @ .., last] => format!("{} or {last}", others.join(", ")),
    }
}
