//! The figures of a comparison: for every measure and dimension the values over the budgets, and beside them how the
//! strategies stand against the baseline.

use super::{Cell, Compared};
use crate::Measure;
use crate::plot::{Curve, Entry, LogLog, Look, Picture, Plane, Shape};
use paracosm_generators::Strategy;

/// All figures with their names.
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

/// A figure; none where nothing was measured, or some value is 0 and has no logarithm.
fn chart(compared: &Compared, measure: Measure, dims: usize) -> Option<LogLog> {
    let Some(&most) = compared.budgets(measure, dims).last() else { return None };
    let budgets = compared.budgets(measure, dims);
    let at = |strategy, budget| compared.cell(measure, dims, budget, strategy);
    let cells = |strategy| budgets.iter().filter_map(move |&budget| at(strategy, budget));
    let strategies = compared.shown(measure, dims);
    let drawable = |cell: &Cell| cell.quartiles[0] > 0.0 && cell.plain.is_none_or(|plain| plain > 0.0);
    if !strategies.iter().all(|&strategy| cells(strategy).all(drawable)) {
        return None;
    }
    let curves = |mark: fn(&Cell) -> Option<(f64, [f64; 2])>, cross: fn(&Cell) -> Option<f64>| {
        let curve = |&strategy: &Strategy| Curve {
            look: look(strategy),
            marks: cells(strategy)
                .filter_map(|c| mark(c).map(|(value, ends)| (c.budget as f64, value, ends)))
                .collect(),
            crosses: cells(strategy).filter_map(|c| cross(c).map(|value| (c.budget as f64, value))).collect(),
        };
        strategies.iter().map(curve).collect::<Vec<_>>()
    };
    let baseline = compared.comparison.baseline;
    let label = compared.label(measure);
    let x = "number of points n".to_owned();
    let values = Plane {
        x: x.clone(),
        y: label.clone(),
        level: None,
        curves: curves(|cell| Some((cell.median, cell.quartiles)), |cell| cell.plain),
    };
    let ratios = Plane {
        x,
        y: format!("ratio to {baseline}, pair by pair"),
        level: Some(1.0),
        curves: curves(|cell| cell.versus.as_ref().map(|versus| (versus.ratio, versus.interval)), |_| None),
    };
    let compares = ratios.curves.iter().any(|curve| !curve.marks.is_empty());
    let crosses = values.curves.iter().any(|curve| !curve.crosses.is_empty());
    let mut ranked = strategies.clone();
    // From top to bottom as the lines end.
    let end = |strategy: &Strategy| at(*strategy, most).map_or(0.0, |cell| cell.median);
    ranked.sort_by(|a, b| end(b).total_cmp(&end(a)));
    let entry = |strategy: Strategy| {
        let slope = compared.slope(measure, dims, strategy).map(|slope| format!("{:.2}", slope.slope));
        let number = slope.unwrap_or_default().replace('-', "\u{2212}");
        Entry { look: look(strategy), name: strategy.name().to_owned(), number }
    };
    let right = if compares { "; right: median ratios with 95 % intervals" } else { "" };
    let seeds = compared.comparison.seeds;
    Some(LogLog {
        title: format!("{}{}, d = {dims}", label[..1].to_uppercase(), &label[1..]),
        note: format!("left: medians of {seeds} seeds with quartiles{right}; marks of one n stand beside each other"),
        planes: if compares { vec![values, ratios] } else { vec![values] },
        legend: ["strategy".into(), if budgets.len() > 1 { "slope".into() } else { String::new() }],
        entries: ranked.into_iter().map(entry).collect(),
        cross: crosses.then(|| "plain set, without seed".into()),
    })
}

/// The same strategy looks the same in every figure; those of one family have colours of one kind.
fn look(strategy: Strategy) -> Look {
    let (colour, shape, filled) = match strategy {
        Strategy::Random => (0x99_9999, Shape::Circle, true),
        Strategy::Lhs => (0x99_9999, Shape::Square, false),
        Strategy::LhsCentred => (0x99_9999, Shape::Diamond, false),
        Strategy::Halton => (0x00_72b2, Shape::Circle, true),
        Strategy::HaltonShifted => (0x00_72b2, Shape::Circle, false),
        Strategy::HaltonScrambled => (0x56_b4e9, Shape::Tip, true),
        Strategy::Sobol => (0xd5_5e00, Shape::Diamond, true),
        Strategy::SobolOwen => (0xe6_9f00, Shape::Diamond, false),
        Strategy::Kronecker => (0x00_9e73, Shape::Square, true),
        Strategy::Hammersley => (0xcc_79a7, Shape::Triangle, true),
        Strategy::Fibonacci => (0x8c_510a, Shape::Tip, false),
        Strategy::Greedy => (0x00_0000, Shape::Triangle, true),
    };
    let byte = |shift: u32| (colour >> shift) as u8;
    Look { colour: (byte(16), byte(8), byte(0)), shape, filled }
}
