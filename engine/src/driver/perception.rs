//! A model of a camera or radar that gives a driver its estimates of the bodies around it, without rendering.
//!
//! Each frame shows the middle of every body that is in range, in the field of view and not behind something large (a
//! car, a lorry, a house), with noise. The latency of the sensor's processing delays every frame, so the driver always
//! lives in the past, not only until the first detection. Positions are kept as seen from where the car began, which
//! the driver knows from its own odometry. A straight line through the last few positions by least squares gives the
//! present position and velocity.

use crate::chance::gaussian;
use crate::object::crosses;
use crate::observation::{Observation, Other};
use crate::sensor::hides;
use nalgebra::Vector2;
use paracosm_road::Pose;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use std::collections::VecDeque;

/// The accuracy and the limits of a modelled sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sensor {
    /// The greatest distance at which the sensor sees, in metres.
    pub range: f64,
    /// The opening angle of the sensor in radians.
    pub field_of_view: f64,
    /// The standard deviation of each coordinate of a detected position, in metres.
    pub noise: f64,
    /// The delay in seconds until the driver knows of a detection.
    pub latency: f64,
    /// The greatest number of detections from which a track is estimated.
    pub samples: usize,
    /// The seconds between two frames.
    pub period: f64,
    /// The seed of the sensor's noise.
    pub seed: u64,
}

/// The seconds after which the driver ignores a body that went out of sight.
const OUT_OF_SIGHT: f64 = 0.5;
/// The fewest detections that give a usable velocity.
const FEWEST: usize = 3;

/// The driver's estimate of a body's present state, if the body has gone straight on since its detections.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Track {
    /// The body with estimated position and velocity.
    pub body: Other,
    /// The mean age in seconds of the detections behind the estimate.
    pub age: f64,
}

/// A position that was seen, from where the car began.
#[derive(Debug, Clone, Copy)]
struct Detection {
    time: f64,
    position: Vector2<f64>,
}

/// A modelled sensor with its memory of detections.
#[derive(Debug)]
pub(super) struct Perception {
    sensor: Sensor,
    random: Pcg64,
    /// The detections of each body, the oldest first. The driver does not know the newest detections yet.
    seen: Vec<VecDeque<Detection>>,
}

impl Perception {
    pub fn new(sensor: Sensor) -> Self {
        Self { sensor, random: Pcg64::seed_from_u64(sensor.seed), seen: Vec::new() }
    }

    /// Forgets all detections and restarts the noise, so that every run of a test sees the same noise.
    pub fn reset(&mut self) {
        *self = Self::new(self.sensor);
    }

    /// Takes a frame of an observation, with the distance `front` in metres from the car's middle to the sensor.
    pub fn see(&mut self, observation: &Observation, front: f64) {
        let bodies = observation.others.iter().map(|body| body.id + 1).max().unwrap_or(0);
        self.seen.resize_with(bodies.max(self.seen.len()), VecDeque::new);
        let half_angle = 0.5 * self.sensor.field_of_view;
        let oldest = observation.time - self.memory();
        for body in &observation.others {
            let seen = &mut self.seen[body.id];
            let from_sensor = body.position - Vector2::new(front, 0.0);
            let bearing = || libm::atan2(from_sensor.y, from_sensor.x).abs();
            // Drawn for every body in every frame: a body out of sight does not change the noise of later detections.
            let drawn = [self.random.random(), self.random.random()];
            let visible = from_sensor.norm() <= self.sensor.range && bearing() <= half_angle;
            if visible && !hidden(body, observation, front) {
                let noise = gaussian(drawn) * self.sensor.noise;
                let odometry = observation.odometry;
                let position = odometry.position + odometry.turn_to_plane(body.position + noise);
                seen.push_back(Detection { time: observation.time, position });
            }
            while seen.front().is_some_and(|detection| detection.time < oldest) {
                seen.pop_front();
            }
        }
    }

    /// Returns the seconds after which a detection is forgotten.
    fn memory(&self) -> f64 {
        self.sensor.latency + OUT_OF_SIGHT + self.sensor.period * self.sensor.samples as f64
    }

    /// Returns the driver's estimates of the bodies at the time of the last frame.
    pub fn tracks<'a>(&'a self, observation: &'a Observation) -> impl Iterator<Item = Track> + 'a {
        observation.others.iter().filter_map(|body| {
            let seen = &self.seen[body.id];
            // A little more than the latency, because times are sums of ticks.
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

/// Returns `true` if a large body stands between the middle of a body and the car's front, which is `front` metres from
/// the car's middle.
pub fn hidden(body: &Other, observation: &Observation, front: f64) -> bool {
    let sensor = Vector2::new(front, 0.0);
    let large = |other: &&Other| hides(other.class);
    observation.others.iter().filter(|other| other.id != body.id).filter(large).any(|other| {
        let pose = Pose { position: other.position, heading: other.heading };
        crosses((&other.outline, &pose), sensor, body.position)
    })
}

/// Fits a straight line by least squares. Returns the position at `now`, the velocity, and the detections' mean age.
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
