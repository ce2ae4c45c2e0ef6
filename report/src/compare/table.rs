//! Writes a comparison as plain-text tables for people.

use crate::write_up::{p_value, three_digits};
use paracosm_analysis::compare::{Compared, ComparisonCell};
use paracosm_coverage::Measure;
use paracosm_space::plural;
use std::fmt::Write;

/// Returns the results of a comparison of strategies as plain-text tables, one table for each measure and dimension.
/// Each table shows the medians over the budgets, their slope, and how each strategy compares with the baseline at the
/// largest budget.
pub fn table(compared: &Compared) -> String {
    let mut text = String::new();
    for measure in compared.measures() {
        for &dims in &compared.comparison.dims {
            block(compared, &mut text, measure, dims);
        }
    }
    text
}

fn block(compared: &Compared, text: &mut String, measure: Measure, dims: usize) {
    let budgets = compared.budgets(measure, dims);
    let Some(&most) = budgets.last() else { return };
    let (label, seeds) = (compared.label(measure), compared.comparison.seeds);
    let _ = writeln!(text, "{label}, d = {dims}: median over {}", plural(seeds, "seed"));
    let _ = write!(text, "  {:<17}", "strategy");
    for n in &budgets {
        let _ = write!(text, "{:>10}", format!("n = {n}"));
    }
    let over = format!("n = {most}: over {}", compared.comparison.baseline);
    let _ = writeln!(text, "{:>8}   {over:<27}{:>6}  {:>9}", "slope", "A12", "Holm's p");
    let mut cut_short = false;
    for strategy in compared.shown(measure, dims) {
        let _ = write!(text, "  {strategy:<17}");
        for &budget in &budgets {
            let cell = compared.cell(measure, dims, budget, strategy);
            cut_short |= cell.is_some_and(|cell| !cell.exact);
            let mark =
                |cell: &ComparisonCell| format!("{}{}", three_digits(cell.median), if cell.exact { "" } else { "*" });
            let _ = write!(text, "{:>10}", cell.map_or("-".into(), mark));
        }
        let slope = compared.slope(measure, dims, strategy).map_or("-".into(), |slope| format!("{:.2}", slope.slope));
        let versus = compared.cell(measure, dims, most, strategy).and_then(|cell| cell.versus.as_ref());
        let sets = compared.cell(measure, dims, most, strategy).map_or(seeds, |cell| cell.seeds);
        let none = match strategy == compared.comparison.baseline {
            true => "the baseline".to_owned(),
            false if sets < seeds => format!("order unknown: {} of {seeds}", plural(sets, "set")),
            false => "order unknown".to_owned(),
        };
        let versus = versus.map_or(none, |versus| {
            let [low, high] = versus.interval.map(|end| format!("{end:.3}"));
            let ratio = format!("{:.3} ({low} to {high})", versus.ratio);
            format!("{ratio:<27}{:>6.2}  {:>9}", versus.better, p_value(versus.p_holm))
        });
        let _ = writeln!(text, "{}", format!("{slope:>8}   {versus}").trim_end());
    }
    if cut_short {
        let _ = writeln!(text, "  * cut short by the limit: the value is the median of the lower ends of brackets");
    }
    text.push('\n');
}
