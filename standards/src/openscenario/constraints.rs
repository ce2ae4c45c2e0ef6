//! Constraint groups of parameters as constraints of the space of tests.
//!
//! A limit may be an expression of other parameters, and a parameter may follow from others. So both sides of a comparison are
//! written as terms of the parameters of tests. Parameters that change together are one parameter of tests, whose values are
//! tuples. A constraint on a part of a tuple is written for each tuple by itself.

use super::demand::{Demand, Limit};
use super::kind::Kind;
use super::parameters::Parameters;
use super::rule::Rule;
use super::scope::Scope;
use crate::xml::{Expression as Computed, ExpressionFlaw, Flaw, MOST_OPERATORS, ReadError};
use paracosm_engine::Constraint;
use paracosm_space::Value;
use paracosm_space::constraint::{Expression, Function, Operand, Relation, Term};
use std::cell::Cell;

/// The statement that the demands of a declared parameter make about a test.
#[derive(Debug, Clone, PartialEq)]
enum Said {
    /// The demands hold in every test.
    Always,
    /// The demands hold in no test.
    Never,
    /// The demands hold in the tests that keep the expression.
    If(Expression),
}

/// The value of a parameter or of an attribute in all tests.
#[derive(Debug, Clone)]
enum Symbol {
    /// The same value in all tests.
    Value(Value),
    /// The value of a parameter of tests, of the given type.
    Parameter(String, Kind),
    /// A number that is computed from parameters of tests.
    Term(Term),
}

/// Parameters, some of them with the values of one tuple.
struct Writer<'a> {
    parameters: &'a Parameters,
    /// The declared parameters, first those of the whole scenario.
    scope: &'a Scope,
    fixed: Vec<(String, Value)>,
    /// The number of expressions that are being written, each within the one before.
    depth: Cell<usize>,
}

/// Writes the demands on the parameters of the whole scenario as constraints of the space.
///
/// # Errors
/// A limit names an unknown parameter, or cannot be computed with. No test keeps the demands.
pub(super) fn of_scenario(parameters: &Parameters) -> Result<Vec<Constraint>, ReadError> {
    let scope = parameters.texts();
    let one = |(at, demand)| constraint(parameters, &scope, at, demand).transpose();
    parameters.demands().enumerate().filter_map(one).collect()
}

/// Writes the demands on a parameter of a scope as a constraint of the space; `None` if they hold in every test.
///
/// # Errors
/// A limit names an unknown parameter, or cannot be computed with. No test keeps the demands.
pub(super) fn constraint(
    parameters: &Parameters,
    scope: &Scope,
    at: usize,
    demand: &Demand,
) -> Result<Option<Constraint>, ReadError> {
    if !demand.depends_on_values() {
        return Ok(None);
    }
    let cases = parameters.cases(scope.sources(at, demand.limits()));
    let said = Writer { parameters, scope, fixed: Vec::new(), depth: Cell::new(0) }.cases(at, demand, &cases)?;
    match said {
        Said::Always => Ok(None),
        Said::If(expression) => Ok(Some(Constraint { expression, place: Some(demand.place()) })),
        Said::Never => {
            let (element, attribute) = ("ParameterDeclaration".to_owned(), "name".to_owned());
            let expected = "a parameter with a value that its type and its constraints allow".to_owned();
            let found = demand.name.clone();
            Err(demand.error(Flaw::Value { element, attribute, found, expected, nearest: None }))
        }
    }
}

