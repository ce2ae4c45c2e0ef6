//! What every scenario has around it: it can be opened in all of them, may vary over time, and changes nothing where it
//! is closed.

use paracosm_engine::{Program, Run, Setup, Step, Test, Weather};
use paracosm_scenarios::ALL;
use paracosm_space::{Parameter, Shape, Space, Value, Values};

/// The test with nominal values, but for these.
fn test(program: &Program, changes: &[(&str, Value)]) -> Values {
    let mut test = program.declare().unwrap_or_else(|error| panic!("{error}")).nominal();
    for (name, value) in changes {
        assert!(test.get(name).is_some(), "{} has no `{name}`", program.name());
        test.set(*name, value.clone());
    }
    test
}

fn parameter(program: &Program, name: &str) -> Parameter {
    let declared = program.declare().expect("it can be declared").parameters;
    declared.into_iter().find(|declared| declared.parameter.name == name).expect("it has it").parameter
}

#[test]
fn closed_it_is_broad_daylight_in_every_scenario() {
    for program in ALL {
        let run = Run::new(program, &test(program, &[]), Setup::asking_every(0.1)).unwrap();
        assert_eq!(run.weather(), Weather::default(), "{}", program.name());
    }
}

#[test]
fn light_fog_rain_and_the_sun_leave_the_place_as_it_is_in_every_scenario() {
    let air = [("fog", 0.3), ("light", 0.4), ("rain", 0.7), ("sun_elevation", 12.0), ("sun_azimuth", -40.0)];
    for program in ALL {
        let begun = |changes: &[(&str, Value)]| {
            Run::new(program, &test(program, changes), Setup::asking_every(0.1))
                .unwrap_or_else(|error| panic!("{error}"))
        };
        let places = |run: &Run| run.bodies().iter().map(|state| state.pose.position).collect::<Vec<_>>();
        let usual = begun(&[("roadside", 1.0.into())]);
        for change in air {
            let run = begun(&[("roadside", 1.0.into()), (change.0, change.1.into())]);
            assert_eq!(run.scenery(), usual.scenery(), "{} with {change:?}", program.name());
            assert_eq!(places(&run), places(&usual), "{} with {change:?}", program.name());
            assert_ne!(run.key(), usual.key(), "{} with {change:?}: the noise of cameras differs", program.name());
        }
        assert_ne!(begun(&[]).scenery(), usual.scenery(), "{}", program.name());
    }
}

#[test]
fn light_fog_rain_and_the_place_of_the_sun_vary_over_time_in_every_scenario() {
    let ranges = [
        ("fog", 0.0, 0.5),
        ("light", 1.0, 0.25),
        ("rain", 0.25, 0.0),
        ("sun_elevation", 90.0, 9.0),
        ("sun_azimuth", -180.0, 180.0),
    ];
    for program in ALL {
        let changes =
            ranges.map(|(name, from, to)| (name, Value::List(Box::new([Value::Number(from), Value::Number(to)]))));
        let opened = ranges.map(|(name, ..)| {
            let mut parameter = parameter(program, name);
            parameter.signal = Some(Shape::PiecewiseLinear { pieces: 1 });
            parameter.default = None;
            parameter
        });
        let space = Space::new(opened.into()).unwrap();
        let values = test(program, &changes);
        let mut run = Run::new(program, Test::new(&values, &space), Setup::asking_every(0.02)).unwrap();
        let duration = program.declare().unwrap().duration;
        let mut seen = 0;
        while let Step::Need(_) = run.advance() {
            let share = run.time() / duration;
            let weather = run.weather();
            let there = [
                weather.fog,
                weather.light,
                weather.rain,
                weather.sun_elevation.to_degrees(),
                weather.sun_azimuth.to_degrees(),
            ];
            for ((name, from, to), found) in ranges.into_iter().zip(there) {
                let expected = from + (to - from) * share;
                let off = (found - expected).abs() / (to - from).abs();
                assert!(off < 0.01, "{}: {name} is {found} after {} s, not {expected}", program.name(), run.time());
            }
            seen += 1;
            if seen == 50 {
                break;
            }
            run.supply(paracosm_engine::Control::default());
        }
        assert!(seen > 20, "{}: {seen} looks", program.name());
    }
}
