//! Converts observations and briefings to messages and back, without the loss of a bit.

use super::{
    Other as WireOther, Pose as WirePose, Rectangle, Reset, Step, Vehicle as WireVehicle, Way as WireWay, other,
};
use paracosm_engine::object::Outline;
use paracosm_engine::vehicle::{Drive, Vehicle};
use paracosm_engine::{Briefing, Observation, Other, Way};

/// Writes an observation to a step. The other bodies are written only if `others` is true.
pub fn write(observation: &Observation, others: bool, step: &mut Step) {
    let Observation { time, speed, travelled, odometry, way, .. } = observation;
    (step.time, step.speed, step.travelled) = (*time, *speed, *travelled);
    step.odometry = Some(WirePose { x: odometry.position.x, y: odometry.position.y, heading: odometry.heading });
    let flat = way.ahead.iter().flat_map(|point| [point.position.x, point.position.y, point.curvature]);
    let way = WireWay { offset: way.offset, heading: way.heading, spacing: Way::SPACING, ahead: flat.collect() };
    step.way = Some(way);
    if others {
        step.others = observation.others.iter().map(WireOther::from).collect();
    }
}

impl From<&Other> for WireOther {
    fn from(other: &Other) -> Self {
        let outline = match other.outline {
            Outline::Rectangle { length, width } => other::Outline::Rectangle(Rectangle { length, width }),
            Outline::Disc { radius } => other::Outline::Radius(radius),
        };
        Self {
            id: u32::try_from(other.id).unwrap_or(u32::MAX),
            class: other.class.to_string(),
            x: other.position.x,
            y: other.position.y,
            velocity_x: other.velocity.x,
            velocity_y: other.velocity.y,
            heading: other.heading,
            outline: Some(outline),
        }
    }
}

impl From<&Briefing> for Reset {
    fn from(briefing: &Briefing) -> Self {
        let vehicle = &briefing.vehicle;
        let drive = match vehicle.drive {
            Drive::Front => super::Drive::Front,
            Drive::Rear => super::Drive::Rear,
            Drive::Four => super::Drive::Four,
        };
        let vehicle = WireVehicle {
            length: vehicle.length,
            width: vehicle.width,
            height: vehicle.height,
            wheelbase: vehicle.wheelbase,
            track: vehicle.track,
            front_axle: vehicle.front_axle,
            centre_of_gravity: vehicle.centre_of_gravity,
            mass: vehicle.mass,
            yaw_inertia: vehicle.yaw_inertia,
            wheel_radius: vehicle.wheel_radius,
            wheel_mass: vehicle.wheel_mass,
            wheel_inertia: vehicle.wheel_inertia,
            ride_frequency: vehicle.ride_frequency,
            damping_ratio: vehicle.damping_ratio,
            cornering_stiffness: vehicle.cornering_stiffness,
            drive: drive.into(),
            max_steering_angle: vehicle.max_steering_angle,
            max_steering_rate: vehicle.max_steering_rate,
            max_acceleration: vehicle.max_acceleration,
            switch_speed: vehicle.switch_speed,
            max_speed: vehicle.max_speed,
        };
        Self { cruise_speed: briefing.cruise_speed, vehicle: Some(vehicle) }
    }
}

impl From<&Reset> for Briefing {
    fn from(reset: &Reset) -> Self {
        let vehicle = reset.vehicle.unwrap_or_default();
        let drive = match vehicle.drive() {
            super::Drive::Front => Drive::Front,
            super::Drive::Rear | super::Drive::Unspecified => Drive::Rear,
            super::Drive::Four => Drive::Four,
        };
        let vehicle = Vehicle {
            length: vehicle.length,
            width: vehicle.width,
            height: vehicle.height,
            wheelbase: vehicle.wheelbase,
            track: vehicle.track,
            front_axle: vehicle.front_axle,
            centre_of_gravity: vehicle.centre_of_gravity,
            mass: vehicle.mass,
            yaw_inertia: vehicle.yaw_inertia,
            wheel_radius: vehicle.wheel_radius,
            wheel_mass: vehicle.wheel_mass,
            wheel_inertia: vehicle.wheel_inertia,
            ride_frequency: vehicle.ride_frequency,
            damping_ratio: vehicle.damping_ratio,
            cornering_stiffness: vehicle.cornering_stiffness,
            drive,
            max_steering_angle: vehicle.max_steering_angle,
            max_steering_rate: vehicle.max_steering_rate,
            max_acceleration: vehicle.max_acceleration,
            switch_speed: vehicle.switch_speed,
            max_speed: vehicle.max_speed,
        };
        Self { cruise_speed: reset.cruise_speed, vehicle, navigation: None }
    }
}
