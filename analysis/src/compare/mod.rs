//! Compares the evenness with which strategies cover the unit cube, over dimensions, budgets and seeds.
//!
//! Every strategy makes a set of points for every dimension, budget and seed. Strategies with a plain set, which uses
//! no randomness, add it. Each set is measured with every measure that does not take too long, and becomes one row.
//! Sets with the same seed are pairs: a comparison of a strategy with the baseline uses pairs (see
//! [`crate::statistics`]).
//!
//! Each set is made and measured on one core and a single thread. So results depend neither on the number of parallel
//! sets nor on other work of the core, except values that a limit of time cut short. Values that a limit cut short are marked.

mod set;
mod summary;

pub use set::MeasuredSet;
pub use summary::{ComparisonCell, Slope};

pub use crate::statistics::Versus;

use crate::Limit;
use crate::asked::{ENOUGH_SEEDS, check_seeds, each_once, few_seeds};
use paracosm_campaign::executor::{alone, in_order, pool};
use paracosm_campaign::{Error, Failure, Reason};
use paracosm_coverage::Measure;
use paracosm_coverage::measure::Compare;
use paracosm_generators::Strategy;
use paracosm_space::plural;
use set::Case;
use std::num::NonZeroUsize;
use std::ops::Range;
use thiserror::Error;

/// The greatest number of sets: a comparison with more sets is a mistake rather than a plan.
const MOST_SETS: usize = 10_000_000;
/// The description of a comparison of strategies by their coverage of unit cubes.
#[derive(Debug, Clone, PartialEq)]
pub struct SamplerComparison {
    /// The strategies that are compared, in the order in which results are shown.
    pub strategies: Vec<Strategy>,
    /// The numbers of dimensions of the unit cubes.
    pub dims: Vec<usize>,
    /// The numbers of points in the sets that the strategies make.
    pub budgets: Vec<usize>,
    /// The number of seeds with which each strategy makes sets of points, at least 2.
    pub seeds: usize,
    /// The seed of the first set of points of each strategy. The other seeds follow without a gap.
    pub first_seed: u64,
    /// The measures that are taken of each set of points. `None` stands for all measures of a continuous space; the
    /// extreme discrepancy is then left out for sets for which it takes more than about a second.
    pub measures: Option<Vec<Measure>>,
    /// The number of coordinates over which a hole of the k-wise dispersion extends.
    pub k: usize,
    /// The strategy with which the other strategies are compared.
    pub baseline: Strategy,
    /// The limit for taking one measure of one set of points.
    pub limit: Limit,
}

/// A flaw in the description of a comparison.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ComparisonFlaw {
    /// The comparison has no strategies.
    #[error("no strategy is named, expected at least one")]
    NoStrategy,
    /// A number of dimensions or a budget of the comparison is 0.
    #[error("found 0 among the dimensions or the budgets, expected numbers from 1 on")]
    Zero,
    /// The comparison has too many sets of points to finish in a reasonable time.
    #[error("the comparison has more than {MOST_SETS} sets: choose fewer strategies, seeds, budgets or dimensions")]
    TooManySets,
    /// The number `k` of coordinates over which a hole extends is 0.
    #[error("k is 0, expected a number from 1 on")]
    NoStrength,
    /// The baseline is not among the strategies of the comparison.
    #[error("the baseline {baseline} is not among the strategies: add it to them, or choose another baseline")]
    Baseline {
        /// The strategy that was chosen as the baseline.
        baseline: Strategy,
    },
    /// The baseline cannot make sets of points with a number of dimensions of the comparison.
    #[error("the baseline {baseline} supports {}, not d = {dims}: choose another baseline or other dimensions", span(*.baseline))]
    Unable {
        /// The strategy that was chosen as the baseline.
        baseline: Strategy,
        /// The number of dimensions that the baseline does not support.
        dims: usize,
    },
    /// A measure of the comparison needs discrete parameters, which the unit cube does not have.
    #[error(
        "the measure `k-wise` needs discrete parameters, and the unit cube has no such parameters: leave the measure out"
    )]
    Discrete,
    /// No measure of the comparison applies to any of its sets of points.
    #[error(
        "there is nothing to measure: {k}-wise dispersion needs d > {k}; choose more dimensions, a smaller k or other measures"
    )]
    Nothing {
        /// The number of coordinates over which a hole of the k-wise dispersion extends.
        k: usize,
    },
}

impl Reason for ComparisonFlaw {}

