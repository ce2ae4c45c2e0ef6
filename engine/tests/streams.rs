//! Streams as scenarios use them: feedback, cycles, signals, and the graph as a picture.

use paracosm_engine::vehicle::VehicleModel;
use paracosm_engine::{AutonomousVehicle, Car, Pedestrian, Program, RoadSegment, Scenario, Side, Stream, Test};
use paracosm_engine::{driver, eventually, never, simulate};
use paracosm_space::{Domain, Parameter, Shape, Space, Value, Values};
use std::cell::RefCell;

/// A car that rolls along for a second.
fn rolling(s: &mut Scenario) -> Car {
    let road = s.place(RoadSegment::new(200.0));
    s.duration(1.0);
    s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(10.0))
}

/// What a stream was at every tick of a run. A function pointer cannot carry it out, so that it goes by this thread.
fn record(s: &mut Scenario, stream: &Stream<f64>) {
    SEEN.take();
    s.place(stream.for_each(|value| SEEN.with_borrow_mut(|seen| seen.push(value))));
}

thread_local! {
    static SEEN: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
}

fn run<'a>(build: fn(&mut Scenario), test: impl Into<Test<'a>>) -> Result<Vec<f64>, String> {
    let program = Program::new("streams", "streams", build);
    let mut driver = driver::find("cruise").unwrap().build(&[]).unwrap();
    let outcome = simulate(&program, test, VehicleModel::SingleTrack, driver.as_mut());
    outcome.ending.message().map_or_else(|| Ok(SEEN.take()), Err)
}

fn refusal(build: fn(&mut Scenario)) -> String {
    let program = Program::new("streams", "streams", build);
    program.declare().expect_err("it is refused").to_string()
}

#[test]
fn feedback_through_pre_counts() {
    let counted = run(
        |s| {
            rolling(s);
            let count = s.forward("count");
            count.define(count.pre().initially(0.0) + 1.0);
            record(s, &count);
        },
        &Values::default(),
    );
    assert_eq!(counted.unwrap(), (1..=101).map(f64::from).collect::<Vec<_>>());
}

#[test]
fn two_streams_that_feed_each_other_a_tick_later_are_no_cycle() {
    let fibonacci = run(
        |s| {
            rolling(s);
            let (a, b) = (s.forward("a"), s.forward("b"));
            a.define(b.pre().initially(1.0));
            b.define(a.pre().initially(0.0) + b.pre().initially(1.0));
            record(s, &a);
        },
        &Values::default(),
    );
    assert_eq!(fibonacci.unwrap()[..8], [1.0, 1.0, 2.0, 3.0, 5.0, 8.0, 13.0, 21.0]);
}

#[test]
fn a_causal_cycle_is_refused_with_the_names_on_it() {
    let cycle = refusal(|s| {
        let car = rolling(s);
        let demand = s.forward("demand");
        let limited = demand.min(car.speed()).named("limited");
        demand.define(limited.map(|speed| 0.5 * speed) + 1.0);
        s.require("fast", eventually(limited.at_least(0.0)));
    });
    let expected = "a stream depends on its own value at the same tick: \
        `map` -> `+` -> `demand` -> `min` -> `limited` -> `map`; put a `pre` on this cycle";
    assert!(cycle.contains(expected), "{cycle}");
}

#[test]
fn a_cycle_that_nobody_reads_is_refused_as_well() {
    let cycle = refusal(|s| {
        rolling(s);
        let itself = s.forward::<f64>("itself");
        itself.define(&*itself);
    });
    assert!(cycle.contains("`itself` -> `itself`"), "{cycle}");
}

#[test]
fn a_stream_that_is_announced_is_to_be_defined_once() {
    let missing = refusal(|s| {
        rolling(s);
        let gap = s.forward::<f64>("gap");
        s.require("gap", never(gap.below(1.0)));
    });
    assert!(missing.contains("the stream `gap` is read, but nothing defines it; call `define` on it"), "{missing}");
    let twice = refusal(|s| {
        rolling(s);
        let gap = s.forward("gap");
        gap.define(1.0);
        gap.define(2.0);
    });
    assert!(twice.contains("the stream `gap` is defined twice"), "{twice}");
}

/// The way of the car as the paper's DistanceMonitor adds it up.
fn distance_monitor(s: &mut Scenario) {
    let car = rolling(s);
    let old = car.position().take(1).concat(&car.position().pre());
    let way = car.position().zip(&old).map(|(new, old)| (new - old).norm()).sum();
    record(s, &(way - car.travelled()));
}

#[test]
fn the_distance_monitor_of_the_paper_measures_the_way() {
    let difference = run(distance_monitor, &Values::default()).unwrap();
    assert_eq!(difference.len(), 101);
    assert!(difference.iter().all(|difference| difference.abs() < 1e-9), "{difference:?}");
}

/// A parameter as it is: what varies is for the test to say.
fn friction(s: &mut Scenario) {
    let friction = s.interval("friction", 0.0..=1.0);
    let road = s.place(RoadSegment::new(200.0).friction(&friction));
    s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(10.0));
    s.duration(1.0);
    record(s, &friction.into());
}

