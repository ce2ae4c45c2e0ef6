//! Reads the constraints of a model: `IF .. THEN .. ELSE ..;` and statements without a condition.

use super::parameters::{Declarations, Declared};
use super::terms;
use super::tokens::{Token, tokens};
use super::{Fault, OPENING, PictFlaw, Section, fail};
use crate::constraint::{Expression, Relation};
use crate::names::{did_you_mean, nearest};
use crate::plural;
use crate::{Position, Value};
use std::fmt;
use std::ops::Range;

/// The greatest depth to which parentheses and `NOT` may be nested.
const DEEPEST: usize = 48;

/// The most pairs of values in a comparison of two parameters.
const MOST_PAIRS: usize = 10_000_000;

/// The most notes on values that no parameter takes.
const MOST_NOTES: usize = 20;

const RELATIONS: [(&str, Relation); 6] = [
    ("=", Relation::Equal),
    ("<>", Relation::NotEqual),
    ("<", Relation::Less),
    ("<=", Relation::LessOrEqual),
    (">", Relation::Greater),
    (">=", Relation::GreaterOrEqual),
];

/// A constraint, and its place in the file.
pub(super) struct Statement {
    pub(super) span: Range<usize>,
    pub(super) expression: Expression,
}

/// A token that may stand at a place: a certain word or sign of the language, or another token in words.
enum Wanted {
    Exactly(&'static str),
    A(&'static str),
}
use Wanted::{A, Exactly};

impl fmt::Display for Wanted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Exactly(word) => write!(f, "`{word}`"),
            A(thing) => f.write_str(thing),
        }
    }
}

/// Reads the constraints of the text from `start` on.
pub(super) fn read(
    text: &str,
    start: usize,
    declared: &Declarations,
    notes: &mut Vec<String>,
) -> Result<Vec<Statement>, Fault> {
    let tokens = tokens(text, start);
    let mut reader = Reader { text, tokens, next: 0, depth: 0, declared, notes, unknown: None, never: 0 };
    let mut statements = Vec::new();
    while *reader.peek() != Token::End {
        let begin = reader.offset();
        let expression = reader.statement()?;
        match reader.unknown.take() {
            // The last sign was a semicolon.
            None => statements.push(Statement { span: begin..reader.tokens[reader.next - 1].1 + 1, expression }),
            Some((at, unknown)) => {
                let Position { line, column } = Position::of(text, at);
                reader.notes.push(format!("line {line}, column {column}: {unknown}, so this constraint is ignored"));
            }
        }
    }
    if let Some(more @ 1..) = reader.never.checked_sub(MOST_NOTES) {
        let values = plural(more, "further value");
        reader.notes.push(format!("the constraints name {values} that the parameter in the comparison never has"));
    }
    Ok(statements)
}

struct Reader<'a> {
    text: &'a str,
    tokens: Vec<(Token, usize)>,
    next: usize,
    depth: usize,
    declared: &'a Declarations,
    notes: &'a mut Vec<String>,
    /// The first name in the current constraint that no parameter has, with its place.
    unknown: Option<(usize, PictFlaw)>,
    /// The number of values that no parameter takes.
    never: usize,
}

impl<'a> Reader<'a> {
    fn peek(&self) -> &Token {
        &self.tokens[self.next].0
    }

    fn offset(&self) -> usize {
        self.tokens[self.next].1
    }

    /// Returns the next token with its offset and moves on. The reader never moves behind [`Token::End`].
    fn take(&mut self) -> (Token, usize) {
        let taken = self.tokens[self.next].clone();
        self.next = (self.next + 1).min(self.tokens.len() - 1);
        taken
    }

    fn takes_word(&mut self, word: &str) -> bool {
        let there = self.peek().is(word);
        if there {
            self.take();
        }
        there
    }

    fn takes_sign(&mut self, sign: &'static str) -> bool {
        let there = *self.peek() == Token::Sign(sign);
        if there {
            self.take();
        }
        there
    }

    /// Returns the error that another token was expected.
    fn expected<T>(&self, wanted: &[Wanted]) -> Result<T, Fault> {
        let words = wanted.iter().filter_map(|wanted| match wanted {
            Exactly(word) => Some(*word),
            A(_) => None,
        });
        let meant = match self.peek() {
            Token::Broken(flaw) => return fail(self.offset(), flaw.clone()),
            Token::Word(word) => nearest(word, words),
            _ => None,
        };
        let expected = wanted.iter().map(Wanted::to_string).collect();
        fail(self.offset(), PictFlaw::Unexpected { found: self.peek().to_string(), expected, meant })
    }

