//! Compares strategies by their purpose: how soon each strategy finds a failure, and how well its tests show where
//! tests fail.
//!
//! Every strategy runs every target with every seed. Runs with the same seed are pairs. A run on a study continues to
//! its budget, whatever it finds; a run on a function ends with the first failure. Each run becomes one row:
//!
//! - *tests to the first failure*, censored at the budget if there was no failure (see `statistics::Survival`). A
//!   test that a strategy proposes again has a known result and costs nothing. A run is *exhausted* if its strategy
//!   had nothing more to propose before the budget was spent. An exhausted run is not censored: it would find no
//!   failure with any number of tests, and its time is infinite. In restricted means, censored and exhausted runs
//!   both count as the budget;
//! - *failure modes*, as [`Modes`](crate::Modes) distinguishes them;
//! - *recall* and *precision* of the run as a map of where tests fail, compared with a [`ReferenceMap`];
//! - *dispersion* of the run's tests, exact. It shows whether strategies with a low dispersion find failures.
//!
//! An open-loop strategy draws the discrete values of every test uniformly among the valid ones. It does not take
//! them from the rows of a covering array, as `run` does: a run over such rows would show what the array leaves out,
//! and `random` would not be random (`Strategy::build_independent`). Adaptive strategies search all combinations
//! anyway.
//!
//! Each run takes one core and a single thread, so that results depend neither on the number of parallel runs nor on
//! other work of the core. Rows are written in order as runs end, so that an interrupted bench can be continued.

mod conduct;
mod files;
mod reference;
mod row;
mod summary;
mod target;

pub use files::Rows;
pub use reference::ReferenceMap;
pub use row::Row;
pub use summary::{BenchCell, Correlation, LogRank, MeanRatio};
pub use target::Target;

use crate::asked::{ENOUGH_SEEDS, check_seeds, each_once, few_seeds};
use paracosm_campaign::executor::{alone, in_order, pool};
use paracosm_campaign::{Error, Failure, Reason};
use paracosm_generators::Strategy;
use paracosm_space::plural;
use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use thiserror::Error;

/// The default strategies of a bench. They are random tests, the paper's choice, random corners as a control, and
/// strategies that use robustness.
pub const USUAL: [Strategy; 8] = [
    Strategy::RANDOM,
    Strategy::HALTON,
    Strategy::RANDOM_CORNERS,
    Strategy::NELDER_MEAD,
    Strategy::CMAES,
    Strategy::GP_CMAES,
    Strategy::BAYES,
    Strategy::AUTO,
];

/// The description of a bench, which compares strategies by the failures that they find on targets.
#[derive(Debug, Clone)]
pub struct Bench {
    /// The strategies that the bench compares, in the order in which results are shown.
    pub strategies: Vec<Strategy>,
    /// The targets (scenarios, systems or functions) on which the strategies are tried.
    pub targets: Vec<Target>,
    /// The greatest number of tests in each run of a strategy.
    pub budget: usize,
    /// The number of seeds with which each strategy runs on each target, at least 2.
    pub seeds: usize,
    /// The seed of the first run of each strategy on each target. The seeds of the other runs follow without a gap.
    pub first_seed: u64,
    /// The number of tests that a strategy proposes at a time.
    pub batch: usize,
    /// The strategy with which the other strategies are compared.
    pub baseline: Strategy,
}

/// A flaw in the description or the folder of a bench.
#[derive(Debug, Error)]
pub enum BenchFlaw {
    /// The budget or the batch size of the bench is 0.
    #[error("found 0 as the budget or the batch, expected numbers from 1 on")]
    Zero,
    /// The baseline is not among the strategies of the bench.
    #[error("the baseline {baseline} is not among the strategies: add it to them, or choose another baseline")]
    Baseline {
        /// The strategy that was chosen as the baseline.
        baseline: Strategy,
    },
    /// A strategy of the bench cannot make tests for a target.
    #[error("{strategy} on {target}: {why}")]
    Unable {
        /// The strategy that cannot make tests for the target.
        strategy: Strategy,
        /// The name of the target for which the strategy cannot make tests.
        target: String,
        /// The reason why the strategy cannot make tests.
        why: Error,
    },
    /// The folder holds the results of a different bench.
    #[error("{} holds a different bench: the entry `{key}` of its bench.json differs; choose another folder", folder.display())]
    Other {
        /// The path of the folder that holds a different bench.
        folder: PathBuf,
        /// The entry of `bench.json` in which the two benches differ.
        key: String,
    },
}

impl Reason for BenchFlaw {}

/// A run of a bench, before it is conducted.
#[derive(Debug, Clone, Copy)]
struct Case {
    target: usize,
    strategy: Strategy,
    seed: u64,
}

impl Bench {
    /// Makes a bench of these strategies on these targets with the default settings. These are 200 tests in batches
    /// of 16 and 30 seeds. The baseline is `random` if it is among the strategies, and otherwise the first strategy.
    ///
    /// # Errors
    /// A list is empty, or names something twice.
    pub fn of(strategies: &[Strategy], targets: Vec<Target>) -> Result<Self, Error> {
        each_once("strategies", strategies.iter().map(|strategy| strategy.name().to_owned()))?;
        each_once("scenarios", targets.iter().map(|target| target.name().to_owned()))?;
        let among = strategies.iter().find(|strategy| **strategy == Strategy::RANDOM);
        let (first_seed, baseline) = (1, *among.unwrap_or(&strategies[0]));
        let strategies = strategies.to_vec();
        Ok(Self { strategies, targets, budget: 200, seeds: ENOUGH_SEEDS, first_seed, batch: 16, baseline })
    }

