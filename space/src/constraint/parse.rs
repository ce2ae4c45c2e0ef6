//! Parses a text into an expression, by recursive descent.

use super::expression::{Expression, Operand};
use super::token::{Token, tokens};
use super::written::KEYWORDS;
use super::{ConstraintError, ConstraintFlaw, Expected, Function, Term};
use crate::Value;
use crate::names::nearest;
use std::str::FromStr;

/// The greatest depth to which parentheses, `not` and `implies` may be nested.
const DEEPEST: usize = 128;
/// The greatest number of operators `+ - * / %` in a comparison. Each of them makes the tree of the comparison one level deeper.
const MOST_OPERATORS: usize = 1000;

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
    let mut parser = Parser { tokens: tokens(text)?, next: 0, depth: 0, operators: 0, places: Vec::new() };
    let expression = parser.implication()?;
    match parser.peek() {
        Token::End => Ok((expression, parser.places)),
        Token::Relation(_) => parser.fail(ConstraintFlaw::Chained),
        Token::Close => parser.fail(ConstraintFlaw::ClosesNothing),
        _ => parser.expected(Expected::Junction),
    }
}

/// One side of a comparison.
enum Side {
    Name(String),
    Value(Value),
    Term(Term),
}

impl Side {
    /// Returns the side as a term; `None` if the side is a word.
    fn term(self) -> Option<Term> {
        match self {
            Side::Name(name) => Some(Term::Parameter(name)),
            Side::Value(value) => value.number().map(Term::Number),
            Side::Term(term) => Some(term),
        }
    }
}

