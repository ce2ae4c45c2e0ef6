//! The scenario `map-traffic`: the roads of any file of OpenDRIVE, full of traffic. The ego vehicle drives one of many ways over
//! the lanes of the map.
//!
//! The parameter `roads` has the path of the file, or `town` for a town that comes with the software. The ego vehicle begins at a
//! random place. If its lane has several next lanes, a fixed rule chooses one of them. All choices follow from the values of the test.
//!
//! Objects and signals of the map stand where the file has them. Objects on a lane are in the way of everybody. All others are
//! scenery: sensors see them, and a car can run into them.
//!
//! The speed limits of the map hold for the traffic. Where the map says nothing, the limit is 50 km/h. The ego vehicle is to keep
//! the lowest limit of its way, times `pace`.

use crate::opendrive::{Map, Road, Thing, write};
use crate::xml::ReadError;
use paracosm_engine::road::{LaneId, LaneKind, Path, RoadError, RoadNetwork, RoutePosition, grid_city};
use paracosm_engine::traffic::TrafficCar;
use paracosm_engine::{
    AutonomousVehicle, Environment, EnvironmentCars, FilesRead, Monitor, Pose, Program, Roadside, Scenario, Weather,
};
use std::collections::BTreeMap;
use std::path::Path as FilePath;
use std::sync::{Arc, Mutex, PoisonError};
use thiserror::Error;
use xxhash_rust::xxh3::xxh3_128;

/// The parameter with the path of the file of the roads.
const ROADS: &str = "roads";
/// The name of the town that comes with the software.
const TOWN: &str = "town";
/// The speed limit in m/s where the map says nothing: 50 km/h.
const USUAL: f64 = 50.0 / 3.6;
/// The greatest speed in m/s that cars want to drive, where limits are higher.
const FASTEST: f64 = 36.0;
/// The duration of a run in seconds.
const DURATION: f64 = 45.0;
/// The least length of the ego vehicle's way in metres.
const SHORTEST: f64 = 40.0;
/// The distance in metres from the end of its way at which the ego vehicle has arrived.
const ARRIVED: f64 = 15.0;
/// The number of places from which ways of the ego vehicle are tried.
const TRIES: usize = 64;
/// The least width in metres of a lane on which cars begin.
const NARROWEST: f64 = 2.4;
/// The distance in metres that a car keeps from the end of the lane on which it begins.
const MARGIN: f64 = 4.5;
/// The room that a car has for itself at the start: metres, and seconds at its speed.
const ROOM: (f64, f64) = (8.0, 1.5);
/// The width in metres of the strip that a car needs at the start.
const STRIP: f64 = 2.2;
/// The deceleration in m/s² with which a car at the start could stop before the next junction.
const GENTLE: f64 = 1.5;

/// The distance in metres that a car keeps from a body on the lanes at the start.
const CLEAR: f64 = 15.0;
/// The distance in metres over which a car looks ahead at the start.
const FORESEEN: f64 = 300.0;

/// Returns the program of the scenario. It reads each file of roads once.
pub fn map_traffic() -> Program {
    let known = Arc::new(Known::default());
    let about = "a way over the roads of any map (OpenDRIVE), in traffic";
    let reads = known.clone();
    Program::of("map-traffic", about, move |s| build(&known, s)).of_files([ROADS.to_owned()], move |test| {
        let file = test.get(ROADS)?.to_string();
        let read = if file == TOWN { None } else { read(&reads, &file).ok() }?;
        Some(FilesRead { hash: format!("{:032x}", xxh3_128(read.text.as_bytes())), paths: vec![file.into()] })
    })
}

/// The networks of the files that were read, by the value of the parameter.
type Known = Mutex<BTreeMap<String, Roads>>;

/// The network of a file, and the bodies of its objects and signals.
#[derive(Debug, Clone)]
struct Roads {
    network: Arc<RoadNetwork>,
    things: Arc<[Thing]>,
    /// The remarks on the file.
    notes: Arc<[String]>,
    /// The text of the file.
    text: Arc<str>,
}

/// The reason why the roads of a test cannot be used.
#[derive(Debug, Error)]
enum NoRoads {
    #[error(transparent)]
    File(#[from] ReadError),
    #[error("{file}: {error}")]
    Network { file: String, error: Box<RoadError> },
    #[error("{file}: the longest way over its lanes is {found:.0} m, expected at least {SHORTEST} m")]
    NoWay { file: String, found: f64 },
    #[error(
        "{file}: its roads have room for {room} of {asked} cars; set fewer cars, for example with --set cars={room} or \
         --open cars=0..{room}"
    )]
    NoRoom { file: String, room: usize, asked: usize },
}

