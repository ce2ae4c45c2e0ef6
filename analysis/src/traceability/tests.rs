//! What is said of trials made up for the purpose.

use super::Traceability;
use paracosm_campaign::{BlackBox, Learned, Log, Problem, ProblemKind, Study, Trial};
use paracosm_engine::{Judgement, Measurements};
use paracosm_oracles::Verdict;
use paracosm_space::{Space, Value, Values};

fn study() -> Study {
    let space =
        "parameter = [{ name = \"x\", interval = [0, 20], unit = \"m\" }, { name = \"lanes\", choice = [2, 4] }]";
    let system = BlackBox::new("none", None).unwrap();
    Study::of_system(system, Space::from_toml(space).unwrap()).build().unwrap()
}

fn traceability(trials: &[Trial]) -> Traceability {
    Traceability::of(&Log::new(study(), Learned::new(), None, trials.to_vec())).unwrap()
}

/// A trial at `x` on two lanes that ended so, with the robustness of `a` and `b` and what it says of its premise.
fn trial(index: usize, x: f64, verdict: Verdict, [a, b]: [Option<f64>; 2], triggered: Option<bool>) -> Trial {
    let judgements = vec![Judgement::new("a", a), Judgement::new("b", b)];
    let test: Values = [("x".to_owned(), Value::Number(x)), ("lanes".to_owned(), 2.into())].into_iter().collect();
    let mut trial = Trial::judged(index, test, verdict, judgements);
    trial.measured = triggered.map(|triggered| Measurements { travelled: 0.0, contact: None, triggered });
    trial
}

fn counts(trials: &[Trial], id: usize) -> [usize; 4] {
    let traced = &traceability(trials).requirements[id];
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
    let traceability = traceability(&trials);
    assert_eq!(traceability.requirements[0].worst(), Some((-1.0, 1)));
    assert_eq!(traceability.requirements[0].violated_in, [1]);
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
    let broken = Trial::broken(9, all[0].test.clone(), Problem::new(ProblemKind::System, "it broke"));
    let traceability = traceability(&[&all[..], &[broken]].concat());
    assert_eq!((traceability.tests, traceability.broken), (8, 1));
    assert_eq!(traceability.parameters[0].gaps, [[6.0, 8.0], [14.0, 18.0]]);
    assert_eq!(traceability.parameters[1].levels, [Value::from(4)]);
    let said: Vec<String> = traceability.untested.iter().map(|gap| format!("{}: {}", gap.what, gap.why)).collect();
    let expected = [
        "b: the requirement was undecided in every test",
        "x: no test from 6 to 8 m",
        "x: no test from 14 to 18 m",
        "lanes: no test with 4",
    ];
    assert_eq!(said, expected);
}
