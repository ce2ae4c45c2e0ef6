//! The mounting of a sensor on the car.

use super::error::{Checks, SensorError};
use crate::geometry::Pose;
use crate::vehicle::VehicleState;
use nalgebra::{Vector2, Vector3};

/// The position of an upright sensor on a car, and the direction in which it looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mount {
    /// The position from the middle of the car's box, on the ground: x ahead, y to the left, z up, in metres.
    pub position: Vector3<f64>,
    /// The direction of the sensor, in radians counter-clockwise from the car's heading.
    pub heading: f64,
}

impl Mount {
    /// Mounts a sensor over the middle of the car, this many metres above the ground, looking ahead.
    pub fn above(height: f64) -> Self {
        Self { position: Vector3::new(0.0, 0.0, height), heading: 0.0 }
    }

    /// Mounts a sensor this many metres ahead of the middle of the car and above the ground, looking ahead.
    pub fn ahead(ahead: f64, height: f64) -> Self {
        Self { position: Vector3::new(ahead, 0.0, height), heading: 0.0 }
    }

    /// Returns the pose of the sensor, seen from above.
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
