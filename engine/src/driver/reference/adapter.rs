//! Lets a braking model drive a whole simulated car: it fills in the [`Situation`] from the observation, brakes as hard as
//! the most worried copy of the model asks for, and otherwise holds the car's speed.
//!
//! In the kinematic world a car that has braked never takes up speed again. Here it goes on when the way is free, and until
//! then it comes no nearer by its own doing: it takes up no more speed than that of whomever it has braked for and who is
//! still in its way. The models themselves ask nothing of a car that is no faster than the other.
//!
//! Gaps and distances across the lane are measured [along the way](super::super::frenet). The truth is of what can be seen:
//! another is not there before the line from the car's front to its middle has once been free of large bodies, and from then
//! on is known, as in the kinematic world. There a cut-out uncovers what stands behind it when it has left its wandering zone,
//! 0.375 m aside; here when it is half of its width aside, about 0.9 m.

use super::super::cruise::Cruise;
use super::super::frenet::Frenet;
use super::super::perception::hidden;
use super::super::{Driver, Fault};
use crate::kinematic::{BrakingModel, DT, Situation};
use crate::observation::{Briefing, Control, Observation, Other};

/// Seconds within which whoever comes over sideways counts as in the way.
const COMES_OVER: f64 = 3.0;
/// Seconds within which the car, at the speed that it is to keep, would come up with whomever it holds back for.
const COMES_UP: f64 = 10.0;

/// A braking model at the wheel.
#[derive(Debug)]
pub(super) struct Reference<M> {
    fresh: M,
    /// What it makes of each of the others.
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
    /// Whether the car has braked for it, and it has been in the way ever since.
    braked_for: bool,
    /// Speed along the lane in m/s at the last question.
    speed: Option<f64>,
}

impl<M: BrakingModel + 'static> Reference<M> {
    /// The driver of a car that brakes as copies of this model ask for.
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

    /// Whether the car, if it took up its speed, would soon come up with one that is in its way or comes into it.
    fn holds_back(&self, s: &Situation) -> bool {
        let in_the_way = s.is_ahead() && (s.overlaps() || s.clearance() < COMES_OVER * s.approach);
        in_the_way && s.gap < COMES_UP * (self.cruise_speed - s.other_speed)
    }
}

/// The strongest acceleration in m/s² with which the car gets no faster than the other.
fn up_to_its_speed(s: &Situation) -> f64 {
    // The missing speed in a second.
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
        let way = Frenet::of(observation);
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
