//! The descriptions of traffic cars, as programs write them.

use super::error::TrafficError;
use super::idm::Idm;
use super::map::Map;
use crate::object::{Body, Colour, Outline};
use crate::road::{LaneId, LaneKind, RoadNetwork, Route, RoutePosition};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

/// The desired speed in m/s by default: 50 km/h.
const TOWN: f64 = 50.0 / 3.6;
/// The number of arms after which a car without a route leaves a roundabout.
const MOST_ARMS: usize = 3;
/// The metres of a lane that each scattered car has for itself.
const SLOT: f64 = 9.0;

/// The description of a car that takes part in simulated traffic.
#[derive(Debug, Clone, PartialEq)]
pub struct TrafficCar {
    pub(super) start: RoutePosition,
    pub(super) way: Way,
    pub(super) desired: f64,
    pub(super) speed: f64,
    pub(super) idm: Idm,
    pub(crate) body: Body,
    pub(super) offset: f64,
    pub(super) changes_lanes: bool,
    pub(super) heedless: bool,
}

/// The way of a car: without a goal, along a route, or round and round.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Way {
    Wander,
    Follow(Vec<LaneId>, f64),
    Circle(Vec<LaneId>),
}

impl TrafficCar {
    /// Makes a passenger car that stands with its middle at `start`. It drives at 50 km/h on a free road and
    /// turns at random.
    pub fn at(start: RoutePosition) -> Self {
        Self {
            start,
            way: Way::Wander,
            desired: TOWN,
            speed: 0.0,
            idm: Idm::default(),
            body: Body::car(),
            offset: 0.0,
            changes_lanes: false,
            heedless: false,
        }
    }

    /// Makes a car that drives along a route from the start to the end, and stays at the end.
    ///
    /// # Panics
    /// The route has no lanes.
    pub fn following(route: &Route) -> Self {
        let start = RoutePosition { lane: route.lanes[0], s: route.start };
        Self { way: Way::Follow(route.lanes.clone(), route.end), ..Self::at(start) }
    }

    /// Makes a car that drives along a route again and again. The first lane follows the last lane or equals it.
    ///
    /// # Panics
    /// The route has no lanes.
    pub fn circling(route: &Route) -> Self {
        let mut lanes = route.lanes.clone();
        if lanes.len() > 1 && lanes.last() == lanes.first() {
            lanes.pop();
        }
        let start = RoutePosition { lane: lanes[0], s: route.start };
        Self { way: Way::Circle(lanes), ..Self::at(start) }
    }

    /// Returns the place where the car starts.
    pub fn start(&self) -> RoutePosition {
        self.start
    }

    /// Sets the speed in m/s at which the car drives on a free road.
    pub fn desired_speed(mut self, speed: f64) -> Self {
        self.desired = speed;
        self
    }

    /// Sets the speed in m/s that the car has at the start.
    pub fn speed(mut self, speed: f64) -> Self {
        self.speed = speed;
        self
    }

    /// Sets the parameters of the model by which the car follows other cars.
    pub fn idm(mut self, idm: Idm) -> Self {
        self.idm = idm;
        self
    }

    /// Sets the body of the car: its class, its size and its colour. The outline of the body should be a rectangle.
    pub fn body(mut self, body: Body) -> Self {
        self.body = body;
        self
    }

    /// Sets the length and width of the car in metres. The class and the height stay. A vehicle larger than 7 m by
    /// 2.3 m reaches into the neighbouring lane in a turn: its middle stays on its lane, and its rear does not cut the
    /// corner.
    pub fn size(mut self, length: f64, width: f64) -> Self {
        self.body.outline = Outline::Rectangle { length, width };
        self
    }

    pub(super) fn length(&self) -> f64 {
        2.0 * self.body.outline.half_extent().x
    }

    pub(super) fn width(&self) -> f64 {
        2.0 * self.body.outline.half_extent().y
    }

    /// Sets the distance in metres at which the car drives to the right of the middle of its lane.
    pub fn keeping_right(mut self, metres: f64) -> Self {
        self.offset = -metres;
        self
    }

    /// Lets the car change lanes by the model MOBIL in order to drive faster. By default, a car changes lanes only
    /// where its route does.
    pub fn changing_lanes(mut self) -> Self {
        self.changes_lanes = true;
        self
    }

    /// Makes the car ignore all bodies that are not part of the traffic.
    pub fn heedless(mut self) -> Self {
        self.heedless = true;
        self
    }

    /// Sets the colour of the car as an object of a scenario, instead of the usual colour.
    pub fn coloured(mut self, colour: Colour) -> Self {
        self.body.colour = colour;
        self
    }

    /// Lets the car start at its desired speed.
    pub fn moving(self) -> Self {
        Self { speed: self.desired, ..self }
    }

