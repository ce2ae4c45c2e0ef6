//! Lets a braking model drive a whole simulated car. The adapter fills in the [`Situation`] from the observation for a
//! copy of the model per body, brakes as hard as any copy asks for, and otherwise holds the car's speed.
//!
//! In the kinematic world a car that has braked never takes up speed again. Here the car goes on when the way is free.
//! While a body that it has braked for is in its way, the car takes up no more speed than that body has, so it does not
//! come nearer by its own doing. The models themselves ask nothing of a car that is no faster than the other.
//!
//! Gaps and lateral distances are measured [along the way](super::super::frenet). The driver ignores a body until the
//! line from the car's front to the body's middle has been free of large bodies once. From then on the driver knows the
//! body's true state, as in the kinematic world. A cut-out uncovers a standing body later than there: when it is half
//! of its width aside, about 0.9 m, and not when it has left its wandering zone, 0.375 m aside.

use super::super::cruise::Cruise;
use super::super::frenet::Frenet;
use super::super::perception::hidden;
use super::super::{Driver, Fault};
use crate::kinematic::{BrakingModel, DT, Situation};
use crate::observation::{Briefing, Control, Observation, Other};
use std::cell::LazyCell;

/// The seconds within which a body that comes over sideways counts as in the way.
const COMES_OVER: f64 = 3.0;
/// The seconds within which the car, at the speed that it is to keep, would reach the body that it holds back for.
const COMES_UP: f64 = 10.0;

/// A braking model that drives a simulated car.
#[derive(Debug)]
pub(super) struct Reference<M> {
    fresh: M,
    /// The copy of the model for each of the other bodies.
    watched: Vec<Watched<M>>,
    cruise: Cruise,
    cruise_speed: f64,
    length: f64,
    width: f64,
    /// The car's speed in m/s at the last question.
    speed: Option<f64>,
}

#[derive(Debug, Clone)]
struct Watched<M> {
    model: M,
    seen: bool,
    /// True if the car has braked for the body and the body has been in the way ever since.
    braked_for: bool,
    /// The body's speed along the lane in m/s at the last question.
    speed: Option<f64>,
}

impl<M: BrakingModel + 'static> Reference<M> {
    /// Makes a driver that brakes as copies of the given model demand.
    pub fn boxed(fresh: M) -> Box<dyn Driver> {
        Box::new(Self {
            fresh,
            watched: Vec::new(),
            cruise: Cruise::default(),
            cruise_speed: 0.0,
            length: 0.0,
            width: 0.0,
            speed: None,
        })
    }

    /// Returns the situation of the car and a body. A turned body counts as the box along the lane that encloses it.
    fn situation(&self, speed: f64, other: &Other, other_speed_before: Option<f64>) -> Situation {
        let (along, across) = (2.0 * other.half_extent().x, 2.0 * other.half_extent().y);
        let rate = |now: f64, before: Option<f64>| before.map_or(0.0, |before| (now - before) / DT);
        Situation {
            speed,
            acceleration: rate(speed, self.speed),
            gap: other.position.x - 0.5 * (self.length + along),
            other_speed: other.velocity.x,
            other_acceleration: rate(other.velocity.x, other_speed_before),
            lateral: other.position.y.abs(),
            approach: -other.velocity.y * 1.0_f64.copysign(other.position.y),
            width: self.width,
            other_width: across,
            lengths: self.length + along,
        }
    }

    /// Returns `true` if the car, at its set speed, would soon reach a body that is in its way or comes into it.
    fn holds_back(&self, s: &Situation) -> bool {
        let in_the_way = s.is_ahead() && (s.overlaps() || s.clearance() < COMES_OVER * s.approach);
        in_the_way && s.gap < COMES_UP * (self.cruise_speed - s.other_speed)
    }
}

/// Returns the strongest acceleration in m/s² with which the car gets no faster than the other body.
fn up_to_its_speed(s: &Situation) -> f64 {
    // The car makes up the missing speed in a second.
    (s.other_speed - s.speed).max(0.0)
}

impl<M: BrakingModel + 'static> Driver for Reference<M> {
    fn period(&self) -> f64 {
        DT
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        self.cruise.reset(briefing)?;
        self.cruise_speed = briefing.cruise_speed;
        self.watched.clear();
        self.length = briefing.vehicle.length;
        self.width = briefing.vehicle.width;
        self.speed = None;
        Ok(())
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        let unknown = Watched { model: self.fresh.clone(), seen: false, braked_for: false, speed: None };
        let bodies = observation.others.iter().map(|other| other.id + 1).max().unwrap_or(0);
        self.watched.resize(bodies.max(self.watched.len()), unknown);
        let way = LazyCell::new(|| Frenet::of(observation));
        let mut brake = 0.0_f64;
        let mut limit = f64::INFINITY;
        for other in &observation.others {
            let seen = self.watched[other.id].seen || !hidden(other, observation, 0.5 * self.length);
            if !seen {
                continue;
            }
            let other = way.straightened(other, 0.0);
            let situation = self.situation(observation.speed, &other, self.watched[other.id].speed);
            let holds_back = self.holds_back(&situation);
            let watched = &mut self.watched[other.id];
            let wanted = watched.model.brake(&situation, DT);
            watched.seen = true;
            watched.speed = Some(other.velocity.x);
            watched.braked_for = holds_back && (watched.braked_for || wanted > 0.0);
            if watched.braked_for {
                limit = limit.min(up_to_its_speed(&situation));
            }
            brake = brake.max(wanted);
        }
        self.speed = Some(observation.speed);
        if brake > 0.0 {
            return Ok(self.cruise.control(-brake, observation));
        }
        Ok(self.cruise.control(self.cruise.acceleration(observation).min(limit), observation))
    }
}
