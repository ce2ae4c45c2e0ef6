//! Traffic: cars that drive over the lanes of a road network and react to what is around them.
//!
//! [`Traffic`] is a simulation of its own, in lanes and metres along them, without physics and without streams. At
//! every step each car looks ahead (`ahead.rs`), follows the car ahead by the intelligent driver model ([`Idm`]),
//! claims the next intersection (`junction.rs`), perhaps changes lanes (`change.rs`), and moves on. All cars decide on
//! the state at the beginning of the step, so that their order does not matter unless they compete; then their indices
//! decide. The time of a step is proportional to the number of cars. A step allocates memory only if a car has to find
//! another way.
//!
//! Cars of up to 7 m by 2.3 m never touch one another. No car waits for ever, with one exception: if the roads around a
//! block are so full of cars that want to go round it that none of them has room to begin.
//!
//! ```
//! use paracosm_engine::road::grid_city;
//! use paracosm_engine::traffic::{Traffic, TrafficCar};
//!
//! let city = grid_city(4, 4, 80.0, 2).build()?;
//! let cars = TrafficCar::scattered(&city, 40, 1);
//! let mut traffic = Traffic::new(city, cars, 1)?;
//! for _ in 0..500 {
//!     traffic.step(0.02, &[]);
//! }
//! assert!(traffic.cars().all(|car| car.travelled > 1.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod ahead;
mod car;
mod change;
mod error;
mod idm;
mod junction;
mod lists;
mod map;
mod obstacle;
mod occupancy;
mod path;
mod state;

pub use car::TrafficCar;
pub use error::TrafficError;
pub use idm::Idm;
pub use obstacle::Obstacle;

use crate::road::{LaneId, RoadNetwork};
use ahead::{Ahead, View};
use junction::Asker;
use lists::Lists;
use map::Map;
use obstacle::Near;
use occupancy::{Body, Occupancy, Who};
use paracosm_road::{Pose, Side};
use state::{Car, Claim};
use std::sync::Arc;

/// The seconds between two decisions of a car about a lane change.
const THOUGHT: f64 = 1.0;

/// A simulation of cars that drive by themselves on a road network.
#[derive(Debug)]
pub struct Traffic {
    map: Map,
    cars: Vec<Car>,
    /// Half the width of the widest car in metres.
    half_width: f64,
    /// The friction coefficient between tyre and road; infinite at first.
    friction: f64,
    /// The seconds since the beginning.
    time: f64,
    /// The number of claims that were given so far.
    turns: u64,
    occupancy: Occupancy,
    claims: Lists<Claim>,
    /// The limits that each car has found ahead of it.
    ahead: Vec<Ahead>,
    askers: Vec<Asker>,
    asking: Lists<usize>,
    /// The lanes to which a car has begun to change in this step.
    changed: Vec<LaneId>,
    near: Near,
}

/// The present state of a car of the traffic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CarState {
    /// The position of the car's middle, and the car's heading.
    pub pose: Pose,
    /// The length of the car in metres.
    pub length: f64,
    /// The width of the car in metres.
    pub width: f64,
    /// The speed of the car in m/s.
    pub speed: f64,
    /// The acceleration of the car in m/s².
    pub acceleration: f64,
    /// The lane of the car; from the beginning of a lane change on, the new lane.
    pub lane: LaneId,
    /// The place of the car's middle, in metres along the car's lane.
    pub s: f64,
    /// The distance of the car from the middle of its lane in metres, positive to the left.
    pub offset: f64,
    /// The side to which the car is changing lanes; `None` if the car keeps its lane.
    pub indicator: Option<Side>,
    /// The distance in metres that the car has travelled.
    pub travelled: f64,
    /// `true` if the car has driven out of the network. Then it has no place.
    pub gone: bool,
}

impl Traffic {
    /// Puts cars on the lanes of a network. Their random choices follow from the seed and their indices.
    ///
    /// # Errors
    /// A value of a car is out of range, a route is not connected, or two cars overlap.
    pub fn new(network: Arc<RoadNetwork>, cars: Vec<TrafficCar>, seed: u64) -> Result<Self, TrafficError> {
        let map = Map::new(network);
        let cars: Vec<TrafficCar> = cars.into_iter().map(|car| car.planned(&map)).collect();
        cars.iter().enumerate().try_for_each(|(index, car)| car.check(index, &map))?;
        let (lanes, count) = (map.network.lanes().len(), cars.len());
        let cars: Vec<Car> = cars.iter().enumerate().map(|(index, car)| Car::new(car, index, seed)).collect();
        let half_width = cars.iter().map(|car| 0.5 * car.width).fold(0.0, f64::max);
        let mut traffic = Self {
            map,
            cars,
            half_width,
            friction: f64::INFINITY,
            time: 0.0,
            turns: 0,
            occupancy: Occupancy::new(lanes, count),
            claims: Lists::new(lanes, 4 * count),
            ahead: vec![Ahead::nothing(); count],
            askers: Vec::with_capacity(count),
            asking: Lists::new(lanes, 4 * count),
            changed: Vec::with_capacity(count),
            near: Near::default(),
        };
        traffic.see(&[]);
        traffic.refuse_overlaps()?;
        for car in &mut traffic.cars {
            car.extend_path(&traffic.map);
        }
        Ok(traffic)
    }

