//! Summarises the runs of a bench: how soon and how often each strategy finds a failure, how it compares with the
//! others, and whether runs with a low dispersion show better where tests fail.

use super::{Bench, Benched, Row};
use crate::statistics::{
    Lifetime, Survival, Versus, bootstrap_interval, correct, holm, log_rank_p, median_and_quartiles, spearman, wilson,
};
use paracosm_generators::Strategy;
use serde::{Serialize, Serializer};

/// The results of a strategy on a target, summarised over the runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BenchCell {
    /// The name of the target on which the strategy ran.
    pub scenario: String,
    /// The strategy that proposed the tests of the runs.
    #[serde(serialize_with = "strategy_name")]
    pub strategy: Strategy,
    /// The number of runs of the strategy on the target.
    pub runs: usize,
    /// The number of runs that found a failure.
    pub found: usize,
    /// The number of runs without a failure that ended before the budget, because the strategy had no more tests.
    pub exhausted: usize,
    /// The share of the runs that found a failure.
    pub rate: f64,
    /// Wilson's 95 % interval of the share of runs that found a failure.
    pub rate_interval: [f64; 2],
    /// The mean number of tests to the first failure, over the runs that found a failure. The mean is too small if some
    /// runs found no failure.
    pub mean_found: Option<f64>,
    /// The number of tests after which half of the runs have found a failure; `None` if fewer runs found a failure.
    pub median: Option<f64>,
    /// The mean number of tests to the first failure, in which a run without a failure counts as the budget (the
    /// restricted mean). An exhausted run, which never finds a failure, counts as the budget too.
    pub restricted_mean: f64,
    /// The 95 % bootstrap interval of the restricted mean number of tests to the first failure, over the seeds.
    pub restricted_interval: [f64; 2],
    /// The restricted mean divided by the smallest such mean of all strategies except `auto` and `random-corners`.
    /// `auto` consists of other strategies, and `random-corners` is the control.
    pub over_best: Option<f64>,
    /// The comparison of the restricted mean with the baseline's restricted mean, over pairs of runs with the same
    /// seed; `None` for the baseline.
    pub versus: Option<Versus>,
    /// The unpaired log-rank test of the Kaplan-Meier curve against the baseline's curve; `None` for the baseline.
    pub log_rank: Option<LogRank>,
    /// The mean number of failure modes of a run; `None` if the target is a function, which has no failure modes.
    pub modes: Option<f64>,
    /// The mean share of the map's failing tests that are predicted to fail; `None` if no run has a known share.
    pub recall: Option<f64>,
    /// The mean precision of the runs that predict a test of the reference map to fail; `None` if there is no such run.
    pub precision: Option<f64>,
    /// The median over the runs of the volume of the largest empty box; `None` if the volume is not known of any run.
    pub dispersion: Option<f64>,
}

/// The result of the log-rank test of two survival curves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LogRank {
    /// The two-sided p-value of the log-rank test.
    pub p: f64,
    /// The p-value of the log-rank test after Holm's correction for all comparisons of the bench.
    pub p_holm: f64,
}

/// The correlation between the dispersion and the recall of the runs on a target.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Correlation {
    /// The name of the target on which the strategies ran.
    pub scenario: String,
    /// The group of strategies, which is `all` (except `random-corners`) or `open loop` (also without adaptive ones).
    pub among: &'static str,
    /// The number of runs of the strategies in the group.
    pub runs: usize,
    /// Spearman's rank correlation between the dispersion and the recall of the runs. If it is below 0, runs that leave
    /// smaller holes show better where tests fail.
    pub spearman: f64,
    /// The 95 % bootstrap interval of the correlation, over the seeds.
    pub interval: [f64; 2],
}

/// The number of tests that a strategy needs to find a failure, relative to the best strategy, over all targets. A
/// ratio divides the strategy's restricted mean on a target by the least restricted mean of any strategy but `auto` and
/// the control.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeanRatio {
    /// The strategy to which the ratios belong.
    #[serde(serialize_with = "strategy_name")]
    pub strategy: Strategy,
    /// The largest ratio of the strategy on any target.
    pub worst: f64,
    /// The name of the target with the largest ratio.
    pub worst_scenario: String,
    /// The geometric mean of the strategy's ratios on all targets.
    pub geometric_mean: f64,
}

fn strategy_name<S: Serializer>(strategy: &Strategy, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(strategy.name())
}

