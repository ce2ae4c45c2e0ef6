//! Summarises the sets of a comparison: medians and quartiles over the seeds, the comparison of each strategy with the
//! baseline, and the exponents with which values fall with the budget.

use super::{MeasuredSet, SamplerComparison};
use crate::statistics::{Versus, bootstrap_interval, correct, median_and_quartiles, median_of, power_law_slope};
use paracosm_coverage::Bracket;
use paracosm_coverage::Measure;
use paracosm_generators::Strategy;
use rayon::prelude::*;
use serde::{Serialize, Serializer};

/// A summary of a strategy's values of a measure for one number of dimensions and one budget. A value that is a bracket
/// counts as its lower end, except in `median_upper`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComparisonCell {
    /// The measure that gave the values.
    #[serde(serialize_with = "measure_name")]
    pub measure: Measure,
    /// The number of dimensions of the unit cube.
    pub dims: usize,
    /// The number of points of each set.
    pub budget: usize,
    /// The strategy that made the sets.
    #[serde(serialize_with = "strategy_name")]
    pub strategy: Strategy,
    /// The number of seeds over which the values are summarised.
    pub seeds: usize,
    /// `true` if every value is exact, that is, if no limit cut a measure short.
    pub exact: bool,
    /// The value of the strategy's plain set, which uses no randomness; `None` if the strategy has no plain set.
    pub plain: Option<f64>,
    /// The median of the values over the seeds.
    pub median: f64,
    /// The median of the upper ends of the values. The median of the true values lies between `median` and this number, and equals both if
    /// every value is exact.
    pub median_upper: f64,
    /// The lower and the upper quartile of the values over the seeds.
    pub quartiles: [f64; 2],
    /// The comparison of the values with the baseline's values; `None` if no comparison is possible. This is so for the
    /// baseline, if a value of either strategy is a bracket, and if neither strategy's values differ between seeds (for
    /// example with measures that a shift does not change).
    pub versus: Option<Versus>,
}

/// The exponent with which a strategy's values of a measure fall with the budget. It is the exponent of the power law
/// that is fitted by least squares to the logarithms.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Slope {
    /// The measure that gave the values.
    #[serde(serialize_with = "measure_name")]
    pub measure: Measure,
    /// The number of dimensions of the unit cube.
    pub dims: usize,
    /// The strategy that made the sets.
    #[serde(serialize_with = "strategy_name")]
    pub strategy: Strategy,
    /// The budgets to which the power law is fitted.
    pub budgets: Vec<usize>,
    /// The exponent of the power law that is fitted to the medians over the seeds.
    pub slope: f64,
    /// The 95 % bootstrap interval of the exponent, over the seeds.
    pub interval: [f64; 2],
    /// The exponent of the power law for the plain sets; `None` if the strategy has no plain sets.
    pub plain: Option<f64>,
}

fn measure_name<S: Serializer>(measure: &Measure, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(measure.name())
}

fn strategy_name<S: Serializer>(strategy: &Strategy, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(strategy.name())
}

/// Computes the cells and the slopes, for each place at which every seed has a value.
pub(super) fn summarise(comparison: &SamplerComparison, sets: &[MeasuredSet]) -> (Vec<ComparisonCell>, Vec<Slope>) {
    let SamplerComparison { dims, budgets, strategies, baseline, .. } = comparison;
    let (mut cells, mut slopes) = (Vec::new(), Vec::new());
    for measure in comparison.all_measures() {
        let lines = dims.iter().flat_map(|&d| strategies.iter().map(move |&strategy| (d, strategy)));
        let lines: Vec<Line> = lines.map(|(d, s)| Line::of(measure, d, s, budgets, sets)).collect();
        let base = |line: &Line, budget| {
            let base = lines.iter().find(|other| other.dims == line.dims && other.strategy == *baseline)?;
            base.places.iter().find(|place| place.budget == budget)
        };
        let mut of_measure: Vec<ComparisonCell> = lines
            .par_iter()
            .flat_map_iter(|line| line.places.iter().map(|place| line.cell(place, base(line, place.budget), *baseline)))
            .collect();
        // Cells are sorted by budget before strategy. The sort keeps the order of the strategies.
        of_measure.sort_by_key(|cell| (cell.dims, cell.budget));
        correct(of_measure.iter_mut().filter_map(|cell| cell.versus.as_mut()));
        cells.extend(of_measure);
        slopes.par_extend(lines.par_iter().filter_map(Line::slope));
    }
    (cells, slopes)
}