struct Parser {
    tokens: Vec<(Token, usize)>,
    next: usize,
    depth: usize,
    /// The number of operators of the comparison so far.
    operators: usize,
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
        self.nested(|parser| {
            let condition = parser.joined("or")?;
            Ok(if parser.takes(&Token::Keyword("implies")) {
                Expression::Implies(Box::new(condition), Box::new(parser.implication()?))
            } else {
                condition
            })
        })
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
        let mut expression = if !self.opens_term() && self.takes(&Token::Open) {
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

    /// Returns `true` if the next token is a parenthesis around a number, not around a condition.
    fn opens_term(&self) -> bool {
        let mut depth = 0;
        for (at, (token, _)) in self.tokens.iter().enumerate().skip(self.next) {
            match token {
                Token::Open => depth += 1,
                Token::Close => depth -= 1,
                Token::Relation(_) | Token::Keyword(_) | Token::ListOpen | Token::End => return false,
                _ => {}
            }
            if depth == 0 {
                let after = self.tokens.get(at + 1).map(|(token, _)| token);
                return at > self.next && matches!(after, Some(Token::Relation(_) | Token::Operator(_)));
            }
        }
        false
    }

    fn comparison(&mut self) -> Result<Expression, ConstraintError> {
        let offset = self.offset();
        self.operators = 0;
        let left = self.side(Expected::Condition)?;
        let relation = self.offset();
        let denied = self.takes(&Token::Keyword("not"));
        if self.takes(&Token::Keyword("in")) {
            let parameter = match left {
                Side::Name(parameter) => parameter,
                Side::Value(value) => {
                    let flaw = ConstraintFlaw::ValueBeforeIn { found: Token::Value(value).to_string() };
                    return Err(ConstraintError::at(offset, flaw));
                }
                Side::Term(term) => {
                    let flaw = ConstraintFlaw::ValueBeforeIn { found: format!("`{term}`") };
                    return Err(ConstraintError::at(offset, flaw));
                }
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
        let right = self.side(Expected::Operand)?;
        let (left_at, right_at, compared) = match (left, right) {
            (Side::Name(parameter), Side::Value(value)) => {
                (offset, other, Expression::Compare { parameter, relation: sign, with: Operand::Value(value) })
            }
            (Side::Name(parameter), Side::Name(with)) => {
                (offset, other, Expression::Compare { parameter, relation: sign, with: Operand::Parameter(with) })
            }
            (Side::Value(value), Side::Name(parameter)) => {
                let relation = sign.mirrored();
                (other, offset, Expression::Compare { parameter, relation, with: Operand::Value(value) })
            }
            (Side::Value(_), Side::Value(_)) => return Err(ConstraintError::at(offset, ConstraintFlaw::OnlyValues)),
            (left, right) => {
                let numbers = [(left, offset), (right, other)].map(|(side, at)| {
                    let word = if let Side::Value(value) = &side { value.to_string() } else { String::new() };
                    side.term().ok_or(ConstraintError::at(at, ConstraintFlaw::WordInTerm { word }))
                });
                let [left, right] = numbers;
                let compared = Expression::Relate { left: left?, relation: sign, right: right? };
                if compared.names().is_empty() {
                    return Err(ConstraintError::at(offset, ConstraintFlaw::OnlyValues));
                }
                (offset, other, compared)
            }
        };
        self.places.push(Places { left: left_at, relation, right: vec![right_at] });
        Ok(compared)
    }

    /// Parses one side of a comparison: a name, a value, or a term.
    fn side(&mut self, expected: Expected) -> Result<Side, ConstraintError> {
        if let Token::Value(value @ Value::Word(_)) = self.peek() {
            let value = value.clone();
            let at = self.offset();
            self.take();
            if matches!(self.peek(), Token::Operator(_)) {
                let word = value.to_string();
                return Err(ConstraintError::at(at, ConstraintFlaw::WordInTerm { word }));
            }
            return Ok(Side::Value(value));
        }
        Ok(match self.sum(expected)? {
            Term::Number(number) => Side::Value(Value::Number(number)),
            Term::Parameter(name) => Side::Name(name),
            term => Side::Term(term),
        })
    }

    /// Parses the sum of products, with `expected` at its beginning.
    fn sum(&mut self, expected: Expected) -> Result<Term, ConstraintError> {
        let mut sum = self.product(expected)?;
        while let Token::Operator(sign @ (Function::Add | Function::Subtract)) = *self.peek() {
            self.operator()?;
            sum = Term::Applied(sign, vec![sum, self.product(Expected::Number)?]);
        }
        Ok(sum)
    }

    fn product(&mut self, expected: Expected) -> Result<Term, ConstraintError> {
        let mut product = self.factor(expected)?;
        while let Token::Operator(sign @ (Function::Multiply | Function::Divide | Function::Remainder)) = *self.peek() {
            self.operator()?;
            product = Term::Applied(sign, vec![product, self.factor(Expected::Number)?]);
        }
        Ok(product)
    }

    /// Takes an operator between two operands.
    fn operator(&mut self) -> Result<(), ConstraintError> {
        self.operators += 1;
        if self.operators > MOST_OPERATORS {
            return self.fail(ConstraintFlaw::TooLong { most: MOST_OPERATORS });
        }
        self.take();
        Ok(())
    }

    fn factor(&mut self, expected: Expected) -> Result<Term, ConstraintError> {
        let at = self.offset();
        Ok(match self.peek().clone() {
            Token::Operator(Function::Subtract) => {
                self.take();
                self.nested(|parser| parser.factor(Expected::Number))?.negative()
            }
            Token::Value(Value::Number(number)) => {
                self.take();
                Term::Number(number)
            }
            Token::Value(word) => {
                return self.fail(ConstraintFlaw::WordInTerm { word: word.to_string() });
            }
            Token::Name(name) => {
                self.take();
                if *self.peek() == Token::Open { self.call(&name, at)? } else { Term::Parameter(name) }
            }
            // At the beginning of a condition, a parenthesis may stand around a condition.
            Token::Open if expected != Expected::Condition || self.opens_term() => {
                self.take();
                let inside = self.nested(|parser| parser.sum(Expected::Number))?;
                self.close(at)?;
                inside
            }
            _ => return self.expected(expected),
        })
    }

    /// Parses a part that is one level deeper.
    fn nested<T>(&mut self, parse: impl Fn(&mut Self) -> Result<T, ConstraintError>) -> Result<T, ConstraintError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return self.fail(ConstraintFlaw::TooDeep { most: DEEPEST });
        }
        let part = parse(self)?;
        self.depth -= 1;
        Ok(part)
    }

    /// Parses the operands of a function.
    fn call(&mut self, name: &str, at: usize) -> Result<Term, ConstraintError> {
        let Some(function) = Function::named(name) else {
            let nearest = nearest(name, Function::names());
            return Err(ConstraintError::at(at, ConstraintFlaw::UnknownFunction { name: name.to_owned(), nearest }));
        };
        let open = self.offset();
        self.take();
        let mut operands = vec![self.nested(|parser| parser.sum(Expected::Number))?];
        while operands.len() < function.operands() {
            if !self.takes(&Token::Comma) {
                return self.expected(Expected::Comma);
            }
            operands.push(self.nested(|parser| parser.sum(Expected::Number))?);
        }
        self.close(open)?;
        Ok(Term::Applied(function, operands))
    }

    fn close(&mut self, open: usize) -> Result<(), ConstraintError> {
        match self.peek() {
            Token::Close => {
                self.take();
                Ok(())
            }
            Token::End => Err(ConstraintError::at(open, ConstraintFlaw::NeverClosed)),
            _ => self.expected(Expected::OperatorOrClose),
        }
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
