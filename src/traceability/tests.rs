//! What is said of trials made up for the purpose.

use super::Traceability;
use crate::{BlackBox, Study, Trial};
use paracosm_coverage::{Space, Value, Values};
use paracosm_engine::{Metric, Outcome};
use paracosm_oracles::Verdict;

fn study() -> Study {
    let space =
        "parameter = [{ name = \"x\", interval = [0, 20], unit = \"m\" }, { name = \"lanes\", choice = [2, 4] }]";
    Study::of_system(BlackBox::new("none", None).unwrap(), Space::from_toml(space).unwrap())
}

/// A trial at `x` on two lanes that ended so, with the robustness of `a` and `b` and what it says of its premise.
fn trial(index: usize, x: f64, verdict: Verdict, [a, b]: [Option<f64>; 2], triggered: Option<bool>) -> Trial {
    let robustness = vec![("a".to_owned(), a), ("b".to_owned(), b)];
    let metrics = triggered.map(|flag| ("triggered".to_owned(), Metric::Flag(flag))).into_iter().collect();
    let test: Values = [("x".to_owned(), Value::Number(x)), ("lanes".to_owned(), 2.into())].into_iter().collect();
    Trial::new(index, test, Outcome { verdict, robustness, metrics, trace: None, error: None }, None)
}

fn counts(trials: &[Trial], id: usize) -> [usize; 4] {
    let traced = &Traceability::of(&study(), trials).unwrap().requirements[id];
    [traced.passed, traced.failed, traced.undecided, traced.not_reached]
}

#[test]
fn a_requirement_is_counted_by_what_became_of_it_and_whether_the_situation_came_about() {
    let trials = [
        trial(0, 1.0, Verdict::Pass, [Some(1.0), Some(2.0)], Some(true)),
        trial(1, 3.0, Verdict::Fail, [Some(-1.0), None], Some(true)),
        trial(2, 5.0, Verdict::Inconclusive, [Some(0.5), Some(0.2)], Some(false)),
        trial(3, 7.0, Verdict::Inconclusive, [Some(0.7), None], Some(true)),
    ];
    assert_eq!(counts(&trials, 0), [2, 1, 0, 1]);
    assert_eq!(counts(&trials, 1), [1, 0, 2, 1]);
    let traceability = Traceability::of(&study(), &trials).unwrap();
    assert_eq!(traceability.requirements[0].worst(), Some((-1.0, 1)));
    assert_eq!(traceability.requirements[0].violated_in, [1]);
}

#[test]
fn the_matrix_says_of_every_test_what_became_of_every_requirement() {
    let trials = [
        trial(0, 1.0, Verdict::Pass, [Some(1.0), Some(2.0)], Some(true)),
        trial(1, 3.0, Verdict::Fail, [Some(-1.0), None], Some(true)),
        trial(2, 5.0, Verdict::Inconclusive, [Some(0.5), Some(0.2)], Some(false)),
        Trial::new(7, Values::default(), Outcome::broken(Verdict::Error, "it broke"), None),
    ];
    let csv = Traceability::of(&study(), &trials).unwrap().csv();
    let mut rows = csv::Reader::from_reader(&csv[..]);
    let tests = ["test.0", "test.1", "test.2", "test.7"];
    assert_eq!(rows.headers().unwrap().iter().skip(14).collect::<Vec<_>>(), tests);
    let rows: Vec<Vec<String>> =
        rows.records().map(|row| row.unwrap().iter().skip(14).map(str::to_owned).collect()).collect();
    assert_eq!(rows[0], ["passed", "failed", "not reached", "not judged"]);
    assert_eq!(rows[1], ["passed", "undecided", "not reached", "not judged"]);
}

#[test]
fn without_a_premise_what_is_open_elsewhere_takes_nothing_from_a_requirement_that_holds() {
    let trials = [trial(0, 1.0, Verdict::Inconclusive, [Some(1.0), None], Some(false))];
    assert_eq!(counts(&trials, 0), [1, 0, 0, 0]);
    assert_eq!(counts(&trials, 1), [0, 0, 1, 0]);
}

#[test]
fn tenths_and_levels_without_a_test_are_named_and_broken_tests_try_nothing() {
    let all = [0.0, 3.0, 5.0, 9.9, 10.0, 13.0, 19.0].map(|x| trial(0, x, Verdict::Pass, [Some(1.0), None], None));
    let broken = Trial::new(9, all[0].test.clone(), Outcome::broken(Verdict::Error, "it broke"), None);
    let traceability = Traceability::of(&study(), &[&all[..], &[broken]].concat()).unwrap();
    assert_eq!((traceability.tests, traceability.broken), (8, 1));
    assert_eq!(traceability.parameters[0].gaps, [[6.0, 8.0], [14.0, 18.0]]);
    assert_eq!(traceability.parameters[1].levels, [Value::from(4)]);
    let said: Vec<String> = traceability.untested.iter().map(|gap| format!("{}: {}", gap.what, gap.why)).collect();
    let expected = [
        "b: it was undecided in every test",
        "x: nothing from 6 to 8 m",
        "x: nothing from 14 to 18 m",
        "lanes: never 4",
    ];
    assert_eq!(said, expected);
}
