//! Audits of small suites of the catalogue's scenarios.

use super::runs::{gives_away, mutated};
use super::*;
use paracosm_campaign::Catalogue;
use paracosm_engine::Program;
use paracosm_space::constraint::Expression;
use paracosm_space::{Domain, Values};
use std::num::NonZeroUsize;

fn study(scenario: &str, driver: &str, opened: &[&str]) -> Study {
    let catalogue = Catalogue::of(paracosm_scenarios::ALL);
    let study = Study::of(catalogue.find(scenario).unwrap()).driver(driver);
    opened.iter().fold(study, |study, name| study.open(name)).build().unwrap()
}

fn suite(text: &str, study: &Study) -> Suite {
    Suite::of(&text.parse().unwrap(), study).unwrap()
}

fn runs(jobs: usize) -> Runs {
    Runs { jobs: NonZeroUsize::new(jobs).unwrap(), ..Runs::default() }
}

fn report(study: &Study, suites: &[&str], mutants: usize, jobs: usize) -> Report {
    let suites = suites.iter().map(|text| suite(text, study)).collect();
    let screen = Screen::of(study, mutants, 16, 0, &runs(jobs)).unwrap();
    Audit::of(study, suites).unwrap().mutants(screen).runs(runs(jobs)).run(&mut Vec::new(), |_| Ok(())).unwrap()
}

#[test]
fn the_hole_of_a_single_row_is_the_dispersion() {
    let study = study("pedestrian-crossing", "aeb", &[]);
    let audited = report(&study, &["halton:40"], 0, 1).suites.remove(0);
    assert_eq!(audited.coverage.continuous.unwrap().bracket(Measure::DISPERSION), Some(audited.holes.largest()));
    assert_eq!(audited.holes.rows.len(), 1);
    assert!(audited.mutants.is_none_or(|score| score.all.mutants == 0));
}

#[test]
fn each_row_of_discrete_values_has_a_hole_and_an_empty_row_is_a_hole_as_a_whole() {
    let study = study("cut-in", "fsm", &["vehicle"]);
    let space = study.space();
    let points = suite("halton:60", &study).points.into_iter().filter(|point| point.discrete == [0]).collect();
    let suite = Suite::new("one row".to_owned(), points, &study).unwrap();
    let holes = Holes::of(&suite, &study, Deadline::never()).unwrap();
    assert_eq!(holes.rows.len(), space.levels()[0]);
    let (empty, tested): (Vec<_>, Vec<_>) = holes.rows.iter().partition(|hole| hole.tests == 0);
    assert!(empty.iter().all(|hole| hole.volume.upper >= 1.0), "{empty:?}");
    assert!(tested.len() == 1 && tested[0].volume.upper < 0.5, "{tested:?}");
}

#[test]
fn a_witness_fails_in_a_box_that_no_test_has_entered() {
    for (scenario, driver) in [("pedestrian-crossing", "planner"), ("cut-in", "fsm"), ("cut-out", "rss")] {
        let study = study(scenario, driver, &[]);
        let suite = suite("halton:40", &study);
        let report = Audit::of(&study, vec![suite.clone()]).unwrap().run(&mut Vec::new(), |_| Ok(())).unwrap();
        let witness = report.suites[0].witness.as_ref().unwrap_or_else(|| panic!("{scenario} has no witness"));
        assert_eq!(witness.tests_inside, 0);
        let active = |test: &Values| witness.mutant.is_active(test);
        assert!(!suite.values(&study).iter().any(active) && active(&witness.test));
        let blind = mutated(&study, witness.mutant.defect).unwrap();
        let test = std::slice::from_ref(&witness.test);
        let [given, trial] = [&study, &blind].map(|study| runs(1).of(study, test).unwrap().remove(0));
        assert_eq!(gives_away(&given, &trial), Some(witness.requirement.as_str()));
        assert!(witness.failing >= 1 && witness.failing <= witness.tried);
        let [lower, upper] = witness.probability_interval;
        assert!(lower <= witness.volume && witness.volume <= upper, "uniform distributions: {witness:?}");
    }
}

