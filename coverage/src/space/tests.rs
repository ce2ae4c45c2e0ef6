use super::*;
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
        assert!(matches!(error, SpaceError::Interval { .. }), "{lo} {hi}: {error}");
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
    let refuse = |text: &str| match Space::from_toml(text).unwrap_err() {
        SpaceError::Syntax { message, at } => (message, at.map(|(line, _)| line)),
        other => (other.to_string(), None),
    };
    let (message, line) = refuse("[[parameter]]\nname = \"a\"\nintervall = [0.0, 1.0]\n");
    assert!(message.contains("intervall") && message.contains("interval"), "{message}");
    assert_eq!(line, Some(3));
    let (message, _) = refuse("[[parameter]]\nname = \"a\"\ninterval = [0.0, 1.0]\nscale = \"log\"\n");
    assert_eq!(message, "`scale` is not supported by this version");
    let (message, _) = refuse("[[parameter]]\nname = \"a\"\ninterval = [1.0, 0.0]\n");
    assert!(message.contains("interval [1, 0]"), "{message}");
    let (message, _) = refuse("[[parameter]]\nname = \"a\"\n");
    assert!(message.contains("expected either `interval"), "{message}");
    let (message, _) = refuse("[[parameter]]\nname = \"a\"\nchoice = [1]\n[[parameter]]\nname = \"a\"\nchoice = [1]\n");
    assert_eq!(message, "parameter `a` is declared twice");
}

proptest! {
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
