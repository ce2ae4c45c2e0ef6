//! Both models against closed forms and published figures.

use super::*;
use proptest::prelude::*;

const CAR: Vehicle = Vehicle::BMW_320I;
const ORIGIN: Pose = Pose { position: Vector2::new(0.0, 0.0), heading: 0.0 };
const DT: f64 = 0.01;
/// The friction of the source's tyre.
const DRY: f64 = 1.0489;

fn km_h(speed: f64) -> f64 {
    speed / 3.6
}

fn pedals(throttle: f64, steering: f64) -> Pedals {
    Pedals { throttle, steering }
}

/// The way to standstill under constant pedals.
fn stopping_distance(model: Model, speed: f64, throttle: f64, friction: f64, dt: f64) -> f64 {
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
    for model in Model::ALL {
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
    for (model, vehicle) in Model::ALL.into_iter().flat_map(|model| [(model, van), (model, small)]) {
        assert_eq!(vehicle.problem(), None);
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
    for model in Model::ALL {
        let distance = stopping_distance(model, km_h(50.0), -6.0 / CAR.max_acceleration, 0.8, DT);
        assert!((16.0..17.0).contains(&distance), "{}: {distance} m", model.name());
    }
}

/// Drives on for some seconds with the front wheels at an angle, and holds the speed if the engine can.
fn bend(car: &mut dyn Dynamics, angle: f64, speed: f64, friction: f64, duration: f64) {
    for _ in 0..(duration / DT).round() as usize {
        let throttle = 0.5 * (speed - car.state().velocity.x);
        car.step(pedals(throttle.max(0.0), angle / CAR.max_steering_angle), friction, DT);
    }
}

/// Radius of the middle's way, and side acceleration, in a steady bend.
fn circle(model: Model, angle: f64, speed: f64, friction: f64) -> (f64, f64) {
    let mut car = model.build(&CAR, ORIGIN, speed);
    bend(car.as_mut(), angle, speed, friction, 20.0);
    let state = car.state();
    (state.speed() / state.yaw_rate, state.speed() * state.yaw_rate)
}

#[test]
fn a_wide_circle_has_the_radius_along_which_the_wheels_point() {
    let ideal = CAR.wheelbase / libm::tan(0.03);
    for model in Model::ALL {
        for speed in [5.0, 10.0, 15.0, 20.0] {
            for friction in [0.6, 0.8, DRY] {
                let (radius, _) = circle(model, 0.03, speed, friction);
                assert!((radius / ideal - 1.0).abs() < 0.02, "{} at {speed} m/s: {radius} m", model.name());
            }
        }
    }
}

/// The steering angle that a bend needs beyond what its radius takes, by the side acceleration: the slope of the straight
/// line through a sweep of speeds, in rad s²/m.
#[test]
fn the_understeer_gradient_is_the_one_that_is_documented() {
    for (model, documented) in [(Model::SingleTrack, 1.4e-5), (Model::Jointed, 4.0e-5)] {
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
    for model in Model::ALL {
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
    for model in Model::ALL {
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
fn launched(model: Model, vehicle: &Vehicle, friction: f64, idle: f64) -> [f64; 4] {
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
    for model in Model::ALL {
        for friction in [0.6, 0.8, DRY] {
            for ratio in launched(model, &CAR, friction, 0.0) {
                assert!((ratio - 1.0).abs() < 0.02, "{} mu {friction}: {ratio}", model.name());
            }
        }
    }
}

#[test]
fn whichever_wheels_drive_gain_speed_as_their_load_allows() {
    for (model, drive) in Model::ALL.into_iter().flat_map(|model| [(model, Drive::Front), (model, Drive::Four)]) {
        let vehicle = Vehicle { drive, ..CAR };
        let turns_idle = model == Model::Jointed && drive == Drive::Front;
        let idle = if turns_idle { 2.0 * CAR.wheel_inertia / (CAR.wheel_radius * CAR.wheel_radius) } else { 0.0 };
        for ratio in launched(model, &vehicle, 0.8, idle) {
            assert!((ratio - 1.0).abs() < 0.02, "{} {drive:?}: {ratio}", model.name());
        }
    }
}

#[test]
fn a_slow_car_goes_where_its_wheels_point() {
    for model in Model::ALL {
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

#[test]
fn both_models_change_lanes_alike_and_the_left_is_on_the_left() {
    let [track, jointed] = Model::ALL.map(|model| {
        let mut car = model.build(&CAR, ORIGIN, 20.0);
        for i in 0..400 {
            let steering = 0.02 * libm::sin(0.01 * f64::from(i) * std::f64::consts::PI);
            car.step(pedals(0.0, if i < 200 { steering } else { 0.0 }), 0.8, DT);
        }
        *car.state()
    });
    assert!(track.position.y > 1.0, "{track:?}");
    assert!((track.position - jointed.position).norm() < 0.1, "{track:?} {jointed:?}");
    assert!((track.heading - jointed.heading).abs() < 0.005, "{track:?} {jointed:?}");
}

#[test]
fn straight_ahead_the_single_track_moves_exactly_as_its_motion_says() {
    let start = Pose { position: Vector2::new(10.0, -1.75), heading: 0.3 };
    let mut car = SingleTrack::new(&CAR, start, 15.0);
    let mut motion = Motion { speed: 15.0, ..Motion::default() };
    for i in 0..2000 {
        let (throttle, friction) = (libm::sin(0.01 * f64::from(i)), 0.5 + 0.3 * libm::cos(0.03 * f64::from(i)));
        motion = motion.after(CAR.acceleration(throttle, motion.speed, friction), DT);
        car.step(pedals(throttle, 0.0), friction, DT);
        let state = car.state();
        let seen = Motion { speed: state.speed(), acceleration: state.acceleration.x, travelled: state.travelled };
        assert_eq!(seen, motion);
        assert_eq!(state.position, start.position + start.forward() * motion.travelled);
    }
}

/// A way with everything in it.
fn wild(car: &mut dyn Dynamics) -> VehicleState {
    for i in 0..1500 {
        let time = 0.01 * f64::from(i);
        let friction = if i % 400 < 200 { 0.8 } else { 0.3 };
        car.step(pedals(libm::sin(1.3 * time), 0.2 * libm::sin(0.7 * time * time)), friction, DT);
    }
    *car.state()
}

#[test]
fn a_way_is_the_same_twice_and_on_any_thread() {
    for model in Model::ALL {
        let once = wild(model.build(&CAR, ORIGIN, 12.0).as_mut());
        let mut car = model.build(&CAR, ORIGIN, 12.0);
        let again = std::thread::spawn(move || wild(car.as_mut())).join().unwrap();
        assert_eq!(once, again);
        assert!(once.is_finite());
    }
}

#[test]
fn a_way_does_not_depend_on_where_it_begins() {
    let start = Pose { position: Vector2::new(4000.0, -700.0), heading: 2.0 };
    for model in Model::ALL {
        let here = wild(model.build(&CAR, ORIGIN, 12.0).as_mut());
        let there = wild(model.build(&CAR, start, 12.0).as_mut());
        assert!((start.then(&here.pose()).position - there.position).norm() < 1e-6);
        assert!((there.heading - here.heading - start.heading).abs() < 1e-9);
        assert!((there.velocity - here.velocity).norm() < 1e-9);
    }
}

#[test]
fn the_car_goes_on_without_a_jump_wherever_it_is() {
    for model in Model::ALL {
        let mut car = model.build(&CAR, ORIGIN, 30.0);
        for i in 0..2000 {
            let before = *car.state();
            car.step(pedals(0.0, 0.003), 0.8, DT);
            let after = car.state();
            let seen = before.pose().to_local(after.position) / DT;
            let mean = 0.5 * (before.velocity + after.velocity);
            assert!((seen - mean).norm() < 0.06, "{} at {i}: {seen} {mean}", model.name());
        }
        assert!(car.state().travelled > 500.0);
    }
}

#[test]
fn inputs_that_are_no_numbers_leave_a_state_that_is_none_and_stays_none() {
    let inputs = [
        (pedals(f64::NAN, 0.0), 0.8, DT),
        (pedals(0.0, f64::NAN), 0.8, DT),
        (pedals(1.0, 0.0), f64::NAN, DT),
        (pedals(1.0, 0.0), f64::INFINITY, DT),
        (pedals(1.0, 0.0), -0.1, DT),
        (pedals(1.0, 0.0), 0.8, 0.0),
    ];
    for (model, (input, friction, dt)) in Model::ALL.into_iter().flat_map(|model| inputs.map(|input| (model, input))) {
        let mut car = model.build(&CAR, ORIGIN, 10.0);
        car.step(pedals(0.0, 0.1), 0.8, DT);
        assert!(car.state().is_finite());
        for _ in 0..2 {
            car.step(input, friction, dt);
            assert!(!car.state().is_finite(), "{} {input:?} {friction} {dt}", model.name());
        }
        car.step(pedals(0.0, 0.0), 0.8, DT);
        assert!(!car.state().is_finite());
        car.wheels();
    }
}

#[test]
fn on_a_road_without_friction_nothing_changes_the_motion() {
    for model in Model::ALL {
        let mut car = model.build(&CAR, ORIGIN, 10.0);
        for i in 0..300 {
            car.step(pedals(if i < 150 { 1.0 } else { -1.0 }, 0.5), 0.0, DT);
        }
        let state = car.state();
        assert!((state.velocity - Vector2::new(10.0, 0.0)).norm() < 0.01, "{} {state:?}", model.name());
        assert!(state.position.y.abs() < 0.05);
    }
}

#[test]
fn wheels_report_what_they_carry_and_how_they_slip() {
    for model in Model::ALL {
        let mut car = model.build(&CAR, ORIGIN, 30.0);
        for _ in 0..150 {
            car.step(pedals(-1.0, 0.0), 0.8, DT);
        }
        let wheels = car.wheels();
        let total: f64 = wheels.iter().map(|wheel| wheel.load).sum();
        assert!((total / (CAR.mass * GRAVITY) - 1.0).abs() < 0.02, "{} {wheels:?}", model.name());
        assert!(wheels.iter().all(|wheel| wheel.contact));
        assert!(wheels[0].load > 1.5 * wheels[2].load, "{} {wheels:?}", model.name());
        // Full brakes hold a brush tyre near the slip at which it begins to slide: 3 mu / C = 0.11.
        assert!(wheels.iter().all(|wheel| (-0.12..-0.03).contains(&wheel.slip_ratio)), "{} {wheels:?}", model.name());

        let mut car = model.build(&CAR, ORIGIN, 15.0);
        bend(car.as_mut(), 0.06, 15.0, 0.8, 5.0);
        let wheels = car.wheels();
        assert!(wheels.iter().all(|wheel| (-0.09..-0.02).contains(&wheel.slip_angle)), "{} {wheels:?}", model.name());
        if model == Model::Jointed {
            assert!(wheels[0].load < wheels[1].load && wheels[2].load < wheels[3].load, "{wheels:?}");
        }
    }
}

#[test]
fn a_jointed_car_that_tips_over_has_no_state() {
    let mut car = Jointed::new(&CAR, ORIGIN, 30.0);
    for _ in 0..500 {
        car.step(pedals(0.0, 1.0), 3.0, DT);
    }
    assert!(!car.state().is_finite());
}

#[test]
fn a_step_of_the_single_track_allocates_nothing() {
    let mut car = SingleTrack::new(&CAR, ORIGIN, 30.0);
    let counted = allocation_counter::measure(|| {
        car.step(pedals(0.5, 0.0), 0.8, DT);
        car.step(pedals(-0.5, 0.1), 0.8, DT);
    });
    assert_eq!(counted.count_total, 0);
}

/// Of the motion in the plane, in joules.
fn energy(state: &VehicleState) -> f64 {
    let centre = state.velocity + Vector2::new(0.0, CAR.ahead() * state.yaw_rate);
    0.5 * (CAR.mass * centre.norm_squared() + CAR.yaw_inertia * state.yaw_rate * state.yaw_rate)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, ..ProptestConfig::default() })]

    #[test]
    fn whatever_the_feet_and_hands_do_the_car_stays_sane(
        speed in 0.0..50.0_f64,
        friction in 0.0..0.9_f64,
        dt in 0.002..0.03_f64,
        inputs in prop::collection::vec((-1.5..1.5_f64, -1.5..1.5_f64), 1..8),
    ) {
        for model in Model::ALL {
            let mut car = model.build(&CAR, ORIGIN, speed);
            for (throttle, steering) in &inputs {
                let before = energy(car.state());
                for _ in 0..(1.0 / dt) as usize {
                    car.step(pedals(*throttle, *steering), friction, dt);
                    prop_assert!(car.state().is_finite(), "{}", model.name());
                }
                let after = energy(car.state());
                // What the body has by rolling and pitching comes back.
                let rocking = 0.02 * before + 500.0;
                prop_assert!(*throttle > 0.0 || after < before + rocking, "{} {before} J, {after} J", model.name());
                prop_assert!(car.state().speed() < 52.0, "{} {:?}", model.name(), car.state());
                let total: f64 = car.wheels().iter().map(|wheel| wheel.load).sum();
                prop_assert!(total < 3.0 * CAR.mass * GRAVITY, "{} {:?}", model.name(), car.wheels());
            }
        }
    }
}
