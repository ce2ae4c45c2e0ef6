//! The figures that the models are held to.

use super::*;
use proptest::prelude::*;

/// The friction of the source's tyre.
const DRY: f64 = 1.0489;

fn km_h(speed: f64) -> f64 {
    speed / 3.6
}

/// The way to standstill under constant pedals.
fn stopping_distance(model: VehicleModel, speed: f64, throttle: f64, friction: f64, dt: f64) -> f64 {
    let mut car = model.build(&CAR, ORIGIN, speed);
    for _ in 0..(60.0 / dt) as usize {
        if car.state().speed() == 0.0 {
            let state = car.state();
            assert!((state.position.x - state.travelled).abs() < 0.01 && state.position.y.abs() < 0.01, "{state:?}");
            return state.travelled;
        }
        car.step(pedals(throttle, 0.0), friction, dt);
        assert!(car.state().velocity.x >= 0.0);
    }
    panic!("{} does not stop: {:?}", model.name(), car.state());
}

#[test]
fn full_brakes_stop_the_car_within_two_percent_of_the_friction_limit_at_any_step() {
    for model in VehicleModel::ALL {
        for speed in [30.0, 50.0, 80.0, 120.0].map(km_h) {
            for friction in [0.2, 0.4, 0.6, 0.8] {
                let ideal = speed * speed / (2.0 * friction * GRAVITY);
                let ratios = [0.002, 0.005, 0.01].map(|dt| stopping_distance(model, speed, -1.0, friction, dt) / ideal);
                for ratio in ratios {
                    let case = || format!("{} at {speed} m/s, mu {friction}: {ratios:?}", model.name());
                    assert!((ratio - 1.0).abs() < 0.02, "{}", case());
                    assert!((ratio / ratios[0] - 1.0).abs() < 0.01, "{}", case());
                }
            }
        }
    }
}

#[test]
fn a_car_of_another_make_brakes_as_well() {
    let van = Vehicle {
        wheelbase: 3.3,
        track: 1.7,
        front_axle: 1.4,
        centre_of_gravity: 0.8,
        mass: 2400.0,
        yaw_inertia: 5500.0,
        wheel_mass: 50.0,
        drive: Drive::Front,
        ..CAR
    };
    let small = Vehicle { front_axle: 1.5, mass: 650.0, yaw_inertia: 900.0, wheel_mass: 18.0, ..CAR };
    for (model, vehicle) in VehicleModel::ALL.into_iter().flat_map(|model| [(model, van), (model, small)]) {
        assert_eq!(vehicle.flaw(), None);
        let ideal = 20.0 * 20.0 / (2.0 * 0.7 * GRAVITY);
        let mut car = model.build(&vehicle, ORIGIN, 20.0);
        for _ in 0..500 {
            car.step(pedals(-1.0, 0.0), 0.7, DT);
        }
        let state = car.state();
        assert!(state.speed() == 0.0 && (state.travelled / ideal - 1.0).abs() < 0.02, "{} {state:?}", model.name());
    }
}

#[test]
fn a_command_of_6_m_s2_from_50_km_h_takes_16_to_17_metres() {
    for model in VehicleModel::ALL {
        let distance = stopping_distance(model, km_h(50.0), -6.0 / CAR.max_acceleration, 0.8, DT);
        assert!((16.0..17.0).contains(&distance), "{}: {distance} m", model.name());
    }
}

/// Radius of the middle's way, and side acceleration, in a steady bend.
fn circle(model: VehicleModel, angle: f64, speed: f64, friction: f64) -> (f64, f64) {
    let mut car = model.build(&CAR, ORIGIN, speed);
    bend(car.as_mut(), angle, speed, friction, 20.0);
    let state = car.state();
    (state.speed() / state.yaw_rate, state.speed() * state.yaw_rate)
}

#[test]
fn a_wide_circle_has_the_radius_along_which_the_wheels_point() {
    let ideal = CAR.wheelbase / libm::tan(0.03);
    for model in VehicleModel::ALL {
        for speed in [5.0, 10.0, 15.0, 20.0] {
            for friction in [0.6, 0.8, DRY] {
                let (radius, _) = circle(model, 0.03, speed, friction);
                assert!((radius / ideal - 1.0).abs() < 0.02, "{} at {speed} m/s: {radius} m", model.name());
            }
        }
    }
}