/// Computes the cells, the correlations and the standings from the rows of a bench.
pub(super) fn summarise(bench: &Bench, rows: &[Row]) -> (Vec<BenchCell>, Vec<Correlation>, Vec<MeanRatio>) {
    let (mut cells, mut correlations) = (Vec::new(), Vec::new());
    let per_target = bench.strategies.len() * bench.seeds;
    for of_target in rows.chunks(per_target) {
        cells.extend(cells_of(bench, of_target));
        // The control leaves the inside of the cube empty on purpose.
        let all: Vec<&Row> = of_target.iter().filter(|row| row.strategy != Strategy::RANDOM_CORNERS).collect();
        let some: Vec<&Row> = all.iter().copied().filter(|row| !row.strategy.is_adaptive()).collect();
        correlations.extend(correlation(bench, "all", &all));
        // If all strategies are open-loop, the second correlation would repeat the first.
        if some.len() < all.len() {
            correlations.extend(correlation(bench, "open loop", &some));
        }
    }
    correct(cells.iter_mut().filter_map(|cell| cell.versus.as_mut()));
    let mut log_ranks: Vec<&mut LogRank> = cells.iter_mut().filter_map(|cell| cell.log_rank.as_mut()).collect();
    let p: Vec<f64> = log_ranks.iter().map(|log_rank| log_rank.p).collect();
    log_ranks.iter_mut().zip(holm(&p)).for_each(|(log_rank, p_holm)| log_rank.p_holm = p_holm);
    let standings = bench.strategies.iter().filter_map(|&strategy| standing(strategy, &cells)).collect();
    (cells, correlations, standings)
}

/// Returns the time to the first failure of a run, which is infinite if the strategy was exhausted, and censored at the
/// budget if the budget was spent.
pub(super) fn lifetime(bench: &Bench, row: &Row) -> Lifetime {
    let time = match row.first_failure {
        Some(tests) => tests as f64,
        None if row.is_exhausted(bench.budget) => f64::INFINITY,
        None => bench.budget as f64,
    };
    Lifetime { time, happened: row.first_failure.is_some() }
}

/// Returns the number of tests to the first failure of a run, at most the budget.
fn waited(bench: &Bench, row: &Row) -> f64 {
    lifetime(bench, row).time.min(bench.budget as f64)
}

fn lifetimes<'a>(bench: &Bench, rows: impl IntoIterator<Item = &'a Row>) -> Vec<Lifetime> {
    rows.into_iter().map(|row| lifetime(bench, row)).collect()
}

impl Benched {
    /// Returns the survival curve of a strategy on a target (the share of runs without a failure, over the tests).
    pub fn survival(&self, scenario: &str, strategy: Strategy) -> Survival {
        Survival::of(&lifetimes(&self.bench, self.rows_of(scenario, strategy)))
    }
}

fn cells_of(bench: &Bench, rows: &[Row]) -> Vec<BenchCell> {
    let lines: Vec<&[Row]> = rows.chunks(bench.seeds).collect();
    let waited = |line: &[Row]| -> Vec<f64> { line.iter().map(|row| waited(bench, row)).collect() };
    let base = lines.iter().find(|line| line[0].strategy == bench.baseline);
    let base = base.map(|line| (waited(line), lifetimes(bench, *line)));
    let mut cells: Vec<BenchCell> = lines
        .iter()
        .map(|line| {
            let times = waited(line);
            let base = base.as_ref().filter(|_| line[0].strategy != bench.baseline);
            let versus = base.map(|(base, _)| Versus::of_means(&times, base));
            let p = base.map(|(_, base)| log_rank_p(&lifetimes(bench, *line), base));
            let log_rank = p.map(|p| LogRank { p, p_holm: p });
            BenchCell { versus, log_rank, ..cell(bench, line, &times) }
        })
        .collect();
    let single = cells.iter().filter(|cell| ![Strategy::AUTO, Strategy::RANDOM_CORNERS].contains(&cell.strategy));
    let least = single.map(|cell| cell.restricted_mean).reduce(f64::min);
    cells.iter_mut().for_each(|cell| cell.over_best = least.map(|least| cell.restricted_mean / least));
    cells
}

