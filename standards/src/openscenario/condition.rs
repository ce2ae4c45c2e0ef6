//! Conditions and triggers as a scenario describes them. Each condition compares a measure of the world with a value.

use super::clock;
use super::kind::Kind;
use super::measure::Measure;
use super::names::Names;
use super::rule::Rule;
use super::scope::Node;
use super::state::State;
use crate::xml::{self, ReadError};
use std::path::PathBuf;

/// Groups of conditions. A trigger is true if all conditions of any of its groups are true.
pub(super) type Trigger = Vec<Vec<Condition>>;

/// A condition with its edge and its delay.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Condition {
    pub name: String,
    /// The path of the file and the line of the condition.
    pub origin: (PathBuf, u32),
    /// The time in seconds after which a change of the condition counts.
    pub delay: f64,
    pub edge: Edge,
    pub check: Check,
}

/// The change at which a condition is true.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Edge {
    None,
    Rising,
    Falling,
    Either,
}

/// The comparison of measures with a value.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Check {
    /// The measures, one for each triggering entity, or a single measure.
    pub measures: Vec<Measure>,
    /// `true` if one measure is enough, `false` if all are needed.
    pub any: bool,
    pub rule: Rule,
    pub value: f64,
}

/// Reads an element `StartTrigger` or `StopTrigger`. A trigger without groups is never true.
pub(super) fn trigger(node: Node<'_>, names: Names<'_>) -> Result<Trigger, ReadError> {
    let group = |group: Node<'_>| group.all("Condition").map(|node| Condition::read(node, names)).collect();
    node.all("ConditionGroup").map(group).collect()
}

impl Condition {
    fn read(node: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        let edges = [
            ("none", Edge::None),
            ("rising", Edge::Rising),
            ("falling", Edge::Falling),
            ("risingOrFalling", Edge::Either),
        ];
        let inner = node.choice("ByEntityCondition or ByValueCondition")?;
        let check = match inner.name() {
            "ByValueCondition" => Check::by_value(inner.choice("a condition such as SimulationTimeCondition")?, names)?,
            _ => Check::by_entity(inner, names)?,
        };
        // Nothing refers to a condition by its name, so the name stays as it is written.
        let name = node.element.text("name").unwrap_or_default().to_owned();
        let delay = node.element.text("delay").map_or(Ok(0.0), |_| node.length("delay"))?;
        let origin = (node.element.file().to_owned(), node.element.line());
        Ok(Self { name, origin, delay, edge: node.one_of("conditionEdge", &edges)?, check })
    }
}

impl Check {
    fn single(measure: Measure, rule: Rule, value: f64) -> Self {
        Self { measures: vec![measure], any: true, rule, value }
    }

    fn by_value(node: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        match node.name() {
            "SimulationTimeCondition" => Ok(Self::single(Measure::Time, Rule::read(node)?, node.number("value")?)),
            "TimeOfDayCondition" => Ok(Self::single(Measure::TimeOfDay, Rule::read(node)?, clock::seconds(node)?)),
            "StoryboardElementStateCondition" => {
                let kinds = ["story", "act", "maneuverGroup", "maneuver", "event", "action"].map(|kind| (kind, kind));
                let measure = Measure::State {
                    element: names.references.note(node, node.one_of("storyboardElementType", &kinds)?)?,
                    state: node.one_of("state", &State::NAMES)?,
                };
                Ok(Self::single(measure, Rule::GreaterOrEqual, 1.0))
            }
            "VariableCondition" => Self::variable(names.variable(node, "variableRef")?, node, names),
            "ParameterCondition" => {
                if let Some(variable) = names.parameter(node, "parameterRef")? {
                    return Self::variable(variable, node, names);
                }
                let name = node.element.required("parameterRef")?;
                let name = name.strip_prefix('$').unwrap_or(name);
                let kind = node.scope.kind(name).unwrap_or(Kind::Text);
                let found = kind.typed(node.scope.get(name).unwrap_or_default());
                let known = |is_equal| Measure::Constant(f64::from(u8::from(is_equal)));
                Self::with_value(node, kind, |wanted| match (&found, wanted) {
                    (xml::Value::Number(found), xml::Value::Number(_)) => Measure::Constant(*found),
                    (found, wanted) => known(found == wanted),
                })
            }
            _ => Err(node
                .refused("use a SimulationTimeCondition, a StoryboardElementStateCondition or a ParameterCondition")),
        }
    }

    fn variable(variable: usize, node: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        Self::with_value(node, names.kinds[variable], |wanted| match wanted {
            xml::Value::Number(_) => Measure::Variable(variable),
            wanted => Measure::VariableIs(variable, wanted.clone()),
        })
    }

    /// Compares a value of a type with the attribute `value`. `measure` returns the number to compare with a number, or otherwise 1 while
    /// the value is the wanted one.
    fn with_value(node: Node<'_>, kind: Kind, measure: impl Fn(&xml::Value) -> Measure) -> Result<Self, ReadError> {
        let text = node.of_kind("value", kind)?;
        let wanted = kind.typed(&text);
        Ok(match wanted {
            xml::Value::Number(number) => Self::single(measure(&wanted), Rule::read(node)?, number),
            _ => Self::single(measure(&wanted), Rule::of_words(node, &text)?, 1.0),
        })
    }

    fn by_entity(node: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        let triggering = node.child("TriggeringEntities")?;
        let any = triggering.one_of("triggeringEntitiesRule", &[("any", true), ("all", false)])?;
        let entities = triggering.all("EntityRef").map(|entity| names.group(entity, "entityRef"));
        let entities = entities.collect::<Result<Vec<_>, _>>()?.concat();
        if entities.is_empty() {
            return Err(triggering.element.lacks("EntityRef"));
        }
        let kind = node.child("EntityCondition")?.choice("a condition such as SpeedCondition")?;
        let mut rule = Rule::GreaterOrEqual;
        let mut value = 1.0;
        let mut measures = Vec::new();
        for entity in entities {
            let (measure, ruled, compared) = Measure::read(kind, entity, names)?;
            (rule, value) = (ruled, compared);
            measures.push(measure);
        }
        Ok(Self { measures, any, rule, value })
    }
}
