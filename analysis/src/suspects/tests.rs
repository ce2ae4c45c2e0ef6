//! Campaigns whose failures are known: a rule decides instead of a simulation.

use super::*;
use paracosm_campaign::{Catalogue, Learned, Sampling, Study, StudyBuilder, Trial};
use paracosm_generators::DiscreteFamily;
use paracosm_space::{Domain, Value};

fn number(test: &Values, name: &str) -> f64 {
    test.get(name).and_then(Value::number).unwrap()
}

fn among(values: &[f64]) -> Domain {
    Domain::Choice(values.iter().map(|&value| value.into()).collect())
}

/// A study of the paper's scenario by this many tests of all rows.
fn crossed(budget: usize) -> StudyBuilder {
    let program = Catalogue::of(paracosm_scenarios::ALL).find("pedestrian-crossing").unwrap();
    Study::of(program).sampling(Sampling { discrete: DiscreteFamily::Cross, budget, ..Sampling::default() })
}

/// All 54 combinations of a few values of four parameters.
fn discrete_study() -> Study {
    let study = crossed(54).open_over("speed", among(&[1.0, 2.0, 3.0]));
    let study = study.open_over("distance", among(&[10.0, 20.0, 30.0])).open("lanes");
    study.open_over("friction", among(&[0.3, 0.8])).build().unwrap()
}

/// A campaign in which this is the verdict of a test.
fn trials(study: &Study, verdict: impl Fn(&Values) -> Verdict) -> Vec<Trial> {
    let points = study.generator(&[]).unwrap().ask(study.sampling().budget);
    let trial = |(index, point)| {
        let test = study.space().decode(point);
        let verdict = verdict(&test);
        Trial::judged(index, test, verdict, Vec::new())
    };
    points.iter().enumerate().map(trial).collect()
}

fn fail_if(fails: bool) -> Verdict {
    if fails { Verdict::Fail } else { Verdict::Pass }
}

fn values(named: &[(&str, f64)]) -> Values {
    named.iter().map(|&(name, value)| (name.to_owned(), value.into())).collect()
}

fn locate(study: &Study, trials: &[Trial], verdict: impl Fn(&Values) -> Verdict) -> LocatedReport {
    LocatedReport::of(&log(study, trials), 200, |test| Ok(verdict(test))).unwrap().unwrap()
}

fn log(study: &Study, trials: &[Trial]) -> Log {
    Log::new(study.clone(), Learned::new(), None, trials.to_vec())
}

#[test]
fn every_guilty_combination_is_suspect_and_located_by_its_values() {
    let study = discrete_study();
    let slippery = |test: &Values| number(test, "friction") == 0.3 && number(test, "speed") == 3.0;
    let wide = |test: &Values| number(test, "lanes") == 6.0;
    let verdict = |test: &Values| fail_if(slippery(test) || wide(test));
    let trials = trials(&study, verdict);

    let suspects = SuspectReport::of(&log(&study, &trials)).unwrap().unwrap();
    let guilty = [values(&[("lanes", 6.0)]), values(&[("speed", 3.0), ("friction", 0.3)])];
    assert_eq!(suspects.explanation.iter().map(|suspect| suspect.values.clone()).collect::<Vec<_>>(), guilty);
    assert_eq!((suspects.found, suspects.size, suspects.unexplained.len()), (2, 3, 0));

    let located = locate(&study, &trials, verdict);
    assert!(located.unexplained.is_empty());
    let mut found: Vec<Values> = located.locations.iter().map(|location| location.values.clone()).collect();
    found.sort_by_key(|values| values.iter().count());
    assert_eq!(found, guilty);
    for location in &located.locations {
        assert_eq!((&location.conclusion, location.starting), (&Conclusion::Guilty, 0));
        assert!(location.bound.is_none_or(|bound| location.tests.len() <= bound));
    }
}

#[test]
fn what_broke_or_decided_nothing_is_no_evidence() {
    let study = discrete_study();
    let verdict = |test: &Values| match (number(test, "lanes") as i32, number(test, "speed") as i32) {
        (2, _) => Verdict::Error,
        (_, 1) => Verdict::Inconclusive,
        (_, 2) => Verdict::Fail,
        _ => Verdict::Pass,
    };
    let suspects = SuspectReport::of(&log(&study, &trials(&study, verdict))).unwrap().unwrap();
    assert_eq!(suspects.ranked.len(), 1);
    assert_eq!((&suspects.ranked[0].values, suspects.ranked[0].failures), (&values(&[("speed", 2.0)]), 12));
    // Without any test that passed there is nothing to tell apart.
    let none_passed = |test: &Values| match verdict(test) {
        Verdict::Pass => Verdict::Invalid,
        other => other,
    };
    assert_eq!(SuspectReport::of(&log(&study, &trials(&study, none_passed))).unwrap(), None);
}

