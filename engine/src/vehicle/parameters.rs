//! The parameters of a car, and the forces that follow from them on a straight road.

use super::GRAVITY;
use super::VehicleFlaw;

/// The wheels that the engine drives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Drive {
    /// The engine drives the front wheels.
    Front,
    /// The engine drives the rear wheels.
    #[default]
    Rear,
    /// The engine drives all four wheels, each in proportion to its load.
    Four,
}

/// The dimensions, masses and limits of a car. Lengths are in metres. The position of a car is the middle of its box;
/// the axles are at equal distances from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vehicle {
    /// The length of the car from bumper to bumper, in metres.
    pub length: f64,
    /// The width of the car from side to side, in metres.
    pub width: f64,
    /// The height of the car from road to roof, in metres.
    pub height: f64,
    /// The distance from the front axle to the rear axle, in metres.
    pub wheelbase: f64,
    /// The distance from a left wheel to the right wheel of the same axle, in metres.
    pub track: f64,
    /// The distance from the centre of gravity to the front axle, in metres.
    pub front_axle: f64,
    /// The height in metres of the centre of gravity above the road, which determines the load transfer. It is the
    /// height of the sprung mass, as in the single-track model of the source.
    pub centre_of_gravity: f64,
    /// The mass of the whole car, in kg.
    pub mass: f64,
    /// The moment of inertia of the car about the vertical axis through its centre of gravity, in kg m².
    pub yaw_inertia: f64,
    /// The radius of a wheel, which is the distance from axle to road, in metres.
    pub wheel_radius: f64,
    /// The mass of one wheel of the car, in kg.
    pub wheel_mass: f64,
    /// The moment of inertia of one wheel about its axle, in kg m².
    pub wheel_inertia: f64,
    /// The frequency in Hz at which the body of the car bounces on the springs.
    pub ride_frequency: f64,
    /// The damping of the body's bounce, as a share of the critical damping, which just prevents overshoot.
    pub damping_ratio: f64,
    /// The side force of a tyre divided by its load and its slip angle, in 1/rad, for small angles.
    pub cornering_stiffness: f64,
    /// The wheels that the engine drives.
    pub drive: Drive,
    /// The largest angle of the front wheels to either side, in radians.
    pub max_steering_angle: f64,
    /// The largest rate at which the front wheels turn, in rad/s.
    pub max_steering_rate: f64,
    /// The greatest acceleration by the engine and deceleration by the brakes, in m/s², without the limits of the road.
    pub max_acceleration: f64,
    /// The speed in m/s above which the engine gives constant power, so that the acceleration falls as 1/v.
    pub switch_speed: f64,
    /// The top speed of the car in m/s.
    pub max_speed: f64,
}

impl Vehicle {
    /// Vehicle 2 of the CommonRoad vehicle models, a BMW 320i (Althoff and Würsching, "CommonRoad: Vehicle Models",
    /// 2020), with a roof 1.4 m above the road. The track is the mean of both axles' tracks. The ride frequency and
    /// damping are those of the car's springs and dampers under its sprung mass. A wheel is half of an axle's unsprung
    /// mass. The wheel inertia is that of a wheel of 15 inches; the source gives the value of a heavier car.
    pub const BMW_320I: Vehicle = Vehicle {
        length: 4.508,
        width: 1.610,
        height: 1.4,
        wheelbase: 2.579,
        track: 1.375,
        front_axle: 1.156,
        centre_of_gravity: 0.614,
        mass: 1093.3,
        yaw_inertia: 1791.6,
        wheel_radius: 0.344,
        wheel_mass: 31.9,
        wheel_inertia: 0.9,
        ride_frequency: 1.52,
        damping_ratio: 0.37,
        cornering_stiffness: 21.92,
        drive: Drive::Rear,
        max_steering_angle: 1.066,
        max_steering_rate: 0.4,
        max_acceleration: 11.5,
        switch_speed: 7.319,
        max_speed: 50.8,
    };

    /// Returns the acceleration in m/s² for a throttle in [-1, 1] at this speed on a road with this friction
    /// coefficient. A throttle below 0 brakes, with a demand of `throttle * max_acceleration`.
    pub fn acceleration(&self, throttle: f64, speed: f64, friction: f64) -> f64 {
        let demand = self.demand(throttle, speed);
        if throttle < 0.0 { demand.max(-friction * GRAVITY) } else { demand.min(self.traction(friction)) }
    }

    /// Returns the same on a road that limits nothing.
    pub(super) fn demand(&self, throttle: f64, speed: f64) -> f64 {
        if throttle < 0.0 {
            return throttle * self.max_acceleration;
        }
        if speed >= self.max_speed {
            return 0.0;
        }
        let power = (self.switch_speed / speed.max(self.switch_speed)).min(1.0);
        throttle * power * self.max_acceleration
    }

    /// Returns the acceleration in m/s² at which the driven wheels begin to spin.
    ///
    /// For the rear axle, it solves `a = mu N_r / m` with `N_r = m (g l_f + a h) / L` for `a`; likewise for the front
    /// axle. A road with so much friction that the front wheels would lift (`mu h >= L`) limits nothing.
    fn traction(&self, friction: f64) -> f64 {
        let (grip, shift) = (friction * GRAVITY, friction * self.centre_of_gravity);
        match self.drive {
            Drive::Front => grip * self.rear_axle() / (self.wheelbase + shift),
            Drive::Rear if self.wheelbase > shift => grip * self.front_axle / (self.wheelbase - shift),
            Drive::Rear => f64::INFINITY,
            Drive::Four => grip,
        }
    }

    /// Returns the distance from the centre of gravity to the rear axle, in metres.
    pub fn rear_axle(&self) -> f64 {
        self.wheelbase - self.front_axle
    }

