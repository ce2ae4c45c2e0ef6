//! Shrinking by conditions made up for the purpose, checked by looking at everything nearby.

use super::search::{Shrinker, Simpler};
use paracosm_space::{Domain, Parameter, Point, Shape, Space, Value, Values};
use proptest::prelude::*;
use std::cell::Cell;
use std::convert::Infallible;

/// Three numbers, two choices and a signal.
fn space() -> Space {
    let number = |name: &str, lo, hi| Parameter::new(name, Domain::Interval { lo, hi });
    let choice = |name: &str, levels: &[&str]| {
        Parameter::new(name, Domain::Choice(levels.iter().map(|level| Value::from(*level)).collect()))
    };
    let mut signal = number("gusts", 0.0, 1.0);
    signal.signal = Some(Shape::PiecewiseConstant { pieces: 6 });
    let parameters = vec![
        number("speed", 0.5, 10.0),
        number("distance", 5.0, 60.0),
        number("friction", 0.2, 0.8),
        choice("weather", &["clear", "rain", "fog"]),
        choice("colour", &["white", "red", "blue", "black"]),
        signal,
    ];
    Space::new(parameters).unwrap()
}

fn nominal() -> Values {
    let values = [1.4.into(), 30.0.into(), 0.8.into(), "clear".into(), "red".into(), Value::Number(0.0)];
    space().parameters().iter().map(|parameter| parameter.name.clone()).zip(values).collect()
}

/// A bound on one coordinate: at least, or at most, what stands at this share of its range or its choice.
#[derive(Debug, Clone)]
struct Bound {
    coordinate: usize,
    share: f64,
    at_least: bool,
}

impl Bound {
    fn holds(&self, point: &Point) -> bool {
        let all: Vec<f64> =
            point.continuous.iter().copied().chain(point.discrete.iter().map(|l| *l as f64 / 3.0)).collect();
        let at = all[self.coordinate % all.len()];
        if self.at_least { at >= self.share } else { at <= self.share }
    }
}

/// Fails where all bounds of one of the lists hold.
fn fails(conditions: &[Vec<Bound>], test: &Values) -> bool {
    let point = space().encode(test).expect("a test of the space");
    conditions.iter().any(|bounds| bounds.iter().all(|bound| bound.holds(&point)))
}

fn shrunk(test: &Values, budget: usize, fails: impl Fn(&Values) -> bool) -> Simpler {
    let space = space();
    let search = Shrinker::new(&space, &nominal(), test, budget, |test| Ok::<_, Infallible>(fails(test)));
    let Ok(found) = search.run();
    found
}

fn bound() -> impl Strategy<Value = Bound> {
    (0_usize..11, 0.0..1.0, any::<bool>()).prop_map(|(coordinate, share, at_least)| Bound {
        coordinate,
        share,
        at_least,
    })
}

/// The test with one parameter as it is nominally.
fn with_nominal(test: &Values, name: &str) -> Values {
    let mut other = test.clone();
    let nominal = nominal().get(name).unwrap().clone();
    let scalars = space().parameter(name).unwrap().scalars(&nominal).unwrap();
    other.set(name, if scalars.len() > 1 { Value::List(scalars.into()) } else { nominal });
    other
}

proptest! {
    #[test]
    fn a_shrunk_test_fails_and_no_parameter_of_it_can_be_set_back_alone(
        conditions in prop::collection::vec(prop::collection::vec(bound(), 1..4), 1..4),
        continuous in prop::collection::vec(0.0..1.0, 9),
        discrete in (0_usize..3, 0_usize..4),
    ) {
        let test = space().decode(&Point { continuous, discrete: vec![discrete.0, discrete.1] });
        prop_assume!(fails(&conditions, &test));
        let runs = Cell::new(0);
        let found = shrunk(&test, usize::MAX, |test| {
            runs.set(runs.get() + 1);
            fails(&conditions, test)
        });
        prop_assert!(found.complete && found.runs == runs.get(), "{found:?}");
        prop_assert!(found.runs < 2000, "{} runs", found.runs);
        prop_assert!(fails(&conditions, &found.test));
        for (name, value) in found.test.iter() {
            let other = with_nominal(&found.test, name);
            let is_nominal = other.get(name) == Some(value);
            prop_assert!(is_nominal || !fails(&conditions, &other), "{name} of {:?}", found.test);
        }
        // Shrinking what is shrunk changes nothing, nor does doing it again.
        prop_assert_eq!(&shrunk(&found.test, usize::MAX, |test| fails(&conditions, test)).test, &found.test);
        prop_assert_eq!(&shrunk(&test, usize::MAX, |test| fails(&conditions, test)).test, &found.test);
    }

    #[test]
    fn what_there_are_no_runs_for_is_left_as_it_fails(budget in 0_usize..40) {
        let test = space().decode(&Point { continuous: vec![0.9; 9], discrete: vec![2, 3] });
        let fails = |test: &Values| test.get("speed").unwrap().number().unwrap() > 3.0;
        let found = shrunk(&test, budget, fails);
        prop_assert!(found.runs <= budget && fails(&found.test));
        prop_assert!(found.complete || found.runs == budget);
    }
}

