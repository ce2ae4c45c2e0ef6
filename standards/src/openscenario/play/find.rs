//! The places of positions in the world, as it is at the moment.

use super::actor::{Actor, Whereabouts};
use super::track::Track;
use crate::opendrive::Map;
use crate::openscenario::place::{Place, driving_turn};
use crate::openscenario::position::{Position, Route, RoutePlace, Turn, Way};
use crate::openscenario::project::project;
use crate::openscenario::route::{Legs, Stop};
use crate::xml::{Misfit, rounded};
use nalgebra::Vector2;
use paracosm_engine::Pose;
use paracosm_engine::road::wrapped;
use std::f64::consts::PI;
use std::path::PathBuf;
use thiserror::Error;

/// The reason why a position has no place in the world.
#[derive(Debug, Clone, PartialEq, Error)]
pub(in crate::openscenario) enum Lost {
    #[error("the map has no road `{road}`{}", paracosm_space::did_you_mean(nearest))]
    NoRoad { road: String, nearest: Option<String> },
    #[error("road `{road}` has no lane {lane} at s = {} m, its lanes are {first} to {last}", rounded(*s))]
    NoLane { road: String, lane: i32, s: f64, first: i32, last: i32 },
    #[error("road `{road}` has no place at s = {} m, it is {} m long", rounded(*s), rounded(*length))]
    NoPlace { road: String, s: f64, length: f64 },
    #[error("`{entity}` is beside all roads or has no place yet, so it has no place on a lane")]
    OffRoad { entity: String },
    #[error("no road leads from `{from}` to `{to}` within 2 km")]
    NoWay { from: String, to: String },
    #[error("`{entity}` is the car of the driver, which stays in the world")]
    Own { entity: String },
    #[error("`{entity}` cannot keep a distance to itself")]
    Itself { entity: String },
    #[error("`{entity}` has no greatest acceleration; give each SpeedProfileEntry a time, or give DynamicConstraints")]
    NoLimits { entity: String },
    #[error("a waypoint of the route is beside all roads")]
    OffRoute,
    #[error("the way begins at {metres} m, and it is {} m long", rounded(*length))]
    Beyond { metres: f64, length: f64 },
    #[error("the way leads to a place beside all roads")]
    Beside,
    #[error("no road leads from road `{from}` to road `{to}`")]
    NoRoute { from: String, to: String },
    #[error(transparent)]
    Misfit(Box<Misfit>),
}

/// The reason why an initial action cannot begin. The line is that of the action in the file.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{line}: an initial action of `{entity}` cannot begin: {lost}")]
pub(in crate::openscenario) struct Misplaced {
    pub line: u32,
    pub entity: String,
    pub lost: Lost,
}

/// An action of a story that cannot begin, with its place in a file.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::openscenario) struct Unplayable {
    pub file: PathBuf,
    pub line: u32,
    pub action: String,
    pub lost: Lost,
}

/// The least distance in metres beyond the end of a road at which a position is not on the road.
const BEYOND: f64 = 1e-6;

