//! Actions as a scenario describes them.

use super::catalogs::Catalogs;
use super::condition::{Metric, MetricKind};
use super::position::{Names, Position};
use super::scope::Node;
use super::transition::{Dynamics, SHAPES, Shape};
use super::way::{self, Way};
use crate::xml::ReadError;

/// An action of one entity.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Action {
    Teleport(Position),
    Speed {
        dynamics: Dynamics,
        target: Target,
    },
    /// The distance to an entity.
    Gap {
        entity: usize,
        gap: Gap,
        how: Metric,
        continuous: bool,
        ahead: Option<bool>,
        limits: Option<[f64; 3]>,
    },
    LaneChange {
        dynamics: Dynamics,
        lane: Lane,
        offset: f64,
    },
    LaneOffset {
        shape: Shape,
        most_acceleration: Option<f64>,
        target: Lateral,
        continuous: bool,
    },
    Trajectory(Box<Trajectory>),
    Synchronize(Box<Synchronization>),
    /// Hands the entity over to its controller.
    Activate {
        lateral: Option<bool>,
        longitudinal: Option<bool>,
    },
    /// Has no effect in this world.
    Nothing,
}

/// The target of a change of speed, in m/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Target {
    Absolute(f64),
    /// The speed of an entity, plus a number or times a factor.
    Relative {
        entity: usize,
        value: f64,
        is_factor: bool,
        continuous: bool,
    },
}

/// The distance that an entity keeps to another entity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Gap {
    Metres(f64),
    /// The distance that the entity travels in so many seconds.
    Seconds(f64),
}

/// The lane that an entity changes to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Lane {
    Absolute(i32),
    /// The number of lanes to the left of the lane of an entity.
    Relative {
        entity: usize,
        lanes: i32,
    },
}

/// The offset from the middle of a lane that an entity moves to, in metres to the left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Lateral {
    Absolute(f64),
    Relative { entity: usize, value: f64 },
}

/// A way that an entity follows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Trajectory {
    pub way: Way,
    /// The scale and the offset of the times of the vertices; `None` if the entity keeps its speed.
    pub timing: Option<Timing>,
    /// The metres along the way at which the entity begins.
    pub from: f64,
}

/// The arrival of an entity at a place when another entity, the master, arrives at another place.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Synchronization {
    pub master: usize,
    pub master_target: way::Target,
    pub target: way::Target,
    /// The speed at the arrival in m/s; `None` if it does not matter.
    pub final_speed: Option<f64>,
    /// The distance in metres before the target from which on the entity has its final speed.
    pub steady: f64,
}

/// The times of a way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Timing {
    pub scale: f64,
    pub offset: f64,
    /// `true` if times count from the beginning of the action, `false` if they count from the beginning of the run.
    pub is_relative: bool,
}

impl Action {
    /// Reads an element `PrivateAction`.
    pub fn private(node: Node<'_>, names: Names<'_>, catalogs: &Catalogs<'_>) -> Result<Self, ReadError> {
        let kind = node.choice("a kind of action such as LongitudinalAction")?;
        let inner = || kind.choice("a kind of action");
        match kind.name() {
            "TeleportAction" => Ok(Self::Teleport(Position::read(kind.child("Position")?, names)?)),
            "LongitudinalAction" => Self::longitudinal(inner()?, names),
            "LateralAction" => Self::lateral(inner()?, names),
            "RoutingAction" => Self::routing(inner()?, names, catalogs),
            "SynchronizeAction" => Self::synchronize(kind, names, catalogs),
            "ControllerAction" => {
                let mut actions = kind.elements().filter(|action| action.name() == "ActivateControllerAction");
                actions.next().map_or(Ok(Self::Nothing), Self::activate)
            }
            "ActivateControllerAction" => Self::activate(kind),
            "VisibilityAction" | "AppearanceAction" => Ok(Self::Nothing),
            _ => Err(kind.refused("use a longitudinal, lateral, routing, teleport or controller action")),
        }
    }

    fn synchronize(node: Node<'_>, names: Names<'_>, catalogs: &Catalogs<'_>) -> Result<Self, ReadError> {
        let absolute = node.first("FinalSpeed").map(|speed| speed.child("AbsoluteSpeed")).transpose()?;
        let final_speed = absolute.map(|speed| speed.length("value")).transpose()?;
        let steady = absolute.and_then(|speed| speed.elements().next());
        let steady = match (steady, final_speed) {
            (Some(steady), _) if steady.name() == "TargetDistanceSteadyState" => steady.length("distance")?,
            (Some(steady), Some(speed)) => steady.length("time")? * speed,
            _ => 0.0,
        };
        Ok(Self::Synchronize(Box::new(Synchronization {
            master: names.entity(node, "masterEntityRef")?,
            master_target: way::Target::read(node.child("TargetPositionMaster")?, names, catalogs)?,
            target: way::Target::read(node.child("TargetPosition")?, names, catalogs)?,
            final_speed,
            steady,
        })))
    }

    fn activate(node: Node<'_>) -> Result<Self, ReadError> {
        let truth = |name| node.element.text(name).map(|_| node.truth_or(name, false)).transpose();
        Ok(Self::Activate { lateral: truth("lateral")?, longitudinal: truth("longitudinal")? })
    }