    /// Moves all cars on by `dt` seconds. `obstacles` are the bodies that are not part of the traffic.
    ///
    /// # Panics
    /// `dt` is not a finite number above 0.
    pub fn step(&mut self, dt: f64, obstacles: &[Obstacle]) {
        assert!(dt > 0.0 && dt.is_finite(), "a step takes {dt} s, expected more than 0");
        if self.time == 0.0 {
            self.claim_starts();
        }
        self.see(obstacles);
        self.look_ahead(dt);
        self.give_leave(dt);
        self.change_lanes(dt);
        for (car, ahead) in self.cars.iter_mut().zip(&self.ahead).filter(|(car, _)| !car.gone) {
            let lowest = (car.speed - car.braking * dt).max(0.0);
            let speed = match car.given {
                Some(given) if given <= ahead.safe => given,
                Some(_) => ahead.safe.max(lowest),
                None => (car.speed + ahead.acceleration.min(car.braking) * dt).min(ahead.safe).max(lowest),
            };
            car.drive(speed, dt, &self.map);
            if ahead.short {
                car.extend_path(&self.map);
            }
            car.give_up_change(dt, &self.map);
        }
        self.time += dt;
    }

    /// Returns the network that the cars drive on.
    pub fn network(&self) -> &Arc<RoadNetwork> {
        &self.map.network
    }

    /// Returns the present states of all cars, in the order in which the cars were given.
    pub fn cars(&self) -> impl ExactSizeIterator<Item = CarState> {
        (0..self.cars.len()).map(|index| self.car(index))
    }

    /// Returns the present poses of all cars; `None` for a car that has driven out of the network.
    pub(crate) fn poses(&self) -> impl Iterator<Item = Option<Pose>> {
        self.cars.iter().map(|car| (!car.gone).then(|| car.pose(&self.map)))
    }

    /// Returns the present state of the car with this index.
    ///
    /// # Panics
    /// There is no car with this index.
    pub fn car(&self, index: usize) -> CarState {
        let car = &self.cars[index];
        CarState {
            pose: car.pose(&self.map),
            length: 2.0 * car.half,
            width: car.width,
            speed: car.speed,
            acceleration: car.acceleration,
            lane: car.lane,
            s: car.s,
            offset: car.offset().0,
            indicator: car.change.map(|change| change.side),
            travelled: car.travelled,
            gone: car.gone,
        }
    }

    /// Sets the speed of a car in m/s from now on. The car deviates from it only to avoid a collision with a body
    /// ahead. With `None`, the model drives the car again.
    ///
    /// # Panics
    /// There is no car with this index, or the speed is not a finite number from 0 on.
    pub fn set_speed(&mut self, index: usize, speed: Option<f64>) {
        assert!(
            speed.is_none_or(|speed| speed >= 0.0 && speed.is_finite()),
            "the speed of car {index} is {speed:?} m/s, expected a finite number from 0 on"
        );
        self.cars[index].given = speed;
        self.cars[index].extend_path(&self.map);
    }

    /// Sets the present speed of a car in m/s at once, for the beginning of a run.
    ///
    /// # Panics
    /// There is no car with this index, or the speed is not a finite number from 0 on.
    pub fn begin_at(&mut self, index: usize, speed: f64) {
        assert!(speed >= 0.0 && speed.is_finite(), "initial speed of car {index}: {speed} m/s, expected 0 or more");
        self.cars[index].speed = speed;
    }

    /// Sets the friction coefficient between tyre and road, for all cars from the next step on. It limits their
    /// braking, which is at most 8 m/s²; they keep larger gaps and take bends more slowly accordingly. At first the
    /// road is dry. Cars that are already braking when the road gets slippery may stop too late. Values below 0.01
    /// count as 0.01.
    ///
    /// # Panics
    /// The friction is not a number from 0 on.
    pub fn set_friction(&mut self, friction: f64) {
        assert!(friction >= 0.0, "the friction of the road is {friction}, expected a number from 0 on");
        if self.friction != friction {
            self.friction = friction;
            self.cars.iter_mut().for_each(|car| car.set_friction(friction));
        }
    }

