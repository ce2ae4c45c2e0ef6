//! Actions as a scenario describes them.

use super::handover::Handover;
use super::measure::{Metric, MetricKind};
use super::names::Names;
use super::position::{Position, Route, Way};
use super::profile::Profile;
use super::scope::Node;
use super::transition::{Dynamics, SHAPES, Shape};
use crate::xml::{Flaw, ReadError};

/// An action of one entity.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Action {
    Teleport(Position),
    Speed {
        dynamics: Dynamics,
        target: Target,
    },
    Profile(Profile),
    /// The distance to an entity.
    Gap {
        entity: usize,
        gap: Gap,
        how: Metric,
        continuous: bool,
        ahead: Option<bool>,
        limits: Option<[f64; 3]>,
    },
    /// The distance to an entity to the side.
    Beside(Beside),
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
    /// Follows a route.
    Route(Route),
    /// Follows the shortest route to a position.
    Acquire(Position),
    Synchronize(Box<Synchronization>),
    /// Changes the controller of the entity.
    Control(Handover),
    /// Puts the entity into the world.
    Add(Position),
    /// Takes the entity out of the world.
    Delete,
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
    /// The distance that the other entity travels in so many seconds.
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

/// The distance that an entity keeps to another entity to the side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Beside {
    pub entity: usize,
    /// The distance in metres; `None` for the distance at the beginning.
    pub metres: Option<f64>,
    /// `true` if the distance is between boxes, `false` if it is between reference points.
    pub freespace: bool,
    /// `true` to the left of the other entity, `false` to its right, `None` on the side at the beginning.
    pub left: Option<bool>,
    pub continuous: bool,
    pub limits: Option<[f64; 3]>,
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
    pub master_target: Position,
    pub target: Position,
    /// The speed at the arrival; `None` if it does not matter.
    pub final_speed: Option<Target>,
    pub steady: Steady,
    /// The metres within which the master and the entity have reached their targets.
    pub tolerances: [f64; 2],
}