    fn longitudinal(node: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        match node.name() {
            "SpeedAction" => {
                let target = node.child("SpeedActionTarget")?.choice("AbsoluteTargetSpeed or RelativeTargetSpeed")?;
                let dynamics = Dynamics::read(node.child("SpeedActionDynamics")?)?;
                Ok(Self::Speed { dynamics, target: Target::read(target, names)? })
            }
            "LongitudinalDistanceAction" => {
                let gap = match node.optional("distance")? {
                    Some(_) => Gap::Metres(node.length("distance")?),
                    None => Gap::Seconds(node.length("timeGap")?),
                };
                let ahead = match node.element.text("displacement") {
                    None => Some(true),
                    Some(_) => node.one_of(
                        "displacement",
                        &[
                            ("any", None),
                            ("leadingReferencedEntity", Some(true)),
                            ("trailingReferencedEntity", Some(false)),
                        ],
                    )?,
                };
                let limits = node.first("DynamicConstraints").map(|limits| {
                    let most = |name| limits.number_or(name, f64::INFINITY);
                    Ok([most("maxAcceleration")?, most("maxDeceleration")?, most("maxSpeed")?])
                });
                Ok(Self::Gap {
                    entity: names.entity(node, "entityRef")?,
                    gap,
                    how: Metric::read(node, MetricKind::Longitudinal)?,
                    continuous: node.truth_or("continuous", false)?,
                    ahead,
                    limits: limits.transpose()?,
                })
            }
            _ => Err(node.refused("use a SpeedAction or a LongitudinalDistanceAction")),
        }
    }

    fn lateral(node: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        match node.name() {
            "LaneChangeAction" => {
                let target = node.child("LaneChangeTarget")?.choice("AbsoluteTargetLane or RelativeTargetLane")?;
                let lane = match target.name() {
                    "RelativeTargetLane" => {
                        Lane::Relative { entity: names.entity(target, "entityRef")?, lanes: target.whole("value")? }
                    }
                    _ => Lane::Absolute(target.whole("value")?),
                };
                let dynamics = Dynamics::read(node.child("LaneChangeActionDynamics")?)?;
                Ok(Self::LaneChange { dynamics, lane, offset: node.number_or("targetLaneOffset", 0.0)? })
            }
            "LaneOffsetAction" => {
                let target =
                    node.child("LaneOffsetTarget")?.choice("AbsoluteTargetLaneOffset or RelativeTargetLaneOffset")?;
                let value = target.number("value")?;
                let target = match target.name() {
                    "RelativeTargetLaneOffset" => {
                        Lateral::Relative { entity: names.entity(target, "entityRef")?, value }
                    }
                    _ => Lateral::Absolute(value),
                };
                let dynamics = node.child("LaneOffsetActionDynamics")?;
                let most = dynamics.optional("maxLateralAcc")?.map(|_| dynamics.length("maxLateralAcc")).transpose()?;
                Ok(Self::LaneOffset {
                    shape: dynamics.one_of("dynamicsShape", &SHAPES)?,
                    most_acceleration: most,
                    target,
                    continuous: node.truth_or("continuous", false)?,
                })
            }
            _ => Err(node.refused("use a LaneChangeAction or a LaneOffsetAction")),
        }
    }

    fn routing(node: Node<'_>, names: Names<'_>, catalogs: &Catalogs<'_>) -> Result<Self, ReadError> {
        if node.name() != "FollowTrajectoryAction" {
            return Err(node.refused("use a FollowTrajectoryAction"));
        }
        let given = match node.first("TrajectoryRef") {
            Some(reference) => reference.choice("Trajectory")?,
            None => node
                .elements()
                .find(|inner| ["Trajectory", "CatalogReference"].contains(&inner.name()))
                .ok_or_else(|| node.element.lacks("Trajectory"))?,
        };
        catalogs.resolved(given, &["Trajectory"], |given| Self::trajectory(node, given, names))
    }

    fn trajectory(node: Node<'_>, given: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        let timing = node.child("TimeReference")?.first("Timing").map(Timing::read).transpose()?;
        let from = node.number_or("initialDistanceOffset", 0.0)?;
        Ok(Self::Trajectory(Box::new(Trajectory { way: Way::read(given, names)?, timing, from })))
    }
}

impl Target {
    fn read(node: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        let value = node.number("value")?;
        if node.name() != "RelativeTargetSpeed" {
            return Ok(Self::Absolute(value));
        }
        Ok(Self::Relative {
            entity: names.entity(node, "entityRef")?,
            value,
            is_factor: node.one_of("speedTargetValueType", &[("delta", false), ("factor", true)])?,
            continuous: node.truth_or("continuous", false)?,
        })
    }
}

impl Timing {
    fn read(node: Node<'_>) -> Result<Self, ReadError> {
        Ok(Self {
            scale: node.length("scale")?,
            offset: node.number("offset")?,
            is_relative: node.one_of("domainAbsoluteRelative", &[("relative", true), ("absolute", false)])?,
        })
    }
}
