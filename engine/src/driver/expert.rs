//! The driver `expert`: keeps its way, keeps its distance, and stops for people on the road. It is told the truth, and is
//! there for networks to learn from, so that what it does depends on nothing but what one image and the speed tell.
//!
//! Behind a car it takes up the speed that its gap allows, the gap in proportion to the speed (the optimal velocity model:
//! Bando, Hasebe, Nakayama, Shibata, Sugiyama, "Dynamical model of traffic congestion and numerical simulation", Phys. Rev.
//! E 51, 1995). A time headway of 1.5 s and a relaxation of 1.5 /s leave a damping ratio of 0.75, so that it hardly
//! overshoots; how fast the other one is, which an image does not show, it need not know. For a person who walks on the
//! road ahead, or onto it, or stands in the way it stops, braking evenly, and holds the brakes while it stands. If they are
//! too near to stop at all, the best is to be past before them.

use super::cruise::{Cruise, PERIOD};
use super::frenet::Frenet;
use super::{Descriptor, Driver, Fault, Settings};
use crate::object::Class;
use crate::observation::{Briefing, Control, Observation, Other};

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    name: "expert",
    about: "keeps its way, its distance and people alive, knowing the truth: whom to learn from",
    settings: &[],
    make: |_: &Settings| Box::new(Expert::default()),
};

/// Metres it keeps where all stand.
const STANDSTILL: f64 = 5.0;
/// Seconds of its speed it keeps beside.
const HEADWAY: f64 = 1.5;
/// Acceleration per m/s of speed that the gap allows and it has not, in 1/s.
const RELAXATION: f64 = 1.5;
/// Room it wants beside the car, in metres.
const MARGIN: f64 = 0.3;
/// How far to the left and right of its way the road goes, in metres, on which it lets nobody walk.
const ROAD: (f64, f64) = (-2.0, 5.3);
/// Who is on the road in so many seconds counts as on it now.
const SOON: f64 = 1.0;
/// From this speed in m/s on a person walks.
const WALKING: f64 = 0.1;
/// How it slows down for people, in m/s².
const EVENLY: f64 = 5.0;
/// What it expects of the brakes, in m/s²: for whom it would take more it goes on.
const HARDEST: f64 = 7.0;
/// What it asks of the brakes at most, in m/s².
const BRAKES: f64 = 9.0;

#[derive(Debug, Default)]
struct Expert {
    cruise: Cruise,
    half_length: f64,
    half_width: f64,
}

impl Expert {
    /// The speed in m/s that a body allows.
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
                // What it covers while it takes up a speed is not there any more to brake in.
                let room = gap - STANDSTILL - speed / RELAXATION;
                // Nearer than it wants to stand it holds the brakes, the harder the nearer.
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
        let way = Frenet::of(observation);
        let speed = observation.speed;
        let allowed = observation.others.iter().filter_map(|body| self.allowed(&way.straightened(body, 0.0), speed));
        let held_back = allowed.map(|allowed| RELAXATION * (allowed - speed)).fold(f64::INFINITY, f64::min);
        let acceleration = self.cruise.acceleration(observation).min(held_back).max(-BRAKES);
        Ok(self.cruise.control(acceleration, observation))
    }
}
