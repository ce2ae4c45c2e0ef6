//! The truth of an expression: for one test, or for all tests of a part of the space at once.

use super::expression::{Expression, Operand, Relation};
use super::span::Span;
use super::{Function, Term};
use crate::Value;

/// The value of a parameter: a quantity, or another value such as a word.
pub(super) enum Known<'a, Q> {
    Quantity(Q),
    Other(&'a Value),
}

impl<'a, Q: Quantity> Known<'a, Q> {
    pub fn of(value: &'a Value) -> Self {
        value.number().map_or(Self::Other(value), |number| Self::Quantity(Q::exact(number)))
    }
}

/// A number, or a span of numbers.
pub(super) trait Quantity: Copy {
    /// The truth of a comparison with a term that has no value.
    const WITHOUT_VALUE: Option<bool>;

    fn exact(number: f64) -> Self;

    /// Returns the value of a function; `None` if the function has no value.
    fn of(function: Function, operands: &[Self]) -> Option<Self>;

    /// Returns whether a relation holds; `None` if the relation holds for some of the numbers only.
    fn relates(self, relation: Relation, other: Self) -> Option<bool>;

    /// Returns whether a relation holds with another parameter or a number. Two spans of different parameters are equal in a
    /// part without volume only, so `!=` holds for spans unless both are the same number.
    fn relates_to_another(self, relation: Relation, other: Self) -> Option<bool>;
}

impl Quantity for f64 {
    const WITHOUT_VALUE: Option<bool> = Some(false);

    fn exact(number: f64) -> Self {
        number
    }

    fn of(function: Function, operands: &[Self]) -> Option<Self> {
        function.value(operands)
    }

    fn relates(self, relation: Relation, other: Self) -> Option<bool> {
        Some(relation.holds(&self, &other))
    }

    fn relates_to_another(self, relation: Relation, other: Self) -> Option<bool> {
        self.relates(relation, other)
    }
}

impl Quantity for Span {
    const WITHOUT_VALUE: Option<bool> = None;

    fn exact(number: f64) -> Self {
        Self::exact(number)
    }

    fn of(function: Function, operands: &[Self]) -> Option<Self> {
        Self::of(function, operands)
    }

    fn relates(self, relation: Relation, other: Self) -> Option<bool> {
        let decided = |holds: bool, fails: bool| if holds { Some(true) } else { fails.then_some(false) };
        let (a, b) = (self, other);
        match relation {
            Relation::Less => decided(a.hi < b.lo, a.lo >= b.hi),
            Relation::LessOrEqual => decided(a.hi <= b.lo, a.lo > b.hi),
            Relation::Equal => decided(a.lo == a.hi && b.lo == b.hi && a.lo == b.lo, a.hi < b.lo || b.hi < a.lo),
            Relation::Greater | Relation::GreaterOrEqual => b.relates(relation.mirrored(), a),
            Relation::NotEqual => a.relates(Relation::Equal, b).map(|equal| !equal),
        }
    }

    fn relates_to_another(self, relation: Relation, other: Self) -> Option<bool> {
        self.relates(relation, other).or((!relation.orders()).then_some(relation == Relation::NotEqual))
    }
}

/// Returns the truth of an expression with the given values of parameters; `None` if the values leave it open. Tests of a
/// part without volume may be exceptions: those in which parameters with spans are equal.
pub(super) fn truth<'a, Q: Quantity + 'a>(
    expression: &'a Expression,
    known: &dyn Fn(&str) -> Option<Known<'a, Q>>,
) -> Option<bool> {
    match expression {
        Expression::Compare { parameter, relation, with } => {
            let right = match with {
                Operand::Value(value) => Some(Known::of(value)),
                Operand::Parameter(other) => known(other),
            };
            match (known(parameter), right) {
                (Some(Known::Quantity(left)), Some(Known::Quantity(right))) if !is_same(with, parameter) => {
                    left.relates_to_another(*relation, right)
                }
                (left, right) => related(left, *relation, right),
            }
        }
        Expression::In { parameter, values } => {
            joined(false, values.iter().map(|value| related(known(parameter), Relation::Equal, Some(Known::of(value)))))
        }
        Expression::Relate { left, relation, right } => match (number(left, known), number(right, known)) {
            (Some(left), Some(right)) => left.relates(*relation, right),
            _ => Q::WITHOUT_VALUE,
        },
        Expression::Not(part) => truth(part, known).map(|holds| !holds),
        Expression::And(parts) => joined(true, parts.iter().map(|part| truth(part, known))),
        Expression::Or(parts) => joined(false, parts.iter().map(|part| truth(part, known))),
        Expression::Implies(condition, consequence) => match truth(condition, known) {
            Some(false) => Some(true),
            Some(true) => truth(consequence, known),
            None => truth(consequence, known).filter(|holds| *holds),
        },
    }
}

/// Returns `true` if an operand is the parameter of this name.
fn is_same(operand: &Operand, name: &str) -> bool {
    matches!(operand, Operand::Parameter(other) if other == name)
}

/// Joins truths by "and" (`all`) or by "or".
fn joined(all: bool, parts: impl Iterator<Item = Option<bool>>) -> Option<bool> {
    let mut joint = Some(all);
    for part in parts {
        match part {
            Some(holds) if holds == all => {}
            Some(decides) => return Some(decides),
            None => joint = None,
        }
    }
    joint
}

pub(super) fn related<Q: Quantity>(
    left: Option<Known<Q>>,
    relation: Relation,
    right: Option<Known<Q>>,
) -> Option<bool> {
    match (left, right) {
        (Some(Known::Quantity(left)), Some(Known::Quantity(right))) => left.relates(relation, right),
        (Some(Known::Other(left)), Some(Known::Other(right))) if !relation.orders() => {
            Some(left.means(right) == (relation == Relation::Equal))
        }
        // A word and a number are never equal, and words have no order.
        (Some(_), Some(_)) => Some(relation == Relation::NotEqual),
        _ => Q::WITHOUT_VALUE,
    }
}

fn number<'a, Q: Quantity + 'a>(term: &Term, known: &dyn Fn(&str) -> Option<Known<'a, Q>>) -> Option<Q> {
    match term {
        Term::Number(number) => Some(Q::exact(*number)),
        Term::Parameter(name) => match known(name)? {
            Known::Quantity(quantity) => Some(quantity),
            Known::Other(_) => None,
        },
        Term::Applied(function, operands) => {
            // No function has more than two operands.
            let a = number(operands.first()?, known)?;
            let b = operands.get(1).map_or(Some(a), |operand| number(operand, known))?;
            Q::of(*function, &[a, b])
        }
    }
}
