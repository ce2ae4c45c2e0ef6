//! Numbers that conditions measure, as a scenario describes them.

use super::entity::ObjectType;
use super::names::Names;
use super::position::Position;
use super::rule::Rule;
use super::scope::Node;
use super::state::State;
use crate::xml::{self, ReadError};

/// A number that is measured at every tick.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Measure {
    Time,
    /// The seconds since the beginning of the year 1970, as the time of day goes.
    TimeOfDay,
    /// A number that never changes.
    Constant(f64),
    /// The number in a variable.
    Variable(usize),
    /// 1 while a variable has a value, otherwise 0.
    VariableIs(usize, xml::Value),
    /// 1 while the element of the storyboard with this index is in the state, otherwise 0.
    State {
        element: usize,
        state: State,
    },
    Speed {
        entity: usize,
        direction: Direction,
    },
    Acceleration {
        entity: usize,
        direction: Direction,
    },
    /// The speed of the entity minus the speed of another entity, along the entity's own axes if there is a direction.
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
    /// 1 while the entity touches one of other entities, otherwise 0.
    Touching {
        entity: usize,
        others: Vec<usize>,
    },
    /// The seconds for which the entity has been at the end of its road.
    EndOfRoad {
        entity: usize,
    },
    /// The seconds for which the entity has been beside all lanes.
    Offroad {
        entity: usize,
    },
    /// 1 while no other entity is in an area of the lanes around the entity, otherwise 0.
    Clearance(Box<Clearance>),
    /// The angle in radians by which the entity's heading differs from a wanted heading, in [0, pi].
    Turned {
        entity: usize,
        from: Bearing,
        wanted: f64,
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

impl Metric {
    /// Returns `true` if the distance depends on the places of entities on lanes.
    pub fn is_along_lanes(self) -> bool {
        self.kind != MetricKind::Straight && self.system != System::Entity
    }
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

/// An area of the lanes around an entity.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Clearance {
    pub entity: usize,
    /// The entities that must not be in the area; all others if there are none.
    pub others: Vec<usize>,
    /// The metres ahead and behind to which the area reaches.
    pub reach: [f64; 2],
    /// The first and the last lane, as numbers of lanes to the left of the entity's lane; all lanes if there are no ranges.
    pub lanes: Vec<[f64; 2]>,
    /// `true` if the lanes of the other direction belong to the area.
    pub opposite: bool,
    /// `true` if boxes count, `false` if reference points count.
    pub freespace: bool,
}

/// The direction from which an angle counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Bearing {
    World,
    /// The direction of the entity's lane, or of its road.
    Lane,
    /// The heading of another entity.
    Entity(usize),
}

impl Direction {
    fn read(node: Node<'_>) -> Result<Self, ReadError> {
        let names = [("longitudinal", Self::Longitudinal), ("lateral", Self::Lateral)];
        if node.element.text("direction").is_some() { node.one_of("direction", &names) } else { Ok(Self::Total) }
    }
}

impl Measure {
    /// Returns the entity whose seconds beside all lanes this measure is.
    pub fn offroad(&self) -> Option<usize> {
        if let Self::Offroad { entity } = self { Some(*entity) } else { None }
    }

    /// Reads a condition of an entity: the measure, the rule, and the value that the measure is compared with.
    pub fn read(node: Node<'_>, entity: usize, names: Names<'_>) -> Result<(Self, Rule, f64), ReadError> {
        let ruled = |measure| Ok((measure, Rule::read(node)?, node.number("value")?));
        // No distance and no time to something is negative.
        let apart = |measure| Ok((measure, Rule::read(node)?, node.length("value")?));
        let other = || names.entity(node, "entityRef");
        match node.name() {
            "SpeedCondition" => ruled(Self::Speed { entity, direction: Direction::read(node)? }),
            "AccelerationCondition" => ruled(Self::Acceleration { entity, direction: Direction::read(node)? }),
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
                apart(Self::Distance { entity, to, how: Metric::read(node, MetricKind::Straight)? })
            }
            "RelativeDistanceCondition" => {
                let to = Goal::Entity(other()?);
                apart(Self::Distance { entity, to, how: Metric::read(node, MetricKind::Straight)? })
            }
            "TimeHeadwayCondition" => {
                let how = Metric::read(node, MetricKind::Longitudinal)?;
                apart(Self::Headway { entity, to: other()?, how })
            }
            "TimeToCollisionCondition" => {
                let target = node.child("TimeToCollisionConditionTarget")?.choice("EntityRef or Position")?;
                let to = match target.name() {
                    "EntityRef" => Goal::Entity(names.entity(target, "entityRef")?),
                    _ => Goal::Place(Position::read(target, names)?),
                };
                apart(Self::TimeToCollision { entity, to, how: Metric::read(node, MetricKind::Longitudinal)? })
            }
            "CollisionCondition" => {
                let other = node.choice("EntityRef or ByType")?;
                let others = match other.name() {
                    "EntityRef" => names.group(other, "entityRef")?,
                    _ => names.of_type(other.one_of("type", &ObjectType::NAMES)?),
                };
                let others = others.into_iter().filter(|other| *other != entity).collect();
                Ok((Self::Touching { entity, others }, Rule::GreaterOrEqual, 1.0))
            }
            "OffroadCondition" => Ok((Self::Offroad { entity }, Rule::GreaterOrEqual, node.length("duration")?)),
            "RelativeClearanceCondition" => {
                Ok((Self::Clearance(Box::new(Clearance::read(node, entity, names)?)), Rule::GreaterOrEqual, 1.0))
            }
            "AngleCondition" | "RelativeAngleCondition" => {
                let from = Bearing::read(node, names)?;
                let wanted = node.number("angle")?;
                Ok((Self::Turned { entity, from, wanted }, Rule::LessOrEqual, node.length("angleTolerance")?))
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

impl Clearance {
    fn read(node: Node<'_>, entity: usize, names: Names<'_>) -> Result<Self, ReadError> {
        let range = |range: Node<'_>| {
            let end =
                |name, open| Ok(if range.element.text(name).is_some() { f64::from(range.whole(name)?) } else { open });
            Ok([end("from", f64::NEG_INFINITY)?, end("to", f64::INFINITY)?])
        };
        let others = node.all("EntityRef").map(|other| names.entity(other, "entityRef"));
        let metres = |name| node.length_or(name, 0.0);
        Ok(Self {
            entity,
            others: others.collect::<Result<_, _>>()?,
            reach: [metres("distanceForward")?, metres("distanceBackward")?],
            lanes: node.all("RelativeLaneRange").map(range).collect::<Result<_, ReadError>>()?,
            opposite: node.truth_or("oppositeLanes", true)?,
            freespace: node.truth_or("freeSpace", false)?,
        })
    }
}

impl Bearing {
    fn read(node: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        if node.name() == "RelativeAngleCondition" {
            return Ok(Self::Entity(names.entity(node, "entityRef")?));
        }
        let systems = [("entity", Self::World), ("world", Self::World), ("lane", Self::Lane), ("road", Self::Lane)];
        if node.element.text("coordinateSystem").is_some() {
            node.one_of("coordinateSystem", &systems)
        } else {
            Ok(Self::World)
        }
    }
}
