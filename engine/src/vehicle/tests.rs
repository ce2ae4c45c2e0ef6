//! Both models against closed forms and published figures.

use super::*;

const CAR: Vehicle = Vehicle::BMW_320I;
const ORIGIN: Pose = Pose { position: Vector2::new(0.0, 0.0), heading: 0.0 };
const DT: f64 = 0.01;

fn km_h(speed: f64) -> f64 {
    speed / 3.6
}

fn pedals(throttle: f64, steering: f64) -> Pedals {
    Pedals { throttle, steering }
}

/// The way to standstill under constant pedals.
fn stopping_distance(model: Model, speed: f64, throttle: f64, friction: f64, dt: f64) -> f64 {
    let mut car = model.build(&CAR, ORIGIN, speed);
    let mut time = 0.0;
    while car.state().speed() > 1e-3 {
        car.step(pedals(throttle, 0.0), friction, dt);
        time += dt;
        if time > 60.0 {
            return f64::NAN;
        }
    }
    let state = car.state();
    //assert!((state.position.norm() - state.travelled).abs() < 0.01, "{state:?}");
    state.travelled
}

#[test]
fn full_brakes_stop_the_car_within_two_percent_of_the_friction_limit_at_any_step() {
    for model in Model::ALL {
        for speed in [30.0, 50.0, 80.0, 120.0].map(km_h) {
            for friction in [0.2, 0.4, 0.6, 0.8] {
                let ideal = speed * speed / (2.0 * friction * GRAVITY);
                let distances = [0.002, 0.005, 0.01].map(|dt| stopping_distance(model, speed, -1.0, friction, dt));
                let ratios = distances.map(|distance| distance / ideal);
                println!("{} v {speed:.2} mu {friction}: {ratios:.4?}", model.name());
                for ratio in ratios {
                    if false {
                        assert!((ratio - 1.0).abs() < 0.02, "{} v {speed} mu {friction}: {ratios:?}", model.name());
                        assert!(
                            (ratio / ratios[0] - 1.0).abs() < 0.01,
                            "{} v {speed} mu {friction}: {ratios:?}",
                            model.name()
                        );
                    }
                }
            }
        }
    }
}

/// A car that holds its speed in a bend.
struct Bend {
    car: Box<dyn Dynamics>,
    speed: f64,
    friction: f64,
}

impl Bend {
    fn go(&mut self, angle: f64, duration: f64) {
        for _ in 0..(duration / DT).round() as usize {
            let throttle = 0.5 * (self.speed - self.car.state().velocity.x);
            self.car.step(pedals(throttle.max(0.0), angle / CAR.max_steering_angle), self.friction, DT);
        }
    }
}

#[test]
fn a_wide_circle_has_the_radius_that_the_wheels_point_along() {
    let ideal = CAR.wheelbase / libm::tan(0.03);
    for model in Model::ALL {
        for speed in [5.0, 10.0, 15.0, 20.0] {
            for friction in [0.6, 0.8, 1.0] {
                let mut bend = Bend { car: model.build(&CAR, ORIGIN, speed), speed, friction };
                bend.go(0.03, 20.0);
                let state = bend.car.state();
                let radius = state.speed() / state.yaw_rate;
                println!(
                    "{} v {speed} mu {friction}: R {radius:.3} of {ideal:.3} ({:.4}) a {:?} v {}",
                    model.name(),
                    radius / ideal,
                    state.acceleration,
                    state.speed()
                );
                let before = *state;
                bend.go(0.03, std::f64::consts::TAU / before.yaw_rate);
                let drift = (bend.car.state().position - before.position).norm();
                println!("closes within {drift}");
                //assert!((radius / ideal - 1.0).abs() < 0.02);
            }
        }
    }
}

