//! Differences between campaigns that are made up for the purpose.

use super::Difference;
use paracosm_campaign::{BlackBox, Learned, Log, Study, Trial};
use paracosm_engine::Judgement;
use paracosm_oracles::Verdict;
use paracosm_space::{Space, Value, Values};
use proptest::prelude::*;

fn log(parameter: &str, trials: &[(f64, Verdict, f64)]) -> Log {
    let space = format!("parameter = [{{ name = \"{parameter}\", interval = [0, 20], unit = \"m\" }}]");
    let system = BlackBox::new("none", None).unwrap();
    let study = Study::of_system(system, Space::from_toml(&space).unwrap()).build().unwrap();
    let trial = |(index, (x, verdict, margin)): (usize, &(f64, Verdict, f64))| {
        let test: Values = [(parameter.to_owned(), Value::Number(*x))].into_iter().collect();
        Trial::judged(index, test, *verdict, vec![Judgement::new("gap", Some(*margin))])
    };
    Log::new(study, Learned::new(), None, trials.iter().enumerate().map(trial).collect())
}

#[test]
fn tests_are_paired_by_their_values_and_counted_by_what_became_of_them() {
    use Verdict::{Fail, Inconclusive, Pass};
    let first =
        log("x", &[(1.0, Pass, 2.0), (2.0, Fail, -1.0), (3.0, Fail, -2.0), (4.0, Fail, -3.0), (5.0, Pass, 1.0)]);
    // In another order, with a test that only this campaign has, and without the test at 5.
    let second = log(
        "x",
        &[(4.0, Inconclusive, 0.5), (9.0, Fail, -9.0), (3.0, Pass, 4.0), (2.0, Fail, -1.0), (1.0, Fail, -0.5)],
    );
    let difference = Difference::of(&first, &second).unwrap();
    assert_eq!((difference.tests, difference.unpaired), (4, [1, 1]));
    assert_eq!((difference.failing, difference.still_failing), ([3, 2], 1));
    let changed = |of: &[super::Changed]| of.iter().map(|changed| changed.index).collect::<Vec<_>>();
    assert_eq!(changed(&difference.new_failures), [[0, 4]]);
    assert_eq!(difference.new_failures[0].violates, ["gap"]);
    // The test at 4 no longer fails, but it did not pass: McNemar's test does not count it.
    assert_eq!(changed(&difference.mended), [[3, 0], [2, 2]]);
    assert_eq!(difference.mcnemar_p, 1.0);
    let margin = &difference.margins[0];
    assert_eq!((margin.smaller, margin.same, margin.larger), (1, 1, 2));
    // The changes are -2.5, 0, 3.5 and 6.
    assert_eq!((margin.median, margin.worst), (1.75, Some(super::Loss { index: 4, change: -2.5 })));
}

#[test]
fn a_change_by_rounding_is_no_change_and_missing_tests_count_once() {
    use Verdict::Pass;
    let first = log("x", &[(1.0, Pass, 2.0), (2.0, Pass, 2.0), (3.0, Pass, 2.0), (3.0, Pass, 2.0), (4.0, Pass, 1.0)]);
    let second = log("x", &[(1.0, Pass, 2.0_f64.next_up()), (2.0, Pass, 2.0 - 1e-12), (4.0, Pass, 1.001)]);
    let difference = Difference::of(&first, &second).unwrap();
    let margin = &difference.margins[0];
    assert_eq!((margin.smaller, margin.same, margin.larger, margin.worst), (0, 2, 1, None));
    assert_eq!((difference.unpaired, difference.missing), ([2, 0], 1));
    assert_eq!(Difference::of(&first, &first).unwrap().missing, 0);
}

#[test]
fn campaigns_without_a_common_test_or_over_other_parameters_are_refused() {
    let first = log("speed", &[(1.0, Verdict::Pass, 2.0)]);
    let refused = |second: &Log| Difference::of(&first, second).unwrap_err().to_string();
    assert!(refused(&log("speed", &[(2.0, Verdict::Pass, 2.0)])).contains("no test in common"));
    let other = refused(&log("sped", &[(1.0, Verdict::Pass, 2.0)]));
    assert!(other.contains("`speed` is open in the first campaign") && other.contains("`sped`"), "{other}");
}

fn campaign() -> impl Strategy<Value = Vec<(f64, Verdict, f64)>> {
    let verdict = (0..Verdict::ALL.len()).prop_map(|index| Verdict::ALL[index]);
    let trial =
        (0..12_u8, verdict, -3..4_i8).prop_map(|(x, verdict, margin)| (f64::from(x), verdict, f64::from(margin)));
    prop::collection::vec(trial, 1..20)
}

proptest! {
    #[test]
    fn counts_are_those_of_a_look_at_all_values(a in campaign(), b in campaign()) {
        // Naive: for each value, the first test of each campaign.
        let first = |all: &[(f64, Verdict, f64)], x: f64| all.iter().find(|trial| trial.0 == x).map(|trial| trial.1);
        let pairs: Vec<(Verdict, Verdict)> =
            (0..12_u8).filter_map(|x| Some((first(&a, x.into())?, first(&b, x.into())?))).collect();
        let Ok(difference) = Difference::of(&log("x", &a), &log("x", &b)) else {
            prop_assert!(pairs.is_empty());
            return Ok(());
        };
        let fails = |verdict: Verdict| verdict == Verdict::Fail;
        let count = |is: &dyn Fn(Verdict, Verdict) -> bool| pairs.iter().filter(|(a, b)| is(*a, *b)).count();
        prop_assert_eq!(difference.tests, pairs.len());
        prop_assert_eq!(difference.new_failures.len(), count(&|a, b| !fails(a) && fails(b)));
        prop_assert_eq!(difference.mended.len(), count(&|a, b| fails(a) && !fails(b)));
        prop_assert_eq!(difference.still_failing, count(&|a, b| fails(a) && fails(b)));
        let back = Difference::of(&log("x", &b), &log("x", &a)).unwrap();
        prop_assert_eq!(back.mended.len(), difference.new_failures.len());
        prop_assert_eq!(back.mcnemar_p, difference.mcnemar_p);
    }
}
