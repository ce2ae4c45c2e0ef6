//! The car of a whole run brakes as the friction of its road allows, at any tick and in any weather.

use paracosm_engine::driver::{Driver, Fault};
use paracosm_engine::{
    AutonomousVehicle, Briefing, Control, Environment, Observation, Outcome, Program, RoadSegment, Run, Scenario,
    Setup, Stream, eventually,
};
use paracosm_space::Values;

/// Puts on the brakes and keeps them on.
struct FullBrakes;

impl Driver for FullBrakes {
    fn period(&self) -> f64 {
        0.05
    }

    fn reset(&mut self, _: &Briefing) -> Result<(), Fault> {
        Ok(())
    }

    fn step(&mut self, _: &Observation) -> Result<Control, Fault> {
        Ok(Control { throttle: -1.0, steering: 0.0 })
    }
}

fn road(s: &mut Scenario) {
    let friction = s.nominal("friction", 0.1..=1.0, 0.8);
    let rain = s.nominal("rain", 0.0..=1.0, 0.0);
    s.place(Environment::new().rain(rain));
    let road = s.place(RoadSegment::new(200.0).friction(friction));
    let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(50.0 / 3.6));
    s.duration(12.0);
    s.require("stops", eventually(car.speed().at_most(0.0)));
}

const PROGRAM: Program = Program::new("brakes", "a car that stops", road);

fn outcome(friction: f64, dt: f64, driver: &mut dyn Driver) -> Outcome {
    in_rain(0.0, friction, dt, driver)
}

fn in_rain(rain: f64, friction: f64, dt: f64, driver: &mut dyn Driver) -> Outcome {
    let mut test = PROGRAM.declare().unwrap().nominal();
    test.set("friction", friction);
    test.set("rain", rain);
    Run::new(&PROGRAM, &test, Setup { dt: Some(dt), ..Setup::asking_every(driver.period()) }).unwrap().drive(driver)
}

fn stopping_distance(friction: f64, dt: f64) -> f64 {
    way(outcome(friction, dt, &mut FullBrakes))
}

fn way(outcome: Outcome) -> f64 {
    let trace = outcome.trace.unwrap();
    trace.signal("car.travelled").unwrap().next_back().unwrap()
}

#[test]
fn full_brakes_from_50_km_h_stop_within_two_percent_of_the_ideal_distance_at_any_tick() {
    let speed: f64 = 50.0 / 3.6;
    for friction in [0.3, 0.8] {
        let ideal = speed * speed / (2.0 * friction * 9.80665);
        let distances = [0.002, 0.005, 0.01].map(|dt| stopping_distance(friction, dt));
        for distance in distances {
            assert!((distance / ideal - 1.0).abs() < 0.02, "mu {friction}: {distance} m, ideal {ideal} m");
            assert!((distance / distances[0] - 1.0).abs() < 0.01, "mu {friction}: {distances:?}");
        }
    }
}

#[test]
fn rain_takes_friction_from_any_road_up_to_three_tenths_and_brakes_need_as_much_more() {
    for friction in [0.3, 0.8] {
        let dry = stopping_distance(friction, 0.01);
        for rain in [0.0, 0.5, 1.0] {
            let wet = way(in_rain(rain, friction, 0.01, &mut FullBrakes));
            let left = 1.0 - 0.3 * rain;
            assert!((wet * left / dry - 1.0).abs() < 0.01, "mu {friction}, rain {rain}: {wet} m for {dry} m");
            assert_eq!(wet, stopping_distance(friction * left, 0.01));
        }
    }
}

#[test]
fn a_control_out_of_range_ends_the_run_with_an_error_that_says_so() {
    struct Wild(f64);
    impl Driver for Wild {
        fn period(&self) -> f64 {
            0.05
        }
        fn reset(&mut self, _: &Briefing) -> Result<(), Fault> {
            Ok(())
        }
        fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
            Ok(Control { throttle: if observation.time < 1.0 { 0.0 } else { self.0 }, steering: 0.0 })
        }
    }
    for throttle in [1.5, f64::NAN] {
        let outcome = outcome(0.8, 0.01, &mut Wild(throttle));
        assert_eq!(outcome.verdict(), paracosm_oracles::Verdict::Error);
        let error = outcome.ending.message().unwrap();
        assert!(error.contains(&throttle.to_string()) && error.contains("1.000 s"), "{error}");
    }
}

