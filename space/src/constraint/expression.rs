//! What a constraint says, as data: comparisons of parameters, joined by `not`, `and`, `or` and `implies`.

use crate::Value;
use std::fmt;

/// A statement about the discrete parameters of a test.
///
/// What [`Display`](fmt::Display) writes, [`FromStr`](std::str::FromStr) reads back as the same expression.
///
/// ```
/// use paracosm_space::constraint::Expression;
/// let expression: Expression = "not (lanes == 2 and [road surface] in ['wet', \"icy\"])".parse()?;
/// assert_eq!(expression.to_string(), "not (lanes == 2 and [road surface] in ['wet', 'icy'])");
/// # Ok::<(), paracosm_space::constraint::ConstraintError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub enum Expression {
    /// `lanes == 2`, `weather != 'fog'`, `front < rear`.
    Compare {
        /// The parameter on the left.
        parameter: String,
        /// How the two sides are related.
        relation: Relation,
        /// What stands on the right.
        with: Operand,
    },
    /// `weather in ['rain', 'fog']`; nothing is in the empty list.
    In {
        /// The parameter.
        parameter: String,
        /// The values listed.
        values: Vec<Value>,
    },
    /// `not a`.
    Not(Box<Expression>),
    /// `a and b and c`: two parts or more.
    And(Vec<Expression>),
    /// `a or b or c`: two parts or more.
    Or(Vec<Expression>),
    /// `a implies b`: `b` holds wherever `a` does.
    Implies(Box<Expression>, Box<Expression>),
}

/// The right side of a comparison.
#[derive(Debug, Clone, PartialEq)]
pub enum Operand {
    /// A number or a quoted word.
    Value(Value),
    /// The name of another parameter.
    Parameter(String),
}

/// How the two sides of a comparison are related. The last four compare numbers only.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Relation {
    /// `==`
    Equal,
    /// `!=`
    NotEqual,
    /// `<`
    Less,
    /// `<=`
    LessOrEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterOrEqual,
}

impl Relation {
    /// Whether it holds between two things of an ordered kind.
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

    /// Whether it asks which side is more.
    pub fn orders(self) -> bool {
        !matches!(self, Relation::Equal | Relation::NotEqual)
    }

    /// The relation that holds exactly where this one does not.
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

    /// The relation of the right side to the left one.
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

/// The words of the language, which are no names unless written in brackets.
pub(super) const KEYWORDS: [&str; 5] = ["in", "not", "and", "or", "implies"];

/// Whether a name may be written without brackets.
pub(super) fn is_plain(name: &str) -> bool {
    let mut signs = name.chars();
    signs.next().is_some_and(begins_name) && signs.all(continues_name) && !KEYWORDS.contains(&name)
}

pub(super) fn begins_name(sign: char) -> bool {
    sign.is_alphabetic() || sign == '_'
}

pub(super) fn continues_name(sign: char) -> bool {
    sign.is_alphanumeric() || sign == '_' || sign == '.'
}

/// A name as the language writes it: in brackets, unless it is plain.
pub(super) struct Name<'a>(pub &'a str);

impl fmt::Display for Name<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if is_plain(self.0) { f.write_str(self.0) } else { enclosed(f, '[', self.0, ']') }
    }
}

/// A value as the language writes it: words in quotes.
pub(super) struct Written<'a>(pub &'a Value);

impl fmt::Display for Written<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.0.word(), self.0.number()) {
            (Some(word), _) => enclosed(f, '\'', word, '\''),
            // Constraints are about numbers, however levels are written.
            (None, Some(number)) => write!(f, "{number}"),
            (None, None) => write!(f, "{}", self.0),
        }
    }
}

fn enclosed(f: &mut fmt::Formatter<'_>, open: char, text: &str, close: char) -> fmt::Result {
    write!(f, "{open}")?;
    for sign in text.chars() {
        if sign == close || sign == '\\' {
            f.write_str("\\")?;
        }
        write!(f, "{sign}")?;
    }
    write!(f, "{close}")
}

impl Expression {
    /// How tightly it holds together: where less than its place asks for, it needs parentheses.
    fn tightness(&self) -> u8 {
        match self {
            Expression::Implies(..) => 0,
            Expression::Or(_) => 1,
            Expression::And(_) => 2,
            Expression::Not(_) | Expression::Compare { .. } | Expression::In { .. } => 3,
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
