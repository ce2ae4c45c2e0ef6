//! Every scenario of the catalogue: that it can be run, is the same whenever it is run, and is what its documentation
//! says.

use paracosm_engine::object::{BodyState, Class, VehicleKind};
use paracosm_engine::vehicle::{Vehicle, VehicleModel};
use paracosm_engine::{Face, Outcome, Program, Run, Setup, Step, driver, signal, simulate, watch};
use paracosm_oracles::Verdict;
use paracosm_scenarios::{ALL, find};
use paracosm_space::{Domain, Value, Values};

fn run(program: &Program, test: &Values, model: VehicleModel, driver: &str) -> Outcome {
    let mut driver = driver::find(driver).unwrap().build(&[]).unwrap();
    simulate(program, test, model, driver.as_mut())
}

fn nominal(program: &Program, changes: &[(&str, Value)]) -> Values {
    let mut test = program.declare().unwrap_or_else(|error| panic!("{error}")).nominal();
    for (name, value) in changes {
        test.set(*name, value.clone());
    }
    test
}

/// The samples of a signal.
fn signal_of(outcome: &Outcome, name: &str) -> Vec<f64> {
    let trace = outcome.trace.as_ref().unwrap_or_else(|| panic!("there is no trace: {:?}", outcome.ending.message()));
    trace.signal(name).unwrap_or_else(|| panic!("no `{name}` in {:?}", trace.signals())).collect()
}

#[test]
fn every_scenario_runs_with_every_driver() {
    for program in ALL {
        // Nothing is drawn here for those that see.
        let blind = |kind: &&driver::Descriptor| kind.build(&[]).unwrap().equipment().cameras.all.is_empty();
        for kind in driver::ALL.iter().copied().filter(blind) {
            let outcome = run(program, &nominal(program, &[]), VehicleModel::SingleTrack, kind.name);
            assert_eq!(outcome.ending.message(), None, "{} with {}", program.name(), kind.name);
            assert!(!matches!(outcome.verdict(), Verdict::Error | Verdict::Invalid));
        }
    }
}

/// The clearance is from all bodies, and the other clearances are from one class of road users each.
#[test]
fn the_clearance_is_the_least_of_the_clearances_by_class_and_to_record_them_changes_nothing_else() {
    let by_class = || signal::on_request().map(|(name, _)| name).filter(|name| name.starts_with("car.clearance_to_"));
    assert_eq!(by_class().count(), 7);
    for program in ALL {
        let recording = program.recording(signal::on_request().map(|(name, _)| name));
        for test in diagonal(program, 3) {
            let [plain, recorded] =
                [program, &recording].map(|program| run(program, &test, VehicleModel::SingleTrack, "aeb"));
            let Some(trace) = &plain.trace else { continue };
            for name in trace.signals() {
                assert_eq!(signal_of(&plain, name), signal_of(&recorded, name), "{name} of {}", program.name());
            }
            let classes: Vec<Vec<f64>> = by_class().map(|name| signal_of(&recorded, name)).collect();
            for (tick, all) in signal_of(&recorded, "car.clearance").into_iter().enumerate() {
                let least = classes.iter().map(|class| class[tick]).fold(f64::INFINITY, f64::min);
                // In the loop, houses stand beside the road.
                let is_least = if program.name() == "t-loop" { least >= all } else { (least - all).abs() < 1e-9 };
                assert!(is_least, "{} at tick {tick}: {least} and {all}", program.name());
            }
        }
    }
}

#[test]
fn every_scenario_runs_with_a_jointed_car() {
    for program in ALL {
        let outcome = run(program, &nominal(program, &[]), VehicleModel::Jointed, "aeb");
        assert_eq!(outcome.ending.message(), None, "{}", program.name());
    }
}

