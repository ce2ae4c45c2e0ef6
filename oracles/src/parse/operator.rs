//! Operators between two values.

use super::token::Token;
use crate::{Arithmetic, Comparison, Connective, Sequence};

/// The strengths with which operators bind, see the [module](super).
pub(super) mod strength {
    pub const IMPLIES: u8 = 1;
    pub const OR: u8 = 2;
    pub const AND: u8 = 3;
    pub const SEQUENCE: u8 = 4;
    pub const PREFIX: u8 = 5;
    pub const COMPARISON: u8 = 6;
    pub const SUM: u8 = 7;
    pub const PRODUCT: u8 = 8;
    pub const SIGN: u8 = 9;
}

/// An operator between two values.
#[derive(Clone, Copy)]
pub(super) enum Infix {
    Join(Connective),
    Sequence(Sequence),
    Compare(Comparison),
    Arithmetic(Arithmetic),
}

impl Infix {
    /// Returns the operator that a token stands for, or `None` if the token is no operator between two values.
    pub fn of(token: &Token) -> Option<Self> {
        let symbol = match token {
            Token::Word(word) => word.as_str(),
            Token::Symbol(symbol) => symbol,
            Token::Number(_) | Token::Quoted(_) | Token::End => return None,
        };
        Some(match symbol {
            "and" => Infix::Join(Connective::And),
            "or" => Infix::Join(Connective::Or),
            "implies" | "->" => Infix::Join(Connective::Implies),
            "until" | "U" => Infix::Sequence(Sequence::Until),
            "release" | "R" => Infix::Sequence(Sequence::Release),
            "since" | "S" => Infix::Sequence(Sequence::Since),
            "+" => Infix::Arithmetic(Arithmetic::Add),
            "-" => Infix::Arithmetic(Arithmetic::Subtract),
            "*" => Infix::Arithmetic(Arithmetic::Multiply),
            "/" => Infix::Arithmetic(Arithmetic::Divide),
            _ => Infix::Compare(Comparison::ALL.into_iter().find(|comparison| comparison.symbol() == symbol)?),
        })
    }

    /// Returns the strength with which the operator binds, as one of the numbers in [`strength`].
    pub fn strength(self) -> u8 {
        match self {
            Infix::Join(Connective::Implies) => strength::IMPLIES,
            Infix::Join(Connective::Or) => strength::OR,
            Infix::Join(Connective::And) => strength::AND,
            Infix::Sequence(_) => strength::SEQUENCE,
            Infix::Compare(_) => strength::COMPARISON,
            Infix::Arithmetic(Arithmetic::Add | Arithmetic::Subtract) => strength::SUM,
            Infix::Arithmetic(_) => strength::PRODUCT,
        }
    }

    /// Returns the advice for a user who chained the operator, as in `a < b < c`.
    pub fn unchained(self) -> &'static str {
        match self {
            Infix::Compare(_) => "comparisons do not chain: write `a < b and b < c`",
            _ => "`until`, `release` and `since` do not chain: use parentheses",
        }
    }
}