#[test]
fn a_test_on_the_way_that_decides_nothing_ends_its_search_without_a_claim() {
    let study = discrete_study();
    let verdict = |test: &Values| fail_if(number(test, "lanes") == 6.0 && number(test, "speed") == 3.0);
    // Of every five tests, three are still to be run.
    let trials: Vec<Trial> = trials(&study, verdict).into_iter().filter(|trial| trial.index % 5 < 2).collect();
    let failing: Vec<usize> = trials.iter().filter(|trial| trial.is_failure()).map(|trial| trial.index).collect();
    assert!(failing.len() > 1);
    let located = locate(&study, &trials, |_| Verdict::Inconclusive);
    let undecided = Conclusion::Undecided(Verdict::Inconclusive);
    assert!(located.unexplained.iter().map(|unexplained| unexplained.failing).eq(failing));
    assert!(located.unexplained.iter().all(|unexplained| unexplained.why == undecided));
    for location in &located.locations {
        assert_eq!((&location.conclusion, location.values.iter().count(), location.bound), (&undecided, 0, None));
        assert!(location.tests.len() <= 1);
    }
}

#[test]
fn a_failure_that_cannot_be_explained_does_not_keep_the_others_from_it() {
    let study = mixed_study();
    let fast = |test: &Values| number(test, "lanes") == 4.0 && number(test, "speed") > 7.0;
    let slippery = |test: &Values| number(test, "lanes") == 6.0 && number(test, "friction") == 0.3;
    let verdict = |test: &Values| fail_if(fast(test) || slippery(test));
    let trials = trials(&study, verdict);
    let located = locate(&study, &trials, verdict);
    let guilty: Vec<_> = located.locations.iter().filter(|found| found.conclusion == Conclusion::Guilty).collect();
    assert_eq!(guilty.len(), 1);
    assert_eq!(guilty[0].values, values(&[("friction", 0.3), ("lanes", 6.0)]));
    let explained = trials.iter().filter(|trial| slippery(&trial.test)).map(|trial| trial.index);
    assert!(guilty[0].explains.iter().copied().eq(explained));
    let left = trials.iter().filter(|trial| fast(&trial.test)).map(|trial| trial.index);
    assert!(located.unexplained.iter().map(|unexplained| unexplained.failing).eq(left));
    assert!(located.unexplained.iter().all(|left| matches!(left.why, Conclusion::Refuted { .. })), "{located:?}");
}

#[test]
fn no_more_tests_are_run_than_there_may_be() {
    let study = mixed_study();
    let verdict = |test: &Values| fail_if(number(test, "lanes") == 4.0 && number(test, "friction") == 0.3);
    let trials = trials(&study, verdict);
    let mut ran = 0;
    let count = |test: &Values| {
        ran += 1;
        Ok(verdict(test))
    };
    let located = LocatedReport::of(&log(&study, &trials), 2, count).unwrap().unwrap();
    assert_eq!((ran, located.ran, located.limit), (2, 2, 2));
    assert!(located.unexplained.iter().all(|unexplained| unexplained.why == Conclusion::LimitReached));
    assert_eq!(located.unexplained.len(), trials.iter().filter(|trial| trial.is_failure()).count());
}

/// The lanes, the friction and any speed.
fn mixed_study() -> Study {
    let study = crossed(60).fix("distance", 30).open_over("friction", among(&[0.3, 0.8]));
    study.open("lanes").build().unwrap()
}

#[test]
fn continuous_values_stay_those_of_the_failing_test() {
    let study = mixed_study();
    let verdict = |test: &Values| fail_if(number(test, "lanes") == 4.0 && number(test, "friction") == 0.3);
    let trials = trials(&study, verdict);
    let located = locate(&study, &trials, verdict);
    let [location] = &located.locations[..] else { panic!("one search, found {located:?}") };
    assert_eq!(location.conclusion, Conclusion::Guilty);
    assert_eq!(location.values, values(&[("friction", 0.3), ("lanes", 4.0)]));
    assert_eq!(location.starting, 1);
    let speed = number(&trials[location.failing].test, "speed");
    assert!(location.tests.iter().all(|test| number(&test.test, "speed") == speed));
}

#[test]
fn failures_that_depend_on_continuous_values_are_not_blamed_on_discrete_ones() {
    let study = mixed_study();
    let fast = |test: &Values| fail_if(number(test, "speed") > 7.0);
    let located = locate(&study, &trials(&study, fast), fast);
    assert!(matches!(&located.locations[0].conclusion, Conclusion::NoStart(passed) if passed.len() == 3));
    // Partly discrete: what is located at this speed is refuted by slower tests.
    let both = |test: &Values| fail_if(number(test, "speed") > 7.0 && number(test, "lanes") == 4.0);
    let trials = trials(&study, both);
    let located = locate(&study, &trials, both);
    let location = &located.locations[0];
    assert_eq!(location.values, values(&[("lanes", 4.0)]));
    let Conclusion::Refuted { trials: passed, .. } = &location.conclusion else { panic!("found {location:?}") };
    assert!(passed.iter().all(|&trial| number(&trials[trial].test, "lanes") == 4.0 && !trials[trial].is_failure()));
}
