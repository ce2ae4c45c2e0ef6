//! The world in which the published models were compared: explicit Euler, ten steps per second, cars of 4.3 m x 1.9 m.
//!
//! Everything here is written anew from a description of that world. Positions are those of the middles of the cars. A
//! car moves with the speed that it has after the step.

use paracosm_engine::kinematic::{BrakingModel, DT, Situation};

/// The length of each car, in metres.
pub const LENGTH: f64 = 4.3;
/// The width of each car, in metres.
pub const WIDTH: f64 = 1.9;
/// The length in metres of the car that a leader uncovers: the published set-up leaves it at its default.
const STANDING_LENGTH: f64 = 5.0;
/// The steps of an encounter, from the moment on at which a car that cuts in has its full lateral speed.
const STEPS: usize = 350;
/// The acceleration of gravity in m/s² by which the decelerations of the leaders are given.
const G: f64 = 9.81;

/// The state of the other car at one step.
#[derive(Clone, Copy)]
struct Other {
    x: f64,
    speed: f64,
    acceleration: f64,
    y: f64,
    lateral_speed: f64,
    length: f64,
}

/// Drives the ego vehicle past another car, whose states are given step by step. `None` means that the ego vehicle cannot
/// see it. Returns whether they collide before `ends` says that the encounter is over, and the last step.
fn drive<M: BrakingModel>(
    mut model: M,
    speed: f64,
    start: f64,
    others: impl Iterator<Item = Option<Other>>,
    ends: impl Fn(&Situation) -> bool,
) -> (bool, usize) {
    let (mut x, mut speed, mut acceleration) = (start, speed, 0.0);
    let mut steps = 0;
    for (i, other) in others.enumerate() {
        steps = i;
        let mut brake = 0.0;
        if let Some(other) = other {
            let lengths = LENGTH + other.length;
            let situation = Situation {
                speed,
                acceleration,
                gap: other.x - x - 0.5 * lengths,
                other_speed: other.speed,
                other_acceleration: other.acceleration,
                lateral: other.y.abs(),
                approach: -other.lateral_speed * 1.0_f64.copysign(other.y),
                width: WIDTH,
                other_width: WIDTH,
                lengths,
            };
            if situation.overlaps() && situation.gap < 0.0 && situation.gap > -lengths {
                return (true, i);
            }
            if ends(&situation) {
                break;
            }
            brake = model.brake(&situation, DT);
        }
        let next = (speed - brake * DT).max(0.0);
        acceleration = (next - speed) / DT;
        speed = next;
        x += speed * DT;
    }
    (false, steps)
}

/// A car that cuts in: speeds in m/s, `gap` in metres at the moment at which it has its full lateral speed.
#[derive(Clone, Copy)]
pub struct CutIn {
    pub speed: f64,
    pub other_speed: f64,
    pub gap: f64,
    pub lateral_speed: f64,
}

impl CutIn {
    /// Returns the grid of a pair of speeds in km/h: 1,062 cases at low speeds, 1,080 at high ones.
    pub fn grid(ego_kph: u32, other_kph: u32) -> Vec<Self> {
        let gaps: Vec<u32> = if ego_kph > 60 { (1..120).step_by(2).collect() } else { (1..60).collect() };
        let [speed, other_speed] = [ego_kph, other_kph].map(|kph| f64::from(kph) / 3.6);
        let at = |gap: u32, tenths: u32| {
            let (gap, lateral_speed) = (f64::from(gap), f64::from(tenths) * 0.1);
            Self { speed, other_speed, gap, lateral_speed }
        };
        gaps.iter().flat_map(|gap| (0..18).map(move |tenths| at(*gap, tenths))).collect()
    }

