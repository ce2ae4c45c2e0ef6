//! Parses formulas from text, by precedence climbing (Pratt, "Top down operator precedence", POPL 1973).
//!
//! The operators, from the weakest to the strongest:
//!
//! | | |
//! | --- | --- |
//! | `->` or `implies` | to the right: `a -> b -> c` is `a -> (b -> c)` |
//! | `or` | |
//! | `and` | |
//! | `until` `release` `since`, or `U` `R` `S` | do not chain |
//! | `not` `always` `eventually` `historically` `once`, or `G` `F` `H` `O` | in front |
//! | `<` `<=` `>` `>=` `==` `!=` | do not chain |
//! | `+` `-` | |
//! | `*` `/` | |
//! | `-` in front | |
//!
//! A temporal operator may have an interval behind it: `[0,30]`, `[2,inf]`, or `~[0,0.25]`, whose bounds are rounded
//! outward to whole samples. The functions are `abs(x)`, `min(x, y)` and `max(x, y)`. `true` and `false` are formulas.
//! A signal is a formula if it stands where a formula is expected. A name needs quotation marks if it is a word of the
//! language, or has other characters than letters, digits, `_` and `.`.

mod error;
mod operator;
mod token;

pub use error::ParseError;

use crate::error::nearest;
use crate::{Arithmetic, Connective, Expression, Formula, Interval, Modality};
use operator::{Infix, strength};
use std::str::FromStr;
use token::Token;

/// The greatest depth of a formula: deeper than people write, and less deep than the stack allows.
const DEEPEST: usize = 200;

/// The greatest number of values that are parsed one inside the other. A formula is written with parentheses around
/// each part, and has to be read again: each level of the formula then takes two.
const MOST_OPEN: usize = 2 * DEEPEST + 1;

const WORDS: [&str; 17] = [
    "not",
    "and",
    "or",
    "implies",
    "always",
    "eventually",
    "historically",
    "once",
    "until",
    "release",
    "since",
    "true",
    "false",
    "abs",
    "min",
    "max",
    "inf",
];
const LETTERS: [&str; 7] = ["G", "F", "H", "O", "U", "R", "S"];

const A_FORMULA: &str = "a formula";
const A_NUMBER: &str = "a number or a signal";
const A_COMPARISON: &str = "a comparison such as `<`";
const AN_OPERATOR: &str = "an operator or the end";

/// Returns `true` if the name of a signal needs no quotation marks.
pub(crate) fn is_plain_name(name: &str) -> bool {
    token::is_word(name) && !is_reserved(name)
}

fn is_reserved(word: &str) -> bool {
    WORDS.contains(&word) || LETTERS.contains(&word)
}

impl Formula {
    /// Parses a formula that may name only the given signals. If it names another signal, the error suggests the
    /// nearest given signal.
    ///
    /// # Errors
    /// The text is not a formula, or names another signal.
    ///
    /// ```
    /// # use paracosm_oracles::Formula;
    /// let error = Formula::parse("always (sped < 120)", &["time", "speed"]).unwrap_err();
    /// assert_eq!(error.to_string(), "column 9: found `sped`, expected a signal of the trace (did you mean `speed`?)");
    /// ```
    pub fn parse(text: &str, signals: &[impl AsRef<str>]) -> Result<Self, ParseError> {
        parse(text, Some(signals.iter().map(AsRef::as_ref).collect()))
    }
}

/// Parses a formula over any signals.
impl FromStr for Formula {
    type Err = ParseError;

    fn from_str(text: &str) -> Result<Self, ParseError> {
        parse(text, None)
    }
}

fn parse(text: &str, signals: Option<Vec<&str>>) -> Result<Formula, ParseError> {
    let mut parser = Parser { tokens: token::tokens(text)?, at: 0, open: 0, signals };
    let value = parser.value(0, A_FORMULA)?;
    if *parser.next() != Token::End {
        return Err(parser.unexpected(AN_OPERATOR));
    }
    Ok(parser.formula(value)?.0)
}

/// A parsed piece of text, with the depth of its nesting.
enum Value {
    Formula(Formula, usize),
    Number(Expression, usize),
}

struct Parser<'a> {
    tokens: Vec<(usize, Token)>,
    at: usize,
    /// The number of values that are being parsed, one inside the other.
    open: usize,
    signals: Option<Vec<&'a str>>,
}

