//! Writes a bench as plain-text tables for people.

use crate::write_up::{p_value, three_digits};
use paracosm_analysis::bench::{BenchCell, Benched};
use paracosm_analysis::statistics::Versus;
use std::fmt::Write;

/// A function that returns the number of a strategy that a column shows.
type Value = fn(&BenchCell) -> Option<f64>;

/// Returns the results of a benchmark of strategies as plain-text tables. The tables show for every scenario how soon
/// each strategy finds a failure and what each strategy knows after all its tests, and then how the strategies compare
/// over all scenarios.
pub fn table(benched: &Benched) -> String {
    let mut text = String::new();
    for target in &benched.bench.targets {
        first_failures(benched, &mut text, target.name());
        after_all(benched, &mut text, target.name());
    }
    over_all(benched, &mut text);
    text
}

fn first_failures(benched: &Benched, text: &mut String, scenario: &str) {
    let (budget, seeds) = (benched.bench.budget, benched.bench.seeds);
    let _ = writeln!(
        text,
        "{scenario}: tests to the first failure, at most {budget}, {seeds} seeds; p after Holm's correction"
    );
    let over = format!("over {} (95 %)", benched.bench.baseline);
    let _ = writeln!(
        text,
        "  {:<17}{:<25}{:>6}{:>8}  {:<24}{:<24}{:>5}{:>12}{:>12}{:>6}",
        "strategy",
        "found (95 %)",
        "mean",
        "median",
        "restricted mean (95 %)",
        over,
        "A12",
        "Wilcoxon p",
        "log-rank p",
        "best"
    );
    for cell in benched.of_target(scenario) {
        let _ = writeln!(text, "{}", first_failure(cell).trim_end());
    }
    for cell in benched.of_target(scenario).filter(|cell| cell.exhausted > 0) {
        let (strategy, of) = (cell.strategy, cell.runs);
        let _ = writeln!(
            text,
            "  {strategy}: {} of {of} runs tried every test that the strategy can propose and found no failure; each of these runs counts as {budget} tests",
            cell.exhausted
        );
    }
}

fn after_all(benched: &Benched, text: &mut String, scenario: &str) {
    let cells = || benched.of_target(scenario);
    let columns: [(&str, Value); 4] = [
        ("modes", |cell| cell.modes),
        ("recall", |cell| cell.recall),
        ("precision", |cell| cell.precision),
        ("dispersion", |cell| cell.dispersion),
    ];
    let known: Vec<_> = columns.into_iter().filter(|(_, value)| cells().any(|cell| value(cell).is_some())).collect();
    if known.is_empty() {
        text.push('\n');
        return;
    }
    let _ = write!(text, "\n  {:<17}", "after all tests");
    known.iter().for_each(|(name, _)| {
        let _ = write!(text, "{name:>12}");
    });
    text.push('\n');
    for cell in cells() {
        let _ = write!(text, "  {:<17}", cell.strategy);
        for (_, value) in &known {
            let _ = write!(text, "{:>12}", value(cell).map_or("-".into(), three_digits));
        }
        text.push('\n');
    }
    for correlation in benched.correlations.iter().filter(|correlation| correlation.scenario == scenario) {
        let [low, high] = correlation.interval;
        let (rho, among) = (correlation.spearman, correlation.among);
        let _ =
            writeln!(text, "  rank correlation of dispersion with recall, {among}: {rho:.2} ({low:.2} to {high:.2})");
    }
    text.push('\n');
}

fn over_all(benched: &Benched, text: &mut String) {
    text.push_str("restricted means, divided by the restricted mean of the best single strategy\n");
    let _ = writeln!(text, "  {:<17}{:>8}  {:<32}{:>15}", "strategy", "worst", "on", "geometric mean");
    for standing in &benched.standings {
        let (worst, mean) = (format!("{:.2}", standing.worst), format!("{:.2}", standing.geometric_mean));
        let _ = writeln!(text, "  {:<17}{worst:>8}  {:<32}{mean:>15}", standing.strategy, standing.worst_scenario);
    }
}

fn first_failure(cell: &BenchCell) -> String {
    let [low, high] = cell.rate_interval;
    let found = format!("{}/{} ({low:.2} to {high:.2})", cell.found, cell.runs);
    let number = |value: Option<f64>| value.map_or("-".into(), |value| format!("{value:.1}"));
    let [low, high] = cell.restricted_interval;
    let restricted = format!("{:.1} ({low:.1} to {high:.1})", cell.restricted_mean);
    let best = cell.over_best.map_or(String::new(), |ratio| format!("{ratio:.2}"));
    let curves = cell.log_rank.map_or(String::new(), |log_rank| p_value(log_rank.p_holm));
    let versus = |versus: &Versus| {
        let [low, high] = versus.interval;
        let ratio = format!("{:.2} ({low:.2} to {high:.2})", versus.ratio);
        format!("{ratio:<24}{:>5.2}{:>12}", versus.better, p_value(versus.p_holm))
    };
    let versus = cell.versus.as_ref().map_or(format!("{:<41}", "the baseline"), versus);
    let (mean, median) = (number(cell.mean_found), number(cell.median));
    format!("  {:<17}{found:<25}{mean:>6}{median:>8}  {restricted:<24}{versus}{curves:>12}{best:>6}", cell.strategy)
}
