//! Strategies held against each other: how evenly each covers the unit cube, over dimensions, budgets and seeds.
//!
//! Every strategy makes a set of points for every dimension, budget and seed; those that have one add their plain set,
//! which takes no chance. A set is measured by everything that does not take too long, and kept as one row. Sets of the
//! same seed are pairs: what is said of a strategy over the baseline is said of pairs (see [`crate::statistics`]).
//!
//! Sets are made and measured one to a core, each on a single thread, so that results depend neither on their number nor
//! on what else a core does, but for values that a time limit cut short, which say so.

mod set;
mod summary;

pub use set::MeasuredSet;
pub use summary::{ComparisonCell, Slope};

pub use crate::statistics::Versus;

use crate::asked::{ENOUGH_SEEDS, check_seeds, each_once, few_seeds};
use paracosm_campaign::executor::{alone, in_order, pool};
use paracosm_campaign::{Error, Failure, Reason};
use paracosm_coverage::Measure;
use paracosm_coverage::measure::Compare;
use paracosm_generators::Strategy;
use set::Case;
use std::num::NonZeroUsize;
use std::time::Duration;
use thiserror::Error;

/// More sets than this are a mistake rather than a plan.
const MOST_SETS: usize = 10_000_000;
/// What is compared, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct SamplerComparison {
    /// The strategies, in the order in which they are shown.
    pub strategies: Vec<Strategy>,
    /// The dimensions of the unit cubes.
    pub dims: Vec<usize>,
    /// The numbers of points of the sets.
    pub budgets: Vec<usize>,
    /// How many seeds each strategy is given, at least 2.
    pub seeds: usize,
    /// The first seed; the others follow it.
    pub first_seed: u64,
    /// What is measured. `None` is all that a continuous space has, the extreme discrepancy only of sets where it takes
    /// no more than about a second.
    pub measures: Option<Vec<Measure>>,
    /// How many coordinates at a time the k-wise dispersion looks at.
    pub k: usize,
    /// The strategy that the others are held against.
    pub baseline: Strategy,
    /// How long one measure of one set may take.
    pub limit: Duration,
}

/// What makes no sense in a comparison.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ComparisonFlaw {
    /// There is nothing to compare.
    #[error("there is no strategy")]
    NoStrategy,
    /// There are no points, or none of their coordinates.
    #[error("found 0 among the dimensions or the budgets, expected numbers from 1 on")]
    Zero,
    /// It would take for ever.
    #[error("these are more than {MOST_SETS} sets; take fewer seeds, budgets or dimensions")]
    TooManySets,
    /// No coordinates are to be looked at together.
    #[error("k is 0, expected a number from 1 on")]
    NoStrength,
    /// The baseline is not compared.
    #[error("the baseline {baseline} is not among the strategies")]
    Baseline {
        /// The baseline.
        baseline: Strategy,
    },
    /// The baseline cannot cover a dimension.
    #[error("the baseline {baseline} is made for {}, not for {dims} dimensions", span(*.baseline))]
    Unable {
        /// The baseline.
        baseline: Strategy,
        /// The dimensions.
        dims: usize,
    },
    /// A measure is none of continuous spaces.
    #[error("k-wise is a measure of discrete parameters, and the unit cube has none")]
    Discrete,
    /// Nothing is measured of any set.
    #[error("there is nothing to measure: {k}-wise dispersion needs more than {k} dimensions")]
    Nothing {
        /// How many coordinates are looked at together.
        k: usize,
    },
}

impl Reason for ComparisonFlaw {}

impl SamplerComparison {
    /// A comparison of these strategies in 2, 3 and 5 dimensions with 50, 100 and 500 points and 30 seeds, against
    /// `halton` if it is among them and the first if not.
    ///
    /// # Errors
    /// There is no strategy.
    pub fn of(strategies: &[Strategy]) -> Result<Self, ComparisonFlaw> {
        let among = strategies.iter().find(|strategy| **strategy == Strategy::HALTON);
        let baseline = *among.or(strategies.first()).ok_or(ComparisonFlaw::NoStrategy)?;
        Ok(Self {
            strategies: strategies.to_vec(),
            dims: vec![2, 3, 5],
            budgets: vec![50, 100, 500],
            seeds: ENOUGH_SEEDS,
            first_seed: 1,
            measures: None,
            k: 2,
            baseline,
            limit: Duration::from_secs(60),
        })
    }

    /// Lays out what is to be done, dimensions and budgets in ascending order.
    ///
    /// # Errors
    /// A list is empty or names something twice, a number is out of range, the baseline is not among the strategies or
    /// cannot cover a dimension, or a measure is none of continuous spaces.
    pub fn plan(&self) -> Result<Schedule, Error> {
        let mut comparison = self.clone();
        comparison.dims.sort_unstable();
        comparison.budgets.sort_unstable();
        comparison.check()?;
        let cases = comparison.cases();
        let notes = comparison.notes();
        Ok(Schedule { comparison, cases, notes })
    }

