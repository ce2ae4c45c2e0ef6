//! The parameters of a scenario: their declarations, the values that a distribution lists for them, and their constraints.

use super::rule::Rule;
use super::scope::{Node, Scope};
use crate::xml::{Flaw, ReadError};
use paracosm_engine::Scenario;
use paracosm_space::{Domain, Parameter, Value};
use std::borrow::Cow;

/// The greatest number of values that a range with a step may list.
const MOST_LEVELS: f64 = 10_000.0;
/// The bound of a parameter that is a number without a distribution.
const BOUND: f64 = 1e9;
/// The share of a step by which a range may exceed its upper limit, because steps are sums of rounded numbers.
const TOLERANCE: f64 = 1e-9;
/// The sign between the names and between the values of parameters that change together.
const JOINT: &str = "|";

/// A distribution of parameters: the parameters that it opens, in the order of the file.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Distribution(Vec<Opened>);

/// Parameters that a distribution opens together, with the tuples of their values.
#[derive(Debug, Clone, PartialEq)]
struct Opened {
    names: Vec<String>,
    levels: Vec<Vec<String>>,
}

impl Distribution {
    /// Reads an element `ParameterValueDistribution`.
    pub fn read(root: Node<'_>) -> Result<Self, ReadError> {
        let Some(deterministic) = root.first("Deterministic") else {
            return Err(root.choice("Deterministic")?.refused("use a Deterministic distribution"));
        };
        let mut all = Vec::new();
        for node in deterministic.elements() {
            let kind = node.choice("a kind of distribution such as DistributionSet")?;
            all.push(match kind.name() {
                "DistributionSet" => {
                    let value = |element: Node<'_>| Ok(vec![element.required("value")?.into_owned()]);
                    let levels = kind.all("Element").map(value).collect::<Result<_, ReadError>>()?;
                    Opened { names: vec![name(node)?], levels }
                }
                "DistributionRange" => Opened { names: vec![name(node)?], levels: range(kind)? },
                "ValueSetDistribution" => Opened::tuples(kind)?,
                _ => return Err(kind.refused("use a DistributionSet, a DistributionRange or a ValueSetDistribution")),
            });
        }
        Ok(Self(all))
    }

    /// Declares the parameters of a scenario, and returns the values that the test gives them. A parameter whose value is an
    /// expression follows from the others. The test is invalid if a value breaks a constraint.
    pub fn declared(&self, root: Node<'_>, s: &mut Scenario) -> Result<Scope, ReadError> {
        let mut scope = Scope::default();
        let mut given = Vec::new();
        for opened in &self.0 {
            let levels = opened.levels.iter().map(|level| parsed(&joint(level))).collect();
            let mut parameter = Parameter::new(joint(&opened.names), Domain::Choice(levels));
            parameter.default = opened.nominal(root);
            let value = s.parameter(parameter, true).value();
            let index = opened.levels.iter().position(|level| parsed(&joint(level)) == value);
            let Some(level) = index.or((!opened.levels.is_empty()).then_some(0)) else { continue };
            given.extend(opened.names.iter().cloned().zip(opened.levels[level].iter().cloned()));
        }
        for declaration in declarations(root) {
            let (name, text) =
                (declaration.element.required("name")?, declaration.element.text("value").unwrap_or_default());
            let value = if let Some((_, value)) = given.iter().find(|(known, _)| known == name) {
                value.clone()
            } else if text.starts_with('$') {
                Node { scope: &scope, ..declaration }.required("value")?.into_owned()
            } else {
                let domain = match parsed(text) {
                    Value::Number(number) => Domain::Interval { lo: (-BOUND).min(number), hi: BOUND.max(number) },
                    other => Domain::Choice(vec![other]),
                };
                let mut parameter = Parameter::new(name, domain);
                parameter.default = Some(parsed(text));
                s.parameter(parameter, false).value().to_string()
            };
            scope.set(name, value);
        }
        for declaration in declarations(root) {
            if let Some(broken) = broken(Node { scope: &scope, ..declaration })? {
                s.refuse(&broken);
            }
        }
        Ok(scope)
    }
}

