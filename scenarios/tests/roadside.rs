//! What stands beside the roads: in every scenario, out of everybody's way, and the same in the same test.

use nalgebra::Vector2;
use paracosm_engine::object::{BodyState, Class};
use paracosm_engine::road::{RoadNetwork, Strip, Surface};
use paracosm_engine::vehicle::VehicleModel;
use paracosm_engine::{
    AutonomousVehicle, Outcome, Place, Program, Road, RoadSegment, Roadside, Run, Scenario, Setup, driver, simulate,
    watch,
};
use paracosm_oracles::Trace;
use paracosm_scenarios::{ALL, find};
use paracosm_space::{Domain, Value, Values};

/// The test with nominal values, but for these.
fn test(program: &Program, changes: &[(&str, f64)]) -> Values {
    let mut test = program.declare().unwrap_or_else(|error| panic!("{error}")).nominal();
    for (name, value) in changes {
        assert!(test.get(name).is_some(), "{} has no `{name}`", program.name());
        test.set(*name, *value);
    }
    test
}

/// How many of its bodies a test has without a roadside, and all that it has with one so full.
fn beginning(program: &Program, fullness: f64) -> (usize, Vec<BodyState>, Run) {
    let run =
        |fullness| Run::new(program, &test(program, &[("roadside", fullness)]), Setup::asking_every(0.1)).unwrap();
    let full = run(fullness);
    (run(0.0).bodies().len(), full.bodies().to_vec(), full)
}

/// Points of a body, from its middle to its rim.
fn points(state: &BodyState) -> impl Iterator<Item = Vector2<f64>> + '_ {
    let half = state.body.outline.half_extent();
    let shares = || (-4..=4).map(|share| f64::from(share) / 4.0);
    let local = shares().flat_map(move |x| shares().map(move |y| (x * half.x, y * half.y)));
    local.map(|(x, y)| state.pose.position + state.pose.forward() * x + state.pose.left() * y)
}

fn on(strip: &Strip, point: Vector2<f64>) -> bool {
    let s = strip.curve.nearest(point);
    let local = strip.curve.at(s).to_local(point);
    local.x.abs() < 1e-6 && (strip.right..=strip.left).contains(&local.y)
}

fn on_roads(network: &RoadNetwork, state: &BodyState) -> bool {
    let roads = network.strips();
    let mut roads = roads.iter().filter(|strip| matches!(strip.surface, Surface::Carriageway | Surface::Sidewalk));
    roads.any(|strip| points(state).any(|point| on(strip, point)))
}

fn overlap(one: &BodyState, other: &BodyState) -> bool {
    let within = |one: &BodyState, other: &BodyState| {
        let room = other.body.outline.half_extent();
        points(one).any(|point| {
            let local = other.pose.to_local(point);
            local.x.abs() < room.x && local.y.abs() < room.y
        })
    };
    within(one, other) || within(other, one)
}

#[test]
fn things_stand_beside_the_roads_of_every_scenario_and_never_on_them() {
    for program in ALL {
        let (before, bodies, run) = beginning(program, 1.0);
        let things = &bodies[before..];
        assert!(things.len() > 20, "{}: {} things", program.name(), things.len());
        for thing in things {
            assert!(!on_roads(run.network(), thing), "{}: {thing:?}", program.name());
        }
        let half = beginning(program, 0.5).1.len() - before;
        assert!((things.len() / 4..3 * things.len() / 4).contains(&half), "{half} of {}", things.len());
    }
}

fn built(s: &mut Scenario, network: impl Place<Handle = Road>) {
    let road = s.place(network);
    s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(5.0));
    s.place(Roadside::new(1.0));
}

#[test]
fn a_road_without_sidewalks_and_one_that_bends_have_room_for_things() {
    let roads: [fn(&mut Scenario); 3] = [
        |s| built(s, RoadSegment::new(200.0).sidewalk(0.0)),
        |s| built(s, RoadSegment::arc(60.0, 2.5).sidewalk(0.0)),
        |s| built(s, RoadSegment::arc(40.0, -3.0).lanes(4)),
    ];
    for (number, build) in roads.into_iter().enumerate() {
        let program = Program::new("road", "a road", build);
        let run = Run::new(&program, &Values::default(), Setup::asking_every(0.1)).unwrap();
        let things = &run.bodies()[1..];
        assert!(things.len() > 10, "road {number}: {} things", things.len());
        assert!(things.iter().all(|thing| !on_roads(run.network(), thing)), "road {number}");
    }
}

#[test]
fn all_kinds_of_things_stand_there() {
    let (before, bodies, run) = beginning(find("pedestrian-crossing").unwrap(), 1.0);
    for class in [Class::Tree, Class::Building, Class::Sign, Class::Bicycle, Class::Pedestrian, Class::Prop, Class::Car]
    {
        assert!(bodies[before..].iter().any(|thing| thing.body.class == class), "{class}");
    }
    let names: Vec<&str> = (before..bodies.len()).map(|body| run.name_of(body)).collect();
    assert!(names.contains(&"bystander") && names.contains(&"tree-2"), "{names:?}");
}

