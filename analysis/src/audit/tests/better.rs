//! Better suites, rivals, and sets of mutants with other seeds.

use super::{Audit, NearMisses, Screen, Suite, report, runs, study, suite};
use paracosm_campaign::{Study, Trial};
use paracosm_engine::Program;
use paracosm_generators::Strategy;
use paracosm_space::Point;
use paracosm_space::constraint::Expression;

#[test]
fn a_better_suite_has_fewer_tests_smaller_holes_and_kills_as_many_mutants() {
    let crossing = paracosm_scenarios::find("pedestrian-crossing").unwrap();
    let constrained = Program::of("constrained", "a crossing with a constraint", |s| {
        crossing.build(s);
        s.constrain("distance >= 4 * speed".parse::<Expression>().unwrap());
    });
    for program in [crossing.clone(), constrained] {
        let study = Study::of(program).driver("planner").build().unwrap();
        let whole = report(&study, &["grid:9x9", "grid:8x8"], 30, 2);
        let [audited, other] = &whole.suites[..] else { panic!("two suites") };
        assert_eq!(other.better, None);
        let better = audited.better.as_ref().unwrap();
        assert!(better.suite.len() < audited.tests && better.in_holes <= better.tests);
        assert!(better.hole.upper < audited.holes.largest().lower, "{better:?}");
        let score = audited.mutants.as_ref().unwrap().all.mutation_score.unwrap();
        assert!(better.mutation_score.unwrap().value >= score.value);
        // A fresh audit of the tests agrees.
        let space = study.space();
        let points = better.suite.iter().map(|test| space.encode(test)).collect::<Result<Vec<_>, _>>().unwrap();
        let suite = Suite::new("better".to_owned(), points, &study).unwrap();
        assert_eq!(suite.left_out, 0);
        let screen = Screen::of(&study, 30, 16, 0, &runs(2)).unwrap();
        let again = Audit::of(&study, vec![suite]).unwrap().mutants(screen).run(&mut Vec::new(), |_| Ok(())).unwrap();
        let [again] = &again.suites[..] else { panic!("one suite") };
        assert_eq!(again.holes.largest(), better.hole);
        assert_eq!(again.mutants.as_ref().unwrap().all.mutation_score, better.mutation_score);
    }
}

#[test]
fn near_misses_come_by_their_robustness_and_those_of_a_share_from_the_farthest_on() {
    let study = study("pedestrian-crossing", "planner", &[]);
    let pool = Suite::of_strategy(&study, Strategy::RANDOM, 160, Some(7)).unwrap();
    let trials = runs(2).of(&study, &pool.values(&study)).unwrap();
    let passed: Vec<&Trial> = trials.iter().filter(|trial| trial.violated().next().is_none()).collect();
    let of = |test: &Point| {
        let is_same = |point: &&Point| study.space().decode(point) == study.space().decode(test);
        &trials[pool.points.iter().position(|point| is_same(&point)).unwrap()]
    };
    // The place of a test among the passing tests, as the least share over the requirements.
    let share = |test: &Point| {
        let below = |(id, robustness): (&str, f64)| {
            let of = passed.iter().filter_map(|trial| trial.robustness(id));
            of.clone().filter(|other| *other < robustness).count() as f64 / of.count() as f64
        };
        of(test).decided().map(below).fold(1.0, f64::min)
    };
    let mut points = vec![pool.points[0].clone()];
    let mut near = NearMisses::of(&study, 160, 7, &runs(2)).unwrap();
    let count = near.add(10, &mut points) + near.add(usize::MAX / 2, &mut points);
    assert_eq!((count, points.len(), near.add(1, &mut points)), (passed.len(), passed.len() + 1, 0));
    // Tests with the same robustness count by their order, so that the share of a test is at most that of its part.
    let first = (passed.len() as f64 / 16.0).ceil() as usize;
    assert!(first > 5 && points[1..=first].iter().all(|test| share(test) < 1.0 / 16.0));
    let distance =
        |a: &Point, b: &Point| a.continuous.iter().zip(&b.continuous).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
    for taken in 1..=first {
        let nearest = |test: &Point| points[..taken].iter().map(|other| distance(test, other)).fold(1e9, f64::min);
        let farthest = points[taken..=first].iter().map(nearest).fold(0.0, f64::max);
        assert_eq!(nearest(&points[taken]), farthest);
    }
}

#[test]
fn no_better_suite_is_made_for_a_suite_of_few_tests() {
    let study = study("pedestrian-crossing", "planner", &[]);
    assert_eq!(report(&study, &["halton:1"], 30, 2).suites[0].better, None);
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
    let (rivals, refusals) = suite("grid:5x4", &study).rivals(&study, &[]);
    let sizes: Vec<usize> = rivals.iter().map(|suite| suite.points.len()).collect();
    let open_loop = Strategy::all().filter(|strategy| !strategy.is_adaptive()).count();
    assert_eq!(rivals.len() + refusals.len(), open_loop);
    assert!(rivals.len() > 5 && sizes.iter().all(|size| *size == 20), "{sizes:?} {refusals:?}");
}
