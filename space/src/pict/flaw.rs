//! Errors in model files of PICT, and their messages.

use crate::SpaceError;
use crate::constraint::ConstraintError;
use crate::names::did_you_mean;
use thiserror::Error;

/// An error in a model file of PICT, with its place and its kind.
#[derive(Debug, Clone, Error, PartialEq)]
#[error("line {line}, column {column}: {flaw}")]
pub struct PictError {
    /// The line of the error, counted from 1.
    pub line: usize,
    /// The column of the error, counted in characters from 1.
    pub column: usize,
    /// The kind of the error, with its details.
    pub flaw: Box<PictFlaw>,
}

/// A kind of line in a model file of PICT. In a file, the kinds stand in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Section {
    /// A line with a parameter and its values.
    Parameter,
    /// A line with a group of parameters, which PICT calls a sub-model.
    SubModel,
    /// A line with a constraint.
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

/// A kind of error in a model file of PICT.
#[derive(Debug, Clone, Error, PartialEq)]
#[non_exhaustive]
pub enum PictFlaw {
    /// A line stands below a line of a kind that has to come later in the file.
    #[error(
        "found {} after {}; parameters come first, then sub-models, then constraints", .found.name(), .after.name()
    )]
    Misplaced {
        /// The kind of the misplaced line.
        found: Section,
        /// The kind of the line that stands above the misplaced line but has to come later.
        after: Section,
    },
    /// The model file has no parameters.
    #[error("found no parameters, expected a line like `Weather: clear, rain, fog`")]
    NoParameters,
    /// The line of a parameter has no colon.
    #[error(
        "found no `:`, expected a `:` between the name of a parameter and its values{}",
        if *.constraint { ", or a constraint that begins with IF, [ or (" } else { "" }
    )]
    NoColon {
        /// `true` if the line looks like a constraint.
        constraint: bool,
    },
    /// A parameter has no name.
    #[error("found no name before `:`, expected the name of a parameter")]
    Nameless,
    /// A parameter describes the expected result, which is not supported.
    #[error("`{name}` is a result parameter, which is not supported")]
    ResultParameter {
        /// The name of the parameter, with its `$`.
        name: String,
    },
    /// An order such as `@ 2` follows the name of a parameter, which is not supported.
    #[error("the order of a parameter is not supported, expected the order of a sub-model: `{{A, B, C}} @ 3`")]
    OrderOfParameter,
    /// Two parameters have the same name.
    #[error("parameter `{name}` is declared twice; case makes no difference")]
    Twice {
        /// The common name, as it is written at the first of the two parameters.
        name: String,
    },
    /// A parameter has no values.
    #[error("found no values, expected the values of parameter `{name}`, with commas between them")]
    NoValues {
        /// The name of the parameter without values.
        name: String,
    },
    /// All values of a parameter are marked as negative values with `~`.
    #[error("every value of parameter `{name}` is negative (`~`), expected a value without `~`")]
    OnlyNegative {
        /// The name of the parameter that has only negative values.
        name: String,
    },
    /// A parameter lists a value both with and without the mark `~` of negative values.
    #[error("`{value}` is listed with and without `~`")]
    BothSigns {
        /// The value that is listed with and without `~`.
        value: String,
    },
    /// The file names a parameter that does not exist.
    #[error("no parameter is called `{name}`{}", did_you_mean(.nearest))]
    Unknown {
        /// The given name, which is not the name of a parameter.
        name: String,
        /// The most similar name of a parameter, if a name is similar enough.
        nearest: Option<String>,
    },
    /// A parameter refers to the values of another parameter that is declared only further below.
    #[error("found `<{name}>` above parameter `{name}`, expected the reference below the parameter")]
    BeforeItsParameter {
        /// The name of the parameter that is declared further below.
        name: String,
    },
    /// A sub-model, which is a group of parameters, has no closing brace.
    #[error("found no `}}`, expected `}}` after the names of a sub-model")]
    OpenSubModel,
    /// The name of a parameter is missing in a sub-model (a group of parameters).
    #[error("found no name, expected a parameter of the sub-model")]
    NamelessInSubModel,
    /// The parameters of the model have too many values.
    #[error("the parameters have more than {most} values, which is the limit; divide the model into several models")]
    TooManyValues {
        /// The greatest number of values of all parameters together.
        most: usize,
    },
    /// Two parameters with too many values are compared.
    #[error(
        "the two parameters have more than {most} pairs of values, which is the limit; compare the parameters with values"
    )]
    TooManyPairs {
        /// The greatest number of pairs of values.
        most: usize,
    },
    /// A parameter is compared with itself.
    #[error("parameter `{name}` is compared with itself, expected another parameter or a value")]
    ComparedToItself {
        /// The name of the parameter.
        name: String,
    },
    /// A backslash stands before a character that needs none.
    #[error("found `\\{sign}`, expected `\\\\`, `\\\"` or `\\]`")]
    Escape {
        /// The character after the backslash.
        sign: char,
    },
    /// Text other than an order, such as `@ 3`, follows a sub-model (a group of parameters).
    #[error("found `{found}`, expected `@` and the order of the sub-model")]
    AfterSubModel {
        /// The text that follows the sub-model.
        found: String,
    },
    /// The order of a sub-model is not a number from 1 to the number of its parameters.
    #[error(
        "found {}, expected an order from 1 to {most}, the number of parameters in the sub-model",
        if .found.is_empty() { "nothing".to_owned() } else { format!("`{found}`") }
    )]
    Order {
        /// The order of the sub-model, as the file writes the order. It may be empty.
        found: String,
        /// The number of parameters of the sub-model, which is the greatest order.
        most: usize,
    },
    /// A name in brackets or a word in quotes has no closing sign.
    #[error("the {} that begins here has no closing `{close}`", if *.close == ']' { "name" } else { "word" })]
    Open {
        /// The sign that would close the name or the word.
        close: char,
    },
    /// Text that begins like a number is not a finite number.
    #[error("found `{written}`, expected a finite number")]
    NoNumber {
        /// The text that begins like a number.
        written: String,
    },
    /// A comment does not begin at the start of a line, as comments have to.
    #[error("found `#`, which begins a comment only at the start of a line")]
    LateComment,
    /// A constraint uses a sign of another language, such as `&&`.
    #[error("found `{sign}`, expected {meant}")]
    Foreign {
        /// The sign of the other language.
        sign: &'static str,
        /// The sign of PICT that replaces the sign of the other language.
        meant: &'static str,
    },
    /// A character of a constraint belongs neither to the language of PICT nor to another known language.
    #[error("found `{sign}`, which has no meaning in a constraint")]
    UnknownSign {
        /// The character that has no meaning.
        sign: char,
    },
    /// A token stands at a place where another token was expected.
    #[error("found {found}, expected {}{}", either(.expected), did_you_mean(.meant))]
    Unexpected {
        /// The token that was found, or the end of the model, in words.
        found: String,
        /// The tokens that may stand at the place of the error, in words.
        expected: Vec<String>,
        /// The word of the language of PICT that the author probably meant.
        meant: Option<&'static str>,
    },
    /// Parentheses and `NOT` are nested too deeply.
    #[error("the constraint has more than {most} levels of nesting; divide it into several constraints")]
    TooDeep {
        /// The greatest depth of nesting that is allowed.
        most: usize,
    },
    /// An opening parenthesis has no closing parenthesis.
    #[error("the `(` here has no closing `)`")]
    NeverClosed,
    /// A word stands where a parameter in brackets has to stand.
    #[error("found `{word}`, expected a parameter in brackets: [{word}]")]
    NoBrackets {
        /// The word that is not in brackets.
        word: String,
    },
    /// A parameter whose values are numbers is compared with a pattern.
    #[error("`LIKE` compares words, but `{name}` takes numbers only")]
    PatternOfNumbers {
        /// The name of the parameter whose values are numbers.
        name: String,
    },
    /// A parameter whose values are numbers is compared with a parameter whose values are words.
    #[error("`{numbers}` takes numbers and `{words}` takes words; numbers and words cannot be compared")]
    NotCompared {
        /// The name of the parameter whose values are numbers.
        numbers: String,
        /// The name of the parameter whose values are words.
        words: String,
    },
    /// A parameter whose values are words is compared with a number.
    #[error("found `{number}`, but parameter `{name}` takes words; write words in quotes")]
    NumberForWords {
        /// The name of the parameter whose values are words.
        name: String,
        /// The number that the parameter is compared with.
        number: f64,
    },
    /// A parameter whose values are numbers is compared with a word.
    #[error("found `\"{word}\"`, but parameter `{name}` takes numbers only; write numbers without quotes")]
    WordForNumbers {
        /// The name of the parameter whose values are numbers.
        name: String,
        /// The word that the parameter is compared with.
        word: String,
    },
    /// A word in a comparison has no quotes.
    #[error("found `{word}`, expected a value; words stand in quotes: \"{word}\"")]
    NoQuotes {
        /// The word that has no quotes.
        word: String,
    },
    /// A constraint does not fit the parameters of the model.
    #[error(transparent)]
    Constraint(ConstraintError),
    /// The parameters and constraints of the model do not make a valid space.
    #[error(transparent)]
    Space(SpaceError),
}

/// Joins alternatives in words, such as `a, b or c`.
fn either(alternatives: &[String]) -> String {
    match alternatives {
        [] => String::new(),
        [one] => one.clone(),
        [others @ .., last] => format!("{} or {last}", others.join(", ")),
    }
}
