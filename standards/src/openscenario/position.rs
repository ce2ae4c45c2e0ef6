//! Positions as a scenario describes them, with the ways and the routes between them. A position is found in the world when an action or a
//! condition needs it.

use super::clothoid::Clothoid;
use super::names::Names;
use super::nurbs::Nurbs;
use super::scope::Node;
use crate::xml::{Flaw, ReadError};

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
    /// A place `s` metres along a way, and `t` metres to its left.
    Along { way: Box<Way>, s: f64, t: f64, turn: Turn },
    /// A place on a route.
    OnRoute { route: Route, place: RoutePlace, turn: Turn },
}

/// A place on a route. The distance `s` in metres counts from the beginning of the route.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum RoutePlace {
    /// `offset` metres to the left of the middle of a lane of the road that is there.
    Lane { s: f64, lane: i32, offset: f64 },
    /// `t` metres to the left of the reference line of the road that is there.
    Road { s: f64, t: f64 },
    /// The place of an entity.
    Entity(usize),
}

/// A route: the shortest way along roads through all waypoints.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Route {
    pub waypoints: Vec<Position>,
}

/// A way that an entity follows.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Way {
    /// Straight lines between vertices.
    Polyline { vertices: Vec<Vertex>, closed: bool },
    /// Clothoids, each of which begins where the one before ends. Without a start, the way begins at the entity that follows it.
    Clothoids { start: Option<Box<Position>>, segments: Vec<Clothoid>, end: f64 },
    /// A curve through control points.
    Nurbs { points: Vec<Vertex>, nurbs: Nurbs },
}

/// A vertex of a polyline, with the time in seconds at which the entity is there.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Vertex {
    pub position: Position,
    pub time: f64,
    /// `true` if the position gives the heading of the entity, `false` if the entity faces along its way.
    pub faces: bool,
}

/// The heading at a position, in radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Turn {
    /// A heading in the world.
    Absolute(f64),
    /// An angle from the direction of the lane, of the road or of the entity.
    Relative(f64),
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
            "LanePosition" => {
                names.sites.check_place(kind)?;
                Self::Lane {
                    road: kind.required("roadId")?.into_owned(),
                    lane: kind.lane("laneId")?,
                    s: kind.number("s")?,
                    offset: kind.number_or("offset", 0.0)?,
                    turn: Turn::read(kind)?,
                }
            }
            "RoadPosition" => {
                names.sites.check_place(kind)?;
                Self::Road {
                    road: kind.required("roadId")?.into_owned(),
                    s: kind.number("s")?,
                    t: kind.number("t")?,
                    turn: Turn::read(kind)?,
                }
            }
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
            "TrajectoryPosition" => {
                let given = kind.child("TrajectoryRef")?.choice("Trajectory or CatalogReference")?;
                let way = names.catalogs.resolved(given, &["Trajectory"], |given| Way::read(given, names, false))?;
                let (s, t) = (kind.number("s")?, kind.number_or("t", 0.0)?);
                Self::Along { way: Box::new(way), s, t, turn: Turn::read(kind)? }
            }
            "RoutePosition" => {
                let given = kind.child("RouteRef")?.choice("Route or CatalogReference")?;
                let place = kind.child("InRoutePosition")?.choice("FromRoadCoordinates or FromLaneCoordinates")?;
                let place = match place.name() {
                    "FromLaneCoordinates" => {
                        names.sites.check_lane(place, "laneId")?;
                        RoutePlace::Lane {
                            s: place.length("pathS")?,
                            lane: place.lane("laneId")?,
                            offset: place.number_or("laneOffset", 0.0)?,
                        }
                    }
                    "FromRoadCoordinates" => RoutePlace::Road { s: place.length("pathS")?, t: place.number("t")? },
                    _ => RoutePlace::Entity(names.entity(place, "entityRef")?),
                };
                Self::OnRoute { route: Route::read(given, names)?, place, turn: Turn::read(kind)? }
            }
            _ => return Err(kind.refused("use a LanePosition, a RoadPosition or a WorldPosition")),
        })
    }
}

