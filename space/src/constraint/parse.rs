//! Parses a text into an expression, by recursive descent.

use super::expression::{Expression, KEYWORDS, Operand};
use super::token::{Token, tokens};
use super::{ConstraintError, ConstraintFlaw, Expected};
use crate::Value;
use crate::names::nearest;
use std::str::FromStr;

/// The greatest depth to which parentheses, `not` and `implies` may be nested.
const DEEPEST: usize = 128;

/// The places of the parts of a comparison, as offsets in bytes.
pub(super) struct Places {
    pub left: usize,
    pub relation: usize,
    pub right: Vec<usize>,
}

impl FromStr for Expression {
    type Err = ConstraintError;

    /// Reads the text of a constraint as an expression. The names are not checked: only a space knows its parameters.
    fn from_str(text: &str) -> Result<Self, ConstraintError> {
        parse(text).map(|(expression, _)| expression)
    }
}

/// Returns the expression, and the places of its comparisons in the order of the text.
pub(super) fn parse(text: &str) -> Result<(Expression, Vec<Places>), ConstraintError> {
    let mut parser = Parser { tokens: tokens(text)?, next: 0, depth: 0, places: Vec::new() };
    let expression = parser.implication()?;
    match parser.peek() {
        Token::End => Ok((expression, parser.places)),
        Token::Relation(_) => parser.fail(ConstraintFlaw::Chained),
        Token::Close => parser.fail(ConstraintFlaw::ClosesNothing),
        _ => parser.expected(Expected::Junction),
    }
}

struct Parser {
    tokens: Vec<(Token, usize)>,
    next: usize,
    depth: usize,
    places: Vec<Places>,
}

impl Parser {
    fn peek(&self) -> &Token {
        &self.tokens[self.next].0
    }

    fn offset(&self) -> usize {
        self.tokens[self.next].1
    }

    /// Returns the next token and moves on. The parser never moves behind [`Token::End`].
    fn take(&mut self) -> Token {
        let token = self.peek().clone();
        self.next = (self.next + 1).min(self.tokens.len() - 1);
        token
    }

    fn takes(&mut self, token: &Token) -> bool {
        let there = self.peek() == token;
        if there {
            self.take();
        }
        there
    }

    fn fail<T>(&self, flaw: ConstraintFlaw) -> Result<T, ConstraintError> {
        Err(ConstraintError::at(self.offset(), flaw))
    }

    fn expected<T>(&self, expected: Expected) -> Result<T, ConstraintError> {
        let meant = match self.peek() {
            Token::Name(name) => nearest(name, KEYWORDS).filter(|word| expected.keywords().contains(word)),
            _ => None,
        };
        self.fail(ConstraintFlaw::Unexpected { found: self.peek().to_string(), expected, meant })
    }

    fn implication(&mut self) -> Result<Expression, ConstraintError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return self.fail(ConstraintFlaw::TooDeep { most: DEEPEST });
        }
        let condition = self.joined("or")?;
        let expression = if self.takes(&Token::Keyword("implies")) {
            Expression::Implies(Box::new(condition), Box::new(self.implication()?))
        } else {
            condition
        };
        self.depth -= 1;
        Ok(expression)
    }

    /// Parses parts that `word` joins. The word `or` joins conjunctions, and `and` joins negations.
    fn joined(&mut self, word: &'static str) -> Result<Expression, ConstraintError> {
        let part = |parser: &mut Self| if word == "or" { parser.joined("and") } else { parser.negation() };
        let mut parts = vec![part(self)?];
        while self.takes(&Token::Keyword(word)) {
            parts.push(part(self)?);
        }
        Ok(match parts.len() {
            1 => parts.remove(0),
            _ if word == "or" => Expression::Or(parts),
            _ => Expression::And(parts),
        })
    }

    fn negation(&mut self) -> Result<Expression, ConstraintError> {
        let mut denials = 0;
        while self.takes(&Token::Keyword("not")) {
            denials += 1;
        }
        if self.depth + denials > DEEPEST {
            return self.fail(ConstraintFlaw::TooDeep { most: DEEPEST });
        }
        let open = self.offset();
        let mut expression = if self.takes(&Token::Open) {
            self.depth += denials;
            let inner = self.implication()?;
            self.depth -= denials;
            match self.peek() {
                Token::Close => self.take(),
                Token::End => {
                    return Err(ConstraintError::at(open, ConstraintFlaw::NeverClosed));
                }
                Token::Relation(_) => {
                    return self.fail(ConstraintFlaw::Chained);
                }
                _ => return self.expected(Expected::JunctionOrClose),
            };
            inner
        } else {
            self.comparison()?
        };
        for _ in 0..denials {
            expression = Expression::Not(Box::new(expression));
        }
        Ok(expression)
    }

    fn comparison(&mut self) -> Result<Expression, ConstraintError> {
        let offset = self.offset();
        let left = match self.peek() {
            Token::Name(_) | Token::Value(_) => self.take(),
            _ => return self.expected(Expected::Condition),
        };
        let relation = self.offset();
        let denied = self.takes(&Token::Keyword("not"));
        if self.takes(&Token::Keyword("in")) {
            let Token::Name(parameter) = left else {
                let flaw = ConstraintFlaw::ValueBeforeIn { found: left.to_string() };
                return Err(ConstraintError::at(offset, flaw));
            };
            let (values, right) = self.list()?;
            self.places.push(Places { left: offset, relation, right });
            let among = Expression::In { parameter, values };
            return Ok(if denied { Expression::Not(Box::new(among)) } else { among });
        }
        let Token::Relation(sign) = *self.peek() else {
            return self.expected(if denied { Expected::In } else { Expected::Comparison });
        };
        if denied {
            return self.expected(Expected::In);
        }
        self.take();
        let other = self.offset();
        let right = match self.peek() {
            Token::Name(_) | Token::Value(_) => self.take(),
            _ => return self.expected(Expected::Operand),
        };
        let (left_at, right_at, parameter, sign, with) = match (left, right) {
            (Token::Name(name), Token::Value(value)) => (offset, other, name, sign, Operand::Value(value)),
            (Token::Name(name), Token::Name(with)) => (offset, other, name, sign, Operand::Parameter(with)),
            (Token::Value(value), Token::Name(name)) => (other, offset, name, sign.mirrored(), Operand::Value(value)),
            _ => return Err(ConstraintError::at(offset, ConstraintFlaw::OnlyValues)),
        };
        self.places.push(Places { left: left_at, relation, right: vec![right_at] });
        Ok(Expression::Compare { parameter, relation: sign, with })
    }

    /// Parses a list, and returns its values with their offsets.
    fn list(&mut self) -> Result<(Vec<Value>, Vec<usize>), ConstraintError> {
        let (mut values, mut places) = (Vec::new(), Vec::new());
        if !self.takes(&Token::ListOpen) {
            return self.expected(Expected::List);
        }
        if self.takes(&Token::ListClose) {
            return Ok((values, places));
        }
        loop {
            places.push(self.offset());
            match self.peek().clone() {
                Token::Value(value) => values.push(value),
                _ => return self.expected(Expected::Value),
            }
            self.take();
            if self.takes(&Token::ListClose) {
                return Ok((values, places));
            }
            if !self.takes(&Token::Comma) {
                return self.expected(Expected::CommaOrClose);
            }
        }
    }
}