    fn check(&self) -> Result<(), Error> {
        let wrong = |flaw: ComparisonFlaw| Err(flaw.into());
        let measures = self.all_measures();
        each_once("strategies", self.strategies.iter().map(|strategy| strategy.name().to_owned()))?;
        each_once("dimensions", self.dims.iter().map(usize::to_string))?;
        each_once("budgets", self.budgets.iter().map(usize::to_string))?;
        each_once("measures", measures.iter().map(|measure| measure.name().to_owned()))?;
        if self.dims[0] == 0 || self.budgets[0] == 0 {
            return wrong(ComparisonFlaw::Zero);
        }
        check_seeds(self.seeds, self.first_seed)?;
        let sets = [self.strategies.len(), self.dims.len(), self.budgets.len(), self.seeds];
        let sets = sets.into_iter().try_fold(1usize, usize::checked_mul);
        if sets.is_none_or(|sets| sets > MOST_SETS) {
            return wrong(ComparisonFlaw::TooManySets);
        }
        if self.k == 0 {
            return wrong(ComparisonFlaw::NoStrength);
        }
        if !self.strategies.contains(&self.baseline) {
            return wrong(ComparisonFlaw::Baseline { baseline: self.baseline });
        }
        if let Some(dims) = self.dims.iter().find(|dims| !self.baseline.dims().contains(dims)) {
            return wrong(ComparisonFlaw::Unable { baseline: self.baseline, dims: *dims });
        }
        if self.measures.is_some() && measures.iter().any(|m| matches!(m.descriptor().compare, Compare::Never)) {
            return wrong(ComparisonFlaw::Discrete);
        }
        if self.cases().is_empty() {
            return wrong(ComparisonFlaw::Nothing { k: self.k });
        }
        Ok(())
    }

    /// What is measured of sets of this size.
    fn measures(&self, dims: usize, budget: usize) -> Vec<Measure> {
        let named = self.measures.is_some();
        let wanted = |measure: &Measure| match measure.descriptor().compare {
            Compare::Always => true,
            Compare::WhereQuick(quick) => named || quick(dims, budget),
            Compare::WhereNamed => named,
            Compare::BeyondK => self.k < dims,
            Compare::Never => false,
        };
        self.all_measures().into_iter().filter(wanted).collect()
    }

    /// What is measured at all, in the order in which it is shown.
    pub fn all_measures(&self) -> Vec<Measure> {
        self.measures.clone().unwrap_or_else(|| Measure::all().collect())
    }

    /// The strategies that can cover so many dimensions.
    fn able(&self, dims: usize) -> impl Iterator<Item = Strategy> {
        self.strategies.iter().copied().filter(move |strategy| strategy.dims().contains(&dims))
    }

    fn cases(&self) -> Vec<Case> {
        let mut cases = Vec::new();
        for &dims in &self.dims {
            for &budget in self.budgets.iter().filter(|budget| !self.measures(dims, **budget).is_empty()) {
                for strategy in self.able(dims) {
                    let plain = strategy.has_plain_set().then_some(None);
                    let seeds = (0..self.seeds as u64).map(|i| Some(self.first_seed + i));
                    cases.extend(plain.into_iter().chain(seeds).map(|seed| Case { strategy, dims, budget, seed }));
                }
            }
        }
        cases
    }

    /// What a reader should know of what is left out, or of how little can be said.
    fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        for strategy in &self.strategies {
            let unable: Vec<usize> = self.dims.iter().copied().filter(|d| !strategy.dims().contains(d)).collect();
            if !unable.is_empty() {
                notes.push(format!("{strategy} is made for {}: left out at d = {}", span(*strategy), list(&unable)));
            }
        }
        let low: Vec<usize> = self.dims.iter().copied().filter(|dims| *dims <= self.k).collect();
        if !low.is_empty() && self.all_measures().contains(&Measure::K_WISE_DISPERSION) {
            let k = self.k;
            notes.push(format!("{k}-wise dispersion left out at d = {}: it says more only beyond {k}", list(&low)));
        }
        let quick = |measure: &Measure| matches!(measure.descriptor().compare, Compare::WhereQuick(_));
        for measure in self.all_measures().into_iter().filter(quick) {
            for &dims in &self.dims {
                let slow = |budget: &usize| !self.measures(dims, *budget).contains(&measure);
                let slow: Vec<usize> = self.budgets.iter().copied().filter(slow).collect();
                if !slow.is_empty() {
                    let (title, at) = (measure.descriptor().title, format!("d = {dims}, n = {}", list(&slow)));
                    notes.push(format!("{title} left out at {at}: it takes long; name it to have it"));
                }
            }
        }
        notes.extend(few_seeds(self.seeds));
        notes
    }
}