impl Writer<'_> {
    /// Writes the demands for each value of the parameters of tests that are written value by value.
    fn cases(&mut self, at: usize, demand: &Demand, split: &[(String, Vec<Value>)]) -> Result<Said, ReadError> {
        let Some(((name, values), rest)) = split.split_first() else { return self.demands(at, demand) };
        let mut parts = Vec::new();
        for value in values {
            self.fixed.push((name.clone(), value.clone()));
            let said = self.cases(at, demand, rest);
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

    fn demands(&self, at: usize, demand: &Demand) -> Result<Said, ReadError> {
        let unknown = |flaw| {
            let (element, attribute) = ("ParameterDeclaration".to_owned(), "name".to_owned());
            demand.error(Flaw::Expression { element, attribute, text: demand.name.clone(), flaw })
        };
        let value = self.value(at).map_err(unknown)?.of(demand.kind);
        let limit = |limit: &Limit| {
            let known = self.text(&limit.text, self.scope.len());
            known
                .and_then(|known| compared(limit.rule, &value, &known.of(demand.kind)))
                .map_err(|flaw| limit.error(flaw))
        };
        let group =
            |limits: &Vec<Limit>| Ok(joined(true, limits.iter().map(limit).collect::<Result<Vec<_>, ReadError>>()?));
        let groups = demand.groups.iter().map(group).collect::<Result<Vec<_>, ReadError>>()?;
        let groups = if groups.is_empty() { Said::Always } else { joined(false, groups) };
        Ok(joined(true, vec![of_kind(&value, demand.kind), groups]))
    }

    /// Returns the value of a parameter of the scope.
    fn value(&self, at: usize) -> Result<Symbol, ExpressionFlaw> {
        if let Some((text, among)) = self.scope.local(at) {
            return self.text(text, among);
        }
        let declaration = self.parameters.declaration(at);
        let Some(name) = self.parameters.source(declaration) else { return self.text(&declaration.text, at) };
        Ok(match self.fixed.iter().find(|(fixed, _)| *fixed == name) {
            Some((_, value)) => Symbol::Value(self.parameters.part(declaration, value)),
            None => Symbol::Parameter(name, declaration.demand.kind),
        })
    }

    /// Returns the value of the text of an attribute that sees the first `among` parameters.
    fn text(&self, text: &str, among: usize) -> Result<Symbol, ExpressionFlaw> {
        let Some(name) = text.strip_prefix('$') else { return Ok(Symbol::Value(Value::parse(text))) };
        match name.strip_prefix('{').map(|inside| inside.strip_suffix('}')) {
            None => self.value(self.scope.find(among, name)?),
            Some(None) => Err(ExpressionFlaw::Unexpected { found: text.to_owned(), expected: "`}` at the end" }),
            Some(Some(inside)) => {
                let depth = self.depth.get();
                if depth > MOST_OPERATORS {
                    return Err(ExpressionFlaw::TooLong);
                }
                self.depth.set(depth + 1);
                let term = |name: &str| self.value(self.scope.find(among, name)?)?.term();
                let written = Computed::parse(inside)?.term(&term)?;
                self.depth.set(depth);
                match written {
                    Term::Number(number) => Ok(Symbol::Value(Value::Number(number))),
                    // Each parameter may name an earlier one several times.
                    term if term.operators() > MOST_OPERATORS => Err(ExpressionFlaw::TooLong),
                    term => Ok(Symbol::Term(term)),
                }
            }
        }
    }
}

impl Symbol {
    /// Returns the symbol with its value as values of a type are.
    fn of(self, kind: Kind) -> Self {
        if let Self::Value(value) = self { Self::Value(kind.value(&value.to_string())) } else { self }
    }

    fn term(self) -> Result<Term, ExpressionFlaw> {
        match self {
            Self::Value(Value::Number(number)) => Ok(Term::Number(number)),
            Self::Value(other) => Err(ExpressionFlaw::Type { found: other.to_string(), expected: "a number" }),
            Self::Parameter(name, kind) if kind.is_text() => {
                Err(ExpressionFlaw::Type { found: name, expected: "a number" })
            }
            Self::Parameter(name, _) => Ok(Term::Parameter(name)),
            Self::Term(term) => Ok(term),
        }
    }
}

/// Returns the statement that a value is of a type.
fn of_kind(value: &Symbol, kind: Kind) -> Said {
    match (value, kind) {
        (Symbol::Value(value), _) => Said::of(kind.takes(&value.to_string())),
        (Symbol::Parameter(_, known), _) if *known == kind || known.is_text() => Said::Always,
        (_, Kind::Whole(least, most)) => {
            let Ok(term) = value.clone().term() else { return Said::Always };
            let rest = Term::Applied(Function::Remainder, vec![term.clone(), Term::Number(1.0)]);
            let relate = |left: &Term, relation, right: f64| {
                Said::If(Expression::Relate { left: left.clone(), relation, right: Term::Number(right) })
            };
            joined(
                true,
                vec![
                    relate(&rest, Relation::Equal, 0.0),
                    relate(&term, Relation::GreaterOrEqual, least as f64),
                    relate(&term, Relation::LessOrEqual, most as f64),
                ],
            )
        }
        _ => Said::Always,
    }
}

fn compared(rule: Rule, value: &Symbol, limit: &Symbol) -> Result<Said, ExpressionFlaw> {
    let relation = rule.relation();
    let compare = |parameter: &String, kind: Kind, relation, value: &Value| {
        let value = if kind.is_text() { Value::from(value.to_string().as_str()) } else { value.clone() };
        Said::If(Expression::Compare { parameter: parameter.clone(), relation, with: Operand::Value(value) })
    };
    Ok(match (value, limit) {
        (Symbol::Value(value), Symbol::Value(limit)) => Said::of(rule.holds(value, limit)),
        (Symbol::Parameter(name, kind), Symbol::Value(limit)) => compare(name, *kind, relation, limit),
        (Symbol::Value(value), Symbol::Parameter(name, kind)) => compare(name, *kind, relation.mirrored(), value),
        (Symbol::Parameter(name, _), Symbol::Parameter(other, _)) => {
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