/// The part of the way before a target on which an entity has its final speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Steady {
    Metres(f64),
    Seconds(f64),
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
    /// Returns `true` if the action moves its entity.
    pub fn moves(&self) -> bool {
        matches!(
            self,
            Self::Teleport(_)
                | Self::Speed { .. }
                | Self::Profile(_)
                | Self::Gap { .. }
                | Self::Beside(_)
                | Self::LaneChange { .. }
                | Self::LaneOffset { .. }
                | Self::Trajectory(_)
                | Self::Synchronize(_)
        )
    }

    /// Reads an element `PrivateAction`.
    pub fn private(node: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        let kind = node.choice("a kind of action such as LongitudinalAction")?;
        let inner = || kind.choice("a kind of action");
        match kind.name() {
            "TeleportAction" => Ok(Self::Teleport(Position::read(kind.child("Position")?, names)?)),
            "LongitudinalAction" => Self::longitudinal(inner()?, names),
            "LateralAction" => Self::lateral(inner()?, names),
            "RoutingAction" => Self::routing(inner()?, names),
            "SynchronizeAction" => Self::synchronize(kind, names),
            "ControllerAction" | "ActivateControllerAction" => Handover::read(kind).map(Self::Control),
            "AppearanceAction" | "VisibilityAction" => Ok(Self::Nothing),
            _ => Err(kind.refused("use a longitudinal, lateral, routing, teleport or controller action")),
        }
    }

    fn synchronize(node: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        let master = names.entity(node, "masterEntityRef")?;
        let last =
            node.first("FinalSpeed").map(|speed| speed.choice("AbsoluteSpeed or RelativeSpeedToMaster")).transpose()?;
        let final_speed = match last {
            Some(speed) if speed.name() == "AbsoluteSpeed" => {
                speed.length("value")?;
                Some(Target::Absolute(speed.speed("value")?))
            }
            Some(speed) => Some(Target::relative(speed, master)?),
            None => None,
        };
        let steady = match last.and_then(|speed| speed.elements().next()) {
            Some(steady) if steady.name() == "TargetDistanceSteadyState" => Steady::Metres(steady.length("distance")?),
            Some(steady) => Steady::Seconds(steady.length("time")?),
            None => Steady::Metres(0.0),
        };
        let within = |name| node.length_or(name, 0.0);
        Ok(Self::Synchronize(Box::new(Synchronization {
            master,
            master_target: Position::read(node.child("TargetPositionMaster")?, names)?,
            target: Position::read(node.child("TargetPosition")?, names)?,
            final_speed,
            steady,
            tolerances: [within("targetToleranceMaster")?, within("targetTolerance")?],
        })))
    }

    fn longitudinal(node: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        match node.name() {
            "SpeedAction" => {
                let target = node.child("SpeedActionTarget")?.choice("AbsoluteTargetSpeed or RelativeTargetSpeed")?;
                let dynamics = Dynamics::read(node.child("SpeedActionDynamics")?, names)?;
                Ok(Self::Speed { dynamics, target: Target::read(target, names)? })
            }
            "SpeedProfileAction" => {
                let other = node.element.text("entityRef").map(|_| names.entity(node, "entityRef")).transpose()?;
                Profile::read(node, other).map(Self::Profile)
            }
            "LongitudinalDistanceAction" => {
                let attributes = ["distance", "timeGap"];
                let gap = match attributes.map(|name| node.element.text(name).is_some()) {
                    [true, false] => Gap::Metres(node.length("distance")?),
                    [false, true] => Gap::Seconds(node.length("timeGap")?),
                    [both, _] => {
                        let element = node.name().to_owned();
                        return Err(node.error(Flaw::OneAttribute { element, attributes, both }));
                    }
                };
                let ahead = match node.element.text("displacement") {
                    None => Some(false),
                    Some(_) => node.one_of(
                        "displacement",
                        &[
                            ("any", None),
                            ("leadingReferencedEntity", Some(true)),
                            ("trailingReferencedEntity", Some(false)),
                        ],
                    )?,
                };
                Ok(Self::Gap {
                    entity: names.entity(node, "entityRef")?,
                    gap,
                    how: Metric::read(node, MetricKind::Longitudinal)?,
                    continuous: node.truth_or("continuous", false)?,
                    ahead,
                    limits: limits(node, names)?,
                })
            }
            _ => Err(node.refused("use a SpeedAction, a SpeedProfileAction or a LongitudinalDistanceAction")),
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
                    _ => {
                        names.sites.check_lane(target, "value")?;
                        Lane::Absolute(target.lane("value")?)
                    }
                };
                let dynamics = Dynamics::read(node.child("LaneChangeActionDynamics")?, names)?;
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
            "LateralDistanceAction" => {
                let sides =
                    [("any", None), ("leftToReferencedEntity", Some(true)), ("rightToReferencedEntity", Some(false))];
                let given =
                    node.element.text("displacement").map(|_| node.one_of("displacement", &sides)).transpose()?;
                Ok(Self::Beside(Beside {
                    entity: names.entity(node, "entityRef")?,
                    metres: node.element.text("distance").map(|_| node.length("distance")).transpose()?,
                    freespace: node.truth_or("freespace", false)?,
                    left: given.flatten(),
                    continuous: node.truth_or("continuous", false)?,
                    limits: limits(node, names)?,
                }))
            }
            _ => Err(node.refused("use a LaneChangeAction or a LaneOffsetAction")),
        }
    }

    fn routing(node: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        match node.name() {
            "AssignRouteAction" => {
                let given = node.choice("Route or CatalogReference")?;
                return Route::read(given, names).map(Self::Route);
            }
            "AcquirePositionAction" => return Position::read(node.child("Position")?, names).map(Self::Acquire),
            "FollowTrajectoryAction" => (),
            _ => return Err(node.refused("use an AssignRouteAction or a FollowTrajectoryAction")),
        }
        let given = match node.first("TrajectoryRef") {
            Some(reference) => reference.choice("Trajectory")?,
            None => node
                .elements()
                .find(|inner| ["Trajectory", "CatalogReference"].contains(&inner.name()))
                .ok_or_else(|| node.element.lacks("Trajectory"))?,
        };
        names.catalogs.resolved(given, &["Trajectory"], |given| Self::trajectory(node, given, names))
    }

    fn trajectory(node: Node<'_>, given: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        let timing = node.child("TimeReference")?.first("Timing").map(Timing::read).transpose()?;
        let from = node.length_or("initialDistanceOffset", 0.0)?;
        Ok(Self::Trajectory(Box::new(Trajectory { way: Way::read(given, names, timing.is_some())?, timing, from })))
    }
}

/// Reads the greatest acceleration, deceleration and speed within an element; `None` if it has no limits.
fn limits(node: Node<'_>, names: Names<'_>) -> Result<Option<[f64; 3]>, ReadError> {
    let Some(limits) = node.first("DynamicConstraints") else { return Ok(None) };
    for rate in ["maxAccelerationRate", "maxDecelerationRate"] {
        if limits.element.has(rate) {
            limits.limit(rate)?;
            names.catalogs.remark(limits, rate, "only a SpeedProfileAction limits the changes of accelerations");
        }
    }
    let most = |name| if limits.element.text(name).is_some() { limits.limit(name) } else { Ok(f64::INFINITY) };
    Ok(Some([most("maxAcceleration")?, most("maxDeceleration")?, most("maxSpeed")?]))
}

impl Target {
    fn read(node: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        if node.name() != "RelativeTargetSpeed" {
            return Ok(Self::Absolute(node.speed("value")?));
        }
        Self::relative(node, names.entity(node, "entityRef")?)
    }

    /// Reads the attributes of a speed that is relative to the speed of an entity.
    fn relative(node: Node<'_>, entity: usize) -> Result<Self, ReadError> {
        Ok(Self::Relative {
            entity,
            value: node.speed("value")?,
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