fn number(test: &Values, name: &str) -> f64 {
    test.get(name).unwrap().number().unwrap()
}

#[test]
fn numbers_become_round_and_choices_early() {
    let test = space().decode(&Point { continuous: vec![0.77; 9], discrete: vec![2, 3] });
    let found = shrunk(&test, usize::MAX, |test| {
        let late = ["blue", "black"].contains(&test.get("colour").unwrap().word().unwrap());
        number(test, "speed") >= 3.017 && number(test, "friction") <= 0.737 && late
    });
    let expected =
        [4.0.into(), 30.0.into(), 0.7.into(), "clear".into(), "blue".into(), vec![0.0; 6].into_iter().collect()];
    assert_eq!(found.test.iter().map(|(_, value)| value.clone()).collect::<Vec<_>>(), expected);
}

#[test]
fn signals_become_constant_or_get_fewer_pieces() {
    let gusts =
        |test: &Values| -> Vec<f64> { test.get("gusts").unwrap().scalars().iter().filter_map(Value::number).collect() };
    let mut continuous = vec![0.5; 3];
    continuous.extend([0.91, 0.82, 0.73, 0.64, 0.55, 0.46]);
    let test = space().decode(&Point { continuous, discrete: vec![0, 0] });
    let strong = shrunk(&test, usize::MAX, |test| gusts(test).iter().all(|gust| *gust > 0.42));
    assert_eq!(gusts(&strong.test), [0.5; 6]);
    let falling = shrunk(&test, usize::MAX, |test| gusts(test)[0] > gusts(test)[5] + 0.2);
    assert_eq!(gusts(&falling.test), [0.3, 0.3, 0.3, 0.0, 0.0, 0.0]);
}

/// Of three numbers any two have to be alike, and far from nominal.
fn alike(test: &Values) -> bool {
    let shares = [("speed", 0.5, 10.0), ("distance", 5.0, 60.0), ("friction", 0.2, 0.8)];
    let shares = shares.map(|(name, lo, hi)| (number(test, name) - lo) / (hi - lo));
    shares.iter().all(|share| (share - shares[0]).abs() < 0.05)
}

#[test]
fn two_parameters_that_only_fail_together_are_made_simpler_together() {
    let mut test = space().decode(&Point { continuous: vec![0.9; 9], discrete: vec![1, 3] });
    test.set("friction", 0.3);
    let same = |test: &Values| {
        // Clear and red, or neither. All others are needed, so that no half of the parameters can be set back.
        let gusts = test.get("gusts").unwrap().scalars().iter().all(|gust| gust.number() > Some(0.5));
        let words = ["weather", "colour"].map(|name| test.get(name).unwrap().word().unwrap().to_owned());
        let needed = number(test, "speed") > 8.0 && number(test, "distance") > 50.0 && number(test, "friction") < 0.75;
        needed && gusts && (words[0] == "clear") == (words[1] == "red")
    };
    let found = shrunk(&test, usize::MAX, same);
    let words = ["weather", "colour"].map(|name| found.test.get(name).unwrap().word().unwrap().to_owned());
    assert_eq!(words, ["clear", "red"]);
}

#[test]
fn three_that_only_fail_together_are_left_as_they_are() {
    let test = space().decode(&Point { continuous: vec![0.9; 9], discrete: vec![0, 1] });
    let found = shrunk(&test, usize::MAX, alike);
    assert!(found.complete && alike(&found.test));
}

#[test]
fn a_constraint_is_never_violated_on_the_way() {
    let space = space().with_constraints(["colour == 'red' implies weather == 'fog'"]).unwrap();
    let test = space.decode(&Point { continuous: vec![0.5; 9], discrete: vec![2, 3] });
    let search = Shrinker::new(&space, &nominal(), &test, usize::MAX, |test: &Values| {
        assert!(space.allows(&space.encode(test).unwrap()), "{test:?}");
        Ok::<_, Infallible>(true)
    });
    let Ok(found) = search.run();
    let words = ["weather", "colour"].map(|name| found.test.get(name).unwrap().word().unwrap());
    assert!(words == ["clear", "white"] || words == ["fog", "red"], "{words:?}");
}