    /// Checks that the bench can be run.
    ///
    /// # Errors
    /// A number is out of range, the baseline is not among the strategies, or a strategy cannot make tests of a target.
    pub fn check(&self) -> Result<(), Error> {
        if self.budget == 0 || self.batch == 0 {
            return Err(BenchFlaw::Zero.into());
        }
        check_seeds(self.seeds, self.first_seed)?;
        if !self.strategies.contains(&self.baseline) {
            return Err(BenchFlaw::Baseline { baseline: self.baseline }.into());
        }
        for target in &self.targets {
            for &strategy in &self.strategies {
                let unable = |why| BenchFlaw::Unable { strategy, target: target.name().to_owned(), why };
                target.check(strategy, self).map_err(unable)?;
            }
        }
        Ok(())
    }

    /// Returns the number of runs of the bench, which has a run for each target, strategy and seed.
    pub fn runs(&self) -> usize {
        self.targets.len() * self.strategies.len() * self.seeds
    }

    /// Returns the runs in the order of their rows.
    fn cases(&self) -> Vec<Case> {
        let mut cases = Vec::with_capacity(self.runs());
        for target in 0..self.targets.len() {
            for &strategy in &self.strategies {
                cases.extend((0..self.seeds as u64).map(|i| Case { target, strategy, seed: self.first_seed + i }));
            }
        }
        cases
    }

    /// Conducts all runs of the bench except the `known` runs, `jobs` runs at a time. `known` has the rows of the first
    /// runs, and `maps` has reference maps by the names of the targets. `watch` receives the new rows in order; its
    /// first error ends the work. The work also ends if `stop` is set.
    ///
    /// # Errors
    /// `watch` returned an error, a run cannot be made, or `stop` was set.
    pub fn run(
        &self,
        jobs: NonZeroUsize,
        maps: &BTreeMap<String, ReferenceMap>,
        known: Vec<Row>,
        stop: &AtomicBool,
        mut watch: impl FnMut(&Row) -> Result<(), Error>,
    ) -> Result<Benched, Error> {
        let cases = self.cases();
        let mut rows = known;
        let left = rows.len()..cases.len();
        let workers = pool(jobs.get().min(left.len()).max(1))?;
        let row = |(): &mut (), i: usize| {
            let map = maps.get(self.targets[cases[i].target].name());
            let row = alone(|| conduct::row(self, &cases[i], map, stop)).map_err(Failure::into);
            row.flatten().transpose()
        };
        let sink = |row: Result<Row, Error>| {
            let row = row?;
            watch(&row)?;
            rows.push(row);
            Ok::<(), Error>(())
        };
        in_order(&workers, left, || (), row, sink)?;
        if rows.len() < cases.len() {
            return Err(Error::Interrupted);
        }
        let (cells, correlations, standings) = summary::summarise(self, &rows);
        let notes = few_seeds(self.seeds).into_iter().chain(self.broken(&rows)).collect();
        Ok(Benched { bench: self.clone(), rows, cells, correlations, standings, notes })
    }
}

impl Bench {
    /// Says of which strategies tests ended in an error.
    fn broken(&self, rows: &[Row]) -> Vec<String> {
        let note = |target: &str, strategy: Strategy| {
            let runs = || rows.iter().filter(|row| row.scenario == target && row.strategy == strategy);
            let (errors, tests): (usize, usize) =
                runs().fold((0, 0), |(errors, tests), row| (errors + row.errors, tests + row.tests));
            let words = format!(
                "{errors} of {} of {strategy} on {target} ended in an error, and count as neither failing nor passing",
                plural(tests, "test")
            );
            (errors > 0).then_some(words)
        };
        let all = self.targets.iter().flat_map(|target| self.strategies.iter().map(move |one| (target.name(), *one)));
        all.filter_map(|(target, strategy)| note(target, strategy)).collect()
    }
}

/// The results of a bench of strategies, with the description of the bench.
#[derive(Debug, Clone)]
pub struct Benched {
    /// The description of the bench.
    pub bench: Bench,
    /// The results of each run, ordered by target, strategy and seed.
    pub rows: Vec<Row>,
    /// The results of each strategy on each target, summarised over the runs and ordered by target and strategy.
    pub cells: Vec<BenchCell>,
    /// The correlation between the dispersion and the recall of the runs on each target, ordered by target.
    pub correlations: Vec<Correlation>,
    /// The comparison of each strategy with the best strategy of each target, summarised over all targets.
    pub standings: Vec<MeanRatio>,
    /// Remarks for the reader of the results, one sentence each.
    pub notes: Vec<String>,
}

impl Benched {
    /// Returns the results of each strategy on the target with the given name, in the order of the strategies.
    pub fn of_target<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a BenchCell> {
        self.cells.iter().filter(move |cell| cell.scenario == name)
    }

    /// Returns the results of each run of a strategy on a target.
    pub fn rows_of<'a>(&'a self, scenario: &'a str, strategy: Strategy) -> impl Iterator<Item = &'a Row> {
        self.rows.iter().filter(move |row| row.scenario == scenario && row.strategy == strategy)
    }
}