/// A strategy's values of a measure in one dimension, over the budgets.
struct Line {
    measure: Measure,
    dims: usize,
    strategy: Strategy,
    places: Vec<Place>,
}

/// A strategy's values of a measure at one budget, in the order of the seeds.
struct Place {
    budget: usize,
    values: Vec<f64>,
    uppers: Vec<f64>,
    plain: Option<f64>,
    exact: bool,
}

impl Place {
    /// Returns `true` if the values differ by more than rounding.
    fn spreads(&self) -> bool {
        let ends = self.values.iter().fold([f64::INFINITY, 0.0], |[low, high], &v| [v.min(low), v.max(high)]);
        ends[1] - ends[0] > 1e-9 * ends[1].abs()
    }
}

impl Line {
    fn of(measure: Measure, dims: usize, strategy: Strategy, budgets: &[usize], sets: &[MeasuredSet]) -> Self {
        let place = |&budget: &usize| {
            let here = sets.iter().filter(|set| (set.strategy, set.dims, set.budget) == (strategy, dims, budget));
            let (plain, seeds): (Vec<_>, Vec<_>) = here.partition(|set| set.seed.is_none());
            let seeds: Vec<Bracket> = seeds.iter().map(|set| set.value(measure)).collect::<Option<_>>()?;
            let plain = plain.first().and_then(|set| set.value(measure));
            (!seeds.is_empty()).then(|| Place {
                budget,
                values: seeds.iter().map(|bracket| bracket.lower).collect(),
                uppers: seeds.iter().map(|bracket| bracket.upper).collect(),
                plain: plain.map(|bracket| bracket.lower),
                exact: seeds.iter().chain(&plain).all(Bracket::is_exact),
            })
        };
        Self { measure, dims, strategy, places: budgets.iter().filter_map(place).collect() }
    }

    fn cell(&self, place: &Place, base: Option<&Place>, baseline: Strategy) -> ComparisonCell {
        let (median, quartiles) = median_and_quartiles(&place.values);
        // The order of bracketed values is unknown, and values that do not vary with the seed allow no statistical
        // test.
        let tells = |base: &&Place| {
            let are_pairs = place.values.len() == base.values.len();
            are_pairs && place.exact && base.exact && (place.spreads() || base.spreads())
        };
        let base = base.filter(|_| self.strategy != baseline).filter(tells);
        ComparisonCell {
            measure: self.measure,
            dims: self.dims,
            budget: place.budget,
            strategy: self.strategy,
            seeds: place.values.len(),
            exact: place.exact,
            plain: place.plain,
            median,
            median_upper: median_and_quartiles(&place.uppers).0,
            quartiles,
            versus: base.map(|base| Versus::of_medians(&place.values, &base.values)),
        }
    }

    /// Returns the slope of the line; `None` if a value is a bracket.
    fn slope(&self) -> Option<Slope> {
        if self.places.iter().any(|place| !place.exact) {
            return None;
        }
        let at = |value: &dyn Fn(&Place) -> Option<f64>| {
            let points = self.places.iter().map(|place| Some((place.budget as f64, value(place)?)));
            power_law_slope(&points.collect::<Option<Vec<_>>>()?)
        };
        // Strategies of others may have more sets of one size than of another: the sets that all sizes have count.
        let seeds = self.places.iter().map(|place| place.values.len()).min()?;
        let slope = at(&|place| Some(median_and_quartiles(place.values.get(..seeds)?).0))?;
        let interval = bootstrap_interval(seeds, |drawn| {
            at(&|place| Some(median_of(drawn, &place.values))).expect("there are budgets enough for a slope")
        });
        let budgets = self.places.iter().map(|place| place.budget).collect();
        let plain = at(&|place| place.plain);
        Some(Slope { measure: self.measure, dims: self.dims, strategy: self.strategy, budgets, slope, interval, plain })
    }
}
