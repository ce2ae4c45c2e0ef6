//! Compares how `greedy`, `greedy-periodic`, `halton` and `random` treat the borders of the space: the tables in
//! docs/samplers.md. `cargo run --release -p paracosm-generators --example borders`, some minutes.

use paracosm_coverage::dispersion::dispersion;
use paracosm_coverage::{Deadline, PointSet};
use paracosm_generators::{Request, Strategy};
use paracosm_space::Space;
use std::thread;

const STRATEGIES: [Strategy; 4] = [Strategy::GREEDY, Strategy::GREEDY_PERIODIC, Strategy::HALTON, Strategy::RANDOM];

/// The number of seeds; the shares hardly differ between seeds.
const SEEDS: u64 = 30;
const SEEDS_OF_SHARES: u64 = 10;

/// The greatest number of tests to a failure.
const MOST_TESTS: usize = 700;

fn main() {
    println!("share of 500 points in the outermost 10 % of the volume, {SEEDS_OF_SHARES} seeds");
    for_all(&[2, 4], |strategy, dims| {
        let shares = (0..SEEDS_OF_SHARES).map(|seed| {
            let points = points(strategy, dims, seed, 500);
            points.iter().filter(|point| is_outermost(point)).count() as f64 / 5.0
        });
        format!("{} %", quartiles(shares.collect()))
    });
    println!("dispersion of 100 points, {SEEDS} seeds");
    for_all(&[2, 3], |strategy, dims| {
        let volumes = (0..SEEDS).map(|seed| {
            let set = PointSet::new(dims, points(strategy, dims, seed, 100)).expect("points of the cube");
            100.0 * dispersion(&set, Deadline::never()).volume.lower
        });
        format!("{} %", quartiles(volumes.collect()))
    });
    println!("tests to the first in a corner with 1 % of the volume, {SEEDS} seeds, each of 16 corners");
    for_all(&[4], |strategy, _| {
        let (found, missed): (Vec<_>, Vec<_>) =
            (0..SEEDS).flat_map(|seed| tests_to_corners(strategy, seed)).partition(Option::is_some);
        let tests = found.into_iter().flatten().chain(missed.iter().map(|_| MOST_TESTS)).map(|tests| tests as f64);
        format!("{}, {} not within {MOST_TESTS}", quartiles(tests.collect()), missed.len())
    });
}

/// Prints a line for each strategy and number of dimensions. They are computed side by side.
fn for_all(dims: &[usize], line: impl Fn(Strategy, usize) -> String + Sync) {
    thread::scope(|scope| {
        let line = &line;
        let cases = dims.iter().flat_map(|&dims| STRATEGIES.map(|strategy| (strategy, dims)));
        let lines: Vec<_> = cases.map(|case| (case, scope.spawn(move || line(case.0, case.1)))).collect();
        for ((strategy, dims), line) in lines {
            println!("{dims} {:16} {}", strategy.name(), line.join().expect("no thread panics"));
        }
    });
}

fn points(strategy: Strategy, dims: usize, seed: u64, n: usize) -> Vec<Vec<f64>> {
    let space = Space::unit_cube(dims);
    let request = Request { seed: Some(seed), ..Request::new(&space, n) };
    let tests = strategy.build(&request).expect("the strategy covers these dimensions").ask(n);
    tests.into_iter().map(|test| test.continuous).collect()
}

/// Returns `true` if a point lies outside of the cube in the middle that has 90 % of the volume.
fn is_outermost(point: &[f64]) -> bool {
    let half = 0.5 * libm::pow(0.9, 1.0 / point.len() as f64);
    point.iter().any(|x| (x - 0.5).abs() > half)
}

/// The number of tests to the first test in each of the 16 corners of four dimensions; `None` if there is none.
fn tests_to_corners(strategy: Strategy, seed: u64) -> [Option<usize>; 16] {
    let side = libm::pow(0.01, 0.25);
    let space = Space::unit_cube(4);
    let request = Request { seed: Some(seed), ..Request::new(&space, MOST_TESTS) };
    let mut generator = strategy.build(&request).expect("the strategy covers four dimensions");
    let mut found = [None; 16];
    for tests in 1..=MOST_TESTS {
        let point = generator.ask(1).remove(0).continuous;
        let is_there = |corner: usize| {
            let near = |(axis, x): (usize, &f64)| if corner >> axis & 1 == 0 { *x < side } else { *x >= 1.0 - side };
            point.iter().enumerate().all(near)
        };
        for (corner, first) in found.iter_mut().enumerate() {
            if first.is_none() && is_there(corner) {
                *first = Some(tests);
            }
        }
        if found.iter().all(Option::is_some) {
            break;
        }
    }
    found
}

/// The median and the quartiles.
fn quartiles(mut values: Vec<f64>) -> String {
    values.sort_by(f64::total_cmp);
    let [low, median, high] = [1, 2, 3].map(|quarter| values[quarter * (values.len() - 1) / 4]);
    format!("{median:.2} ({low:.2} to {high:.2})")
}
