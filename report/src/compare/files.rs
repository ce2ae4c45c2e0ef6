//! Writes the folder of a comparison: a row for every set, their statistics, and the figures.

use super::{figures, latex};
use crate::write_up::{maybe, write_csv, write_pictures};
use paracosm_analysis::compare::Compared;
use paracosm_analysis::statistics::Versus;
use paracosm_campaign::Error;
use paracosm_campaign::files::write_whole;
use paracosm_coverage::Measure;
use std::path::Path;

/// Writes the results of a comparison of strategies to an existing folder, as CSV, LaTeX and figures. The files are
/// `sets.csv`, `summary.csv`, `slopes.csv`, `table.tex`, and for each measure in each dimension a figure as SVG and
/// PNG, such as `dispersion-d2.svg`.
///
/// # Errors
/// A file cannot be written.
pub fn write(compared: &Compared, folder: &Path) -> Result<(), Error> {
    write_csv(&folder.join("sets.csv"), &set_rows(compared))?;
    write_csv(&folder.join("summary.csv"), &summary_rows(compared))?;
    write_csv(&folder.join("slopes.csv"), &slope_rows(compared))?;
    write_whole(&folder.join("table.tex"), latex::tables(compared).as_bytes())?;
    write_pictures(folder, &figures::all(compared))
}

/// Returns the rows of `sets.csv`: the names of the columns, and a row for every set of points. Plain sets have no seed. The columns of a
/// measure that was not taken are empty.
pub fn set_rows(compared: &Compared) -> Vec<Vec<String>> {
    let measures: Vec<Measure> =
        compared.comparison.all_measures().into_iter().filter(|m| *m != Measure::K_WISE).collect();
    let columns = measures.iter().flat_map(|m| ["lower", "upper"].map(|end| format!("{}_{end}", m.name())));
    let header = ["strategy", "d", "n", "seed"].map(str::to_owned).into_iter().chain(columns);
    let mut rows = vec![header.chain(["exact".into()]).collect()];
    for set in &compared.sets {
        let mut row = vec![set.strategy.to_string(), set.dims.to_string(), set.budget.to_string(), maybe(set.seed)];
        for &measure in &measures {
            let value = set.value(measure);
            row.extend([maybe(value.map(|bracket| bracket.lower)), maybe(value.map(|bracket| bracket.upper))]);
        }
        row.push((!set.is_cut_short()).to_string());
        rows.push(row);
    }
    rows
}

/// Returns the rows of `summary.csv`: the names of the columns, and a row for each measure, size and strategy.
pub fn summary_rows(compared: &Compared) -> Vec<Vec<String>> {
    let header = [
        "measure",
        "d",
        "n",
        "strategy",
        "seeds",
        "exact",
        "plain",
        "median",
        "median_upper",
        "lower_quartile",
        "upper_quartile",
        "baseline",
        "ratio",
        "ratio_low",
        "ratio_high",
        "a12_better",
        "wilcoxon_p",
        "holm_p",
    ];
    let mut rows = vec![header.map(str::to_owned).to_vec()];
    for cell in &compared.cells {
        let [lower, upper] = cell.quartiles;
        let versus = cell.versus.as_ref();
        let of = |number: fn(&Versus) -> f64| maybe(versus.map(number));
        rows.push(vec![
            cell.measure.name().into(),
            cell.dims.to_string(),
            cell.budget.to_string(),
            cell.strategy.to_string(),
            cell.seeds.to_string(),
            cell.exact.to_string(),
            maybe(cell.plain),
            cell.median.to_string(),
            cell.median_upper.to_string(),
            lower.to_string(),
            upper.to_string(),
            compared.comparison.baseline.to_string(),
            of(|versus| versus.ratio),
            of(|versus| versus.interval[0]),
            of(|versus| versus.interval[1]),
            of(|versus| versus.better),
            of(|versus| versus.p),
            of(|versus| versus.p_holm),
        ]);
    }
    rows
}

/// Returns the rows of `slopes.csv`: the names of the columns, and a row for each measure, dimension and strategy.
pub fn slope_rows(compared: &Compared) -> Vec<Vec<String>> {
    let header = ["measure", "d", "strategy", "budgets", "slope", "slope_low", "slope_high", "plain_slope"];
    let mut rows = vec![header.map(str::to_owned).to_vec()];
    for slope in &compared.slopes {
        let [low, high] = slope.interval;
        let budgets: Vec<String> = slope.budgets.iter().map(usize::to_string).collect();
        rows.push(vec![
            slope.measure.name().into(),
            slope.dims.to_string(),
            slope.strategy.to_string(),
            budgets.join(" "),
            slope.slope.to_string(),
            low.to_string(),
            high.to_string(),
            maybe(slope.plain),
        ]);
    }
    rows
}