impl SamplerComparison {
    /// Makes a comparison of these strategies with the default settings. These are 2, 3 and 5 dimensions, 50, 100 and
    /// 500 points, and 30 seeds, or as many as the given sets of a size if they are fewer. The baseline is `halton` if it is
    /// among the strategies, and otherwise the first strategy.
    ///
    /// # Errors
    /// There are no strategies.
    pub fn of(strategies: &[Strategy]) -> Result<Self, ComparisonFlaw> {
        let among = strategies.iter().find(|strategy| **strategy == Strategy::HALTON);
        let baseline = *among.or(strategies.first()).ok_or(ComparisonFlaw::NoStrategy)?;
        Ok(Self {
            strategies: strategies.to_vec(),
            dims: vec![2, 3, 5],
            budgets: vec![50, 100, 500],
            seeds: Self::usual_seeds(strategies),
            first_seed: 1,
            measures: None,
            k: 2,
            baseline,
            limit: Limit::LONG,
        })
    }

    /// Returns the number of seeds for which each of the given sets has a partner.
    fn usual_seeds(strategies: &[Strategy]) -> usize {
        let given = strategies.iter().filter_map(|strategy| strategy.given());
        let counts = given.flat_map(|sets| sets.sizes().map(|(dims, points)| sets.count(dims, points)));
        counts.min().map_or(ENOUGH_SEEDS, |fewest| fewest.clamp(2, ENOUGH_SEEDS))
    }

    /// Checks the comparison and plans its sets of points, with dimensions and budgets in ascending order.
    ///
    /// # Errors
    /// A list is empty or names something twice, a number is out of range, the baseline is not among the strategies
    /// or cannot make sets of a dimension, or a measure needs discrete parameters.
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

    /// Returns the measures that are taken of sets of this size.
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

    /// Returns all measures that the comparison takes, in the order in which results are shown.
    pub fn all_measures(&self) -> Vec<Measure> {
        self.measures.clone().unwrap_or_else(|| Measure::all().collect())
    }

    /// Returns the strategies that can make sets of this number of dimensions.
    fn able(&self, dims: usize) -> impl Iterator<Item = Strategy> {
        self.strategies.iter().copied().filter(move |strategy| strategy.dims().contains(&dims))
    }

    /// Returns the seeds with which a strategy makes sets of a size. Given sets have their numbers in place of seeds, and there may be fewer.
    fn seeds_of(&self, strategy: Strategy, dims: usize, budget: usize) -> Range<u64> {
        match strategy.given() {
            None => self.first_seed..self.first_seed + self.seeds as u64,
            Some(sets) => 1..1 + sets.count(dims, budget).min(self.seeds) as u64,
        }
    }

    fn cases(&self) -> Vec<Case> {
        let mut cases = Vec::new();
        for &dims in &self.dims {
            for &budget in self.budgets.iter().filter(|budget| !self.measures(dims, **budget).is_empty()) {
                for strategy in self.able(dims) {
                    let plain = strategy.has_plain_set().then_some(None);
                    let seeds = self.seeds_of(strategy, dims, budget).map(Some);
                    cases.extend(plain.into_iter().chain(seeds).map(|seed| Case { strategy, dims, budget, seed }));
                }
            }
        }
        cases
    }

    /// Returns remarks for the reader about sets and measures that are left out, and about few seeds.
    fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        for strategy in &self.strategies {
            let unable: Vec<usize> = self.dims.iter().copied().filter(|d| !strategy.dims().contains(d)).collect();
            if !unable.is_empty() {
                notes.push(format!("{strategy} supports {} and is left out at d = {}", span(*strategy), list(&unable)));
            }
        }
        for strategy in &self.strategies {
            let Some(sets) = strategy.given() else { continue };
            let sizes = self.dims.iter().flat_map(|dims| self.budgets.iter().map(move |budget| (*dims, *budget)));
            for (dims, budget) in sizes.filter(|(dims, _)| strategy.dims().contains(dims)) {
                let (count, at) = (sets.count(dims, budget), format!("at d = {dims}, n = {budget}"));
                match count {
                    0 => notes.push(format!("{strategy} has no set {at}")),
                    _ if count < self.seeds => {
                        let have = plural(count, "set");
                        notes.push(format!(
                            "{strategy} has {have} {at}, too few for a comparison of pairs with the baseline over {} seeds", self.seeds
                        ));
                    }
                    _ => {}
                }
            }
            for (dims, points) in sets.sizes().filter(|(d, n)| !self.dims.contains(d) || !self.budgets.contains(n)) {
                let words = format!("{} in {}", plural(points, "point"), plural(dims, "dimension"));
                notes.push(format!("{strategy} also has sets of {words}: --dims and --budgets do not name this size"));
            }
        }
        let low: Vec<usize> = self.dims.iter().copied().filter(|dims| *dims <= self.k).collect();
        if !low.is_empty() && self.all_measures().contains(&Measure::K_WISE_DISPERSION) {
            let k = self.k;
            notes.push(format!(
                "{k}-wise dispersion is left out at d = {}: it differs from the dispersion only for d > {k}",
                list(&low)
            ));
        }
        let quick = |measure: &Measure| matches!(measure.descriptor().compare, Compare::WhereQuick(_));
        for measure in self.all_measures().into_iter().filter(quick) {
            for &dims in &self.dims {
                let slow = |budget: &usize| !self.measures(dims, *budget).contains(&measure);
                let slow: Vec<usize> = self.budgets.iter().copied().filter(slow).collect();
                if !slow.is_empty() {
                    let (title, at) = (measure.descriptor().title, format!("d = {dims}, n = {}", list(&slow)));
                    notes.push(format!(
                        "{title} is left out at {at}, because it takes long: name the measure to include it"
                    ));
                }
            }
        }
        notes.extend(few_seeds(self.seeds));
        notes
    }
}

