//! Conditions and triggers as a scenario describes them. Each condition compares a measure of the world with a value.

use super::position::{Names, Position};
use super::scope::Node;
use super::state::State;
use crate::xml::{self, ReadError};
use paracosm_engine::Stream;
use paracosm_space::Value;
use std::cmp::Ordering;

/// Groups of conditions. A trigger is true if all conditions of any of its groups are true.
pub(super) type Trigger = Vec<Vec<Condition>>;

/// A condition with its edge and its delay.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Condition {
    pub name: String,
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

/// A number that is measured at every tick.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Measure {
    Time,
    /// A number that never changes.
    Constant(f64),
    /// The number in a variable.
    Variable(usize),
    /// 1 while a variable has a value, otherwise 0.
    VariableIs(usize, xml::Value),
    /// 1 while an element of the storyboard with this name is in the state, otherwise 0.
    State {
        element: String,
        kind: &'static str,
        state: State,
    },
    Speed {
        entity: usize,
        direction: Direction,
    },
    Acceleration {
        entity: usize,
    },
    /// The speed of the entity minus the speed of another entity.
    RelativeSpeed {
        entity: usize,
        other: usize,
        direction: Direction,
    },
    /// The seconds for which the entity has been standing.
    Standing {
        entity: usize,
    },
    /// The distance that the entity has travelled, in metres.
    Travelled {
        entity: usize,
    },
    Distance {
        entity: usize,
        to: Goal,
        how: Metric,
    },
    /// The distance divided by the speed of the entity.
    Headway {
        entity: usize,
        to: usize,
        how: Metric,
    },
    /// The distance divided by the speed at which the distance becomes shorter; infinite if it does not.
    TimeToCollision {
        entity: usize,
        to: Goal,
        how: Metric,
    },
    /// 1 while the entity touches another entity, otherwise 0.
    Touching {
        entity: usize,
        other: usize,
    },
    /// The seconds for which the entity has been at the end of its road.
    EndOfRoad {
        entity: usize,
    },
}

/// The direction of a speed or of an acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Direction {
    Longitudinal,
    Lateral,
    Total,
}

/// The other end of a distance.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Goal {
    Entity(usize),
    Place(Position),
}

/// The way in which a distance is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Metric {
    pub kind: MetricKind,
    /// `true` if the distance is between boxes, `false` if it is between reference points.
    pub freespace: bool,
    pub system: System,
}

/// The kind of a distance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MetricKind {
    Longitudinal,
    Lateral,
    Straight,
}

/// The system of coordinates of a distance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum System {
    Entity,
    Lane,
    Road,
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
        Ok(Self { name, delay, edge: node.one_of("conditionEdge", &edges)?, check })
    }
}

impl Check {
    fn single(measure: Measure, rule: Rule, value: f64) -> Self {
        Self { measures: vec![measure], any: true, rule, value }
    }

    fn by_value(node: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        match node.name() {
            "SimulationTimeCondition" => Ok(Self::single(Measure::Time, Rule::read(node)?, node.number("value")?)),
            "StoryboardElementStateCondition" => {
                let kinds = ["story", "act", "maneuverGroup", "maneuver", "event", "action"].map(|kind| (kind, kind));
                let measure = Measure::State {
                    element: node.required("storyboardElementRef")?.into_owned(),
                    kind: node.one_of("storyboardElementType", &kinds)?,
                    state: node.one_of("state", &State::NAMES)?,
                };
                Ok(Self::single(measure, Rule::GreaterOrEqual, 1.0))
            }
            "VariableCondition" => {
                let (variable, rule) = (names.variable(node, "variableRef")?, Rule::read(node)?);
                Ok(match xml::Value::of(&node.required("value")?) {
                    xml::Value::Number(number) => Self::single(Measure::Variable(variable), rule, number),
                    other => Self::single(Measure::VariableIs(variable, other), rule, 1.0),
                })
            }
            "ParameterCondition" => {
                let name = node.element.required("parameterRef")?;
                let name = name.strip_prefix('$').unwrap_or(name);
                let unknown = || node.dangling("parameterRef", "parameter", node.scope.names());
                let (found, wanted) = (node.scope.get(name).ok_or_else(unknown)?, node.required("value")?);
                let rule = Rule::read(node)?;
                Ok(match (found.parse(), wanted.parse()) {
                    (Ok(found), Ok(wanted)) => Self::single(Measure::Constant(found), rule, wanted),
                    _ => Self::single(Measure::Constant(f64::from(u8::from(found == wanted))), rule, 1.0),
                })
            }
            _ => Err(node
                .refused("use a SimulationTimeCondition, a StoryboardElementStateCondition or a ParameterCondition")),
        }
    }

