//! The demands of a declaration on the value of its parameter: the type, and the groups of constraints.

use super::kind::Kind;
use super::rule::Rule;
use super::scope::{Node, Scope};
use crate::xml::{ExpressionFlaw, Flaw, ReadError, brief};
use std::path::PathBuf;

/// The demands on the value of a parameter.
#[derive(Debug, Clone)]
pub(super) struct Demand {
    pub name: String,
    pub kind: Kind,
    /// The groups are alternatives, and the limits of a group hold together. Without groups there are no limits.
    pub groups: Vec<Vec<Limit>>,
    /// The file and the line of the declaration.
    place: (PathBuf, u32),
}

/// A limit of a parameter, which may be an expression of any parameters.
#[derive(Debug, Clone)]
pub(super) struct Limit {
    pub rule: Rule,
    pub text: String,
    /// The file and the line of the limit.
    place: (PathBuf, u32),
}

/// The reason why a value breaks the demands on it.
#[derive(Debug)]
pub(super) enum Breach {
    /// The value is not one of those in words.
    Value(String),
    /// A limit has no value.
    Limit(ReadError),
}

impl Demand {
    /// Reads an element `ParameterDeclaration`.
    pub fn read(node: Node<'_>) -> Result<Self, ReadError> {
        let place = |node: Node<'_>| (node.element.file().to_owned(), node.element.line());
        let (name, kind) = (node.element.required("name")?.to_owned(), node.kind("parameterType")?);
        let limit = |node: Node<'_>| {
            let text = node.element.required("value")?;
            // A number limits whole numbers, too. The value of an expression is unknown here.
            let takes = if kind.is_whole() { Kind::Double } else { kind };
            if !text.starts_with('$') && !takes.takes(text) {
                return Err(node.unexpected("value", text, takes.expected()));
            }
            Ok(Limit { rule: Rule::read(node)?, text: text.to_owned(), place: place(node) })
        };
        let group = |group: Node<'_>| {
            let limits = group.all("ValueConstraint").map(limit).collect::<Result<Vec<_>, ReadError>>()?;
            if limits.is_empty() { Err(group.element.lacks("ValueConstraint")) } else { Ok(limits) }
        };
        let groups = node.all("ConstraintGroup").map(group);
        let groups = groups.collect::<Result<_, ReadError>>()?;
        Ok(Self { name, kind, groups, place: place(node) })
    }

    /// Returns `true` if some finite numbers break the demands.
    pub fn depends_on_values(&self) -> bool {
        self.kind.is_whole() || !self.groups.is_empty()
    }

    /// Returns the texts of all limits.
    pub fn limits(&self) -> impl Iterator<Item = &str> {
        self.groups.iter().flatten().map(|limit| limit.text.as_str())
    }

    /// Returns the reason why a value breaks the demands; `None` if it keeps them. The limits see the parameters in `scope`.
    pub fn breach(&self, value: &str, scope: &Scope) -> Option<Breach> {
        if !self.kind.takes(value) {
            return Some(Breach::of(self.kind));
        }
        let value = self.kind.value(value);
        let mut described = Vec::new();
        for group in &self.groups {
            let mut holds = true;
            let mut members = Vec::new();
            for limit in group {
                let found = match scope.resolve(&limit.text) {
                    Ok(found) => found,
                    Err(flaw) => return Some(Breach::Limit(limit.error(flaw))),
                };
                holds &= limit.rule.holds(&value, &self.kind.value(&found));
                members.push(format!("{} {found}", limit.rule.words()));
            }
            if holds {
                return None;
            }
            described.push(members.join(" and "));
        }
        (!described.is_empty()).then(|| Breach::Value(format!("a value that is {}", described.join(", or "))))
    }

    /// Returns the file and the line of the declaration.
    pub fn place(&self) -> String {
        format!("{}:{}", self.place.0.display(), self.place.1)
    }

    /// Makes an error at the place of the declaration.
    pub fn error(&self, flaw: Flaw) -> ReadError {
        ReadError { file: self.place.0.clone(), line: Some(self.place.1), flaw: Box::new(flaw) }
    }
}

impl Limit {
    /// Makes the error that the limit has no value.
    pub fn error(&self, flaw: ExpressionFlaw) -> ReadError {
        let (element, attribute) = ("ValueConstraint".to_owned(), "value".to_owned());
        let flaw = Flaw::Expression { element, attribute, text: brief(&self.text), flaw };
        ReadError { file: self.place.0.clone(), line: Some(self.place.1), flaw: Box::new(flaw) }
    }
}

impl Breach {
    /// Returns the breach of a value that is not of a type.
    pub fn of(kind: Kind) -> Self {
        Self::Value(kind.expected())
    }

    /// Makes the error that the attribute `value` of an element breaks the demands.
    pub fn error(self, node: Node<'_>, value: &str) -> ReadError {
        match self {
            Self::Value(expected) => node.unexpected("value", value, expected),
            Self::Limit(error) => error,
        }
    }
}
