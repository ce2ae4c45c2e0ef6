//! The robustness of a collision, recomputed from the trace that the run left behind.

use paracosm_engine::vehicle::VehicleModel;
use paracosm_engine::{Outcome, Program, driver, simulate};
use paracosm_oracles::Verdict;
use paracosm_scenarios::find;
use paracosm_space::{Value, Values};

/// The acceleration of gravity in m/s².
const GRAVITY: f64 = 9.80665;

fn run(program: &Program, changes: &[(&str, f64)]) -> Outcome {
    let mut test: Values = program.declare().unwrap().nominal();
    for (name, value) in changes {
        test.set(*name, Value::Number(*value));
    }
    simulate(program, &test, VehicleModel::SingleTrack, driver::find("aeb").unwrap().build(&[]).unwrap().as_mut())
}

/// The velocity of an object during the last tick, from its last two positions.
fn velocity(outcome: &Outcome, name: &str) -> [f64; 2] {
    let trace = outcome.trace.as_ref().unwrap();
    ["x", "y"].map(|axis| {
        let positions: Vec<f64> = trace.signal(&format!("{name}.{axis}")).unwrap().collect();
        let [.., before, last] = positions[..] else { panic!("one sample") };
        (last - before) / trace.dt()
    })
}

/// The distance that full braking takes for the speed at which the car and the object close along the heading of the
/// car: max(0, v)² / (2 μ g), at least 0.001 m.
fn missing_distance(outcome: &Outcome, other: &str, friction: f64) -> f64 {
    let last = |name| outcome.trace.as_ref().unwrap().signal(name).unwrap().last().unwrap();
    let (sin, cos) = libm::sincos(last("car.heading"));
    let ahead = |velocity: [f64; 2]| velocity[0] * cos + velocity[1] * sin;
    // The car may brake, so that its speed at the end of the tick is another than its speed during the tick.
    let during = velocity(outcome, "car");
    let car = last("car.speed") * ahead(during) / libm::hypot(during[0], during[1]);
    let closing = car - ahead(velocity(outcome, other));
    let closing = closing.max(0.0);
    (closing * closing / (2.0 * friction * GRAVITY)).max(0.001)
}

/// Checks all collisions among tests of a scenario, and returns their number.
fn check(scenario: &str, friction: f64, tests: impl Iterator<Item = Vec<(&'static str, f64)>>) -> usize {
    let program = find(scenario).unwrap();
    let mut collisions = 0;
    for test in tests {
        let outcome = run(program, &test);
        let Some(contact) = outcome.measured.as_ref().and_then(|measured| measured.contact.as_ref()) else { continue };
        let robustness = outcome.trace.as_ref().unwrap().signal("car.clearance").unwrap().last().unwrap();
        let expected = -missing_distance(&outcome, &contact.with, friction);
        assert!(
            (robustness - expected).abs() <= 0.01 * expected.abs(),
            "{scenario}, {test:?}: {robustness} m, expected {expected} m"
        );
        collisions += 1;
    }
    collisions
}

#[test]
fn no_collision_with_a_pedestrian_counts_the_speed_of_the_pedestrian_across_the_road() {
    for friction in [0.8, 0.4] {
        let grid = (0..20).flat_map(|i| (0..20).map(move |j| (0.5 + 0.5 * f64::from(i), 5.0 + 2.9 * f64::from(j))));
        let test = |(speed, distance)| vec![("speed", speed), ("distance", distance), ("friction", friction)];
        let collisions = check("pedestrian-crossing", friction, grid.map(test));
        assert!(collisions > 30, "{collisions} collisions at friction {friction}");
    }
}

#[test]
fn a_pedestrian_from_the_near_side_walks_the_other_way_and_is_met_as_well() {
    let program = find("pedestrian-crossing").unwrap();
    let mut test: Values = program.declare().unwrap().nominal();
    let walk = |test: &Values| {
        let mut driver = driver::find("cruise").unwrap().build(&[]).unwrap();
        let outcome = simulate(program, test, VehicleModel::SingleTrack, driver.as_mut());
        let y: Vec<f64> = outcome.trace.as_ref().unwrap().signal("pedestrian.y").unwrap().collect();
        (y[0], *y.last().unwrap())
    };
    test.set("distance", Value::Number(60.0));
    test.set("speed", Value::Number(8.0));
    let far = walk(&test);
    test.set("side", Value::Word("near".to_owned()));
    let near = walk(&test);
    assert!(far.0 > 0.0 && far.1 < 0.0 && near.0 == far.1 && near.1 == far.0, "{far:?} {near:?}");
}

#[test]
fn from_the_near_side_slow_pedestrians_are_hit_more_often_and_from_the_far_side_fast_ones() {
    let program = find("pedestrian-crossing").unwrap();
    // The share of tests that fail, with slow and with fast pedestrians.
    let failing = |side: &str| {
        [1.5, 8.0].map(|speed| {
            let fails = (0..40).filter(|i| {
                let mut test: Values = program.declare().unwrap().nominal();
                test.set("side", Value::Word(side.to_owned()));
                test.set("speed", Value::Number(speed));
                test.set("distance", Value::Number(5.0 + 55.0 * (f64::from(*i) + 0.5) / 40.0));
                let mut driver = driver::find("aeb").unwrap().build(&[]).unwrap();
                simulate(program, &test, VehicleModel::SingleTrack, driver.as_mut()).verdict() == Verdict::Fail
            });
            fails.count()
        })
    };
    let ([slow, fast], [slow_near, fast_near]) = (failing("far"), failing("near"));
    assert!(slow < fast, "far side: {slow} slow, {fast} fast");
    assert!(slow_near > fast_near, "near side: {slow_near} slow, {fast_near} fast");
}

#[test]
fn a_collision_with_a_car_counts_the_speed_at_which_the_cars_close() {
    let gaps = (0..20).map(|i| vec![("gap", 2.0 * f64::from(i)), ("relative_speed", -40.0), ("ego_speed", 60.0)]);
    let collisions = check("cut-in", 0.8, gaps);
    assert!(collisions > 3, "{collisions} collisions");
}