    fn by_entity(node: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        let triggering = node.child("TriggeringEntities")?;
        let any = triggering.one_of("triggeringEntitiesRule", &[("any", true), ("all", false)])?;
        let entities = triggering.all("EntityRef").map(|entity| names.entity(entity, "entityRef"));
        let entities = entities.collect::<Result<Vec<_>, _>>()?;
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

impl Direction {
    fn read(node: Node<'_>) -> Result<Self, ReadError> {
        let names = [("longitudinal", Self::Longitudinal), ("lateral", Self::Lateral)];
        if node.element.text("direction").is_some() { node.one_of("direction", &names) } else { Ok(Self::Total) }
    }
}

impl Measure {
    /// Reads a condition of an entity: the measure, the rule, and the value that the measure is compared with.
    fn read(node: Node<'_>, entity: usize, names: Names<'_>) -> Result<(Self, Rule, f64), ReadError> {
        let ruled = |measure| Ok((measure, Rule::read(node)?, node.number("value")?));
        let other = || names.entity(node, "entityRef");
        match node.name() {
            "SpeedCondition" => ruled(Self::Speed { entity, direction: Direction::read(node)? }),
            "AccelerationCondition" => match Direction::read(node)? {
                Direction::Lateral => Err(node.refused("use the direction `longitudinal`")),
                Direction::Longitudinal | Direction::Total => ruled(Self::Acceleration { entity }),
            },
            "RelativeSpeedCondition" => {
                ruled(Self::RelativeSpeed { entity, other: other()?, direction: Direction::read(node)? })
            }
            "StandStillCondition" => Ok((Self::Standing { entity }, Rule::GreaterOrEqual, node.length("duration")?)),
            "EndOfRoadCondition" => Ok((Self::EndOfRoad { entity }, Rule::GreaterOrEqual, node.length("duration")?)),
            "TraveledDistanceCondition" => {
                Ok((Self::Travelled { entity }, Rule::GreaterOrEqual, node.length("value")?))
            }
            "ReachPositionCondition" => {
                let to = Goal::Place(Position::read(node.child("Position")?, names)?);
                let how = Metric { kind: MetricKind::Straight, freespace: false, system: System::Entity };
                Ok((Self::Distance { entity, to, how }, Rule::LessOrEqual, node.length("tolerance")?))
            }
            "DistanceCondition" => {
                let to = Goal::Place(Position::read(node.child("Position")?, names)?);
                ruled(Self::Distance { entity, to, how: Metric::read(node, MetricKind::Straight)? })
            }
            "RelativeDistanceCondition" => {
                let to = Goal::Entity(other()?);
                ruled(Self::Distance { entity, to, how: Metric::read(node, MetricKind::Straight)? })
            }
            "TimeHeadwayCondition" => {
                let how = Metric::read(node, MetricKind::Longitudinal)?;
                ruled(Self::Headway { entity, to: other()?, how })
            }
            "TimeToCollisionCondition" => {
                let target = node.child("TimeToCollisionConditionTarget")?.choice("EntityRef or Position")?;
                let to = match target.name() {
                    "EntityRef" => Goal::Entity(names.entity(target, "entityRef")?),
                    _ => Goal::Place(Position::read(target, names)?),
                };
                ruled(Self::TimeToCollision { entity, to, how: Metric::read(node, MetricKind::Longitudinal)? })
            }
            "CollisionCondition" => {
                let Some(reference) = node.first("EntityRef") else {
                    return Err(node.refused("name the other entity by an EntityRef"));
                };
                let other = names.entity(reference, "entityRef")?;
                Ok((Self::Touching { entity, other }, Rule::GreaterOrEqual, 1.0))
            }
            _ => Err(node.refused("use a condition on time, speed, distance or the state of an element")),
        }
    }
}

impl Metric {
    /// Reads the attributes of a distance. `usual` is the kind of the distance if the element does not say.
    pub fn read(node: Node<'_>, usual: MetricKind) -> Result<Self, ReadError> {
        let kinds = [
            ("longitudinal", MetricKind::Longitudinal),
            ("lateral", MetricKind::Lateral),
            ("euclidianDistance", MetricKind::Straight),
            ("cartesianDistance", MetricKind::Straight),
        ];
        let kind = match node.element.text("relativeDistanceType") {
            None => usual,
            Some(_) => node.one_of("relativeDistanceType", &kinds)?,
        };
        let systems = [("entity", System::Entity), ("lane", System::Lane), ("road", System::Road)];
        let system = match node.element.text("coordinateSystem") {
            None if node.truth_or("alongRoute", false)? => System::Road,
            None => System::Entity,
            Some(_) => node.one_of("coordinateSystem", &systems)?,
        };
        Ok(Self { kind, freespace: node.truth_or("freespace", false)?, system })
    }
}