fn varying(shape: Option<Shape>, value: Value) -> Result<Vec<f64>, String> {
    let mut parameter = Parameter::new("friction", Domain::Interval { lo: 0.0, hi: 1.0 });
    parameter.signal = shape;
    let space = Space::new(vec![parameter]).unwrap();
    let values = [("friction".to_owned(), value)].into_iter().collect();
    run(friction, Test::new(&values, &space))
}

#[test]
fn a_parameter_is_a_constant_or_a_signal_as_the_test_says() {
    assert_eq!(varying(None, 0.5.into()).unwrap(), [0.5; 101]);
    let linear = varying(Some(Shape::PiecewiseLinear { pieces: 2 }), [0.0, 1.0, 0.5].into()).unwrap();
    assert_eq!([0, 25, 50, 75, 100].map(|tick| linear[tick]), [0.0, 0.5, 1.0, 0.75, 0.5]);
    let steps =
        varying(Some(Shape::PiecewiseConstant { pieces: 100 }), (0..100).map(|i| 0.01 * f64::from(i)).collect());
    let expected: Vec<f64> = (0..=100).map(|tick| 0.01 * f64::from(tick.min(99))).collect();
    assert_eq!(steps.unwrap(), expected, "with as many pieces as ticks every tick has a value of its own");
    assert_eq!(varying(Some(Shape::Polynomial { degree: 3 }), 0.3.into()).unwrap(), [0.3; 101]);
}

#[test]
fn values_that_do_not_make_the_signal_are_refused() {
    let error = varying(Some(Shape::PiecewiseLinear { pieces: 2 }), [0.0, 1.0].into()).unwrap_err();
    assert!(
        error.contains("the number of values of parameter `friction` is 2, expected 3 for a piecewise-linear(2)"),
        "{error}"
    );
    let error = varying(None, [0.0, 1.0].into()).unwrap_err();
    assert!(error.contains("does not vary over time"), "{error}");
}

/// A signal that the program asks for, and words that vary.
fn declared(s: &mut Scenario) {
    rolling(s);
    let per_tick = s.per_tick();
    let light = s.interval("light", 0.0..=1.0).signal(per_tick);
    let weather = s.choice("weather", ["clear", "rain", "fog"]).signal(Shape::PiecewiseConstant { pieces: 2 });
    let weather = Stream::from(&weather);
    let seen = Stream::from(light).when(&weather.equals("fog")).merge(&Stream::constant(-1.0));
    record(s, &seen);
}

#[test]
fn a_parameter_has_the_operators_and_the_methods_of_streams() {
    let seen = run(
        |s| {
            rolling(s);
            let speed = s.interval("speed", 1.0..=6.0).default(2.0);
            let sum: Stream<f64> = &speed + 1.0 - (-&speed) * 2.0 / &speed + 3.0 * &speed;
            // A method of streams, and a parameter where a reference to a stream is expected.
            let fast = sum.when(&speed.at_least(3.0));
            record(s, &fast.merge(&sum.when(&speed)));
        },
        &[("speed", Value::Number(2.0))].into_iter().collect::<Values>(),
    );
    assert_eq!(seen.unwrap().first(), Some(&11.0));
}

#[test]
fn a_program_declares_signals_and_reads_them_as_any_parameter() {
    let program = Program::new("streams", "streams", declared);
    let declaration = program.declare().unwrap();
    let signals: Vec<_> = declaration.parameters.iter().map(|declared| declared.parameter.signal).collect();
    assert_eq!(signals, [100, 2].map(|pieces| Some(Shape::PiecewiseConstant { pieces })));
    let mut test = declaration.nominal();
    test.set("light", (0..100).map(f64::from).map(|i| i / 100.0).collect::<Value>());
    test.set("weather", ["rain", "fog"]);
    let seen = run(declared, &test).unwrap();
    assert_eq!(seen[49..53], [-1.0, 0.5, 0.51, 0.52]);
    test.set("weather", "fog");
    assert_eq!(run(declared, &test).unwrap()[..3], [0.0, 0.01, 0.02], "one value stands for all");
}

#[test]
fn a_shape_that_does_not_suit_its_parameter_is_refused_in_every_run() {
    fn build(s: &mut Scenario) {
        rolling(s);
        let weather = s.choice("weather", ["clear", "fog"]).signal(Shape::Polynomial { degree: 2 });
        let light = s.interval("light", 0.0..=1.0).signal(Shape::PiecewiseConstant { pieces: 0 });
        record(s, &Stream::from(light).when(&Stream::from(weather).equals("fog")));
    }
    let test = [("weather".to_owned(), "fog".into()), ("light".to_owned(), 0.5.into())].into_iter().collect();
    let error = run(build, &test).unwrap_err();
    assert!(error.contains("`weather`: found a signal of the shape polynomial(2) for a choice"), "{error}");
    assert!(error.contains("`light`: the signal piecewise-constant(0) has 0 coordinates"), "{error}");
}

