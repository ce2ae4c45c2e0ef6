//! Prints formulas as text. Parsing the text gives the same formula.
//!
//! Comparisons always stand in parentheses. Joined formulas stand in parentheses if they are part of another formula.

use crate::parse::is_plain_name;
use crate::{Arithmetic, Connective, Expression, Formula, Modality, Sequence};
use std::fmt;

impl Connective {
    fn word(self) -> &'static str {
        match self {
            Connective::And => "and",
            Connective::Or => "or",
            Connective::Implies => "->",
        }
    }
}

impl Modality {
    fn word(self) -> &'static str {
        match self {
            Modality::Always => "always",
            Modality::Eventually => "eventually",
            Modality::Historically => "historically",
            Modality::Once => "once",
        }
    }
}

impl Sequence {
    fn word(self) -> &'static str {
        match self {
            Sequence::Until => "until",
            Sequence::Release => "release",
            Sequence::Since => "since",
        }
    }
}

impl fmt::Display for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Formula::Constant(truth) => write!(f, "{truth}"),
            Formula::Flag(name) => write!(f, "{}", Name(name)),
            Formula::Compare(left, comparison, right) => write!(f, "({left} {} {right})", comparison.symbol()),
            Formula::Not(inner) => write!(f, "not {}", Part(inner)),
            Formula::Join(connective, left, right) => {
                write!(f, "{} {} {}", Part(left), connective.word(), Part(right))
            }
            Formula::Modal(modality, interval, inner) => write!(f, "{}{interval} {}", modality.word(), Part(inner)),
            Formula::Sequence(sequence, interval, left, right) => {
                write!(f, "{} {}{interval} {}", Part(left), sequence.word(), Part(right))
            }
        }
    }
}

/// A formula that is part of another formula.
struct Part<'a>(&'a Formula);

impl fmt::Display for Part<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            joined @ (Formula::Join(..) | Formula::Sequence(..)) => write!(f, "({joined})"),
            other => write!(f, "{other}"),
        }
    }
}

/// The name of a signal, in quotation marks if it would otherwise have another meaning.
struct Name<'a>(&'a str);

impl fmt::Display for Name<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if is_plain_name(self.0) {
            return f.write_str(self.0);
        }
        write!(f, "\"{}\"", self.0.replace('\\', "\\\\").replace('"', "\\\""))
    }
}

/// Returns the strength with which an expression binds its parts.
fn strength(expression: &Expression) -> u8 {
    match expression {
        Expression::Binary(Arithmetic::Add | Arithmetic::Subtract, ..) => 1,
        Expression::Binary(Arithmetic::Multiply | Arithmetic::Divide, ..) => 2,
        _ => 3,
    }
}

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let within = |f: &mut fmt::Formatter<'_>, inner: &Expression, parentheses: bool| {
            if parentheses { write!(f, "({inner})") } else { write!(f, "{inner}") }
        };
        match self {
            Expression::Number(number) => write!(f, "{number}"),
            Expression::Signal(name) => write!(f, "{}", Name(name)),
            Expression::Negate(inner) => {
                f.write_str("-")?;
                // Without parentheses the minus sign would become part of the number.
                within(f, inner, strength(inner) < 3 || matches!(**inner, Expression::Number(_)))
            }
            Expression::Absolute(inner) => write!(f, "abs({inner})"),
            Expression::Binary(Arithmetic::Least, left, right) => write!(f, "min({left}, {right})"),
            Expression::Binary(Arithmetic::Greatest, left, right) => write!(f, "max({left}, {right})"),
            Expression::Binary(operation, left, right) => {
                let symbol = match operation {
                    Arithmetic::Add => "+",
                    Arithmetic::Subtract => "-",
                    Arithmetic::Multiply => "*",
                    _ => "/",
                };
                within(f, left, strength(left) < strength(self))?;
                write!(f, " {symbol} ")?;
                within(f, right, strength(right) <= strength(self))
            }
        }
    }
}