/// Returns the place of a position.
pub(super) fn find(position: &Position, actors: &[Actor], map: &Map) -> Result<Whereabouts, Lost> {
    let on_road = |entity: usize| {
        let off = || Lost::OffRoad { entity: actors[entity].entity.name.clone() };
        actors[entity].on_lane(map).ok_or_else(off)
    };
    match position {
        Position::World { x, y, heading } => {
            Ok(placed(Pose { position: Vector2::new(*x, *y), heading: *heading }, map))
        }
        Position::Lane { road, lane, s, offset, turn } => {
            let (index, s) = road_at(road, *s, map)?;
            Ok(Whereabouts::OnLane(on_lane(index, *lane, s, *offset, *turn, map)?))
        }
        Position::Road { road, s, t, turn } => {
            let (index, s) = road_at(road, *s, map)?;
            Ok(Whereabouts::OnLane(beside(index, s, *t, *turn, map)))
        }
        Position::RelativeLane { entity, lanes, ds, along_lane, offset, turn } => {
            let mut place = on_road(*entity)?;
            place.offset = 0.0;
            let against = place.is_against();
            let below = actors[*entity].on_lane(map).map_or(place.lane, |place| place.lane_below(map));
            place.lane = neighbour(below, *lanes);
            if *along_lane {
                place.advance(*ds, map);
            } else {
                let lane = place.lane;
                place.lane = 0;
                place.advance(if against { -*ds } else { *ds }, map);
                // The lane goes on over a road of the other direction.
                place.lane = if place.is_against() == against { lane } else { -lane };
                place.offset = 0.0;
            }
            Ok(Whereabouts::OnLane(on_lane(place.road, place.lane, place.s, *offset, *turn, map)?))
        }
        Position::RelativeRoad { entity, ds, dt, turn } => {
            let mut place = on_road(*entity)?;
            let t = place.t(map) + dt;
            (place.lane, place.offset) = (0, 0.0);
            let against = place.is_against();
            place.advance(if against { -*ds } else { *ds }, map);
            let turns = place.is_against() != against;
            let there = beside(place.road, place.s, if turns { -t } else { t }, *turn, map);
            let is_relative = matches!(turn, Turn::Relative(_));
            let turn = if turns && is_relative { wrapped(there.turn + PI) } else { there.turn };
            Ok(Whereabouts::OnLane(Place { turn, ..there }))
        }
        Position::RelativeWorld { entity, dx, dy, turn } => {
            let from = actors[*entity].pose;
            let position = from.position + Vector2::new(*dx, *dy);
            Ok(placed(Pose { position, heading: turned(from, *turn) }, map))
        }
        Position::RelativeObject { entity, dx, dy, turn } => {
            let from = actors[*entity].pose;
            let position = from.position + from.turn_to_plane(Vector2::new(*dx, *dy));
            Ok(placed(Pose { position, heading: turned(from, *turn) }, map))
        }
        Position::Along { way, s, t, turn } => {
            let track = track(way, None, actors, map)?;
            let here = track.map_or(Pose { position: Vector2::zeros(), heading: 0.0 }, |track| track.at(*s));
            let position = here.position + here.left() * *t;
            Ok(placed(Pose { position, heading: turned(here, *turn) }, map))
        }
        Position::OnRoute { route, place, turn } => {
            let legs = legs(route, actors, map)?;
            match place {
                RoutePlace::Lane { s, lane, offset } => {
                    let (road, s) = legs.at(*s);
                    Ok(Whereabouts::OnLane(on_lane(road, *lane, s, *offset, *turn, map)?))
                }
                RoutePlace::Road { s, t } => {
                    let (road, s) = legs.at(*s);
                    Ok(Whereabouts::OnLane(beside(road, s, *t, *turn, map)))
                }
                RoutePlace::Entity(entity) => Ok(match actors[*entity].place(map) {
                    Whereabouts::OnLane(place) => Whereabouts::OnLane(facing(place, *turn, map)),
                    Whereabouts::Free(pose) => Whereabouts::Free(Pose { heading: turned(pose, *turn), ..pose }),
                }),
            }
        }
    }
}

/// Returns the roads of a route.
pub(super) fn legs(route: &Route, actors: &[Actor], map: &Map) -> Result<Legs, Lost> {
    let place = |waypoint: &Position| match find(waypoint, actors, map)? {
        Whereabouts::OnLane(place) => Ok(place),
        Whereabouts::Free(_) => Err(Lost::OffRoute),
    };
    let places = route.waypoints.iter().map(place).collect::<Result<Vec<_>, Lost>>()?;
    through(&places, map)
}

/// Returns the roads of the shortest way through places.
pub(super) fn through(places: &[Place], map: &Map) -> Result<Legs, Lost> {
    let stops: Vec<Stop> =
        places.iter().map(|place| Stop { road: place.road, s: place.s, forward: !place.is_against() }).collect();
    Legs::through(&stops, map).map_err(|[from, to]| {
        let [from, to] = [from, to].map(|road| map.roads[road].id.clone());
        Lost::NoRoute { from, to }
    })
}

/// Returns the place on the lane under a pose, or the pose itself beside all roads.
fn placed(pose: Pose, map: &Map) -> Whereabouts {
    project(&pose, map).map_or(Whereabouts::Free(pose), Whereabouts::OnLane)
}

