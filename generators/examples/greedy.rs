//! Compares the dispersion of `greedy` with that of Halton points: the table in its documentation.
//! `cargo run --release -p paracosm-generators --example greedy`, under a minute.

use paracosm_coverage::dispersion::dispersion;
use paracosm_coverage::{Deadline, PointSet};
use paracosm_generators::{Request, Strategy};
use paracosm_space::Space;
use std::time::Instant;

const SEEDS: u64 = 20;

fn main() {
    println!("{:>2} {:>4} {:>7} {:>16} {:>11}", "d", "n", "median", "quartiles", "ms a point");
    for (dims, n) in [(2, 100), (2, 500), (3, 100), (3, 500), (5, 200), (8, 100)] {
        let space = Space::unit_cube(dims);
        let points = |strategy: Strategy, seed| {
            let request = Request { seed, ..Request::new(&space, n) };
            let points = strategy.build(&request).expect("the strategy covers these dimensions").ask(n);
            PointSet::new(dims, points.iter().map(|point| &point.continuous)).expect("points of the cube")
        };
        let volume = |points: &PointSet| dispersion(points, Deadline::never()).volume.lower;
        let halton = volume(&points(Strategy::HALTON, None));
        let begun = Instant::now();
        let sets: Vec<PointSet> = (0..SEEDS).map(|seed| points(Strategy::GREEDY, Some(seed))).collect();
        let each = begun.elapsed().as_secs_f64() * 1e3 / (SEEDS as usize * n) as f64;
        let mut ratios: Vec<f64> = sets.iter().map(|set| volume(set) / halton).collect();
        ratios.sort_by(f64::total_cmp);
        let [low, median, high] = [5, 10, 15].map(|i| ratios[i]);
        println!("{dims:>2} {n:>4} {median:>7.3} {low:>7.3} to {high:.3} {each:>11.2}");
    }
}