#[test]
fn each_mutant_of_a_screen_is_noticed_and_a_smaller_set_is_a_part() {
    let study = study("pedestrian-crossing", "aeb", &[]);
    let screen = Screen::of(&study, 60, 16, 0, &runs(2)).unwrap();
    assert_eq!(screen.mutants.len(), 60);
    let smaller = Screen::of(&study, 25, 16, 0, &runs(1)).unwrap().mutants;
    assert!(smaller.len() == 25 && smaller.iter().all(|one| screen.mutants.contains(one)));
    for noticed in &screen.mutants {
        let test = std::slice::from_ref(&noticed.test.test);
        assert!(noticed.mutant.is_active(&test[0]));
        let with = mutated(&study, noticed.mutant.defect).unwrap();
        let [given, trial] = [&study, &with].map(|study| runs(1).of(study, test).unwrap().remove(0));
        assert_eq!(gives_away(&given, &trial), Some(noticed.test.requirement.as_str()), "{}", noticed.mutant);
    }
}

#[test]
fn results_do_not_depend_on_the_number_of_jobs_or_on_an_interruption() {
    let study = study("pedestrian-crossing", "aeb", &[]);
    let whole = report(&study, &["halton:20", "grid:5x4"], 40, 1);
    assert_eq!(whole, report(&study, &["halton:20", "grid:5x4"], 40, 2));
    let suites = || ["halton:20", "grid:5x4"].map(|text| suite(text, &study)).to_vec();
    let audit = || Audit::of(&study, suites()).unwrap().mutants(Screen::of(&study, 40, 16, 0, &runs(2)).unwrap());
    let mut tried = Vec::new();
    let mut left = 17;
    let cut = audit().run(&mut tried, |_| {
        left -= 1;
        if left == 0 { Err(Error::Interrupted) } else { Ok(()) }
    });
    assert!(cut.is_err() && tried.len() == 16);
    assert_eq!(audit().run(&mut tried, |_| Ok(())).unwrap(), whole);
}

#[test]
fn a_suite_that_meets_more_failures_of_the_screen_kills_more_mutants() {
    let study = study("pedestrian-crossing", "aeb", &[]);
    let report = report(&study, &["halton:4", "halton:200"], 100, 2);
    let [few, many] = [0, 1].map(|at| report.suites[at].mutants.clone().unwrap());
    assert!(few.all.killed < many.all.killed, "{few:?} {many:?}");
    // Every test of the short suite is in the long one.
    assert!(few.kinds.iter().zip(&many.kinds).all(|(few, many)| few.all.killed <= many.all.killed));
    for (at, score) in [(0, &few), (1, &many)] {
        let additions = report.suites[at].additions.clone().unwrap();
        assert_eq!(additions.missed, 100 - score.all.killed);
        let witness = report.suites[at].witness.as_ref().unwrap();
        assert_eq!(additions.tests.last(), Some(&witness.test));
        assert!(additions.at_least < additions.tests.len() && additions.tests.len() <= additions.missed + 1);
    }
    let screen = Screen::of(&study, 100, 16, 0, &runs(2)).unwrap();
    let suites = ["halton:4", "halton:200"].map(|text| suite(text, &study));
    assert_eq!(screen.scores(&study, &suites, &runs(2)).unwrap(), [few.clone(), many.clone()]);
    let sum = |score: &Score| score.kinds.iter().map(|kind| kind.all.killed).sum::<usize>();
    assert_eq!((sum(&few), sum(&many)), (few.all.killed, many.all.killed));
}

#[test]
fn the_listed_values_of_a_scenario_are_a_suite_of_the_open_intervals() {
    let catalogue = Catalogue::of(paracosm_scenarios::ALL);
    let open = |over: Option<Vec<f64>>| {
        let study = Study::of(catalogue.find("pedestrian-crossing").unwrap());
        let listed = |values: Vec<f64>| Domain::Choice(values.into_iter().map(Into::into).collect());
        let study = match over {
            Some(values) => study.open_over("speed", listed(values)).open_over("distance", listed(vec![20.0, 40.0])),
            None => study,
        };
        study.build().unwrap()
    };
    let (study, listed) = (open(None), open(Some(vec![1.0, 2.0, 5.0])));
    let suite = Suite::stated(&listed, &study).unwrap();
    assert_eq!(suite.points.len(), 6);
    assert_eq!(suite.values(&study)[5].get("speed").and_then(paracosm_space::Value::number), Some(5.0));
    // Where nothing but listed values is open, they are the whole space, and no hole is left for a witness.
    let whole = Suite::stated(&listed, &listed).unwrap();
    let audited = Audit::of(&listed, vec![whole]).unwrap().run(&mut Vec::new(), |_| Ok(())).unwrap().suites.remove(0);
    assert_eq!((audited.tests, audited.holes.largest().upper), (6, 0.0));
    assert!(audited.witness.is_none() && audited.mutants.is_none());
    assert!(Suite::stated(&study, &study).unwrap_err().to_string().contains("name a suite"));
}