    /// Returns a similar car with random changes of its size and its driver, which follow from `seed`. The car is up to
    /// 10 % longer or shorter and up to 16 % faster or slower; its parameters as a follower change by up to 20 %.
    pub fn varied(self, seed: u64) -> Self {
        let mut random = Pcg64::seed_from_u64(seed);
        let mut near = |value: f64, share: f64| value * random.random_range(1.0 - share..=1.0 + share);
        let (length, width) = (near(self.length(), 0.1), near(self.width(), 0.04));
        Self {
            desired: near(self.desired, 0.16),
            idm: Idm {
                acceleration: near(self.idm.acceleration, 0.2),
                deceleration: near(self.idm.deceleration, 0.2),
                headway: near(self.idm.headway, 0.2),
                gap: near(self.idm.gap, 0.2),
                ..self.idm
            },
            ..self.size(length, width)
        }
    }

    /// Makes a panel van that starts at a place.
    pub fn van(start: RoutePosition) -> Self {
        Self::at(start).body(Body::van())
    }

    /// Makes a lorry for routes that lead straight on. It accelerates about half as fast as a car.
    pub fn truck(start: RoutePosition) -> Self {
        let idm = Idm { acceleration: 0.8, ..Idm::default() };
        Self::at(start).body(Body::truck()).idm(idm)
    }

    /// Makes a city bus for routes that lead straight on. It accelerates at up to 1 m/s², since passengers stand.
    pub fn bus(start: RoutePosition) -> Self {
        let idm = Idm { acceleration: 1.0, ..Idm::default() };
        Self::at(start).body(Body::bus()).idm(idm)
    }

    /// Makes a motorcycle that starts at a place.
    pub fn motorcycle(start: RoutePosition) -> Self {
        Self::at(start).body(Body::motorcycle())
    }

    /// Makes a bicycle that drives at up to 5 m/s at the right of its lane.
    pub fn bicycle(start: RoutePosition) -> Self {
        let idm = Idm { acceleration: 0.8, deceleration: 1.5, gap: 1.5, ..Idm::default() };
        Self::at(start).body(Body::bicycle()).desired_speed(5.0).keeping_right(1.0).idm(idm)
    }

    /// Returns `count` cars at different random places on the roads of a network, or fewer cars if there is no more
    /// room. Each is made by [`TrafficCar::at`].
    pub fn scattered(network: &RoadNetwork, count: usize, seed: u64) -> Vec<Self> {
        let mut places = Vec::new();
        for (id, lane) in network.ids().zip(network.lanes()).filter(|(_, lane)| lane.kind == LaneKind::Road) {
            let slots = (lane.length() / SLOT) as usize;
            places.extend((0..slots).map(|slot| RoutePosition { lane: id, s: (slot as f64 + 0.5) * SLOT }));
        }
        let mut random = Pcg64::seed_from_u64(seed);
        let count = count.min(places.len());
        for i in 0..count {
            let other = random.random_range(i..places.len());
            places.swap(i, other);
        }
        places.truncate(count);
        places.into_iter().map(Self::at).collect()
    }

    /// Moves lane changes within a roundabout to the road before it, if that is possible.
    pub(super) fn planned(mut self, map: &Map) -> Self {
        if let Way::Follow(lanes, _) | Way::Circle(lanes) = &mut self.way
            && lanes.iter().all(|lane| lane.index() < map.network.lanes().len())
        {
            let within = |pair: &[LaneId]| !map.is_road(pair[0]) && map.beside(pair[0], pair[1]);
            while let Some(at) = lanes.windows(2).position(within) {
                let Some(earlier) = changed_earlier(lanes, at, map) else { break };
                *lanes = earlier;
            }
        }
        self
    }

    /// Refuses values and routes that are not valid.
    pub(super) fn check(&self, index: usize, map: &Map) -> Result<(), TrafficError> {
        let lanes = map.network.lanes().len();
        let number = |what, value: f64, least: f64, most: f64| {
            let fits = (least..=most).contains(&value);
            if fits { Ok(()) } else { Err(TrafficError::Value { car: index, what, value, least, most }) }
        };
        let way: &[LaneId] = match &self.way {
            Way::Wander => &[],
            Way::Follow(lanes, _) | Way::Circle(lanes) => lanes,
        };
        if let Some(lane) = way.iter().chain([&self.start.lane]).find(|lane| lane.index() >= lanes) {
            return Err(TrafficError::UnknownLane { car: index, lane: lane.index(), lanes });
        }
        number("place in metres along its lane", self.start.s, 0.0, map.length(self.start.lane))?;
        number("length in metres", self.length(), 0.1, 30.0)?;
        number("width in metres", self.width(), 0.1, map.network.lane(self.start.lane).width_at(self.start.s))?;
        number("desired speed in m/s", self.desired, 0.0, 100.0)?;
        number("speed in m/s", self.speed, 0.0, 100.0)?;
        number("offset in metres to the right", -self.offset, -5.0, 5.0)?;
        number("acceleration of IDM in m/s²", self.idm.acceleration, 0.01, 10.0)?;
        number("deceleration of IDM in m/s²", self.idm.deceleration, 0.01, 10.0)?;
        number("time headway of IDM in s", self.idm.headway, 0.0, 100.0)?;
        number("gap of IDM in metres", self.idm.gap, 0.5, 100.0)?;
        number("exponent of IDM", self.idm.exponent, 0.1, 100.0)?;
        let leads = |from: LaneId, to: LaneId| {
            let beside = map.is_road(from) && map.beside(from, to);
            beside || map.network.lane(from).successors.contains(&to)
        };
        let closing = match &self.way {
            Way::Circle(lanes) if lanes.len() > 1 => Some((lanes[lanes.len() - 1], lanes[0])),
            Way::Circle(lanes) => Some((lanes[0], lanes[0])),
            _ => None,
        };
        let pairs = way.windows(2).map(|pair| (pair[0], pair[1])).chain(closing);
        for (from, to) in pairs {
            if !leads(from, to) {
                return Err(TrafficError::Route { car: index, from: from.index(), to: to.index() });
            }
        }
        Ok(())
    }
}

