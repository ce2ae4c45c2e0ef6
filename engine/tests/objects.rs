//! Objects as programs place them: people's own, those along paths, those that the physics moves, roads and weather.

use nalgebra::Vector2;
use paracosm_engine::object::{Body, BodyState, Class, Input, InputError, Output, Outputs, Physical, Tick};
use paracosm_engine::road::{CrossIntersection, Path, RoadSegment};
use paracosm_engine::vehicle::VehicleModel;
use paracosm_engine::{
    AutonomousVehicle, Car, ContactMotion, Environment, Face, Fixture, Mover, Outcome, Pedestrian, Place, Pose,
    Program, Road, Run, Scenario, Setup, Side, Stream, Temporal, Weather, always, driver, eventually, never, simulate,
};
use paracosm_oracles::Verdict;
use paracosm_space::Values;

fn run(build: fn(&mut Scenario)) -> Outcome {
    let program = Program::new("objects", "objects", build);
    let mut driver = driver::find("cruise").unwrap().build(&[]).unwrap();
    simulate(&program, &Values::default(), VehicleModel::SingleTrack, driver.as_mut())
}

fn refusal(build: fn(&mut Scenario)) -> String {
    let program = Program::new("objects", "objects", build);
    program.declare().expect_err("it is refused").to_string()
}

/// The samples of a signal.
fn signal(outcome: &Outcome, name: &str) -> Vec<f64> {
    let trace = outcome.trace.as_ref().unwrap_or_else(|| panic!("there is no trace: {:?}", outcome.ending.message()));
    trace.signal(name).unwrap_or_else(|| panic!("no `{name}` in {:?}", trace.signals())).collect()
}

/// A car that rolls along with 10 m/s for 5 s, from x = 10.
fn rolling(s: &mut Scenario) -> (Road, Car) {
    let road = s.place(RoadSegment::new(300.0).lanes(4));
    s.duration(5.0);
    let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(10.0));
    (road, car)
}

#[test]
fn an_actor_follows_its_path_at_the_speed_that_its_input_says_and_stops_at_its_end() {
    let outcome = run(|s| {
        let (road, car) = rolling(s);
        let other = s.place(Mover::car(road.path(2)).starting(280.0).speed(car.speed() * 0.5));
        s.require("there", eventually(other.arrived()));
    });
    assert_eq!(outcome.verdict(), Verdict::Pass, "{:?}", outcome.judgements);
    let (x, speed) = (signal(&outcome, "other.x"), signal(&outcome, "other.speed"));
    assert!((x[0], *x.last().unwrap()) == (280.0, 300.0) && (x[100] - 285.0).abs() < 1e-9);
    assert!((speed[100] - 5.0).abs() < 1e-9 && *speed.last().unwrap() == 0.0);
}

#[test]
fn an_actor_that_changes_lanes_faces_where_it_goes() {
    let outcome = run(|s| {
        let (road, _) = rolling(s);
        let offset = Stream::<()>::tick().scan(0.0, |offset: f64, ()| (offset + 0.01).min(3.5));
        let other = s.place(Mover::car(road.path(2)).starting(50.0).speed(10.0).offset(offset));
        s.require("beside", eventually(other.position().y().at_least(-1.75)));
    });
    assert_eq!(outcome.verdict(), Verdict::Pass, "{:?}", outcome.judgements);
    let y = signal(&outcome, "other.y");
    assert!((y[0] + 5.24).abs() < 1e-9 && (y.last().unwrap() + 1.75).abs() < 1e-9);
}

#[test]
fn an_actor_starts_at_the_first_value_of_its_offset_and_does_not_jump() {
    let outcome = run(|s| {
        let (road, car) = rolling(s);
        let other = s.place(Mover::bicycle(road.path(2)).starting(50.0).speed(3.5).offset(-1.0));
        // It is beside the car's lane from the first tick on.
        s.place(Mover::car(road.path(1)).named("beside").starting(10.0).speed(10.0).offset(3.5));
        s.require("steady", always(other.speed().below(3.6)));
        s.require("clear", never(car.collides()));
    });
    assert_eq!(outcome.verdict(), Verdict::Pass, "{:?}", outcome.judgements);
    let y = signal(&outcome, "bicycle.y");
    assert!(y.iter().all(|y| (y + 6.25).abs() < 1e-9), "{:?}", &y[..3]);
    let speed = signal(&outcome, "bicycle.speed");
    assert!(speed.iter().all(|speed| (speed - 3.5).abs() < 1e-9), "{:?}", &speed[..3]);
    // Two lanes of 3.5 m, and the widths of both cars: the clearance of the first tick is that of the bodies where they start.
    let clearance = signal(&outcome, "car.clearance");
    assert!((clearance[0] - clearance[1]).abs() < 0.1 && clearance[0] > 0.5, "{:?}", &clearance[..3]);
}