impl Opened {
    /// Returns the tuple of values that is nearest to the values of the declarations: the same words, and the nearest numbers.
    fn nominal(&self, root: Node<'_>) -> Option<Value> {
        let declared: Vec<Option<Value>> = self.names.iter().map(|name| nominal(root, name)).collect();
        let distance = |level: &&Vec<String>| -> f64 {
            let apart = |(value, declared): (&String, &Option<Value>)| match (parsed(value), declared) {
                (Value::Number(value), Some(Value::Number(declared))) => (value - declared).abs(),
                (value, declared) => f64::from(u8::from(Some(&value) != declared.as_ref())),
            };
            level.iter().zip(&declared).map(apart).sum()
        };
        let nearest = self.levels.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        Some(parsed(&joint(nearest)))
    }

    fn tuples(kind: Node<'_>) -> Result<Self, ReadError> {
        let mut names: Vec<String> = Vec::new();
        let mut levels = Vec::new();
        for set in kind.all("ParameterValueSet") {
            let mut level = Vec::new();
            for (index, assignment) in set.all("ParameterAssignment").enumerate() {
                let name = assignment.element.required("parameterRef")?;
                if levels.is_empty() {
                    names.push(name.to_owned());
                } else if names.get(index).is_none_or(|known| known != name) {
                    return Err(assignment.dangling("parameterRef", "parameter", names.iter().map(String::as_str)));
                }
                level.push(assignment.required("value")?.into_owned());
            }
            levels.push(level);
        }
        Ok(Self { names, levels })
    }
}

fn name(node: Node<'_>) -> Result<String, ReadError> {
    node.required("parameterName").map(Cow::into_owned)
}

/// Returns the values of a range with a step.
fn range(node: Node<'_>) -> Result<Vec<Vec<String>>, ReadError> {
    let limits = node.child("Range")?;
    let (lo, hi, step) = (limits.number("lowerLimit")?, limits.number("upperLimit")?, node.number("stepWidth")?);
    let count = (hi - lo) / step + TOLERANCE;
    if !(step > 0.0 && (0.0..MOST_LEVELS).contains(&count)) {
        let found = node.required("stepWidth")?.into_owned();
        let expected = format!("a step above 0 that divides {lo} to {hi} into at most {MOST_LEVELS} parts");
        let (element, attribute) = (node.name().to_owned(), "stepWidth".to_owned());
        return Err(node.error(Flaw::Value { element, attribute, found, expected, nearest: None }));
    }
    Ok((0..=count as usize).map(|index| vec![(lo + index as f64 * step).to_string()]).collect())
}

/// Returns the names or the values of parameters that change together as one text.
fn joint(parts: &[String]) -> String {
    parts.join(JOINT)
}

/// Returns a value as spaces have it: a number, or a word.
fn parsed(text: &str) -> Value {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Value::Number(number),
        _ => Value::from(text),
    }
}

/// Returns the value that the declaration of a parameter gives the parameter.
fn nominal(root: Node<'_>, name: &str) -> Option<Value> {
    let declaration = declarations(root).find(|declaration| declaration.element.text("name") == Some(name))?;
    declaration.element.text("value").map(parsed)
}

fn declarations(root: Node<'_>) -> impl Iterator<Item = Node<'_>> {
    root.first("ParameterDeclarations").into_iter().flat_map(|all| all.all("ParameterDeclaration"))
}

/// Returns the description of the constraints that a parameter breaks; `None` if a group of its constraints holds, or if it
/// has none. The groups are alternatives, and the constraints of a group hold together.
fn broken(declaration: Node<'_>) -> Result<Option<String>, ReadError> {
    let name = declaration.element.required("name")?;
    let value = parsed(declaration.scope.get(name).unwrap_or_default());
    let mut described = Vec::new();
    for group in declaration.all("ConstraintGroup") {
        let mut holds = true;
        let mut members = Vec::new();
        for constraint in group.all("ValueConstraint") {
            let rule = Rule::read(constraint)?;
            let limit = constraint.required("value")?;
            holds &= rule.holds(&value, &parsed(&limit));
            members.push(format!("{} {limit}", rule.words()));
        }
        if holds {
            return Ok(None);
        }
        described.push(members.join(" and "));
    }
    let broken = || format!("`{name}` is {value}, expected a value that is {}", described.join(", or "));
    Ok((!described.is_empty()).then(broken))
}
