//! Constraint groups of parameters as constraints of the space of tests.
//!
//! A limit may be an expression of other parameters, and a parameter may follow from others. So both sides of a comparison are
//! written as terms of the parameters of tests. Parameters that change together are one parameter of tests, whose values are
//! tuples. A constraint on a part of a tuple is written for each tuple by itself.

use super::parameters::{Declaration, Parameters};
use super::rule::Rule;
use crate::xml::{Expression as Computed, ExpressionFlaw};
use paracosm_space::constraint::{Expression, Operand, Relation, Term};
use paracosm_space::{Value, nearest};

/// What the constraint groups of a declared parameter say.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Said {
    /// The groups hold in every test.
    Always,
    /// No group holds in any test.
    Never,
    /// The groups hold in the tests that keep the expression.
    If(Expression),
}

/// The value of a parameter or of an attribute in all tests.
#[derive(Debug, Clone)]
enum Symbol {
    /// The same value in all tests.
    Value(Value),
    /// The value of a parameter of tests. Values of a parameter that takes texts are texts also if they look like numbers.
    Parameter { name: String, takes_texts: bool },
    /// A number that is computed from parameters of tests.
    Term(Term),
}

/// The declared parameters, some of them with the values of one tuple.
struct Writer<'a> {
    parameters: &'a Parameters,
    fixed: Vec<(String, Value)>,
}

/// Writes the constraint groups of a declared parameter.
///
/// # Errors
/// A limit names an unknown parameter, or cannot be computed with.
pub(super) fn written(parameters: &Parameters, declaration: &Declaration) -> Result<Said, ExpressionFlaw> {
    Writer { parameters, fixed: Vec::new() }.cases(declaration, &parameters.cases(declaration))
}

impl Writer<'_> {
    /// Writes the groups for each value of the parameters of tests that are written value by value.
    fn cases(&mut self, declaration: &Declaration, split: &[(String, Vec<Value>)]) -> Result<Said, ExpressionFlaw> {
        let Some(((name, values), rest)) = split.split_first() else { return self.groups(declaration) };
        let mut parts = Vec::new();
        for value in values {
            self.fixed.push((name.clone(), value.clone()));
            let said = self.cases(declaration, rest);
            self.fixed.pop();
            let is = |relation| Expression::Compare {
                parameter: name.clone(),
                relation,
                with: Operand::Value(value.clone()),
            };
            parts.push(match said? {
                Said::Always => Said::Always,
                Said::Never => Said::If(is(Relation::NotEqual)),
                Said::If(then) => Said::If(Expression::Implies(Box::new(is(Relation::Equal)), Box::new(then))),
            });
        }
        Ok(joined(true, parts))
    }

    fn groups(&self, declaration: &Declaration) -> Result<Said, ExpressionFlaw> {
        let value = self.declared(declaration)?;
        let limit = |(rule, text): &(Rule, String)| compared(*rule, &value, &self.text(text)?);
        let group = |limits: &Vec<(Rule, String)>| {
            Ok(joined(true, limits.iter().map(limit).collect::<Result<Vec<_>, ExpressionFlaw>>()?))
        };
        Ok(joined(false, declaration.groups.iter().map(group).collect::<Result<Vec<_>, ExpressionFlaw>>()?))
    }

    /// Returns the value of a declared parameter.
    fn declared(&self, declaration: &Declaration) -> Result<Symbol, ExpressionFlaw> {
        let Some(name) = self.parameters.source(declaration) else { return self.text(&declaration.text) };
        if let Some((_, value)) = self.fixed.iter().find(|(fixed, _)| *fixed == name) {
            return Ok(Symbol::Value(self.parameters.part(declaration, value)));
        }
        Ok(Symbol::Parameter { name, takes_texts: declaration.takes_texts() })
    }

    /// Returns the value of the text of an attribute.
    fn text(&self, text: &str) -> Result<Symbol, ExpressionFlaw> {
        let Some(name) = text.strip_prefix('$') else { return Ok(Symbol::Value(super::distribution::parsed(text))) };
        match name.strip_prefix('{').map(|inside| inside.strip_suffix('}')) {
            None => self.named(name),
            Some(None) => Err(ExpressionFlaw::Unexpected { found: text.to_owned(), expected: "`}` at the end" }),
            Some(Some(inside)) => {
                let term = |name: &str| self.named(name)?.term();
                Ok(match Computed::parse(inside)?.term(&term)? {
                    Term::Number(number) => Symbol::Value(Value::Number(number)),
                    term => Symbol::Term(term),
                })
            }
        }
    }

    fn named(&self, name: &str) -> Result<Symbol, ExpressionFlaw> {
        let unknown = || {
            let nearest = nearest(name, self.parameters.names()).map(str::to_owned);
            ExpressionFlaw::NoParameter { name: name.to_owned(), nearest }
        };
        self.declared(self.parameters.find(name).ok_or_else(unknown)?)
    }
}

impl Symbol {
    fn term(self) -> Result<Term, ExpressionFlaw> {
        match self {
            Self::Value(Value::Number(number)) => Ok(Term::Number(number)),
            Self::Value(other) => Err(ExpressionFlaw::Type { found: other.to_string(), expected: "a number" }),
            Self::Parameter { name, takes_texts: true } => {
                Err(ExpressionFlaw::Type { found: name, expected: "a number" })
            }
            Self::Parameter { name, takes_texts: false } => Ok(Term::Parameter(name)),
            Self::Term(term) => Ok(term),
        }
    }
}

fn compared(rule: Rule, value: &Symbol, limit: &Symbol) -> Result<Said, ExpressionFlaw> {
    let relation = rule.relation();
    let compare = |parameter: &String, takes_texts: bool, relation, value: &Value| {
        let value = if takes_texts { Value::from(value.to_string().as_str()) } else { value.clone() };
        Said::If(Expression::Compare { parameter: parameter.clone(), relation, with: Operand::Value(value) })
    };
    Ok(match (value, limit) {
        (Symbol::Value(value), Symbol::Value(limit)) => Said::of(rule.holds(value, limit)),
        (Symbol::Parameter { name, takes_texts }, Symbol::Value(limit)) => compare(name, *takes_texts, relation, limit),
        (Symbol::Value(value), Symbol::Parameter { name, takes_texts }) => {
            compare(name, *takes_texts, relation.mirrored(), value)
        }
        (Symbol::Parameter { name, .. }, Symbol::Parameter { name: other, .. }) => {
            let with = Operand::Parameter(other.clone());
            Said::If(Expression::Compare { parameter: name.clone(), relation, with })
        }
        // A word is no number, and has no order.
        (Symbol::Value(Value::Word(_)), _) | (_, Symbol::Value(Value::Word(_))) => {
            Said::of(relation == Relation::NotEqual)
        }
        (value, limit) => {
            Said::If(Expression::Relate { left: value.clone().term()?, relation, right: limit.clone().term()? })
        }
    })
}

impl Said {
    fn of(holds: bool) -> Self {
        if holds { Self::Always } else { Self::Never }
    }
}

/// Joins statements by "and" (`all`) or by "or".
fn joined(all: bool, parts: Vec<Said>) -> Said {
    let mut left = Vec::new();
    for part in parts {
        match part {
            Said::If(expression) => left.push(expression),
            decided if decided == Said::of(all) => {}
            decided => return decided,
        }
    }
    match left.len() {
        0 => Said::of(all),
        1 => Said::If(left.remove(0)),
        _ if all => Said::If(Expression::And(left)),
        _ => Said::If(Expression::Or(left)),
    }
}