#[test]
fn what_has_no_driver_in_this_process_is_refused() {
    let catalogue = Catalogue::of(paracosm_scenarios::ALL);
    let program = catalogue.find("pedestrian-crossing").unwrap();
    let external = Study::of(program.clone()).driver("grpc://localhost:1").build().unwrap();
    let flaw = Audit::of(&external, Vec::new()).unwrap_err();
    assert!(matches!(flaw, AuditFlaw::External { .. }), "{flaw}");
}

#[test]
fn a_smaller_suite_has_fewer_tests_smaller_holes_and_kills_all_mutants_of_the_set() {
    let crossing = paracosm_scenarios::find("pedestrian-crossing").unwrap();
    let constrained = Program::of("constrained", "a crossing with a constraint", |s| {
        crossing.build(s);
        s.constrain("distance >= 4 * speed".parse::<Expression>().unwrap());
    });
    for program in [crossing.clone(), constrained] {
        let study = Study::of(program).driver("planner").build().unwrap();
        let whole = report(&study, &["grid:9x9"], 30, 2);
        let [audited] = &whole.suites[..] else { panic!("one suite") };
        let smaller = audited.smaller.as_ref().unwrap();
        assert!(smaller.tests.len() < audited.tests && smaller.killing < smaller.tests.len());
        assert!(smaller.largest_hole.upper < audited.holes.largest().lower, "{smaller:?}");
        // A fresh audit of the tests agrees.
        let space = study.space();
        let points = smaller.tests.iter().map(|test| space.encode(test)).collect::<Result<Vec<_>, _>>().unwrap();
        let suite = Suite::new("smaller".to_owned(), points, &study).unwrap();
        assert_eq!(suite.left_out, 0);
        let screen = Screen::of(&study, 30, 16, 0, &runs(2)).unwrap();
        let again = Audit::of(&study, vec![suite]).unwrap().mutants(screen).run(&mut Vec::new(), |_| Ok(())).unwrap();
        let [again] = &again.suites[..] else { panic!("one suite") };
        assert_eq!(again.holes.largest(), smaller.largest_hole);
        let score = again.mutants.as_ref().unwrap().all;
        assert_eq!((score.killed, score.mutants), (30, 30));
    }
}

#[test]
fn no_smaller_suite_is_made_for_a_suite_of_few_tests_or_of_listed_values() {
    let study = study("pedestrian-crossing", "planner", &[]);
    assert_eq!(report(&study, &["halton:4"], 30, 2).suites[0].smaller, None);
}

#[test]
fn another_seed_gives_other_mutants_and_other_tests_of_the_screen() {
    let study = study("pedestrian-crossing", "aeb", &[]);
    let [one, other] = [0, 1].map(|seed| Screen::of(&study, 40, 16, seed, &runs(2)).unwrap());
    assert!(one.values != other.values);
    let conditional = |screen: &Screen| {
        let with = screen.mutants.iter().filter(|noticed| !noticed.mutant.when.is_empty());
        with.map(|noticed| noticed.mutant.to_string()).collect::<Vec<_>>()
    };
    let (one, other) = (conditional(&one), conditional(&other));
    assert!(!one.is_empty() && !one.iter().any(|mutant| other.contains(mutant)));
}

#[test]
fn every_strategy_that_does_not_learn_makes_a_rival_of_the_same_size() {
    let study = study("pedestrian-crossing", "aeb", &[]);
    let (rivals, refusals) = suite("grid:5x4", &study).rivals(&study);
    let sizes: Vec<usize> = rivals.iter().map(|suite| suite.points.len()).collect();
    let open_loop = paracosm_generators::Strategy::all().filter(|strategy| !strategy.is_adaptive()).count();
    assert_eq!(rivals.len() + refusals.len(), open_loop);
    assert!(rivals.len() > 5 && sizes.iter().all(|size| *size == 20), "{sizes:?} {refusals:?}");
}