#[test]
fn actors_that_overlap_by_their_offsets_cannot_start() {
    let outcome = run(|s| {
        let (road, car) = rolling(s);
        s.place(Mover::car(road.path(2)).starting(10.0).speed(10.0).offset(3.5));
        s.require("clear", never(car.collides()));
    });
    assert_eq!(outcome.verdict(), Verdict::Invalid);
    assert!(outcome.ending.message().unwrap().contains("overlap at the start"), "{:?}", outcome.ending.message());
}

#[test]
fn the_car_collides_with_another_car_by_the_side_that_meets_it() {
    let outcome = run(|s| {
        let (road, car) = rolling(s);
        s.place(Mover::truck(road.path(1)).starting(50.0).speed(2.0));
        s.require("no-collision", never(car.collides()));
    });
    assert_eq!(outcome.verdict(), Verdict::Fail);
    // 40 m less the halves of both, at 8 m/s; what was missing is what stops 8 m/s.
    let clearance = signal(&outcome, "car.clearance");
    assert!((clearance[0] - (40.0 - 5.05 - 2.254)).abs() < 1e-9);
    assert!((outcome.judgements[0].robustness.unwrap() + 64.0 / (2.0 * 0.8 * 9.80665)).abs() < 0.1);
    let measured = outcome.measured.as_ref().expect("it was run");
    let contact = measured.contact.as_ref().expect("they touch");
    assert_eq!((contact.face, contact.with.as_str()), (Face::Front, "truck"));
    assert_eq!((contact.class, contact.motion), (Class::Truck, ContactMotion::Driving));
    assert!((contact.other_speed - 2.0).abs() < 1e-9);
    // The contact is what the violation comes down to, and the last that was recorded.
    let violation = outcome.judgements[0].violation.as_ref().expect("it is violated");
    assert_eq!(violation.time, (clearance.len() - 1) as f64 * 0.01);
    assert_eq!((violation.speed, violation.travelled), (Some(contact.speed), Some(measured.travelled)));
}

#[test]
fn a_violation_without_a_contact_has_its_time_and_place_and_what_holds_has_none() {
    let outcome = run(|s| {
        let (_, car) = rolling(s);
        s.require("slow", always(car.travelled().below(7.0)));
        s.require("far", eventually(car.travelled().at_least(7.0)));
    });
    // It goes on to the end, where it is farthest over the line.
    let travelled = signal(&outcome, "car.travelled");
    let [slow, far] = &outcome.judgements[..] else { panic!("two requirements were stated") };
    let violation = slow.violation.as_ref().expect("it is violated");
    assert_eq!(violation.time, (travelled.len() - 1) as f64 * 0.01);
    assert_eq!(violation.travelled, Some(*travelled.last().unwrap()));
    assert_eq!(far.violation, None);
    assert_eq!(outcome.measured.unwrap().contact, None);
}

/// A ball that is kicked for half a second.
struct Ball {
    at: Pose,
    kick: Stream<f64>,
}

struct Rolling {
    kick: Input<f64>,
    position: Output<Vector2<f64>>,
}

impl Physical for Rolling {
    fn show(&self, body: &BodyState, outputs: &mut Outputs<'_>) {
        outputs.set(&self.position, body.pose.position);
    }

    fn push(&mut self, _: &BodyState, tick: &Tick<'_>) -> Result<Vector2<f64>, InputError> {
        Ok(Vector2::new(0.0, tick.number(&self.kick)?))
    }
}

impl Place for Ball {
    type Handle = Stream<Vector2<f64>>;

    fn place(self, scenario: &mut Scenario) -> Self::Handle {
        let mut draft = scenario.object("ball");
        draft.body(Body::disc(Class::Prop, 0.2, 0.4), self.at);
        let rolling = Rolling { kick: draft.input("kick", self.kick), position: draft.output("position") };
        let position = rolling.position.stream();
        draft.physical(0.5, rolling);
        position
    }
}

