//! Strategies held against each other by what they are for: how soon each finds a failure, and how much of where tests fail
//! is known after it.
//!
//! Every strategy runs every target with every seed; runs of the same seed are pairs. A run goes on to its budget, whatever
//! it finds (only that of a function ends with a failure), and is one row:
//!
//! - *tests to the first failure*, censored at the budget where there was none (`statistics::Survival` says what that asks
//!   for). A test that is proposed again is known, and costs nothing. A run that is *exhausted*, for its strategy had nothing
//!   more to propose before the budget was spent, is not censored: there is no failure for it to be found, however many
//!   tests it had, and its time is infinite. In restricted means both count as the budget;
//! - *failure modes*, as [`Modes`](crate::Modes) tells them apart;
//! - *recall* and *precision* of the run as a map of where tests fail, against a [`ReferenceMap`];
//! - *dispersion* of its tests, exact, so that it can be asked whether a low one finds failures.
//!
//! Discrete values are drawn for every test of an open-loop strategy, uniformly among the valid ones, instead of taken from
//! the rows of a covering array as in `run`: a run over such rows tells what the array has left out, and `random` would not be
//! random (`Strategy::build_independent`). Adaptive strategies search all combinations anyway.
//!
//! Runs are made one to a core, each on a single thread, so that results depend neither on their number nor on what else a
//! core does. Rows are written in order as runs end, so that a study that was cut short goes on where it was.

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
use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use thiserror::Error;

/// The strategies of a bench where nothing is said: chance, the paper's choice, random corners as a control, and what goes by robustness.
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

/// What is run, and how.
#[derive(Debug, Clone)]
pub struct Bench {
    /// The strategies, in the order in which they are shown.
    pub strategies: Vec<Strategy>,
    /// What they are tried on.
    pub targets: Vec<Target>,
    /// How many tests a run has.
    pub budget: usize,
    /// How many seeds each strategy is given, at least 2.
    pub seeds: usize,
    /// The first seed; the others follow it.
    pub first_seed: u64,
    /// How many tests a strategy is asked for at a time.
    pub batch: usize,
    /// The strategy that the others are held against.
    pub baseline: Strategy,
}

/// What makes no sense in a bench.
#[derive(Debug, Error)]
pub enum BenchFlaw {
    /// No test is run.
    #[error("found 0 as the budget or the batch, expected numbers from 1 on")]
    Zero,
    /// The baseline is not run.
    #[error("the baseline {baseline} is not among the strategies")]
    Baseline {
        /// The baseline.
        baseline: Strategy,
    },
    /// A strategy cannot make tests of a target.
    #[error("{strategy} on {target}: {why}")]
    Unable {
        /// The strategy.
        strategy: Strategy,
        /// The target.
        target: String,
        /// Why.
        why: Error,
    },
    /// A folder holds another bench.
    #[error("{} holds a different bench: its `{key}` differs", folder.display())]
    Other {
        /// The folder.
        folder: PathBuf,
        /// The entry of bench.json in which they differ.
        key: String,
    },
}

impl Reason for BenchFlaw {}

/// A run that is to be made.
#[derive(Debug, Clone, Copy)]
struct Case {
    target: usize,
    strategy: Strategy,
    seed: u64,
}

impl Bench {
    /// These strategies on these targets: 200 tests in batches of 16, 30 seeds, against `random` if it is among them and
    /// the first if not.
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

    /// Checks that it can be done.
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

    /// How many runs there are.
    pub fn runs(&self) -> usize {
        self.targets.len() * self.strategies.len() * self.seeds
    }

    /// The runs in the order of their rows.
    fn cases(&self) -> Vec<Case> {
        let mut cases = Vec::with_capacity(self.runs());
        for target in 0..self.targets.len() {
            for &strategy in &self.strategies {
                cases.extend((0..self.seeds as u64).map(|i| Case { target, strategy, seed: self.first_seed + i }));
            }
        }
        cases
    }

    /// Makes the runs that are not known yet, `jobs` at a time; `watch` sees the row of each in order, and its first error
    /// ends the work, as does `stop` once it is set. The known rows are those of the first runs; `maps` are by the names of
    /// the targets.
    ///
    /// # Errors
    /// That of `watch`, or a run cannot be made.
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
        let notes = few_seeds(self.seeds).into_iter().collect();
        Ok(Benched { bench: self.clone(), rows, cells, correlations, standings, notes })
    }
}

/// A bench that was run.
#[derive(Debug, Clone)]
pub struct Benched {
    /// What was run.
    pub bench: Bench,
    /// Every run: by target, strategy and seed.
    pub rows: Vec<Row>,
    /// What is said of each strategy: by target and strategy.
    pub cells: Vec<BenchCell>,
    /// How dispersion and recall go together: by target.
    pub correlations: Vec<Correlation>,
    /// How each strategy stands over all targets.
    pub standings: Vec<MeanRatio>,
    /// What else a reader should know, a sentence each.
    pub notes: Vec<String>,
}

impl Benched {
    /// The cells of a target, in the order of the strategies.
    pub fn of_target<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a BenchCell> {
        self.cells.iter().filter(move |cell| cell.scenario == name)
    }

    /// The rows of a strategy on a target.
    pub fn rows_of<'a>(&'a self, scenario: &'a str, strategy: Strategy) -> impl Iterator<Item = &'a Row> {
        self.rows.iter().filter(move |row| row.scenario == scenario && row.strategy == strategy)
    }
}
