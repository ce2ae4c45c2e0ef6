//! The driver `aeb`: cruise control with autonomous emergency braking for pedestrians.
//!
//! Twenty times a second the driver looks through a modelled sensor ([`perception`](super::perception)). It predicts
//! that the car and every detected body go on as they do now [along the way](super::frenet). It brakes if the two paths
//! meet within its time to collision. The brake builds up and lets go at a limited jerk. Once it brakes, it looks
//! further ahead than before and goes on until nothing has been in the way for a while. So it does not let go in front
//! of a person who is still crossing. Then it takes up its speed again.
//!
//! The sources of the numbers:
//!
//! | setting | source |
//! | --- | --- |
//! | deceleration 9 m/s² | what the tyres of a car hold on dry asphalt, some 0.9 g; UN R152 asks an emergency brake for at least 5 m/s², the careful and competent driver of UN R157 brakes with 7.6 m/s² |
//! | ttc 1.6 s | chosen later than the 2 s at which the driver of UN R157 perceives a risk, since a system that brakes for every risk is switched off by its owner |
//! | jerk 30 m/s³ | chosen between the 12.65 m/s³ of UN R157's human driver and a step: full brakes in 0.3 s |
//! | latency 0.5 s | chosen: from light to brake demand, through detection, confirmation over some frames and fusion; 0.35 s and 0.75 s are the reaction times of UN R157's models |
//! | range 60 m, field of view 60° | chosen for one forward camera: at 60 km/h the range is 3.6 s ahead, and the angle loses a person 1 m beside the car when the bumper is 3.1 m away |
//! | noise 0.1 m, samples 8, margin 0.3 m | chosen: 8 detections in 0.4 s give a walking speed to 0.3 m/s (one standard deviation), so that a person who stands beside the road seldom looks like one who walks onto it |
//! | clear_ttc 3 s, release 0.5 s | chosen so that the brake is not let go in front of a person who is still crossing |
//!
//! A study can vary the defaults, above all those without a source: `--set driver.NAME=VALUE`.

use super::cruise::{Cruise, PERIOD};
use super::frenet::Frenet;
use super::perception::{Perception, Sensor, Track};
use super::{Descriptor, Driver, Fault, Setting, Settings, setting, whole};
use crate::observation::{Briefing, Control, Observation, Other};
use std::cell::LazyCell;

pub(super) const DESCRIPTOR: Descriptor = Descriptor {
    name: "aeb",
    about: "keeps its speed and its way, and brakes for bodies that it sees on its path",
    settings: &SETTINGS,
    make: |settings| Box::new(Aeb::new(settings)),
};

const SETTINGS: [Setting; 12] = [
    setting("range", 60.0, "m", (0.0, 500.0), "greatest distance at which the sensor sees"),
    setting("field_of_view", 60.0, "deg", (0.0, 360.0), "opening angle of the sensor"),
    setting("noise", 0.1, "m", (0.0, 10.0), "standard deviation of a detected position, each coordinate"),
    setting("latency", 0.5, "s", (0.0, 5.0), "delay of every frame"),
    whole("samples", 8.0, (3.0, 100.0), "number of detections from which a motion is estimated"),
    setting("ttc", 1.6, "s", (0.0, 10.0), "time to collision at which the driver brakes"),
    setting("clear_ttc", 3.0, "s", (0.0, 30.0), "time to collision above which the way is clear again"),
    setting("release", 0.5, "s", (0.0, 10.0), "how long the way must be clear before the brake lets go"),
    setting("deceleration", 9.0, "m/s^2", (0.0, 20.0), "deceleration that the driver asks for"),
    setting("jerk", 30.0, "m/s^3", (1.0, 1000.0), "rate at which the deceleration changes"),
    setting("margin", 0.3, "m", (0.0, 5.0), "room that the driver wants beside the car"),
    whole("seed", 1.0, (0.0, 4294967295.0), "seed of the noise, which is the same in every test"),
];

