//! Constraints as data: comparisons of parameters, joined by `not`, `and`, `or` and `implies`.

use super::Term;
use super::written::{Name, Written};
use crate::Value;
use std::fmt;

/// A logical statement about the parameters of a test.
///
/// [`FromStr`](std::str::FromStr) reads the same expression from the text that [`Display`](fmt::Display) writes.
///
/// ```
/// use paracosm_space::constraint::Expression;
/// let expression: Expression = "not (lanes == 2 and [road surface] in ['wet', \"icy\"])".parse()?;
/// assert_eq!(expression.to_string(), "not (lanes == 2 and [road surface] in ['wet', 'icy'])");
/// # Ok::<(), paracosm_space::constraint::ConstraintError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub enum Expression {
    /// A comparison, such as `lanes == 2`, `weather != 'fog'` or `front < rear`.
    Compare {
        /// The name of the parameter on the left side of the comparison.
        parameter: String,
        /// The relation between the two sides of the comparison, such as `<`.
        relation: Relation,
        /// The right side of the comparison.
        with: Operand,
    },
    /// The statement that a parameter has a value from a list, such as `weather in ['rain', 'fog']`. It never holds if
    /// the list is empty.
    In {
        /// The name of the parameter on the left side of `in`.
        parameter: String,
        /// The values in the list after `in`.
        values: Vec<Value>,
    },
    /// A comparison of computed numbers, such as `ego_speed - lead_speed >= 10`. It does not hold if one of the two numbers
    /// has no value, for example because of a division by zero.
    Relate {
        /// The number on the left side of the comparison.
        left: Term,
        /// The relation between the two sides of the comparison.
        relation: Relation,
        /// The number on the right side of the comparison.
        right: Term,
    },
    /// The negation `not a`.
    Not(Box<Expression>),
    /// The conjunction `a and b and c`, with two parts or more.
    And(Vec<Expression>),
    /// The disjunction `a or b or c`, with two parts or more.
    Or(Vec<Expression>),
    /// The implication `a implies b`. If `a` holds, `b` has to hold.
    Implies(Box<Expression>, Box<Expression>),
}

/// The right side of a comparison, which is a value or a parameter.
#[derive(Debug, Clone, PartialEq)]
pub enum Operand {
    /// A number or a quoted word on the right side of a comparison.
    Value(Value),
    /// The name of the parameter on the right side of a comparison.
    Parameter(String),
}

/// The relation between the two sides of a comparison. The last four relations compare numbers only.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Relation {
    /// The relation `==`.
    Equal,
    /// The relation `!=`.
    NotEqual,
    /// The relation `<`.
    Less,
    /// The relation `<=`.
    LessOrEqual,
    /// The relation `>`.
    Greater,
    /// The relation `>=`.
    GreaterOrEqual,
}

impl Relation {
    /// Returns `true` if the relation holds between `left` and `right`.
    pub fn holds<T: PartialOrd>(self, left: &T, right: &T) -> bool {
        match self {
            Relation::Equal => left == right,
            Relation::NotEqual => left != right,
            Relation::Less => left < right,
            Relation::LessOrEqual => left <= right,
            Relation::Greater => left > right,
            Relation::GreaterOrEqual => left >= right,
        }
    }

    /// Returns `true` if the relation is `<`, `<=`, `>` or `>=`, which compare sizes.
    pub fn orders(self) -> bool {
        !matches!(self, Relation::Equal | Relation::NotEqual)
    }

    /// Returns the opposite relation, such as `>=` for `<`. It holds exactly if this relation does not hold.
    pub fn negated(self) -> Self {
        match self {
            Relation::Equal => Relation::NotEqual,
            Relation::NotEqual => Relation::Equal,
            Relation::Less => Relation::GreaterOrEqual,
            Relation::LessOrEqual => Relation::Greater,
            Relation::Greater => Relation::LessOrEqual,
            Relation::GreaterOrEqual => Relation::Less,
        }
    }