/// Moves the lane change after the lane with index `at` back to the last road before it; `None` if no such way exists.
fn changed_earlier(lanes: &[LaneId], at: usize, map: &Map) -> Option<Vec<LaneId>> {
    let lane = |id: LaneId| map.network.lane(id);
    let mut way: Vec<LaneId> = lanes[at + 1..].iter().rev().copied().collect();
    for before in (0..at).rev() {
        let beside = lanes[before];
        let like = |other: &&LaneId| {
            let (one, other) = (lane(beside), lane(**other));
            (one.kind, one.element, one.number.signum()) == (other.kind, other.element, other.number.signum())
        };
        way.push(*lane(way[way.len() - 1]).predecessors.iter().find(like)?);
        if map.is_road(beside) {
            let last = way[way.len() - 1];
            way.extend(Some(beside).filter(|beside| map.beside(*beside, last)));
            way.extend(lanes[..before].iter().rev());
            way.reverse();
            return Some(way);
        }
    }
    None
}

/// The choices of a car at forks.
#[derive(Debug)]
pub(super) enum Itinerary {
    /// The car chooses at random; the number counts the arms that it has passed since it entered a roundabout.
    Wander(Pcg64, usize),
    Lanes {
        lanes: Vec<LaneId>,
        next: usize,
        circular: bool,
    },
}

impl Itinerary {
    /// Returns the itinerary of a car after its first lane, and the end of the itinerary in metres along its last lane.
    pub fn of(car: &TrafficCar, index: usize, seed: u64) -> (Self, f64) {
        match &car.way {
            Way::Wander => (Self::Wander(Pcg64::new(u128::from(seed), index as u128), 0), f64::INFINITY),
            Way::Follow(way, end) => (Self::Lanes { lanes: way.clone(), next: 1, circular: false }, *end),
            Way::Circle(way) => {
                // The lane after a lane that leads to itself is the same lane.
                let next = 1 % way.len();
                (Self::Lanes { lanes: way.clone(), next, circular: true }, f64::INFINITY)
            }
        }
    }

    /// Returns the lane that the car takes after the lane `last`; `None` if the itinerary ends with this lane.
    pub fn next(&mut self, last: LaneId, network: &RoadNetwork) -> Option<LaneId> {
        match self {
            Self::Wander(random, arms) => {
                let exit = |lane: &&LaneId| network.lane(**lane).kind == LaneKind::Exit;
                let lane = match &*network.lane(last).successors {
                    [] => return None,
                    [only] => *only,
                    several if *arms >= MOST_ARMS => *several.iter().find(exit).unwrap_or(&several[0]),
                    several => several[random.random_range(0..several.len())],
                };
                *arms = match network.lane(lane).kind {
                    LaneKind::RingAtArm => *arms + 1,
                    LaneKind::Ring => *arms,
                    _ => 0,
                };
                Some(lane)
            }
            Self::Lanes { lanes, next, circular } => {
                let lane = *lanes.get(*next)?;
                *next += 1;
                if *circular && *next == lanes.len() {
                    *next = 0;
                }
                Some(lane)
            }
        }
    }

    /// Returns the end of the itinerary, `end` metres along its last lane; `None` if the itinerary has no end.
    pub fn goal(&self, end: f64) -> Option<RoutePosition> {
        match self {
            Self::Lanes { lanes, circular: false, .. } => {
                lanes.last().map(|lane| RoutePosition { lane: *lane, s: end })
            }
            _ => None,
        }
    }

    /// Returns `true` if the car has no fixed route and may choose another way.
    pub fn is_free(&self) -> bool {
        matches!(self, Self::Wander(..))
    }
}