    fn statement(&mut self) -> Result<Expression, Fault> {
        self.check_section()?;
        let statement = if self.takes_word("IF") {
            let condition = Box::new(self.predicate()?);
            if !self.takes_word("THEN") {
                return self.expected(&[Exactly("AND"), Exactly("OR"), Exactly("THEN")]);
            }
            let consequence = Expression::Implies(condition.clone(), Box::new(self.predicate()?));
            if self.takes_word("ELSE") {
                let otherwise = Expression::Implies(Box::new(Expression::Not(condition)), Box::new(self.predicate()?));
                Expression::And(vec![consequence, otherwise])
            } else if matches!(self.peek(), Token::Sign(";")) {
                consequence
            } else {
                return self.expected(&[Exactly("AND"), Exactly("OR"), Exactly("ELSE"), Exactly(";")]);
            }
        } else if matches!(self.peek(), Token::Word(_)) && !OPENING.iter().any(|word| self.peek().is(word)) {
            return self.expected(&[Exactly("IF"), Exactly("NOT"), Exactly("("), A("a parameter in brackets")]);
        } else {
            self.predicate()?
        };
        if self.takes_sign(";") { Ok(statement) } else { self.expected(&[Exactly("AND"), Exactly("OR"), Exactly(";")]) }
    }

    /// Checks that no parameter and no sub-model stands where a constraint should begin.
    fn check_section(&self) -> Result<(), Fault> {
        let line = self.text[self.offset()..].lines().next().unwrap_or_default();
        let found = match self.peek() {
            Token::Sign("{") => Section::SubModel,
            Token::Word(word) if line[word.len()..].trim_start().starts_with(':') => Section::Parameter,
            _ => return Ok(()),
        };
        fail(self.offset(), PictFlaw::Misplaced { found, after: Section::Constraint })
    }

    fn predicate(&mut self) -> Result<Expression, Fault> {
        let mut cases = vec![self.conjunction()?];
        while self.takes_word("OR") {
            cases.push(self.conjunction()?);
        }
        Ok(if cases.len() == 1 { cases.remove(0) } else { Expression::Or(cases) })
    }

    fn conjunction(&mut self) -> Result<Expression, Fault> {
        let mut parts = vec![self.factor()?];
        while self.takes_word("AND") {
            parts.push(self.factor()?);
        }
        Ok(if parts.len() == 1 { parts.remove(0) } else { Expression::And(parts) })
    }