    /// Returns the relation with both sides exchanged, such as `>` for `<`.
    pub fn mirrored(self) -> Self {
        match self {
            Relation::Less => Relation::Greater,
            Relation::LessOrEqual => Relation::GreaterOrEqual,
            Relation::Greater => Relation::Less,
            Relation::GreaterOrEqual => Relation::LessOrEqual,
            same => same,
        }
    }
}

impl fmt::Display for Relation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Relation::Equal => "==",
            Relation::NotEqual => "!=",
            Relation::Less => "<",
            Relation::LessOrEqual => "<=",
            Relation::Greater => ">",
            Relation::GreaterOrEqual => ">=",
        })
    }
}

impl Expression {
    /// Returns the names of the parameters of the expression. Each name occurs once.
    pub fn names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        self.each_parameter(&mut |name| {
            if !names.contains(&name) {
                names.push(name);
            }
        });
        names
    }

    fn each_parameter<'a>(&'a self, see: &mut dyn FnMut(&'a str)) {
        match self {
            Expression::Compare { parameter, with, .. } => {
                see(parameter);
                if let Operand::Parameter(other) = with {
                    see(other);
                }
            }
            Expression::In { parameter, .. } => see(parameter),
            Expression::Relate { left, right, .. } => {
                left.each_parameter(see);
                right.each_parameter(see);
            }
            Expression::Not(part) => part.each_parameter(see),
            Expression::And(parts) | Expression::Or(parts) => parts.iter().for_each(|part| part.each_parameter(see)),
            Expression::Implies(condition, consequence) => {
                condition.each_parameter(see);
                consequence.each_parameter(see);
            }
        }
    }

    /// Returns `true` if the expression compares computed numbers.
    pub(super) fn computes(&self) -> bool {
        match self {
            Expression::Relate { .. } => true,
            Expression::Compare { .. } | Expression::In { .. } => false,
            Expression::Not(part) => part.computes(),
            Expression::And(parts) | Expression::Or(parts) => parts.iter().any(Expression::computes),
            Expression::Implies(condition, consequence) => condition.computes() || consequence.computes(),
        }
    }

    /// Returns a number for the strength with which the expression binds its parts. The expression needs parentheses if
    /// its place requires a higher number.
    fn tightness(&self) -> u8 {
        match self {
            Expression::Implies(..) => 0,
            Expression::Or(_) => 1,
            Expression::And(_) => 2,
            Expression::Not(_) | Expression::Compare { .. } | Expression::In { .. } | Expression::Relate { .. } => 3,
        }
    }

    fn write(&self, f: &mut fmt::Formatter<'_>, needed: u8) -> fmt::Result {
        if self.tightness() < needed { write!(f, "({self})") } else { write!(f, "{self}") }
    }
}

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let joined = |f: &mut fmt::Formatter<'_>, parts: &[Expression], word: &str, needed| {
            for (i, part) in parts.iter().enumerate() {
                f.write_str(if i == 0 { "" } else { word })?;
                part.write(f, needed)?;
            }
            Ok(())
        };
        match self {
            Expression::Compare { parameter, relation, with } => {
                write!(f, "{} {relation} ", Name(parameter))?;
                match with {
                    Operand::Value(value) => write!(f, "{}", Written(value)),
                    Operand::Parameter(other) => write!(f, "{}", Name(other)),
                }
            }
            Expression::In { parameter, values } => {
                write!(f, "{} in [", Name(parameter))?;
                for (i, value) in values.iter().enumerate() {
                    write!(f, "{}{}", if i == 0 { "" } else { ", " }, Written(value))?;
                }
                f.write_str("]")
            }
            Expression::Relate { left, relation, right } => write!(f, "{left} {relation} {right}"),
            Expression::Not(part) => {
                f.write_str("not ")?;
                part.write(f, 3)
            }
            Expression::And(parts) => joined(f, parts, " and ", 3),
            Expression::Or(parts) => joined(f, parts, " or ", 2),
            Expression::Implies(condition, consequence) => {
                condition.write(f, 1)?;
                f.write_str(" implies ")?;
                consequence.write(f, 0)
            }
        }
    }
}