fn build(known: &Known, s: &mut Scenario) {
    let roads = s.text(ROADS, TOWN).value();
    let cars = s.interval("cars", 0.0..=40.0).default(12.0).value().round() as usize;
    let route = s.choice("route", [1, 2, 3, 4, 5, 6, 7, 8]).default(1).value();
    let pace = s.interval("pace", 0.6..=1.2).default(1.0).value();
    let seed = s.nominal_choice("traffic_seed", [1, 2, 3, 4, 5, 6, 7, 8], 1).value();
    let friction = s.nominal("friction", 0.2..=0.8, 0.8);
    let usual = Weather::default();
    let air = [("fog", usual.fog), ("light", usual.light), ("rain", usual.rain)];
    let [fog, light, rain] = air.map(|(name, nominal)| s.nominal(name, 0.0..=1.0, nominal).atmospheric());
    let fullness = s.nominal("roadside", 0.0..=1.0, 0.0).value();

    let planned = read(known, &roads).and_then(|Roads { network, things, notes, .. }| {
        s.note(|| notes.to_vec());
        let begin = |seed| places(&network, &things, seed);
        let way = Way::drawn(&network, &roads, begin(route as u64))?;
        let speed = pace * way.limit;
        let others = others(&network, &way, speed, (seed as u64, begin(seed as u64)));
        let room = others.len();
        if room < cars {
            return Err(NoRoads::NoRoom { file: roads.clone(), room, asked: cars });
        }
        let others = others.into_iter().take(cars).collect();
        Ok((network, things, way, speed, others))
    });
    let (network, things, way, speed, others) = match planned {
        Ok(planned) => planned,
        Err(why) => return s.refuse(&why.to_string()),
    };
    s.tick(0.02);
    let streets = s.place(network);
    s.place(Environment::new().light(light).fog(fog).rain(rain).friction(friction));
    let car = s.place(AutonomousVehicle::along(way.path).starting(way.start).speed(speed));
    s.place(EnvironmentCars::on(&streets, others).seed(seed as u64));
    for thing in things.iter() {
        s.place(*thing);
    }
    s.place(Roadside::new(fullness));

    s.duration(DURATION);
    let arrived = car.remaining().at_most(ARRIVED);
    s.end(&arrived);
    s.monitor(Monitor::no_collision(&car));
    s.monitor(Monitor::right_of_way(&car, 1.0));
    s.monitor(Monitor::activity(&car, 30.0));
}

/// Returns the roads and the things of a file, or of the town.
fn read(known: &Known, roads: &str) -> Result<Roads, NoRoads> {
    let mut known = known.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(roads) = known.get(roads) {
        return Ok(roads.clone());
    }
    let file = FilePath::new(roads);
    let mut map = if roads == TOWN { town() } else { Map::read(file) }?;
    add_limits(&mut map);
    let network = map.network().map_err(|error| NoRoads::Network { file: roads.to_owned(), error: error.into() })?;
    let notes = map.notes.iter().map(|note| note.in_file(file)).collect();
    let read = Roads { things: Thing::all(&map, &network), network: network.clone(), notes, text: map.text.clone() };
    known.insert(roads.to_owned(), read.clone());
    Ok(read)
}

/// Returns the map of the town: nine junctions and the streets between them, as a file of OpenDRIVE has them.
fn town() -> Result<Map, ReadError> {
    let city = grid_city(3, 3, 90.0, 2).build().expect("the streets meet at the junctions");
    let text = write(&city, TOWN).expect("the town is made of our elements");
    Map::parse(FilePath::new("town.xodr"), text)
}

/// A way of the ego vehicle.
struct Way {
    path: Path,
    /// The place at which the car begins, in metres along the path.
    start: f64,
    /// The lowest speed limit of the lanes of the way in m/s.
    limit: f64,
}

impl Way {
    /// Returns the first of the ways from many places that is long enough for a whole run, or the longest of these ways.
    fn drawn(network: &RoadNetwork, roads: &str, places: impl Iterator<Item = RoutePosition>) -> Result<Self, NoRoads> {
        let mut longest: Option<(f64, Vec<LaneId>, f64)> = None;
        for (index, place) in places.take(TRIES).enumerate() {
            let wanted = DURATION * network.lane(place.lane).limit_at(place.s).unwrap_or(USUAL).min(FASTEST);
            let mut lanes = vec![place.lane];
            let mut length = network.lane(place.lane).length() - place.s;
            while length < wanted {
                let next = &network.lane(lanes[lanes.len() - 1]).successors;
                let Some(lane) = next.get((index + lanes.len()) % next.len().max(1)) else { break };
                lanes.push(*lane);
                length += network.lane(*lane).length();
            }
            if longest.as_ref().is_none_or(|(most, ..)| length > *most) {
                longest = Some((length, lanes, place.s));
            }
            if length >= wanted {
                break;
            }
        }
        match longest {
            Some((length, lanes, start)) if length >= SHORTEST => {
                let limit = limits(network, &lanes).reduce(f64::min).unwrap_or(USUAL).min(FASTEST);
                Ok(Self { path: network.path(&lanes), start, limit })
            }
            other => Err(NoRoads::NoWay { file: roads.to_owned(), found: other.map_or(0.0, |(length, ..)| length) }),
        }
    }
}

