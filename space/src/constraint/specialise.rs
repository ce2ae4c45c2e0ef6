//! A constraint on a space in which some parameters have fixed values.

use super::truth::{Known, truth};
use super::{Expression, Operand, Term};
use crate::{Value, Values};

/// The rest of an expression once some of its parameters are known.
#[derive(Debug, Clone, PartialEq)]
pub enum Specialised {
    /// The expression holds whatever values the other parameters have.
    Always,
    /// The expression never holds.
    Never,
    /// The expression depends on the other parameters.
    Open(Expression),
}

impl Expression {
    /// Returns `true` if the expression holds for the values of a test. A comparison of a parameter without a value does not
    /// hold.
    pub fn holds(&self, test: &Values) -> bool {
        truth(self, &|name: &str| test.get(name).map(Known::<f64>::of)) == Some(true)
    }

    /// Returns the expression for tests in which some parameters have fixed values. `known` returns the value of a parameter;
    /// `None` if tests may have different values. `takes` returns `false` if a parameter never takes a value.
    pub fn specialised(
        &self,
        known: &dyn Fn(&str) -> Option<Value>,
        takes: &dyn Fn(&str, &Value) -> bool,
    ) -> Specialised {
        let parts =
            |all: bool, parts: &[Expression]| joined(all, parts.iter().map(|part| part.specialised(known, takes)));
        match self {
            Expression::Compare { parameter, relation, with } => {
                let right = match with {
                    Operand::Value(value) => Some(value.clone()),
                    Operand::Parameter(other) => known(other),
                };
                match (known(parameter), right, with) {
                    (Some(left), Some(right), _) => {
                        let (left, right) = (Known::<f64>::of(&left), Known::of(&right));
                        Specialised::of(super::truth::related(Some(left), *relation, Some(right)) == Some(true))
                    }
                    (Some(left), None, Operand::Parameter(other)) => compare(other, relation.mirrored(), left, takes),
                    (None, Some(right), _) => compare(parameter, *relation, right, takes),
                    _ => Specialised::Open(self.clone()),
                }
            }
            Expression::In { parameter, values } => match known(parameter) {
                Some(value) => Specialised::of(values.iter().any(|other| other.means(&value))),
                None => {
                    let taken = |value: &&Value| takes(parameter, value);
                    let values: Vec<Value> = values.iter().filter(taken).cloned().collect();
                    let never = values.is_empty();
                    let left = Expression::In { parameter: parameter.clone(), values };
                    if never { Specialised::Never } else { Specialised::Open(left) }
                }
            },
            Expression::Relate { left, relation, right } => {
                let number = |name: &str| known(name).and_then(|value| value.number());
                let [left, right] = [left, right].map(|term| term.with(&number));
                let compared = |parameter: &String, relation, value: f64| {
                    compare(parameter, relation, Value::Number(value), takes)
                };
                match (&left, &right) {
                    (Term::Parameter(name), Term::Number(value)) => compared(name, *relation, *value),
                    (Term::Number(value), Term::Parameter(name)) => compared(name, relation.mirrored(), *value),
                    _ => {
                        let left = Expression::Relate { left, relation: *relation, right };
                        let is_known = left.names().is_empty();
                        if is_known { Specialised::of(left.holds(&Values::default())) } else { Specialised::Open(left) }
                    }
                }
            }
            Expression::Not(part) => part.specialised(known, takes).negated(),
            Expression::And(all) => parts(true, all),
            Expression::Or(any) => parts(false, any),
            Expression::Implies(condition, consequence) => {
                match (condition.specialised(known, takes), consequence.specialised(known, takes)) {
                    (Specialised::Never, _) | (_, Specialised::Always) => Specialised::Always,
                    (Specialised::Always, consequence) => consequence,
                    (condition, Specialised::Never) => condition.negated(),
                    (Specialised::Open(condition), Specialised::Open(consequence)) => {
                        Specialised::Open(Expression::Implies(Box::new(condition), Box::new(consequence)))
                    }
                }
            }
        }
    }
}

impl Specialised {
    fn of(holds: bool) -> Self {
        if holds { Self::Always } else { Self::Never }
    }

    fn negated(self) -> Self {
        match self {
            Self::Always => Self::Never,
            Self::Never => Self::Always,
            Self::Open(expression) => Self::Open(Expression::Not(Box::new(expression))),
        }
    }
}

/// Compares a parameter with a value that it perhaps never takes.
fn compare(
    parameter: &str,
    relation: super::Relation,
    value: Value,
    takes: &dyn Fn(&str, &Value) -> bool,
) -> Specialised {
    if !relation.orders() && !takes(parameter, &value) {
        return Specialised::of(relation == super::Relation::NotEqual);
    }
    if relation.orders() && value.number().is_none() {
        return Specialised::Never;
    }
    Specialised::Open(Expression::Compare { parameter: parameter.to_owned(), relation, with: Operand::Value(value) })
}

/// Joins expressions by "and" (`all`) or by "or".
fn joined(all: bool, parts: impl Iterator<Item = Specialised>) -> Specialised {
    let mut left = Vec::new();
    for part in parts {
        match part {
            Specialised::Open(expression) => left.push(expression),
            decided if decided == Specialised::of(all) => {}
            decided => return decided,
        }
    }
    match left.len() {
        0 => Specialised::of(all),
        1 => Specialised::Open(left.remove(0)),
        _ if all => Specialised::Open(Expression::And(left)),
        _ => Specialised::Open(Expression::Or(left)),
    }
}