/// The speed in m/s that the driver assumes for a slow or standing car when it judges whether the way is clear.
const CREEP: f64 = 3.0;

struct Aeb {
    cruise: Cruise,
    perception: Perception,
    ttc: f64,
    clear_ttc: f64,
    release: f64,
    deceleration: f64,
    jerk: f64,
    margin: f64,
    half_length: f64,
    half_width: f64,
    braking: bool,
    /// The present brake demand in m/s².
    brake: f64,
    /// The time at which the way was last seen blocked, in seconds.
    blocked: f64,
}

impl Aeb {
    fn new(settings: &Settings) -> Self {
        let sensor = Sensor {
            range: settings.get("range"),
            field_of_view: settings.get("field_of_view").to_radians(),
            noise: settings.get("noise"),
            latency: settings.get("latency"),
            samples: settings.get("samples") as usize,
            period: PERIOD,
            seed: settings.get("seed") as u64,
        };
        Self {
            cruise: Cruise::default(),
            perception: Perception::new(sensor),
            ttc: settings.get("ttc"),
            clear_ttc: settings.get("clear_ttc"),
            release: settings.get("release"),
            deceleration: settings.get("deceleration"),
            jerk: settings.get("jerk"),
            margin: settings.get("margin"),
            half_length: 0.0,
            half_width: 0.0,
            braking: false,
            brake: 0.0,
            blocked: 0.0,
        }
    }

    /// Returns the seconds until the car at this speed meets a body if both keep their motion, `None` if never.
    fn time_to_collision(&self, body: &Other, speed: f64) -> Option<f64> {
        let half_extent = body.half_extent();
        let side = self.half_width + half_extent.y + self.margin;
        let end = self.half_length + half_extent.x;
        let beside = while_between(body.position.y, body.velocity.y, -side, side)?;
        let along = while_between(body.position.x, body.velocity.x - speed, -end, end)?;
        let meeting = beside.0.max(along.0);
        (meeting <= beside.1.min(along.1)).then_some(meeting)
    }
}

/// Returns the first and the last time, from 0 on, at which `x + v t` is between two values.
fn while_between(x: f64, v: f64, lo: f64, hi: f64) -> Option<(f64, f64)> {
    if v == 0.0 {
        return (lo..=hi).contains(&x).then_some((0.0, f64::INFINITY));
    }
    let (a, b) = ((lo - x) / v, (hi - x) / v);
    let (from, to) = (a.min(b).max(0.0), a.max(b));
    (from <= to).then_some((from, to))
}

impl Driver for Aeb {
    fn period(&self) -> f64 {
        PERIOD
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        self.cruise.reset(briefing)?;
        self.perception.reset();
        self.half_length = 0.5 * briefing.vehicle.length;
        self.half_width = 0.5 * briefing.vehicle.width;
        self.braking = false;
        self.brake = 0.0;
        self.blocked = 0.0;
        Ok(())
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        self.perception.see(observation, self.half_length);
        let (horizon, speed) =
            if self.braking { (self.clear_ttc, observation.speed.max(CREEP)) } else { (self.ttc, observation.speed) };
        // Mostly there is nobody in sight, and then the way does not matter.
        let way = LazyCell::new(|| Frenet::of(observation));
        let ahead = |track: Track| {
            let ttc = self.time_to_collision(&way.straightened(&track.body, track.age), speed);
            ttc.is_some_and(|ttc| ttc <= horizon)
        };
        if self.perception.tracks(observation).any(ahead) {
            self.braking = true;
            self.blocked = observation.time;
        } else if observation.time - self.blocked > self.release {
            self.braking = false;
        }
        let change = self.jerk * PERIOD;
        let wanted = if self.braking { self.deceleration } else { 0.0 };
        self.brake = wanted.clamp(self.brake - change, self.brake + change);
        if self.brake > 0.0 {
            return Ok(self.cruise.control(-self.brake, observation));
        }
        self.cruise.step(observation)
    }
}