#[test]
fn the_physics_moves_what_is_physical() {
    let outcome = run(|s| {
        let (road, car) = rolling(s);
        let kick =
            Stream::<()>::tick().scan(0.0, |time: f64, ()| time + 0.01).map(|time| if time < 0.5 { 4.0 } else { 0.0 });
        let ball = s.place(Ball { at: road.on_sidewalk(Side::Right, 100.0), kick });
        s.require("rolls", eventually((ball.y() + 8.0).named("way").at_least(5.0)));
        s.require("no-collision", never(car.collides()));
    });
    assert_eq!(outcome.verdict(), Verdict::Pass, "{:?} {:?}", outcome.judgements, outcome.ending.message());
    let way = signal(&outcome, "way");
    assert!(way.windows(2).skip(1).all(|pair| pair[1] >= pair[0] - 1e-4), "a ball rolls on");
}

#[test]
fn a_network_is_placed_and_spoken_of_by_its_elements() {
    let outcome = run(|s| {
        let arms = ["one", "two", "three", "four"].map(|arm| RoadSegment::new(100.0).named(format!("arm {arm}")));
        let [one, two, three, four] = arms;
        let crossing = CrossIntersection::new()
            .connect("one", one, "one")
            .connect("two", two, "one")
            .connect("three", three, "one")
            .connect("four", four, "one");
        let streets = s.place(crossing);
        let way = streets.way(("arm three", -1, 90.0), ("arm four", 1, 50.0));
        s.duration(20.0);
        s.place(AutonomousVehicle::at(streets.on_lane("arm one", -1, 50.0)));
        let other = s.place(Mover::bicycle(way).speed(10.0));
        s.require("turns", eventually(other.arrived()));
        s.require("north", eventually(other.position().y().at_least(50.0)));
    });
    assert_eq!(outcome.verdict(), Verdict::Pass, "{:?} {:?}", outcome.judgements, outcome.ending.message());
}

#[test]
fn conditions_are_streams_that_anything_can_read() {
    let outcome = run(|s| {
        rolling(s);
        let falling = Stream::<()>::tick().scan(1.0, |light: f64, ()| light - 0.001);
        let world = s.place(Environment::new().light(&falling).fog(0.2).friction(0.5));
        s.require("dark", always((&world.light - &world.fog).named("sight").above(0.25)));
    });
    assert_eq!(outcome.verdict(), Verdict::Pass, "{:?} {:?}", outcome.judgements, outcome.ending.message());
    assert!((signal(&outcome, "sight")[500] - 0.299).abs() < 1e-9);
}

/// The car rolls, and somebody walks beside the road, at dusk.
fn dusk(s: &mut Scenario) {
    let (road, _) = rolling(s);
    let walker = s.place(Pedestrian::at(road.on_sidewalk(Side::Left, 50.0)));
    walker.walk(road.on_sidewalk(Side::Left, 54.0), 2.0);
    let falling = Stream::<()>::tick().scan(1.0, |light: f64, ()| light - 0.001);
    s.place(Environment::new().light(falling).fog(0.2).sun(0.3, -1.0));
}

#[test]
fn a_run_says_its_weather_and_how_far_bodies_have_come() {
    let program = Program::new("dusk", "dusk", dusk);
    let mut run = Run::new(&program, &Values::default(), Setup::asking_every(0.5)).unwrap();
    let mut driver = driver::find("cruise").unwrap().build(&[]).unwrap();
    let mut ways = Vec::new();
    run.watch(driver.as_mut(), |run| {
        let expected =
            Weather { light: 0.999 - 0.1 * run.time(), fog: 0.2, rain: 0.0, sun_elevation: 0.3, sun_azimuth: -1.0 };
        assert!((run.weather().light - expected.light).abs() < 1e-9);
        assert_eq!(run.weather(), Weather { light: run.weather().light, ..expected });
        ways.push((run.bodies()[0].travelled, run.bodies()[1].travelled));
    });
    // Who has arrived comes no further.
    assert!((ways[2].1 - 2.0).abs() < 1e-9 && (ways[10].1 - 4.0).abs() < 1e-9, "{ways:?}");
    assert!((ways[10].0 - run.bodies()[0].pose.position.x + 10.0).abs() < 0.1, "{ways:?}");
}

