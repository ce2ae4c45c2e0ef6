//! Draws the figures of a comparison: for every measure and dimension, the values over the budgets, and beside the
//! values the ratio of each strategy to the baseline.

use crate::plot::{Entry, LogLog, LogLogCurve, Picture, Plane, PlotFrame};
use paracosm_analysis::compare::{Compared, ComparisonCell};
use paracosm_coverage::Measure;
use paracosm_generators::Look;
use paracosm_generators::Strategy;
use paracosm_space::plural;

/// Draws all figures and returns them with their names.
pub(super) fn all(compared: &Compared) -> Vec<(String, Picture)> {
    let mut figures = Vec::new();
    for measure in compared.measures() {
        for &dims in &compared.comparison.dims {
            if let Some(chart) = chart(compared, measure, dims) {
                figures.push((format!("{}-d{dims}", measure.name()), Picture::of_log_log(chart)));
            }
        }
    }
    figures
}

/// Returns the figure of a measure in a dimension; `None` if nothing was measured, or if a value is 0 and has no
/// logarithm.
fn chart(compared: &Compared, measure: Measure, dims: usize) -> Option<LogLog> {
    let budgets = compared.budgets(measure, dims);
    let most = *budgets.last()?;
    let mut strategies = compared.shown(measure, dims);
    let at = |strategy: Strategy, budget: usize| compared.cell(measure, dims, budget, strategy);
    let lines: Vec<(Look, Vec<&ComparisonCell>)> = strategies
        .iter()
        .map(|&strategy| (strategy.look(), budgets.iter().filter_map(|&budget| at(strategy, budget)).collect()))
        .collect();
    if !lines.iter().flat_map(|(_, cells)| cells).all(|cell| has_logarithms(cell)) {
        return None;
    }
    let baseline = compared.comparison.baseline;
    let label = compared.label(measure);
    let x = "number of points n".to_owned();
    let y = format!("ratio to {baseline}, pair by pair");
    let values = Plane { x: x.clone(), y: label.clone(), level: None, curves: lines.iter().map(values).collect() };
    let ratios = Plane { x, y, level: Some(1.0), curves: lines.iter().map(ratios).collect() };
    let compares = ratios.curves.iter().any(|curve| !curve.marks.is_empty());
    let crosses = values.curves.iter().any(|curve| !curve.crosses.is_empty());
    // The legend lists the strategies from top to bottom as their lines end.
    let end = |strategy: &Strategy| at(*strategy, most).map_or(0.0, |cell| cell.median);
    strategies.sort_by(|a, b| end(b).total_cmp(&end(a)));
    let entry = |strategy: Strategy| {
        let slope = compared.slope(measure, dims, strategy).map(|slope| format!("{:.2}", slope.slope));
        let number = slope.unwrap_or_default().replace('-', "\u{2212}");
        Entry { look: strategy.look(), name: strategy.name().to_owned(), number }
    };
    let right = if compares { "; right: median ratios with 95 % intervals" } else { "" };
    let seeds = compared.comparison.seeds;
    let frame = PlotFrame {
        title: format!("{}{}, d = {dims}", label[..1].to_uppercase(), &label[1..]),
        note: format!(
            "left: medians of {} with quartiles{right}; marks of the same n stand beside each other",
            plural(seeds, "seed")
        ),
        legend: ["strategy".into(), if budgets.len() > 1 { "slope".into() } else { String::new() }],
        entries: strategies.into_iter().map(entry).collect(),
        cross: crosses.then(|| "plain set, without seed".into()),
    };
    Some(LogLog { frame, planes: if compares { vec![values, ratios] } else { vec![values] } })
}

fn has_logarithms(cell: &ComparisonCell) -> bool {
    let versus = cell.versus.iter().flat_map(|versus| versus.interval);
    cell.quartiles.into_iter().chain(cell.plain).chain(versus).all(|value| value > 0.0 && value.is_finite())
}

/// Returns the medians of a strategy with their quartiles, and the values of its sets without a seed as crosses.
fn values((look, cells): &(Look, Vec<&ComparisonCell>)) -> LogLogCurve {
    let marks = cells.iter().map(|cell| (cell.budget as f64, cell.median, cell.quartiles)).collect();
    let crosses = cells.iter().filter_map(|cell| Some((cell.budget as f64, cell.plain?))).collect();
    LogLogCurve { look: *look, marks, crosses }
}

/// Returns the ratios of a strategy to the baseline, with their confidence intervals.
fn ratios((look, cells): &(Look, Vec<&ComparisonCell>)) -> LogLogCurve {
    let versus =
        |cell: &&ComparisonCell| cell.versus.as_ref().map(|versus| (cell.budget as f64, versus.ratio, versus.interval));
    LogLogCurve { look: *look, marks: cells.iter().filter_map(versus).collect(), crosses: Vec::new() }
}
