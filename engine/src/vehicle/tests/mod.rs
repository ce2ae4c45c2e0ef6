//! Both models of the car against closed forms and published figures, and what must hold of both.

mod behaviour;
mod brush;
mod combined;
mod validation;

use super::*;

const CAR: Vehicle = Vehicle::BMW_320I;
const ORIGIN: Pose = Pose { position: Vector2::new(0.0, 0.0), heading: 0.0 };
const DT: f64 = 0.01;

fn pedals(throttle: f64, steering: f64) -> Pedals {
    Pedals { throttle, steering }
}

/// Drives on for some seconds with the front wheels at an angle, and holds the speed if the engine can.
fn bend(car: &mut dyn Dynamics, angle: f64, speed: f64, friction: f64, duration: f64) {
    for _ in 0..(duration / DT).round() as usize {
        let throttle = 0.5 * (speed - car.state().velocity.x);
        car.step(pedals(throttle.max(0.0), angle / CAR.max_steering_angle), friction, DT);
    }
}
