//! Writes a bench as a LaTeX table in the style of the package booktabs.

use crate::write_up::latex::{LEVEL, escaped, p_value, ratio};
use paracosm_analysis::bench::{BenchCell, Benched};
use std::fmt::Write;

/// Returns the table, ready to be `\input`.
pub(super) fn table(benched: &Benched) -> String {
    let bench = &benched.bench;
    let baseline = escaped(bench.baseline.name());
    let mut text = format!(
        "% Needs \\usepackage{{booktabs}}. Every number is in summary.csv.\n\n\\begin{{table}}\n\\centering\n\
         \\caption{{Tests to the first failure in runs of {} tests, {} seeds: share of runs with a failure (Wilson's \
         95\\,\\% interval), mean over these, restricted mean over all, least in bold; its ratio to {baseline} with the \
         95\\,\\% bootstrap interval over pairs, the probability $A_{{12}}$ of needing fewer, and the $p$ of Wilcoxon's \
         signed-rank test and of the log-rank test, each after Holm's correction. $\\dagger$: the former has $p \\le \
         {LEVEL}$. After all tests the mean number of failure modes, mean recall and precision.}}\n\\label{{tab:bench}}\n",
        bench.budget, bench.seeds,
    );
    let _ = writeln!(text, "\\begin{{tabular}}{{llrrrlrrrrrr}}\n\\toprule");
    let _ = writeln!(
        text,
        "scenario & strategy & found & mean & restricted & ratio & $A_{{12}}$ & $p$ & log-rank $p$ & modes & recall & precision \\\\"
    );
    for target in &bench.targets {
        let _ = writeln!(text, "\\midrule");
        let least = benched.of_target(target.name()).map(|cell| cell.restricted_mean).fold(f64::INFINITY, f64::min);
        for (i, cell) in benched.of_target(target.name()).enumerate() {
            let first = if i == 0 { escaped(target.name()) } else { String::new() };
            let _ = writeln!(text, "{first} & {} \\\\", row(cell, least));
        }
    }
    text.push_str("\\bottomrule\n\\end{tabular}\n\\end{table}\n");
    text
}

fn row(cell: &BenchCell, least: f64) -> String {
    let number = |value: Option<f64>, digits: usize| value.map_or(String::new(), |value| format!("${value:.digits$}$"));
    let [low, high] = cell.rate_interval;
    let found = format!("${:.2}$ $[{low:.2}, {high:.2}]$", cell.rate);
    let restricted = format!("{:.1}", cell.restricted_mean);
    let restricted = if cell.restricted_mean == least { format!("\\mathbf{{{restricted}}}") } else { restricted };
    let differs = cell.versus.as_ref().is_some_and(|versus| versus.p_holm <= LEVEL);
    let mark = if differs { "^{\\dagger}" } else { "" };
    let columns = [
        escaped(cell.strategy.name()),
        found,
        number(cell.mean_found, 1),
        format!("${restricted}{mark}$"),
        cell.versus.as_ref().map_or("& &".into(), ratio),
        cell.log_rank.map_or(String::new(), |log_rank| p_value(log_rank.p_holm)),
        number(cell.modes, 1),
        number(cell.recall, 2),
        number(cell.precision, 2),
    ];
    columns.join(" & ")
}
