//! Conducts one run of a bench: a strategy proposes tests of a target until the budget is spent, and the results
//! become a row.

use super::target::{TargetKind, generator_of, study_of};
use super::{Bench, Case, ReferenceMap, Row};
use crate::Modes;
use paracosm_campaign::{Error, Expected, Learned, Log, Steering, Study, Trial, Worker};
use paracosm_coverage::dispersion::dispersion_within;
use paracosm_coverage::valid::Validity;
use paracosm_coverage::{Deadline, PointSet};
use paracosm_generators::Generator;
use paracosm_generators::functions::Placed;
use paracosm_oracles::Verdict;
use paracosm_space::{Point, Space};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The greatest number of dimensions of which the dispersion is computed. Up to this number the dispersion of a few
/// hundred tests takes far less time than the tests.
const MOST_DIMS: usize = 4;

/// The number of batches in a row without a new test after which a strategy is taken to have no more tests.
const MOST_IDLE: usize = 100;

/// Conducts a run and returns its row; `None` if the run was stopped.
pub(super) fn row(
    bench: &Bench,
    case: &Case,
    map: Option<&ReferenceMap>,
    stop: &AtomicBool,
) -> Result<Option<Row>, Error> {
    let target = &bench.targets[case.target];
    let (tests, errors, modes) = match &target.kind {
        TargetKind::Study(study) => {
            let study = study_of(study, case.strategy, case.seed, bench)?;
            let mut campaign = Studied::new(&study)?;
            let Some(done) = explore(&mut campaign, bench, stop, |_| false)? else { return Ok(None) };
            let (points, trials): (Vec<Point>, Vec<Trial>) = done.into_iter().unzip();
            let outcome = |trial: &Trial| trial.covers().then(|| trial.is_failure());
            let tests = points.into_iter().zip(trials.iter().map(outcome)).collect();
            let errors = trials.iter().filter(|trial| trial.verdict == Verdict::Error).count();
            (tests, errors, Some(Modes::of(&Log::new(study.clone(), Learned::new(), None, trials)).modes.len()))
        }
        TargetKind::Function(function) => {
            let generator = generator_of(function, case.strategy, case.seed, bench)?;
            let mut placed = Computed { generator, placed: function.placed(case.seed) };
            let fails = |robustness: &Option<f64>| robustness.map(|robustness| robustness < 0.0);
            // A function has no reference map, so that tests after the first failure would tell nothing more.
            let Some(done) = explore(&mut placed, bench, stop, |robustness| fails(robustness) == Some(true))? else {
                return Ok(None);
            };
            (done.into_iter().map(|(point, robustness)| (point, fails(&robustness))).collect::<Vec<_>>(), 0, None)
        }
    };
    let first = tests.iter().position(|(_, fails)| *fails == Some(true));
    let found = map.map(|map| map.judge(&tests));
    Ok(Some(Row {
        scenario: target.name().to_owned(),
        strategy: case.strategy,
        seed: case.seed,
        tests: tests.len(),
        first_failure: first.map(|index| index + 1),
        failures: tests.iter().filter(|(_, fails)| *fails == Some(true)).count(),
        errors,
        modes,
        recall: found.and_then(|found| found.recall),
        precision: found.and_then(|found| found.precision),
        dispersion: if map.is_some() { dispersion_of(&target.space(), &tests)? } else { None },
    }))
}

/// Returns the dispersion of the tests that count for coverage (those with an outcome), an upper bound if it is not exact;
/// `None` unless the number of continuous parameters is in 1 to `MOST_DIMS`.
fn dispersion_of(space: &Space, tests: &[(Point, Option<bool>)]) -> Result<Option<f64>, Error> {
    let dims = space.dims();
    if !(1..=MOST_DIMS).contains(&dims) {
        return Ok(None);
    }
    let covering = tests.iter().filter(|(_, fails)| fails.is_some()).map(|(point, _)| &point.continuous);
    let points = PointSet::new(dims, covering)?;
    let rules = space.rules()?;
    let valid = Validity::of(space, &rules).map(|validity| validity.whole());
    // Without a deadline and without a valid part, the lower and the upper bound are the same.
    Ok(Some(dispersion_within(&points, valid.as_deref(), Deadline::never(), &mut |_| ()).volume.upper))
}

/// Tests with their outcomes.
type Done<T> = Vec<(Point, T)>;

/// A target together with the strategy that chooses its tests.
trait Tested {
    type Outcome: Clone;
    fn ask(&mut self, n: usize) -> Result<Vec<Point>, Error>;
    fn run(&mut self, index: usize, test: &Point) -> Result<Self::Outcome, Error>;
    fn tell(&mut self, tests: &[Point], outcomes: &[Self::Outcome]) -> Result<(), Error>;
}

/// Runs different tests until an outcome `ends` the run, the budget is spent or the strategy has no more tests.
/// Returns the tests with their outcomes; `None` if `stop` was set.
fn explore<T: Tested>(
    tested: &mut T,
    &Bench { budget, batch, .. }: &Bench,
    stop: &AtomicBool,
    ends: impl Fn(&T::Outcome) -> bool,
) -> Result<Option<Done<T::Outcome>>, Error> {
    let mut done: Done<T::Outcome> = Vec::with_capacity(budget);
    let mut known = BTreeMap::new();
    let mut idle = 0;
    while done.len() < budget && idle < MOST_IDLE {
        let tests = tested.ask(batch.min(budget - done.len()))?;
        if tests.is_empty() {
            break;
        }
        let before = done.len();
        let mut outcomes = Vec::with_capacity(tests.len());
        for test in &tests {
            let index = *known.entry(key(test)).or_insert(done.len());
            if index == done.len() {
                if stop.load(Ordering::Relaxed) {
                    return Ok(None);
                }
                let outcome = tested.run(index, test)?;
                let is_last = ends(&outcome);
                done.push((test.clone(), outcome));
                if is_last {
                    return Ok(Some(done));
                }
            }
            outcomes.push(done[index].1.clone());
        }
        tested.tell(&tests, &outcomes)?;
        idle = if done.len() > before { 0 } else { idle + 1 };
    }
    Ok(Some(done))
}

