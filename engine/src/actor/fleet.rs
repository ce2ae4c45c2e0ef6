//! Environment cars: [`Traffic`] as an object of a scenario, which reacts to other objects and can be controlled.

use crate::flaw::{Flaws, WorldFlaw};
use crate::object::{Class, Geometric, Input, InputError, Output, Outputs, Tick, Wiring};
use crate::scenario::{Place, Scenario, Streets};
use crate::stream::{Datum, Stream};
use crate::traffic::{Obstacle, Traffic, TrafficCar};
use nalgebra::Vector2;
use paracosm_road::{Pose, Side};
use std::cell::RefCell;
use std::rc::Rc;

/// Cars that drive by themselves over the roads of a scenario. They are not placed yet.
#[derive(Debug, Clone)]
pub struct EnvironmentCars {
    streets: Streets,
    cars: Vec<TrafficCar>,
    /// The greatest number of cars to place; the first ones are placed.
    most: usize,
    seed: u64,
}

/// The handle of placed environment cars, with their outputs and their inputs. Cars are counted from 0, in the order in
/// which they were given.
#[derive(Debug, Clone)]
pub struct Fleet {
    name: String,
    count: usize,
    /// `true` if the traffic has begun. Otherwise, the reason has been reported.
    sound: bool,
    wiring: Wiring,
    flaws: Flaws,
    told: Rc<RefCell<Told>>,
}

/// The outputs that the program reads, and the orders that it gives to the cars.
#[derive(Debug, Default)]
struct Told {
    shown: Vec<(usize, Shown)>,
    orders: Vec<(usize, Order)>,
}

#[derive(Debug)]
enum Shown {
    Position(Output<Vector2<f64>>),
    Speed(Output<f64>),
}

#[derive(Debug)]
enum Order {
    /// The speed of a car. While the stream is absent, the car drives by its model.
    Speed(Input<f64>),
    Wish(Input<f64>),
    Change(Side, f64, Input<bool>),
}

struct Driving {
    traffic: Traffic,
    obstacles: Vec<Obstacle>,
    told: Rc<RefCell<Told>>,
}

impl EnvironmentCars {
    /// Puts the given cars on the roads of a scenario.
    pub fn on(streets: &Streets, cars: Vec<TrafficCar>) -> Self {
        Self { streets: streets.clone(), cars, most: usize::MAX, seed: 1 }
    }

    /// Puts `count` cars at random places on the roads by [`TrafficCar::scattered`], or fewer cars if the room is too
    /// small. [`Fleet::count`] gives the number.
    pub fn scattered(streets: &Streets, count: usize, seed: u64) -> Self {
        let cars = streets.network().map(|network| TrafficCar::scattered(network, usize::MAX, seed));
        Self { seed, most: count, ..Self::on(streets, cars.unwrap_or_default()) }
    }

    /// Removes cars that would start within `metres` metres of a place. Scattered cars start elsewhere instead; given
    /// cars are left out.
    pub fn away_from(mut self, place: Vector2<f64>, metres: f64) -> Self {
        if let Some(network) = self.streets.network() {
            let far = |car: &TrafficCar| {
                let start = car.start();
                (network.lane(start.lane).curve.point(start.s) - place).norm() > metres
            };
            self.cars.retain(far);
        }
        self
    }

    /// Sets the seed of all random choices of the cars.
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }
}

impl Place for EnvironmentCars {
    type Handle = Fleet;

    fn place(mut self, scenario: &mut Scenario) -> Fleet {
        self.cars.truncate(self.most);
        let (wiring, flaws) = (scenario.wiring.clone(), scenario.flaws.clone());
        let mut draft = scenario.object("traffic");
        let told = Rc::<RefCell<Told>>::default();
        let (name, count) = (draft.name().to_owned(), self.cars.len());
        let mut fleet = Fleet { name, count, sound: false, wiring, flaws, told: told.clone() };
        // The mistake in a network that cannot be built has been reported already.
        let Some(network) = self.streets.network() else { return fleet };
        let bodies: Vec<_> = self.cars.iter().map(|car| car.body).collect();
        match Traffic::new(network.clone(), self.cars, self.seed) {
            Ok(traffic) => {
                for (car, body) in traffic.cars().zip(bodies) {
                    draft.body(body, car.pose);
                }
                draft.geometric(Driving { traffic, obstacles: Vec::new(), told });
                fleet.sound = true;
            }
            Err(error) => draft.flaw(error.into()),
        }
        fleet
    }
}

/// If a program asks for a car that does not exist, the mistake is reported when the world is built.
impl Fleet {
    /// Returns the number of placed cars. It is smaller than the number asked for if there was not enough room.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns a stream of the position of a car's middle. A car that has left the network keeps its last position.
    pub fn position(&self, car: usize) -> Stream<Vector2<f64>> {
        self.show(car, "position", Shown::Position)
    }

