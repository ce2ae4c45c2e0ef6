//! Better suites, rivals, and sets of mutants with other seeds.

use super::{Audit, Screen, Suite, report, runs, study, suite};
use paracosm_campaign::Study;
use paracosm_engine::Program;
use paracosm_generators::Strategy;
use paracosm_space::constraint::Expression;

#[test]
fn a_better_suite_has_fewer_tests_smaller_holes_and_kills_all_mutants_of_the_set() {
    let crossing = paracosm_scenarios::find("pedestrian-crossing").unwrap();
    let constrained = Program::of("constrained", "a crossing with a constraint", |s| {
        crossing.build(s);
        s.constrain("distance >= 4 * speed".parse::<Expression>().unwrap());
    });
    for program in [crossing.clone(), constrained] {
        let study = Study::of(program).driver("planner").build().unwrap();
        let whole = report(&study, &["grid:9x9"], 30, 2);
        let [audited] = &whole.suites[..] else { panic!("one suite") };
        let better = audited.better.as_ref().unwrap();
        assert!(better.suite.len() < audited.tests && better.killing < better.tests);
        assert!(better.hole.upper < audited.holes.largest().lower, "{better:?}");
        assert_eq!(better.mutation_score.unwrap().value, 1.0);
        // A fresh audit of the tests agrees.
        let space = study.space();
        let points = better.suite.iter().map(|test| space.encode(test)).collect::<Result<Vec<_>, _>>().unwrap();
        let suite = Suite::new("better".to_owned(), points, &study).unwrap();
        assert_eq!(suite.left_out, 0);
        let screen = Screen::of(&study, 30, 16, 0, &runs(2)).unwrap();
        let again = Audit::of(&study, vec![suite]).unwrap().mutants(screen).run(&mut Vec::new(), |_| Ok(())).unwrap();
        let [again] = &again.suites[..] else { panic!("one suite") };
        assert_eq!(again.holes.largest(), better.hole);
        let score = again.mutants.as_ref().unwrap().all;
        assert_eq!((score.killed, score.counted), (30, 30));
    }
}

#[test]
fn no_better_suite_is_made_for_a_suite_of_few_tests() {
    let study = study("pedestrian-crossing", "planner", &[]);
    assert_eq!(report(&study, &["halton:4"], 30, 2).suites[0].better, None);
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
    let open_loop = Strategy::all().filter(|strategy| !strategy.is_adaptive()).count();
    assert_eq!(rivals.len() + refusals.len(), open_loop);
    assert!(rivals.len() > 5 && sizes.iter().all(|size| *size == 20), "{sizes:?} {refusals:?}");
}