/// Returns the speed limits of lanes, in m/s.
fn limits(network: &RoadNetwork, lanes: &[LaneId]) -> impl Iterator<Item = f64> {
    lanes.iter().flat_map(|lane| &network.lane(*lane).limits).map(|limit| limit.speed)
}

/// Adds the limits that a map lacks, if the map has limits at all: the usual limit where the map says nothing, and the greatest speed
/// of cars where the map says that there is no limit.
fn add_limits(map: &mut Map) {
    let lanes = |road: &Road| road.sections.iter().any(|of| of.lanes.iter().any(|lane| !lane.limits.is_empty()));
    if !map.roads.iter().any(|road| !road.limits.is_empty() || lanes(road)) {
        return;
    }
    for road in &mut map.roads {
        if road.limits.first().is_none_or(|(from, _)| *from > 0.0) {
            road.limits.insert(0, (0.0, Some(USUAL)));
        }
        let lanes = road.sections.iter_mut().flat_map(|section| &mut section.lanes);
        let all = road.limits.iter_mut().chain(lanes.flat_map(|lane| &mut lane.limits));
        all.for_each(|(_, limit)| *limit = limit.or(Some(FASTEST)));
    }
}

/// Returns random places on roads at which a car can begin, in random order.
fn places(network: &RoadNetwork, things: &[Thing], seed: u64) -> impl Iterator<Item = RoutePosition> {
    let fits = |place: &RoutePosition| {
        let lane = network.lane(place.lane);
        let here = lane.curve.point(place.s);
        let near = |thing: &Thing| (thing.at.position - here).norm() < CLEAR + thing.body.outline.reach();
        lane.width_at(place.s) >= NARROWEST
            && (MARGIN..=lane.length() - MARGIN).contains(&place.s)
            && !things.iter().any(|thing| thing.is_in_the_way && near(thing))
    };
    TrafficCar::scattered(network, usize::MAX, seed).into_iter().map(|car| car.start()).filter(fits)
}

/// The room of a car at its start.
struct Room {
    lane: LaneId,
    s: f64,
    pose: Pose,
    /// The metres that the car needs before and behind it.
    metres: f64,
}

impl Room {
    fn of(network: &RoadNetwork, place: RoutePosition, speed: f64) -> Self {
        let RoutePosition { lane, s } = place;
        Self { lane, s, pose: network.lane(lane).curve.at(s), metres: ROOM.0 + ROOM.1 * speed }
    }

    /// Returns `true` if the room of the car meets the room of another car.
    fn meets(&self, other: &Self) -> bool {
        let metres = self.metres.max(other.metres);
        let aside = self.pose.to_local(other.pose.position);
        self.lane == other.lane && (self.s - other.s).abs() < metres || aside.x.abs() < metres && aside.y.abs() < STRIP
    }
}

/// Returns cars for all places on the roads at which there is room for a car that drives, in random order.
fn others(
    network: &RoadNetwork,
    way: &Way,
    speed: f64,
    (seed, places): (u64, impl Iterator<Item = RoutePosition>),
) -> Vec<TrafficCar> {
    let lane = way.path.lane_pieces().next().map(|(_, lane)| lane);
    let ego = lane.map(|lane| Room::of(network, RoutePosition { lane, s: way.start }, 2.0 * speed));
    let mut taken: Vec<Room> = ego.into_iter().collect();
    let all: Vec<LaneId> = network.ids().collect();
    let desired = limits(network, &all).reduce(f64::max).unwrap_or(USUAL).min(FASTEST);
    let mut cars = Vec::new();
    for (index, place) in places.enumerate() {
        let car = TrafficCar::at(place).desired_speed(desired).varied(1000 * seed + index as u64);
        let free = free_metres(network, place);
        let lane = network.lane(place.lane);
        let bend = (GENTLE / lane.curve.greatest_curvature()).sqrt();
        let most = lane.limit_at(place.s).unwrap_or(USUAL).min(FASTEST);
        let speed = (2.0 * GENTLE * free).sqrt().min(bend).min(0.9 * most);
        let room = Room::of(network, place, speed);
        if !taken.iter().any(|other| room.meets(other)) {
            taken.push(room);
            cars.push(car.changing_lanes().speed(speed));
        }
    }
    cars
}

/// Returns the metres from a place to the next lane of a junction, at most [`FORESEEN`].
fn free_metres(network: &RoadNetwork, place: RoutePosition) -> f64 {
    let mut lane = network.lane(place.lane);
    let mut metres = lane.length() - place.s;
    while metres < FORESEEN {
        match *lane.successors {
            [next] if network.lane(next).kind == LaneKind::Road => lane = network.lane(next),
            [] => return FORESEEN,
            _ => return metres,
        }
        metres += lane.length();
    }
    FORESEEN
}