    /// Returns a stream of the speed of a car in m/s. A car that has left the network keeps its last speed.
    pub fn speed(&self, car: usize) -> Stream<f64> {
        self.show(car, "speed", Shown::Speed)
    }

    /// Sets the speed of a car in m/s. The car deviates from this speed only to avoid a collision with a body ahead. At
    /// ticks at which the stream is absent, the car drives by its model.
    pub fn drive(&self, car: usize, speed: impl Into<Stream<f64>>) {
        self.order(car, "speed", &speed.into(), Order::Speed);
    }

    /// Sets the speed in m/s at which a car drives on a free road.
    pub fn wish(&self, car: usize, speed: impl Into<Stream<f64>>) {
        self.order(car, "desired_speed", &speed.into(), Order::Wish);
    }

    /// Makes a car change to the next lane on a given side within `seconds` seconds when an event occurs, even if other
    /// cars are there. Without such a lane the car keeps its lane. A time that is not a finite number above 0 is
    /// reported as a mistake when the world is built.
    pub fn change_lane(&self, car: usize, side: Side, seconds: f64, event: &Stream<bool>) {
        if seconds > 0.0 && seconds.is_finite() {
            self.order(car, "change_lane", event, |event| Order::Change(side, seconds, event));
        } else {
            self.flaws.borrow_mut().push(WorldFlaw::LaneChange { traffic: self.name.clone(), car, seconds });
        }
    }

    fn show<T: Datum>(&self, car: usize, what: &str, shown: impl FnOnce(Output<T>) -> Shown) -> Stream<T> {
        if !self.has(car) {
            return Stream::absent();
        }
        let output = self.wiring.output(&format!("{}[{car}].{what}", self.name));
        let stream = output.stream();
        self.told.borrow_mut().shown.push((car, shown(output)));
        stream
    }

    fn order<T: Datum>(&self, car: usize, what: &str, by: &Stream<T>, order: impl FnOnce(Input<T>) -> Order) {
        if self.has(car) {
            let input = self.wiring.input(&format!("{}[{car}].{what}", self.name), by);
            self.told.borrow_mut().orders.push((car, order(input)));
        }
    }

    /// Returns `true` if the car exists; otherwise, it reports a mistake.
    fn has(&self, car: usize) -> bool {
        if self.sound && car >= self.count {
            let traffic = self.name.clone();
            self.flaws.borrow_mut().push(WorldFlaw::NoCar { traffic, car, count: self.count });
        }
        self.sound && car < self.count
    }
}

impl Driving {
    fn obey(&mut self, tick: &Tick<'_>) -> Result<(), InputError> {
        for (car, order) in &self.told.borrow().orders {
            match order {
                Order::Speed(input) => {
                    let speed = tick.get(input).map(|_| tick.speed(input)).transpose()?;
                    self.traffic.set_speed(*car, speed);
                }
                Order::Wish(input) => self.traffic.set_desired_speed(*car, tick.speed(input)?),
                Order::Change(side, seconds, event) => {
                    if tick.get(event) == Some(true) {
                        self.traffic.change_lane(*car, *side, *seconds);
                    }
                }
            }
        }
        Ok(())
    }
}

impl Geometric for Driving {
    fn poses(&self, poses: &mut [Option<Pose>]) {
        for (slot, pose) in poses.iter_mut().zip(self.traffic.poses()) {
            *slot = pose;
        }
    }

    fn begin(&mut self, tick: &Tick<'_>, velocities: &mut [Vector2<f64>]) -> Result<(), InputError> {
        for (car, order) in &self.told.borrow().orders {
            if let Order::Speed(input) = order
                && tick.get(input).is_some()
            {
                self.traffic.begin_at(*car, tick.speed(input)?);
            }
        }
        for (velocity, car) in velocities.iter_mut().zip(self.traffic.cars()) {
            *velocity = car.pose.forward() * car.speed;
        }
        Ok(())
    }

    fn show(&self, outputs: &mut Outputs<'_>) {
        for (car, shown) in &self.told.borrow().shown {
            let state = self.traffic.car(*car);
            match shown {
                Shown::Position(output) => outputs.set(output, state.pose.position),
                Shown::Speed(output) => outputs.set(output, state.speed),
            }
        }
    }

    fn step(&mut self, tick: &Tick<'_>) -> Result<(), InputError> {
        self.obey(tick)?;
        // Objects beside the roads are no obstacles.
        let in_the_way = |class| !matches!(class, Class::Building | Class::Tree | Class::Sign);
        self.obstacles.clear();
        self.obstacles.extend(tick.others().filter(|other| in_the_way(other.body.class)).map(|other| {
            let half = other.body.outline.half_extent();
            Obstacle { pose: other.pose, length: 2.0 * half.x, width: 2.0 * half.y, velocity: other.velocity }
        }));
        self.traffic.set_friction(tick.friction());
        self.traffic.step(tick.dt(), &self.obstacles);
        Ok(())
    }
}
