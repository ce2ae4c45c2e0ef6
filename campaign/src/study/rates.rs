//! Checks that cameras are not faster than the ticks of a scenario.

use super::Simulation;
use crate::Reason;
use paracosm_engine::sensor::Cameras;
use thiserror::Error;

/// The tolerance for rates, because periods are rounded.
const WHISKER: f64 = 1e-9;

/// A camera takes more images a second than the simulation has ticks.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("camera `{camera}`: `rate` is {rate} Hz, expected at most {} Hz: a tick of `{scenario}` takes {dt} s", 1.0 / dt)]
pub struct RateFlaw {
    /// The name of the camera that is too fast.
    pub camera: String,
    /// The number of images that the camera takes in a second.
    pub rate: f64,
    /// The name of the scenario.
    pub scenario: String,
    /// The duration of a tick of the scenario, in seconds.
    pub dt: f64,
}

impl Reason for RateFlaw {}

impl Simulation {
    /// Checks that no camera takes more images a second than the scenario has ticks.
    ///
    /// # Errors
    /// A camera is too fast.
    pub fn check_rates(&self, cameras: &Cameras) -> Result<(), RateFlaw> {
        let dt = self.dt();
        match cameras.all.iter().find(|(_, camera)| camera.rate * dt > 1.0 + WHISKER) {
            None => Ok(()),
            Some((name, camera)) => {
                let scenario = self.scenario().to_owned();
                Err(RateFlaw { camera: name.clone(), rate: camera.rate, scenario, dt })
            }
        }
    }
}
