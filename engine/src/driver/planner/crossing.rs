//! Finds the road users in the way of the car, and those who come into it.
//!
//! Positions count [along the way](super::super::frenet). Everybody is expected to keep the present velocity. A road
//! user who comes over counts as in the way, unless the car passes before or the road user has gone by when the car
//! arrives.

use super::super::Settings;
use super::super::frenet::Frenet;
use crate::object::Class;
use crate::observation::{Briefing, Observation, Other};

/// The spare seconds with which the car passes before a road user, and after one.
const BEFORE: f64 = 0.3;
const AFTER: f64 = 0.5;

/// The room ahead of the car, up to a road user in the way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Room {
    /// The gap from the car's front to the road user, in metres.
    pub gap: f64,
    /// The speed of the road user along the way, in m/s.
    pub speed: f64,
}

/// The part of the driver that looks for road users in the way.
#[derive(Debug)]
pub(super) struct Crossing {
    horizon: f64,
    margin: f64,
    /// The deceleration in m/s² with which the car can come to rest at most.
    braking: f64,
    half_length: f64,
    half_width: f64,
}

impl Crossing {
    pub fn new(settings: &Settings) -> Self {
        Self {
            horizon: settings.get("horizon"),
            margin: settings.get("margin"),
            braking: settings.get("braking"),
            half_length: 0.0,
            half_width: 0.0,
        }
    }

    pub fn reset(&mut self, briefing: &Briefing) {
        self.half_length = 0.5 * briefing.vehicle.length;
        self.half_width = 0.5 * briefing.vehicle.width;
    }

    /// Returns the room up to each of the given bodies that is in the way.
    pub fn rooms(&self, observation: &Observation, bodies: &[Other]) -> impl Iterator<Item = Room> {
        let way = Frenet::of(observation);
        let road_users =
            bodies.iter().filter(|body| !matches!(body.class, Class::Building | Class::Tree | Class::Sign));
        road_users.filter_map(move |body| self.room(&way.straightened(body, 0.0), observation.speed))
    }

    /// Returns the room up to a body; `None` if the body does not get in the way.
    fn room(&self, body: &Other, speed: f64) -> Option<Room> {
        let half = body.half_extent();
        let (along, across) = (body.position.x, body.position.y.abs());
        if along < 0.0 {
            return None;
        }
        let gap = along - half.x - self.half_length;
        let room = Room { gap, speed: body.velocity.x };
        let reach = half.y + self.half_width + self.margin;
        let approach = -body.velocity.y * body.position.y.signum();
        if approach <= 0.0 {
            return (across < reach).then_some(room);
        }
        let (enters, leaves) = (((across - reach) / approach).max(0.0), (across + reach) / approach);
        let closing = speed - body.velocity.x;
        if enters > self.horizon {
            return None;
        }
        // The times at which the car comes to the body and has passed it.
        let (comes, passed) = if closing > 0.0 {
            ((gap / closing).max(0.0), (gap + 2.0 * (half.x + self.half_length)) / closing)
        } else {
            (if gap > 0.0 { f64::INFINITY } else { 0.0 }, f64::INFINITY)
        };
        // If the car can no longer stop, it goes on if it just passes before.
        let stops = gap > 0.5 * closing * closing.abs() / self.braking;
        let before = if stops { enters - BEFORE } else { enters + self.margin / approach };
        let clear = passed < before || comes > leaves + AFTER;
        (!clear).then_some(room)
    }
}