    /// Returns how far the centre of gravity is ahead of the car's middle, in metres.
    pub(super) fn ahead(&self) -> f64 {
        0.5 * self.wheelbase - self.front_axle
    }

    /// Returns the moment of inertia without wheels about the vertical through the centre of gravity, in kg m².
    pub(super) fn body_inertia(&self) -> f64 {
        let arm = 0.25 * (self.wheelbase * self.wheelbase + self.track * self.track);
        self.yaw_inertia - 4.0 * (self.wheel_mass * arm + self.wheel_inertia)
    }

    /// Returns the loads in newtons on the front and on the rear axle at an acceleration in m/s².
    pub(super) fn axle_loads(&self, acceleration: f64) -> [f64; 2] {
        let (inertia, per_metre) = (acceleration * self.centre_of_gravity, self.mass / self.wheelbase);
        let front = per_metre * (GRAVITY * self.rear_axle() - inertia);
        let rear = per_metre * (GRAVITY * self.front_axle + inertia);
        [front.max(0.0), rear.max(0.0)]
    }

    /// Returns the greatest torque of the engine, or of the brakes, on all wheels together, in N m.
    pub fn max_torque(&self) -> f64 {
        self.max_acceleration * self.mass * self.wheel_radius
    }

    /// Returns the same car with a given greatest torque, in N m.
    pub fn with_max_torque(self, torque: f64) -> Self {
        Self { max_acceleration: torque / (self.mass * self.wheel_radius), ..self }
    }

    /// Returns the same car, if its description is valid.
    ///
    /// # Panics
    /// The vehicle has a [`Vehicle::flaw`].
    pub(super) fn checked(&self) -> Self {
        if let Some(flaw) = self.flaw() {
            panic!("{flaw}");
        }
        *self
    }

    /// Returns the first mistake in the description of the vehicle; `None` if the description is valid.
    pub fn flaw(&self) -> Option<VehicleFlaw> {
        let positive = [
            ("length", self.length),
            ("width", self.width),
            ("height", self.height),
            ("wheelbase", self.wheelbase),
            ("track", self.track),
            ("centre_of_gravity", self.centre_of_gravity),
            ("mass", self.mass),
            ("yaw_inertia", self.yaw_inertia),
            ("wheel_radius", self.wheel_radius),
            ("wheel_mass", self.wheel_mass),
            ("wheel_inertia", self.wheel_inertia),
            ("ride_frequency", self.ride_frequency),
            ("damping_ratio", self.damping_ratio),
            ("cornering_stiffness", self.cornering_stiffness),
            ("max_steering_rate", self.max_steering_rate),
            ("max_acceleration", self.max_acceleration),
            ("switch_speed", self.switch_speed),
            ("max_speed", self.max_speed),
        ];
        let wrong = positive.into_iter().find(|(_, value)| !(*value > 0.0 && value.is_finite()));
        if let Some((parameter, value)) = wrong {
            return Some(VehicleFlaw::NotPositive { parameter, value });
        }
        let between = |parameter, value: f64, most: f64| {
            (!(0.0..most).contains(&value)).then_some(VehicleFlaw::OutOfRange { parameter, value, most })
        };
        let wrong = between("front_axle", self.front_axle, self.wheelbase)
            .or_else(|| between("max_steering_angle", self.max_steering_angle, std::f64::consts::FRAC_PI_2));
        if wrong.is_some() {
            return wrong;
        }
        let wheels = 2.0 * self.wheel_mass;
        for (axle, load) in ["front", "rear"].into_iter().zip(self.axle_loads(0.0)) {
            let carried = load / GRAVITY;
            if carried <= wheels {
                return Some(VehicleFlaw::Axle { axle, carried, wheels });
            }
        }
        let body = self.body_inertia();
        let flaw = VehicleFlaw::YawInertia { whole: self.yaw_inertia, wheels: self.yaw_inertia - body };
        (body <= 0.0).then_some(flaw)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::Motion;

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

    #[test]
    fn four_driven_wheels_use_the_whole_load_and_front_wheels_the_one_that_they_shed() {
        let grip = |drive| Vehicle { drive, ..CAR }.acceleration(1.0, 0.0, 0.5);
        assert_eq!(grip(Drive::Four), 0.5 * GRAVITY);
        let front = grip(Drive::Front);
        assert!((front - 0.5 * CAR.axle_loads(front)[0] / CAR.mass).abs() < 1e-12);
        assert!(front < 0.5 * CAR.axle_loads(0.0)[0] / CAR.mass);
    }

    #[test]
    fn a_torque_is_an_acceleration_by_mass_and_wheel() {
        let strong = CAR.with_max_torque(2000.0);
        assert!((strong.max_torque() - 2000.0).abs() < 1e-9);
        assert!((strong.max_acceleration * CAR.mass * CAR.wheel_radius - 2000.0).abs() < 1e-9);
    }

    #[test]
    fn what_no_car_has_is_named() {
        assert_eq!(CAR.flaw(), None);
        let problem = |car: Vehicle| car.flaw().unwrap().to_string();
        assert!(problem(Vehicle { mass: f64::NAN, ..CAR }).contains("mass is NaN"));
        assert!(problem(Vehicle { track: 0.0, ..CAR }).contains("track is 0"));
        assert!(problem(Vehicle { wheel_mass: 250.0, ..CAR }).contains("rear axle carries 490.1 kg"));
        assert!(
            problem(Vehicle { yaw_inertia: 200.0, ..CAR }).contains("yaw_inertia is 200 kg m², expected more than")
        );
        assert!(
            problem(Vehicle { front_axle: 3.0, ..CAR })
                .contains("front_axle is 3, expected a number from 0 to less than 2.579")
        );
    }
}