/// Returns a way that an entity at the pose `from` follows; `None` for a way without a beginning.
pub(super) fn track(way: &Way, from: Option<Pose>, actors: &[Actor], map: &Map) -> Result<Option<Track>, Lost> {
    let pose = |position: &Position| {
        // A place of the world needs no lane, which might end just before the place.
        if let Position::World { x, y, heading } = position {
            return Ok(Pose { position: Vector2::new(*x, *y), heading: *heading });
        }
        Ok(match find(position, actors, map)? {
            Whereabouts::OnLane(place) => place.pose(map),
            Whereabouts::Free(pose) => pose,
        })
    };
    match way {
        Way::Polyline { vertices, closed } => {
            let again = vertices.first().filter(|_| *closed);
            let all =
                vertices.iter().chain(again).map(|vertex| Ok((pose(&vertex.position)?, vertex.time, vertex.faces)));
            Ok(Track::polyline(all.collect::<Result<Vec<_>, Lost>>()?))
        }
        Way::Nurbs { points, nurbs } => {
            let points = points.iter().map(|point| Ok((pose(&point.position)?.position, point.time)));
            let points = points.collect::<Result<Vec<_>, Lost>>()?;
            Ok(Some(Track::nurbs(&points, nurbs)))
        }
        Way::Clothoids { start, segments, end } => {
            let start = start.as_deref().map(pose).transpose()?.or(from);
            Ok(start.map(|start| Track::clothoids(start, segments, *end)))
        }
    }
}

fn turned(from: Pose, turn: Turn) -> f64 {
    match turn {
        Turn::Absolute(heading) => heading,
        Turn::Relative(angle) => wrapped(from.heading + angle),
    }
}

/// Returns the number of the lane that is so many lanes to the left. There is no lane 0 to drive on.
pub(super) fn neighbour(lane: i32, left: i32) -> i32 {
    let there = lane + left;
    if lane != 0 && (there == 0 || there.signum() != lane.signum()) { there + left.signum() } else { there }
}

/// Returns the index of a road, and the place on it.
fn road_at(id: &str, s: f64, map: &Map) -> Result<(usize, f64), Lost> {
    let unknown = || {
        let nearest = paracosm_space::nearest(id, map.roads.iter().map(|road| road.id.as_str())).map(str::to_owned);
        Lost::NoRoad { road: id.to_owned(), nearest }
    };
    let index = map.road(id).ok_or_else(unknown)?;
    let length = map.roads[index].length;
    if (0.0..=length + BEYOND).contains(&s) {
        Ok((index, s.min(length)))
    } else {
        Err(Lost::NoPlace { road: id.to_owned(), s, length })
    }
}

fn on_lane(index: usize, lane: i32, s: f64, offset: f64, turn: Turn, map: &Map) -> Result<Place, Lost> {
    check_lane(index, lane, s, map)?;
    let road = &map.roads[index];
    let along = driving_turn(road, road.section_at(s), lane);
    Ok(facing(Place { road: index, s, lane, offset, turn: along }, turn, map))
}

/// Checks that a road has a lane at a place along it.
pub(super) fn check_lane(road: usize, lane: i32, s: f64, map: &Map) -> Result<(), Lost> {
    let road = &map.roads[road];
    let section = &road.sections[road.section_at(s)];
    if section.lane(lane).is_some() {
        return Ok(());
    }
    let numbers = [section.lanes.last(), section.lanes.first()].map(|lane| lane.map_or(0, |lane| lane.number));
    // Places are sums of rounded numbers, and nobody needs more than millimetres here.
    let s = (1000.0 * s).round() / 1000.0;
    Err(Lost::NoLane { road: road.id.clone(), lane, s, first: numbers[0], last: numbers[1] })
}

/// Returns the place `t` metres to the left of the reference line, on the lane that is there.
fn beside(road: usize, s: f64, t: f64, turn: Turn, map: &Map) -> Place {
    let mut place = Place { road, s, lane: 0, offset: 0.0, turn: 0.0 };
    place.offset = t - place.t(map);
    let lane = place.lane_below(map);
    place.enter(lane, map);
    facing(place, turn, map)
}

/// Turns a place from the direction of its lane, or to a heading in the world.
fn facing(place: Place, turn: Turn, map: &Map) -> Place {
    match turn {
        Turn::Relative(angle) => Place { turn: place.turn + angle, ..place },
        Turn::Absolute(heading) => {
            let along = Place { turn: 0.0, ..place }.pose(map).heading;
            Place { turn: wrapped(heading - along), ..place }
        }
    }
}
