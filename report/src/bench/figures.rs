//! Draws the figures of a bench: for every scenario, the share of runs still without a failure, and recall over
//! dispersion.

use crate::plot::{Entry, Picture, PlotFrame, Series, Shares, Survivals, Waiting};
use paracosm_analysis::bench::{BenchCell, Benched, Row};
use paracosm_generators::Strategy;

/// Draws all figures and returns them with their names.
pub(super) fn all(benched: &Benched) -> Vec<(String, Picture)> {
    let mut figures = Vec::new();
    for target in &benched.bench.targets {
        let name = target.name();
        let file = target.file_name();
        figures.push((format!("{file}-survival"), Picture::of_survivals(survival(benched, name))));
        if let Some(chart) = recall(benched, name) {
            figures.push((format!("{file}-recall"), Picture::of_shares(chart)));
        }
    }
    figures
}

/// Returns the chart of the Kaplan-Meier curves of all strategies in a scenario.
fn survival(benched: &Benched, scenario: &str) -> Survivals {
    let (budget, seeds) = (benched.bench.budget, benched.bench.seeds);
    let curve = |cell: &BenchCell| {
        let rows = || benched.rows_of(scenario, cell.strategy);
        let end = |row: &Row| row.first_failure.map_or(f64::INFINITY, |tests| tests as f64);
        Waiting {
            look: cell.strategy.look(),
            steps: benched.survival(scenario, cell.strategy).steps,
            ends: rows().map(end).collect(),
            censored: rows().any(|row| row.first_failure.is_none() && !row.is_exhausted(budget)),
        }
    };
    let number = |cell: &BenchCell| format!("{:.1}", cell.restricted_mean);
    let cells = ranked(benched, scenario, |cell| cell.restricted_mean);
    // Strategies with the same curve share one curve and one mark.
    let all: Vec<Waiting> = cells.iter().map(|cell| curve(cell)).collect();
    let same = |i: usize| all.iter().position(|other| other.is_same(&all[i])).expect("a curve equals itself");
    let entry =
        |i: usize| Entry { look: all[same(i)].look, name: cells[i].strategy.to_string(), number: number(cells[i]) };
    let entries: Vec<Entry> = (0..all.len()).map(entry).collect();
    let different: Vec<Waiting> = (0..all.len()).filter(|i| same(*i) == *i).map(|i| all[i].clone()).collect();
    let shared = if different.len() < all.len() { "; the same mark: the same curve" } else { "" };
    Survivals {
        frame: PlotFrame {
            title: format!("Tests to the first failure: {scenario}"),
            note: format!(
                "Kaplan-Meier curves of {seeds} runs each; a tick at the end: runs censored after {budget} tests; legend: restricted mean{shared}"
            ),
            legend: ["strategy".into(), "tests".into()],
            entries,
            cross: None,
        },
        axes: ["tests".into(), "share of runs without a failure".into()],
        numbers: "runs that are without a failure after this number of tests".into(),
        horizon: budget as f64,
        curves: different,
    }
}

/// The greatest number of strategies in a chart of marks. Readers do not tell more marks apart.
const MOST: usize = 8;

/// Returns a chart of recall over dispersion, with a mark for every run; `None` if a value is unknown, or a dispersion
/// is 0. The chart shows at most eight strategies: strategies in open loop, and then searches with the highest recall.
fn recall(benched: &Benched, scenario: &str) -> Option<Shares> {
    let rank = |cell: &BenchCell| cell.recall.unwrap_or(0.0);
    let by_recall: Vec<Strategy> = ranked(benched, scenario, rank).into_iter().map(|cell| cell.strategy).collect();
    let (searches, others): (Vec<Strategy>, Vec<Strategy>) = by_recall.into_iter().partition(|one| one.is_adaptive());
    let shown: Vec<Strategy> = others.into_iter().chain(searches).take(MOST).collect();
    let mut range = (f64::INFINITY, 0.0_f64);
    let mut all = Vec::new();
    for &strategy in benched.bench.strategies.iter().filter(|strategy| shown.contains(strategy)) {
        let mark = |row: &Row| Some((row.dispersion.filter(|volume| *volume > 0.0)?, row.recall?));
        let marks: Vec<(f64, f64)> = benched.rows_of(scenario, strategy).map(mark).collect::<Option<_>>()?;
        range = marks.iter().fold(range, |(least, most), mark| (least.min(mark.0), most.max(mark.0)));
        all.push(Series { look: strategy.look(), marks });
    }
    let (budget, number) =
        (benched.bench.budget, |cell: &BenchCell| cell.recall.map_or("-".into(), |r| format!("{r:.2}")));
    let correlations = benched.correlations.iter().filter(|correlation| correlation.scenario == scenario);
    let words: Vec<String> = correlations.map(|c| format!("{} {:.2}", c.among, c.spearman)).collect();
    let words = words.join(", ").replace('-', "\u{2212}");
    let hidden = benched.bench.strategies.len() - shown.len();
    let hidden = if hidden > 0 { format!("; not drawn: {hidden} strategies") } else { String::new() };
    Some(Shares {
        frame: PlotFrame {
            title: format!("Does a low dispersion find failures? {scenario}"),
            note: format!(
                "a mark for each run of {budget} tests; rank correlation: {words}; legend: mean recall{hidden}"
            ),
            legend: ["strategy".into(), "recall".into()],
            entries: entries(benched, scenario, &shown, number, rank),
            cross: None,
        },
        x: "dispersion: volume of the largest box without a test".into(),
        y: "recall: share of the failing region that the run's tests predict".into(),
        range,
        series: all,
    })
}

/// Returns the lines of the legend for the shown strategies, sorted by `rank` from the greatest to the least.
fn entries(
    benched: &Benched,
    scenario: &str,
    shown: &[Strategy],
    number: impl Fn(&BenchCell) -> String,
    rank: impl Fn(&BenchCell) -> f64,
) -> Vec<Entry> {
    let entry =
        |cell: &BenchCell| Entry { look: cell.strategy.look(), name: cell.strategy.to_string(), number: number(cell) };
    ranked(benched, scenario, rank).into_iter().filter(|cell| shown.contains(&cell.strategy)).map(entry).collect()
}

/// Returns the cells of a scenario, sorted by `rank` from the greatest to the least.
fn ranked<'a>(benched: &'a Benched, scenario: &'a str, rank: impl Fn(&BenchCell) -> f64) -> Vec<&'a BenchCell> {
    let mut cells: Vec<&BenchCell> = benched.of_target(scenario).collect();
    cells.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
    cells
}
