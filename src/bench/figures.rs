//! The figures of a bench: for every scenario how many runs are still without a failure, and recall over dispersion.

use super::{Benched, Cell};
use crate::plot::{Entry, Frame, Picture, Series, Shares};
use crate::write_up::look;
use paracosm_generators::Strategy;

/// How many marks a curve has, so that it is known without its colour.
const MARKS: usize = 5;

/// All figures with their names.
pub(super) fn all(benched: &Benched) -> Vec<(String, Picture)> {
    let mut figures = Vec::new();
    for target in &benched.bench.targets {
        let name = target.name();
        let file = target.file_name();
        figures.push((format!("{file}-survival"), Picture::of_shares(survival(benched, name))));
        if let Some(chart) = recall(benched, name) {
            figures.push((format!("{file}-recall"), Picture::of_shares(chart)));
        }
    }
    figures
}

/// The curves of Kaplan and Meier.
fn survival(benched: &Benched, scenario: &str) -> Shares {
    let budget = benched.bench.budget as f64;
    let series = |(index, &strategy): (usize, &Strategy)| {
        let survival = benched.survival(scenario, strategy);
        let inner = survival.steps.iter().copied().filter(|step| step.0 > 1.0);
        let end = survival.at(budget);
        let steps = [(1.0, survival.at(1.0))].into_iter().chain(inner).chain([(budget, end)]).collect();
        // Marks at sizes that differ from curve to curve, evenly along the axis.
        let of = benched.bench.strategies.len() as f64;
        let along = |mark: usize| (mark as f64 + (index as f64 + 0.5) / of) / MARKS as f64;
        let size = |mark: usize| libm::floor(libm::pow(budget, along(mark))).max(1.0);
        let marks = (0..MARKS).map(|mark| (size(mark), survival.at(size(mark)))).collect();
        Series { look: look(strategy), steps, marks }
    };
    let number = |cell: &Cell| format!("{:.1}", cell.restricted_mean);
    let seeds = benched.bench.seeds;
    Shares {
        frame: Frame {
            title: format!("Tests to the first failure: {scenario}"),
            note: format!(
                "Kaplan-Meier curves of {seeds} runs each, which end after {budget} tests; legend: restricted mean"
            ),
            legend: ["strategy".into(), "tests".into()],
            entries: entries(benched, scenario, number, |cell| cell.restricted_mean),
            cross: None,
        },
        x: "tests".into(),
        y: "share of runs without a failure".into(),
        range: (1.0, budget),
        series: benched.bench.strategies.iter().enumerate().map(series).collect(),
    }
}

/// A mark for every run; none where recall or dispersion is not known, or has no logarithm.
fn recall(benched: &Benched, scenario: &str) -> Option<Shares> {
    let mut range = (f64::INFINITY, 0.0_f64);
    let mut all = Vec::new();
    for &strategy in &benched.bench.strategies {
        let mark = |row: &super::Row| Some((row.dispersion.filter(|volume| *volume > 0.0)?, row.recall?));
        let marks: Vec<(f64, f64)> = benched.rows_of(scenario, strategy).map(mark).collect::<Option<_>>()?;
        range = marks.iter().fold(range, |(least, most), mark| (least.min(mark.0), most.max(mark.0)));
        all.push(Series { look: look(strategy), steps: Vec::new(), marks });
    }
    let (budget, number) = (benched.bench.budget, |cell: &Cell| cell.recall.map_or("-".into(), |r| format!("{r:.2}")));
    let correlations = benched.correlations.iter().filter(|correlation| correlation.scenario == scenario);
    let words: Vec<String> = correlations.map(|c| format!("{} {:.2}", c.among, c.spearman)).collect();
    let words = words.join(", ").replace('-', "\u{2212}");
    Some(Shares {
        frame: Frame {
            title: format!("Does a low dispersion find failures? {scenario}"),
            note: format!("a mark for each run of {budget} tests; rank correlation: {words}; legend: mean recall"),
            legend: ["strategy".into(), "recall".into()],
            entries: entries(benched, scenario, number, |cell| cell.recall.unwrap_or(0.0)),
            cross: None,
        },
        x: "dispersion: volume of the largest box without a test".into(),
        y: "recall: share of where tests fail that the run's tests tell".into(),
        range,
        series: all,
    })
}

/// The lines of the legend, from the greatest to the least of a number.
fn entries(
    benched: &Benched,
    scenario: &str,
    number: impl Fn(&Cell) -> String,
    rank: impl Fn(&Cell) -> f64,
) -> Vec<Entry> {
    let mut cells: Vec<&Cell> = benched.of_target(scenario).collect();
    cells.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
    let entry =
        |cell: &Cell| Entry { look: look(cell.strategy), name: cell.strategy.to_string(), number: number(cell) };
    cells.into_iter().map(entry).collect()
}
