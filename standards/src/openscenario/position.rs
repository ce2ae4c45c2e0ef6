//! Positions as a scenario describes them. A position is found in the world when an action or a condition needs it.

use super::scope::Node;
use crate::xml::ReadError;

/// A position, in the ways in which a file describes it.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Position {
    /// A place in the world, in metres and radians.
    World { x: f64, y: f64, heading: f64 },
    /// A place `offset` metres to the left of the middle of a lane.
    Lane { road: String, lane: i32, s: f64, offset: f64, turn: Turn },
    /// A place `t` metres to the left of the reference line of a road.
    Road { road: String, s: f64, t: f64, turn: Turn },
    /// A place `lanes` lanes to the left of an entity and `ds` metres further along the road, or along the lane.
    RelativeLane { entity: usize, lanes: i32, ds: f64, along_lane: bool, offset: f64, turn: Turn },
    /// A place `ds` metres further along the road than an entity, and `dt` metres to its left.
    RelativeRoad { entity: usize, ds: f64, dt: f64, turn: Turn },
    /// A place that differs from an entity's place by a vector of the world.
    RelativeWorld { entity: usize, dx: f64, dy: f64, turn: Turn },
    /// A place that differs from an entity's place by a vector as the entity sees it.
    RelativeObject { entity: usize, dx: f64, dy: f64, turn: Turn },
}

/// The heading at a position, in radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Turn {
    /// A heading in the world.
    Absolute(f64),
    /// An angle from the direction of the lane, of the road or of the entity.
    Relative(f64),
}

/// The names that a scenario declares, in their order.
#[derive(Debug, Clone, Copy)]
pub(super) struct Names<'a> {
    pub entities: &'a [String],
    pub variables: &'a [String],
}

impl Names<'_> {
    /// Returns the index of the entity that an attribute names.
    pub fn entity(self, node: Node<'_>, attribute: &'static str) -> Result<usize, ReadError> {
        let name = node.required(attribute)?;
        let index = self.entities.iter().position(|known| *known == name);
        index.ok_or_else(|| node.dangling(attribute, "entity", self.entities.iter().map(String::as_str)))
    }

    /// Returns the index of the variable that an attribute names.
    pub fn variable(self, node: Node<'_>, attribute: &'static str) -> Result<usize, ReadError> {
        let name = node.element.required(attribute)?;
        let name = name.strip_prefix('$').unwrap_or(name);
        let index = self.variables.iter().position(|known| known == name);
        index.ok_or_else(|| node.dangling(attribute, "variable", self.variables.iter().map(String::as_str)))
    }
}

impl Turn {
    fn read(position: Node<'_>) -> Result<Self, ReadError> {
        let Some(orientation) = position.first("Orientation") else { return Ok(Self::Relative(0.0)) };
        let heading = orientation.number_or("h", 0.0)?;
        let is_relative = match orientation.element.text("type") {
            None => false,
            Some(_) => orientation.one_of("type", &[("relative", true), ("absolute", false)])?,
        };
        Ok(if is_relative { Self::Relative(heading) } else { Self::Absolute(heading) })
    }
}

impl Position {
    /// Reads an element `Position`, or another element with the same content.
    pub fn read(node: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        let kind = node.choice("a kind of position such as LanePosition")?;
        let entity = || names.entity(kind, "entityRef");
        Ok(match kind.name() {
            "WorldPosition" => {
                Self::World { x: kind.number("x")?, y: kind.number("y")?, heading: kind.number_or("h", 0.0)? }
            }
            "LanePosition" => Self::Lane {
                road: kind.required("roadId")?.into_owned(),
                lane: kind.whole("laneId")?,
                s: kind.number("s")?,
                offset: kind.number_or("offset", 0.0)?,
                turn: Turn::read(kind)?,
            },
            "RoadPosition" => Self::Road {
                road: kind.required("roadId")?.into_owned(),
                s: kind.number("s")?,
                t: kind.number("t")?,
                turn: Turn::read(kind)?,
            },
            "RelativeLanePosition" => {
                let along_lane = kind.element.text("dsLane").is_some();
                Self::RelativeLane {
                    entity: entity()?,
                    lanes: kind.whole("dLane")?,
                    ds: kind.number(if along_lane { "dsLane" } else { "ds" })?,
                    along_lane,
                    offset: kind.number_or("offset", 0.0)?,
                    turn: Turn::read(kind)?,
                }
            }
            "RelativeRoadPosition" => Self::RelativeRoad {
                entity: entity()?,
                ds: kind.number("ds")?,
                dt: kind.number("dt")?,
                turn: Turn::read(kind)?,
            },
            "RelativeWorldPosition" | "RelativeObjectPosition" => {
                let (entity, dx, dy, turn) = (entity()?, kind.number("dx")?, kind.number("dy")?, Turn::read(kind)?);
                if kind.name() == "RelativeWorldPosition" {
                    Self::RelativeWorld { entity, dx, dy, turn }
                } else {
                    Self::RelativeObject { entity, dx, dy, turn }
                }
            }
            _ => return Err(kind.refused("use a LanePosition, a RoadPosition or a WorldPosition")),
        })
    }
}
