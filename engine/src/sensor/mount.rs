//! The mounting of a sensor on the car.

use super::error::{Checks, SensorError};
use crate::vehicle::VehicleState;
use nalgebra::{Vector2, Vector3};
use paracosm_road::Pose;

/// The position and the heading of an upright sensor on a car.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mount {
    /// The position of the sensor in metres from the car's middle on the ground (x ahead, y to the left, z up).
    pub position: Vector3<f64>,
    /// The direction of the sensor, in radians counter-clockwise from the car's heading.
    pub heading: f64,
}

impl Mount {
    /// Makes the mounting of a sensor that looks ahead from `height` metres above the ground at the car's middle.
    pub fn above(height: f64) -> Self {
        Self { position: Vector3::new(0.0, 0.0, height), heading: 0.0 }
    }

    /// Makes the mounting of a sensor that looks ahead, `ahead` metres from the car's middle and `height` metres high.
    pub fn ahead(ahead: f64, height: f64) -> Self {
        Self { position: Vector3::new(ahead, 0.0, height), heading: 0.0 }
    }

    /// Returns the pose of the sensor in the plane of the world.
    pub fn pose(&self, car: &VehicleState) -> Pose {
        car.pose().then(&Pose { position: self.position.xy(), heading: self.heading })
    }

    /// Returns the velocity of the sensor over the ground in m/s, which includes the turning of the car.
    pub fn velocity(&self, car: &VehicleState) -> Vector2<f64> {
        let arm = self.position.xy();
        car.pose().turn_to_plane(car.velocity + Vector2::new(-arm.y, arm.x) * car.yaw_rate)
    }

    pub(super) fn check(&self, checks: &Checks<'_>) -> Result<(), SensorError> {
        for (axis, value) in ["x", "y"].into_iter().zip(self.position.iter()) {
            checks.within(&format!("mount.position.{axis}"), *value, (-100.0, 100.0), "m")?;
        }
        checks.within("mount.position.z", self.position.z, (0.0, 100.0), "m")?;
        checks.within("mount.heading", self.heading, (-100.0, 100.0), "rad")
    }
}