#[test]
fn a_test_with_other_parameters_than_the_program_asks_for_is_named() {
    let mut test = PROGRAM.declare().unwrap().nominal();
    test.set("fog", 1.0);
    let Err(error) = Run::new(&PROGRAM, &test, Setup::asking_every(0.05)) else { panic!("it was accepted") };
    assert!(error.to_string().contains("fog"), "{error}");
    let Err(error) = Run::new(&PROGRAM, &Default::default(), Setup::asking_every(0.05)) else {
        panic!("it was accepted")
    };
    assert!(error.to_string().contains("friction"), "{error}");
}

/// Brakes whose driver is slow.
struct Late(f64);

impl Driver for Late {
    fn period(&self) -> f64 {
        FullBrakes.period()
    }

    fn latency(&self) -> f64 {
        self.0
    }

    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault> {
        FullBrakes.reset(briefing)
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        FullBrakes.step(observation)
    }
}

#[test]
fn a_late_driver_brakes_later_by_whole_ticks_and_rolls_until_then() {
    let at_once = outcome(0.8, 0.01, &mut FullBrakes).trace.unwrap();
    // Neither the period nor a multiple of it.
    for latency in [0.0, 0.01, 0.07, 0.33] {
        let late = outcome(0.8, 0.01, &mut Late(latency)).trace.unwrap();
        let ticks = (latency / 0.01).round() as usize;
        let speeds = |trace: &paracosm_oracles::Trace| trace.signal("car.speed").unwrap().collect::<Vec<_>>();
        let (late, at_once) = (speeds(&late), speeds(&at_once));
        assert!(late[..=ticks].iter().all(|speed| *speed == at_once[0]), "{latency} s");
        assert_eq!(late[ticks..], at_once[..at_once.len() - ticks], "{latency} s");
    }
}

/// A road under a sky, in this order or the other, with friction said by the one or the other, in rain that swells.
fn swelling(s: &mut Scenario, sky_first: bool, by_road: bool) {
    let rain = Stream::<()>::tick().scan(0.0, |rain: f64, ()| rain + 0.002);
    let sky = Environment::new().rain(&rain);
    let sky = if by_road { sky } else { sky.friction(0.5) };
    let road = |s: &mut Scenario| match RoadSegment::new(200.0) {
        road if by_road => s.place(road.friction(0.5)),
        road => s.place(road),
    };
    let road = if sky_first {
        s.place(sky);
        road(s)
    } else {
        let road = road(s);
        s.place(sky);
        road
    };
    let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(10.0));
    s.duration(4.0);
    s.require("stops", eventually(car.speed().at_most(0.0)));
    s.require("swells", eventually((rain * 1.0).named("rain").at_least(0.5)));
}

#[test]
fn rain_is_a_stream_and_makes_roads_slippery_in_whatever_order_a_world_is_placed() {
    let stopped = |build: fn(&mut Scenario)| {
        let program = Program::new("rain", "a car that stops in rain", build);
        let mut rains = Vec::new();
        let mut run = Run::new(&program, &Values::default(), Setup::asking_every(0.05)).unwrap();
        let outcome = run.watch(&mut FullBrakes, |run| rains.push((run.time(), run.weather().rain)));
        assert!(rains.len() > 50 && rains.iter().all(|(time, rain)| (rain - 0.2 * time).abs() < 0.003), "{rains:?}");
        outcome.trace.unwrap()
    };
    let first = stopped(|s| swelling(s, true, true));
    // The deceleration is that of the friction which rain leaves: 0.5 g, and less and less.
    let speeds: Vec<f64> = first.signal("car.speed").unwrap().collect();
    let rains: Vec<f64> = first.signal("rain").unwrap().collect();
    for tick in [50, 100, 150] {
        let (found, left) = ((speeds[tick] - speeds[tick + 20]) / 0.2, 1.0 - 0.3 * rains[tick + 10]);
        assert!((found / (0.5 * 9.80665 * left) - 1.0).abs() < 0.01, "{found} m/s² at tick {tick}");
    }
    assert!(stopped(|s| swelling(s, false, true)) == first);
    assert!(stopped(|s| swelling(s, true, false)) == first);
    assert!(stopped(|s| swelling(s, false, false)) == first);
}