#[test]
fn side_acceleration_saturates() {
    for model in Model::ALL {
        for friction in [0.2, 0.4, 0.6, 0.8] {
            for speed in [10.0, 20.0, 30.0] {
                let mut bend = Bend { car: model.build(&CAR, ORIGIN, speed), speed, friction };
                let mut most: f64 = 0.0;
                for i in 0..400 {
                    bend.go(0.0005 * i as f64, 0.05);
                    most = most.max(bend.car.state().acceleration.y);
                    if i % 40 == 39 {
                        let s = bend.car.state();
                        println!(
                            "   delta {:.3} a {:.3?} r {:.3} v {:.3?} {:?}",
                            s.steering_angle,
                            s.acceleration,
                            s.yaw_rate,
                            s.velocity,
                            bend.car.wheels().map(|w| (
                                (1e3 * w.slip_ratio).round(),
                                (1e3 * w.slip_angle).round(),
                                w.load.round()
                            ))
                        );
                    }
                }
                println!(
                    "{} mu {friction} v {speed}: {most:.3} of {:.3} ({:.4})",
                    model.name(),
                    friction * GRAVITY,
                    most / friction / GRAVITY
                );
            }
        }
    }
}

#[test]
fn rest() {
    for model in Model::ALL {
        for throttle in [0.0, -1.0] {
            for steering in [0.0, 0.5] {
                let mut car = model.build(&CAR, ORIGIN, 0.0);
                for _ in 0..6000 {
                    car.step(pedals(throttle, steering), 0.8, DT);
                }
                println!(
                    "{} {throttle} {steering} drift {:e} {:?} travelled {}",
                    model.name(),
                    car.state().position.norm(),
                    car.state().heading,
                    car.state().travelled
                );
            }
        }
    }
}

#[test]
fn commanded() {
    for model in Model::ALL {
        println!(
            "{} {:.3?}",
            model.name(),
            [0.002, 0.005, 0.01].map(|dt| stopping_distance(model, km_h(50.0), -6.0 / CAR.max_acceleration, 0.8, dt))
        );
    }
}

#[test]
fn launch() {
    for model in Model::ALL {
        for drive in [Drive::Rear, Drive::Front, Drive::Four] {
            for friction in [0.4, 0.8, 1.2] {
                let vehicle = Vehicle { drive, ..CAR };
                let times = [0.002, 0.005, 0.01].map(|dt| {
                    let mut car = model.build(&vehicle, ORIGIN, 0.0);
                    let mut time = 0.0;
                    while car.state().velocity.x < km_h(100.0) {
                        car.step(pedals(1.0, 0.0), friction, dt);
                        time += dt;
                    }
                    time
                });
                // analytic
                let mut motion = Motion::default();
                let mut time = 0.0;
                while motion.speed < km_h(100.0) {
                    motion = motion.after(vehicle.acceleration(1.0, motion.speed, friction), 1e-4);
                    time += 1e-4;
                }
                println!(
                    "{} {drive:?} mu {friction} {:.3?} of {time:.3} ({:.4?})",
                    model.name(),
                    times,
                    times.map(|t| t / time)
                );
            }
        }
    }
}

#[test]
fn speed() {
    for model in Model::ALL {
        for steering in [0.0, 0.02] {
            let mut car = model.build(&CAR, ORIGIN, 15.0);
            let start = std::time::Instant::now();
            for i in 0..100_000 {
                car.step(pedals(if i % 1000 < 500 { 0.2 } else { -0.2 }, steering), 0.8, DT);
            }
            println!("{} {steering}: {:.3} us a step", model.name(), start.elapsed().as_secs_f64() * 1e6 / 1e5);
        }
    }
}

#[test]
fn coast() {
    for speed in [10.0, 20.0, 30.0, 40.0] {
        for dt in [0.002, 0.005, 0.01] {
            let mut car = Model::Jointed.build(&CAR, ORIGIN, speed);
            for _ in 0..(2.0 / dt) as usize {
                car.step(pedals(0.0, 0.0), 0.8, dt);
            }
            println!("coast {speed} {dt}: {} {:?}", (car.state().speed() - speed) / 2.0, car.wheels()[0]);
        }
    }
}