impl Route {
    /// Reads an element `Route`, or a `CatalogReference` to one.
    pub fn read(given: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        names.catalogs.resolved(given, &["Route"], |route| {
            let waypoint = |waypoint: Node<'_>| Position::read(waypoint.child("Position")?, names);
            let mut waypoints = route.all("Waypoint").map(waypoint).collect::<Result<Vec<_>, ReadError>>()?;
            at_least_two(route, "waypoint", waypoints.len())?;
            if route.truth_or("closed", false)? {
                waypoints.push(waypoints[0].clone());
            }
            Ok(Self { waypoints })
        })
    }
}

impl Way {
    /// Reads an element `Trajectory`. The vertices of a polyline need times if an entity is there `on_time`.
    pub fn read(trajectory: Node<'_>, names: Names<'_>, on_time: bool) -> Result<Self, ReadError> {
        let shape = trajectory.child("Shape")?.choice("Polyline")?;
        let vertex = |vertex: Node<'_>| {
            let given = vertex.child("Position")?;
            let faces =
                given.elements().any(|kind| kind.first("Orientation").is_some() || kind.element.text("h").is_some());
            Ok(Vertex { position: Position::read(given, names)?, time: vertex.length_or("time", 0.0)?, faces })
        };
        match shape.name() {
            "Polyline" => {
                let vertices = shape.all("Vertex").map(vertex).collect::<Result<Vec<_>, ReadError>>()?;
                at_least_two(shape, "point", vertices.len())?;
                if on_time {
                    rising(shape)?;
                }
                Ok(Self::Polyline { vertices, closed: trajectory.truth_or("closed", false)? })
            }
            "Clothoid" => {
                let prime =
                    if shape.element.text("curvaturePrime").is_some() { "curvaturePrime" } else { "curvatureDot" };
                let segment = Clothoid {
                    curvature: shape.number("curvature")?,
                    rate: shape.number(prime)?,
                    length: Clothoid::length(shape, 0.0)?,
                    turn: 0.0,
                    time: shape.number_or("startTime", 0.0)?,
                };
                let start = Some(Box::new(Position::read(shape.child("Position")?, names)?));
                Ok(Self::Clothoids { start, segments: vec![segment], end: shape.number_or("stopTime", 0.0)? })
            }
            "ClothoidSpline" => {
                let first = shape.first("ClothoidSplineSegment").and_then(|segment| segment.first("PositionStart"));
                let start = first.map(|position| Position::read(position, names)).transpose()?.map(Box::new);
                let mut segments: Vec<Clothoid> = Vec::new();
                let mut before = 0.0;
                for segment in shape.all("ClothoidSplineSegment") {
                    let segment = Clothoid::read(segment, segments.is_empty(), before)?;
                    before += segment.length;
                    segments.push(segment);
                }
                Ok(Self::Clothoids { start, segments, end: shape.number_or("timeEnd", 0.0)? })
            }
            "Nurbs" => {
                let points = shape.all("ControlPoint").map(vertex).collect::<Result<Vec<_>, ReadError>>()?;
                Ok(Self::Nurbs { nurbs: Nurbs::read(shape, points.len())?, points })
            }
            _ => Err(shape.refused("use a Polyline, a Clothoid, a ClothoidSpline or a Nurbs")),
        }
    }
}

/// Checks the number of the places that a route or a polyline leads through.
fn at_least_two(node: Node<'_>, child: &'static str, found: usize) -> Result<(), ReadError> {
    let element = node.name().to_owned();
    if found >= 2 { Ok(()) } else { Err(node.error(Flaw::TooFew { element, child, found, least: 2 })) }
}

/// Checks that all vertices of a polyline have times, and that the times do not fall.
fn rising(polyline: Node<'_>) -> Result<(), ReadError> {
    let mut before = 0.0;
    for vertex in polyline.all("Vertex") {
        let time = vertex.length("time")?;
        if time < before {
            let expected = format!("at least {before}, the time of the vertex before");
            return Err(vertex.unexpected("time", &vertex.required("time")?, expected));
        }
        before = time;
    }
    Ok(())
}
