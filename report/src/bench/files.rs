//! Writes the folder of a bench: the results as CSV and LaTeX, and the figures.

use super::{figures, latex};
use crate::write_up::{maybe, write_csv, write_pictures};
use paracosm_analysis::bench::Benched;
use paracosm_campaign::Error;
use paracosm_campaign::files::write_whole;
use std::path::Path;

/// Writes the results of a benchmark of strategies to a folder, as CSV, LaTeX and figures. The files are `summary.csv`,
/// `correlations.csv`, `standings.csv`, `survival.csv`, `table.tex`, and for each scenario the Kaplan-Meier curves and
/// recall over dispersion as SVG and PNG.
///
/// # Errors
/// A file cannot be written.
pub fn write(benched: &Benched, folder: &Path) -> Result<(), Error> {
    write_csv(&folder.join("summary.csv"), &summary_rows(benched))?;
    write_csv(&folder.join("correlations.csv"), &correlation_rows(benched))?;
    write_csv(&folder.join("standings.csv"), &standing_rows(benched))?;
    write_csv(&folder.join("survival.csv"), &survival_rows(benched))?;
    write_whole(&folder.join("table.tex"), latex::table(benched).as_bytes())?;
    write_pictures(folder, &figures::all(benched))
}

fn summary_rows(benched: &Benched) -> Vec<Vec<String>> {
    let header = [
        "scenario",
        "strategy",
        "runs",
        "found",
        "exhausted",
        "rate",
        "rate_low",
        "rate_high",
        "mean_found",
        "median",
        "restricted_mean",
        "restricted_low",
        "restricted_high",
        "over_best",
        "baseline",
        "ratio",
        "ratio_low",
        "ratio_high",
        "a12_better",
        "wilcoxon_p",
        "holm_p",
        "log_rank_p",
        "log_rank_holm_p",
        "modes",
        "recall",
        "precision",
        "dispersion",
    ];
    let mut rows = vec![header.map(str::to_owned).to_vec()];
    for cell in &benched.cells {
        let mut row = vec![cell.scenario.clone(), cell.strategy.to_string(), cell.runs.to_string()];
        row.extend([cell.found.to_string(), cell.exhausted.to_string(), cell.rate.to_string()]);
        row.extend(cell.rate_interval.map(|end| end.to_string()));
        row.extend([maybe(cell.mean_found), maybe(cell.median), cell.restricted_mean.to_string()]);
        row.extend(cell.restricted_interval.map(|end| end.to_string()));
        row.extend([maybe(cell.over_best), benched.bench.baseline.to_string()]);
        let versus = cell.versus.as_ref().map(|v| [v.ratio, v.interval[0], v.interval[1], v.better, v.p, v.p_holm]);
        row.extend((0..6).map(|i| maybe(versus.map(|numbers| numbers[i]))));
        row.extend(
            [cell.log_rank.map(|log_rank| log_rank.p), cell.log_rank.map(|log_rank| log_rank.p_holm)].map(maybe),
        );
        row.extend([cell.modes, cell.recall, cell.precision, cell.dispersion].map(maybe));
        rows.push(row);
    }
    rows
}

fn correlation_rows(benched: &Benched) -> Vec<Vec<String>> {
    let header = ["scenario", "among", "runs", "spearman", "low", "high"];
    let mut rows = vec![header.map(str::to_owned).to_vec()];
    for correlation in &benched.correlations {
        let [low, high] = correlation.interval;
        let numbers = [correlation.spearman, low, high].map(|number| number.to_string());
        let names = [correlation.scenario.clone(), correlation.among.to_owned(), correlation.runs.to_string()];
        rows.push(names.into_iter().chain(numbers).collect());
    }
    rows
}

fn standing_rows(benched: &Benched) -> Vec<Vec<String>> {
    let header = ["strategy", "worst", "worst_scenario", "geometric_mean"];
    let mut rows = vec![header.map(str::to_owned).to_vec()];
    for standing in &benched.standings {
        let (worst, at) = (standing.worst.to_string(), standing.worst_scenario.clone());
        rows.push(vec![standing.strategy.to_string(), worst, at, standing.geometric_mean.to_string()]);
    }
    rows
}

fn survival_rows(benched: &Benched) -> Vec<Vec<String>> {
    let header = ["scenario", "strategy", "tests", "without_failure"];
    let mut rows = vec![header.map(str::to_owned).to_vec()];
    for target in &benched.bench.targets {
        for &strategy in &benched.bench.strategies {
            for (tests, share) in benched.survival(target.name(), strategy).steps {
                rows.push(vec![target.name().into(), strategy.to_string(), tests.to_string(), share.to_string()]);
            }
        }
    }
    rows
}
