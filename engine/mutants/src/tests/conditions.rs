use super::*;
use crate::{Condition, Mutant};
use paracosm_space::{Space, Value, Values};

fn values() -> Values {
    [("speed", Value::from(12.0)), ("weather", "fog".into()), ("lanes", 2.into())].into_iter().collect()
}

fn within(parameter: &str, lo: f64, hi: f64) -> Condition {
    Condition::Within { parameter: parameter.into(), lo, hi }
}

fn between(parameter: &str, lo: f64, hi: f64) -> Condition {
    Condition::Between { parameter: parameter.into(), lo, hi }
}

fn is(parameter: &str, value: impl Into<Value>) -> Condition {
    Condition::Is { parameter: parameter.into(), value: value.into() }
}

#[test]
fn a_condition_holds_where_it_says() {
    for (condition, holds) in [
        (within("speed", 12.0, 15.0), true),
        (within("speed", 10.0, 12.0), true),
        (within("speed", 12.1, 15.0), false),
        (between("speed", 11.0, 13.0), true),
        (between("speed", 12.0, 13.0), false),
        (between("speed", 11.0, 12.0), false),
        (within("lanes", 2.0, 4.0), true),
        (within("weather", 2.0, 4.0), false),
        (within("sped", 2.0, 14.0), false),
        (is("weather", "fog"), true),
        (is("weather", "rain"), false),
        (is("lanes", 2), true),
        (is("lanes", 4), false),
        (Condition::Is { parameter: "lanes".into(), value: Value::written("2.0") }, true),
    ] {
        assert_eq!(condition.holds(&values()), holds, "{condition}");
    }
}

#[test]
fn a_mutant_is_active_where_all_its_conditions_hold() {
    let mutant = |when: &[Condition]| Mutant { defect: defect("late-reaction", 0.5), when: when.to_vec() };
    let (yes, no) = (is("weather", "fog"), is("weather", "rain"));
    for (when, active) in [
        (vec![], true),
        (vec![yes.clone()], true),
        (vec![yes.clone(), no.clone()], false),
        (vec![yes, within("speed", 10.0, 20.0)], true),
        (vec![no], false),
    ] {
        assert_eq!(mutant(&when).is_active(&values()), active, "{}", mutant(&when));
    }
}

#[test]
fn a_mutant_is_told_in_plain_words() {
    let mutant = |when: &[Condition]| Mutant { defect: defect("late-reaction", 0.5), when: when.to_vec() };
    assert_eq!(mutant(&[]).to_string(), "late-reaction 0.5 s");
    let when = [within("speed", 10.0, 15.0), between("distance", 30.0, 60.5), is("weather", "fog")];
    let words = "late-reaction 0.5 s when speed is 10 to 15 and distance is between 30 and 60.5 and weather is fog";
    assert_eq!(mutant(&when).to_string(), words);
}

#[test]
fn a_mutant_is_written_and_read_back() {
    let when = vec![within("speed", 10.0, 15.5), between("distance", 30.0, 60.0), is("weather", "fog"), is("lanes", 2)];
    let mutant = Mutant { defect: defect("late-reaction", 0.5), when };
    let text = serde_json::to_string(&mutant).unwrap();
    let expected = concat!(
        r#"{"defect":{"kind":"late-reaction","size":0.5},"when":[{"parameter":"speed","within":[10.0,15.5]},"#,
        r#"{"parameter":"distance","between":[30.0,60.0]},{"parameter":"weather","is":"fog"},{"parameter":"lanes","is":2}]}"#,
    );
    assert_eq!(text, expected);
    assert_eq!(serde_json::from_str::<Mutant>(&text).unwrap(), mutant);
    let always = r#"{"defect":{"kind":"late-reaction","size":0.5}}"#;
    let read: Mutant = serde_json::from_str(always).unwrap();
    assert!(read.when.is_empty());
    assert_eq!(serde_json::to_string(&read).unwrap(), always);
}

#[test]
fn a_condition_without_meaning_is_refused() {
    for (text, words) in [
        (r#"{"parameter": "speed"}"#, "the condition on `speed` has 0 of `within`, `between` and `is`, expected one"),
        (r#"{"parameter": "speed", "within": [1, 2], "is": 1}"#, "has 2 of `within`"),
        (r#"{"parameter": "speed", "within": [2, 1]}"#, "has the interval [2, 1]"),
        (r#"{"parameter": "speed", "between": [1, 1]}"#, "has the interval [1, 1]"),
        (r#"{"parameter": "speed", "is": [1, 1]}"#, "has the list [1, 1], expected a number or a word"),
        (r#"{"parameter": "speed", "was": 3}"#, "unknown field `was`"),
    ] {
        let error = serde_json::from_str::<Condition>(text).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
}

#[test]
fn a_condition_on_an_unknown_parameter_is_found_with_the_nearest_name() {
    let space = Space::unit_cube(2);
    let mutant = |name: &str| Mutant { defect: defect("late-reaction", 0.5), when: vec![within(name, 0.0, 0.5)] };
    assert_eq!(mutant("x2").check(&space), Ok(()));
    let error = mutant("x3").check(&space).unwrap_err().to_string();
    assert!(error.contains("`x3`") && error.contains("did you mean"), "{error}");
}