#[test]
fn the_structure_of_a_world_does_not_vary_over_time() {
    let refused = refusal(|s| {
        rolling(s);
        let lanes = s.choice("lanes", [2, 4]).signal(Shape::PiecewiseConstant { pieces: 3 });
        assert_eq!(lanes.value(), 2);
    });
    assert!(refused.contains("parameter `lanes` varies over time"), "{refused}");
}

#[test]
fn a_comparison_of_two_streams_is_worth_their_difference() {
    fn build(s: &mut Scenario) {
        let car = rolling(s);
        let limit = s.interval("limit", 0.0..=20.0).signal(Shape::PiecewiseLinear { pieces: 1 });
        s.require("limit", never(car.speed().above(limit)));
    }
    let program = Program::new("streams", "streams", build);
    let mut driver = driver::find("cruise").unwrap().build(&[]).unwrap();
    let mut test = Values::default();
    test.set("limit", [12.0, 11.0]);
    let outcome = simulate(&program, &test, VehicleModel::SingleTrack, driver.as_mut());
    assert!((outcome.judgements[0].robustness.unwrap() - 1.0).abs() < 1e-9, "{:?}", outcome.judgements);
}

#[test]
fn streams_that_a_trace_could_not_tell_apart_are_refused() {
    let closures = refusal(|s| {
        let car = rolling(s);
        s.require("slow", never(car.speed().map(|speed| speed).above(50.0)));
        s.require("near", never(car.speed().map(|speed| speed * speed).above(900.0)));
    });
    assert!(closures.contains("are called `map(car.speed)`: give them different names by `named`"), "{closures}");
    let output = refusal(|s| {
        let car = rolling(s);
        s.require("slow", never((car.speed() * 3.6).named("car.speed").above(50.0)));
    });
    assert!(output.contains("a stream of a requirement is called `car.speed`"), "{output}");
    let fine: fn(&mut Scenario) = |s| {
        let car = rolling(s);
        let squared = car.speed().map(|speed| speed * speed);
        s.require("slow", never(squared.above(900.0)));
        s.require("fast", never(squared.below(25.0)));
        s.require("double", never((car.speed() * 2.0).below(5.0)));
        s.require("half", never((car.speed() * 2.0).above(60.0)));
        s.require("other", never(car.speed().map(|speed| speed).named("other").above(50.0)));
    };
    let declaration = Program::new("streams", "streams", fine).declare().unwrap();
    assert_eq!(declaration.requirements.len(), 5);
}

#[test]
fn the_graph_is_drawn_in_dot() {
    fn build(s: &mut Scenario) {
        let speed = s.interval("speed", 1.0..=5.0).default(2.0);
        let road = s.place(RoadSegment::new(200.0));
        let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)));
        let walker = s.place(Pedestrian::at(road.on_sidewalk(Side::Left, 100.0)));
        let near = car.gap_along(&road.crossing(100.0)).below(30.0).named("near");
        let count = s.forward("count");
        count.define(count.pre().initially(0.0) + 1.0);
        walker.walk(road.on_sidewalk(Side::Right, 100.0), speed).skip_until(&near);
        s.require("late", never(count.above(1e9)));
    }
    let dot = Program::new("a \"picture\"", "", build).dot().unwrap();
    let expected = r#"digraph "a \"picture\"" {
  rankdir=LR;
  n0 [label="0.8", shape=plaintext];
  n1 [label="speed = 2", shape=ellipse];
  n2 [label="car.position", shape=box];
  n3 [label="distance to crossing(100)", shape=plaintext];
  n4 [label="2.254", shape=plaintext];
  n5 [label="-", shape=plaintext];
  n6 [label="30", shape=plaintext];
  n7 [label="near = <", shape=plaintext];
  n8 [label="skip_until", shape=plaintext];
  n9 [label="0", shape=plaintext];
  n10 [label="take 1", shape=plaintext];
  n11 [label="pre", shape=plaintext];
  n12 [label="concat", shape=plaintext];
  n13 [label="1", shape=plaintext];
  n14 [label="count = +", shape=plaintext];
  n2 -> n3;
  n3 -> n5 [headlabel=1];
  n4 -> n5 [headlabel=2];
  n5 -> n7 [headlabel=1];
  n6 -> n7 [headlabel=2];
  n1 -> n8 [headlabel=1];
  n7 -> n8 [headlabel=2];
  n9 -> n10;
  n14 -> n11 [style=dashed];
  n10 -> n12 [headlabel=1];
  n11 -> n12 [headlabel=2];
  n12 -> n14;
  n13 -> n14;
  r0 [label="road.friction", shape=box, style=bold];
  n0 -> r0;
  r1 [label="pedestrian.speed", shape=box, style=bold];
  n8 -> r1;
  r2 [label="late", shape=box, style=bold];
  n14 -> r2;
}
"#;
    assert_eq!(dot, expected, "{dot}");
}
