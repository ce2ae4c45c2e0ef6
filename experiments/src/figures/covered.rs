//! The figures of how evenly sets of points cover a space: sets of samplers, and suites of published scenarios.

use super::plot::{Axis, BLUE, CURVES, Figure, Key, Layer, Mark, ORANGE, Panel};
use super::table::{Row, Table};

/// The samplers of the figure; a reader does not tell more curves apart.
const SAMPLERS: [&str; 8] = ["random", "halton", "sobol-owen", "lhs", "lattice", "greedy", "best", "star-set"];
const SIZES: [f64; 6] = [20.0, 60.0, 100.0, 240.0, 500.0, 1000.0];

/// The median of a measure over the sets of a sampler with a number of points, if all values are exact.
fn median(sets: &[Row<'_>], points: f64, measure: &str) -> Option<f64> {
    let ends = |row: &Row<'_>| ["lower", "upper"].map(|end| row.number(&format!("{measure}_{end}")));
    let own = sets.iter().filter(|row| row.number("n") == points);
    let exact: Option<Vec<f64>> = own.map(ends).map(|[low, high]| (low == high).then_some(low)).collect();
    let mut values = exact?;
    values.sort_by(f64::total_cmp);
    Some(f64::midpoint(*values.get(values.len().checked_sub(1)? / 2)?, values[values.len() / 2]))
}

/// Draws the dispersion in two and five dimensions, and the star discrepancy in two dimensions, over the number of points.
pub fn samplers(tables: &[Table]) -> Figure {
    let study = &tables[0];
    let charts = [
        ("(a) dispersion, d = 2", "dispersion", "2", &[0.001, 0.01, 0.1, 1.0][..]),
        ("(b) dispersion, d = 5", "dispersion", "5", &[0.01, 0.1, 1.0]),
        ("(c) star discrepancy, d = 2", "star", "2", &[0.001, 0.01, 0.1, 1.0]),
    ];
    let panels = charts.map(|(name, measure, dims, ticks)| {
        let curves = SAMPLERS.iter().zip(CURVES).flat_map(|(sampler, colour)| {
            let own: Vec<Row<'_>> =
                study.rows().filter(|row| row.word("strategy") == *sampler && row.word("d") == dims).collect();
            let at = |points: f64| Some((libm::log10(points), libm::log10(median(&own, points, measure)?)));
            let points: Vec<(f64, f64)> = SIZES.into_iter().filter_map(at).collect();
            [Layer::Line(points.clone(), colour), Layer::Points(points, Mark::Dot(20.0), colour)]
        });
        let y = Axis::logarithmic(if measure == "star" { "star discrepancy" } else { "dispersion" }, ticks);
        Panel { name: name.to_owned(), x: Axis::logarithmic("number of points", &SIZES), y, layers: curves.collect() }
    });
    let legend = SAMPLERS.iter().zip(CURVES).map(|(name, colour)| (Key::Line(colour), (*name).to_owned())).collect();
    Figure { columns: 1, shape: 0.4, panels: panels.into(), legend, bar: None }
}

/// Draws the largest holes of published suites and of better suites over the number of tests.
pub fn suites(tables: &[Table]) -> Figure {
    let marks = |tests: &str, hole: &str| {
        let known = tables[0]
            .rows()
            .map(|row| (row.number(tests), row.number(hole)))
            .filter(|(tests, hole)| *tests > 0.0 && *hole > 0.0);
        known.map(|(tests, hole)| (libm::log10(tests), hole)).collect::<Vec<_>>()
    };
    let layers = vec![
        Layer::Points(marks("tests", "hole_lower"), Mark::Cross(36.0), ORANGE),
        Layer::Points(marks("better_tests", "better_hole_upper"), Mark::Dot(36.0), BLUE),
    ];
    let legend = vec![
        (Key::Mark(Mark::Cross(30.0), ORANGE), "stated suite, at least".to_owned()),
        (Key::Mark(Mark::Dot(30.0), BLUE), "better suite, at most".to_owned()),
    ];
    let x = Axis::logarithmic("number of tests", &[1.0, 10.0, 100.0, 1000.0, 10_000.0, 100_000.0]);
    let y = Axis::new("largest hole (share)", (0.0, 0.4), 0.1);
    Figure { columns: 1, shape: 0.45, panels: vec![Panel { name: String::new(), x, y, layers }], legend, bar: None }
}
