//! Writes a comparison as LaTeX tables in the style of the package booktabs, one table for each measure.

use crate::write_up::latex::{LEVEL, escaped, in_math, ratio};
use crate::write_up::three_digits;
use paracosm_analysis::compare::{Compared, ComparisonCell};
use paracosm_coverage::Measure;
use std::fmt::Write;

/// Returns the tables of all measures, ready to be `\input`.
pub(super) fn tables(compared: &Compared) -> String {
    let mut text = String::from("% Needs \\usepackage{booktabs}. Every number is in summary.csv and slopes.csv.\n");
    for measure in compared.measures() {
        table(&mut text, compared, measure);
    }
    text
}

fn table(text: &mut String, compared: &Compared, measure: Measure) {
    let comparison = &compared.comparison;
    let dims: Vec<usize> =
        comparison.dims.iter().copied().filter(|&dims| !compared.budgets(measure, dims).is_empty()).collect();
    let budgets: Vec<usize> = comparison
        .budgets
        .iter()
        .copied()
        .filter(|n| dims.iter().any(|&dims| compared.budgets(measure, dims).contains(n)))
        .collect();
    let baseline = escaped(comparison.baseline.name());
    let _ = write!(
        text,
        "\n\\begin{{table}}\n\\centering\n\\caption{{{}: median over {} seeds at $n$ points in $d$ dimensions, lowest in \
         bold; the fitted slope of $\\log$ median over $\\log n$; and at the largest $n$ the median ratio to {baseline} \
         with its 95\\,\\% bootstrap interval, the probability $A_{{12}}$ of being lower, and Wilcoxon's signed-rank $p$ \
         after Holm's correction. Brackets enclose a median that is not known exactly. $\\dagger$: differs from \
         {baseline} at that $n$ ($p \\le {LEVEL}$).}}\n\
         \\label{{tab:{}}}\n",
        escaped(&capitalised(&compared.label(measure))),
        comparison.seeds,
        measure.name(),
    );
    let _ = writeln!(text, "\\begin{{tabular}}{{rl{}rlrr}}\n\\toprule", "r".repeat(budgets.len()));
    let heads: String = budgets.iter().map(|n| format!(" & $n={n}$")).collect();
    let _ = writeln!(text, "$d$ & strategy{heads} & slope & ratio & $A_{{12}}$ & $p$ \\\\");
    for d in dims {
        let _ = writeln!(text, "\\midrule");
        for (i, strategy) in compared.shown(measure, d).into_iter().enumerate() {
            let first = if i == 0 { d.to_string() } else { String::new() };
            let _ = write!(text, "{first} & {}", escaped(strategy.name()));
            for &n in &budgets {
                let shown = compared.shown(measure, d);
                let cells = || shown.iter().filter_map(|&s| compared.cell(measure, d, n, s));
                // If a value is only a bracket, no value is known to be the lowest.
                let known = cells().all(|cell| cell.exact);
                let medians = cells().filter(|_| known).map(|cell| cell.median);
                let least = medians.fold(f64::INFINITY, f64::min);
                let cell = compared.cell(measure, d, n, strategy);
                let _ = write!(text, " & {}", cell.map_or(String::new(), |cell| median(cell, least)));
            }
            let slope = compared.slope(measure, d, strategy);
            let slope = slope.map_or(String::new(), |slope| format!("${:.2}$", slope.slope));
            let most = compared.budgets(measure, d).last().copied().unwrap_or_default();
            let versus = compared.cell(measure, d, most, strategy).and_then(|cell| cell.versus.as_ref());
            let _ = writeln!(text, " & {slope} & {} \\\\", versus.map_or("& &".into(), ratio));
        }
    }
    text.push_str("\\bottomrule\n\\end{tabular}\n\\end{table}\n");
}

fn median(cell: &ComparisonCell, least: f64) -> String {
    let number = in_math(&three_digits(cell.median));
    let number = if cell.median == least { format!("\\mathbf{{{number}}}") } else { number };
    let differs = cell.versus.as_ref().is_some_and(|versus| versus.p_holm <= LEVEL);
    let upper = three_digits(cell.median_upper);
    if upper != three_digits(cell.median) {
        return format!("$[{number}, {}]$", in_math(&upper));
    }
    format!("${number}{}$", if differs { "^{\\dagger}" } else { "" })
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