#[test]
fn nothing_that_moves_comes_near_what_stands_beside_the_road() {
    for program in ALL.iter().filter(|program| program.name() != "grid-traffic") {
        let (before, ..) = beginning(program, 0.0);
        let mut driver = driver::find("cruise").unwrap().build(&[]).unwrap();
        let test = test(program, &[("roadside", 1.0)]);
        let mut looks = 0;
        let _ = watch(program, &test, VehicleModel::SingleTrack, driver.as_mut(), |run| {
            looks += 1;
            if looks % 10 == 0 {
                let (own, things) = run.bodies().split_at(before);
                for moves in own.iter().filter(|body| body.velocity.norm() > 0.0 && body.present) {
                    let reach = |body: &BodyState| body.body.outline.reach();
                    let far = |thing: &BodyState| {
                        (thing.pose.position - moves.pose.position).norm() > reach(thing) + reach(moves)
                    };
                    let touched = things.iter().find(|thing| !far(thing) && overlap(thing, moves));
                    assert_eq!(touched, None, "{}: {moves:?}", program.name());
                }
            }
        });
        assert!(looks > 50, "{}: {looks} looks", program.name());
    }
}

#[test]
fn the_same_test_has_the_same_things_and_another_test_has_others() {
    for program in ALL {
        let (before, first, _) = beginning(program, 0.6);
        assert_eq!(first, beginning(program, 0.6).1, "{}", program.name());
        let declared = program.declare().unwrap().parameters;
        let other = declared.iter().find_map(|declared| match &declared.parameter.domain {
            Domain::Interval { lo, hi } if declared.open => {
                Some((declared.parameter.name.as_str(), lo + 0.37 * (hi - lo)))
            }
            _ => None,
        });
        let values = test(program, &[("roadside", 0.6), other.expect("an interval is open")]);
        let other = Run::new(program, &values, Setup::asking_every(0.1)).unwrap();
        let places = |bodies: &[BodyState]| bodies[before..].iter().map(|thing| thing.pose).collect::<Vec<_>>();
        assert_ne!(places(&first), places(other.bodies()), "{}", program.name());
    }
}

fn driven(program: &Program, driver: &str, changes: &[(&str, f64)]) -> Outcome {
    let mut driver = driver::find(driver).unwrap().build(&[]).unwrap();
    simulate(program, &test(program, changes), VehicleModel::SingleTrack, driver.as_mut())
}

#[test]
fn for_a_driver_that_does_not_see_by_cameras_the_test_is_the_same() {
    for program in ALL {
        for driver in ["aeb", "expert"] {
            let [bare, full] = [0.0, 1.0].map(|fullness| driven(program, driver, &[("roadside", fullness)]));
            let hash = |outcome: &Outcome| outcome.trace.as_ref().map(Trace::hash);
            assert!(hash(&bare).is_some(), "{} with {driver}: {:?}", program.name(), bare.ending.message());
            assert_eq!(
                (bare.verdict(), hash(&bare)),
                (full.verdict(), hash(&full)),
                "{} with {driver}",
                program.name()
            );
        }
    }
}

#[test]
fn who_leaves_the_road_runs_into_what_stands_there() {
    let program = find("t-loop").unwrap();
    let (before, ..) = beginning(program, 0.0);
    let test = test(program, &[("roadside", 1.0), ("friction", 0.2), ("speed", 12.0)]);
    let mut driver = driver::find("cruise").unwrap().build(&[]).unwrap();
    let mut touched = None;
    let _ = watch(program, &test, VehicleModel::SingleTrack, driver.as_mut(), |run| touched = run.touched());
    assert!(touched.is_some_and(|body| body >= before), "{touched:?} of {before}");
}

#[test]
fn a_zebra_crossing_is_paint() {
    let program = find("pedestrian-crossing").unwrap();
    for driver in ["aeb", "expert"] {
        let [bare, striped] = [0.0, 1.0].map(|zebra| driven(program, driver, &[("zebra", zebra), ("distance", 25.0)]));
        assert_eq!(bare.trace.unwrap().hash(), striped.trace.unwrap().hash());
    }
    let painted = |zebra: f64| {
        let run = Run::new(program, &test(program, &[("zebra", zebra)]), Setup::asking_every(0.1)).unwrap();
        run.network().strips().iter().filter(|strip| strip.surface == Surface::Zebra).count()
    };
    assert_eq!((painted(0.0), painted(1.0)), (0, 7));
}

#[test]
fn a_roadside_fuller_than_full_is_refused() {
    let program = find("follow-leader").unwrap();
    for fullness in [-0.1, 1.5, f64::NAN] {
        let error = program.check(&test(program, &[("roadside", fullness)])).expect_err("it is none").to_string();
        assert!(error.contains("expected a number from 0 to 1"), "{error}");
    }
    let word = {
        let mut test = test(program, &[]);
        test.set("roadside", Value::Word("full".to_owned()));
        test
    };
    assert!(program.check(&word).is_err());
}
