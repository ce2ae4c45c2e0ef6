//! Faults of trials made up for the purpose.

use super::{Blamed, Preventability};
use paracosm_campaign::{Problem, ProblemKind, Trial};
use paracosm_engine::Judgement;
use paracosm_oracles::Verdict;
use paracosm_space::Values;

/// A trial with these robustnesses of `a` and `b`; it fails if one is negative.
fn trial(a: Option<f64>, b: Option<f64>) -> Trial {
    let fails = [a, b].into_iter().flatten().any(|worth| worth < 0.0);
    let verdict = if fails { Verdict::Fail } else { Verdict::Pass };
    Trial::judged(3, Values::default(), verdict, vec![Judgement::new("a", a), Judgement::new("b", b)])
}

fn broken(verdict: Verdict) -> Trial {
    let mut trial = Trial::broken(3, Values::default(), Problem::new(ProblemKind::System, "it broke"));
    trial.verdict = verdict;
    trial
}

/// Whose fault a trial is by these references.
fn fault(failing: &Trial, references: Vec<(&str, Trial)>) -> Preventability {
    Blamed::new(failing, references.into_iter().map(|(name, trial)| (name.to_owned(), trial))).fault
}

#[test]
fn a_failure_is_prevented_by_who_keeps_what_was_violated() {
    let failing = trial(Some(-2.0), None);
    let better = trial(Some(0.5), Some(1.0));
    let less_bad = trial(Some(-0.5), Some(1.0));
    assert_eq!(fault(&failing, vec![("ideal", better.clone()), ("cc", less_bad.clone())]), Preventability::Preventable);
    assert_eq!(fault(&failing, vec![("ideal", less_bad.clone()), ("cruise", less_bad)]), Preventability::Unpreventable);
    assert_eq!(fault(&failing, vec![("ideal", better.clone()), ("cruise", better)]), Preventability::Induced);
}

#[test]
fn who_violates_instead_what_was_kept_prevents_nothing_but_the_undecided_is_held_against_nobody() {
    let violates_b = trial(Some(3.0), Some(-1.0));
    assert_eq!(
        fault(&trial(Some(-2.0), Some(1.0)), vec![("ideal", violates_b.clone())]),
        Preventability::Unpreventable
    );
    assert_eq!(fault(&trial(Some(-2.0), None), vec![("ideal", violates_b.clone())]), Preventability::Preventable);
    // Both were violated, and one still is.
    assert_eq!(fault(&trial(Some(-2.0), Some(-1.0)), vec![("ideal", violates_b)]), Preventability::Unpreventable);
}

#[test]
fn an_end_before_anything_was_decided_prevents_nothing() {
    let failing = trial(Some(1.0), Some(-2.0));
    // It hit something on the way to `b`.
    assert_eq!(fault(&failing, vec![("ideal", trial(Some(-1.0), None))]), Preventability::Unpreventable);
    assert_eq!(fault(&failing, vec![("ideal", trial(Some(1.0), None))]), Preventability::Unpreventable);
}

#[test]
fn what_broke_or_could_not_be_built_judges_nothing() {
    let failing = trial(Some(1.0), Some(-2.0));
    let (kept, violated) = (trial(Some(1.0), Some(2.0)), trial(Some(1.0), Some(-1.0)));
    for broken in [Verdict::Error, Verdict::Invalid].map(broken) {
        let by = |ideal: &Trial| fault(&failing, vec![("ideal", ideal.clone()), ("cruise", broken.clone())]);
        assert_eq!(by(&broken), Preventability::Unknown);
        assert_eq!(by(&violated), Preventability::Unknown);
        assert_eq!(by(&kept), Preventability::Preventable);
        let blamed = Blamed::new(&failing, [("ideal".to_owned(), broken)].into_iter());
        assert_eq!(serde_json::to_value(&blamed).unwrap()["runs"]["ideal"]["prevents"], serde_json::Value::Null);
    }
}
