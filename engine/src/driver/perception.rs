//! What a driver believes of the bodies around it: a modelled camera or radar, instead of a rendered one.
//!
//! Each frame shows the middle of every body that is in range, in the field of view and not behind something large
//! (a car, a lorry, a house), with noise, and reaches the
//! driver only after the latency of the sensor's processing; that holds for every frame, so that the driver
//! lives in the past all the time and not only until the first detection. Positions are kept as seen from where
//! the car began, which it knows from its own odometry; a straight line through the last few of them by least
//! squares gives position and velocity now.

use crate::chance::gaussian;
use crate::geometry::Pose;
use crate::object::crosses;
use crate::observation::{Observation, Other};
use crate::sensor::hides;
use nalgebra::Vector2;
use rand::SeedableRng;
use rand_pcg::Pcg64;
use std::collections::VecDeque;

/// How good the sensor is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sensor {
    /// Metres up to which it sees.
    pub range: f64,
    /// Opening angle in radians.
    pub field_of_view: f64,
    /// Standard deviation of each coordinate of a position, in metres.
    pub noise: f64,
    /// Seconds from what happens to when the driver knows.
    pub latency: f64,
    /// How many detections a track is fitted to.
    pub samples: usize,
    /// Seconds between two frames.
    pub period: f64,
    /// Where the noise begins.
    pub seed: u64,
}

/// Seconds after which the last of a body that went out of sight is no longer acted on.
const OUT_OF_SIGHT: f64 = 0.5;
/// Fewest detections that give a velocity worth acting on.
const FEWEST: usize = 3;

/// A body as the driver believes it to be now, if it has gone straight on since it was seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Track {
    /// The body.
    pub body: Other,
    /// How long ago it was seen, in seconds: the mean of the detections.
    pub age: f64,
}

/// A position that was seen, from where the car began.
#[derive(Debug, Clone, Copy)]
struct Detection {
    time: f64,
    position: Vector2<f64>,
}

/// The memory of the sensor.
#[derive(Debug)]
pub(super) struct Perception {
    sensor: Sensor,
    random: Pcg64,
    /// Of each body, what has been seen, the last first forgotten; the newest the driver does not know yet.
    seen: Vec<VecDeque<Detection>>,
}

impl Perception {
    pub fn new(sensor: Sensor) -> Self {
        Self { sensor, random: Pcg64::seed_from_u64(sensor.seed), seen: Vec::new() }
    }

    /// Forgets everything, the state of the noise included: every run of a test sees the same noise.
    pub fn reset(&mut self) {
        *self = Self::new(self.sensor);
    }

    /// Takes a frame; `front` is the distance in metres from the car's middle to the sensor at its front.
    pub fn see(&mut self, observation: &Observation, front: f64) {
        let bodies = observation.others.iter().map(|body| body.id + 1).max().unwrap_or(0);
        self.seen.resize_with(bodies.max(self.seen.len()), VecDeque::new);
        let half_angle = 0.5 * self.sensor.field_of_view;
        let oldest = observation.time - self.memory();
        for body in &observation.others {
            let seen = &mut self.seen[body.id];
            let from_sensor = body.position - Vector2::new(front, 0.0);
            let bearing = libm::atan2(from_sensor.y, from_sensor.x).abs();
            // Drawn for every frame, so that what is out of sight does not shift the noise of what is seen later.
            let noise = gaussian(&mut self.random) * self.sensor.noise;
            let visible = from_sensor.norm() <= self.sensor.range && bearing <= half_angle;
            if visible && !hidden(body, observation, front) {
                let odometry = observation.odometry;
                let position = odometry.position + odometry.turn_to_plane(body.position + noise);
                seen.push_back(Detection { time: observation.time, position });
            }
            while seen.front().is_some_and(|detection| detection.time < oldest) {
                seen.pop_front();
            }
        }
    }

    /// Seconds after which a detection is forgotten.
    fn memory(&self) -> f64 {
        self.sensor.latency + OUT_OF_SIGHT + self.sensor.period * self.sensor.samples as f64
    }

    /// What the driver believes at the time of the last frame.
    pub fn tracks<'a>(&'a self, observation: &'a Observation) -> impl Iterator<Item = Track> + 'a {
        observation.others.iter().filter_map(|body| {
            let seen = &self.seen[body.id];
            // A whisker more than the latency, because times are sums of ticks.
            let known = observation.time - self.sensor.latency + 1e-9;
            let count = seen.iter().take_while(|detection| detection.time <= known).count();
            let fitted = seen.iter().take(count).skip(count.saturating_sub(self.sensor.samples));
            let (position, velocity, age) = fit(fitted, observation.time)?;
            let odometry = observation.odometry;
            let (position, velocity) = (odometry.to_local(position), odometry.turn_to_local(velocity));
            Some(Track { body: Other { position, velocity, ..*body }, age })
        })
    }
}

/// Whether something large stands between the middle of a body and the car's front, which is `front` metres from the car's
/// middle.
pub(super) fn hidden(body: &Other, observation: &Observation, front: f64) -> bool {
    let sensor = Vector2::new(front, 0.0);
    let large = |other: &&Other| hides(other.class);
    observation.others.iter().filter(|other| other.id != body.id).filter(large).any(|other| {
        let pose = Pose { position: other.position, heading: other.heading };
        crosses((&other.outline, &pose), sensor, body.position)
    })
}

/// The straight line through the detections by least squares: position at `now`, velocity, and the detections' mean age.
fn fit<'a>(
    detections: impl ExactSizeIterator<Item = &'a Detection> + Clone,
    now: f64,
) -> Option<(Vector2<f64>, Vector2<f64>, f64)> {
    let n = detections.len();
    if n < FEWEST {
        return None;
    }
    let mean_time = detections.clone().map(|d| d.time).sum::<f64>() / n as f64;
    let mean_position = detections.clone().map(|d| d.position).sum::<Vector2<f64>>() / n as f64;
    let mut spread = 0.0;
    let mut along = Vector2::zeros();
    for detection in detections {
        let t = detection.time - mean_time;
        spread += t * t;
        along += (detection.position - mean_position) * t;
    }
    let velocity = along / spread;
    let age = now - mean_time;
    Some((mean_position + velocity * age, velocity, age))
}