/// Tests of a scenario: from the corner where every open parameter is least to the one where each is greatest.
fn diagonal(program: &Program, count: usize) -> Vec<Values> {
    let declaration = program.declare().unwrap();
    let at = |share: f64| {
        let value = |domain: &Domain| match domain {
            Domain::Interval { lo, hi } => Value::Number(lo + (hi - lo) * share),
            Domain::Choice(levels) => levels[((levels.len() - 1) as f64 * share) as usize].clone(),
        };
        let open = declaration.parameters.iter().filter(|declared| declared.open);
        let changes: Vec<_> = open.map(|d| (d.parameter.name.as_str(), value(&d.parameter.domain))).collect();
        nominal(program, &changes)
    };
    (0..count).map(|i| at(i as f64 / (count - 1) as f64)).collect()
}

#[test]
fn the_same_test_has_the_same_trace_in_every_run_and_on_every_thread() {
    let mut tests = 0;
    for program in ALL {
        let count = if program.declare().unwrap().duration > 50.0 { 4 } else { 20 };
        let values = diagonal(program, count);
        let hash = |test: &Values| run(program, test, VehicleModel::SingleTrack, "aeb").trace.map(|trace| trace.hash());
        let alone: Vec<_> = values.iter().map(hash).collect();
        let again: Vec<_> = std::thread::scope(|scope| {
            let threads: Vec<_> = values.iter().map(|test| scope.spawn(move || hash(test))).collect();
            threads.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        assert_eq!(alone, again, "{}", program.name());
        tests += alone.iter().flatten().count();
    }
    assert!(tests > 200, "{tests} tests have a trace");
}

/// Goes through runs in turns, a question to a driver at a time, as a batch would: the hash of each.
fn in_turns(program: &Program, tests: &[Values], model: VehicleModel) -> Vec<Option<String>> {
    let kind = driver::find("aeb").unwrap();
    let mut drivers: Vec<_> = tests.iter().map(|_| kind.build(&[]).unwrap()).collect();
    let setup = Setup { vehicle: model.into(), ..Setup::asking_every(drivers[0].period()) };
    let mut runs: Vec<_> = tests.iter().map(|test| Run::new(program, test, setup).ok()).collect();
    let mut hashes = vec![None; tests.len()];
    for (run, driver) in runs.iter().zip(&mut drivers) {
        run.iter().for_each(|run| driver.reset(&run.briefing()).unwrap());
    }
    while runs.iter().any(Option::is_some) {
        for ((slot, driver), hash) in runs.iter_mut().zip(&mut drivers).zip(&mut hashes) {
            let Some(run) = slot else { continue };
            match run.advance() {
                Step::Need(observation) => {
                    let control = driver.step(observation).unwrap();
                    run.supply(control);
                }
                Step::Done(outcome) => {
                    *hash = outcome.trace.map(|trace| trace.hash());
                    *slot = None;
                }
            }
        }
    }
    hashes
}

#[test]
fn runs_that_go_on_in_turns_are_those_that_go_on_alone() {
    for program in ALL.iter().filter(|program| program.declare().unwrap().duration < 50.0) {
        for model in VehicleModel::ALL {
            let tests = diagonal(program, 4);
            let alone = tests.iter().map(|test| run(program, test, model, "aeb").trace.map(|trace| trace.hash()));
            assert_eq!(in_turns(program, &tests, model), alone.collect::<Vec<_>>(), "{} {model}", program.name());
        }
    }
}

/// The width of the target of `ncap-ccr` in metres.
const TARGET_WIDTH: f64 = 1.8;

#[test]
fn a_car_that_does_not_brake_comes_upon_the_other_after_six_seconds_with_the_overlap_that_is_asked_for() {
    let program = find("ncap-ccr").unwrap();
    let speeds = [("standing", 50.0), ("standing", 10.0), ("moving", 60.0)];
    let cases =
        [-50, -75, 100, 75, 50].into_iter().flat_map(|overlap| speeds.map(|(target, speed)| (overlap, target, speed)));
    for (overlap, target, speed) in cases {
        let changes = [
            ("ego_speed", Value::Number(speed)),
            ("overlap", Value::Number(f64::from(overlap))),
            ("target", Value::Word(target.to_owned())),
        ];
        let outcome = run(program, &nominal(program, &changes), VehicleModel::SingleTrack, "cruise");
        let time = outcome.trace.as_ref().unwrap().len() as f64 * 0.01;
        assert!((time - 6.0).abs() < 0.05, "{target} at {speed} km/h: {time} s");
        let last = |name: &str| *signal_of(&outcome, name).last().unwrap();
        // The sides of both cars as places across the lane: the share of the ego vehicle's width that both cover.
        let [own, other] = [("car.y", Vehicle::BMW_320I.width), ("target.y", TARGET_WIDTH)]
            .map(|(name, width)| [last(name) - 0.5 * width, last(name) + 0.5 * width]);
        let covered = (own[1].min(other[1]) - own[0].max(other[0])) / Vehicle::BMW_320I.width;
        assert!((covered - f64::from(overlap).abs() / 100.0).abs() < 1e-9, "{overlap} %: {covered}");
        let aside = last("target.y") - last("car.y");
        assert!(overlap == 100 && aside.abs() < 1e-9 || aside.signum() == f64::from(overlap).signum());
    }
    let changes = [("ego_speed", Value::Number(29.0)), ("target", Value::Word("moving".to_owned()))];
    let outcome = run(program, &nominal(program, &changes), VehicleModel::SingleTrack, "cruise");
    assert_eq!(outcome.verdict(), Verdict::Invalid);
}

#[test]
fn the_target_of_ccrb_brakes_after_three_seconds_from_the_ego_vehicle_s_speed_to_2_km_h() {
    let program = find("ncap-ccrb").unwrap();
    for (gap, deceleration) in [(12.0, 2.0), (12.0, 6.0), (40.0, 2.0), (40.0, 6.0)] {
        let changes = [("gap", Value::Number(gap)), ("deceleration", Value::Number(deceleration))];
        let outcome = run(program, &nominal(program, &changes), VehicleModel::SingleTrack, "cruise");
        let speed = signal_of(&outcome, "target.speed");
        let (start, crawl) = (50.0 / 3.6, 2.0 / 3.6);
        for (tick, speed) in speed.iter().enumerate().skip(1) {
            let expected = (start - (0.01 * tick as f64 - 3.0).max(0.0) * deceleration).max(crawl);
            assert!((speed - expected).abs() < 0.01 * deceleration + 1e-9, "tick {tick}: {speed}, expected {expected}");
        }
        let apart = signal_of(&outcome, "target.x")[0] - signal_of(&outcome, "car.x")[0];
        assert!((apart - 0.5 * (Vehicle::BMW_320I.length + 4.5) - gap).abs() < 1e-9, "{apart}");
        assert_eq!(outcome.verdict(), Verdict::Fail, "nobody brakes");
    }
}

#[test]
fn every_kind_of_vehicle_cuts_in_from_either_side_at_the_gap_that_is_asked_for_and_changes_its_speed() {
    let program = find("cut-in").unwrap();
    for kind in [VehicleKind::CAR, VehicleKind::VAN, VehicleKind::TRUCK, VehicleKind::BUS, VehicleKind::MOTORCYCLE] {
        for (side, begins) in [("left", -0.5 * 3.5), ("right", -2.5 * 3.5)] {
            for rate in [-3.0, 0.0, 3.0] {
                let changes = [
                    ("vehicle", Value::Word(kind.name.to_owned())),
                    ("side", Value::Word(side.to_owned())),
                    ("acceleration", Value::Number(rate)),
                    ("gap", Value::Number(60.0)),
                ];
                let outcome = run(program, &nominal(program, &changes), VehicleModel::SingleTrack, "cruise");
                let [x, y, speed] = ["other.x", "other.y", "other.speed"].map(|name| signal_of(&outcome, name));
                let apart = x[0] - signal_of(&outcome, "car.x")[0];
                let halves = 0.5 * (Vehicle::BMW_320I.length + kind.size[0]);
                assert!((apart - halves - 60.0).abs() < 1e-9, "{} {side}: {apart}", kind.name);
                assert!((y[0] - begins).abs() < 1e-9 && (y[y.len() - 1] - y_of_lane_2()).abs() < 1e-9, "{side}");
                let expected = (30.0 / 3.6 + rate * 0.01 * (speed.len() - 1) as f64).clamp(0.0, 80.0 / 3.6);
                let last = speed[speed.len() - 1];
                assert!((last - expected).abs() < 0.04, "{rate}: {last}, expected {expected}");
            }
        }
    }
}

#[test]
fn a_test_of_the_regulation_is_invalid_if_the_vehicle_would_move_aside_faster_than_it_drives() {
    for (scenario, slow) in [("cut-in", ("relative_speed", -45.0)), ("cut-out", ("ego_speed", 9.0))] {
        let program = find(scenario).unwrap();
        for (lateral, valid) in [(3.0, false), (1.0, true)] {
            let changes = [(slow.0, Value::Number(slow.1)), ("lateral_speed", Value::Number(lateral))];
            let outcome = run(program, &nominal(program, &changes), VehicleModel::SingleTrack, "cruise");
            assert_eq!(outcome.verdict() != Verdict::Invalid, valid, "{scenario} {lateral} m/s");
        }
    }
}

#[test]
fn a_cut_out_to_either_side_reveals_every_kind_of_obstacle_at_the_gap() {
    let program = find("cut-out").unwrap();
    for name in ["car", "van", "truck", "bus", "motorcycle", "pedestrian"] {
        for (side, way) in [("left", 1.0), ("right", -1.0)] {
            let changes = [("obstacle", Value::Word(name.to_owned())), ("side", Value::Word(side.to_owned()))];
            let outcome = run(program, &nominal(program, &changes), VehicleModel::SingleTrack, "cruise");
            let moved = signal_of(&outcome, "leader.y").last().unwrap() - y_of_lane_2();
            assert!((moved - way * 3.5).abs() < 1e-9, "{name} {side}: {moved}");
            let v = 50.0 / 3.6;
            let lead = 10.0 + 2.0 * v + 0.5 * (Vehicle::BMW_320I.length + 4.5);
            let rear = lead + 3.0 * v + 0.5 * 4.5 + 30.0;
            let front = signal_of(&outcome, "car.x").last().unwrap() + 0.5 * Vehicle::BMW_320I.length;
            assert!((front - rear).abs() < 0.2, "{name}: {front}, expected {rear}");
        }
    }
}

#[test]
fn the_leader_of_a_cut_out_leaves_its_lane_at_the_gap_before_the_car_that_stands() {
    let program = find("cut-out").unwrap();
    let test = nominal(program, &[("gap", Value::Number(25.0)), ("ego_speed", Value::Number(36.0))]);
    let outcome = run(program, &test, VehicleModel::SingleTrack, "cruise");
    let (x, y) = (signal_of(&outcome, "leader.x"), signal_of(&outcome, "leader.y"));
    let leaves = y.iter().position(|y| (y - y_of_lane_2()).abs() > 1e-9).expect("it leaves");
    // 10 m + 2 s at 10 m/s + the halves of two cars is where it begins, and it drives 3 s straight on.
    let begun = 10.0 + 20.0 + 0.5 * (Vehicle::BMW_320I.length + 4.5);
    assert!((x[leaves - 1] - (begun + 30.0)).abs() < 0.2, "{}", x[leaves - 1]);
    let impact = *signal_of(&outcome, "car.x").last().unwrap() + 0.5 * Vehicle::BMW_320I.length;
    assert!((impact - (begun + 30.0 + 0.5 * 4.5 + 25.0)).abs() < 0.2, "{impact}");
}

fn y_of_lane_2() -> f64 {
    -1.5 * 3.5
}

/// Where the middle of a pedestrian is when the car has it: as a share of the car's width from its right side.
fn impact(outcome: &Outcome, name: &str) -> f64 {
    let last = |name: &str| *signal_of(outcome, name).last().unwrap();
    0.5 + (last(&format!("{name}.y")) - last("car.y")) / Vehicle::BMW_320I.width
}

#[test]
fn a_car_that_does_not_brake_takes_the_pedestrian_where_the_protocol_says_to_a_centimetre() {
    let cases = [
        ("ncap-cpna", "adult", Some(25), 0.25),
        ("ncap-cpna", "adult", Some(75), 0.75),
        ("ncap-cpfa", "adult", None, 0.5),
        ("ncap-cpnco", "child", None, 0.5),
    ];
    for (scenario, name, choice, share) in cases {
        let program = find(scenario).unwrap();
        for speed in (10..=60).step_by(5) {
            let mut changes = vec![("ego_speed", Value::Number(f64::from(speed)))];
            changes.extend(choice.map(|impact| ("impact", Value::Number(f64::from(impact)))));
            let outcome = run(program, &nominal(program, &changes), VehicleModel::SingleTrack, "cruise");
            assert_eq!(outcome.verdict(), Verdict::Fail, "{scenario} at {speed} km/h");
            let missed = (impact(&outcome, name) - share).abs() * Vehicle::BMW_320I.width;
            assert!(missed < 0.01, "{scenario} at {speed} km/h: {missed} m beside {share}");
            let face = outcome.measured.and_then(|measured| measured.contact).map(|contact| contact.face);
            assert_eq!(face, Some(Face::Front));
            let time = outcome.trace.as_ref().unwrap().len() as f64 * 0.002;
            assert!((time - 6.0).abs() < 0.01, "{scenario} at {speed} km/h: the impact is at {time} s");
        }
    }
}

#[test]
fn pedestrians_reach_their_speed_over_the_distance_that_the_protocol_says() {
    for (scenario, name, run_up, km_h) in [("ncap-cpna", "adult", 1.0, 5.0), ("ncap-cpfa", "adult", 1.5, 8.0)] {
        let program = find(scenario).unwrap();
        let outcome = run(program, &nominal(program, &[]), VehicleModel::SingleTrack, "cruise");
        let (y, speed) = (signal_of(&outcome, &format!("{name}.y")), signal_of(&outcome, &format!("{name}.speed")));
        let walks = speed.iter().position(|speed| *speed > km_h / 3.6 - 1e-6).expect("it reaches its speed");
        let way = (y[walks] - y[0]).abs();
        assert!((way - run_up).abs() < 0.01, "{scenario}: {way} m");
    }
}

#[test]
fn a_cut_in_begins_at_the_gap_from_bumper_to_bumper_and_moves_across_as_fast_as_it_says() {
    let program = find("cut-in").unwrap();
    let changes = [("gap", 30.0), ("lateral_speed", 1.5), ("ego_speed", 60.0), ("relative_speed", -10.0)];
    let changes = changes.map(|(name, value)| (name, Value::Number(value)));
    let outcome = run(program, &nominal(program, &changes), VehicleModel::SingleTrack, "cruise");
    let clearance = signal_of(&outcome, "car.clearance")[0];
    let beside: f64 = 3.5 - 0.5 * (Vehicle::BMW_320I.width + 1.8);
    assert!((clearance - (beside * beside + 30.0 * 30.0).sqrt()).abs() < 1e-9, "{clearance}");
    let y = signal_of(&outcome, "other.y");
    assert!((y[101] - y[1] + 1.5).abs() < 1e-9);
}

#[test]
fn a_world_that_cannot_be_is_invalid() {
    let program = find("cut-in").unwrap();
    let changes = [("ego_speed", 20.0), ("relative_speed", -50.0)].map(|(name, value)| (name, Value::Number(value)));
    let outcome = run(program, &nominal(program, &changes), VehicleModel::SingleTrack, "cruise");
    assert_eq!(outcome.verdict(), Verdict::Invalid);
    assert!(outcome.ending.message().unwrap().contains("the other vehicle would drive backwards"));
}

#[test]
fn the_loop_is_gone_round_on_its_way() {
    let program = find("t-loop").unwrap();
    for model in VehicleModel::ALL {
        let outcome = run(program, &nominal(program, &[]), model, "cruise");
        assert_eq!(outcome.verdict(), Verdict::Pass, "{model}: {:?}", outcome.judgements);
        let travelled = *signal_of(&outcome, "car.travelled").last().unwrap();
        assert!(travelled > 1000.0, "{model}: {travelled} m");
    }
}

/// All bodies as a test begins.
fn beginning(program: &Program, test: &Values) -> Vec<BodyState> {
    Run::new(program, test, Setup::asking_every(0.1)).unwrap_or_else(|error| panic!("{error}")).bodies().to_vec()
}

#[test]
fn the_city_has_as_many_cars_as_it_says_away_from_the_car_under_test() {
    let program = find("grid-traffic").unwrap();
    for (seed, cars) in
        [(1, 100), (2, 100), (3, 100), (4, 100), (5, 100), (6, 100), (7, 100), (8, 100), (1, 10), (8, 30)]
    {
        let number = |value: i32| Value::Number(f64::from(value));
        let test = nominal(program, &[("traffic_seed", number(seed)), ("cars", number(cars))]);
        let bodies = beginning(program, &test);
        assert_eq!(bodies.len(), 1 + cars as usize);
        let near = |body: &BodyState| (body.pose.position - bodies[0].pose.position).norm();
        assert!(bodies[1..].iter().all(|body| near(body) > 12.0));
    }
}

#[test]
fn on_the_highway_all_kinds_of_vehicles_are_under_way_and_the_truck_is_white() {
    let program = find("highway-traffic").unwrap();
    for seed in 1..=4 {
        let test = nominal(program, &[("traffic_seed", Value::Number(f64::from(seed)))]);
        let bodies = beginning(program, &test);
        let (truck, others) = (&bodies[1], &bodies[2..]);
        assert!(truck.body.class == Class::Truck && truck.body.colour.iter().all(|share| *share > 230), "{truck:?}");
        assert!(others.len() > 30 && others.iter().all(|other| other.velocity.norm() > 9.0));
        let length = |other: &BodyState| 2.0 * other.body.outline.half_extent().x;
        let of = |class| others.iter().filter(|other| other.body.class == class).count();
        assert!(of(Class::Truck) >= 3 && of(Class::Van) > 3 && of(Class::Car) > of(Class::Van));
        let mut sizes: Vec<u64> = others.iter().map(|other| length(other).to_bits()).collect();
        sizes.sort_unstable();
        sizes.dedup();
        assert_eq!(sizes.len(), others.len(), "no two are alike");
    }
}

#[test]
fn the_distractor_has_the_colour_of_the_leader() {
    let program = find("oncoming-distractor").unwrap();
    let bodies = beginning(program, &nominal(program, &[]));
    let [red, green, blue] = bodies[1].body.colour;
    assert!(bodies[1].body.colour == bodies[2].body.colour && red > 150 && green < 60 && blue < 60);
}

#[test]
fn in_the_roundabout_the_other_car_keeps_its_speed_where_nobody_is_in_its_way() {
    let program = find("roundabout-entry").unwrap();
    for (lead, other) in [(4.0, 6.0), (3.0, 9.0), (2.5, 3.0)] {
        let test = nominal(program, &[("lead", Value::Number(lead)), ("other_speed", Value::Number(other))]);
        let mut driver = driver::find("cruise").unwrap().build(&[]).unwrap();
        let mut seen = 0;
        let _ = watch(program, &test, VehicleModel::SingleTrack, driver.as_mut(), |run| {
            let body = run.bodies()[1];
            // Until both would be there, 60 m after 8 m/s.
            if run.time() < 7.5 - lead {
                assert!(
                    (body.velocity.norm() - other).abs() < 0.02,
                    "{} m/s after {} s",
                    body.velocity.norm(),
                    run.time()
                );
                seen += 1;
            }
        });
        assert!(seen > 30, "{seen} looks");
    }
}

#[test]
fn in_the_roundabout_nobody_runs_into_the_car_from_behind() {
    let program = find("roundabout-entry").unwrap();
    let mut within = 0;
    for lead in [-4.0, -3.0, -2.0, -1.0] {
        for (speed, other) in [(4.0, 9.0), (6.0, 9.0), (8.0, 9.0), (8.0, 6.0)] {
            let changes = [("lead", lead), ("approach_speed", speed), ("other_speed", other)];
            let changes = changes.map(|(name, value)| (name, Value::Number(value)));
            let outcome = run(program, &nominal(program, &changes), VehicleModel::SingleTrack, "cruise");
            if outcome.verdict() == Verdict::Invalid {
                continue;
            }
            let face = outcome.measured.and_then(|measured| measured.contact).map(|contact| contact.face);
            assert_ne!(face, Some(Face::Rear), "{changes:?}");
            within += 1;
        }
    }
    assert!(within > 8, "{within} tests are valid");
}

/// Whether some of many points of a body are within another.
fn overlap(one: &BodyState, other: &BodyState) -> bool {
    let (half, room) = (one.body.outline.half_extent(), other.body.outline.half_extent());
    let shares = || (-4..=4).map(|share| f64::from(share) / 4.0);
    let points = shares().flat_map(|x| shares().map(move |y| (x * half.x, y * half.y)));
    let mut points = points.map(|(x, y)| one.pose.position + one.pose.forward() * x + one.pose.left() * y);
    points.any(|point| {
        let local = other.pose.to_local(point);
        local.x.abs() < room.x && local.y.abs() < room.y
    })
}

#[test]
fn on_the_highway_the_truck_drives_through_nobody() {
    let program = find("highway-traffic").unwrap();
    let mut crossed = 0;
    for (seed, delay, speed) in [(1, 0.0, 15.0), (1, 9.0, 9.0), (2, 6.0, 15.0), (3, 6.0, 12.0), (4, 3.0, 15.0)] {
        let changes = [("traffic_seed", f64::from(seed)), ("truck_delay", delay), ("truck_speed", speed)];
        let test = nominal(program, &changes.map(|(name, value)| (name, Value::Number(value))));
        let mut driver = driver::find("aeb").unwrap().build(&[]).unwrap();
        let mut y = f64::INFINITY;
        let _ = watch(program, &test, VehicleModel::SingleTrack, driver.as_mut(), |run| {
            let (truck, others) = (&run.bodies()[1], &run.bodies()[2..]);
            let through = others.iter().find(|other| other.present && overlap(truck, other));
            assert_eq!(through, None, "after {} s of {changes:?}", run.time());
            y = truck.pose.position.y;
        });
        crossed += i32::from(y < -20.0);
    }
    assert!(crossed >= 3, "{crossed} trucks cross in time");
}

#[test]
fn the_expert_stops_for_who_crosses_at_one_metre_a_second_and_goes_on() {
    let program = find("pedestrian-crossing").unwrap();
    for distance in [5.0, 15.0, 25.0, 30.0, 40.0, 50.0, 60.0] {
        let changes = [("speed", Value::Number(1.0)), ("distance", Value::Number(distance))];
        let outcome = run(program, &nominal(program, &changes), VehicleModel::SingleTrack, "expert");
        assert_eq!(outcome.verdict(), Verdict::Pass, "from {distance} m on");
        let least = signal_of(&outcome, "car.speed").into_iter().fold(f64::INFINITY, f64::min);
        assert_eq!(least < 0.5, distance > 20.0, "{least} m/s from {distance} m on");
    }
}