#[test]
fn a_pedestrian_becomes_faster_and_slower_with_its_acceleration() {
    let outcome = run(|s| {
        let (road, _) = rolling(s);
        let walker = s.place(Pedestrian::at(road.on_sidewalk(Side::Left, 50.0)).accelerating(2.0));
        // 3 m/s for two seconds, then no wish to walk.
        let wish = Stream::<()>::tick()
            .scan(0.0, |ticks: f64, ()| ticks + 1.0)
            .map(|ticks| if ticks <= 200.0 { 3.0 } else { 0.0 });
        walker.walk(road.on_sidewalk(Side::Left, 150.0), wish);
    });
    let (speed, x) = (signal(&outcome, "pedestrian.speed"), signal(&outcome, "pedestrian.x"));
    // Euler steps of 0.02 m/s: after n of them the pedestrian has walked 0.0001 n (n + 1) metres.
    for (tick, expected) in [(50, 1.0), (100, 2.0), (150, 3.0), (200, 3.0), (250, 2.0), (350, 0.0), (450, 0.0)] {
        assert!((speed[tick] - expected).abs() < 1e-9, "{} m/s at tick {tick}", speed[tick]);
    }
    let sum = |n: f64| 0.0001 * n * (n + 1.0);
    assert!((x[450] - x[0] - (sum(150.0) + 50.0 * 0.03 + sum(149.0))).abs() < 1e-6, "{} m", x[450] - x[0]);
}

#[test]
fn an_acceleration_of_a_pedestrian_that_is_not_above_0_is_refused() {
    for build in [
        |s: &mut Scenario| drop(s.place(Pedestrian::at(Pose::default()).accelerating(0.0))),
        |s: &mut Scenario| drop(s.place(Pedestrian::at(Pose::default()).accelerating(f64::NAN))),
    ] {
        assert!(refusal(build).contains("m/s², expected more than 0 m/s²"));
    }
}

#[test]
fn without_an_environment_it_is_broad_daylight() {
    let program = Program::new("day", "day", |s| drop(rolling(s)));
    let run = Run::new(&program, &Values::default(), Setup::asking_every(0.5)).unwrap();
    assert_eq!(run.weather(), Weather::default());
}

#[test]
fn a_statement_of_several_streams_keeps_its_robustness() {
    let outcome = run(|s| {
        let (_, car) = rolling(s);
        let quick = car.speed().above(7.0) & !car.position().x().above(70.0);
        s.require("quick", always(&quick));
        s.require("still", never(Temporal::from(car.speed().below(4.0)).historically(0.0..=1.0)));
    });
    let robustness: Vec<f64> = outcome.judgements.iter().map(|judgement| judgement.robustness.unwrap()).collect();
    assert!((robustness[0] - 3.0).abs() < 0.5 && (robustness[1] - 6.0).abs() < 0.5, "{robustness:?}");
}

/// A world with a requirement of this scale.
fn slow(s: &mut Scenario, scale: f64) {
    let (_, car) = rolling(s);
    s.require("slow", always(car.speed().below(7.0))).scale(scale);
}

#[test]
fn mistakes_are_named() {
    let twice = refusal(|s| {
        rolling(s);
        s.place(Environment::new().friction(0.3));
        s.place(RoadSegment::new(10.0).friction(0.5));
    });
    assert!(twice.contains("the scenario sets the friction of the roads twice: set it only once"), "{twice}");
    assert!(twice.contains("the number of ego vehicles is 1 and the number of road networks is 2"), "{twice}");
    let beyond = refusal(|s| {
        let (road, _) = rolling(s);
        s.place(Mover::car(road.path(1)).starting(400.0));
        s.place(Fixture::tree(road.on_lane(7, 10.0)));
    });
    assert!(
        beyond.contains("other starts 400 m along a path of 300 m, expected a start from 0 to this length"),
        "{beyond}"
    );
    assert!(beyond.contains("`road` has no lane 7; it has 1 to 2 and -1 to -2"), "{beyond}");
    let scaled =
        [(|s| slow(s, 0.0)) as fn(&mut Scenario), |s| slow(s, -5.0), |s| slow(s, f64::NAN), |s| slow(s, f64::INFINITY)];
    for (build, scale) in scaled.into_iter().zip(["0", "-5", "NaN", "inf"]) {
        let says = format!("the scale of requirement `slow` is {scale}, expected a number above 0");
        assert!(refusal(build).contains(&says), "{}", refusal(build));
    }
    let flat = refusal(|s| {
        let (road, _) = rolling(s);
        s.place(Fixture::new("sheet", Body::block(Class::Prop, 1.0, 0.0, 1.0), road.on_lane(2, 10.0)));
    });
    assert!(flat.contains("sheet is 1 m long, 0 m wide and 1 m tall"), "{flat}");
}