    /// Sets the speed in m/s at which a car wants to drive.
    ///
    /// # Panics
    /// There is no car with this index, or the speed is not a finite number from 0 on.
    pub fn set_desired_speed(&mut self, index: usize, speed: f64) {
        assert!(speed >= 0.0 && speed.is_finite(), "desired speed of car {index}: {speed} m/s, expected 0 or more");
        self.cars[index].desired = speed;
    }

    /// Makes a car begin a lane change that takes `duration` seconds, even if another car is in the way. Returns
    /// `false` if there is no lane on this side, the car is not on a road, or it is changing lanes already. A car with
    /// a route changes back when its route asks for it.
    ///
    /// # Panics
    /// There is no car with this index, or the duration is not a finite number above 0.
    pub fn change_lane(&mut self, index: usize, side: Side, duration: f64) -> bool {
        assert!(duration > 0.0 && duration.is_finite(), "lane change of car {index}: {duration} s, expected above 0");
        let car = &mut self.cars[index];
        let lane = self.map.network.lane(car.lane);
        let to = if side == Side::Left { lane.left } else { lane.right };
        let on_road = car.s + car.half < self.map.length(car.lane) || self.map.road_after(car.lane).is_some();
        match to.filter(|_| car.change.is_none() && !car.gone && on_road && self.map.is_road(car.lane)) {
            Some(to) => car.begin_change(side, to, duration, &self.map),
            None => return false,
        }
        true
    }

    fn view(&self) -> View<'_> {
        View { map: &self.map, cars: &self.cars, occupancy: &self.occupancy, claims: &self.claims }
    }

    /// Finds the bodies on every lane and the cars that have claims on it.
    fn see(&mut self, obstacles: &[Obstacle]) {
        let (map, cars) = (&self.map, &self.cars);
        self.occupancy.clear(|index, bodies| {
            let car = &cars[index as usize];
            if car.gone {
                return;
            }
            let body =
                |lane, s: f64, who| Body { lane, rear: s - car.half, front: s + car.half, speed: car.speed, who };
            bodies.push(body(car.lane, car.s, Who::Car(index)));
            if let Some(from) = car.change.and_then(|change| change.from) {
                bodies.push(body(from, map.across(car.s, car.lane, from), Who::Leaving(index)));
            }
        });
        for obstacle in obstacles {
            obstacle::place(obstacle, map, self.half_width, &mut self.near, self.occupancy.added());
        }
        self.occupancy.sort();
        self.claims.clear();
        for (index, car) in cars.iter().enumerate() {
            for claim in &car.claims {
                self.claims.add(claim.lane, index, *claim);
            }
        }
    }

    fn look_ahead(&mut self, dt: f64) {
        let mut all = std::mem::take(&mut self.ahead);
        let view = self.view();
        for (index, ahead) in all.iter_mut().enumerate() {
            if self.cars[index].gone {
                *ahead = Ahead::nothing();
            } else {
                view.look_ahead(index, dt, ahead);
            }
        }
        self.ahead = all;
    }

    fn change_lanes(&mut self, dt: f64) {
        self.changed.clear();
        for index in 0..self.cars.len() {
            if self.cars[index].gone || self.cars[index].next_thought > self.time {
                continue;
            }
            self.cars[index].next_thought += THOUGHT;
            let change = self.view().wanted_change(index, &self.ahead[index], dt);
            // One change at a time, because the second car has not seen the first.
            if let Some((side, to, duration)) = change.filter(|(_, to, _)| !self.changed.contains(to)) {
                self.cars[index].begin_change(side, to, duration, &self.map);
                self.changed.push(to);
            }
        }
    }

    /// Claims the lanes that a car stands on at the start, or before which it cannot stop.
    fn claim_starts(&mut self) {
        for car in &mut self.cars {
            // The car may have been given another speed.
            car.extend_path(&self.map);
            claim_start(car, &self.map, &mut self.turns);
        }
    }

    fn refuse_overlaps(&self) -> Result<(), TrafficError> {
        for (index, car) in self.cars.iter().enumerate() {
            let next = self.occupancy.ahead_of(index).first();
            if let Some((body, other)) = next.and_then(|body| Some((body, body.car()?)))
                && body.rear < car.s + car.half
            {
                return Err(TrafficError::Overlap { first: index.min(other), second: index.max(other) });
            }
        }
        Ok(())
    }
}

fn claim_start(car: &mut Car, map: &Map, turns: &mut u64) {
    let reach = car.half + 0.5 * car.speed * car.speed / car.braking;
    let mut base = -car.s;
    for k in 0..car.path.len() {
        let lane = car.path[k];
        let facts = map.lane(lane);
        let begins = base + facts.line.min(0.0);
        if begins > reach {
            return;
        }
        if !facts.rivals.is_empty() && base + facts.line <= reach {
            car.claims.push(Claim { lane, start: base, entry: base, turn: *turns, sure: true });
            *turns += 1;
        }
        base += facts.length;
    }
}
