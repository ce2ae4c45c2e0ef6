//! A driver whose controls a network gives.

use crate::Model;
use paracosm_engine::driver::{Driver, Equipment, Fault, FaultKind};
use paracosm_engine::sensor::{CameraSpec, Cameras, Image, Rig};
use paracosm_engine::{Briefing, Control, Observation};

/// The seconds between two images, and between two questions to the driver.
pub const PERIOD: f64 = 0.1;

/// A driver whose steering and throttle a neural network gives.
#[derive(Debug, Clone)]
pub struct Pilot {
    model: Model,
    newest: Option<Image>,
}

/// Returns the description of the camera of a neural driver, from the width and the height of its images in pixels.
pub fn camera(resolution: [u32; 2]) -> CameraSpec {
    CameraSpec {
        resolution,
        focal_mm: 24.0,
        sensor_mm: 36.0,
        position: [0.3, 0.0, 1.35],
        yaw_pitch_roll: [0.0, 2.0, 0.0],
        rate: 1.0 / PERIOD,
        ..CameraSpec::default()
    }
}

impl Pilot {
    /// Makes a driver from the neural network that gives the controls.
    pub fn new(model: Model) -> Self {
        Self { model, newest: None }
    }
}

impl Driver for Pilot {
    fn period(&self) -> f64 {
        PERIOD
    }

    fn equipment(&mut self) -> Equipment {
        let all = [("front".to_owned(), camera(self.model.resolution()))];
        Equipment {
            cameras: Cameras { look: self.model.look(), all: all.into(), ..Cameras::default() },
            ..Equipment::default()
        }
    }

    fn reset(&mut self, _: &Briefing) -> Result<(), Fault> {
        self.newest = None;
        Ok(())
    }

    fn perceive(&mut self, _: &Rig, images: &[Image]) -> Result<(), Fault> {
        if let Some(image) = images.last() {
            self.newest = Some(image.clone());
        }
        Ok(())
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        // Before the first image arrives the driver lets the car roll.
        let Some(image) = &self.newest else { return Ok(Control::default()) };
        let [steering, throttle] = self
            .model
            .answer(image, observation.speed)
            .map_err(|error| Fault::of(FaultKind::Answer, error.to_string()))?
            .map(f64::from);
        if !(steering.is_finite() && throttle.is_finite()) {
            let message =
                format!("the network's answer is steering {steering} and throttle {throttle}, expected finite numbers");
            return Err(Fault::of(FaultKind::Answer, message));
        }
        Ok(Control { throttle: throttle.clamp(-1.0, 1.0), steering: steering.clamp(-1.0, 1.0) })
    }
}