#[test]
fn what_is_no_number_is_a_mistake_and_no_panic() {
    let paths = refusal(|s| {
        let (road, _) = rolling(s);
        let here = Vector2::new(0.0, 30.0);
        s.place(Mover::car(Path::straight(here, Vector2::new(f64::NAN, 0.0))));
        s.place(Mover::truck(road.path(1)).starting(f64::NAN));
        s.duration(1e12);
    });
    assert!(paths.contains("other has a path with a piece of NaN m"), "{paths}");
    assert!(paths.contains("truck starts NaN m along"), "{paths}");
    assert!(
        paths.contains(
            "a run has 100000000000000 ticks, expected at most 10000000: make the run shorter or its ticks longer"
        ),
        "{paths}"
    );
    let car = refusal(|s| {
        let road = s.place(RoadSegment::new(100.0));
        let nowhere = Pose { position: Vector2::new(f64::NAN, 0.0), ..road.on_lane(1, 10.0) };
        s.place(AutonomousVehicle::at(nowhere));
        s.duration(-1.0);
    });
    assert!(car.contains("car has a way with a piece"), "{car}");
    let fog = run(|s| {
        let (_, car) = rolling(s);
        s.place(Environment::new().fog(car.speed()));
        s.require("some", eventually(car.speed().above(1.0)));
    });
    assert_eq!(fog.ending.message().unwrap(), "the fog is 10, expected 0 to 1 at 0.000 s");
    let rain = run(|s| {
        let (_, car) = rolling(s);
        s.place(Environment::new().rain(car.speed()));
        s.require("some", eventually(car.speed().above(1.0)));
    });
    assert_eq!(rain.ending.message().unwrap(), "the rain is 10, expected 0 to 1 at 0.000 s");
    let sun = run(|s| {
        let (_, car) = rolling(s);
        s.place(Environment::new().sun(2.0, 0.0));
        s.require("some", eventually(car.speed().above(1.0)));
    });
    assert_eq!(sun.ending.message().unwrap(), "the sun's elevation is 2, expected -pi/2 to pi/2 at 0.000 s");
}

#[test]
fn time_is_that_of_the_run_whatever_the_tick() {
    fn clock(s: &mut Scenario) {
        let (_, car) = rolling(s);
        s.require("late", eventually((Stream::time() + car.travelled() * 0.0).named("clock").at_least(4.995)));
    }
    let program = Program::new("clock", "a clock", clock);
    for dt in [0.01, 0.002, 0.05] {
        let setup = Setup { dt: Some(dt), ..Setup::asking_every(0.05) };
        let mut driver = driver::find("cruise").unwrap().build(&[]).unwrap();
        let outcome = Run::new(&program, &Values::default(), setup).unwrap().drive(driver.as_mut());
        let last = *signal(&outcome, "clock").last().unwrap();
        assert!((last - 5.0).abs() < 1e-9, "{last}");
    }
}

#[test]
fn an_input_that_makes_no_sense_ends_the_run_with_its_name() {
    let outcome = run(|s| {
        let (road, car) = rolling(s);
        s.place(Mover::car(road.path(2)).starting(50.0).speed(car.speed() - 20.0));
        s.require("some", eventually(car.speed().above(1.0)));
    });
    assert_eq!(outcome.verdict(), Verdict::Error);
    assert_eq!(
        outcome.ending.message().unwrap(),
        "the value of the input `other.speed` is -10, expected a number from 0 on at 0.000 s"
    );
}

#[test]
fn people_and_things_of_one_name_are_numbered() {
    let outcome = run(|s| {
        let (road, car) = rolling(s);
        for at in [50.0, 60.0] {
            s.place(Pedestrian::at(road.on_sidewalk(Side::Left, at)));
        }
        s.place(Pedestrian::child(road.on_sidewalk(Side::Left, 70.0)));
        s.place(
            Mover::new("pedestrian", Body::adult(), Path::straight(Vector2::new(0.0, 30.0), Vector2::new(9.0, 30.0)))
                .speed(1.0),
        );
        s.require("some", eventually(car.speed().above(1.0)));
    });
    for name in ["pedestrian.x", "pedestrian-2.x", "child.x", "pedestrian-3.x"] {
        assert_eq!(signal(&outcome, name).len(), 501);
    }
}