/// The steering angle that a bend needs beyond what its radius takes, by the side acceleration: the slope of the
/// straight line through a sweep of speeds, in rad s²/m.
#[test]
fn the_understeer_gradient_is_the_one_that_is_documented() {
    for (model, documented) in [(VehicleModel::SingleTrack, 1.4e-5), (VehicleModel::Jointed, 4.0e-5)] {
        let sweep = (5..=20).map(|speed| {
            let (radius, side) = circle(model, 0.03, f64::from(speed), DRY);
            (side, 0.03 - libm::atan(CAR.wheelbase / radius))
        });
        let (squares, products) = sweep
            .fold((0.0, 0.0), |(squares, products), (side, beyond)| (squares + side * side, products + side * beyond));
        let gradient = products / squares;
        assert!((gradient - documented).abs() < 0.2e-5, "{}: {gradient}", model.name());
    }
}

#[test]
fn side_acceleration_saturates_at_the_friction() {
    for model in VehicleModel::ALL {
        for friction in [0.2, 0.4, 0.6, 0.8] {
            let speed = 20.0;
            let mut car = model.build(&CAR, ORIGIN, speed);
            let mut most: f64 = 0.0;
            for i in 0..400 {
                bend(car.as_mut(), 0.0005 * f64::from(i), speed, friction, 0.05);
                most = most.max(car.state().acceleration.y);
            }
            let ratio = most / (friction * GRAVITY);
            assert!((ratio - 1.0).abs() < 0.05, "{} mu {friction}: {ratio}", model.name());
        }
    }
}

#[test]
fn a_car_at_rest_stays_where_it_is() {
    for model in VehicleModel::ALL {
        for throttle in [0.0, -1.0] {
            let mut car = model.build(&CAR, ORIGIN, 0.0);
            for _ in 0..6000 {
                car.step(pedals(throttle, 0.0), 0.8, DT);
            }
            let state = car.state();
            assert!(state.position.norm() < 0.001 && state.heading.abs() < 0.001, "{}: {state:?}", model.name());
        }
    }
}

/// Seconds from rest to a speed in closed form: a constant acceleration, which traction or engine limits, then constant
/// power. Driven wheels at the limit of traction also turn the others faster, which `idle` kg stand for.
fn launch(vehicle: &Vehicle, speed: f64, friction: f64, idle: f64) -> f64 {
    let mass = vehicle.mass + idle;
    let weight = vehicle.mass * GRAVITY;
    let (front, rear) = (vehicle.front_axle, vehicle.rear_axle());
    let shifted = friction * vehicle.centre_of_gravity * vehicle.mass / mass;
    let traction = match vehicle.drive {
        Drive::Front => friction * weight * rear / (vehicle.wheelbase + shifted),
        Drive::Rear => friction * weight * front / (vehicle.wheelbase - shifted),
        Drive::Four => friction * weight,
    };
    let acceleration = (traction / mass).min(vehicle.max_acceleration);
    let power = vehicle.max_acceleration * vehicle.switch_speed;
    let constant = speed.min(power / acceleration);
    constant / acceleration + (speed * speed - constant * constant) / (2.0 * power)
}

/// The times of a car from rest to 40, 60, 80 and 100 km/h at full throttle, by those in closed form.
fn launched(model: VehicleModel, vehicle: &Vehicle, friction: f64, idle: f64) -> [f64; 4] {
    let mut car = model.build(vehicle, ORIGIN, 0.0);
    let mut time = 0.0;
    [40.0, 60.0, 80.0, 100.0].map(|speed| {
        while car.state().velocity.x < km_h(speed) {
            car.step(pedals(1.0, 0.0), friction, 0.002);
            time += 0.002;
        }
        time / launch(vehicle, km_h(speed), friction, idle)
    })
}

#[test]
fn the_car_gains_speed_as_traction_and_power_allow() {
    for model in VehicleModel::ALL {
        for friction in [0.6, 0.8, DRY] {
            for ratio in launched(model, &CAR, friction, 0.0) {
                assert!((ratio - 1.0).abs() < 0.02, "{} mu {friction}: {ratio}", model.name());
            }
        }
    }
}

