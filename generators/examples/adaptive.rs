//! How many tests it takes to the first failure: the table of adaptive strategies in BENCHMARKS.md.
//! `cargo run --release -p paracosm-generators --example adaptive [BATCH [SEEDS]]`, a minute; with SEEDS 0 the time that
//! proposals take.
//!
//! Functions with a known set of failures (values below 0), which another seed puts elsewhere; a run ends after 300 tests
//! and then counts as 300. Medians, and how many of the runs found a failure.

use paracosm_coverage::{Point, Space};
use paracosm_generators::functions::Function;
use paracosm_generators::{Request, Strategy};
use std::time::Instant;

const BUDGET: usize = 300;

/// After how many tests the first one fails; None after the budget.
fn first_failure(function: &Function, strategy: Strategy, seed: u64, batch: usize) -> Option<usize> {
    let (space, placed) = (function.space(), function.placed(seed));
    let request = Request { seed: Some(seed), ..Request::new(&space, BUDGET) };
    let mut generator = strategy.build(&request).expect("a generator");
    let mut done = 0;
    while done < BUDGET {
        let tests = generator.ask(batch.min(BUDGET - done));
        let robustness: Vec<_> = tests.iter().map(|test| placed.robustness(test)).collect();
        if let Some(index) = robustness.iter().position(|r| r.is_some_and(|r| r < 0.0)) {
            return Some(done + index + 1);
        }
        if tests.is_empty() {
            return None;
        }
        generator.tell(&tests, &robustness);
        done += tests.len();
    }
    None
}

/// The median time of a batch of proposals after so many tests, in milliseconds, where no failure can be found.
fn print_times(batch: usize) {
    let space = Space::unit_cube(5);
    let hidden = [0.31, 0.64, 0.45, 0.58, 0.37];
    for strategy in Strategy::ALL.into_iter().filter(|strategy| strategy.is_adaptive()) {
        let mut generator = strategy.build(&Request::new(&space, 1000)).expect("a generator");
        let (mut done, mut spent) = (0, Vec::new());
        while done < 520 {
            let begun = Instant::now();
            let tests = generator.ask(batch);
            spent.push((done, begun.elapsed().as_secs_f64() * 1e3));
            let wave = |(x, c): (&f64, &f64)| (x - c) * (x - c) + 0.05 * (1.0 - libm::cos(20.0 * (x - c)));
            let robustness = |test: &Point| Some(0.1 + test.continuous.iter().zip(&hidden).map(wave).sum::<f64>());
            let told: Vec<_> = tests.iter().map(robustness).collect();
            generator.tell(&tests, &told);
            done += tests.len();
        }
        for after in [100, 200, 500] {
            let near = spent.iter().filter(|(done, _)| (after - 60..after + 20).contains(done));
            let mut near: Vec<f64> = near.map(|spent| spent.1).collect();
            near.sort_by(f64::total_cmp);
            println!("{:<12} batch {batch} after {after} tests: {:.2} ms", strategy.name(), near[near.len() / 2]);
        }
    }
}

fn main() {
    let mut numbers = std::env::args().skip(1).map(|text| text.parse().expect("a number"));
    let (batch, seeds) = (numbers.next().unwrap_or(16), numbers.next().unwrap_or(30));
    if seeds == 0 {
        return print_times(batch);
    }
    let strategies: Vec<Strategy> = [Strategy::Random, Strategy::Halton]
        .into_iter()
        .chain(Strategy::ALL.into_iter().filter(|strategy| strategy.is_adaptive()))
        .collect();
    print!("| function |");
    strategies.iter().for_each(|strategy| print!(" `{strategy}` |"));
    println!("\n|{}", " --- |".repeat(1 + strategies.len()));
    for function in &Function::ALL {
        print!("| {} |", function.name);
        for &strategy in &strategies {
            let runs = (0..seeds as u64).map(|seed| first_failure(function, strategy, seed, batch));
            let runs: Vec<Option<usize>> = runs.collect();
            let found = runs.iter().flatten().count();
            let mut tests: Vec<usize> = runs.into_iter().map(|run| run.unwrap_or(BUDGET)).collect();
            tests.sort_unstable();
            print!(" {} ({found}) |", tests[tests.len() / 2]);
        }
        println!();
    }
}
