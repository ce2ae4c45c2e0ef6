//! Ways through the world as a scenario describes them: polylines and clothoids.

use super::catalogs::Catalogs;
use super::position::{Names, Position};
use super::scope::Node;
use crate::xml::ReadError;

/// A way that an entity follows.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Way {
    /// Straight lines between vertices.
    Polyline { vertices: Vec<Vertex>, closed: bool },
    /// Clothoids, each of which begins where the one before ends. Without a start, the way begins at the entity that follows it.
    Clothoids { start: Option<Box<Position>>, segments: Vec<Clothoid>, end: f64 },
}

/// A place that an entity is to reach.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Target {
    At(Position),
    /// A place `s` metres along a way, and `t` metres to its left.
    Along {
        way: Way,
        s: f64,
        t: f64,
    },
}

/// A vertex of a polyline, with the time in seconds at which the entity is there.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Vertex {
    pub position: Position,
    pub time: f64,
}

/// A curve whose curvature changes evenly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Clothoid {
    /// The curvature at the beginning in 1/m, and its change in 1/m².
    pub curvature: f64,
    pub rate: f64,
    /// The length in metres.
    pub length: f64,
    /// The turn at the beginning in radians.
    pub turn: f64,
    /// The time in seconds at the beginning.
    pub time: f64,
}

impl Way {
    /// Reads an element `Trajectory`.
    pub fn read(trajectory: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        let shape = trajectory.child("Shape")?.choice("Polyline")?;
        match shape.name() {
            "Polyline" => {
                let vertex = |vertex: Node<'_>| {
                    let position = Position::read(vertex.child("Position")?, names)?;
                    Ok(Vertex { position, time: vertex.number_or("time", 0.0)? })
                };
                let vertices = shape.all("Vertex").map(vertex).collect::<Result<_, ReadError>>()?;
                Ok(Self::Polyline { vertices, closed: trajectory.truth_or("closed", false)? })
            }
            "Clothoid" => {
                let prime =
                    if shape.element.text("curvaturePrime").is_some() { "curvaturePrime" } else { "curvatureDot" };
                let segment = Clothoid {
                    curvature: shape.number("curvature")?,
                    rate: shape.number(prime)?,
                    length: shape.length("length")?,
                    turn: 0.0,
                    time: shape.number_or("startTime", 0.0)?,
                };
                let start = Some(Box::new(Position::read(shape.child("Position")?, names)?));
                Ok(Self::Clothoids { start, segments: vec![segment], end: shape.number_or("stopTime", 0.0)? })
            }
            "ClothoidSpline" => {
                let first = shape.first("ClothoidSplineSegment").and_then(|segment| segment.first("PositionStart"));
                let start = first.map(|position| Position::read(position, names)).transpose()?.map(Box::new);
                let segments = shape.all("ClothoidSplineSegment").enumerate();
                let segments = segments.map(|(index, segment)| Clothoid::read(segment, index == 0));
                let segments = segments.collect::<Result<_, ReadError>>()?;
                Ok(Self::Clothoids { start, segments, end: shape.number_or("timeEnd", 0.0)? })
            }
            _ => Err(shape.refused("use a Polyline, a Clothoid or a ClothoidSpline")),
        }
    }
}

impl Target {
    /// Reads an element with the content of a `Position`. The way of a `TrajectoryPosition` may lie in a catalog.
    pub fn read(node: Node<'_>, names: Names<'_>, catalogs: &Catalogs<'_>) -> Result<Self, ReadError> {
        let kind = node.choice("a kind of position such as LanePosition")?;
        if kind.name() != "TrajectoryPosition" {
            return Ok(Self::At(Position::read(node, names)?));
        }
        let given = kind.child("TrajectoryRef")?.choice("Trajectory or CatalogReference")?;
        let way = catalogs.resolved(given, &["Trajectory"], |given| Way::read(given, names))?;
        Ok(Self::Along { way, s: kind.number("s")?, t: kind.number_or("t", 0.0)? })
    }
}

impl Clothoid {
    fn read(segment: Node<'_>, is_first: bool) -> Result<Self, ReadError> {
        if let Some(position) = segment.first("PositionStart").filter(|_| !is_first) {
            return Err(
                position.refused("only the first segment has a start; the others begin where the one before ends")
            );
        }
        let (from, to) = (segment.number("curvatureStart")?, segment.number("curvatureEnd")?);
        let length = segment.length("length")?;
        Ok(Self {
            curvature: from,
            rate: if length > 0.0 { (to - from) / length } else { 0.0 },
            length,
            turn: segment.number_or("hOffset", 0.0)?,
            time: segment.number_or("timeStart", 0.0)?,
        })
    }
}
