//! Environment cars: [`Traffic`] as an object of a scenario, that minds the other objects and can be told what to do.

use crate::flaw::{Flaws, WorldFlaw};
use crate::geometry::{Pose, Side};
use crate::object::{Body, Class, Geometric, Input, InputError, Output, Outputs, Tick, Wiring};
use crate::scenario::{Place, Scenario, Streets};
use crate::stream::{Datum, Stream};
use crate::traffic::{CarState, Obstacle, Traffic, TrafficCar};
use nalgebra::Vector2;
use std::cell::RefCell;
use std::rc::Rc;

/// Cars that drive by themselves over the roads of a scenario, not placed yet.
#[derive(Debug, Clone)]
pub struct EnvironmentCars {
    streets: Streets,
    cars: Vec<TrafficCar>,
    /// How many of them there are to be, the first ones.
    most: usize,
    seed: u64,
}

/// Placed environment cars: what can be read of them, and what they can be told. Cars are counted from 0, in the order in
/// which they were given.
#[derive(Debug, Clone)]
pub struct Fleet {
    name: String,
    count: usize,
    /// Whether it has begun: why it has not has been reported.
    sound: bool,
    wiring: Wiring,
    flaws: Flaws,
    told: Rc<RefCell<Told>>,
}

/// What the program has asked of the cars.
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
    /// Absent: it drives as it likes.
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
    /// These cars on these roads.
    pub fn on(streets: &Streets, cars: Vec<TrafficCar>) -> Self {
        Self { streets: streets.clone(), cars, most: usize::MAX, seed: 1 }
    }

    /// So many cars at places that chance chooses: [`TrafficCar::scattered`]. Where there is no room for them there are
    /// fewer: [`Fleet::count`].
    pub fn scattered(streets: &Streets, count: usize, seed: u64) -> Self {
        let cars = streets.network().map(|network| TrafficCar::scattered(network, usize::MAX, seed));
        Self { seed, most: count, ..Self::on(streets, cars.unwrap_or_default()) }
    }

    /// Without those that would start within so many metres of a place. Scattered cars start elsewhere instead, given
    /// ones are left out.
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

    /// Where all that they do by chance comes from.
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
        // A network that cannot be built has been reported.
        let Some(network) = self.streets.network() else { return fleet };
        let colours: Vec<_> = self.cars.iter().map(|car| car.colour).collect();
        match Traffic::new(network.clone(), self.cars, self.seed) {
            Ok(traffic) => {
                for (car, colour) in traffic.cars().zip(colours) {
                    let body = body(&car);
                    draft.body(body.coloured(colour.unwrap_or(body.colour)), car.pose);
                }
                draft.geometric(Driving { traffic, obstacles: Vec::new(), told });
                fleet.sound = true;
            }
            Err(error) => draft.flaw(error.into()),
        }
        fleet
    }
}

/// What a car of the traffic is to others, by its size.
fn body(car: &CarState) -> Body {
    let usual = match (car.length, car.width) {
        (length, _) if length > 7.0 => Body::truck(),
        (_, width) if width < 1.0 => Body::bicycle(),
        _ => Body::car(),
    };
    Body::block(usual.class, car.length, car.width, usual.height)
}

/// To ask for a car that is not there is a mistake that is reported when the world is built.
impl Fleet {
    /// How many cars there are: perhaps fewer than were asked for, where there is no room for more.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Where the middle of a car is. One that has left the network is where it was last seen.
    pub fn position(&self, car: usize) -> Stream<Vector2<f64>> {
        self.show(car, "position", Shown::Position)
    }

    /// The speed of a car in m/s. One that has left the network has the speed at which it did.
    pub fn speed(&self, car: usize) -> Stream<f64> {
        self.show(car, "speed", Shown::Speed)
    }

    /// Gives a car this speed in m/s, which it leaves only so as not to run into what is ahead; at ticks at which the
    /// stream is absent it drives as it likes.
    pub fn drive(&self, car: usize, speed: impl Into<Stream<f64>>) {
        self.order(car, "speed", &speed.into(), Order::Speed);
    }

    /// Sets the speed in m/s at which a car drives where nothing hinders it.
    pub fn wish(&self, car: usize, speed: impl Into<Stream<f64>>) {
        self.order(car, "desired_speed", &speed.into(), Order::Wish);
    }

    /// Lets a car change to the lane beside, within so many seconds, whoever is there, when the event occurs and there is
    /// such a lane. A time that is no finite number above 0 is a mistake that is reported when the world is built.
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

    /// Whether there is such a car; it is a mistake where there is not.
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
        for (pose, car) in poses.iter_mut().zip(self.traffic.cars()) {
            *pose = (!car.gone).then_some(car.pose);
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
        // What stands beside the roads is nothing to stop for.
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