impl Parser<'_> {
    fn next(&self) -> &Token {
        &self.tokens[self.at].1
    }

    fn advance(&mut self) -> Token {
        let token = self.next().clone();
        self.at = (self.at + 1).min(self.tokens.len() - 1);
        token
    }

    fn is_next(&self, symbol: &str) -> bool {
        matches!(self.next(), Token::Symbol(next) if *next == symbol)
    }

    fn expect(&mut self, symbol: &'static str) -> Result<(), ParseError> {
        if !self.is_next(symbol) {
            return Err(self.unexpected(&format!("`{symbol}`")));
        }
        self.advance();
        Ok(())
    }

    /// Returns the error that the next token is not the expected token.
    fn unexpected(&self, expected: &str) -> ParseError {
        self.refuse(expected, self.misspelt())
    }

    fn refuse(&self, expected: &str, help: Option<String>) -> ParseError {
        let (column, token) = &self.tokens[self.at];
        ParseError { column: *column, found: token.to_string(), expected: expected.to_owned(), help }
    }

    /// Suggests a word of the language if the previous name is probably a mistyped word, since a value follows the
    /// name.
    fn misspelt(&self) -> Option<String> {
        let Token::Word(previous) = &self.tokens[self.at.checked_sub(1)?].1 else { return None };
        let value = matches!(self.next(), Token::Symbol("(" | "[" | "~") | Token::Word(_) | Token::Number(_));
        if is_reserved(previous) || !value {
            return None;
        }
        nearest(previous, WORDS).map(|word| format!("did you mean `{word}` instead of `{previous}`?"))
    }

    /// Parses a value whose operators bind at least as strongly as `least`.
    fn value(&mut self, least: u8, expected: &str) -> Result<Value, ParseError> {
        self.open += 1;
        if self.open > MOST_OPEN {
            return Err(self.too_deep());
        }
        let mut left = self.operand(expected)?;
        let mut unchained = u8::MAX;
        while let Some(infix) = Infix::of(self.next()) {
            let strength = infix.strength();
            if strength < least {
                break;
            }
            if strength == unchained {
                return Err(self.refuse(AN_OPERATOR, Some(infix.unchained().to_owned())));
            }
            left = self.infix(left, infix)?;
            if matches!(infix, Infix::Compare(_) | Infix::Sequence(_)) {
                unchained = strength;
            }
        }
        self.open -= 1;
        Ok(left)
    }

    fn too_deep(&self) -> ParseError {
        self.refuse(&format!("a formula with at most {DEEPEST} levels of nesting"), None)
    }

    /// Returns the depth of a value that joins two parts of these depths.
    fn deeper(&self, left: usize, right: usize) -> Result<usize, ParseError> {
        let depth = 1 + left.max(right);
        if depth > DEEPEST { Err(self.too_deep()) } else { Ok(depth) }
    }

    fn infix(&mut self, left: Value, infix: Infix) -> Result<Value, ParseError> {
        let strength = infix.strength();
        match infix {
            Infix::Compare(_) | Infix::Arithmetic(_) => {
                let (left, l) = self.number(left)?;
                self.advance();
                let right = self.value(strength + 1, A_NUMBER)?;
                let (right, r) = self.number(right)?;
                let depth = self.deeper(l, r)?;
                Ok(match infix {
                    Infix::Compare(comparison) => Value::Formula(left.compare(comparison, right), depth),
                    Infix::Arithmetic(operation) => {
                        Value::Number(Expression::Binary(operation, Box::new(left), Box::new(right)), depth)
                    }
                    Infix::Join(_) | Infix::Sequence(_) => unreachable!("the outer match has taken them"),
                })
            }
            Infix::Join(connective) => {
                let (left, l) = self.formula(left)?;
                self.advance();
                let right = self.value(strength + u8::from(connective != Connective::Implies), A_FORMULA)?;
                let (right, r) = self.formula(right)?;
                let depth = self.deeper(l, r)?;
                Ok(Value::Formula(Formula::Join(connective, Box::new(left), Box::new(right)), depth))
            }
            Infix::Sequence(sequence) => {
                let (left, l) = self.formula(left)?;
                self.advance();
                let interval = self.interval()?;
                let right = self.value(strength + 1, A_FORMULA)?;
                let (right, r) = self.formula(right)?;
                let depth = self.deeper(l, r)?;
                Ok(Value::Formula(Formula::Sequence(sequence, interval, Box::new(left), Box::new(right)), depth))
            }
        }
    }

    /// Converts a value into a formula. A signal alone is a formula.
    fn formula(&self, value: Value) -> Result<(Formula, usize), ParseError> {
        match value {
            Value::Formula(formula, depth) => Ok((formula, depth)),
            Value::Number(Expression::Signal(name), depth) => Ok((Formula::Flag(name), depth)),
            Value::Number(..) => Err(self.unexpected(A_COMPARISON)),
        }
    }

    /// Converts a value into a number, for the operator that comes next.
    fn number(&self, value: Value) -> Result<(Expression, usize), ParseError> {
        match value {
            Value::Number(number, depth) => Ok((number, depth)),
            Value::Formula(formula, _) => {
                let help = format!("`{formula}` is true or false, not a number");
                Err(self.refuse("an operator between formulas or the end", Some(help)))
            }
        }
    }

    fn operand(&mut self, expected: &str) -> Result<Value, ParseError> {
        match self.next().clone() {
            Token::Number(number) => {
                self.advance();
                Ok(Value::Number(Expression::Number(number), 1))
            }
            Token::Symbol("(") => {
                self.advance();
                let value = self.value(0, expected)?;
                if !self.is_next(")") {
                    return Err(self.unexpected("an operator or `)`"));
                }
                self.advance();
                Ok(value)
            }
            Token::Symbol("-") => {
                self.advance();
                if let Token::Number(number) = *self.next() {
                    self.advance();
                    return Ok(Value::Number(Expression::Number(-number), 1));
                }
                let inner = self.value(strength::SIGN, A_NUMBER)?;
                let (inner, depth) = self.number(inner)?;
                Ok(Value::Number(-inner, self.deeper(depth, 0)?))
            }
            Token::Quoted(name) => self.signal(name),
            Token::Word(word) => self.word(word, expected),
            Token::Symbol(_) | Token::End => Err(self.unexpected(expected)),
        }
    }

    fn word(&mut self, word: String, expected: &str) -> Result<Value, ParseError> {
        let modality = match word.as_str() {
            "true" | "false" if expected != A_NUMBER => {
                self.advance();
                return Ok(Value::Formula(Formula::Constant(word == "true"), 1));
            }
            "abs" => return self.function(None),
            "min" => return self.function(Some(Arithmetic::Least)),
            "max" => return self.function(Some(Arithmetic::Greatest)),
            "not" => None,
            "always" | "G" => Some(Modality::Always),
            "eventually" | "F" => Some(Modality::Eventually),
            "historically" | "H" => Some(Modality::Historically),
            "once" | "O" => Some(Modality::Once),
            word if is_reserved(word) => return Err(self.refuse(expected, Some(quotes(word)))),
            _ => return self.signal(word),
        };
        if expected == A_NUMBER {
            return Err(self.refuse(expected, Some(quotes(&word))));
        }
        self.advance();
        let interval = if modality.is_some() { self.interval()? } else { Interval::UNBOUNDED };
        let inner = self.value(strength::PREFIX, A_FORMULA)?;
        let (inner, depth) = self.formula(inner)?;
        let formula = match modality {
            None => !inner,
            Some(modality) => Formula::Modal(modality, interval, Box::new(inner)),
        };
        Ok(Value::Formula(formula, self.deeper(depth, 0)?))
    }

    fn signal(&mut self, name: String) -> Result<Value, ParseError> {
        if let Some(signals) = &self.signals
            && !signals.contains(&name.as_str())
        {
            let near = nearest(&name, signals.iter().copied());
            let help = match near {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("the signals of the trace are {}", signals.join(", ")),
            };
            return Err(self.refuse("a signal of the trace", Some(help)));
        }
        self.advance();
        Ok(Value::Number(Expression::Signal(name), 1))
    }

    /// Parses `abs`, or an operation that is written as a function of two numbers.
    fn function(&mut self, operation: Option<Arithmetic>) -> Result<Value, ParseError> {
        self.advance();
        self.expect("(")?;
        let (first, mut depth) = self.argument()?;
        let number = match operation {
            None => first.abs(),
            Some(operation) => {
                self.expect(",")?;
                let (second, other) = self.argument()?;
                depth = depth.max(other);
                Expression::Binary(operation, Box::new(first), Box::new(second))
            }
        };
        self.expect(")")?;
        Ok(Value::Number(number, self.deeper(depth, 0)?))
    }

    fn argument(&mut self) -> Result<(Expression, usize), ParseError> {
        let value = self.value(strength::SUM, A_NUMBER)?;
        self.number(value)
    }

    /// Parses the interval behind a temporal operator, or returns the unbounded interval if the text has none.
    fn interval(&mut self) -> Result<Interval, ParseError> {
        let outward = self.is_next("~");
        if outward {
            self.advance();
        }
        if !outward && !self.is_next("[") {
            return Ok(Interval::UNBOUNDED);
        }
        self.expect("[")?;
        let (_, start) = self.bound("a time in seconds, from 0 on", false)?;
        self.expect(",")?;
        let (at, end) = self.bound("a time in seconds, or `inf`", true)?;
        let interval = Interval { start, end, outward };
        if !interval.is_valid() {
            self.at = at;
            return Err(self.refuse(&format!("a time of at least {start} s"), None));
        }
        self.expect("]")?;
        Ok(interval)
    }

    /// Parses a time bound, and returns its place and its value.
    fn bound(&mut self, expected: &str, endless: bool) -> Result<(usize, f64), ParseError> {
        let at = self.at;
        let bound = match self.next() {
            Token::Number(bound) => *bound,
            Token::Word(word) if word == "inf" && endless => f64::INFINITY,
            _ => return Err(self.refuse(expected, None)),
        };
        self.advance();
        Ok((at, bound))
    }
}

fn quotes(word: &str) -> String {
    format!("`{word}` is a word of the language; write a signal of this name in quotes")
}
