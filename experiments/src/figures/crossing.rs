//! The figures of the pedestrian study: samples in the plane of speed and distance, and the map of a network's failures.

use super::outline::outline;
use super::plot::{Axis, BLUE, FAILING, Figure, GREEN, Key, Layer, Mark, ORANGE, PINK, Panel};
use super::table::Table;
use plotters::style::RGBColor;

const RED: RGBColor = ORANGE;

fn speed() -> Axis {
    Axis::new("walking speed (m/s)", (0.5, 10.0), 1.0).at(&[0.5, 2.0, 4.0, 6.0, 8.0, 10.0])
}

fn distance() -> Axis {
    Axis::new("distance (m)", (5.0, 60.0), 10.0).at(&[5.0, 20.0, 40.0, 60.0])
}

/// A square map of tests in the middle of cells, row by row.
struct Map {
    side: usize,
    fails: Vec<bool>,
}

impl Map {
    fn of(fails: Vec<bool>) -> Self {
        Self { side: fails.len().isqrt(), fails }
    }

    /// Returns the corner of a cell in the plane of speed and distance.
    fn corner(&self, column: usize, row: usize) -> (f64, f64) {
        let share = |at: usize| at as f64 / self.side as f64;
        (0.5 + 9.5 * share(column), 5.0 + 55.0 * share(row))
    }

    fn at(&self, column: usize, row: usize) -> bool {
        self.fails[row * self.side + column]
    }

    /// Returns the failing cells; neighbours in a row are one rectangle.
    fn cells(&self) -> Vec<[(f64, f64); 2]> {
        let mut cells = Vec::new();
        for row in 0..self.side {
            let mut column = 0;
            while column < self.side {
                let end = (column..self.side).find(|at| !self.at(*at, row)).unwrap_or(self.side);
                if end > column {
                    cells.push([self.corner(column, row), self.corner(end, row + 1)]);
                }
                column = end + 1;
            }
        }
        cells
    }

    /// Returns the border between failing and passing cells.
    fn outline(&self, colour: RGBColor) -> impl Iterator<Item = Layer> {
        let pieces = outline([self.side; 2], |i, j| self.at(i, j), |i, j| self.corner(i, j));
        pieces.into_iter().map(move |piece| Layer::Line(piece, colour))
    }
}

/// Draws the random and the Halton samples of three sizes over the region in which tests of the reference map fail.
pub fn samples(tables: &[Table]) -> Figure {
    let [tests, reference] = tables else { panic!("two tables") };
    let map = Map::of(reference.rows().map(|row| row.word("verdict") == "fail").collect());
    let sizes = tests.different("tests");
    let mut panels = Vec::new();
    for size in &sizes {
        for strategy in ["random", "halton"] {
            let marks = |fails: bool| {
                let own = tests.rows().filter(|row| row.word("strategy") == strategy && row.word("tests") == *size);
                let of_kind = own.filter(|row| (row.word("verdict") == "fail") == fails);
                of_kind.map(|row| (row.number("speed"), row.number("distance"))).collect::<Vec<_>>()
            };
            let letter = ['a', 'b', 'c', 'd', 'e', 'f'][panels.len()];
            let side = if *size == "500" { 13.0 } else { 18.0 };
            let title = if strategy == "halton" { "Halton" } else { strategy };
            panels.push(Panel {
                name: format!("({letter}) {title}, {size} tests"),
                x: speed(),
                y: distance(),
                layers: vec![
                    Layer::Cells(map.cells(), FAILING),
                    Layer::Points(marks(false), Mark::Dot(side), BLUE),
                    Layer::Points(marks(true), Mark::Cross(1.5 * side), RED),
                ],
            });
        }
    }
    let legend = vec![
        (Key::Mark(Mark::Dot(20.0), BLUE), "pass".to_owned()),
        (Key::Mark(Mark::Cross(28.0), RED), "fail".to_owned()),
        (Key::Area(FAILING), "fails on the reference map".to_owned()),
    ];
    Figure { columns: 2, shape: 0.6, panels, legend, bar: None }
}

/// Draws where tests fail with the network, and the borders of where tests fail with other drivers.
pub fn map(tables: &[Table]) -> Figure {
    let [network, others] = tables else { panic!("two tables") };
    let own = Map::of(network.rows().map(|row| row.word("verdict") == "fail").collect());
    let of = |driver: &str| Map::of(others.rows().map(|row| row.word(driver) == "true").collect());
    let mut layers = vec![Layer::Cells(own.cells(), PINK)];
    layers.extend(of("cruise").outline(BLUE));
    layers.extend(of("expert").outline(GREEN));
    let legend = vec![
        (Key::Area(PINK), "fails with the network".to_owned()),
        (Key::Line(BLUE), "border with cruise".to_owned()),
        (Key::Line(GREEN), "border with expert".to_owned()),
    ];
    let panels = vec![Panel { name: String::new(), x: speed(), y: distance(), layers }];
    Figure { columns: 1, shape: 0.5, panels, legend, bar: None }
}