/// Returns the dimensions that a strategy supports, in words.
fn span(strategy: Strategy) -> String {
    let (least, most) = strategy.dims().into_inner();
    if least == most { format!("exactly {most} dimensions") } else { format!("at most {most} dimensions") }
}

/// Returns the numbers as text, with commas between the numbers.
fn list(numbers: &[usize]) -> String {
    numbers.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
}

/// A comparison that was checked and can be run.
#[derive(Debug)]
pub struct Schedule {
    comparison: SamplerComparison,
    cases: Vec<Case>,
    notes: Vec<String>,
}

impl Schedule {
    /// Returns the number of sets of points that the comparison will make.
    pub fn sets(&self) -> usize {
        self.cases.len()
    }

    /// Returns remarks for the reader about sets and measures that are left out, and about few seeds, one sentence
    /// each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Makes and measures all sets of points, `jobs` sets at a time. `watch` receives the sets in order; its first
    /// error ends the work.
    ///
    /// # Errors
    /// `watch` returned an error, or a strategy cannot make a set of this size.
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
                "the limit cut {} short: the lower bounds of their brackets stand for the values; --time-limit sets the \
                 limit",
                plural(cut_short, "set")
            ));
        }
        Ok(Compared { comparison, sets, cells, slopes, notes })
    }
}

/// A comparison with its results.
#[derive(Debug, Clone)]
pub struct Compared {
    /// The description of the comparison.
    pub comparison: SamplerComparison,
    /// All measured sets of points, ordered by dimension, budget and strategy; a plain set precedes sets with seeds.
    pub sets: Vec<MeasuredSet>,
    /// The results of each strategy over its sets of points, ordered by measure, dimension, budget and strategy.
    pub cells: Vec<ComparisonCell>,
    /// The exponents with which each strategy's values fall with the budget, by measure, dimension and strategy.
    pub slopes: Vec<Slope>,
    /// Remarks for the reader about sets and measures that are left out or cut short, and about few seeds, one sentence
    /// each.
    pub notes: Vec<String>,
}

impl Compared {
    /// Returns the summarised values of a measure for a dimension, a budget and a strategy.
    pub fn cell(&self, measure: Measure, dims: usize, budget: usize, strategy: Strategy) -> Option<&ComparisonCell> {
        let at = |cell: &&ComparisonCell| {
            (cell.measure, cell.dims, cell.budget, cell.strategy) == (measure, dims, budget, strategy)
        };
        self.cells.iter().find(at)
    }

    /// Returns the exponent with which a strategy's values of a measure fall with the budget, for a dimension.
    pub fn slope(&self, measure: Measure, dims: usize, strategy: Strategy) -> Option<&Slope> {
        self.slopes.iter().find(|slope| (slope.measure, slope.dims, slope.strategy) == (measure, dims, strategy))
    }

    /// Returns the strategies that have at least one value of this measure in this dimension.
    pub fn shown(&self, measure: Measure, dims: usize) -> Vec<Strategy> {
        let has = |strategy: &Strategy| {
            self.cells.iter().any(|c| (c.measure, c.dims, c.strategy) == (measure, dims, *strategy))
        };
        self.comparison.strategies.iter().copied().filter(has).collect()
    }

    /// Returns the budgets at which at least one strategy has a value of this measure in this dimension.
    pub fn budgets(&self, measure: Measure, dims: usize) -> Vec<usize> {
        let has = |budget: &usize| self.cells.iter().any(|c| (c.measure, c.dims, c.budget) == (measure, dims, *budget));
        self.comparison.budgets.iter().copied().filter(has).collect()
    }

    /// Returns the measures of which at least one strategy has a value.
    pub fn measures(&self) -> Vec<Measure> {
        let has = |measure: &Measure| self.cells.iter().any(|cell| cell.measure == *measure);
        self.comparison.all_measures().into_iter().filter(has).collect()
    }

    /// Returns the title of a measure in words, with the comparison's number in place of `k`.
    pub fn label(&self, measure: Measure) -> String {
        let title = measure.descriptor().title;
        title.strip_prefix("k-").map_or_else(|| title.to_owned(), |rest| format!("{}-{rest}", self.comparison.k))
    }
}
