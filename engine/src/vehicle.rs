//! The vehicle `single-track`: two axles, each of which can push no harder than its tyres hold the road. It drives
//! straight on: the model is longitudinal.
//!
//! The car is a rigid body on a front and a rear axle. Acceleration shifts load between them
//! (`N_f = m (g l_r - a h) / L`, `N_r = m (g l_f + a h) / L`), and an axle transmits at most `mu N`. The brakes
//! act on both axles in the proportion of their loads, as a stability control makes them, so that the whole car
//! decelerates at up to `mu g`; the engine drives the rear axle alone. Within a step the acceleration is
//! constant and the motion exact, standstill included: the stopping distance is v²/(2 a) whatever the step.
//!
//! (The ray-cast vehicle of rapier is not used: it brakes with twice the friction force.)

/// Standard gravity in m/s².
pub const GRAVITY: f64 = 9.80665;

/// Dimensions, masses and limits of a car. Lengths in metres, the car's position is the middle of its box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vehicle {
    /// Bumper to bumper.
    pub length: f64,
    /// Side to side.
    pub width: f64,
    /// Road to roof.
    pub height: f64,
    /// Front axle to rear axle.
    pub wheelbase: f64,
    /// Centre of gravity to front axle.
    pub front_axle: f64,
    /// Height above the road of the centre of gravity (of the sprung mass, as the single-track model of the source
    /// takes it), on which the load transfer acts.
    pub centre_of_gravity: f64,
    /// What the engine and the brakes can do, in m/s², before the road limits them.
    pub max_acceleration: f64,
    /// Speed in m/s above which the engine gives constant power, so that its acceleration falls as 1/v.
    pub switch_speed: f64,
    /// Top speed in m/s.
    pub max_speed: f64,
}

impl Vehicle {
    /// Vehicle 2 of the CommonRoad vehicle models, a BMW 320i (Althoff and Würsching, "CommonRoad: Vehicle
    /// Models", 2020), with a roof 1.4 m above the road.
    pub const BMW_320I: Vehicle = Vehicle {
        length: 4.508,
        width: 1.610,
        height: 1.4,
        wheelbase: 2.579,
        front_axle: 1.156,
        centre_of_gravity: 0.614,
        max_acceleration: 11.5,
        switch_speed: 7.319,
        max_speed: 50.8,
    };

    /// The acceleration in m/s² that a throttle in [-1, 1] gives at this speed on a road of this friction.
    /// Below 0 it is a brake, and `throttle * max_acceleration` is asked of it.
    pub fn acceleration(&self, throttle: f64, speed: f64, friction: f64) -> f64 {
        if throttle < 0.0 {
            return (throttle * self.max_acceleration).max(-friction * GRAVITY);
        }
        if speed >= self.max_speed {
            return 0.0;
        }
        let power = (self.switch_speed / speed.max(self.switch_speed)).min(1.0);
        // a = mu N_r / m with N_r = m (g l_f + a h) / L, solved for a. A road so rough that the front wheels
        // would lift (mu h >= L) limits nothing.
        let lever = self.wheelbase - friction * self.centre_of_gravity;
        let traction = if lever > 0.0 { friction * GRAVITY * self.front_axle / lever } else { f64::INFINITY };
        (throttle * power * self.max_acceleration).min(traction)
    }
}

/// How a car moves along its heading.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// m/s, never below 0.
    pub speed: f64,
    /// m/s² over the last step: the change of speed by its duration.
    pub acceleration: f64,
    /// The way covered so far, in metres.
    pub travelled: f64,
}

impl Motion {
    /// The motion after `dt` seconds under a constant acceleration that a brake ends at standstill.
    pub fn after(self, acceleration: f64, dt: f64) -> Self {
        let speed = self.speed + acceleration * dt;
        let (speed, way) = if speed < 0.0 {
            (0.0, -0.5 * self.speed * self.speed / acceleration)
        } else {
            (speed, (self.speed + 0.5 * acceleration * dt) * dt)
        };
        Self { speed, acceleration: (speed - self.speed) / dt, travelled: self.travelled + way }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAR: Vehicle = Vehicle::BMW_320I;

    fn stopping_distance(speed: f64, friction: f64, dt: f64) -> f64 {
        let mut motion = Motion { speed, ..Motion::default() };
        while motion.speed > 0.0 {
            motion = motion.after(CAR.acceleration(-1.0, motion.speed, friction), dt);
        }
        motion.travelled
    }

    #[test]
    fn full_brakes_stop_the_car_within_two_percent_of_the_friction_limit() {
        let speed = 50.0 / 3.6;
        for friction in [0.3, 0.8] {
            let ideal = speed * speed / (2.0 * friction * GRAVITY);
            let distances = [0.002, 0.01].map(|dt| stopping_distance(speed, friction, dt));
            for distance in distances {
                assert!((distance / ideal - 1.0).abs() < 0.02, "mu {friction}: {distance} m, ideal {ideal} m");
            }
            assert!((distances[0] / distances[1] - 1.0).abs() < 0.01, "mu {friction}: {distances:?}");
        }
    }

    #[test]
    fn a_standing_car_with_its_brakes_on_does_not_move() {
        let rest = Motion::default().after(CAR.acceleration(-1.0, 0.0, 0.8), 0.01);
        assert_eq!(rest, Motion::default());
    }

    #[test]
    fn brakes_weaker_than_the_road_do_as_commanded() {
        assert_eq!(CAR.acceleration(-0.5, 10.0, 0.8), -5.75);
        assert_eq!(CAR.acceleration(-0.9, 10.0, 0.2), -0.2 * GRAVITY);
    }

    #[test]
    fn the_rear_axle_spins_before_the_whole_car_slips() {
        for friction in [0.2, 0.5, 0.8] {
            let grip = CAR.acceleration(1.0, 0.0, friction);
            let rear_load = (GRAVITY * CAR.front_axle + grip * CAR.centre_of_gravity) / CAR.wheelbase;
            assert!((grip - friction * rear_load).abs() < 1e-12);
            assert!(grip < friction * GRAVITY);
        }
    }

    #[test]
    fn the_engine_gives_constant_power_above_the_switch_speed_and_nothing_at_top_speed() {
        assert!((CAR.acceleration(1.0, 2.0 * CAR.switch_speed, 5.0) - 0.5 * CAR.max_acceleration).abs() < 1e-12);
        assert_eq!(CAR.acceleration(1.0, CAR.max_speed, 0.8), 0.0);
    }
}