fn cell(bench: &Bench, line: &[Row], times: &[f64]) -> BenchCell {
    let survival = Survival::of(&lifetimes(bench, line));
    let found: Vec<f64> = line.iter().filter_map(|row| row.first_failure).map(|tests| tests as f64).collect();
    let of = |value: fn(&Row) -> Option<f64>| line.iter().filter_map(value).collect::<Vec<f64>>();
    BenchCell {
        scenario: line[0].scenario.clone(),
        strategy: line[0].strategy,
        runs: line.len(),
        found: found.len(),
        exhausted: line.iter().filter(|row| row.is_exhausted(bench.budget)).count(),
        rate: found.len() as f64 / line.len() as f64,
        rate_interval: wilson(found.len(), line.len(), 0.95),
        mean_found: mean(&found),
        median: survival.median(),
        restricted_mean: survival.restricted_mean(bench.budget as f64),
        restricted_interval: bootstrap_interval(times.len(), |drawn| {
            drawn.iter().map(|&index| times[index]).sum::<f64>() / drawn.len() as f64
        }),
        over_best: None,
        versus: None,
        log_rank: None,
        modes: mean(&of(|row| row.modes.map(|modes| modes as f64))),
        recall: mean(&of(|row| row.recall)),
        precision: mean(&of(|row| row.precision)),
        dispersion: Some(of(|row| row.dispersion))
            .filter(|all| !all.is_empty())
            .map(|all| median_and_quartiles(&all).0),
    }
}

fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Returns `None` if dispersion or recall is unknown for a run, or does not vary.
fn correlation(bench: &Bench, among: &'static str, rows: &[&Row]) -> Option<Correlation> {
    let both: Option<Vec<(f64, f64)>> = rows.iter().map(|row| Some((row.dispersion?, row.recall?))).collect();
    let (dispersion, recall): (Vec<f64>, Vec<f64>) = both?.into_iter().unzip();
    let rho = spearman(&dispersion, &recall)?;
    // The runs of a strategy are consecutive, one for each seed, so that the runs of a seed are drawn together.
    let interval = bootstrap_interval(bench.seeds, |drawn| {
        let lines = (0..rows.len()).step_by(bench.seeds);
        let (x, y): (Vec<f64>, Vec<f64>) = lines
            .flat_map(|line| drawn.iter().map(move |seed| line + seed))
            .map(|i| (dispersion[i], recall[i]))
            .unzip();
        spearman(&x, &y).unwrap_or(0.0)
    });
    Some(Correlation { scenario: rows[0].scenario.clone(), among, runs: rows.len(), spearman: rho, interval })
}

fn standing(strategy: Strategy, cells: &[BenchCell]) -> Option<MeanRatio> {
    let ratios =
        || cells.iter().filter(|cell| cell.strategy == strategy).filter_map(|cell| Some((cell.over_best?, cell)));
    // Of equal ratios the first counts.
    let worst = ratios().reduce(|worst, next| if next.0 > worst.0 { next } else { worst })?;
    let logs: Vec<f64> = ratios().map(|(ratio, _)| libm::log(ratio)).collect();
    let geometric_mean = libm::exp(mean(&logs)?);
    Some(MeanRatio { strategy, worst: worst.0, worst_scenario: worst.1.scenario.clone(), geometric_mean })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::Target;
    use paracosm_generators::functions::Function;

    #[test]
    fn a_run_waits_longer_than_its_budget_or_for_ever() {
        let targets = vec![Target::function(Function::named("corner5").unwrap())];
        let bench = Bench { budget: 50, ..Bench::of(&[Strategy::RANDOM], targets).unwrap() };
        let row = |tests: usize, first_failure: Option<usize>| Row {
            scenario: "corner5".into(),
            strategy: Strategy::RANDOM,
            seed: 1,
            tests,
            first_failure,
            failures: usize::from(first_failure.is_some()),
            errors: 0,
            modes: None,
            recall: None,
            precision: None,
            dispersion: None,
        };
        let rows = [row(50, Some(7)), row(50, None), row(8, None)];
        let lifetimes = lifetimes(&bench, &rows);
        let expected = [(7.0, true), (50.0, false), (f64::INFINITY, false)];
        assert_eq!(lifetimes, expected.map(|(time, happened)| Lifetime { time, happened }));
        assert_eq!(rows.map(|row| waited(&bench, &row)), [7.0, 50.0, 50.0]);
        let survival = Survival::of(&lifetimes);
        assert_eq!((survival.restricted_mean(50.0), survival.at(50.0)), (107.0 / 3.0, 2.0 / 3.0));
    }
}
