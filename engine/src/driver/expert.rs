//! The driver `expert`: it keeps its way and its distance, and stops for people on the road. It is told the ground
//! truth. Networks learn from it, so its controls depend only on facts that one image and the speed show.
//!
//! Behind a car it takes up the speed that its gap allows, in proportion to the gap (the optimal velocity model: Bando,
//! Hasebe, Nakayama, Shibata, Sugiyama, "Dynamical model of traffic congestion and numerical simulation", Phys. Rev. E
//! 51, 1995). A time headway of 1.5 s and a relaxation of 1.5 /s leave a damping ratio of 0.75, so that it hardly
//! overshoots. It need not know the other car's speed, which an image does not show. It stops for a person who walks on
//! the road ahead or onto it, or stands in the way: it brakes evenly, and holds the brakes while it stands. If a
//! walking person is too near to stop, it goes on, because it is then best to pass first.

use super::cruise::{Cruise, PERIOD};
use super::frenet::Frenet;
use super::{Descriptor, Driver, Fault, Settings};
use crate::object::Class;
use crate::observation::{Briefing, Control, Observation, Other};
use std::cell::LazyCell;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    name: "expert",
    about: "keeps its way and its distance, and stops for people; knows the ground truth, so that networks can learn from it",
    settings: &[],
    make: |_: &Settings| Box::new(Expert::default()),
};

/// The gap in metres that the driver keeps when all stand.
const STANDSTILL: f64 = 5.0;
/// The time headway in seconds that the driver keeps in addition.
const HEADWAY: f64 = 1.5;
/// The acceleration per m/s of difference between the allowed speed and the present speed, in 1/s.
const RELAXATION: f64 = 1.5;
/// The room that the driver wants beside the car, in metres.
const MARGIN: f64 = 0.3;
/// The lateral range of the road from the driver's way, in metres: the driver stops for people who walk in it.
const ROAD: (f64, f64) = (-2.0, 5.3);
/// The seconds of prediction: a person who will be on the road by then counts as on it now.
const SOON: f64 = 1.0;
/// The speed in m/s from which on a person counts as walking.
const WALKING: f64 = 0.1;
/// The even deceleration for people, in m/s².
const EVENLY: f64 = 5.0;
/// The greatest deceleration that the driver plans with, in m/s². If a walking person would need more, it goes on.
const HARDEST: f64 = 7.0;
/// The greatest deceleration that the driver asks for, in m/s².
const BRAKES: f64 = 9.0;

#[derive(Debug, Default)]
struct Expert {
    cruise: Cruise,
    half_length: f64,
    half_width: f64,
}

impl Expert {
    /// Returns the speed in m/s that a body allows. `None` if the body does not concern the driver.
    fn allowed(&self, body: &Other, speed: f64) -> Option<f64> {
        let half = body.half_extent();
        let gap = body.position.x - half.x - self.half_length;
        let in_the_way = body.position.y.abs() < half.y + self.half_width + MARGIN;
        if body.position.x < 0.0 {
            return None;
        }
        match body.class {
            Class::Pedestrian => {
                let walks = body.velocity.norm() > WALKING;
                let road = ROAD.0..=ROAD.1;
                let on_the_road =
                    walks && [0.0, SOON].iter().any(|t| road.contains(&(body.position.y + t * body.velocity.y)));
                let needed = speed * speed / (2.0 * gap.max(0.1));
                let concerns = in_the_way || on_the_road && needed <= HARDEST;
                // The car still moves on while it takes up a speed, so that distance is not left for braking.
                let room = gap - STANDSTILL - speed / RELAXATION;
                // If the person is nearer than that, the driver holds the brakes, the harder the nearer.
                concerns.then(|| (2.0 * EVENLY * room.abs()).sqrt().copysign(room))
            }
            Class::Building | Class::Tree | Class::Sign => None,
            _ => in_the_way.then(|| (gap - STANDSTILL).max(0.0) / HEADWAY),
        }
    }
}

impl Driver for Expert {
    fn period(&self) -> f64 {
        PERIOD
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        self.half_length = 0.5 * briefing.vehicle.length;
        self.half_width = 0.5 * briefing.vehicle.width;
        self.cruise.reset(briefing)
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        let way = LazyCell::new(|| Frenet::of(observation));
        let speed = observation.speed;
        let allowed = observation.others.iter().filter_map(|body| self.allowed(&way.straightened(body, 0.0), speed));
        let held_back = allowed.map(|allowed| RELAXATION * (allowed - speed)).fold(f64::INFINITY, f64::min);
        let acceleration = self.cruise.acceleration(observation).min(held_back).max(-BRAKES);
        Ok(self.cruise.control(acceleration, observation))
    }
}