    fn factor(&mut self) -> Result<Expression, Fault> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return fail(self.offset(), PictFlaw::TooDeep { most: DEEPEST });
        }
        let open = self.offset();
        let factor = if self.takes_word("NOT") {
            Expression::Not(Box::new(self.factor()?))
        } else if self.takes_sign("(") {
            let inner = self.predicate()?;
            if *self.peek() == Token::End {
                return fail(open, PictFlaw::NeverClosed);
            }
            if !self.takes_sign(")") {
                return self.expected(&[Exactly("AND"), Exactly("OR"), Exactly(")")]);
            }
            inner
        } else {
            self.term()?
        };
        self.depth -= 1;
        Ok(factor)
    }

    fn term(&mut self) -> Result<Expression, Fault> {
        for (word, negative) in [("IsNegative", true), ("IsPositive", false)] {
            if self.takes_word(word) {
                return self.sign(negative);
            }
        }
        let name = match self.peek().clone() {
            Token::Name(name) => name,
            Token::Word(word) => return fail(self.offset(), PictFlaw::NoBrackets { word }),
            _ => return self.expected(&[A("a parameter in brackets"), Exactly("NOT"), Exactly("(")]),
        };
        let Some(parameter) = self.parameter(&name) else { return Ok(self.skip()) };
        self.take();
        let operator = self.offset();
        let denied = self.takes_word("NOT");
        let term = if self.takes_word("IN") {
            self.list(parameter)?
        } else if self.peek().is("LIKE") {
            if parameter.numeric {
                return fail(operator, PictFlaw::PatternOfNumbers { name: parameter.name.clone() });
            }
            self.take();
            let Token::Text(pattern) = self.peek().clone() else { return self.expected(&[A("a pattern in quotes")]) };
            self.take();
            terms::like(parameter, &pattern)
        } else if denied {
            return self.expected(&[Exactly("IN"), Exactly("LIKE")]);
        } else {
            self.relation(parameter)?
        };
        Ok(if denied { Expression::Not(Box::new(term)) } else { term })
    }

    /// Finds the parameter of this name. The name is the next token. If no parameter has the name, the constraint says
    /// nothing about the model, and `None` is returned.
    fn parameter(&mut self, name: &str) -> Option<&'a Declared> {
        let at = self.offset();
        let found = self.declared.find(name);
        found.map(|i| &self.declared[i]).map_err(|flaw| self.unknown.get_or_insert((at, flaw))).ok()
    }

    /// Skips the rest of a comparison with an unknown parameter. The returned expression replaces the comparison. The
    /// constraint is ignored anyway.
    fn skip(&mut self) -> Expression {
        self.take();
        let mut depth = 0;
        loop {
            let ends = ["AND", "OR", "THEN", "ELSE"].iter().any(|word| self.peek().is(word));
            match self.peek() {
                Token::End | Token::Broken(_) | Token::Sign(";") => break,
                Token::Sign(")") if depth == 0 => break,
                _ if ends && depth == 0 => break,
                Token::Sign("(") => depth += 1,
                Token::Sign(")") => depth -= 1,
                _ => {}
            }
            self.take();
        }
        Expression::And(Vec::new())
    }

    /// Reads the arguments of `IsNegative` or `IsPositive`.
    fn sign(&mut self, negative: bool) -> Result<Expression, Fault> {
        if !self.takes_sign("(") {
            return self.expected(&[Exactly("(")]);
        }
        let start = self.next;
        while !matches!(self.peek(), Token::Sign(")" | ";") | Token::Broken(_) | Token::End) {
            self.take();
        }
        if *self.peek() != Token::Sign(")") {
            return self.expected(&[Exactly(")")]);
        }
        let (from, to) = (self.tokens[start].1, self.offset());
        self.take();
        // The name may stand in brackets.
        let name = self.text[from..to].trim();
        let name = name.strip_prefix('[').and_then(|name| name.strip_suffix(']')).unwrap_or(name);
        if !name.is_empty() {
            return Ok(match self.declared.find(name) {
                Ok(i) => terms::of_sign(&self.declared[i], negative),
                Err(flaw) => {
                    self.unknown.get_or_insert((from, flaw));
                    Expression::And(Vec::new())
                }
            });
        }
        let with_negatives = self.declared.iter().filter(|parameter| parameter.has_negatives());
        let mut each: Vec<_> = with_negatives.map(|parameter| terms::of_sign(parameter, negative)).collect();
        Ok(match each.len() {
            // No parameter has negative values. All tests are positive, so any parameter gives the right expression.
            0 => terms::of_sign(&self.declared[0], negative),
            1 => each.remove(0),
            _ if negative => Expression::Or(each),
            _ => Expression::And(each),
        })
    }

    fn relation(&mut self, parameter: &'a Declared) -> Result<Expression, Fault> {
        let relation = RELATIONS.iter().find(|(sign, _)| *self.peek() == Token::Sign(sign));
        let Some((_, relation)) = relation.copied() else {
            let relations = RELATIONS.iter().map(|(sign, _)| Exactly(sign)).chain([Exactly("IN"), Exactly("LIKE")]);
            return self.expected(&relations.collect::<Vec<_>>());
        };
        let place = self.offset();
        self.take();
        if let Token::Name(name) = self.peek().clone() {
            let Some(other) = self.parameter(&name) else { return Ok(self.skip()) };
            if std::ptr::eq(parameter, other) {
                return fail(place, PictFlaw::ComparedToItself { name: parameter.name.clone() });
            }
            if parameter.values.len().saturating_mul(other.values.len()) > MOST_PAIRS {
                return fail(place, PictFlaw::TooManyPairs { most: MOST_PAIRS });
            }
            if parameter.numeric != other.numeric {
                let (numbers, words) = if parameter.numeric { (parameter, other) } else { (other, parameter) };
                let flaw = PictFlaw::NotCompared { numbers: numbers.name.clone(), words: words.name.clone() };
                return fail(place, flaw);
            }
            self.take();
            return Ok(terms::with_parameter(parameter, relation, other));
        }
        let (value, at) = self.value(parameter)?;
        if !relation.orders() {
            self.note_unknown(parameter, &value, at);
        }
        Ok(terms::with_value(parameter, relation, value))
    }

    /// Reads a number or a word, as the parameter's values require, and returns its offset too.
    fn value(&mut self, parameter: &Declared) -> Result<(Value, usize), Fault> {
        let (name, at) = (parameter.name.clone(), self.offset());
        let flaw = match self.peek().clone() {
            Token::Number(number) if parameter.numeric => {
                self.take();
                return Ok((Value::Number(number), at));
            }
            Token::Text(word) if !parameter.numeric => {
                self.take();
                return Ok((Value::Word(word), at));
            }
            Token::Number(number) => PictFlaw::NumberForWords { name, number },
            Token::Text(word) => PictFlaw::WordForNumbers { name, word },
            Token::Word(word) => PictFlaw::NoQuotes { word },
            _ if parameter.numeric => return self.expected(&[A("a number"), A("a parameter in brackets")]),
            _ => return self.expected(&[A("a word in quotes"), A("a parameter in brackets")]),
        };
        fail(at, flaw)
    }

    fn list(&mut self, parameter: &Declared) -> Result<Expression, Fault> {
        if !self.takes_sign("{") {
            return self.expected(&[A("`{` and the values")]);
        }
        let mut listed = Vec::new();
        loop {
            let (value, at) = self.value(parameter)?;
            self.note_unknown(parameter, &value, at);
            listed.push(value);
            if self.takes_sign("}") {
                break;
            }
            if !self.takes_sign(",") {
                return self.expected(&[Exactly(","), Exactly("}")]);
            }
        }
        Ok(terms::among(parameter, &listed))
    }

    /// Adds a note if the parameter never takes the value.
    fn note_unknown(&mut self, parameter: &Declared, value: &Value, at: usize) {
        if parameter.takes(value) {
            return;
        }
        self.never += 1;
        if self.never > MOST_NOTES {
            return;
        }
        let words = parameter.values.iter().map(|listed| listed.text.as_str());
        let meant = value.word().and_then(|word| nearest(word, words));
        let Position { line, column } = Position::of(self.text, at);
        self.notes.push(format!(
            "line {line}, column {column}: parameter `{}` never has the value `{value}`{}",
            parameter.name,
            did_you_mean(&meant)
        ));
    }
}