/// The dimensions that a strategy can cover, in words.
fn span(strategy: Strategy) -> String {
    let (least, most) = strategy.dims().into_inner();
    if least == most { format!("exactly {most} dimensions") } else { format!("at most {most} dimensions") }
}

/// Numbers with commas between them.
fn list(numbers: &[usize]) -> String {
    numbers.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
}

/// A comparison that can be done.
#[derive(Debug)]
pub struct Schedule {
    comparison: SamplerComparison,
    cases: Vec<Case>,
    notes: Vec<String>,
}

impl Schedule {
    /// How many sets will be made.
    pub fn sets(&self) -> usize {
        self.cases.len()
    }

    /// What is left out and what else a reader should know, a sentence each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Makes and measures all sets, `jobs` at a time; `watch` sees each in order, and its first error ends the work.
    ///
    /// # Errors
    /// That of `watch`, or a strategy cannot make a set that large.
    pub fn run(
        self,
        jobs: NonZeroUsize,
        mut watch: impl FnMut(&MeasuredSet) -> Result<(), Error>,
    ) -> Result<Compared, Error> {
        let Self { comparison, cases, mut notes } = self;
        let workers = pool(jobs.get().min(cases.len()))?;
        // One thread keeps a set's measures on one core.
        let measure = |i: usize| {
            let case: &Case = &cases[i];
            let measures = comparison.measures(case.dims, case.budget);
            alone(|| case.measure(&measures, comparison.k, comparison.limit)).map_err(Failure::into)
        };
        let mut sets = Vec::with_capacity(cases.len());
        let sink = |set: Result<MeasuredSet, Error>| {
            let set = set?;
            watch(&set)?;
            sets.push(set);
            Ok::<(), Error>(())
        };
        in_order(&workers, 0..cases.len(), || (), |(), i| Some(measure(i).flatten()), sink)?;
        let (cells, slopes) = workers.install(|| summary::summarise(&comparison, &sets));
        let cut_short = sets.iter().filter(|set| set.is_cut_short()).count();
        if cut_short > 0 {
            notes.push(format!(
                "{cut_short} sets were cut short by the time limit: the lower ends of brackets stand in"
            ));
        }
        Ok(Compared { comparison, sets, cells, slopes, notes })
    }
}

/// A comparison that was done.
#[derive(Debug, Clone)]
pub struct Compared {
    /// What was compared.
    pub comparison: SamplerComparison,
    /// Every set: by dimension, budget, strategy, and the plain one before the seeds.
    pub sets: Vec<MeasuredSet>,
    /// What is said of each strategy: by measure, dimension, budget and strategy.
    pub cells: Vec<ComparisonCell>,
    /// How fast each strategy's values fall with the budget: by measure, dimension and strategy.
    pub slopes: Vec<Slope>,
    /// What is left out and what else a reader should know, a sentence each.
    pub notes: Vec<String>,
}

impl Compared {
    /// The cell of a measure, a dimension, a budget and a strategy.
    pub fn cell(&self, measure: Measure, dims: usize, budget: usize, strategy: Strategy) -> Option<&ComparisonCell> {
        let at = |cell: &&ComparisonCell| {
            (cell.measure, cell.dims, cell.budget, cell.strategy) == (measure, dims, budget, strategy)
        };
        self.cells.iter().find(at)
    }

    /// The slope of a measure, a dimension and a strategy.
    pub fn slope(&self, measure: Measure, dims: usize, strategy: Strategy) -> Option<&Slope> {
        self.slopes.iter().find(|slope| (slope.measure, slope.dims, slope.strategy) == (measure, dims, strategy))
    }

    /// The strategies that have a value of this measure in this dimension.
    pub fn shown(&self, measure: Measure, dims: usize) -> Vec<Strategy> {
        let has = |strategy: &Strategy| {
            self.cells.iter().any(|c| (c.measure, c.dims, c.strategy) == (measure, dims, *strategy))
        };
        self.comparison.strategies.iter().copied().filter(has).collect()
    }

    /// The budgets at which there is a value of this measure in this dimension.
    pub fn budgets(&self, measure: Measure, dims: usize) -> Vec<usize> {
        let has = |budget: &usize| self.cells.iter().any(|c| (c.measure, c.dims, c.budget) == (measure, dims, *budget));
        self.comparison.budgets.iter().copied().filter(has).collect()
    }

    /// The measures of which there is a value.
    pub fn measures(&self) -> Vec<Measure> {
        let has = |measure: &Measure| self.cells.iter().any(|cell| cell.measure == *measure);
        self.comparison.all_measures().into_iter().filter(has).collect()
    }

    /// A measure in words.
    pub fn label(&self, measure: Measure) -> String {
        let title = measure.descriptor().title;
        title.strip_prefix("k-").map_or_else(|| title.to_owned(), |rest| format!("{}-{rest}", self.comparison.k))
    }
}
