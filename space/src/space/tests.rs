use super::*;
use crate::parameter::ParameterFlaw;
use crate::{ParameterError, Shape};
use proptest::prelude::*;

fn pedestrian() -> Space {
    let mut speed = Parameter::new("speed", Domain::Interval { lo: 0.5, hi: 10.0 });
    speed.unit = Some("m/s".into());
    speed.default = Some(1.4.into());
    let lanes = Parameter::new("lanes", Domain::Choice(vec![2.into(), 4.into(), 6.into()]));
    let weather = Parameter::new("weather", Domain::Choice(vec!["clear".into(), "fog".into()]));
    Space::new(vec![speed, lanes, weather]).unwrap()
}

fn interval(lo: f64, hi: f64) -> Result<Space, SpaceError> {
    Space::new(vec![Parameter::new("x", Domain::Interval { lo, hi })])
}

#[test]
fn a_space_written_as_toml_is_read_back_as_the_same_space() {
    let space = pedestrian();
    assert_eq!(Space::from_toml(&space.to_toml()), Ok(space));
}

#[test]
fn numbers_of_a_choice_are_kept_as_they_are_written() {
    let text =
        "[[parameter]]\nname = \"a\"\nchoice = [1.0, 2.50, 1e-3, +4, 1_000, 0x10, -0.0, 1e300, 0.50, \"0.50\"]\n";
    let space = Space::from_toml(text).unwrap();
    let written = |space: &Space| {
        let levels = space.parameters()[0].levels().unwrap();
        levels.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    // What only TOML writes so is written as the number, and what a word is like.
    assert_eq!(written(&space), ["1.0", "2.50", "1e-3", "+4", "1000", "16", "-0.0", "1e300", "0.5", "0.50"]);
    assert_eq!(Space::from_toml(&space.to_toml()), Ok(space.clone()));
    let json = serde_json::to_string(&space).unwrap();
    assert_eq!(serde_json::from_str::<Space>(&json).unwrap(), space);
    let test = space.decode(&Point { continuous: vec![], discrete: vec![1] });
    assert_eq!(serde_json::to_string(&test).unwrap(), "{\"a\":2.5}", "a number to those who use it");
    let twice = "[[parameter]]\nname = \"a\"\nchoice = [1.0, 1.00]\n";
    assert_eq!(Space::from_toml(twice).unwrap_err().to_string(), "parameter `a`: the choice names 1 twice");
    for (texts, message) in [
        (
            "[\"1\"]",
            "parameter `a`: the key `written` has length 1, expected length 2, a text for each value of `choice`",
        ),
        ("[\"1\", \"2.1\"]", "parameter `a`: found `2.1` in `written`, expected a text of the value 2"),
    ] {
        let toml = format!("[[parameter]]\nname = \"a\"\nchoice = [1, 2]\nwritten = {texts}\n");
        assert_eq!(Space::from_toml(&toml).unwrap_err().to_string(), message);
    }
}

#[test]
fn a_test_written_as_json_keeps_its_order_and_its_numbers() {
    let space = pedestrian();
    let values = space.decode(&Point { continuous: vec![0.25], discrete: vec![2, 1] });
    let text = serde_json::to_string(&values).unwrap();
    assert_eq!(text, r#"{"speed":2.875,"lanes":6,"weather":"fog"}"#);
    assert_eq!(serde_json::from_str::<Values>(&text).unwrap(), values);
}

#[test]
fn intervals_that_hold_no_interval_are_refused() {
    for (lo, hi) in [(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::NAN), (0.0, f64::INFINITY)] {
        let error = interval(lo, hi).unwrap_err();
        assert!(
            matches!(error, SpaceError::Parameter(ParameterError { flaw: ParameterFlaw::Interval { .. }, .. })),
            "{lo} {hi}: {error}"
        );
    }
}

#[test]
fn values_that_are_not_in_the_space_are_named_with_the_nearest_valid_one() {
    let space = pedestrian();
    let with = |name: &str, value: Value| {
        let mut values = space.decode(&Point { continuous: vec![0.1], discrete: vec![2, 1] });
        values.set(name, value);
        space.encode(&values).unwrap_err().to_string()
    };
    assert_eq!(with("speed", 11.0.into()), "parameter `speed`: found 11, expected a number in [0.5, 10]");
    assert_eq!(with("speed", f64::NAN.into()), "parameter `speed`: found NaN, expected a number in [0.5, 10]");
    assert_eq!(with("lanes", 3.into()), "parameter `lanes`: found 3, expected one of 2, 4, 6");
    assert_eq!(
        with("weather", "frog".into()),
        "parameter `weather`: found frog, expected one of clear, fog (did you mean `fog`?)"
    );
    assert_eq!(with("lane", 2.into()), "no parameter is called `lane` (did you mean `lanes`?)");
}

#[test]
fn a_space_file_with_an_error_says_where_it_is() {
    let refuse = |text: &str| {
        let error = Space::from_toml(text).unwrap_err();
        (error.to_string(), error.at().map(|at| at.line))
    };
    let (message, line) = refuse("[[parameter]]\nname = \"a\"\nintervall = [0.0, 1.0]\n");
    assert!(message.contains("intervall") && message.contains("interval"), "{message}");
    assert_eq!(line, Some(3));
    let (message, _) = refuse("[[parameter]]\nname = \"a\"\ninterval = [0.0, 1.0]\nscale = \"log\"\n");
    assert_eq!(message, "parameter `a`: the key `scale` is not supported by this version; remove the key");
    let (message, _) = refuse("[[parameter]]\nname = \"a\"\ninterval = [1.0, 0.0]\n");
    assert!(message.contains("interval [1, 0]"), "{message}");
    let (message, _) = refuse("[[parameter]]\nname = \"a\"\n");
    assert!(message.contains("expected either `interval"), "{message}");
    let (message, _) = refuse("[[parameter]]\nname = \"a\"\nchoice = [1]\n[[parameter]]\nname = \"a\"\nchoice = [1]\n");
    assert_eq!(message, "parameter `a` is declared twice");
}

#[test]
fn a_space_has_at_most_ten_thousand_parameters() {
    let parameters = |count: usize| {
        (0..count).map(|i| Parameter::new(format!("p{i}"), Domain::Interval { lo: 0.0, hi: 1.0 })).collect()
    };
    assert!(Space::new(parameters(10_000)).is_ok());
    let error = Space::new(parameters(10_001)).unwrap_err();
    assert_eq!(error.to_string(), "found 10001 parameters, expected at most 10000: fix some of them");
}

fn varying(parameter: Parameter, shape: Shape) -> Parameter {
    Parameter { signal: Some(shape), ..parameter }
}

/// A parameter of every kind that varies, and one that does not.
fn signals() -> Space {
    let interval = |name: &str, lo, hi| Parameter::new(name, Domain::Interval { lo, hi });
    let weather = Parameter::new("weather", Domain::Choice(vec!["clear".into(), "fog".into()]));
    Space::new(vec![
        varying(weather, Shape::PiecewiseConstant { pieces: 2 }),
        varying(interval("leader", 0.0, 20.0), Shape::Polynomial { degree: 2 }),
        interval("gap", 5.0, 60.0),
        varying(interval("light", 0.0, 1.0), Shape::PiecewiseLinear { pieces: 1 }),
        varying(interval("friction", 0.2, 0.8), Shape::PiecewiseConstant { pieces: 2 }),
    ])
    .unwrap()
}

#[test]
fn a_signal_counts_once_for_each_of_its_coordinates() {
    let space = signals();
    assert_eq!((space.dims(), space.levels()), (8, vec![2, 2]));
    let names: Vec<String> = space.coordinates().map(|coordinate| coordinate.name()).collect();
    let expected = [
        "weather[0]",
        "weather[1]",
        "leader[0]",
        "leader[1]",
        "leader[2]",
        "gap",
        "light[0]",
        "light[1]",
        "friction[0]",
        "friction[1]",
    ];
    assert_eq!(names, expected);
    assert_eq!(space.continuous().map(|coordinate| coordinate.name()).collect::<Vec<_>>(), expected[2..]);
    assert_eq!(space.discrete().map(|coordinate| coordinate.name()).collect::<Vec<_>>(), expected[..2]);
}

#[test]
fn the_value_of_a_signal_is_a_list_or_one_value_for_all() {
    let space = signals();
    let point = Point { continuous: vec![0.0, 0.5, 1.0, 0.5, 0.25, 0.75, 0.0, 1.0], discrete: vec![1, 0] };
    let values = space.decode(&point);
    let text = r#"{"weather":["fog","clear"],"leader":[0,10,20],"gap":32.5,"light":[0.25,0.75],"friction":[0.2,0.8]}"#;
    assert_eq!(serde_json::to_string(&values).unwrap(), text);
    assert_eq!(serde_json::from_str::<Values>(text).unwrap(), values);
    let mut constant = values;
    constant.set("leader", 5.0);
    assert_eq!(space.encode(&constant).unwrap().continuous[..3], [0.25; 3]);
}

#[test]
fn a_space_with_signals_is_written_as_the_contract_says() {
    let toml = "[[parameter]]\nname = \"leader\"\ninterval = [0.0, 20.0]\n";
    let read = |signal: &str| Space::from_toml(&format!("{toml}signal = {signal}\n"));
    let shape = |signal: &str| read(signal).unwrap().parameters()[0].signal;
    assert_eq!(shape(r#"{ shape = "polynomial", degree = 2 }"#), Some(Shape::Polynomial { degree: 2 }));
    assert_eq!(shape(r#"{ shape = "piecewise-constant", pieces = 3 }"#), Some(Shape::PiecewiseConstant { pieces: 3 }));
    assert_eq!(shape(r#"{ shape = "piecewise-linear", pieces = 4 }"#), Some(Shape::PiecewiseLinear { pieces: 4 }));
    assert_eq!(shape(r#"{ shape = "constant" }"#), None);
    assert_eq!(Space::from_toml(&signals().to_toml()), Ok(signals()));
    let refused = |signal: &str, expected: &str| {
        let error = read(signal).unwrap_err().to_string();
        assert!(error.contains(expected) && error.contains("leader"), "{signal}: {error}");
    };
    refused(r#"{ shape = "polinomial", degree = 2 }"#, "did you mean `polynomial`?");
    refused(r#"{ shape = "polynomial", pieces = 2 }"#, "takes the key `degree`, and not the key `pieces`");
    refused(r#"{ shape = "polynomial", degree = 2, pieces = 2 }"#, "takes the key `degree`, and not the key `pieces`");
    refused(r#"{ shape = "piecewise-linear" }"#, "takes the key `pieces`, and not the key `degree`");
    refused(r#"{ shape = "piecewise-constant", pieces = 0 }"#, "has 0 coordinates, expected 1 to 1000000");
    refused(r#"{ shape = "piecewise-linear", pieces = 0 }"#, "at least one piece");
    refused(r#"{ shape = "polynomial", degree = 10000000000 }"#, "expected 1 to 1000000");
}

#[test]
fn values_that_make_no_signal_are_refused() {
    let space = signals();
    let with = |name: &str, value: Value| {
        let mut values = space.decode(&Point { continuous: vec![0.5; 8], discrete: vec![0, 1] });
        values.set(name, value);
        space.encode(&values).unwrap_err().to_string()
    };
    assert_eq!(
        with("leader", [1.0, 2.0].into()),
        "parameter `leader`: found 2 values, expected 3 for a signal of shape polynomial(2)"
    );
    assert_eq!(with("leader", [1.0, 2.0, 21.0].into()), "parameter `leader`: found 21, expected a number in [0, 20]");
    assert_eq!(with("gap", [6.0].into()), "parameter `gap`: found [6], expected a number in [5, 60]");
    let weather = Parameter::new("weather", Domain::Choice(vec!["clear".into(), "fog".into()]));
    let error = Space::new(vec![varying(weather, Shape::Polynomial { degree: 1 })]).unwrap_err().to_string();
    assert_eq!(
        error,
        "parameter `weather`: found a signal of the shape polynomial(1) for a choice, expected the shape piecewise-constant"
    );
    let taken = Parameter::new("light[1]", Domain::Interval { lo: 0.0, hi: 1.0 });
    let parameters = signals().parameters().iter().cloned().chain([taken]).collect();
    assert_eq!(Space::new(parameters), Err(SpaceError::Twice { name: "light[1]".into() }));
}

#[test]
fn shapes_are_read_as_they_are_written() {
    for text in ["polynomial(2)", "piecewise-constant(5)", "piecewise-linear(1)"] {
        assert_eq!(text.parse::<Shape>().unwrap().to_string(), text);
        let for_a_shell = text.replace('(', ":").replace(')', "");
        assert_eq!(for_a_shell.parse::<Shape>(), text.parse());
    }
    let refused = |text: &str| text.parse::<Shape>().unwrap_err().to_string();
    assert!(refused("piecewise-liner:2").contains("(did you mean `piecewise-linear`?)"));
    assert!(refused("polynomial").contains("expected the shape `polynomial` with a number"));
    assert!(refused("polynomial:two").contains("polynomial:two"));
}

/// The value of a Bézier curve by de Casteljau's corner cutting, straight from its definition.
fn casteljau(coefficients: &[f64], u: f64) -> f64 {
    match coefficients {
        [value] => *value,
        values => (1.0 - u) * casteljau(&values[..values.len() - 1], u) + u * casteljau(&values[1..], u),
    }
}

proptest! {
    #[test]
    fn a_polynomial_has_these_bernstein_coefficients(
        values in prop::collection::vec(-20.0..20.0f64, 1..9), tick in 0..=100usize
    ) {
        let shape = Shape::Polynomial { degree: values.len() - 1 };
        let value = shape.number_at(&values, tick, 100);
        prop_assert!((value - casteljau(&values, tick as f64 / 100.0)).abs() < 1e-12, "{}", value);
    }

    #[test]
    fn every_shape_stays_in_the_range_of_its_values_and_is_constant_where_they_are(
        values in prop::collection::vec(-1e3..1e3f64, 2..40), tick in 0..=333usize
    ) {
        let n = values.len();
        let shapes = [
            Shape::Polynomial { degree: n - 1 },
            Shape::PiecewiseConstant { pieces: n },
            Shape::PiecewiseLinear { pieces: n - 1 },
        ];
        let (least, most) = values.iter().fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(*v), b.max(*v)));
        for shape in shapes {
            let value = shape.number_at(&values, tick, 333);
            prop_assert!((least..=most).contains(&value), "{}: {}", shape, value);
            prop_assert_eq!(shape.number_at(&vec![values[0]; n], tick, 333), values[0]);
        }
    }

    #[test]
    fn pieces_are_equal_parts_of_a_run(pieces in 1..50usize, ticks in 1..500usize) {
        let values: Vec<f64> = (0..=pieces).map(|i| i as f64).collect();
        for tick in 0..=ticks {
            // Of the line from 0 to the number of pieces, joints are whole numbers.
            let line = pieces as f64 * tick as f64 / ticks as f64;
            let step = Shape::PiecewiseConstant { pieces }.number_at(&values[..pieces], tick, ticks);
            let exact = (tick * pieces / ticks).min(pieces - 1);
            prop_assert_eq!(step, exact as f64);
            let linear = Shape::PiecewiseLinear { pieces }.number_at(&values, tick, ticks);
            prop_assert!((linear - line).abs() < 1e-12 * pieces as f64, "{} {}", linear, line);
        }
    }

    #[test]
    fn signals_survive_the_round_trip(
        continuous in prop::collection::vec(0.0..=1.0f64, 8), discrete in prop::collection::vec(0..2usize, 2)
    ) {
        let space = signals();
        let values = space.decode(&Point { continuous, discrete: discrete.clone() });
        let point = space.encode(&values).unwrap();
        prop_assert_eq!(&point.discrete, &discrete);
        prop_assert_eq!(space.decode(&point), values);
    }

    #[test]
    fn encoding_what_was_decoded_gives_the_same_values_back(
        lo in -1e6..1e6f64, width in prop_oneof![1e-6..1.0f64, 1.0..1e6f64], u in 0.0..=1.0f64
    ) {
        let space = interval(lo, lo + width).unwrap();
        let values = space.decode(&Point { continuous: vec![u], discrete: vec![] });
        let point = space.encode(&values).unwrap();
        prop_assert_eq!(space.decode(&point), values);
        // What is lost is rounding of the value, magnified where the interval is far from 0.
        let resolution = 4.0 * f64::EPSILON * (1.0 + (lo.abs() + width) / width);
        prop_assert!((point.continuous[0] - u).abs() <= resolution, "{} {}", point.continuous[0], u);
    }

    #[test]
    fn every_coordinate_decodes_into_the_domain(lo in -1e3..1e3f64, width in 1e-9..1e3f64, u in 0.0..=1.0f64) {
        let space = interval(lo, lo + width).unwrap();
        let values = space.decode(&Point { continuous: vec![u], discrete: vec![] });
        prop_assert!(space.encode(&values).is_ok());
    }

    #[test]
    fn levels_survive_the_round_trip(lanes in 0..3usize, weather in 0..2usize) {
        let point = Point { continuous: vec![0.25], discrete: vec![lanes, weather] };
        let space = pedestrian();
        prop_assert_eq!(space.encode(&space.decode(&point)).unwrap(), point);
    }
}

#[test]
fn distributions_are_read_written_and_checked() {
    let text = |distribution: &str| {
        format!("parameter = [{{ name = \"speed\", interval = [0.5, 10.0], distribution = {distribution} }}]")
    };
    let space = Space::from_toml(&text("{ beta = [2, 5] }")).unwrap();
    assert_eq!(space.parameters()[0].distribution, crate::Distribution::Beta(2.0, 5.0));
    assert_eq!(Space::from_toml(&space.to_toml()).unwrap(), space);
    let uniform = Space::from_toml(&text("\"uniform\"")).unwrap();
    assert!(!uniform.to_toml().contains("distribution"), "what is usual is not written");
    for (wrong, says) in [
        ("{ beat = [2, 5] }", "`beta`"),
        ("{ beta = 2 }", "two numbers"),
        ("{ beta = [2, \"x\"] }", "`x`"),
        ("{ beta = [2, 5], normal = [1, 1] }", "exactly one"),
        ("3", "{ beta = [2.0, 5.0] }"),
        ("{ weights = [1, 2] }", "choice"),
        ("{ triangular = 11 }", "[0.5, 10]"),
    ] {
        let message = Space::from_toml(&text(wrong)).unwrap_err().to_string();
        assert!(message.contains(says), "{wrong}: {message}");
    }
}

#[test]
fn quantiles_become_tests_in_the_order_of_the_coordinates() {
    let space = Space::from_toml(
        "[[parameter]]\nname = \"weather\"\nchoice = [\"clear\", \"rain\", \"fog\"]\ndistribution = { weights = [7, 2, 1] }\n\
         [[parameter]]\nname = \"speed\"\ninterval = [0, 10]\nsignal = { shape = \"piecewise-linear\", pieces = 1 }\n\
         distribution = { triangular = 0 }\n\
         [[parameter]]\nname = \"lanes\"\nchoice = [2, 4]\n",
    )
    .unwrap();
    let point = space.at_quantiles(&[0.75, 0.0, 0.75, 0.5]);
    assert_eq!(point, Point { continuous: vec![0.0, 0.5], discrete: vec![1, 1] });
}

#[test]
fn what_a_file_says_of_the_design_domain_is_no_matter_of_the_space() {
    let parameter = "[[parameter]]\nname = \"x\"\ninterval = [0, 1]\n";
    let space = Space::from_toml(parameter).unwrap();
    let odd = format!("{parameter}[odd.load]\nvaried = [\"x\"]\n");
    assert_eq!(Space::from_toml(&odd).unwrap(), space);
    assert!(!space.to_toml().contains("odd") && !serde_json::to_string(&space).unwrap().contains("odd"));
    assert!(Space::from_toml(&format!("{parameter}[ood]\n")).is_err());
}

#[test]
fn the_discrete_part_of_a_space_keeps_the_constraints_between_its_parameters() {
    let texts = ["lanes > 2 or weather == 'clear'", "lanes > 2 or speed < 5"];
    let part = pedestrian().with_constraints(texts).unwrap().discrete_part();
    let names: Vec<&str> = part.parameters().iter().map(|parameter| parameter.name.as_str()).collect();
    assert_eq!(names, ["lanes", "weather"]);
    assert_eq!(part.constraints().iter().map(Constraint::text).collect::<Vec<_>>(), texts[..1]);
    assert!(interval(0.0, 1.0).unwrap().discrete_part().parameters().is_empty());
}