/// Returns the key of a test, which is its coordinates to the last bit.
fn key(test: &Point) -> (Vec<u64>, Vec<usize>) {
    (test.continuous.iter().map(|u| u.to_bits()).collect(), test.discrete.clone())
}

/// A study whose tests run as in a campaign.
struct Studied<'a> {
    study: &'a Study,
    steering: Steering<'a>,
    worker: Worker<'a>,
    expected: Expected,
}

impl<'a> Studied<'a> {
    fn new(study: &'a Study) -> Result<Self, Error> {
        let worker = Worker::until(study, Arc::default())?;
        let steering = Steering::with(study, study.independent_generator()?, Vec::new())?;
        Ok(Self { study, steering, worker, expected: Expected::of(study, &[]) })
    }
}

impl Tested for Studied<'_> {
    type Outcome = Trial;

    fn ask(&mut self, n: usize) -> Result<Vec<Point>, Error> {
        Ok(self.steering.ask(n)?)
    }

    fn run(&mut self, index: usize, test: &Point) -> Result<Trial, Error> {
        let (trial, _) = self.worker.run(index, &self.study.space().decode(test));
        let trial = self.expected.check(trial);
        self.expected.go_on()?;
        Ok(trial)
    }

    fn tell(&mut self, tests: &[Point], trials: &[Trial]) -> Result<(), Error> {
        Ok(self.steering.tell(tests, trials)?)
    }
}

/// A function whose tests are computed.
struct Computed {
    generator: Box<dyn Generator>,
    placed: Placed,
}

impl Tested for Computed {
    type Outcome = Option<f64>;

    fn ask(&mut self, n: usize) -> Result<Vec<Point>, Error> {
        Ok(self.generator.ask(n))
    }

    fn run(&mut self, _: usize, test: &Point) -> Result<Option<f64>, Error> {
        Ok(self.placed.robustness(test))
    }

    fn tell(&mut self, tests: &[Point], robustness: &[Option<f64>]) -> Result<(), Error> {
        self.generator.tell(tests, robustness);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::Target;
    use paracosm_generators::Strategy;
    use paracosm_generators::functions::Function;

    /// Proposes the rows 0 0 1, 1 1 2, 2 2 3 and so on up to a last row.
    struct Repeating {
        asked: usize,
        last: usize,
        ran: Vec<usize>,
        told: Vec<usize>,
    }

    impl Tested for Repeating {
        type Outcome = usize;

        fn ask(&mut self, n: usize) -> Result<Vec<Point>, Error> {
            let rows = [self.asked, self.asked, self.asked + 1].map(|row| row.min(self.last));
            self.asked += 1;
            let test = |row| Point { continuous: vec![], discrete: vec![row] };
            Ok(rows.into_iter().take(n).map(test).collect())
        }

        fn run(&mut self, _: usize, test: &Point) -> Result<usize, Error> {
            self.ran.push(test.discrete[0]);
            Ok(10 * test.discrete[0])
        }

        fn tell(&mut self, tests: &[Point], outcomes: &[usize]) -> Result<(), Error> {
            assert!(tests.iter().zip(outcomes).all(|(test, outcome)| 10 * test.discrete[0] == *outcome));
            self.told.extend(outcomes);
            Ok(())
        }
    }

    fn of(budget: usize) -> Bench {
        Bench {
            budget,
            ..Bench::of(&[Strategy::RANDOM], vec![Target::function(Function::named("corner5").unwrap())]).unwrap()
        }
    }

    fn explored(last: usize, budget: usize) -> (Vec<usize>, Repeating) {
        let mut tested = Repeating { asked: 0, last, ran: vec![], told: vec![] };
        let done = explore(&mut tested, &of(budget), &AtomicBool::new(false), |_| false).unwrap().unwrap();
        (done.into_iter().map(|(_, outcome)| outcome).collect(), tested)
    }

    #[test]
    fn a_test_that_is_known_is_told_but_neither_run_nor_counted() {
        let (done, tested) = explored(100, 5);
        assert_eq!(done, [0, 10, 20, 30, 40]);
        assert_eq!(tested.ran, [0, 1, 2, 3, 4]);
        assert_eq!(tested.told[..6], [0, 0, 10, 10, 10, 20]);
    }

    #[test]
    fn a_strategy_that_only_repeats_itself_has_no_more() {
        let (done, tested) = explored(2, 50);
        assert_eq!(done, [0, 10, 20]);
        assert!(tested.asked < 200);
    }

    #[test]
    fn a_run_that_was_stopped_has_no_row() {
        let mut tested = Repeating { asked: 0, last: 9, ran: vec![], told: vec![] };
        assert!(explore(&mut tested, &of(5), &AtomicBool::new(true), |_| false).unwrap().is_none());
    }

    #[test]
    fn a_run_may_end_before_its_budget() {
        let mut tested = Repeating { asked: 0, last: 9, ran: vec![], told: vec![] };
        let done = explore(&mut tested, &of(8), &AtomicBool::new(false), |outcome| *outcome == 30).unwrap().unwrap();
        assert_eq!(done.len(), 4);
    }
}
