//! The rules by which scenarios compare values.

use super::scope::Node;
use crate::xml::ReadError;
use paracosm_engine::Stream;
use paracosm_space::Value;
use paracosm_space::constraint::Relation;
use std::cmp::Ordering;

/// The way in which a measure is compared with a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Rule {
    Equal,
    NotEqual,
    Greater,
    GreaterOrEqual,
    Less,
    LessOrEqual,
}

const RULES: [(&str, Rule); 6] = [
    ("equalTo", Rule::Equal),
    ("notEqualTo", Rule::NotEqual),
    ("greaterThan", Rule::Greater),
    ("greaterOrEqual", Rule::GreaterOrEqual),
    ("lessThan", Rule::Less),
    ("lessOrEqual", Rule::LessOrEqual),
];

impl Rule {
    /// Reads the attribute `rule`.
    pub fn read(node: Node<'_>) -> Result<Self, ReadError> {
        node.one_of("rule", &RULES)
    }

    /// Reads the attribute `rule` of an element that compares with a word. Words have no order.
    pub fn of_words(node: Node<'_>, word: &str) -> Result<Self, ReadError> {
        let rule = Self::read(node)?;
        if matches!(rule, Self::Equal | Self::NotEqual) {
            return Ok(rule);
        }
        let expected = format!("equalTo or notEqualTo, because `{word}` is no number");
        Err(node.unexpected("rule", &node.required("rule")?, expected))
    }

    /// Returns `true` if a value fulfils the rule. Words have no order.
    pub fn holds(self, value: &Value, limit: &Value) -> bool {
        let order = match (value, limit) {
            (Value::Number(value), Value::Number(limit)) => value.partial_cmp(limit),
            _ => (value == limit).then_some(Ordering::Equal),
        };
        match self {
            Self::Equal => order == Some(Ordering::Equal),
            Self::NotEqual => order != Some(Ordering::Equal),
            Self::Greater => order == Some(Ordering::Greater),
            Self::GreaterOrEqual => order.is_some_and(Ordering::is_ge),
            Self::Less => order == Some(Ordering::Less),
            Self::LessOrEqual => order.is_some_and(Ordering::is_le),
        }
    }

    /// Returns the rule as a relation of constraints.
    pub fn relation(self) -> Relation {
        match self {
            Self::Equal => Relation::Equal,
            Self::NotEqual => Relation::NotEqual,
            Self::Greater => Relation::Greater,
            Self::GreaterOrEqual => Relation::GreaterOrEqual,
            Self::Less => Relation::Less,
            Self::LessOrEqual => Relation::LessOrEqual,
        }
    }

    /// Returns the rule in words, which a limit follows.
    pub fn words(self) -> &'static str {
        match self {
            Self::Equal => "equal to",
            Self::NotEqual => "not equal to",
            Self::Greater => "greater than",
            Self::GreaterOrEqual => "at least",
            Self::Less => "less than",
            Self::LessOrEqual => "at most",
        }
    }

    /// Returns the stream that is true while a measure fulfils the rule.
    pub fn compare(self, measure: &Stream<f64>, value: f64) -> Stream<bool> {
        match self {
            Self::Equal => measure.equals(value),
            Self::NotEqual => !measure.equals(value),
            Self::Greater => measure.above(value),
            Self::GreaterOrEqual => measure.at_least(value),
            Self::Less => measure.below(value),
            Self::LessOrEqual => measure.at_most(value),
        }
    }
}
