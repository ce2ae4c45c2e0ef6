//! An encounter, from its beginning until a collision, until no collision is possible any more, or until its end.

use super::course::{Course, Place, Size};
use super::situation::Situation;
use super::{BrakingModel, DT};

/// An encounter of the ego vehicle with other road users, with the ego vehicle in the middle of its lane.
#[derive(Debug, Clone, PartialEq)]
pub struct Encounter {
    /// The speed of the ego vehicle in m/s until it brakes.
    pub speed: f64,
    /// The length and width of the ego vehicle.
    pub size: Size,
    /// The motions of the other road users, as courses.
    pub others: Vec<Course>,
    /// The duration of the encounter in seconds.
    pub duration: f64,
}

/// The result of an encounter of the ego vehicle with other road users.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ended {
    /// The collision that ended the encounter; `None` if the encounter ended without a collision.
    pub collision: Option<Collision>,
    /// The smallest time to collision in seconds with a road user in the ego vehicle's path. It is infinite if there
    /// was no such road user, and 0 at a collision with the ego vehicle's front.
    pub least_ttc: f64,
    /// The smallest gap in metres to a road user ahead in the ego vehicle's path. It is infinite if there was no such
    /// road user, and 0 at a collision with the ego vehicle's front.
    pub least_gap: f64,
}

/// A collision of the ego vehicle with another road user.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Collision {
    /// The time of the collision in seconds since the beginning, computed with constant speeds between two steps.
    pub time: f64,
    /// The difference of the speeds of both road users along the lane, in m/s.
    pub speed: f64,
    /// The side of the ego vehicle that was hit in the collision.
    pub face: Impact,
}

/// The side of the ego vehicle that was hit in a collision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Impact {
    /// The ego vehicle ran into the other road user, or both overlapped from the beginning.
    Front,
    /// The other road user moved into the side of the ego vehicle.
    Side,
    /// The other road user ran into the ego vehicle from behind.
    Rear,
}

/// The state of the ego vehicle.
#[derive(Debug, Clone, Copy)]
struct Ego {
    /// The position of the front bumper, in metres along the lane.
    front: f64,
    speed: f64,
    /// The acceleration over the last step, in m/s².
    acceleration: f64,
}

impl Ego {
    /// Returns the state after a step with constant deceleration, which ends at standstill.
    fn after(self, brake: f64) -> Self {
        let speed = self.speed - brake * DT;
        let (speed, way) = if speed < 0.0 {
            (0.0, 0.5 * self.speed * self.speed / brake)
        } else {
            (speed, 0.5 * (self.speed + speed) * DT)
        };
        Self { front: self.front + way, speed, acceleration: (speed - self.speed) / DT }
    }
}

/// The distances of two road users along and across the lane.
#[derive(Debug, Clone, Copy)]
struct Apart {
    gap: f64,
    lengths: f64,
    clearance: f64,
    closing: f64,
}

impl Apart {
    fn of(s: &Situation) -> Self {
        Self { gap: s.gap, lengths: s.lengths, clearance: s.clearance(), closing: s.closing() }
    }
}

impl Encounter {
    /// Returns the result of the encounter with a given driver in the ego vehicle. A copy of the driver watches each of
    /// the other road users. The car brakes as hard as the copy that asks for most, and never accelerates again.
    pub fn run<M: BrakingModel>(&self, driver: &M) -> Ended {
        let mut models = vec![driver.clone(); self.others.len()];
        let mut before: Vec<Option<Apart>> = vec![None; self.others.len()];
        let mut ego = Ego { front: 0.0, speed: self.speed, acceleration: 0.0 };
        let mut ended = Ended { collision: None, least_ttc: f64::INFINITY, least_gap: f64::INFINITY };
        for tick in 0..=(self.duration / DT).round() as usize {
            let time = tick as f64 * DT;
            let mut brake = 0.0_f64;
            let mut settled = true;
            for ((course, model), before) in self.others.iter().zip(&mut models).zip(&mut before) {
                let place = course.at(time);
                let situation = self.situation(&ego, &place, course.size);
                if situation.overlaps() && situation.is_ahead() {
                    ended.least_gap = ended.least_gap.min(situation.gap);
                    ended.least_ttc = ended.least_ttc.min(situation.time_to_collision());
                }
                let now = Apart::of(&situation);
                if let Some(collision) = collision(before.unwrap_or(now), now, time) {
                    ended.collision = Some(collision.no_later_than(ended.collision));
                }
                *before = Some(now);
                settled &= place.settled && situation.is_ahead() && situation.closing() <= 0.0;
                if time >= course.visible_from {
                    brake = brake.max(model.brake(&situation, DT));
                }
            }
            // If all others are ahead and continue so, none comes nearer to a car that never accelerates.
            if settled || ended.collision.is_some() {
                break;
            }
            ego = ego.after(brake);
        }
        if ended.collision.is_some_and(|collision| collision.face == Impact::Front) {
            ended.least_ttc = 0.0;
            ended.least_gap = 0.0;
        }
        ended
    }

    fn situation(&self, ego: &Ego, other: &Place, size: Size) -> Situation {
        Situation {
            speed: ego.speed,
            acceleration: ego.acceleration,
            gap: other.rear - ego.front,
            other_speed: other.speed,
            other_acceleration: other.acceleration,
            lateral: other.lateral,
            approach: other.approach,
            width: self.size.width,
            other_width: size.width,
            lengths: self.size.length + size.length,
        }
    }
}

/// Returns the part of a step, between 0 and 1, in which a straight line from one value to another is negative.
fn negative(from: f64, to: f64) -> Option<(f64, f64)> {
    let crossing = from / (from - to);
    match (from < 0.0, to < 0.0) {
        (true, true) => Some((0.0, 1.0)),
        (true, false) => Some((0.0, crossing)),
        (false, true) => Some((crossing, 1.0)),
        (false, false) => None,
    }
}

/// Returns the contact in the step that ends at `time`. A corner may touch for less than a step, between its two ends.
fn collision(before: Apart, now: Apart, time: f64) -> Option<Collision> {
    let reached = negative(before.gap, now.gap)?;
    let not_passed = negative(-before.lengths - before.gap, -now.lengths - now.gap)?;
    let beside = negative(before.clearance, now.clearance)?;
    let share = reached.0.max(not_passed.0).max(beside.0);
    if share >= reached.1.min(not_passed.1).min(beside.1) {
        return None;
    }
    let face = if share == reached.0 {
        Impact::Front
    } else if share == beside.0 {
        Impact::Side
    } else {
        Impact::Rear
    };
    let closing = before.closing + share * (now.closing - before.closing);
    Some(Collision { time: (time - DT * (1.0 - share)).max(0.0), speed: closing.abs(), face })
}

impl Collision {
    fn no_later_than(self, known: Option<Self>) -> Self {
        known.filter(|known| known.time <= self.time).unwrap_or(self)
    }
}
