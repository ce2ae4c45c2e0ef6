//! Audits of small suites of the catalogue's scenarios.

use super::near_misses::NearMisses;
use super::runs::{gives_away, mutated};
use super::*;
use paracosm_campaign::Catalogue;
use paracosm_coverage::PointSet;
use paracosm_coverage::dispersion::dispersion;
use paracosm_generators::{Request, Strategy};
use paracosm_space::{Domain, Space, Values};
use std::num::NonZeroUsize;

mod better;

fn study(scenario: &str, driver: &str, opened: &[&str]) -> Study {
    let catalogue = Catalogue::of(paracosm_scenarios::ALL);
    let study = Study::of(catalogue.find(scenario).unwrap()).driver(driver);
    opened.iter().fold(study, |study, name| study.open(name)).build().unwrap()
}

fn suite(text: &str, study: &Study) -> Suite {
    Suite::of(&text.parse().unwrap(), study, &study.catalogue()).unwrap()
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
    assert!(audited.mutants.is_none_or(|score| score.all.counted == 0));
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
        assert!(witness.agrees_on_suite);
        let active = |test: &Values| witness.mutant.is_active(test);
        assert!(!suite.values(&study).iter().any(active) && active(&witness.fails_at));
        let blind = mutated(&study, witness.mutant.defect).unwrap();
        let test = std::slice::from_ref(&witness.fails_at);
        let [given, trial] = [&study, &blind].map(|study| runs(1).of(study, test).unwrap().remove(0));
        assert_eq!(gives_away(&given, &trial), Some(witness.requirement.as_str()));
        assert!(witness.failing >= 1 && witness.failing <= witness.tried);
        let Estimate { lower, upper, .. } = witness.probability;
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
    assert!(few.by_kind.iter().zip(&many.by_kind).all(|(few, many)| few.all.killed <= many.all.killed));
    for (at, score) in [(0, &few), (1, &many)] {
        let additions = report.suites[at].additions.clone().unwrap();
        assert_eq!(additions.missed, 100 - score.all.killed);
        let witness = report.suites[at].witness.as_ref().unwrap();
        assert_eq!(additions.tests.last(), Some(&witness.fails_at));
        assert!(additions.at_least < additions.tests.len() && additions.tests.len() <= additions.missed + 1);
    }
    let screen = Screen::of(&study, 100, 16, 0, &runs(2)).unwrap();
    let suites = ["halton:4", "halton:200"].map(|text| suite(text, &study));
    assert_eq!(screen.scores(&study, &suites, &runs(2)).unwrap(), [few.clone(), many.clone()]);
    let sum = |score: &Score| score.by_kind.iter().map(|kind| kind.all.killed).sum::<usize>();
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
fn each_row_has_a_claim_and_rows_with_the_same_points_share_a_proof() {
    let study = study("cut-in", "fsm", &["vehicle"]);
    let rows = study.space().levels()[0];
    let suite = suite("grid:3x3x3x3", &study);
    let audit = || Audit::of(&study, vec![suite.clone()]).unwrap();
    let certificate = audit().run(&mut Vec::new(), |_| Ok(())).unwrap().suites.remove(0).certificate;
    assert_eq!((certificate.claims.len(), certificate.note.clone()), (rows, None));
    let holes = Holes::of(&suite, &study, Deadline::never()).unwrap();
    for (claim, hole) in certificate.claims.iter().zip(&holes.rows) {
        assert_eq!((claim.row.as_ref(), claim.lower), (Some(&hole.levels), hole.volume.lower));
        assert!(claim.upper >= hole.volume.upper && claim.upper <= hole.volume.upper * (1.0 + 1e-9), "{claim:?}");
        assert!(claim.note.is_none());
    }
    let (first, others) = certificate.claims.split_first().unwrap();
    assert!(first.like.is_none() && first.proofs.len() == 1);
    assert!(others.iter().all(|claim| claim.like == Some(0) && claim.proofs.is_empty()));
    // Without time, a certificate says so in each claim.
    let hurried = audit().time_limit(Duration::ZERO).run(&mut Vec::new(), |_| Ok(())).unwrap().suites.remove(0);
    assert!(hurried.certificate.claims.iter().all(|claim| claim.upper >= 1.0 && claim.note.is_some()));
}

#[test]
fn of_many_rows_the_largest_holes_are_certified() {
    let catalogue = Catalogue::of(paracosm_scenarios::ALL);
    let values = |n: u32| Domain::Choice((0..n).map(|i| (1.0 + 0.02 * f64::from(i)).into()).collect());
    let study = Study::of(catalogue.find("pedestrian-crossing").unwrap()).open_over("speed", values(300));
    let distances = Domain::Choice(vec![20.0.into(), 40.0.into()]);
    let study = study.open_over("distance", distances).build().unwrap();
    let suite = suite("random:100", &study);
    let audited = Audit::of(&study, vec![suite]).unwrap().run(&mut Vec::new(), |_| Ok(())).unwrap().suites.remove(0);
    assert_eq!((audited.holes.rows.len(), audited.certificate.claims.len()), (600, 256));
    assert_eq!(audited.certificate.note.as_deref(), Some("the certificate is about the 256 largest holes of 600 rows"));
}

#[test]
fn the_listed_grid_of_a_cut_in_leaves_a_larger_hole_than_forty_points() {
    // The lists of the logical scenario ALKS 4.4_1, without its constraints: a row has 5,250 tests.
    let lists = [
        vec![20.0, 30.0, 40.0, 50.0, 60.0],
        vec![-50.0, -40.0, -30.0, -20.0, -10.0],
        vec![0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0],
        vec![0.5, 1.0, 1.5, 2.0, 2.5, 3.0],
        vec![-3.0, -1.5, 0.0, 1.5, 3.0],
    ];
    let unit = |list: &Vec<f64>| -> Vec<f64> {
        let (first, last) = (list[0], list[list.len() - 1]);
        list.iter().map(|value| (value - first) / (last - first)).collect()
    };
    let axes: Vec<Vec<f64>> = lists.iter().map(unit).collect();
    let sizes: Vec<usize> = axes.iter().map(Vec::len).collect();
    let place = |at: Vec<usize>| at.iter().zip(&axes).map(|(at, axis)| axis[*at]).collect::<Vec<f64>>();
    let grid: Vec<Vec<f64>> = crate::combinations::combinations(&sizes).map(place).collect();
    assert_eq!(grid.len(), 5250);
    let halton = Strategy::HALTON.build(&Request::new(&Space::unit_cube(5), 40)).unwrap().ask(40);
    let halton: Vec<Vec<f64>> = halton.into_iter().map(|point| point.continuous).collect();
    let hole = |points: &[Vec<f64>]| dispersion(&PointSet::new(5, points).unwrap(), Deadline::never()).volume;
    let [grid, halton] = [&grid, &halton].map(|points| hole(points));
    assert_eq!(grid, paracosm_coverage::Bracket::exact(0.25));
    assert!(halton.is_exact() && (halton.upper - 0.238).abs() < 0.0005, "{halton:?}");
}
