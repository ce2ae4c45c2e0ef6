//! Lets a braking model drive a whole simulated car: it fills in the [`Situation`] from the observation, brakes as hard as
//! the most worried copy of the model asks for, and otherwise holds the car's speed.

use super::super::Driver;
use super::super::cruise::Cruise;
use crate::kinematic::{BrakingModel, DT, Situation};
use crate::observation::{Briefing, Control, Observation, Other};

/// A braking model at the wheel.
#[derive(Debug)]
pub(super) struct Reference<M> {
    fresh: M,
    /// What it makes of each of the others.
    watched: Vec<Watched<M>>,
    cruise: Cruise,
    length: f64,
    width: f64,
    /// The car's speed in m/s at the last question.
    speed: Option<f64>,
}

#[derive(Debug)]
struct Watched<M> {
    model: M,
    /// Speed along the lane in m/s at the last question.
    speed: Option<f64>,
}

impl<M: BrakingModel + 'static> Reference<M> {
    /// The driver of a car that brakes as copies of this model ask for.
    pub fn boxed(fresh: M) -> Box<dyn Driver> {
        Box::new(Self { fresh, watched: Vec::new(), cruise: Cruise::default(), length: 0.0, width: 0.0, speed: None })
    }

    /// A body that is turned counts with the box along the lane that encloses it.
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
}

impl<M: BrakingModel + 'static> Driver for Reference<M> {
    fn period(&self) -> f64 {
        DT
    }

    fn reset(&mut self, briefing: &Briefing) {
        self.cruise.reset(briefing);
        self.watched.clear();
        self.length = briefing.vehicle.length;
        self.width = briefing.vehicle.width;
        self.speed = None;
    }

    fn step(&mut self, observation: &Observation) -> Control {
        let fresh = &self.fresh;
        let bodies = observation.others.iter().map(|other| other.id + 1).max().unwrap_or(0);
        self.watched.resize_with(bodies.max(self.watched.len()), || Watched { model: fresh.clone(), speed: None });
        let mut brake = 0.0_f64;
        for other in &observation.others {
            let situation = self.situation(observation.speed, other, self.watched[other.id].speed);
            let watched = &mut self.watched[other.id];
            watched.speed = Some(other.velocity.x);
            brake = brake.max(watched.model.brake(&situation, DT));
        }
        self.speed = Some(observation.speed);
        if brake > 0.0 {
            return self.cruise.control(-brake, observation);
        }
        self.cruise.control(self.cruise.acceleration(observation), observation)
    }
}