#[test]
fn whichever_wheels_drive_gain_speed_as_their_load_allows() {
    for (model, drive) in VehicleModel::ALL.into_iter().flat_map(|model| [(model, Drive::Front), (model, Drive::Four)])
    {
        let vehicle = Vehicle { drive, ..CAR };
        let turns_idle = model == VehicleModel::Jointed && drive == Drive::Front;
        let idle = if turns_idle { 2.0 * CAR.wheel_inertia / (CAR.wheel_radius * CAR.wheel_radius) } else { 0.0 };
        for ratio in launched(model, &vehicle, 0.8, idle) {
            assert!((ratio - 1.0).abs() < 0.02, "{} {drive:?}: {ratio}", model.name());
        }
    }
}

#[test]
fn a_slow_car_goes_where_its_wheels_point() {
    for model in VehicleModel::ALL {
        for (speed, angle) in [(0.3, 0.5), (1.0, 1.0), (2.0, 0.5), (3.0, 0.3), (5.0, 0.2)] {
            for dt in [0.002, 0.01, 0.03] {
                let mut car = model.build(&CAR, ORIGIN, speed);
                for i in 0..(10.0 / dt) as usize {
                    let throttle = (0.5 * (speed - car.state().velocity.x)).max(0.0);
                    car.step(pedals(throttle, angle / CAR.max_steering_angle), 0.8, dt);
                    let state = car.state();
                    // The rear axle does not slip, so that its middle turns about the point on its line that the front
                    // wheels point to.
                    let curvature = state.yaw_rate / state.velocity.x * CAR.wheelbase / libm::tan(angle);
                    let steady = i as f64 * dt > 4.0;
                    assert!(
                        !steady || (curvature - 1.0).abs() < 0.02,
                        "{} {speed} {angle} {dt}: {curvature}",
                        model.name()
                    );
                }
            }
        }
    }
}

prop_compose! {
    /// Cars from the lightest to vans, none of which tips over before it slides.
    fn any_car()(
        mass in 600.0..3500.0_f64,
        wheelbase in 2.0..4.0_f64,
        front in 0.4..0.6_f64,
        height in 0.17..0.27_f64,
        slender in 1.1..1.4_f64,
        inertia in 0.2..0.3_f64,
        wheel in 0.015..0.03_f64,
        ride_frequency in 1.0..2.5_f64,
        damping_ratio in 0.2..0.6_f64,
        drive in prop::sample::select(vec![Drive::Front, Drive::Rear, Drive::Four]),
    ) -> Vehicle {
        Vehicle {
            wheelbase,
            track: 2.0 * slender * height * wheelbase,
            front_axle: front * wheelbase,
            centre_of_gravity: height * wheelbase,
            mass,
            yaw_inertia: inertia * mass * wheelbase * wheelbase,
            wheel_mass: wheel * mass,
            wheel_inertia: 0.06 * wheel * mass,
            ride_frequency,
            damping_ratio,
            drive,
            ..CAR
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 50, ..ProptestConfig::default() })]

    #[test]
    fn any_car_bends_and_stops(car in any_car(), friction in 0.2..0.8_f64, dt in 0.002..0.02_f64) {
        prop_assert_eq!(car.flaw(), None);
        for model in VehicleModel::ALL {
            let mut moving = model.build(&car, ORIGIN, 15.0);
            let angle = 0.3 * friction * GRAVITY * car.wheelbase / (15.0 * 15.0);
            for _ in 0..(4.0 / dt) as usize {
                let throttle = (0.5 * (15.0 - moving.state().velocity.x)).max(0.0);
                moving.step(pedals(throttle, angle / car.max_steering_angle), friction, dt);
            }
            let state = *moving.state();
            let ratio = state.yaw_rate / state.velocity.x * car.wheelbase / libm::tan(angle);
            prop_assert!((ratio - 1.0).abs() < 0.05, "{} {ratio} {state:?}", model.name());
            for _ in 0..(2.0 / dt) as usize {
                moving.step(pedals(0.0, 0.0), friction, dt);
            }
            let before = *moving.state();
            for _ in 0..(15.0 / dt) as usize {
                moving.step(pedals(-1.0, 0.0), friction, dt);
            }
            let after = moving.state();
            let ideal = before.velocity.norm_squared() / (2.0 * friction * GRAVITY);
            let ratio = (after.travelled - before.travelled) / ideal;
            prop_assert!(after.speed() == 0.0 && (ratio - 1.0).abs() < 0.02, "{} {ratio} {before:?} {after:?}", model.name());
        }
    }
}