    /// Returns `true` if a driver collides. `dropping` is the time to collision at overlap beyond which the case is
    /// dropped and counts as no collision.
    pub fn collides<M: BrakingModel>(&self, model: M, dropping: f64) -> bool {
        // The lateral speed rises with 1.5 m/s², and the car is 1.6 m beside the ego vehicle when it is reached.
        let rise = (self.lateral_speed / 0.15).ceil() as usize;
        let lateral_speed = |i: usize| if i < rise { 0.15 * i as f64 } else { self.lateral_speed };
        let beside = 1.6 + WIDTH;
        let moving =
            rise + if self.lateral_speed > 0.0 { (10.0 * beside / self.lateral_speed) as usize + 1 } else { 0 };
        let mut y = beside + (0..rise).map(|i| lateral_speed(i) * DT).sum::<f64>();
        let begins = -(rise as f64) * DT;
        let others = (0..STEPS + rise).map(|i| {
            let lateral_speed = if i <= moving { lateral_speed(i) } else { 0.0 };
            let x = LENGTH + self.gap + self.other_speed * (begins + i as f64 * DT);
            let other = Other {
                x,
                speed: self.other_speed,
                acceleration: 0.0,
                y,
                lateral_speed: -lateral_speed,
                length: LENGTH,
            };
            if i < moving {
                y -= lateral_speed * DT;
            }
            Some(other)
        });
        let late = |s: &Situation| s.gap >= -LENGTH && s.clearance() <= 0.0 && (s.gap / s.closing()).abs() > dropping;
        drive(model, self.speed, self.speed * begins, others, late).0
    }
}

/// A leader, 2 s ahead, that leaves the lane and uncovers a standing car.
#[derive(Clone, Copy)]
pub struct CutOut {
    pub speed: f64,
    /// The distance in metres from the leader's front to the standing car.
    pub distance: f64,
    pub lateral_speed: f64,
}

impl CutOut {
    /// Returns the cases at 60 to 130 km/h .
    pub fn grid() -> Vec<Self> {
        let mut all = Vec::new();
        for kph in (60..=130).step_by(10) {
            for distance in (2..=147).step_by(5) {
                for tenths in (1..30).step_by(2) {
                    let (speed, lateral_speed) = (f64::from(kph) / 3.6, f64::from(tenths) * 0.1);
                    all.push(Self { speed, distance: f64::from(distance), lateral_speed });
                }
            }
        }
        all
    }

    fn leader_collides_by(&self, last: usize) -> bool {
        (1..=last).any(|step| {
            let time = step as f64 * DT;
            let apart = self.distance + LENGTH - self.speed * time;
            self.lateral_speed * time < WIDTH && apart.abs() < 0.5 * (LENGTH + STANDING_LENGTH)
        })
    }

    /// `None` if the leader runs into the standing car itself before the ego vehicle stands or collides.
    pub fn collides<M: BrakingModel>(&self, model: M) -> Option<bool> {
        let x = 2.0 * self.speed + self.distance + 2.0 * LENGTH;
        let standing = Other { x, speed: 0.0, acceleration: 0.0, y: 0.0, lateral_speed: 0.0, length: STANDING_LENGTH };
        // The standing car is in sight when the leader has left the zone in which cars wander.
        let seen = |step: usize| self.lateral_speed * step as f64 * DT > 0.375;
        let others = (1..STEPS).map(|step| seen(step).then_some(standing));
        let (collides, last) = drive(model, self.speed, self.speed * DT, others, |s| s.speed == 0.0);
        (!self.leader_collides_by(last + 1)).then_some(collides)
    }
}

/// A leader, 2 s ahead, that brakes to standstill.
#[derive(Clone, Copy)]
pub struct Following {
    pub speed: f64,
    pub deceleration: f64,
}

impl Following {
    /// Returns the 1,121 cases: 12 to 128 km/h, decelerations of 0.05 to 0.95 g.
    pub fn grid() -> Vec<Self> {
        let speeds = (12..130).step_by(2);
        let at = |kph: u32, twentieths: u32| Self {
            speed: f64::from(kph) / 3.6,
            deceleration: f64::from(twentieths) * 0.05 * G,
        };
        speeds.flat_map(|kph| (1..20).map(move |twentieths| at(kph, twentieths))).collect()
    }

    pub fn collides<M: BrakingModel>(&self, model: M) -> bool {
        let mut x = LENGTH + 2.0 * self.speed;
        let others = (0..STEPS - 1).map(|i| {
            let speed = (self.speed - self.deceleration * DT * i as f64).max(0.0);
            x += speed * DT;
            let acceleration = if speed > 0.0 { -self.deceleration } else { 0.0 };
            Some(Other { x, speed, acceleration, y: 0.0, lateral_speed: 0.0, length: LENGTH })
        });
        drive(model, self.speed, self.speed * DT, others, |s| s.speed == 0.0).0
    }
}
